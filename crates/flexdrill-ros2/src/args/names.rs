//! ROS 2 names: what is allowed, how relative and private names become absolute, and remapping rules.

use super::ArgsError;

/// Namespace and name of a node in the graph.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NodeIdentity {
    /// Absolute namespace: `/` or `/a/b`.
    pub namespace: String,
    /// Name without slashes.
    pub name: String,
}

impl NodeIdentity {
    /// A checked identity. `namespace` may lack its leading slash.
    ///
    /// # Errors
    /// When one of the two is not a valid name.
    pub fn new(namespace: &str, name: &str) -> Result<Self, ArgsError> {
        check_token(name).map_err(|problem| ArgsError::Name {
            what: "node name",
            name: name.to_owned(),
            problem,
        })?;
        Ok(Self {
            namespace: normal_namespace(namespace)?,
            name: name.to_owned(),
        })
    }

    /// `/a/b/name`.
    pub fn full_name(&self) -> String {
        join(&self.namespace, &self.name)
    }

    /// Makes a topic or service name absolute: `~/x` is private to the node, `x` relative to its namespace.
    ///
    /// # Errors
    /// When the name has a character or form that ROS 2 does not allow.
    pub fn expand(&self, name: &str) -> Result<String, ArgsError> {
        let wrong = |problem| ArgsError::Name {
            what: "topic or service name",
            name: name.to_owned(),
            problem,
        };
        let absolute = if name == "~" {
            self.full_name()
        } else if let Some(private) = name.strip_prefix("~/") {
            join(&self.full_name(), private)
        } else if name.starts_with('/') {
            name.to_owned()
        } else {
            join(&self.namespace, name)
        };
        for token in absolute[1..].split('/') {
            check_token(token).map_err(wrong)?;
        }
        Ok(absolute)
    }
}

fn join(namespace: &str, name: &str) -> String {
    if namespace == "/" {
        format!("/{name}")
    } else {
        format!("{namespace}/{name}")
    }
}

/// Makes a namespace absolute and checks it.
///
/// # Errors
/// When it is not a valid ROS 2 namespace.
pub fn normal_namespace(namespace: &str) -> Result<String, ArgsError> {
    let trimmed = namespace.strip_prefix('/').unwrap_or(namespace);
    if trimmed.is_empty() {
        return Ok("/".into());
    }
    for token in trimmed.split('/') {
        check_token(token).map_err(|problem| ArgsError::Name {
            what: "namespace",
            name: namespace.to_owned(),
            problem,
        })?;
    }
    Ok(format!("/{trimmed}"))
}

/// Why ROS 2 does not allow a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NameProblem {
    /// The name or a part between two slashes is empty.
    #[error("it is empty or has an empty part between two slashes")]
    Empty,
    /// A part begins with a digit or another character that is not allowed there.
    #[error("a part must begin with a letter or underscore, not '{0}'")]
    Begin(char),
    /// A character within a part is not allowed.
    #[error("'{0}' is not allowed; use letters, digits, underscores and slashes")]
    Character(char),
    /// Reserved by ROS 2.
    #[error("two underscores in a row are not allowed")]
    Underscores,
}

/// Checks one part of a name.
fn check_token(token: &str) -> Result<(), NameProblem> {
    let mut characters = token.chars();
    match characters.next() {
        None => return Err(NameProblem::Empty),
        Some(c) if c.is_ascii_alphabetic() || c == '_' => {}
        Some(c) => return Err(NameProblem::Begin(c)),
    }
    if let Some(bad) = characters.find(|c| !(c.is_ascii_alphanumeric() || *c == '_')) {
        return Err(NameProblem::Character(bad));
    }
    if token.contains("__") {
        return Err(NameProblem::Underscores);
    }
    Ok(())
}

/// Which names a rule is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scheme {
    /// Topics and services.
    Any,
    /// `rostopic://`.
    Topic,
    /// `rosservice://`.
    Service,
}

/// One remapping rule for a topic or service name, `[node:]from:=to`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RemapRule {
    /// Only for the node of this name.
    pub node: Option<String>,
    /// For topics, services or both.
    pub scheme: Scheme,
    /// Name to replace, as written.
    pub from: String,
    /// Replacement, as written.
    pub to: String,
}

/// Rules in the order given; the first that matches is used.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Remapping {
    pub(super) rules: Vec<RemapRule>,
    /// `__node:=`, with an optional node prefix.
    pub(super) node_names: Vec<(Option<String>, String)>,
    /// `__ns:=`, with an optional node prefix.
    pub(super) namespaces: Vec<(Option<String>, String)>,
}

