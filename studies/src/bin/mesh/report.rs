//! Tables and text.

use std::fmt::Write;

use asperity::patches::Perimeter;
use asperity::reference::AreaLoadLaw;
use asperity_studies::spread::Spread;

use crate::states::{HURST, LOADS, ROLLOFF, State};
use crate::study::{BAND, CELLS, REMOVED, Study};

/// The load at which κ of different spectra is told apart best, with many contacts that are still apart.
const MIDDLE: usize = 2;

impl Study {
    pub(crate) fn text(&self) -> String {
        [self.introduction(), self.mesh(), self.choice(), self.spectrum()].join("\n\n")
    }

    fn introduction(&self) -> String {
        format!(
            "## Mesh and spectrum\n\n\
             Study `mesh`: how much do κ = A E\\* h′/(A₀ p̄), the mean gap and the interfacial stiffness depend on the \
             mesh?\n\n\
             Self-affine surfaces (H = {HURST}, roll-off at {ROLLOFF} of the side, kernel Love), {} seeds, the same on \
             every mesh, {} loads, of which the first table shows every second; *cells* are those to the shortest \
             wave, λₛ. *Corrected* is the area less (π − 1 + ln 2)/24 = {:.4} cells for each side of a cell between \
             contact and no contact (`Perimeter::corrected_area`; Yastrebov, Anciaux & Molinari, Tribol. Int. 114 \
             (2017) 161). *Limit* is Richardson's extrapolation from the finest two meshes, 2 κ(Δ/2) − κ(Δ). Mean ± \
             standard deviation of one surface. In the picture the numbers are p̄/(E\\* h′).\n\n\
             ![Ratio of area to load, mean gap and stiffness against the cells to the shortest wave and against the \
             width of the spectrum](images/mesh.png)",
            self.surfaces,
            LOADS.len(),
            Perimeter::AREA_CORRECTION,
        )
    }

    fn mesh(&self) -> String {
        let mut text = format!(
            "### Cells to the shortest wave\n\nλᵣ/λₛ = {BAND}. κ, counted:\n\n| p̄/(E\\* h′) |"
        );
        // Writing to a string cannot fail.
        for family in &self.meshes {
            let _ = write!(text, " {} cells |", family.mesh.cells);
        }
        text.push_str(" limit |\n|---|---|");
        text.push_str(&"---|".repeat(self.meshes.len()));
        text.push('\n');
        for (place, load) in LOADS.iter().enumerate().step_by(2) {
            let _ = write!(text, "| {load} |");
            for family in &self.meshes {
                let _ = write!(text, " {} |", family.spread(place, State::kappa).decimals(2));
            }
            let _ = writeln!(text, " {} |", self.limit(place).decimals(2));
        }
        let taken: Vec<f64> = self.meshes.iter().map(|f| self.taken(f)).collect();
        let agrees = taken.iter().all(|part| (part - 1.0).abs() <= 1.0 - REMOVED);
        let parts: Vec<String> = taken
            .iter()
            .zip(&self.meshes)
            .map(|(part, f)| format!("{:.0} % with {}", 100.0 * part, f.mesh.cells))
            .collect();
        let factor = Spread::of(taken.iter().map(|part| Perimeter::AREA_CORRECTION / part));
        let limits = || (0..LOADS.len()).map(|load| self.limit(load).mean);
        let (bgt, persson) = (AreaLoadLaw::BUSH_GIBSON_THOMAS, AreaLoadLaw::PERSSON);
        let between = limits().all(|kappa| kappa > persson && kappa < bgt);
        let _ = write!(
            text,
            "\n**Verdict on the correction: {}** (criterion: on every mesh, on the mean over the loads, at most {:.0} \
             % of the excess of the counted area is left, with either sign). It removes {} cells. The factor that fits \
             these surfaces is {} in the place of {:.4}.\n\n\
             {} between √(2π) = {bgt:.3} and Persson's √(8/π) = {persson:.3} {}; a κ near or above √(2π) on a coarse \
             mesh is an artefact of the mesh.",
            if agrees { "agrees" } else { "differs" },
            100.0 * (1.0 - REMOVED),
            parts.join(", "),
            factor.decimals(3),
            Perimeter::AREA_CORRECTION,
            if between { "The limit is" } else { "The limit is not" },
            if between { "at every load" } else { "at each load" },
        );
        text
    }

