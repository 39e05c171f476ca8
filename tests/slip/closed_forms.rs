//! Joints whose curves are known in closed form.

use asperity::bed::Bed;
use asperity::reference::{HertzSphere, SphereSlip};
use asperity::slip::{Friction, PartialSlip, SlipHistory};
use asperity::surface::Paraboloid;
use asperity::{Boussinesq, Grid, HeightMap, LoadingSolver};
use asperity_testing::close::relative;
use nalgebra::DMatrix;

use crate::joints::{of_curve, read};

/// The curve of Hertz at 40 000 knots: Cattaneo, Mindlin and Deresiewicz without a mesh.
#[test]
fn a_sphere_without_a_mesh() {
    let sphere = HertzSphere::new(1.0, 1.0).unwrap();
    let nodes = 40_000;
    // Knots at equal steps of the contact radius.
    let approaches: Vec<f64> =
        (0..nodes).map(|k| 1.01e-4 * (f64::from(k) / f64::from(nodes - 1)).powi(2)).collect();
    let history = of_curve(&approaches, |approach| sphere.load(approach));
    let bed = Bed::new(&history).unwrap();
    let load = sphere.load(1e-4);
    let joint = PartialSlip::new(&bed, load, Friction::new(0.3, 1.2).unwrap()).unwrap();
    let exact = SphereSlip::new(sphere, load, 0.3, 1.2).unwrap();

    // The truth in `tests/data/slip/sphere.json`: T/μP, U, c, D.
    for (share, displacement, radius, lost) in [
        (0.1, 2.4418889356983232e-06, 0.009654893846056297, 2.2863105984379577e-15),
        (0.3, 7.618553412821128e-06, 0.008879040017426006, 7.224142498573267e-14),
        (0.5, 1.3321421101892283e-05, 0.007937005259840998, 4.0570113933041486e-13),
        (0.8, 2.3688173183927784e-05, 0.005848035476425732, 2.553120178055831e-12),
        (1.0, 3.6e-05, 0.0, 1.1520000000000003e-11),
    ] {
        let force = share * joint.sliding_load();
        assert!(relative(exact.displacement(force), displacement) < 1e-13, "{share}");
        assert!((exact.stick_radius(force) - radius).abs() < 1e-13, "{share}");
        // The bracket of the truth cancels to 1e-3 at a tenth.
        assert!(relative(exact.dissipation(force), lost) < 1e-11, "{share}");

        let cycle = joint.cycle(force).unwrap();
        // Chords of a curve: (Δδ/δ)²/8 of its load at knots 40 000 steps apart, 1e-9, over the tenth of the amplitude,
        // and that over a hundredth, which is the share that is lost, for the dissipation.
        assert!(relative(cycle.displacement, displacement) < 1e-8, "{share}");
        assert!(relative(cycle.dissipation, lost) < 1e-6, "{share}");
        let state = joint.monotone(force).unwrap();
        if share < 1.0 {
            let stiffness = exact.tangential_stiffness(force);
            // By steps of one knot.
            assert!(relative(state.tangential_stiffness, stiffness) < 1e-4, "{share}");
        } else {
            assert_eq!((state.tangential_stiffness, state.stick_nodes), (0.0, 0));
        }
    }
}

/// W = W₀ (e^(δ/u₀) − 1), of rough surfaces under light loads: T = μ (P + W₀) (1 − e^(−U/κμu₀)).
#[test]
fn an_exponential_law() {
    let (scale, length) = (2.0, 0.5);
    let nodes = 40_000;
    let approaches: Vec<f64> = (0..nodes).map(|k| 3.0 * f64::from(k) / f64::from(nodes)).collect();
    let history = of_curve(&approaches, |approach| scale * (approach / length).exp_m1());
    let bed = Bed::new(&history).unwrap();
    let load = 100.0;
    let joint = PartialSlip::new(&bed, load, Friction::new(0.4, 1.3).unwrap()).unwrap();
    for share in [1e-3, 0.1, 0.5, 0.9, 0.999] {
        let force = share * joint.sliding_load();
        let displacement = -1.3 * 0.4 * length * (-force / (0.4 * (load + scale))).ln_1p();
        let state = joint.monotone(force).unwrap();
        // Chords: (Δδ/u₀)²/8 = 3e-9 of u₀, over the share of it that is slipped.
        assert!(relative(state.displacement, displacement) < 4e-9 / share, "{share}");
        // All of it is interfacial in this history, whose mean gap falls as the approach grows.
        assert!(relative(state.interfacial_displacement, state.displacement) < 1e-12);
    }
}

