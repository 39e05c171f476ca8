//! Any history of the load and of the tangential load.

use nalgebra::DMatrix;

use super::Friction;
use super::state::{SAME_LOAD, SlipState, borne};
use crate::bed::{Bed, BedState, Superposition};
use crate::kernel::Theory;
use crate::{Error, LoadingPath, SlipError};

/// A contact under any history of the load P and the tangential load T, by steps that are linear in both.
///
/// The traction is `q = ∫ λ(s) dp(s)` with a ratio λ between −μ and μ that is constant in pieces of the load s from 0
/// to P. A step changes the pieces at the top: where T changes fast, a piece of ±μ, the slip zone, eats those below it;
/// where P grows and T follows slowly, a piece of the ratio dT/dP comes on top of them; where P falls, the top is cut
/// off (Jäger, *A New Principle in Contact Mechanics*, J. Tribol. 120 (1998) 677; Aleshin, Bou Matar & Van Den Abeele,
/// Int. J. Solids Struct. 60–61 (2015) 84). At constant P this is Masing's rule: loops that close are forgotten.
///
/// A step takes O(log N) for each piece that it ends, of a path of N states.
///
/// ```
/// use asperity::bed::Bed;
/// use asperity::loading::History;
/// use asperity::slip::{Friction, SlipHistory};
/// use asperity::{Boussinesq, Grid, LoadingSolver, SelfAffine};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let half_space = Boussinesq::new(Grid::square(32, 1.25e-3)?, 115e9)?;
/// let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space)
///     .max_load(500.0)
///     .build()?;
/// let history = path.run()?;
/// let bed = Bed::new(&history)?;
///
/// let mut joint = SlipHistory::new(&bed, Friction::new(0.3, 1.2)?);
/// joint.to(400.0, 0.0)?;
/// joint.to(400.0, 60.0)?; // at constant load
/// let loaded = joint.to(300.0, -20.0)?; // both at once
/// println!("{} m, {} J lost so far", loaded.displacement, joint.dissipation());
/// assert!(joint.to(300.0, 91.0).is_err()); // friction bears 90 N
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct SlipHistory<'a> {
    bed: &'a Bed<'a>,
    friction: Friction,
    load: BedState,
    pieces: Vec<Piece>,
    /// What rounding made of T in the last step in both loads: at the greater of them.
    rounding: f64,
    dissipation: f64,
}

/// A piece of one ratio, from a load of the path to the start of the next piece, or to the present load.
#[derive(Debug, Clone, Copy)]
struct Piece {
    start: BedState,
    ratio: f64,
    /// ∫ λ ds, ∫ λ dδ and −∫ λ dḡ over the pieces below.
    below: [f64; 3],
}

impl Piece {
    /// The same integrals up to a state in or at the end of this piece.
    fn up_to(&self, end: &BedState) -> [f64; 3] {
        let start = &self.start;
        let changes =
            [end.load - start.load, end.approach - start.approach, start.mean_gap - end.mean_gap];
        [0, 1, 2].map(|k| self.below[k] + self.ratio * changes[k])
    }
}

/// How a step ends, or a part of one.
struct Part {
    /// The load there.
    load: f64,
    /// The front of the slip zone there.
    front: f64,
}

/// Ratios that differ by less are the same: dT/dP is a quotient of differences.
const SAME_RATIO: f64 = 1e-12;

/// What is left of a step in both loads after a part of it.
fn left(part: f64, load: f64, force: f64) -> (f64, f64) {
    ((1.0 - part) * load, (1.0 - part) * force)
}

/// Where a front stops that would get so far: at the lower end of the piece below it, if it reaches that or nearly
/// does.
fn stop(reach: f64, below: &Piece, load: f64) -> f64 {
    let lowest = below.start.load;
    if reach <= lowest + SAME_LOAD * load { lowest } else { reach }
}

impl<'a> SlipHistory<'a> {
    /// An unloaded contact.
    #[must_use]
    pub fn new(bed: &'a Bed<'a>, friction: Friction) -> Self {
        let load = bed.first();
        Self { bed, friction, load, pieces: Vec::new(), rounding: 0.0, dissipation: 0.0 }
    }

