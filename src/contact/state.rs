//! The scalars of a state of contact.

use std::cmp::Ordering;

use crate::Grid;

/// The scalars of one state of contact, in the units of the input; SI is given here.
///
/// A node whose gap is closed is in contact, with pressure or without: at the instant at which it
/// touches it carries nothing yet. Stiffnesses are exact derivatives *on further loading* of the nodes
/// in contact.
///
/// In full contact, that of a flat surface under no load too, the mean gap is exactly 0 and the interfacial stiffness
/// infinite. Nodes that touch at one approach have a state each; only the stiffness of the last one lasts. The earlier ones
/// have that of the nodes taken so far, nearly so on a path without a factor, and in equal steps there with a hardness.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct ContactState {
    /// Number of nodes in contact, n.
    pub contact_nodes: usize,
    /// Normal approach δ from first touch \[m\]; of the mean planes if the half-space is periodic and
    /// its mean displacement arbitrary.
    pub approach: f64,
    /// Normal load `W = ΔA Σ p` \[N\].
    pub load: f64,
    /// Contact area `n ΔA` \[m²\].
    pub contact_area: f64,
    /// Contact area over nominal area, between 0 and 1.
    pub contact_area_fraction: f64,
    /// Nominal area \[m²\].
    pub nominal_area: f64,
    /// Gap averaged over the nominal area \[m\].
    pub mean_gap: f64,
    /// Normal contact stiffness `K = dW/dδ` \[N/m\], δ being the approach of a distant point of the
    /// half-space; `None` if there is no such point, as under a periodic half-space, every one of
    /// which recedes without bound, and if stiffnesses were not asked for.
    pub contact_stiffness: Option<f64>,
    /// Interfacial stiffness `Kᵢ = −dW/dḡ` \[N/m\], ḡ being the mean gap: infinite in full contact,
    /// where the mean gap cannot change. `None` if stiffnesses were not asked for; a path always has it.
    pub interfacial_stiffness: Option<f64>,
    /// Elastic energy `U = ½ ΔA Σ p u` \[J\], which comes back on unloading. Where nothing yields it is `∫ W dδ`.
    pub energy: f64,
    /// What has yielded, with a [hardness](crate::loading::LoadingBuilder::hardness); `None` without one. A single load
    /// gives its fields too ([`ContactFields`](crate::contact::ContactFields)).
    pub plastic: Option<PlasticState>,
}

/// Nodes whose pressure is their hardness, and what they have lost of their height.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct PlasticState {
    /// Number of nodes that have yielded; all of them are in contact.
    pub yielded_nodes: usize,
    /// Their area over the nominal area.
    pub yielded_area_fraction: f64,
    /// Volume `V = ΔA Σ v` of the plastic depth v, the overlap of yielded nodes \[m³\].
    pub volume: f64,
    /// Energy that is lost, `ΔA Σ H v` \[J\].
    pub work: f64,
    /// dV/dW on further loading \[m³/N\]; 0 on a plateau, where no node is elastic and the load does not change, and of
    /// a single load for which stiffnesses were not asked.
    pub volume_per_load: f64,
    /// The same of the work \[m\].
    pub work_per_load: f64,
    /// Normal stiffness dW/dδ on *unloading* \[N/m\]: of all nodes in contact, also those that have yielded. It is what
    /// conducts. `None` on a periodic half-space, and unless it was asked for:
    /// [`LoadingPath::add_unloading_stiffness`](crate::LoadingPath::add_unloading_stiffness).
    pub contact_unloading_stiffness: Option<f64>,
    /// The same for the interfacial stiffness −dW/dḡ \[N/m\]: infinite in full contact. `None` unless it was asked for.
    pub interfacial_unloading_stiffness: Option<f64>,
}

