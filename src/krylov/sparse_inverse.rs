//! A sparse inverse Cholesky factor of the influence matrix of a contact set.

use super::NodeSet;
use super::lattice::{Lattice, Lattices, Neighbour};
use crate::kernel::KernelTable;
use crate::parallel::{for_each_chunk, vectorized};

/// Neighbours on which a node conditions, chosen by time and not by count.
///
/// One cold solve to 1e-8 on a 512 × 512 self-affine surface (λ_s = 4 cells), at 3.4, 12.6 and 47 %
/// contact: iterations for the pressure + for the stiffness, all convolutions, and seconds of one
/// thread with everything (some 0.1 s of it synthesis of the surface).
///
/// |  k | 3.4 %               | 12.6 %              | 47 %                |
/// |---:|---------------------|---------------------|---------------------|
/// |  4 | 23 + 23, 55, 0.41 s | 34 + 30, 74, 0.67 s | 56 + 42, 111, 1.39 s |
/// |  8 | 18 + 19, 46, 0.43 s | 25 + 25, 60, 0.62 s | 38 + 36, 85, 1.26 s |
/// | 12 | 16 + 17, 41, 0.40 s | 24 + 23, 56, 0.60 s | 35 + 31, 77, 1.58 s |
/// | 16 | 14 + 15, 37, 0.38 s | 21 + 21, 51, 0.66 s | 30 + 29, 69, 1.65 s |
/// | 32 | 12 + 12, 32, 0.44 s | 17 + 17, 43, 0.99 s | 28 + 24, 62, 3.06 s |
pub(crate) const NEIGHBOURS: usize = 8;

/// Rows a thread takes at a time.
const CHUNK: usize = 512;

/// ```math
/// M = U U^T \approx C_{II}^{-1}
/// ```
///
/// the best in the sense of Kullback and Leibler for its sparsity. Nodes are ordered coarse to fine.
/// Each conditions on the k earlier nodes of greatest influence: with A their influence matrix and a
/// their influence on the node, `w = A⁻¹ a` and `v = C(0, 0) − aᵀ w`, its column of U is
/// `(1, −w) / √v` (Vecchia; Schäfer, Katzfuss and Owhadi, SIAM J. Sci. Comput. 43 (2021) A2019). M is
/// positive definite by construction, in whatever precision the columns are computed: here single.
#[derive(Debug, Clone)]
pub(crate) struct SparseInverse<const K: usize = NEIGHBOURS> {
    lattices: Lattices,
    /// 1 / C(0, 0).
    unit: f64,
    rows: Vec<Row<K>>,
    /// Grid index of the node of each row, and the row of each node of the grid.
    contact: NodeSet,
    /// Rows of the neighbours; a missing one is the row itself, with no weight.
    columns: Vec<[u32; K]>,
    /// The same by neighbour: where its entries begin, and which rows it serves with what weight.
    starts: Vec<u32>,
    entries: Vec<(u32, f32)>,
    scratch: Vec<f64>,
}

/// A column of U.
#[derive(Debug, Clone, Copy)]
struct Row<const K: usize> {
    neighbours: [u32; K],
    weights: [f32; K],
    /// 1 / v, times C(0, 0).
    precision: f32,
}

impl<const K: usize> Row<K> {
    const EMPTY: Self = Self {
        neighbours: [NodeSet::NONE; K],
        weights: [0.0; K],
        precision: 1.0,
    };
}

impl<const K: usize> SparseInverse<K> {
    /// Bytes taken for each node in contact at most, while it changes.
    pub(crate) const BYTES_A_NODE: usize = 2 * size_of::<Row<K>>()
        + size_of::<[u32; K]>()
        + K * size_of::<(u32, f32)>()
        + 2 * size_of::<u32>()
        + size_of::<f64>();

    /// For an empty contact set.
    pub(crate) fn new(table: &KernelTable) -> Self {
        Self {
            lattices: Lattices::new(table),
            unit: 1.0 / table.self_influence(),
            rows: Vec::new(),
            contact: NodeSet::new(table.grid().nodes()),
            columns: Vec::new(),
            starts: Vec::new(),
            entries: Vec::new(),
            scratch: Vec::new(),
        }
    }

    /// Makes it that of another contact set. Only nodes whose neighbours change cost anything much.
    pub(crate) fn update(&mut self, contact: &NodeSet) {
        let mut rows = vec![Row::EMPTY; contact.len()];
        let (lattices, nodes, places) = (&self.lattices, contact.nodes(), contact.places());
        let (old_rows, old_places) = (&self.rows, self.contact.places());
        for_each_chunk(&mut rows, CHUNK, |chunk, rows| {
            for (row, &node) in rows.iter_mut().zip(&nodes[chunk * CHUNK..]) {
                let mut found = [Neighbour::default(); K];
                let is_in = |node: usize| places[node] != NodeSet::NONE;
                let (count, lattice) = lattices.earlier(node as usize, is_in, &mut found);
                for (neighbour, found) in row.neighbours.iter_mut().zip(&found[..count]) {
                    *neighbour = found.node;
                }
                let old = old_rows.get(old_places[node as usize] as usize);
                match old {
                    Some(old) if old.neighbours == row.neighbours => *row = *old,
                    _ => vectorized(
                        #[inline(always)]
                        || row.fill(lattice, &found, count),
                    ),
                }
            }
        });
        self.rows = rows;
        self.contact.clone_from(contact);
        self.link();
    }

