//! Whole paths on which nodes yield, single loads beside them, and unloading.

use asperity::loading::ContactEvent;
use asperity::{Error, LoadingSolver, LoadingState, PeriodicBoussinesq};

use crate::dense::{ContactSet, Instant, Node};
use crate::draw::Draw;
use crate::judge::rates_are_those_of;
use crate::kernels;
use crate::paths::Trial;
use crate::problem::Sample;
use crate::records::whole;
use crate::scratch::Scratch;
use crate::variant::Path;
use crate::verdict::{Tally, Verdict, Violation, ensure};
use crate::walk::{Demands, Walk};

/// Gaps in contact that single loads leave, relative to the approach.
const TOLERANCE: f64 = 1e-11;

/// Draws a contact problem on a body whose contact only grows, and a hardness, and follows its path as
/// [`paths()`](crate::paths()) does. Where no node is about to change, a single load has the sets of the path, and the
/// elastic path of the surface that is left ends in its state. Sometimes the path is written and read as well.
///
/// # Errors
///
/// What is wrong.
pub fn yielding(bytes: &[u8]) -> Verdict {
    let mut draw = Draw::new(bytes);
    Sample::look(&mut draw, kernels::GROWING, |sample, draw| {
        sample.harden(draw);
        run(sample, draw)
    })
}

fn run(sample: &Sample, draw: &mut Draw<'_>) -> Verdict {
    let mut tally = Trial::new(sample).run(draw)?;
    if draw.once_in(4) {
        tally += whole(sample, draw, &Scratch::new()?)?;
    }
    Ok(tally)
}

