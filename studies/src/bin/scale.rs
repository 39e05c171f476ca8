//! Long paths: how time and memory grow with the number of contact nodes.
//!
//! A self-affine surface, roll-off at a quarter of the side and short cut-off at four cells, up to a
//! given number of nodes in contact. With `--picture` it draws time and memory of the default, of the factor alone and
//! of iterations alone.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use asperity::surface::{Amplitude, SelfAffine};
use asperity::updater::{
    CholeskyTimings, ConjugateGradient, Handover, LinearUpdater, RecursiveCholesky,
};
use asperity::{Boussinesq, Grid, LoadingSolver};
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLACK, BLUE, Chart, Corner, ORANGE, Series, Style};
use asperity_cli::outcome::Failure;
use asperity_cli::panel;
use asperity_studies::peak_memory::peak_memory;
use asperity_studies::phases;
use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};

/// Side of the surface.
const SIDE: f64 = 1e-2;
/// States between two points of a curve.
const STRIDE: u32 = 64;
/// Nodes in contact at the first point.
const FEWEST: u32 = 256;

/// Times long paths.
#[derive(Parser)]
struct Options {
    /// Nodes a side of the grid.
    #[arg(long, default_value_t = 256)]
    nodes: usize,
    /// Contact nodes at which the path ends.
    #[arg(long, default_value_t = 9830)]
    contact_nodes: usize,
    /// The factor up to a memory budget of so many MB, conjugate gradients after.
    #[arg(long)]
    budget: Option<usize>,
    /// Nodes to watch at a time.
    #[arg(long)]
    window: Option<usize>,
    /// Seed of the surface.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Draws time and memory against the number of nodes in contact into this folder.
    #[arg(long)]
    picture: Option<PathBuf>,
}

impl Options {
    fn surface(&self) -> Result<SelfAffine, asperity::SurfaceError> {
        let (rolloff, cutoff) = (SIDE / 4.0, 4.0 * SIDE / self.nodes as f64);
        SelfAffine::new(0.8, rolloff, cutoff, Amplitude::RmsHeight(50e-6), self.seed)
    }

    fn kernel(&self) -> Result<Boussinesq, asperity::Error> {
        Boussinesq::new(Grid::square(self.nodes, SIDE)?, 1.0)
    }
}

fn run<U: LinearUpdater>(
    options: &Options,
    updater: U,
    timings: Option<fn(&U) -> CholeskyTimings>,
) -> Result<(), Box<dyn Error>> {
    let (surface, kernel) = (options.surface()?, options.kernel()?);
    let style = ProgressStyle::with_template("{wide_bar} {pos}/{len} nodes {elapsed}");
    let bar = ProgressBar::new(options.contact_nodes as u64)
        .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    let start = Instant::now();
    let mut builder =
        LoadingSolver::builder(&surface, &kernel).updater(updater).max_nodes(options.contact_nodes);
    if let Some(megabytes) = options.budget {
        builder = builder.memory_budget(megabytes * 1_000_000);
    }
    if let Some(size) = options.window {
        builder = builder.window_size(size);
    }
    let mut path = builder.build()?;
    let mut states = 0_u32;
    for state in path.by_ref() {
        state?;
        states += 1;
        if states.is_multiple_of(128) {
            bar.set_position(states.into());
        }
    }
    let seconds = start.elapsed().as_secs_f64();
    bar.finish_and_clear();
    let n = f64::from(states);
    let certificate = path.certificate()?;
    let in_sq = certificate.length / path.problem().rms_height();
    let peak = peak_memory().unwrap_or(f64::NAN);
    println!(
        "{states} nodes ({:.1} %) in {seconds:.2} s: {:.1} GFLOP/s as n^3/3 a second, {} windows, \
         peak memory {:.0} MB = {:.3} x 4n^2",
        100.0 * n / (options.nodes * options.nodes) as f64,
        n.powi(3) / 3.0 / seconds / 1e9,
        path.timings().windows,
        peak / 1e6,
        peak / (4.0 * n * n)
    );
    println!(
        "  least pressure {:.1e} of the mean, least gap {:.1e} Sq, gap in contact {:.1e} Sq",
        certificate.least_pressure,
        certificate.least_gap * in_sq,
        certificate.greatest_contact_gap * in_sq
    );
    if let (Some(timings), Some(updater)) = (timings, path.updater()) {
        phases::print(path.timings(), timings(updater));
    }
    Ok(())
}

