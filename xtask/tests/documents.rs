//! Documents keep to their width, words and figures, and the files, links and functions that they name exist.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Most characters of a line; tables, links and what a command writes may be longer.
const WIDTH: usize = 120;
/// Sections that a command writes are between such lines.
const WRITTEN: &str = "<!-- flexdrill bench";
/// Folders that are not the repository's own.
const FOREIGN: [&str; 5] = ["target", ".git", ".venv", ".venv-peers", "node_modules"];
/// First folders of a path that is meant from the repository's root.
const ROOTS: [&str; 10] = [
    ".ci",
    "benches",
    "config",
    "crates",
    "docs",
    "launch_scripts",
    "msg",
    "src",
    "tests",
    "xtask",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn files(extensions: &[&str]) -> Vec<PathBuf> {
    fn add(folder: &Path, extensions: &[&str], found: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if path.is_dir() && !FOREIGN.contains(&name.as_str()) {
                add(&path, extensions, found);
            } else if extensions.iter().any(|extension| name.ends_with(extension)) {
                found.push(path);
            }
        }
    }
    let mut found = Vec::new();
    add(&root(), extensions, &mut found);
    assert!(!found.is_empty());
    found
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

fn name(path: &Path) -> String {
    path.strip_prefix(root()).unwrap_or(path).display().to_string()
}

/// The line with addresses and the targets of links taken out.
fn without_links(line: &str) -> String {
    let mut out = String::new();
    let mut rest = line;
    while let Some((text, target)) = rest.split_once("](") {
        out.push_str(text);
        rest = target.split_once(')').map_or("", |(_, rest)| rest);
    }
    out.push_str(rest);
    out.split(' ')
        .filter(|word| !word.contains("://"))
        .collect::<Vec<_>>()
        .join(" ")
}

/// What stands between backticks, outside of code blocks.
fn code(text: &str) -> Vec<&str> {
    let mut fenced = false;
    text.lines()
        .filter(|line| {
            fenced ^= line.trim_start().starts_with("```");
            !fenced && !line.trim_start().starts_with("```")
        })
        .flat_map(|line| line.split('`').skip(1).step_by(2))
        .collect()
}

#[test]
fn lines_are_no_wider_than_a_page() {
    let mut wide = Vec::new();
    for file in files(&[".md", ".cff"]) {
        let (mut written, mut fenced) = (false, false);
        for (number, line) in read(&file).lines().enumerate() {
            if line.starts_with(WRITTEN) {
                written = !line.contains(": end");
            }
            fenced ^= line.trim_start().starts_with("```");
            let free = written || fenced || line.trim_start().starts_with('|');
            if !free && without_links(line).chars().count() > WIDTH {
                wide.push(format!("{}:{}", name(&file), number + 1));
            }
        }
    }
    assert!(wide.is_empty(), "wider than {WIDTH} characters:\n{}", wide.join("\n"));
}

#[test]
fn links_lead_somewhere() {
    let mut broken = Vec::new();
    for file in files(&[".md"]) {
        let text = read(&file);
        for link in text
            .split("](")
            .skip(1)
            .filter_map(|rest| Some(rest.split_once(')')?.0))
        {
            let (path, heading) = link.split_once('#').unwrap_or((link, ""));
            if path.contains("://") {
                continue;
            }
            let target = if path.is_empty() {
                file.clone()
            } else {
                file.parent().unwrap_or(Path::new("")).join(path)
            };
            let there = target.exists() && (heading.is_empty() || headings(&read(&target)).contains(heading));
            if !there {
                broken.push(format!("{}: {link}", name(&file)));
            }
        }
    }
    assert!(broken.is_empty(), "links to nowhere:\n{}", broken.join("\n"));
}

/// Anchors of a document's headings.
fn headings(text: &str) -> BTreeSet<String> {
    text.lines()
        .filter_map(|line| line.strip_prefix('#'))
        .map(|line| {
            let title = line.trim_start_matches('#').trim().to_lowercase().replace(' ', "-");
            title
                .chars()
                .filter(|c| c.is_alphanumeric() || "-_".contains(*c))
                .collect()
        })
        .collect()
}

/// Documents that speak of the present, and not of what was (changelog, history) or of other projects' files.
fn present_documents() -> Vec<PathBuf> {
    let past = |path: &PathBuf| path.ends_with("CHANGELOG.md") || name(path).starts_with("docs/history/");
    let foreign = |path: &PathBuf| path.components().any(|part| part.as_os_str() == "upstream");
    let all = files(&[".md"]).into_iter();
    all.filter(|path| !past(path) && !foreign(path)).collect()
}

/// Endings of the repository's own files.
const ENDINGS: [&str; 10] = [
    ".rs", ".yaml", ".md", ".py", ".sh", ".msg", ".toml", ".ts", ".csv", ".json",
];
/// Files that the program writes for a user.
const WRITTEN_FILES: [&str; 23] = [
    // by `flexdrill ahead`
    "surveys.csv",
    "metadata.yaml",
    "report.md",
    "findings.csv",
    "reach.csv",
    "reach_plausible.csv",
    "sweep.json",
    "points.csv",
    "map.csv",
    "map.json",
    "envelope_x.csv",
    "envelope_y.csv",
    // by `flexdrill calibrate`
    "overlay.yaml",
    "posterior.csv",
    "calibrated.yaml",
    "calibration.json",
    "sensitivity.csv",
    "sensitivity.json",
    "ahead.csv",
    // by `flexdrill trip`
    "trip.csv",
    "stuck.csv",
    "reached.csv",
    // by `flexdrill bridge wits --look`
    "site.yaml",
];

#[test]
fn files_that_are_named_exist() {
    let there: Vec<String> = files(&ENDINGS).iter().map(|file| name(file)).collect();
    let mut missing = Vec::new();
    for file in present_documents() {
        let text = read(&file);
        for path in code(&text) {
            let named = path.split(' ').next().unwrap_or_default().trim_start_matches("./");
            let first = named.split('/').next().unwrap_or_default();
            let plain = named.chars().all(|c| c.is_alphanumeric() || "/._-".contains(c));
            let from_root = named.contains('/') && plain && ROOTS.contains(&first);
            // A file may be named without its folders, but then it is one of the repository's.
            let ending = ENDINGS
                .iter()
                .any(|ending| named.len() > ending.len() && named.ends_with(ending));
            let short = plain && ending && !named.starts_with('/') && !WRITTEN_FILES.contains(&named);
            let known = || {
                there
                    .iter()
                    .any(|path| path == named || path.ends_with(&format!("/{named}")))
            };
            if (from_root && !root().join(named).exists()) || (short && !from_root && !known()) {
                missing.push(format!("{}: {path}", name(&file)));
            }
        }
    }
    assert!(missing.is_empty(), "named and not there:\n{}", missing.join("\n"));
}

/// The source without its comments: what only a comment names is not there.
fn without_comments(source: &str) -> String {
    source
        .lines()
        .map(|line| line.split_once("//").map_or(line, |(code, _)| code))
        .collect::<Vec<_>>()
        .join("\n")
}

fn words(source: &str) -> impl Iterator<Item = &str> {
    source
        .split(|c: char| !c.is_alphanumeric() && c != '_')
        .filter(|word| !word.is_empty())
}

/// Names that the sources define after one of these keywords.
fn defined(sources: &[String], keywords: &[&str]) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for source in sources {
        let mut before = "";
        for word in words(source) {
            if keywords.contains(&before) {
                found.insert(word.to_owned());
            }
            before = word;
        }
    }
    found
}

