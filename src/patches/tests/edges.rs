//! Edges of contacts that grow and shrink, and constrictions, against flood fills.

use nalgebra::DMatrix;
use proptest::prelude::*;

use super::super::*;
use super::{Case, cases};
use crate::loading::ContactEvent;
use crate::surface::Axis;
use crate::{Boundary, Error, Grid};

/// What a flood fill counts of the edges of the nodes in contact, as an edge that was followed does.
fn counted(case: &Case, contact: &[usize]) -> Result<(Perimeter, f64), Error> {
    let grid = case.grid()?;
    let mut picture = case.picture(0);
    for &node in contact {
        picture.is_in[node] = true;
    }
    let [along_x, along_y, border_along_x, border_along_y] = picture.sides(contact.iter().copied());
    let perimeter = Perimeter { along_x, along_y, border_along_x, border_along_y };
    let area = contact.len() as f64 - Perimeter::AREA_CORRECTION * (along_x + along_y) as f64;
    Ok((perimeter, area * grid.cell_area()))
}

proptest! {
    /// All nodes of the case join, and `leaving` of them leave again on the way.
    #[test]
    fn an_edge_follows_nodes_that_join_and_leave(
        case in cases(),
        leaving in prop::collection::vec(any::<prop::sample::Index>(), 0..20),
    ) {
        let grid = case.grid()?;
        let mut edge = ContactEdge::new(grid, case.boundary);
        let mut contact: Vec<usize> = Vec::new();
        let mut leaving = leaving.iter();
        for &node in &case.order {
            let at = grid.coordinates(node);
            edge.follow(ContactEvent::Touch, at)?;
            contact.push(node);
            let again = edge.follow(ContactEvent::Touch, at);
            let is_refused = matches!(again, Err(Error::AlreadyInContact { .. }));
            prop_assert!(is_refused);
            if node % 3 == 0 && let Some(which) = leaving.next() {
                let leaves = contact.swap_remove(which.index(contact.len()));
                let at = grid.coordinates(leaves);
                edge.follow(ContactEvent::Release, at)?;
                let again = edge.follow(ContactEvent::Release, at);
                let is_refused = matches!(again, Err(Error::NotInContact { .. }));
                prop_assert!(is_refused);
            }
            edge.follow(ContactEvent::Limit, at)?;
            let (perimeter, area) = counted(&case, &contact)?;
            prop_assert_eq!(edge.perimeter(), perimeter);
            prop_assert_eq!(edge.contact_nodes(), contact.len());
            prop_assert!((edge.corrected_area() - area).abs() <= 1e-14 * area);
        }
        let (nx, ny) = case.shape;
        let map = DMatrix::from_fn(nx, ny, |ix, iy| contact.contains(&(ix + nx * iy)));
        prop_assert_eq!(ContactEdge::of(&map, grid, case.boundary)?.perimeter(), edge.perimeter());
    }

    /// The greatest gap of which a channel leads all the way through nodes that have no smaller one.
    #[test]
    fn a_constriction_is_where_the_last_channel_would_close(
        case in cases(),
        gaps in prop::collection::vec(0_u8..12, 64),
    ) {
        let (nx, ny) = case.shape;
        let picture = case.picture(case.order.len());
        let is_in = DMatrix::from_vec(nx, ny, picture.is_in.clone());
        let gap = DMatrix::from_fn(nx, ny, |ix, iy| f64::from(gaps[ix + nx * iy]));
        for axis in [Axis::X, Axis::Y] {
            let grid = case.grid()?;
            let found =
                constriction(&gap, &is_in, (&grid, case.boundary), axis)?;
            let leads = |least: &u8| {
                let mut closed = case.picture(case.order.len());
                let nodes = closed.is_in.iter_mut().zip(&gaps);
                nodes.for_each(|(is_in, gap)| *is_in |= gap < least);
                closed.channels().cut(axis).percolates(axis)
            };
            let expected = (0..12).rev().find(leads).map(f64::from);
            prop_assert_eq!(found.map(|found| found.gap), expected);
            if let Some(Constriction { node, gap: least }) = found {
                prop_assert!(!is_in[node] && gap[node] == least);
            }
        }
    }
}

#[test]
fn what_does_not_fit_is_refused() -> Result<(), Error> {
    let grid = Grid::square(3, 1.0)?;
    let mut edge = ContactEdge::new(grid, Boundary::Free);
    let outside = edge.follow(ContactEvent::Touch, (0, 3));
    assert!(matches!(outside, Err(Error::NodeOutOfGrid { .. })));
    let (map, gap) = (DMatrix::from_element(2, 3, true), DMatrix::zeros(3, 3));
    let made = ContactEdge::of(&map, grid, Boundary::Free);
    assert!(matches!(made, Err(Error::GridMismatch { .. })));
    let on = (&grid, Boundary::Free);
    let through = |gap: &DMatrix<f64>, map| constriction(gap, map, on, Axis::X);
    let found = through(&gap, &map);
    assert!(matches!(found, Err(Error::GridMismatch { .. })));
    let map = DMatrix::from_element(3, 3, false);
    let found = through(&gap.add_scalar(f64::NAN), &map);
    assert!(matches!(found, Err(Error::FieldNotFinite { .. })));
    Ok(())
}
