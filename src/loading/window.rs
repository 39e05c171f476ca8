//! The watched nodes and the events among them.

use crate::updater::{Schur, System, Touched};

/// A watched node that touches next.
#[derive(Debug, Clone, Copy)]
pub(super) struct Candidate {
    /// Its place in the window.
    pub(super) position: usize,
    /// The approach at which it touches.
    pub(super) approach: f64,
}

/// The nodes that may touch before any other, with all that decides among them.
///
/// Everything here is small and dense: the Schur complement S of the watched nodes, and their
/// reduced right-hand sides, of which the first two give the gap $r_1 - \delta r_2$.
#[derive(Debug, Clone, Default)]
pub(super) struct Window {
    nodes: Vec<usize>,
    schur: Schur,
    reduced: Vec<[f64; System::RHS]>,
    open: Vec<bool>,
    touched: Touched,
    horizon: f64,
    /// The right-hand sides when the window was opened.
    opened: Vec<[f64; System::RHS]>,
}

impl Window {
    /// The watched nodes.
    pub(super) fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// Nodes that touched since the window was opened.
    pub(super) fn touched(&self) -> &Touched {
        &self.touched
    }

    /// Watched nodes that have not touched, in the order of the window.
    pub(super) fn untouched(&self) -> impl Iterator<Item = usize> {
        self.nodes
            .iter()
            .zip(&self.open)
            .filter(|(_, open)| **open)
            .map(|(&node, _)| node)
    }

    /// Opens a window on `nodes`; no other node touches before the approach `horizon`. The caller
    /// fills the Schur complement and then calls [`Self::start`].
    pub(super) fn open(
        &mut self,
        nodes: impl Iterator<Item = usize>,
        horizon: f64,
    ) -> (&[usize], &mut Schur) {
        self.nodes.clear();
        self.nodes.extend(nodes);
        self.open.clear();
        self.open.resize(self.nodes.len(), true);
        self.touched.reset(self.nodes.len());
        self.horizon = horizon;
        (&self.nodes, &mut self.schur)
    }

    /// Takes over the right-hand sides of the Schur complement.
    pub(super) fn start(&mut self) {
        self.reduced.clear();
        self.reduced.extend_from_slice(self.schur.rhs());
        self.opened.clear();
        self.opened.extend_from_slice(self.schur.rhs());
    }

    /// The node with the smallest ratio $r_1 / r_2$, if it touches before the horizon. Ties go to
    /// the node of the lowest index.
    ///
    /// The first node of a window always counts: the horizon is the bound of a node that was
    /// later, so that anything else is rounding.
    pub(super) fn first_contact(&self) -> Option<Candidate> {
        let ratios = self
            .reduced
            .iter()
            .map(|[r1, r2, _]| if *r2 > 0.0 { r1 / r2 } else { f64::INFINITY });
        let candidate = self.smallest(ratios)?;
        let finite = candidate.approach < f64::INFINITY;
        let within = candidate.approach <= self.horizon || self.touched.is_empty();
        (finite && within).then_some(candidate)
    }

    /// The node with the smallest gap at the present approach, and the approach that closes it.
    pub(super) fn smallest_gap(&self, approach: f64) -> Option<Candidate> {
        if !self.touched.is_empty() {
            return None;
        }
        let gaps = self.reduced.iter().map(|[r1, r2, _]| r1 - approach * r2);
        let Candidate { position, .. } = self.smallest(gaps)?;
        let [r1, r2, _] = self.reduced[position];
        Some(Candidate {
            position,
            approach: r1 / r2,
        })
    }

    /// How much the events of this window have changed the approach at which a node touches,
    /// relative to that approach: what of it rests on the Schur complement.
    pub(super) fn drift(&self, candidate: Candidate) -> f64 {
        let Candidate { position, approach } = candidate;
        let ([r1, r2, _], [first1, first2, _]) = (self.reduced[position], self.opened[position]);
        ((r1 - first1).abs() + approach * (r2 - first2).abs()) / (r2 * approach)
    }

    /// Takes back the last events, and knows no further ones.
    pub(super) fn give_up(&mut self, events: usize) {
        let left = self.touched.len().saturating_sub(events);
        for &position in &self.touched.positions()[left..] {
            self.open[position] = true;
        }
        self.touched.truncate(&mut self.schur, left);
        self.horizon = f64::NEG_INFINITY;
    }

    /// The open node with the smallest value.
    fn smallest(&self, values: impl Iterator<Item = f64>) -> Option<Candidate> {
        let mut best: Option<Candidate> = None;
        for (position, value) in values.enumerate() {
            if !self.open[position] {
                continue;
            }
            let better = best.is_none_or(|best| {
                value < best.approach
                    || (value == best.approach && self.nodes[position] < self.nodes[best.position])
            });
            if better {
                best = Some(Candidate {
                    position,
                    approach: value,
                });
            }
        }
        best
    }

    /// Lets a watched node touch. Returns the entries it adds to $L^{-1}B$.
    ///
    /// # Errors
    ///
    /// The pivot, if it is not positive.
    pub(super) fn touch(&mut self, position: usize) -> Result<[f64; System::RHS], f64> {
        let node = self.nodes[position];
        let entries = self
            .touched
            .push(&mut self.schur, node, position, &mut self.reduced)?;
        self.open[position] = false;
        Ok(entries)
    }
}
