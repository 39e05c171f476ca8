//! The bodies whose stresses are asked for, and what is found of them.

use asperity::record::LoadingRecord;
use asperity::stress::{FirstYield, Subsurface, Survey};
use asperity::{LoadingPath, LoadingState};
use asperity_cli::outcome::Failure;
use nalgebra::DMatrix;

use super::Options;
use super::progress::Progress;
use crate::at::state_at_load;
use crate::elasticity::Bodies;

/// A state of the record.
pub(super) struct Moment<'a> {
    pub(super) record: &'a LoadingRecord,
    path: LoadingPath,
    pub(super) state: LoadingState,
    pub(super) pressure: DMatrix<f64>,
    /// Coefficient of friction, and direction \[°\].
    pub(super) friction: (f64, f64),
}

/// A body, with its stresses.
pub(super) struct Body {
    /// Which of two it is, in words.
    pub(super) name: &'static str,
    pub(super) below: Subsurface,
    pub(super) survey: Survey,
    /// From the uppermost layer to the base.
    pub(super) materials: Vec<Material>,
}

/// A layer, the base, or all of a body without layers.
pub(super) struct Material {
    /// Which of several it is, in words.
    pub(super) name: Option<String>,
    /// The depths that lie in it.
    pub(super) survey: Survey,
    /// If its yield stress is known.
    pub(super) yielding: Option<Yielding>,
}

/// A yield stress \[Pa\], and the state of the path at which it is reached.
pub(super) struct Yielding {
    pub(super) stress: f64,
    pub(super) first: Option<FirstYield>,
}

impl<'a> Moment<'a> {
    pub(super) fn new(record: &'a LoadingRecord, options: &Options) -> Result<Self, Failure> {
        let failed = |error| Failure::new("cannot compute the pressure", error);
        let Some(last) = record.states().last().copied() else {
            return Err(Failure::request("the record holds no state"));
        };
        let state = match options.load {
            None => last,
            Some(load) => state_at_load(record, load)?,
        };
        let mut path = record.replay().map_err(failed)?;
        let pressure = path.fields_at(&state).map_err(failed)?.pressure;
        let friction = (options.friction, options.angle);
        Ok(Self { record, path, state, pressure, friction })
    }

    /// The bodies that are asked for.
    pub(super) fn bodies(&mut self, options: &Options) -> Result<Vec<Body>, Failure> {
        let own = &options.yield_stress[..];
        let other = options.against_yield_stress.as_slice();
        let mut found = Vec::new();
        // Tractions on the other body are opposite.
        let sides = [("body", 1.0, own), ("other body", -1.0, other)];
        let ratios = ratios(self.record, options)?;
        if !other.is_empty() && ratios.len() < 2 {
            return Err(Failure::request(match is_of_layers(self.record) {
                true => {
                    "--against-yield-stress is that of a second body, which is not looked at on layers"
                }
                false => {
                    "--against-yield-stress is that of a second body: give --material and --against"
                }
            }));
        }
        for (ratio, (name, sign, strength)) in ratios.into_iter().zip(sides) {
            found.push(self.body(name, (ratio, sign), strength, options)?);
        }
        Ok(found)
    }

    fn body(
        &mut self,
        name: &'static str,
        (ratio, sign): (f64, f64),
        strengths: &[f64],
        options: &Options,
    ) -> Result<Body, Failure> {
        let failed = |error| Failure::new("cannot compute the stress below the surface", error);
        let (coefficient, angle) = self.friction;
        let below = Subsurface::of_record(self.record, ratio)
            .and_then(|below| below.sliding(sign * coefficient, angle.to_radians()))
            .map_err(failed)?;
        let depths = Some(&options.depth[..]).filter(|depths| !depths.is_empty());
        let progress = Progress::new();
        let survey = below.survey_with(&self.pressure, depths, |field| {
            progress.passed(field.depth);
            Ok(())
        });
        let survey = survey.map_err(failed)?;
        let mut yielding = self.yielding(&below, strengths)?.into_iter();
        let layers = below.layers().map_or(0, |body| body.layers().len());
        let word = |place: usize| match () {
            () if layers == 0 => None,
            () if place < layers => Some(format!("layer {}", place + 1)),
            () => Some("base".to_string()),
        };
        let parts = below.by_material(&survey).into_iter().enumerate();
        let materials = parts.map(|(place, survey)| Material {
            name: word(place),
            survey,
            yielding: yielding.next(),
        });
        let materials = materials.collect();
        Ok(Body { name, below, survey, materials })
    }

    /// When each material begins to yield, whose yield stresses are one for all, one for each, or not known.
    fn yielding(
        &mut self,
        below: &Subsurface,
        strengths: &[f64],
    ) -> Result<Vec<Yielding>, Failure> {
        let materials = below.materials();
        let strengths = match *strengths {
            [] => return Ok(Vec::new()),
            [one] => vec![one; materials],
            ref each if each.len() == materials => each.to_vec(),
            ref others => {
                return Err(Failure::request(format!(
                    "--yield-stress takes one value for all materials or one for each, from the uppermost layer to the base: the body has {materials}, and {} are given",
                    others.len()
                )));
            }
        };
        let history = self.record.history();
        let found = below
            .first_yields(&mut self.path, history, &strengths)
            .map_err(|error| Failure::new("cannot find the load of first yield", error))?;
        let each = found.into_iter().zip(strengths);
        Ok(each.map(|(first, stress)| Yielding { stress, first }).collect())
    }
}

/// Records of other bodies have one modulus; those on kernels of somebody's own are not read here.
fn is_of_layers(record: &LoadingRecord) -> bool {
    record.kernel().origin.composite_modulus().is_none()
}

/// That the path is of other bodies than those given, of which one may be left out if the record knows both.
pub(super) fn warning_of_path(
    record: &LoadingRecord,
    options: &Options,
) -> Result<Option<String>, Failure> {
    let Some(first) = options.material else { return Ok(None) };
    let bodies = Bodies::between(first, options.against)?;
    let is_known = options.against.is_none() && record.bodies().contains(&(first.e, first.nu));
    Ok(bodies.warning_of_path(record, "Poisson's ratio").filter(|_| !is_known))
}

/// Poisson's ratios of the body and of the other one, if that is not rigid; layers have their own.
fn ratios(record: &LoadingRecord, options: &Options) -> Result<Vec<f64>, Failure> {
    if is_of_layers(record) {
        return match (options.poisson, options.material) {
            (None, None) => Ok(vec![0.0]),
            _ => Err(Failure::request(
                "--poisson and --material are those of a homogeneous body, and this record is of layers, which it knows",
            )),
        };
    }
    if let Some(ratio) = options.poisson {
        return Ok(vec![ratio]);
    }
    if let Some(first) = options.material {
        let both = [Some(first), options.against];
        return Ok(both.into_iter().flatten().map(|body| body.nu).collect());
    }
    let ratios: Vec<f64> = record.bodies().iter().map(|(_, ratio)| *ratio).collect();
    if ratios.is_empty() {
        return Err(Failure::request(
            "the record does not know its bodies: give --poisson, or --material and --against",
        ));
    }
    Ok(ratios)
}
