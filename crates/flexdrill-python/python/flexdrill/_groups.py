"""The groups of a recording. Names carry their units; angles are in rad.

A group of a `Recording` has a value per sample: numbers are arrays over time, values along the tool arrays of time and
place. A group of a `Snapshot` has those of one instant. Quantities that do not change have no axis of time in either.
Frames: world X horizontal in the direction of build, Y horizontal, Z down; across the bore y horizontal, z towards the
low side.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np
import numpy.typing as npt

from ._figures import BitFigures, F, TransferFigures

FloatArray = npt.NDArray[np.float64]
CodeArray = npt.NDArray[np.uint8]
CountArray = npt.NDArray[np.uint64]

N = TypeVar("N")
"""A count or a code of one instant, or an array of them over time."""


@dataclass(frozen=True)
class Applied(Generic[F]):
    """Inputs as they act on the model, after the slew limits."""

    rotary_speed_rad_per_s: F
    """Speed of the top drive."""
    drive_angle_rad: F
    """Angle of the top drive."""
    drive_torque_nm: F
    """Torque of the drive on the pipe, positive in the sense of the rotation."""
    weight_on_bit_n: F
    """Weight at the bit."""
    weight_set_n: F
    """Weight that is asked for, at the bit or at the kick-off."""
    weight_at_kickoff_n: F
    """Axial force on the guide at the kick-off; NaN where the guide is not held there."""
    rate_of_penetration_m_per_s: F
    standpipe_pressure_pa: F
    """Pressure inside minus outside."""


@dataclass(frozen=True)
class Joints:
    """Per joint, top to bottom. Forces are those of the link above on the link below, in the upper link's frame."""

    measured_depth_m: FloatArray
    """Along the path from the kick-off; constant."""
    inclination_rad: FloatArray
    """Inclination of the bore; constant."""
    bend_angle_rad: FloatArray
    """Angle between the axes of the two links, not negative."""
    bend_direction_rad: FloatArray
    """Direction in which the lower link turns away, from the high side, clockwise looking down the hole."""
    limit_angle_rad: FloatArray
    """Bend angle at which the stop begins."""
    stop_moment_nm: FloatArray
    """Moment of the limit stop, not negative."""
    lateral_y_m: FloatArray
    """Horizontal displacement of the pipe from the bore's axis."""
    lateral_z_m: FloatArray
    """Displacement of the pipe towards the low side from the bore's axis."""
    spin_rate_rad_per_s: FloatArray
    """Spin rate of the link below the joint."""
    axial_force_n: FloatArray
    """Tension positive."""
    shear_force_n: FloatArray
    """Magnitude of the shear force."""
    torque_nm: FloatArray
    """Torque through the joint, positive in the drive's sense."""


@dataclass(frozen=True)
class Contacts:
    """Per station, top to bottom. Peaks and means are over the time since the sample before."""

    measured_depth_m: FloatArray
    """Along the path from the kick-off; constant."""
    inclination_rad: FloatArray
    """Inclination of the bore; constant."""
    state: CodeArray
    """0 free, 1 pipe on guide, 2 guide on wall, 3 both."""
    pipe_guide_gap_m: FloatArray
    """Gap between pipe and guide; negative is penetration."""
    pipe_guide_normal_n: FloatArray
    """Normal force, not negative."""
    pipe_guide_tangential_n: FloatArray
    """Friction round the circumference on the pipe, in the spin's sense."""
    pipe_guide_axial_n: FloatArray
    """Friction along the axis on the pipe, downhole positive."""
    pipe_guide_normal_peak_n: FloatArray
    """Largest normal force."""
    pipe_guide_normal_rms_n: FloatArray
    """Root mean square of the normal force."""
    pipe_guide_shock_ns: FloatArray
    """Largest impulse of a short interval above the resting force."""
    guide_wall_gap_m: FloatArray
    """Gap between guide and wall; negative is penetration."""
    guide_wall_normal_n: FloatArray
    guide_wall_tangential_n: FloatArray
    """Friction round the circumference on the guide."""
    guide_wall_axial_n: FloatArray
    guide_wall_normal_peak_n: FloatArray
    guide_wall_normal_rms_n: FloatArray
    guide_wall_shock_ns: FloatArray


@dataclass(frozen=True)
class Bit(BitFigures[F], Generic[F, N]):
    """The bit. Means and accelerations (root mean squares) cover the time since the sample before, with every step; torque,
    speed and weight without `mean` are those of the sample's instant, and a mean of them aliases with the rotation."""

    torque_nm: F
    """Torque of the rock against the bit; negative in reverse, 0 off bottom."""
    rotary_speed_rad_per_s: F
    """Negative in reverse."""
    weight_on_bit_n: F
    """0 off bottom."""
    stick_slip_severity: N
    """Index into `SEVERITIES`."""


@dataclass(frozen=True)
class Reactions:
    """Forces on the tool from outside, in the world frame. The sums balance but for `unbalance_n`."""

    measured_depth_m: FloatArray
    """Per support, and last the string above where a hoist carries it; constant."""
    inclination_rad: FloatArray
    """As `measured_depth_m`."""
    body: CodeArray
    """As `measured_depth_m`: index into `HOLDERS`; constant."""
    force_n: FloatArray
    """Force on the pipe that is held; that of the string on the guide. Their sum is `supports_n`."""
    moment_nm: FloatArray
    """Moment, without the torque of the drive or the string on the top of the pipe."""
    supports_n: FloatArray
    """Sum of the supports' forces."""
    weight_n: FloatArray
    """Weight of both pipes and of all masses."""
    wall_n: FloatArray
    """Sum of the wall's forces on the guide."""
    bit_n: FloatArray
    """Force of the rock."""
    loads_n: FloatArray
    """Sum of the point loads."""
    inertia_n: FloatArray
    """Minus mass times acceleration."""
    damping_n: FloatArray
    """Damping of the motion as a whole."""
    unbalance_n: FloatArray
    """Sum of all of these: the solver's residual."""


