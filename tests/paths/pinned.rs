//! Small paths of every kind, pinned: who changes how events are found sees here whether the paths are still the same.
//!
//! Of a path with a factor every bit of every state is pinned. Without a factor the order of events is, and columns are
//! compared with those of the factor, within what states say of their error. Windows, solutions inside them and
//! convolutions may change by a fiftieth there, and by two; with a factor not at all.
//!
//! To print the table of the present code:
//!
//! ```text
//! ASPERITY_PINS=print cargo test --release --test paths -- pinned --nocapture
//! ```
//!
//! With `ASPERITY_PINS=bits` the bits of paths without a factor are compared as well: for changes that should not touch
//! any.
//!
//! The table changes only together with results that are meant to change, and the commit says why: better estimates,
//! another rule for ties, fewer windows. Where the last digits change, it says what is computed in another order, and
//! the drivers have run. A change that only moves code leaves the table as it is.
//!
//! Bits are those of x86-64, and are compared there only: matrix products sum in the order of the registers of a
//! processor, with AVX-512 and with AVX2 to the same numbers on all of these paths. Elsewhere the order of events is
//! compared, and counts as without a factor.

use asperity::kernel::{Base, Layer, Layered, LayeredBody};
use asperity::loading::{History, LoadingBuilder};
use asperity::record::LoadingRecord;
use asperity::surface::{Amplitude, HeightMap, SelfAffine};
use asperity::updater::{ConjugateGradient, Handover, LinearUpdater, RecursiveCholesky};
use asperity::{ContactEvent, Grid, InfluenceKernel, LoadingSolver, LoadingState, Surface};
use asperity_testing::surfaces::self_affine;
use nalgebra::DMatrix;

use crate::without_factor::half_spaces;

/// What is pinned of a path.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Pin {
    name: String,
    is_exact: bool,
    states: usize,
    /// Hashes: of the events in their order, and of the bits of all columns.
    order: u64,
    bits: u64,
    /// Windows, events taken back, solutions in windows, and convolutions.
    counts: [usize; 4],
}

impl std::fmt::Display for Pin {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { name, states, order, bits, counts, .. } = self;
        write!(f, "    ({name:?}, {states}, {order:#018x}, {bits:#018x}, {counts:?}),")
    }
}

/// FNV-1a.
struct Hash(u64);

impl Hash {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn add(&mut self, number: u64) {
        for byte in number.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}

fn order(states: &[LoadingState]) -> u64 {
    let mut hash = Hash::new();
    for LoadingState { step, event, node: (ix, iy), contact, .. } in states {
        let kind = match event {
            ContactEvent::Touch => 0,
            ContactEvent::Release => 1,
            _ => 2,
        };
        [*step as u64, kind, *ix as u64, *iy as u64, contact.contact_nodes as u64]
            .into_iter()
            .for_each(|number| hash.add(number));
    }
    hash.0
}

/// All columns of a state.
fn columns(state: &LoadingState) -> Vec<f64> {
    let contact = &state.contact;
    let mut columns = vec![
        contact.approach,
        contact.load,
        contact.energy,
        contact.mean_gap,
        contact.contact_stiffness.unwrap_or(f64::NAN),
        contact.interfacial_stiffness.unwrap_or(f64::NAN),
        state.approach_error,
    ];
    if let Some(plastic) = contact.plastic {
        columns.extend([plastic.volume, plastic.work, plastic.volume_per_load]);
    }
    columns
}

fn bits(states: &[LoadingState]) -> u64 {
    let mut hash = Hash::new();
    states.iter().flat_map(columns).for_each(|value| hash.add(value.to_bits()));
    hash.0
}

/// A path to be pinned.
struct Case {
    name: String,
    surface: HeightMap,
    kernel: Box<dyn InfluenceKernel>,
    hardness: Option<f64>,
}

impl Case {
    fn builder<U: LinearUpdater + Clone>(&self, updater: U) -> LoadingBuilder<'_, U> {
        let mut builder = LoadingSolver::builder(&self.surface, &*self.kernel).updater(updater);
        if let Some(hardness) = self.hardness {
            builder = builder.hardness(hardness);
        }
        builder
    }
}

