//! Small surfaces on which many nodes touch at once: every updater goes the whole path, and each of its
//! states is that of a dense solution.

use asperity::surface::HeightMap;
use asperity::updater::{ConjugateGradient, Dense, Handover, LinearUpdater, RecursiveCholesky};
use asperity::{
    Boundary, Boussinesq, Grid, InfluenceKernel, LoadingSolver, LoadingState, PeriodicBoussinesq,
    Problem, Spectral,
};
use asperity_testing::Altered;
use nalgebra::{DMatrix, DVector};

/// The default updater, made to give up its factor at a number of nodes in contact.
fn seam(at: usize) -> impl LinearUpdater {
    // More than there is for so many nodes and the least window that has to follow them.
    Altered::new(RecursiveCholesky::new()).on_bytes(move |inner, (contact, watched)| match contact
        .checked_sub(64)
    {
        Some(contact) if contact >= at => usize::MAX,
        _ => inner.bytes(contact, watched),
    })
}

/// Heights of many symmetries on one grid.
fn shapes(nx: usize, ny: usize) -> Vec<(&'static str, DMatrix<f64>)> {
    // Twice the distance from the middle: whole numbers.
    let middle = |i: usize, n: usize| (2 * i) as f64 - (n - 1) as f64;
    let field = |height: &dyn Fn(f64, f64) -> f64| {
        DMatrix::from_fn(nx, ny, |ix, iy| height(middle(ix, nx), middle(iy, ny)))
    };
    let turn = |x: f64, n: usize| (std::f64::consts::PI * x / n as f64).cos();
    vec![
        ("flat", field(&|_, _| 0.0)),
        ("paraboloid", field(&|x, y| -(x * x + y * y))),
        ("cone", field(&|x, y| -x.hypot(y))),
        ("pyramid", field(&|x, y| -(x.abs().max(y.abs())))),
        ("strip along y", field(&|x, _| -(x * x))),
        ("strip along x", field(&|_, y| -(y * y))),
        ("bowl", field(&|x, y| x * x + y * y)),
        ("wave", field(&|x, y| turn(x, nx) * turn(y, ny))),
        ("board", DMatrix::from_fn(nx, ny, |ix, iy| ((ix + iy) % 2) as f64)),
        // Mirrored in both directions, of three heights.
        (
            "steps",
            field(&|x, y| {
                ((3.0 * x.abs() + 5.0 * y.abs() + x.abs() * y.abs()) % 7.0 % 3.0).floor()
            }),
        ),
    ]
}

