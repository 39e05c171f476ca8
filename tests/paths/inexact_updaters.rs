//! Tolerances of iterations.

use asperity::Error;
use asperity::updater::ConjugateGradient;

#[test]
fn tolerances_that_make_no_sense_are_refused() {
    for bad in [0.0, 1.0, -1e-10, f64::NAN, f64::INFINITY] {
        let refused = ConjugateGradient::with_tolerance(bad);
        let Err(Error::OutOfRange { quantity: "tolerance", value, .. }) = refused else {
            panic!("{bad}: {refused:?}");
        };
        assert_eq!(value.to_bits(), bad.to_bits());
    }
    assert!(ConjugateGradient::with_tolerance(1e-13).is_ok());
}
