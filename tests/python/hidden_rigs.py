"""Plausible tools on rigs that the twin has not seen.

hidden_rigs.py --out DIR [--rigs 60] [--seconds 600] [--members 16] [--seed 1] [--jobs 2] [--binary FILE] [--config FILE]
               [--twin FILE]

A hidden rig is a run of the program with another structure than the twin's, drawn from the list STRUCTURES, and with
parameters from ranges half as wide again as the twin's own. Its plan of speed and weight changes every half minute to
two. Sensors with factor, tare, noise, drift, delay, quantising and dropouts make a log of it. The twin replays this log
with its plausible tools (`flexdrill replay LOG --members N`), and its bands are compared with what the hidden rig did.
The twin gets the log and the configuration that is under test, and nothing else. With --twin it has another one than the
rigs are drawn from: one with a coarser mesh takes less time, and errs by that too.

DIR/rig_NNN.json has the figures of one rig: a run that was interrupted continues where it was, and one that begins with
those of tests/data/hidden_rigs adds to them. DIR/scores.md has the tables of all rigs in DIR; with --rigs 0 none is
added. DIR/factors.yaml has the factors on the bands (`ensemble.band_factors`) with which a band holds 90 % of what
another rig of the same population does. Each rig judges factors by all others, which have not seen it. Factors that the
configuration already has are taken out first. Ends with 77 when packages are missing.
"""

import argparse
import json
import math
import random
import shutil
import subprocess
import sys
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from statistics import median

import conformal

try:
    from rosbags.highlevel import AnyReader
    from ruamel.yaml import YAML
except ImportError as missing:
    print(f"missing: {missing.name}")
    sys.exit(77)

# Figures that are judged: name in twin/bands, with topic and field of the truth.
JUDGED = {
    "bit torque": "transfer/bit_torque",
    "weight at the bit": "transfer/bit_weight",
    "force of pipe on guide": "contact_forces/max_pipe_guide_force",
    "force of guide on wall": "contact_forces/max_guide_wall_force",
    "swing of the bit's speed": "bit_state/stick_slip_index",
}
TOPICS = ("transfer", "contact_forces", "bit_state", "bands", "alarms")
# A band belongs to one second. The motion is chaotic within it, so that each second is judged by itself.
SECOND = 10**9
# Seconds at the beginning that are not judged: the tool comes to its speed, and members are at rest before.
SETTLING = 30
# An alarm of the twin about its inputs, its comparison or the program is not one of the tool.
DRILLING, LOW = 0, 1
WITHIN = 60
TENTHS = 10
# Most draws of a hidden rig.
DRAWS = 50
# Share of what a hidden rig does that a band is to hold.
HOLDS = 0.9


def at(config, key, value):
    """Sets a dotted key."""
    *parents, last = key.split(".")
    for parent in parents:
        config = config.setdefault(parent, {})
    config[last] = value


def get(config, key):
    for part in key.split("."):
        config = config[part]
    return config


WITHOUT_CUTTING = "a bit whose torque falls with its speed, without cutting"
# Another structure than the twin assumes, by name: what it does to a configuration.
STRUCTURES = {
    "friction in the pipe acts around and along by itself": lambda c: at(c, "contact.inner.friction", "separate"),
    "joints of constant velocity": lambda c: (at(c, "tool.joint.kind", "ball_cage"), get(c, "tool.joint").pop("friction", 0)),
    "joints with play of 0.5 deg": lambda c: at(c, "tool.joint.play_deg", 0.5),
    # The weight is that at the kick-off, as friction takes its part on the way to the bit of every rig. Without a surface
    # to lift the bit from, its plan stays on bottom.
    WITHOUT_CUTTING: lambda c: (
        at(c, "rock.law", "weakening"),
        at(c, "boundary.weight_on_bit_at", "kickoff"),
    ),
    "a string of two sections": lambda c: at(
        c,
        "string.sections",
        [
            {"length": 700.0, "outer_diameter": 0.0889, "inner_diameter": 0.0702},
            {"length": 500.0, "outer_diameter": 0.0730, "inner_diameter": 0.0546},
        ],
    ),
    "a stiff drive": lambda c: at(c, "string.top_drive.tuning", "stiff"),
    "a hole 2 mm larger": lambda c: at(c, "well.hole_diameter", get(c, "well.hole_diameter") + 0.002),
    "a guide that lies on the wall without sticking": lambda c: at(c, "contact.outer.friction", "vector"),
    "pins without friction that falls, and a coarse mesh": lambda c: at(c, "tool.elements_per_link", 4),
    "half of the step": lambda c: at(c, "solver.time_step", 0.00025),
}


