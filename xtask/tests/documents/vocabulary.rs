//! Words to leave out are left out.

use super::*;

/// Words that the glossary's table rules out, in small letters.
fn words_to_leave_out() -> Vec<String> {
    let glossary = read(&root().join("docs/glossary.md"));
    let table = glossary.split("## Words to leave out").nth(1).unwrap();
    let rows = table.lines().filter(|line| line.starts_with("| `"));
    rows.filter_map(|row| row.split('|').nth(1))
        .flat_map(|cell| cell.split('`').skip(1).step_by(2))
        .map(str::to_lowercase)
        .collect()
}

/// Paragraphs of a text without code, quotations and addresses, each with the number of its first line.
fn paragraphs(lines: impl Iterator<Item = (usize, String)>) -> Vec<(usize, String)> {
    let mut found: Vec<(usize, String)> = Vec::new();
    let mut open = false;
    for (number, line) in lines {
        let text = line.trim();
        if text.is_empty() {
            open = false;
            continue;
        }
        match found.last_mut().filter(|_| open) {
            Some((_, paragraph)) => {
                paragraph.push(' ');
                paragraph.push_str(text);
            }
            None => found.push((number, text.to_owned())),
        }
        open = !text.starts_with('|');
    }
    for (_, paragraph) in &mut found {
        let outside = |text: &str, mark| text.split(mark).step_by(2).collect::<Vec<_>>().join(" ");
        *paragraph = outside(&outside(&without_links(paragraph), '`'), '"').to_lowercase();
    }
    found
}

/// The prose of a document: no code blocks, and nothing that a command wrote between its markers.
fn prose(text: &str) -> Vec<(usize, String)> {
    let (mut fenced, mut written) = (false, false);
    let lines = text.lines().enumerate().map(|(number, line)| {
        if line.starts_with(WRITTEN) {
            written = !line.contains(": end");
        }
        let fence = line.trim_start().starts_with("```");
        fenced ^= fence;
        let code = fenced || fence || written || line.starts_with("    ");
        (number + 1, if code { String::new() } else { line.to_owned() })
    });
    paragraphs(lines)
}

/// The comments of a configuration or of a message definition.
fn comments(text: &str) -> Vec<(usize, String)> {
    let lines = text.lines().enumerate().map(|(number, line)| {
        let comment = line.split_once('#').map_or("", |(_, comment)| comment);
        (number + 1, comment.to_owned())
    });
    paragraphs(lines)
}

/// The words of `banned` that stand in `paragraph` as words of their own; to stand still is none.
fn found_words<'a>(paragraph: &str, banned: &'a [String]) -> Vec<&'a str> {
    let words: Vec<&str> = paragraph
        .split(|c: char| !c.is_alphanumeric() && c != '-' && c != '\'')
        .filter(|word| !word.is_empty())
        .collect();
    let stands = |at: usize| at > 0 && (words[at - 1].starts_with("stand") || words[at - 1] == "stood");
    let at = |term: &str, from: usize| {
        let term: Vec<&str> = term.split(' ').collect();
        words.get(from..from + term.len()) == Some(&term[..])
    };
    let hit = |term: &&String| (0..words.len()).any(|from| at(term, from) && !(*term == "still" && stands(from)));
    banned.iter().filter(hit).map(String::as_str).collect()
}

#[test]
fn words_to_leave_out_are_left_out() {
    let banned = words_to_leave_out();
    assert!(banned.len() > 20, "{banned:?}");
    let mut found = Vec::new();
    let mut look = |file: &Path, paragraphs: Vec<(usize, String)>| {
        for (line, paragraph) in paragraphs {
            for word in found_words(&paragraph, &banned) {
                found.push(format!("{}:{line}: {word}", name(file)));
            }
        }
    };
    for file in files(&[".md"]) {
        look(&file, prose(&read(&file)));
    }
    for file in files(&[".yaml", ".msg", ".srv"]) {
        // Definitions of other packages have their own words.
        let own = ["config/", "docs/", "msg/"];
        if own.iter().any(|folder| name(&file).starts_with(folder)) {
            look(&file, comments(&read(&file)));
        }
    }
    assert!(
        found.is_empty(),
        "words that docs/glossary.md leaves out, by paragraph:\n{}",
        found.join("\n")
    );
}

/// The search finds a word in prose and over the end of a line, and neither in code nor in quotations.
#[test]
fn words_are_found_in_prose_alone() {
    let banned = ["still".to_owned(), "so much".to_owned(), "he".to_owned()];
    let all = |text: &str| {
        let found = prose(text);
        let words = found.iter().flat_map(|(_, paragraph)| found_words(paragraph, &banned));
        words.map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(all("It is still here, and So\nmuch more."), ["still", "so much"]);
    assert_eq!(all("| he | says |"), ["he"]);
    let exempt = "The model stands still. `still` and \"so much\".\n\n    he codes\n\n```\nstill\n```\nThe theory.";
    assert_eq!(all(exempt), [""; 0]);
    assert_eq!(found_words(&comments("key: 1  # he is\nhe: 2")[0].1, &banned), ["he"]);
}
