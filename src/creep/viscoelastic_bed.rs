//! The bed of a path stepped in time: any history of load or approach.

use nalgebra::DMatrix;

use super::prony::Prony;
use super::state::{CreepState, area_from, in_pieces};
use super::weights::Weights;
use crate::bed::{Bed, Superposition};
use crate::kernel::Theory;
use crate::{CreepError, Error, LoadingPath};

/// What a step of a bed leads to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Control {
    /// This load \[N\].
    Load(f64),
    /// This approach \[m\]; where it is less than what the surface has kept of its dent, the surfaces are apart. In
    /// full contact of a periodic half-space, whose mean planes come no closer, any more load has it: the least is
    /// taken.
    Approach(f64),
}

/// The contact of viscoelastic bodies under any history, receding and returning contact included, in steps of time.
///
/// Each increment of the path, from one knot to the next, is an element with a stress φ and a compression ψ of its own,
/// `ψ = E* ∫ J dφ`. The contact is a prefix of the elements: they are compressed in full, ψ = 1 and φ ≥ 0; those behind
/// the front are free, φ = 0, and recover, ψ ≤ 1. The load ∫ φ dW or the approach ∫ ψ dδ says where the front is. So
/// nodes leave the contact in the reverse of the order in which they came, and come back in it, whatever the history.
///
/// Stresses are linear in each step. With that, each step fulfils all conditions of contact to rounding; with shorter
/// steps the error falls by the square of their length. A step that is far too long, some thousand of the shortest
/// relaxation times, may bring out negative pressures; it is then halved.
///
/// A step takes O(N M) for the N elements that have ever carried load, and M terms of creep.
///
/// ```
/// use asperity::bed::Bed;
/// use asperity::creep::{Control, Prony, ViscoelasticBed};
/// use asperity::{Boussinesq, Grid, LoadingSolver, SelfAffine};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let half_space = Boussinesq::new(Grid::square(32, 1.25e-3)?, 115e9)?;
/// let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space).max_load(900.0).build()?;
/// let history = path.run()?;
/// let bed = Bed::new(&history)?;
/// let mut contact = ViscoelasticBed::new(&bed, &Prony::shares(&[(1.0, 0.5)])?)?;
/// let pressed = contact.step(0.0, Control::Load(400.0))?;
/// for _ in 0..50 {
///     contact.step(0.1, Control::Load(400.0))?;
/// }
/// let lifted = contact.step(0.0, Control::Load(100.0))?;
/// // Less load, and yet more contact than a quarter of it had at first.
/// assert!(lifted.contact_nodes < pressed.contact_nodes);
/// assert!(lifted.contact_area > bed.at_load(100.0)?.contact_area);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct ViscoelasticBed<'a> {
    bed: &'a Bed<'a>,
    prony: Prony,
    elements: Vec<Element>,
    /// Loads of the elements \[N\], of the first so many that have ever carried any.
    forces: Vec<f64>,
    /// Internal variables, those of all terms of an element together.
    strains: Vec<f64>,
    /// ∫ force dt, of a body that flows.
    integrals: Vec<f64>,
    state: CreepState,
    /// What is needed in a step, kept to allocate nothing.
    history: Vec<f64>,
    halvings: usize,
    steps: usize,
}

/// One increment of the path.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Element {
    /// The knot before.
    knot: usize,
    /// Load of the path before \[N\].
    start: f64,
    /// Load from the knot before to the knot after \[N\]; infinite behind full contact.
    length: f64,
    /// Approach for each newton of it \[m/N\].
    approach: f64,
    /// By how much the mean gap closes for each newton of it \[m/N\].
    closes: f64,
}

/// The factors of a step: `ψ = slope φ + history`.
struct Step {
    duration: f64,
    weights: Vec<Weights>,
    slope: f64,
}

/// Where the front is after a step.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Front {
    /// The element that is compressed in part.
    element: usize,
    /// Its load.
    force: f64,
    /// By how much the surfaces are apart.
    separation: f64,
}

impl<'a> ViscoelasticBed<'a> {
    /// With the bed of a path, and the modulus [relative to](Prony::relative_to) the E\* of that path: at first touch,
    /// at t = 0.
    ///
    /// # Errors
    ///
    /// Those of [`Bed::at_load`]; [`Error::NotHomogeneous`] for a path on layers of several materials.
    pub fn new(bed: &'a Bed<'a>, prony: &Prony) -> Result<Self, Error> {
        bed.history().layering().check(Theory::Creep)?;
        let touched = bed.at_load(0.0)?;
        Ok(Self {
            bed,
            prony: prony.clone(),
            elements: elements(bed),
            forces: Vec::new(),
            strains: Vec::new(),
            integrals: Vec::new(),
            state: CreepState::of_path(bed, &touched, 0.0, 0.0),
            history: Vec::new(),
            halvings: 0,
            steps: 0,
        })
    }

