//! Single loads, and other targets, without the path to them.

use asperity::{
    ContactTarget, Error, FixedLoadSolution, FixedLoadSolver, InfluenceKernel, PeriodicBoussinesq,
};

use crate::dense::Dense;
use crate::draw::Draw;
use crate::judge::{Judge, Settings};
use crate::kernels;
use crate::problem::Sample;
use crate::refusal::Circumstances;
use crate::variant::{Run, Variant};
use crate::verdict::{Tally, Verdict, Violation};

/// More than the default: where nodes have to join one by one on bodies that promise nothing, some ten thousand are
/// needed.
const MOST_ITERATIONS: usize = 50_000;

/// Nodes of a side and of a grid. Two coarser grids are made of a side above 32, one above 16.
const LONGEST_SIDE: usize = 48;
const MOST_NODES: usize = 600;

/// Draws a contact problem and solves it for several loads, approaches, areas and mean gaps, from nothing, from other
/// solutions and in sweeps. Every solution is checked densely against the tolerance and compared with the path.
///
/// # Errors
///
/// What is wrong.
pub fn fixed_loads(bytes: &[u8]) -> Verdict {
    let mut draw = Draw::new(bytes);
    Sample::look(&mut draw, kernels::DEFINITE, |sample, draw| run(sample, draw))
}

/// The same on more nodes of a half-space, so that solutions start on coarser grids.
///
/// # Errors
///
/// What is wrong.
pub fn large_loads(bytes: &[u8]) -> Verdict {
    let mut draw = Draw::new(bytes);
    let nx = draw.whole(2, LONGEST_SIDE);
    let ny = draw.whole(2, LONGEST_SIDE.min(MOST_NODES / nx));
    let sample = Sample::half_space(&mut draw, (nx, ny), PeriodicBoussinesq::MAX_ASPECT)?;
    run(&sample, &mut draw).map_err(|violation| violation.during(sample.context()))
}

fn run(sample: &Sample, draw: &mut Draw<'_>) -> Verdict {
    let dense = Dense::new(&sample.kernel, sample.surface.matrix()).in_computing_gauge();
    let circumstances = Circumstances::of(&dense, sample.kernel.contact_growth());
    let path = Variant::REFERENCE.run(sample, &[], |_, _| Ok(()))?;
    let Run::Followed { states, failure: None, .. } = path else {
        // It is the driver of paths that asks why.
        return Ok(Tally::default());
    };
    let settings = Settings {
        tolerance: 10_f64.powf(draw.mostly(-12.0, -3.0, -1.0)),
        nested: !draw.once_in(3),
        stiffness: !draw.once_in(3),
    };
    let solver = FixedLoadSolver::builder(&sample.surface, &sample.kernel)
        .tolerance(settings.tolerance)
        .nested(settings.nested)
        .stiffness(settings.stiffness)
        .max_iterations(MOST_ITERATIONS)
        .build();
    let mut solver = match solver {
        Ok(solver) => solver,
        // Cells so long that iterations come to no answer.
        Err(Error::OutOfRange { value, .. }) if value > PeriodicBoussinesq::MAX_ASPECT => {
            return Ok(Tally::refusal());
        }
        Err(error) => return Err(Violation::new(format!("{settings:?} was refused: {error}"))),
    };
    let judge = Judge {
        dense,
        grid: sample.kernel.grid(),
        history: states.into_iter().collect(),
        circumstances,
        settings,
    };
    let mut tally = Tally::default();
    let mut last: Option<FixedLoadSolution> = None;
    for _ in 0..draw.whole(1, 4) {
        let target = judge.target(draw);
        let context = |violation: Violation| violation.during(format!("{settings:?}, {target:?}"));
        let (found, target) = match (draw.whole(0, 3), &last, target) {
            (0, Some(last), _) => {
                let load = last.contact.load * draw.between(0.5, 1.5);
                let target = ContactTarget::Load(load);
                (solver.solve_from(last, load), target)
            }
            (1, _, ContactTarget::Approach(approach)) => (solver.solve_approach(approach), target),
            (1, _, ContactTarget::Load(load)) => (solver.solve(load), target),
            (2, _, _) => {
                let others = [judge.target(draw), judge.target(draw)];
                tally += judge.sweep(&mut solver, [others[0], target, others[1]])?;
                continue;
            }
            _ => (solver.solve_target(target), target),
        };
        match found {
            Ok(mut solution) => {
                if !settings.stiffness && draw.once_in(2) {
                    let added = solver.add_stiffness(&mut solution);
                    if let Err(error) = added {
                        tally += judge.refusal(&error, target).map_err(context)?;
                        continue;
                    }
                }
                tally += judge.solution(&solution, target).map_err(context)?;
                last = Some(solution);
            }
            Err(error) => tally += judge.refusal(&error, target).map_err(context)?,
        }
    }
    Ok(tally)
}

/// What is asked of a solver.
impl Judge {
    fn target(&self, draw: &mut Draw<'_>) -> ContactTarget {
        let states = self.history.states();
        let (Some(first), Some(last)) = (states.first(), states.last()) else {
            return ContactTarget::Load(1.0);
        };
        // Beyond full contact as well; of a flat surface any load is.
        let greatest = match last.contact.load > 0.0 {
            true => last.contact.load,
            false => self.grid.nominal_area(),
        };
        match draw.whole(0, 6) {
            0..=2 => ContactTarget::Load(greatest * draw.decades(-4.0, 1.0)),
            3 => ContactTarget::Approach(last.contact.approach * draw.decades(-3.0, 0.3)),
            4 => ContactTarget::MeanGap(first.contact.mean_gap * draw.unit()),
            5 => ContactTarget::AreaFraction(draw.unit()),
            _ => ContactTarget::AreaFraction(
                draw.whole(1, self.grid.nodes()) as f64 / self.grid.nodes() as f64,
            ),
        }
    }

    fn sweep(&self, solver: &mut FixedLoadSolver, targets: [ContactTarget; 3]) -> Verdict {
        let mut tally = Tally::default();
        for (found, target) in solver.sweep(targets).zip(targets) {
            let verdict = match found {
                Ok(solution) => self.solution(&solution, target),
                Err(error) => self.refusal(&error, target),
            };
            tally += verdict.map_err(|violation| {
                violation.during(format!("{:?}, {target:?} of {targets:?}", self.settings))
            })?;
        }
        Ok(tally)
    }
}
