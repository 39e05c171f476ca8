//! How often values occur.

use crate::Error;

/// How the range of values is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Bins {
    /// So many of one width, from zero, or the least value if that is below, to the greatest.
    Linear(usize),
    /// So many for each factor of ten, all of one ratio, with edges at the powers of ten: from the edge below the
    /// least positive value to the one above the greatest. Values that are not positive lie outside.
    PerDecade(usize),
}

/// How many values lie in each of a number of bins.
///
/// A value on an edge belongs to the bin above it, one on the last edge to the last bin.
#[derive(Debug, Clone, PartialEq)]
pub struct Histogram {
    edges: Vec<f64>,
    counts: Vec<usize>,
    outside: usize,
}

impl Histogram {
    /// Most bins of a linear histogram.
    pub const MAX_BINS: usize = 1 << 16;

    /// Most bins in a factor of ten.
    pub const MAX_PER_DECADE: usize = 1000;

    /// The histogram of these values. Without any that bins can be made for, none or only zeros,
    /// it has no bins.
    ///
    /// ```
    /// use asperity::patches::{Bins, Histogram};
    ///
    /// # fn main() -> Result<(), asperity::Error> {
    /// let areas = [1e-12, 2e-12, 5e-11, 0.0];
    /// let histogram = Histogram::new(areas, Bins::PerDecade(1))?;
    /// assert_eq!(histogram.counts(), [2, 1]);
    /// assert_eq!(histogram.outside(), 1);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a value that is not finite, for no bins or more than [`Self::MAX_BINS`] or
    /// [`Self::MAX_PER_DECADE`], and for bins so narrow that rounding makes
    /// two edges one, or with an edge beyond the greatest double.
    pub fn new(values: impl IntoIterator<Item = f64>, bins: Bins) -> Result<Self, Error> {
        let values: Vec<f64> = values.into_iter().collect();
        for &value in &values {
            Error::require("value of a histogram", value, value.is_finite(), "finite")?;
        }
        let edges = match bins {
            Bins::Linear(count) => linear(&values, count)?,
            Bins::PerDecade(count) => per_decade(&values, count)?,
        };
        Self::with_edges(values, edges)
    }

    /// The same with given edges, to compare several states; fewer than two make no bin. NaN lies outside.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for an edge that is not finite, or not above the one before it.
    pub fn with_edges(
        values: impl IntoIterator<Item = f64>,
        edges: Vec<f64>,
    ) -> Result<Self, Error> {
        let mut last = f64::NEG_INFINITY;
        for &edge in &edges {
            let is_next = edge > last && edge.is_finite();
            let expected = "finite and above the one before it";
            last = Error::require("edge of a bin", edge, is_next, expected)?;
        }
        let mut counts = vec![0; edges.len().saturating_sub(1)];
        let mut outside = 0;
        for value in values {
            let above = edges.partition_point(|edge| *edge <= value);
            let bin = if value == last { above.checked_sub(2) } else { above.checked_sub(1) };
            match bin.and_then(|bin| counts.get_mut(bin)) {
                Some(count) => *count += 1,
                None => outside += 1,
            }
        }
        Ok(Self { edges, counts, outside })
    }

    /// Edges of the bins, one more than there are bins; empty without bins.
    #[must_use]
    pub fn edges(&self) -> &[f64] {
        &self.edges
    }

    /// Number of values in each bin.
    #[must_use]
    pub fn counts(&self) -> &[usize] {
        &self.counts
    }

    /// Number of values in no bin.
    #[must_use]
    pub fn outside(&self) -> usize {
        self.outside
    }

    /// Probability density in each bin, per unit of the values: counts over the number of all values and the width of
    /// the bin. Its integral is the share of values inside, 1 if there are none outside.
    #[must_use]
    pub fn density(&self) -> Vec<f64> {
        let all = self.counts.iter().sum::<usize>() + self.outside;
        let bins = self.counts.iter().zip(self.edges.windows(2));
        bins.map(|(&count, edges)| {
            if count == 0 {
                return 0.0;
            }
            // Halves, since the whole width may overflow.
            let half_width = 0.5 * edges[1] - 0.5 * edges[0];
            0.5 * (count as f64 / all as f64) / half_width
        })
        .collect()
    }
}

fn linear(values: &[f64], count: usize) -> Result<Vec<f64>, Error> {
    let is_number = (1..=Histogram::MAX_BINS).contains(&count);
    Error::require("number of bins", count as f64, is_number, "1 to 65536")?;
    let least = values.iter().copied().fold(0.0, f64::min);
    let greatest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if greatest <= least {
        return Ok(Vec::new());
    }
    let part = |k: usize| k as f64 / count as f64;
    let edges = (0..=count).map(|k| least * (1.0 - part(k)) + greatest * part(k));
    Ok(edges.collect())
}

fn per_decade(values: &[f64], count: usize) -> Result<Vec<f64>, Error> {
    let is_number = (1..=Histogram::MAX_PER_DECADE).contains(&count);
    Error::require("bins per decade", count as f64, is_number, "1 to 1000")?;
    let positive = values.iter().copied().filter(|value| *value > 0.0);
    let least = positive.clone().fold(f64::INFINITY, f64::min);
    let greatest = positive.fold(0.0, f64::max);
    if greatest == 0.0 {
        return Ok(Vec::new());
    }
    // At most 630 decades, and so within the type.
    let edge = |k: i32| libm::pow(10.0, f64::from(k) / count as f64);
    let below = |value: f64| (libm::log10(value) * count as f64).floor() as i32;
    // Logarithms are rounded: the edges themselves decide.
    let mut first = below(least);
    while edge(first) > least {
        first -= 1;
    }
    let mut last = below(greatest);
    while edge(last) <= greatest {
        last += 1;
    }
    Ok((first..=last).map(edge).collect())
}
