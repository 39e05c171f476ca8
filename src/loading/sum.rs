//! Compensated summation.

/// A sum whose error does not grow with the number of terms (Neumaier 1974).
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sum {
    sum: f64,
    lost: f64,
}

impl Sum {
    /// Adds a term.
    pub(super) fn add(&mut self, term: f64) {
        let sum = self.sum + term;
        self.lost += if self.sum.abs() >= term.abs() {
            (self.sum - sum) + term
        } else {
            (term - sum) + self.sum
        };
        self.sum = sum;
    }

    /// The sum of all terms.
    pub(super) fn total(self) -> f64 {
        self.sum + self.lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whichever of sum and term is greater, what is lost of the other is kept.
    #[test]
    fn nothing_is_lost() {
        for terms in [
            &[1.0, 1e100, 1.0, -1e100][..],
            &[1e100, 2.0, -1e100],
            &[2.0, -1e100, 1e100],
            &[1e100, 1.0, -1e100, -1e-100, 1.0],
            &[0.5, 1.5],
            &[-3.0, -3.0, 8.0],
        ] {
            let mut sum = Sum::default();
            terms.iter().for_each(|term| sum.add(*term));
            assert_eq!(sum.total(), 2.0, "{terms:?}");
        }
    }
}
