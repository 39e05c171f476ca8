//! Coated and thin bodies: free kernels beside periodic ones on padded grids and beside a quadrature, the iterations
//! that layers take, and the picture of the page on coats.
//!
//! ```text
//! cargo run --release -p asperity-studies --bin layers -- --report docs/validation.md
//! ```
//!
//! The coefficients of the quadrature are what `studies/src/bin/peers/layered_cells.py` has written.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use asperity::kernel::{Base, Layer, Layered, LayeredBody};
use asperity::loading::History;
use asperity::surface::Paraboloid;
use asperity::updater::ConjugateGradient;
use asperity::{
    Boussinesq, ContactEvent, ContactTarget, Error, FixedLoadSolver, Grid, InfluenceKernel,
    LoadingSolver, LoadingState, SelfAffine, plane_strain_modulus,
};
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLUE, Chart, Corner, GREY, ORANGE, Series, Style};
use asperity_cli::outcome::Failure;
use asperity_cli::panel;
use asperity_studies::page::Section;
use asperity_studies::study;
use clap::Parser;

const QUADRATURE: &str = include_str!("../../../tests/data/layers_free.csv");
const STEEL: Base = Base::HalfSpace { youngs_modulus: 210e9, poissons_ratio: 0.3 };

/// Coated and thin bodies.
#[derive(Debug, Parser)]
#[command(name = "layers")]
struct Options {
    /// Also write the section of this page
    #[arg(long, value_name = "FILE.md")]
    report: Option<PathBuf>,

    /// Nodes along each side of the surface whose iterations are counted
    #[arg(long, value_name = "N", default_value_t = 512)]
    nodes: usize,

    /// Only count iterations, of bodies whose names contain this
    #[arg(long, value_name = "WORD", num_args = 0..=1, default_missing_value = "")]
    only_iterations: Option<String>,

    /// Only draw the picture
    #[arg(long, conflicts_with = "only_iterations")]
    only_picture: bool,

    /// Folder for the pictures
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
}

fn main() -> ExitCode {
    study::main(run)
}

fn run(options: &Options) -> Result<(), Failure> {
    let failed = |error: Error| Failure::new("cannot solve for a contact", error);
    panel::register_font()?;
    std::fs::create_dir_all(&options.out)
        .map_err(|error| Failure::new("cannot make the folder of the pictures", error))?;
    let mut text = String::from("## Coated and thin bodies\n\nStudy `layers`.\n");
    if options.only_picture {
        let picture = coats(&options.out, &mut text)?;
        println!("{text}\n{}", picture.display());
        return Ok(());
    }
    if let Some(word) = &options.only_iterations {
        iterations(options.nodes, word, &mut text).map_err(failed)?;
        println!("{text}");
        return Ok(());
    }
    quadrature(&mut text).map_err(failed)?;
    padded(&mut text).map_err(failed)?;
    let picture = coats(&options.out, &mut text)?;
    let section = Section { study: "layers", text: &text, pictures: &[picture] };
    section.show(options.report.as_deref())
}

fn one_layer(
    youngs_modulus: f64,
    poissons_ratio: f64,
    thickness: f64,
    base: Base,
) -> Result<LayeredBody, Error> {
    LayeredBody::new(&[Layer { youngs_modulus, poissons_ratio, thickness }], base)
}

/// Greatest errors of coefficients beside those of a quadrature.
fn quadrature(text: &mut String) -> Result<(), Error> {
    let grid = Grid::square(8, 8.0)?;
    let mut greatest = 0.0_f64;
    let mut bodies = 0;
    let lines = QUADRATURE.lines().skip(1);
    let numbers = lines.map(|line| -> Vec<f64> {
        line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect()
    });
    let lines: Vec<Vec<f64>> = numbers.collect();
    for case in lines.chunks(7) {
        let base = match case[0][3] {
            0.0 => Base::Rigid,
            youngs_modulus => Base::HalfSpace { youngs_modulus, poissons_ratio: case[0][4] },
        };
        let kernel = Layered::free(grid, one_layer(case[0][0], case[0][1], case[0][2], base)?)?;
        for line in case {
            let found = kernel.coefficient(line[5] as isize, line[6] as isize);
            greatest = greatest.max((found - line[7]).abs() / kernel.coefficient(0, 0));
        }
        bodies += 1;
    }
    let _ = write!(
        text,
        "\n**Coefficients.** `studies/src/bin/peers/layered_cells.py` integrates the symbol of {bodies} bodies, soft, \
         stiff and on a rigid base, over all wavevectors, without the tables of this crate. The greatest difference in \
         {} coefficients is {greatest:.0e} of C(0, 0).\n",
        lines.len()
    );
    Ok(())
}

