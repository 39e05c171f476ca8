//! The answer, and how exact it is.

use nalgebra::DMatrix;

use super::level::Level;
use crate::contact::{Certificate, Conditions, ContactFields, ContactState, PlasticState};
use crate::krylov::{dot, sum, sum_over};
use crate::{Error, Grid, HeightMap};

/// Contact under one load: fields and scalars.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "parts::Parts", into = "parts::Parts")
)]
#[non_exhaustive]
pub struct FixedLoadSolution {
    /// Scalars of the contact.
    pub contact: ContactState,
    /// Its fields; in contact are nodes with pressure or a closed gap.
    pub fields: ContactFields,
    /// Pressure per unit of load \[1/m²\], the exact derivative on further loading of the nodes in
    /// contact, `dp/dW = y₂ / (ΔA Σ y₂)` with `y₂ = C_II⁻¹ e` on the contact set I. Empty if stiffnesses
    /// were not asked for.
    pub pressure_rate: DMatrix<f64>,
    /// How well the conditions of contact are met. Gaps there are relative to
    /// [`Certificate::length`], which is never less than what the tolerance is relative to.
    pub certificate: Certificate,
    /// The effort.
    pub effort: SolverEffort,
}

/// The effort of a solution; where its load was searched for, of the last step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct SolverEffort {
    /// Steps of conjugate gradients on the finest grid, for the pressure.
    pub iterations: usize,
    /// The same for the stiffness.
    pub stiffness_iterations: usize,
    /// Convolutions on the finest grid, for pressure and stiffness.
    pub convolutions: usize,
    /// Convolutions on coarser grids, each counted as its part of the nodes of the finest.
    pub coarse_convolutions: f64,
}

impl FixedLoadSolution {
    /// Number of nodes with pressure. It is less than that of nodes in contact where some touch or leave
    /// at this very load, to within rounding, which then decides how many of them are counted.
    pub(super) fn carrying_nodes(&self) -> usize {
        self.fields.pressure.iter().filter(|p| **p > 0.0).count()
    }

    /// `Ok` if everything is finite; the interfacial stiffness of full contact need not be.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] and [`Error::FieldNotFinite`] otherwise.
    pub(super) fn check_finite(&self, grid: &Grid) -> Result<(), Error> {
        let fields = [
            ("pressure", &self.fields.pressure),
            ("displacement", &self.fields.displacement),
            ("pressure rate", &self.pressure_rate),
        ];
        for (field, values) in fields {
            // Without stiffnesses there is no rate.
            if !values.is_empty() {
                grid.check_finite(field, values)?;
            }
        }
        match self.contact.not_finite() {
            None => Ok(()),
            Some((quantity, value)) => {
                Err(Error::OutOfRange { quantity, value, expected: "finite, as all of a state" })
            }
        }
    }

    /// The solution that `level` holds, without stiffnesses; its load is `load` if that was
    /// prescribed, else that of the pressure.
    ///
    /// With a hardness, that of each node and which have yielded. These overlap by their plastic depth, which is no
    /// gap.
    pub(super) fn of(
        level: &Level,
        load: Option<f64>,
        effort: SolverEffort,
        yielded: Option<(&[f64], &[bool])>,
    ) -> Self {
        let (nx, ny) = level.grid.shape();
        let nodes = level.grid.nodes();
        let cell_area = level.grid.cell_area();
        let (approach, total_gap) = (level.iterate.approach, &level.iterate.total_gap);
        let pressure = DMatrix::from_column_slice(nx, ny, &level.iterate.pressure);
        let mut gap = DMatrix::from_iterator(nx, ny, total_gap.iter().map(|c| c - approach));
        let mut yielded_map = DMatrix::from_element(nx, ny, false);
        let mut plastic_depth = DMatrix::zeros(nx, ny);
        if let Some((_, yielded)) = yielded {
            yielded_map.as_mut_slice().copy_from_slice(yielded);
            for ((depth, gap), has_yielded) in plastic_depth.iter_mut().zip(&mut gap).zip(yielded) {
                if *has_yielded {
                    // What rounds is none.
                    (*depth, *gap) = ((-*gap).max(0.0), 0.0);
                }
            }
        }
        let displacements = total_gap.iter().zip(&level.gap).map(|(c, g)| c - g);
        let displacement = DMatrix::from_iterator(nx, ny, displacements);
        let contact_map = pressure.zip_map(&gap, |p, gap| p > 0.0 || gap <= 0.0);

        let (p, gaps) = (pressure.as_slice(), gap.as_slice());
        let in_contact = contact_map.as_slice();
        let contact_nodes = in_contact.iter().filter(|is_in| **is_in).count();
        // Gaps in contact are closed to within the tolerance: left out, full contact is exact.
        let open = |node: usize| if in_contact[node] { 0.0 } else { gaps[node] };
        let load = load.unwrap_or(cell_area * sum(p));
        let plastic = yielded.map(|(_, yielded)| {
            let (count, depth) =
                (yielded.iter().filter(|it| **it).count(), plastic_depth.as_slice());
            PlasticState {
                yielded_nodes: count,
                yielded_area_fraction: count as f64 / nodes as f64,
                volume: cell_area * sum(depth),
                work: cell_area * dot(p, depth),
                ..PlasticState::default()
            }
        });
        let mean_gap = sum_over(nodes, open) / nodes as f64;
        let contact = ContactState {
            energy: 0.5 * cell_area * dot(p, displacement.as_slice()),
            plastic,
            ..ContactState::new(&level.grid, contact_nodes, approach, load, mean_gap)
        };
        let conditions = Conditions::new(load / cell_area, approach, level.scale);
        let certificate =
            conditions.check((0..nodes).map(|node| (p[node], gaps[node], in_contact[node])));
        let certificate = match yielded {
            Some((hardness, _)) => {
                certificate.with_hardness(p.iter().copied().zip(hardness.iter().copied()))
            }
            None => certificate,
        };
        Self {
            contact,
            fields: ContactFields {
                pressure,
                gap,
                displacement,
                contact_map,
                yielded_map,
                plastic_depth,
            },
            pressure_rate: DMatrix::zeros(0, 0),
            certificate,
            effort,
        }
    }

