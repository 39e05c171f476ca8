//! Stiffnesses of the last state. No later state follows from them, but the window with which the path goes on has
//! them.

use super::increments::{Found, ROUNDING};
use super::stiffnesses::{CONTACT, INTERFACIAL, SAME_STIFFNESS};
use crate::loading::{ContactEvent, LoadingState, NextWindow};
use crate::{Error, Grid};

/// Without a factor states know how fast the mean gap closes to 4·10⁻³ of it at worst.
const SAME_CLOSING: f64 = 2e-2;
/// What rounding of displacements leaves of that rate in full contact, where it is 0.
const NO_CLOSING: f64 = 1e-6;

/// Checks the last of some states, where the next window begins.
pub(super) fn check(grid: &Grid, states: &[LoadingState], next: &NextWindow) -> Result<(), Error> {
    let Some(last) = states.last().filter(|last| !last.contact.is_plateau()) else {
        return Ok(());
    };
    let ([stiffness, closing], [stiffness_off, closing_off, no_closing]) = match next {
        NextWindow::Factor(end) => (ends(end.scalars), [ROUNDING, ROUNDING, 0.0]),
        NextWindow::Iterations(end) => match end.scalars {
            Some(scalars) => (ends(scalars), [ROUNDING, ROUNDING, 0.0]),
            None => {
                let rate = &end.kept.rate;
                let sum = rate.pressure.iter().sum();
                let rates = [sum, closing(grid, states, &rate.displacement)];
                (rates, [SAME_STIFFNESS, SAME_CLOSING, NO_CLOSING])
            }
        },
    };
    let reason = "is what its path goes on with";
    let expected = grid.cell_area() * stiffness;
    if let Some(value) = last.contact.contact_stiffness {
        let tolerance = stiffness_off * expected.abs();
        Found { quantity: CONTACT, value, expected, tolerance, reason }.at(last.step)?;
    }
    let Some(value) = last.contact.interfacial_stiffness else {
        return Ok(());
    };
    if (expected / value - closing).abs() <= closing_off * closing.abs() + no_closing {
        return Ok(());
    }
    let expected = expected / closing;
    Found { quantity: INTERFACIAL, value, expected, tolerance: 0.0, reason }.at(last.step)
}

/// Stiffness and closing rate of the scalars of a path.
fn ends([.., stiffness, closing]: [f64; 6]) -> [f64; 2] {
    [stiffness, closing]
}

