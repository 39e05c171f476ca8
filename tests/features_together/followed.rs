//! What follows from a path: patches, leaks, slip, creep, conductances and tables.

use asperity::bed::Bed;
use asperity::creep::{Creep, PiecewiseLinear, Prony, Relaxation};
use asperity::joint::{Conduction, InterfaceRow, InterfaceTable};
use asperity::leak::Seal;
use asperity::patches::{Connectivity, PatchHistory, Patches, Percolation};
use asperity::slip::{Friction, PartialSlip, SlipZone};
use asperity::surface::Axis;
use asperity::{ContactEvent, Error, Grid, JointError, LoadingSolver, LoadingState};
use nalgebra::{DMatrix, DVector};

use super::dense::{Dense, near};
use super::rows::{Any, E_STAR, Pressed, Row};

/// Neighbours of a node through the sides of its cell, and around borders that repeat; not around that between the ends
/// of `cut`.
fn neighbours(
    (nx, ny): (usize, usize),
    node: usize,
    repeats: [bool; 2],
    cut: Option<Axis>,
) -> Vec<usize> {
    let (ix, iy) = (node % nx, node / nx);
    let around = [repeats[0] && cut != Some(Axis::X), repeats[1] && cut != Some(Axis::Y)];
    let mut found = Vec::new();
    for step in [1, nx - 1] {
        if (step == 1 && ix + 1 < nx) || (step != 1 && ix > 0) || around[0] {
            found.push((ix + step) % nx + nx * iy);
        }
    }
    for step in [1, ny - 1] {
        if (step == 1 && iy + 1 < ny) || (step != 1 && iy > 0) || around[1] {
            found.push(ix + nx * ((iy + step) % ny));
        }
    }
    found
}

/// A map whose patches are filled.
struct Flood<'a> {
    map: &'a DMatrix<bool>,
    repeats: [bool; 2],
    cut: Option<Axis>,
}

impl Flood<'_> {
    /// Length of the sides between nodes in contact and others, and of those at a border that does not repeat.
    fn perimeter(&self, grid: &Grid) -> f64 {
        let (nx, ny) = self.map.shape();
        let nodes = (0..self.map.len()).filter(|&node| self.map.as_slice()[node]);
        let sides = nodes.map(|node| {
            let others = neighbours((nx, ny), node, self.repeats, None);
            let inner = others
                .iter()
                .filter(|&&other| !self.map.as_slice()[other])
                .map(|other| if other / nx == node / nx { grid.dy() } else { grid.dx() });
            let (ix, iy) = (node % nx, node / nx);
            let ends = |at: usize, n: usize| usize::from(at == 0) + usize::from(at + 1 == n);
            let [along_y, along_x] = [(ix, nx, 0), (iy, ny, 1)]
                .map(|(at, n, k)| if self.repeats[k] { 0 } else { ends(at, n) });
            inner.sum::<f64>() + along_y as f64 * grid.dy() + along_x as f64 * grid.dx()
        });
        sides.sum()
    }

    /// All nodes that hang together with some.
    fn from(&self, mut waiting: Vec<usize>) -> Vec<bool> {
        let mut reached = vec![false; self.map.len()];
        waiting.retain(|&node| self.map.as_slice()[node]);
        waiting.iter().for_each(|&node| reached[node] = true);
        while let Some(node) = waiting.pop() {
            for other in neighbours(self.map.shape(), node, self.repeats, self.cut) {
                if self.map.as_slice()[other] && !std::mem::replace(&mut reached[other], true) {
                    waiting.push(other);
                }
            }
        }
        reached
    }

    /// Number of nodes of each patch.
    fn patches(&self) -> Vec<usize> {
        let mut left = self.map.clone();
        let mut sizes = Vec::new();
        while let Some(node) = left.iter().position(|is_in| *is_in) {
            let patch = self.from(vec![node]);
            sizes.push(patch.iter().filter(|is_in| **is_in).count());
            left.iter_mut().zip(patch).for_each(|(left, is_in)| *left &= !is_in);
        }
        sizes
    }

    /// Nodes at both ends along the axis of the cut.
    fn ends(&self) -> [Vec<usize>; 2] {
        let (nx, ny) = self.map.shape();
        match self.cut {
            Some(Axis::X) => [0, nx - 1].map(|ix| (0..ny).map(|iy| ix + nx * iy).collect()),
            _ => [0, ny - 1].map(|iy| (0..nx).map(|ix| ix + nx * iy).collect()),
        }
    }

    /// Whether one leads from end to end.
    fn leads_through(&self) -> bool {
        let [first, last] = self.ends();
        let reached = self.from(first);
        last.iter().any(|&node| reached[node])
    }
}

