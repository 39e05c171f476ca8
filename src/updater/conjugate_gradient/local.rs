//! How a watched node acts on the contact near it.

use super::tuning::{CANDIDATES, NEAREST, REACH, SAME};
use crate::Problem;
use crate::kernel::KernelTable;
use crate::krylov::NodeSet;
use crate::krylov::single::solve_in_place;
use crate::parallel::vectorized;
use crate::{Boundary, Grid};

/// `x = C_KK⁻¹ C_Kj` on the contact nodes K near a watched node j: what pressure on j, and none but that of K to answer
/// it, takes off K. Of a node j in contact, which is one of K, it is `x = C_KK⁻¹ e_j`: what a gap of j adds to
/// pressures.
#[derive(Debug, Clone, Default)]
pub(super) struct Local {
    pub(super) node: usize,
    /// K.
    pub(super) contact: Vec<u32>,
    /// x.
    pub(super) weights: Vec<f64>,
}

impl Local {
    /// Whether the node is in contact.
    pub(super) fn is_in_contact(&self) -> bool {
        self.contact.contains(&(self.node as u32))
    }
}

/// Offsets to the nodes around a node, nearest first.
#[derive(Debug, Clone)]
pub(super) struct Neighbourhood {
    grid: Grid,
    boundary: Boundary,
    /// (squared distance, dy, dx)
    offsets: Vec<(f64, i32, i32)>,
}

impl Neighbourhood {
    pub(super) fn new(problem: &Problem) -> Self {
        let (grid, boundary) = (problem.grid(), problem.boundary());
        // Sides of a cell relative to those of a square one of the same area.
        let side_x = grid.dx().sqrt() / grid.dy().sqrt();
        let side_y = grid.dy().sqrt() / grid.dx().sqrt();
        let [x_repeats, y_repeats] = boundary.repeats();
        // So that no node is met twice where the grid repeats.
        let most = |n: usize, repeats: bool| if repeats { (n - 1) / 2 } else { n - 1 };
        let (most_x, most_y) = (most(grid.nx(), x_repeats), most(grid.ny(), y_repeats));
        let all = (2 * most_x + 1) * (2 * most_y + 1) - 1;
        let (mut reach, mut offsets) = (REACH, Vec::new());
        while offsets.len() < all.min(CANDIDATES) {
            offsets.clear();
            let [end_x, end_y] = [(most_x, side_x), (most_y, side_y)]
                .map(|(most, side)| ((reach / side) as usize).min(most) as i32);
            for dy in -end_y..=end_y {
                for dx in -end_x..=end_x {
                    let (x, y) = (f64::from(dx) * side_x, f64::from(dy) * side_y);
                    let squared = x * x + y * y;
                    if (dx, dy) != (0, 0) && squared <= reach * reach {
                        offsets.push((squared, dy, dx));
                    }
                }
            }
            reach *= 2.0;
        }
        offsets.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        if let Some(&(last, _, _)) = offsets.get(CANDIDATES) {
            offsets.retain(|(squared, _, _)| *squared <= last * (1.0 + SAME));
        }
        Self { grid, boundary, offsets }
    }

    /// The grid of the nodes.
    pub(super) fn grid(&self) -> Grid {
        self.grid
    }

    /// The contact nodes nearest to a node, in whole shells of one distance, so that symmetry is kept.
    fn nearest(&self, set: &NodeSet, node: usize) -> Vec<u32> {
        if set.len() <= NEAREST {
            return set.nodes().to_vec();
        }
        let (nx, ny) = (self.grid.nx() as i32, self.grid.ny() as i32);
        let (ix, iy) = self.grid.coordinates(node);
        let (ix, iy) = (ix as i32, iy as i32);
        let [x_repeats, y_repeats] = self.boundary.repeats();
        let places = set.places();
        let mut found = Vec::with_capacity(NEAREST);
        let mut last = 0.0;
        for &(squared, dy, dx) in &self.offsets {
            if found.len() >= NEAREST && squared > last * (1.0 + SAME) {
                break;
            }
            let (mut x, mut y) = (ix + dx, iy + dy);
            if x_repeats {
                x = x.rem_euclid(nx);
            }
            if y_repeats {
                y = y.rem_euclid(ny);
            }
            if x < 0 || y < 0 || x >= nx || y >= ny {
                continue;
            }
            let other = x as usize + self.grid.nx() * y as usize;
            if places[other] != NodeSet::NONE {
                found.push(other as u32);
                last = squared;
            }
        }
        found
    }

