//! Contact nodes farther from a watched node, which answer it in groups.

use super::grouping::Grouping;
use super::local::{Farther, Local, Neighbourhood};
use super::tuning::{ADJACENT, BLOCK, FINE, FINEST, GREATEST_ANSWER, REPRESENTATIVES, SINGLY};
use crate::kernel::KernelTable;
use crate::krylov::NodeSet;
use crate::krylov::single::solve_in_place;
use crate::parallel::vectorized;
use crate::{Boundary, Grid};

/// Contact nodes that answer a watched node together, each with the same pressure.
///
/// Seen from afar they are up to four points of the grid with the same centre: what the kernel makes of their extent, some per cent
/// of a small pressure, is left out.
#[derive(Debug, Clone, Default)]
pub(super) struct Group {
    /// (place in the table, share)
    points: [(usize, f64); 4],
    count: usize,
    /// From the watched node \[cells\].
    pub(super) centre: [f64; 2],
    /// Its first node, and the one behind its last, in a list of all.
    pub(super) members: [usize; 2],
    /// What is closer to the centre sees all its nodes, squared \[sides of a square cell of the same area\].
    adjacent: f64,
    /// The pressures of all its nodes that unit pressure on the watched node takes off.
    pub(super) pressure: f64,
}

/// The answer to a watched node of the contact nodes nearest to it, one by one, and of others in groups.
#[derive(Debug, Clone, Default)]
pub(super) struct Wide {
    /// All nodes with their pressures, the nearest first.
    pub(super) local: Local,
    /// Their places in the table, until it is found.
    places: Vec<usize>,
    /// How many of them answer one by one.
    pub(super) nearest: usize,
    pub(super) groups: Vec<Group>,
    /// Sides of a cell relative to those of a square one of the same area.
    sides: [f64; 2],
}

/// What a block collects.
#[derive(Clone, Copy, Default)]
struct Block {
    nodes: usize,
    sums: [i32; 2],
    /// Where the next of its nodes goes in a list of all.
    next: usize,
    side: f64,
}

impl Group {
    /// The points beside the centre.
    fn place(&mut self, own: [usize; 2], table: &KernelTable) {
        let grid = table.grid();
        let along = |axis: usize, n: usize| {
            let base = self.centre[axis].floor();
            let part = self.centre[axis] - base;
            let first = own[axis] as i32 + base as i32;
            let second = if part > 0.0 { first + 1 } else { first };
            // Centres lie between nodes of the grid, if that is not periodic.
            let wrapped = |i: i32| i.rem_euclid(n as i32) as usize;
            [(wrapped(first), 1.0 - part), (wrapped(second), part)]
        };
        let (xs, ys) = (along(0, grid.nx()), along(1, grid.ny()));
        for (y, of_y) in ys {
            for (x, of_x) in xs {
                if of_x * of_y > 0.0 {
                    self.points[self.count] = (table.place(grid.index(x, y)), of_x * of_y);
                    self.count += 1;
                }
            }
        }
    }

    /// (place in the table, share) of the points that stand for it.
    pub(super) fn points(&self) -> &[(usize, f64)] {
        &self.points[..self.count]
    }

    /// Whether something at an offset from the watched node sees all its nodes.
    fn is_adjacent(&self, offset: [f64; 2], sides: [f64; 2]) -> bool {
        let [x, y] = [0, 1].map(|axis| (offset[axis] - self.centre[axis]) * sides[axis]);
        x * x + y * y < self.adjacent
    }

    /// Its displacement on average by unit pressure at a place, or at its points.
    fn coupling(&self, table: &KernelTable, place: usize) -> f64 {
        self.points().iter().map(|&(own, share)| share * table.between(own, place)).sum()
    }
}

impl Wide {
    /// Of a node that nothing answers yet.
    pub(super) fn of(node: usize) -> Self {
        let local = Local { node, ..Local::default() };
        Self { local, ..Self::default() }
    }

