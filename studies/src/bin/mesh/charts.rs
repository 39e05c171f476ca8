//! The picture.

use asperity::reference::AreaLoadLaw;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{BLACK, BLUE, Chart, Corner, GREEN, GREY, ORANGE, Series, Style};

use crate::states::{LOADS, State};
use crate::study::{Family, Study};

/// The loads that are drawn.
const SHOWN: [usize; 3] = [0, 2, 4];

fn line(families: &[Family], x: fn(&Family) -> f64, y: impl Fn(&Family) -> f64) -> Vec<(f64, f64)> {
    families.iter().map(|family| (x(family), y(family))).collect()
}

fn cells(family: &Family) -> f64 {
    family.mesh.cells as f64
}

fn band(family: &Family) -> f64 {
    family.mesh.band as f64
}

fn colour(place: usize) -> plotters::style::RGBColor {
    [BLUE, ORANGE, GREEN][place % 3]
}

/// A quantity of every family under the loads that are drawn.
fn curves(
    families: &[Family],
    x: fn(&Family) -> f64,
    value: fn(&State) -> f64,
    style: Style,
    name: &str,
) -> Vec<Series> {
    let mut series = Vec::new();
    for (place, load) in SHOWN.into_iter().enumerate() {
        let points = line(families, x, |family| family.spread(load, value).mean);
        let name = format!("{}{name}", LOADS[load]);
        series.push(Series::new(name, colour(place), style, points.clone()));
        series.push(Series::new("", colour(place), Style::Dots, points));
    }
    series
}

impl Study {
    pub(crate) fn charts(&self) -> Vec<Chart> {
        let (from, to) = (3.0, 40.0);
        let cells_axis = || Axis::plain_logarithmic("cells to the shortest wave", from, to);
        let (narrow, wide) = (1.5, 40.0);
        let band_axis = || Axis::plain_logarithmic("λᵣ/λₛ", narrow, wide);
        let theories = |from: f64, to: f64| {
            let flat = |name: &str, colour, value: f64| {
                Series::new(name, colour, Style::Dashed, [(from, value), (to, value)])
            };
            [
                flat("√(2π)", GREY, AreaLoadLaw::BUSH_GIBSON_THOMAS),
                flat("√(8/π)", BLACK, AreaLoadLaw::PERSSON),
            ]
        };
        let mut kappa = Vec::from(theories(from, to));
        kappa.extend(curves(&self.meshes, cells, State::kappa, Style::Dashed, ", counted"));
        kappa.extend(curves(
            &self.meshes,
            cells,
            State::corrected_kappa,
            Style::Line,
            ", corrected",
        ));
        let mut left = Vec::new();
        for (place, load) in SHOWN.into_iter().enumerate() {
            for (k, (name, style)) in
                [(", gap", Style::Line), (", stiffness", Style::Dashed)].into_iter().enumerate()
            {
                let points =
                    line(&self.meshes, cells, |family| 100.0 * self.beside_finest(family, load)[k]);
                let name = format!("{}{name}", LOADS[load]);
                left.push(Series::new(name, colour(place), style, points.clone()));
                left.push(Series::new("", colour(place), Style::Dots, points));
            }
        }
        let values = left.iter().flat_map(|s| s.points.iter().map(|p| p.1));
        let (low, high) = values.fold((0.0_f64, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
        let mut widths = Vec::from(theories(narrow, wide));
        widths.extend(curves(&self.bands, band, State::corrected_kappa, Style::Line, ""));
        vec![
            Chart {
                title: "Area over load, λᵣ/λₛ = 8".to_string(),
                x: cells_axis(),
                y: Axis::plain("κ = A E* h′ / load", 1.4, 4.0),
                series: kappa,
                legend: Corner::TopRight,
            },
            Chart {
                title: "Mean gap and stiffness beside the finest mesh".to_string(),
                x: cells_axis(),
                y: Axis::plain("difference [%]", low, high).with_room(0.1, 0.9),
                series: left,
                legend: Corner::TopRight,
            },
            Chart {
                title: "Area over load, corrected, 8 cells".to_string(),
                x: band_axis(),
                y: Axis::plain("κ = A E* h′ / load", 0.4, 3.0),
                series: widths,
                legend: Corner::BottomLeft,
            },
            Chart {
                title: "Interfacial stiffness over load, 8 cells".to_string(),
                x: band_axis(),
                y: Axis::plain("K_i h_rms / load", 0.0, 5.6),
                series: curves(&self.bands, band, |s| s.stiffness, Style::Line, ""),
                legend: Corner::BottomLeft,
            },
        ]
    }
}
