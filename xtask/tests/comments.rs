//! Long functions have comments that say why, at each phase.
//!
//! A function is long from [`LONG`] lines between its braces on. A comment line of it is a line with `//`, alone or after
//! code; doc comments (`///`, `//!`) stand outside and do not count. A function within another counts for both.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Lines of a body from which on the function is long.
const LONG: usize = 40;
/// Least share of comment lines in all long functions together.
const LEAST_SHARE: f64 = 0.06;
/// Folders of product sources below which every function counts; `crates/*/src` and `xtask/*/src` are added.
const SOURCES: [&str; 2] = ["src", "xtask/src"];
/// Changed foreign code, whose comments are its authors'.
const FOREIGN: &str = "crates/rustdds";
/// How a generated file begins.
const GENERATED: &str = "//! Generated from";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// A long function.
#[derive(Debug, PartialEq, Eq)]
struct Function {
    name: String,
    /// Line of its name, counted from 1.
    line: usize,
    lines: usize,
    comments: usize,
}

/// A source without its strings, characters and comments, which may hold braces and words of code.
struct Code {
    /// As long as the source; what was taken out is blank, so that positions and lines remain.
    text: Vec<u8>,
    /// Lines with a plain comment, counted from 0.
    comments: BTreeSet<usize>,
}

impl Code {
    fn of(source: &str) -> Self {
        let bytes = source.as_bytes();
        let mut code = Self {
            text: bytes.to_vec(),
            comments: BTreeSet::new(),
        };
        let (mut at, mut line) = (0, 0);
        while at < bytes.len() {
            let rest = &bytes[at..];
            let end = at + special(rest, at > 0 && is_word(bytes[at - 1])).unwrap_or(0);
            if end == at {
                line += usize::from(bytes[at] == b'\n');
                at += 1;
                continue;
            }
            if is_plain_comment(rest) {
                let more = count_lines(&bytes[at..end]);
                code.comments.extend(line..=line + more);
            }
            line += count_lines(&bytes[at..end]);
            for byte in code.text[at..end].iter_mut().filter(|byte| **byte != b'\n') {
                *byte = b' ';
            }
            at = end;
        }
        code
    }

    /// The position after the bracket that closes the one at `open`.
    fn after_block(&self, open: usize) -> usize {
        let mut depth = 0;
        for (at, byte) in self.text.iter().enumerate().skip(open) {
            match byte {
                b'{' => depth += 1,
                b'}' if depth == 1 => return at + 1,
                b'}' => depth -= 1,
                _ => {}
            }
        }
        self.text.len()
    }

    /// The position of the brace that opens a body after `from`; `None` for a declaration without one.
    fn body(&self, from: usize) -> Option<usize> {
        let mut depth = 0;
        for (at, byte) in self.text.iter().enumerate().skip(from) {
            match byte {
                // A semicolon or brace within brackets belongs to a type: `[f64; 3]`, `[f64; { N }]`.
                b'(' | b'[' => depth += 1,
                b')' | b']' => depth -= 1,
                b'{' if depth == 0 => return Some(at),
                b';' if depth == 0 => return None,
                _ => {}
            }
        }
        None
    }

    /// Positions of a text.
    fn all<'a>(&'a self, wanted: &'a [u8]) -> impl Iterator<Item = usize> + 'a {
        let starts = self.text.windows(wanted.len()).enumerate();
        starts.filter(move |(_, text)| *text == wanted).map(|(at, _)| at)
    }

    /// What is compiled for tests only.
    fn of_tests(&self) -> Vec<std::ops::Range<usize>> {
        let attributes = self.all(b"#[cfg(test").chain(self.all(b"#[cfg(all(test"));
        attributes
            .map(|at| {
                let after = at + self.text[at..].iter().position(|byte| *byte == b']').unwrap_or(0) + 1;
                let end = self.body(after).map_or(after, |open| self.after_block(open));
                at..end
            })
            .collect()
    }

