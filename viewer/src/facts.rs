//! What a record says of itself: names, numbers with their SI units, and words.

use asperity::contact::Certificate;
use asperity::kernel::{Base, KernelOrigin, LayeredBody};
use asperity::loading::LoadingEnd;
use asperity::nalgebra::DMatrix;
use asperity::record::{LoadingRecord, RecordedHardness};
use asperity::surface::Topography;
use asperity::{Boundary, ContactRule, ContactTarget, Error, LoadingState, Warning};
use serde_json::{Value, json};

/// A fact: its name, and numbers with their unit, or words.
fn fact(name: &str, value: impl Into<Value>, unit: &str) -> Value {
    json!({"name": name, "value": value.into(), "unit": unit})
}

/// Surface, half-space, bodies, and how the path was followed.
pub(crate) fn of(record: &LoadingRecord) -> Result<Vec<Value>, Error> {
    let grid = record.grid();
    let (nx, ny) = grid.shape();
    let (lx, ly) = grid.sides();
    let heights = record.heights();
    let mut facts = vec![
        fact("grid", format!("{nx} × {ny} nodes"), ""),
        fact("sides", vec![lx, ly], "m"),
        fact("cells", vec![grid.dx(), grid.dy()], "m"),
        fact("rms height Sq", heights.rms_height(), "m"),
        fact("rms gradient", heights.rms_gradient(&grid)?, ""),
        fact("half-space", half_space(record.kernel().boundary), ""),
        fact("influence of a cell", kernel(&record.kernel().origin), ""),
    ];
    if let Some(e_star) = record.kernel().origin.composite_modulus() {
        facts.push(fact("composite modulus E*", e_star, "Pa"));
    }
    if let Some(body) = layered(&record.kernel().origin) {
        facts.extend(layers(body));
    }
    for (number, (youngs_modulus, poissons_ratio)) in (1..).zip(record.bodies()) {
        facts.push(fact(&format!("body {number}: Young's modulus"), *youngs_modulus, "Pa"));
        facts.push(fact(&format!("body {number}: Poisson's ratio"), *poissons_ratio, ""));
    }
    if let [_] = record.bodies() {
        facts.push(fact("body 2", "rigid", ""));
    }
    match &record.settings().hardness {
        None => {}
        Some(RecordedHardness::Uniform(hardness)) => facts.push(fact("hardness", *hardness, "Pa")),
        Some(_) => facts.push(fact("hardness", "one value for each node", "")),
    }
    facts.push(fact("order of events", rule(record.settings().rule), ""));
    facts.extend(record.settings().targets.iter().map(target));
    let end = record.end().map_or("has not ended: it can be continued", reason);
    facts.push(fact("ended by", end, ""));
    Ok(facts)
}

fn half_space(boundary: Boundary) -> &'static str {
    match boundary {
        Boundary::Free => "free",
        Boundary::Periodic => "periodic",
        Boundary::PeriodicX => "periodic along x and free along y",
        Boundary::PeriodicY => "periodic along y and free along x",
    }
}

fn kernel(origin: &KernelOrigin) -> &'static str {
    match origin {
        KernelOrigin::Boussinesq { .. } => "Love's rectangle",
        KernelOrigin::PeriodicBoussinesq { .. } | KernelOrigin::SemiPeriodicBoussinesq { .. } => {
            "Love's rectangle and its images"
        }
        KernelOrigin::Spectral { .. } => "spectral, 2/(E*|q|)",
        KernelOrigin::Layered { .. }
        | KernelOrigin::PeriodicLayered { .. }
        | KernelOrigin::SpectralLayered { .. } => "of elastic layers",
        _ => "of the user",
    }
}

fn layered(origin: &KernelOrigin) -> Option<&LayeredBody> {
    match origin {
        KernelOrigin::Layered { body }
        | KernelOrigin::PeriodicLayered { body }
        | KernelOrigin::SpectralLayered { body } => Some(body),
        _ => None,
    }
}

