//! Creep and relaxation, one made from the other.

use asperity::Error;
use asperity::creep::Prony;
use proptest::prelude::*;

/// Conversions of two series, a solid and a fluid, made by root finding in another program.
#[test]
fn a_solid_and_a_fluid_are_converted_as_elsewhere() {
    let solid = Prony::relaxation(0.2, &[(1.0, 0.3), (0.1, 0.5)]).unwrap();
    let creep: Vec<_> = solid.creep_terms().iter().map(|term| (term.time, term.amount)).collect();
    let expected =
        [(0.18781569683413782, 0.767362311259819), (2.662184303165862, 3.2326376887401818)];
    compare(&creep, &expected);
    assert_eq!((solid.fluidity(), solid.instantaneous_compliance()), (0.0, 1.0));
    let fluid = Prony::relaxation(0.0, &[(0.1, 0.6), (1.0, 0.4)]).unwrap();
    let creep: Vec<_> = fluid.creep_terms().iter().map(|term| (term.time, term.amount)).collect();
    compare(&creep, &[(0.2173913043478261, 0.9187145557655957)]);
    assert!((fluid.fluidity() / 2.1739130434782608 - 1.0).abs() < 1e-13);
}

fn compare(found: &[(f64, f64)], expected: &[(f64, f64)]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        // Roots of a well-conditioned function, in double precision on both sides.
        assert!((found.0 / expected.0 - 1.0).abs() < 1e-13, "{found:?} {expected:?}");
        assert!((found.1 / expected.1 - 1.0).abs() < 1e-13, "{found:?} {expected:?}");
    }
}

/// A standard linear solid, a Maxwell body and two bodies in series in closed form.
#[test]
fn bodies_in_closed_form() {
    let (equilibrium, modulus, time) = (2.0, 3.0, 0.7);
    let solid = Prony::relaxation(equilibrium, &[(time, modulus)]).unwrap();
    let retardation = time * (equilibrium + modulus) / equilibrium;
    let final_compliance = 1.0 / equilibrium - 1.0 / (equilibrium + modulus);
    compare(
        &[(solid.creep_terms()[0].time, solid.creep_terms()[0].amount)],
        &[(retardation, final_compliance)],
    );
    let maxwell = Prony::creep(0.25, &[], 0.5).unwrap();
    let term = maxwell.relaxation_terms()[0];
    compare(&[(term.time, term.amount)], &[(0.5, 4.0)]);
    assert_eq!(maxwell.equilibrium_modulus(), 0.0);
    // On an elastic body the creep of the other is all there is.
    let two = solid.in_series(&Prony::elastic(10.0).unwrap()).unwrap();
    for t in [0.0, 0.1, 1.0, 30.0] {
        assert!((two.creep_at(t) / (solid.creep_at(t) + 0.1) - 1.0).abs() < 1e-14);
    }
    let plane = solid.plane_strain(0.5).unwrap();
    assert!((plane.relaxation_at(0.3) / solid.relaxation_at(0.3) * 0.75 - 1.0).abs() < 1e-14);
    let half = solid.relative_to(2.0).unwrap();
    assert!((half.creep_at(0.3) / solid.creep_at(0.3) / 2.0 - 1.0).abs() < 1e-15);
}

/// Fluids: a Maxwell body over a modulus, of a Poisson's ratio, and on bodies of each kind.
#[test]
fn fluids_in_closed_form() {
    let maxwell = Prony::creep(0.25, &[], 0.5).unwrap();
    let other = Prony::relaxation(0.0, &[(2.0, 3.0)]).unwrap();
    for (fluid, instantaneous, fluidity) in [
        (maxwell.relative_to(2.0), 0.5, 1.0),
        (maxwell.plane_strain(0.5), 0.1875, 0.375),
        (maxwell.in_series(&Prony::elastic(4.0).unwrap()), 0.5, 0.5),
        (maxwell.in_series(&other), 0.25 + 1.0 / 3.0, 0.5 + 1.0 / 6.0),
    ] {
        let fluid = fluid.unwrap();
        assert_eq!((fluid.equilibrium_modulus(), fluid.creep_terms().len()), (0.0, 0));
        assert!((fluid.fluidity() / fluidity - 1.0).abs() < 1e-15, "{fluid:?}");
        // J = j₀ + φ t, R = e^(−φ t/j₀)/j₀.
        for t in [0.0, 0.1, 1.0, 3.0] {
            let relaxation = (-fluidity * t / instantaneous).exp() / instantaneous;
            assert!((fluid.creep_at(t) / (instantaneous + fluidity * t) - 1.0).abs() < 1e-14);
            // Rounding of an exponent up to 6.
            assert!((fluid.relaxation_at(t) / relaxation - 1.0).abs() < 1e-13, "{fluid:?} {t}");
        }
    }
    // On a solid all flows, whichever is on top.
    let solid = Prony::relaxation(2.0, &[(0.7, 3.0)]).unwrap();
    for two in [maxwell.in_series(&solid).unwrap(), solid.in_series(&maxwell).unwrap()] {
        assert_eq!((two.equilibrium_modulus(), two.fluidity()), (0.0, 0.5));
        for t in [0.0, 0.1, 1.0, 30.0] {
            let sum = maxwell.creep_at(t) + solid.creep_at(t);
            assert!((two.creep_at(t) / sum - 1.0).abs() < 1e-14);
            // Well-conditioned roots, and a sum of some terms of one sign.
            assert!((convolved(&two, t) - 1.0).abs() < 1e-12, "{t}");
        }
    }
}

