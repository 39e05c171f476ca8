//! Fig. 4 on the page.

use std::fmt::Write;

use super::picture;
use crate::report::Report;

/// Contact maps.
pub(crate) fn figure4(report: &Report, prefix: &str) -> String {
    let maps = &report.figure4.maps;
    let mut rows = String::new();
    for name in report.names() {
        let _ = write!(rows, "| {name} |");
        for map in maps.iter().filter(|map| map.surface == name) {
            let place = if map.at_border { ", at the border" } else { "" };
            let _ = write!(rows, " {:.2}{place} |", map.reduced);
        }
        rows.push('\n');
    }
    let areas = maps.iter().take_while(|map| map.surface == maps[0].surface);
    let areas: Vec<String> = areas.map(|map| format!(" {:.0} % |", 100.0 * map.area)).collect();
    format!(
        "## Fig. 4: where the surface touches\n\n{}\n\n\
         The verdicts above count, for seed 1, patches of fewer than ten cells as small and the largest tenth of the \
         patches as large. The greatest pressure, over E\\*h′:\n\n\
         | A/A₀ |{}\n|---{}|\n{rows}\n\
         If it is at the border of the square, the cause is the finite punch on a free half-space, and not roughness.",
        picture(prefix, "figure4", "Contact maps at four areas, coloured by pressure"),
        areas.concat(),
        "|---".repeat(areas.len()),
    )
}
