"""Many runs on threads."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import Optional, Union, cast

from . import _native
from ._errors import StepError, ValueOutOfBounds
from ._inputs import Input, Inputs, all_changes, share_of, steps_of
from ._results import Recording, wanted_groups
from ._twin import Twin


def rollout(
    twins: Sequence[Twin],
    inputs: Union[Inputs, Sequence[Inputs]],
    seconds: float,
    *,
    threads: Optional[int] = None,
    record: Union[str, Sequence[str]] = ("bit", "hazards"),
    rate_hz: float = 10.0,
    progress: Optional[Callable[[float], object]] = None,
) -> list[Recording]:
    """Runs twins side by side and returns a recording of each, in their order. The twins are advanced in place; run
    forks to keep a state.

    `inputs` is one mapping per twin, or one for all, with the arguments of `Twin.run`. A function of time is asked for
    all its values before the runs begin. `threads` is the number of processors unless it is given; it changes no bit. A
    run whose step fails ends there, and its recording has the `failure`; the others go on. `progress` is called with
    the share of the runs that ended.

    Raises `InputError` before anything runs when an input is outside the limits of a twin's configuration.
    """
    many: Sequence[Inputs] = [inputs] * len(twins) if isinstance(inputs, Mapping) else inputs
    if len(many) != len(twins):
        raise ValueOutOfBounds(
            f"inputs has {len(many)} entries: must be one mapping, or one for each of {len(twins)} twins"
        )
    if len({id(twin) for twin in twins}) != len(twins):
        raise ValueOutOfBounds("a twin is listed twice: it can only be advanced by one run; list a fork")
    if threads is not None and threads < 1:
        raise ValueOutOfBounds(f"threads = {threads}: must be 1 or more")
    steps: list[int] = []
    changes: list[_native.Changes] = []
    recorders: list[_native.Recorder] = []
    for twin, of_twin in zip(twins, many):
        steps.append(steps_of(seconds, twin.time_step_s))
        named = cast("Mapping[str, Input]", of_twin)
        changes.append(all_changes(named, steps[-1], twin.time_s, twin.steps, twin.time_step_s))
        recorders.append(_native.Recorder(wanted_groups(record), rate_hz, twin.time_step_s))
    count = len(twins)
    natives = [twin._native for twin in twins]
    failures = _native.rollout(
        natives, steps, changes, recorders, threads or os.cpu_count() or 1, share_of(progress, count)
    )
    return [
        Recording._of(recorder, cast("Optional[StepError]", failure))
        for recorder, failure in zip(recorders, failures)
    ]
