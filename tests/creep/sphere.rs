//! A rigid sphere on a viscoelastic half-space, in the closed form of Lee and Radok.

use asperity::bed::Bed;
use asperity::creep::{Creep, PiecewiseLinear, Prony};
use asperity::reference::HertzSphere;
use asperity::surface::Paraboloid;
use asperity::{Boussinesq, Grid, LoadingSolver};

/// Under a load W put on at once a³ = (3/4) R W J(t), δ = a²/R, and at the centre p = 2/(π R) ∫ R(t − s) da(s). On
/// finer and finer grids all three converge as the elastic path does, in the mean with the mesh: the approach and the
/// pressure at the centre faster than the area, which is counted in whole cells.
#[test]
fn a_sphere_creeps_as_in_closed_form() {
    let body = Prony::relaxation(0.2, &[(1.0, 0.3), (0.1, 0.5)]).unwrap();
    let radius = 10.0;
    let hertz = HertzSphere::new(radius, 1.0).unwrap();
    let load = hertz.load(0.2 * 0.2 / radius);
    let times = [0.0, 0.1, 1.0, 10.0];
    let mut all = Vec::new();
    for n in [24, 48, 96] {
        let half_space = Boussinesq::new(Grid::square(n, 1.0).unwrap(), 1.0).unwrap();
        let surface = Paraboloid::new(radius).unwrap();
        let builder = LoadingSolver::builder(&surface, &half_space);
        let mut path = builder.max_load(5.1 * load).build().unwrap();
        let history = path.run().unwrap();
        let bed = Bed::new(&history).unwrap();
        let creep = Creep::new(&bed, &body, &PiecewiseLinear::step(load).unwrap()).unwrap();
        let mut worst = [0.0_f64; 3];
        for time in times {
            let state = creep.at(time).unwrap();
            let creeps = body.creep_at(time);
            let approach = hertz.approach_at_load(load * creeps);
            let centre = centre(&body, &hertz, load, time);
            let pressure = creep.pressure(time, 200).unwrap().pressure(&bed, &mut path).unwrap();
            let middle = n / 2;
            let found = pressure.view((middle - 1, middle - 1), (2, 2)).mean();
            let errors = [
                state.approach / approach - 1.0,
                found / centre - 1.0,
                state.contact_area / hertz.contact_area(approach) - 1.0,
            ];
            println!("n = {n}, t = {time}: {errors:?}");
            for (worst, error) in worst.iter_mut().zip(errors) {
                *worst = worst.max(error.abs());
            }
        }
        all.push(worst);
    }
    // A contact of 10, 19 and 38 cells in diameter at first. Of the area a node more or less around the rim is left,
    // some 1/n of it, and of the others with a rim of cells half in contact some n^(-3/2).
    for (worst, bounds) in
        all.iter().zip([[2e-2, 2e-2, 9e-2], [5e-3, 5e-3, 5e-2], [2e-3, 2e-3, 2.5e-2]])
    {
        assert!(worst.iter().zip(bounds).all(|(worst, bound)| *worst < bound), "{all:?}");
    }
}

/// The pressure at the centre: 2/(π R) [R(t) a(0) + ∫ R(t − s) a′(s) ds] by Simpson's rule on the mean of R
/// over each of 20 000 steps.
fn centre(body: &Prony, hertz: &HertzSphere, load: f64, time: f64) -> f64 {
    let radius_at = |t: f64| hertz.contact_radius(hertz.approach_at_load(load * body.creep_at(t)));
    let mut sum = body.relaxation_at(time) * radius_at(0.0);
    let steps = 20_000;
    let (mut before, mut last) = (radius_at(0.0), 0.0);
    for k in 1..=steps {
        let now = time * f64::from(k) / f64::from(steps);
        let after = radius_at(now);
        // The mean of R over the step by Simpson's rule; a is smooth.
        let weights = [last, 0.5 * (last + now), now].map(|s| body.relaxation_at(time - s));
        sum += (after - before) * (weights[0] + 4.0 * weights[1] + weights[2]) / 6.0;
        (before, last) = (after, now);
    }
    2.0 / (std::f64::consts::PI * hertz.radius()) * sum
}