/// Nodes in contact, seconds since the beginning, and the most megabytes that the path has held.
type Point = (f64, f64, f64);

fn curve<U: LinearUpdater>(options: &Options, updater: U) -> Result<Vec<Point>, Box<dyn Error>> {
    let (surface, kernel) = (options.surface()?, options.kernel()?);
    let start = Instant::now();
    let builder = LoadingSolver::builder(&surface, &kernel).updater(updater);
    let mut path = builder.max_nodes(options.contact_nodes).build()?;
    let (mut points, mut states, mut most) = (Vec::new(), 0_u32, 0.0_f64);
    while let Some(state) = path.next() {
        state?;
        states += 1;
        if states >= FEWEST && states.is_multiple_of(STRIDE) {
            most = most.max(path.bytes() as f64);
            points.push((f64::from(states), start.elapsed().as_secs_f64(), most / 1e6));
        }
    }
    Ok(points)
}

fn charts(options: &Options) -> Result<[Chart; 2], Box<dyn Error>> {
    let curves = [
        ("factor alone", BLUE, Style::Line, curve(options, RecursiveCholesky::new())?),
        ("iterations alone", ORANGE, Style::Line, curve(options, ConjugateGradient::new())?),
        ("default", BLACK, Style::Dashed, curve(options, Handover::new())?),
    ];
    let (from, to) = (f64::from(FEWEST), options.contact_nodes as f64);
    let series = |value: fn(&Point) -> f64| {
        curves.iter().map(move |(name, colour, style, points)| {
            Series::new(*name, *colour, *style, points.iter().map(|point| (point.0, value(point))))
        })
    };
    let ends = |value: fn(&Point) -> f64| {
        let values = curves.iter().flat_map(|curve| curve.3.iter().map(value));
        values.fold((f64::INFINITY, 0.0_f64), |(least, most), v| (least.min(v), most.max(v)))
    };
    let nodes = || Axis::plain_logarithmic("nodes in contact", from, to);
    let (least, most) = ends(|point| point.1);
    let (fewest, greatest) = ends(|point| point.2);
    Ok([
        Chart {
            title: format!("Time of a path on {0} × {0} nodes", options.nodes),
            x: nodes(),
            y: Axis::logarithmic("time", "s", least, most).with_room(0.05, 0.05),
            series: series(|point| point.1).collect(),
            legend: Corner::TopLeft,
        },
        Chart {
            title: "Memory that it holds".to_string(),
            x: nodes(),
            y: Axis::plain_logarithmic("memory [MB]", fewest, greatest).with_room(0.1, 0.1),
            series: series(|point| point.2).collect(),
            legend: Corner::TopLeft,
        },
    ])
}

fn draw(options: &Options, folder: &Path) -> Result<(), Failure> {
    let charts = charts(options).map_err(|error| Failure::new("cannot follow a path", error))?;
    panel::register_font()?;
    let name = folder.join("performance.png");
    std::fs::create_dir_all(folder).map_err(|error| Failure::writing(folder, error))?;
    println!("{}", chart::draw(&charts, 2, &name)?.display());
    Ok(())
}

fn main() -> ExitCode {
    let options = Options::parse();
    let done = match &options.picture {
        Some(folder) => draw(&options, folder),
        None => time(&options).map_err(|error| Failure::new("cannot follow a path", error)),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.report();
            ExitCode::FAILURE
        }
    }
}

fn time(options: &Options) -> Result<(), Box<dyn Error>> {
    if options.budget.is_some() {
        run(options, Handover::new(), None)
    } else {
        let timings = RecursiveCholesky::timings;
        run(options, RecursiveCholesky::new(), Some(timings))
    }
}
