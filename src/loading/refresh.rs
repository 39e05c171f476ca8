//! From one window to the next: all gaps afresh, and the nodes to watch.

use std::time::Instant;

use super::cost::{automatic_window, watched_for};
use super::limits::ContactRule;
use super::solver::LoadingSolver;
use super::sum::Sum;
use crate::updater::LinearUpdater;
use crate::{Error, InfluenceKernel, Surface};

/// How far below zero a gap may lie, relative to the greatest initial gap and the approach, before
/// it counts as an overlap. The displacement comes from an FFT and a triangular solve, whose errors
/// stay below 1e-13 of the greatest displacement.
const GAP_TOLERANCE: f64 = 1e-10;
/// The same for $y_2$ relative to its greatest value; the condition of the influence matrix grows
/// with the side of the grid only, so that solves lose two or three digits.
const PRESSURE_TOLERANCE: f64 = 1e-10;
/// Rates below this, relative to the greatest, are nothing but rounding where either sign is possible:
/// otherwise nodes that neither gain nor lose pressure could touch and leave for ever.
const LEAST_RATE: f64 = 1e-12;

impl<S: Surface, K: InfluenceKernel, U: LinearUpdater> LoadingSolver<S, K, U> {
    /// Commits what touched, computes all gaps and opens the next window.
    pub(super) fn refresh(&mut self) -> Result<(), Error> {
        let count = self.contact.len();
        if self.may_take_back() {
            // The solution that verified the last window, to the last bit, whatever was asked for
            // in between.
            self.solve(count)?;
        }
        // There is room: it was asked for before these nodes were watched.
        self.commit()?;
        let size = self.affordable(count, self.next_window_size(count))?;
        if !self.may_take_back() {
            self.solve(count)?;
        }
        if !self.updater.is_exact() {
            self.renew_front();
        } else if self.may_take_back() {
            self.renew_stiffness();
        }
        self.rank()?;
        let start = Instant::now();
        let (size, horizon) = self.choose(size);
        self.timings.choice += start.elapsed();
        self.timings.windows += 1;
        self.watch(size, horizon)
    }

    /// Opens a window on the first `size` nodes of the ranking.
    pub(super) fn watch(&mut self, size: usize, horizon: f64) -> Result<(), Error> {
        let watched = self.ranking[..size].iter().map(|&(_, node)| node);
        let (nodes, schur) = self.window.open(watched, horizon);
        self.updater.schur(&self.system, nodes, schur)?;
        if schur.size() != size {
            return Err(Error::UpdaterMismatch {
                quantity: "the Schur complement",
                expected: size,
                found: schur.size(),
            });
        }
        self.window.start();
        Ok(())
    }

    /// Takes the stiffness at the front from the solution on the contact set.
    pub(super) fn renew_stiffness(&mut self) {
        let mut stiffness = Sum::default();
        self.solution.y2.iter().for_each(|y2| stiffness.add(*y2));
        self.front.unit_unit = stiffness.total();
    }

    /// Takes load, energy and stiffness at the front from the solution on the contact set.
    fn renew_front(&mut self) {
        let approach = self.front.approach;
        self.renew_stiffness();
        let (mut load, mut work) = (Sum::default(), Sum::default());
        let solution = self.solution.y1.iter().zip(&self.solution.y2);
        for (&node, (y1, y2)) in self.contact.iter().zip(solution) {
            let pressure = y1 + approach * y2;
            load.add(pressure);
            work.add(pressure * (approach - self.system.gap()[node]));
        }
        self.front.load = self.grid.cell_area() * load.total();
        self.front.energy = 0.5 * self.grid.cell_area() * work.total();
    }

    /// How many nodes to watch with `count` nodes in contact.
    fn next_window_size(&self, count: usize) -> usize {
        let nodes = self.grid.nodes();
        let size = match (self.rule, self.window_size) {
            (ContactRule::SmallestGap, _) => 1,
            (_, Some(size)) => size,
            (_, None) => automatic_window(count, nodes, self.updater.window_cost())
                .min(watched_for(self.limits.nodes - count)),
        };
        size.min(nodes - count)
    }