    /// Translates neighbours to rows, and transposes.
    fn link(&mut self) {
        let (rows, places) = (&self.rows, self.contact.places());
        self.columns.clear();
        self.columns.resize(rows.len(), [0; K]);
        for_each_chunk(&mut self.columns, CHUNK, |chunk, columns| {
            for (i, columns) in columns.iter_mut().enumerate() {
                let row = chunk * CHUNK + i;
                for (column, &neighbour) in columns.iter_mut().zip(&rows[row].neighbours) {
                    *column = match places.get(neighbour as usize) {
                        Some(&place) => place,
                        None => row as u32,
                    };
                }
            }
        });
        self.starts.clear();
        self.starts.resize(rows.len() + 1, 0);
        for (row, columns) in self.columns.iter().enumerate() {
            for &column in columns.iter().take_while(|&&column| column != row as u32) {
                self.starts[column as usize + 1] += 1;
            }
        }
        let mut total = 0;
        for start in &mut self.starts {
            total += *start;
            *start = total;
        }
        self.entries.clear();
        self.entries.resize(total as usize, (0, 0.0));
        // Filled from the back, so that `starts` ends where it should.
        let ends = &mut self.starts[1..];
        for (row, columns) in self.columns.iter().enumerate().rev() {
            let used = columns.iter().take_while(|&&column| column != row as u32);
            for (&column, &weight) in used.zip(&rows[row].weights) {
                let end = &mut ends[column as usize];
                *end -= 1;
                self.entries[*end as usize] = (row as u32, weight);
            }
        }
        // Each of `ends` is now a start: move them down by one.
        let length = self.starts.len();
        self.starts.copy_within(1..length, 0);
        self.starts[length - 1] = total;
        self.scratch.resize(rows.len(), 0.0);
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.rows[..])
            + size_of_val(&self.columns[..])
            + size_of_val(&self.entries[..])
            + size_of_val(self.contact.places())
    }

    /// y = M x for values at the nodes in contact.
    pub(crate) fn apply(&mut self, x: &[f64], y: &mut Vec<f64>) {
        let (rows, columns, unit) = (&self.rows, &self.columns, self.unit);
        for_each_chunk(&mut self.scratch, CHUNK, |chunk, values| {
            let first = chunk * CHUNK;
            for (i, value) in values.iter_mut().enumerate() {
                let (row, columns) = (&rows[first + i], &columns[first + i]);
                let mut lanes = [0.0; 4];
                let pairs = columns.chunks_exact(4).zip(row.weights.chunks_exact(4));
                for (columns, weights) in pairs {
                    for ((lane, &column), &weight) in lanes.iter_mut().zip(columns).zip(weights) {
                        *lane += f64::from(weight) * x[column as usize];
                    }
                }
                let explained = (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
                *value = (x[first + i] - explained) * (f64::from(row.precision) * unit);
            }
        });
        y.resize(x.len(), 0.0);
        let (scratch, starts, entries) = (&self.scratch, &self.starts, &self.entries);
        for_each_chunk(y, CHUNK, |chunk, values| {
            let first = chunk * CHUNK;
            for (i, value) in values.iter_mut().enumerate() {
                let range = starts[first + i] as usize..starts[first + i + 1] as usize;
                let served = entries[range].iter();
                let terms = served.map(|&(row, weight)| f64::from(weight) * scratch[row as usize]);
                *value = scratch[first + i] - terms.sum::<f64>();
            }
        });
    }
}

impl<const K: usize> Row<K> {
    /// Weights and precision given the neighbours: Gaussian elimination of the k × k influence
    /// matrix of the first `count`; the others are unit rows.
    #[inline(always)]
    fn fill(&mut self, lattice: &Lattice, found: &[Neighbour; K], count: usize) {
        let mut matrix = [[0.0_f32; K]; K];
        let mut rhs = [0.0_f32; K];
        for (i, row) in matrix.iter_mut().enumerate() {
            row[i] = 1.0;
            if i < count {
                rhs[i] = lattice.between(found[i].offset, 0);
                for (value, other) in row[i + 1..count].iter_mut().zip(&found[i + 1..count]) {
                    *value = lattice.between(found[i].offset, other.offset);
                }
            }
        }
        let mut unexplained = 1.0_f32;
        for j in 0..K {
            let pivot_row = matrix[j];
            let inverse = 1.0 / pivot_row[j];
            unexplained -= rhs[j] * rhs[j] * inverse;
            for i in j + 1..K {
                let factor = pivot_row[i] * inverse;
                for (value, pivot) in matrix[i].iter_mut().zip(&pivot_row) {
                    *value -= factor * pivot;
                }
                rhs[i] -= factor * rhs[j];
            }
        }
        for j in (0..K).rev() {
            let row = &matrix[j];
            let mut value = rhs[j];
            for (entry, weight) in row[j + 1..].iter().zip(&self.weights[j + 1..]) {
                value -= entry * weight;
            }
            self.weights[j] = value / row[j];
        }
        self.precision = 1.0 / unexplained;
        // A kernel may be too close to singular for single precision: then the node stands alone.
        let sane = unexplained > 1e-4 && self.weights.iter().all(|weight| weight.is_finite());
        if !sane {
            self.weights = [0.0; K];
            self.precision = 1.0;
        }
    }
}
