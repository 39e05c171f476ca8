//! Descents, step by step.

use super::*;
use crate::fixed_load::iterate::Iterate;
use crate::krylov::dot;
use crate::surface::{Amplitude, HeightMap, SelfAffine};
use crate::{Boussinesq, FixedLoadSolver, Grid, Spectral};
use nalgebra::dmatrix;

const CRITERIA: Criteria = Criteria {
    tolerance: 1e-10,
    floor: 0.0,
    length: f64::INFINITY,
    max_iterations: 100,
    verify: true,
};

/// A solution on a rough surface, where half of each pressure is spread evenly over the contact.
fn spread_out() -> Result<(Level, Prescribed), Error> {
    let grid = Grid::square(24, 1.0)?;
    let surface = SelfAffine::new(0.8, 0.5, 0.2, Amplitude::RmsHeight(0.01), 4)?;
    let mut solver = FixedLoadSolver::new(&surface, &Boussinesq::new(grid, 1.0)?)?;
    let solution = solver.solve(0.03)?;
    let mut level = solver.into_finest();
    let total = sum(solution.fields.pressure.as_slice());
    let mean = total / solution.contact.contact_nodes as f64;
    level.choose_contact(|node, _, _| solution.fields.contact_map[node])?;
    for (node, pressure) in level.iterate.pressure.iter_mut().enumerate() {
        let even = if solution.fields.contact_map[node] { mean } else { 0.0 };
        *pressure = 0.5 * (solution.fields.pressure[node] + even);
    }
    level.refresh()?;
    Ok((level, Prescribed::Sum(total)))
}

/// ½ pᵀ C p + gᵀ p.
fn energy(level: &mut Level, pressure: &[f64]) -> Result<f64, Error> {
    level.iterate.pressure.copy_from_slice(pressure);
    level.refresh()?;
    let total_gap = dot(pressure, &level.iterate.total_gap);
    Ok(0.5 * (total_gap + dot(pressure, &level.gap)))
}

/// A step that goes far beyond the minimum of the energy ends at the lowest point of the way; one that does
/// not, at its end.
#[test]
fn a_release_goes_as_far_as_the_energy_falls() -> Result<(), Error> {
    for (overshoot, is_whole) in [(30.0, false), (8.0, false), (1.5, true), (1.0, true)] {
        let (mut level, prescribed) = spread_out()?;
        let begin = level.iterate.pressure.clone();
        let mut descent = Descent::new(&mut level, prescribed, CRITERIA);
        let start = Start {
            pressure: descent.pressure.clone(),
            total_gap: descent.total_gap.clone(),
            approach: descent.approach(),
        };
        // Towards the solution and past it, into tension.
        let mean = sum(&start.pressure) / start.pressure.len() as f64;
        for (x, start) in descent.pressure.iter_mut().zip(&start.pressure) {
            *x = start + overshoot * (start - mean);
        }
        let mut end = descent.pressure.clone();
        let sparse = descent.level.preconditioner.sparse();
        release(sparse, &mut end, &descent.weights, prescribed);
        descent.release(&start)?;
        // The approach is the mean of what lies on the nodes that still carry, by their weights.
        let carrying: Vec<usize> =
            (0..end.len()).filter(|&place| descent.pressure[place] > 0.0).collect();
        let [moment, total] = carrying.iter().fold([0.0; 2], |[moment, total], &place| {
            let weight = descent.weights[place];
            [moment + weight * descent.total_gap[place], total + weight]
        });
        let approach = descent.level.iterate.approach;
        assert!((approach - moment / total).abs() < 1e-13 * approach);
        let reached = level.iterate.pressure.clone();
        let mut whole = begin.clone();
        level.iterate.contact.scatter(&end, &mut whole);
        let lowest = energy(&mut level, &reached)?;
        // Differences of energies are second order in what the step is off by in single precision.
        let rounding = 1e-12 * lowest;
        for k in 0..=50 {
            let part = f64::from(k) / 50.0;
            let on_the_way: Vec<f64> = (begin.iter().zip(&whole))
                .map(|(begin, end)| begin + part * (end - begin))
                .collect();
            let other = energy(&mut level, &on_the_way)?;
            // A whole step is no worse than none.
            if !is_whole || k == 0 {
                assert!(lowest <= other + rounding, "{overshoot}, {part}");
            }
        }
        assert_eq!(reached == whole, is_whole, "{overshoot}");
    }
    Ok(())
}

/// The nodes that lose their pressure first end the way there, and are set free together.
#[test]
fn the_edge_is_where_the_first_pressures_vanish() -> Result<(), Error> {
    let (mut level, prescribed) = spread_out()?;
    let mut descent = Descent::new(&mut level, prescribed, CRITERIA);
    let begin: Vec<f64> = (0..descent.pressure.len()).map(|place| (1 + place % 7) as f64).collect();
    // A quarter and half of the way to the first three, whose pressure would fall; that of the others doubles.
    let change = |place: usize| match place {
        0 | 1 => -4.0,
        2 => -2.0,
        _ => 1.0,
    };
    for (place, x) in descent.pressure.iter_mut().enumerate() {
        *x = begin[place] * (1.0 + change(place));
    }
    let start = Start {
        total_gap: descent.total_gap.clone(),
        approach: descent.approach(),
        pressure: begin.clone(),
    };
    let part = edge(&start.pressure, &descent.pressure);
    descent.stop_at_the_edge(&start, part)?;
    for (place, (x, begin)) in descent.pressure.iter().zip(begin).enumerate() {
        let expected = begin * (1.0 + 0.25 * change(place));
        assert_eq!(*x, expected, "{place}");
    }
    assert_eq!(sum(&descent.pressure), sum(&descent.level.iterate.pressure));
    Ok(())
}

