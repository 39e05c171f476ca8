//! Paths with adhesion, `--work-of-adhesion`: the branch of pressing on, and with `--unload` that of pulling off.

mod charts;
mod course;
mod expected;
mod map;
mod object;
mod table;
mod words;

use std::path::PathBuf;
use std::time::Instant;

use asperity::adhesion::{AdhesiveEvent, AdhesiveState};
use asperity::contact::ContactTarget;
use asperity::{ContactState, Grid, Warning};
use asperity_cli::outcome::{Failure, Outcome};
use asperity_cli::panel;
use clap::ArgMatches;
use nalgebra::DMatrix;

pub(super) use expected::expected;
pub(super) use words::{Pulled, pull};

use super::fields::{self, Fields};
use super::interrupt::{self, Interrupt};
use super::interrupted;
use super::job::Job;
use super::options::{Options, Rule};
use super::summary::Summary;
use super::updater::Updater;
use crate::advice::told;
use crate::at::At;
use course::Course;

/// What does not go with adhesion, and why.
pub(super) fn check(options: &Options, job: &Job, asks_of_joint: bool) -> Result<(), Failure> {
    let refusals = [
        (
            job.has_hardness(),
            "--work-of-adhesion does not go with --hardness or --yield: adhesion of surfaces that yield is not derived",
        ),
        (
            matches!(options.updater, Updater::Iterative),
            "--work-of-adhesion does not go with --updater iterative: whether a state is stable is read off a factor, which takes 4n² \
             bytes for n nodes in contact",
        ),
        (
            matches!(options.rule, Rule::ApproximateOrder),
            "--work-of-adhesion does not go with --rule approximate-order: where surfaces jump depends on the order of nodes",
        ),
        (
            options.report,
            "--report shows contact that only grows, and with --work-of-adhesion nodes part again: the map, the chart and --at show both \
             branches",
        ),
        (
            asks_of_joint,
            "conductances and tables for finite elements follow from the stiffness of contact that only presses; with \
             --work-of-adhesion they are not derived",
        ),
    ];
    match refusals.into_iter().find(|(is_asked, _)| *is_asked) {
        Some((_, reason)) => Err(Failure::request(reason)),
        None => Ok(()),
    }
}

/// Whether a branch that grows has come to a target, or behind it in a jump.
fn is_there(target: &ContactTarget, contact: &ContactState, grid: &Grid) -> bool {
    match *target {
        ContactTarget::Load(load) => contact.load >= load,
        ContactTarget::Approach(approach) => contact.approach >= approach,
        ContactTarget::MeanGap(gap) => contact.mean_gap <= gap,
        ContactTarget::AreaFraction(fraction) => {
            grid.nodes_in(fraction).is_ok_and(|nodes| contact.contact_nodes >= nodes)
        }
        ContactTarget::MeanPressure(pressure) => contact.mean_pressure() >= pressure,
        _ => false,
    }
}

/// The state with which a branch of loading has come to a target, `None` before it.
///
/// # Errors
///
/// A branch that has passed the target without a state there.
fn reached<'a>(
    branch: &'a [AdhesiveState],
    (target, name): (&ContactTarget, &str),
    grid: &Grid,
) -> Result<Option<&'a AdhesiveState>, Failure> {
    let Some(state) = branch.iter().find(|state| is_there(target, &state.contact, grid)) else {
        return Ok(None);
    };
    let contact = &state.contact;
    // Limits are met exactly, and read back bit for bit.
    let is_close = |found: f64, asked: f64| (found - asked).abs() <= 1e-12 * asked.abs();
    let is_met = match *target {
        ContactTarget::Load(load) => is_close(contact.load, load),
        ContactTarget::Approach(approach) => is_close(contact.approach, approach),
        ContactTarget::MeanGap(gap) => is_close(contact.mean_gap, gap),
        ContactTarget::MeanPressure(pressure) => is_close(contact.mean_pressure(), pressure),
        // One node after the other.
        _ => true,
    };
    match is_met || state.event == AdhesiveEvent::JumpEnd {
        true => Ok(Some(state)),
        false => Err(Failure::request(format!(
            "the record has passed {name} and has no state there: only a new path stops at it"
        ))),
    }
}

