"""Cells that a map calls clear, run on rigs that the twin has not seen.

hidden_cells.py MAP --out DIR [--rigs 60] [--seed 2] [--jobs 2] [--binary FILE] [--config FILE]

MAP is the map.json of `flexdrill map CONFIG --plausible`, over speed and weight. Each hidden rig is one of those of
hidden_rigs.py: another structure than the twin's, and parameters from ranges half as wide again. Its driller brings it to
a cell that the map calls clear, from rest and by the rig's own instruments: the weight indicator has a factor and a tare
within what the configuration states, the speed sensor a factor. Then, as the map's own runs, it drills for a minute. The
same with a cell of which the map says that an alarm must be expected from every start.

DIR/cell_NNN.json has what one rig did: a run that was interrupted continues where it was. DIR/cells.md has the table.
Ends with 77 when packages are missing.
"""

import json
import random
import shutil
import sys
from pathlib import Path

import hidden_rigs

# Time to reach speed and weight from rest, at the configured slew limits, and for alarms of the way to end (s).
WAY = 12
VERDICTS = ("clear", "alarm")


def axis_values(map_file):
    """Speed and weight of the cells by verdict."""
    made = json.loads(map_file.read_text())
    keys = [made[axis]["key"] for axis in ("x", "y")]
    wanted = ["inputs.rotary_speed.initial_rpm", "inputs.weight_on_bit.initial_kn"]
    if keys != wanted:
        raise SystemExit(f"{map_file}: its axes are {keys}; this needs {wanted}")
    cells = {verdict: [(c["x"], c["y"]) for c in made["cells"] if c["verdict"] == verdict] for verdict in VERDICTS}
    return cells, made["horizon"]


def one(number, options, cells, horizon):
    """Runs one hidden rig at a cell of each verdict: whether an alarm of the tool stood."""
    result = options.out / f"cell_{number:03}.json"
    if result.exists():
        return json.loads(result.read_text())
    rng = random.Random(f"{options.seed} cell {number}")
    folder = options.out / f"cell_{number:03}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    names = hidden_rigs.drawn(options, rng, folder / "hidden.yaml")
    (folder / "plan.yaml").write_text(
        'separator: ","\ncolumns:\n  time: {column: time_s, format: seconds}\n'
        "  rotary_speed: {column: rpm, unit: r/min}\n  weight_on_bit: {direct: {column: wob, unit: kN}}\n"
    )
    factor, tare, of_speed = 1 + rng.uniform(-0.05, 0.05), rng.uniform(-2.0, 2.0), 1 + rng.uniform(-0.01, 0.01)
    found = {"structures": names}
    for verdict in VERDICTS:
        if not cells[verdict]:
            continue
        speed, weight = rng.choice(cells[verdict])
        # What acts where the instruments show the cell's values.
        true_weight, true_speed = max((weight - tare) / factor, 0.0), speed / of_speed
        rows = [(second, true_speed, true_weight) for second in range(WAY + int(horizon) + 1)]
        plan = folder / f"{verdict}.csv"
        plan.write_text("time_s,rpm,wob\n" + "".join(f"{second},{rpm:.3f},{kn:.3f}\n" for second, rpm, kn in rows))
        bag = folder / verdict
        hidden_rigs.run(
            [options.binary, "replay", plan, "--mapping", folder / "plan.yaml", "--config", folder / "hidden.yaml"]
            + ["--out", bag],
            folder / f"{verdict}.log",
        )
        real = hidden_rigs.messages(bag, ("transfer", "alarms"))
        first = min(real["transfer"])
        stood = hidden_rigs.standing(real, range(first, max(real["transfer"]) + 1))
        alarms = sorted({alarm for second, of in stood.items() if second >= first + WAY for alarm in of})
        found[verdict] = {"rpm": speed, "kn": weight, "true_kn": true_weight, "alarms": alarms}
        shutil.rmtree(bag)
    result.write_text(json.dumps(found))
    return found


def table(rigs, options):
    """What came in the cells of each verdict, as Markdown."""
    out = [
        f"{len(rigs)} hidden rigs, seed {options.seed}, one cell of each kind on each.",
        "",
        "| the map says | rigs | an alarm of the tool stood | 95 % | which |",
        "| --- | --- | --- | --- | --- |",
    ]
    for verdict in VERDICTS:
        runs = [rig[verdict]["alarms"] for rig in rigs if verdict in rig]
        if not runs:
            out.append(f"| {verdict} | 0 | the map has no such cell | | |")
            continue
        with_alarm = [alarms for alarms in runs if alarms]
        low, high = hidden_rigs.wilson(len(with_alarm) / len(runs), len(runs))
        counts = {}
        for alarm in (alarm for alarms in with_alarm for alarm in alarms):
            counts[alarm] = counts.get(alarm, 0) + 1
        which = ", ".join(f"{alarm} {count}" for alarm, count in sorted(counts.items(), key=lambda of: -of[1]))
        out.append(f"| {verdict} | {len(runs)} | {len(with_alarm)} | {low:.2f} to {high:.2f} | {which} |")
    return "\n".join(out) + "\n"


def main():
    parser = hidden_rigs.arguments(__doc__, 2)
    parser.add_argument("map", type=Path)
    options = parser.parse_args()
    cells, horizon = axis_values(options.map)
    rigs, failed = hidden_rigs.every(options, lambda number: one(number, options, cells, horizon))
    text = table([rig for rig in rigs if rig], options) + failed
    (options.out / "cells.md").write_text(text)
    print(text)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
