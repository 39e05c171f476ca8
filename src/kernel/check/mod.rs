//! Whether a kernel keeps its promises, tried on small contact sets.

mod contact;
mod sets;

use asperity_fft::Plan;
use num_complex::Complex64;

use self::contact::Contact;
use super::{Boundary, ContactGrowth, InfluenceKernel, KernelTable};
use crate::{Error, KernelError};

/// What [`check`] has tried, and what it has found.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct KernelReport {
    /// Number of contact sets that were tried.
    pub contact_sets: usize,
    /// Number of nodes of the largest of them.
    pub largest_contact: usize,
    /// Whether every contact set there is on the grid was tried.
    pub exhaustive: bool,
    /// The least value of the symbol \[m/Pa\] on the waves of the grid, that is the least eigenvalue
    /// of the influence matrix on the whole grid; `None` unless both directions repeat. The wave of length
    /// zero is left out if the mean displacement is arbitrary.
    pub least_symbol: Option<f64>,
    /// The growth that the kernel promises.
    pub promised_growth: ContactGrowth,
    /// The most that no set has contradicted, which may be more than what is promised. It is evidence
    /// and no proof, unless the check was exhaustive.
    pub supported_growth: ContactGrowth,
}

/// Tests the promises of a kernel, for those who write their own: a path trusts them.
///
/// * Coefficients are finite, symmetric and, if the boundary is periodic, repeat:
///   [`KernelTable::new`].
/// * The influence matrix is positive definite: by a Cholesky factorization for every contact set that
///   is tried, and by the symbol on the whole grid if the boundary is periodic.
/// * Contact [grows](ContactGrowth) as promised. With I the contact set, C its influence matrix,
///   `y₂ = C_II⁻¹ e` and `r₂ = 1 − C_:I y₂`, growth is monotone if `y₂ ≥ 0` and `r₂ ≥ 0` for all sets,
///   and convex if moreover no element off the diagonal of `C_II⁻¹` is positive.
///
/// On grids of up to 10 nodes all contact sets are tried. On larger ones it is some 250: scattered
/// nodes, patches, patches with holes, and the whole grid if it has at most 256 nodes. They are drawn
/// with a fixed seed, so that the answer is always the same.
///
/// A sign only counts if rounding cannot have made it. A kernel in the zero gauge, in which the matrix
/// of the whole grid is singular, is checked in another one. On a grid of a million nodes the check
/// takes some seconds.
///
/// # Errors
///
/// Those of [`KernelTable::new`]; [`KernelError::SymbolNotPositive`]; [`KernelError::BrokenPromise`] with the
/// promise, the contact set, the node and the value.
///
/// # Example
///
/// ```
/// use asperity::{Boussinesq, ContactGrowth, Grid, kernel};
///
/// let kernel = Boussinesq::new(Grid::square(12, 1e-3)?, 1e11)?;
/// let report = kernel::check(&kernel)?;
/// assert_eq!(report.promised_growth, ContactGrowth::Convex);
/// assert_eq!(report.supported_growth, ContactGrowth::Convex);
/// assert_eq!(report.largest_contact, 144);
/// # Ok::<(), asperity::Error>(())
/// ```
pub fn check<K: InfluenceKernel + ?Sized>(kernel: &K) -> Result<KernelReport, Error> {
    let table = KernelTable::new(kernel)?.regular();
    let least_symbol = match table.boundary() {
        Boundary::Free | Boundary::PeriodicX | Boundary::PeriodicY => None,
        Boundary::Periodic => Some(least_symbol(&table)?),
    };
    let sets = sets::contact_sets(&table.grid());
    let mut report = KernelReport {
        contact_sets: sets.list.len(),
        largest_contact: sets.list.iter().map(Vec::len).max().unwrap_or_default(),
        exhaustive: sets.exhaustive,
        least_symbol,
        promised_growth: table.contact_growth(),
        supported_growth: ContactGrowth::Convex,
    };
    for nodes in sets.list {
        let contact = Contact::new(&table, nodes)?;
        let (supported, violation) = contact.growth();
        if let Some(violation) = violation
            && supported < report.promised_growth
        {
            return Err(contact.broken(&table, violation));
        }
        report.supported_growth = report.supported_growth.min(supported);
    }
    Ok(report)
}

/// The least value of the symbol, by a Fourier transform of one period.
fn least_symbol(table: &KernelTable) -> Result<f64, Error> {
    let grid = table.grid();
    let (nx, ny) = grid.shape();
    let mut rows: Vec<_> = (0..grid.nodes())
        .map(|node| Complex64::from(table.between(table.place(node), table.place(0))))
        .collect();
    f64::complex_forward(nx).process(&mut rows);
    let mut columns: Vec<_> =
        (0..grid.nodes()).map(|place| rows[place / ny + nx * (place % ny)]).collect();
    f64::complex_forward(ny).process(&mut columns);
    let greatest = columns.iter().map(|value| value.re).fold(0.0, f64::max);
    // A Fourier transform errs by a few rounding errors of the greatest value.
    let rounding = 16.0 * f64::EPSILON * greatest;
    let skipped = usize::from(table.gauge().is_some());
    let mut least = f64::INFINITY;
    for (place, value) in columns.iter().enumerate().skip(skipped) {
        let value = value.re;
        if value <= rounding {
            return Err(Error::Kernel(KernelError::SymbolNotPositive {
                q: grid.wave_vector(place / ny, place % ny),
                value,
            }));
        }
        least = least.min(value);
    }
    Ok(least)
}

#[cfg(test)]
mod tests;
