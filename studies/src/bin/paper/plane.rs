//! Plane contacts by a kernel in three dimensions.
//!
//! Nothing changes along y, so a single row of cells is enough, each a bar that reaches across the
//! whole strip. The free half-space needs the strip to be long: on its middle line a bar of length ℓ
//! acts like an infinite one, apart from a constant and an error of the order (x/ℓ)². The periodic
//! half-space with one cell along y is plane without any error.

use asperity::loading::{History, LoadingBuilder};
use asperity::reference::{HertzLine, Westergaard};
use asperity::surface::{Axis, Cylinder, Wave};
use asperity::{Boussinesq, Error, Grid, LoadingSolver, PeriodicBoussinesq};

/// Half the domain; x of the paper goes from −1 to 1 over the contact or the wavelength.
const HALF_DOMAIN: f64 = 5.0;
/// Radius of the cylinder: only the parabola counts, and the problem is linear.
const RADIUS: f64 = 10.0;
const WAVELENGTH: f64 = 2.0;
const AMPLITUDE: f64 = 0.01;
/// Length of the strip over the width of the domain.
pub(crate) const LENGTH: f64 = 1000.0;
/// Number of loads over which errors are averaged: the error of a single state depends on where in a
/// cell the edge of contact lies.
const SAMPLES: usize = 20;
/// The contact at these loads is from 0.9 to 1.1 times as wide as that of the case.
const WIDTHS: (f64, f64) = (0.9, 1.1);
/// The fraction of the half-width that counts as inner, away from the edge of contact.
const INNER: f64 = 0.6;

/// A case of Fig. 3.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Case {
    /// Eq. (20), on the free half-space.
    Cylinder,
    /// Eq. (22), one wave on the periodic half-space: half-width of the contact over the wavelength.
    Wave(f64),
    /// Eq. (22), the middle one of some waves on the free half-space: the half-width, and their number.
    FreeWaves(f64, usize),
}

/// Pressure along x: (x, computed, closed form), pressures over p₀ or p*.
pub(crate) type Profile = Vec<(f64, f64, f64)>;

/// Errors of the pressure over p₀ or p*.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct PlaneError {
    /// Greatest on the inner part of the contact.
    pub(crate) inner: f64,
    /// Root mean square over the contact.
    pub(crate) rms: f64,
}

impl Case {
    pub(crate) fn name(self) -> String {
        let width = |a: f64| match a {
            0.5 => "full",
            0.25 => "half",
            _ => "quarter",
        };
        match self {
            Self::Cylinder => "cylinder".to_string(),
            Self::Wave(a) => format!("wave, {} contact", width(a)),
            Self::FreeWaves(a, count) => format!("{count} free waves, {} contact", width(a)),
        }
    }

    /// Pressure with `nodes` cells over the contact of the cylinder or a wavelength, with the strip
    /// `length` times as long as the domain is wide.
    pub(crate) fn profile(self, nodes: usize, length: f64) -> Result<Profile, Error> {
        let mut profiles = self.profiles(nodes, length, &[1.0])?;
        Ok(profiles.pop().unwrap_or_default())
    }

    /// Errors, averaged over loads around the case's own; full contact is a single load.
    pub(crate) fn error(self, nodes: usize, length: f64) -> Result<PlaneError, Error> {
        let full = matches!(self, Self::Wave(0.5) | Self::FreeWaves(0.5, _));
        let widths: Vec<f64> = if full {
            vec![1.0]
        } else {
            let step = (WIDTHS.1 - WIDTHS.0) / SAMPLES as f64;
            (0..SAMPLES).map(|k| WIDTHS.0 + (k as f64 + 0.5) * step).collect()
        };
        let profiles = self.profiles(nodes, length, &widths)?;
        let mut mean = PlaneError::default();
        for (profile, width) in profiles.iter().zip(&widths) {
            let inner = INNER * width * self.half_width();
            let mut squares = (0.0, 0.0);
            let mut worst = 0.0_f64;
            for (x, computed, exact) in profile {
                let error = (computed - exact).abs();
                if x.abs() < inner {
                    worst = worst.max(error);
                }
                if *computed > 0.0 || *exact > 0.0 {
                    squares = (squares.0 + error * error, squares.1 + 1.0);
                }
            }
            mean.inner += worst / widths.len() as f64;
            mean.rms += (squares.0 / squares.1).sqrt() / widths.len() as f64;
        }
        Ok(mean)
    }

    /// Half the width of the contact in the units of x.
    fn half_width(self) -> f64 {
        match self {
            Self::Cylinder => 1.0,
            Self::Wave(a) | Self::FreeWaves(a, _) => a * WAVELENGTH,
        }
    }