impl Remapping {
    /// The identity of a node whose name and namespace would be these without rules.
    ///
    /// # Errors
    /// When the result is not a valid name.
    pub fn identity(&self, namespace: &str, name: &str) -> Result<NodeIdentity, ArgsError> {
        let pick = |rules: &[(Option<String>, String)]| {
            rules
                .iter()
                .find(|(node, _)| node.as_deref().is_none_or(|node| node == name))
                .map(|(_, to)| to.clone())
        };
        let new_namespace = pick(&self.namespaces);
        let new_name = pick(&self.node_names);
        NodeIdentity::new(
            new_namespace.as_deref().unwrap_or(namespace),
            new_name.as_deref().unwrap_or(name),
        )
    }

    /// The absolute name that a node's topic gets. `original_name` is the node's name before remapping.
    ///
    /// # Errors
    /// When a name involved is not valid.
    pub fn topic(&self, identity: &NodeIdentity, original_name: &str, topic: &str) -> Result<String, ArgsError> {
        self.apply(Scheme::Topic, identity, original_name, topic)
    }

    /// The absolute name that a node's service gets.
    ///
    /// # Errors
    /// When a name involved is not valid.
    pub fn service(&self, identity: &NodeIdentity, original_name: &str, service: &str) -> Result<String, ArgsError> {
        self.apply(Scheme::Service, identity, original_name, service)
    }

    fn apply(&self, scheme: Scheme, identity: &NodeIdentity, original: &str, name: &str) -> Result<String, ArgsError> {
        let absolute = identity.expand(name)?;
        for rule in &self.rules {
            let for_node = rule
                .node
                .as_deref()
                .is_none_or(|node| node == original || node == identity.name);
            let for_kind = rule.scheme == Scheme::Any || rule.scheme == scheme;
            if for_node && for_kind && identity.expand(&rule.from)? == absolute {
                return identity.expand(&rule.to);
            }
        }
        Ok(absolute)
    }
}

/// Reads `[node:]from:=to` into the remapping.
///
/// # Errors
/// When the rule has no `:=` or a side is missing or invalid.
pub(super) fn read_rule(text: &str, into: &mut Remapping) -> Result<(), ArgsError> {
    let wrong = |why: &str| ArgsError::Rule {
        rule: text.to_owned(),
        why: why.to_owned(),
    };
    let (left, to) = text.split_once(":=").ok_or_else(|| wrong("there is no ':=' in it"))?;
    // An empty name would remap everything or nothing.
    if to.is_empty() || left.is_empty() {
        return Err(wrong("a side of ':=' is empty"));
    }
    // The scheme comes before the node's prefix, whose colon is the first one after it.
    let (scheme, left) = if let Some(rest) = left.strip_prefix("rostopic://") {
        (Scheme::Topic, rest)
    } else if let Some(rest) = left.strip_prefix("rosservice://") {
        (Scheme::Service, rest)
    } else {
        (Scheme::Any, left)
    };
    let (node, from) = match left.split_once(':') {
        Some((node, from)) => (Some(node.to_owned()), from),
        None => (None, left),
    };
    if let Some(node) = &node {
        check_token(node).map_err(|why| wrong(&format!("node prefix '{node}': {why}")))?;
    }
    // A rule with a wildcard that was taken literally would silently not apply.
    if from.contains('*') || to.contains('\\') {
        return Err(wrong(
            "wildcards in remapping are not supported; write one rule per name",
        ));
    }
    match from {
        // Special names set the node's identity and are no rules on topics.
        "__node" | "__name" => {
            check_token(to).map_err(|problem| wrong(&problem.to_string()))?;
            into.node_names.push((node, to.to_owned()));
        }
        "__ns" => {
            if !to.starts_with('/') {
                return Err(wrong("a namespace must begin with '/'"));
            }
            into.namespaces.push((node, normal_namespace(to)?));
        }
        _ => {
            // Both sides are expanded with any node, only to find invalid names at the start and not at the first use.
            let probe = NodeIdentity {
                namespace: "/".into(),
                name: "node".into(),
            };
            probe.expand(from)?;
            probe.expand(to)?;
            into.rules.push(RemapRule {
                node,
                scheme,
                from: from.to_owned(),
                to: to.to_owned(),
            });
        }
    }
    Ok(())
}
