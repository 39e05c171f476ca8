//! `asperity load`: the contact of a measured surface under given loads.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use asperity::fixed_load::FixedLoadSolution;
use asperity::io::write_npy;
use asperity::{Doubt, FixedLoadSolver, Grid, InfluenceKernel};
use asperity_cli::half_space::{Periodic, half_space};
use asperity_cli::number::quantity;
use asperity_cli::outcome::{self, Failure, Outcome};
use asperity_cli::{panel, say};
use clap::Args;

use crate::contact_map::draw as draw_map;
use crate::elasticity::Elasticity;
use crate::reading::Reading;
use crate::resolution::Resolution;
use crate::values::{bytes, positive};

/// The contact of a measured surface under given loads or mean pressures, each solved by itself
///
/// Prints one line for each on stdout, for programs, and what people want to know on stderr. Writes load.csv and
/// contact_map_K.png, K counting from 0. The model is that of `asperity path`: elastic, without friction and
/// adhesion, small slopes. Memory grows with the grid and not with the contact.
#[derive(Debug, Args)]
pub(crate) struct Options {
    /// Heights, positive towards the half-space, in a file of an instrument (.npy, .gsf, .gwy, .sdf, .x3p, .sur, .al3d, .vk4, text):
    /// rows of an image are y; an array of NumPy is [ix, iy]
    #[arg(long, value_name = "FILE")]
    surface: PathBuf,

    #[command(flatten)]
    reading: Reading,

    #[command(flatten)]
    elasticity: Elasticity,

    #[command(flatten)]
    loads: Loads,

    /// Repeat surface and half-space with the nominal area, with this kernel [default: a free
    /// half-space, which goes on without pressure]; approaches are then those of the mean planes, and
    /// there is no contact stiffness but the interfacial one
    #[arg(long, value_enum)]
    periodic: Option<Periodic>,

    /// Greatest error of gaps relative to the approach
    #[arg(
        long,
        value_name = "T",
        allow_negative_numbers = true,
        default_value_t = 1e-8
    )]
    tolerance: f64,

    /// Bytes that may be held at most, 2e9 say [default: three quarters of the memory]
    #[arg(long, value_name = "BYTES", value_parser = bytes)]
    memory_budget: Option<usize>,

    /// Directory for pressure_K.npy and gap_K.npy, K counting the loads from 0
    #[arg(long, value_name = "DIR")]
    save: Option<PathBuf>,

    /// Directory for load.csv and the pictures, made if it is not there
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
}

/// At least one.
#[derive(Debug, Args)]
#[group(required = true, multiple = true)]
struct Loads {
    /// Load; may be given several times
    #[arg(long, value_name = "NEWTONS", allow_negative_numbers = true)]
    load: Vec<f64>,

    /// Load over nominal area; may be given several times, and comes after the loads
    #[arg(long, value_name = "PA", allow_negative_numbers = true, value_parser = positive)]
    mean_pressure: Vec<f64>,
}

impl Loads {
    /// All of them \[N\], on a nominal area.
    fn on(&self, nominal_area: f64) -> Vec<f64> {
        let pressures = self.mean_pressure.iter();
        let given = self.load.iter().copied();
        given
            .chain(pressures.map(|pressure| pressure * nominal_area))
            .collect()
    }
}

/// Solves for each load in turn.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let bodies = options.elasticity.required()?;
    let surface = options.reading.surface(&options.surface)?;
    eprintln!("bodies     {bodies}");
    let doubts = Doubt::of_surface(&surface).into_iter();
    for doubt in doubts.chain(Doubt::of_modulus(bodies.e_star)) {
        eprintln!("warning: {doubt}");
    }
    let grid = *surface.grid();
    let (nx, ny) = grid.shape();
    let start = Instant::now();
    let cannot_begin = |error| Failure::new("no solution can begin", error);
    let half_space = half_space(options.periodic, grid, bodies.e_star).map_err(cannot_begin)?;
    let mut builder = FixedLoadSolver::builder(&surface, &half_space)
        .tolerance(options.tolerance)
        .stiffness(false);
    if let Some(budget) = options.memory_budget {
        builder = builder.memory_budget(budget);
    }
    let mut solver = builder.build().map_err(cannot_begin)?;
    eprintln!(
        "{nx} x {ny} nodes, set up in {:.3} s, {} MB",
        start.elapsed().as_secs_f64(),
        solver.bytes() / 1_000_000
    );
    panel::register_font()?;
    for directory in options.save.iter().chain([&options.out]) {
        std::fs::create_dir_all(directory)
            .map_err(|error| Failure::new(format!("cannot make {}", directory.display()), error))?;
    }
    let loads = options.loads.on(grid.nominal_area());
    let mut outcome = Outcome::default();
    let mut table = format!("{}\n", COLUMNS.join(","));
    for (k, &load) in loads.iter().enumerate() {
        eprintln!(
            "load {} of {}: {}",
            k + 1,
            loads.len(),
            quantity(load, "N", 6)
        );
        let solved = solve(&mut solver, load).and_then(|(solution, effort)| {
            let resolution = Resolution::of(&solution.contact_map, &grid, half_space.boundary());
            let resolution = resolution.map_err(|error| Failure::new("no patches", error))?;
            let numbers = numbers(&solution, &resolution, &grid);
            // Writing to a text cannot fail.
            let _ = writeln!(table, "{}", numbers.join(","));
            print_line(&numbers, &solution, effort.0);
            print_words(&solution, &resolution, bodies.e_star, effort.1);
            Ok(solution)
        });
        match solved {
            Ok(solution) => {
                let picture = options.out.join(format!("contact_map_{k}.png"));
                let FixedLoadSolution {
                    state,
                    pressure,
                    contact_map,
                    ..
                } = &solution;
                outcome.written(draw_map(&grid, state, pressure, contact_map, &picture));
                if let Some(directory) = &options.save {
                    outcome.all_written(save(directory, &solution, k));
                }
            }
            // What was found before is not lost.
            Err(failure) => outcome.note(Err(failure)),
        }
    }
    if table.lines().count() > 1 {
        outcome.written(outcome::write(&options.out.join("load.csv"), table));
    }
    outcome.finish_on_stderr()
}

