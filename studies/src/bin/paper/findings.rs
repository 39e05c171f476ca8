//! Rules, and what is wrong or ambiguous in the paper, each with its evidence.

use std::fmt::Write;

use asperity::reference::{AreaLoadLaw, SQUARE_PUNCH_STIFFNESS};

use crate::figure3::{NODES, WAVES};
use crate::figure7::{LIGHT_LOADS, PAPER_EXPONENTIAL};
use crate::misprint;
use crate::plane::Case;
use crate::report::Report;
use crate::rules::Findings;
use crate::surfaces::{PAPER_GRADIENT, PAPER_NODES, SIDE, SQ};
use crate::words::{list as and, scientific, signed};
use asperity_cli::outcome::Failure;

/// First contact against smallest gap.
pub(crate) fn rules(report: &Report) -> String {
    let rules = &report.rules;
    let row = |name: &str, found: &Findings| {
        format!(
            "| {name} | {} | {} of {} | {} | {} of {} | {} |",
            found.backward,
            found.negative,
            found.examined,
            scientific(found.least_pressure, 2),
            found.overlapping,
            found.examined,
            scientific(found.least_gap, 2),
        )
    };
    let parted = rules.parted.map_or("never".to_string(), |step| format!("at node {}", step + 1));
    format!(
        "## The two rules for the next contact\n\n\
         Table 1, seed 1, {} × {} nodes, {} nodes in contact ({:.2} % of the area), by the rule of this crate, *the gap \
         that closes first*, and by the paper's, *the smallest gap*. Every tenth state is examined; counted are \
         pressures below −10⁻¹⁰ of their mean and gaps below −10⁻¹⁰ Sq.\n\n\
         | rule | steps back | p < 0 in states | least p / mean p | overlap in states | least gap / Sq |\n\
         |---|---|---|---|---|---|\n{}\n{}\n\n\
         The two rules first differ {parted}; the contact sets differ in {} of {} states. At the same number of nodes the load \
         differs by up to {:.2} % (from 100 nodes on), the approach by up to {:.3} Sq: this part \
         of the paper's curves is due to its rule.",
        rules.nodes,
        rules.nodes,
        rules.steps,
        100.0 * rules.steps as f64 / (rules.nodes * rules.nodes) as f64,
        row("first contact", &rules.exact),
        row("smallest gap", &rules.smallest_gap),
        rules.other_sets,
        rules.steps,
        100.0 * rules.load,
        rules.approach,
    )
}

