//! Nodes that touch together, too many to be watched: a flat punch, a plateau.

use super::Corrected;
use crate::Error;
use crate::loading::run::LoadingRun;
use crate::loading::scales::Scales;
use crate::loading::state::ContactEvent;
use crate::updater::{LinearUpdater, Touched};

impl Corrected {
    /// Lets all nodes that touch at a time join, up to `most`, in the order of their indices. Between them
    /// stiffness and closing rate change in equal steps.
    pub(super) fn enter<U: LinearUpdater>(
        &mut self,
        run: &mut LoadingRun<U>,
        scales: &Scales,
        time: f64,
        most: usize,
    ) -> Result<(), Error> {
        let mut start = run.front;
        let approach = start.approach();
        let together = |&&(other, node): &&(f64, usize)| {
            let line = run.field.line(&run.problem, node, approach);
            other <= time + scales.tie_of(line.closing)
        };
        let group = self.ranking.iter().filter(together);
        let mut group: Vec<usize> = group.map(|&(_, node)| node).collect();
        // What their times cannot be told apart by.
        let error = group.iter().fold(scales.tie, |error, &node| {
            let line = run.field.line(&run.problem, node, approach);
            error.max(scales.tie_of(line.closing))
        });
        group.sort_unstable();
        group.truncate(most);
        let count = run.contact.len();
        for &node in &group {
            run.contact.push(node)?;
        }
        start.advance(approach + time);
        self.last_span = self.last_span.max(time);
        // However little is left open by so many nodes: rates must be exact.
        self.rate_span = f64::INFINITY;
        let entered = run
            .updater
            .join(&run.problem, &run.contact, &Touched::default())
            .and_then(|()| run.solve_field(start.approach(), self.rate_span));
        if let Err(error) = entered {
            run.contact.truncate(count);
            return Err(error);
        }
        run.front = start;
        self.survey(run)?;
        let [stiffness, closing] = start.missing(&run.front);
        let share = (group.len() as f64).recip();
        for (k, node) in group.into_iter().enumerate() {
            let contact_nodes = count + k + 1;
            start.touch(share * stiffness, share * closing, contact_nodes);
            start.clamp_mean_gap();
            let step = run.releases.steps(contact_nodes);
            let event = (step, ContactEvent::Touch, node);
            run.enqueue_at(&start, event, contact_nodes, error)?;
        }
        Ok(())
    }
}
