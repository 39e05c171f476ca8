//! Following both branches, and their files.

use std::path::{Path, PathBuf};
use std::time::Instant;

use asperity::adhesion::{AdhesiveBranch, AdhesiveEnd, AdhesivePath, AdhesiveState, Direction};
use asperity::contact::ContactTarget;
use asperity::record::AdhesiveRecord;
use asperity_cli::number::{counted, quantity, scientific};
use asperity_cli::outcome::Failure;
use indicatif::ProgressBar;
use nalgebra::DMatrix;

use super::super::follow::bar;
use super::super::interrupt::Interrupt;
use super::super::job::Job;
use super::super::lines::{Lines, STRIDE, printed};
use super::super::options::Options;
use super::is_there;
use crate::at::At;

const HEADER: &str = "step,ix,iy,event,approach,load,contact_area,contact_area_fraction,mean_gap,contact_stiffness,\
                      interfacial_stiffness,branch,soft_nodes,cohesive_nodes,elastic_energy,adhesive_energy,dissipated,work";

/// Why a path ends that goes on from a record without being pressed further.
const OF_RECORD: &str = "the end of loading in the record";

/// A path that has been followed.
pub(super) struct Followed {
    pub(super) path: AdhesivePath,
    /// Of both branches.
    pub(super) states: Vec<AdhesiveState>,
    /// States that were asked for, and those that were not reached.
    pub(super) reached: Vec<(At, AdhesiveState)>,
    pub(super) missed: Vec<At>,
    /// Why loading has ended, `None` if it was broken off.
    pub(super) ended_by: Option<&'static str>,
}

impl Followed {
    /// The last branch of loading, and that of unloading behind it. A record may have more of both before.
    pub(super) fn branches(&self) -> [AdhesiveBranch; 2] {
        let states = &self.states[self.turn()..];
        [Direction::Loading, Direction::Unloading].map(|direction| {
            states.iter().filter(|state| state.direction == direction).copied().collect()
        })
    }

    /// The state from which the last branch of loading begins, if it does not begin from where the surfaces are apart.
    pub(super) fn before_loading(&self) -> Option<AdhesiveState> {
        Some(self.states[self.turn().checked_sub(1)?])
    }

    /// How many states there are before the last branch of loading.
    fn turn(&self) -> usize {
        let turns = |pair: &[AdhesiveState]| {
            [Direction::Unloading, Direction::Loading] == [pair[0].direction, pair[1].direction]
        };
        self.states.windows(2).rposition(turns).map_or(0, |before| before + 1)
    }

    /// The last state of loading.
    pub(super) fn pressed(&self) -> Option<AdhesiveState> {
        let loading = |state: &&AdhesiveState| state.direction == Direction::Loading;
        self.states.iter().rev().find(loading).copied()
    }

    /// Writes the record of both branches, and fields of the last state of loading.
    pub(super) fn save(
        &self,
        name: &Path,
        fields: &[(&str, DMatrix<f64>)],
    ) -> Result<PathBuf, Failure> {
        save(name, &self.path, &self.states, fields)
    }
}

fn save(
    name: &Path,
    path: &AdhesivePath,
    states: &[AdhesiveState],
    fields: &[(&str, DMatrix<f64>)],
) -> Result<PathBuf, Failure> {
    let fields: Vec<_> = fields.iter().map(|(name, field)| (*name, field)).collect();
    AdhesiveRecord::new(path, states.iter().copied().collect())
        .and_then(|record| record.write_npz(name, &fields))
        .map(|()| name.to_path_buf())
        .map_err(|error| Failure::writing(name, error))
}

/// What a record has of a path already.
pub(super) struct Begun {
    reached: Vec<(At, AdhesiveState)>,
    missed: Vec<At>,
    /// Why loading has ended, `None` if it goes on.
    ended_by: Option<&'static str>,
}

impl Begun {
    /// Without a record, nothing.
    ///
    /// # Errors
    ///
    /// A record that has passed a state that is asked for and does not have it, or is beyond where the path is to end.
    pub(super) fn of(job: &Job, options: &Options) -> Result<Self, Failure> {
        let (grid, begun) = (job.grid(), states_of(job));
        let branch = present_loading(begun, options.unload);
        let pending = job.begun_with_adhesion().and_then(AdhesiveRecord::pending);
        let has_no_end = job.targets().is_empty();
        let ended_by = match pending {
            Some((Direction::Unloading, _)) if has_no_end && !options.unload => {
                return Err(Failure::request(
                    "the path of the record was on its way back: give --unload to go on, or an end of loading to press \
                     the surfaces together again",
                ));
            }
            None if has_no_end => Some(OF_RECORD),
            _ => end_of(branch, job, options)?,
        };
        let (mut reached, mut missed) = (Vec::new(), Vec::new());
        for at in job.at() {
            let target = at.target(grid.nominal_area());
            match super::reached(branch, (&target, &at.to_string()), &grid)? {
                Some(state) => reached.push((*at, *state)),
                None => missed.push(*at),
            }
        }
        // A record that was unloading goes on with that.
        let is_back = |state: &AdhesiveState| state.direction == Direction::Unloading;
        let is_turned = options.unload && begun.last().is_some_and(is_back);
        let is_full =
            branch.last().is_some_and(|state| state.contact.contact_nodes == grid.nodes());
        let sticks = job.law().is_some_and(|law| law.adhesion().given().0 > 0.0);
        // With all nodes in contact there is more to come of loads and approaches alone, and nothing without adhesion.
        let may_come = |target: &&ContactTarget| {
            let of_gaps =
                matches!(target, ContactTarget::AreaFraction(_) | ContactTarget::MeanGap(_));
            !is_full || (sticks && !of_gaps)
        };
        let next = job.targets().iter().find(may_come);
        if let (true, None, Some(target)) = (is_turned, ended_by, next) {
            return Err(Failure::request(format!(
                "the path of the record was on its way back and has not come to {}: without --unload it goes there",
                named(target)
            )));
        }
        Ok(Self { reached, missed, ended_by: ended_by.or(is_turned.then_some(OF_RECORD)) })
    }
}

