//! What looks wrong, although nothing forbids it.

use std::fmt;

use crate::surface::{Topography, Trend};

/// Something that a person should look at: most often a unit that was mistaken. Nothing is refused because of it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Doubt {
    /// A surface with slopes above 45°, for which the theory of small slopes does not hold, and that no machining makes.
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
    /// A pressure that no body bears elastically.
    HighPressure {
        /// The greatest pressure \[Pa\].
        pressure: f64,
        /// Composite modulus \[Pa\].
        e_star: f64,
    },
}

/// Root mean square gradient above which a surface is doubted.
const STEEP: f64 = 1.0;
/// How many times the roughness a tilt may be.
const TILT: f64 = 3.0;
/// Pressure over composite modulus: metals yield at a hardness of some 0.01 to 0.03, and glass at 0.1.
const HIGH: f64 = 0.1;
/// No solid is softer \[Pa\].
const SOFTEST: f64 = 1e3;

impl Doubt {
    /// What looks wrong with a surface.
    #[must_use]
    pub fn of_surface(surface: &Topography) -> Vec<Self> {
        let mut doubts = Vec::new();
        let gradient = surface.map().rms_gradient(surface.grid());
        if let Some(rms_gradient) = gradient.ok().filter(|gradient| *gradient > STEEP) {
            doubts.push(Self::Steep { rms_gradient });
        }
        if let Ok(levelled) = surface.level(Trend::Plane) {
            let left = levelled.map().rms_height();
            let plane = surface.map().rms_height().powi(2) - left * left;
            let plane = plane.max(0.0).sqrt();
            if plane > TILT * left && left > 0.0 {
                doubts.push(Self::Tilted { plane, left });
            }
        }
        doubts
    }

