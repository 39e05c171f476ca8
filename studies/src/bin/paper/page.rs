//! The page of verdicts: everything in it comes from this study.

use std::error::Error;
use std::path::{Path, PathBuf};

use crate::report::Report;
use crate::{candidates, conclusions, criteria, findings, method, sections, statements};
use asperity_cli::outcome::Failure;
use asperity_studies::page::wrapped;

/// The study writes between these lines of the page, and leaves the rest alone.
const FIGURES: [&str; 2] =
    ["<!-- written by the study `paper`: begin -->", "<!-- written by the study `paper`: end -->"];
/// The same for the whole path.
const WHOLE_PATH: [&str; 2] = [
    "<!-- written by the study `paper`, whole path: begin -->",
    "<!-- written by the study `paper`, whole path: end -->",
];
const TITLE: &str = "# The paper, figure by figure\n";

impl Report {
    /// Writes the page alone, into the directory of the pictures.
    pub(crate) fn write(&self, name: &Path) -> Result<PathBuf, Failure> {
        let page = self.merged(TITLE.to_string(), "")?;
        std::fs::write(name, page)
            .map_err(|error| Failure::new(format!("cannot write {}", name.display()), error))?;
        Ok(name.to_path_buf())
    }

    /// Writes the criterion of each verdict.
    pub(crate) fn write_criteria(&self, name: &Path) -> Result<PathBuf, Failure> {
        let (conclusions, statements) = (conclusions::claims(self), statements::claims(self));
        let method = method::claims(self);
        let claims = conclusions.iter().chain(&statements).chain(&method);
        std::fs::write(name, criteria::criteria(claims))
            .map_err(|error| Failure::new(format!("cannot write {}", name.display()), error))?;
        Ok(name.to_path_buf())
    }

    /// Puts the page into a file that others write as well, and the pictures into images/ next to it.
    pub(crate) fn publish(&self, name: &Path) -> Result<PathBuf, Failure> {
        let present = std::fs::read_to_string(name).unwrap_or(TITLE.to_string());
        let page = self.merged(present, "images/paper_")?;
        let publish = || -> Result<(), Box<dyn Error>> {
            let images = name.parent().unwrap_or(Path::new("")).join("images");
            std::fs::create_dir_all(&images)?;
            for picture in self.pictures() {
                let file = picture.file_name().ok_or("a picture without a name")?;
                let copy = images.join(format!("paper_{}", file.to_string_lossy()));
                std::fs::copy(picture, copy)?;
            }
            std::fs::write(name, page)?;
            Ok(())
        };
        publish()
            .map_err(|error| Failure::new(format!("cannot write {}", name.display()), error))?;
        Ok(name.to_path_buf())
    }

    fn pictures(&self) -> impl Iterator<Item = &PathBuf> {
        let figures = [
            &self.figure3.picture,
            &self.figure4.picture,
            &self.figure5.picture,
            &self.figure6.picture,
            &self.figure7.picture,
            &self.figure8.picture,
        ];
        let whole_path = self.whole_path.iter().map(|path| &path.picture);
        figures.into_iter().chain(whole_path)
    }

    /// A page with the text in its places; names of pictures begin with `prefix`.
    fn merged(&self, present: String, prefix: &str) -> Result<String, Failure> {
        let page = put(&present, FIGURES, &self.text(prefix)?);
        Ok(match &self.whole_path {
            Some(path) => put(&page, WHOLE_PATH, &sections::whole_path(path, prefix)),
            None => page,
        })
    }

    /// The figures.
    fn text(&self, prefix: &str) -> Result<String, Failure> {
        let names = self.names();
        let (conclusions, statements) = (conclusions::claims(self), statements::claims(self));
        let (method, candidates) = (method::claims(self), candidates::claims(self));
        let sections = [
            self.introduction(),
            format!("## The conclusions of the paper\n\n{}", criteria::table(&names, &conclusions)),
            format!(
                "## Its other statements on the figures\n\n{}",
                criteria::table(&names, &statements)
            ),
            format!("## Its statements on the method\n\n{}", criteria::table(&["here"], &method)),
            candidates::section(self, &candidates),
            sections::figure3(self, prefix),
            sections::figure4(self, prefix),
            sections::figure5(prefix),
            sections::figure6(self, prefix),
            sections::figure7(self, prefix),
            sections::figure8(self, prefix),
            findings::rules(self),
            findings::list(self, &candidates::possible(self, &candidates))?,
        ];
        Ok(sections.map(|text| text.trim_end().to_string()).join("\n\n"))
    }

    fn introduction(&self) -> String {
        let study = &self.study;
        let path = 100.0 * study.path_nodes as f64 / (study.nodes * study.nodes) as f64;
        let (mut area, mut approach, mut stiffness) = (0.0_f64, 0.0_f64, 0.0_f64);
        let mut gap = 0.0_f64;
        for run in study.families.iter().flat_map(|family| &family.runs) {
            let seam = run.seam().unwrap_or_default();
            area = area.max(seam.area);
            approach = approach.max(seam.approach);
            stiffness = stiffness.max(seam.contact_stiffness);
            gap = gap.max(seam.mean_gap);
        }
        format!(
            "Every number and statement in the text of X. Zhang, Y. Zhang, Z. Jin, *A semi-analytical \
             approach to the elastic loading behaviour of rough surfaces*, Friction 8(5), 970–981 \
             (2020), \"the paper\", beside ours. The curves in its pictures were not digitised. This \
             command writes the numbers and pictures:\n\n\
             ```text\n\
             cargo run --release -p asperity-studies --bin paper -- --nodes {} --seeds {} \
             --report paper/figure_by_figure.md\n\
             ```\n\n\
             * **Rough surfaces**: {} × {} nodes, {} seeds each; \"a ± b\" is the mean over the seeds and \
             the sample standard deviation. There are three surfaces, because the paper does not determine its own: \
             see \"Which surface the paper had\".\n\
             * **Loads**: the exact path to {} nodes in contact ({path:.0} % of the nominal area); beyond that \
             fixed loads up to 0.1 A₀E\\*. Where the two methods meet, they differ by at most {area:.0e} of the area, \
             {approach:.0e} of the approach, {gap:.0e} of the mean gap and {stiffness:.0e} of the stiffness.\n\
             * **Dimensionless**: loads W/A₀E\\*, lengths over Sq, stiffnesses K Sq/A₀E\\*, pressures over \
             E\\*.\n\
             * **Verdicts** follow from numbers. A number *agrees* if the mean is within 2σ or 5 % of the paper's, is \
             *near* within 20 %, and *undecided* if 2σ is more than that. The program writes the criterion of every \
             other row into `criteria.md`. The criteria were written a day after the first numbers were on this page, \
             and some were made stricter since.",
            study.nodes, study.seeds, study.nodes, study.nodes, study.seeds, study.path_nodes,
        )
    }
}

/// A page with the text in the place of what is between the markers, or at its end.
fn put(present: &str, [begin, end]: [&str; 2], text: &str) -> String {
    let parts = present.split_once(begin).and_then(|(before, rest)| {
        let (_, after) = rest.split_once(end)?;
        Some((before.to_string(), after))
    });
    let (before, after) = parts.unwrap_or((format!("{}\n\n", present.trim_end()), "\n"));
    format!("{before}{begin}\n\n{}\n\n{end}{after}", wrapped(text))
}
