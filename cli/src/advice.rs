//! Options of the command line that do what the library advises.

use asperity::{Warning, surface};

/// What looks wrong, with the option that changes it if there is one.
pub(crate) fn told(warning: &Warning) -> String {
    match warning {
        Warning::Surface(surface::Warning::Tilted { .. }) => format!("{warning} (`--level plane`)"),
        Warning::HighPressure { .. } => {
            format!("{warning} (`--hardness`, or `--yield` for a typical one)")
        }
        _ => warning.to_string(),
    }
}
