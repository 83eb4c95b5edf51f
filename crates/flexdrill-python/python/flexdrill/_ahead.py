"""The hole ahead."""

from __future__ import annotations

from dataclasses import dataclass

from ._groups import FloatArray


@dataclass(frozen=True)
class HoleAhead:
    """Where a tool drills next: arrays over stations each 0.25 m, the first at the bit. `low` and `high` are 5 and 95 % of
    the plausible tools. Positions are from the kick-off: horizontal at azimuth 0, to the right of it, down."""

    known: bool
    """Whether the tool as configured has an answer; without one the arrays are empty."""
    because: str
    """Why it has none, or why there is no range; empty where both are known."""
    weight_n: float
    """Weight at the bit."""
    radius_m: float
    """Radius that the tool drills to in a long arc; NaN where the thrust bends it without limit."""
    build_rate_rad_per_m: float
    """Turn of the inclination over the next metre."""
    build_rate_low_rad_per_m: float
    """NaN without a range."""
    build_rate_high_rad_per_m: float
    """NaN without a range."""
    members: int
    """Plausible tools with a result."""
    failed: int
    """Plausible tools without one."""
    measured_depth_m: FloatArray
    """Along the path from the kick-off."""
    inclination_rad: FloatArray
    inclination_low_rad: FloatArray
    """NaN without a range, as all that follow with `low`, `high`, or the sides of the range."""
    inclination_high_rad: FloatArray
    azimuth_rad: FloatArray
    azimuth_low_rad: FloatArray
    azimuth_high_rad: FloatArray
    position_m: FloatArray
    """Of the tool as configured, three values per station."""
    upper_m: FloatArray
    """Side of the range towards the high side of the hole."""
    lower_m: FloatArray
    """Side towards the low side."""
    right_m: FloatArray
    """Side to the right, looking down the hole."""
    left_m: FloatArray
    """Side to the left."""
