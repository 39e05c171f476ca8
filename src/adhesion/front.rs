//! Where a path is: nodes on their law at an approach, and what solves there.

use std::sync::Arc;

use faer::prelude::Solve;
use faer::{Mat, Side};

use super::law::CohesiveLaw;
use super::state::NodeState;
use crate::contact::ContactSequence;
use crate::convolution::Convolution;
use crate::updater::{Left, LinearUpdater, RecursiveCholesky, Schur, WindowFactor, join_all};
use crate::{Error, Problem};

/// The nodes on their law.
#[derive(Debug, Clone)]
pub(super) struct Front {
    /// By node index.
    pub(super) nodes: Vec<NodeState>,
    /// Approach \[m\], in the gauge of the kernel.
    pub(super) approach: f64,
    /// Within a jump the nodes whose traction is held, and their pull \[Pa\], those first that are carried first.
    pub(super) held: Vec<(usize, f64)>,
}

impl Front {
    /// What the path goes along: the approach, or within a jump the pull of a node.
    pub(super) fn parameter(&self) -> Parameter {
        self.held.first().map_or(Parameter::Approach, |&(node, _)| Parameter::Pull(node))
    }

    /// How many nodes are in a state.
    pub(super) fn count(&self, state: NodeState) -> usize {
        self.nodes.iter().filter(|&&other| other == state).count()
    }
}

/// What grows or falls between two events.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Parameter {
    Approach,
    /// The pull of the node whose traction is held, at a fixed approach.
    Pull(usize),
}

/// Pressures and gaps of all nodes, and their rates along the parameter of a path, in its direction.
#[derive(Debug, Clone, Default)]
pub(super) struct Field {
    pub(super) pressure: [Vec<f64>; 2],
    pub(super) gap: [Vec<f64>; 2],
}

impl Field {
    /// Sums of all pressures and of all gaps, with their rates.
    pub(super) fn sums(&self) -> [[f64; 2]; 2] {
        [&self.pressure, &self.gap].map(|pair| [0, 1].map(|k| pair[k].iter().sum()))
    }
}

/// The contact with its factor, and the nodes on the slope of their law.
///
/// With the contact I and the soft nodes S, whose pressures p and gaps obey gap = h₂ + p/k,
///
/// ```text
/// C_II p_I + C_IS p_S         = δ − g_I − u_I
/// C_SI p_I + (C_SS − 1/k) p_S = δ − g_S − u_S + h₂
/// ```
///
/// where u displaces what is pulled with a fixed traction. The Schur complement of the second row, S_SS − 1/k = −M, is
/// negative definite in every stable state.
#[derive(Debug)]
pub(super) struct Body {
    pub(super) problem: Arc<Problem>,
    pub(super) law: CohesiveLaw,
    pub(super) budget: usize,
    updater: RecursiveCholesky,
    contact: ContactSequence,
    /// The soft nodes, those that have been so longest first: the factor knows their columns again.
    soft: Vec<usize>,
    /// Nodes out of contact whose columns the factor has, in its order.
    known: Vec<usize>,
    /// Of the window that has been played last, until nodes have left the contact.
    window: Option<Window>,
    /// The matrix S_SS of the soft nodes, if it is known.
    soft_matrix: Option<Mat<f64>>,
    /// The least pivot of M over 1/k: gaps of soft nodes are known so many times less exactly than others.
    least_pivot: f64,
    convolution: Convolution,
}

/// What a window has watched, and the matrix of that.
#[derive(Debug)]
struct Window {
    /// Out of contact, in the order of its rows.
    nodes: Vec<usize>,
    schur: Schur,
}

/// What a solution leaves in gaps that are known, relative to the range and the greatest length.
const RESIDUAL: f64 = 1e-8;

impl Body {
    pub(super) fn new(problem: Arc<Problem>, law: CohesiveLaw, budget: usize) -> Self {
        Self {
            contact: ContactSequence::new(problem.grid()),
            convolution: problem.convolution(),
            updater: RecursiveCholesky::new(),
            soft: Vec::new(),
            known: Vec::new(),
            window: None,
            soft_matrix: None,
            least_pivot: 1.0,
            problem,
            law,
            budget,
        }
    }

    /// The contact that the factor holds, in its order.
    pub(super) fn contact(&self) -> &ContactSequence {
        &self.contact
    }

