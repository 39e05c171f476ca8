//! The tables.

use std::fmt::{self, Write as _};
use std::path::{Path, PathBuf};

use asperity::slip::SlipState;
use asperity_cli::outcome::{self, Failure};

use super::history::Sheared;
use super::joint::Joint;

/// `slip.csv`: the first loading up to sliding.
pub(super) fn loading(joint: &Joint, name: &Path) -> Result<PathBuf, Failure> {
    let header = "tangential_load,displacement,interfacial_displacement,stick_area,slip_area,\
                  stick_nodes,slipping_nodes,tangential_stiffness";
    write(name, header, joint.loading.iter().map(line))
}

fn line(state: &SlipState) -> String {
    format!(
        "{:e},{:e},{:e},{:e},{:e},{},{},{:e}",
        state.tangential_load,
        state.displacement,
        state.interfacial_displacement,
        state.stick_area,
        state.slip_area,
        state.stick_nodes,
        state.slipping_nodes,
        state.tangential_stiffness,
    )
}

/// `cycles.csv`: one line for each amplitude at which something slips.
pub(super) fn cycles(joint: &Joint, name: &Path) -> Result<PathBuf, Failure> {
    let header = "amplitude,displacement,interfacial_displacement,dissipation,secant_stiffness,\
                  loss_factor,slipping_nodes";
    let lines = joint.cycles.iter().map(|cycle| {
        format!(
            "{:e},{:e},{:e},{:e},{:e},{:e},{}",
            cycle.amplitude,
            cycle.displacement,
            cycle.interfacial_displacement,
            cycle.dissipation,
            cycle.secant_stiffness,
            cycle.loss_factor,
            cycle.slipping_nodes,
        )
    });
    write(name, header, lines)
}

/// `iwan.csv`: one line for each element, the one that slips first at the top.
pub(super) fn elements(joint: &Joint, name: &Path) -> Result<PathBuf, Failure> {
    let elements: Vec<_> = joint.slip.jenkins_elements().collect();
    let lines = elements
        .iter()
        .rev()
        .map(|element| format!("{:e},{:e}", element.slip_displacement, element.stiffness));
    write(name, "slip_displacement,stiffness", lines)
}

/// `history.csv`: one line for each row of the history.
pub(super) fn history(sheared: &Sheared, name: &Path) -> Result<PathBuf, Failure> {
    let header = "load,tangential_load,displacement,interfacial_displacement,stick_area,slip_area,\
                  stick_nodes,slipping_nodes,tangential_stiffness,dissipation";
    let lines = sheared
        .rows
        .iter()
        .map(|(state, lost)| format!("{:e},{},{lost:e}", state.load, line(state)));
    write(name, header, lines)
}

fn write(
    name: &Path,
    header: &str,
    lines: impl Iterator<Item = String>,
) -> Result<PathBuf, Failure> {
    let made = || -> Result<String, fmt::Error> {
        let mut text = String::new();
        writeln!(text, "{header}")?;
        for line in lines {
            writeln!(text, "{line}")?;
        }
        Ok(text)
    };
    outcome::write(name, made().map_err(|error| Failure::writing(name, error))?)
}
