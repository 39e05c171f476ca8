//! The three conclusions of the paper, claim by claim.

use crate::criteria::{Claim, Found, Verdict};
use crate::figure6::Ratios;
use crate::figure7::{Fits, LEAST_LOAD, LIGHT_LOADS, SATURATED, SMALL_LOAD, ratio_of_line};
use crate::figure8::{GROWTH, Gap, OUTSIDE, PAPER_RANGE, TOLERANCE};
use crate::report::Report;
use crate::words::{percent, scaled, scientific, signed};

/// Greatest deviation of the exponential over the range of the approach.
const FITS: f64 = 0.05;

/// All of them, with what was found for each surface.
pub(crate) fn claims(report: &Report) -> Vec<Claim> {
    let mut all = area(&report.figure6.ratios);
    all.extend(approach(&report.figure7.fits));
    all.extend(gap(&report.figure8.gaps));
    all
}

fn area(ratios: &[Ratios]) -> Vec<Claim> {
    let falls = ratios.iter().map(|found| {
        let (falls, steps) = found.falls;
        let (mean_falls, mean_steps) = found.mean_falls;
        let text = format!("{falls} of {steps} steps; of the mean {mean_falls} of {mean_steps}");
        let all = [falls == steps, mean_falls == mean_steps];
        Found::new(text, Verdict::of(&all))
    });
    vec![
        Claim::new(
            "(1) k decreases",
            "\"continuingly\"",
            "*agrees* if k falls from each of 1, 5, 10, 15 and 30 % contact to the next and on to the greatest load, for \
             every seed; *in part* if for the mean only",
            falls,
        ),
        Claim::number(
            "(1) k at 0.2 % contact, the start",
            (2.5, "2.5"),
            ratios,
            |r| r.at[0].1,
            |s| s.decimals(2),
        ),
        Claim::number(
            "(1) k under the greatest load",
            (1.0, "1.0"),
            ratios,
            |r| r.end,
            |s| s.decimals(2),
        ),
        near_two(ratios),
    ]
}

/// k = 2 from 1 to 15 % contact.
pub(crate) fn near_two(ratios: &[Ratios]) -> Claim {
    let found = ratios.iter().map(|found| {
        let text = format!("{} % off at most", percent(found.from_two, 1));
        Found::new(text, Verdict::within(found.from_two, 0.1, 0.2))
    });
    Claim::new(
        "(1) k = 2 within 10 % from 1 to 15 %",
        "yes",
        "*agrees* if the mean k is within 10 % of 2 at every area between, *near* within 20 %, else *differs*",
        found,
    )
}

fn approach(fits: &[Fits]) -> Vec<Claim> {
    let exponential = fits.iter().map(|found| {
        let shares = found.light.map(|fit| {
            let share = |value: f64| value / fit.range.mean;
            (share(fit.deviation.mean), share(fit.of_power.mean))
        });
        let list = |value: fn(&(f64, f64)) -> f64| shares.map(|s| percent(value(&s), 1)).join(", ");
        let text = format!("rms {} % of the range of u; power {} %", list(|s| s.0), list(|s| s.1));
        let verdict = if shares.iter().all(|(ours, _)| *ours <= FITS) {
            Verdict::of(&[true, shares.iter().all(|(ours, power)| ours <= power)])
        } else {
            Verdict::Differs
        };
        Found::new(text, verdict)
    });
    let growth = fits.iter().map(|found| {
        let [growing, saturating, power] = found.growth.map(|s| s.mean);
        let text = format!(
            "rms {} % growing, {} % saturating, {} % power",
            percent(growing, 1),
            percent(saturating, 1),
            percent(power, 1)
        );
        let verdict = if growing < power {
            Verdict::Agrees
        } else if saturating < power {
            Verdict::InPart
        } else {
            Verdict::Differs
        };
        Found::new(text, verdict)
    });
    let saturated = fits.iter().map(|found| {
        let area = found.saturated_at;
        let verdict = if area.mean >= 0.9 {
            Verdict::Agrees
        } else if area.mean >= 0.5 {
            Verdict::InPart
        } else {
            Verdict::Differs
        };
        let text = format!("at A/A₀ = {} %", scaled(area, 100.0).decimals(0));
        Found::new(text, verdict)
    });
    let light = scientific(SMALL_LOAD, 1);
    let ranges = LIGHT_LOADS.map(|load| scientific(load, 2)).join(", ");
    vec![
        Claim::new(
            "(2) exponential approach at small loads",
            "\"approximated by\"",
            format!(
                "*agrees* if the rms deviation of y₀ + A exp(−W/t), fitted to u/Sq at evenly spaced W up to \
                 each of {ranges}, is at most {} % of the range of u there and not above that of y₀ + A W^α; *in part* if only the \
                 first; else *differs*",
                percent(FITS, 0)
            ),
            exponential,
        ),
        Claim::number(
            "(2) line at large loads: intercept over slope",
            (ratio_of_line(), "0.0123"),
            fits,
            |f| f.offset,
            |s| s.decimals(4),
        ),
        Claim::new(
            "(2) K \"growths exponentially\"",
            "yes",
            format!(
                "*agrees* if c exp(W/t) fits K at evenly spaced W from {} to {light} better than c W^α, *in part* if only \
                 c (1 − exp(−W/t)) does, else *differs*; rms deviations over the rms K, means",
                scientific(LEAST_LOAD, 1)
            ),
            growth,
        ),
        Claim::new(
            "(2) K saturates because A/A₀ = 1",
            "\"is explained by\"",
            format!(
                "*agrees* if K is {} % of that of the punch from A/A₀ = 90 % on, on average, *in part* if from 50 % on, else \
                 *differs*",
                percent(SATURATED, 0)
            ),
            saturated,
        ),
    ]
}

