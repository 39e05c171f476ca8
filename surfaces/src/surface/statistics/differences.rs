//! Slopes and curvatures from differences between nodes.

use crate::surface::Topography;

impl Topography {
    /// Root mean square slopes along x and along y from forward differences, without unit:
    ///
    /// ```math
    /// R_{\Delta q,x} = \sqrt{\left\langle \left(\frac{h_{i+1,j} - h_{ij}}{\Delta x}\right)^2 \right\rangle}
    /// ```
    ///
    /// and likewise along y. The means run over the neighbours that exist, none across the border; a direction with
    /// a single node has the slope 0.
    #[must_use]
    pub fn rms_slopes(&self) -> (f64, f64) {
        let (along_x, along_y) = self.map().mean_square_slopes(self.grid());
        (along_x.sqrt(), along_y.sqrt())
    }

    /// Root mean square gradient from forward differences, without unit: S_dq of ISO 25178-2, whose gradient is left
    /// open there. See [`HeightMap::rms_gradient`](crate::HeightMap::rms_gradient).
    #[must_use]
    pub fn rms_gradient(&self) -> f64 {
        let (along_x, along_y) = self.map().mean_square_slopes(self.grid());
        (along_x + along_y).sqrt()
    }

    /// Root mean square Laplacian from second differences \[1/m\]:
    ///
    /// ```math
    /// \sqrt{\left\langle \left(
    ///     \frac{h_{i+1,j} - 2 h_{ij} + h_{i-1,j}}{\Delta x^2} +
    ///     \frac{h_{i,j+1} - 2 h_{ij} + h_{i,j-1}}{\Delta y^2} \right)^2 \right\rangle}
    /// ```
    ///
    /// over the nodes that have all four neighbours. A direction with a single node is constant; 0 if no node has its
    /// neighbours.
    #[must_use]
    pub fn rms_laplacian(&self) -> f64 {
        let heights = self.heights();
        let (nx, ny) = heights.shape();
        let second = |before: f64, here: f64, after: f64, cell: f64| {
            // Differences of neighbours first: they are small beside the heights.
            ((after - here) - (here - before)) / cell / cell
        };
        let inner = |nodes: usize| if nodes == 1 { 0..1 } else { 1..nodes - 1 };
        let (mut sum, mut count) = (0.0, 0_usize);
        for iy in inner(ny) {
            let mut column = 0.0;
            for ix in inner(nx) {
                let mut laplacian = 0.0;
                if nx > 1 {
                    let [before, after] = [ix - 1, ix + 1].map(|ix| heights[(ix, iy)]);
                    laplacian += second(before, heights[(ix, iy)], after, self.grid().dx());
                }
                if ny > 1 {
                    let [before, after] = [iy - 1, iy + 1].map(|iy| heights[(ix, iy)]);
                    laplacian += second(before, heights[(ix, iy)], after, self.grid().dy());
                }
                column += laplacian * laplacian;
                count += 1;
            }
            sum += column;
        }
        (sum / count.max(1) as f64).sqrt()
    }

    /// Root mean square curvature from second differences \[1/m\], half of the
    /// [Laplacian](Self::rms_laplacian): the mean ½ (κ₁ + κ₂) of the principal curvatures of a surface of small slopes.
    #[must_use]
    pub fn rms_curvature(&self) -> f64 {
        0.5 * self.rms_laplacian()
    }
}
