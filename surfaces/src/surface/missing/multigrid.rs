//! A multigrid cycle: an approximate solution whose error is as small in long waves as in short ones.

use super::stencil::{Field, Stencil, sum_means};

/// Two steps of Jacobi's iteration that are best for eigenvalues of D⁻¹A between [`SHORTEST`] and 2: the inverse roots
/// of Chebyshev's polynomial. Longer waves are left to the coarser levels, and none is above 2.
const STEPS: [f64; 2] = {
    let (middle, half) = (0.5 * (2.0 + SHORTEST), 0.5 * (2.0 - SHORTEST));
    let root = half * std::f64::consts::FRAC_1_SQRT_2;
    [1.0 / (middle + root), 1.0 / (middle - root)]
};

/// Lower end of the eigenvalues that smoothing is made for.
const SHORTEST: f64 = 0.5;

/// Levels of halved resolution, down to a single node.
///
/// A coarser node stands for two by two nodes and has the mean of their corrections; its equations are
/// [`Stencil::coarser`]. One cycle smooths, corrects the smooth rest from the coarser level, and smooths again in the
/// opposite order, which makes the whole a symmetric, positive definite operator.
#[derive(Debug)]
pub(super) struct Multigrid {
    finest: Level,
    coarser: Vec<(Field, Level)>,
}

/// A level, but for its right side.
#[derive(Debug)]
pub(super) struct Level {
    pub(super) stencil: Stencil,
    pub(super) solution: Field,
    pub(super) scratch: Field,
}

impl Level {
    fn new(stencil: Stencil) -> Self {
        let (nx, ny) = stencil.shape();
        Self { stencil, solution: Field::zeros(nx, ny), scratch: Field::zeros(nx, ny) }
    }
}

impl Multigrid {
    /// All levels of the equations of the finest, given with its weights g.
    pub(super) fn new(finest: Stencil, mut given: Vec<f32>) -> Self {
        let finest = Level::new(finest);
        let mut coarser: Vec<(Field, Level)> = Vec::new();
        loop {
            let last = coarser.last().map_or(&finest, |(_, level)| level);
            if last.stencil.shape() == (1, 1) {
                break;
            }
            let (stencil, held) = last.stencil.coarser(&given);
            let (nx, ny) = stencil.shape();
            coarser.push((Field::zeros(nx, ny), Level::new(stencil)));
            given = held;
        }
        Self { finest, coarser }
    }

    /// The finest level, whose solution is that of the last cycle.
    pub(super) fn finest(&mut self) -> &mut Level {
        &mut self.finest
    }

    /// One cycle for the right side `b`, from zero.
    pub(super) fn cycle(&mut self, b: &Field) {
        cycle(&mut self.finest, b, &mut self.coarser);
    }
}

fn cycle(level: &mut Level, b: &Field, coarser: &mut [(Field, Level)]) {
    let Level { stencil, solution, scratch } = level;
    let Some(((sums, next), rest)) = coarser.split_first_mut() else {
        // A single node: its own equation.
        stencil.relax_zero(1.0, b, solution);
        return;
    };
    let [first, second] = STEPS;
    stencil.relax_zero(first, b, scratch);
    stencil.relax(second, b, scratch, solution);
    stencil.residual(b, solution, scratch);
    sum_means(scratch, sums);
    cycle(next, sums, rest);
    stencil.add_means(&next.solution, solution);
    stencil.relax(second, b, solution, scratch);
    stencil.relax(first, b, scratch, solution);
}
