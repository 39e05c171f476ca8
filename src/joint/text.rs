//! Tables in the words of other programs.

use std::fmt::Write as _;

use super::{Carrier, InterfaceRow, InterfaceTable};

/// A program that reads a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FeProgram {
    /// Abaqus: a surface interaction for an input file.
    Abaqus,
    /// CalculiX: the same in its words.
    CalculiX,
    /// MOOSE: piecewise linear functions.
    Moose,
    /// A table of comma-separated values with a line of names.
    Csv,
}

/// The units of such a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum FeUnits {
    /// m, N, Pa, W, A.
    #[default]
    Si,
    /// mm, N, MPa, t, s, A, in which power is in mW and voltage in mV.
    Millimetres,
}

impl FeUnits {
    /// How a table names them.
    fn in_words(self) -> &'static str {
        match self {
            Self::Si => "SI units",
            Self::Millimetres => "mm, N, MPa, t, s, A (power in mW, voltage in mV)",
        }
    }

    /// A row in these units.
    fn of(self, row: &InterfaceRow, carrier: Option<Carrier>) -> InterfaceRow {
        let Self::Millimetres = self else { return *row };
        let conductance = match carrier {
            // mW/(mm² K).
            Some(Carrier::Heat) | None => 1e-3,
            // A/(mV mm²).
            Some(Carrier::Current) => 1e-9,
        };
        InterfaceRow {
            pressure: 1e-6 * row.pressure,
            overclosure: 1e3 * row.overclosure,
            conductance: row.conductance.map(|value| conductance * value),
            tangential_stiffness: row.tangential_stiffness.map(|value| 1e-9 * value),
            slip_limit: row.slip_limit.map(|value| 1e-6 * value),
        }
    }
}

/// The name of the interaction.
const NAME: &str = "ROUGH_INTERFACE";

impl InterfaceTable {
    /// The table for a program, in SI units.
    ///
    /// * *Abaqus*: `*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR`; `*GAP CONDUCTANCE, PRESSURE` for heat, `*GAP
    ///   ELECTRICAL CONDUCTANCE, PRESSURE` for current; `*FRICTION, ELASTIC SLIP`, which is one number: that of the
    ///   last row.
    /// * *CalculiX*: the same; a `*FRICTION` whose stick slope is the stiffness of the last row; current goes by the
    ///   analogy with heat, as a `*GAP CONDUCTANCE`.
    /// * *MOOSE*: `PiecewiseLinear` functions: the pressure of the overclosure, each other quantity of the pressure.
    /// * *CSV*: all columns.
    #[must_use]
    pub fn text(&self, program: FeProgram) -> String {
        self.text_in(program, FeUnits::Si)
    }

    /// The same in other units. The names of CSV tell them unless they are those of SI.
    #[must_use]
    pub fn text_in(&self, program: FeProgram, units: FeUnits) -> String {
        let table = self.map_rows(|row| units.of(row, self.carrier()));
        match program {
            FeProgram::Abaqus | FeProgram::CalculiX => table.keywords(program, units),
            FeProgram::Moose => table.functions(units),
            FeProgram::Csv => table.columns(units),
        }
    }

    /// What the table is, line by line.
    fn about(&self, units: FeUnits) -> [String; 3] {
        [
            format!(
                "interface law of a rough surface by asperity {}, in {}",
                env!("CARGO_PKG_VERSION"),
                units.in_words()
            ),
            "overclosure: what the mean gap has closed since first touch; all quantities per nominal area".to_string(),
            format!(
                "{} rows; between them values err by at most {:e} of themselves (pressures below a thousandth of the greatest: of that thousandth)",
                self.rows().len(),
                self.tolerance()
            ),
        ]
    }

