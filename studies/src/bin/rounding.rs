//! What rounding does to a path: drift over tens of thousands of nodes, and the condition of the matrix against the
//! aspect of cells and the size of the grid. Prints the tables of docs/reliability.md.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use asperity::contact::ContactFields;
use asperity::surface::HeightMap;
use asperity::updater::RecursiveCholesky;
use asperity::{
    Boussinesq, FixedLoadSolver, Grid, InfluenceKernel, LoadingSolver, LoadingState,
    PeriodicBoussinesq, Problem, SelfAffine, Spectral,
};
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLUE, Chart, Corner, GREEN, ORANGE, Series, Style};
use asperity_cli::outcome::Failure;
use asperity_cli::panel;
use asperity_studies::study;
use clap::{Parser, Subcommand};
use nalgebra::DMatrix;

/// Measures what rounding does to a path.
#[derive(Parser)]
struct Options {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    /// Scalars that are carried from node to node, against those of the pressure solved for afresh. Memory: 4 n² bytes.
    Drift {
        /// Nodes a side.
        #[arg(long, default_value_t = 256)]
        nodes: usize,
        /// Nodes in contact at the end.
        #[arg(long, default_value_t = 60_000)]
        contact: usize,
        /// Nodes in contact between two lines.
        #[arg(long, default_value_t = 6_000)]
        every: usize,
    },
    /// Condition numbers, and what is left of the conditions of contact on the path of each.
    Condition {
        /// Draws the table into this folder.
        #[arg(long)]
        picture: Option<PathBuf>,
    },
}

fn main() -> ExitCode {
    study::main(run)
}

fn run(options: &Options) -> Result<(), Failure> {
    let failed = |error| Failure::new("cannot follow a path", error);
    match &options.what {
        &What::Drift { nodes, contact, every } => drift(nodes, contact, every).map_err(failed),
        What::Condition { picture } => {
            let found = condition().map_err(failed)?;
            picture.as_deref().map_or(Ok(()), |folder| draw(&found, folder))
        }
    }
}

fn relative(value: f64, expected: f64) -> f64 {
    (value / expected - 1.0).abs()
}

fn drift(nodes: usize, contact: usize, every: usize) -> Result<(), Box<dyn Error>> {
    let surface = SelfAffine::zhang2020(1);
    let kernel = Boussinesq::new(Grid::square(nodes, 1e-2)?, 115e9)?;
    let mut path = LoadingSolver::builder(&surface, &kernel)
        .updater(RecursiveCholesky::new())
        .max_nodes(contact)
        .build()?;
    let mut loads = FixedLoadSolver::builder(&surface, &kernel).tolerance(1e-11).build()?;
    let cell = path.grid().cell_area();
    println!("| nodes | load | mean gap | energy | stiffness | approach | gap in contact |");
    println!("|---|---|---|---|---|---|---|");
    let mut last: Option<LoadingState> = None;
    while let Some(state) = path.next() {
        let state = state?;
        let is_last = state.contact.contact_nodes == contact;
        last = Some(state);
        if !state.contact.contact_nodes.is_multiple_of(every) && !is_last {
            continue;
        }
        let ContactFields { pressure, displacement, gap, .. } = path.fields()?;
        let certificate = path.certificate()?;
        let energy = 0.5 * cell * pressure.dot(&displacement);
        let single = loads.solve(state.contact.load)?.contact;
        let stiffness = [state.contact.contact_stiffness, single.contact_stiffness];
        let [Some(own), Some(other)] = stiffness else {
            return Err("there is no contact stiffness".into());
        };
        println!(
            "| {} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {:.1e} |",
            state.contact.contact_nodes,
            relative(state.contact.load, cell * pressure.sum()),
            relative(state.contact.mean_gap, gap.mean()),
            relative(state.contact.energy, energy),
            relative(own, other),
            relative(state.contact.approach, single.approach),
            certificate.greatest_contact_gap,
        );
    }
    let Some(last) = last else {
        return Err("the path has no states".into());
    };
    println!("\n{} events", last.step);
    Ok(())
}

/// Rough, without ties.
fn rough(grid: &Grid) -> Result<HeightMap, asperity::SurfaceError> {
    let (nx, ny) = grid.shape();
    HeightMap::new(DMatrix::from_fn(nx, ny, |ix, iy| {
        let (x, y) = (ix as f64, iy as f64);
        (1.3 * x + 0.7 * y).sin() + (0.9 * y - 0.4 * x).cos() + 0.3 * (1.9 * x * y).sin()
    }))
}

