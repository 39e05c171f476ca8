//! Sphere on a half-space under a tangential load (Cattaneo and Mindlin).

use super::{HertzSphere, positive_part};
use crate::Error;

/// A sphere that is pressed with a load P and sheared with a tangential load T below μP: it sticks within a circle and
/// slips around it.
///
/// The bodies have the ratio κ of tangential to normal compliance (see [`Friction`](crate::slip::Friction)) and are not
/// coupled. A tangential load of at least μP, at which the sphere slides, counts as μP; one of the other sign as none.
///
/// Cattaneo, Rend. Accad. Naz. Lincei 27 (1938) 342; Mindlin, J. Appl. Mech. 16 (1949) 259; Mindlin & Deresiewicz, J.
/// Appl. Mech. 20 (1953) 327; Johnson, *Contact Mechanics*, §7.2 and §7.4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SphereSlip {
    sphere: HertzSphere,
    load: f64,
    friction: f64,
    compliance_ratio: f64,
}

impl SphereSlip {
    /// A sphere under a load P \[N\], with a coefficient of friction μ and a ratio of compliances κ.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for any of the three.
    pub fn new(
        sphere: HertzSphere,
        load: f64,
        friction: f64,
        compliance_ratio: f64,
    ) -> Result<Self, Error> {
        let ratio = "ratio of tangential to normal compliance";
        Ok(Self {
            sphere,
            load: Error::require_positive("load", load)?,
            friction: Error::require_positive("coefficient of friction", friction)?,
            compliance_ratio: Error::require_positive(ratio, compliance_ratio)?,
        })
    }

    /// The tangential load at which it slides, μP \[N\].
    #[must_use]
    pub fn sliding_load(&self) -> f64 {
        self.friction * self.load
    }

    /// T/μP, between 0 and 1.
    fn share(&self, tangential_load: f64) -> f64 {
        let share = positive_part(tangential_load) / self.sliding_load();
        if share > 1.0 { 1.0 } else { share }
    }

    /// `c/a = (1 − T/μP)^(1/3)`, and 1 − c/a without the rounding of a difference.
    fn ratio(&self, tangential_load: f64) -> (f64, f64) {
        let share = self.share(tangential_load);
        let ratio = (1.0 - share).cbrt();
        (ratio, share / (1.0 + ratio + ratio * ratio))
    }

    /// The approach under P \[m\].
    #[must_use]
    pub fn approach(&self) -> f64 {
        self.sphere.approach_at_load(self.load)
    }

    /// Radius of the circle that sticks, $`c = a (1 - T/\mu P)^{1/3}`$ \[m\].
    #[must_use]
    pub fn stick_radius(&self, tangential_load: f64) -> f64 {
        self.sphere.contact_radius(self.approach()) * self.ratio(tangential_load).0
    }

    /// Displacement of a distant point \[m\], $`U = \kappa\mu\delta \left[1 - (1 - T/\mu P)^{2/3}\right]`$.
    #[must_use]
    pub fn displacement(&self, tangential_load: f64) -> f64 {
        let (ratio, rest) = self.ratio(tangential_load);
        self.compliance_ratio * self.friction * self.approach() * rest * (1.0 + ratio)
    }

    /// Tangent stiffness `dT/dU = 2E* c/κ` \[N/m\].
    #[must_use]
    pub fn tangential_stiffness(&self, tangential_load: f64) -> f64 {
        2.0 * self.sphere.e_star() * self.stick_radius(tangential_load) / self.compliance_ratio
    }

    /// Energy that a cycle of T between −T and T costs \[J\]:
    /// $`D = 4\kappa\mu^2 P\delta \left[\frac15 + x - x^{2/3} - \frac15 x^{5/3}\right]`$ with x = 1 − T/μP.
    #[must_use]
    pub fn dissipation(&self, amplitude: f64) -> f64 {
        // The bracket is (1 − y)³ (1 + 3y + y²)/5 with y = c/a, without cancellation.
        let (ratio, rest) = self.ratio(amplitude);
        let bracket = rest * rest * rest * (1.0 + ratio * (3.0 + ratio)) / 5.0;
        let work = self.friction * self.friction * self.load * self.approach();
        4.0 * self.compliance_ratio * work * bracket
    }

    /// Traction at distance `r` from the centre \[Pa\], `q = μ [p(r) − p*(r)]` with the Hertz pressures of P and of P −
    /// T/μ.
    #[must_use]
    pub fn traction(&self, r: f64, tangential_load: f64) -> f64 {
        let approach = self.approach();
        let (ratio, _) = self.ratio(tangential_load);
        let stick = self.sphere.pressure(r, approach * ratio * ratio);
        self.friction * (self.sphere.pressure(r, approach) - stick)
    }

