# %% [markdown]
# # First run, and an orbit
# The paper's tool: 33 links in a quarter circle of 3.2 m, 40 r/min, 10 kN. The run starts from rest; the drive needs
# two seconds to its speed.

# %%
import matplotlib.pyplot as plt
import numpy as np

import flexdrill

twin = flexdrill.Twin()
run = twin.run(12, speed_rpm=40, weight_kn=10)
print(run)
print(f"bit torque {run.bit.torque_nm[-200:].mean():.1f} N m, {twin.mass_kg:.0f} kg of steel")

# %% [markdown]
# The pipe's motion across the bore at the joint that moves most, over the last six seconds. The low side is down.

# %%
late = run.time_s >= 6.0
lateral_y_mm = 1e3 * run.joints.lateral_y_m[late]
lateral_z_mm = 1e3 * run.joints.lateral_z_m[late]
spread = np.hypot(lateral_y_mm.std(axis=0), lateral_z_mm.std(axis=0))
joint = int(spread.argmax())
depth_m = run.joints.measured_depth_m[joint]

# A figure per cell: a notebook shows it, and closes it, where its cell ends.
figure, orbit = plt.subplots(figsize=(5.5, 4.5), layout="constrained")
orbit.plot(lateral_y_mm[:, joint], lateral_z_mm[:, joint], linewidth=0.8)
orbit.set(title=f"joint {joint + 1} at {depth_m:.2f} m", xlabel="horizontal (mm)", ylabel="to the low side (mm)")
orbit.set_aspect("equal")
orbit.invert_yaxis()
plt.show()

# %% [markdown]
# Largest forces along the tool. Peaks are those within each sampling interval, so that no collision is missed.

# %%
contacts = run.contacts
figure, forces = plt.subplots(figsize=(7.5, 4.5), layout="constrained")
forces.plot(contacts.measured_depth_m, contacts.pipe_guide_normal_peak_n[late].max(axis=0), label="pipe on guide")
forces.plot(contacts.measured_depth_m, contacts.guide_wall_normal_peak_n[late].max(axis=0), label="guide on wall")
forces.set(title="largest forces", xlabel="measured depth (m)", ylabel="N")
forces.legend()
plt.show()
