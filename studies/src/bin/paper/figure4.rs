//! Fig. 4: where the surface touches, and with what pressure.

use std::path::{Path, PathBuf};

use asperity::patches::{Connectivity, Patches};
use asperity::{Boundary, Boussinesq, FixedLoadSolver};
use nalgebra::DMatrix;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use crate::run::TOLERANCE;
use crate::study::{Family, Study};
use crate::surfaces::{E_STAR, NOMINAL_AREA, SIDE, grid};
use crate::table::write_csv;
use asperity_cli::axis::Axis;
use asperity_cli::outcome::Failure;
use asperity_cli::panel::{Area, Drawn, Panel, anchor, shade};
use asperity_cli::picture::{FINE, draw_fine};

/// Contact areas that are shown.
const AREAS: [f64; 4] = [0.01, 0.05, 0.15, 0.4];
/// Pixels a side of a map.
const MAP: i32 = 216;
const FONT: i32 = 14;
/// Pressures over E* h′ from which on the colour is the lightest and the darkest, evenly in the logarithm.
const SHADES: (f64, f64) = (0.1, 10.0);
/// Patches of fewer cells count as small.
const SMALL: usize = 10;

/// A map, and what its patches are like.
pub(crate) struct Map {
    pub(crate) surface: &'static str,
    pub(crate) load: f64,
    pub(crate) area: f64,
    /// Greatest pressure over E*, and over E* h′.
    pub(crate) greatest: f64,
    pub(crate) reduced: f64,
    /// Whether it is at the border of the square.
    pub(crate) at_border: bool,
    pub(crate) patches: usize,
    /// The fraction of patches with fewer than ten cells, and of the contact in them.
    pub(crate) small: f64,
    pub(crate) in_small: f64,
    /// The fraction of the contact in the largest tenth of the patches.
    pub(crate) in_large: f64,
    /// Pressure over E* h′.
    pressure: DMatrix<f64>,
}

pub(crate) struct Figure4 {
    pub(crate) maps: Vec<Map>,
    pub(crate) picture: PathBuf,
}

pub(crate) fn make(study: &Study, directory: &Path) -> Result<Figure4, Failure> {
    eprintln!("figure 4: contact maps");
    let mut maps = Vec::new();
    for family in &study.families {
        maps.extend(family_maps(study, family)?);
    }
    let rows = maps.iter().map(|map| {
        let numbers = [
            map.load,
            map.area,
            map.greatest,
            map.reduced,
            f64::from(u8::from(map.at_border)),
            map.patches as f64,
            map.small,
            map.in_small,
            map.in_large,
        ];
        let numbers = numbers.map(|n| n.to_string()).to_vec();
        [vec![map.surface.to_string()], numbers].concat()
    });
    write_csv(
        &directory.join("figure4.csv"),
        &[
            "surface",
            "load",
            "area",
            "greatest_pressure",
            "greatest_pressure_over_gradient",
            "greatest_at_border",
            "patches",
            "small_patches",
            "contact_in_small",
            "contact_in_largest_tenth",
        ],
        rows,
    )?;
    let picture = draw(&maps, &directory.join("figure4.png"))?;
    Ok(Figure4 { maps, picture })
}

fn family_maps(study: &Study, family: &Family) -> Result<Vec<Map>, Failure> {
    let failed = |error: asperity::Error| Failure::new("the maps of Fig. 4", error);
    let Some(run) = family.runs.first() else {
        return Ok(Vec::new());
    };
    let grid = grid(study.nodes).map_err(failed)?;
    let heights = family.rough.heights(&grid, run.seed).map_err(failed)?;
    let kernel = Boussinesq::new(grid, E_STAR).map_err(failed)?;
    let mut solver = FixedLoadSolver::builder(&heights, &kernel)
        .tolerance(TOLERANCE)
        .stiffness(false)
        .build()
        .map_err(failed)?;
    let mut maps = Vec::new();
    for area in AREAS {
        let Some(point) = run.at_area(area) else {
            continue;
        };
        let solution = solver.solve(point.load * NOMINAL_AREA * E_STAR).map_err(failed)?;
        let patches =
            Patches::new(&solution.fields.contact_map, &grid, Boundary::Free, Connectivity::Four)
                .map_err(failed)?;
        let mut sizes: Vec<usize> = patches.patches().iter().map(|patch| patch.nodes).collect();
        sizes.sort_unstable();
        let contact = sizes.iter().sum::<usize>() as f64;
        let small = sizes.partition_point(|size| *size < SMALL);
        let in_small = sizes[..small].iter().sum::<usize>() as f64;
        let tenth = sizes.len().div_ceil(10);
        let in_large = sizes[sizes.len() - tenth..].iter().sum::<usize>() as f64;
        maps.push(Map {
            surface: family.rough.name(),
            load: point.load,
            area: solution.contact.contact_area_fraction,
            greatest: solution.fields.max_pressure() / E_STAR,
            reduced: solution.fields.max_pressure() / (E_STAR * family.gradient),
            at_border: is_at_border(&solution.fields.pressure),
            patches: sizes.len(),
            small: small as f64 / sizes.len() as f64,
            in_small: in_small / contact,
            in_large: in_large / contact,
            pressure: solution.fields.pressure / (E_STAR * family.gradient),
        });
    }
    Ok(maps)
}

