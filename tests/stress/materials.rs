//! The load of first yield of each layer and of the base.

use asperity::kernel::{Base, Layer, Layered, LayeredBody};
use asperity::loading::History;
use asperity::stress::{FirstYield, Measure, Subsurface};
use asperity::surface::Paraboloid;
use asperity::{Error, Grid, InfluenceKernel, LoadingSolver, Spectral, StressError};
use nalgebra::DMatrix;

const STEEL: (f64, f64) = (210e9, 0.3);
const COAT: (f64, f64) = (450e9, 0.22);
const RADIUS: f64 = 10e-3;
/// Half the side of the grid \[m\].
const HALF: f64 = 200e-6;

fn grid() -> Result<Grid, Error> {
    Ok(Grid::square(33, 2.0 * HALF)?)
}

/// A sphere that is pressed on a body until its contact is some 0.7 of the grid wide.
fn pressed(kernel: &dyn InfluenceKernel, e_star: f64) -> Result<(LoadingSolver, History), Error> {
    let contact = 0.7 * HALF;
    let load = 4.0 / 3.0 * e_star * contact.powi(3) / RADIUS;
    let mut path =
        LoadingSolver::builder(&Paraboloid::new(RADIUS)?, kernel).max_load(load).build()?;
    let history = path.run()?;
    Ok((path, history))
}

fn layered(layers: &[((f64, f64), f64)], base: Base) -> Result<LayeredBody, Error> {
    let layer = |&((youngs_modulus, poissons_ratio), thickness): &((f64, f64), f64)| Layer {
        youngs_modulus,
        poissons_ratio,
        thickness,
    };
    LayeredBody::new(&layers.iter().map(layer).collect::<Vec<_>>(), base)
}

/// The greatest von Mises' stress at so many depths from one to another.
fn greatest(
    body: &Subsurface,
    pressure: &DMatrix<f64>,
    (from, to): (f64, f64),
    count: usize,
) -> Result<f64, Error> {
    let mut most = 0.0_f64;
    for k in 0..count {
        let part = k as f64 / (count - 1) as f64;
        // Both ends as they are given.
        let depth = if k + 1 == count { to } else { from + part * (to - from) };
        most = most.max(body.at_depth(pressure, depth)?.map(Measure::VonMises).max());
    }
    Ok(most)
}

/// Layers of the base's moduli: each begins to yield where the half-space does within its depths, and one of them with
/// the half-space itself.
#[test]
fn layers_of_one_material_yield_as_a_half_space() -> Result<(), Error> {
    let (youngs_modulus, poissons_ratio) = STEEL;
    let e_star = youngs_modulus / (1.0 - poissons_ratio * poissons_ratio);
    let strength = 6e8;
    let half_space = Spectral::new(grid()?, e_star)?;
    let plain = Subsurface::of(&half_space, poissons_ratio)?;
    let (mut path, history) = pressed(&half_space, e_star)?;
    let whole = plain.first_yield(&mut path, &history, strength)?.unwrap();
    assert_eq!(plain.materials(), 1);
    assert_eq!(plain.first_yields(&mut path, &history, &[strength])?, [Some(whole)]);

    // The greatest stress lies in the second of three.
    let depth = whole.greatest.depth;
    let thicknesses = [0.4 * depth, depth];
    let layers = thicknesses.map(|thickness| (STEEL, thickness));
    let body = layered(&layers, Base::HalfSpace { youngs_modulus, poissons_ratio })?;
    let kernel = Layered::spectral(grid()?, body)?;
    let below = Subsurface::of(&kernel, 0.0)?;
    let (mut path, history) = pressed(&kernel, e_star)?;
    assert_eq!(below.materials(), 3);
    let found = below.first_yields(&mut path, &history, &[strength; 3])?;
    let loads: Vec<f64> = found.iter().flatten().map(|first| first.state.contact.load).collect();
    assert_eq!(loads.len(), 3, "{found:?}");
    // Both are within the tolerance, and the load goes with the cube of the stress.
    let close = |a: f64, b: f64| (a / b - 1.0).abs() < 3.0 * 2.1 * FirstYield::TOLERANCE;
    assert!(close(loads[1], whole.state.contact.load), "{found:?} {whole:?}");
    let ends = [0.0, thicknesses[0], thicknesses[0] + thicknesses[1], 1.5 * HALF];
    for (place, first) in found.into_iter().flatten().enumerate() {
        let pressure = path.fields_at(&first.state)?.pressure;
        let stress = greatest(&plain, &pressure, (ends[place], ends[place + 1]), 100)?;
        // Von Mises' stress varies by itself over some 50 µm: between depths 1 to 3 µm apart a maximum is missed by
        // less than (1.5/50)²/2.
        assert!((stress / strength - 1.0).abs() < 6e-4, "{place}: {stress:e}");
        assert!((ends[place]..=ends[place + 1]).contains(&first.greatest.depth), "{first:?}");
    }
    Ok(())
}

