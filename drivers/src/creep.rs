//! Viscoelastic contact under histories that come back to where they were.

use asperity::bed::Bed;
use asperity::creep::{Control, CreepState, Prony, ViscoelasticBed};
use asperity::loading::History;
use asperity::{CreepError, Error, LoadingPath};
use nalgebra::DVector;

use crate::creep_forms;
use crate::dense::Dense;
use crate::draw::Draw;
use crate::instants::{Scale, duration, value};
use crate::kernels;
use crate::problem::Sample;
use crate::refusal::Circumstances;
use crate::verdict::{Tally, Verdict, Violation, ensure};

/// Errors of solutions relative to themselves beyond which nothing is compared.
const WELL_CONDITIONED: f64 = 1e-9;
/// What a bed takes for rounding of a compression is 10⁻¹².
const ROUNDING: f64 = 1e-11;
/// Steps so many times the shortest retardation time may bring out negative pressures, however they are divided.
const LONG: f64 = 100.0;

/// Draws a surface on a half-space, a part of its path, a body, and steps of load or approach in which equal values
/// return. Behind each step the pressures are a contact of the present gaps, which a dense matrix and a memory of each
/// node make of them: no other pressures are. Then loads and approaches over time in closed form, compared with
/// convolutions and with the bed.
///
/// # Errors
///
/// What is wrong.
pub fn creep(bytes: &[u8]) -> Verdict {
    let mut draw = Draw::new(bytes);
    Sample::look(&mut draw, kernels::GROWING, |sample, draw| run(sample, draw))
}

fn run(sample: &Sample, draw: &mut Draw<'_>) -> Verdict {
    let growth = sample.kernel.contact_growth();
    let dense = Dense::new(&sample.kernel, sample.surface.matrix()).in_gauge_of_paths(growth);
    let Circumstances { error, .. } = Circumstances::of(&dense, growth);
    let builder = match draw.once_in(2) {
        true => sample.path().max_nodes(draw.whole(1, dense.nodes())),
        false => sample.path(),
    };
    // It is the driver of paths that asks why.
    let Ok(mut path) = builder.build() else {
        return Ok(Tally::default());
    };
    let Ok(history) = path.by_ref().collect::<Result<History, Error>>() else {
        return Ok(Tally::default());
    };
    let Some((body, unit)) = body(draw)? else {
        return Ok(Tally::refusal());
    };
    let Some([_, inverse]) = dense.norms().filter(|_| error < WELL_CONDITIONED) else {
        return Ok(Tally::refusal());
    };
    let Ok(bed) = Bed::new(&history) else {
        return Ok(Tally::refusal());
    };
    let last = history.states().last().map(|state| state.contact);
    let (load, approach) = last.map_or((0.0, 0.0), |contact| (contact.load, contact.approach));
    // Of a flat surface no load is greater than others.
    let load =
        if load > 0.0 { load } else { sample.kernel.grid().cell_area() / dense.own_pressure(1.0) };
    let approach = if approach > 0.0 { approach } else { 1.0 / dense.own_length(1.0) };
    let scale = Scale { load, approach, time: unit };
    let context = |violation: Violation| violation.during(format!("{body:?}"));
    let mut tally = {
        let contact = ViscoelasticBed::new(&bed, &body)
            .map_err(|error| Violation::new(format!("it was refused: {error}")))?;
        let memory = Memory::new(&body, dense.nodes());
        let mut trial = Trial {
            bed: &bed,
            path: &mut path,
            contact,
            memory,
            dense: &dense,
            error,
            inverse,
            greatest: [0.0; 2],
            rises: true,
        };
        trial.walk(draw, &scale).map_err(context)?
    };
    tally += creep_forms::run(&bed, &body, draw, &scale).map_err(context)?;
    Ok(tally)
}