/// A sphere on the free kernel, and on the periodic one on larger and larger grids.
fn padded(text: &mut String) -> Result<(), Error> {
    let n = 64_usize;
    let radius = 400.0;
    let _ = write!(
        text,
        "\n**Free and padded.** A sphere with a contact some 40 cells wide on a free grid of {n}² cells, and on a \
         periodic grid of so many times the side, at the same load: relative difference of the greatest pressure. \
         Images of a sphere in the period L change it by some (a/L)³; those of a layer on a rigid base are not \
         felt.\n\n\
         | body | 1 | 2 | 4 | 8 |\n|---|---:|---:|---:|---:|\n"
    );
    let steel = Base::HalfSpace { youngs_modulus: 1.0, poissons_ratio: 0.3 };
    for (name, body) in [
        ("soft coat, E₁/E₂ = 0.1, h = 5 cells", one_layer(0.1, 0.3, 5.0, steel)?),
        ("stiff coat, E₁/E₂ = 10, h = 5 cells", one_layer(10.0, 0.3, 5.0, steel)?),
        ("rigid base, ν = 0.3, h = 5 cells", one_layer(1.0, 0.3, 5.0, Base::Rigid)?),
        ("rigid base, ν = 0.5, h = 5 cells", one_layer(1.0, 0.5, 5.0, Base::Rigid)?),
    ] {
        let sphere = Paraboloid::new(radius)?;
        let grid = Grid::square(n, n as f64)?;
        let free = Layered::free(grid, body.clone())?;
        let mut solver = FixedLoadSolver::builder(&sphere, &free).tolerance(1e-10).build()?;
        let expected = solver.solve_target(ContactTarget::AreaFraction(0.3))?;
        let _ = write!(text, "| {name} |");
        for times in [1, 2, 4, 8] {
            let large = Grid::square(times * n, (times * n) as f64)?;
            let kernel = Layered::periodic(large, body.clone())?;
            // Beyond the free grid nothing touches.
            let middle = 0.5 * (times * n) as f64;
            let inside = 0.5 * n as f64;
            let heights = asperity::nalgebra::DMatrix::from_fn(times * n, times * n, |ix, iy| {
                let (x, y) = (ix as f64 + 0.5 - middle, iy as f64 + 0.5 - middle);
                let is_inside = x.abs() < inside && y.abs() < inside;
                let depth = -(x * x + y * y) / (2.0 * radius);
                if is_inside { depth } else { depth.min(-inside * inside / radius) }
            });
            let surface = asperity::HeightMap::new(heights)?;
            let mut solver =
                FixedLoadSolver::builder(&surface, &kernel).tolerance(1e-10).build()?;
            let found = solver.solve(expected.contact.load)?;
            let difference = found.fields.max_pressure() / expected.fields.max_pressure() - 1.0;
            let _ = write!(text, " {difference:.1e} |");
        }
        text.push('\n');
    }
    Ok(())
}

/// The bodies whose iterations are counted, on cells of 1: a half-space, five layers, a thick and a thin one.
fn counted() -> Result<Vec<(&'static str, Option<LayeredBody>)>, Error> {
    let steel = Base::HalfSpace { youngs_modulus: 1.0, poissons_ratio: 0.3 };
    // Six layers of two cells, from a tenth of the modulus at the surface to that of the base.
    let graded: Vec<Layer> = (0..6)
        .map(|k| Layer {
            youngs_modulus: 10_f64.powf(f64::from(k) / 6.0 - 1.0),
            poissons_ratio: 0.3,
            thickness: 2.0,
        })
        .collect();
    Ok(vec![
        ("half-space", None),
        ("soft coat, E₁/E₂ = 0.1, h = 4", Some(one_layer(0.1, 0.3, 4.0, steel)?)),
        ("stiff coat, E₁/E₂ = 10, h = 4", Some(one_layer(10.0, 0.3, 4.0, steel)?)),
        ("rigid base, ν = 0.3, h = 4", Some(one_layer(1.0, 0.3, 4.0, Base::Rigid)?)),
        ("rigid base, ν = 0.5, h = 4", Some(one_layer(1.0, 0.5, 4.0, Base::Rigid)?)),
        ("six layers, E/E₂ from 0.1 to 0.7", Some(LayeredBody::new(&graded, steel)?)),
        ("stiff coat, E₁/E₂ = 10, h = 32", Some(one_layer(10.0, 0.3, 32.0, steel)?)),
        ("rigid base, ν = 0.5, h = 1", Some(one_layer(1.0, 0.5, 1.0, Base::Rigid)?)),
    ])
}

