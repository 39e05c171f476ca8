//! Depths that are chosen, and the load of first yield.

use asperity::kernel::{Base, Layer, Layered, LayeredBody};
use asperity::loading::History;
use asperity::stress::{FirstYield, Measure, Subsurface};
use asperity::surface::Paraboloid;
use asperity::{Boundary, Boussinesq, Error, Grid, LoadingSolver};
use nalgebra::DMatrix;

use super::hertz;

#[test]
fn depths_reach_from_a_tenth_of_a_cell_to_a_patch() -> Result<(), Error> {
    let grid = Grid::square(32, 32e-6)?;
    let body = Subsurface::new(grid, Boundary::Free, 0.3)?;
    // Patches of one node and of twelve.
    let is_in = |ix, iy| (ix, iy) == (30, 30) || ((5..9).contains(&ix) && (8..11).contains(&iy));
    let pressure = DMatrix::from_fn(32, 32, |ix, iy| if is_in(ix, iy) { 1e9 } else { 0.0 });
    let depths = body.depths(&pressure)?;
    assert_eq!(depths[0], 0.0);
    assert!((depths[1] / 1e-7 - 1.0).abs() < 1e-12);
    let diameter = 2.0 * (12e-12 / std::f64::consts::PI).sqrt();
    let deepest = depths.last().unwrap();
    assert!(*deepest > 0.85 * diameter && *deepest < 1.2 * diameter, "{deepest}");
    for pair in depths[1..].windows(2) {
        assert!((pair[1] / pair[0] - 1.25).abs() < 1e-12);
    }
    // Given ones are taken as they are, in order of depth.
    let survey = body.survey(&pressure, Some(&[2e-6, 0.0, 1e-6]))?;
    let found: Vec<f64> = survey.depths.iter().map(|depth| depth.depth).collect();
    assert_eq!(found, [0.0, 1e-6, 2e-6]);
    Ok(())
}

/// A line contact on a strip that repeats along its short side: its patch is far longer than its area says, and the
/// greatest stresses lie at half of its width, behind others at the surface.
#[test]
fn line_contacts_on_strips_are_looked_at_to_their_width() -> Result<(), Error> {
    let nodes = 128;
    for (boundary, shape) in [(Boundary::PeriodicY, (nodes, 1)), (Boundary::PeriodicX, (1, nodes))]
    {
        let cell = 2.5 / nodes as f64;
        let grid = Grid::new(shape.0, shape.1, cell, cell)?;
        // Half a width of 1, as Hertz has it.
        let pressure = DMatrix::from_fn(shape.0, shape.1, |ix, iy| {
            let y = (ix.max(iy) as f64 + 0.5) * cell - 1.25;
            (1.0 - y * y).max(0.0).sqrt()
        });
        for (poissons_ratio, friction) in [(0.25, 0.1), (0.3, 0.25), (0.25, 0.0)] {
            let angle = if shape.0 > 1 { 0.0 } else { std::f64::consts::FRAC_PI_2 };
            let body = Subsurface::new(grid, boundary, poissons_ratio)?.sliding(friction, angle)?;
            let found = body.survey(&pressure, None)?;
            let everywhere: Vec<f64> = (0..=60).map(|k| 0.025 * f64::from(k)).collect();
            let all = body.survey(&pressure, Some(&everywhere))?;
            for measure in [Measure::VonMises, Measure::GreatestShear] {
                let [found, all] = [&found, &all].map(|survey| survey.greatest(measure));
                // Depths 0.025 apart miss a vertex by some 1e-4 of it.
                assert!(found.value > 0.999 * all.value, "{found:?} {all:?}");
            }
            let shear = found.greatest(Measure::GreatestShear);
            // Hertz: 0.3003 at 0.786.
            if friction == 0.0 {
                assert!((shear.value / 0.3003 - 1.0).abs() < 2e-3, "{shear:?}");
                assert!((shear.depth - 0.786).abs() < 0.02, "{shear:?}");
            }
        }
    }
    Ok(())
}

/// Where many small patches press together, the greatest stress may lie deeper than any of them is wide: depths go on
/// until it is found.
#[test]
fn what_lies_deep_is_found() -> Result<(), Error> {
    // Hertz' pressure in patches of nine cells, with slits of one between them: below 0.81 of it, and at the slits,
    // where the pressure is what it was, less von Mises' stress than that.
    let (grid, smooth) = hertz(30, 32);
    let pressure =
        smooth.map_with_location(|ix, iy, p| if ix % 10 == 7 || iy % 10 == 7 { 0.0 } else { p });
    let body = Subsurface::new(grid, Boundary::Free, 0.3)?;
    let first = *body.depths(&pressure)?.last().unwrap();
    let found = body.survey(&pressure, None)?;
    let everywhere: Vec<f64> = (1..=60).map(|k| 0.015 * f64::from(k)).collect();
    let all = body.survey(&pressure, Some(&everywhere))?;
    for measure in [Measure::VonMises, Measure::GreatestShear] {
        let [found, all] = [&found, &all].map(|survey| survey.greatest(measure));
        println!("{found:?} {all:?}, first {first}");
        assert!(found.depth > first && all.depth > first, "{found:?} {all:?} {first}");
        // Depths 0.015 apart miss a vertex by 10⁻⁴ of it.
        assert!(found.value > 0.9995 * all.value, "{found:?} {all:?}");
    }
    // It lies within what was looked at.
    assert!(found.depths.last().unwrap().depth > found.greatest(Measure::VonMises).depth);
    Ok(())
}