impl ContactState {
    /// A state made of data, with so many nodes of a grid in contact, no stiffness and no energy; these are fields to
    /// be set.
    #[must_use]
    pub fn new(grid: &Grid, contact_nodes: usize, approach: f64, load: f64, mean_gap: f64) -> Self {
        Self {
            contact_nodes,
            approach,
            load,
            contact_area: contact_nodes as f64 * grid.cell_area(),
            contact_area_fraction: contact_nodes as f64 / grid.nodes() as f64,
            nominal_area: grid.nominal_area(),
            mean_gap,
            contact_stiffness: None,
            interfacial_stiffness: None,
            energy: 0.0,
            plastic: None,
        }
    }

    /// Load over nominal area \[Pa\].
    #[must_use]
    pub fn mean_pressure(&self) -> f64 {
        self.load / self.nominal_area
    }

    /// Whether all quantities are finite; in full contact the interfacial stiffness need not be.
    pub(crate) fn is_finite(&self) -> bool {
        self.not_finite().is_none()
    }

    /// A quantity that is not finite, with its name; in full contact the interfacial stiffness need not be.
    pub(crate) fn not_finite(&self) -> Option<(&'static str, f64)> {
        let plastic = self.plastic.unwrap_or_default();
        let interfacial = self.interfacial_stiffness.unwrap_or_default();
        let is_infinite = self.contact_area_fraction == 1.0 && !interfacial.is_nan();
        let interfacial = if is_infinite { 0.0 } else { interfacial };
        let quantities = [
            ("approach", self.approach),
            ("load", self.load),
            ("contact area", self.contact_area),
            ("contact area fraction", self.contact_area_fraction),
            ("nominal area", self.nominal_area),
            ("mean gap", self.mean_gap),
            ("elastic energy", self.energy),
            ("plastic volume", plastic.volume),
            ("plastic work", plastic.work),
            ("plastic volume for each newton", plastic.volume_per_load),
            ("plastic work for each newton", plastic.work_per_load),
            ("contact stiffness", self.contact_stiffness.unwrap_or_default()),
            ("interfacial stiffness", interfacial),
        ];
        quantities.into_iter().find(|(_, value)| !value.is_finite())
    }

    /// Puts back the stiffness of full contact, for formats without infinity, such as JSON, which lose it.
    #[cfg(feature = "serde")]
    pub(crate) fn restore_infinity(&mut self) {
        if self.contact_area_fraction == 1.0 {
            self.interfacial_stiffness.get_or_insert(f64::INFINITY);
            let plastic = self.plastic.as_mut();
            if let Some(known) = plastic.filter(|p| p.contact_unloading_stiffness.is_some()) {
                known.interfacial_unloading_stiffness.get_or_insert(f64::INFINITY);
            }
        }
    }

    /// Takes what has fallen since an earlier state from there: where contact only grows it is rounding, or what
    /// states of an iteration may be off by.
    pub(crate) fn keep_growing(&mut self, earlier: &Self) {
        self.approach = self.approach.max(earlier.approach);
        self.load = self.load.max(earlier.load);
        self.mean_gap = self.mean_gap.min(earlier.mean_gap);
        if let (Some(plastic), Some(earlier)) = (&mut self.plastic, &earlier.plastic) {
            plastic.volume = plastic.volume.max(earlier.volume);
            plastic.work = plastic.work.max(earlier.work);
        } else {
            // About the mean displacement of a periodic half-space all nodes at their hardness have no elastic energy.
            self.energy = self.energy.max(earlier.energy);
        }
    }

    /// Which of two states of one path comes first while the load grows. Loads are equal on a plateau.
    pub(crate) fn order(&self, other: &Self) -> Ordering {
        self.load.total_cmp(&other.load).then(self.approach.total_cmp(&other.approach))
    }

    /// dW/dδ for the approach of this state: of the mean planes if there is no other.
    pub(crate) fn load_rate(&self) -> Option<f64> {
        let yielding = self.plastic.filter(|plastic| plastic.volume_per_load != 0.0);
        self.contact_stiffness.or_else(|| match (self.interfacial_stiffness, yielding) {
            // Mean planes approach by what the mean gap closes and by what yields.
            (Some(stiffness), Some(plastic)) => {
                Some(1.0 / (1.0 / stiffness + plastic.volume_per_load / self.nominal_area))
            }
            (stiffness, _) => stiffness,
        })
    }

