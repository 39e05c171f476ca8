//! Fig. 7 on the page.

use super::{Table, picture};
use crate::figure7::{Fits, LARGE_LOAD, LIGHT_LOADS, LINE_UNIT, PAPER_EXPONENTIAL, PAPER_LINE};
use crate::report::Report;
use crate::surfaces::{SIDE, SQ};
use crate::words::{percent, scaled, scientific, signed};
use asperity_studies::spread::Spread;

/// Approach and contact stiffness.
pub(crate) fn figure7(report: &Report, prefix: &str) -> String {
    let punch = report.study.punch;
    let exact = asperity::reference::SQUARE_PUNCH_STIFFNESS * SQ / SIDE;
    format!(
        "## Fig. 7: approach and contact stiffness\n\n{}\n\n{}\n\
         The exponential is y₀ + A exp(−W/t) through u/Sq = −δ/Sq, the line is fitted from {} on; both by least \
         squares over evenly spaced loads. The paper gives neither its range nor its spacing, and the fit depends more on \
         the range than on the seed, so that it has no verdict here. The paper's line cannot be one of u/Sq: saturation \
         alone means a slope of {}. In the picture, and \
         in two rows, u is divided by {LINE_UNIT} Sq, the unit in which its line fits.\n\n\
         **Saturated stiffness.** The rigid square punch has K = {:.7} E\\*L, {} in these units; the same punch on \
         the mesh has {} ({} % less, the error of the mesh), and the rough surfaces end there.\n\n\
         **Growth at light loads.** For few asperities of a finite surface a power with the exponent 1/(1 + H) = 0.56 is \
         expected (Pastewka et al., arXiv 1210.4635).",
        picture(prefix, "figure7", "Approach and contact stiffness against load, with fits"),
        table(report),
        scientific(LARGE_LOAD, 1),
        signed(-1.0 / exact, 0),
        asperity::reference::SQUARE_PUNCH_STIFFNESS,
        scientific(exact, 4),
        scientific(punch, 4),
        percent(1.0 - punch / exact, 2),
    )
}

fn table(report: &Report) -> String {
    let fits = &report.figure7.fits;
    let mut table = Table::new(&report.names());
    let mut row = |quantity: &str, paper: &str, value: &dyn Fn(&Fits) -> String| {
        table.row(quantity, paper, fits.iter().map(value));
    };
    let (y0, a, t) = PAPER_EXPONENTIAL;
    for (k, load) in LIGHT_LOADS.into_iter().enumerate() {
        let fit = |f: &Fits| {
            let [y0, a] = [f.light[k].offset, f.light[k].amplitude].map(|s| s.decimals(2));
            format!("{y0}; {a}; {}", f.light[k].scale.decimals(4))
        };
        let paper = format!("{}; {}; {}", signed(y0, 2), signed(a, 2), signed(t, 4));
        row(&format!("y₀; A; t, W ≤ {}", scientific(load, 2)), &paper, &fit);
    }
    let unit = |spread: Spread| scaled(spread, 1.0 / LINE_UNIT);
    let (slope, intercept) = PAPER_LINE;
    row("slope, u/20 Sq", &signed(slope, 2), &|f| unit(f.line[0]).decimals(2));
    row("intercept, u/20 Sq", &signed(intercept, 2), &|f| unit(f.line[1]).decimals(3));
    row("slope, u/Sq", "–", &|f| f.line[0].decimals(1));
    row("approach at 0.1 A₀E\\*, over Sq", "–", &|f| f.approach.decimals(2));
    let punch = report.study.punch;
    row("K at 0.1 A₀E\\*, over the punch on this mesh", "–", &|f| {
        scaled(f.stiffness, 1.0 / punch).decimals(4)
    });
    row("exponent of K ~ W^α, W from 10⁻⁴ to 10⁻³", "–", &|f| f.exponent.decimals(2));
    let tenth = report.study.families.iter().map(|family| {
        let share = family.at_area(0.1, |p| p.contact_stiffness / punch);
        share.decimals(3)
    });
    table.row("K over the punch at 10 % contact", "–", tenth);
    table.text
}
