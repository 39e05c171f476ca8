"""A reproducible random sample of the mutants that cargo-mutants lists."""

import hashlib
import json
import subprocess
from dataclasses import dataclass


@dataclass(frozen=True)
class Mutant:
    """One mutant: what it replaces, where, and by what."""

    id: int
    folder: str
    file: str
    line: int
    function: str
    return_type: str
    genre: str
    name: str
    replacement: str
    # Line and column, both from 1 and in characters; the end is the first character behind.
    start: tuple[int, int]
    end: tuple[int, int]


def listed(root):
    """All mutants of the crate in `root`, in the order of cargo-mutants."""
    command = ["cargo", "mutants", "--list", "--json"]
    answer = subprocess.run(command, cwd=root, check=True, capture_output=True, text=True).stdout
    seen, mutants = {}, []
    for entry in json.loads(answer):
        start, end = entry["span"]["start"], entry["span"]["end"]
        # Without line and column: a new test above or a new comment changes no sample.
        what = entry["name"].split(": ", 1)[1]
        name = f"{entry['file']}: {what}"
        seen[name] = seen.get(name, -1) + 1
        digest = hashlib.sha256(f"{name} #{seen[name]}".encode()).digest()
        function = entry["function"] or {"function_name": "", "return_type": ""}
        mutants.append(
            Mutant(
                id=1 + int.from_bytes(digest[:4], "big") // 2,
                folder=entry["file"].split("/")[1].removesuffix(".rs"),
                file=entry["file"],
                line=start["line"],
                function=function["function_name"],
                return_type=function["return_type"],
                genre=entry["genre"],
                name=what,
                replacement=entry["replacement"],
                start=(start["line"], start["column"]),
                end=(end["line"], end["column"]),
            )
        )
    if len({mutant.id for mutant in mutants}) < len(mutants):
        raise SystemExit("two mutants have the same number: their digests need more bytes")
    return mutants


def drawn(mutants, folder, size, seed, shard):
    """`size` mutants of a folder. Shards 0, 1, 2 … with the same seed have no mutant in common."""
    order = sorted(
        (mutant for mutant in mutants if mutant.folder == folder),
        key=lambda mutant: hashlib.sha256(f"{seed} {mutant.id}".encode()).digest(),
    )
    return order[shard * size : (shard + 1) * size]