fn cases() -> Vec<Case> {
    let unit = Grid::square(24, 1.0).unwrap();
    let mut cases = Vec::new();
    let mut add = |name: String, surface: &HeightMap, kernel, hardness| {
        cases.push(Case { name, surface: surface.clone(), kernel, hardness });
    };
    let surface = self_affine(&unit, 0.8, 1e-2, 5);
    for (hardness, kind) in [(None, "elastic"), (Some(0.05), "hard")] {
        for (name, kernel) in half_spaces(unit) {
            add(format!("{name}, {kind}"), &surface, kernel, hardness);
        }
    }
    // On which nodes leave the contact.
    let grid = Grid::square(24, 24.0).unwrap();
    let coat = Layer { youngs_modulus: 10.0, poissons_ratio: 0.3, thickness: 1.0 };
    let body =
        LayeredBody::new(&[coat], Base::HalfSpace { youngs_modulus: 1.0, poissons_ratio: 0.3 })
            .unwrap();
    let kernel = Layered::free(grid, body).unwrap();
    let surface = SelfAffine::new(0.8, 12.0, 2.0, Amplitude::RmsHeight(1.0), 1).unwrap();
    let surface = HeightMap::sample(&surface, &grid).unwrap();
    add("stiff coat".into(), &surface, Box::new(kernel), None);
    // Nodes that touch or yield together.
    let tile = Grid::square(10, 10.0).unwrap();
    let heights = SelfAffine::new(0.8, 10.0, 3.0, Amplitude::RmsHeight(0.1), 7).unwrap();
    let heights = heights.heights(&tile).unwrap();
    let tiled = DMatrix::from_fn(20, 20, |ix, iy| heights[(ix % 10, iy % 10)]);
    let [_, (_, kernel), _] = half_spaces(Grid::square(20, 20.0).unwrap());
    add("tiles".into(), &HeightMap::new(tiled).unwrap(), kernel, None);
    let small = Grid::square(16, 1.0).unwrap();
    let plateau = |ix: usize, iy: usize| if (5..11).contains(&ix) && iy > 3 { 1e-2 } else { 0.0 };
    let plateau = HeightMap::new(DMatrix::from_fn(16, 16, plateau)).unwrap();
    for (hardness, name) in [(None, "plateau"), (Some(0.03), "hard plateau")] {
        let [(_, kernel), ..] = half_spaces(small);
        add(name.into(), &plateau, kernel, hardness);
    }
    // Where the nearest nodes do not say what a distant one does.
    let strip = Grid::new(120, 3, 1.0, 1.0).unwrap();
    let [.., (_, kernel)] = half_spaces(strip);
    let square = self_affine(&Grid::square(120, 120.0).unwrap(), 0.8, 0.5, 1);
    let heights = square.heights(&Grid::square(120, 120.0).unwrap()).unwrap();
    let surface = HeightMap::new(heights.columns(0, 3).into_owned()).unwrap();
    add("strip".into(), &surface, kernel, None);
    cases
}

/// Follows a path to its end, interrupted and resumed behind some states if that is asked for.
fn followed<U: LinearUpdater + Clone>(
    name: String,
    builder: &LoadingBuilder<'_, U>,
    interrupted: Option<usize>,
) -> (Pin, Vec<LoadingState>) {
    let mut path = builder.clone().build().unwrap();
    let mut states: Vec<LoadingState> = Vec::new();
    if let Some(at) = interrupted {
        let history: History = path.by_ref().take(at).collect::<Result<_, _>>().unwrap();
        let record = LoadingRecord::new(&path, history).unwrap();
        states.extend(record.history().events());
        path = builder.clone().resume(record.history()).unwrap();
    }
    states.extend(path.by_ref().map(Result::unwrap));
    // Its numbers follow from each other, as a record checks.
    LoadingRecord::new(&path, states.iter().copied().collect()).unwrap();
    let timings = path.timings();
    let convolutions = path.convolutions();
    let pin = Pin {
        name,
        is_exact: convolutions.is_none(),
        states: states.len(),
        order: order(&states),
        bits: bits(&states),
        counts: [
            timings.windows,
            timings.taken_back,
            timings.ties,
            convolutions.unwrap_or_default(),
        ],
    };
    (pin, states)
}

