//! Responses to the waves of a grid that repeats.

use std::f64::consts::TAU;

use super::cells::Stresses;
use super::depth::Depth;
use super::lanes::{LANES, Lanes, each};
use super::load::{COMPONENTS, Response, transposed};
use super::rectangle::WaveSums;
use crate::Grid;
use crate::kernel::{Below, sinc};
use crate::parallel::{for_each_chunk, vectorized};

/// A wave has faded at this many times its reciprocal wave number: to 10⁻¹⁴, and all beyond it weigh little in a cell.
const FADED: f64 = 32.0;

/// What a load is between the nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Between {
    /// Uniform on cells: waves that look alike on the grid count as well.
    Cells,
    /// The waves of the grid alone.
    Waves,
}

/// Responses to the waves 0 ≤ kx ≤ nx/2 and 0 ≤ ky ≤ ny/2, ky fastest; to the uniform one [`Response::uniform`].
#[derive(Debug)]
pub(super) struct Spectrum {
    shape: (usize, usize),
    values: Vec<Stresses>,
}

/// A wave along one side: its wave number, and what it has of a load on the nodes.
type Wave = (f64, f64);

/// The same of neighbours along y, side by side.
#[derive(Clone, Copy)]
struct Neighbours {
    q: Lanes,
    weight: Lanes,
    /// Square of the least wave number among them.
    least: f64,
}

/// Wave vectors side by side, their lengths, and what each wave has of a load on the nodes.
struct Waves {
    qx: f64,
    qy: Lanes,
    q: Lanes,
    weight: Lanes,
}

impl Waves {
    #[inline(always)]
    fn new((qx, weight): Wave, along_y: &Neighbours) -> Self {
        let qy = along_y.q;
        Self {
            qx,
            qy,
            // The uniform wave has no direction, and an answer of its own.
            q: each(|k| (qx * qx + qy[k] * qy[k]).sqrt().max(f64::MIN_POSITIVE)),
            weight: each(|k| weight * along_y.weight[k]),
        }
    }
}

/// The waves along a side that look like k of n on the grid, up to the wave number `most`: as many for each k.
fn alike(k: usize, (n, side): (usize, f64), between: Between, most: f64) -> Vec<Wave> {
    let turn = k as f64 / n as f64;
    match between {
        Between::Waves => vec![(TAU * turn / side, 1.0)],
        Between::Cells => {
            let reach = (most * side / TAU + 0.5).ceil() as isize;
            let waves = (-reach..=reach).map(|m| turn + m as f64);
            waves.map(|turn| (TAU * turn / side, sinc(turn))).collect()
        }
    }
}

/// The greatest wave number at a depth: infinite on the surface, where all waves count. With loads on cells no spectrum
/// is asked for there.
fn most(depth: &Depth) -> f64 {
    FADED / depth.least()
}

/// Adds those of a half-space.
#[inline(always)]
fn add_waves(depth: &Depth, sums: &mut WaveSums, x: Wave, y: &Neighbours) {
    vectorized(
        #[inline(always)]
        || {
            let Waves { qx, qy, q, weight } = Waves::new(x, y);
            let (plain, deep) = depth.of_waves(&q);
            let per_q = each(|k| 1.0 / q[k]);
            sums.add(
                (&each(|k| qx * per_q[k]), &each(|k| qy[k] * per_q[k])),
                (&each(|k| weight[k] * plain[k]), &each(|k| weight[k] * deep[k])),
            );
        },
    );
}

/// Responses of a half-space to a load on cells, at the waves (kx, ky) of nx × ny cells: at 0 ≤ ky ≤ ny/2, or as many
/// of them as have not faded.
pub(super) fn along_a_line(
    kx: usize,
    (nx, ny): (usize, usize),
    (dx, dy): (f64, f64),
    depth: &Depth,
    response: &Response,
) -> Vec<Stresses> {
    let most = most(depth);
    let along_x = alike(kx, (nx, dx), Between::Cells, most);
    // The least wave number of those that look like (kx, ky) is its own.
    if TAU * kx as f64 >= most * nx as f64 * dx {
        return Vec::new();
    }
    let reached = (most * ny as f64 * dy / TAU) as usize + 1;
    let count = reached.next_multiple_of(LANES).min(ny / 2 + 1);
    let mut line = vec![[0.0; COMPONENTS]; count];
    let add = |sums: &mut WaveSums, x: Wave, y: &Neighbours| add_waves(depth, sums, x, y);
    for (place, values) in line.chunks_mut(LANES).enumerate() {
        let along_y = neighbours(place * LANES, (ny, dy), Between::Cells, most);
        let sum = sum(&along_x, &along_y, most, &add);
        for (lane, value) in values.iter_mut().enumerate() {
            *value = response.of(&sum.values(lane));
        }
    }
    line
}

/// What looks like each of the waves from `first` on along a side with n nodes, side by side.
fn neighbours(
    first: usize,
    (n, side): (usize, f64),
    between: Between,
    most: f64,
) -> Vec<Neighbours> {
    // Lanes behind the last wave repeat it, and nothing reads them.
    let waves = |lane: usize| alike((first + lane).min(n / 2), (n, side), between, most);
    let lanes: [Vec<Wave>; LANES] = std::array::from_fn(waves);
    let of = |m: usize| {
        let q = each(|k| lanes[k][m].0);
        let least = q.iter().map(|q| q * q).fold(f64::INFINITY, f64::min);
        Neighbours { q, weight: each(|k| lanes[k][m].1), least }
    };
    (0..lanes[0].len()).map(of).collect()
}