    /// What looks wrong with the greatest pressure of a contact.
    #[must_use]
    pub fn of_pressure(pressure: f64, e_star: f64) -> Option<Self> {
        (pressure > HIGH * e_star).then_some(Self::HighPressure { pressure, e_star })
    }
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Steep { rms_gradient } => {
                write!(
                    f,
                    "the rms gradient of the surface is {rms_gradient:.3}; the theory needs slopes well below 1"
                )?;
                // The first unit that makes a surface of it.
                let smaller = [(1e-3, "a thousand"), (1e-6, "a million"), (1e-9, "10⁹")];
                let fits = |(factor, _): &&(f64, &str)| rms_gradient * factor < 0.5 * STEEP;
                match smaller.iter().find(fits) {
                    Some((factor, times)) => write!(
                        f,
                        ". With heights {times} times smaller (nm for µm, or µm for mm and so on) it would be \
                         {:.2e}: are the units of heights and sides right?",
                        rms_gradient * factor
                    ),
                    None => write!(f, ": are the units of heights and sides right?"),
                }
            }
            Self::Tilted { plane, left } => write!(
                f,
                "the surface is tilted: a plane makes up {plane:.3e} m of its rms height, and only {left:.3e} m is \
                 roughness. Contact would begin at one edge; level it (`level`, `--level plane`) unless the tilt is \
                 meant"
            ),
            Self::HighPressure { pressure, e_star } => {
                write!(
                    f,
                    "the greatest pressure is {pressure:.3e} Pa, {:.2} of E* = {e_star:.3e} Pa; metals yield at some \
                     0.01 to 0.03 of it",
                    pressure / e_star
                )?;
                if e_star < SOFTEST {
                    write!(
                        f,
                        ". No solid is as soft as that: in GPa it would be {:.3e} Pa",
                        1e9 * e_star
                    )?;
                }
                Ok(())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::{Error, Grid};

    fn doubts(cell: f64, height: impl Fn(f64, f64) -> f64) -> Result<Vec<Doubt>, Error> {
        let heights = DMatrix::from_fn(16, 16, |ix, iy| height(ix as f64, iy as f64));
        let surface = Topography::new(Grid::new(16, 16, cell, cell)?, heights)?;
        Ok(Doubt::of_surface(&surface))
    }

    #[test]
    fn units_that_are_mixed_up_are_noticed() -> Result<(), Error> {
        let rough = |x: f64, y: f64| 1e-6 * (x.sin() + (1.7 * y).sin());
        assert_eq!(doubts(1e-5, rough)?, []);
        // Heights in nm that are taken for µm.
        let found = doubts(1e-5, |x, y| 1e3 * rough(x, y))?;
        assert!(matches!(found[..], [Doubt::Steep { .. }]), "{found:?}");
        assert!(found[0].to_string().contains("a thousand times smaller"));
        // No unit makes a surface of this one.
        let hopeless = Doubt::Steep { rms_gradient: 1e10 }.to_string();
        assert!(!hopeless.contains("times smaller"), "{hopeless}");
        assert!(hopeless.ends_with("are the units of heights and sides right?"));
        Ok(())
    }

    #[test]
    fn a_tilt_that_hides_the_roughness_is_noticed() -> Result<(), Error> {
        let tilted =
            |slope: f64| move |x: f64, y: f64| 1e-9 * (x.sin() + (1.7 * y).sin()) + slope * x;
        assert_eq!(doubts(1e-5, tilted(1e-10))?, []);
        let found = doubts(1e-5, tilted(1e-8))?;
        let [doubt @ Doubt::Tilted { plane, left }] = found[..] else {
            return Err(Error::NotFinite { step: 0 });
        };
        // 16 columns at 1e-8 m each: an rms height of 1e-8 √((16² − 1)/12), and two waves of rms 0.7e-9.
        assert!((plane / 4.61e-8 - 1.0).abs() < 0.01, "{plane}");
        assert!((left / 1e-9 - 1.0).abs() < 0.1, "{left}");
        let text = doubt.to_string();
        assert!(
            text.contains(&format!("{plane:.3e} m of its rms height")),
            "{text}"
        );
        assert!(
            text.contains(&format!("{left:.3e} m is roughness")),
            "{text}"
        );
        Ok(())
    }

    /// Heights whose plane is no number are not called tilted.
    #[test]
    fn heights_that_overflow_are_not_tilted() -> Result<(), Error> {
        let sign = |k: f64| if k < 8.0 { 1.0 } else { -1.0 };
        let found = doubts(1.0, |x, y| f64::MAX * sign(x) * sign(y))?;
        assert!(
            !found
                .iter()
                .any(|doubt| matches!(doubt, Doubt::Tilted { .. })),
            "{found:?}"
        );
        Ok(())
    }

    /// Text that has room for so many bytes.
    struct Room(usize);

    impl fmt::Write for Room {
        fn write_str(&mut self, text: &str) -> fmt::Result {
            self.0 = self.0.checked_sub(text.len()).ok_or(fmt::Error)?;
            Ok(())
        }
    }

    /// Wherever its text ends too early, a doubt that does not fit says so.
    #[test]
    fn a_doubt_that_does_not_fit_is_an_error() {
        use fmt::Write;
        let (plane, left) = (1e-6, 1e-9);
        let (pressure, e_star) = (60.0, 115.0);
        for doubt in [
            Doubt::Steep { rms_gradient: 40.0 },
            Doubt::Steep { rms_gradient: 1e10 },
            Doubt::Tilted { plane, left },
            Doubt::HighPressure { pressure, e_star },
        ] {
            let length = doubt.to_string().len();
            for room in 0..length {
                assert!(write!(Room(room), "{doubt}").is_err(), "{room} of {length}");
            }
            assert!(write!(Room(length), "{doubt}").is_ok());
        }
    }

    #[test]
    fn pressures_that_no_body_bears_are_noticed() {
        assert_eq!(Doubt::of_pressure(1e9, 115e9), None);
        let gigapascals = Doubt::of_pressure(60.0, 115.0);
        assert!(gigapascals.is_some_and(|doubt| doubt.to_string().contains("1.150e11")));
        // Too high for metals, on a modulus that solids have.
        let high = Doubt::of_pressure(20e9, 115e9).map(|doubt| doubt.to_string());
        assert!(
            high.is_some_and(
                |text| text.contains("2.000e10 Pa, 0.17 of E*") && !text.contains("GPa")
            )
        );
    }
}
