"""Sweeps and maps that the program makes, read as arrays. Damaged and foreign files are refused with file and remedy."""

from __future__ import annotations

import csv
import hashlib
import json
import os
import pickle
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import flexdrill

BINARY = os.environ.get("FLEXDRILL_BINARY", "")
ROOT = Path(__file__).resolve().parents[3]

pytestmark = pytest.mark.skipif(not BINARY, reason="FLEXDRILL_BINARY does not name the program")


def program(*arguments: object) -> None:
    subprocess.run([BINARY, *map(str, arguments)], check=True, capture_output=True, timeout=300, cwd=ROOT)


def table(file: Path) -> list[dict[str, str]]:
    with file.open(newline="") as opened:
        return list(csv.DictReader(opened))


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A sweep of eight points, worked and collected."""
    folder = tmp_path_factory.mktemp("results") / "sweep"
    program("sweep", "plan", "tests/data/sweep.yaml", folder)
    program("sweep", "work", folder, "--jobs", 2)
    program("sweep", "collect", folder)
    return folder


@pytest.fixture(scope="module")
def mapped(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A map of three speeds and two weights, of which not all runs are made."""
    folder = tmp_path_factory.mktemp("results") / "map"
    program(
        *("map", "tests/data/small.yaml", "--rpm", "30:110", "--wob", "1:9", "--grid", "3x3", "--horizon", 10),
        *("--members", 2, "--share", 80, "--jobs", 2, "--out", folder),
    )
    return folder


@pytest.fixture
def copy(swept: Path, tmp_path: Path) -> Path:
    shutil.copytree(swept, tmp_path / "copy")
    return tmp_path / "copy"


def close(cell: str, value: float) -> bool:
    # The program reads the numbers of its files to the last bit but one, and writes the table of what it has read.
    return bool(np.isnan(value)) if cell == "" else abs(float(cell) - value) <= 4e-16 * abs(value)


def test_a_sweep_has_the_values_of_its_table(swept: Path) -> None:
    sweep = flexdrill.read_sweep(swept)
    rows = table(swept / "points.csv")
    assert len(sweep) == len(rows) == 8 and sweep.horizon_s == 10.0 and sweep.most_members == 2
    assert list(sweep.values) == ["inputs.rotary_speed.initial_rpm", "inputs.weight_on_bit.initial_kn"]
    assert len(sweep.figures) > 5 and len(sweep.alarms) > 5
    for at, row in enumerate(rows):
        assert row["point"] == sweep.point[at] and row["start"] == sweep.start[at]
        assert row["state"] == sweep.state[at] == "known" and row["failure"] == sweep.failure[at]
        assert int(row["seed"]) == sweep.seed[at] and close(row["run_up_s"], sweep.run_up_s[at])
        assert (int(row["members"]), int(row["failed"])) == (sweep.members[at], sweep.failed[at])
        assert [int(row[name]) for name in ("good", "degraded", "poor")] == sweep.quality[at].tolist()
        any_alarm = [int(row[f"any_alarm_{priority}"]) for priority in flexdrill.PRIORITIES]
        assert any_alarm == sweep.any_alarm[at].tolist()
        for key, values in sweep.values.items():
            assert float(row[key]) == values[at]
        for alarm, counts in sweep.alarms.items():
            for number, priority in enumerate(flexdrill.PRIORITIES):
                assert int(row[f"{alarm}_{priority}"]) == counts[at, number]
        for name, figure in sweep.figures.items():
            for number, quantile in enumerate(("p5", "p50", "p95")):
                assert close(row[f"{name}_{quantile}"], figure[at, number]), name
    assert any(np.isfinite(figure).all() and np.ptp(figure) > 0.0 for figure in sweep.figures.values())
    seen = max(sweep.alarms, key=lambda alarm: int(sweep.alarms[alarm].sum()))
    np.testing.assert_array_equal(sweep.chance(seen), sweep.alarms[seen] / 2.0)
    with pytest.raises(flexdrill.NotRecordedError, match="is no alarm of this sweep"):
        sweep.chance("no_alarm")


