//! The joint as elements of Jenkins, each with a spring and a slider of its own: another description of the same thing,
//! for any history of approach and displacement.

use asperity::bed::{Bed, BedState};
use asperity::slip::{Friction, PartialSlip, SlipHistory};
use asperity::{Boussinesq, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq};
use asperity_testing::close::relative;
use asperity_testing::surfaces::rough;
use proptest::prelude::*;

use crate::joints::{read, rough_path};

/// A spring in a gap with a slider: normal force k_n (δ − gap), tangential one at most μ times that.
struct Element {
    stiffness: f64,
    gap: f64,
    /// Tangential force.
    force: f64,
}

/// Independent elements under a common approach and a common displacement, both linear in a step.
struct Elements {
    elements: Vec<Element>,
    friction: Friction,
    approach: f64,
    displacement: f64,
    dissipation: f64,
}

impl Elements {
    fn new(bed: &Bed, friction: Friction) -> Self {
        let elements = bed.springs().map(|spring| Element {
            stiffness: spring.stiffness,
            gap: spring.gap,
            force: 0.0,
        });
        Self {
            elements: elements.collect(),
            friction,
            approach: 0.0,
            displacement: 0.0,
            dissipation: 0.0,
        }
    }

    /// Returns the tangential force.
    fn to(&mut self, approach: f64, displacement: f64) -> f64 {
        let (mu, ratio) = (self.friction.coefficient(), self.friction.compliance_ratio());
        let (rise, shift) = (approach - self.approach, displacement - self.displacement);
        let mut sum = 0.0;
        for element in &mut self.elements {
            let [before, now] = [self.approach, approach]
                .map(|a| mu * element.stiffness * (a - element.gap).max(0.0));
            // An element that touches within the step is dragged for the rest of it.
            let part =
                if rise > 0.0 { ((approach - element.gap) / rise).clamp(0.0, 1.0) } else { 1.0 };
            let dragged = element.force + element.stiffness / ratio * part * shift;
            let force = dragged.clamp(-now, now);
            // What the slider gives way, under a limit that changes linearly.
            let slip = (dragged - force) / (element.stiffness / ratio);
            self.dissipation += 0.5 * (before + now) * slip.abs();
            element.force = force;
            sum += force;
        }
        (self.approach, self.displacement) = (approach, displacement);
        sum
    }
}

/// Both descriptions through corners (P, T), stopping at the events on the way; how far tangential loads differ over
/// μP, and dissipations over the whole.
fn compare(bed: &Bed, friction: Friction, corners: &[(f64, f64)], fine: usize) -> (f64, f64) {
    let mut joint = SlipHistory::new(bed, friction);
    let mut elements = Elements::new(bed, friction);
    let mut at = (0.0_f64, 0.0_f64);
    let mut worst = 0.0_f64;
    let greatest = corners.iter().fold(0.0_f64, |most, corner| most.max(corner.0));
    for &(load, force) in corners {
        let (least, most) = (at.0.min(load), at.0.max(load));
        let mut stops: Vec<f64> = bed
            .loads()
            .iter()
            .copied()
            .filter(|knot| (least..most).contains(knot))
            .chain([least, most])
            .collect();
        stops.sort_by(f64::total_cmp);
        if load < at.0 {
            stops.reverse();
        }
        let mut shares: Vec<f64> = if load == at.0 {
            vec![0.0, 1.0]
        } else {
            stops.iter().map(|stop| (stop - at.0) / (load - at.0)).collect()
        };
        shares.dedup();
        for ends in shares.windows(2) {
            for part in 1..=fine {
                let share = ends[0] + (ends[1] - ends[0]) * part as f64 / fine as f64;
                let (p, t) = (at.0 + share * (load - at.0), at.1 + share * (force - at.1));
                let state = joint.to(p, t).unwrap();
                let approach = bed.at_load(p).unwrap().approach;
                let sum = elements.to(approach, state.displacement);
                worst = worst.max((sum - t).abs() / (friction.coefficient() * greatest));
            }
        }
        at = (load, force);
    }
    let lost = joint.dissipation();
    // Where hardly anything is lost, a part of all that could be.
    let all = bed.at_load(greatest).unwrap().energy * friction.coefficient().powi(2);
    let scale = lost.max(1e-2 * all);
    (worst, (elements.dissipation - lost).abs() / scale)
}

