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
        fact("skewness Ssk, with the tilt", json!(map.skewness()), ""),
        fact("kurtosis Sku, with the tilt", json!(map.kurtosis()), ""),
        fact("slope of the mean plane along x", json!(sx), ""),
        fact("the same along y", json!(sy), ""),
    ];
    if let Ok(gradient) = map.rms_gradient(grid) {
        facts.push(fact("rms gradient", json!(gradient), ""));
    }
    facts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fault::Fault;
    use crate::request::{Generation, Reading};

    #[test]
    fn what_is_missing_is_asked_for() -> Result<(), Fault> {
        let [layout, height_unit] = ["matrix", "nm"].map(|text| Some(text.to_string()));
        let mut reading = Reading { layout, height_unit, ..Reading::default() };
        let text = b"3 1 nan 1\n5 9 2 6\n5 3 5 8\n";
        let needs = |reading: &Reading| -> Result<Value, Fault> {
            Ok(of(&Heights::read(text, "a.txt", reading)?)["needs"].clone())
        };
        assert_eq!(needs(&reading)?, json!(["side", "fill"]));
        reading.side = Some(1e-3);
        assert_eq!(needs(&reading)?, json!(["fill"]));
        reading.fill = true;
        assert_eq!(needs(&reading)?, json!([]));
        Ok(())
    }

    /// The example of the program: 50 µm, and 8 cells of the shortest wave.
    #[test]
    fn facts_are_those_of_the_surface() -> Result<(), Fault> {
        let made =
            of(&Heights::generate(&Generation { nodes: Some(64), ..Generation::default() })?);
        let facts = made["facts"].as_array().cloned().unwrap_or_default();
        let value = |name: &str| {
            let fact = facts.iter().find(|fact| fact["name"] == name);
            fact.and_then(|fact| fact["value"].as_f64()).unwrap_or(f64::NAN)
        };
        // The generator scales what it made to its height, to rounding.
        assert!((value("rms height Sq") / 50e-6 - 1.0).abs() < 1e-12);
        assert!(value("rms gradient") > 0.0 && made["needs"] == json!([]));
        let source = made["source"].as_str().unwrap_or_default();
        assert!(source.contains("shortest wavelength 1.25 mm, roll-off at 2.5 mm"), "{source}");
        assert!(materials().contains(r#""name":"steel""#));
        Ok(())
    }
}
