//! The contact, the solutions on it, and the watched nodes.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::equilibrium::{Equilibrium, Field};
use super::galerkin;
use super::local::{Local, Neighbourhood};
use crate::contact::ContactSequence;
use crate::krylov::{Directions, LinearSystem, NodeSet, Operator, SparseInverse, greatest};
use crate::updater::{Schur, Solution, SolveRequest};
use crate::{Boundary, Error, Problem, parallel};

/// Bounds of the residual of the rate, which is 1 in contact: below the first one rounding ends the
/// iteration, above the second one a horizon could not be trusted.
const RATE_TOLERANCE: [f64; 2] = [1e-11, 1e-5];
/// Residual of the row sums relative to the greatest one: what depends on them, the mean gap's rate, is
/// exact at the ends of windows anyway.
const SUMS_TOLERANCE: f64 = 1e-4;
/// Before there is an approach to compare with, this part of the mean gap takes its place.
const LEAST_LENGTH: f64 = 1e-6;

/// When iterations end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Criteria {
    /// Greatest residual of a gap in contact, relative to the approach.
    pub(super) tolerance: f64,
    pub(super) max_iterations: usize,
}

/// What depends on the problem and its contact, made at first use.
#[derive(Debug, Clone)]
pub(super) struct State {
    operator: Operator,
    inverse: SparseInverse,
    neighbourhood: Neighbourhood,
    /// The nodes that operator and inverse were last used for.
    set: NodeSet,
    now: Equilibrium,
    /// Where the last window began: its prefixes start from there.
    before: Option<Equilibrium>,
    /// `C_II⁻¹ s_I` for the row sums s of C, on the first so many nodes.
    sums: (usize, Field),
    watched: Vec<Local>,
    /// Their Schur complement.
    schur: Vec<f64>,
    /// Search directions of the last rate.
    directions: Directions,
}

impl State {
    pub(super) fn new(problem: &Problem) -> Self {
        let nodes = problem.grid().nodes();
        Self {
            operator: Operator::new(problem.convolution()),
            inverse: SparseInverse::new(problem.table()),
            neighbourhood: Neighbourhood::new(problem),
            set: NodeSet::new(nodes),
            now: Equilibrium::zero(nodes),
            before: None,
            sums: (0, Field::zero(nodes)),
            watched: Vec::new(),
            schur: Vec::new(),
            directions: Directions::default(),
        }
    }

    /// Begins with a contact and a solution on it, as a start.
    pub(super) fn take_over(
        &mut self,
        contact: &ContactSequence,
        approach: f64,
        solution: &Solution,
    ) {
        let values = [&solution.pressure, &solution.rate];
        let fields = values.map(|values| {
            let mut pressure = vec![0.0; self.now.load.pressure.len()];
            for (&node, value) in contact.order().iter().zip(values) {
                pressure[node] = *value;
            }
            Field {
                pressure,
                displacement: Vec::new(),
            }
        });
        let [load, rate] = fields;
        self.now = Equilibrium {
            count: contact.len(),
            approach,
            load,
            rate,
        };
    }

    /// Number of nodes in contact that there is a solution or a start for.
    pub(super) fn count(&self) -> usize {
        self.now.count
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        let before = self.before.as_ref().map_or(0, Equilibrium::bytes);
        let sums = self.sums.1.bytes();
        self.operator.bytes() + 2 * self.inverse.bytes() + self.now.bytes() + before + sums
    }

    /// Makes the set the first `count` nodes of a contact.
    fn choose(&mut self, contact: &ContactSequence, count: usize) {
        let mut is_in = vec![false; self.set.places().len()];
        for &node in &contact.order()[..count] {
            is_in[node] = true;
        }
        if self.set.assign(|node| is_in[node]) {
            self.inverse.update(&self.set);
        }
    }

    /// Computes displacements that are not known, of what was taken over.
    fn complete(&mut self) -> Result<(), Error> {
        for field in [&mut self.now.load, &mut self.now.rate] {
            if !field.is_known() {
                let displacement = self.operator.apply_field(&field.pressure)?;
                field.displacement = displacement.to_vec();
            }
        }
        Ok(())
    }

