//! Errors of the engine as exceptions of Python, with their numbers as attributes.

use std::any::Any;
use std::convert::Infallible;
use std::path::PathBuf;

use asperity::{
    AdhesionError, BedError, CreepError, Error, FileError, JointError, KernelError, SlipError,
    StressError, SurfaceError, UpdaterError,
};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// What a function of this package fails with.
pub(crate) enum Failure {
    /// An error of the engine.
    Engine(Box<Error>),
    /// An argument that is no array of numbers, or has the wrong shape.
    Array { message: String, numbers: Numbers },
    /// What the arguments say together makes no sense.
    Arguments(String),
    /// A panic, which would be a mistake in the engine.
    Panic(String),
    /// An exception of Python.
    Python(PyErr),
}

/// The result of a function of this package.
pub(crate) type Fallible<T> = Result<T, Failure>;

/// Names and values of the attributes of an exception.
pub(crate) type Numbers = Vec<(&'static str, Number)>;

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Engine(Box::new(error))
    }
}

impl From<SurfaceError> for Failure {
    fn from(error: SurfaceError) -> Self {
        Error::from(error).into()
    }
}

impl From<FileError> for Failure {
    fn from(error: FileError) -> Self {
        Error::from(error).into()
    }
}

impl From<Infallible> for Failure {
    fn from(error: Infallible) -> Self {
        match error {}
    }
}

impl From<PyErr> for Failure {
    fn from(error: PyErr) -> Self {
        Self::Python(error)
    }
}

impl Failure {
    /// Of arguments that make no sense together.
    pub(crate) fn arguments(message: impl Into<String>) -> Self {
        Self::Arguments(message.into())
    }

    /// Of what a panic left.
    pub(crate) fn of_panic(payload: &(dyn Any + Send)) -> Self {
        let text = payload.downcast_ref::<&str>().map(ToString::to_string);
        let text = text.or_else(|| payload.downcast_ref::<String>().cloned());
        Self::Panic(text.unwrap_or_else(|| "a panic without words".to_string()))
    }
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        let (class, kind, message, numbers) = match failure {
            Failure::Python(error) => return error,
            Failure::Engine(error) => {
                let (class, kind, numbers) = describe(&error);
                (class, kind, message(&error, &numbers), numbers)
            }
            Failure::Array { message, numbers } => ("ArrayError", "Array", message, numbers),
            Failure::Arguments(message) => ("AsperityError", "Arguments", message, Vec::new()),
            Failure::Panic(text) => {
                let message = format!("a mistake in asperity, please report it: {text}");
                ("InternalError", "Panic", message, Vec::new())
            }
        };
        Python::attach(|py| {
            raise(py, class, kind, &message, numbers).unwrap_or_else(|error| {
                // Without the module of the exceptions, as while the interpreter ends.
                PyRuntimeError::new_err(format!("{message} ({error})"))
            })
        })
    }
}

/// An exception of the module `asperity.errors`.
fn raise(
    py: Python<'_>,
    class: &str,
    kind: &str,
    message: &str,
    numbers: Numbers,
) -> PyResult<PyErr> {
    let attributes = PyDict::new(py);
    attributes.set_item("kind", kind)?;
    for (name, number) in numbers {
        // Nodes by row and column too.
        match name {
            "ix" => attributes.set_item("column", number.clone())?,
            "iy" => attributes.set_item("row", number.clone())?,
            "nx" => attributes.set_item("columns", number.clone())?,
            "ny" => attributes.set_item("rows", number.clone())?,
            _ => {}
        }
        attributes.set_item(name, number)?;
    }
    let class = py.import("asperity.errors")?.getattr(class)?;
    Ok(PyErr::from_value(class.call((message,), Some(&attributes))?))
}

/// What an error says: of nodes and grids by rows and columns, as arrays have them.
fn message(error: &Error, numbers: &Numbers) -> String {
    if let Error::GridMismatch { expected, found } = *error {
        return format!(
            "expected {} rows x {} columns, but found {} x {}",
            expected.1, expected.0, found.1, found.0
        );
    }
    let text = in_python(&error.to_string());
    let count = |wanted: &str| {
        numbers.iter().find_map(|(name, number)| match number {
            Number::Count(count) if *name == wanted => Some(*count),
            _ => None,
        })
    };
    if let (Some(ix), Some(iy)) = (count("ix"), count("iy")) {
        return text
            .replace(&format!("node ({ix}, {iy})"), &format!("the node in row {iy}, column {ix}"));
    }
    if let (Some(nx), Some(ny)) = (count("nx"), count("ny")) {
        return text.replace(&format!("{nx} x {ny}"), &format!("{ny} x {nx} (rows x columns)"));
    }
    text
}

