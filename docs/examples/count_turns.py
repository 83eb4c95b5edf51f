"""Counts the turns of the pipe in the guide from raw positions, without the whirl analysis.

    pip install mcap==1.6.0 mcap-ros2-support==0.6.0 numpy ruamel.yaml
    python3 docs/examples/count_turns.py read RECORDING.mcap...
    python3 docs/examples/count_turns.py run config/default.yaml --set tool.joint.limit_deg=8 --runs 3

`run` makes the recordings with `flexdrill replay` at constant inputs. Each has 1 N more for a tenth of a second than
the one before, so that their differences show the scatter. To count turns, a recording needs twin/tool_shape at 20 Hz
or more, which `run` sets. For other recordings, such as those of the default configuration (10 Hz), `read` prints the
other figures. All figures are of the last three quarters, as in `flexdrill bench`.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

try:
    import numpy as np
    from mcap.reader import make_reader
    from mcap_ros2.decoder import DecoderFactory
    from ruamel.yaml import YAML
except ImportError as missing:
    raise SystemExit(f"{missing.name} is missing: pip install mcap==1.6.0 mcap-ros2-support==0.6.0 numpy ruamel.yaml") from None

read_yaml = YAML(typ="safe", pure=True).load
RPM = 2 * np.pi / 60
SHAPE_RATE = 50  # Hz, 75 positions per turn at 40 r/min
# s between positions, of 20 Hz: at 120 r/min an orbit of four turns per turn moves by 2.5 rad from one to the next.
LONGEST_INTERVAL = 0.051
TOPICS = {"shape": "twin/tool_shape", "contact": "twin/contact_forces", "joint": "twin/joint_deflections",
          "bit": "twin/bit_state", "session": "twin/session"}


def read(bag):
    """The configuration, and by the names of TOPICS times (s) and messages of the last three quarters."""
    found = {name: [] for name in TOPICS}
    with Path(bag).open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        for _, channel, record, message in reader.iter_decoded_messages():
            for name, topic in TOPICS.items():
                if channel.topic.endswith(topic):
                    found[name].append((1e-9 * record.log_time, message))
    for name, messages in found.items():
        if len(messages) < (1 if name == "session" else 2):
            raise SystemExit(f"{bag}: {len(messages)} messages of {TOPICS[name]}, which is needed; is it a recording by "
                             "flexdrill run or replay, with all outputs.rates above 0?")
    start, end = found["bit"][0][0], found["bit"][-1][0]
    late = {name: [pair for pair in pairs if pair[0] >= start + (end - start) / 4] for name, pairs in found.items()}
    times = {name: np.array([time for time, _ in pairs]) for name, pairs in late.items()}
    messages = {name: [message for _, message in pairs] for name, pairs in late.items()}
    return found["session"][0][1].configuration, times, messages


def lateral(exaggeration, messages):
    """Pipe and guide of every station, displaced from the bore's axis: arrays of instant, station, (y, z) in m."""
    inclination = np.array(messages["contact"][0].inclination)
    low_side = np.stack([-np.cos(inclination), np.zeros_like(inclination), np.sin(inclination)], axis=1)
    lines = {"bore": [], "flexible_pipe": [], "guide_pipe": []}
    for array in messages["shape"]:
        for marker in array.markers:
            if marker.ns in lines:
                lines[marker.ns].append([(p.x, p.y, p.z) for p in marker.points])
    lines = {name: np.array(points) for name, points in lines.items()}
    out = []
    for name in ("flexible_pipe", "guide_pipe"):
        moved = (lines[name] - lines["bore"]) / exaggeration
        out.append(np.stack([moved[..., 1], np.einsum("tsk,sk->ts", moved, low_side)], axis=-1))
    return out


def turns(path):
    """Net turns about the origin, positive from y to z, the drive's sense; `path` is instant, station, (y, z)."""
    before, after = path[:-1], path[1:]
    cross = before[..., 0] * after[..., 1] - before[..., 1] * after[..., 0]
    return np.arctan2(cross, (before * after).sum(-1)).sum(0) / (2 * np.pi)


def measure(bag):
    """The counts of one recording."""
    configuration, times, messages = read(bag)
    configuration = read_yaml(configuration)
    tool = configuration["tool"]
    interval = float(np.median(np.diff(times["shape"])))
    counted = interval < LONGEST_INTERVAL
    pipe, guide = lateral(configuration["outputs"]["exaggeration"], messages)
    joints = np.arange(1, tool["links"]) * tool["elements_per_link"]
    path = (pipe - guide)[:, joints]
    bit = np.array([m.rotary_speed for m in messages["bit"]])
    tool_turns = bit.mean() / (2 * np.pi) * np.ptp(times["shape"])
    if tool_turns < 1:
        tool_turns = np.nan  # it stands: a ratio has no meaning
    depth = np.array(messages["contact"][0].measured_depth)
    link = depth[-1] / tool["links"]
    ends = pipe[:, np.r_[0, joints, -1]]
    # A link of length L whose ends are displaced by d across its chord is L - d^2 / (2 L) long along the chord.
    shortening = (np.diff(ends, axis=1) ** 2).sum((1, 2)) / (2 * link)
    tilt = np.diff(ends, axis=1) / link
    tilt_rate = np.linalg.norm(np.diff(tilt, axis=0), axis=-1) / np.diff(times["shape"])[:, None]
    axial = np.array([m.axial_force for m in messages["joint"]])
    return {
        "inclination_deg": np.degrees(np.array(messages["contact"][0].inclination)[joints]),
        "interval": interval,
        "about_centre": turns(path) / tool_turns if counted else None,
        "about_mean": turns(path - path.mean(0)) / tool_turns if counted else None,
        "ripple_rms_rpm": bit.std() / RPM,
        "ripple_half_range_rpm": np.ptp(bit) / 2 / RPM,
        "joints_at_limit": np.mean([m.joints_at_limit for m in messages["joint"]]),
        "axial_force": axial.mean(0),
        "pushed": (axial[:, -1] < 0).mean(),
        "tilt_rate": (np.sqrt((tilt_rate ** 2).mean()), tilt_rate.max()) if counted else None,
        "wall_force": np.mean([m.guide_wall_normal for m in messages["contact"]], axis=0),
        "peak_force": np.max([max(m.pipe_guide_normal_peak) for m in messages["contact"]]),
        "shortening_mm": 1e3 * np.array([shortening.mean(), shortening.min(), shortening.max()]),
    }


