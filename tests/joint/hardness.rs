//! Joints of surfaces that yield: what conducts is the whole contact, and not its elastic nodes alone.

use asperity::joint::{Conduction, InterfaceRow, InterfaceTable};
use asperity::kernel::Layering;
use asperity::loading::History;
use asperity::surface::Paraboloid;
use asperity::{
    BedError, Boundary, Boussinesq, ContactEvent, Error, FixedLoadSolver, Grid, InfluenceKernel,
    JointError, LoadingSolver, LoadingState, PeriodicBoussinesq, Spectral, Surface,
};
use asperity_testing::dense::{influence_matrix, restrict};
use nalgebra::DVector;

use super::rough;

const E_STAR: f64 = 115e9;
const RESISTIVITY: f64 = 0.04;

/// All states of a path with a hardness, with the stiffnesses on unloading.
fn yielding<'a>(
    surface: &'a dyn Surface,
    kernel: &'a dyn InfluenceKernel,
    hardness: f64,
    area: f64,
) -> (LoadingSolver, Vec<LoadingState>) {
    let builder = LoadingSolver::builder(surface, kernel).hardness(hardness);
    let mut path = builder.max_area_fraction(area).build().unwrap();
    let mut states = path.by_ref().collect::<Result<Vec<_>, Error>>().unwrap();
    path.add_unloading_stiffness(&mut states).unwrap();
    (path, states)
}

fn heat() -> Conduction {
    Conduction::thermal(E_STAR, RESISTIVITY).unwrap()
}

fn conductance(state: &LoadingState) -> f64 {
    heat().of(&state.contact, Layering::HalfSpace).unwrap().unwrap()
}

/// The stiffness of a set of nodes, ΔA eᵀC⁻¹e, and the interfacial one, from a dense solution with no factor of this
/// crate.
fn dense(kernel: &dyn InfluenceKernel, nodes: &[usize]) -> [f64; 2] {
    let matrix = influence_matrix(kernel);
    let grid = kernel.grid();
    let inside = restrict(&matrix, nodes);
    let rate = inside.lu().solve(&DVector::from_element(nodes.len(), 1.0)).unwrap();
    let closing = (0..grid.nodes()).filter(|node| !nodes.contains(node)).map(|node| {
        let sinks: f64 = nodes.iter().zip(rate.iter()).map(|(&i, y)| matrix[(node, i)] * y).sum();
        1.0 - sinks
    });
    let stiffness = grid.cell_area() * rate.sum();
    [stiffness, stiffness / (closing.sum::<f64>() / grid.nodes() as f64)]
}

/// At every touch of three paths, most nodes of which yield. Dense solutions have a condition number of some 10³; the
/// interfacial stiffness is a quotient whose denominator is as small as the open part of the area, a 192nd at least:
/// 1e-16 · 1e3 · 192 at most.
#[test]
fn the_stiffness_on_unloading_is_that_of_the_contact() {
    let grid = Grid::new(16, 12, 2e-5, 3e-5).unwrap();
    let kernels: [Box<dyn InfluenceKernel>; 3] = [
        Box::new(Boussinesq::new(grid, E_STAR).unwrap()),
        Box::new(PeriodicBoussinesq::new(grid, E_STAR).unwrap()),
        Box::new(Spectral::new(grid, E_STAR).unwrap()),
    ];
    for (kernel, hardness) in kernels.iter().zip([1e9, 0.3e9, 3e9]) {
        let surface = rough();
        let (path, states) = yielding(&surface, &**kernel, hardness, 1.0);
        assert!(states.last().unwrap().contact.plastic.unwrap().yielded_nodes > 60);
        let order = path.contact_order();
        let mut before = 0.0;
        for state in &states {
            let plastic = state.contact.plastic.unwrap();
            let interfacial = plastic.interfacial_unloading_stiffness.unwrap();
            // Never nothing, as on plateaus, and never less than under a smaller load.
            let found = conductance(state);
            assert!(found > 0.0 && found >= before, "state {}: {found} after {before}", state.step);
            before = found;
            if state.event != ContactEvent::Touch {
                continue;
            }
            let nodes = state.contact.contact_nodes;
            let expected = dense(&**kernel, &order[..nodes]);
            if kernel.boundary() == Boundary::Periodic {
                assert_eq!(plastic.contact_unloading_stiffness, None);
            } else {
                let stiffness = plastic.contact_unloading_stiffness.unwrap();
                let error = stiffness / expected[0] - 1.0;
                assert!(error.abs() < 1e-12, "{nodes} nodes: {error:e}");
            }
            if nodes == grid.nodes() {
                assert_eq!(interfacial, f64::INFINITY);
            } else {
                let error = interfacial / expected[1] - 1.0;
                assert!(error.abs() < 1e-10, "{nodes} nodes: {error:e}");
            }
        }
    }
}

