//! Direct summation, the definition itself.

use nalgebra::DMatrix;

use crate::kernel::KernelTable;
use crate::{Error, InfluenceKernel};

/// Displacement of every node under `pressure`, summed term by term.
///
/// ```math
/// u_i = \sum_j C(\mathbf i - \mathbf j)\, p_j
/// ```
///
/// takes time in proportion to the *square* of the number of nodes. It is primarily used to test
/// [`Convolution`](super::Convolution) and kernels; each sum is compensated (Neumaier), so that
/// its relative error stays near rounding however many nodes there are.
///
/// With a periodic kernel the offsets wrap, since its coefficients repeat with the grid: the sum is
/// over one period, and the same as it stands here.
///
/// `pressure` \[Pa\] and the displacement returned \[m\] have nx rows and ny columns.
///
/// # Errors
///
/// Those of [`KernelTable::new`], [`Error::GridMismatch`] if `pressure` does not have the shape of
/// the kernel's grid, and [`Error::FieldNotFinite`].
pub fn direct_sum<K: InfluenceKernel + ?Sized>(
    kernel: &K,
    pressure: &DMatrix<f64>,
) -> Result<DMatrix<f64>, Error> {
    let table = KernelTable::new(kernel)?;
    let grid = table.grid();
    grid.check_finite("pressure", pressure)?;
    let places: Vec<usize> = (0..grid.nodes()).map(|node| table.place(node)).collect();
    Ok(DMatrix::from_iterator(
        grid.nx(),
        grid.ny(),
        places.iter().map(|&place| {
            let terms = places.iter().zip(pressure.iter());
            compensated_sum(terms.map(|(&other, p)| table.between(place, other) * p))
        }),
    ))
}

/// Neumaier's sum: the rounding error of every addition is collected and added at the end.
fn compensated_sum(terms: impl Iterator<Item = f64>) -> f64 {
    let (sum, lost) = terms.fold((0.0_f64, 0.0_f64), |(sum, lost), term| {
        let next = sum + term;
        let error = if sum.abs() >= term.abs() { (sum - next) + term } else { (term - next) + sum };
        (next, lost + error)
    });
    sum + lost
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Boundary, Grid};

    /// C = 4, 2 and 1 for the node itself, its neighbours along x and along y, 0 otherwise.
    struct Neighbours(Grid);

    impl InfluenceKernel for Neighbours {
        fn grid(&self) -> Grid {
            self.0
        }
        fn boundary(&self) -> Boundary {
            Boundary::Free
        }
        fn coefficient(&self, di: isize, dj: isize) -> f64 {
            match (di.abs(), dj.abs()) {
                (0, 0) => 4.0,
                (1, 0) => 2.0,
                (0, 1) => 1.0,
                _ => 0.0,
            }
        }
    }

    #[test]
    fn hand_computed_grid() -> Result<(), Error> {
        let kernel = Neighbours(Grid::new(3, 2, 1.0, 1.0)?);
        #[rustfmt::skip]
        let pressure = DMatrix::from_column_slice(3, 2, &[
            1.0, 10.0, 100.0,
            0.0, 0.0, 1000.0,
        ]);
        #[rustfmt::skip]
        let expected = DMatrix::from_column_slice(3, 2, &[
            4.0 + 20.0, 2.0 + 40.0 + 200.0, 20.0 + 400.0 + 1000.0,
            1.0, 10.0 + 2000.0, 100.0 + 4000.0,
        ]);
        assert_eq!(direct_sum(&kernel, &pressure)?, expected);
        Ok(())
    }

    #[test]
    fn compensation_keeps_what_cancels() {
        // Plain summation gives 0.
        assert_eq!(compensated_sum([1.0, 1e100, 1.0, -1e100].into_iter()), 2.0);
    }

    #[test]
    fn refuses_bad_fields() -> Result<(), Error> {
        let kernel = Neighbours(Grid::new(3, 2, 1.0, 1.0)?);
        assert!(matches!(
            direct_sum(&kernel, &DMatrix::zeros(2, 3)),
            Err(Error::GridMismatch { expected: (3, 2), found: (2, 3) })
        ));
        let mut pressure = DMatrix::zeros(3, 2);
        pressure[(2, 1)] = f64::NAN;
        assert!(matches!(
            direct_sum(&kernel, &pressure),
            Err(Error::FieldNotFinite { field: "pressure", ix: 2, iy: 1, .. })
        ));
        Ok(())
    }
}
