"""The alarms of a run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ._results_file import PRIORITIES

if TYPE_CHECKING:
    from ._native import AlarmRow

CHANGES = (
    "activated",
    "raised",
    "lowered",
    "returned",
    "acknowledged",
    "shelved",
    "unshelved",
    "suppressed",
    "released",
    "taken_out",
    "put_back",
    "adjusted",
)
"""Names of the changes, by their codes in `twin/alarm_events`."""
STATES = (
    "normal",
    "active_unacknowledged",
    "active_acknowledged",
    "returned_unacknowledged",
    "shelved",
    "suppressed_by_design",
    "out_of_service",
)
"""Names of the states, by their codes."""
PLACES = ("", "pipe", "guide")
"""Names of the bodies, by their codes; empty for none."""


@dataclass(frozen=True)
class AlarmEvent:
    """One change of one alarm, as the node publishes it on `twin/alarm_events`."""

    time_s: float
    """Model time."""
    id: str
    """The alarm for programs, such as `backward_whirl`."""
    name: str
    """The alarm for people."""
    change: str
    """What has changed: `activated`, `raised`, `lowered`, `returned`, or another of the message's changes."""
    state: str
    """The state from now on. An alarm that has returned waits for an acknowledgement, which a run does not have."""
    priority: str
    """`low`, `medium` or `high`; empty where there is none."""
    evidence: str
    """What happens, in a sentence; empty where the condition is absent."""
    what_to_do: str
    """What the driller can do."""
    what_the_engineer_can_do: str
    body: str
    """The body with the worst value, `pipe` or `guide`; empty where there is none."""
    measured_depth_m: float
    """Where it is, from the kick-off; NaN where there is no place."""
    value: float
    """The value that was judged; NaN where there is none."""


def events(rows: Sequence[AlarmRow]) -> tuple[AlarmEvent, ...]:
    """From the values of the compiled module, whose codes are those of the message."""
    return tuple(_event(*row) for row in rows)


def _event(
    time_s: float,
    id: str,
    name: str,
    change: int,
    state: int,
    priority: int,
    evidence: str,
    what_to_do: str,
    what_the_engineer_can_do: str,
    body: int,
    measured_depth_m: float,
    value: float,
) -> AlarmEvent:
    return AlarmEvent(
        time_s,
        id,
        name,
        CHANGES[change],
        STATES[state],
        ("", *PRIORITIES)[priority],
        evidence,
        what_to_do,
        what_the_engineer_can_do,
        PLACES[body],
        measured_depth_m,
        value,
    )
