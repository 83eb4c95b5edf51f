"""Runs, their recordings and states."""

from __future__ import annotations

import copy
import pickle
import threading
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from conftest import SMALL

import flexdrill
from flexdrill import _groups, _native


def same(one: flexdrill.Recording, other: flexdrill.Recording) -> None:
    assert one.columns.keys() == other.columns.keys()
    for name, values in one.columns.items():
        np.testing.assert_array_equal(values, other.columns[name], err_msg=name)


def test_the_groups_have_the_fields_of_the_core() -> None:
    for group in flexdrill.GROUPS:
        of_core = {column for at, column, _ in _native.columns() if at == group}
        of_class = {field.name for field in fields(getattr(_groups, group.capitalize()))}
        assert of_core == of_class, group


def test_a_recording_has_samples_by_rate(twin: flexdrill.Twin) -> None:
    run = twin.run(0.2, speed_rpm=40, weight_kn=5, record="all", rate_hz=100)
    np.testing.assert_allclose(run.time_s, np.arange(21) * 0.01, atol=1e-12)
    assert len(run) == 21 and run.step[-1] == 400 == twin.steps
    assert run.groups == flexdrill.GROUPS
    assert run.joints.bend_angle_rad.shape == (21, 5)
    assert run.joints.measured_depth_m.shape == (5,)
    assert run.contacts.state.shape == (21, 19) and run.contacts.state.dtype == np.uint8
    assert run.shape.bore_m.shape == (19, 3) and run.shape.pipe_m.shape == (21, 19, 2)
    assert run.hazards.severity.shape == (21, len(flexdrill.HAZARDS))
    assert run.reactions.force_n.shape[2] == 3
    # The drive slews by 20 r/min per second.
    assert run.applied.rotary_speed_rad_per_s[-1] == pytest.approx(4.0 * np.pi / 30.0)


def test_arrays_cannot_be_written_to(twin: flexdrill.Twin) -> None:
    run = twin.run(0.02, record=["bit"])
    with pytest.raises(ValueError, match="read-only"):
        run.bit.torque_nm[0] = 1.0


def test_a_snapshot_agrees_with_the_last_sample(twin: flexdrill.Twin) -> None:
    run = twin.run(0.1, speed_rpm=40, record="all", rate_hz=100)
    snapshot = twin.snapshot()
    assert snapshot.time_s == run.time_s[-1]
    assert snapshot.bit.torque_nm == run.bit.torque_nm[-1]
    assert isinstance(snapshot.bit.torque_nm, float) and isinstance(snapshot.quality.level, int)
    np.testing.assert_array_equal(snapshot.joints.bend_angle_rad, run.joints.bend_angle_rad[-1])
    assert snapshot.energy.drive_j == run.energy.drive_j[-1]


def test_two_runs_equal_one(built: flexdrill.Twin) -> None:
    whole, parts = built.fork(), built.fork()
    one = whole.run(0.3, speed_rpm=60, weight_kn=5)
    # Seven steps are no whole period of 5 ms.
    first = parts.run(0.1035, speed_rpm=60, weight_kn=5)
    second = parts.run(0.1965)
    np.testing.assert_array_equal(one.bit.torque_nm, np.concatenate([first.bit.torque_nm, second.bit.torque_nm]))
    np.testing.assert_array_equal(
        one.joints.lateral_z_m, np.concatenate([first.joints.lateral_z_m, second.joints.lateral_z_m])
    )


def test_numbers_arrays_and_functions_are_the_same_inputs(built: flexdrill.Twin) -> None:
    def speed(time_s: float) -> float:
        return 0.0 if time_s < 0.1 - 1e-9 else 60.0

    of_array = built.fork().run(0.2, speed_rpm=[0, 60], weight_kn=5)
    of_function = built.fork().run(0.2, speed_rpm=speed, weight_kn=np.array([5.0]))
    held = built.fork().run(0.2, speed_rpm=flexdrill.held([0.0, 0.1], [0.0, 60.0]), weight_kn=5)
    parts = built.fork()
    parts.step(200, speed_rpm=0, weight_kn=5)
    last = parts.run(0.1, speed_rpm=60)
    same(of_array, of_function)
    same(of_array, held)
    np.testing.assert_array_equal(of_array.bit.torque_nm[-1], last.bit.torque_nm[-1])
    other = built.fork().run(0.2, speed_rpm=60, weight_kn=5)
    assert of_array.bit.torque_nm[-1] != other.bit.torque_nm[-1]


def test_a_fork_moves_alone_and_to_the_same_bits(turning: flexdrill.Twin) -> None:
    fork, copied = turning.fork(), copy.deepcopy(turning)
    same(turning.run(0.1), fork.run(0.1))
    assert copied.time_s == pytest.approx(0.2) and turning.time_s == pytest.approx(0.3)