/// A solution with its stiffnesses, and the seconds that it and they took.
fn solve(
    solver: &mut FixedLoadSolver,
    load: f64,
) -> Result<(FixedLoadSolution, (f64, f64)), Failure> {
    let failed = |error| {
        Failure::new(
            format!("no contact under {}", quantity(load, "N", 6)),
            error,
        )
    };
    let start = Instant::now();
    let mut solution = solver.solve(load).map_err(failed)?;
    let seconds = start.elapsed().as_secs_f64();
    solver.add_stiffness(&mut solution).map_err(failed)?;
    let seconds_more = start.elapsed().as_secs_f64() - seconds;
    Ok((solution, (seconds, seconds_more)))
}

/// The columns of load.csv, in SI units.
const COLUMNS: [&str; 11] = [
    "load",
    "contact_nodes",
    "max_pressure",
    "mean_gap",
    "approach",
    "contact_stiffness",
    "interfacial_stiffness",
    "mean_pressure",
    "contact_area",
    "contact_area_fraction",
    "corrected_contact_area",
];

/// The numbers of those columns; nothing where there is none.
fn numbers(solution: &FixedLoadSolution, resolution: &Resolution, grid: &Grid) -> [String; 11] {
    let state = solution.state;
    let exact = |value: f64| format!("{value:e}");
    let optional = |value: Option<f64>| value.map_or_else(String::new, exact);
    [
        exact(state.load),
        state.contact_nodes.to_string(),
        exact(solution.max_pressure()),
        exact(state.mean_gap),
        exact(state.approach),
        optional(state.contact_stiffness),
        optional(state.interfacial_stiffness),
        exact(state.load / grid.nominal_area()),
        exact(state.contact_area),
        exact(state.contact_area_fraction),
        exact(resolution.corrected_area),
    ]
}

/// The line for programs.
fn print_line(numbers: &[String; 11], solution: &FixedLoadSolution, seconds: f64) {
    let named = COLUMNS.iter().zip(numbers);
    let named: Vec<String> = named
        .map(|(name, number)| format!("{name}={number}"))
        .collect();
    say!(
        "{} iterations={} seconds={seconds:.6}",
        named.join(" "),
        solution.effort.iterations,
    );
}

/// The lines for people.
fn print_words(
    solution: &FixedLoadSolution,
    resolution: &Resolution,
    e_star: f64,
    seconds_more: f64,
) {
    let state = solution.state;
    let greatest = solution.max_pressure();
    eprintln!(
        "  contact {:.4} % of the nominal area, {resolution}",
        100.0 * state.contact_area_fraction
    );
    eprintln!(
        "  mean pressure {}, greatest pressure {}, mean gap {}, approach {}",
        quantity(state.mean_pressure(), "Pa", 4),
        quantity(greatest, "Pa", 4),
        quantity(state.mean_gap, "m", 4),
        quantity(state.approach, "m", 4)
    );
    for (name, stiffness) in [
        ("contact stiffness", state.contact_stiffness),
        ("interfacial stiffness", state.interfacial_stiffness),
    ] {
        if let Some(stiffness) = stiffness.filter(|stiffness| stiffness.is_finite()) {
            eprintln!("  {name} {}", quantity(stiffness, "N/m", 4));
        }
    }
    let gap = |relative: f64| quantity(relative * solution.certificate.length, "m", 2);
    let least = solution.certificate.least_gap;
    eprintln!(
        "  left of the equations: gap in contact {}{}",
        gap(solution.certificate.greatest_contact_gap),
        // There is none in full contact.
        match least.is_finite() {
            true => format!(", least gap outside {}", gap(least)),
            false => String::new(),
        }
    );
    eprintln!(
        "  {} convolutions and {:.1} on coarser grids, {seconds_more:.3} s more for the stiffness",
        solution.effort.convolutions, solution.effort.coarse_convolutions,
    );
    let high = Doubt::of_pressure(greatest, e_star);
    for doubt in resolution.doubt().into_iter().chain(high) {
        eprintln!("warning: {doubt}");
    }
    if state.contact_area_fraction == 1.0 {
        eprintln!("note: the contact is full; above full contact nothing but the pressure changes");
    }
}

/// Writes the fields of the K-th load.
fn save(directory: &Path, solution: &FixedLoadSolution, k: usize) -> Result<Vec<PathBuf>, Failure> {
    let fields = [("pressure", &solution.pressure), ("gap", &solution.gap)];
    let written = fields.map(|(name, field)| {
        let file = directory.join(format!("{name}_{k}.npy"));
        match write_npy(&file, field) {
            Ok(()) => Ok(file),
            Err(error) => Err(Failure::writing(&file, error)),
        }
    });
    written.into_iter().collect()
}