/// Patches, and from end to end contact and channels, against filling every map; with whatever ends.
pub(super) fn patches(pressed: &mut Pressed<'_>) -> Result<(), Error> {
    let (name, grid) = (pressed.row.name, pressed.path.grid());
    let boundary = pressed.row.kernel.boundary();
    let repeats = boundary.repeats();
    // Of single states, whatever the path.
    for state in pressed.some() {
        let map = pressed.path.contact_map_at(&state)?;
        let mut sizes = Flood { map: &map, repeats, cut: None }.patches();
        let found = Patches::new(&map, &grid, boundary, Connectivity::Four)?;
        let mut found: Vec<usize> = found.patches().iter().map(|patch| patch.nodes).collect();
        sizes.sort_unstable();
        found.sort_unstable();
        assert_eq!(found, sizes, "{name}, state {}", state.step);
    }
    let contact = pressed.history.contact_sequence(grid)?;
    for state in PatchHistory::new(&contact, boundary, Connectivity::Four) {
        let map = contact.map_at(state.step);
        let flood = Flood { map: &map, repeats, cut: None };
        let (sizes, length) = (flood.patches(), flood.perimeter(&grid));
        near(state.perimeter.length(&grid), length, 1e-12 * length, name);
        let expected = (sizes.len(), sizes.iter().max().copied());
        assert_eq!((state.patches, Some(state.largest)), expected, "{name}, {}", state.step);
    }
    let first = |axis, of_contact: bool| {
        (1..=contact.len()).find(|&nodes| {
            let map = contact.map_at(nodes);
            let open = map.map(|is_in| !is_in);
            let map = if of_contact { &map } else { &open };
            Flood { map, repeats, cut: Some(axis) }.leads_through() == of_contact
        })
    };
    let found = Percolation::of(&contact, boundary, Connectivity::Four);
    let found = [found.contact_x, found.contact_y, found.seal_x, found.seal_y];
    let expected =
        [first(Axis::X, true), first(Axis::Y, true), first(Axis::X, false), first(Axis::Y, false)];
    assert_eq!(found, expected, "{name}");
    Ok(())
}

