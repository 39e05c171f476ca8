use super::super::tests::problem;
use super::*;

const CRITERIA: Criteria = Criteria {
    tolerance: 1e-10,
    max_iterations: 1000,
};

/// A window at its end: 60 nodes were in contact and ten watched, of which six have joined.
struct Window {
    problem: Problem,
    contact: ContactSequence,
    state: State,
    solution: Solution,
}

impl Window {
    fn new() -> Result<Self, Error> {
        let problem = problem()?;
        let gap = problem.initial_gap();
        let mut nodes: Vec<usize> = (0..240).collect();
        nodes.sort_by(|a, b| gap[*a].total_cmp(&gap[*b]));
        let mut window = Self {
            contact: ContactSequence::with_order(problem.grid(), nodes[..60].iter().copied())?,
            state: State::new(&problem),
            solution: Solution::default(),
            problem,
        };
        window.solve(60, 3.0, 0.1)?;
        let Self {
            problem,
            contact,
            state,
            ..
        } = &mut window;
        let mut schur = Schur::default();
        state.watch(CRITERIA, problem, contact, &nodes[60..70], &mut schur)?;
        assert_eq!(state.sums.count(), 60);
        for &node in &nodes[60..66] {
            contact.push(node)?;
        }
        window.solve(66, 3.0, 0.1)?;
        Ok(window)
    }

    fn solve(&mut self, count: usize, approach: f64, span: f64) -> Result<(), Error> {
        let Self {
            problem,
            contact,
            state,
            solution,
        } = self;
        let request = SolveRequest {
            span,
            ..SolveRequest::exact(count, approach)
        };
        state.solve(CRITERIA, problem, contact, request, solution)
    }
}

/// The end of a window is an instant of it, and solutions inside are others; questions are none.
#[test]
fn solutions_inside_a_window_are_kept() -> Result<(), Error> {
    let mut window = Window::new()?;
    assert_eq!((window.state.count(), window.state.instants.len()), (66, 1));
    for (count, approach, span, known) in [
        // Of the whole contact: as it is, more exactly, and elsewhere.
        (66, 3.0, 0.1, 1),
        (66, 3.0, f64::INFINITY, 1),
        (66, 2.5, 0.0, 1),
        // Before the window, and inside it exactly: from nothing.
        (40, 3.0, 0.0, 1),
        (63, 3.0, f64::INFINITY, 1),
        // Where it begins nothing has joined.
        (60, 3.0, 0.0, 1),
        (63, 3.0, 0.0, 2),
        (64, 3.0, 0.0, 3),
        (65, 3.0, 0.0, 3),
    ] {
        window.solve(count, approach, span)?;
        assert_eq!(
            window.state.instants.len(),
            known,
            "{count} {approach} {span}"
        );
        assert_eq!((window.state.count(), window.state.now.approach), (66, 3.0));
        assert_eq!(window.solution.pressure.len(), count);
        // No rate is solved for that is not asked for.
        assert_eq!(window.solution.displacement[1].is_empty(), span == 0.0);
    }
    Ok(())
}

/// Back to where a window began, everything is as it was there; back to anywhere else, pressures are a start.
#[test]
fn windows_are_taken_back() -> Result<(), Error> {
    for (left, is_known) in [(60, true), (63, false), (50, false)] {
        let mut window = Window::new()?;
        window.contact.truncate(left);
        window.state.truncate(&window.contact);
        let state = &window.state;
        assert_eq!((state.count(), state.now.load.is_known()), (left, is_known));
        assert_eq!((state.instants.len(), state.before.is_none()), (0, true));
        // Row sums that were solved for are kept where the window began.
        assert_eq!(state.sums.count(), left);
        let pressures = state
            .now
            .load
            .pressure
            .iter()
            .filter(|p| **p != 0.0)
            .count();
        assert_eq!(pressures, left);
    }
    Ok(())
}

/// Row sums that were solved for at the end of a window go back with it.
#[test]
fn row_sums_are_taken_back() -> Result<(), Error> {
    let mut window = Window::new()?;
    let Window {
        problem,
        contact,
        state,
        ..
    } = &mut window;
    let watched = (0..240).find(|&node| !contact.contains(node));
    let watched: Vec<usize> = watched.into_iter().collect();
    state.watch(CRITERIA, problem, contact, &watched, &mut Schur::default())?;
    assert_eq!(state.sums.count(), 66);
    contact.truncate(60);
    state.truncate(contact);
    assert_eq!((state.count(), state.sums.count()), (60, 60));
    assert!(state.now.load.is_known());
    Ok(())
}

/// A solution of another updater is a start: pressures and rates of the nodes in contact, of which nothing else is known.
#[test]
fn solutions_are_taken_over() -> Result<(), Error> {
    let problem = crate::test_chain::problem(&[0.0, 1.0, 2.0])?;
    let contact = ContactSequence::with_order(problem.grid(), [2, 0])?;
    let mut state = State::new(&problem);
    let solution = Solution {
        pressure: vec![5.0, 6.0],
        rate: vec![7.0, 8.0],
        ..Solution::default()
    };
    state.take_over(&contact, 3.0, &solution);
    let now = &state.now;
    assert_eq!((state.count(), now.approach, now.span), (2, 3.0, 0.0));
    assert_eq!(now.load.pressure, [6.0, 0.0, 5.0]);
    assert_eq!(now.rate.pressure, [8.0, 0.0, 7.0]);
    assert!(!now.load.is_known() && !now.rate.is_known());
    assert_eq!((state.sums.count(), state.grid()), (2, problem.grid()));
    Ok(())
}