/// The sum over all pairs up to the wave number `most`, and some beyond it.
#[inline(always)]
fn sum<S: Default>(
    along_x: &[Wave],
    along_y: &[Neighbours],
    most: f64,
    add: &impl Fn(&mut S, Wave, &Neighbours),
) -> S {
    let mut sum = S::default();
    for y in along_y {
        for &(qx, weight) in along_x {
            if qx * qx + y.least < most * most {
                add(&mut sum, (qx, weight), y);
            }
        }
    }
    sum
}

impl Spectrum {
    pub(super) fn new(grid: &Grid, between: Between, depth: &Depth, response: &Response) -> Self {
        let add = |sums: &mut WaveSums, x: Wave, y: &Neighbours| add_waves(depth, sums, x, y);
        let of = |sums: &WaveSums, lane: usize| response.of(&sums.values(lane));
        Self::summed((grid, between), most(depth), (response, response.uniform()), add, of)
    }

    /// Of layers.
    pub(super) fn of_layers(
        grid: &Grid,
        between: Between,
        below: &Below<'_>,
        response: &Response,
    ) -> Self {
        let most = FADED / below.scale();
        let add = |sums: &mut [Stresses; LANES], x: Wave, y: &Neighbours| {
            let Waves { qx, qy, q, weight } = Waves::new(x, y);
            for (k, sum) in sums.iter_mut().enumerate() {
                if between == Between::Waves || q[k] < most {
                    let found = below.of_wave(q[k], (qx / q[k], qy[k] / q[k]));
                    super::cells::add(sum, weight[k], &found);
                }
            }
        };
        let of = |sums: &[Stresses; LANES], lane: usize| sums[lane];
        Self::summed((grid, between), most, (response, below.uniform()), add, of)
    }

    /// The sum of two.
    pub(super) fn plus(mut self, other: &Self) -> Self {
        let all = self.values.iter_mut().zip(&other.values);
        all.for_each(|(value, other)| super::cells::add(value, 1.0, other));
        self
    }

    /// Sums, for each wave of the grid, over all waves that look like it: `add` gets those up to the wave number
    /// `most`, and some beyond it, and `of` makes stresses of a sum.
    fn summed<S: Default>(
        (grid, between): (&Grid, Between),
        most: f64,
        (response, uniform): (&Response, Stresses),
        add: impl Fn(&mut S, Wave, &Neighbours) + Sync + Send,
        of: impl Fn(&S, usize) -> Stresses + Sync + Send,
    ) -> Self {
        let shape = grid.shape();
        let (nx, ny) = shape;
        let height = ny / 2 + 1;
        let along_y: Vec<Vec<Neighbours>> = (0..height)
            .step_by(LANES)
            .map(|first| neighbours(first, (ny, grid.dy()), between, most))
            .collect();
        let within = if between == Between::Waves { f64::INFINITY } else { most };
        let is_symmetric = nx == ny && grid.dx() == grid.dy() && response.is_symmetric();
        let mut values = vec![[0.0; COMPONENTS]; (nx / 2 + 1) * height];
        for_each_chunk(&mut values, height, |kx, column| {
            let mut along_x = alike(kx, (nx, grid.dx()), between, most);
            // Those that a cell averages to nothing are left out.
            along_x.retain(|(_, weight)| *weight != 0.0);
            let skipped = if is_symmetric { kx / LANES } else { 0 };
            for (values, along_y) in column.chunks_mut(LANES).zip(&along_y).skip(skipped) {
                let sum = sum(&along_x, along_y, within, &add);
                for (lane, value) in values.iter_mut().enumerate() {
                    *value = of(&sum, lane);
                }
            }
        });
        if is_symmetric {
            for kx in 1..height {
                for ky in 0..kx {
                    let other = values[kx + height * ky];
                    values[ky + height * kx] = std::array::from_fn(|c| other[transposed(c)]);
                }
            }
        }
        values[0] = uniform;
        let mut spectrum = Self { shape, values };
        spectrum.silence(response);
        spectrum
    }

    /// The shortest wave along a side with an even number of nodes is its own mirror image: components that change
    /// their sign with the direction are 0.
    fn silence(&mut self, response: &Response) {
        let (nx, ny) = self.shape;
        let height = ny / 2 + 1;
        for c in 0..COMPONENTS {
            let (x, y) = response.signs(c);
            if x < 0.0 && nx.is_multiple_of(2) {
                let last = self.values.len() - height;
                self.values[last..].iter_mut().for_each(|value| value[c] = 0.0);
            }
            if y < 0.0 && ny.is_multiple_of(2) {
                self.values.chunks_mut(height).for_each(|column| column[height - 1][c] = 0.0);
            }
        }
    }

    /// The response of a component to the wave (kx, ky) with kx ≤ nx/2 and ky < ny.
    pub(super) fn at(
        &self,
        (kx, ky): (usize, usize),
        component: usize,
        response: &Response,
    ) -> f64 {
        let ny = self.shape.1;
        let value = |ky: usize| self.values[ky + (ny / 2 + 1) * kx][component];
        if 2 * ky <= ny { value(ky) } else { response.signs(component).1 * value(ny - ky) }
    }
}
