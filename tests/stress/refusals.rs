//! What has no answer.

use asperity::kernel::{Base, Layer, Layered, LayeredBody};
use asperity::stress::Subsurface;
use asperity::{Boundary, Error, Grid};
use nalgebra::DMatrix;

#[test]
fn what_makes_no_sense_is_refused() -> Result<(), Error> {
    let grid = Grid::square(4, 1.0)?;
    for nu in [-1.0, 0.51, f64::NAN] {
        assert!(matches!(Subsurface::new(grid, Boundary::Free, nu), Err(Error::OutOfRange { .. })));
    }
    let body = Subsurface::new(grid, Boundary::Free, 0.3)?;
    let load = DMatrix::from_element(4, 4, 1.0);
    for depth in [-1e-9, f64::NAN, f64::INFINITY] {
        assert!(body.at_depth(&load, depth).is_err(), "{depth}");
        assert!(body.survey(&load, Some(&[depth])).is_err(), "{depth}");
    }
    assert!(body.at_depth(&DMatrix::zeros(3, 4), 0.1).is_err());
    assert!(body.at_depth(&DMatrix::from_element(4, 4, f64::NAN), 0.1).is_err());
    assert!(body.under_traction((&load, 0.1), [&load, &DMatrix::zeros(1, 1)]).is_err());
    for (coefficient, angle) in [(f64::NAN, 0.0), (0.1, f64::INFINITY)] {
        assert!(body.clone().sliding(coefficient, angle).is_err());
    }
    // Without a load there is no stress, and no place for it.
    assert!(body.survey(&DMatrix::zeros(4, 4), None).is_err());
    assert!(body.survey(&load, Some(&[])).is_err());
    Ok(())
}

#[test]
fn layers_are_refused() -> Result<(), Error> {
    let coat = Layer { young: 400e9, poisson: 0.25, thickness: 1e-6 };
    let body = LayeredBody::new(&[coat], Base::HalfSpace { young: 210e9, poisson: 0.3 })?;
    let kernel = Layered::free(Grid::square(8, 1e-5)?, body)?;
    assert!(matches!(Subsurface::of(&kernel, 0.3), Err(Error::NotHomogeneous { .. })));
    Ok(())
}