/// A body and one of its times; `None` if it is none in double precision.
fn body(draw: &mut Draw<'_>) -> Result<Option<(Prony, f64)>, Violation> {
    let decades = draw.one_of(3.0, &[0.5, 8.0]);
    let unit = draw.decades(-9.0, 9.0);
    let mut times: Vec<f64> = Vec::new();
    let mut terms = Vec::new();
    for _ in 0..draw.whole(0, 4) {
        let time = match times.last() {
            Some(&last) if draw.once_in(6) => draw.one_of(last, &[last * (1.0 + 1e-12)]),
            _ => unit * draw.decades(-decades, decades),
        };
        times.push(time);
        terms.push((time, draw.decades(-3.0, 0.0)));
    }
    let sum: f64 = terms.iter().map(|term| term.1).sum();
    let relaxes = draw.one_of(0.5, &[0.9, 0.999, 1.0]);
    let shares: Vec<_> = terms.iter().map(|term| (term.0, term.1 / sum * relaxes)).collect();
    let made = match draw.whole(0, 3) {
        0 | 1 => Prony::shares(&shares),
        2 => Prony::relaxation(if relaxes == 1.0 { 0.0 } else { 1.0 - relaxes }, &shares),
        _ => Prony::creep(1.0, &terms, draw.one_of(0.0, &[1e-3, 1.0]) / unit),
    };
    match made {
        Ok(body) => {
            consistent(&body)?;
            Ok(Some((body, times.first().map_or(unit, |time| *time))))
        }
        Err(Error::OutOfRange { .. } | Error::NotPositive { .. }) => Ok(None),
        Err(error) => Err(Violation::new(format!("{terms:?} was refused: {error}"))),
    }
}

/// `s R̂ · s Ĵ = 1`: both forms are of one body.
fn consistent(body: &Prony) -> Result<(), Violation> {
    let terms = body.relaxation_terms().iter().chain(body.creep_terms());
    for rate in terms.map(|term| 1.0 / term.time).chain([1.0]) {
        for rate in [0.1 * rate, rate, 7.0 * rate] {
            let relaxation = body.relaxation_terms().iter().map(|term| {
                let z = rate * term.time;
                term.amount * z / (1.0 + z)
            });
            let creep = body.creep_terms().iter().map(|t| t.amount / (1.0 + rate * t.time));
            let modulus = body.equilibrium_modulus() + relaxation.sum::<f64>();
            let flow = body.fluidity() / rate;
            let compliance = body.instantaneous_compliance() + creep.sum::<f64>() + flow;
            let product = modulus * compliance;
            ensure!((product - 1.0).abs() < 1e-11, "s R s J is {product} at {rate:e}: {body:?}");
        }
    }
    Ok(())
}

/// What each node remembers of its pressure.
struct Memory {
    body: Prony,
    strains: Vec<DVector<f64>>,
    integral: DVector<f64>,
    pressure: DVector<f64>,
}

impl Memory {
    fn new(body: &Prony, nodes: usize) -> Self {
        let none = DVector::zeros(nodes);
        Self {
            body: body.clone(),
            strains: vec![none.clone(); body.creep_terms().len()],
            integral: none.clone(),
            pressure: none,
        }
    }

    /// The same behind a step in which the pressure goes to this one, linearly.
    fn behind(&self, duration: f64, pressure: DVector<f64>) -> Self {
        let strains = self.body.creep_terms().iter().zip(&self.strains).map(|(term, strain)| {
            let z = duration / term.time;
            // 1 − (1 − e⁻ᶻ)/z loses its digits where z is small: ½ z − z²/6 + …
            let now = match z < 1e-2 {
                true => {
                    z * (0.5 - z * (1.0 / 6.0 - z * (1.0 / 24.0 - z * (1.0 / 120.0 - z / 720.0))))
                }
                false => 1.0 + (-z).exp_m1() / z,
            };
            let keep = (-z).exp();
            strain * keep + &self.pressure * (-(-z).exp_m1() - now) + &pressure * now
        });
        Self {
            body: self.body.clone(),
            strains: strains.collect(),
            integral: &self.integral + (&self.pressure + &pressure) * (0.5 * duration),
            pressure,
        }
    }

    /// ∫ J dp: pressures that displace as much at once.
    fn effective(&self) -> DVector<f64> {
        let mut sum = &self.pressure * self.body.instantaneous_compliance();
        for (term, strain) in self.body.creep_terms().iter().zip(&self.strains) {
            sum += strain * term.amount;
        }
        sum + &self.integral * self.body.fluidity()
    }
}

struct Trial<'a, 'b> {
    bed: &'b Bed<'a>,
    path: &'b mut LoadingPath,
    contact: ViscoelasticBed<'b>,
    memory: Memory,
    dense: &'b Dense,
    /// Error of a solution relative to itself, and the norm of the inverse.
    error: f64,
    inverse: f64,
    /// The greatest effective load and lengths so far: what is left of them has their rounding.
    greatest: [f64; 2],
    /// Whether the approach was prescribed in all steps so far, and never fell.
    rises: bool,
}