def test_points_of_random_values_and_words_are_found(tmp_path: Path) -> None:
    keys = ("contact.inner.friction_tangential", "contact.outer.friction_tangential")
    ranges = ", ".join(f"{key}: [0.1, 0.6]" for key in keys)
    (tmp_path / "random.yaml").write_text(
        f"configuration: {ROOT}/tests/data/small.yaml\nhorizon: 10\nmembers: 1\nstarts: [rest]\n"
        f"latin_hypercube: {{points: 8, seed: 3, ranges: {{{ranges}}}}}\n"
    )
    (tmp_path / "words.yaml").write_text(
        f"configuration: {ROOT}/tests/data/small.yaml\nhorizon: 10\nmembers: 1\nstarts: [rest]\n"
        "list:\n- {contact.outer.friction: separate, contact.inner.friction_tangential: 0.2}\n"
        "- {contact.outer.friction: vector, contact.inner.friction_tangential: 0.3}\n"
    )
    for name in ("random", "words"):
        program("sweep", "plan", tmp_path / f"{name}.yaml", tmp_path / name)
        program("sweep", "work", tmp_path / name, "--jobs", 2)
        sweep = flexdrill.read_sweep(tmp_path / name)
        assert set(sweep.state) == {"known"} and len(set(sweep.point)) == len(sweep)
    assert flexdrill.read_sweep(tmp_path / "words").values["contact.outer.friction"].tolist() == ["separate", "vector"]


def test_a_sweep_as_a_grid_of_xarray(swept: Path) -> None:
    pytest.importorskip("xarray")
    sweep = flexdrill.read_sweep(swept)
    dataset: Any = sweep.to_xarray()
    assert dataset["stop_moment_nm"].attrs["units"] == "N m"
    keys = list(sweep.values)
    grid = dataset["stop_moment_nm"].set_index(point=[*keys, "start"]).unstack("point")
    at = grid.sel({keys[0]: 60, keys[1]: 5, "start": "rest", "quantile": 0.5})
    chosen = (sweep.values[keys[0]] == 60) & (sweep.values[keys[1]] == 5) & (sweep.start == "rest")
    assert np.count_nonzero(chosen) == 1
    assert at.item() == sweep.figures["stop_moment_nm"][chosen, 1]


def test_a_map_has_the_values_of_its_table(mapped: Path) -> None:
    read = flexdrill.read_map(mapped)
    assert repr(flexdrill.read_map(mapped / "map.json")) == repr(read)
    rows = table(mapped / "map.csv")
    assert read.x.values.tolist() == [30.0, 70.0, 110.0] and read.x.unit == "r/min" and read.y.unit == "kN"
    assert read.starts == ("rest", "running") and read.verdict.shape == (3, 3) and len(rows) == 18
    assert np.count_nonzero(read.state != "inferred") == read.runs < 18
    assert read.model_time_s > 10.0 * read.runs and read.first_looks == 0 and read.posterior is None
    for number, row in enumerate(rows):
        cell, start = divmod(number, 2)
        at = (start, *divmod(cell, 3))
        assert row["verdict"] == read.verdict[at[1:]] and row["start"] == read.starts[start]
        assert row["state"] == read.state[at] and row["alarm"] == read.alarm[at]
        assert (row["expected"] == "true") == read.expected[at] and int(row["members"]) == read.members[at]
        # The table has four digits of the chances.
        assert row["chance"] == ("" if np.isnan(read.chance[at]) else f"{read.chance[at]:.4f}")
        assert [row["chance_low"], row["chance_high"]] == [f"{end:.4f}" for end in read.chance_interval[at]]
        for alarm, counts in read.alarms.items():
            for which, priority in enumerate(flexdrill.PRIORITIES):
                assert (row[f"{alarm}_{priority}"] or "0") == str(counts[(*at, which)])
        for name, unit in read.units.items():
            column = name if not unit else name[: name.rindex(flexdrill_ending(unit))]
            for which, quantile in enumerate(("p5", "p50", "p95")):
                title = f"{column}_{quantile}" + (f" ({unit})" if unit else "")
                assert close(row[title], read.figures[name][(*at, which)]), title
    assert any(np.isfinite(figure).any() for figure in read.figures.values())


def test_what_is_not_known_is_a_class_of_its_own(mapped: Path, tmp_path: Path) -> None:
    content = json.loads((mapped / "map.json").read_text())
    cell = content["cells"][0]
    start = cell["starts"][0]
    content["runs"] -= start["state"] in ("known", "unknown")
    nothing: dict[str, object] = {"alarms": [], "figures": [], "members": 0, "failed": 0, "chance": None}
    start.update(nothing, alarm="", failure="", state="not_known", expected=False, confidence=0.4, interval=[0.0, 1.0])
    cell["verdict"] = "not_known"
    (tmp_path / "map.json").write_text(json.dumps(content))
    read = flexdrill.read_map(tmp_path)
    assert read.verdict[0, 0] == "not_known" and read.state[0, 0, 0] == "not_known"
    assert not np.any(read.verdict[read.state[0] == "not_known"] == "clear")
    assert np.isnan(read.chance[0, 0, 0]) and read.confidence[0, 0, 0] == 0.4


