//! One state of contact.

/// What happens to a node at an event of the path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ContactEvent {
    /// Its gap has closed, and it joins the contact.
    Touch,
    /// Its pressure has fallen to zero, and it leaves the contact. It never happens with the kernels
    /// of this crate; see [`ContactGrowth`](crate::ContactGrowth).
    Release,
}

/// The state of contact at one instant of loading.
///
/// A state is the instant of an event, at which a node touches or leaves: its own pressure is zero.
/// Stiffnesses are exact derivatives *on further loading*, with the event already done.
/// Quantities carry the units of the input; SI is given here.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ContactState {
    /// Number of the event, 1 for first touch. Where no node ever leaves the contact it is the number
    /// of nodes in contact too.
    pub step: usize,
    /// What happened.
    pub event: ContactEvent,
    /// The node to which it happened, (ix, iy).
    pub node: (usize, usize),
    /// Number of nodes in contact, n.
    pub contact_nodes: usize,
    /// Normal approach δ from first touch \[m\]; of the mean planes if the half-space is periodic.
    pub approach: f64,
    /// Normal load $W = \Delta A \sum p$ \[N\].
    pub load: f64,
    /// Contact area $n\, \Delta A$ \[m²\].
    pub contact_area: f64,
    /// Contact area over nominal area, between 0 and 1.
    pub contact_area_fraction: f64,
    /// Gap averaged over the nominal area \[m\].
    pub mean_gap: f64,
    /// Normal contact stiffness $K = dW/d\delta$ \[N/m\] with the approach of a distant point of the
    /// half-space; `None` if the half-space is periodic, which has none: every distant point recedes
    /// without bound.
    pub contact_stiffness: Option<f64>,
    /// Interfacial stiffness $K_i = -dW/d\bar g$ \[N/m\]: infinite in full contact, where the mean
    /// gap cannot change. On a periodic half-space it is dW/dδ as well, since δ is that of the mean
    /// planes.
    pub interfacial_stiffness: f64,
    /// Elastic energy $U = \int W\, d\delta$ \[J\].
    pub energy: f64,
}

impl ContactState {
    /// Load over nominal area \[Pa\].
    #[must_use]
    pub fn mean_pressure(&self) -> f64 {
        self.load * self.contact_area_fraction / self.contact_area
    }

    /// Whether all quantities are finite, stiffnesses but for full contact.
    pub(super) fn is_finite(&self) -> bool {
        let quantities = [
            self.approach,
            self.load,
            self.contact_area,
            self.mean_gap,
            self.energy,
        ];
        let full = self.contact_area_fraction == 1.0;
        quantities.iter().all(|quantity| quantity.is_finite())
            && (self.interfacial_stiffness.is_finite() || full)
            && !self.interfacial_stiffness.is_nan()
    }

    /// $dW/d\delta$ for the approach of this state: that of the mean planes if there is no other.
    fn load_rate(&self) -> f64 {
        self.contact_stiffness.unwrap_or(self.interfacial_stiffness)
    }

    /// The state at another approach with the same nodes in contact, by the exact linear relations
    /// of the interval between two events:
    /// $W = W_n + K (\delta - \delta_n)$, $\bar g = \bar g_n - (K / K_i)(\delta - \delta_n)$.
    ///
    /// It is a state of the path only if `approach` lies between this state's and the next one's.
    #[must_use]
    pub fn at_approach(&self, approach: f64) -> Self {
        if approach == self.approach {
            return *self;
        }
        let change = self.load_rate() * (approach - self.approach);
        Self {
            approach,
            ..self.at_load(self.load + change)
        }
    }

    /// The state at another load with the same nodes in contact; see [`Self::at_approach`].
    #[must_use]
    pub fn at_load(&self, load: f64) -> Self {
        let change = load - self.load;
        let advance = change / self.load_rate();
        Self {
            approach: self.approach + advance,
            load,
            mean_gap: self.mean_gap - change / self.interfacial_stiffness,
            energy: self.energy + 0.5 * (self.load + load) * advance,
            ..*self
        }
    }

    /// The state at another mean gap with the same nodes in contact; see [`Self::at_approach`].
    #[must_use]
    pub fn at_mean_gap(&self, mean_gap: f64) -> Self {
        let change = (self.mean_gap - mean_gap) * self.interfacial_stiffness;
        Self {
            mean_gap,
            ..self.at_load(self.load + change)
        }
    }
}