    fn choice(&self) -> String {
        let mut text = "### What to choose\n\n\
            Greatest error of each mesh over the loads, on the mean over the surfaces, in per cent of the limit for κ \
            and of the finest mesh for the others:\n\n\
            | cells | κ counted | κ corrected | mean gap | stiffness |\n|---|---|---|---|---|\n"
            .to_string();
        let worst = |value: &dyn Fn(usize) -> f64| {
            let each = (0..LOADS.len()).map(value);
            let worst =
                each.fold(0.0_f64, |worst, x| if x.abs() > worst.abs() { x } else { worst });
            format!("{:+.1}", 100.0 * worst).replace('-', "−")
        };
        for (place, family) in self.meshes.iter().enumerate() {
            let beside = |k: usize| match place + 1 == self.meshes.len() {
                true => "–".to_string(),
                false => worst(&|load| self.beside_finest(family, load)[k]),
            };
            let _ = writeln!(
                text,
                "| {} | {} | {} | {} | {} |",
                family.mesh.cells,
                worst(&|load| self.left(family, load)[0]),
                worst(&|load| self.left(family, load)[1]),
                beside(0),
                beside(1),
            );
        }
        text.push_str(
            "\nMean gap and stiffness are right on any mesh that represents the shortest wave. For the area use the \
             corrected one, or better two meshes and the extrapolation 2 κ(Δ/2) − κ(Δ). Refine by Fourier \
             interpolation (`Topography::resample`), and only if the spectrum really ends at λₛ: the area of a \
             measured surface that is rough down to its pixels depends on the pixel. If surfaces differ by more than \
             the error of the mesh, as under light loads, more surfaces help more than a finer mesh.",
        );
        text
    }

    fn spectrum(&self) -> String {
        let mut text = format!(
            "### Width of the spectrum\n\n{CELLS} cells to the shortest wave, p̄/(E\\* h′) = {}. α is Nayak's \
             parameter.\n\n| λᵣ/λₛ | α | κ, corrected |\n|---|---|---|\n",
            LOADS[MIDDLE],
        );
        for family in &self.bands {
            let kappa = family.spread(MIDDLE, State::corrected_kappa).decimals(2);
            let _ = writeln!(text, "| {} | {:.1} | {kappa} |", family.mesh.band, family.nayak);
        }
        let trend = self.trend(MIDDLE);
        let slope = Spread { mean: trend.slope, deviation: trend.error };
        let _ = write!(
            text,
            "\nV. A. Yastrebov, G. Anciaux and J.-F. Molinari (J. Mech. Phys. Solids 107 (2017) 469) find that at a \
             given p̄/(E\\* h′) the area falls with the logarithm of Nayak's parameter. Here dκ/d(ln α) = {} (standard \
             error over all surfaces). **Verdict: {}** (criterion: negative by more than two standard errors).",
            slope.decimals(3),
            if trend.falls() { "agrees" } else { "not resolved" },
        );
        text
    }

    pub(crate) fn csv(&self) -> String {
        let mut text =
            "band,cells,seed,mean_pressure_over_e_star_rms_gradient,contact_area_fraction,\
                        corrected_area_fraction,mean_gap_over_rms_height,\
                        interfacial_stiffness_rms_height_over_load\n"
                .to_string();
        for family in self.meshes.iter().chain(&self.bands) {
            for (seed, states) in family.seeds.iter().enumerate() {
                for s in states {
                    let _ = writeln!(
                        text,
                        "{},{},{},{:e},{:e},{:e},{:e},{:e}",
                        family.mesh.band,
                        family.mesh.cells,
                        seed + 1,
                        s.load,
                        s.area,
                        s.corrected,
                        s.gap,
                        s.stiffness
                    );
                }
            }
        }
        text
    }
}