fn gap(gaps: &[Gap]) -> Vec<Claim> {
    let inside = gaps.iter().map(|found| {
        let text = format!("{} % off at most", percent(found.inside, 1));
        Found::new(text, Verdict::within(found.inside, TOLERANCE, 2.0 * TOLERANCE))
    });
    let end = |value: fn(&Gap) -> f64, paper: f64| {
        gaps.iter().map(move |found| {
            let ours = value(found);
            Found::new(scientific(ours, 2), Verdict::end(paper, ours))
        })
    };
    let outside = gaps.iter().map(|found| {
        let [below, above] = found.outside;
        let text = format!("γ {} and {} of its greatest", signed(below, 2), signed(above, 2));
        let short = [below, above].map(|share| share < 1.0 - TOLERANCE);
        Found::new(text, Verdict::of(&short))
    });
    let growth = gaps.iter().map(|found| {
        let [light, moderate, heavy] = found.exponents.map(|s| s.mean);
        let text = format!(
            "Kᵢ ~ W^{}, W^{}, W^{}",
            signed(light, 2),
            signed(moderate, 2),
            signed(heavy, 2)
        );
        Found::new(text, Verdict::of(&[light, moderate, heavy].map(|exponent| exponent > 1.0)))
    });
    let ranges = GROWTH
        .map(|(from, to)| format!("{} to {}", scientific(from, 1), scientific(to, 1)))
        .join(", ");
    let ends = "as an end of a range; the law holds where γ = W/(Kᵢ Sq), the mean, is within 10 % of its greatest value";
    vec![
        Claim::new(
            "(3) ḡ is linear in ln W from 4 × 10⁻³ to 2 × 10⁻²",
            "yes",
            "*agrees* if the mean γ is within 10 % of that of the fitted line everywhere between, *near* within 20 %, else \
             *differs*",
            inside,
        ),
        Claim::new(
            "(3) lower end of that range",
            "4 × 10⁻³",
            ends,
            end(|gap| gap.range.0, PAPER_RANGE.0),
        ),
        Claim::new(
            "(3) upper end of that range",
            "2 × 10⁻²",
            ends,
            end(|gap| gap.range.1, PAPER_RANGE.1),
        ),
        Claim::new(
            "(3) \"only\" there",
            "yes",
            format!(
                "*agrees* if the mean γ is more than 10 % below its greatest value at both W = {} and {}, *in part* if at \
                 one, else *differs*",
                scientific(OUTSIDE[0], 1),
                scientific(OUTSIDE[1], 1)
            ),
            outside,
        ),
        Claim::new(
            "(3) Kᵢ at \"an increasing growth rate\"",
            "yes",
            format!(
                "*agrees* if dKᵢ/dW grows with W, α > 1 in Kᵢ ~ W^α, in each of the ranges of W {ranges}; *in part* if in some; \
                 else *differs*; means"
            ),
            growth,
        ),
    ]
}
