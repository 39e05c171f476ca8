//! A user-defined surface and kernel.

use asperity::{Boundary, ContactGrowth, Grid, InfluenceKernel, Surface, SurfaceError};
use nalgebra::DMatrix;

/// Facets of different heights and slopes: nothing in it is symmetric.
pub(crate) struct Facets {
    facets: Vec<[f64; 3]>,
}

impl Facets {
    pub(crate) fn new() -> Self {
        let facets = (0..9).map(|k| {
            let k = f64::from(k);
            [(1.3 * k).sin(), (2.1 * k + 0.4).cos(), 0.2 * (3.7 * k).sin()]
        });
        Self { facets: facets.collect() }
    }
}

/// Heights that are sampled from a surface can be taken out again, and are those of the surface.
#[test]
fn heights_are_taken_out_of_a_map() {
    let grid = Grid::new(5, 4, 1.0, 2.0).unwrap();
    let expected = Facets::new().heights(&grid).unwrap();
    let map = asperity::surface::HeightMap::sample(&Facets::new(), &grid).unwrap();
    assert_eq!(map.into_matrix(), expected);
}

impl Surface for Facets {
    fn heights(&self, grid: &Grid) -> Result<DMatrix<f64>, SurfaceError> {
        let (lx, ly) = grid.sides();
        Ok(DMatrix::from_fn(grid.nx(), grid.ny(), |ix, iy| {
            let (x, y) = grid.position(ix, iy);
            let plane = |[a, b, c]: &[f64; 3]| a * x / lx + b * y / ly + c;
            // The lower envelope of the planes, rippled so that no two nodes touch at once.
            let roof = self.facets.iter().map(plane).fold(f64::INFINITY, f64::min);
            1e-6 * (roof + 0.05 * (71.0 * x / lx + 57.0 * (y / ly).powi(2)).sin())
        }))
    }
}

/// Grains on springs, coupled by a half-space that sees them from a depth: a point force, with its
/// singularity taken away at the distance of a cell, on top of a Winkler foundation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grains {
    pub(crate) grid: Grid,
    pub(crate) e_star: f64,
    pub(crate) growth: ContactGrowth,
}

impl InfluenceKernel for Grains {
    fn grid(&self) -> Grid {
        self.grid
    }

    fn boundary(&self) -> Boundary {
        Boundary::Free
    }

    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        let (dx, dy) = (self.grid.dx(), self.grid.dy());
        let (x, y) = (di as f64 * dx, dj as f64 * dy);
        let own = if (di, dj) == (0, 0) { 1.0 } else { 0.0 };
        // The transform of 1/sqrt(r² + d²) is positive, 2π exp(-q d)/q: positive definite.
        let depth = 0.3 * dx.min(dy);
        let point = dx * dy / (std::f64::consts::PI * self.e_star * x.hypot(y).hypot(depth));
        point + own * 0.5 * dx.min(dy) / self.e_star
    }

    fn contact_growth(&self) -> ContactGrowth {
        self.growth
    }
}