    /// Number of nodes that have yielded, 0 without a hardness.
    pub(crate) fn yielded_nodes(&self) -> usize {
        self.plastic.map_or(0, |plastic| plastic.yielded_nodes)
    }

    /// Whether all nodes in contact have yielded: the approach grows, and the load does not.
    pub(crate) fn is_plateau(&self) -> bool {
        self.yielded_nodes() > 0 && self.yielded_nodes() == self.contact_nodes
    }

    /// The state further on a plateau: gaps close as the approach grows, and yielded nodes give way.
    fn along_plateau(&self, advance: f64) -> Self {
        let plastic = self.plastic.map(|plastic| PlasticState {
            volume: plastic.volume + self.contact_area * advance,
            work: plastic.work + self.load * advance,
            ..plastic
        });
        Self {
            approach: self.approach + advance,
            mean_gap: self.mean_gap - (1.0 - self.contact_area_fraction) * advance,
            plastic,
            ..*self
        }
    }

    /// The state at another load with the same nodes in contact, by the exact linear relations
    /// between two events: `W = Wₙ + K (δ − δₙ)`, `ḡ = ḡₙ − (K / Kᵢ)(δ − δₙ)`.
    ///
    /// `None` without stiffnesses, and on a plateau.
    pub(crate) fn at_load(&self, load: f64) -> Option<Self> {
        if load == self.load {
            return Some(*self);
        }
        if self.is_plateau() {
            return None;
        }
        let change = load - self.load;
        let advance = change / self.load_rate()?;
        let lost = self.plastic.map_or(0.0, |plastic| plastic.work_per_load * change);
        let plastic = self.plastic.map(|plastic| PlasticState {
            volume: plastic.volume + plastic.volume_per_load * change,
            work: plastic.work + lost,
            ..plastic
        });
        Some(Self {
            approach: self.approach + advance,
            load,
            mean_gap: self.mean_gap - change / self.interfacial_stiffness?,
            energy: self.energy + 0.5 * (self.load + load) * advance - lost,
            plastic,
            ..*self
        })
    }

    /// The same at another approach; also `None` if the approach cannot change, as in full contact of
    /// a periodic half-space.
    pub(crate) fn at_approach(&self, approach: f64) -> Option<Self> {
        if approach == self.approach {
            return Some(*self);
        }
        if self.is_plateau() {
            return Some(Self { approach, ..self.along_plateau(approach - self.approach) });
        }
        let rate = self.load_rate().filter(|rate| rate.is_finite())?;
        let state = self.at_load(self.load + rate * (approach - self.approach))?;
        Some(Self { approach, ..state })
    }

