//! Stresses below the surface against closed forms, on finer and finer meshes.
//!
//! ```text
//! cargo run --release -p asperity-studies --bin stress -- --report docs/validation.md
//! ```

use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use asperity::convolution::Convolution;
use asperity::stress::{Measure, Stress, Subsurface};
use asperity::{Boundary, Boussinesq, Error, Grid, PeriodicBoussinesq, Spectral};
use asperity_cli::outcome::Failure;
use asperity_studies::golden;
use asperity_studies::page::Section;
use asperity_studies::study;
use clap::Parser;
use nalgebra::DMatrix;

/// What tamaas found: `peers/stress.py`.
const TAMAAS: &str = include_str!("peers/stress.csv");

const POISSON: f64 = 0.3;
/// Cells in the radius, or in half the width, of the contact.
const CELLS: [usize; 2] = [8, 64];

/// Stresses below the surface.
#[derive(Debug, Parser)]
#[command(name = "stress")]
struct Options {
    /// Also write the section of this page
    #[arg(long, value_name = "FILE.md")]
    report: Option<PathBuf>,

    /// Nodes along each side of the grid that is timed
    #[arg(long, value_name = "N", default_value_t = 512)]
    nodes: usize,
}

fn main() -> ExitCode {
    study::main(run)
}

fn run(options: &Options) -> Result<(), Failure> {
    let failed = |error: Error| Failure::new("cannot compute stresses", error);
    let mut text = String::from("## Stress below the surface\n\nStudy `stress`.\n");
    let lines = tamaas()?;
    meshes(&mut text, &lines).map_err(failed)?;
    waves(&mut text).map_err(failed)?;
    let section = Section { study: "stress", text: &text, pictures: &[] };
    section.show(options.report.as_deref())?;
    println!("{}", times(options.nodes).map_err(failed)?);
    Ok(())
}

/// √(1 − x²) over a cell about x.
fn of_line(x: f64, width: f64) -> f64 {
    let integral = |x: f64| {
        let x = x.clamp(-1.0, 1.0);
        0.5 * (x * (1.0 - x * x).sqrt() + x.asin())
    };
    (integral(x + 0.5 * width) - integral(x - 0.5 * width)) / width
}

/// √(1 − x² − y²) over cells of the width 1/`cells`, `reach` of them on either side of the middle one.
fn of_sphere(cells: usize, reach: usize) -> Result<(Grid, DMatrix<f64>), Error> {
    const PARTS: usize = 32;
    let (n, width) = (2 * reach + 1, 1.0 / cells as f64);
    let pressure = DMatrix::from_fn(n, n, |ix, iy| {
        let at = |i: usize| (i as f64 - reach as f64) * width;
        // Exact along x, and midpoints along y.
        let rows = (0..PARTS).map(|k| {
            let y = at(iy) + ((k as f64 + 0.5) / PARTS as f64 - 0.5) * width;
            let a = (1.0 - y * y).max(0.0).sqrt();
            if a > 0.0 { a * of_line(at(ix) / a, width / a) } else { 0.0 }
        });
        rows.sum::<f64>() / PARTS as f64
    });
    Ok((Grid::new(n, n, width, width)?, pressure))
}

/// A row of a table: what is compared, with its errors on all meshes.
struct Row {
    what: &'static str,
    errors: Vec<f64>,
}

/// A node at a depth by tamaas: version, nodes along a side, depth, node, and the components.
type Line = (String, usize, f64, usize, usize, f64, f64, f64, f64, f64, f64);

fn tamaas() -> Result<Vec<Line>, Failure> {
    let lines: Result<Vec<Line>, csv::Error> =
        csv::Reader::from_reader(TAMAAS.as_bytes()).into_deserialize().collect();
    lines.map_err(|error| Failure::new("cannot read stress.csv", error))
}

/// Hertz's pressure that repeats every 4 radii, smoothed as in `peers/stress.py`.
fn of_periodic_sphere(n: usize) -> DMatrix<f64> {
    let at = |i: usize| (i as f64 - (n / 2) as f64) * 4.0 / n as f64;
    let sharp =
        DMatrix::from_fn(n, n, |ix, iy| (1.0 - at(ix) * at(ix) - at(iy) * at(iy)).max(0.0).sqrt());
    let around = |i: usize| [(0.25, (i + n - 1) % n), (0.5, i), (0.25, (i + 1) % n)];
    DMatrix::from_fn(n, n, |ix, iy| {
        let pairs = around(ix).into_iter().flat_map(|x| around(iy).map(|y| (x, y)));
        pairs.map(|((a, ix), (b, iy))| a * b * sharp[(ix, iy)]).sum()
    })
}

