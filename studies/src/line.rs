//! Straight lines through points.

/// y = intercept + slope x.
#[derive(Debug, Clone, Copy)]
pub struct Line {
    /// dy/dx.
    pub slope: f64,
    /// y at x = 0.
    pub intercept: f64,
    /// Pearson's correlation coefficient.
    pub pearson: f64,
}

impl Line {
    /// The least-squares line through points, from deviations from their mean; not a number where all
    /// have the same x.
    pub fn fit(points: &[(f64, f64)]) -> Self {
        let n = points.len() as f64;
        let mean = |value: fn(&(f64, f64)) -> f64| points.iter().map(value).sum::<f64>() / n;
        let (x, y) = (mean(|p| p.0), mean(|p| p.1));
        let sum = |product: fn(f64, f64) -> f64| -> f64 {
            points.iter().map(|p| product(p.0 - x, p.1 - y)).sum()
        };
        let (xx, xy, yy) = (sum(|x, _| x * x), sum(|x, y| x * y), sum(|_, y| y * y));
        let slope = xy / xx;
        Self { slope, intercept: y - slope * x, pearson: xy / (xx * yy).sqrt() }
    }

    /// y at x.
    pub fn at(&self, x: f64) -> f64 {
        self.intercept + self.slope * x
    }
}
