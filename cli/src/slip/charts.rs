//! `slip.png` and `history.png`: curves of the joint.

use std::path::{Path, PathBuf};

use asperity::slip::{SlipCycle, SlipState};
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLUE, Chart, Corner, GREEN, GREY, ORANGE, PURPLE, Series, Style};
use asperity_cli::number::quantity;
use asperity_cli::outcome::Failure;

use super::history::Sheared;
use super::joint::Joint;

/// Amplitudes of the loops, over the sliding load.
const LOOPS: [f64; 4] = [0.95, 0.75, 0.5, 0.25];
/// Points of half a loop.
const HALF: usize = 120;
/// Bins of the distribution of slip displacements, in a factor of ten.
const BINS: usize = 8;
/// Decades of it that are shown.
const SHOWN: f64 = 3.0;

/// Draws the six charts of a joint.
pub(super) fn draw(joint: &Joint, name: &Path) -> Result<PathBuf, Failure> {
    let charts = [
        Some(loops(joint)),
        dissipation(joint),
        stiffness(joint),
        loss_factor(joint),
        Some(stick_area(joint)),
        distribution(joint),
    ];
    let charts: Vec<Chart> = charts.into_iter().flatten().collect();
    chart::draw(&charts, 3, name)
}

/// By Masing's rule: a branch is the first loading, twice as large.
fn loops(joint: &Joint) -> Chart {
    let (limit, far) = (joint.slip.sliding_load(), joint.slip.sliding_displacement());
    let colours = [BLUE, ORANGE, GREEN, PURPLE];
    let branch = |share: f64, sign: f64| -> Option<Vec<(f64, f64)>> {
        let amplitude = share * limit;
        let end = joint.slip.monotone(amplitude).ok()?;
        let points = (0..=HALF).filter_map(|k| {
            let down = 2.0 * amplitude * k as f64 / HALF as f64;
            let half = joint.slip.monotone(0.5 * down).ok()?;
            Some((sign * (end.displacement - 2.0 * half.displacement), sign * (amplitude - down)))
        });
        Some(points.collect())
    };
    // Each way alone: a thick line that comes back on itself would be drawn with holes.
    let loops = LOOPS.iter().zip(colours).flat_map(|(share, colour)| {
        let names = [format!("{share} μP"), String::new()];
        let ways = names.into_iter().zip([1.0, -1.0]).filter_map(move |(name, sign)| {
            Some(Series::new(name, colour, Style::Line, branch(*share, sign)?))
        });
        ways.collect::<Vec<_>>()
    });
    let first = joint.loading.iter().map(|state| (state.displacement, state.tangential_load));
    let first = Series::new("first loading", GREY, Style::Dashed, first);
    Chart {
        title: format!("cycles under P = {}", quantity(joint.state.load, "N", 4)),
        x: Axis::linear("displacement U", "m", -far, far),
        y: Axis::linear("tangential load T", "N", -1.06 * limit, 1.06 * limit),
        series: [first].into_iter().chain(loops).collect(),
        legend: Corner::TopLeft,
    }
}

/// Points of a quantity of cycles in two colours: grey where few nodes slip.
fn of_cycles(joint: &Joint, quantity: impl Fn(&SlipCycle) -> f64) -> Vec<Series> {
    let (few, many): (Vec<&SlipCycle>, Vec<&SlipCycle>) =
        joint.cycles.iter().partition(|cycle| cycle.has_few_nodes());
    let points = |cycles: Vec<&SlipCycle>| -> Vec<(f64, f64)> {
        cycles.into_iter().map(|cycle| (cycle.amplitude, quantity(cycle))).collect()
    };
    let mut series = vec![Series::new("", BLUE, Style::Dots, points(many))];
    if !few.is_empty() {
        series.push(Series::new("fewer than 50 nodes slip", GREY, Style::Dots, points(few)));
    }
    series
}

/// The axis of the amplitude.
fn amplitudes(joint: &Joint) -> Option<Axis> {
    let (first, last) = (joint.cycles.first()?, joint.cycles.last()?);
    let axis = Axis::logarithmic("amplitude of T", "N", first.amplitude, last.amplitude);
    Some(axis.with_room(0.04, 0.04))
}

fn dissipation(joint: &Joint) -> Option<Chart> {
    let (first, last) = (joint.cycles.first()?, joint.cycles.last()?);
    let mut series = of_cycles(joint, |cycle| cycle.dissipation);
    // A cube for the eye, through the middle of the resolved points.
    let resolved: Vec<_> = joint.cycles.iter().filter(|cycle| !cycle.has_few_nodes()).collect();
    if let Some(from) = resolved.first() {
        let least = last.dissipation.min(first.dissipation);
        let cube = |amplitude: f64| from.dissipation * (amplitude / from.amplitude).powi(3);
        let points = joint.cycles.iter().map(|cycle| (cycle.amplitude, cube(cycle.amplitude)));
        let inside = points.filter(|(_, d)| (least..=last.dissipation).contains(d));
        series.insert(0, Series::new("slope 3", ORANGE, Style::Dashed, inside));
    }
    let title = match joint.exponent {
        Some(exponent) => format!("dissipation of a cycle, as T to the {exponent:.2}"),
        None => "dissipation of a cycle".to_string(),
    };
    let y = Axis::logarithmic("dissipation", "J", first.dissipation, last.dissipation);
    Some(Chart {
        title,
        x: amplitudes(joint)?,
        y: y.with_room(0.04, 0.06),
        series,
        legend: Corner::TopLeft,
    })
}

