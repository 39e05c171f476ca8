//! Where a path is: nodes on their law at an approach, and what solves there.

use std::sync::Arc;

use super::answers::Answers;
use super::board::Hold;
use super::law::CohesiveLaw;
use super::rows::{Rows, Sources};
use super::soft::Soft;
use super::state::NodeState;
use crate::contact::{ContactSequence, ContactState};
use crate::convolution::Convolution;
use crate::memory::Memory;
use crate::updater::{Left, LinearUpdater, RecursiveCholesky, Schur, WindowFactor, join_all};
use crate::{Error, Problem};

/// The nodes on their law.
#[derive(Debug, Clone)]
pub(super) struct Front {
    /// By node index.
    pub(super) nodes: Vec<NodeState>,
    /// Approach \[m\], in the gauge of the kernel.
    pub(super) approach: f64,
    /// Within a jump the nodes whose traction is held, those first that are carried first. The path goes along the pull
    /// of the first one at a fixed approach, and along the approach where there is none.
    pub(super) held: Vec<Hold>,
}

impl Front {
    /// How many nodes are in a state.
    pub(super) fn count(&self, state: NodeState) -> usize {
        self.nodes.iter().filter(|&&other| other == state).count()
    }
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
    memory: Memory,
    updater: RecursiveCholesky,
    contact: ContactSequence,
    /// The soft nodes, in the order in which they are watched.
    soft: Vec<usize>,
    /// The factor of their matrix, if it is known.
    soft_factor: Option<Soft>,
    watched: Watched,
    /// What has joined last, until something else happens.
    joined: Option<Joined>,
    /// How the sums of pressures and of gaps change with each node on this contact, if it is known: see
    /// [`sums_by_node`](Self::sums_by_node).
    sums: Option<[Vec<f64>; 2]>,
    /// The least pivot of M over 1/k: gaps of soft nodes are known so many times less exactly than others.
    least_pivot: f64,
    convolution: Convolution,
}

/// The nodes whose columns the updater has, in its order, and the matrix of these.
#[derive(Debug, Default)]
struct Watched {
    nodes: Vec<usize>,
    schur: Schur,
}

/// What it takes to let nodes leave again that have joined last.
#[derive(Debug)]
struct Joined {
    nodes: usize,
    /// R, a column for each node that joined and a row for each watched node that did not: the matrix of these lost
    /// R Rᵀ.
    columns: Vec<f64>,
}

/// Nodes that are needed no more stay watched as long as there is at most one of them for so many that are needed: to
/// leave any out, all columns are moved.
const NEEDED_FOR_ONE: usize = 4;
/// How far a solution may be from gaps that are known, relative to the sum of range, greatest initial gap and approach.
const RESIDUAL: f64 = 1e-8;

impl Body {
    pub(super) fn new(problem: Arc<Problem>, law: CohesiveLaw, memory: Memory) -> Self {
        Self {
            contact: ContactSequence::new(problem.grid()),
            convolution: problem.convolution(),
            updater: RecursiveCholesky::new(),
            soft: Vec::new(),
            soft_factor: None,
            watched: Watched::default(),
            joined: None,
            sums: None,
            least_pivot: 1.0,
            problem,
            law,
            memory,
        }
    }

    /// The soft nodes.
    pub(super) fn soft(&self) -> &[usize] {
        &self.soft
    }

    /// The least pivot of M over 1/k, 1 at most: rounding of gaps is greater by its inverse.
    pub(super) fn least_pivot(&self) -> f64 {
        self.least_pivot
    }

    /// Lets factor and soft nodes follow: nodes that left the contact leave the factor, others join it.
    pub(super) fn follow(&mut self, front: &Front) -> Result<(), Error> {
        let is = |node: usize, state| front.nodes[node] == state;
        let places = self.contact.order().iter().copied().enumerate();
        let left = places.filter(|&(_, node)| !is(node, NodeState::Contact));
        let left: Vec<Left> = left.map(|(position, node)| Left { node, position }).collect();
        self.joined = None;
        if !left.is_empty() {
            self.sums = None;
            self.leave(&left)?;
        }
        let nodes = 0..front.nodes.len();
        let joined: Vec<usize> = nodes
            .filter(|&node| is(node, NodeState::Contact) && !self.contact.contains(node))
            .collect();
        if !joined.is_empty() {
            self.sums = None;
            let places = self.watched.places(front.nodes.len());
            let places: Option<Vec<usize>> = joined.iter().map(|&node| places[node]).collect();
            if let Some(places) = places {
                self.join(&joined, &places)?;
            } else {
                self.watched = Watched::default();
                let contact = &mut self.contact;
                join_all(&mut self.updater, &self.problem, contact, &joined, self.memory.left())
                    .map_err(|error| self.memory.in_all(error))?;
            }
        }
        self.list_soft(front);
        Ok(())
    }

