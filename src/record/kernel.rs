//! The parameters of a kernel, as a record keeps them.

use crate::kernel::{
    Boussinesq, KernelOrigin, KernelTable, Layered, PeriodicBoussinesq, SemiPeriodicBoussinesq,
    Spectral,
};
use crate::surface::Axis;
use crate::{Boundary, Error, Grid, InfluenceKernel};

/// How far coefficients of a kernel may differ from those that a record remembers, relative to the greatest: the same
/// formulas on another machine differ by the last bits of elementary functions.
const SAME_KERNEL: f64 = 1e-12;

/// The parameters of a kernel, as a record keeps them.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct KernelRecord {
    /// Its parameters.
    pub origin: KernelOrigin,
    /// The surroundings of the grid.
    pub boundary: Boundary,
    /// Some of its coefficients \[m/Pa\], from which it is known again: see [`KernelRecord::OFFSETS`].
    pub coefficients: Vec<f64>,
}

impl KernelRecord {
    /// Number of coefficients that are remembered: at the offsets 0, 1, half a side and the greatest one in either
    /// direction.
    pub const OFFSETS: usize = 16;

    pub(super) fn of(table: &KernelTable) -> Self {
        let along = |n: usize| [0, 1.min(n - 1), n / 2, n - 1];
        let (nx, ny) = table.grid().shape();
        let offsets = along(nx).into_iter();
        let offsets = offsets.flat_map(|di| along(ny).map(|dj| (di as isize, dj as isize)));
        Self {
            origin: table.origin(),
            boundary: table.boundary(),
            coefficients: offsets
                .map(|(di, dj)| table.coefficient(di, dj).unwrap_or(f64::NAN))
                .collect(),
        }
    }

    /// `Ok` if the surroundings of the grid are those that the parameters say.
    pub(super) fn check_boundary(&self) -> Result<(), Error> {
        match self.origin.boundary() {
            Some(expected) if expected != self.boundary => {
                let [expected, found] =
                    [expected, self.boundary].map(|boundary| format!("{boundary:?}"));
                Err(Error::WrongBoundary { expected, found })
            }
            _ => Ok(()),
        }
    }

    /// `Ok` if the coefficients are those of a kernel, but for a uniform displacement where that is arbitrary.
    pub(super) fn check(&self, table: &KernelTable) -> Result<(), Error> {
        let found = Self::of(table).coefficients;
        let greatest = found.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
        if found.len() != self.coefficients.len() {
            return Err(Error::LengthMismatch {
                expected: found.len(),
                found: self.coefficients.len(),
            });
        }
        let mut pairs = self.coefficients.iter().zip(&found);
        // A path with a hardness may have been followed in another gauge.
        let gauge = match (table.gauge(), self.coefficients.first(), found.first()) {
            (Some(_), Some(expected), Some(found)) => expected - found,
            _ => 0.0,
        };
        let greatest = greatest.max(gauge.abs());
        // NaN is another kernel as well.
        let is_same = |a: f64, b: f64| (a - (b + gauge)).abs() <= SAME_KERNEL * greatest;
        match pairs.find(|(a, b)| !is_same(**a, **b)) {
            None => Ok(()),
            Some((expected, found)) => {
                Err(Error::WrongKernel { expected: *expected, found: *found })
            }
        }
    }

    /// A kernel in the gauge of this one, if that was [another](crate::PeriodicBoussinesq::with_gauge) than the kernel
    /// has by itself; it must be the same otherwise.
    fn in_gauge(&self, table: KernelTable) -> KernelTable {
        let found = Self::of(&table).coefficients;
        match (table.gauge(), self.coefficients.first(), found.first()) {
            (Some(gauge), Some(&asked), Some(&own))
                if (asked - own).abs() > SAME_KERNEL * asked.abs().max(own.abs()) =>
            {
                let moved = table.in_gauge(gauge + (asked - own));
                // In a smaller one gaps need not be convex.
                if asked < own { moved.at_most_monotone() } else { moved }
            }
            _ => table,
        }
    }

    /// The kernel, made again in its gauge, if it is still the same.
    pub(super) fn make(&self, grid: Grid) -> Result<KernelTable, Error> {
        let table = match &self.origin {
            KernelOrigin::Boussinesq { e_star } => {
                KernelTable::new(&Boussinesq::new(grid, *e_star)?)
            }
            KernelOrigin::PeriodicBoussinesq { e_star } => {
                KernelTable::new(&PeriodicBoussinesq::new(grid, *e_star)?)
            }
            KernelOrigin::SemiPeriodicBoussinesq { e_star, boundary } => {
                // The other boundaries name no direction.
                let along = if *boundary == Boundary::PeriodicY { Axis::Y } else { Axis::X };
                KernelTable::new(&SemiPeriodicBoussinesq::new(grid, *e_star, along)?)
            }
            KernelOrigin::Spectral { e_star } => KernelTable::new(&Spectral::new(grid, *e_star)?),
            KernelOrigin::Layered { body } => KernelTable::new(&Layered::free(grid, body.clone())?),
            KernelOrigin::PeriodicLayered { body } => {
                KernelTable::new(&Layered::periodic(grid, body.clone())?)
            }
            KernelOrigin::SpectralLayered { body } => {
                KernelTable::new(&Layered::spectral(grid, body.clone())?)
            }
            KernelOrigin::Other => Err(Error::ForeignKernel),
        }?;
        // In the gauge that a problem uses.
        let table = table.regular();
        self.check(&table)?;
        Ok(self.in_gauge(table))
    }
}