    /// The present state.
    #[must_use]
    pub fn state(&self) -> CreepState {
        self.state
    }

    /// How often a step was halved because pressures would have been negative.
    #[must_use]
    pub fn halvings(&self) -> usize {
        self.halvings
    }

    /// Takes up a history of load or approach at its beginning, of a bed that has made no step yet.
    pub(super) fn begin_at(&mut self, time: f64) -> bool {
        let is_new = self.steps == 0;
        if is_new {
            self.state.time = time;
        }
        is_new
    }

    /// Gives the present state a time that it has but for rounding.
    pub(super) fn set_time(&mut self, time: f64) -> CreepState {
        self.state.time = time;
        self.state
    }

    /// The terms of creep and relaxation that the steps are made for.
    pub(super) fn prony(&self) -> &Prony {
        &self.prony
    }

    /// The internal variables, those of all terms of an element together.
    pub(super) fn strains(&self) -> &[f64] {
        &self.strains
    }

    /// Takes each internal variable as many times as far from what it was `before` as its term says, under the present
    /// load; not where pressures would become negative.
    pub(super) fn go_ahead(&mut self, before: &[f64], times: &[f64]) {
        let present = self.memory();
        let earlier = before.iter().copied().chain(std::iter::repeat(0.0));
        for ((strain, before), times) in
            self.strains.iter_mut().zip(earlier).zip(times.iter().cycle())
        {
            *strain += (times - 1.0) * (*strain - before);
        }
        if !matches!(self.attempt(0.0, Control::Load(present.state.load)), Ok(true)) {
            self.restore(present);
        }
    }

    /// In the time `duration` \[s\] to a load or an approach; in no time at all it is a jump. Returns the state there.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a duration that is negative or not finite, a negative load, and an approach that is
    /// not finite; [`CreepError::BedEnds`] if the path does not reach as far; [`CreepError::StepFails`]. The present
    /// state then stays.
    pub fn step(&mut self, duration: f64, control: Control) -> Result<CreepState, Error> {
        let is_so = duration >= 0.0 && duration.is_finite();
        Error::require("duration of a step", duration, is_so, "at least 0 and finite")?;
        match control {
            Control::Load(load) => {
                let is_so = load >= 0.0 && load.is_finite();
                Error::require("load of a step", load, is_so, "at least 0 and finite")?;
            }
            Control::Approach(approach) => {
                Error::require("approach of a step", approach, approach.is_finite(), "finite")?;
            }
        }
        if !self.attempt(duration, control)? {
            let before = self.memory();
            self.in_parts(duration, control).inspect_err(|_| self.restore(before))?;
        }
        self.steps += 1;
        Ok(self.state)
    }

