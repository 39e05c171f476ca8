//! Which surface the paper had.

use crate::criteria::{self, Claim, Verdict};
use crate::figure7::ratio_of_line;
use crate::report::Report;
use crate::study::Family;
use crate::surfaces::{PAPER_GRADIENT, SIDE, SQ, short_cutoff};
use crate::words::{list, signed};
use crate::{conclusions, statements};
use asperity_studies::spread::Spread;

/// The numbers of the paper that depend on the surface.
pub(crate) fn claims(report: &Report) -> Vec<Claim> {
    let families = &report.study.families;
    let fits = &report.figure7.fits;
    let gradient = |value: fn(&Family) -> f64| move |family: &Family| Spread::of([value(family)]);
    let paper = (PAPER_GRADIENT, "0.112");
    let mut all = vec![
        Claim::number(
            "rms gradient, central differences on 512²",
            paper,
            families,
            gradient(|family| family.central_paper),
            |s| signed(s.mean, 4),
        ),
        Claim::number(
            "rms gradient of the waves",
            paper,
            families,
            gradient(|family| family.gradient),
            |s| signed(s.mean, 4),
        ),
        Claim::number(
            "k under the greatest load",
            (1.0, "1.0"),
            &report.figure6.ratios,
            |r| r.end,
            |s| s.decimals(2),
        ),
        Claim::number(
            "line at large loads: intercept over slope",
            (ratio_of_line(), "0.0123"),
            fits,
            |f| f.offset,
            |s| s.decimals(4),
        ),
        conclusions::near_two(&report.figure6.ratios),
    ];
    all.push(statements::small_patches(report));
    all
}

/// Names of the surfaces for which a gradient and k are not contradicted.
pub(crate) fn possible(report: &Report, claims: &[Claim]) -> Vec<String> {
    let verdict = |claim: usize, place: usize| claims[claim].found[place].verdict;
    let families = report.study.families.iter().enumerate();
    let fits = families.filter(|(place, _)| {
        let fits = |claim| matches!(verdict(claim, *place), Verdict::Agrees | Verdict::Near);
        // The paper does not say which gradient it means.
        (fits(0) || fits(1)) && fits(2)
    });
    fits.map(|(_, family)| quoted(family.rough.name())).collect()
}

fn quoted(name: &str) -> String {
    format!("\"{name}\"")
}

/// What the patches say of those that are possible.
fn by_patches(report: &Report, claims: &[Claim], possible: &[String]) -> String {
    let Some(patches) = claims.last() else {
        return String::new();
    };
    let names = report.names();
    let holds = names.iter().zip(&patches.found);
    let holds = holds.filter(|(_, found)| found.verdict == Verdict::Agrees);
    let holds: Vec<String> = holds.map(|(name, _)| quoted(name)).collect();
    let left: Vec<String> = holds.into_iter().filter(|name| possible.contains(name)).collect();
    format!(
        " Of these, \"most of the contact patches are small\" (Fig. 4) holds for {} at every area, as far as \"small\" means \
         fewer than ten cells.",
        list(&left)
    )
}

pub(crate) fn section(report: &Report, claims: &[Claim]) -> String {
    let study = &report.study;
    let names = report.names();
    let possible = possible(report, claims);
    let excluded: Vec<String> =
        names.iter().map(|name| quoted(name)).filter(|name| !possible.contains(name)).collect();
    let verdict = match possible.len() {
        0 => "none of these surfaces has the paper's gradient and its k under the greatest load."
            .to_string(),
        1 => format!(
            "only {} has the paper's gradient and its k under the greatest load.",
            list(&possible)
        ),
        _ => format!(
            "{} have the paper's gradient and its k under the greatest load. These two numbers do \
             not show whether the table or the amplitudes of the paper were different from what \
             it says.{}",
            list(&possible),
            by_patches(report, claims, &possible)
        ),
    };
    let against = if excluded.is_empty() {
        String::new()
    } else {
        format!(" Contradicted: {}.", list(&excluded))
    };
    format!(
        "## Which surface the paper had\n\n\
         Table 1 of the paper with eq. (23), Sq = {} µm, H = 0.8, λᵣ = L/4, on a square of {} mm, does not have the rms \
         gradient {PAPER_GRADIENT} that the paper states. Two others are shown beside it everywhere, with the same phases \
         for a seed and the same Sq:\n\n\
         * **Table 1**: amplitudes of waves ∝ √C(q), as a power spectrum means, B = 2π√(C/A₀).\n\
         * **no roll-off**: the same with λᵣ = L, against the paper's table.\n\
         * **amplitudes ∝ C**: all of Table 1, but amplitudes of waves ∝ C(q), as if the root in B had been forgotten.\n\n\
         {}\n\
         All ratios k use the gradient of the sum of waves. The short cut-off is \
         {:.1} µm, {:.1} cells. A surface *has the gradient* if either definition agrees or is near.\n\n\
         **Verdict:** {verdict}{against}",
        signed(SQ * 1e6, 0),
        signed(SIDE * 1e3, 0),
        criteria::table(&names, claims),
        short_cutoff(study.nodes) * 1e6,
        short_cutoff(study.nodes) * study.nodes as f64 / SIDE,
    )
}