/// Where the paper is wrong or ambiguous.
pub(crate) fn list(report: &Report, possible: &[String]) -> Result<String, Failure> {
    let [printed, corrected] =
        misprint::residuals().map_err(|error| Failure::new("the example of eq. (19)", error))?;
    let study = &report.study;
    let punch = study.punch * SIDE / SQ;
    let worst_free = report
        .figure3
        .cases
        .iter()
        .filter(|found| matches!(found.case, Case::FreeWaves(..)))
        .map(|found| found.on_paper_mesh().inner)
        .fold(0.0, f64::max);
    let wave = |half_width: f64| {
        let found = report.figure3.cases.iter().find(|f| f.case == Case::Wave(half_width));
        found.map_or(0.0, |found| found.on_paper_mesh().inner)
    };
    let boundary = boundary_effect(report);
    let all = |value: &dyn Fn(usize) -> String| {
        let names = study.families.iter().enumerate();
        let texts =
            names.map(|(index, family)| format!("{} ({})", value(index), family.rough.name()));
        texts.collect::<Vec<_>>().join(", ")
    };
    let gradients = all(&|i| format!("{:.3}", study.families[i].gradient));
    let ends = all(&|i| report.figure6.ratios[i].end.decimals(2));
    let slopes = all(&|i| report.figure7.fits[i].line[0].decimals(1));
    let approaches = all(&|i| report.figure7.fits[i].approach.decimals(1));
    let starts = all(&|i| {
        let starts = report.figure7.fits[i].light.map(|fit| fit.offset.mean + fit.amplitude.mean);
        starts.map(|start| signed(start, 2)).join(", ")
    });
    let raw = all(&|i| report.figure6.ratios[i].at[1].1.decimals(2));
    let less = all(&|i| report.figure6.ratios[i].at[1].2.decimals(2));
    let (y0, a, _) = PAPER_EXPONENTIAL;
    let ranges = LIGHT_LOADS.map(|load| load.to_string()).join(", ");
    let limit = AreaLoadLaw::PERSSON;
    let area = 1.0 * 0.1 / PAPER_GRADIENT;
    let nodes = area * (PAPER_NODES * PAPER_NODES) as f64;
    let share = std::f64::consts::PI / 16.0;
    let items = [
        format!(
            "**Rule for the next node.** \"The smallest gap\" is not exact: {} of {} examined states have negative \
             pressure, see above. [theory.md](../docs/theory.md#3-the-next-contact) says why.",
            report.rules.smallest_gap.negative, report.rules.smallest_gap.examined
        ),
        format!(
            "**Eq. (3)** is called a point load. It is Love's uniformly loaded square, and its prefactor Δ/πE\\* is right: \
             with it the flat punch on the mesh has K = {punch:.4} E\\*L (exact: {SQUARE_PUNCH_STIFFNESS:.4}); twice the \
             prefactor would halve K."
        ),
        "**Eq. (15)** lacks l₀ = √(c₀ − lᵀl). Step 8 has √(c₀ − xᵀc), equal in exact arithmetic.".to_string(),
        format!(
            "**Eq. (19)**, and step 7, are misprinted: the numerator is l_m and the sum runs over i = m+1 … n, m \
             descending. On a system of 36 influence coefficients the printed form leaves a relative residual of {}, \
             the corrected one {}.",
            scientific(printed, 1),
            scientific(corrected, 1)
        ),
        "**Steps 2 and 13.** Two nodes in contact are after the first event. Step 13 has to compare \
         Δ²Σp with W, and to interpolate in the last interval, or it overshoots by up to one event. Here a path ends \
         at exactly its greatest load."
            .to_string(),
        format!(
            "**Zero padding** is not stated. A free half-space needs (2N)²; without it the problem becomes a \
             periodic one, with another answer: {boundary}."
        ),
        format!(
            "**Eq. (21).** p₀ is called the average pressure, but p\\* = πE\\*Δ/λ, its value there, is the pressure of full \
             contact. The average is p\\* sin²(πa/λ): with it half and quarter contact agree with the closed form \
             within {} and {} p\\* (Fig. 3); with p\\* the loads would be 2 and {:.1} times as large. Δ is the amplitude \
             here, and the mesh size elsewhere.",
            scientific(wave(0.25), 1),
            scientific(wave(0.125), 1),
            1.0 / (std::f64::consts::PI / 8.0).sin().powi(2)
        ),
        format!(
            "**Fig. 3.** Δ = 2/N_x = 0.0124 means N_x = {NODES}. The paper does not say how it computes plane cases. Its {WAVES} free waves in place of a periodic problem are off by up to {} p\\*, \
             and no finer mesh helps.",
            scientific(worst_free, 1)
        ),
        "**Eq. (23)** lacks C₀, has λᵣ for λₛ in its upper limits, and needs B = 2π√(C/A₀) and φ(−q) = −φ(q) for heights \
         that are real and in metres. With these, Sq is met exactly by every seed (`SelfAffine`)."
            .to_string(),
        format!(
            "**The rms gradient {PAPER_GRADIENT}** contradicts Table 1 with eq. (23): {gradients}. k under the greatest load is \
             {ends}, but 1.0 in the paper. Not contradicted by both: {}. The table may be wrong or the amplitudes; \
             see \"Which surface the paper had\".",
            and(possible)
        ),
        format!(
            "**\"pi/16 percent\"** is the fraction π/16 = {:.1} %: {:.0} nodes of 256². Taken as a percentage it would be {:.0} \
             nodes, which do not take 20 minutes. [performance.md](../docs/performance.md#the-headline-case) has our time.",
            100.0 * share,
            (share * 65536.0).floor(),
            share / 100.0 * 65536.0
        ),
        "**Symbols.** E\\* = E/(1 − ν²); k = A E\\* √⟨|∇h|²⟩ / W. Both are hard to read in print.".to_string(),
        format!(
            "**The saturated stiffness 5.8 × 10⁻³** is K Sq/A₀E\\* = {SQUARE_PUNCH_STIFFNESS:.4} Sq/L = {}: the rigid square \
             punch, for any surface.",
            scientific(SQUARE_PUNCH_STIFFNESS * SQ / SIDE, 4)
        ),
        format!(
            "**The fits of Fig. 7.** The exponential starts at {}, not 0; ours, over loads up to {ranges}, at {starts}. The \
             line with slope −8.93 cannot be one of u/Sq, for which saturation alone gives {}; ours has {slopes}. It fits u \
             over 20 Sq, or u over its greatest value, which here is {approaches} Sq.",
            signed(y0 + a, 2),
            signed(-1.0 / (SQUARE_PUNCH_STIFFNESS * SQ / SIDE), 0)
        ),
            "**Figs. 6 to 8** show a free half-space under a finite square, but are compared with theories of an infinite \
             one. At large contact the pressure is greatest at the border (Fig. 4), and approach and K \
             become those of a square punch (Fig. 7)."
            .to_string(),
        format!(
            "**Memory.** k = 1.0 with the gradient {PAPER_GRADIENT} at 0.1 A₀E\\* means A/A₀ = {area:.2}: {:.1} × 10⁵ nodes of \
             512², whose factor takes {:.0} GB, on a computer with 8 GB. Beyond its limit the paper names conjugate \
             gradients with FFT for eq. (11), but not where it used them, nor what they cost. Here it is \
             `FixedLoadSolver`, from {} nodes on.",
            nodes / 1e5,
            4.0 * nodes * nodes / 1e9,
            study.path_nodes
        ),
        format!(
            "**Whole cells** inflate k at small contact: at 1 % it is {raw} with cells counted and {less} with the border \
             corrected. Part of the paper's fall from 2.5 comes from the mesh."
        ),
        format!(
            "**√(8/π)** is taken for what Persson's theory says of all areas, and found \"better\" at large ones (Fig. 6). It \
             is the limit of his theory at *vanishing* load, as √(2π) is that of Bush, Gibson and Thomas; at other loads \
             the theory is the curve A/A₀ = erf(√2 W/A₀E\\*h′), whose k falls. Such a comparison \
             cannot fail either: since A ≤ A₀, k is \
             below √(8/π) = {limit:.3} on every surface from W/A₀E\\* = h′/{limit:.3} on. So it has no verdict here; the \
             comparison with the whole curve has."
        ),
    ];
    let mut text = "## Where the paper is wrong or ambiguous, and the evidence\n\n".to_string();
    for (number, item) in (1..).zip(items) {
        let _ = writeln!(text, "{number}. {item}");
    }
    Ok(text.trim_end().to_string())
}

/// What the boundary does at the same load on the same surface.
fn boundary_effect(report: &Report) -> String {
    let texts = report.boundary.iter().map(|found| {
        format!(
            "{} % more nodes on the periodic half-space at W = {}",
            signed(100.0 * (found.periodic as f64 / found.free as f64 - 1.0), 1),
            scientific(found.load, 1)
        )
    });
    texts.collect::<Vec<_>>().join(", ")
}
