//! Shapes with closed-form contact solutions: paraboloids, cylinder, cone, flat punch.

use nalgebra::DMatrix;

use super::placement::{Axis, Placement};
use crate::{Error, Grid, Surface};

/// Makes a shape with a `placement` a surface of this height at (x, y) from there, and adds `centered_at`.
macro_rules! placed {
    ($shape:ty, $point:literal, |$this:ident, $x:ident, $y:ident| $height:expr) => {
        impl $shape {
            #[doc = concat!("Puts ", $point, " at (x, y) \\[m\\] instead of the centre of the grid.")]
            ///
            /// Positions are those of [`Grid::position`]. A point outside the grid is allowed. If
            /// it lies on a node, or midway between two, nodes that mirror each other get heights
            /// that are equal bit for bit.
            ///
            /// # Errors
            ///
            /// [`Error::OutOfRange`] for a coordinate that is not finite.
            pub fn centered_at(mut self, x: f64, y: f64) -> Result<Self, Error> {
                self.placement = Placement::at(x, y)?;
                Ok(self)
            }
        }

        impl Surface for $shape {
            fn heights(&self, grid: &Grid) -> Result<DMatrix<f64>, Error> {
                let $this = self;
                self.placement.heights(grid, |$x, $y| $height)
            }
        }
    };
}
pub(super) use placed;

/// A paraboloid of revolution, the parabolic stand-in for a sphere of radius R.
///
/// ```math
/// z = -\frac{x^2 + y^2}{2R}
/// ```
///
/// with x and y measured from the apex, which is at height 0 in the centre of the grid unless
/// moved by [`centered_at`](Self::centered_at). Hertz's point contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paraboloid {
    radius: f64,
    placement: Placement,
}

getters!(Paraboloid {
    /// Radius of curvature R \[m\].
    radius: f64,
});

impl Paraboloid {
    /// A paraboloid with radius of curvature `radius` \[m\] at its apex.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for a radius that is not positive and finite.
    pub fn new(radius: f64) -> Result<Self, Error> {
        let radius = Error::require_positive("radius", radius)?;
        Ok(Self { radius, placement: Placement::default() })
    }
}

placed!(Paraboloid, "the apex", |this, x, y| -(x * x + y * y) / (2.0 * this.radius));

/// A paraboloid with different radii of curvature along x and y.
///
/// ```math
/// z = -\frac{x^2}{2R_x} - \frac{y^2}{2R_y}
/// ```
///
/// with x and y measured from the apex, which is at height 0 in the centre of the grid unless
/// moved by [`centered_at`](Self::centered_at). Hertz's elliptic contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EllipticParaboloid {
    radius_x: f64,
    radius_y: f64,
    placement: Placement,
}

impl EllipticParaboloid {
    /// A paraboloid with radii of curvature `radius_x` in the x-z plane and `radius_y` in the y-z
    /// plane \[m\].
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for a radius that is not positive and finite.
    pub fn new(radius_x: f64, radius_y: f64) -> Result<Self, Error> {
        let radius_x = Error::require_positive("radius along x", radius_x)?;
        let radius_y = Error::require_positive("radius along y", radius_y)?;
        Ok(Self { radius_x, radius_y, placement: Placement::default() })
    }

    /// Radii of curvature R_x and R_y \[m\].
    #[must_use]
    pub fn radii(&self) -> (f64, f64) {
        (self.radius_x, self.radius_y)
    }
}

placed!(EllipticParaboloid, "the apex", |this, x, y| {
    -(x * x / (2.0 * this.radius_x) + y * y / (2.0 * this.radius_y))
});

/// A parabolic cylinder, the parabolic stand-in for a circular one of radius R.
///
/// ```math
/// z = -\frac{x^2}{2R}
/// ```
///
/// for a cylinder that lies along y, and the same with y for one that lies along x. The distance
/// is measured from the ridge, which is at height 0 through the centre of the grid unless moved by
/// [`centered_at`](Self::centered_at). It reaches across the whole grid and ends there: on a free
/// half-space the pressure is Hertz's line contact only far from its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cylinder {
    radius: f64,
    axis: Axis,
    placement: Placement,
}