/// Hertz' path on a mesh: displacements err as the approach of the path does, dissipations by the thinness of the slip
/// ring in cells.
#[test]
fn a_sphere_on_a_mesh() {
    let n = 48;
    let (side, radius) = (1.0, 10.0);
    let surface = Paraboloid::new(radius).unwrap();
    let kernel = Boussinesq::new(Grid::square(n, side).unwrap(), 1.0).unwrap();
    let sphere = HertzSphere::new(radius, 1.0).unwrap();
    // A contact radius of 3/8 of the side.
    let load = sphere.load(0.375 * 0.375 / radius);
    let (_, history) = read(LoadingSolver::builder(&surface, &kernel).max_load(load));
    let bed = Bed::new(&history).unwrap();
    let joint = PartialSlip::new(&bed, load, Friction::new(0.3, 1.2).unwrap()).unwrap();
    let exact = SphereSlip::new(sphere, load, 0.3, 1.2).unwrap();
    for (share, displacement, lost) in
        [(0.25, 1e-3, 6e-2), (0.5, 1e-3, 1e-2), (0.75, 1e-3, 5e-3), (0.9, 1e-3, 5e-3)]
    {
        let force = share * joint.sliding_load();
        let cycle = joint.cycle(force).unwrap();
        let errors = (
            relative(cycle.displacement, exact.displacement(force)),
            relative(cycle.dissipation, exact.dissipation(force)),
        );
        assert!(errors.0 < displacement && errors.1 < lost, "{share}: {errors:?}");
        let state = joint.monotone(force).unwrap();
        let stick = (state.stick_area / std::f64::consts::PI).sqrt();
        // Half a cell of 1/48, at a radius of 0.17 at least.
        assert!(relative(stick, exact.stick_radius(force)) < 0.06, "{share}");
    }
}

/// A flat punch sticks up to the load at which it slides as a whole, and loses nothing before.
#[test]
fn a_flat_punch_slips_at_once() {
    let surface = HeightMap::new(DMatrix::zeros(6, 6)).unwrap();
    let kernel = Boussinesq::new(Grid::square(6, 1.0).unwrap(), 1.0).unwrap();
    let (_, history) = read(LoadingSolver::builder(&surface, &kernel));
    let bed = Bed::new(&history).unwrap();
    let joint = PartialSlip::new(&bed, 2.0, Friction::new(0.5, 1.5).unwrap()).unwrap();
    let stiffness = bed.stiffnesses()[35] / 1.5;
    for force in [0.1, 0.5, 0.99] {
        let cycle = joint.cycle(force).unwrap();
        assert_eq!((cycle.dissipation, cycle.slipping_nodes), (0.0, 0));
        assert!(relative(cycle.secant_stiffness, stiffness) < 1e-13);
        assert_eq!(joint.monotone(force).unwrap().stick_nodes, 36);
    }
    let limit = joint.monotone(1.0).unwrap();
    assert_eq!((limit.stick_nodes, limit.slipping_nodes), (0, 36));
    // Behind it the joint slides: 4 T (U − T/k).
    let displacement = 3.0 / stiffness;
    let cycle = joint.cycle_of_displacement(displacement).unwrap();
    assert!(relative(cycle.dissipation, 4.0 * (displacement - 1.0 / stiffness)) < 1e-13);
    let mut history = SlipHistory::new(&bed, joint.friction());
    history.to(2.0, 0.0).unwrap();
    history.to(2.0, 0.9).unwrap();
    history.to(2.0, -0.9).unwrap();
    assert_eq!(history.dissipation(), 0.0);
}
