"""Which lines of the library do the tests reach, file by file?

    cargo llvm-cov --release --locked -p asperity -p asperity-drivers --lib --tests --no-report
    python studies/coverage/lines.py
    python studies/coverage/lines.py --show src/loading/resume.rs

The first command runs the tests and leaves their counts in the target directory; `--target DIR` says where that is. A
binary may as well be run by itself, with LLVM_PROFILE_FILE=DIR/NAME-%p.profraw.

One report is made for each binary, and a line is reached if it is in one of them: small functions are compiled into
the tests that call them, and a report over all binaries takes those counts for another function's. Tests themselves are left
out: what stands behind `#[cfg(test)]`, and files named after tests.
"""

import argparse
import subprocess
from pathlib import Path

ROOT = Path(__file__).parents[2]


def tools():
    """The folder of llvm-cov and llvm-profdata that belong to rustc."""
    root = subprocess.run(["rustc", "--print", "sysroot"], check=True, capture_output=True, text=True).stdout.strip()
    found = sorted(Path(root).glob("lib/rustlib/*/bin/llvm-cov"))
    if not found:
        raise SystemExit("no llvm-cov: rustup component add llvm-tools")
    return found[0].parent


def counts(target):
    """How often each line was reached, by file and line."""
    folder, reached = tools(), {}
    profiles = [str(path) for path in target.glob("*.profraw")]
    profile = target / "lines.profdata"
    subprocess.run([folder / "llvm-profdata", "merge", "-sparse", *profiles, "-o", profile], check=True)
    for binary in (target / "release/deps").iterdir():
        if binary.suffix or not binary.stat().st_mode & 0o100:
            continue
        command = [folder / "llvm-cov", "export", "-format=lcov", "-instr-profile", profile, binary]
        report = subprocess.run(command, capture_output=True, text=True)
        file = None
        for entry in report.stdout.splitlines():
            kind, _, value = entry.partition(":")
            if kind == "SF":
                path = Path(value)
                file = str(path.relative_to(ROOT)) if path.is_relative_to(ROOT / "src") else None
            elif kind == "DA" and file:
                line, count = map(int, value.split(",")[:2])
                lines = reached.setdefault(file, {})
                lines[line] = max(lines.get(line, 0), count)
    return reached


def tests_in(file):
    """The lines of a file that are compiled for tests only, and the files of modules that are."""
    text = (ROOT / file).read_text().splitlines()
    lines, files = set(), set()
    for start, line in enumerate(text):
        if not line.strip().startswith(("#[cfg(test)]", "#[cfg(all(test,")) or start in lines:
            continue
        indent = line[: len(line) - len(line.lstrip())]
        item = next(k for k in range(start + 1, len(text)) if text[k].rstrip().endswith((";", "{", "}")))
        end = item
        if text[item].rstrip().endswith("{"):
            end = next(k for k in range(item, len(text)) if text[k].rstrip() == indent + "}")
        elif " mod " in " " + text[item]:
            name = text[item].split("mod ")[1].rstrip("; ")
            path = Path(file)
            inner = path.parent if path.name in ("mod.rs", "lib.rs") else path.with_suffix("")
            files |= {str(inner / f"{name}.rs"), str(inner / name / "mod.rs")}
            if path.name not in ("mod.rs", "lib.rs"):
                files.add(str(path.parent / f"{name}.rs"))
        lines |= set(range(start, end + 1))
    return {k + 1 for k in lines}, files


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--target", type=Path, default=ROOT / "target/llvm-cov-target")
    parser.add_argument("--least", type=float, default=95.0, help="files below this share are listed, in %%")
    parser.add_argument("--show", help="a file whose lines that are not reached are printed")
    arguments = parser.parse_args()
    reached = counts(arguments.target)
    sources = [str(path.relative_to(ROOT)) for path in (ROOT / "src").rglob("*.rs")]
    inside = {file: tests_in(file) for file in sources}
    only_tests = {file for _, files in inside.values() for file in files}
    table = []
    for file, lines in reached.items():
        if file in only_tests or "tests" in Path(file).parts:
            continue
        code = sorted(set(lines) - inside[file][0])
        missed = [line for line in code if not lines[line]]
        if code:
            table.append((1 - len(missed) / len(code), file, len(code), missed))
    total, missed = sum(row[2] for row in table), sum(len(row[3]) for row in table)
    print(f"{len(table)} files, {total} lines, {100 * (1 - missed / total):.1f} % reached")
    for share, file, code, lines in sorted(table):
        if 100 * share < arguments.least:
            print(f"{100 * share:5.1f} %  {file}: {len(lines)} of {code}")
        if file == arguments.show:
            text = (ROOT / file).read_text().splitlines()
            for line in lines:
                print(f"{line:5} {text[line - 1]}")


if __name__ == "__main__":
    main()
