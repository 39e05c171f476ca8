//! What looks wrong, although nothing forbids it.

use std::fmt;

use super::fourier::Waves;
use super::{Topography, Trend, Window};
use crate::number::quantity;

/// Something about a surface that a person should look at: most often a unit that was mistaken. Nothing is refused
/// because of it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// A surface with slopes above 45°, for which the theory of small slopes does not hold, and that no machining
    /// makes.
    Steep {
        /// Root mean square gradient.
        rms_gradient: f64,
    },
    /// A plane through the heights that is larger than what is left without it.
    Tilted {
        /// Root mean square height of the plane \[m\].
        plane: f64,
        /// Root mean square height of what is left \[m\].
        left: f64,
    },
    /// Heights that differ by less than atoms do.
    Smooth {
        /// Root mean square height \[m\].
        rms_height: f64,
    },
    /// A surface most of whose nodes were missing and have been filled.
    Filled {
        /// Nodes that were filled.
        filled: usize,
        /// Nodes of the surface.
        nodes: usize,
    },
    /// Waves that the grid does not resolve: contact areas at light loads are those of the mesh.
    Unresolved {
        /// The share of waves shorter than four cells in the mean square gradient, without tilt.
        share: f64,
    },
}

/// Root mean square gradient above which a warning is given.
const STEEP: f64 = 1.0;
/// How many times the roughness a tilt may be.
const TILT: f64 = 3.0;
/// Root mean square height below which a warning is given \[m\]: a tenth of an atom.
const SMOOTH: f64 = 1e-11;
/// Cells of the shortest wave that counts as resolved, and the share that shorter waves may have.
const CELLS: f64 = 4.0;
const UNRESOLVED: f64 = 0.1;
/// Nodes a side of the piece in which waves are looked at: more of them tell nothing new, and take memory.
const MIDDLE: std::ops::RangeInclusive<usize> = 16..=512;

impl Warning {
    /// What looks wrong with a surface.
    #[must_use]
    pub fn of_surface(surface: &Topography) -> Vec<Self> {
        let mut warnings = Vec::new();
        let gradient = surface.map().rms_gradient(surface.grid());
        if let Some(rms_gradient) = gradient.ok().filter(|gradient| *gradient > STEEP) {
            warnings.push(Self::Steep { rms_gradient });
        }
        let rms_height = surface.map().rms_height();
        if rms_height < SMOOTH && rms_height > 0.0 {
            warnings.push(Self::Smooth { rms_height });
        }
        if let Some(share) = short_waves(surface).filter(|share| *share > UNRESOLVED) {
            warnings.push(Self::Unresolved { share });
        }
        if let Ok(levelled) = surface.level(Trend::Plane) {
            let left = levelled.map().rms_height();
            let plane = surface.map().rms_height().powi(2) - left * left;
            let plane = plane.max(0.0).sqrt();
            if plane > TILT * left {
                warnings.push(Self::Tilted { plane, left });
            }
        }
        warnings
    }

    /// Warnings about a surface on which so many nodes have been filled: most of it would be made up.
    #[must_use]
    pub fn of_filling(filled: usize, nodes: usize) -> Option<Self> {
        (2 * filled > nodes).then_some(Self::Filled { filled, nodes })
    }
}

