//! The contact problem on one grid, with all the memory that solving it takes.

use std::borrow::Cow;

use nalgebra::DMatrix;

use super::budget::MemoryBudget;
use super::iterate::Iterate;
use crate::cell_response::CellResponse;
use crate::contact::ErrorLength;
use crate::convolution::Convolution;
use crate::kernel::KernelTable;
use crate::krylov::{Operator, Preconditioner, sum};
use crate::{Error, Grid};

/// The load or approach prescribed on one grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Prescribed {
    /// The sum of all pressures.
    Sum(f64),
    /// The approach.
    Approach(f64),
}

impl Prescribed {
    /// The same on a grid with other cells: the load is what counts.
    pub(super) fn on_cells(self, from: f64, to: f64) -> Self {
        match self {
            Self::Sum(sum) => Self::Sum(sum * from / to),
            approach @ Self::Approach(_) => approach,
        }
    }

    /// Gives pressures the sum that is prescribed. What cannot have it, from a solution that failed, becomes uniform.
    pub(super) fn scale(self, pressure: &mut [f64]) {
        if let Self::Sum(target) = self {
            let factor = target / sum(pressure);
            if factor > 0.0 && factor.is_finite() {
                for value in pressure {
                    *value *= factor;
                }
            } else {
                pressure.fill(target / pressure.len() as f64);
            }
        }
    }
}

/// The contact problem on one grid.
#[derive(Debug, Clone)]
pub(super) struct Level {
    pub(super) grid: Grid,
    /// Initial gap, zero at the highest node of the finest grid.
    pub(super) gap: Vec<f64>,
    /// In the zero gauge if the mean displacement is arbitrary.
    pub(super) operator: Operator,
    /// That of the matrix in the gauge `gauge`.
    pub(super) preconditioner: Preconditioner,
    /// A gauge of its own to compute in, since the zero gauge is singular in full contact; `None` if
    /// the mean displacement is the kernel's.
    pub(super) gauge: Option<f64>,
    /// C(0, 0), in that gauge.
    pub(super) self_influence: f64,
    pub(super) scale: ErrorLength,
    pub(super) iterate: Iterate,
    memory: MemoryBudget,
}

impl Level {
    /// The problem with the kernel of `table`, of which `convolution` is the convolution, and the
    /// initial gap `gap` of a surface of the given rms height.
    pub(super) fn new(
        table: &KernelTable,
        convolution: Convolution,
        gap: Vec<f64>,
        rms_height: f64,
        memory: MemoryBudget,
    ) -> Self {
        let gauge = table.computing_gauge();
        let (own, convolution) = match gauge {
            Some(gauge) => (Cow::Owned(table.in_gauge(gauge)), convolution.without_mean()),
            None => (Cow::Borrowed(table), convolution),
        };
        Self {
            grid: table.grid(),
            operator: Operator::new(convolution),
            preconditioner: Preconditioner::new(&own),
            gauge,
            self_influence: own.self_influence(),
            scale: ErrorLength::new(rms_height, table),
            iterate: Iterate::new(gap.len()),
            gap,
            memory,
        }
    }

    /// How a single cell answers its own pressure.
    pub(super) fn cell_response(&self) -> CellResponse {
        CellResponse::new(self.self_influence, self.grid.cell_area())
    }

    /// Whether all nodes in contact are among those that touch first.
    pub(super) fn touch_first(&self, contact_map: &DMatrix<bool>) -> bool {
        let mut nodes = contact_map.iter().zip(&self.gap);
        nodes.all(|(in_contact, gap)| !in_contact || *gap <= 0.0)
    }

    /// Mean initial gap.
    pub(super) fn mean_initial_gap(&self) -> f64 {
        sum(&self.gap) / self.gap.len() as f64
    }

    /// Uniform displacement per unit of the sum of pressures that the gauge of the level adds to the
    /// zero gauge.
    pub(super) fn uniform(&self) -> f64 {
        self.gauge.unwrap_or_default()
    }

    /// Computes the displacements of the present pressures afresh.
    pub(super) fn refresh(&mut self) -> Result<(), Error> {
        let Iterate { pressure, total_gap, .. } = &mut self.iterate;
        let displacement = self.operator.apply_field(pressure)?;
        for ((total_gap, u), g) in total_gap.iter_mut().zip(displacement).zip(&self.gap) {
            *total_gap = g + u;
        }
        Ok(())
    }

    /// Does `work` with displacements in the gauge of the level.
    pub(super) fn in_gauge<T>(
        &mut self,
        work: impl FnOnce(&mut Self) -> Result<T, Error>,
    ) -> Result<T, Error> {
        self.operator.set_uniform(self.uniform());
        let done = work(self);
        self.operator.set_uniform(0.0);
        done
    }

    /// Makes the nodes for which `is_in` holds the contact, given the present pressures and closures.
    ///
    /// # Errors
    ///
    /// [`Error::MemoryBudget`] if there are too many of them.
    pub(super) fn choose_contact(
        &mut self,
        is_in: impl Fn(usize, &[f64], &[f64]) -> bool,
    ) -> Result<(), Error> {
        let Iterate { pressure, total_gap, contact, .. } = &mut self.iterate;
        if !contact.assign(|node| is_in(node, pressure, total_gap)) {
            return Ok(());
        }
        let fits = self.memory.check(contact.len());
        if fits.is_err() {
            contact.assign(|_| false);
        }
        self.preconditioner.update(contact);
        fits
    }

    /// Errors of gaps are measured by no less than this length: far beyond full contact the approach
    /// of mean planes stays what it is, whereas rounding grows with the pressure.
    pub(super) fn least_length(&self, prescribed: Prescribed) -> f64 {
        match prescribed {
            Prescribed::Sum(sum) => self.scale.own_displacement(sum),
            Prescribed::Approach(_) => 0.0,
        }
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.gap[..])
            + self.operator.bytes()
            + self.preconditioner.bytes()
            + self.iterate.bytes()
    }
}