    /// Names of modules that are compiled for tests only and have separate files.
    fn modules_of_tests(&self) -> Vec<String> {
        let starts = self.of_tests().into_iter();
        let declared = starts.filter_map(|range| {
            let after = self.text.get(range.end..)?;
            let item = String::from_utf8_lossy(&after[..after.iter().position(|byte| *byte == b';')?]).into_owned();
            let name = item.split_whitespace().collect::<Vec<_>>();
            match name[..] {
                [.., "mod", name] => Some(name.to_owned()),
                _ => None,
            }
        });
        declared.collect()
    }

    fn line(&self, at: usize) -> usize {
        count_lines(&self.text[..at])
    }
}

fn count_lines(bytes: &[u8]) -> usize {
    bytes.iter().filter(|byte| **byte == b'\n').count()
}

fn is_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

fn is_plain_comment(rest: &[u8]) -> bool {
    match rest {
        [b'/', b'/', b'!', ..] | [b'/', b'*', b'!' | b'*', ..] => false,
        // Four slashes are no doc comment.
        [b'/', b'/', b'/', next, ..] => *next == b'/',
        [b'/', b'/' | b'*', ..] => true,
        _ => false,
    }
}

/// Length of the comment, string or character with which `rest` begins. In a word (`after_word`) no prefix of a string
/// begins.
fn special(rest: &[u8], after_word: bool) -> Option<usize> {
    let until = |end: &[u8], from: usize| {
        let found = rest[from..].windows(end.len()).position(|text| text == end);
        found.map_or(rest.len(), |at| from + at + end.len())
    };
    match rest {
        [b'/', b'/', ..] => Some(rest.iter().position(|byte| *byte == b'\n').unwrap_or(rest.len())),
        [b'/', b'*', ..] => Some(block_comment(rest)),
        [b'"', ..] => Some(quoted(rest)),
        [b'\'', ..] => character(rest),
        [b'r' | b'b' | b'c', ..] if !after_word => {
            let prefix = rest
                .iter()
                .take_while(|byte| matches!(byte, b'b' | b'c' | b'r'))
                .count();
            let hashes = rest[prefix..].iter().take_while(|byte| **byte == b'#').count();
            let is_raw = rest[..prefix].contains(&b'r');
            match rest.get(prefix + hashes) {
                Some(b'"') if is_raw => {
                    let end = [&b"\""[..], &vec![b'#'; hashes]].concat();
                    Some(until(&end, prefix + hashes + 1))
                }
                Some(b'"') if hashes == 0 => Some(prefix + quoted(&rest[prefix..])),
                _ => None,
            }
        }
        _ => None,
    }
}

/// Block comments nest.
fn block_comment(rest: &[u8]) -> usize {
    let (mut depth, mut at) = (0, 0);
    while at < rest.len() {
        match &rest[at..] {
            [b'/', b'*', ..] => (depth, at) = (depth + 1, at + 2),
            [b'*', b'/', ..] => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            break;
        }
    }
    at
}

fn quoted(rest: &[u8]) -> usize {
    let mut at = 1;
    while at < rest.len() && rest[at] != b'"' {
        at += if rest[at] == b'\\' { 2 } else { 1 };
    }
    (at + 1).min(rest.len())
}

/// A quote begins a character if another one follows a single character or an escape; otherwise it is a lifetime.
fn character(rest: &[u8]) -> Option<usize> {
    if rest.get(1) == Some(&b'\\') {
        let end = rest.iter().skip(3).position(|byte| *byte == b'\'')?;
        return Some(end + 4);
    }
    let text = std::str::from_utf8(rest.get(1..5.min(rest.len()))?);
    let valid = match &text {
        Ok(text) => text,
        // A character of several bytes may be cut at the end.
        Err(error) => std::str::from_utf8(&rest[1..1 + error.valid_up_to()]).ok()?,
    };
    let length = valid.chars().next()?.len_utf8();
    (rest.get(1 + length) == Some(&b'\'')).then_some(length + 2)
}

