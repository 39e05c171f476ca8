//! The end of a window in an archive: members that begin with `window_`, beside whole numbers in the parameters.
//!
//! * `window_ahead`, `window_plastic`: states that the path has not returned yet, 14 numbers each: `step`, `ix`,
//!   `iy`, `contact_nodes`, `event`, and the columns from `approach` to `approach_error`; with a hardness 5 more,
//!   from `yielded_nodes` on.
//! * `window_watched`, `window_places`, `window_sizes`: with a factor: the nodes that each window watched, places of
//!   those that touched among them, and 3 numbers for each window: nodes watched, touched, and of these not taken
//!   back.
//! * `window_left`, `window_yielded`: 2 numbers each: with a factor, for each node that left, windows before and its
//!   place in the order of contact; for each window in which nodes yielded, windows before (only with a factor) and
//!   nodes that yielded.
//! * `window_scalars`: with a factor, and after a single event without one: approach, load, energy, mean gap,
//!   stiffness and closing rate at the end of the window.
//! * `window_joined`, `window_proposed`, `window_row_sums`: without a factor, as all that follow: nodes in the order
//!   in which the end was solved; nodes that were watched, and row sums of their Schur complement.
//! * `window_numbers`: spans of the window and its rates \[m\], error of pivots, tolerance, approach \[m\], span that
//!   the rates serve \[m\], errors of three displacements.
//! * `window_pressure`, `window_rate`, `window_displacement`, `window_rate_displacement`: pressure in contact at the
//!   end of the window and its rate, by node index, and the displacements under them; with a factor pressure and rate
//!   in the order of contact, if nodes yielded in the window.
//! * `window_sums`, `window_sums_start`, `window_sums_displacement`: row sums of the influence matrix with the
//!   contact eliminated, unless periodic along x and y.
//! * `window_directions`, `window_coarse`: search directions of the last solution, unless periodic along x and y and
//!   no node may yield; contact of the preconditioner's coarse matrix.
//! * `window_beside_nodes`, `window_beside_pressures`, `window_beside_errors`: as all that follow, once nodes may
//!   yield: nodes that yielded in the window, their hardness \[Pa\], and three errors of the displacements below.
//! * `window_gap_sums`, `window_depth_sums`, `window_work_sums`, `window_gap_sums_displacement`,
//!   `window_depth_sums_displacement`: response of the sums of gaps, plastic depths, and these times the hardness, to
//!   a displacement of the contact, and the displacements under them (with a hardness of each node
//!   `window_work_sums_displacement` as well); empty where one follows from another.
//! * `window_unit_displacement`, `window_load_displacement`: displacement under a pressure of 1, and under their
//!   hardness, of the nodes that yielded before the window.

use std::io::{Seek, Write};

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::{COLUMNS, Column, PLASTIC_COLUMNS, event, whole};
use crate::contact::{ContactState, PlasticState};
use crate::io::archive::{Archive, ArchiveWriter};
use crate::loading::{EstimatedEnd, FactorEnd, FactorLog, LoadingState, NextWindow, WindowEnd};
use crate::updater::{Kept, KeptBeside, KeptField, Solution};
use crate::{Error, Grid};

/// Whole numbers of a state before the columns.
const WHOLE: usize = 5;
/// Numbers of a state on what has yielded.
const PLASTIC: usize = 1 + PLASTIC_COLUMNS.len();

/// Responses of the three sums beside nodes that have yielded, and the displacements under them.
const BESIDE: [[&str; 2]; 3] = [
    ["window_gap_sums", "window_gap_sums_displacement"],
    ["window_depth_sums", "window_depth_sums_displacement"],
    ["window_work_sums", "window_work_sums_displacement"],
];
/// Displacements under the nodes that had yielded before the window.
const UNDER: [&str; 2] = ["window_unit_displacement", "window_load_displacement"];

/// The part of a window's end that is no array.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Numbers {
    handed_over_at: Option<usize>,
    /// Whether nodes may have yielded.
    #[serde(default)]
    has_hardness: bool,
    /// With a factor: the nodes that have left it.
    #[serde(default)]
    left: usize,
    /// The windows in which nodes yielded; and with a factor the nodes of the solution that is kept behind them.
    #[serde(default)]
    yielded: usize,
    #[serde(default)]
    solution: usize,
    /// Without a factor.
    iterations: Option<IterationNumbers>,
}