fn stiffness(joint: &Joint) -> Option<Chart> {
    let finite = |cycle: &SlipCycle| cycle.secant_stiffness;
    let greatest = joint.cycles.iter().map(finite).filter(|k| k.is_finite()).fold(0.0, f64::max);
    let series = of_cycles(joint, finite);
    (greatest > 0.0).then_some(())?;
    Some(Chart {
        title: "secant stiffness of a cycle".to_string(),
        x: amplitudes(joint)?,
        y: Axis::linear("T/U", "N/m", 0.0, 1.06 * greatest),
        series,
        legend: Corner::BottomLeft,
    })
}

fn loss_factor(joint: &Joint) -> Option<Chart> {
    let factors = || joint.cycles.iter().map(|cycle| cycle.loss_factor);
    let (least, most) = (factors().reduce(f64::min)?, factors().reduce(f64::max)?);
    let y = Axis::plain_logarithmic("D/(π T U)", least, most);
    Some(Chart {
        title: "loss factor of a cycle".to_string(),
        x: amplitudes(joint)?,
        y: y.with_room(0.04, 0.06),
        series: of_cycles(joint, |cycle| cycle.loss_factor),
        legend: Corner::TopLeft,
    })
}

fn stick_area(joint: &Joint) -> Chart {
    let all = joint.slip.preload().contact_area;
    let share = |state: &SlipState| (state.tangential_load, state.stick_area / all);
    let curve = joint.loading.iter().map(share);
    let at = share(&joint.state);
    let limit = joint.slip.sliding_load();
    Chart {
        title: "what sticks".to_string(),
        x: Axis::linear("tangential load T", "N", 0.0, 1.03 * limit),
        y: Axis::plain("stick area / contact area", 0.0, 1.06),
        series: vec![
            Series::new("", BLUE, Style::Line, curve),
            Series::new("the load asked for", ORANGE, Style::Dots, [at]),
        ],
        legend: Corner::TopRight,
    }
}

/// Iwan's density of slip displacements, in bins of one ratio.
fn distribution(joint: &Joint) -> Option<Chart> {
    let far = joint.slip.sliding_displacement();
    let bins = (SHOWN * BINS as f64) as usize;
    let mut sums = vec![0.0; bins];
    for element in joint.slip.jenkins_elements() {
        let place = SHOWN + (element.slip_displacement / far).log10();
        if place >= 0.0 {
            sums[((place * BINS as f64) as usize).min(bins - 1)] += element.stiffness;
        }
    }
    let edge = |k: usize| far * 10_f64.powf(k as f64 / BINS as f64 - SHOWN);
    let density: Vec<(f64, f64)> = sums
        .iter()
        .enumerate()
        .filter(|(_, sum)| **sum > 0.0)
        .map(|(k, sum)| ((edge(k) * edge(k + 1)).sqrt(), sum / (edge(k + 1) - edge(k))))
        .collect();
    let values = density.iter().map(|(_, density)| *density);
    let (least, most) = (values.clone().fold(f64::INFINITY, f64::min), values.fold(0.0, f64::max));
    (most > 0.0).then_some(())?;
    Some(Chart {
        title: "Iwan's distribution of elements".to_string(),
        x: Axis::logarithmic("slip displacement", "m", edge(0), far).with_room(0.0, 0.04),
        y: Axis::logarithmic("density of stiffness", "N/m²", least, most).with_room(0.04, 0.06),
        series: vec![
            Series::new("", BLUE, Style::Line, density.iter().copied()),
            Series::new("", BLUE, Style::Dots, density.iter().copied()),
        ],
        legend: Corner::TopRight,
    })
}

/// Draws a history: T against U, and both loads row by row.
pub(super) fn draw_history(sheared: &Sheared, name: &Path) -> Result<PathBuf, Failure> {
    let most = |of: &dyn Fn(&SlipState) -> f64| {
        sheared.ways.iter().flatten().map(|state| of(state).abs()).fold(f64::MIN_POSITIVE, f64::max)
    };
    let shift = most(&|state| state.displacement);
    let (force, load) = (most(&|state| state.tangential_load), most(&|state| state.load));
    // One by one: a thick line that comes back on itself would be drawn with holes.
    let lines = |of: &dyn Fn(&SlipState) -> (f64, f64)| -> Vec<Series> {
        let line = |way: &Vec<SlipState>| Series::new("", BLUE, Style::Line, way.iter().map(of));
        sheared.ways.iter().map(line).collect()
    };
    let curve = lines(&|state| (state.displacement, state.tangential_load));
    let loads = lines(&|state| (state.load, state.tangential_load));
    let lost: Vec<(f64, f64)> =
        (1..).map(f64::from).zip(sheared.rows.iter().map(|row| row.1)).collect();
    let tangential = || Axis::linear("tangential load T", "N", -1.06 * force, 1.06 * force);
    let legend = Corner::TopLeft;
    let charts = [
        Chart {
            title: "history".to_string(),
            x: Axis::linear("displacement U", "m", -1.06 * shift, 1.06 * shift),
            y: tangential(),
            series: curve,
            legend,
        },
        Chart {
            title: "loads".to_string(),
            x: Axis::linear("load P", "N", 0.0, 1.06 * load),
            y: tangential(),
            series: loads,
            legend,
        },
        Chart {
            title: "energy lost".to_string(),
            x: Axis::plain("row", 0.0, sheared.rows.len() as f64 + 0.5),
            y: Axis::linear("dissipation", "J", 0.0, 1.06 * sheared.dissipation()),
            series: vec![Series::new("", BLUE, Style::Line, lost)],
            legend,
        },
    ];
    chart::draw(&charts, 3, name)
}
