//! My surface has a formula: how do I press that?
//!
//! A surface gives its heights on any grid, positive towards the half-space. Here they are parallel
//! ridges, pressed alone and with roughness on top.
//!
//! ```text
//! cargo run --release --example own_surface
//! ```
//!
//! It prints:
//!
//! ```text
//! ridges
//! contact [%]    load [N]  approach [m]
//!        0.01    0.0000e0      0.0000e0
//!        1.23  2.8198e-13    3.8481e-21
//!        2.45    1.0334e1     7.7347e-8
//!        3.67    3.8418e1     2.2602e-7
//!        4.89    3.7106e2     1.5863e-6
//!        6.11    5.2098e2     2.1910e-6
//!        7.33    9.4822e2     3.8817e-6
//!        8.55    1.4141e3     5.6840e-6
//!        9.77    1.7667e3     7.0276e-6
//!       10.99    2.2175e3     8.7206e-6
//!       12.21    2.7378e3     1.0638e-5
//!       13.43    4.2372e3     1.6104e-5
//!       14.65    5.0438e3     1.9015e-5
//!       15.88    5.7164e3     2.1419e-5
//!       17.10    6.2910e3     2.3457e-5
//!       18.32    6.9323e3     2.5713e-5
//!       19.54    8.1437e3     2.9930e-5
//!       20.76    1.0096e4     3.6684e-5
//!       21.98    1.1571e4     4.1746e-5
//!       23.20    1.3199e4     4.7299e-5
//!       24.42    1.4208e4     5.0719e-5
//!       25.64    1.4800e4     5.2713e-5
//!       26.86    1.5683e4     5.5677e-5
//!       28.08    1.8039e4     6.3533e-5
//!       29.30    2.0741e4     7.2499e-5
//! rough ridges
//! contact [%]    load [N]  approach [m]
//!        0.01    0.0000e0      0.0000e0
//!        1.23    8.7879e2     2.6249e-5
//!        2.45    2.1605e3     4.0107e-5
//!        3.67    3.4792e3     5.0488e-5
//!        4.89    4.8409e3     5.9436e-5
//!        6.11    6.1964e3     6.7281e-5
//!        7.33    7.6998e3     7.5206e-5
//!        8.55    9.4313e3     8.3808e-5
//!        9.77    1.1223e4     9.2254e-5
//!       10.99    1.3102e4     1.0071e-4
//!       12.21    1.5030e4     1.0900e-4
//!       13.43    1.7036e4     1.1729e-4
//!       14.65    1.9264e4     1.2623e-4
//!       15.88    2.1188e4     1.3375e-4
//!       17.10    2.3128e4     1.4118e-4
//!       18.32    2.4835e4     1.4758e-4
//!       19.54    2.6912e4     1.5521e-4
//!       20.76    2.9139e4     1.6325e-4
//!       21.98    3.1098e4     1.7021e-4
//!       23.20    3.3274e4     1.7783e-4
//!       24.42    3.5829e4     1.8667e-4
//!       25.64    3.7886e4     1.9372e-4
//!       26.86    4.0073e4     2.0114e-4
//!       28.08    4.2620e4     2.0971e-4
//!       29.30    4.5133e4     2.1812e-4
//! ```

use std::f64::consts::TAU;

use asperity::{Boussinesq, Error, Grid, LoadingSolver, SelfAffine, Surface, SurfaceError};
use nalgebra::DMatrix;

/// Parallel ridges, a wavelength apart.
#[derive(Clone, Copy)]
struct Ridges {
    amplitude: f64,
    wavelength: f64,
}

impl Surface for Ridges {
    fn heights(&self, grid: &Grid) -> Result<DMatrix<f64>, SurfaceError> {
        Ok(DMatrix::from_fn(grid.nx(), grid.ny(), |ix, iy| {
            let (x, _) = grid.position(ix, iy);
            self.amplitude * (TAU * x / self.wavelength).cos()
        }))
    }
}

/// Contact area and approach as the load grows.
fn press(name: &str, surface: impl Surface) -> Result<(), Error> {
    let half_space = Boussinesq::new(Grid::square(128, 2.5e-3)?, 115e9)?;
    let path = LoadingSolver::builder(&surface, &half_space).max_area_fraction(0.3).build()?;
    println!("{name}\ncontact [%]   load [kN]  approach [µm]");
    for state in path.step_by(500) {
        let contact = state?.contact;
        let area = 100.0 * contact.contact_area_fraction;
        println!("{area:11.2} {:11.3} {:14.3}", 1e-3 * contact.load, 1e6 * contact.approach);
    }
    Ok(())
}

fn main() -> Result<(), Error> {
    let ridges = Ridges { amplitude: 20e-6, wavelength: 0.5e-3 };
    press("ridges", ridges)?;
    press("rough ridges", ridges.plus(SelfAffine::zhang2020(1)))
}
