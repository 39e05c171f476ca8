//! Paths on disk: whole ones, and archives that somebody has tampered with.

use std::io::{Cursor, Read, Write};

use allocation_counter::measure;
use asperity::Error;
use asperity::contact::ContactFields;
use asperity::loading::{History, LoadingState};
use asperity::record::LoadingRecord;
use asperity::updater::RecursiveCholesky;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use crate::dense::Dense;
use crate::draw::Draw;
use crate::edits::edit;
use crate::kernels::{self, Class};
use crate::limits::Limit;
use crate::problem::Sample;
use crate::refusal::Circumstances;
use crate::scratch::{Scratch, bytes_of};
use crate::verdict::{Tally, Verdict, Violation, ensure};
use crate::walk::{Demands, Walk};

/// Bytes of memory for each byte of an archive: what deflate can make of it, a fourteenth of which are the columns of a
/// state each, times what a state takes; twice, since vectors grow.
const MEMORY: u64 = 2 * (1032 * 9 + 1032 / 14 * 160);
const ANYWAY: u64 = 1 << 20;
/// Nodes and states up to which a record is brought back to life.
const SMALL: usize = 1 << 10;
/// Longest member of an archive that is made here.
const LONGEST: usize = 1 << 14;
/// Gaps in contact that a replay leaves, relative to the approach: it solves by iterations.
const ITERATED: f64 = 1e-10;

/// Reads bytes as a record: as they are, or as a true record, whole or with members that were tampered with behind its
/// checksums. No panic, bounded memory; a whole record comes back as it was, with the fields of its states; whatever
/// was read can be written and read again, and goes on or says why not.
///
/// # Errors
///
/// What is wrong.
pub fn records(bytes: &[u8]) -> Verdict {
    let mut draw = Draw::new(bytes);
    let scratch = Scratch::new()?;
    if draw.once_in(4) {
        return read(draw.rest(), &scratch);
    }
    Sample::look(&mut draw, kernels::DEFINITE, |sample, draw| whole(sample, draw, &scratch))
}

/// A record of a true path: the same after it was written, and hostile after it was tampered with.
pub(crate) fn whole(sample: &Sample, draw: &mut Draw<'_>, scratch: &Scratch) -> Verdict {
    let Some((record, states)) = record(sample, draw)? else {
        return Ok(Tally::default());
    };
    let failed = |error: Error| Violation::new(format!("a whole record: {error}"));
    let path = scratch.path("record.npz");
    record.write_npz(&path, &[]).map_err(failed)?;
    let again = LoadingRecord::read_npz(&path).map_err(failed)?;
    ensure!(same(&record, &again), "a record is not what it was after it was written");
    let mut tally = bring_back(sample, &again, &states, draw)?;
    if draw.once_in(2) {
        let archive = bytes_of(&path)?;
        tally += read(&tampered(&archive, draw)?, scratch)?;
    }
    Ok(tally)
}

/// A path to a limit as a record; none if it failed, of which the driver of paths has to say something.
fn record(
    sample: &Sample,
    draw: &mut Draw<'_>,
) -> Result<Option<(LoadingRecord, Vec<LoadingState>)>, Violation> {
    let follow = |limit: Limit| -> Result<_, Error> {
        let builder = sample.path().updater(RecursiveCholesky::new());
        let mut path = limit.set(builder).build()?;
        let states: Vec<LoadingState> = path.by_ref().collect::<Result<_, _>>()?;
        Ok((path, states))
    };
    let Ok((_, states)) = follow(Limit::None) else {
        return Ok(None);
    };
    let dense = Dense::of_sample(sample).in_gauge_of_paths(sample.kernel.contact_growth());
    let limit = Limit::draw(draw, &states, &sample.kernel.grid()).unless_rounding(&dense, &states);
    let Ok((path, mut states)) = follow(limit) else {
        return Ok(None);
    };
    if draw.once_in(3) {
        states.truncate(draw.whole(0, states.len()));
    }
    let history: History = states.iter().copied().collect();
    match LoadingRecord::new(&path, history) {
        Ok(record) => Ok(Some((record, states))),
        Err(error) => Err(Violation::new(format!("no record of a path: {error}"))),
    }
}

fn same(a: &LoadingRecord, b: &LoadingRecord) -> bool {
    a.grid() == b.grid()
        && a.heights() == b.heights()
        && a.kernel() == b.kernel()
        && a.settings() == b.settings()
        && a.states() == b.states()
        && a.end() == b.end()
}

