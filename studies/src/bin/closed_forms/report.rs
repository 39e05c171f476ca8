//! Table, text and picture.

use std::fmt::Write;

use asperity::reference::SQUARE_PUNCH_STIFFNESS;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{BLACK, BLUE, Chart, Corner, GREEN, GREY, ORANGE, PURPLE, Series, Style};
use asperity_cli::number::scientific;

use crate::curve::{CELLS, COEFFICIENT, Curve, LOADS, Quantity, SLACK, TOLERANCE};
use crate::double_wave::{BEYOND, BRACKET, CLOSE, Comparison, EXACT, Limit};
use crate::punch::SquarePunch;

/// By how much the extrapolated stiffness of the square punch may differ from the known one, which is known to a few
/// units of its seventh decimal.
const PUNCH_CLOSE: f64 = 3e-6;

/// All that was found.
pub(crate) struct Report {
    pub(crate) curves: Vec<Curve>,
    pub(crate) punch: SquarePunch,
    pub(crate) wave: Comparison,
}

fn verdict(agrees: bool) -> &'static str {
    if agrees { "agrees" } else { "**differs**" }
}

fn plural(agree: bool) -> &'static str {
    if agree { "agree" } else { "differ" }
}

impl Report {
    pub(crate) fn text(&self) -> String {
        let mut text = format!(
            "## Closed forms\n\n\
             Study `closed_forms`: `FixedLoadSolver` to {} against `asperity::reference`, which shares no code with \
             it, at equal load: the root mean square of the relative error over {LOADS} loads from 3/4 to 5/4 of a \
             target (of radii, for the circular punch) and four places of the apex between the nodes. Cells are \
             counted over the radius of the contact, the shorter semi-axis or the half-width. Pressures are the \
             greatest; those of the cone and the punch, which are infinite there, from 0.35 to 0.65 of the \
             radius.\n\n\
             **Criterion**, for every entry: the order fitted to the finest four meshes is at least the expected one \
             less {SLACK}, and on the finest mesh the error is at most {COEFFICIENT} × cells^(−expected order). \
             *Expected* is 2, but 1 for area, stiffness, and the pressure under a circular edge that cells do not \
             follow.\n\n\
             ![Errors of area, approach, pressure, stiffness and energy against the cells over a contact, and the wave \
             in two directions beside its limits](images/closed_forms.png)\n\n\
             The error with {} cells, and in brackets the order at which it falls:\n\n{}\n",
            scientific(TOLERANCE, 1),
            CELLS[CELLS.len() - 1],
            self.table(),
        );
        let agreeing = self.curves.iter().filter(|curve| curve.agrees()).count();
        // Writing to a string cannot fail.
        let _ =
            write!(text, "**Verdict: {agreeing} of {} entries agree.**\n\n", self.curves.len(),);
        self.square_punch(&mut text);
        self.double_wave(&mut text);
        text
    }

    /// A line for each contact, a column for each quantity; an entry that does not agree is marked.
    fn table(&self) -> String {
        let names = Quantity::ALL.map(|quantity| format!(" {} |", quantity.name()));
        let mut text =
            format!("| contact |{}\n|---{}|\n", names.concat(), "|---".repeat(names.len()));
        let mut contacts: Vec<&str> = self.curves.iter().map(|curve| curve.contact).collect();
        contacts.dedup();
        for contact in contacts {
            let cells = Quantity::ALL.map(|quantity| {
                let mut of = self.curves.iter();
                let curve = of.find(|c| c.contact == contact && c.quantity == quantity);
                curve.map_or(" – |".to_string(), |curve| {
                    let (_, error) = curve.points[CELLS.len() - 1];
                    let mark = if curve.agrees() { "" } else { " **differs**" };
                    format!(" {error:.1e} ({:.2}){mark} |", curve.order())
                })
            });
            // Writing to a string cannot fail.
            let _ = writeln!(text, "| {contact} |{}", cells.concat());
        }
        text
    }

    fn square_punch(&self, text: &mut String) {
        let finest = self.punch.stiffness.last().map_or(0, |(cells, _)| *cells);
        let limit = self.punch.limit();
        let close = (limit - SQUARE_PUNCH_STIFFNESS).abs() <= PUNCH_CLOSE;
        let _ = write!(
            text,
            "### The square punch\n\n\
             No closed form is known, only numbers: K = π × 0.3667874 E\\*L = 1.152297 E\\*L, the capacity of a \
             square. Grids of up to {finest} cells a side, extrapolated, have {limit:.7}. **Verdict: {}** (criterion: \
             within {} of it).\n\n",
            verdict(close),
            scientific(PUNCH_CLOSE, 1),
        );
    }

