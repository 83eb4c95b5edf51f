"""Files of JSON that the program writes, read with checks: what is wrong is said with file, value, bound and remedy."""

from __future__ import annotations

import errno
import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Optional, Union, cast

import numpy as np
import numpy.typing as npt

from ._errors import ResultFileError
from ._groups import CountArray, FloatArray

PathLike = Union[str, "os.PathLike[str]"]
Array = npt.NDArray[Any]
TextArray = npt.NDArray[np.str_]
FlagArray = npt.NDArray[np.bool_]

SWEEP_FORMAT = 3
"""The format of plans and results of points that this version reads: `FORMAT` of flexdrill-sweep."""
MAP_FORMAT = 2
"""The format of maps that this version reads: `FORMAT` of flexdrill-map."""
PRIORITIES = ("low", "medium", "high")
"""Names of the priorities of alarms, rising: the last axis of counts of alarms."""
QUANTILES = (0.05, 0.5, 0.95)
"""The last axis of figures."""
MOST_MEMBERS = 10_000
MOST_TEXT = 4096


class Entry:
    """An object of a file of JSON whose values are checked as they are read."""

    def __init__(self, file: Path, remedy: str, value: object, place: str = "") -> None:
        self.file, self.remedy, self.place = file, remedy, place
        if not isinstance(value, dict):
            raise self.wrong("", value, "an object")
        self.values = cast("dict[str, Any]", value)

    def wrong(self, name: str, value: object, bound: str) -> ResultFileError:
        """The error of a value."""
        said = ascii(value)
        said = said if len(said) <= 60 else said[:57] + "..."
        place = ".".join(part for part in (self.place, name) if part) or "the content"
        return ResultFileError(str(self.file), f"{place} = {said}: must be {bound}", self.remedy)

    def _get(self, name: str, bound: str) -> Any:
        if name not in self.values:
            raise self.wrong(name, None, f"{bound}; it is missing")
        return self.values[name]

    def text(self, name: str, among: Optional[Sequence[str]] = None, most: int = MOST_TEXT) -> str:
        """A text, one of `among` where given."""
        bound = f"a text of at most {most} characters" if among is None else f"one of {', '.join(among)}"
        value = self._get(name, bound)
        if not isinstance(value, str) or len(value) > most or (among is not None and value not in among):
            raise self.wrong(name, value, bound)
        return value

    def count(self, name: str, least: int = 0, most: int = 2**63 - 1) -> int:
        """A whole number."""
        value = self._get(name, "a whole number")
        if type(value) is not int or not least <= value <= most:
            raise self.wrong(name, value, f"a whole number of {least} to {most}")
        return value

    def number(self, name: str, least: float = -np.inf, most: float = np.inf) -> float:
        """A finite number."""
        return self._number(name, self._get(name, "a number"), least, most)

    def maybe(self, name: str, least: float = -np.inf, most: float = np.inf) -> float:
        """A finite number, or NaN where the file has null."""
        value = self._get(name, "a number or null")
        return np.nan if value is None else self._number(name, value, least, most)

    def flag(self, name: str, missing: Optional[bool] = None) -> bool:
        """A truth value; `missing` where the file has none, if it may have none."""
        if missing is not None and name not in self.values:
            return missing
        value = self._get(name, "true or false")
        if not isinstance(value, bool):
            raise self.wrong(name, value, "true or false")
        return value

    def items(self, name: str, count: Optional[int] = None, most: int = 1_000_000) -> list[Any]:
        """A list, of `count` values where given."""
        bound = f"a list of at most {most} values" if count is None else f"a list of {count} values"
        value = self._get(name, bound)
        if not isinstance(value, list):
            raise self.wrong(name, value, bound)
        found = list(cast("Sequence[Any]", value))
        if len(found) > most or (count is not None and len(found) != count):
            raise self.wrong(name, f"{len(found)} values", bound)
        return found

    def numbers(self, name: str, count: Optional[int] = None, most: int = 1_000_000) -> FloatArray:
        """A list of finite numbers."""
        found = [self._number(f"{name}.{at}", value) for at, value in enumerate(self.items(name, count, most))]
        return np.array(found, dtype=np.float64)

    def texts(self, name: str, among: Optional[Sequence[str]] = None) -> list[str]:
        """A list of texts, each one of `among` where given."""
        found = self.items(name)
        for at, value in enumerate(found):
            if not isinstance(value, str) or len(value) > MOST_TEXT or (among is not None and value not in among):
                bound = f"a text of at most {MOST_TEXT} characters" if among is None else f"one of {', '.join(among)}"
                raise self.wrong(f"{name}.{at}", value, bound)
        return found

    def lists(self, name: str, width: int) -> list[list[Any]]:
        """A list of lists of `width` values."""
        found = self.items(name)
        for at, value in enumerate(cast("list[object]", found)):
            if not isinstance(value, list) or len(cast("Sequence[Any]", value)) != width:
                raise self.wrong(f"{name}.{at}", found[at], f"a list of {width} values")
        return found

    def entry(self, name: str) -> Entry:
        """An object in this one."""
        return Entry(self.file, self.remedy, self._get(name, "an object"), self._at(name))

    def entries(self, name: str, count: Optional[int] = None) -> list[Entry]:
        """A list of objects."""
        found = enumerate(self.items(name, count))
        return [Entry(self.file, self.remedy, value, self._at(f"{name}.{at}")) for at, value in found]

    def _at(self, name: str) -> str:
        return f"{self.place}.{name}" if self.place else name

    def _number(self, name: str, value: Any, least: float = -np.inf, most: float = np.inf) -> float:
        if type(value) not in (int, float):
            raise self.wrong(name, value, "a number")
        try:
            number = float(value)
        except OverflowError:
            number = np.inf
        if not (np.isfinite(number) and least <= number <= most):
            bounded = "a finite number" if least == -np.inf and most == np.inf else f"{least:g} to {most:g}"
            raise self.wrong(name, value, bounded)
        return number