#[test]
fn shares_are_parts_of_the_modulus() {
    let body = Prony::shares(&[(10.0, 0.2), (0.1, 0.3)]).unwrap();
    assert_eq!(body.equilibrium_modulus(), 0.5);
    assert!((body.instantaneous_modulus() - 1.0).abs() < 1e-15);
    assert_eq!(body.relaxation_terms()[0].time, 0.1);
    // Ten tenths are one: it flows.
    let tenths: Vec<_> = (1..=10).map(|k| (f64::from(k), 0.1)).collect();
    let fluid = Prony::shares(&tenths).unwrap();
    assert_eq!(fluid.equilibrium_modulus(), 0.0);
    assert!(fluid.fluidity() > 0.0);
    // Equal times are one term, and nothing is none.
    let same = Prony::shares(&[(1.0, 0.2), (1.0, 0.3), (2.0, 0.0)]).unwrap();
    assert_eq!((same.relaxation_terms().len(), same.creep_terms().len()), (1, 1));
}

#[test]
fn what_is_no_body_is_refused() {
    let refused = |made: Result<Prony, Error>| match made {
        Err(error @ (Error::NotPositive { .. } | Error::OutOfRange { .. })) => error.to_string(),
        other => panic!("{other:?}"),
    };
    assert!(refused(Prony::shares(&[(1.0, 1.2)])).contains("1.2"));
    assert!(refused(Prony::shares(&[(1.0, -0.2)])).contains("-0.2"));
    assert!(refused(Prony::shares(&[(-1.0, 0.2)])).contains("-1"));
    refused(Prony::shares(&[(0.0, 0.2)]));
    refused(Prony::shares(&[(1e-320, 0.2)]));
    for bad in [f64::NAN, f64::INFINITY] {
        refused(Prony::shares(&[(bad, 0.2)]));
        refused(Prony::shares(&[(1.0, bad)]));
        refused(Prony::relaxation(bad, &[]));
        refused(Prony::creep(bad, &[], 0.0));
        refused(Prony::creep(1.0, &[], bad));
    }
    refused(Prony::relaxation(0.0, &[]));
    refused(Prony::relaxation(-1.0, &[(1.0, 2.0)]));
    // Kelvin and Voigt: no pressure has a series.
    refused(Prony::creep(0.0, &[(1.0, 1.0)], 0.0));
    refused(Prony::creep(1.0, &[], -1.0));
    refused(Prony::creep(1e300, &[(1e-300, 1e300)], 0.0));
    refused(Prony::relaxation(1e-200, &[(1e200, 1e200)]));
    refused(Prony::elastic(1.0).unwrap().relative_to(0.0));
    refused(Prony::elastic(1e-200).unwrap().relative_to(1e200));
    refused(Prony::elastic(1.0).unwrap().plane_strain(0.51));
    refused(Prony::elastic(1.0).unwrap().plane_strain(-1.0));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    /// There and back, over up to twelve decades of times and six of moduli; and ∫ R(t − s) dJ(s) = 1 at any time, each
    /// pair of exponentials in closed form.
    #[test]
    fn there_and_back(
        terms in prop::collection::vec((-6.0..6.0_f64, -4.0..2.0_f64), 1..8),
        flows in any::<bool>(),
    ) {
        let terms: Vec<_> = terms.iter().map(|t| (10_f64.powf(t.0), 10_f64.powf(t.1))).collect();
        let made = Prony::relaxation(if flows { 0.0 } else { 0.1 }, &terms).unwrap();
        let creep: Vec<_> = made.creep_terms().iter().map(|t| (t.time, t.amount)).collect();
        prop_assert!(made.creep_terms().iter().all(|term| term.amount > 0.0));
        let back = Prony::creep(made.instantaneous_compliance(), &creep, made.fluidity()).unwrap();
        prop_assert_eq!(back.relaxation_terms().len(), made.relaxation_terms().len());
        let total = made.instantaneous_modulus();
        for k in -8..=8 {
            for t in [10_f64.powi(k), 3.0 * 10_f64.powi(k)] {
                let (a, b) = (made.relaxation_at(t), back.relaxation_at(t));
                // Two conversions in double precision; the modulus is a sum of positive terms.
                prop_assert!((a - b).abs() <= 1e-11 * total, "{} {} at {}", a, b, t);
                let convolved = convolved(&made, t);
                prop_assert!((convolved - 1.0).abs() < 1e-10, "{} at {}", convolved, t);
            }
        }
    }
}

/// ∫ R(t − s) dJ(s), plainly.
fn convolved(body: &Prony, t: f64) -> f64 {
    let mut sum = body.relaxation_at(t) * body.instantaneous_compliance();
    for term in body.creep_terms() {
        // ∫₀ᵗ R(t − s) j/τ e^(−s/τ) ds.
        sum += body.equilibrium_modulus() * -term.amount * (-t / term.time).exp_m1();
        for relaxing in body.relaxation_terms() {
            let (a, b) = (1.0 / relaxing.time, 1.0 / term.time);
            // (e^(−bt) − e^(−at))/(a − b), without a difference of nearly equal ones.
            let slower = a.min(b);
            let difference = -(-(a - b).abs() * t).exp_m1() / (a - b).abs();
            let overlap =
                if a == b { t * (-a * t).exp() } else { (-slower * t).exp() * difference };
            sum += relaxing.amount * term.amount / term.time * overlap;
        }
    }
    let flown = body
        .relaxation_terms()
        .iter()
        .map(|term| term.amount * term.time * -(-t / term.time).exp_m1());
    sum += body.fluidity() * flown.sum::<f64>();
    sum
}
