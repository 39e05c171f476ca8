//! Stretches of a path against windows of a single event, each of which has an exact solution of its own.

use std::error::Error;

use asperity::LoadingSolver;
use asperity::loading::{History, LoadingState};
use asperity::record::LoadingRecord;
use asperity::updater::ConjugateGradient;

/// Events of a stretch: as many as a window of the path has.
const LENGTH: usize = 60;
/// Of the exact solutions. Nodes that touch within ten times this, over their closing rate, join together.
const TOLERANCE: f64 = 1e-12;
/// Events closer than this, relative to their approach, are ties.
const TIE: f64 = 1e-9;

/// Follows stretches spread evenly over a recorded path once more, with an exact solution at every event, and prints
/// how order and approaches differ.
pub(crate) fn compare(record: &LoadingRecord, stretches: usize) -> Result<(), Box<dyn Error>> {
    let kernel = record.make_kernel()?;
    let states = record.history().events();
    let room = states.len().saturating_sub(2 * LENGTH);
    let (mut misplaced, mut worst) = (0, 0.0_f64);
    for k in 1..=stretches {
        let count = LENGTH + room * k / (stretches + 1);
        let before: History = states[..count].iter().copied().collect();
        let mut path = LoadingSolver::builder(record.heights(), &kernel)
            .updater(ConjugateGradient::with_tolerance(TOLERANCE)?)
            .window_size(1)
            .max_nodes(states[count - 1].contact.contact_nodes + LENGTH)
            .resume(&before)?;
        let exact = path.by_ref().collect::<Result<Vec<LoadingState>, asperity::Error>>()?;
        let found = &states[count..];
        let length = exact.len().min(found.len());
        let (exact, found) = (&exact[..length], &found[..length]);
        let other = found.iter().enumerate().filter(|(k, state)| {
            let own = exact.iter().position(|exact| exact.node == state.node);
            own.is_none_or(|own| {
                let apart = (exact[own].contact.approach - exact[*k].contact.approach).abs();
                own != *k && apart > TIE * state.contact.approach
            })
        });
        let other = other.count();
        let spacing =
            (exact[length - 1].contact.approach - exact[0].contact.approach) / length as f64;
        let errors = found.iter().zip(exact);
        let error = errors.fold(0.0_f64, |worst, (found, exact)| {
            worst.max((found.contact.approach - exact.contact.approach).abs())
        });
        println!(
            "  {count} nodes: {other} of {length} events elsewhere, approach within {:.1e} of their spacing, {} windows",
            error / spacing,
            path.timings().windows,
        );
        misplaced += other;
        worst = worst.max(error / spacing);
    }
    println!(
        "{stretches} stretches: {misplaced} events elsewhere, approach within {worst:.1e} of their spacing"
    );
    Ok(())
}
