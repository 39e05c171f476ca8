//! Least-squares fits.

use std::error::Error;

use nalgebra_of_varpro::{DMatrix, DVector};
use varpro::prelude::*;
use varpro::problem::SeparableProblemBuilder;
use varpro::solvers::levmar::LevMarSolver;

/// y = intercept + slope x.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line {
    pub(crate) slope: f64,
    pub(crate) intercept: f64,
    /// Pearson's correlation coefficient.
    pub(crate) pearson: f64,
}

impl Line {
    /// The least-squares line through points, by singular values.
    pub(crate) fn fit(points: &[(f64, f64)]) -> Result<Self, Box<dyn Error>> {
        let n = points.len() as f64;
        let mean = |value: fn(&(f64, f64)) -> f64| points.iter().map(value).sum::<f64>() / n;
        let (mx, my) = (mean(|p| p.0), mean(|p| p.1));
        let scale = points.iter().map(|p| (p.0 - mx).abs()).fold(0.0, f64::max);
        // Centred and scaled, the two columns are orthogonal and of one size.
        let design = DMatrix::from_fn(points.len(), 2, |row, column| match column {
            0 => 1.0,
            _ => (points[row].0 - mx) / scale,
        });
        let values = DVector::from_iterator(points.len(), points.iter().map(|p| p.1));
        let found = design.svd(true, true).solve(&values, 1e-12)?;
        let centred = values.add_scalar(-my);
        let slope = found[1] / scale;
        let spread = points.iter().map(|p| (p.0 - mx).powi(2)).sum::<f64>();
        Ok(Self {
            slope,
            intercept: found[0] - slope * mx,
            pearson: slope * spread.sqrt() / centred.norm(),
        })
    }

    /// y at x.
    pub(crate) fn at(&self, x: f64) -> f64 {
        self.intercept + self.slope * x
    }
}

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

/// Mean and sample standard deviation of a number over the seeds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spread {
    pub(crate) mean: f64,
    pub(crate) deviation: f64,
}

impl Spread {
    /// Of some values; the deviation of a single one is zero.
    pub(crate) fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let values: Vec<f64> = values.into_iter().collect();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
        Self {
            mean,
            deviation: (squares / (n - 1.0).max(1.0)).sqrt(),
        }
    }

    /// As "mean ± deviation" with so many decimals.
    pub(crate) fn decimals(&self, decimals: usize) -> String {
        format!("{:.decimals$} ± {:.decimals$}", self.mean, self.deviation).replace('-', "−")
    }

    /// As "mean ± deviation" in units of a power of ten.
    pub(crate) fn scientific(&self, exponent: i32, decimals: usize) -> String {
        let unit = 10_f64.powi(exponent);
        let scaled = Self {
            mean: self.mean / unit,
            deviation: self.deviation / unit,
        };
        format!(
            "({}) × {}",
            scaled.decimals(decimals),
            crate::number::power_of_ten(exponent)
        )
    }
}
