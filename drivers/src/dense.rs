//! The contact problem as one dense matrix: what every state is compared with.
//!
//! Nothing is shared with the library but the influence coefficients. On a set I of nodes in contact the pressures
//! are `p = C_II⁻¹ (δ e − g_I)` by a Cholesky factor of nalgebra, made afresh for every set. What was found is a state
//! of contact at the approach δ, and the only one, if no such pressure and no gap elsewhere is negative.
//!
//! Nodes that have yielded carry their hardness: `p_I = C_II⁻¹ (δ e − g_I − C_IY H_Y)` on the elastic ones, no pressure
//! above the hardness, and no gap above zero where a node has yielded.
//!
//! # How large an error may be
//!
//! A solution by a factor has a residual of some n rounding errors of the numbers that it cancels, the lengths `ℓ = δ +
//! max g + |C| |p|`. In contact that is the error of a gap, and of a displacement elsewhere it is `‖C_OI C_II⁻¹‖` times
//! as much, in the maximum norm; of a pressure `‖C_II⁻¹‖` times as much. The norms are those of the very set. Where
//! nodes have yielded they are the greatest of all sets before: a window of events is computed from the equations at
//! its beginning, of more elastic nodes. What a window says of gaps, `g_Y = B⁻¹ b_Y` and `r_Y = −B⁻¹ y_Y` of nodes that
//! yielded in it, has `B = (C_II⁻¹)_YY` and the pressures `b_Y` and rates `y_Y` solved for at its beginning: columns
//! with residuals as above are off by `‖C_II⁻¹‖` times as much, and `‖B⁻¹‖ ≤ ‖C‖` since `B⁻¹` is a Schur complement. So
//! scalars and rates, which windows carry on, are off by the product of both norms instead of `1 + ‖C_OI C_II⁻¹‖`;
//! fields are solved for on the very set.

use asperity::{Boundary, ContactGrowth, InfluenceKernel, LoadingState, MeanDisplacement};
use asperity_testing::dense::{influence_matrix, initial_gap};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::problem::Sample;
use crate::verdict::{Tally, Violation, ensure};

/// Rounding errors of a residual, as a multiple of the number of nodes and a constant that stands for those of the
/// convolution and of the path.
const ROUNDINGS: f64 = 4.0;
const ANYWAY: f64 = 16.0;

/// A contact problem in units of its own, so that no product of them overflows: powers of two, which round nothing.
#[derive(Debug, Clone)]
pub(crate) struct Dense {
    influence: DMatrix<f64>,
    gap: DVector<f64>,
    /// The greatest pressure of each node, if any is limited.
    hardness: Option<DVector<f64>>,
    /// Mean of the coefficients where it is arbitrary: the displacement for a unit sum of pressures.
    gauge: Option<f64>,
    /// The gauge of the kernel as it was given: the size of what rounds in its coefficients.
    given_gauge: f64,
    cell_area: f64,
    length: f64,
    compliance: f64,
}

/// The scalars of a state in the units of a [`Dense`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scalars {
    /// In the gauge of the kernel.
    pub(crate) own_approach: f64,
    pub(crate) sum: f64,
    pub(crate) mean_gap: f64,
    pub(crate) stiffness: Option<f64>,
    pub(crate) interfacial: Option<f64>,
    pub(crate) energy: f64,
    pub(crate) plastic: Option<Plastic>,
}

/// What is lost where nodes have yielded: the sum of their plastic depths and that of depths times hardness, and how
/// much each grows with the sum of pressures.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plastic {
    pub(crate) sums: [f64; 2],
    pub(crate) per_load: [f64; 2],
}

/// A power of two near a positive number.
fn near(value: f64) -> f64 {
    2_f64.powf(value.log2().round())
}

