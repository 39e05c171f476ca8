//! How the surface of layers answers a wave: a recursion from the base to the surface.
//!
//! A wave along x in plane strain, with depth z and x̄ = q z, has the displacements W cos qx into the body and U sin qx
//! along it, and on planes of constant z the pressure 2 G q n cos qx and the shear traction −2 G q τ sin qx. In a
//! material of Poisson's ratio ν
//!
//! ```math
//! \frac{\mathrm d}{\mathrm d \bar x} \begin{pmatrix} W \\ U \\ n \\ \tau \end{pmatrix} =
//! A \begin{pmatrix} W \\ U \\ n \\ \tau \end{pmatrix}, \qquad
//! A = \begin{pmatrix} 0 & -b & -c & 0 \\ 1 & 0 & 0 & -2 \\ 0 & 0 & 0 & -1 \\ 0 & -d & b & 0 \end{pmatrix},
//! ```
//!
//! b = ν / (1 − ν), c = (1 − 2ν) / (1 − ν), d = 1 / (1 − ν): Hooke's law and equilibrium, without a division by 1 − 2ν.
//! The eigenvalues are ±1, each twice, and (A² − 1)² = 0, so that with B = A² − 1
//!
//! ```math
//! e^{-A x} = \cosh x + \tfrac12 x \sinh x\, B - A \bigl(\sinh x + \tfrac12 (x \cosh x - \sinh x)\, B\bigr) ,
//! ```
//!
//! ```math
//! B = d \begin{pmatrix} -1 & 0 & 0 & 1 \\ 0 & 1 & -1 & 0 \\ 0 & 1 & -1 & 0 \\ -1 & 0 & 0 & 1 \end{pmatrix}, \qquad
//! AB = d \begin{pmatrix} 0 & -1 & 1 & 0 \\ 1 & 0 & 0 & -1 \\ 1 & 0 & 0 & -1 \\ 0 & -1 & 1 & 0 \end{pmatrix} .
//! ```
//!
//! With (W, U) = S (n, τ) below, blocks of this matrix give the same above. S is symmetric and positive, and errors in
//! it fade on the way up.

/// A material: shear modulus and Poisson's ratio.
#[derive(Debug, Clone, Copy)]
pub(super) struct Material {
    pub(super) shear: f64,
    poissons_ratio: f64,
}

impl Material {
    pub(super) fn new(youngs_modulus: f64, poissons_ratio: f64) -> Self {
        Self { shear: 0.5 * youngs_modulus / (1.0 + poissons_ratio), poissons_ratio }
    }

    /// Stress along a wave, from the displacement along it times 2q and the pressure on planes of constant depth.
    pub(super) fn along(self, displacement: f64, pressure: f64) -> f64 {
        (self.shear * displacement - self.poissons_ratio * pressure) / (1.0 - self.poissons_ratio)
    }
}

pub(super) type Block = [[f64; 2]; 2];

fn product(a: Block, b: Block) -> Block {
    a.map(|[first, second]| [0, 1].map(|j| first * b[0][j] + second * b[1][j]))
}

/// The compliance matrix of a surface, times 2 q \[1/Pa\]: from pressure and shear traction to displacements.
#[derive(Debug, Clone, Copy)]
pub(super) struct Compliance(Block);

/// From this thickness on, in units of 1/q, nothing below a layer is felt: 10⁻¹⁹ of it.
const DEEP: f64 = 26.0;
/// From this thickness on nothing passes through a layer: 10⁻²⁶.
const BLIND: f64 = 60.0;
/// Greatest thickness that is passed at once: terms that grow with it cancel.
const STEP: f64 = 4.0;

impl Compliance {
    /// Nothing moves.
    pub(super) const RIGID: Self = Self([[0.0; 2]; 2]);

    /// That of a half-space.
    pub(super) fn half_space(material: Material) -> Self {
        let nu = material.poissons_ratio;
        let (own, other) = (2.0 * (1.0 - nu), 2.0 * nu - 1.0);
        Self([[own, other], [other, own]]).scaled(1.0 / material.shear)
    }

