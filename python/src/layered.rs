//! Bodies of layers.

use asperity::kernel::{Base, KernelOrigin, Layer, Layered, LayeredBody};
use asperity::{Boundary, Error, Grid};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::choice::choose;
use crate::errors::{Failure, Fallible};
use crate::half_space::Kernel;
use crate::materials;

/// What surrounds a layered body, and what its pressure is between nodes.
#[derive(Clone, Copy, PartialEq)]
enum Surroundings {
    Free,
    Love,
    Spectral,
}

const SURROUNDINGS: [(&str, Surroundings); 3] = [
    ("free", Surroundings::Free),
    ("love", Surroundings::Love),
    ("spectral", Surroundings::Spectral),
];

/// A layered body before it has a grid.
#[derive(Clone)]
pub(crate) struct Layers {
    body: LayeredBody,
    surroundings: Surroundings,
}

/// A body by numbers or a name, or a word of its own.
#[derive(FromPyObject)]
pub(crate) enum Lowest {
    #[pyo3(transparent)]
    Numbers((f64, f64)),
    #[pyo3(transparent)]
    Word(String),
}

/// A body as plain values: layers, the base unless it is rigid, the modulus of the other body, and the boundary.
pub(crate) type Parts = (Vec<(f64, f64, f64)>, Option<(f64, f64)>, Option<f64>, String);

impl Layers {
    /// From the arguments of `HalfSpace.layered`.
    pub(crate) fn of(
        layers: &[(f64, f64, f64)],
        base: &Lowest,
        against: Option<&materials::Body>,
        boundary: &str,
    ) -> Fallible<Self> {
        let base = match base {
            Lowest::Numbers(numbers) => Some(*numbers),
            Lowest::Word(word) if word == "rigid" => None,
            Lowest::Word(name) => Some(materials::Body::Named(name.clone()).numbers()?),
        };
        let against = match against {
            Some(body) => {
                let (young, poisson) = body.numbers()?;
                Some(asperity::plane_strain_modulus(young, poisson)?)
            }
            None => None,
        };
        Self::of_parts(&(layers.to_vec(), base, against, boundary.to_string()))
    }

    /// From plain values.
    pub(crate) fn of_parts((layers, base, against, boundary): &Parts) -> Fallible<Self> {
        let surroundings = choose("boundary", boundary, &SURROUNDINGS)?;
        let layers: Vec<Layer> = layers
            .iter()
            .map(|&(young, poisson, thickness)| Layer { young, poisson, thickness })
            .collect();
        let base = base.map_or(Base::Rigid, |(young, poisson)| Base::HalfSpace { young, poisson });
        let body = LayeredBody::new(&layers, base)?;
        let body = match against {
            Some(modulus) => body.against(*modulus)?,
            None => body,
        };
        Ok(Self { body, surroundings })
    }

    /// The body of a kernel.
    pub(crate) fn of_origin(origin: &KernelOrigin) -> Option<Self> {
        let (body, surroundings) = match origin {
            KernelOrigin::Layered { body } => (body, Surroundings::Free),
            KernelOrigin::PeriodicLayered { body } => (body, Surroundings::Love),
            KernelOrigin::SpectralLayered { body } => (body, Surroundings::Spectral),
            _ => return None,
        };
        Some(Self { body: body.clone(), surroundings })
    }

    pub(crate) fn parts(&self) -> Parts {
        let layers = self.body.layers().iter();
        let layers = layers.map(|layer| (layer.young, layer.poisson, layer.thickness)).collect();
        let base = match self.body.base() {
            Base::Rigid => None,
            Base::HalfSpace { young, poisson } => Some((young, poisson)),
        };
        (layers, base, self.body.counterpart(), self.word().to_string())
    }

    pub(crate) fn word(&self) -> &'static str {
        let mut known = SURROUNDINGS.iter();
        known.find(|(_, s)| *s == self.surroundings).map_or("", |(word, _)| *word)
    }

    pub(crate) fn boundary(&self) -> Boundary {
        match self.surroundings {
            Surroundings::Free => Boundary::Free,
            Surroundings::Love | Surroundings::Spectral => Boundary::Periodic,
        }
    }

    pub(crate) fn surface_modulus(&self) -> f64 {
        self.body.surface_modulus()
    }

    /// Ĉ(q) of each wave number.
    pub(crate) fn compliance(&self, waves: &[f64]) -> Vec<f64> {
        waves.iter().map(|&q| self.body.compliance(q)).collect()
    }

    pub(crate) fn kernel(&self, grid: Grid) -> Result<Kernel, Error> {
        let body = self.body.clone();
        let kernel = match self.surroundings {
            Surroundings::Free => Layered::free(grid, body)?,
            Surroundings::Love => Layered::periodic(grid, body)?,
            Surroundings::Spectral => Layered::spectral(grid, body)?,
        };
        Ok(Box::new(kernel))
    }

    /// As Python writes it.
    pub(crate) fn repr(&self, py: Python<'_>) -> Fallible<String> {
        let (layers, base, against, boundary) = self.parts();
        let words = PyDict::new(py);
        words.set_item("layers", layers)?;
        match base {
            None => words.set_item("base", "rigid")?,
            Some(numbers) => words.set_item("base", numbers)?,
        }
        words.set_item("boundary", boundary)?;
        let word = |name: &str| -> Fallible<String> {
            let value = words.get_item(name)?.ok_or_else(|| Failure::arguments(name))?;
            Ok(value.repr()?.to_string())
        };
        let against = against.map_or(String::new(), |e| format!("; against {e:e} Pa"));
        let (layers, base, boundary) = (word("layers")?, word("base")?, word("boundary")?);
        Ok(format!("<HalfSpace.layered({layers}, base={base}, boundary={boundary}){against}>"))
    }
}