/// Events of a path without a factor that are counted at each load.
const STRETCH: usize = 200;

/// Iterations without a factor: of single loads, and of the stretch of a path that begins at each.
fn iterations(n: usize, word: &str, text: &mut String) -> Result<(), Error> {
    let grid = Grid::square(n, n as f64)?;
    let amplitude = asperity::surface::Amplitude::RmsHeight(1.0);
    let surface = SelfAffine::new(0.8, 0.25 * n as f64, 8.0, amplitude, 1)?;
    let fractions = [0.01, 0.1, 0.3, 0.6];
    let mut rows = String::new();
    for (name, body) in counted()?.into_iter().filter(|(name, _)| name.contains(word)) {
        let kernel: Box<dyn InfluenceKernel> = match body {
            None => Box::new(Boussinesq::new(grid, 1.0)?),
            Some(body) => Box::new(Layered::free(grid, body)?),
        };
        let start = Instant::now();
        let _ = write!(rows, "| {name} | {:?} |", kernel.contact_growth());
        let mut solver = FixedLoadSolver::builder(&surface, &kernel).tolerance(1e-10).build()?;
        for fraction in fractions {
            match load_and_stretch(&surface, &kernel, &mut solver, fraction) {
                Ok([load, path]) => {
                    let _ = write!(rows, " {load}; {path} |");
                }
                Err(error) => {
                    eprintln!("{name}, {fraction}: {error}");
                    rows.push_str(" – |");
                }
            }
            eprintln!("{name}, {fraction}: {:.1} s", start.elapsed().as_secs_f64());
        }
        rows.push('\n');
        eprintln!("{rows}");
    }
    let _ = write!(
        text,
        "\n**Iterations without a factor.** A self-affine surface (H = 0.8, shortest wavelength 8 cells) on {n}² nodes \
         with a free boundary; thicknesses in cells. At each area fraction: convolutions of a single load from scratch \
         to 10⁻¹⁰, with its stiffness; and convolutions an event over the first {STRETCH} events of a path from there \
         (`ConjugateGradient`), with the windows taken back.\n\n\
         | body | promise | 1 % | 10 % | 30 % | 60 % |\n|---|---|---:|---:|---:|---:|\n{rows}"
    );
    Ok(())
}

/// A load under which about this part of the nodes is in contact. Where nodes may leave, not every number of them has a
/// load.
fn load_at(solver: &mut FixedLoadSolver, fraction: f64) -> Result<f64, Error> {
    let mut solution = solver.solve_target(ContactTarget::MeanGap(1.0))?;
    for _ in 0..20 {
        let ratio = fraction / solution.contact.contact_area_fraction;
        if (ratio - 1.0).abs() < 0.01 {
            break;
        }
        // Full contact is far from a proportion.
        let load = solution.contact.load * ratio.powf(if fraction > 0.5 { 1.3 } else { 1.1 });
        solution = solver.solve(load)?;
    }
    Ok(solution.contact.load)
}

/// Steps and convolutions of a single load, and of a stretch of the path from there.
fn load_and_stretch(
    surface: &SelfAffine,
    kernel: &dyn InfluenceKernel,
    solver: &mut FixedLoadSolver,
    fraction: f64,
) -> Result<[String; 2], Error> {
    let grid = kernel.grid();
    let load = load_at(solver, fraction)?;
    let solution = solver.solve(load)?;
    let load = solution.effort.convolutions.to_string();
    let nodes = (0..grid.nodes()).filter(|&node| solution.fields.contact_map.as_slice()[node]);
    let history: History = (1..)
        .zip(nodes)
        .map(|(count, node)| {
            let mut contact = solution.contact;
            contact.contact_nodes = count;
            LoadingState::new(count, ContactEvent::Touch, grid.coordinates(node), contact)
        })
        .collect();
    let mut path = LoadingSolver::builder(surface, kernel)
        .updater(ConjugateGradient::new())
        .resume(&history)?;
    let before = path.convolutions().unwrap_or_default();
    path.by_ref().take(STRETCH).try_for_each(|state| state.map(drop))?;
    // The events of the last window are all computed.
    let events = (STRETCH + path.waiting()) as f64;
    let convolutions = (path.convolutions().unwrap_or_default() - before) as f64 / events;
    let timings = path.timings();
    let path = match timings.taken_back {
        0 => format!("{convolutions:.2}"),
        windows => format!("{convolutions:.2} ({windows} taken back)"),
    };
    Ok([load, path])
}

