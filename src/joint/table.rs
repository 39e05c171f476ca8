//! The laws of an interface as a short table.

use super::conduction::stiffnesses;
use super::{Carrier, Conduction};
use crate::kernel::Theory;
use crate::loading::History;
use crate::{BedError, ContactState, Error, JointError, LoadingState};

/// Below this part of the greatest pressure errors are absolute.
const SMALL: f64 = 1e-3;

/// The quantity whose small values have an absolute error.
const PRESSURE: &str = "pressure";

/// By which part of itself a number of a table rises at least from row to row: it prints as another one in thirteen
/// digits.
const RISE: f64 = 1e-11;

/// An interface under one pressure, per nominal area.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct InterfaceRow {
    /// Mean pressure \[Pa\].
    pub pressure: f64,
    /// Overclosure \[m\]: what the mean gap has closed since first touch.
    pub overclosure: f64,
    /// Conductance per area \[W/(m² K), S/m²\] of the interface, if conduction was asked for.
    pub conductance: Option<f64>,
    /// Tangential stiffness per area before any slip \[Pa/m\], if friction was asked for.
    pub tangential_stiffness: Option<f64>,
    /// Shear stress at which the interface slides \[Pa\], μ times the pressure.
    pub slip_limit: Option<f64>,
}

impl InterfaceRow {
    /// What is interpolated, with its name and over what: pressure over overclosure; the others over the pressure, and
    /// over the overclosure too, which is how they follow from a pressure that is interpolated itself.
    fn values(&self) -> [(&'static str, f64, Option<f64>); 5] {
        let [over_gap, over_pressure] = [self.overclosure, self.pressure];
        let (conductance, tangential) = ("conductance", "tangential stiffness");
        [
            (PRESSURE, over_gap, Some(self.pressure)),
            (conductance, over_pressure, self.conductance),
            (conductance, over_gap, self.conductance),
            (tangential, over_pressure, self.tangential_stiffness),
            (tangential, over_gap, self.tangential_stiffness),
        ]
    }
}

/// Coulomb friction of an interface.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Friction {
    coefficient: f64,
    compliance_ratio: f64,
}

/// The laws of an interface: pressure over overclosure, and over the pressure conductance, tangential stiffness and
/// slip limit.
///
/// It is the interface alone, for a finite element model whose bodies are flat there: what the mean gap closes, and the
/// interfacial stiffness $`K_i`$ on either half-space. Bulk deformation, and the constriction into the nominal area,
/// are the model's own.
///
/// Rows are states of the path, in strictly rising order of pressure and overclosure: where one of them stays, as the
/// pressure on a plateau of nodes that have all yielded, it is raised by 10⁻¹¹ of itself. Of all states so many are
/// left out that linear interpolation between the rows is wrong by no more than the tolerance at any of them: relative
/// to the value, and for pressures below a thousandth of the greatest one relative to that. In full contact, where the
/// interface is rigid, the table ends.
///
/// That holds for conductances and tangential stiffnesses over the pressure, and over the overclosure by way of the
/// pressure that the table gives. Only at exactly the pressure of a plateau they are those of any place on it.
///
/// Conductance and tangential stiffness are those of all nodes in contact, also of those that have yielded: see
/// [`Conduction::of`].
#[derive(Debug, Clone, PartialEq)]
pub struct InterfaceTable {
    rows: Vec<InterfaceRow>,
    tolerance: f64,
    carrier: Option<Carrier>,
    friction: Option<Friction>,
}

/// What is to be in an [`InterfaceTable`].
#[derive(Debug, Clone)]
#[must_use]
pub struct InterfaceTableBuilder<'a> {
    history: &'a History,
    conduction: Option<Conduction>,
    friction: Option<Friction>,
    tolerance: f64,
}

impl<'a> InterfaceTableBuilder<'a> {
    /// Adds conductances.
    pub fn conduction(mut self, conduction: Conduction) -> Self {
        self.conduction = Some(conduction);
        self
    }

    /// Adds tangential stiffness and slip limit, with the coefficient of friction μ and the ratio κ = E\*/G\* of
    /// tangential to normal compliance: the stiffness is $`K_i / \kappa`$. Of bodies of one material, and of a rigid
    /// one against ν, κ = (2 − ν) / (2 (1 − ν)): 1.21 for ν = 0.3.
    pub fn friction(mut self, coefficient: f64, compliance_ratio: f64) -> Self {
        self.friction = Some(Friction { coefficient, compliance_ratio });
        self
    }