    /// Ranks the nodes out of contact by the approach at which they would touch if no other did (or,
    /// under the paper's rule, by their gap), after checking that the path is still one.
    pub(super) fn rank(&mut self) -> Result<(), Error> {
        let approach = self.front.approach;
        let grid = self.grid;
        let exact = self.rule == ContactRule::FirstContact;
        let stepwise = self.is_stepwise();
        let least_closing = if stepwise { LEAST_RATE } else { 0.0 };
        if exact && !stepwise {
            let least = -PRESSURE_TOLERANCE * self.greatest_rate();
            let contact = self.contact.iter().zip(&self.solution.y2);
            let mut rates = contact.map(|(&node, &y2)| (node, y2));
            if let Some((node, y2)) = rates.find(|(_, y2)| y2.is_nan() || *y2 < least) {
                return Err(self.not_monotone("pressure per unit of approach", node, y2));
            }
        }

        let gaps = self.system.gap();
        let least = -GAP_TOLERANCE * (self.greatest_gap + approach);
        let start = Instant::now();
        let [u1, u2] = self.fields.displacements(&self.contact, &self.solution)?;
        self.timings.convolution += start.elapsed();
        let start = Instant::now();
        self.ranking.clear();
        // Sums over the nodes out of contact have no cancellation, unlike the running ones: close
        // to full contact only they are exact.
        let (mut closing, mut mean_gap) = (Sum::default(), Sum::default());
        for (node, ((gap, u1), u2)) in gaps.iter().zip(u1).zip(u2).enumerate() {
            if self.in_contact[node] {
                continue;
            }
            let (r1, r2) = (gap + u1, 1.0 - u2);
            let present = r1 - approach * r2;
            if present.is_nan() {
                return Err(Error::NotFinite {
                    step: self.steps() + 1,
                });
            }
            if exact && present < least {
                let (ix, iy) = grid.coordinates(node);
                return Err(Error::NotMonotone {
                    quantity: "gap",
                    ix,
                    iy,
                    approach,
                    value: present,
                });
            }
            closing.add(r2);
            mean_gap.add(present);
            let key = match self.rule {
                ContactRule::SmallestGap => present,
                ContactRule::FirstContact if r2 > least_closing => r1 / r2,
                ContactRule::FirstContact => f64::INFINITY,
            };
            self.ranking.push((key, node));
        }
        self.front.closing = closing.total() / grid.nodes() as f64;
        self.front.mean_gap = mean_gap.total() / grid.nodes() as f64;
        self.timings.choice += start.elapsed();
        Ok(())
    }

    /// The greatest $y_2$.
    fn greatest_rate(&self) -> f64 {
        self.solution.y2.iter().copied().fold(0.0, f64::max)
    }

    /// What $y_2$ has to be below for a node to lose its pressure.
    pub(super) fn slowest_release(&self) -> f64 {
        -LEAST_RATE * self.greatest_rate()
    }

    /// Moves the nodes to watch to the front of the ranking, those watched before first; returns their
    /// number, `size` or a little less, and the horizon, the smallest key among the others.
    fn choose(&mut self, mut size: usize) -> (usize, f64) {
        let order = |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        let multiple = match (self.rule, self.window_size) {
            (ContactRule::FirstContact, None) => self.updater.window_cost().multiple.max(1),
            _ => 1,
        };
        let mut horizon = f64::INFINITY;
        let mut among = self.ranking.len();
        loop {
            if size < among {
                let ranking = &mut self.ranking[..among];
                horizon = ranking.select_nth_unstable_by(size, order).1.0;
            }
            let chosen = &mut self.ranking[..size];
            chosen.sort_unstable_by_key(|&(_, node)| node);
            let again = |node: &usize| chosen.binary_search_by_key(node, |&(_, node)| node).is_ok();
            let new = size - self.window.untouched().filter(again).count();
            if new <= multiple || new.is_multiple_of(multiple) {
                break;
            }
            among = size;
            size -= new % multiple;
        }
        let chosen = &mut self.ranking[..size];
        let mut front = 0;
        // Nodes watched before keep their order, so that the updater knows them again.
        for node in self.window.untouched() {
            if let Ok(found) = chosen[front..].binary_search_by_key(&node, |&(_, node)| node) {
                chosen[front..=front + found].rotate_right(1);
                front += 1;
            }
        }
        (size, horizon)
    }

    /// Bytes held whatever the number of nodes in contact: all of them O(grid).
    pub(super) fn fixed_bytes(&self) -> usize {
        let ranking = size_of::<(f64, usize)>();
        let contact = size_of::<usize>() + size_of::<bool>();
        self.grid.nodes() * (ranking + contact) + self.system.bytes() + self.fields.bytes()
    }

    /// The greatest window up to `size` that stays within the memory budget.
    pub(super) fn affordable(&self, count: usize, mut size: usize) -> Result<usize, Error> {
        let budget = self.memory_budget;
        loop {
            let needed = self.bytes(count + size, size);
            if needed <= budget {
                return Ok(size);
            }
            if size <= 1 {
                return Err(Error::MemoryBudget {
                    needed,
                    budget,
                    nodes_that_fit: count,
                });
            }
            size /= 2;
        }
    }

    /// Bytes held with `count` nodes in contact and `watched` watched.
    fn bytes(&self, count: usize, watched: usize) -> usize {
        // The Schur complement and its factor, both of the watched nodes.
        let window = watched
            .saturating_mul(watched)
            .saturating_mul(2 * size_of::<f64>());
        self.updater
            .bytes(count, watched)
            .saturating_add(window)
            .saturating_add(self.fixed_bytes())
    }
}
