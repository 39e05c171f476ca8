//! What a path will take, for `--dry-run`, and what its events cost.

use std::fmt;
use std::time::Instant;

use asperity::loading::{default_budget, factor_seconds, greatest_factor, iteration_seconds};
use asperity::reference::AreaLoadLaw;
use asperity::{ContactGrowth, ContactTarget, FixedLoadSolver, InfluenceKernel};
use asperity_cli::number::{counted, quantity};
use asperity_cli::outcome::Failure;
use asperity_cli::units;
use serde_json::{Value, json};

use super::job::Job;
use super::progress::total;
use super::updater::Updater;

// Measured on 32 to 512 nodes a side, elastic and yielding, free and periodic, with each updater.

/// Memory of the program itself, for each node of the grid with a factor and without one, and for each node in contact
/// without one \[bytes\].
const PROGRAM: f64 = 28e6;
const NODE: [f64; 2] = [350.0, 750.0];
const CONTACT_NODE: f64 = 1000.0;
/// Of a factor of n nodes, per n² \[bytes\].
const FACTOR: f64 = 4.0;
/// Seconds of an event besides its linear algebra, and per node of the grid, its share of convolutions: elastic, and
/// with a hardness, which makes windows shorter.
const EVENT: f64 = 1e-5;
const EVENT_NODE: [f64; 2] = [3e-10, 1e-9];
/// Elastic events without a factor, over what the hand-over takes them to cost: on one thread 0.5 to 3.8 was measured,
/// on 32² to 128² nodes from 5 to 100 % of contact.
const ITERATED: f64 = 1.6;
/// With a hardness linear algebra takes longer the more nodes yield with a factor, and the fewer of them without one: a
/// number, and what comes to it per share of the nodes that have yielded and per share of those that have not.
const YIELDING_FACTOR: [f64; 2] = [1.0, 8.0];
const YIELDING_ITERATIONS: [f64; 2] = [0.5, 2.0];
/// Seconds of an event where nodes may leave, a number and per n² of a factor of n nodes; without one a number and per
/// node of the grid. 128² and 256² nodes, stiff coats with a factor: 0.6 to 0.7 of it were measured where hardly a node
/// leaves, and 2.3 with 15 % of releases.
const STEP_FACTOR: [f64; 2] = [8e-4, 2.5e-11];
const STEP_ITERATIONS: [f64; 2] = [1.7e-3, 5e-8];
/// Seconds for tables and pictures, and per node of the grid with a factor and without one.
const OUTPUT: f64 = 0.02;
const OUTPUT_NODE: [f64; 2] = [5e-7, 4e-6];
/// How exactly the end of the path is solved for.
const TOLERANCE: f64 = 1e-4;

impl Updater {
    /// Seconds that the linear algebra of an event takes with so many elastic nodes in contact on a grid of `nodes`, on
    /// two cores.
    pub(super) fn event_seconds(self, nodes: usize, elastic: usize) -> f64 {
        match self.has_factor(nodes, elastic, nodes) {
            true => factor_seconds(elastic),
            false => iteration_seconds(nodes, elastic),
        }
    }

    /// Whether there is a factor with so many elastic nodes on the way to `end` of them.
    fn has_factor(self, nodes: usize, elastic: usize, end: usize) -> bool {
        match self {
            Self::Cholesky => true,
            Self::Iterative => false,
            Self::Auto => elastic <= greatest_factor(nodes, end),
        }
    }
}

/// What a path to an end costs, if the same share of its nodes is elastic all the way.
struct Work {
    nodes: usize,
    end: End,
    /// Of the nodes in contact.
    elastic: f64,
    updater: Updater,
    /// Whether nodes may leave the contact.
    may_leave: bool,
    /// Nodes of a factor for which there is room.
    room: f64,
}

impl Work {
    fn new(job: &Job, end: End, growth: ContactGrowth) -> Self {
        let nodes = job.grid().nodes();
        let budget = job.memory_budget().unwrap_or_else(default_budget) as f64;
        let room = (budget - PROGRAM - NODE[0] * nodes as f64).max(0.0);
        Self {
            nodes,
            end,
            elastic: 1.0 - end.yielded / end.contact.max(1.0),
            updater: job.updater(),
            may_leave: growth == ContactGrowth::Unknown,
            room: (room / FACTOR).sqrt(),
        }
    }

    fn grid(&self) -> f64 {
        self.nodes as f64
    }

    fn elastic_of(&self, contact: usize) -> usize {
        (self.elastic * contact as f64) as usize
    }

