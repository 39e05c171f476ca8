//! A rough surface of 48 × 48 nodes against tables of a boundary element method in steps of time, of another program.

use std::path::PathBuf;

use asperity::bed::Bed;
use asperity::creep::{Control, Creep, PiecewiseLinear, Prony, ViscoelasticBed};
use asperity::loading::History;
use asperity::surface::HeightMap;
use asperity::{Boussinesq, Grid, LoadingSolver};
use asperity_testing::table;

fn data(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

fn path() -> (LoadingSolver, History) {
    let heights = asperity::io::read_npy(data("selfaffine_48.npy")).unwrap();
    let half_space = Boussinesq::new(Grid::square(48, 1e-2).unwrap(), 1.0).unwrap();
    let surface = HeightMap::new(heights).unwrap();
    let builder = LoadingSolver::builder(&surface, &half_space);
    let mut path = builder.max_nodes(560).build().unwrap();
    let history = path.by_ref().collect::<Result<_, _>>().unwrap();
    (path, history)
}

fn solid() -> Prony {
    Prony::relaxation(0.2, &[(1.0, 0.3), (0.1, 0.5)]).unwrap()
}

const LOAD: f64 = 3.41e-7;

/// A load put on at once and held: nodes, approach and mean gap of the table are exact, and its pressures have the
/// error of 150 steps from row to row, 2·10⁻⁵. The dense solves of both sides lose three digits of sixteen.
#[test]
fn a_load_that_is_held() {
    let (mut path, history) = path();
    let bed = Bed::new(&history).unwrap();
    let creep = Creep::new(&bed, &solid(), &PiecewiseLinear::step(LOAD).unwrap()).unwrap();
    assert_eq!(creep.recession(), None);
    let rows = table::read(data("creep/step_selfaffine_48.csv"));
    assert_eq!(rows.len(), 5);
    for row in rows {
        let [time, nodes, approach, mean_gap, max_pressure] = row[..] else {
            panic!("{row:?}");
        };
        let state = creep.at(time).unwrap();
        assert_eq!(state.contact_nodes as f64, nodes, "{time}");
        assert!((state.approach / approach - 1.0).abs() < 1e-12, "{time}");
        assert!((state.mean_gap / mean_gap - 1.0).abs() < 1e-12, "{time}");
        let exact = creep.pressure(time, usize::MAX).unwrap().pressure(&bed, &mut path).unwrap();
        assert!((exact.max() / max_pressure - 1.0).abs() < 2e-5, "{time}: {}", exact.max());
        assert!((exact.sum() * path.grid().cell_area() / LOAD - 1.0).abs() < 1e-11, "{time}");
        let on_path = creep.path_state(time).unwrap();
        let contact = path.contact_map_at(&on_path).unwrap();
        for (p, inside) in exact.iter().zip(&contact) {
            assert!(if *inside { *p >= -1e-13 } else { *p == 0.0 }, "{time}: {p}");
        }
        // Twenty pieces, and twice as many; at first all of it is one.
        let errors = [20, 40].map(|pieces| {
            let rough = creep.pressure(time, pieces).unwrap().pressure(&bed, &mut path).unwrap();
            (rough - &exact).abs().max() / exact.max()
        });
        println!("t = {time}: pieces {errors:?}");
        assert!(errors[0] < 4e-3, "{time}: {errors:?}");
        assert!(errors[1] < 0.7 * errors[0] || errors[0] < 1e-12, "{time}: {errors:?}");
    }
}

/// Unloading and reloading in steps of 0.05 with linear pressures, in both programs the same problem: to the rounding
/// of sixty dense solves.
#[test]
fn a_load_that_comes_and_goes() {
    let (mut path, history) = path();
    let bed = Bed::new(&history).unwrap();
    let mut contact = ViscoelasticBed::new(&bed, &solid()).unwrap();
    let rows = table::read(data("creep/history_selfaffine_48.csv"));
    assert_eq!(rows.len(), 60);
    for row in rows {
        let [time, load, nodes, approach, mean_gap, max_pressure] = row[..] else {
            panic!("{row:?}");
        };
        let state = contact.step(0.05, Control::Load(load)).unwrap();
        assert!((state.time - time).abs() < 1e-12);
        assert_eq!(state.contact_nodes as f64, nodes, "{time}");
        assert!((state.approach / approach - 1.0).abs() < 1e-11, "{time}");
        assert!((state.mean_gap / mean_gap - 1.0).abs() < 1e-11, "{time}");
        let pressure = contact.pressure(usize::MAX).unwrap().pressure(&bed, &mut path).unwrap();
        assert!((pressure.max() / max_pressure - 1.0).abs() < 1e-11, "{time}");
    }
    assert_eq!(contact.halvings(), 0);
}