    /// Displacement of one by unit pressure on a group, shared by its nodes.
    fn coupling(&self, table: &KernelTable, group: &Group, at: (usize, [f64; 2])) -> f64 {
        let (place, offset) = at;
        if group.is_adjacent(offset, self.sides) {
            let members = &self.places[group.members[0]..group.members[1]];
            let sum: f64 = members.iter().map(|&own| table.between(own, place)).sum();
            sum / members.len() as f64
        } else {
            group.coupling(table, place)
        }
    }

    /// The nearest nodes as they are, without groups.
    pub(super) fn nearest_alone(&self) -> Local {
        let Local { node, contact, weights } = &self.local;
        let contact = contact[..self.nearest].to_vec();
        Local { node: *node, contact, weights: weights[..self.nearest].to_vec() }
    }

    /// Some nodes of a group, at most so many.
    fn representatives(&self, group: &Group) -> impl Iterator<Item = &usize> {
        let members = &self.places[group.members[0]..group.members[1]];
        members.iter().step_by(members.len().div_ceil(REPRESENTATIVES))
    }

    /// The mean displacement of the nodes of a group by unit pressure shared among those of another one.
    fn coupling_of(&self, table: &KernelTable, group: &Group, other: &Group) -> f64 {
        if !group.is_adjacent(other.centre, self.sides) {
            let terms = other.points().iter();
            return terms.map(|&(place, share)| share * group.coupling(table, place)).sum();
        }
        let (mut sum, mut pairs) = (0.0, 0.0);
        for &place in self.representatives(group) {
            for &other in self.representatives(other) {
                sum += table.between(place, other);
                pairs += 1.0;
            }
        }
        sum / pairs
    }

    /// The same of one group.
    fn own_coupling(&self, table: &KernelTable, group: &Group) -> f64 {
        let places: Vec<usize> = self.representatives(group).copied().collect();
        let (mut sum, mut pairs) = (0.0, 0.0);
        for (k, &place) in places.iter().enumerate() {
            for &other in &places[..k] {
                sum += table.between(place, other);
                pairs += 1.0;
            }
        }
        let own = table.self_influence();
        let part = 1.0 / (group.members[1] - group.members[0]) as f64;
        if pairs > 0.0 { own * part + (1.0 - part) * sum / pairs } else { own }
    }
}

/// From a node to another one, the shorter way round where the half-space repeats \[cells\].
pub(super) fn offset(grid: Grid, boundary: Boundary, from: usize, to: usize) -> [f64; 2] {
    let (from, to) = (grid.coordinates(from), grid.coordinates(to));
    let along = |from: usize, to: usize, n: usize, repeats: bool| {
        let (d, n) = (to as f64 - from as f64, n as f64);
        if !repeats || 2.0 * d.abs() <= n { d } else { d - n.copysign(d) }
    };
    let [x, y] = boundary.repeats();
    [along(from.0, to.0, grid.nx(), x), along(from.1, to.1, grid.ny(), y)]
}

