//! What the paper says of its curves and maps beyond its conclusions, claim by claim.

use crate::criteria::{Claim, Found, Verdict};
use crate::figure4::Map;
use crate::figure5::{PAPER_END, Straight};
use crate::figure6::{AREAS, Ratios};
use crate::report::Report;
use crate::words::percent;
use asperity::reference::AreaLoadLaw;

/// 1 − r of the paper's correlation.
const SCATTER: f64 = 1e-3;

/// All of them, with what was found for each surface.
pub(crate) fn claims(report: &Report) -> Vec<Claim> {
    let mut all = vec![small_patches(report), large_patches(report)];
    all.extend(line(&report.figure5.fits, report.study.seeds));
    all.extend(theories(&report.figure6.ratios));
    all
}

/// The maps of each surface.
fn of_surface<'a>(report: &'a Report, name: &'a str) -> impl Iterator<Item = &'a Map> {
    let maps = report.figure4.maps.iter();
    maps.filter(move |map| map.surface == name)
}

/// A share of every map of each surface: whether it is more than half.
fn shares(report: &Report, share: fn(&Map) -> f64) -> impl Iterator<Item = Found> {
    report.study.families.iter().map(move |family| {
        let shares: Vec<f64> = of_surface(report, family.rough.name()).map(share).collect();
        let text: Vec<String> = shares.iter().map(|s| percent(*s, 0)).collect();
        let most: Vec<bool> = shares.iter().map(|s| *s > 0.5).collect();
        Found::new(format!("{} %", text.join(", ")), Verdict::of(&most))
    })
}

/// Small patches in Fig. 4.
pub(crate) fn small_patches(report: &Report) -> Claim {
    Claim::new(
        "Fig. 4: most patches are small",
        "yes",
        "*agrees* if more than half of the patches of seed 1 have fewer than ten cells in each of four maps, *in part* in \
         some, else *differs*",
        shares(report, |map| map.small),
    )
}

fn large_patches(report: &Report) -> Claim {
    Claim::new(
        "Fig. 4: most contact is in large patches",
        "yes",
        "the same with the part of the contact that is in the largest tenth of the patches",
        shares(report, |map| map.in_large),
    )
}

fn line(fits: &[Straight], seeds: u64) -> Vec<Claim> {
    let pearson = fits.iter().map(|fit| {
        let scatter = (1.0 - fit.pearson.mean) / SCATTER;
        let verdict = Verdict::within(scatter.max(1.0 / scatter), 2.0, 4.0);
        Found::new(fit.pearson.decimals(4), verdict)
    });
    let slopes = fits.iter().map(|fit| {
        let [below, lower, upper] = fit.slopes.map(|s| s.decimals(2));
        let text = format!("{below}, {lower}, {upper}; {} of {seeds} seeds", fit.falling);
        let mean = fit.slopes.map(|s| s.mean);
        let all = [fit.falling as u64 == seeds, mean[0] > mean[1] && mean[1] > mean[2]];
        Found::new(text, Verdict::of(&all))
    });
    vec![
        Claim::new(
            "Fig. 5: Pearson's r below 30 % contact",
            "0.999",
            "*agrees* if the mean 1 − r is within a factor of 2 of 0.001, *near* within 4, else *differs*",
            pearson,
        ),
        Claim::new(
            "Fig. 5: beyond 30 % the slope falls",
            "yes",
            "slopes of A/A₀ against W/A₀E\\*: of the line below 30 %, and of lines through the lower and the upper half of the \
             loads beyond; *agrees* if each is less than the one before for every seed, *in part* if for the mean only",
            slopes,
        ),
        Claim::number(
            "Fig. 5: A/A₀ at 0.1 A₀E\\*",
            (PAPER_END.1, "0.89, from k and h′"),
            fits,
            |fit| fit.end,
            |s| s.decimals(3),
        ),
    ]
}

fn theories(ratios: &[Ratios]) -> Vec<Claim> {
    let (bush, persson) = (AreaLoadLaw::BUSH_GIBSON_THOMAS, AreaLoadLaw::PERSSON);
    // Cells counted, and corrected.
    let light = ratios.iter().map(|found| {
        let k = [found.at[1].1, found.at[1].2];
        let middle = 0.5 * (bush + persson);
        let decided = k.iter().all(|k| (k.mean - middle).abs() > 2.0 * k.deviation);
        let verdict =
            if decided { Verdict::of(&k.map(|k| k.mean > middle)) } else { Verdict::Undecided };
        let text = format!("k = {}, {} corrected", k[0].decimals(2), k[1].decimals(2));
        Found::new(text, verdict)
    });
    let low = ratios.iter().map(|found| {
        // From the second to the last area of the table; behind it there is the greatest load.
        let (areas, end) = found.over_persson.split_at(AREAS.len());
        let of = |k: usize| areas.iter().skip(1).map(move |over| over[k].mean);
        let least = [0, 1].map(|k| of(k).fold(f64::INFINITY, f64::min));
        let greatest = [0, 1].map(|k| of(k).fold(0.0, f64::max));
        let last = [0, 1].map(|k| end.first().map_or(f64::NAN, |over| over[k].mean));
        let text = format!(
            "{:.2} to {:.2} of it, {:.2} under the greatest load; {:.2} to {:.2}, {:.2} corrected",
            least[0], greatest[0], last[0], least[1], greatest[1], last[1]
        );
        let above = [least, last].concat().into_iter().map(|ratio| ratio > 1.0);
        Found::new(text, Verdict::of(&above.collect::<Vec<_>>()))
    });
    vec![
        Claim::new(
            "Fig. 6: √(2π) is better at small areas",
            "yes",
            "*agrees* if the mean k at 1 % contact is nearer to √(2π) than to √(8/π), with cells counted and corrected, *in \
             part* with one of them, else *differs*; *undecided* if either is less than 2σ from the middle between the two",
            light,
        ),
        Claim::new(
            "Persson's theory underestimates the area",
            "yes, by others",
            "*agrees* if the mean area is above erf(√2 W/A₀E\\*h′) at each of 1, 5, 10, 15 and 30 % contact and under the greatest \
             load, with cells counted and corrected, *in part* in some of these cases, else *differs*",
            low,
        ),
    ]
}
