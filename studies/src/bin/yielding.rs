//! Contact with a hardness: the path of metals beside the elastic one, a sphere, and tamaas' solver with a limit of
//! pressure.
//!
//! ```text
//! cargo run --release -p asperity-studies --bin yielding -- --report docs/validation.md
//! ```
//!
//! The table of tamaas is what `studies/src/bin/peers/hardness.py` has written.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use asperity::loading::History;
use asperity::surface::Paraboloid;
use asperity::{
    Boussinesq, ContactEvent, Error, Grid, LoadingSolver, LoadingState, SelfAffine,
    plane_strain_modulus,
};
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLUE, Chart, Corner, GREY, ORANGE, Series, Style};
use asperity_cli::field_map::{FieldMap, Scale};
use asperity_cli::outcome::Failure;
use asperity_cli::panel;
use asperity_studies::page::Section;
use asperity_studies::study;
use clap::Parser;
use nalgebra::DMatrix;

const HARDNESS: f64 = 2.5e9;
/// What tamaas found.
const TAMAAS: &str = include_str!("peers/hardness.csv");

/// Contact with a hardness.
#[derive(Debug, Parser)]
#[command(name = "yielding")]
struct Options {
    /// Also write the section of this page
    #[arg(long, value_name = "FILE.md")]
    report: Option<PathBuf>,

    /// Folder for the pictures
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
}

fn main() -> ExitCode {
    study::main(run)
}

fn run(options: &Options) -> Result<(), Failure> {
    let failed = |error: Error| Failure::new("cannot follow a path", error);
    panel::register_font()?;
    std::fs::create_dir_all(&options.out)
        .map_err(|error| Failure::new("cannot make the folder of the pictures", error))?;
    let mut text = String::from(
        "## Contact with a hardness\n\nStudy `yielding`, which also draws the pictures of [Metals that \
         yield](metals_that_yield.md).\n",
    );
    let pictures = metals(&options.out)?;
    sphere(&mut text).map_err(failed)?;
    tamaas(&mut text);
    let section = Section { study: "yielding", text: &text, pictures: &pictures };
    section.show(options.report.as_deref())
}

/// The surface of the first command, of steel, with a hardness and without.
fn metals(directory: &Path) -> Result<Vec<PathBuf>, Failure> {
    let failed = |error: Error| Failure::new("cannot follow the path of a rough surface", error);
    let e_star = plane_strain_modulus(210e9, 0.3).map_err(failed)?;
    let grid = Grid::square(256, 1e-2).map_err(|error| failed(error.into()))?;
    let half_space = Boussinesq::new(grid, e_star).map_err(failed)?;
    let paper = SelfAffine::zhang2020(1);
    let (rolloff, shortest) = (paper.rolloff_wavelength(), 8.0 * grid.dx());
    let spectrum = SelfAffine::new(paper.hurst(), rolloff, shortest, paper.amplitude(), 1)
        .map_err(|error| failed(error.into()))?;
    let builder = || LoadingSolver::builder(&spectrum, &half_space).max_area_fraction(0.2);
    let elastic = states(builder().build().map_err(failed)?).map_err(failed)?;
    let mut path = builder().hardness(HARDNESS).build().map_err(failed)?;
    let yielding = path.by_ref().collect::<Result<Vec<_>, _>>().map_err(failed)?;

    let area = |state: &LoadingState| (state.contact.load, state.contact.contact_area_fraction);
    let yielded = |state: &LoadingState| {
        let plastic = state.contact.plastic.unwrap_or_default();
        (state.contact.load, plastic.yielded_area_fraction)
    };
    let loaded = |states: &[LoadingState]| -> Vec<LoadingState> {
        states.iter().filter(|state| state.contact.load > 1.0).copied().collect()
    };
    let (elastic, plastic) = (loaded(&elastic), loaded(&yielding));
    let chart = Chart {
        title: "Steel, rigid against rough: 256 × 256 nodes to 20 % contact".to_string(),
        x: Axis::logarithmic("load W", "N", 1.0, 1e6),
        y: Axis::plain_logarithmic("contact area over nominal area", 1e-5, 0.3),
        series: vec![
            Series::new("elastic", GREY, Style::Line, elastic.iter().map(area)),
            Series::new("hardness 2.5 GPa", BLUE, Style::Line, plastic.iter().map(area)),
            Series::new("yielded", ORANGE, Style::Dashed, plastic.iter().map(yielded)),
        ],
        legend: Corner::TopLeft,
    };
    let curves = chart::draw(&[chart], 1, &directory.join("yielding_area.png"))?;

    // The map at 10 %.
    let history: History = yielding.iter().copied().collect();
    let state = history.at_area_fraction(0.1).ok_or_else(|| Failure::request("no such area"))?;
    let fields = path.fields_at(&state).map_err(failed)?;
    let (pressure, contact, yielded) = (fields.pressure, fields.contact_map, fields.yielded_map);
    let values =
        DMatrix::from_fn(256, 256, |ix, iy| match (contact[(ix, iy)], yielded[(ix, iy)]) {
            (false, _) => f64::NAN,
            (true, true) => f64::INFINITY,
            (true, false) => pressure[(ix, iy)],
        });
    let map = FieldMap {
        grid: &grid,
        length_unit: "m",
        values: &values,
        range: (0.0, HARDNESS),
        scale: Scale::Linear,
        contours: &[],
        label: ("pressure", "Pa"),
    }
    .write(&directory.join("yielding_map.png"), "10 % contact under a hardness of 2.5 GPa")?;

    Ok(vec![curves, map])
}