#[derive(Debug, Serialize, Deserialize)]
struct IterationNumbers {
    settles: bool,
    /// Whether the path is behind a single event.
    #[serde(default)]
    is_single: bool,
    proposed_beside: usize,
    sums_of: usize,
    directions: usize,
    marks: [usize; 2],
    /// Of the proposed nodes those that were out of contact, where nodes in it were proposed as well, and the nodes
    /// that have yielded since.
    #[serde(default)]
    beside: Option<[usize; 2]>,
}

impl Numbers {
    pub(super) fn of(end: &WindowEnd) -> Self {
        let [left, yielded, solution] = match &end.next {
            NextWindow::Factor(end) => {
                let solution = end.solution.as_ref();
                let nodes = solution.map_or(0, |solution| solution.pressure.len());
                [end.log.left.len(), end.log.yielded.len(), nodes]
            }
            NextWindow::Iterations(end) => [0, end.yielded.len(), 0],
        };
        let iterations = match &end.next {
            NextWindow::Factor(_) => None,
            NextWindow::Iterations(end) => Some(IterationNumbers {
                settles: end.settles,
                is_single: end.scalars.is_some(),
                proposed_beside: end.kept.proposed_beside,
                sums_of: end.kept.sums_of,
                directions: end.kept.directions.len(),
                marks: end.kept.marks,
                beside: end.kept.beside.as_ref().map(|of| [of.outside, of.yielded.len()]),
            }),
        };
        let handed_over_at = end.handed_over_at;
        let has_hardness = end.ahead.iter().any(|state| state.contact.plastic.is_some());
        Self { handed_over_at, has_hardness, left, yielded, solution, iterations }
    }
}

/// Writes the arrays.
pub(super) fn write(
    end: &WindowEnd,
    grid: &Grid,
    archive: &mut ArchiveWriter<impl Write + Seek>,
) -> std::io::Result<()> {
    let ahead = end.ahead.iter().flat_map(|state| {
        let (ix, iy) = state.node;
        let event = usize::from(state.event.code());
        let whole = [state.step, ix, iy, state.contact.contact_nodes, event];
        let columns = COLUMNS.iter().map(|column| (column.get)(state));
        whole.into_iter().map(|number| number as f64).chain(columns).collect::<Vec<_>>()
    });
    archive.numbers("window_ahead", end.ahead.len() * (WHOLE + COLUMNS.len()), ahead)?;
    if Numbers::of(end).has_hardness {
        let plastic = end.ahead.iter().flat_map(|state| {
            let plastic = state.contact.plastic.unwrap_or_default();
            let columns = PLASTIC_COLUMNS.iter().map(move |column| (column.get)(&plastic));
            std::iter::once(plastic.yielded_nodes as f64).chain(columns)
        });
        archive.numbers("window_plastic", end.ahead.len() * PLASTIC, plastic)?;
    }
    let mut nodes = |name: &str, nodes: &[usize]| {
        archive.integers(name, nodes.len(), nodes.iter().map(|&node| node as i64))
    };
    let end = match &end.next {
        NextWindow::Factor(end) => {
            let FactorEnd { log, scalars, solution } = &**end;
            nodes("window_watched", &log.watched)?;
            nodes("window_places", &log.joined)?;
            nodes("window_sizes", log.windows.as_flattened())?;
            if !log.left.is_empty() {
                nodes("window_left", log.left.as_flattened())?;
            }
            if !log.yielded.is_empty() {
                nodes("window_yielded", log.yielded.as_flattened())?;
            }
            if let Some(Solution { pressure, rate }) = solution {
                archive.numbers("window_pressure", pressure.len(), pressure.iter().copied())?;
                archive.numbers("window_rate", rate.len(), rate.iter().copied())?;
            }
            return archive.numbers("window_scalars", scalars.len(), scalars.iter().copied());
        }
        NextWindow::Iterations(end) => end,
    };
    let kept = &end.kept;
    nodes("window_joined", &end.joined)?;
    nodes("window_proposed", &kept.proposed)?;
    nodes("window_coarse", &kept.coarse)?;
    if !end.yielded.is_empty() {
        nodes("window_yielded", &end.yielded)?;
    }
    if let Some(scalars) = &end.scalars {
        archive.numbers("window_scalars", scalars.len(), scalars.iter().copied())?;
    }
    if let Some(beside) = &kept.beside {
        write_beside(beside, grid, archive)?;
    }
    let numbers = [
        end.last_span,
        end.rate_span,
        end.left_out,
        kept.tolerance,
        kept.approach,
        kept.serves,
        kept.load.drift,
        kept.rate.drift,
        kept.sums.drift,
    ];
    archive.numbers("window_numbers", numbers.len(), numbers.into_iter())?;
    let directions = kept.directions.iter().flatten().map(|&value| f64::from(value));
    let length = kept.directions.iter().map(Vec::len).sum();
    archive.numbers("window_directions", length, directions)?;
    for (name, values) in [
        ("window_row_sums", &kept.row_sums),
        ("window_pressure", &kept.load.pressure),
        ("window_rate", &kept.rate.pressure),
        ("window_sums", &kept.sums.pressure),
        ("window_sums_start", &kept.sums_start),
    ] {
        archive.numbers(name, values.len(), values.iter().copied())?;
    }
    let (nx, ny) = grid.shape();
    for (name, field) in [
        ("window_displacement", &kept.load),
        ("window_rate_displacement", &kept.rate),
        ("window_sums_displacement", &kept.sums),
    ] {
        if !field.displacement.is_empty() {
            archive.matrix(name, &DMatrix::from_column_slice(nx, ny, &field.displacement))?;
        }
    }
    Ok(())
}