/// Where patches are small, the greatest stress may be theirs; and every depth of a survey has that of all nodes.
#[test]
fn depths_have_the_greatest_of_all_nodes() -> Result<(), Error> {
    // Every second node of a Hertzian pressure of the same load: nodes are patches.
    let (grid, smooth) = hertz(10, 12);
    let pressure =
        smooth.map_with_location(|ix, iy, p| if (ix + iy) % 2 == 0 { 0.0 } else { 2.0 * p });
    let body = Subsurface::new(grid, Boundary::Free, 0.3)?;
    let survey = body.survey(&smooth, None)?;
    let deepest = survey.depths.last().unwrap().depth;
    assert!(deepest > survey.greatest(Measure::VonMises).depth);
    let spots = body.survey(&pressure, None)?;
    // The spots themselves yield first, and nothing deeper is more: the depths are those of patches that touch at
    // corners.
    assert!(spots.greatest(Measure::VonMises).value > survey.greatest(Measure::VonMises).value);
    // The load is that of all depths and measures the greatest of all nodes.
    for depth in &survey.depths {
        let field = body.at_depth(&smooth, depth.depth)?;
        for measure in Measure::ALL {
            let greatest = depth.greatest(measure);
            let map = field.map(measure);
            assert_eq!(greatest.value, map.max());
            assert_eq!(greatest.value, map[greatest.node]);
        }
    }
    Ok(())
}

/// A survey hands over every field that it has, once; its depths are those of the materials one after the other, of
/// which an interface belongs to the upper one; and an error of who looks at them ends it.
#[test]
fn surveys_are_made_of_materials() -> Result<(), Error> {
    let (grid, pressure) = hertz(4, 8);
    let layer =
        |youngs_modulus, thickness| Layer { youngs_modulus, poissons_ratio: 0.3, thickness };
    let base = Base::HalfSpace { youngs_modulus: 1.0, poissons_ratio: 0.3 };
    let layers = LayeredBody::new(&[layer(3.0, 0.3), layer(0.5, 0.4)], base)?;
    let body = Subsurface::of(&Layered::free(grid, layers)?, 0.3)?;
    let mut seen = Vec::new();
    let survey = body.survey_with(&pressure, None, |field| {
        seen.push((field.depth, field.map(Measure::VonMises).max()));
        Ok::<(), Error>(())
    })?;
    seen.sort_by(|a, b| a.0.total_cmp(&b.0));
    let of = |depth: &asperity::stress::DepthSurvey| {
        (depth.depth, depth.greatest(Measure::VonMises).value)
    };
    assert_eq!(seen, survey.depths.iter().map(of).collect::<Vec<_>>());
    let parts = body.by_material(&survey);
    assert_eq!(parts.len(), 3);
    let together: Vec<_> = parts.iter().flat_map(|part| &part.depths).map(of).collect();
    assert_eq!(together, seen);
    let second = 0.3 + 0.4;
    for (part, (above, below)) in
        parts.iter().zip([(-1.0, 0.3), (0.3, second), (second, f64::INFINITY)])
    {
        let is_within = |depth: f64| depth > above && depth <= below;
        assert!(part.depths.iter().all(|depth| is_within(depth.depth)), "{above} {below}");
        // Each is looked at around its own greatest stress.
        assert!(part.depths.len() > 5, "{}", part.depths.len());
    }
    let greatest = parts.iter().map(|part| part.greatest(Measure::VonMises).value);
    assert_eq!(greatest.fold(0.0, f64::max), survey.greatest(Measure::VonMises).value);
    // None was looked at in the second one.
    let few = body.by_material(&body.survey(&pressure, Some(&[0.3, 2.0]))?);
    assert_eq!(few.iter().map(|part| part.depths.len()).collect::<Vec<_>>(), [1, 0, 1]);
    let mut looked_at = 0;
    let ended = body.survey_with(&pressure, None, |_| {
        looked_at += 1;
        Err(Error::NotFinite { step: 7 })
    });
    assert!(matches!(ended, Err(Error::NotFinite { step: 7 })) && looked_at == 1);
    Ok(())
}

