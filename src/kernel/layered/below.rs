//! What a pressure does below the surface of layers.

use super::body::{Base, LayeredBody};
use super::cell::{self, Smoothness};
use super::compliance::{Block, Compliance, Material};
use super::free::first_variation;
use super::radial::{Radial, Spectrum};
use crate::Grid;
use crate::parallel::for_each_chunk;

/// Stress components in the order of Voigt: xx, yy, zz, yz, xz, xy.
type Stresses = [f64; 6];

/// A wave has faded at this many times its reciprocal wave number.
const FADED: f64 = 34.0;

/// Stresses at one depth of a layered body, under waves of pressure and under cells, less those of a half-space of the
/// uppermost layer at depths within that: without the difference responses near the surface have no end.
#[derive(Debug)]
pub(crate) struct Below<'a> {
    body: &'a LayeredBody,
    z: f64,
    /// The layer, and the distances to its upper and its lower side; `None` in the base.
    layer: Option<(usize, f64, f64)>,
    /// Poisson's ratio there.
    poissons_ratio: f64,
    /// Whether the half-space of the uppermost layer is taken off.
    is_difference: bool,
    /// Waves fade with this depth.
    scale: f64,
}

/// Stresses in the plane of a wave of pressure: minus σzz, σxz over i, σxx along the wave.
#[derive(Debug, Clone, Copy)]
struct InPlane {
    pressure: f64,
    shear: f64,
    along: f64,
}

impl InPlane {
    /// At a depth x/q of a half-space under a wave of `pressure` and one of `shear`.
    fn in_half_space([pressure, shear]: [f64; 2], x: f64) -> Self {
        let fades = libm::exp(-x);
        Self {
            pressure: ((1.0 + x) * pressure - x * shear) * fades,
            shear: (x * pressure + (1.0 - x) * shear) * fades,
            along: ((x - 1.0) * pressure + (2.0 - x) * shear) * fades,
        }
    }
}

impl<'a> Below<'a> {
    /// At a depth z ≥ 0; on the interface of two layers in the upper one. `None` in a rigid base.
    pub(crate) fn new(body: &'a LayeredBody, z: f64) -> Option<Self> {
        let (mut top, mut layer) = (0.0, None);
        for (place, other) in body.layers().iter().enumerate() {
            let bottom = top + other.thickness;
            if z <= bottom {
                layer = Some((place, z - top, bottom - z));
                break;
            }
            top = bottom;
        }
        let poissons_ratio = match (layer, body.base()) {
            (Some((place, ..)), _) => body.layers()[place].poissons_ratio,
            (None, Base::HalfSpace { poissons_ratio, .. }) => poissons_ratio,
            (None, Base::Rigid) => return None,
        };
        let is_difference = matches!(layer, Some((0, ..)));
        let scale = if is_difference { 2.0 * body.top_thickness() - z } else { z };
        Some(Self { body, z, layer, poissons_ratio, is_difference, scale })
    }

    /// Whether what is found has to be added to the half-space of the uppermost layer, and Poisson's ratio of that.
    pub(crate) fn added_to(&self) -> Option<f64> {
        let top = self.body.layers().first().filter(|_| self.is_difference);
        top.map(|layer| layer.poissons_ratio)
    }

    /// Waves fade as exp(−q times this).
    pub(crate) fn scale(&self) -> f64 {
        self.scale
    }

    /// Under a uniform pressure of 1, of a body that cannot expand sideways.
    pub(crate) fn uniform(&self) -> Stresses {
        let sideways = -self.poissons_ratio / (1.0 - self.poissons_ratio);
        match self.is_difference {
            true => [0.0; 6],
            false => [sideways, sideways, -1.0, 0.0, 0.0, 0.0],
        }
    }

    /// Under a wave of pressure of 1 along (cx, cy): σyz and σxz over i.
    pub(crate) fn of_wave(&self, q: f64, (cx, cy): (f64, f64)) -> Stresses {
        let InPlane { pressure, shear, along } = self.in_plane(q);
        let across = self.poissons_ratio * (along - pressure);
        let excess = along - across;
        [
            across + excess * cx * cx,
            across + excess * cy * cy,
            -pressure,
            shear * cy,
            shear * cx,
            excess * cx * cy,
        ]
    }

    fn in_plane(&self, q: f64) -> InPlane {
        let found = self.whole(q);
        if !self.is_difference {
            return found;
        }
        let top = InPlane::in_half_space([1.0, 0.0], q * self.z);
        InPlane {
            pressure: found.pressure - top.pressure,
            shear: found.shear - top.shear,
            along: found.along - top.along,
        }
    }

