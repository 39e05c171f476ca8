//! How a watched node acts on the contact near it.

use crate::Problem;
use crate::kernel::KernelTable;
use crate::krylov::NodeSet;
use crate::parallel::vectorized;
use crate::{Boundary, Grid};

/// Nodes in contact that a local solution takes into account at least, if there are so many in reach.
const NEAREST: usize = 144;
/// So far away they may be, in cells of the shorter side.
const REACH: f64 = 32.0;
/// Products, and look-ups that take as long, of a local solution.
pub(super) const PRODUCTS: usize = NEAREST * NEAREST * NEAREST;
/// Lanes of the sums in single precision.
const LANES: usize = 16;

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
        for (j, &place) in places.iter().enumerate() {
            let column = &mut matrix[j * size + j..(j + 1) * size];
            for (value, &other) in column.iter_mut().zip(&places[j..]) {
                *value = (table.between(other, place) * unit) as f32;
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

/// `x ← A⁻¹ x` for a symmetric positive definite A given column by column, of which only the lower triangle
/// is read; it becomes its Cholesky factor.
#[inline(always)]
fn solve_in_place(a: &mut [f32], size: usize, x: &mut [f32]) {
    for j in 0..size {
        let (before, rest) = a.split_at_mut(j * size);
        let column = &mut rest[j..size];
        subtract_columns(before, size, j, column);
        // Rounding must not end it: a solution that is a little off is as good as any.
        let root = column[0].max(1e-6).sqrt();
        let inverse = 1.0 / root;
        column[0] = root;
        for value in &mut column[1..] {
            *value *= inverse;
        }
        x[j] *= inverse;
        let (here, below) = x[j..].split_at_mut(1);
        for (value, entry) in below.iter_mut().zip(&column[1..]) {
            *value -= entry * here[0];
        }
    }
    for j in (0..size).rev() {
        let column = &a[j * size + j..(j + 1) * size];
        let (here, below) = x[j..].split_at_mut(1);
        here[0] = (here[0] - product(&column[1..], below)) / column[0];
    }
}

/// column −= Σ_k L_jk L_k from row j down, for all columns k before j; four at a time, so that the column
/// passes the registers a quarter as often.
#[inline(always)]
fn subtract_columns(before: &[f32], size: usize, j: usize, column: &mut [f32]) {
    let mut blocks = before.chunks_exact(4 * size);
    for block in &mut blocks {
        let of = |k: usize| &block[k * size + j..(k + 1) * size];
        let (c0, c1, c2, c3) = (of(0), of(1), of(2), of(3));
        let (a0, a1, a2, a3) = (c0[0], c1[0], c2[0], c3[0]);
        for ((((value, x0), x1), x2), x3) in column.iter_mut().zip(c0).zip(c1).zip(c2).zip(c3) {
            *value -= (a0 * x0 + a1 * x1) + (a2 * x2 + a3 * x3);
        }
    }
    for other in blocks.remainder().chunks_exact(size) {
        let other = &other[j..];
        let factor = other[0];
        for (value, x) in column.iter_mut().zip(other) {
            *value -= factor * x;
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
