//! Fig. 3: plane contacts against their closed forms, eqs. (20) and (22).

use std::path::{Path, PathBuf};

use crate::plane::{Case, LENGTH, PlaneError};
use crate::table::write_csv;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{
    self, BLACK, BLUE, Chart, Corner, GREEN, GREY, ORANGE, PURPLE, Series, Style,
};
use asperity_cli::outcome::Failure;
use asperity_studies::line::Line;

/// The mesh of the paper: cells over the contact of the cylinder, or a wavelength.
pub(crate) const NODES: usize = 161;
/// Number of free waves in place of a periodic problem.
pub(crate) const WAVES: usize = 5;
const MESHES: [usize; 6] = [21, 41, 81, 161, 321, 641];
/// Lengths of the strip over the width of the domain.
const LENGTHS: [f64; 8] = [0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0];
const COUNTS: [usize; 6] = [1, 3, 5, 7, 11, 15];

const CASES: [Case; 7] = [
    Case::Cylinder,
    Case::Wave(0.5),
    Case::Wave(0.25),
    Case::Wave(0.125),
    Case::FreeWaves(0.5, WAVES),
    Case::FreeWaves(0.25, WAVES),
    Case::FreeWaves(0.125, WAVES),
];

/// What was found.
pub(crate) struct Figure3 {
    pub(crate) cases: Vec<Convergence>,
    /// (length of the strip over the domain, change of the pressure over p₀).
    pub(crate) lengths: Vec<(f64, f64)>,
    /// (number of free waves, inner error at half contact over p*).
    pub(crate) waves: Vec<(f64, f64)>,
    pub(crate) picture: PathBuf,
}

/// Errors of a case on finer and finer meshes.
pub(crate) struct Convergence {
    pub(crate) case: Case,
    pub(crate) errors: Vec<(usize, PlaneError)>,
    /// Orders of the inner and the rms error.
    pub(crate) orders: (f64, f64),
}

impl Convergence {
    fn new(case: Case) -> Result<Self, Failure> {
        let errors = MESHES.map(|nodes| Ok((nodes, case.error(nodes, LENGTH).map_err(failed)?)));
        let errors: Vec<_> = errors.into_iter().collect::<Result<_, Failure>>()?;
        let order = |value: fn(&PlaneError) -> f64| {
            let points: Vec<(f64, f64)> = errors
                .iter()
                .map(|(nodes, error)| ((*nodes as f64).ln(), value(error).ln()))
                .collect();
            -Line::fit(&points).slope
        };
        let orders = (order(|e| e.inner), order(|e| e.rms));
        Ok(Self { case, errors, orders })
    }

    /// The errors on the mesh of the paper.
    pub(crate) fn on_paper_mesh(&self) -> PlaneError {
        let found = self.errors.iter().find(|(nodes, _)| *nodes == NODES);
        found.map_or_else(PlaneError::default, |(_, error)| *error)
    }
}

fn failed(error: asperity::Error) -> Failure {
    Failure::new("a plane contact of Fig. 3", error)
}

/// Computes and draws the figure.
pub(crate) fn make(directory: &Path) -> Result<Figure3, Failure> {
    eprintln!("figure 3: plane contacts");
    let mut cases = Vec::new();
    for case in CASES {
        cases.push(Convergence::new(case)?);
    }
    let long = Case::Cylinder.profile(NODES, LENGTH).map_err(failed)?;
    let mut lengths = Vec::new();
    for length in LENGTHS {
        let profile = Case::Cylinder.profile(NODES, length).map_err(failed)?;
        let inner = profile.iter().zip(&long).filter(|(a, _)| a.0.abs() < 0.6);
        let change = inner.map(|(a, b)| (a.1 - b.1).abs()).fold(0.0, f64::max);
        lengths.push((length, change));
    }
    let mut waves: Vec<(f64, f64)> = Vec::new();
    for count in COUNTS {
        let case = Case::FreeWaves(0.25, count);
        let error = case.error(NODES, LENGTH).map_err(failed)?;
        waves.push((count as f64, error.inner));
    }
    write(directory, &cases, &lengths, &waves)?;
    let picture = draw(directory, &cases, &lengths, &waves)?;
    Ok(Figure3 { cases, lengths, waves, picture })
}

fn write(
    directory: &Path,
    cases: &[Convergence],
    lengths: &[(f64, f64)],
    waves: &[(f64, f64)],
) -> Result<(), Failure> {
    let mut rows = Vec::new();
    for case in CASES {
        for (x, computed, exact) in case.profile(NODES, LENGTH).map_err(failed)? {
            let numbers = [x, computed, exact].map(|value| value.to_string());
            rows.push([vec![case.name()], numbers.to_vec()].concat());
        }
    }
    let header = ["case", "x", "pressure", "closed_form"];
    write_csv(&directory.join("figure3_pressure.csv"), &header, rows.into_iter())?;
    let errors = cases.iter().flat_map(|convergence| {
        let name = convergence.case.name();
        convergence.errors.iter().map(move |(nodes, error)| {
            [name.clone(), nodes.to_string(), error.inner.to_string(), error.rms.to_string()]
        })
    });
    let lengths = lengths.iter().map(|(length, change)| {
        let name = "cylinder: change with the length of the strip over the domain".to_string();
        [name, length.to_string(), change.to_string(), String::new()]
    });
    let waves = waves.iter().map(|(count, error)| {
        let name = "free waves, half contact: their number".to_string();
        [name, count.to_string(), error.to_string(), String::new()]
    });
    write_csv(
        &directory.join("figure3_errors.csv"),
        &["case", "parameter", "inner_error", "rms_error"],
        errors.chain(lengths).chain(waves),
    )
}

