//! What is printed.

use asperity::patches::Connectivity;
use asperity::record::LoadingRecord;
use asperity::{Boundary, LoadingState};
use asperity_cli::number::quantity;
use asperity_cli::say;

use super::followed::Followed;
use super::moment::Moment;

/// What the record is of.
pub(super) fn print_record(record: &LoadingRecord, connectivity: Connectivity) {
    let (nx, ny) = record.grid().shape();
    let (boundary, all_the_way) = match record.kernel().boundary {
        Boundary::Free => ("free", "from end to end"),
        Boundary::Periodic => ("periodic", "around the periodic grid"),
    };
    let (joined, channels) = match connectivity {
        Connectivity::Four => ("a side", "sides and corners"),
        Connectivity::Eight => ("a side or a corner", "sides"),
    };
    say!(
        "{} states on {nx} x {ny} nodes, {boundary} boundary",
        record.states().len()
    );
    say!("patches: nodes in contact with {joined} in common; channels lead across {channels}");
    say!("\"along x\" and \"along y\" are {all_the_way}");
    say!();
}

/// When contact percolates, and when leakage ends.
pub(super) fn print_passages(followed: &Followed) {
    for passage in &followed.passages {
        match &passage.state {
            Some(state) => say!(
                "{:18} from state {} on: {}",
                passage.name,
                state.step,
                described(state)
            ),
            None => say!("{:18} not on this path", passage.name),
        }
    }
    say!();
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
    let count = match moment.patches.len() {
        1 => "1 patch".to_string(),
        count => format!("{count} patches"),
    };
    say!(
        "{count}; the largest has {} nodes, {:.4e} m², {:.2} % of the contact, and carries {} ({:.2} %) at a mean of {}",
        patch.nodes,
        patch.area,
        percent(patch.area, state.contact_area),
        quantity(carried.load, "N", 4),
        percent(carried.load, state.load),
        quantity(carried.mean_pressure, "Pa", 4)
    );
}

/// Load, area and mean pressure of a state.
pub(super) fn described(state: &LoadingState) -> String {
    format!(
        "W = {}, A/A0 = {:.2} %, mean pressure {}",
        quantity(state.load, "N", 4),
        100.0 * state.contact_area_fraction,
        quantity(state.mean_pressure(), "Pa", 4)
    )
}
