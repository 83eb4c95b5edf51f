//! Markdown tables.

/// A table of text cells.
pub struct Table {
    text: String,
}

impl Table {
    /// With these names of columns.
    pub fn new<const N: usize>(head: [&str; N]) -> Self {
        Self::with_head(&head)
    }

    /// With as many columns as there are names.
    pub fn with_head(head: &[&str]) -> Self {
        let mut table = Self { text: String::new() };
        table.cells(head);
        table.cells(&vec!["---"; head.len()]);
        table
    }

    /// Adds a row.
    pub fn row<const N: usize>(&mut self, cells: [String; N]) {
        self.cells(&cells);
    }

    /// Adds a row of any length.
    pub fn cells(&mut self, cells: &[impl AsRef<str>]) {
        let cells: Vec<&str> = cells.iter().map(AsRef::as_ref).collect();
        self.text.push_str(&format!("| {} |\n", cells.join(" | ")));
    }

    /// The table as Markdown.
    pub fn text(&self) -> &str {
        &self.text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_markdown() {
        let mut table = Table::new(["a", "b"]);
        table.row(["1".into(), "2".into()]);
        assert_eq!(table.text(), "| a | b |\n| --- | --- |\n| 1 | 2 |\n");
    }
}
