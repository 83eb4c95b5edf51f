//! All definitions of the repository: our own messages and services in `msg/`, the foreign ones that we use in
//! `crates/flexdrill-messages/external/`.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::definition::{Array, Base, Definition, Field, FieldType, Primitive, Source, TypeName};
use super::{GenerateError, parser};

/// Folder of our own messages and services, from the repository's root.
const OWN: &str = "msg";
/// Folder of the foreign messages, from the repository's root.
const EXTERNAL: &str = "crates/flexdrill-messages/external";
/// Our package.
const PACKAGE: &str = "flexdrill";

/// Definitions by name.
#[derive(Debug, Clone, Default)]
pub struct Catalogue {
    definitions: BTreeMap<TypeName, Definition>,
    services: BTreeMap<TypeName, Service>,
    actions: BTreeMap<TypeName, Definition>,
}

/// A service as ROS 2 describes it: a type whose fields are what a request, a reply and an event of it carry.
#[derive(Debug, Clone)]
pub struct Service {
    /// `std_srvs/srv/Trigger`.
    pub whole: Definition,
    /// `std_srvs/srv/Trigger_Event`.
    pub event: Definition,
}

impl Catalogue {
    /// Reads every definition below the repository's `root`.
    ///
    /// # Errors
    /// When a folder or file cannot be read, a definition cannot be parsed, or names a message that is not there.
    pub fn read(root: &Path) -> Result<Self, GenerateError> {
        let mut catalogue = Self::default();
        catalogue.read_folder(root, PACKAGE, OWN)?;
        for package in entries(&root.join(EXTERNAL))? {
            let name = file_name(&package);
            for kind in entries(&package)? {
                let folder = format!("{EXTERNAL}/{name}/{}", file_name(&kind));
                catalogue.read_folder(root, &name, &folder)?;
            }
        }
        for definition in catalogue.definitions.values() {
            catalogue.dependencies(definition)?;
        }
        Ok(catalogue)
    }

    fn read_folder(&mut self, root: &Path, package: &str, folder: &str) -> Result<(), GenerateError> {
        for path in entries(&root.join(folder))? {
            let text = std::fs::read_to_string(&path).map_err(|source| GenerateError::Read {
                path: path.clone(),
                source,
            })?;
            let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let extension = path.extension().unwrap_or_default().to_string_lossy().into_owned();
            let file = format!("{folder}/{}", file_name(&path));
            let (kind, added) = match extension.as_str() {
                "msg" => ("msg", self.add_message(package, &stem, &text, Source::File(file))),
                "srv" => ("srv", self.add_service(package, &stem, &text, Source::File(file))),
                "action" => ("action", self.add_action(package, &stem, &text, Source::File(file))),
                _ => continue,
            };
            added.map_err(|source| GenerateError::Parse { path, kind, source })?;
        }
        Ok(())
    }

    /// Adds one message from its text.
    ///
    /// # Errors
    /// When it cannot be parsed.
    pub fn add_message(
        &mut self,
        package: &str,
        name: &str,
        text: &str,
        source: Source,
    ) -> Result<(), parser::ParseError> {
        let definition = parser::parse(TypeName::message(package, name), text, source, 1)?;
        self.definitions.insert(definition.name.clone(), definition);
        Ok(())
    }

    /// Adds a service and both halves of it from its text.
    ///
    /// # Errors
    /// When it cannot be parsed.
    pub fn add_service(
        &mut self,
        package: &str,
        name: &str,
        text: &str,
        source: Source,
    ) -> Result<(), parser::ParseError> {
        let lines: Vec<&str> = text.lines().collect();
        let Some(cut) = lines.iter().position(|line| line.trim() == "---") else {
            return Err(parser::ParseError {
                line: lines.len(),
                problem: "a service needs a line `---` between request and response".to_owned(),
            });
        };
        for (half, part, first_line) in [("Request", &lines[..cut], 1), ("Response", &lines[cut + 1..], cut + 2)] {
            let text: String = part.iter().flat_map(|line| [*line, "\n"]).collect();
            let type_name = TypeName {
                package: package.to_owned(),
                kind: "srv",
                name: format!("{name}_{half}"),
            };
            let definition = parser::parse(type_name, &text, Source::Text, first_line)?;
            self.definitions.insert(definition.name.clone(), definition);
        }
        let service = Service::new(package, "srv", name, text, source);
        self.services.insert(service.whole.name.clone(), service);
        Ok(())
    }

