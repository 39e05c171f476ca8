//! Tables of pages in Markdown.

/// The lines of all tables of a page whose first column has this header, their headers among them, as cells without
/// blanks around them.
#[must_use]
pub fn tables(page: &str, header: &str) -> Vec<Vec<String>> {
    let cells = |line: &str| -> Option<Vec<String>> {
        let inner = line.strip_prefix('|')?.strip_suffix('|')?;
        Some(inner.split('|').map(|cell| cell.trim().to_string()).collect())
    };
    let mut found = Vec::new();
    let mut is_in = false;
    for line in page.lines() {
        let Some(cells) = cells(line) else {
            is_in = false;
            continue;
        };
        is_in |= cells[0] == header;
        if is_in && !cells[0].starts_with("---") {
            found.push(cells);
        }
    }
    found
}
