//! Conductance on half-spaces that repeat along one side, whose approach is counted from where one likes.

use asperity::joint::{Conduction, InterfaceTable};
use asperity::kernel::{KernelTable, Layering};
use asperity::loading::History;
use asperity::reference::contact_conductance;
use asperity::surface::{Axis, HeightMap};
use asperity::{
    ContactGrowth, ContactState, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq,
    SemiPeriodicBoussinesq,
};
use asperity_testing::assert_relative;
use asperity_testing::dense::restrict;
use nalgebra::{DMatrix, DVector};

use super::{history, rough};

const E_STAR: f64 = 115e9;
const RESISTIVITY: f64 = 0.04;

fn heat() -> Conduction {
    Conduction::thermal(E_STAR, RESISTIVITY).unwrap()
}

fn body_of(kernel: &dyn InfluenceKernel) -> Layering {
    kernel.origin().layering(kernel.boundary())
}

/// The states of a path, of the body that its kernel is.
fn of_body(states: History, kernel: &dyn InfluenceKernel) -> History {
    states.on(body_of(kernel))
}

/// `∫ dx dy / r` over a rectangle of the sides a and b around the origin, from a point in its plane.
fn rectangle((x, y): (f64, f64), (a, b): (f64, f64)) -> f64 {
    let part = |x: f64, y: f64| {
        let term = |x: f64, y: f64| if x == 0.0 { 0.0 } else { x * (y / x.abs()).asinh() };
        term(x, y) + term(y, x)
    };
    let (x0, x1, y0, y1) = (x - 0.5 * a, x + 0.5 * a, y - 0.5 * b, y + 0.5 * b);
    part(x1, y1) - part(x0, y1) - part(x1, y0) + part(x0, y0)
}

/// Conductances of spots of one potential on a half-space of each body, whose current leaves by the same cells along a
/// row of `images` to either side: to a point that is far off, and to the mean potential of the grid.
fn conducted(grid: &Grid, spots: &[usize], images: usize) -> [f64; 2] {
    let (nx, [dx, dy]) = (grid.nx(), [grid.dx(), grid.dy()]);
    let place = |node: usize| ((node % nx) as f64 * dx, (node / nx) as f64 * dy);
    let reach = images as i64;
    let all: Vec<usize> = (0..grid.nodes()).collect();
    // A half-space of the resistivity ρ has the potential ρ/(2π) ∫ i/r: both together that of ρ₁ + ρ₂.
    let potential = DMatrix::from_fn(all.len(), all.len(), |i, j| {
        let ((x, y), (u, v)) = (place(i), place(j));
        let row = (-reach..=reach).map(|k| {
            let along = x - u + k as f64 * nx as f64 * dx;
            rectangle((along, y - v), (dx, dy))
        });
        RESISTIVITY / (2.0 * std::f64::consts::PI) * row.sum::<f64>()
    });
    let inside = restrict(&potential, spots);
    let density = inside.lu().solve(&DVector::from_element(spots.len(), 1.0)).unwrap();
    let current = density.sum() * dx * dy;
    let everywhere = potential.select_columns(spots) * &density;
    [current, current / (1.0 - everywhere.mean())]
}

/// A flat top on a part of the nodes, the others far below.
fn spots(grid: &Grid, is_one: impl Fn(usize, usize) -> bool) -> (HeightMap, Vec<usize>) {
    let heights =
        DMatrix::from_fn(grid.nx(), grid.ny(), |ix, iy| if is_one(ix, iy) { 0.0 } else { -1.0 });
    let nodes = (0..grid.nodes()).filter(|node| is_one(node % grid.nx(), node / grid.nx()));
    (HeightMap::new(heights).unwrap(), nodes.collect())
}

/// The state in which all spots touch, and nothing else.
fn touching(surface: &HeightMap, kernel: &dyn InfluenceKernel, nodes: usize) -> ContactState {
    let path = LoadingSolver::builder(surface, kernel).max_load(1.0).build().unwrap();
    let states: Vec<_> = path.collect::<Result<_, _>>().unwrap();
    let found = states.iter().rev().find(|state| state.contact.contact_nodes == nodes).unwrap();
    found.contact
}

