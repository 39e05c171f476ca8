//! Many loads, each from the ones before.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;

use asperity::fixed_load::FixedLoadSolution;
use asperity::{ContactTarget, Error};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use pyo3::sync::MutexExt;

use super::{Settings, Solution, solver};
use crate::argument::whole;
use crate::arrays::{Found, Kind};
use crate::compute::{Answers, detached, pool, wait};
use crate::errors::{Failure, Fallible};
use crate::given::warn_of;
use crate::half_space::HalfSpace;
use crate::history::Setting;
use crate::surface::Surface;
use crate::targets::Targets;
use crate::warnings::{of_contact, warn_all};

/// What the thread of a sweep sends.
type Solved = Result<Result<FixedLoadSolution, Error>, String>;

/// The contact at a sequence of loads: an iterator of `Solution`, made by `sweep`.
///
/// Each is solved when it is asked for, from the ones before, and as exact as if it were alone. After Ctrl-C the solution
/// that was under way comes next.
#[pyclass(frozen, module = "asperity")]
pub(crate) struct LoadSweep {
    thread: Mutex<Thread>,
    count: usize,
    setting: Setting,
    e_star: Option<f64>,
    check: bool,
}

/// The thread that solves: the states that it goes on from borrow their solver, so that both live there.
struct Thread {
    process: u32,
    /// Asks for one more solution.
    ask: Sender<()>,
    answers: Option<Answers<Solved>>,
    /// Whether a solution was asked for and has not come yet.
    is_asked: bool,
    /// A solution whose warnings were made errors: it comes next.
    kept: Option<FixedLoadSolution>,
    left: usize,
}

#[pymethods]
impl LoadSweep {
    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __len__(&self) -> usize {
        self.count
    }

    fn __next__(&self, py: Python<'_>) -> Fallible<Option<Solution>> {
        // Not locked while it waits: a handler of signals may ask for this sweep too.
        let mut answers = {
            let mut thread = self.lock(py);
            if let Some(kept) = thread.kept.take() {
                return Ok(Some(Solution::new(kept, self.setting)));
            }
            if thread.left == 0 {
                return Ok(None);
            }
            if thread.process != std::process::id() {
                return Err(Failure::arguments(
                    "a sweep does not go on in a child process, which has none of the threads of its parent: make it there",
                ));
            }
            let Some(answers) = thread.answers.take() else {
                return Err(Failure::arguments("this sweep is solving already, in another thread"));
            };
            if !thread.is_asked {
                // A thread that has ended answers no more.
                thread.is_asked = thread.ask.send(()).is_ok();
            }
            Some(answers)
        };
        let solved = wait(py, &mut answers);
        {
            let mut thread = self.lock(py);
            thread.answers = answers;
            match &solved {
                // Interrupted: what is under way comes next.
                Err(_) => {}
                Ok(Some(Ok(Ok(_)))) => {
                    thread.is_asked = false;
                    thread.left -= 1;
                }
                // A sweep ends with its first error.
                _ => thread.left = 0,
            }
        }
        match solved? {
            Some(Ok(Ok(solution))) => {
                if let Err(error) = self.warn(py, &solution) {
                    self.lock(py).kept = Some(solution);
                    return Err(error);
                }
                Ok(Some(Solution::new(solution, self.setting)))
            }
            Some(Ok(Err(error))) => Err(error.into()),
            Some(Err(panic)) => Err(Failure::Panic(panic)),
            None => Ok(None),
        }
    }
}

impl LoadSweep {
    /// What looks wrong with a solution, if that was asked for.
    fn warn(&self, py: Python<'_>, solution: &FixedLoadSolution) -> Fallible<()> {
        if !self.check {
            return Ok(());
        }
        let e_star = self.e_star.filter(|_| solution.contact.plastic.is_none());
        let on = (&self.setting.grid, self.setting.boundary);
        let fields = &solution.fields;
        let found =
            detached(py, || of_contact(&fields.pressure, &fields.contact_map, on, e_star))??;
        warn_all(py, found)
    }

    fn lock(&self, py: Python<'_>) -> MutexGuard<'_, Thread> {
        self.thread.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner)
    }
}