/// Columns within what states say of their error. That is an estimate and no bound: approaches are off by 2.3 times as
/// much at worst where nodes yield, and on strips by 5. Other columns within what `without_factor`, `strips` and
/// `hardness_without_factor` measured.
fn compare(name: &str, found: &[LoadingState], exact: &[LoadingState]) {
    assert_eq!(found.len(), exact.len(), "{name}");
    let (first, last) = (exact[0].contact, exact.last().unwrap().contact);
    for (a, b) in found.iter().zip(exact) {
        // Of both solutions, 10⁻¹⁰ of the approach in the gauge of the kernel.
        let tie = 1e-8 * last.approach.max(first.mean_gap);
        let error = (a.contact.approach - b.contact.approach).abs();
        assert!(error <= 5.0 * a.approach_error + tie, "{name}: {error:e} {a:?} {b:?}");
        let load = (a.contact.load - b.contact.load).abs();
        assert!(load <= 1e-3 * b.contact.load + 1e-6 * last.load, "{name}: {a:?} {b:?}");
        let gap = (a.contact.mean_gap - b.contact.mean_gap).abs();
        assert!(gap <= 2e-5 * first.mean_gap + tie, "{name}: {a:?} {b:?}");
    }
}

fn pins() -> Vec<Pin> {
    let mut pins = Vec::new();
    for case in cases() {
        let name = &case.name;
        let with = case.builder(RecursiveCholesky::new());
        let (pin, exact) = followed(format!("{name}, factor"), &with, None);
        pins.push(pin);
        let without = case.builder(ConjugateGradient::new());
        let (pin, found) = followed(format!("{name}, iterations"), &without, None);
        pins.push(pin);
        compare(name, &found, &exact);
        if name.starts_with("periodic") {
            let at = Some(exact.len() / 3);
            pins.push(followed(format!("{name}, factor, resumed"), &with, at).0);
            pins.push(followed(format!("{name}, iterations, resumed"), &without, at).0);
        }
        if name == "free, elastic" {
            let fixed = case.builder(Handover::new()).build().unwrap().bytes();
            let handing_over = case.builder(Handover::new()).memory_budget(fixed + 1_500_000);
            let (pin, found) = followed(format!("{name}, handed over"), &handing_over, None);
            pins.push(pin);
            compare("handed over", &found, &exact);
        }
    }
    pins
}

#[test]
fn small_paths_are_pinned() {
    let mode = std::env::var("ASPERITY_PINS").unwrap_or_default();
    let found = pins();
    if mode == "print" {
        found.iter().for_each(|pin| println!("{pin}"));
        return;
    }
    assert_eq!(found.len(), TABLE.len());
    let mut changed = Vec::new();
    for (pin, &(name, states, order, bits, counts)) in found.iter().zip(TABLE) {
        assert_eq!(pin.name, name);
        let near = |(a, b): (&usize, &usize)| a.abs_diff(*b) <= 2 + b / 50;
        let with_bits = cfg!(target_arch = "x86_64") && (pin.is_exact || mode == "bits");
        let is_same = (pin.states, pin.order) == (states, order)
            && pin.counts.iter().zip(&counts).all(near)
            && (!with_bits || (pin.counts, pin.bits) == (counts, bits));
        if !is_same {
            changed.push(pin.to_string());
        }
    }
    assert!(changed.is_empty(), "these have changed:\n{}", changed.join("\n"));
}

