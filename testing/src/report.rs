//! What stands in the page of a path (`asperity-report`), read as its script does.

use serde_json::Value;

/// The data of a page.
#[must_use]
pub fn data(page: &str) -> Value {
    let (_, data) = page.split_once(r#"id="data">"#).unwrap();
    serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap()
}

/// Deflated bytes in base 64.
#[must_use]
pub fn bytes(text: &Value) -> Vec<u8> {
    let digits = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let place = |letter: u8| digits.iter().position(|digit| *digit == letter).map(|i| i as u32);
    let mut bytes = Vec::new();
    for group in text.as_str().unwrap().as_bytes().chunks(4) {
        let known: Vec<u32> = group.iter().filter_map(|letter| place(*letter)).collect();
        let bits = (0..4).fold(0, |bits, i| bits << 6 | known.get(i).copied().unwrap_or(0));
        bytes.extend((0..known.len() - 1).map(|i| (bits >> (16 - 8 * i)) as u8));
    }
    miniz_oxide::inflate::decompress_to_vec_zlib(&bytes).unwrap()
}

/// Whole numbers in planes of bytes.
#[must_use]
pub fn numbers(planes: &Value) -> Vec<u32> {
    let (count, bytes) = (planes["count"].as_u64().unwrap() as usize, bytes(&planes["data"]));
    let plane =
        |i: usize| bytes.chunks(count).enumerate().map(move |(k, p)| u32::from(p[i]) << (8 * k));
    (0..count).map(|i| plane(i).sum()).collect()
}

/// A quantity at every event of a record.
#[must_use]
pub fn column(events: &Value, name: &str) -> Vec<f64> {
    let column = &events["columns"][name];
    let step = column["step"].as_f64().unwrap();
    let mut code = 0_i32;
    let values = numbers(&column["values"]).into_iter().map(|change| {
        code = code.wrapping_add((change >> 1) as i32 ^ -((change & 1) as i32));
        match (code, column["scale"].as_str().unwrap()) {
            (code, "whole") => f64::from(code),
            (i32::MAX, _) => 0.0,
            (code, _) if code == i32::MAX - 1 => f64::INFINITY,
            (code, _) if code == i32::MAX - 2 => f64::NAN,
            (code, "signed") => {
                let steps = f64::from(code.abs() - 1);
                f64::from(code.signum()) * (column["least"].as_f64().unwrap() + steps * step).exp()
            }
            (code, _) => (f64::from(code) * step).exp(),
        }
    });
    values.collect()
}
