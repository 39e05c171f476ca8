//! `merge_tree.png`: which patches were born when, and merged into which.

use std::path::{Path, PathBuf};

use asperity::record::LoadingRecord;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{BLUE, ORANGE};
use asperity_cli::chart_format::{self, ChartFormat};
use asperity_cli::number::counted;
use asperity_cli::outcome::Failure;
use asperity_cli::panel::{Area, Drawn, Panel, anchor};
use asperity_cli::picture::{FINE, draw_fine, draw_svg};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::followed::Followed;
use super::tree_layout::{Leaf, rows};

/// Most branches in the picture.
const MOST: usize = 40;
const WIDTH: i32 = 1040;
const ROW: i32 = 20;
const FONT: i32 = 15;
const LEFT: i32 = 190;
const TOP: i32 = 86;
/// The right edge of both columns left of the panel.
const COLUMNS: [i32; 2] = [96, LEFT - 12];

/// Draws the largest branches against the load.
pub(super) fn draw(
    record: &LoadingRecord,
    followed: &Followed,
    name: &Path,
) -> Result<PathBuf, Failure> {
    let branches = followed.tree.branches();
    let tree = Tree { record, followed, leaves: rows(branches, MOST) };
    let height = ROW * tree.leaves.len() as i32;
    let panel = |text_rise| Panel {
        left: FINE * LEFT,
        top: FINE * TOP,
        width: FINE * (WIDTH - LEFT - 30),
        height: FINE * height,
        font: FINE * FONT,
        stroke: FINE as u32,
        text_rise,
    };
    let Some(ends) = tree.loads() else {
        return Err(Failure::request("there is no tree of mergers: no state carries load"));
    };
    let size = (WIDTH, TOP + height + 70);
    match chart_format::chosen() {
        Some(ChartFormat::Svg) => draw_svg(&name.with_extension("svg"), size, FINE, |area| {
            area.fill(&WHITE)?;
            tree.draw(area, &panel(0.0), ends)
        }),
        _ => draw_fine(name, size, |area| tree.draw(area, &panel(0.2), ends)),
    }
}

struct Tree<'a> {
    record: &'a LoadingRecord,
    followed: &'a Followed,
    leaves: Vec<Leaf>,
}

impl Tree<'_> {
    fn load(&self, step: usize) -> f64 {
        let touches = &self.followed.touches;
        let state = step.checked_sub(1).and_then(|place| touches.get(place));
        state.map_or(f64::NAN, |state| state.contact.load)
    }

    /// The first positive load at which a branch is born, and the last load.
    fn loads(&self) -> Option<(f64, f64)> {
        let branches = self.followed.tree.branches();
        let births = self.leaves.iter().map(|leaf| branches[leaf.branch].birth);
        let last = self.record.states().last()?.contact.load;
        let positive = births.map(|step| self.load(step)).filter(|load| *load > 0.0);
        let first = positive.fold(last, f64::min);
        (first > 0.0).then_some((first, last))
    }

    fn draw<DB: DrawingBackend>(
        &self,
        area: &Area<DB>,
        panel: &Panel,
        (first, last): (f64, f64),
    ) -> Drawn<DB> {
        let load = &Axis::logarithmic("load", "N", first, last).with_room(0.02, 0.02);
        let branches = self.followed.tree.branches();
        let count = self.leaves.len();
        let row = Axis::plain("", count as f64 - 0.5, -0.5);
        panel.rule_upright(area, load)?;
        let end = |leaf: &Leaf| match branches[leaf.branch].merger {
            Some(merger) => self.load(merger.step).max(first),
            None => last,
        };
        for (place, leaf) in self.leaves.iter().enumerate() {
            if let Some(into) = leaf.into {
                let rows = [place, into].map(|place| (end(leaf), place as f64));
                panel.curve(area, (load, &row), rows.into_iter(), BLUE)?;
            }
        }
        for (place, leaf) in self.leaves.iter().enumerate() {
            let branch = branches[leaf.branch];
            // First touch is without load, which has no place on the axis.
            let begin = self.load(branch.birth).max(first);
            let colour = if leaf.into.is_none() { ORANGE } else { BLUE };
            let thick =
                Panel { stroke: panel.stroke * (2 + branch.nodes.max(1).ilog10()) / 2, ..*panel };
            let line = [begin, end(leaf)].map(|load| (load, place as f64));
            thick.curve(area, (load, &row), line.into_iter(), colour)?;
            let middle = panel.top + panel.height * (2 * place as i32 + 1) / (2 * count as i32);
            let (ix, iy) = branch.node;
            let texts = [format!("{ix}, {iy}"), branch.nodes.to_string()];
            for (text, right) in texts.iter().zip(COLUMNS) {
                let pos = anchor(HPos::Right, VPos::Center);
                panel.write(area, text, (FINE * right, middle), panel.font - FINE, pos)?;
            }
        }
        panel.border(area)?;
        panel.frame_below(area, load)?;
        for (text, right) in ["first node", "nodes"].into_iter().zip(COLUMNS) {
            let at = (FINE * right, panel.top - FINE * 14);
            let pos = anchor(HPos::Right, VPos::Center);
            panel.write(area, text, at, panel.font - FINE, pos)?;
        }
        let lasting = self.leaves.iter().filter(|leaf| leaf.into.is_none()).count();
        let title = format!(
            "The {count} largest of {}: each from its first node until it merges into an older one, or to the end ({lasting}, orange)",
            counted(branches.len(), "patch")
        );
        let middle = (FINE * WIDTH / 2, FINE * 30);
        let pos = anchor(HPos::Center, VPos::Center);
        panel.write(area, &title, middle, panel.font, pos)?;
        area.present()
    }
}
