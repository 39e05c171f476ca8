//! Whether coefficients are those of a kernel.

use super::KernelTable;
use crate::{Error, KernelError};

impl KernelTable {
    /// Compares every coefficient with that of the opposite offset.
    pub(super) fn check_reciprocity(&self) -> Result<(), Error> {
        let opposites = self.values.iter().zip(self.values.iter().rev());
        for (place, (&value, &opposite)) in opposites.enumerate().take(self.center()) {
            if !self.agree(value, opposite) {
                let (di, dj) = self.offset(place);
                return Err(Error::Kernel(KernelError::NotSymmetric { di, dj, value, opposite }));
            }
        }
        Ok(())
    }

    /// Compares every coefficient with those one period further, if the boundary has periods and where the table has
    /// them.
    pub(super) fn check_periodicity(&self) -> Result<(), Error> {
        let (nx, ny) = self.grid.shape();
        let [x_repeats, y_repeats] = self.boundary.repeats();
        if !x_repeats && !y_repeats {
            return Ok(());
        }
        let width = 2 * nx - 1;
        for (place, &value) in self.values.iter().enumerate() {
            let (column, row) = (place % width, place / width);
            let along_x = (x_repeats && column + nx < width).then_some(place + nx);
            let along_y = (y_repeats && row + ny < 2 * ny - 1).then_some(place + ny * width);
            for image in [along_x, along_y].into_iter().flatten() {
                let repeated = self.values[image];
                if !self.agree(value, repeated) {
                    let (di, dj) = self.offset(place);
                    let (image_di, image_dj) = self.offset(image);
                    return Err(Error::Kernel(KernelError::NotPeriodic {
                        di,
                        dj,
                        value,
                        image_di,
                        image_dj,
                        repeated,
                    }));
                }
            }
        }
        Ok(())
    }

    /// Whether two coefficients that ought to be the same are.
    fn agree(&self, value: f64, other: f64) -> bool {
        // A formula may be evaluated in another order for another offset, and an inverse Fourier transform rounds
        // all coefficients as the greatest.
        const TOLERANCE: f64 = 1e-14;
        let scale = self.self_influence().abs();
        (value - other).abs() <= TOLERANCE * value.abs().max(other.abs()).max(scale)
    }

    /// The offset at a place of the table.
    pub(super) fn offset(&self, place: usize) -> (isize, isize) {
        let (nx, ny) = self.grid.shape();
        let width = 2 * nx - 1;
        let signed = |index: usize, n: usize| index as isize - (n as isize - 1);
        (signed(place % width, nx), signed(place / width, ny))
    }
}