def parse(file: Path, text: bytes, remedy: str) -> Entry:
    """The object of a file of JSON."""

    def refuse(name: str) -> object:
        raise ValueError(f"{name} is no number")

    try:
        value = json.loads(text.decode("utf-8"), parse_constant=refuse)
    # Values nested without end exhaust the parser; a text cut in the middle and wrong bytes are ValueErrors.
    except (ValueError, RecursionError) as error:
        raise ResultFileError(str(file), f"it is cut off or no JSON: {error}", remedy) from error
    return Entry(file, remedy, value)


def check_format(entry: Entry, kind: str, known: int) -> None:
    """Refuses what another version wrote, before anything else of it is read."""
    found = entry.count("format")
    if found != known:
        raise ResultFileError(
            str(entry.file),
            f"{kind} of format {found}; this version of the package reads format {known}",
            "install the version of the package that belongs to the program that wrote it, or make it again",
        )


def read_bounded(file: Path, most: int, remedy: str) -> bytes:
    """The bytes of a file of at most `most` bytes."""
    with file.open("rb") as opened:
        content = opened.read(most + 1)
    if len(content) > most:
        raise ResultFileError(str(file), f"it has more than {most} bytes", remedy)
    return content


def not_there(file: Path, how: str) -> FileNotFoundError:
    """The error of a file that the program has not written."""
    return FileNotFoundError(errno.ENOENT, f"{os.strerror(errno.ENOENT)}; {how}", str(file))


def column_of(figure: str, unit: str) -> str:
    """Name of a figure with its unit, as in `points.csv`: `stop_moment` in N m is `stop_moment_nm`."""
    if not unit:
        return figure
    return f"{figure}_{unit.lower().replace('1/', 'per_').replace('/', '_per_').replace(' ', '')}"


class Counts:
    """Counts of alarms and quantiles of figures, filled entry by entry."""

    def __init__(self, shape: tuple[int, ...]) -> None:
        self.shape = shape
        self.alarms: dict[str, CountArray] = {}
        self.figures: dict[str, FloatArray] = {}
        self.units: dict[str, str] = {}

    def declare_alarm(self, alarm: str) -> CountArray:
        """The array of an alarm, made when it is first named."""
        return self.alarms.setdefault(alarm, np.zeros((*self.shape, len(PRIORITIES)), dtype=np.uint64))

    def declare_figure(self, name: str, unit: str) -> str:
        """The column of a figure, made when it is first named."""
        column = column_of(name, unit)
        if column not in self.figures:
            self.figures[column] = np.full((*self.shape, len(QUANTILES)), np.nan)
            self.units[column] = unit
        return column

    def fill(self, at: tuple[int, ...], entry: Entry, ended: int, alarms: Optional[Sequence[str]] = None) -> None:
        """The alarms and figures of `entry`, of which `ended` members ended; the alarms among `alarms` where given."""
        for alarm in entry.entries("alarms"):
            counts = self.declare_alarm(alarm.text("alarm", alarms))
            priority = PRIORITIES.index(alarm.text("priority", PRIORITIES))
            counts[(*at, priority)] = alarm.count("seen", 1, ended)
        for figure in entry.entries("figures"):
            column = self.declare_figure(figure.text("name"), figure.text("unit"))
            if figure.values.get("quantiles") is not None:
                quantiles = figure.numbers("quantiles", len(QUANTILES))
                if np.any(np.diff(quantiles) < 0.0):
                    raise figure.wrong("quantiles", quantiles.tolist(), "rising")
                self.figures[column][at] = quantiles


def shares(seen: CountArray, ended: CountArray) -> FloatArray:
    """Members that saw an alarm over members that ended; NaN where none ended."""
    of = ended[..., np.newaxis].astype(np.float64)
    found = np.full(seen.shape, np.nan)
    np.divide(seen, of, out=found, where=of > 0.0)
    return found
