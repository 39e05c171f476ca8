//! Surfaces that stick: walks with loops within loops.

use asperity::adhesion::{
    Adhesion, AdhesiveEnd, AdhesiveEvent, AdhesiveFields, AdhesivePath, AdhesiveState, NodeState,
};
use asperity::{ContactState, ContactTarget, Error, KernelTable};
use asperity_testing::equilibria::Equilibria;
use nalgebra::{DMatrix, DVector};

use crate::draw::Draw;
use crate::kernels::Class;
use crate::problem::Sample;
use crate::verdict::{Tally, Verdict, Violation, ensure};

/// Cells up to so many times as long as wide; with longer ones matrices of neighbours are nearly singular.
const LONGEST: f64 = 10.0;
/// Nodes of which all states are tried: 4⁸ of them.
const TRIED: usize = 8;
/// Gaps relative to the range and the greatest length, pressures relative to the greatest of the walk, and energies
/// relative to their greatest: rounding of solutions whose condition is 10³ at most, with two digits to spare.
const GAP: f64 = 1e-9;
const ENERGY: f64 = 1e-9;
/// Gaps and pressures of a surface that has nodes of one height. They come near together, and where not all of them are
/// stable there, some are left beyond their law by the slack of a window, 10⁻⁹ of the stress, which soft nodes amplify.
const TIED: f64 = 1e-7;
/// Rates relative to those of their equations, for each unit of the condition: rounding, three digits that a window may
/// lose before it ends, and two to spare.
const RATE: f64 = 1e-11;

/// Draws a surface on a half-space, a law of adhesion and a walk of approaches. Energies balance and jumps lose at
/// every state; where the walk turns, pressures and gaps are on the law by dense displacements, and numbers of nodes,
/// energies, mean gap and stiffnesses follow from them; on few nodes the state is the extreme one of all equilibria;
/// and a closed loop restores its state.
///
/// # Errors
///
/// What is wrong.
pub fn adhesion(bytes: &[u8]) -> Verdict {
    let mut draw = Draw::new(bytes);
    let shape = match draw.whole(0, 3) {
        0 => (4, 2),
        1 => (2, 3),
        2 => (draw.whole(1, 40), 1),
        _ => (draw.whole(2, 9), draw.whole(2, 9)),
    };
    let sample = Sample::half_space(&mut draw, shape, LONGEST)?;
    run(&sample, &mut draw).map_err(|violation| violation.during(sample.context()))
}

/// A law whose range is of the order of the heights, one in five weak: stiff bodies that stick a little. None on one
/// cell of the spectral half-space, which has no wave, so that no pressure displaces anything.
fn law(draw: &mut Draw<'_>, sample: &Sample) -> Result<Option<Adhesion>, Error> {
    let grid = sample.kernel.grid();
    let height = sample.surface.peak_to_valley();
    let height = if height > 0.0 { height } else { grid.dx() };
    let range = height * draw.decades(-1.0, 0.7);
    let resolution = match draw.between(0.05, 0.75) {
        weak if weak < 0.2 => 0.2 * 10_f64.powf(-7.3 * (weak - 0.05) / 0.15),
        resolution => resolution,
    };
    // Per work, of a triangle of this range.
    let (one, unit) = (1e-3, 1.0);
    let compliance = Adhesion::work(one).range(unit).on(&*sample.kernel)?;
    let compliance = compliance.resolution() / compliance.slope();
    let law = match draw.whole(0, 2) {
        0 => Adhesion::work(0.5 * resolution / compliance * range * range),
        1 => Adhesion::work(0.5 * resolution / compliance * range * range).range(range),
        _ => {
            let flat = draw.between(0.05, 0.8) * range;
            let stress = resolution / compliance * (range - flat);
            Adhesion::maugis(0.5 * stress * (flat + range), stress).range(range)
        }
    };
    Ok(Some(law).filter(|_| compliance.is_normal()))
}

