//! Hereditary integrals of a load that is given by its corners.

use super::exponential_sum::ExponentialSum;
use super::prony::{Prony, PronyTerm};
use super::weights::Weights;

/// A quantity x(t) with corners, and what bodies with a creep function remember of it:
///
/// ```math
/// y(t) = \int J(t - s)\, \mathrm{d}x(s) = j_0 x + \sum_m j_m s_m + \varphi \int x\, \mathrm{d}t, \qquad
/// \tau_m \dot s_m + s_m = x .
/// ```
///
/// The internal variables s and their lags x − s are kept at each corner; between two of them they are in closed form.
/// Both are, since neither can be had from the other without loss of digits: s for y itself, the lag for its rate.
#[derive(Debug, Clone)]
pub(super) struct Hereditary {
    corners: Vec<(f64, f64)>,
    instantaneous: f64,
    terms: Vec<PronyTerm>,
    fluidity: f64,
    /// At corner i those of all terms, from `i * terms.len()` on.
    strains: Vec<f64>,
    lags: Vec<f64>,
    /// ∫ x dt up to each corner.
    integrals: Vec<f64>,
}

/// A time, as that since the last corner before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    pub(super) corner: usize,
    pub(super) since: f64,
}

impl Hereditary {
    /// With the creep function of a body.
    pub(super) fn creep(prony: &Prony, corners: &[(f64, f64)]) -> Self {
        let (instantaneous, terms) = (prony.instantaneous_compliance(), prony.creep_terms());
        Self::new(instantaneous, terms, prony.fluidity(), corners)
    }

    /// The quantity itself, and with [`relaxed`](Self::relaxed) what a body with these terms of relaxation makes of it.
    pub(super) fn relaxation(prony: &Prony, corners: &[(f64, f64)]) -> Self {
        Self::new(prony.equilibrium_modulus(), prony.relaxation_terms(), 0.0, corners)
    }

    fn new(instantaneous: f64, terms: &[PronyTerm], fluidity: f64, corners: &[(f64, f64)]) -> Self {
        let (count, all) = (terms.len(), corners.len());
        let mut made = Self {
            corners: corners.to_vec(),
            instantaneous,
            terms: terms.to_vec(),
            fluidity,
            strains: Vec::with_capacity(count * all),
            lags: Vec::with_capacity(count * all),
            integrals: Vec::with_capacity(all),
        };
        let Some(&(_, first)) = corners.first() else {
            return made;
        };
        made.strains.resize(count, 0.0);
        made.lags.resize(count, first);
        made.integrals.push(0.0);
        for (k, pair) in corners.windows(2).enumerate() {
            let [(start, old), (end, new)] = [pair[0], pair[1]];
            let (duration, change) = (end - start, new - old);
            for (m, term) in terms.iter().enumerate() {
                let (strain, lag) = (made.strains[k * count + m], made.lags[k * count + m]);
                let (strain, lag) = if duration > 0.0 {
                    let w = Weights::of(duration / term.time);
                    let strain = w.keep * strain + w.old * old + w.now * new;
                    (strain, w.keep * lag + w.mean * change)
                } else {
                    (strain, lag + change)
                };
                made.strains.push(strain);
                made.lags.push(lag);
            }
            made.integrals.push(made.integrals[k] + 0.5 * duration * (old + new));
        }
        made
    }

    pub(super) fn corners(&self) -> &[(f64, f64)] {
        &self.corners
    }

    /// The corner before a time, the last one of those at one time; `None` before the first.
    pub(super) fn place(&self, time: f64) -> Option<Place> {
        let corner = self.corners.partition_point(|corner| corner.0 <= time).checked_sub(1)?;
        Some(Place { corner, since: time - self.corners[corner].0 })
    }

    /// How long it is from a corner to the next; infinite from the last.
    pub(super) fn duration(&self, corner: usize) -> f64 {
        match self.corners.get(corner + 1) {
            Some(next) => next.0 - self.corners[corner].0,
            None => f64::INFINITY,
        }
    }

    /// dx/dt behind a corner: 0 behind the last, and at a jump.
    pub(super) fn slope(&self, corner: usize) -> f64 {
        let duration = self.duration(corner);
        if duration > 0.0 && duration < f64::INFINITY {
            (self.corners[corner + 1].1 - self.corners[corner].1) / duration
        } else {
            0.0
        }
    }

