//! Tables, text and picture.

use std::fmt::Write;

use asperity::Error;
use asperity::reference::AreaLoadLaw;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{BLACK, BLUE, Chart, Corner, GREEN, GREY, ORANGE, PURPLE, Series, Style};
use plotters::style::RGBColor;

use crate::contact::{Contact, GRADIENT, HURST};

/// What Richardson's limits of counted and corrected area may differ by, and what the finest mesh may leave of the mean
/// gap, relative, for the mesh to be called resolved.
const RESOLVED: f64 = 0.01;

/// All contacts.
pub(crate) struct Report {
    /// The same surface on finer and finer meshes, each under all loads.
    pub(crate) meshes: Vec<Vec<Contact>>,
    /// Wider and wider spectra under the reference load, up to that of the challenge.
    pub(crate) bands: Vec<Contact>,
    /// The spectrum of the challenge under several loads.
    pub(crate) loads: Vec<Contact>,
}

fn colour(place: usize) -> RGBColor {
    [BLUE, ORANGE, GREEN, PURPLE][place % 4]
}

impl Report {
    /// (first order of counted cells, of corrected area, second order of the mean gap) extrapolated from the finest two
    /// meshes, under one load: A/A₀, A/A₀ and ḡ in m.
    fn limits(&self, load: usize) -> [f64; 3] {
        let [.., fine, finest] = self.meshes.as_slice() else {
            return [f64::NAN; 3];
        };
        let (a, b) = (&fine[load], &finest[load]);
        [2.0 * b.area - a.area, 2.0 * b.corrected - a.corrected, (4.0 * b.gap - a.gap) / 3.0]
    }

    /// The corrected area on the coarsest mesh, over its limit, under one load.
    fn left_by_coarsest(&self, load: f64) -> f64 {
        let coarsest = self.meshes.first();
        let place = coarsest.and_then(|mesh| mesh.iter().position(|c| c.load == load));
        coarsest
            .zip(place)
            .map_or(f64::NAN, |(mesh, place)| mesh[place].corrected / self.limits(place)[1])
    }

    pub(crate) fn text(&self) -> String {
        [self.introduction(), self.resolution(), self.spectra() + &self.coarser()].join("\n\n")
    }

    fn introduction(&self) -> String {
        format!(
            "## The contact-mechanics challenge\n\n\
             Study `challenge`. The geometry of M. H. Müser et al., *Meeting the contact-mechanics challenge*, Tribol. \
             Lett. 65 (2017) 118 (problem: arXiv 1512.02403): L = 100 µm, H = {HURST}, λᵣ = 20 µm, λₛ = 0.1 µm, rms \
             gradient {GRADIENT}, E\\* = 25 MPa, reference load 250 kPa, which is 0.01 E\\*h′; periodic, kernel \
             2/(E\\*|q|). It is solved here **without adhesion** and with our own phases: the numbers of that paper \
             cannot be compared.\n\n\
             ![Area over load against the width of the spectrum, distributions of gap and of pressure, and the mean \
             gap against load](images/challenge.png)"
        )
    }

    fn resolution(&self) -> String {
        let band = self.meshes.first().and_then(|m| m.first()).map_or(0, |c| c.band);
        let mut text = format!(
            "### The error of the resolution\n\nThe same surface, its spectrum cut at L/{band}, on the coarsest and \
             the finest of three meshes under the reference load. *Limit*: Richardson's extrapolation from the finest \
             two, of first order for the area as counted and of second for the mean gap.\n\n\
             | nodes | cells to λₛ | A/A₀ | corrected | ḡ/h_rms |\n|---|---|---|---|---|\n"
        );
        let count = self.meshes.first().map_or(0, Vec::len);
        let (mut area, mut gap) = (0.0_f64, 0.0_f64);
        let reference = self.bands.last().map(|c| c.load);
        for load in 0..count {
            let [counted, corrected, gap_limit] = self.limits(load);
            area = area.max((corrected / counted - 1.0).abs());
            let is_shown = |mesh: &&Vec<Contact>| Some(mesh[load].load) == reference;
            for mesh in self.meshes.first().into_iter().chain(self.meshes.last()).filter(is_shown) {
                row(&mut text, &mesh[load]);
            }
            if let Some(finest) = self.meshes.last() {
                gap = gap.max((finest[load].gap / gap_limit - 1.0).abs());
                if is_shown(&finest) {
                    let h_rms = finest[load].spectrum.rms_height();
                    let _ = writeln!(
                        text,
                        "| limit | | {counted:.5} | {corrected:.5} | {:.4} |",
                        gap_limit / h_rms
                    );
                }
            }
        }
        let resolved = area <= RESOLVED && gap <= RESOLVED;
        let _ = write!(
            text,
            "\n**Verdict: {}** (criterion: the limits of counted and corrected area, two estimates of the same number, \
             within {r:.0} % of each other, and the mean gap on the finest mesh within {r:.0} % of its limit, at every \
             load). Found: {:.2} % and {:.3} %.",
            if resolved { "resolved" } else { "not resolved" },
            100.0 * area,
            100.0 * gap,
            r = 100.0 * RESOLVED,
        );
        text
    }