    fn has_factor(&self, contact: usize) -> bool {
        let elastic = self.elastic_of(contact);
        let fits = matches!(self.updater, Updater::Cholesky) || elastic as f64 <= self.room;
        fits && self.updater.has_factor(
            self.nodes,
            elastic,
            self.elastic_of(self.end.contact as usize),
        )
    }

    fn has_factor_at_end(&self) -> bool {
        self.has_factor(self.end.contact as usize)
    }

    /// Seconds of an event with so many nodes in contact.
    fn event(&self, contact: usize) -> f64 {
        let elastic = self.elastic_of(contact);
        if self.may_leave {
            let ([fixed, slope], size) = match self.has_factor(contact) {
                true => (STEP_FACTOR, (elastic as f64).powi(2)),
                false => (STEP_ITERATIONS, self.grid()),
            };
            return fixed + slope * size;
        }
        let yields = self.end.yielded > 0.0;
        let yielding = |[fixed, share]: [f64; 2], part: f64| fixed + share * part;
        let (algebra, slower) = match (self.has_factor(contact), yields) {
            (true, false) => (factor_seconds(elastic), 1.0),
            (true, true) => {
                (factor_seconds(elastic), yielding(YIELDING_FACTOR, 1.0 - self.elastic))
            }
            (false, false) => (iteration_seconds(self.nodes, elastic), ITERATED),
            (false, true) => (
                iteration_seconds(self.nodes, elastic),
                yielding(YIELDING_ITERATIONS, self.elastic),
            ),
        };
        EVENT + EVENT_NODE[usize::from(yields)] * self.grid() + slower * algebra
    }

    fn bytes(&self) -> f64 {
        let end = self.elastic_of(self.end.contact as usize);
        let elastic = end as f64;
        let factor = match self.updater {
            Updater::Cholesky => elastic,
            Updater::Iterative => 0.0,
            Updater::Auto => (greatest_factor(self.nodes, end) as f64).min(self.room),
        };
        let rest = match self.has_factor_at_end() {
            true => NODE[0] * self.grid(),
            false => NODE[1] * self.grid() + CONTACT_NODE * elastic,
        };
        PROGRAM + rest + FACTOR * factor * factor
    }
}

/// What one path will take.
pub(super) struct Expected {
    /// In contact at its end.
    contact: f64,
    /// Whether that is without what adhesion adds.
    is_least: bool,
    seconds: f64,
    bytes: f64,
}

/// Nodes at the end of a path.
#[derive(Clone, Copy)]
struct End {
    contact: f64,
    yielded: f64,
}

impl Expected {
    /// Of a path, whose kernel is evaluated and whose end is solved for.
    ///
    /// # Errors
    ///
    /// Those of setting up the path.
    pub(super) fn of(job: &Job, unloads: bool) -> Result<Self, Failure> {
        let start = Instant::now();
        let kernel = job.kernel()?;
        // It refuses what the path would refuse. That of a record does all its work again.
        if job.begun().is_empty() && job.law().is_none() {
            job.solver()?;
        }
        let set_up = start.elapsed().as_secs_f64();
        let end = End::of(job, &*kernel);
        let growth = kernel.contact_growth();
        let work = Work::new(job, end, growth);
        let begun = job.begun().last().map_or(0, |state| state.contact.contact_nodes);
        // Of a record a factor is computed again, and iterations go on where they were.
        let loading = total(end.contact, |contact| match contact < begun {
            true if !work.has_factor(contact) => 0.0,
            _ => work.event(contact),
        });
        let back = Work::new(job, End { yielded: 0.0, ..end }, growth);
        let unloading = total(end.contact, |contact| back.event(contact));
        let output = OUTPUT + OUTPUT_NODE[usize::from(!work.has_factor_at_end())] * work.grid();
        let events = 1.0 + end.yielded / end.contact.max(1.0);
        Ok(Self {
            contact: end.contact,
            is_least: false,
            seconds: set_up + events * loading + if unloads { unloading } else { 0.0 } + output,
            bytes: if unloads { back.bytes().max(work.bytes()) } else { work.bytes() },
        })
    }

    /// The same of what takes so many times as long, and so many times as much memory besides that of the program, with
    /// at least these nodes in contact.
    pub(super) fn scaled(self, slower: f64, larger: f64, is_least: bool) -> Self {
        let bytes = PROGRAM + larger * (self.bytes - PROGRAM).max(0.0);
        Self { seconds: slower * self.seconds, bytes, is_least, ..self }
    }