/// The greatest difference from tamaas of all components, for the waves of the grid and for uniform cells.
fn beside_tamaas(lines: &[Line], cells: usize) -> Result<[f64; 2], Error> {
    let n = 4 * cells;
    let (grid, pressure) = (Grid::square(n, 4.0)?, of_periodic_sphere(n));
    let bodies = [
        Subsurface::of(&Spectral::new(grid, 1.0)?, POISSON)?,
        Subsurface::new(grid, Boundary::Periodic, POISSON)?,
    ];
    let mut differences = [0.0_f64; 2];
    for (body, difference) in bodies.iter().zip(&mut differences) {
        let own: Vec<&Line> = lines.iter().filter(|line| line.1 == n).collect();
        for depth in own.chunk_by(|a, b| a.2 == b.2) {
            let field = body.at_depth(&pressure, depth[0].2)?;
            for &&(_, _, _, ix, iy, xx, yy, zz, yz, xz, xy) in depth {
                let found = field.components().map(|component| component[(ix, iy)]);
                for (found, theirs) in found.into_iter().zip([xx, yy, zz, yz, xz, xy]) {
                    *difference = difference.max((found - theirs).abs());
                }
            }
        }
    }
    Ok(differences)
}

fn meshes(text: &mut String, lines: &[Line]) -> Result<(), Error> {
    let mut rows = [
        "sphere, axis at 0.48 a: σrr, σzz",
        "sphere, greatest von Mises' stress, 0.6200 p₀",
        "sphere, its depth, 0.481 a",
        "sphere, greatest shear, 0.3100 p₀",
        "tension at 1.25 a on the surface",
        "sliding sphere, σxx at a/2 on the surface, over its traction",
        "cylinder, 0.786 a below the middle: σxx, σzz",
        "cylinder, greatest shear, 0.3003 p₀",
        "cylinder, its depth, 0.786 a",
        "tamaas, waves of the grid: all components",
        "tamaas, uniform cells: all components",
    ]
    .map(|what| Row { what, errors: Vec::new() });
    for cells in CELLS {
        let reach = cells + cells / 4;
        let (grid, pressure) = of_sphere(cells, reach)?;
        let body = Subsurface::new(grid, Boundary::Free, POISSON)?;
        let middle = |stress: Option<Stress>| stress.unwrap_or_default();
        let z = 0.48;
        let axis = middle(body.at_depth(&pressure, z)?.at(grid.nodes() / 2));
        let radial = -(1.0 + POISSON) * (1.0 - z * (1.0_f64 / z).atan()) + 0.5 / (1.0 + z * z);
        let survey = body.survey(&pressure, None)?;
        let von_mises = survey.greatest(Measure::VonMises);
        let shear = survey.greatest(Measure::GreatestShear);
        let surface = body.at_depth(&pressure, 0.0)?;
        let outside = surface.xx[(reach + cells + cells / 4, reach)];
        let none = DMatrix::zeros(grid.nx(), grid.ny());
        let pulled = body.under_traction((&none, 0.0), [&pressure, &none])?;
        let inside = pulled.xx[(reach + cells / 2, reach)];
        let hamilton = -std::f64::consts::PI * (4.0 + POISSON) / 16.0;
        let (exact, place) = sphere_maximum();

        let n = 2 * reach + 1;
        let line = Grid::new(n, 2, grid.dx(), grid.dx())?;
        let width = grid.dx();
        let load =
            DMatrix::from_fn(n, 2, |ix, _| of_line((ix as f64 - reach as f64) * width, width));
        let roller = Subsurface::new(line, Boundary::PeriodicY, POISSON)?;
        let z: f64 = 0.786;
        let below = middle(roller.at_depth(&load, z)?.at(reach));
        let root = (1.0 + z * z).sqrt();
        let (side, down) = (2.0 * z - (1.0 + 2.0 * z * z) / root, -1.0 / root);
        let rolling = roller.survey(&load, None)?.greatest(Measure::GreatestShear);
        let (line_exact, line_place) = line_maximum();
        let [of_waves, of_cells] = beside_tamaas(lines, cells)?;
        let found = [
            (axis.xx - radial).hypot(axis.zz + 1.0 / (1.0 + 0.48 * 0.48)),
            von_mises.value - exact,
            von_mises.depth - place,
            shear.value - 0.5 * exact,
            outside - (1.0 - 2.0 * POISSON) / 3.0 / (1.25 * 1.25),
            inside - hamilton,
            (below.xx - side).hypot(below.zz - down),
            rolling.value - line_exact,
            rolling.depth - line_place,
            of_waves,
            of_cells,
        ];
        rows.iter_mut().zip(found).for_each(|(row, error)| row.errors.push(error.abs()));
    }
    text.push_str(
        "\nErrors in units of p₀ and a, ν = 0.3, on cells of a part of the radius or half width a; pressures are \
         averages over cells. The order is that from the first mesh to the last. A maximum is flat: its place follows \
         from its value with the root of the error.\n\n| |",
    );
    for cells in CELLS {
        let _ = write!(text, " a/{cells} |");
    }
    text.push_str(" order |\n|---|---:|---:|---:|\n");
    for Row { what, errors } in &rows {
        let _ = write!(text, "| {what} |");
        for error in errors {
            let _ = write!(text, " {error:.1e} |");
        }
        // Roundings have no order.
        let order = (errors[0] / errors[1]).log2() / 3.0;
        let order = if errors[0] < 1e-12 { "–".to_string() } else { format!("{order:.1}") };
        let _ = writeln!(text, " {order} |");
    }
    let version = lines.first().map_or("", |line| &line.0);
    let _ = writeln!(
        text,
        "\nThe last two rows: tamaas {version} (`boussinesq_gradient` and `hooke`, `peers/stress.py`) has the waves of \
         the grid, as `Spectral`; the sphere's pressure repeats every 4a, at 27 places between 0.25 and 0.75 a deep."
    );
    Ok(())
}

