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
    use std::f64::consts::{PI, SQRT_2};

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

    /// A wave along x, of which all is known in closed form: Sq is 1/√2 of its amplitude, Sku is 3/2, and the mean of
    /// |sin(2πj/n)| is 2 cot(π/n)/n. The sum of j sin(2πj/n) is −n/2 cot(π/n), and that of the squares of j about their
    /// mean n(n² − 1)/12: their ratio is the slope of the mean plane. Differences of neighbours are 2 sin(π/n) times a
    /// cosine, and there is none across the border, from the last node to the first. Only rounding is left.
    #[test]
    fn facts_of_a_wave_are_those_of_its_formula() -> Result<(), Fault> {
        let (amplitude, cell, n): (f64, f64, f64) = (3e-6, 1e-3, 16.0);
        let wave = |j: i32| 3.0 * (2.0 * PI * f64::from(j) / n).sin();
        let row: Vec<String> = (0..16).map(|j| format!("{:.17}", wave(j))).collect();
        let text = format!("{}\n", row.join(" ")).repeat(4);
        let [layout, height_unit] = ["matrix", "µm"].map(|text| Some(text.to_string()));
        let reading = Reading { layout, height_unit, side: Some(16e-3), ..Reading::default() };
        let made = of(&Heights::read(text.as_bytes(), "wave.txt", &reading)?);
        let facts = made["facts"].as_array().cloned().unwrap_or_default();
        let value = |name: &str| {
            let fact = facts.iter().find(|fact| fact["name"] == name);
            fact.map_or(Value::Null, |fact| fact["value"].clone())
        };
        let is_near = |found: &Value, expected: f64| {
            let found = found.as_f64().unwrap_or(f64::NAN);
            (found / expected - 1.0).abs() < 1e-12
        };
        let cot = 1.0 / (PI / n).tan();
        let whole = 2.0 * n * (PI / n).sin().powi(2);
        let differences = (whole - (2.0 * PI / n).sin().powi(2)) / (n - 1.0);
        for (name, expected) in [
            ("rms height Sq", amplitude / SQRT_2),
            ("mean absolute height Sa", 2.0 * amplitude * cot / n),
            ("peak to valley Sz", 2.0 * amplitude),
            ("kurtosis Sku, with the tilt", 1.5),
            ("slope of the mean plane along x", -6.0 * amplitude * cot / ((n * n - 1.0) * cell)),
            ("rms gradient", amplitude / cell * differences.sqrt()),
        ] {
            assert!(is_near(&value(name), expected), "{name}: {} {expected}", value(name));
        }
        for name in ["skewness Ssk, with the tilt", "the same along y"] {
            assert!(value(name).as_f64().is_some_and(|zero| zero.abs() < 1e-12), "{name}");
        }
        assert_eq!(value("grid"), "16 × 4 nodes");
        let (sides, cells) = (value("sides"), value("cells"));
        assert!(is_near(&sides[0], 16e-3) && is_near(&sides[1], 4e-3), "{sides}");
        assert!(is_near(&cells[0], cell) && is_near(&cells[1], cell), "{cells}");
        Ok(())
    }
}
