//! Integrals over a cell of functions of the distance from where it is observed.

use crate::kernel::gauss::{EIGHT, FOUR, FOURTEEN, SIX, TEN, TWENTY};

/// How smooth a function of the distance is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Smoothness {
    /// Its nearest singularities lie at r = ± i times this.
    pub(super) depth: f64,
    /// Nowhere is it smoother than a function whose singularities are this far.
    pub(super) most: f64,
}

/// ∫ f(r) dA over the cell of `sides` about `center`, with f at four distances at a time.
///
/// Along a line through the cell that passes the origin at a distance b, the nearest singularities lie at √(b² + depth²) to either
/// side of the line. With d, the least of these distances in the cell, and half the long side a of the cell, an n-point rule converges
/// as ϱ⁻²ⁿ with ϱ = d/a + √(d²/a² + 1). The rules are those with ϱ⁻²ⁿ ≤ 10⁻¹⁶; where there is none, the cell is divided.
pub(super) fn integral(
    f: &impl Fn([f64; 4]) -> [f64; 4],
    smoothness: Smoothness,
    center: (f64, f64),
    sides: (f64, f64),
) -> f64 {
    let ((x, y), (dx, dy)) = (center, sides);
    let beyond = |at: f64, side: f64| (at.abs() - 0.5 * side).max(0.0);
    let (near_x, near_y) = (beyond(x, dx), beyond(y, dy));
    let Smoothness { depth, most } = smoothness;
    let nearest = (near_x * near_x + near_y * near_y + depth * depth).sqrt().min(most);
    let distance = nearest / (0.5 * dx.max(dy));
    let rule: &[(f64, f64)] = if distance < 1.06 {
        let half = |x, y, sides| integral(f, smoothness, (x, y), sides);
        return if dx >= dy {
            let sides = (0.5 * dx, dy);
            half(x - 0.25 * dx, y, sides) + half(x + 0.25 * dx, y, sides)
        } else {
            let sides = (dx, 0.5 * dy);
            half(x, y - 0.25 * dy, sides) + half(x, y + 0.25 * dy, sides)
        };
    } else if distance < 1.74 {
        &TWENTY
    } else if distance < 3.1 {
        &FOURTEEN
    } else if distance < 5.0 {
        &TEN
    } else if distance < 10.7 {
        &EIGHT
    } else if distance < 50.0 {
        &SIX
    } else {
        &FOUR
    };
    let mut sum = 0.0;
    for (node_y, weight_y) in rule {
        for (node_x, weight_x) in rule {
            let signs = [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
            let corners = f(signs.map(|(sign_x, sign_y)| {
                let x = x + 0.5 * sign_x * node_x * dx;
                let y = y + 0.5 * sign_y * node_y * dy;
                (x * x + y * y).sqrt()
            }));
            sum += weight_x * weight_y * corners.iter().sum::<f64>();
        }
    }
    0.25 * dx * dy * sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ c (r² + c²)^(−3/2) dA is the solid angle under which the cell is seen from the height c.
    #[test]
    fn solid_angles() {
        for depth in [1e-4, 0.03, 1.0, 20.0] {
            for (x, y, dx, dy) in [
                (0.0, 0.0, 1.0, 1.0),
                (1.0, 0.0, 1.0, 1.0),
                (0.0, 0.3, 2.0, 0.3),
                (7.0, 5.0, 1.0, 1.0),
                (90.0, 30.0, 1.0, 1.0),
            ] {
                let f = |r: f64| {
                    let square = r * r + depth * depth;
                    depth / (square * square.sqrt())
                };
                let corner = |x: f64, y: f64| {
                    (x * y / (depth * (x * x + y * y + depth * depth).sqrt())).atan()
                };
                let (left, right) = (x - 0.5 * dx, x + 0.5 * dx);
                let (low, high) = (y - 0.5 * dy, y + 0.5 * dy);
                let exact = corner(right, high) - corner(left, high) - corner(right, low)
                    + corner(left, low);
                let smoothness = Smoothness { depth, most: f64::INFINITY };
                let found = integral(&|r| r.map(f), smoothness, (x, y), (dx, dy));
                // The four angles are below π/2, and round; so do sums over up to a hundred parts of a cell.
                let allowed = 4e-15 * (exact + std::f64::consts::FRAC_PI_2);
                assert!((found - exact).abs() < allowed, "{depth} {x} {y}: {found} {exact}");
            }
        }
    }
}
