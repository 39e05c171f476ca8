//! What is known of a surface, and of materials.

use asperity::material::Material;
use asperity::surface::{Topography, Trend};
use serde_json::{Value, json};

use crate::heights::{Found, Heights};

/// Names and values of all materials.
pub(crate) fn materials() -> String {
    let of = |material: &Material| {
        json!({
            "name": material.name,
            "young": material.youngs_modulus,
            "poisson": material.poissons_ratio,
            "hardness": material.hardness,
        })
    };
    Value::Array(Material::ALL.iter().map(of).collect()).to_string()
}

/// Facts as the viewer shows them, and what the page has to ask for.
pub(crate) fn of(heights: &Heights) -> Value {
    let (facts, shape, sides, needs) = match &heights.found {
        Found::Whole(surface) => {
            (of_surface(surface), surface.grid().shape(), Some(surface.grid().sides()), vec![])
        }
        Found::Part(measured) => {
            let size = measured.cell.is_none().then_some("side");
            let holes = (measured.missing > 0).then_some("fill");
            let needs = size.into_iter().chain(holes).collect();
            let sides = measured.grid().ok().map(|grid| grid.sides());
            (vec![], measured.heights.shape(), sides, needs)
        }
    };
    json!({
        "name": heights.name,
        "source": heights.source,
        "shape": [shape.0, shape.1],
        "sides": sides.map(|(lx, ly)| [lx, ly]),
        "missing": heights.missing,
        "needs": needs,
        "facts": facts,
        "notes": heights.notes,
        "warnings": heights.warnings,
    })
}

fn of_surface(surface: &Topography) -> Vec<Value> {
    let (grid, map) = (surface.grid(), surface.map());
    let ((nx, ny), (lx, ly)) = (grid.shape(), grid.sides());
    let (sx, sy) = surface.trend(Trend::Plane).slopes();
    let fact =
        |name: &str, value: Value, unit: &str| json!({"name": name, "value": value, "unit": unit});
    let mut facts = vec![
        fact("grid", json!(format!("{nx} × {ny} nodes")), ""),
        fact("sides", json!([lx, ly]), "m"),
        fact("cells", json!([grid.dx(), grid.dy()]), "m"),
        fact("rms height Sq", json!(map.rms_height()), "m"),
        fact("mean absolute height Sa", json!(map.mean_absolute_height()), "m"),
        fact("peak to valley Sz", json!(map.peak_to_valley()), "m"),
        fact("skewness Ssk", json!(map.skewness()), ""),
        fact("kurtosis Sku", json!(map.kurtosis()), ""),
        fact("slope of the mean plane along x, along y", json!([sx, sy]), ""),
    ];
    if let Ok(gradient) = map.rms_gradient(grid) {
        facts.push(fact("rms gradient", json!(gradient), ""));
    }
    facts
}