getters!(Cylinder {
    /// Radius of curvature R \[m\].
    radius: f64,
    /// Direction of the ridge.
    axis: Axis,
});

impl Cylinder {
    /// A cylinder of radius `radius` \[m\] whose ridge runs along `axis`.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for a radius that is not positive and finite.
    pub fn new(radius: f64, axis: Axis) -> Result<Self, Error> {
        let radius = Error::require_positive("radius", radius)?;
        Ok(Self { radius, axis, placement: Placement::default() })
    }
}

placed!(Cylinder, "a point of the ridge", |this, x, y| {
    let across = this.axis.of((y, x));
    -across * across / (2.0 * this.radius)
});

/// A cone.
///
/// ```math
/// z = -t \sqrt{x^2 + y^2}
/// ```
///
/// with x and y measured from the apex, which is at height 0 in the centre of the grid unless
/// moved by [`centered_at`](Self::centered_at). Sneddon's contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    slope: f64,
    placement: Placement,
}

getters!(Cone {
    /// Slope t of the flank, without unit.
    slope: f64,
});

impl Cone {
    /// A cone whose flank falls by `slope` = t metres a metre: the tangent of the angle between
    /// flank and base.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for a slope that is not positive and finite.
    pub fn new(slope: f64) -> Result<Self, Error> {
        let slope = Error::require_positive("slope", slope)?;
        Ok(Self { slope, placement: Placement::default() })
    }
}

placed!(Cone, "the apex", |this, x, y| -this.slope * libm::hypot(x, y));

/// A rigid flat punch as large as the grid: one height everywhere.
///
/// Every node touches at the same approach. Its stiffness bounds that of any rough surface on the
/// same grid.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FlatPunch {
    height: f64,
}

getters!(FlatPunch {
    /// The height \[m\].
    height: f64,
});

impl FlatPunch {
    /// A flat punch at height `height` \[m\]; [`FlatPunch::default`] lies at 0.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a height that is not finite.
    pub fn new(height: f64) -> Result<Self, Error> {
        Ok(Self { height: Error::require_finite("height", height)? })
    }
}

