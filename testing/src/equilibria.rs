//! All equilibria of a few nodes that stick, found by trying every state of every node.

use asperity::Problem;
use asperity::adhesion::{AdhesiveFields, CohesiveLaw, NodeState};
use nalgebra::{DMatrix, DVector};

/// A surface of a few nodes that sticks: influence, initial gaps and law.
#[derive(Debug)]
pub struct Equilibria {
    matrix: DMatrix<f64>,
    gap: DVector<f64>,
    law: CohesiveLaw,
}

const OPEN: usize = 0;
const SOFT: usize = 1;
const CONTACT: usize = 2;
const COHESIVE: usize = 3;

impl Equilibria {
    /// Of a problem with a law.
    #[must_use]
    pub fn of(problem: &Problem, law: CohesiveLaw) -> Self {
        let nodes = problem.initial_gap().len();
        Self {
            matrix: DMatrix::from_fn(nodes, nodes, |i, j| problem.coefficient(i, j).unwrap()),
            gap: DVector::from_column_slice(problem.initial_gap()),
            law,
        }
    }

    /// Whether nodes only help each other to close: the inverse of the matrix has no positive element off its diagonal,
    /// and no negative sum of a row. Then one equilibrium at an approach has the greatest gaps, and one the least.
    #[must_use]
    pub fn is_cooperative(&self) -> bool {
        let size = self.gap.len();
        let inverse = self.matrix.clone().try_inverse();
        inverse.is_some_and(|inverse| {
            let helps = |i: usize, j: usize| i == j || inverse[(i, j)] <= 0.0;
            (0..size).all(|i| inverse.row(i).sum() >= 0.0 && (0..size).all(|j| helps(i, j)))
        })
    }

    /// The approach of a state in the gauge of the kernel.
    #[must_use]
    pub fn approach(&self, fields: &AdhesiveFields) -> f64 {
        let pressure = DVector::from_column_slice(fields.pressure.as_slice());
        (&self.gap + &self.matrix * pressure)[0] - fields.gap[0]
    }

    /// Influence between nodes that answer; soft ones give way along the slope of the law as well. Rows and columns are
    /// divided by the roots of what each node gives way by, which are returned: with weak laws soft ones give way far
    /// more.
    fn reduced(
        &self,
        free: &[usize],
        is_soft: impl Fn(usize) -> bool,
    ) -> (DMatrix<f64>, DVector<f64>) {
        let size = free.len();
        let gives_way = |i: usize| match is_soft(free[i]) {
            true => 1.0 / self.law.slope(),
            false => self.matrix[(free[i], free[i])],
        };
        let roots = DVector::from_fn(size, |i, _| gives_way(i).sqrt());
        let reduced = DMatrix::from_fn(size, size, |i, j| {
            let along_slope = if i == j && is_soft(free[i]) { 1.0 } else { 0.0 };
            self.matrix[(free[i], free[j])] / (roots[i] * roots[j]) - along_slope
        });
        (reduced, roots)
    }

    /// How the sums of all pressures and of all gaps change with the approach in the gauge of the kernel, while nodes
    /// stay what they are; each with what it is off by for every unit of relative error of the equations. `None` if
    /// these have no solution.
    #[must_use]
    pub fn rates(&self, nodes: &DMatrix<NodeState>) -> Option<[(f64, f64); 2]> {
        let answers = |i: &usize| matches!(nodes[*i], NodeState::Soft | NodeState::Contact);
        let free: Vec<usize> = (0..nodes.len()).filter(answers).collect();
        let (count, greatest) = (nodes.len() as f64, self.matrix.amax());
        // Of nodes that do not know of each other.
        let alone = count / greatest;
        if free.is_empty() {
            return Some([(0.0, alone), (-count, count)]);
        }
        let (reduced, roots) = self.reduced(&free, |i| nodes[i] == NodeState::Soft);
        let inverse = reduced.clone().try_inverse()?;
        let scale = roots.map(f64::recip);
        let rates = (&inverse * &scale).component_mul(&scale);
        let gaps = self.matrix.select_columns(&free) * &rates;
        let condition = reduced.norm() * inverse.norm();
        let off = condition * (inverse.norm() * scale.norm_squared() + alone);
        Some([(rates.sum(), off), (gaps.sum() - count, count * (1.0 + greatest * off))])
    }

    /// Gaps of the state with nodes so, if that is a strict minimum of the energy.
    fn equilibrium(&self, nodes: &[usize], approach: f64) -> Option<DVector<f64>> {
        let law = &self.law;
        let size = nodes.len();
        let free: Vec<usize> = (0..size).filter(|&i| matches!(nodes[i], SOFT | CONTACT)).collect();
        let mut pressure =
            DVector::from_fn(size, |i, _| if nodes[i] == COHESIVE { -law.stress() } else { 0.0 });
        let base = &self.gap + &self.matrix * &pressure;
        let (reduced, roots) = self.reduced(&free, |i| nodes[i] == SOFT);
        let right = DVector::from_fn(free.len(), |i, _| {
            let range = if nodes[free[i]] == SOFT { law.range() } else { 0.0 };
            (range + approach - base[free[i]]) / roots[i]
        });
        let solved =
            if free.is_empty() { right.clone() } else { reduced.clone().lu().solve(&right)? };
        let solved = solved.component_div(&roots);
        free.iter().zip(solved.iter()).for_each(|(&i, &p)| pressure[i] = p);
        let gap = &self.gap + &self.matrix * &pressure - DVector::from_element(size, approach);
        let is_on_law = (0..size).all(|i| match nodes[i] {
            OPEN => gap[i] > law.range(),
            SOFT => gap[i] < law.range() && gap[i] > law.flat_range(),
            COHESIVE => gap[i] < law.flat_range() && gap[i] > 0.0,
            _ => pressure[i] > -law.stress(),
        });
        let soft = nodes.iter().filter(|&&node| node == SOFT).count();
        let is_stable = || {
            let values = match free.len() {
                0 => Vec::new(),
                1 => vec![reduced[(0, 0)]],
                _ => reduced.clone().symmetric_eigenvalues().as_slice().to_vec(),
            };
            values.iter().filter(|&&value| value < 0.0).count() == soft
        };
        (is_on_law && is_stable()).then_some(gap)
    }

    /// Gaps of all strict minima of the energy at an approach in the gauge of the kernel, of 3 kinds of nodes, or 4 where
    /// the law has a flat part.
    #[must_use]
    pub fn all(&self, kinds: usize, approach: f64) -> Vec<DVector<f64>> {
        let size = self.gap.len() as u32;
        let states = (0..kinds.pow(size))
            .map(|code| (0..size).map(|i| code / kinds.pow(i) % kinds).collect::<Vec<usize>>());
        states.filter_map(|nodes| self.equilibrium(&nodes, approach)).collect()
    }
}
