//! What holds along every path: it consists of single loads, nothing goes backwards, and energy is work.

use asperity::loading::History;
use asperity::{FixedLoadSolver, LoadingSolver, LoadingState};
use proptest::prelude::*;

use crate::case::{Body, case, failed};
use crate::same::{EXACT, close};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    /// One load without the path to it is the state of the path at that load.
    #[test]
    fn a_fixed_load_is_a_state_of_the_path(case in case(), part in 0.001..1.5) {
        let tolerance = 1e-12;
        let history: History = case.states().map_err(failed)?.into_iter().collect();
        let last = history.states().last().map_or(0.0, |last| last.contact.load);
        prop_assume!(last > 0.0);
        let load = part * last;
        let expected = history.at_load(load)
            .ok_or_else(|| TestCaseError::fail("no reading"))?;
        let (surface, kernel) = (case.surface().map_err(failed)?, case.kernel().map_err(failed)?);
        let solver = FixedLoadSolver::builder(&surface, &kernel).tolerance(tolerance).build();
        let found = solver.and_then(|mut solver| solver.solve(load)).map_err(failed)?.contact;
        // Errors of the tolerance, times a condition of 10³.
        let allowed = 1e3 * tolerance;
        let length = expected.contact.approach + history.states().first().map_or(0.0, |s| s.contact.mean_gap);
        close("approach", found.approach, expected.contact.approach, allowed * length)?;
        close("mean gap", found.mean_gap, expected.contact.mean_gap, allowed * length)?;
        close("energy", found.energy, expected.contact.energy, allowed * load * length)?;
        // As many nodes, unless one is about to touch.
        let near = |s: &&LoadingState| (s.contact.load - load).abs() <= 1e3 * allowed * load;
        if !history.states().iter().any(|s| near(&s)) {
            prop_assert_eq!(found.contact_nodes, expected.contact.contact_nodes);
        }
    }

    /// Load, approach, area and stiffness only grow, and the mean gap only falls.
    #[test]
    fn everything_is_monotone(case in case()) {
        let states = case.states().map_err(failed)?;
        let last = states.last().map_or(0.0, |last| last.contact.approach);
        let initial = states.first().map_or(0.0, |first| first.contact.mean_gap);
        for pair in states.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            // The approach of mean planes is a difference of two lengths, and so is every mean gap.
            let slack = EXACT * if case.body == Body::Free { 0.0 } else { last };
            prop_assert!(b.contact.load >= a.contact.load, "{:?} {:?}", a, b);
            prop_assert!(b.contact.approach >= a.contact.approach - slack, "{:?} {:?}", a, b);
            prop_assert!(b.contact.contact_area > a.contact.contact_area, "{:?} {:?}", a, b);
            prop_assert!(b.contact.mean_gap <= a.contact.mean_gap + EXACT * initial, "{:?} {:?}", a, b);
            let stiffer = |a: Option<f64>, b: Option<f64>| match (a, b) {
                (Some(a), Some(b)) => b >= a * (1.0 - EXACT),
                (a, b) => a == b,
            };
            prop_assert!(stiffer(a.contact.contact_stiffness, b.contact.contact_stiffness), "{:?} {:?}", a, b);
            prop_assert!(stiffer(a.contact.interfacial_stiffness, b.contact.interfacial_stiffness), "{:?} {:?}", a, b);
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
                work += 0.5 * (last.contact.load + state.contact.load) * (state.contact.approach - last.contact.approach);
            }
            // Approaches of mean planes differ by less than they are, near full contact by far less.
            let allowed = EXACT * state.contact.load * (state.contact.approach + state.contact.mean_gap);
            close("work", state.contact.energy, work, allowed)?;
            let pressure = path.fields().map_err(failed)?.pressure;
            let displacement = path.fields().map_err(failed)?.displacement;
            let energy = 0.5 * cell * pressure.dot(&displacement);
            close("half of pressures times displacements", state.contact.energy, energy, allowed)?;
            last = Some(state);
        }
    }
}
