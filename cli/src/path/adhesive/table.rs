//! The short table, and what pulls.

use asperity::adhesion::{AdhesiveState, Direction};
use asperity_cli::half_space::is_of_mean_planes;
use asperity_cli::number::{counted, quantity};
use asperity_cli::{say, speech};

use super::super::job::Job;
use super::course::Followed;
use super::words::{Pulled, pull};
use crate::columns::{Column, print as print_columns};

/// Loads of the rows of each branch, as fractions of the greatest.
const LOADS: [f64; 6] = [0.0, 0.01, 0.1, 0.3, 0.6, 1.0];

/// Prints rows of both branches, and what pulls.
pub(super) fn print(job: &Job, followed: &Followed, warnings: &[String], seconds: f64) {
    let states = counted(followed.states.len(), "state");
    say!("{states} in {seconds:.2} s");
    if let Some(end) = followed.ended_by {
        say!("ended by: {end}");
    }
    say!();
    let pulled = Pulled::of(followed);
    let rows = rows(followed, &pulled);
    columns(job, &rows);
    say!("load: below 0 where the surfaces are pulled apart; pressure: load over nominal area");
    say!("area: cells whose gap is 0; pulled: cells that are pulled across a gap");
    let has_stiffness = rows.iter().any(|state| state.contact.contact_stiffness.is_some());
    match is_of_mean_planes(job.periodic(), has_stiffness) {
        false => say!("approach: from where surfaces that do not pull would touch"),
        true => {
            say!("approach: of the mean planes, from where surfaces that do not pull would touch")
        }
    }
    say!();
    let law = followed.path.law();
    say!(
        "law: pull of {} at most, over a gap of {}; slope times compliance of a cell {:.2}",
        quantity(law.stress(), "Pa", 4),
        quantity(law.range(), "m", 4),
        law.resolution()
    );
    let area = job.grid().nominal_area();
    let force = |state: &AdhesiveState| {
        format!(
            "{}, {} of nominal area, at an approach of {}",
            quantity(pull(state), "N", 4),
            quantity(pull(state) / area, "Pa", 4),
            quantity(state.contact.approach, "m", 4)
        )
    };
    if let Some(state) = &pulled.pull_in {
        say!("pull-in: pressed on, the surfaces pull each other with {}", force(state));
    }
    if let Some(state) = &pulled.pull_off {
        say!("pull-off: it takes {}", force(state));
        say!(
            "loop: {} lost in {} on both branches, {} of nominal area",
            quantity(pulled.dissipated, "J", 4),
            counted(pulled.jumps, "jump"),
            quantity(pulled.dissipated / area, "J/m²", 4)
        );
    }
    warnings.iter().for_each(speech::warn);
}

/// States that are asked for, or some spread over both branches; the extremes among them.
fn rows(followed: &Followed, pulled: &Pulled) -> Vec<AdhesiveState> {
    let mut rows: Vec<AdhesiveState> = pulled.pull_in.into_iter().chain(pulled.pull_off).collect();
    if followed.reached.is_empty() {
        let most = pulled.pressed.map_or(0.0, |state| state.contact.load);
        let [loading, unloading] = followed.branches();
        for load in LOADS.map(|fraction| fraction * most) {
            let is_above = |state: &&AdhesiveState| state.contact.load >= load;
            rows.extend(loading.states().iter().find(is_above));
            rows.extend(unloading.states().iter().rev().find(is_above));
        }
    } else {
        rows.extend(followed.reached.iter().map(|(_, state)| *state));
    }
    rows.extend(pulled.pressed);
    rows.sort_by_key(|state| state.step);
    rows.dedup_by_key(|state| state.step);
    rows
}

fn columns(job: &Job, rows: &[AdhesiveState]) {
    let nodes = job.grid().nodes() as f64;
    let column = |name: &'static str, unit: &'static str, quantity: fn(&AdhesiveState) -> f64| {
        Column::new(name, unit, rows.iter().map(quantity))
    };
    let share = rows.iter().map(|s| (s.soft_nodes + s.cohesive_nodes) as f64 / nodes);
    let mut columns = vec![
        Column::words("branch", rows.iter().map(|state| state.direction.name())),
        column("load", "N", |s| s.contact.load),
        column("pressure", "Pa", |s| s.contact.mean_pressure()),
        Column::percent("area", rows.iter().map(|s| s.contact.contact_area_fraction)),
        Column::percent("pulled", share),
        column("approach", "m", |s| s.contact.approach),
        column("mean gap", "m", |s| s.contact.mean_gap),
        column("lost", "J", |s| s.dissipated),
    ];
    if rows.iter().all(|state| state.direction == Direction::Loading) {
        columns.remove(0);
    }
    print_columns(&columns);
    say!();
}
