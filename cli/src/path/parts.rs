//! What a path is of, for `settings.json`.

use asperity::kernel::{Base, LayeredBody};
use asperity::{ContactRule, ContactTarget, Grid};
use asperity_cli::half_space::Periodic;
use asperity_cli::outcome::Failure;
use clap::ValueEnum;
use nalgebra::DMatrix;
use serde_json::{Map, Value, json};

use super::updater::Updater;
use crate::adhesion::Law;
use crate::elasticity::Bodies;
use crate::settings::Settings;

/// The hardness, a number if it is the same everywhere; nothing if nothing yields.
fn hardness(map: Option<&DMatrix<f64>>) -> Value {
    let first = map.and_then(|map| map.iter().next().copied());
    match (map, first) {
        (Some(map), Some(first)) if map.iter().all(|value| *value == first) => json!(first),
        (Some(_), _) => json!("one value for each node"),
        _ => Value::Null,
    }
}

/// Layers from the surface downwards, each its Young's modulus, Poisson's ratio and thickness; nothing if there are
/// none.
fn layers(body: Option<&LayeredBody>) -> Value {
    let Some(body) = body else { return Value::Null };
    let layers = body
        .layers()
        .iter()
        .map(|layer| [layer.youngs_modulus, layer.poissons_ratio, layer.thickness]);
    let base = match body.base() {
        Base::Rigid => json!("rigid"),
        Base::HalfSpace { youngs_modulus, poissons_ratio } => {
            json!([youngs_modulus, poissons_ratio])
        }
    };
    json!({"layers": layers.collect::<Vec<_>>(), "base": base, "against": body.counterpart()})
}

/// What a path is of besides its surface.
pub(super) struct Parts<'a> {
    pub(super) bodies: &'a Bodies,
    pub(super) periodic: Option<Periodic>,
    pub(super) hardness: Option<&'a DMatrix<f64>>,
    pub(super) law: Option<Law>,
    pub(super) rule: ContactRule,
    pub(super) updater: Updater,
    pub(super) targets: &'a [ContactTarget],
    /// Whether it goes back from there.
    pub(super) unload: bool,
}

impl Parts<'_> {
    /// Everything that determines the path on a surface from this source.
    pub(super) fn settings(&self, grid: &Grid, surface: Value) -> Result<Settings, Failure> {
        let plain = |value: Result<Value, serde_json::Error>| {
            value.map_err(|error| Failure::new("cannot write the settings", error))
        };
        let updater = self.updater.to_possible_value();
        let (sides, cell) = (grid.sides(), (grid.dx(), grid.dy()));
        let settings = [
            ("surface", surface),
            ("grid", json!({"nodes": grid.shape(), "sides": sides, "cell": cell})),
            ("e_star", json!(self.bodies.e_star)),
            ("bodies", json!(self.bodies.elastic)),
            ("layers", layers(self.bodies.layered.as_ref())),
            (
                "half_space",
                match self.periodic {
                    None => json!("free"),
                    Some(kernel) => json!(kernel.in_words()),
                },
            ),
            ("hardness", hardness(self.hardness)),
            ("rule", plain(serde_json::to_value(self.rule))?),
            (
                "updater",
                json!(updater.map_or_else(String::new, |value| value.get_name().to_string())),
            ),
            ("targets", plain(serde_json::to_value(self.targets))?),
            ("unload", json!(self.unload)),
        ];
        let settings = settings.map(|(name, value)| (name.to_string(), value));
        let adhesion = self.law.map(|law| ("adhesion".to_string(), law.settings()));
        Ok(Settings::new(settings.into_iter().chain(adhesion).collect::<Map<_, _>>()))
    }
}