    /// That of a layer of the thickness `x`/q on what this is of.
    pub(super) fn under(self, material: Material, x: f64) -> Self {
        if x >= DEEP {
            return Self::half_space(material);
        }
        let steps = (x / STEP).ceil().max(1.0);
        let transfer = Transfer::new(material.poissons_ratio, x / steps);
        let mut own = self.scaled(material.shear);
        for _ in 0..steps as usize {
            own = transfer.applied(own);
        }
        own.scaled(1.0 / material.shear)
    }

    /// The same, with what `down` makes of tractions on what this is of made one of tractions on the layer.
    pub(super) fn under_with(self, material: Material, x: f64, down: Block) -> (Self, Block) {
        if x >= BLIND {
            return (Self::half_space(material), [[0.0; 2]; 2]);
        }
        let steps = (x / STEP).ceil().max(1.0);
        let transfer = Transfer::new(material.poissons_ratio, x / steps);
        let (mut own, mut down) = (self.scaled(material.shear), down);
        for _ in 0..steps as usize {
            let (above, inverse) = transfer.with_traction(own);
            own = above;
            down = product(down, inverse);
        }
        (own.scaled(1.0 / material.shear), down)
    }

    /// Displacements times 2q, into the body and along it, under tractions.
    pub(super) fn displacements(self, [pressure, shear]: [f64; 2]) -> [f64; 2] {
        self.0.map(|[first, second]| first * pressure + second * shear)
    }

    /// q Ĉ(q) \[1/Pa\].
    pub(super) fn normal(self) -> f64 {
        0.5 * self.0[0][0]
    }

    fn scaled(self, factor: f64) -> Self {
        Self(self.0.map(|row| row.map(|value| factor * value)))
    }
}

/// From the lower side of a slice of a material to the upper one.
struct Transfer {
    /// Displacements from displacements and from tractions, tractions from displacements and from tractions.
    blocks: [[Block; 2]; 2],
}

impl Transfer {
    fn new(nu: f64, x: f64) -> Self {
        let (b, c, d) = (nu / (1.0 - nu), (1.0 - 2.0 * nu) / (1.0 - nu), 1.0 / (1.0 - nu));
        // e^x − 1 has all digits of a small x.
        let grown = libm::expm1(x);
        let cosh = 1.0 + 0.5 * grown * grown / (1.0 + grown);
        let sinh = 0.5 * (grown + grown / (1.0 + grown));
        let even = 0.5 * d * x * sinh;
        let odd = 0.5 * d * x_cosh_less_sinh(x, cosh, sinh);
        let (less, more) = (cosh - even, cosh + even);
        Self {
            blocks: [
                [
                    [[less, b * sinh + odd], [-(sinh + odd), more]],
                    [[c * sinh - odd, even], [-even, 2.0 * sinh + odd]],
                ],
                [
                    [[-odd, even], [-even, d * sinh + odd]],
                    [[less, sinh + odd], [-(b * sinh + odd), more]],
                ],
            ],
        }
    }

    fn applied(&self, below: Compliance) -> Compliance {
        self.with_traction(below).0
    }

    /// The same, with the matrix that leads from tractions above to those below.
    fn with_traction(&self, below: Compliance) -> (Compliance, Block) {
        let [displacement, traction] =
            self.blocks.each_ref().map(|[from_displacement, from_traction]| {
                let mut sum = *from_traction;
                for (i, row) in sum.iter_mut().enumerate() {
                    for (j, value) in row.iter_mut().enumerate() {
                        let [first, second] = from_displacement[i];
                        *value += first * below.0[0][j] + second * below.0[1][j];
                    }
                }
                sum
            });
        let [[p, q], [r, s]] = traction;
        let determinant = p * s - q * r;
        let row = |[first, second]: [f64; 2]| {
            [(first * s - second * r) / determinant, (second * p - first * q) / determinant]
        };
        let [[normal, other], [another, along]] = displacement.map(row);
        // Symmetric, as reciprocity has it.
        let mixed = 0.5 * (other + another);
        let inverse = [[s / determinant, -q / determinant], [-r / determinant, p / determinant]];
        (Compliance([[normal, mixed], [mixed, along]]), inverse)
    }
}