/// The share of waves shorter than [`CELLS`] cells, of whatever shape, in the mean square gradient in the middle of a
/// surface; `None` where there is no gradient, or too few nodes to tell waves apart.
fn short_waves(surface: &Topography) -> Option<f64> {
    let grid = surface.grid();
    let (nx, ny) = grid.shape();
    // A profile has waves along one direction.
    let is_few = |n: usize| n > 1 && n < *MIDDLE.start();
    if is_few(nx) || is_few(ny) || nx.max(ny) == 1 {
        return None;
    }
    let middle = |n: usize| {
        let some = n.min(*MIDDLE.end());
        let first = (n - some) / 2;
        first..first + some
    };
    let piece = surface.crop(middle(nx), middle(ny)).ok()?;
    // Maps need not repeat: jumps at their borders would be short waves.
    let levelled = piece.level(Trend::Plane).ok()?;
    let whole = levelled.window(Window::Hann).ok()?;
    let fewest = whole.grid().of_directions(whole.grid().shape(), usize::min);
    // The window spreads each wave to its neighbours along either axis.
    let reach = 1.5 / fewest as f64;
    let greatest = std::f64::consts::TAU * (1.0 / CELLS + reach);
    let (mut short, mut all) = (0.0, 0.0);
    for wave in Waves::new(whole.heights(), whole.map().mean_height(), whole.grid()).iter() {
        let (qx, qy) = wave.q;
        let square = wave.count as f64 * wave.power * (qx * qx + qy * qy);
        all += square;
        if libm::hypot(qx * grid.dx(), qy * grid.dy()) > greatest {
            short += square;
        }
    }
    let share = short / all;
    share.is_finite().then_some(share)
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Steep { rms_gradient } => {
                let gradient = match rms_gradient < 1e3 {
                    true => format!("{rms_gradient:.3}"),
                    false => format!("{rms_gradient:.2e}"),
                };
                write!(
                    f,
                    "the rms gradient of the surface is {gradient}; the theory needs slopes well below 1"
                )?;
                // The first unit that makes a surface of it.
                let smaller = [
                    (1e-3, "a thousand", "nm for µm, or µm for mm"),
                    (1e-6, "a million", "nm for mm, or µm for m"),
                    (1e-9, "10⁹", "nm for m"),
                ];
                let fits = |smaller: &&(f64, _, _)| rms_gradient * smaller.0 < 0.5 * STEEP;
                match smaller.iter().find(fits) {
                    Some((factor, times, units)) => write!(
                        f,
                        ". With heights {times} times smaller ({units}) it would be \
                         {:.2e}: are the units of heights and sides right?",
                        rms_gradient * factor
                    ),
                    None => write!(f, ": are the units of heights and sides right?"),
                }
            }
            Self::Tilted { plane, left } => write!(
                f,
                "the surface is tilted: a plane makes up {} of its rms height, and only {} is roughness. Contact would begin at one edge; \
                 level it (`Topography::level`) unless the tilt is meant",
                quantity(plane, "m", 4),
                quantity(left, "m", 4)
            ),
            Self::Smooth { rms_height } => write!(
                f,
                "the rms height of the surface is {}, less than a tenth of an atom: is the unit of heights right?",
                quantity(rms_height, "m", 4)
            ),
            Self::Filled { filled, nodes } => write!(
                f,
                "{filled} of {nodes} heights were missing and have been interpolated: most of this surface was never measured. Crop \
                 it to what was, or measure again"
            ),
            Self::Unresolved { share } => write!(
                f,
                "waves shorter than four cells make up {:.0} % of the mean square gradient. The grid does not resolve \
                 them: contact areas and greatest pressures depend on the mesh",
                100.0 * share
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::{Error, Grid};

    fn warnings(cell: f64, height: impl Fn(f64, f64) -> f64) -> Result<Vec<Warning>, Error> {
        let heights = DMatrix::from_fn(16, 16, |ix, iy| height(ix as f64, iy as f64));
        let surface = Topography::new(Grid::new(16, 16, cell, cell)?, heights)?;
        Ok(Warning::of_surface(&surface))
    }

    #[test]
    fn units_that_are_mixed_up_are_noticed() -> Result<(), Error> {
        let rough = |x: f64, y: f64| 1e-6 * (x.sin() + (0.9 * y).sin());
        assert_eq!(warnings(1e-5, rough)?, []);
        // Heights in nm that are taken for µm.
        let found = warnings(1e-5, |x, y| 1e3 * rough(x, y))?;
        assert!(matches!(found[..], [Warning::Steep { .. }]), "{found:?}");
        // Up or down by three cells from node to node.
        let steep = warnings(1e-5, |x, _| 3e-5 * [0.0, 1.0, 0.0, -1.0][x as usize % 4])?;
        assert!(
            matches!(steep[0], Warning::Steep { rms_gradient } if (rms_gradient - 3.0).abs() < 1e-14),
            "{steep:?}"
        );
        assert!(found[0].to_string().contains("a thousand times smaller"));
        let nanometres = Warning::Steep { rms_gradient: 64_266_609.492 }.to_string();
        assert!(nanometres.contains("surface is 6.43e7;"), "{nanometres}");
        // No unit makes a surface of this one.
        let hopeless = Warning::Steep { rms_gradient: 1e10 }.to_string();
        assert!(!hopeless.contains("times smaller"), "{hopeless}");
        assert!(hopeless.ends_with("are the units of heights and sides right?"));
        Ok(())
    }

    #[test]
    fn a_tilt_that_hides_the_roughness_is_noticed() -> Result<(), Error> {
        let tilted =
            |slope: f64| move |x: f64, y: f64| 1e-9 * (x.sin() + (0.9 * y).sin()) + slope * x;
        assert_eq!(warnings(1e-5, tilted(1e-10))?, []);
        let found = warnings(1e-5, tilted(1e-8))?;
        let [warning @ Warning::Tilted { plane, left }] = found[..] else {
            return Err(Error::TooFewWaves { found: 0, needed: 1 });
        };
        // 16 columns at 1e-8 m each: an rms height of 1e-8 √((16² − 1)/12), and two waves of rms 0.7e-9.
        assert!((plane / 4.61e-8 - 1.0).abs() < 0.01, "{plane}");
        assert!((left / 1e-9 - 1.0).abs() < 0.1, "{left}");
        // A plane is all tilt.
        let found = warnings(1e-5, |x, _| 1e-8 * x)?;
        assert!(matches!(found[..], [Warning::Tilted { .. }]), "{found:?}");
        let text = warning.to_string();
        assert!(text.contains(&format!("{} of its rms height", quantity(plane, "m", 4))), "{text}");
        assert!(text.contains(&format!("{} is roughness", quantity(left, "m", 4))), "{text}");
        Ok(())
    }

    /// Heights whose plane is no number are not called tilted.
    #[test]
    fn heights_that_overflow_are_not_tilted() -> Result<(), Error> {
        let sign = |k: f64| if k < 8.0 { 1.0 } else { -1.0 };
        let found = warnings(1.0, |x, y| f64::MAX * sign(x) * sign(y))?;
        assert!(
            !found.iter().any(|warning| matches!(warning, Warning::Tilted { .. })),
            "{found:?}"
        );
        Ok(())
    }

    /// Wherever its text ends too early, a warning that does not fit says so.
    #[test]
    fn a_warning_that_does_not_fit_is_an_error() {
        use std::io::Write;
        let (plane, left) = (1e-6, 1e-9);
        let rms_height = 1e-13;
        for warning in [
            Warning::Steep { rms_gradient: 40.0 },
            Warning::Steep { rms_gradient: 1e10 },
            Warning::Tilted { plane, left },
            Warning::Smooth { rms_height },
            Warning::Unresolved { share: 0.3 },
            Warning::Filled { filled: 3, nodes: 4 },
        ] {
            let length = warning.to_string().len();
            let mut text = vec![0; length];
            for room in 0..length {
                assert!(write!(&mut text[..room], "{warning}").is_err(), "{room} of {length}");
            }
            assert!(write!(&mut text[..], "{warning}").is_ok());
        }
    }

    #[test]
    fn heights_smaller_than_atoms_are_noticed() -> Result<(), Error> {
        let found = warnings(1e-5, |x, y| 5e-13 * (x.sin() + (0.9 * y).sin()))?;
        let is_close = |rms_height: f64| (rms_height / 5e-13 - 1.0).abs() < 0.1;
        let is_smooth =
            matches!(found[..], [Warning::Smooth { rms_height }] if is_close(rms_height));
        assert!(is_smooth, "{found:?}");
        assert!(found[0].to_string().contains("less than a tenth of an atom"));
        // Nothing is wrong with a plane.
        assert_eq!(warnings(1e-5, |_, _| 1e-6)?, []);
        Ok(())
    }

    /// Two waves of 16/6 and 16/2 cells with equal gradients: half of the mean square gradient is not resolved, but for
    /// the sixth of the former that the window makes waves of 16/5 cells, and for the waves of 16/3 that it makes of the
    /// latter.
    #[test]
    fn waves_that_the_grid_does_not_resolve_are_noticed() -> Result<(), Error> {
        let wave = |waves: f64, x: f64| (std::f64::consts::TAU * waves * x / 16.0).sin() / waves;
        let found = warnings(1e-5, |x, y| 1e-6 * (wave(2.0, x) + wave(6.0, y)))?;
        let is_half =
            matches!(found[..], [Warning::Unresolved { share }] if (share - 0.42).abs() < 0.05);
        assert!(is_half, "{found:?}");
        assert!(found[0].to_string().contains("% of the mean square gradient"));
        assert_eq!(warnings(1e-5, |x, y| 1e-6 * (wave(2.0, x) + wave(2.0, y)))?, []);
        // Four cells resolve a wave.
        assert_eq!(warnings(1e-5, |x, y| 1e-6 * (wave(4.0, x) + wave(4.0, y)))?, []);
        Ok(())
    }

    /// Profiles as well.
    #[test]
    fn profiles_that_are_not_resolved() -> Result<(), Error> {
        for (length, resolved) in [(30.0, true), (3.0, false)] {
            let wave = |k: usize| 1e-8 * (std::f64::consts::TAU * k as f64 / length).sin();
            for (nx, ny) in [(5000, 1), (1, 300)] {
                let heights = DMatrix::from_fn(nx, ny, |ix, iy| wave(ix + iy));
                let map = Topography::new(Grid::new(nx, ny, 1e-6, 1e-6)?, heights)?;
                assert_eq!(Warning::of_surface(&map).is_empty(), resolved, "{length}");
            }
        }
        Ok(())
    }

    /// 30 cells of 1 µm resolve a wave along x, however long cells are along y; three do not.
    #[test]
    fn oblong_cells_resolve_what_runs_along_their_short_sides() -> Result<(), Error> {
        let grid = Grid::new(120, 60, 1e-6, 10e-6)?;
        for (length, resolved) in [(30.0, true), (3.0, false)] {
            let wave = |ix: usize| 1e-8 * (std::f64::consts::TAU * ix as f64 / length).sin();
            let map = Topography::new(grid, DMatrix::from_fn(120, 60, |ix, _| wave(ix)))?;
            assert_eq!(Warning::of_surface(&map).is_empty(), resolved, "{length}");
        }
        Ok(())
    }
}
