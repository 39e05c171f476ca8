//! Linear viscoelastic moduli as Prony series, of relaxation and of creep.

use super::secular::{Pole, roots};
use crate::Error;

/// One term of a Prony series.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PronyTerm {
    /// Relaxation time ρ or retardation time τ \[s\].
    pub time: f64,
    /// Modulus r \[Pa\] or compliance j \[1/Pa\]; parts of the instantaneous modulus if the series has no unit.
    pub amount: f64,
}

/// The modulus of a linear viscoelastic body, in its two forms.
///
/// Relaxation, the stress under a unit strain, and creep, the strain under a unit stress:
///
/// ```math
/// R(t) = r_\infty + \sum_k r_k e^{-t/\varrho_k}, \qquad
/// J(t) = j_0 + \sum_m j_m \left(1 - e^{-t/\tau_m}\right) + \varphi t, \qquad \int_0^t R(t - s)\, \mathrm{d}J(s) = 1 .
/// ```
///
/// Each is made from the other: the Laplace transforms obey $`s \hat R \cdot s \hat J = 1`$, whose poles and roots
/// alternate. All coefficients are positive, as thermodynamics demands, and `R(0) = 1/j₀` is finite. A body with `r∞ =
/// 0` flows: its *fluidity* φ is positive.
///
/// For a contact the modulus is the plane-strain modulus `E/(1 − ν²)`. A Poisson's ratio that does not depend on time
/// is a factor ([`plane_strain`](Self::plane_strain)), and two bodies creep one on top of the other:
/// [`in_series`](Self::in_series). [`relative_to`](Self::relative_to) divides by the E\* of a path, which has been
/// computed with one modulus; the series of [`shares`](Self::shares) is of that kind already.
///
/// ```
/// use asperity::creep::Prony;
///
/// # fn main() -> Result<(), asperity::Error> {
/// // Half of the modulus relaxes, 0.3 of it in a tenth of a second and 0.2 in ten.
/// let rubber = Prony::shares(&[(0.1, 0.3), (10.0, 0.2)])?;
/// assert!((rubber.relaxation_at(0.0) - 1.0).abs() < 1e-15);
/// assert!((rubber.creep_at(f64::INFINITY) - 2.0).abs() < 1e-14);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Prony {
    equilibrium_modulus: f64,
    relaxation: Vec<PronyTerm>,
    instantaneous_compliance: f64,
    creep: Vec<PronyTerm>,
    fluidity: f64,
}

impl Prony {
    /// A body that does not creep.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`].
    pub fn elastic(modulus: f64) -> Result<Self, Error> {
        Self::relaxation(modulus, &[])
    }

    /// From relaxation: the modulus r∞ \[Pa\] that is left in the end, 0 for a body that flows, and the terms
    /// (ϱ \[s\], r \[Pa\]).
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a negative modulus in the end; [`Error::NotPositive`] for times and moduli of terms
    /// that are not, and if nothing carries at all; [`Error::OutOfRange`] for numbers too far apart for double
    /// precision.
    pub fn relaxation(equilibrium: f64, terms: &[(f64, f64)]) -> Result<Self, Error> {
        let quantity = "equilibrium modulus of a Prony series";
        let is_so = equilibrium >= 0.0 && equilibrium.is_finite();
        Error::require(quantity, equilibrium, is_so, "at least 0 and finite")?;
        let relaxation = checked(terms)?;
        let total = equilibrium + relaxation.iter().map(|term| term.amount).sum::<f64>();
        let instantaneous = Error::require_positive("instantaneous modulus", total)?;
        // Σ rᵢ/(x − λᵢ) = 0 with λ₀ = 0 and r₀ = r∞.
        let at_rest = (equilibrium > 0.0).then_some(Pole { place: 0.0, weight: equilibrium });
        let rates = relaxation.iter().rev().map(|t| Pole { place: 1.0 / t.time, weight: t.amount });
        let poles: Vec<Pole> = at_rest.into_iter().chain(rates).collect();
        let creep = roots(&poles, 0.0).into_iter().rev().map(|root| PronyTerm {
            time: 1.0 / root.place,
            amount: 1.0 / root.place / root.place / root.slope,
        });
        let viscosity: f64 = relaxation.iter().map(|term| term.amount * term.time).sum();
        Self {
            equilibrium_modulus: equilibrium,
            instantaneous_compliance: 1.0 / instantaneous,
            creep: creep.collect(),
            fluidity: if equilibrium > 0.0 { 0.0 } else { 1.0 / viscosity },
            relaxation,
        }
        .sound()
    }

