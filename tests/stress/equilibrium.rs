//! What holds of any load.

use asperity::stress::Subsurface;
use asperity::{Boundary, Error, Grid};
use nalgebra::DMatrix;

/// A bump that is smooth on the grid, off its middle.
fn bump(n: usize) -> DMatrix<f64> {
    DMatrix::from_fn(n, n, |ix, iy| {
        let (x, y) = (ix as f64 - 0.55 * n as f64, iy as f64 - 0.45 * n as f64);
        let r = (x * x + 1.4 * y * y).sqrt() / (0.25 * n as f64);
        if r < 1.0 { (0.5 * std::f64::consts::PI * r).cos().powi(2) } else { 0.0 }
    })
}

/// ∂σᵢⱼ/∂xⱼ = 0 by central differences, whose error falls to a quarter on cells half as wide.
#[test]
fn forces_balance_inside() -> Result<(), Error> {
    for boundary in [Boundary::Free, Boundary::Periodic, Boundary::PeriodicX, Boundary::PeriodicY] {
        let mut worst = Vec::new();
        for n in [32, 64] {
            let h = 1.0 / n as f64;
            let body = Subsurface::new(Grid::square(n, 1.0)?, boundary, 0.3)?.sliding(0.3, 0.8)?;
            let load = bump(n);
            let z = 0.15;
            let (above, here, below) = (
                body.at_depth(&load, z - h)?,
                body.at_depth(&load, z)?,
                body.at_depth(&load, z + h)?,
            );
            let mut greatest = 0.0_f64;
            for iy in 1..n - 1 {
                for ix in 1..n - 1 {
                    let x = |f: &DMatrix<f64>| (f[(ix + 1, iy)] - f[(ix - 1, iy)]) / (2.0 * h);
                    let y = |f: &DMatrix<f64>| (f[(ix, iy + 1)] - f[(ix, iy - 1)]) / (2.0 * h);
                    let z = |f: &DMatrix<f64>, g: &DMatrix<f64>| {
                        (g[(ix, iy)] - f[(ix, iy)]) / (2.0 * h)
                    };
                    let sums = [
                        x(&here.xx) + y(&here.xy) + z(&above.xz, &below.xz),
                        x(&here.xy) + y(&here.yy) + z(&above.yz, &below.yz),
                        x(&here.xz) + y(&here.yz) + z(&above.zz, &below.zz),
                    ];
                    sums.iter().for_each(|sum| greatest = greatest.max(sum.abs()));
                }
            }
            worst.push(greatest);
        }
        // Gradients are some 7; h²/6 of third derivatives of some 1/z³ is 0.01 on the finer grid.
        assert!(worst[1] < 0.1 && worst[0] > 3.0 * worst[1], "{boundary:?}: {worst:?}");
    }
    Ok(())
}

/// Each plane carries the load, and on the surface each cell its pressure and traction.
#[test]
fn each_plane_carries_the_load() -> Result<(), Error> {
    let n = 64;
    let load = bump(n);
    let grid = Grid::square(n, 1.0)?;
    let (x, y) = (0.3 * 0.8_f64.cos(), 0.3 * 0.8_f64.sin());
    for boundary in [Boundary::Free, Boundary::Periodic, Boundary::PeriodicX, Boundary::PeriodicY] {
        let body = Subsurface::new(grid, boundary, 0.3)?.sliding(0.3, 0.8)?;
        let surface = body.at_depth(&load, 0.0)?;
        for (field, ratio) in [(&surface.zz, -1.0), (&surface.xz, -x), (&surface.yz, -y)] {
            // Sums over 4096 cells, extrapolated ones with weights of up to 1023.
            assert!((field - ratio * &load).amax() < 1e-11, "{boundary:?}");
        }
    }
    let periodic = Subsurface::new(grid, Boundary::Periodic, 0.3)?.sliding(0.3, 0.8)?;
    let free = Subsurface::new(grid, Boundary::Free, 0.3)?;
    let total = load.sum();
    for z in [0.003, 0.05, 0.4] {
        let field = periodic.at_depth(&load, z)?;
        for (field, ratio) in [(&field.zz, -1.0), (&field.xz, -x), (&field.yz, -y)] {
            assert!((field.sum() / total - ratio).abs() < 1e-12, "{z}");
        }
        // Beyond the grid there is less than beyond a circle that fits in, about a point at which all load might be:
        // 0.2 from the border.
        let carried = -free.at_depth(&load, z)?.zz.sum() / total;
        let beyond = (1.0 + (0.2_f64 / z).powi(2)).powf(-1.5);
        assert!(carried < 1.0 + 1e-3 && carried > 1.0 - beyond - 1e-3, "{z}: {carried}");
    }
    Ok(())
}
