//! What has no answer.

use asperity::kernel::{Base, Layer, Layered, LayeredBody};
use asperity::stress::Subsurface;
use asperity::{Boundary, Error, Grid, StressError};
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

/// Tractions on layers, depths in a rigid base, and layers far thinner than a cell of a grid that repeats.
#[test]
fn what_layers_do_not_have_is_refused() -> Result<(), Error> {
    let grid = Grid::square(8, 8e-6)?;
    let load = DMatrix::from_element(8, 8, 1.0);
    let coat = |thickness| Layer { youngs_modulus: 400e9, poissons_ratio: 0.25, thickness };
    let sheet = LayeredBody::new(&[coat(1e-6)], Base::Rigid)?;
    let sheet = Subsurface::of(&Layered::free(grid, sheet)?, 0.3)?;
    assert!(matches!(sheet.clone().sliding(0.1, 0.0), Err(Error::NotHomogeneous { .. })));
    let pulled = sheet.under_traction((&load, 1e-7), [&load, &DMatrix::zeros(8, 8)]);
    assert!(matches!(pulled, Err(Error::NotHomogeneous { .. })));
    let deep = sheet.at_depth(&load, 1.1e-6);
    assert!(matches!(deep, Err(Error::Stress(StressError::InRigidBase { .. }))), "{deep:?}");
    assert!(sheet.survey(&load, None)?.depths.iter().all(|depth| depth.depth <= 1e-6));
    let thin = LayeredBody::new(
        &[coat(1e-7)],
        Base::HalfSpace { youngs_modulus: 210e9, poissons_ratio: 0.3 },
    )?;
    let thin = Subsurface::of(&Layered::periodic(grid, thin)?, 0.3)?;
    assert!(matches!(thin.at_depth(&load, 1e-7), Err(Error::OutOfRange { .. })));
    Ok(())
}

/// Flat cells that repeat have more of their kind within reach than memory holds.
#[test]
fn flat_cells_that_repeat_are_refused() -> Result<(), Error> {
    for aspect in [1e6, 1e20] {
        let boundaries = [Boundary::Periodic, Boundary::PeriodicX, Boundary::PeriodicY];
        for (boundary, (dx, dy)) in
            boundaries.into_iter().flat_map(|b| [(b, (1.0, aspect)), (b, (aspect, 1.0))])
        {
            let refused = Subsurface::new(Grid::new(4, 4, dx, dy)?, boundary, 0.3);
            let is_typed =
                matches!(refused, Err(Error::OutOfRange { value, .. }) if value == aspect);
            assert!(is_typed, "{boundary:?} {aspect} {refused:?}");
        }
        let free = Subsurface::new(Grid::new(4, 4, 1.0, aspect)?, Boundary::Free, 0.3)?;
        assert!(free.at_depth(&DMatrix::from_element(4, 4, 1.0), 0.5).is_ok());
    }
    Ok(())
}
