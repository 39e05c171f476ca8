//! The stress kernel of a depth: coefficients, or a symbol, for each surrounding of the grid.

use nalgebra::DMatrix;

use super::across::add_waves_along_x;
use super::cells::{ROWS, Stresses, rectangles, strips};
use super::depth::Depth;
use super::load::{COMPONENTS, Load, Response, transposed};
use super::waves::{Between, Spectrum};
use crate::convolution::{Convolution, Parity};
use crate::kernel::Below;
use crate::{Boundary, Error, Grid};

/// Coefficients by offset.
type Offsets<'a> = &'a (dyn Fn(isize, isize) -> f64 + Sync);

/// Where a layer, or a depth below it, is thinner than this, in long sides of a cell, too many waves look alike on a
/// grid that repeats.
const THIN: f64 = 0.2;

/// Where the load is, and how it is spread.
#[derive(Debug, Clone, Copy)]
pub(super) struct Domain {
    pub(super) grid: Grid,
    pub(super) boundary: Boundary,
    pub(super) between: Between,
}

/// The responses of all components to one load, at one depth.
#[derive(Debug)]
pub(super) struct StressKernel {
    domain: Domain,
    response: Response,
    table: Table,
}

#[derive(Debug)]
enum Table {
    /// At offsets that are not negative, x fastest.
    Free(Vec<Stresses>),
    /// At all offsets of a period, and of waves.
    Periodic { cells: Option<Vec<Stresses>>, waves: Spectrum },
    /// At all offsets of a period along x, and at those that are not negative across.
    AlongX(Vec<Stresses>),
    /// The same with x and y exchanged.
    AlongY(Vec<Stresses>),
}

impl StressKernel {
    /// That of a pressure on layers, at a depth of 0 or more that is not in a rigid base.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] if the depth and the layers are too thin for cells that repeat.
    pub(super) fn of_layers(domain: Domain, below: &Below<'_>, z: f64) -> Result<Self, Error> {
        let (grid, between) = (&domain.grid, domain.between);
        let poissons_ratio = below.added_to();
        let response = Response::new(Load::Normal, poissons_ratio.unwrap_or_default());
        let half_space = poissons_ratio.map(|_| Self::new(domain, response, z)).transpose()?;
        let table = if domain.boundary == Boundary::Free {
            let mut values = below.cells(grid);
            if let Some(Self { table: Table::Free(others), .. }) = &half_space {
                let all = values.iter_mut().zip(others);
                all.for_each(|(value, other)| super::cells::add(value, 1.0, other));
            }
            Table::Free(values)
        } else {
            let thin = below.scale() / grid.dx().max(grid.dy());
            let quantity = "depth to which layers let waves fade over the long side of a cell";
            let is_enough = between == Between::Waves || thin >= THIN;
            Error::require(quantity, thin, is_enough, "at least 0.2 where the grid repeats")?;
            let waves = Spectrum::of_layers(grid, between, below, &response);
            match half_space {
                Some(Self { table: Table::Periodic { cells, waves: others }, .. }) => {
                    Table::Periodic { cells, waves: others.plus(&waves) }
                }
                _ => Table::Periodic { cells: None, waves },
            }
        };
        Ok(Self { domain, response, table })
    }

    pub(super) fn new(domain: Domain, response: Response, z: f64) -> Result<Self, Error> {
        // Responses have no unit: lengths in long sides of a cell.
        let unit = domain.grid.dx().max(domain.grid.dy());
        let sides = (domain.grid.dx() / unit, domain.grid.dy() / unit);
        let (nx, ny) = domain.grid.shape();
        let domain = Domain { grid: Grid::new(nx, ny, sides.0, sides.1)?, ..domain };
        let (grid, z) = (&domain.grid, z / unit);
        let table = match domain.boundary {
            Boundary::Free => Table::Free(rectangles((nx, 0..ny), sides, &[(1.0, z)], &response)),
            Boundary::Periodic => periodic(&domain, &response, z),
            Boundary::PeriodicX => Table::AlongX(along_x(grid, &response, z)),
            Boundary::PeriodicY => {
                Table::AlongY(along_x(&grid.transposed(), &response.transposed(), z))
            }
        };
        Ok(Self { domain, response, table })
    }

    /// Adds all components under a load on the nodes to `sums`.
    pub(super) fn add(
        &self,
        load: &[f64],
        sums: &mut [DMatrix<f64>; COMPONENTS],
    ) -> Result<(), Error> {
        let mut convolution = Convolution::blank((self.domain.grid, self.domain.boundary));
        let mut found = vec![0.0; load.len()];
        for (component, sum) in sums.iter_mut().enumerate() {
            self.set(&mut convolution, component)?;
            convolution.apply(load, &mut found)?;
            sum.iter_mut().zip(&found).for_each(|(sum, value)| *sum += value);
        }
        Ok(())
    }

