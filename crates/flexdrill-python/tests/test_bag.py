"""What is made of the messages of a bag. The reader of the file itself is rosbags."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import flexdrill


def messages(topic: str, **fields: Any) -> flexdrill.Messages:
    count = len(next(iter(fields.values()))) if fields else 0
    stamps = 1_700_000_000_000_000_000 + 1_000_000_000 * np.arange(count)
    return flexdrill.Messages(topic, "flexdrill/msg/Bands", (stamps - stamps[:1].sum()) * 1e-9, stamps, fields)


def band(name: str, unit: str, *quantiles: float) -> SimpleNamespace:
    p5, p50, p95 = quantiles
    return SimpleNamespace(name=name, unit=unit, p5=p5, p50=p50, p95=p95)


def chance(name: str, priority: int, probability: float) -> SimpleNamespace:
    return SimpleNamespace(id=name, priority=priority, probability=probability)


def test_bands_are_arrays_by_figure() -> None:
    topic = messages(
        "/twin/bands",
        members=np.array([12, 12, 12]),
        effective=np.array([12.0, 7.0, 9.5]),
        bands=[
            [band("bit_state/torque", "N m", 71.0, 92.0, 118.0)],
            [],
            [band("bit_state/torque", "N m", 70.0, 90.0, 110.0), band("transfer/efficiency", "", 0.7, 0.8, 0.9)],
        ],
        alarms=[[], [], [chance("shock", 1, 7 / 12), chance("shock", 3, 2 / 12)]],
    )
    bands = flexdrill.Bag({"/twin/bands": topic}).bands()
    torque = bands["bit_state/torque"]
    assert torque.unit == "N m"
    np.testing.assert_array_equal(torque.p5, [71.0, np.nan, 70.0])
    np.testing.assert_array_equal(torque.p95, [118.0, np.nan, 110.0])
    np.testing.assert_array_equal(bands["transfer/efficiency"].p50, [np.nan, np.nan, 0.8])
    np.testing.assert_array_equal(bands.chances["shock"], [0.0, 0.0, 7 / 12])
    np.testing.assert_array_equal(bands.time_s, [0.0, 1.0, 2.0])
    assert list(bands.members) == [12, 12, 12] and bands.effective[1] == 7.0


def test_a_bag_without_bands_says_so() -> None:
    with pytest.raises(KeyError, match="twin/bands"):
        flexdrill.Bag({}).bands()
    empty = flexdrill.Bag({"/twin/bands": messages("/twin/bands")}).bands()
    assert len(empty.time_s) == 0 and not empty.figures and not empty.chances
