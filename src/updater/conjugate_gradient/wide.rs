//! Schur complements from local solutions that go on beyond the nearest nodes.

use super::galerkin::{self, Axis, Source, displacement, distance};
use super::grouping::Grouping;
use super::groups::{Wide, offset};
use super::local::{Local, Neighbourhood};
use super::tuning::{FAR, FIELD, POINTS};
use crate::convolution::Convolution;
use crate::kernel::KernelTable;
use crate::{Problem, parallel};

/// What a watched node does to pressures, and what that displaces.
struct WideSource<'a> {
    answer: &'a Wide,
    /// Nearest nodes on few points, and the points of all groups.
    near: Vec<(usize, f64)>,
    /// Nearest nodes and groups on few points each.
    few: Vec<(usize, f64)>,
    /// Everything on fewer points, for what is far away, and where that is \[m\].
    whole: Vec<(usize, f64)>,
    centre: [f64; 2],
    radius: f64,
}

/// ```math
/// \tilde S_{ij} = s_i^T C\, s_j ,
/// ```
///
/// as [`galerkin::schur`], with the pressures `s = e - x` of local solutions in which nodes beyond the nearest ones answer in groups.
/// What the source of j displaces is known on a patch of the grid around j, by a convolution. What i does outside of it is small, and
/// interpolated.
pub(super) fn schur(
    problem: &Problem,
    answers: &[Wide],
    (neighbourhood, grouping): (&Neighbourhood, &Grouping),
    matrix: &mut [f64],
) {
    // Few nodes in contact all answer, however far they are.
    let is_narrow = answers.iter().all(|answer| answer.groups.is_empty());
    let Some(convolution) = grouping.convolution.as_ref().filter(|_| !is_narrow) else {
        let locals: Vec<Local> = answers.iter().map(Wide::nearest_alone).collect();
        return galerkin::schur(problem, &locals, matrix);
    };
    let size = answers.len();
    let mut sources: Vec<WideSource<'_>> = Vec::with_capacity(size);
    sources.extend(answers.iter().map(|answer| WideSource::new(problem, answer)));
    let mut columns: Vec<(usize, &mut [f64])> =
        matrix.chunks_mut(size.max(1)).enumerate().collect();
    let products = size * (FIELD + size * POINTS.pow(4));
    parallel::for_each(products, &mut columns, |(j, column)| {
        let source = &sources[*j];
        let around = (neighbourhood, grouping.half_patch);
        let patch = Patch::new(around, convolution.clone(), &source.answer.local);
        for (i, other) in sources.iter().enumerate().skip(*j) {
            column[i] = other.energy(source, problem.table(), &patch);
        }
    });
}

impl<'a> WideSource<'a> {
    fn new(problem: &Problem, answer: &'a Wide) -> Self {
        let (grid, table) = (problem.grid(), problem.table());
        let Wide { local, groups, .. } = answer;
        let core = Source::new(problem, &answer.nearest_alone());
        let (ix, iy) = grid.coordinates(local.node);
        let at = [ix as i32, iy as i32];
        let sides = [grid.dx(), grid.dy()];
        let wrapped = |axis: usize, d: i32| {
            let n = if axis == 0 { grid.nx() } else { grid.ny() };
            (at[axis] + d).rem_euclid(n as i32) as usize
        };
        let place = |d: [i32; 2]| table.place(grid.index(wrapped(0, d[0]), wrapped(1, d[1])));
        let ends = |axis: usize| {
            groups.iter().flat_map(move |group| {
                let centre = group.centre[axis];
                [centre.floor() as i32, centre.ceil() as i32]
            })
        };
        let spread = |axes: &[Axis; 2], weights: &[[f64; POINTS]; POINTS]| {
            let mut points = Vec::with_capacity(POINTS * POINTS);
            for (row, &y) in weights.iter().zip(axes[1].points()) {
                for (weight, &x) in row.iter().zip(axes[0].points()) {
                    points.push((place([x, y]), *weight));
                }
            }
            points
        };
        let add =
            |weights: &mut [[f64; POINTS]; POINTS], pressure: f64, [x, y]: [[f64; POINTS]; 2]| {
                for (row, y) in weights.iter_mut().zip(y) {
                    for (weight, x) in row.iter_mut().zip(x) {
                        *weight += pressure * x * y;
                    }
                }
            };
        let (mut near, mut few) = (core.far.clone(), core.far.clone());
        for group in groups {
            let points = group.points().iter();
            near.extend(points.map(|&(place, share)| (place, -share * group.pressure)));
        }
        if !groups.is_empty() {
            let axes = [0, 1].map(|axis| Axis::of(ends(axis)));
            let mut by_groups = [[0.0; POINTS]; POINTS];
            for group in groups {
                let of = [0, 1].map(|axis| axes[axis].weights(group.centre[axis]));
                add(&mut by_groups, -group.pressure, of);
            }
            few.extend(spread(&axes, &by_groups));
        }
        let axes = [0, 1].map(|axis| Axis::of(ends(axis).chain(core.offsets(axis))));
        let mut all = [[0.0; POINTS]; POINTS];
        for (offset, pressure) in &core.answers {
            let of = [0, 1].map(|axis| axes[axis].weights(f64::from(offset[axis])));
            add(&mut all, *pressure, of);
        }
        for group in groups {
            let of = [0, 1].map(|axis| axes[axis].weights(group.centre[axis]));
            add(&mut all, -group.pressure, of);
        }
        let whole = spread(&axes, &all);
        let middle = |axis: usize| 0.5 * f64::from(axes[axis].first() + axes[axis].last());
        let half = |axis: usize| 0.5 * f64::from(axes[axis].last() - axes[axis].first());
        Self {
            answer,
            near,
            few,
            whole,
            centre: [0, 1].map(|axis| (f64::from(at[axis]) + middle(axis)) * sides[axis]),
            radius: (half(0) * sides[0]).hypot(half(1) * sides[1]),
        }
    }

