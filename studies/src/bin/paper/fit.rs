//! The fit of an exponential or a power.

use std::error::Error;

use nalgebra_of_varpro::DVector;
use varpro::prelude::*;
use varpro::problem::SeparableProblemBuilder;
use varpro::solvers::levmar::LevMarSolver;

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

    /// Its derivative with respect to t.
    fn slope(self, x: f64, t: f64) -> f64 {
        match self {
            Self::Decay => (-x / t).exp() * x / (t * t),
            Self::Growth => -(x / t).exp() * x / (t * t),
            Self::Saturation => -(-x / t).exp() * x / (t * t),
            Self::Power => x.powf(t) * x.ln(),
        }
    }

    /// Where to start, with x up to 1.
    fn guess(self) -> f64 {
        match self {
            Self::Growth => 1.0,
            Self::Decay | Self::Saturation => 0.4,
            Self::Power => 0.5,
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
    /// With an offset, by variable projection and Levenberg-Marquardt.
    pub(crate) fn with_offset(points: &[(f64, f64)], shape: Shape) -> Result<Self, Box<dyn Error>> {
        Self::new(points, shape, true)
    }

    /// The same with the offset zero.
    pub(crate) fn through_zero(
        points: &[(f64, f64)],
        shape: Shape,
    ) -> Result<Self, Box<dyn Error>> {
        Self::new(points, shape, false)
    }

    fn new(points: &[(f64, f64)], shape: Shape, offset: bool) -> Result<Self, Box<dyn Error>> {
        // In units of the greatest, all numbers are of the order of 1.
        let greatest = |value: fn(&(f64, f64)) -> f64| {
            points.iter().map(|p| value(p).abs()).fold(0.0, f64::max)
        };
        let (unit, height) = (greatest(|p| p.0), greatest(|p| p.1));
        let x = DVector::from_iterator(points.len(), points.iter().map(|p| p.0 / unit));
        let y = DVector::from_iterator(points.len(), points.iter().map(|p| p.1 / height));
        let mut model = SeparableModelBuilder::<f64>::new(&["t"])
            .function(&["t"], move |x: &DVector<f64>, t: f64| x.map(|x| shape.value(x, t)))
            .partial_deriv("t", move |x: &DVector<f64>, t: f64| x.map(|x| shape.slope(x, t)));
        if offset {
            model =
                model.invariant_function(|x: &DVector<f64>| DVector::from_element(x.len(), 1.0));
        }
        let model = model
            .independent_variable(x.clone())
            .initial_parameters(vec![shape.guess()])
            .build()?;
        let problem = SeparableProblemBuilder::new(model).observations(y.clone()).build()?;
        let fit = LevMarSolver::default()
            .solve(problem)
            .map_err(|_| format!("the fit of {shape:?} did not converge"))?;
        let linear = fit
            .linear_coefficients()
            .ok_or_else(|| format!("the fit of {shape:?} has no coefficients"))?;
        let t = fit.nonlinear_parameters()[0];
        let found = Self {
            shape,
            offset: if offset { height * linear[1] } else { 0.0 },
            amplitude: height * linear[0],
            parameter: if shape == Shape::Power { t } else { t * unit },
            deviation: 0.0,
            unit,
        };
        let squares = points.iter().map(|(x, y)| (found.at(*x) - y).powi(2));
        let mean = squares.sum::<f64>() / points.len() as f64;
        Ok(Self { deviation: mean.sqrt(), ..found })
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
