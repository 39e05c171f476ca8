//! The figures, one section each.

use std::fmt::Write;

use crate::figure3::{NODES, WAVES};
use crate::figure7::{
    Fits, LARGE_LOAD, LINE_UNIT, PAPER_EXPONENTIAL, PAPER_LINE, PAPER_STIFFNESS, SMALL_LOADS,
};
use crate::plane::{Case, LENGTH};
use crate::report::Report;
use crate::surfaces::{PAPER_GRADIENT, SIDE, SQ};
use crate::verdicts::{Table, areas, families, scaled, scientific, verdict};
use asperity_cli::number::power_of_ten;
use asperity_studies::spread::Spread;

fn picture(prefix: &str, figure: u8, text: &str) -> String {
    format!("![{text}]({prefix}figure{figure}.png)")
}

/// Plane contacts.
pub(crate) fn figure3(report: &Report, prefix: &str) -> String {
    let figure = &report.figure3;
    let mut rows = String::new();
    for found in &figure.cases {
        let error = found.on_paper_mesh();
        let orders = match found.case {
            // Free waves do not tend to the periodic solution.
            Case::FreeWaves(..) => "–".to_string(),
            _ => format!("{:.2}, {:.2}", found.orders.0, found.orders.1),
        };
        let _ = writeln!(
            rows,
            "| {} | {} | {} | {orders} |",
            found.case.name(),
            scientific(error.inner, 2),
            scientific(error.rms, 2),
        );
    }
    let waves = |count: f64| {
        let found = figure.waves.iter().find(|(waves, _)| *waves == count);
        scientific(found.map_or(0.0, |(_, error)| *error), 1)
    };
    let length = figure.lengths.iter().find(|(length, _)| *length == 1.0);
    let length = length.map_or(0.0, |(_, change)| *change);
    let worst = figure
        .cases
        .iter()
        .filter(|found| matches!(found.case, Case::FreeWaves(..)))
        .map(|found| found.on_paper_mesh().inner)
        .fold(0.0, f64::max);
    format!(
        "### Fig. 3: plane contacts against their closed forms\n\n{}\n\n\
         The paper does not say how it computes plane cases with a kernel in three dimensions. Here a single \
         row of cells is used, each a bar across the whole strip, so that no quantity can vary along it:\n\n\
         * **Cylinder**, eq. (20): the free half-space, a strip {LENGTH:.0} times as long as the domain is wide. \
         The error of a finite length ℓ is of second order in 1/ℓ: {} of p₀ if the strip is as long as the domain \
         is wide, and 10⁻⁶ times as large with the length used.\n\
         * **Wave**, eqs. (21) and (22): `PeriodicBoussinesq` with one cell along y is the plane periodic problem \
         without approximation, one wavelength.\n\
         * **{WAVES} free waves**: the paper's substitute for it, on the domain (−5, 5); the middle wave is compared \
         at the same mean pressure. The error, up to {} p\\*, does not fall with a finer mesh, only with more waves: \
         {} with 1, {} with 3, {} with {WAVES} and {} with 15 at half contact.\n\n\
         Errors of the pressure over p₀ or p\\* with N = {NODES} cells over the contact of the cylinder, or the \
         wavelength. *Inner* is the greatest error on |x| < 0.6 a, *rms* the root mean square over the contact. Both are \
         averages over 20 loads with 0.9 to 1.1 times the half-width, since the error depends on where in a cell \
         the edge lies (full contact: one load). \
         Orders of convergence by a fit from N = 21 to 641:\n\n\
         | case | inner error | rms error | orders, inner and rms |\n|---|---|---|---|\n{rows}\n\
         **Verdict: agrees.** Away from the edge of contact the error is of second order in the cell size. Over the \
         whole contact it is of first order, because the edge cuts cells; in full contact there is no edge, and it is \
         of second order. Free waves have an error of their own that no finer mesh removes.",
        picture(
            prefix,
            3,
            "Pressures of plane contacts, and their errors against mesh, length of the strip and number of waves"
        ),
        scientific(length, 2),
        scientific(worst, 2),
        waves(1.0),
        waves(3.0),
        waves(WAVES as f64),
        waves(15.0),
    )
}