/// Solve for the contact at a sequence of loads, mean pressures, approaches, areas or mean gaps.
///
/// Parameters
/// ----------
/// surface : Surface
///     Without missing nodes.
/// half_space : HalfSpace
/// load, mean_pressure, approach, area_fraction, mean_gap : array_like of float
///     One of them [N, Pa, m, -, m], in any order: the closer each is to the one before, the faster.
/// stiffness, hardness, tolerance, max_iterations, memory_budget, check
///     As of `solve`.
///
/// Returns
/// -------
/// LoadSweep
///     An iterator of `Solution`.
///
/// Examples
/// --------
/// >>> import asperity as asp
/// >>> surface = asp.example_surface(nodes=64)
/// >>> half_space = asp.HalfSpace(115e9, boundary="free")
/// >>> [one.contact_nodes > 0 for one in asp.sweep(surface, half_space, [10.0, 20.0], check=False)]
/// [True, True]
#[pyfunction]
#[pyo3(signature = (surface, half_space, load=None, *, mean_pressure=None, approach=None, area_fraction=None, mean_gap=None, stiffness=true, hardness=None, tolerance=1e-8, max_iterations=5000, memory_budget=None, check=true))]
#[allow(clippy::too_many_arguments)] // each is a keyword
fn sweep(
    py: Python<'_>,
    surface: PyRef<'_, Surface>,
    half_space: PyRef<'_, HalfSpace>,
    load: Option<&Bound<'_, PyAny>>,
    mean_pressure: Option<&Bound<'_, PyAny>>,
    approach: Option<&Bound<'_, PyAny>>,
    area_fraction: Option<&Bound<'_, PyAny>>,
    mean_gap: Option<&Bound<'_, PyAny>>,
    stiffness: bool,
    hardness: Option<&Bound<'_, PyAny>>,
    tolerance: f64,
    #[pyo3(from_py_with = whole)] max_iterations: usize,
    #[pyo3(from_py_with = whole)] memory_budget: Option<usize>,
    check: bool,
) -> Fallible<LoadSweep> {
    let grid = *surface.grid();
    let given = [load, mean_pressure, approach, area_fraction, mean_gap];
    let place = given.iter().position(Option::is_some);
    let (Some(place), 1) = (place, given.iter().flatten().count()) else {
        return Err(Failure::arguments(
            "give one of load, mean_pressure, approach, area_fraction and mean_gap, as a list of numbers",
        ));
    };
    let names = ["load", "mean_pressure", "approach", "area_fraction", "mean_gap"];
    let Some(values) = given[place] else {
        return Err(Failure::arguments("nothing is asked for"));
    };
    let values = Found::of(values, names[place], Kind::Real)?.list()?;
    let targets = values.into_iter().map(|value| {
        let mut target = Targets::default();
        let slots = [
            &mut target.load,
            &mut target.mean_pressure,
            &mut target.approach,
            &mut target.area_fraction,
            &mut target.mean_gap,
        ];
        if let Some(slot) = slots.into_iter().nth(place) {
            *slot = Some(value);
        }
        target.only()
    });
    let targets: Vec<ContactTarget> = targets.collect::<Fallible<_>>()?;
    if check {
        warn_of(py, &surface, &half_space, hardness)?;
    }
    let settings = Settings { tolerance, max_iterations, stiffness, memory_budget };
    let mut solver = solver(py, &surface, &half_space, hardness, &settings)?;
    let (count, threads) = (targets.len(), pool(py)?);
    let (ask, asked) = channel::<()>();
    let (answer, answers) = channel::<Solved>();
    let solve = move || {
        let mut sweep = solver.sweep(targets);
        while asked.recv().is_ok() {
            let next = catch_unwind(AssertUnwindSafe(|| threads.install(|| sweep.next())));
            let answered = match next {
                Ok(None) => break,
                Ok(Some(solved)) => answer.send(Ok(solved)),
                Err(_) => answer.send(Err("while a sweep was solved".to_string())),
            };
            if answered.is_err() {
                break;
            }
        }
    };
    let thread = thread::Builder::new().name("asperity-sweep".to_string()).spawn(solve);
    thread.map_err(|error| PyOSError::new_err(format!("no thread is to be had: {error}")))?;
    let has_hardness = hardness.is_some();
    Ok(LoadSweep {
        thread: Mutex::new(Thread {
            process: std::process::id(),
            ask,
            answers: Some(Answers::new(answers)),
            is_asked: false,
            kept: None,
            left: count,
        }),
        count,
        setting: Setting { grid, boundary: half_space.surroundings(), has_hardness },
        e_star: half_space.modulus(),
        check,
    })
}

pub(super) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<LoadSweep>()?;
    module.add_function(wrap_pyfunction!(sweep, module)?)
}
