//! `asperity load`: the contact of a measured surface under given loads.

use std::path::PathBuf;
use std::time::Instant;

use asperity::fixed_load::FixedLoadSolution;
use asperity::io::write_npy;
use asperity::{Doubt, FixedLoadSolver, Grid, InfluenceKernel};
use asperity_cli::half_space::{Periodic, half_space};
use asperity_cli::outcome::Failure;
use asperity_cli::say;
use clap::Args;

use crate::elasticity::Elasticity;
use crate::reading::Reading;
use crate::room;
use crate::values::bytes;

/// The contact of a measured surface under given loads, each solved by itself: one line for each
///
/// Results go to stdout, progress to stderr. Memory grows with the grid and not with the contact.
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

    /// Load; may be given several times
    #[arg(
        long,
        value_name = "NEWTONS",
        allow_negative_numbers = true,
        required = true
    )]
    load: Vec<f64>,

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
}

/// Solves for each load in turn.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let e_star = options.elasticity.required()?;
    let surface = options.reading.surface(&options.surface)?;
    for doubt in Doubt::of_surface(&surface) {
        eprintln!("warning: {doubt}");
    }
    let grid = *surface.grid();
    let (nx, ny) = grid.shape();
    let start = Instant::now();
    let half_space = half_space(options.periodic, grid, e_star)
        .map_err(|error| Failure::new("no such half-space", error))?;
    let check = |grid: &Grid| {
        FixedLoadSolver::check_room(grid, half_space.boundary(), options.memory_budget)
    };
    let mut builder = FixedLoadSolver::builder(&surface, &half_space)
        .tolerance(options.tolerance)
        .stiffness(false);
    if let Some(budget) = options.memory_budget {
        builder = builder.memory_budget(budget);
    }
    let mut solver = builder
        .build()
        .map_err(|error| room::failure("no solution can begin".to_string(), error, check))?;
    eprintln!(
        "{nx} x {ny} nodes, set up in {:.3} s, {} MB",
        start.elapsed().as_secs_f64(),
        solver.bytes() / 1_000_000
    );
    if let Some(directory) = &options.save {
        std::fs::create_dir_all(directory)
            .map_err(|error| Failure::new(format!("cannot make {}", directory.display()), error))?;
    }
    for (k, &load) in options.load.iter().enumerate() {
        eprintln!("load {} of {}: {load} N", k + 1, options.load.len());
        let failed = |error| Failure::new(format!("no contact under {load} N"), error);
        let start = Instant::now();
        let mut solution = solver.solve(load).map_err(failed)?;
        let seconds = start.elapsed().as_secs_f64();
        solver.add_stiffness(&mut solution).map_err(failed)?;
        let seconds_more = start.elapsed().as_secs_f64() - seconds;
        print(&solution, seconds, seconds_more);
        if let Some(directory) = &options.save {
            for (name, field) in [("pressure", &solution.pressure), ("gap", &solution.gap)] {
                let file = directory.join(format!("{name}_{k}.npy"));
                write_npy(&file, field).map_err(|error| Failure::writing(&file, error))?;
            }
        }
        verify(&solution, options.tolerance)?;
    }
    Ok(())
}

/// A line for programs on stdout, and one for people on stderr.
fn print(solution: &FixedLoadSolution, seconds: f64, seconds_more: f64) {
    let state = solution.state;
    say!(
        "load={:e} contact_nodes={} max_pressure={:e} mean_gap={:e} approach={:e} \
         contact_stiffness={} interfacial_stiffness={} iterations={} seconds={seconds:.6}",
        state.load,
        state.contact_nodes,
        solution.max_pressure(),
        state.mean_gap,
        state.approach,
        printed(state.contact_stiffness),
        printed(state.interfacial_stiffness),
        solution.effort.iterations,
    );
    eprintln!(
        "  {:.3} % in contact, {} convolutions and {:.1} on coarser grids, {seconds_more:.3} s more \
         for the stiffness, errors: complementarity {:.1e}, gap in contact {:.1e}, least gap {:.1e}",
        100.0 * state.contact_area_fraction,
        solution.effort.convolutions,
        solution.effort.coarse_convolutions,
        solution.certificate.complementarity,
        solution.certificate.greatest_contact_gap,
        solution.certificate.least_gap,
    );
}

/// `Ok` if the certificate of a solution is within what was asked for. The solver stops at a tolerance of gaps that is relative to
/// no more than the length of the certificate, and keeps pressures from being negative and their sum at the load: what is
/// ten times worse, or than rounding, is wrong.
fn verify(solution: &FixedLoadSolution, tolerance: f64) -> Result<(), Failure> {
    let allowed = (10.0 * tolerance).max(1e-10);
    let certificate = &solution.certificate;
    for (quantity, error) in [
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
                "the certificate is bad: an error of {error:.1e} ({quantity}), where {allowed:.1e} is the most"
            )));
        }
    }
    Ok(())
}

/// Nothing where there is none.
fn printed(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| format!("{value:e}"))
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
