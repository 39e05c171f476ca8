//! States of contact: single loads, sweeps, fields, and the way back.

use asperity::fixed_load::FixedLoadBuilder;
use asperity::loading::{History, LoadingEnd};
use asperity::{
    ContactState, ContactTarget, Error, FixedLoadSolution, FixedLoadSolver, LoadingSolver,
    LoadingState,
};

use super::dense::{Dense, near};
use super::rows::Pressed;

/// Tolerance of single loads, of gaps in contact over the approach; scalars are off by little more.
const TOLERANCE: f64 = 1e-10;
const ALLOWED: f64 = 1e-8;

impl Pressed<'_> {
    fn solver(&self) -> FixedLoadBuilder<'_> {
        let builder = FixedLoadSolver::builder(&self.row.surface, &*self.row.kernel);
        let builder = builder.tolerance(TOLERANCE);
        match &self.row.hardness {
            Some(hardness) => builder.hardness_map(hardness),
            None => builder,
        }
    }

    pub(super) fn last(&self) -> LoadingState {
        *self.history.states().last().unwrap()
    }

    /// Some states of the path behind the first, at events and between two, and its last.
    pub(super) fn some(&self) -> Vec<LoadingState> {
        let states = self.history.states();
        let some = states.iter().skip(5).step_by(states.len() / 6);
        let parts = [0.11, 0.37, 0.79];
        let between = parts.map(|part| self.history.at_load(part * self.last().contact.load));
        some.chain(states.last()).copied().chain(between.into_iter().flatten()).collect()
    }

    /// A solution is the contact under its load, and the state of the path there.
    fn compare(&self, dense: &Dense, solution: &FixedLoadSolution, expected: &LoadingState) {
        let (name, state) = (self.row.name, &solution.contact);
        let (path, context) = (&expected.contact, format!("{name} at {} N", state.load));
        let pressure = solution.fields.pressure.as_slice();
        let truth = dense.scalars(pressure, state.approach, ALLOWED, &context);
        near(state.load, truth.load, ALLOWED * state.load, &context);
        assert_eq!(state.contact_nodes, path.contact_nodes, "{context}");
        let length = path.approach.abs().max(path.mean_gap);
        // What the path is off by without a factor, and the solution.
        let allowed = ALLOWED.max(self.row.tolerance());
        // A given mean gap has a load that is as uncertain as it is stiff.
        let stiffness = path.interfacial_stiffness.filter(|stiffness| stiffness.is_finite());
        let uncertain = 10.0 * TOLERANCE * length * stiffness.unwrap_or(0.0).abs();
        near(state.load, path.load, allowed * path.load + uncertain, &context);
        let scale = path.energy + path.plastic.map_or(0.0, |plastic| plastic.work);
        near(state.energy, path.energy, allowed * scale + uncertain * length, &context);
        near(state.mean_gap, path.mean_gap, allowed * length, &context);
        near(state.mean_gap, truth.mean_gap, ALLOWED * length, &context);
        // That of the approach of a distant point.
        let moved = path.contact_stiffness.map_or(0.0, |stiffness| uncertain / stiffness);
        near(state.approach, path.approach, allowed * length + moved, &context);
        if let Some(approach) = truth.approach {
            near(state.approach, approach, ALLOWED * length, &context);
        }
        if let (Some(found), Some(expected)) = (&state.plastic, &path.plastic) {
            assert_eq!(found.yielded_nodes, expected.yielded_nodes, "{context}");
            near(found.work, expected.work, allowed * path.energy, &context);
        }
        // Rates belong to the set, and in the load nothing cancels.
        for (found, expected) in rates(state).into_iter().zip(rates(path)) {
            assert_eq!(found.is_some(), expected.is_some(), "{context}");
            let (found, expected) = (found.unwrap_or(0.0), expected.unwrap_or(0.0));
            near(found, expected, allowed * expected.abs(), &context);
        }
        if state.contact_nodes > 0 {
            let sum = self.row.kernel.grid().cell_area() * solution.pressure_rate.sum();
            near(sum, 1.0, ALLOWED, &context);
        }
    }
}

/// Stiffnesses, and the plastic volume and work of each newton.
fn rates(state: &ContactState) -> [Option<f64>; 4] {
    let per_load = state.plastic.map(|plastic| (plastic.volume_per_load, plastic.work_per_load));
    let [volume, work] = [per_load.map(|pair| pair.0), per_load.map(|pair| pair.1)];
    [state.contact_stiffness, state.interfacial_stiffness, volume, work]
}

/// Loads all along the path, and behind full contact.
pub(super) fn fixed_load(pressed: &mut Pressed<'_>) -> Result<(), Error> {
    let dense = Dense::of(pressed.row);
    let mut solver = pressed.solver().build()?;
    let last = pressed.last().contact;
    let mut parts = vec![0.13, 0.52, 0.93];
    if last.contact_area_fraction == 1.0 && last.plastic.is_none() {
        parts.push(1.7);
    }
    for part in parts {
        let load = part * last.load;
        let solution = solver.solve(load)?;
        let expected = pressed.history.at(ContactTarget::Load(load))?;
        pressed.compare(&dense, &solution, &expected);
    }
    if last.contact_area_fraction == 1.0 && last.plastic.is_some() {
        // All nodes have yielded below it.
        let refused = solver.solve(last.load * (1.0 + 1e-12));
        assert!(matches!(refused, Err(Error::BeyondHardness { .. })), "{refused:?}");
    }
    Ok(())
}

