# %% [markdown]
# # A figure of the paper
# Lin et al. (Scientific Reports 2024) draw the contact forces of a station over eight turns: once a turn the pipe
# presses on the guide with tens of kN. The paper gives neither the tool's dimensions nor its weight on bit;
# `paper.yaml` is the set that agrees best. The manual says which findings agree and which do not.

# %%
import matplotlib.pyplot as plt
import numpy as np

import flexdrill

twin = flexdrill.Twin("paper.yaml")
inputs = twin.configuration["inputs"]
speed_rpm = inputs["rotary_speed"]["initial_rpm"]
weight_kn = inputs["weight_on_bit"]["initial_kn"]
speed_rpm, weight_kn = speed_rpm or 40.0, weight_kn or 7.5
turn_s = 60.0 / speed_rpm
twin.run(4 * turn_s, speed_rpm=speed_rpm, weight_kn=weight_kn, record=["bit"])
run = twin.run(8 * turn_s, record=["contacts", "energy"], rate_hz=200)
print(f"{speed_rpm:.0f} r/min, {weight_kn:.1f} kN, {len(run)} samples")

# %%
contacts = run.contacts
station = int(contacts.pipe_guide_normal_n.max(axis=0).argmax())
inclination_deg = np.degrees(contacts.inclination_rad[station])
turns = (run.time_s - run.time_s[0]) / turn_s
figure, axis = plt.subplots(figsize=(10, 4.5), layout="constrained")
axis.plot(turns, contacts.pipe_guide_normal_n[:, station] / 1e3, label="pipe on guide")
axis.plot(turns, contacts.guide_wall_normal_n[:, station] / 1e3, label="guide on wall")
axis.set(title=f"station at {inclination_deg:.0f} degrees", xlabel="turns of the tool", ylabel="normal force (kN)")
axis.legend()
plt.show()

# %% [markdown]
# A run is only as good as its energy balance: what the audit cannot account for, over the work of the drive.

# %%
error = run.energy.error_j[-1] - run.energy.error_j[0]
drive = run.energy.drive_j[-1] - run.energy.drive_j[0]
print(f"energy error {100 * abs(error / drive):.3f} % of the drive's work")
