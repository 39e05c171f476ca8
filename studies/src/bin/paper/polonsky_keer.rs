//! Plain conjugate gradients for one load: I. A. Polonsky and L. M. Keer, Wear 231 (1999) 206.
//!
//! No preconditioner, no coarser grids: the method that the paper compares itself with.

use asperity::Error;
use asperity::convolution::Convolution;

/// Steps after which to give up.
pub(crate) const MOST: usize = 3000;

/// How many steps it takes until no gap in contact and no overlap is above `tolerance` times the approach, from a
/// uniform pressure of the sum `sum`; `None` if [`MOST`] are not enough.
pub(crate) fn steps(
    initial_gap: &[f64],
    convolution: &mut Convolution,
    sum: f64,
    tolerance: f64,
) -> Result<Option<usize>, Error> {
    let nodes = initial_gap.len();
    let mut pressure = vec![sum / nodes as f64; nodes];
    let mut direction = vec![0.0; nodes];
    let (mut gap, mut image) = (vec![0.0; nodes], vec![0.0; nodes]);
    let (mut square, mut length) = (1.0, 0.0);
    let mut conjugate = false;
    for step in 0..=MOST {
        convolution.apply(&pressure, &mut gap)?;
        for (gap, initial) in gap.iter_mut().zip(initial_gap) {
            *gap += initial;
        }
        let approach = mean_in_contact(&gap, &pressure);
        let mut worst = 0.0_f64;
        for (gap, p) in gap.iter_mut().zip(&pressure) {
            *gap -= approach;
            worst = worst.max(if *p > 0.0 { gap.abs() } else { -*gap });
        }
        if worst <= tolerance * approach {
            return Ok(Some(step));
        }
        let in_contact = |values: &[f64], others: &[f64]| -> f64 {
            let products = values.iter().zip(others).zip(&pressure);
            let products = products.filter(|(_, p)| **p > 0.0);
            products.map(|((a, b), _)| a * b).sum()
        };
        let previous = square;
        square = in_contact(&gap, &gap);
        let share = if conjugate { square / previous } else { 0.0 };
        for ((d, gap), p) in direction.iter_mut().zip(&gap).zip(&pressure) {
            *d = if *p > 0.0 { gap + share * *d } else { 0.0 };
        }
        convolution.apply(&direction, &mut image)?;
        let mean = mean_in_contact(&image, &pressure);
        image.iter_mut().for_each(|value| *value -= mean);
        let curvature = in_contact(&image, &direction);
        // A single node has nothing to balance: the last length serves the nodes that overlap.
        if curvature > 0.0 {
            length = in_contact(&gap, &direction) / curvature;
        }
        conjugate = true;
        for ((p, d), gap) in pressure.iter_mut().zip(&direction).zip(&gap) {
            *p = (*p - length * d).max(0.0);
            if *p == 0.0 && *gap < 0.0 {
                *p = -length * gap;
                conjugate = false;
            }
        }
        let factor = sum / pressure.iter().sum::<f64>();
        pressure.iter_mut().for_each(|p| *p *= factor);
    }
    Ok(None)
}

/// The mean over the nodes with pressure.
fn mean_in_contact(values: &[f64], pressure: &[f64]) -> f64 {
    let inside = values.iter().zip(pressure).filter(|(_, p)| **p > 0.0);
    let (sum, count) = inside.fold((0.0, 0), |(sum, count), (value, _)| (sum + value, count + 1));
    sum / f64::from(count)
}