/// Words of the library in those of this package.
pub(crate) fn in_python(text: &str) -> String {
    const WORDS: [(&str, &str); 14] = [
        ("`surface::fill_missing`", "`Surface.fill_missing()`"),
        ("`ReadOptions::height_unit`", "`height_unit=`"),
        ("`ReadOptions::lateral_unit`", "`lateral_unit=`"),
        ("`ReadOptions::side`", "`size=`"),
        ("`ReadOptions::channel`", "`channel=`"),
        ("`ReadOptions::layout`", "`layout=`"),
        ("`ReadOptions::rows_are_y`", "`rows_are_y=True`"),
        ("`Topography::level`", "`Surface.level(\"plane\")`"),
        ("`AdhesiveRecord` reads it", "`asperity.open` reads it"),
        ("`kernel::check`", "`check_half_space`"),
        ("The model is elastic", "The model is elastic unless a `hardness=` is given"),
        ("of this crate", "of this package"),
        ("it has to be given", "it has to be given, as `half_space=`"),
        ("step the bed through it", "`Creep.follow` steps through it"),
    ];
    WORDS.iter().fold(text.to_string(), |text, (rust, python)| text.replace(rust, python))
}

/// An attribute of an exception.
#[derive(Clone, IntoPyObject)]
pub(crate) enum Number {
    Real(f64),
    Count(usize),
    Offset(isize),
    Text(String),
    Texts(Vec<String>),
    Counts(Vec<usize>),
    CountPair((usize, usize)),
    RealPair((f64, f64)),
    MaybeCount(Option<usize>),
    MaybeReal(Option<f64>),
    MaybeText(Option<String>),
}

macro_rules! from {
    ($($variant:ident: $type:ty),* $(,)?) => {$(
        impl From<$type> for Number {
            fn from(value: $type) -> Self {
                Self::$variant(value)
            }
        }
    )*};
}
from!(
    Real: f64, Count: usize, Offset: isize, Text: String, Texts: Vec<String>, Counts: Vec<usize>,
    CountPair: (usize, usize), RealPair: (f64, f64), MaybeCount: Option<usize>, MaybeReal: Option<f64>,
    MaybeText: Option<String>,
);

impl From<&'static str> for Number {
    fn from(value: &'static str) -> Self {
        Self::Text(value.to_string())
    }
}

impl From<char> for Number {
    fn from(value: char) -> Self {
        Self::Text(value.to_string())
    }
}

impl From<PathBuf> for Number {
    fn from(value: PathBuf) -> Self {
        Self::Text(value.display().to_string())
    }
}

/// The attributes of these names, from variables of the same names.
macro_rules! numbers {
    ($($name:ident),* $(,)?) => { vec![$((stringify!($name), Number::from($name.clone()))),*] };
}

/// The class of an exception, the name of the error, and its numbers.
type Described = (&'static str, &'static str, Numbers);

const VALUE: &str = "AsperityError";
const CONVERGENCE: &str = "ConvergenceError";
const MEMORY: &str = "MemoryLimitError";

