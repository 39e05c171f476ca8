//! Lines along which a field on the nodes of a grid has a given value: marching squares.

use nalgebra::DMatrix;

/// A point in units of nodes: node (ix, iy) is at (ix, iy).
pub type Point = (f64, f64);

/// The sides of a square of four nodes, each by its two corners, which are counted around the square from (ix, iy). All
/// run upwards along x or y, so that both squares at a side meet the level at the same point, to the last bit.
const SIDES: [(usize, usize); 4] = [(0, 1), (1, 2), (3, 2), (0, 3)];

/// The lines between the nodes whose value is at most `level` and the others, as straight pieces with ends on the lines
/// between neighbouring nodes, where the field is linear in between.
///
/// Beside a value that is not finite the line runs halfway between the nodes; beside a node without a value, NaN, there
/// is none. Where two nodes below meet two above across a square, the two below are taken to be apart, as patches are
/// whose nodes have only a corner in common. Lines are open at the border of the grid.
#[must_use]
pub fn contour(field: &DMatrix<f64>, level: f64) -> Vec<[Point; 2]> {
    let (nx, ny) = field.shape();
    let mut pieces = Vec::new();
    for iy in 1..ny {
        for ix in 1..nx {
            let corners = [(ix - 1, iy - 1), (ix, iy - 1), (ix, iy), (ix - 1, iy)];
            square(field, corners, level, &mut pieces);
        }
    }
    pieces
}

/// Adds the pieces within one square.
fn square(
    field: &DMatrix<f64>,
    corners: [(usize, usize); 4],
    level: f64,
    pieces: &mut Vec<[Point; 2]>,
) {
    let values = corners.map(|node| field[node]);
    if values.iter().any(|value| value.is_nan()) {
        return;
    }
    let below = values.map(|value| value <= level);
    let crossing = |side: usize| {
        let (a, b) = SIDES[side];
        let share = share(values[a], values[b], level);
        let along = |from: usize, to: usize| from as f64 + share * (to as f64 - from as f64);
        (along(corners[a].0, corners[b].0), along(corners[a].1, corners[b].1))
    };
    let crossed: Vec<usize> =
        (0..4).filter(|&side| below[SIDES[side].0] != below[SIDES[side].1]).collect();
    match crossed[..] {
        [one, other] => pieces.push([crossing(one), crossing(other)]),
        [_, _, _, _] => {
            // Around each of the two corners that lie below: between the side that ends there and the one that begins.
            let first = usize::from(!below[0]);
            for corner in [first, first + 2] {
                pieces.push([crossing((corner + 3) % 4), crossing(corner)]);
            }
        }
        _ => (),
    }
}

/// How far from a to b the level is met.
fn share(a: f64, b: f64, level: f64) -> f64 {
    let share = (level - a) / (b - a);
    if a.is_finite() && b.is_finite() && share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;

    /// Distance from the middle of a square of nodes.
    fn cone(nodes: usize) -> DMatrix<f64> {
        let middle = 0.5 * (nodes as f64 - 1.0);
        DMatrix::from_fn(nodes, nodes, |ix, iy| (ix as f64 - middle).hypot(iy as f64 - middle))
    }

    /// How many pieces end at each point.
    fn ends(pieces: &[[Point; 2]]) -> HashMap<(u64, u64), usize> {
        let mut ends = HashMap::new();
        for (x, y) in pieces.iter().flatten() {
            *ends.entry((x.to_bits(), y.to_bits())).or_insert(0) += 1;
        }
        ends
    }

    /// The circle of radius r, of which every chord within a square is too short by at most h²/24r² of itself; the
    /// crossings are off it by at most 1/8(r − 1), the error of linear interpolation of a distance within a cell of r.
    #[test]
    fn the_contour_of_a_cone_is_a_closed_circle() {
        let (nodes, radius) = (41, 15.3);
        let pieces = contour(&cone(nodes), radius);
        let middle = 0.5 * (nodes as f64 - 1.0);
        for (x, y) in pieces.iter().flatten() {
            let found = (x - middle).hypot(y - middle);
            assert!((found - radius).abs() < 1.0 / (8.0 * (radius - 1.0)), "{found}");
        }
        let length: f64 = pieces.iter().map(|[a, b]| (a.0 - b.0).hypot(a.1 - b.1)).sum();
        let circle = std::f64::consts::TAU * radius;
        let error = 1.0 / (8.0 * (radius - 1.0)) / radius + 2.0 / (24.0 * radius * radius);
        assert!((length / circle - 1.0).abs() < error);
        assert!(ends(&pieces).values().all(|&count| count == 2));
    }

    /// A plane is linear between all nodes, so that the line 3x + 4y = 71.3 is met to rounding. It runs from x = 0 to
    /// x = 20, falls by 15, and is 25 long. Above and below may be exchanged: no node lies on it.
    #[test]
    fn the_contour_of_a_plane_is_straight() {
        let plane = DMatrix::from_fn(21, 31, |ix, iy| 3.0 * ix as f64 + 4.0 * iy as f64);
        for (field, level) in [(plane.clone(), 71.3), (-plane, -71.3)] {
            let pieces = contour(&field, level);
            for (x, y) in pieces.iter().flatten() {
                assert!((3.0 * x + 4.0 * y - 71.3).abs() < 1e-12, "{x} {y}");
            }
            let length: f64 = pieces.iter().map(|[a, b]| (a.0 - b.0).hypot(a.1 - b.1)).sum();
            assert!((length - 25.0).abs() < 1e-11, "{length}");
            // The two ends at the border, and nowhere else.
            let open = ends(&pieces).values().filter(|&&count| count == 1).count();
            assert_eq!(open, 2);
        }
    }

    /// A single node below, among nodes that are infinitely far above: a diamond halfway to its neighbours.
    #[test]
    fn beside_infinity_the_line_is_halfway() {
        let mut field = DMatrix::from_element(3, 3, f64::INFINITY);
        field[(1, 1)] = f64::NEG_INFINITY;
        let pieces = contour(&field, 7.0);
        assert_eq!(pieces.len(), 4);
        for (x, y) in pieces.iter().flatten() {
            assert_eq!((x - 1.0).abs() + (y - 1.0).abs(), 0.5);
        }
        assert!(ends(&pieces).values().all(|&count| count == 2));
        field[(0, 0)] = f64::NAN;
        assert_eq!(contour(&field, 7.0).len(), 3);
    }

    /// Both ways to put two nodes below into a square leave each of them its own corner.
    #[test]
    fn nodes_across_a_corner_are_apart() {
        for (a, b) in [((0, 0), (1, 1)), ((1, 0), (0, 1))] {
            let mut field = DMatrix::from_element(2, 2, 1.0);
            field[a] = 0.0;
            field[b] = 0.0;
            let pieces = contour(&field, 0.25);
            assert_eq!(pieces.len(), 2);
            let node = |(ix, iy): (usize, usize)| (ix as f64, iy as f64);
            for corner in [node(a), node(b)] {
                let near = |p: &Point| (p.0 - corner.0).abs() + (p.1 - corner.1).abs() == 0.25;
                let around = pieces.iter().filter(|piece| piece.iter().all(near));
                assert_eq!(around.count(), 1);
            }
        }
    }

    #[test]
    fn no_line_without_two_sides() {
        assert!(contour(&cone(8), 100.0).is_empty());
        assert!(contour(&cone(8), -1.0).is_empty());
        assert!(contour(&DMatrix::from_element(1, 9, 1.0), 1.0).is_empty());
        assert!(contour(&DMatrix::from_element(5, 5, f64::NAN), 1.0).is_empty());
    }
}