/// The long functions of a source that are compiled into the product.
fn long_functions(source: &str) -> Vec<Function> {
    let code = Code::of(source);
    let tests = code.of_tests();
    let names = code.all(b"fn ").filter(|at| *at == 0 || !is_word(code.text[at - 1]));
    names
        .filter(|at| !tests.iter().any(|range| range.contains(at)))
        .filter_map(|at| {
            let name: Vec<u8> = code.text[at + 3..]
                .iter()
                .copied()
                .take_while(|byte| is_word(*byte))
                .collect();
            let open = code.body(at + 3 + name.len())?;
            let [first, last] = [open, code.after_block(open) - 1].map(|at| code.line(at));
            let lines = (last - first).saturating_sub(1);
            (lines >= LONG && !name.is_empty()).then(|| Function {
                name: String::from_utf8(name).unwrap(),
                line: code.line(at) + 1,
                lines,
                comments: code.comments.range(first..=last).count(),
            })
        })
        .collect()
}

/// All product sources with their text.
fn sources() -> Vec<(String, String)> {
    fn add(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if path.is_dir() && name != "tests" {
                add(&path, found);
            } else if name.ends_with(".rs") && name != "tests.rs" {
                found.push(path);
            }
        }
    }
    let mut folders: Vec<PathBuf> = SOURCES.iter().map(|folder| root().join(folder)).collect();
    for above in ["crates", "xtask"] {
        for entry in std::fs::read_dir(root().join(above)).unwrap() {
            folders.push(entry.unwrap().path().join("src"));
        }
    }
    let mut found = Vec::new();
    for folder in folders.iter().filter(|folder| folder.is_dir()) {
        if !folder.starts_with(root().join(FOREIGN)) {
            add(folder, &mut found);
        }
    }
    found.sort();
    let texts: Vec<(PathBuf, String)> = found
        .into_iter()
        .map(|path| {
            let text = std::fs::read_to_string(&path).unwrap();
            (path, text)
        })
        .collect();
    let of_tests: Vec<PathBuf> = texts.iter().flat_map(|(path, text)| test_modules(path, text)).collect();
    texts
        .into_iter()
        .filter(|(path, text)| !text.starts_with(GENERATED) && !of_tests.iter().any(|module| path.starts_with(module)))
        .map(|(path, text)| (path.strip_prefix(root()).unwrap().display().to_string(), text))
        .collect()
}

/// Files and folders of the modules that a file declares for tests only.
fn test_modules(path: &Path, text: &str) -> Vec<PathBuf> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let folder = match stem.as_str() {
        "lib" | "main" | "mod" => path.parent().unwrap().to_owned(),
        _ => path.with_extension(""),
    };
    let modules = Code::of(text).modules_of_tests().into_iter();
    modules
        .flat_map(|name| [folder.join(format!("{name}.rs")), folder.join(name)])
        .collect()
}

/// The crate, or the room of `src/`, that a file belongs to.
fn room(file: &str) -> String {
    match file.split('/').collect::<Vec<_>>()[..] {
        ["src", room, ..] => format!("src/{room}"),
        ["crates", name, ..] => name.to_owned(),
        ["xtask", "src", ..] => "xtask".to_owned(),
        ["xtask", name, ..] => format!("xtask/{name}"),
        _ => file.to_owned(),
    }
}

/// Counts of a room.
#[derive(Default)]
struct Counts {
    functions: usize,
    lines: usize,
    comments: usize,
    without: usize,
}

impl Counts {
    fn add(&mut self, function: &Function) {
        self.functions += 1;
        self.lines += function.lines;
        self.comments += function.comments;
        self.without += usize::from(function.comments == 0);
    }

    fn share(&self) -> f64 {
        self.comments as f64 / self.lines.max(1) as f64
    }

    fn print(&self, name: &str) {
        println!(
            "| {name} | {} | {} | {:.1} % | {} |",
            self.functions,
            self.lines,
            100.0 * self.share(),
            self.without
        );
    }
}

