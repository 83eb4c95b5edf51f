//! Documents agree with each other and with what they describe.

use super::*;

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
