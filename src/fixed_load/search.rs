//! The load of a state of which something else is known.

use super::level::Level;
use super::plateau::Plateau;
use super::solution::FixedLoadSolution;
use super::stepper::Stepper;
use super::tuning::{LONGEST, MOST_LAME, MOST_STEPS, NARROWEST, ROUNDING, TYPICAL};
use crate::Error;
use crate::contact::{ContactState, ContactTarget};

/// Contact at a target, from the last state of `stepper`.
///
/// # Errors
///
/// Those of the steps; [`Error::OutOfRange`] for a fraction of the area or a mean gap that cannot be,
/// and [`Error::NoConvergence`] if the load that goes with it is not found.
pub(super) fn solve_target(
    stepper: &mut Stepper<'_>,
    target: ContactTarget,
) -> Result<FixedLoadSolution, Error> {
    match target {
        ContactTarget::Load(load) => stepper.step_to_load(load),
        ContactTarget::MeanPressure(mean_pressure) => {
            let mean_pressure = Error::require_positive("mean pressure", mean_pressure)?;
            let area = stepper.finest().grid.nominal_area();
            stepper.step_to_load(mean_pressure * area)
        }
        ContactTarget::Approach(approach) if stepper.finds_approach() => {
            let target = Error::require_positive("approach", approach)?;
            let unloaded = stepper.finest().mean_initial_gap();
            search(stepper, Sought::Approach { target, unloaded })
        }
        ContactTarget::Approach(approach) => stepper.step_to_approach(approach),
        ContactTarget::AreaFraction(fraction) => {
            let nodes = stepper.finest().grid.nodes_in(fraction)?;
            stepper.count_nodes();
            search(stepper, Sought::Nodes(nodes))
        }
        ContactTarget::MeanGap(mean_gap) => {
            let sought = Sought::mean_gap(mean_gap, stepper.finest())?;
            search(stepper, sought)
        }
    }
}

/// The quantity that is looked for, along the logarithm of the load.
#[derive(Debug, Clone, Copy)]
enum Sought {
    /// So many nodes. Area grows in proportion to the load over decades.
    Nodes(usize),
    /// A mean gap, given the one without load. It falls with the logarithm of the load over decades.
    MeanGap { target: f64, unloaded: f64 },
    /// An approach, and the mean gap without load.
    Approach { target: f64, unloaded: f64 },
}

impl Sought {
    fn mean_gap(target: f64, level: &Level) -> Result<Self, Error> {
        let unloaded = level.mean_initial_gap();
        if !(target > 0.0 && target < unloaded) {
            return Err(Error::OutOfRange {
                quantity: "mean gap",
                value: target,
                expected: "above 0 and below that of surfaces that just touch",
            });
        }
        Ok(Self::MeanGap { target, unloaded })
    }

    /// How far a state lies beyond, in a measure that is close to a line over the logarithm of the
    /// load and grows with it. Nodes that touch without pressure count as half a node.
    fn beyond(self, state: &ContactState, carrying: usize) -> f64 {
        match self {
            Self::Nodes(nodes) => {
                let touching = if carrying < state.contact_nodes { 0.5 } else { 0.0 };
                ((carrying as f64 + touching) / nodes as f64).ln()
            }
            Self::MeanGap { target, unloaded } => (target - state.mean_gap) / unloaded,
            Self::Approach { target, unloaded } => (state.approach - target) / unloaded,
        }
    }

    /// How far a state is off: for nodes, a part of their number.
    fn distance(self, state: &ContactState, carrying: usize) -> f64 {
        let beyond = self.beyond(state, carrying);
        match self {
            Self::Nodes(_) => beyond.exp_m1().abs(),
            _ => beyond.abs(),
        }
    }

    /// Whether a state, whose gaps are exact to `error`, is the one sought.
    fn is_found(self, state: &ContactState, carrying: usize, error: f64) -> bool {
        match self {
            Self::Nodes(nodes) => state.contact_nodes == nodes && carrying == nodes,
            Self::MeanGap { target, unloaded } => {
                (state.mean_gap - target).abs() <= error.max(ROUNDING * unloaded)
            }
            Self::Approach { target, .. } => {
                (state.approach - target).abs() <= error.max(ROUNDING * target)
            }
        }
    }

    /// The approach at which a plateau has what is sought, or would have it; `None` for nodes, whose number stays.
    fn approach_on(self, plateau: &Plateau) -> Option<f64> {
        match self {
            Self::Nodes(_) => None,
            Self::MeanGap { target, .. } => Some(plateau.approach_at(target)),
            Self::Approach { target, .. } => Some(target),
        }
    }

