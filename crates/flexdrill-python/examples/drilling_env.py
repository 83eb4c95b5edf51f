"""The twin as an environment of Gymnasium: python drilling_env.py checks it and plays a short episode at random.

For studies of advice on a model. Closed-loop control of a rig is out of scope: the twin is no controller, and a policy
that was learned here knows neither the rig's limits nor its crew.

One step is a second of model time. The action is the targets of speed and weight, both scaled to -1..1 over the limits
of the configuration; the model moves towards them within its slew limits. An episode is truncated when a hazard reaches
the level CRITICAL, and ends after `seconds`.
"""

from __future__ import annotations

from typing import Any, Optional

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium import spaces
from gymnasium.utils.env_checker import check_env

import flexdrill

Observation = npt.NDArray[np.float32]
CRITICAL = flexdrill.SEVERITIES.index("critical")


class DrillingEnv(gymnasium.Env[Observation, npt.NDArray[np.float32]]):
    """Targets as actions, alarms as truncation, work at the bit less shock and ripple as reward."""

    metadata = {"render_modes": []}

    def __init__(self, config: flexdrill.Config = "coarse.yaml", seconds: int = 60, **overrides: Any) -> None:
        self.start = flexdrill.Twin(config, **overrides)
        self.twin = self.start.fork()
        self.seconds = seconds
        limits = self.start.input_limits
        self.low = np.array([limits["speed_rpm"][0], limits["weight_kn"][0]])
        self.high = np.array([limits["speed_rpm"][1], limits["weight_kn"][1]])
        self.action_space = spaces.Box(-1.0, 1.0, (2,), np.float32)
        # Speed and torque of the bit, weight, ripple, the largest force, the levels of the hazards.
        size = 5 + len(flexdrill.HAZARDS)
        self.observation_space = spaces.Box(-np.inf, np.inf, (size,), np.float32)

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None
    ) -> tuple[Observation, dict[str, Any]]:
        """The tool at rest, disturbed by numbers that follow from the seed."""
        super().reset(seed=seed)
        self.twin = self.start.fork()
        self.twin.disturb(int(self.np_random.integers(2**32)))
        return self.observe(self.twin.run(0.1, record=["bit", "contacts", "hazards"], rate_hz=10)), {}

    def step(self, action: npt.NDArray[np.float32]) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """One second towards the targets."""
        share = (np.clip(action.astype(np.float64), -1.0, 1.0) + 1.0) / 2.0
        speed_rpm, weight_kn = (self.low + share * (self.high - self.low)).tolist()
        try:
            run = self.twin.run(
                1.0, speed_rpm=speed_rpm, weight_kn=weight_kn, record=["bit", "contacts", "hazards"], rate_hz=10
            )
        except flexdrill.StepError as failure:
            # What would have come is unknown.
            return self.observation(), 0.0, False, True, {"failure": str(failure)}
        observation = self.observe(run)
        level = int(run.hazards.severity.max())
        power_kw = float(np.mean(run.bit.torque_nm * run.bit.rotary_speed_rad_per_s)) / 1e3
        reward = power_kw - float(run.bit.stick_slip_index[-1]) - (1.0 if level > 0 else 0.0)
        ended = self.twin.time_s >= self.seconds - 1e-6
        return observation, reward, ended, level >= CRITICAL, {"time_s": self.twin.time_s, "level": level}

    def observation(self) -> Observation:
        """From the present state."""
        now = self.twin.snapshot()
        force = float(now.contacts.pipe_guide_normal_peak_n.max())
        return self.scaled(now.bit, force, now.hazards.severity)

    def observe(self, run: flexdrill.Recording) -> Observation:
        """From the last sample of a run and its largest force."""
        return self.scaled(
            self.twin.snapshot().bit, run.contacts.pipe_guide_normal_peak_n.max(), run.hazards.severity[-1]
        )

    @staticmethod
    def scaled(bit: flexdrill.Bit[float, int], force_n: float, severity: flexdrill.CodeArray) -> Observation:
        """Figures of the order of one."""
        figures = [
            bit.rotary_speed_rad_per_s / 10.0,
            bit.torque_nm / 100.0,
            bit.weight_on_bit_n / 1e4,
            bit.stick_slip_index,
            force_n / 1e3,
        ]
        return np.concatenate([figures, severity]).astype(np.float32)


def main() -> None:
    check_env(DrillingEnv(seconds=5), skip_render_check=True)
    env = DrillingEnv(seconds=5)
    env.reset(seed=1)
    env.action_space.seed(1)
    total, ended, truncated = 0.0, False, False
    while not (ended or truncated):
        _, reward, ended, truncated, _ = env.step(env.action_space.sample())
        total += reward
    print(f"gymnasium's checker passed; a random episode of {env.twin.time_s:.0f} s has the reward {total:.2f}")


if __name__ == "__main__":
    main()
