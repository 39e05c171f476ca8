//! `asperity load`: the contact of a measured surface under given loads.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use asperity::fixed_load::FixedLoadSolution;
use asperity::io::write_npy;
use asperity::{FixedLoadSolver, Grid, InfluenceKernel, Warning};
use asperity_cli::half_space::Periodic;
use asperity_cli::number::{counted, quantity};
use asperity_cli::outcome::{self, Failure, Outcome};
use asperity_cli::{answer, note, panel, speech};
use clap::Args;
use serde_json::{Map, Value, json};

use crate::advice;
use crate::contact_map::draw as draw_map;
use crate::elasticity::Elasticity;
use crate::hardness::Hardness;
use crate::reading::Reading;
use crate::resolution::Resolution;
use crate::room;
use crate::values::{bytes, positive};

/// The contact of a measured surface under given loads or mean pressures, each solved by itself
///
/// Prints one line for each load on stdout, for programs, and a description on stderr. Writes load.csv and
/// contact_map_K.png, where K counts the loads from 0. The model is that of `asperity path`: elastic up to the hardness if there is
/// one, without friction and adhesion, with small slopes. Memory is proportional to the grid, whatever the contact.
#[derive(Debug, Args)]
pub(crate) struct Options {
    /// File with heights, positive towards the half-space (`asperity formats` lists what is read): the rows of
    /// an image are y; a NumPy array is [ix, iy]
    #[arg(long, value_name = "FILE")]
    surface: PathBuf,

    #[command(flatten)]
    reading: Reading,

    #[command(flatten)]
    elasticity: Elasticity,

    #[command(flatten)]
    hardness: Hardness,

    #[command(flatten)]
    loads: Loads,

    /// Repeat surface and half-space periodically, with this kernel [default: a free half-space, which carries no
    /// pressure outside the surface]; with love and spectral the approach is then that of the mean planes, and of the two stiffnesses
    /// there is only the interfacial one
    #[arg(long, value_enum)]
    periodic: Option<Periodic>,

    /// Greatest error of the gaps, relative to the approach
    #[arg(long, value_name = "T", allow_negative_numbers = true, default_value_t = 1e-8)]
    tolerance: f64,

    /// Greatest memory in bytes, for example 2e9 [default: three quarters of the memory]
    #[arg(long, value_name = "BYTES", value_parser = bytes)]
    memory_budget: Option<usize>,

    /// Print one JSON object instead: states, one for each load that was solved for, with the columns of load.csv, iterations and
    /// seconds (SI units; null where there is no number)
    #[arg(long)]
    json: bool,

    /// Directory for pressure_K.npy and gap_K.npy, where K counts the loads from 0
    #[arg(long, value_name = "DIR")]
    save: Option<PathBuf>,

    /// Directory for load.csv and the pictures, created if it does not exist
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

    /// Load over nominal area; may be given several times, and is solved after the loads
    #[arg(long, value_name = "PA", allow_negative_numbers = true, value_parser = positive)]
    mean_pressure: Vec<f64>,
}

impl Loads {
    /// All of them \[N\], on a nominal area.
    fn on(&self, nominal_area: f64) -> Vec<f64> {
        let pressures = self.mean_pressure.iter();
        let given = self.load.iter().copied();
        given.chain(pressures.map(|pressure| pressure * nominal_area)).collect()
    }
}

