//! Fig. 6 on the page.

use std::fmt::Write;

use super::picture;
use crate::report::Report;
use crate::words::{areas, scaled};

/// Area over load.
pub(crate) fn figure6(report: &Report, prefix: &str) -> String {
    let ratios = &report.figure6.ratios;
    let mut head = "| A/A₀ |".to_string();
    for name in report.names() {
        let _ = write!(head, " {name}, cells counted | corrected |");
    }
    let mut rows = String::new();
    for (index, (area, _, _)) in ratios.first().map_or(&[][..], |r| &r.at).iter().enumerate() {
        let _ = write!(rows, "| {:.1} % |", 100.0 * area);
        for found in ratios {
            let (_, raw, corrected) = &found.at[index];
            let _ = write!(rows, " {} | {} |", raw.decimals(2), corrected.decimals(2));
        }
        rows.push('\n');
    }
    let _ = write!(rows, "| at 0.1 A₀E\\* |");
    for found in ratios {
        let (raw, corrected) = (found.end, found.end_corrected);
        let _ = write!(rows, " {} | {} |", raw.decimals(2), corrected.decimals(2));
    }
    let names = report.names();
    let near = names.iter().zip(ratios);
    let near: Vec<String> = near
        .map(|(name, found)| {
            format!(
                "{name}: {} with cells counted, {} corrected",
                areas(found.near_two[0]),
                areas(found.near_two[1])
            )
        })
        .collect();
    let central: Vec<String> = report
        .study
        .families
        .iter()
        .zip(ratios)
        .map(|(family, found)| {
            let k = scaled(found.end, family.central_paper / family.gradient);
            format!("{} for {}", k.decimals(2), family.rough.name())
        })
        .collect();
    let rule = "---|---|".repeat(ratios.len());
    format!(
        "## Fig. 6: the ratio of area to load\n\n{}\n\n\
         k = A E\\* h′ / W. \"Corrected\" is the area without the excess of whole cells along the \
         edge of the contact: (π − 1 + ln 2)/24 times the length of the staircase times the cell size (Yastrebov, Anciaux and Molinari 2017, \
         arXiv 1701.02727).\n\n{head}\n|---|{rule}\n{rows}\n\n\
         Within 10 % of 2: {}. With the gradient by central differences on the paper's mesh, k under the greatest \
         load is {}. To end at k = 1.0, a surface must be almost in full contact at 0.1 A₀E\\*, \
         which requires a small gradient.",
        picture(
            prefix,
            "figure6",
            "Ratio of area to load against area, and the area over that of Persson's theory"
        ),
        near.join("; "),
        central.join(", "),
    )
    .trim_end()
    .to_string()
}
