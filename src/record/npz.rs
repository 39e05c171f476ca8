//! Records on disk: archives of arrays that `numpy.load` opens.

mod window_end;

use std::io::{Seek, Write};
use std::path::Path;

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::{KernelRecord, LoadingRecord, Settings};
use crate::contact::{ContactState, PlasticState};
use crate::error::AdhesionError;
use crate::io::archive::{Archive, ArchiveWriter};
use crate::io::write_whole;
use crate::loading::{ContactEvent, History, LoadingEnd, LoadingState};
use crate::patches::{Connectivity, PatchHistory, PatchState, activation_map};
use crate::surface::HeightMap;
use crate::{Error, FileError, Grid};

/// Name of the format in errors, and in the file itself.
const NAME: &str = "asperity record";
/// That of records with adhesion, which are read elsewhere.
pub(super) const WITH_ADHESION: &str = "asperity record with adhesion";
/// Grows with every change that older readers would misunderstand.
const VERSION: u32 = 2;
/// Version of records without a hardness, which older readers understand.
const ELASTIC_VERSION: u32 = 1;

/// The parameters of a record, as JSON in the member `parameters`.
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
    settings: Settings,
    end: Option<LoadingEnd>,
    /// Young's modulus [Pa] and Poisson's ratio of each elastic body, if they are known.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    bodies: Vec<(f64, f64)>,
    /// What the next window begins with, if that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    window: Option<window_end::Numbers>,
    units: String,
}

/// The name of the format alone, which tells one kind of record from another.
#[derive(Debug, Deserialize)]
struct Named {
    format: String,
}

/// A whole number of a state.
type Whole = fn(&LoadingState) -> usize;

/// A scalar of a state, as a column of the archive.
#[derive(Clone, Copy)]
pub(super) struct Column<S> {
    pub(super) name: &'static str,
    pub(super) get: fn(&S) -> f64,
    pub(super) set: fn(&mut S, f64),
}

/// A state with the scalars of a contact.
pub(super) trait OfContact {
    fn contact(&self) -> &ContactState;
    fn contact_mut(&mut self) -> &mut ContactState;
}

impl OfContact for LoadingState {
    fn contact(&self) -> &ContactState {
        &self.contact
    }

    fn contact_mut(&mut self) -> &mut ContactState {
        &mut self.contact
    }
}

/// A column of a field of the contact.
macro_rules! of_contact {
    ($name:ident) => {
        Column {
            name: stringify!($name),
            get: |state| state.contact().$name,
            set: |state, value| state.contact_mut().$name = value,
        }
    };
    // NaN stands for a stiffness that there is not.
    ($name:ident or NaN) => {
        Column {
            name: stringify!($name),
            get: |state| state.contact().$name.unwrap_or(f64::NAN),
            set: |state, value| state.contact_mut().$name = (!value.is_nan()).then_some(value),
        }
    };
}

/// The columns of numbers that are not whole, of the contact of any state.
pub(super) const fn contact_columns<S: OfContact>() -> [Column<S>; 8] {
    [
        of_contact!(approach),
        of_contact!(load),
        of_contact!(contact_area),
        of_contact!(contact_area_fraction),
        of_contact!(mean_gap),
        of_contact!(contact_stiffness or NaN),
        of_contact!(interfacial_stiffness or NaN),
        of_contact!(energy),
    ]
}

/// Those of a path without adhesion.
const COLUMNS: [Column<LoadingState>; 9] = {
    let [a, b, c, d, e, f, g, h] = contact_columns();
    let error = Column {
        name: "approach_error",
        get: |state: &LoadingState| state.approach_error,
        set: |state: &mut LoadingState, value| state.approach_error = value,
    };
    [a, b, c, d, e, f, g, h, error]
};

/// The columns of what has yielded, on a path with a hardness.
const PLASTIC_COLUMNS: [Column<PlasticState>; 4] = [
    Column { name: "plastic_volume", get: |s| s.volume, set: |s, x| s.volume = x },
    Column { name: "plastic_work", get: |s| s.work, set: |s, x| s.work = x },
    Column {
        name: "plastic_volume_per_load",
        get: |s| s.volume_per_load,
        set: |s, x| s.volume_per_load = x,
    },
    Column {
        name: "plastic_work_per_load",
        get: |s| s.work_per_load,
        set: |s, x| s.work_per_load = x,
    },
];

