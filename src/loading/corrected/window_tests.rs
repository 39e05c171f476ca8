use super::*;
use crate::loading::row;
use crate::updater::Dense;

fn scales(tolerance: f64) -> Scales {
    Scales {
        length: 1.0,
        tolerance,
        tie: 1e-9,
    }
}

#[test]
fn windows_have_their_sizes() {
    let size = |size, settles| Corrected::new(size, settles).size;
    assert_eq!([size(None, true), size(None, false)], [60, 128]);
    assert_eq!([size(Some(3), true), size(Some(20), false)], [8, 20]);
}

#[test]
fn any_contradiction_is_one() {
    assert!(Contradictions::default().is_empty());
    let tension = Contradictions {
        tension: vec![1],
        ..Contradictions::default()
    };
    let overlap = Contradictions {
        overlap: vec![1],
        ..Contradictions::default()
    };
    let outside = Contradictions {
        outside: vec![(0.0, 1)],
        ..Contradictions::default()
    };
    assert!(
        ![tension, overlap, outside]
            .iter()
            .any(Contradictions::is_empty)
    );
}

/// Nodes 2, 4 and 6 are watched beside node 0 from the approach 1 on, and the first two join before 2. There gaps may overlap by
/// 100 · 10⁻⁵ · 2, and pressures times a compliance be as far below nothing.
#[test]
fn contradictions_at_the_end_are_found() -> Result<(), Error> {
    let far = 20.0;
    for (x, tension, overlap, outside) in [
        (1.9e-3, &[][..], &[][..], &[][..]),
        (2.1e-3, &[1], &[2], &[10, 8]),
    ] {
        let gaps = [
            0.0,
            far,
            1.5,
            far,
            2.0 + x,
            far,
            2.0 - x,
            far,
            2.0 - x,
            far,
            2.0 - 1.04 * x,
            far,
        ];
        let mut run = row::solved(&gaps, &[0], 1.0)?;
        let watched = Watched {
            nodes: vec![2, 4, 6],
            lines: vec![[1.0; 2]; 3],
            schur: DMatrix::from_diagonal_element(3, 3, 4.0),
            row_sums: vec![6.0; 3],
            horizon: 9.0,
        };
        let mut corrected = Corrected::new(None, true);
        corrected.last_span = 0.25;
        let found = corrected.go_to_end(&mut run, &scales(1e-5), &watched, &[0, 1], 1.0)?;
        assert_eq!(
            (&found.tension[..], &found.overlap[..]),
            (tension, overlap),
            "{x}"
        );
        // At the rate 1; node 10 has overlapped for longer.
        let nodes: Vec<usize> = found.outside.iter().map(|(_, node)| *node).collect();
        assert_eq!(nodes, outside);
        for ((time, _), expected) in found.outside.iter().zip([-1.04 * x, -x]) {
            assert!((time - expected).abs() < 1e-13, "{time} {expected}");
        }
        assert_eq!((run.front.approach(), corrected.rate_span), (2.0, 1.0));
        assert_eq!(run.contact.order(), [0, 2, 4]);
        assert!(run.field.belongs_to(&run.contact, 2.0));
    }
    Ok(())
}

/// Rates to 10⁻⁵ serve a tenth of a metre here; twice as far they have to be twice as exact, and no less than that is worth a
/// solution.
#[test]
fn rates_are_found_again_if_they_have_to_serve_much_further() -> Result<(), Error> {
    for (horizon, last, rate_span) in [
        (0.19, 9.0, 0.1),
        (0.21, 9.0, 0.21),
        // Without a horizon as far as the last node that touches.
        (f64::INFINITY, 0.19, 0.1),
        (f64::INFINITY, 0.21, 0.21),
        (f64::INFINITY, f64::INFINITY, 0.1),
    ] {
        let mut run = row::solved(&[0.0, 9.0, 1.25, 9.0, 1.5, 9.0], &[0], 1.0)?;
        let mut corrected = Corrected::new(None, true);
        corrected.rate_span = 0.1;
        let mut choice = Choice {
            watched: vec![(0.05, 2), (last, 4)],
            horizon,
            group: None,
        };
        corrected.refine(&mut run, &scales(1e-6), &mut choice, &[])?;
        assert_eq!(corrected.rate_span, rate_span, "{horizon} {last}");
        // Then nodes are chosen anew: all five.
        assert_eq!(choice.watched.len(), if rate_span > 0.1 { 5 } else { 2 });
    }
    Ok(())
}

/// Everything is known of the front after the beginning of a window, and found once.
#[test]
fn a_window_begins_with_a_solution() -> Result<(), Error> {
    let mut run = row::run(&[0.0, 9.0, 1.25, 9.0], Dense)?;
    run.contact.push(0)?;
    run.front.place_at(1.0);
    let mut corrected = Corrected::new(None, true);
    corrected.begin(&mut run)?;
    assert!(run.field.belongs_to(&run.contact, 1.0));
    assert_eq!(corrected.rate_span, f64::INFINITY);
    assert_eq!(corrected.ranked, Some((run.contact.revision(), 1.0)));
    let nodes: Vec<usize> = corrected.ranking.iter().map(|(_, node)| *node).collect();
    assert_eq!(nodes, [1, 2, 3]);
    // What belongs to the front is left alone.
    corrected.ranking.clear();
    corrected.begin(&mut run)?;
    assert!(corrected.ranking.is_empty());
    run.front.place_at(1.1);
    corrected.rate_span = 0.5;
    corrected.begin(&mut run)?;
    assert_eq!((corrected.ranking.len(), corrected.rate_span), (3, 0.5));
    Ok(())
}