fn states(path: LoadingSolver) -> Result<Vec<LoadingState>, Error> {
    path.collect()
}

/// A rigid sphere of R = 1 on E* = 1 with H = 0.1: first yield at `δ = R (πH/2E*)²`, where Hertz' greatest pressure is
/// H, under `W = π³R²H³/6E*²`; and loads beyond, from 800 rings of exact influence, extrapolated.
fn sphere(text: &mut String) -> Result<(), Error> {
    let hardness = 0.1;
    let first = (std::f64::consts::FRAC_PI_2 * hardness).powi(2);
    let load = std::f64::consts::PI.powi(3) * f64::powi(hardness, 3) / 6.0;
    let beyond = [(1.2, 1.31208), (1.5, 1.81525), (3.0, 4.69615)];
    text.push_str(
        "\n### A rigid sphere\n\nThe first node yields at the approach δ_y = R (πH/2E*)² under W_y = π³R²H³/6E*² \
         (Hertz). Beyond, the contact has no closed form; the loads are those of 800 rings of exact influence, \
         extrapolated (R = 1, E* = 1, H = 0.1). Errors fall with the square of the cell, less evenly where few cells \
         are elastic.\n\n\
         | nodes | δ_y found / exact | W/W_y at δ = 1.2 δ_y | 1.5 δ_y | 3 δ_y |\n|---|---|---|---|---|\n",
    );
    let surface = Paraboloid::new(1.0)?;
    for nodes in [33, 65, 129] {
        let grid = Grid::square(nodes, 0.7)?;
        let half_space = Boussinesq::new(grid, 1.0)?;
        let builder = LoadingSolver::builder(&surface, &half_space).hardness(hardness);
        let path = builder.max_approach(3.0 * first).build()?;
        let history: History = path.collect::<Result<_, _>>()?;
        let mut events = history.states().iter();
        let yields = events.find(|state| state.event == ContactEvent::Yield);
        let found = yields.map_or(f64::NAN, |state| state.contact.approach / first);
        let _ = write!(text, "| {nodes}² | {found:.4} |");
        for (approach, _) in beyond {
            let at = history.at_approach(approach * first);
            let ratio = at.map_or(f64::NAN, |state| state.contact.load / load);
            let _ = write!(text, " {ratio:.5} |");
        }
        text.push('\n');
    }
    let _ = write!(text, "| rings | 1 |");
    for (_, ratio) in beyond {
        let _ = write!(text, " {ratio:.5} |");
    }
    text.push('\n');
    Ok(())
}

/// What tamaas' solver finds.
fn tamaas(text: &mut String) {
    let (mut surfaces, mut other, mut greatest) = (0, 0, 0.0_f64);
    for line in TAMAAS.lines().skip(1) {
        let cells: Vec<f64> =
            line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
        surfaces += 1;
        other += (cells[6] + cells[7]) as usize;
        greatest = greatest.max(cells[8]);
    }
    // Writing to a text cannot fail.
    let _ = write!(
        text,
        "\n### tamaas with a limit of pressure\n\n`KatoSaturated` of tamaas 2.9 with a tolerance of 10⁻¹², on a \
         periodic half-space; asperity follows the path to the same mean pressure. On {surfaces} rough surfaces of 64² \
         and 128² nodes, with H/(E* h′) from 0.02 to 1 and mean pressures from 0.05 to 0.9 H, {other} nodes are in \
         contact or yielded in one and not in the other, and pressures differ by at most {greatest:.1e} H \
         (`studies/src/bin/peers/hardness.py`).\n",
    );
}
