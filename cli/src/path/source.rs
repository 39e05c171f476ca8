//! The surface of a path: from a file, or generated.

use std::path::Path;

use asperity::surface::{Amplitude, SelfAffine, Topography};
use asperity::{Grid, LoadingSolver};
use asperity_cli::number::quantity;
use asperity_cli::outcome::Failure;
use md5::{Digest, Md5};
use serde_json::{Value, json};

use super::options::Options;

/// Side \[m\] and nodes a side of the generated surface, and its seed, if not given.
const SIDE: f64 = 1e-2;
const NODES: usize = 256;
const SEED: u64 = 1;
/// Root mean square height of Table 1 \[m\].
const RMS_HEIGHT: f64 = 50e-6;

/// A surface, its name, and what it is from.
pub(super) type Made = (Topography, String, Value);

/// The surface of a file.
pub(super) fn read(file: &Path, options: &Options) -> Result<Made, Failure> {
    let surface = options.reading.surface(file)?;
    let name = file.display().to_string();
    let source = json!({
        "file": name,
        "heights_md5": fingerprint(&surface),
        "reading": options.reading.given(),
    });
    Ok((surface, name, source))
}

/// What a generated surface is from.
pub(super) fn source_of(spectrum: &SelfAffine) -> Value {
    json!({
        "generator": "self-affine",
        "seed": spectrum.seed(),
        "hurst": spectrum.hurst(),
        "rolloff_wavelength": spectrum.rolloff_wavelength(),
        "short_cutoff_wavelength": spectrum.short_cutoff_wavelength(),
        "rms_height": RMS_HEIGHT,
    })
}

/// The surface of the paper's Table 1, before it is made.
pub(super) struct Generated {
    pub(super) spectrum: SelfAffine,
    pub(super) grid: Grid,
}

impl Generated {
    /// With its short cut-off moved to two cells if the grid cannot carry it.
    pub(super) fn new(options: &Options) -> Result<Self, Failure> {
        options
            .reading
            .only_sides("a generated surface: --surface names a file")?;
        let nodes = options.nodes.unwrap_or(NODES);
        let seed = options.seed.unwrap_or(SEED);
        let side = options.reading.side.unwrap_or(SIDE);
        let side_y = options.reading.side_y.unwrap_or(side);
        let failed = |error| no_surface(options, nodes, error);
        let grid = Grid::with_sides(nodes, nodes, side, side_y).map_err(failed)?;
        let paper = SelfAffine::zhang2020(seed);
        let two_cells = 2.0 * grid.dx().max(grid.dy());
        if two_cells > paper.rolloff_wavelength() {
            return Err(Failure::request(format!(
                "{nodes} nodes a side are too few for the roll-off wavelength of {}: two cells are {}",
                quantity(paper.rolloff_wavelength(), "m", 5),
                quantity(two_cells, "m", 5)
            )));
        }
        if two_cells <= paper.short_cutoff_wavelength() * (1.0 + 1e-9) {
            let spectrum = paper;
            return Ok(Self { spectrum, grid });
        }
        let amplitude = Amplitude::RmsHeight(RMS_HEIGHT);
        let rolloff = paper.rolloff_wavelength();
        let spectrum = SelfAffine::new(paper.hurst(), rolloff, two_cells, amplitude, seed);
        let spectrum = spectrum.map_err(failed)?;
        Ok(Self { spectrum, grid })
    }
}

pub(super) fn generate(options: &Options) -> Result<Made, Failure> {
    let Generated { spectrum, grid } = Generated::new(options)?;
    let (nodes, seed) = (grid.nx(), spectrum.seed());
    let failed = |error| no_surface(options, nodes, error);
    LoadingSolver::check_room(&grid, options.boundary(), options.memory_budget).map_err(failed)?;
    let wanted = SelfAffine::zhang2020(seed).short_cutoff_wavelength();
    if spectrum.short_cutoff_wavelength() > wanted {
        eprintln!(
            "note: {nodes} nodes a side cannot carry the short cut-off wavelength of {}; \
             it is {}, two cells, instead",
            quantity(wanted, "m", 5),
            quantity(spectrum.short_cutoff_wavelength(), "m", 5)
        );
    }
    let heights = Topography::sample(&spectrum, grid).map_err(failed)?;
    let name = format!("self-affine, Table 1 of Zhang et al. (2020), seed {seed}");
    Ok((heights, name, source_of(&spectrum)))
}

fn no_surface(options: &Options, nodes: usize, error: asperity::Error) -> Failure {
    let what = format!("cannot put the surface on {nodes} x {nodes} nodes");
    options.no_room(what, error)
}

/// MD5 of the heights as they are pressed, in 64 bits each, x fast.
pub(super) fn fingerprint(surface: &Topography) -> String {
    let mut hash = Md5::new();
    for height in surface.map().matrix() {
        hash.update(height.to_le_bytes());
    }
    let digits = hash.finalize();
    digits.iter().map(|byte| format!("{byte:02x}")).collect()
}
