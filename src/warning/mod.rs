//! Warnings: input and results that are allowed and look wrong.

use std::fmt;

use nalgebra::DMatrix;

use crate::adhesion::CohesiveLaw;
use crate::kernel::{Base, LayeredBody};
use crate::number::{counted, quantity, significant};
use crate::patches::{Connectivity, ContactEdge, Patches};
use crate::surface::{self, Topography};
use crate::{Boundary, Error, Grid};

/// Something that a person should look at: most often a unit that was mistaken, or a grid that is too coarse. Nothing
/// is refused because of it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// Something about a surface.
    Surface(surface::Warning),
    /// Contact without a load: nodes that touch at the same height.
    NoLoad {
        /// Nodes in contact.
        contact_nodes: usize,
    },
    /// Contact of patches that the grid does not resolve.
    SmallPatches {
        /// Nodes in contact.
        contact_nodes: usize,
        /// By how much the area of their cells exceeds the corrected contact area, relative to it.
        excess: f64,
    },
    /// A greatest pressure that the edge of a cut surface makes.
    EdgePeak {
        /// The greatest pressure \[Pa\].
        pressure: f64,
        /// The greatest pressure away from the border \[Pa\].
        inside: f64,
    },
    /// A composite modulus that no two bodies have.
    Modulus {
        /// Composite modulus \[Pa\].
        e_star: f64,
    },
    /// A hardness that no solid of this modulus has.
    Hardness {
        /// The hardness \[Pa\].
        hardness: f64,
        /// Composite modulus \[Pa\].
        e_star: f64,
    },
    /// Cells wider than the coat of a body is thick.
    WideCells {
        /// The longer side of a cell \[m\].
        cell: f64,
        /// Thickness of the coat \[m\].
        thickness: f64,
    },
    /// A pressure that solids do not bear elastically.
    HighPressure {
        /// The greatest pressure \[Pa\].
        pressure: f64,
        /// Composite modulus \[Pa\].
        e_star: f64,
        /// Typical hardness of the material \[Pa\], where it is known.
        hardness: Option<f64>,
    },
    /// A cohesive law so steep that cells snap one by one, which makes loops of its own.
    SteepLaw {
        /// The slope of the law times the compliance of a cell.
        resolution: f64,
        /// The longer side of a cell \[m\].
        cell: f64,
        /// That of cells that would do \[m\].
        cell_needed: f64,
    },
    /// Adhesion on summits that the grid does not resolve.
    SmallSummits {
        /// Contact radius of the highest summit at pull-off, in the limit of JKR, over the longer side of a cell.
        cells: f64,
        /// Radius of curvature of the highest summit \[m\].
        radius: f64,
    },
    /// A work of adhesion that no two solids have.
    StrongAdhesion {
        /// Work of adhesion \[J/m²\].
        work: f64,
    },
    /// Fluid that would open the gap through which it leaks.
    PressureDrop {
        /// Pressure drop of the fluid \[Pa\].
        pressure_drop: f64,
        /// The least mean pressure of the contact that is not far above it \[Pa\].
        mean_pressure: f64,
        /// At how many states that is so.
        states: usize,
    },
}

