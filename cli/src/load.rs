//! `asperity load`: the contact of a measured surface under given loads.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use asperity::fixed_load::FixedLoadSolution;
use asperity::io::write_npy;
use asperity::kernel::Theory;
use asperity::{ContactTarget, FixedLoadSolver, Grid, InfluenceKernel, Warning};
use asperity_cli::half_space::{Periodic, boundary};
use asperity_cli::number::{counted, quantity};
use asperity_cli::outcome::{self, Failure, Outcome};
use asperity_cli::{answer, note, panel, say, speech};
use clap::Args;
use serde_json::{Map, Value, json};

use crate::advice;
use crate::at::At;
use crate::conduction::{Conduct, conductances};
use crate::contact_map::draw as draw_map;
use crate::earlier::{self, Earlier};
use crate::elasticity::Elasticity;
use crate::hardness::Hardness;
use crate::path::fields::Format;
use crate::reading::Reading;
use crate::resolution::Resolution;
use crate::room;
use crate::state_table::{self, Row};
use crate::values::{FORCE, PRESSURE, bytes};

/// The contact of a measured surface under given pressures or loads, each solved by itself
///
/// Prints a table of the states, and writes load.csv and, for each state, a map named after it: contact_map_5MPa.png,
/// or contact_map_500kPa.png for 0.5MPa. The model is that of `asperity path`: elastic up to the hardness if there is
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
    conduct: Conduct,

    #[command(flatten)]
    loads: Loads,

    /// Repeat surface and half-space periodically, with this kernel [default: a free half-space, which carries no
    /// pressure outside the surface]; with love and spectral a half-space has the approach of the mean planes, and the
    /// interfacial stiffness only
    #[arg(long, value_enum)]
    periodic: Option<Periodic>,

    /// Greatest error of the gaps, relative to the approach
    #[arg(long, value_name = "T", default_value_t = 1e-8, help_heading = "Solver")]
    tolerance: f64,

    /// Greatest memory in bytes, for example 2e9 [default: three quarters of the memory]
    #[arg(long, value_name = "BYTES", value_parser = bytes, help_heading = "Solver")]
    memory_budget: Option<usize>,

    /// Print one JSON object instead: states, one for each load that was solved for, with at (what was asked for),
    /// the columns of load.csv, iterations and seconds (SI units; null where there is no number), and warnings; load.csv
    /// and pictures are written only if --out is given
    #[arg(long)]
    json: bool,

    /// Directory for pressure and gap of each state: pressure_5MPa.npy, gap_5MPa.npy
    #[arg(long, value_name = "DIR")]
    save: Option<PathBuf>,

    /// Directory for load.csv and the pictures, created if it does not exist [default: out]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// At least one.
#[derive(Debug, Args)]
#[group(required = true, multiple = true)]
struct Loads {
    /// Load over nominal area, load, or contact area: 5MPa,50MPa or 10N or 2mm2 or 10%; a bare number is a mean
    /// pressure in Pa. For an area the load is any at which so many nodes are in contact
    #[arg(long, value_name = "STATE,...", value_delimiter = ',')]
    at: Vec<At>,

    /// Load; may be given several times
    #[arg(long, value_name = "NEWTONS", value_parser = FORCE.any())]
    load: Vec<f64>,

    /// Load over nominal area; may be given several times
    #[arg(long, value_name = "PA", value_parser = PRESSURE.positive())]
    mean_pressure: Vec<f64>,
}

impl Loads {
    /// All of them: loads, pressures, and others.
    fn all(&self) -> Result<Vec<At>, Failure> {
        let pressures = self.mean_pressure.iter().copied().map(At::MeanPressure);
        let loads = self.load.iter().copied().map(At::Load);
        let all: Vec<At> = loads.chain(pressures).chain(self.at.iter().copied()).collect();
        At::check(&all, false)?;
        Ok(all)
    }
}

impl Options {
    /// Where the table and the pictures go, if anywhere.
    fn directory(&self) -> Option<&Path> {
        outcome::directory(self.out.as_deref(), self.json)
    }

    /// `Ok` if the surface is none of the files that are written.
    fn check_surface(&self, asked: &[At]) -> Result<(), Failure> {
        if let Some(directory) = self.directory() {
            outcome::check_input(&self.surface, directory, &["load.csv"])?;
        }
        let Some(directory) = &self.save else { return Ok(()) };
        let fields =
            asked.iter().flat_map(|at| FIELDS.map(|name| Format::Npy.file(name, &at.ending())));
        outcome::check_input(&self.surface, directory, &fields.collect::<Vec<_>>())
    }
}