impl LoadingRecord {
    /// Writes the record as an `.npz` archive, which `numpy.load` opens: an array for each column of the states,
    /// `patches`, `largest_patch` and `perimeter` beside them, `heights`, `activation` (the load at which each node
    /// touched, NaN where none has), the fields given, and `parameters`, a text of JSON with units and versions.
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
        self.check_fields(fields)?;
        Ok(write_whole(path, |output| self.write(output, fields))?)
    }

    /// The same into anything that takes bytes: memory, where there is no disk.
    ///
    /// # Errors
    ///
    /// As [`LoadingRecord::write_npz`]; an error of the output is called that of `name`.
    ///
    /// ```
    /// use std::io::Cursor;
    ///
    /// use asperity::record::LoadingRecord;
    /// use asperity::{Boussinesq, Grid, LoadingSolver, SelfAffine};
    ///
    /// # fn main() -> Result<(), asperity::Error> {
    /// let half_space = Boussinesq::new(Grid::square(32, 1.25e-3)?, 115e9)?;
    /// let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space).max_load(500.0).build()?;
    /// let history = path.run()?;
    /// let mut bytes = Cursor::new(Vec::new());
    /// LoadingRecord::new(&path, history)?.write_npz_to(&mut bytes, "path.npz", &[])?;
    /// assert!(bytes.into_inner().starts_with(b"PK"));
    /// # Ok(())
    /// # }
    /// ```
    pub fn write_npz_to(
        &self,
        output: impl Write + Seek,
        name: impl AsRef<Path>,
        fields: &[(&str, &DMatrix<f64>)],
    ) -> Result<(), Error> {
        self.check_fields(fields)?;
        let named = |source| FileError::Io { path: name.as_ref().to_path_buf(), source };
        self.write(output, fields).map_err(|error| named(error).into())
    }

    fn check_fields(&self, fields: &[(&str, &DMatrix<f64>)]) -> Result<(), Error> {
        fields.iter().try_for_each(|(_, field)| Ok(self.grid.check_shape(field.shape())?))
    }

    fn write(
        &self,
        output: impl Write + Seek,
        fields: &[(&str, &DMatrix<f64>)],
    ) -> std::io::Result<()> {
        let states = self.states();
        let parameters = serde_json::to_string(&self.parameters())?;
        let mut archive = ArchiveWriter::new(output);
        archive.text("parameters", &parameters)?;
        let whole: [(&str, Whole); 4] = [
            ("step", |state| state.step),
            ("ix", |state| state.node.0),
            ("iy", |state| state.node.1),
            ("contact_nodes", |state| state.contact.contact_nodes),
        ];
        for (name, get) in whole {
            archive.integers(name, states.len(), states.iter().map(|s| get(s) as i64))?;
        }
        let events = states.iter().map(|state| i64::from(state.event.code()));
        archive.integers("event", states.len(), events)?;
        for Column { name, get, .. } in COLUMNS {
            archive.numbers(name, states.len(), states.iter().map(get))?;
        }
        if self.settings.hardness.is_some() {
            let plastic = || states.iter().map(|state| state.contact.plastic.unwrap_or_default());
            let nodes = plastic().map(|plastic| plastic.yielded_nodes as i64);
            archive.integers("yielded_nodes", states.len(), nodes)?;
            for Column { name, get, .. } in PLASTIC_COLUMNS {
                archive.numbers(name, states.len(), plastic().map(|plastic| get(&plastic)))?;
            }
        }
        self.write_patches(&mut archive)?;
        archive.matrix("heights", self.heights.matrix())?;
        if let Ok(load) = activation_map(&self.grid, self.states(), |state| state.contact.load) {
            archive.matrix("activation", &load)?;
        }
        if let Some(end) = self.history.window_end() {
            window_end::write(end, &self.grid, &mut archive)?;
        }
        for (name, field) in fields {
            archive.matrix(name, field)?;
        }
        archive.finish()
    }

    /// Number of patches, nodes of the largest one and length of all edges \[m\] at each state, 4-connected; nothing
    /// where nodes leave the contact.
    fn write_patches(&self, archive: &mut ArchiveWriter<impl Write + Seek>) -> std::io::Result<()> {
        let Ok(contact) = self.history.contact_sequence(self.grid) else {
            return Ok(());
        };
        let patches = PatchHistory::new(&contact, self.kernel.boundary, Connectivity::Four);
        // At a limit, and where a node yields, they are those of the last touch.
        let mut touched = patches;
        let mut present = None;
        let patches = self.states().iter().filter_map(|state| {
            if state.event == ContactEvent::Touch {
                present = touched.next();
            }
            present
        });
        let patches: Vec<PatchState> = patches.collect();
        let count = patches.len();
        archive.integers("patches", count, patches.iter().map(|s| s.patches as i64))?;
        archive.integers("largest_patch", count, patches.iter().map(|s| s.largest as i64))?;
        let lengths = patches.iter().map(|s| s.perimeter.length(&self.grid));
        archive.numbers("perimeter", count, lengths)
    }

    fn parameters(&self) -> Parameters {
        Parameters {
            format: NAME.to_string(),
            version: if self.settings.hardness.is_some() { VERSION } else { ELASTIC_VERSION },
            program: concat!("asperity ", env!("CARGO_PKG_VERSION")).to_string(),
            shape: self.grid.shape(),
            cell: (self.grid.dx(), self.grid.dy()),
            kernel: self.kernel.clone(),
            settings: self.settings.clone(),
            end: self.end,
            bodies: self.bodies.clone(),
            window: self.history.window_end().map(window_end::Numbers::of),
            units: "SI: m, N, m², N/m, J; stiffness NaN where there is none; event 0 touch, 1 release, 2 limit, 3 yield"
                .to_string(),
        }
    }

    /// Reads a record that [`write_npz`](Self::write_npz) has written.
    ///
    /// # Errors
    ///
    /// [`FileError::Io`]; [`FileError::BadFile`] for a file that is damaged, not a record, or of a newer version;
    /// [`AdhesionError::Record`] for one with adhesion; those of [`Self::from_parts`].
    pub fn read_npz(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let archive = Archive::open(path, NAME)?;
        let bad = |reason: String| {
            Error::File(FileError::BadFile {
                path: path.to_path_buf(),
                format: NAME,
                offset: None,
                reason,
            })
        };
        let text = archive.text("parameters")?;
        let named: Result<Named, _> = serde_json::from_str(&text);
        if named.is_ok_and(|named| named.format == WITH_ADHESION) {
            return Err(AdhesionError::Record { path: path.to_path_buf() }.into());
        }
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
        let heights = HeightMap::new(archive.matrix("heights")?)?;
        let wholes_of = |name: &str, length: Option<usize>| {
            let values = archive.vector(name, length)?;
            match values.iter().find(|value| whole(**value) as f64 != **value) {
                Some(value) => Err(bad(format!("member '{name}': {value} is no whole number"))),
                None => Ok(values),
            }
        };
        let steps = wholes_of("step", None)?;
        let length = Some(steps.len());
        let wholes = |name: &str| wholes_of(name, length);
        let (ix, iy, nodes) = (wholes("ix")?, wholes("iy")?, wholes("contact_nodes")?);
        let events = wholes("event")?;
        let mut states = Vec::with_capacity(steps.len());
        for k in 0..steps.len() {
            let event =
                event(events[k]).ok_or_else(|| bad(format!("no event is {}", events[k])))?;
            // The other scalars follow, a column at a time.
            let contact = ContactState::new(&grid, whole(nodes[k]), 0.0, 0.0, 0.0);
            let node = (whole(ix[k]), whole(iy[k]));
            states.push(LoadingState::new(whole(steps[k]), event, node, contact));
        }
        for Column { name, set, .. } in COLUMNS {
            let values = archive.vector(name, length)?;
            for (state, value) in states.iter_mut().zip(values) {
                set(state, value);
            }
        }
        if parameters.settings.hardness.is_some() {
            let yielded = wholes("yielded_nodes")?;
            for (state, yielded) in states.iter_mut().zip(yielded) {
                let yielded_nodes = whole(yielded);
                let plastic = PlasticState {
                    yielded_nodes,
                    yielded_area_fraction: yielded_nodes as f64 / grid.nodes() as f64,
                    ..PlasticState::default()
                };
                state.contact.plastic = Some(plastic);
            }
            for Column { name, set, .. } in PLASTIC_COLUMNS {
                let values = archive.vector(name, length)?;
                for (state, value) in states.iter_mut().zip(values) {
                    if let Some(plastic) = &mut state.contact.plastic {
                        set(plastic, value);
                    }
                }
            }
        }
        let window = parameters.window;
        let window =
            window.map(|numbers| window_end::read(&archive, &grid, numbers)).transpose()?;
        let history = states.into_iter().collect::<History>().with_window_end(window);
        Self::from_parts(
            grid,
            heights,
            parameters.kernel,
            parameters.settings,
            history,
            parameters.end,
        )?
        .with_bodies(&parameters.bodies)
    }
}

/// A whole number of a file.
pub(super) fn whole(value: f64) -> usize {
    value as usize
}

/// The event of a number.
fn event(code: f64) -> Option<ContactEvent> {
    ContactEvent::ALL.into_iter().find(|event| f64::from(event.code()) == code)
}

#[cfg(test)]
mod tests;
