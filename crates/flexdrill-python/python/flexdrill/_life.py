"""Tables of `flexdrill life`: the damage of each joint by its serial number, with its band and what to do."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Optional

from ._errors import ResultFileError
from ._results_file import Entry, PathLike, not_there, read_bounded

VERDICTS = ("sound", "listed", "possible", "expected")
"""What to do with a joint, rising: nothing is due; inspect it at the next opportunity; a crack is possible; a crack is
expected."""
MOST_BYTES = 64 << 20
FORMAT = "1"
COLUMNS = "serial_number,start_ns,end_ns,configuration,place_from_bit,hours,stop_damage,link_damage"
REMEDY = "take a copy, or make it again of all recordings with flexdrill life add"
TO_95_PERCENT = 1.644853626951472


@dataclass(frozen=True)
class Damage:
    """A damage; 1 is a life. The band has the scatter of the class and of the stress concentration, and nothing else."""

    low: float
    """5 %."""
    median: float
    high: float
    """95 %."""


@dataclass(frozen=True)
class JointLife:
    """A joint over all runs of the table."""

    serial_number: str
    hours: float
    """Model time of its runs (h)."""
    runs: int
    places: tuple[int, ...]
    """Its place from the bit up in each run, the newest last."""
    stop: Damage
    """Of its stop."""
    link: Damage
    """Of the link below it, bent at its middle."""
    part: str
    """The more damaged part: `stop` or `link`."""
    verdict: str
    """One of `flexdrill.VERDICTS`."""
    hours_left: Optional[float]
    """Hours at its mean rate until the 95 % of the damage is a life; 0 from then on, None without damage."""

    @property
    def damage(self) -> Damage:
        """Damage of the more damaged part."""
        return self.stop if self.part == "stop" else self.link


@dataclass(frozen=True)
class Life:
    """A table of lives."""

    path: str
    detail_class: str
    """The class of the joints, in words."""
    environment: str
    design_factor: float
    """A joint is listed from `1 / design_factor` on."""
    runs: int
    joints: tuple[JointLife, ...]
    """The most damaged first."""

    def __repr__(self) -> str:
        return f"<Life of {len(self.joints)} joints in {self.runs} runs: {self.detail_class}>"

    def joint(self, serial_number: str) -> JointLife:
        """The joint of a serial number."""
        for joint in self.joints:
            if joint.serial_number == serial_number:
                return joint
        raise KeyError(serial_number)


@dataclass(frozen=True)
class _Row:
    serial: str
    start: int
    configuration: str
    place: int
    hours: float
    stop: float
    link: float


def read_life(path: PathLike) -> Life:
    """Reads a table of `flexdrill life`, also one to which a running node adds (`flexdrill run --life`).

    Raises `FileNotFoundError` where there is none, and `ResultFileError` for a file that is damaged or no such table.
    """
    file = Path(path)
    if not file.is_file():
        raise not_there(file, "make it with flexdrill life add FILE RECORDING")
    content = read_bounded(file, MOST_BYTES, REMEDY)
    try:
        lines = content.decode("utf-8-sig").splitlines()
    except UnicodeDecodeError as error:
        raise ResultFileError(str(file), f"no text in UTF-8: {error}", REMEDY) from None
    heading: dict[str, str] = {}
    rows: list[_Row] = []
    named = False
    for number, line in enumerate(lines, 1):
        # A spreadsheet fills short lines with commas, puts them in quotes, and doubles quotes within.
        plain = line.strip(" ,\r")
        said = plain.lstrip('"')
        if not plain:
            continue
        if named:
            rows.append(_row(file, number, plain))
        elif said.startswith("#"):
            said = said[1:].rstrip('"').replace('""', '"') if plain.startswith('"') else said[1:]
            name, colon, value = said.partition(":")
            if colon:
                heading.setdefault(name.strip(), value.strip())
        elif plain == COLUMNS:
            named = True
        else:
            raise ResultFileError(str(file), f"line {number}: must be the names {COLUMNS}", REMEDY)
    if heading.get("flexdrill life") != FORMAT:
        found = heading.get("flexdrill life", "none")
        raise ResultFileError(str(file), f"# flexdrill life: {found}: must be {FORMAT}", REMEDY)
    if not named:
        raise ResultFileError(str(file), f"the line of names is missing: {COLUMNS}", REMEDY)
    factors = (_factor(file, heading, "stop"), _factor(file, heading, "link"))
    design_factor = max(1.0, _number(file, "# design factor", _entry(file, heading, "design factor")))
    by_serial: dict[str, list[_Row]] = {}
    for row in rows:
        by_serial.setdefault(row.serial, []).append(row)
    joints = [_joint(of, factors, design_factor) for of in by_serial.values()]
    joints.sort(key=lambda joint: (-joint.damage.high, joint.serial_number))
    return Life(
        path=str(file),
        detail_class=_entry(file, heading, "class"),
        environment=_entry(file, heading, "environment"),
        design_factor=design_factor,
        runs=len({(row.start, row.configuration) for row in rows}),
        joints=tuple(joints),
    )


def _entry(file: Path, heading: dict[str, str], name: str) -> str:
    if name not in heading:
        raise ResultFileError(str(file), f"the comment line `# {name}: ...` is missing", REMEDY)
    return heading[name]


def _number(file: Path, name: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not (math.isfinite(value) and value >= 0.0):
        raise ResultFileError(str(file), f"{name} = {text[:60]}: must be a number of at least 0", REMEDY)
    return value


def _whole(file: Path, name: str, text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise ResultFileError(str(file), f"{name} = {text[:60]}: must be a whole number", REMEDY) from None


def _factor(file: Path, heading: dict[str, str], name: str) -> float:
    """Factor from the median damage of a part to its 95 %."""
    try:
        value = json.loads(_entry(file, heading, name))
    except json.JSONDecodeError as error:
        raise ResultFileError(str(file), f"# {name}: {error}", REMEDY) from None
    detail = Entry(file, REMEDY, value, name)
    line = detail.entry("line")
    endurance = math.log(10.0) * line.number("scatter", 0.0, 10.0)
    spread = detail.number("stress_concentration_scatter", 0.0, 10.0)
    slope = max(line.number("slope", 0.0, 100.0), line.number("slope_below_knee", 0.0, 100.0))
    return math.exp(TO_95_PERCENT * math.hypot(endurance, slope * math.sqrt(math.log1p(spread * spread))))


def _row(file: Path, number: int, line: str) -> _Row:
    fields = [field.strip().strip('"') for field in line.split(",")]
    if len(fields) != 8:
        raise ResultFileError(str(file), f"line {number}: has {len(fields)} fields: must have 8, {COLUMNS}", REMEDY)
    serial, start, end, configuration, place, hours, stop, link = fields
    at = f"line {number}: "
    _whole(file, f"{at}end_ns", end)
    return _Row(
        serial=serial,
        start=_whole(file, f"{at}start_ns", start),
        configuration=configuration,
        place=_whole(file, f"{at}place_from_bit", place),
        hours=_number(file, f"{at}hours", hours),
        stop=_number(file, f"{at}stop_damage", stop),
        link=_number(file, f"{at}link_damage", link),
    )


def _joint(rows: Sequence[_Row], factors: tuple[float, float], design_factor: float) -> JointLife:
    rows = sorted(rows, key=lambda row: row.start)
    hours = sum(row.hours for row in rows)
    # The scatter is that of the joint, the same in all its runs: its bands add up as they are.
    medians = (sum(row.stop for row in rows), sum(row.link for row in rows))
    stop, link = (Damage(median / factor, median, median * factor) for median, factor in zip(medians, factors))
    part, damage = ("stop", stop) if stop.high > link.high else ("link", link)
    if damage.median >= 1.0:
        verdict = "expected"
    elif damage.high >= 1.0:
        verdict = "possible"
    elif damage.high >= 1.0 / design_factor:
        verdict = "listed"
    else:
        verdict = "sound"
    return JointLife(
        serial_number=rows[0].serial,
        hours=hours,
        runs=len(rows),
        places=tuple(row.place for row in rows),
        stop=stop,
        link=link,
        part=part,
        verdict=verdict,
        hours_left=max(0.0, hours * (1.0 / damage.high - 1.0)) if damage.high > 0.0 else None,
    )
