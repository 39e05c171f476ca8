//! States made of increments of a path with weights.

use nalgebra::DMatrix;

use super::{Bed, BedState};
use crate::{Error, LoadingPath, LoadingState};

/// A state ∫ φ(s) dp(s) with a weight φ that is constant in pieces. See the [module](super).
///
/// Its load is known without a path; everything else takes the [`Bed`] of one.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Superposition {
    pieces: Vec<Piece>,
}

/// A stretch of a path with one weight.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Piece {
    /// Load of the path at which it begins \[N\].
    pub start: f64,
    /// Load of the path at which it ends \[N\].
    pub end: f64,
    /// The weight φ of its increments.
    pub weight: f64,
}

/// The scalars of a superposition.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Superposed {
    /// `∫ φ ds` \[N\].
    pub load: f64,
    /// `∫ φ dδ` \[m\].
    pub approach: f64,
    /// The initial mean gap and `∫ φ dḡ` \[m\].
    pub mean_gap: f64,
    /// Elastic energy `½ ΔA Σ p u` \[J\] of pressures p and displacements u.
    pub energy: f64,
}

impl Superposition {
    /// Pieces of a path from first touch on: each ends at a load \[N\] and has a weight. A piece without length is left
    /// out.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for ends that are not finite or fall, and weights that are not finite.
    pub fn new(pieces: impl IntoIterator<Item = (f64, f64)>) -> Result<Self, Error> {
        let mut made = Vec::new();
        let mut start = 0.0;
        for (end, weight) in pieces {
            let is_next = end >= start && end.is_finite();
            Error::require("end of a piece", end, is_next, "finite, and no less than that before")?;
            Error::require("weight of a piece", weight, weight.is_finite(), "finite")?;
            if end > start {
                made.push(Piece { start, end, weight });
            }
            start = end;
        }
        Ok(Self { pieces: made })
    }

    /// The pieces, from first touch on.
    #[must_use]
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// The load of the path at which the last piece ends \[N\].
    #[must_use]
    pub fn end(&self) -> f64 {
        self.pieces.last().map_or(0.0, |piece| piece.end)
    }

    /// Its load, `∫ φ ds` \[N\].
    #[must_use]
    pub fn load(&self) -> f64 {
        self.pieces.iter().map(|piece| piece.weight * (piece.end - piece.start)).sum()
    }

    /// Its scalars.
    ///
    /// # Errors
    ///
    /// [`BedError::PathEndsBefore`](crate::BedError::PathEndsBefore).
    pub fn scalars(&self, bed: &Bed) -> Result<Superposed, Error> {
        let ends = self.ends(bed)?;
        let mut sums =
            Superposed { load: 0.0, approach: 0.0, mean_gap: ends[0].mean_gap, energy: 0.0 };
        // From the last piece on, so that the approach of all later ones is at hand.
        for (piece, ends) in self.pieces.iter().zip(ends.windows(2)).rev() {
            let [start, end] = [&ends[0], &ends[1]];
            let weight = piece.weight;
            let (load, approach) = (end.load - start.load, end.approach - start.approach);
            // ∫ (δ(end) − δ(s)) ds over the piece.
            let own = (end.energy - start.energy) - start.load * approach;
            sums.energy += weight * (sums.approach * load + weight * own);
            sums.load += weight * load;
            sums.approach += weight * approach;
            sums.mean_gap += weight * (end.mean_gap - start.mean_gap);
        }
        Ok(sums)
    }

    /// Its pressure \[Pa\].
    ///
    /// Each end of a piece takes a field of the path: a backward substitution with a factor, one solution on a known
    /// contact from a [record](crate::record::LoadingRecord::replay).
    ///
    /// # Errors
    ///
    /// [`BedError::PathEndsBefore`](crate::BedError::PathEndsBefore), and those of [`LoadingPath::fields_at`].
    pub fn pressure(&self, bed: &Bed, path: &mut LoadingPath) -> Result<DMatrix<f64>, Error> {
        self.sum(bed, path, |path, state| path.pressure_at(state))
    }

    /// Its displacement \[m\].
    ///
    /// # Errors
    ///
    /// Those of [`Self::pressure`].
    pub fn displacement(&self, bed: &Bed, path: &mut LoadingPath) -> Result<DMatrix<f64>, Error> {
        self.sum(bed, path, |path, state| Ok(path.fields_at(state)?.displacement))
    }

    /// By how much gaps change, `∫ φ dg` \[m\]; with the initial gap this is what is left of it.
    ///
    /// # Errors
    ///
    /// Those of [`Self::pressure`].
    pub fn gap_change(&self, bed: &Bed, path: &mut LoadingPath) -> Result<DMatrix<f64>, Error> {
        let mut sum = self.sum(bed, path, |path, state| Ok(path.fields_at(state)?.gap))?;
        // At first touch the gap is the initial one, where pressure and displacement are none.
        if let Some(first) = self.pieces.first() {
            for (value, initial) in sum.iter_mut().zip(path.problem().initial_gap()) {
                *value -= first.weight * initial;
            }
        }
        Ok(sum)
    }

    /// Σ φ (field(end) − field(start)) for a field that is none at first touch.
    fn sum(
        &self,
        bed: &Bed,
        path: &mut LoadingPath,
        field: impl Fn(&mut LoadingPath, &LoadingState) -> Result<DMatrix<f64>, Error>,
    ) -> Result<DMatrix<f64>, Error> {
        let (nx, ny) = path.grid().shape();
        let mut sum = DMatrix::zeros(nx, ny);
        let next = self.pieces.iter().skip(1).map(|piece| piece.weight).chain([0.0]);
        for (piece, next) in self.pieces.iter().zip(next) {
            // The end of a piece is the start of the next.
            let weight = piece.weight - next;
            if weight != 0.0 {
                let found = field(path, &bed.path_state(piece.end)?)?;
                sum.zip_apply(&found, |sum, value| *sum += weight * value);
            }
        }
        Ok(sum)
    }

    /// The elastic states at the start of the first piece and at the ends of all.
    fn ends(&self, bed: &Bed) -> Result<Vec<BedState>, Error> {
        let ends = self.pieces.iter().map(|piece| piece.end);
        std::iter::once(0.0).chain(ends).map(|load| bed.at_load(load)).collect()
    }
}
