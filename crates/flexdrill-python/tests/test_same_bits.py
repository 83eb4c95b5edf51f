"""The package and the command line compute the same bits from the same configuration and inputs."""

from __future__ import annotations

import os
import subprocess
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

import flexdrill
from flexdrill import _alarms, _figures

BINARY = os.environ.get("FLEXDRILL_BINARY", "")

TIMES_S = [0.0, 1.0, 2.0, 3.0]
SPEED_RPM = [40.0, 57.3, 12.1, 80.0]
WEIGHT_KN = [5.0, 10.0, 10.0, 2.5]
DURATION_S = 4.0


@pytest.mark.skipif(not BINARY, reason="FLEXDRILL_BINARY does not name the program")
@pytest.mark.parametrize("config", ["default.yaml", "coarse.yaml"])
def test_a_replay_of_a_field_log(config: str, tmp_path: Path) -> None:
    pytest.importorskip("rosbags")
    twin = flexdrill.Twin(config)
    _replay(twin, TIMES_S, SPEED_RPM, WEIGHT_KN, DURATION_S, tmp_path)
    bag = flexdrill.read_bag(tmp_path / "run")
    run = twin.run(
        DURATION_S,
        speed_rpm=flexdrill.held(TIMES_S, SPEED_RPM),
        weight_kn=flexdrill.held(TIMES_S, WEIGHT_KN),
        record="all",
        rate_hz=50,
    )
    assert len(run) == 201
    equal = [
        ("twin/bit_state", "torque", run.bit.mean_torque_nm),
        ("twin/bit_state", "rotary_speed", run.bit.mean_rotary_speed_rad_per_s),
        ("twin/bit_state", "stick_slip_index", run.bit.stick_slip_index),
        ("twin/bit_state", "lateral_acceleration_peak", run.bit.lateral_acceleration_peak_m_per_s2),
        ("twin/joint_deflections", "bend_angle", run.joints.bend_angle_rad),
        ("twin/joint_deflections", "bend_direction", run.joints.bend_direction_rad),
        ("twin/joint_deflections", "lateral_y", run.joints.lateral_y_m),
        ("twin/joint_deflections", "torque", run.joints.torque_nm),
        ("twin/contact_forces", "pipe_guide_normal", run.contacts.pipe_guide_normal_n),
        ("twin/contact_forces", "pipe_guide_normal_peak", run.contacts.pipe_guide_normal_peak_n),
        ("twin/contact_forces", "guide_wall_normal_rms", run.contacts.guide_wall_normal_rms_n),
    ]
    for topic, field, ours in equal:
        theirs = bag[topic].fields[field]
        assert isinstance(theirs, np.ndarray) and theirs.shape == ours.shape, (topic, field)
        np.testing.assert_array_equal(theirs, ours, err_msg=f"{topic} {field}")
    # Every figure of the table: a column is a field, perhaps with `mean_` before it and a unit behind it. The transfer is
    # published at 10 Hz: every fifth sample.
    tables = [("twin/bit_state", run.bit, "BitFigures", 1), ("twin/transfer", run.transfer, "TransferFigures", 5)]
    for topic, group, name, every in tables:
        published = bag[topic].fields
        for column in [field.name for field in fields(getattr(_figures, name))]:
            named = [field for field in published if column.removeprefix("mean_").startswith(field)]
            expected = published[max(named, key=len)]
            np.testing.assert_array_equal(expected, getattr(group, column)[::every], err_msg=f"{topic} {column}")
    assert np.ptp(run.bit.torque_nm) > 10.0
    # Whirl is published at 10 Hz: every fifth sample.
    np.testing.assert_array_equal(bag["twin/whirl"].fields["whirl_rate"], run.whirl.whirl_rate_rad_per_s[::5])
    assert bag["twin/session"].config_hash[0] == twin.configuration_hash


@pytest.mark.skipif(not BINARY, reason="FLEXDRILL_BINARY does not name the program")
def test_the_alarms_of_a_replay(twin: flexdrill.Twin, tmp_path: Path) -> None:
    pytest.importorskip("rosbags")
    # Fast and light, so that the pipe whirls; some seconds longer than the longest delay of an alarm.
    times_s = [float(second) for second in range(12)]
    _replay(twin, times_s, [115.0] * 12, [5.0] * 12, 12.0, tmp_path)
    theirs = flexdrill.read_bag(tmp_path / "run")["twin/alarm_events"]
    run = twin.run(12.0, speed_rpm=115.0, weight_kn=5.0, record="bit", rate_hz=30)
    assert "backward_whirl" in {event.id for event in run.alarms}
    for field in ("id", "name", "evidence", "what_to_do", "what_the_engineer_can_do"):
        assert list(theirs.fields[field]) == [getattr(event, field) for event in run.alarms], field
    codes = {"change": _alarms.CHANGES, "to_state": _alarms.STATES, "priority": ("", *flexdrill.PRIORITIES)}
    for field, names in codes.items():
        ours = [getattr(event, field.removeprefix("to_")) for event in run.alarms]
        assert [names[int(code)] for code in theirs.fields[field]] == ours, field
    np.testing.assert_array_equal(theirs.fields["value"], [event.value for event in run.alarms])
    np.testing.assert_array_equal(theirs.fields["measured_depth"], [event.measured_depth_m for event in run.alarms])
    np.testing.assert_allclose(theirs.time_s, [event.time_s for event in run.alarms], atol=1e-9)


def _replay(
    twin: flexdrill.Twin,
    times_s: list[float],
    speed_rpm: list[float],
    weight_kn: list[float],
    duration_s: float,
    tmp_path: Path,
) -> None:
    """A log of these inputs, replayed by the program into tmp_path/run."""
    (tmp_path / "config.json").write_text(_json(twin))
    rows = [f"{time},{speed},{weight}\n" for time, speed, weight in zip(times_s, speed_rpm, weight_kn)]
    (tmp_path / "log.csv").write_text("time_s,rpm,wob\n" + "".join(rows))
    (tmp_path / "columns.yaml").write_text(
        "title: samples of a second\nseparator: ','\ncolumns:\n  time: {column: time_s, format: seconds}\n"
        "  rotary_speed: {column: rpm, unit: r/min}\n  weight_on_bit: {direct: {column: wob, unit: kN}}\n"
    )
    subprocess.run(
        [
            *(BINARY, "replay", tmp_path / "log.csv", "--mapping", tmp_path / "columns.yaml"),
            *("--config", tmp_path / "config.json", "--duration", str(duration_s), "--out", tmp_path / "run"),
        ],
        check=True,
        capture_output=True,
        timeout=120,
    )


def _json(twin: flexdrill.Twin) -> str:
    import json

    return json.dumps(twin.configuration)