    /// Profiles for several widths of the contact, as multiples of the case's own.
    fn profiles(self, nodes: usize, length: f64, widths: &[f64]) -> Result<Vec<Profile>, Error> {
        let cell = 2.0 / nodes as f64;
        match self {
            Self::Cylinder => {
                let hertz = HertzLine::new(RADIUS, 1.0)?;
                let ly = length * 2.0 * HALF_DOMAIN;
                let grid = Grid::new(5 * nodes, 1, cell, ly)?;
                let cylinder = Cylinder::new(RADIUS, Axis::Y)?;
                let kernel = Boussinesq::new(grid, 1.0)?;
                let targets: Vec<f64> =
                    widths.iter().map(|w| hertz.load_at_half_width(*w)).collect();
                let greatest = targets.iter().copied().fold(0.0, f64::max);
                let path = LoadingSolver::builder(&cylinder, &kernel).max_load(greatest * ly);
                let mut plane = Plane::follow(path)?;
                let scaled = |target: &f64| {
                    let section = plane.at_load(target * ly)?;
                    let p0 = hertz.max_pressure(*target);
                    let point = |(x, p): (f64, f64)| (x, p / p0, hertz.pressure(x, *target) / p0);
                    Ok(section.into_iter().map(point).collect())
                };
                targets.iter().map(scaled).collect()
            }
            Self::Wave(a) => {
                let grid = Grid::new(nodes, 1, cell, WAVELENGTH)?;
                let wave = Wave::new(AMPLITUDE, WAVELENGTH, Axis::X)?;
                let kernel = PeriodicBoussinesq::new(grid, 1.0)?;
                let mut plane = Plane::follow(LoadingSolver::builder(&wave, &kernel))?;
                wave_profiles(a, widths, |mean| plane.at_load(mean * grid.nominal_area()))
            }
            Self::FreeWaves(a, count) => {
                let width = count as f64 * WAVELENGTH;
                let grid = Grid::new(count * nodes, 1, cell, length * width)?;
                let wave = Wave::new(AMPLITUDE, WAVELENGTH, Axis::X)?;
                let kernel = Boussinesq::new(grid, 1.0)?;
                let mut plane = Plane::follow(LoadingSolver::builder(&wave, &kernel))?;
                let middle = nodes * (count / 2)..nodes * (count / 2 + 1);
                wave_profiles(a, widths, |mean| {
                    let mut section = plane.at_mean(mean, middle.clone())?;
                    Ok(section.drain(middle.clone()).collect())
                })
            }
        }
    }
}

/// Profiles of a wave at several widths, from its pressure at a mean pressure.
fn wave_profiles(
    half_width: f64,
    widths: &[f64],
    mut pressure: impl FnMut(f64) -> Result<Vec<(f64, f64)>, Error>,
) -> Result<Vec<Profile>, Error> {
    let westergaard = Westergaard::new(AMPLITUDE, WAVELENGTH, 1.0)?;
    let full = westergaard.full_contact_pressure();
    let scaled = |width: &f64| {
        let mean = westergaard.mean_pressure_at_half_width(width * half_width * WAVELENGTH);
        let point = |(x, p): (f64, f64)| (x, p / full, westergaard.pressure(x, mean) / full);
        Ok(pressure(mean)?.into_iter().map(point).collect())
    };
    widths.iter().map(scaled).collect()
}

/// A finished path of a single row of cells.
struct Plane {
    path: LoadingSolver,
    history: History,
}

impl Plane {
    fn follow(builder: LoadingBuilder<'_>) -> Result<Self, Error> {
        let mut path = builder.build()?;
        let history = path.by_ref().collect::<Result<History, Error>>()?;
        Ok(Self { path, history })
    }

    /// (x from the middle, pressure) of every cell at a load within the path.
    fn at_load(&mut self, load: f64) -> Result<Vec<(f64, f64)>, Error> {
        let grid = self.path.grid();
        let state = self.history.at_load(load);
        let present = self.history.states().len();
        let state = state.ok_or(Error::StateNotReached { step: present + 1, present })?;
        let pressure = self.path.fields_at(&state)?.pressure;
        let x = |ix: usize| grid.position(ix, 0).0 - grid.center().0;
        Ok((0..grid.nx()).map(|ix| (x(ix), pressure[(ix, 0)])).collect())
    }

    /// The same at the load that gives some cells this mean pressure: it grows with the load.
    fn at_mean(
        &mut self,
        mean: f64,
        cells: std::ops::Range<usize>,
    ) -> Result<Vec<(f64, f64)>, Error> {
        let area = self.path.grid().nominal_area();
        // The edges carry more than the middle, never half of it or less.
        let (mut low, mut high) = (0.5 * mean * area, 2.0 * mean * area);
        // Halved to the last bit, or nearly.
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            let section = self.at_load(middle)?;
            let sum: f64 = section[cells.clone()].iter().map(|(_, p)| p).sum();
            if sum < mean * cells.len() as f64 {
                low = middle;
            } else {
                high = middle;
            }
        }
        self.at_load(high)
    }
}
