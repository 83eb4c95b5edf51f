"""Exceptions. Each carries its figures as attributes; the message says the same in a sentence."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Optional

if TYPE_CHECKING:
    from ._results import Recording


class FlexdrillError(Exception):
    """Base of all exceptions of this package."""

    def __init__(self, message: str) -> None:
        super().__init__(message)

    def __reduce__(self) -> tuple[Callable[..., FlexdrillError], tuple[type[FlexdrillError], str, dict[str, Any]]]:
        return (_again, (type(self), str(self), dict(self.__dict__)))


def _again(kind: type[FlexdrillError], message: str, figures: dict[str, Any]) -> FlexdrillError:
    """For pickle: an exception of a worker process arrives with its figures."""
    error = kind.__new__(kind, message)
    error.__dict__.update(figures)
    return error


@dataclass(frozen=True)
class Problem:
    """One value of a configuration that is out of its bounds or contradicts another."""

    file: str
    """Name of the file, or what stands for it."""
    line: Optional[int]
    """Line of the value, or of the nearest enclosing key if the value is a default; None without a file."""
    key: str
    """Dotted path."""
    value: str
    """The value as written."""
    unit: str
    """Unit of value and bound; empty if dimensionless."""
    bound: str
    """What it must be."""
    reason: str
    """Why, or what to do."""


class ConfigError(FlexdrillError, ValueError):
    """A configuration was refused. `problems` has every value that is out of bounds; a text that cannot be read at all
    has none."""

    def __init__(self, message: str, problems: Sequence[Problem] = ()) -> None:
        super().__init__(message)
        self.problems: tuple[Problem, ...] = tuple(problems)


class StartError(FlexdrillError, RuntimeError):
    """The tool cannot be built, or does not come to rest under gravity and the initial weight on bit."""


class InputError(FlexdrillError, ValueError):
    """An input is outside the limits of the configuration. Nothing has been run towards it."""

    def __init__(
        self, message: str, input: str, time_s: float, value: float, bound: tuple[float, float], unit: str
    ) -> None:
        super().__init__(message)
        self.input = input
        """Name of the input, such as `rotary_speed`."""
        self.time_s = time_s
        """Model time from which it would act."""
        self.value = value
        self.bound = bound
        """Smallest and largest value."""
        self.unit = unit


class StepError(FlexdrillError, RuntimeError):
    """A step could not be taken, whatever its size. The twin is in the state before this step."""

    def __init__(
        self,
        message: str,
        time_s: float,
        step_s: float,
        station: int,
        body: str,
        cause: str,
        value: float,
        bound: Optional[tuple[float, float]],
        unit: str,
    ) -> None:
        super().__init__(message)
        self.time_s = time_s
        """Model time at the beginning of the sub-step that failed."""
        self.step_s = step_s
        """Size of that sub-step."""
        self.station = station
        """Station of the worst residual, counted from 0 at the top."""
        self.body = body
        """`pipe` or `guide`."""
        self.cause = cause
        """One word: not_converged, not_finite, singular, out_of_range, or the input that is out of its bounds."""
        self.value = value
        """Worst residual or pivot, or the input."""
        self.bound = bound
        """Smallest and largest value of the input; None for a residual."""
        self.unit = unit
        self.recording: Optional[Recording] = None
        """What was recorded up to the failure."""


class RecordError(FlexdrillError, ValueError):
    """A recording cannot be made: an unknown group, a rate that makes no sense, or more bytes than a machine has."""


class NotRecordedError(FlexdrillError, AttributeError):
    """A group that was not recorded was asked for."""


class ResultFileError(FlexdrillError, ValueError):
    """A sweep or a map cannot be read: a file is damaged, of another version, or of another plan."""

    def __init__(self, file: str, reason: str, remedy: str) -> None:
        super().__init__(f"{file}: {reason}: {remedy}")
        self.file = file
        """The file, or the directory."""
        self.reason = reason
        """What is wrong."""
        self.remedy = remedy
        """What to do."""


class SavedStateError(FlexdrillError, ValueError):
    """Bytes are no saved twin, damaged, or of another version."""


class ValueOutOfBounds(FlexdrillError, ValueError):
    """A value cannot be computed with."""
