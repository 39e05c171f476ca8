//! `loading_curve.svg`: area, approach, mean gap and stiffnesses against load.

use std::path::{Path, PathBuf};

use asperity::LoadingState;
use plotters::prelude::*;

use super::job::Job;
use super::sheet;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{BLUE, ORANGE, Series, Style};
use asperity_cli::half_space::is_of_mean_planes;
use asperity_cli::number::{counted, quantity};
use asperity_cli::outcome::Failure;
use asperity_cli::panel::{Area, Drawn};

/// A quantity of a state.
type Quantity = fn(&LoadingState) -> f64;
/// What a curve shows, its colour, and its name if there are several in a panel.
type Curve = (Quantity, RGBColor, &'static str);

/// Draws the picture into a directory.
pub(super) fn draw(
    job: &Job,
    states: &[LoadingState],
    directory: &Path,
) -> Result<PathBuf, Failure> {
    let name = directory.join("loading_curve.svg");
    sheet::write(&name, |area| panels(area, job, states), |area| panels(area, job, states))
}

fn panels<DB: DrawingBackend>(area: &Area<DB>, job: &Job, states: &[LoadingState]) -> Drawn<DB> {
    area.fill(&WHITE)?;
    let (nx, ny) = job.grid().shape();
    let title = format!(
        "Loading path of {}: {nx} × {ny} nodes{}, E* = {}, Sq = {}",
        counted(states.len(), "state"),
        match job.periodic() {
            None => String::new(),
            Some(kernel) => format!(", {}", kernel.in_words()),
        },
        quantity(job.e_star(), "Pa", 4),
        quantity(job.heights().rms_height(), "m", 4)
    );
    sheet::title(area, &title)?;

    let loaded: Vec<LoadingState> =
        states.iter().filter(|s| s.contact.load > 0.0).copied().collect();
    let Some((from, to)) = extent(&loaded, &[|s| s.contact.load]) else {
        sheet::instead(area, "No state of this path carries load.")?;
        return area.present();
    };
    let load = || Axis::logarithmic("load W", "N", from, to).with_room(0.0, 0.02);

    let logarithmic = |name, unit, quantities: &[Quantity]| {
        let (low, high) = extent(&loaded, quantities).unwrap_or((1.0, 10.0));
        Axis::logarithmic(name, unit, low, high).with_room(0.04, 0.06)
    };
    let linear = |name, unit, quantity: Quantity| {
        let highest = loaded.iter().map(quantity).fold(0.0, f64::max);
        let lowest = loaded.iter().map(quantity).fold(0.0, f64::min);
        // A mean gap that is to be zero may be off by rounding.
        if lowest < -1e-6 * highest {
            Axis::linear(name, unit, lowest, highest).with_room(0.05, 0.06)
        } else {
            Axis::linear(name, unit, 0.0, highest).with_room(0.0, 0.06)
        }
    };

    // A half-space that repeats both ways has no approach but that of the mean planes, and no stiffness but the
    // interfacial one.
    let has_stiffness = loaded.iter().any(|s| s.contact.contact_stiffness.is_some());
    let both: [Curve; 2] = [
        (contact_stiffness, BLUE, "contact, K = dW/dδ"),
        (interfacial_stiffness, ORANGE, "interfacial, −dW/d(mean gap)"),
    ];
    let interfacial: [Curve; 1] = [(both[1].0, BLUE, "")];
    let (approach, stiffness, stiffnesses) = match is_of_mean_planes(job.periodic(), has_stiffness)
    {
        false => ("approach δ", "stiffness", &both[..]),
        true => ("approach of the mean planes", "interfacial stiffness", &interfacial[..]),
    };
    let contact_and_yielded: [Curve; 2] =
        [(|s| s.contact.contact_area, BLUE, "contact"), (yielded_area, ORANGE, "yielded")];
    let contact: [Curve; 1] = [(|s| s.contact.contact_area, BLUE, "")];
    let areas = match job.has_hardness() {
        true => &contact_and_yielded[..],
        false => &contact[..],
    };
    let all: [(Axis, &[Curve]); 4] = [
        (
            logarithmic(
                "contact area A",
                "m²",
                &areas.iter().map(|(value, ..)| *value).collect::<Vec<_>>(),
            ),
            areas,
        ),
        (linear(approach, "m", |s| s.contact.approach), &[(|s| s.contact.approach, BLUE, "")]),
        (linear("mean gap", "m", |s| s.contact.mean_gap), &[(|s| s.contact.mean_gap, BLUE, "")]),
        (
            logarithmic(
                stiffness,
                "N/m",
                &stiffnesses.iter().map(|(value, ..)| *value).collect::<Vec<_>>(),
            ),
            stiffnesses,
        ),
    ];
    for (place, (y, curves)) in (0_i32..).zip(all) {
        let panel = sheet::panel(place);
        let x = load();
        panel.rule(area, &x, &y)?;
        for (value, colour, _) in curves {
            let points = loaded.iter().map(|state| (state.contact.load, value(state)));
            Series::new("", *colour, Style::Line, points).draw(area, &panel, (&x, &y))?;
        }
        sheet::legend(area, &panel, curves.iter().map(|(_, colour, name)| (*colour, *name)))?;
        panel.frame(area, &x, &y)?;
    }
    area.present()
}

/// NaN, which is not drawn, where nothing has yielded.
fn yielded_area(state: &LoadingState) -> f64 {
    let yielded = state.contact.plastic.map_or(0, |plastic| plastic.yielded_nodes);
    let area = state.contact.contact_area * yielded as f64 / state.contact.contact_nodes as f64;
    if yielded > 0 { area } else { f64::NAN }
}

/// NaN, which is not drawn, where there is none.
fn contact_stiffness(state: &LoadingState) -> f64 {
    state.contact.contact_stiffness.unwrap_or(f64::NAN)
}

/// The same.
fn interfacial_stiffness(state: &LoadingState) -> f64 {
    state.contact.interfacial_stiffness.unwrap_or(f64::NAN)
}

/// Least and greatest positive finite value of some quantities.
fn extent(states: &[LoadingState], quantities: &[Quantity]) -> Option<(f64, f64)> {
    let values = || {
        let each = quantities.iter().flat_map(|q| states.iter().map(q));
        each.filter(|value| *value > 0.0 && value.is_finite())
    };
    values().next()?;
    Some((values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max)))
}