/// Contact maps.
pub(crate) fn figure4(report: &Report, prefix: &str) -> String {
    let mut rows = String::new();
    for map in &report.figure4.maps {
        let _ = writeln!(
            rows,
            "| {} | {:.1} % | {} | {:.3} | {} | {:.0} % | {:.0} % | {:.0} % |",
            map.surface,
            100.0 * map.area,
            scientific(map.load, 3),
            map.greatest,
            map.patches,
            100.0 * map.small,
            100.0 * map.in_small,
            100.0 * map.in_large,
        );
    }
    let agrees = report.figure4.maps.iter().all(|map| map.small > 0.5);
    let large = report
        .figure4
        .maps
        .iter()
        .filter(|map| map.in_large > 0.5)
        .count();
    format!(
        "### Fig. 4: where the surface touches\n\n{}\n\n\
         The paper: \"most of the contact patches are small and sparsely distributed …, while the majority of \
         the contact points belong to large patches\". Counted for seed 1, with patches of fewer than ten cells \
         as small and the largest tenth of the patches as large:\n\n\
         | surface | A/A₀ | W/A₀E\\* | greatest p/E\\* | patches | small ones | contact in small ones | contact in the \
         largest tenth |\n|---|---|---|---|---|---|---|---|\n{rows}\n\
         **Verdict:** most patches are small {}; more than half of the contact is in the largest tenth in {large} of \
         {} maps. The pressure is greatest along the border of the square at large contact: the cause is \
         the finite punch on a free half-space, and not roughness.",
        picture(
            prefix,
            4,
            "Contact maps at four areas, coloured by pressure"
        ),
        if agrees {
            "at every area"
        } else {
            "at most areas"
        },
        report.figure4.maps.len(),
    )
}

/// Area against load.
pub(crate) fn figure5(report: &Report, prefix: &str) -> String {
    let mut table = Table::new(report);
    let fits = &report.figure5.fits;
    let pearson = fits.iter().map(|f| {
        // To the digits of the paper.
        let near = (f.pearson.mean - 0.999).abs() <= (2.0 * f.pearson.deviation).max(5e-4);
        let verdict = if near { "agrees" } else { "differs" };
        [f.pearson.decimals(4), verdict.to_string()]
    });
    table.row("Pearson r below 30 % contact", "0.999", pearson);
    let plain = |value: String| [value, String::new()];
    table.row(
        "slope of the line, A/A₀ per W/A₀E\\*",
        "–",
        fits.iter().map(|f| plain(f.slope.decimals(2))),
    );
    table.row(
        "greatest deviation from it, of 30 %",
        "–",
        fits.iter()
            .map(|f| plain(format!("{} %", scaled(f.worst, 100.0).decimals(1)))),
    );
    table.row(
        "A/A₀ at 0.1 A₀E\\*",
        "0.89, from k = 1.0 and h′ = 0.112",
        fits.iter().map(|f| {
            [
                f.end.decimals(3),
                verdict(0.1 / PAPER_GRADIENT, f.end).to_string(),
            ]
        }),
    );
    format!(
        "### Fig. 5: area against load\n\n{}\n\n{}\n\
         Evenly spaced loads. A correlation of 0.999 does not make a law linear: a line with an intercept \
         also fits a gently curved law, and k of Fig. 6 falls over the same range.",
        picture(prefix, 5, "Contact area against load"),
        table.text,
    )
}