fn run(sample: &Sample, draw: &mut Draw<'_>) -> Verdict {
    let grid = sample.kernel.grid();
    let is_long = grid.cell_aspect() > LONGEST;
    let set_up = law(draw, sample).and_then(|law| {
        let Some(law) = law else {
            return Ok(None);
        };
        let builder = AdhesivePath::builder(&sample.surface, &*sample.kernel, law);
        let builder = builder.window_size(draw.whole(1, 40));
        Ok(Some((builder.build()?, KernelTable::new(&*sample.kernel)?)))
    });
    let (path, table) = match set_up {
        Ok(Some(made)) => made,
        Ok(None) => return Ok(Tally::refusal()),
        Err(_) if is_long => return Ok(Tally::refusal()),
        // A single cell that repeats.
        Err(Error::OutOfRange { value: 0.0, .. }) if grid.nodes() == 1 => {
            return Ok(Tally::refusal());
        }
        Err(error) => {
            return Err(Violation::new(format!("a sensible law was refused: {error}")));
        }
    };
    let range = path.law().range();
    let deep = sample.surface.peak_to_valley().max(range);
    // On branches that grow as the approach does: mean planes may go back in a jump.
    let is_free = table.gauge().is_none();
    let layer = matches!(sample.class, Class::Soft | Class::SoftPeriodic);
    let may_cycle = (sample.class == Class::Spectral || layer) && !is_distinct(sample);
    let mut trial = Trial {
        exact: Equilibria::of(path.problem(), path.law()),
        gauge: table.gauge().unwrap_or_default(),
        greatest: path.law().stress(),
        energy: 0.0,
        slack: if is_distinct(sample) { GAP } else { TIED },
        path,
        sample,
        tally: Tally::default(),
        events: Vec::new(),
    };
    // Within range: where it begins a state is both, out of range and near.
    let turns: Vec<f64> = (0..5).map(|_| draw.between(-0.97 * range, deep)).collect();
    match trial.walk(&turns, is_free) {
        Ok(()) => Ok(trial.tally),
        // Of long cells the matrix has neighbours that are nearly one. On the spectral half-space a pull may open a gap, on
        // a thin layer neighbours hardly know of each other: nodes of one height may take turns without end.
        Err(Stop::Error(_)) if is_long || may_cycle => Ok(Tally::refusal()),
        Err(Stop::Error(error)) => Err(Violation::new(format!("the path broke off: {error}"))),
        Err(Stop::Violation(violation)) => Err(violation),
    }
}

/// Whether no two nodes have one height: those that do may take turns.
fn is_distinct(sample: &Sample) -> bool {
    let mut heights: Vec<f64> = sample.surface.matrix().iter().copied().collect();
    heights.sort_by(f64::total_cmp);
    let least = 1e-6 * sample.surface.peak_to_valley();
    heights.windows(2).all(|pair| pair[1] - pair[0] > least)
}

/// Why a walk does not go on.
enum Stop {
    Error(Error),
    Violation(Violation),
}

impl From<Error> for Stop {
    fn from(error: Error) -> Self {
        Self::Error(error)
    }
}

impl From<Violation> for Stop {
    fn from(violation: Violation) -> Self {
        Self::Violation(violation)
    }
}

struct Trial<'a> {
    path: AdhesivePath,
    exact: Equilibria,
    /// What a unit sum of pressures displaces the mean planes by.
    gauge: f64,
    /// The greatest pressure or mean pressure so far, or σ₀.
    greatest: f64,
    /// The greatest energy so far.
    energy: f64,
    /// What gaps and pressures may be off by: [`GAP`] or [`TIED`].
    slack: f64,
    sample: &'a Sample,
    tally: Tally,
    /// Approaches of events.
    events: Vec<f64>,
}

