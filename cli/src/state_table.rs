//! The table of states that people read: the same for paths and single loads.

use asperity::Grid;
use asperity::contact::ContactState;
use asperity::joint::Carrier;
use asperity_cli::half_space::{Periodic, is_of_mean_planes};
use asperity_cli::say;

use crate::columns::{Column, print as print_columns};

/// A state with what it does not know of itself.
#[derive(Debug, Clone)]
pub(crate) struct Row {
    pub(crate) contact: ContactState,
    /// The greatest pressure of a cell \[Pa\].
    pub(crate) greatest: f64,
    /// The corrected contact area \[m²\].
    pub(crate) corrected_area: f64,
    /// Area of yielded cells over nominal area, if cells yield.
    pub(crate) yielded: Option<f64>,
    /// What it conducts \[W/K, S\]; the same carriers in every row.
    pub(crate) conductances: Vec<(Carrier, f64)>,
}

/// Prints the rows, and what their columns are.
pub(crate) fn print(rows: &[Row], grid: &Grid, periodic: Option<Periodic>) {
    print_of(&[], rows, grid, periodic);
}

/// The same with the seed of each row, if there are any.
pub(crate) fn print_of(seeds: &[u64], rows: &[Row], grid: &Grid, periodic: Option<Periodic>) {
    let nominal_area = grid.nominal_area();
    let column = |name: &'static str, unit: &'static str, quantity: &dyn Fn(&Row) -> f64| {
        Column::new(name, unit, rows.iter().map(quantity))
    };
    let stiffness = |stiffness: Option<f64>| stiffness.unwrap_or(f64::NAN);
    let has_yielded = rows.iter().any(|row| row.yielded.is_some());
    let mut columns = vec![
        column("load", "N", &|row| row.contact.load),
        column("pressure", "Pa", &|row| row.contact.mean_pressure()),
        column("greatest", "Pa", &|row| row.greatest),
        column("area", "m²", &|row| row.contact.contact_area),
        Column::percent("area", rows.iter().map(|row| row.contact.contact_area_fraction)),
        Column::percent("corrected", rows.iter().map(|row| row.corrected_area / nominal_area)),
        column("approach", "m", &|row| row.contact.approach),
        column("mean gap", "m", &|row| row.contact.mean_gap),
        column("K", "N/m", &|row| stiffness(row.contact.contact_stiffness)),
        column("K_i", "N/m", &|row| stiffness(row.contact.interfacial_stiffness)),
    ];
    if has_yielded {
        let yielded = rows.iter().map(|row| row.yielded.unwrap_or(0.0));
        columns.insert(6, Column::percent("yielded", yielded));
    }
    // A half-space that repeats both ways has no contact stiffness.
    let has_k = rows.iter().any(|row| row.contact.contact_stiffness.is_some());
    columns.retain(|column| has_k || column.name() != "K");
    // A profile is as wide as one likes.
    let width = match (grid.shape(), grid.sides()) {
        ((_, 1), (_, ly)) => Some(ly),
        ((1, _), (lx, _)) => Some(lx),
        _ => None,
    };
    if let Some(width) = width {
        columns.insert(1, column("per width", "N/m", &|row| row.contact.load / width));
    }
    let carriers = rows.first().map_or(&[][..], |row| &row.conductances);
    for (k, (carrier, _)) in carriers.iter().enumerate() {
        let (name, unit) = match carrier {
            Carrier::Heat => ("heat", "W/(m² K)"),
            Carrier::Current => ("current", "S/m²"),
        };
        columns.push(column(name, unit, &|row| row.conductances[k].1 / nominal_area));
    }
    if !seeds.is_empty() {
        columns.insert(0, Column::counts("seed", seeds));
    }
    print_columns(&columns);
    say!();
    say!("pressure: load over nominal area; greatest: the greatest pressure of a cell");
    say!(
        "area: cells in contact; corrected: without the excess of whole cells along the edges of patches (somewhat too small)"
    );
    // Layers on a rigid base have an approach of their own, and so a K, where they repeat too.
    match (has_k, is_of_mean_planes(periodic, has_k)) {
        (true, _) => say!("approach: from first touch; K: contact stiffness, d load/d approach"),
        (false, true) => say!("approach: of the mean planes, from first touch"),
        (false, false) => say!("approach: from first touch"),
    }
    if has_yielded {
        say!("yielded: cells at the hardness; they count as contact");
    }
    say!("K_i: interfacial stiffness, -d load/d mean gap");
    if !carriers.is_empty() {
        say!("heat, current: conductance per nominal area");
    }
    say!();
}