    /// Goes back to a front from the one that has been followed to last.
    pub(super) fn go_back(&mut self, front: &Front) -> Result<(), Error> {
        if let Some(joined) = self.joined.take() {
            self.sums = None;
            self.contact.truncate(self.contact.len() - joined.nodes);
            self.updater.truncate(&self.problem, &self.contact)?;
            self.watched.schur.add_gram(1.0, &joined.columns);
        }
        // Nodes that have left join again.
        self.follow(front)
    }

    fn list_soft(&mut self, front: &Front) {
        let is_soft = |node: &usize| front.nodes[*node] == NodeState::Soft;
        self.soft_factor = None;
        self.soft = self.watched.nodes.iter().copied().filter(is_soft).collect();
        let mut is_there = vec![false; front.nodes.len()];
        self.soft.iter().for_each(|&node| is_there[node] = true);
        self.soft.extend((0..front.nodes.len()).filter(|node| is_soft(node) && !is_there[*node]));
    }

    /// Lets watched nodes join, with the columns that the updater has of them, and reduces the matrix of the others.
    fn join(&mut self, joined: &[usize], places: &[usize]) -> Result<(), Error> {
        let watched = self.watched.nodes.len();
        self.check_budget(self.contact.len() + joined.len(), watched)?;
        let mut touched = WindowFactor::default();
        touched.reset(watched, joined.len());
        for &place in places {
            let pushed = touched.push(&mut self.watched.schur, place, 1.0);
            pushed.map_err(|_| Error::FactorizationFailed { nodes: joined.len() })?;
        }
        touched.finish(&mut self.watched.schur);
        joined.iter().try_for_each(|&node| self.contact.push(node))?;
        self.updater.join(&self.problem, &self.contact, &touched)?;
        let mut is_left = vec![true; watched];
        places.iter().for_each(|&place| is_left[place] = false);
        let left: Vec<usize> = (0..watched).filter(|&place| is_left[place]).collect();
        let columns = (0..joined.len()).flat_map(|event| {
            let column = touched.column(event);
            left.iter().map(move |&place| column[place])
        });
        self.joined = Some(Joined { nodes: joined.len(), columns: columns.collect() });
        self.watched.schur = self.watched.schur.part(&left, 0)?;
        self.watched.nodes = left.iter().map(|&place| self.watched.nodes[place]).collect();
        Ok(())
    }

    /// Lets nodes leave the contact. If all of them were watched there, they stay watched, behind the others.
    fn leave(&mut self, left: &[Left]) -> Result<(), Error> {
        let places = self.watched.places(self.problem.initial_gap().len());
        left.iter().try_for_each(|left| self.contact.remove(left.node).map(|_| ()))?;
        let places: Option<Vec<usize>> = left.iter().map(|left| places[left.node]).collect();
        let Some(places) = places else {
            self.watched = Watched::default();
            return self.updater.release(&self.problem, &self.contact, left);
        };
        let watched = self.watched.nodes.len();
        let mut touched = WindowFactor::default();
        touched.reset(watched, left.len());
        for &place in &places {
            let pushed = touched.push(&mut self.watched.schur, place, -1.0);
            pushed.map_err(|_| Error::FactorizationFailed { nodes: left.len() })?;
        }
        touched.finish(&mut self.watched.schur);
        self.updater.release_watched(&self.problem, &self.contact, left)?;
        let mut stays = vec![true; watched];
        places.iter().for_each(|&place| stays[place] = false);
        let stay: Vec<usize> = (0..watched).filter(|&place| stays[place]).collect();
        self.watched.schur = touched.opened(&self.watched.schur, &stay)?;
        self.watched.nodes = stay.iter().map(|&place| self.watched.nodes[place]).collect();
        self.watched.nodes.extend(left.iter().map(|left| left.node));
        Ok(())
    }

