"""Maps of `flexdrill map` as arrays over the two quantities."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import NotRecordedError
from ._groups import CountArray, FloatArray
from ._results_file import (
    MAP_FORMAT,
    MOST_MEMBERS,
    PRIORITIES,
    QUANTILES,
    Counts,
    Entry,
    FlagArray,
    PathLike,
    TextArray,
    check_format,
    not_there,
    parse,
    read_bounded,
    shares,
)

if TYPE_CHECKING:
    import xarray

FILE = "map.json"
MOST_BYTES = 64 << 20
MOST_VALUES = 200
STARTS = ("rest", "running")
STATES = ("known", "inferred", "unknown", "not_known")
VERDICTS = ("clear", "alarm", "depends_on_start", "unknown", "not_known")
REMEDY = "remove it and run the same flexdrill map command again, which keeps the runs that were made"


@dataclass(frozen=True)
class MapAxis:
    """One quantity of a map."""

    key: str
    """Key of the configuration."""
    name: str
    unit: str
    """Unit of the values; empty if dimensionless."""
    values: FloatArray
    """Rising."""


@dataclass(frozen=True)
class MapSample:
    """The sample of a calibration that the plausible tools of a map are drawn from."""

    sha256: str
    """SHA-256 of its file."""
    version: str
    """Version of the program that wrote it."""
    log: str
    """File name of the log that it was fitted to."""
    log_sha256: str
    rows: tuple[int, int]
    """First and last row of the log."""
    members: int
    effective: float
    """Members alike that its weights amount to."""
    keys: tuple[str, ...]
    """Keys of the configuration that it has; the others are drawn from `uncertainty`, given these."""


@dataclass(frozen=True)
class Map:
    """A map. Arrays are over y and x, or over start, y and x."""

    path: str
    """The file."""
    program: str
    """The program that computed it, with its version."""
    title: str
    """Title of the configuration."""
    configuration_hash: str
    motion_hash: str
    """Hash of what determines the motion: the map belongs to every configuration with it."""
    x: MapAxis
    y: MapAxis
    horizon_s: float
    """Model time that each member was judged over."""
    most_members: int
    """Members per cell and start, at most; `members` has how many ran."""
    run_all: bool
    """Whether all of these ran, also where the first ones decided every alarm."""
    first_alarm: bool
    """Whether a member ended with its first alarm that counts."""
    plausible: bool
    """Whether members are plausible tools, drawn from what is not known, and not the tool of the configuration."""
    posterior: MapSample | None
    """What they are drawn from after a calibration; `None` where they are drawn from `uncertainty` alone."""
    seed: int
    priority: str
    """Priority from which on an alarm counts for `chance` and `verdict`."""
    limit: float
    """Chance above which an alarm must be expected."""
    starts: tuple[str, ...]
    """The first axis of the arrays below: `rest`, `running`."""
    runs: int
    """Runs that were made."""
    first_looks: int
    """Runs among these that have their first member alone, since no neighbour is of another class."""
    model_time_s: float
    """Model time of all members that count and of the states that they began from; 0 where unknown."""
    verdict: TextArray
    """Over y and x: `clear`, `alarm`, `depends_on_start`, `unknown` where a run failed, or `not_known` where no run was
    made from some start and those around do not say with 95 % what the cell is. The last two are never safe."""
    state: TextArray
    """`known` where it was run, `unknown` where no member ended, `inferred` with 95 % from the runs around, `not_known`."""
    expected: FlagArray
    """Whether an alarm must be expected; it says nothing where the state is `unknown` or `not_known`."""
    confidence: FloatArray
    """Probability that a run would say the same: 1 where a member ended, at least 0.95 where inferred, that of the most
    likely class where not known."""
    chance: FloatArray
    """Chance of any alarm that counts; NaN where not run."""
    chance_interval: FloatArray
    """Its 95 % interval by the members that ended, on a last axis of two; 0 to 1 where not known."""
    alarm: TextArray
    """Identifier of the alarm that most members saw; empty where none was seen."""
    members: CountArray
    """Members that were run."""
    failed: CountArray
    """Members of these that failed; they are in no chance."""
    failure: TextArray
    """Why the first of them failed; empty where none did."""
    alarms: Mapping[str, CountArray]
    """Members that saw each alarm that any saw; the last axis is `flexdrill.PRIORITIES`."""
    figures: Mapping[str, FloatArray]
    """Figures named with their unit; the last axis is `flexdrill.QUANTILES`. NaN where not run."""
    units: Mapping[str, str]
    """Unit of each figure; empty if dimensionless."""

    def __repr__(self) -> str:
        return f"<Map of {len(self.x.values)} x {len(self.y.values)} cells: {self.x.name}, {self.y.name}>"

    @property
    def ended(self) -> CountArray:
        """Members that ended."""
        return self.members - self.failed

    def chance_of(self, alarm: str) -> FloatArray:
        """Members that saw an alarm over members that ended, the last axis over priorities; NaN where not run. An alarm
        that no member saw is none of the map's."""
        if alarm not in self.alarms:
            raise NotRecordedError(f"no member of this map saw {alarm}; seen were {', '.join(self.alarms) or 'none'}")
        return shares(self.alarms[alarm], self.ended)

    def to_xarray(self) -> xarray.Dataset:
        """All arrays as a dataset of xarray, with units (`pip install flexdrill[xarray]`)."""
        import xarray

        over = ("start", "y", "x")
        variables: dict[str, Any] = {"verdict": (("y", "x"), self.verdict)}
        names = ("state", "expected", "confidence", "chance", "alarm", "members", "failed", "failure")
        variables.update({name: (over, getattr(self, name)) for name in names})
        variables["chance_interval"] = ((*over, "bound"), self.chance_interval)
        for alarm, counts in self.alarms.items():
            variables[f"alarm.{alarm}"] = ((*over, "priority"), counts)
        for name, figure in self.figures.items():
            variables[name] = ((*over, "quantile"), figure, {"units": self.units[name]} if self.units[name] else {})
        coordinates: dict[str, Any] = {"start": list(self.starts), "bound": ["low", "high"]}
        coordinates.update({"priority": list(PRIORITIES), "quantile": list(QUANTILES)})
        for name, axis in (("x", self.x), ("y", self.y)):
            about = {"key": axis.key, "long_name": axis.name, **({"units": axis.unit} if axis.unit else {})}
            coordinates[name] = (name, axis.values, about)
        about = {"program": self.program, "title": self.title, "motion_hash": self.motion_hash}
        return xarray.Dataset(variables, coordinates, about)