/// Solves for each load in turn.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    if options.json {
        speech::be_quiet();
    }
    let asked = options.loads.all()?;
    options.check_surface(&asked)?;
    let bodies = options.elasticity.required()?;
    let conductions = options.conduct.conductions(bodies.e_star)?;
    let layering = bodies.layering(boundary(options.periodic));
    if !conductions.is_empty() {
        layering
            .check(Theory::Conductance)
            .map_err(|error| Failure::new("cannot compute a conductance", error))?;
    }
    let surface = options.reading.surface(&options.surface)?;
    Reading::check_row(&surface, boundary(options.periodic))?;
    let hardness = options.hardness.of(&bodies)?;
    note!("bodies     {bodies}");
    if let Some(hardness) = hardness {
        note!("hardness   {hardness}");
    }
    options.conduct.tell();
    let warnings = Warning::of_surface(&surface).into_iter();
    let soft = hardness.and_then(|h| Warning::of_hardness(h.pascals, bodies.e_star));
    for warning in warnings.chain(bodies.warnings(surface.grid())).chain(soft) {
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
    let directory = options.directory();
    options.save.as_deref().into_iter().chain(directory).try_for_each(outcome::create_folder)?;
    let earlier = Earlier::of(&earlier::LOAD, directory, &[]);
    let mut outcome = Outcome::default();
    let names = COLUMNS.into_iter().chain(conductions.iter().map(|(name, _)| *name));
    let mut table = format!("{}\n", names.collect::<Vec<_>>().join(","));
    let conducts = !conductions.is_empty();
    let (mut rows, mut states, mut warnings) = (Vec::new(), Vec::new(), Vec::new());
    for &at in &asked {
        let solved = solve(&mut solver, (at, conducts), &grid).and_then(|(solution, seconds)| {
            let resolution =
                Resolution::of(&solution.fields.contact_map, &grid, half_space.boundary());
            let resolution = resolution
                .map_err(|error| Failure::new("cannot find the contact patches", error))?;
            let row = Row {
                contact: solution.contact,
                greatest: solution.fields.max_pressure(),
                corrected_area: resolution.corrected_area,
                yielded: solution.contact.plastic.map(|plastic| plastic.yielded_area_fraction),
                conductances: conductances(&conductions, &solution.contact, layering),
            };
            let numbers = numbers(&solution, &row, &grid);
            let cells: Vec<&str> = numbers.iter().map(|(_, number)| number.as_str()).collect();
            // Writing to a text cannot fail.
            let _ = writeln!(table, "{}", cells.join(","));
            states.push(object(at, &numbers, &solution, seconds.0));
            rows.push(row);
            print_words(at, &solution, &resolution, seconds);
            let on = (&grid, half_space.boundary());
            let of_contact =
                Warning::of_contact(&solution.fields.pressure, &solution.fields.contact_map, on)
                    .map_err(|error| Failure::new("cannot look at the contact", error))?;
            let yields = solution.contact.plastic.is_some();
            let high = bodies.warning_of(solution.fields.max_pressure()).filter(|_| !yields);
            let growth = half_space.contact_growth();
            let told = of_contact.iter().chain(&high).map(|found| advice::told_on(growth, found));
            warnings.extend(told.map(|told| format!("at {at}: {told}")));
            Ok(solution)
        });
        match solved {
            Ok(solution) => {
                if let Some(directory) = directory {
                    let picture = directory.join(format!("contact_map{}.png", at.ending()));
                    let FixedLoadSolution { contact, fields, .. } = &solution;
                    outcome.written(draw_map(
                        &grid,
                        contact,
                        &fields.pressure,
                        &fields.contact_map,
                        contact.plastic.map(|_| &fields.yielded_map),
                        &picture,
                    ));
                }
                if let Some(directory) = &options.save {
                    outcome.all_written(save(directory, &solution, at));
                }
                outcome.note(verify(&solution, options.tolerance));
            }
            // What was found before is not lost.
            Err(failure) => outcome.note(Err(failure)),
        }
    }
    if !rows.is_empty() {
        if let Some(directory) = directory {
            outcome.written(outcome::write(&directory.join("load.csv"), table));
        }
        say!();
        state_table::print(&rows, &grid, options.periodic);
    }
    warnings.iter().for_each(speech::warn);
    if options.json {
        answer!("{}", json!({ "states": states, "warnings": warnings }));
    }
    earlier.finish(outcome)
}

/// A solution with its stiffnesses, and the seconds that it and they took.
fn solve(
    solver: &mut FixedLoadSolver,
    (at, conducts): (At, bool),
    grid: &Grid,
) -> Result<(FixedLoadSolution, (f64, f64)), Failure> {
    let target = at.target(grid.nominal_area());
    let failed = |error| {
        let asked = match target {
            ContactTarget::Load(load) => quantity(load, "N", 6),
            _ => at.to_string(),
        };
        Failure::new(format!("cannot solve for the contact under {asked}"), error)
    };
    let start = Instant::now();
    let mut solution = solver.solve_target(target).map_err(failed)?;
    let seconds = start.elapsed().as_secs_f64();
    solver.add_stiffness(&mut solution).map_err(failed)?;
    // What has yielded conducts by the stiffness on unloading.
    if conducts && solution.contact.plastic.is_some() {
        solver.add_unloading_stiffness(&mut solution).map_err(failed)?;
    }
    let seconds_more = start.elapsed().as_secs_f64() - seconds;
    Ok((solution, (seconds, seconds_more)))
}

