"""The twin."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Optional, Union, cast

from . import _native
from ._ahead import HoleAhead
from ._errors import StepError
from ._inputs import NAMES, Input, ask, constant_changes, is_function, period_steps, share_of, steps_of
from ._results import GROUPS, USUAL_GROUPS, Recording, Snapshot, wanted_groups

Config = Union[str, "os.PathLike[str]", Mapping[str, Any]]
"""A path, the name of a shipped configuration, or the configuration itself as nested mappings."""

_SHIPPED = Path(__file__).parent / "configs"


def shipped_configs() -> tuple[str, ...]:
    """Names of the configurations that the package has."""
    return tuple(sorted(path.name for path in _SHIPPED.glob("*.yaml")))


def _read(config: Config) -> tuple[str, str]:
    """Name and text of a configuration."""
    if isinstance(config, Mapping):
        return "the given configuration", json.dumps(config)
    path = Path(config)
    if not path.exists() and str(config) in shipped_configs():
        path = _SHIPPED / path
    return str(path), path.read_text(encoding="utf-8")


@dataclass(frozen=True)
class Friction:
    """Coefficients that may change during a run."""

    pipe_guide_around: float
    """Pipe on guide, round the circumference."""
    pipe_guide_along: float
    """Pipe on guide, along the axis."""
    guide_wall_around: float
    """Guide on wall, round the circumference."""
    guide_wall_along: float
    """Guide on wall, along the axis."""
    bit: float
    """Friction factor between bit and rock: eta of the paper's Eq. 1."""