def read_map(path: PathLike) -> Map:
    """Reads a map: `map.json`, or the directory of `flexdrill map` that has it.

    Raises `FileNotFoundError` where there is none, and `ResultFileError` for a map that is damaged or of another
    version.
    """
    file = Path(path)
    file = file / FILE if file.is_dir() else file
    if not file.is_file():
        raise not_there(file, "make it with flexdrill map CONFIG --rpm A:B --wob A:B --out DIR, which writes it last")
    whole = parse(file, read_bounded(file, MOST_BYTES, REMEDY), REMEDY)
    check_format(whole, "a map", MAP_FORMAT)
    x, y = _axis(whole.entry("x")), _axis(whole.entry("y"))
    starts = whole.texts("starts", STARTS)
    if starts not in (["rest"], ["running"], ["rest", "running"]):
        raise whole.wrong("starts", starts, "rest, running or both, each once")
    most_members = whole.count("members", 1, MOST_MEMBERS)
    columns, rows = len(x.values), len(y.values)
    shape = (len(starts), rows, columns)
    counts = Counts(shape)
    verdict = np.empty((rows, columns), dtype=object)
    texts = {name: np.empty(shape, dtype=object) for name in ("state", "alarm", "failure")}
    numbers = {name: np.full(shape, np.nan) for name in ("confidence", "chance")}
    interval = np.full((*shape, 2), np.nan)
    expected = np.zeros(shape, dtype=np.bool_)
    members, failed = np.zeros(shape, dtype=np.uint64), np.zeros(shape, dtype=np.uint64)
    for number, cell in enumerate(whole.entries("cells", rows * columns)):
        row, column = divmod(number, columns)
        for name, value in (("x", x.values[column]), ("y", y.values[row])):
            if cell.number(name) != value:
                raise cell.wrong(name, cell.values[name], f"{value:g}, as the axis says")
        verdict[row, column] = cell.text("verdict", VERDICTS)
        for start, of in enumerate(cell.entries("starts", len(starts))):
            at = (start, row, column)
            texts["state"][at] = of.text("state", STATES)
            texts["alarm"][at], texts["failure"][at] = of.text("alarm"), of.text("failure")
            numbers["confidence"][at] = of.number("confidence", 0.0, 1.0)
            numbers["chance"][at] = of.maybe("chance", 0.0, 1.0)
            expected[at] = of.flag("expected")
            interval[at] = of.numbers("interval", 2)
            members[at] = of.count("members", 0, most_members)
            failed[at] = of.count("failed", 0, int(members[at]))
            counts.fill(at, of, int(members[at] - failed[at]))
    return Map(
        path=str(file),
        program=whole.text("program"),
        title=whole.text("title"),
        configuration_hash=whole.text("configuration"),
        motion_hash=whole.text("motion"),
        x=x,
        y=y,
        horizon_s=whole.number("horizon", 0.0),
        most_members=most_members,
        run_all=whole.flag("run_all"),
        first_alarm=whole.flag("first_alarm", missing=False),
        plausible=whole.flag("plausible", missing=False),
        posterior=_sample(whole.entry("posterior")) if "posterior" in whole.values else None,
        seed=whole.count("seed", 0, 2**64 - 1),
        priority=whole.text("priority", PRIORITIES),
        limit=whole.number("limit", 0.0, 1.0),
        starts=tuple(starts),
        runs=whole.count("runs"),
        first_looks=whole.count("first_looks") if "first_looks" in whole.values else 0,
        model_time_s=whole.number("model_time", 0.0) if "model_time" in whole.values else 0.0,
        verdict=verdict.astype(np.str_),
        state=texts["state"].astype(np.str_),
        expected=expected,
        confidence=numbers["confidence"],
        chance=numbers["chance"],
        chance_interval=interval,
        alarm=texts["alarm"].astype(np.str_),
        members=members,
        failed=failed,
        failure=texts["failure"].astype(np.str_),
        alarms=dict(sorted(counts.alarms.items())),
        figures=counts.figures,
        units=counts.units,
    )


def _sample(entry: Entry) -> MapSample:
    first, last = entry.numbers("rows", 2)
    members = entry.count("members")
    return MapSample(
        sha256=entry.text("sha256"),
        version=entry.text("version"),
        log=entry.text("log"),
        log_sha256=entry.text("log_sha256"),
        rows=(int(first), int(last)),
        members=members,
        effective=entry.number("effective", 0.0, members),
        keys=tuple(entry.texts("keys")),
    )


def _axis(entry: Entry) -> MapAxis:
    values = entry.numbers("values", most=MOST_VALUES)
    if len(values) < 2 or np.any(np.diff(values) <= 0.0):
        raise entry.wrong("values", values.tolist(), "rising, at least two")
    return MapAxis(entry.text("key"), entry.text("name"), entry.text("unit"), values)