#[test]
fn long_functions_say_why() {
    let (mut rooms, mut whole) = (BTreeMap::<String, Counts>::new(), Counts::default());
    let (mut all, mut without) = (Vec::new(), Vec::new());
    let sources = sources();
    assert!(sources.len() > 400, "{} sources", sources.len());
    for (file, text) in &sources {
        for function in long_functions(text) {
            rooms.entry(room(file)).or_default().add(&function);
            whole.add(&function);
            let Function {
                name,
                line,
                lines,
                comments,
            } = &function;
            let row = format!("{file}:{line} {name}, {lines} lines, {comments} comments");
            if *comments == 0 {
                without.push(row.clone());
            }
            all.push((*comments as f64 / *lines as f64, row));
        }
    }
    println!("| room | functions of {LONG} lines or more | lines | comments | without any |\n|---|---|---|---|---|");
    for (name, counts) in &rooms {
        counts.print(name);
    }
    whole.print("whole");
    assert!(whole.functions > 100, "{} functions", whole.functions);
    assert!(
        without.is_empty(),
        "functions of {LONG} lines or more need comments that say why, at each phase; without any:\n{}",
        without.join("\n")
    );
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let least: Vec<&str> = all.iter().take(20).map(|(_, row)| row.as_str()).collect();
    assert!(
        whole.share() >= LEAST_SHARE,
        "{:.2} % of the lines of long functions are comments, at least {} % are asked for; those with the fewest:\n{}",
        100.0 * whole.share(),
        100.0 * LEAST_SHARE,
        least.join("\n")
    );
}

/// A function of `lines` lines with a body that begins with these.
fn function(head: &str, body: &[&str], lines: usize) -> String {
    let filling = vec!["    x += 1;"; lines - body.len()];
    format!("{head} {{\n{}\n{}\n}}\n", body.join("\n"), filling.join("\n"))
}

#[test]
fn the_scanner_counts_bodies_and_plain_comments() {
    let found = |source: &str| {
        let functions = long_functions(source);
        functions
            .into_iter()
            .map(|f| (f.name, f.line, f.lines, f.comments))
            .collect::<Vec<_>>()
    };
    let short = function("fn short()", &["    // Why."], LONG - 1);
    assert_eq!(found(&short), []);
    // Alone, after code, in two lines; not in documentation or in a string.
    let comments = [
        "    // One.",
        "    x += 1; // Two.",
        "    // Three,",
        "    // and its end.",
        "    /// Documents an item.",
        "    x = \"// no comment\";",
    ];
    let long = function(
        "/// Doc.\npub(crate) fn long<'a, const N: usize>(x: [f64; 3]) -> &'a str",
        &comments,
        LONG,
    );
    assert_eq!(found(&long), [("long".to_owned(), 2, LONG, 4)]);
    // Braces and quotes in strings, raw strings, characters and lifetimes.
    let traps = [
        "    a = \"}\\\"}\";",
        "    b = r#\"}\"}\"#;",
        "    c = '}'; d = '\\''; e = '\\u{7d}'; f = b'}'; g = b\"}\"; h = br\"\\\";",
        "    let i: &'static str = \"\"; 'outer: loop {}",
        "    j = '\u{e9}'; /* } // */",
        "    k = \"over",
        "} lines\";",
    ];
    let trapped = function("fn trapped()", &traps, LONG);
    assert_eq!(found(&(trapped + &short)), [("trapped".to_owned(), 1, LONG, 1)]);
    // Declarations, pointers to functions and what is compiled for tests have no body here.
    let tests = format!("#[cfg(test)]\nmod tests {{\n{}}}\n", function("fn test()", &[], LONG));
    let others = format!("trait T {{ fn declared(&self); }}\ntype P = fn(f64);\n{tests}{long}");
    assert_eq!(found(&others).len(), 1);
    let declared =
        "#[cfg(test)]\nmod witness;\n#[cfg(test)]\n#[path = \"x.rs\"]\npub(crate) mod other;\nmod product;\n";
    assert_eq!(Code::of(declared).modules_of_tests(), ["witness", "other"]);
    let files = test_modules(Path::new("src/lib.rs"), declared);
    assert!(files.contains(&PathBuf::from("src/witness")), "{files:?}");
    // An inner function counts for itself and for the outer one.
    let inner = function("fn inner()", &["    // Why."], LONG);
    let outer = format!("fn outer() {{\n{inner}}}\n");
    let names: Vec<String> = found(&outer).into_iter().map(|(name, ..)| name).collect();
    assert_eq!(names, ["outer", "inner"]);
}
