"""Inputs of a run: numbers, arrays and functions of time."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional, TypedDict, Union, cast

import numpy as np
import numpy.typing as npt

from ._errors import ValueOutOfBounds
from ._groups import FloatArray

if TYPE_CHECKING:
    from ._native import Changes

Values = Union[Sequence[float], npt.NDArray[np.floating[Any]]]
"""Several numbers."""
Input = Union[float, Values, Callable[[float], float]]
"""A number acts during the whole run. The n values of an array act for one n-th of the run each. A function takes the
model time (s) and is asked every 5 ms. Without an input the last one stays."""

PERIOD_S = 5e-3
"""Time between two calls of a function: the input period of node and replay."""


class Inputs(TypedDict, total=False):
    """Inputs of one run of a rollout; what is left out stays."""

    speed_rpm: Input
    weight_kn: Input
    rate_of_penetration_m_per_h: Input
    standpipe_pressure_mpa: Input


NAMES = ("speed_rpm", "weight_kn", "rate_of_penetration_m_per_h", "standpipe_pressure_mpa")


def steps_of(seconds: float, time_step_s: float) -> int:
    """Model steps in a time, rounded."""
    if not (math.isfinite(seconds) and seconds >= 0.0):
        raise ValueOutOfBounds(f"seconds = {seconds}: must be a finite time, 0 s or more")
    return round(seconds / time_step_s)


def period_steps(time_step_s: float) -> int:
    """Model steps between two calls of a function."""
    return max(1, round(PERIOD_S / time_step_s))


def share_of(progress: Optional[Callable[[float], object]], whole: int) -> Optional[Callable[[int], object]]:
    """Takes a count and passes on its share of the whole."""
    if progress is None:
        return None
    hear = progress

    def take(count: int) -> object:
        return hear(count / whole)

    return take


def is_function(value: Optional[Input]) -> bool:
    """Whether an input is a function of time."""
    return callable(value)


def constant_changes(name: str, value: Optional[Input], steps: int) -> list[tuple[int, float]]:
    """The values of a number or an array, each with the step from which it acts; none of a function."""
    if value is None or callable(value):
        return []
    values = np.asarray(value, dtype=np.float64)
    if values.ndim == 0:
        return [(0, float(values))]
    if values.ndim != 1 or not 1 <= len(values) <= max(steps, 1):
        raise ValueOutOfBounds(
            f"{name} has the shape {values.shape}: must be a number, or 1 to {steps} values, one per model step at most"
        )
    starts = np.round(np.arange(len(values)) * (steps / len(values))).astype(int)
    return list(zip(starts.tolist(), cast("list[float]", values.tolist())))


def ask(function: Optional[Input], time_s: float) -> float:
    """The value of a function of time."""
    return float(cast("Callable[[float], float]", function)(time_s))


def all_changes(inputs: Mapping[str, Input], steps: int, begun_s: float, begun: int, time_step_s: float) -> Changes:
    """The changes of a whole run; functions are asked for all their values at once."""
    unknown = set(inputs) - set(NAMES)
    if unknown:
        raise ValueOutOfBounds(f"inputs: {', '.join(sorted(unknown))} is no input; the inputs are {', '.join(NAMES)}")
    period = period_steps(time_step_s)
    out: list[list[tuple[int, float]]] = []
    for name in NAMES:
        value = inputs.get(name)
        if is_function(value):
            starts = [0, *range(period - begun % period, steps, period)]
            out.append([(start, ask(value, begun_s + start * time_step_s)) for start in starts])
        else:
            out.append(constant_changes(name, value, steps))
    return cast("Changes", tuple(out))


def held(times_s: Values, values: Values) -> Callable[[float], float]:
    """A function of time that holds each value from its time on, as the samples of a rig act: for `Twin.run` and
    `rollout`. Before the first time the first value acts."""
    times: FloatArray = np.asarray(times_s, dtype=np.float64)
    known: FloatArray = np.asarray(values, dtype=np.float64)
    if times.ndim != 1 or times.shape != known.shape or len(times) == 0 or bool(np.any(np.diff(times) < 0.0)):
        raise ValueOutOfBounds("held: times and values must be of the same length, at least one, and the times rising")

    def at(time_s: float) -> float:
        # A model time is a product of steps; it must not miss the sample of its own instant by the last bit.
        index = int(np.searchsorted(times, time_s + 1e-9, side="right")) - 1
        return float(known[max(index, 0)])

    return at