    /// For programs.
    pub(super) fn object(&self) -> Value {
        json!({ "contact_nodes": self.contact.round(), "seconds": self.seconds, "bytes": self.bytes })
    }
}

impl End {
    /// Of the target that is reached first.
    fn of(job: &Job, kernel: &dyn InfluenceKernel) -> Self {
        let all = Self { contact: job.grid().nodes() as f64, yielded: 0.0 };
        let ends = job.targets().iter().map(|target| Self::at(job, kernel, *target));
        ends.fold(all, |first, end| if end.contact <= first.contact { end } else { first })
    }

    /// Of a target: by a single solution where its number of nodes is not known, and by theory if there is none.
    fn at(job: &Job, kernel: &dyn InfluenceKernel, target: ContactTarget) -> Self {
        let nodes = job.grid().nodes() as f64;
        let theory = Theory::of(job);
        let (solved, area) = match (target, job.hardness_map()) {
            (ContactTarget::AreaFraction(fraction), None) => {
                return Self { contact: fraction * nodes, yielded: 0.0 };
            }
            // Without adhesion nothing touches before 0.
            (ContactTarget::Approach(approach), _) if approach <= 0.0 => {
                return Self { contact: 0.0, yielded: 0.0 };
            }
            // A load is solved for sooner, and its share of yielded nodes is that of the area.
            (ContactTarget::AreaFraction(fraction), Some(_)) => {
                (ContactTarget::Load(theory.load(fraction)), Some(fraction))
            }
            _ => (target, None),
        };
        let mut builder =
            FixedLoadSolver::builder(job.heights(), kernel).tolerance(TOLERANCE).stiffness(false);
        if let Some(hardness) = job.hardness_map() {
            builder = builder.hardness_map(hardness);
        }
        if let Some(budget) = job.memory_budget() {
            builder = builder.memory_budget(budget);
        }
        let solution = builder.build().and_then(|mut solver| solver.solve_target(solved));
        let (contact, yielded) = match solution {
            Ok(solution) => {
                let contact = solution.contact.contact_nodes as f64;
                (
                    contact,
                    solution.contact.plastic.map_or(0.0, |p| p.yielded_nodes as f64 / contact),
                )
            }
            Err(_) => (nodes * theory.area(target), theory.yielded()),
        };
        let contact = area.map_or(contact, |fraction| fraction * nodes);
        Self { contact, yielded: yielded * contact }
    }
}

/// The contact of a randomly rough surface by Persson's theory. Pressures are distributed about as `p exp(−2 p² / (E*
/// h′)²)`, cut off at the hardness.
struct Theory {
    law: Option<AreaLoadLaw>,
    nominal_area: f64,
    /// E* h′ \[Pa\].
    scale: f64,
    hardness: f64,
}

impl Theory {
    fn of(job: &Job) -> Self {
        Self {
            law: AreaLoadLaw::new(job.rms_gradient(), job.e_star()).ok(),
            nominal_area: job.grid().nominal_area(),
            scale: job.e_star() * job.rms_gradient(),
            hardness: job.hardness_map().map_or(f64::INFINITY, |map| map.mean()),
        }
    }

    /// What the hardness leaves of the mean pressure of the contact.
    fn below(&self) -> f64 {
        self.law.as_ref().map_or(1.0, |law| law.persson(self.hardness))
    }

    /// The load of an area, over nominal area; a little less than all that the hardness bears.
    fn load(&self, fraction: f64) -> f64 {
        let pressure = fraction * self.scale * self.below() / AreaLoadLaw::PERSSON;
        pressure.min(0.9 * self.hardness) * self.nominal_area
    }

    /// The contact area at a target, over nominal area.
    fn area(&self, target: ContactTarget) -> f64 {
        match (target, &self.law) {
            (ContactTarget::AreaFraction(fraction), _) => fraction,
            (ContactTarget::Load(load), Some(law)) => {
                law.persson(load / self.nominal_area / self.below())
            }
            // Not more than all.
            _ => 1.0,
        }
    }

    /// The part of the contact that has yielded.
    fn yielded(&self) -> f64 {
        (-2.0 * (self.hardness / self.scale).powi(2)).exp()
    }
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}about {} in contact, {} and {} of memory",
            if self.is_least { "without what adhesion adds, " } else { "" },
            counted(self.contact.round(), "node"),
            units::time_to(self.seconds, 2),
            quantity(self.bytes, "B", 2)
        )
    }
}