fn sources() -> Vec<String> {
    files(&[".rs"])
        .iter()
        .map(|file| without_comments(&read(file)))
        .collect()
}

#[test]
fn functions_and_types_that_are_named_exist() {
    let sources = sources();
    let words: BTreeSet<&str> = sources.iter().flat_map(|source| words(source)).collect();
    let types = defined(&sources, &["struct", "enum", "trait", "type"]);
    let mut missing = Vec::new();
    // Reports to other projects name what is theirs.
    let own = files(&[".md"])
        .into_iter()
        .filter(|file| !name(file).starts_with("docs/upstream/"));
    for file in own {
        let text = read(&file);
        let glossary = file.ends_with("docs/glossary.md");
        for item in code(&text) {
            let path = item.contains("::") && item.chars().all(|c| c.is_alphanumeric() || "_:".contains(c));
            let carries = glossary
                && item.starts_with(char::is_uppercase)
                && item.chars().any(char::is_lowercase)
                && item.chars().all(|c| c.is_alphanumeric() || c == '_');
            let known = !path || item.split("::").all(|word| words.contains(word));
            if !known || (carries && !types.contains(item)) {
                missing.push(format!("{}: {item}", name(&file)));
            }
        }
    }
    assert!(missing.is_empty(), "named and not there:\n{}", missing.join("\n"));
}

