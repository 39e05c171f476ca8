//! What must not matter to a path, and what must always hold along one: random surfaces on every kernel.
//!
//! Here two answers of the library are compared; [`asperity_drivers::paths`] compares one with dense solutions. Properties of
//! single states on the free half-space are those of `tests/paths/path_properties.rs` of the library.
//!
//! `PROPTEST_RNG_SEED` draws other cases.

use std::collections::BTreeSet;

use asperity::loading::History;
use asperity::surface::HeightMap;
use asperity::updater::{ConjugateGradient, Dense, Handover, LinearUpdater, RecursiveCholesky};
use asperity::{
    Boussinesq, Error, FixedLoadSolver, Grid, InfluenceKernel, LoadingSolver, LoadingState,
    PeriodicBoussinesq, Spectral,
};
use nalgebra::DMatrix;
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;

/// What two paths may differ by that are exact to rounding, relative to the numbers themselves: they solve with matrices of
/// condition 10³ at most and are 10⁻¹¹ apart at worst, mean gaps as much of the initial one.
const EXACT: f64 = 1e-11;
/// Events this close, relative to the approach, are one: rounding decides which comes first. Of a path without a factor as
/// well, as `asperity::loading` says.
const TIE: f64 = 1e-9;
/// What states without a factor may be off: 10⁻⁵ at worst on large grids, and a window is a large part of so short a path.
const ITERATED: f64 = 3e-4;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Body {
    Free,
    Periodic,
    Spectral,
}

/// A surface on a body.
#[derive(Debug, Clone)]
struct Case {
    body: Body,
    nodes: (usize, usize),
    cell: (f64, f64),
    e_star: f64,
    /// By node.
    heights: Vec<f64>,
}

fn case() -> impl Strategy<Value = Case> {
    let body = prop::sample::select(vec![Body::Free, Body::Periodic, Body::Spectral]);
    let nodes = prop_oneof![
        4 => (1_usize..=10, 1_usize..=10),
        1 => (Just(1), 1_usize..=40),
        1 => (1_usize..=40, Just(1)),
    ];
    let aspect = prop_oneof![Just(1.0), 0.2..5.0];
    (body, nodes, aspect).prop_flat_map(|(body, nodes, aspect)| {
        let levels = prop_oneof![
            // Noise, without a tie.
            3 => Just(None),
            // A few levels: many nodes touch together.
            1 => (2_u32..8).prop_map(Some),
        ];
        let heights = prop::collection::vec(0.0..1.0, nodes.0 * nodes.1);
        (levels, heights).prop_map(move |(levels, heights)| Case {
            body,
            nodes,
            cell: (1e-3, 1e-3 * aspect),
            e_star: 1e9,
            heights: match levels {
                None => heights.iter().map(|height| 1e-5 * height).collect(),
                Some(levels) => {
                    let levels = f64::from(levels);
                    let steps = heights.iter().map(|height| (levels * height).floor());
                    steps.map(|step| 1e-5 * step / levels).collect()
                }
            },
        })
    })
}

impl Case {
    fn grid(&self) -> Result<Grid, Error> {
        Grid::new(self.nodes.0, self.nodes.1, self.cell.0, self.cell.1)
    }

    fn matrix(&self) -> DMatrix<f64> {
        DMatrix::from_column_slice(self.nodes.0, self.nodes.1, &self.heights)
    }

    fn surface(&self) -> Result<HeightMap, Error> {
        HeightMap::new(self.matrix())
    }

    fn kernel(&self) -> Result<Box<dyn InfluenceKernel + Send + Sync>, Error> {
        let grid = self.grid()?;
        Ok(match self.body {
            Body::Free => Box::new(Boussinesq::new(grid, self.e_star)?),
            Body::Periodic => Box::new(PeriodicBoussinesq::new(grid, self.e_star)?),
            Body::Spectral => Box::new(Spectral::new(grid, self.e_star)?),
        })
    }

    /// The path with an updater and, if that is given, windows of so many nodes.
    fn path<U: LinearUpdater>(
        &self,
        updater: U,
        window: Option<usize>,
    ) -> Result<Vec<LoadingState>, Error> {
        let (surface, kernel) = (self.surface()?, self.kernel()?);
        let builder = LoadingSolver::builder(&surface, &kernel).updater(updater);
        let builder = match window {
            Some(nodes) => builder.window_size(nodes),
            None => builder,
        };
        builder.build()?.collect()
    }

