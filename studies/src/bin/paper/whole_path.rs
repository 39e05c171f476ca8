//! The path of every node of a mesh, from the file that `asperity path` writes.

use std::path::{Path, PathBuf};

use asperity::contact::ContactSequence;
use asperity::{Boussinesq, Grid, HeightMap, InfluenceKernel};

use crate::run::{GREATEST_LOAD, Point, Run, corrected_areas};
use crate::study::Study;
use crate::surfaces::{E_STAR, NOMINAL_AREA, Rough, SQ, grid};
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLUE, Chart, Corner, GREY, ORANGE, Series, Style};
use asperity_cli::outcome::Failure;

/// What the file holds, in SI units and with E* = 1 Pa.
const COLUMNS: [&str; 12] = [
    "step",
    "ix",
    "iy",
    "approach",
    "load",
    "contact_area",
    "contact_area_fraction",
    "mean_gap",
    "contact_stiffness",
    "interfacial_stiffness",
    "corrected_contact_area",
    "approach_error",
];
/// Agreement with the surface: the file has all digits, sums of heights may round.
const SAME: f64 = 1e-9;

type Row = (usize, usize, usize, f64, f64, f64, f64, f64, f64, f64, f64, f64);

/// The path of Table 1, seed 1, to full contact.
pub(crate) struct WholePath {
    pub(crate) mesh: usize,
    /// Nodes in contact at which the paths of the figures end.
    pub(crate) path_nodes: usize,
    pub(crate) gradient: f64,
    pub(crate) run: Run,
    /// Against the fixed loads of the study, if they are of the same mesh.
    pub(crate) against: Option<Against>,
    pub(crate) picture: PathBuf,
}

/// Greatest relative differences from fixed loads.
pub(crate) struct Against {
    pub(crate) loads: usize,
    pub(crate) greatest: f64,
    pub(crate) approach: f64,
    pub(crate) mean_gap: f64,
    pub(crate) stiffness: f64,
    pub(crate) area: f64,
}

impl WholePath {
    /// Reads the file, checks that it is what it should be, and draws it.
    pub(crate) fn new(name: &Path, study: &Study, directory: &Path) -> Result<Self, Failure> {
        eprintln!("the whole path: {}", name.display());
        let wrong = |what: String| Failure::request(format!("{}: {what}", name.display()));
        let failed = |error: asperity::Error| Failure::new("the surface of the whole path", error);
        let rows = read(name)
            .map_err(|error| Failure::new(format!("cannot read {}", name.display()), error))?;
        let mesh = (rows.len() as f64).sqrt().round() as usize;
        if mesh * mesh != rows.len() {
            return Err(wrong(format!(
                "{} states are not those of all nodes of a square",
                rows.len()
            )));
        }
        let grid = grid(mesh).map_err(failed)?;
        let heights = Rough::Table1.heights(&grid, 1).map_err(failed)?;
        let contact = check(&rows, grid, &heights).map_err(wrong)?;
        let areas = corrected_areas(&contact);
        // First touch carries no load and divides nothing.
        let points = rows.iter().zip(&areas).skip(1);
        let points = points.map(|(row, area)| point(row, *area)).collect();
        let run = Run { rough: Rough::Table1, seed: 1, points };
        let gradient = Rough::Table1.gradient(mesh).map_err(failed)?;
        Ok(Self {
            mesh,
            path_nodes: study.path_nodes,
            gradient,
            against: against(&run, mesh, study),
            picture: draw(&run, gradient, directory)?,
            run,
        })
    }
}

fn read(name: &Path) -> Result<Vec<Row>, csv::Error> {
    let mut reader = csv::Reader::from_path(name)?;
    let header = reader.headers()?;
    if header.iter().ne(COLUMNS) {
        let text = format!("the columns are {header:?} and not {COLUMNS:?}");
        return Err(std::io::Error::other(text).into());
    }
    reader.deserialize().collect()
}

/// The order of contact, if the states are those of every node of this surface, one after the other.
fn check(rows: &[Row], grid: Grid, heights: &HeightMap) -> Result<ContactSequence, String> {
    let (mut approach, mut load) = (0.0, 0.0);
    for (place, row) in rows.iter().enumerate() {
        let (step, ix, iy) = (row.0, row.1, row.2);
        if step != place + 1 || ix >= grid.nx() || iy >= grid.ny() {
            return Err(format!("line {} has step {step} at ({ix}, {iy})", place + 2));
        }
        if row.3 < approach || row.4 < load {
            return Err(format!("approach or load falls at step {step}"));
        }
        (approach, load) = (row.3, row.4);
    }
    let order = rows.iter().map(|row| row.1 + grid.nx() * row.2);
    let contact = ContactSequence::with_order(grid, order).map_err(|error| error.to_string())?;
    let expected = heights.max_height() - heights.mean_height();
    let Some(first) = rows.first() else {
        return Err("there are no states".to_string());
    };
    if heights.matrix()[(first.1, first.2)] != heights.max_height()
        || (first.7 / expected - 1.0).abs() > SAME
    {
        return Err(format!(
            "it begins at ({}, {}) with a mean gap of {:e} m: not the surface of Table 1, seed 1, whose initial mean gap is \
             {expected:e} m",
            first.1, first.2, first.7
        ));
    }
    // The stiffness of a single cell.
    let kernel = Boussinesq::new(grid, E_STAR).map_err(|error| error.to_string())?;
    let single = grid.cell_area() / kernel.coefficient(0, 0);
    if (first.8 / single - 1.0).abs() > SAME {
        return Err(format!(
            "it begins with a stiffness of {:e} N/m, and not with {single:e} N/m: another modulus, or a periodic half-space",
            first.8
        ));
    }
    Ok(contact)
}