    /// Slip at distance `r` from the centre \[m\]: 0 within the stick radius, and κμ times the gap under P − T/μ around
    /// it, as far as there is contact.
    #[must_use]
    pub fn slip(&self, r: f64, tangential_load: f64) -> f64 {
        let (r, approach) = (r.abs(), self.approach());
        if r <= self.stick_radius(tangential_load) || r > self.sphere.contact_radius(approach) {
            return 0.0;
        }
        let (ratio, _) = self.ratio(tangential_load);
        let stick = approach * ratio * ratio;
        let gap = 0.5 * r * r / self.sphere.radius() + self.sphere.displacement(r, stick) - stick;
        self.compliance_ratio * self.friction * positive_part(gap)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums over rings: the traction carries T, and a cycle loses 4 times the traction limit times the slip, which
    /// shares no formula with the closed one.
    #[test]
    fn tractions_and_slips_add_up() -> Result<(), Error> {
        let sphere = HertzSphere::new(2.0, 3.0)?;
        let joint = SphereSlip::new(sphere, 0.7, 0.4, 1.2)?;
        let radius = sphere.contact_radius(joint.approach());
        for share in [0.05, 0.3, 0.7, 0.98] {
            let force = share * joint.sliding_load();
            let rings = 400_000;
            let (mut sum, mut work) = (0.0, 0.0);
            for k in 0..rings {
                let r = radius * (f64::from(k) + 0.5) / f64::from(rings);
                let area = 2.0 * std::f64::consts::PI * r * radius / f64::from(rings);
                sum += area * joint.traction(r, force);
                let limit = 0.4 * sphere.pressure(r, joint.approach());
                work += 4.0 * area * limit * joint.slip(r, force);
            }
            // The mid-point rule at the square roots of both edges: 400 000^(-3/2).
            assert!((sum / force - 1.0).abs() < 1e-7, "{share}: {sum} {force}");
            let expected = joint.dissipation(force);
            assert!((work / expected - 1.0).abs() < 1e-6, "{share}: {work} {expected}");
        }
        Ok(())
    }

    /// The formulas as they are in books, and the stiffness as the slope of the displacement.
    #[test]
    fn formulas_of_books() -> Result<(), Error> {
        let joint = SphereSlip::new(HertzSphere::new(2.0, 3.0)?, 0.7, 0.4, 1.2)?;
        let limit = joint.sliding_load();
        for share in [0.2, 0.5, 0.9, 1.0] {
            let x: f64 = 1.0 - share;
            let displacement = 1.2 * 0.4 * joint.approach() * (1.0 - x.powf(2.0 / 3.0));
            assert!((joint.displacement(share * limit) / displacement - 1.0).abs() < 1e-14);
            let bracket = 0.2 + x - x.powf(2.0 / 3.0) - 0.2 * x.powf(5.0 / 3.0);
            let lost = 4.0 * 1.2 * 0.16 * 0.7 * joint.approach() * bracket;
            assert!((joint.dissipation(share * limit) / lost - 1.0).abs() < 1e-12);
        }
        let (force, step) = (0.6 * limit, 1e-5 * limit);
        let change = joint.displacement(force + step) - joint.displacement(force - step);
        // The third derivative, over 1e-10, and rounding of 1e-16/1e-5.
        assert!((2.0 * step / change / joint.tangential_stiffness(force) - 1.0).abs() < 1e-9);
        Ok(())
    }

    #[test]
    fn nothing_is_lost_without_shear_and_no_more_than_at_the_limit_beyond() -> Result<(), Error> {
        let sphere = HertzSphere::new(2.0, 3.0)?;
        let joint = SphereSlip::new(sphere, 0.7, 0.4, 1.2)?;
        for none in [0.0, -1.0] {
            assert_eq!((joint.displacement(none), joint.dissipation(none)), (0.0, 0.0));
            assert_eq!(joint.stick_radius(none), sphere.contact_radius(joint.approach()));
        }
        let limit = joint.sliding_load();
        assert_eq!(joint.dissipation(2.0 * limit), joint.dissipation(limit));
        assert_eq!(joint.stick_radius(limit), 0.0);
        assert!(joint.displacement(f64::NAN).is_nan());
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(SphereSlip::new(sphere, bad, 0.4, 1.2).is_err());
            assert!(SphereSlip::new(sphere, 0.7, bad, 1.2).is_err());
            assert!(SphereSlip::new(sphere, 0.7, 0.4, bad).is_err());
        }
        Ok(())
    }
}