/// The leak rate of a gap by a dense factor, as the power that is lost over the pressure drop: errors of pressures
/// enter by their square.
fn dense_leak(
    gap: &DMatrix<f64>,
    contact: &DMatrix<bool>,
    (cell, repeats, axis): ([f64; 2], [bool; 2], Axis),
    seal: &Seal,
) -> f64 {
    // What is less closes as well.
    let least = 1e-12 * gap.max();
    let open = contact.zip_map(gap, |is_in, gap| !is_in && gap > least);
    let flood = Flood { map: &open, repeats, cut: Some(axis) };
    let [inlet, outlet] = flood.ends();
    let reached = [flood.from(inlet.clone()), flood.from(outlet.clone())];
    let nodes: Vec<usize> = (0..gap.len()).filter(|&k| reached[0][k] && reached[1][k]).collect();
    if nodes.is_empty() {
        return 0.0;
    }
    let nx = gap.nrows();
    let along = match axis {
        Axis::X => cell[1] / cell[0],
        _ => cell[0] / cell[1],
    };
    // Half a cell, from its node to a face.
    let half = |node: usize, is_along: bool| {
        let shape = if is_along { along } else { 1.0 / along };
        2.0 * shape * gap.as_slice()[node].powi(3) / (12.0 * seal.viscosity())
    };
    let mut links: Vec<(usize, usize, f64)> = Vec::new();
    for (i, &node) in nodes.iter().enumerate() {
        for other in neighbours(gap.shape(), node, repeats, Some(axis)) {
            if let Ok(j) = nodes.binary_search(&other)
                && j > i
            {
                let is_x = node / nx == other / nx;
                let [a, b] = [node, other].map(|node| half(node, is_x == (axis == Axis::X)));
                links.push((i, j, a * b / (a + b)));
            }
        }
    }
    let ends = [(inlet, seal.pressure_drop()), (outlet, 0.0)];
    let mut matrix = DMatrix::zeros(nodes.len(), nodes.len());
    let mut rhs = DVector::zeros(nodes.len());
    for &(i, j, g) in &links {
        matrix[(i, i)] += g;
        matrix[(j, j)] += g;
        matrix[(i, j)] -= g;
        matrix[(j, i)] -= g;
    }
    for (end, pressure) in &ends {
        for i in end.iter().filter_map(|node| nodes.binary_search(node).ok()) {
            matrix[(i, i)] += half(nodes[i], true);
            rhs[i] += half(nodes[i], true) * pressure;
        }
    }
    let pressure: DVector<f64> = matrix.lu().solve(&rhs).unwrap();
    let mut power: f64 = links
        .iter()
        .map(|&(i, j, g): &(usize, usize, f64)| g * f64::powi(pressure[i] - pressure[j], 2))
        .sum();
    for (end, given) in &ends {
        for i in end.iter().filter_map(|node| nodes.binary_search(node).ok()) {
            power += half(nodes[i], true) * f64::powi(pressure[i] - given, 2);
        }
    }
    power / seal.pressure_drop()
}

/// Leak rates along both axes, and the state at which the last channel closes.
pub(super) fn leak(pressed: &mut Pressed<'_>) -> Result<(), Error> {
    let (name, grid) = (pressed.row.name, pressed.path.grid());
    let boundary = pressed.row.kernel.boundary();
    let repeats = boundary.repeats();
    let mut rates = 0;
    for axis in [Axis::X, Axis::Y] {
        let seal = Seal::new(1e-3, 1e6, axis)?;
        for state in pressed.some() {
            let gap = pressed.path.fields_at(&state)?.gap;
            let contact = pressed.path.contact_map_at(&state)?;
            let found = seal.leak_at(&mut pressed.path, &state)?.leak_rate;
            let on = ([grid.dx(), grid.dy()], repeats, axis);
            let expected = dense_leak(&gap, &contact, on, &seal);
            rates += usize::from(expected > 0.0);
            // Conductances of twelve decades leave 10⁻⁴ of a pressure by elimination, and of a power its square.
            near(found, expected, 1e-8 * expected, &format!("{name}, state {}", state.step));
        }
        let history = pressed.history.clone();
        let closing = seal.curve(&mut pressed.path, &history, 4)?.closing;
        let is_open = |state: &LoadingState| {
            let open = pressed.path.contact_map_at(state).unwrap().map(|is_in| !is_in);
            Flood { map: &open, repeats, cut: Some(axis) }.leads_through()
        };
        let expected = history.states().iter().find(|state| !is_open(state));
        // A channel may open again where nodes leave.
        let expected = expected.filter(|_| !pressed.leaves());
        assert_eq!(closing.as_ref(), expected, "{name}");
    }
    assert!(rates > 3, "{name}: {rates}");
    Ok(())
}

