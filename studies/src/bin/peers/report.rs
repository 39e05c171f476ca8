//! The tables, and the verdicts.

use std::fmt::Write;

use asperity_cli::number::scientific;

use crate::ours::{LOADS, TOLERANCE};
use crate::table::{Row, Wave};

/// What may differ, of the greatest pressure, of the mean gap over the rms height, and of the stiffness.
const PRESSURE: f64 = 1e-6;
const GAP: f64 = 1e-6;
const STIFFNESS: f64 = 1e-3;

/// The same of the answer to one wave: rounding.
const WAVE: f64 = 1e-9;

/// Programs and half-spaces in the order of columns.
const COLUMNS: [(&str, &str); 7] = [
    ("aspher", "free"),
    ("ContactMechanics", "free"),
    ("dense", "free"),
    ("aspher", "periodic"),
    ("ContactMechanics", "periodic"),
    ("tamaas", "periodic"),
    ("dense", "periodic"),
];

/// The worst of one program on one surface over all loads.
struct Cell<'a> {
    rows: Vec<&'a Row>,
}

impl<'a> Cell<'a> {
    fn new(rows: &'a [Row], surface: &str, (program, half_space): (&str, &str)) -> Option<Self> {
        let of = rows.iter().filter(|row| {
            row.surface == surface && row.program == program && row.half_space == half_space
        });
        let rows: Vec<_> = of.collect();
        (!rows.is_empty()).then_some(Self { rows })
    }

    fn greatest(&self, value: impl Fn(&Row) -> f64) -> f64 {
        self.rows.iter().map(|row| value(row)).fold(0.0, f64::max)
    }

    fn nodes(&self) -> usize {
        self.rows.iter().map(|row| row.nodes_different).sum()
    }

    fn pressure(&self) -> f64 {
        self.greatest(|row| row.pressure_difference)
    }

    fn gap(&self) -> f64 {
        self.greatest(|row| row.gap_difference)
    }

    /// `None` if a node joined between the two loads at every load.
    fn stiffness(&self) -> Option<f64> {
        let known = self.rows.iter().filter_map(|row| row.stiffness_difference);
        known.reduce(f64::max)
    }

    fn agrees(&self) -> bool {
        self.rows.len() == LOADS.len()
            && self.nodes() == 0
            && self.pressure() <= PRESSURE
            && self.gap() <= GAP
            && self.stiffness().is_none_or(|difference| difference <= STIFFNESS)
    }
}

fn table(rows: &[Row], surfaces: &[&str]) -> String {
    let mut text = "| program, half-space | entries | agree | pressure | mean gap | stiffness \
    |\n|---|---|---|---|---|---|\n"
        .to_string();
    for (program, half_space) in COLUMNS {
        let cells = surfaces.iter().filter_map(|name| Cell::new(rows, name, (program, half_space)));
        let cells: Vec<Cell> = cells.collect();
        let agree: Vec<&Cell> = cells.iter().filter(|cell| cell.agrees()).collect();
        let worst = |value: &dyn Fn(&Cell) -> f64| {
            let greatest = agree.iter().map(|cell| value(cell)).fold(0.0, f64::max);
            format!("{greatest:.0e}")
        };
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "| {program}, {half_space} | {} | {} | {} | {} | {} |",
            cells.len(),
            agree.len(),
            worst(&|cell| cell.pressure()),
            worst(&|cell| cell.gap()),
            worst(&|cell| cell.stiffness().unwrap_or(0.0)),
        );
    }
    text
}