    /// Slope of [`Self::beyond`] at a state, and whether it is exact.
    fn slope(self, state: &ContactState) -> (f64, bool) {
        match self {
            Self::Nodes(_) => (1.0, false),
            Self::Approach { .. } => (0.2, false),
            Self::MeanGap { unloaded, .. } => match state.interfacial_stiffness {
                // On a plateau there is none.
                Some(stiffness) if stiffness > 0.0 => (state.load / stiffness / unloaded, true),
                _ => (0.2, false),
            },
        }
    }

    /// A load of the right order: the area times the pressure that flattens two neighbours.
    ///
    /// On rough contact the mean pressure of the true area is half of E* times the rms gradient; with
    /// the step s between neighbours and C(0, 0) ≈ 1.12 dx / E* that is 0.56 s / C(0, 0).
    fn typical_load(self, level: &Level) -> f64 {
        let steps = level.gap.windows(2).map(|pair| (pair[1] - pair[0]).powi(2));
        let mut step = (steps.sum::<f64>() / level.gap.len() as f64).sqrt();
        if step <= 0.0 {
            step = level.grid.dx();
        }
        let nodes = match self {
            Self::Nodes(nodes) => nodes as f64,
            _ => TYPICAL * level.grid.nodes() as f64,
        };
        level.grid.cell_area() * nodes * (0.56 * step / level.self_influence)
    }
}

/// The next step where nothing has happened on the way between two places, as close to full contact: twice as far as
/// that way, and no less than `change`, whose absolute value is at most the longest step.
fn further(change: f64, [from, to]: [f64; 2]) -> f64 {
    (2.0 * (to - from).abs()).clamp(change.abs(), LONGEST).copysign(change)
}

