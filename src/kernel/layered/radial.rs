//! Functions of the distance that are known by their wave numbers: the inverse Hankel transform, and a table of it.

use std::f64::consts::{PI, TAU};

use crate::kernel::gauss::FOURTEEN;
use crate::parallel::for_each_chunk;

/// q times the transform of a function of the distance, which is
///
/// ```math
/// f(r) = \frac{1}{2 \pi} \int_0^\infty g(q)\, J_0(q r)\, \mathrm dq ,
/// ```
///
/// or with another Bessel function, of what goes with cos θ or cos 2θ.
#[derive(Debug)]
pub(super) struct Spectrum<G> {
    pub(super) g: G,
    pub(super) bessel: fn(f64) -> f64,
    /// Where g begins to vary. From here on it varies over wave numbers in proportion to themselves,
    pub(super) first: f64,
    /// or over this, if that is less.
    pub(super) widest: f64,
    /// From here on it does nothing but fade,
    pub(super) settled: f64,
    /// over this.
    pub(super) fading: f64,
    /// Nothing is left from here on.
    pub(super) end: f64,
}

/// Half waves of J₀ before those that are averaged: over one of them, g then changes by a sixteenth at most or fades.
const BEFORE: f64 = 16.0;
/// Partial integrals that are averaged.
const AVERAGED: usize = 24;

impl<G: Fn(f64) -> f64> Spectrum<G> {
    /// f(r).
    ///
    /// From half wave to half wave of J₀ partial integrals lie above and below the limit. Averages of neighbours, and
    /// their averages in turn, tend to it faster than any power.
    fn transform(&self, r: f64) -> f64 {
        let half = if r > 0.0 { PI / r } else { f64::INFINITY };
        let settled = self.settled.max(BEFORE * half);
        let (mut total, mut from, mut count) = (0.0, 0.0, 0.0);
        let mut next = |total: &mut f64| {
            count += 1.0;
            let to = (count * half).min(self.end);
            *total += self.integral(from, to, r);
            from = to;
            to
        };
        loop {
            let reached = next(&mut total);
            if reached >= self.end {
                return total / TAU;
            }
            if reached >= settled {
                break;
            }
        }
        let mut sums = [total; AVERAGED];
        for sum in &mut sums {
            *sum = total;
            next(&mut total);
        }
        for last in (1..AVERAGED).rev() {
            for i in 0..last {
                sums[i] = 0.5 * (sums[i] + sums[i + 1]);
            }
        }
        sums[0] / TAU
    }

    /// ∫ g J₀ dq between two wave numbers not more than half a wave apart, or below which g does not vary faster than
    /// J₀.
    fn integral(&self, from: f64, to: f64, r: f64) -> f64 {
        let (mut sum, mut a) = (0.0, from);
        while a < to {
            let widest = if a < self.settled { self.widest } else { self.fading };
            let step = a.max(self.first).min(widest);
            let b = if a + 1.2 * step < to { a + step } else { to };
            let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
            for (node, weight) in FOURTEEN {
                for q in [middle - half * node, middle + half * node] {
                    sum += half * weight * (self.g)(q) * (self.bessel)(q * r);
                }
            }
            a = b;
        }
        sum
    }
}

/// Coefficients of a panel.
const ORDER: usize = 14;
/// Width of panels in asinh(r / scale).
const WIDTH: f64 = 0.25;

/// A function of the distance, as Chebyshev series on panels.
///
/// Interpolated is f times $`\sqrt{r^2 + s^2}`$ as a function of asinh(r/s), with the scale s of f near the origin:
/// smooth at the origin, and where f falls as a power of r.
#[derive(Debug, Clone)]
pub(super) struct Radial {
    scale: f64,
    /// Ends of panels.
    ends: Vec<f64>,
    panels: Vec<Panel>,
}

#[derive(Debug, Clone, Copy, Default)]
struct Panel {
    middle: f64,
    per_half: f64,
    series: [f64; ORDER],
}

impl Radial {
    /// The function of `spectrum` up to the distance `reach`, with panels not wider than `widest`.
    pub(super) fn new<G: Fn(f64) -> f64 + Sync>(
        spectrum: &Spectrum<G>,
        scale: f64,
        reach: f64,
        widest: f64,
    ) -> Self {
        Self::of(|r| spectrum.transform(r), scale, reach, widest)
    }

