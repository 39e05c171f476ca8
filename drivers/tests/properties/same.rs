//! Whether two paths are one.

use asperity::LoadingState;
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;

/// What two paths may differ by that are exact to rounding, relative to the numbers themselves: they solve with
/// matrices of condition 10³ at most and are 10⁻¹¹ apart at worst, mean gaps as much of the initial one.
pub(crate) const EXACT: f64 = 1e-11;
/// Events this close, relative to the approach, are one: rounding decides which comes first. Of a path without a factor
/// as well, as `asperity::loading` says.
const TIE: f64 = 1e-9;
/// How far quantities of a path scale.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scale {
    pub(crate) length: f64,
    pub(crate) load: f64,
}

pub(crate) const SAME: Scale = Scale { length: 1.0, load: 1.0 };

pub(crate) fn close(what: &str, a: f64, b: f64, allowed: f64) -> TestCaseResult {
    prop_assert!(
        (a - b).abs() <= allowed || a == b,
        "{}: {:e} and {:e}, {:e} apart where {:e} is allowed",
        what,
        a,
        b,
        (a - b).abs(),
        allowed
    );
    Ok(())
}

/// Compares a path with another one whose nodes are at `place`: the same nodes in the same order up to ties, and the
/// same scalars between groups of ties.
pub(crate) fn same_path(
    found: &[LoadingState],
    expected: &[LoadingState],
    place: impl Fn((usize, usize)) -> (usize, usize),
    scale: Scale,
    allowed: f64,
) -> TestCaseResult {
    prop_assert_eq!(found.len(), expected.len());
    let initial = expected.first().map_or(0.0, |first| first.contact.mean_gap);
    let last = expected.last().map_or(0.0, |last| last.contact.approach);
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    for (k, (a, b)) in found.iter().zip(expected).enumerate() {
        ours.push(place(a.node));
        theirs.push(b.node);
        let next = expected.get(k + 1).map_or(f64::INFINITY, |next| next.contact.approach);
        // Lengths cancel in an approach: the heights.
        let tie = (TIE * b.contact.approach).max(1e-13 * initial);
        if next - b.contact.approach <= tie {
            continue;
        }
        ours.sort_unstable();
        theirs.sort_unstable();
        prop_assert_eq!(&ours, &theirs, "up to step {}", b.step);
        ours.clear();
        theirs.clear();
        // Where there is hardly an approach, it consists of rounding.
        if b.contact.approach <= tie {
            continue;
        }
        let Scale { length, load } = scale;
        let approach = allowed * (b.contact.approach + last);
        close("approach", a.contact.approach, length * b.contact.approach, length * approach)?;
        close(
            "mean gap",
            a.contact.mean_gap,
            length * b.contact.mean_gap,
            length * allowed * initial,
        )?;
        // A load is a stiffness times an approach, both as exact as that.
        let stiffness = b.contact.contact_stiffness.or(b.contact.interfacial_stiffness);
        let stiffness = stiffness.filter(|k| k.is_finite()).unwrap_or(0.0);
        let slack = allowed * b.contact.load + approach * stiffness;
        close("load", a.contact.load, load * b.contact.load, load * slack)?;
        let slack = 3.0 * allowed * b.contact.energy + slack * b.contact.approach;
        close("energy", a.contact.energy, load * length * b.contact.energy, load * length * slack)?;
        if let (Some(a), Some(b)) = (a.contact.contact_stiffness, b.contact.contact_stiffness) {
            close("stiffness", a, load / length * b, load / length * allowed * b)?;
        }
    }
    Ok(())
}

/// Every number of every state, bit by bit.
pub(crate) fn bits(states: &[LoadingState]) -> Vec<[Option<u64>; 8]> {
    let row = |s: &LoadingState| {
        let scalars = [
            Some(s.contact.approach),
            Some(s.contact.load),
            Some(s.contact.mean_gap),
            Some(s.contact.energy),
            s.contact.contact_stiffness,
            s.contact.interfacial_stiffness,
            Some(s.node.0 as f64),
            Some(s.node.1 as f64),
        ];
        scalars.map(|value| value.map(f64::to_bits))
    };
    states.iter().map(row).collect()
}
