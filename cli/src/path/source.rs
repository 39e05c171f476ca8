//! The surface of a path: from a file, or generated.

use std::path::Path;

use asperity::surface::{Amplitude, SelfAffine, Topography};
use asperity::{Grid, LoadingSolver, SurfaceError};
use asperity_cli::number::quantity;
use asperity_cli::outcome::Failure;
use md5::{Digest, Md5};
use serde_json::{Value, json};

use super::options::Options;

/// Side \[m\] and nodes a side of the generated surface, its seed, and cells of its shortest wave, if not given.
const SIDE: f64 = 1e-2;
const NODES: usize = 256;
const SEED: u64 = 1;
const CELLS_OF_SHORTEST_WAVE: f64 = 8.0;

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
    let rms_height = match spectrum.amplitude() {
        Amplitude::RmsHeight(height) => Some(height),
        _ => None,
    };
    json!({
        "generator": "self-affine",
        "seed": spectrum.seed(),
        "hurst": spectrum.hurst(),
        "rolloff_wavelength": spectrum.rolloff_wavelength(),
        "short_cutoff_wavelength": spectrum.short_cutoff_wavelength(),
        "rms_height": rms_height,
    })
}

/// A surface with the spectrum of Zhang et al. (2020), Table 1, before it is made.
pub(super) struct Generated {
    pub(super) spectrum: SelfAffine,
    pub(super) grid: Grid,
}

impl Generated {
    /// Its shortest wave has so many cells that the grid resolves it, unless another one is asked for.
    pub(super) fn new(options: &Options) -> Result<Self, Failure> {
        options.reading.only_sides()?;
        let nodes = options.nodes.unwrap_or(NODES);
        let seed = options.seed.unwrap_or(SEED);
        let side = options.reading.side.unwrap_or(SIDE);
        let side_y = options.reading.side_y.unwrap_or(side);
        let failed = |error: SurfaceError| no_surface(options, nodes, error.into());
        let grid = Grid::with_sides(nodes, nodes, side, side_y).map_err(failed)?;
        let paper = SelfAffine::zhang2020(seed);
        let (cell, rolloff) = (longer_side(&grid), paper.rolloff_wavelength());
        if 2.0 * cell > rolloff {
            return Err(Failure::request(format!(
                "{nodes} nodes a side are too few for the roll-off wavelength of {}: two cells are {}",
                quantity(rolloff, "m", 5),
                quantity(2.0 * cell, "m", 5)
            )));
        }
        let resolved = CELLS_OF_SHORTEST_WAVE * cell;
        let least = paper.short_cutoff_wavelength();
        let shortest = options.short_cutoff.unwrap_or(resolved.max(least).min(rolloff));
        let spectrum = SelfAffine::new(paper.hurst(), rolloff, shortest, paper.amplitude(), seed);
        let spectrum = spectrum.map_err(failed)?;
        Ok(Self { spectrum, grid })
    }
}

/// The generated surface.
pub(super) fn generate(options: &Options) -> Result<Made, Failure> {
    let Generated { spectrum, grid } = Generated::new(options)?;
    let failed = |error| no_surface(options, grid.nx(), error);
    LoadingSolver::check_room(&grid, options.boundary(), options.memory_budget).map_err(failed)?;
    let heights = Topography::sample(&spectrum, grid).map_err(|error| failed(error.into()))?;
    let shortest = spectrum.short_cutoff_wavelength();
    let name = format!(
        "generated as an example: self-affine, Hurst exponent {}, shortest wavelength {} ({}), roll-off at {}, seed {}",
        spectrum.hurst(),
        quantity(shortest, "m", 4),
        quantity(shortest / longer_side(&grid), "cells", 4),
        quantity(spectrum.rolloff_wavelength(), "m", 4),
        spectrum.seed()
    );
    Ok((heights, name, source_of(&spectrum)))
}

/// Of a cell.
fn longer_side(grid: &Grid) -> f64 {
    grid.dx().max(grid.dy())
}

fn no_surface(options: &Options, nodes: usize, error: asperity::Error) -> Failure {
    let what = format!("cannot generate the surface on {nodes} x {nodes} nodes");
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
