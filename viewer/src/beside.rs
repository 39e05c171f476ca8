//! Tables that other commands have written beside a record.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde_json::{Map, Value, json};

/// A table that a page can show: its file, what it is, its column along x, whether pictures of its command are over the
/// logarithm of that, and the columns that are drawn.
struct Kind {
    file: &'static str,
    title: &'static str,
    short: &'static str,
    along: &'static str,
    log: bool,
    charts: &'static [&'static str],
}

const KINDS: [Kind; 7] = [
    Kind {
        file: "unloading.csv",
        title: "Unloading from the last state",
        short: "Unloading",
        along: "approach",
        log: false,
        charts: &["load", "contact_area_fraction", "mean_gap"],
    },
    Kind {
        file: "slip.csv",
        title: "Slip under a tangential load",
        short: "Slip",
        along: "displacement",
        log: false,
        charts: &["tangential_load", "slip_area", "tangential_stiffness"],
    },
    Kind {
        file: "cycles.csv",
        title: "Cycles of the tangential load",
        short: "Cycles",
        along: "amplitude",
        log: true,
        charts: &["dissipation", "loss_factor"],
    },
    Kind {
        file: "creep.csv",
        title: "Creep",
        short: "Creep",
        along: "time",
        log: true,
        charts: &["contact_area_fraction", "mean_gap", "load", "approach"],
    },
    Kind {
        file: "creep_cycles.csv",
        title: "Steady cycles of the load",
        short: "Creep, cycles",
        along: "frequency",
        log: true,
        charts: &["dissipation", "loss_factor"],
    },
    Kind {
        file: "leak.csv",
        title: "Leak",
        short: "Leak",
        along: "load",
        log: false,
        charts: &["leak_rate", "permeability", "constriction_gap"],
    },
    Kind {
        file: "history.csv",
        title: "History of the tangential load",
        short: "History",
        along: "displacement",
        log: false,
        charts: &["tangential_load"],
    },
];

/// Lines of a table that a page has at most; of more, some evenly spread.
const LINES: usize = 400;
/// Bytes of a file that is read.
const BYTES: u64 = 100_000_000;

/// A folder of tables.
pub(crate) struct Folder {
    pub(crate) path: PathBuf,
    /// Tables that are older are left out.
    pub(crate) since: Option<SystemTime>,
    /// Whether the page tells its path, and not that its tables lie beside the record.
    pub(crate) is_named: bool,
}

/// What was found in a folder.
#[derive(Default)]
pub(crate) struct Beside {
    /// Tables, by their files.
    pub(crate) panels: Vec<(PathBuf, Value)>,
    pub(crate) settings: Option<Value>,
    /// What was left out, and why.
    pub(crate) notes: Vec<String>,
}

/// Whether two names are of one folder, or of one file, that is there.
pub(crate) fn is_same(one: &Path, other: &Path) -> bool {
    one.canonicalize().ok().zip(other.canonicalize().ok()).is_some_and(|(one, other)| one == other)
}

/// The tables of a folder, and its settings.
pub(crate) fn of(folder: &Folder) -> Beside {
    let mut beside = Beside::default();
    let name = folder.is_named.then(|| folder.path.display().to_string());
    for kind in KINDS {
        let file = folder.path.join(kind.file);
        let Ok(about) = fs::metadata(&file) else { continue };
        if !about.is_file() {
            continue;
        }
        if let (Some(since), Ok(written)) = (folder.since, about.modified())
            && written < since
        {
            beside.notes.push(format!("{} is left out: it is older than the record", kind.file));
            continue;
        }
        if about.len() > BYTES {
            beside.notes.push(format!("{} is left out: it has {} bytes", kind.file, about.len()));
            continue;
        }
        match fs::read_to_string(&file)
            .map_err(|error| error.to_string())
            .and_then(|text| table(&text, &kind))
        {
            Ok((columns, lines)) => {
                let panel = json!({
                    "title": kind.title,
                    "short": kind.short,
                    "file": kind.file,
                    "folder": name,
                    "along": kind.along,
                    "log": kind.log,
                    "charts": kind.charts,
                    "lines": lines,
                    "columns": columns,
                });
                beside.panels.push((file, panel));
            }
            Err(why) => beside.notes.push(format!("{} is left out: {why}", kind.file)),
        }
    }
    // Whatever determines the path; a record does not know the name of its surface.
    let settings = fs::read_to_string(folder.path.join("settings.json")).ok();
    beside.settings = settings.and_then(|text| serde_json::from_str(&text).ok());
    beside
}

/// The columns of a table that the page shows, and how many lines it has.
fn table(text: &str, kind: &Kind) -> Result<(Vec<Value>, usize), String> {
    let mut lines = text.lines().filter(|line| !line.trim().is_empty());
    let names: Vec<&str> = lines.next().ok_or("it is empty")?.split(',').map(str::trim).collect();
    if !names.contains(&kind.along) {
        return Err(format!("it has no column {}", kind.along));
    }
    if !kind.charts.iter().any(|chart| names.contains(chart)) {
        return Err(format!("it has no column {}", kind.charts.join(" or ")));
    }
    let rows: Vec<&str> = lines.collect();
    let every = rows.len().div_ceil(LINES).max(1);
    let mut columns: Vec<Vec<Option<f64>>> = vec![Vec::new(); names.len()];
    let kept = rows.iter().enumerate().filter(|(i, _)| i % every == 0 || i + 1 == rows.len());
    for (number, row) in kept {
        let cells: Vec<&str> = row.split(',').map(str::trim).collect();
        if cells.len() != names.len() {
            let (found, expected) = (cells.len(), names.len());
            return Err(format!("line {} has {found} columns and not {expected}", number + 2));
        }
        for (column, cell) in columns.iter_mut().zip(cells) {
            let value = cell.parse().ok().filter(|value: &f64| value.is_finite());
            column.push(value.map(rounded));
        }
    }
    let columns = names.iter().zip(columns);
    let columns = columns.filter(|(name, _)| **name == kind.along || kind.charts.contains(name));
    let columns = columns.map(|(name, values)| json!({"name": name, "values": values}));
    Ok((columns.collect(), rows.len()))
}

/// Six digits, of which charts show fewer.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// The names and values of settings, those of groups as `group.name`.
pub(crate) fn flat(settings: &Value) -> Map<String, Value> {
    fn add(name: &str, value: &Value, into: &mut Map<String, Value>) {
        let Value::Object(group) = value else {
            // Scripts round whole numbers that are greater, as seeds may be.
            let great = value.as_u64().filter(|whole| *whole > 1 << 53);
            let value = great.map_or_else(|| value.clone(), |whole| whole.to_string().into());
            into.insert(name.to_string(), value);
            return;
        };
        for (key, value) in group {
            let name = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
            add(&name, value, into);
        }
    }
    let mut all = Map::new();
    add("", settings, &mut all);
    all
}

/// Where a record lies, for what was written since.
pub(crate) fn place_of(record: &Path) -> Folder {
    let folder = record.parent().filter(|folder| !folder.as_os_str().is_empty());
    let since = fs::metadata(record).and_then(|about| about.modified()).ok();
    Folder { path: folder.unwrap_or(Path::new(".")).to_path_buf(), since, is_named: false }
}
