//! The fit of an exponential.

use std::error::Error;

use nalgebra_of_varpro::DVector;
use varpro::prelude::*;
use varpro::problem::SeparableProblemBuilder;
use varpro::solvers::levmar::LevMarSolver;

/// y = y₀ + A exp(−x/t).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Exponential {
    pub(crate) offset: f64,
    pub(crate) amplitude: f64,
    pub(crate) scale: f64,
    /// Rms deviation.
    pub(crate) deviation: f64,
}

impl Exponential {
    /// The least-squares exponential through points, by variable projection and
    /// Levenberg-Marquardt, from the guess `scale` for t.
    pub(crate) fn fit(points: &[(f64, f64)], scale: f64) -> Result<Self, Box<dyn Error>> {
        // In units of the guess all numbers are of the order of 1.
        let x = DVector::from_iterator(points.len(), points.iter().map(|p| p.0 / scale));
        let y = DVector::from_iterator(points.len(), points.iter().map(|p| p.1));
        let model = SeparableModelBuilder::<f64>::new(&["t"])
            .function(&["t"], |x: &DVector<f64>, t: f64| x.map(|x| (-x / t).exp()))
            .partial_deriv("t", |x: &DVector<f64>, t: f64| {
                x.map(|x| (-x / t).exp() * x / (t * t))
            })
            .invariant_function(|x: &DVector<f64>| DVector::from_element(x.len(), 1.0))
            .independent_variable(x.clone())
            .initial_parameters(vec![1.0])
            .build()?;
        let problem = SeparableProblemBuilder::new(model)
            .observations(y.clone())
            .build()?;
        let fit = LevMarSolver::default()
            .solve(problem)
            .map_err(|_| "the exponential fit did not converge")?;
        let linear = fit
            .linear_coefficients()
            .ok_or("the exponential fit has no coefficients")?;
        let t = fit.nonlinear_parameters()[0];
        let (amplitude, offset) = (linear[0], linear[1]);
        let residual = x.map(|x| offset + amplitude * (-x / t).exp()) - y;
        Ok(Self {
            offset,
            amplitude,
            scale: t * scale,
            deviation: residual.norm() / (points.len() as f64).sqrt(),
        })
    }

    /// y at x.
    pub(crate) fn at(&self, x: f64) -> f64 {
        self.offset + self.amplitude * (-x / self.scale).exp()
    }
}
