"""ROS 2 message types for Cyclone DDS, made at run time from the .msg, .srv and .action files of this repository.

Nothing of the Rust code is used: what is decoded here shows that the bytes on the wire are what the definitions say.
"""

import dataclasses
import pathlib
import re

from cyclonedds.idl import IdlStruct, annotations, types

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXTERNAL = ROOT / "crates" / "flexdrill-messages" / "external"

PRIMITIVES = {
    "bool": bool,
    "byte": types.uint8,
    "char": types.uint8,
    "uint8": types.uint8,
    "int8": types.int8,
    "uint16": types.uint16,
    "int16": types.int16,
    "uint32": types.uint32,
    "int32": types.int32,
    "uint64": types.uint64,
    "int64": types.int64,
    "float32": types.float32,
    "float64": types.float64,
    "string": str,
}
ZERO = {bool: False, str: ""}
_made = {}
_elements = {}
_fields = {}


def _definition(package, kind, name):
    """The text of a definition: of a service the half, of an action the part or what ROS 2 makes of it."""
    half = None
    if kind == "action":
        action, part = name.split("_", 1)
        made = {
            "SendGoal_Request": f"unique_identifier_msgs/UUID goal_id\n{package}/action/{action}_Goal goal",
            "SendGoal_Response": "bool accepted\nbuiltin_interfaces/Time stamp",
            "GetResult_Request": "unique_identifier_msgs/UUID goal_id",
            "GetResult_Response": f"int8 status\n{package}/action/{action}_Result result",
            "FeedbackMessage": f"unique_identifier_msgs/UUID goal_id\n{package}/action/{action}_Feedback feedback",
        }
        if part in made:
            return made[part]
        file = ROOT / "msg" / f"{action}.action"
        if package != "flexdrill":
            file = EXTERNAL / package / "action" / f"{action}.action"
        parts = re.split(r"^---$", file.read_text(), flags=re.M)
        return parts[["Goal", "Result", "Feedback"].index(part)]
    if kind == "srv":
        name, half = name.rsplit("_", 1)
    own = ROOT / "msg" / f"{name}.{kind}"
    foreign = EXTERNAL / package / kind / f"{name}.{kind}"
    text = (own if package == "flexdrill" else foreign).read_text()
    if half:
        parts = re.split(r"^---$", text, flags=re.M)
        text = parts[0 if half == "Request" else 1]
    return text


def _element(text, package):
    """Type and zero of a field's element."""
    text = re.sub(r"<=\d+$", "", text)
    if text in PRIMITIVES:
        kind = PRIMITIVES[text]
        if kind in ZERO:
            return kind, ZERO[kind]
        return kind, 0.0 if text.startswith("float") else 0
    if text.count("/") == 2:
        made = make(text)
        return made, made
    if "/" in text:
        other, name = text.split("/")
    else:
        other, name = package, text
    made = make(f"{other}/msg/{name}")
    return made, made


def make(ros_type):
    """The Cyclone type of `package/msg/Name` or `package/srv/Name_Request`."""
    if ros_type in _made:
        return _made[ros_type]
    package, kind, name = ros_type.split("/")
    fields, elements = [], {}
    for line in _definition(package, kind, name).splitlines():
        line = line.split("#")[0].strip()
        words = line.split()
        if len(words) < 2 or "=" in line.split('"')[0].replace("<=", ""):
            continue
        match = re.fullmatch(r"([\w/]+(?:<=\d+)?)(?:\[(<=)?(\d*)\])?", words[0])
        base, bounded, count = match.group(1), match.group(2), match.group(3)
        element, zero = _element(base, package)
        elements[words[1]] = element
        if count is None:
            default = dataclasses.field(default_factory=zero) if isinstance(zero, type) else zero
            fields.append((words[1], element, default))
        elif count and not bounded:
            size = int(count)
            fields.append((words[1], types.array[element, size], dataclasses.field(default_factory=lambda z=zero, n=size: [z] * n)))
        else:
            fields.append((words[1], types.sequence[element], dataclasses.field(default_factory=list)))
    if not fields:
        fields.append(("structure_needs_at_least_one_member", types.uint8, 0))
    made = _finish(f"{package}::{kind}::dds_::{name}_", name, fields)
    _fields[made] = (fields, elements)
    _elements.update({(made, field): element for field, element in elements.items()})
    _made[ros_type] = made
    return made


def short(ros_type):
    """A type of the same name on the wire that is one byte long: what a program of another version may send."""
    key = ("short", ros_type)
    if key not in _made:
        package, kind, name = ros_type.split("/")
        _made[key] = _finish(f"{package}::{kind}::dds_::{name}_", f"{name}Short", [("byte", types.uint8, 0)])
    return _made[key]


def with_cyclone_header(ros_type):
    """The same with the 16 bytes that rmw_cyclonedds puts before a request or reply."""
    key = ("header", ros_type)
    if key not in _made:
        package, kind, name = ros_type.split("/")
        fields, elements = _fields[make(ros_type)]
        header = [("client_id", types.uint64, 0), ("sequence", types.int64, 0)]
        made = _finish(f"{package}::{kind}::dds_::{name}_", f"{name}WithHeader", header + fields)
        _elements.update({(made, field): element for field, element in elements.items()})
        _made[key] = made
    return _made[key]


def _finish(dds_name, name, fields):
    meta = type(IdlStruct)
    namespace = meta.__prepare__(name, (IdlStruct,), typename=dds_name)
    namespace["__module__"] = __name__
    for field, kind, default in fields:
        namespace["__annotations__"][field] = kind
        namespace[field] = default
    return annotations.final(dataclasses.dataclass(meta(name, (IdlStruct,), namespace)))


def to_plain(value):
    """A message as dictionaries and lists."""
    if dataclasses.is_dataclass(value):
        return {field.name: to_plain(getattr(value, field.name)) for field in dataclasses.fields(value)}
    if isinstance(value, (list, tuple)):
        return [to_plain(item) for item in value]
    if isinstance(value, (bytes, bytearray)):
        return list(value)
    return value


def from_plain(made, plain):
    """A message of a type from dictionaries and lists; what is left out is zero."""
    message = made()
    for field in dataclasses.fields(made):
        if field.name not in plain:
            continue
        value = plain[field.name]
        current = getattr(message, field.name)
        if dataclasses.is_dataclass(current):
            value = from_plain(type(current), value)
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            value = [from_plain(_elements[made, field.name], item) for item in value]
        setattr(message, field.name, value)
    return message
