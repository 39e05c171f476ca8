//! What a branch is read for.

use super::state::{AdhesiveEvent, AdhesiveState};

/// The states of one branch, or of several that follow each other: what an [`AdhesivePath`](super::AdhesivePath) is
/// collected into.
#[derive(Debug, Clone, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(from = "Parts", into = "Parts")
)]
pub struct AdhesiveBranch {
    states: Vec<AdhesiveState>,
}

/// What is written of a branch.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(transparent)]
struct Parts(Vec<AdhesiveState>);

#[cfg(feature = "serde")]
impl From<Parts> for AdhesiveBranch {
    fn from(Parts(mut states): Parts) -> Self {
        states.iter_mut().for_each(|state| state.contact.restore_infinity());
        Self { states }
    }
}

#[cfg(feature = "serde")]
impl From<AdhesiveBranch> for Parts {
    fn from(branch: AdhesiveBranch) -> Self {
        Self(branch.states)
    }
}

impl FromIterator<AdhesiveState> for AdhesiveBranch {
    fn from_iter<I: IntoIterator<Item = AdhesiveState>>(states: I) -> Self {
        Self { states: states.into_iter().collect() }
    }
}

impl Extend<AdhesiveState> for AdhesiveBranch {
    fn extend<I: IntoIterator<Item = AdhesiveState>>(&mut self, states: I) {
        self.states.extend(states);
    }
}

impl AdhesiveBranch {
    /// The states, one for each event.
    #[must_use]
    pub fn states(&self) -> &[AdhesiveState] {
        &self.states
    }

    /// The greatest pull \[N\], the least load with its sign changed; 0 where nothing pulls. Of unloading it is the
    /// force that pulls the surfaces apart, under a dead load too, whatever the compliance of the machine; of loading
    /// the one with which they pull each other in. A branch that has turned around begins with its first event: the state
    /// where it turned is the last of the branch before, and may be pulled more.
    #[must_use]
    pub fn pull_off(&self) -> f64 {
        let least = self.states.iter().map(|state| state.contact.load).fold(0.0, f64::min);
        // 0 rather than −0.
        0.0 - least
    }

    /// Energy lost in jumps from the first of these states to the last \[J\]; over loading and unloading it is what the
    /// loop costs. It depends on the machine: here the approach is held during a jump, that in the gauge of the kernel
    /// on a periodic half-space.
    #[must_use]
    pub fn dissipated(&self) -> f64 {
        match &self.states[..] {
            [first, .., last] => last.dissipated - first.dissipated,
            _ => 0.0,
        }
    }

    /// The load \[N\] at an approach \[m\], the first time that the branch is there: exact, since both are linear
    /// between two events. `None` for an approach that no two of its states enclose: a branch that has turned around
    /// begins with its first event.
    #[must_use]
    pub fn load_at(&self, approach: f64) -> Option<f64> {
        self.read(|state| [state.contact.approach, state.contact.load], approach)
    }

    /// The approach \[m\] at a load \[N\], the first time that the branch is there.
    #[must_use]
    pub fn approach_at(&self, load: f64) -> Option<f64> {
        self.read(|state| [state.contact.load, state.contact.approach], load)
    }

    /// The second quantity where the first has a value, the first time. Between the two ends of a jump there is no
    /// state.
    fn read(&self, quantities: impl Fn(&AdhesiveState) -> [f64; 2], at: f64) -> Option<f64> {
        if let Some([_, other]) = self.states.first().map(&quantities).filter(|[x, _]| *x == at) {
            return Some(other);
        }
        self.states.windows(2).find_map(|pair| {
            let [[x, y], [next_x, next_y]] = [quantities(&pair[0]), quantities(&pair[1])];
            if next_x == at {
                return Some(next_y);
            }
            let is_between = (x - at) * (next_x - at) < 0.0;
            let is_way = is_between && pair[1].event != AdhesiveEvent::JumpEnd;
            is_way.then_some(y + (at - x) / (next_x - x) * (next_y - y))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::Direction;
    use super::*;
    use crate::{ContactState, Error, Grid};

    /// A load that falls to −2 N, jumps to −5 N at an approach of 3 m, and rises.
    #[test]
    fn readings_are_those_of_the_first_time() -> Result<(), Error> {
        let grid = Grid::square(2, 1.0)?;
        let states = [
            (1.0, 0.0, AdhesiveEvent::Near, 0.5),
            (3.0, -2.0, AdhesiveEvent::JumpStart, 0.5),
            (3.0, -5.0, AdhesiveEvent::JumpEnd, 0.75),
            (5.0, 1.0, AdhesiveEvent::Limit, 0.75),
        ];
        let states =
            (1..).zip(states).map(|(step, (approach, load, event, dissipated))| AdhesiveState {
                step,
                direction: Direction::Loading,
                event,
                node: (0, 0),
                contact: ContactState::new(&grid, 0, approach, load, 1.0),
                soft_nodes: 0,
                cohesive_nodes: 0,
                adhesive_energy: 0.0,
                dissipated,
                work: 0.0,
            });
        let branch: AdhesiveBranch = states.collect();
        assert_eq!((branch.pull_off(), branch.dissipated()), (5.0, 0.25));
        let loads = [1.0, 2.0, 3.0, 4.0, 5.0].map(|approach| branch.load_at(approach));
        assert_eq!(loads, [0.0, -1.0, -2.0, -2.0, 1.0].map(Some));
        let approaches = [0.0, -1.0, -2.0, -5.0, 1.0].map(|load| branch.approach_at(load));
        assert_eq!(approaches, [1.0, 2.0, 3.0, 3.0, 5.0].map(Some));
        // Within the jump there is no state, and it comes later.
        assert_eq!(branch.approach_at(-3.5), Some(3.5));
        assert_eq!((branch.load_at(0.5), branch.approach_at(2.0)), (None, None));
        assert_eq!(AdhesiveBranch::default().pull_off(), 0.0);
        Ok(())
    }
}
