//! Waves: Johnson's contact of one, and fronts that cross the cells at an angle.

use std::f64::consts::{PI, TAU};

use asperity::adhesion::{Adhesion, AdhesiveBranch, AdhesivePath};
use asperity::surface::HeightMap;
use asperity::{ContactTarget, Grid, PeriodicBoussinesq};
use nalgebra::DMatrix;

/// `h cos(2π (kx x + ky y))` on a unit square, or on a strip of one row.
fn wave((nx, ny): (usize, usize), [kx, ky]: [f64; 2], height: f64) -> HeightMap {
    let at = |i: usize, n: usize| (i as f64 + 0.5) / n as f64;
    let phase = |ix: usize, iy: usize| TAU * (kx * at(ix, nx) + ky * at(iy, ny));
    HeightMap::new(DMatrix::from_fn(nx, ny, |ix, iy| height * phase(ix, iy).cos())).unwrap()
}

/// K. L. Johnson, Int. J. Solids Struct. 32 (1995) 423: with ψ = πa/λ for a contact 2a wide,
///
/// ```text
/// p̄ = p* (sin²ψ − α √tan ψ),   p* = πE*h/λ,   α² = 2wλ / (π²h²E*)
/// ```
fn johnson(alpha: f64, psi: f64) -> f64 {
    psi.sin().powi(2) - alpha * psi.tan().sqrt()
}

/// The least of it on narrow contacts, which is the pull-off, and the greatest, behind which contact jumps to full.
fn extremes(alpha: f64) -> [f64; 2] {
    let values = (1..100_000).map(|k| 0.5 * PI * f64::from(k) / 1e5);
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], psi| {
        let value = johnson(alpha, psi);
        [if psi < 0.25 * PI { least.min(value) } else { least }, most.max(value)]
    })
}

/// Pull-off, and the load at which contact jumps to full, over p* times the area.
fn measured(nodes: usize, alpha: f64) -> [f64; 2] {
    let height = 0.01;
    let surface = wave((nodes, 1), [1.0, 0.0], height);
    let grid = Grid::new(nodes, 1, 1.0 / nodes as f64, 1.0 / nodes as f64).unwrap();
    let kernel = PeriodicBoussinesq::new(grid, 1.0).unwrap();
    let unit = PI * height * grid.nominal_area();
    let work = 0.5 * (alpha * PI * height).powi(2);
    let builder = AdhesivePath::builder(&surface, &kernel, Adhesion::work(work));
    // Up to full contact, and back to where it would part from that.
    let mut path = builder.until(ContactTarget::AreaFraction(1.0)).build().unwrap();
    let loading = path.run().unwrap();
    let greatest =
        loading.states().iter().take_while(|state| state.contact.contact_area_fraction < 0.95);
    let greatest = greatest.map(|state| state.contact.load).fold(f64::NEG_INFINITY, f64::max);
    // Pull-off of partial contact: turned around before.
    let builder = AdhesivePath::builder(&surface, &kernel, Adhesion::work(work));
    let mut path = builder.until(ContactTarget::AreaFraction(0.4)).build().unwrap();
    path.run().unwrap();
    path.unload().unwrap();
    let unloading: AdhesiveBranch = path.run().unwrap();
    [unloading.pull_off() / unit, greatest / unit]
}

/// Of pull-off the cells leave 0.7 % at most, of the jump 0.4 % and, with cells of a quarter, 0.04 %: the range falls as
/// the root of the cell.
#[test]
fn a_wave_is_that_of_johnson() {
    for alpha in [0.2, 0.3] {
        let [least, most] = extremes(alpha);
        for (nodes, allowed) in [(128, 0.005), (512, 0.0005)] {
            let [found, jump] = measured(nodes, alpha);
            assert!((found / -least - 1.0).abs() < 0.01, "{alpha} {nodes}: {found} {least}");
            assert!((jump / most - 1.0).abs() < allowed, "{alpha} {nodes}: {jump} {most}");
        }
    }
}

/// What a front costs that goes back and forth between two areas, over w times the area that it sweeps.
fn lost([kx, ky]: [f64; 2], resolution: f64) -> f64 {
    let nodes = 32;
    let kernel = PeriodicBoussinesq::new(Grid::square(nodes, 1.0).unwrap(), 1.0).unwrap();
    let unit = Adhesion::work(1e-9).range(1.0).on(&kernel).unwrap().resolution() / 1e-9;
    let surface = wave((nodes, nodes), [kx, ky], 0.02);
    let work = 1.8e-4;
    let law = Adhesion::work(work).range((work * unit / resolution).sqrt());
    let builder = AdhesivePath::builder(&surface, &kernel, law);
    let mut path = builder.until(ContactTarget::AreaFraction(0.5)).build().unwrap();
    assert!((path.law().resolution() / resolution - 1.0).abs() < 1e-12);
    path.run().unwrap();
    // A little on, where no nodes are left that touch together with the last.
    let approach = path.state().unwrap().contact.approach;
    path.load_to(ContactTarget::Approach(approach + 1e-6 * approach.abs())).unwrap();
    path.run().unwrap();
    let begin = path.state().unwrap();
    path.unload_to(ContactTarget::AreaFraction(0.25)).unwrap();
    path.run().unwrap();
    let middle = path.state().unwrap();
    path.load_to(ContactTarget::Approach(begin.contact.approach)).unwrap();
    path.run().unwrap();
    let end = path.state().unwrap();
    let swept = begin.contact.contact_area - middle.contact.contact_area;
    assert!(swept > 0.2, "{kx} {ky}: {swept}");
    assert_eq!(end.contact.contact_nodes, begin.contact.contact_nodes);
    (end.dissipated - begin.dissipated) / (2.0 * swept * work)
}

/// Fronts at 0°, 26.6° and 45° to the rows of cells, with k C(0,0) of 0.4 and 0.5: those that cross the rows cost nothing,
/// and where whole rows go at once it is less than a hundredth of w.
#[test]
fn fronts_cross_the_cells_without_a_loop() {
    for resolution in [0.4, 0.5] {
        let along = lost([1.0, 0.0], resolution);
        assert!((-1e-10..0.01).contains(&along), "{resolution}: {along}");
        for wave in [[2.0, 1.0], [1.0, 1.0]] {
            let across = lost(wave, resolution);
            // Rounding of energies of the order of w.
            assert!(across.abs() < 1e-10, "{resolution} {wave:?}: {across}");
        }
    }
}
