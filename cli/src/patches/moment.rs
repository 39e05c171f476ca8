//! One state of a path, with its fields.

use asperity::LoadingState;
use asperity::contact::ContactFields;
use asperity::patches::{Connectivity, Patch, PatchLoad, Patches};
use asperity::record::LoadingRecord;
use asperity_cli::number::{counted, quantity};
use asperity_cli::outcome::Failure;
use nalgebra::DMatrix;

use super::Options;

/// The state that a command line asks for.
pub(super) fn state(record: &LoadingRecord, options: &Options) -> Result<LoadingState, Failure> {
    let history = record.history();
    let Some(last) = record.states().last() else {
        return Err(Failure::request("the record holds no state"));
    };
    let missed = |what: String| {
        Failure::request(format!(
            "the path has no state at {what}: it ends at {}, with {} of {} in contact",
            quantity(last.contact.load, "N", 6),
            last.contact.contact_nodes,
            counted(record.grid().nodes(), "node")
        ))
    };
    if let Some(load) = options.at_load {
        return history.at_load(load).ok_or_else(|| missed(quantity(load, "N", 6)));
    }
    if let Some(fraction) = options.at_area_fraction {
        let found = history.at_area_fraction(fraction);
        return found.ok_or_else(|| missed(format!("an area fraction of {fraction}")));
    }
    Ok(*last)
}

/// A state with its fields and its patches.
pub(super) struct Moment {
    pub(super) state: LoadingState,
    pub(super) contact_map: DMatrix<bool>,
    pub(super) pressure: DMatrix<f64>,
    pub(super) gap: DMatrix<f64>,
    /// Each patch with what it carries, the largest first.
    pub(super) patches: Vec<(Patch, PatchLoad)>,
}

impl Moment {
    pub(super) fn new(
        record: &LoadingRecord,
        state: LoadingState,
        connectivity: Connectivity,
    ) -> Result<Self, Failure> {
        let failed = |error| Failure::new("cannot compute the fields of the state", error);
        let mut path = record.replay().map_err(failed)?;
        let fields = path.fields_at(&state).map_err(failed)?;
        let ContactFields { contact_map, pressure, gap, .. } = fields;
        let (grid, boundary) = (record.grid(), record.kernel().boundary);
        let found = Patches::new(&contact_map, &grid, boundary, connectivity).map_err(failed)?;
        let loads = found.loads(&pressure).map_err(failed)?;
        let mut patches: Vec<_> = found.patches().iter().copied().zip(loads).collect();
        patches.sort_by_key(|(patch, _)| std::cmp::Reverse(patch.nodes));
        Ok(Self { state, contact_map, pressure, gap, patches })
    }
}