    fn check_budget(&self, contact: usize, watched: usize) -> Result<(), Error> {
        self.memory.check(self.bytes(contact, watched), self.contact.len())
    }

    fn bytes(&self, contact: usize, watched: usize) -> usize {
        // Three times a matrix of these nodes and its factor: the matrix itself and a copy, that of the soft nodes and
        // its factor, and the columns of a window.
        let of_window = WindowFactor::bytes(watched).saturating_mul(3);
        self.updater.bytes(contact, watched).saturating_add(of_window)
    }

    /// Another body of the same problem, which has what memory this one leaves.
    pub(super) fn beside(&self) -> Self {
        let Memory { budget, fixed } = self.memory;
        let own = self.bytes(self.contact.len(), self.watched.nodes.len());
        let left = Memory { budget, fixed: fixed.saturating_add(own) };
        Self::new(Arc::clone(&self.problem), self.law, left)
    }

    /// Before first touch, where the highest node comes into range.
    pub(super) fn apart(&self) -> ContactState {
        let (range, mean_gap) = (self.law.range(), self.problem.mean_gap());
        ContactState::new(&self.problem.grid(), 0, -range, 0.0, mean_gap + range)
    }

    /// Watches some nodes; those that were watched before come first, and stay if few of them are needed no more
    /// and there is memory for these.
    fn watch(&mut self, nodes: &[usize]) -> Result<(), Error> {
        let mut is_new = vec![false; self.problem.initial_gap().len()];
        nodes.iter().for_each(|&node| is_new[node] = true);
        let before = self.watched.nodes.iter().enumerate();
        let needed: Vec<usize> =
            before.filter(|(_, node)| is_new[**node]).map(|(k, _)| k).collect();
        let all = self.watched.nodes.len();
        let others = all - needed.len();
        let with_others = others + is_new.iter().filter(|is_new| **is_new).count();
        let stay = others <= nodes.len() / NEEDED_FOR_ONE
            && self.check_budget(self.contact.len(), with_others).is_ok();
        let kept = if stay { (0..all).collect() } else { needed };
        let mut watched: Vec<usize> = kept.iter().map(|&place| self.watched.nodes[place]).collect();
        watched.iter().for_each(|&node| is_new[node] = false);
        for &node in nodes {
            if std::mem::take(&mut is_new[node]) {
                watched.push(node);
            }
        }
        self.joined = None;
        if watched == self.watched.nodes {
            return Ok(());
        }
        self.check_budget(self.contact.len(), watched.len())?;
        let mut schur = self.watched.schur.part(&kept, watched.len())?;
        let places = self.contact.places();
        let with_positions: Vec<_> = watched.iter().map(|&node| (node, places[node])).collect();
        self.watched = Watched::default();
        let (problem, contact) = (&self.problem, &self.contact);
        self.updater.watch_beside(problem, contact, &with_positions, kept.len(), &mut schur)?;
        self.watched = Watched { nodes: watched, schur };
        // Those that were watched before come in the same order, and so do the soft ones among them.
        let places = self.watched.places(self.problem.initial_gap().len());
        let places: Option<Vec<usize>> = self.soft.iter().map(|&node| places[node]).collect();
        self.soft_factor =
            self.soft_factor.take().zip(places).map(|(soft, places)| soft.at(places));
        Ok(())
    }

    /// The factor of the soft nodes.
    fn factor_soft(&mut self) -> Result<&Soft, Error> {
        let unstable = Error::FactorizationFailed { nodes: self.contact.len() + self.soft.len() };
        let factor = match self.soft_factor.take() {
            Some(factor) => factor,
            None => {
                let places = self.watched.places(self.problem.initial_gap().len());
                if self.soft.iter().any(|&node| places[node].is_none()) {
                    let all: Vec<usize> =
                        self.watched.nodes.iter().chain(&self.soft).copied().collect();
                    self.watch(&all)?;
                }
                let places = self.watched.places(self.problem.initial_gap().len());
                let mut places: Vec<usize> =
                    self.soft.iter().filter_map(|&node| places[node]).collect();
                places.sort_unstable();
                self.soft = places.iter().map(|&place| self.watched.nodes[place]).collect();
                let compliance = self.law.slope().recip();
                Soft::of(&self.watched.schur, places, compliance).ok_or(unstable)?
            }
        };
        self.least_pivot = factor.least_pivot;
        Ok(self.soft_factor.insert(factor))
    }

