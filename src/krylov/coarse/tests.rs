use super::*;
use crate::kernel::KernelTable;
use crate::{Boussinesq, Error, Grid, PeriodicBoussinesq};

/// Some grids that hat functions and aggregates do not divide, with free and periodic boundaries.
fn tables() -> Result<Vec<KernelTable>, Error> {
    let mut tables = Vec::new();
    for (nx, ny, dx, dy) in [(100, 100, 1.0, 1.0), (131, 77, 1.0, 1.3), (420, 24, 1.0, 4.0)] {
        let grid = Grid::new(nx, ny, dx, dy)?;
        tables.push(KernelTable::new(&Boussinesq::new(grid, 1.0)?)?);
        let periodic = KernelTable::new(&PeriodicBoussinesq::new(grid, 1.0)?)?;
        let gauge = periodic.computing_gauge().unwrap_or_default();
        tables.push(periodic.in_gauge(gauge));
    }
    Ok(tables)
}

fn space(table: &KernelTable) -> Result<CoarseSpace, Error> {
    CoarseSpace::new(table).ok_or(Error::OutOfRange {
        quantity: "hats",
        value: 0.0,
        expected: "some",
    })
}

/// Islands of contact, none in one corner.
fn islands(table: &KernelTable) -> NodeSet {
    let (nx, ny) = table.grid().shape();
    let mut contact = NodeSet::new(nx * ny);
    contact.assign(|node| {
        let (x, y) = ((node % nx) as f64, (node / nx) as f64);
        let wave = (0.37 * x).sin() + (0.29 * y + 0.1 * x).cos();
        wave > 0.2 && (x > 0.4 * nx as f64 || y > 0.3 * ny as f64)
    });
    contact
}

#[test]
fn hats_sum_to_one() -> Result<(), Error> {
    for table in tables()? {
        let mut space = space(&table)?;
        let contact = islands(&table);
        space.update(&contact);
        assert!(space.is_useful());
        let total: f64 = space.masses.iter().sum();
        assert!((total - contact.len() as f64).abs() < 1e-9 * total);
        // P keeps what is uniform.
        let mut rest = Vec::new();
        space.project_out(&contact, &vec![2.0; contact.len()], &mut rest);
        assert!(rest.iter().all(|value| value.abs() < 1e-12));
    }
    Ok(())
}

/// The hat functions at a node are what a sum over it alone finds, and their values sum to one.
#[test]
fn hats_at_a_node() -> Result<(), Error> {
    for table in tables()? {
        let mut space = space(&table)?;
        let (nx, ny) = table.grid().shape();
        let mut contact = NodeSet::new(nx * ny);
        let mut sums = Vec::new();
        for node in (0..nx * ny).step_by(7) {
            contact.assign(|other| other == node);
            space.basis.restrict(&contact, &[1.0], &mut sums);
            let mut total = 0.0;
            for (hat, value) in space.basis.at(node % nx, node / nx) {
                total += value;
                sums[hat] -= value;
            }
            // Rounding of products of numbers up to 1.
            assert!((total - 1.0).abs() < 1e-14, "node {node}: {total}");
            assert!(sums.iter().all(|sum| sum.abs() < 1e-14), "node {node}");
        }
    }
    Ok(())
}

/// P is symmetric, with eigenvalues from 0 to 1.
#[test]
fn means_over_hats() -> Result<(), Error> {
    for table in tables()? {
        let mut space = space(&table)?;
        let contact = islands(&table);
        space.update(&contact);
        let wave = |rate: f64| -> Vec<f64> {
            let nodes = contact.nodes().iter();
            nodes.map(|&node| (rate * f64::from(node)).sin()).collect()
        };
        let (a, b) = (wave(0.013), wave(0.71));
        let mut rest = Vec::new();
        let mut mean = |values: &[f64]| -> Vec<f64> {
            space.project_out(&contact, values, &mut rest);
            values.iter().zip(&rest).map(|(value, rest)| value - rest).collect()
        };
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (pa, pb) = (mean(&a), mean(&b));
        let scale = dot(&a, &a);
        assert!((dot(&a, &pb) - dot(&b, &pa)).abs() < 1e-12 * scale);
        assert!(dot(&a, &pa) >= 0.0 && dot(&a, &pa) <= scale);
        // (P a)ᵀ (1 − P) a ≥ 0: no eigenvalue is above one.
        let ppa = mean(&pa);
        assert!(dot(&pa, &pa) - dot(&pa, &ppa) >= -1e-12 * scale);
    }
    Ok(())
}