/// A sphere begins to yield where 0.620 p₀ is the yield stress, under (π³ R² / 6 E*²) (Y / 0.620)³.
#[test]
fn a_sphere_begins_to_yield() -> Result<(), Error> {
    let (radius, e_star, strength) = (10e-3, 115e9, 1e9);
    let p0: f64 = strength / 0.620;
    let load =
        std::f64::consts::PI.powi(3) * radius * radius / (6.0 * e_star * e_star) * p0.powi(3);
    let a = 0.5 * std::f64::consts::PI * p0 * radius / e_star;
    let half_space = Boussinesq::new(Grid::square(41, 2.6 * a)?, e_star)?;
    let mut path = LoadingSolver::builder(&Paraboloid::new(radius)?, &half_space)
        .max_load(1.3 * load)
        .build()?;
    let history = path.run()?;
    let body = Subsurface::of(&half_space, 0.3)?;
    let found = body.first_yield(&mut path, &history, strength)?.unwrap();
    assert!((found.greatest.value / strength - 1.0).abs() <= FirstYield::TOLERANCE);
    // Fifteen cells in the radius: 1 % of the stress is 3 % of the load.
    assert!((found.state.contact.load / load - 1.0).abs() < 0.03, "{found:?} {load}");
    assert!((found.greatest.depth / a - 0.481).abs() < 0.02, "{found:?} {a}");
    assert!(body.first_yield(&mut path, &history, 1.2 * strength)?.is_none());
    assert!(body.first_yield(&mut path, &history, 0.0).is_err());
    assert!(body.first_yield(&mut path, &History::default(), strength)?.is_none());
    Ok(())
}

/// What ParaView reads: a header, and arrays of which x runs fastest, then y, then z.
#[test]
fn a_volume_has_all_depths() -> Result<(), Error> {
    let grid = Grid::new(5, 4, 1.0, 2.0)?;
    let body = Subsurface::new(grid, Boundary::Free, 0.3)?;
    let pressure = DMatrix::from_fn(5, 4, |ix, iy| (ix * iy) as f64);
    let file = std::env::temp_dir().join(format!("asperity-volume-{}.vti", std::process::id()));
    let mut seen = Vec::new();
    body.write_volume(&pressure, (0.5, 3), &file, |field| seen.push(field.clone()))?;
    let bytes = std::fs::read(&file).unwrap();
    assert_eq!(seen.iter().map(|field| field.depth).collect::<Vec<_>>(), [0.0, 0.5, 1.0]);
    let find =
        |text: &str| bytes.windows(text.len()).position(|part| part == text.as_bytes()).unwrap();
    let header = String::from_utf8(bytes[..find("<AppendedData")].to_vec()).unwrap();
    for said in ["WholeExtent=\"0 4 0 3 0 2\"", "Origin=\"5e-1 1e0 0\"", "Spacing=\"1e0 2e0 5e-1\""]
    {
        assert!(header.contains(said), "{header}");
    }
    let first =
        find("<AppendedData encoding=\"raw\">\n_") + "<AppendedData encoding=\"raw\">\n_".len();
    let offset = |name: &str| -> usize {
        let rest = header.split(&format!("Name=\"{name}\"")).nth(1).unwrap();
        rest.split("offset=\"").nth(1).unwrap().split('"').next().unwrap().parse().unwrap()
    };
    let float = |at: usize| f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    for (name, width) in
        [("von_mises", 1), ("greatest_shear", 1), ("greatest_tension", 1), ("stress", 6)]
    {
        let start = first + offset(name);
        let length = u64::from_le_bytes(bytes[start..start + 8].try_into().unwrap());
        assert_eq!(length, 4 * 60 * width as u64, "{name}");
        for (k, field) in seen.iter().enumerate() {
            for node in 0..20 {
                let stress = field.at(node).unwrap();
                let measure = Measure::ALL.iter().find(|measure| measure.name() == name);
                let expected = match measure {
                    Some(measure) => vec![stress.measure(*measure)],
                    None => vec![stress.xx, stress.yy, stress.zz, stress.xy, stress.yz, stress.xz],
                };
                for (c, expected) in expected.into_iter().enumerate() {
                    let found = float(start + 8 + 4 * (width * (node + 20 * k) + c));
                    assert_eq!(found, expected as f32, "{name} {k} {node} {c}");
                }
            }
        }
    }
    assert!(bytes.ends_with(b"\n  </AppendedData>\n</VTKFile>\n"));
    for (step, count) in [(0.0, 3), (0.5, 0), (f64::NAN, 1), (0.5, usize::MAX)] {
        assert!(body.write_volume(&pressure, (step, count), &file, |_| ()).is_err());
    }
    std::fs::remove_file(&file).unwrap();
    let refused = body.write_volume(&DMatrix::zeros(1, 1), (0.5, 3), &file, |_| ());
    assert!(matches!(refused, Err(Error::GridMismatch { .. })), "{refused:?}");
    assert!(!file.exists());
    Ok(())
}