/// Whether a node of the border has the greatest value.
fn is_at_border(values: &DMatrix<f64>) -> bool {
    let (nx, ny) = values.shape();
    let (ix, iy) = values.iamax_full();
    ix == 0 || iy == 0 || ix + 1 == nx || iy + 1 == ny
}

fn draw(maps: &[Map], name: &Path) -> Result<PathBuf, Failure> {
    let columns = AREAS.len() as i32;
    let rows = (maps.len() as i32 + columns - 1) / columns;
    let (gap, left, right, top, bottom) = (34, 58, 70, 62, 56);
    let width = left + columns * (MAP + gap) + right;
    let height = rows * (MAP + top) + bottom;
    draw_fine(name, (width, height), |area| {
        for (place, map) in (0_i32..).zip(maps) {
            let (column, row) = (place % columns, place / columns);
            let panel = Panel {
                left: FINE * (left + column * (MAP + gap)),
                top: FINE * (top + row * (MAP + top)),
                width: FINE * MAP,
                height: FINE * MAP,
                font: FINE * FONT,
                stroke: FINE as u32,
                text_rise: 0.2,
            };
            map.draw(area, &panel, column == 0, row + 1 == rows)?;
        }
        let bar = Panel {
            left: FINE * (left + columns * (MAP + gap) - gap / 2),
            top: FINE * top,
            width: FINE * 16,
            height: FINE * (rows * (MAP + top) - top),
            font: FINE * FONT,
            stroke: FINE as u32,
            text_rise: 0.2,
        };
        let axis = Axis::plain_logarithmic("p / E*h′", SHADES.0, SHADES.1);
        bar.colour_bar(area, &axis, shade)
    })
}

impl Map {
    fn draw<DB: DrawingBackend>(
        &self,
        area: &Area<DB>,
        panel: &Panel,
        first: bool,
        last: bool,
    ) -> Drawn<DB> {
        let (nx, ny) = self.pressure.shape();
        for iy in 0..ny {
            for ix in 0..nx {
                let pressure = self.pressure[(ix, iy)];
                if pressure <= 0.0 {
                    continue;
                }
                let edge = |node: usize, nodes: usize| (panel.width as usize * node / nodes) as i32;
                let x = panel.left + edge(ix, nx);
                let y = panel.top + panel.height - edge(iy + 1, ny);
                let size = (edge(ix + 1, nx) - edge(ix, nx), edge(iy + 1, ny) - edge(iy, ny));
                let corners = [(x, y), (x + size.0, y + size.1)];
                area.draw(&Rectangle::new(corners, colour(pressure).filled()))?;
            }
        }
        panel.border(area)?;
        if first {
            panel.frame_left(area, &Axis::linear("y", "m", 0.0, SIDE))?;
        }
        if last {
            panel.frame_below(area, &Axis::linear("x", "m", 0.0, SIDE))?;
        }
        let title = |line: i32, text: String| {
            let at = (panel.left + panel.width / 2, panel.top - FINE * (30 - 18 * line));
            panel.write(area, &text, at, FINE * FONT, anchor(HPos::Center, VPos::Center))
        };
        title(0, self.surface.to_string())?;
        title(1, format!("A/A₀ = {:.1} %, W = {:.2e} A₀E*", 100.0 * self.area, self.load))
    }
}

/// The colour of a pressure over E* h′.
fn colour(pressure: f64) -> RGBColor {
    let (from, to) = SHADES;
    shade((pressure / from).ln() / (to / from).ln())
}
