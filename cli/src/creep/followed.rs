//! The states over time, in closed form or in steps.

use std::path::Path;

use asperity::bed::Bed;
use asperity::creep::{ControlHistory, Creep, CreepState, Relaxation, ViscoelasticBed};
use asperity::leak::{Leak, Seal};
use asperity::patches::Connectivity;
use asperity::record::LoadingRecord;
use asperity::{BedError, ContactEvent, CreepError, Error, LoadingPath};
use asperity_cli::number::{at_least, quantity};
use asperity_cli::outcome::Failure;
use asperity_cli::units;

use super::course::Task;
use crate::passages::{self, Passage};
use crate::path::fields::Fields;
use crate::shell;

/// A history that has been followed.
pub(super) struct Followed<'a> {
    pub(super) states: Vec<CreepState>,
    pub(super) method: Method,
    /// When each state of the path was reached for the first time.
    pub(super) times: Vec<f64>,
    /// When contact recedes for the first time.
    pub(super) recedes: Option<f64>,
    /// Until when the path is enough, if it is not to the end.
    pub(super) enough_until: Option<f64>,
    solution: Solution<'a>,
}

/// How the states were found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Method {
    ClosedForm,
    Steps {
        count: usize,
        halvings: usize,
        /// Of approach and area, relative to their greatest: a third of what steps twice as long change.
        error: f64,
    },
}