impl Neighbourhood {
    /// The answer of the contact near a node out of contact, in single precision: it enters a Schur complement by the square of
    /// its error.
    pub(super) fn solve_wide(
        &self,
        table: &KernelTable,
        set: &NodeSet,
        grouping: &Grouping,
        node: usize,
    ) -> Wide {
        let mut wide = self.gather(table, set, grouping, node);
        let grid = self.grid();
        let count = wide.nearest;
        let (size, unit) = (count + wide.groups.len(), table.self_influence().recip());
        let own = (table.place(node), [0.0; 2]);
        let at: Vec<(usize, [f64; 2])> = wide.local.contact[..count]
            .iter()
            .zip(&wide.places)
            .map(|(&other, &place)| (place, offset(grid, table.boundary(), node, other as usize)))
            .collect();
        let mut matrix = vec![0.0_f32; size * size];
        let mut x = vec![0.0_f32; size];
        for (j, &place) in at.iter().enumerate() {
            let column = &mut matrix[j * size..(j + 1) * size];
            let (singles, others) = column.split_at_mut(count);
            for (value, &(other, _)) in singles[j..].iter_mut().zip(&at[j..]) {
                *value = (table.between(other, place.0) * unit) as f32;
            }
            for (value, group) in others.iter_mut().zip(&wide.groups) {
                *value = (wide.coupling(table, group, place) * unit) as f32;
            }
            x[j] = (table.between(place.0, own.0) * unit) as f32;
        }
        for (j, group) in wide.groups.iter().enumerate() {
            let column = &mut matrix[(count + j) * size + count + j..(count + j + 1) * size];
            column[0] = (wide.own_coupling(table, group) * unit) as f32;
            for (value, other) in column[1..].iter_mut().zip(&wide.groups[j + 1..]) {
                *value = (wide.coupling_of(table, group, other) * unit) as f32;
            }
            x[count + j] = (wide.coupling(table, group, own) * unit) as f32;
        }
        vectorized(
            #[inline(always)]
            || solve_in_place(&mut matrix, size, &mut x),
        );
        // Groups of nodes that are very unlike are no basis.
        if !x.iter().all(|x| x.abs() < GREATEST_ANSWER) {
            let local = self.solve(table, set, node);
            return Wide { nearest: local.contact.len(), local, ..Wide::default() };
        }
        let mut weights: Vec<f64> = x[..count].iter().map(|&x| f64::from(x)).collect();
        weights.resize(wide.places.len(), 0.0);
        for (group, &x) in wide.groups.iter_mut().zip(&x[count..]) {
            group.pressure = f64::from(x);
            let [from, to] = group.members;
            weights[from..to].fill(f64::from(x) / (to - from) as f64);
        }
        wide.local.weights = weights;
        wide.places = Vec::new();
        wide
    }