/// x cosh x − sinh x, which is x³/3 of a small x.
fn x_cosh_less_sinh(x: f64, cosh: f64, sinh: f64) -> f64 {
    if x > 1.0 {
        return x * cosh - sinh;
    }
    let square = x * x;
    x * square * SERIES.iter().rev().fold(0.0, |sum, term| sum * square + term)
}

/// 2k / (2k + 1)! of Σ 2k x^(2k + 1) / (2k + 1)!, of which the eleventh term is below 10⁻²⁰ of the first.
const SERIES: [f64; 10] = {
    let mut series = [0.0; 10];
    let (mut k, mut factorial) = (0, 1.0);
    while k < 10 {
        let even = 2.0 * (k + 1) as f64;
        factorial *= even * (even + 1.0);
        series[k] = even / factorial;
        k += 1;
    }
    series
};

#[cfg(test)]
mod tests {
    use super::*;

    /// The elements that are written out, beside the sum of the powers of A.
    #[test]
    fn transfers_are_exponentials() {
        for nu in [-0.9_f64, 0.0, 0.3, 0.5] {
            let (b, c, d) = (nu / (1.0 - nu), (1.0 - 2.0 * nu) / (1.0 - nu), 1.0 / (1.0 - nu));
            let a = [
                [0.0, -b, -c, 0.0],
                [1.0, 0.0, 0.0, -2.0],
                [0.0, 0.0, 0.0, -1.0],
                [0.0, -d, b, 0.0],
            ];
            for x in [1e-6, 0.1, 0.9, 1.1, 3.9] {
                let identity = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
                let mut term: [[f64; 4]; 4] =
                    std::array::from_fn(|i| std::array::from_fn(|j| identity(i, j)));
                let mut sum = term;
                for power in 1..60 {
                    let next = |i: usize, j: usize| -> f64 {
                        let products = (0..4).map(|k| a[i][k] * term[k][j]);
                        -x / f64::from(power) * products.sum::<f64>()
                    };
                    term = std::array::from_fn(|i| std::array::from_fn(|j| next(i, j)));
                    for (total, value) in sum.as_flattened_mut().iter_mut().zip(term.as_flattened())
                    {
                        *total += value;
                    }
                }
                let transfer = Transfer::new(nu, x);
                for (i, row) in sum.iter().enumerate() {
                    for (j, expected) in row.iter().enumerate() {
                        let found = transfer.blocks[i / 2][j / 2][i % 2][j % 2];
                        // Terms of both sums are below those of e^(x ‖A‖) with ‖A‖ ≤ 3.5; each rounds a few times.
                        let allowed = 8.0 * f64::EPSILON * libm::exp(3.5 * x);
                        assert!((found - expected).abs() < allowed, "{nu} {x} {i} {j}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_series_meets_the_difference() {
        for x in [0.3, 0.9, 0.999] {
            let difference = x_cosh_less_sinh(x, x.cosh(), x.sinh());
            let plain = x * x.cosh() - x.sinh();
            // What the difference of two numbers of some x loses.
            assert!((difference - plain).abs() < 4.0 * f64::EPSILON * x.cosh(), "{x}");
        }
        let x = 1e-5;
        let exact = x * x * x / 3.0 * (1.0 + x * x / 10.0);
        assert!((x_cosh_less_sinh(x, x.cosh(), x.sinh()) / exact - 1.0).abs() < 1e-15);
    }

    /// A layer of the material of the half-space below is more of it.
    #[test]
    fn a_half_space_on_a_half_space_is_one() {
        for nu in [-0.9, 0.0, 0.3, 0.5] {
            let material = Material { shear: 2.0, poissons_ratio: nu };
            let below = Compliance::half_space(material);
            for x in [1e-6, 0.1, 1.0, 3.9, 4.1, 25.0, 27.0] {
                let above = below.under(material, x);
                for (a, b) in above.0.as_flattened().iter().zip(below.0.as_flattened()) {
                    // Terms of up to e⁴ × 8 that cancel, in each of at most seven steps that forget.
                    assert!((a - b).abs() < 1e-14 * below.0[0][0], "{nu} {x}: {a} {b}");
                }
            }
        }
    }
}
