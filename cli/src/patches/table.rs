//! `patches.csv`: the patches of every state.

use std::fmt::{self, Write as _};
use std::path::{Path, PathBuf};

use asperity::ContactEvent;
use asperity::patches::PatchEvent;
use asperity::record::LoadingRecord;
use asperity_cli::outcome::{self, Failure};

use super::followed::Followed;

/// One line for each state. At the limit of a path, and where a node yields, the patches are those of the last touch.
pub(super) fn write(
    record: &LoadingRecord,
    followed: &Followed,
    name: &Path,
) -> Result<PathBuf, Failure> {
    let text = lines(record, followed).map_err(|error| Failure::writing(name, error))?;
    outcome::write(name, text)
}

fn lines(record: &LoadingRecord, followed: &Followed) -> Result<String, fmt::Error> {
    let mut output = String::new();
    writeln!(
        output,
        "step,load,contact_area_fraction,patches,largest_patch,perimeter,corrected_area_fraction,event"
    )?;
    let grid = record.grid();
    let (mut touched, mut present) = (followed.patches.iter(), None);
    for state in record.states() {
        if state.event == ContactEvent::Touch {
            present = touched.next();
        }
        let Some(patches) = present else {
            continue;
        };
        let event = match (state.event, patches.event) {
            (ContactEvent::Limit | ContactEvent::Yield, _) => state.event.name(),
            (_, PatchEvent::Birth) => "birth",
            (_, PatchEvent::Growth) => "growth",
            (_, PatchEvent::Merge { .. }) => "merge",
        };
        writeln!(
            output,
            "{},{:e},{},{},{},{:e},{},{event}",
            state.step,
            state.contact.load,
            state.contact.contact_area_fraction,
            patches.patches,
            patches.largest,
            patches.perimeter.length(&grid),
            patches.corrected_area(&grid) / grid.nominal_area(),
        )?;
    }
    Ok(output)
}