    /// To a load P and a tangential load T \[N\], along a straight line in both; returns the state there.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for what is not finite, and for a negative load;
    /// [`BedError::PathEndsBefore`](crate::BedError::PathEndsBefore) for a load that the path has not reached;
    /// [`SlipError::JointSlides`] for |T| > μP, and [`SlipError::StaysAtLimit`] if |T| = μP all along the step while P
    /// changes: the displacement is unknown then; [`Error::NotHomogeneous`] for a path on layers. The history is as
    /// before after an error.
    pub fn to(&mut self, load: f64, tangential_load: f64) -> Result<SlipState, Error> {
        self.bed.history().layering().check(Theory::Slip)?;
        let target = self.bed.at_load(load)?;
        // What is beyond the last load by rounding is that.
        let load = target.load;
        let before = self.load.load;
        let force = borne(&self.friction, (load, load.max(before)), tangential_load)?;
        // Loads that are computed differ by their rounding, and do not make all stick.
        if (load - before).abs() <= SAME_LOAD * before {
            match load < before {
                true => self.cut(target),
                false => self.load = target,
            }
            self.turn(force)?;
            self.slide_at_limit(force);
            return Ok(self.state());
        }
        let mut change = force - self.force();
        let exact = change / (load - before);
        // Loads have a rounding of their own, which counts where they hardly change.
        let rounding =
            SAME_RATIO.max(4.0 * f64::EPSILON * load.max(before) / (load - before).abs());
        let slope = self.snapped(exact, rounding);
        if slope != exact {
            change = slope * (load - before);
        }
        if self.stays_at_limit(slope) {
            return Err(SlipError::StaysAtLimit { from: before, to: load }.into());
        }
        if load > before {
            self.press(target, slope, change)?;
        } else {
            self.relieve(target, slope, change)?;
        }
        self.rounding = 4.0 * f64::EPSILON * self.friction.coefficient() * load.max(before);
        self.slide_at_limit(force);
        Ok(self.state())
    }

    /// The present state.
    #[must_use]
    pub fn state(&self) -> SlipState {
        let [force, shift, gap] = self.sums();
        let ratio = self.friction.compliance_ratio();
        let values = [force, ratio * shift, ratio * gap];
        let stick = match self.pieces.last() {
            Some(top) if self.is_limit(top.ratio) => &top.start,
            _ => &self.load,
        };
        SlipState::new(self.bed, &self.friction, &self.load, stick, values)
    }

    /// Energy lost so far \[J\]: the work of friction, which never falls.
    #[must_use]
    pub fn dissipation(&self) -> f64 {
        self.dissipation
    }

    /// The traction as a superposition of increments of the path, with the ratios λ as weights.
    ///
    /// # Errors
    ///
    /// None, of a history that was made by this crate.
    pub fn superposition(&self) -> Result<Superposition, Error> {
        let ends = self.pieces.iter().skip(1).map(|piece| piece.start.load);
        let ends = ends.chain([self.load.load]);
        Superposition::new(ends.zip(self.pieces.iter().map(|piece| piece.ratio)))
    }

    /// Tangential elastic energy that is stored \[J\].
    ///
    /// # Errors
    ///
    /// Those of [`Self::superposition`].
    pub fn stored_energy(&self) -> Result<f64, Error> {
        let scalars = self.superposition()?.scalars(self.bed)?;
        Ok(self.friction.compliance_ratio() * scalars.energy)
    }

    /// Traction \[Pa\]: a field of the path for each piece.
    ///
    /// # Errors
    ///
    /// Those of [`Superposition::pressure`].
    pub fn traction(&self, path: &mut LoadingPath) -> Result<DMatrix<f64>, Error> {
        self.superposition()?.pressure(self.bed, path)
    }

    fn sums(&self) -> [f64; 3] {
        self.pieces.last().map_or([0.0; 3], |top| top.up_to(&self.load))
    }

    fn force(&self) -> f64 {
        self.sums()[0]
    }

    /// What rounding makes of T, a sum over pieces of both signs.
    fn rounding_of_force(&self) -> f64 {
        let ends = self.pieces.iter().skip(1).map(|piece| piece.start.load).chain([self.load.load]);
        let forces = self
            .pieces
            .iter()
            .zip(ends)
            .map(|(piece, end)| piece.ratio.abs() * (end - piece.start.load));
        4.0 * f64::EPSILON * forces.sum::<f64>()
    }

    fn is_limit(&self, ratio: f64) -> bool {
        ratio.abs() == self.friction.coefficient()
    }

    /// A slope that is the ratio at the top, or the limit, to rounding.
    fn snapped(&self, slope: f64, rounding: f64) -> f64 {
        let limit = self.friction.coefficient();
        let top = self.pieces.last().map(|piece| piece.ratio);
        let known = top.into_iter().chain([limit, -limit]);
        let mut near = known.filter(|ratio| (slope - ratio).abs() <= rounding * limit);
        near.next().unwrap_or(slope)
    }

    /// Whether friction is at its limit all over the contact now and throughout the step.
    fn stays_at_limit(&self, slope: f64) -> bool {
        let is_limit = self.is_limit(slope);
        match self.pieces.as_slice() {
            // From no load: P and T grow together.
            [] => is_limit,
            [all] => is_limit && slope == all.ratio,
            _ => false,
        }
    }