pub(crate) fn text(rows: &[Row], waves: &[Wave]) -> String {
    let mut surfaces: Vec<&str> = Vec::new();
    for row in rows {
        if !surfaces.contains(&row.surface.as_str()) {
            surfaces.push(&row.surface);
        }
    }
    let mut programs: Vec<String> = Vec::new();
    for row in rows {
        let program = match row.tolerance {
            0.0 => format!("\"{}\" with {}", row.program, row.version),
            tolerance => {
                let tolerance = scientific(tolerance, 1);
                format!("{} {} (to {tolerance})", row.program, row.version)
            }
        };
        if !programs.contains(&program) {
            programs.push(program);
        }
    }
    let cells = || {
        let of =
            |surface| COLUMNS.map(|column| (surface, column, Cell::new(rows, surface, column)));
        surfaces.iter().flat_map(move |surface| of(surface))
    };
    let compared = cells().filter(|(_, _, cell)| cell.is_some()).count();
    let agreeing = cells().filter(|(_, _, cell)| cell.as_ref().is_some_and(Cell::agrees)).count();
    let solved = rows.len();
    let table = table(rows, &surfaces);
    let mut text = format!(
        "## Other programs\n\n\
         Study `peers`: other programs on the same surfaces, loads and half-spaces. `studies/src/bin/peers/peers.sh` \
         installs and runs them.\n\n\
         * **Programs**: {}; ours is `FixedLoadSolver`, to {}. \"dense\" is `dense.py`: the influence matrix entry by \
         entry, LU on the contact set, and the set changed until the conditions of contact hold to rounding, on grids \
         of up to 1024 nodes.\n\
         * **Half-spaces**: free with Love's kernel (`Boussinesq`); periodic with 2/(E\\*|q|) (`Spectral`).\n\
         * **Surfaces**: eight on 128 × 128 nodes; others on grids that are not square, with cells of 3 : 1, and with \
         an odd number of nodes along y or x.\n\
         * **Loads**: p̄ = {} E\\* times the rms gradient between nodes. An entry is one surface under all three.\n\
         * **Criterion**, for every entry: at each load the same nodes under pressure, pressures within {} of the \
         greatest, mean gaps within {} Sq, and stiffness within {} of theirs by differences, from a second load larger \
         by 10⁻⁵, unless a node joins in between.\n\n\
         The worst of the entries that agree, in these measures:\n\n{table}\n\
         **Verdict: {agreeing} of {compared} entries, {solved} states in all, agree.** The exception:\n",
        programs.join(", "),
        scientific(TOLERANCE, 1),
        LOADS.map(|load| load.to_string()).join(", "),
        scientific(PRESSURE, 1),
        scientific(GAP, 1),
        scientific(STIFFNESS, 1),
    );
    let failing = cells().filter_map(|(surface, column, cell)| Some((surface, column, cell?)));
    for (surface, (program, half_space), cell) in failing.filter(|(_, _, cell)| !cell.agrees()) {
        let judge = Cell::new(rows, surface, ("dense", half_space));
        let judged = judge.map_or("no judge on a grid of this size".to_string(), |judge| {
            let verdict = if judge.agrees() {
                "agrees with asperity"
            } else {
                "does not agree with asperity"
            };
            format!(
                "the dense check {verdict}: {} nodes, {}",
                judge.nodes(),
                scientific(judge.pressure(), 1)
            )
        });
        let _ = write!(
            text,
            "\n* **{program}, {half_space}, {surface}**: {} nodes differ, and pressures by {}; {judged}.",
            cell.nodes(),
            scientific(cell.pressure(), 1),
        );
    }
    text.push_str(&shortest_waves(waves));
    text
}

/// How the other programs answer the shortest waves, where they should all answer 2/(E* |q|).
fn shortest_waves(waves: &[Wave]) -> String {
    let wrong = |wave: &&Wave| (wave.response - 1.0).abs() > WAVE;
    let each = waves.iter().filter(wrong).map(|wave| {
        let k = wave.wave_number as f64;
        format!(
            "{} on {} × {} nodes answers the wave with {} periods along {} with {:.6} of that, and ½ (1 + {k}/{}) = \
             {:.6}",
            wave.program,
            wave.nx,
            wave.ny,
            wave.wave_number,
            wave.axis,
            wave.response,
            wave.wave_number + 1,
            0.5 * (1.0 + k / (k + 1.0)),
        )
    });
    let wrong: Vec<String> = each.collect();
    let why = match wrong.len() {
        0 => "All are right.".to_string(),
        count => format!(
            "All but {count} are right within {}: {}. With an odd number of nodes along its first axis tamaas takes \
             one of the two conjugates of the shortest wave for the next shorter wave.",
            scientific(WAVE, 1),
            wrong.join("; "),
        ),
    };
    format!(
        "\n\n**Why.** A wave of pressure displaces by 2/(E\\*|q|) times itself: {} of the shortest waves were given \
         to tamaas and ContactMechanics (`waves.csv`). {why}",
        waves.len(),
    )
}
