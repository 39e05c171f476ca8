//! Fig. 6: the ratio k of area to load against the area.

use std::path::{Path, PathBuf};

use asperity::reference::AreaLoadLaw;

use crate::study::{Family, Study};
use crate::table::write_csv;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLACK, Chart, Corner, GREEN, GREY, PURPLE, Series, Style, colour};
use asperity_cli::outcome::Failure;
use asperity_studies::spread::Spread;

/// Areas of the table.
pub(crate) const AREAS: [f64; 6] = [0.002, 0.01, 0.05, 0.1, 0.15, 0.3];
/// Areas over which the mean curve is sampled, evenly in the logarithm.
const SAMPLES: usize = 200;
const LEAST: f64 = 1e-3;

/// The ratio of one surface.
pub(crate) struct Ratios {
    /// k at each of the areas, raw and with the corrected area.
    pub(crate) at: Vec<(f64, Spread, Spread)>,
    /// k under the greatest load.
    pub(crate) end: Spread,
    /// The areas between which k is within 10 % of 2, the mean over the seeds; raw and corrected.
    pub(crate) near_two: [Option<(f64, f64)>; 2],
}

pub(crate) struct Figure6 {
    pub(crate) ratios: Vec<Ratios>,
    pub(crate) picture: PathBuf,
}

pub(crate) fn make(study: &Study, directory: &Path) -> Result<Figure6, Failure> {
    let mut rows = Vec::new();
    let mut charts = Vec::new();
    for (place, family) in study.families.iter().enumerate() {
        let gradient = family.gradient;
        let mut series = Vec::new();
        for (index, run) in family.runs.iter().enumerate() {
            rows.extend(run.points.iter().map(|p| {
                let numbers = [
                    run.seed as f64,
                    p.area,
                    p.ratio(gradient),
                    p.corrected_ratio(gradient),
                ];
                [
                    vec![family.rough.name().to_string()],
                    numbers.map(|n| n.to_string()).to_vec(),
                ]
                .concat()
            }));
            let name = |text: &'static str| if index == 0 { text } else { "" };
            let raw = run.points.iter().map(|p| (p.area, p.ratio(gradient)));
            let corrected = run
                .points
                .iter()
                .map(|p| (p.area, p.corrected_ratio(gradient)));
            series.push(Series::new(
                name("corrected for the staircase"),
                GREY,
                Style::Line,
                corrected,
            ));
            series.push(Series::new(
                name("cells counted"),
                colour(place),
                Style::Line,
                raw,
            ));
        }
        for (value, colour, name) in [
            (AreaLoadLaw::BUSH_GIBSON_THOMAS, GREEN, "√(2π), Bush et al."),
            (AreaLoadLaw::HYUN, BLACK, "2, Hyun et al."),
            (AreaLoadLaw::PERSSON, PURPLE, "√(8/π), Persson"),
        ] {
            let ends = [(LEAST, value), (1.0, value)];
            series.push(Series::new(name, colour, Style::Dashed, ends));
        }
        charts.push(Chart {
            title: format!("{}, h′ = {:.3}", family.rough.name(), gradient),
            x: Axis::plain_logarithmic("contact area A / A₀", LEAST, 1.0),
            y: Axis::plain("k = A E* h′ / W", 0.0, 3.5),
            series,
            legend: Corner::BottomLeft,
        });
    }
    write_csv(
        &directory.join("figure6.csv"),
        &["surface", "seed", "area", "k", "corrected_k"],
        rows.into_iter(),
    )?;
    let picture = chart::draw(&charts, 2, &directory.join("figure6.png"))?;
    Ok(Figure6 {
        ratios: study.families.iter().map(Ratios::of).collect(),
        picture,
    })
}

impl Ratios {
    fn of(family: &Family) -> Self {
        let gradient = family.gradient;
        let raw = |area| family.at_area(area, |p| p.ratio(gradient));
        let corrected = |area| family.at_area(area, |p| p.corrected_ratio(gradient));
        let range = |mean: &dyn Fn(f64) -> f64| {
            let step = (1.0 / LEAST).ln() / SAMPLES as f64;
            let areas = (0..SAMPLES).map(|k| LEAST * (k as f64 * step).exp());
            let near: Vec<f64> = areas
                .filter(|a| (mean(*a) / 2.0 - 1.0).abs() <= 0.1)
                .collect();
            Some((*near.first()?, *near.last()?))
        };
        Self {
            at: AREAS
                .map(|area| (area, raw(area), corrected(area)))
                .to_vec(),
            end: family.at_end(|p| p.ratio(gradient)),
            near_two: [range(&|a| raw(a).mean), range(&|a| corrected(a).mean)],
        }
    }
}