impl Surface for FlatPunch {
    fn heights(&self, grid: &Grid) -> Result<DMatrix<f64>, Error> {
        Ok(DMatrix::from_element(grid.nx(), grid.ny(), self.height))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Heights equal bit for bit under x -> -x and y -> -y.
    pub(crate) fn assert_mirrored(heights: &DMatrix<f64>) {
        let (nx, ny) = heights.shape();
        for ix in 0..nx {
            for iy in 0..ny {
                let z = heights[(ix, iy)].to_bits();
                assert_eq!(z, heights[(nx - 1 - ix, iy)].to_bits(), "{ix} {iy}");
                assert_eq!(z, heights[(ix, ny - 1 - iy)].to_bits(), "{ix} {iy}");
            }
        }
    }

    /// Sizes, odd and even, and cells without a short binary form.
    fn grids() -> Result<Vec<Grid>, Error> {
        [(1, 1), (2, 3), (16, 16), (33, 20), (1, 47), (57, 57)]
            .into_iter()
            .map(|(nx, ny)| Grid::with_sides(nx, ny, 1.1e-3, 0.7e-3))
            .collect()
    }

    #[test]
    fn shapes_are_symmetric_bit_for_bit() -> Result<(), Error> {
        for grid in grids()? {
            assert_mirrored(&Paraboloid::new(0.3)?.heights(&grid)?);
            assert_mirrored(&EllipticParaboloid::new(0.3, 0.7)?.heights(&grid)?);
            assert_mirrored(&Cylinder::new(0.3, Axis::X)?.heights(&grid)?);
            assert_mirrored(&Cylinder::new(0.3, Axis::Y)?.heights(&grid)?);
            assert_mirrored(&Cone::new(0.1)?.heights(&grid)?);
            assert_mirrored(&FlatPunch::new(-2e-6)?.heights(&grid)?);
            let (cx, cy) = grid.center();
            let centered = Cone::new(0.1)?.centered_at(cx, cy)?.heights(&grid)?;
            assert_eq!(centered, Cone::new(0.1)?.heights(&grid)?);
        }
        let square = Grid::square(31, 1.1e-3)?;
        for heights in [Paraboloid::new(0.3)?.heights(&square)?, Cone::new(0.3)?.heights(&square)?]
        {
            assert_eq!(heights, heights.transpose());
        }
        Ok(())
    }

    #[test]
    fn shapes_follow_their_equations() -> Result<(), Error> {
        let grid = Grid::new(9, 7, 1e-3, 2e-3)?;
        let (cx, cy) = (3.5e-3, 5e-3);
        let paraboloid = Paraboloid::new(0.5)?.centered_at(cx, cy)?.heights(&grid)?;
        let elliptic = EllipticParaboloid::new(0.5, 0.25)?.centered_at(cx, cy)?.heights(&grid)?;
        let along_x = Cylinder::new(0.5, Axis::X)?.centered_at(cx, cy)?.heights(&grid)?;
        let along_y = Cylinder::new(0.5, Axis::Y)?.centered_at(cx, cy)?.heights(&grid)?;
        let cone = Cone::new(0.2)?.centered_at(cx, cy)?.heights(&grid)?;
        for ix in 0..9 {
            for iy in 0..7 {
                let (x, y) = grid.position(ix, iy);
                let (x, y) = (x - cx, y - cy);
                // Heights below 2e-3, each side rounded a few times.
                let close = |z: f64, expected: f64| assert!((z - expected).abs() < 1e-17);
                close(paraboloid[(ix, iy)], -x * x - y * y);
                close(elliptic[(ix, iy)], -x * x - 2.0 * y * y);
                close(along_x[(ix, iy)], -y * y);
                close(along_y[(ix, iy)], -x * x);
                close(cone[(ix, iy)], -0.2 * (x * x + y * y).sqrt());
            }
        }
        // The apex is on node (3, 2), at height +0.
        assert_eq!(paraboloid[(3, 2)].to_bits(), 0);
        assert_eq!(cone[(3, 2)].to_bits(), 0);
        assert_eq!(FlatPunch::default().heights(&grid)?, DMatrix::zeros(9, 7));
        Ok(())
    }

    /// Parameters are kept, each under its own name.
    #[test]
    fn shapes_say_what_they_were_made_of() -> Result<(), Error> {
        assert_eq!(Paraboloid::new(0.5)?.radius(), 0.5);
        assert_eq!(EllipticParaboloid::new(0.5, 0.25)?.radii(), (0.5, 0.25));
        let cylinder = Cylinder::new(0.5, Axis::Y)?;
        assert_eq!((cylinder.radius(), cylinder.axis()), (0.5, Axis::Y));
        assert_eq!(Cone::new(0.2)?.slope(), 0.2);
        assert_eq!(FlatPunch::new(-2e-6)?.height(), -2e-6);
        Ok(())
    }

    #[test]
    fn bad_parameters_are_refused() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            for error in [
                Paraboloid::new(bad).err(),
                EllipticParaboloid::new(bad, 1.0).err(),
                EllipticParaboloid::new(1.0, bad).err(),
                Cylinder::new(bad, Axis::X).err(),
                Cone::new(bad).err(),
            ] {
                assert!(matches!(error, Some(Error::NotPositive { .. })));
            }
        }
        assert!(matches!(FlatPunch::new(f64::NAN), Err(Error::OutOfRange { .. })));
    }

    #[test]
    fn heights_beyond_the_range_of_numbers_are_refused() -> Result<(), Error> {
        let grid = Grid::square(4, 1e10)?;
        let heights = Paraboloid::new(1e-300)?.heights(&grid);
        assert!(matches!(heights, Err(Error::HeightNotFinite { ix: 0, iy: 0, .. })));
        Ok(())
    }
}
