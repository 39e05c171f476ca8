//! The figures on the page, one section each.

mod figure3;
mod figure4;
mod figure5;
mod figure6;
mod figure7;
mod figure8;
mod whole_path;

use std::fmt::Write;

pub(crate) use figure3::figure3;
pub(crate) use figure4::figure4;
pub(crate) use figure5::figure5;
pub(crate) use figure6::figure6;
pub(crate) use figure7::figure7;
pub(crate) use figure8::figure8;
pub(crate) use whole_path::whole_path;

fn picture(prefix: &str, figure: &str, text: &str) -> String {
    format!("![{text}]({prefix}{figure}.png)")
}

/// A table with a column for each surface.
struct Table {
    text: String,
}

impl Table {
    fn new(names: &[&str]) -> Self {
        let names: Vec<String> = names.iter().map(|name| format!(" {name} |")).collect();
        Self {
            text: format!(
                "| quantity | paper |{}\n|---|---|{}\n",
                names.concat(),
                "---|".repeat(names.len())
            ),
        }
    }

    fn row(&mut self, quantity: &str, paper: &str, cells: impl IntoIterator<Item = String>) {
        let cells = cells.into_iter().map(|cell| format!(" {cell} |"));
        let cells = cells.collect::<String>();
        // Writing to a string does not fail.
        let _ = writeln!(self.text, "| {quantity} | {paper} |{cells}");
    }
}
