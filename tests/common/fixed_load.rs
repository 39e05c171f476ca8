//! What every fixed-load solution has to fulfil.

use asperity::FixedLoadSolution;

/// How far a number is from the one expected.
pub fn relative(found: f64, expected: f64) -> f64 {
    ((found - expected) / expected).abs()
}

/// Every figure of a certificate within the tolerance.
pub fn check(solution: &FixedLoadSolution, tolerance: f64) {
    let certificate = solution.certificate;
    assert!(certificate.complementarity <= tolerance, "{certificate:?}");
    assert!(certificate.least_gap >= -tolerance, "{certificate:?}");
    assert!(
        certificate.greatest_contact_gap <= tolerance,
        "{certificate:?}"
    );
    // A sum of positive numbers, scaled: rounding of the sum only.
    assert!(certificate.load_error.abs() <= 1e-13, "{certificate:?}");
    assert!(solution.pressure.iter().all(|p| *p >= 0.0));
}
