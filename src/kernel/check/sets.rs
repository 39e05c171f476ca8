//! Contact sets to try a kernel on.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use crate::Grid;

/// Grids of up to this many nodes have few enough contact sets for all of them: 2¹⁰ − 1.
const EXHAUSTIVE: usize = 10;

/// The whole grid is tried with up to this many nodes.
const WHOLE: usize = 256;

/// Most nodes of a set that is drawn.
const LARGEST: usize = 64;

/// Sets drawn of each kind.
const DRAWN: usize = 80;

/// Contact sets, each without repetitions and in ascending order.
pub(super) struct ContactSets {
    pub(super) list: Vec<Vec<usize>>,
    /// Whether these are all there are.
    pub(super) exhaustive: bool,
}

/// All sets of a small grid; of a larger one scattered nodes, dense patches, patches with holes, and
/// the whole if that is not too large.
pub(super) fn contact_sets(grid: &Grid) -> ContactSets {
    let nodes = grid.nodes();
    if nodes <= EXHAUSTIVE {
        let set = |bits: u32| (0..nodes).filter(|node| bits >> node & 1 == 1).collect();
        return ContactSets { list: (1..1_u32 << nodes).map(set).collect(), exhaustive: true };
    }
    let mut draw = Draw(ChaCha8Rng::from_seed([0; 32]));
    let mut list = Vec::new();
    if nodes <= WHOLE {
        list.push((0..nodes).collect());
    }
    for _ in 0..DRAWN {
        let size = 1 + draw.below(LARGEST.min(nodes));
        list.push(distinct((0..size).map(|_| draw.below(nodes)).collect()));
        // How contacts look: nodes close to each other, with all of a patch or part of it.
        let patch = draw.patch(grid);
        let share = 1 + draw.below(7);
        list.push(distinct(patch.clone()));
        let holes = patch.into_iter().filter(|_| draw.below(8) < share);
        list.push(distinct(holes.collect()));
    }
    list.retain(|set| !set.is_empty());
    ContactSets { list, exhaustive: false }
}

fn distinct(mut set: Vec<usize>) -> Vec<usize> {
    set.sort_unstable();
    set.dedup();
    set
}

/// Random numbers that are the same every time and everywhere.
struct Draw(ChaCha8Rng);

impl Draw {
    /// A number below `limit`.
    fn below(&mut self, limit: usize) -> usize {
        // What the remainder prefers is one part in 2³² of the limit.
        self.0.next_u32() as usize % limit
    }

    /// The nodes of a rectangle of at most [`LARGEST`] nodes, or of the ellipse in it.
    fn patch(&mut self, grid: &Grid) -> Vec<usize> {
        let side = |n: usize| n.min(LARGEST);
        let width = 1 + self.below(side(grid.nx()).min(16));
        let height = 1 + self.below(side(grid.ny()).min(LARGEST / width));
        let (left, low) = (self.below(grid.nx() - width + 1), self.below(grid.ny() - height + 1));
        let round = self.below(2) == 1;
        let inside = |i: usize, n: usize| {
            let x = (2 * i + 1) as f64 / n as f64 - 1.0;
            x * x
        };
        let mut nodes = Vec::with_capacity(width * height);
        for j in 0..height {
            for i in 0..width {
                if !round || inside(i, width) + inside(j, height) < 1.0 {
                    nodes.push(grid.index(left + i, low + j));
                }
            }
        }
        nodes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Error;

    /// Patches are rectangles or the ellipses in them, which fill most of their box, all of it inside the grid.
    #[test]
    fn patches_are_dense() -> Result<(), Error> {
        let mut draw = Draw(ChaCha8Rng::from_seed([1; 32]));
        for (nx, ny) in [(20, 13), (1, 40), (40, 1)] {
            let grid = Grid::new(nx, ny, 1.0, 1.0)?;
            let (mut whole, mut round) = (0, 0);
            for _ in 0..200 {
                let patch = draw.patch(&grid);
                assert!((1..=LARGEST).contains(&patch.len()));
                let places: Vec<_> = patch.iter().map(|&node| grid.coordinates(node)).collect();
                let side = |along: fn(&(usize, usize)) -> usize| {
                    let places = places.iter().map(along);
                    let (least, most) = places
                        .fold((usize::MAX, 0), |(least, most), i| (least.min(i), most.max(i)));
                    1 + most - least
                };
                let (width, height) = (side(|place| place.0), side(|place| place.1));
                assert!(width <= nx && height <= ny);
                let area = width * height;
                // A circle has π/4 of its square.
                assert!(patch.len() <= area && 2 * patch.len() >= area, "{patch:?}");
                whole += usize::from(patch.len() == area);
                round += usize::from(patch.len() < area);
            }
            assert!(whole > 50 && (round > 20 || nx.min(ny) == 1), "{whole} {round}");
        }
        Ok(())
    }
    /// Sets with holes are made of the patch before, from an eighth of it to seven.
    #[test]
    fn holes_are_few_or_many() -> Result<(), Error> {
        let sets = contact_sets(&Grid::new(40, 30, 1.0, 1.0)?);
        assert!(!sets.exhaustive);
        let shares = sets.list.windows(2).filter_map(|pair| {
            let (whole, part) = (&pair[0], &pair[1]);
            let is_part = part.len() < whole.len() && part.iter().all(|node| whole.contains(node));
            (whole.len() >= 16 && is_part).then(|| part.len() as f64 / whole.len() as f64)
        });
        let shares: Vec<f64> = shares.collect();
        let few = shares.iter().filter(|share| **share < 0.3).count();
        let many = shares.iter().filter(|share| **share > 0.7).count();
        // Two sevenths each are expected of some fifty.
        assert!(few >= 5 && many >= 5, "{few} and {many} of {}", shares.len());
        Ok(())
    }
}
