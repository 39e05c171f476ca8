//! The answer, and how exact it is.

use nalgebra::DMatrix;

use super::level::Level;
use crate::contact::{Certificate, Conditions, ContactState, PlasticState};
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
    /// Scalars of the state.
    pub state: ContactState,
    /// Pressure `p ≥ 0` \[Pa\], nx × ny.
    pub pressure: DMatrix<f64>,
    /// Gap `g + u − δ` \[m\], in contact zero to within the tolerance.
    pub gap: DMatrix<f64>,
    /// Displacement of the half-space `u = C p` \[m\], positive into it; about its mean if the
    /// half-space is periodic and its mean displacement arbitrary.
    pub displacement: DMatrix<f64>,
    /// Which nodes are in contact: those with pressure or a closed gap.
    pub contact_map: DMatrix<bool>,
    /// Pressure per unit of load \[1/m²\], the exact derivative on further loading of the nodes in
    /// contact, `dp/dW = y₂ / (ΔA Σ y₂)` with `y₂ = C_II⁻¹ e` on the contact set I. Empty if stiffnesses
    /// were not asked for.
    pub pressure_rate: DMatrix<f64>,
    /// How well the conditions of contact are met. Gaps there are relative to
    /// [`Certificate::length`], which is never less than what the tolerance is relative to.
    pub certificate: Certificate,
    /// The effort.
    pub effort: SolverEffort,
    /// Nodes that have yielded, with a [hardness](super::FixedLoadBuilder::hardness); `None` without one.
    pub plastic: Option<Plastic>,
}

/// Nodes whose pressure is their hardness, and what stays of them in the surface.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Plastic {
    /// Which nodes have yielded, nx × ny; all of them are in contact.
    pub yielded_map: DMatrix<bool>,
    /// Plastic depth \[m\], nx × ny: the elastic overlap of yielded nodes, 0 elsewhere. Less it, the surface presses into the
    /// half-space elastically on unloading and reloading, up to this state.
    pub depth: DMatrix<f64>,
    /// Area of yielded nodes \[m²\].
    pub area: f64,
    /// Sum of the plastic depth over the area \[m³\].
    pub volume: f64,
    /// Energy that is lost, H times the volume where H is the same everywhere \[J\]. The energy of the state is elastic.
    pub work: f64,
}

impl Plastic {
    /// Number of nodes that have yielded.
    #[must_use]
    pub fn yielded_nodes(&self) -> usize {
        self.yielded_map.iter().filter(|has_yielded| **has_yielded).count()
    }

    /// The scalars; rates are those of a tangent.
    fn state(&self, grid: &Grid) -> PlasticState {
        PlasticState {
            yielded_nodes: self.yielded_nodes(),
            yielded_area_fraction: self.yielded_nodes() as f64 / grid.nodes() as f64,
            volume: self.volume,
            work: self.work,
            ..PlasticState::default()
        }
    }

    fn new(grid: &Grid, pressure: &[f64], yielded: &[bool], depth: Vec<f64>) -> Self {
        let (nx, ny) = grid.shape();
        let cell_area = grid.cell_area();
        let count = yielded.iter().filter(|has_yielded| **has_yielded).count();
        Self {
            yielded_map: DMatrix::from_column_slice(nx, ny, yielded),
            area: count as f64 * cell_area,
            volume: cell_area * sum(&depth),
            work: cell_area * dot(pressure, &depth),
            depth: DMatrix::from_vec(nx, ny, depth),
        }
    }
}

