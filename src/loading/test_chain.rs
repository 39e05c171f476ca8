//! Paths on nodes in a row, whose numbers can be worked out by hand: see [`test_chain`](crate::test_chain).

use nalgebra::DMatrix;

use super::gap_field::GapLine;
use super::run::LoadingRun;
use super::solver::LoadingSolver;
use super::state::ContactEvent;
use super::tolerances::WindowTolerances;
use super::window::{Course, Window, WindowEvent};
use crate::updater::Dense;
pub(super) use crate::updater::test_altered::Altered;
use crate::{Error, test_chain};

/// A path that has not begun.
pub(super) fn run(gaps: &[f64]) -> Result<LoadingRun, Error> {
    let (surface, kernel) = (test_chain::surface(gaps)?, test_chain::kernel(gaps.len())?);
    let builder = LoadingSolver::builder(&surface, &kernel).updater(Dense);
    Ok(builder.build()?.into_path().run)
}

/// A path with nodes in contact, solved at an approach.
pub(super) fn solved(gaps: &[f64], contact: &[usize], approach: f64) -> Result<LoadingRun, Error> {
    let mut run = run(gaps)?;
    for &node in contact {
        run.contact.push(node)?;
    }
    run.scalars.place_at(approach);
    run.renew_field(&mut Dense, approach)?;
    Ok(run)
}

/// The same with all scalars known there.
pub(super) fn surveyed(
    gaps: &[f64],
    contact: &[usize],
    approach: f64,
) -> Result<LoadingRun, Error> {
    let mut run = solved(gaps, contact, approach)?;
    let LoadingRun { problem, contact, field, scalars, .. } = &mut run;
    scalars.renew_load(problem, contact, field);
    run.survey(None, |_, _| ())?;
    Ok(run)
}

/// A window from the approach 1 on: nodes, `[gap, closing]` of each, their Schur complement, and their row sums.
pub(super) fn window(
    lines: &[(usize, [f64; 2])],
    matrix: &DMatrix<f64>,
    row_sums: &[f64],
    horizon: f64,
) -> Window {
    let mut window = Window::default();
    let lines = lines.iter().map(|&(node, line)| (node, gap_line(line)));
    let (nodes, schur) = window.open((1.0, horizon), lines);
    assert!(schur.resize(nodes.len()).is_ok());
    schur.matrix_mut().copy_from(matrix);
    schur.row_sums_mut().copy_from_slice(row_sums);
    window.begin();
    window
}

/// A window of nodes that do not act on each other, each with its gap; all close at the rate 1.
pub(super) fn apart(gaps: &[(usize, f64)], horizon: f64) -> Window {
    let size = gaps.len();
    let lines: Vec<_> = gaps.iter().map(|&(node, gap)| (node, [gap, 1.0])).collect();
    // Each acts on itself and two neighbours.
    let (matrix, row_sums) = (DMatrix::from_diagonal_element(size, size, 4.0), vec![6.0; size]);
    window(&lines, &matrix, &row_sums, horizon)
}

/// The Schur complement of a window.
pub(super) fn matrix(window: &Window) -> DMatrix<f64> {
    let (schur, size) = (window.schur(), window.nodes().len());
    DMatrix::from_fn(size, size, |i, j| schur.entry(i, j))
}

pub(super) fn gap_line([gap, closing]: [f64; 2]) -> GapLine {
    GapLine { gap, closing }
}

/// `c₀ − c₁ t + c₂ t² + c₃ t³`.
pub(super) fn course([c0, c1, c2, c3]: [f64; 4]) -> Course {
    Course { line: gap_line([c0, c1]), curve: [c2, c3] }
}

/// Events from (position, time).
pub(super) fn events(pairs: &[(usize, f64)]) -> Vec<WindowEvent> {
    let event = |&(position, time): &(usize, f64)| {
        let kind = ContactEvent::Touch;
        WindowEvent { position, kind, time, closing: 1.0 }
    };
    pairs.iter().map(event).collect()
}

/// (position, time) of events.
pub(super) fn pairs(events: &[WindowEvent]) -> Vec<(usize, f64)> {
    let pair = |event: &WindowEvent| (event.position, event.time);
    events.iter().map(pair).collect()
}

pub(super) fn tolerances(length: f64, tolerance: f64, tie: f64) -> WindowTolerances {
    WindowTolerances { length, tolerance, tie }
}