    /// The soft nodes.
    pub(super) fn soft(&self) -> &[usize] {
        &self.soft
    }

    /// The least pivot of M over 1/k, 1 at most: rounding of gaps is greater by its inverse.
    pub(super) fn least_pivot(&self) -> f64 {
        self.least_pivot
    }

    /// Nodes out of contact whose columns the factor has: those that are watched first, in this order, cost no
    /// substitution.
    pub(super) fn known(&self) -> &[usize] {
        &self.known
    }

    /// Keeps the matrix of what a window watches, from which that of the next one follows.
    pub(super) fn keep(&mut self, nodes: Vec<usize>, schur: Schur) {
        self.window = Some(Window { nodes, schur });
    }

    /// Lets factor and soft nodes follow: nodes that left the contact leave the factor, others join it.
    pub(super) fn follow(&mut self, front: &Front) -> Result<(), Error> {
        let is = |node: usize, state| front.nodes[node] == state;
        let places = self.contact.order().iter().copied().enumerate();
        let left = places.filter(|&(_, node)| !is(node, NodeState::Contact));
        let left: Vec<Left> = left.map(|(position, node)| Left { node, position }).collect();
        if !left.is_empty() {
            for left in &left {
                self.contact.remove(left.node)?;
            }
            self.updater.release(&self.problem, &self.contact, &left)?;
            // It forgets all columns.
            self.known.clear();
        }
        self.soft_matrix = None;
        let window = self.window.take().filter(|_| left.is_empty());
        let nodes = 0..front.nodes.len();
        let joined: Vec<usize> = nodes
            .clone()
            .filter(|&node| is(node, NodeState::Contact) && !self.contact.contains(node))
            .collect();
        let window = match window {
            Some(mut window) if joined.iter().all(|node| window.nodes.contains(node)) => {
                self.join(&mut window, &joined)?;
                Some(window)
            }
            _ if joined.is_empty() => None,
            _ => {
                let contact = &mut self.contact;
                join_all(&mut self.updater, &self.problem, contact, &joined, self.budget)?;
                self.known.clear();
                None
            }
        };
        self.soft.retain(|&node| is(node, NodeState::Soft));
        let mut is_there = vec![false; front.nodes.len()];
        self.soft.iter().for_each(|&node| is_there[node] = true);
        // Those whose columns are known first, in their order.
        for node in self.known.iter().copied().chain(nodes) {
            if is(node, NodeState::Soft) && !is_there[node] {
                is_there[node] = true;
                self.soft.push(node);
            }
        }
        self.soft_matrix = window.and_then(|window| window.matrix_of(&self.soft));
        Ok(())
    }

    /// Lets watched nodes join, with the columns that the factor has of them, and reduces the matrix of the others.
    fn join(&mut self, window: &mut Window, joined: &[usize]) -> Result<(), Error> {
        if joined.is_empty() {
            return Ok(());
        }
        let watched = window.schur.size();
        let needed = self.updater.bytes(self.contact.len() + joined.len(), watched);
        let needed = needed.saturating_add(WindowFactor::bytes(watched));
        if needed > self.budget {
            let (budget, nodes_that_fit) = (self.budget, self.contact.len());
            return Err(Error::MemoryBudget { needed, budget, nodes_that_fit });
        }
        let mut touched = WindowFactor::default();
        touched.reset(watched, joined.len());
        for node in joined {
            let place = window.nodes.iter().position(|other| other == node);
            let place = place.ok_or(Error::FactorizationFailed { nodes: watched })?;
            let pushed = touched.push(&mut window.schur, place, 1.0);
            pushed.map_err(|_| Error::FactorizationFailed { nodes: joined.len() })?;
        }
        touched.finish(&mut window.schur);
        joined.iter().try_for_each(|&node| self.contact.push(node))?;
        self.updater.join(&self.problem, &self.contact, &touched)?;
        self.known.retain(|node| !joined.contains(node));
        Ok(())
    }

