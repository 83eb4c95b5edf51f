# %% [markdown]
# # The hole ahead
# Where the rig's tool drills in the next five metres under three weights, with the range of plausible tools.

# %%
import matplotlib.pyplot as plt
import numpy as np

import flexdrill

twin = flexdrill.Twin("rig.yaml")
ahead = {weight_kn: twin.ahead(5, weight_kn=weight_kn) for weight_kn in (6, 10, 20)}
for weight_kn, hole in ahead.items():
    rates = [hole.build_rate_low_rad_per_m, hole.build_rate_rad_per_m, hole.build_rate_high_rad_per_m]
    low, rate, high = np.degrees(rates)
    print(f"{weight_kn:2d} kN: {hole.radius_m:.2f} m, {rate:.2f} deg/m (90 %: {low:.2f} to {high:.2f}) {hole.because}")

# %% [markdown]
# Inclination over depth: lines are the tool as configured, pale areas 90 % of the plausible tools.

# %%
figure, inclination = plt.subplots(figsize=(7.5, 4.5), layout="constrained")
for weight_kn, hole in ahead.items():
    depth_m = hole.measured_depth_m
    inclination.plot(depth_m, np.degrees(hole.inclination_rad), label=f"{weight_kn} kN")
    low, high = np.degrees(hole.inclination_low_rad), np.degrees(hole.inclination_high_rad)
    inclination.fill_between(depth_m, low, high, alpha=0.2)
inclination.set(title="the next five metres", xlabel="measured depth (m)", ylabel="inclination (deg)")
inclination.legend()
plt.show()
