//! What is printed.

use std::path::Path;

use asperity::kernel::KernelOrigin;
use asperity::patches::{Connectivity, constriction};
use asperity::record::LoadingRecord;
use asperity::surface::{Axis, Topography};
use asperity::{Boundary, Error, LoadingState, Warning};
use asperity_cli::number::{area, counted, quantity};
use asperity_cli::outcome::of_program;
use asperity_cli::{say, speech};

use crate::elasticity::Bodies;
use crate::resolution::Resolution;
use crate::shell;

use super::followed::Followed;
use super::moment::Moment;

/// What the record is of.
pub(super) fn print_record(record: &LoadingRecord, connectivity: Connectivity) {
    let (nx, ny) = record.grid().shape();
    let boundary = match record.kernel().boundary {
        Boundary::Free => "free",
        Boundary::Periodic => "periodic",
        Boundary::PeriodicX => "along x periodic",
        Boundary::PeriodicY => "along y periodic",
    };
    let joined = match connectivity {
        Connectivity::Four => "a side",
        Connectivity::Eight => "a side or a corner",
    };
    say!("{} on {nx} x {ny} nodes, {boundary} boundary", counted(record.states().len(), "state"));
    say!(
        "patches: nodes in contact that share {joined}; channels pass through sides, as a leak does"
    );
    let and_across = match record.kernel().boundary {
        Boundary::Free => "",
        _ => "; both may pass a border across that repeats",
    };
    say!(
        "the contact percolates when one patch extends from end to end, and seals when no channel does any more{and_across}"
    );
    say!();
}

/// When contact percolates and when it seals, and how to see what the path has not reached.
pub(super) fn print_passages(file: &Path, record: &LoadingRecord, followed: &Followed) {
    let passages = || followed.passages.iter().chain(&followed.around);
    let width = passages().map(|passage| passage.name.len()).max().unwrap_or_default();
    for passage in passages() {
        match &passage.at {
            Some(state) => {
                say!("{:width$} from state {} on: {}", passage.name, state.step, described(state))
            }
            None => say!("{:width$} not on this path", passage.name),
        }
    }
    if !followed.around.is_empty() {
        say!("(what winds goes around the periodic grid and on without end)");
    }
    let is_missing = followed.passages.iter().any(|passage| passage.at.is_none());
    let can_go_on = record.kernel().origin != KernelOrigin::Other;
    let reached = record.states().last().map_or(0.0, |state| state.contact.contact_area_fraction);
    if is_missing && can_go_on && reached < 1.0 {
        // Random surfaces percolate and seal at some 40 to 55 % contact.
        let further = if reached < 0.5 { 0.6 } else { 1.0 };
        let file = shell::quoted(file.as_os_str());
        say!(
            "the path ends at {:.2} % contact; to see more: asperity path --resume {file} --record {file} --max-area-fraction \
             {further}, and then this command again",
            100.0 * reached
        );
    }
    say!();
}

/// What looks wrong with a record and one of its states.
pub(super) fn warnings(record: &LoadingRecord, moment: &Moment) -> Result<Vec<String>, Error> {
    let grid = record.grid();
    let mut warnings =
        Warning::of_surface(&Topography::new(grid, record.heights().matrix().clone())?);
    let on = (&grid, record.kernel().boundary);
    warnings.extend(Warning::of_contact(&moment.pressure, &moment.contact_map, on)?);
    if let Ok((_, bodies)) = Bodies::of_record(record) {
        warnings.extend(bodies.warnings(&grid));
        // With a hardness it is what was asked for.
        let yields = record.hardness_map()?.is_some();
        warnings.extend(bodies.warning_of(moment.pressure.max()).filter(|_| !yields));
    }
    Ok(warnings.iter().map(|warning| of_program(&warning.to_string())).collect())
}

/// The narrowest place of the widest channel, and what looks wrong.
pub(super) fn print_channels(
    record: &LoadingRecord,
    moment: &Moment,
    corners: bool,
) -> Result<(), Error> {
    let (grid, boundary) = (record.grid(), record.kernel().boundary);
    for (name, axis) in [("x", Axis::X), ("y", Axis::Y)] {
        let on = (&grid, boundary);
        match constriction(&moment.gap, &moment.contact_map, on, axis)? {
            Some(narrowest) => say!(
                "the widest channel along {name} is narrowest at node ({}, {}), where the gap is {}",
                narrowest.node.0,
                narrowest.node.1,
                quantity(narrowest.gap, "m", 4)
            ),
            None => say!("no channel along {name}: the contact seals"),
        }
    }
    let resolution = Resolution::of(&moment.contact_map, &grid, boundary)?;
    match corners {
        true => say!("mesh, of patches that corners do not connect: {resolution}"),
        false => say!("mesh: {resolution}"),
    }
    warnings(record, moment)?.iter().for_each(speech::warn);
    Ok(())
}

/// The patches of one state.
pub(super) fn print_moment(moment: &Moment) {
    let state = &moment.state;
    say!("at {}:", described(state));
    let Some((patch, carried)) = moment.patches.first() else {
        say!("nothing is in contact");
        return;
    };
    let percent = |part: f64, whole: f64| 100.0 * part / whole;
    let carries = match state.contact.load {
        0.0 => "carries nothing yet".to_string(),
        load => format!(
            "carries {} ({:.2} %) at a mean pressure of {}",
            quantity(carried.load, "N", 4),
            percent(carried.load, load),
            quantity(carried.mean_pressure, "Pa", 4)
        ),
    };
    say!(
        "{}; the largest has {}, {}, {:.2} % of the contact, and {carries}",
        counted(moment.patches.len(), "patch"),
        counted(patch.nodes, "node"),
        area(patch.area, 4),
        percent(patch.area, state.contact.contact_area)
    );
}

/// Load, area and mean pressure of a state.
pub(super) fn described(state: &LoadingState) -> String {
    format!(
        "W = {}, A/A0 = {:.2} %, mean pressure {}",
        quantity(state.contact.load, "N", 4),
        100.0 * state.contact.contact_area_fraction,
        quantity(state.contact.mean_pressure(), "Pa", 4)
    )
}