/// Half of the way, a quarter and so on where the energy is no less there, and no less than to the first pressure that
/// vanishes; nodes that lose their pressure on the way are all set free, and the sum stays.
#[test]
fn the_way_down_ends_where_the_energy_is_less() -> Result<(), Error> {
    // The energy is least at 1 and is what it was at 2, a little less far for what is cut off; the first pressure
    // vanishes at 1.04.
    for (overshoot, halvings) in [(1.5, Some(0)), (3.0, Some(1)), (6.0, Some(2)), (1e6, None)] {
        let (mut level, prescribed) = spread_out()?;
        let begin = level.iterate.pressure.clone();
        let mut descent = Descent::new(&mut level, prescribed, CRITERIA);
        let start = Start {
            pressure: descent.pressure.clone(),
            total_gap: descent.total_gap.clone(),
            approach: descent.approach(),
        };
        let mean = sum(&start.pressure) / start.pressure.len() as f64;
        for (x, start) in descent.pressure.iter_mut().zip(&start.pressure) {
            *x = start + overshoot * (start - mean);
        }
        let end = descent.pressure.clone();
        let edge = edge(&start.pressure, &end);
        descent.go_downhill(&start)?;
        let on_the_way = |part: f64| -> Vec<f64> {
            let both = start.pressure.iter().zip(&end);
            both.map(|(from, end)| (from + part * (end - from)).max(0.0)).collect()
        };
        let mut parts = Vec::new();
        if let Some(halvings) = halvings {
            parts.extend((0..=halvings).map(|k| 0.5_f64.powi(k)));
        } else {
            parts.extend((0..MOST_HALVINGS).map(|k| 0.5_f64.powi(k as i32)).chain([edge]));
        }
        let change = descent.energy_since(&start);
        let found = descent.pressure.clone();
        let contact = level.iterate.contact.clone();
        let before = energy(&mut level, &begin)?;
        // Energies are displacements in double precision times pressures.
        let rounding = 1e-12 * before;
        for (k, &part) in parts.iter().enumerate() {
            let mut expected = on_the_way(part);
            if part > edge {
                prescribed.scale(&mut expected);
            }
            let mut everywhere = begin.clone();
            contact.scatter(&expected, &mut everywhere);
            let after = energy(&mut level, &everywhere)?;
            if k + 1 < parts.len() {
                assert!(after >= before, "{overshoot} {part}: {after} {before}");
                continue;
            }
            for (found, expected) in found.iter().zip(&expected) {
                // The first to vanish is zero, and rounds otherwise.
                assert!((found - expected).abs() <= 1e-14 * mean, "{overshoot} {part}");
            }
            assert!(found.contains(&0.0));
            assert!(after < before && (after - before - change).abs() < rounding, "{overshoot}");
        }
    }
    Ok(())
}

/// From a start with tension, too: what the energy says on the way from there is not to the point.
#[test]
fn nodes_with_tension_at_the_start_are_released() -> Result<(), Error> {
    let (mut level, prescribed) = spread_out()?;
    let narrow = level.iterate.contact.len();
    let Iterate { pressure, total_gap, .. } = &level.iterate;
    let wide = 1.3 * dot(pressure, total_gap) / sum(pressure);
    level.choose_contact(|node, _, total_gap| total_gap[node] < wide)?;
    assert!(level.iterate.contact.len() > narrow);
    let mut descent = Descent::new(&mut level, prescribed, CRITERIA);
    let errors = descent.iterate(1e-6, &mut Progress::default())?;
    assert!(errors.tension > 1e6 * descent.tolerance());
    // Beyond the least energy that pressures of any sign have, seen from where there is no tension.
    for x in &mut descent.pressure {
        *x *= if *x < 0.0 { 1.3 } else { 1.0 };
    }
    descent.move_there()?;
    let start = Start {
        pressure: descent.pressure.clone(),
        total_gap: descent.total_gap.clone(),
        approach: descent.approach(),
    };
    descent.release(&start)?;
    assert!(descent.pressure.iter().all(|x| *x >= 0.0));
    Ok(())
}

/// In full contact uniform pressure displaces nothing relative to the mean plane, so that no step answers to a residual
/// that is the same everywhere. Rounding may leave one.
#[test]
fn a_uniform_rounding_takes_no_step() -> Result<(), Error> {
    let grid = Grid::new(1, 4, 1.0, 1.0)?;
    let surface = HeightMap::new(dmatrix![0.0, 1.0, 1.0, 0.0])?;
    let mut level = FixedLoadSolver::new(&surface, &Spectral::new(grid, 1.0)?)?.into_finest();
    // Nothing is below tension at the nodes that lie low.
    level.iterate.pressure.copy_from_slice(&[-1.0, 2.0, 2.0, -1.0]);
    level.iterate.total_gap.fill(0.5);
    level.choose_contact(|_, _, _| true)?;
    let mut descent = Descent::new(&mut level, Prescribed::Sum(2.0), CRITERIA);
    descent.level.iterate.approach = 0.5 + f64::EPSILON;
    let mut progress = Progress::default();
    let errors = descent.iterate(1e-6, &mut progress)?;
    assert_eq!((errors.residual, progress.iterations), (f64::EPSILON, 0));
    assert!(errors.tension > 0.0);
    Ok(())
}