type Kernel = Box<dyn InfluenceKernel>;

fn kernels(grid: Grid) -> [(&'static str, Result<Kernel, asperity::Error>); 3] {
    let free = Boussinesq::new(grid, 1.0).map(|kernel| Box::new(kernel) as Kernel);
    let periodic = PeriodicBoussinesq::new(grid, 1.0).map(|kernel| Box::new(kernel) as Kernel);
    let spectral = Spectral::new(grid, 1.0).map(|kernel| Box::new(kernel) as Kernel);
    [("free, Love", free), ("periodic, Love", periodic), ("spectral", spectral)]
}

fn condition() -> Result<[Vec<Residuals>; 3], Box<dyn Error>> {
    println!("| half-space | nodes | aspect | condition | least pressure | gap in contact |");
    println!("|---|---|---|---|---|---|");
    let sizes = [8, 16, 32].map(|nodes| (nodes, 1.0));
    let aspects = (1..=6).map(|power| (16, 10_f64.powi(power)));
    let mut found: [Vec<Residuals>; 3] = Default::default();
    for (nodes, aspect) in sizes.into_iter().chain(aspects) {
        let grid = Grid::new(nodes, nodes, 1.0, 1.0 / aspect)?;
        for ((name, kernel), found) in kernels(grid).into_iter().zip(&mut found) {
            let residuals = kernel.and_then(|kernel| residuals(&grid, &*kernel));
            let rest = match &residuals {
                Ok([condition, pressure, gap]) => {
                    format!("{condition:.1e} | {pressure:.1e} | {gap:.1e}")
                }
                Err(error) => format!("refused: {error} | |"),
            };
            println!("| {name} | {nodes}² | {aspect:.0e} | {rest} |");
            found.extend(residuals);
        }
    }
    Ok(found)
}

fn draw(found: &[Vec<Residuals>; 3], folder: &Path) -> Result<(), Failure> {
    let chart = |title: &str, y: &str, value: fn(&Residuals) -> f64| {
        let names = ["free, Love", "periodic, Love", "spectral"];
        let series = found.iter().zip(names).zip([BLUE, GREEN, ORANGE]);
        let series = series.map(|((found, name), colour)| {
            let points = found.iter().map(|residuals| (residuals[0], value(residuals)));
            Series::new(name, colour, Style::Dots, points)
        });
        Chart {
            title: title.to_string(),
            x: Axis::plain_logarithmic("condition number of the influence matrix", 5.0, 5e7),
            y: Axis::plain_logarithmic(y, 1e-16, 1e-7),
            series: series.collect(),
            legend: Corner::TopLeft,
        }
    };
    let charts = [
        chart("Pressure below zero", "relative to the mean pressure", |found| -found[1]),
        chart("Gap in contact", "relative to the reference length", |found| found[2]),
    ];
    panel::register_font()?;
    let name = folder.join("rounding.png");
    std::fs::create_dir_all(folder).map_err(|error| Failure::writing(folder, error))?;
    println!("{}", chart::draw(&charts, 2, &name)?.display());
    Ok(())
}

/// Condition of the whole matrix, and the worst of the certificates of a path to full contact: least pressure, gap in
/// contact.
type Residuals = [f64; 3];

fn residuals(grid: &Grid, kernel: &dyn InfluenceKernel) -> Result<Residuals, asperity::Error> {
    let surface = rough(grid)?;
    let problem = Problem::new(&surface, kernel)?;
    let nodes = grid.nodes();
    let matrix = DMatrix::from_fn(nodes, nodes, |i, j| problem.coefficient(i, j).unwrap_or(0.0));
    let values = matrix.symmetric_eigenvalues();
    let mut path =
        LoadingSolver::builder(&surface, kernel).updater(RecursiveCholesky::new()).build()?;
    let (mut pressure, mut contact) = (0.0_f64, 0.0_f64);
    while let Some(state) = path.next() {
        if state?.contact.contact_nodes % 8 != 0 {
            continue;
        }
        let certificate = path.certificate()?;
        pressure = pressure.min(certificate.least_pressure);
        contact = contact.max(certificate.greatest_contact_gap);
    }
    Ok([values.max() / values.min(), pressure, contact])
}