/// The first state on the way back, by the elastic path of the surface that is left. It is found as the last one of
/// that path, whose nodes touch together to rounding: all of them.
#[test]
fn it_is_where_unloading_begins() {
    let grid = Grid::square(32, 1.25e-3).unwrap();
    let free = Boussinesq::new(grid, E_STAR).unwrap();
    let periodic = PeriodicBoussinesq::new(grid, E_STAR).unwrap();
    let kernels: [&dyn InfluenceKernel; 2] = [&free, &periodic];
    for kernel in kernels {
        let surface = rough();
        let builder = || LoadingSolver::builder(&surface, kernel).hardness(2e9);
        for area in [0.05, 0.2, 0.4] {
            // Between two events, where no node is about to touch.
            let last = builder().max_area_fraction(area).build().unwrap().last().unwrap().unwrap();
            let load = last.contact.load * (1.0 + 1e-7);
            let mut path = builder().max_load(load).build().unwrap();
            let mut states = path.by_ref().collect::<Result<Vec<_>, Error>>().unwrap();
            path.add_unloading_stiffness(&mut states).unwrap();
            let last = states.last().unwrap().contact;
            let residual = path.residual_surface().unwrap();
            let back = LoadingSolver::builder(&residual, kernel).max_load(load).build().unwrap();
            let back = back.last().unwrap().unwrap().contact;
            assert_eq!(back.contact_nodes, last.contact_nodes);
            let plastic = last.plastic.unwrap();
            assert!(plastic.yielded_nodes * 3 > last.contact_nodes);
            for (found, expected) in [
                (plastic.contact_unloading_stiffness, back.contact_stiffness),
                (plastic.interfacial_unloading_stiffness, back.interfacial_stiffness),
            ] {
                match (found, expected) {
                    // Condition numbers of 10³.
                    (Some(a), Some(b)) => assert!((a / b - 1.0).abs() < 1e-11, "{a} {b}"),
                    (a, b) => assert_eq!(a, b),
                }
            }
            // Elastic nodes alone are much softer.
            let elastic = last.interfacial_stiffness.unwrap();
            assert!(elastic < 0.8 * plastic.interfacial_unloading_stiffness.unwrap());
        }
    }
}

/// A ball under 8 N: Holm's 4a/ρ with the radius of the area in contact. Whole cells along the edge, of which the
/// circle has 28 across, make the radius uncertain by half a cell, 3.6 %; the elastic ring alone conducts 0.00368 W/K.
#[test]
fn a_ball_that_yields_conducts_as_its_contact() {
    let grid = Grid::square(64, 0.6e-3).unwrap();
    let half_space = Boussinesq::new(grid, E_STAR).unwrap();
    let ball = Paraboloid::new(10e-3).unwrap();
    let builder = LoadingSolver::builder(&ball, &half_space).hardness(150e6);
    let mut path = builder.max_load(8.0).build().unwrap();
    let mut states = path.by_ref().collect::<Result<Vec<_>, Error>>().unwrap();
    path.add_unloading_stiffness(&mut states).unwrap();
    let last = states.last().unwrap();
    assert!(last.contact.plastic.unwrap().yielded_nodes * 2 > last.contact.contact_nodes);
    let radius = (last.contact.contact_area / std::f64::consts::PI).sqrt();
    let holm = 4.0 * radius / RESISTIVITY;
    let found = conductance(last);
    assert!((found / holm - 1.0).abs() < 0.036, "{found} {holm}");
    // It rises with the load all the way.
    assert!(states.windows(2).all(|pair| conductance(&pair[0]) <= conductance(&pair[1])));
}

/// Single loads are solved to a tolerance of 1e-10 of the gaps, from which stiffnesses err by its square.
#[test]
fn single_loads_have_the_stiffness_of_the_path() {
    let grid = Grid::square(32, 1.25e-3).unwrap();
    let free = Boussinesq::new(grid, E_STAR).unwrap();
    let periodic = PeriodicBoussinesq::new(grid, E_STAR).unwrap();
    let kernels: [&dyn InfluenceKernel; 2] = [&free, &periodic];
    for kernel in kernels {
        let surface = rough();
        let (_, states) = yielding(&surface, kernel, 2e9, 0.3);
        let history: History = states.into_iter().collect();
        let builder = FixedLoadSolver::builder(&surface, kernel).hardness(2e9);
        let mut solver = builder.tolerance(1e-10).stiffness(true).build().unwrap();
        let greatest = history.states().last().unwrap().contact.load;
        for part in [0.031, 0.32, 0.77] {
            let mut solution = solver.solve(part * greatest).unwrap();
            let refused = heat().of(&solution.contact, Layering::HalfSpace);
            assert!(matches!(
                refused,
                Err(Error::Joint(JointError::NoUnloadingStiffness { yielded_nodes, .. })) if yielded_nodes > 0
            ));
            solver.add_unloading_stiffness(&mut solution).unwrap();
            let expected = history.at_load(part * greatest).unwrap();
            assert_eq!(solution.contact.contact_nodes, expected.contact.contact_nodes);
            let [a, b] = [&solution.contact, &expected.contact]
                .map(|contact| heat().of(contact, Layering::HalfSpace).unwrap().unwrap());
            assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
            let [a, b] = [&solution.contact, &expected.contact]
                .map(|contact| heat().of_interface(contact, Layering::HalfSpace).unwrap().unwrap());
            assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
        }
    }
}

