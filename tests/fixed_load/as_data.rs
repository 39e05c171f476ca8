//! Solutions as data of any format that serde knows.

use asperity::{Error, FixedLoadSolution, FixedLoadSolver, Grid};
use serde_json::Value;

use crate::problems::{Kernel, solver};
use asperity_testing::surfaces::rough;

fn written(solution: &FixedLoadSolution) -> String {
    serde_json::to_string(solution).unwrap()
}

fn read(text: &str) -> Result<FixedLoadSolution, serde_json::Error> {
    serde_json::from_str(text)
}

/// Partial contact and full contact, whose greatest numbers JSON does not have, with stiffnesses and without.
#[test]
fn a_solution_is_data() {
    let grid = Grid::new(12, 9, 1.0, 1.0).unwrap();
    let map = rough(&grid, 4);
    for kernel in Kernel::all(grid, 1.0) {
        for stiffness in [true, false] {
            let builder = FixedLoadSolver::builder(&map, &kernel);
            let mut solver = builder.stiffness(stiffness).build().unwrap();
            for load in [1e-2, 1e6] {
                let solution = solver.solve(load).unwrap();
                let full = solution.certificate.least_gap == f64::INFINITY;
                assert_eq!(full, load > 1.0);
                assert_eq!(read(&written(&solution)).unwrap(), solution);
            }
        }
    }
}

/// With a hardness, of which half the contact has had enough.
#[test]
fn what_has_yielded_is_data() {
    let grid = Grid::new(12, 9, 1.0, 1.0).unwrap();
    let map = rough(&grid, 4);
    let kernel = Kernel::free(grid, 1.0);
    let elastic = FixedLoadSolver::new(&map, &kernel).unwrap().solve(1e-2).unwrap();
    let hardness = 0.5 * elastic.fields.max_pressure();
    let builder = FixedLoadSolver::builder(&map, &kernel).hardness(hardness);
    let solution = builder.build().unwrap().solve(1e-2).unwrap();
    assert!(solution.contact.plastic.unwrap().yielded_nodes > 0);
    assert_eq!(read(&written(&solution)).unwrap(), solution);
    for field in ["yielded_map", "plastic_depth"] {
        let mut fewer: Value = serde_json::from_str(&written(&solution)).unwrap();
        fewer[field].as_array_mut().unwrap().pop();
        assert!(serde_json::from_value::<FixedLoadSolution>(fewer).is_err(), "{field}");
    }
}

#[test]
fn fields_of_another_shape_are_refused() {
    let grid = Grid::square(16, 1.0).unwrap();
    let mut solver = solver(&rough(&grid, 4), &Kernel::free(grid, 1.0), 1e-8);
    let text = written(&solver.solve(1e-2).unwrap());
    let fields = ["pressure", "gap", "displacement", "contact_map", "pressure_rate"];
    for field in fields {
        let mut fewer: Value = serde_json::from_str(&text).unwrap();
        fewer[field].as_array_mut().unwrap().pop();
        let refused = serde_json::from_value::<FixedLoadSolution>(fewer).unwrap_err();
        let expected = Error::LengthMismatch { expected: 256, found: 255 };
        assert_eq!(refused.to_string(), expected.to_string(), "{field}");
    }
    let mut none: Value = serde_json::from_str(&text).unwrap();
    none["shape"] = serde_json::json!([0, 16]);
    assert!(serde_json::from_value::<FixedLoadSolution>(none).is_err());
}
