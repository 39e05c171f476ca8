//! A surface of the page: from a file, or generated.

use asperity::io::{LengthUnit, MeasuredSurface, ReadOptions};
use asperity::number::quantity;
use asperity::surface::{Amplitude, Topography, Trend, Warning};
use asperity::{Boundary, Grid, SelfAffine};

use crate::fault::{Fault, of_page};
use crate::request::{Generation, Level, Reading};
use crate::room;

/// Side \[m\], nodes a side, seed, and cells of the shortest wave of a generated surface, as in the program.
const SIDE: f64 = 1e-2;
const NODES: usize = 256;
const SEED: u64 = 1;
const CELLS_OF_SHORTEST_WAVE: f64 = 8.0;

/// A surface, and what is known of where it is from.
#[derive(Debug)]
pub(crate) struct Heights {
    pub(crate) name: String,
    /// In words: the format of the file and its size, or the spectrum.
    pub(crate) source: String,
    pub(crate) notes: Vec<String>,
    pub(crate) warnings: Vec<String>,
    /// How many nodes were missing in the file.
    pub(crate) missing: usize,
    pub(crate) found: Found,
}

/// What a path can be of, and what cannot be pressed yet.
#[derive(Debug)]
pub(crate) enum Found {
    Whole(Topography),
    /// Without a size, or with nodes missing.
    Part(MeasuredSurface),
}

impl Heights {
    /// What is in a file, prepared as asked.
    pub(crate) fn read(bytes: &[u8], name: &str, reading: &Reading) -> Result<Self, Fault> {
        let mut measured = options(reading)?.read_bytes(bytes, name)?;
        let mut notes: Vec<String> = measured.notes.iter().map(|note| of_page(note)).collect();
        if !measured.understood.is_empty() {
            notes.insert(0, format!("understood: {}", of_page(&measured.understood)));
        }
        let (source, missing) = (measured.to_string(), measured.missing);
        if let Some(grid) = measured.cell.and_then(|_| measured.grid().ok()) {
            room::check(&grid, Boundary::Free)?;
        }
        let mut warnings = Vec::new();
        measured = match reading.level {
            Level::None => measured,
            Level::Plane => measured.level(Trend::Plane)?,
            Level::Quadratic => measured.level(Trend::Quadratic)?,
        };
        if missing > 0 && reading.fill {
            measured = measured.fill_missing()?;
            notes.push(format!("{missing} missing nodes are interpolated from the nodes around"));
            warnings.extend(Warning::of_filling(missing, measured.heights.len()));
        }
        let found = if measured.missing > 0 || measured.cell.is_none() {
            Found::Part(measured)
        } else {
            let grid = measured.grid()?;
            let surface = Topography::new(grid, measured.heights)?;
            let surface = if reading.invert { surface.invert() } else { surface };
            warnings.extend(Warning::of_surface(&surface));
            Found::Whole(surface)
        };
        let warnings = said(&warnings, &found);
        Ok(Self { name: name.to_string(), source, notes, warnings, missing, found })
    }

    /// A self-affine surface; what is not given is that of the program's example.
    pub(crate) fn generate(asked: &Generation) -> Result<Self, Fault> {
        let nodes = asked.nodes.unwrap_or(NODES);
        let side = asked.side.unwrap_or(SIDE);
        let grid = Grid::with_sides(nodes, nodes, side, side)?;
        room::check(&grid, Boundary::Free)?;
        let spectrum = spectrum(asked, &grid)?;
        let surface = Topography::sample(&spectrum, grid)?;
        let warnings = Warning::of_surface(&surface);
        let found = Found::Whole(surface);
        Ok(Self {
            name: format!("generated, seed {}", spectrum.seed()),
            source: format!(
                "self-affine: Hurst exponent {}, shortest wavelength {}, roll-off at {}",
                spectrum.hurst(),
                quantity(spectrum.short_cutoff_wavelength(), "m", 4),
                quantity(spectrum.rolloff_wavelength(), "m", 4)
            ),
            notes: Vec::new(),
            warnings: said(&warnings, &found),
            missing: 0,
            found,
        })
    }

    /// The surface, if it can be pressed.
    pub(crate) fn surface(&self) -> Result<&Topography, Fault> {
        match &self.found {
            Found::Whole(surface) => Ok(surface),
            Found::Part(measured) if measured.cell.is_none() => {
                Err(Fault::new("how large is the surface? Give its side along x"))
            }
            Found::Part(MeasuredSurface { missing: 1, .. }) => {
                Err(Fault::new("1 node is missing: let it be filled"))
            }
            Found::Part(measured) => Err(Fault::new(format!(
                "{} nodes are missing: let them be filled",
                measured.missing
            ))),
        }
    }

    /// Heights in levels from 1 to 255, 0 where a node is missing.
    pub(crate) fn picture(&self) -> Vec<u8> {
        let heights = match &self.found {
            Found::Whole(surface) => surface.heights(),
            Found::Part(measured) => &measured.heights,
        };
        let known = || heights.iter().copied().filter(|height| height.is_finite());
        let (least, most) = (known().fold(f64::MAX, f64::min), known().fold(f64::MIN, f64::max));
        let range = if most > least { most - least } else { 1.0 };
        let level = |height: &f64| match height.is_finite() {
            true => (1.0 + (height - least) / range * 254.0) as u8,
            false => 0,
        };
        heights.iter().map(level).collect()
    }
}