    /// Greatest relative error of interpolation (default: 0.01).
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// The table.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for tolerance, friction and compliance ratio; [`Error::OutOfRange`] for a tolerance of 1
    /// and more, for a path with fewer than two rows, and for stiffnesses that are negative or NaN;
    /// [`BedError::NotFromFirstTouch`]; [`JointError::NoFunction`] where the mean gap opens so much under a greater load
    /// that the law is no function of the overclosure; [`JointError::NoUnloadingStiffness`] if nodes have yielded, and
    /// conductances or tangential stiffnesses are asked for without the stiffness of [`Conduction::of`];
    /// [`Error::NotHomogeneous`] for these on layers.
    pub fn build(self) -> Result<InterfaceTable, Error> {
        let tolerance = Error::require_positive("tolerance of the table", self.tolerance)?;
        Error::require("tolerance of the table", tolerance, tolerance < 1.0, "below 1")?;
        if let Some(friction) = self.friction {
            Error::require_positive("coefficient of friction", friction.coefficient)?;
            Error::require_positive("compliance ratio", friction.compliance_ratio)?;
        }
        if self.friction.is_some() {
            self.history.layering().check(Theory::TangentialStiffness)?;
        }
        let Points { rising, others, .. } = self.points()?;
        let count = rising.len();
        let is_one = count > 1;
        Error::require(
            "number of states with their own pressure",
            count as f64,
            is_one,
            "two or more",
        )?;
        let rows = thinned(&rising, tolerance);
        others.iter().try_for_each(|(step, row)| check_between(&rows, *step, row, tolerance))?;
        Ok(InterfaceTable {
            rows,
            tolerance,
            carrier: self.conduction.map(|conduction| conduction.carrier()),
            friction: self.friction,
        })
    }

    /// The states of the path as rows.
    fn points(&self) -> Result<Points, Error> {
        let states = self.history.states();
        // Overclosures are from first touch on.
        let first = states.first().map(|state| state.contact);
        if let Some(ContactState { load, approach, .. }) = first.filter(|first| first.load > 0.0) {
            return Err(BedError::NotFromFirstTouch { load, approach }.into());
        }
        let unloaded = first.map_or(0.0, |first| first.mean_gap);
        let mut points = Points::default();
        for state in states {
            if let Some(row) = self.row(state, unloaded)? {
                points.add(state.step, row);
            }
        }
        Ok(points)
    }

    /// The row of a state, `None` where it has no finite stiffness.
    fn row(&self, state: &LoadingState, unloaded: f64) -> Result<Option<InterfaceRow>, Error> {
        let contact = &state.contact;
        if !contact.interfacial_stiffness.is_some_and(f64::is_finite) {
            return Ok(None);
        }
        let area = contact.nominal_area;
        let pressure = contact.mean_pressure();
        let conductance = match &self.conduction {
            Some(conduction) => {
                conduction.of_interface(contact, self.history.layering())?.map(|whole| whole / area)
            }
            None => None,
        };
        let tangential_stiffness = match self.friction {
            Some(friction) => {
                let [_, stiffness] = stiffnesses(contact)?;
                if let Some(stiffness) = stiffness {
                    let is_one = stiffness >= 0.0;
                    Error::require("interfacial stiffness", stiffness, is_one, "not negative")?;
                }
                stiffness.map(|stiffness| stiffness / friction.compliance_ratio / area)
            }
            None => None,
        };
        Ok(Some(InterfaceRow {
            pressure,
            overclosure: unloaded - contact.mean_gap,
            conductance,
            tangential_stiffness,
            slip_limit: self.friction.map(|f| f.coefficient * pressure),
        }))
    }
}

/// The states of a path as rows of a table.
#[derive(Debug, Default)]
struct Points {
    /// In strictly rising order of overclosure and pressure, also in print.
    rising: Vec<InterfaceRow>,
    /// What the last one of them had before it was raised.
    last: [f64; 2],
    /// Those at which overclosure or pressure falls, with the numbers of their events.
    others: Vec<(usize, InterfaceRow)>,
}

impl Points {
    /// Adds the row of a state.
    fn add(&mut self, step: usize, row: InterfaceRow) {
        let place = [row.overclosure, row.pressure];
        let Some(last) = self.rising.last_mut() else {
            (self.rising, self.last) = (vec![row], place);
            return;
        };
        if place == self.last {
            // Nodes that touch at once: the last of them has the stiffness of all.
            *last = InterfaceRow { overclosure: last.overclosure, pressure: last.pressure, ..row };
            return;
        }
        // On a plateau of nodes that have all yielded the pressure stays what it is. What falls by so little is
        // rounding.
        let risen = |raised: f64, before: f64, now: f64| {
            let value = now.max(raised * (1.0 + RISE));
            (now >= before * (1.0 - RISE) && value > raised).then_some(value)
        };
        let overclosure = risen(last.overclosure, self.last[0], row.overclosure);
        match (overclosure, risen(last.pressure, self.last[1], row.pressure)) {
            (Some(overclosure), Some(pressure)) => {
                self.rising.push(InterfaceRow { overclosure, pressure, ..row });
                self.last = place;
            }
            _ => self.others.push((step, row)),
        }
    }
}