def show(name, found):
    joints = len(found["inclination_deg"])
    middle = slice(joints // 3, joints - joints // 3)
    centre, mean = found["about_centre"], found["about_mean"]
    print(f"{name}: bit speed ripple {found['ripple_rms_rpm']:.2f} r/min rms, {found['ripple_half_range_rpm']:.2f} "
          f"half of the range; {found['joints_at_limit']:.1f} of {joints} joints at the limit")
    print(f"  shortening of the tilted links: {found['shortening_mm'][0]:.2f} mm, "
          f"{found['shortening_mm'][1]:.2f} to {found['shortening_mm'][2]:.2f}")
    first, last = found["axial_force"][[0, -1]]
    print(f"  mean axial force {first:.0f} N in the first joint, {last:.0f} N in the last, which is pushed in "
          f"{100 * found['pushed']:.0f} % of the time; largest pipe-guide force {found['peak_force']:.0f} N")
    if found["tilt_rate"]:
        print(f"  tilt of links changes by {found['tilt_rate'][0]:.2f} rad/s rms, {found['tilt_rate'][1]:.1f} at most")
    upper, lower = (half.sum() for half in np.array_split(found["wall_force"], 2))
    print(f"  mean guide-wall force, summed up: {upper:.0f} N in the upper half, {lower:.0f} N in the lower")
    if centre is None:
        print(f"  turns are not counted: {TOPICS['shape']} comes every {found['interval']:.2f} s, at most "
              f"{LONGEST_INTERVAL} s are needed; record with outputs.rates.tool_shape: {SHAPE_RATE}")
        return
    for what, ratio in (("the gap's centre", centre), ("the orbit's mean", mean)):
        low, median, high = np.percentile(ratio[middle], [10, 50, 90])
        print(f"  turns per turn of the tool about {what}, middle third: median {median:.2f}, "
              f"80 % within {low:.2f} to {high:.2f}; all joints: {' '.join(f'{r:.2f}' for r in ratio)}")


def configured(flexdrill, path, changes):
    """The whole configuration with the changes, each KEY=VALUE with the key's dotted path."""
    full = subprocess.run([flexdrill, "check", "--full", path], check=True, capture_output=True, text=True).stdout
    config = read_yaml(full)
    for change in [*changes, f"outputs.rates.tool_shape={SHAPE_RATE}", "outputs.exaggeration=1"]:
        keys, value = change.split("=", 1)
        *parents, key = keys.split(".")
        place = config
        for parent in parents:
            place = place[parent]
        place[key] = read_yaml(value)
    return config


def run(given):
    """Makes the recordings and shows each."""
    config = configured(given.flexdrill, given.config, given.set)
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        # JSON is YAML, and keeps numbers as numbers.
        (folder / "config.yaml").write_text(json.dumps(config))
        (folder / "columns.yaml").write_text(json.dumps({
            "title": "constant inputs", "separator": ",",
            "columns": {"time": {"column": "time_s", "format": "seconds"},
                        "rotary_speed": {"column": "rpm", "unit": "r/min"},
                        "weight_on_bit": {"direct": {"column": "wob", "unit": "kN"}}}}))
        for number in range(given.runs):
            rows = [f"{0.1 * i:.1f},{given.rpm},{given.wob + (1e-3 * number if i == 20 else 0)}\n"
                    for i in range(int(10 * given.duration) + 20)]
            (folder / "log.csv").write_text("time_s,rpm,wob\n" + "".join(rows))
            out = folder / f"run_{number}"
            ended = subprocess.run([given.flexdrill, "replay", folder / "log.csv", "--mapping", folder / "columns.yaml",
                                    "--config", folder / "config.yaml", "--duration", str(given.duration),
                                    "--out", out], capture_output=True, text=True)
            if ended.returncode != 0:
                raise SystemExit(ended.stderr)
            [recording] = out.glob("*.mcap")
            show(f"{given.config} {' '.join(given.set)} run {number}", measure(recording))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    actions = parser.add_subparsers(dest="action", required=True)
    reading = actions.add_parser("read")
    reading.add_argument("recordings", nargs="+", metavar="RECORDING.mcap")
    running = actions.add_parser("run")
    running.add_argument("config")
    running.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    running.add_argument("--runs", type=int, default=3)
    running.add_argument("--rpm", type=float, default=40.0)
    running.add_argument("--wob", type=float, default=10.0, help="kN")
    running.add_argument("--duration", type=float, default=20.0, help="s")
    running.add_argument("--flexdrill", default="target/release/flexdrill")
    given = parser.parse_args()
    if given.action == "run":
        run(given)
    else:
        for recording in given.recordings:
            show(recording, measure(recording))


if __name__ == "__main__":
    main()