    /// Adds an action from its text: goal, result and feedback, the services and the message that carry them, and the
    /// action as a whole.
    ///
    /// # Errors
    /// When it cannot be parsed.
    pub fn add_action(
        &mut self,
        package: &str,
        name: &str,
        text: &str,
        source: Source,
    ) -> Result<(), parser::ParseError> {
        // Lines are counted, because errors must name the line of the file and not that of a part.
        let lines: Vec<&str> = text.lines().collect();
        let cuts: Vec<usize> = (0..lines.len()).filter(|&line| lines[line].trim() == "---").collect();
        let [first, second] = cuts[..] else {
            return Err(parser::ParseError {
                line: lines.len(),
                problem: "an action needs two lines `---`: between goal and result, and before the feedback".to_owned(),
            });
        };
        let part = |part: &str| TypeName {
            package: package.to_owned(),
            kind: "action",
            name: format!("{name}_{part}"),
        };
        // Each part begins with its line in the file.
        let parts = [
            ("Goal", &lines[..first], 1),
            ("Result", &lines[first + 1..second], first + 2),
            ("Feedback", &lines[second + 1..], second + 2),
        ];
        // The parts come first. The carriers below refer to them.
        for (kind, lines, first_line) in parts {
            let text: String = lines.iter().flat_map(|line| [*line, "\n"]).collect();
            let definition = parser::parse(part(kind), &text, Source::Text, first_line)?;
            self.definitions.insert(definition.name.clone(), definition);
        }
        // What ROS 2 makes of every action.
        let id = TypeName::message("unique_identifier_msgs", "UUID");
        let single = |kind: Primitive| FieldType {
            base: Base::Primitive(kind),
            array: Array::Single,
        };
        let time = TypeName::message("builtin_interfaces", "Time");
        // Names, fields and their order are fixed by rosidl: the type hashes are formed over them.
        let carriers = [
            (
                "SendGoal_Request",
                vec![nested("goal_id", id.clone()), nested("goal", part("Goal"))],
            ),
            (
                "SendGoal_Response",
                vec![plain("accepted", single(Primitive::Bool)), nested("stamp", time)],
            ),
            ("GetResult_Request", vec![nested("goal_id", id.clone())]),
            (
                "GetResult_Response",
                vec![
                    plain("status", single(Primitive::Int8)),
                    nested("result", part("Result")),
                ],
            ),
            (
                "FeedbackMessage",
                vec![nested("goal_id", id), nested("feedback", part("Feedback"))],
            ),
        ];
        for (kind, fields) in carriers {
            // The text of a carrier exists nowhere as a file, so it is written as rosidl writes it.
            let text: String = fields.iter().map(written).collect();
            let definition = made_of(part(kind), fields, &text, Source::Text);
            self.definitions.insert(definition.name.clone(), definition);
        }
        // Only two services have types of the action; cancelling has one type for all actions.
        for service in ["SendGoal", "GetResult"] {
            let service = Service::new(package, "action", &format!("{name}_{service}"), "", Source::Text);
            self.services.insert(service.whole.name.clone(), service);
        }
        // The action as a whole has a hash too, which ROS 2 announces.
        let whole = TypeName {
            name: name.to_owned(),
            ..part("")
        };
        let fields = vec![
            nested("goal", part("Goal")),
            nested("result", part("Result")),
            nested("feedback", part("Feedback")),
            nested("send_goal_service", part("SendGoal")),
            nested("get_result_service", part("GetResult")),
            nested("feedback_message", part("FeedbackMessage")),
        ];
        self.actions.insert(whole.clone(), made_of(whole, fields, text, source));
        Ok(())
    }

    /// All services, sorted by name.
    pub fn services(&self) -> impl Iterator<Item = &Service> {
        self.services.values()
    }

    /// All actions, sorted by name.
    pub fn actions(&self) -> impl Iterator<Item = &Definition> {
        self.actions.values()
    }

    /// All definitions, sorted by name.
    pub fn iter(&self) -> impl Iterator<Item = &Definition> {
        self.definitions.values()
    }