class Twin:
    """One tool in its well, at some instant of a run.

    The tool comes to rest under gravity and the initial weight on bit when it is built. The same configuration and
    inputs give the same bits as the command line, whatever the machine and the number of threads.
    """

    def __init__(self, config: Config = "default.yaml", **overrides: Any) -> None:
        """Builds the tool of a configuration.

        `config` is a path, one of `shipped_configs()` (a file of that name in the working directory has precedence), or
        nested mappings. `overrides` change single keys: `Twin(**{"tool.joint.limit_deg": 8})`, or with two underscores
        for a dot, `Twin(tool__joint__limit_deg=8)`.

        Raises `ConfigError` with every key that is out of bounds, `StartError` when the tool does not come to rest,
        and `OSError` when the file cannot be read.
        """
        name, text = _read(config)
        changes = [(key.replace("__", "."), json.dumps(value)) for key, value in overrides.items()]
        self._native = _native.Twin(name, text, changes)

    @classmethod
    def _of(cls, native: _native.Twin) -> Twin:
        twin = cls.__new__(cls)
        twin._native = native
        return twin

    def __repr__(self) -> str:
        return f"<Twin at {self.time_s:.4f} s, configuration {self.configuration_hash[:12]}>"

    # --- Running ---------------------------------------------------------------------------------------------------

    def run(
        self,
        seconds: float,
        *,
        speed_rpm: Optional[Input] = None,
        weight_kn: Optional[Input] = None,
        rate_of_penetration_m_per_h: Optional[Input] = None,
        standpipe_pressure_mpa: Optional[Input] = None,
        record: Union[str, Sequence[str]] = USUAL_GROUPS,
        rate_hz: float = 50.0,
        progress: Optional[Callable[[float], object]] = None,
    ) -> Recording:
        """Runs for a time, rounded to whole model steps, and returns the samples.

        Inputs are targets, towards which the model moves within the slew limits of the configuration. Each is a number,
        an array whose n values act for one n-th of the run each, or a function of the model time (s) that is asked
        every 5 ms. Without one the last target stays. `record` names the groups (`GROUPS`, or "all"), `rate_hz` the
        samples per second. `progress` is called with the share that is done, 0 to 1.

        Python's lock is released while the model runs; Ctrl-C ends the run. Two runs one after the other equal one over
        both times, to the bit.

        Raises `InputError` when an input is outside the limits of the configuration, and `StepError` when a step cannot
        be taken; its `recording` has the samples before.
        """
        inputs = (speed_rpm, weight_kn, rate_of_penetration_m_per_h, standpipe_pressure_mpa)
        steps = steps_of(seconds, self.time_step_s)
        recorder = _native.Recorder(wanted_groups(record), rate_hz, self.time_step_s)
        try:
            self._advance(steps, inputs, recorder, share_of(progress, steps))
        except StepError as failure:
            failure.recording = Recording._of(recorder)
            raise
        return Recording._of(recorder)

    def step(
        self,
        steps: int = 1,
        *,
        speed_rpm: Optional[Input] = None,
        weight_kn: Optional[Input] = None,
        rate_of_penetration_m_per_h: Optional[Input] = None,
        standpipe_pressure_mpa: Optional[Input] = None,
    ) -> None:
        """Takes model steps without recording; inputs as in `run`."""
        if steps < 0:
            raise ValueError(f"steps = {steps}: must be 0 or more")
        self._advance(steps, (speed_rpm, weight_kn, rate_of_penetration_m_per_h, standpipe_pressure_mpa), None, None)

    def _advance(
        self,
        steps: int,
        inputs: Sequence[Optional[Input]],
        recorder: Optional[_native.Recorder],
        progress: Optional[Callable[[int], object]],
    ) -> None:
        constant = [constant_changes(name, value, steps) for name, value in zip(NAMES, inputs)]
        functions = [(number, value) for number, value in enumerate(inputs) if is_function(value)]
        if not functions:
            self._native.run(steps, cast("_native.Changes", tuple(constant)), recorder, progress)
            return
        period = period_steps(self.time_step_s)
        done = 0
        while done < steps:
            stride = min(period - self.steps % period, steps - done)
            changes = [
                [(max(step - done, 0), value) for step, value in of_input if done <= step < done + stride]
                for of_input in constant
            ]
            for number, function in functions:
                changes[number] = [(0, ask(function, self.time_s))]
            self._native.run(stride, cast("_native.Changes", tuple(changes)), recorder, None)
            done += stride
            if progress is not None:
                progress(done)

    def reset(self) -> None:
        """Resets the motion to the state after the start; friction coefficients stay."""
        self._native.reset()

    # --- The present state -----------------------------------------------------------------------------------------

    def snapshot(self) -> Snapshot:
        """The present state, with all groups. The snapshot does not restart the intervals of peaks and means."""
        recorder = _native.Recorder(GROUPS, None, self.time_step_s)
        self._native.look(recorder)
        return Snapshot(recorder.finish())

    @property
    def time_s(self) -> float:
        """Model time since the start."""
        return self._native.time_s

    @property
    def steps(self) -> int:
        """Model steps since the start."""
        return self._native.step

    @property
    def time_step_s(self) -> float:
        """The model step."""
        return self._native.time_step_s

    @property
    def inputs(self) -> dict[str, float]:
        """The targets that act now, by the names of the arguments of `run`."""
        return dict(zip(NAMES, self._native.inputs))

    @property
    def input_limits(self) -> dict[str, tuple[float, float]]:
        """Smallest and largest value of each input, from the configuration."""
        return {name: (low, high) for name, (low, high) in zip(NAMES, self._native.input_limits)}

    @property
    def joint_stations(self) -> tuple[int, ...]:
        """Stations of the joints, top to bottom."""
        return tuple(self._native.joint_stations)

    @property
    def mass_kg(self) -> float:
        """Mass of the tool."""
        return self._native.mass_kg

    @property
    def configuration(self) -> dict[str, Any]:
        """The complete configuration, defaults included. Changes of it change nothing here."""
        return cast("dict[str, Any]", json.loads(self._native.configuration))

    @property
    def configuration_hash(self) -> str:
        """SHA-256 of the configuration, as the command line prints it."""
        return self._native.configuration_hash

    @property
    def friction(self) -> Friction:
        """The coefficients in force."""
        (inner, outer, bit) = self._native.live
        return Friction(inner[0], inner[1], outer[0], outer[1], bit)

    def set_friction(self, **changes: float) -> None:
        """Changes coefficients from the next step on: `twin.set_friction(pipe_guide_around=0.3)`.

        Raises `TypeError` for a name that `Friction` does not have, and `ValueOutOfBounds` for a value that is negative
        or not finite; then all stay.
        """
        new = replace(self.friction, **changes)
        self._native.set_live(
            [new.pipe_guide_around, new.pipe_guide_along], [new.guide_wall_around, new.guide_wall_along], new.bit
        )

    # --- The hole ahead --------------------------------------------------------------------------------------------

    def ahead(
        self, metres: float = 5.0, *, members: int = 24, weight_kn: Optional[float] = None, seed: int = 0
    ) -> HoleAhead:
        """Where this tool drills in the next metres, as `flexdrill ahead` computes it, with the range of plausible tools.

        The hole is that of the configuration, in a vertical plane at azimuth 0; the motion of the twin does not change it.
        `weight_kn` is the weight at the bit, without one the target that acts now, or 10 kN where that is 0. A range needs
        19 `members` with a result. The same arguments give the same bits. Python's lock is released meanwhile.

        Raises `ValueOutOfBounds` for a length or a number of members out of bounds. A tool for which nothing can be
        predicted is an answer with `known` False, and `because` says why.
        """
        weight = self.inputs["weight_kn"] or 10.0 if weight_kn is None else weight_kn
        because, no_range, radius, rates, counts, columns = self._native.ahead(metres, members, weight, seed)
        return HoleAhead(
            known=because is None,
            because=because or no_range or "",
            weight_n=1e3 * weight,
            radius_m=radius,
            build_rate_rad_per_m=rates[0],
            build_rate_low_rad_per_m=rates[1],
            build_rate_high_rad_per_m=rates[2],
            members=counts[0],
            failed=counts[1],
            **columns,
        )

    # --- Other twins -----------------------------------------------------------------------------------------------

    def fork(self) -> Twin:
        """Another twin in the same state. With the same inputs it moves to the same bits; neither knows of the
        other."""
        return Twin._of(self._native.fork())

    def disturb(self, seed: int) -> None:
        """Adds lateral velocities of up to 1e-5 m/s to the pipe, by random numbers that follow from `seed`. Forks of
        one state then part as the motion is sensitive to it: the members of an ensemble."""
        self._native.disturb(seed)

    def to_bytes(self) -> bytes:
        """Configuration and state."""
        return self._native.to_bytes()

    @classmethod
    def from_bytes(cls, data: bytes) -> Twin:
        """The twin of `to_bytes`, which goes on to the same bits. Raises `SavedStateError`."""
        return cls._of(_native.Twin.from_bytes(data))

    def save(self, path: Union[str, os.PathLike[str]]) -> None:
        """Writes configuration and state to a file, by way of a temporary file next to it."""
        target = Path(path)
        temporary = target.with_name(f".{target.name}.{os.getpid()}")
        try:
            temporary.write_bytes(self.to_bytes())
            os.replace(temporary, target)
        finally:
            temporary.unlink(missing_ok=True)

    @classmethod
    def load(cls, path: Union[str, os.PathLike[str]]) -> Twin:
        """The twin of a file that `save` wrote."""
        return cls.from_bytes(Path(path).read_bytes())

    def __copy__(self) -> Twin:
        return self.fork()

    def __deepcopy__(self, memo: dict[int, Any]) -> Twin:
        return self.fork()

    def __reduce__(self) -> tuple[Callable[[bytes], Twin], tuple[bytes]]:
        return (_restore, (self.to_bytes(),))


def _restore(data: bytes) -> Twin:
    """For pickle."""
    return Twin.from_bytes(data)
