//! `asperity path`: from a rough surface to its whole loading path.
//!
//! Writes `settings.json`, `path.csv` with one line for each state, `loading_curve.svg` and `contact_map.png`, the
//! record of the path and its page if they are asked for, and prints a short table. If the path ends with an error,
//! everything up to there is written all the same, `path.csv` as `path.csv.part`, and the exit code is 1. After Ctrl-C
//! the record and `path.csv.part` are written, and the exit code is 130.

mod adhesive;
mod again;
mod conductance_chart;
mod curves;
mod expected;
pub(crate) mod fields;
mod follow;
mod generated;
mod interrupt;
mod job;
mod joint;
mod lines;
mod loop_chart;
mod map;
mod moments;
mod object;
mod options;
mod parts;
mod progress;
mod roughness;
mod sheet;
mod shift;
mod source;
mod summary;
mod table;
mod there_and_back;
mod unloading;
mod updater;

use std::path::{Path, PathBuf};
use std::time::{Instant, SystemTime};

use asperity::{LoadingPath, LoadingState};
use asperity_cli::number::counted;
use asperity_cli::outcome::{self, Failure, Outcome};
use asperity_cli::{answer, note, panel, say, speech};
use asperity_report::PathTable;
use clap::ArgMatches;
use nalgebra::DMatrix;

use crate::conduction::Named;
use crate::earlier::{self, Earlier};
use crate::ensemble::Member;
use crate::report;
use crate::settings::Settings;
use expected::Expected;
use follow::{Followed, PathFile};
use interrupt::Interrupt;
use job::Job;
pub(crate) use options::Options;
use summary::Summary;

/// The path, whatever updater it has.
type Solver = LoadingPath;

/// Follows one path, or that of each seed, with the options that were given.
pub(crate) fn run(options: &Options, given: &ArgMatches) -> Result<(), Failure> {
    if options.json {
        speech::be_quiet();
    }
    let interrupt = Interrupt::listen()?;
    if options.ensemble.seeds.is_none() {
        if options.dry_run {
            return estimate(options, "");
        }
        let earlier = Earlier::of(&earlier::PATH, Some(&options.out), &[options.resume.as_deref()]);
        return earlier.finish(follow_one(options, given, &interrupt, None)?);
    }
    let there = options.ensemble.there(&options.out)?;
    // What is there must be what would be computed now.
    for seed in &there {
        let member = Member::new(*seed, &options.out);
        let expected = Job::expected_settings(&options.of(&member))?;
        let name = member.folder.display().to_string();
        let found = Settings::read(&member.folder)?;
        expected
            .check_same("this command", (&name, &found), false)
            .map_err(|failure| failure.with_advice("give another --out, or remove that folder"))?;
    }
    let missing = options.ensemble.count() - there.len() as u128;
    let missing = counted(missing, "path");
    say!("{missing} to follow, {} finished", there.len());
    let seeds = options.ensemble.seeds_of_task();
    let mut members =
        seeds.filter(|seed| !there.contains(seed)).map(|seed| Member::new(seed, &options.out));
    if options.dry_run {
        return members.next().map_or(Ok(()), |first| estimate(&options.of(&first), " for each"));
    }
    let mut summary = Summary::default();
    members.try_for_each(|member| {
        match follow_one(&options.of(&member), given, &interrupt, Some(&mut summary)) {
            Err(failure) if failure.code() == interrupt::EXIT_CODE => {
                member.abandon()?;
                let seed = member.seed;
                Err(Failure::with_code(
                    format!("interrupted at seed {seed}: the same command follows it again and skips finished folders"),
                    interrupt::EXIT_CODE,
                ))
            }
            done => done,
        }?
        .finish_quietly()?;
        member.finish()?;
        note!("wrote {}", member.folder.display());
        Ok(())
    })?;
    summary.print(options.periodic);
    Ok(())
}

