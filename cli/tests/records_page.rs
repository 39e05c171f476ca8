//! `docs/records.md` has every array and member of the files of a path, and no other.

mod common;

use std::collections::BTreeSet;
use std::error::Error;
use std::fs;
use std::path::Path;

use asperity_testing::page::tables;
use common::{Scratch, run};
use serde_json::Value;

type Done = Result<(), Box<dyn Error>>;
type Names = BTreeSet<String>;

/// Paths that have all there is: yields, releases and a limit; with a factor, and without one on both half-spaces; with
/// bodies.
const PATHS: [&str; 8] = [
    "--hardness 2.5e9",
    "--hardness 2.5e9 --max-load 1e3",
    "--max-load 100 --material steel --against glass",
    "--layer steel,3e-4 --base 3e9,0.3 --max-area-fraction 0.3",
    "--updater iterative --max-area-fraction 0.3",
    "--updater iterative --max-area-fraction 0.3 --periodic love",
    "--updater iterative --max-area-fraction 0.3 --hardness 2.5e9",
    "--resume r.npz --max-area-fraction 0.4",
];

/// The names of the members of an archive, and the text of its parameters, which is UTF-32 and not compressed.
fn members(file: &Path) -> Result<(Names, Value), Box<dyn Error>> {
    let bytes = fs::read(file)?;
    let mut names = Names::new();
    // Entries of the central directory: the length of the name stands at 28, the name at 46.
    for at in (0..bytes.len()).filter(|at| bytes[*at..].starts_with(b"PK\x01\x02")) {
        let length = usize::from(u16::from_le_bytes([bytes[at + 28], bytes[at + 29]]));
        let name = std::str::from_utf8(&bytes[at + 46..at + 46 + length])?;
        names.insert(name.strip_suffix(".npy").ok_or("no array")?.to_string());
    }
    let begin = [b'{', 0, 0, 0, b'"', 0, 0, 0];
    let begin = bytes.windows(8).position(|window| window == begin).ok_or("no parameters")?;
    let letters =
        bytes[begin..].chunks_exact(4).map(|four| four.try_into().map(u32::from_le_bytes));
    let text: String = letters.map_while(|code| char::from_u32(code.ok()?)).collect();
    let mut values = serde_json::Deserializer::from_str(&text).into_iter();
    Ok((names, values.next().ok_or("no parameters")??))
}

/// The names of an object, and of the objects in it that the page takes apart.
fn keys(of: &Value, taken_apart: &[&str]) -> Names {
    let mut names = Names::new();
    for (name, value) in of.as_object().into_iter().flatten() {
        match value.as_object() {
            Some(group) if taken_apart.contains(&name.as_str()) => {
                names.extend(group.keys().map(|key| format!("{name}.{key}")));
            }
            _ => _ = names.insert(name.clone()),
        }
    }
    names
}

/// Names in the first column of the tables of a page with this header.
fn tabulated(page: &str, header: &str) -> Names {
    let tables = tables(page, header);
    let cells = tables.iter().map(|line| line[0].clone());
    cells
        .flat_map(|cell| cell.split('`').skip(1).step_by(2).map(str::to_string).collect::<Vec<_>>())
        .collect()
}

#[test]
fn the_page_is_that_of_the_files() -> Done {
    let folder = Scratch::new("records-page")?;
    let page =
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/records.md"))?;
    let (of_record, rest) = page.split_once("## path.csv").ok_or("no section")?;
    let (of_table, of_settings) = rest.split_once("## settings.json").ok_or("no section")?;
    let (mut arrays, mut parameters, mut settings) = (Names::new(), Names::new(), Names::new());
    let (mut columns, mut events) = (Names::new(), Names::new());
    for line in PATHS {
        let generated = if line.contains("--resume") { "" } else { "--nodes 32 --record r.npz" };
        let line = format!("path {generated} {line}");
        // One record is of one body.
        if !line.contains("--resume") {
            let _ = fs::remove_file(folder.join("r.npz"));
        }
        run(&folder.0, &line)?;
        let (names, text) = members(&folder.join("r.npz"))?;
        arrays.extend(names);
        parameters.extend(keys(&text, &["kernel", "settings"]));
        let told = fs::read_to_string(folder.join("out/settings.json"))?;
        settings.extend(keys(&serde_json::from_str(&told)?, &[]));
        let table = fs::read_to_string(folder.join("out/path.csv"))?;
        let (header, lines) = table.split_once('\n').ok_or("no header")?;
        columns.extend(header.split(',').map(str::to_string));
        events.extend(lines.lines().filter_map(|line| line.split(',').nth(3)).map(str::to_string));
        // The codes of events are in the record, the page has them in words.
        let codes = text["units"].as_str().and_then(|units| units.split("event ").nth(1));
        let codes = codes.ok_or("no codes")?.split(", ").map(|code| match code.split_once(' ') {
            Some((number, "touch")) => format!("{number}: a node touches"),
            Some((number, "release")) => format!("{number}: a node leaves"),
            Some((number, "limit")) => format!("{number}: the last state at a target"),
            Some((number, "yield")) => format!("{number}: a node yields"),
            _ => code.to_string(),
        });
        let row = of_record.lines().find(|line| line.starts_with("| `event` | n |"));
        for code in codes {
            assert!(row.ok_or("no events")?.contains(&code), "{code}: {row:?}");
        }
    }
    // With adhesion the table has columns, and words, of its own.
    run(&folder.0, "path --nodes 16 --work-of-adhesion 0.05 --unload")?;
    let told = fs::read_to_string(folder.join("out/settings.json"))?;
    settings.extend(keys(&serde_json::from_str(&told)?, &[]));
    let table = fs::read_to_string(folder.join("out/path.csv"))?;
    columns.extend(table.lines().next().ok_or("no header")?.split(',').map(str::to_string));
    assert_eq!(tabulated(of_record, "array"), arrays);
    assert_eq!(tabulated(of_record, "member"), parameters);
    assert_eq!(tabulated(of_table, "column"), columns);
    assert_eq!(tabulated(of_settings, "member"), settings);
    // All kinds of events were there, and the page has their words.
    assert_eq!(events, ["limit", "release", "touch", "yield"].map(str::to_string).into());
    let row = of_table.lines().find(|line| line.starts_with("| `event` |")).ok_or("no events")?;
    assert!(events.iter().all(|event| row.contains(&format!("`{event}`"))), "{row}");
    Ok(())
}
