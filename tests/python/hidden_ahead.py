"""Advice and forecasts on rigs that the twin has not seen.

hidden_ahead.py --out DIR [--rigs 60] [--seconds 240] [--members 12] [--forecast-members 4] [--seed 3] [--jobs 2]
                [--binary FILE] [--config FILE] [--twin FILE]

The rigs are those of hidden_rigs.py: another structure than the twin's, other parameters, sensors that err. The twin runs
on the log of such a rig with its plausible tools and looks ahead (`flexdrill replay LOG --look-ahead`). It knows nothing
else of the rig.

Advice: where an alarm of the tool stands in the twin and on the rig, the rig's driller follows the first advice that comes,
by the rig's own instruments and five seconds after it, and drills on for a minute. The alarms that stood must be gone for
the last 15 s, and no other may stand then. The same rig without the advice, its speed and weight kept for as long, says
what would have ended without it.

Forecasts: the bands of the next minute, by lead, against what the rig does while its plan stays. Those that begin within a
minute after a change of the plan are counted once more by themselves.

DIR/rig_NNN.json has what came of one rig: a run that was interrupted continues where it was. DIR/ahead.md has the tables.
Ends with 77 when packages are missing.
"""

import json
import math
import re
import shutil
import sys
from collections import defaultdict
from pathlib import Path

import hidden_rigs
from hidden_rigs import SECOND, mean, standard_error, wilson
from rosbags.highlevel import AnyReader
from ruamel.yaml import YAML

# From an answer to its first effect (s): a driller reads it and turns the knob.
READS = 5
# Time that alarms have to end after that, the end of which must be free of them (s).
ENDS, FREE = 60, 15
# Advices of one rig that are followed.
MOST = 3
LEADS = ((0, 10), (10, 30), (30, 60))
AFTER_CHANGE = 60
# Figure of a forecast: topic and field of what came, and how a second's value is made of its messages.
FIGURES = {
    "bit_speed": ("bit_state", "rotary_speed", mean),
    "bit_torque": ("bit_state", "torque", mean),
    "weight_on_bit": ("bit_state", "weight_on_bit", mean),
    "pipe_guide_force": ("contact_forces", "max_pipe_guide_force", max),
    "guide_wall_force": ("contact_forces", "max_guide_wall_force", max),
}
ADVICE = re.compile(
    r"at (?P<at>[\d.]+) s: advice on (?P<alarm>.+?) after .*?: (?:nothing from|(?P<verb>Lower|Raise) the (?P<knob>speed|weight) to "
    r"(?P<to>[\d.]+) .*? in (?P<ended>\d+) of (?P<of>\d+) )"
)


def by_second(bag):
    """What a rig did in each second, by figure."""
    wanted = defaultdict(list)
    for figure, (topic, field, made) in FIGURES.items():
        wanted[topic].append((figure, field, made))
    values = {figure: defaultdict(list) for figure in FIGURES}
    with AnyReader([bag]) as reader:
        of = {c.id: c.topic.rsplit("/", 1)[-1] for c in reader.connections if "/twin/" in f"/{c.topic}"}
        for connection, _, data in reader.messages(connections=[c for c in reader.connections if of.get(c.id) in wanted]):
            message = reader.deserialize(data, connection.msgtype)
            stamp = message.header.stamp
            # A message at the end of a second is of that second: its interval lies before its stamp.
            second = (stamp.sec * SECOND + stamp.nanosec - 1) // SECOND
            for figure, field, _ in wanted[of[connection.id]]:
                values[figure][second].append(getattr(message, field))
    return {figure: {second: FIGURES[figure][2](of) for second, of in seconds.items()} for figure, seconds in values.items()}


def forecasts_held(bag, rig, came, offset, first):
    """For each forecast of the twin: whether its bands held what the rig did, by figure and second, while the plan stayed."""
    held = []
    with AnyReader([bag]) as reader:
        connections = [c for c in reader.connections if c.topic.endswith("twin/forecast")]
        for connection, _, data in reader.messages(connections=connections):
            forecast = reader.deserialize(data, connection.msgtype)
            if not forecast.bands:
                continue
            made = forecast.header.stamp.sec - offset - first
            begins = forecast.bands_from.sec - offset
            plan = rig.rows[min(max(made, 0), len(rig.rows) - 1)]
            changed = next((made - back for back in range(made + 1) if rig.rows[made - back] != plan), -1)
            for band in forecast.bands:
                if band.name not in FIGURES:
                    continue
                for lead, (low, high) in enumerate(zip(band.p5, band.p95)):
                    second = begins + lead - first
                    if second >= len(rig.rows) or rig.rows[second] != plan:
                        break
                    real = came[band.name].get(first + second)
                    if real is not None and math.isfinite(low):
                        held.append([band.name, lead, made - changed <= AFTER_CHANGE, bool(low <= real <= high)])
    return held


