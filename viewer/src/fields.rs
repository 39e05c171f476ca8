//! Pressure and gap at some states spread over the path, in few levels.

use asperity::contact::ContactFields;
use asperity::loading::History;
use asperity::nalgebra::DMatrix;
use asperity::{ContactEvent, Error, Grid, LoadingPath};
use serde_json::{Value, json};

use crate::blob::deflated;

/// How many states have fields.
const STATES: usize = 24;
/// Levels of a field, and of how many states one is kept, from fine to coarse: the first that fits.
const FINENESS: [(f64, usize); 8] =
    [(126.0, 1), (62.0, 1), (44.0, 1), (30.0, 1), (22.0, 1), (14.0, 1), (14.0, 2), (6.0, 2)];
/// Letters that fields of all states may take together on any grid.
const LETTERS: usize = 250_000;
/// Letters that a page has at most for each node of a larger grid, if it can: 1 MB on 256 × 256 nodes.
const LETTERS_PER_NODE: usize = 15;

/// States of a path as places among all, at loads that grow as the cubes of whole numbers: first contact and full load
/// both have some.
fn chosen(history: &History) -> Vec<usize> {
    let states = history.states();
    let last = states.last().map_or(0.0, |state| state.contact.load);
    let up_to = |load: f64| states.partition_point(|state| state.contact.load <= load);
    let part = |i: usize| (i as f64 / STATES as f64).powi(3);
    let places = (1..STATES).map(|i| up_to(part(i) * last).saturating_sub(1));
    let mut places: Vec<usize> = places.chain(states.len().checked_sub(1)).collect();
    places.dedup();
    places
}

/// A field at a state: of each node a part of the greatest pressure in contact, or of the greatest gap out of it.
struct Field {
    place: usize,
    pressure: f64,
    gap: f64,
    in_contact: Vec<bool>,
    /// Its root, in parts of 65535.
    parts: Vec<u16>,
}

impl Field {
    fn of(
        place: usize,
        in_contact: Vec<bool>,
        ContactFields { pressure, gap, .. }: &ContactFields,
    ) -> Self {
        let greatest = |field: &DMatrix<f64>| field.iter().copied().fold(0.0, f64::max);
        let most = (greatest(pressure), greatest(gap));
        // Small ones matter more: by the root.
        let whole = |part: f64| {
            if part > 0.0 { (part.min(1.0).sqrt() * f64::from(u16::MAX)).round() as u16 } else { 0 }
        };
        let nodes = pressure.iter().zip(gap).zip(&in_contact);
        let parts =
            nodes.map(|((p, g), is_in)| whole(if *is_in { p / most.0 } else { g / most.1 }));
        Self { place, pressure: most.0, gap: most.1, parts: parts.collect(), in_contact }
    }

    fn levels(&self, levels: f64) -> Vec<u8> {
        let level = |part: &u16| (f64::from(*part) / f64::from(u16::MAX) * levels).round() as u8;
        self.parts.iter().map(level).collect()
    }
}

/// Pressure and gap at some states: one level a node, of the pressure in contact and of the gap out of it. The rest of
/// the page has `taken` letters. Returns the pressure of the last state as well.
pub(crate) fn of(
    grid: &Grid,
    history: &History,
    taken: usize,
    path: &mut LoadingPath,
) -> Result<(Value, Option<DMatrix<f64>>), Error> {
    let contact_at = contact_at(grid, history);
    let (mut found, mut last) = (Vec::new(), None);
    for place in chosen(history) {
        let Some(state) = history.states().get(place) else { continue };
        let fields = path.fields_at(state)?;
        found.push(Field::of(place, contact_at(place), &fields));
        last = Some(fields.pressure);
    }
    let room = LETTERS.max((LETTERS_PER_NODE * grid.nodes()).saturating_sub(taken));
    let mut page = Value::Null;
    for (levels, every) in FINENESS {
        // The last state is always among them.
        let kept = || found.iter().rev().step_by(every).rev();
        let code = |field: &Field| predicted(&field.levels(levels), &field.in_contact, grid.nx());
        let data = deflated(&kept().flat_map(code).collect::<Vec<u8>>());
        let fits = data.len() <= room;
        let states = kept().map(
            |field| json!({"event": field.place, "pressure": field.pressure, "gap": field.gap}),
        );
        page = json!({"levels": levels, "states": states.collect::<Vec<_>>(), "data": data});
        if fits {
            break;
        }
    }
    Ok((page, last))
}