/// The greatest difference of σzz and σrr on the axis of a sphere, and its depth, by golden section on the closed form.
fn sphere_maximum() -> (f64, f64) {
    let difference = |z: f64| {
        let radial = -(1.0 + POISSON) * (1.0 - z * (1.0 / z).atan()) + 0.5 / (1.0 + z * z);
        radial + 1.0 / (1.0 + z * z)
    };
    golden::greatest(difference, (0.2, 1.5))
}

/// Half of that of a cylinder.
fn line_maximum() -> (f64, f64) {
    let half = |z: f64| {
        let root = (1.0 + z * z).sqrt();
        0.5 * (2.0 * z - (1.0 + 2.0 * z * z) / root + 1.0 / root)
    };
    golden::greatest(half, (0.2, 1.5))
}

/// Waves of pressure on the waves of the grid, and on cells, whose pressures are steps.
fn waves(text: &mut String) -> Result<(), Error> {
    let (n, depth) = (64, 3.0);
    let grid = Grid::square(n, n as f64)?;
    let wave = Subsurface::of(&Spectral::new(grid, 1.0)?, POISSON)?;
    let cell = Subsurface::new(grid, Boundary::Periodic, POISSON)?;
    text.push_str("\nA wave of pressure against Westergaard's stresses, at a depth of three cells: greatest error of \
    all components.\n\n| cells to a wave | waves of the grid | uniform cells |\n|---:|---:|---:|\n");
    for k in [1, 8] {
        let q = std::f64::consts::TAU * f64::from(k) / n as f64;
        let load = DMatrix::from_fn(n, n, |ix, _| (q * ix as f64).cos());
        let fades = (-q * depth).exp();
        let error = |body: &Subsurface| -> Result<f64, Error> {
            let field = body.at_depth(&load, depth)?;
            let mut greatest = 0.0_f64;
            for ix in 0..n {
                let (cos, sin) = ((q * ix as f64).cos(), (q * ix as f64).sin());
                for (found, expected) in [
                    (field.xx[(ix, 0)], -(1.0 - q * depth) * fades * cos),
                    (field.yy[(ix, 0)], -2.0 * POISSON * fades * cos),
                    (field.zz[(ix, 0)], -(1.0 + q * depth) * fades * cos),
                    (field.xz[(ix, 0)], -q * depth * fades * sin),
                    (field.xy[(ix, 0)], 0.0),
                    (field.yz[(ix, 0)], 0.0),
                ] {
                    greatest = greatest.max((found - expected).abs());
                }
            }
            Ok(greatest)
        };
        let _ =
            writeln!(text, "| {} | {:.0e} | {:.1e} |", n as i32 / k, error(&wave)?, error(&cell)?);
    }
    Ok(())
}

/// Depths that are timed, in cells.
const DEPTHS: [f64; 5] = [0.1, 1.0, 3.0, 10.0, 50.0];

/// What a depth takes, in convolutions of displacements on the same grid.
fn times(n: usize) -> Result<String, Error> {
    let grid = Grid::square(n, n as f64)?;
    let pressure = DMatrix::from_fn(n, n, |ix, iy| {
        let is_in = (ix / 7 + iy / 5) % 3 == 0;
        if is_in { 1.0 + (0.01 * (ix * iy) as f64).sin() } else { 0.0 }
    });
    let one = |mut convolution: Convolution| -> Result<f64, Error> {
        let mut displacement = vec![0.0; grid.nodes()];
        let start = Instant::now();
        for _ in 0..20 {
            convolution.apply(pressure.as_slice(), &mut displacement)?;
        }
        Ok(start.elapsed().as_secs_f64() / 20.0)
    };
    let units = [
        one(Convolution::new(&Boussinesq::new(grid, 1.0)?)?)?,
        one(Convolution::new(&PeriodicBoussinesq::new(grid, 1.0)?)?)?,
    ];
    let mut taken: [Vec<String>; 2] = Default::default();
    let boundaries = [Boundary::Free, Boundary::Periodic].into_iter().zip(units);
    for ((boundary, unit), taken) in boundaries.zip(&mut taken) {
        for depth in DEPTHS {
            let body = Subsurface::new(grid, boundary, POISSON)?;
            let start = Instant::now();
            let greatest = body.at_depth(&pressure, depth)?.greatest();
            let time = start.elapsed().as_secs_f64();
            assert!(greatest[0].0 > 0.0, "there is a stress");
            taken.push(format!("{:.0}", time / unit));
        }
    }
    Ok(format!(
        "The time of one depth, all components and measures, in convolutions of displacements on the same {n} × {n} \
         nodes, {} cells deep: {} on a free grid, {} on a periodic one.",
        DEPTHS.map(|depth| depth.to_string()).join(", "),
        taken[0].join(", "),
        taken[1].join(", "),
    ))
}