/// Solves for each load in turn.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    if options.json {
        speech::be_quiet();
    }
    let bodies = options.elasticity.required()?;
    let surface = options.reading.surface(&options.surface)?;
    let hardness = options.hardness.of(&bodies)?;
    note!("bodies     {bodies}");
    if let Some(hardness) = hardness {
        note!("hardness   {hardness}");
    }
    let warnings = Warning::of_surface(&surface).into_iter();
    for warning in warnings.chain(bodies.warnings(surface.grid())) {
        eprintln!("warning: {}", advice::told(&warning));
    }
    let grid = *surface.grid();
    let (nx, ny) = grid.shape();
    let start = Instant::now();
    let half_space = bodies
        .kernel(options.periodic, grid)
        .map_err(|error| Failure::new("cannot make the half-space", error))?;
    let check = |grid: &Grid| {
        FixedLoadSolver::check_room(grid, half_space.boundary(), options.memory_budget)
    };
    let mut builder = FixedLoadSolver::builder(&surface, &half_space)
        .tolerance(options.tolerance)
        .stiffness(false);
    if let Some(hardness) = hardness {
        builder = builder.hardness(hardness.pascals);
    }
    if let Some(budget) = options.memory_budget {
        builder = builder.memory_budget(budget);
    }
    let mut solver = builder
        .build()
        .map_err(|error| room::failure("cannot set up the solver".to_string(), error, check))?;
    note!(
        "{nx} x {ny} nodes, set up in {:.3} s, {} MB",
        start.elapsed().as_secs_f64(),
        solver.bytes() / 1_000_000
    );
    panel::register_font()?;
    for directory in options.save.iter().chain([&options.out]) {
        std::fs::create_dir_all(directory).map_err(|error| {
            Failure::new(format!("cannot create {}", directory.display()), error)
        })?;
    }
    let loads = options.loads.on(grid.nominal_area());
    let mut outcome = Outcome::default();
    let mut table = format!("{}\n", COLUMNS.join(","));
    let mut states = Vec::new();
    for (k, &load) in loads.iter().enumerate() {
        note!("load {} of {}: {}", k + 1, loads.len(), quantity(load, "N", 6));
        let solved = solve(&mut solver, load).and_then(|(solution, effort)| {
            let resolution =
                Resolution::of(&solution.fields.contact_map, &grid, half_space.boundary());
            let resolution = resolution
                .map_err(|error| Failure::new("cannot find the contact patches", error))?;
            let numbers = numbers(&solution, &resolution, &grid);
            // Writing to a text cannot fail.
            let _ = writeln!(table, "{}", numbers.join(","));
            let answer = answer(&numbers, &solution, effort.0);
            if options.json {
                states.push(object(&answer));
            } else {
                answer!("{}", line(&answer));
            }
            print_words(&solution, &resolution, effort.1);
            let on = (&grid, half_space.boundary());
            let warnings =
                Warning::of_contact(&solution.fields.pressure, &solution.fields.contact_map, on)
                    .map_err(|error| Failure::new("cannot look at the contact", error))?;
            let yields = solution.contact.plastic.is_some();
            let high = bodies.warning_of(solution.fields.max_pressure()).filter(|_| !yields);
            for warning in warnings.iter().chain(&high) {
                eprintln!("warning: {}", advice::told(warning));
            }
            Ok(solution)
        });
        match solved {
            Ok(solution) => {
                let picture = options.out.join(format!("contact_map_{k}.png"));
                let FixedLoadSolution { contact, fields, .. } = &solution;
                let yielded = contact.plastic.map(|_| &fields.yielded_map);
                outcome.written(draw_map(
                    &grid,
                    contact,
                    &fields.pressure,
                    &fields.contact_map,
                    yielded,
                    &picture,
                ));
                if let Some(directory) = &options.save {
                    outcome.all_written(save(directory, &solution, k));
                }
                outcome.note(verify(&solution, options.tolerance));
            }
            // What was found before is not lost.
            Err(failure) => outcome.note(Err(failure)),
        }
    }
    if table.lines().count() > 1 {
        outcome.written(outcome::write(&options.out.join("load.csv"), table));
    }
    if options.json {
        answer!("{}", json!({ "states": states }));
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
            format!("cannot solve for the contact under {}", quantity(load, "N", 6)),
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
const COLUMNS: [&str; 13] = [
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
    "yielded_area_fraction",
    "plastic_volume",
];

/// The numbers of those columns; nothing where there is none.
fn numbers(solution: &FixedLoadSolution, resolution: &Resolution, grid: &Grid) -> [String; 13] {
    let state = solution.contact;
    let plastic = state.plastic.unwrap_or_default();
    let exact = |value: f64| format!("{value:e}");
    let optional = |value: Option<f64>| value.map_or_else(String::new, exact);
    [
        exact(state.load),
        state.contact_nodes.to_string(),
        exact(solution.fields.max_pressure()),
        exact(state.mean_gap),
        exact(state.approach),
        optional(state.contact_stiffness),
        optional(state.interfacial_stiffness),
        exact(state.load / grid.nominal_area()),
        exact(state.contact_area),
        exact(state.contact_area_fraction),
        exact(resolution.corrected_area),
        exact(plastic.yielded_area_fraction),
        exact(plastic.volume),
    ]
}

/// Names and numbers for programs.
fn answer(
    numbers: &[String; 13],
    solution: &FixedLoadSolution,
    seconds: f64,
) -> Vec<(&'static str, String)> {
    let effort = [
        ("iterations", solution.effort.iterations.to_string()),
        ("seconds", format!("{seconds:.6}")),
    ];
    COLUMNS.into_iter().zip(numbers.iter().cloned()).chain(effort).collect()
}

/// As a line.
fn line(answer: &[(&str, String)]) -> String {
    let named = answer.iter().map(|(name, number)| format!("{name}={number}"));
    named.collect::<Vec<_>>().join(" ")
}

/// As an object; what is no number is null.
fn object(answer: &[(&str, String)]) -> Value {
    let named = answer.iter().map(|(name, number)| {
        // Counts are integers.
        let count = number.parse().map(|count: u64| json!(count));
        let value = count.or_else(|_| number.parse().map(|number: f64| json!(number)));
        ((*name).to_string(), value.unwrap_or(Value::Null))
    });
    Value::Object(named.collect::<Map<_, _>>())
}

/// The lines for people.
fn print_words(solution: &FixedLoadSolution, resolution: &Resolution, seconds_more: f64) {
    let state = solution.contact;
    let greatest = solution.fields.max_pressure();
    note!(
        "  contact {:.4} % of the nominal area, {resolution}",
        100.0 * state.contact_area_fraction
    );
    note!(
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
            note!("  {name} {}", quantity(stiffness, "N/m", 4));
        }
    }
    let gap = |relative: f64| quantity(relative * solution.certificate.length, "m", 2);
    let least = solution.certificate.least_gap;
    note!(
        "  residuals: gap in contact {}{}",
        gap(solution.certificate.greatest_contact_gap),
        // There is none in full contact.
        match least.is_finite() {
            true => format!(", least gap out of contact {}", gap(least)),
            false => String::new(),
        }
    );
    note!(
        "  {} convolutions and {:.1} on coarser grids, {seconds_more:.3} s more for the stiffness",
        solution.effort.convolutions,
        solution.effort.coarse_convolutions,
    );
    if let Some(plastic) = &solution.contact.plastic {
        note!(
            "  {} yielded, plastic volume {}, energy lost {}",
            counted(plastic.yielded_nodes, "node"),
            quantity(plastic.volume, "m³", 4),
            quantity(plastic.work, "J", 4)
        );
    }
    if state.contact_area_fraction == 1.0 {
        note!("note: the contact is full; beyond full contact only the pressure changes");
    }
}

