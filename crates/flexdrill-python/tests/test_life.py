"""Tables of `flexdrill life` in Python: the figures that the program prints, and what is refused."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import flexdrill

DETAIL = (
    '{"line":{"log_cycles":11.699,"slope":3.0,"knee":0.0,"slope_below_knee":3.0,"scatter":0.2},'
    '"section_modulus":2.3e-5,"stress_concentration":1.5,"stress_concentration_scatter":0.2}'
)
HEAD = f"""# flexdrill life: 1
# tool.pipe: x
# tool.joint.kind: x
# class: DNVGL-RP-C203 F1
# environment: free_corrosion
# stop: {DETAIL}
# link: {DETAIL}
# design factor: 3
serial_number,start_ns,end_ns,configuration,place_from_bit,hours,stop_damage,link_damage
"""
ROWS = """J-1,1700000000000000000,1700003600000000000,a,1,1,0.01,0.2
J-1,1700010000000000000,1700013600000000000,b,2,1,0.02,0.21
J-2,1700010000000000000,1700013600000000000,b,1,1,0.001,1.2e-5
"""


def written(folder: Path, text: str) -> Path:
    file = folder / "joints.csv"
    file.write_text(text)
    return file


def test_damages_add_up_with_the_band_of_the_class(tmp_path: Path) -> None:
    life = flexdrill.read_life(written(tmp_path, HEAD + ROWS))
    assert (life.runs, [joint.serial_number for joint in life.joints]) == (2, ["J-1", "J-2"])
    worst = life.joints[0]
    # 3.4 for a scatter of 0.2, a stress concentration known to 0.2, and a slope of 3: docs/joint_life.md.
    factor = math.exp(1.645 * math.sqrt((0.2 * math.log(10)) ** 2 + 9 * math.log(1.04)))
    assert factor == pytest.approx(3.4, abs=0.05)
    assert worst.part == "link" and worst.damage is worst.link
    assert worst.link.median == pytest.approx(0.41, rel=1e-12)
    assert worst.link.high == pytest.approx(0.41 * factor, rel=1e-3)
    assert worst.link.low == pytest.approx(0.41 / factor, rel=1e-3)
    assert (worst.verdict, worst.places, worst.runs, worst.hours) == ("possible", (1, 2), 2, 2.0)
    assert worst.hours_left == 0.0
    sound = life.joint("J-2")
    assert sound.verdict == "sound" and sound.part == "stop"
    assert sound.hours_left == pytest.approx(1.0 / (0.001 * factor) - 1.0, rel=1e-2)
    with pytest.raises(KeyError):
        life.joint("J-3")


def test_a_table_of_a_spreadsheet_is_the_same(tmp_path: Path) -> None:
    head = [line.replace('"', '""') for line in HEAD.splitlines()]
    quoted = [f'"{line}",,,,,,,' if '""' in line else f"{line},,,,,,," for line in head[:-1]]
    text = "\ufeff" + "\r\n".join([*quoted, head[-1], *ROWS.splitlines(), ""])
    plain = flexdrill.read_life(written(tmp_path, HEAD + ROWS))
    file = tmp_path / "sheet.csv"
    file.write_text(text, encoding="utf-8", newline="")
    assert flexdrill.read_life(file).joints == plain.joints


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (ROWS, "must be the names"),
        (HEAD.replace("life: 1", "life: 2") + ROWS, "must be 1"),
        (HEAD.replace("# design factor: 3\n", "") + ROWS, "design factor"),
        (HEAD.replace('"scatter":0.2}', '"scatter":-1}') + ROWS, "stop.line.scatter"),
        (HEAD.replace('{"line"', '{line"') + ROWS, "# stop"),
        (HEAD + ROWS.replace("0.21", "nan"), "line 11: link_damage = nan"),
        (HEAD + "J-1,1,2,a\n", "has 4 fields"),
    ],
)
def test_what_is_no_table_is_refused(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(flexdrill.ResultFileError, match=".") as refused:
        flexdrill.read_life(written(tmp_path, text))
    assert said in str(refused.value) and "flexdrill life add" in str(refused.value)


def test_a_missing_table_says_how_to_make_it(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="flexdrill life add"):
        flexdrill.read_life(tmp_path / "none.csv")