# Keys that are not drawn for the rigs: how their torque falls is the configuration's, or one of `STRUCTURES`. The tables of
# before these keys had distributions are therefore of the same rigs.
KEPT = ("rock.weakening.ratio", "rock.weakening.rate_rpm", "rock.depth_of_cut.cutting_weakening")


def widened(distribution, rng):
    """A value from a distribution of the configuration, half as wide again."""
    [(law, ends)] = distribution.items()
    low, high = ends["low"], ends["high"]
    if law == "log_normal":
        low, high, back = math.log(low), math.log(high), math.exp
    else:
        back = float
    middle, half = (low + high) / 2, 1.5 * (high - low) / 2
    if law in ("normal", "log_normal"):
        # Half of the width is 1.645 standard deviations where 90 % lie within. Nothing beyond twice that exists.
        return back(middle + max(-2.0, min(2.0, rng.gauss(0, 1 / 1.645))) * half)
    return back(rng.uniform(low, middle + half))


def hidden_rig(config, rng):
    """A configuration of another structure with other parameters, with the names of its structures."""
    for entry in config.pop("uncertainty")["keys"]:
        if entry["key"] in KEPT:
            continue
        value = widened(entry["distribution"], rng)
        for key in [entry["key"], *entry.get("also", [])]:
            try:
                present = get(config, key)
            except KeyError:
                present = {"contact.inner.friction_axial": 0.2, "contact.outer.friction_axial": 0.3}.get(key)
            form = entry.get("form", "value")
            if form != "value" and present is None:
                continue
            at(config, key, {"value": value, "factor": (present or 0) * value, "offset": (present or 0) + value}[form])
    config.pop("ensemble", None)
    names = rng.sample(sorted(STRUCTURES), 3)
    for name in names:
        STRUCTURES[name](config)
    return names


def drawn(options, rng, file):
    """Writes the configuration of a hidden rig, and returns the names of its structures.

    A draw from a range that is wider than the twin's may lie beyond the bounds of a key: then all is drawn again.
    """
    yaml = YAML(typ="safe")
    for _ in range(DRAWS):
        config = yaml.load(options.config.read_text())
        names = hidden_rig(config, rng)
        with file.open("w") as to:
            yaml.dump(config, to)
        checked = subprocess.run([options.binary, "check", file], capture_output=True, text=True, check=False)
        if checked.returncode == 0:
            return names
    raise RuntimeError(f"{file}: none of {DRAWS} draws is a tool: {checked.stderr[-500:]}")