impl Trial<'_> {
    /// A single load, and unloading, beside the state of a path where a walk stands.
    pub(crate) fn beside(&self, path: &mut Path, state: &LoadingState, walk: &Walk<'_>) -> Verdict {
        let mut tally = Tally::default();
        // On a plateau the load is that of many states, and none is no load.
        let is_between = |(set, _): &(ContactSet<'_>, Instant)| {
            state.contact.load > 0.0 && set.all(Node::Elastic).count() > 0
        };
        let Some((set, instant)) = walk.solved(state).filter(is_between) else {
            return Ok(tally);
        };
        self.single_load(state, &set, &instant, &mut tally)
            .map_err(|violation| violation.during("a single load"))?;
        self.unloading(path, state, &set, &instant, &mut tally)
            .map_err(|violation| violation.during("unloading"))?;
        Ok(tally)
    }

    /// Whether a solution for the same load has the same sets if its gaps are off by `error` where they should be none,
    /// and negative by no more.
    ///
    /// Let d be the difference of its pressures from those of the state, of one sum, and that of gaps be w. Where d > 0
    /// the state's gap is not negative and the solution's no more than the error; where d < 0 the other way about. So
    /// `dᵀ C d = dᵀ w ≤ error Σ |d|`, and no d is greater than `error √n` over the least eigenvalue, which is one over
    /// the norm of the inverse or more. Then approaches differ by `|C| |d|` and the error, as gaps beside nodes that
    /// are elastic in both.
    fn is_clear(&self, set: &ContactSet<'_>, instant: &Instant, error: f64) -> bool {
        let Some([norm, inverse]) = self.dense.norms() else {
            return false;
        };
        let pressure =
            error * (self.dense.nodes() as f64).sqrt() * inverse + instant.pressure_error;
        let gap = 2.0 * (norm * pressure + error);
        let bears = |node: usize| self.dense.hardness().map_or(f64::INFINITY, |h| h[node]);
        set.states().iter().enumerate().all(|(node, state)| match state {
            Node::Out => instant.gap[node] > gap,
            Node::Yielded => instant.gap[node] < -gap,
            Node::Elastic => {
                let value = instant.pressure[node];
                value > pressure && bears(node) - value > pressure
            }
        })
    }

    fn single_load(
        &self,
        state: &LoadingState,
        set: &ContactSet<'_>,
        instant: &Instant,
        tally: &mut Tally,
    ) -> Result<(), Violation> {
        let found = self.dense.of(state);
        let own = self.dense.own_displacement(found.sum);
        let left = TOLERANCE * self.dense.own_length(state.contact.approach).max(own);
        let error = left + instant.gap_error;
        if left < 10.0 * instant.gap_error || !self.is_clear(set, instant, error) {
            return Ok(());
        }
        let solver = self.sample.single_loads().tolerance(TOLERANCE).build();
        let solution = solver.and_then(|mut solver| solver.solve(state.contact.load));
        let solution = match solution {
            Ok(solution) => solution,
            Err(Error::OutOfRange { value, .. }) if value > PeriodicBoussinesq::MAX_ASPECT => {
                return Ok(());
            }
            Err(failure) => {
                *tally += self.circumstances.judge(&failure)?;
                return Ok(());
            }
        };
        let fields = &solution.fields;
        for (node, state) in set.states().iter().enumerate() {
            let found = match (fields.contact_map[node], fields.yielded_map[node]) {
                (true, true) => Node::Yielded,
                (true, false) => Node::Elastic,
                _ => Node::Out,
            };
            ensure!(found == *state, "node {node} is {found:?}, and {state:?} on the path");
        }
        let single = self.dense.scalars(&solution.contact);
        // On one set the pressures of elastic nodes differ by what sums up to nothing: approaches by no more than gaps.
        tally.close("approach", single.own_approach, found.own_approach, 2.0 * error)?;
        let carried = 2.0 * set.norms.carried * error;
        for node in 0..set.states().len() {
            let found = fields.gap[node] - fields.plastic_depth[node];
            let (found, expected) = (self.dense.own_length(found), instant.gap[node]);
            tally.close("gap", found, expected, carried)?;
        }
        if let Some(plastic) = &solution.contact.plastic {
            let volume = plastic.volume / self.grid.cell_area();
            let [expected, errors] = set.plastic_sums(instant, carried);
            let volume = self.dense.own_length(volume);
            tally.close("plastic volume", volume, expected[0], errors[0])?;
        }
        let nodes = [Node::Elastic, Node::Yielded].map(|node| set.all(node).collect::<Vec<_>>());
        let nodes = [&nodes[0][..], &nodes[1][..]];
        let solved = ContactSet::beside(&self.dense, nodes, TOLERANCE, set.norms);
        if let Some(solved) = solved.filter(|solved| solved.closing_error < 0.1) {
            rates_are_those_of(&solved, (&solution, &single), self.grid.cell_area(), tally)?;
        }
        tally.checked += 1;
        Ok(())
    }

    /// The elastic path of the surface that is left, up to the same load.
    fn unloading(
        &self,
        path: &mut Path,
        state: &LoadingState,
        set: &ContactSet<'_>,
        instant: &Instant,
        tally: &mut Tally,
    ) -> Result<(), Violation> {
        let failed = |error: Error| Violation::new(error.to_string());
        let residual = path.residual_surface_at(state).map_err(failed)?;
        let reloading = LoadingSolver::builder(&residual, &self.sample.kernel);
        let states = reloading
            .max_load(state.contact.load)
            .build()
            .and_then(|path| path.collect::<Result<Vec<LoadingState>, _>>());
        let states = match states {
            Ok(states) => states,
            Err(failure) => {
                *tally += self.circumstances.judge(&failure)?;
                return Ok(());
            }
        };
        let Some(last) = states.last() else {
            return Err(Violation::new("an elastic path without a state"));
        };
        let dense = self.dense.elastic(residual.matrix());
        let mut walk = Walk::new(&dense, self.grid, Demands::EXACT);
        walk.skip(&states)?;
        let Some((again, reloaded)) = walk.solved(last) else {
            return Ok(());
        };
        // What the heights are off by, and what rounds.
        let error = again.norms.carried * instant.carried_error + reloaded.gap_error;
        if last.event != ContactEvent::Limit || !self.is_clear(set, instant, error) {
            return Ok(());
        }
        for (node, state) in set.states().iter().enumerate() {
            let is_in = again.contains(node);
            ensure!(
                is_in == (*state != Node::Out),
                "node {node} in contact: {is_in}, {state:?} on the path"
            );
        }
        let (found, expected) = (dense.of(last), self.dense.of(state));
        let shift = -self.dense.own_length(residual.max_height());
        tally.close("load", found.sum, expected.sum, 0.0)?;
        tally.close("approach", found.own_approach + shift, expected.own_approach, error)?;
        tally.close("mean gap", found.mean_gap, expected.mean_gap, error)?;
        tally.close("energy", found.energy, expected.energy, 2.0 * error * found.sum)?;
        tally.checked += 1;
        Ok(())
    }
}
