//! Where the greatest stresses are.

use nalgebra::DMatrix;

use super::body::Subsurface;
use super::tensor::{Measure, StressField};
use crate::kernel::{Base, LayeredBody};
use crate::patches::{Connectivity, Patch, Patches};
use crate::{Error, StressError};

/// The greatest value of a measure, and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Greatest {
    /// \[Pa\].
    pub value: f64,
    /// Depth \[m\].
    pub depth: f64,
    /// The node above it, (ix, iy).
    pub node: (usize, usize),
}

/// The greatest values at a depth.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct DepthSurvey {
    /// Depth \[m\].
    pub depth: f64,
    /// In the order of [`Measure::ALL`].
    greatest: [Greatest; 4],
}

impl DepthSurvey {
    fn new(body: &Subsurface, field: &StressField) -> Self {
        let depth = field.depth;
        let greatest = field.greatest().map(|(value, node)| {
            let node = body.grid().coordinates(node);
            Greatest { value, depth, node }
        });
        Self { depth, greatest }
    }

    /// The greatest value of a measure at this depth.
    #[must_use]
    pub fn greatest(&self, measure: Measure) -> Greatest {
        self.greatest[measure as usize]
    }
}

/// The greatest stresses at each of some depths, and over all.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Survey {
    /// From the least depth to the greatest.
    pub depths: Vec<DepthSurvey>,
}

impl Survey {
    /// The greatest value of a measure at any of the depths. A survey that chooses its depths adds some around it: see
    /// [`Subsurface::survey`].
    #[must_use]
    pub fn greatest(&self, measure: Measure) -> Greatest {
        let all = self.depths.iter().map(|depth| depth.greatest(measure));
        let none = Greatest { value: f64::NEG_INFINITY, depth: 0.0, node: (0, 0) };
        // The first of equals, which is the least deep.
        all.fold(none, |best, next| if next.value > best.value { next } else { best })
    }

    fn insert(&mut self, depth: DepthSurvey) {
        let place = self.depths.partition_point(|other| other.depth < depth.depth);
        self.depths.insert(place, depth);
    }

    /// The place of the greatest value of a measure.
    fn place(&self, measure: Measure) -> usize {
        let depth = self.greatest(measure).depth;
        self.depths.partition_point(|other| other.depth < depth)
    }
}

/// The depths of one material, both included \[m\].
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    top: f64,
    bottom: f64,
}

/// Depths grow by this factor.
const RATIO: f64 = 1.25;
/// The least one below the surface, in sides of a cell.
const LEAST: f64 = 0.1;
/// Depths that are added around a greatest value: a parabola through three depths comes nearer with each.
const REFINED: usize = 3;

impl Subsurface {
    /// Depths at which stresses under a pressure are worth looking at \[m\]: the surface, and from a tenth of a cell on
    /// by a factor of 1.25 to the diameter of a circle of the area of the largest patch, or to the width of one that goes
    /// on without end, a line contact; of layers their interfaces as well, from both sides, and their middles.
    ///
    /// # Errors
    ///
    /// [`StressError::NoLoad`](crate::StressError::NoLoad) if there is no pressure; [`Error::GridMismatch`] and
    /// [`Error::FieldNotFinite`].
    pub fn depths(&self, pressure: &DMatrix<f64>) -> Result<Vec<f64>, Error> {
        let grid = self.grid();
        grid.check_finite("pressure", pressure)?;
        let contact = pressure.map(|pressure| pressure > 0.0);
        let patches = Patches::new(&contact, &grid, self.boundary(), Connectivity::Eight)?;
        let sides = grid.sides();
        let deepest = patches.patches().iter().map(|patch| size(patch, sides)).fold(0.0, f64::max);
        if deepest == 0.0 {
            return Err(StressError::NoLoad.into());
        }
        let mut depths = vec![0.0];
        let mut depth = LEAST * grid.cell_area().sqrt();
        while depth < RATIO.sqrt() * deepest {
            depths.push(depth);
            depth *= RATIO;
        }
        for Span { top, bottom } in self.spans() {
            depths
                .extend([top, 0.5 * (top + bottom), bottom].into_iter().filter(|z| z.is_finite()));
        }
        let end = self.end();
        depths.retain(|depth| *depth <= end);
        depths.sort_by(f64::total_cmp);
        depths.dedup();
        Ok(depths)
    }

    /// The depths of each material: the layers from the uppermost on, and the base unless it is rigid.
    pub(super) fn spans(&self) -> Vec<Span> {
        let layers = self.layers().map_or(&[][..], LayeredBody::layers);
        let mut spans = Vec::new();
        let (mut top, mut bottom) = (0.0_f64, 0.0);
        for layer in layers {
            bottom += layer.thickness;
            spans.push(Span { top, bottom });
            // On an interface stresses are those of the upper layer.
            top = f64::next_up(bottom);
        }
        if !self.layers().is_some_and(|body| body.base() == Base::Rigid) {
            spans.push(Span { top, bottom: f64::INFINITY });
        }
        spans
    }

    /// The depths of a survey that lie in each material, from the uppermost layer to the base; empty for a
    /// material in which no depth was looked at. What lies on an interface belongs to the layer above it.
    #[must_use]
    pub fn by_material(&self, survey: &Survey) -> Vec<Survey> {
        let spans = self.spans().into_iter();
        spans
            .map(|Span { top, bottom }| {
                let within = |depth: &&DepthSurvey| (top..=bottom).contains(&depth.depth);
                Survey { depths: survey.depths.iter().filter(within).copied().collect() }
            })
            .collect()
    }

    /// The greatest depth at which the body has stresses \[m\].
    fn end(&self) -> f64 {
        self.spans().last().map_or(f64::INFINITY, |span| span.bottom)
    }

