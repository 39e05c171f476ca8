//! All meshes and all spectra, and what they say.

use asperity::Error;
use asperity_studies::line::Line;
use asperity_studies::spread::Spread;
use indicatif::ProgressBar;

use crate::kept::Kept;
use crate::states::{LOADS, Mesh, State};

/// λ_r/λ_s of the surfaces that are refined, and cells to the shortest wave of those whose spectrum is widened.
pub(crate) const BAND: usize = 8;
pub(crate) const CELLS: usize = 8;
pub(crate) const MESHES: [usize; 4] = [4, 8, 16, 32];
pub(crate) const BANDS: [usize; 5] = [2, 4, 8, 16, 32];
/// The part of what counting cells gives too much that the correction must remove: on a Hertz contact some 80 %.
pub(crate) const REMOVED: f64 = 0.75;

/// A mesh with the states of each seed.
pub(crate) struct Family {
    pub(crate) mesh: Mesh,
    pub(crate) nayak: f64,
    pub(crate) seeds: Vec<Vec<State>>,
}

impl Family {
    fn new(mesh: Mesh, seeds: u64, kept: &Kept, bar: &ProgressBar) -> Result<Self, Error> {
        let states = (1..=seeds).map(|seed| {
            let states = match kept.states(mesh, seed) {
                Some(states) => Ok(states),
                None => mesh.states(seed),
            };
            bar.inc(1);
            states
        });
        Ok(Self { mesh, nayak: mesh.nayak()?, seeds: states.collect::<Result<_, _>>()? })
    }

    /// A number of the states under one load.
    pub(crate) fn spread(&self, load: usize, value: impl Fn(&State) -> f64) -> Spread {
        Spread::of(self.seeds.iter().filter_map(|s| s.get(load)).map(value))
    }

    /// The mean over the seeds, relative to one of another mesh.
    fn relative(&self, other: &Self, load: usize, value: fn(&State) -> f64) -> f64 {
        self.spread(load, value).mean / other.spread(load, value).mean - 1.0
    }
}

/// A straight line in the logarithm of Nayak's parameter.
pub(crate) struct Trend {
    pub(crate) slope: f64,
    /// Standard error of the slope, over all surfaces.
    pub(crate) error: f64,
}

impl Trend {
    /// The criterion: κ falls, by more than two standard errors.
    pub(crate) fn falls(&self) -> bool {
        self.slope < -2.0 * self.error
    }
}

/// All that was computed.
pub(crate) struct Study {
    pub(crate) surfaces: u64,
    pub(crate) meshes: Vec<Family>,
    pub(crate) bands: Vec<Family>,
}

impl Study {
    pub(crate) fn new(surfaces: u64, finest: usize, kept: &Kept) -> Result<Self, Error> {
        let meshes = MESHES.into_iter().filter(|cells| *cells <= finest);
        let meshes: Vec<_> = meshes.map(|cells| Mesh { band: BAND, cells }).collect();
        let bands = BANDS.into_iter().filter(|band| *band <= finest);
        let bands: Vec<_> = bands.map(|band| Mesh { band, cells: CELLS }).collect();
        let bar = ProgressBar::new(surfaces * (meshes.len() + bands.len()) as u64);
        let all = |meshes: Vec<Mesh>| {
            let each = meshes.into_iter().map(|mesh| Family::new(mesh, surfaces, kept, &bar));
            each.collect::<Result<Vec<_>, _>>()
        };
        let study = Self { surfaces, meshes: all(meshes)?, bands: all(bands)? };
        bar.finish_and_clear();
        Ok(study)
    }

    /// κ without mesh: Richardson's extrapolation of counted cells from the finest two meshes, first order, surface by
    /// surface.
    pub(crate) fn limit(&self, load: usize) -> Spread {
        let [.., fine, finest] = self.meshes.as_slice() else {
            return Spread::of([f64::NAN]);
        };
        let pairs = fine.seeds.iter().zip(&finest.seeds);
        Spread::of(pairs.filter_map(|(fine, finest)| {
            Some(2.0 * finest.get(load)?.kappa() - fine.get(load)?.kappa())
        }))
    }

    /// What a mesh leaves of κ, counted and corrected, relative to the limit, on the mean over the surfaces.
    pub(crate) fn left(&self, family: &Family, load: usize) -> [f64; 2] {
        let limit = self.limit(load).mean;
        [State::kappa, State::corrected_kappa]
            .map(|value| family.spread(load, value).mean / limit - 1.0)
    }

    /// The same of mean gap and stiffness, relative to the finest mesh.
    pub(crate) fn beside_finest(&self, family: &Family, load: usize) -> [f64; 2] {
        let finest = self.meshes.last();
        finest.map_or([f64::NAN; 2], |finest| {
            [
                family.relative(finest, load, |s| s.gap),
                family.relative(finest, load, |s| s.stiffness),
            ]
        })
    }

    /// What the correction takes away over what counting cells gives too much, on the mean over the loads; 1 would be
    /// exact.
    pub(crate) fn taken(&self, family: &Family) -> f64 {
        let each = (0..LOADS.len()).map(|load| self.left(family, load));
        let [counted, corrected] =
            each.fold([0.0; 2], |sum, left| [sum[0] + left[0], sum[1] + left[1]]);
        (counted - corrected) / counted
    }

    /// How the corrected κ changes with the logarithm of Nayak's parameter under one load.
    pub(crate) fn trend(&self, load: usize) -> Trend {
        let points: Vec<(f64, f64)> = self
            .bands
            .iter()
            .flat_map(|family| {
                let x = family.nayak.ln();
                let of = move |seed: &Vec<State>| Some((x, seed.get(load)?.corrected_kappa()));
                family.seeds.iter().filter_map(of)
            })
            .collect();
        let line = Line::fit(&points);
        let n = points.len() as f64;
        let mean = points.iter().map(|p| p.0).sum::<f64>() / n;
        let spread: f64 = points.iter().map(|p| (p.0 - mean).powi(2)).sum();
        let residual: f64 = points.iter().map(|p| (p.1 - line.at(p.0)).powi(2)).sum();
        Trend { slope: line.slope, error: (residual / (n - 2.0) / spread).sqrt() }
    }
}