/// Name, states, hashes of the events in their order and of the bits of all columns; windows, events taken back,
/// solutions in windows, and convolutions of iterations.
type Row = (&'static str, usize, u64, u64, [usize; 4]);

#[rustfmt::skip]
const TABLE: &[Row] = &[
    ("free, elastic, factor", 576, 0xed6c9a4a80b83825, 0xdc43d9bce8421d4f, [10, 0, 0, 0]),
    ("free, elastic, iterations", 576, 0xed6c9a4a80b83825, 0xd6272aeb4807db06, [25, 0, 6, 254]),
    ("free, elastic, handed over", 576, 0xed6c9a4a80b83825, 0x733b238982819491, [15, 0, 3, 182]),
    ("periodic, elastic, factor", 576, 0x9ec1efeb436aaaa5, 0x506a9dfa5cb84018, [10, 0, 0, 0]),
    ("periodic, elastic, iterations", 576, 0x9ec1efeb436aaaa5, 0xf4f34dcded77dcf2, [25, 0, 1, 179]),
    ("periodic, elastic, factor, resumed", 576, 0x9ec1efeb436aaaa5, 0x506a9dfa5cb84018, [5, 0, 0, 0]),
    ("periodic, elastic, iterations, resumed", 576, 0x9ec1efeb436aaaa5, 0xf4f34dcded77dcf2, [9, 0, 0, 104]),
    ("spectral, elastic, factor", 576, 0x840ed9de6223d6d9, 0xd72172829085545b, [10, 0, 0, 0]),
    ("spectral, elastic, iterations", 576, 0x840ed9de6223d6d9, 0x2ee18aeaba353e97, [24, 0, 3, 186]),
    ("free, hard, factor", 1152, 0x49641b45ffbb60d6, 0x24c2c859d7bbd1c8, [17, 161, 0, 0]),
    ("free, hard, iterations", 1152, 0x49641b45ffbb60d6, 0x2e71ac26690e8071, [118, 1, 28, 785]),
    ("periodic, hard, factor", 1152, 0x36cc7e5d5d717180, 0x2584d3a866090f71, [17, 124, 0, 0]),
    ("periodic, hard, iterations", 1152, 0x36cc7e5d5d717180, 0x881e85bc724fc7b3, [109, 1, 33, 644]),
    ("periodic, hard, factor, resumed", 1152, 0x36cc7e5d5d717180, 0x2584d3a866090f71, [11, 106, 0, 0]),
    ("periodic, hard, iterations, resumed", 1152, 0x36cc7e5d5d717180, 0x881e85bc724fc7b3, [68, 1, 20, 410]),
    ("spectral, hard, factor", 1152, 0xe03930f9a28adde2, 0x6ce4e3c26b0c0302, [18, 199, 0, 0]),
    ("spectral, hard, iterations", 1152, 0xe03930f9a28adde2, 0x36dfac96b9c0cd08, [110, 5, 30, 660]),
    ("stiff coat, factor", 532, 0xa2cb8f13158c16ae, 0x1ddf124d7c774fbc, [27, 440, 0, 0]),
    ("stiff coat, iterations", 532, 0xa2cb8f13158c16ae, 0x150d94a226f54c0c, [51, 0, 0, 2451]),
    ("tiles, factor", 400, 0xbc5c3a8f86689941, 0x74da2c26cf05e71f, [8, 0, 0, 0]),
    ("tiles, iterations", 400, 0xbc5c3a8f86689941, 0x66b183ea032e4e8c, [17, 0, 3, 113]),
    ("plateau, factor", 256, 0x86afd4d90931829d, 0xdf4c045ad8ffa6f7, [6, 0, 0, 0]),
    ("plateau, iterations", 256, 0x86afd4d90931829d, 0xf3f7ea87888afcbc, [10, 0, 9, 98]),
    ("hard plateau, factor", 512, 0xf82522ac9cc8343c, 0xd76a26334b45ff0b, [11, 66, 0, 0]),
    ("hard plateau, iterations", 512, 0xf82522ac9cc8343c, 0xa1e6ab9aa89473fd, [31, 1, 15, 234]),
    ("strip, factor", 360, 0xe315699cffbb1351, 0xb1bbf3c98b94b715, [9, 0, 0, 0]),
    ("strip, iterations", 360, 0xe315699cffbb1351, 0xb9b25b35a854ea20, [22, 0, 4, 142]),
];
