//! Windows with a factor on bodies on which nodes may leave: until one does.
//!
//! Nodes only touch in such a window. Between two events every pressure and every gap is a line, so that its values at
//! the events tell all. With the factor R of the Schur complement of the nodes J that touch at the times tⱼ, and what
//! they close by as the others before them are eliminated, cⱼ (t − tⱼ) at the time t, the pressures of the contact I,
//! and the gap of a node o that is neither watched nor in contact, are
//!
//! ```text
//! p(t) = p(0) + t p'(0) − Σⱼ Bⱼ cⱼ (t − tⱼ),    B = C_II⁻¹ C_IJ R⁻ᵀ
//! g(t) = g(0) + t g'(0) + Σⱼ wⱼ cⱼ (t − tⱼ),    w = R⁻¹ C_Jo − Bᵀ C_Io
//! ```
//!
//! with sums h(t) over the events so far. A window ends with the last event before a pressure falls to zero. Most nodes
//! stay open by a bound: h is known at the end T, and the squares of w sum to S_oo at most, which is no greater than
//! C(0, 0), so that with any α and β
//!
//! ```text
//! |h(t) − α h(T) − β h'(T)|² ≤ C(0, 0) Σⱼ cⱼ² ((t − tⱼ)₊ − α (T − tⱼ) − β)²
//! ```

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, Mat, MatMut, MatRef, Par};
use nalgebra::DMatrix;

use crate::Error;
use crate::loading::gap_field::GapLine;
use crate::loading::run::LoadingRun;
use crate::loading::tuning::{LEAST_DETERMINANT, LEAST_RATE};
use crate::loading::window::Window;
use crate::parallel;
use crate::updater::{Solution, WindowFactor};

/// Gaps that are looked at together, at the speed of a matrix product.
const AT_ONCE: usize = 96;

/// Pressures and gaps when a window begins, and how its events change them.
pub(super) struct AtStart {
    /// Of the contact.
    solution: Solution,
    /// Of the nodes that are not watched.
    gaps: Vec<(usize, GapLine)>,
    /// Times of the events, and what the gaps there close by.
    times: Vec<f64>,
    closing: Vec<f64>,
    /// R and B.
    own: Mat<f64>,
    relief: DMatrix<f64>,
}

impl AtStart {
    /// From C_II⁻¹ C_IJ for the nodes of the events.
    pub(super) fn of(
        run: &LoadingRun,
        window: &Window,
        mut relief: DMatrix<f64>,
        unwatched: impl Iterator<Item = usize>,
    ) -> Result<Self, Error> {
        let factor = window.touched_factor()?;
        let (nodes, events) = relief.shape();
        let own = Mat::from_fn(events, events, |i, t| {
            if t <= i { factor.column(t)[factor.positions()[i]] } else { 0.0 }
        });
        let columns = MatMut::from_column_major_slice_mut(relief.as_mut_slice(), nodes, events);
        solve_lower_triangular_in_place(own.as_ref(), columns.transpose_mut(), Par::Seq);
        Ok(Self {
            solution: run.field.solution().clone(),
            gaps: unwatched.map(|node| (node, run.line(node))).collect(),
            times: window.events().iter().map(|event| event.time).collect(),
            closing: window.reduced(usize::MAX, 0.0).into_iter().map(|[_, rate]| rate).collect(),
            own,
            relief,
        })
    }

    /// How many events come before a pressure falls to zero, on the contact or on a node that has touched: the first at
    /// least. Zero are pressures up to `tension`, so that a release which ties with a touch is none of the window's.
    pub(super) fn before_release(&self, factor: &WindowFactor, tension: f64) -> usize {
        let Solution { pressure, rate } = &self.solution;
        let slowest = -LEAST_RATE * rate.iter().copied().fold(0.0, f64::max);
        let has_left = |p: f64, rate: f64| p < -tension || p <= tension && rate < slowest;
        let first = self.times.first().copied().unwrap_or_default();
        let lines = pressure.iter().zip(rate).map(|(p, rate)| [p + first * rate, *rate]);
        let mut contact: Vec<[f64; 2]> = lines.collect();
        let mut touched: Vec<[f64; 2]> = Vec::new();
        for (k, times) in (1..).zip(self.times.windows(2)) {
            let span = times[1] - times[0];
            let closing = self.closing[k - 1];
            let mut left = false;
            for ([p, rate], relief) in contact.iter_mut().zip(self.relief.column(k - 1).iter()) {
                *rate -= closing * relief;
                *p += span * *rate;
                left |= has_left(*p, *rate);
            }
            let mut pressed = vec![[0.0]; k];
            pressed[k - 1] = [closing];
            factor.solve_back(&mut pressed);
            touched.push([0.0; 2]);
            for ([p, rate], [more]) in touched.iter_mut().zip(pressed) {
                *rate += more;
                *p += span * *rate;
                left |= has_left(*p, *rate);
            }
            if left {
                return k;
            }
        }
        self.times.len()
    }