    /// The same at another mean gap; also `None` if the mean gap cannot change.
    pub(crate) fn at_mean_gap(&self, mean_gap: f64) -> Option<Self> {
        if mean_gap == self.mean_gap {
            return Some(*self);
        }
        if self.is_plateau() {
            let open = 1.0 - self.contact_area_fraction;
            let advance = (self.mean_gap - mean_gap) / open;
            return (open > 0.0).then(|| Self { mean_gap, ..self.along_plateau(advance) });
        }
        let rate = self.interfacial_stiffness.filter(|rate| rate.is_finite())?;
        let state = self.at_load(self.load + rate * (self.mean_gap - mean_gap))?;
        Some(Self { mean_gap, ..state })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 10 N on 8 of 4 × 5 nodes, 5 m² in all, in numbers that are short in binary.
    fn state() -> Result<ContactState, crate::Error> {
        let grid = Grid::new(4, 5, 0.5, 0.5)?;
        Ok(ContactState {
            contact_stiffness: Some(4.0),
            interfacial_stiffness: Some(2.0),
            energy: 6.0,
            ..ContactState::new(&grid, 8, 3.0, 10.0, 7.0)
        })
    }

    #[test]
    fn areas_and_mean_pressure_are_those_of_the_grid() -> Result<(), crate::Error> {
        let state = state()?;
        assert_eq!(state.contact_area, 2.0);
        assert_eq!(state.contact_area_fraction, 0.4);
        assert_eq!(state.mean_pressure(), 2.0);
        // Pulled, with nothing in contact.
        let apart = ContactState::new(&Grid::new(4, 5, 0.5, 0.5)?, 0, -3.0, -10.0, 7.0);
        assert_eq!(apart.mean_pressure(), -2.0);
        Ok(())
    }

    /// 4 N more: 1 m of approach at 4 N/m, 2 m of mean gap at 2 N/m, and the work of a mean of 12 N over 1 m. The same
    /// state whichever of the three is asked for.
    #[test]
    fn the_same_contact_at_another_load() -> Result<(), crate::Error> {
        let before = state()?;
        let after =
            ContactState { approach: 4.0, load: 14.0, mean_gap: 5.0, energy: 18.0, ..before };
        assert_eq!(before.at_load(14.0), Some(after));
        assert_eq!(before.at_approach(4.0), Some(after));
        assert_eq!(before.at_mean_gap(5.0), Some(after));
        // Of the mean planes if there is no other approach: 4 N at 2 N/m.
        let planes = ContactState { contact_stiffness: None, ..before };
        assert_eq!(planes.at_load(14.0).map(|state| state.approach), Some(5.0));
        Ok(())
    }

    /// Without stiffnesses only the state itself is known; where they are infinite, loads alone can be asked for.
    #[test]
    fn what_no_stiffness_tells_is_not_told() -> Result<(), crate::Error> {
        let state = state()?;
        let unknown =
            ContactState { contact_stiffness: None, interfacial_stiffness: None, ..state };
        let full = ContactState {
            contact_stiffness: None,
            interfacial_stiffness: Some(f64::INFINITY),
            ..state
        };
        for known in [state, unknown, full] {
            assert_eq!(known.at_load(10.0), Some(known));
            assert_eq!(known.at_approach(3.0), Some(known));
            assert_eq!(known.at_mean_gap(7.0), Some(known));
        }
        assert_eq!(unknown.at_load(14.0), None);
        for stiff in [unknown, full] {
            assert_eq!(stiff.at_approach(4.0), None);
            assert_eq!(stiff.at_mean_gap(5.0), None);
        }
        let pressed = full.at_load(14.0);
        assert_eq!(pressed.map(|s| (s.approach, s.mean_gap)), Some((3.0, 7.0)));
        Ok(())
    }

    /// No quantity may be no number or infinite, but the interfacial stiffness of full contact.
    #[test]
    fn states_are_finite_in_every_quantity() -> Result<(), crate::Error> {
        let state = state()?;
        assert!(state.is_finite());
        let quantities: [fn(&mut ContactState, f64); 8] = [
            |state, x| state.approach = x,
            |state, x| state.load = x,
            |state, x| state.contact_area = x,
            |state, x| state.contact_area_fraction = x,
            |state, x| state.mean_gap = x,
            |state, x| state.contact_stiffness = Some(x),
            |state, x| state.interfacial_stiffness = Some(x),
            |state, x| state.energy = x,
        ];
        for (k, set) in quantities.into_iter().enumerate() {
            for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let mut state = state;
                set(&mut state, bad);
                assert!(!state.is_finite(), "quantity {k} is {bad}");
            }
        }
        let full = |stiffness| ContactState {
            contact_area_fraction: 1.0,
            interfacial_stiffness: Some(stiffness),
            ..state
        };
        assert!(full(f64::INFINITY).is_finite());
        assert!(!full(f64::NAN).is_finite());
        Ok(())
    }
}
