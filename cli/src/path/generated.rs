//! A generated surface.

use asperity::surface::{Amplitude, SelfAffine, Topography};
use asperity::{Grid, LoadingSolver, SurfaceError};
use asperity_cli::number::{counted, plain, quantity};
use asperity_cli::outcome::Failure;
use serde_json::{Value, json};

use super::options::Options;
use super::source::Made;

/// Side \[m\] and nodes a side of the generated surface, its seed, and cells of its shortest wave, if not given.
const SIDE: f64 = 1e-2;
const NODES: usize = 256;
const SEED: u64 = 1;
const CELLS_OF_SHORTEST_WAVE: f64 = 8.0;

/// A surface before it is made.
pub(super) struct Generated {
    spectrum: SelfAffine,
    pub(super) grid: Grid,
    /// How many times as long waves are along x.
    stretch: f64,
    is_example: bool,
}

impl Generated {
    /// Its shortest wave has so many cells that the grid resolves it, unless another one is asked for.
    pub(super) fn new(options: &Options) -> Result<Self, Failure> {
        options.reading.only_sides()?;
        let roughness = &options.roughness;
        let nodes = roughness.nodes.unwrap_or(NODES);
        let seed = roughness.seed.unwrap_or(SEED);
        let stretch = roughness.anisotropy.unwrap_or(1.0);
        let side = options.reading.side.unwrap_or(SIDE);
        let side_y = options.reading.side_y.unwrap_or(side);
        let failed = |error: SurfaceError| no_surface(options, nodes, error.into());
        let grid = Grid::with_sides(nodes, nodes, side, side_y).map_err(failed)?;
        let squeezed = squeezed(&grid, stretch).map_err(failed)?;
        let paper = SelfAffine::zhang2020(seed);
        let cell = squeezed.dx().max(squeezed.dy());
        let rolloff = roughness.rolloff.unwrap_or(paper.rolloff_wavelength());
        if 2.0 * cell > rolloff {
            return Err(Failure::request(format!(
                "{} a side of {} cannot carry the roll-off wavelength of {}: two cells are {}",
                counted(nodes, "node"),
                quantity(side.max(side_y), "m", 5),
                quantity(rolloff, "m", 5),
                quantity(2.0 * cell, "m", 5)
            )));
        }
        let least = match roughness.rolloff {
            Some(_) => 0.0,
            None => paper.short_cutoff_wavelength(),
        };
        let resolved = (CELLS_OF_SHORTEST_WAVE * cell).max(least).min(rolloff);
        let shortest = roughness.short_cutoff.unwrap_or(resolved);
        let hurst = roughness.hurst.unwrap_or(paper.hurst());
        let amplitude = roughness.amplitude(paper.amplitude());
        let spectrum = SelfAffine::new(hurst, rolloff, shortest, amplitude, seed);
        let spectrum = spectrum.map_err(failed)?;
        Ok(Self { spectrum, grid, stretch, is_example: roughness.is_example() })
    }

    /// What it is from.
    pub(super) fn source(&self) -> Value {
        let (rms_height, rms_gradient) = match self.spectrum.amplitude() {
            Amplitude::RmsHeight(height) => (Some(height), None),
            Amplitude::RmsGradient(gradient) => (None, Some(gradient)),
            _ => (None, None),
        };
        json!({
            "generator": "self-affine",
            "seed": self.spectrum.seed(),
            "hurst": self.spectrum.hurst(),
            "rolloff_wavelength": self.spectrum.rolloff_wavelength(),
            "short_cutoff_wavelength": self.spectrum.short_cutoff_wavelength(),
            "rms_height": rms_height,
            "rms_gradient": rms_gradient,
            "anisotropy": self.stretch,
        })
    }

    /// The surface, from that on the squeezed grid.
    fn stretched(&self, isotropic: Topography) -> Result<Topography, SurfaceError> {
        let heights = isotropic.map().matrix();
        let surface = Topography::new(self.grid, heights.clone())?;
        match self.spectrum.amplitude() {
            // Less steep along x now, by how much depends on the waves that there are.
            Amplitude::RmsGradient(gradient) if self.stretch != 1.0 => {
                let factor = gradient / surface.rms_gradient_spectral();
                Topography::new(self.grid, heights * factor)
            }
            _ => Ok(surface),
        }
    }

    /// In words.
    fn name(&self) -> Result<String, SurfaceError> {
        let spectrum = &self.spectrum;
        let squeezed = squeezed(&self.grid, self.stretch)?;
        let shortest = spectrum.short_cutoff_wavelength();
        let cells = shortest / squeezed.dx().max(squeezed.dy());
        let stretched = match self.stretch {
            1.0 => String::new(),
            ratio => format!(" along y, waves {ratio} times as long along x"),
        };
        Ok(format!(
            "generated{}: self-affine, Hurst exponent {}, shortest wavelength {} ({}), roll-off at {}{stretched}, seed {}",
            if self.is_example { " as an example" } else { "" },
            spectrum.hurst(),
            quantity(shortest, "m", 4),
            plain(cells, 4) + " cells",
            quantity(spectrum.rolloff_wavelength(), "m", 4),
            spectrum.seed()
        ))
    }
}

/// The generated surface.
pub(super) fn generate(options: &Options) -> Result<Made, Failure> {
    let generated = Generated::new(options)?;
    let grid = generated.grid;
    let failed = |error| no_surface(options, grid.nx(), error);
    LoadingSolver::check_room(&grid, options.boundary(), options.memory_budget).map_err(failed)?;
    let made = squeezed(&grid, generated.stretch).and_then(|squeezed| {
        let isotropic = Topography::sample(&generated.spectrum, squeezed)?;
        Ok((generated.stretched(isotropic)?, generated.name()?))
    });
    let (heights, name) = made.map_err(|error: SurfaceError| failed(error.into()))?;
    Ok((heights, name, generated.source()))
}

/// The grid on which waves are as long along x as along y.
fn squeezed(grid: &Grid, stretch: f64) -> Result<Grid, SurfaceError> {
    let (lx, ly) = grid.sides();
    Grid::with_sides(grid.nx(), grid.ny(), lx / stretch, ly)
}

fn no_surface(options: &Options, nodes: usize, error: asperity::Error) -> Failure {
    let what = format!("cannot generate the surface on {nodes} x {nodes} nodes");
    options.no_room(what, error)
}