    /// T to a value at constant load: slip spreads inwards, one piece at a time.
    fn turn(&mut self, force: f64) -> Result<(), Error> {
        let change = force - self.force();
        // Sums at greater loads before have rounding of their own.
        let borne = self.friction.coefficient() * self.load.load;
        let rounding = self.rounding_of_force().max(self.rounding).max(SAME_LOAD * borne);
        if change.abs() <= rounding || self.load.load == 0.0 {
            return Ok(());
        }
        let top = change.signum() * self.friction.coefficient();
        let load = self.load.load;
        loop {
            let change = force - self.force();
            let Some((front, below)) = self.front(top).filter(|_| change * top > 0.0) else {
                return Ok(());
            };
            let reach = front.load - change / (top - below.ratio);
            let end = Part { load, front: stop(reach, &below, load) };
            self.slide(top, &below, &front, end)?;
            if reach > below.start.load - SAME_LOAD * load {
                return Ok(());
            }
        }
    }

    /// The whole contact slips where T is the limit, also what rounding would leave of the stick zone.
    fn slide_at_limit(&mut self, force: f64) {
        let limit = self.friction.coefficient();
        let borne = limit * self.load.load;
        if borne > 0.0 && force.abs() >= borne {
            self.replace(force.signum() * limit, self.bed.first(), self.load);
        }
    }

    /// P grows.
    fn press(&mut self, target: BedState, slope: f64, mut change: f64) -> Result<(), Error> {
        let limit = self.friction.coefficient();
        if slope.abs() <= limit {
            self.push(self.load, slope);
            self.load = target;
            return Ok(());
        }
        // Slip from the edge, and the front recedes. What is left of the step is counted in both loads: where P hardly
        // changes, its digits say nothing of how far the step is.
        let top = slope.signum() * limit;
        let mut rise = target.load - self.load.load;
        while rise > 0.0 {
            let Some((front, below)) = self.front(top) else {
                self.replace(top, self.bed.first(), target);
                return Ok(());
            };
            let way = ((change - top * rise) / (top - below.ratio)).max(0.0);
            let lowest = below.start.load;
            let part = (front.load - lowest) / way;
            let end = if part < 1.0 {
                let load = (self.load.load + part * rise).min(target.load);
                Part { load, front: lowest }
            } else {
                let load = target.load;
                Part { load, front: stop(front.load - way, &below, load) }
            };
            self.slide(top, &below, &front, end)?;
            (rise, change) = if part < 1.0 { left(part, rise, change) } else { (0.0, 0.0) };
        }
        // What has underflowed of the step is added as well.
        self.load = target;
        Ok(())
    }

    /// P falls.
    fn relieve(&mut self, target: BedState, slope: f64, mut change: f64) -> Result<(), Error> {
        let limit = self.friction.coefficient();
        let mut fall = self.load.load - target.load;
        while fall > 0.0 && self.load.load > target.load {
            let Some(last) = self.pieces.last().copied() else {
                self.load = target;
                return Ok(());
            };
            if last.ratio == slope {
                // Unloading retraces: nothing slips.
                let stop = target.load.max(last.start.load);
                let part = if stop > target.load { (self.load.load - stop) / fall } else { 1.0 };
                self.cut(self.bed.at_load(stop)?);
                (fall, change) = left(part, fall, change);
                continue;
            }
            // The present slip zone goes on, unless T falls faster than its limit.
            let goes_on = self.is_limit(last.ratio) && last.ratio * slope <= limit * limit;
            let top = if goes_on { last.ratio } else { limit * (last.ratio - slope).signum() };
            let Some((front, below)) = self.front(top) else {
                self.cut(target);
                return Ok(());
            };
            // How far the front would fall in the rest of the step, and after which parts of it the piece below is
            // eaten, or the load has reached the front, so that the slip zone is gone.
            let way = ((top * fall + change) / (top - below.ratio)).max(0.0);
            let (now, lowest) = (self.load.load, below.start.load);
            let eaten = (front.load - lowest) / way;
            // A zone that has just begun does not end: its front falls at least as fast as the load, but for rounding.
            let ends = way < fall && now > front.load;
            let gone = if ends { (now - front.load) / (fall - way) } else { f64::INFINITY };
            let part = 1.0_f64.min(eaten).min(gone).max(0.0);
            let load = if part < 1.0 { now - part * fall } else { target.load };
            let load = load.clamp(target.load, now);
            let reach = if part == eaten {
                lowest
            } else if part == gone {
                load
            } else {
                stop(front.load - part * way, &below, load)
            };
            self.slide(top, &below, &front, Part { load, front: reach.min(load) })?;
            (fall, change) = left(part, fall, change);
        }
        // A load that has arrived stays where it is, whatever rounding has left of the step, and T goes on.
        if fall > 0.0 {
            let force = self.force() + change;
            self.turn(force)?;
        }
        // What is less than rounding of the step falls as well.
        if self.load.load > target.load {
            self.cut(target);
        }
        Ok(())
    }

