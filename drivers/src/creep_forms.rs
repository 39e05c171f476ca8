//! Viscoelastic contact in closed form, compared with convolutions term by term and with the bed.

use asperity::bed::Bed;
use asperity::creep::{
    ControlHistory, Creep, PiecewiseLinear, Prony, Relaxation, Unloading, ViscoelasticBed,
};
use asperity::{BedError, CreepError, Error};

use crate::draw::Draw;
use crate::instants::{Scale, duration, value};
use crate::verdict::{Tally, Verdict, Violation, ensure};

/// Rounding of convolutions of some corners and terms, and what counts as that of the last knot is 10⁻¹².
const ROUNDING: f64 = 1e-11;

/// A load and an approach over time, with jumps, holds and corners that come back.
pub(crate) fn run(bed: &Bed<'_>, body: &Prony, draw: &mut Draw<'_>, scale: &Scale) -> Verdict {
    let part = draw.one_of(0.3, &[0.01, 1.0]);
    let load = course(draw, scale.time, part * scale.load, bed.loads())?;
    let rising = draw.once_in(2);
    let approach = course(draw, scale.time, scale.approach, bed.approaches())?;
    let mut tally = Tally::default();
    if let Some(load) = load {
        let load = if rising { sorted(&load) } else { Some(load) };
        if let Some(load) = load {
            tally += creep(bed, body, &load, draw)
                .map_err(|violation| violation.during(format!("load {:?}", load.corners())))?;
        }
    }
    // An approach that falls is refused from there on.
    if let Some(approach) = approach.and_then(|approach| sorted(&approach)) {
        tally += relaxation(bed, body, &approach, draw)
            .map_err(|violation| violation.during(format!("approach {:?}", approach.corners())))?;
    }
    Ok(tally)
}

/// Corners; `None` if they are too close in time for double precision.
fn course(
    draw: &mut Draw<'_>,
    unit: f64,
    scale: f64,
    knots: &[f64],
) -> Result<Option<PiecewiseLinear>, Violation> {
    let mut corners: Vec<(f64, f64)> = Vec::new();
    let (mut now, mut last) = (unit * draw.one_of(0.0, &[1.0, -3.0]), 0.0);
    for _ in 0..draw.whole(1, 8) {
        last = duration(draw, unit, last);
        now += last;
        let earlier = match corners.len() {
            0 => 0.0,
            count => corners[draw.whole(0, count - 1)].1,
        };
        let present = corners.last().map_or(0.0, |corner| corner.1);
        let value = value(draw, [earlier, present], knots);
        let value = value.unwrap_or_else(|| scale * draw.unit()).max(0.0);
        corners.push((now, value));
    }
    match PiecewiseLinear::new(corners.iter().copied()) {
        Ok(course) => Ok(Some(course)),
        Err(Error::OutOfRange { .. }) => Ok(None),
        Err(error) => Err(Violation::new(format!("{corners:?} was refused: {error}"))),
    }
}

/// The same times with values that do not fall.
fn sorted(course: &PiecewiseLinear) -> Option<PiecewiseLinear> {
    let mut values: Vec<f64> = course.corners().iter().map(|corner| corner.1).collect();
    values.sort_by(f64::total_cmp);
    let corners = course.corners().iter().zip(values).map(|(corner, value)| (corner.0, value));
    PiecewiseLinear::new(corners).ok()
}

