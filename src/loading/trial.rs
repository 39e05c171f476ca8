//! The end of a window before anything has followed there.

use std::sync::Arc;

use super::plastic::Displaced;
use super::run::LoadingRun;
use super::state::ContactEvent;
use super::window::{Window, WindowEvent};
use crate::contact::ContactSequence;
use crate::updater::{Behind, Left};
use crate::{Error, Problem};

/// A window at its end, before the path or what solves on its contact learns of it.
pub(super) struct Trial {
    pub(super) contact: ContactSequence,
    /// Nodes that yielded, in the order in which they did.
    pub(super) yielded: Vec<usize>,
    /// The same with the number of their event in the window, from 1 on, and their places in the contact then.
    departures: Vec<(usize, Left)>,
    /// Where nodes yielded: the problem of those that did not, and what the others displace.
    yields: Option<(Problem, Displaced)>,
}

impl Trial {
    /// Contact and problem behind some events.
    pub(super) fn of(run: &LoadingRun, events: &[(usize, ContactEvent)]) -> Result<Self, Error> {
        let (contact, yielded, departures) = contact_behind(run, events)?;
        let yields = match &run.plastic {
            Some(plastic) if !yielded.is_empty() => {
                let displaced = plastic.displaced(&yielded)?;
                Some((plastic.elastic(&run.problem, &displaced), displaced))
            }
            _ => None,
        };
        Ok(Self { contact, yielded, departures, yields })
    }

    /// Lets the path follow, whatever solves on its contact.
    pub(super) fn adopt(self, run: &mut LoadingRun) {
        let step = run.steps();
        if let (Some((problem, displaced)), Some(plastic)) = (self.yields, &run.plastic) {
            run.plastic = Some(Arc::new(plastic.grown(&self.yielded, &displaced)));
            run.problem = problem;
        }
        run.contact = self.contact;
        for (number, left) in self.departures {
            run.releases.push_yielded(step + number, left);
        }
    }

    /// The nodes that have joined and not yielded since.
    pub(super) fn joined(&self, run: &LoadingRun) -> Vec<usize> {
        let nodes = self.contact.order().iter();
        nodes.filter(|&&node| !run.contact.contains(node)).copied().collect()
    }

    /// The problem there, where it was `own` before.
    pub(super) fn problem<'a>(&'a self, own: &'a Problem) -> &'a Problem {
        self.yields.as_ref().map_or(own, |(problem, _)| problem)
    }

    /// Problem and contact there, and the nodes that have yielded since.
    pub(super) fn set<'a>(
        &'a self,
        run: &'a LoadingRun,
    ) -> (&'a Problem, &'a ContactSequence, &'a [usize]) {
        (self.problem(&run.problem), &self.contact, &self.yielded)
    }

    /// The nodes that have yielded, and what they carry.
    pub(super) fn pressures(&self, run: &LoadingRun) -> Vec<(usize, f64)> {
        self.yielded.iter().map(|&node| (node, run.hardness(node))).collect()
    }

    /// The state at an approach, where the problem was `own` before, and these pressures.
    pub(super) fn behind<'a>(
        &'a self,
        own: &'a Problem,
        yielded: &'a [(usize, f64)],
        approach: f64,
    ) -> Behind<'a> {
        let load = self.yields.as_ref().map_or(&[][..], |(_, displaced)| displaced.load());
        Behind { problem: self.problem(own), contact: &self.contact, yielded, load, approach }
    }

    /// The same events in another order.
    pub(super) fn reorder(
        &mut self,
        run: &mut LoadingRun,
        events: &[(usize, ContactEvent)],
    ) -> Result<(), Error> {
        let (contact, yielded, departures) = contact_behind(run, events)?;
        run.field.reorder(&self.contact, &contact);
        (self.contact, self.yielded, self.departures) = (contact, yielded, departures);
        Ok(())
    }
}

/// The nodes of events, and what happens to them.
pub(super) fn of_nodes(window: &Window, events: &[WindowEvent]) -> Vec<(usize, ContactEvent)> {
    events.iter().map(|event| (window.node(event.position), event.kind)).collect()
}

/// The contact behind some events, the nodes that yielded, and these with the number of their event and their places
/// then.
#[allow(clippy::type_complexity)]
fn contact_behind(
    run: &LoadingRun,
    events: &[(usize, ContactEvent)],
) -> Result<(ContactSequence, Vec<usize>, Vec<(usize, Left)>), Error> {
    let mut contact = run.contact.clone();
    let (mut yielded, mut departures) = (Vec::new(), Vec::new());
    for (number, &(node, kind)) in (1..).zip(events) {
        if kind == ContactEvent::Touch {
            contact.push(node)?;
        } else {
            let position = contact.remove(node)?;
            yielded.push(node);
            departures.push((number, Left { node, position }));
        }
    }
    Ok((contact, yielded, departures))
}
