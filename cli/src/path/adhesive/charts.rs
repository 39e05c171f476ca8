//! `loading_curve.svg` with adhesion: both branches in each panel, with loads below 0.

use std::path::{Path, PathBuf};

use asperity::adhesion::{AdhesiveBranch, AdhesiveState};
use asperity_cli::number::{counted, quantity};
use asperity_cli::outcome::Failure;
use asperity_cli::panel::{Area, Drawn};
use plotters::prelude::*;

use super::super::job::Job;
use super::super::sheet;
use super::super::there_and_back::{self, approach};
use super::course::Followed;

type Quantity = there_and_back::Quantity<AdhesiveState>;

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
    let has_stiffness = followed.states.iter().any(|s| s.contact.contact_stiffness.is_some());
    let approach = approach(job, has_stiffness, |s: &AdhesiveState| s.contact.approach);
    let pairs = [(approach, LOAD), (LOAD, AREA), (LOAD, MEAN_GAP), (approach, LOST)];
    let there = behind(followed.before_loading(), &loading);
    let back = behind(loading.states().last().copied(), &unloading);
    there_and_back::panels(area, pairs, [(&there, "pressed on"), (&back, "pulled off")])
}

/// The states of a branch, if there are any, behind the one that it begins from.
fn behind(begin: Option<AdhesiveState>, branch: &AdhesiveBranch) -> Vec<AdhesiveState> {
    let begin = begin.filter(|_| !branch.states().is_empty());
    begin.into_iter().chain(branch.states().iter().copied()).collect()
}