/// Writes what iterations go on from beside nodes that have yielded.
fn write_beside(
    beside: &KeptBeside,
    grid: &Grid,
    archive: &mut ArchiveWriter<impl Write + Seek>,
) -> std::io::Result<()> {
    let (nx, ny) = grid.shape();
    let yielded = beside.yielded.iter().map(|&node| node as i64);
    archive.integers("window_beside_nodes", beside.yielded.len(), yielded)?;
    let pressures = beside.pressures.iter().copied();
    archive.numbers("window_beside_pressures", beside.pressures.len(), pressures)?;
    for ([sums, displacement], field) in BESIDE.iter().zip(&beside.sums) {
        archive.numbers(sums, field.pressure.len(), field.pressure.iter().copied())?;
        if !field.displacement.is_empty() {
            let values = DMatrix::from_column_slice(nx, ny, &field.displacement);
            archive.matrix(displacement, &values)?;
        }
    }
    let drifts = beside.sums.iter().map(|field| field.drift);
    archive.numbers("window_beside_errors", BESIDE.len(), drifts)?;
    for (name, under) in UNDER.iter().zip(&beside.under) {
        archive.matrix(name, &DMatrix::from_column_slice(nx, ny, under))?;
    }
    Ok(())
}

/// Reads what [`write_beside`] has written.
fn read_beside(archive: &Archive, [outside, yielded]: [usize; 2]) -> Result<KeptBeside, Error> {
    let nodes = archive.vector("window_beside_nodes", Some(yielded))?;
    let drifts = archive.vector("window_beside_errors", Some(BESIDE.len()))?;
    let mut beside = KeptBeside {
        outside,
        yielded: nodes.into_iter().map(whole).collect(),
        pressures: archive.vector("window_beside_pressures", Some(yielded))?,
        ..KeptBeside::default()
    };
    for (([sums, displacement], field), drift) in BESIDE.iter().zip(&mut beside.sums).zip(drifts) {
        let pressure = archive.vector(sums, None)?;
        if !pressure.is_empty() {
            let displacement = archive.matrix(displacement)?.data.into();
            *field = KeptField { pressure, displacement, drift };
        }
    }
    for (name, under) in UNDER.iter().zip(&mut beside.under) {
        *under = archive.matrix(name)?.data.into();
    }
    Ok(beside)
}

