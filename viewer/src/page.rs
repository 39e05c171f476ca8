//! The file: its parts are in the folder `page`, and the library of its charts in `vendor`.

use serde_json::Value;

/// What stands for the parts.
const PARTS: [(&str, &str); 3] = [
    ("@@viewer@@", include_str!("../page/viewer.html")),
    (
        "@@style@@",
        concat!(include_str!("../vendor/uplot/uPlot.min.css"), include_str!("../page/style.css")),
    ),
    (
        "@@script@@",
        concat!(
            "/*\n",
            include_str!("../vendor/uplot/LICENSE"),
            "*/\n",
            include_str!("../vendor/uplot/uPlot.iife.min.js"),
            "\n\"use strict\";\n",
            include_str!("../page/decode.js"),
            include_str!("../page/path.js"),
            include_str!("../page/units.js"),
            include_str!("../page/colours.js"),
            include_str!("../page/map.js"),
            include_str!("../page/charts.js"),
            include_str!("../page/words.js"),
            include_str!("../page/save.js"),
            include_str!("../page/main.js"),
            include_str!("../page/start.js")
        ),
    ),
];

/// Letters of the page without data.
pub(crate) fn letters() -> usize {
    PARTS.iter().map(|(_, part)| part.len()).sum()
}

/// The whole page with its data.
pub(crate) fn of(data: &Value) -> String {
    let mut page = include_str!("../page/page.html").to_string();
    for (place, part) in PARTS {
        page = page.replacen(place, part, 1);
    }
    // In a script `<` begins a tag, or a comment, whatever is around it; in a text of JSON this is the same letter.
    let data = data.to_string().replace('<', "\\u003c");
    page.replacen("@@data@@", &data, 1)
}