/// Which nodes are in contact at a state, by its place among all.
fn contact_at<'a>(grid: &'a Grid, history: &'a History) -> impl Fn(usize) -> Vec<bool> + 'a {
    move |place| {
        let mut is_in = vec![false; grid.nodes()];
        for state in history.states().iter().take(place + 1) {
            let node = state.node.0 + grid.nx() * state.node.1;
            let Some(node) = is_in.get_mut(node) else { continue };
            *node = match state.event {
                ContactEvent::Touch => true,
                ContactEvent::Release => false,
                // A limit has the node of the last event, whatever that was.
                _ => continue,
            };
        }
        is_in
    }
}

/// Levels less what the neighbours before let expect: fields are smooth, and what is left deflates well.
fn predicted(levels: &[u8], is_in: &[bool], nx: usize) -> Vec<u8> {
    let at = |node: usize, back: usize| {
        node.checked_sub(back).filter(|&other| is_in[other] == is_in[node])
    };
    (0..levels.len())
        .map(|node| {
            let left = if node % nx > 0 { at(node, 1) } else { None };
            let (below, corner) =
                (at(node, nx), if node % nx > 0 { at(node, nx + 1) } else { None });
            let level = |place: Option<usize>| place.map(|place| i32::from(levels[place]));
            let expected = match (level(left), level(below), level(corner)) {
                (Some(left), Some(below), Some(corner)) => {
                    // Along a plane, but within what is beside.
                    (left + below - corner).clamp(left.min(below), left.max(below))
                }
                (Some(left), Some(below), None) => (left + below) / 2,
                (Some(one), None, _) | (None, Some(one), _) => one,
                (None, None, _) => 0,
            };
            levels[node].wrapping_sub(expected as u8)
        })
        .collect()
}

/// Heights in levels, likewise.
pub(crate) fn heights(heights: &DMatrix<f64>) -> Value {
    const HEIGHTS: f64 = 254.0;
    let (least, most) = (heights.min(), heights.max());
    let range = if most > least { most - least } else { 1.0 };
    let levels: Vec<u8> =
        heights.iter().map(|z| ((z - least) / range * HEIGHTS).round() as u8).collect();
    let all = vec![true; levels.len()];
    let data = deflated(&predicted(&levels, &all, heights.nrows()));
    json!({"least": least, "greatest": most, "levels": HEIGHTS, "data": data})
}

#[cfg(test)]
mod tests {
    use asperity::surface::HeightMap;
    use asperity::{Boussinesq, LoadingSolver, LoadingState};

    use super::*;

    /// A path may be asked for a load that it reaches just after a node has left.
    #[test]
    fn a_limit_changes_no_contact() -> Result<(), Error> {
        let grid = Grid::square(4, 1e-3)?;
        let kernel = Boussinesq::new(grid, 1e9)?;
        let surface = HeightMap::new(DMatrix::from_fn(4, 4, |ix, iy| (ix + 4 * iy) as f64 * 1e-7))?;
        let run =
            LoadingSolver::builder(&surface, &kernel).max_area_fraction(0.2).build()?.run()?;
        let contact = run.states().last().map(|state| state.contact);
        let events = [
            (ContactEvent::Touch, (1, 0)),
            (ContactEvent::Touch, (2, 0)),
            (ContactEvent::Yield, (1, 0)),
            (ContactEvent::Release, (2, 0)),
            (ContactEvent::Limit, (2, 0)),
        ];
        let history: History = (1..)
            .zip(events)
            .filter_map(|(step, (event, node))| {
                Some(LoadingState::new(step, event, node, contact?))
            })
            .collect();
        let nodes = |place| {
            let is_in = contact_at(&grid, &history)(place);
            (0..16).filter(|&node| is_in[node]).collect::<Vec<_>>()
        };
        for (place, expected) in
            [vec![1], vec![1, 2], vec![1, 2], vec![1], vec![1]].iter().enumerate()
        {
            assert_eq!(nodes(place), *expected, "after event {place}");
        }
        Ok(())
    }
}
