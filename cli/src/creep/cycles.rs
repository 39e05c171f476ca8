//! `creep_cycles.csv` and `creep_cycles.png`: loops, and the energy lost in cycles of load against their frequency.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use asperity::Error;
use asperity::bed::Bed;
use asperity::creep::{Cycle, CycleSettings, ViscoelasticBed};
use asperity::loading::History;
use asperity::record::LoadingRecord;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLUE, Chart, Corner, GREEN, ORANGE, Series, Style};
use asperity_cli::number::quantity;
use asperity_cli::outcome::{self, Failure};

use super::course::{Cycles, Task};

/// Frequencies a decade.
const A_DECADE: f64 = 5.0;
/// From the slowest to the fastest phase of the series, and beyond both by this factor.
const BEYOND: f64 = 20.0;
/// At most so many increments of the path: a curve needs no more.
const INCREMENTS: usize = 1500;
/// Fewer increments that join and leave in a cycle are too few for its loss.
const LEAST_INCREMENTS: usize = 50;

/// Steady cycles of one amplitude at some frequencies.
pub(super) struct Sweep {
    /// From the lowest frequency on.
    pub(super) cycles: Vec<Cycle>,
    /// Nodes between the contact of the mean load less the amplitude and of both together, after long creep.
    pub(super) moving_nodes: usize,
}

impl Sweep {
    /// Runs them on a path of fewer states, which are states of the path nevertheless.
    pub(super) fn new(record: &LoadingRecord, task: &Task, cycles: &Cycles) -> Result<Self, Error> {
        let creep = task.prony.creep_at(f64::INFINITY);
        let greatest = creep * (cycles.mean + cycles.amplitude);
        let whole = Bed::of_record(record)?;
        // A path that is not enough says so before any cycle; bodies that flow are refused by the bed.
        let ends = if greatest.is_finite() {
            let low = whole.at_load(creep * (cycles.mean - cycles.amplitude))?.contact_nodes;
            (low, whole.at_load(greatest)?.contact_nodes)
        } else {
            (0, 0)
        };
        let thinned = thinned(record.history(), greatest);
        let bed = Bed::new(&thinned)?;
        let mut contact = ViscoelasticBed::new(&bed, &task.prony)?;
        contact.settle(cycles.mean)?;
        let settings = CycleSettings { steps: 64, tolerance: 1e-4, most: 10_000 };
        let mut found = Vec::new();
        for frequency in frequencies(task) {
            let period = 1.0 / frequency;
            found.push(contact.cycle(cycles.mean, cycles.amplitude, period, settings)?);
        }
        found.reverse();
        Ok(Self { cycles: found, moving_nodes: ends.1 - ends.0 })
    }

    /// The cycle that loses most.
    pub(super) fn worst(&self) -> Option<&Cycle> {
        self.cycles.iter().max_by(|a, b| a.dissipation.total_cmp(&b.dissipation))
    }

    /// Whether so few nodes join and leave in a cycle that the loss depends on the grid.
    pub(super) fn is_coarse(&self) -> bool {
        self.moving_nodes < LEAST_INCREMENTS
    }

    pub(super) fn write(&self, name: &Path) -> Result<PathBuf, Failure> {
        let mut text = String::from(
            "frequency,amplitude,approach_amplitude,dissipation,stiffness,loss_factor,cycles,distance\n",
        );
        for cycle in &self.cycles {
            // Writing to a text cannot fail.
            let _ = writeln!(
                text,
                "{:e},{:e},{:e},{:e},{:e},{:e},{},{:e}",
                1.0 / cycle.period,
                cycle.amplitude,
                cycle.approach_amplitude,
                cycle.dissipation,
                cycle.stiffness,
                cycle.loss_factor,
                cycle.cycles,
                cycle.distance
            );
        }
        outcome::write(name, text)
    }

    pub(super) fn draw(&self, name: &Path) -> Result<PathBuf, Failure> {
        let (Some(slow), Some(fast), Some(worst)) =
            (self.cycles.first(), self.cycles.last(), self.worst())
        else {
            return Err(Failure::request("there is no cycle to draw"));
        };
        // Each about its own middle, so that loops can be compared.
        let around = |cycle: &Cycle| {
            let approaches = cycle.path.iter().map(|point| point.0);
            let (low, high) = approaches
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
            0.5 * (low + high)
        };
        let middle = |cycle: &Cycle| {
            let centre = around(cycle);
            cycle.path.iter().map(move |(x, load)| (x - centre, *load)).collect::<Vec<_>>()
        };
        let widest = self.cycles.iter().map(|cycle| cycle.approach_amplitude).fold(0.0, f64::max);
        let named = |cycle: &Cycle| quantity(1.0 / cycle.period, "Hz", 2);
        let loops = [(slow, GREEN), (worst, ORANGE), (fast, BLUE)]
            .map(|(cycle, colour)| Series::new(named(cycle), colour, Style::Line, middle(cycle)));
        let (lowest, highest) =
            (worst.mean_load - worst.amplitude, worst.mean_load + worst.amplitude);
        let frequency = |cycle: &Cycle| 1.0 / cycle.period;
        let lost = self.cycles.iter().map(|cycle| (frequency(cycle), cycle.dissipation));
        let charts = [
            Chart {
                title: "cycles of load".to_string(),
                x: Axis::linear("approach from its middle", "m", -widest, widest)
                    .with_room(0.05, 0.05),
                y: Axis::linear("load", "N", lowest, highest).with_room(0.05, 0.2),
                series: loops.into(),
                legend: Corner::TopLeft,
            },
            Chart {
                title: format!("energy lost in a cycle of ±{}", quantity(worst.amplitude, "N", 3)),
                x: Axis::logarithmic("frequency", "Hz", frequency(slow), frequency(fast)),
                y: Axis::linear("energy lost in a cycle", "J", 0.0, 1.1 * worst.dissipation),
                series: vec![
                    Series::new("", BLUE, Style::Line, lost.clone()),
                    Series::new("", BLUE, Style::Dots, lost),
                ],
                legend: Corner::TopRight,
            },
        ];
        chart::draw(&charts, 2, name)
    }
}

/// From the highest on: the contact settles at its mean load before, which is what a fast cycle sees.
fn frequencies(task: &Task) -> Vec<f64> {
    let terms = (task.prony.relaxation_terms(), task.prony.creep_terms());
    let (Some(fastest), Some(slowest)) = (terms.0.first(), terms.1.last()) else {
        return Vec::new();
    };
    let high = BEYOND / (std::f64::consts::TAU * fastest.time);
    let low = 1.0 / (BEYOND * std::f64::consts::TAU * slowest.time);
    let count = ((high / low).log10() * A_DECADE).ceil().max(1.0);
    (0..=count as usize).map(|k| high * (low / high).powf(k as f64 / count)).collect()
}

/// The states up to a load, or a part of them if they are many.
fn thinned(history: &History, greatest: f64) -> History {
    let events = history.states();
    let within = events.partition_point(|state| state.contact.load <= greatest) + 1;
    let states = &events[..within.min(events.len())];
    let every = states.len().div_ceil(INCREMENTS).max(1);
    let last = states.len().saturating_sub(1);
    let kept = states.iter().enumerate().filter(|(k, _)| k % every == 0 || *k == last);
    kept.map(|(_, state)| *state).collect()
}
