//! The last states of many paths, in one table.

use asperity::adhesion::AdhesiveState;
use asperity::{Grid, LoadingState};
use asperity_cli::half_space::Periodic;
use asperity_cli::number::counted;
use asperity_cli::outcome::Failure;
use asperity_cli::{say, speech};

use super::Solver;
use super::adhesive::{Pulled, pull};
use super::job::Job;
use super::table::{corrected_areas, row, verify, warnings};
use crate::columns::{self, Column};
use crate::conduction::Named;
use crate::state_table::{self, Row};

/// What is known of the paths that have been followed.
#[derive(Default)]
pub(super) struct Summary {
    is_begun: bool,
    rows: Vec<Row>,
    seeds: Vec<u64>,
    grid: Option<Grid>,
    /// Of paths with adhesion.
    pulled: Vec<Pulled>,
    /// Each warning with the first seed that has it, and how many paths have one that differs in its numbers alone.
    warnings: Vec<(u64, String, usize)>,
}

impl Summary {
    /// Begins the next path, and returns whether it is the first.
    pub(super) fn begin(&mut self) -> bool {
        !std::mem::replace(&mut self.is_begun, true)
    }

    /// Adds the last state of the path of a seed.
    pub(super) fn add(
        &mut self,
        (job, seed): (&Job, u64),
        solver: &mut Solver,
        states: &[LoadingState],
        conductions: &[Named],
    ) -> Result<(), Failure> {
        let failed = |error| Failure::new("cannot compute the last state", error);
        let corrected = corrected_areas(job, states).map_err(failed)?;
        let Some(last) = states.last() else { return Ok(()) };
        let greatest = solver.fields().map_err(failed)?.max_pressure();
        self.rows.push(row(job, last, greatest, &corrected, conductions));
        self.seeds.push(seed);
        self.grid = Some(job.grid());
        warnings(job, solver)?.into_iter().for_each(|warning| self.warn(seed, warning));
        verify(solver)
    }

    /// Adds what pulls on the path of a seed.
    pub(super) fn add_pulled(
        &mut self,
        (job, seed): (&Job, u64),
        pulled: Pulled,
        warnings: &[String],
    ) {
        self.pulled.push(pulled);
        self.seeds.push(seed);
        self.grid = Some(job.grid());
        warnings.iter().for_each(|warning| self.warn(seed, warning.clone()));
    }

    fn warn(&mut self, seed: u64, warning: String) {
        match self.warnings.iter_mut().find(|(_, other, _)| kind(other) == kind(&warning)) {
            Some((.., count)) => *count += 1,
            None => self.warnings.push((seed, warning, 1)),
        }
    }

    /// Prints the table, if there is anything in it.
    pub(super) fn print(&self, periodic: Option<Periodic>) {
        let Some(grid) = &self.grid else { return };
        if self.pulled.is_empty() {
            say!("\nthe last state of each path");
            state_table::print_of(&self.seeds, &self.rows, grid, periodic);
        } else {
            say!("\nthe last state of loading of each path, and what pulls");
            self.print_pulled();
        }
        for (seed, warning, count) in &self.warnings {
            let of = counted(*count, "path");
            speech::warn(match count {
                1 => format!("seed {seed}: {warning}"),
                _ => format!("seed {seed}, one of {of} like it: {warning}"),
            });
        }
    }
}

impl Summary {
    fn print_pulled(&self) {
        let pressed = |quantity: fn(&AdhesiveState) -> f64| {
            self.pulled.iter().map(move |row| row.pressed.as_ref().map_or(f64::NAN, quantity))
        };
        let force = |state: fn(&Pulled) -> Option<AdhesiveState>| {
            let states = self.pulled.iter().map(state);
            states.map(|state| state.as_ref().map_or(f64::NAN, pull)).collect::<Vec<_>>()
        };
        let (pull_in, pull_off) = (force(|row| row.pull_in), force(|row| row.pull_off));
        let mut columns = vec![
            Column::counts("seed", &self.seeds),
            Column::new("load", "N", pressed(|state| state.contact.load)),
            Column::percent("area", pressed(|state| state.contact.contact_area_fraction)),
            Column::new("pull-in", "N", pull_in.iter().copied()),
            Column::new("pull-off", "N", pull_off.iter().copied()),
            Column::new("loop", "J", self.pulled.iter().map(|row| row.dissipated)),
        ];
        if pull_off.iter().all(|force| force.is_nan()) {
            columns.truncate(4);
        }
        columns::print(&columns);
        say!();
    }
}

/// What a warning says before its first number.
fn kind(warning: &str) -> &str {
    warning.split(|c: char| c.is_ascii_digit()).next().unwrap_or_default()
}