    /// The present pressure, as increments of the path with their stresses: see
    /// [`Creep::pressure`](super::Creep::pressure).
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] without pieces.
    pub fn pressure(&self, pieces: usize) -> Result<Superposition, Error> {
        in_pieces(&self.weights(|k, length| self.forces[k] / length), pieces)
    }

    /// The present compression of each increment, ψ, as its weight: the displacement of the surface is made of it
    /// ([`Superposition::displacement`]), and with the initial gap and the approach its gap.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] without pieces.
    pub fn compression(&self, pieces: usize) -> Result<Superposition, Error> {
        in_pieces(&self.weights(|k, length| self.present_compression(k) / length), pieces)
    }

    /// The present gap \[m\], `g = g₀ + ∫ ψ du − δ` with the initial gap g₀ and the present
    /// [compression](Self::compression) ψ, in pieces. Nodes in contact have none, and where the pieces would overlap
    /// there is none either.
    ///
    /// `path` is that of the bed: it gives a field for each piece.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] without pieces, and those of [`Superposition::displacement`].
    pub fn gap(&self, pieces: usize, path: &mut LoadingPath) -> Result<DMatrix<f64>, Error> {
        let mut gap = self.compression(pieces)?.displacement(self.bed, path)?;
        for (value, initial) in gap.iter_mut().zip(path.problem().initial_gap()) {
            *value = (initial + *value - self.state.approach).max(0.0);
        }
        for event in self.bed.history().events().iter().take(self.state.contact_nodes) {
            if let Some(value) = gap.get_mut(event.node) {
                *value = 0.0;
            }
        }
        Ok(gap)
    }

    fn weights(&self, of: impl Fn(usize, f64) -> f64) -> Vec<(f64, f64)> {
        let elements = self.elements.iter().take(self.forces.len()).enumerate();
        let weights = elements.map(|(k, element)| {
            let length = if element.length.is_finite() {
                element.length
            } else {
                // Behind full contact as much as it carries or is compressed.
                self.present_compression(k).max(self.forces[k]).max(f64::MIN_POSITIVE)
            };
            (element.start + length, of(k, length))
        });
        weights.collect()
    }

    /// Compression of an element, in newtons of the elastic path.
    fn present_compression(&self, element: usize) -> f64 {
        let terms = self.prony.creep_terms();
        let strains = &self.strains[element * terms.len()..];
        let creep = terms.iter().zip(strains).map(|(term, strain)| term.amount * strain);
        self.prony.instantaneous_compliance() * self.forces[element]
            + creep.sum::<f64>()
            + self.prony.fluidity() * self.integrals[element]
    }

    /// The step in parts, each half as long as it was where pressures would be negative.
    fn in_parts(&mut self, duration: f64, control: Control) -> Result<(), Error> {
        let start = self.state;
        let (from, to) = match control {
            Control::Load(load) => (start.load, load),
            Control::Approach(approach) => (start.approach, approach),
        };
        // Parts that are left to do, the next one last, each as two fractions of the step.
        let mut left = vec![(0.0, 1.0)];
        let mut parts = 0;
        while let Some((begin, end)) = left.pop() {
            parts += 1;
            let middle: f64 = 0.5 * (begin + end);
            let value = from + end * (to - from);
            let control = match control {
                _ if end == 1.0 => control,
                Control::Load(_) => Control::Load(value),
                Control::Approach(_) => Control::Approach(value),
            };
            if parts > 1 && self.attempt((end - begin) * duration, control)? {
                continue;
            }
            if parts > MOST_PARTS || middle <= begin || middle >= end {
                let step = (end - begin) * duration;
                return Err(CreepError::StepFails { time: self.state.time, step }.into());
            }
            self.halvings += 1;
            left.push((middle, end));
            left.push((begin, middle));
        }
        self.state.time = start.time + duration;
        Ok(())
    }

    /// Makes the step if no pressure becomes negative by it, and no contact is lost to an approach that does not fall.
    /// Returns whether it has.
    fn attempt(&mut self, duration: f64, control: Control) -> Result<bool, Error> {
        let step = self.prepare(duration);
        let time = self.state.time + duration;
        // What is as much as rounding of the compression is none.
        let is_sound = self
            .elements
            .iter()
            .zip(&self.history)
            .all(|(element, history)| element.length - history >= -ROUNDING * element.length);
        if !is_sound {
            return Ok(false);
        }
        let front = match control {
            Control::Load(load) => self.front_of_load(&step, load),
            Control::Approach(approach) => self.front_of_approach(&step, approach),
        };
        let path_ends = self.bed.last_load();
        let front = front.ok_or(CreepError::BedEnds { time, path_ends })?;
        let falls = match control {
            Control::Load(_) => true,
            Control::Approach(approach) => approach < self.state.approach,
        };
        if front.separation > 0.0 && !falls && self.state.contact_nodes > 0 {
            return Ok(false);
        }
        self.commit(&step, time, control, front);
        Ok(true)
    }

    /// The compression of each element by what it has borne before, if it bears nothing at the end of the step.
    fn prepare(&mut self, duration: f64) -> Step {
        let (terms, flow) = (self.prony.creep_terms(), 0.5 * duration * self.prony.fluidity());
        let weights: Vec<Weights> = terms.iter().map(|t| Weights::of(duration / t.time)).collect();
        let count = terms.len();
        self.history.clear();
        self.history.extend(self.forces.iter().enumerate().map(|(k, force)| {
            let strains = &self.strains[k * count..(k + 1) * count];
            let creep = terms.iter().zip(&weights).zip(strains);
            let creep = creep.map(|((t, w), strain)| t.amount * (w.keep * strain + w.old * force));
            creep.sum::<f64>() + self.prony.fluidity() * self.integrals[k] + flow * force
        }));
        let now = terms.iter().zip(&weights).map(|(term, w)| term.amount * w.now);
        let slope = self.prony.instantaneous_compliance() + now.sum::<f64>() + flow;
        Step { duration, weights, slope }
    }

    /// The load of an element that is compressed in full.
    fn full(&self, step: &Step, element: usize) -> f64 {
        let history = self.history.get(element).copied().unwrap_or(0.0);
        ((self.elements[element].length - history) / step.slope).max(0.0)
    }

    /// How many elements have a length: all but that behind full contact.
    fn bounded(&self) -> usize {
        self.elements.partition_point(|element| element.length.is_finite())
    }

    fn front_of_load(&self, step: &Step, load: f64) -> Option<Front> {
        if load == 0.0 {
            return Some(Front { element: 0, force: 0.0, separation: 0.0 });
        }
        let mut left = load;
        let known = self.forces.len();
        for element in 0..known {
            let full = self.full(step, element);
            if left < full - ROUNDING * load {
                return Some(Front { element, force: left, separation: 0.0 });
            }
            // At a knot, but for rounding, the next element has begun.
            left = (left - full).max(0.0);
        }
        // All elements bear what they can, and by rounding the load is a little more.
        if let Some(element) = known.checked_sub(1)
            && known == self.elements.len()
            && left <= ROUNDING * load
        {
            return Some(Front { element, force: self.full(step, element), separation: 0.0 });
        }
        // The others have borne nothing yet: they are those of the path.
        let start = self.elements.get(known).map_or(f64::INFINITY, |element| element.start);
        let label = start + left * step.slope;
        let after = self.elements.partition_point(|element| element.start <= label);
        let element = after.checked_sub(1).filter(|element| *element >= known)?;
        let force = (label - self.elements[element].start) / step.slope;
        let most = self.elements[element].length / step.slope;
        let is_within = force <= most + ROUNDING * load;
        is_within.then_some(Front { element, force: force.min(most), separation: 0.0 })
    }

    fn front_of_approach(&self, step: &Step, approach: f64) -> Option<Front> {
        let kept = self.elements.iter().zip(&self.history);
        let kept: f64 = kept.map(|(element, history)| element.approach * history).sum();
        let mut left = approach - kept;
        if left < -ROUNDING * approach.abs() {
            return Some(Front { element: 0, force: 0.0, separation: -left });
        }
        // A body that has flowed to the approach at which it is held keeps its dent, and no load is left.
        left = left.max(0.0);
        // In full contact of a periodic half-space mean planes cannot approach: the load is then the least there is.
        let bounded = self.bounded();
        let is_rigid = self.elements.get(bounded).is_some_and(|element| element.approach == 0.0);
        let end = if is_rigid { bounded } else { self.elements.len() };
        let known = self.forces.len();
        for element in 0..known.min(end) {
            let closes = self.elements[element].approach * step.slope * self.full(step, element);
            if left < closes - ROUNDING * approach.abs() {
                let force = left / self.elements[element].approach / step.slope;
                return Some(Front { element, force, separation: 0.0 });
            }
            left = (left - closes).max(0.0);
        }
        // All elements are compressed in full, and by rounding the approach is a little more.
        if known >= end && left <= ROUNDING * approach.abs() {
            let element = if is_rigid { end } else { end.checked_sub(1)? };
            let force = if is_rigid { 0.0 } else { self.full(step, element) };
            return Some(Front { element, force, separation: 0.0 });
        }
        // The others have borne nothing yet: they are those of the path.
        let approaches = self.bed.approaches();
        let label = approaches[self.elements.get(known)?.knot] + left;
        let after = self.elements.partition_point(|element| approaches[element.knot] <= label);
        let element = after.checked_sub(1).filter(|element| *element >= known)?;
        let Element { knot, length, approach, .. } = self.elements[element];
        let beyond = label - approaches[knot];
        let (reach, compression) = match approach > 0.0 {
            true => (length * approach, (beyond / approach).min(length)),
            false => (0.0, 0.0),
        };
        let force = compression / step.slope;
        let is_within = beyond <= reach + ROUNDING * label && beyond.is_finite();
        (is_within && force.is_finite()).then_some(Front { element, force, separation: 0.0 })
    }

    fn commit(&mut self, step: &Step, time: f64, control: Control, front: Front) {
        let count = step.weights.len();
        let carries = front.element + usize::from(front.force > 0.0);
        let known = self.forces.len().max(carries);
        self.forces.resize(known, 0.0);
        self.history.resize(known, 0.0);
        self.integrals.resize(known, 0.0);
        self.strains.resize(known * count, 0.0);
        let mut sums = (0.0, 0.0, 0.0, 0.0);
        for k in 0..known {
            let old = self.forces[k];
            let new = match k.cmp(&front.element) {
                std::cmp::Ordering::Less => self.full(step, k),
                std::cmp::Ordering::Equal => front.force,
                std::cmp::Ordering::Greater => 0.0,
            };
            let element = self.elements[k];
            // In full contact exactly what it is, however it rounds.
            let compression =
                if k < front.element { element.length } else { step.slope * new + self.history[k] };
            for (w, strain) in
                step.weights.iter().zip(&mut self.strains[k * count..(k + 1) * count])
            {
                *strain = w.keep * *strain + w.old * old + w.now * new;
            }
            self.integrals[k] += 0.5 * step.duration * (old + new);
            self.forces[k] = new;
            sums.0 += new;
            sums.1 += compression;
            sums.2 += compression * element.approach;
            sums.3 += compression * element.closes;
        }
        let (sum, effective_load, kept, closed) = sums;
        let separation = front.separation;
        let is_apart = separation > 0.0;
        let knot = match self.elements.get(front.element) {
            // The last nodes touch at the end of the path, where nothing need follow on which the front could begin.
            Some(_) if self.is_at_end(step, control, &front) => self.bed.loads().len() - 1,
            element => element.map_or(0, |element| element.knot),
        };
        let (contact_nodes, contact_area, contact_area_fraction) =
            if is_apart { (0, 0.0, 0.0) } else { area_from(self.bed, knot) };
        let unloaded = self.bed.mean_gaps().first().copied().unwrap_or(0.0);
        self.state = CreepState {
            time,
            effective_load,
            load: match control {
                Control::Load(load) => load,
                Control::Approach(_) => sum,
            },
            approach: match control {
                Control::Load(_) => kept,
                Control::Approach(approach) => approach,
            },
            contact_nodes,
            contact_area,
            contact_area_fraction,
            mean_gap: unloaded - closed + separation,
        };
    }

    /// Whether all elements that have a length are compressed in full, but for rounding of what is prescribed.
    fn is_at_end(&self, step: &Step, control: Control, front: &Front) -> bool {
        let (prescribed, of_approach) = match control {
            Control::Load(load) => (load, false),
            Control::Approach(approach) => (approach.abs(), true),
        };
        let mut missing = 0.0;
        for k in front.element..self.bounded() {
            let carried = if k == front.element { front.force } else { 0.0 };
            let force = self.full(step, k) - carried;
            let compression = self.elements[k].approach * step.slope;
            missing += if of_approach { compression * force } else { force };
            if missing > ROUNDING * prescribed {
                return false;
            }
        }
        prescribed > 0.0
    }

    fn memory(&self) -> Memory {
        Memory {
            forces: self.forces.clone(),
            strains: self.strains.clone(),
            integrals: self.integrals.clone(),
            state: self.state,
        }
    }

    fn restore(&mut self, before: Memory) {
        self.forces = before.forces;
        self.strains = before.strains;
        self.integrals = before.integrals;
        self.state = before.state;
    }
}

