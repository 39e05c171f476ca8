//! `leak.csv`: the leak along the path.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use asperity::leak::LeakCurve;
use asperity_cli::outcome::{self, Failure};

/// One line for each point; columns of a constriction are empty where there is none.
pub(super) fn write(curve: &LeakCurve, name: &Path) -> Result<PathBuf, Failure> {
    let mut output = "step,load,mean_pressure,contact_area_fraction,mean_gap,leak_rate,mean_field_leak_rate,permeability,\
                      transverse_permeability,constriction_ix,constriction_iy,constriction_gap,constriction_pressure_drop,\
                      constriction_dissipation,imbalance\n"
        .to_string();
    for point in &curve.points {
        let contact = &point.state.contact;
        let transverse =
            point.transverse_permeability.map_or_else(String::new, |k| format!("{k:e}"));
        let constriction = point.constriction.map_or_else(
            || ",,,,".to_string(),
            |narrowest| {
                format!(
                    "{},{},{:e},{:e},{:e}",
                    narrowest.node.0,
                    narrowest.node.1,
                    narrowest.gap,
                    narrowest.pressure_drop,
                    narrowest.dissipation
                )
            },
        );
        // Writing to a text cannot fail.
        let _ = writeln!(
            output,
            "{},{:e},{:e},{:e},{:e},{:e},{:e},{:e},{transverse},{constriction},{:e}",
            point.state.step,
            contact.load,
            contact.mean_pressure(),
            contact.contact_area_fraction,
            contact.mean_gap,
            point.leak_rate,
            point.mean_field_leak_rate,
            point.permeability,
            point.imbalance,
        );
    }
    outcome::write(name, output)
}
