//! The whole path on the page.

use std::fmt::Write;

use super::picture;
use crate::criteria::Verdict;
use crate::run::Point;
use crate::whole_path::{Against, WholePath};
use crate::words::{percent, scientific, signed};

/// Loads of the table, W/A₀E*.
const LOADS: [f64; 5] = [1e-4, 1e-3, 0.01, 0.1, 1.0];
/// The ordinate of the paper's line, in Sq.
const UNIT: f64 = crate::figure7::LINE_UNIT;

/// The path of all nodes, event by event.
pub(crate) fn whole_path(path: &WholePath, prefix: &str) -> String {
    let nodes = path.mesh * path.mesh;
    let mut rows = String::new();
    for load in LOADS {
        let after = path.run.points.partition_point(|point| point.load <= load);
        let state = after.checked_sub(1).and_then(|at| path.run.points.get(at));
        if let Some(point) = state.filter(|_| after < path.run.points.len()) {
            let _ = writeln!(rows, "{}", row(load, point, nodes, path.gradient));
        }
    }
    let full = path.run.last().map_or(0.0, |point| point.load);
    let against = path.against.as_ref().map_or(String::new(), against);
    format!(
        "The figures above follow events up to {} nodes and solve for single loads from there. The path without a factor \
         ([theory.md](../docs/theory.md#11-without-a-factor)) has every event of the paper's mesh: Table 1's spectrum, seed 1, \
         {} × {} nodes, all {nodes} of them from first touch to full contact at W = {} A₀E\\*.\n\n\
         ```text\n\
         cargo run --release -- path --nodes {} --short-cutoff 78.125e-6 --e-star 1 --max-area-fraction 1\n\
         cargo run --release -p asperity-studies --bin paper -- --nodes {} --whole-path out/path.csv --report \
         paper/figure_by_figure.md --reuse\n\
         ```\n\n{}\n\n\
         The dashed line is the paper's greatest \
         load. The table gives the last state at or below each load (k \
         with the rms gradient {:.4} of the sum of waves):\n\n\
         | W/A₀E\\* | nodes | A/A₀ | k | k corrected | u/{UNIT} Sq | ḡ/Sq | K Sq/A₀E\\* | Kᵢ Sq/A₀E\\* |\n\
         |---|---|---|---|---|---|---|---|---|\n{}{against}",
        path.path_nodes,
        path.mesh,
        path.mesh,
        signed(full, 3),
        path.mesh,
        path.mesh,
        picture(
            prefix,
            "whole_path",
            "Area, k, approach, mean gap and both stiffnesses against load, from first touch to full contact"
        ),
        path.gradient,
        rows.trim_end(),
    )
}

/// The same by single loads.
fn against(found: &Against) -> String {
    let worst = [found.approach, found.mean_gap, found.stiffness, found.area];
    let worst = worst.into_iter().fold(0.0, f64::max);
    format!(
        "\n\nThe fixed loads of \"Table 1\", seed 1, above are solved without following events. \
        At {} of them, up to W = {}, approach, mean \
         gap, contact stiffness and area differ from this path's, interpolated between two events, by at most {}, {}, {} and {} \
         (areas and stiffnesses change in steps).\n\n\
         **\"Robust results from infinitesimal to full contact\"**, here with the exact rule: {} (*agrees* if all nodes touch, \
         without which this section is not written, and none of these differences is above 10⁻³; *near* 10⁻²; else \
         *differs*).",
        found.loads,
        scientific(found.greatest, 1),
        scientific(found.approach, 1),
        scientific(found.mean_gap, 1),
        scientific(found.stiffness, 1),
        scientific(found.area, 1),
        Verdict::within(worst, 1e-3, 1e-2),
    )
}

fn row(load: f64, point: &Point, nodes: usize, gradient: f64) -> String {
    format!(
        "| {load} | {} | {} % | {} | {} | {} | {} | {} | {} |",
        (point.area * nodes as f64).round(),
        percent(point.area, 2),
        signed(point.ratio(gradient), 3),
        signed(point.corrected_ratio(gradient), 3),
        signed(point.approach / UNIT, 3),
        scientific(point.mean_gap, 4),
        scientific(point.contact_stiffness, 4),
        scientific(point.interfacial_stiffness, 4),
    )
}
