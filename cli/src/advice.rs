//! Options of the command line that do what the library advises.

use asperity::{ContactGrowth, Warning};
use asperity_cli::outcome::of_program;

/// The same of a contact on a body. Where nodes may leave the contact, none can have a hardness.
pub(crate) fn told_on(growth: ContactGrowth, warning: &Warning) -> String {
    match (growth, warning) {
        (ContactGrowth::Unknown, Warning::HighPressure { .. }) => of_program(&warning.to_string()),
        _ => told(warning),
    }
}

/// What looks wrong, with the option that changes it if there is one.
pub(crate) fn told(warning: &Warning) -> String {
    let told = match warning {
        Warning::HighPressure { hardness: Some(_), .. } => {
            format!("{warning} (`--yield`, or `--hardness` for another)")
        }
        Warning::HighPressure { hardness: None, .. } => format!("{warning} (`--hardness`)"),
        Warning::NoLoad { .. } => {
            format!("{warning} (`--max-load`; where all nodes touch at once, `asperity load`)")
        }
        Warning::PressureDrop { .. } => format!("{warning} (`--pressure-drop`, `--load`)"),
        Warning::EdgePeak { .. } => format!("{warning} (`--periodic`)"),
        _ => warning.to_string(),
    };
    of_program(&told)
}