    /// From creep: the compliance j₀ \[1/Pa\] at once, the terms (τ \[s\], j \[1/Pa\]), and the fluidity φ \[1/(Pa
    /// s)\].
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for a compliance at once that is not (without it no pressure has a Prony series), and for
    /// terms; [`Error::OutOfRange`] for a negative fluidity, and for numbers too far apart for double precision.
    pub fn creep(instantaneous: f64, terms: &[(f64, f64)], fluidity: f64) -> Result<Self, Error> {
        let instantaneous = Error::require_positive("instantaneous compliance", instantaneous)?;
        let is_so = fluidity >= 0.0 && fluidity.is_finite();
        Error::require("fluidity", fluidity, is_so, "at least 0 and finite")?;
        let creep = checked(terms)?;
        // j₀ = Σ wᵢ/(x − μᵢ) with w = j μ, and μ₀ = 0, w₀ = φ.
        let flow = (fluidity > 0.0).then_some(Pole { place: 0.0, weight: fluidity });
        let rates = creep
            .iter()
            .rev()
            .map(|term| Pole { place: 1.0 / term.time, weight: term.amount / term.time });
        let poles: Vec<Pole> = flow.into_iter().chain(rates).collect();
        let relaxation = roots(&poles, instantaneous).into_iter().rev().map(|root| PronyTerm {
            time: 1.0 / root.place,
            amount: 1.0 / root.place / root.slope,
        });
        let total = instantaneous + creep.iter().map(|term| term.amount).sum::<f64>();
        Self {
            equilibrium_modulus: if fluidity > 0.0 { 0.0 } else { 1.0 / total },
            relaxation: relaxation.collect(),
            instantaneous_compliance: instantaneous,
            creep,
            fluidity,
        }
        .sound()
    }

    /// As parts of the instantaneous modulus E₀, which is that of a path: `R(t)/E₀ = 1 − Σ gᵢ (1 − e^(−t/τᵢ))`, the
    /// terms being (τ \[s\], g). If the gᵢ add up to 1, the body flows.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] if the gᵢ add up to more than 1, and as for [`relaxation`](Self::relaxation).
    pub fn shares(terms: &[(f64, f64)]) -> Result<Self, Error> {
        let sum: f64 = terms.iter().map(|(_, share)| share).sum();
        // Decimal fractions such as ten times 0.1 add up to 1 only to rounding.
        let rounding = f64::EPSILON * (2 + terms.len()) as f64;
        Error::require(
            "sum of the shares of a Prony series",
            sum,
            sum <= 1.0 + rounding,
            "at most 1",
        )?;
        let left = 1.0 - sum;
        Self::relaxation(if left <= rounding { 0.0 } else { left }, terms)
    }

    /// The plane-strain modulus `E(t)/(1 − ν²)` of this body, being E(t), with a Poisson's ratio that does not depend
    /// on time.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a Poisson's ratio below −1 or above ½, and at −1.
    pub fn plane_strain(&self, poissons_ratio: f64) -> Result<Self, Error> {
        let is_so = poissons_ratio > -1.0 && poissons_ratio <= 0.5;
        Error::require("Poisson's ratio", poissons_ratio, is_so, "above -1 and at most 0.5")?;
        self.relative_to((1.0 - poissons_ratio) * (1.0 + poissons_ratio))
    }

    /// This body on top of another one: creep functions add up, as in the composite modulus of two bodies,
    /// `1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂`. One that does not creep is [`elastic`](Self::elastic).
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for numbers too far apart for double precision.
    pub fn in_series(&self, other: &Self) -> Result<Self, Error> {
        let terms = self.creep.iter().chain(&other.creep).map(|term| (term.time, term.amount));
        let terms: Vec<_> = terms.collect();
        let instantaneous = self.instantaneous_compliance + other.instantaneous_compliance;
        Self::creep(instantaneous, &terms, self.fluidity + other.fluidity)
    }

