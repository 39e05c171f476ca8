//! Responses to the waves of a grid that repeats.

use std::f64::consts::TAU;

use super::cells::Stresses;
use super::depth::Depth;
use super::load::{COMPONENTS, Response};
use super::rectangle::Values;
use crate::Grid;
use crate::kernel::{Below, sinc};
use crate::parallel::for_each_chunk;

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

/// Responses to the waves 0 ≤ kx ≤ nx/2 and 0 ≤ ky ≤ ny/2, kx fastest; to the uniform one [`Response::uniform`].
#[derive(Debug)]
pub(super) struct Spectrum {
    shape: (usize, usize),
    values: Vec<Stresses>,
}

/// A wave along one side: its wave number, and what it has of a load on the nodes.
type Wave = (f64, f64);

/// A wave vector, its length, and what the wave has of a load on the nodes.
type Alike = ((f64, f64), f64, f64);

/// The waves along a side that look like k of n on the grid, up to the wave number `most`.
fn alike(k: usize, (n, side): (usize, f64), between: Between, most: f64) -> Vec<Wave> {
    let turn = k as f64 / n as f64;
    match between {
        Between::Waves => vec![(TAU * turn / side, 1.0)],
        Between::Cells => {
            let reach = (most * side / TAU + 0.5).ceil() as isize;
            let waves = (-reach..=reach).map(|m| turn + m as f64);
            // Those that a cell averages to nothing are left out.
            let weighed = waves.map(|turn| (TAU * turn / side, sinc(turn)));
            weighed.filter(|(_, weight)| *weight != 0.0).collect()
        }
    }
}

impl Spectrum {
    pub(super) fn new(grid: &Grid, between: Between, depth: &Depth, response: &Response) -> Self {
        // On the surface all waves count; it is never asked for of cells.
        let most = FADED / depth.least();
        Self::summed((grid, between), most, response, response.uniform(), |waves| {
            let mut sum = Values::default();
            waves.for_each(|((qx, qy), q, weight)| {
                let (plain, deep) = depth.of_wave(q);
                sum.add_wave((qx / q, qy / q), (weight * plain, weight * deep));
            });
            response.of(&sum)
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
            let mut sum = [0.0; COMPONENTS];
            waves.for_each(|((qx, qy), q, weight)| {
                super::cells::add(&mut sum, weight, &below.of_wave(q, (qx / q, qy / q)));
            });
            sum
        })
    }

    /// The sum of two.
    pub(super) fn plus(mut self, other: &Self) -> Self {
        let all = self.values.iter_mut().zip(&other.values);
        all.for_each(|(value, other)| super::cells::add(value, 1.0, other));
        self
    }

    /// From the waves that look like each wave of the grid, up to the wave number `most`.
    fn summed(
        (grid, between): (&Grid, Between),
        most: f64,
        response: &Response,
        uniform: Stresses,
        sum: impl Fn(&mut dyn Iterator<Item = Alike>) -> Stresses + Sync + Send,
    ) -> Self {
        let shape = grid.shape();
        let (nx, ny) = shape;
        let along_x: Vec<Vec<Wave>> =
            (0..=nx / 2).map(|kx| alike(kx, (nx, grid.dx()), between, most)).collect();
        let width = along_x.len();
        let mut values = vec![[0.0; COMPONENTS]; width * (ny / 2 + 1)];
        for_each_chunk(&mut values, width, |ky, row| {
            let along_y = alike(ky, (ny, grid.dy()), between, most);
            for (kx, value) in row.iter_mut().enumerate() {
                if (kx, ky) == (0, 0) {
                    *value = uniform;
                    continue;
                }
                let pairs = along_y.iter().flat_map(|y| along_x[kx].iter().map(move |x| (x, y)));
                let mut waves = pairs.filter_map(|(&(qx, weight_x), &(qy, weight_y))| {
                    let q = (qx * qx + qy * qy).sqrt();
                    let counts = between == Between::Waves || q < most;
                    counts.then_some(((qx, qy), q, weight_x * weight_y))
                });
                *value = sum(&mut waves);
                // The shortest wave of an even number of nodes runs both ways: what depends on the way is nothing.
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
        let width = self.shape.0 / 2 + 1;
        self.values.chunks_mut(width).for_each(|row| row[0] = [0.0; COMPONENTS]);
        self
    }

    /// The response of a component to the wave (kx, ky) with kx ≤ nx/2 and ky < ny.
    pub(super) fn at(
        &self,
        (kx, ky): (usize, usize),
        component: usize,
        response: &Response,
    ) -> f64 {
        let (nx, ny) = self.shape;
        let value = |ky: usize| self.values[kx + (nx / 2 + 1) * ky][component];
        if 2 * ky <= ny { value(ky) } else { response.signs(component).1 * value(ny - ky) }
    }
}