/// What a bed remembers.
struct Memory {
    forces: Vec<f64>,
    strains: Vec<f64>,
    integrals: Vec<f64>,
    state: CreepState,
}

/// The increments of a path: knots of one load have none between them.
fn elements(bed: &Bed) -> Vec<Element> {
    let (loads, approaches, gaps) = (bed.loads(), bed.approaches(), bed.mean_gaps());
    let mut elements: Vec<Element> = (1..loads.len())
        .filter(|&k| loads[k] > loads[k - 1])
        .map(|k| {
            let length = loads[k] - loads[k - 1];
            Element {
                knot: k - 1,
                start: loads[k - 1],
                length,
                approach: (approaches[k] - approaches[k - 1]) / length,
                closes: (gaps[k - 1] - gaps[k]) / length,
            }
        })
        .collect();
    if let (true, Some(knot)) = (bed.is_full(), loads.len().checked_sub(1)) {
        elements.push(Element {
            knot,
            start: loads[knot],
            length: f64::INFINITY,
            approach: 1.0 / bed.stiffnesses()[knot],
            closes: 0.0,
        });
    }
    elements
}

/// A compression is a sum of some positive numbers up to 1, which have been renewed in every step.
const ROUNDING: f64 = 1e-12;
/// Parts of a step: then it is far longer than is of use.
const MOST_PARTS: usize = 20_000;
