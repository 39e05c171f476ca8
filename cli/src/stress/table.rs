//! `stress.csv`: the greatest stresses at each depth.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use asperity::stress::Measure;
use asperity_cli::outcome::{self, Failure};

use super::body::{Body, Moment};

/// One line for each depth of each body.
pub(super) fn write(moment: &Moment, bodies: &[Body], name: &Path) -> Result<PathBuf, Failure> {
    let mut output = "body,load,depth".to_string();
    // Writing to a text cannot fail.
    for measure in Measure::ALL {
        let _ = write!(output, ",{0},{0}_ix,{0}_iy", measure.name());
    }
    output.push('\n');
    for (body, place) in bodies.iter().zip(1..) {
        for depth in &body.survey.depths {
            let _ = write!(output, "{place},{:e},{:e}", moment.state.contact.load, depth.depth);
            for measure in Measure::ALL {
                let found = depth.greatest(measure);
                let _ = write!(output, ",{:e},{},{}", found.value, found.node.0, found.node.1);
            }
            output.push('\n');
        }
    }
    outcome::write(name, output)
}