impl Dense {
    pub(crate) fn new(kernel: &dyn InfluenceKernel, heights: &DMatrix<f64>) -> Self {
        let grid = kernel.grid();
        let compliance = near(kernel.coefficient(0, 0));
        let greatest = heights.max() - heights.min();
        // Of a flat surface no length is given.
        let length = near(if greatest > 0.0 { greatest } else { grid.dx() });
        let influence = influence_matrix(kernel) / compliance;
        let arbitrary = kernel.boundary() == Boundary::Periodic
            && kernel.mean_displacement() == MeanDisplacement::Arbitrary;
        let gauge = arbitrary.then(|| influence.column(0).mean());
        Self {
            gauge,
            given_gauge: gauge.unwrap_or(0.0).abs(),
            gap: DVector::from_vec(initial_gap(heights)) / length,
            hardness: None,
            influence,
            cell_area: grid.cell_area(),
            length,
            compliance,
        }
    }

    /// The problem of a sample, with its hardness.
    pub(crate) fn of_sample(sample: &Sample) -> Self {
        let mut dense = Self::new(&sample.kernel, sample.surface.matrix());
        let limits = sample.hardness.as_ref().filter(|map| map.min() < f64::INFINITY);
        dense.hardness = limits.map(|map| {
            DVector::from_iterator(map.len(), map.iter().map(|h| dense.own_pressure(*h)))
        });
        dense
    }

    /// The elastic problem of another surface on the same body, in the same units.
    pub(crate) fn elastic(&self, heights: &DMatrix<f64>) -> Self {
        let gap = DVector::from_vec(initial_gap(heights)) / self.length;
        Self { gap, hardness: None, ..self.clone() }
    }

    pub(crate) fn nodes(&self) -> usize {
        self.gap.len()
    }

    /// What a pressure displaces where it acts.
    pub(crate) fn self_influence(&self) -> f64 {
        self.influence[(0, 0)]
    }

    pub(crate) fn gap(&self) -> &DVector<f64> {
        &self.gap
    }

    /// The greatest pressure of each node, if any is limited.
    pub(crate) fn hardness(&self) -> Option<&DVector<f64>> {
        self.hardness.as_ref()
    }

    /// `C p`, and the greatest of `|C| |p|`, in the gauge of the kernel as it was given if that is more.
    pub(crate) fn displace(&self, pressure: &DVector<f64>) -> (DVector<f64>, f64) {
        let absolute = pressure.abs();
        let rows = self.influence.row_iter();
        let lengths = rows.map(|row| {
            let terms = row.iter().zip(absolute.iter());
            terms.map(|(c, p)| c.abs() * p).sum()
        });
        let displacement = &self.influence * pressure;
        let given = self.given_gauge * absolute.sum();
        (displacement, lengths.fold(0.0, f64::max) + given)
    }

    /// The same problem in the gauge in which solutions for one load are computed, of the size of a cell's own
    /// displacement: their errors are measured in it. The problem itself where the mean displacement means something.
    pub(crate) fn in_computing_gauge(self) -> Self {
        self.in_gauge(|_, good| good)
    }

    /// The same problem in the gauge in which paths are computed: the kernel's own, unless it is far above a good one
    /// or lets a coefficient be negative; with a hardness nothing is convex. An approach that is reported for mean
    /// planes goes with the load by that gauge, and by another one only as well as the load is known.
    pub(crate) fn in_gauge_of_paths(self, growth: ContactGrowth) -> Self {
        let least = self.influence.column(0).min();
        let greatest = match growth {
            ContactGrowth::Convex if self.hardness.is_none() => 1e3,
            _ => 10.0,
        };
        self.in_gauge(|own, good| match own / good {
            _ if least < 0.0 => good,
            part if part > greatest => 10.0 * good,
            _ => own,
        })
    }

    fn in_gauge(mut self, choose: impl FnOnce(f64, f64) -> f64) -> Self {
        if let Some(gauge) = self.gauge {
            let least = self.influence.column(0).min() - gauge;
            // Of a single node nothing but its gauge is known.
            let good = if least < 0.0 { -1.5 * least } else { gauge };
            let other = choose(gauge, good);
            self.influence.add_scalar_mut(other - gauge);
            self.gauge = Some(other);
        }
        self
    }

