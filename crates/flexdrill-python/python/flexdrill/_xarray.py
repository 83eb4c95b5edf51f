"""Columns as a dataset of xarray."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy.typing as npt
import xarray

Array = npt.NDArray[Any]

UNITS = {
    "_rad_per_s": "rad/s",
    "_m_per_s2": "m/s2",
    "_m_per_s": "m/s",
    "_w_per_m": "W/m",
    "_per_s": "1/s",
    "_rad": "rad",
    "_nm": "N m",
    "_ns": "N s",
    "_pa": "Pa",
    "_m": "m",
    "_n": "N",
    "_s": "s",
    "_j": "J",
    "_w": "W",
}
"""Endings of names and their units, the longer before the shorter."""

ALONG = {
    "joints": "joint",
    "contacts": "station",
    "shape": "station",
    "whirl": "watched",
    "hazards": "hazard",
    "reactions": "support",
}
"""The axis of values along the tool, by group."""


def unit_of(name: str) -> str:
    """The unit that a name carries; empty if it is dimensionless."""
    return next((unit for ending, unit in UNITS.items() if name.endswith(ending)), "")


def axes_of(name: str, shape: tuple[int, ...], fixed: bool) -> list[str]:
    """Names of the axes of a column."""
    group, _, column = name.rpartition(".")
    axes = [] if fixed else ["time"]
    rest = shape[len(axes) :]
    if not rest:
        return axes
    if group == "ageing":
        return [*axes, "station" if "friction_work" in column else "joint"]
    if group == "reactions" and column.endswith("_n") and len(rest) == 1:
        return [*axes, f"{group}_{len(rest)}_{rest[0]}"]
    axes.append(ALONG.get(group, f"{group}_axis"))
    return axes if len(rest) == 1 else [*axes, {2: "lateral", 3: "world"}.get(rest[1], f"{group}_component")]


def dataset(columns: Mapping[str, Array], fixed: frozenset[str]) -> xarray.Dataset:
    """A variable per column, named `bit.torque_nm`, with its unit; places along the tool are coordinates."""
    variables: dict[str, tuple[list[str], Array, dict[str, str]]] = {}
    coordinates: dict[str, tuple[list[str], Array, dict[str, str]]] = {}
    for name, values in columns.items():
        axes = axes_of(name, values.shape, name in fixed)
        unit = unit_of(name)
        entry = (axes, values, {"units": unit} if unit else {})
        if name == "time_s":
            coordinates["time"] = entry
        elif name in fixed:
            coordinates[name] = entry
        else:
            variables[name] = entry
    return xarray.Dataset(variables, coordinates)
