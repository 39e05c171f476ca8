//! What the other programs found, and whether our side of it is still ours.

use crate::{ours, surfaces};
use asperity_cli::outcome::Failure;

const TABLE: &str = include_str!("peers.csv");
const WAVES: &str = include_str!("waves.csv");
/// Our numbers in the table and now may differ by rounding, on another machine, and by the tolerance of the solutions.
const SAME: f64 = 1e-8;

/// One solution of another program beside ours.
pub(crate) struct Row {
    pub(crate) program: String,
    pub(crate) version: String,
    pub(crate) tolerance: f64,
    pub(crate) half_space: String,
    pub(crate) surface: String,
    /// Nodes with pressure in one of the solutions only.
    pub(crate) nodes_different: usize,
    /// Greatest at any node, over the greatest pressure.
    pub(crate) pressure_difference: f64,
    /// Of the mean gap, over the rms height.
    pub(crate) gap_difference: f64,
    /// Of the stiffness, relative; `None` where a node joined in between or the mean gap is closed.
    pub(crate) stiffness_difference: Option<f64>,
}

/// A line of the file.
type Line = (
    String,
    String,
    f64,
    String,
    String,
    f64,
    usize,
    usize,
    usize,
    f64,
    f64,
    f64,
    f64,
    f64,
    f64,
    usize,
);

/// All rows, after our side of each was solved again.
pub(crate) fn read() -> Result<Vec<Row>, Failure> {
    let failed = |error: asperity::Error| Failure::new("the comparison with other programs", error);
    let bad = |error: csv::Error| Failure::new("cannot read peers.csv", error);
    let mut reader = csv::Reader::from_reader(TABLE.as_bytes());
    let lines: Vec<Line> = reader.deserialize().collect::<Result<_, _>>().map_err(bad)?;
    let mut rows = Vec::new();
    for rough in surfaces::all().map_err(failed)? {
        let rms_height = rough.heights.rms_height();
        for solved in ours::solve(&rough).map_err(failed)? {
            let state = &solved.solution.contact;
            let stiffness = state.interfacial_stiffness.unwrap_or(f64::NAN);
            let of = lines.iter().filter(|line| {
                line.4 == rough.name
                    && line.3 == solved.half_space
                    && (line.5 / solved.mean_pressure - 1.0).abs() < SAME
            });
            for line in of {
                let same = line.7 == solved.nodes
                    && (line.12 - state.mean_gap).abs() <= SAME * rms_height
                    && (line.14 / stiffness - 1.0).abs() <= SAME;
                if !same {
                    return Err(Failure::request(format!(
                        "our side of peers.csv is another one by now ({}, {}, p/E* = {:e}: {} nodes, not {}): run \
                         peers.sh again",
                        rough.name, solved.half_space, solved.mean_pressure, solved.nodes, line.7,
                    )));
                }
                let joined = line.15 != line.6;
                let difference = (line.13 / stiffness - 1.0).abs();
                rows.push(Row {
                    program: line.0.clone(),
                    version: line.1.clone(),
                    tolerance: line.2,
                    half_space: line.3.clone(),
                    surface: line.4.clone(),
                    nodes_different: line.8,
                    pressure_difference: line.10,
                    gap_difference: (line.11 - line.12).abs() / rms_height,
                    stiffness_difference: (!joined).then_some(difference),
                });
            }
        }
    }
    Ok(rows)
}

/// How a program answers one wave.
pub(crate) struct Wave {
    pub(crate) nx: usize,
    pub(crate) ny: usize,
    /// `x` or `y`.
    pub(crate) axis: String,
    pub(crate) wave_number: usize,
    pub(crate) program: String,
    /// Displacement over 2/(E* |q|).
    pub(crate) response: f64,
}

/// The answers of the other programs to the shortest waves.
pub(crate) fn waves() -> Result<Vec<Wave>, Failure> {
    let mut reader = csv::Reader::from_reader(WAVES.as_bytes());
    let rows = reader.deserialize::<(usize, usize, String, usize, String, f64)>();
    let wave = rows.map(|row| {
        row.map(|(nx, ny, axis, wave_number, program, response)| Wave {
            nx,
            ny,
            axis,
            wave_number,
            program,
            response,
        })
    });
    wave.collect::<Result<_, _>>().map_err(|error| Failure::new("cannot read waves.csv", error))
}