    fn states(&self) -> Result<Vec<LoadingState>, Error> {
        self.path(RecursiveCholesky::new(), None)
    }

    /// The same surface seen with other axes: node (ix, iy) of it is `place(ix, iy)` of this one.
    fn seen(
        &self,
        nodes: (usize, usize),
        cell: (f64, f64),
        place: impl Fn(usize, usize) -> (usize, usize),
    ) -> Self {
        let matrix = self.matrix();
        let heights = DMatrix::from_fn(nodes.0, nodes.1, |ix, iy| matrix[place(ix, iy)]);
        Self {
            nodes,
            cell,
            heights: heights.as_slice().to_vec(),
            ..self.clone()
        }
    }
}

/// How far quantities of a path scale.
#[derive(Debug, Clone, Copy)]
struct Scale {
    length: f64,
    load: f64,
}

const SAME: Scale = Scale {
    length: 1.0,
    load: 1.0,
};

fn close(what: &str, a: f64, b: f64, allowed: f64) -> TestCaseResult {
    prop_assert!(
        (a - b).abs() <= allowed || a == b,
        "{}: {:e} and {:e}, {:e} apart where {:e} is allowed",
        what,
        a,
        b,
        (a - b).abs(),
        allowed
    );
    Ok(())
}

/// Compares a path with another one whose nodes are at `place`: the same nodes in the same order up to ties, and the same
/// scalars between groups of ties.
fn same_path(
    found: &[LoadingState],
    expected: &[LoadingState],
    place: impl Fn((usize, usize)) -> (usize, usize),
    scale: Scale,
    allowed: f64,
) -> TestCaseResult {
    prop_assert_eq!(found.len(), expected.len());
    let initial = expected.first().map_or(0.0, |first| first.mean_gap);
    let last = expected.last().map_or(0.0, |last| last.approach);
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    for (k, (a, b)) in found.iter().zip(expected).enumerate() {
        ours.push(place(a.node));
        theirs.push(b.node);
        let next = expected
            .get(k + 1)
            .map_or(f64::INFINITY, |next| next.approach);
        // Lengths cancel in an approach: the heights.
        let tie = (TIE * b.approach).max(1e-13 * initial);
        if next - b.approach <= tie {
            continue;
        }
        ours.sort_unstable();
        theirs.sort_unstable();
        prop_assert_eq!(&ours, &theirs, "up to step {}", b.step);
        ours.clear();
        theirs.clear();
        // Where there is hardly an approach, it consists of rounding.
        if b.approach <= tie {
            continue;
        }
        let Scale { length, load } = scale;
        let approach = allowed * (b.approach + last);
        close(
            "approach",
            a.approach,
            length * b.approach,
            length * approach,
        )?;
        close(
            "mean gap",
            a.mean_gap,
            length * b.mean_gap,
            length * allowed * initial,
        )?;
        // A load is a stiffness times an approach, both as exact as that.
        let stiffness = b.contact_stiffness.or(b.interfacial_stiffness);
        let stiffness = stiffness.filter(|k| k.is_finite()).unwrap_or(0.0);
        let slack = allowed * b.load + approach * stiffness;
        close("load", a.load, load * b.load, load * slack)?;
        let slack = 3.0 * allowed * b.energy + slack * b.approach;
        close(
            "energy",
            a.energy,
            load * length * b.energy,
            load * length * slack,
        )?;
        if let (Some(a), Some(b)) = (a.contact_stiffness, b.contact_stiffness) {
            close(
                "stiffness",
                a,
                load / length * b,
                load / length * allowed * b,
            )?;
        }
    }
    Ok(())
}

fn failed(error: Error) -> TestCaseError {
    TestCaseError::fail(error.to_string())
}