    /// The local solution of a node out of contact, in single precision: it enters a Schur complement by
    /// the square of its error.
    pub(super) fn solve(&self, table: &KernelTable, set: &NodeSet, node: usize) -> Local {
        let own = table.place(node);
        let coupling = |place: usize| table.between(place, own);
        Self::answer(table, node, self.nearest(set, node), coupling)
    }

    /// The local solution of a node in contact.
    pub(super) fn solve_inside(&self, table: &KernelTable, set: &NodeSet, node: usize) -> Local {
        let mut contact = self.nearest(set, node);
        if !contact.contains(&(node as u32)) {
            contact.push(node as u32);
        }
        let (own, unit) = (table.place(node), table.self_influence());
        let mut local =
            Self::answer(table, node, contact, |place| if place == own { unit } else { 0.0 });
        for x in &mut local.weights {
            *x /= unit;
        }
        local
    }

    /// What takes a displacement off some nodes.
    fn answer(
        table: &KernelTable,
        node: usize,
        contact: Vec<u32>,
        displacement: impl Fn(usize) -> f64,
    ) -> Local {
        let places: Vec<usize> = contact.iter().map(|&other| table.place(other as usize)).collect();
        let (size, unit) = (contact.len(), table.self_influence().recip());
        let mut matrix = vec![0.0_f32; size * size];
        for (j, &place) in places.iter().enumerate() {
            let column = &mut matrix[j * size + j..(j + 1) * size];
            for (value, &other) in column.iter_mut().zip(&places[j..]) {
                *value = (table.between(other, place) * unit) as f32;
            }
        }
        let mut x: Vec<f32> =
            places.iter().map(|&place| (displacement(place) * unit) as f32).collect();
        vectorized(
            #[inline(always)]
            || solve_in_place(&mut matrix, size, &mut x),
        );
        Local { node, contact, weights: x.into_iter().map(f64::from).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Boussinesq, Error, HeightMap, PeriodicBoussinesq, test_chain};

    fn flat(grid: Grid, periodic: bool) -> Result<Problem, Error> {
        let surface = HeightMap::new(nalgebra::DMatrix::zeros(grid.nx(), grid.ny()))?;
        if periodic {
            Problem::new(&surface, &PeriodicBoussinesq::new(grid, 1.0)?)
        } else {
            Problem::new(&surface, &Boussinesq::new(grid, 1.0)?)
        }
    }

    fn set(nodes: usize, is_in: impl Fn(usize) -> bool) -> NodeSet {
        let mut set = NodeSet::new(nodes);
        set.assign(is_in);
        set
    }

    /// The nearest 144 in whole shells, by distances to all nodes, the shorter way round where they repeat.
    #[test]
    fn the_nearest_nodes_are_found() -> Result<(), Error> {
        for (grid, periodic) in
            [(Grid::new(14, 13, 1.0, 1.5)?, false), (Grid::new(13, 15, 1.5, 1.0)?, true)]
        {
            let problem = flat(grid, periodic)?;
            let neighbourhood = Neighbourhood::new(&problem);
            for watched in [0, 70, grid.nodes() - 1] {
                let set = set(grid.nodes(), |node| node != watched && node % 11 != 5);
                assert!(set.len() > NEAREST);
                let squared = |node: u32| {
                    let (a, b) = (grid.coordinates(node as usize), grid.coordinates(watched));
                    let along = |a: usize, b: usize, n: usize, d: f64| {
                        let cells = a.abs_diff(b);
                        d * (if periodic { cells.min(n - cells) } else { cells }) as f64
                    };
                    along(a.0, b.0, grid.nx(), grid.dx()).powi(2)
                        + along(a.1, b.1, grid.ny(), grid.dy()).powi(2)
                };
                let mut by_distance = set.nodes().to_vec();
                by_distance.sort_by(|a, b| squared(*a).total_cmp(&squared(*b)));
                let last = squared(by_distance[NEAREST - 1]) * (1.0 + 1e-6);
                let mut expected: Vec<u32> =
                    by_distance.into_iter().filter(|node| squared(*node) <= last).collect();
                let mut found = neighbourhood.nearest(&set, watched);
                assert!(found.is_sorted_by(|a, b| squared(*a) <= squared(*b) * (1.0 + 1e-9)));
                found.sort_unstable();
                expected.sort_unstable();
                assert_eq!(found, expected, "{watched}");
            }
        }
        Ok(())
    }

    /// Two rows of 80 have 159 candidates each way, fewer than are looked at. Of the 101 × 101 nodes of a free grid
    /// within 50 cells, those within 32 are; where the grid repeats within 25, all of them, and half of them beyond a
    /// circle of that radius.
    #[test]
    fn nodes_far_away_are_out_of_reach() -> Result<(), Error> {
        for dx in [1.0, 2.0, 1e-3] {
            let problem = flat(Grid::new(80, 2, dx, 1.0)?, false)?;
            let found = Neighbourhood::new(&problem).nearest(&set(160, |node| node > 0), 0);
            assert!(found.len() >= NEAREST, "{}", found.len());
        }
        let wide = Neighbourhood::new(&flat(Grid::new(51, 51, 1.0, 1.0)?, false)?);
        let farthest = |beside: &Neighbourhood| beside.offsets.last().map(|last| last.0);
        assert_eq!((wide.offsets.len(), farthest(&wide)), (CANDIDATES, Some(1024.0)));
        let corner = set(51 * 51, |node| node < 20 * 51);
        // 20 of 51 rows, seen from the middle of the last one: those of 26 rows and more below are not.
        assert!(wide.nearest(&corner, 50 * 51 + 25).iter().all(|&node| node >= 18 * 51));
        let around = Neighbourhood::new(&flat(Grid::new(51, 51, 1.0, 1.0)?, true)?);
        assert_eq!((around.offsets.len(), farthest(&around)), (51 * 51 - 1, Some(1250.0)));
        // Of few nodes all are taken into account.
        let problem = flat(Grid::new(80, 2, 1.0, 1.0)?, false)?;
        let found = Neighbourhood::new(&problem).nearest(&set(160, |node| node > 80), 0);
        assert_eq!(found, (81..160).collect::<Vec<u32>>());
        Ok(())
    }

    /// On cells sixteen times as long as wide candidates lie within an ellipse, so many times as long in cells across
    /// as along.
    #[test]
    fn as_many_nodes_are_in_reach_on_long_cells() -> Result<(), Error> {
        let grid = Grid::new(20, 300, 16.0, 1.0)?;
        let offsets = Neighbourhood::new(&flat(grid, false)?).offsets;
        assert!((CANDIDATES..CANDIDATES + 8).contains(&offsets.len()), "{}", offsets.len());
        let [most_x, most_y] = [|o: &(f64, i32, i32)| o.2.abs(), |o: &(f64, i32, i32)| o.1.abs()]
            .map(|along| offsets.iter().map(along).max());
        assert_eq!((most_x, most_y), (Some(8), Some(128)));
        // However long they are, the search comes to an end.
        let longest = Grid::new(3, 60, 1e-45, 1e45)?;
        let offsets = Neighbourhood::new(&flat(longest, false)?).offsets;
        assert_eq!(offsets.len(), 5 * 119 - 1);
        Ok(())
    }

    /// Beside a node alone x = 1/4. Of the neighbours 0 and 1 it is (−1, 4)/15 for node 2.
    #[test]
    fn local_solutions_of_nodes_in_a_row() -> Result<(), Error> {
        let problem = test_chain::problem(&[0.0; 5])?;
        let neighbourhood = Neighbourhood::new(&problem);
        let cases = [
            (1, vec![0, 2], vec![0.25, 0.25]),
            (3, vec![0, 2], vec![0.0, 0.25]),
            (2, vec![0, 1], vec![-1.0 / 15.0, 4.0 / 15.0]),
            (4, vec![], vec![]),
        ];
        for (node, contact, weights) in cases {
            let set = set(5, |node| contact.contains(&(node as u32)));
            let local = neighbourhood.solve(problem.table(), &set, node);
            assert_eq!((local.node, &local.contact), (node, &contact));
            assert_eq!(local.weights.len(), weights.len());
            for (found, expected) in local.weights.iter().zip(&weights) {
                // Rounding errors in single precision.
                assert!((found - expected).abs() < 1e-7, "{found} {expected}");
            }
        }
        Ok(())
    }
}
