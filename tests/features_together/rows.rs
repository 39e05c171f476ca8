//! The paths of the table: one for each kind of body, of material, and of how it is followed.

use std::sync::{Arc, OnceLock};

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

/// A body.
type Kernel = Arc<dyn InfluenceKernel + Send + Sync>;

/// A path of the table.
#[derive(Clone)]
pub(super) struct Row {
    pub(super) name: &'static str,
    pub(super) surface: HeightMap,
    pub(super) kernel: Kernel,
    pub(super) hardness: Option<DMatrix<f64>>,
    /// Without a factor.
    pub(super) iterative: bool,
    /// Interrupted, and continued from its record.
    pub(super) resumed: bool,
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
    fn new(
        name: &'static str,
        surface: HeightMap,
        kernel: impl InfluenceKernel + Send + Sync + 'static,
    ) -> Self {
        let kernel = Arc::new(kernel);
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

    /// How far a number of a path may be from that of a dense solution. With a factor both have a condition number of
    /// some 10³ and stiffnesses are quotients of differences; without one docs/reliability.md has what events are off
    /// by at worst, 2·10⁻⁴ of an interfacial stiffness.
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
        let history = history.on(self.kernel.origin().layering(self.kernel.boundary()));
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

/// A sheet on a rigid base, a soft layer and a stiff one.
pub(super) fn bodies() -> [LayeredBody; 3] {
    let steel = Base::HalfSpace { youngs_modulus: 210e9, poissons_ratio: 0.3 };
    let rubber = Base::HalfSpace { youngs_modulus: 3e9, poissons_ratio: 0.3 };
    [(E_STAR, 6e-5, Base::Rigid), (50e9, 4e-5, steel), (210e9, 2e-5, rubber)].map(
        |(youngs_modulus, thickness, base)| {
            LayeredBody::new(&[Layer { youngs_modulus, poissons_ratio: 0.3, thickness }], base)
                .unwrap()
        },
    )
}

/// All rows, in the order of the page.
pub(super) fn all() -> &'static [Row] {
    static ALL: OnceLock<Vec<Row>> = OnceLock::new();
    ALL.get_or_init(make_all)
}

fn make_all() -> Vec<Row> {
    let grid = Grid::square(16, 3.2e-4).unwrap();
    let rough = |grid: &Grid| self_affine(grid, 0.8, 1.5e-6, 3);
    let free = |name| Row::new(name, rough(&grid), Boussinesq::new(grid, E_STAR).unwrap());
    let periodic = || PeriodicBoussinesq::new(grid, E_STAR).unwrap();
    let along = |axis| SemiPeriodicBoussinesq::new(grid, E_STAR, axis).unwrap();
    let long = Grid::new(18, 12, 2e-5, 3e-5).unwrap();
    let long = Row::new("non-square cells", rough(&long), Boussinesq::new(long, E_STAR).unwrap());
    let layered = |body| Layered::free(grid, body).unwrap();
    let [sheet, soft, stiff] = bodies();
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
        Row::new("sheet", rough(&grid), layered(sheet)),
        Row::new("soft layer", rough(&grid), layered(soft)),
        Row::new("stiff layer", rough(&grid), layered(stiff)),
        Row { iterative: true, ..free("without a factor") },
        Row { resumed: true, ..free("resumed") },
    ]
}

/// Two rows in one, and three: of these the page says what it says of each.
pub(super) fn both() -> &'static [Row] {
    static BOTH: OnceLock<Vec<Row>> = OnceLock::new();
    BOTH.get_or_init(make_both)
}

fn make_both() -> Vec<Row> {
    let find = |row: &str| all().iter().find(|other| other.name == row).unwrap().clone();
    let take = |name: &'static str, row: &str| Row { name, ..find(row) };
    let hard = |name| take(name, "hardness");
    let plastic = |name| take(name, "fully plastic");
    let square = all()[0].kernel.grid();
    let [sheet, soft, _] = bodies();
    let long = |name| take(name, "non-square cells");
    let periodic_long = PeriodicBoussinesq::new(long("").kernel.grid(), E_STAR).unwrap();
    let on_long = DMatrix::from_element(18, 12, HARDNESS);
    let kernel = |row: &str| find(row).kernel;
    let layered = |body| -> Kernel { Arc::new(Layered::periodic(square, body).unwrap()) };
    vec![
        Row { kernel: kernel("periodic"), ..hard("hardness, periodic") },
        Row {
            kernel: kernel("periodic x"),
            ..take("hardness per node, periodic x", "hardness per node")
        },
        Row { kernel: kernel("periodic y"), ..hard("hardness, periodic y") },
        Row { hardness: Some(on_long), ..long("hardness, non-square cells") },
        Row { kernel: kernel("sheet"), ..hard("hardness, sheet") },
        Row { kernel: kernel("soft layer"), ..hard("hardness, soft layer") },
        Row { iterative: true, ..hard("hardness, without a factor") },
        Row { iterative: true, ..take("hardness per node, without a factor", "hardness per node") },
        Row { resumed: true, ..hard("hardness, resumed") },
        Row { kernel: kernel("periodic"), ..plastic("fully plastic, periodic") },
        Row { kernel: kernel("periodic x"), ..plastic("fully plastic, periodic x") },
        Row { resumed: true, ..plastic("fully plastic, resumed") },
        Row { kernel: kernel("sheet"), ..plastic("fully plastic, sheet") },
        Row { iterative: true, ..plastic("fully plastic, without a factor") },
        Row { kernel: Arc::new(periodic_long), ..long("non-square cells, periodic") },
        Row { iterative: true, ..long("non-square cells, without a factor") },
        Row { kernel: kernel("periodic"), ..take("after unloading, periodic", "after unloading") },
        Row { iterative: true, ..take("after unloading, without a factor", "after unloading") },
        Row { kernel: layered(sheet), ..take("sheet, periodic", "sheet") },
        Row { kernel: layered(soft), ..take("soft layer, periodic", "soft layer") },
        Row { iterative: true, ..take("sheet, without a factor", "sheet") },
        Row { iterative: true, ..take("stiff layer, without a factor", "stiff layer") },
        Row { resumed: true, ..take("stiff layer, resumed", "stiff layer") },
        Row { until: None, ..take("full contact, free", "free") },
        Row {
            kernel: kernel("periodic y"),
            until: None,
            ..take("full contact, periodic y", "free")
        },
        Row { iterative: true, ..take("full contact, without a factor", "full contact") },
        Row { resumed: true, ..take("full contact, resumed", "full contact") },
        Row { iterative: true, resumed: true, ..take("without a factor, resumed", "free") },
    ]
}
