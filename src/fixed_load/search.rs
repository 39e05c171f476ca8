//! The load of a state of which something else is known.

use super::continuation::Continuation;
use super::solution::FixedLoadSolution;
use super::solver::FixedLoadSolver;
use crate::krylov::sum;
use crate::{Error, InfluenceKernel, Surface};

/// Steps after which to give up; bisection alone would halve the bracket so often.
const MOST_STEPS: usize = 100;
/// Longest step as the logarithm of a load, as long as there is a bound on one side only.
const LONGEST: f64 = 1.5;
/// A bracket of loads that is narrower, relative to the load, holds nothing more.
const NARROWEST: f64 = 1e-13;
/// Contact area fraction from which to look for a mean gap.
const TYPICAL: f64 = 0.05;

/// What is looked for, along the logarithm of the load.
#[derive(Debug, Clone, Copy)]
pub(super) enum Sought {
    /// So many nodes. Area grows in proportion to the load over decades.
    Nodes(usize),
    /// A mean gap, that for no load, and the greatest error. It falls with the logarithm of the load
    /// over decades.
    MeanGap {
        target: f64,
        unloaded: f64,
        tolerance: f64,
    },
}

impl Sought {
    /// How far a solution lies beyond, in a measure that is close to a line over the logarithm of the
    /// load and grows with it.
    fn beyond(self, solution: &FixedLoadSolution) -> f64 {
        let state = &solution.state;
        match self {
            Self::Nodes(nodes) => (state.contact_nodes as f64 / nodes as f64).ln(),
            Self::MeanGap {
                target, unloaded, ..
            } => (target - state.mean_gap) / unloaded,
        }
    }

    fn is_found(self, solution: &FixedLoadSolution) -> bool {
        let state = &solution.state;
        match self {
            Self::Nodes(nodes) => state.contact_nodes == nodes,
            Self::MeanGap {
                target, tolerance, ..
            } => (state.mean_gap - target).abs() <= tolerance * state.approach,
        }
    }

    /// Slope of [`Self::beyond`] at a solution, exact if stiffnesses are known.
    fn slope(self, solution: &FixedLoadSolution) -> f64 {
        match self {
            Self::Nodes(_) => 1.0,
            Self::MeanGap { unloaded, .. } => {
                let state = &solution.state;
                match state.interfacial_stiffness {
                    Some(stiffness) => state.load / stiffness / unloaded,
                    None => 0.2,
                }
            }
        }
    }
}

impl<S: Surface, K: InfluenceKernel> FixedLoadSolver<S, K> {
    /// The number of nodes for a fraction of the nominal area.
    pub(super) fn nodes_of(&self, fraction: f64) -> Result<Sought, Error> {
        if !(fraction > 0.0 && fraction <= 1.0) {
            return Err(Error::OutOfRange {
                quantity: "contact area fraction",
                value: fraction,
                expected: "above 0 and at most 1",
            });
        }
        let nodes = (fraction * self.grid.nodes() as f64).round() as usize;
        Ok(Sought::Nodes(nodes.max(1)))
    }

    /// The search for a mean gap.
    pub(super) fn mean_gap_of(&self, target: f64) -> Result<Sought, Error> {
        let gaps = &self.levels[0].gap;
        let unloaded = sum(gaps) / gaps.len() as f64;
        if !(target > 0.0 && target < unloaded) {
            return Err(Error::OutOfRange {
                quantity: "mean gap",
                value: target,
                expected: "above 0 and below that of surfaces that just touch",
            });
        }
        Ok(Sought::MeanGap {
            target,
            unloaded,
            tolerance: self.tolerance,
        })
    }

    /// A load of the right order: the area times the pressure that flattens two neighbours.
    ///
    /// On rough contact the mean pressure of the true area is half of E* times the rms gradient; with
    /// the step s between neighbours and C(0, 0) ≈ 1.12 dx / E* that is 0.56 s / C(0, 0).
    fn typical_load(&self, sought: Sought) -> f64 {
        let level = &self.levels[0];
        let steps = level.gap.windows(2).map(|pair| (pair[1] - pair[0]).powi(2));
        let mut step = (steps.sum::<f64>() / level.gap.len() as f64).sqrt();
        if step <= 0.0 {
            step = self.grid.dx();
        }
        let nodes = match sought {
            Sought::Nodes(nodes) => nodes as f64,
            Sought::MeanGap { .. } => TYPICAL * self.grid.nodes() as f64,
        };
        let own = level.self_influence;
        self.grid.cell_area() * nodes * (0.56 * step / own)
    }

    /// The state that is sought, from the `last` one of a sweep if there is one: the root of
    /// [`Sought::beyond`] by the exact tangent or by secants, inside a bracket once there is one.
    ///
    /// # Errors
    ///
    /// Those of [`Self::solve`]; [`Error::NoConvergence`] if the root is not found.
    pub(super) fn search(
        &mut self,
        continuation: &mut Continuation,
        sought: Sought,
        last: Option<&FixedLoadSolution>,
    ) -> Result<FixedLoadSolution, Error> {
        let (mut low, mut high): (Option<f64>, Option<f64>) = (None, None);
        let mut best: Option<FixedLoadSolution> = None;
        let mut previous = last.map(|last| (last.state.load.ln(), sought.beyond(last)));
        let mut x = match (last, previous) {
            (Some(last), Some((x, beyond))) => {
                x - (beyond / sought.slope(last)).clamp(-LONGEST, LONGEST)
            }
            _ => self.typical_load(sought).ln(),
        };
        let mut is_state = last.is_some();
        for _ in 0..MOST_STEPS {
            let solution = self.next_load(continuation, x.exp(), is_state)?;
            is_state = true;
            if sought.is_found(&solution) {
                return Ok(solution);
            }
            let beyond = sought.beyond(&solution);
            let side = if beyond > 0.0 { &mut high } else { &mut low };
            *side = Some(x);
            let mut slope = sought.slope(&solution);
            if let Some((earlier, then)) = previous
                && !matches!(sought, Sought::MeanGap { .. } if solution.state.interfacial_stiffness.is_some())
            {
                let secant = (beyond - then) / (x - earlier);
                if secant > 0.0 && secant.is_finite() {
                    slope = secant;
                }
            }
            previous = Some((x, beyond));
            if best
                .as_ref()
                .is_none_or(|best| beyond.abs() < sought.beyond(best).abs())
            {
                best = Some(solution);
            }
            let mut next = x - (beyond / slope).clamp(-LONGEST, LONGEST);
            if let (Some(low), Some(high)) = (low, high) {
                // NaN as well.
                if !(next > low && next < high) {
                    next = low + 0.5 * (high - low);
                }
                if high - low <= NARROWEST * high.abs().max(1.0) {
                    break;
                }
            }
            x = next;
        }
        match (best, sought) {
            // Nodes that touch together: the nearest number there is.
            (Some(best), Sought::Nodes(_)) if low.is_some() && high.is_some() => Ok(best),
            (best, _) => Err(Error::NoConvergence {
                residual: best.map_or(f64::INFINITY, |best| sought.beyond(&best).abs()),
                tolerance: self.tolerance,
                iterations: MOST_STEPS,
            }),
        }
    }
}
