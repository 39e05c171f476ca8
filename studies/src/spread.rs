//! What several surfaces have in common, and by how much they differ.

use asperity_cli::number::power_of_ten;

/// Mean and sample standard deviation of a number over the seeds.
#[derive(Debug, Clone, Copy)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Of a single value, not of the mean; from n − 1.
    pub deviation: f64,
}

impl Spread {
    /// Of some values; the deviation of a single one is zero.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let values: Vec<f64> = values.into_iter().collect();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
        Self { mean, deviation: (squares / (n - 1.0).max(1.0)).sqrt() }
    }

    /// As "mean ± deviation" with so many decimals.
    pub fn decimals(&self, decimals: usize) -> String {
        format!("{:.decimals$} ± {:.decimals$}", self.mean, self.deviation).replace('-', "−")
    }

    /// As "mean ± deviation" in units of a power of ten.
    pub fn scientific(&self, exponent: i32, decimals: usize) -> String {
        let unit = 10_f64.powi(exponent);
        let scaled = Self { mean: self.mean / unit, deviation: self.deviation / unit };
        format!("({}) × {}", scaled.decimals(decimals), power_of_ten(exponent))
    }
}
