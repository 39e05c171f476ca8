"""Builds the switched copy, and runs its test binaries with one mutant on."""

import json
import os
import re
import resource
import signal
import subprocess
import tempfile
import threading
import time

from rewrite import VARIABLE

MEMORY = 6 << 30
FAILED = re.compile(r"test (.+?)(?: - should panic)? \.\.\. FAILED")
# The cases of every run, as .cargo/config.toml has them; a failure leaves no seed for the mutants that follow.
ENVIRONMENT = {"PROPTEST_DISABLE_FAILURE_PERSISTENCE": "true", "PROPTEST_RNG_SEED": "2020"}


def build(copy, tests, only_library):
    """Compiles the tests. Returns the errors' spans and the binaries by name."""
    command = ["cargo", "test", "--locked", "--release", "--package", "asperity", "--no-run"]
    command += ["--message-format=json", "--lib"]
    if not only_library:
        command += [argument for test in tests for argument in ("--test", test)]
    child = subprocess.run(command, cwd=copy, stdout=subprocess.PIPE, text=True, check=False)
    errors, binaries = [], {}
    for line in child.stdout.splitlines():
        message = json.loads(line)
        if message["reason"] == "compiler-message" and message["message"]["level"] == "error":
            errors.append(message["message"])
        if message["reason"] == "compiler-artifact" and message["executable"]:
            kind = message["target"]["kind"][0]
            name = "unit tests" if kind == "lib" else message["target"]["name"]
            binaries[name] = message["executable"]
    if child.returncode and not errors:
        raise SystemExit(f"cargo test ended with {child.returncode}")
    return errors, binaries


class Step:
    """A test binary, or the part of it that begins or does not begin with a module's name."""

    def __init__(self, name, binary, arguments=()):
        self.name = name
        self.command = [binary, *arguments, "--test-threads=2"]
        self.seconds = None

    def run(self, copy, mutant, jobs):
        """What became of the tests: None if all passed, otherwise what failed first."""
        limits = ["prlimit", f"--as={MEMORY}"]
        wall = None
        if self.seconds is not None:
            # In processor time, which other work on the machine does not lengthen. A program that
            # waits forever takes none: the clock ends it in the end.
            processor = int(5 * self.seconds + 10)
            limits.append(f"--cpu={processor}:{processor}")
            wall = 4 * jobs * processor
        with tempfile.TemporaryDirectory() as temporary:
            environment = os.environ | ENVIRONMENT
            environment |= {VARIABLE: str(mutant), "TMPDIR": temporary, "CARGO_MANIFEST_DIR": str(copy)}
            child = subprocess.Popen(
                [*limits, "--", *self.command],
                cwd=copy,
                env=environment,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                text=True,
                errors="replace",
                start_new_session=True,
            )
            late = threading.Event()
            clock = threading.Timer(wall, lambda: (late.set(), kill(child))) if wall else None
            if clock:
                clock.start()
            try:
                failure = next(filter(None, map(FAILED.match, child.stdout)), None)
                if failure:
                    kill(child)
                code = child.wait()
            finally:
                if clock:
                    clock.cancel()
                kill(child)
        if failure:
            return failure.group(1)
        if late.is_set() or code in (-signal.SIGXCPU, -signal.SIGKILL):
            return "timeout"
        if code < 0:
            return f"signal {-code}"
        return None if code == 0 else f"exit code {code}"

    def measure(self, copy):
        """The processor time that the tests take with no mutant on, all of which have to pass."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        begun = time.monotonic()
        failure = self.run(copy, 0, 1)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if failure:
            raise SystemExit(f"{self.name}: without a mutant: {failure}")
        self.seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        print(f"{self.name}: {self.seconds:.1f} s, {time.monotonic() - begun:.1f} s by the clock", flush=True)


def kill(child):
    if child.poll() is None:
        os.killpg(child.pid, signal.SIGKILL)


def plan(binaries, folders):
    """The steps for the mutants of each folder: first the unit tests beside them, which mostly fail."""
    unit = binaries["unit tests"]
    whole = [Step(name, binary) for name, binary in binaries.items() if name != "unit tests"]
    steps = {}
    for folder in folders:
        beside = Step(f"unit tests of {folder}", unit, [f"{folder}::"])
        others = Step(f"unit tests but {folder}", unit, ["--skip", f"{folder}::"])
        steps[folder] = [beside, others, *whole]
    return steps
