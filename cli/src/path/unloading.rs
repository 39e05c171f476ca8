//! Unloading from the last state, with `--unload`: `unloading.csv`, its picture, and the surface that is left.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use asperity::io::{write_npy, write_x3p};
use asperity::loading::{History, LoadingBuilder};
use asperity::{LoadingSolver, LoadingState};

use super::Solver;
use super::fields::RESIDUAL_SURFACES;
use super::job::Job;
use super::lines::printed;
use super::loop_chart::{self, Branches};
use asperity_cli::number::quantity;
use asperity_cli::outcome::{self, Failure};
use asperity_cli::say;

/// Writes and draws the states on unloading, from the last state of the path to the last touch, and writes the surface
/// that is left; prints what the loop costs.
pub(super) fn write(
    job: &Job,
    solver: &mut Solver,
    loading: &[LoadingState],
    directory: &Path,
) -> Result<Vec<PathBuf>, Failure> {
    let failed = |error| Failure::new("cannot compute the unloading path", error);
    let Some(last) = solver.state() else {
        return Ok(Vec::new());
    };
    let surface = solver.residual_surface().map_err(failed)?;
    let kernel = job.kernel()?;
    let load = last.contact.load;
    let builder = LoadingSolver::builder(&surface, &kernel).updater(job.updater().make());
    let builder = job.memory_budget().into_iter().fold(builder, LoadingBuilder::memory_budget);
    // Without a load there is the first touch alone.
    let (builder, count) = match load > 0.0 {
        true => (builder.max_load(load), usize::MAX),
        false => (builder, 1),
    };
    let path = builder.build().map_err(failed)?;
    let states = path.take(count).collect::<Result<History, _>>().map_err(failed)?;
    let states = states.up_to_load(load);
    // Approaches of the path count from the first touch of the first surface.
    let touch = -surface.max_height();
    let mut lines = "load,approach,mean_gap,contact_area,contact_area_fraction,contact_stiffness,\
                     interfacial_stiffness,elastic_energy\n"
        .to_string();
    let mut branches = Branches {
        loading: loading.iter().map(|state| state.contact).collect(),
        unloading: states.states().iter().rev().map(|state| state.contact).collect(),
    };
    for contact in &mut branches.unloading {
        contact.approach += touch;
        // Writing to a text cannot fail.
        let _ = writeln!(
            lines,
            "{:e},{:e},{:e},{:e},{:e},{},{},{:e}",
            contact.load,
            contact.approach,
            contact.mean_gap,
            contact.contact_area,
            contact.contact_area_fraction,
            printed(contact.contact_stiffness),
            printed(contact.interfacial_stiffness),
            contact.energy,
        );
    }
    if let Some(plastic) = last.contact.plastic {
        say!();
        say!(
            "unloading: the surfaces part at an approach of {}; {} of {} come back, {} are lost in a plastic volume of {}",
            quantity(touch, "m", 4),
            quantity(last.contact.energy, "J", 4),
            quantity(last.contact.energy + plastic.work, "J", 4),
            quantity(plastic.work, "J", 4),
            quantity(plastic.volume, "m³", 4)
        );
    }
    let [npy, x3p] = RESIDUAL_SURFACES.map(|name| directory.join(name));
    let heights = surface.matrix();
    write_npy(&npy, heights).map_err(|error| Failure::writing(&npy, error))?;
    write_x3p(&x3p, &job.grid(), heights).map_err(|error| Failure::writing(&x3p, error))?;
    let table = outcome::write(&directory.join("unloading.csv"), lines)?;
    Ok(vec![table, npy, x3p, loop_chart::draw(job, &branches, directory)?])
}