    fn keywords(&self, program: FeProgram, units: FeUnits) -> String {
        let mut text = String::new();
        for line in self.about(units) {
            let _ = writeln!(text, "** {line}");
        }
        let _ = writeln!(text, "*SURFACE INTERACTION, NAME={NAME}");
        let _ = writeln!(text, "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR");
        for row in self.rows() {
            let _ = writeln!(text, "{}, {}", number(row.pressure), number(row.overclosure));
        }
        if let Some(carrier) = self.carrier() {
            let keyword = match (program, carrier) {
                (FeProgram::Abaqus, Carrier::Heat) => "*GAP CONDUCTANCE, PRESSURE",
                (FeProgram::Abaqus, Carrier::Current) => "*GAP ELECTRICAL CONDUCTANCE, PRESSURE",
                (_, Carrier::Heat) => "*GAP CONDUCTANCE",
                (_, Carrier::Current) => {
                    let _ = writeln!(
                        text,
                        "** electrical, by the analogy with heat: temperatures are potentials"
                    );
                    "*GAP CONDUCTANCE"
                }
            };
            let _ = writeln!(text, "{keyword}");
            for row in self.rows() {
                let _ = writeln!(
                    text,
                    "{}, {}",
                    number(row.conductance.unwrap_or(0.0)),
                    number(row.pressure)
                );
            }
        }
        let last =
            self.rows().last().and_then(|row| Some((row.tangential_stiffness?, row.slip_limit?)));
        if let (Some(friction), Some((stiffness, limit))) = (self.friction(), last) {
            let _ = writeln!(
                text,
                "** tangential stiffness and slip limit under the greatest pressure of the table; with all rows: CSV"
            );
            if program == FeProgram::Abaqus {
                let _ = writeln!(text, "*FRICTION, ELASTIC SLIP={}", number(limit / stiffness));
                let _ = writeln!(text, "{}", number(friction));
            } else {
                let _ = writeln!(text, "*FRICTION");
                let _ = writeln!(text, "{}, {}", number(friction), number(stiffness));
            }
        }
        text
    }

    fn functions(&self, units: FeUnits) -> String {
        let mut text = String::new();
        for line in self.about(units) {
            let _ = writeln!(text, "# {line}");
        }
        let values = |quantity: &dyn Fn(&InterfaceRow) -> f64| {
            let all: Vec<String> = self.rows().iter().map(|row| number(quantity(row))).collect();
            all.join(" ")
        };
        let _ = writeln!(text, "[Functions]");
        let mut function = |name: &str, x: String, y: String| {
            let _ = writeln!(
                text,
                "  [{name}]\n    type = PiecewiseLinear\n    x = '{x}'\n    y = '{y}'\n  []"
            );
        };
        let pressure = || values(&|row| row.pressure);
        function("pressure_of_overclosure", values(&|row| row.overclosure), pressure());
        if self.carrier().is_some() {
            function(
                "conductance_of_pressure",
                pressure(),
                values(&|row| row.conductance.unwrap_or(0.0)),
            );
        }
        if self.friction().is_some() {
            let stiffness = values(&|row| row.tangential_stiffness.unwrap_or(0.0));
            function("tangential_stiffness_of_pressure", pressure(), stiffness);
            function(
                "slip_limit_of_pressure",
                pressure(),
                values(&|row| row.slip_limit.unwrap_or(0.0)),
            );
        }
        let _ = writeln!(text, "[]");
        text
    }

    fn columns(&self, units: FeUnits) -> String {
        let mut columns = vec![("pressure", "MPa"), ("overclosure", "mm")];
        if let Some(carrier) = self.carrier() {
            let unit = match carrier {
                Carrier::Heat => "mW/(mm2 K)",
                Carrier::Current => "A/(mV mm2)",
            };
            columns.push((carrier.column(), unit));
        }
        if self.friction().is_some() {
            columns.extend([("tangential_stiffness", "MPa/mm"), ("slip_limit", "MPa")]);
        }
        let names = columns.iter().map(|(name, unit)| match units {
            FeUnits::Si => name.to_string(),
            FeUnits::Millimetres => format!("{name} [{unit}]"),
        });
        let mut text = names.collect::<Vec<_>>().join(",") + "\n";
        for row in self.rows() {
            let optional = [row.conductance, row.tangential_stiffness, row.slip_limit];
            let all = [Some(row.pressure), Some(row.overclosure)].into_iter().chain(optional);
            let cells: Vec<String> = all.flatten().map(number).collect();
            text += &(cells.join(",") + "\n");
        }
        text
    }
}

/// Thirteen digits, with point and exponent: CalculiX reads no more than twenty characters.
pub(super) fn number(value: f64) -> String {
    format!("{value:.12e}")
}
