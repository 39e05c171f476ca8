//! `unloading.svg`: the way there and back of a contact that yields.

use std::path::{Path, PathBuf};

use asperity::contact::ContactState;
use asperity_cli::number::quantity;
use asperity_cli::outcome::Failure;
use asperity_cli::panel::{Area, Drawn};
use plotters::prelude::*;

use super::job::Job;
use super::sheet;
use super::there_and_back::{self, approach};

type Quantity = there_and_back::Quantity<ContactState>;

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
    let has_stiffness = branches.loading.iter().any(|s| s.contact_stiffness.is_some());
    let approach = approach(job, has_stiffness, |s: &ContactState| s.approach);
    let pairs = [(approach, LOAD), (LOAD, AREA), (LOAD, MEAN_GAP), (LOAD, INTERFACIAL)];
    let ways = [(&branches.loading[..], "pressed on"), (&branches.unloading, "unloaded")];
    there_and_back::panels(area, pairs, ways)
}
