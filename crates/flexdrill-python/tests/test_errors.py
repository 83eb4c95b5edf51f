"""What is wrong is said with its figures, and changes nothing."""

from __future__ import annotations

import pickle
from typing import cast

import pytest
from conftest import SMALL

import flexdrill


def test_a_configuration_names_every_problem() -> None:
    with pytest.raises(flexdrill.ConfigError) as caught:
        flexdrill.Twin(SMALL, tool__joint__limit_deg=400, contact__inner__stiffness=-1.0)
    keys = [problem.key for problem in caught.value.problems]
    assert keys == ["tool.joint.limit_deg", "contact.inner.stiffness"]
    stiffness = caught.value.problems[1]
    assert stiffness.unit == "N/m" and stiffness.value.startswith("-1") and stiffness.bound
    assert isinstance(caught.value, ValueError)


@pytest.mark.parametrize(
    ("config", "overrides", "words"),
    [
        ({"well": 3}, {}, "well"),
        (SMALL, {"tool.nothing": 1}, "no such key"),
        (SMALL, {"tool.links": "many"}, "must be a number"),
        ({**SMALL, "unknown": 1}, {}, "unknown"),
    ],
)
def test_a_configuration_that_cannot_be_read(
    config: flexdrill.Config, overrides: dict[str, object], words: str
) -> None:
    with pytest.raises(flexdrill.ConfigError, match=words):
        flexdrill.Twin(config, **overrides)


def test_a_file_that_is_not_there() -> None:
    with pytest.raises(FileNotFoundError):
        flexdrill.Twin("no such file.yaml")


def test_an_input_beyond_the_limits(twin: flexdrill.Twin) -> None:
    with pytest.raises(flexdrill.InputError) as caught:
        twin.run(0.1, speed_rpm=[40, 400])
    error = caught.value
    assert (error.input, error.value, error.unit) == ("rotary_speed", 400.0, "r/min")
    assert error.bound == tuple(twin.input_limits["speed_rpm"]) == (0.0, 120.0)
    assert error.time_s == pytest.approx(0.05)
    assert twin.steps == 0
    with pytest.raises(flexdrill.InputError):
        twin.run(0.1, weight_kn=float("nan"))


@pytest.mark.parametrize("seconds", [-1.0, float("nan"), float("inf")])
def test_times_that_make_no_sense(twin: flexdrill.Twin, seconds: float) -> None:
    with pytest.raises(flexdrill.ValueOutOfBounds):
        twin.run(seconds)


def test_recordings_that_make_no_sense(twin: flexdrill.Twin) -> None:
    with pytest.raises(flexdrill.RecordError, match="no group; the groups are applied"):
        twin.run(0.1, record=["bits"])
    with pytest.raises(flexdrill.RecordError, match="at most 2000 Hz"):
        twin.run(0.1, rate_hz=3000)
    with pytest.raises(flexdrill.RecordError, match="bytes"):
        twin.run(1e9, record="all", rate_hz=2000)
    with pytest.raises(flexdrill.NotRecordedError, match="joints was not recorded"):
        _ = twin.run(0.02, record=["bit"]).joints
    assert twin.steps == 40
    with pytest.raises(flexdrill.ValueOutOfBounds, match="1 to 4 values"):
        twin.run(0.002, speed_rpm=[1, 2, 3, 4, 5])


def failing() -> flexdrill.Twin:
    """A step that no halving saves: hardly an iteration is allowed, and no halving."""
    return flexdrill.Twin(SMALL, solver__max_iterations=2, solver__max_halvings=0, contact__inner__stiffness=1e9)


def test_a_step_that_fails_says_where_and_keeps_the_samples() -> None:
    twin = failing()
    with pytest.raises(flexdrill.StepError) as caught:
        twin.run(5, speed_rpm=120, weight_kn=60)
    error = caught.value
    assert error.cause == "not_converged" and error.body in flexdrill.BODIES
    assert 0 <= error.station < 19 and error.value > 0 and error.unit == "N or N m"
    assert error.time_s == pytest.approx(twin.time_s)
    assert error.recording is not None and error.recording.time_s[-1] <= error.time_s
    assert str(error.station) in str(error)


def test_a_rollout_says_which_run_failed(built: flexdrill.Twin) -> None:
    runs = flexdrill.rollout([built.fork(), failing()], {"speed_rpm": 120, "weight_kn": 60}, 5, threads=2)
    assert runs[0].failure is None and runs[0].time_s[-1] == pytest.approx(5.0)
    assert isinstance(runs[1].failure, flexdrill.StepError)
    assert runs[1].time_s[-1] < 5.0


def test_a_rollout_of_the_same_twin_twice(twin: flexdrill.Twin) -> None:
    with pytest.raises(flexdrill.ValueOutOfBounds, match="twice"):
        flexdrill.rollout([twin, twin], {}, 0.1)
    with pytest.raises(flexdrill.ValueOutOfBounds, match="is no input"):
        flexdrill.rollout([twin], cast(flexdrill.Inputs, {"speed": 40}), 0.1)
    with pytest.raises(flexdrill.ValueOutOfBounds, match="2 twins"):
        flexdrill.rollout([twin, twin.fork()], [{}], 0.1)


def test_damaged_states_are_refused(twin: flexdrill.Twin) -> None:
    data = twin.to_bytes()
    for damaged in (b"", b"other bytes", data[:40], data[:-1], data[:100] + b"x" + data[101:]):
        with pytest.raises(flexdrill.SavedStateError):
            flexdrill.Twin.from_bytes(damaged)
    with pytest.raises(flexdrill.SavedStateError, match="format"):
        flexdrill.Twin.from_bytes(data[:8] + b"\x09" + data[9:])


def test_exceptions_of_a_worker_process_arrive() -> None:
    with pytest.raises(flexdrill.InputError) as caught:
        flexdrill.Twin(SMALL).run(0.1, speed_rpm=400)
    again = pickle.loads(pickle.dumps(caught.value))
    assert isinstance(again, flexdrill.InputError) and again.value == 400.0 and str(again) == str(caught.value)