/// Fields of a state of a record, against dense ones.
fn bring_back(
    sample: &Sample,
    record: &LoadingRecord,
    states: &[LoadingState],
    draw: &mut Draw<'_>,
) -> Verdict {
    let dense = Dense::of_sample(sample).in_gauge_of_paths(sample.kernel.contact_growth());
    let circumstances = Circumstances {
        tolerance: Some(ITERATED),
        ..Circumstances::of(&dense, sample.kernel.contact_growth())
    };
    let ours = matches!(
        sample.class,
        Class::Free
            | Class::Periodic
            | Class::Spectral
            | Class::AlongX
            | Class::AlongY
            | Class::Soft
            | Class::SoftPeriodic
            | Class::Layers
            | Class::LayersPeriodic
            | Class::LayersSpectral
    );
    // Gauges that are both exchanged for another one are one kernel to compute with.
    let may_be = matches!(sample.class, Class::PeriodicInGauge | Class::SpectralInGauge);
    ensure!(
        may_be || record.make_kernel().is_ok() == ours,
        "the kernel of the record: {:?}",
        record.make_kernel().err()
    );
    let Some(last) = states.len().checked_sub(1) else {
        return Ok(Tally::default());
    };
    let replay = record.replay_on(&sample.kernel);
    let mut replay = replay.map_err(|error| Violation::new(format!("no replay: {error}")))?;
    let k = draw.whole(0, last);
    match replay.fields_at(&states[k]) {
        Ok(ContactFields { pressure, gap, plastic_depth, .. }) => {
            let demands = Demands { residual: ITERATED, ..Demands::EXACT };
            let mut walk = Walk::new(&dense, record.grid(), demands);
            walk.skip(&states[..=k])?;
            walk.compare_fields(&states[k], [&pressure, &gap, &plastic_depth])
                .map_err(|violation| violation.during(format!("replay of {:?}", states[k])))?;
            Ok(walk.tally())
        }
        Err(error) => circumstances.judge(&error),
    }
}

/// The archive with one or two members that somebody has changed, and with checksums that say they are right.
fn tampered(archive: &[u8], draw: &mut Draw<'_>) -> Result<Vec<u8>, Violation> {
    let failed = |error: zip::result::ZipError| Violation::new(format!("an archive: {error}"));
    let io = |error: std::io::Error| Violation::new(format!("an archive: {error}"));
    let mut members = ZipArchive::new(Cursor::new(archive)).map_err(failed)?;
    let count = members.len();
    let victims = [draw.whole(0, count - 1), draw.whole(0, count - 1)];
    let method = match draw.once_in(2) {
        true => CompressionMethod::Deflated,
        false => CompressionMethod::Stored,
    };
    let options = SimpleFileOptions::default().compression_method(method);
    let mut output = ZipWriter::new(Cursor::new(Vec::new()));
    for k in 0..count {
        let mut member = members.by_index(k).map_err(failed)?;
        let mut bytes = Vec::new();
        member.read_to_end(&mut bytes).map_err(io)?;
        if victims.contains(&k) {
            edit(draw, &mut bytes, LONGEST);
        }
        let name = member.name().map_err(failed)?.into_owned();
        output.start_file(name, options).map_err(failed)?;
        output.write_all(&bytes).map_err(io)?;
    }
    Ok(output.finish().map_err(failed)?.into_inner())
}

/// Reads a hostile archive, and does with it whatever can be done.
fn read(bytes: &[u8], scratch: &Scratch) -> Verdict {
    let path = scratch.file("hostile.npz", bytes)?;
    let mut outcome = None;
    let memory = measure(|| outcome = Some(LoadingRecord::read_npz(&path)));
    let limit = ANYWAY + MEMORY * bytes.len() as u64;
    ensure!(
        memory.bytes_max <= limit,
        "{} bytes of memory for a record of {}, more than {limit}",
        memory.bytes_max,
        bytes.len()
    );
    let record = match outcome {
        Some(Ok(record)) => record,
        Some(Err(error)) => {
            ensure!(!error.to_string().is_empty(), "a refusal without a reason");
            return Ok(Tally::refusal());
        }
        None => return Err(Violation::new("nothing was read")),
    };
    let failed = |error: Error| Violation::new(format!("a record that was read: {error}"));
    let again = scratch.path("again.npz");
    record.write_npz(&again, &[]).map_err(failed)?;
    let again = LoadingRecord::read_npz(&again).map_err(failed)?;
    ensure!(same(&record, &again), "a record is not what it was after it was written");
    record.contact().map_err(failed)?;
    if record.grid().nodes() <= SMALL && record.states().len() <= SMALL {
        // Answers or errors: numbers that somebody has changed are no path.
        if let (Ok(mut replay), Some(last)) = (record.replay(), record.states().last()) {
            let _ = replay.fields_at(last);
        }
        if let Ok(path) = record.resume() {
            for state in path.take(SMALL) {
                if state.is_err() {
                    break;
                }
            }
        }
    }
    Ok(Tally { checked: 1, ..Tally::default() })
}