    /// How some nodes, in ascending order, and the sums of pressures and of gaps answer to what is given of these
    /// nodes, with all soft nodes on their slope. `known` are rows that were made of this front before.
    pub(super) fn rows(
        &mut self,
        front: &Front,
        nodes: Vec<usize>,
        known: Option<Rows>,
    ) -> Result<(Answers, Rows), Error> {
        let all: Vec<usize> = self.soft.iter().chain(&nodes).copied().collect();
        self.watch(&all)?;
        let sums = match self.sums.take() {
            Some(sums) => sums,
            None => self.sums_by_node()?,
        };
        self.factor_soft()?;
        let places = self.watched.places(front.nodes.len());
        let of_rows: Vec<usize> = nodes.iter().filter_map(|&node| places[node]).collect();
        let too_few = Error::LengthMismatch { expected: nodes.len(), found: of_rows.len() };
        let Some(soft) = self.soft_factor.as_ref().filter(|_| of_rows.len() == nodes.len()) else {
            return Err(too_few);
        };
        // Of nodes in contact a gap is given, of which the matrix of the updater has the negative.
        let is_contact: Vec<bool> =
            nodes.iter().map(|&node| front.nodes[node] == NodeState::Contact).collect();
        let signs: Vec<f64> = is_contact.iter().map(|is| if *is { -1.0 } else { 1.0 }).collect();
        let (size, width) = (nodes.len(), nodes.len() + 2);
        let schur = &self.watched.schur;
        // Where each column comes from: what is known of a node, or one that is solved for.
        let sources = Sources::of(&nodes, known.as_ref());
        let mut columns = Vec::with_capacity(soft.len() * sources.new.len());
        for (&place, &node) in soft.places().iter().zip(&self.soft) {
            columns.extend(sources.new.iter().map(|&column| match of_rows.get(column) {
                Some(&row) => schur.entry(place, row),
                None => sums[column - size][node],
            }));
        }
        let solved = soft.half(columns, sources.new.len());
        let half = match known {
            Some(known) => known.half.joined(&solved, &sources.columns),
            None => solved,
        };
        let gram = half.gram().ok_or(Error::FactorizationFailed { nodes: width })?;
        let mut matrix = vec![0.0; width * size];
        for (j, column) in matrix.chunks_exact_mut(width).enumerate() {
            let sign = signs[j];
            for (i, value) in column.iter_mut().enumerate() {
                let through = gram.entry(i, j);
                *value = match of_rows.get(i) {
                    Some(&row) => sign * (schur.entry(row, of_rows[j]) + through),
                    None => sums[i - size][nodes[j]] + sign * through,
                };
            }
        }
        self.sums = Some(sums);
        let answers = Answers::new(matrix, is_contact);
        Ok((answers, Rows { nodes, half, signs }))
    }

    /// Sums of the squared pressures of the soft nodes that are no rows, at each of some instants: how far the approach
    /// has gone, which changes these pressures by itself, and what is given of the rows then.
    pub(super) fn squares(
        &self,
        rows: &Rows,
        is_row: impl Fn(usize) -> bool,
        field: &Field,
        given: &[(f64, Vec<f64>)],
    ) -> Vec<f64> {
        let Some(soft) = &self.soft_factor else { return vec![0.0; given.len()] };
        let factors: Vec<f64> = given
            .iter()
            .flat_map(|(_, given)| given.iter().zip(&rows.signs).map(|(given, sign)| given * sign))
            .collect();
        let answers = soft.combine(&rows.half, rows.signs.len(), &factors);
        let is_other: Vec<bool> = self.soft.iter().map(|&node| !is_row(node)).collect();
        let lists = given.iter().enumerate().map(|(list, (time, _))| {
            let nodes =
                self.soft.iter().zip(&is_other).enumerate().filter(|(_, (_, other))| **other);
            let squares = nodes.map(|(place, (&node, _))| {
                let alone = field.pressure[0][node] + time * field.pressure[1][node];
                (alone + answers[(place, list)]).powi(2)
            });
            squares.sum()
        });
        lists.collect()
    }