    /// From the base up to the depth, where displacements follow from tractions, and on to the surface, whose tractions
    /// are known.
    fn whole(&self, q: f64) -> InPlane {
        const ALL: Block = [[1.0, 0.0], [0.0, 1.0]];
        let mut below = match self.body.base() {
            Base::Rigid => Compliance::RIGID,
            Base::HalfSpace { youngs_modulus, poissons_ratio } => {
                Compliance::half_space(Material::new(youngs_modulus, poissons_ratio))
            }
        };
        let mut down = ALL;
        // Compliance and material at the depth.
        let mut there = None;
        for (place, layer) in self.body.layers().iter().enumerate().rev() {
            let material = Material::new(layer.youngs_modulus, layer.poissons_ratio);
            match self.layer {
                Some((own, ..)) if own < place => {
                    below = below.under(material, q * layer.thickness);
                }
                Some((own, above, rest)) if own == place => {
                    below = below.under(material, q * rest);
                    there = Some((below, material));
                    (below, down) = below.under_with(material, q * above, down);
                }
                _ => (below, down) = below.under_with(material, q * layer.thickness, down),
            }
        }
        let tractions = down.map(|[of_pressure, _]| of_pressure);
        match there {
            Some((compliance, material)) => {
                let [_, displacement] = compliance.displacements(tractions);
                let [pressure, shear] = tractions;
                InPlane { pressure, shear, along: material.along(displacement, pressure) }
            }
            None => InPlane::in_half_space(tractions, q * (self.z - self.body.thickness())),
        }
    }

    /// Under uniform pressures of 1 on cells, without images, at offsets (di, dj) ≥ 0, di fastest.
    pub(crate) fn cells(&self, grid: &Grid) -> Vec<Stresses> {
        let (nx, ny) = grid.shape();
        let (dx, dy) = (grid.dx(), grid.dy());
        let field = Field::new(self, libm::hypot(nx as f64 * dx, ny as f64 * dy));
        let mut values = vec![[0.0; 6]; nx * ny];
        for_each_chunk(&mut values, nx, |j, row| {
            for (i, value) in row.iter_mut().enumerate() {
                field.add_cell(value, (i as f64 * dx, j as f64 * dy), (dx, dy));
            }
        });
        values
    }
}

/// Stresses around a point load, as functions of the distance.
struct Field {
    /// Of σzz, of the mean of σxx and σyy, of σrz, and of their difference.
    down: Radial,
    mean: Radial,
    shear: Radial,
    excess: Radial,
    scale: f64,
}

impl Field {
    /// Up to a distance.
    fn new(below: &Below<'_>, reach: f64) -> Self {
        let across = |s: &InPlane| below.poissons_ratio * (s.along - s.pressure);
        let first = first_variation(below.body).min(0.1 / below.scale);
        let widest = 1.0 / (below.body.top_thickness() + below.z);
        let end = FADED / below.scale;
        let table = |bessel: fn(f64) -> f64, of: &(dyn Fn(InPlane) -> f64 + Sync)| {
            // Each wave number is asked for at many distances.
            let response = Radial::of(|q| of(below.in_plane(q)), first, end, widest);
            let g = |q: f64| q * response.at(q);
            let spectrum = Spectrum { g, bessel, first, widest, settled: 0.0, fading: widest, end };
            Radial::new(&spectrum, below.scale, reach, f64::INFINITY)
        };
        Self {
            down: table(libm::j0, &|s| -s.pressure),
            mean: table(libm::j0, &|s| 0.5 * (s.along + across(&s))),
            shear: table(libm::j1, &|s| -s.shear),
            excess: table(|x| libm::jn(2, x), &|s| -0.5 * (s.along - across(&s))),
            scale: below.scale,
        }
    }

    /// Adds the integral over a cell, by rules that leave 10⁻¹⁶, as of displacements.
    fn add_cell(&self, sum: &mut Stresses, center: (f64, f64), sides: (f64, f64)) {
        let smoothness = Smoothness { depth: self.scale, most: f64::INFINITY };
        let Some(rule) = smoothness.rule(center, sides) else {
            for (center, sides) in cell::halves(center, sides) {
                self.add_cell(sum, center, sides);
            }
            return;
        };
        for (node_y, weight_y) in rule {
            for (node_x, weight_x) in rule {
                let weight = 0.25 * sides.0 * sides.1 * weight_x * weight_y;
                self.add_points(sum, weight, cell::places(center, sides, (*node_x, *node_y)));
            }
        }
    }

    fn add_points(&self, sum: &mut Stresses, weight: f64, places: [(f64, f64); 4]) {
        let distances = places.map(|(x, y)| (x * x + y * y).sqrt());
        let (down, mean) = (self.down.at_each(distances), self.mean.at_each(distances));
        let (shear, excess) = (self.shear.at_each(distances), self.excess.at_each(distances));
        for (k, (x, y)) in places.into_iter().enumerate() {
            // At the point itself the last two are zero.
            let r = distances[k].max(f64::MIN_POSITIVE);
            let (cx, cy) = (x / r, y / r);
            let turned = excess[k] * (cx * cx - cy * cy);
            let found = [
                mean[k] + turned,
                mean[k] - turned,
                down[k],
                shear[k] * cy,
                shear[k] * cx,
                2.0 * excess[k] * cx * cy,
            ];
            sum.iter_mut().zip(found).for_each(|(sum, value)| *sum += weight * value);
        }
    }
}
