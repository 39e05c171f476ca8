//! The recursive Cholesky factorisation.

use std::time::Instant;

use super::factor::{CholeskyTimings, Factor};
use super::panels::ROWS;
use super::{LinearUpdater, MixedCholesky, Schur, Solution, System, Touched};
use crate::{Error, parallel};

/// The Cholesky factor of the contact set's influence matrix, grown by one row for each node that
/// touches (paper, eqs. 14-19), in blocks.
///
/// The factor $C_{II} = L L^T$ is stored as its lower half, 4n² bytes for n nodes. With it grow
/// the forward-substituted right-hand sides $L^{-1}B$ and the columns $F = L^{-1}C_{IP}$ of the
/// watched nodes P, so that
///
/// * the Schur complement is $C_{PP} - F^T F$, and only nodes that were not watched before cost a
///   forward substitution (n² flops each);
/// * a node that touches has its row of L ready, $[F_j^T, \ldots]$: the paper's $l^n$ (eq. 16);
/// * a solution costs one backward substitution (eq. 17).
///
/// [`timings`](Self::timings) says where the time went.
#[derive(Debug, Clone)]
pub struct RecursiveCholesky {
    factor: Factor<f64>,
    /// $L^{-1} B$, row by row.
    border: Vec<[f64; System::RHS]>,
}

impl Default for RecursiveCholesky {
    fn default() -> Self {
        Self::new()
    }
}

impl RecursiveCholesky {
    /// An empty contact set.
    #[must_use]
    pub fn new() -> Self {
        Self {
            factor: Factor::new(),
            border: Vec::new(),
        }
    }

    /// The same with a factor in single precision: half the memory, twice the speed; see
    /// [`MixedCholesky`] for what remains exact.
    #[must_use]
    pub fn mixed() -> MixedCholesky {
        MixedCholesky::new()
    }

    /// The factor of a contact set that is known as a whole.
    pub(crate) fn of(system: &System, contact: &[usize]) -> Result<Self, Error> {
        let mut updater = Self::new();
        let (mut schur, mut touched) = (Schur::default(), Touched::default());
        for nodes in contact.chunks(ROWS) {
            updater.schur(system, nodes, &mut schur)?;
            touched.reset(nodes.len());
            let mut reduced = schur.rhs().to_vec();
            for (position, &node) in nodes.iter().enumerate() {
                touched
                    .push(&mut schur, node, position, &mut reduced)
                    .map_err(|_| Error::FactorizationFailed {
                        nodes: contact.len(),
                    })?;
            }
            updater.commit(system, &touched)?;
        }
        Ok(updater)
    }

    /// Bytes held at most while [`Self::of`] factors `contact` nodes.
    pub(crate) fn bytes_of(contact: usize) -> usize {
        let window = 2 * ROWS * ROWS * size_of::<f64>();
        Self::new().bytes(contact, ROWS).saturating_add(window)
    }

    /// The factor alone.
    pub(super) fn into_factor(self) -> Factor<f64> {
        self.factor
    }

    /// Where the time went so far.
    #[must_use]
    pub fn timings(&self) -> CholeskyTimings {
        self.factor.timings
    }
}

impl LinearUpdater for RecursiveCholesky {
    /// Nodes that were watched before are recognised if they come first and in the same order;
    /// only the others cost a forward substitution.
    fn schur(&mut self, system: &System, nodes: &[usize], schur: &mut Schur) -> Result<(), Error> {
        self.factor.eliminate(system, nodes, schur)?;
        let start = Instant::now();
        for (rhs, &node) in schur.rhs_mut().iter_mut().zip(nodes) {
            *rhs = system.rhs_at(node);
        }
        self.factor
            .columns
            .subtract_products(&self.border, schur.rhs_mut());
        self.factor.timings.schur += start.elapsed();
        Ok(())
    }

    fn commit(&mut self, system: &System, touched: &Touched) -> Result<(), Error> {
        self.factor.commit(system, touched)?;
        self.border
            .extend((0..touched.len()).filter_map(|event| touched.rhs(event)));
        Ok(())
    }

    /// The rows of later nodes are rotated into place, n² of them at most: much less than a new
    /// factor, and as accurate.
    fn release(&mut self, system: &System, node: usize) -> Result<(), Error> {
        self.factor.release(system, node)?.remove(&mut self.border);
        Ok(())
    }

    fn solve(
        &mut self,
        _system: &System,
        touched: &Touched,
        count: usize,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        self.factor.check_count(touched, count)?;
        let start = Instant::now();
        let committed = count.min(self.factor.len());
        let mut pending: Vec<[f64; 2]> = (0..count - committed)
            .filter_map(|event| touched.rhs(event))
            .map(|[g, e, _]| [g, e])
            .collect();
        touched.solve_transposed(&mut pending);
        let Solution { y1, y2 } = solution;
        for (y, rhs) in [(&mut *y1, 0), (&mut *y2, 1)] {
            y.clear();
            y.extend(self.border[..committed].iter().map(|values| values[rhs]));
            y.extend(pending.iter().map(|values| values[rhs]));
        }
        let terms: Vec<_> = touched.positions().iter().copied().zip(pending).collect();
        let Factor {
            panels, columns, ..
        } = &self.factor;
        parallel::inside(|| {
            columns.subtract(&terms, [&mut y1[..committed], &mut y2[..committed]]);
            panels.solve_transposed([&mut y1[..committed], &mut y2[..committed]]);
        });
        for value in y1 {
            *value = -*value;
        }
        self.factor.timings.solve += start.elapsed();
        Ok(())
    }

    fn bytes(&self, contact: usize, watched: usize) -> usize {
        Factor::<f64>::bytes(contact, watched)
            .saturating_add(contact.saturating_mul(size_of::<[f64; System::RHS]>()))
    }
}