/// The effort of a solution.
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
    /// Greatest pressure \[Pa\].
    #[must_use]
    pub fn max_pressure(&self) -> f64 {
        self.pressure.max()
    }

    /// Number of nodes with pressure. It is less than that of nodes in contact where some touch or leave
    /// at this very load, to within rounding, which then decides how many of them are counted.
    pub(super) fn carrying_nodes(&self) -> usize {
        self.pressure.iter().filter(|p| **p > 0.0).count()
    }

    /// `Ok` if everything is finite; the interfacial stiffness of full contact need not be.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] and [`Error::FieldNotFinite`] otherwise.
    pub(super) fn check_finite(&self, grid: &Grid) -> Result<(), Error> {
        let fields = [
            ("pressure", &self.pressure),
            ("displacement", &self.displacement),
            ("pressure rate", &self.pressure_rate),
        ];
        for (field, values) in fields {
            // Without stiffnesses there is no rate.
            if !values.is_empty() {
                grid.check_finite(field, values)?;
            }
        }
        if self.state.is_finite() {
            return Ok(());
        }
        Err(Error::OutOfRange {
            quantity: "approach of a solution",
            value: self.state.approach,
            expected: "finite, as all of its state",
        })
    }

    /// The solution that `level` holds, without stiffnesses; its load is `load` if that was
    /// prescribed, else that of the pressure.
    ///
    /// With a hardness, that of each node and which have yielded. These overlap by their plastic depth, which is no gap.
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
        let plastic = yielded.map(|(_, yielded)| {
            let mut depth = vec![0.0; nodes];
            for ((depth, gap), has_yielded) in depth.iter_mut().zip(&mut gap).zip(yielded) {
                if *has_yielded {
                    // What rounds is none.
                    (*depth, *gap) = ((-*gap).max(0.0), 0.0);
                }
            }
            Plastic::new(&level.grid, &level.iterate.pressure, yielded, depth)
        });
        let displacements = total_gap.iter().zip(&level.gap).map(|(c, g)| c - g);
        let displacement = DMatrix::from_iterator(nx, ny, displacements);
        let contact_map = pressure.zip_map(&gap, |p, gap| p > 0.0 || gap <= 0.0);

        let (p, gaps) = (pressure.as_slice(), gap.as_slice());
        let in_contact = contact_map.as_slice();
        let contact_nodes = in_contact.iter().filter(|is_in| **is_in).count();
        // Gaps in contact are closed to within the tolerance: left out, full contact is exact.
        let open = |node: usize| if in_contact[node] { 0.0 } else { gaps[node] };
        let load = load.unwrap_or(cell_area * sum(p));
        let state = ContactState {
            contact_nodes,
            approach,
            load,
            contact_area: contact_nodes as f64 * cell_area,
            contact_area_fraction: contact_nodes as f64 / nodes as f64,
            mean_gap: sum_over(nodes, open) / nodes as f64,
            contact_stiffness: None,
            interfacial_stiffness: None,
            energy: 0.5 * cell_area * dot(p, displacement.as_slice()),
            plastic: plastic.as_ref().map(|plastic| plastic.state(&level.grid)),
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
            state,
            pressure,
            gap,
            displacement,
            contact_map,
            pressure_rate: DMatrix::zeros(0, 0),
            certificate,
            effort,
            plastic,
        }
    }

    /// The surface \[m\] with its plastic depth taken off: on unloading, and on loading up to this state again, its contact is
    /// elastic. Without a hardness it is the surface itself.
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] for a surface of another grid.
    pub fn residual_surface(&self, surface: &HeightMap) -> Result<HeightMap, Error> {
        let Some(plastic) = &self.plastic else {
            return Ok(surface.clone());
        };
        let heights = surface.matrix();
        if heights.shape() != plastic.depth.shape() {
            return Err(Error::GridMismatch {
                expected: plastic.depth.shape(),
                found: heights.shape(),
            });
        }
        Ok(HeightMap::new(heights - &plastic.depth)?)
    }

    /// Whether a node is in contact and has not yielded.
    pub(super) fn is_elastic(&self, node: usize) -> bool {
        let has_yielded = self.plastic.as_ref().is_some_and(|p| p.yielded_map.as_slice()[node]);
        self.contact_map.as_slice()[node] && !has_yielded
    }
}

/// A solution as plain data.
#[cfg(feature = "serde")]
mod parts {
    use nalgebra::{DMatrix, Scalar};
    use serde::{Deserialize, Serialize};

    use super::{FixedLoadSolution, Plastic, SolverEffort};
    use crate::Error;
    use crate::contact::{Certificate, ContactState};

    /// The parts of a solution; fields have x fast.
    #[derive(Debug, Clone, Serialize, Deserialize)]
    pub(super) struct Parts {
        /// Nodes along x and y.
        shape: (usize, usize),
        state: ContactState,
        pressure: Vec<f64>,
        gap: Vec<f64>,
        displacement: Vec<f64>,
        contact_map: Vec<bool>,
        /// Empty if stiffnesses were not asked for.
        pressure_rate: Vec<f64>,
        certificate: Certificate,
        effort: SolverEffort,
        /// Of a solution with a hardness.
        #[serde(default)]
        plastic: Option<PlasticParts>,
    }

    /// The parts of what has yielded.
    #[derive(Debug, Clone, Serialize, Deserialize)]
    struct PlasticParts {
        yielded_map: Vec<bool>,
        depth: Vec<f64>,
        area: f64,
        volume: f64,
        work: f64,
    }

    impl From<FixedLoadSolution> for Parts {
        fn from(solution: FixedLoadSolution) -> Self {
            Self {
                shape: solution.pressure.shape(),
                state: solution.state,
                pressure: solution.pressure.data.into(),
                gap: solution.gap.data.into(),
                displacement: solution.displacement.data.into(),
                contact_map: solution.contact_map.data.into(),
                pressure_rate: solution.pressure_rate.data.into(),
                certificate: solution.certificate,
                effort: solution.effort,
                plastic: solution.plastic.map(|plastic| {
                    let Plastic { yielded_map, depth, area, volume, work } = plastic;
                    let (yielded_map, depth) = (yielded_map.data.into(), depth.data.into());
                    PlasticParts { yielded_map, depth, area, volume, work }
                }),
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
            let mut state = parts.state;
            let pressure_rate = if parts.pressure_rate.is_empty() {
                DMatrix::zeros(0, 0)
            } else {
                state.restore_infinity();
                matrix(parts.shape, parts.pressure_rate)?
            };
            Ok(Self {
                state,
                pressure: matrix(parts.shape, parts.pressure)?,
                gap: matrix(parts.shape, parts.gap)?,
                displacement: matrix(parts.shape, parts.displacement)?,
                contact_map: matrix(parts.shape, parts.contact_map)?,
                pressure_rate,
                certificate: parts.certificate,
                effort: parts.effort,
                plastic: match parts.plastic {
                    None => None,
                    Some(plastic) => Some(Plastic {
                        yielded_map: matrix(parts.shape, plastic.yielded_map)?,
                        depth: matrix(parts.shape, plastic.depth)?,
                        area: plastic.area,
                        volume: plastic.volume,
                        work: plastic.work,
                    }),
                },
            })
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
