//! The paths of the table: one for each kind of body, of material, and of how it is followed.

use asperity::kernel::{Base, Layer, Layered, LayeredBody};
use asperity::loading::{History, LoadingBuilder};
use asperity::record::LoadingRecord;
use asperity::surface::Axis;
use asperity::surface::HeightMap;
use asperity::updater::{ConjugateGradient, Handover, LinearUpdater};
use asperity::{
    Boussinesq, Error, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq,
    SemiPeriodicBoussinesq,
};
use asperity_testing::surfaces::self_affine;
use nalgebra::DMatrix;

pub(super) const E_STAR: f64 = 1e11;
const HARDNESS: f64 = 4e9;

/// An updater of any kind.
pub(super) type Any = Box<dyn LinearUpdater>;

/// A path of the table.
pub(super) struct Row {
    pub(super) name: &'static str,
    pub(super) surface: HeightMap,
    pub(super) kernel: Box<dyn InfluenceKernel>,
    pub(super) hardness: Option<DMatrix<f64>>,
    /// Without a factor.
    pub(super) iterative: bool,
    /// Interrupted, and continued from its record.
    resumed: bool,
    /// The area fraction at which it ends, unless it goes on to the end.
    until: Option<f64>,
}

/// A path that was followed to its end.
pub(super) struct Pressed<'a> {
    pub(super) row: &'a Row,
    pub(super) path: LoadingSolver<Any>,
    pub(super) history: History,
}

impl Row {
    fn new(name: &'static str, surface: HeightMap, kernel: impl InfluenceKernel + 'static) -> Self {
        let kernel = Box::new(kernel);
        let (hardness, until) = (None, Some(0.5));
        Self { name, surface, kernel, hardness, iterative: false, resumed: false, until }
    }

    /// The path of a surface.
    fn builder_of<'a>(&'a self, surface: &'a HeightMap) -> LoadingBuilder<'a, Any> {
        let updater: Any = match self.iterative {
            true => Box::new(ConjugateGradient::new()),
            false => Box::new(Handover::new()),
        };
        let builder = LoadingSolver::builder(surface, &*self.kernel).updater(updater);
        let builder = match self.until {
            Some(area) => builder.max_area_fraction(area),
            None => builder,
        };
        match &self.hardness {
            Some(hardness) => builder.hardness_map(hardness),
            None => builder,
        }
    }

    /// How far a number of a path may be from that of a dense solution. With a factor both have a condition number of some 10³ and
    /// stiffnesses are quotients of differences; without one docs/reliability.md has what events are off by at worst, 2·10⁻⁴ of an
    /// interfacial stiffness.
    pub(super) fn tolerance(&self) -> f64 {
        if self.iterative { 2e-4 } else { 1e-9 }
    }

    /// Follows the path, at most to so many states.
    pub(super) fn follow(&self, states: usize) -> (LoadingSolver<Any>, History) {
        let mut path = self.builder_of(&self.surface).build().unwrap();
        let history = path.by_ref().take(states).collect::<Result<_, Error>>().unwrap();
        (path, history)
    }

    /// Goes on behind a record, which is written and read.
    pub(super) fn resume(&self, record: &LoadingRecord) -> (LoadingSolver<Any>, History) {
        let record = through_a_file(record);
        let mut path = self.builder_of(record.heights()).resume(record.history()).unwrap();
        let mut history: History = record.history().events().iter().copied().collect();
        history = history.on(record.history().layering());
        history.extend(path.by_ref().map(Result::unwrap));
        (path, history)
    }

    pub(super) fn press(&self) -> Pressed<'_> {
        let (path, history) = if self.resumed {
            let (path, history) = self.follow(50);
            self.resume(&LoadingRecord::new(&path, history).unwrap())
        } else {
            self.follow(usize::MAX)
        };
        let history = history.on(self.kernel.origin().layering());
        Pressed { row: self, path, history }
    }
}

pub(super) fn through_a_file(record: &LoadingRecord) -> LoadingRecord {
    use std::sync::atomic::{AtomicUsize, Ordering};
    static NEXT: AtomicUsize = AtomicUsize::new(0);
    let number = NEXT.fetch_add(1, Ordering::Relaxed);
    let file = format!("asperity-together-{}-{number}.npz", std::process::id());
    let file = std::env::temp_dir().join(file);
    record.write_npz(&file, &[]).unwrap();
    let read = LoadingRecord::read_npz(&file);
    std::fs::remove_file(&file).unwrap();
    read.unwrap()
}

/// All rows, in the order of the page.
pub(super) fn all() -> Vec<Row> {
    let grid = Grid::square(16, 3.2e-4).unwrap();
    let rough = |grid: &Grid| self_affine(grid, 0.8, 1.5e-6, 3);
    let free = |name| Row::new(name, rough(&grid), Boussinesq::new(grid, E_STAR).unwrap());
    let periodic = || PeriodicBoussinesq::new(grid, E_STAR).unwrap();
    let along = |axis| SemiPeriodicBoussinesq::new(grid, E_STAR, axis).unwrap();
    let long = Grid::new(18, 12, 2e-5, 3e-5).unwrap();
    let long = Row::new("non-square cells", rough(&long), Boussinesq::new(long, E_STAR).unwrap());
    let layered = |young, thickness, base| {
        let layer = Layer { young, poisson: 0.3, thickness };
        Layered::free(grid, LayeredBody::new(&[layer], base).unwrap()).unwrap()
    };
    let steel = Base::HalfSpace { young: 210e9, poisson: 0.3 };
    let rubber = Base::HalfSpace { young: 3e9, poisson: 0.3 };
    let uniform = || Some(DMatrix::from_element(16, 16, HARDNESS));
    // A third of the nodes never yields.
    let map = DMatrix::from_fn(16, 16, |ix, iy| match (ix + iy) % 3 {
        0 => f64::INFINITY,
        _ => HARDNESS * (1.0 + 0.5 * (ix as f64).sin()),
    });
    let hard = Row { hardness: uniform(), ..free("hardness") };
    let residual = hard.press().path.residual_surface().unwrap();
    vec![
        free("free"),
        Row::new("periodic", rough(&grid), periodic()),
        Row::new("periodic x", rough(&grid), along(Axis::X)),
        Row::new("periodic y", rough(&grid), along(Axis::Y)),
        long,
        Row { until: None, ..Row::new("full contact", rough(&grid), periodic()) },
        hard,
        Row { hardness: Some(map), ..free("hardness per node") },
        Row { hardness: uniform(), until: None, ..free("fully plastic") },
        Row { surface: residual, ..free("after unloading") },
        Row::new("sheet", rough(&grid), layered(E_STAR, 6e-5, Base::Rigid)),
        Row::new("soft layer", rough(&grid), layered(50e9, 4e-5, steel)),
        Row::new("stiff layer", rough(&grid), layered(210e9, 2e-5, rubber)),
        Row { iterative: true, ..free("without a factor") },
        Row { resumed: true, ..free("resumed") },
    ]
}
