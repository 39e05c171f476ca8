//! Responses to the waves of a grid that repeats.

use std::f64::consts::TAU;

use super::cells::Stresses;
use super::depth::Depth;
use super::lanes::{LANES, Lanes, each};
use super::load::{COMPONENTS, Response};
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
    /// Square of the least wave number.
    least: f64,
}

/// Wave vectors, their lengths, and what each wave has of a load on the nodes.
struct Waves {
    qx: f64,
    qy: Lanes,
    q: Lanes,
    weight: Lanes,
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

impl Spectrum {
    pub(super) fn new(grid: &Grid, between: Between, depth: &Depth, response: &Response) -> Self {
        // On the surface all waves count; it is never asked for of cells.
        let most = FADED / depth.least();
        Self::summed((grid, between), most, response, response.uniform(), |waves| {
            let mut sums = WaveSums::default();
            vectorized(
                #[inline(always)]
                || {
                    for Waves { qx, qy, q, weight } in waves {
                        let (plain, deep) = depth.of_waves(&q);
                        sums.add(
                            (&each(|k| qx / q[k]), &each(|k| qy[k] / q[k])),
                            (&each(|k| weight[k] * plain[k]), &each(|k| weight[k] * deep[k])),
                        );
                    }
                },
            );
            std::array::from_fn(|lane| response.of(&sums.values(lane)))
        })
    }

    /// Of layers.
    pub(super) fn of_layers(
        grid: &Grid,
        between: Between,
        below: &Below<'_>,
        response: &Response,
    ) -> Self {
        let most = FADED / below.scale();
        Self::summed((grid, between), most, response, below.uniform(), |waves| {
            let mut sums = [[0.0; COMPONENTS]; LANES];
            for Waves { qx, qy, q, weight } in waves {
                for (k, sum) in sums.iter_mut().enumerate() {
                    if between == Between::Waves || q[k] < most {
                        let found = below.of_wave(q[k], (qx / q[k], qy[k] / q[k]));
                        super::cells::add(sum, weight[k], &found);
                    }
                }
            }
            sums
        })
    }

    /// The sum of two.
    pub(super) fn plus(mut self, other: &Self) -> Self {
        let all = self.values.iter_mut().zip(&other.values);
        all.for_each(|(value, other)| super::cells::add(value, 1.0, other));
        self
    }

    /// From the waves that look like each wave of the grid, of which `sum` is given all that are not beyond the wave
    /// number `most`, and some that are.
    fn summed(
        (grid, between): (&Grid, Between),
        most: f64,
        response: &Response,
        uniform: Stresses,
        sum: impl Fn(&mut dyn Iterator<Item = Waves>) -> [Stresses; LANES] + Sync + Send,
    ) -> Self {
        let shape = grid.shape();
        let (nx, ny) = shape;
        let height = ny / 2 + 1;
        let neighbours = |first: usize| -> Vec<Neighbours> {
            // Behind the last there is nothing to be found.
            let waves =
                |lane: usize| alike((first + lane).min(height - 1), (ny, grid.dy()), between, most);
            let lanes: [Vec<Wave>; LANES] = std::array::from_fn(waves);
            let of = |m: usize| {
                let q = each(|k| lanes[k][m].0);
                let least = q.iter().map(|q| q * q).fold(f64::INFINITY, f64::min);
                Neighbours { q, weight: each(|k| lanes[k][m].1), least }
            };
            (0..lanes[0].len()).map(of).collect()
        };
        let along_y: Vec<Vec<Neighbours>> = (0..height).step_by(LANES).map(neighbours).collect();
        let mut values = vec![[0.0; COMPONENTS]; (nx / 2 + 1) * height];
        for_each_chunk(&mut values, height, |kx, column| {
            let mut along_x = alike(kx, (nx, grid.dx()), between, most);
            // Those that a cell averages to nothing are left out.
            along_x.retain(|(_, weight)| *weight != 0.0);
            for (values, along_y) in column.chunks_mut(LANES).zip(&along_y) {
                let pairs = along_y.iter().flat_map(|y| along_x.iter().map(move |x| (x, y)));
                let mut waves = pairs.filter_map(|(&(qx, weight), y)| {
                    let counts = between == Between::Waves || qx * qx + y.least < most * most;
                    counts.then(|| Waves {
                        qx,
                        qy: y.q,
                        // The uniform wave has no direction, and an answer of its own.
                        q: each(|k| (qx * qx + y.q[k] * y.q[k]).sqrt().max(f64::MIN_POSITIVE)),
                        weight: each(|k| weight * y.weight[k]),
                    })
                });
                let sums = sum(&mut waves);
                values.copy_from_slice(&sums[..values.len()]);
            }
            if kx == 0 {
                column[0] = uniform;
            }
            // The shortest wave of an even number of nodes runs both ways: what depends on the way is nothing.
            for (ky, value) in column.iter_mut().enumerate() {
                for (c, value) in value.iter_mut().enumerate() {
                    let (x, y) = response.signs(c);
                    if (x < 0.0 && 2 * kx == nx) || (y < 0.0 && 2 * ky == ny) {
                        *value = 0.0;
                    }
                }
            }
        });
        Self { shape, values }
    }

    /// Takes out the waves that do not vary along x.
    pub(super) fn without_mean_along_x(mut self) -> Self {
        self.values[..self.shape.1 / 2 + 1].fill([0.0; COMPONENTS]);
        self
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