/// The job, and the conductances that it is asked for, with what looks wrong unless it has been said before.
fn prepare(options: &Options, is_first: bool) -> Result<(Job, Vec<Named>), Failure> {
    options.check()?;
    let job = Job::new(options)?;
    if job.law().is_none() {
        options.check_approach()?;
    }
    if options.unload && !job.has_hardness() && job.law().is_none() {
        return Err(Failure::request(
            "--unload needs --hardness, --yield or --work-of-adhesion: elastic contact goes back through the same states",
        ));
    }
    if is_first {
        note!("{}", job.to_string().trim_end());
        options.joint.conduct.tell();
        for warning in job.warnings() {
            eprintln!("warning: {}", crate::advice::told(&warning));
        }
    }
    let conductions = options.joint.check(&job.pair())?;
    if job.law().is_some() {
        adhesive::check(options, &job, options.joint.is_asked(&conductions))?;
    }
    Ok((job, conductions))
}

/// Prints what a path will take.
fn estimate(options: &Options, of: &str) -> Result<(), Failure> {
    let (job, _) = prepare(options, true)?;
    let expected = match job.law() {
        Some(_) => adhesive::expected(&job, options)?,
        None => Expected::of(&job, options.unload)?,
    };
    match options.json {
        true => answer!("{}", expected.object()),
        false => answer!("{expected}{of}"),
    }
    Ok(())
}

