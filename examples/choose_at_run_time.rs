//! Surface and half-space come from a configuration: how do I choose them while the program runs?
//!
//! ```text
//! cargo run --release --example choose_at_run_time
//! ```
//!
//! It prints:
//!
//! ```text
//! surface  half-space  load at 10 % contact [N]
//! sphere   free                        1.3262e1
//! sphere   periodic                    1.3418e1
//! sphere   spectral                    1.3390e1
//! rough    free                        1.0573e4
//! rough    periodic                    1.0324e4
//! rough    spectral                    1.0182e4
//! ```

use std::error::Error;

use asperity::surface::Paraboloid;
use asperity::{
    Boussinesq, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq, SelfAffine, Spectral,
    Surface,
};

fn surface(name: &str) -> Result<Box<dyn Surface>, Box<dyn Error>> {
    Ok(match name {
        "sphere" => Box::new(Paraboloid::new(1.0)?),
        "rough" => Box::new(SelfAffine::zhang2020(1)),
        _ => return Err(format!("no surface is called {name}").into()),
    })
}

fn half_space(name: &str, grid: Grid) -> Result<Box<dyn InfluenceKernel>, Box<dyn Error>> {
    let e_star = 115e9;
    Ok(match name {
        "free" => Box::new(Boussinesq::new(grid, e_star)?),
        "periodic" => Box::new(PeriodicBoussinesq::new(grid, e_star)?),
        "spectral" => Box::new(Spectral::new(grid, e_star)?),
        _ => return Err(format!("no half-space is called {name}").into()),
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let grid = Grid::square(128, 2.5e-3)?;
    println!("surface  half-space  load at 10 % contact [N]");
    for surface_name in ["sphere", "rough"] {
        let surface = surface(surface_name)?;
        for name in ["free", "periodic", "spectral"] {
            let half_space = half_space(name, grid)?;
            let path =
                LoadingSolver::builder(&surface, &half_space).max_area_fraction(0.1).build()?;
            if let Some(last) = path.last() {
                println!("{surface_name:7}  {name:10}  {:24.4e}", last?.contact.load);
            }
        }
    }
    Ok(())
}
