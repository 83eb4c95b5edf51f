"""Shared by the tests: one small tool, built once, forked by each."""

from __future__ import annotations

from typing import Any

import pytest

import flexdrill

SMALL: dict[str, Any] = {
    "well": {"sections": [{"arc": {"radius": 3.2, "build_angle_deg": 16.4}}], "hole_diameter": 0.118},
    "tool": {
        "links": 6,
        "elements_per_link": 3,
        "pipe": {"outer_diameter": 0.063, "inner_diameter": 0.032},
        "guide": {"outer_diameter": 0.102, "inner_diameter": 0.080},
        "joint": {"limit_deg": 6.0},
        "bit": {"diameter": 0.118},
    },
}
"""Six links of the paper's tool: all of its mechanics in a fifth of the time."""


@pytest.fixture(scope="session")
def built() -> flexdrill.Twin:
    return flexdrill.Twin(SMALL)


@pytest.fixture
def twin(built: flexdrill.Twin) -> flexdrill.Twin:
    return built.fork()


@pytest.fixture
def turning(built: flexdrill.Twin) -> flexdrill.Twin:
    """In motion, so that a state consists of more than its start."""
    fork = built.fork()
    fork.step(400, speed_rpm=60, weight_kn=5)
    return fork