/// Writes the fields of the K-th load.
fn save(directory: &Path, solution: &FixedLoadSolution, k: usize) -> Result<Vec<PathBuf>, Failure> {
    let fields = [("pressure", &solution.fields.pressure), ("gap", &solution.fields.gap)];
    let written = fields.map(|(name, field)| {
        let file = directory.join(format!("{name}_{k}.npy"));
        match write_npy(&file, field) {
            Ok(()) => Ok(file),
            Err(error) => Err(Failure::writing(&file, error)),
        }
    });
    written.into_iter().collect()
}

/// `Ok` if the certificate of a solution is within what was asked for. The solver stops at a tolerance of gaps that is relative to
/// no more than the length of the certificate, and keeps pressures from being negative and their sum at the load: what is
/// ten times worse, or than rounding, is wrong.
fn verify(solution: &FixedLoadSolution, tolerance: f64) -> Result<(), Failure> {
    let allowed = (10.0 * tolerance).max(1e-10);
    let certificate = &solution.certificate;
    for (what, error) in [
        ("least pressure in contact", -certificate.least_pressure),
        ("least gap out of contact", -certificate.least_gap),
        ("greatest gap in contact", certificate.greatest_contact_gap),
        ("complementarity", certificate.complementarity),
        ("sum of pressures less load", certificate.load_error.abs()),
    ] {
        // NaN is wrong as well.
        let is_right = error <= allowed;
        if !is_right {
            return Err(Failure::request(format!(
                "the contact under {} violates the contact conditions: {what} has an error of {error:.1e}, more than the allowed {allowed:.1e}",
                quantity(solution.contact.load, "N", 6)
            )));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use asperity::surface::SelfAffine;
    use asperity::{Boussinesq, Error};

    use super::*;

    /// A solution is within its tolerance, and each of its errors counts.
    #[test]
    fn bad_certificates_are_errors() -> Result<(), Error> {
        let half_space = Boussinesq::new(Grid::square(32, 1.25e-3)?, 115e9)?;
        let surface = SelfAffine::zhang2020(1);
        let solution = || {
            let builder = FixedLoadSolver::builder(&surface, &half_space).tolerance(1e-8);
            builder.build()?.solve(10.0)
        };
        assert!(verify(&solution()?, 1e-8).is_ok());
        let errors: [fn(&mut FixedLoadSolution, f64); 5] = [
            |solution, error| solution.certificate.least_pressure = -error,
            |solution, error| solution.certificate.least_gap = -error,
            |solution, error| solution.certificate.greatest_contact_gap = error,
            |solution, error| solution.certificate.complementarity = error,
            |solution, error| solution.certificate.load_error = -error,
        ];
        for spoil in errors {
            for (error, is_right) in [(0.9e-7, true), (1.1e-7, false), (f64::NAN, false)] {
                let mut solution = solution()?;
                spoil(&mut solution, error);
                assert_eq!(verify(&solution, 1e-8).is_ok(), is_right, "{error:e}");
            }
        }
        Ok(())
    }
}