/// A stiffness of the elastic nodes alone is no answer.
#[test]
fn what_is_not_known_is_refused() {
    let grid = Grid::square(32, 1.25e-3).unwrap();
    let half_space = Boussinesq::new(grid, E_STAR).unwrap();
    let surface = rough();
    let builder = || LoadingSolver::builder(&surface, &half_space).max_area_fraction(0.4);
    let mut path = builder().hardness(2e9).build().unwrap();
    let states = path.by_ref().collect::<Result<Vec<_>, Error>>().unwrap();
    let first = states.iter().find(|s| s.event == ContactEvent::Yield).unwrap().step;
    for state in &states {
        let [of, of_interface] = [
            heat().of(&state.contact, Layering::HalfSpace),
            heat().of_interface(&state.contact, Layering::HalfSpace),
        ];
        if state.step < first {
            assert!(of.unwrap().is_some() && of_interface.unwrap().is_some());
        } else {
            for refused in [of, of_interface] {
                let nodes = state.contact.plastic.unwrap().yielded_nodes;
                assert!(matches!(
                    refused,
                    Err(Error::Joint(JointError::NoUnloadingStiffness { yielded_nodes, .. }))
                        if yielded_nodes == nodes
                ));
            }
        }
    }
    let history: History = states.iter().copied().collect();
    assert!(matches!(
        heat().bounds(&history, 1e-8),
        Err(Error::Joint(JointError::BoundsWithYielding { step })) if step == first
    ));
    let table = || InterfaceTable::builder(&history);
    assert!(matches!(table().conduction(heat()).build(), Err(Error::Joint(_))));
    assert!(matches!(table().friction(0.2, 1.2).build(), Err(Error::Joint(_))));
    // Overclosures of states that do not begin with first touch are not known.
    let later: History = states[20..].iter().copied().collect();
    assert!(matches!(
        InterfaceTable::builder(&later).build(),
        Err(Error::Bed(BedError::NotFromFirstTouch { .. }))
    ));
    // Pressure and overclosure ask for no stiffness.
    assert!(table().build().unwrap().rows().len() > 10);
    // A state of a longer path, and of more nodes.
    let longer = LoadingSolver::builder(&surface, &half_space).max_area_fraction(0.5);
    let longer = longer.hardness(2e9).build().unwrap();
    let beyond = longer.last().unwrap().unwrap();
    assert!(matches!(
        path.add_unloading_stiffness(&mut [beyond]),
        Err(Error::StateNotReached { .. })
    ));
    let mut foreign = states[5];
    foreign.contact.contact_nodes = grid.nodes() + 1;
    assert!(matches!(
        path.add_unloading_stiffness(&mut [states[3], foreign]),
        Err(Error::NotOnPath { .. })
    ));
    // A factor of 409 nodes beside that of the path, and of no more elastic ones, is not in this budget.
    let budget = path.bytes();
    let mut tight = builder().hardness(2e9).memory_budget(budget + 1_000_000).build().unwrap();
    let mut states = tight.by_ref().collect::<Result<Vec<_>, Error>>().unwrap();
    let before = states.clone();
    assert!(matches!(tight.add_unloading_stiffness(&mut states), Err(Error::MemoryBudget { .. })));
    assert_eq!(states, before);
    // An elastic path has nothing to add.
    let mut elastic = builder().build().unwrap();
    let mut states = elastic.by_ref().collect::<Result<Vec<_>, Error>>().unwrap();
    let before = states.clone();
    elastic.add_unloading_stiffness(&mut states).unwrap();
    assert_eq!(states, before);
}

/// A column of a table.
type Column = fn(&InterfaceRow) -> f64;

/// Linear interpolation as a finite element program does it.
fn between(rows: &[InterfaceRow], x: Column, y: Column, at: f64) -> f64 {
    let after = rows.partition_point(|row| x(row) < at).clamp(1, rows.len() - 1);
    let (a, b) = (&rows[after - 1], &rows[after]);
    y(a) + (y(b) - y(a)) * ((at - x(a)) / (x(b) - x(a)))
}

