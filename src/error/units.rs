//! Units in messages.

/// A value with the unit of its quantity, if that has one unit.
pub(super) fn with_unit(quantity: &str, value: f64) -> String {
    let unit = match quantity {
        "load" => " N",
        "approach"
        | "gap"
        | "mean gap"
        | "greatest gap in contact"
        | "least gap out of contact" => " m",
        "pressure" | "least pressure in contact" => " Pa",
        _ => "",
    };
    format!("{value}{unit}")
}