    /// Work of one source on the displacement that another one causes, which is known on a patch.
    fn energy(&self, other: &Self, table: &KernelTable, patch: &Patch) -> f64 {
        let (grid, boundary) = (table.grid(), table.boundary());
        let work = |here: &[(usize, f64)], there: &[(usize, f64)]| -> f64 {
            here.iter().map(|&(place, p)| p * displacement(table, place, there)).sum()
        };
        let apart = distance(grid, boundary, self.centre, other.centre);
        if apart > FAR * (self.radius + other.radius) {
            return work(&self.whole, &other.whole);
        }
        let [own, from] = [self, other].map(|source| source.answer.local.node);
        let between = offset(grid, boundary, from, own).map(|d| d as i32);
        if !patch.meets_another(between) {
            return work(&self.few, &other.few);
        }
        let known = |node: usize| {
            let offset = offset(grid, boundary, from, node).map(|d| d as i32);
            patch.at(offset)
        };
        let outside = |place: usize| displacement(table, place, &other.near);
        let Wide { local, nearest, groups, .. } = self.answer;
        let at = |node: usize| known(node).unwrap_or_else(|| outside(table.place(node)));
        let nodes = local.contact[..*nearest].iter().zip(&local.weights);
        let mut sum = at(own) - nodes.map(|(&node, x)| x * at(node as usize)).sum::<f64>();
        for group in groups {
            let [first, end] = group.members;
            let share = group.pressure / (end - first) as f64;
            let (mut inside, mut left) = (0.0, 0.0);
            for &node in &local.contact[first..end] {
                match known(node as usize) {
                    Some(value) => inside += value,
                    None => left += 1.0,
                }
            }
            if left > 0.0 {
                let points = group.points().iter();
                inside += left * points.map(|&(place, share)| share * outside(place)).sum::<f64>();
            }
            sum -= share * inside;
        }
        sum
    }
}

/// What a source displaces on the part of the grid around its watched node.
struct Patch {
    /// Cells to its sides.
    half: [i32; 2],
    displacement: Vec<f64>,
}

impl Patch {
    fn new(
        (neighbourhood, half): (&Neighbourhood, [i32; 2]),
        mut convolution: Convolution,
        local: &Local,
    ) -> Self {
        let (grid, boundary) = (neighbourhood.grid(), neighbourhood.boundary());
        let nodes = convolution.grid().nodes();
        let mut patch = Self { half, displacement: vec![0.0; nodes] };
        let mut pressure = vec![0.0; nodes];
        let mut add = |node: usize, p: f64| {
            let offset = offset(grid, boundary, local.node, node).map(|d| d as i32);
            if let Some(place) = patch.place(offset) {
                pressure[place] += p;
            }
        };
        add(local.node, 1.0);
        for (&node, x) in local.contact.iter().zip(&local.weights) {
            add(node as usize, -x);
        }
        if convolution.apply(&pressure, &mut patch.displacement).is_err() {
            // Fields have the shape of its grid: it cannot be.
            patch.displacement.clear();
        }
        patch
    }

    /// The place of an offset from the watched node.
    fn place(&self, [dx, dy]: [i32; 2]) -> Option<usize> {
        let [hx, hy] = self.half;
        (dx.abs() <= hx && dy.abs() <= hy)
            .then(|| (dx + hx) as usize + (2 * hx + 1) as usize * (dy + hy) as usize)
    }

    /// Displacement at an offset, if it is known.
    fn at(&self, offset: [i32; 2]) -> Option<f64> {
        self.place(offset).and_then(|place| self.displacement.get(place).copied())
    }

    /// Whether it has nodes in common with one that lies so many cells away.
    fn meets_another(&self, [dx, dy]: [i32; 2]) -> bool {
        let [hx, hy] = self.half;
        dx.abs() <= 2 * hx && dy.abs() <= 2 * hy
    }
}

#[cfg(test)]
mod tests;