    /// The same modulus over another one: over the E\* of a path for [`Creep`](super::Creep) and its like.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`], and [`Error::OutOfRange`] for numbers too far apart for double precision.
    pub fn relative_to(&self, modulus: f64) -> Result<Self, Error> {
        let modulus = Error::require_positive("modulus that others are relative to", modulus)?;
        let scaled = |terms: &[PronyTerm], factor: f64| {
            terms.iter().map(|term| PronyTerm { amount: term.amount * factor, ..*term }).collect()
        };
        Self {
            equilibrium_modulus: self.equilibrium_modulus / modulus,
            relaxation: scaled(&self.relaxation, 1.0 / modulus),
            instantaneous_compliance: self.instantaneous_compliance * modulus,
            creep: scaled(&self.creep, modulus),
            fluidity: self.fluidity * modulus,
        }
        .sound()
    }

    /// The creep function J(t) \[1/Pa\]: 0 before t = 0, j₀ at it.
    #[must_use]
    pub fn creep_at(&self, time: f64) -> f64 {
        if time < 0.0 {
            return 0.0;
        }
        let flow = if self.fluidity > 0.0 { self.fluidity * time } else { 0.0 };
        let terms = self.creep.iter().map(|term| -term.amount * (-time / term.time).exp_m1());
        self.instantaneous_compliance + terms.sum::<f64>() + flow
    }

    /// The relaxation function R(t) \[Pa\]: 0 before t = 0.
    #[must_use]
    pub fn relaxation_at(&self, time: f64) -> f64 {
        if time < 0.0 {
            return 0.0;
        }
        let terms = self.relaxation.iter().map(|term| term.amount * (-time / term.time).exp());
        self.equilibrium_modulus + terms.sum::<f64>()
    }

    /// The terms of relaxation, in the order of their times.
    #[must_use]
    pub fn relaxation_terms(&self) -> &[PronyTerm] {
        &self.relaxation
    }

    /// The terms of creep, in the order of their times.
    #[must_use]
    pub fn creep_terms(&self) -> &[PronyTerm] {
        &self.creep
    }

    /// r∞ \[Pa\], 0 if the body flows.
    #[must_use]
    pub fn equilibrium_modulus(&self) -> f64 {
        self.equilibrium_modulus
    }

    /// R(0) \[Pa\].
    #[must_use]
    pub fn instantaneous_modulus(&self) -> f64 {
        1.0 / self.instantaneous_compliance
    }

    /// j₀ \[1/Pa\].
    #[must_use]
    pub fn instantaneous_compliance(&self) -> f64 {
        self.instantaneous_compliance
    }

    /// φ \[1/(Pa s)\], 0 unless the body flows.
    #[must_use]
    pub fn fluidity(&self) -> f64 {
        self.fluidity
    }

    /// The body itself if all its numbers are.
    fn sound(self) -> Result<Self, Error> {
        let terms = self.relaxation.iter().chain(&self.creep);
        let positive = terms.flat_map(|term| [term.time, term.amount]);
        let mut positive = positive.chain([self.instantaneous_compliance]);
        let expected =
            "positive and finite: times and moduli are too far apart for double precision";
        let quantity = "a number of a Prony series or of its other form";
        let bad = positive.find(|number| !(number.is_finite() && *number > 0.0));
        let others = [self.equilibrium_modulus, self.fluidity];
        let bad = bad.or_else(|| others.into_iter().find(|number| !number.is_finite()));
        if let Some(value) = bad {
            return Err(Error::OutOfRange { quantity, value, expected });
        }
        Ok(self)
    }
}

/// The terms in the order of their times, equal times taken together, and without those that are nothing.
fn checked(terms: &[(f64, f64)]) -> Result<Vec<PronyTerm>, Error> {
    let mut checked: Vec<PronyTerm> = Vec::with_capacity(terms.len());
    for &(time, amount) in terms {
        let time = Error::require_positive("time of a term of a Prony series", time)?;
        if amount != 0.0 {
            let amount = Error::require_positive("amount of a term of a Prony series", amount)?;
            checked.push(PronyTerm { time, amount });
        }
    }
    checked.sort_by(|a, b| a.time.total_cmp(&b.time));
    checked.dedup_by(|later, earlier| {
        // As rates, which are the poles.
        let is_same = 1.0 / later.time == 1.0 / earlier.time;
        if is_same {
            earlier.amount += later.amount;
        }
        is_same
    });
    let fastest = checked.first().map_or(1.0, |term| 1.0 / term.time);
    let expected = "one whose inverse is finite";
    let time = 1.0 / fastest;
    Error::require("time of a term of a Prony series", time, fastest.is_finite(), expected)?;
    Ok(checked)
}
