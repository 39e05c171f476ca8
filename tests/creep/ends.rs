//! The bed exactly at the end of its path, and in full contact of a periodic half-space.

use asperity::bed::Bed;
use asperity::creep::{
    Control, ControlHistory, Creep, PiecewiseLinear, Relaxation, Steps, ViscoelasticBed,
};
use asperity::loading::History;
use asperity::surface::HeightMap;
use asperity::{
    Boussinesq, CreepError, Error, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq,
    Spectral,
};
use nalgebra::DMatrix;

use crate::growing::{case, solid};
use crate::stepping::rough;

/// Exactly at its end a path has its last node in contact, and those that touch together with it, in one step or in
/// some, up or down: as in closed form.
#[test]
fn the_last_nodes_touch_at_the_end_of_a_path() {
    let grid = Grid::square(8, 1.0).unwrap();
    // Four or eight nodes of this one touch at a time.
    let bowl = HeightMap::new(DMatrix::from_fn(8, 8, |ix, iy| {
        -0.01 * ((ix as f64 - 3.5).powi(2) + (iy as f64 - 3.5).powi(2))
    }));
    let surfaces = [rough(&grid, 4), bowl.unwrap()];
    let kernels: [Box<dyn InfluenceKernel>; 3] = [
        Box::new(Boussinesq::new(grid, 1.0).unwrap()),
        Box::new(PeriodicBoussinesq::new(grid, 1.0).unwrap()),
        Box::new(Spectral::new(grid, 1.0).unwrap()),
    ];
    let mut tied = 0;
    for (surface, kernel) in surfaces.iter().flat_map(|s| kernels.iter().map(move |k| (s, k))) {
        let mut path = LoadingSolver::builder(surface, &**kernel).build().unwrap();
        let all = path.run().unwrap();
        for count in [8, 12, 31, 60, 64] {
            let history: History = all.states()[..count].iter().copied().collect();
            let bed = Bed::new(&history).unwrap();
            let (last, end) = (bed.last_load(), bed.approaches()[count - 1]);
            tied += usize::from(bed.loads()[count - 2] == last);
            let creep = Creep::new(&bed, &solid(), &PiecewiseLinear::step(last).unwrap()).unwrap();
            let expected = creep.at(0.0).unwrap();
            assert_eq!(expected.contact_nodes, count);
            // The load goes with the approach times the stiffness, of which the compression rounds.
            let interval = bed.loads().partition_point(|load| *load < last) - 1;
            let advance = end - bed.approaches()[interval];
            let stiffness = (last - bed.loads()[interval]) / advance;
            let rounding = 1e-14 * (stiffness * end / last).max(1.0);
            for parts in [&[1.0][..], &[0.37, 1.0], &[1.0, 0.61, 1.0], &[0.9, 0.2, 0.6, 1.0, 1.0]] {
                for of in [Control::Load, Control::Approach] {
                    let value = if of(1.0) == Control::Load(1.0) { last } else { end };
                    let mut contact = ViscoelasticBed::new(&bed, &solid()).unwrap();
                    for part in parts {
                        contact.step(0.0, of(part * value)).unwrap();
                    }
                    let found = contact.state();
                    let context = format!("{count} {parts:?}: {found:?} {expected:?}");
                    assert_eq!(
                        (found.contact_nodes, found.contact_area, found.contact_area_fraction),
                        (
                            expected.contact_nodes,
                            expected.contact_area,
                            expected.contact_area_fraction
                        ),
                        "{context}"
                    );
                    // Sums of 64 terms.
                    let gap = (found.mean_gap - expected.mean_gap).abs() / bed.mean_gaps()[0];
                    let approach = (found.approach / expected.approach - 1.0).abs();
                    assert!(approach < 1e-13 && gap < 1e-13, "{context}");
                    let load = (found.load / last - 1.0).abs();
                    assert!(load < rounding.max(1e-13), "{load:e} {rounding:e} {context}");
                }
            }
            // Less by a millionth, the last is not in contact yet.
            let mut contact = ViscoelasticBed::new(&bed, &solid()).unwrap();
            let state = contact.step(0.0, Control::Load((1.0 - 1e-6) * last)).unwrap();
            let before = bed.at_load((1.0 - 1e-6) * last).unwrap().contact_nodes;
            assert_eq!(state.contact_nodes, before);
            assert!(before < count);
        }
    }
    assert!(tied >= 6, "{tied}");
}

/// The last approach of full contact on a periodic half-space is that under any more load; held, it relaxes as in
/// closed form, and less of it lets nodes go.
#[test]
fn the_approach_of_full_contact_may_be_held() {
    let grid = Grid::square(8, 1.0).unwrap();
    for seed in 1..=4 {
        let kernels: [Box<dyn InfluenceKernel>; 2] = [
            Box::new(PeriodicBoussinesq::new(grid, 1.0).unwrap()),
            Box::new(Spectral::new(grid, 1.0).unwrap()),
        ];
        for kernel in kernels {
            let case = case(kernel, seed);
            let bed = Bed::new(&case.history).unwrap();
            let (last, end) = (bed.last_load(), bed.approaches()[63]);
            let corners = [(0.0, 0.0), (0.0, end), (1.0, end), (1.0, 0.5 * end), (2.0, 0.5 * end)];
            let corners = PiecewiseLinear::new(corners).unwrap();
            let times = Steps::default().times(&solid(), &corners, 2.0).unwrap();
            let course = ControlHistory::Approach(corners);
            let mut contact = ViscoelasticBed::new(&bed, &solid()).unwrap();
            let states = contact.follow(&course, &times).unwrap();
            let held = PiecewiseLinear::step(end).unwrap();
            let relaxation = Relaxation::new(&bed, &solid(), &held).unwrap();
            for state in states {
                if state.time >= 1.0 {
                    assert!(state.contact_nodes < 64 && state.approach == 0.5 * end, "{state:?}");
                    continue;
                }
                assert_eq!((state.contact_nodes, state.contact_area_fraction), (64, 1.0));
                assert!(state.approach == end && state.mean_gap.abs() < 1e-13 * end);
                let expected = relaxation.at(state.time).unwrap().load;
                // Twice the 10⁻⁴ that default steps leave.
                assert!((state.load / expected - 1.0).abs() < 2e-4, "{state:?} {expected}");
            }
            // From any more load to the least, which is that of the path at first.
            let mut contact = ViscoelasticBed::new(&bed, &solid()).unwrap();
            let pressed = contact.step(0.0, Control::Load(5.0 * last)).unwrap();
            let state = contact.step(0.0, Control::Approach(pressed.approach)).unwrap();
            assert!((state.load / last - 1.0).abs() < 1e-12, "{state:?}");
            let mut before = f64::INFINITY;
            contact.step(0.3, Control::Load(20.0 * last)).unwrap();
            for _ in 0..20 {
                let state = contact.step(0.1, Control::Approach(pressed.approach)).unwrap();
                assert_eq!(state.contact_nodes, 64);
                assert!(state.mean_gap.abs() < 1e-13 * end && state.load < before.min(last));
                before = state.load;
            }
            let refused = contact.step(0.1, Control::Approach(1.001 * end));
            assert!(matches!(refused, Err(Error::Creep(CreepError::BedEnds { .. }))));
        }
    }
}