/// Area over load.
pub(crate) fn figure6(report: &Report, prefix: &str) -> String {
    let ratios = &report.figure6.ratios;
    let mut head = "| A/A₀ |".to_string();
    for name in families(report) {
        let _ = write!(head, " {name}, cells counted | corrected |");
    }
    let mut rows = String::new();
    for (index, (area, _, _)) in ratios.first().map_or(&[][..], |r| &r.at).iter().enumerate() {
        let _ = write!(rows, "| {:.1} % |", 100.0 * area);
        for found in ratios {
            let (_, raw, corrected) = &found.at[index];
            let _ = write!(rows, " {} | {} |", raw.decimals(2), corrected.decimals(2));
        }
        rows.push('\n');
    }
    let _ = write!(rows, "| at 0.1 A₀E\\* |");
    for found in ratios {
        let _ = write!(rows, " {} | |", found.end.decimals(2));
    }
    let near: Vec<String> = families(report)
        .zip(ratios)
        .map(|(name, found)| {
            format!(
                "{name}: {} with cells counted, {} corrected",
                areas(found.near_two[0]),
                areas(found.near_two[1])
            )
        })
        .collect();
    let central: Vec<String> = report
        .study
        .families
        .iter()
        .zip(ratios)
        .map(|(family, found)| {
            let k = scaled(found.end, family.central_paper / family.gradient);
            format!("{} for {}", k.decimals(2), family.rough.name())
        })
        .collect();
    format!(
        "### Fig. 6: the ratio of area to load\n\n{}\n\n\
         k = A E\\* h′ / W. \"Corrected\" is the area without what whole cells along the border of the contact add to \
         it: (π − 1 + ln 2)/24 times the length of the staircase times the cell size (Yastrebov, Anciaux and Molinari 2017, \
         arXiv 1701.02727).\n\n{head}\n|---|{}\n{rows}\n\n\
         Within 10 % of 2: {}. With the gradient by central differences on the paper's mesh, k under the greatest \
         load is {}.\n\n\
         **Verdict:** k falls all the way, as the paper says, from about √(2π) towards √(8/π) and below. How \
         high it starts depends in good part on the mesh: corrected, it starts lower. To end at 1.0, a surface \
         must be almost in full contact at 0.1 A₀E\\*, which takes a small gradient.",
        picture(prefix, 6, "Ratio of area to load against area"),
        "---|---|".repeat(ratios.len()),
        near.join("; "),
        central.join(", "),
    )
}

/// Approach and contact stiffness.
pub(crate) fn figure7(report: &Report, prefix: &str) -> String {
    let fits = &report.figure7.fits;
    let mut table = Table::new(report);
    let (y0, a, t) = PAPER_EXPONENTIAL;
    for (index, greatest) in SMALL_LOADS.iter().enumerate() {
        let at = |k: usize| move |f: &Fits| f.exponentials[index][k];
        let range = format!("W ≤ {}", scientific(*greatest, 2));
        let decimals = |s: &Spread| s.decimals(2);
        table.number(
            &format!("y₀, {range}"),
            (y0, "−2.56"),
            fits,
            at(0),
            decimals,
        );
        table.number(&format!("A, {range}"), (a, "2.26"), fits, at(1), decimals);
        table.number(&format!("t, {range}"), (t, "0.0021"), fits, at(2), |s| {
            s.decimals(4)
        });
    }
    let (slope, intercept) = PAPER_LINE;
    table.number(
        "slope, u/20 Sq",
        (slope, "−8.93"),
        fits,
        |f| scaled(f.line[0], 1.0 / LINE_UNIT),
        |s| s.decimals(2),
    );
    table.number(
        "intercept, u/20 Sq",
        (intercept, "−0.11"),
        fits,
        |f| scaled(f.line[1], 1.0 / LINE_UNIT),
        |s| s.decimals(3),
    );
    let plain = |value: String| [value, String::new()];
    table.row(
        "slope, u/Sq",
        "–",
        fits.iter().map(|f| plain(f.line[0].decimals(1))),
    );
    table.row(
        "approach at 0.1 A₀E\\*, over Sq",
        "–",
        fits.iter().map(|f| plain(f.approach.decimals(2))),
    );
    table.number(
        "K at 0.1 A₀E\\*",
        (PAPER_STIFFNESS, "5.8 × 10⁻³"),
        fits,
        |f| f.stiffness,
        |s| s.scientific(-3, 3),
    );
    let share = fits
        .iter()
        .map(|f| plain(scaled(f.stiffness, 1.0 / report.study.punch).decimals(4)));
    table.row("K at 0.1 A₀E\\*, over the punch on this mesh", "–", share);
    let tenth = report.study.families.iter().map(|family| {
        let share = family.at_area(0.1, |p| p.contact_stiffness / report.study.punch);
        plain(share.decimals(3))
    });
    table.row("K over the punch at 10 % contact", "–", tenth);
    table.row(
        "exponent of K ~ W^α, W from 10⁻⁴ to 10⁻³",
        "–",
        fits.iter().map(|f| plain(f.exponent.decimals(2))),
    );
    let exact = asperity::reference::SQUARE_PUNCH_STIFFNESS * SQ / SIDE;
    let punch = report.study.punch;
    format!(
        "### Fig. 7: approach and contact stiffness\n\n{}\n\n{}\n\
         The exponential is y₀ + A exp(−W/t) through u/Sq = −δ/Sq, the line is fitted from {} on; both by least \
         squares over evenly spaced loads, since the paper does not say which it took. The fits of the exponential \
         depend on the range more than on the seed, and none starts at 0, where every path does. All three numbers \
         agree for: {}.\n\n\
         **Saturated stiffness.** The rigid square punch has K = {} E\\*L, {} in these units; the same punch on \
         the mesh has {} ({:.2} % less, the error of the mesh), and the rough surfaces end there: the value has \
         nothing to do with roughness. Nor does it take A/A₀ = 1, as the paper says: see the row at 10 % contact.\n\n\
         **Growth at light loads.** K follows a power of the load over the decades in which the paper sees an \
         exponential. For few asperities of a finite surface the exponent 1/(1 + H) = 0.56 is expected \
         (Pastewka et al., arXiv 1210.4635).",
        picture(
            prefix,
            7,
            "Approach and contact stiffness against load, with fits"
        ),
        table.text,
        scientific(LARGE_LOAD, 1),
        exponentials(report),
        asperity::reference::SQUARE_PUNCH_STIFFNESS,
        scientific(exact, 4),
        scientific(punch, 4),
        100.0 * (1.0 - punch / exact),
    )
}