def followed(rig, advice, truth, first, number):
    """What came of an advice on the rig, and what came without it; None where no alarm stood there."""
    at = math.ceil(advice["at"])
    stood = hidden_rigs.standing(truth, range(first, first + at + 1))[first + at]
    if not stood:
        return None
    speed, weight = rig.rows[at]
    kept = rig.rows[: at + 1] + [(speed, weight)] * (READS + ENDS)
    if advice["knob"] == "speed":
        speed = (advice["to"] - rig.speed.tare) / rig.speed.factor
    else:
        weight = max((advice["to"] - rig.weight.tare) / rig.weight.factor, 0.0)
    told = rig.rows[: at + 1] + [rig.rows[at]] * READS + [(speed, weight)] * ENDS
    outcome = {"stood": sorted(stood), **advice}
    for name, rows in (("followed", told), ("kept", kept)):
        bag = rig.drills(rows, f"{name}_{number}")
        alarms = hidden_rigs.standing(hidden_rigs.messages(bag, ("alarms",)), range(first, first + len(rows) + 1))
        outcome[name] = sorted({alarm for of in sorted(alarms)[-FREE:] for alarm in alarms[of]})
        shutil.rmtree(bag)
    return outcome


def one(number, options):
    """Runs a hidden rig, the twin on its log, and the rig again as the twin advises."""
    result = options.out / f"rig_{number:03}.json"
    if result.exists():
        return json.loads(result.read_text())
    rig = hidden_rigs.Hidden(number, options)
    bag = rig.drills(rig.rows, "truth")
    truth = hidden_rigs.messages(bag, hidden_rigs.TOPICS)
    rig.log(truth)
    yaml = YAML(typ="safe")
    config = yaml.load((options.twin or options.config).read_text())
    ahead = {"advice": True, "forecast": options.forecast_members > 0, "threads": 1}
    if options.forecast_members > 0:
        ahead["forecast_members"] = options.forecast_members
    config["look_ahead"] = ahead
    with (rig.folder / "looks.yaml").open("w") as to:
        yaml.dump(config, to)
    of_twin = rig.twin(rig.folder / "looks.yaml", options.members, "--look-ahead")
    first = min(truth["transfer"])
    offset = min(hidden_rigs.messages(of_twin, ("transfer",))["transfer"]) - first
    forecasts = forecasts_held(of_twin, rig, by_second(bag), offset, first)
    advices, absent, none = [], 0, 0
    for found in ADVICE.finditer((rig.folder / "twin.log").read_text()):
        if found["to"] is None:
            none += 1
            continue
        if len(advices) == MOST:
            break
        advice = {"at": float(found["at"]), "alarm": found["alarm"], "knob": found["knob"], "to": float(found["to"])}
        advice |= {"ended": int(found["ended"]), "of": int(found["of"])}
        outcome = followed(rig, advice, truth, first, len(advices))
        if outcome is None:
            absent += 1
        else:
            advices.append(outcome)
    figures = {"structures": rig.structures, "advices": advices, "absent": absent, "none": none, "forecasts": forecasts}
    result.write_text(json.dumps(figures))
    shutil.rmtree(bag)
    shutil.rmtree(of_twin)
    return figures


def tables(rigs, options):
    """What came of advice and forecasts, as Markdown."""
    advices = [advice for rig in rigs for advice in rig["advices"]]
    out = [
        f"{len(rigs)} hidden rigs of {options.seconds} s, seed {options.seed}, {options.members} plausible tools each.",
        "",
        f"Advice on {len(advices)} alarms that stood on the rig too; {sum(rig['absent'] for rig in rigs)} more stood in the twin "
        f"alone, and on {sum(rig['none'] for rig in rigs)} nothing was found.",
        "",
        "| | ended all that stood, and no other stands | 95 % | said by the twin |",
        "| --- | --- | --- | --- |",
    ]
    said = f"{mean(advice['ended'] / advice['of'] for advice in advices):.2f}"
    for name, words, share in (("followed", "advice followed", said), ("kept", "speed and weight kept", "")):
        ended = sum(not advice[name] for advice in advices)
        low, high = wilson(ended / len(advices), len(advices)) if advices else (math.nan, math.nan)
        out.append(f"| {words} | {ended} of {len(advices)} | {low:.2f} to {high:.2f} | {share} |")
    out += ["", "| figure | lead (s) | held, mean of rigs | standard error | within a minute after a change of the plan |"]
    out.append("| --- | --- | --- | --- | --- |")
    for figure in FIGURES:
        for begin, end in LEADS:
            shares = [[], []]
            for rig in rigs:
                rows = [row for row in rig["forecasts"] if row[0] == figure and begin <= row[1] < end]
                for only_after in (False, True):
                    held = [row[3] for row in rows if row[2] or not only_after]
                    if held:
                        shares[only_after].append(mean(held))
            of_all, after = shares
            out.append(
                f"| {figure} | {begin} to {end} | {mean(of_all):.2f} | {standard_error(of_all):.2f} | {mean(after):.2f} |"
            )
    return "\n".join(out) + "\n"


def main():
    parser = hidden_rigs.arguments(__doc__, 3)
    parser.add_argument("--seconds", type=int, default=240)
    parser.add_argument("--members", type=int, default=12)
    parser.add_argument("--forecast-members", type=int, default=4)
    parser.add_argument("--twin", type=Path)
    options = parser.parse_args()
    rigs, failed = hidden_rigs.every(options, lambda number: one(number, options))
    text = tables([rig for rig in rigs if rig], options) + failed
    (options.out / "ahead.md").write_text(text)
    print(text)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
