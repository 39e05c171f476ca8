"""Which share of the mutants of cargo-mutants do the tests kill? With one build for all of them.

    pip install tree-sitter tree-sitter-rust
    python studies/mutants/switch.py --work DIR --folders loading,updater --size 40

cargo-mutants builds the crate once for each mutant. Here a random sample of its list goes into one copy of
the crate, each mutant behind a switch that the environment variable ASPERITY_MUTANT turns on:

    a + b   becomes   (match crate::mutant::on() { 7 => (a - b), _ => (a + b) })

and a function that returns something else begins with `if crate::mutant::on() == 7 { return … }`. A mutant that
rustc refuses is dropped. What is decided at compile time has no switch and is left out: constants, `let` chains,
values behind `impl Trait`. With no mutant on, all tests have to pass. A mutant is killed if a test fails, if the
tests crash, or if they take five times as long and 10 s.

DIR/outcomes.csv has a line for each mutant; a run that was interrupted goes on behind it. Other mutants with the
same chances: `--shard 1`. After a new test: `--again survived`, or `--only` and their numbers. Where compiling takes
long, `--tests unit` begins, and `--again survived --tests paths,kernels` goes on with those that are left.
"""

import argparse
import csv
import json
import math
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import rewrite
import sample
import trial

ROOT = Path(__file__).parents[2]
TESTS = [trial.UNIT, "closed_forms", "kernels", "own_parts", "paths", "fixed_load", "robustness", "allocations"]
COLUMNS = ["id", "file", "line", "function", "genre", "mutant", "outcome", "by"]
SURVIVED, KILLED = "survived", "killed"
INVALID, NO_SWITCH = "does not compile", "cannot be switched"


class Outcomes:
    """The table of outcomes, on disk from the first line on. The last line of a mutant counts."""

    def __init__(self, path):
        self.path = path
        self.of = {}
        if path.exists():
            with path.open(newline="") as file:
                self.of = {int(row["id"]): row for row in csv.DictReader(file)}
        else:
            with path.open("w", newline="") as file:
                csv.writer(file).writerow(COLUMNS)

    def note(self, mutant, outcome, by=""):
        values = [mutant.id, mutant.file, mutant.line, mutant.function, mutant.genre, mutant.name, outcome, by]
        with self.path.open("a", newline="") as file:
            csv.writer(file).writerow(values)
        self.of[mutant.id] = dict(zip(COLUMNS, map(str, values)))
        print(f"{outcome} {by and f'({by})'} {mutant.file}:{mutant.line}: {mutant.name}", flush=True)

    def is_built(self, mutant):
        return self.of.get(mutant.id, {}).get("outcome") not in (INVALID, NO_SWITCH)


def write_if_new(path, content):
    """Leaves alone what does not change, so that cargo does."""
    if not path.exists() or path.read_bytes() != content:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


