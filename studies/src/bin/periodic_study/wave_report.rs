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
        let finest = self.of(Periodic::Love).last();
        let full = finest.map_or(f64::NAN, |e| e.full * (e.nodes as f64).powi(2));
        let exact = self.of(Periodic::Spectral).map(|e| e.full).fold(0.0, f64::max);
        let agrees = [Periodic::Love, Periodic::Spectral].iter().all(|kernel| {
            let mut columns = COLUMNS.iter();
            columns.all(|(_, value, order)| {
                (self.order(*kernel, *value) - f64::from(*order)).abs() <= SLACK
            })
        });
        format!(
            "### A wave against Westergaard\n\n\
             The path of a sinusoidal surface to full contact, for both periodic kernels, with a row of nodes on the \
             crest, against the closed form of H. M. Westergaard (1939, `reference::Westergaard`):\n\n\
             ![Errors of mean gap, area and stiffness against the nodes along a wave](images/westergaard.png)\n\n{}\n\
             Greatest errors, in brackets the order at which they fall: of the mean gap at any event; of the area just \
             before a row of nodes touches, and of the stiffness, between 10 and 90 % of the load of full contact. \
             That load is exact to rounding, {exact:.0e}, for the spectral kernel. Love's cells are stiffer by \
             {full:.3} (cell / wavelength)², in theory π²/6 = {:.3}, because the pressure of a cell is uniform.\n\n\
             **Verdict: {}** (criterion: orders, those of the finest three grids, within {SLACK} of 2, 1 and 1). \
             `tests/closed_forms/westergaard.rs` holds the constants.",
            self.table(),
            PI * PI / 6.0,
            if agrees { "agrees" } else { "**differs**" },
        )
    }

    fn table(&self) -> String {
        let mut text = "| kernel | nodes a wave | mean gap / amplitude | area / A₀ | stiffness | load of full \
                        contact |\n|---|---|---|---|---|---|\n"
            .to_string();
        for kernel in [Periodic::Love, Periodic::Spectral] {
            let [gap, area, stiffness] = COLUMNS.map(|(_, value, _)| self.order(kernel, value));
            if let Some(e) = self.of(kernel).last() {
                let _ = writeln!(
                    text,
                    "| {} | {} | {:.2e} ({gap:.2}) | {:.2e} ({area:.2}) | {:.2e} ({stiffness:.2}) | {:.1e} |",
                    kernel.name(),
                    e.nodes,
                    e.gap,
                    e.area,
                    e.stiffness,
                    e.full
                );
            }
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
