use super::*;
use crate::{Error, test_chain};

fn contact(nodes: usize, is_in: &[usize]) -> NodeSet {
    let mut contact = NodeSet::new(nodes);
    contact.assign(|node| is_in.contains(&node));
    contact
}

/// With no more nodes in contact than a pattern has room for, nothing is left out: C M b is b, but for single
/// precision.
#[test]
fn few_nodes_are_inverted_exactly() -> Result<(), Error> {
    let table = crate::KernelTable::from_fn(
        test_chain::grid(9)?,
        crate::Boundary::Free,
        crate::ContactGrowth::Monotone,
        // Twice that of the other rows: units matter.
        |di, _| [8.0, 2.0].get(di.unsigned_abs()).copied().unwrap_or(0.0),
    )?;
    let is_in = [0, 1, 2, 3, 5, 6, 8];
    let mut inverse: SparseInverse = SparseInverse::new(&table);
    assert!(inverse.update(&contact(9, &is_in)));
    assert!(!inverse.update(&contact(9, &is_in)));
    let b = [1.0, -2.0, 3.0, 0.5, 0.0, 4.0, -1.0];
    let mut y = Vec::new();
    inverse.apply(&b, &mut y);
    for (&i, b) in is_in.iter().zip(b) {
        let product: f64 = is_in
            .iter()
            .zip(&y)
            .map(|(&j, y)| table.between(table.place(i), table.place(j)) * y)
            .sum();
        // Some rounding errors of 6·10⁻⁸ of numbers up to 4.
        assert!((product - b).abs() < 2e-6, "{i}: {product}");
    }
    // Of nothing comes nothing.
    inverse.apply(&[0.0; 7], &mut y);
    assert_eq!(y, [0.0; 7]);
    Ok(())
}

/// Patterns of 18 numbers of four bytes, the index of what they were made of, contact nodes, and four fields of the
/// grid.
#[test]
fn bytes_are_those_held() -> Result<(), Error> {
    let mut inverse: SparseInverse = SparseInverse::new(&test_chain::kernel(30)?);
    let is_in: Vec<usize> = (0..30).filter(|node| node % 4 != 1).collect();
    inverse.update(&contact(30, &is_in));
    assert!(inverse.patterns.len() > 2 && inverse.index.capacity() >= inverse.patterns.len());
    let index = inverse.index.capacity() * size_of::<(Found<NEIGHBOURS>, u32)>();
    let expected = 72 * inverse.patterns.len() + index + 4 * is_in.len() + 4 * 4 * 30;
    assert_eq!(inverse.bytes(), expected);
    Ok(())
}
