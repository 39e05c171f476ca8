use std::io::{Cursor, ErrorKind};

use super::*;
use crate::surface::Paraboloid;
use crate::{Boussinesq, LoadingSolver};

/// A path of four states.
fn record() -> Result<LoadingRecord, Error> {
    let half_space = Boussinesq::new(Grid::square(2, 1.0)?, 1.0)?;
    let mut path = LoadingSolver::new(&Paraboloid::new(10.0)?, &half_space)?;
    let history: History = path.by_ref().collect::<Result<_, _>>()?;
    LoadingRecord::new(&path, history)
}

#[test]
fn a_record_does_not_fit() -> Result<(), Box<dyn std::error::Error>> {
    let record = record()?;
    let name = format!("asperity-full-{}.npz", std::process::id());
    let file = std::env::temp_dir().join(name);
    let is_read = |bytes: &[u8]| {
        // A new file each time: some systems wait for the disk before they replace what is in one.
        let _ = std::fs::remove_file(&file);
        std::fs::write(&file, bytes).is_ok() && LoadingRecord::read_npz(&file).is_ok()
    };
    let mut whole = Cursor::new(Vec::new());
    record.write(&mut whole, &[])?;
    let mut disk = whole.into_inner();
    assert!(is_read(&disk));
    // Whatever the room, down to nothing: the writer refuses what does not fit, and the reader what was written of it.
    for room in 0..disk.len() {
        let written = record.write(&mut Cursor::new(&mut disk[..room]), &[]);
        let refused = written.is_err_and(|error| error.kind() == ErrorKind::WriteZero);
        assert!(refused && !is_read(&disk[..room]), "room for {room} bytes");
    }
    std::fs::remove_file(&file)?;
    #[cfg(target_os = "linux")]
    {
        use std::os::unix::fs::FileTypeExt;
        let full = Path::new("/dev/full");
        let written = record.write_npz(full, &[]);
        assert!(
            matches!(&written, Err(Error::File(FileError::Io { path, .. })) if path == full),
            "{written:?}"
        );
        assert!(std::fs::metadata(full)?.file_type().is_char_device());
    }
    Ok(())
}

/// The members that a record is read from, checksums and all, with other parameters and a change of the
/// columns.
fn archive(
    record: &LoadingRecord,
    parameters: &str,
    change: impl Fn(&str, &mut Vec<f64>),
) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut archive = ArchiveWriter::new(Cursor::new(&mut bytes));
    archive.text("parameters", parameters)?;
    let mut column = |name: &str, get: &dyn Fn(&LoadingState) -> f64| {
        let mut values: Vec<f64> = record.states().iter().map(get).collect();
        change(name, &mut values);
        archive.numbers(name, values.len(), values.into_iter())
    };
    column("step", &|state| state.step as f64)?;
    column("ix", &|state| state.node.0 as f64)?;
    column("iy", &|state| state.node.1 as f64)?;
    column("contact_nodes", &|state| state.contact.contact_nodes as f64)?;
    column("event", &|state| code(state.event) as f64)?;
    for Column { name, get, .. } in COLUMNS {
        column(name, &get)?;
    }
    archive.matrix("heights", record.heights.matrix())?;
    archive.finish()?;
    Ok(bytes)
}

/// What becomes of a column, by its name.
type Change<'a> = &'a dyn Fn(&str, &mut Vec<f64>);

/// Whole archives of something else: refused, and for their own reason.
#[test]
fn archives_that_are_no_record_are_refused() -> Result<(), Box<dyn std::error::Error>> {
    let record = record()?;
    let name = format!("asperity-other-{}.npz", std::process::id());
    let file = std::env::temp_dir().join(name);
    let read = |parameters: &str, change: Change| {
        let written = archive(&record, parameters, change).and_then(|b| std::fs::write(&file, b));
        (written, LoadingRecord::read_npz(&file))
    };
    let text = serde_json::to_string(&record.parameters())?;
    let as_it_is = |_: &str, _: &mut Vec<f64>| {};
    let (written, same) = read(&text, &as_it_is);
    written?;
    assert_eq!(same?.states(), record.states());

    let newer = text.replace("\"version\":1", "\"version\":3");
    let other = text.replace(NAME, "lens prescription");
    let three = |name: &str, values: &mut Vec<f64>| {
        if name == "load" {
            values.truncate(3);
        }
    };
    let event = |name: &str, values: &mut Vec<f64>| {
        if name == "event" {
            values[1] = 4.0;
        }
    };
    let cases: [(&str, Change, &str); 5] = [
        (&newer, &as_it_is, "version 3 is newer than 2, which this program reads"),
        (&other, &as_it_is, "it holds 'lens prescription'"),
        ("{}", &as_it_is, "its parameters are not understood: missing field `format`"),
        (&text, &three, "member 'load': it has 3 numbers, but there are 4 states"),
        (&text, &event, "no event is 4"),
    ];
    for (parameters, change, expected) in cases {
        let (written, found) = read(parameters, change);
        written?;
        let Err(Error::File(FileError::BadFile { path, format: NAME, reason, .. })) = found else {
            std::fs::remove_file(&file)?;
            return Err(format!("{expected}: {found:?}").into());
        };
        assert_eq!(path, file);
        assert!(reason.starts_with(expected), "{reason}");
    }
    std::fs::remove_file(&file)?;
    Ok(())
}
