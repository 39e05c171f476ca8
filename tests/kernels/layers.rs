//! Layered bodies beside other programs: a layer on a rigid base of ContactMechanics, and coefficients of cells by
//! quadrature over all wavevectors.

use asperity::kernel::{Base, Layer, Layered, LayeredBody};
use asperity::{Grid, InfluenceKernel, KernelTable};

/// The numbers of a table without its header.
fn numbers(text: &str) -> Vec<Vec<f64>> {
    let line = |line: &str| line.split(',').map(|cell| cell.parse().unwrap()).collect();
    text.lines().skip(1).map(line).collect()
}

#[test]
fn the_layer_of_contact_mechanics() {
    let lines = numbers(include_str!("../data/layers_contact_mechanics.csv"));
    assert_eq!(lines.len(), 30);
    for line in lines {
        let [nx, ny, lx, ly, thickness, youngs_modulus, poissons_ratio, kx, ky, expected] =
            line[..]
        else {
            panic!("{line:?}");
        };
        let grid = Grid::with_sides(nx as usize, ny as usize, lx, ly).unwrap();
        let layer = Layer { youngs_modulus, poissons_ratio, thickness };
        let body = LayeredBody::new(&[layer], Base::Rigid).unwrap();
        let (qx, qy) = grid.wave_vector(kx as usize, ky as usize);
        let found = body.compliance(qx.hypot(qy));
        // Its formula loses some digits where hyperbolic functions are large, and its transform some.
        assert!((found / expected - 1.0).abs() < 1e-12, "{line:?}: {found}");
        // The same wave on the kernel.
        let table = KernelTable::new(&Layered::spectral(grid, body).unwrap()).unwrap();
        let mut sum = 0.0;
        for node in 0..grid.nodes() {
            let (ix, iy) = grid.coordinates(node);
            let turns = kx * ix as f64 / nx + ky * iy as f64 / ny;
            let c = table.coefficient(ix as isize, iy as isize).unwrap();
            sum += c * (std::f64::consts::TAU * turns).cos();
        }
        assert!((sum / expected - 1.0).abs() < 1e-12, "{line:?}: {sum}");
    }
}

/// The other body adds what a half-space gives way by, 2/(E* q).
#[test]
fn a_counterpart_gives_way_beside_the_layers() {
    let layer = Layer { youngs_modulus: 2.0, poissons_ratio: 0.3, thickness: 0.4 };
    let rigid = LayeredBody::new(&[layer], Base::Rigid).unwrap();
    let elastic = rigid.clone().against(5.0).unwrap();
    assert_eq!([rigid.counterpart(), elastic.counterpart()], [None, Some(5.0)]);
    for q in [0.1, 1.0, 30.0] {
        let added = elastic.compliance(q) - rigid.compliance(q);
        assert!((added / (2.0 / (5.0 * q)) - 1.0).abs() < 1e-13, "{q}: {added}");
    }
}

#[test]
fn cells_by_quadrature_over_all_waves() {
    let grid = Grid::square(8, 8.0).unwrap();
    let lines = numbers(include_str!("../data/layers_free.csv"));
    assert_eq!(lines.len(), 49);
    for case in lines.chunks(7) {
        let layer =
            Layer { youngs_modulus: case[0][0], poissons_ratio: case[0][1], thickness: case[0][2] };
        let base = match case[0][3] {
            0.0 => Base::Rigid,
            youngs_modulus => Base::HalfSpace { youngs_modulus, poissons_ratio: case[0][4] },
        };
        let body = LayeredBody::new(&[layer], base).unwrap();
        let alone = 1.0 / body.surface_modulus();
        let kernel = Layered::free(grid, body).unwrap();
        for line in case {
            let (di, dj) = (line[5] as isize, line[6] as isize);
            let (found, expected) = (kernel.coefficient(di, dj), line[7]);
            // Love's formula in the script loses two digits at a distance, where it is a hundredth.
            let scale = alone.max(case[0][7]);
            assert!((found - expected).abs() < 1e-14 * scale, "{line:?}: {found}");
            assert_eq!(found, kernel.coefficient(-dj, di));
        }
    }
}
