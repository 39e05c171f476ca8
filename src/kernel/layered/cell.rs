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

impl Smoothness {
    /// The rule for the cell of `sides` about `center`; `None` if the cell has to be divided.
    ///
    /// Along a line through the cell that passes the origin at a distance b, the nearest singularities lie at √(b² +
    /// depth²) to either side of the line. With d, the least of these distances in the cell, and half the long side a
    /// of the cell, an n-point rule converges as ϱ⁻²ⁿ with ϱ = d/a + √(d²/a² + 1). The rules are those with ϱ⁻²ⁿ ≤
    /// 10⁻¹⁶; where there is none, the cell is divided.
    pub(super) fn rule(
        self,
        (x, y): (f64, f64),
        (dx, dy): (f64, f64),
    ) -> Option<&'static [(f64, f64)]> {
        let beyond = |at: f64, side: f64| (at.abs() - 0.5 * side).max(0.0);
        let (near_x, near_y) = (beyond(x, dx), beyond(y, dy));
        let Self { depth, most } = self;
        let nearest = (near_x * near_x + near_y * near_y + depth * depth).sqrt().min(most);
        match nearest / (0.5 * dx.max(dy)) {
            distance if distance < 1.06 => None,
            distance if distance < 1.74 => Some(&TWENTY),
            distance if distance < 3.1 => Some(&FOURTEEN),
            distance if distance < 5.0 => Some(&TEN),
            distance if distance < 10.7 => Some(&EIGHT),
            distance if distance < 50.0 => Some(&SIX),
            _ => Some(&FOUR),
        }
    }
}

/// Centers and sides of the halves of a cell.
pub(super) fn halves((x, y): (f64, f64), (dx, dy): (f64, f64)) -> [((f64, f64), (f64, f64)); 2] {
    if dx >= dy {
        [-0.25, 0.25].map(|part| ((x + part * dx, y), (0.5 * dx, dy)))
    } else {
        [-0.25, 0.25].map(|part| ((x, y + part * dy), (dx, 0.5 * dy)))
    }
}

/// The four places of a cell that belong to a node of a rule for each direction.
pub(super) fn places(
    (x, y): (f64, f64),
    (dx, dy): (f64, f64),
    (node_x, node_y): (f64, f64),
) -> [(f64, f64); 4] {
    const SIGNS: [(f64, f64); 4] = [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
    SIGNS.map(|(sign_x, sign_y)| (x + 0.5 * sign_x * node_x * dx, y + 0.5 * sign_y * node_y * dy))
}

/// ∫ f(r) dA over the cell of `sides` about `center`, with f at four distances at a time.
pub(super) fn integral(
    f: &impl Fn([f64; 4]) -> [f64; 4],
    smoothness: Smoothness,
    center: (f64, f64),
    sides: (f64, f64),
) -> f64 {
    let Some(rule) = smoothness.rule(center, sides) else {
        return halves(center, sides)
            .map(|(center, sides)| integral(f, smoothness, center, sides))
            .iter()
            .sum();
    };
    let ((x, y), (dx, dy)) = (center, sides);
    let mut sum = 0.0;
    for (node_y, weight_y) in rule {
        for (node_x, weight_x) in rule {
            let places = places((x, y), (dx, dy), (*node_x, *node_y));
            let corners = f(places.map(|(x, y)| (x * x + y * y).sqrt()));
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