    /// By how much x jumps up to this corner: not at all where a corner has a time of its own.
    pub(super) fn jump(&self, corner: usize) -> f64 {
        let (time, value) = self.corners[corner];
        match corner.checked_sub(1).map(|before| self.corners[before]) {
            None => value,
            Some((before, old)) if before == time => value - old,
            Some(_) => 0.0,
        }
    }

    /// By how much y jumps up to this corner.
    pub(super) fn response_to_jump(&self, corner: usize) -> f64 {
        self.instantaneous * self.jump(corner)
    }

    /// x.
    pub(super) fn value(&self, place: Place) -> f64 {
        let (start, end) = (self.corners[place.corner], self.corners.get(place.corner + 1));
        match end {
            Some(end) if end.0 > start.0 => {
                start.1 + (end.1 - start.1) * (place.since / (end.0 - start.0))
            }
            _ => start.1,
        }
    }

    /// y and dy/dt, the rate behind a corner.
    pub(super) fn response(&self, place: Place) -> (f64, f64) {
        let Place { corner, since } = place;
        let (old, new, slope) = (self.corners[corner].1, self.value(place), self.slope(corner));
        let at = corner * self.terms.len();
        let mut value = self.instantaneous * new;
        let mut rate = self.instantaneous * slope;
        for (m, term) in self.terms.iter().enumerate() {
            let w = Weights::of(since / term.time);
            value += term.amount * (w.keep * self.strains[at + m] + w.old * old + w.now * new);
            let lag = w.keep * self.lags[at + m] + w.mean * (new - old);
            rate += term.amount / term.time * lag;
        }
        if self.fluidity > 0.0 {
            let mean = 0.5 * (old + new);
            // Without load for ever is still nothing.
            let flown = if mean > 0.0 { since * mean } else { 0.0 };
            value += self.fluidity * (self.integrals[corner] + flown);
            rate += self.fluidity * new;
        }
        (value, rate)
    }

    /// `∫ R(t − s) dx(s)`, of terms of relaxation.
    pub(super) fn relaxed(&self, place: Place) -> f64 {
        let (old, new) = (self.corners[place.corner].1, self.value(place));
        let at = place.corner * self.terms.len();
        let terms = self.terms.iter().zip(&self.lags[at..]).map(|(term, lag)| {
            let w = Weights::of(place.since / term.time);
            term.amount * (w.keep * lag + w.mean * (new - old))
        });
        self.instantaneous * new + terms.sum::<f64>()
    }

    /// dy/dt behind a corner, as a function of the time since.
    pub(super) fn rate(&self, corner: usize) -> ExponentialSum {
        let (slope, value) = (self.slope(corner), self.corners[corner].1);
        let at = corner * self.terms.len();
        let final_compliance: f64 = self.terms.iter().map(|term| term.amount).sum();
        let lags = self.terms.iter().zip(&self.lags[at..]);
        ExponentialSum {
            constant: (self.instantaneous + final_compliance) * slope + self.fluidity * value,
            linear: self.fluidity * slope,
            terms: lags
                .map(|(term, lag)| (term.amount * (lag / term.time - slope), term.time))
                .collect(),
        }
    }

    /// A time since a corner after which nothing of a held load is left to come but flow: exponentials are 0.
    pub(super) fn long(&self) -> f64 {
        let slowest = self.terms.last().map_or(0.0, |term| term.time);
        (UNDERFLOWS * slowest).min(f64::MAX / 8.0)
    }

    /// An upper bound on the time since a corner, behind which x is held, until y reaches a value; `None` if it never
    /// does.
    pub(super) fn reaches(&self, corner: usize, value: f64) -> Option<f64> {
        let long = self.long();
        if self.response(Place { corner, since: long }).0 >= value {
            return Some(long);
        }
        let flow = self.fluidity * self.corners[corner].1;
        (flow > 0.0).then(|| (long + value / flow).min(f64::MAX / 8.0))
    }
}

/// e⁻⁷⁵⁰ is 0 in double precision.
const UNDERFLOWS: f64 = 750.0;
