//! The half-spaces and surfaces of these tests.

use asperity::surface::HeightMap;
use asperity::{
    Boundary, Boussinesq, ContactGrowth, FixedLoadSolver, Grid, InfluenceKernel,
    PeriodicBoussinesq, Spectral,
};

/// A free half-space or one of two periodic ones.
#[derive(Debug, Clone)]
pub(crate) enum Kernel {
    Free(Box<Boussinesq>),
    Love(PeriodicBoussinesq),
    Spectral(Spectral),
}

impl Kernel {
    pub(crate) fn free(grid: Grid, e_star: f64) -> Self {
        Self::Free(Box::new(Boussinesq::new(grid, e_star).unwrap()))
    }

    pub(crate) fn periodic(grid: Grid, e_star: f64) -> [Self; 2] {
        [
            Self::Love(PeriodicBoussinesq::new(grid, e_star).unwrap()),
            Self::Spectral(Spectral::new(grid, e_star).unwrap()),
        ]
    }

    pub(crate) fn all(grid: Grid, e_star: f64) -> [Self; 3] {
        let [love, spectral] = Self::periodic(grid, e_star);
        [Self::free(grid, e_star), love, spectral]
    }

    fn any(&self) -> &dyn InfluenceKernel {
        match self {
            Self::Free(kernel) => kernel,
            Self::Love(kernel) => kernel,
            Self::Spectral(kernel) => kernel,
        }
    }

    /// In `factor` times its gauge, if it has one.
    pub(crate) fn in_gauge(self, factor: f64) -> Self {
        match self {
            Self::Free(_) => self,
            Self::Love(kernel) => {
                let gauge = factor * kernel.gauge();
                Self::Love(kernel.with_gauge(gauge).unwrap())
            }
            Self::Spectral(kernel) => {
                let gauge = factor * kernel.gauge();
                Self::Spectral(kernel.with_gauge(gauge).unwrap())
            }
        }
    }

    /// Eigenvalue of a wave, of a periodic one.
    pub(crate) fn symbol(&self, kx: usize, ky: usize) -> f64 {
        let (kx, ky) = (kx as isize, ky as isize);
        match self {
            Self::Free(_) => panic!("a free half-space has no waves of its own"),
            Self::Love(kernel) => kernel.symbol(kx, ky),
            Self::Spectral(kernel) => kernel.symbol(kx, ky),
        }
    }

    /// C(0, 0), in the zero gauge if the mean displacement is arbitrary.
    pub(crate) fn self_influence(&self) -> f64 {
        let gauge = match self {
            Self::Free(_) => 0.0,
            Self::Love(kernel) => kernel.gauge(),
            Self::Spectral(kernel) => kernel.gauge(),
        };
        self.coefficient(0, 0) - gauge
    }
}

impl InfluenceKernel for Kernel {
    fn grid(&self) -> Grid {
        self.any().grid()
    }

    fn boundary(&self) -> Boundary {
        self.any().boundary()
    }

    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        self.any().coefficient(di, dj)
    }

    fn contact_growth(&self) -> ContactGrowth {
        self.any().contact_growth()
    }
}

/// A kernel with nothing but the required methods.
pub(crate) struct Plain(pub(crate) Boussinesq);

impl InfluenceKernel for Plain {
    fn grid(&self) -> Grid {
        self.0.grid()
    }

    fn boundary(&self) -> Boundary {
        Boundary::Free
    }

    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        self.0.coefficient(di, dj)
    }
}

/// A solver with this tolerance.
pub(crate) fn solver(
    surface: &HeightMap,
    kernel: &dyn InfluenceKernel,
    tolerance: f64,
) -> FixedLoadSolver {
    FixedLoadSolver::builder(surface, kernel).tolerance(tolerance).build().unwrap()
}
