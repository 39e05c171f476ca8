//! The contact of a wave on finer and finer grids, against Westergaard's closed form.

use std::fmt::Write;

use asperity::reference::Westergaard;
use asperity::surface::{Axis as Along, Wave};
use asperity::{Grid, LoadingSolver, LoadingState};

use crate::Options;
use asperity_cli::half_space::{Periodic, half_space};
use asperity_cli::outcome::Failure;
use asperity_studies::order::order;

/// Nodes along the coarsest wave, and of every grid across it: the wave does not vary there.
pub(crate) const COARSEST: usize = 32;
const ACROSS: usize = 4;
/// Amplitude of the wave of unit length.
const AMPLITUDE: f64 = 0.01;
/// Area and stiffness are compared between these fractions of the load of full contact. At lighter loads
/// the contact is no wider than a cell, and at heavier ones the gap.
const INSIDE: (f64, f64) = (0.1, 0.9);

/// Errors on one grid.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Errors {
    pub(crate) kernel: Periodic,
    pub(crate) nodes: usize,
    /// Of the mean gap over the amplitude, greatest at any event.
    pub(crate) gap: f64,
    /// Of the area over the nominal area, just before nodes touch.
    pub(crate) area: f64,
    /// Of the stiffness, relative, just before nodes touch.
    pub(crate) stiffness: f64,
    /// Of the load of full contact, relative.
    pub(crate) full: f64,
}

/// What can be drawn and fitted of [`Errors`].
pub(crate) type Column = (&'static str, fn(&Errors) -> f64, i32);

pub(crate) const COLUMNS: [Column; 3] = [
    ("mean gap, error / amplitude", |e| e.gap, 2),
    ("contact area, error / A₀", |e| e.area, 1),
    ("interfacial stiffness, relative error", |e| e.stiffness, 1),
];

/// All grids, kernel by kernel.
pub(crate) struct Convergence {
    pub(crate) errors: Vec<Errors>,
}

impl Convergence {
    pub(crate) fn run(options: &Options) -> Result<Self, Failure> {
        let mut errors = Vec::new();
        for kernel in [Periodic::Love, Periodic::Spectral] {
            let mut nodes = COARSEST;
            while nodes <= options.wave_nodes {
                errors.push(
                    Errors::on(kernel, nodes)
                        .map_err(|error| Failure::new("the study of a wave failed", error))?,
                );
                nodes *= 2;
            }
        }
        Ok(Self { errors })
    }

    pub(crate) fn of(&self, kernel: Periodic) -> impl Iterator<Item = &Errors> {
        self.errors.iter().filter(move |e| e.kernel == kernel)
    }

    /// The order in which an error falls, from the finest three grids.
    pub(crate) fn order(&self, kernel: Periodic, value: fn(&Errors) -> f64) -> f64 {
        let points = self.of(kernel).map(|e| (e.nodes as f64, value(e)));
        order(&points.collect::<Vec<_>>(), 3)
    }

    pub(crate) fn csv(&self) -> String {
        let mut text = "kernel,nodes,mean_gap_error_over_amplitude,area_fraction_error,\
                        stiffness_relative_error,full_contact_pressure_relative_error\n"
            .to_string();
        for e in &self.errors {
            let _ = writeln!(
                text,
                "{},{},{:e},{:e},{:e},{:e}",
                e.kernel.name(),
                e.nodes,
                e.gap,
                e.area,
                e.stiffness,
                e.full
            );
        }
        text
    }
}

impl Errors {
    fn on(kernel: Periodic, nodes: usize) -> Result<Self, asperity::Error> {
        let side = ACROSS as f64 / nodes as f64;
        let grid = Grid::with_sides(nodes, ACROSS, 1.0, side)?;
        // A row of nodes on the crest, and one in the trough.
        let (x, y) = grid.position(0, 0);
        let wave = Wave::new(AMPLITUDE, 1.0, Along::X)?.centered_at(x, y)?;
        let exact = Westergaard::new(AMPLITUDE, 1.0, 1.0)?;
        let path = LoadingSolver::new(&wave, &half_space(Some(kernel), grid, 1.0)?)?;
        let states: Vec<LoadingState> = path.collect::<Result<_, _>>()?;
        let full = exact.full_contact_pressure();
        let mut errors = Self { kernel, nodes, gap: 0.0, area: 0.0, stiffness: 0.0, full: 0.0 };
        for pair in states.windows(2) {
            let (before, at) = (pair[0], pair[1]);
            let pressure = at.contact.mean_pressure();
            // Whole rows touch at once: nothing is between them.
            if at.contact.load <= before.contact.load * (1.0 + 1e-9) || pressure > full {
                continue;
            }
            let gap = (at.contact.mean_gap - exact.mean_gap(pressure)) / AMPLITUDE;
            errors.gap = errors.gap.max(gap.abs());
            let ratio = pressure / full;
            if ratio > INSIDE.0 && ratio < INSIDE.1 {
                let area =
                    before.contact.contact_area_fraction - exact.contact_area_fraction(pressure);
                errors.area = errors.area.max(area.abs());
                // A path always has it.
                let stiffness = before.contact.interfacial_stiffness.unwrap_or(f64::INFINITY);
                let per_area = stiffness / grid.nominal_area();
                let stiffness = per_area / exact.interfacial_stiffness(pressure) - 1.0;
                errors.stiffness = errors.stiffness.max(stiffness.abs());
            }
        }
        if let Some(last) = states.last() {
            errors.full = (last.contact.mean_pressure() / full - 1.0).abs();
        }
        Ok(errors)
    }
}