@dataclass(frozen=True)
class Transfer(TransferFigures[F]):
    """Torque, weight and power from the surface to the bit, means over a sliding window; NaN where the tool has no such
    figure. Torques and losses of torque are negative in reverse."""


@dataclass(frozen=True)
class Shape:
    """Lines of both pipes, per station."""

    bore_m: FloatArray
    """Axis of the bore in the world frame; constant."""
    low_side: FloatArray
    """Unit vector towards the low side in the world frame; constant."""
    pipe_m: FloatArray
    """Displacement (y, z) of the pipe from the bore's axis."""
    guide_m: FloatArray
    """Displacement (y, z) of the guide from the bore's axis."""


@dataclass(frozen=True)
class Whirl:
    """Per watched station and pipe."""

    station: CountArray
    """Station from the top; constant."""
    measured_depth_m: FloatArray
    """Constant."""
    inclination_rad: FloatArray
    """Constant."""
    body: CodeArray
    """Index into `BODIES`; constant."""
    kind: CodeArray
    """Index into `WHIRL_KINDS`."""
    whirl_rate_rad_per_s: FloatArray
    """Positive in the sense of the rotation."""
    whirl_ratio: FloatArray
    """Whirl rate over rotary speed; NaN where the motion has no single rate."""
    orbit_radius_m: FloatArray
    """Root mean square radius about the running mean."""
    clearance_ratio: FloatArray
    """Largest distance from the gap's centre in the window over the clearance."""
    contact_duty: FloatArray
    """Part of the window in contact, 0 to 1."""
    confidence: FloatArray
    """0 to 1."""
    severity: CodeArray
    """Index into `SEVERITIES`."""
    level_kind: CodeArray
    """Kind of whirl of the level, index into `WHIRL_KINDS`."""
    rolling: CodeArray
    """1 for backward whirl so near to rolling without slip that it counts as rolling."""
    rolling_share: FloatArray
    """Whirl rate over that of rolling without slip, for backward whirl of the pipe; 0 elsewhere."""
    peak_force_n: FloatArray
    """Largest normal force in the window."""
    gap_turns: FloatArray
    """Turns about the gap's centre per turn of the tool."""
    bending_cycles: FloatArray
    """Bending cycles per turn of the tool."""
    impulse_ns: FloatArray
    """Largest impulse above the resting one in the window."""
    impact_rate_per_s: FloatArray
    """Impacts of at least 1 N s per second."""
    friction_power_w_per_m: FloatArray
    """Work of the friction per second and metre of the tool."""


@dataclass(frozen=True)
class Hazards:
    """Per hazard, in the order of `HAZARDS`."""

    severity: CodeArray
    """Index into `SEVERITIES`."""
    value: FloatArray
    """The figure that the hazard is judged by, in its own unit."""
    threshold: FloatArray
    """Threshold of the level, in the same unit."""
    measured_depth_m: FloatArray
    """Worst place; NaN where there is none."""
    confidence: FloatArray
    """0 to 1."""
    since_s: FloatArray
    """Model time at which the level was reached."""


@dataclass(frozen=True)
class Ageing(Generic[F]):
    """Relative ageing since the start. It compares places and parameters; it predicts no life."""

    duration_s: F
    stop_damage: FloatArray
    """Per joint: damage of its stop."""
    bending_damage: FloatArray
    """Per joint: damage of the link below by bending."""
    pipe_guide_friction_work_j: FloatArray
    """Per station."""
    guide_wall_friction_work_j: FloatArray
    """Per station."""


@dataclass(frozen=True)
class Solver(Generic[N]):
    """Counters since the start."""

    newton_iterations: N
    last_iterations: N
    """Iterations of the last step."""
    rejected: N
    """Sub-steps that did not converge."""
    halved_steps: N
    deepest_halving: N
    """The smallest sub-step was a step over two to this power."""
    failed_steps: N


@dataclass(frozen=True)
class Energy(Generic[F]):
    """Energy since the start. Drive, hoist, weight, gravity, loads, feed and pressure put in; bit, friction, damping,
    string and mud take out."""

    drive_j: F
    weight_on_bit_j: F
    gravity_j: F
    loads_j: F
    feed_j: F
    axial_update_j: F
    pressure_j: F
    hoist_j: F
    bit_j: F
    friction_j: F
    contact_damping_j: F
    rayleigh_damping_j: F
    numerical_damping_j: F
    string_j: F
    mud_j: F
    joint_friction_j: F
    """Part of the friction, in the joints' pins."""
    axial_foresight_j: F
    against_laws_j: F
    """Magnitudes of the steps' errors, summed up."""
    stored_j: F
    error_j: F
    """In less out less stored."""


@dataclass(frozen=True)
class Quality(Generic[F, N]):
    """Quality of the computed motion, by its energy error over the last ten seconds."""

    level: N
    """0 good, 1 degraded, 2 poor."""
    judged: N
    """1 once the window has been full; before, the level means nothing."""
    energy_error_share: F
    numerical_share: F
    refinement: N
    """A step is solved in two to this power parts."""
