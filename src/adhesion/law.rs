//! The law of adhesion: how hard a gap is pulled shut.

use crate::error::AdhesionError;
use crate::kernel::KernelTable;
use crate::{Error, InfluenceKernel};

/// Slope times compliance of a cell that a law gets where it may choose: a triangle, and the slope at the end of
/// Maugis' law.
const TRIANGLE: f64 = 0.45;
const BORDER: f64 = 0.5;
/// Beyond the first the branches contain loops that the mesh makes, of which there is a warning; beyond the second the
/// law is refused.
const WARNED: f64 = 0.5;
const GREATEST: f64 = 0.8;
/// Neighbours and soft nodes make the gap of a cell move by so many times what its own pull alone moves it by.
const AMPLIFIED: f64 = 20.0;
/// Gaps of the weakest laws may still be off by this part of what those of others may: less would be rounding.
const LEAST_PART: f64 = 1e-3;
/// How far beyond its law a traction that is held has to be to go against its gap, relative to the stress: rounding
/// is far less, even where a state is nearly unstable.
const BEYOND: f64 = 1e-6;

/// Adhesion of two surfaces: the traction that pulls a gap shut, as a function of the gap alone.
///
/// ```math
/// \text{pull}(h) = \begin{cases} \sigma_0 & h \le h_1 \\ k\,(h_2 - h) & h_1 \le h \le h_2 \\ 0 & h \ge h_2 \end{cases}
/// \qquad k = \frac{\sigma_0}{h_2 - h_1}, \qquad w = \tfrac12 \sigma_0 (h_1 + h_2)
/// ```
///
/// This is the law of Maugis (1992) with a slope for its outer border, which keeps every event of a path exact and
/// cells from snapping one by one. Where the gap is 0 the pressure is −σ₀ or more.
///
/// ```
/// use asperity::adhesion::Adhesion;
/// use asperity::{Boussinesq, Grid};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let half_space = Boussinesq::new(Grid::square(64, 1e-6)?, 1e9)?;
/// // 50 mJ/m², over a range as short as these cells resolve: as close to JKR as this mesh comes.
/// let law = Adhesion::work(0.05).on(&half_space)?;
/// assert!((law.resolution() - 0.45).abs() < 1e-12);
/// // The same work over 5 nm.
/// let law = Adhesion::work(0.05).range(5e-9).on(&half_space)?;
/// assert!((law.stress() - 20e6).abs() < 1e-6);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Adhesion {
    work: f64,
    stress: Option<f64>,
    range: Option<f64>,
}

impl Adhesion {
    /// No adhesion at w = 0: the states of the path without it, of bodies whose contact grows, between first touch and
    /// full contact, where branches end whatever target is further. Otherwise a triangle, h₁ = 0, of this work of
    /// adhesion w \[J/m²\]. Unless a [`range`](Self::range) is given it is as short as the cells of the path resolve,
    /// k C(0,0) = 0.45: the limit of JKR as far as this mesh goes.
    #[must_use]
    pub fn work(work: f64) -> Self {
        Self { work, stress: None, range: None }
    }

    /// Maugis' law of this work of adhesion w \[J/m²\] and cohesive stress σ₀ \[Pa\]. Unless a [`range`](Self::range)
    /// is given the slope at its outer border is as steep as the cells of the path resolve, k C(0,0) = 0.5.
    #[must_use]
    pub fn maugis(work: f64, stress: f64) -> Self {
        Self { work, stress: Some(stress), range: None }
    }

    /// The gap h₂ at which the pull ends \[m\].
    #[must_use]
    pub fn range(self, range: f64) -> Self {
        Self { range: Some(range), ..self }
    }

    /// What was given: work of adhesion, cohesive stress and range.
    #[must_use]
    pub fn given(&self) -> (f64, Option<f64>, Option<f64>) {
        (self.work, self.stress, self.range)
    }