def test_a_saved_twin_goes_on_to_the_same_bits(turning: flexdrill.Twin, tmp_path: Path) -> None:
    turning.set_friction(pipe_guide_around=0.35)
    turning.step(7)
    turning.save(tmp_path / "state")
    assert [path.name for path in tmp_path.iterdir()] == ["state"]
    loaded = flexdrill.Twin.load(tmp_path / "state")
    pickled: flexdrill.Twin = pickle.loads(pickle.dumps(turning))
    assert loaded.inputs == turning.inputs and loaded.configuration == turning.configuration
    assert pickled.friction.pipe_guide_around == 0.35
    run = turning.run(0.2, record="all")
    same(run, loaded.run(0.2, record="all"))
    same(run, pickled.run(0.2, record="all"))
    again: flexdrill.Recording = pickle.loads(pickle.dumps(run))
    same(run, again)


def test_reset_returns_to_the_start(built: flexdrill.Twin) -> None:
    twin = built.fork()
    before = twin.run(0.1, speed_rpm=60, weight_kn=5)
    twin.reset()
    assert twin.time_s == 0.0
    same(before, twin.run(0.1, speed_rpm=60, weight_kn=5))


def test_disturbed_forks_part(turning: flexdrill.Twin) -> None:
    forks = [turning.fork() for _ in range(3)]
    for fork, seed in zip(forks, (1, 1, 2)):
        fork.disturb(seed)
    first, alike, other = (fork.run(0.1).joints.lateral_y_m[-1] for fork in forks)
    np.testing.assert_array_equal(first, alike)
    assert np.any(first != other)


def test_friction_changes_the_motion(turning: flexdrill.Twin) -> None:
    fork = turning.fork()
    fork.set_friction(bit=0.5)
    assert turning.friction.bit != 0.5
    ratio = fork.run(0.05).bit.torque_nm[-1] / turning.run(0.05).bit.torque_nm[-1]
    # Torque is proportional to the factor; the bit's speed and with it the regularisation differ a little.
    assert ratio == pytest.approx(0.5 / turning.friction.bit, rel=0.02)
    with pytest.raises(flexdrill.ValueOutOfBounds):
        fork.set_friction(bit=-1.0)
    with pytest.raises(TypeError):
        fork.set_friction(rock=1.0)


def test_rollout_is_the_same_for_any_number_of_threads(turning: flexdrill.Twin) -> None:
    def batch(threads: int) -> list[flexdrill.Recording]:
        twins = [turning.fork() for _ in range(5)]
        inputs: list[flexdrill.Inputs] = [{"weight_kn": 2.0 + number} for number in range(5)]
        return flexdrill.rollout(twins, inputs, 0.1, threads=threads, record="all", rate_hz=100)

    alone, together = batch(1), batch(3)
    for one, other in zip(alone, together):
        same(one, other)
    by_hand = turning.fork().run(0.1, weight_kn=4.0, record="all", rate_hz=100)
    same(by_hand, together[2])
    forces = [run.bit.weight_on_bit_n[-1] for run in together]
    assert forces[4] > forces[0]


def test_a_run_releases_the_lock(built: flexdrill.Twin) -> None:
    twin, counted, done = built.fork(), 0, threading.Event()

    def run() -> None:
        twin.run(0.5, speed_rpm=60)
        done.set()

    worker = threading.Thread(target=run)
    worker.start()
    while not done.is_set():
        counted += 1
    worker.join()
    # With the lock held this loop would get a turn at the run's own looks at signals only: some per second.
    assert counted > 1000, counted


def test_progress_ends_at_one(twin: flexdrill.Twin) -> None:
    shares: list[float] = []
    twin.run(0.3, progress=shares.append)
    assert shares == sorted(shares) and shares[-1] == 1.0 and len(shares) == 3


def test_xarray_has_units_and_places(twin: flexdrill.Twin) -> None:
    pytest.importorskip("xarray")
    data = twin.run(0.1, record="all").to_xarray()
    assert data["bit.torque_nm"].attrs["units"] == "N m"
    assert data["joints.bend_angle_rad"].dims == ("time", "joint")
    assert data["shape.pipe_m"].dims == ("time", "station", "lateral")
    assert data["transfer.drive_power_w"].attrs["units"] == "W" and data["transfer.drive_power_w"].dims == ("time",)
    assert data["time"].attrs["units"] == "s"
    assert data["joints.measured_depth_m"].dims == ("joint",)


def test_overrides_change_single_keys() -> None:
    twin = flexdrill.Twin(SMALL, tool__joint__limit_deg=8, **{"contact.inner.friction_axial": 0.4})
    assert twin.configuration["tool"]["joint"]["limit_deg"] == 8
    assert twin.friction.pipe_guide_along == 0.4
    assert twin.configuration_hash != flexdrill.Twin(SMALL).configuration_hash


def test_the_shipped_configurations_are_there() -> None:
    assert {"default.yaml", "coarse.yaml", "paper.yaml", "rig.yaml"} <= set(flexdrill.shipped_configs())
    assert flexdrill.Twin("coarse.yaml").configuration["run"]["title"] == "The paper's case, coarse"
