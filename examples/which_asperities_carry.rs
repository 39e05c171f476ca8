//! Which asperities carry the load, where are they, and how hard are they pressed?
//!
//! Pictures of patches along a whole path come from `asperity patches`, and maps of pressure from `asperity path`.
//!
//! ```text
//! cargo run --release --example which_asperities_carry
//! ```
//!
//! It prints:
//!
//! ```text
//! 58 patches under 50 N, 1.98 % of the nominal area
//!    x [µm]    y [µm]   area [µm²]   load [%]   sum [%]   mean p [GPa]   max p [GPa]
//!     390.1     910.1       1419.1      11.21     11.21          3.951         8.850
//!     316.7      80.2       1770.0      11.09     22.30          3.133         6.501
//!     137.5     260.2       1739.5       9.06     31.36          2.603         6.892
//!     622.1     489.6       1480.1       7.59     38.95          2.565         6.363
//!     732.1     799.9       1510.6       7.56     46.52          2.503         7.532
//!     156.8     395.7        976.6       6.55     53.07          3.353         9.681
//!     396.5      97.9        900.3       4.44     57.51          2.465         8.559
//!     900.0     517.0        595.1       3.47     60.98          2.917         7.424
//!     925.2      10.4        778.2       3.45     64.42          2.215         7.831
//!     799.9     661.6        885.0       3.41     67.84          1.927         6.116
//! ```

use asperity::patches::{Connectivity, Patches};
use asperity::surface::Amplitude;
use asperity::{Boussinesq, Error, FixedLoadSolver, Grid, InfluenceKernel, SelfAffine};

const LOAD: f64 = 50.0; // [N]
const E_STAR: f64 = 115e9;

fn main() -> Result<(), Error> {
    let side = 1e-3;
    let grid = Grid::square(256, side)?;
    let surface = SelfAffine::new(0.8, side / 4.0, side / 64.0, Amplitude::RmsHeight(1e-6), 1)?;
    let half_space = Boussinesq::new(grid, E_STAR)?;
    let solution = FixedLoadSolver::new(&surface, &half_space)?.solve(LOAD)?;

    let patches = Patches::new(
        &solution.fields.contact_map,
        &grid,
        half_space.boundary(),
        Connectivity::Four,
    )?;
    let loads = patches.loads(&solution.fields.pressure)?;
    let mut both: Vec<_> = patches.patches().iter().zip(&loads).collect();
    both.sort_by(|a, b| b.1.load.total_cmp(&a.1.load));

    println!(
        "{} patches under {LOAD} N, {:.2} % of the nominal area",
        both.len(),
        100.0 * solution.contact.contact_area_fraction
    );
    println!("   x [µm]    y [µm]   area [µm²]   load [%]   sum [%]   mean p [GPa]   max p [GPa]");
    let mut sum = 0.0;
    for (patch, carried) in both.iter().take(10) {
        sum += carried.load;
        let (x, y) = patch.centroid;
        println!(
            "{:9.1} {:9.1} {:12.1} {:10.2} {:9.2} {:14.3} {:13.3}",
            1e6 * x,
            1e6 * y,
            1e12 * patch.area,
            100.0 * carried.load / solution.contact.load,
            100.0 * sum / solution.contact.load,
            carried.mean_pressure / 1e9,
            carried.max_pressure / 1e9
        );
    }
    Ok(())
}