    pub(super) fn watch(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        self.choose(contact, contact.len());
        self.complete()?;
        let periodic = problem.boundary() == Boundary::Periodic;
        if !periodic {
            self.solve_row_sums(criteria, problem, contact)?;
        }
        schur.resize(nodes.len());
        for (sum, &node) in schur.row_sums_mut().iter_mut().zip(nodes) {
            let all = problem.row_sums()[node];
            *sum = if periodic {
                // All row sums are the same, so that y₂ explains them.
                all * (1.0 - self.now.rate.displacement[node])
            } else {
                all - self.sums.1.displacement[node]
            };
        }
        let mut locals: Vec<Local> = nodes
            .iter()
            .map(|&node| Local {
                node,
                ..Local::default()
            })
            .collect();
        let (neighbourhood, set) = (&self.neighbourhood, &self.set);
        parallel::for_each(&mut locals, |local| {
            *local = neighbourhood.solve(problem.table(), set, local.node);
        });
        galerkin::schur(problem, &locals, schur.as_mut_slice());
        self.schur.clear();
        self.schur.extend_from_slice(schur.as_mut_slice());
        self.watched = locals;
        Ok(())
    }

    /// The Schur complement of some watched nodes, and what pressure on them does to the others; `None` if
    /// one was not watched.
    fn factor_of(&self, joined: &[usize]) -> Option<(Cholesky<f64, nalgebra::Dyn>, Vec<&Local>)> {
        let size = self.watched.len();
        let place = |node: &usize| self.watched.iter().position(|local| local.node == *node);
        let places: Vec<usize> = joined.iter().map(place).collect::<Option<_>>()?;
        let matrix = DMatrix::from_fn(places.len(), places.len(), |i, j| {
            let (i, j) = (places[i].max(places[j]), places[i].min(places[j]));
            self.schur[i + size * j]
        });
        let locals = places.iter().map(|&place| &self.watched[place]);
        Some((matrix.cholesky()?, locals.collect()))
    }

    /// Adds to pressures what nodes that joined, with the right-hand sides `rhs` left for them, change.
    fn carry(&self, joined: &[usize], rhs: Vec<f64>, pressure: &mut [f64]) {
        let Some((factor, locals)) = self.factor_of(joined) else {
            return;
        };
        let solved = factor.solve(&DVector::from_vec(rhs));
        for (local, w) in locals.iter().zip(solved.iter()) {
            pressure[local.node] += w;
            for (&node, x) in local.contact.iter().zip(&local.weights) {
                pressure[node as usize] -= w * x;
            }
        }
    }

    /// Solves `C_II x = b` on the set from a start, with what is known of its displacements. The result's
    /// displacements are in double precision.
    fn settle(
        &mut self,
        (b, tolerance, max_iterations): (impl Fn(usize) -> f64, f64, usize),
        start: &[f64],
        base: &Field,
        directions: &mut Directions,
    ) -> Result<Field, Error> {
        let (mut x, mut residual) = (Vec::new(), Vec::new());
        self.set.gather(start, &mut x);
        let nodes = self.set.nodes().iter().map(|&node| node as usize);
        let b: Vec<f64> = nodes.clone().map(b).collect();
        if base.is_known() {
            // Single precision is enough for the difference.
            let values = nodes.clone().zip(&x);
            let change: Vec<f64> = values.map(|(node, x)| x - base.pressure[node]).collect();
            let image = self.operator.step(&self.set, &change)?;
            let terms = nodes.zip(&b);
            residual.extend(terms.map(|(node, b)| b - base.displacement[node] - image[node]));
        }
        let mut system = LinearSystem {
            operator: &mut self.operator,
            inverse: &mut self.inverse,
            contact: &self.set,
            tolerance,
            max_iterations,
        };
        if !base.is_known() {
            system.residual(&b, &x, &mut residual)?;
        }
        directions.project(&mut x, &mut residual);
        // The residual of a start is one of single precision: what counts is that fresh ones fall.
        let mut last = f64::INFINITY;
        let mut iterations = 0;
        loop {
            let outcome = system.solve_along(&b, &mut x, &mut residual, directions)?;
            if outcome.iterations == 0 {
                system.residual(&b, &x, &mut residual)?;
            }
            iterations += outcome.iterations;
            let worst = greatest(residual.len(), 0.0, |i| residual[i].abs());
            if worst <= tolerance {
                break;
            }
            if worst.is_nan() || worst > 0.5 * last || iterations >= max_iterations {
                return Err(Error::NoConvergence {
                    residual: worst,
                    tolerance,
                    iterations,
                });
            }
            last = worst;
        }
        let mut pressure = vec![0.0; start.len()];
        self.set.scatter(&x, &mut pressure);
        Ok(Field {
            pressure,
            displacement: self.operator.displacement().to_vec(),
        })
    }

