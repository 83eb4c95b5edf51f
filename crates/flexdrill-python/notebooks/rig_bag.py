# %% [markdown]
# # Reading a rig's bag
# Any recording of the node or of `ros2 bag record` will do. Here the program replays the demonstration's field log into
# one: rotation off bottom, and from 50 s on drilling. `FLEXDRILL_BINARY` names the program, `FLEXDRILL_ROOT` the
# repository.

# %%
import os
import subprocess
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import flexdrill

program = os.environ.get("FLEXDRILL_BINARY", "flexdrill")
log = Path(os.environ.get("FLEXDRILL_ROOT", ".")) / "config/field_logs/demo.csv"
folder = Path(tempfile.mkdtemp())
subprocess.run([program, "replay", log, "--duration", "75", "--out", folder / "rig"], check=True, capture_output=True)
bag = flexdrill.read_bag(folder / "rig", ["twin/bit_state", "twin/contact_forces", "twin/applied_inputs"])
print(bag)

# %%
bit, contacts, applied = bag["twin/bit_state"], bag["twin/contact_forces"], bag["twin/applied_inputs"]
figure, (speeds, torques, forces) = plt.subplots(3, 1, figsize=(10, 8), sharex=True, layout="constrained")
rpm = 30.0 / np.pi
speeds.step(applied.time_s, applied.rotary_speed * rpm, where="post", label="asked for")
speeds.plot(bit.time_s, bit.rotary_speed * rpm, linewidth=0.7, label="bit")
speeds.set(ylabel="r/min")
speeds.legend()
torques.plot(bit.time_s, bit.torque, linewidth=0.7)
torques.set(ylabel="bit torque (N m)")
drawn = forces.pcolormesh(
    contacts.time_s, contacts.measured_depth[0], contacts.pipe_guide_normal_peak.T, shading="nearest", rasterized=True
)
forces.set(ylabel="measured depth (m)", xlabel="time (s)")
figure.colorbar(drawn, ax=forces, label="pipe on guide (N)")
plt.show()

# %% [markdown]
# The recording's inputs drive a twin of another tool: what would this run have been with joints that bend less?

# %%
other = flexdrill.Twin(tool__joint__limit_deg=4)
begin_s = 45.0
speed_rpm = flexdrill.held(applied.time_s - begin_s, applied.rotary_speed * rpm)
weight_kn = flexdrill.held(applied.time_s - begin_s, applied.weight_on_bit / 1e3)
run = other.run(25, speed_rpm=speed_rpm, weight_kn=weight_kn, record=["joints"])
print(f"largest stop moment {run.joints.stop_moment_nm.max():.0f} N m")
