use super::super::tests::{by_gap, problem};
use super::*;

const CRITERIA: Criteria = Criteria { tolerance: 1e-10, max_iterations: 1000 };

/// A window at its end: 60 nodes were in contact and ten proposed, of which six have joined.
struct Window {
    problem: Problem,
    contact: ContactSequence,
    solutions: Solutions,
}

impl Window {
    fn new() -> Result<Self, Error> {
        let problem = problem()?;
        let nodes = by_gap(&problem);
        let mut window = Self {
            contact: ContactSequence::with_order(problem.grid(), nodes[..60].iter().copied())?,
            solutions: Solutions::new(&problem),
            problem,
        };
        window.ask(Asked::Advance(0.1), 60, 3.0)?;
        window.propose(&nodes[60..70])?;
        assert_eq!(window.solutions.sums.count(), 60);
        for &node in &nodes[60..66] {
            window.contact.push(node)?;
        }
        window.ask(Asked::Advance(0.1), 66, 3.0)?;
        Ok(window)
    }

    fn propose(&mut self, nodes: &[usize]) -> Result<(), Error> {
        let Self { problem, contact, solutions } = self;
        let proposed = solutions.propose(CRITERIA, problem, contact, [nodes, &[]], None);
        proposed.map(|_| ())
    }

    /// Asks for a solution, and checks that there is a value for each node: of rates where they are known.
    fn ask(&mut self, asked: Asked, count: usize, approach: f64) -> Result<(), Error> {
        let Self { problem, contact, solutions } = self;
        let (at, mut solved) = ((count, approach), Solved::default());
        match asked {
            Asked::Advance(span) => {
                let here = Behind::on(problem, contact, approach);
                solutions.advance(CRITERIA, &here, Aim::Span(span), &mut solved)?;
            }
            Asked::Apart => solutions.solve_apart(CRITERIA, problem, contact, at, &mut solved)?,
            Asked::Probe => {
                let mut part = contact.clone();
                part.truncate(count);
                let found =
                    solutions.probe(CRITERIA, &Behind::on(problem, &part, approach), 0.0)?;
                assert_eq!(found.displacement[0].len(), 240);
                return Ok(());
            }
        }
        let Solution { pressure, rate } = &solved.solution;
        assert_eq!([pressure.len(), rate.len()], [count; 2]);
        assert!(solved.displacement.iter().all(|field| field.len() == 240));
        Ok(())
    }
}

#[derive(Debug, Clone, Copy)]
enum Asked {
    Advance(f64),
    Apart,
    Probe,
}

/// The end of a window is an instant of it, and solutions inside are others; questions are none.
#[test]
fn solutions_inside_a_window_are_kept() -> Result<(), Error> {
    let mut window = Window::new()?;
    let solutions = &window.solutions;
    assert_eq!((solutions.count(), solutions.instants.len()), (66, 1));
    for (count, approach, asked, known) in [
        // Of the whole contact: as it is, more exactly, and elsewhere.
        (66, 3.0, Asked::Advance(0.1), 1),
        (66, 3.0, Asked::Apart, 1),
        (66, 2.5, Asked::Apart, 1),
        // Before the window, and inside it exactly: from nothing.
        (40, 3.0, Asked::Probe, 1),
        (63, 3.0, Asked::Apart, 1),
        // Where it begins nothing has joined.
        (60, 3.0, Asked::Probe, 1),
        (63, 3.0, Asked::Probe, 2),
        (64, 3.0, Asked::Probe, 3),
        (65, 3.0, Asked::Probe, 3),
        (66, 2.5, Asked::Probe, 3),
    ] {
        window.ask(asked, count, approach)?;
        let Window { solutions, .. } = &window;
        assert_eq!(solutions.instants.len(), known, "{count} {approach} {asked:?}");
        assert_eq!((solutions.count(), solutions.now.approach), (66, 3.0));
    }
    Ok(())
}

/// Back to where a window began, everything is as it was there; back to anywhere else, pressures are a start.
#[test]
fn windows_are_taken_back() -> Result<(), Error> {
    for (left, is_known) in [(60, true), (63, false), (50, false)] {
        let mut window = Window::new()?;
        window.contact.truncate(left);
        window.solutions.truncate(&window.contact);
        let solutions = &window.solutions;
        assert_eq!((solutions.count(), solutions.now.load.is_known()), (left, is_known));
        assert_eq!((solutions.instants.len(), solutions.before.is_none()), (0, true));
        // Row sums that were solved for are kept where the window began.
        assert_eq!(solutions.sums.count(), left);
        let pressures = solutions.now.load.pressure.iter().filter(|p| **p != 0.0).count();
        assert_eq!(pressures, left);
    }
    Ok(())
}

/// Row sums that were solved for at the end of a window go back with it.
#[test]
fn row_sums_are_taken_back() -> Result<(), Error> {
    let mut window = Window::new()?;
    let free = (0..240).find(|&node| !window.contact.contains(node));
    window.propose(&[free.unwrap_or_default()])?;
    assert_eq!(window.solutions.sums.count(), 66);
    window.contact.truncate(60);
    window.solutions.truncate(&window.contact);
    let solutions = &window.solutions;
    assert_eq!((solutions.count(), solutions.sums.count()), (60, 60));
    assert!(solutions.now.load.is_known());
    Ok(())
}

/// Pressures that displace the contact as they are told to, of 4 on a node alone and 1 on its neighbour.
#[test]
fn contacts_respond() -> Result<(), Error> {
    let problem = crate::test_chain::problem(&[0.0, 1.0, 2.0, 9.0])?;
    let contact = ContactSequence::with_order(problem.grid(), [2, 0])?;
    let mut solutions = Solutions::new(&problem);
    for rhs in [[8.0, 4.0], [-1.0, 0.0], [0.0; 2]] {
        let of = |node: usize| rhs[node / 2];
        let found = solutions.respond(CRITERIA, &problem, &contact, of)?;
        let [p0, p2] = rhs.map(|u| u / 4.0);
        let expected = [p0, 0.0, p2, 0.0, rhs[0], p0 + p2, rhs[1], p2];
        let found = [found.pressure, found.displacement].concat();
        assert_eq!(found.len(), 8);
        for (found, expected) in found.into_iter().zip(expected) {
            // The tolerance of residuals, of up to 8.
            assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        }
    }
    Ok(())
}

/// A solution of another updater is a start: pressures and rates of the nodes in contact, of which nothing else is
/// known.
#[test]
fn solutions_are_taken_over() -> Result<(), Error> {
    let problem = crate::test_chain::problem(&[0.0, 1.0, 2.0])?;
    let contact = ContactSequence::with_order(problem.grid(), [2, 0])?;
    let mut solutions = Solutions::new(&problem);
    let solution = Solution { pressure: vec![5.0, 6.0], rate: vec![7.0, 8.0] };
    solutions.take_over(&contact, 3.0, &solution);
    let now = &solutions.now;
    assert_eq!((solutions.count(), now.approach, now.serves), (2, 3.0, 0.0));
    assert_eq!(now.load.pressure, [6.0, 0.0, 5.0]);
    assert_eq!(now.rate.pressure, [8.0, 0.0, 7.0]);
    assert!(!now.load.is_known() && !now.rate.is_known());
    assert_eq!((solutions.sums.count(), solutions.grid()), (2, problem.grid()));
    Ok(())
}
