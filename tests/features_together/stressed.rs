//! Stresses below the surface, beside sums of point forces and planes that carry the load.

use asperity::kernel::{Base, Layered, LayeredBody};
use asperity::stress::{Measure, Subsurface};
use asperity::{Boundary, Error, Grid};
use nalgebra::DMatrix;

use super::rows::Pressed;

const POISSON: f64 = 0.3;

/// σzz, and the trace, of point forces at the middles of parts of all cells and of their images.
fn of_images(
    pressure: &DMatrix<f64>,
    grid: &Grid,
    repeats: [bool; 2],
    (x, y, z): (f64, f64, f64),
) -> (f64, f64) {
    // Of uniform pressure σzz lacks (z/NL)³ without those that are farther than N sides if both repeat, and less if one
    // does; the trace along one side (1 + ν) z Lᵧ/(π N² L²).
    let far = if repeats == [true; 2] { 5 } else { 20 };
    let [along_x, along_y] = repeats.map(|repeats| if repeats { -far..=far } else { 0..=0 });
    let sides = grid.sides();
    let images = along_y.flat_map(|b| along_x.clone().map(move |a| (a, b)));
    let stresses = images.map(|(a, b)| {
        let place = (x + f64::from(a) * sides.0, y + f64::from(b) * sides.1, z);
        of_points(pressure, (grid.dx(), grid.dy()), place)
    });
    stresses.fold((0.0, 0.0), |sum, one| (sum.0 + one.0, sum.1 + one.1))
}

fn of_points(
    pressure: &DMatrix<f64>,
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

/// The layers of a row carry what is on them; and if all below were of the same material they would have its stresses.
fn of_layers(
    (name, boundary): (&str, Boundary),
    body: &Subsurface,
    pressure: &DMatrix<f64>,
) -> Result<(), Error> {
    let (grid, layers) = (body.grid(), body.layers().unwrap());
    let on = |grid: Grid, body: LayeredBody| match boundary {
        Boundary::Free => Layered::free(grid, body),
        _ => Layered::periodic(grid, body),
    };
    let top = layers.layers()[0];
    let middle = 0.5 * top.thickness;
    if boundary == Boundary::Free {
        // On a plane some fifty times as wide as it is deep. A stiff layer, a plate on what lies below, spreads the
        // load over some four times its thickness, and beyond (4z/R)³ is missing.
        let wide = 5;
        let around = Grid::new(wide * grid.nx(), wide * grid.ny(), grid.dx(), grid.dy())?;
        let (x, y) = (wide / 2 * grid.nx(), wide / 2 * grid.ny());
        let mut load = DMatrix::zeros(around.nx(), around.ny());
        load.view_mut((x, y), pressure.shape()).copy_from(pressure);
        let field =
            Subsurface::of(&on(around, layers.clone())?, POISSON)?.at_depth(&load, middle)?;
        let carried = -field.zz.sum() / pressure.sum();
        assert!((carried - 1.0).abs() < 1e-3, "{name}: {carried}");
        // The grid cuts a part of it out.
        let part = body.at_depth(pressure, middle)?.zz;
        let found = field.zz.view((x, y), pressure.shape()).into_owned();
        assert!((part - found).amax() < 1e-9 * pressure.max(), "{name}");
    } else {
        let carried = -body.at_depth(pressure, middle)?.zz.sum() / pressure.sum();
        assert!((carried - 1.0).abs() < 1e-11, "{name}: {carried}");
    }
    let (youngs_modulus, poissons_ratio) = (top.youngs_modulus, top.poissons_ratio);
    let same = Base::HalfSpace { youngs_modulus, poissons_ratio };
    let same = Subsurface::of(&on(grid, LayeredBody::new(&[top], same)?)?, POISSON)?;
    let plain = Subsurface::new(grid, boundary, poissons_ratio)?;
    for depth in [middle, 2.0 * top.thickness] {
        let [found, expected] = [same.at_depth(pressure, depth)?, plain.at_depth(pressure, depth)?];
        for (found, expected) in [
            (&found.xx, &expected.xx),
            (&found.yy, &expected.yy),
            (&found.zz, &expected.zz),
            (&found.xz, &expected.xz),
        ] {
            // What stresses of layers are right to.
            assert!((found - expected).amax() < 1e-9 * pressure.max(), "{name}, {depth}");
        }
    }
    Ok(())
}

/// On the surface minus the pressure; below, sums of point forces and of their images, and the mean pressure on all
/// planes where the grid repeats. And the first load at which von Mises' stress is one that the path has passed.
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
    if body.layers().is_some() {
        return of_layers((name, body.boundary()), &body, &pressure);
    }
    let z = 3.0 * grid.dx().max(grid.dy());
    let field = body.at_depth(&pressure, z)?;
    let (ix, iy) = (grid.nx() / 3, grid.ny() / 2);
    let place = (ix as f64 * grid.dx(), iy as f64 * grid.dy(), z);
    let repeats = body.boundary().repeats();
    let (down, trace) = of_images(&pressure, &grid, repeats, place);
    let stress = field.at(grid.index(ix, iy)).unwrap();
    // The second derivative of a point force at three cells, times (1/4)²/24.
    assert!((stress.zz - down).abs() < 5e-3 * most, "{name}: {} {down}", stress.zz);
    if body.boundary() == Boundary::Periodic {
        // That of a uniform pressure depends on how its plane ends.
        assert!((field.zz.sum() / total + 1.0).abs() < 1e-12, "{name}");
    } else {
        let found = stress.xx + stress.yy + stress.zz;
        assert!((found - trace).abs() < 5e-3 * most, "{name}: {found} {trace}");
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