/// By how much the counted contact area may exceed the corrected one: a patch of some 15 nodes does. On balls at eight
/// places between the nodes the counted area was 21 % too large on average, and up to 42 %, with 12 to 15 nodes in
/// contact; 13 % and 32 % with 16 to 23; 8 % and 17 % with 32 to 47.
const EXCESS: f64 = 0.15;
/// The same of a single patch, all of whose figures depend on it: one of some 50 nodes.
const EXCESS_OF_ONE: f64 = 0.08;
/// Pressure over composite modulus: metals yield at a hardness of some 0.01 to 0.03, and polymers at 0.047 (PTFE) to
/// 0.072 (PMMA).
const METALS: f64 = 0.02;
const POLYMERS: f64 = 0.05;
/// Rounding of a pressure, relative to the hardness.
const SAME_HARDNESS: f64 = 1e-6;
/// Metals, glass and ceramics are stiffer than this, polymers are softer, and rubber, which does not yield, is softer
/// than the second \[Pa\].
const SOFTEST_METAL: f64 = 1e10;
const SOFTEST_POLYMER: f64 = 1e8;
/// A layer is like another if its modulus is at most so many times as large, and at least so many times as small.
const LIKE: f64 = 2.0;
/// The hardness of solids over their composite modulus, from annealed metals to polymers and ceramics, with a wide
/// margin below.
const HARDNESSES: std::ops::RangeInclusive<f64> = 1e-5..=0.3;
/// Moduli of solids lie between that of soft rubber and that of diamond \[Pa\].
const SOLIDS: std::ops::RangeInclusive<f64> = 1e6..=2e12;
/// Bonds of solids, broken slowly, take less \[J/m²\]: twice the surface energy of tungsten is 7.
const STRONGEST: f64 = 10.0;
/// Pressure drop over mean pressure. Half of the drop, its mean, takes load off the contact. Leak rates fall as the
/// second power of the load far from the closing of the last channel and as the twentieth power near it, so that a
/// fiftieth changes them by 2 to 20 %.
const DROP: f64 = 0.02;
/// Slope times compliance of a cell from which on a front that crosses cells makes a loop, with rounding.
const STEEP: f64 = 1.0 - 1e-12;
/// Cells in the contact radius of a summit at pull-off: with 5 the force is 7 % too great, with fewer it depends on where
/// the summit is between the nodes.
const CELLS_OF_SUMMIT: f64 = 5.0;

impl Warning {
    /// Warnings about a surface.
    #[must_use]
    pub fn of_surface(surface: &Topography) -> Vec<Self> {
        let warnings = surface::Warning::of_surface(surface);
        warnings.into_iter().map(Self::Surface).collect()
    }