fn kernels() -> [Box<dyn InfluenceKernel>; 2] {
    let grid = Grid::new(16, 14, 1.0, 2.0).unwrap();
    [
        Box::new(Boussinesq::new(grid, 3.0).unwrap()),
        Box::new(PeriodicBoussinesq::new(grid, 3.0).unwrap()),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Random histories of both loads, on a free and on a periodic half-space.
    #[test]
    fn random_histories_are_those_of_the_elements(
        seed in 0_u64..1000,
        steps in prop::collection::vec((0.05..1.0_f64, -0.97..0.97_f64, any::<bool>()), 2..12),
    ) {
        for kernel in kernels() {
            let (_, history) = rough_path(kernel.as_ref(), seed, 0.6);
            let bed = Bed::new(&history).unwrap();
            let friction = Friction::new(0.35, 1.25).unwrap();
            let mut load = 0.5 * bed.last_load();
            let corners: Vec<(f64, f64)> = steps.iter().map(|&(p, t, moves)| {
                if moves {
                    load = p * bed.last_load();
                }
                (load, 0.35 * load * t)
            }).collect();
            let mut all = vec![(0.5 * bed.last_load(), 0.0)];
            all.extend(corners);
            let (force, _) = compare(&bed, friction, &all, 1);
            // Sums over 134 elements, through up to 1000 steps.
            prop_assert!(force < 1e-11, "{force:e}");
            // Where the load changes the elements' own account is of second order in the step: a tenth of what is lost
            // in steps from event to event, at worst, and a sixteenth of that in quarters of them.
            let (_, lost) = compare(&bed, friction, &all, 4);
            prop_assert!(lost < 0.02, "{lost:e}");
        }
    }
}

/// Where a load changes by its last digit, or a little more, and the tangential load by most of what friction bears:
/// the joint is that of a constant load, to what P changes by.
#[test]
fn loads_that_hardly_change_are_constant() {
    for kernel in kernels() {
        let (_, history) = rough_path(kernel.as_ref(), 741, 0.6);
        let bed = Bed::new(&history).unwrap();
        let friction = Friction::new(0.35, 1.25).unwrap();
        let load = 0.44 * bed.last_load();
        let limit = 0.35 * load;
        // First loading, and a joint with slip of both signs.
        for before in [&[0.0][..], &[0.6, -0.3, 0.1]] {
            let follow = |near: f64| {
                let mut joint = SlipHistory::new(&bed, friction);
                joint.to(0.94 * bed.last_load(), 0.0).unwrap();
                for force in before {
                    joint.to(near, force * limit).unwrap();
                }
                joint.to(load, 0.94 * limit).unwrap()
            };
            let constant = follow(load);
            for (near, error) in [
                (load.next_down(), 1e-13),
                (load.next_up(), 1e-13),
                (load * (1.0 + 1e-12), 1e-11),
                (load * (1.0 - 1e-12), 1e-11),
                (load * (1.0 + 1e-9), 1e-8),
                (load * (1.0 - 1e-9), 1e-8),
            ] {
                let found = follow(near);
                // The force is what was asked for, whatever the step.
                assert!(relative(found.tangential_load, 0.94 * limit) < 1e-13, "{near}: {found:?}");
                assert!(
                    relative(found.displacement, constant.displacement) < error,
                    "{near}: {found:?}"
                );
                assert_eq!(found.stick_nodes, constant.stick_nodes);
            }
        }
    }
}

/// At constant load the account of the elements is exact, and where the load changes it converges to the joint's by the
/// second order.
#[test]
fn dissipations_converge_to_the_joint_s() {
    let [kernel, _] = kernels();
    let (_, history) = rough_path(kernel.as_ref(), 5, 0.6);
    let bed = Bed::new(&history).unwrap();
    let friction = Friction::new(0.35, 1.25).unwrap();
    let (load, limit) = (0.6 * bed.last_load(), 0.35 * 0.6 * bed.last_load());
    let constant = [(load, 0.0), (load, 0.9 * limit), (load, -0.7 * limit), (load, 0.2 * limit)];
    let (_, lost) = compare(&bed, friction, &constant, 1);
    assert!(lost < 1e-12, "{lost:e}");
    let both = [
        (load, 0.0),
        (1.4 * load, 0.9 * limit),
        (0.7 * load, -0.5 * limit),
        (0.8 * load, 0.6 * limit),
        (0.4 * load, 0.0),
    ];
    let errors = [1, 2, 4].map(|fine| compare(&bed, friction, &both, fine).1);
    assert!(errors[2] < 2e-3, "{errors:?}");
    for pair in errors.windows(2) {
        // 4 for steps that are small against the distance of events.
        assert!(pair[0] / pair[1] > 2.5, "{errors:?}");
    }
}

/// Their sums are the stiffness and the limit of friction, and their losses those of the cycle.
#[test]
fn elements_add_up_to_the_joint() {
    for kernel in kernels() {
        let (_, history) = rough_path(kernel.as_ref(), 3, 0.7);
        let bed = Bed::new(&history).unwrap();
        let friction = Friction::new(0.2, 1.1).unwrap();
        let load = 0.8 * bed.last_load();
        let joint = PartialSlip::new(&bed, load, friction).unwrap();
        let elements: Vec<_> = joint.jenkins_elements().collect();
        let BedState { contact_nodes, stiffness, .. } = joint.preload();
        assert_eq!(elements.len(), contact_nodes);
        assert!(elements.iter().all(|element| element.stiffness > 0.0));
        let sum: f64 = elements.iter().map(|element| element.stiffness).sum();
        // Sums of 150 terms of one sign, made of differences of stiffnesses.
        assert!(relative(sum, stiffness / 1.1) < 1e-12);
        let sum: f64 = elements.iter().map(|element| element.slip_force()).sum();
        assert!(relative(sum, joint.sliding_load()) < 1e-12);
        for share in [0.05, 0.2, 0.5, 0.9, 1.0] {
            let cycle = joint.cycle(share * joint.sliding_load()).unwrap();
            let lost: f64 =
                elements.iter().map(|element| element.dissipation(cycle.displacement)).sum();
            let slips = elements
                .iter()
                .filter(|e| e.slip_displacement <= (1.0 + 1e-12) * cycle.displacement);
            assert_eq!(slips.count(), cycle.slipping_nodes);
            // Rounding of the approach times the amplitude.
            let rounding = 1e-14 * cycle.amplitude * joint.sliding_displacement();
            let error = (lost - cycle.dissipation).abs();
            assert!(error < rounding, "{share}: {error:e} of {lost:e}");
        }
    }
}

/// In full contact of a periodic half-space the last node makes the joint rigid. The others bear what friction bears of
/// the load of the path; what there is beyond it slips first, so that it loses 4 T U of its own limit T.
#[test]
fn full_contact_slips_rigidly_at_first() {
    let [_, kernel] = kernels();
    let surface = rough(&kernel.grid(), 3);
    let (_, history) = read(LoadingSolver::builder(&surface, kernel.as_ref()));
    let bed = Bed::new(&history).unwrap();
    let (nodes, full) = (kernel.grid().nodes(), bed.last_load());
    assert_eq!((bed.loads().len(), bed.is_full()), (nodes, true));
    let (mu, ratio) = (0.2, 1.1);
    for load in [full, 1.3 * full] {
        let joint = PartialSlip::new(&bed, load, Friction::new(mu, ratio).unwrap()).unwrap();
        let elements: Vec<_> = joint.jenkins_elements().collect();
        assert_eq!(elements.len(), nodes - 1);
        let sum: f64 = elements.iter().map(|element| element.stiffness).sum();
        assert!(relative(sum, bed.stiffnesses()[nodes - 2] / ratio) < 1e-12);
        let sum: f64 = elements.iter().map(|element| element.slip_force()).sum();
        // Approaches are right to 1e-13, and the stiffnesses of the last nodes are hundreds of times the mean one.
        assert!(relative(sum, mu * full) < 1e-10, "{sum} {full}");
        for share in [0.1, 0.5, 0.9, 1.0] {
            let cycle = joint.cycle(share * joint.sliding_load()).unwrap();
            let lost = elements.iter().map(|element| element.dissipation(cycle.displacement));
            let lost = lost.sum::<f64>() + 4.0 * mu * (load - full) * cycle.displacement;
            let error = (lost - cycle.dissipation).abs();
            let scale = joint.sliding_load() * joint.sliding_displacement();
            assert!(error < 1e-10 * scale, "{share}: {error:e} of {lost:e}");
            let is_rigid = share * load < load - full;
            assert_eq!(cycle.secant_stiffness == f64::INFINITY, is_rigid, "{share}: {cycle:?}");
        }
    }
}