/// The state that is sought: the root of [`Sought::beyond`] by the exact tangent or by secants, inside
/// a bracket once there is one.
///
/// Fewer nodes than touch first cannot be had: as long as no other node is in contact, pressures are proportional to
/// the load, and the contact is the same under any smaller one.
fn search(stepper: &mut Stepper<'_>, sought: Sought) -> Result<FixedLoadSolution, Error> {
    let step = |beyond: f64, slope: f64| (-beyond / slope).clamp(-LONGEST, LONGEST);
    let (mut low, mut high): (Option<f64>, Option<f64>) = (None, None);
    let mut nearest: Option<((bool, f64), FixedLoadSolution)> = None;
    let mut previous = None;
    // How far off the search was, and how wide the bracket, when either had halved last, and the steps since.
    let (mut halved, mut lame) = ([f64::INFINITY; 2], 0);
    let mut x = match stepper.last() {
        Some(last) => {
            let (x, beyond) = (last.load.ln(), sought.beyond(last, last.contact_nodes));
            previous = Some((x, beyond));
            x + step(beyond, sought.slope(last).0)
        }
        None => sought.typical_load(stepper.finest()).ln(),
    };
    for _ in 0..MOST_STEPS {
        if let Some(greatest) = stepper.greatest_load() {
            // No state has that load.
            let most = greatest.ln() - 10.0 * NARROWEST;
            if x > most && low == Some(most) {
                break;
            }
            x = x.min(most);
        }
        let solution = stepper.step_to_load(x.exp())?;
        let state = &solution.contact;
        let carrying = solution.carrying_nodes();
        if sought.is_found(state, carrying, stepper.gap_error(state)) {
            return Ok(solution);
        }
        let beyond = sought.beyond(state, carrying);
        if beyond > 0.0
            && matches!(sought, Sought::Nodes(_))
            && stepper.finest().touch_first(&solution.fields.contact_map)
        {
            return Ok(solution);
        }
        let side = if beyond > 0.0 { &mut high } else { &mut low };
        *side = Some(x);
        // On a plateau the load is one, and tells nothing of the rest.
        for plateau in stepper.plateaus_of(&solution)? {
            let Some(approach) = sought.approach_on(&plateau) else {
                continue;
            };
            let x = stepper.load_of(&plateau).ln();
            if approach < plateau.ends[0] {
                high = Some(high.map_or(x, |high| high.min(x)));
            } else if approach > plateau.ends[1] {
                low = Some(low.map_or(x, |low| low.max(x)));
            } else {
                return stepper.rest_on(plateau, approach);
            }
        }
        let (slope, is_exact) = sought.slope(state);
        let mut change = step(beyond, slope);
        if let Some((earlier, then)) = previous
            && !is_exact
        {
            let secant = (beyond - then) / (x - earlier);
            if secant > 0.0 && secant.is_finite() {
                change = step(beyond, secant);
            } else if beyond == then {
                change = further(change, [earlier, x]);
            }
        }
        previous = Some((x, beyond));
        // Where nodes just touch, rounding decides how many. Of loads as good the last is nearest to where these touch.
        let rank = (carrying < state.contact_nodes, sought.distance(state, carrying));
        if nearest.as_ref().is_none_or(|(best, _)| rank <= *best) {
            nearest = Some((rank, solution));
        }
        let nearest_bound = if beyond > 0.0 { high } else { low };
        let mut next = nearest_bound.unwrap_or(x) + change;
        if let (Some(low), Some(high)) = (low, high) {
            let now = [beyond.abs(), high - low];
            if now.iter().zip(halved).any(|(now, then)| *now <= 0.5 * then) {
                (halved, lame) = (now, 0);
            } else {
                lame += 1;
            }
            // Where nothing changes over a range of loads, secants creep. NaN as well.
            if lame >= MOST_LAME || !(next > low && next < high) {
                next = low + 0.5 * (high - low);
            }
            if high - low <= NARROWEST * high.abs().max(1.0) {
                break;
            }
        }
        x = next;
    }
    match (nearest, sought) {
        // Nodes that touch together: the nearest number there is.
        (Some((_, nearest)), Sought::Nodes(_)) if low.is_some() && high.is_some() => Ok(nearest),
        (nearest, _) => Err(Error::NoConvergence {
            residual: nearest.map_or(f64::INFINITY, |((_, distance), _)| distance),
            tolerance: stepper.tolerance(),
            iterations: MOST_STEPS,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{Amplitude, SelfAffine};
    use crate::{Boussinesq, FixedLoadSolver, Grid};

    #[test]
    fn where_nothing_happens_steps_double() {
        for (change, way, expected) in [
            (0.125, [2.0, 2.25], 0.5),
            (-0.125, [2.0, 2.25], -0.5),
            (0.125, [2.25, 2.0], 0.5),
            // No less than what the slope says, and no more than the longest step.
            (1.0, [2.0, 2.25], 1.0),
            (0.125, [2.0, 4.0], LONGEST),
            (-LONGEST, [2.0, 2.0], -LONGEST),
        ] {
            assert_eq!(further(change, way), expected, "{change} {way:?}");
        }
    }

    /// The load to begin with is of the right order: within a step of that of the solution, which is a factor
    /// of 4.5, in whatever units and for few nodes or many.
    #[test]
    fn a_search_begins_near_its_end() -> Result<(), Error> {
        for (side, e_star) in [(1.0, 1.0), (3e-4, 2e11)] {
            let grid = Grid::square(48, side)?;
            let height = Amplitude::RmsHeight(5e-3 * side);
            let surface = SelfAffine::new(0.8, 0.5 * side, 0.1 * side, height, 1)?;
            let kernel = Boussinesq::new(grid, e_star)?;
            let mut solver = FixedLoadSolver::new(&surface, &kernel)?;
            for nodes in [23, 115, 460] {
                let fraction = nodes as f64 / grid.nodes() as f64;
                let solution = solver.solve_target(ContactTarget::AreaFraction(fraction))?;
                let level = solver.clone().into_finest();
                let typical = Sought::Nodes(nodes).typical_load(&level);
                let off = (typical / solution.contact.load).ln();
                assert!(off.abs() < LONGEST, "{nodes} nodes: a factor of e^{off}");
                let sought = Sought::mean_gap(solution.contact.mean_gap, &level)?;
                assert!(
                    (sought.typical_load(&level) / solution.contact.load).ln().abs()
                        < 2.0 * LONGEST
                );
            }
        }
        Ok(())
    }

    /// The slope of a mean gap is that of states close to each other, exactly where there is a stiffness; without one,
    /// and of a number of nodes, what is typical.
    #[test]
    fn slopes_are_those_between_states() -> Result<(), Error> {
        let grid = Grid::square(24, 1.0)?;
        let surface = SelfAffine::new(0.8, 0.5, 0.2, Amplitude::RmsHeight(0.01), 4)?;
        let kernel = Boussinesq::new(grid, 1.0)?;
        let builder = FixedLoadSolver::builder(&surface, &kernel);
        let mut solver = builder.tolerance(1e-11).stiffness(true).build()?;
        let load = 0.01;
        let state = solver.solve(load)?.contact;
        // Of the same contact, on which mean gap and load go in proportion.
        let near = solver.solve(load * (1.0 + 1e-6))?.contact;
        assert_eq!(near.contact_nodes, state.contact_nodes);
        let level = solver.into_finest();
        let sought = Sought::mean_gap(0.5 * state.mean_gap, &level)?;
        let (slope, is_exact) = sought.slope(&state);
        let between = (sought.beyond(&near, near.contact_nodes)
            - sought.beyond(&state, state.contact_nodes))
            / (near.load / state.load).ln();
        // Half of 1e-6 by the logarithm, and errors of 1e-11 over 1e-6 of the load.
        assert!(is_exact && (slope / between - 1.0).abs() < 1e-4);
        let unknown = ContactState { interfacial_stiffness: None, ..state };
        assert!(matches!(sought.slope(&unknown), (typical, false) if typical > 0.0));
        assert_eq!(Sought::Nodes(7).slope(&state), (1.0, false));
        Ok(())
    }
}