    /// The greatest stresses under a pressure at given depths \[m\], or, without any, at [those](Self::depths) that are
    /// worth it: as many more as are needed until von Mises' and the greatest shear stress fall with depth, and three
    /// around the place where each is greatest, in each material.
    ///
    /// # Errors
    ///
    /// [`StressError::NoLoad`](crate::StressError::NoLoad) without a pressure or a depth, and those of
    /// [`Self::at_depth`].
    pub fn survey(&self, pressure: &DMatrix<f64>, depths: Option<&[f64]>) -> Result<Survey, Error> {
        self.survey_with(pressure, depths, |_| Ok(()))
    }

    /// The same, with each field handed over as it is found, in no order of depth. An error of `visit` ends the survey.
    ///
    /// # Errors
    ///
    /// Those of [`Self::survey`] and of `visit`.
    pub fn survey_with<E: From<Error>>(
        &self,
        pressure: &DMatrix<f64>,
        depths: Option<&[f64]>,
        mut visit: impl FnMut(&StressField) -> Result<(), E>,
    ) -> Result<Survey, E> {
        let mut survey = Survey { depths: Vec::new() };
        match depths {
            Some(depths) => {
                for &depth in depths {
                    self.survey_depth((pressure, depth), &mut survey, &mut visit)?;
                }
            }
            None => {
                for span in self.spans() {
                    let found = self.survey_within(span, pressure, &mut visit)?;
                    survey.depths.extend(found.depths);
                }
            }
        }
        if survey.depths.is_empty() {
            return Err(Error::from(StressError::NoLoad).into());
        }
        Ok(survey)
    }

    /// The same within one material, at depths that are chosen.
    pub(super) fn survey_within<E: From<Error>>(
        &self,
        span: Span,
        pressure: &DMatrix<f64>,
        visit: &mut impl FnMut(&StressField) -> Result<(), E>,
    ) -> Result<Survey, E> {
        let mut survey = Survey { depths: Vec::new() };
        let mut add = |survey: &mut Survey, depth: f64| {
            self.survey_depth((pressure, depth), survey, &mut *visit)
        };
        let within = |depth: &f64| (span.top..=span.bottom).contains(depth);
        for depth in self.depths(pressure)?.into_iter().filter(within) {
            add(&mut survey, depth)?;
        }
        let sides = self.grid().sides();
        for measure in [Measure::VonMises, Measure::GreatestShear] {
            while survey.place(measure) + 1 == survey.depths.len() {
                let deepest = survey.greatest(measure).depth;
                if deepest > sides.0.max(sides.1) || RATIO * deepest > span.bottom {
                    break;
                }
                add(&mut survey, RATIO * deepest)?;
            }
            for _ in 0..REFINED {
                let place = survey.place(measure);
                let Some([a, b, c]) = around(&survey.depths, place, measure) else { break };
                add(&mut survey, vertex(a, b, c))?;
            }
        }
        Ok(survey)
    }

    fn survey_depth<E: From<Error>>(
        &self,
        (pressure, depth): (&DMatrix<f64>, f64),
        survey: &mut Survey,
        visit: &mut impl FnMut(&StressField) -> Result<(), E>,
    ) -> Result<(), E> {
        let field = self.at_depth(pressure, depth)?;
        survey.insert(DepthSurvey::new(self, &field));
        visit(&field)
    }
}

/// The diameter of a circle of the area of a patch, or the width of a strip of its area if that goes on without end
/// and is wider; without end along both sides, the longer side.
fn size(patch: &Patch, (x, y): (f64, f64)) -> f64 {
    let round = 2.0 * (patch.area / std::f64::consts::PI).sqrt();
    match patch.wraps {
        (false, false) => round,
        (true, false) => round.max(patch.area / x),
        (false, true) => round.max(patch.area / y),
        (true, true) => round.max(x).max(y),
    }
}

/// Depth and value on both sides of a place and there, unless it is at an end.
fn around(depths: &[DepthSurvey], place: usize, measure: Measure) -> Option<[(f64, f64); 3]> {
    let at = |place: usize| {
        let found = depths.get(place)?.greatest(measure);
        Some((found.depth, found.value))
    };
    Some([at(place.checked_sub(1)?)?, at(place)?, at(place + 1)?])
}

/// Where a parabola through three points is greatest, of which that in the middle is; not closer to any of them than a
/// twentieth of their distances, where it would tell nothing.
fn vertex((a, fa): (f64, f64), (b, fb): (f64, f64), (c, fc): (f64, f64)) -> f64 {
    let (left, right) = (b - a, c - b);
    let (rise, fall) = (fb - fa, fb - fc);
    let curvature = left * fall + right * rise;
    let shift = 0.5 * (right * right * rise - left * left * fall) / curvature;
    let shift = if shift.is_finite() { shift } else { 0.0 };
    let least = 0.05 * left.min(right);
    // If the middle is the vertex already, the longer side is divided.
    let shift = if shift.abs() < least {
        if right > left { least.max(0.25 * right) } else { -least.max(0.25 * left) }
    } else {
        shift
    };
    b + shift.clamp(-0.95 * left, 0.95 * right)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parabolas_have_their_vertex() {
        let f = |z: f64| 3.0 - 2.0 * (z - 1.3) * (z - 1.3);
        let found = vertex((1.0, f(1.0)), (1.2, f(1.2)), (1.5, f(1.5)));
        assert!((found - 1.3).abs() < 1e-14, "{found}");
        // On the vertex, and on a plateau, the longer side is divided.
        assert_eq!(vertex((0.3, f(0.3)), (1.3, f(1.3)), (1.8, f(1.8))), 1.3 - 0.25);
        assert_eq!(vertex((0.0, 1.0), (1.0, 1.0), (3.0, 1.0)), 1.5);
    }
}