    /// Solves on the contact for two right-hand sides over the grid, of which only the values there count: what is left
    /// in the contact of `C_II x = −b`.
    fn solve(&mut self, right: [&[f64]; 2]) -> Result<[Vec<f64>; 2], Error> {
        let order = self.contact.order();
        let mut solved: Vec<[f64; 2]> =
            order.iter().map(|&node| right.map(|values| -values[node])).collect();
        if !solved.is_empty() {
            self.updater.solve_for(&self.problem, &self.contact, &mut solved)?;
        }
        let mut fields = [0, 1].map(|_| vec![0.0; self.problem.initial_gap().len()]);
        for (&node, values) in self.contact.order().iter().zip(solved) {
            (fields[0][node], fields[1][node]) = values.into();
        }
        Ok(fields)
    }

    fn displace(&mut self, pressure: [&[f64]; 2]) -> Result<[Vec<f64>; 2], Error> {
        let mut fields = [0, 1].map(|_| vec![0.0; self.problem.initial_gap().len()]);
        let [first, second] = &mut fields;
        self.convolution.apply_two(pressure, [first, second])?;
        Ok(fields)
    }

    /// Adds what some pressures displace.
    fn add_displacement(
        &mut self,
        to: &mut [Vec<f64>; 2],
        pressure: [&[f64]; 2],
    ) -> Result<(), Error> {
        let displacement = self.displace(pressure)?;
        for (to, more) in to.iter_mut().zip(displacement) {
            to.iter_mut().zip(more).for_each(|(to, more)| *to += more);
        }
        Ok(())
    }

    /// The state of a front that the factor has followed to, with rates along its parameter in a direction, 1 or −1.
    ///
    /// # Errors
    ///
    /// [`Error::FactorizationFailed`] if the state is not stable or its gaps are not what they should be.
    pub(super) fn survey(&mut self, front: &Front, sign: f64) -> Result<Field, Error> {
        let nodes = front.nodes.len();
        let mut pressure = [0, 1].map(|_| vec![0.0; nodes]);
        for (p, state) in pressure[0].iter_mut().zip(&front.nodes) {
            if *state == NodeState::Cohesive {
                *p = -self.law.stress();
            }
        }
        for &(node, pull) in &front.held {
            pressure[0][node] = -pull;
        }
        let along = match front.parameter() {
            Parameter::Approach => sign,
            Parameter::Pull(node) => {
                pressure[1][node] = -sign;
                0.0
            }
        };
        // Gaps of a surface that nothing else presses or pulls.
        let gap = self.problem.initial_gap().iter().map(|gap| gap - front.approach);
        let bare = [gap.collect(), vec![-along; nodes]];
        let mut base = bare.clone();
        if pressure.iter().flatten().any(|p| *p != 0.0) {
            self.add_displacement(&mut base, [&pressure[0], &pressure[1]])?;
        }
        self.least_pivot = 1.0;
        if !self.soft.is_empty() {
            let [value, rate] = self.soft_pressures(&base)?;
            for (&node, (value, rate)) in self.soft.iter().zip(value.into_iter().zip(rate)) {
                (pressure[0][node], pressure[1][node]) = (value, rate);
            }
            base.clone_from(&bare);
            self.add_displacement(&mut base, [&pressure[0], &pressure[1]])?;
        }
        if !self.contact.is_empty() {
            let solved = self.solve([&base[0], &base[1]])?;
            for (pressure, solved) in pressure.iter_mut().zip(&solved) {
                for &node in self.contact.order() {
                    pressure[node] = solved[node];
                }
            }
            base = bare;
            self.add_displacement(&mut base, [&pressure[0], &pressure[1]])?;
        }
        let mut field = Field { pressure, gap: base };
        self.settle(front, &mut field)?;
        Ok(field)
    }

    /// Gives gaps that are known by their state the values that they have, after a check.
    fn settle(&self, front: &Front, field: &mut Field) -> Result<(), Error> {
        let slope = self.law.slope();
        let length = self.law.range() + self.problem.greatest_gap() + front.approach.abs();
        for (node, state) in front.nodes.iter().enumerate() {
            let [p, rate] = [0, 1].map(|k| field.pressure[k][node]);
            let known = match state {
                NodeState::Contact => [0.0, 0.0],
                NodeState::Soft => [self.law.range() + p / slope, rate / slope],
                _ => continue,
            };
            let left = (field.gap[0][node] - known[0]).abs();
            if left.is_nan() || left > RESIDUAL * length {
                return Err(Error::FactorizationFailed {
                    nodes: self.contact.len() + self.soft.len(),
                });
            }
            [field.gap[0][node], field.gap[1][node]] = known;
        }
        Ok(())
    }