    fn spectra(&self) -> String {
        let mut text = "### Approaching the spectrum of the challenge\n\nThe reference load, p̄ = 0.01 E\\*, with four \
                        cells to λₛ (4.1 at the end), the rms gradient always 1:\n\n\
                        | L/λₛ | nodes | Nayak's α | A/A₀ | κ, corrected | ḡ [µm] |\n\
                        |---|---|---|---|---|---|\n"
            .to_string();
        for c in &self.bands {
            let _ = writeln!(
                text,
                "| {} | {}² | {:.1} | {:.5} | {:.3} | {:.4} |",
                c.band,
                c.nodes,
                c.spectrum.nayak_parameter(),
                c.area,
                c.corrected_kappa(),
                1e6 * c.gap,
            );
        }
        if let Some(last) = self.bands.last() {
            let persson = AreaLoadLaw::PERSSON;
            let left = self.left_by_coarsest(last.load);
            let _ = write!(
                text,
                "\nThe wider the spectrum, the less κ, between √(2π) = {:.3} and Persson's √(8/π) = {persson:.3}. With \
                 four cells to λₛ the corrected area of the table before is {:.1} % below its limit at this load; with \
                 as much here, this geometry has, without adhesion, A/A₀ = {:.2} % at p̄ = {} E\\* and a mean gap of \
                 {:.3} µm.",
                AreaLoadLaw::BUSH_GIBSON_THOMAS,
                100.0 * (1.0 - left),
                100.0 * last.corrected / left,
                last.load,
                1e6 * last.gap,
            );
        }
        text
    }

    /// What a mesh of half as many nodes changes.
    fn coarser(&self) -> String {
        let finest = self.bands.last();
        let same = finest.and_then(|fine| {
            let coarse = self.loads.iter().find(|c| c.load == fine.load)?;
            Some((fine, coarse))
        });
        same.map_or_else(String::new, |(fine, coarse)| {
            format!(
                " With {} × {n} nodes, {:.1} cells to λₛ, the counted area differs by {:.1} %, the corrected one by \
                 {:.1} % and the mean gap by {:.2} %.",
                coarse.nodes,
                coarse.cells(),
                100.0 * (coarse.area / fine.area - 1.0).abs(),
                100.0 * (coarse.corrected / fine.corrected - 1.0).abs(),
                100.0 * (coarse.gap / fine.gap - 1.0).abs(),
                n = coarse.nodes,
            )
        })
    }

    fn all(&self) -> impl Iterator<Item = &Contact> {
        self.meshes.iter().flatten().chain(&self.bands).chain(&self.loads)
    }

    pub(crate) fn csv(&self) -> String {
        let mut text = "nodes,side_over_short_cutoff,mean_pressure_over_e_star,contact_area_fraction,\
                        corrected_area_fraction,mean_gap,rms_height,interfacial_stiffness_rms_height_over_load,\
                        greatest_over_mean_pressure\n"
            .to_string();
        for c in self.all() {
            let _ = writeln!(
                text,
                "{},{},{:e},{:e},{:e},{:e},{:e},{:e},{:e}",
                c.nodes,
                c.band,
                c.load,
                c.area,
                c.corrected,
                c.gap,
                c.spectrum.rms_height(),
                c.stiffness,
                c.peak
            );
        }
        text
    }

    pub(crate) fn charts(&self, reference: f64) -> Result<Vec<Chart>, Error> {
        Ok(vec![self.kappa(), self.gaps(reference), self.pressures(reference)?, self.mean_gap()])
    }