impl Trial<'_> {
    fn walk(&mut self, turns: &[f64], is_free: bool) -> Result<(), Stop> {
        let mut levels = turns.to_vec();
        levels.sort_by(f64::total_cmp);
        let &[lowest, low, middle, high, highest] = &levels[..] else { return Ok(()) };
        // From out of range on, loading has the greatest gaps of all equilibria; unloading the least, if there was but one
        // where it turned. Loops have neither.
        self.go(lowest, Extreme::Greatest)?;
        let turned = self.go(highest, Extreme::Greatest)?;
        let is_alone = turned.is_some_and(|fields| self.is_alone(&fields));
        let start = self.go(low, if is_alone { Extreme::Least } else { Extreme::Neither })?;
        for turn in [high, middle, high] {
            self.go(self.at_event(turn, [low, highest]), Extreme::Neither)?;
        }
        let back = self.go(low, Extreme::Neither)?;
        if let (true, Some(start), Some(back)) = (is_free, start, back)
            && is_distinct(self.sample)
        {
            let left = (&start.gap - &back.gap).amax();
            let allowed = self.slack * self.length();
            self.tally.close("a gap behind a loop", left, 0.0, allowed)?;
        }
        self.path.unload()?;
        self.follow()?;
        if self.path.end() == Some(AdhesiveEnd::NoMoreEvents)
            && let Some(state) = self.path.state()
        {
            let nodes = (state.contact.contact_nodes, state.soft_nodes, state.cohesive_nodes);
            if nodes != (0, 0, 0) || state.contact.load != 0.0 {
                return Err(Violation::new(format!("pulled off, and yet {state:?}")).into());
            }
        }
        Ok(())
    }

    fn length(&self) -> f64 {
        self.path.law().range() + self.sample.surface.peak_to_valley()
    }

    /// The approach of the event that was nearest to a level, if one was between these: rounding puts the target before
    /// it or behind it.
    fn at_event(&self, level: f64, [low, high]: [f64; 2]) -> f64 {
        let between = self.events.iter().copied().filter(|event| *event > low && *event < high);
        let off = |event: &f64| (event - level).abs();
        between.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(level)
    }

    /// Goes to an approach; fields of the state there, if a branch ends there.
    fn go(&mut self, to: f64, extreme: Extreme) -> Result<Option<AdhesiveFields>, Stop> {
        let present = self.path.state().map_or(f64::NEG_INFINITY, |s| s.contact.approach);
        let target = ContactTarget::Approach(to);
        let is_loading = to >= present;
        match is_loading {
            true => self.path.load_to(target),
            false => self.path.unload_to(target),
        }?;
        self.follow()?;
        self.check_end(to, is_loading)?;
        // A jump may have led mean planes beyond where the walk was to go.
        let extreme = match extreme {
            Extreme::Greatest if !is_loading => Extreme::Neither,
            Extreme::Least if is_loading => Extreme::Neither,
            _ => extreme,
        };
        let Some(state) = self.path.state().filter(|state| state.event == AdhesiveEvent::Limit)
        else {
            return Ok(None);
        };
        let fields = self.path.fields_at(&state)?;
        self.check(&state, &fields)?;
        if self.is_tried(&fields) {
            self.compare(&fields, extreme)?;
        }
        Ok(Some(fields))
    }

    /// A branch ends at its target, or where nothing more happens.
    fn check_end(&self, to: f64, is_loading: bool) -> Result<(), Violation> {
        let Some(state) = self.path.state() else { return Ok(()) };
        let ContactState { approach, contact_nodes, .. } = state.contact;
        let pulled = contact_nodes + state.soft_nodes + state.cohesive_nodes;
        // It is that of mean planes, from which all that they have ever been displaced by is taken off.
        let nodes = self.path.grid().nodes();
        let reach = self.length() + to.abs() + self.gauge.abs() * self.greatest * nodes as f64;
        match self.path.end() {
            Some(AdhesiveEnd::Target) => ensure!(
                state.event != AdhesiveEvent::Limit || (approach - to).abs() <= self.slack * reach,
                "a branch to {to} ends at {approach}"
            ),
            _ if is_loading => {
                ensure!(contact_nodes == nodes, "nothing more happens below {to}: {state:?}")
            }
            _ => ensure!(pulled == 0, "nothing more happens above {to}: {state:?}"),
        }
        Ok(())
    }

    /// The rest of the branch: what costs nothing to check.
    fn follow(&mut self) -> Result<(), Stop> {
        let unit = self.path.law().work() * self.path.grid().nominal_area();
        let mut dissipated = self.path.state().map_or(0.0, |state| state.dissipated);
        while let Some(state) = self.path.next().transpose()? {
            let energies = [state.contact.energy, state.adhesive_energy, state.dissipated];
            let greatest = energies.iter().fold(unit, |most, energy| most.max(energy.abs()));
            self.tally.not_negative("loss", state.dissipated - dissipated, ENERGY * greatest)?;
            dissipated = state.dissipated;
            if !matches!(state.event, AdhesiveEvent::JumpEnd | AdhesiveEvent::Limit) {
                self.events.push(state.contact.approach);
            }
            let sum = energies.iter().sum();
            self.tally.close("work", state.work, sum, ENERGY * greatest)?;
            self.energy = self.energy.max(greatest);
            // A window goes on from what rounding has made of its first state.
            let mean = state.contact.load.abs() / self.path.grid().nominal_area();
            self.greatest = self.greatest.max(mean);
            self.tally.checked += 1;
        }
        Ok(())
    }

    /// A state from its pressures alone.
    fn check(&mut self, state: &AdhesiveState, fields: &AdhesiveFields) -> Result<(), Violation> {
        let law = self.path.law();
        let problem = self.path.problem();
        let pressure = &fields.pressure;
        let approach = state.contact.approach + self.gauge * pressure.sum();
        self.greatest = pressure.amax().max(self.greatest);
        let greatest = self.greatest;
        let length = self.length() + approach.abs();
        // Of all gaps, of pressures times displacements, and of adhesion over the area of a cell.
        let (mut gaps, mut elastic, mut adhesive) = (0.0, 0.0, 0.0);
        for (node, kind) in fields.nodes.iter().enumerate() {
            let displaced = pressure.iter().enumerate().map(|(other, p)| {
                problem.coefficient(node, other).map_or(f64::NAN, |coefficient| coefficient * p)
            });
            let displaced: f64 = displaced.sum();
            let gap = problem.initial_gap()[node] + displaced - approach;
            gaps += gap;
            elastic += 0.5 * pressure[node] * displaced;
            adhesive += law.energy(gap.max(0.0));
            self.tally.close("gap", fields.gap[node], gap, self.slack * length)?;
            let allowed = self.slack * greatest + law.slope() * self.slack * length;
            match kind {
                NodeState::Contact => {
                    self.tally.close("gap in contact", gap, 0.0, self.slack * length)?;
                    self.tally.not_negative("pressure", pressure[node] + law.stress(), allowed)?;
                }
                NodeState::Held => {
                    return Err(Violation::new(format!("node {node} is held outside of a jump")));
                }
                _ => {
                    self.tally.not_negative("gap", gap, self.slack * length)?;
                    self.tally.close("pull", -pressure[node], law.pull(gap), allowed)?;
                }
            }
        }
        let area = self.path.grid().cell_area();
        let (nodes, sum) = (pressure.len() as f64, pressure.sum());
        let unit = area * greatest * nodes;
        self.tally.close("load", state.contact.load, area * sum, self.slack * unit)?;
        let count = |kind| fields.nodes.iter().filter(|node| **node == kind).count();
        let expected = [NodeState::Soft, NodeState::Cohesive, NodeState::Contact].map(count);
        let found = [state.soft_nodes, state.cohesive_nodes, state.contact.contact_nodes];
        ensure!(
            found == expected,
            "{found:?} nodes are soft, cohesive and in contact: {expected:?}"
        );
        // Sums along the walk, which long cells let drift from what the present pressures say.
        if self.sample.kernel.grid().cell_aspect() <= LONGEST {
            // About the mean planes, as far as these have ever been displaced.
            elastic -= 0.5 * self.gauge * sum * sum;
            let reach = length + self.gauge.abs() * greatest * nodes;
            let allowed = ENERGY * self.energy + self.slack * unit * reach;
            self.tally.close(
                "mean gap",
                state.contact.mean_gap,
                gaps / nodes,
                self.slack * reach,
            )?;
            self.tally.close("elastic energy", state.contact.energy, area * elastic, allowed)?;
            self.tally.close(
                "energy of adhesion",
                state.adhesive_energy,
                area * adhesive,
                allowed,
            )?;
            self.check_stiffnesses(&state.contact, &fields.nodes)?;
        }
        Ok(())
    }

    /// Stiffnesses by the rates of dense equations.
    fn check_stiffnesses(
        &mut self,
        contact: &ContactState,
        nodes: &DMatrix<NodeState>,
    ) -> Result<(), Violation> {
        let Some([(pressures, off), (gaps, gaps_off)]) = self.exact.rates(nodes) else {
            return Ok(());
        };
        let (area, count) = (self.path.grid().cell_area(), nodes.len() as f64);
        match contact.contact_stiffness {
            Some(found) => {
                let allowed = RATE * area * off;
                self.tally.close("contact stiffness", found, area * pressures, allowed)?;
            }
            None => ensure!(self.gauge != 0.0, "there is no contact stiffness"),
        }
        let Some(found) = contact.interfacial_stiffness else {
            return Err(Violation::new("there is no interfacial stiffness"));
        };
        if contact.contact_nodes == nodes.len() {
            ensure!(
                found == f64::INFINITY,
                "in full contact the interfacial stiffness is {found:e}"
            );
            return Ok(());
        }
        // Times what closes, which may be next to nothing.
        let closing = -gaps / count;
        let allowed = RATE * (area * off + found.abs() * gaps_off / count);
        self.tally.close("interfacial stiffness", found * closing, area * pressures, allowed)
    }

    /// Whether all equilibria can be tried, of which some are extreme.
    fn is_tried(&self, fields: &AdhesiveFields) -> bool {
        fields.gap.len() <= TRIED && self.exact.is_cooperative()
    }

    /// The gaps of all equilibria at the approach of a state, less those of the state.
    fn beyond(&self, fields: &AdhesiveFields) -> (f64, Vec<DVector<f64>>) {
        let kinds = if self.path.law().flat_range() > 0.0 { 4 } else { 3 };
        let approach = self.exact.approach(fields);
        let found = DVector::from_column_slice(fields.gap.as_slice());
        let all = self.exact.all(kinds, approach);
        (approach, all.into_iter().map(|gap| gap - &found).collect())
    }

    /// Whether a state is the only equilibrium at its approach.
    fn is_alone(&self, fields: &AdhesiveFields) -> bool {
        let allowed = self.slack * self.length();
        self.is_tried(fields)
            && self.beyond(fields).1.into_iter().all(|beyond| beyond.amax() <= allowed)
    }

    /// A state beside all equilibria at its approach, of which it is an extreme one.
    fn compare(&mut self, fields: &AdhesiveFields, extreme: Extreme) -> Result<(), Violation> {
        let sign = match extreme {
            Extreme::Greatest => 1.0,
            Extreme::Least => -1.0,
            Extreme::Neither => return Ok(()),
        };
        let allowed = self.slack * self.length();
        let (approach, all) = self.beyond(fields);
        for beyond in all {
            let most = (sign * beyond).max();
            ensure!(
                most <= allowed,
                "there is an equilibrium whose gaps are {most:e} beyond those of the branch, at {approach:e}"
            );
        }
        self.tally.checked += 1;
        Ok(())
    }
}

/// Which of all equilibria at an approach a state is.
#[derive(Clone, Copy)]
enum Extreme {
    Greatest,
    Least,
    Neither,
}
