//! Flat surfaces, with nothing out of contact from the beginning: what a state says of mean gap and stiffness.

use asperity::loading::{History, LoadingState};
use asperity::surface::FlatPunch;
use asperity::updater::{ConjugateGradient, Dense, Handover, LinearUpdater, RecursiveCholesky};
use asperity::{
    Boussinesq, FixedLoadSolver, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq, Spectral,
};

/// In full contact the mean gap is exactly 0 and the interfacial stiffness infinite, by identity: in a path with a factor and
/// without one, read from its record under a load, and under a fixed load, however few nodes there are. Before, among nodes that
/// touch together, there is a stiffness, and the mean gap is 0 as well.
#[test]
fn nothing_out_of_contact_is_no_gap_and_infinite_stiffness() {
    for (nx, ny) in [(1, 1), (1, 2), (2, 1), (2, 2), (1, 3), (3, 3), (4, 3)] {
        let grid = Grid::new(nx, ny, 1.0, 1.5).unwrap();
        let kernels: [Box<dyn InfluenceKernel>; 3] = [
            Box::new(Boussinesq::new(grid, 1.0).unwrap()),
            Box::new(PeriodicBoussinesq::new(grid, 1.0).unwrap()),
            Box::new(Spectral::new(grid, 1.0).unwrap()),
        ];
        for kernel in &kernels {
            for height in [0.0, 0.3, -1e-7] {
                on_flat(&FlatPunch::new(height).unwrap(), &**kernel);
            }
        }
    }
}

fn on_flat(punch: &FlatPunch, kernel: &dyn InfluenceKernel) {
    let nodes = kernel.grid().nodes();
    let fixed = FixedLoadSolver::builder(punch, kernel).tolerance(1e-12);
    let fixed = fixed.build().unwrap().solve(1.0).unwrap().state;
    let is_full = |found: &LoadingState| {
        let context = format!("{found:?}");
        assert_eq!(found.contact.contact_nodes, nodes, "{context}");
        assert_eq!(found.contact.mean_gap, 0.0, "{context}");
        assert_eq!(found.contact.interfacial_stiffness, Some(f64::INFINITY));
        match (found.contact.contact_stiffness, fixed.contact_stiffness) {
            (Some(found), Some(fixed)) => assert!((found / fixed - 1.0).abs() < 1e-11, "{context}"),
            (found, fixed) => assert_eq!(found, fixed, "{context}"),
        }
    };
    assert_eq!((fixed.contact_nodes, fixed.mean_gap), (nodes, 0.0));
    assert_eq!(fixed.interfacial_stiffness, Some(f64::INFINITY));
    let updaters: [Box<dyn LinearUpdater>; 4] = [
        Box::new(Dense),
        Box::new(RecursiveCholesky::new()),
        Box::new(ConjugateGradient::new()),
        Box::new(Handover::new()),
    ];
    for updater in updaters {
        let path = LoadingSolver::builder(punch, kernel).updater(updater);
        let history: History = path.build().unwrap().map(Result::unwrap).collect();
        let (last, before) = history.states().split_last().unwrap();
        for state in before {
            assert_eq!((state.contact.load, state.contact.mean_gap), (0.0, 0.0), "{state:?}");
            let stiffness = state.contact.interfacial_stiffness.unwrap();
            assert!(stiffness > 0.0 && stiffness.is_finite(), "{state:?}");
        }
        is_full(last);
        assert_eq!(last.contact.load, 0.0);
        let loaded = history.at_load(1.0).unwrap();
        is_full(&loaded);
        // On a periodic half-space both are 0 but for rounding.
        assert!((loaded.contact.approach - fixed.approach).abs() < 1e-11, "{loaded:?}");
    }
}