    /// The front of a slip zone of the ratio `top`, and the piece below it; `None` if the zone is the whole contact.
    fn front(&self, top: f64) -> Option<(BedState, Piece)> {
        let (last, others) = self.pieces.split_last()?;
        if last.ratio == top {
            return others.last().map(|below| (last.start, *below));
        }
        Some((self.load, *last))
    }

    /// A part of a step in which the front of the slip zone moves through one piece.
    fn slide(&mut self, top: f64, below: &Piece, front: &BedState, end: Part) -> Result<(), Error> {
        let load = self.bed.at_load(end.load)?;
        let reached = self.bed.at_load(end.front)?;
        let work = friction_work(self.bed, [&self.load, &load], [front, &reached]);
        let scale = self.friction.displacement_per_approach() * (top - below.ratio).abs();
        self.dissipation += scale * work;
        self.replace(top, reached, load);
        Ok(())
    }

    /// One ratio from `start` to `load`, in place of all that lies beyond `start`.
    fn replace(&mut self, top: f64, start: BedState, load: BedState) {
        self.cut(start);
        if load.load > start.load {
            self.push(start, top);
        }
        self.load = load;
    }

    /// Takes off what lies beyond a load, which becomes the present one.
    fn cut(&mut self, load: BedState) {
        while self.pieces.last().is_some_and(|piece| piece.start.load >= load.load) {
            self.pieces.pop();
        }
        self.load = load;
    }

    /// A piece on top of the others, which end at its start.
    fn push(&mut self, start: BedState, ratio: f64) {
        match self.pieces.last() {
            Some(last) if last.ratio == ratio => (),
            Some(last) => self.pieces.push(Piece { start, ratio, below: last.up_to(&start) }),
            None => self.pieces.push(Piece { start, ratio, below: [0.0; 3] }),
        }
    }
}

/// Σ p r₂ ΔA dδ(s) over the way of a front, from s₀ down to s₁ while the load goes from P₀ to P₁ in proportion:
/// ```math
/// \int_{s_1}^{s_0} \left[ (P - s)\, \mathrm{d}\delta(s) - (\delta(P) - \delta(s))\, \mathrm{d}s \right] \ge 0
/// ```
/// times κ|Δλ| and the coefficient it is the work of friction: nodes beyond the front slip by κ|Δλ| r₂ dδ under μp.
fn friction_work(bed: &Bed, [p0, p1]: [&BedState; 2], [s0, s1]: [&BedState; 2]) -> f64 {
    let (loads, approaches) = (s0.load - s1.load, s0.approach - s1.approach);
    if loads <= 0.0 {
        return 0.0;
    }
    let fixed = (p0.load - s0.load) * approaches - (p0.approach - s0.approach) * loads;
    let above = before_end(bed, s1, s0);
    let under = loads * approaches - above;
    // P(s) moves: dP/ds = change/(s₁ − s₀).
    let change = p1.load - p0.load;
    let moving = if change == 0.0 {
        0.0
    } else {
        let [low, high] = if change < 0.0 { [p1, p0] } else { [p0, p1] };
        let all = (high.load - low.load) * (high.approach - low.approach);
        let below_end = before_end(bed, low, high);
        let carried = if change < 0.0 { all - below_end } else { below_end };
        change / loads * above - carried * (loads / change)
    };
    (fixed + above - under + moving).max(0.0)
}

/// ∫ (s₁ − s) dδ(s) from s₀ up to s₁: over a few intervals as a sum of positive terms, over many by the energy ∫ s dδ, of
/// which rounding leaves less than there is of so small a step.
fn before_end(bed: &Bed, start: &BedState, end: &BedState) -> f64 {
    let (mut sum, mut before, mut next) = (0.0, (start.load, start.approach), start.interval + 1);
    for _ in 0..=FEW_KNOTS {
        let is_end = next > end.interval;
        let knot = if is_end {
            (end.load, end.approach)
        } else {
            // Nodes that touch together are one knot: the step may be as small as those of a few.
            let last = bed.loads().partition_point(|load| *load <= bed.loads()[next]) - 1;
            next = last + 1;
            (bed.loads()[last], bed.approaches()[last])
        };
        let left = (end.load - before.0) + (end.load - knot.0);
        sum += 0.5 * left * (knot.1 - before.1);
        if is_end {
            return sum.max(0.0);
        }
        before = knot;
    }
    let (loads, approaches) = (end.load - start.load, end.approach - start.approach);
    let rest = end.load * approaches - (end.energy - start.energy);
    rest.clamp(0.0, (loads * approaches).max(0.0))
}

/// Intervals that are summed one by one.
const FEW_KNOTS: usize = 16;
