//! A metal to full yielding without a factor, beside the same path with one: order of events, errors, time and memory.
//!
//! ```text
//! cargo run --release -p asperity-studies --bin yielding_without_factor -- --nodes 512
//! ```
//!
//! Both paths go side by side, one event at a time, so that what has been compared is told while they are under way.

use std::collections::HashMap;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use asperity::loading::LoadingTimings;
use asperity::updater::{ConjugateGradient, LinearUpdater, RecursiveCholesky};
use asperity::{
    Boussinesq, ContactEvent, Error, Grid, LoadingSolver, LoadingState, SelfAffine,
    plane_strain_modulus,
};
use asperity_cli::outcome::Failure;
use asperity_studies::peak_memory::peak_memory;
use clap::Parser;

/// Events closer than this, relative to the approach, are ties, which come in the order of their nodes.
const TIE: f64 = 1e-9;

/// Follows a metal without a factor, and compares with the path of a factor.
#[derive(Debug, Parser)]
#[command(name = "yielding_without_factor")]
struct Options {
    /// Nodes along each side
    #[arg(long, default_value_t = 512)]
    nodes: usize,

    /// Hardness, Pa
    #[arg(long, default_value_t = 2.5e9)]
    hardness: f64,

    /// Seed of the surface
    #[arg(long, default_value_t = 1)]
    seed: u64,

    /// Ends after so many events; all have yielded otherwise
    #[arg(long, default_value_t = usize::MAX)]
    events: usize,

    /// Only the path without a factor
    #[arg(long)]
    alone: bool,

    /// Says how far it is after so many events
    #[arg(long, default_value_t = 16_384)]
    every: usize,
}

fn main() -> ExitCode {
    match run(&Options::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            Failure::new("cannot follow a path", error).report();
            ExitCode::FAILURE
        }
    }
}

/// A path, and the time that it took so far.
struct Timed<U> {
    path: LoadingSolver<U>,
    time: Duration,
    most_elastic: usize,
    most_bytes: usize,
}

impl<U: LinearUpdater> Timed<U> {
    fn next(&mut self) -> Result<Option<LoadingState>, Error> {
        let start = Instant::now();
        let state = self.path.next().transpose();
        self.time += start.elapsed();
        let state = state?;
        if let Some(LoadingState { contact, .. }) = state {
            let yielded = contact.plastic.unwrap_or_default().yielded_nodes;
            self.most_elastic = self.most_elastic.max(contact.contact_nodes - yielded);
            self.most_bytes = self.most_bytes.max(self.path.bytes());
        }
        Ok(state)
    }

    fn told(&self, name: &str) -> String {
        let LoadingTimings { windows, taken_back, ties, .. } = self.path.timings();
        let (seconds, bytes) = (self.time.as_secs_f64(), self.most_bytes as f64 / 1e6);
        format!(
            "{name}: {seconds:.0} s, {bytes:.0} MB, {windows} windows, {taken_back} taken back, {ties} near ties, at most {} elastic \
             nodes, end {:?}",
            self.most_elastic,
            self.path.end()
        )
    }
}

type Event = (bool, (usize, usize));

/// What has been compared so far.
#[derive(Default)]
struct Compared {
    /// Approaches of events that only one of the paths has come to.
    found: HashMap<Event, (f64, f64)>,
    exact: HashMap<Event, f64>,
    places: usize,
    ties: usize,
    beyond: usize,
    worst_error: f64,
    worst_load: f64,
    exceeded: usize,
    worst_ratio: f64,
}

impl Compared {
    fn compare(&mut self, found: &LoadingState, exact: &LoadingState) {
        let event = |state: &LoadingState| (state.event == ContactEvent::Yield, state.node);
        let approach = |state: &LoadingState| state.contact.approach;
        if event(found) == event(exact) {
            self.error(approach(found), found.approach_error, approach(exact));
            let loads = [found, exact].map(|state| state.contact.load);
            if loads[1] > 0.0 {
                self.worst_load = self.worst_load.max((loads[0] / loads[1] - 1.0).abs());
            }
            return;
        }
        self.places += 1;
        self.found.insert(event(found), (approach(found), found.approach_error));
        self.exact.insert(event(exact), approach(exact));
        for event in [event(found), event(exact)] {
            if let Some(&(at, error)) = self.found.get(&event)
                && let Some(&expected) = self.exact.get(&event)
            {
                self.found.remove(&event);
                self.exact.remove(&event);
                self.error(at, error, expected);
                // Whether it was a tie: the approach of the event in whose place it came.
                let other = if event == (found.event == ContactEvent::Yield, found.node) {
                    approach(exact)
                } else {
                    approach(found)
                };
                if (other - expected).abs() <= TIE * expected {
                    self.ties += 1;
                } else {
                    self.beyond += 1;
                }
            }
        }
    }

    fn error(&mut self, found: f64, estimate: f64, exact: f64) {
        let error = (found - exact).abs();
        if exact > 0.0 {
            self.worst_error = self.worst_error.max(error / exact);
        }
        let allowed = estimate + TIE * exact;
        self.exceeded += usize::from(error > allowed);
        if allowed > 0.0 {
            self.worst_ratio = self.worst_ratio.max(error / allowed);
        }
    }

    fn told(&self) -> String {
        let Self { places, ties, beyond, worst_error, worst_load, exceeded, .. } = self;
        format!(
            "{places} places differ ({ties} events in ties, {beyond} not; {} not met again yet); approaches off by {worst_error:.1e}, loads by \
             {worst_load:.1e} at worst; {exceeded} approaches off by more than their estimate, by a factor of {:.2} at worst",
            self.found.len(),
            self.worst_ratio
        )
    }
}

fn run(options: &Options) -> Result<(), Error> {
    let grid = Grid::square(options.nodes, 1e-2)?;
    let half_space = Boussinesq::new(grid, plane_strain_modulus(210e9, 0.3)?)?;
    let paper = SelfAffine::zhang2020(1);
    let (rolloff, shortest) = (paper.rolloff_wavelength(), 8.0 * grid.dx());
    let surface =
        SelfAffine::new(paper.hurst(), rolloff, shortest, paper.amplitude(), options.seed)?;
    let builder = || LoadingSolver::builder(&surface, &half_space).hardness(options.hardness);
    let path = builder().updater(ConjugateGradient::new()).build()?;
    let mut iterated = Timed { path, time: Duration::ZERO, most_elastic: 0, most_bytes: 0 };
    let path = builder().updater(RecursiveCholesky::new()).build()?;
    let mut exact = Timed { path, time: Duration::ZERO, most_elastic: 0, most_bytes: 0 };
    let mut compared = Compared::default();
    let mut count = 0;
    let tell = |count: usize, iterated: &Timed<_>, exact: &Timed<_>, compared: &Compared| {
        println!("{count} events of {}", 2 * grid.nodes());
        println!("  {}", iterated.told("without a factor"));
        if !options.alone {
            println!("  {}\n  {}", exact.told("with a factor"), compared.told());
        }
        if let Some(bytes) = peak_memory() {
            println!("  peak of the process: {:.0} MB", bytes / 1e6);
        }
    };
    while count < options.events {
        let Some(found) = iterated.next()? else {
            break;
        };
        count += 1;
        if !options.alone {
            match exact.next()? {
                Some(exact) => compared.compare(&found, &exact),
                None => println!("the path with a factor has ended before event {count}"),
            }
        }
        if count.is_multiple_of(options.every) {
            tell(count, &iterated, &exact, &compared);
        }
    }
    tell(count, &iterated, &exact, &compared);
    Ok(())
}