/// Coulomb's law at every node under a tangential load that grows: it holds at no other traction.
pub(super) fn slip(pressed: &mut Pressed<'_>) -> Result<(), Error> {
    let name = pressed.row.name;
    let bed = Bed::new(&pressed.history)?;
    let friction = Friction::new(0.3, 1.2)?;
    // Behind full contact too.
    let part = if bed.is_full() { 1.2 } else { 0.9 };
    let joint = PartialSlip::new(&bed, part * bed.last_load(), friction)?;
    let dense = Dense::of(pressed.row);
    let path = &mut pressed.path;
    let preload = joint.preload();
    let pressure = path.fields_at(&bed.path_state(preload.load)?)?.pressure;
    let allowed = pressed.row.tolerance() * joint.sliding_displacement();
    let mut slipping = 0;
    for part in [0.15, 0.5, 0.95] {
        let context = format!("{name}, {part} of sliding");
        let force = part * joint.sliding_load();
        let traction = joint.traction(path, force)?;
        let zones = joint.zones(path, force)?;
        let slip = joint.slip(path, force)?;
        let mut shift = 1.2 * &dense.matrix * DVector::from_column_slice(traction.as_slice());
        if dense.about_mean {
            shift.add_scalar_mut(-shift.mean());
        }
        let state = joint.monotone(force)?;
        let sum = traction.sum() * path.grid().cell_area();
        near(sum, force, pressed.row.tolerance() * force, &context);
        let mut counts = [0, 0];
        for node in 0..shift.len() {
            let [q, p, s] = [&traction, &pressure, &slip].map(|field| field.as_slice()[node]);
            let left = state.displacement - shift[node];
            let small = pressed.row.tolerance() * pressure.max();
            match zones.as_slice()[node] {
                SlipZone::Open => assert_eq!((q, p), (0.0, 0.0), "{context}"),
                SlipZone::Stick => {
                    counts[0] += 1;
                    near(left, 0.0, allowed, &context);
                    assert!(q.abs() <= 0.3 * p + small && s == 0.0, "{context}");
                }
                SlipZone::Slip => {
                    counts[1] += 1;
                    near(q, 0.3 * p, small, &context);
                    near(left, s, allowed, &context);
                    assert!(s >= 0.0, "{context}");
                }
                other => panic!("{other:?}"),
            }
        }
        assert_eq!([state.stick_nodes, state.slipping_nodes], counts, "{context}");
        slipping += counts[1];
    }
    // In full contact all may stick.
    assert!(slipping > 0, "{name}");
    Ok(())
}

/// Share of the modulus that relaxes, and its time.
const SHARE: f64 = 0.6;
const TIME: f64 = 2.0;

/// A load that is held: the contact is the elastic one under W J(t)/J(0), and in the end that of a body of the modulus
/// that is left.
pub(super) fn creep(pressed: &mut Pressed<'_>) -> Result<(), Error> {
    let name = pressed.row.name;
    let bed = Bed::new(&pressed.history)?;
    let prony = Prony::shares(&[(TIME, SHARE)])?;
    // Behind full contact too.
    let load = if bed.is_full() { 0.5 } else { 0.35 } * bed.last_load();
    let held = Creep::new(&bed, &prony, &PiecewiseLinear::step(load)?)?;
    let dense = Dense::of(pressed.row);
    let length = bed.approaches().last().copied().unwrap_or(0.0);
    let allowed = pressed.row.tolerance() * length;
    for time in [0.0, 0.7, 5.0, 1e9] {
        let context = format!("{name} at {time} s");
        // The compliance of a standard solid.
        let left = 1.0 - SHARE;
        let grown = (1.0 - SHARE * (-time * left / TIME).exp()) / left;
        let state = held.at(time)?;
        near(state.effective_load, load * grown, 1e-12 * load, &context);
        let there = held.path_state(time)?;
        let elastic = pressed.path.fields_at(&there)?.pressure;
        let tolerance = pressed.row.tolerance();
        let truth = dense.scalars(elastic.as_slice(), state.approach, tolerance, &context);
        near(truth.load, load * grown, 1e-9 * load, &context);
        near(state.approach, truth.approach.unwrap(), allowed, &context);
        near(state.mean_gap, truth.mean_gap, allowed, &context);
        let pressure = held.pressure(time, 10_000)?.pressure(&bed, &mut pressed.path)?;
        let sum = pressure.sum() * pressed.path.grid().cell_area();
        near(sum, load, pressed.row.tolerance() * load, &context);
        let scale = elastic.max();
        let in_contact = |node: usize| elastic.as_slice()[node] > 0.0;
        for (node, p) in pressure.iter().enumerate() {
            assert!(*p >= -pressed.row.tolerance() * scale, "{context}");
            assert!(in_contact(node) || *p == 0.0, "{context}");
            if time == 0.0 || time == 1e9 {
                let modulus = if time == 0.0 { 1.0 } else { left };
                near(*p, modulus * elastic[node], tolerance * scale, &context);
            }
        }
    }
    relaxation(pressed.row, &mut pressed.path, &bed, &prony)
}