/// By how much the mean gap closes for each metre of the approach: yielded nodes have no gap.
fn closing(grid: &Grid, states: &[LoadingState], displacement: &[f64]) -> f64 {
    let mut closes: Vec<f64> = displacement.iter().map(|u| 1.0 - u).collect();
    let yields = states.iter().filter(|state| state.event == ContactEvent::Yield);
    for node in yields.filter_map(|state| grid.node(state.node.0, state.node.1)) {
        if let Some(closes) = closes.get_mut(node) {
            *closes = 0.0;
        }
    }
    closes.iter().sum::<f64>() / grid.nodes() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::ContactState;
    use crate::kernel::{Base, Layer, Layered, LayeredBody};
    use crate::loading::{History, WindowEnd};
    use crate::record::LoadingRecord;
    use crate::surface::{Amplitude, Axis};
    use crate::updater::{ConjugateGradient, Handover, LinearUpdater};
    use crate::{
        Boussinesq, InfluenceKernel, LoadingSolver, PeriodicBoussinesq, SelfAffine,
        SemiPeriodicBoussinesq,
    };

    type Change = fn(&mut ContactState);

    /// The same record with a change of the last state, or of the states that its window has not yielded yet.
    fn changed(
        record: &LoadingRecord,
        of_states: impl FnOnce(&mut [LoadingState]),
        of_ahead: impl FnOnce(&mut [LoadingState]),
    ) -> Result<LoadingRecord, Error> {
        let mut states = record.states().to_vec();
        of_states(&mut states);
        let mut end: Option<WindowEnd> = record.history.window_end().cloned();
        if let Some(end) = &mut end {
            of_ahead(&mut end.ahead);
        }
        let history = states.into_iter().collect::<History>().with_window_end(end);
        let (kernel, settings) = (record.kernel.clone(), record.settings.clone());
        let heights = record.heights.clone();
        LoadingRecord::from_parts(record.grid, heights, kernel, settings, history, record.end)
    }

    fn kernels(grid: Grid) -> Result<Vec<Box<dyn InfluenceKernel>>, Error> {
        let body = |youngs_modulus: f64, thickness: f64, base: f64| {
            let base = Base::HalfSpace { youngs_modulus: base, poissons_ratio: 0.3 };
            LayeredBody::new(&[Layer { youngs_modulus, poissons_ratio: 0.3, thickness }], base)
        };
        Ok(vec![
            Box::new(Boussinesq::new(grid, 2.0)?),
            Box::new(PeriodicBoussinesq::new(grid, 2.0)?),
            Box::new(SemiPeriodicBoussinesq::new(grid, 2.0, Axis::X)?),
            Box::new(Layered::free(grid, body(2.0, 10.0, 0.1)?)?),
            Box::new(Layered::periodic(grid, body(1.0, 2.0, 3.0)?)?),
        ])
    }

    /// A hundredth more or less of either stiffness is refused with a factor, a twentieth without one, whatever the
    /// body.
    #[test]
    fn the_last_stiffnesses_are_those_of_the_next_window() -> Result<(), Error> {
        let grid = Grid::new(18, 15, 1.0, 1.5)?;
        let surface = SelfAffine::new(0.8, 12.0, 4.0, Amplitude::RmsHeight(0.1), 3)?;
        let mut looked_at = 0;
        for (kernel, is_stiff) in kernels(grid)?.iter().zip([false, false, false, true, false]) {
            for (iterative, part) in [(false, 1.01), (true, 1.05)] {
                for (hardness, area) in [(None, 0.2), (None, 0.7), (Some(0.05), 0.4)] {
                    if is_stiff && hardness.is_some() {
                        continue;
                    }
                    let updater: Box<dyn LinearUpdater> = match iterative {
                        true => Box::new(ConjugateGradient::new()),
                        false => Box::new(Handover::new()),
                    };
                    let builder = LoadingSolver::builder(&surface, &**kernel).updater(updater);
                    let builder = builder.max_area_fraction(area);
                    let mut path = match hardness {
                        Some(hardness) => builder.hardness(hardness),
                        None => builder,
                    }
                    .build()?;
                    let history: History = path.by_ref().collect::<Result<_, _>>()?;
                    let record = LoadingRecord::new(&path, history)?;
                    let context = format!("{:?} {iterative} {area}", record.kernel.origin);
                    assert!(changed(&record, |_| {}, |_| {}).is_ok(), "{context}");
                    let is_plateau = |state: &LoadingState| state.contact.is_plateau();
                    let has_ahead =
                        record.history.window_end().is_some_and(|end| !end.ahead.is_empty());
                    // A state ahead follows from the last one, but for the estimated errors of both.
                    if record.states().last().is_none_or(is_plateau) || (has_ahead && iterative) {
                        continue;
                    }
                    for part in [part, 1.0 / part, -1.0] {
                        let edits: [(bool, f64); 2] = [(true, part), (false, part)];
                        for (of_contact, part) in edits {
                            let edit = |states: &mut [LoadingState]| {
                                let contact = states.last_mut().map(|last| &mut last.contact);
                                let Some(contact) = contact else { return };
                                let stiffness = match of_contact {
                                    true => &mut contact.contact_stiffness,
                                    false => &mut contact.interfacial_stiffness,
                                };
                                *stiffness = stiffness.map(|value| part * value);
                            };
                            let mut after = record.states().to_vec();
                            edit(&mut after);
                            if after == record.states() {
                                continue;
                            }
                            let read = changed(&record, edit, |_| {});
                            let is_refused = matches!(read, Err(Error::Inconsistent { .. }));
                            assert!(is_refused, "{context}, {of_contact} {part}");
                            looked_at += 1;
                        }
                    }
                }
            }
        }
        assert!(looked_at > 60, "{looked_at}");
        Ok(())
    }

    /// States that the window has not yielded yet are in the order of the events too.
    #[test]
    fn states_ahead_follow_the_events() -> Result<(), Error> {
        let grid = Grid::new(18, 15, 1.0, 1.5)?;
        let surface = SelfAffine::new(0.8, 12.0, 4.0, Amplitude::RmsHeight(0.1), 3)?;
        let kernel = Boussinesq::new(grid, 2.0)?;
        let mut path = LoadingSolver::builder(&surface, &kernel)
            .updater(ConjugateGradient::new())
            .hardness(0.05)
            .build()?;
        let history: History = path.by_ref().take(101).collect::<Result<_, _>>()?;
        let record = LoadingRecord::new(&path, history)?;
        let ahead = record.history.window_end().map_or(0, |end| end.ahead.len());
        assert!(ahead > 1, "{ahead}");
        let change: [Change; 2] = [
            |state| state.contact_nodes += 1,
            |state| {
                if let Some(plastic) = &mut state.plastic {
                    plastic.yielded_nodes += 1;
                }
            },
        ];
        for change in change {
            let read = changed(&record, |_| {}, |ahead| change(&mut ahead[0].contact));
            assert!(matches!(read, Err(Error::NotOnPath { .. })), "{read:?}");
        }
        Ok(())
    }
}
