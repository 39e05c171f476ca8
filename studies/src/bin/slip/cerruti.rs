//! Displacements of a half-space under uniform tractions on square cells of side 1, E* = 1.
//!
//! Of bodies alike, or one on a rigid one (Johnson, *Contact Mechanics*, §3.6): with r the distance and k = ν/(1 − ν),
//! a traction along x displaces by `(1/r + k x²/r³)/π` along x and by `k x y/r³/π` along y, and a pressure by `1/r/π`
//! into the body. Bodies that differ are coupled by Dundurs' β: a traction along x displaces by `β x/r²/π` normally,
//! and a pressure by `−β x/r²/π` along x. Each is integrated over the cell in closed form.

use nalgebra::DMatrix;

/// Displacements at all offsets between nodes of a square of n × n nodes.
pub(crate) struct Cerruti {
    n: usize,
    /// Normal ones under a pressure.
    normal: DMatrix<f64>,
    /// Along x under a traction along x, along y under one along x, and along y under one along y.
    pub(crate) along: DMatrix<f64>,
    pub(crate) mixed: DMatrix<f64>,
    pub(crate) across: DMatrix<f64>,
    /// Normal ones under tractions along x and y, for β = 1.
    coupling: [DMatrix<f64>; 2],
}

impl Cerruti {
    pub(crate) fn new(n: usize, poissons_ratio: f64) -> Self {
        let k = poissons_ratio / (1.0 - poissons_ratio);
        let table = |of: &dyn Fn(Corners) -> f64| {
            DMatrix::from_fn(2 * n - 1, 2 * n - 1, |i, j| {
                let offset = |i: usize| i as f64 - (n as f64 - 1.0);
                of(Corners::around(offset(i), offset(j))) / std::f64::consts::PI
            })
        };
        Self {
            n,
            normal: table(&|c| c.inverse),
            along: table(&|c| c.inverse + k * c.xx),
            mixed: table(&|c| k * c.xy),
            across: table(&|c| c.inverse + k * (c.inverse - c.xx)),
            coupling: [table(&|c| c.x), table(&|c| c.y)],
        }
    }

    /// The part of a table between nodes: displacement at rows under what acts on columns.
    pub(crate) fn between(
        &self,
        table: &DMatrix<f64>,
        rows: &[usize],
        columns: &[usize],
    ) -> DMatrix<f64> {
        let n = self.n;
        DMatrix::from_fn(rows.len(), columns.len(), |a, b| {
            let (to, from) = (rows[a], columns[b]);
            // x is the fast index.
            table[(to % n + n - 1 - from % n, to / n + n - 1 - from / n)]
        })
    }

    pub(crate) fn normal(&self, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
        self.between(&self.normal, rows, columns)
    }

    /// Normal displacements under tractions along x, and along y, times β.
    pub(crate) fn coupling(&self, rows: &[usize], columns: &[usize]) -> [DMatrix<f64>; 2] {
        [0, 1].map(|axis| self.between(&self.coupling[axis], rows, columns))
    }
}

/// Integrals over a cell.
struct Corners {
    /// Of 1/r.
    inverse: f64,
    /// Of x²/r³.
    xx: f64,
    /// Of x y/r³.
    xy: f64,
    /// Of x/r² and of y/r².
    x: f64,
    y: f64,
}

impl Corners {
    /// Seen from an offset: differences of antiderivatives at the corners.
    fn around(dx: f64, dy: f64) -> Self {
        let mut sums = Self { inverse: 0.0, xx: 0.0, xy: 0.0, x: 0.0, y: 0.0 };
        for (right, up, sign) in
            [(0.5, 0.5, 1.0), (-0.5, 0.5, -1.0), (0.5, -0.5, -1.0), (-0.5, -0.5, 1.0)]
        {
            // No corner lies on an axis through a node.
            let (x, y): (f64, f64) = (dx + right, dy + up);
            let r = x.hypot(y);
            let (of_x, of_y) = (y * (x / y.abs()).asinh(), x * (y / x.abs()).asinh());
            sums.inverse += sign * (of_x + of_y);
            sums.xx += sign * of_x;
            sums.xy -= sign * r;
            sums.x += sign * (y * r.ln() + x * (y / x).atan());
            sums.y += sign * (x * r.ln() + y * (x / y).atan());
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the mid-point rule on 200² parts of a cell two cells away, and of the cell itself by symmetry: the xx and yy
    /// parts are halves.
    #[test]
    fn integrals_are_those_of_the_densities() {
        let corners = Corners::around(2.0, -1.0);
        let parts = 200;
        let mut sums = [0.0; 5];
        for i in 0..parts {
            for j in 0..parts {
                let part = |k: usize| (k as f64 + 0.5) / parts as f64 - 0.5;
                let (x, y): (f64, f64) = (2.0 + part(i), -1.0 + part(j));
                let r = x.hypot(y);
                let area = 1.0 / (parts * parts) as f64;
                let densities =
                    [1.0 / r, x * x / r.powi(3), x * y / r.powi(3), x / (r * r), y / (r * r)];
                for (sum, density) in sums.iter_mut().zip(densities) {
                    *sum += area * density;
                }
            }
        }
        let found = [corners.inverse, corners.xx, corners.xy, corners.x, corners.y];
        for (found, expected) in found.iter().zip(sums) {
            // The mid-point rule: 1/24 of the second derivative over 200².
            assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        }
        let own = Corners::around(0.0, 0.0);
        assert!((own.xx - 0.5 * own.inverse).abs() < 1e-15);
        assert!(own.xy.abs() + own.x.abs() + own.y.abs() < 1e-15);
    }
}
