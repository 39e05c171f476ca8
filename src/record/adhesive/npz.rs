//! Records of paths with adhesion on disk.

use std::io::{Seek, Write};
use std::path::Path;

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::super::npz::{Column, OfContact, WITH_ADHESION as NAME, contact_columns, whole};
use super::{AdhesiveRecord, KernelRecord};
use crate::adhesion::{
    Adhesion, AdhesiveEvent, AdhesiveState, Change, Direction, NodeState, Trace,
};
use crate::contact::{ContactState, ContactTarget};
use crate::io::archive::{Archive, ArchiveWriter};
use crate::io::write_whole;
use crate::surface::HeightMap;
use crate::{Error, FileError, Grid};

/// Grows with every change that older readers would misunderstand.
const VERSION: u32 = 1;
const UNITS: &str = "SI: m, N, m², N/m, J; stiffness NaN where there is none; branch 0 loading, 1 unloading; event 0 near, \
                     1 pull, 2 touch, 3 part, 4 soften, 5 far, 6 jump start, 7 jump end, 8 limit; nodes 0 open, 1 soft, 2 \
                     cohesive, 3 contact, 4 held";

/// The parameters, as JSON in the member `parameters`.
#[derive(Debug, Serialize, Deserialize)]
struct Parameters {
    format: String,
    version: u32,
    /// Which program wrote it.
    program: String,
    /// Nodes along x and y.
    shape: (usize, usize),
    /// Cell along x and y [m].
    cell: (f64, f64),
    kernel: KernelRecord,
    adhesion: Adhesion,
    /// Where the last branch is to end, if it has not; records of before have ended.
    #[serde(default)]
    pending: Option<Vec<ContactTarget>>,
    /// Which way it goes; if records of before do not say, as its last state.
    #[serde(default)]
    pending_branch: Option<Direction>,
    units: String,
}

impl OfContact for AdhesiveState {
    fn contact(&self) -> &ContactState {
        &self.contact
    }

    fn contact_mut(&mut self) -> &mut ContactState {
        &mut self.contact
    }
}

/// The columns of numbers that are not whole: those of every contact, and of adhesion.
const COLUMNS: [Column<AdhesiveState>; 8] = contact_columns();
const ADHESIVE_COLUMNS: [Column<AdhesiveState>; 3] = [
    Column {
        name: "adhesive_energy",
        get: |s| s.adhesive_energy,
        set: |s, x| s.adhesive_energy = x,
    },
    Column { name: "dissipated", get: |s| s.dissipated, set: |s, x| s.dissipated = x },
    Column { name: "work", get: |s| s.work, set: |s, x| s.work = x },
];

/// A whole number of a state, and of a change.
type Whole = fn(&AdhesiveState) -> usize;
type OfChange = fn(&Change) -> usize;

const EVENTS: [AdhesiveEvent; 9] = [
    AdhesiveEvent::Near,
    AdhesiveEvent::Pull,
    AdhesiveEvent::Touch,
    AdhesiveEvent::Part,
    AdhesiveEvent::Soften,
    AdhesiveEvent::Far,
    AdhesiveEvent::JumpStart,
    AdhesiveEvent::JumpEnd,
    AdhesiveEvent::Limit,
];
const BRANCHES: [Direction; 2] = [Direction::Loading, Direction::Unloading];
const NODES: [NodeState; 5] =
    [NodeState::Open, NodeState::Soft, NodeState::Cohesive, NodeState::Contact, NodeState::Held];

/// The number that stands for a value in a file: its place among all.
fn code<T: PartialEq>(all: &[T], one: &T) -> usize {
    all.iter().position(|other| other == one).unwrap_or(all.len())
}