    fn double_wave(&self, text: &mut String) {
        let wave = &self.wave;
        let _ = write!(
            text,
            "### A wave in two directions\n\n\
             K. L. Johnson, J. A. Greenwood and J. G. Higginson (1985): z = D cos(2πx/λ) cos(2πy/λ) is flat from p\\* \
             = √2 πE\\*D/λ on; under a light load each crest is a Hertz contact by itself, and just below p\\* each \
             valley a penny crack. In between there is no closed form.\n\n\
             **Full contact.** At p̄ = {BEYOND} p\\* the pressure is p̄ + p\\* cos cos, at most {:.2} p\\*, and the \
             energy p\\*DA₀/8. p̄ less the least pressure is the load of full contact on the mesh. Relative errors:\n\n\
             | kernel | nodes a wave | load of full contact | greatest pressure | energy |\n|---|---|---|---|---|\n",
            1.0 + BEYOND,
        );
        for full in &wave.full {
            if let Some((nodes, errors)) = full.errors.last() {
                let [load, peak, energy] = errors.map(|error| format!("{error:.1e}"));
                let name = full.kernel.name();
                let _ = writeln!(text, "| {name} | {nodes} | {load} | {peak} | {energy} |");
            }
        }
        let [love, spectral] = &wave.full;
        let _ = write!(
            text,
            "\n**Verdict: Love {}, spectral {}** (criteria: contact full at 1 + {bracket} of the load found and not at \
             1 − {bracket} on every grid; Love's second order within 0.2, found {:.2}; spectral errors within {}).\n\n",
            verdict(love.agrees()),
            verdict(spectral.agrees()),
            love.order(),
            scientific(EXACT, 1),
            bracket = scientific(BRACKET, 1),
        );
        let farthest = |limit: &Limit| {
            scientific(limit.ratios.iter().map(|(distance, _)| *distance).fold(0.0, f64::max), 1)
        };
        let _ = writeln!(
            text,
            "**The two limits.** Corrected area in contact over that of Hertz contacts, π(3P/8π)^⅔, with {} nodes a \
             wave, and corrected area out of contact over that of the cracks, 3(1 − P)/2π, with {}; P = p̄/p\\*, \
             kernel Love, means over four places of the crest. Lines in P^⅔ up to P = {} and in 1 − P up to {} go to \
             {:.4} and {:.4} at the limits. **Verdict: contacts {}, holes {}** (criterion: 1 within {CLOSE}).",
            wave.light.nodes,
            wave.heavy.nodes,
            farthest(&wave.light),
            farthest(&wave.heavy),
            wave.light.extrapolated(),
            wave.heavy.extrapolated(),
            plural(wave.light.agrees()),
            plural(wave.heavy.agrees()),
        );
    }

    pub(crate) fn csv(&self) -> String {
        let mut text = "contact,quantity,cells,rms_relative_error\n".to_string();
        for curve in &self.curves {
            for (cells, error) in &curve.points {
                let quantity = curve.quantity.name().replace(',', "");
                let contact = curve.contact.replace(',', "");
                let _ = writeln!(text, "{contact},{quantity},{cells},{error:e}");
            }
        }
        text
    }

    pub(crate) fn charts(&self) -> Vec<Chart> {
        let shown = [
            Quantity::Area,
            Quantity::Distance,
            Quantity::Pressure,
            Quantity::Stiffness,
            Quantity::Energy,
        ];
        let mut charts: Vec<_> = shown.map(|quantity| self.chart(quantity)).into();
        charts.push(self.limits());
        charts
    }

    fn chart(&self, quantity: Quantity) -> Chart {
        let curves = || self.curves.iter().filter(|c| c.quantity == quantity);
        let points = || curves().flat_map(|c| c.points.iter().copied());
        let least = points().fold(f64::INFINITY, |least, (_, e)| least.min(e));
        let most = points().fold(0.0_f64, |most, (_, e)| most.max(e));
        let (from, to) = (CELLS[0] as f64, CELLS[CELLS.len() - 1] as f64);
        let order = quantity.order();
        let guide = |cells: f64| (cells, 2.5 * most * (from / cells).powf(order));
        let mut series =
            vec![Series::new(format!("order {order}"), GREY, Style::Dashed, [from, to].map(guide))];
        for curve in curves() {
            let (colour, style) = look(curve.contact);
            let points = curve.points.clone();
            series.push(Series::new(curve.contact, colour, style, points.clone()));
            series.push(Series::new("", colour, Style::Dots, points));
        }
        // Room for the legend under the curves.
        let floor = least * 1e-3;
        Chart {
            title: quantity.name().to_string(),
            x: Axis::plain_logarithmic("cells over the radius", 3.0, 170.0),
            y: Axis::plain_logarithmic("rms relative error", floor, 3.0 * most),
            series,
            legend: Corner::BottomLeft,
        }
    }

    fn limits(&self) -> Chart {
        let points = |limit: &Limit| -> Vec<(f64, f64)> {
            limit.ratios.iter().map(|(d, r)| (*d, r.mean)).collect()
        };
        let (light, heavy) = (points(&self.wave.light), points(&self.wave.heavy));
        let all = || light.iter().chain(&heavy).map(|(_, ratio)| *ratio);
        let low = all().fold(1.0_f64, f64::min);
        let high = all().fold(1.0_f64, f64::max);
        Chart {
            title: "wave in two directions".to_string(),
            x: Axis::plain_logarithmic("distance from the limit, P or 1 − P", 1e-4, 0.1)
                .with_room(0.05, 0.05),
            y: Axis::plain("area over that of the limit", low, high).with_room(0.5, 0.2),
            series: vec![
                Series::new("", GREY, Style::Dashed, [(1e-4, 1.0), (0.1, 1.0)]),
                Series::new("contact over Hertz, P → 0", BLUE, Style::Line, light.clone()),
                Series::new("", BLUE, Style::Dots, light),
                Series::new("no contact over cracks, P → 1", ORANGE, Style::Line, heavy.clone()),
                Series::new("", ORANGE, Style::Dots, heavy),
            ],
            legend: Corner::BottomLeft,
        }
    }
}

/// Colour and line of a contact, the same in every panel; periodic ones are dashed.
fn look(contact: &str) -> (plotters::style::RGBColor, Style) {
    match contact {
        "sphere" => (BLUE, Style::Line),
        "ellipse" => (ORANGE, Style::Line),
        "cone" => (GREEN, Style::Line),
        "circular punch" => (PURPLE, Style::Line),
        "square punch" => (GREY, Style::Line),
        "wave, Love" => (BLUE, Style::Dashed),
        "wave, spectral" => (ORANGE, Style::Dashed),
        _ => (BLACK, Style::Line),
    }
}
