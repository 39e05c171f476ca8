//! Coefficients of a layered body without pressure outside the grid.

use std::f64::consts::PI;

use super::body::{Base, LayeredBody};
use super::cell::{Smoothness, integral};
use super::far::Far;
use super::radial::{Radial, Spectrum};
use crate::kernel::{Boussinesq, InfluenceKernel};
use crate::parallel::for_each_chunk;
use crate::{Error, Grid};

/// Deep layers are felt up to this wave number, in units of 1 / thickness of the uppermost one: 10⁻²⁰ of the whole is
/// left.
pub(super) const DEEPEST: f64 = 26.0;
/// What is left of the response of a half-space where a layer on a rigid base has none: more than the errors of the
/// table.
const NOTHING: f64 = 1e-12;

/// The coefficients at offsets (di, dj) ≥ 0, di fastest.
///
/// Love's rectangle on a half-space of the uppermost layer, and the difference from it, which has no singularity: a
/// function of the distance alone, integrated over the cell.
pub(super) fn coefficients(grid: &Grid, body: &LayeredBody) -> Result<Vec<f64>, Error> {
    let (nx, ny) = grid.shape();
    let (dx, dy) = (grid.dx(), grid.dy());
    let love = Boussinesq::new(*grid, body.surface_modulus())?;
    let difference = Difference::new(body, Far::distance(grid));
    let far = Far::new(grid, difference.smoothness(), |r| difference.radial.at_each(r));
    let counterpart =
        body.counterpart().map(|e_star| Boussinesq::new(*grid, e_star)).transpose()?;
    let half_diagonal = 0.5 * libm::hypot(dx, dy);
    let mut values = vec![0.0; nx * ny];
    // On square cells symmetric to the last bit, so that ties of symmetric surfaces are ties.
    let is_mirrored = |ix: usize, iy: usize| dx == dy && ix < iy && iy < nx;
    for_each_chunk(&mut values, nx, |iy, row| {
        let far_row = far.row(iy);
        for (ix, value) in row.iter_mut().enumerate() {
            if is_mirrored(ix, iy) {
                continue;
            }
            let (x, y) = (ix as f64 * dx, iy as f64 * dy);
            let (x, y) = if dx == dy { (x.max(y), x.min(y)) } else { (x, y) };
            let (di, dj) = (ix as isize, iy as isize);
            *value = if libm::hypot(x, y) - half_diagonal > difference.reach {
                counterpart.as_ref().map_or(0.0, |other| other.coefficient(di, dj))
            } else if far.serves(ix, iy) {
                love.coefficient(di, dj) + far_row.integral(ix)
            } else {
                love.coefficient(di, dj) + difference.over_cell((x, y), (dx, dy))
            };
        }
    });
    for iy in 0..ny {
        for ix in (0..nx.min(iy)).filter(|&ix| is_mirrored(ix, iy)) {
            values[ix + nx * iy] = values[iy + nx * ix];
        }
    }
    Ok(values)
}

/// Displacement around a point load of 1, less that of a half-space of the uppermost layer.
struct Difference {
    radial: Radial,
    /// The distance of the nearest singularity from the origin, which is imaginary.
    depth: f64,
    /// Beyond, the body does not answer at all.
    reach: f64,
}

impl Difference {
    /// Up to a distance.
    fn new(body: &LayeredBody, distance: f64) -> Self {
        let top = body.top_modulus();
        let spectrum = spectrum(body, |q| body.reduced_compliance(q) - 2.0 / top);
        let depth = 2.0 * body.top_thickness();
        let radial = Radial::new(&spectrum, depth, distance, f64::INFINITY);
        let mut reach = f64::INFINITY;
        if body.base() == Base::Rigid {
            // With the half-space it cancels to nothing: the last panel at whose end or middle it does not.
            let is_felt = |r: f64| {
                let half_space = 1.0 / (PI * top * r);
                (radial.at(r) + half_space).abs() > NOTHING * half_space
            };
            let mut from = 0.0;
            for &end in radial.ends() {
                if is_felt(end) || is_felt(0.5 * (from + end)) {
                    reach = f64::INFINITY;
                } else {
                    reach = reach.min(end);
                }
                from = end;
            }
        }
        Self { radial, depth, reach }
    }

    fn smoothness(&self) -> Smoothness {
        Smoothness { depth: self.depth, most: f64::INFINITY }
    }

    fn over_cell(&self, center: (f64, f64), sides: (f64, f64)) -> f64 {
        integral(&|r| self.radial.at_each(r), self.smoothness(), center, sides)
    }
}

/// `g`, with the wave numbers at which the compliance of a body varies.
pub(super) fn spectrum<G: Fn(f64) -> f64>(body: &LayeredBody, g: G) -> Spectrum<G> {
    let top = body.top_thickness();
    Spectrum {
        g,
        bessel: libm::j0,
        first: first_variation(body),
        widest: 1.0 / top,
        settled: 0.0,
        fading: 1.0 / top,
        end: DEEPEST / top,
    }
}

/// The wave number below which the compliance hardly varies. A stiff coat resists waves as a plate from qh = (G₂/G₁)^⅓
/// on, and as a membrane, which is not to slide on what lies below, from qh = G₂/G₁ on; so does a soft layer give way.
pub(super) fn first_variation(body: &LayeredBody) -> f64 {
    0.1 * body.softest_over_stiffest() / body.thickness()
}
