"""Bags as arrays: recordings of flexdrill, and of `ros2 bag record`.

The reader is rosbags (`pip install flexdrill[bags]`): plain Python, MCAP and SQLite, with the types that the bag itself
holds. No ROS installation is needed.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np
import numpy.typing as npt

from ._errors import ValueOutOfBounds
from ._groups import FloatArray

if TYPE_CHECKING:
    import xarray

Array = npt.NDArray[Any]


@dataclass(frozen=True)
class Messages:
    """The messages of one topic, field by field. A field is an attribute too: `messages.torque`.

    Numbers are arrays over time. A sequence of numbers that is equally long in all messages is an array of time and
    place; other fields are lists. Fields of nested messages are joined by an underscore: `header_frame_id`.
    """

    topic: str
    """Name of the topic in the bag."""
    type_name: str
    """Type of the messages."""
    time_s: FloatArray
    """Time of each message since the first of the bag, by the stamp of its header, without one by the time of
    recording."""
    stamp_ns: npt.NDArray[np.int64]
    """The same since 1970."""
    fields: Mapping[str, Union[Array, list[Any]]]
    """All fields by name."""

    def __len__(self) -> int:
        return len(self.stamp_ns)

    def __getattr__(self, name: str) -> Any:
        found = self.__dict__.get("fields", {})
        if name in found:
            return found[name]
        raise AttributeError(f"{self.__dict__.get('type_name')} has no field {name}; it has {', '.join(found)}")

    def to_xarray(self) -> xarray.Dataset:
        """The numeric fields as a dataset of xarray over time."""
        import xarray

        variables = {
            name: (["time", f"{name}_axis"][: values.ndim], values)
            for name, values in self.fields.items()
            if isinstance(values, np.ndarray) and values.ndim <= 2
        }
        return xarray.Dataset(variables, {"time": ("time", self.time_s, {"units": "s"})}, {"topic": self.topic})


@dataclass(frozen=True)
class Band:
    """A figure over plausible tools, in the SI unit of its message. NaN where the twin had no band."""

    unit: str
    """SI unit; empty for a ratio."""
    p5: FloatArray
    """5 % of the plausible tools lie below, over time."""
    p50: FloatArray
    """Half of them lie below."""
    p95: FloatArray
    """95 % of them lie below."""


@dataclass(frozen=True)
class Bands:
    """What plausible tools did: `twin/bands` by figure instead of by second."""

    time_s: FloatArray
    """End of each second since the first message of the bag."""
    members: npt.NDArray[np.int64]
    """Plausible tools that ran."""
    effective: FloatArray
    """Number of members alike that they amount to by their weights; there are bands from 8 on."""
    figures: Mapping[str, Band]
    """Bands by topic and field, such as `bit_state/torque`."""
    chances: Mapping[str, FloatArray]
    """Share of the tools in which an alarm stands, by its id; 0 where no tool has it."""

    def __getitem__(self, name: str) -> Band:
        return self.figures[name]


class Bag(Mapping[str, Messages]):
    """The topics of a bag by name. A name may leave out what stands before: `bag["twin/bit_state"]`."""

    def __init__(self, topics: Mapping[str, Messages]) -> None:
        self._topics = dict(topics)

    def __getitem__(self, name: str) -> Messages:
        found = [topic for topic in self._topics if topic == name or topic.endswith("/" + name.lstrip("/"))]
        if len(found) != 1:
            among = f"it stands for {', '.join(found)}" if found else f"the bag has {', '.join(self._topics)}"
            raise KeyError(f"{name}: {among}")
        return self._topics[found[0]]

    def __iter__(self) -> Iterator[str]:
        return iter(self._topics)

    def __len__(self) -> int:
        return len(self._topics)

    def bands(self, topic: str = "twin/bands") -> Bands:
        """The bands of plausible tools, of a run with `ensemble` in its configuration.

        Raises `KeyError` where the bag has none.
        """
        messages = self[topic]
        count = len(messages)
        figures: dict[str, Band] = {}
        chances: dict[str, FloatArray] = {}
        # By name in each second: a later version may have more figures, and a second without bands has none.
        for index, found in enumerate(messages.fields.get("bands", [])):
            for band in found:
                if band.name not in figures:
                    figures[band.name] = Band(band.unit, *(np.full(count, np.nan) for _ in range(3)))
                of = figures[band.name]
                of.p5[index], of.p50[index], of.p95[index] = band.p5, band.p50, band.p95
        for index, seen in enumerate(messages.fields.get("alarms", [])):
            for chance in seen:
                of_alarm = chances.setdefault(chance.id, np.zeros(count))
                # An alarm has a row for each priority, of this one or a higher one: the largest is that of any.
                of_alarm[index] = max(of_alarm[index], chance.probability)
        return Bands(
            messages.time_s,
            np.asarray(messages.fields.get("members", []), dtype=np.int64),
            np.asarray(messages.fields.get("effective", []), dtype=np.float64),
            figures,
            chances,
        )

    def __repr__(self) -> str:
        return f"<Bag: {', '.join(f'{name} ({len(of)})' for name, of in self._topics.items())}>"


def read_bag(path: Union[str, os.PathLike[str]], topics: Optional[Sequence[str]] = None) -> Bag:
    """Reads a bag (an MCAP file, or the folder of MCAP or SQLite that rosbag2 makes), all topics or those whose names
    end in one of `topics`.

    Raises `ImportError` without rosbags, and rosbags' errors when the bag cannot be read.
    """
    try:
        from rosbags.highlevel import AnyReader
    except ImportError as missing:
        raise ImportError("read_bag needs rosbags: pip install 'flexdrill[bags]'") from missing
    if isinstance(topics, str):
        raise ValueOutOfBounds(f"topics = {topics!r}: must be a list of names")
    with AnyReader([Path(path)]) as reader:
        wanted = [
            connection
            for connection in reader.connections
            if topics is None or any(_ends_in(connection.topic, name) for name in topics)
        ]
        kinds = {connection.topic: connection.msgtype for connection in wanted}
        found: dict[str, list[tuple[int, Any]]] = {name: [] for name in kinds}
        for connection, recorded, data in reader.messages(connections=wanted):
            message = reader.deserialize(data, connection.msgtype)
            found[connection.topic].append((_stamp(message, recorded), message))
        start = reader.start_time
    stamps = [messages[0][0] for messages in found.values() if messages]
    start = min([start, *stamps]) if stamps else start
    return Bag({name: _messages(name, kinds[name], messages, start) for name, messages in found.items()})


def _ends_in(topic: str, name: str) -> bool:
    return topic == name or topic.endswith("/" + name.lstrip("/"))


def _stamp(message: Any, recorded: int) -> int:
    header = getattr(message, "header", None)
    if header is None:
        return recorded
    return int(header.stamp.sec) * 1_000_000_000 + int(header.stamp.nanosec)


def _messages(topic: str, kind: str, messages: list[tuple[int, Any]], start: int) -> Messages:
    stamps = np.array([stamp for stamp, _ in messages], dtype=np.int64)
    columns: dict[str, list[Any]] = {}
    for _, message in messages:
        _add(columns, "", message)
    arrays = {name: _column(values) for name, values in columns.items()}
    times: FloatArray = ((stamps - start) * 1e-9).astype(np.float64)
    return Messages(topic, kind, times, stamps, arrays)


def _add(columns: dict[str, list[Any]], prefix: str, message: Any) -> None:
    for field in fields(message):
        if field.name.startswith("__"):
            continue
        value, name = getattr(message, field.name), prefix + field.name
        if is_dataclass(value):
            if name != "header_stamp":
                _add(columns, name + "_", value)
        elif not name.isupper():
            columns.setdefault(name, []).append(value)


def _column(values: list[Any]) -> Union[Array, list[Any]]:
    """An array where all values are numbers, or number sequences of one length; otherwise the list itself."""
    first = values[0]
    if isinstance(first, (bool, int, float)):
        return np.array(values)
    if isinstance(first, np.ndarray) and len({value.shape for value in values}) == 1:
        return np.stack(values)
    return values