/// A coated sphere: no depth of a material bears more than its yield stress at its own load, and one bears that.
#[test]
fn each_material_of_a_coated_sphere_yields_by_itself() -> Result<(), Error> {
    let thickness = 30e-6;
    let (youngs_modulus, poissons_ratio) = STEEL;
    let body = layered(&[(COAT, thickness)], Base::HalfSpace { youngs_modulus, poissons_ratio })?;
    let kernel = Layered::free(grid()?, body)?;
    let below = Subsurface::of(&kernel, 0.0)?;
    let (mut path, history) = pressed(&kernel, 250e9)?;
    let strengths = [1.2e9, 7e8];
    let spans = [(0.0, thickness), (thickness.next_up(), 1.5 * HALF)];
    let found = below.first_yields(&mut path, &history, &strengths)?;
    for ((first, strength), span) in found.iter().zip(strengths).zip(spans) {
        let first = first.unwrap();
        let pressure = path.fields_at(&first.state)?.pressure;
        let stress = greatest(&below, &pressure, span, 12)?;
        // The tolerance, and what the last of the parabolas misses of the maximum.
        assert!(stress < strength * (1.0 + 1e-3), "{span:?}: {stress:e} {first:?}");
        let there = below.at_depth(&pressure, first.greatest.depth)?.map(Measure::VonMises);
        assert!((there.max() / strength - 1.0).abs() <= FirstYield::TOLERANCE, "{first:?}");
        assert!(first.greatest.depth >= span.0 && first.greatest.depth <= span.1, "{first:?}");
    }
    Ok(())
}

#[test]
fn there_is_one_yield_stress_for_each_material() -> Result<(), Error> {
    let body = layered(&[(COAT, 1e-5), (STEEL, 1e-5)], Base::Rigid)?;
    let kernel = Layered::free(Grid::square(8, 8e-5)?, body)?;
    let below = Subsurface::of(&kernel, 0.0)?;
    // A rigid base does not yield.
    assert_eq!(below.materials(), 2);
    let (mut path, history) = pressed(&kernel, 1e9)?;
    for given in [0, 1, 3] {
        let refused = below.first_yields(&mut path, &history, &vec![1e9; given]);
        let expected = StressError::YieldStresses { given, materials: 2 }.to_string();
        assert_eq!(refused.unwrap_err().to_string(), expected);
    }
    assert_eq!(below.first_yields(&mut path, &history, &[1e15; 2])?, [None, None]);
    let negative = below.first_yields(&mut path, &history, &[1e9, -1.0]);
    assert!(matches!(negative, Err(Error::NotPositive { .. })), "{negative:?}");
    Ok(())
}

/// With a hardness the first yield below the surface is that of the elastic path, if it comes before the first node yields.
/// Behind that it is one of the places at which the stress passes, and where the stress ends below it no answer is certain.
#[test]
fn bodies_that_yield_at_the_surface_too() -> Result<(), Error> {
    let (youngs_modulus, poissons_ratio) = STEEL;
    let e_star = youngs_modulus / (1.0 - poissons_ratio * poissons_ratio);
    let half_space = Spectral::new(grid()?, e_star)?;
    let below = Subsurface::of(&half_space, poissons_ratio)?;
    let (mut path, history) = pressed(&half_space, e_star)?;
    let strength = 6e8;
    let elastic = below.first_yield(&mut path, &history, strength)?;
    let load = elastic.map_or(0.0, |first| first.state.contact.load);
    let last = history.states().last().map_or(0.0, |state| state.contact.load);
    let ball = Paraboloid::new(RADIUS)?;
    let with = |hardness: f64| -> Result<(LoadingSolver, History), Error> {
        let builder = LoadingSolver::builder(&ball, &half_space).hardness(hardness);
        let mut path = builder.max_load(last).build()?;
        let history = path.run()?;
        Ok((path, history))
    };
    let (mut path, history) = with(2e9)?;
    let first = below.first_yield(&mut path, &history, strength)?;
    let found = first.map_or(0.0, |first| first.state.contact.load);
    assert!((found / load - 1.0).abs() < 1e-3, "{found} {load}");
    // The stress is never much above the hardness.
    let (mut path, history) = with(6e8)?;
    let refused = below.first_yield(&mut path, &history, 5.0 * strength);
    let reached = match refused {
        Err(Error::Stress(StressError::BehindHardness { reached, .. })) => reached,
        _ => f64::NAN,
    };
    assert!(reached < strength, "{reached}");
    let passed = below.first_yield(&mut path, &history, 1.001 * reached)?;
    let passed = passed.map_or(0.0, |first| first.greatest.value);
    assert!(
        (passed / (1.001 * reached) - 1.0).abs() < 2.0 * FirstYield::TOLERANCE,
        "{passed} {reached}"
    );
    Ok(())
}
