"""Reads a recording with rosbags and plots orbits and forces (pip install rosbags==0.11.9 matplotlib==3.10.8 numpy).

    flexdrill replay config/field_logs/demo.csv --out run        # or: flexdrill run --record run
    python3 docs/examples/plot_recording.py run --out run.png

The types come from the recording itself: no ROS installation and no message package is needed. A bag that `ros2 bag
record` has made is read in the same way.
"""

import argparse
from pathlib import Path

try:
    import matplotlib

    matplotlib.use("Agg")  # into a file; leave it out to plot on a screen
    import matplotlib.pyplot as plt
    import numpy as np
    from rosbags.highlevel import AnyReader
except ImportError as missing:
    raise SystemExit(f"{missing.name} is missing: pip install rosbags==0.11.9 matplotlib==3.10.8 numpy") from None


def read(bag, names):
    """Messages by topic name without namespace, for the topics `names`."""
    found = {name: [] for name in names}
    with AnyReader([Path(bag)]) as reader:
        name_of = {c.topic: name for c in reader.connections for name in names if c.topic.endswith("/" + name)}
        wanted = [c for c in reader.connections if c.topic in name_of]
        for connection, _, data in reader.messages(connections=wanted):
            found[name_of[connection.topic]].append(reader.deserialize(data, connection.msgtype))
    return found


def seconds(messages):
    """Times of the messages from the first on (s)."""
    stamps = np.array([m.header.stamp.sec * 10**9 + m.header.stamp.nanosec for m in messages])
    return (stamps - stamps[0]) * 1e-9


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bag", help="folder, as flexdrill and ros2 bag make them")
    parser.add_argument("--out", default="recording.png", help="picture: .png, .svg or .pdf")
    parser.add_argument("--orbits", type=int, default=3, help="how many joints")
    given = parser.parse_args()

    found = read(given.bag, ["twin/contact_forces", "twin/joint_deflections", "twin/bit_state"])
    contacts, joints, bit = found.values()
    if not contacts or not joints:
        raise SystemExit(f"{given.bag}: no twin/contact_forces or no twin/joint_deflections in it")

    # Instant by station. Collisions are shorter than the publishing interval: the peaks are those within it.
    depth = contacts[0].measured_depth
    inner = np.array([m.pipe_guide_normal_peak for m in contacts])
    outer = np.array([m.guide_wall_normal_peak for m in contacts])
    for name, force in (("pipe on guide", inner), ("guide on wall", outer)):
        instant, station = np.unravel_index(force.argmax(), force.shape)
        print(f"largest force, {name}: {force.max():.6f} N at {depth[station]:.2f} m, {seconds(contacts)[instant]:.2f} s")

    # The joints next to the largest force, and four seconds around it.
    joint_depth = joints[0].measured_depth
    lateral = np.array([[m.lateral_y, m.lateral_z] for m in joints])  # instant, axis, joint
    station_of = np.abs(depth[:, None] - joint_depth).argmin(axis=0)
    worst = inner[:, station_of].max(axis=0).argsort()[::-1][: given.orbits]

    figure, axes = plt.subplots(2, max(given.orbits, 2), figsize=(4 * max(given.orbits, 2), 8), layout="constrained")
    for axis, joint in zip(axes[0], worst):
        middle = seconds(contacts)[inner[:, station_of[joint]].argmax()]
        near = np.abs(seconds(joints) - middle) <= 2
        axis.plot(1e3 * lateral[near, 0, joint], 1e3 * lateral[near, 1, joint], linewidth=0.8)
        axis.set(title=f"joint {joint + 1:02}, {joint_depth[joint]:.2f} m, {middle:.0f} s",
                 xlabel="horizontal (mm)", ylabel="to the low side (mm)", aspect="equal")
        axis.invert_yaxis()
    for axis in axes[0][len(worst):]:
        axis.axis("off")

    along, over_time = axes[1][0], axes[1][1]
    along.plot(depth, inner.max(axis=0) / 1e3, label="pipe on guide")
    along.plot(depth, outer.max(axis=0) / 1e3, label="guide on wall")
    along.set(title="largest forces", xlabel="measured depth (m)", ylabel="kN")
    along.legend()
    over_time.plot(seconds(joints), [m.torque[0] for m in joints], label="uppermost joint")
    if bit:
        over_time.plot(seconds(bit), [m.torque for m in bit], label="bit")
    over_time.set(title="torque", xlabel="time (s)", ylabel="N m")
    over_time.legend()
    for axis in axes[1][2:]:
        axis.axis("off")
    figure.savefig(given.out, dpi=120)
    print(f"wrote {given.out}")


if __name__ == "__main__":
    main()