def plan(seconds, rng, lifts):
    """Speed (r/min) and weight (kN) by the second: changes every 30 to 120 s, and once off bottom if the rig can do that."""
    rows, next_change, lifted = [], 0, rng.randrange(seconds // 2, max(seconds - 60, seconds // 2 + 1))
    speed = weight = 0.0
    for second in range(seconds):
        if second >= next_change:
            speed, weight = rng.choice([30.0, 40.0, 50.0, 60.0, 70.0]), rng.choice([6.0, 8.0, 10.0, 14.0, 18.0])
            next_change = second + rng.randrange(30, 120)
        on_bottom = second >= 10 and not (lifts and lifted <= second < lifted + 25)
        rows.append((speed, weight if on_bottom else 0.0))
    return rows


class Sensor:
    """What a sensor shows of a true value: factor, tare, noise, drift, quantum; a delay in whole seconds; dropouts."""

    def __init__(self, rng, factor, tare, noise, drift, quantum, delay):
        self.rng, self.noise, self.quantum, self.delay = rng, noise, quantum, delay
        self.factor, self.tare = 1 + rng.uniform(-factor, factor), rng.uniform(-tare, tare)
        self.drift, self.drifted = drift, 0.0

    def shows(self, value):
        # A walk whose standard deviation after an hour is `drift`.
        self.drifted += self.rng.gauss(0, self.drift / 60)
        if self.rng.random() < 0.01:
            return None
        shown = self.factor * value + self.tare + self.drifted + self.rng.gauss(0, self.noise)
        return round(shown / self.quantum) * self.quantum


def run(command, log):
    with log.open("w") as to:
        done = subprocess.run([str(part) for part in command], stdout=to, stderr=subprocess.STDOUT, check=False)
    if done.returncode:
        raise RuntimeError(f"{command[1]} ended with {done.returncode}: {log.read_text()[-500:]}")


def messages(bag, wanted):
    """Messages of the twin by short name and second of their stamp; of each second the last one."""
    found = defaultdict(dict)
    with AnyReader([bag]) as reader:
        of = {c.id: c.topic.rsplit("/", 1)[-1] for c in reader.connections if "/twin/" in f"/{c.topic}"}
        ours = [c for c in reader.connections if of.get(c.id) in wanted]
        for connection, stamp, data in reader.messages(connections=ours):
            message = reader.deserialize(data, connection.msgtype)
            header = message.header.stamp
            found[of[connection.id]][(header.sec * SECOND + header.nanosec) // SECOND] = message
    return found


def standing(found, seconds):
    """Ids of the alarms of the tool that stand, by the second."""
    by_second, present = {}, frozenset()
    for second in seconds:
        if second in found["alarms"]:
            present = frozenset(
                alarm.id for alarm in found["alarms"][second].alarms if alarm.active and alarm.category == DRILLING
            )
        by_second[second] = present
    return by_second


class Hidden:
    """A hidden rig with its plan, and the folder of its files."""

    COLUMNS = (
        'separator: ","\ncolumns:\n  time: {column: time_s, format: seconds}\n'
        "  rotary_speed: {column: rpm, unit: r/min}\n  weight_on_bit: {direct: {column: wob, unit: kN}}\n"
    )

    def __init__(self, number, options):
        self.rng = random.Random(f"{options.seed} {number}")
        self.binary, self.folder = options.binary, options.out / f"rig_{number:03}"
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)
        self.structures = drawn(options, self.rng, self.folder / "hidden.yaml")
        (self.folder / "plan.yaml").write_text(self.COLUMNS)
        self.rows = plan(options.seconds, self.rng, WITHOUT_CUTTING not in self.structures)

    def drills(self, rows, name):
        """Runs the rig at speeds and weights that act, second by second, into the bag of this name."""
        table = self.folder / f"{name}.csv"
        table.write_text("time_s,rpm,wob\n" + "".join(f"{second},{speed},{weight}\n" for second, (speed, weight) in enumerate(rows)))
        bag = self.folder / name
        run(
            [self.binary, "replay", table, "--mapping", self.folder / "plan.yaml", "--config", self.folder / "hidden.yaml"]
            + ["--out", bag],
            self.folder / f"{name}.log",
        )
        return bag

    def log(self, truth):
        """What the rig's sensors show of its plan and of what it did, as a log with its mapping."""
        rng = self.rng
        self.speed = Sensor(rng, 0.01, 0.0, 0.2, 0.0, 0.1, 0)
        self.weight = Sensor(rng, 0.05, 2.0, 0.4, 0.2, 0.1, 0)
        torque = Sensor(rng, 0.05, 50.0, 15.0, 5.0, 1.0, rng.randrange(0, 3))
        first = min(truth["transfer"])
        lines = ["time_s,rpm,wob,torque"]
        for second, (rpm, kn) in enumerate(self.rows):
            at_surface = truth["transfer"].get(first + second - torque.delay)
            shown = torque.shows(at_surface.surface_torque) if at_surface else None
            # A driller zeroes the weight off bottom, and never puts on less than nothing.
            shown_weight = self.weight.shows(kn) if kn > 0 else 0.0
            values = [self.speed.shows(rpm), None if shown_weight is None else max(shown_weight, 0.0), shown]
            lines.append(",".join([str(second), *("" if value is None else f"{value:.3f}" for value in values)]))
        (self.folder / "rig.csv").write_text("\n".join(lines) + "\n")
        (self.folder / "rig.yaml").write_text(self.COLUMNS + "  torque: {column: torque, unit: N.m}\n")

    def twin(self, config, members, *others):
        """Runs the twin of this configuration on the log, into a bag."""
        run(
            [self.binary, "replay", self.folder / "rig.csv", "--mapping", self.folder / "rig.yaml", "--config", config]
            + ["--members", members, "--out", self.folder / "twin", *others],
            self.folder / "twin.log",
        )
        return self.folder / "twin"


def study(options):
    """What rigs of one table have in common."""
    return {"seconds": options.seconds, "seed": options.seed, "members": options.members}


def kept(folder):
    """The rigs of a folder, and what they have in common; ends where they are of several studies."""
    rigs = [json.loads(figures.read_text()) for figures in sorted(folder.glob("rig_*.json"))]
    first = rigs[0]["study"] if rigs else None
    for rig in rigs:
        if rig["study"] != first:
            sys.exit(f"{folder} has rigs of several studies: {first} and {rig['study']}")
    return rigs, first


def one(number, options):
    """Runs a hidden rig and the twin on its log; figures by second."""
    result = options.out / f"rig_{number:03}.json"
    if result.exists():
        return json.loads(result.read_text())
    rig = Hidden(number, options)
    bag = rig.drills(rig.rows, "truth")
    truth = messages(bag, TOPICS)
    rig.log(truth)
    of_twin = rig.twin(options.twin or options.config, options.members)
    twin = messages(of_twin, TOPICS)
    figures = {"study": study(options), **compared(truth, twin, min(truth["transfer"]), rig.structures)}
    result.write_text(json.dumps(figures))
    # Bags of a rig take a hundred megabytes; what is judged is in the figures.
    shutil.rmtree(bag)
    shutil.rmtree(of_twin)
    return figures


def field(message, path):
    return getattr(message, path.split("/")[1])


def needed(real, low, middle, high):
    """The factor on a band with which it holds the truth; None if there is none."""
    half = high - middle if real > middle else middle - low
    off = abs(real - middle)
    return 0.0 if off == 0 else round(off / half, 3) if half > 0 else None


def compared(truth, twin, first, names):
    """What is judged of one rig.

    For each figure by the second the factor on the members' band with which it holds the truth, the width of the band in
    parts of its middle in the first and the last third, and by which share the twin's own figure was off; the alarms that
    came, with their chances.
    """
    begins = min(twin["bands"], default=0)
    offset = min(twin["transfer"]) - first
    seconds = [second for second in sorted(twin["bands"]) if second - offset in truth["transfer"] and second > begins + SETTLING]
    factors, widths, off = defaultdict(list), defaultdict(list), defaultdict(list)
    for second in seconds:
        message = twin["bands"][second]
        of = {band.name: (band, factor) for band, factor in zip(message.bands, message.band_factors, strict=True)}
        for name, path in JUDGED.items():
            topic = path.split("/")[0]
            (band, factor), real, own = of.get(path, (None, 1.0)), truth[topic].get(second - offset), twin[topic].get(second)
            if band is None or real is None or own is None or not math.isfinite(band.p5):
                continue
            # As of the members themselves, so that factors are of one kind whatever the configuration has. An end that was cut
            # at 0 comes nearer to the middle than theirs, which asks for the configuration's factor at most.
            low, high = (band.p50 + (end - band.p50) / factor for end in (band.p5, band.p95))
            real, own = field(real, path), field(own, path)
            factors[name].append(needed(real, low, band.p50, high))
            if band.p50:
                widths[name].append((high - low) / abs(band.p50))
            if real:
                off[name].append(abs(own - real) / abs(real))
    bands = {
        name: {
            "needed": rows,
            "width": [round(mean(part), 3) for part in ends_of(widths[name])] if widths[name] else None,
            "twin_off": round(mean(off[name]), 3) if off[name] else None,
        }
        for name, rows in factors.items()
    }
    # The next minute: whether an alarm of the tool stands within it in the hidden rig.
    real = standing(truth, range(first, first + len(truth["transfer"]) + 1))
    own = standing(twin, range(first + offset, first + offset + len(twin["transfer"]) + 1))
    last = max(real)
    alarms = []
    for second in seconds[::10]:
        now = second - offset
        chance = twin["bands"][second].any_alarm
        if now + WITHIN <= last and math.isfinite(chance):
            came = sorted({name for later in range(now, now + WITHIN) for name in real[later]})
            alarms.append({"chance": round(chance, 3), "twin": bool(own.get(second)), "came": came})
    stands = [
        any(alarm.id == "rig_disagrees" and alarm.active for alarm in twin["alarms"][second].alarms)
        for second in sorted(twin["alarms"])
    ]
    begins = sum(now and not before for before, now in zip([False, *stands], stands))
    return {"structures": names, "bands": bands, "alarms": alarms, "disagrees": begins, "seconds": len(seconds)}


def ends_of(values):
    """The first and the last third."""
    third = max(len(values) // 3, 1)
    return values[:third], values[-third:]


def wilson(share, count):
    """95 % interval of a share of `count`."""
    if count == 0:
        return math.nan, math.nan
    z = 1.96
    middle = (share + z * z / (2 * count)) / (1 + z * z / count)
    half = z / (1 + z * z / count) * math.sqrt(share * (1 - share) / count + z * z / (4 * count * count))
    return middle - half, middle + half


def mean(values):
    values = list(values)
    return sum(values) / len(values) if values else math.nan


def factors_needed(rig, name):
    """The factors with which the band of a figure holds a rig's truth, by the second."""
    return [math.inf if factor is None else factor for factor in rig["bands"].get(name, {}).get("needed", [])]


def held(rigs, name, factor):
    """Shares of the seconds in which the band holds, by rig."""
    return [mean(by <= factor for by in rows) for rows in (factors_needed(rig, name) for rig in rigs) if rows]


def standard_error(values):
    return math.sqrt(mean((value - mean(values)) ** 2 for value in values) / max(len(values) - 1, 1)) if values else math.nan


def factor(rigs, name):
    """The factor on the bands of a figure with which they hold another rig, by these; None of too few."""
    found = conformal.quantile([factors_needed(rig, name) for rig in rigs], HOLDS)
    # Bands that hold more than asked for are not made narrower than the members say.
    return None if found is None else max(1.0, math.ceil(100 * found) / 100)


def factors(rigs, of):
    """Factors by all rigs, and the table of what those by all others are worth on each."""
    rows = []
    out = [
        f"Factors on the bands, by {len(rigs)} rigs: mean share of a rig's seconds in which the band holds, with its standard",
        "error over rigs. Each rig judges the factor by all others.",
        "",
        "| figure | factor | holds without it | with that by the others |",
        "| --- | --- | --- | --- |",
    ]
    for name, path in JUDGED.items():
        found = factor(rigs, name)
        others = [(rig, factor(rigs[:index] + rigs[index + 1 :], name)) for index, rig in enumerate(rigs)]
        shares = [held(rigs, name, 1.0), [share for rig, by in others if by for share in held([rig], name, by)]]
        words = [f"{mean(of):.2f} +- {standard_error(of):.2f}" if of else "" for of in shares]
        out.append(f"| {name} | {f'{found:.2f}' if found else 'too few rigs'} | {words[0]} | {words[1]} |")
        if found and found > 1.0:
            rows.append(
                f'- {{figure: {path}, factor: {found}, source: "{len(rigs)} hidden rigs of {of["seconds"]} s, seed '
                f'{of["seed"]}, {of["members"]} members; tests/python/hidden_rigs.py"}}'
            )
    return "\n".join(["", *out, ""]), "\n".join(["# ensemble.band_factors; figures that are left out have the factor 1", *rows, ""])


def tables(rigs, of):
    """Scores as Markdown. A rig counts as one: its seconds are not independent."""
    out = [
        f"{len(rigs)} hidden rigs of {of['seconds']} s, seed {of['seed']}, {of['members']} plausible tools each.",
        "",
        "| figure | truth within the 90 % band, mean of rigs | standard error | first third | last third | width, last over "
        "first third (median) | twin's own figure off by (mean share) |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    for name in JUDGED:
        bands_of = [rig["bands"][name] for rig in rigs if name in rig["bands"]]
        inside = [[by <= 1 for by in factors_needed(rig, name)] for rig in rigs if name in rig["bands"]]
        all_of = [mean(rows) for rows in inside]
        early, late = ([mean(ends_of(rows)[end]) for rows in inside] for end in (0, 1))
        # A rig whose plan begins off bottom has no width to speak of in the first third.
        ratio = [bands["width"][1] / bands["width"][0] for bands in bands_of if bands["width"] and bands["width"][0]]
        error = [bands["twin_off"] for bands in bands_of if bands["twin_off"] is not None]
        out.append(
            f"| {name} | {mean(all_of):.2f} | {standard_error(all_of):.2f} | {mean(early):.2f} | {mean(late):.2f} | "
            f"{median(ratio or [math.nan]):.2f} | {mean(error):.2f} |"
        )
    alarms = [(row["chance"], row["twin"], bool(row["came"])) for rig in rigs for row in rig["alarms"]]
    climate = mean(came for _, _, came in alarms)
    brier = [
        ("plausible tools", mean((chance - came) ** 2 for chance, _, came in alarms)),
        ("the twin alone", mean((own - came) ** 2 for _, own, came in alarms)),
        ("climate", mean((climate - came) ** 2 for _, _, came in alarms)),
    ]
    out += ["", f"An alarm of the tool within the next minute, {len(alarms)} instants, it came in {climate:.2f} of them:", ""]
    out += ["| forecast | Brier score |", "| --- | --- |", *(f"| {name} | {score:.3f} |" for name, score in brier), ""]
    out += ["| chance said | instants | came | 95 % |", "| --- | --- | --- | --- |"]
    for tenth in range(TENTHS):
        rows = [came for chance, _, came in alarms if tenth <= min(chance * TENTHS, TENTHS - 0.5) < tenth + 1]
        if rows:
            low, high = wilson(mean(rows), len(rows))
            said = f"{tenth / TENTHS:.1f} to {(tenth + 1) / TENTHS:.1f}"
            out.append(f"| {said} | {len(rows)} | {mean(rows):.2f} | {low:.2f} to {high:.2f} |")
    disagreeing = sum(rig["disagrees"] > 0 for rig in rigs)
    begins, hours = sum(rig["disagrees"] for rig in rigs), len(rigs) * of["seconds"] / 3600
    out += [
        "",
        f"`rig_disagrees` came {begins} times in {hours:.1f} h, on {disagreeing} of {len(rigs)} rigs.",
    ]
    return "\n".join(out) + "\n"


def arguments(description, seed):
    """What every study of hidden rigs is told; rigs of another study have another seed."""
    parser = argparse.ArgumentParser(description=description.split("\n\n")[0])
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--rigs", type=int, default=60)
    parser.add_argument("--seed", type=int, default=seed)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--binary", type=Path, default=root / "target/release/flexdrill")
    parser.add_argument("--config", type=Path, default=root / "config/rig.yaml")
    return parser


def every(options, one):
    """What `one` finds on each rig, by number; None and a message where a rig could not be computed. With a sentence on those."""
    options.out.mkdir(parents=True, exist_ok=True)

    def safe(number):
        try:
            return one(number)
        except RuntimeError as error:
            print(f"rig {number}: {error}", file=sys.stderr)
            return None

    with ThreadPoolExecutor(options.jobs) as pool:
        rigs = list(pool.map(safe, range(options.rigs)))
    failed = sum(rig is None for rig in rigs)
    words = f"\n{failed} rigs could not be computed: their messages are above, and they are in no table.\n" if failed else ""
    return rigs, words


def main():
    parser = arguments(__doc__, 1)
    parser.add_argument("--seconds", type=int, default=600)
    parser.add_argument("--members", type=int, default=16)
    parser.add_argument("--twin", type=Path)
    options = parser.parse_args()
    _, of = kept(options.out)
    if options.rigs and of not in (None, study(options)):
        sys.exit(f"{options.out} has rigs of another study: {of}, not {study(options)}")
    _, failed = every(options, lambda number: one(number, options))
    rigs, of = kept(options.out)
    if not rigs:
        sys.exit(f"{options.out} has no rigs{failed}")
    of_factors, in_configuration = factors(rigs, of)
    text = tables(rigs, of) + of_factors
    (options.out / "factors.yaml").write_text(in_configuration)
    text += failed
    (options.out / "scores.md").write_text(text)
    print(text)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