/// What looks wrong, with what there may be no room for.
fn said(warnings: &[Warning], found: &Found) -> Vec<String> {
    let room = match found {
        Found::Whole(surface) => room::warning(surface.grid(), Boundary::Free),
        Found::Part(_) => None,
    };
    warnings.iter().map(|warning| of_page(&warning.to_string())).chain(room).collect()
}

/// What is asked of the reader.
fn options(reading: &Reading) -> Result<ReadOptions, Fault> {
    let unit = |text: &Option<String>| {
        let unit = text.as_ref().map(|text| text.parse::<LengthUnit>());
        unit.transpose().map_err(Fault::from)
    };
    let mut options = ReadOptions::new();
    if let Some(side) = reading.side {
        options = options.side(side);
    }
    if let Some(side) = reading.side_y {
        options = options.side_y(side);
    }
    if let Some(unit) = unit(&reading.height_unit)? {
        options = options.height_unit(unit);
    }
    if let Some(unit) = unit(&reading.lateral_unit)? {
        options = options.lateral_unit(unit);
    }
    if let Some(name) = &reading.channel {
        options = options.channel(name);
    }
    if let Some(layout) = &reading.layout {
        options = options.layout(layout.parse().map_err(Fault::from)?);
    }
    if reading.rows_are_y {
        options = options.rows_are_y();
    }
    if reading.ignore_mask {
        options = options.ignore_mask();
    }
    Ok(options)
}

/// Its shortest wave has so many cells that the grid resolves it, unless another one is asked for.
fn spectrum(asked: &Generation, grid: &Grid) -> Result<SelfAffine, Fault> {
    let seed = asked.seed.unwrap_or(SEED);
    let paper = SelfAffine::zhang2020(seed);
    let rolloff = asked.rolloff.unwrap_or(paper.rolloff_wavelength());
    let cell = grid.dx();
    if 2.0 * cell > rolloff {
        return Err(Fault::new(format!(
            "{} nodes a side are too few for the roll-off wavelength of {}: two cells are {}",
            grid.nx(),
            quantity(rolloff, "m", 4),
            quantity(2.0 * cell, "m", 4)
        )));
    }
    let least = match asked.rolloff {
        Some(_) => 0.0,
        None => paper.short_cutoff_wavelength(),
    };
    let resolved = (CELLS_OF_SHORTEST_WAVE * cell).max(least).min(rolloff);
    let shortest = asked.short_cutoff.unwrap_or(resolved);
    let amplitude = match (asked.rms_height, asked.rms_gradient) {
        (Some(height), _) => Amplitude::RmsHeight(height),
        (None, Some(gradient)) => Amplitude::RmsGradient(gradient),
        (None, None) => paper.amplitude(),
    };
    let hurst = asked.hurst.unwrap_or(paper.hurst());
    Ok(SelfAffine::new(hurst, rolloff, shortest, amplitude, seed)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fault::Kind;

    const TEXT: &str = "3 1 4 1\n5 9 nan 6\n5 3 5 12\n";

    /// The page asks for the layout, the unit, the side and the missing nodes, one after the other.
    #[test]
    fn a_text_is_read_by_questions() -> Result<(), Fault> {
        let read = |reading: &Reading| Heights::read(TEXT.as_bytes(), "a.txt", reading);
        let mut reading = Reading::default();
        assert_eq!(read(&reading).err().map(|fault| fault.kind), Some(Kind::Layout));
        reading.layout = Some("matrix".to_string());
        assert_eq!(read(&reading).err().map(|fault| fault.kind), Some(Kind::HeightUnit));
        reading.height_unit = Some("µm".to_string());
        let sizeless = read(&reading)?;
        assert!(sizeless.surface().is_err_and(|fault| fault.message.contains("how large")));
        assert_eq!(sizeless.picture()[6], 0);
        assert_eq!([sizeless.picture()[1], sizeless.picture()[11]], [1, 255]);
        reading.side = Some(4e-3);
        let holed = read(&reading)?;
        assert!(holed.surface().is_err_and(|fault| fault.message.starts_with("1 node is missing")));
        reading.fill = true;
        let whole = read(&reading)?;
        let surface = whole.surface()?;
        assert_eq!(surface.grid().shape(), (4, 3));
        assert_eq!(surface.heights()[(3, 2)], 12e-6);
        reading.invert = true;
        assert!(read(&reading)?.surface()?.heights()[(3, 2)] < 0.0);
        reading.height_unit = Some("parsec".to_string());
        assert!(read(&reading).is_err());
        Ok(())
    }

    #[test]
    fn too_few_nodes_are_refused() -> Result<(), Fault> {
        let made = Heights::generate(&Generation { nodes: Some(64), ..Generation::default() })?;
        assert_eq!(made.surface()?.grid().shape(), (64, 64));
        for nodes in [0, 4, 100_000] {
            let asked = Generation { nodes: Some(nodes), ..Generation::default() };
            assert!(Heights::generate(&asked).is_err(), "{nodes}");
        }
        Ok(())
    }
}
