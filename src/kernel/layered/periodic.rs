//! The symbol of a layered body that repeats with the grid.

use std::f64::consts::TAU;

use super::body::LayeredBody;
use super::cell::{Smoothness, integral};
use super::free::{DEEPEST, spectrum};
use super::radial::{Radial, Spectrum};
use crate::kernel::PeriodicBoussinesq;
use crate::kernel::periodic::{CosineSeries, Even, sinc, wave_number};
use crate::parallel::for_each_chunk;
use crate::{Error, Grid};

/// Where waves hand over to a sum over cells, and over which width, in units of 1 / long side of a cell.
const HANDOVER: f64 = 9.0;
const OVER: f64 = 1.5;
/// erfc of it is 10⁻¹⁷: six widths before the handover there are waves alone, six behind it none.
const WIDTHS: f64 = 6.0;
/// Distance in long sides of a cell at which what cells add is 10⁻¹⁷ of the greatest.
const REACH: f64 = 9.0;
/// Thickness in long sides of a cell from which on waves do all: those before the difference has faded.
const THICK: f64 = 3.5;

/// Ĉ of uniform pressures on cells and on all their images, `mean` at k = 0.
///
/// The half-space of the uppermost layer, and the difference from it: a sum over all waves that look alike on the grid.
/// The difference fades as exp(−2 q h), over many waves if the layer is thin. From some wave number on they are left to
/// the cells themselves: what is left then has no long waves, and reaches no farther than nine cells.
pub(super) fn cells(grid: &Grid, body: &LayeredBody, mean: f64) -> Result<Even, Error> {
    let (nx, ny) = grid.shape();
    let (dx, dy) = (grid.dx(), grid.dy());
    let long = dx.max(dy);
    let love = PeriodicBoussinesq::new(*grid, body.surface_modulus())?;
    let top = body.top_modulus();
    let part = |q: f64| 0.5 * libm::erfc((q * long - HANDOVER) / OVER);
    let difference = |q: f64| body.reduced_compliance(q) - 2.0 / top;
    let near = if body.top_thickness() < THICK * long {
        Some(Near::new(grid, body, |q| difference(q) * (1.0 - part(q))))
    } else {
        None
    };
    let most = match near {
        Some(_) => (HANDOVER + WIDTHS * OVER) / long,
        None => DEEPEST / body.top_thickness(),
    };
    let along = |side: f64| (most * side / TAU + 0.5).ceil() as isize;
    let (most_x, most_y) = (along(dx), along(dy));
    let width = nx / 2 + 1;
    let mut values = vec![0.0; width * (ny / 2 + 1)];
    // On square grids symmetric to the last bit, as free ones are.
    let is_square = dx == dy && nx == ny;
    for_each_chunk(&mut values, width, |ky, row| {
        let near = near.as_ref().map(|near| near.row(ky));
        for (kx, value) in row.iter_mut().enumerate() {
            if (kx, ky) == (0, 0) {
                *value = mean;
                continue;
            }
            if is_square && kx < ky {
                continue;
            }
            let mut sum = 0.0;
            for my in -most_y..=most_y {
                let turn_y = ky as f64 / ny as f64 + my as f64;
                let weight_y = sinc(turn_y);
                for mx in -most_x..=most_x {
                    let turn_x = kx as f64 / nx as f64 + mx as f64;
                    let q = TAU * libm::hypot(turn_x / dx, turn_y / dy);
                    if q >= most || weight_y == 0.0 {
                        continue;
                    }
                    let weight = sinc(turn_x) * weight_y;
                    if weight != 0.0 {
                        let part = if near.is_some() { part(q) } else { 1.0 };
                        sum += weight * part * difference(q) / q;
                    }
                }
            }
            if let Some(near) = &near {
                sum += near.at(kx);
            }
            *value = love.symbol(kx as isize, ky as isize) + sum;
        }
    });
    let at = |kx: usize, ky: usize| {
        let (kx, ky) = if is_square { (kx.max(ky), kx.min(ky)) } else { (kx, ky) };
        values[kx + width * ky]
    };
    Ok(Even::from_fn((nx, ny), at))
}

/// Ĉ of the waves of the grid alone, `mean` at k = 0.
pub(super) fn waves(grid: &Grid, body: &LayeredBody, mean: f64) -> Even {
    let (nx, ny) = grid.shape();
    let width = nx / 2 + 1;
    let mut values = vec![0.0; width * (ny / 2 + 1)];
    for_each_chunk(&mut values, width, |ky, row| {
        let qy = wave_number(ky, ny, grid.dy());
        for (kx, value) in row.iter_mut().enumerate() {
            let q = libm::hypot(wave_number(kx, nx, grid.dx()), qy);
            *value = if (kx, ky) == (0, 0) { mean } else { body.compliance(q) };
        }
    });
    Even::from_fn((nx, ny), |kx, ky| values[kx + width * ky])
}

/// What cells add for waves beyond the handover: a sum over those within reach.
struct Near {
    series_x: CosineSeries,
    series_y: CosineSeries,
    columns: usize,
    /// Integrals over cells at a, b ≥ 0, a fastest.
    values: Vec<f64>,
}

impl Near {
    fn new<G: Fn(f64) -> f64 + Sync>(grid: &Grid, body: &LayeredBody, g: G) -> Self {
        let (dx, dy) = (grid.dx(), grid.dy());
        let long = dx.max(dy);
        let all = spectrum(body, g);
        let spectrum = Spectrum {
            widest: all.widest.min(OVER / long),
            settled: (HANDOVER + WIDTHS * OVER) / long,
            // The window spans this much, thin layers more.
            end: all.end.max((HANDOVER + WIDTHS * OVER) / long),
            ..all
        };
        let depth = 2.0 * body.top_thickness();
        // Beyond the reach there is nothing; the cells that it crosses reach half a diagonal farther.
        let radial = Radial::new(&spectrum, depth.min(long), (REACH + 1.0) * long, 0.15 * long);
        let columns = (REACH * long / dx) as usize + 1;
        let rows = (REACH * long / dy) as usize + 1;
        let mut values = vec![0.0; columns * rows];
        for_each_chunk(&mut values, columns, |b, row| {
            for (a, value) in row.iter_mut().enumerate() {
                let center = (a as f64 * dx, b as f64 * dy);
                if libm::hypot(center.0, center.1) <= REACH * long {
                    // Waves of the handover turn by four and a half over half a cell, wherever it is.
                    let smoothness = Smoothness { depth, most: 1.5 * long };
                    *value = integral(&|r| radial.at_each(r), smoothness, center, (dx, dy));
                }
            }
        });
        Self {
            series_x: CosineSeries::new(grid.nx()),
            series_y: CosineSeries::new(grid.ny()),
            columns,
            values,
        }
    }

    /// The sums over b, at a wave along y.
    fn row(&self, ky: usize) -> NearRow<'_> {
        let rows = self.values.len() / self.columns;
        let sums = (0..self.columns).map(|a| {
            let column: Vec<f64> = (0..rows).map(|b| self.values[a + self.columns * b]).collect();
            self.series_y.sum(&column, ky)
        });
        NearRow { series: &self.series_x, sums: sums.collect() }
    }
}

struct NearRow<'a> {
    series: &'a CosineSeries,
    sums: Vec<f64>,
}

impl NearRow<'_> {
    fn at(&self, kx: usize) -> f64 {
        self.series.sum(&self.sums, kx)
    }
}