    /// `C(0, 0) p̄` for pressures of this sum, which errors are relative to where the approach is less; nothing where
    /// the mean displacement means something.
    pub(crate) fn own_displacement(&self, sum: f64) -> f64 {
        match self.gauge {
            Some(_) => self.influence[(0, 0)] * sum / self.nodes() as f64,
            None => 0.0,
        }
    }

    /// The rate of a node's [own displacement](Self::own_displacement) over that at which the mean gap closes.
    pub(crate) fn closing_of_own(&self, state: &asperity::ContactState) -> f64 {
        self.scalars(state)
            .interfacial
            .map_or(0.0, |stiffness| stiffness * self.own_displacement(1.0))
    }

    /// The displacement for a unit sum of pressures that is not reported: nothing where the mean displacement means
    /// something.
    pub(crate) fn gauge(&self) -> f64 {
        self.gauge.unwrap_or(0.0)
    }

    /// Whether approaches are those of the mean planes.
    pub(crate) fn is_gauged(&self) -> bool {
        self.gauge.is_some()
    }

    /// A length \[m\] in its own units.
    pub(crate) fn own_length(&self, length: f64) -> f64 {
        length / self.length
    }

    /// The greatest initial gap \[m\].
    pub(crate) fn greatest_gap(&self) -> f64 {
        self.gap.max() * self.length
    }

    /// A pressure \[Pa\] in its own units.
    pub(crate) fn own_pressure(&self, pressure: f64) -> f64 {
        pressure / self.length * self.compliance
    }

    /// A load \[N\] as a sum of pressures in its own units.
    pub(crate) fn own_sum(&self, load: f64) -> f64 {
        self.own_pressure(load / self.cell_area)
    }

    /// The displacement under a load \[N\] that is not reported, in the gauge of the kernel \[m\].
    pub(crate) fn uniform_displacement(&self, load: f64) -> f64 {
        self.gauge().abs() * self.own_sum(load) * self.length
    }

    /// The approach in the gauge of the kernel, from what is reported.
    pub(crate) fn own_approach(&self, approach: f64, load: f64) -> f64 {
        self.own_length(approach) + self.gauge() * self.own_sum(load)
    }

    pub(crate) fn scalars(&self, state: &asperity::ContactState) -> Scalars {
        let stiffness = |k: f64| k / self.cell_area * self.compliance;
        Scalars {
            own_approach: self.own_approach(state.approach, state.load),
            sum: self.own_sum(state.load),
            mean_gap: self.own_length(state.mean_gap),
            stiffness: state.contact_stiffness.map(stiffness),
            interfacial: state.interfacial_stiffness.map(stiffness),
            energy: self.own_length(self.own_pressure(state.energy / self.cell_area)),
            plastic: state.plastic.map(|plastic| Plastic {
                sums: [
                    self.own_length(plastic.volume / self.cell_area),
                    self.own_length(self.own_pressure(plastic.work / self.cell_area)),
                ],
                per_load: [
                    plastic.volume_per_load / self.compliance,
                    self.own_length(plastic.work_per_load),
                ],
            }),
        }
    }

    /// The condition number of the whole matrix in the maximum norm, `None` if it is not positive definite in double
    /// precision.
    pub(crate) fn condition(&self) -> Option<f64> {
        let [own, inverse] = self.norms()?;
        Some(own * inverse)
    }

    /// The norms of the matrix and of its inverse.
    pub(crate) fn norms(&self) -> Option<[f64; 2]> {
        let inverse = self.influence.clone().cholesky()?.inverse();
        Some([norm(&self.influence), norm(&inverse)])
    }