fn describe(error: &Error) -> Described {
    match error {
        Error::NotPositive { quantity, value } => (VALUE, "NotPositive", numbers![quantity, value]),
        Error::OutOfRange { quantity, value, expected } => {
            (VALUE, "OutOfRange", numbers![quantity, value, expected])
        }
        Error::FieldNotFinite { field, ix, iy, value } => {
            (VALUE, "FieldNotFinite", numbers![field, ix, iy, value])
        }
        Error::GridMismatch { expected, found } => {
            let [expected, found] = [expected, found].map(|(columns, rows)| (*rows, *columns));
            (VALUE, "GridMismatch", numbers![expected, found])
        }
        Error::LengthMismatch { expected, found } => {
            (VALUE, "LengthMismatch", numbers![expected, found])
        }
        Error::NodeOutOfGrid { node, nodes } => (VALUE, "NodeOutOfGrid", numbers![node, nodes]),
        Error::Kernel(error) => of_kernel(error),
        Error::NotPositiveDefinite { ix, iy, approach, pivot } => {
            (VALUE, "NotPositiveDefinite", numbers![ix, iy, approach, pivot])
        }
        Error::NotFinite { step } => (VALUE, "NotFinite", numbers![step]),
        Error::RecordNotFinite { step, quantity, value } => {
            (VALUE, "RecordNotFinite", numbers![step, quantity, value])
        }
        Error::WrongBoundary { expected, found } => {
            (VALUE, "WrongBoundary", numbers![expected, found])
        }
        Error::Inconsistent { step, quantity, value, expected, reason } => {
            (VALUE, "Inconsistent", numbers![step, quantity, value, expected, reason])
        }
        Error::NotOnPath { step, load, approach, quantity, value, expected } => {
            (VALUE, "NotOnPath", numbers![step, load, approach, quantity, value, expected])
        }
        Error::BeyondHardness { load, mean_pressure, hardness } => {
            (VALUE, "BeyondHardness", numbers![load, mean_pressure, hardness])
        }
        Error::ForeignKernel => (VALUE, "ForeignKernel", Vec::new()),
        Error::WrongKernel { expected, found } => (VALUE, "WrongKernel", numbers![expected, found]),
        Error::CannotContinue { steps } => (VALUE, "CannotContinue", numbers![steps]),
        Error::StateNotReached { step, present } => {
            (VALUE, "StateNotReached", numbers![step, present])
        }
        Error::FactorizationFailed { nodes } => (VALUE, "FactorizationFailed", numbers![nodes]),
        Error::NotMonotone { quantity, ix, iy, approach, value } => {
            (VALUE, "NotMonotone", numbers![quantity, ix, iy, approach, value])
        }
        Error::AlreadyInContact { ix, iy } => (VALUE, "AlreadyInContact", numbers![ix, iy]),
        Error::NotInContact { ix, iy } => (VALUE, "NotInContact", numbers![ix, iy]),
        Error::NodeLeaves { ix, iy, event } => (VALUE, "NodeLeaves", numbers![ix, iy, event]),
        Error::Cycling { approach, events } => (CONVERGENCE, "Cycling", numbers![approach, events]),
        Error::ApproachNotReached { approach, mean_gap } => {
            (VALUE, "ApproachNotReached", numbers![approach, mean_gap])
        }
        Error::MemoryBudget { needed, budget, nodes_that_fit } => {
            (MEMORY, "MemoryBudget", numbers![needed, budget, nodes_that_fit])
        }
        Error::NoConvergence { residual, tolerance, iterations } => {
            (CONVERGENCE, "NoConvergence", numbers![residual, tolerance, iterations])
        }
        Error::Updater(error) => of_updater(error),
        Error::Bed(error) => of_bed(error),
        Error::Creep(error) => of_creep(error),
        Error::Slip(error) => of_slip(error),
        Error::Joint(error) => of_joint(error),
        Error::Stress(error) => of_stress(error),
        Error::NotHomogeneous { asked, reason } => {
            (VALUE, "NotHomogeneous", numbers![asked, reason])
        }
        Error::Adhesion(error) => of_adhesion(error),
        Error::Surface(error) => of_surface(error),
        Error::File(error) => of_file(error),
        // Those that come to be later have their words.
        _ => (VALUE, "Other", Vec::new()),
    }
}

fn of_stress(error: &StressError) -> Described {
    match error {
        StressError::NoLoad => (VALUE, "NoLoad", Vec::new()),
        StressError::InRigidBase { depth, thickness } => {
            (VALUE, "InRigidBase", numbers![depth, thickness])
        }
        StressError::BehindHardness { yield_stress, load, reached } => {
            (VALUE, "BehindHardness", numbers![yield_stress, load, reached])
        }
        StressError::YieldStresses { given, materials } => {
            (VALUE, "YieldStresses", numbers![given, materials])
        }
        _ => (VALUE, "Other", Vec::new()),
    }
}

fn of_kernel(error: &KernelError) -> Described {
    match error {
        KernelError::NotFinite { di, dj, value } => {
            (VALUE, "KernelNotFinite", numbers![di, dj, value])
        }
        KernelError::NotSymmetric { di, dj, value, opposite } => {
            (VALUE, "NotSymmetric", numbers![di, dj, value, opposite])
        }
        KernelError::NotPeriodic { di, dj, value, image_di, image_dj, repeated } => {
            (VALUE, "NotPeriodic", numbers![di, dj, value, image_di, image_dj, repeated])
        }
        KernelError::SymbolNotPositive { q, value } => {
            (VALUE, "SymbolNotPositive", numbers![q, value])
        }
        KernelError::SymbolNotEven { q, value, opposite } => {
            (VALUE, "SymbolNotEven", numbers![q, value, opposite])
        }
        KernelError::GrowthUnknown => (VALUE, "GrowthUnknown", Vec::new()),
        KernelError::BrokenPromise { promise, quantity, contact, node, value } => {
            (VALUE, "BrokenPromise", numbers![promise, quantity, contact, node, value])
        }
        _ => (VALUE, "Kernel", Vec::new()),
    }
}