/// The influence between hat functions is that of all pairs of nodes, but for less than the ridge of E.
#[test]
fn influence_between_hats() -> Result<(), Error> {
    for table in tables()? {
        let space = space(&table)?;
        let (nx, size) = (table.grid().nx(), space.basis.len());
        let contact = islands(&table);
        let CoarseInfluence { half, masses } = space.aggregates.influence(&space.basis, &contact);
        let at = |node: u32| (node as usize % nx, node as usize / nx);
        let mut exact = vec![0.0; size * size];
        let mut column = vec![0.0; size];
        for &node in contact.nodes() {
            column.fill(0.0);
            let place = table.place(node as usize);
            for &other in contact.nodes() {
                let value = table.between(place, table.place(other as usize));
                let (ix, iy) = at(other);
                for (hat, weight) in space.basis.at(ix, iy) {
                    column[hat] += weight * value / table.self_influence();
                }
            }
            let (ix, iy) = at(node);
            for (hat, weight) in space.basis.at(ix, iy) {
                for (sum, value) in exact[size * hat..][..size].iter_mut().zip(&column) {
                    *sum += weight * value;
                }
            }
        }
        let most = masses.iter().fold(0.0_f64, |a, &b| a.max(b));
        for i in (0..size).filter(|&i| masses[i] > 0.1 * most) {
            for j in (0..size).filter(|&j| masses[j] > 0.1 * most) {
                let found = half[i + size * j] + half[j + size * i];
                let expected = exact[i + size * j];
                let scale = (exact[i + size * i] * exact[j + size * j]).sqrt();
                let error = (found - expected).abs() / scale;
                assert!(error < 0.15, "{i}, {j}: {found} instead of {expected}");
            }
        }
    }
    Ok(())
}

#[test]
fn small_grids_have_no_hats() -> Result<(), Error> {
    for (nx, ny) in [(64, 64), (200, 32), (1, 1)] {
        let grid = Grid::new(nx, ny, 1.0, 1.0)?;
        let table = KernelTable::new(&Boussinesq::new(grid, 1.0)?)?;
        assert!(CoarseSpace::new(&table).is_none());
    }
    Ok(())
}

/// Sixteen nodes for each hat function are enough, and one less is not.
#[test]
fn few_nodes_need_no_hats() -> Result<(), Error> {
    for table in tables()? {
        let mut space = space(&table)?;
        let least = SPARSE * space.basis.len();
        let mut contact = NodeSet::new(table.grid().nodes());
        for (nodes, is_useful) in [(least, true), (least - 1, false)] {
            contact.assign(|node| node < nodes);
            space.update(&contact);
            assert_eq!(space.is_useful(), is_useful);
        }
        // Too few hat functions.
        let small = KernelTable::new(&Boussinesq::new(Grid::square(8, 8.0)?, 1.0)?)?;
        assert!(CoarseSpace::new(&small).is_none());
    }
    Ok(())
}

/// The inverse is made anew when more than a tenth of the contact has changed. What it stands for then is counted.
#[test]
fn the_inverse_is_kept_until_the_contact_has_changed() -> Result<(), Error> {
    let table = KernelTable::new(&Boussinesq::new(Grid::square(100, 100.0)?, 1.0)?)?;
    let mut space = space(&table)?;
    let mut contact = NodeSet::new(10_000);
    contact.assign(|_| true);
    space.update(&contact);
    let counted = |space: &CoarseSpace| space.inverse_masses.iter().sum::<f64>();
    // Of 9200 nodes 800 have left since, of 9000 a thousand, more than a tenth.
    for (nodes, known) in [(9200, 10_000.0), (9000, 9000.0), (8500, 9000.0), (8000, 8000.0)] {
        contact.assign(|node| node < nodes);
        space.update(&contact);
        assert!((counted(&space) - known).abs() < 1e-6, "{nodes}: {}", counted(&space));
        let now: f64 = space.masses.iter().sum();
        assert!((now - nodes as f64).abs() < 1e-6);
    }
    Ok(())
}