    /// The surface \[m\] with its plastic depth taken off: on unloading, and on loading up to this state again, its
    /// contact is elastic. Without a hardness it is the surface itself.
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] for a surface of another grid.
    pub fn residual_surface(&self, surface: &HeightMap) -> Result<HeightMap, Error> {
        let (heights, depth) = (surface.matrix(), &self.fields.plastic_depth);
        if heights.shape() != depth.shape() {
            return Err(Error::GridMismatch { expected: depth.shape(), found: heights.shape() });
        }
        Ok(HeightMap::new(heights - depth)?)
    }

    /// Whether a node is in contact and has not yielded.
    pub(super) fn is_elastic(&self, node: usize) -> bool {
        let ContactFields { contact_map, yielded_map, .. } = &self.fields;
        contact_map.as_slice()[node] && !yielded_map.as_slice()[node]
    }
}

/// A solution as plain data.
#[cfg(feature = "serde")]
mod parts {
    use nalgebra::{DMatrix, Scalar};
    use serde::{Deserialize, Serialize};

    use super::{FixedLoadSolution, SolverEffort};
    use crate::Error;
    use crate::contact::{Certificate, ContactFields, ContactState};

    /// The parts of a solution; fields have x fast.
    #[derive(Debug, Clone, Serialize, Deserialize)]
    pub(super) struct Parts {
        /// Nodes along x and y.
        shape: (usize, usize),
        contact: ContactState,
        pressure: Vec<f64>,
        gap: Vec<f64>,
        displacement: Vec<f64>,
        contact_map: Vec<bool>,
        yielded_map: Vec<bool>,
        plastic_depth: Vec<f64>,
        /// Empty if stiffnesses were not asked for.
        pressure_rate: Vec<f64>,
        certificate: Certificate,
        effort: SolverEffort,
    }

    impl From<FixedLoadSolution> for Parts {
        fn from(solution: FixedLoadSolution) -> Self {
            let FixedLoadSolution { contact, fields, pressure_rate, certificate, effort } =
                solution;
            Self {
                shape: fields.pressure.shape(),
                contact,
                pressure: fields.pressure.data.into(),
                gap: fields.gap.data.into(),
                displacement: fields.displacement.data.into(),
                contact_map: fields.contact_map.data.into(),
                yielded_map: fields.yielded_map.data.into(),
                plastic_depth: fields.plastic_depth.data.into(),
                pressure_rate: pressure_rate.data.into(),
                certificate,
                effort,
            }
        }
    }

    impl TryFrom<Parts> for FixedLoadSolution {
        type Error = Error;

        fn try_from(parts: Parts) -> Result<Self, Error> {
            let (nx, ny) = parts.shape;
            if nx == 0 || ny == 0 {
                return Err(crate::SurfaceError::EmptyGrid { nx, ny }.into());
            }
            let mut contact = parts.contact;
            let pressure_rate = if parts.pressure_rate.is_empty() {
                DMatrix::zeros(0, 0)
            } else {
                contact.restore_infinity();
                matrix(parts.shape, parts.pressure_rate)?
            };
            let fields = ContactFields {
                pressure: matrix(parts.shape, parts.pressure)?,
                gap: matrix(parts.shape, parts.gap)?,
                displacement: matrix(parts.shape, parts.displacement)?,
                contact_map: matrix(parts.shape, parts.contact_map)?,
                yielded_map: matrix(parts.shape, parts.yielded_map)?,
                plastic_depth: matrix(parts.shape, parts.plastic_depth)?,
            };
            let Parts { certificate, effort, .. } = parts;
            Ok(Self { contact, fields, pressure_rate, certificate, effort })
        }
    }

    /// A field of one value for each node.
    fn matrix<T: Scalar>((nx, ny): (usize, usize), values: Vec<T>) -> Result<DMatrix<T>, Error> {
        let expected = nx.saturating_mul(ny);
        if values.len() != expected {
            return Err(Error::LengthMismatch { expected, found: values.len() });
        }
        Ok(DMatrix::from_vec(nx, ny, values))
    }
}