/// An approach that is held: the contact is the elastic one there, and its pressure relaxes with the modulus.
fn relaxation(
    row: &Row,
    path: &mut LoadingSolver<Any>,
    bed: &Bed<'_>,
    prony: &Prony,
) -> Result<(), Error> {
    let name = row.name;
    let load = 0.6 * bed.last_load();
    let there = bed.path_state(load)?;
    let held = Relaxation::new(bed, prony, &PiecewiseLinear::step(there.contact.approach)?)?;
    let elastic = path.fields_at(&there)?.pressure;
    let tolerance = row.tolerance();
    Dense::of(row).scalars(elastic.as_slice(), there.contact.approach, tolerance, name);
    for time in [0.0, 0.7, 5.0, 1e9] {
        let modulus = 1.0 - SHARE + SHARE * f64::exp(-time / TIME);
        near(held.at(time)?.load, modulus * load, tolerance * load, name);
        let pressure = held.pressure(time, 10_000)?.pressure(bed, path)?;
        for (found, elastic_pressure) in pressure.iter().zip(&elastic) {
            near(*found, modulus * elastic_pressure, tolerance * elastic.max(), name);
        }
        let gap = held.gap(time, path)?;
        for (found, elastic_gap) in gap.iter().zip(&path.fields_at(&there)?.gap) {
            near(*found, *elastic_gap, tolerance * there.contact.approach, name);
        }
    }
    Ok(())
}

const RESISTIVITY: f64 = 0.04;

impl Pressed<'_> {
    /// Whether nodes leave the contact.
    fn leaves(&self) -> bool {
        self.history.states().iter().any(|state| state.event == ContactEvent::Release)
    }

    /// The states with what conducts.
    fn conducting(&self) -> Result<asperity::loading::History, Error> {
        let mut states = self.history.states().to_vec();
        self.path.add_unloading_stiffness(&mut states)?;
        let history: asperity::loading::History = states.into_iter().collect();
        Ok(history.on(self.history.layering()))
    }
}

/// 2K/(ρE*) with the stiffness of all nodes in contact, by a dense factor.
pub(super) fn conductance(pressed: &mut Pressed<'_>) -> Result<(), Error> {
    let name = pressed.row.name;
    let history = pressed.conducting()?;
    let body = history.layering();
    // Of one that repeats along one side the approach is counted from where one likes.
    let in_a_row = pressed.row.kernel.boundary().repeats() != [false; 2];
    let heat = Conduction::thermal(E_STAR, RESISTIVITY)?;
    let dense = Dense::of(pressed.row);
    let events = history.states().iter().filter(|state| state.event == ContactEvent::Touch);
    for state in events.skip(3).step_by(7) {
        let context = format!("{name}, state {}", state.step);
        let [contact, interfacial] = dense.stiffness(&pressed.path.contact_map_at(state)?);
        let scale = 2.0 / (RESISTIVITY * E_STAR);
        let tolerance = pressed.row.tolerance();
        for (found, stiffness) in [
            (heat.of(&state.contact, body)?, contact.filter(|_| !in_a_row).or(interfacial)),
            (heat.of_interface(&state.contact, body)?, interfacial),
        ] {
            let expected = scale * stiffness.unwrap();
            near(found.unwrap(), expected, tolerance * expected, &context);
        }
    }
    Ok(())
}