fn kernels(grid: Grid) -> [(&'static str, Box<dyn InfluenceKernel>); 3] {
    [
        ("free", Box::new(Boussinesq::new(grid, 1.0).unwrap())),
        ("Love", Box::new(PeriodicBoussinesq::new(grid, 1.0).unwrap())),
        ("spectral", Box::new(Spectral::new(grid, 1.0).unwrap())),
    ]
}

/// What the states of an updater may be off by, relative to the greatest value of its kind.
#[derive(Clone, Copy)]
struct Allowed {
    pressure: f64,
    length: f64,
}

/// Compares a state with the dense solution on its nodes under its load.
fn compare(
    problem: &Problem,
    contact: &[usize],
    state: &LoadingState,
    allowed: Allowed,
) -> Result<(), String> {
    let (n, gap) = (contact.len(), problem.initial_gap());
    let table = problem.table();
    let own = table.self_influence();
    // C p − δ = −g on the contact, and the load that goes with it: the same in any gauge.
    let matrix = DMatrix::from_fn(n + 1, n + 1, |i, j| match (i < n, j < n) {
        (true, true) => problem.coefficient(contact[i], contact[j]).unwrap(),
        (false, false) => 0.0,
        (true, false) => -own,
        (false, true) => own,
    });
    let load = state.contact.load / problem.grid().cell_area();
    let rhs = DVector::from_fn(n + 1, |i, _| if i < n { -gap[contact[i]] } else { own * load });
    let solved = matrix.lu().solve(&rhs).ok_or("singular")?;
    let (pressure, approach) = (solved.rows(0, n), own * solved[n]);
    let greatest = problem.greatest_gap();
    let length = allowed.length * (greatest + approach.abs());
    let least = pressure.min();
    if least < -allowed.pressure * pressure.amax() - length / own {
        return Err(format!("pressure {least:e} of {:e}", pressure.amax()));
    }
    let reported = approach - table.gauge().unwrap_or(0.0) * load;
    if (reported - state.contact.approach).abs() > length {
        return Err(format!("approach {} and not {reported}", state.contact.approach));
    }
    let mut open = 0.0;
    for node in (0..gap.len()).filter(|node| !contact.contains(node)) {
        let inside = contact.iter().zip(pressure.iter());
        let u: f64 = inside.map(|(&other, p)| problem.coefficient(node, other).unwrap() * p).sum();
        let here = gap[node] + u - approach;
        if here < -length {
            return Err(format!("gap {here:e} of {greatest:e}"));
        }
        open += here;
    }
    let mean_gap = open / gap.len() as f64;
    if (mean_gap - state.contact.mean_gap).abs() > length {
        return Err(format!("mean gap {} and not {mean_gap}", state.contact.mean_gap));
    }
    Ok(())
}

/// What is wrong with a path, if anything is.
fn whole_path<U: LinearUpdater>(
    map: &HeightMap,
    kernel: &dyn InfluenceKernel,
    updater: U,
    window: Option<usize>,
    allowed: Allowed,
) -> Result<(), String> {
    let mut builder = LoadingSolver::builder(map, kernel).updater(updater).hand_over(true);
    if let Some(size) = window {
        builder = builder.window_size(size);
    }
    let mut path = builder.build().map_err(|error| error.to_string())?;
    let nodes = path.grid().nodes();
    let mut states = Vec::new();
    for state in path.by_ref() {
        states.push(state.map_err(|error| format!("after {} states: {error}", states.len()))?);
    }
    if states.len() != nodes {
        return Err(format!("ends after {} of {nodes} nodes", states.len()));
    }
    let order = path.contact_order();
    let mut last = (0.0, 0.0);
    for state in &states {
        if state.contact.mean_gap < 0.0 || state.contact.energy < 0.0 {
            return Err(format!("mean gap or energy below zero: {state:?}"));
        }
        if state.contact.load < last.0 || state.contact.approach < last.1 {
            return Err(format!("load or approach falls: {last:?} {state:?}"));
        }
        last = (state.contact.load, state.contact.approach);
        let contact = &order[..state.contact.contact_nodes];
        compare(path.problem(), contact, state, allowed)
            .map_err(|what| format!("state {}: {what}", state.step))?;
    }
    Ok(())
}

/// Every updater on every shape of some grids.
fn catalogue(grids: &[(usize, usize, f64, f64)]) {
    // Rounding of 2⁻⁵³ times the condition number, which reaches 4e5 on the strips of the spectral kernel.
    let exact = Allowed { pressure: 1e-10, length: 1e-11 };
    // States between the ends of windows: see `paths/without_factor.rs`.
    let near = Allowed { pressure: 1e-4, length: 1e-4 };
    let (mut wrong, mut paths) = (Vec::new(), 0);
    for &(nx, ny, dx, dy) in grids {
        let grid = Grid::new(nx, ny, dx, dy).unwrap();
        for (shape, heights) in shapes(nx, ny) {
            let map = HeightMap::new(heights).unwrap();
            for (name, kernel) in kernels(grid) {
                let kernel = &*kernel;
                let mut results = vec![
                    ("dense", whole_path(&map, kernel, Dense, None, exact)),
                    ("factor", whole_path(&map, kernel, RecursiveCholesky::new(), None, exact)),
                    (
                        "factor, one by one",
                        whole_path(&map, kernel, RecursiveCholesky::new(), Some(1), exact),
                    ),
                    ("default", whole_path(&map, kernel, Handover::new(), None, exact)),
                ];
                // Longer periodic cells need a factor.
                if kernel.boundary() == Boundary::Free
                    || grid.cell_aspect() <= ConjugateGradient::MAX_ASPECT
                {
                    results.extend([
                        (
                            "iterations",
                            whole_path(&map, kernel, ConjugateGradient::new(), None, near),
                        ),
                        (
                            "iterations by threes",
                            whole_path(&map, kernel, ConjugateGradient::new(), Some(3), near),
                        ),
                        ("seam at 1", whole_path(&map, kernel, seam(1), Some(2), near)),
                        (
                            "seam in the middle",
                            whole_path(&map, kernel, seam(nx * ny / 2), Some(4), near),
                        ),
                    ]);
                }
                for (updater, result) in results {
                    paths += 1;
                    if let Err(what) = result {
                        wrong.push(format!(
                            "{nx} × {ny} of {dx} × {dy}, {shape}, {name}, {updater}: {what}"
                        ));
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} of {paths} paths are wrong:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn strips() {
    catalogue(&[
        (1, 1, 1.0, 1.0),
        (2, 1, 1.0, 1.0),
        (1, 5, 1.0, 1.0),
        (1, 20, 1.0, 1.0),
        (24, 1, 1.0, 1.0),
        (24, 1, 1.0, 30.0),
    ]);
}

#[test]
fn eight_by_some() {
    catalogue(&[2, 3, 5, 8].map(|n| (8, n, 1.0, 1.0)));
}

#[test]
fn other_rectangles() {
    catalogue(&[
        (3, 5, 1.0, 1.0),
        (7, 7, 1.0, 1.0),
        (10, 3, 1.0, 10.0),
        (10, 3, 1.0, 100.0),
        (12, 11, 1.0, 0.5),
    ]);
}

/// Symmetric heights that once ended with an overlap of 10⁻⁹ under the free half-space.
#[test]
fn five_in_a_row() {
    let grid = Grid::new(1, 5, 1.0, 1.0).unwrap();
    let map = HeightMap::new(DMatrix::from_row_slice(1, 5, &[0.0, 2.0, 1.0, 2.0, 0.0])).unwrap();
    let allowed = Allowed { pressure: 1e-13, length: 1e-13 };
    let kernel = Boussinesq::new(grid, 1.0).unwrap();
    for window in [None, Some(1), Some(2), Some(5)] {
        whole_path(&map, &kernel, Handover::new(), window, allowed).unwrap();
    }
    let near = Allowed { pressure: 1e-4, length: 1e-4 };
    whole_path(&map, &kernel, ConjugateGradient::new(), None, near).unwrap();
}
