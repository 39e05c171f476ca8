//! Verdicts: the paper's numbers and ours, its conclusions, and which surface it had.

use std::fmt::Write;

use crate::figure6::Ratios;
use crate::figure7::{LINE_UNIT, PAPER_LINE, PAPER_STIFFNESS, SMALL_LOADS};
use crate::figure8::{Gap, PAPER_RANGE};
use crate::report::Report;
use crate::surfaces::{PAPER_GRADIENT, PAPER_NODES, SIDE, SQ, short_cutoff};
use asperity_studies::spread::Spread;

/// The verdict on a number of the paper.
pub(crate) fn verdict(paper: f64, ours: Spread) -> &'static str {
    let difference = (ours.mean - paper).abs();
    if difference <= (2.0 * ours.deviation).max(0.05 * paper.abs()) {
        "agrees"
    } else if difference <= 0.2 * paper.abs() {
        "near"
    } else {
        "differs"
    }
}

/// A signed number with so many decimals.
pub(crate) fn signed(value: f64, decimals: usize) -> String {
    format!("{value:.decimals$}").replace('-', "−")
}

/// A number as m × 10ⁿ.
pub(crate) fn scientific(value: f64, digits: usize) -> String {
    asperity_cli::number::scientific(value, digits)
}

/// A table with a column for each surface: quantity, paper, ours and verdict.
pub(crate) struct Table {
    pub(crate) text: String,
}

impl Table {
    pub(crate) fn new(report: &Report) -> Self {
        let names: Vec<&str> = families(report).collect();
        let columns = names
            .iter()
            .map(|name| format!(" {name} | |"))
            .collect::<String>();
        let rules = "---|---|".repeat(names.len());
        Self {
            text: format!("| quantity | paper |{columns}\n|---|---|{rules}\n"),
        }
    }

    pub(crate) fn row(
        &mut self,
        quantity: &str,
        paper: &str,
        cells: impl IntoIterator<Item = [String; 2]>,
    ) {
        let cells = cells
            .into_iter()
            .map(|[ours, verdict]| format!(" {ours} | {verdict} |"));
        let cells = cells.collect::<String>();
        // Writing to a string does not fail.
        let _ = writeln!(self.text, "| {quantity} | {paper} |{cells}");
    }

    /// A row whose verdicts follow from the numbers; `show` writes the spread.
    pub(crate) fn number<'a, T: 'a>(
        &mut self,
        quantity: &str,
        (paper, text): (f64, &str),
        of: impl IntoIterator<Item = &'a T>,
        value: impl Fn(&T) -> Spread,
        show: impl Fn(&Spread) -> String,
    ) {
        let cells = of.into_iter().map(|found| {
            let ours = value(found);
            [show(&ours), verdict(paper, ours).to_string()]
        });
        self.row(quantity, text, cells);
    }
}

pub(crate) fn families(report: &Report) -> impl Iterator<Item = &'static str> + '_ {
    report
        .study
        .families
        .iter()
        .map(|family| family.rough.name())
}

/// The three conclusions.
pub(crate) fn conclusions(report: &Report) -> String {
    let mut table = Table::new(report);
    let ratios = &report.figure6.ratios;
    let start = |r: &Ratios| r.at[0].1;
    table.number(
        "(1) k at 0.2 % contact, \"decreases from 2.5\"",
        (2.5, "2.5"),
        ratios,
        start,
        |s| s.decimals(2),
    );
    table.number(
        "(1) k under the greatest load, \"to 1.0\"",
        (1.0, "1.0"),
        ratios,
        |r| r.end,
        |s| s.decimals(2),
    );
    let near = ratios.iter().map(|r| {
        let ends = [r.at[1].1.mean, r.at[4].1.mean];
        let worst = ends
            .map(|k| (k / 2.0 - 1.0).abs())
            .into_iter()
            .fold(0.0, f64::max);
        let verdict = match worst {
            x if x <= 0.1 => "agrees".to_string(),
            x => format!("near: within {:.0} %", (100.0 * x).ceil()),
        };
        [areas(r.near_two[0]), verdict]
    });
    table.row("(1) areas where k is within 10 % of 2", "1–15 %", near);
    let fits = &report.figure7.fits;
    let exponential = fits.iter().map(|f| {
        let deviation = f.exponentials[1][3];
        [
            format!("rms {} Sq", signed(deviation.mean, 3)),
            "a description, no law".to_string(),
        ]
    });
    let load = scientific(SMALL_LOADS[1], 1);
    table.row(
        &format!("(2) exponential approach, W ≤ {load}: deviation"),
        "not stated",
        exponential,
    );
    table.number(
        "(2) slope of the linear regime, u/20 Sq",
        (PAPER_LINE.0, "−8.93"),
        fits,
        |f| scaled(f.line[0], 1.0 / LINE_UNIT),
        |s| s.decimals(2),
    );
    let growth = fits.iter().map(|f| {
        [
            format!("K ~ W^α, α = {}", f.exponent.decimals(2)),
            "differs: a power".to_string(),
        ]
    });
    table.row("(2) K \"growths exponentially\"", "exponential", growth);
    table.number(
        "(2) saturated K",
        (PAPER_STIFFNESS, "5.8 × 10⁻³"),
        fits,
        |f| f.stiffness,
        |s| s.scientific(-3, 3),
    );
    let ranges = report.figure8.gaps.iter().map(|gap| {
        [
            format!(
                "{} to {}",
                scientific(gap.range.0, 2),
                scientific(gap.range.1, 2)
            ),
            range_verdict(gap).to_string(),
        ]
    });
    table.row(
        "(3) loads where ḡ is linear in ln W",
        "4 × 10⁻³ to 2 × 10⁻²",
        ranges,
    );
    let rates = report.study.families.iter().map(|family| {
        let exponent = |from: f64, to: f64| {
            family.spread(|run| {
                let (a, b) = (run.at_load(from)?, run.at_load(to)?);
                Some((b.interfacial_stiffness / a.interfacial_stiffness).ln() / (to / from).ln())
            })
        };
        let (low, high) = (exponent(1e-4, 1e-3), exponent(3e-2, 1e-1));
        [
            format!(
                "Kᵢ ~ W^{} light, W^{} heavy",
                signed(low.mean, 2),
                signed(high.mean, 2)
            ),
            if high.mean > 1.0 { "agrees" } else { "differs" }.to_string(),
        ]
    });
    table.row("(3) Kᵢ at \"an increasing growth rate\"", "yes", rates);
    format!(
        "### The conclusions of the paper\n\n{}\n\
         \"No roll-off\" is the same spectrum with λᵣ = L; the next section says why it is here. The sections \
         after it say how each number was found.",
        table.text
    )
}