fn of_updater(error: &UpdaterError) -> Described {
    match error {
        UpdaterError::UpdaterMismatch { quantity, expected, found } => {
            (VALUE, "UpdaterMismatch", numbers![quantity, expected, found])
        }
        UpdaterError::UpdaterWrong { quantity, contact_nodes, error, tolerance } => {
            (VALUE, "UpdaterWrong", numbers![quantity, contact_nodes, error, tolerance])
        }
        UpdaterError::ContactNotClosed { quantity, ix, iy, value, tolerance } => {
            (CONVERGENCE, "ContactNotClosed", numbers![quantity, ix, iy, value, tolerance])
        }
        UpdaterError::TooManyWatched { nodes } => (MEMORY, "TooManyWatched", numbers![nodes]),
        UpdaterError::ReleaseNotSupported { ix, iy } => {
            (VALUE, "ReleaseNotSupported", numbers![ix, iy])
        }
        UpdaterError::HardnessNotSupported => (VALUE, "HardnessNotSupported", Vec::new()),
        _ => (VALUE, "Updater", Vec::new()),
    }
}

fn of_bed(error: &BedError) -> Described {
    match error {
        BedError::Empty => (VALUE, "EmptyPath", Vec::new()),
        BedError::NotFromFirstTouch { load, approach } => {
            (VALUE, "NotFromFirstTouch", numbers![load, approach])
        }
        BedError::NotElasticGrowth { event, ix, iy, happens, instead } => {
            (VALUE, "NotElasticGrowth", numbers![event, ix, iy, happens, instead])
        }
        BedError::NotMonotone { step, quantity, value, before, expected } => {
            (VALUE, "PathNotMonotone", numbers![step, quantity, value, before, expected])
        }
        BedError::NoStiffness { step, stiffness } => {
            (VALUE, "NoStiffness", numbers![step, stiffness])
        }
        BedError::PathEndsBefore { quantity, value, end } => {
            (VALUE, "PathEndsBefore", numbers![quantity, value, end])
        }
        _ => (VALUE, "Bed", Vec::new()),
    }
}

fn of_creep(error: &CreepError) -> Described {
    match error {
        CreepError::ContactRecedes { time, effective_load } => {
            (VALUE, "ContactRecedes", numbers![time, effective_load])
        }
        CreepError::ContactReturns { time } => (VALUE, "ContactReturns", numbers![time]),
        CreepError::PathEnds { time, effective_load, path_ends, until } => {
            (VALUE, "PathEnds", numbers![time, effective_load, path_ends, until])
        }
        CreepError::BedEnds { time, path_ends } => (VALUE, "BedEnds", numbers![time, path_ends]),
        CreepError::StepFails { time, step } => (CONVERGENCE, "StepFails", numbers![time, step]),
        CreepError::NotSteady { cycles, distance, tolerance } => {
            (CONVERGENCE, "NotSteady", numbers![cycles, distance, tolerance])
        }
        CreepError::NoSteadyCycle { fluidity } => (VALUE, "NoSteadyCycle", numbers![fluidity]),
        _ => (VALUE, "Creep", Vec::new()),
    }
}

fn of_slip(error: &SlipError) -> Described {
    match error {
        SlipError::JointSlides { tangential_load, load, limit } => {
            (VALUE, "JointSlides", numbers![tangential_load, load, limit])
        }
        SlipError::StaysAtLimit { from, to } => (VALUE, "StaysAtLimit", numbers![from, to]),
        SlipError::WithinPathError { change, approach_error } => {
            (VALUE, "WithinPathError", numbers![change, approach_error])
        }
        _ => (VALUE, "Slip", Vec::new()),
    }
}

fn of_joint(error: &JointError) -> Described {
    match error {
        JointError::NoUnloadingStiffness { yielded_nodes, contact_nodes } => {
            (VALUE, "NoUnloadingStiffness", numbers![yielded_nodes, contact_nodes])
        }
        JointError::BoundsWithYielding { step } => (VALUE, "BoundsWithYielding", numbers![step]),
        JointError::NoFunction { step, quantity, value, interpolated, tolerance } => {
            (VALUE, "NoFunction", numbers![step, quantity, value, interpolated, tolerance])
        }
        _ => (VALUE, "Joint", Vec::new()),
    }
}

