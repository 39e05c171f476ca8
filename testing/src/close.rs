//! Differences of numbers and of states.

#[doc(hidden)]
pub use approx::assert_relative_eq;

use asperity::LoadingState;

/// How far a number is from the one expected.
#[must_use]
pub fn relative(found: f64, expected: f64) -> f64 {
    ((found - expected) / expected).abs()
}

/// Asserts that two numbers differ by no more than a part of the greater. `approx` would also let pass what differs by
/// less than 2.2e-16, whatever the unit.
#[macro_export]
macro_rules! assert_relative {
    ($found:expr, $expected:expr, $tolerance:expr $(,)?) => {
        $crate::close::assert_relative_eq!(
            $found,
            $expected,
            epsilon = 0.0,
            max_relative = $tolerance
        )
    };
}

/// Every column of two states within `tolerance`, relative to its own size; mean gaps relative to the
/// first one, a difference of which they are.
#[track_caller]
pub fn assert_close(found: &LoadingState, expected: &LoadingState, tolerance: f64, unloaded: f64) {
    let context = format!("{found:?} {expected:?}");
    assert_eq!(found.contact.contact_nodes, expected.contact.contact_nodes, "{context}");
    let contact_stiffness = |state: &LoadingState| state.contact.contact_stiffness.unwrap_or(0.0);
    let interfacial = |state: &LoadingState| state.contact.interfacial_stiffness.unwrap();
    for (a, b, scale) in [
        (found.contact.approach, expected.contact.approach, expected.contact.approach),
        (found.contact.load, expected.contact.load, expected.contact.load),
        (found.contact.contact_area, expected.contact.contact_area, expected.contact.contact_area),
        (found.contact.mean_gap, expected.contact.mean_gap, unloaded),
        (found.contact.energy, expected.contact.energy, expected.contact.energy),
        (contact_stiffness(found), contact_stiffness(expected), contact_stiffness(expected)),
        (interfacial(found), interfacial(expected), interfacial(expected)),
    ] {
        assert!(a == b || (a - b).abs() <= tolerance * scale, "{a} {b}, {context}");
    }
}
