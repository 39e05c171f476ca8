//! The contact of a wave against Westergaard's closed form, on finer and finer periodic grids: in what
//! order each quantity converges, and to what.

use asperity::reference::Westergaard;
use asperity::surface::{Axis, Wave};
use asperity::{Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq, Spectral};

const AMPLITUDE: f64 = 0.01;
const E_STAR: f64 = 3.0;

/// Greatest errors over a path, in powers of the cell over the wavelength.
#[derive(Debug)]
struct Errors {
    /// Of the mean gap at any event, over amplitude × (cell / wavelength)².
    gap: f64,
    /// Of the area fraction, over cell / wavelength, just before nodes touch between a tenth and nine
    /// tenths of the load of full contact: least and greatest.
    area: (f64, f64),
    /// Of the stiffness there, relative, over cell / wavelength.
    stiffness: f64,
    /// Of the load of full contact, relative, over (cell / wavelength)².
    full: f64,
}

/// On `nodes` × 4 cells along a wave and across it.
fn errors<K: InfluenceKernel>(nodes: usize, kernel: impl Fn(Grid) -> K) -> Errors {
    let cell = 1.0 / nodes as f64;
    let grid = Grid::new(nodes, 4, cell, cell).unwrap();
    // A row of nodes on the crest, and one in the trough.
    let (x, y) = grid.position(0, 0);
    let wave = Wave::new(AMPLITUDE, 1.0, Axis::X).unwrap().centered_at(x, y).unwrap();
    let exact = Westergaard::new(AMPLITUDE, 1.0, E_STAR).unwrap();
    let path = LoadingSolver::new(&wave, &kernel(grid)).unwrap();
    let states: Vec<_> = path.map(Result::unwrap).collect();
    let full = exact.full_contact_pressure();
    let last = states.last().unwrap();
    let mut errors = Errors {
        gap: 0.0,
        area: (f64::INFINITY, f64::NEG_INFINITY),
        stiffness: 0.0,
        full: (last.contact.mean_pressure() / full - 1.0) / (cell * cell),
    };
    for pair in states.windows(2) {
        let (before, at) = (pair[0], pair[1]);
        let pressure = at.contact.mean_pressure();
        // Two rows of four nodes touch at once.
        if at.contact.load <= before.contact.load * (1.0 + 1e-9) || pressure > full {
            continue;
        }
        let gap =
            (at.contact.mean_gap - exact.mean_gap(pressure)).abs() / (AMPLITUDE * cell * cell);
        errors.gap = errors.gap.max(gap);
        let ratio = pressure / full;
        if ratio > 0.1 && ratio < 0.9 {
            let area = before.contact.contact_area_fraction - exact.contact_area_fraction(pressure);
            errors.area.0 = errors.area.0.min(area / cell);
            errors.area.1 = errors.area.1.max(area / cell);
            let found = before.contact.interfacial_stiffness.unwrap() / grid.nominal_area();
            let error = found / exact.interfacial_stiffness(pressure) - 1.0;
            errors.stiffness = errors.stiffness.max(error.abs() / cell);
        }
    }
    errors
}

fn love(grid: Grid) -> PeriodicBoussinesq {
    PeriodicBoussinesq::new(grid, E_STAR).unwrap()
}

fn spectral(grid: Grid) -> Spectral {
    Spectral::new(grid, E_STAR).unwrap()
}

/// The constants of the second-order error of the mean gap, and of the first-order staircases of area
/// and stiffness, do not depend on the grid; they are those that a solver which shares no code with
/// this crate found: 2.99 and 3.34 for the mean gap, 0.650 and 0.619 for the area, up to 9.8 for
/// the stiffness.
#[test]
fn orders_of_convergence() {
    for nodes in [64, 128, 256, 512] {
        for (name, errors, gap, area) in [
            ("Love", errors(nodes, love), 2.99, 0.650),
            ("spectral", errors(nodes, spectral), 3.34, 0.619),
        ] {
            let context = format!("{name}, {nodes} nodes: {errors:?}");
            // Given to three digits; beside it 10 (cell/wavelength)², some 0.25 % on the coarsest grid.
            assert!((errors.gap / gap - 1.0).abs() < 0.005, "{context}");
            // Just before a row touches the area falls short of the exact one by the same everywhere,
            // but for 0.8 cell/wavelength: 1.3 % on the coarsest grid.
            for found in [errors.area.0, errors.area.1] {
                assert!((found / -area - 1.0).abs() < 0.015, "{context}");
            }
            // A staircase whose steps are the widest at the ends of the range of loads, where a step may
            // or may not count: from 8.1 to 9.7 on these grids.
            assert!(errors.stiffness > 7.5 && errors.stiffness < 10.0, "{context}");
        }
    }
}

/// The load of full contact: of one wave the spectral kernel makes no error, and Love's cells are
/// stiffer by (π²/6) (cell/wavelength)², since pressure that is uniform on cells is by so much less of a
/// wave.
#[test]
fn load_of_full_contact() {
    for nodes in [64, 128] {
        let cell_squared = ((nodes * nodes) as f64).recip();
        // Rounding of a path of 512 events.
        let error = errors(nodes, spectral).full * cell_squared;
        assert!(error.abs() < 1e-10, "{nodes}: {error:e}");
        let coefficient = errors(nodes, love).full;
        let expected = std::f64::consts::PI.powi(2) / 6.0;
        // Aliases add a term of the order of cell/wavelength beside it.
        assert!((coefficient / expected - 1.0).abs() < 0.05, "{coefficient}");
    }
}
