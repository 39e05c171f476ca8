//! How a watched node acts on the contact near it.

use crate::Problem;
use crate::kernel::KernelTable;
use crate::krylov::NodeSet;
use crate::parallel::vectorized;
use crate::{Boundary, Grid};

/// Nodes in contact that a local solution takes into account at least, if there are so many in reach.
const NEAREST: usize = 96;
/// So far away they may be, in cells of the shorter side.
const REACH: f64 = 32.0;
/// Products, and look-ups that take as long, of a local solution.
pub(super) const PRODUCTS: usize = NEAREST * NEAREST * NEAREST;
/// Lanes of the sums in single precision.
const LANES: usize = 32;

/// `x = C_KK⁻¹ C_Kj` on the contact nodes K near a watched node j: what pressure on j, and none but
/// that of K to answer it, takes off K.
#[derive(Debug, Clone, Default)]
pub(super) struct Local {
    pub(super) node: usize,
    /// K.
    pub(super) contact: Vec<u32>,
    /// x.
    pub(super) weights: Vec<f64>,
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
        let shorter = grid.dx().min(grid.dy());
        let [reach_x, reach_y] = [(grid.nx(), grid.dx()), (grid.ny(), grid.dy())].map(|(n, d)| {
            let most = match boundary {
                Boundary::Free => n - 1,
                // So that no node is met twice.
                Boundary::Periodic => (n - 1) / 2,
            };
            ((REACH * shorter / d) as usize).max(1).min(most) as i32
        });
        let mut offsets = Vec::new();
        for dy in -reach_y..=reach_y {
            for dx in -reach_x..=reach_x {
                let (x, y) = (
                    f64::from(dx) * grid.dx() / shorter,
                    f64::from(dy) * grid.dy() / shorter,
                );
                let squared = x * x + y * y;
                if (dx, dy) != (0, 0) && squared <= REACH * REACH {
                    offsets.push((squared, dy, dx));
                }
            }
        }
        offsets.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        Self {
            grid,
            boundary,
            offsets,
        }
    }

    /// The contact nodes nearest to a node, in whole shells of one distance, so that symmetry is kept.
    fn nearest(&self, set: &NodeSet, node: usize) -> Vec<u32> {
        if set.len() <= NEAREST {
            return set.nodes().to_vec();
        }
        let (nx, ny) = (self.grid.nx() as i32, self.grid.ny() as i32);
        let (ix, iy) = self.grid.coordinates(node);
        let (ix, iy) = (ix as i32, iy as i32);
        let places = set.places();
        let mut found = Vec::with_capacity(NEAREST + LANES);
        let mut last = 0.0;
        for &(squared, dy, dx) in &self.offsets {
            if found.len() >= NEAREST && squared > last * (1.0 + 1e-9) {
                break;
            }
            let (mut x, mut y) = (ix + dx, iy + dy);
            match self.boundary {
                Boundary::Periodic => (x, y) = (x.rem_euclid(nx), y.rem_euclid(ny)),
                Boundary::Free if x < 0 || y < 0 || x >= nx || y >= ny => continue,
                Boundary::Free => {}
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
        let contact = self.nearest(set, node);
        let places: Vec<usize> = contact
            .iter()
            .map(|&other| table.place(other as usize))
            .collect();
        let (size, own, unit) = (
            contact.len(),
            table.place(node),
            table.self_influence().recip(),
        );
        let mut matrix = vec![0.0_f32; size * size];
        for (i, &place) in places.iter().enumerate() {
            let row = &mut matrix[i * size..i * size + i + 1];
            for (value, &other) in row.iter_mut().zip(&places) {
                *value = (table.between(place, other) * unit) as f32;
            }
        }
        let coupling = places
            .iter()
            .map(|&place| (table.between(place, own) * unit) as f32);
        let mut x: Vec<f32> = coupling.collect();
        vectorized(
            #[inline(always)]
            || solve_in_place(&mut matrix, size, &mut x),
        );
        Local {
            node,
            contact,
            weights: x.into_iter().map(f64::from).collect(),
        }
    }
}

/// `x ← A⁻¹ x` for a symmetric positive definite A given row by row, of which only the lower triangle is
/// read; it becomes its Cholesky factor.
#[inline(always)]
fn solve_in_place(a: &mut [f32], size: usize, x: &mut [f32]) {
    for i in 0..size {
        let (above, row) = a.split_at_mut(i * size);
        let row = &mut row[..=i];
        for j in 0..i {
            let other = &above[j * size..=j * size + j];
            row[j] = (row[j] - product(&row[..j], &other[..j])) / other[j];
        }
        let pivot = row[i] - product(&row[..i], &row[..i]);
        // Rounding must not end it: a solution that is a little off is as good as any.
        row[i] = pivot.max(1e-6).sqrt();
        x[i] = (x[i] - product(&row[..i], &x[..i])) / row[i];
    }
    for i in (0..size).rev() {
        let row = &a[i * size..=i * size + i];
        x[i] /= row[i];
        let last = x[i];
        for (value, entry) in x[..i].iter_mut().zip(row) {
            *value -= entry * last;
        }
    }
}

/// Σ aᵢ bᵢ in a fixed order.
#[inline(always)]
fn product(a: &[f32], b: &[f32]) -> f32 {
    let mut sums = [0.0_f32; LANES];
    let (whole, rest) = a.as_chunks::<LANES>();
    let (others, others_rest) = b.as_chunks::<LANES>();
    for (a, b) in whole.iter().zip(others) {
        for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
            *sum += a * b;
        }
    }
    let rest: f32 = rest.iter().zip(others_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f32>() + rest
}
