//! Table, text and picture of the wave.

use std::f64::consts::PI;
use std::fmt::Write;

use asperity_cli::axis::Axis;
use asperity_cli::chart::{BLUE, Chart, Corner, GREY, ORANGE, Series, Style};
use asperity_cli::half_space::Periodic;

use crate::wave::{COARSEST, COLUMNS, Convergence, Errors};

/// By how much an order may differ from the theory's.
const SLACK: f64 = 0.1;

impl Convergence {
    pub(crate) fn text(&self) -> String {
        let finest = |kernel| self.of(kernel).last();
        let coefficient = |kernel, value: fn(&Errors) -> f64, order: i32| {
            finest(kernel).map_or(f64::NAN, |e| value(e) * (e.nodes as f64).powi(order))
        };
        let of = |kernel| {
            [
                coefficient(kernel, |e| e.gap, 2),
                coefficient(kernel, |e| e.area, 1),
                coefficient(kernel, |e| e.full, 2),
            ]
        };
        let ([gap, area, full], [spectral_gap, spectral_area, _]) =
            (of(Periodic::Love), of(Periodic::Spectral));
        let exact = self.of(Periodic::Spectral).map(|e| e.full).fold(0.0, f64::max);
        let agrees = [Periodic::Love, Periodic::Spectral].iter().all(|kernel| {
            let mut columns = COLUMNS.iter();
            columns.all(|(_, value, order)| {
                (self.order(*kernel, *value) - f64::from(*order)).abs() <= SLACK
            })
        });
        format!(
            "### A wave against Westergaard\n\n\
             A sinusoidal surface, pressed flat: H. M. Westergaard (1939) gives the closed form (`reference::Westergaard`). The \
             whole path to full contact, for both periodic kernels, with a row of nodes on the crest:\n\n\
             ![Errors of mean gap, area and stiffness against the nodes along a wave](images/westergaard.png)\n\n{}\n\
             * **Mean gap**: the greatest error at any event, from first touch to full contact. Second order: {gap:.2} (Love) and \
             {spectral_gap:.2} (spectral) times amplitude × (cell / wavelength)² on the finest grid.\n\
             * **Area**: the greatest error just before a row of nodes touches, between 10 and 90 % of the load of full contact: \
             too small by {area:.2} (Love) and {spectral_area:.2} (spectral) cells over the wavelength. Then two rows touch at once, \
             one at each edge, and it is {:.2} and {:.2} too much.\n\
             * **Stiffness**: the greatest relative error in the same range.\n\
             * **Load of full contact**: exact to rounding, {exact:.0e}, for the spectral kernel, which \
             represents the wave exactly. Love's cells are stiffer by {full:.3} (cell / wavelength)², in theory π²/6 = {:.3}, because \
             the pressure of a cell is uniform.\n\n\
             **Verdict: {}** (criterion: orders, those of the finest three grids, within {SLACK} of 2, 1 and 1). \
             `tests/closed_forms/westergaard.rs` holds the constants.",
            self.table(),
            2.0 - area,
            2.0 - spectral_area,
            PI * PI / 6.0,
            if agrees { "agrees" } else { "**differs**" },
        )
    }

    fn table(&self) -> String {
        let mut text = "| kernel | nodes a wave | mean gap / amplitude | area / A₀ | stiffness | load of full \
                        contact |\n|---|---|---|---|---|---|\n"
            .to_string();
        for kernel in [Periodic::Love, Periodic::Spectral] {
            if let Some(e) = self.of(kernel).last() {
                let _ = writeln!(
                    text,
                    "| {} | {} | {:.2e} | {:.2e} | {:.2e} | {:.1e} |",
                    kernel.name(),
                    e.nodes,
                    e.gap,
                    e.area,
                    e.stiffness,
                    e.full
                );
            }
            let [gap, area, stiffness] = COLUMNS.map(|(_, value, _)| self.order(kernel, value));
            let _ = writeln!(
                text,
                "| {} | **order** | **{gap:.2}** | **{area:.2}** | **{stiffness:.2}** | |",
                kernel.name()
            );
        }
        text
    }

    pub(crate) fn charts(&self) -> Vec<Chart> {
        let extent = |value: fn(&Errors) -> f64| {
            let values = || self.errors.iter().map(value);
            let (least, most) =
                (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max));
            (least, most)
        };
        let finest = extent(|e| e.nodes as f64).1;
        COLUMNS
            .iter()
            .map(|&(name, value, order)| {
                let points = |kernel| {
                    let each = self.of(kernel).map(move |e| (e.nodes as f64, value(e)));
                    each.collect::<Vec<_>>()
                };
                let (love, spectral) = (points(Periodic::Love), points(Periodic::Spectral));
                let (least, most) = extent(value);
                // A line of the order that theory has, a little above the coarsest error.
                let start = 1.5 * love[0].1;
                let slope = |nodes: f64| start * (COARSEST as f64 / nodes).powi(order);
                Chart {
                    title: name.to_string(),
                    x: Axis::plain_logarithmic("nodes a wave", COARSEST as f64, finest)
                        .with_room(0.05, 0.05),
                    y: Axis::plain_logarithmic("error", least, start.max(most))
                        .with_room(0.06, 0.06),
                    series: vec![
                        Series::new(
                            format!("order {order}"),
                            GREY,
                            Style::Dashed,
                            [COARSEST as f64, finest].map(|nodes| (nodes, slope(nodes))),
                        ),
                        Series::new("Love kernel", BLUE, Style::Line, love.clone()),
                        Series::new("", BLUE, Style::Dots, love),
                        Series::new("spectral kernel", ORANGE, Style::Line, spectral.clone()),
                        Series::new("", ORANGE, Style::Dots, spectral),
                    ],
                    legend: Corner::BottomLeft,
                }
            })
            .collect()
    }
}