/// Loads, and then an area, an approach and a mean gap.
pub(super) fn sweep(pressed: &mut Pressed<'_>) -> Result<(), Error> {
    let dense = Dense::of(pressed.row);
    let last = pressed.last().contact;
    let half = pressed.history.at(ContactTarget::Load(0.5 * last.load))?.contact;
    let mut targets = vec![
        ContactTarget::Load(0.07 * last.load),
        ContactTarget::Load(0.3 * last.load),
        ContactTarget::Load(0.9 * last.load),
        ContactTarget::Approach(half.approach),
    ];
    // A stiff coat bends away from the border, and the gap opens there.
    let mean_gap = 0.5 * (half.mean_gap + last.mean_gap);
    if mean_gap < pressed.history.states()[0].contact.mean_gap {
        targets.push(ContactTarget::MeanGap(mean_gap));
    }
    let mut solver = pressed.solver().build()?;
    for (solution, target) in solver.sweep(targets.clone()).zip(targets) {
        pressed.compare(&dense, &solution?, &pressed.history.at(target)?);
    }
    let area = 0.6 * last.contact_area_fraction;
    let solution = solver.sweep([ContactTarget::AreaFraction(area)]).next().unwrap()?;
    let nodes = pressed.row.kernel.grid().nodes_in(area)?;
    assert_eq!(solution.contact.contact_nodes, nodes, "{}", pressed.row.name);
    Ok(())
}

/// Pressures are the contact, and scalars and fields are theirs.
pub(super) fn fields(pressed: &mut Pressed<'_>) -> Result<(), Error> {
    let dense = Dense::of(pressed.row);
    // Pressures are solved for on the known contact, also without a factor, where the approach is an estimate.
    let allowed = 1e-9;
    for state in pressed.some() {
        let path = &mut pressed.path;
        let (contact, context) = (&state.contact, format!("{}, {}", pressed.row.name, state.step));
        let fields = path.fields_at(&state)?;
        let tolerance = pressed.row.tolerance();
        let truth =
            dense.scalars(fields.pressure.as_slice(), contact.approach, tolerance, &context);
        let length = contact.approach.abs().max(contact.mean_gap);
        near(contact.load, truth.load, allowed * contact.load, &context);
        let scale = contact.energy + contact.plastic.map_or(0.0, |plastic| plastic.work);
        near(contact.energy, truth.energy, tolerance * scale, &context);
        near(contact.mean_gap, truth.mean_gap, tolerance * length, &context);
        if let Some(approach) = truth.approach {
            near(contact.approach, approach, tolerance * length, &context);
        }
        for (found, expected) in fields.gap.iter().zip(&truth.gap) {
            near(*found, *expected, tolerance * length, &context);
        }
        for (found, expected) in fields.plastic_depth.iter().zip(&truth.depth) {
            near(*found, *expected, tolerance * length, &context);
        }
        let nodes = path.contact_map_at(&state)?.iter().filter(|is_in| **is_in).count();
        assert_eq!(nodes, contact.contact_nodes, "{context}");
    }
    Ok(())
}

/// The way back is elastic contact of what is left of the surface: the same pressure under the same load, and on the
/// way up to it no work but the elastic energy.
pub(super) fn unload(pressed: &mut Pressed<'_>) -> Result<(), Error> {
    let (name, last) = (pressed.row.name, pressed.last().contact);
    let there = pressed.path.fields()?.pressure;
    let residual = pressed.path.residual_surface()?;
    let kernel = &*pressed.row.kernel;
    let builder = LoadingSolver::builder(&residual, kernel).max_load(last.load);
    let mut back = builder.build()?;
    let states = back.by_ref().collect::<Result<History, _>>()?;
    // Full contact, where it ends, may come before.
    let end = match (back.end(), states.states().last()) {
        // On a stiff layer the last event may be where the other path ended, but for what that was estimated to.
        (Some(LoadingEnd::NoMoreEvents), Some(end)) => *end,
        _ => states.at(ContactTarget::Load(last.load))?,
    };
    let pressure = back.fields_at(&end)?.pressure;
    let gaps = asperity_testing::dense::initial_gap(residual.matrix());
    let dense = Dense::of(pressed.row).elastic(gaps);
    let tolerance = pressed.row.tolerance();
    let truth = dense.scalars(pressure.as_slice(), 0.0, 1e-9, name);
    near(truth.load, last.load, 1e-9 * last.load, name);
    let lost = last.plastic.map_or(0.0, |plastic| plastic.work);
    near(truth.energy, last.energy, tolerance * (last.energy + lost), name);
    for (found, expected) in pressure.iter().zip(&there) {
        near(*found, *expected, tolerance * there.max(), name);
    }
    // The work of the load: lost is what is plastic.
    let work = |states: &[LoadingState]| -> f64 {
        let pairs = states.windows(2).map(|pair| [&pair[0].contact, &pair[1].contact]);
        pairs.map(|[a, b]| 0.5 * (a.load + b.load) * (b.approach - a.approach)).sum()
    };
    let mut down = states.events().to_vec();
    down.push(end);
    let (up, down) = (work(pressed.history.states()), work(&down));
    near(up - down, lost, 10.0 * tolerance * up, name);
    Ok(())
}
