//! All that was found.

use crate::boundary::Boundary;
use crate::effort::Effort;
use crate::figure3::Figure3;
use crate::figure4::Figure4;
use crate::figure5::Figure5;
use crate::figure6::Figure6;
use crate::figure7::Figure7;
use crate::figure8::Figure8;
use crate::iterations::Iterations;
use crate::rules::Rules;
use crate::study::Study;
use crate::whole_path::WholePath;

/// All that was found.
pub(crate) struct Report {
    pub(crate) study: Study,
    pub(crate) figure3: Figure3,
    pub(crate) figure4: Figure4,
    pub(crate) figure5: Figure5,
    pub(crate) figure6: Figure6,
    pub(crate) figure7: Figure7,
    pub(crate) figure8: Figure8,
    pub(crate) rules: Rules,
    pub(crate) boundary: Vec<Boundary>,
    pub(crate) iterations: Iterations,
    pub(crate) effort: Effort,
    /// If its file was given.
    pub(crate) whole_path: Option<WholePath>,
}

impl Report {
    /// Names of the surfaces.
    pub(crate) fn names(&self) -> Vec<&'static str> {
        let families = self.study.families.iter();
        families.map(|family| family.rough.name()).collect()
    }
}