/// Does one job and writes its files.
pub(super) fn follow(
    (options, given): (&Options, &ArgMatches),
    job: &Job,
    interrupt: &Interrupt,
    summary: Option<&mut Summary>,
) -> Result<Outcome, Failure> {
    let path = job.adhesive_path()?;
    let warnings = Warning::of_adhesion(job.surface(), &path.law(), job.e_star());
    let warnings: Vec<String> = warnings.iter().map(told).collect();
    panel::register_font()?;
    let start = Instant::now();
    let mut course = Course::new(job, path, options)?;
    let settings = job.settings().write(&options.out)?;
    let ended = course.follow(interrupt, options.unload);
    let is_interrupted = interrupt.is_asked() && !course.is_done();
    let (followed, lines) = course.end();
    let seconds = start.elapsed().as_secs_f64();
    let is_whole = ended.is_ok() && !is_interrupted;

    // Each of these is tried whatever became of the others: nothing computed is lost.
    let mut outcome = Outcome::default();
    outcome.written(Ok(settings));
    outcome.note(ended);
    outcome.written(lines.finish(is_whole));
    if is_interrupted && summary.is_some() {
        outcome.finish_quietly()?;
        return Err(interrupt::of_one_of_many());
    }
    if is_interrupted {
        let name = job.record_if_interrupted(&options.out);
        outcome.written(followed.save(&name, &[]));
        outcome.finish()?;
        return Err(interrupted(given, &name, followed.states.len()));
    }
    let mut kept = job.record().map(|name| followed.save(name, &[]));
    if interrupt.wait_no_longer() && summary.is_some() {
        outcome.finish_quietly()?;
        return Err(interrupt::of_one_of_many());
    }
    let pressed = followed.pressed();
    let mut greatest = f64::NAN;
    match pressed.map(|state| fields_at(&followed, &state).map(|found| (state, found))) {
        None => {}
        Some(Err(failure)) => outcome.note(Err(failure)),
        Some(Ok((state, (found, nodes)))) => {
            greatest = found.first().map_or(f64::NAN, |(_, pressure)| pressure.max());
            let name = options.out.join("contact_map.png");
            outcome.written(map::draw(&job.grid(), &state, (&found, &nodes), &name));
            if let (Some(name), Some(Ok(_))) = (job.record(), &kept) {
                kept = Some(followed.save(name, &found));
            }
            if let Some(format) = options.fields {
                let written = fields::write(&found, &job.grid(), format, (&options.out, ""));
                outcome.all_written(written);
            }
        }
    }
    if let Some(kept) = kept {
        outcome.written(kept);
    }
    match (options.json, summary) {
        (true, summary) => {
            let seed = summary.and(options.roughness.seed);
            object::print(job, &followed, &warnings, (greatest, seconds, seed));
        }
        (false, Some(summary)) => {
            let seed = options.roughness.seed.unwrap_or_default();
            summary.add_pulled((job, seed), Pulled::of(&followed), &warnings);
        }
        (false, None) => table::print(job, &followed, &warnings, seconds),
    }
    outcome.written(charts::draw(job, &followed, &options.out));
    for (at, state) in &followed.reached {
        outcome.all_written(write_at(options, job, &followed, (*at, state)));
    }
    if let Some(at) = followed.missed.first() {
        outcome.note(Err(Failure::request(format!(
            "the path has no state at {at}: it was ended by {}",
            followed.ended_by.unwrap_or("an error")
        ))));
    }
    Ok(outcome)
}

/// Pressure and gap of a state, and where its nodes are on the law.
fn fields_at(
    followed: &course::Followed,
    state: &AdhesiveState,
) -> Result<(Fields, DMatrix<asperity::adhesion::NodeState>), Failure> {
    let found = followed.path.fields_at(state);
    let found =
        found.map_err(|error| Failure::new("cannot compute the fields of a state", error))?;
    Ok((vec![("pressure", found.pressure), ("gap", found.gap)], found.nodes))
}

/// Draws the map of a state and writes its fields, both named after it.
fn write_at(
    options: &Options,
    job: &Job,
    followed: &course::Followed,
    (at, state): (At, &AdhesiveState),
) -> Result<Vec<PathBuf>, Failure> {
    let (found, nodes) = fields_at(followed, state)?;
    let ending = at.ending();
    let map = options.out.join(format!("contact_map{ending}.png"));
    let mut files = vec![map::draw(&job.grid(), state, (&found, &nodes), &map)?];
    if let Some(format) = options.fields {
        files.extend(fields::write(&found, &job.grid(), format, (&options.out, &ending))?);
    }
    Ok(files)
}