fn draw(
    directory: &Path,
    cases: &[Convergence],
    lengths: &[(f64, f64)],
    waves: &[(f64, f64)],
) -> Result<PathBuf, Failure> {
    let mut pressures = Vec::new();
    let shown = [
        (Case::Cylinder, BLACK, "cylinder, p/p₀, x/a"),
        (Case::FreeWaves(0.5, WAVES), BLUE, "full contact, p/p*, 2x/λ"),
        (Case::FreeWaves(0.25, WAVES), ORANGE, "half contact"),
        (Case::FreeWaves(0.125, WAVES), GREEN, "quarter contact"),
    ];
    for (case, colour, name) in shown {
        let profile = case.profile(NODES, LENGTH).map_err(failed)?;
        let inside = profile.iter().filter(|(x, _, _)| x.abs() <= 1.0);
        let exact = inside.clone().map(|(x, _, exact)| (*x, *exact));
        pressures.push(Series::new(name, colour, Style::Line, exact));
        // Every fourth, so that the line is seen.
        let computed = inside.step_by(4).map(|(x, p, _)| (*x, *p));
        pressures.push(Series::new("", colour, Style::Dots, computed));
    }
    let pressure = Chart {
        title: "Closed forms (lines), computed, N = 161 (dots)".to_string(),
        x: Axis::plain("x", -1.0, 1.0),
        y: Axis::plain("pressure", 0.0, 2.9),
        series: pressures,
        legend: Corner::TopLeft,
    };

    let colours = [BLACK, BLUE, ORANGE, GREEN];
    let mut errors = Vec::new();
    for (convergence, colour) in cases.iter().zip(colours) {
        let name = convergence.case.name();
        let points = |value: fn(&PlaneError) -> f64| {
            let points = convergence.errors.iter();
            points.map(move |(n, e)| (*n as f64, value(e))).collect::<Vec<_>>()
        };
        errors.push(Series::new("", colour, Style::Line, points(|e| e.inner)));
        errors.push(Series::new(name, colour, Style::Dots, points(|e| e.inner)));
        if convergence.case != Case::Wave(0.5) {
            errors.push(Series::new("", colour, Style::Dashed, points(|e| e.rms)));
        }
    }
    let slope =
        |order: i32, at: f64| MESHES.map(|n| (n as f64, at * (21.0 / n as f64).powi(order)));
    errors.push(Series::new("orders 1 and 2", GREY, Style::Dashed, slope(1, 0.06)));
    errors.push(Series::new("", GREY, Style::Dashed, slope(2, 3e-4)));
    let mesh = Chart {
        title: "Error of the pressure: inner (dots), rms (dashed)".to_string(),
        x: Axis::plain_logarithmic("cells N over contact or wavelength", 18.0, 750.0),
        y: Axis::plain_logarithmic("error / p₀ or p*", 2e-7, 30.0),
        series: errors,
        legend: Corner::TopRight,
    };
    let length = Chart {
        title: "Cylinder: error from the length of the strip".to_string(),
        x: Axis::plain_logarithmic("length of the strip / width of the domain", 0.2, 40.0),
        y: Axis::plain_logarithmic("change of p/p₀, |x| < 0.6 a", 1e-7, 1e-1),
        series: vec![
            Series::new("measured", BLUE, Style::Dots, lengths.iter().copied()),
            Series::new(
                "order 2",
                GREY,
                Style::Dashed,
                lengths.iter().map(|(l, _)| (*l, lengths[4].1 * (4.0 / l).powi(2))),
            ),
        ],
        legend: Corner::TopRight,
    };
    let count = Chart {
        title: "Half contact: error from the number of free waves".to_string(),
        x: Axis::plain_logarithmic("number of waves (paper: 5)", 0.9, 17.0),
        y: Axis::plain_logarithmic("inner error / p*, N = 161", 1e-5, 1e-1),
        series: vec![
            Series::new("measured", PURPLE, Style::Dots, waves.iter().copied()),
            Series::new(
                "order 2",
                GREY,
                Style::Dashed,
                waves.iter().map(|(n, _)| (*n, waves[1].1 * (3.0 / n).powi(2))),
            ),
        ],
        legend: Corner::TopRight,
    };
    chart::draw(&[pressure, mesh, length, count], 2, &directory.join("figure3.png"))
}