impl Trial<'_, '_> {
    fn walk(&mut self, draw: &mut Draw<'_>, scale: &Scale) -> Verdict {
        let mut tally = Tally::default();
        let mut steps: Vec<(f64, Control)> = Vec::new();
        let by_load = draw.one_of(Some(true), &[Some(false), None]);
        // So that creep does not lead beyond the path in no time.
        let part = draw.one_of(1.0, &[0.1, 1e-3]);
        for _ in 0..draw.whole(1, 24) {
            let duration = duration(draw, scale.time, steps.last().map_or(0.0, |step| step.0));
            let is_load = by_load.unwrap_or_else(|| draw.once_in(2));
            let earlier = |draw: &mut Draw<'_>| {
                let of_kind = steps.iter().filter_map(|step| match step.1 {
                    Control::Load(load) if is_load => Some(load),
                    Control::Approach(approach) if !is_load => Some(approach),
                    _ => None,
                });
                let of_kind: Vec<f64> = of_kind.collect();
                let last = of_kind.len().checked_sub(1)?;
                of_kind.get(draw.whole(0, last)).copied()
            };
            let earlier = earlier(draw);
            let state = self.contact.state();
            let control = match is_load {
                true => {
                    let knots = self.bed.loads();
                    let value = value(draw, [earlier.unwrap_or(0.0), state.load], knots);
                    Control::Load(value.unwrap_or_else(|| part * scale.load * draw.unit()).max(0.0))
                }
                false => {
                    let knots = self.bed.approaches();
                    let value = value(draw, [earlier.unwrap_or(0.0), state.approach], knots);
                    let any = |draw: &mut Draw<'_>| scale.approach * draw.between(-0.2, 1.05);
                    Control::Approach(value.unwrap_or_else(|| any(draw)))
                }
            };
            steps.push((duration, control));
            let goes_on = self
                .step(duration, control, &mut tally)
                .map_err(|violation| violation.during(format!("{steps:?}")))?;
            if !goes_on {
                break;
            }
        }
        Ok(tally)
    }

    /// Whether the step was made in one.
    fn step(
        &mut self,
        duration: f64,
        control: Control,
        tally: &mut Tally,
    ) -> Result<bool, Violation> {
        let before = (self.contact.state(), self.pieces()?);
        let state = match self.contact.step(duration, control) {
            Ok(state) => state,
            Err(error) => {
                self.judge(duration, control, &error)?;
                let now = (self.contact.state(), self.pieces()?);
                ensure!(now == before, "{before:?} became {now:?}");
                tally.refused += 1;
                return Ok(true);
            }
        };
        self.check(&before.0, &state, duration, control)?;
        self.rises &= matches!(control, Control::Approach(a) if a >= before.0.approach);
        ensure!(
            !self.rises || state.contact_nodes >= before.0.contact_nodes,
            "contact was lost: {before:?} became {state:?}"
        );
        if self.contact.halvings() > 0 {
            return Ok(false);
        }
        self.compare(&state, duration, tally)?;
        tally.checked += 1;
        Ok(true)
    }

    fn pieces(&self) -> Result<asperity::bed::Superposition, Violation> {
        let pieces = self.contact.pressure(usize::MAX);
        pieces.map_err(|error| Violation::new(format!("no pressure: {error}")))
    }

    /// What needs nothing to compare with.
    fn check(
        &self,
        before: &CreepState,
        state: &CreepState,
        duration: f64,
        control: Control,
    ) -> Result<(), Violation> {
        let asked = match control {
            Control::Load(load) => state.load == load,
            Control::Approach(approach) => state.approach == approach,
        };
        ensure!(asked, "asked for {control:?}: {state:?}");
        ensure!(state.time == before.time + duration, "{duration:e} behind {before:?}: {state:?}");
        let numbers = [state.effective_load, state.load, state.approach, state.mean_gap];
        ensure!(numbers.iter().all(|number| number.is_finite()), "{state:?}");
        ensure!(state.load >= 0.0 && state.effective_load >= 0.0, "{state:?}");
        let unloaded = self.bed.mean_gaps().first().copied().unwrap_or(0.0);
        ensure!(state.mean_gap >= -1e-11 * unloaded, "{state:?}");
        if state.contact_nodes == 0 {
            ensure!(state.load == 0.0 && state.contact_area == 0.0, "{state:?}");
            ensure!(state.contact_area_fraction == 0.0, "{state:?}");
        }
        Ok(())
    }

    /// Whether an error is deserved: increments in contact are compressed in full, so that the effective load, and the
    /// approach, are no less than those of the path with this contact.
    fn judge(&self, duration: f64, control: Control, error: &Error) -> Result<(), Violation> {
        let shortest = self.memory.body.relaxation_terms().first();
        let is_long = shortest.is_some_and(|term| duration > LONG * term.time);
        let deserved = match (error, control) {
            // One that is divided may lead beyond the path on its way.
            (Error::Creep(CreepError::BedEnds { .. }), _) if is_long => true,
            (Error::Creep(CreepError::BedEnds { .. }), Control::Load(load)) => {
                let nodes = self.dense.nodes();
                let before = self.contact.state().load;
                let end = self.dense.own_sum(self.bed.last_load()) * (1.0 - 1e-9);
                // Where it is divided, anywhere on the way.
                (1..=64).map(|part| f64::from(part) / 64.0).any(|part| {
                    let sum = self.dense.own_sum(before + part * (load - before));
                    // As if each node carried its part.
                    let pressure = DVector::from_element(nodes, sum / nodes as f64);
                    self.memory.behind(part * duration, pressure).effective().sum() >= end
                })
            }
            (Error::Creep(CreepError::BedEnds { .. }), Control::Approach(approach)) => {
                let end = self.bed.approaches().last().copied().unwrap_or(0.0);
                approach >= end * (1.0 - 1e-9)
            }
            (Error::Creep(CreepError::StepFails { .. }), _) => is_long,
            _ => false,
        };
        ensure!(deserved, "it was refused: {error}");
        Ok(())
    }

    /// The conditions of contact, with what each node remembers.
    ///
    /// Pressures are those of the path, and gaps in contact as much off as its own: the error of a solution relative to
    /// itself times the lengths that cancel.
    fn compare(
        &mut self,
        state: &CreepState,
        duration: f64,
        tally: &mut Tally,
    ) -> Result<(), Violation> {
        let dense = self.dense;
        let failed = |error: Error| Violation::new(format!("no field: {error}"));
        let field = self.pieces()?.pressure(self.bed, self.path).map_err(failed)?;
        let pressure =
            DVector::from_iterator(field.len(), field.iter().map(|p| dense.own_pressure(*p)));
        let memory = self.memory.behind(duration, pressure);
        let effective = memory.effective();
        let (displacement, lengths) = dense.displace(&effective);
        let (sum, effective_sum) = (memory.pressure.sum(), effective.sum());
        let own = dense.own_length(state.approach) + dense.gauge() * effective_sum;
        let gap = dense.gap() + displacement - DVector::from_element(dense.nodes(), own);
        let lengths = own.abs() + dense.gap().max() + lengths;
        self.greatest = [self.greatest[0].max(effective_sum), self.greatest[1].max(lengths)];
        let [greatest, lengths] = self.greatest;
        let allowed = (16.0 * self.error + ROUNDING) * lengths;
        let of_pressure = self.inverse * allowed / memory.body.instantaneous_compliance();
        let order = self.path.contact_order();
        let mut inside = vec![false; dense.nodes()];
        for &node in order.iter().take(state.contact_nodes) {
            inside[node] = true;
        }
        for (node, &is_inside) in inside.iter().enumerate() {
            let (gap, pressure) = (gap[node], memory.pressure[node]);
            let what = |violation: Violation| {
                violation.during(format!("node {node}, in contact: {is_inside}, {state:?}"))
            };
            tally.not_negative("pressure", pressure, of_pressure).map_err(what)?;
            match is_inside {
                true => tally.close("gap in contact", gap, 0.0, allowed).map_err(what)?,
                false => {
                    tally.not_negative("gap", gap, allowed).map_err(what)?;
                    tally
                        .close("pressure of no contact", pressure, 0.0, of_pressure)
                        .map_err(what)?;
                }
            }
        }
        let nodes = dense.nodes() as f64;
        tally.close("load", dense.own_sum(state.load), sum, nodes * of_pressure)?;
        let found = dense.own_sum(state.effective_load);
        let of_sum = nodes * self.inverse * allowed + 1e-11 * greatest;
        tally.close("effective load", found, effective_sum, of_sum)?;
        tally.close("mean gap", dense.own_length(state.mean_gap), gap.mean(), allowed)?;
        self.memory = memory;
        Ok(())
    }
}
