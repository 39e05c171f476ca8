use std::io::{Cursor, ErrorKind};

use super::*;
use crate::loading::LoadingBuilder;
use crate::surface::{Amplitude, Paraboloid, SelfAffine};
use crate::updater::{ConjugateGradient, LinearUpdater, RecursiveCholesky};
use crate::{Boussinesq, InfluenceKernel, LoadingSolver, PeriodicBoussinesq};

/// A path of four states.
fn record() -> Result<LoadingRecord, Error> {
    let half_space = Boussinesq::new(Grid::square(2, 1.0)?, 1.0)?;
    let mut path = LoadingSolver::new(&Paraboloid::new(10.0)?, &half_space)?;
    let history = path.run()?;
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
    column("event", &|state| f64::from(state.event.code()))?;
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
        (&text, &three, "member 'load': it has 3 numbers, and 4 were expected"),
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

/// A member of an archive.
#[derive(Clone)]
enum Member {
    Vector(Vec<f64>),
    Matrix(DMatrix<f64>),
}

impl Member {
    fn values(&mut self) -> &mut [f64] {
        match self {
            Self::Vector(values) => values,
            Self::Matrix(values) => values.as_mut_slice(),
        }
    }
}

/// The members that a record is read from.
fn members(file: &Path) -> Result<Vec<(String, Member)>, Error> {
    let archive = Archive::open(file, NAME)?;
    let whole = ["step", "ix", "iy", "contact_nodes", "event", "yielded_nodes", "heights"];
    let window = "ahead watched places sizes scalars joined proposed coarse numbers directions row_sums pressure rate sums \
                  sums_start displacement rate_displacement sums_displacement";
    let names = whole.into_iter().map(str::to_string);
    let names = names.chain(COLUMNS.iter().map(|column| column.name.to_string()));
    let names = names.chain(PLASTIC_COLUMNS.iter().map(|column| column.name.to_string()));
    let names = names.chain(window.split_whitespace().map(|name| format!("window_{name}")));
    let found = names.filter_map(|name| {
        let vector = archive.vector(&name, None).map(Member::Vector);
        let member = vector.or_else(|_| archive.matrix(&name).map(Member::Matrix));
        Some((name, member.ok()?))
    });
    Ok(found.collect())
}

fn with_members(parameters: &str, members: &[(String, Member)]) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut archive = ArchiveWriter::new(Cursor::new(&mut bytes));
    archive.text("parameters", parameters)?;
    for (name, member) in members {
        match member {
            Member::Vector(values) => {
                archive.numbers(name, values.len(), values.iter().copied())?;
            }
            Member::Matrix(matrix) => archive.matrix(name, matrix)?,
        }
    }
    archive.finish()?;
    Ok(bytes)
}

/// Records of a path with a factor, without one, and with a hardness, on both half-spaces: between two ends of windows.
fn records() -> Result<Vec<(LoadingRecord, bool)>, Error> {
    let grid = Grid::new(10, 9, 1.0, 1.0)?;
    let surface = SelfAffine::new(0.8, 8.0, 2.5, Amplitude::RmsHeight(0.1), 3)?;
    let free = Boussinesq::new(grid, 1.0)?;
    let periodic = PeriodicBoussinesq::new(grid, 1.0)?;
    let kernels: [&dyn InfluenceKernel; 2] = [&free, &periodic];
    let mut records = Vec::new();
    for kernel in kernels {
        let builder = LoadingSolver::builder(&surface, kernel);
        let with =
            |builder: LoadingBuilder<'_>| followed(builder.updater(RecursiveCholesky::new()));
        records.push((with(builder.clone())?, true));
        records.push((with(builder.clone().hardness(0.05))?, true));
        records.push((followed(builder.updater(ConjugateGradient::new()))?, false));
    }
    Ok(records)
}

fn followed<U: LinearUpdater>(builder: LoadingBuilder<'_, U>) -> Result<LoadingRecord, Error> {
    let mut path = builder.build()?;
    let history: History = path.by_ref().take(40).collect::<Result<_, _>>()?;
    LoadingRecord::new(&path, history)
}

