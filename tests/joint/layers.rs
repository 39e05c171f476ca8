//! What follows from a path on homogeneous half-spaces alone is refused where the body is known to have layers.

use asperity::bed::Bed;
use asperity::creep::{Creep, PiecewiseLinear, Prony, Relaxation, ViscoelasticBed};
use asperity::joint::{Conduction, InterfaceTable};
use asperity::kernel::{Base, Layer, Layered, LayeredBody, Layering, Theory};
use asperity::loading::History;
use asperity::record::LoadingRecord;
use asperity::slip::{Friction, PartialSlip, SlipHistory};
use asperity::{Boussinesq, Error, Grid, InfluenceKernel, LoadingSolver};

use super::rough;

const STEEL: Base = Base::HalfSpace { youngs_modulus: 210e9, poissons_ratio: 0.3 };

fn body(youngs_modulus: f64, base: Base) -> LayeredBody {
    LayeredBody::new(&[Layer { youngs_modulus, poissons_ratio: 0.3, thickness: 2e-4 }], base)
        .unwrap()
}

fn record(kernel: &dyn InfluenceKernel) -> LoadingRecord {
    let surface = rough();
    let builder = LoadingSolver::builder(&surface, kernel).max_area_fraction(0.1);
    let mut path = builder.build().unwrap();
    let history = path.by_ref().collect::<Result<History, Error>>().unwrap();
    LoadingRecord::new(&path, history).unwrap()
}

/// Whether each is refused: slip in both ways, creep in three, bounds, tables with conductance and with friction, and
/// the conductances of a state in both ways.
fn refused(record: &LoadingRecord) -> [bool; 10] {
    fn is_refused<T>(result: Result<T, Error>) -> bool {
        match result {
            Ok(_) => false,
            Err(Error::NotHomogeneous { .. }) => true,
            Err(other) => panic!("{other}"),
        }
    }
    let history = record.history();
    let bed = Bed::of_record(record).unwrap();
    let last = bed.last_load();
    let friction = Friction::new(0.3, 1.2).unwrap();
    let prony = Prony::shares(&[(1.0, 0.5)]).unwrap();
    let held = |value: f64| PiecewiseLinear::new([(0.0, value)]).unwrap();
    let approach = 0.5 * bed.approaches().last().unwrap();
    let heat = Conduction::thermal(1e11, 0.04).unwrap();
    let table = || InterfaceTable::builder(history);
    // Pressure over overclosure is what the path says, whatever the body.
    assert!(table().build().unwrap().rows().len() > 5);
    [
        is_refused(PartialSlip::new(&bed, last, friction)),
        is_refused(SlipHistory::new(&bed, friction).to(0.5 * last, 0.0)),
        is_refused(Creep::new(&bed, &prony, &held(0.1 * last))),
        is_refused(Relaxation::new(&bed, &prony, &held(approach))),
        is_refused(ViscoelasticBed::new(&bed, &prony)),
        is_refused(heat.bounds(history, 1e-8)),
        is_refused(table().conduction(heat).build()),
        is_refused(table().friction(0.3, 1.2).build()),
        is_refused(heat.of(&history.states()[5].contact, history.layering())),
        is_refused(heat.of_interface(&history.states()[5].contact, history.layering())),
    ]
}

#[test]
fn theories_of_half_spaces_are_refused_on_layers() {
    let grid = Grid::square(32, 1.25e-3).unwrap();
    let free = |body| Layered::free(grid, body).unwrap();
    let coat = record(&free(body(50e9, STEEL)));
    assert_eq!(coat.history().layering(), Layering::Several);
    assert_eq!(refused(&coat), [true; 10]);
    // One material on a rigid base creeps as a whole.
    let alone = record(&free(body(3e6, Base::Rigid)));
    assert_eq!(alone.history().layering(), Layering::OneMaterial);
    assert_eq!(refused(&alone), [true, true, false, false, false, true, true, true, true, true]);
    let half_space = record(&Boussinesq::new(grid, 1e11).unwrap());
    assert_eq!(half_space.history().layering(), Layering::HalfSpace);
    assert_eq!(refused(&half_space), [false; 10]);
    // A layer on its own material is none.
    let same = record(&free(body(210e9, STEEL)));
    assert_eq!(refused(&same), [false; 10]);
    // Parts of a path are of the same body; of states alone nothing is known.
    let targets = [asperity::ContactTarget::Load(0.5 * coat.states().last().unwrap().contact.load)];
    let (part, _) = coat.history().ending_at(&grid, &targets).unwrap();
    assert_eq!(part.layering(), Layering::Several);
    let kernel = free(body(50e9, STEEL));
    let mut path =
        LoadingSolver::builder(&rough(), &kernel).max_area_fraction(0.1).build().unwrap();
    assert_eq!(path.run().unwrap().layering(), Layering::Several);
    let states: History = coat.states().iter().copied().collect();
    assert_eq!(states.layering(), Layering::Unknown);
    assert!(states.on(Layering::Several).layering().check(Theory::Slip).is_err());
}

/// Why one material on a rigid base may creep: displacements go with 1/E, so that all of them relax by one function.
/// Not so with a second elastic material. Coefficients are right to 1e-9.
#[test]
fn one_material_on_a_rigid_base_answers_in_proportion() {
    let grid = Grid::square(16, 1.3e-3).unwrap();
    let worst = |base: Base| {
        let [soft, stiff] = [3e6, 6e6]
            .map(|youngs_modulus| Layered::free(grid, body(youngs_modulus, base)).unwrap());
        let offsets = (0..16).flat_map(|i| (0..16).map(move |j| (i, j)));
        let scale = soft.coefficient(0, 0);
        let errors = offsets
            .map(|(i, j)| (soft.coefficient(i, j) - 2.0 * stiff.coefficient(i, j)).abs() / scale);
        errors.fold(0.0, f64::max)
    };
    assert!(worst(Base::Rigid) < 1e-9, "{:e}", worst(Base::Rigid));
    let soft_base = Base::HalfSpace { youngs_modulus: 1e6, poissons_ratio: 0.3 };
    assert!(worst(soft_base) > 1e-2, "{:e}", worst(soft_base));
}
