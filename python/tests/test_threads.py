"""The lock of the interpreter, threads, forks, signals, and panics."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import asperity as asp
from asperity import _asperity

POSIX = os.name == "posix"


def signal_when(holds: Callable[[], object], number: int = signal.SIGINT) -> list[float]:
    """Sends a signal to this process as soon as something holds: when it was sent, once it was."""
    sent: list[float] = []

    def wait() -> None:
        last = time.monotonic() + 60.0
        while not holds() and time.monotonic() < last:
            time.sleep(0.001)
        sent.append(time.monotonic())
        os.kill(os.getpid(), number)

    threading.Thread(target=wait, daemon=True).start()
    return sent


@pytest.fixture
def long_path(body: asp.HalfSpace) -> asp.LoadingPath:
    """A path of some seconds."""
    return asp.load_path(asp.example_surface(nodes=160), body, area_fraction=0.35)


def test_the_lock_is_released(long_path: asp.LoadingPath) -> None:
    """This thread counts while another one computes."""
    counted = [0]
    running = threading.Thread(target=lambda: long_path.run(check=False))
    running.start()
    while running.is_alive():
        counted[0] += 1
        time.sleep(0.001)
    assert long_path.end == "area fraction"
    # With the lock held it would come to a turn or two for each look at signals, of which there are 20 in a second.
    assert counted[0] > 100


def test_two_paths_side_by_side(rough: asp.Surface, body: asp.HalfSpace) -> None:
    alone = asp.load_path(rough, body, area_fraction=0.4).run(check=False)
    with ThreadPoolExecutor(4) as threads:
        runs = [threads.submit(lambda: asp.load_path(rough, body, area_fraction=0.4).run(check=False)) for _ in range(8)]
        assert all(run.result() == alone for run in runs)


def test_one_path_in_many_threads(rough: asp.Surface, body: asp.HalfSpace) -> None:
    """Threads take turns: each state comes once."""
    path = asp.load_path(rough, body, area_fraction=0.3)
    steps: list[int] = []

    def take() -> None:
        for state in path:
            steps.append(state.step)
            if state.step % 100 == 0:
                assert path.pressure(state).max() > 0.0

    with ThreadPoolExecutor(6) as threads:
        for taken in [threads.submit(take) for _ in range(6)]:
            taken.result()
    assert sorted(steps) == list(range(1, int(0.3 * 4096) + 1))
    assert path.history == asp.load_path(rough, body, area_fraction=0.3).run(check=False)


def test_results_do_not_depend_on_the_number_of_threads(rough: asp.Surface, body: asp.HalfSpace) -> None:
    before = asp.threads()
    found = []
    try:
        for count in [1, 2, 5]:
            asp.set_threads(count)
            assert asp.threads() == count
            path = asp.load_path(rough, body, area_fraction=0.3)
            found.append((path.run(check=False), path.pressure().tobytes()))
    finally:
        asp.set_threads(before)
    assert found[0] == found[1] == found[2]
    for wrong in [0, 10**6]:
        with pytest.raises(asp.AsperityError) as refused:
            asp.set_threads(wrong)
        assert refused.value.value == wrong


@pytest.mark.skipif(not POSIX, reason="signals of POSIX")
def test_ctrl_c_in_the_middle_of_a_path(long_path: asp.LoadingPath) -> None:
    """KeyboardInterrupt, and the path goes on after."""
    sent = signal_when(lambda: len(long_path.history) > 100)
    with pytest.raises(KeyboardInterrupt):
        long_path.run(check=False)
    # At the next window, and not at the end.
    assert time.monotonic() - sent[0] < 2.0
    done = len(long_path.history)
    assert 0 < done < int(0.35 * 160 * 160) and long_path.end is None
    assert long_path.pressure().max() > 0.0
    history = long_path.run(check=False)
    assert len(history) == int(0.35 * 160 * 160) and long_path.end == "area fraction"
    np.testing.assert_array_equal(history.step, np.arange(1, len(history) + 1))


@pytest.mark.skipif(not POSIX, reason="signals of POSIX")
def test_ctrl_c_while_an_interrupted_analysis_goes_on(body: asp.HalfSpace) -> None:
    """What asks the path for its states waits then, and Ctrl-C ends that wait too. Afterwards all is there."""
    path = asp.load_path(asp.example_surface(nodes=160), body, nodes=1000, check=False)
    path.run(check=False)
    pressure = path.pressure()
    seal = asp.Seal(1e-3, 1e5, along="x")
    # Some seconds of work, of which the waits take a part.
    for ask in [
        lambda: seal.curve(path, states=400, check=False),
        lambda: path.history,
        lambda: repr(path),
        path.pressure,
    ]:
        start = time.monotonic()
        threading.Timer(0.1, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        with pytest.raises(KeyboardInterrupt):
            ask()
        assert time.monotonic() - start < 2.0
    assert len(path.history) == 1000
    np.testing.assert_array_equal(path.pressure(), pressure)


@pytest.mark.skipif(not POSIX, reason="signals of POSIX")
def test_a_handler_asks_for_the_path_that_its_thread_waits_for(long_path: asp.LoadingPath) -> None:
    """It comes to its turn as others do."""
    seen: list[int] = []
    before = signal.signal(signal.SIGALRM, lambda number, frame: seen.append(len(long_path.history)))
    running = threading.Thread(target=lambda: long_path.run(check=False))
    try:
        running.start()
        signal.setitimer(signal.ITIMER_REAL, 0.1)
        while running.is_alive():
            repr(long_path)
    finally:
        running.join()
        signal.signal(signal.SIGALRM, before)
    assert len(seen) == 1 and 0 < seen[0] < len(long_path.history)


@pytest.mark.skipif(not POSIX, reason="signals of POSIX")
def test_ctrl_c_in_a_single_load() -> None:
    """The wait ends at once."""
    surface = asp.example_surface(nodes=512)
    timer = threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        while True:
            asp.solve(surface, asp.HalfSpace(115e9, boundary="love"), area_fraction=0.3, tolerance=1e-12, check=False)
    assert time.monotonic() - start < 5.0


@pytest.mark.skipif(not POSIX, reason="signals of POSIX")
def test_ctrl_c_in_a_survey_of_stresses() -> None:
    """The wait ends at once, and what is under way ends at its next depth."""
    pressure = np.zeros((256, 256))
    pressure[100:150, 100:150] = 1e9
    below = asp.stress_of(pressure, 1e-3, 0.3, periodic=False)
    timer = threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        below.survey(np.linspace(1e-6, 1e-4, 5000))
    assert time.monotonic() - start < 5.0
    assert below.survey([1e-5]).depth.tolist() == [1e-5]


@pytest.mark.skipif(not POSIX, reason="signals of POSIX")
def test_signals_while_many_states_are_computed(body: asp.HalfSpace) -> None:
    """Handlers run meanwhile, not once at the end; one that raises ends the wait, and the path can be used after."""
    path = asp.load_path(asp.example_surface(nodes=160), body, nodes=100, check=False)
    path.run(check=False)
    noticed: list[int] = []
    before = signal.signal(signal.SIGALRM, lambda number, frame: noticed.append(number))
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.02, 0.02)
        for ask in [
            lambda: asp.Seal(1e-3, 1e5, along="x").curve(path, states=5, check=False),
            lambda: asp.first_yield(path, 1e8, 0.3),
            lambda: asp.first_yields(path, [1e8], 0.3),
            lambda: asp.report(path),
        ]:
            noticed.clear()
            ask()
            assert len(noticed) > 3
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, signal.default_int_handler)
        signal.setitimer(signal.ITIMER_REAL, 0.05)
        with pytest.raises(KeyboardInterrupt):
            asp.report(path)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    assert path.pressure().max() > 0.0


@pytest.mark.skipif(not POSIX, reason="signals of POSIX")
def test_ctrl_c_in_a_sweep() -> None:
    """What was under way comes next."""
    surface = asp.example_surface(nodes=512)
    loads = [1e4, 2e4, 4e4]
    half_space = asp.HalfSpace(115e9, boundary="free")
    expected = [one.contact_nodes for one in asp.sweep(surface, half_space, loads, check=False)]
    sweep = asp.sweep(surface, half_space, loads, check=False)
    found: list[int] = []
    interrupted = 0
    # In the second one, which takes many times as long as it takes to see that the first one is there.
    signal_when(lambda: found)
    while len(found) < 3:
        try:
            found.append(next(sweep).contact_nodes)
        except KeyboardInterrupt:
            interrupted += 1
    assert found == expected and interrupted == 1


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_fork(rough: asp.Surface, body: asp.HalfSpace) -> None:
    """A child has none of the threads of its parent, and computes all the same: the paths of the parent too."""
    alone = asp.load_path(rough, body, area_fraction=0.4).run(check=False)
    begun = asp.load_path(rough, body, area_fraction=0.4)
    for _ in range(50):
        next(begun)
    sweep = asp.sweep(rough, body, [100.0, 200.0], check=False)
    next(sweep)
    child = os.fork()
    if child == 0:
        code = 1
        try:
            assert begun.run(check=False) == alone
            assert asp.load_path(rough, body, area_fraction=0.4).run(check=False) == alone
            assert asp.solve(rough, body, load=100.0, check=False).load == 100.0
            try:
                next(sweep)
            except asp.AsperityError as error:
                assert "child" in str(error)
                code = 0
        finally:
            os._exit(code)
    deadline = time.monotonic() + 120.0
    while time.monotonic() < deadline:
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            assert os.waitstatus_to_exitcode(status) == 0
            break
        time.sleep(0.02)
    else:
        os.kill(child, signal.SIGKILL)
        pytest.fail("the child hangs")
    # And the parent goes on.
    assert begun.run(check=False) == alone and next(sweep).load == 200.0


def worker(seed: int) -> int:
    surface = asp.example_surface(nodes=48, seed=seed)
    return len(asp.load_path(surface, asp.HalfSpace(115e9, boundary="free"), area_fraction=0.2).run(check=False))


@pytest.mark.parametrize("method", ["spawn"] + (["fork"] if hasattr(os, "fork") else []))
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_multiprocessing(method: str) -> None:
    import multiprocessing

    asp.load_path(asp.example_surface(nodes=32), asp.HalfSpace(1e9, boundary="free"), nodes=9, check=False).run(check=False)
    with multiprocessing.get_context(method).Pool(2) as pool:
        assert pool.map(worker, range(1, 5)) == [int(0.2 * 48 * 48)] * 4


@pytest.mark.parametrize("way", ["attached", "detached", "interruptible"])
def test_panics_are_exceptions(way: str, capfd: pytest.CaptureFixture[str]) -> None:
    """A mistake in the engine ends no process. With the lock of the interpreter held it is PyO3 that catches it."""
    expected = BaseException if way == "attached" else asp.errors.InternalError
    with pytest.raises(expected, match="on purpose") as caught:
        _asperity._panic_for_tests(way)
    if way != "attached":
        assert isinstance(caught.value, RuntimeError) and "report" in str(caught.value)
    assert "on purpose" in capfd.readouterr().err
    # And the threads go on.
    assert asp.solve(asp.example_surface(nodes=32), asp.HalfSpace(1e9, boundary="free"), load=1.0, check=False).load == 1.0


def test_the_end_of_the_interpreter() -> None:
    """Paths, sweeps and threads that are under way when the interpreter ends."""
    program = textwrap.dedent(
        """
        import threading, asperity as asp
        surface, body = asp.example_surface(nodes=128), asp.HalfSpace(115e9, boundary="free")
        path = asp.load_path(surface, body, area_fraction=0.3)
        next(path)
        sweep = asp.sweep(surface, body, [10.0, 20.0], check=False)
        next(sweep)
        threading.Thread(target=lambda: path.run(check=False), daemon=True).start()
        print("done")
        """
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120, check=False)
    assert (done.returncode, done.stdout.strip(), done.stderr) == (0, "done", "")


def test_a_sweep_in_two_threads() -> None:
    """As a generator, a sweep is for one thread at a time: the other one is told."""
    surface = asp.example_surface(nodes=512)
    sweep = asp.sweep(surface, asp.HalfSpace(115e9, boundary="free"), [1e4, 2e4], check=False)
    with ThreadPoolExecutor(2) as threads:
        both = [threads.submit(next, sweep) for _ in range(2)]
        refused = [run.exception() for run in both]
    assert sorted(error is None for error in refused) == [False, True]
    assert any(isinstance(error, asp.AsperityError) and "another thread" in str(error) for error in refused)
    assert next(sweep).load == 2e4


@pytest.mark.skipif(not POSIX, reason="signals of POSIX")
def test_handlers_of_signals_may_ask_what_is_under_way(long_path: asp.LoadingPath) -> None:
    """A handler runs in the middle of a path and of a sweep, in the same thread: nothing is locked then."""
    surface = asp.example_surface(nodes=512)
    sweep = asp.sweep(surface, asp.HalfSpace(115e9, boundary="free"), [1e4, 2e4], check=False)
    told: list[str] = []
    solved: list[asp.Solution] = []

    def in_a_path(number: int, frame: object) -> None:
        told.append(f"path {len(long_path.history)} {next(long_path).step} {long_path.pressure().max()}")

    def in_a_sweep(number: int, frame: object) -> None:
        with pytest.raises(asp.AsperityError, match="solving already"):
            next(sweep)
        told.append("sweep")

    def both() -> asp.Solution:
        solved.append(next(sweep))
        return next(sweep)

    before = signal.getsignal(signal.SIGUSR1)
    try:
        signal.signal(signal.SIGUSR1, in_a_path)
        signal_when(lambda: len(long_path.history) > 100, signal.SIGUSR1)
        assert long_path.run(check=False) is not None
        signal.signal(signal.SIGUSR1, in_a_sweep)
        signal_when(lambda: solved, signal.SIGUSR1)
        assert both().load == 2e4
    finally:
        signal.signal(signal.SIGUSR1, before)
    assert [words.split()[0] for words in told] == ["path", "sweep"]
    # The state that the handler took is in the history too.
    assert len(long_path.history) == int(0.35 * 160 * 160)
