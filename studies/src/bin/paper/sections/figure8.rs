//! Fig. 8 on the page.

use std::fmt::Write;

use super::picture;
use crate::figure8::PAPER_RANGE;
use crate::report::Report;
use crate::words::scientific;

/// Mean gap and interfacial stiffness.
pub(crate) fn figure8(report: &Report, prefix: &str) -> String {
    let mut rows = String::new();
    for (name, gap) in report.names().iter().zip(&report.figure8.gaps) {
        let [light, moderate, heavy] = gap.exponents.map(|s| s.decimals(2));
        let _ = writeln!(
            rows,
            "| {name} | {} to {} | {:.2} | {} | {} | {}, {} | {light}; {moderate}; {heavy} |",
            scientific(gap.range.0, 2),
            scientific(gap.range.1, 2),
            gap.greatest,
            gap.decay.decimals(3),
            gap.pearson.decimals(4),
            gap.ends[0].decimals(2),
            gap.ends[1].decimals(2),
        );
    }
    format!(
        "## Fig. 8: mean gap and interfacial stiffness\n\n{}\n\n\
         A gap that falls linearly with ln W, ḡ = const − γ Sq ln W, has γ = −dḡ/d(ln W)/Sq = W/(Kᵢ Sq), which \
         the exact stiffness gives at every state. The law is taken to hold where γ, averaged over the \
         seeds, is within 10 % of its greatest value. The line is fitted in the paper's range, {} to {}. The last column has \
         α of Kᵢ ~ W^α at light, moderate and heavy loads.\n\n\
         | surface | range of the law | greatest γ | γ of the line | Pearson r of the line | γ at the ends of \
         the paper's range over γ of the line | α |\n|---|---|---|---|---|---|---|\n{rows}\n\
         Below the range few asperities carry the load, and Kᵢ grows more slowly than W; above it little gap is left, and \
         Kᵢ grows faster.",
        picture(
            prefix,
            "figure8",
            "Mean gap, its slope, the interfacial stiffness and its growth against load"
        ),
        scientific(PAPER_RANGE.0, 1),
        scientific(PAPER_RANGE.1, 1),
    )
}
