//! Schur complements from local solutions.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use super::local::Local;
use super::tuning::{FAR, POINTS};
use crate::kernel::KernelTable;
use crate::{Boundary, Grid, Problem, parallel};

/// Pressures that go with a watched node: out of contact a unit pressure on it and the answer of the contact near it,
/// `e_j − x_j`; in contact the answer to its overlap, `−x_q`.
struct Source {
    /// (place in the table, pressure) of all nodes, by the first.
    near: Vec<(usize, f64)>,
    /// The place of the watched node itself.
    own: usize,
    is_in_contact: bool,
    /// The same interpolated to few nodes.
    far: Vec<(usize, f64)>,
    centre: [f64; 2],
    radius: f64,
}

/// ```math
/// \tilde S_{ij} = (e_i - x_i)^T C\, (e_j - x_j)
/// ```
///
/// column by column, for all pairs: the complement of a Galerkin solution, from which the exact one
/// differs by the square of the error of x, and is never greater. The lower triangle is written.
///
/// With nodes q in contact, of which `x_q = C_KK⁻¹ e_q`, it is the same of the matrix M of
/// [`LinearUpdater::watch_both`](crate::updater::LinearUpdater::watch_both): with the sources $`s_j = e_j - x_j`$ and
/// $`s_q = -x_q`$
///
/// ```math
/// \tilde M_{ij} = s_i^T C\, s_j + [i \text{ in contact}]\, s_{j,i} + [j \text{ in contact}]\, s_{i,j}
/// ```
pub(super) fn schur(problem: &Problem, locals: &[Local], matrix: &mut [f64]) {
    let table = problem.table();
    let sources: Vec<Source> = locals.iter().map(|local| Source::new(problem, local)).collect();
    let size = locals.len();
    let products = sources.iter().map(|source| products(source.near.len(), size)).sum();
    let mut columns: Vec<(usize, &mut [f64])> =
        matrix.chunks_mut(size.max(1)).enumerate().collect();
    parallel::for_each(products, &mut columns, |(j, column)| {
        let mut known = Displacements::default();
        for (i, source) in sources.iter().enumerate().skip(*j) {
            column[i] = source.energy(&sources[*j], table, &mut known);
        }
    });
}

/// Displacements of places under one source. Where nodes beside each other are watched, as on a plateau, the places
/// near one of them are near most of the others too.
type Displacements = HashMap<usize, f64, BuildHasherDefault<OfPlace>>;

/// A hash of places. They come from the grid and not from outside, so that a fast one does.
#[derive(Default)]
struct OfPlace(u64);

impl Hasher for OfPlace {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.write_usize(usize::from(*byte)));
    }

    fn write_usize(&mut self, place: usize) {
        // 2⁶⁴ over the golden ratio.
        self.0 = (self.0 ^ place as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    }
}

/// Products, and look-ups that take as long, of a column: those of a source of `nodes` with itself, and with its
/// neighbours among the `size` sources, of which each has some 64.
fn products(nodes: usize, size: usize) -> usize {
    nodes * (nodes + size * 64)
}

impl Source {
    fn new(problem: &Problem, local: &Local) -> Self {
        let (grid, table) = (problem.grid(), problem.table());
        let own = grid.coordinates(local.node);
        let own = [own.0 as i32, own.1 as i32];
        // Offsets from the watched node, the shorter way round where the half-space repeats.
        let [x_repeats, y_repeats] = problem.boundary().repeats();
        let shortest = |d: i32, n: usize, repeats: bool| {
            let n = n as i32;
            match repeats {
                true if 2 * d > n => d - n,
                true if 2 * d < -n => d + n,
                _ => d,
            }
        };
        let offset = |node: u32| {
            let (ix, iy) = grid.coordinates(node as usize);
            [
                shortest(ix as i32 - own[0], grid.nx(), x_repeats),
                shortest(iy as i32 - own[1], grid.ny(), y_repeats),
            ]
        };
        let answers = local.contact.iter().zip(&local.weights);
        let is_in_contact = local.is_in_contact();
        let alone = (!is_in_contact).then_some(local.node);
        let answers: Vec<([i32; 2], f64)> = alone
            .map(|_| ([0, 0], 1.0))
            .into_iter()
            .chain(answers.map(|(&node, x)| (offset(node), -x)))
            .collect();
        let nodes = alone.into_iter().chain(local.contact.iter().map(|&n| n as usize));
        let near = nodes.zip(&answers).map(|(node, (_, p))| (table.place(node), *p));
        let mut near: Vec<(usize, f64)> = near.collect();
        near.sort_unstable_by_key(|(place, _)| *place);
        let axes = [0, 1].map(|axis| Axis::of(answers.iter().map(|(offset, _)| offset[axis])));
        let mut weights = [[0.0; POINTS]; POINTS];
        for (offset, pressure) in &answers {
            let [x, y] = [0, 1].map(|axis| axes[axis].weights(offset[axis]));
            for (row, y) in weights.iter_mut().zip(y) {
                for (weight, x) in row.iter_mut().zip(x) {
                    *weight += pressure * x * y;
                }
            }
        }
        let mut far = Vec::with_capacity(POINTS * POINTS);
        for (row, y) in weights.iter().zip(&axes[1].points[..axes[1].count]) {
            for (weight, x) in row.iter().zip(&axes[0].points[..axes[0].count]) {
                let wrapped = |own: i32, d: i32, n: usize| (own + d).rem_euclid(n as i32) as usize;
                let node =
                    grid.index(wrapped(own[0], *x, grid.nx()), wrapped(own[1], *y, grid.ny()));
                far.push((table.place(node), *weight));
            }
        }
        let sides = [grid.dx(), grid.dy()];
        let middle = |axis: usize| 0.5 * f64::from(axes[axis].first() + axes[axis].last());
        let half = |axis: usize| 0.5 * f64::from(axes[axis].last() - axes[axis].first());
        Self {
            near,
            own: table.place(local.node),
            is_in_contact,
            far,
            centre: [0, 1].map(|axis| (f64::from(own[axis]) + middle(axis)) * sides[axis]),
            radius: (half(0) * sides[0]).hypot(half(1) * sides[1]),
        }
    }

