//! `settings.json`: everything that determines a path, beside its `path.csv`.

use std::fs;
use std::path::{Path, PathBuf};

use asperity_cli::outcome::{self, Failure};
use serde_json::{Map, Value, json};

/// The file in the folder of a path.
const NAME: &str = "settings.json";
/// What members of an ensemble differ in: the seed of a generated surface, or the file of a measured one.
const OF_MEMBER: [&str; 3] = ["surface.seed", "surface.file", "surface.heights_md5"];

/// Everything that determines a path: surface, half-space, rule, updater, targets, and the program.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Settings(Value);

impl Settings {
    /// Of a path by this program.
    pub(crate) fn new(mut settings: Map<String, Value>) -> Self {
        let program = concat!("asperity ", env!("CARGO_PKG_VERSION"));
        settings.insert("program".to_string(), json!(program));
        settings.insert("units".to_string(), json!("SI: m, Pa, N"));
        Self(Value::Object(settings))
    }

    /// Writes them into the folder of their path.
    pub(crate) fn write(&self, folder: &Path) -> Result<PathBuf, Failure> {
        outcome::write(&folder.join(NAME), format!("{:#}\n", self.0))
    }

    /// Those of the path in a folder.
    pub(crate) fn read(folder: &Path) -> Result<Self, Failure> {
        let file = folder.join(NAME);
        let failed = |error: Box<dyn std::error::Error>| {
            let name = file.display();
            Failure::new(
                format!("cannot read the settings of the path in {}: {name}", folder.display()),
                error,
            )
        };
        let text = fs::read_to_string(&file).map_err(|error| failed(error.into()))?;
        let settings = serde_json::from_str(&text).map_err(|error| failed(error.into()))?;
        Ok(Self(settings))
    }

    /// Whether they have an entry.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.0.get(name).is_some()
    }

    /// `Ok` if the paths of two folders are of the same settings; if they are `members` of an ensemble, but for the
    /// seed or the measured map.
    pub(crate) fn check_same(
        &self,
        name: &str,
        (other_name, other): (&str, &Self),
        members: bool,
    ) -> Result<(), Failure> {
        let [mut own, mut others] = [Vec::new(), Vec::new()];
        flatten("", &self.0, &mut own);
        flatten("", &other.0, &mut others);
        let value = |all: &[(String, String)], key: &str| {
            let found = all.iter().find(|(other, _)| other == key);
            found.map_or_else(|| "nothing".to_string(), |(_, value)| value.clone())
        };
        let mut keys: Vec<&String> = own.iter().chain(&others).map(|(key, _)| key).collect();
        keys.sort();
        keys.dedup();
        let differences: Vec<String> = keys
            .into_iter()
            .filter(|key| !(members && OF_MEMBER.contains(&key.as_str())))
            .filter(|key| value(&own, key) != value(&others, key))
            .map(|key| {
                let values = (value(&own, key), value(&others, key));
                format!("{key} is {} in {name} and {} in {other_name}", values.0, values.1)
            })
            .collect();
        if differences.is_empty() {
            return Ok(());
        }
        Err(Failure::request(format!(
            "{name} and {other_name} have different settings: {}",
            differences.join("; ")
        )))
    }
}

/// The settings by name, those of a group as `group.name`.
fn flatten(name: &str, value: &Value, into: &mut Vec<(String, String)>) {
    let Value::Object(group) = value else {
        into.push((name.to_string(), value.to_string()));
        return;
    };
    for (key, value) in group {
        let name = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
        flatten(&name, value, into);
    }
}
