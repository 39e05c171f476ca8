//! Statistics of a few maps, for comparison with tamaas and SurfaceTopography.
//!
//! Prints lines `map,quantity,value`; `studies/statistics/compare.py` adds the numbers of the others and writes
//! `docs/statistics.md`.

use std::error::Error;
use std::path::Path;

use asperity::Grid;
use asperity::io::read_npy;
use asperity::nalgebra::DMatrix;
use asperity::surface::{Axis, RadialBins, Topography, Trend, fill_missing};

/// The conjugate of the golden ratio, whose multiples have fractions that look random.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

fn main() -> Result<(), Box<dyn Error>> {
    println!("map,quantity,value");
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data");
    let stored = |name: &str| read_npy(data.join(format!("{name}.npy")));
    report("periodic_32x24", stored("periodic_32x24")?, (2e-5, 3e-5))?;
    report("selfaffine_48", stored("selfaffine_48")?, (1e-2 / 48.0, 1e-2 / 48.0))?;
    report("periodic_128", stored("periodic_128")?, (1.0 / 128.0, 1.0 / 128.0))?;
    report("formula_45x28", formula(), (2e-6, 3.5e-6))?;
    Ok(())
}

/// Noise of all waves on a tilted plane.
fn formula() -> DMatrix<f64> {
    DMatrix::from_fn(45, 28, |ix, iy| {
        let noise = (GOLDEN * (ix * ix + 3 * ix * iy + 5 * iy * iy + ix) as f64).fract();
        1e-6 * (noise + 0.03 * ix as f64 - 0.02 * iy as f64)
    })
}

/// Prints what is compared of one map with cells of dx × dy.
fn report(name: &str, heights: DMatrix<f64>, cell: (f64, f64)) -> Result<(), asperity::Error> {
    let (nx, ny) = heights.shape();
    let print = |quantity: &str, value: f64| println!("{name},\"{quantity}\",{value:e}");
    let map = Topography::new(Grid::new(nx, ny, cell.0, cell.1)?, heights.clone())?;

    print("rms height", map.map().rms_height());
    print("rms gradient, differences", map.rms_gradient());
    print("rms slope along x, differences", map.rms_slopes().0);
    print("rms slope along y, differences", map.rms_slopes().1);
    print("rms Laplacian, differences", map.rms_laplacian());
    print("rms curvature, differences", map.rms_curvature());
    let moments = map.spectral_moments();
    print("m20", moments.m20());
    print("m02", moments.m02());
    print("rms gradient, spectral", moments.rms_gradient());
    print("rms Laplacian, spectral", moments.rms_laplacian());
    print("Nayak's parameter", moments.nayak_parameter());

    let fitted = map.trend(Trend::Plane);
    print("tilt of the plane", fitted.tilt());
    print("rms height above the plane", map.level(Trend::Plane)?.map().rms_height());
    let level = map.level(Trend::Quadratic)?;
    print("rms height above the quadratic", level.map().rms_height());

    // The square of side 1 that tamaas takes every map for.
    let unit = Topography::new(Grid::with_sides(nx, ny, 1.0, 1.0)?, heights.clone())?;
    let moments = unit.spectral_moments();
    print("unit square: m0", moments.m0());
    print("unit square: m2", moments.m2());
    print("unit square: m4", moments.m4());
    let thirds = (moments.m40() + 3.0 * moments.m22() + moments.m04()) / 3.0;
    print("unit square: (m40 + 3 m22 + m04)/3", thirds);
    print("unit square: rms gradient, spectral", moments.rms_gradient());
    let pressure = unit.full_contact_pressure(1.0)?;
    print("unit square: least mean pressure of full contact over E*", -pressure.min());

    // A disc and a third of all other nodes are missing.
    let missing = |ix: usize, iy: usize| {
        let (x, y) = (2.0 * ix as f64 - nx as f64, 2.0 * iy as f64 - ny as f64);
        x * x + y * y < 0.2 * (nx * ny) as f64 || (GOLDEN * (ix + nx * iy) as f64).fract() < 0.33
    };
    let holed =
        DMatrix::from_fn(
            nx,
            ny,
            |ix, iy| {
                if missing(ix, iy) { f64::NAN } else { heights[(ix, iy)] }
            },
        );
    let filled = fill_missing(holed)?;
    print(
        "rms height with missing nodes filled",
        Topography::new(*map.grid(), filled)?.map().rms_height(),
    );

    for (k, bin) in map.radial_psd(&RadialBins::PerDecade(10))?.iter().enumerate() {
        print(&format!("radial wavevector {k}"), bin.wavevector);
        print(&format!("radial density {k}"), bin.density);
    }
    for (axis, letter) in [(Axis::X, 'x'), (Axis::Y, 'y')] {
        for (k, bin) in map.psd_along(axis).iter().enumerate() {
            print(&format!("profile wavevector along {letter} {k}"), bin.wavevector);
            print(&format!("profile density along {letter} {k}"), bin.density);
        }
    }
    Ok(())
}
