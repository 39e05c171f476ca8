//! The solutions on the contact, and the watched nodes.

use std::mem;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::equilibrium::{Equilibrium, Field};
use super::galerkin;
use super::local::{self, Local, Neighbourhood};
use super::solver::{Equation, Solver};
use super::tolerances::{Criteria, Tolerances};
use crate::contact::ContactSequence;
use crate::krylov::{Directions, greatest};
use crate::updater::{Schur, Solution, SolveRequest};
use crate::{Boundary, Error, Problem, parallel};

/// Residual of the row sums relative to the greatest one: what depends on them, the mean gap's rate, is
/// exact at the ends of windows anyway.
const SUMS_TOLERANCE: f64 = 1e-4;
/// Windows after which the row sums are solved for; in between they follow the contact by local solutions.
const SUMS_WINDOWS: usize = 3;
/// At lower mean closing rates, close to full contact, always: differences of row sums are all that is left.
const SUMS_OPEN: f64 = 0.03;
/// Before there is an approach to compare with, this part of the mean gap takes its place.
const LEAST_LENGTH: f64 = 1e-6;

/// What depends on the problem and its contact, made at first use.
#[derive(Debug, Clone)]
pub(super) struct State {
    solver: Solver,
    neighbourhood: Neighbourhood,
    now: Equilibrium,
    /// Where the last window began: its prefixes start from there.
    before: Option<Equilibrium>,
    sums: RowSums,
    watched: Vec<Local>,
    /// Nodes in contact when they were watched.
    watched_at: usize,
    /// Their Schur complement.
    schur: Vec<f64>,
    /// Search directions of the last solution on the whole contact.
    directions: Directions,
}

/// `C_II⁻¹ s_I` for the row sums s of C.
#[derive(Debug, Clone)]
struct RowSums {
    /// On the first so many nodes.
    count: usize,
    field: Field,
    /// Windows since they were solved for.
    age: usize,
}

impl RowSums {
    /// Of which nothing but a start is known.
    fn start(count: usize, field: Field) -> Self {
        Self {
            count,
            field,
            age: SUMS_WINDOWS,
        }
    }
}

