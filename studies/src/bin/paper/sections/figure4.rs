//! Fig. 4 on the page.

use std::fmt::Write;

use super::picture;
use crate::report::Report;
use crate::words::scientific;

/// Contact maps.
pub(crate) fn figure4(report: &Report, prefix: &str) -> String {
    let mut rows = String::new();
    for map in &report.figure4.maps {
        let _ = writeln!(
            rows,
            "| {} | {:.1} % | {} | {:.3} | {:.2} | {} | {} | {:.0} % | {:.0} % | {:.0} % |",
            map.surface,
            100.0 * map.area,
            scientific(map.load, 3),
            map.greatest,
            map.reduced,
            if map.at_border { "border" } else { "inside" },
            map.patches,
            100.0 * map.small,
            100.0 * map.in_small,
            100.0 * map.in_large,
        );
    }
    format!(
        "### Fig. 4: where the surface touches\n\n{}\n\n\
         The paper: \"most of the contact patches are small and sparsely distributed …, while the majority of \
         the contact points belong to large patches\". Counted for seed 1, with patches of fewer than ten cells \
         as small and the largest tenth of the patches as large:\n\n\
         | surface | A/A₀ | W/A₀E\\* | greatest p/E\\* | greatest p/E\\*h′ | where | patches | small ones | contact in small ones | \
         contact in the largest tenth |\n|---|---|---|---|---|---|---|---|---|---|\n{rows}\n\
         Colours of the maps are even in the logarithm of p/E\\*h′. If the pressure is greatest \
         at the border of the square, the cause is the finite punch on a free half-space, and not \
         roughness.",
        picture(prefix, "figure4", "Contact maps at four areas, coloured by pressure"),
    )
}
