//! Nodes in contact and the bounds of their load, from event to event of a window.

use super::plastic::Plastic;
use super::run::LoadingRun;
use super::scalars::{PathScalars, Rates};
use super::state::ContactEvent;

/// Nodes in contact where a window begins.
#[derive(Debug, Clone, Copy)]
pub(super) struct Carried {
    /// How many are elastic, and how many have yielded.
    pub(super) nodes: [usize; 2],
    /// Events so far.
    step: usize,
    /// The sum of pressures of those that have yielded, and what all could carry: a load beyond these is rounding.
    sum: f64,
    most: f64,
}

impl Carried {
    pub(super) fn of(run: &LoadingRun) -> Self {
        let (elastic, step) = (run.contact.len(), run.steps());
        let Some(plastic) = &run.plastic else {
            return Self { nodes: [elastic, 0], step, sum: 0.0, most: f64::INFINITY };
        };
        let hardness = plastic.hardness().values();
        let carried: f64 = run.contact.order().iter().map(|&node| hardness[node]).sum();
        let sum = plastic.sum();
        Self { nodes: [elastic, plastic.count()], step, sum, most: sum + carried }
    }
}

/// Nodes in contact and what they carry, along the events of a window.
pub(super) struct Walk<'a> {
    hardness: Option<&'a [f64]>,
    pub(super) carried: Carried,
    pub(super) step: usize,
}

impl<'a> Walk<'a> {
    pub(super) fn new(plastic: Option<&'a Plastic>, carried: Carried) -> Self {
        let hardness = plastic.map(|plastic| plastic.hardness().values());
        Self { hardness, step: carried.step, carried }
    }

    /// Lets a node touch or yield. Returns the bounds of the load there.
    pub(super) fn pass(&mut self, node: usize, kind: ContactEvent) -> [f64; 2] {
        let Carried { nodes: [elastic, yielded], sum, most, .. } = &mut self.carried;
        let bounds = [*sum, *most];
        let hardness = self.hardness.map_or(f64::INFINITY, |hardness| hardness[node]);
        if kind == ContactEvent::Touch {
            *elastic += 1;
            *most += hardness;
        } else {
            *elastic -= 1;
            *yielded += 1;
            *sum += hardness;
        }
        self.step += 1;
        bounds
    }

    /// Takes over the rates behind the last event.
    pub(super) fn take(&self, scalars: &mut PathScalars, rates: Rates) {
        scalars.change_rates(rates, self.carried.nodes, self.carried.sum);
    }

    pub(super) fn contact_nodes(&self) -> usize {
        let [elastic, yielded] = self.carried.nodes;
        elastic + yielded
    }
}