def copy_crate(copy):
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    names = set(subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\n"))
    for name in names - {""}:
        # Sources are written with their switches.
        if (ROOT / name).is_file() and not name.startswith("src/"):
            write_if_new(copy / name, (ROOT / name).read_bytes())
    kept = {copy / name for name in names} | {copy / "src" / "mutant.rs"}
    for folder in ("src", "tests"):
        for old in (copy / folder).rglob("*.rs"):
            if old not in kept:
                old.unlink()


def write_sources(copy, mutants, outcomes):
    """Writes the library with the switches; returns what was written, by file."""
    written = {}
    for path in sorted((ROOT / "src").rglob("*.rs")):
        name = str(path.relative_to(ROOT))
        here = [mutant for mutant in mutants if mutant.file == name and outcomes.is_built(mutant)]
        text = path.read_text()
        if here:
            source = rewrite.Source(text)
            for mutant in here:
                try:
                    source.add(mutant)
                except rewrite.CannotSwitch as why:
                    outcomes.note(mutant, NO_SWITCH, str(why))
            content = source.written()
        else:
            content = text.encode()
        if name == "src/lib.rs":
            content = b"#![allow(warnings)]\n" + content + b"\nmod mutant;\n"
        written[name] = content
        write_if_new(copy / name, content)
    write_if_new(copy / "src" / "mutant.rs", rewrite.SWITCH.encode())
    return written


def spans_of(message):
    """Where an error is: where the compiler points first, then the rest."""
    spans = sorted(message["spans"], key=lambda span: not span["is_primary"])
    return spans + [span for child in message["children"] for span in child["spans"]]


def lacking(message, written, by_number):
    """The deleted arm without which a match is not complete: rustc points to what is matched, the arm comes next."""
    span = message["spans"][0] if message["spans"] else None
    if span is None or (message["code"] or {}).get("code") != "E0004":
        return None
    marks = rewrite.MARK.finditer(written.get(span["file_name"], b""))
    behind = (int(mark.group(1)) for mark in marks if mark.start() >= span["byte_end"])
    return next((number for number in behind if by_number[number].genre == "MatchArm"), None)


def compile_switched(copy, mutants, tests, outcomes):
    """Compiles the switched crate without the mutants that rustc refuses; returns the test binaries."""
    by_number = {mutant.id: mutant for mutant in mutants}
    while True:
        written = write_sources(copy, mutants, outcomes)
        errors, binaries = trial.build(copy, tests)
        if not errors:
            return binaries
        refused = {}
        for message in errors:
            found = (
                rewrite.blamed(written.get(span["file_name"], b""), span["byte_start"], span["byte_end"])
                for span in spans_of(message)
            )
            number = next((number for number in found if number), None)
            number = number or lacking(message, written, by_number)
            if number:
                refused.setdefault(number, message["message"])
        if not refused:
            print(*(message["rendered"] for message in errors), sep="\n")
            raise SystemExit("rustc's errors are in none of the mutants")
        for number, why in refused.items():
            outcomes.note(by_number[number], INVALID, why)


def try_out(mutant, steps, copy, jobs, outcomes):
    """Runs tests until one fails: first what has killed other mutants of the folder, then all by the same measure."""
    order = sorted(steps, key=lambda step: -(step.kills + 0.1) / (step.seconds + 0.1))
    trials = [(step, list(step.killers)) for step in order if step.killers] + [(step, []) for step in order]
    for step, only in trials:
        failure = step.run(copy, mutant.id, jobs, only)
        if failure:
            step.kills += 1
            if failure.is_test and failure.what not in step.killers:
                step.killers.append(failure.what)
            outcomes.note(mutant, KILLED, f"{step.name}: {failure.what}")
            return
    outcomes.note(mutant, SURVIVED)


def measure(steps, copy, path):
    """Times of the steps without a mutant, kept in a file as long as the binaries stay the same."""
    seconds = json.loads(path.read_text()) if path.exists() else {}
    for step in (step for folder in steps.values() for step in folder):
        binary = Path(step.command[0])
        key = f"{step.timed_as}: {binary.name} of {binary.stat().st_mtime}"
        if key not in seconds:
            seconds[key] = step.measure(copy)
            path.write_text(json.dumps(seconds, indent=1))
        step.seconds = seconds[key]


def wilson(killed, viable):
    """The 95 % interval of a share (Wilson 1927)."""
    if viable == 0:
        return 0.0, 1.0
    z, share = 1.959963984540054, killed / viable
    centre = share + z * z / (2 * viable)
    half = z * math.sqrt(share * (1 - share) / viable + z * z / (4 * viable * viable))
    return (centre - half) / (1 + z * z / viable), (centre + half) / (1 + z * z / viable)


def table(mutants, folders, outcomes):
    """Counts by folder; the last line weighs folders by the mutants that cargo-mutants lists in them."""
    print("\n| folder | listed | tried | no switch | refused | viable | killed | share | 95 % |")
    print("|---|---|---|---|---|---|---|---|---|")
    weight, share = 0, 0.0
    for folder in folders:
        listed = [mutant for mutant in mutants if mutant.folder == folder]
        found = [outcomes.of[mutant.id]["outcome"] for mutant in listed if mutant.id in outcomes.of]
        killed = found.count(KILLED)
        viable = killed + found.count(SURVIVED)
        low, high = wilson(killed, viable)
        cells = [folder, len(listed), len(found), found.count(NO_SWITCH), found.count(INVALID), viable, killed]
        cells += [f"{100 * killed / max(viable, 1):.0f} %", f"{100 * low:.0f} to {100 * high:.0f} %"]
        print("|", " | ".join(map(str, cells)), "|")
        if viable:
            # Of those listed, as many are viable as of those tried.
            expected = len(listed) * viable / len(found)
            weight, share = weight + expected, share + expected * killed / viable
    if weight:
        print(f"\nWeighed by the viable mutants of each folder: {100 * share / weight:.0f} % killed.")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--work", type=Path, required=True, help="folder for the copy and the outcomes")
    parser.add_argument("--folders", default="loading,updater,fixed_load,convolution,kernel,contact,krylov")
    parser.add_argument("--size", type=int, default=40, help="mutants of each folder")
    parser.add_argument("--seed", type=int, default=2020)
    parser.add_argument("--shard", type=int, default=0, help="the next ones of the same draw")
    parser.add_argument("--tests", default=",".join(TESTS), help="the test binaries")
    parser.add_argument("--jobs", type=int, default=2, help="mutants at a time")
    parser.add_argument("--only", help="numbers of mutants, whether they were tried or not")
    parser.add_argument("--again", choices=[SURVIVED], help="tries those once more")
    parser.add_argument("--table", action="store_true", help="prints the table of what is known, and ends")
    arguments = parser.parse_args()
    if shutil.which("prlimit") is None:
        raise SystemExit("prlimit is missing (package util-linux)")
    work, folders = arguments.work.resolve(), arguments.folders.split(",")
    work.mkdir(parents=True, exist_ok=True)
    outcomes = Outcomes(work / "outcomes.csv")
    mutants = sample.listed(ROOT)
    if not arguments.table:
        chosen = [
            mutant
            for folder in folders
            for mutant in sample.drawn(mutants, folder, arguments.size, arguments.seed, arguments.shard)
        ]
        copy = work / "copy"
        copy_crate(copy)
        binaries = compile_switched(copy, chosen, arguments.tests.split(","), outcomes)
        steps = trial.plan(binaries, folders)
        measure(steps, copy, work / "times.json")
        if arguments.only:
            numbers = set(map(int, arguments.only.split(",")))
            waiting = [mutant for mutant in chosen if mutant.id in numbers]
        else:
            done = set(outcomes.of)
            if arguments.again:
                done -= {number for number, row in outcomes.of.items() if row["outcome"] == arguments.again}
            waiting = [mutant for mutant in chosen if mutant.id not in done]
        with ThreadPoolExecutor(arguments.jobs) as pool:
            list(
                pool.map(
                    lambda mutant: try_out(mutant, steps[mutant.folder], copy, arguments.jobs, outcomes),
                    waiting,
                )
            )
    table(mutants, folders, outcomes)


if __name__ == "__main__":
    main()