impl State {
    pub(super) fn new(problem: &Problem) -> Self {
        let nodes = problem.grid().nodes();
        Self {
            solver: Solver::new(problem),
            neighbourhood: Neighbourhood::new(problem),
            now: Equilibrium::zero(nodes),
            before: None,
            sums: RowSums::start(0, Field::zero(nodes)),
            watched: Vec::new(),
            watched_at: 0,
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
        let [load, rate] = [&solution.pressure, &solution.rate].map(|values| {
            let mut pressure = vec![0.0; self.now.load.pressure.len()];
            for (&node, value) in contact.order().iter().zip(values) {
                pressure[node] = *value;
            }
            Field::of(pressure)
        });
        self.now = Equilibrium {
            count: contact.len(),
            approach,
            span: 0.0,
            load,
            rate,
        };
        let nothing = Field::of(vec![0.0; self.now.rate.pressure.len()]);
        self.sums = RowSums::start(contact.len(), nothing);
    }

    /// Number of nodes in contact that there is a solution or a start for.
    pub(super) fn count(&self) -> usize {
        self.now.count
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        // What there is before the first window will be there twice.
        let before = self.before.as_ref().unwrap_or(&self.now).bytes();
        let sums = self.now.bytes() / 2;
        self.solver.bytes() + self.now.bytes() + before + sums
    }

    pub(super) fn watch(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        self.solver.choose(contact, contact.len());
        self.solver.complete(&mut self.now.load)?;
        self.solver.complete(&mut self.now.rate)?;
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
                all - self.sums.field.displacement[node]
            };
        }
        let of = |&node: &usize| Local {
            node,
            ..Local::default()
        };
        let mut locals: Vec<Local> = nodes.iter().map(of).collect();
        let (neighbourhood, set) = (&self.neighbourhood, self.solver.set());
        let products = locals.len() * local::PRODUCTS;
        parallel::for_each(products, &mut locals, |local| {
            *local = neighbourhood.solve(problem.table(), set, local.node);
        });
        galerkin::schur(problem, &locals, schur.as_mut_slice());
        self.schur.clear();
        self.schur.extend_from_slice(schur.as_mut_slice());
        self.watched = locals;
        self.watched_at = contact.len();
        schur.set_displacements(self.improved(problem));
        Ok(())
    }

    /// Displacements of the watched nodes with what the residuals of the solution say of them: pressures that
    /// took a residual r out of the contact would change that of node j by `x_jᵀ r`.
    fn improved(&self, problem: &Problem) -> Vec<[f64; 2]> {
        let of = |local: &Local| {
            let left = self.now.left_near(problem, local);
            let node = local.node;
            [
                self.now.load.displacement[node] + left[0],
                self.now.rate.displacement[node] + left[1],
            ]
        };
        self.watched.iter().map(of).collect()
    }

    /// Improves what a solution says of the watched nodes, of which some have joined since they were watched:
    /// the pressures of these, and the displacements of the others.
    fn improve(
        &self,
        problem: &Problem,
        contact: &ContactSequence,
        solved: &Equilibrium,
        solution: &mut Solution,
    ) {
        let from = self.watched_at;
        let Some(joined) = contact.order()[..solved.count].get(from..) else {
            return;
        };
        let Some((factor, places)) = self.factor_of(joined) else {
            return;
        };
        let near: Vec<[f64; 2]> = self
            .watched
            .iter()
            .map(|local| solved.left_near(problem, local))
            .collect();
        let [u, u_rate] = &mut solution.displacement;
        let of_load = (&mut solution.pressure, u);
        let of_rate = (&mut solution.rate, u_rate);
        let fields = if solved.rate.is_known() { 2 } else { 1 };
        let fields = [of_load, of_rate].into_iter().take(fields);
        for (k, (pressures, displacement)) in fields.enumerate() {
            let of_near: Vec<f64> = near.iter().map(|near| near[k]).collect();
            let left = places.iter().zip(joined);
            let left = left.map(|(&place, &node)| solved.left(problem, node)[k] - of_near[place]);
            let left = DVector::from_iterator(places.len(), left);
            let change = if places.is_empty() {
                left
            } else {
                factor.solve(&left)
            };
            for (pressure, change) in pressures[from..].iter_mut().zip(change.iter()) {
                *pressure += change;
            }
            for (i, (local, near)) in self.watched.iter().zip(&of_near).enumerate() {
                if !places.contains(&i) {
                    let of_joined = places.iter().zip(change.iter());
                    let of_joined =
                        of_joined.map(|(&place, change)| self.complement(i, place) * change);
                    displacement[local.node] += near + of_joined.sum::<f64>();
                }
            }
        }
    }

    /// An entry of the Schur complement.
    fn complement(&self, i: usize, j: usize) -> f64 {
        self.schur[i.max(j) + self.watched.len() * i.min(j)]
    }

    /// The factor of the Schur complement of some watched nodes, and their places; `None` if one was not
    /// watched.
    fn factor_of(&self, joined: &[usize]) -> Option<(Cholesky<f64, Dyn>, Vec<usize>)> {
        let place = |node: &usize| self.watched.iter().position(|local| local.node == *node);
        let places: Vec<usize> = joined.iter().map(place).collect::<Option<_>>()?;
        let size = places.len();
        let matrix = DMatrix::from_fn(size, size, |i, j| self.complement(places[i], places[j]));
        Some((matrix.cholesky()?, places))
    }

    /// The pressures of a field and what nodes that joined, with the right-hand sides `rhs`, add to them.
    fn carried(&self, field: &Field, joined: &[usize], rhs: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut pressure = field.pressure.clone();
        if joined.is_empty() || !field.is_known() {
            return pressure;
        }
        let Some((factor, places)) = self.factor_of(joined) else {
            return pressure;
        };
        let left = joined
            .iter()
            .map(|&node| rhs(node) - field.displacement[node]);
        let solved = factor.solve(&DVector::from_iterator(joined.len(), left));
        for (&place, w) in places.iter().zip(solved.iter()) {
            let local = &self.watched[place];
            pressure[local.node] += w;
            for (&node, x) in local.contact.iter().zip(&local.weights) {
                pressure[node as usize] -= w * x;
            }
        }
        pressure
    }

    /// `C_II⁻¹ s_I` on the whole contact, unless it is known.
    fn solve_row_sums(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
    ) -> Result<(), Error> {
        let RowSums { count, field, age } = &self.sums;
        if *count == contact.len() && field.is_known() {
            return Ok(());
        }
        let sums = problem.row_sums();
        let joined = contact.order().get(*count..).unwrap_or_default();
        let start = self.carried(field, joined, |node| sums[node]);
        let open = self.now.rate.open().clamp(1e-6, 1.0);
        let (age, tolerance) = if *age < SUMS_WINDOWS && open > SUMS_OPEN {
            (age + 1, f64::INFINITY)
        } else {
            let most = greatest(sums.len(), 0.0, |i| sums[i]);
            // What is explained already leaves less to be explained.
            (0, SUMS_TOLERANCE * most * open)
        };
        let equation = Equation {
            rhs: |node: usize| sums[node],
            tolerance,
            max_iterations: criteria.max_iterations,
        };
        let mut directions = mem::take(&mut self.directions);
        let field = self
            .solver
            .solve(&equation, start, field, &mut directions)?;
        self.sums = RowSums {
            count: contact.len(),
            field,
            age,
        };
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
        let is_solved = self.now.count == count && self.now.load.is_known();
        let is_here = self.now.approach == request.approach;
        // The path must not notice questions, which are all that may be asked of a contact that is solved, at
        // another approach or more exactly than the path needs.
        let is_question = is_solved && (!is_here || request.span == f64::INFINITY);
        let asked = if is_solved && is_here && request.span <= self.now.span {
            None
        } else if is_question {
            let now = mem::take(&mut self.now);
            let solved = self.solve_from(criteria, problem, contact, request, &now);
            self.now = now;
            Some(solved?.0)
        } else if count == contact.len() && self.now.count <= count {
            let now = mem::take(&mut self.now);
            match self.solve_from(criteria, problem, contact, request, &now) {
                Ok((solved, directions)) => {
                    if now.count < count && now.load.is_known() {
                        self.before = Some(now);
                    }
                    self.now = solved;
                    self.directions = directions;
                }
                Err(error) => {
                    self.now = now;
                    return Err(error);
                }
            }
            None
        } else {
            Some(self.solve_prefix(criteria, problem, contact, request)?)
        };
        let solved = asked.as_ref().unwrap_or(&self.now);
        let values = |field: &Field| {
            let nodes = contact.order()[..count].iter();
            nodes
                .map(|&node| field.pressure.get(node).copied().unwrap_or(0.0))
                .collect()
        };
        solution.pressure = values(&solved.load);
        solution.rate = values(&solved.rate);
        solution.displacement[0].clone_from(&solved.load.displacement);
        solution.displacement[1].clone_from(&solved.rate.displacement);
        if request.span < f64::INFINITY {
            self.improve(problem, contact, solved, solution);
            solved.scale(problem, contact, solution);
        }
        Ok(())
    }

    /// Solves on a part of the contact: inside the last window from its beginning, and otherwise from nothing
    /// and with nothing that the path uses.
    fn solve_prefix(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
        request: SolveRequest,
    ) -> Result<Equilibrium, Error> {
        let count = request.count;
        let before = self.before.take();
        let within = |from: &&Equilibrium| {
            request.span == 0.0 && from.count <= count && count <= self.now.count
        };
        let solved = match before.as_ref().filter(within) {
            Some(from) => {
                let solved = self.solve_from(criteria, problem, contact, request, from);
                solved.map(|(solved, _)| solved)
            }
            None => {
                let solved = Self::new(problem).solve_from(
                    criteria,
                    problem,
                    contact,
                    request,
                    &Equilibrium::zero(problem.grid().nodes()),
                );
                solved.map(|(solved, _)| solved)
            }
        };
        self.before = before;
        solved
    }

    /// Solves for rate and pressure, in this order: the directions of the one serve the other, and are
    /// returned. The rate stays empty if it is not asked for.
    fn solve_from(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
        request: SolveRequest,
        from: &Equilibrium,
    ) -> Result<(Equilibrium, Directions), Error> {
        let SolveRequest {
            count,
            approach,
            span,
            ..
        } = request;
        self.solver.choose(contact, count);
        let nodes = &contact.order()[..count];
        let joined = nodes.get(from.count..).unwrap_or_default();
        let gap = problem.initial_gap();
        let overlap = |node: usize| approach - gap[node];
        let least = LEAST_LENGTH * problem.mean_gap();
        let length = greatest(count, least, |k| overlap(nodes[k]).abs());
        let tolerances = Tolerances::of(criteria, request, length, from.rate.open());
        let max_iterations = criteria.max_iterations;
        let mut directions = if span > 0.0 {
            Directions::keeping()
        } else {
            Directions::default()
        };
        let mut rate = Field::default();
        if span > 0.0 {
            let equation = Equation {
                rhs: |_| 1.0,
                tolerance: tolerances.rate,
                max_iterations,
            };
            let start = self.carried(&from.rate, joined, equation.rhs);
            rate = self
                .solver
                .solve(&equation, start, &from.rate, &mut directions)?;
        }
        let equation = Equation {
            rhs: overlap,
            tolerance: tolerances.load,
            max_iterations,
        };
        let base = from.load_at(approach);
        let start = self.carried(&base, joined, overlap);
        let load = self
            .solver
            .solve(&equation, start, &base, &mut directions)?;
        let solved = Equilibrium {
            count,
            approach,
            span,
            load,
            rate,
        };
        Ok((solved, directions))
    }

    /// Goes back to the first nodes of the contact.
    pub(super) fn truncate(&mut self, left: &ContactSequence) {
        match self.before.take() {
            Some(before) if before.count == left.len() => {
                self.now = before;
                self.directions = Directions::default();
                if self.sums.count > left.len() {
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
        let mut field = mem::take(&mut self.sums.field);
        field.keep(left);
        self.sums = RowSums::start(left.len(), field);
    }
}