impl AdhesiveRecord {
    /// Writes the record as an `.npz` archive, which `numpy.load` opens: an array for each column of the states, on all
    /// branches one after the other, `heights`, the fields given, what happened to nodes, and `parameters`, a text of
    /// JSON with units and versions.
    ///
    /// The file is written under another name beside its place and then renamed: what has the name is whole. A device
    /// is written to as it is.
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] for fields of another grid, and [`FileError::Io`].
    pub fn write_npz(
        &self,
        path: impl AsRef<Path>,
        fields: &[(&str, &DMatrix<f64>)],
    ) -> Result<(), Error> {
        for (_, field) in fields {
            self.grid.check_shape(field.shape())?;
        }
        Ok(write_whole(path, |output| self.write(output, fields))?)
    }

    fn write(
        &self,
        output: impl Write + Seek,
        fields: &[(&str, &DMatrix<f64>)],
    ) -> std::io::Result<()> {
        let (states, Trace { changes, marks }) = (self.states.states(), &self.trace);
        let mut archive = ArchiveWriter::new(output);
        archive.text("parameters", &serde_json::to_string(&self.parameters())?)?;
        let whole: [(&str, Whole); 8] = [
            ("step", |state| state.step),
            ("branch", |state| code(&BRANCHES, &state.direction)),
            ("event", |state| code(&EVENTS, &state.event)),
            ("ix", |state| state.node.0),
            ("iy", |state| state.node.1),
            ("contact_nodes", |state| state.contact.contact_nodes),
            ("soft_nodes", |state| state.soft_nodes),
            ("cohesive_nodes", |state| state.cohesive_nodes),
        ];
        for (name, get) in whole {
            archive.integers(name, states.len(), states.iter().map(|s| get(s) as i64))?;
        }
        for Column { name, get, .. } in COLUMNS.iter().chain(&ADHESIVE_COLUMNS) {
            archive.numbers(name, states.len(), states.iter().map(get))?;
        }
        let of_changes: [(&str, OfChange); 3] = [
            ("changed_node", |change| change.node),
            ("changed_from", |change| code(&NODES, &change.from)),
            ("changed_to", |change| code(&NODES, &change.to)),
        ];
        for (name, get) in of_changes {
            archive.integers(name, changes.len(), changes.iter().map(|c| get(c) as i64))?;
        }
        archive.integers("changes", marks.len(), marks.iter().map(|mark| mark.0 as i64))?;
        archive.numbers("approach_in_gauge", marks.len(), marks.iter().map(|mark| mark.1))?;
        archive.matrix("heights", self.heights.matrix())?;
        for (name, field) in fields {
            archive.matrix(name, field)?;
        }
        archive.finish()
    }

    fn parameters(&self) -> Parameters {
        Parameters {
            format: NAME.to_string(),
            version: VERSION,
            program: concat!("asperity ", env!("CARGO_PKG_VERSION")).to_string(),
            shape: self.grid.shape(),
            cell: (self.grid.dx(), self.grid.dy()),
            kernel: self.kernel.clone(),
            adhesion: self.adhesion,
            pending: self.pending.as_ref().map(|(_, targets)| targets.clone()),
            pending_branch: self.pending.as_ref().map(|(direction, _)| *direction),
            units: UNITS.to_string(),
        }
    }

    /// Reads a record that [`write_npz`](Self::write_npz) has written.
    ///
    /// # Errors
    ///
    /// [`FileError::Io`]; [`FileError::BadFile`] for a file that is damaged, not such a record, or of a newer version;
    /// [`Error::WrongBoundary`], [`Error::RecordNotFinite`], [`Error::Inconsistent`] and
    /// [`AdhesionError::WrongChanges`](crate::AdhesionError::WrongChanges) for states of no path.
    pub fn read_npz(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let archive = Archive::open(path, NAME)?;
        let bad = |reason: String| {
            let path = path.to_path_buf();
            Error::File(FileError::BadFile { path, format: NAME, offset: None, reason })
        };
        let text = archive.text("parameters")?;
        let parameters: Parameters = serde_json::from_str(&text)
            .map_err(|error| bad(format!("its parameters are not understood: {error}")))?;
        if parameters.format != NAME {
            return Err(bad(format!("it holds '{}'", parameters.format)));
        }
        if parameters.version > VERSION {
            return Err(bad(format!(
                "version {} is newer than {VERSION}, which this program reads",
                parameters.version
            )));
        }
        let ((nx, ny), (dx, dy)) = (parameters.shape, parameters.cell);
        let grid = Grid::new(nx, ny, dx, dy)?;
        let wholes = |name: &str, length| {
            let values = archive.vector(name, length)?;
            match values.iter().find(|value| whole(**value) as f64 != **value) {
                Some(value) => Err(bad(format!("member '{name}': {value} is no whole number"))),
                None => Ok(values.into_iter().map(whole).collect::<Vec<_>>()),
            }
        };
        let steps = wholes("step", None)?;
        let length = Some(steps.len());
        let [branches, events, ix, iy] =
            ["branch", "event", "ix", "iy"].map(|name| wholes(name, length));
        let [contact, soft, cohesive] =
            ["contact_nodes", "soft_nodes", "cohesive_nodes"].map(|name| wholes(name, length));
        let (branches, events, ix, iy) = (branches?, events?, ix?, iy?);
        let (contact, soft, cohesive) = (contact?, soft?, cohesive?);
        let none = |name: &str, code: usize| bad(format!("member '{name}': {code} has no meaning"));
        let mut states = Vec::with_capacity(steps.len());
        for (k, &step) in steps.iter().enumerate() {
            let direction = BRANCHES.get(branches[k]).ok_or_else(|| none("branch", branches[k]))?;
            let event = EVENTS.get(events[k]).ok_or_else(|| none("event", events[k]))?;
            if step != k + 1 || ix[k] >= nx || iy[k] >= ny {
                return Err(bad(format!("state {} is no state of its grid", k + 1)));
            }
            states.push(AdhesiveState {
                step,
                direction: *direction,
                event: *event,
                node: (ix[k], iy[k]),
                // The other scalars follow, a column at a time.
                contact: ContactState::new(&grid, contact[k], 0.0, 0.0, 0.0),
                soft_nodes: soft[k],
                cohesive_nodes: cohesive[k],
                adhesive_energy: 0.0,
                dissipated: 0.0,
                work: 0.0,
            });
        }
        for Column { name, set, .. } in COLUMNS.iter().chain(&ADHESIVE_COLUMNS) {
            let values = archive.vector(name, length)?;
            states.iter_mut().zip(values).for_each(|(state, value)| set(state, value));
        }
        let nodes = wholes("changed_node", None)?;
        let [from, to] = ["changed_from", "changed_to"].map(|name| wholes(name, Some(nodes.len())));
        let (from, to) = (from?, to?);
        let mut changes = Vec::with_capacity(nodes.len());
        for (k, &node) in nodes.iter().enumerate() {
            let state = |code: usize| NODES.get(code).ok_or_else(|| none("changed", code)).copied();
            changes.push(Change { node, from: state(from[k])?, to: state(to[k])? });
        }
        let approaches = archive.vector("approach_in_gauge", length)?;
        let marks = wholes("changes", length)?.into_iter().zip(approaches).collect();
        let last = states.last().map_or(Direction::Loading, |state| state.direction);
        let direction = parameters.pending_branch.unwrap_or(last);
        Self {
            grid,
            heights: HeightMap::new(archive.matrix("heights")?)?,
            kernel: parameters.kernel,
            adhesion: parameters.adhesion,
            pending: parameters.pending.map(|targets| (direction, targets)),
            states: states.into_iter().collect(),
            trace: Trace { changes, marks },
        }
        .checked()
    }
}