/// Beginnings of the names of test files.
const TESTS: [&str; 9] = [
    "analytic_",
    "mechanics_",
    "paper_",
    "replay_",
    "property_",
    "interop_",
    "crash_",
    "network_",
    "no_alloc",
];
/// A name of so many words is a sentence, as tests have them.
const SENTENCE: usize = 6;

#[test]
fn tests_that_are_named_exist() {
    let functions = defined(&sources(), &["fn"]);
    let stems: BTreeSet<String> = files(&[".rs"])
        .iter()
        .flat_map(|file| [file.file_stem(), file.parent().and_then(Path::file_name)])
        .flatten()
        .map(|stem| stem.to_string_lossy().into_owned())
        .collect();
    let mut missing = Vec::new();
    for file in present_documents() {
        let text = read(&file);
        for item in code(&text) {
            let plain = item.contains('_')
                && item
                    .chars()
                    .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
            let test = TESTS.iter().any(|begin| item.starts_with(begin)) || item.split('_').count() >= SENTENCE;
            // A key with a compound unit has as many words: `slew_m_per_h_per_s`.
            let key = item.contains("_per_");
            if plain && test && !key && !item.ends_with('_') && !functions.contains(item) && !stems.contains(item) {
                missing.push(format!("{}: {item}", name(&file)));
            }
        }
    }
    assert!(missing.is_empty(), "named and not there:\n{}", missing.join("\n"));
}

/// Rows that the page of a rig's inputs has at least.
const SHAPES: usize = 40;

#[test]
fn every_shape_of_a_rigs_inputs_has_a_source_and_a_test() {
    let functions = defined(&sources(), &["fn"]);
    let page = read(&root().join("docs/rig_inputs.md"));
    let mut shapes = 0;
    for line in page.lines().filter(|line| line.starts_with("| ")) {
        // Code between backticks may have the mark of a column: no row of this page has it.
        let cells: Vec<&str> = line.trim_matches('|').split(" | ").map(str::trim).collect();
        assert_eq!(
            cells.len(),
            5,
            "shape, who, source, what the program does, test: {line}"
        );
        assert!(cells.iter().all(|cell| !cell.is_empty()), "{line}");
        if cells[0] == "shape" {
            continue;
        }
        let mut named = code(cells[4]).into_iter().filter(|name| functions.contains(*name));
        assert!(cells[4] == "the same" || named.next().is_some(), "no test: {line}");
        shapes += 1;
    }
    assert!(shapes >= SHAPES, "{shapes} shapes");
}

#[test]
fn the_guide_names_every_test_binary_of_the_program() {
    let guide = read(&root().join("CONTRIBUTING.md"));
    let named: BTreeSet<&str> = code(&guide).into_iter().collect();
    let entries = std::fs::read_dir(root().join("tests")).unwrap();
    let missing: Vec<String> = entries
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.join("main.rs").is_file() || path.extension().is_some_and(|extension| extension == "rs"))
        .map(|path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned())
        .filter(|binary| !named.contains(binary.as_str()))
        .collect();
    assert!(missing.is_empty(), "CONTRIBUTING.md does not name {missing:?}");
}

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

/// The number before `after` in a text.
fn number_before(text: &str, after: &str) -> f64 {
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let before = text.split(after).next().filter(|before| before.len() < text.len());
    let word = before
        .and_then(|before| before.split(' ').next_back())
        .unwrap_or_default();
    word.parse()
        .unwrap_or_else(|_| panic!("no number before {after:?}: {word:?}"))
}