    /// `Ok` if what was given may be a law on some cells.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`]. A work of adhesion of 0 is none, whatever else was given.
    pub fn check(&self) -> Result<(), Error> {
        let given = [
            ("work of adhesion", Some(self.work)),
            ("range of adhesion", self.range),
            ("cohesive stress", self.stress),
        ];
        for (quantity, value) in given {
            if let Some(value) = value.filter(|_| self.work != 0.0) {
                Error::require_positive(quantity, value)?;
            }
        }
        Ok(())
    }

    /// The law on the cells of a kernel.
    ///
    /// # Errors
    ///
    /// That of [`Self::check`]; [`Error::OutOfRange`] for a range h₂ that does not lie between w/σ₀ and 2w/σ₀, and one
    /// so long that the slope is no number; and [`AdhesionError::Unresolved`] and [`AdhesionError::NoRoomForSlope`] for
    /// cells that are too large for the law.
    pub fn on(&self, kernel: &dyn InfluenceKernel) -> Result<CohesiveLaw, Error> {
        self.of(&KernelTable::new(kernel)?)
    }

    /// The same with coefficients that are tabulated.
    pub(super) fn of(&self, table: &KernelTable) -> Result<CohesiveLaw, Error> {
        self.check()?;
        let (work, compliance) =
            (self.work, table.self_influence() - table.gauge().unwrap_or_default());
        if work == 0.0 {
            return Ok(CohesiveLaw { stress: 0.0, flat: 0.0, range: 0.0, compliance });
        }
        Error::require(
            "displacement of a cell by its own unit pressure, about the mean planes",
            compliance,
            compliance > 0.0,
            "positive: a single cell that repeats is not pulled out of its plane",
        )?;
        let (cell, range) = (table.grid().dx().max(table.grid().dy()), self.range);
        let (stress, flat, range) = match self.stress {
            None => {
                let range = range.unwrap_or_else(|| (2.0 * work * compliance / TRIANGLE).sqrt());
                (2.0 * work / range, 0.0, range)
            }
            Some(stress) => {
                let middle = work / stress;
                let slope = 0.5 * stress * compliance / BORDER;
                if range.is_none() && slope > middle {
                    let cell_needed = cell * middle / slope;
                    return Err(AdhesionError::NoRoomForSlope {
                        stress,
                        range: middle,
                        slope,
                        cell,
                        cell_needed,
                    }
                    .into());
                }
                let range = range.unwrap_or(middle + slope);
                if !(range > middle && range <= 2.0 * middle) {
                    return Err(Error::OutOfRange {
                        quantity: "range of adhesion",
                        value: range,
                        expected: "above work of adhesion over cohesive stress, and at most twice that",
                    });
                }
                (stress, 2.0 * middle - range, range)
            }
        };
        let law = CohesiveLaw { stress, flat, range, compliance };
        let resolution = law.resolution();
        if resolution.is_nan() || resolution > GREATEST {
            let cell_needed = cell * WARNED / resolution;
            return Err(AdhesionError::Unresolved {
                resolution,
                greatest: GREATEST,
                cell,
                cell_needed,
            }
            .into());
        }
        let is_number = law.slope().is_normal() && (range * range).is_finite();
        let expected = "short enough for a slope and energies that are numbers";
        Error::require("range of adhesion", range, is_number, expected)?;
        Ok(law)
    }
}

/// An [`Adhesion`] on the cells of a kernel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CohesiveLaw {
    stress: f64,
    /// h₁ and h₂.
    flat: f64,
    range: f64,
    /// C(0,0), about the mean planes of a periodic half-space.
    compliance: f64,
}

impl CohesiveLaw {
    /// The work of adhesion w \[J/m²\].
    #[must_use]
    pub fn work(&self) -> f64 {
        0.5 * self.stress * (self.flat + self.range)
    }

    /// The greatest pull σ₀ \[Pa\].
    #[must_use]
    pub fn stress(&self) -> f64 {
        self.stress
    }

    /// The gap h₁ up to which the pull is greatest \[m\]; 0 for a triangle.
    #[must_use]
    pub fn flat_range(&self) -> f64 {
        self.flat
    }

