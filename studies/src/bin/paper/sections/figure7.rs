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
        "### Fig. 7: approach and contact stiffness\n\n{}\n\n{}\n\
         The exponential is y₀ + A exp(−W/t) through u/Sq = −δ/Sq, the line is fitted from {} on; both by least \
         squares over evenly spaced loads, since the paper does not say which spacing it used. \
         The paper does not give the range of the exponential fit either. The fit depends more on \
         the range than on the seed, so that all three ranges are judged (above). No fit starts \
         at 0, but every path does. The paper's line cannot be one of u/Sq: saturation alone means a slope of {}. In the picture, and \
         in two rows, u is divided by {LINE_UNIT} Sq, the unit in which its line fits. Only the \
         ratio of intercept to slope is judged, because it does not depend on the unit.\n\n\
         **Saturated stiffness.** The rigid square punch has K = {} E\\*L, {} in these units; the same punch on \
         the mesh has {} ({} % less, the error of the mesh), and the rough surfaces end there. \
         The value does not depend on roughness, so that there is no verdict on it.\n\n\
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
        let of = |f: &Fits| f.light[k];
        let range = format!("W ≤ {}", scientific(load, 2));
        let name = |symbol: &str| format!("{symbol}, {range}");
        row(&name("y₀"), &signed(y0, 2), &|f| of(f).offset.decimals(2));
        row(&name("A"), &signed(a, 2), &|f| of(f).amplitude.decimals(2));
        row(&name("t"), &signed(t, 4), &|f| of(f).scale.decimals(4));
        let deviation = |f: &Fits| {
            let (ours, power) = (of(f).deviation.mean, of(f).of_power.mean);
            format!("{}; {}", signed(ours, 3), signed(power, 3))
        };
        row(&name("rms deviation [Sq]; of a power"), "–", &deviation);
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