    /// `C_II⁻¹ s_I` on the whole contact, unless it is known.
    fn solve_row_sums(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
    ) -> Result<(), Error> {
        let sums = problem.row_sums();
        let (count, base) = std::mem::take(&mut self.sums);
        if count == contact.len() && base.is_known() {
            self.sums = (count, base);
            return Ok(());
        }
        let mut start = base.pressure.clone();
        if base.is_known() {
            let joined = &contact.order()[count..];
            let left = joined
                .iter()
                .map(|&node| sums[node] - base.displacement[node]);
            self.carry(joined, left.collect(), &mut start);
        }
        let most = greatest(sums.len(), 0.0, |i| sums[i]);
        // What is explained already leaves less to be explained.
        let open = 1.0 - self.now.rate.displacement.iter().sum::<f64>() / sums.len() as f64;
        let tolerance = SUMS_TOLERANCE * most * open.clamp(1e-6, 1.0);
        let criteria = (|node: usize| sums[node], tolerance, criteria.max_iterations);
        let mut directions = self.directions.clone();
        let field = self.settle(criteria, &start, &base, &mut directions)?;
        self.sums = (contact.len(), field);
        Ok(())
    }

    pub(super) fn solve(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
        request: SolveRequest,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        let count = request.count;
        let whole = count == contact.len();
        let start = match &self.before {
            Some(before) if !whole && before.count <= count && count <= self.now.count => {
                before.clone()
            }
            _ if self.now.count <= count => self.now.clone(),
            _ => Equilibrium::zero(problem.grid().nodes()),
        };
        let solved = self.solve_from(criteria, problem, contact, request, &start)?;
        let places = contact.order()[..count].iter();
        let values = |field: &Field| places.clone().map(|&node| field.pressure[node]).collect();
        solution.pressure = values(&solved.load);
        solution.rate = values(&solved.rate);
        solution.displacement = [
            solved.load.displacement.clone(),
            solved.rate.displacement.clone(),
        ];
        if whole {
            if self.now.count < count && self.now.load.is_known() {
                self.before = Some(std::mem::take(&mut self.now));
            }
            self.now = solved;
        }
        Ok(())
    }

    /// Solves for rate and pressure, in this order: the directions of the one serve the other.
    fn solve_from(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
        request: SolveRequest,
        from: &Equilibrium,
    ) -> Result<Equilibrium, Error> {
        let SolveRequest {
            count,
            approach,
            span,
        } = request;
        self.choose(contact, count);
        let gap = problem.initial_gap();
        let overlap = |node: usize| approach - gap[node];
        let joined = contact.order()[..count]
            .get(from.count..)
            .unwrap_or_default();
        let base = from.load_at(approach);
        let length = greatest(count, LEAST_LENGTH * problem.mean_gap(), |k| {
            overlap(contact.order()[k]).abs()
        });
        let tolerance = criteria.tolerance * length;
        let mut directions = Directions::keeping();
        let mut rate = from.rate.clone();
        if span > 0.0 {
            let rate_tolerance = (tolerance / span).clamp(RATE_TOLERANCE[0], RATE_TOLERANCE[1]);
            let mut start = from.rate.pressure.clone();
            if from.rate.is_known() {
                let left = joined
                    .iter()
                    .map(|&node| 1.0 - from.rate.displacement[node]);
                self.carry(joined, left.collect(), &mut start);
            }
            let criteria = (|_| 1.0, rate_tolerance, criteria.max_iterations);
            rate = self.settle(criteria, &start, &from.rate, &mut directions)?;
            if count == contact.len() {
                self.directions = directions.clone();
            }
        }
        let mut start = base.pressure.clone();
        if base.is_known() {
            let left = joined
                .iter()
                .map(|&node| overlap(node) - base.displacement[node]);
            self.carry(joined, left.collect(), &mut start);
        }
        let criteria = (overlap, tolerance, criteria.max_iterations);
        let load = self.settle(criteria, &start, &base, &mut directions)?;
        Ok(Equilibrium {
            count,
            approach,
            load,
            rate,
        })
    }

    /// Goes back to the first nodes of the contact.
    pub(super) fn truncate(&mut self, left: &ContactSequence) {
        match self.before.take() {
            Some(before) if before.count == left.len() => {
                self.now = before;
                self.directions = Directions::default();
                if self.sums.0 > left.len() {
                    self.keep_sums(left);
                }
            }
            _ => self.keep(left),
        }
    }

    /// Keeps of all solutions, as starts, what belongs to nodes that are left in contact.
    pub(super) fn keep(&mut self, left: &ContactSequence) {
        self.before = None;
        self.directions = Directions::default();
        self.watched.clear();
        self.now.load.keep(left);
        self.now.rate.keep(left);
        self.now.count = left.len();
        self.keep_sums(left);
    }

    fn keep_sums(&mut self, left: &ContactSequence) {
        self.sums.0 = left.len();
        self.sums.1.keep(left);
    }
}
