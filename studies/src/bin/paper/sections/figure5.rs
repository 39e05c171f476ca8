//! Fig. 5 on the page.

use super::{Table, picture};
use crate::report::Report;
use crate::words::scaled;

/// Area against load.
pub(crate) fn figure5(report: &Report, prefix: &str) -> String {
    let mut table = Table::new(&report.names());
    let fits = &report.figure5.fits;
    table.row("Pearson r below 30 % contact", "0.999", fits.iter().map(|f| f.pearson.decimals(4)));
    table.row(
        "slope of the line, A/A₀ per W/A₀E\\*",
        "–",
        fits.iter().map(|f| f.slopes[0].decimals(2)),
    );
    table.row(
        "greatest deviation from it, of 30 %",
        "–",
        fits.iter().map(|f| format!("{} %", scaled(f.worst, 100.0).decimals(1))),
    );
    table.row(
        "slope in the lower half of the loads beyond",
        "–",
        fits.iter().map(|f| f.slopes[1].decimals(2)),
    );
    table.row("slope in the upper half", "–", fits.iter().map(|f| f.slopes[2].decimals(2)));
    format!(
        "### Fig. 5: area against load\n\n{}\n\n{}\n\
         Evenly spaced loads. A correlation of 0.999 does not prove a linear law: a line with an \
         intercept also fits a slightly curved law, and k of Fig. 6 falls over the same range. \
         The dot follows from the paper's k and gradient at its greatest load.",
        picture(prefix, "figure5", "Contact area against load"),
        table.text,
    )
}
