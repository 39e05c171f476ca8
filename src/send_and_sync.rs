//! All types of this crate can be sent to other threads and shared between them; of those with parameters, where these
//! can. The builders cannot: they borrow a surface and a kernel that need not. What is asserted here holds if it
//! compiles.

use crate::adhesion::{
    Adhesion, AdhesiveBranch, AdhesiveEnd, AdhesiveEvent, AdhesiveFields, AdhesivePath,
    AdhesiveState, CohesiveLaw, Direction, NodeState,
};
use crate::bed::{Bed, BedState, Piece, Spring, Superposed, Superposition};
use crate::contact::{
    Certificate, ContactFields, ContactSequence, ContactState, ContactTarget, PlasticState,
};
use crate::convolution::Convolution;
use crate::creep::{
    ControlHistory, Creep, CreepState, Cycle, PiecewiseLinear, Prony, Recession, Relaxation,
    Unloading, UnloadingState, ViscoelasticBed,
};
use crate::fixed_load::{FixedLoadSolution, FixedLoadSolver, LoadSweep, SolverEffort};
use crate::joint::{
    Carrier, ConductanceBounds, Conduction, FeProgram, InterfaceRow, InterfaceTable,
};
use crate::kernel::{
    Base, Boundary, Boussinesq, ContactGrowth, KernelOrigin, KernelReport, KernelTable, Layer,
    Layered, LayeredBody, Layering, MeanDisplacement, PeriodicBoussinesq, SemiPeriodicBoussinesq,
    Spectral,
};
use crate::leak::{CriticalConstriction, Leak, LeakCurve, LeakPoint, Seal};
use crate::loading::{
    ContactEvent, ContactRule, History, LoadingEnd, LoadingPath, LoadingSolver, LoadingState,
};
use crate::patches::{
    Bins, Branch, Connectivity, Constriction, ContactEdge, FieldDistribution, Histogram, MergeTree,
    Merger, Patch, PatchEvent, PatchHistory, PatchLoad, PatchState, Patches, Percolation,
    Perimeter,
};
use crate::record::{AdhesiveRecord, KernelRecord, LoadingRecord, Settings};
use crate::reference::{
    AreaLoadLaw, CircularPunch, Cone, DoubleWave, HertzEllipse, HertzLine, HertzSphere, SphereSlip,
    Westergaard,
};
use crate::slip::{
    Friction, JenkinsElement, PartialSlip, SlipCycle, SlipHistory, SlipState, SlipZone,
};
use crate::stress::{
    DepthSurvey, FirstYield, Greatest, Measure, Stress, StressField, Subsurface, Survey,
};
use crate::surface::{HeightMap, SelfAffine, Topography};
use crate::updater::{
    ConjugateGradient, Dense, Handover, RecursiveCholesky, Schur, Solution, UpdaterReport,
    WindowFactor,
};
use crate::{
    AdhesionError, BedError, CreepError, Error, FileError, Grid, JointError, KernelError, Problem,
    SlipError, StressError, UpdaterError, Warning,
};

/// Compiles for types that can be sent and shared.
const fn asserted<T: Send + Sync>() {}

macro_rules! send_and_sync {
    ($($t:ty),+ $(,)?) => { const _: () = { $(asserted::<$t>();)+ }; };
}

send_and_sync!(Grid, Problem, Warning);
send_and_sync!(
    Error,
    FileError,
    AdhesionError,
    BedError,
    CreepError,
    JointError,
    KernelError,
    SlipError,
    StressError,
    UpdaterError
);
send_and_sync!(
    Certificate,
    ContactFields,
    ContactSequence,
    ContactState,
    ContactTarget,
    Convolution,
    PlasticState,
);
send_and_sync!(
    FixedLoadSolution,
    FixedLoadSolver,
    LoadSweep<'static, std::vec::IntoIter<ContactTarget>>,
    SolverEffort,
);
send_and_sync!(
    Base,
    Boundary,
    Boussinesq,
    ContactGrowth,
    KernelOrigin,
    KernelReport,
    KernelTable,
    Layer,
    Layered,
    LayeredBody,
    Layering,
    MeanDisplacement,
    PeriodicBoussinesq,
    SemiPeriodicBoussinesq,
    Spectral,
);
send_and_sync!(
    ContactEvent,
    ContactRule,
    History,
    LoadingEnd,
    LoadingPath,
    LoadingSolver,
    LoadingSolver<ConjugateGradient>,
    LoadingSolver<Dense>,
    LoadingSolver<RecursiveCholesky>,
    LoadingState,
);
send_and_sync!(
    Adhesion,
    AdhesiveBranch,
    AdhesiveEnd,
    AdhesiveEvent,
    AdhesiveFields,
    AdhesivePath,
    AdhesiveState,
    CohesiveLaw,
    Direction,
    NodeState,
);
send_and_sync!(
    Bins,
    Branch,
    Connectivity,
    Constriction,
    ContactEdge,
    FieldDistribution,
    Histogram,
    MergeTree,
    Merger,
    Patch,
    PatchEvent,
    PatchHistory<'static>,
    PatchLoad,
    PatchState,
    Patches,
    Percolation,
    Perimeter,
);
send_and_sync!(Bed<'static>, BedState, Piece, Spring, Superposed, Superposition);
send_and_sync!(
    Friction,
    JenkinsElement,
    PartialSlip<'static>,
    SlipCycle,
    SlipHistory<'static>,
    SlipState,
    SlipZone,
);
send_and_sync!(AdhesiveRecord, KernelRecord, LoadingRecord, Settings);
send_and_sync!(Carrier, ConductanceBounds, Conduction, FeProgram, InterfaceRow, InterfaceTable);
send_and_sync!(CriticalConstriction, Leak, LeakCurve, LeakPoint, Seal);
send_and_sync!(
    AreaLoadLaw,
    CircularPunch,
    Cone,
    DoubleWave,
    HertzEllipse,
    HertzLine,
    HertzSphere,
    SphereSlip,
    Westergaard,
);
send_and_sync!(
    PiecewiseLinear,
    ControlHistory,
    Creep<'static>,
    CreepState,
    Cycle,
    Prony,
    Recession,
    Relaxation<'static>
);
send_and_sync!(Unloading<'static, 'static>, UnloadingState, ViscoelasticBed<'static>);
send_and_sync!(HeightMap, SelfAffine, Topography);
send_and_sync!(
    ConjugateGradient,
    Dense,
    Handover,
    RecursiveCholesky,
    Schur,
    Solution,
    UpdaterReport,
    WindowFactor,
);
send_and_sync!(DepthSurvey, FirstYield, Greatest, Measure, Stress, StressField, Subsurface, Survey,);