    /// How many of the first `count` events come before a node that is not watched touches, when these have joined and
    /// the solution is that at the last of them.
    pub(super) fn before_others(
        &self,
        run: &LoadingRun,
        (window, count): (&Window, usize),
        overlap: f64,
    ) -> usize {
        let (times, closing) = (&self.times[..count], &self.closing[..count]);
        let Some(&span) = times.last().filter(|_| count > 1) else {
            return count;
        };
        let (problem, table) = (&run.problem, run.problem.table());
        let end = run.scalars.approach() + span;
        let bounds: Vec<Bound> = times
            .iter()
            .map(|&time| Bound::at(time, times, closing, table.self_influence()))
            .collect();
        // Whoever is far from touching stays open by a coarser bound.
        let coarse = bounds.iter().map(|bound| bound.most).fold(0.0, f64::max);
        let mut near: Vec<(usize, GapLine)> = Vec::new();
        for &(node, line) in &self.gaps {
            if line.gap - span * line.closing.max(0.0) > coarse {
                continue;
            }
            let at_end = run.field.line(problem, node, end);
            let known =
                [at_end.gap - line.gap + span * line.closing, line.closing - at_end.closing];
            let stays =
                |bound: &Bound| line.gap - bound.time * line.closing + bound.least(known) >= 0.0;
            if !bounds.iter().all(stays) {
                near.push((node, line));
            }
        }
        let place = |&node: &usize| table.place(node);
        let touched: Vec<usize> = window.touched().map(|node| table.place(node)).collect();
        let before = &run.contact.order()[..self.relief.nrows()];
        let contact: Vec<usize> = before.iter().map(place).collect();
        let mut parts: Vec<(&[(usize, GapLine)], usize)> =
            near.chunks(AT_ONCE).map(|part| (part, count)).collect();
        let work = near.len() * count * (contact.len() + count);
        parallel::for_each(work, &mut parts, |(part, stand)| {
            let (nodes, own) = (contact.len(), self.own.get(..count, ..count));
            let mut influence = vec![0.0; nodes * part.len()];
            let mut weights = vec![0.0; count * part.len()];
            for (k, (node, _)) in part.iter().enumerate() {
                let place = table.place(*node);
                table.fill_column(place, &contact, &mut influence[k * nodes..][..nodes]);
                table.fill_column(place, &touched, &mut weights[k * count..][..count]);
            }
            let columns = &mut weights[..];
            let mut columns = MatMut::from_column_major_slice_mut(columns, count, part.len());
            solve_lower_triangular_in_place(own, columns.as_mut(), Par::Seq);
            let relief = &self.relief.as_slice()[..nodes * count];
            let relief = MatRef::from_column_major_slice(relief, nodes, count).transpose();
            let influence = MatRef::from_column_major_slice(&influence, nodes, part.len());
            matmul(columns, Accum::Add, relief, influence, -1.0, Par::Seq);
            for ((_, line), weights) in part.iter().zip(weights.chunks(count)) {
                *stand = first_overlap(line, weights, times, closing, overlap).min(*stand);
            }
        });
        parts.into_iter().map(|(_, stand)| stand).fold(count, usize::min)
    }
}

/// The first event before which a gap closes, by what each event adds to it; their number if it does not.
fn first_overlap(
    line: &GapLine,
    weights: &[f64],
    times: &[f64],
    closing: &[f64],
    overlap: f64,
) -> usize {
    let (mut gap, mut rate) = (line.gap - times[0] * line.closing, -line.closing);
    for k in 1..times.len() {
        rate += closing[k - 1] * weights[k - 1];
        gap += (times[k] - times[k - 1]) * rate;
        if gap < -overlap {
            return k;
        }
    }
    times.len()
}

/// How what events add to a gap at a time follows from what they add at the end and how fast that grows there.
struct Bound {
    time: f64,
    /// α and β.
    weights: [f64; 2],
    /// By how much that may be off, and what they add at most.
    off: f64,
    most: f64,
}

impl Bound {
    /// With the weights for which it is off least.
    fn at(time: f64, times: &[f64], closing: &[f64], self_influence: f64) -> Self {
        let end = times.last().copied().unwrap_or_default();
        let terms = times
            .iter()
            .zip(closing)
            .map(|(touched, c)| [c * (time - touched).max(0.0), c * (end - touched), *c]);
        let mut sums = [[0.0; 3]; 3];
        for term in terms.clone() {
            for (sums, a) in sums.iter_mut().zip(term) {
                sums.iter_mut().zip(term).for_each(|(sum, b)| *sum += a * b);
            }
        }
        let [[yy, ya, yb], [_, aa, ab], [_, _, bb]] = sums;
        let determinant = aa * bb - ab * ab;
        let weights = if determinant > LEAST_DETERMINANT * aa * bb {
            [(ya * bb - yb * ab) / determinant, (yb * aa - ya * ab) / determinant]
        } else {
            [time / end, 0.0]
        };
        let off = terms.map(|[y, a, b]| (y - weights[0] * a - weights[1] * b).powi(2)).sum::<f64>();
        let [off, most] = [off, yy].map(|squares| (self_influence * squares).sqrt());
        Self { time, weights, off, most }
    }

    /// The least that it can be where the end and the slope there are known.
    fn least(&self, known: [f64; 2]) -> f64 {
        let [alpha, beta] = self.weights;
        alpha * known[0] + beta * known[1] - self.off
    }
}