/// Ranges over which all three numbers of the exponential are the paper's.
fn exponentials(report: &Report) -> String {
    let paper = [
        PAPER_EXPONENTIAL.0,
        PAPER_EXPONENTIAL.1,
        PAPER_EXPONENTIAL.2,
    ];
    let mut texts = Vec::new();
    for (name, fits) in families(report).zip(&report.figure7.fits) {
        for (greatest, found) in SMALL_LOADS.iter().zip(&fits.exponentials) {
            if paper
                .iter()
                .zip(found)
                .all(|(paper, ours)| verdict(*paper, *ours) == "agrees")
            {
                texts.push(format!("{name} with W ≤ {}", scientific(*greatest, 2)));
            }
        }
    }
    if texts.is_empty() {
        "none of these ranges".to_string()
    } else {
        texts.join(", ")
    }
}

/// Mean gap and interfacial stiffness.
pub(crate) fn figure8(report: &Report, prefix: &str) -> String {
    let mut rows = String::new();
    for (name, gap) in families(report).zip(&report.figure8.gaps) {
        let _ = writeln!(
            rows,
            "| {name} | {} to {} | {:.2} | {} | {} | {}, {} |",
            scientific(gap.range.0, 2),
            scientific(gap.range.1, 2),
            gap.greatest,
            gap.decay.decimals(3),
            gap.pearson.decimals(4),
            gap.ends[0].decimals(2),
            gap.ends[1].decimals(2),
        );
    }
    format!(
        "### Fig. 8: mean gap and interfacial stiffness\n\n{}\n\n\
         A gap that falls linearly with ln W, ḡ = const − γ Sq ln W, has γ = −dḡ/d(ln W)/Sq = W/(Kᵢ Sq), which \
         the exact stiffness gives at every state. The law is taken to hold where γ, averaged over the \
         seeds, is within 10 % of its greatest value. The line is fitted in the paper's range, 4 × {} to \
         2 × {}.\n\n\
         | surface | range of the law | greatest γ | γ of the line | Pearson r of the line | γ at the ends of \
         the paper's range over γ of the line |\n|---|---|---|---|---|---|\n{rows}\n\
         **Verdict:** the law holds over a moderate range only, as the paper says; verdicts on its ends are in the \
         first table. γ is near the 0.4 to 0.5 of Persson's theory, where the gap closes over a length in \
         proportion to Sq. Below the range few asperities carry the load and γ is smaller (a finite surface has a highest \
         summit); beyond it contact is so large that the gap runs out.",
        picture(
            prefix,
            8,
            "Mean gap, its slope and the interfacial stiffness against load"
        ),
        power_of_ten(-3),
        power_of_ten(-2),
    )
}
