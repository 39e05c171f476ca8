//! The last states of many paths, in one table.

use asperity::{Grid, LoadingState};
use asperity_cli::half_space::Periodic;
use asperity_cli::number::counted;
use asperity_cli::outcome::Failure;
use asperity_cli::{say, speech};

use super::Solver;
use super::job::Job;
use super::table::{corrected_areas, row, verify, warnings};
use crate::conduction::Named;
use crate::state_table::{self, Row};

/// What is known of the paths that have been followed.
#[derive(Default)]
pub(super) struct Summary {
    rows: Vec<Row>,
    seeds: Vec<u64>,
    grid: Option<Grid>,
    /// Each warning with how many paths have one that differs in its numbers alone.
    warnings: Vec<(String, usize)>,
}

impl Summary {
    /// Whether no path has come to its end.
    pub(super) fn is_empty(&self) -> bool {
        self.rows.is_empty()
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
        for warning in warnings(job, solver)? {
            match self.warnings.iter_mut().find(|(other, _)| kind(other) == kind(&warning)) {
                Some((_, count)) => *count += 1,
                None => self.warnings.push((warning, 1)),
            }
        }
        verify(solver)
    }

    /// Prints the table, if there is anything in it.
    pub(super) fn print(&self, periodic: Option<Periodic>) {
        let Some(grid) = &self.grid else { return };
        say!("\nthe last state of each path");
        state_table::print_of(&self.seeds, &self.rows, grid, periodic);
        for (warning, count) in &self.warnings {
            let of = counted(*count, "path");
            speech::warn(match count {
                1 => warning.clone(),
                _ => format!("{warning} (one of {of} like it)"),
            });
        }
    }
}

/// What a warning says before its first number.
fn kind(warning: &str) -> &str {
    warning.split(|c: char| c.is_ascii_digit()).next().unwrap_or_default()
}