/// The cells of the first row of a table that begins so, behind a heading.
fn row<'a>(text: &'a str, heading: &str, begin: &str) -> Vec<&'a str> {
    let (_, section) = text.split_once(heading).unwrap_or_else(|| panic!("no {heading:?}"));
    let row = section.lines().find(|line| line.starts_with(begin));
    let row = row.unwrap_or_else(|| panic!("no row {begin:?} behind {heading:?}"));
    row.split('|').map(str::trim).collect()
}

/// Figures that stand in two documents are the same figure, as rounded as the text has it.
#[test]
fn figures_that_stand_in_two_documents_agree() {
    let measured = read(&root().join("docs/measurements.md"));
    let parse = |cell: &str| cell.parse::<f64>().unwrap_or_else(|_| panic!("{cell:?} is no number"));
    let agree = |place: &str, shown: f64, figure: f64, unit: f64| {
        assert!(
            (shown - figure).abs() <= 0.5 * unit + 1e-9,
            "{place} says {shown}, docs/measurements.md {figure}"
        );
    };
    let readme = read(&root().join("README.md"));
    let real_time = row(&measured, "<!-- flexdrill bench real-time", "| as it is, 10 kN |");
    let whole = parse(real_time[2]);
    agree(
        "README.md",
        number_before(&readme, " times faster than real time with whole steps"),
        whole,
        1.0,
    );
    let mechanics = read(&root().join("docs/mechanics.md"));
    let cost = number_before(&mechanics, " times the time, not twice");
    agree(
        "README.md",
        number_before(&readme, " times faster with the half steps"),
        whole / cost,
        1.0,
    );

    let simd = read(&root().join("docs/decisions/own_simd.md"));
    let instructions = row(&measured, "`portable` |", "| as it is, 10 kN |");
    for (column, after) in [(2, " with AVX-512,"), (3, " with AVX2 and"), (4, " with portable code")] {
        agree(
            "own_simd.md",
            number_before(&simd, after),
            parse(instructions[column]),
            0.1,
        );
    }
    let comparison = read(&root().join("docs/comparison.md"));
    let ours = row(&comparison, "## The same tool", "| flexdrill |");
    let peers = row(&measured, "## The same tool in EXUDYN", "| real-time factor");
    agree("comparison.md", parse(ours[4]), parse(peers[3]), 0.1);
}

#[test]
fn every_page_is_in_the_summary() {
    let summary = read(&root().join("docs/SUMMARY.md"));
    let pages = files(&[".md"]);
    let missing: Vec<String> = pages
        .iter()
        .filter_map(|page| name(page).strip_prefix("docs/").map(str::to_owned))
        .filter(|page| page != "SUMMARY.md" && !summary.contains(&format!("]({page})")))
        .collect();
    assert!(missing.is_empty(), "not in docs/SUMMARY.md: {missing:?}");
}

/// What a page of `docs/effects/` says, in this order; a picture of a run is not there for every effect.
const OF_AN_EFFECT: [&str; 6] = [
    "## Law",
    "## Keys",
    "## Size",
    "## Closed form",
    "## Cost",
    "## Left out",
];

#[test]
fn every_page_of_an_effect_has_the_same_sections_and_is_in_their_list() {
    let folder = root().join("docs/effects");
    let list = read(&folder.join("README.md"));
    let pages: Vec<PathBuf> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    assert!(pages.len() > 10, "{} pages", pages.len());
    for page in pages.iter().filter(|page| !page.ends_with("README.md")) {
        let text = read(page);
        let found: Vec<&str> = text.lines().filter(|line| OF_AN_EFFECT.contains(line)).collect();
        assert_eq!(found, OF_AN_EFFECT, "{}", name(page));
        let file = page.file_name().unwrap().to_string_lossy().into_owned();
        assert!(
            list.contains(&format!("]({file})")),
            "{file} is not in docs/effects/README.md"
        );
    }
}

/// Lines of text that a reader sees before the first picture: one screen.
const SCREEN: usize = 40;

#[test]
fn the_readme_fits_a_screen_before_its_first_picture() {
    let readme = read(&root().join("README.md"));
    let before = readme.lines().take_while(|line| !line.starts_with("![")).count();
    assert!(before <= SCREEN, "{before} lines");
    assert!(before < readme.lines().count(), "no picture");
}

