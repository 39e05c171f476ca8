//! The scalars of viscoelastic contact at a time, and what its fields are made of.

use crate::Error;
use crate::bed::{Bed, BedState, Superposition};

/// The contact of viscoelastic bodies at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct CreepState {
    /// Time t \[s\], just after a jump there.
    pub time: f64,
    /// Effective load $`W_e = E^\ast \int J(t - s)\, \mathrm{d}W(s)`$ \[N\]. While it has not fallen, contact and gaps
    /// are those of the elastic path at this load.
    pub effective_load: f64,
    /// Load W \[N\].
    pub load: f64,
    /// Approach δ \[m\]; negative where the surfaces are apart.
    pub approach: f64,
    /// Nodes in contact: the first so many of the path.
    pub contact_nodes: usize,
    /// Their area \[m²\].
    pub contact_area: f64,
    /// The same over the nominal area.
    pub contact_area_fraction: f64,
    /// Gap averaged over the nominal area \[m\].
    pub mean_gap: f64,
}

/// Nodes in contact with their area, and that over the nominal one.
pub(super) type Area = (usize, f64, f64);

/// The nodes that a path has in contact from a knot on.
pub(super) fn area_from(bed: &Bed, knot: usize) -> Area {
    let contact = bed.history().states().get(knot).map(|state| &state.contact);
    contact.map_or((0, 0.0, 0.0), |c| (c.contact_nodes, c.contact_area, c.contact_area_fraction))
}

impl CreepState {
    /// That of the path at the effective load.
    pub(super) fn of_path(bed: &Bed, elastic: &BedState, time: f64, load: f64) -> Self {
        let (contact_nodes, contact_area, contact_area_fraction) = area_from(bed, elastic.interval);
        Self {
            time,
            effective_load: elastic.load,
            load,
            approach: elastic.approach,
            contact_nodes,
            contact_area,
            contact_area_fraction,
            mean_gap: elastic.mean_gap,
        }
    }
}

/// Increments (load of the path at the end, weight) as some pieces of one weight each, the mean over the loads in it.
///
/// What a piece leaves out goes with the product of its load and of the change of the weight in it. Their sum is least
/// if it is the same in all pieces: ends are equally far apart in the measure ∫ √(dφ dW). A load that was put on at
/// once is one piece. If there are no more increments than pieces, they stay as they are.
pub(super) fn in_pieces(increments: &[(f64, f64)], pieces: usize) -> Result<Superposition, Error> {
    let expected = "at least 1";
    Error::require("number of pieces", pieces as f64, pieces > 0, expected)?;
    let starts = std::iter::once(0.0).chain(increments.iter().map(|increment| increment.0));
    let lengths: Vec<f64> = increments.iter().zip(starts).map(|(i, start)| i.0 - start).collect();
    let steps = || {
        increments.windows(2).zip(lengths.windows(2)).map(|(pair, length)| {
            // Where nothing is carried between two knots of one load there is no weight.
            let is_none = length[0] <= 0.0 || length[1] <= 0.0;
            let mean = 0.5 * (length[0] + length[1]);
            if is_none { 0.0 } else { ((pair[1].1 - pair[0].1).abs() * mean).sqrt() }
        })
    };
    let variation: f64 = steps().sum();
    if increments.len() <= pieces {
        return Superposition::new(increments.iter().copied());
    }
    let mut merged: Vec<(f64, f64)> = Vec::with_capacity(pieces + 1);
    let (mut start, mut load, mut passed, mut bin) = (0.0, 0.0, 0.0, 0);
    let mut carried = 0.0;
    let changes = std::iter::once(0.0).chain(steps());
    for (&(end, weight), change) in increments.iter().zip(changes) {
        passed += change;
        // Weights that are all the same are one piece; at rounding the last is no bin of its own.
        let part = if variation > 0.0 { passed / variation } else { 0.0 };
        let place = ((part * pieces as f64) as usize).min(pieces - 1);
        if place > bin && load > start {
            merged.push((load, carried / (load - start)));
            (start, carried) = (load, 0.0);
        }
        bin = bin.max(place);
        carried += weight * (end - load);
        load = end;
    }
    if load > start {
        merged.push((load, carried / (load - start)));
    }
    Superposition::new(merged)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A large first increment stays alone; the load is kept.
    #[test]
    fn pieces_carry_what_their_increments_do() -> Result<(), Error> {
        let mut increments = vec![(10.0, 0.5)];
        increments.extend((1..=100).map(|k| {
            let k = f64::from(k);
            (10.0 + 0.1 * k, 0.5 + 0.005 * k)
        }));
        let load: f64 = 5.0 + (1..=100).map(|k| 0.1 * (0.5 + 0.005 * f64::from(k))).sum::<f64>();
        for count in [1, 2, 7, 50, 101, 500] {
            let state = in_pieces(&increments, count)?;
            assert!(state.pieces().len() <= count.min(101), "{count}");
            // Rounding of a hundred sums.
            assert!((state.load() / load - 1.0).abs() < 1e-14, "{count}");
            assert_eq!(state.end(), 20.0);
        }
        let some = in_pieces(&increments, 20)?;
        assert!(some.pieces().len() > 15);
        assert!(in_pieces(&increments, 0).is_err());
        assert_eq!(in_pieces(&[], 3)?.load(), 0.0);
        Ok(())
    }
}