    fn kappa(&self) -> Chart {
        let points = |value: fn(&Contact) -> f64| {
            let each = self.bands.iter().map(move |c| (c.band as f64, value(c)));
            each.collect::<Vec<_>>()
        };
        let flat = |name: &str, colour, value: f64| {
            Series::new(name, colour, Style::Dashed, [(90.0, value), (1400.0, value)])
        };
        Chart {
            title: "Area over load at 0.01 E*, 4 cells to λₛ".to_string(),
            x: Axis::plain_logarithmic("L/λₛ", 90.0, 1400.0),
            y: Axis::plain("κ = A E* h′ / load", 1.4, 3.4),
            series: vec![
                flat("√(2π)", GREY, AreaLoadLaw::BUSH_GIBSON_THOMAS),
                flat("√(8/π)", BLACK, AreaLoadLaw::PERSSON),
                Series::new("cells counted", ORANGE, Style::Line, points(Contact::kappa)),
                Series::new("", ORANGE, Style::Dots, points(Contact::kappa)),
                Series::new("corrected", BLUE, Style::Line, points(Contact::corrected_kappa)),
                Series::new("", BLUE, Style::Dots, points(Contact::corrected_kappa)),
            ],
            legend: Corner::TopRight,
        }
    }

    /// The meshes under the reference load, and the finest contact with the spectrum of the challenge.
    fn at(&self, reference: f64) -> Vec<(String, &Contact)> {
        let of = self.meshes.iter().flatten().filter(|c| c.load == reference);
        let all = of.chain(self.bands.last());
        all.map(|c| (format!("L/λₛ = {}, {}²", c.band, c.nodes), c)).collect()
    }

    fn gaps(&self, reference: f64) -> Chart {
        let series = self.at(reference).into_iter().enumerate();
        Chart {
            title: format!("Distribution of the gap at {reference} E*"),
            x: Axis::plain_logarithmic("gap g [m]", 1e-11, 1e-5),
            y: Axis::plain_logarithmic("g × density over A₀", 1e-5, 3.0),
            series: series
                .map(|(k, (name, c))| Series::new(name, colour(k), Style::Line, c.gaps.clone()))
                .collect(),
            legend: Corner::BottomRight,
        }
    }

    fn pressures(&self, reference: f64) -> Result<Chart, Error> {
        let at = self.at(reference);
        let most = at.iter().flat_map(|(_, c)| c.pressures.last());
        let most = most.fold(0.0_f64, |most, (p, _)| most.max(*p));
        let law = AreaLoadLaw::new(GRADIENT, 1.0)?;
        let persson = (0..=200).map(|k| {
            let p = most * f64::from(k) / 200.0;
            (p, law.persson_density(p, reference))
        });
        let mut series = vec![Series::new("Persson", BLACK, Style::Dashed, persson)];
        for (k, (name, c)) in at.into_iter().enumerate() {
            series.push(Series::new(name, colour(k), Style::Line, c.pressures.clone()));
        }
        Ok(Chart {
            title: format!("Distribution of the pressure at {reference} E*"),
            x: Axis::plain("pressure / E*", 0.0, most),
            y: Axis::plain_logarithmic("E* × density over A₀", 1e-6, 1.0),
            series,
            legend: Corner::BottomLeft,
        })
    }

    fn mean_gap(&self) -> Chart {
        let points = |contacts: &mut dyn Iterator<Item = &Contact>| {
            contacts.map(|c| (c.load, c.gap / c.spectrum.rms_height())).collect::<Vec<_>>()
        };
        let mut series = Vec::new();
        for (k, mesh) in self.meshes.iter().chain([&self.loads]).enumerate() {
            let name =
                mesh.first().map_or(String::new(), |c| format!("L/λₛ = {}, {}²", c.band, c.nodes));
            let points = points(&mut mesh.iter());
            series.push(Series::new(name, colour(k), Style::Line, points.clone()));
            series.push(Series::new("", colour(k), Style::Dots, points));
        }
        Chart {
            title: "Mean gap".to_string(),
            x: Axis::plain_logarithmic("mean pressure / E*", 1e-3, 0.2),
            y: Axis::plain("ḡ / h_rms", 0.0, 2.6),
            series,
            legend: Corner::TopRight,
        }
    }
}

fn row(text: &mut String, c: &Contact) {
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "| {}² | {:.1} | {:.5} | {:.5} | {:.4} |",
        c.nodes,
        c.cells(),
        c.area,
        c.corrected,
        c.gap / c.spectrum.rms_height(),
    );
}
