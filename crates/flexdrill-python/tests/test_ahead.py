"""Where the tool drills next."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest

import flexdrill


@pytest.fixture(scope="module")
def twin() -> flexdrill.Twin:
    return flexdrill.Twin("rig.yaml")


def test_a_curved_guide_has_an_answer_with_a_range(twin: flexdrill.Twin) -> None:
    ahead = twin.ahead(1.0, weight_kn=10)
    assert ahead.known and ahead.because == "" and ahead.members + ahead.failed == 24
    assert ahead.measured_depth_m.shape == (5,) and ahead.position_m.shape == (5, 3)
    np.testing.assert_allclose(np.diff(ahead.measured_depth_m), 0.25, atol=1e-12)
    assert np.all(ahead.inclination_low_rad[1:] < ahead.inclination_high_rad[1:])
    assert ahead.build_rate_low_rad_per_m < ahead.build_rate_rad_per_m < ahead.build_rate_high_rad_per_m
    # The bit is where it is: all sides of the range meet there.
    for side in (ahead.upper_m, ahead.lower_m, ahead.right_m, ahead.left_m):
        np.testing.assert_allclose(side[0], ahead.position_m[0], atol=1e-9)
    # The chords between stations are as long as the way, less the rise of an arc of metres over 0.25 m.
    chords = np.linalg.norm(np.diff(ahead.position_m, axis=0), axis=1)
    np.testing.assert_allclose(chords, 0.25, rtol=1e-2)
    again = twin.ahead(1.0, weight_kn=10)
    for field in fields(ahead):
        np.testing.assert_array_equal(getattr(again, field.name), getattr(ahead, field.name), err_msg=field.name)


def test_few_members_have_no_range(twin: flexdrill.Twin) -> None:
    ahead = twin.ahead(0.5, members=2)
    assert ahead.known and "range" in ahead.because and ahead.weight_n == 1e4
    assert np.all(np.isnan(ahead.azimuth_high_rad)) and np.isnan(ahead.build_rate_low_rad_per_m)


def test_what_cannot_be_predicted_says_why() -> None:
    ahead = flexdrill.Twin("rig.yaml", **{"tool.bit.axis": "link"}).ahead(1.0)
    assert not ahead.known and "tool.bit.axis" in ahead.because and ahead.position_m.shape == (0, 3)
    assert np.isnan(ahead.radius_m)


def test_questions_out_of_bounds_are_refused(twin: flexdrill.Twin) -> None:
    for metres in (0.0, -1.0, float("nan"), 1e9):
        with pytest.raises(flexdrill.ValueOutOfBounds, match="metres"):
            twin.ahead(metres)
    with pytest.raises(flexdrill.ValueOutOfBounds, match="members"):
        twin.ahead(1.0, members=10**6)