def test_a_map_says_what_its_tools_are_drawn_from(mapped: Path, tmp_path: Path) -> None:
    content = json.loads((mapped / "map.json").read_text())
    keys = ["contact.outer.friction_tangential"]
    sample = {"sha256": "ab" * 32, "version": "1.2.3", "log": "rig.csv", "log_sha256": "cd" * 32, "rows": [3, 900]}
    content |= {"plausible": True, "posterior": {**sample, "members": 30, "effective": 28.5, "keys": keys}}
    (tmp_path / "map.json").write_text(json.dumps(content))
    found = flexdrill.read_map(tmp_path).posterior
    assert found == flexdrill.MapSample("ab" * 32, "1.2.3", "rig.csv", "cd" * 32, (3, 900), 30, 28.5, tuple(keys))
    content["posterior"]["effective"] = 31.0
    (tmp_path / "map.json").write_text(json.dumps(content))
    with pytest.raises(flexdrill.ResultFileError, match="posterior.effective"):
        flexdrill.read_map(tmp_path)


def flexdrill_ending(unit: str) -> str:
    return {"N": "_n", "N m": "_nm", "1/h": "_per_h"}[unit]


def test_a_map_as_a_dataset_of_xarray(mapped: Path) -> None:
    pytest.importorskip("xarray")
    read = flexdrill.read_map(mapped)
    dataset: Any = read.to_xarray()
    assert dataset["x"].attrs["units"] == "r/min" and dataset["verdict"].dims == ("y", "x")
    point = dataset["chance"].sel(start="running", x=110.0, y=9.0).item()
    np.testing.assert_equal(point, read.chance[1, 2, 2])


def test_missing_results_are_named_and_can_be_left_missing(copy: Path) -> None:
    file = sorted((copy / "points").glob("*/*.jsonl"))[3]
    name = file.parent.name + file.stem
    file.unlink()
    with pytest.raises(flexdrill.ResultFileError, match="1 of 8 points have no result.*sweep work") as caught:
        flexdrill.read_sweep(copy)
    assert caught.value.file == str(copy) and isinstance(caught.value, ValueError)
    again = pickle.loads(pickle.dumps(caught.value))
    assert again.remedy == caught.value.remedy and str(again) == str(caught.value)
    sweep = flexdrill.read_sweep(copy, partial=True)
    gone = sweep.state == "missing"
    assert np.count_nonzero(gone) == 1 and name not in sweep.point and sweep.members[gone] == 0
    assert all(np.isnan(figure[gone]).all() for figure in sweep.figures.values())
    assert np.isnan(sweep.chance(next(iter(sweep.alarms)))[gone]).all()
    # What is being written, or belongs to no point, is no result.
    (copy / "points/aa").mkdir(exist_ok=True)
    (copy / "points/aa/.part-x").write_bytes(b"half")
    assert np.count_nonzero(flexdrill.read_sweep(copy, partial=True).state == "missing") == 1


def signed(line: bytes) -> bytes:
    return line + b'\n"' + hashlib.sha256(line).hexdigest().encode() + b'"\n'


def point(change: Callable[[bytes], bytes]) -> Callable[[Path], Path]:
    """Damages the first line of a result and signs it again."""

    def damage(folder: Path) -> Path:
        file = sorted((folder / "points").glob("*/*.jsonl"))[0]
        line = file.read_bytes().partition(b"\n")[0]
        changed = change(line)
        assert changed != line
        file.write_bytes(signed(changed))
        return file

    return damage


def plan(change: Callable[[bytes], bytes]) -> Callable[[Path], Path]:
    def damage(folder: Path) -> Path:
        file = folder / "sweep.json"
        changed = change(file.read_bytes())
        assert changed != file.read_bytes()
        file.write_bytes(changed)
        return file

    return damage


def cut(folder: Path) -> Path:
    file = sorted((folder / "points").glob("*/*.jsonl"))[0]
    file.write_bytes(file.read_bytes()[:-20])
    return file