/// A column of a table.
type Column = fn(&InterfaceRow) -> f64;

/// Linear interpolation as a finite element program does it.
fn between(rows: &[InterfaceRow], x: Column, y: Column, at: f64) -> f64 {
    let after = rows.partition_point(|row| x(row) < at).clamp(1, rows.len() - 1);
    let (a, b) = (&rows[after - 1], &rows[after]);
    y(a) + (y(b) - y(a)) * ((at - x(a)) / (x(b) - x(a)))
}

/// Every state of the path to the tolerance of the table: pressures on all bodies, and conductances and tangential
/// stiffnesses by dense factors.
pub(super) fn table(pressed: &mut Pressed<'_>) -> Result<(), Error> {
    const TOLERANCE: f64 = 0.01;
    let name = pressed.row.name;
    let history = pressed.conducting()?;
    let states = history.states();
    let (area, unloaded) = (pressed.path.grid().nominal_area(), states[0].contact.mean_gap);
    let plain = match InterfaceTable::builder(&history).tolerance(TOLERANCE).build() {
        Ok(table) => table.rows().to_vec(),
        // Where nodes leave the gap may open under a greater load.
        Err(Error::Joint(JointError::NoFunction { .. })) if pressed.leaves() => Vec::new(),
        Err(error) => return Err(error),
    };
    let greatest = plain.last().map_or(0.0, |row| row.pressure);
    for state in states.iter().filter(|_| !plain.is_empty()) {
        let pressure = state.contact.load / area;
        if pressure > greatest {
            // In full contact it has ended.
            assert_eq!(state.contact.contact_area_fraction, 1.0, "{name}");
            continue;
        }
        let overclosure = unloaded - state.contact.mean_gap;
        let found = between(&plain, |row| row.overclosure, |row| row.pressure, overclosure);
        let scale = pressure.max(1e-3 * greatest);
        // Rows are raised by 10⁻¹¹.
        near(found, pressure, TOLERANCE * (1.0 + 1e-6) * scale, name);
    }
    let heat = Conduction::thermal(E_STAR, RESISTIVITY)?;
    let builder = InterfaceTable::builder(&history).tolerance(TOLERANCE).conduction(heat);
    let table = builder.friction(0.25, 1.2).build()?;
    let dense = Dense::of(pressed.row);
    let events = states.iter().filter(|state| state.event == ContactEvent::Touch);
    for state in events.skip(3).step_by(7) {
        let contact = &state.contact;
        if contact.contact_area_fraction == 1.0 || contact.interfacial_stiffness == Some(0.0) {
            continue;
        }
        let [_, stiffness] = dense.stiffness(&pressed.path.contact_map_at(state)?);
        let stiffness = stiffness.unwrap() / area;
        let columns: [(Column, f64); 3] = [
            (|row| row.conductance.unwrap(), 2.0 * stiffness / (RESISTIVITY * E_STAR)),
            (|row| row.tangential_stiffness.unwrap(), stiffness / 1.2),
            (|row| row.slip_limit.unwrap(), 0.25 * contact.load / area),
        ];
        for (column, expected) in columns {
            let found = between(table.rows(), |row| row.pressure, column, contact.load / area);
            let allowed = (TOLERANCE * (1.0 + 1e-6) + pressed.row.tolerance()) * expected;
            near(found, expected, allowed, &format!("{name}, state {}", state.step));
        }
    }
    Ok(())
}