    /// The gap h₂ at which the pull ends \[m\].
    #[must_use]
    pub fn range(&self) -> f64 {
        self.range
    }

    /// The slope k = σ₀/(h₂ − h₁) \[Pa/m\]; 0 without adhesion.
    #[must_use]
    pub fn slope(&self) -> f64 {
        if self.stress == 0.0 { 0.0 } else { self.stress / (self.range - self.flat) }
    }

    /// C(0,0) \[m/Pa\], about the mean planes of a periodic half-space: what a unit pressure displaces its cell by.
    pub(super) fn compliance(&self) -> f64 {
        self.compliance
    }

    /// k C(0,0): up to 0.5 the mesh adds no loop of its own; a law beyond 0.8 is refused.
    #[must_use]
    pub fn resolution(&self) -> f64 {
        self.slope() * self.compliance
    }

    /// How many times as long the cells may be before the mesh makes loops of its own: 0.5 over the
    /// [resolution](Self::resolution). Below 1 there is a [warning](crate::Warning::SteepLaw).
    #[must_use]
    pub fn cell_margin(&self) -> f64 {
        WARNED / self.resolution()
    }

    /// The contact radius `(9π w R² / 8E*)^⅓` that a sphere of a radius R \[m\] has at pull-off in the limit of JKR.
    #[must_use]
    pub fn pull_off_radius(&self, radius: f64, e_star: f64) -> f64 {
        let work = 9.0 * std::f64::consts::PI * self.work();
        (work * radius * radius / (8.0 * e_star)).cbrt()
    }

    /// Tabor's number `μ = σ₀ (9R / (2π w E*²))^⅓ / 1.157` of a sphere of a radius R \[m\] and the modulus E* \[Pa\],
    /// from the cohesive stress: above 3 contact is nearly that of JKR, below 0.3 nearly that of DMT.
    #[must_use]
    pub fn tabor_parameter(&self, radius: f64, e_star: f64) -> f64 {
        let cube = 9.0 * radius / (2.0 * std::f64::consts::PI * self.work() * e_star * e_star);
        self.stress * cube.cbrt() / 1.157
    }

    /// The pull at a gap \[Pa\].
    #[must_use]
    pub fn pull(&self, gap: f64) -> f64 {
        (self.slope() * (self.range - gap)).clamp(0.0, self.stress)
    }

    /// By how much gaps may be off where pulls are off by a part of the stress: by that part of the range, and less
    /// where the law is weak. Nodes of one height come to a corner of the law together but for this.
    pub(super) fn gap_of(&self, part: f64) -> f64 {
        part * self.range * (AMPLIFIED * self.resolution()).clamp(LEAST_PART, 1.0)
    }

    /// Which way a pull that is held goes to the law: 1 where it grows and −1 where it falls. It goes the way of its gap
    /// unless what happened meanwhile has left it beyond the law: a node that has parted while others close.
    pub(super) fn direction(&self, [pressure, gap]: [f64; 2], way: f64) -> f64 {
        let lag = way * (self.pull(gap) + pressure);
        if lag < -BEYOND * self.stress { -way } else { way }
    }

