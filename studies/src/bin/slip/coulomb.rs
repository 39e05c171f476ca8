//! Coulomb's law on all nodes of a contact, step by step in the displacement: tractions of any direction within discs,
//! by Gauss and Seidel node by node (Jourdan, Alart & Jean, Comput. Methods Appl. Mech. Eng. 155 (1998) 31).

use asperity_cli::outcome::Failure;
use nalgebra::{DMatrix, DVector};

use crate::cerruti::Cerruti;

/// Change of a traction in a sweep over the greatest limit at which sweeps end.
const SETTLED: f64 = 1e-10;
/// Most sweeps of a step.
const SWEEPS: usize = 100_000;

/// Tractions of some nodes, x and y of each in turn.
pub(crate) struct Coulomb {
    influence: DMatrix<f64>,
    pub(crate) traction: DVector<f64>,
}

impl Coulomb {
    pub(crate) fn new(half_space: &Cerruti, nodes: &[usize]) -> Self {
        let [along, mixed, across] = [&half_space.along, &half_space.mixed, &half_space.across]
            .map(|table| half_space.between(table, nodes, nodes));
        let size = 2 * nodes.len();
        let influence = DMatrix::from_fn(size, size, |i, j| {
            let part = match (i % 2, j % 2) {
                (0, 0) => &along,
                (1, 1) => &across,
                _ => &mixed,
            };
            part[(i / 2, j / 2)]
        });
        Self { influence, traction: DVector::zeros(size) }
    }

    /// Displacements under the tractions.
    pub(crate) fn displacement(&self) -> DVector<f64> {
        &self.influence * &self.traction
    }

    /// The tractions that make these displacements where they stay within their limits; where they do not, they are at
    /// the limit and against what is missing.
    pub(crate) fn solve(&mut self, wanted: &DVector<f64>, limits: &[f64]) -> Result<(), Failure> {
        let scale = limits.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let mut missing = wanted - self.displacement();
        for _ in 0..SWEEPS {
            let mut change = 0.0_f64;
            for (node, limit) in limits.iter().enumerate() {
                let (ix, iy) = (2 * node, 2 * node + 1);
                // Of a square cell both are the same, and a traction along one axis does not displace along the other.
                let own = self.influence[(ix, ix)];
                let free =
                    [self.traction[ix] + missing[ix] / own, self.traction[iy] + missing[iy] / own];
                let size = free[0].hypot(free[1]);
                let share = if size > *limit { limit / size } else { 1.0 };
                for (axis, index) in [ix, iy].into_iter().enumerate() {
                    let step = share * free[axis] - self.traction[index];
                    if step != 0.0 {
                        self.traction[index] += step;
                        missing.axpy(-step, &self.influence.column(index), 1.0);
                        change = change.max(step.abs());
                    }
                }
            }
            if change < SETTLED * scale {
                return Ok(());
            }
        }
        Err(Failure::request("the tractions of a step do not settle"))
    }

    /// Sum of the tractions along x.
    pub(crate) fn force(&self) -> f64 {
        self.traction.iter().step_by(2).sum()
    }

    /// Sum of the sizes of tractions along y over that along x.
    pub(crate) fn across(&self) -> f64 {
        let sum = |first: usize| -> f64 {
            self.traction.iter().skip(first).step_by(2).map(|q| q.abs()).sum()
        };
        sum(1) / sum(0)
    }
}
