//! `contact_map.png`: the nodes in contact, coloured by pressure.

use std::path::{Path, PathBuf};

use asperity::Grid;
use nalgebra::DMatrix;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::Solver;
use super::job::Job;
use asperity_cli::axis::Axis;
use asperity_cli::number::quantity;
use asperity_cli::outcome::Failure;
use asperity_cli::panel::{Area, Drawn, Panel, anchor, shade};
use asperity_cli::picture;

/// Pixels along the longer side of the map, about.
const SIDE: f64 = 860.0;
/// Pixels a side of the map has at least.
const SHORTEST: i32 = 60;
/// Pixels along x that the caption needs.
const CAPTION: i32 = 640;
const FONT: i32 = 20;
const MARGIN: Margin = Margin {
    left: 130,
    right: 200,
    top: 80,
    bottom: 100,
};
/// Pressures below zero, which only the paper's rule gives.
const TENSION: RGBColor = RGBColor(230, 0, 0);

struct Margin {
    left: i32,
    right: i32,
    top: i32,
    bottom: i32,
}

/// Draws the present state of a path into a directory.
pub(super) fn draw(job: &Job, solver: &mut Solver, directory: &Path) -> Result<PathBuf, Failure> {
    let name = directory.join("contact_map.png");
    let pressure = solver
        .pressure()
        .map_err(|error| Failure::new("no pressure for the map", error))?;
    let contact = solver.contact_map();
    let caption = solver.state().map_or_else(String::new, |state| {
        format!(
            "{} nodes in contact, A/A₀ = {:.2} %, W = {}",
            state.contact_nodes,
            100.0 * state.contact_area_fraction,
            quantity(state.load, "N", 4)
        )
    });

    let (width, height) = map_size(&job.grid());
    let inner = (CAPTION - MARGIN.left - MARGIN.right).max(width);
    let size = (
        inner + MARGIN.left + MARGIN.right,
        height + MARGIN.top + MARGIN.bottom,
    );
    let map = Map {
        grid: job.grid(),
        pressure,
        contact,
        panel: Panel {
            left: MARGIN.left + (inner - width) / 2,
            top: MARGIN.top,
            width,
            height,
            font: FONT,
            stroke: 1,
            text_rise: 0.2,
        },
    };
    picture::draw(&name, size, |area| map.draw(area, &caption))
}

/// Pixels of the map: whole ones for each node if there are enough, in the proportions of the
/// nominal area.
fn map_size(grid: &Grid) -> (i32, i32) {
    let (lx, ly) = grid.sides();
    let pixels = |side: f64, nodes: usize| {
        let exact = SIDE * side / lx.max(ly);
        let nodes = nodes as f64;
        let whole = (exact / nodes).round().max(1.0) * nodes;
        let pixels = if whole < 1.2 * SIDE && nodes <= exact {
            whole
        } else {
            exact
        };
        (pixels.round() as i32).max(SHORTEST)
    };
    (pixels(lx, grid.nx()), pixels(ly, grid.ny()))
}

struct Map {
    grid: Grid,
    pressure: DMatrix<f64>,
    contact: DMatrix<bool>,
    panel: Panel,
}

impl Map {
    fn draw<DB: DrawingBackend>(&self, area: &Area<DB>, caption: &str) -> Drawn<DB> {
        let panel = &self.panel;
        // The middle of the picture is further right than that of the map.
        let free = (area.dim_in_pixel().0 as i32 - CAPTION) / 2;
        let middle = (panel.left + panel.width / 2).min(CAPTION / 2 + free);
        let middle = (middle, MARGIN.top / 2);
        panel.write(
            area,
            caption,
            middle,
            FONT + 2,
            anchor(HPos::Center, VPos::Center),
        )?;

        let greatest = self.pressure.iter().copied().fold(0.0, f64::max);
        let pixels = self.pixels();
        for (place, value) in (0_i32..).zip(pixels) {
            let Some(value) = value else { continue };
            let at = (
                panel.left + place % panel.width,
                panel.top + panel.height - 1 - place / panel.width,
            );
            area.draw_pixel(at, &colour(value, greatest))?;
        }
        let (lx, ly) = self.grid.sides();
        // One unit for both axes, that of the longer side.
        let longer = lx.max(ly);
        let [x, y] = [("x", lx), ("y", ly)].map(|(name, side)| {
            let excess = (longer - side) / longer;
            let axis = Axis::linear(name, "m", 0.0, longer);
            axis.with_room(0.0, -excess)
        });
        panel.frame(area, &x, &y)?;
        if greatest > 0.0 {
            self.colour_bar(area, greatest)?;
        }
        area.present()
    }

    /// The greatest pressure of the contact nodes that fall on each pixel, row by row from the
    /// lower left corner: however many nodes share a pixel, no contact is lost.
    fn pixels(&self) -> Vec<Option<f64>> {
        let (width, height) = (self.panel.width as usize, self.panel.height as usize);
        let (nx, ny) = self.grid.shape();
        let span = |node: usize, nodes: usize, pixels: usize| {
            let first = node * pixels / nodes;
            first..((node + 1) * pixels / nodes).max(first + 1)
        };
        let mut pixels = vec![None; width * height];
        for iy in 0..ny {
            for ix in 0..nx {
                if !self.contact[(ix, iy)] {
                    continue;
                }
                let value = self.pressure[(ix, iy)];
                for row in span(iy, ny, height) {
                    for column in span(ix, nx, width) {
                        let pixel: &mut Option<f64> = &mut pixels[column + width * row];
                        *pixel = Some(pixel.map_or(value, |other| other.max(value)));
                    }
                }
            }
        }
        pixels
    }

    fn colour_bar<DB: DrawingBackend>(&self, area: &Area<DB>, greatest: f64) -> Drawn<DB> {
        let bar = Panel {
            left: self.panel.left + self.panel.width + 28,
            width: 26,
            ..self.panel
        };
        let tension = self.pressure.iter().any(|p| *p < -1e-9 * greatest);
        bar.colour_bar(area, &Axis::linear("pressure", "Pa", 0.0, greatest))?;
        if tension {
            let at = (bar.left + bar.width, bar.top - FONT);
            let pos = anchor(HPos::Right, VPos::Center);
            area.draw(&Rectangle::new(
                [(at.0 + 8, at.1 - 8), (at.0 + 24, at.1 + 8)],
                TENSION.filled(),
            ))?;
            bar.write(area, "below 0", at, FONT, pos)?;
        }
        Ok(())
    }
}

/// Colour of a pressure.
fn colour(value: f64, greatest: f64) -> RGBColor {
    if value < -1e-9 * greatest {
        return TENSION;
    }
    let share = if greatest > 0.0 {
        value / greatest
    } else {
        0.0
    };
    shade(share)
}