    /// The definition of that name.
    pub fn get(&self, name: &TypeName) -> Option<&Definition> {
        self.definitions.get(name)
    }

    /// Every message that `definition` is made of, directly or not, once each, in the order of first use.
    ///
    /// # Errors
    /// When one of them is not in the catalogue, or messages contain each other.
    pub fn dependencies(&self, definition: &Definition) -> Result<Vec<&Definition>, GenerateError> {
        let mut found = Vec::new();
        let mut seen = BTreeSet::new();
        self.collect(definition, &mut vec![definition.name.clone()], &mut seen, &mut found)?;
        Ok(found)
    }

    fn collect<'a>(
        &'a self,
        definition: &Definition,
        path: &mut Vec<TypeName>,
        seen: &mut BTreeSet<TypeName>,
        found: &mut Vec<&'a Definition>,
    ) -> Result<(), GenerateError> {
        for name in definition.nested() {
            if path.contains(name) {
                return Err(GenerateError::Recursive(name.to_string()));
            }
            let of_service = || {
                self.services
                    .values()
                    .flat_map(|service| [&service.whole, &service.event])
                    .find(|part| part.name == *name)
            };
            let nested = self
                .definitions
                .get(name)
                .or_else(of_service)
                .ok_or_else(|| GenerateError::UnknownType {
                    name: name.to_string(),
                    used_in: definition.name.to_string(),
                })?;
            if seen.insert(name.clone()) {
                found.push(nested);
                path.push(name.clone());
                self.collect(nested, path, seen, found)?;
                path.pop();
            }
        }
        Ok(())
    }
}

impl Service {
    /// `kind` is that of the interface: `srv`, or `action` for the services of one.
    fn new(package: &str, kind: &'static str, name: &str, text: &str, source: Source) -> Self {
        let type_name = |name: String| TypeName {
            package: package.to_owned(),
            kind,
            name,
        };
        let part = |part: &str| type_name(format!("{name}_{part}"));
        let up_to_one = |name: &str, of: TypeName| {
            let kind = FieldType {
                base: Base::Nested(of),
                array: Array::Bounded(1),
            };
            plain(name, kind)
        };
        let of_event = vec![
            nested("info", TypeName::message("service_msgs", "ServiceEventInfo")),
            up_to_one("request", part("Request")),
            up_to_one("response", part("Response")),
        ];
        let of_whole = vec![
            nested("request_message", part("Request")),
            nested("response_message", part("Response")),
            nested("event_message", part("Event")),
        ];
        Self {
            whole: made_of(type_name(name.to_owned()), of_whole, text, source),
            event: made_of(part("Event"), of_event, "", Source::Text),
        }
    }
}

/// A field without comment and default.
fn plain(name: &str, kind: FieldType) -> Field {
    Field {
        docs: Vec::new(),
        name: name.to_owned(),
        kind,
        default: None,
    }
}

/// A field that is another type.
fn nested(name: &str, of: TypeName) -> Field {
    let kind = FieldType {
        base: Base::Nested(of),
        array: Array::Single,
    };
    plain(name, kind)
}

fn made_of(name: TypeName, fields: Vec<Field>, text: &str, source: Source) -> Definition {
    Definition {
        name,
        docs: Vec::new(),
        constants: Vec::new(),
        fields,
        text: text.to_owned(),
        source,
    }
}

/// The line that declares a single field.
fn written(field: &Field) -> String {
    let kind = match &field.kind.base {
        Base::Nested(name) => name.short(),
        Base::Primitive(Primitive::Bool) => "bool".to_owned(),
        Base::Primitive(kind) => format!("{kind:?}").to_lowercase(),
    };
    format!("{kind} {}\n", field.name)
}

/// Entries of a folder, sorted, so that the output does not depend on the file system.
fn entries(folder: &Path) -> Result<Vec<PathBuf>, GenerateError> {
    let read = |source| GenerateError::Read {
        path: folder.to_owned(),
        source,
    };
    let mut paths = std::fs::read_dir(folder)
        .map_err(read)?
        .map(|entry| entry.map(|entry| entry.path()).map_err(read))
        .collect::<Result<Vec<_>, _>>()?;
    paths.sort();
    Ok(paths)
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