impl InterfaceTable {
    /// The same table with other rows.
    pub(super) fn map_rows(&self, map: impl Fn(&InterfaceRow) -> InterfaceRow) -> Self {
        Self { rows: self.rows.iter().map(map).collect(), ..*self }
    }

    /// A table of the states of a path from first touch on.
    pub fn builder(history: &History) -> InterfaceTableBuilder<'_> {
        InterfaceTableBuilder { history, conduction: None, friction: None, tolerance: 0.01 }
    }

    /// The rows, in the order of pressure.
    #[must_use]
    pub fn rows(&self) -> &[InterfaceRow] {
        &self.rows
    }

    /// Greatest relative error of interpolation.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// What its conductances are of.
    #[must_use]
    pub fn carrier(&self) -> Option<Carrier> {
        self.carrier
    }

    /// The coefficient of friction.
    #[must_use]
    pub fn friction(&self) -> Option<f64> {
        self.friction.map(|friction| friction.coefficient)
    }
}

/// The value at a place on the line through two points.
fn on_line((x0, y0): (f64, f64), (x1, y1): (f64, f64), x: f64) -> f64 {
    y0 + (y1 - y0) * ((x - x0) / (x1 - x0))
}

/// What a number of a table is divided by for its relative error.
fn scale(quantity: &str, value: f64, greatest: f64) -> f64 {
    if quantity == PRESSURE { value.max(SMALL * greatest) } else { value }
}

/// The error of interpolation at a row between two others, over the one that is allowed.
fn error(
    before: &InterfaceRow,
    row: &InterfaceRow,
    after: &InterfaceRow,
    [tolerance, greatest]: [f64; 2],
) -> f64 {
    let ends = before.values().into_iter().zip(after.values());
    let errors = ends.zip(row.values()).map(|(((_, x0, y0), (_, x1, y1)), (quantity, x, y))| {
        let (Some(y0), Some(y1), Some(y)) = (y0, y1, y) else {
            return 0.0;
        };
        let found = on_line((x0, y0), (x1, y1), x);
        (found - y).abs() / (tolerance * scale(quantity, y, greatest))
    });
    errors.fold(0.0, f64::max)
}

/// The error of a table at a state that is no row of it, and may lie anywhere between two.
fn check_between(
    rows: &[InterfaceRow],
    step: usize,
    row: &InterfaceRow,
    tolerance: f64,
) -> Result<(), Error> {
    let greatest = rows.last().map_or(0.0, |row| row.pressure);
    for (k, (quantity, x, value)) in row.values().into_iter().enumerate() {
        let after = rows.partition_point(|other| other.values()[k].1 < x).clamp(1, rows.len() - 1);
        let ends = [&rows[after - 1], &rows[after]].map(|end| end.values()[k]);
        let ([(_, x0, Some(y0)), (_, x1, Some(y1))], Some(value)) = (ends, value) else {
            continue;
        };
        let interpolated = on_line((x0, y0), (x1, y1), x);
        // NaN as well.
        let is_near = (interpolated - value).abs() <= tolerance * scale(quantity, value, greatest);
        if !is_near {
            return Err(
                JointError::NoFunction { step, quantity, value, interpolated, tolerance }.into()
            );
        }
    }
    Ok(())
}

/// The rows that interpolation needs: the two ends, and always the one between two others at which the error is
/// greatest, until none is too large (Ramer, Douglas and Peucker).
fn thinned(all: &[InterfaceRow], tolerance: f64) -> Vec<InterfaceRow> {
    let greatest = all.last().map_or(0.0, |row| row.pressure);
    let mut kept = vec![false; all.len()];
    let mut waiting = vec![(0, all.len() - 1)];
    while let Some((first, last)) = waiting.pop() {
        kept[first] = true;
        kept[last] = true;
        let mut worst = (1.0, None);
        for place in first + 1..last {
            let error = error(&all[first], &all[place], &all[last], [tolerance, greatest]);
            if error > worst.0 {
                worst = (error, Some(place));
            }
        }
        if let (_, Some(place)) = worst {
            waiting.extend([(first, place), (place, last)]);
        }
    }
    all.iter().zip(kept).filter(|(_, kept)| *kept).map(|(row, _)| *row).collect()
}
