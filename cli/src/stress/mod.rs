//! `asperity stress`: the stress below the surface at a state of a record, and the load at which a body begins to
//! yield.
//!
//! Prints where each measure of stress is greatest, and writes `stress.csv`, `stress.png`, `von_mises_map.png`,
//! `shear_map.png`, `section_x.png` and `section_y.png`; with `--volume` also `stress.vti`.

mod body;
mod charts;
mod maps;
mod progress;
mod section;
mod table;
mod words;

use std::path::PathBuf;

use asperity::record::LoadingRecord;
use asperity_cli::outcome::{self, Failure, Outcome};
use asperity_cli::{answer, panel, speech};
use clap::{ArgGroup, Args};

use crate::earlier::{self, Earlier};
use crate::material::Material;
use crate::values::{ANGLE, FORCE, LENGTH, PRESSURE, SHARE, poisson};
use body::Moment;

/// Stress below the surface of a recorded contact: where it is greatest, maps and sections, and the load of first yield
///
/// The body is a homogeneous elastic half-space or has layers, under the pressures of a state of the path, and, with
/// --friction on a homogeneous one, under tractions in proportion to them. Prints von Mises' and Tresca's equivalent
/// stress, the greatest shear stress and the greatest tension with their places; with --yield-stress also the load of
/// the path at which the body, or each of its layers, begins to yield.
///
/// Writes stress.csv (the greatest value of each measure at each depth, for each body), stress.png, maps of von Mises'
/// stress and of the greatest shear stress at the depths where they are greatest (von_mises_map.png, shear_map.png),
/// and vertical sections of von Mises' stress through its greatest value (section_x.png, section_y.png); maps and
/// sections are of the first body.
#[derive(Debug, Args)]
#[command(group(ArgGroup::new("ratio").args(["poisson", "material"])))]
pub(crate) struct Options {
    /// File that `asperity path --record` has written
    #[arg(value_name = "FILE.npz")]
    record: PathBuf,

    /// Load of the state whose stresses are computed [default: the last state]
    #[arg(long, value_name = "NEWTONS", value_parser = FORCE.positive())]
    load: Option<f64>,

    /// Poisson's ratio of the body [default: both bodies of the record, if it knows them; layers it knows]
    #[arg(long, value_name = "NU", value_parser = poisson)]
    poisson: Option<f64>,

    /// The body: a name (steel, aluminium, ...) or Young's modulus in Pa and Poisson's ratio (210e9,0.3)
    #[arg(long, value_name = "NAME|E,NU")]
    material: Option<Material>,

    /// The other body [default: rigid]
    #[arg(long, value_name = "NAME|E,NU", requires = "material", conflicts_with = "poisson")]
    against: Option<Material>,

    /// Yield stress of the body, of layers one for all or one for each from the uppermost to the base: prints the load
    /// at which von Mises' stress reaches it in each material
    #[arg(long, value_name = "PA,...", value_delimiter = ',', value_parser = PRESSURE.positive())]
    yield_stress: Vec<f64>,

    /// Yield stress of the other body
    #[arg(long, value_name = "PA", value_parser = PRESSURE.positive())]
    against_yield_stress: Option<f64>,

    /// Coefficient of friction of a contact that slides: tractions of so many times the pressure
    #[arg(long, value_name = "MU", value_parser = SHARE.not_negative(), default_value_t = 0.0)]
    friction: f64,

    /// Direction of sliding in degrees from x towards y: that in which the other body moves over this one
    #[arg(long, value_name = "DEGREES", value_parser = ANGLE.any(), default_value_t = 0.0, requires = "friction")]
    angle: f64,

    /// Depth at which stresses are computed; may be given several times [default: from the surface to the size of the
    /// largest patch, and around the greatest stress]
    #[arg(long, value_name = "METRES", value_parser = LENGTH.not_negative())]
    depth: Vec<f64>,

    /// Write stress.vti, which ParaView opens: the stress tensor and its measures at so many depths, as deep as the
    /// sections
    #[arg(long, value_name = "DEPTHS", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    volume: Option<u32>,

    /// Print one JSON object with load, mean_pressure, friction, angle, bodies and warnings, and write files only if
    /// --out is given. Each body has poissons_ratio, von_mises, tresca, greatest_shear and greatest_tension (value,
    /// depth, node), depths, and materials, from the uppermost layer to the base: the same four of each (null without a
    /// depth in it), yield_stress, and first_yield (load, contact_nodes, von_mises; null if the path ends before); SI
    /// units
    #[arg(long)]
    json: bool,

    /// Directory for the files, created if it does not exist [default: out]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Reads the record, says where stresses are greatest, and writes the files.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    if options.json {
        speech::be_quiet();
    }
    let file = options.record.display();
    let record = LoadingRecord::read_npz(&options.record)
        .map_err(|error| Failure::new(format!("cannot read {file}"), error))?;
    let mut moment = Moment::new(&record, options)?;
    let bodies = moment.bodies(options)?;
    let mut warnings = words::warnings(&moment, &bodies, options.depth.is_empty());
    warnings.extend(body::warning_of_path(&record, options)?);
    if options.json {
        answer!("{}", words::object(&moment, &bodies, &warnings));
    }
    words::print(&moment, &bodies);
    warnings.iter().for_each(speech::warn);
    let Some(directory) = outcome::directory(options.out.as_deref(), options.json) else {
        return Ok(());
    };
    panel::register_font()?;
    outcome::create_folder(directory)?;
    let earlier = Earlier::of(&earlier::STRESS, Some(directory), &[Some(&options.record)]);
    let mut outcome = Outcome::default();
    let place = |name: &str| directory.join(name);
    outcome.written(table::write(&moment, &bodies, &place("stress.csv")));
    outcome.written(charts::draw(&bodies, &place("stress.png")));
    let Some(body) = bodies.first() else { return earlier.finish(outcome) };
    outcome.all_written(maps::draw(&moment, body, directory));
    outcome.all_written(section::draw(&moment, body, directory));
    if let Some(depths) = options.volume {
        outcome.written(section::write_volume(&moment, body, depths as usize, place("stress.vti")));
    }
    earlier.finish(outcome)
}