    /// Work of one source on the displacement that another one causes, which is known at some places.
    fn energy(&self, other: &Self, table: &KernelTable, known: &mut Displacements) -> f64 {
        let distance = distance(table.grid(), table.boundary(), self.centre, other.centre);
        if distance > FAR * (self.radius + other.radius) {
            return self
                .far
                .iter()
                .map(|here| here.1 * displacement(table, here.0, &other.far))
                .sum();
        }
        // The answer of the contact near a watched node takes its displacement away there. What a node in contact
        // displaces there is nothing but its own overlap, which goes with the last term.
        let mut answering = other.near.iter().peekable();
        let mut work = if self.is_in_contact { other.at(self.own) } else { 0.0 };
        for &(place, pressure) in &self.near {
            while answering.next_if(|(other, _)| *other < place).is_some() {}
            let is_taken_away = (place != other.own || other.is_in_contact)
                && answering.peek().is_some_and(|(other, _)| *other == place);
            if !is_taken_away {
                let found = known.entry(place);
                work +=
                    pressure * *found.or_insert_with(|| displacement(table, place, &other.near));
            }
        }
        work
    }

    /// Pressure at a place.
    fn at(&self, place: usize) -> f64 {
        let found = self.near.binary_search_by_key(&place, |&(other, _)| other);
        found.map_or(0.0, |k| self.near[k].1)
    }
}

/// Displacement of a place under some pressures. Four sums side by side: one waits for each of its additions.
fn displacement(table: &KernelTable, place: usize, pressures: &[(usize, f64)]) -> f64 {
    let term = |&(other, pressure): &(usize, f64)| table.between(place, other) * pressure;
    let fours = pressures.chunks_exact(4);
    let rest: f64 = fours.remainder().iter().map(term).sum();
    let mut sums = [0.0; 4];
    for four in fours {
        for (sum, pressure) in sums.iter_mut().zip(four) {
            *sum += term(pressure);
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// How far two points are from each other, the shorter way round where the half-space repeats.
fn distance(grid: Grid, boundary: Boundary, a: [f64; 2], b: [f64; 2]) -> f64 {
    let (lx, ly) = grid.sides();
    let repeats = boundary.repeats();
    let [dx, dy] = [(0, lx), (1, ly)].map(|(axis, side)| {
        let d = (a[axis] - b[axis]).abs();
        if repeats[axis] { d.min((side - d).abs()) } else { d }
    });
    dx.hypot(dy)
}

/// Up to [`POINTS`] points between the least and the greatest offset along an axis.
#[derive(Default)]
struct Axis {
    points: [i32; POINTS],
    count: usize,
}

impl Axis {
    fn of(offsets: impl Iterator<Item = i32> + Clone) -> Self {
        let (first, last) =
            (offsets.clone().min().unwrap_or_default(), offsets.max().unwrap_or_default());
        let count = POINTS.min((last - first + 1) as usize);
        let mut points = [0; POINTS];
        for (k, point) in points[..count].iter_mut().enumerate() {
            let gaps = count.max(2) as i32 - 1;
            *point = first + (2 * (last - first) * k as i32 + gaps) / (2 * gaps);
        }
        Self { points, count }
    }

    fn first(&self) -> i32 {
        self.points[0]
    }

    fn last(&self) -> i32 {
        self.points[self.count - 1]
    }

    /// Lagrange's polynomials at an offset.
    fn weights(&self, offset: i32) -> [f64; POINTS] {
        let mut weights = [0.0; POINTS];
        let points = &self.points[..self.count];
        for (k, (weight, &point)) in weights.iter_mut().zip(points).enumerate() {
            let others = points.iter().enumerate().filter(|(other, _)| *other != k);
            *weight = others
                .map(|(_, &other)| f64::from(offset - other) / f64::from(point - other))
                .product();
        }
        weights
    }
}

#[cfg(test)]
mod tests;