    /// Solves `C_II x = −b` for two right-hand sides b over the grid, of which only the values in contact count; x is 0
    /// elsewhere.
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
        for hold in &front.held {
            pressure[0][hold.node] = -hold.pull;
        }
        let carried = front.held.first();
        let along = match carried {
            None => sign,
            Some(hold) => {
                pressure[1][hold.node] = -hold.way;
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
        if let Some(&Hold { node, way, .. }) = carried
            && self.law.direction([field.pressure[0][node], field.gap[0][node]], way) != way
        {
            let [[_, dp], [_, dgap]] = [&mut field.pressure, &mut field.gap];
            dp.iter_mut().chain(dgap).for_each(|rate| *rate = -*rate);
        }
        Ok(field)
    }

    /// Pressures and gaps at the end of a window, before the factor follows: those of its rows are given, and contact
    /// and soft nodes are still those of its beginning. No rates.
    pub(super) fn preview(
        &mut self,
        front: &Front,
        (field, time): (&Field, f64),
        rows: &Rows,
        (ended, given): (&[(usize, [f64; 2])], Vec<f64>),
    ) -> Result<Field, Error> {
        let nodes = front.nodes.len();
        let mut pressure = field.pressure[0].clone();
        let answers = self.soft_factor.as_ref().map(|soft| {
            let factors: Vec<f64> =
                given.iter().zip(&rows.signs).map(|(x, sign)| x * sign).collect();
            soft.combine(&rows.half, rows.signs.len(), &factors)
        });
        if let Some(answers) = answers {
            for (place, &node) in self.soft.iter().enumerate() {
                let alone = field.pressure[0][node] + time * field.pressure[1][node];
                pressure[node] = alone + answers[(place, 0)];
            }
        }
        let mut given_gaps = vec![0.0; nodes];
        for &(node, [p, gap]) in ended {
            (pressure[node], given_gaps[node]) = (p, gap);
        }
        let bare = || self.problem.initial_gap().iter().map(|gap| gap - front.approach);
        let mut base: [Vec<f64>; 2] = [bare().collect(), vec![0.0; nodes]];
        let zero = vec![0.0; nodes];
        self.contact.order().iter().for_each(|&node| pressure[node] = 0.0);
        self.add_displacement(&mut base, [&pressure, &zero])?;
        if !self.contact.is_empty() {
            base[0].iter_mut().zip(&given_gaps).for_each(|(base, gap)| *base -= gap);
            let [solved, _] = self.solve([&base[0], &zero])?;
            self.contact.order().iter().for_each(|&node| pressure[node] = solved[node]);
            base[0].iter_mut().zip(&given_gaps).for_each(|(base, gap)| *base += gap);
            self.add_displacement(&mut base, [&solved, &zero])?;
        }
        let [gap, _] = base;
        Ok(Field { pressure: [pressure, zero.clone()], gap: [gap, zero] })
    }

    /// The greatest length that gaps at an approach have come of: rounding is relative to it.
    pub(super) fn greatest_length(&self, approach: f64) -> f64 {
        self.law.range() + self.problem.greatest_gap() + approach.abs()
    }

    /// Gives gaps that are known by their state the values that they have, after a check.
    fn settle(&self, front: &Front, field: &mut Field) -> Result<(), Error> {
        let slope = self.law.slope();
        let length = self.greatest_length(front.approach);
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

    /// Pressures of the soft nodes, from the gaps of all nodes without pressures on these and on the contact.
    fn soft_pressures(&mut self, base: &[Vec<f64>; 2]) -> Result<[Vec<f64>; 2], Error> {
        self.factor_soft()?;
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
        let range = self.law.range();
        gaps[0].iter_mut().for_each(|gap| *gap -= range);
        Ok(self.factor_soft()?.solve(gaps))
    }

    /// How the sums of pressures and of gaps change with a unit of pressure at each node out of contact, or of gap at
    /// each in contact, while the others in contact answer and no node is soft.
    fn sums_by_node(&mut self) -> Result<[Vec<f64>; 2], Error> {
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
}

impl Watched {
    /// The place of each node of a grid of so many.
    fn places(&self, nodes: usize) -> Vec<Option<usize>> {
        let mut places = vec![None; nodes];
        self.nodes.iter().enumerate().for_each(|(place, &node)| places[node] = Some(place));
        places
    }
}