#[test]
fn every_crate_has_a_row_in_the_architecture() {
    let page = read(&root().join("docs/architecture.md"));
    let crates = std::fs::read_dir(root().join("crates")).unwrap();
    let names = crates.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned());
    let missing: Vec<String> = names
        .filter(|name| name.starts_with("flexdrill"))
        .filter(|name| !page.lines().any(|line| line.starts_with(&format!("| `{name}` |"))))
        .collect();
    assert!(missing.is_empty(), "no row in docs/architecture.md: {missing:?}");
}

/// The string literals of a source of Rust or TypeScript, without what is filled in between braces.
fn literals(source: &str) -> String {
    let source = source.replace("'\"'", "").replace("'`'", "");
    let mut chars = source.chars().peekable();
    let (mut out, mut quote, mut braces) = (String::new(), None, 0_u32);
    while let Some(c) = chars.next() {
        match (quote, c) {
            // A comment ends with its line.
            (None, '/') if chars.peek() == Some(&'/') => while chars.next_if(|c| *c != '\n').is_some() {},
            (None, '"' | '`') => quote = Some(c),
            (None, _) => {}
            (Some(_), '\\') => match chars.next() {
                Some('\n') => while chars.next_if(|c| c.is_whitespace()).is_some() {},
                Some('n') => out.push(' '),
                Some(escaped) if braces == 0 => out.push(escaped),
                _ => {}
            },
            (Some(_), '{') => braces += 1,
            (Some(_), '}') => braces = braces.saturating_sub(1),
            (Some(_), _) if braces > 0 => {}
            (Some(open), c) if c == open => {
                quote = None;
                out.push('\n');
            }
            (Some(_), c) => out.push(c),
        }
    }
    out
}

/// Least length of a part of a message by which it is recognised.
const RECOGNISED: usize = 12;

/// Every message that the page on troubleshooting quotes is one that a source has, in one of its parts at least.
#[test]
fn messages_of_the_page_on_troubleshooting_exist() {
    let own = |path: &PathBuf| !name(path).contains("/dist/");
    let code = files(&[".rs", ".ts"]).into_iter().filter(own);
    let mut sources: Vec<String> = code.map(|file| literals(&read(&file))).collect();
    sources.extend(files(&[".sh", ".mjs", ".py"]).iter().map(|file| read(file)));
    sources.push(read(&root().join(".ci/run")));
    let page = read(&root().join("docs/troubleshooting.md"));
    let (before, symptoms) = page.split_once("## Missing data").unwrap();
    // Symptoms are what other programs show.
    let after = symptoms.split_once("\n## ").unwrap().1;
    let mut missing = Vec::new();
    let mut rows = 0;
    for row in before
        .lines()
        .chain(after.lines())
        .filter(|line| line.starts_with("| `"))
    {
        let quoted = row.split(" | ").next().unwrap_or_default();
        let spans = quoted.split('`').skip(1).step_by(2);
        let parts: Vec<&str> = spans
            .flat_map(|span| span.split("..."))
            .flat_map(|part| part.split(|c: char| c.is_ascii_digit() || ":;".contains(c)))
            .map(str::trim)
            .filter(|part| part.len() >= RECOGNISED)
            .collect();
        rows += 1;
        let known = |part: &&str| sources.iter().any(|source| source.contains(*part));
        if !parts.is_empty() && !parts.iter().any(known) {
            missing.push(quoted);
        }
    }
    assert!(rows > 100, "{rows}");
    assert!(
        missing.is_empty(),
        "no source has these messages:\n{}",
        missing.join("\n")
    );
}

/// The checks find what they are for.
#[test]
fn names_in_comments_do_not_count() {
    let source = "// struct Gone; fn gone() {}\nstruct Here; // enum Also\nfn a_test() {}\n";
    let sources = [without_comments(source)];
    assert_eq!(
        defined(&sources, &["struct", "enum"]),
        BTreeSet::from(["Here".to_owned()])
    );
    assert_eq!(defined(&sources, &["fn"]), BTreeSet::from(["a_test".to_owned()]));
}