/// Against the potential itself: to the mean of the surface it is the program's, however long the row of images, and to
/// a point far off it falls with the length of the row, as dW/dδ with the length that its approach is counted from.
#[test]
fn a_row_conducts_to_the_mean_of_its_surface() {
    let grid = Grid::new(6, 9, 1e-4, 1.4e-4).unwrap();
    let (surface, nodes) =
        spots(&grid, |ix, iy| (ix * 5 + iy * 7 + ix * iy * 3) % 11 < 3 && iy != 4);
    let kernel = SemiPeriodicBoussinesq::new(grid, E_STAR, Axis::X).unwrap();
    let contact = touching(&surface, &kernel, nodes.len());
    let body = body_of(&kernel);
    assert_eq!(body, Layering::SemiPeriodicHalfSpace);
    let found = heat().of(&contact, body).unwrap().unwrap();
    assert_eq!(heat().of_interface(&contact, body).unwrap(), Some(found));
    // The same coefficients, as if they were somebody's own.
    let coefficient = |di, dj| kernel.coefficient(di, dj);
    let own =
        KernelTable::from_fn(grid, kernel.boundary(), ContactGrowth::Unknown, coefficient).unwrap();
    let contact = touching(&surface, &own, nodes.len());
    let of_own = heat().of(&contact, body_of(&own)).unwrap().unwrap();
    assert_relative!(of_own, found, 1e-10);
    let far = contact_conductance(contact.contact_stiffness.unwrap(), E_STAR, RESISTIVITY).unwrap();
    let [short, long] = [50, 400].map(|images| conducted(&grid, &nodes, images));
    // What a row leaves out falls by the square of its length: 1/N² of half the width over the side, below 10⁻³ and
    // 10⁻⁵.
    assert!((short[1] / found - 1.0).abs() < 1e-3, "{found} {short:?}");
    assert!((long[1] / found - 1.0).abs() < 1e-5, "{found} {long:?}");
    assert!(long[0] < 0.8 * short[0] && short[0] < 0.8 * far, "{far} {short:?} {long:?}");
}

/// Many equal strips beside each other conduct as so many periods of a periodic half-space: edges matter less and less.
/// To a far point they do not.
#[test]
fn many_strips_conduct_as_a_periodic_half_space() {
    let is_one = |ix: usize, iy: usize| ix == 1 && iy % 4 == 2;
    let tile = Grid::square(4, 1e-3).unwrap();
    let (surface, nodes) = spots(&tile, is_one);
    let periodic = PeriodicBoussinesq::new(tile, E_STAR).unwrap();
    let contact = touching(&surface, &periodic, nodes.len());
    let expected = heat().of(&contact, body_of(&periodic)).unwrap().unwrap();
    let off = [1, 4, 16, 64].map(|count| {
        let grid = Grid::new(4, 4 * count, 2.5e-4, 2.5e-4).unwrap();
        let (surface, nodes) = spots(&grid, is_one);
        let kernel = SemiPeriodicBoussinesq::new(grid, E_STAR, Axis::X).unwrap();
        let contact = touching(&surface, &kernel, nodes.len());
        let found = heat().of(&contact, body_of(&kernel)).unwrap().unwrap();
        (found / count as f64 / expected - 1.0).abs()
    });
    assert!(off[3] < off[2] && off[2] < off[1] && off[3] < 0.004, "{off:?}");
}

/// One number for one contact: that of a table for finite elements times the nominal area.
#[test]
fn a_table_has_the_same_conductance() {
    let grid = Grid::square(32, 1.25e-3).unwrap();
    for axis in [Axis::X, Axis::Y] {
        let kernel = SemiPeriodicBoussinesq::new(grid, E_STAR, axis).unwrap();
        let states = of_body(history(&rough(), &kernel, 0.3), &kernel);
        let builder = InterfaceTable::builder(&states).conduction(heat()).tolerance(1e-3);
        let table = builder.build().unwrap();
        let last = states.states().last().unwrap().contact;
        let expected = heat().of(&last, states.layering()).unwrap().unwrap();
        let row = table.rows().last().unwrap();
        let found = row.conductance.unwrap() * grid.nominal_area();
        assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
    }
}

/// A surface, and the same with more roughness: as on a free half-space, with twice the roughness in the bounds.
#[test]
fn a_rougher_surface_conducts_within_the_bounds() {
    let grid = Grid::square(32, 1.25e-3).unwrap();
    let kernel = SemiPeriodicBoussinesq::new(grid, E_STAR, Axis::Y).unwrap();
    let smooth = HeightMap::sample(&rough(), &grid).unwrap();
    for height in [1e-8, 1e-7, 1e-6] {
        let more = |ix: usize, iy: usize| {
            height * ((ix * 37 + iy * 101 + ix * iy * 17) % 97) as f64 / 96.0
        };
        let raised = DMatrix::from_fn(32, 32, |ix, iy| smooth.matrix()[(ix, iy)] + more(ix, iy));
        let raised = HeightMap::new(raised).unwrap();
        let first = of_body(history(&smooth, &kernel, 0.8), &kernel);
        let second = of_body(history(&raised, &kernel, 0.8), &kernel);
        let bounds = heat().bounds(&first, height).unwrap();
        let mut compared = 0;
        for (state, bound) in first.states().iter().zip(&bounds) {
            if let Some(other) = second.at_load(state.contact.load) {
                let found = heat().of(&other.contact, second.layering()).unwrap().unwrap();
                assert!(bound.lower <= found && found <= bound.upper, "{found} {bound:?}");
                compared += 1;
            }
        }
        assert!(compared > 50, "{compared}");
    }
}
