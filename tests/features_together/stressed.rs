//! Stresses below the surface, beside sums of point forces and planes that carry the load.

use asperity::stress::{Measure, Subsurface};
use asperity::{Boundary, Error};

use super::rows::Pressed;

const POISSON: f64 = 0.3;

/// σzz, and the trace, of point forces at the middles of parts of all cells.
fn of_points(
    pressure: &nalgebra::DMatrix<f64>,
    (dx, dy): (f64, f64),
    (x, y, z): (f64, f64, f64),
) -> (f64, f64) {
    const PARTS: usize = 4;
    let part = |k: usize| (k as f64 + 0.5) / PARTS as f64 - 0.5;
    let (mut down, mut trace) = (0.0, 0.0);
    for iy in 0..pressure.ncols() {
        for ix in 0..pressure.nrows() {
            let force = pressure[(ix, iy)] * dx * dy / (PARTS * PARTS) as f64;
            for (a, b) in (0..PARTS).flat_map(|a| (0..PARTS).map(move |b| (a, b))) {
                let (x, y) = (x - (ix as f64 + part(a)) * dx, y - (iy as f64 + part(b)) * dy);
                let rho = (x * x + y * y + z * z).sqrt();
                down -= 3.0 * force * z.powi(3) / (std::f64::consts::TAU * rho.powi(5));
                trace -= (1.0 + POISSON) * force * z / (std::f64::consts::PI * rho.powi(3));
            }
        }
    }
    (down, trace)
}

/// On the surface minus the pressure; below, sums of point forces, or the mean pressure on all planes where the grid
/// repeats. And the first load at which von Mises' stress is one that the path has passed.
pub(super) fn stress(pressed: &mut Pressed<'_>) -> Result<(), Error> {
    let name = pressed.row.name;
    let body = Subsurface::of(&*pressed.row.kernel, POISSON)?;
    let grid = body.grid();
    let states = pressed.history.states();
    let state = states[2 * states.len() / 3];
    let pressure = pressed.path.fields_at(&state)?.pressure;
    let (most, total) = (pressure.max(), pressure.sum());
    let surface = body.at_depth(&pressure, 0.0)?;
    // Sums over 300 cells, extrapolated ones with weights of up to 1023.
    assert!((&surface.zz + &pressure).amax() < 1e-11 * most, "{name}");
    if let Some(layers) = body.layers() {
        // The lower side of a layer carries what the surface does, as far as the grid reaches beyond the contact.
        let field = body.at_depth(&pressure, 0.5 * layers.layers()[0].thickness)?;
        let carried = -field.zz.sum() / total;
        assert!((0.5..1.01).contains(&carried), "{name}: {carried}");
        return Ok(());
    }
    let z = 3.0 * grid.dx().max(grid.dy());
    let field = body.at_depth(&pressure, z)?;
    match body.boundary() {
        Boundary::Free => {
            let (ix, iy) = (grid.nx() / 3, grid.ny() / 2);
            let place = (ix as f64 * grid.dx(), iy as f64 * grid.dy(), z);
            let (down, trace) = of_points(&pressure, (grid.dx(), grid.dy()), place);
            let stress = field.at(grid.index(ix, iy)).unwrap();
            // The second derivative of a point force at three cells, times (1/4)²/24.
            assert!((stress.zz - down).abs() < 5e-3 * most, "{name}: {} {down}", stress.zz);
            let found = stress.xx + stress.yy + stress.zz;
            assert!((found - trace).abs() < 5e-3 * most, "{name}: {found} {trace}");
        }
        Boundary::Periodic => assert!((field.zz.sum() / total + 1.0).abs() < 1e-12, "{name}"),
        // What a plane carries beyond the edges that do not repeat is missing.
        _ => assert!((0.8..1.0).contains(&(-field.zz.sum() / total)), "{name}"),
    }
    if body.boundary() != Boundary::Free {
        return Ok(());
    }
    let von_mises = body.survey(&pressure, None)?.greatest(Measure::VonMises).value;
    let found = body.first_yield(&mut pressed.path, &pressed.history, 0.5 * von_mises)?;
    let found = found.unwrap();
    assert!((found.greatest.value / (0.5 * von_mises) - 1.0).abs() < 0.02, "{name}: {found:?}");
    assert!(found.state.contact.load < state.contact.load, "{name}: {found:?}");
    Ok(())
}
