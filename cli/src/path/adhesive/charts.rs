//! `loading_curve.svg` with adhesion: both branches in each panel, with loads below 0.

use std::path::{Path, PathBuf};

use asperity::adhesion::{AdhesiveBranch, AdhesiveState};
use asperity_cli::axis::Axis;
use asperity_cli::chart::{BLUE, ORANGE};
use asperity_cli::half_space::is_of_mean_planes;
use asperity_cli::number::{counted, quantity};
use asperity_cli::outcome::Failure;
use asperity_cli::panel::{Area, Drawn};
use plotters::prelude::*;

use super::super::job::Job;
use super::super::sheet;
use super::course::Followed;

/// A quantity of a state: its name, its unit, and what it is.
type Quantity = (&'static str, &'static str, fn(&AdhesiveState) -> f64);

const LOAD: Quantity = ("load W", "N", |s| s.contact.load);
const AREA: Quantity = ("contact area A", "m²", |s| s.contact.contact_area);
const MEAN_GAP: Quantity = ("mean gap", "m", |s| s.contact.mean_gap);
const LOST: Quantity = ("energy lost in jumps", "J", |s| s.dissipated);

/// Draws the picture into a directory.
pub(super) fn draw(job: &Job, followed: &Followed, directory: &Path) -> Result<PathBuf, Failure> {
    let name = directory.join("loading_curve.svg");
    sheet::write(&name, |area| panels(area, job, followed), |area| panels(area, job, followed))
}

fn panels<DB: DrawingBackend>(area: &Area<DB>, job: &Job, followed: &Followed) -> Drawn<DB> {
    area.fill(&WHITE)?;
    let (nx, ny) = job.grid().shape();
    let [loading, unloading] = followed.branches();
    let title = format!(
        "Surfaces that stick, {}: {nx} × {ny} nodes, E* = {}, w = {}, Sq = {}",
        counted(followed.states.len(), "state"),
        quantity(job.e_star(), "Pa", 4),
        quantity(followed.path.law().work(), "J/m²", 4),
        quantity(job.heights().rms_height(), "m", 4)
    );
    sheet::title(area, &title)?;
    let name = match is_of_mean_planes(job.periodic()) {
        false => "approach δ",
        true => "approach of the mean planes",
    };
    let approach: Quantity = (name, "m", |s| s.contact.approach);
    let pairs = [(approach, LOAD), (LOAD, AREA), (LOAD, MEAN_GAP), (approach, LOST)];
    for (place, (x, y)) in (0_i32..).zip(pairs) {
        let panel = sheet::panel(place);
        let (horizontal, vertical) = (axis(x, &followed.states), axis(y, &followed.states));
        panel.rule(area, &horizontal, &vertical)?;
        let curves: [(&AdhesiveBranch, _, _); 2] =
            [(&loading, BLUE, "pressed on"), (&unloading, ORANGE, "pulled off")];
        let curves = curves.iter().filter(|(branch, ..)| !branch.states().is_empty());
        for (branch, colour, _) in curves.clone() {
            let points = branch.states().iter().map(|state| ((x.2)(state), (y.2)(state)));
            panel.curve(area, (&horizontal, &vertical), points, *colour)?;
        }
        // Contact grows with the load: that corner is free.
        if place == 1 {
            sheet::legend(area, &panel, curves.map(|(_, colour, name)| (*colour, *name)))?;
        }
        panel.frame(area, &horizontal, &vertical)?;
    }
    area.present()
}

fn axis((name, unit, quantity): Quantity, states: &[AdhesiveState]) -> Axis {
    let values = || states.iter().map(quantity).filter(|value| value.is_finite());
    let (low, high) = (values().fold(0.0, f64::min), values().fold(0.0, f64::max));
    Axis::linear(name, unit, low, high).with_room(if low < 0.0 { 0.05 } else { 0.0 }, 0.06)
}