/// Times at and between corners, and behind them.
fn times(course: &PiecewiseLinear, body: &Prony, draw: &mut Draw<'_>) -> Vec<f64> {
    let corners = course.corners();
    let mut times: Vec<f64> = corners.iter().map(|corner| corner.0).collect();
    let between = corners
        .windows(2)
        .flat_map(|pair| [1e-3, 0.3, 0.99].map(|part| pair[0].0 + part * (pair[1].0 - pair[0].0)));
    times.extend(between);
    let end = course.end();
    let terms = body.creep_terms().iter().map(|term| term.time);
    times.extend(terms.flat_map(|time| [end + 0.1 * time, end + time, end + 10.0 * time]));
    times.push(end + draw.unit());
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

/// Pieces of a quantity: the time and value at the beginning, and those at the end; equal times are a jump.
type Piece = [(f64, f64); 2];

fn pieces(course: &PiecewiseLinear) -> Vec<Piece> {
    let mut before = course.corners().first().map_or((0.0, 0.0), |corner| (corner.0, 0.0));
    let pieces =
        course.corners().iter().map(|&corner| [std::mem::replace(&mut before, corner), corner]);
    pieces.collect()
}

/// `∫ f(t − s) dx(s)` of a constant, exponentials `a e^(−t/τ)` and a flow.
fn convolve(pieces: &[Piece], time: f64, constant: f64, terms: &[(f64, f64)], flow: f64) -> f64 {
    let mut sum = 0.0;
    for &[(start, from), (end, to)] in pieces.iter().filter(|piece| piece[0].0 <= time) {
        if end == start {
            let since = time - start;
            let faded = terms.iter().map(|(time, amount)| amount * (-since / time).exp());
            sum += (to - from) * (constant + faded.sum::<f64>() + flow * since);
            continue;
        }
        let until = end.min(time);
        let (length, left) = (until - start, time - until);
        let slope = (to - from) / (end - start);
        let faded = terms.iter().map(|(time, amount)| {
            amount * time * (-left / time).exp() * -(-length / time).exp_m1()
        });
        sum += slope * (constant * length + faded.sum::<f64>());
        sum += slope * flow * length * (left + 0.5 * length);
    }
    sum
}

/// The effective load, and what it may be off by.
fn effective(body: &Prony, pieces: &[Piece], time: f64) -> (f64, f64) {
    let terms = body.creep_terms();
    let fading: Vec<(f64, f64)> = terms.iter().map(|term| (term.time, -term.amount)).collect();
    let all: f64 = terms.iter().map(|term| term.amount).sum();
    let constant = body.instantaneous_compliance() + all;
    let greatest = pieces.iter().fold(0.0_f64, |most, piece| most.max(piece[1].1));
    let start = pieces.first().map_or(0.0, |piece| piece[0].0);
    let flown = body.fluidity() * (time - start).max(0.0);
    // Times that are rounded, over the shortest one of the body.
    let shortest = terms.first().map_or(f64::INFINITY, |term| term.time);
    let late = 16.0 * f64::EPSILON * start.abs().max(time.abs()) / shortest;
    let allowed = (ROUNDING + late) * greatest * pieces.len() as f64 * (constant + flown);
    (convolve(pieces, time, constant, &fading, body.fluidity()), allowed)
}

fn refused(error: &Error) -> Violation {
    Violation::new(format!("it was refused: {error}"))
}

fn creep(bed: &Bed<'_>, body: &Prony, load: &PiecewiseLinear, draw: &mut Draw<'_>) -> Verdict {
    let mut tally = Tally::default();
    let pieces = pieces(load);
    let found = Creep::new(bed, body, load).map_err(|error| refused(&error))?;
    let recession = found.recession();
    let course = ControlHistory::Load(load.clone());
    let mut contact = ViscoelasticBed::new(bed, body).map_err(|error| refused(&error))?;
    let mut follows = true;
    let mut before = 0.0_f64;
    for time in times(load, body, draw) {
        let during = |violation: Violation| violation.during(format!("at {time:e}, {recession:?}"));
        let (expected, allowed) = effective(body, &pieces, time);
        tally
            .close("effective load", found.effective_load(time), expected, allowed)
            .map_err(during)?;
        let is_behind = recession.is_some_and(|r| time > r.time || (r.is_jump && time == r.time));
        let stepped = if follows { Some(contact.follow(&course, &[time])) } else { None };
        // Up to the end of the path a step is as good as a curve; behind it nothing is.
        follows = matches!(stepped, Some(Ok(_)));
        match found.at(time) {
            Ok(state) => {
                ensure!(!is_behind, "a state at {time:e}, behind {recession:?}");
                let fallen = before - state.effective_load;
                ensure!(fallen <= allowed, "it fell by {fallen:e} up to {time:e}: {recession:?}");
                before = before.max(state.effective_load);
                tally.close("load", state.load, load.value_at(time), 0.0).map_err(during)?;
                if let Ok(pressure) = found.pressure(time, usize::MAX) {
                    let off = allowed * (1.0 + late(load, body, &[time]) / ROUNDING);
                    let off = off / body.instantaneous_compliance();
                    tally
                        .close("load of pressures", pressure.load(), state.load, off)
                        .map_err(during)?;
                }
                if let (Some(Ok(states)), 0) = (&stepped, contact.halvings()) {
                    let Some(step) = states.last() else { continue };
                    tally.close("bed", step.effective_load, expected, allowed).map_err(during)?;
                    let soft = bed.stiffnesses().first().map_or(0.0, |k| allowed / k);
                    let soft = soft + ROUNDING * state.approach;
                    tally.close("approach", step.approach, state.approach, soft).map_err(during)?;
                    let gap = bed.mean_gaps().first().copied().unwrap_or(0.0);
                    tally
                        .close("mean gap", step.mean_gap, state.mean_gap, 1e-9 * gap + 2.0 * soft)
                        .map_err(during)?;
                    let knots = bed.loads();
                    let near = |way: f64| knots.partition_point(|knot| *knot <= expected + way);
                    if near(allowed) == near(-allowed) && state.load > 0.0 {
                        ensure!(step.contact_nodes == state.contact_nodes, "{step:?} {state:?}");
                    }
                }
                tally.checked += 1;
            }
            Err(Error::Creep(CreepError::ContactRecedes { .. })) => {
                ensure!(is_behind, "refused at {time:e}: {recession:?}");
                tally.refused += 1;
            }
            Err(
                Error::Creep(CreepError::PathEnds { .. })
                | Error::Bed(BedError::PathEndsBefore { .. }),
            ) => {
                let last = bed.last_load();
                ensure!(
                    expected >= last - allowed,
                    "refused at {time:e}, {expected:e} of {last:e}"
                );
                tally.refused += 1;
            }
            Err(error) => return Err(during(refused(&error))),
        }
    }
    if let Some(recession) = recession {
        let top = effective(body, &pieces, recession.time);
        if !recession.is_jump {
            tally.close("greatest", recession.effective_load, top.0, top.1)?;
        }
    }
    let reached = found.times();
    ensure!(reached.windows(2).all(|pair| pair[0] <= pair[1]), "times of knots: {reached:?}");
    let late = late(load, body, &reached);
    for (time, knot) in reached.iter().zip(bed.loads()) {
        let (expected, allowed) = effective(body, &pieces, *time);
        // It may be reached just before a jump down.
        let jump = recession.filter(|r| r.is_jump && r.time == *time);
        let expected = jump.map_or(expected, |r| r.effective_load.max(expected));
        let allowed = allowed * (1.0 + late / ROUNDING);
        ensure!(expected >= knot - allowed, "{knot:e} is reached at {time:e}, but {expected:e}");
    }
    unloading(&found, (load, body), &mut tally, &times(load, body, draw))?;
    Ok(tally)
}

/// What times that are rounded make of a load on the steepest ramp, and of the fastest term.
fn late(load: &PiecewiseLinear, body: &Prony, times: &[f64]) -> f64 {
    let ramps = load.corners().windows(2).map(|pair| pair[1].0 - pair[0].0);
    let steepest = ramps.filter(|ramp| *ramp > 0.0).fold(f64::INFINITY, f64::min);
    let latest = times.iter().filter(|time| time.is_finite());
    let latest = latest.fold(load.end().abs(), |most, time| most.max(time.abs()));
    let shortest = body.relaxation_terms().first().map_or(f64::INFINITY, |term| term.time);
    16.0 * f64::EPSILON * latest * (1.0 / steepest + 1.0 / shortest)
}

/// Of unloading what holds of any.
fn unloading(
    creep: &Creep<'_>,
    (load, body): (&PiecewiseLinear, &Prony),
    tally: &mut Tally,
    times: &[f64],
) -> Result<(), Violation> {
    let (Some(recession), Ok(unloading)) = (creep.recession(), Unloading::new(creep)) else {
        return Ok(());
    };
    let greatest = load.corners().iter().fold(0.0_f64, |most, corner| most.max(corner.1));
    let late = late(load, body, times);
    let mut before = f64::INFINITY;
    for &time in times.iter().filter(|time| **time > recession.time) {
        let during = |violation: Violation| violation.during(format!("unloading at {time:e}"));
        match unloading.at(time) {
            Ok(state) => {
                let contact = state.contact.load;
                // What is missing of the load by rounding, 1e-12 of the greatest or half of it, the contact makes up.
                let missing = (1e-12 * greatest / state.load).min(0.5);
                let most =
                    recession.effective_load.min(before) * (1.0 + 1e-9 + late) / (1.0 - missing);
                ensure!(contact <= most, "{contact:e} of {most:e} in contact at {time:e}");
                ensure!(state.contact_time <= recession.time, "{state:?} behind {recession:?}");
                before = contact;
                ensure!(state.load > 0.0 || contact == 0.0, "{contact:e} in contact at {time:e}");
                let carried = unloading.pressure(time, usize::MAX).map_err(|e| refused(&e))?;
                let is_pressed = carried.pieces().iter().all(|piece| piece.weight >= -1e-9);
                ensure!(is_pressed, "tension at {time:e}: {carried:?}");
                let expected = load.value_at(time);
                let allowed = (1e-8 + late) * greatest;
                tally.close("load", carried.load(), expected, allowed).map_err(during)?;
                tally.checked += 1;
            }
            Err(Error::Creep(CreepError::ContactReturns { time: returns })) => {
                ensure!(time >= returns, "it returned at {returns:e}, and not at {time:e}");
                tally.refused += 1;
            }
            Err(error) => return Err(during(refused(&error))),
        }
    }
    Ok(())
}

fn relaxation(
    bed: &Bed<'_>,
    body: &Prony,
    approach: &PiecewiseLinear,
    draw: &mut Draw<'_>,
) -> Verdict {
    let mut tally = Tally::default();
    let found = Relaxation::new(bed, body, approach).map_err(|error| refused(&error))?;
    ensure!(found.recession().is_none(), "{:?}, and it never fell", found.recession());
    let terms: Vec<(f64, f64)> =
        body.relaxation_terms().iter().map(|term| (term.time, term.amount)).collect();
    let end = bed.approaches().last().copied().unwrap_or(0.0);
    for time in times(approach, body, draw) {
        let during = |violation: Violation| violation.during(format!("at {time:e}"));
        let present = approach.value_at(time);
        let state = match found.at(time) {
            Ok(state) => state,
            Err(Error::Bed(BedError::PathEndsBefore { .. })) => {
                ensure!(present >= end * (1.0 - 1e-11), "refused at {time:e}: {present:e}");
                tally.refused += 1;
                continue;
            }
            Err(error) => return Err(during(refused(&error))),
        };
        ensure!(state.approach == present, "asked for {present:e}: {state:?}");
        let Some(pieces) = elastic(bed, approach, time) else { continue };
        let greatest = pieces.last().map_or(0.0, |piece| piece[1].1);
        let stiff = bed.at_approach(present).map_or(0.0, |state| state.stiffness);
        let stiff = if stiff.is_finite() { stiff * present } else { 0.0 };
        let allowed = (ROUNDING + late(approach, body, &[time]))
            * (greatest + stiff)
            * pieces.len().max(8) as f64
            * body.instantaneous_modulus();
        let expected = convolve(&pieces, time, body.equilibrium_modulus(), &terms, 0.0);
        tally.close("load", state.load, expected, allowed).map_err(during)?;
        ensure!(state.load >= -allowed, "{state:?}");
        let pressure = found.pressure(time, usize::MAX).map_err(|error| refused(&error))?;
        tally.close("load of pressures", pressure.load(), state.load, allowed).map_err(during)?;
        tally.checked += 1;
    }
    Ok(tally)
}

/// The elastic load up to a time, in pieces from knot to knot; `None` beyond the path.
fn elastic(bed: &Bed<'_>, approach: &PiecewiseLinear, until: f64) -> Option<Vec<Piece>> {
    let load = |approach: f64| bed.at_approach(approach.max(0.0)).ok().map(|state| state.load);
    let mut all = Vec::new();
    for [(start, from), (end, to)] in pieces(approach) {
        if start > until {
            break;
        }
        let mut before = (start, load(from)?);
        if end > start {
            let inside = bed.approaches().iter().filter(|knot| **knot > from && **knot < to);
            for knot in inside {
                let passed = (start + (end - start) * ((knot - from) / (to - from)), load(*knot)?);
                all.push([before, passed]);
                before = passed;
            }
        }
        all.push([before, (end, load(to)?)]);
    }
    Some(all)
}