    /// The energy φ of a gap \[J/m²\], 0 out of range and −w at 0: its derivative is the pull.
    #[must_use]
    pub fn energy(&self, gap: f64) -> f64 {
        if gap < self.flat {
            self.stress * gap - self.work()
        } else {
            let left = (self.range - gap).max(0.0);
            -0.5 * self.slope() * left * left
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Boussinesq, Grid};

    fn half_space(cell: f64) -> Result<Boussinesq, Error> {
        Boussinesq::new(Grid::square(8, 8.0 * cell)?, 2.0)
    }

    /// Every law has its work under it, ends at its range, and is as steep as was said.
    #[test]
    fn laws_keep_their_work() -> Result<(), Error> {
        let kernel = half_space(0.1)?;
        let compliance = kernel.coefficient(0, 0);
        let laws = [
            (Adhesion::work(0.05), Some(0.45)),
            (Adhesion::work(0.05).range(0.5), None),
            (Adhesion::maugis(0.05, 0.3), Some(0.5)),
            (Adhesion::maugis(0.05, 0.3).range(0.3), None),
        ];
        for (law, resolution) in laws {
            let law = law.on(&kernel)?;
            assert!((law.work() / 0.05 - 1.0).abs() < 1e-14);
            assert!((law.resolution() / (law.slope() * compliance) - 1.0).abs() < 1e-14);
            if let Some(resolution) = resolution {
                assert!((law.resolution() / resolution - 1.0).abs() < 1e-14, "{law:?}");
            }
            // The midpoint rule is exact but in the cells of the two corners.
            let (cells, range) = (100_000, law.range());
            let step = range / f64::from(cells);
            let middle = |k: i32| (f64::from(k) + 0.5) * step;
            let area: f64 = (0..cells).map(|k| law.pull(middle(k)) * step).sum();
            assert!((area / law.work() - 1.0).abs() < 1e-9);
            assert!((law.energy(0.0) + law.work()).abs() < 1e-16);
            assert_eq!((law.energy(range), law.pull(range)), (0.0, 0.0));
            assert!((law.pull(0.0) / law.stress() - 1.0).abs() < 1e-15);
            for gap in [0.3 * law.flat_range() + 1e-3 * range, 0.7 * range, 0.9 * range] {
                let slope = (law.energy(gap + 1e-6) - law.energy(gap - 1e-6)) / 2e-6;
                assert!((slope / law.pull(gap) - 1.0).abs() < 1e-6, "{law:?} {gap}");
            }
        }
        Ok(())
    }

    /// The number of Tabor by which the stress of Maugis' law is made.
    #[test]
    fn tabor_parameters_are_those_of_maugis() -> Result<(), Error> {
        let (radius, e_star, work) = (1.0, 2.0, 0.01);
        let unit: f64 = 2.0 * std::f64::consts::PI * work * e_star * e_star / (9.0 * radius);
        let law = Adhesion::maugis(work, 1.157 * 0.7 * unit.cbrt()).on(&half_space(1e-3)?)?;
        assert!((law.tabor_parameter(radius, e_star) - 0.7).abs() < 1e-14);
        Ok(())
    }

    /// What the mesh does not resolve is refused with the cell that would do, and that does.
    #[test]
    fn steep_laws_are_refused() -> Result<(), Error> {
        let law = Adhesion::work(0.05).range(0.05);
        let refused = law.on(&half_space(0.1)?).err();
        let Some(Error::Adhesion(AdhesionError::Unresolved { resolution, cell_needed, .. })) =
            refused
        else {
            return Err(Error::NotFinite { step: 0 });
        };
        assert!(resolution > 2.0 && cell_needed < 0.025);
        assert!((law.on(&half_space(cell_needed)?)?.resolution() - 0.5).abs() < 1e-12);
        let law = Adhesion::maugis(0.05, 1.0);
        let refused = law.on(&half_space(0.1)?).err();
        let Some(Error::Adhesion(AdhesionError::NoRoomForSlope { cell_needed, .. })) = refused
        else {
            return Err(Error::NotFinite { step: 0 });
        };
        assert!(law.on(&half_space(cell_needed * 0.999_999)?)?.flat_range() < 1e-6);
        for (law, quantity) in [
            (Adhesion::work(-0.05), "work of adhesion"),
            (Adhesion::work(f64::NAN), "work of adhesion"),
            (Adhesion::work(1.0).range(-1.0), "range of adhesion"),
            (Adhesion::maugis(1.0, 0.0), "cohesive stress"),
            (Adhesion::maugis(0.05, 0.3).range(1.0), "range of adhesion"),
            (Adhesion::maugis(0.05, 0.3).range(0.1), "range of adhesion"),
        ] {
            let told = law.on(&half_space(0.1)?).err().map(|error| error.to_string());
            assert!(told.as_deref().is_some_and(|told| told.starts_with(quantity)), "{told:?}");
        }
        Ok(())
    }
}