    /// Warnings about a contact: its pressure \[Pa\] and its nodes, on a grid with what is around it.
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] if a map has another shape than the grid.
    pub fn of_contact(
        pressure: &DMatrix<f64>,
        contact_map: &DMatrix<bool>,
        on: (&Grid, Boundary),
    ) -> Result<Vec<Self>, Error> {
        let (grid, boundary) = on;
        grid.check_shape(pressure.shape())?;
        let edge = ContactEdge::of(contact_map, *grid, boundary)?;
        let contact_nodes = edge.contact_nodes();
        if contact_nodes > 1 && pressure.iter().all(|value| *value == 0.0) {
            return Ok(vec![Self::NoLoad { contact_nodes }]);
        }
        let excess = contact_nodes as f64 * grid.cell_area() / edge.corrected_area() - 1.0;
        let is_small =
            excess > EXCESS || (excess > EXCESS_OF_ONE && is_one_patch(contact_map, on)?);
        let small = is_small.then_some(Self::SmallPatches { contact_nodes, excess });
        Ok(small.into_iter().chain(Self::of_edge(pressure, boundary)).collect())
    }

    /// The surface of a free half-space ends at the border of the grid. On a ball whose contact is cut off there, the
    /// greatest pressure moves to the border when the radius of the contact is 1.15 times the distance. Until then
    /// approach and greatest pressure are within 0.2 % of Hertz; at 1.2 times the greatest pressure is 1.4 times that
    /// of Hertz, at 1.4 times 2.5 times.
    fn of_edge(pressure: &DMatrix<f64>, boundary: Boundary) -> Option<Self> {
        let (nx, ny) = pressure.shape();
        let [repeats_x, repeats_y] = boundary.repeats();
        let is_end = |k: usize, n: usize| k == 0 || k + 1 == n;
        let (mut border, mut inside, mut has_inside) = (0.0_f64, 0.0_f64, false);
        for (node, &value) in pressure.iter().enumerate() {
            let (ix, iy) = (node % nx, node / nx);
            if (!repeats_x && is_end(ix, nx)) || (!repeats_y && is_end(iy, ny)) {
                border = border.max(value);
            } else {
                inside = inside.max(value);
                has_inside = true;
            }
        }
        // On two rows of nodes all are at the border.
        (has_inside && border > inside).then_some(Self::EdgePeak { pressure: border, inside })
    }

    /// Warnings about a composite modulus.
    #[must_use]
    pub fn of_modulus(e_star: f64) -> Option<Self> {
        (!SOLIDS.contains(&e_star)).then_some(Self::Modulus { e_star })
    }

    /// Warnings about a hardness of bodies of a composite modulus. What is harder than they can be does not yield.
    #[must_use]
    pub fn of_hardness(hardness: f64, e_star: f64) -> Option<Self> {
        // One that is not positive is no hardness at all, and an error elsewhere.
        let is_soft = hardness > 0.0 && hardness < HARDNESSES.start() * e_star;
        is_soft.then_some(Self::Hardness { hardness, e_star })
    }

    /// Warnings about the layers of a body on a grid whose cells are wider than the coat is thick: down to where the
    /// modulus is twice or half that of the surface. On a ball, with cells half as wide as the coat, as wide and twice
    /// as wide, the greatest pressure on a hard coat was 5, 9 and 15 % off, and the stiffness of an incompressible
    /// layer on a rigid base 0.5, 2 and 4 %.
    #[must_use]
    pub fn of_layers(body: &LayeredBody, grid: &Grid) -> Option<Self> {
        let modulus = |youngs_modulus: f64, poissons_ratio: f64| {
            youngs_modulus / (1.0 - poissons_ratio * poissons_ratio)
        };
        let first = body.layers().first()?;
        let surface = modulus(first.youngs_modulus, first.poissons_ratio);
        let is_like = |youngs_modulus, poissons_ratio| {
            let ratio = modulus(youngs_modulus, poissons_ratio) / surface;
            (1.0 / LIKE..=LIKE).contains(&ratio)
        };
        let like = body
            .layers()
            .iter()
            .take_while(|layer| is_like(layer.youngs_modulus, layer.poissons_ratio));
        let (count, thickness) =
            like.fold((0, 0.0), |(n, sum), layer| (n + 1, sum + layer.thickness));
        let ends = count < body.layers().len()
            || match body.base() {
                Base::Rigid => true,
                Base::HalfSpace { youngs_modulus, poissons_ratio } => {
                    !is_like(youngs_modulus, poissons_ratio)
                }
            };
        let cell = grid.dx().max(grid.dy());
        // Of cells as wide as the coat is thick, but for rounding of the sides, there is none.
        (ends && cell > thickness * (1.0 + 1e-9)).then_some(Self::WideCells { cell, thickness })
    }

    /// Warnings about the greatest pressure of an elastic contact, with the typical hardness of the material where it
    /// is known.
    #[must_use]
    pub fn of_pressure(pressure: f64, e_star: f64, hardness: Option<f64>) -> Option<Self> {
        let borne = match hardness {
            // What a path with this hardness leaves of a surface bears it again, to rounding.
            Some(hardness) => hardness * (1.0 + SAME_HARDNESS),
            None if e_star >= SOFTEST_METAL => METALS * e_star,
            None if e_star >= SOFTEST_POLYMER => POLYMERS * e_star,
            None => f64::INFINITY,
        };
        (pressure > borne).then_some(Self::HighPressure { pressure, e_star, hardness })
    }

    /// Warnings about a law of adhesion on a surface, with the composite modulus.
    #[must_use]
    pub fn of_adhesion(surface: &Topography, law: &CohesiveLaw, e_star: f64) -> Vec<Self> {
        let cell = surface.grid().dx().max(surface.grid().dy());
        let resolution = law.resolution();
        let steep = (law.cell_margin() < STEEP).then(|| Self::SteepLaw {
            resolution,
            cell,
            cell_needed: cell * law.cell_margin(),
        });
        let sticks = law.work() > 0.0;
        let small = radius_of_highest(surface).filter(|_| sticks).and_then(|radius| {
            let cells = law.pull_off_radius(radius, e_star) / cell;
            (cells < CELLS_OF_SUMMIT).then_some(Self::SmallSummits { cells, radius })
        });
        let strong = (law.work() > STRONGEST).then(|| Self::StrongAdhesion { work: law.work() });
        strong.into_iter().chain(steep).chain(small).collect()
    }

    /// Warnings about the pressure drop of a fluid that leaks through contacts under these mean pressures \[Pa\].
    /// Without a load there is no contact to open.
    #[must_use]
    pub fn of_pressure_drop(
        pressure_drop: f64,
        mean_pressures: impl IntoIterator<Item = f64>,
    ) -> Option<Self> {
        let is_near = |pressure: &f64| *pressure > 0.0 && pressure_drop > DROP * pressure;
        let near = mean_pressures.into_iter().filter(is_near);
        let (states, mean_pressure) =
            near.fold((0, f64::INFINITY), |(n, least), pressure| (n + 1, pressure.min(least)));
        (states > 0).then_some(Self::PressureDrop { pressure_drop, mean_pressure, states })
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Surface(warning) => warning.fmt(f),
            Self::NoLoad { contact_nodes } => write!(
                f,
                "{contact_nodes} nodes touch at the same height, and nothing presses on them yet: the path ends before there is a \
                 load. Ask for a load, or for more contact than these nodes"
            ),
            Self::SmallPatches { contact_nodes, excess } => write!(
                f,
                "the contact is not resolved: the area of its {} may be up to {:.0} % too large. Contact area \
                 and greatest pressure depend on the mesh; use the corrected area, or a finer grid",
                counted(contact_nodes, "cell"),
                100.0 * excess
            ),
            Self::EdgePeak { pressure, inside } => write!(
                f,
                "the greatest pressure, {}, is at the border of the grid: the edge of the surface makes it, and it grows on finer \
                 grids. Away from the border it is {}. Take a larger piece, or a periodic half-space if the surface has no edge there",
                pascals(pressure),
                pascals(inside)
            ),
            Self::Modulus { e_star } if e_star > *SOLIDS.end() => write!(
                f,
                "E* = {} is above that of diamond: is the modulus in Pa?",
                pascals(e_star)
            ),
            Self::Modulus { e_star } => {
                write!(f, "E* = {} is softer than rubber", pascals(e_star))?;
                match in_larger_unit(e_star, SOLIDS) {
                    Some((value, unit)) => {
                        write!(f, ": if all moduli were given in {unit}, it is {}", pascals(value))
                    }
                    None => write!(f, ": is the modulus in Pa?"),
                }
            }
            Self::Hardness { hardness, e_star } => {
                write!(
                    f,
                    "a hardness of {} is {} of E* = {}: no solid is so soft",
                    pascals(hardness),
                    significant(hardness / e_star, 2),
                    pascals(e_star)
                )?;
                let solids = HARDNESSES.start() * e_star..=HARDNESSES.end() * e_star;
                match in_larger_unit(hardness, solids) {
                    Some((value, unit)) => {
                        write!(f, ". If it was given in {unit}, it is {}", pascals(value))
                    }
                    None => write!(f, ". Is it in Pa?"),
                }
            }
            Self::WideCells { cell, thickness } => write!(
                f,
                "cells of {} are wider than the coat is thick, {}: pressures may change within a cell, and stiffness and \
                 greatest pressure depend on the mesh. Use a finer grid",
                quantity(cell, "m", 4),
                quantity(thickness, "m", 4)
            ),
            Self::HighPressure { pressure, hardness: Some(hardness), .. } => write!(
                f,
                "the greatest pressure is {}, {} times the typical hardness of the material, {}. The model is elastic",
                pascals(pressure),
                significant(pressure / hardness, 2),
                pascals(hardness)
            ),
            Self::HighPressure { pressure, e_star, hardness: None } => write!(
                f,
                "the greatest pressure is {}, {} of E* = {}. The model is elastic; {}",
                pascals(pressure),
                significant(pressure / e_star, 2),
                pascals(e_star),
                if e_star >= SOFTEST_METAL {
                    "metals yield at some 0.01 to 0.03 of E*, glass and ceramics at some 0.03 to 0.12"
                } else {
                    "polymers yield at some 0.05 of E*"
                }
            ),
            Self::SteepLaw { resolution, cell, cell_needed } => write!(
                f,
                "the slope of the law of adhesion times the compliance of a cell is {resolution:.2}, above 0.5: cells snap one by \
                 one, and part of the loop is made by the mesh. Cells of {} instead of {} make none, nor does a longer range",
                quantity(cell_needed, "m", 3),
                quantity(cell, "m", 3)
            ),
            Self::SmallSummits { cells, radius } => write!(
                f,
                "the highest summit, with a radius of {}, would be pulled off from a contact radius of {} cells: fewer than 5, and \
                 the pull-off force depends on the mesh. Use a finer grid, or a smoother surface",
                quantity(radius, "m", 3),
                significant(cells, 2)
            ),
            Self::StrongAdhesion { work } => write!(
                f,
                "a work of adhesion of {} is above that of any two solids at rest, some {}: is it in J/m², and not in mJ/m²?",
                quantity(work, "J/m²", 4),
                quantity(STRONGEST, "J/m²", 4)
            ),
            Self::PressureDrop { pressure_drop, mean_pressure, states } => {
                write!(
                    f,
                    "the pressure drop of the fluid, {}, is not small beside the mean pressure of the contact, {}",
                    pascals(pressure_drop),
                    pascals(mean_pressure)
                )?;
                if states > 1 {
                    write!(f, " and more at {states} states")?;
                }
                write!(
                    f,
                    ": the fluid would open the gap, and more would leak. Take a pressure drop of {} or less, or states above {}",
                    pascals(DROP * mean_pressure),
                    pascals(pressure_drop / DROP)
                )
            }
        }
    }
}