/// The states of the record that a path goes on from.
fn states_of(job: &Job) -> &[AdhesiveState] {
    job.begun_with_adhesion().map_or(&[], |record| record.states().states())
}

/// A path as far as it has come, with its files.
pub(super) struct Course<'a> {
    job: &'a Job,
    followed: Followed,
    lines: Lines,
    /// The record, and the states after which it is written.
    saves: Option<(PathBuf, usize)>,
    is_done: bool,
}

impl<'a> Course<'a> {
    pub(super) fn new(
        job: &'a Job,
        path: AdhesivePath,
        options: &Options,
    ) -> Result<Self, Failure> {
        let record = job.record().map(Path::to_path_buf);
        let Begun { reached, missed, ended_by } = Begun::of(job, options)?;
        let begun = states_of(job);
        let mut lines = Lines::create(&options.out, HEADER)?;
        begun.iter().try_for_each(|state| lines.add(&line(state)))?;
        Ok(Self {
            job,
            followed: Followed { path, states: begun.to_vec(), reached, missed, ended_by },
            lines,
            saves: record.zip(options.save_every.map(usize::from)),
            is_done: false,
        })
    }

    /// Whether all of it has been followed.
    pub(super) fn is_done(&self) -> bool {
        self.is_done
    }

    /// The path, and its file.
    pub(super) fn end(self) -> (Followed, Lines) {
        (self.followed, self.lines)
    }

    /// Runs the path to its end, and back, or until it is asked to stop, writing each state as it comes.
    pub(super) fn follow(&mut self, interrupt: &Interrupt, unloads: bool) -> Result<(), Failure> {
        let bar = bar();
        interrupt.wait();
        let done = match self.followed.ended_by {
            Some(_) => Ok(()),
            None => self.resume().and_then(|()| self.load(interrupt, &bar)),
        };
        let done = done.and_then(|()| match unloads && !interrupt.is_asked() {
            true => self.unload(interrupt, &bar),
            false => Ok(()),
        });
        bar.finish_and_clear();
        self.is_done = !interrupt.is_asked();
        done
    }

    /// Lets the path of a record go on to where this one is to end.
    fn resume(&mut self) -> Result<(), Failure> {
        if self.job.begun_with_adhesion().is_none() {
            return Ok(());
        }
        let turned = self.followed.path.load_to_first_of(&self.targets());
        turned.map_err(|error| Failure::new("cannot go on", error))
    }

    /// The branch of loading, to each state that is asked for in turn.
    fn load(&mut self, interrupt: &Interrupt, bar: &ProgressBar) -> Result<(), Failure> {
        let (job, grid) = (self.job, self.job.grid());
        let nominal_area = grid.nominal_area();
        loop {
            self.branch(interrupt, bar)?;
            let (Some(state), Some(end)) = (self.followed.path.state(), self.followed.path.end())
            else {
                return Ok(());
            };
            let mut left = Vec::new();
            for at in std::mem::take(&mut self.followed.missed) {
                match is_there(&at.target(nominal_area), &state.contact, &grid) {
                    true => self.followed.reached.push((at, state)),
                    false => left.push(at),
                }
            }
            self.followed.missed = left;
            let mut ends = job.targets().iter();
            let reached = ends.find(|target| is_there(target, &state.contact, &grid));
            let next = self.targets();
            if let (AdhesiveEnd::Target, None) = (end, reached)
                && !next.is_empty()
            {
                let turned = self.followed.path.load_to_first_of(&next);
                turned.map_err(|error| Failure::new("the path broke off", error))?;
                continue;
            }
            self.followed.ended_by = Some(reached.map_or("no more events", in_words));
            return Ok(());
        }
    }

    /// Where loading has to stop.
    fn targets(&self) -> Vec<ContactTarget> {
        let nominal_area = self.job.grid().nominal_area();
        let missed = self.followed.missed.iter().map(|at| at.target(nominal_area));
        self.job.targets().iter().copied().chain(missed).collect()
    }

    fn unload(&mut self, interrupt: &Interrupt, bar: &ProgressBar) -> Result<(), Failure> {
        let turned = self.followed.path.unload();
        turned.map_err(|error| Failure::new("cannot unload", error))?;
        self.branch(interrupt, bar)
    }

