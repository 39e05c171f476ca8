//! The end of a window before anything has followed there.

use std::sync::Arc;

use super::plastic::{Displaced, Plastic};
use super::run::LoadingRun;
use super::state::ContactEvent;
use crate::contact::ContactSequence;
use crate::updater::{Behind, Left};
use crate::{Error, Problem};

/// A window at its end, before the updater learns of it.
pub(super) struct Trial {
    pub(super) contact: ContactSequence,
    pub(super) problem: Problem,
    displaced: Displaced,
    /// Nodes that yielded, in the order in which they did.
    pub(super) yielded: Vec<usize>,
    /// The same with the number of their event in the window, from 1 on, and their places in the contact then.
    departures: Vec<(usize, Left)>,
}

impl Trial {
    /// Contact and problem behind some events.
    pub(super) fn of(
        run: &LoadingRun,
        plastic: &Plastic,
        events: impl Iterator<Item = (usize, ContactEvent)>,
    ) -> Result<Self, Error> {
        let (contact, yielded, departures) = contact_behind(run, events)?;
        let displaced = plastic.displaced(&yielded)?;
        let problem = plastic.elastic(&run.problem, &displaced);
        Ok(Self { contact, problem, displaced, yielded, departures })
    }

    /// Lets the path follow, whatever solves on its contact. Returns what has yielded then.
    pub(super) fn adopt(self, run: &mut LoadingRun, plastic: &Plastic) -> Arc<Plastic> {
        let step = run.steps();
        let Self { contact, problem, displaced, yielded, departures } = self;
        let plastic = Arc::new(plastic.grown(&yielded, &displaced));
        run.plastic = Some(Arc::clone(&plastic));
        run.problem = problem;
        run.contact = contact;
        for (number, left) in departures {
            run.releases.push_yielded(step + number, left);
        }
        plastic
    }

    /// Problem and contact there, and the nodes that have yielded since.
    pub(super) fn set(&self) -> (&Problem, &ContactSequence, &[usize]) {
        (&self.problem, &self.contact, &self.yielded)
    }

    /// The nodes that have yielded, and what they carry.
    pub(super) fn pressures(&self, plastic: &Plastic) -> Vec<(usize, f64)> {
        let hardness = plastic.hardness().values();
        self.yielded.iter().map(|&node| (node, hardness[node])).collect()
    }

    pub(super) fn behind<'a>(&'a self, yielded: &'a [(usize, f64)], approach: f64) -> Behind<'a> {
        let (problem, contact) = (&self.problem, &self.contact);
        Behind { problem, contact, yielded, load: self.displaced.load(), approach }
    }

    /// The same events in another order.
    pub(super) fn reorder(
        &mut self,
        run: &mut LoadingRun,
        events: &[(usize, ContactEvent)],
    ) -> Result<(), Error> {
        let (contact, yielded, departures) = contact_behind(run, events.iter().copied())?;
        run.field.reorder(&self.contact, &contact);
        (self.contact, self.yielded, self.departures) = (contact, yielded, departures);
        Ok(())
    }
}

/// The contact behind some events, the nodes that yielded, and these with the number of their event and their places then.
#[allow(clippy::type_complexity)]
fn contact_behind(
    run: &LoadingRun,
    events: impl Iterator<Item = (usize, ContactEvent)>,
) -> Result<(ContactSequence, Vec<usize>, Vec<(usize, Left)>), Error> {
    let mut contact = run.contact.clone();
    let (mut yielded, mut departures) = (Vec::new(), Vec::new());
    for (number, (node, kind)) in (1..).zip(events) {
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
