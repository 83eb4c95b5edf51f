"""What a run returns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional, Union, cast

import numpy.typing as npt

from . import _native
from ._alarms import AlarmEvent, events
from ._errors import NotRecordedError, StepError
from ._groups import (
    Ageing,
    Applied,
    Bit,
    CodeArray,
    Contacts,
    CountArray,
    Energy,
    FloatArray,
    Hazards,
    Joints,
    Quality,
    Reactions,
    Shape,
    Solver,
    Transfer,
    Whirl,
)

if TYPE_CHECKING:
    import xarray

Array = npt.NDArray[Any]

HAZARDS: tuple[str, ...] = tuple(_native.names()[0])
"""Names of the hazards, in the order of `Hazards`."""
SEVERITIES: tuple[str, ...] = tuple(_native.names()[1])
"""Names of the levels, rising."""
WHIRL_KINDS: tuple[str, ...] = tuple(_native.names()[2])
"""Names of the kinds of whirl."""
BODIES = ("pipe", "guide")
"""Names of the bodies."""
HOLDERS = ("pipe", "guide", "string")
"""What holds the tool at an entry of `Reactions`: a support of the pipe or of the guide, or the string above."""

_COLUMNS = [(f"{group}.{column}" if group else column, fixed) for group, column, fixed in _native.columns()]
_FIXED = frozenset(name for name, fixed in _COLUMNS if fixed)

GROUPS: tuple[str, ...] = tuple(dict.fromkeys(group for group, _, _ in _native.columns() if group))
"""Names of all groups that can be recorded."""
USUAL_GROUPS = ("applied", "joints", "contacts", "bit", "whirl", "hazards", "quality")
"""Groups of a recording unless others are asked for."""


class _Grouped:
    """Columns by group."""

    def __init__(self, columns: Mapping[str, Array]) -> None:
        self._columns = dict(columns)

    @property
    def groups(self) -> tuple[str, ...]:
        """The groups that were recorded."""
        return tuple(dict.fromkeys(name.split(".")[0] for name in self._columns if "." in name))

    @property
    def columns(self) -> Mapping[str, Array]:
        """All columns by name, `bit.torque_nm`: `numpy.savez(file, **recording.columns)` keeps them."""
        return dict(self._columns)

    def _group(self, name: str) -> dict[str, Any]:
        start = name + "."
        found: dict[str, Any] = {
            column[len(start) :]: self._value(column) for column in self._columns if column.startswith(start)
        }
        if not found:
            raise NotRecordedError(
                f"{name} was not recorded, only {', '.join(self.groups) or 'time'}; run with record=[..., {name!r}]"
            )
        return found

    def _value(self, column: str) -> Any:
        return self._columns[column]

    @property
    def joints(self) -> Joints:
        """Bend, forces and torque per joint."""
        return Joints(**self._group("joints"))

    @property
    def contacts(self) -> Contacts:
        """Gaps and forces per station."""
        return Contacts(**self._group("contacts"))

    @property
    def reactions(self) -> Reactions:
        """Forces from outside."""
        return Reactions(**self._group("reactions"))

    @property
    def shape(self) -> Shape:
        """Lines of both pipes."""
        return Shape(**self._group("shape"))

    @property
    def whirl(self) -> Whirl:
        """Whirl per watched station."""
        return Whirl(**self._group("whirl"))

    @property
    def hazards(self) -> Hazards:
        """Levels of the hazards."""
        return Hazards(**self._group("hazards"))


class Recording(_Grouped):
    """Samples over the time of a run. The arrays cannot be written to and share the memory that the run filled."""

    def __init__(
        self,
        columns: Mapping[str, Array],
        failure: Optional[StepError] = None,
        alarms: Sequence[AlarmEvent] = (),
    ) -> None:
        super().__init__(columns)
        self.alarms: tuple[AlarmEvent, ...] = tuple(alarms)
        """What the alarms did in the run, in the order of time. They are those of the node for these inputs."""
        self.failure = failure
        """Why the run ended early, in a rollout; None where it did not."""

    @classmethod
    def _of(cls, recorder: _native.Recorder, failure: Optional[StepError] = None) -> Recording:
        alarms = events(recorder.alarms())
        return cls(recorder.finish(), failure, alarms)

    def __len__(self) -> int:
        return len(self.time_s)

    def __repr__(self) -> str:
        ended = "" if self.failure is None else f", ended early: {self.failure}"
        return f"<Recording of {len(self)} samples: {', '.join(self.groups)}{ended}>"

    @property
    def time_s(self) -> FloatArray:
        """Model time of each sample."""
        return cast(FloatArray, self._columns["time_s"])

    @property
    def step(self) -> CountArray:
        """Model steps taken at each sample."""
        return cast(CountArray, self._columns["step"])

    @property
    def applied(self) -> Applied[FloatArray]:
        """Inputs as they act."""
        return Applied(**self._group("applied"))

    @property
    def bit(self) -> Bit[FloatArray, CodeArray]:
        """The bit."""
        return Bit(**self._group("bit"))

    @property
    def transfer(self) -> Transfer[FloatArray]:
        """Torque and weight from the surface to the bit."""
        return Transfer(**self._group("transfer"))

    @property
    def ageing(self) -> Ageing[FloatArray]:
        """Relative ageing."""
        return Ageing(**self._group("ageing"))

    @property
    def solver(self) -> Solver[CountArray]:
        """Counters of the solver."""
        return Solver(**self._group("solver"))

    @property
    def energy(self) -> Energy[FloatArray]:
        """Energy since the start."""
        return Energy(**self._group("energy"))

    @property
    def quality(self) -> Quality[FloatArray, Union[CodeArray, CountArray]]:
        """Quality of the computed motion."""
        return Quality(**self._group("quality"))

    def to_xarray(self) -> xarray.Dataset:
        """All columns as a dataset of xarray, with units and places (`pip install flexdrill[xarray]`)."""
        from ._xarray import dataset

        return dataset(self._columns, _FIXED)


class Snapshot(_Grouped):
    """One instant, with all groups."""

    def __repr__(self) -> str:
        return f"<Snapshot at {self.time_s:.4f} s>"

    def _value(self, column: str) -> Any:
        array = self._columns[column]
        if column in _FIXED:
            return array
        of_instant = array[0]
        return of_instant.item() if of_instant.ndim == 0 else of_instant

    @property
    def time_s(self) -> float:
        """Model time."""
        return float(self._columns["time_s"][0])

    @property
    def step(self) -> int:
        """Model steps taken."""
        return int(self._columns["step"][0])

    @property
    def applied(self) -> Applied[float]:
        """Inputs as they act."""
        return Applied(**self._group("applied"))

    @property
    def bit(self) -> Bit[float, int]:
        """The bit."""
        return Bit(**self._group("bit"))

    @property
    def transfer(self) -> Transfer[float]:
        """Torque and weight from the surface to the bit."""
        return Transfer(**self._group("transfer"))

    @property
    def ageing(self) -> Ageing[float]:
        """Relative ageing."""
        return Ageing(**self._group("ageing"))

    @property
    def solver(self) -> Solver[int]:
        """Counters of the solver."""
        return Solver(**self._group("solver"))

    @property
    def energy(self) -> Energy[float]:
        """Energy since the start."""
        return Energy(**self._group("energy"))

    @property
    def quality(self) -> Quality[float, int]:
        """Quality of the computed motion."""
        return Quality(**self._group("quality"))


def wanted_groups(record: Union[str, Sequence[str]]) -> list[str]:
    """The names of groups: "all", one name, or several."""
    if record == "all":
        return list(GROUPS)
    return [record] if isinstance(record, str) else list(record)
