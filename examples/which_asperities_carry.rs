//! Which asperities carry the load, where are they, and how hard are they pressed?
//!
//! Pictures of patches along a whole path come from `asperity patches`, and maps of pressure from `asperity path`.
//!
//! ```text
//! cargo run --release --example which_asperities_carry
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

    let patches =
        Patches::new(&solution.contact_map, &grid, half_space.boundary(), Connectivity::Four)?;
    let loads = patches.loads(&solution.pressure)?;
    let mut both: Vec<_> = patches.patches().iter().zip(&loads).collect();
    both.sort_by(|a, b| b.1.load.total_cmp(&a.1.load));

    println!(
        "{} patches under {LOAD} N, {:.2} % of the nominal area",
        both.len(),
        100.0 * solution.state.contact_area_fraction
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
            100.0 * carried.load / solution.state.load,
            100.0 * sum / solution.state.load,
            carried.mean_pressure / 1e9,
            carried.max_pressure / 1e9
        );
    }
    Ok(())
}