/// Area and stiffness of a rough surface on steel with a soft coat, none, and a stiff one.
fn coats(directory: &Path, text: &mut String) -> Result<PathBuf, Failure> {
    let failed = |error: Error| Failure::new("cannot follow a path", error);
    let n = 128;
    let grid = Grid::square(n, 1e-3).map_err(|error| failed(error.into()))?;
    let amplitude = asperity::surface::Amplitude::RmsHeight(1e-6);
    let surface = SelfAffine::new(0.8, 0.25e-3, 8.0 * grid.dx(), amplitude, 1)
        .map_err(|error| failed(error.into()))?;
    let h = 20e-6;
    let e_star = plane_strain_modulus(210e9, 0.3).map_err(failed)?;
    let plain: Box<dyn InfluenceKernel> = Box::new(Boussinesq::new(grid, e_star).map_err(failed)?);
    let coated = |youngs_modulus: f64| -> Result<Box<dyn InfluenceKernel>, Error> {
        Ok(Box::new(Layered::free(grid, one_layer(youngs_modulus, 0.3, h, STEEL)?)?))
    };
    let bodies = [
        ("soft coat, 21 GPa", ORANGE, coated(21e9).map_err(failed)?),
        ("no coat, 210 GPa", GREY, plain),
        ("stiff coat, 2.1 TPa", BLUE, coated(2.1e12).map_err(failed)?),
    ];
    let (mut areas, mut stiffnesses) = (Vec::new(), Vec::new());
    let _ = write!(
        text,
        "\n**Coats on steel.** A self-affine surface of {n} × {n} nodes on 1 mm × 1 mm (Sq 1 µm, shortest wavelength 8 \
         cells) against steel with a coat of 20 µm, 2.6 cells, to 30 % contact:\n\n\
         | body | nodes that left | load at 10 % | K_i there |\n|---|---:|---:|---:|\n"
    );
    for (name, colour, kernel) in bodies {
        let start = Instant::now();
        let builder = LoadingSolver::builder(&surface, &kernel).max_area_fraction(0.3);
        let path = builder.build().map_err(failed)?;
        let states: Vec<LoadingState> = path.collect::<Result<_, _>>().map_err(failed)?;
        eprintln!("{name}: {:.1} s", start.elapsed().as_secs_f64());
        let left = states.iter().filter(|state| state.event == ContactEvent::Release).count();
        let history: History = states.iter().copied().collect();
        if let Some(state) = history.at_area_fraction(0.1) {
            let _ = writeln!(
                text,
                "| {name} | {left} | {:.2} kN | {:.3} GN/m |",
                state.contact.load / 1e3,
                state.contact.interfacial_stiffness.unwrap_or(f64::NAN) / 1e9
            );
        }
        let loaded = states.iter().filter(|state| state.contact.load > 1.0);
        let loaded: Vec<LoadingState> = loaded.copied().collect();
        let area = |state: &LoadingState| (state.contact.load, state.contact.contact_area_fraction);
        let stiffness = |state: &LoadingState| {
            (state.contact.load, state.contact.contact_stiffness.unwrap_or(f64::NAN))
        };
        areas.push(Series::new(name, colour, Style::Line, loaded.iter().map(area)));
        stiffnesses.push(Series::new(name, colour, Style::Line, loaded.iter().map(stiffness)));
    }
    let load = || Axis::logarithmic("load W", "N", 1.0, 1e5);
    let charts = [
        Chart {
            title: "20 µm on steel: contact area".to_string(),
            x: load(),
            y: Axis::plain_logarithmic("contact area over nominal area", 1e-4, 0.5),
            series: areas,
            legend: Corner::BottomRight,
        },
        Chart {
            title: "contact stiffness".to_string(),
            x: load(),
            y: Axis::logarithmic("dW/dδ", "N/m", 1e6, 1e9),
            series: stiffnesses,
            legend: Corner::BottomRight,
        },
    ];
    let picture = chart::draw(&charts, 2, &directory.join("layers.png"))?;
    Ok(picture)
}
