//! The fit of an exponential or a power.

use asperity_studies::golden;
use asperity_studies::line::Line;

/// A function of x with one parameter t.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shape {
    /// exp(−x/t).
    Decay,
    /// exp(x/t).
    Growth,
    /// 1 − exp(−x/t).
    Saturation,
    /// x^t, for x > 0.
    Power,
}

impl Shape {
    fn value(self, x: f64, t: f64) -> f64 {
        match self {
            Self::Decay => (-x / t).exp(),
            Self::Growth => (x / t).exp(),
            Self::Saturation => -(-x / t).exp_m1(),
            Self::Power => x.powf(t),
        }
    }
}

/// y = offset + amplitude × shape(x; t), by least squares.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fit {
    shape: Shape,
    pub(crate) offset: f64,
    /// Of the shape in units of the greatest x: for exponentials this makes no difference.
    pub(crate) amplitude: f64,
    /// t: a length of x for exponentials, an exponent for a power.
    pub(crate) parameter: f64,
    /// Rms deviation.
    pub(crate) deviation: f64,
    /// The greatest x.
    unit: f64,
}

impl Fit {
    /// With an offset.
    pub(crate) fn with_offset(points: &[(f64, f64)], shape: Shape) -> Self {
        Self::new(points, shape, |shaped| {
            let line = Line::fit(shaped);
            (line.intercept, line.slope)
        })
    }

    /// The same with the offset zero.
    pub(crate) fn through_zero(points: &[(f64, f64)], shape: Shape) -> Self {
        Self::new(points, shape, |shaped| {
            let sum = |product: fn(&(f64, f64)) -> f64| shaped.iter().map(product).sum::<f64>();
            (0.0, sum(|(s, y)| s * y) / sum(|(s, _)| s * s))
        })
    }

    /// Offset and amplitude are the best ones for a t, which is searched for in steps first, then between the
    /// neighbours of the best.
    fn new(
        points: &[(f64, f64)],
        shape: Shape,
        linear: impl Fn(&[(f64, f64)]) -> (f64, f64),
    ) -> Self {
        let unit = points.iter().map(|(x, _)| x.abs()).fold(0.0, f64::max);
        let of = |step: f64| {
            let t = 10_f64.powf(step / 20.0);
            let shaped: Vec<_> =
                points.iter().map(|(x, y)| (shape.value(x / unit, t), *y)).collect();
            let (offset, amplitude) = linear(&shaped);
            let squares = shaped.iter().map(|(s, y)| (offset + amplitude * s - y).powi(2));
            let deviation = (squares.sum::<f64>() / points.len() as f64).sqrt();
            let parameter = if shape == Shape::Power { t } else { t * unit };
            Self { shape, offset, amplitude, parameter, deviation, unit }
        };
        let steps = (-30..=40).map(f64::from);
        let best = steps.min_by(|a, b| of(*a).deviation.total_cmp(&of(*b).deviation));
        let best = best.unwrap_or_default();
        of(golden::greatest(|step| -of(step).deviation, (best - 1.0, best + 1.0)).1)
    }

    /// y at x.
    pub(crate) fn at(&self, x: f64) -> f64 {
        let shape = match self.shape {
            Shape::Power => self.shape.value(x / self.unit, self.parameter),
            _ => self.shape.value(x, self.parameter),
        };
        self.offset + self.amplitude * shape
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_points_give_their_parameters() {
        for (shape, parameter) in [
            (Shape::Decay, 0.7),
            (Shape::Growth, 2.3),
            (Shape::Saturation, 1.1),
            (Shape::Power, 0.45),
        ] {
            let unit = 3.0;
            let points = |offset: f64| {
                (1..=40).map(f64::from).map(move |k| {
                    let x = unit * k / 40.0;
                    let of = if shape == Shape::Power { x / unit } else { x };
                    (x, offset - 2.5 * shape.value(of, parameter))
                })
            };
            let with = Fit::with_offset(&points(0.3).collect::<Vec<_>>(), shape);
            let without = Fit::through_zero(&points(0.0).collect::<Vec<_>>(), shape);
            for (fit, offset) in [(with, 0.3), (without, 0.0)] {
                assert!((fit.parameter / parameter - 1.0).abs() < 1e-6, "{fit:?}");
                assert!((fit.amplitude + 2.5).abs() < 1e-5, "{fit:?}");
                assert!((fit.offset - offset).abs() < 1e-5 && fit.deviation < 1e-6, "{fit:?}");
            }
        }
    }
}
