# %% [markdown]
# # What if: forks of one state
# The tool drills at 60 r/min with much friction between pipe and guide. Which change calms it: less speed, or more
# weight? Each candidate runs in three forks that differ by 1e-5 m/s of lateral velocity, so that chance is seen.

# %%
import matplotlib.pyplot as plt
import numpy as np

import flexdrill

twin = flexdrill.Twin("coarse.yaml", contact__inner__friction_tangential=0.5, contact__inner__friction_axial=0.5)
before = twin.run(8, speed_rpm=60, weight_kn=10, record=["bit", "contacts"], rate_hz=50)

# %%
candidates: dict[str, flexdrill.Inputs] = {
    "as it is": {},
    "40 r/min": {"speed_rpm": 40.0},
    "25 kN": {"weight_kn": 25.0},
}
members = 3
forks: list[flexdrill.Twin] = []
inputs: list[flexdrill.Inputs] = []
for candidate in candidates.values():
    for member in range(members):
        fork = twin.fork()
        fork.disturb(member)
        forks.append(fork)
        inputs.append(candidate)
runs = flexdrill.rollout(forks, inputs, 8, record=["bit", "contacts", "hazards"], rate_hz=50)

# %%
figure, axes = plt.subplots(1, len(candidates), figsize=(12, 4), sharey=True, layout="constrained")
for column, (name, axis) in enumerate(zip(candidates, axes)):
    axis.plot(before.time_s, before.contacts.pipe_guide_normal_peak_n.max(axis=1) / 1e3, color="0.6", linewidth=0.6)
    peaks: list[float] = []
    for run in runs[column * members : (column + 1) * members]:
        largest = run.contacts.pipe_guide_normal_peak_n.max(axis=1) / 1e3
        axis.plot(run.time_s, largest, linewidth=0.6)
        peaks.append(float(np.median(largest[len(largest) // 2 :])))
    axis.set(title=f"{name}: median {np.median(peaks):.2f} kN", xlabel="time (s)")
axes[0].set(ylabel="largest force of pipe on guide (kN)")
plt.show()
