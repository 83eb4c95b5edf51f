//! What stands at a place of a YAML text, for errors that quote it. Lines and columns count from 1.

/// The plain scalar that begins at a place. A comma ends it within brackets only.
pub fn scalar_at(text: &str, line: u64, column: u64) -> String {
    let (Ok(row), Ok(start)) = (usize::try_from(line), usize::try_from(column)) else {
        return String::new();
    };
    let content = text.lines().nth(row.saturating_sub(1)).unwrap_or("");
    let rest: String = content.chars().skip(start.saturating_sub(1)).collect();
    let mut scalar = rest.split(" #").next().unwrap_or("");
    if open_brackets(text, line, column) > 0 {
        scalar = scalar.split([',', '}', ']']).next().unwrap_or("");
    }
    scalar.trim().to_string()
}

/// Whether a value is a number but for a comma in the place of the point.
pub fn has_decimal_comma(value: &str) -> bool {
    value.contains(',') && value.replacen(',', ".", 1).parse::<f64>().is_ok()
}

/// Whether a key at a place is the decimals of a number that was written with a comma, which ends a value within
/// brackets: `{hole_diameter: 0,118}`.
pub fn follows_decimal_comma(text: &str, line: u64, column: u64, key: &str) -> bool {
    let (Ok(row), Ok(start)) = (usize::try_from(line), usize::try_from(column)) else {
        return false;
    };
    let content = text.lines().nth(row.saturating_sub(1)).unwrap_or("");
    let before: String = content.chars().take(start.saturating_sub(1)).collect();
    let ends_in_digit = |text: &str| text.ends_with(|last: char| last.is_ascii_digit());
    key.bytes().all(|byte| byte.is_ascii_digit()) && before.trim_end().strip_suffix(',').is_some_and(ends_in_digit)
}

/// Line and column of the first tab before a key or an item, up to a line; in the whole text where the line is 0.
pub fn tab_before_key(text: &str, last_line: u64) -> Option<(u64, u64)> {
    (1_u64..).zip(text.lines()).find_map(|(line, content)| {
        if last_line > 0 && line > last_line {
            return None;
        }
        let key = content.trim_start();
        let indent = &content[..content.len() - key.len()];
        let tab = indent.find('\t')?;
        let is_key = key.starts_with("- ") || (!key.starts_with('#') && key.contains(':'));
        // Within brackets a tab is as good as a space.
        (is_key && open_brackets(text, line, 1) == 0).then_some((line, tab as u64 + 1))
    })
}

/// Brackets that are open at a place, outside of quotation marks and comments.
fn open_brackets(text: &str, line: u64, column: u64) -> usize {
    let (mut depth, mut quote) = (0_usize, None);
    for (row, content) in (1_u64..).zip(text.lines()) {
        let mut before = ' ';
        for (position, character) in (1_u64..).zip(content.chars()) {
            if (row, position) >= (line, column) {
                return depth;
            }
            // A mark within a word, as in driller's, begins no quotation.
            let begins_word = before.is_whitespace() || "[{,:".contains(before);
            match quote {
                Some(mark) => quote = (character != mark).then_some(mark),
                None => match character {
                    '#' if before.is_whitespace() => break,
                    '"' | '\'' if begins_word => quote = Some(character),
                    '[' | '{' => depth += 1,
                    ']' | '}' => depth = depth.saturating_sub(1),
                    _ => {}
                },
            }
            before = character;
        }
        if row >= line {
            break;
        }
    }
    depth
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comma_ends_a_value_within_brackets_only() {
        let text = "a: 0,118  # m\nb: {c: 0,118, d: [1, x]}\n";
        let scalars = [(1, 4), (2, 8), (2, 22)].map(|(line, column)| scalar_at(text, line, column));
        assert_eq!(scalars, ["0,118", "0", "x"]);
        assert!(has_decimal_comma("0,118") && !has_decimal_comma("0.118") && !has_decimal_comma("1,2,3"));
        assert!(follows_decimal_comma(text, 2, 10, "118"));
        assert!(!follows_decimal_comma(text, 2, 15, "d"));
    }

    #[test]
    fn brackets_in_comments_and_quotations_are_not_open() {
        let text = "a: the rig's # [{\nb: '[' \nc: \"{\"\nd: [1,\n  2]\ne: 1\n";
        let open = [2, 3, 4, 5, 6].map(|line| open_brackets(text, line, 1));
        assert_eq!(open, [0, 0, 0, 1, 0]);
    }

    #[test]
    fn a_tab_before_a_key_is_found_and_one_within_brackets_is_none() {
        assert_eq!(tab_before_key("a:\n \tb: 1\n", 0), Some((2, 2)));
        assert_eq!(tab_before_key("a:\n \tb: 1\n", 1), None);
        assert_eq!(tab_before_key("a: {\n\tb: 1}\n\t# c: 2\n\ttext\n", 0), None);
    }
}
