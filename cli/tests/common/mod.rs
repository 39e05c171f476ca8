//! What tests of the program share.
#![allow(dead_code, unreachable_pub)]

use std::error::Error;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

/// A folder that is made with its test, and removed with it.
pub struct Scratch(pub PathBuf);

impl Scratch {
    pub fn new(name: &str) -> std::io::Result<Self> {
        let name = format!("asperity-{name}-{}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        fs::create_dir_all(&folder)?;
        Ok(Self(folder))
    }

    pub fn join(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // It may be gone already.
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// A folder with a surface of 48 × 48 nodes.
pub fn with_surface(name: &str) -> std::io::Result<Scratch> {
    let folder = Scratch::new(name)?;
    fs::copy(data("selfaffine_48.npy"), folder.join("rough.npy"))?;
    Ok(folder)
}

/// A file among the data of the library's tests.
pub fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data").join(name)
}

/// The program in a folder.
pub fn asperity(folder: &Path, arguments: &[&OsStr]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_asperity"));
    command.current_dir(folder).args(arguments);
    command
}

/// What the program does in a folder with the words of a line.
pub fn output(folder: &Path, line: &str) -> std::io::Result<Output> {
    let words: Vec<&OsStr> = line.split_whitespace().map(OsStr::new).collect();
    asperity(folder, &words).output()
}

/// The same of a line that has to succeed.
pub fn run(folder: &Path, line: &str) -> std::io::Result<Output> {
    let done = output(folder, line)?;
    assert!(done.status.success(), "{line}: {}", said(&done));
    Ok(done)
}

/// The answer to a line that has to succeed.
pub fn answer(folder: &Path, line: &str) -> Result<Value, Box<dyn Error>> {
    only_line(run(folder, &format!("{line} --json"))?)
}

/// The only line of stdout, as JSON.
pub fn only_line(done: Output) -> Result<Value, Box<dyn Error>> {
    let text = String::from_utf8(done.stdout)?;
    assert_eq!(text.lines().count(), 1, "{text}");
    Ok(serde_json::from_str(&text)?)
}

/// A number of an object, NaN where there is none.
pub fn number(object: &Value, name: &str) -> f64 {
    object[name].as_f64().unwrap_or(f64::NAN)
}

/// The program under a limit that a shell sets first.
pub fn limited(folder: &Path, limit: &str, arguments: &[&OsStr]) -> std::io::Result<Output> {
    Command::new("sh")
        .current_dir(folder)
        .args(["-c", &format!("{limit} && exec \"$@\""), "sh"])
        .arg(env!("CARGO_BIN_EXE_asperity"))
        .args(arguments)
        .output()
}

/// What a program printed.
pub fn printed(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// What a program said on stderr.
pub fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A refusal by the program itself, not by a signal.
pub fn is_refused(output: &Output, words: &[&str]) {
    let said = said(output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    for word in words {
        assert!(said.contains(word), "{word} is not in: {said}");
    }
}

/// The cells of a column of a table.
pub fn column(file: &Path, name: &str) -> Result<Vec<String>, Box<dyn Error>> {
    let text = fs::read_to_string(file)?;
    let mut lines = text.lines();
    let header = lines.next().ok_or("no header")?;
    let place = header.split(',').position(|other| other == name);
    let place = place.ok_or_else(|| format!("no column {name}"))?;
    Ok(lines.map(|line| line.split(',').nth(place).unwrap_or_default().to_string()).collect())
}

/// The numbers of a column of a table.
pub fn numbers(file: &Path, name: &str) -> Result<Vec<f64>, Box<dyn Error>> {
    Ok(column(file, name)?.iter().map(|cell| cell.parse()).collect::<Result<_, _>>()?)
}