/// What the last fields are made of.
enum Solution<'a> {
    Creep(Creep<'a>),
    Relaxation(Relaxation<'a>),
    Bed(Box<ViscoelasticBed<'a>>),
}

/// States up to some time.
struct Part {
    states: Vec<CreepState>,
    /// That the path ended before the last, and when, if that is known.
    enough_until: Option<Option<f64>>,
}

impl<'a> Followed<'a> {
    pub(super) fn new(bed: &'a Bed<'a>, task: &Task) -> Result<Self, Failure> {
        Self::along(bed, task).map_err(|error| Failure::new("cannot follow the history", error))
    }

    /// When contact percolates and when the gap seals, in the order of contact of the path.
    pub(super) fn passages(
        &self,
        record: &LoadingRecord,
        connectivity: Connectivity,
    ) -> Result<[Passage<f64>; 4], Error> {
        let states = record.states();
        let contact = record.history().contact_sequence(record.grid())?;
        // The states at which nodes touch, among all.
        let touches = states.iter().enumerate();
        let touches = touches.filter(|(_, state)| state.event == ContactEvent::Touch);
        let touches: Vec<usize> = touches.map(|(k, _)| k).collect();
        let boundary = record.kernel().boundary;
        Ok(passages::from_end_to_end(&contact, boundary, connectivity, |nodes| {
            let knot = touches.get(nodes.checked_sub(1)?)?;
            self.times.get(*knot).copied()
        }))
    }

    fn along(bed: &'a Bed<'a>, task: &Task) -> Result<Self, Error> {
        let times = task.steps.times(&task.prony, task.course.corners(), task.end)?;
        let (solution, recedes, knots) = match &task.course {
            ControlHistory::Load(load) => {
                let creep = Creep::new(bed, &task.prony, load)?;
                let recedes = creep.recession().map(|recession| recession.time);
                let recedes =
                    recedes.filter(|time| *time < task.end || has_receded(creep.at(task.end)));
                let knots = creep.times();
                (Solution::Creep(creep), recedes, knots)
            }
            ControlHistory::Approach(approach) => {
                let relaxation = Relaxation::new(bed, &task.prony, approach)?;
                let (recedes, knots) = (relaxation.recession(), relaxation.times());
                let recedes =
                    recedes.filter(|time| *time < task.end || has_receded(relaxation.at(task.end)));
                (Solution::Relaxation(relaxation), recedes, knots)
            }
        };
        if recedes.is_some() {
            return Self::stepped(bed, task, &times, (recedes, knots));
        }
        let Part { states, enough_until } = match &solution {
            Solution::Creep(creep) => grown(&times, |time| creep.at(time))?,
            Solution::Relaxation(relaxation) => grown(&times, |time| relaxation.at(time))?,
            Solution::Bed(_) => Part { states: Vec::new(), enough_until: None },
        };
        // The approach of a path ends with its last knot.
        let enough_until =
            enough_until.map(|until| until.or(knots.last().copied()).unwrap_or_default());
        let until = enough_until.unwrap_or(task.end);
        let times = knots.into_iter().filter(|time| *time <= until).collect();
        Ok(Self { states, method: Method::ClosedForm, times, recedes, enough_until, solution })
    }

    /// In steps, and once more in steps twice as long.
    fn stepped(
        bed: &'a Bed<'a>,
        task: &Task,
        times: &[f64],
        (recedes, knots): (Option<f64>, Vec<f64>),
    ) -> Result<Self, Error> {
        let middles = times.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
        let mut fine: Vec<f64> = Vec::with_capacity(2 * times.len());
        for (time, middle) in times.iter().zip(middles.map(Some).chain([None])) {
            fine.push(*time);
            fine.extend(middle);
        }
        let mut contact = ViscoelasticBed::new(bed, &task.prony)?;
        let Part { states, enough_until } = through(&mut contact, &task.course, &fine)?;
        let mut coarse = ViscoelasticBed::new(bed, &task.prony)?;
        let rough = through(&mut coarse, &task.course, times)?.states;
        let mut reached = knots;
        for state in &states {
            // First to touch in this step.
            reached.resize(reached.len().max(state.contact_nodes), state.time);
        }
        let count = states.len().saturating_sub(1);
        let states: Vec<CreepState> = states.into_iter().step_by(2).collect();
        let error = difference(&states, &rough) / 3.0;
        Ok(Self {
            states,
            method: Method::Steps { count, halvings: contact.halvings(), error },
            times: reached,
            recedes,
            enough_until: enough_until.map(Option::unwrap_or_default),
            solution: Solution::Bed(Box::new(contact)),
        })
    }

    /// `Ok` if the path was long enough.
    pub(super) fn whole(&self, bed: &Bed, task: &Task, record: &Path) -> Result<(), Failure> {
        let Some(until) = self.enough_until else {
            return Ok(());
        };
        let reached = match self.states.is_empty() {
            true => {
                "the path ends below what this history needs, from its beginning on".to_string()
            }
            false => format!(
                "the path is enough until t = {}, and not to {}",
                units::time(until),
                units::time(task.end)
            ),
        };
        let failure = Failure::request(reached);
        let file = shell::quoted(record.as_os_str());
        let further = match (&self.solution, &task.course) {
            (Solution::Creep(creep), _) => {
                format!("--max-load {}", at_least(creep.effective_load(task.end), 5))
            }
            (_, ControlHistory::Approach(approach)) => {
                if let Some(closest) = closest(bed) {
                    return Err(failure.with_advice(&format!(
                        "mean planes come no closer than in full contact, where they are at an approach of {}",
                        quantity(closest, "m", 5)
                    )));
                }
                let values = approach.corners().iter().map(|corner| corner.1);
                format!("--max-approach {}", at_least(values.fold(0.0, f64::max), 5))
            }
            // To full contact, behind which all is linear.
            (_, ControlHistory::Load(_)) => "--max-area-fraction 1".to_string(),
        };
        Err(failure.with_advice(&format!(
            "`asperity path --resume {file} --record {file} {further}` takes it further"
        )))
    }

    /// Pressure and gap of the last state.
    pub(super) fn fields(
        &self,
        record: &LoadingRecord,
        bed: &Bed,
        pieces: u32,
    ) -> Result<Fields, Failure> {
        let failed = |error| Failure::new("cannot compute the fields of the last state", error);
        let made = self.last_fields(record, bed, pieces as usize);
        made.map_err(failed)
    }

    /// The leak at a time, before contact recedes.
    pub(super) fn leak(
        &self,
        seal: &Seal,
        path: &mut LoadingPath,
        state: &CreepState,
    ) -> Result<Leak, Error> {
        let time = state.time;
        let (gap, elastic) = match &self.solution {
            Solution::Creep(creep) => {
                let elastic = creep.path_state(time)?;
                (path.fields_at(&elastic)?.gap, elastic)
            }
            Solution::Relaxation(relaxation) => {
                (relaxation.gap(time, path)?, relaxation.path_state(time)?)
            }
            Solution::Bed(_) => {
                return Err(CreepError::ContactRecedes {
                    time: self.recedes.unwrap_or(time),
                    effective_load: state.effective_load,
                }
                .into());
            }
        };
        let mut contact_map = path.contact_map_at(&elastic)?;
        if state.contact_nodes == 0 {
            contact_map.fill(false);
        }
        seal.leak(&gap, &contact_map, (&path.grid(), path.problem().boundary()))
    }

    fn last_fields(
        &self,
        record: &LoadingRecord,
        bed: &Bed,
        pieces: usize,
    ) -> Result<Fields, Error> {
        let mut path = record.replay()?;
        let Some(last) = self.states.last() else {
            return Ok(Vec::new());
        };
        let (pressure, gap) = match &self.solution {
            Solution::Creep(creep) => (
                creep.pressure(last.time, pieces)?,
                path.fields_at(&creep.path_state(last.time)?)?.gap,
            ),
            Solution::Relaxation(relaxation) => {
                (relaxation.pressure(last.time, pieces)?, relaxation.gap(last.time, &mut path)?)
            }
            Solution::Bed(contact) => (contact.pressure(pieces)?, contact.gap(pieces, &mut path)?),
        };
        let pressure = pressure.pressure(bed, &mut path)?;
        Ok(vec![("pressure", pressure), ("gap", gap)])
    }
}

/// Whether contact has receded at a time, as it has where the load falls at once.
fn has_receded(state: Result<CreepState, Error>) -> bool {
    matches!(state, Err(Error::Creep(CreepError::ContactRecedes { .. })))
}

/// The approach of the mean planes in full contact, if the path is there.
fn closest(bed: &Bed) -> Option<f64> {
    let last = bed.history().states().last()?.contact;
    let is_closest = last.contact_stiffness.is_none() && last.interfacial_stiffness?.is_infinite();
    is_closest.then_some(last.approach)
}

/// The states up to where the path ends; when that is, if the error says so.
fn grown(times: &[f64], at: impl Fn(f64) -> Result<CreepState, Error>) -> Result<Part, Error> {
    let mut states = Vec::with_capacity(times.len());
    for &time in times {
        match at(time) {
            Ok(state) => states.push(state),
            Err(Error::Creep(CreepError::PathEnds { until, .. })) => {
                return Ok(Part { states, enough_until: Some(Some(until)) });
            }
            Err(Error::Bed(BedError::PathEndsBefore { .. })) => {
                return Ok(Part { states, enough_until: Some(None) });
            }
            Err(error) => return Err(error),
        }
    }
    Ok(Part { states, enough_until: None })
}

/// The same by the bed.
fn through(
    contact: &mut ViscoelasticBed,
    course: &ControlHistory,
    times: &[f64],
) -> Result<Part, Error> {
    let mut states: Vec<CreepState> = Vec::with_capacity(times.len());
    for &time in times {
        match contact.follow(course, &[time]) {
            Ok(now) => states.extend(now),
            Err(Error::Creep(CreepError::BedEnds { .. })) => {
                let until = states.last().map(|state| state.time);
                return Ok(Part { states, enough_until: Some(until) });
            }
            Err(error) => return Err(error),
        }
    }
    Ok(Part { states, enough_until: None })
}

/// The greatest difference of approaches and areas at the same times, over the greatest of each.
fn difference(states: &[CreepState], others: &[CreepState]) -> f64 {
    let quantities: [fn(&CreepState) -> f64; 2] =
        [|state| state.approach, |state| state.contact_area_fraction];
    let of = |quantity: &fn(&CreepState) -> f64| {
        let pairs = states.iter().zip(others);
        let error = pairs.map(|(a, b)| (quantity(a) - quantity(b)).abs()).fold(0.0, f64::max);
        let greatest = states.iter().map(|state| quantity(state).abs()).fold(0.0, f64::max);
        if greatest > 0.0 { error / greatest } else { 0.0 }
    };
    quantities.iter().map(of).fold(0.0, f64::max)
}