    fn branch(&mut self, interrupt: &Interrupt, bar: &ProgressBar) -> Result<(), Failure> {
        let start = Instant::now();
        let most = self.followed.pressed().map_or(1, |state| state.contact.contact_nodes.max(1));
        while let Some(state) = self.next(interrupt)? {
            if state.step.is_multiple_of(STRIDE) {
                let nodes = state.contact.contact_nodes;
                let progress = match state.direction {
                    Direction::Loading => self.job.progress(&state.contact),
                    Direction::Unloading => self.job.progress_back(nodes, most),
                };
                bar.set_position((100.0 * progress.done) as u64);
                let (load, left) =
                    (scientific(state.contact.load, 3), progress.left(start.elapsed()));
                bar.set_message(format!("{}, W = {load} N{left}", counted(nodes, "node")));
            }
            self.add(state)?;
        }
        Ok(())
    }

    /// The next state of the branch; `None` at its end, or once the path is asked to stop.
    fn next(&mut self, interrupt: &Interrupt) -> Result<Option<AdhesiveState>, Failure> {
        let broke_off = |error| Failure::new("the path broke off", error);
        let path = &mut self.followed.path;
        while !interrupt.is_asked() {
            if path.prepare().map_err(broke_off)? {
                return path.next().transpose().map_err(broke_off);
            }
        }
        Ok(None)
    }

    fn add(&mut self, state: AdhesiveState) -> Result<(), Failure> {
        self.followed.states.push(state);
        self.lines.add(&line(&state))?;
        match &self.saves {
            Some((name, every)) if self.followed.states.len().is_multiple_of(*every) => {
                self.followed.save(name, &[]).map(|_| ())
            }
            _ => Ok(()),
        }
    }
}

/// A state in the file. `{:e}` prints the shortest digits that read back as the same number.
fn line(state: &AdhesiveState) -> String {
    let (contact, (ix, iy)) = (&state.contact, state.node);
    format!(
        "{},{ix},{iy},{},{:e},{:e},{:e},{:e},{:e},{},{},{},{},{},{:e},{:e},{:e},{:e}",
        state.step,
        state.event.name(),
        contact.approach,
        contact.load,
        contact.contact_area,
        contact.contact_area_fraction,
        contact.mean_gap,
        printed(contact.contact_stiffness),
        printed(contact.interfacial_stiffness),
        state.direction.name(),
        state.soft_nodes,
        state.cohesive_nodes,
        contact.energy,
        state.adhesive_energy,
        state.dissipated,
        state.work,
    )
}

/// The last branch of loading of a record, which goes on unless it is unloaded from; empty if a record that was unloaded
/// is pressed on again.
fn present_loading(states: &[AdhesiveState], unloads: bool) -> &[AdhesiveState] {
    let behind_last = |states: &[AdhesiveState], direction| {
        states.iter().rposition(|state| state.direction == direction).map_or(0, |k| k + 1)
    };
    let end = if unloads { behind_last(states, Direction::Loading) } else { states.len() };
    let states = &states[..end];
    &states[behind_last(states, Direction::Unloading)..]
}

/// Why the loading of a record has ended, `None` if it goes on.
///
/// # Errors
///
/// A record that is beyond where the path is to end.
fn end_of(
    branch: &[AdhesiveState],
    job: &Job,
    options: &Options,
) -> Result<Option<&'static str>, Failure> {
    let Some(last) = branch.last() else { return Ok(None) };
    let mut ended_by = None;
    for target in job.targets() {
        let name = named(target);
        match super::reached(branch, (target, &name), &job.grid())? {
            None => {}
            Some(state) if state.step == last.step => ended_by = Some(in_words(target)),
            // Nobody says where the path ends.
            Some(_) if options.has_open_end() => ended_by = Some(OF_RECORD),
            Some(state) => {
                return Err(Failure::request(format!(
                    "the record is beyond {name} already, where the path is to end: it came there with state {} of {}",
                    state.step, last.step
                )));
            }
        }
    }
    Ok(ended_by)
}

/// A target with its value.
fn named(target: &ContactTarget) -> String {
    match *target {
        ContactTarget::Load(load) => format!("a load of {}", quantity(load, "N", 6)),
        ContactTarget::Approach(approach) => {
            format!("an approach of {}", quantity(approach, "m", 6))
        }
        ContactTarget::MeanGap(gap) => format!("a mean gap of {}", quantity(gap, "m", 6)),
        ContactTarget::MeanPressure(pressure) => {
            format!("a mean pressure of {}", quantity(pressure, "Pa", 6))
        }
        ContactTarget::AreaFraction(fraction) => format!("{:.4} % of contact", 100.0 * fraction),
        _ => "a state".to_string(),
    }
}

/// Why a path has ended.
fn in_words(target: &ContactTarget) -> &'static str {
    match target {
        ContactTarget::Approach(_) => "the requested approach",
        ContactTarget::MeanGap(_) => "the requested mean gap",
        ContactTarget::AreaFraction(_) => "the requested contact area",
        _ => "the requested load",
    }
}