    /// Any function that is smooth over `scale` near the origin, and over what is left of the distance beyond.
    pub(super) fn of(
        function: impl Fn(f64) -> f64 + Sync,
        scale: f64,
        reach: f64,
        widest: f64,
    ) -> Self {
        let mut panels = Vec::new();
        let mut ends = Vec::new();
        let mut from = 0.0_f64;
        while from < reach {
            let start = libm::asinh(from / scale);
            let to = (scale * libm::sinh(start + WIDTH)).min(from + widest);
            let half = 0.5 * (libm::asinh(to / scale) - start);
            panels.push(Panel { middle: start + half, per_half: 1.0 / half, ..Panel::default() });
            ends.push(to);
            from = to;
        }
        for_each_chunk(&mut panels, 1, |_, panels| {
            for panel in panels {
                panel.fill(|t| {
                    let r = scale * libm::sinh(t);
                    function(r) * scale * libm::cosh(t)
                });
            }
        });
        Self { scale, ends, panels }
    }

    /// f(r), for r within reach.
    pub(super) fn at(&self, r: f64) -> f64 {
        let [value] = self.at_each([r]);
        value
    }

    /// f at some distances within reach: Clenshaw's recurrences, each of which waits for itself, side by side.
    pub(super) fn at_each<const N: usize>(&self, distances: [f64; N]) -> [f64; N] {
        let panels = distances.map(|r| {
            let place = self.ends.partition_point(|end| *end < r).min(self.panels.len() - 1);
            &self.panels[place]
        });
        let ratios = distances.map(|r| r / self.scale);
        let x: [f64; N] = std::array::from_fn(|k| {
            (libm::asinh(ratios[k]) - panels[k].middle) * panels[k].per_half
        });
        let (mut b1, mut b2) = ([0.0; N], [0.0; N]);
        for place in (1..ORDER).rev() {
            for k in 0..N {
                let next = 2.0 * x[k] * b1[k] - b2[k] + panels[k].series[place];
                (b1[k], b2[k]) = (next, b1[k]);
            }
        }
        std::array::from_fn(|k| {
            let value = x[k] * b1[k] - b2[k] + panels[k].series[0];
            value / (self.scale * (1.0 + ratios[k] * ratios[k]).sqrt())
        })
    }

    /// Ends of panels.
    pub(super) fn ends(&self) -> &[f64] {
        &self.ends
    }
}

impl Panel {
    /// Chebyshev's interpolant at the nodes of its polynomial.
    fn fill(&mut self, function: impl Fn(f64) -> f64) {
        let n = ORDER as f64;
        let angle = |k: usize| PI * (k as f64 + 0.5) / n;
        let values: [f64; ORDER] =
            std::array::from_fn(|k| function(self.middle + libm::cos(angle(k)) / self.per_half));
        self.series = std::array::from_fn(|j| {
            let terms = (0..ORDER).map(|k| values[k] * libm::cos(j as f64 * angle(k)));
            terms.sum::<f64>() * if j == 0 { 1.0 } else { 2.0 } / n
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ e^(−cq) J₀(qr) dq = 1 / √(r² + c²), and minus its derivative by c.
    #[test]
    fn transforms_and_tables_of_exponentials() {
        for c in [1e-3, 1.0, 40.0] {
            let spectrum = Spectrum {
                g: |q: f64| (1.0 + q) * libm::exp(-c * q),
                bessel: libm::j0,
                first: 0.1 / c.max(1.0),
                widest: 2.0 / c,
                settled: 0.0,
                fading: 2.0 / c,
                end: 45.0 / c,
            };
            let exact = |r: f64| {
                let square = r * r + c * c;
                (1.0 / square.sqrt() + c / (square * square.sqrt())) / TAU
            };
            let table = Radial::new(&spectrum, c, 1000.0, f64::INFINITY);
            for k in 0..200 {
                let r = 1000.0 * (f64::from(k) / 200.0).powi(4);
                // The first is that of the greatest of both functions at this distance.
                let scale = (1.0 + 1.0 / c) / (TAU * (r * r + c * c).sqrt());
                let (found, expected) = (spectrum.transform(r), exact(r));
                assert!((found - expected).abs() < 2e-14 * scale, "{c} {r}: {found} {expected}");
                let found = table.at(r);
                assert!((found - expected).abs() < 2e-13 * scale, "{c} {r}: {found} {expected}");
            }
        }
    }
}