/// Radius of curvature \[m\] about the highest node that has neighbours on all sides, by second differences; `None` on
/// a profile and where it is no summit.
fn radius_of_highest(surface: &Topography) -> Option<f64> {
    let (grid, heights) = (surface.grid(), surface.map().matrix());
    let (nx, ny) = grid.shape();
    let inner = (1..ny.max(1) - 1).flat_map(|iy| (1..nx.max(1) - 1).map(move |ix| (ix, iy)));
    let (ix, iy) = inner.max_by(|&a, &b| heights[a].total_cmp(&heights[b]))?;
    let along = |before: f64, after: f64, step: f64| {
        (2.0 * heights[(ix, iy)] - before - after) / (step * step)
    };
    let of_x = along(heights[(ix - 1, iy)], heights[(ix + 1, iy)], grid.dx());
    let of_y = along(heights[(ix, iy - 1)], heights[(ix, iy + 1)], grid.dy());
    let curvature = 0.5 * (of_x + of_y);
    (curvature > 0.0).then(|| curvature.recip())
}

/// Whether nodes in contact are one patch.
fn is_one_patch(
    contact_map: &DMatrix<bool>,
    (grid, boundary): (&Grid, Boundary),
) -> Result<bool, Error> {
    let patches = Patches::new(contact_map, grid, boundary, Connectivity::Eight)?;
    Ok(patches.patches().len() == 1)
}

/// A pressure that was given in GPa or MPa if it is one of these then, and the unit.
fn in_larger_unit(
    value: f64,
    plausible: std::ops::RangeInclusive<f64>,
) -> Option<(f64, &'static str)> {
    let units = [(1e9, "GPa"), (1e6, "MPa")].map(|(factor, unit)| (factor * value, unit));
    units.into_iter().find(|(value, _)| plausible.contains(value))
}

/// A pressure in the unit in which it is read easily.
fn pascals(value: f64) -> String {
    quantity(value, "Pa", 4)
}

#[cfg(test)]
mod tests;