/// Every number of every state, bit by bit.
fn bits(states: &[LoadingState]) -> Vec<[Option<u64>; 8]> {
    let row = |s: &LoadingState| {
        let scalars = [
            Some(s.approach),
            Some(s.load),
            Some(s.mean_gap),
            Some(s.energy),
            s.contact_stiffness,
            s.interfacial_stiffness,
            Some(s.node.0 as f64),
            Some(s.node.1 as f64),
        ];
        scalars.map(|value| value.map(f64::to_bits))
    };
    states.iter().map(row).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    /// Heights λ times as high on cells μ times as long, with a modulus ν times as large: approaches λ times, loads λμν
    /// times.
    #[test]
    fn units_do_not_matter(
        case in case(),
        exponents in (-3.0..3.0, -3.0..3.0, -3.0..3.0),
    ) {
        let [height, cell, modulus] = [exponents.0, exponents.1, exponents.2]
            .map(|exponent: f64| 10_f64.powf(exponent));
        let other = Case {
            cell: (cell * case.cell.0, cell * case.cell.1),
            e_star: modulus * case.e_star,
            heights: case.heights.iter().map(|z| height * z).collect(),
            ..case.clone()
        };
        let scale = Scale { length: height, load: height * cell * modulus };
        let expected = case.states().map_err(failed)?;
        let found = other.states().map_err(failed)?;
        same_path(&found, &expected, |node| node, scale, EXACT)?;
    }

    /// Only differences of heights count: a constant rounds them, by as much as it is larger.
    #[test]
    fn a_constant_height_does_not_matter(case in case(), constant in -1e-3..1e-3) {
        let other = Case {
            heights: case.heights.iter().map(|z| z + constant).collect(),
            ..case.clone()
        };
        let expected = case.states().map_err(failed)?;
        let found = other.states().map_err(failed)?;
        // Heights of 1e-5 next to a constant of 1e-3 keep 2e-14 of themselves, and pressures lose the condition number.
        let levels: BTreeSet<u64> = case.heights.iter().map(|z| z.to_bits()).collect();
        // Ties come apart, and in which order is a matter of rounding.
        if levels.len() == case.heights.len() {
            same_path(&found, &expected, |node| node, SAME, 10.0 * EXACT)?;
        }
    }

    /// The grid mirrored in x, in y, and turned by a right angle.
    #[test]
    fn axes_do_not_matter(case in case()) {
        let expected = case.states().map_err(failed)?;
        let (nx, ny) = case.nodes;
        let in_x = case.seen(case.nodes, case.cell, |ix, iy| (nx - 1 - ix, iy));
        let in_y = case.seen(case.nodes, case.cell, |ix, iy| (ix, ny - 1 - iy));
        let turned = case.seen((ny, nx), (case.cell.1, case.cell.0), |ix, iy| (iy, ny - 1 - ix));
        let found = in_x.states().map_err(failed)?;
        same_path(&found, &expected, |(ix, iy)| (nx - 1 - ix, iy), SAME, EXACT)?;
        let found = in_y.states().map_err(failed)?;
        same_path(&found, &expected, |(ix, iy)| (ix, ny - 1 - iy), SAME, EXACT)?;
        let found = turned.states().map_err(failed)?;
        same_path(&found, &expected, |(ix, iy)| (iy, ny - 1 - ix), SAME, EXACT)?;
    }

    /// A periodic half-space begins nowhere.
    #[test]
    fn periodic_surfaces_may_be_moved(case in case(), by in (0_usize..40, 0_usize..40)) {
        prop_assume!(case.body != Body::Free);
        let expected = case.states().map_err(failed)?;
        let (nx, ny) = case.nodes;
        let place = |(ix, iy): (usize, usize)| ((ix + by.0) % nx, (iy + by.1) % ny);
        let moved = case.seen(case.nodes, case.cell, |ix, iy| place((ix, iy)));
        let found = moved.states().map_err(failed)?;
        same_path(&found, &expected, place, SAME, EXACT)?;
    }

    /// Any window and any updater with a factor: one path. Without a factor the same events, and nearly the same states.
    #[test]
    fn windows_and_updaters_do_not_matter(
        case in case(),
        window in 1_usize..60,
    ) {
        let expected = case.path(RecursiveCholesky::new(), Some(1)).map_err(failed)?;
        let same = |found: Result<Vec<LoadingState>, Error>, allowed| {
            same_path(&found.map_err(failed)?, &expected, |node| node, SAME, allowed)
        };
        same(case.path(RecursiveCholesky::new(), None), EXACT)?;
        same(case.path(RecursiveCholesky::new(), Some(window)), EXACT)?;
        same(case.path(Dense::new(), Some(window)), EXACT)?;
        same(case.path(Handover::new(), Some(window)), EXACT)?;
        same(case.path(ConjugateGradient::new(), None), ITERATED)?;
    }

    /// Any number of threads: the same bits.
    #[test]
    fn threads_do_not_matter(case in case(), threads in 2_usize..5) {
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let pool = pool.map_err(|error| TestCaseError::fail(error.to_string()))?;
            pool.install(|| {
                let factor = case.path(RecursiveCholesky::new(), None)?;
                Ok((factor, case.path(ConjugateGradient::new(), None)?))
            })
            .map_err(failed)
        };
        let (one, many) = (run(1)?, run(threads)?);
        prop_assert_eq!(bits(&one.0), bits(&many.0));
        prop_assert_eq!(bits(&one.1), bits(&many.1));
    }

    /// One load without the path to it is the state of the path at that load.
    #[test]
    fn a_fixed_load_is_a_state_of_the_path(case in case(), part in 0.001..1.5) {
        let tolerance = 1e-12;
        let history: History = case.states().map_err(failed)?.into_iter().collect();
        let last = history.states().last().map_or(0.0, |last| last.load);
        prop_assume!(last > 0.0);
        let load = part * last;
        let expected = history.at_load(load)
            .ok_or_else(|| TestCaseError::fail("no reading"))?;
        let (surface, kernel) = (case.surface().map_err(failed)?, case.kernel().map_err(failed)?);
        let solver = FixedLoadSolver::builder(&surface, &kernel).tolerance(tolerance).build();
        let found = solver.and_then(|mut solver| solver.solve(load)).map_err(failed)?.state;
        // Errors of the tolerance, times a condition of 10³.
        let allowed = 1e3 * tolerance;
        let length = expected.approach + history.states().first().map_or(0.0, |s| s.mean_gap);
        close("approach", found.approach, expected.approach, allowed * length)?;
        close("mean gap", found.mean_gap, expected.mean_gap, allowed * length)?;
        close("energy", found.energy, expected.energy, allowed * load * length)?;
        // As many nodes, unless one is about to touch.
        let near = |s: &&LoadingState| (s.load - load).abs() <= 1e3 * allowed * load;
        if !history.states().iter().any(|s| near(&s)) {
            prop_assert_eq!(found.contact_nodes, expected.contact_nodes);
        }
    }

    /// Load, approach, area and stiffness only grow, and the mean gap only falls.
    #[test]
    fn everything_is_monotone(case in case()) {
        let states = case.states().map_err(failed)?;
        let last = states.last().map_or(0.0, |last| last.approach);
        let initial = states.first().map_or(0.0, |first| first.mean_gap);
        for pair in states.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            // The approach of mean planes is a difference of two lengths, and so is every mean gap.
            let slack = EXACT * if case.body == Body::Free { 0.0 } else { last };
            prop_assert!(b.load >= a.load, "{:?} {:?}", a, b);
            prop_assert!(b.approach >= a.approach - slack, "{:?} {:?}", a, b);
            prop_assert!(b.contact_area > a.contact_area, "{:?} {:?}", a, b);
            prop_assert!(b.mean_gap <= a.mean_gap + EXACT * initial, "{:?} {:?}", a, b);
            let stiffer = |a: Option<f64>, b: Option<f64>| match (a, b) {
                (Some(a), Some(b)) => b >= a * (1.0 - EXACT),
                (a, b) => a == b,
            };
            prop_assert!(stiffer(a.contact_stiffness, b.contact_stiffness), "{:?} {:?}", a, b);
            prop_assert!(stiffer(a.interfacial_stiffness, b.interfacial_stiffness), "{:?} {:?}", a, b);
        }
    }

    /// The energy is the work of the load along the approach, by the rule of trapezia, and half of pressures times
    /// displacements.
    #[test]
    fn energy_is_the_work_of_the_load(case in case()) {
        let (surface, kernel) = (case.surface().map_err(failed)?, case.kernel().map_err(failed)?);
        let mut path = LoadingSolver::new(&surface, &kernel).map_err(failed)?;
        let cell = path.grid().cell_area();
        let mut last: Option<LoadingState> = None;
        let mut work = 0.0;
        while let Some(state) = path.next() {
            let state = state.map_err(failed)?;
            if let Some(last) = last {
                work += 0.5 * (last.load + state.load) * (state.approach - last.approach);
            }
            // Approaches of mean planes differ by less than they are, near full contact by far less.
            let allowed = EXACT * state.load * (state.approach + state.mean_gap);
            close("work", state.energy, work, allowed)?;
            let pressure = path.pressure().map_err(failed)?;
            let displacement = path.displacement().map_err(failed)?;
            let energy = 0.5 * cell * pressure.dot(&displacement);
            close("half of pressures times displacements", state.energy, energy, allowed)?;
            last = Some(state);
        }
    }
}