/// The columns of load.csv, in SI units.
const COLUMNS: [&str; 15] = [
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
    "plastic_work",
    "energy",
];

/// The numbers of those columns and of conductances, by name; nothing where there is none.
fn numbers(solution: &FixedLoadSolution, row: &Row, grid: &Grid) -> Vec<(&'static str, String)> {
    let state = solution.contact;
    let exact = |value: f64| format!("{value:e}");
    let optional = |value: Option<f64>| value.map_or_else(String::new, exact);
    let of_columns = [
        exact(state.load),
        state.contact_nodes.to_string(),
        exact(row.greatest),
        exact(state.mean_gap),
        exact(state.approach),
        optional(state.contact_stiffness),
        optional(state.interfacial_stiffness),
        exact(state.load / grid.nominal_area()),
        exact(state.contact_area),
        exact(state.contact_area_fraction),
        exact(row.corrected_area),
        exact(row.yielded.unwrap_or(0.0)),
        exact(state.plastic.map_or(0.0, |plastic| plastic.volume)),
        exact(state.plastic.map_or(0.0, |plastic| plastic.work)),
        exact(state.energy),
    ];
    let conducted = row.conductances.iter();
    let some = |value: f64| optional(Some(value).filter(|value| !value.is_nan()));
    let conducted = conducted.map(|(carrier, value)| (carrier.column(), some(*value)));
    COLUMNS.into_iter().zip(of_columns).chain(conducted).collect()
}

/// The same for programs, with what was asked for, and the effort; what is no number is null.
fn object(
    at: At,
    numbers: &[(&'static str, String)],
    solution: &FixedLoadSolution,
    seconds: f64,
) -> Value {
    let named = numbers.iter().map(|(name, number)| {
        // Counts are integers.
        let count = number.parse().map(|count: u64| json!(count));
        let value = count.or_else(|_| number.parse().map(|number: f64| json!(number)));
        ((*name).to_string(), value.unwrap_or(Value::Null))
    });
    let mut object: Map<String, Value> = named.collect();
    object.insert("at".to_string(), json!(at.to_string()));
    object.insert("iterations".to_string(), json!(solution.effort.iterations));
    object.insert("seconds".to_string(), json!(seconds));
    Value::Object(object)
}

/// How a state was found, and what the table does not have.
fn print_words(
    at: At,
    solution: &FixedLoadSolution,
    resolution: &Resolution,
    (seconds, seconds_more): (f64, f64),
) {
    let certificate = &solution.certificate;
    let gap = |relative: f64| quantity(relative * certificate.length, "m", 2);
    note!("at {at}: {resolution}");
    note!(
        "  {} convolutions and {:.1} on coarser grids in {seconds:.3} s, {seconds_more:.3} s more for the stiffness",
        solution.effort.convolutions,
        solution.effort.coarse_convolutions,
    );
    note!(
        "  residuals: gap in contact {}{}",
        gap(certificate.greatest_contact_gap),
        // There is none in full contact.
        match certificate.least_gap.is_finite() {
            true => format!(", least gap out of contact {}", gap(certificate.least_gap)),
            false => String::new(),
        }
    );
    if let Some(plastic) = &solution.contact.plastic {
        note!(
            "  {} yielded, plastic volume {}, energy lost {}",
            counted(plastic.yielded_nodes, "node"),
            quantity(plastic.volume, "m³", 4),
            quantity(plastic.work, "J", 4)
        );
    }
    if solution.contact.contact_area_fraction == 1.0 {
        note!("note: the contact is full; beyond full contact only the pressure changes");
    }
}

/// The fields that are saved.
const FIELDS: [&str; 2] = ["pressure", "gap"];

/// Writes the fields of a state.
fn save(directory: &Path, solution: &FixedLoadSolution, at: At) -> Result<Vec<PathBuf>, Failure> {
    let [pressure, gap] = FIELDS;
    let fields = [(pressure, &solution.fields.pressure), (gap, &solution.fields.gap)];
    let written = fields.map(|(name, field)| {
        let file = directory.join(Format::Npy.file(name, &at.ending()));
        match write_npy(&file, field) {
            Ok(()) => Ok(file),
            Err(error) => Err(Failure::writing(&file, error)),
        }
    });
    written.into_iter().collect()
}

/// `Ok` if the certificate of a solution is within what was asked for. The solver stops at a tolerance of gaps that is
/// relative to no more than the length of the certificate, and keeps pressures from being negative and their sum at the
/// load: what is ten times worse, or than rounding, is wrong.
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