pub(crate) fn scaled(spread: Spread, factor: f64) -> Spread {
    Spread {
        mean: spread.mean * factor,
        deviation: spread.deviation * factor.abs(),
    }
}

pub(crate) fn areas(range: Option<(f64, f64)>) -> String {
    range.map_or("none".to_string(), |(from, to)| {
        format!("{:.1}–{:.0} %", 100.0 * from, 100.0 * to)
    })
}

pub(crate) fn range_verdict(gap: &Gap) -> &'static str {
    let (from, to) = gap.range;
    if from <= 1.05 * PAPER_RANGE.0 && to >= 0.95 * PAPER_RANGE.1 {
        "agrees: contains it"
    } else if from < PAPER_RANGE.1 && to > PAPER_RANGE.0 {
        "in part"
    } else {
        "differs"
    }
}

/// Which surfaces, and why two.
pub(crate) fn surfaces(report: &Report) -> String {
    let families = &report.study.families;
    let mut rows = String::new();
    for family in families {
        let _ = writeln!(
            rows,
            "| {} | {:.4} | {:.4} | {:.4} |",
            family.rough.name(),
            family.gradient,
            family.central,
            family.central_paper,
        );
    }
    let nodes = report.study.nodes;
    let closest = families
        .iter()
        .min_by(|a, b| {
            let distance = |f: &crate::study::Family| (f.central_paper - PAPER_GRADIENT).abs();
            distance(a).total_cmp(&distance(b))
        })
        .map_or("", |family| family.rough.name());
    let fitting: Vec<String> = families
        .iter()
        .zip(&report.figure6.ratios)
        .zip(report.figure7.fits.iter().zip(&report.figure8.gaps))
        .map(|((family, ratios), (fits, gap))| {
            let k = verdict(1.0, ratios.end);
            let line = verdict(PAPER_LINE.1, scaled(fits.line[1], 1.0 / LINE_UNIT));
            format!(
                "* **{}**: gradient {}; k under the greatest load {k} ({}); intercept of the linear \
                 approach {line} ({}); logarithmic gap {}.",
                family.rough.name(),
                verdict(PAPER_GRADIENT, Spread::of([family.central_paper])),
                ratios.end.decimals(2),
                scaled(fits.line[1], 1.0 / LINE_UNIT).decimals(3),
                range_verdict(gap),
            )
        })
        .collect();
    format!(
        "### Two surfaces\n\n\
         Table 1 of the paper with eq. (23), Sq = {} µm, H = 0.8, λᵣ = L/4, on a square of {} mm, does not \
         have the rms gradient {PAPER_GRADIENT} that the paper states. The same spectrum without its \
         roll-off, λᵣ = L, has it, if gradients are central differences on the paper's mesh. Both are \
         shown everywhere. Gradients:\n\n\
         | surface | of the sum of waves, {nodes} × {nodes} | central differences, {nodes} × {nodes} | \
         central differences, {PAPER_NODES} × {PAPER_NODES} |\n|---|---|---|---|\n{rows}\n\
         The surface closest to {PAPER_GRADIENT} is \"{closest}\". The short cut-off is {:.1} µm, {:.1} cells. \
         All ratios k below use the gradient of the sum of waves; with central differences they would be \
         smaller in proportion.\n\n\
         Which surface the paper's numbers fit:\n\n{}",
        signed(SQ * 1e6, 0),
        signed(SIDE * 1e3, 0),
        short_cutoff(nodes) * 1e6,
        short_cutoff(nodes) * nodes as f64 / SIDE,
        fitting.join("\n"),
    )
}
