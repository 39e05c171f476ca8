//! `unloading.svg`: the way there and back of a contact that yields.

use std::path::{Path, PathBuf};

use asperity::contact::ContactState;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{BLUE, ORANGE};
use asperity_cli::half_space::is_of_mean_planes;
use asperity_cli::number::quantity;
use asperity_cli::outcome::Failure;
use asperity_cli::panel::{Area, Drawn};
use plotters::prelude::*;

use super::job::Job;
use super::sheet;

/// A quantity of a state: its name, its unit, and what it is.
type Quantity = (&'static str, &'static str, fn(&ContactState) -> f64);

const LOAD: Quantity = ("load W", "N", |s| s.load);
const AREA: Quantity = ("contact area A", "m²", |s| s.contact_area);
const MEAN_GAP: Quantity = ("mean gap", "m", |s| s.mean_gap);
const INTERFACIAL: Quantity =
    ("interfacial stiffness", "N/m", |s| s.interfacial_stiffness.unwrap_or(f64::NAN));

/// Both branches, whose approaches count from the same touch: pressed on, and unloaded.
pub(super) struct Branches {
    pub(super) loading: Vec<ContactState>,
    pub(super) unloading: Vec<ContactState>,
}

/// Draws the picture into a directory.
pub(super) fn draw(job: &Job, branches: &Branches, directory: &Path) -> Result<PathBuf, Failure> {
    let name = directory.join("unloading.svg");
    sheet::write(&name, |area| panels(area, job, branches), |area| panels(area, job, branches))
}

fn panels<DB: DrawingBackend>(area: &Area<DB>, job: &Job, branches: &Branches) -> Drawn<DB> {
    area.fill(&WHITE)?;
    let (nx, ny) = job.grid().shape();
    let title = format!(
        "There and back: {nx} × {ny} nodes, E* = {}, Sq = {}",
        quantity(job.e_star(), "Pa", 4),
        quantity(job.heights().rms_height(), "m", 4)
    );
    sheet::title(area, &title)?;
    let name = match is_of_mean_planes(job.periodic()) {
        false => "approach δ",
        true => "approach of the mean planes",
    };
    let approach: Quantity = (name, "m", |s| s.approach);
    let pairs = [(approach, LOAD), (LOAD, AREA), (LOAD, MEAN_GAP), (LOAD, INTERFACIAL)];
    for (place, (x, y)) in (0_i32..).zip(pairs) {
        let panel = sheet::panel(place);
        let (horizontal, vertical) = (axis(x, branches), axis(y, branches));
        panel.rule(area, &horizontal, &vertical)?;
        let curves =
            [(&branches.loading, BLUE, "pressed on"), (&branches.unloading, ORANGE, "unloaded")];
        for (states, colour, _) in curves {
            let points = states.iter().map(|state| ((x.2)(state), (y.2)(state)));
            panel.curve(area, (&horizontal, &vertical), points, colour)?;
        }
        // Load grows with the approach: that corner is free.
        if place == 0 {
            sheet::legend(area, &panel, curves.map(|(_, colour, name)| (colour, name)))?;
        }
        panel.frame(area, &horizontal, &vertical)?;
    }
    Ok(())
}

fn axis((name, unit, quantity): Quantity, branches: &Branches) -> Axis {
    let states = || branches.loading.iter().chain(&branches.unloading);
    let values = || states().map(quantity).filter(|value| value.is_finite());
    let (low, high) = (values().fold(0.0, f64::min), values().fold(0.0, f64::max));
    // A mean gap that is to be zero may be off by rounding.
    let low = if low < -1e-6 * high { low } else { 0.0 };
    Axis::linear(name, unit, low, high).with_room(if low < 0.0 { 0.05 } else { 0.0 }, 0.06)
}