    /// Makes a convolution that of one component.
    fn set(&self, convolution: &mut Convolution, component: usize) -> Result<(), Error> {
        let parity = self.response.parity(component);
        let (nx, ny) = self.domain.grid.shape();
        let (of_x, _) = self.response.signs(component);
        let sign = |offset: isize, sign: f64| if offset < 0 { sign } else { 1.0 };
        match &self.table {
            Table::Free(values) => {
                let at = |di: isize, dj: isize| {
                    sign(di, of_x) * values[di.unsigned_abs() + nx * dj.unsigned_abs()][component]
                };
                convolution.set(parity, Some(&at), None)
            }
            Table::Periodic { cells, waves } => {
                let of_cells = cells.as_ref().map(|values| {
                    move |di: isize, dj: isize| {
                        values[di.unsigned_abs() + nx * dj.unsigned_abs()][component]
                    }
                });
                let uniform = match cells {
                    Some(values) => values.iter().map(|value| value[component]).sum(),
                    None => 0.0,
                };
                let of_wave = |kx: usize, ky: usize| {
                    let value = waves.at((kx, ky), component, &self.response);
                    // The spectrum has the whole response to the uniform wave: what cells add to it is taken off.
                    if (kx, ky) == (0, 0) && parity == Parity::Even {
                        value - uniform
                    } else {
                        value
                    }
                };
                let of_cells = of_cells.as_ref().map(|at| at as Offsets<'_>);
                convolution.set(parity, of_cells, Some(&of_wave))
            }
            Table::AlongX(values) => {
                let at = |di: isize, dj: isize| {
                    values[di.unsigned_abs() + nx * dj.unsigned_abs()][component]
                };
                convolution.set(parity, Some(&at), None)
            }
            Table::AlongY(values) => {
                let component = transposed(component);
                let at = |di: isize, dj: isize| {
                    let value = values[dj.unsigned_abs() + ny * di.unsigned_abs()][component];
                    sign(di, of_x) * value
                };
                convolution.set(parity, Some(&at), None)
            }
        }
    }
}

/// From this depth on, in long sides of a cell, waves that look alike on the grid have soon faded.
const DEEP: f64 = 1.0;

/// Waves alone at depths where they soon fade, and if the load consists of those of the grid. Otherwise waves that are
/// extrapolated from greater depths, and the difference from these on cells near the load.
fn periodic(domain: &Domain, response: &Response, z: f64) -> Table {
    let Domain { grid, between, .. } = domain;
    let (depth, near) = split(*between, z);
    let waves = Spectrum::new(grid, *between, &depth, response);
    let cells = near.map(|near| near.folded(grid, [true, true], response));
    Table::Periodic { cells, waves }
}

/// The depth of the waves, and the difference on cells if they are extrapolated.
fn split(between: Between, z: f64) -> (Depth, Option<Near>) {
    if between == Between::Waves || z >= DEEP {
        return (Depth::At(z), None);
    }
    let depth = Depth::extrapolated(z);
    (depth, Some(Near::new(&depth, z)))
}

/// The difference between the response at a depth and the extrapolated one, which is nothing far from the load.
struct Near {
    /// Weights and depths.
    parts: Vec<(f64, f64)>,
}

/// Cells whose differences are held at a time: of flat ones there are millions within reach.
const HELD: usize = 1 << 16;

impl Near {
    fn new(depth: &Depth, z: f64) -> Self {
        let mut parts = vec![(1.0, z)];
        parts.extend(depth.parts().into_iter().map(|(weight, z)| (-weight, z)));
        Self { parts }
    }

    /// With all images along the sides that repeat: at all offsets there, and at those that are not negative elsewhere.
    fn folded(
        &self,
        grid: &Grid,
        [x_repeats, y_repeats]: [bool; 2],
        response: &Response,
    ) -> Vec<Stresses> {
        let (nx, ny) = grid.shape();
        let within = |side: f64, n: usize, repeats: bool| {
            let reached = (Depth::REACH / side) as usize + 1;
            if repeats { reached } else { reached.min(n) }
        };
        let columns = within(grid.dx(), nx, x_repeats);
        let rows = within(grid.dy(), ny, y_repeats);
        let mut sums = vec![[0.0; COMPONENTS]; nx * ny];
        let signs: [(f64, f64); COMPONENTS] = std::array::from_fn(|c| response.signs(c));
        let place = |offset: usize, is_negative: bool, n: usize, repeats: bool| match (
            repeats,
            is_negative,
        ) {
            (true, false) => Some(offset % n),
            (true, true) => Some((n - offset % n) % n),
            (false, false) => Some(offset).filter(|offset| *offset < n),
            (false, true) => None,
        };
        let at_once = HELD.div_ceil(columns).next_multiple_of(ROWS);
        for first in (0..rows).step_by(at_once) {
            let rows = first..rows.min(first + at_once);
            let sides = (grid.dx(), grid.dy());
            let values = rectangles((columns, rows.clone()), sides, &self.parts, response);
            for (b, row) in rows.zip(values.chunks_exact(columns)) {
                for below in [false, true] {
                    let Some(j) = place(b, below, ny, y_repeats).filter(|_| b > 0 || !below) else {
                        continue;
                    };
                    for (a, value) in row.iter().enumerate() {
                        for left in [false, true] {
                            let i = place(a, left, nx, x_repeats).filter(|_| a > 0 || !left);
                            let Some(i) = i else { continue };
                            let sum = &mut sums[i + nx * j];
                            for ((sum, value), (x, y)) in sum.iter_mut().zip(value).zip(signs) {
                                let x = if left { x } else { 1.0 };
                                let y = if below { y } else { 1.0 };
                                *sum += x * y * value;
                            }
                        }
                    }
                }
            }
        }
        sums
    }
}

/// Of a grid that repeats along x alone, at offsets of a period along x and at those that are not negative across. The
/// mean along x is the response to strips.
fn along_x(grid: &Grid, response: &Response, z: f64) -> Vec<Stresses> {
    let (nx, ny) = grid.shape();
    let (depth, near) = split(Between::Cells, z);
    let mut values = match near {
        Some(near) => near.folded(grid, [true, false], response),
        None => vec![[0.0; COMPONENTS]; nx * ny],
    };
    let uniform = strips(ny, grid.dy(), &depth.parts(), response);
    for (row, uniform) in values.chunks_exact_mut(nx).zip(&uniform) {
        row.iter_mut().for_each(|value| super::cells::add(value, 1.0 / nx as f64, uniform));
    }
    add_waves_along_x(&mut values, grid, &depth, response);
    values
}