/// Tables reproduce every state of the path within the tolerance that they state, plateaus among them, where the
/// conductance jumps at one pressure: there the table is right on one side or the other of the 10⁻¹¹ by which it raises
/// pressures from row to row.
#[test]
fn tables_reproduce_paths_that_yield() {
    let (mut plateaus, mut widest) = (0, 0.0_f64);
    for (nodes, hardness, periodic) in
        [(64, 2.5e9, true), (32, 1e9, true), (32, 0.3e9, false), (32, 2.5e9, false)]
    {
        let grid = Grid::square(nodes, 1.25e-3).unwrap();
        let kernel: Box<dyn InfluenceKernel> = match periodic {
            true => Box::new(PeriodicBoussinesq::new(grid, E_STAR).unwrap()),
            false => Box::new(Boussinesq::new(grid, E_STAR).unwrap()),
        };
        let surface = rough();
        let (_, states) = yielding(&surface, &*kernel, hardness, 0.5);
        let unloaded = states[0].contact.mean_gap;
        let area = grid.nominal_area();
        let is_plateau = |s: &&LoadingState| s.contact.interfacial_stiffness == Some(0.0);
        plateaus += states.iter().filter(is_plateau).count();
        let history: History = states.iter().copied().collect();
        let of = |s: &LoadingState| {
            heat().of_interface(&s.contact, Layering::HalfSpace).unwrap().unwrap()
        };
        for group in states.chunk_by(|a, b| (a.contact.load / b.contact.load - 1.0).abs() < 1e-11) {
            let [low, high] = [of(&group[0]), of(group.last().unwrap())];
            widest = widest.max(1.0 - low / high);
        }
        for tolerance in [0.1, 0.01, 0.001] {
            let table = InterfaceTable::builder(&history).conduction(heat()).friction(0.25, 1.2);
            let table = table.tolerance(tolerance).build().unwrap();
            let rows = table.rows();
            assert!(rows.windows(2).all(|pair| {
                pair[0].pressure < pair[1].pressure && pair[0].overclosure < pair[1].overclosure
            }));
            let greatest = rows.last().unwrap().pressure;
            // Of some 10³ rows each raised at most by 1e-11.
            let near = 1e-7;
            for state in &states {
                let pressure = state.contact.mean_pressure();
                let overclosure = unloaded - state.contact.mean_gap;
                let found = between(rows, |r| r.overclosure, |r| r.pressure, overclosure);
                let error = (found - pressure).abs() / pressure.max(1e-3 * greatest);
                assert!(error <= tolerance * (1.0 + 1e-6), "state {}: {error}", state.step);
                let expected =
                    heat().of_interface(&state.contact, Layering::HalfSpace).unwrap().unwrap()
                        / area;
                let columns: [(Column, f64); 2] = [
                    (|row| row.conductance.unwrap(), expected),
                    (
                        |row| row.tangential_stiffness.unwrap(),
                        expected * RESISTIVITY * E_STAR / 2.0 / 1.2,
                    ),
                ];
                for (column, expected) in columns {
                    let sides = [-near, 0.0, near].map(|off| {
                        between(rows, |r| r.pressure, column, pressure * (1.0 + off)) / expected
                            - 1.0
                    });
                    // By way of the pressure that the overclosure gives, whose rounding is some 10⁻⁵ of the 10⁻¹¹
                    // between the rows of a jump.
                    let chained = between(rows, |r| r.pressure, column, found) / expected - 1.0;
                    assert!(
                        chained.abs() <= tolerance * (1.0 + 1e-6) + 1e-4,
                        "{nodes}² {hardness:e}, tolerance {tolerance}, state {}: {chained} over overclosure",
                        state.step
                    );
                    // At a jump it passes through all values from one side to the other.
                    let least = sides.iter().copied().fold(f64::INFINITY, f64::min);
                    let most = sides.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                    let allowed = tolerance * (1.0 + 1e-6) + near;
                    assert!(
                        least <= allowed && most >= -allowed,
                        "{nodes}² {hardness:e}, tolerance {tolerance}, state {}: {sides:?}",
                        state.step
                    );
                }
            }
            let last = rows.last().unwrap().conductance.unwrap();
            let expected = heat()
                .of_interface(&states.last().unwrap().contact, Layering::HalfSpace)
                .unwrap()
                .unwrap()
                / area;
            assert!((last / expected - 1.0).abs() < 1e-12);
        }
    }
    assert!(plateaus > 20, "{plateaus}");
    // What the page says of the pressure of a plateau.
    assert!((widest - 0.365).abs() < 5e-3, "{widest}");
}
