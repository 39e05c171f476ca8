//! Computing without the lock of the interpreter, on threads that belong to this process.

use std::fmt::Display;
use std::mem;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use parking_lot::{Mutex as FairMutex, MutexGuard as FairGuard};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use pyo3::sync::MutexExt;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::argument::whole;
use crate::errors::{Failure, Fallible};

/// How long signals wait while something is computed elsewhere.
const PAUSE: Duration = Duration::from_millis(20);

/// The threads, and the process that they belong to.
struct Threads {
    process: u32,
    pool: Arc<ThreadPool>,
}

static THREADS: Mutex<Option<Threads>> = Mutex::new(None);

/// The threads of this process.
pub(crate) fn pool(py: Python<'_>) -> Fallible<Arc<ThreadPool>> {
    let mut threads = THREADS.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    match &*threads {
        Some(threads) if threads.process == process => Ok(Arc::clone(&threads.pool)),
        _ => {
            let pool = made(0)?;
            // A child has none of the threads of its parent, and so nothing to wait for at their end.
            mem::forget(threads.replace(Threads { process, pool: Arc::clone(&pool) }));
            Ok(pool)
        }
    }
}

/// So many threads; 0 for as many as there are processors, or as `RAYON_NUM_THREADS` says.
fn made(count: usize) -> Fallible<Arc<ThreadPool>> {
    let pool = ThreadPoolBuilder::new().num_threads(count).build();
    Ok(Arc::new(pool.map_err(refused)?))
}

fn refused(error: impl Display) -> PyErr {
    PyOSError::new_err(format!("no threads are to be had: {error}"))
}

/// Does work without the lock of the interpreter, so that other threads of Python go on.
pub(crate) fn detached<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> Fallible<T> {
    let pool = pool(py)?;
    let done = py.detach(|| catch_unwind(AssertUnwindSafe(|| pool.install(work))));
    done.map_err(|payload| Failure::of_panic(&*payload))
}

/// Does long work, and looks at signals meanwhile: Ctrl-C ends the wait, and what is computed by then is lost.
pub(crate) fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> Fallible<T> {
    interruptible_with(py, &Arc::default(), move |_: &mut ()| work())
}

/// The same with what is locked meanwhile, to the end of the work and not only of the wait.
pub(crate) fn interruptible_with<L: Send + 'static, T: Send + 'static>(
    py: Python<'_>,
    lock: &Arc<FairMutex<L>>,
    work: impl FnOnce(&mut L) -> T + Send + 'static,
) -> Fallible<T> {
    let (send, receive) = mpsc::channel();
    let (pool, lock) = (pool(py)?, Arc::clone(lock));
    // Who holds the lock may wait for all threads of the pool: none of them waits for the lock.
    let begun = thread::Builder::new().spawn(move || {
        let done = catch_unwind(AssertUnwindSafe(|| {
            let mut locked = lock.lock();
            let locked = &mut *locked;
            pool.install(|| work(locked))
        }));
        // Nobody listens after an interruption.
        let _ = send.send(done);
    });
    begun.map_err(refused)?;
    let mut waiting = Some(Answers::new(receive));
    let done = wait(py, &mut waiting)?;
    match done {
        Some(done) => done.map_err(|payload| Failure::of_panic(&*payload)),
        None => Err(Failure::Panic("the thread has ended without an answer".to_string())),
    }
}

/// The same for work in parts, which is told when nobody waits for it any more.
pub(crate) fn cancellable<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&AtomicBool) -> T + Send + 'static,
) -> Fallible<T> {
    let is_left = Arc::new(AtomicBool::new(false));
    let told = Arc::clone(&is_left);
    interruptible(py, move || work(&told)).inspect_err(|_| is_left.store(true, Ordering::Relaxed))
}

/// Waits for a lock without the interpreter, and looks at signals in between.
pub(crate) fn locked<'a, T: Send>(
    py: Python<'_>,
    lock: &'a FairMutex<T>,
) -> Fallible<FairGuard<'a, T>> {
    loop {
        if let Some(guard) = lock.try_lock() {
            return Ok(guard);
        }
        if let Some(guard) = py.detach(|| lock.try_lock_for(PAUSE)) {
            return Ok(guard);
        }
        py.check_signals()?;
    }
}

/// What a thread sends.
pub(crate) struct Answers<T> {
    receive: Receiver<T>,
    /// Came together with a signal.
    kept: Option<T>,
}

impl<T> Answers<T> {
    pub(crate) fn new(receive: Receiver<T>) -> Self {
        Self { receive, kept: None }
    }

    fn next(&mut self) -> Result<T, RecvTimeoutError> {
        self.kept.take().map_or_else(|| self.receive.recv_timeout(PAUSE), Ok)
    }
}

/// Waits for what a thread sends, and looks at signals meanwhile; `None` if it sends nothing more. After a signal the answers are
/// still there, also one that came with the signal.
pub(crate) fn wait<T: Send>(
    py: Python<'_>,
    waiting: &mut Option<Answers<T>>,
) -> Fallible<Option<T>> {
    loop {
        // A receiver may be sent to another thread and not shared.
        let Some(mut answers) = waiting.take() else {
            return Ok(None);
        };
        let (received, answers) = py.detach(move || (answers.next(), answers));
        let answers = waiting.insert(answers);
        let signals = py.check_signals();
        match received {
            Ok(value) if signals.is_err() => answers.kept = Some(value),
            Ok(value) => return Ok(Some(value)),
            Err(RecvTimeoutError::Disconnected) if signals.is_ok() => return Ok(None),
            Err(_) => {}
        }
        signals?;
    }
}

/// Number of threads that computations use.
///
/// Returns
/// -------
/// int
///     As many as there are processors, unless `RAYON_NUM_THREADS` or `set_threads` says otherwise. Results are the same
///     bit for bit with any number.
#[pyfunction]
fn threads(py: Python<'_>) -> Fallible<usize> {
    Ok(pool(py)?.current_num_threads())
}

/// Computes with another number of threads from now on.
///
/// Parameters
/// ----------
/// count : int
///     Number of threads, at least 1. Results are the same bit for bit with any number.
#[pyfunction]
fn set_threads(py: Python<'_>, #[pyo3(from_py_with = whole)] count: usize) -> Fallible<()> {
    if !(1..=4096).contains(&count) {
        return Err(asperity::Error::OutOfRange {
            quantity: "number of threads",
            value: count as f64,
            expected: "from 1 to 4096",
        }
        .into());
    }
    let pool = made(count)?;
    let process = std::process::id();
    let mut threads = THREADS.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner);
    match threads.replace(Threads { process, pool }) {
        Some(old) if old.process != process => mem::forget(old),
        _ => {}
    }
    Ok(())
}

/// Panics, with the lock of the interpreter or without it, for the test that no panic ends a process.
#[pyfunction]
#[allow(clippy::panic)]
fn _panic_for_tests(py: Python<'_>, way: &str) -> Fallible<()> {
    match way {
        "detached" => detached(py, || panic!("on purpose")),
        "interruptible" => interruptible(py, || panic!("on purpose")),
        _ => panic!("on purpose"),
    }
}

pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(threads, module)?)?;
    module.add_function(wrap_pyfunction!(set_threads, module)?)?;
    module.add_function(wrap_pyfunction!(_panic_for_tests, module)?)
}