    /// Pressures of the soft nodes where these are all gaps without them and without those of the contact.
    fn soft_pressures(&mut self, base: &[Vec<f64>; 2]) -> Result<[Vec<f64>; 2], Error> {
        let mut gaps =
            [0, 1].map(|k| self.soft.iter().map(|&node| base[k][node]).collect::<Vec<_>>());
        if !self.contact.is_empty() {
            let solved = self.solve([&base[0], &base[1]])?;
            let displacement = self.displace([&solved[0], &solved[1]])?;
            for (gaps, displacement) in gaps.iter_mut().zip(&displacement) {
                for (gap, &node) in gaps.iter_mut().zip(&self.soft) {
                    *gap += displacement[node];
                }
            }
        }
        let matrix = match self.soft_matrix.take() {
            Some(matrix) => matrix,
            None => {
                let mut schur = Schur::default();
                self.updater.watch(&self.problem, &self.contact, &self.soft, &mut schur)?;
                self.known.clone_from(&self.soft);
                Mat::from_fn(schur.size(), schur.size(), |i, j| schur.entry(i, j))
            }
        };
        // M, of which the factor takes the lower triangle.
        let compliance = self.law.slope().recip();
        let size = matrix.nrows();
        let minus = Mat::from_fn(size, size, |i, j| {
            if i == j { compliance - matrix[(i, j)] } else { -matrix[(i, j)] }
        });
        self.soft_matrix = Some(matrix);
        let nodes = self.contact.len() + self.soft.len();
        let factor = minus.llt(Side::Lower);
        let factor = factor.map_err(|_| Error::FactorizationFailed { nodes })?;
        let pivots = (0..size).map(|i| factor.L()[(i, i)].powi(2) / compliance);
        self.least_pivot = pivots.fold(1.0, f64::min);
        let range = self.law.range();
        let mut right = Mat::from_fn(size, 2, |i, k| gaps[k][i] - if k == 0 { range } else { 0.0 });
        factor.solve_in_place(&mut right);
        Ok([0, 1].map(|k| right.col(k).iter().copied().collect()))
    }

    /// What a unit of pressure at each node out of contact, or of gap at each in contact, makes of the sums of
    /// pressures and of gaps, the others in contact answering and no node soft.
    pub(super) fn sums_by_node(&mut self) -> Result<[Vec<f64>; 2], Error> {
        let nodes = self.problem.initial_gap().len();
        let minus = [vec![-1.0; nodes], self.problem.row_sums().iter().map(|s| -s).collect()];
        let mut solved = self.solve([&minus[0], &minus[1]])?;
        let displaced = self.displace([&solved[0], &solved[1]])?;
        for ((solved, displaced), minus) in solved.iter_mut().zip(&displaced).zip(&minus) {
            for node in (0..nodes).filter(|&node| !self.contact.contains(node)) {
                solved[node] = -minus[node] - displaced[node];
            }
        }
        Ok(solved)
    }

    /// The matrix of some nodes out of contact, of which the soft ones come first, and of nodes at some positions of
    /// the contact.
    pub(super) fn watch(
        &mut self,
        nodes: &[usize],
        positions: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        let watched = nodes.len() + positions.len();
        let needed = self.updater.bytes(self.contact.len(), watched);
        let needed = needed.saturating_add(WindowFactor::bytes(watched));
        if needed > self.budget {
            let budget = self.budget;
            return Err(Error::MemoryBudget { needed, budget, nodes_that_fit: self.contact.len() });
        }
        self.updater.watch_both(&self.problem, &self.contact, nodes, positions, schur)?;
        self.known.clear();
        self.known.extend_from_slice(nodes);
        Ok(())
    }
}

impl Window {
    /// The part of the matrix that is of some nodes, if all of them were watched.
    fn matrix_of(&self, nodes: &[usize]) -> Option<Mat<f64>> {
        let place = |node: &usize| self.nodes.iter().position(|other| other == node);
        let places: Vec<usize> = nodes.iter().map(place).collect::<Option<_>>()?;
        let size = places.len();
        Some(Mat::from_fn(size, size, |i, j| self.schur.entry(places[i], places[j])))
    }
}