fn of_adhesion(error: &AdhesionError) -> Described {
    match error {
        AdhesionError::Unresolved { resolution, greatest, cell, cell_needed } => {
            (VALUE, "AdhesionUnresolved", numbers![resolution, greatest, cell, cell_needed])
        }
        AdhesionError::NoRoomForSlope { stress, range, slope, cell, cell_needed } => {
            (VALUE, "NoRoomForSlope", numbers![stress, range, slope, cell, cell_needed])
        }
        AdhesionError::GrowthUnknown => (VALUE, "GrowthUnknown", Vec::new()),
        AdhesionError::Behind { quantity, value, present } => {
            (VALUE, "Behind", numbers![quantity, value, present])
        }
        AdhesionError::NotOnLaw { ix, iy, approach, value } => {
            (VALUE, "NotOnLaw", numbers![ix, iy, approach, value])
        }
        AdhesionError::WrongChanges { step } => (VALUE, "WrongChanges", numbers![step]),
        AdhesionError::Record { path } => {
            let filename = path;
            ("FileError", "RecordWithAdhesion", numbers![filename])
        }
        _ => (VALUE, "Adhesion", Vec::new()),
    }
}

fn of_surface(error: &SurfaceError) -> Described {
    match error {
        SurfaceError::EmptyGrid { nx, ny } => (VALUE, "EmptyGrid", numbers![nx, ny]),
        SurfaceError::CellMismatch { expected, found } => {
            (VALUE, "CellMismatch", numbers![expected, found])
        }
        SurfaceError::GridTooLarge { nx, ny, max_side } => {
            (VALUE, "GridTooLarge", numbers![nx, ny, max_side])
        }
        SurfaceError::HeightNotFinite { ix, iy, value, count } => {
            (VALUE, "HeightNotFinite", numbers![ix, iy, value, count])
        }
        SurfaceError::NothingMeasured { nx, ny } => (VALUE, "NothingMeasured", numbers![nx, ny]),
        SurfaceError::CropOutOfGrid { axis, start, end, nodes } => {
            (VALUE, "CropOutOfGrid", numbers![axis, start, end, nodes])
        }
        SurfaceError::CutoffBelowGrid { wavelength, shortest } => {
            (VALUE, "CutoffBelowGrid", numbers![wavelength, shortest])
        }
        SurfaceError::NoWaves { shortest, longest } => {
            (VALUE, "NoWaves", numbers![shortest, longest])
        }
        SurfaceError::TooFewWaves { found, needed } => {
            (VALUE, "TooFewWaves", numbers![found, needed])
        }
        SurfaceError::LessThanOneNode { fraction, least } => {
            (VALUE, "LessThanOneNode", numbers![fraction, least])
        }
        SurfaceError::NoConvergence { residual, tolerance, iterations } => {
            (CONVERGENCE, "NoConvergence", numbers![residual, tolerance, iterations])
        }
        _ => (VALUE, "Surface", Vec::new()),
    }
}

fn of_file(error: &FileError) -> Described {
    match error {
        FileError::Io { path, source } => {
            let class = match source.kind() {
                std::io::ErrorKind::NotFound => "MissingFileError",
                std::io::ErrorKind::PermissionDenied => "ForbiddenFileError",
                _ => "FileError",
            };
            let filename = path;
            let mut numbers = numbers![filename];
            if let Some(errno) = source.raw_os_error() {
                let text = source.to_string().replace(&format!(" (os error {errno})"), "");
                numbers.push(("errno", Number::Offset(errno as isize)));
                numbers.push(("strerror", Number::Text(text)));
            }
            (class, "Io", numbers)
        }
        FileError::UnknownFormat { path, begins, what } => {
            let filename = path;
            let begins = begins.iter().map(|byte| usize::from(*byte)).collect::<Vec<_>>();
            ("FileError", "UnknownFormat", numbers![filename, begins, what])
        }
        FileError::BadFile { path, format, offset, reason } => {
            let filename = path;
            ("FileError", "BadFile", numbers![filename, format, offset, reason])
        }
        FileError::WhichChannel { path, wanted, channels } => {
            let filename = path;
            ("FileError", "WhichChannel", numbers![filename, wanted, channels])
        }
        FileError::NoUnit { path, quantity, found, option } => {
            let filename = path;
            ("FileError", "NoUnit", numbers![filename, quantity, found, option])
        }
        FileError::NoLayout { layout } => (VALUE, "NoLayout", numbers![layout]),
        FileError::NoLength { unit } => (VALUE, "NoLength", numbers![unit]),
        FileError::NoSide => ("FileError", "NoSide", Vec::new()),
        _ => ("FileError", "File", Vec::new()),
    }
}
