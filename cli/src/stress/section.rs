//! `section_x.png`, `section_y.png` and `stress.vti`: the stresses at evenly spaced depths.

use std::path::{Path, PathBuf};

use asperity::Grid;
use asperity::kernel::Base;
use asperity::stress::Measure;
use asperity_cli::field_map::{FieldMap, Scale};
use asperity_cli::number::quantity;
use asperity_cli::outcome::Failure;
use nalgebra::DMatrix;

use super::body::{Body, Moment};
use super::progress::Progress;

/// Depths of a section.
const DEPTHS: usize = 60;
/// How deep a section is, in depths of the greatest stress and at least in cells, and how wide in depths of its own.
const DEEP: f64 = 4.0;
const LEAST: f64 = 8.0;
const WIDE: f64 = 3.0;

/// A vertical section through the place of the greatest stress.
struct Section {
    /// First node and number of nodes along it.
    first: usize,
    nodes: usize,
    /// Width of a node.
    width: f64,
    /// Stresses, along the section and from the lowest depth up.
    values: DMatrix<f64>,
}

impl Section {
    /// About a node of a side, so deep.
    fn new((at, nodes): (usize, usize), width: f64, deep: f64) -> Self {
        let half = (0.5 * WIDE * deep / width).ceil().max(1.0) as usize;
        let first = at.saturating_sub(half);
        let end = (at + half + 1).min(nodes);
        let values = DMatrix::zeros(end - first, DEPTHS);
        Self { first, nodes: end - first, width, values }
    }

    fn put(&mut self, row: usize, stress: impl Fn(usize) -> f64) {
        for k in 0..self.nodes {
            self.values[(k, row)] = stress(self.first + k);
        }
    }
}

/// How deep sections and the volume reach \[m\].
fn reach(moment: &Moment, body: &Body) -> f64 {
    let depth = body.survey.greatest(Measure::VonMises).depth;
    let deep = (DEEP * depth).max(LEAST * moment.record.grid().cell_area().sqrt());
    // There is no stress in a rigid base.
    let layers = body.below.layers().filter(|layers| layers.base() == Base::Rigid);
    layers.map_or(deep, |layers| deep.min(layers.thickness()))
}

/// The distance of so many depths that reach down to one.
fn step(deep: f64, depths: usize) -> f64 {
    let steps = depths.saturating_sub(1).max(1) as f64;
    let mut step = deep / steps;
    // Not below it by rounding, where a rigid base may be.
    while step * steps > deep {
        step = step.next_down();
    }
    step
}

/// Writes the stresses at so many depths for `ParaView`.
pub(super) fn write_volume(
    moment: &Moment,
    body: &Body,
    depths: usize,
    file: PathBuf,
) -> Result<PathBuf, Failure> {
    let progress = Progress::new();
    let step = step(reach(moment, body), depths);
    body.below
        .write_volume(&moment.pressure, (step, depths), &file, |field| progress.passed(field.depth))
        .map_err(|error| Failure::writing(&file, error))?;
    Ok(file)
}

/// Draws both sections.
pub(super) fn draw(
    moment: &Moment,
    body: &Body,
    directory: &Path,
) -> Result<Vec<PathBuf>, Failure> {
    let grid = moment.record.grid();
    let greatest = body.survey.greatest(Measure::VonMises);
    let (ix, iy) = greatest.node;
    let deep = reach(moment, body);
    let step = step(deep, DEPTHS);
    let mut along_x = Section::new((ix, grid.nx()), grid.dx(), deep);
    let mut along_y = Section::new((iy, grid.ny()), grid.dy(), deep);
    let progress = Progress::new();
    for k in 0..DEPTHS {
        let field = body.below.at_depth(&moment.pressure, k as f64 * step);
        let field = field.map_err(|error| Failure::new("cannot compute a section", error))?;
        let at = |ix: usize, iy: usize| {
            let stress = field.at(grid.index(ix, iy)).unwrap_or_default();
            stress.von_mises()
        };
        along_x.put(DEPTHS - 1 - k, |k| at(k, iy));
        along_y.put(DEPTHS - 1 - k, |k| at(ix, k));
        progress.passed(field.depth);
    }
    let mut written = Vec::new();
    let (x, y) = grid.position(ix, iy);
    let at = |x: f64, y: f64| format!("({}, {})", quantity(x, "m", 4), quantity(y, "m", 4));
    for (section, along, middle) in [(&along_x, "x", ix), (&along_y, "y", iy)] {
        let failed = |error| Failure::new("cannot draw a section", error);
        let rows = Grid::new(section.nodes, DEPTHS, section.width, step).map_err(failed)?;
        let map = FieldMap {
            grid: &rows,
            length_unit: "m",
            values: &section.values,
            range: (0.0, greatest.value.max(section.values.max())),
            scale: Scale::Linear,
            contours: &[],
            label: ("von Mises' stress", "Pa"),
        };
        // From the greatest stress.
        let start = (section.first as f64 - middle as f64 - 0.5) * section.width;
        let load = quantity(moment.state.contact.load, "N", 4);
        let caption = format!("W = {load}, along {along} below {}", at(x, y));
        let name = directory.join(format!("section_{along}.png"));
        let axis = format!("{along} from there");
        written.push(map.write_section(&name, &caption, (&axis, start))?);
    }
    Ok(written)
}
