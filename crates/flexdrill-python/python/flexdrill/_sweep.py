"""Directories of `flexdrill sweep` as arrays over their points."""

from __future__ import annotations

import hashlib
import itertools
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import NotRecordedError, ResultFileError
from ._groups import CountArray, FloatArray
from ._results_file import (
    MOST_MEMBERS,
    PRIORITIES,
    QUANTILES,
    SWEEP_FORMAT,
    Array,
    Counts,
    Entry,
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

PLAN = "sweep.json"
MOST_PLAN_BYTES = 256 << 20
MOST_POINT_BYTES = 1 << 18
MOST_POINTS = 200_000
MOST_SEED = 2**64 - 1
STARTS = ("rest", "running")
PLAN_REMEDY = "plan again in a new directory: flexdrill sweep plan SPEC DIR"
POINT_REMEDY = "remove it and run flexdrill sweep work DIR, which computes it again"


@dataclass(frozen=True)
class Sweep:
    """The results of a sweep. Arrays have a value per point, in the order of the plan and of `points.csv`."""

    path: str
    """The directory."""
    program: str
    """The program that computed it, with its version."""
    arithmetic: str
    """Its arithmetic, on which the last bits depend."""
    configuration: str
    """The configuration that the points change (YAML)."""
    configuration_hash: str
    horizon_s: float
    """Model time that each member was judged over."""
    most_members: int
    """Members per point, at most; `members` has how many ran."""
    run_all: bool
    """Whether all of these run, also where the first ones decide every alarm."""
    values: Mapping[str, Array]
    """Values of the keys of the configuration, by key: the inputs of a point."""
    start: TextArray
    """`rest` or `running`."""
    seed: CountArray
    point: TextArray
    """Name of each point; empty where it has no result."""
    state: TextArray
    """`known`, `unknown` where no member ended, or `missing` where there is no result."""
    members: CountArray
    """Members that were run."""
    failed: CountArray
    """Members of these that failed; they are in no count."""
    failure: TextArray
    """Why the first of them, or the way to the values, failed; empty where none did."""
    run_up_s: FloatArray
    """Model time of the way to the values; NaN where it failed."""
    quality: CountArray
    """Members by the worst quality of their motion: good, degraded, poor."""
    any_alarm: CountArray
    """Members that saw any alarm, over points and `flexdrill.PRIORITIES`: with this priority or a higher one."""
    alarms: Mapping[str, CountArray]
    """Members that saw each alarm, over points and `flexdrill.PRIORITIES`: with this priority or a higher one."""
    figures: Mapping[str, FloatArray]
    """Figures over points and `flexdrill.QUANTILES` of the members, named with their unit; NaN where not known."""
    units: Mapping[str, str]
    """Unit of each figure; empty if dimensionless."""

    def __len__(self) -> int:
        return len(self.state)

    def __repr__(self) -> str:
        done = int(np.count_nonzero(self.state != "missing"))
        return f"<Sweep of {len(self)} points, {done} with a result: {', '.join(self.values)}>"

    @property
    def ended(self) -> CountArray:
        """Members that ended."""
        return self.members - self.failed

    def chance(self, alarm: str) -> FloatArray:
        """Members that saw an alarm over members that ended, over points and priorities; NaN where none ended."""
        if alarm not in self.alarms:
            raise NotRecordedError(f"{alarm} is no alarm of this sweep; it has {', '.join(self.alarms)}")
        return shares(self.alarms[alarm], self.ended)

    def to_xarray(self) -> xarray.Dataset:
        """All arrays as a dataset of xarray over points (`pip install flexdrill[xarray]`). The keys of the
        configuration are coordinates: `dataset.set_index(point=[...]).unstack()` makes a grid of them."""
        import xarray

        over = "point"
        variables: dict[str, Any] = {
            name: (over, getattr(self, name)) for name in ("state", "members", "failed", "failure")
        }
        variables["run_up_s"] = (over, self.run_up_s, {"units": "s"})
        variables["quality"] = ((over, "quality_level"), self.quality)
        variables["any_alarm"] = ((over, "priority"), self.any_alarm)
        for alarm, counts in self.alarms.items():
            variables[f"alarm.{alarm}"] = ((over, "priority"), counts)
        for name, figure in self.figures.items():
            variables[name] = ((over, "quantile"), figure, {"units": self.units[name]} if self.units[name] else {})
        coordinates: dict[str, Any] = {key: (over, values) for key, values in self.values.items()}
        coordinates.update({"start": (over, self.start), "seed": (over, self.seed), "name": (over, self.point)})
        coordinates.update({"priority": list(PRIORITIES), "quantile": list(QUANTILES)})
        coordinates["quality_level"] = ["good", "degraded", "poor"]
        about = {"program": self.program, "configuration_hash": self.configuration_hash, "horizon_s": self.horizon_s}
        return xarray.Dataset(variables, coordinates, about)


def read_sweep(path: PathLike, *, partial: bool = False) -> Sweep:
    """Reads the directory of a sweep, made by `flexdrill sweep plan` and filled by `flexdrill sweep work`. With
    `partial`, points without a result are of the state `missing`.

    Raises `FileNotFoundError` without a plan, and `ResultFileError` for a plan or a result that is damaged, of another
    version or of another plan, and for missing results without `partial`.
    """
    folder = Path(path)
    file = folder / PLAN
    if not file.is_file():
        raise not_there(file, "it is the plan of a sweep; make one with flexdrill sweep plan SPEC DIR")
    plan = parse(file, read_bounded(file, MOST_PLAN_BYTES, PLAN_REMEDY), PLAN_REMEDY)
    check_format(plan, "a plan", SWEEP_FORMAT)
    runs = plan.entry("runs")
    keys = plan.texts("keys")
    rows = plan.lists("rows", len(keys))
    starts = plan.texts("starts", STARTS)
    seeds = _seeds(plan)
    most_members = runs.count("members", 1, MOST_MEMBERS)
    count = len(rows) * len(starts) * len(seeds)
    if not 1 <= count <= MOST_POINTS:
        raise plan.wrong("points", count, f"1 to {MOST_POINTS}, rows times starts times seeds")
    wanted = [(row, start, seed) for row in range(len(rows)) for start in starts for seed in seeds]
    where: dict[tuple[Any, ...], list[int]] = {}
    for number, (row, start, seed) in enumerate(wanted):
        for name in _names(rows[row], start, seed):
            where.setdefault(name, []).append(number)

    counts = Counts((count,))
    alarms = runs.texts("alarms")
    for alarm in alarms:
        counts.declare_alarm(alarm)
    for at, (figure, unit) in enumerate(runs.lists("figures", 2)):
        if not (isinstance(figure, str) and isinstance(unit, str)):
            raise runs.wrong(f"figures.{at}", [figure, unit], "name and unit")
        counts.declare_figure(figure, unit)
    names, states, failures = [""] * count, ["missing"] * count, [""] * count
    members, failed = np.zeros(count, dtype=np.uint64), np.zeros(count, dtype=np.uint64)
    quality = np.zeros((count, 3), dtype=np.uint64)
    any_alarm = np.zeros((count, len(PRIORITIES)), dtype=np.uint64)
    run_up = np.full(count, np.nan)
    for point_file in _files(folder / "points"):
        body = _body(point_file, runs)
        values = [body.entry("values").values.get(key) for key in keys]
        name = (body.text("start", STARTS), body.count("seed", 0, MOST_SEED), *map(_rounded, values))
        # What is no point of this plan is left out, as by the command.
        for number in where.get(name, ()):
            if not all(_same(*pair) for pair in zip(values, rows[wanted[number][0]])):
                continue
            outcome = body.entry("outcome")
            names[number] = body.text("point")
            members[number] = outcome.count("members", 0, most_members)
            failed[number] = outcome.count("failed", 0, int(members[number]))
            ended = int(members[number] - failed[number])
            states[number] = "known" if ended > 0 else "unknown"
            failures[number] = outcome.text("failure")
            run_up[number] = outcome.maybe("run_up", 0.0)
            quality[number] = outcome.numbers("quality", 3)
            if int(quality[number].sum()) != ended:
                raise outcome.wrong("quality", quality[number].tolist(), f"{ended} members together")
            any_alarm[number] = outcome.numbers("any_alarm", len(PRIORITIES))
            if int(any_alarm[number].max()) > ended:
                raise outcome.wrong("any_alarm", any_alarm[number].tolist(), f"at most {ended} members each")
            counts.fill((number,), outcome, ended, alarms)
    missing = states.count("missing")
    if missing and not partial:
        raise ResultFileError(
            str(folder),
            f"{missing} of {count} points have no result",
            "run flexdrill sweep work DIR, or read with partial=True",
        )
    return Sweep(
        path=str(folder),
        program=runs.text("program"),
        arithmetic=runs.text("arithmetic"),
        configuration=runs.text("configuration", most=MOST_PLAN_BYTES),
        configuration_hash=runs.text("hash"),
        horizon_s=runs.number("horizon", 0.0),
        most_members=most_members,
        run_all=runs.flag("run_all"),
        values={key: _array([rows[row][at] for row, _, _ in wanted]) for at, key in enumerate(keys)},
        start=np.array([start for _, start, _ in wanted]),
        seed=np.array([seed for _, _, seed in wanted], dtype=np.uint64),
        point=np.array(names),
        state=np.array(states),
        members=members,
        failed=failed,
        failure=np.array(failures),
        run_up_s=run_up,
        quality=quality,
        any_alarm=any_alarm,
        alarms=counts.alarms,
        figures=counts.figures,
        units=counts.units,
    )


ROUNDING = 4.0 * float(np.finfo(np.float64).eps)
"""The program that plans and the one that works read a number to the last bit but one."""


def _rounded(value: Any) -> Any:
    return f"{value:.12e}" if isinstance(value, (int, float)) and not isinstance(value, bool) else value


def _names(row: list[Any], start: str, seed: int) -> Iterator[tuple[Any, ...]]:
    """What the result of a point may be found by: its content, with numbers rounded from either side."""
    ways = [{_rounded(value)} for value in row]
    for way, value in zip(ways, row):
        if isinstance(value, float):
            way.update(_rounded(value * (1.0 + side)) for side in (-ROUNDING, ROUNDING))
    return ((start, seed, *values) for values in itertools.product(*ways))


def _same(value: Any, planned: Any) -> bool:
    if isinstance(value, float) and isinstance(planned, (int, float)):
        return abs(value - planned) <= ROUNDING * abs(planned)
    return bool(value == planned)


def _seeds(plan: Entry) -> list[int]:
    seeds = plan.items("seeds")
    for at, seed in enumerate(seeds):
        if type(seed) is not int or not 0 <= seed <= MOST_SEED:
            raise plan.wrong(f"seeds.{at}", seed, f"a whole number of 0 to {MOST_SEED}")
    return seeds


def _files(points: Path) -> Iterator[Path]:
    """The complete results in the folders of points; what is being written has a name that begins with a dot."""
    if not points.is_dir():
        return
    for folder in sorted(points.iterdir()):
        if folder.is_dir():
            yield from sorted(file for file in folder.glob("*.jsonl") if not file.name.startswith("."))


def _body(file: Path, runs: Entry) -> Entry:
    """The first line of a point's file, held against the checksum in the second, the plan, and the file's own name."""
    content = read_bounded(file, MOST_POINT_BYTES, POINT_REMEDY)
    line, _, rest = content.partition(b"\n")
    if rest != f'"{hashlib.sha256(line).hexdigest()}"\n'.encode("ascii"):
        raise ResultFileError(str(file), "it does not end with the checksum of its first line", POINT_REMEDY)
    body = parse(file, line, POINT_REMEDY)
    check_format(body, "a result", SWEEP_FORMAT)
    own = {name: runs.text(name) for name in ("program", "arithmetic")}
    own.update({"configuration": runs.text("hash"), "point": file.parent.name + file.stem})
    for name, expected in own.items():
        if body.text(name) != expected:
            raise body.wrong(name, body.values[name], f"{expected}, as the plan and the name of the file say")
    return body


def _array(values: list[Any]) -> Array:
    """Numbers as float64, truth values as bool, words as text."""
    if all(isinstance(value, bool) for value in values):
        return np.array(values, dtype=np.bool_)
    if all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in values):
        return np.array(values, dtype=np.float64)
    return np.array([value if isinstance(value, str) else json.dumps(value) for value in values])
