//! What the paper says of its method, claim by claim, each tested once.

use crate::criteria::{Claim, Found, Verdict};
use crate::effort::Effort;
use crate::iterations::{Iterations, LIGHTEST, MODERATE};
use crate::plane::Case;
use crate::polonsky_keer;
use crate::report::Report;
use crate::words::{percent, signed};

/// Memory of the paper's computer.
const MEMORY: f64 = 8e9;

/// All of them.
pub(crate) fn claims(report: &Report) -> Vec<Claim> {
    let mut all = vec![figure3(report), negative(report)];
    all.extend(gradients(&report.iterations));
    all.extend(effort(&report.effort));
    all
}

fn figure3(report: &Report) -> Claim {
    let cases = report.figure3.cases.iter();
    let shown = cases.filter(|found| !matches!(found.case, Case::Wave(_)));
    let worst = shown.map(|found| found.on_paper_mesh().rms);
    let worst = worst.fold(0.0, f64::max);
    Claim::new(
        "Fig. 3: closed forms",
        "\"good agreement\"",
        "*agrees* if the rms error over the contact of the cylinder and of the paper's free waves on its mesh is at most 1 % of \
         p₀ or p\\*, *near* 2 %, else *differs*",
        [Found::new(format!("{} %", percent(worst, 2)), Verdict::within(worst, 0.01, 0.02))],
    )
}

fn negative(report: &Report) -> Claim {
    let found = &report.rules.smallest_gap;
    let verdict = Verdict::of(&[found.negative == 0]);
    Claim::new(
        "no negative pressure, by its rule",
        "\"without any\"",
        "*agrees* if no examined state of the rule \"smallest gap\" has a pressure below −10⁻¹⁰ of the mean, else *differs*",
        [Found::new(format!("{} of {} states", found.negative, found.examined), verdict)],
    )
}

fn gradients(found: &Iterations) -> [Claim; 2] {
    let criterion = "*agrees* if it takes more than twice as many steps at W = 10⁻⁹ as at 10⁻² to the same accuracy, else \
                     *differs*";
    let ends = [LIGHTEST, MODERATE].map(|load| found.at(load));
    let compare = |steps: [Option<usize>; 2]| {
        let text = steps.map(said).join(" steps, ");
        let number = steps.map(|s| s.unwrap_or(polonsky_keer::MOST + 1));
        let verdict = Verdict::of(&[number[0] > 2 * number[1]]);
        Found::new(format!("{text} at 10⁻²"), verdict)
    };
    let plain = compare(ends.map(|steps| steps.and_then(|s| s.plain)));
    let ours = compare(ends.map(|steps| steps.map(|s| s.ours)));
    let paper = "\"drops significantly\"";
    [
        Claim::new(
            "conjugate gradients at infinitesimal contact: plain",
            paper,
            criterion,
            [plain],
        ),
        Claim::new("the same: `FixedLoadSolver`", paper, criterion, [ours]),
    ]
}

/// A number of steps of plain conjugate gradients.
fn said(steps: Option<usize>) -> String {
    steps.map_or(format!("more than {}", polonsky_keer::MOST), |steps| steps.to_string())
}

fn effort(effort: &Effort) -> Vec<Claim> {
    let largest = effort.factors;
    let texts: Vec<String> =
        largest.iter().map(|bytes| format!("{} GB", signed(bytes / 1e9, 1))).collect();
    let fits: Vec<bool> = largest.iter().map(|bytes| *bytes <= MEMORY).collect();
    vec![
        Claim::new(
            "a factor saves half of the memory",
            "\"half of the storage\"",
            "*agrees* if this crate's path holds at most 60 % of the bytes of the influence matrix of the contact, sphere to π/16 of 256² \
             nodes; else *differs*",
            [Found::new(
                format!("{} %", percent(effort.held, 0)),
                Verdict::of(&[effort.held <= 0.6]),
            )],
        ),
        Claim::new(
            "the recursion saves half of the operations",
            "\"half of the computation\"",
            "*agrees* if a step of eqs. (10) to (19) has at most 60 % of the multiplications of one that solves for y₁ and y₂ anew \
             with the factor, counted for the sphere's last step; else *differs*",
            [Found::new(
                format!("{} %", percent(effort.recursion, 0)),
                Verdict::of(&[effort.recursion <= 0.6]),
            )],
        ),
        Claim::new(
            "128² to 1024² practical at 1 to 10 %",
            "\"is practical\"",
            "*agrees* if the factor of 1 % and of 10 % of 1024² fits into the 8 GB of the paper's computer, *in part* if one does, \
             else *differs*",
            [Found::new(texts.join(" and "), Verdict::of(&fits))],
        ),
    ]
}