    /// The contact near a node in groups.
    fn gather(
        &self,
        table: &KernelTable,
        set: &NodeSet,
        Grouping { blocks: around, .. }: &Grouping,
        node: usize,
    ) -> Wide {
        let mut farther = Vec::new();
        let nearest = self.around(set, node, SINGLY, |candidate| {
            farther.extend(candidate.node.map(|other| (candidate, other)));
            true
        });
        let grid = self.grid();
        let own = grid.coordinates(node);
        let within = nearest.last().map_or(0.0, |&last| {
            let [x, y] = offset(grid, table.boundary(), node, last as usize);
            let [sx, sy] = self.sides();
            (x * sx).hypot(y * sy)
        });
        let fine = (FINE * within).max(FINEST);
        let mut blocks = vec![Block::default(); around.count];
        let block_of = |k: usize| {
            let of = &around.of[k];
            if of.distance < fine { (of.small, BLOCK) } else { (of.large, 3.0 * BLOCK) }
        };
        for (Farther { candidate, offset, .. }, _) in &farther {
            let (block, side) = block_of(*candidate);
            let block = &mut blocks[block as usize];
            block.side = side;
            block.nodes += 1;
            for (sum, d) in block.sums.iter_mut().zip(offset) {
                *sum += d;
            }
        }
        let nearest_count = nearest.len();
        let (mut first, mut groups) = (nearest_count, Vec::new());
        for block in blocks.iter_mut().filter(|block| block.nodes > 0) {
            block.next = first;
            let mut group = Group {
                centre: block.sums.map(|sum| f64::from(sum) / block.nodes as f64),
                members: [first, first + block.nodes],
                adjacent: (ADJACENT * block.side).powi(2),
                ..Group::default()
            };
            group.place([own.0, own.1], table);
            groups.push(group);
            first += block.nodes;
        }
        let mut contact = nearest;
        contact.resize(first, 0);
        for (Farther { candidate, .. }, other) in &farther {
            let block = &mut blocks[block_of(*candidate).0 as usize];
            contact[block.next] = *other;
            block.next += 1;
        }
        let places = contact.iter().map(|&other| table.place(other as usize)).collect();
        let local = Local { node, contact, weights: Vec::new() };
        Wide { local, places, nearest: nearest_count, groups, sides: self.sides() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Boussinesq, Error, HeightMap, PeriodicBoussinesq, Problem};

    fn flat(grid: Grid, periodic: bool) -> Result<Problem, Error> {
        let surface = HeightMap::new(nalgebra::DMatrix::zeros(grid.nx(), grid.ny()))?;
        if periodic {
            Problem::new(&surface, &PeriodicBoussinesq::new(grid, 1.0)?)
        } else {
            Problem::new(&surface, &Boussinesq::new(grid, 1.0)?)
        }
    }

    /// All contact nodes closer than 32 cells answer, once; those of a group alike, and what they carry is that of the group.
    #[test]
    fn all_nodes_in_reach_answer() -> Result<(), Error> {
        for periodic in [false, true] {
            let grid = Grid::square(80, 1.0)?;
            let problem = flat(grid, periodic)?;
            let is_in = |node: usize| node % 7 != 2 && node % 3 != 1;
            let mut set = NodeSet::new(grid.nodes());
            set.assign(is_in);
            let neighbourhood = Neighbourhood::new(&problem);
            for node in [2, 11 + 80 * 40] {
                let wide = neighbourhood.solve_wide(
                    problem.table(),
                    &set,
                    neighbourhood.grouping(problem.table()),
                    node,
                );
                let mut found = wide.local.contact.clone();
                found.sort_unstable();
                let expected: Vec<u32> = (0..grid.nodes())
                    .filter(|&other| {
                        let [x, y] = offset(grid, problem.boundary(), node, other);
                        // On a periodic grid no node is met twice.
                        let twice = periodic && (x.abs() == 40.0 || y.abs() == 40.0);
                        is_in(other) && x * x + y * y < 1023.5 && !twice
                    })
                    .map(|other| other as u32)
                    .collect();
                assert_eq!(found, expected);
                let mut next = wide.nearest;
                assert!((SINGLY..SINGLY + 8).contains(&next), "{next}");
                for group in &wide.groups {
                    let [first, end] = group.members;
                    assert_eq!(first, next);
                    let weights = &wide.local.weights[first..end];
                    assert!(weights.iter().all(|x| *x == weights[0]));
                    let sum: f64 = weights.iter().sum();
                    assert!((sum - group.pressure).abs() < 1e-12);
                    let shares: f64 = group.points().iter().map(|(_, share)| share).sum();
                    assert!((shares - 1.0).abs() < 1e-12);
                    next = end;
                }
                assert_eq!(next, wide.local.contact.len());
            }
        }
        Ok(())
    }

    /// A contact and its mirror image answer alike.
    #[test]
    fn mirror_images_answer_alike() -> Result<(), Error> {
        let grid = Grid::square(63, 1.0)?;
        let problem = flat(grid, false)?;
        let is_in = |node: usize| node % 5 != 3 && node % 11 != 4;
        let image = |node: usize| {
            let (ix, iy) = grid.coordinates(node);
            grid.index(iy, 62 - ix)
        };
        let watched = (20 * 63..).find(|&node| !is_in(node)).unwrap_or_default();
        let mut answers = Vec::new();
        for is_image in [false, true] {
            let mut nodes = vec![false; grid.nodes()];
            for node in (0..grid.nodes()).filter(|&node| is_in(node)) {
                nodes[if is_image { image(node) } else { node }] = true;
            }
            let mut set = NodeSet::new(grid.nodes());
            set.assign(|node| nodes[node]);
            let node = if is_image { image(watched) } else { watched };
            let neighbourhood = Neighbourhood::new(&problem);
            let Wide { local, .. } = neighbourhood.solve_wide(
                problem.table(),
                &set,
                neighbourhood.grouping(problem.table()),
                node,
            );
            let mut weights = vec![0.0; grid.nodes()];
            for (&node, x) in local.contact.iter().zip(&local.weights) {
                weights[node as usize] = *x;
            }
            answers.push(weights);
        }
        for node in 0..grid.nodes() {
            let error = (answers[0][node] - answers[1][image(node)]).abs();
            // Single precision, and other representatives of a group: those of large ones are a sample.
            assert!(error < 1e-4, "{node}: {error:e}");
        }
        Ok(())
    }
}
