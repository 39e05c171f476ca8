//! The picture of rough contact.

use asperity::reference::AreaLoadLaw;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{BLACK, BLUE, Chart, Corner, GREEN, GREY, ORANGE, Series, Style};

use crate::rough::{FIT, LEAST_LOAD, MOST_LOAD, State, Study};

impl Study {
    /// The states of all surfaces as dots and their mean as a line.
    fn series(&self, x: fn(&State) -> f64, y: fn(&State) -> f64) -> [Series; 2] {
        let dots = self.states.iter().map(|s| (x(s), y(s)));
        let means = (0..self.loads).map(|i| (self.spread(i, x).mean, self.spread(i, y).mean));
        let name = format!("{} surfaces", self.surfaces);
        [
            Series::new(name, BLUE, Style::Dots, dots),
            Series::new("their mean", BLUE, Style::Line, means),
        ]
    }

    pub(crate) fn charts(&self) -> Vec<Chart> {
        let grid =
            || (0..=200).map(|i| LEAST_LOAD * (MOST_LOAD / LEAST_LOAD).powf(i as f64 / 200.0));
        let load = || {
            Axis::plain_logarithmic("mean pressure / (E* h′)", LEAST_LOAD, MOST_LOAD)
                .with_room(0.03, 0.03)
        };
        let with = |mut series: Vec<Series>, own: [Series; 2]| {
            series.extend(own);
            series
        };
        let bgt = AreaLoadLaw::BUSH_GIBSON_THOMAS;
        let (gamma, intercept) = self.exponential();
        let gap_range = (0.0, self.spread(0, |s| s.gap).mean * 1.1);
        let law = |gap: f64| (gap, (intercept - gap / gamma.mean).exp());
        let counted = (0..self.loads).map(|i| {
            let kappa = self.spread(i, |s| s.area / s.load);
            (self.spread(i, |s| s.area).mean, kappa.mean)
        });
        vec![
            Chart {
                title: "Contact area".to_string(),
                x: load(),
                y: Axis::plain_logarithmic("A / A₀", 1e-3, 1.0).with_room(0.0, 0.04),
                series: with(
                    vec![
                        Series::new(
                            "Persson",
                            BLACK,
                            Style::Line,
                            grid().map(|p| (p, self.persson(p))),
                        ),
                        Series::new(
                            "Bush-Gibson-Thomas, κ = √(2π)",
                            ORANGE,
                            Style::Dashed,
                            grid().map(|p| (p, bgt * p)).filter(|(_, a)| *a <= 1.0),
                        ),
                    ],
                    self.series(|s| s.load, |s| s.area),
                ),
                legend: Corner::BottomRight,
            },
            Chart {
                title: "Area over load, corrected".to_string(),
                x: Axis::plain_logarithmic("A / A₀", 2e-3, 1.0),
                y: Axis::plain("κ = A E* h′ / load", 0.6, 3.4),
                series: with(
                    vec![
                        Series::new(
                            "Persson",
                            BLACK,
                            Style::Line,
                            grid().map(|p| (self.persson(p), self.persson(p) / p)),
                        ),
                        Series::new(
                            "Bush-Gibson-Thomas, √(2π)",
                            ORANGE,
                            Style::Dashed,
                            [(2e-3, bgt), (1.0, bgt)],
                        ),
                        Series::new("cells counted whole", GREY, Style::Line, counted),
                    ],
                    self.series(|s| s.area, |s| s.corrected / s.load),
                ),
                legend: Corner::BottomLeft,
            },
            Chart {
                title: "Mean gap".to_string(),
                x: Axis::plain("ḡ / h_rms", gap_range.0, gap_range.1),
                y: Axis::plain_logarithmic("mean pressure / (E* h′)", LEAST_LOAD, MOST_LOAD)
                    .with_room(0.05, 0.08),
                series: with(
                    vec![Series::new(
                        format!("exp(−ḡ/(γ h_rms)), γ = {:.2}", gamma.mean),
                        GREEN,
                        Style::Dashed,
                        (0..=200).map(|i| law(gap_range.1 * f64::from(i) / 200.0)),
                    )],
                    self.series(|s| s.gap, |s| s.load),
                ),
                legend: Corner::TopRight,
            },
            Chart {
                title: "Interfacial stiffness over load".to_string(),
                x: load(),
                y: Axis::plain("K_i h_rms / load", 0.0, 6.0),
                series: with(
                    vec![
                        Series::new(
                            format!("1/γ = {:.2}, fitted", 1.0 / gamma.mean),
                            GREEN,
                            Style::Dashed,
                            [(FIT.0, 1.0 / gamma.mean), (FIT.1, 1.0 / gamma.mean)],
                        ),
                        Series::new(
                            "1/γ = 2.08, Akarapu et al. (2011)",
                            GREY,
                            Style::Dashed,
                            [(LEAST_LOAD, 1.0 / 0.48), (MOST_LOAD, 1.0 / 0.48)],
                        ),
                    ],
                    self.series(|s| s.load, |s| s.stiffness),
                ),
                legend: Corner::BottomLeft,
            },
        ]
    }
}
