//! A boundary element method of viscoelastic contact in steps of time. It knows no path and no bed: in each step it
//! finds the contact of the present gaps by an active set, with dense solves, and each node keeps its own memory of its
//! pressure.

use asperity::InfluenceKernel;
use asperity::creep::Prony;
use asperity::surface::HeightMap;
use asperity_testing::dense::{influence_matrix, initial_gap, restrict};
use nalgebra::{DMatrix, DVector};

/// What a step is to end at.
#[derive(Debug, Clone, Copy)]
pub(crate) enum To {
    Load(f64),
    Approach(f64),
}

pub(crate) struct Stepping {
    influence: DMatrix<f64>,
    initial_gap: Vec<f64>,
    cell_area: f64,
    prony: Prony,
    /// Of all nodes, one for each term of creep, and the integral of the pressure.
    memory: Vec<DVector<f64>>,
    pub(crate) pressure: DVector<f64>,
    pub(crate) gap: Vec<f64>,
    pub(crate) inside: Vec<bool>,
    pub(crate) approach: f64,
}

impl Stepping {
    /// On a surface of the grid of a kernel, whose E* is that of the modulus at once.
    pub(crate) fn new(heights: &HeightMap, kernel: &dyn InfluenceKernel, prony: &Prony) -> Self {
        let gap = initial_gap(heights.matrix());
        let nodes = gap.len();
        Self {
            influence: influence_matrix(kernel),
            cell_area: kernel.grid().cell_area(),
            prony: prony.clone(),
            memory: vec![DVector::zeros(nodes); prony.creep_terms().len() + 1],
            pressure: DVector::zeros(nodes),
            inside: gap.iter().map(|gap| *gap == 0.0).collect(),
            gap: gap.clone(),
            initial_gap: gap,
            approach: 0.0,
        }
    }

    pub(crate) fn nodes(&self) -> usize {
        self.inside.iter().filter(|inside| **inside).count()
    }

    pub(crate) fn load(&self) -> f64 {
        self.cell_area * self.pressure.sum()
    }

    pub(crate) fn mean_gap(&self) -> f64 {
        self.gap.iter().sum::<f64>() / self.gap.len() as f64
    }

    /// One step, with the pressure linear in it.
    pub(crate) fn step(&mut self, duration: f64, to: To) {
        let factors: Vec<[f64; 3]> = self
            .prony
            .creep_terms()
            .iter()
            .map(|term| {
                // Of s' = (x − s)/τ with x linear: e^−z, and what the old and the new x add.
                let z = duration / term.time;
                let mean = if z > 0.0 { -(-z).exp_m1() / z } else { 1.0 };
                [(-z).exp(), mean - (-z).exp(), 1.0 - mean]
            })
            .collect();
        let flow = 0.5 * duration * self.prony.fluidity();
        let last = self.memory.len() - 1;
        let mut strain = &self.memory[last] * self.prony.fluidity() + &self.pressure * flow;
        let mut slope = self.prony.instantaneous_compliance() + flow;
        for ((term, [keep, old, now]), memory) in
            self.prony.creep_terms().iter().zip(&factors).zip(&self.memory)
        {
            strain += (memory * *keep + &self.pressure * *old) * term.amount;
            slope += term.amount * now;
        }
        let kept = &self.influence * strain;
        let gap: Vec<f64> = self.initial_gap.iter().zip(&kept).map(|(g, u)| g + u).collect();
        let pressure = self.solve(&gap, slope, to);
        for ([keep, old, now], memory) in factors.iter().zip(&mut self.memory) {
            *memory = &*memory * *keep + &self.pressure * *old + &pressure * *now;
        }
        self.memory[last] += (&self.pressure + &pressure) * (0.5 * duration);
        self.pressure = pressure;
    }

    /// p ≥ 0, gap + slope C p − δ ≥ 0, one of them zero at each node.
    fn solve(&mut self, gap: &[f64], slope: f64, to: To) -> DVector<f64> {
        let nodes = gap.len();
        // What counts as closed: rounding of lengths such as these.
        let scale = gap.iter().fold(0.0_f64, |a, g| a.max(g.abs()));
        for _ in 0..400 {
            if let To::Load(_) = to
                && !self.inside.contains(&true)
            {
                // A load takes at least the node that is nearest.
                let least = gap.iter().copied().fold(f64::INFINITY, f64::min);
                self.inside = gap.iter().map(|gap| *gap == least).collect();
            }
            let contact: Vec<usize> = (0..nodes).filter(|&i| self.inside[i]).collect();
            let (mut pressure, mut approach) = (DVector::zeros(nodes), self.approach);
            if let To::Approach(wanted) = to {
                approach = wanted;
            }
            if !contact.is_empty() {
                let matrix = restrict(&self.influence, &contact) * slope;
                let factor = matrix.cholesky().unwrap();
                let ones = DVector::from_element(contact.len(), 1.0);
                let gaps = DVector::from_iterator(contact.len(), contact.iter().map(|&i| -gap[i]));
                let (by_gap, by_approach) = (factor.solve(&gaps), factor.solve(&ones));
                if let To::Load(load) = to {
                    approach = (load / self.cell_area - by_gap.sum()) / by_approach.sum();
                }
                for (k, &i) in contact.iter().enumerate() {
                    pressure[i] = by_gap[k] + approach * by_approach[k];
                }
            }
            let displacement = &self.influence * &pressure * slope;
            let left: Vec<f64> = (0..nodes).map(|i| gap[i] + displacement[i] - approach).collect();
            let next: Vec<bool> = (0..nodes)
                .map(|i| if self.inside[i] { pressure[i] >= 0.0 } else { left[i] < -1e-14 * scale })
                .collect();
            if next == self.inside {
                self.approach = approach;
                self.gap = left;
                for (gap, inside) in self.gap.iter_mut().zip(&self.inside) {
                    if *inside {
                        *gap = 0.0;
                    }
                }
                return pressure;
            }
            self.inside = next;
        }
        panic!("the active set does not settle");
    }
}

/// A rough surface.
pub(crate) fn rough(grid: &asperity::Grid, seed: u64) -> HeightMap {
    asperity_testing::surfaces::rough(grid, seed)
}
