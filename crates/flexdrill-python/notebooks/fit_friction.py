# %% [markdown]
# # Fitting friction
# A drive torque was measured while the tool turned off bottom and on bottom. Which friction between pipe and guide, and
# which friction factor of the bit, explain it? Off bottom
# the torque is that of the friction alone, on bottom nearly all of it is the bit's. Here a twin with known
# coefficients makes the measurement, with noise, so that the answer can be checked.

# %%
from typing import cast

import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import least_squares

import flexdrill

TRUE = (0.30, 0.27)
LEVELS_KN = [0.0, 12.0]
# Standard deviation of a mean (N m): a gauge off bottom; on bottom the motion of the pipe scatters in addition.
SCATTER_NM = np.array([0.1, 1.0])
start = flexdrill.Twin("coarse.yaml")
start.step(5000, speed_rpm=40)  # 2.5 s: up to speed


def drive_torques(pipe_guide: float, bit: float) -> flexdrill.FloatArray:
    """Mean drive torque (N m) at each weight, over two seconds after one and a half of settling."""
    twins = [start.fork() for _ in LEVELS_KN]
    for twin in twins:
        twin.set_friction(pipe_guide_around=pipe_guide, pipe_guide_along=pipe_guide, bit=bit)
    inputs: list[flexdrill.Inputs] = [{"weight_kn": weight} for weight in LEVELS_KN]
    runs = flexdrill.rollout(twins, inputs, 3.5, record=["applied"], rate_hz=200)
    return np.array([run.applied.drive_torque_nm[-400:].mean() for run in runs])


noise = np.random.default_rng(1).normal(0.0, SCATTER_NM)
measured = drive_torques(*TRUE) + noise

# %%
GUESS = (0.2, 0.2)


def misfit(friction: flexdrill.FloatArray) -> flexdrill.FloatArray:
    """Differences over their standard deviations."""
    difference = drive_torques(float(friction[0]), float(friction[1])) - measured
    scaled: flexdrill.FloatArray = difference / SCATTER_NM
    return scaled


fit = least_squares(
    misfit,
    GUESS,
    bounds=([0.0, 0.0], [1.0, 1.0]),
    diff_step=[0.2, 0.2],  # so that the scatter does not hide the slope
    max_nfev=5,
)
jacobian = cast(flexdrill.FloatArray, fit.jac)
covariance = np.linalg.inv(jacobian.T @ jacobian)
for name, value, error, true in zip(("pipe on guide", "bit"), fit.x, np.sqrt(np.diag(covariance)), TRUE):
    print(f"{name}: {value:.3f} +- {2 * error:.3f}, true {true:.3f}")

# %%
figure, axis = plt.subplots(figsize=(7, 4.5), layout="constrained")
axis.plot(LEVELS_KN, measured, "o", label="measured")
axis.plot(LEVELS_KN, drive_torques(*GUESS), "--", label="first guess")
axis.plot(LEVELS_KN, drive_torques(*fit.x), label="fitted")
axis.set(xlabel="weight on bit (kN)", ylabel="drive torque (N m)")
axis.legend()
plt.show()
