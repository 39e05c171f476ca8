//! The loading path by the paper's rule, to be compared with the exact one.

use asperity::contact::{ContactSequence, ContactState};
use asperity::convolution::Convolution;
use asperity::loading::ContactEvent;
use asperity::updater::{LinearUpdater, RecursiveCholesky, Schur, Solution, WindowFactor};
use asperity::{Boundary, Error, InfluenceKernel, LoadingPath, LoadingState, Problem, Surface};
use nalgebra::DMatrix;

/// A loading path by either rule, and the fields of its present state.
pub trait EitherPath: Iterator<Item = Result<LoadingState, Error>> {
    /// The contact problem.
    fn problem(&self) -> &Problem;

    /// Node indices in contact in the order in which they touched.
    fn contact_order(&self) -> Vec<usize>;

    /// Which nodes are in contact.
    fn contact_map(&self) -> DMatrix<bool>;

    /// Pressure \[Pa\].
    fn pressure(&mut self) -> Result<DMatrix<f64>, Error>;

    /// Gap \[m\].
    fn gap(&mut self) -> Result<DMatrix<f64>, Error>;

    /// How far pressures and gaps fall below zero.
    fn extremes(&mut self) -> Result<Extremes, Error> {
        let (pressure, gap, contact) = (self.pressure()?, self.gap()?, self.contact_map());
        let mean = pressure.sum() / contact.iter().filter(|is_in| **is_in).count() as f64;
        let least = |values: &DMatrix<f64>, among: bool| {
            let nodes = values.iter().zip(&contact).filter(|(_, is_in)| **is_in == among);
            nodes.map(|(value, _)| *value).fold(f64::INFINITY, f64::min)
        };
        let pressure = least(&pressure, true);
        Ok(Extremes {
            // Nothing out of nothing is zero.
            pressure: if pressure == 0.0 { 0.0 } else { pressure / mean },
            gap: least(&gap, false) / self.problem().rms_height(),
        })
    }
}

/// Least values of a state.
#[derive(Debug, Clone, Copy)]
pub struct Extremes {
    /// Least pressure in contact over the mean there.
    pub pressure: f64,
    /// Least gap out of contact over Sq; infinite in full contact.
    pub gap: f64,
}

impl EitherPath for LoadingPath {
    fn problem(&self) -> &Problem {
        Self::problem(self)
    }

    fn contact_order(&self) -> Vec<usize> {
        Self::contact_order(self)
    }

    fn contact_map(&self) -> DMatrix<bool> {
        Self::contact_map(self)
    }

    fn pressure(&mut self) -> Result<DMatrix<f64>, Error> {
        Ok(self.fields()?.pressure)
    }

    fn gap(&mut self) -> Result<DMatrix<f64>, Error> {
        Ok(self.fields()?.gap)
    }
}

/// The loading path by the paper's procedure, on a free half-space: the node with the smallest gap at the present state
/// touches next (its step 4), at the approach at which that gap closes, even if this is smaller than the present one.
/// Each node costs a row of the factor, a solution and a convolution.
///
/// It is not exact: there are negative pressures, overlaps, and an approach that goes backwards. `docs/theory.md`,
/// section 3, says why.
pub struct SmallestGap<U = RecursiveCholesky> {
    problem: Problem,
    updater: U,
    convolution: Convolution,
    contact: ContactSequence,
    most_nodes: usize,
    has_failed: bool,
    approach: f64,
    solution: Solution,
    /// Pressure of all nodes, and pressure per unit of approach.
    pressure: [Vec<f64>; 2],
    /// Displacements under these.
    displacement: [Vec<f64>; 2],
}

impl SmallestGap {
    /// With a Cholesky factor, up to so many nodes in contact.
    ///
    /// # Errors
    ///
    /// Those of [`Problem::new`], and [`Error::OutOfRange`] for a periodic kernel.
    pub fn new(
        surface: &dyn Surface,
        kernel: &dyn InfluenceKernel,
        most_nodes: usize,
    ) -> Result<Self, Error> {
        Self::with_updater(surface, kernel, most_nodes, RecursiveCholesky::new())
    }
}

impl<U: LinearUpdater> SmallestGap<U> {
    /// The same with an updater that has no node in contact.
    ///
    /// # Errors
    ///
    /// As [`new`](SmallestGap::new).
    pub fn with_updater(
        surface: &dyn Surface,
        kernel: &dyn InfluenceKernel,
        most_nodes: usize,
        updater: U,
    ) -> Result<Self, Error> {
        let problem = Problem::new(surface, kernel)?;
        if problem.boundary() != Boundary::Free {
            return Err(Error::OutOfRange {
                quantity: "number of periodic directions",
                value: 2.0,
                expected: "0 for the rule of the smallest gap",
            });
        }
        let nodes = problem.grid().nodes();
        let field = || vec![0.0; nodes];
        Ok(Self {
            convolution: problem.convolution(),
            contact: ContactSequence::new(problem.grid()),
            problem,
            updater,
            most_nodes: most_nodes.min(nodes),
            has_failed: false,
            approach: 0.0,
            solution: Solution::default(),
            pressure: [field(), field()],
            displacement: [field(), field()],
        })
    }

