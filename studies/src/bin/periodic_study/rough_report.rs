//! Table and text of rough contact.

use std::fmt::Write;

use asperity::reference::AreaLoadLaw;
use asperity_studies::spread::Spread;

use crate::rough::{CUTOFF, FIT, HURST, LIGHT, Study};

/// By how much the area that is still open under the greatest load may differ from that of Persson's theory, relative.
const OPEN: f64 = 0.1;
/// γ in Persson's theory and in the simulations known.
const GAMMA: (f64, f64) = (0.4, 0.5);

fn verdict(agrees: bool) -> &'static str {
    if agrees { "agrees" } else { "differs" }
}

impl Study {
    pub(crate) fn text(&self) -> String {
        let (gamma, _) = self.exponential();
        let (persson, bgt) = (AreaLoadLaw::PERSSON, AreaLoadLaw::BUSH_GIBSON_THOMAS);
        let counted = self.kappa(|s| s.area);
        let corrected = self.kappa(|s| s.corrected);
        let between = self.light().all(|load| {
            let kappa = self.spread(load, |s| s.corrected / s.load).mean;
            kappa > persson && kappa < bgt
        });
        let last = self.loads - 1;
        let at_last = self.at(last).next().map_or(f64::NAN, |s| s.load);
        let open = self.spread(last, |s| 1.0 - s.area);
        let open_of_persson = 1.0 - self.persson(at_last);
        let off = open.mean / open_of_persson - 1.0;
        let upper = (0..self.loads).filter(|load| {
            let load = self.at(*load).next().map_or(f64::NAN, |s| s.load);
            load >= 0.1 * FIT.1 && load <= FIT.1
        });
        let stiffness = Spread::of(upper.map(|load| self.spread(load, |s| s.stiffness).mean));
        format!(
            "### Rough contact against theory\n\n\
             ![Area, mean gap and interfacial stiffness of self-affine surfaces against \
             load](images/periodic_study.png)\n\n\
             {} self-affine surfaces of {n} × {n} nodes (H = {HURST}, roll-off at a quarter and short cut-off at 1/32 \
             of the side, {:.0} cells), kernel {}; {} loads each. *Corrected* is the area without the excess of whole \
             cells along the edge of the contact. Mean ± standard deviation of one surface:\n\n{}\n\
             * **Area, light.** Where A/A₀ is below {LIGHT}, κ is {} with cells counted and {} corrected. Bush, Gibson \
             and Thomas have √(2π) = {bgt:.3} for vanishing load, Persson √(8/π) = {persson:.3}. The corrected κ is \
             between the two at every light load: {} (criterion: the mean of the surfaces, each load).\n\
             * **Area, heavy.** Persson's theory, A/A₀ = erf(√2 p̄/(E\\* h′)), is exact in full contact. Under the \
             greatest load the open area is {} of A₀, {:.4} by the theory, {:.0} % {} than it says: {} (criterion: \
             within {:.0} %).\n\
             * **Mean gap.** With p̄/(E\\* h′) from {} to {}, p̄ ∝ exp(−ḡ/(γ h_rms)) fits with γ = {}: {} (criterion: \
             from {} to {}). Akarapu, Sharp and Robbins (Phys. Rev. Lett. 106 (2011) 204301) found 0.48 for the \
             stiffness.\n\
             * **Stiffness.** K_i h_rms/(A₀ p̄) is {} over the upper decade of the same loads, and 1/γ = {:.2}, \
             because the curve is not exactly exponential.",
            self.surfaces,
            CUTOFF * self.nodes as f64,
            self.kernel.name(),
            self.loads,
            self.table(),
            counted.decimals(2),
            corrected.decimals(2),
            verdict(between),
            open.decimals(4),
            open_of_persson,
            100.0 * off.abs(),
            if off < 0.0 { "less" } else { "more" },
            verdict(off.abs() <= OPEN),
            100.0 * OPEN,
            FIT.0,
            FIT.1,
            gamma.decimals(3),
            verdict(gamma.mean >= GAMMA.0 && gamma.mean <= GAMMA.1),
            GAMMA.0,
            GAMMA.1,
            stiffness.decimals(2),
            1.0 / gamma.mean,
            n = self.nodes,
        )
    }

    fn table(&self) -> String {
        let mut text =
            "| p̄/(E\\* h′) | A/A₀ | Persson | κ = A E\\* h′/(A₀ p̄) | κ, corrected | ḡ/h_rms | \
                        K_i h_rms/(A₀ p̄) |\n|---|---|---|---|---|---|---|\n"
                .to_string();
        for load in (0..self.loads).step_by((self.loads / 2).max(1)) {
            let Some(first) = self.at(load).next() else {
                break;
            };
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "| {:.2e} | {} | {:.4} | {} | {} | {} | {} |",
                first.load,
                self.spread(load, |s| s.area).decimals(4),
                self.persson(first.load),
                self.spread(load, |s| s.area / s.load).decimals(2),
                self.spread(load, |s| s.corrected / s.load).decimals(2),
                self.spread(load, |s| s.gap).decimals(3),
                self.spread(load, |s| s.stiffness).decimals(2),
            );
        }
        text
    }
}
