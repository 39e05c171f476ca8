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
from dataclasses import dataclass

from rewrite import VARIABLE

UNIT = "unit"
MEMORY = 6 << 30
FAILED = re.compile(r"test (.+?)(?: - should panic)? \.\.\. FAILED")
# The cases of every run, as .cargo/config.toml has them; a failure leaves no seed for the mutants that follow.
ENVIRONMENT = {"PROPTEST_DISABLE_FAILURE_PERSISTENCE": "true", "PROPTEST_RNG_SEED": "2020"}


def build(copy, tests):
    """Compiles tests. Returns the compiler's errors and the binaries by name."""
    command = ["cargo", "test", "--locked", "--release", "--package", "asperity", "--no-run"]
    command += ["--message-format=json"]
    for test in tests:
        command += ["--lib"] if test == UNIT else ["--test", test]
    child = subprocess.run(command, cwd=copy, stdout=subprocess.PIPE, text=True, check=False)
    errors, binaries = [], {}
    for line in child.stdout.splitlines():
        message = json.loads(line)
        if message["reason"] == "compiler-message" and message["message"]["level"] == "error":
            errors.append(message["message"])
        if message["reason"] == "compiler-artifact" and message["executable"]:
            kind = message["target"]["kind"][0]
            name = UNIT if kind == "lib" else message["target"]["name"]
            binaries[name] = message["executable"]
    if child.returncode and not errors:
        raise SystemExit(f"cargo test ended with {child.returncode}")
    return errors, binaries


@dataclass
class Failure:
    """The test that failed, or what became of the program."""

    what: str
    is_test: bool = False


class Step:
    """A test binary, or the part of it that begins or does not begin with a module's name."""

    def __init__(self, name, binary, arguments=(), timed_as=None):
        self.name = name
        # Steps of the same length are measured once.
        self.timed_as = timed_as or name
        self.command = [binary, "--test-threads=2", *arguments]
        self.seconds = None
        # Tests that have failed, and how often any did.
        self.killers = []
        self.kills = 0

    def run(self, copy, mutant, jobs, only=()):
        """What became of the tests, or `only` of these: None if all passed, otherwise what failed first."""
        command = [*self.command[:2], "--exact", *only] if only else self.command
        limits = ["prlimit", f"--as={MEMORY}"]
        ticks = None
        if self.seconds is not None:
            # In processor time, which other work on the machine does not lengthen.
            processor = int(5 * self.seconds + 10)
            limits.append(f"--cpu={processor}:{processor}")
            ticks = 10 * jobs * processor
        with tempfile.TemporaryDirectory() as temporary:
            environment = os.environ | ENVIRONMENT
            environment |= {VARIABLE: str(mutant), "TMPDIR": temporary, "CARGO_MANIFEST_DIR": str(copy)}
            child = subprocess.Popen(
                [*limits, "--", *command],
                cwd=copy,
                env=environment,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                text=True,
                errors="replace",
                start_new_session=True,
            )
            ended, late = threading.Event(), threading.Event()

            def watch():
                # A program that waits forever takes no processor time. Seconds are counted, because a
                # machine that sleeps is no fault of the mutant's.
                for _ in range(ticks):
                    if ended.wait(1.0):
                        return
                late.set()
                kill(child)

            if ticks:
                threading.Thread(target=watch, daemon=True).start()
            try:
                failure = next(filter(None, map(FAILED.match, child.stdout)), None)
                if failure:
                    kill(child)
                code = child.wait()
            finally:
                ended.set()
                kill(child)
        if failure:
            return Failure(failure.group(1), True)
        if late.is_set() or code in (-signal.SIGXCPU, -signal.SIGKILL):
            return Failure("timeout")
        if code < 0:
            return Failure(f"signal {-code}")
        return Failure(f"exit code {code}") if code else None

    def measure(self, copy):
        """The processor time that the tests take with no mutant on, all of which have to pass."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        begun = time.monotonic()
        failure = self.run(copy, 0, 1)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if failure:
            raise SystemExit(f"{self.name}: without a mutant: {failure.what}")
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        print(f"{self.timed_as}: {seconds:.1f} s, {time.monotonic() - begun:.1f} s by the clock", flush=True)
        return seconds


def kill(child):
    if child.poll() is None:
        os.killpg(child.pid, signal.SIGKILL)


def plan(binaries, folders):
    """The steps for the mutants of each folder; unit tests beside them are a step of their own."""
    steps = {}
    for folder in folders:
        steps[folder] = [Step(name, binary) for name, binary in binaries.items() if name != UNIT]
        if UNIT in binaries:
            module, binary = f"{folder}::", binaries[UNIT]
            steps[folder].append(Step(f"{UNIT} {folder}", binary, [module]))
            steps[folder].append(Step(f"{UNIT} but {folder}", binary, ["--skip", module], UNIT))
    return steps
