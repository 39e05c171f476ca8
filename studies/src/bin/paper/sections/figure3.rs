//! Fig. 3 on the page.

use std::fmt::Write;

use super::picture;
use crate::figure3::{NODES, WAVES};
use crate::plane::{Case, LENGTH};
use crate::report::Report;
use crate::words::scientific;

/// Plane contacts.
pub(crate) fn figure3(report: &Report, prefix: &str) -> String {
    let figure = &report.figure3;
    let mut rows = String::new();
    for found in &figure.cases {
        let error = found.on_paper_mesh();
        let orders = match found.case {
            // Free waves do not tend to the periodic solution.
            Case::FreeWaves(..) => "–".to_string(),
            _ => format!("{:.2}, {:.2}", found.orders.0, found.orders.1),
        };
        let _ = writeln!(
            rows,
            "| {} | {} | {} | {orders} |",
            found.case.name(),
            scientific(error.inner, 2),
            scientific(error.rms, 2),
        );
    }
    let waves = |count: f64| {
        let found = figure.waves.iter().find(|(waves, _)| *waves == count);
        scientific(found.map_or(0.0, |(_, error)| *error), 1)
    };
    let length = figure.lengths.iter().find(|(length, _)| *length == 1.0);
    let length = length.map_or(0.0, |(_, change)| *change);
    let worst = figure
        .cases
        .iter()
        .filter(|found| matches!(found.case, Case::FreeWaves(..)))
        .map(|found| found.on_paper_mesh().inner)
        .fold(0.0, f64::max);
    format!(
        "## Fig. 3: plane contacts against their closed forms\n\n{}\n\n\
         A single row of cells, each a bar across the whole strip, so that no quantity can vary along it:\n\n\
         * **Cylinder**, eq. (20): the free half-space, a strip {LENGTH:.0} times as long as the domain is wide. \
         The error of a finite length ℓ is of second order in 1/ℓ: {} of p₀ if the strip is as long as the domain \
         is wide, and 10⁻⁶ times as large with the length used.\n\
         * **Wave**, eqs. (21) and (22): `PeriodicBoussinesq` with one cell along y is the plane periodic problem \
         without approximation, one wavelength.\n\
         * **{WAVES} free waves**: the paper's substitute for the periodic problem, on the domain \
         (−5, 5); the middle wave is compared at the same mean pressure. The error, up to {} p\\*, does not fall with a finer mesh, only with more waves: \
         {} with 1, {} with 3, {} with {WAVES} and {} with 15 at half contact.\n\n\
         Errors of the pressure over p₀ or p\\* with N = {NODES} cells over the contact of the cylinder, or the \
         wavelength. *Inner* is the greatest error on |x| < 0.6 a, *rms* the root mean square over the contact, both \
         averages over 20 loads. Orders of convergence by a fit from N = 21 to 641:\n\n\
         | case | inner error | rms error | orders, inner and rms |\n|---|---|---|---|\n{rows}\n\
         Away from the edge of contact the error is of second order in the cell size. Over the \
         whole contact it is of first order, because the edge cuts cells. Free waves have an additional error that no \
         finer mesh removes.",
        picture(
            prefix,
            "figure3",
            "Pressures of plane contacts, and their errors against mesh, length of the strip and number of waves"
        ),
        scientific(length, 2),
        scientific(worst, 2),
        waves(1.0),
        waves(3.0),
        waves(WAVES as f64),
        waves(15.0),
    )
}
