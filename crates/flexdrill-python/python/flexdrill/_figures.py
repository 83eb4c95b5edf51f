"""Written by `cargo xtask reference columns` from the table of figures. Do not edit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

F = TypeVar("F")
"""A number of one instant, or an array of numbers over time."""


@dataclass(frozen=True)
class BitFigures(Generic[F]):
    """Figures of `twin/bit_state`. The publishing interval is the time since the sample before."""

    mean_torque_nm: F
    """Torque of the rock against the bit, mean (N m): positive where it opposes forward rotation, negative in reverse,
    0 off bottom."""
    mean_rotary_speed_rad_per_s: F
    """Rotary speed of the bit, mean (rad/s, negative in reverse)."""
    mean_weight_on_bit_n: F
    """Weight on the bit, mean (N): given, or what the rock carries; 0 off bottom."""
    stick_slip_index: F
    """(max - min) / (2 mean) of the rotary speed over its window; 0 while the drive is near standstill, at least 1
    while the bit stands and the drive turns."""
    tangential_acceleration_m_per_s2: F
    """Root mean square over the publishing interval of spin acceleration times bit radius (m/s2)."""
    axial_acceleration_m_per_s2: F
    """Root mean square over the publishing interval of the axial acceleration (m/s2)."""
    lateral_acceleration_m_per_s2: F
    """Root mean square over the publishing interval of the lateral acceleration one station above the bit (m/s2)."""
    lateral_acceleration_peak_m_per_s2: F
    """Largest lateral acceleration one station above the bit in the publishing interval (m/s2)."""
    lateral_impulse_m_per_s: F
    """Integral of the size of the lateral acceleration one station above the bit over the publishing interval (m/s)."""


@dataclass(frozen=True)
class TransferFigures(Generic[F]):
    """Figures of `twin/transfer`: means over the sliding window `transfer.window`, in which every step counts. NaN
    where the tool has no such figure."""

    duration_s: F
    """Time that the means cover (s): transfer.window, less at the beginning; 0 before the first tenth of a second."""
    surface_torque_nm: F
    """Torque of the top drive (N m)."""
    surface_torque_rms_nm: F
    """Root mean square of it (N m)."""
    kickoff_torque_nm: F
    """Torque on the top of the tool (N m)."""
    kickoff_torque_rms_nm: F
    """Root mean square of it (N m)."""
    bit_torque_nm: F
    """Torque of the rock against the bit (N m), 0 off bottom."""
    bit_torque_rms_nm: F
    """Root mean square of it (N m)."""
    torque_efficiency: F
    """Torque at the bit over that at the surface, without a string over that at the kick-off; 0 off bottom. NaN below 1
    N m there and while the tool does not turn."""
    pipe_guide_friction_torque_nm: F
    """Torque of the rotation that friction between pipe and guide takes (N m): its power over the speed of the tool's
    top. NaN while the tool does not turn, as for the next two."""
    guide_wall_friction_torque_nm: F
    """Torque of the rotation that friction between guide and wall takes (N m), without what the advance takes."""
    joint_friction_torque_nm: F
    """Torque of the rotation that the pins of the joints take (N m)."""
    string_friction_torque_nm: F
    """Torque that the friction of the wall takes from the string above (N m); it also holds a string that stands."""
    surface_weight_n: F
    """Weight that is slacked off at the surface (N): what the hook carries less than off bottom."""
    surface_weight_rms_n: F
    """Root mean square of it (N)."""
    kickoff_weight_n: F
    """Axial force on the guide at the kick-off (N), positive where it pushes down the hole."""
    kickoff_weight_rms_n: F
    """Root mean square of it (N)."""
    bit_weight_n: F
    """Weight on the bit (N), 0 off bottom."""
    bit_weight_rms_n: F
    """Root mean square of it (N)."""
    hook_load_n: F
    """Load on the hook (N): the weight in mud of the string and of all that hangs on its end, guide and pipe, less what
    stands on the bottom and on the wall."""
    pipe_guide_axial_drag_n: F
    """Axial friction of the guide on the pipe (N), positive where it pushes up the hole."""
    guide_wall_axial_drag_n: F
    """Axial friction of the wall on the guide (N), positive where it pushes up the hole."""
    string_axial_drag_n: F
    """Axial friction of the wall on the string above (N), positive where it pushes up the hole."""
    depth_of_cut_m: F
    """Depth of cut (m per turn), 0 off bottom."""
    rate_of_penetration_m_per_s: F
    """Rate at which the hole deepens (m/s), never negative: how much deeper than before the bit has come. 0 off bottom,
    whatever the block does, and while a bit that was lifted is lowered to the bottom again."""
    drive_power_w: F
    """Power put in: of the top drive (W)."""
    hoist_power_w: F
    """Of the hoist (W)."""
    weight_on_bit_power_w: F
    """Of the weight on bit (W); below a hoist minus the power that the rock takes along the hole."""
    gravity_power_w: F
    """Of gravity (W)."""
    load_power_w: F
    """Of the point loads (W)."""
    feed_power_w: F
    """Of the advance (W): the friction of the wall times the advance; below a hoist with the weight on bit and less the
    string's force times the advance, which the displacements of the tool in its frame do not contain."""
    pressure_power_w: F
    """Of the pressure in the pipe (W)."""
    bit_power_w: F
    """Power taken: by the rock (W)."""
    friction_power_w: F
    """By friction in both layers and in the joints (W): the sum of the next three, to the accuracy of a step."""
    pipe_guide_friction_power_w: F
    """By friction between pipe and guide (W)."""
    guide_wall_friction_power_w: F
    """By friction between guide and wall (W)."""
    joint_friction_power_w: F
    """By friction in the joints (W)."""
    contact_damping_power_w: F
    """By the damping of contacts, stops and joints with play (W)."""
    rayleigh_damping_power_w: F
    """By Rayleigh damping (W)."""
    numerical_damping_power_w: F
    """By the time integration (W)."""
    string_power_w: F
    """By the string above, to friction on the wall and to the mud (W)."""
    axial_update_power_w: F
    """Of updating the axial force in the geometric stiffness (W), positive when put in."""
    stored_power_w: F
    """Stored as motion and deformation (W), negative when it is released."""
    error_power_w: F
    """Put in, less taken, less stored (W): the error of the energy audit."""
    mud_power_w: F
    """By the mud that moves with pipe and guide (W): power taken, part of the same balance."""
    drive_at_limit: F
    """Share of the time (0 to 1) in which the torque of the top drive was at its limit: the speed asked for is then not
    kept."""
    weight_arrives: F
    """Share of a weight at the kick-off (0 to 1) that reaches the bit when only the sliding friction of a clean hole in
    the arc takes from it."""