/// Does one job and writes its files.
fn follow_one(
    options: &Options,
    given: &ArgMatches,
    interrupt: &Interrupt,
    mut summary: Option<&mut Summary>,
) -> Result<Outcome, Failure> {
    let is_first = summary.as_mut().is_none_or(|summary| summary.begin());
    let (job, conductions) = prepare(options, is_first)?;
    let begun = SystemTime::now();
    // What cannot be written is said before the work.
    outcome::create_folder(&options.out)?;
    if let Some(record) = job.record() {
        outcome::check_place(record)?;
    }
    if job.law().is_some() {
        return adhesive::follow((options, given), &job, interrupt, summary);
    }
    let mut solver = job.solver()?;
    panel::register_font()?;
    let settings = job.settings().write(&options.out)?;
    let table = PathTable::new(job.grid(), job.boundary());
    // The stiffness on unloading, by which a contact conducts that yields, is computed at the end for all states at
    // once.
    let conducts_at_end = job.has_hardness() && options.joint.needs_stiffness(&conductions);
    let columns = if conducts_at_end { Vec::new() } else { conductions.clone() };
    let file = PathFile::create(&options.out, table, (columns, job.layering()))?;

    let start = Instant::now();
    let mut followed = Followed::new(&job, file, options.save_every)?;
    let ended = followed.follow(&job, &mut solver, interrupt);
    let is_interrupted = interrupt.is_asked() && solver.end().is_none();
    let (mut states, file) = followed.end();
    let seconds = start.elapsed().as_secs_f64();
    let is_whole = ended.is_ok() && !is_interrupted;

    // Each of these is tried whatever became of the others: nothing computed is lost.
    let mut outcome = Outcome::default();
    outcome.written(Ok(settings));
    outcome.note(ended);
    if is_interrupted && summary.is_some() {
        outcome.finish_quietly()?;
        return Err(interrupt::of_one_of_many());
    }
    if is_interrupted {
        let name = job.record_if_interrupted(&options.out);
        outcome.written(save(&name, &job, &solver, &states, &[]));
        outcome.written(file.finish(is_whole));
        outcome.finish()?;
        return Err(interrupted(given, &name, states.len()));
    }
    // First without the fields, which take time and memory.
    let record = job.record();
    let mut kept = record.map(|name| save(name, &job, &solver, &states, &[]));
    outcome.written(file.finish(is_whole));
    if interrupt.wait_no_longer() && summary.is_some() {
        outcome.finish_quietly()?;
        return Err(interrupt::of_one_of_many());
    }
    if conducts_at_end {
        let table = PathTable::new(job.grid(), job.boundary());
        outcome.note(
            solver
                .add_unloading_stiffness(&mut states)
                .map_err(|error| Failure::new("cannot compute the stiffness on unloading", error))
                .and_then(|()| {
                    let conductions = (conductions.clone(), job.layering());
                    PathFile::write_whole(&options.out, table, conductions, (&states, is_whole))
                }),
        );
    }
    let mut map = None;
    match solver.fields() {
        Ok(found) => {
            let name = options.out.join("contact_map.png");
            map = states.last().map(|last| map::draw(&job, last, &found, &name));
            let fields = fields::of(found, job.has_hardness());
            if let (Some(name), Some(Ok(_))) = (record, &kept) {
                kept = Some(save(name, &job, &solver, &states, &fields));
            }
            if let Some(format) = options.fields {
                let written = fields::write(&fields, &job.grid(), format, (&options.out, ""));
                outcome.all_written(written);
            }
        }
        Err(error) => {
            outcome.note(Err(Failure::new("cannot compute the fields of the last state", error)));
        }
    }
    if let Some(kept) = kept {
        outcome.written(kept);
    }
    let told = (&conductions[..], seconds);
    outcome.note(match (options.json, summary) {
        (true, summary) => {
            let seed = summary.and(options.roughness.seed);
            object::print(&job, &mut solver, &states, (&conductions, seconds, seed))
        }
        (false, Some(summary)) => {
            let seed = options.roughness.seed.unwrap_or_default();
            summary.add((&job, seed), &mut solver, &states, &conductions)
        }
        (false, None) => table::print(&job, &mut solver, &states, told),
    });
    if options.unload {
        outcome.all_written(unloading::write(&job, &mut solver, &states, &options.out));
    }
    if options.report {
        outcome.written(report_of(&job, &mut solver, &states, (&options.out, begun)));
    }
    outcome.all_written(options.joint.write(&job.pair(), &states, &options.out));
    outcome.written(curves::draw(&job, &states, &options.out));
    if let Some(drawn) = conductance_chart::draw(&job, &conductions, &states, &options.out) {
        outcome.written(drawn);
    }
    map.into_iter().for_each(|map| outcome.written(map));
    let (moments, missed) = moments::reached(&job, &states);
    for moment in &moments {
        let written = moments::write(&job, &mut solver, moment, (&options.out, options.fields));
        outcome.all_written(written);
    }
    outcome.note(missed);
    Ok(outcome)
}

/// How to go on with a path that was interrupted.
fn interrupted(given: &ArgMatches, record: &Path, states: usize) -> Failure {
    let again = again::command(record, given);
    let states = counted(states, "state");
    Failure::with_code(
        format!("interrupted: {states} in {}; continue with `{again}`", record.display()),
        interrupt::EXIT_CODE,
    )
}

/// Writes the page of the path, with the tables that have been written since it began.
fn report_of(
    job: &Job,
    solver: &mut Solver,
    states: &[LoadingState],
    tables: (&Path, SystemTime),
) -> Result<PathBuf, Failure> {
    let failed = |error| Failure::new("cannot make the report", error);
    let record = job.record_of(solver, states).map_err(failed)?;
    report::of_path(job.name(), &record, solver, tables)
}

/// Writes the record of the path so far, and fields of its last state.
fn save(
    name: &Path,
    job: &Job,
    solver: &Solver,
    states: &[LoadingState],
    fields: &[(&str, DMatrix<f64>)],
) -> Result<PathBuf, Failure> {
    let fields = fields.iter().map(|(name, field)| (*name, field));
    let fields: Vec<_> = fields.collect();
    job.record_of(solver, states)
        .and_then(|record| record.write_npz(name, &fields))
        .map(|()| name.to_path_buf())
        .map_err(|error| Failure::writing(name, error))
}