def renamed(folder: Path) -> Path:
    file = sorted((folder / "points").glob("*/*.jsonl"))[0]
    return file.rename(file.with_name("0" * 30 + ".jsonl"))


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (cut, "checksum of its first line: remove it and run flexdrill sweep work"),
        (renamed, "point = .*as the plan and the name of the file say"),
        (point(lambda line: line.replace(b'"format":3', b'"format":1')), "a result of format 1; .* reads format 3"),
        (point(lambda line: line.replace(b'"program":"flexdrill ', b'"program":"flexdrill 9')), "program = "),
        (
            point(lambda line: line.replace(b'"failed":0', b'"failed":3')),
            "outcome.failed = 3: must be a whole number of 0",
        ),
        (point(lambda line: line.replace(b'"failed":0', b'"failed":NaN')), "NaN is no number"),
        (point(lambda line: line.replace(b'"failed":0', b'"failed":' + b"9" * 5000)), "cut off or no JSON|must be"),
        (
            point(lambda line: line.replace(b'"quality":[', b'"quality":[1,')),
            "quality = '4 values': must be a list of 3",
        ),
        (point(lambda line: line.replace(b'"run_up":', b'"run_up":"x","was":')), "run_up = 'x': must be a number"),
        (point(lambda _: b"[" * 100_000), "cut off or no JSON"),
        (point(lambda _: b"\xff\xfe"), "cut off or no JSON"),
        (plan(lambda text: text.replace(b'"format":3', b'"format":7')), "a plan of format 7; .* reads format 3"),
        (plan(lambda text: text[: len(text) // 2]), "cut off or no JSON.*: plan again in a new directory"),
        (plan(lambda text: text.replace(b'"seeds":[', b'"seeds":[-')), "seeds.0 = -1"),
        (plan(lambda text: text.replace(b'"keys":', b'"key":')), "keys = None: must be .*; it is missing"),
        (plan(lambda text: text.replace(b'"rows":[[', b'"rows":[[1,')), "rows.0 = .*: must be a list of 2 values"),
        (plan(lambda _: b"[]"), "the content = "),
    ],
)
def test_what_is_damaged_or_foreign_is_refused(copy: Path, damage: Callable[[Path], Path], words: str) -> None:
    file = damage(copy)
    with pytest.raises(flexdrill.ResultFileError, match=words) as caught:
        flexdrill.read_sweep(copy)
    assert caught.value.file == str(file) and caught.value.remedy in str(caught.value)
    assert len(str(caught.value)) < 800


def text(change: Callable[[str], str]) -> Callable[[str], str]:
    return change


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (text(lambda map: map.replace('"format":2', '"format":1')), "a map of format 1; .* reads format 2"),
        (text(lambda map: map[:-40]), "cut off or no JSON.*run the same flexdrill map command again"),
        (text(lambda map: map.replace('"values":[30', '"values":[130')), "x.values = .*: must be rising"),
        (
            text(lambda map: map.replace('"verdict":"', '"verdict":"very ', 1)),
            "cells.0.verdict = .*: must be one of clear",
        ),
        (text(lambda map: map.replace('"confidence":', '"confidence":1', 1)), "cells.0.starts.0.confidence"),
        (text(lambda map: map.replace('"x":30', '"x":31', 1)), "cells.0.x = 31.*: must be 30, as the axis says"),
        (
            text(lambda map: map.replace('"cells":[', '"cells":[{},', 1)),
            "cells = '10 values': must be a list of 9 values",
        ),
    ],
)
def test_a_map_that_is_none_is_refused(mapped: Path, tmp_path: Path, change: Callable[[str], str], words: str) -> None:
    whole = (mapped / "map.json").read_text()
    file = tmp_path / "map.json"
    file.write_text(change(whole))
    assert file.read_text() != whole
    with pytest.raises(flexdrill.ResultFileError, match=words) as caught:
        flexdrill.read_map(tmp_path)
    assert caught.value.file == str(file)


def test_any_changed_byte_of_a_result_is_found(copy: Path) -> None:
    file = sorted((copy / "points").glob("*/*.jsonl"))[0]
    content = file.read_bytes()
    for at in range(0, len(content), 97):
        file.write_bytes(content[:at] + bytes([content[at] ^ 1]) + content[at + 1 :])
        with pytest.raises(flexdrill.ResultFileError):
            flexdrill.read_sweep(copy)


def test_what_is_not_there(tmp_path: Path, swept: Path) -> None:
    with pytest.raises(FileNotFoundError, match="flexdrill sweep plan"):
        flexdrill.read_sweep(tmp_path)
    with pytest.raises(FileNotFoundError, match="flexdrill map CONFIG"):
        flexdrill.read_map(swept)
    assert json.loads((swept / "sweep.json").read_text())["format"] == 3