/// Reads what [`write`] has written; whether it is the end of a window of a path turns out when the path goes on.
pub(super) fn read(archive: &Archive, grid: &Grid, numbers: Numbers) -> Result<WindowEnd, Error> {
    let width = WHOLE + COLUMNS.len();
    let ahead = archive.vector("window_ahead", None)?;
    let states = ahead.chunks_exact(width).map(|row| {
        let nodes = whole(row[3]);
        let contact = ContactState::new(grid, nodes, 0.0, 0.0, 0.0);
        // An unknown code becomes an event that no window has.
        let event = event(row[4]).unwrap_or(crate::ContactEvent::Limit);
        let node = (whole(row[1]), whole(row[2]));
        let mut state = LoadingState::new(whole(row[0]), event, node, contact);
        for (Column { set, .. }, value) in COLUMNS.iter().zip(&row[WHOLE..]) {
            set(&mut state, *value);
        }
        state
    });
    let mut ahead: Vec<LoadingState> = states.collect();
    if numbers.has_hardness && !ahead.is_empty() {
        let plastic = archive.vector("window_plastic", ahead.len().checked_mul(PLASTIC))?;
        for (state, numbers) in ahead.iter_mut().zip(plastic.chunks_exact(PLASTIC)) {
            let yielded_nodes = whole(numbers[0]);
            let mut plastic = PlasticState {
                yielded_nodes,
                yielded_area_fraction: yielded_nodes as f64 / grid.nodes() as f64,
                ..PlasticState::default()
            };
            for (column, value) in PLASTIC_COLUMNS.iter().zip(&numbers[1..]) {
                (column.set)(&mut plastic, *value);
            }
            state.contact.plastic = Some(plastic);
        }
    }
    let vector = |name: &str| archive.vector(name, None);
    let nodes = |name: &str| -> Result<Vec<usize>, Error> {
        Ok(vector(name)?.into_iter().map(whole).collect())
    };
    let handed_over_at = numbers.handed_over_at;
    let scalars = || -> Result<[f64; 6], Error> {
        let mut scalars = [0.0; 6];
        scalars.copy_from_slice(&archive.vector("window_scalars", Some(6))?);
        Ok(scalars)
    };
    let Some(iterations) = numbers.iterations else {
        let pairs = |name: &str, count: usize| -> Result<Vec<[usize; 2]>, Error> {
            if count == 0 {
                return Ok(Vec::new());
            }
            let pairs = archive.vector(name, count.checked_mul(2))?;
            let pairs: Vec<usize> = pairs.into_iter().map(whole).collect();
            Ok(pairs.as_chunks().0.to_vec())
        };
        let solution = match numbers.solution {
            0 => None,
            count => Some(Solution {
                pressure: archive.vector("window_pressure", Some(count))?,
                rate: archive.vector("window_rate", Some(count))?,
            }),
        };
        let log = FactorLog {
            watched: nodes("window_watched")?,
            joined: nodes("window_places")?,
            windows: nodes("window_sizes")?.as_chunks().0.to_vec(),
            left: pairs("window_left", numbers.left)?,
            yielded: pairs("window_yielded", numbers.yielded)?,
        };
        let next = NextWindow::Factor(Box::new(FactorEnd { log, scalars: scalars()?, solution }));
        return Ok(WindowEnd { ahead, handed_over_at, next });
    };
    let values = archive.vector("window_numbers", Some(9))?;
    let displacement = |name: &str| archive.matrix(name).map(|field| field.data.into());
    let field = |pressure, displacement, drift| KeptField { pressure, displacement, drift };
    let sums = vector("window_sums")?;
    let sums_displacement =
        if sums.is_empty() { Vec::new() } else { displacement("window_sums_displacement")? };
    let directions = vector("window_directions")?;
    let length = directions.len() / iterations.directions.max(1);
    let directions = directions.chunks_exact(length.max(1));
    let kept = Kept {
        tolerance: values[3],
        approach: values[4],
        serves: values[5],
        load: field(vector("window_pressure")?, displacement("window_displacement")?, values[6]),
        rate: field(vector("window_rate")?, displacement("window_rate_displacement")?, values[7]),
        proposed: nodes("window_proposed")?,
        proposed_beside: iterations.proposed_beside,
        row_sums: vector("window_row_sums")?,
        sums_of: iterations.sums_of,
        sums: field(sums, sums_displacement, values[8]),
        sums_start: vector("window_sums_start")?,
        directions: directions
            .map(|values| values.iter().map(|&value| value as f32).collect())
            .collect(),
        marks: iterations.marks,
        coarse: nodes("window_coarse")?,
        beside: iterations.beside.map(|counts| read_beside(archive, counts)).transpose()?,
    };
    let next = NextWindow::Iterations(Box::new(EstimatedEnd {
        settles: iterations.settles,
        joined: nodes("window_joined")?,
        last_span: values[0],
        rate_span: values[1],
        left_out: values[2],
        yielded: if numbers.yielded == 0 {
            Vec::new()
        } else {
            let counts = archive.vector("window_yielded", Some(numbers.yielded))?;
            counts.into_iter().map(whole).collect()
        },
        scalars: if iterations.is_single { Some(scalars()?) } else { None },
        kept,
    }));
    Ok(WindowEnd { ahead, handed_over_at, next })
}
