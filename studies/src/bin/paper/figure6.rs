//! Fig. 6: the ratio k of area to load against the area.

use std::path::{Path, PathBuf};

use asperity::reference::AreaLoadLaw;

use crate::study::{Family, Study};
use crate::surfaces::E_STAR;
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
/// Areas between which the paper takes k for 2.
const PAPER_RANGE: (f64, f64) = (0.01, 0.15);

/// The ratio of one surface.
pub(crate) struct Ratios {
    /// Steps from one area to the next, 1 % and more, and from the last to the greatest load: in how many k falls,
    /// and how many there are, all runs together; and the same of the mean.
    pub(crate) falls: (usize, usize),
    pub(crate) mean_falls: (usize, usize),
    /// Greatest deviation of the mean k from 2 in the paper's range of areas, as a fraction.
    pub(crate) from_two: f64,
    /// Area over that of Persson's theory at each of [`AREAS`] and under the greatest load, cells counted and
    /// corrected.
    pub(crate) over_persson: Vec<[Spread; 2]>,
    /// k at each of the areas, raw and with the corrected area.
    pub(crate) at: Vec<(f64, Spread, Spread)>,
    /// k under the greatest load, raw and with the corrected area.
    pub(crate) end: Spread,
    pub(crate) end_corrected: Spread,
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
                let numbers =
                    [run.seed as f64, p.area, p.ratio(gradient), p.corrected_ratio(gradient)];
                [vec![family.rough.name().to_string()], numbers.map(|n| n.to_string()).to_vec()]
                    .concat()
            }));
            let name = |text: &'static str| if index == 0 { text } else { "" };
            let raw = run.points.iter().map(|p| (p.area, p.ratio(gradient)));
            let corrected = run.points.iter().map(|p| (p.area, p.corrected_ratio(gradient)));
            series.push(Series::new(
                name("corrected for the staircase"),
                GREY,
                Style::Line,
                corrected,
            ));
            series.push(Series::new(name("cells counted"), colour(place), Style::Line, raw));
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
            y: Axis::plain("k = A E* h′ / W", 0.0, 4.0),
            series,
            legend: Corner::BottomLeft,
        });
    }
    charts.push(against_persson(study));
    write_csv(
        &directory.join("figure6.csv"),
        &["surface", "seed", "area", "k", "corrected_k"],
        rows.into_iter(),
    )?;
    let picture = chart::draw(&charts, 2, &directory.join("figure6.png"))?;
    Ok(Figure6 { ratios: study.families.iter().map(Ratios::of).collect(), picture })
}

/// Contact area over that of Persson's theory, of each surface the mean over the seeds.
fn against_persson(study: &Study) -> Chart {
    let mut series = Vec::new();
    for (place, family) in study.families.iter().enumerate() {
        for (corrected, style) in [(false, Style::Line), (true, Style::Dashed)] {
            let areas = logarithmic(LEAST, 1.0);
            let points = areas.map(|area| (area, family.over_persson(Some(area), corrected).mean));
            let points = points.filter(|(_, ratio)| ratio.is_finite());
            let name = match corrected {
                false => family.rough.name().to_string(),
                true => format!("{}, corrected", family.rough.name()),
            };
            series.push(Series::new(name, colour(place), style, points));
        }
    }
    let ends = [(LEAST, 1.0), (1.0, 1.0)];
    series.push(Series::new("", BLACK, Style::Dashed, ends));
    Chart {
        title: "Area over Persson's erf(√2 W/A₀E*h′), means".to_string(),
        x: Axis::plain_logarithmic("contact area A / A₀", LEAST, 1.0),
        y: Axis::plain("A / A of Persson", 0.8, 2.0),
        series,
        legend: Corner::TopRight,
    }
}

/// Areas evenly spaced in the logarithm, without the last.
fn logarithmic(from: f64, to: f64) -> impl Iterator<Item = f64> {
    let step = (to / from).ln() / SAMPLES as f64;
    (0..SAMPLES).map(move |k| from * (k as f64 * step).exp())
}

impl Family {
    /// Contact area over that of Persson's theory at an area, or under the greatest load.
    fn over_persson(&self, area: Option<f64>, corrected: bool) -> Spread {
        self.spread(|run| {
            let point = match area {
                Some(area) => run.at_area(area)?,
                None => *run.last()?,
            };
            let law = AreaLoadLaw::new(self.gradient, E_STAR).ok()?;
            let found = if corrected { point.corrected } else { point.area };
            Some(found / law.persson(point.load * E_STAR))
        })
    }
}

impl Ratios {
    fn of(family: &Family) -> Self {
        let gradient = family.gradient;
        let raw = |area| family.at_area(area, |p| p.ratio(gradient));
        let corrected = |area| family.at_area(area, |p| p.corrected_ratio(gradient));
        let range = |mean: &dyn Fn(f64) -> f64| {
            let near: Vec<f64> =
                logarithmic(LEAST, 1.0).filter(|a| (mean(*a) / 2.0 - 1.0).abs() <= 0.1).collect();
            Some((*near.first()?, *near.last()?))
        };
        let steps = |value: &dyn Fn(f64) -> Option<f64>, end: Option<f64>| {
            let areas = AREAS.into_iter().filter(|area| *area >= PAPER_RANGE.0);
            let values: Vec<f64> = areas.filter_map(value).chain(end).collect();
            let falls = values.windows(2).filter(|pair| pair[1] < pair[0]).count();
            (falls, values.len().saturating_sub(1))
        };
        let of_runs = family.runs.iter().map(|run| {
            let at = |area| run.at_area(area).map(|p| p.ratio(gradient));
            steps(&at, run.last().map(|p| p.ratio(gradient)))
        });
        let end = family.at_end(|p| p.ratio(gradient));
        let from_two = logarithmic(PAPER_RANGE.0, PAPER_RANGE.1)
            .chain([PAPER_RANGE.1])
            .map(|area| (raw(area).mean / 2.0 - 1.0).abs());
        let areas = AREAS.map(Some).into_iter().chain([None]);
        Self {
            falls: of_runs.fold((0, 0), |sum, found| (sum.0 + found.0, sum.1 + found.1)),
            mean_falls: steps(&|area| Some(raw(area).mean), Some(end.mean)),
            from_two: from_two.fold(0.0, f64::max),
            over_persson: areas
                .map(|area| [false, true].map(|corrected| family.over_persson(area, corrected)))
                .collect(),
            at: AREAS.map(|area| (area, raw(area), corrected(area))).to_vec(),
            end,
            end_corrected: family.at_end(|p| p.corrected_ratio(gradient)),
            near_two: [range(&|a| raw(a).mean), range(&|a| corrected(a).mean)],
        }
    }
}