fn point(row: &Row, corrected_area: f64) -> Point {
    let force = NOMINAL_AREA * E_STAR;
    Point {
        load: row.4 / force,
        area: row.6,
        corrected: corrected_area / NOMINAL_AREA,
        approach: row.3 / SQ,
        mean_gap: row.7 / SQ,
        contact_stiffness: row.8 * SQ / force,
        interfacial_stiffness: row.9 * SQ / force,
        event: true,
    }
}

/// The differences from the fixed loads of the same surface on the same mesh.
fn against(run: &Run, mesh: usize, study: &Study) -> Option<Against> {
    let family = study.families.iter().find(|f| f.rough == run.rough)?;
    let other = family.runs.iter().find(|other| other.seed == run.seed)?;
    if study.nodes != mesh {
        return None;
    }
    let mut found = Against {
        loads: 0,
        greatest: 0.0,
        approach: 0.0,
        mean_gap: 0.0,
        stiffness: 0.0,
        area: 0.0,
    };
    for fixed in other.points.iter().filter(|point| !point.event) {
        let path = run.at_load(fixed.load)?;
        let off = |value: fn(&Point) -> f64| (value(&path) / value(fixed) - 1.0).abs();
        found.loads += 1;
        found.greatest = fixed.load;
        found.approach = found.approach.max(off(|p| p.approach));
        found.mean_gap = found.mean_gap.max(off(|p| p.mean_gap));
        found.stiffness = found.stiffness.max(off(|p| p.contact_stiffness));
        found.area = found.area.max(off(|p| p.area));
    }
    (found.loads > 0).then_some(found)
}

fn draw(run: &Run, gradient: f64, directory: &Path) -> Result<PathBuf, Failure> {
    let loads = (1e-8, 2.0);
    let load = || Axis::plain_logarithmic("load W / A₀E*", loads.0, loads.1);
    let series = |name, colour, value: &dyn Fn(&Point) -> (f64, f64)| {
        Series::new(name, colour, Style::Line, run.points.iter().map(value))
    };
    // Many points: those outside the axes are left out.
    let upright = |at: f64, from: f64, to: f64| {
        let heights = (0..=400).map(move |k| from * (to / from).powf(f64::from(k) / 400.0));
        let points = heights.map(move |y| (at, y));
        Series::new("W = 0.1 A₀E*", GREY, Style::Dashed, points)
    };
    let area = run.at_load(GREATEST_LOAD).map_or(1.0, |point| point.area);
    let charts = [
        Chart {
            title: "Fig. 5: contact area".to_string(),
            x: load(),
            y: Axis::plain_logarithmic("A / A₀", 3e-6, 2.0),
            series: vec![
                series("A / A₀", BLUE, &|p| (p.load, p.area)),
                upright(GREATEST_LOAD, 3e-6, 2.0),
            ],
            legend: Corner::TopLeft,
        },
        Chart {
            title: "Fig. 6: ratio of area to load".to_string(),
            x: Axis::plain_logarithmic("A / A₀", 1e-5, 1.0),
            y: Axis::plain("k = A E* h′ / W", 0.0, 5.0),
            series: vec![
                series("cells counted", BLUE, &|p| (p.area, p.ratio(gradient))),
                series("corrected for the staircase", ORANGE, &|p| {
                    (p.area, p.corrected_ratio(gradient))
                }),
                upright(area, 1e-3, 5.0),
            ],
            legend: Corner::BottomLeft,
        },
        Chart {
            title: "Fig. 7: approach and contact stiffness".to_string(),
            x: load(),
            y: Axis::plain_logarithmic("δ / Sq;  K Sq / A₀E*", 1e-5, 1e3),
            series: vec![
                series("approach δ / Sq", BLUE, &|p| (p.load, p.approach)),
                series("contact stiffness K Sq / A₀E*", ORANGE, &|p| {
                    (p.load, p.contact_stiffness)
                }),
                upright(GREATEST_LOAD, 1e-5, 1e3),
            ],
            legend: Corner::TopLeft,
        },
        Chart {
            title: "Fig. 8: mean gap and interfacial stiffness".to_string(),
            x: load(),
            y: Axis::plain_logarithmic("ḡ / Sq;  Kᵢ Sq / A₀E*", 1e-6, 1e4),
            series: vec![
                series("mean gap ḡ / Sq", BLUE, &|p| (p.load, p.mean_gap)),
                series("interfacial stiffness Kᵢ Sq / A₀E*", ORANGE, &|p| {
                    (p.load, p.interfacial_stiffness)
                }),
                upright(GREATEST_LOAD, 1e-6, 1e4),
            ],
            legend: Corner::TopLeft,
        },
    ];
    chart::draw(&charts, 2, &directory.join("whole_path.png"))
}