    /// The rounding errors of n nodes, relative to the lengths that cancel.
    pub(crate) fn rounding(nodes: usize) -> f64 {
        ROUNDINGS * (ANYWAY + nodes as f64) * f64::EPSILON
    }
}

/// Greatest sum of absolute values of a row.
fn norm(matrix: &DMatrix<f64>) -> f64 {
    let rows = matrix.row_iter().map(|row| row.abs().sum());
    rows.fold(0.0, f64::max)
}

/// What has become of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Node {
    Out,
    Elastic,
    Yielded,
}

/// What errors of gaps are carried on by.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Norms {
    /// `‖C_II⁻¹‖`.
    pub(crate) inverse: f64,
    /// `1 + ‖C_OI C_II⁻¹‖`.
    pub(crate) carried: f64,
    /// `Σ |y₂|`.
    rate: f64,
    /// What cancels in a closing rate.
    closing: f64,
}

impl Norms {
    /// The greater of each.
    pub(crate) fn max(self, other: Self) -> Self {
        Self {
            inverse: self.inverse.max(other.inverse),
            carried: self.carried.max(other.carried),
            rate: self.rate.max(other.rate),
            closing: self.closing.max(other.closing),
        }
    }
}

/// The equations of one set of nodes in contact.
pub(crate) struct ContactSet<'a> {
    dense: &'a Dense,
    /// Those that have not yielded.
    nodes: Vec<usize>,
    states: Vec<Node>,
    /// Pressures of those that have, and their displacement.
    load: DVector<f64>,
    under_load: DVector<f64>,
    factor: Cholesky<f64, Dyn>,
    /// Gaps in contact that a solution may leave besides rounding, relative to the approach.
    residual: f64,
    pub(crate) norms: Norms,
    /// `y₂ = C_II⁻¹ e`, by node of the grid, and how fast gaps close.
    pub(crate) rate: DVector<f64>,
    pub(crate) closing: DVector<f64>,
    /// Error of the latter.
    pub(crate) closing_error: f64,
}

/// The solution on a set at an approach.
pub(crate) struct Instant {
    pub(crate) pressure: DVector<f64>,
    pub(crate) displacement: DVector<f64>,
    pub(crate) gap: DVector<f64>,
    /// What cancels in a gap.
    pub(crate) lengths: f64,
    pub(crate) gap_error: f64,
    /// What gaps are off by if they have come through a window of events.
    pub(crate) carried_error: f64,
    pub(crate) pressure_error: f64,
}

impl<'a> ContactSet<'a> {
    /// `None` if the matrix is not positive definite in double precision.
    ///
    /// Gaps in contact may be off by `residual` of the approach besides rounding.
    pub(crate) fn new(dense: &'a Dense, nodes: &[usize], residual: f64) -> Option<Self> {
        Self::beside(dense, [nodes, &[]], residual, Norms::default())
    }

    /// The same beside nodes that have yielded, with norms that are no less than those of sets before.
    pub(crate) fn beside(
        dense: &'a Dense,
        [nodes, yielded]: [&[usize]; 2],
        residual: f64,
        before: Norms,
    ) -> Option<Self> {
        let all = dense.nodes();
        let mut states = vec![Node::Out; all];
        for &node in nodes {
            states[node] = Node::Elastic;
        }
        let mut load = DVector::zeros(all);
        for &node in yielded {
            states[node] = Node::Yielded;
            load[node] = dense.hardness.as_ref()?[node];
        }
        let columns = dense.influence.select_columns(nodes);
        let factor = columns.select_rows(nodes).cholesky()?;
        let inverse = factor.inverse();
        let outside: Vec<usize> = (0..all).filter(|&node| states[node] != Node::Elastic).collect();
        let carried = 1.0 + norm(&(columns.select_rows(&outside) * &inverse));
        let ones = DVector::from_element(nodes.len(), 1.0);
        let mut set = Self {
            dense,
            nodes: nodes.to_vec(),
            states,
            under_load: &dense.influence * &load,
            load,
            factor,
            residual,
            norms: Norms { inverse: norm(&inverse), carried, rate: 0.0, closing: 0.0 },
            rate: DVector::zeros(0),
            closing: DVector::zeros(0),
            closing_error: 0.0,
        };
        let rate = set.solve(&ones);
        let (displacement, lengths) = dense.displace(&rate);
        set.norms.rate = rate.abs().sum();
        set.norms.closing = 1.0 + lengths;
        set.norms = set.norms.max(before);
        let rounding = set.norms.closing * Dense::rounding(all);
        set.closing_error = set.through_windows() * rounding + set.norms.carried * residual;
        set.closing = displacement.map(|u| 1.0 - u);
        set.rate = rate;
        Some(set)
    }