/// The states behind those of a record, if the path goes on.
fn next_states(record: &LoadingRecord, has_factor: bool) -> Result<Vec<LoadingState>, Error> {
    let kernel = record.make_kernel()?;
    let hardness = record.hardness_map()?;
    let builder = record.builder(&kernel, hardness.as_ref());
    if has_factor {
        builder.updater(RecursiveCholesky::new()).resume(record.history())?.take(30).collect()
    } else {
        builder.updater(ConjugateGradient::new()).resume(record.history())?.take(30).collect()
    }
}

/// Whether states are the same within ten times what they say of their error, and to 10⁻⁶, to which a resumed path
/// recognises itself.
fn are_close(a: &LoadingState, b: &LoadingState) -> bool {
    let off = 1e-6 + 10.0 * (a.approach_error + b.approach_error);
    let close = |a: Option<f64>, b: Option<f64>| match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() <= off * (1.0 + b.abs()),
        (a, b) => a == b,
    };
    let (one, other) = (&a.contact, &b.contact);
    (a.step, a.event, a.node) == (b.step, b.event, b.node)
        && close(Some(one.approach), Some(other.approach))
        && close(Some(one.load), Some(other.load))
        && close(Some(one.mean_gap), Some(other.mean_gap))
        && close(Some(one.energy), Some(other.energy))
        && close(one.interfacial_stiffness, other.interfacial_stiffness)
}

/// Whether a change may be taken as it is. Two things follow from nothing: an estimated error that is no more than a
/// tenth of the lengths, and a stiffness of the last state, from which the path goes on with its own. It is between
/// bounds, which are wide for few nodes.
fn is_free(name: &str, is_last: bool, is_double: bool) -> bool {
    name == "approach_error"
        || (is_last && is_double && ["contact_stiffness", "interfacial_stiffness"].contains(&name))
}

/// Every array is changed at some places, to nothing, the negative, something huge and the double. Each change is
/// refused when the record is read; or the numbers of its states are what they were, and the path does not go on, or
/// goes on as it would have.
#[test]
fn changed_numbers_are_refused_or_change_nothing() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::temp_dir().join(format!("asperity-changed-{}.npz", std::process::id()));
    let changes: [fn(f64) -> f64; 4] = [|_| 0.0, |x| -x, |_| 1e300, |x| 2.0 * x];
    let (mut tried, mut refused, mut stopped) = (0, 0, 0);
    for (record, has_factor) in records()? {
        record.write_npz(&file, &[])?;
        let expected = next_states(&record, has_factor)?;
        let parameters = serde_json::to_string(&record.parameters())?;
        let all = members(&file)?;
        for (k, (name, member)) in all.iter().enumerate() {
            let last = member.clone().values().len().saturating_sub(1);
            let mut places = vec![0, last / 3, 2 * last / 3, last];
            places.dedup();
            for (place, change) in places.iter().flat_map(|place| changes.map(|c| (*place, c))) {
                let mut members = all.clone();
                let Some(value) = members[k].1.values().get_mut(place) else { continue };
                let old = std::mem::replace(value, change(*value));
                if *value == old || value.is_nan() {
                    continue;
                }
                let new = *value;
                tried += 1;
                std::fs::write(&file, with_members(&parameters, &members)?)?;
                let Ok(read) = LoadingRecord::read_npz(&file) else {
                    refused += 1;
                    continue;
                };
                let is_same = |(a, b): (&LoadingState, &LoadingState)| {
                    a.contact == b.contact && a.approach_error == b.approach_error
                };
                let numbers = read.states().iter().zip(record.states()).all(is_same);
                let is_same = numbers && read.heights() == record.heights();
                let free = is_free(name, place == last, new == 2.0 * old);
                assert!(is_same || free, "{name}, {place}: {old:e} was changed to {new:e}");
                match next_states(&read, has_factor) {
                    Err(_) => stopped += 1,
                    Ok(next) => {
                        let as_before = next.len() == expected.len()
                            && next.iter().zip(&expected).all(|(a, b)| are_close(a, b));
                        assert!(as_before, "{name}, {place}: {old:e} was changed to {new:e}");
                    }
                }
            }
        }
    }
    std::fs::remove_file(&file)?;
    println!("{tried} changes: {refused} refused, {stopped} refused as the path goes on");
    assert!(tried > 1500 && refused > 1100 && stopped > 200, "{tried} {refused} {stopped}");
    Ok(())
}