    /// The gap of a node at the present approach.
    fn gap_of(&self, node: usize) -> f64 {
        self.problem.initial_gap()[node] + self.displacement[0][node] - self.approach
    }

    /// How fast it closes.
    fn closing_of(&self, node: usize) -> f64 {
        1.0 - self.displacement[1][node]
    }

    fn nodes_apart(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.problem.initial_gap().len()).filter(|&node| !self.contact.contains(node))
    }

    /// Adds the node with the smallest gap.
    fn advance(&mut self) -> Result<Option<LoadingState>, Error> {
        let step = self.contact.len() + 1;
        let next = self.nodes_apart().min_by(|&a, &b| self.gap_of(a).total_cmp(&self.gap_of(b)));
        let Some(node) = next.filter(|_| step <= self.most_nodes) else {
            return Ok(None);
        };
        let approach = self.approach + self.gap_of(node) / self.closing_of(node);
        if !approach.is_finite() {
            return Err(Error::NotFinite { step });
        }
        self.join(node)?;
        self.solve(approach)?;
        let contact = self.scalars();
        let node = self.problem.grid().coordinates(node);
        Ok(Some(LoadingState::new(step, ContactEvent::Touch, node, contact)))
    }

    /// Takes a node into contact and updater.
    fn join(&mut self, node: usize) -> Result<(), Error> {
        let mut schur = Schur::default();
        self.updater.watch(&self.problem, &self.contact, &[node], &mut schur)?;
        let factor = WindowFactor::of(schur, &[0])?;
        let order = self.contact.order().iter().copied().chain([node]);
        self.contact = ContactSequence::with_order(self.problem.grid(), order)?;
        self.updater.join(&self.problem, &self.contact, &factor)
    }

    /// Solves on the contact at an approach, and computes all displacements.
    fn solve(&mut self, approach: f64) -> Result<(), Error> {
        self.approach = approach;
        let (problem, contact) = (&self.problem, &self.contact);
        self.updater.solve(problem, contact, contact.len(), approach, &mut self.solution)?;
        let values = [&self.solution.pressure, &self.solution.rate];
        for (field, values) in self.pressure.iter_mut().zip(values) {
            for (&node, &value) in contact.order().iter().zip(values) {
                field[node] = value;
            }
        }
        let ([pressure, rate], [u, u_rate]) = (&self.pressure, &mut self.displacement);
        self.convolution.apply_two([pressure, rate], [u, u_rate])
    }

    /// The scalars of the present state.
    fn scalars(&self) -> ContactState {
        let grid = self.problem.grid();
        let nodes = grid.nodes() as f64;
        let sum = |values: &[f64]| values.iter().sum::<f64>();
        let load = grid.cell_area() * sum(&self.solution.pressure);
        let stiffness = grid.cell_area() * sum(&self.solution.rate);
        let mean_gap = self.nodes_apart().map(|node| self.gap_of(node)).sum::<f64>() / nodes;
        let closing = self.nodes_apart().map(|node| self.closing_of(node)).sum::<f64>() / nodes;
        let work = self.pressure[0].iter().zip(&self.displacement[0]).map(|(p, u)| p * u);
        let mut state = ContactState::new(&grid, self.contact.len(), self.approach, load, mean_gap);
        state.contact_stiffness = Some(stiffness);
        state.interfacial_stiffness = Some(stiffness / closing);
        state.energy = 0.5 * grid.cell_area() * work.sum::<f64>();
        state
    }
}

impl<U: LinearUpdater> Iterator for SmallestGap<U> {
    type Item = Result<LoadingState, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.has_failed {
            return None;
        }
        let item = self.advance();
        self.has_failed = item.is_err();
        item.transpose()
    }
}

impl<U: LinearUpdater> EitherPath for SmallestGap<U> {
    fn problem(&self) -> &Problem {
        &self.problem
    }

    fn contact_order(&self) -> Vec<usize> {
        self.contact.order().to_vec()
    }

    fn contact_map(&self) -> DMatrix<bool> {
        self.contact.map_at(self.contact.len())
    }

    fn pressure(&mut self) -> Result<DMatrix<f64>, Error> {
        let (nx, ny) = self.problem.grid().shape();
        Ok(DMatrix::from_column_slice(nx, ny, &self.pressure[0]))
    }

    fn gap(&mut self) -> Result<DMatrix<f64>, Error> {
        let (nx, ny) = self.problem.grid().shape();
        let gaps = (0..nx * ny).map(|node| self.gap_of(node));
        Ok(DMatrix::from_iterator(nx, ny, gaps))
    }
}