    /// What rounding errors of gaps are carried on by in a window of events.
    fn through_windows(&self) -> f64 {
        let carried = self.norms.carried;
        match self.states.contains(&Node::Yielded) {
            true => carried.max(norm(&self.dense.influence) * self.norms.inverse),
            false => carried,
        }
    }

    /// `C_II⁻¹ b`, on the whole grid.
    fn solve(&self, rhs: &DVector<f64>) -> DVector<f64> {
        let solved = self.factor.solve(rhs);
        let mut field = DVector::zeros(self.dense.nodes());
        for (&node, value) in self.nodes.iter().zip(solved.iter()) {
            field[node] = *value;
        }
        field
    }

    /// Whether a node is in contact and has not yielded.
    pub(crate) fn contains(&self, node: usize) -> bool {
        self.states[node] == Node::Elastic
    }

    pub(crate) fn states(&self) -> &[Node] {
        &self.states
    }

    /// All nodes that are there.
    pub(crate) fn all(&self, state: Node) -> impl Iterator<Item = usize> + '_ {
        (0..self.states.len()).filter(move |&node| self.states[node] == state)
    }

    /// The solution at an approach in the gauge of the kernel.
    pub(crate) fn at(&self, own_approach: f64) -> Instant {
        let dense = self.dense;
        let rhs =
            self.nodes.iter().map(|&node| own_approach - dense.gap[node] - self.under_load[node]);
        let rhs = DVector::from_iterator(self.nodes.len(), rhs);
        let pressure = self.solve(&rhs) + &self.load;
        let (displacement, lengths) = dense.displace(&pressure);
        let gap = &dense.gap + &displacement - DVector::from_element(dense.nodes(), own_approach);
        let lengths = own_approach.abs() + dense.gap.max() + lengths;
        let rounding = Dense::rounding(dense.nodes()) * lengths;
        let residual = self.norms.carried * self.residual * own_approach.abs();
        let gap_error = self.norms.carried * rounding + residual;
        Instant {
            pressure,
            displacement,
            gap,
            lengths,
            gap_error,
            carried_error: self.through_windows() * rounding + residual,
            pressure_error: self.norms.inverse * gap_error,
        }
    }

    /// How far the sum of pressures is off where gaps are: `Σ |y₂|` times as much, and the rounding of what yielded
    /// nodes carry.
    pub(crate) fn sum_error(&self, gap_error: f64) -> f64 {
        let rounding = Dense::rounding(self.dense.nodes());
        self.norms.rate * gap_error + rounding * self.load.sum()
    }

    /// How far a rate of pressure is off.
    pub(crate) fn rate_error(&self) -> f64 {
        self.norms.inverse * self.closing_error
    }

    /// The elastic energy, of the mean planes where the mean displacement is arbitrary, and its error.
    pub(crate) fn energy(&self, instant: &Instant) -> (f64, f64) {
        let gauge = self.dense.gauge();
        let sum = instant.pressure.sum();
        let energy = instant.pressure.dot(&instant.displacement) - gauge * sum * sum;
        let lengths = instant.lengths + gauge.abs() * sum.abs();
        let pressures = instant.pressure.abs().sum();
        let error =
            pressures * (Dense::rounding(self.dense.nodes()) * lengths + instant.carried_error);
        (0.5 * energy, error)
    }

    /// `dW/dδ` and `−dW/dḡ`, each with its error relative to itself.
    pub(crate) fn stiffnesses(&self) -> [(f64, f64); 2] {
        if self.nodes.is_empty() {
            // Nothing is elastic: the load does not change.
            return [(0.0, 0.0); 2];
        }
        let stiffness = self.rate.sum();
        let relative = self.stiffness_error() / stiffness.abs();
        let closing: f64 = self.all(Node::Out).map(|node| self.closing[node]).sum();
        let closing = closing / self.dense.nodes() as f64;
        [
            (stiffness, relative),
            (stiffness / closing, relative + self.closing_error / closing.abs()),
        ]
    }

    fn stiffness_error(&self) -> f64 {
        self.norms.rate * self.closing_error
    }

    /// What is lost where nodes have yielded, the sums of a [`Plastic`], and the errors of it if those of gaps are so
    /// large.
    pub(crate) fn plastic_sums(&self, instant: &Instant, gap_error: f64) -> [[f64; 2]; 2] {
        let [mut found, mut errors] = [[0.0; 2]; 2];
        for node in self.all(Node::Yielded) {
            for (k, factor) in [1.0, self.load[node]].into_iter().enumerate() {
                found[k] -= factor * instant.gap[node];
                errors[k] += factor * gap_error;
            }
        }
        [found, errors]
    }

    /// How much of it each unit of the sum of pressures adds, and the errors.
    fn plastic_per_load(&self) -> [[f64; 2]; 2] {
        let (stiffness, error) = (self.rate.sum(), self.stiffness_error());
        let [mut found, mut errors] = [[0.0; 2]; 2];
        if stiffness > 0.0 {
            for node in self.all(Node::Yielded) {
                for (k, factor) in [1.0, self.load[node]].into_iter().enumerate() {
                    let rate = factor * self.closing[node] / stiffness;
                    found[k] += rate;
                    errors[k] += (factor * self.closing_error + rate.abs() * error) / stiffness;
                }
            }
        }
        [found, errors]
    }

    /// `Ok` if stiffnesses, and what is lost of each newton, are those of this set.
    pub(crate) fn check_rates(&self, found: &Scalars, tally: &mut Tally) -> Result<(), Violation> {
        if let Some(plastic) = found.plastic {
            let [expected, errors] = self.plastic_per_load();
            for (k, what) in
                ["plastic volume by load", "plastic work by load"].into_iter().enumerate()
            {
                tally.close(what, plastic.per_load[k], expected[k], errors[k])?;
            }
        }
        let [(contact, error), (expected, interfacial_error)] = self.stiffnesses();
        ensure!(
            found.stiffness.is_none() == self.dense.is_gauged(),
            "the contact stiffness is {:?}, where a distant point stays put: {}",
            found.stiffness,
            !self.dense.is_gauged()
        );
        if let Some(stiffness) = found.stiffness {
            tally.close("contact stiffness", stiffness, contact, error * contact.abs())?;
        }
        let Some(interfacial) = found.interfacial else {
            return Err(Violation::new("there is no interfacial stiffness"));
        };
        if self.all(Node::Out).next().is_none() {
            ensure!(
                interfacial == f64::INFINITY,
                "in full contact the interfacial stiffness is {interfacial:e}"
            );
        } else if interfacial_error < 0.1 {
            let allowed = interfacial_error * expected.abs();
            tally.close("interfacial stiffness", interfacial, expected, allowed)?;
        }
        Ok(())
    }
}

/// The scalars of a state of a path.
impl Dense {
    pub(crate) fn of(&self, state: &LoadingState) -> Scalars {
        self.scalars(&state.contact)
    }
}
