//! Which line of the file every key stands on, so that a range error can name it.

use std::fmt;

use serde::Deserialize;
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};
use serde_saphyr::Spanned;

/// A YAML document reduced to its keys and where their values stand.
#[derive(Debug, Default)]
pub struct Lines {
    entries: Vec<Entry>,
}

#[derive(Debug)]
struct Entry {
    key: String,
    line: u64,
    column: u64,
}

impl Lines {
    /// Of `text`; empty if it is not YAML, which the typed reading then reports.
    pub fn of(text: &str) -> Self {
        let mut lines = Self::default();
        if let Ok(tree) = Self::tree(text) {
            lines.collect(String::new(), &tree);
        }
        lines
    }

    /// Why `text` is not YAML; `None` where it is.
    pub(crate) fn fault(text: &str) -> Option<serde_saphyr::Error> {
        Self::tree(text).err()
    }

    fn tree(text: &str) -> Result<Spanned<Tree>, serde_saphyr::Error> {
        let options = serde_saphyr::options! {
            non_finite_float_policy: serde_saphyr::NonFiniteFloatPolicy::AsString,
            alias_limits: crate::reading::alias_limits(),
        };
        serde_saphyr::from_str_with_options(text, options)
    }

    fn collect(&mut self, key: String, node: &Spanned<Tree>) {
        let child = |name: &str| {
            if key.is_empty() {
                name.to_string()
            } else {
                format!("{key}.{name}")
            }
        };
        match &node.value {
            Tree::Leaf => {}
            Tree::Map(entries) => {
                for (name, value) in entries {
                    let path = child(&name.value);
                    self.entries.push(Entry {
                        key: path.clone(),
                        line: name.referenced.line(),
                        column: name.referenced.column(),
                    });
                    self.collect(path, value);
                }
            }
            Tree::List(items) => {
                for (index, value) in items.iter().enumerate() {
                    let path = child(&index.to_string());
                    self.entries.push(Entry {
                        key: path.clone(),
                        line: value.referenced.line(),
                        column: value.referenced.column(),
                    });
                    self.collect(path, value);
                }
            }
        }
    }

    /// Line of `key`, and whether it is the key itself rather than its nearest enclosing key.
    pub fn find(&self, key: &str) -> (Option<u64>, bool) {
        let mut part = key;
        loop {
            if let Some(entry) = self.entries.iter().find(|entry| entry.key == part) {
                return (Some(entry.line), part == key);
            }
            match part.rfind('.') {
                Some(dot) => part = &part[..dot],
                None => return (None, false),
            }
        }
    }

    /// Whether `key` is written in the file.
    pub fn has(&self, key: &str) -> bool {
        self.place(key).is_some()
    }

    /// Line and column of `key`.
    pub fn place(&self, key: &str) -> Option<(u64, u64)> {
        let entry = self.entries.iter().find(|entry| entry.key == key)?;
        Some((entry.line, entry.column))
    }

    /// The last key that begins at or before a place in the file; empty if none.
    pub fn key_at(&self, line: u64, column: u64) -> &str {
        self.entries
            .iter()
            .filter(|entry| (entry.line, entry.column) <= (line, column))
            .max_by_key(|entry| (entry.line, entry.column))
            .map_or("", |entry| &entry.key)
    }
}

#[derive(Debug)]
enum Tree {
    Leaf,
    Map(Vec<(Spanned<String>, Spanned<Tree>)>),
    List(Vec<Spanned<Tree>>),
}

impl<'de> Deserialize<'de> for Tree {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(TreeVisitor)
    }
}

struct TreeVisitor;

impl<'de> Visitor<'de> for TreeVisitor {
    type Value = Tree;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("any YAML value")
    }

    fn visit_bool<E>(self, _: bool) -> Result<Tree, E> {
        Ok(Tree::Leaf)
    }

    fn visit_i64<E>(self, _: i64) -> Result<Tree, E> {
        Ok(Tree::Leaf)
    }

    fn visit_u64<E>(self, _: u64) -> Result<Tree, E> {
        Ok(Tree::Leaf)
    }

    fn visit_f64<E>(self, _: f64) -> Result<Tree, E> {
        Ok(Tree::Leaf)
    }

    fn visit_i128<E>(self, _: i128) -> Result<Tree, E> {
        Ok(Tree::Leaf)
    }

    fn visit_u128<E>(self, _: u128) -> Result<Tree, E> {
        Ok(Tree::Leaf)
    }

    fn visit_str<E>(self, _: &str) -> Result<Tree, E> {
        Ok(Tree::Leaf)
    }

    fn visit_unit<E>(self) -> Result<Tree, E> {
        Ok(Tree::Leaf)
    }

    fn visit_none<E>(self) -> Result<Tree, E> {
        Ok(Tree::Leaf)
    }

    fn visit_some<D: Deserializer<'de>>(self, deserializer: D) -> Result<Tree, D::Error> {
        Tree::deserialize(deserializer)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Tree, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = seq.next_element()? {
            items.push(item);
        }
        Ok(Tree::List(items))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Tree, A::Error> {
        let mut entries = Vec::new();
        while let Some(entry) = map.next_entry()? {
            entries.push(entry);
        }
        Ok(Tree::Map(entries))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_lists_and_flow_maps_have_their_lines() {
        let lines = Lines::of("a:\n  b: 1\n  c: [1, 2]\nd:\n  - e: {f: .nan}\n  - 3\n");
        assert_eq!(lines.find("a.b"), (Some(2), true));
        assert_eq!(lines.find("a.c.1"), (Some(3), true));
        assert_eq!(lines.find("d.0.e.f"), (Some(5), true));
        assert_eq!(lines.find("d.1"), (Some(6), true));
        assert_eq!(lines.find("d.1.x"), (Some(6), false));
        assert_eq!(lines.find("x"), (None, false));
        assert_eq!(lines.key_at(2, 6), "a.b");
    }

    /// Anybody may write a configuration, or send one. Five lines stand for a hundred thousand values here, which took
    /// part of a second to read, and another line makes it ten times as many.
    #[test]
    fn aliases_that_repeat_one_another_are_not_expanded() {
        let text = |levels: usize| {
            let mut text = "a0: &a0 [0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\n".to_owned();
            for level in 1..levels {
                let last = format!("*a{}", level - 1);
                text += &format!("a{level}: &a{level} [{}]\n", vec![last; 10].join(", "));
            }
            text
        };
        assert!(Lines::of(&text(2)).has("a1.9.9"));
        assert!(!Lines::of(&text(5)).has("a0"));
    }
}