fn layers(body: &LayeredBody) -> Vec<Value> {
    let mut facts = Vec::new();
    for (number, layer) in (1..).zip(body.layers()) {
        let name = |what: &str| format!("layer {number}: {what}");
        facts.push(fact(&name("Young's modulus"), layer.youngs_modulus, "Pa"));
        facts.push(fact(&name("Poisson's ratio"), layer.poissons_ratio, ""));
        facts.push(fact(&name("thickness"), layer.thickness, "m"));
    }
    match body.base() {
        Base::Rigid => facts.push(fact("base", "rigid", "")),
        Base::HalfSpace { youngs_modulus, poissons_ratio } => {
            facts.push(fact("base: Young's modulus", youngs_modulus, "Pa"));
            facts.push(fact("base: Poisson's ratio", poissons_ratio, ""));
        }
    }
    facts.push(match body.counterpart() {
        None => fact("other body", "rigid", ""),
        Some(e_star) => fact("other body: E/(1 − ν²)", e_star, "Pa"),
    });
    facts
}

fn rule(rule: ContactRule) -> &'static str {
    match rule {
        ContactRule::FirstContact => "exact: the node that touches first",
        ContactRule::ApproximateOrder => "nearly exact",
    }
}

fn target(target: &ContactTarget) -> Value {
    match *target {
        ContactTarget::Load(load) => fact("target: load", load, "N"),
        ContactTarget::Approach(approach) => fact("target: approach", approach, "m"),
        ContactTarget::MeanGap(mean_gap) => fact("target: mean gap", mean_gap, "m"),
        ContactTarget::AreaFraction(fraction) => fact("target: contact area", fraction, "1"),
        _ => fact("target", "another", ""),
    }
}

/// Why a path has ended, in words.
#[must_use]
pub fn reason(end: LoadingEnd) -> &'static str {
    match end {
        LoadingEnd::FullContact => "full contact",
        LoadingEnd::FullyPlastic => "all cells have yielded",
        LoadingEnd::Load => "the requested load",
        LoadingEnd::Approach => "the requested approach",
        LoadingEnd::MeanGap => "the requested mean gap",
        LoadingEnd::AreaFraction => "the requested contact area",
        LoadingEnd::Nodes => "the requested number of nodes",
        LoadingEnd::Memory => "the memory budget",
        LoadingEnd::NoMoreEvents => "no further node touches",
        _ => "an error",
    }
}

/// The residuals of the last state, recomputed from its pressure: zero is exact.
pub(crate) fn certificate(certificate: &Certificate, last: &LoadingState) -> Vec<Value> {
    let pressure = last.contact.load / last.contact.contact_area;
    let mut facts = vec![
        fact("greatest gap in contact", certificate.greatest_contact_gap * certificate.length, "m"),
        fact("least pressure in contact", certificate.least_pressure * pressure, "Pa"),
        fact("sum of pressures less load", certificate.load_error * last.contact.load, "N"),
        fact("estimated error of the approach", last.approach_error, "m"),
    ];
    // There is none in full contact.
    if certificate.least_gap.is_finite() {
        facts.push(fact(
            "least gap out of contact",
            certificate.least_gap * certificate.length,
            "m",
        ));
    }
    if let Some(excess) = certificate.excess_pressure {
        facts.push(fact("pressure beyond the hardness, over it", excess, ""));
    }
    facts
}

/// What looks wrong with the surface, the bodies, and the last state, of which the pressure is known where it can be
/// computed.
pub(crate) fn warnings(
    record: &LoadingRecord,
    pressure: Option<&DMatrix<f64>>,
) -> Result<Vec<String>, Error> {
    let (grid, kernel) = (record.grid(), record.kernel());
    let surface = Topography::new(grid, record.heights().matrix().clone())?;
    let mut warnings = Warning::of_surface(&surface);
    let body = layered(&kernel.origin);
    // Of a coated body that of its surface, as in the program.
    let e_star =
        kernel.origin.composite_modulus().or_else(|| body.map(LayeredBody::surface_modulus));
    warnings.extend(e_star.and_then(Warning::of_modulus));
    warnings.extend(body.and_then(|body| Warning::of_layers(body, &grid)));
    if let Some(pressure) = pressure {
        let contact = record.contact()?;
        let map = contact.map_at(contact.len());
        // With a hardness the greatest pressure is what was asked for.
        if let (Some(e_star), None) = (e_star, &record.settings().hardness) {
            warnings.extend(Warning::of_pressure(pressure.max(), e_star, None));
        }
        warnings.extend(Warning::of_contact(pressure, &map, (&grid, kernel.boundary))?);
    }
    // The function of the library, which readers of a page need not know.
    Ok(warnings.iter().map(|w| w.to_string().replace(" (`Topography::level`)", "")).collect())
}
