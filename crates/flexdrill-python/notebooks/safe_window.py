# %% [markdown]
# # A safe window, in small
# A grid of speed and weight with much friction between pipe and guide; each point is a fork of the same state at rest.
# Colour: the worst level of any hazard in the second half. This grid is small and each point runs once: it shows the
# method, and decides nothing at a rig.

# %%
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap

import flexdrill

speeds_rpm = [30.0, 75.0, 120.0]
weights_kn = [5.0, 20.0, 40.0]
start = flexdrill.Twin("coarse.yaml", contact__inner__friction_tangential=0.7, contact__inner__friction_axial=0.7)
points = [(speed, weight) for weight in weights_kn for speed in speeds_rpm]
inputs: list[flexdrill.Inputs] = [{"speed_rpm": speed, "weight_kn": weight} for speed, weight in points]
runs = flexdrill.rollout([start.fork() for _ in points], inputs, 12, record=["hazards"])

# %%
worst = np.array([run.hazards.severity[len(run) // 2 :].max() for run in runs])
unknown = [run.failure is not None for run in runs]
for (speed, weight), level, run in zip(points, worst, runs):
    last = run.hazards.severity[len(run) // 2 :].max(axis=0)
    names = ", ".join(name for name, severity in zip(flexdrill.HAZARDS, last) if severity > 0)
    print(f"{speed:4.0f} r/min {weight:4.0f} kN: {flexdrill.SEVERITIES[level]} {names}")

# %%
colours = ListedColormap(["#2c7bb6", "#abd9e9", "#fdae61", "#d7191c"])
figure, axis = plt.subplots(figsize=(7, 4.5), layout="constrained")
grid = np.ma.masked_array(worst, unknown).reshape(len(weights_kn), len(speeds_rpm))
drawn = axis.pcolormesh(speeds_rpm, weights_kn, grid, cmap=colours, norm=BoundaryNorm(np.arange(-0.5, 4.0), 4))
axis.set(title="worst level of any hazard", xlabel="rotary speed (r/min)", ylabel="weight on bit (kN)")
axis.set_xticks(speeds_rpm)
axis.set_yticks(weights_kn)
bar = figure.colorbar(drawn, ticks=range(4))
bar.ax.set_yticklabels(flexdrill.SEVERITIES)
plt.show()
