"""Balances of the whole tool, from the published messages of a bag and the configuration in it alone.

balances.py BAG [--config FILE] [--settle S] [--json]

The script has a geometry of the well and laws of its own; nothing comes from the twin's code. It looks for times of
constant inputs, takes the last `transfer.window` seconds of each, and prints every balance with its residual, scale,
limit and the reason of the limit, or why the messages do not allow it. Symbols: X horizontal in the build's direction,
Y horizontal, Z down; in a station's frame x down the hole, y horizontal, z towards the low side. Units are SI.

Ends with 1 where a balance is violated, with 2 where the bag has no time to judge, with 77 when packages are missing.
"""

import argparse
import io
import json
import math
import sys
from collections import defaultdict
from dataclasses import asdict, dataclass, field
from pathlib import Path

try:
    import numpy as np
    from rosbags.highlevel import AnyReader
    from ruamel.yaml import YAML
except ImportError as missing:
    print(f"missing: {missing.name}")
    sys.exit(77)

TOPICS = {
    "transfer": "twin/transfer",
    "reactions": "twin/reactions",
    "contacts": "twin/contact_forces",
    "joints": "twin/joint_deflections",
    "bit": "twin/bit_state",
    "shape": "twin/tool_shape",
    "applied": "twin/applied_inputs",
    "session": "twin/session",
}
# Newton leaves up to 10 mN on a node at rest and up to 1 N on a node in motion (docs/mechanics.md, A step).
LEFT_AT_REST, LEFT_IN_MOTION = 0.010, 1.0
# Standard errors by which the mean of samples may differ from the mean of all steps. The error is known from eight parts
# (Student's t with 7 degrees of freedom): one mean of two thousand exceeds six by chance, as many as the array has.
STANDARD_ERRORS = 6.0
PARTS = 8
X, Y, Z = range(3)


@dataclass
class Balance:
    """One balance in one window. `residual` is signed where it is one number; `why` says why it does not apply."""

    name: str
    unit: str = ""
    residual: float = math.nan
    scale: float = math.nan
    limit: float = math.nan
    reason: str = ""
    why: str = ""

    @property
    def violated(self):
        return not self.why and not abs(self.residual) <= self.limit

    def line(self):
        if self.why:
            return f"  {self.name:<44} not applicable: {self.why}"
        mark = "VIOLATED" if self.violated else "holds"
        figures = f"{self.residual:+.4g} of {self.scale:.4g} {self.unit}, limit {self.limit:.3g}"
        return f"  {self.name:<44} {mark:<8} {figures} ({self.reason})"


@dataclass
class Window:
    condition: str
    start: float
    end: float
    balances: list = field(default_factory=list)


# ---------------------------------------------------------------- the bag and its configuration


def read(path):
    """Messages of the twin by short name, each a list of (stamp in s, message)."""
    found = defaultdict(list)
    with AnyReader([path]) as reader:
        of = {}
        for connection in reader.connections:
            for name, topic in TOPICS.items():
                if connection.topic == topic or connection.topic.endswith("/" + topic):
                    of[connection.id] = name
        wanted = [connection for connection in reader.connections if connection.id in of]
        for connection, _, data in reader.messages(connections=wanted):
            message = reader.deserialize(data, connection.msgtype)
            header = message.markers[0].header if of[connection.id] == "shape" else message.header
            found[of[connection.id]].append((header.stamp.sec * 10**9 + header.stamp.nanosec, message))
    return found


class Keys:
    """Values of the configuration by dotted key, with the defaults that docs/configuration.md lists."""

    def __init__(self, values):
        self.values = values

    def __call__(self, key, default=None):
        at = self.values
        for part in key.split("."):
            if not isinstance(at, dict) or at.get(part) is None:
                return default
            at = at[part]
        return at


def tube_area(outer, inner):
    return math.pi / 4 * (outer**2 - inner**2)


def polar(outer, inner):
    return math.pi / 32 * (outer**4 - inner**4)


class Well:
    """Centre line of straight and circular sections in the X-Z plane, from the kick-off at the origin."""

    def __init__(self, keys):
        self.pieces, self.centres = [], []
        depth, angle, point = 0.0, math.radians(keys("well.start_inclination_deg", 0.0)), np.zeros(3)
        for section in keys("well.sections"):
            if "straight" in section:
                length, radius = section["straight"]["length"], math.inf
            else:
                radius = section["arc"]["radius"]
                length = radius * math.radians(section["arc"]["build_angle_deg"])
                # The low side points away from the centre of curvature.
                self.centres.append((point - radius * low_side(angle), depth, depth + length, radius))
            self.pieces.append((depth, length, angle, radius, point))
            point = self._along(self.pieces[-1], length)
            depth, angle = depth + length, angle + length / radius
        self.length = depth

    @staticmethod
    def _along(piece, s):
        _, _, angle, radius, point = piece
        if math.isinf(radius):
            return point + s * tangent(angle)
        return point + radius * (low_side(angle + s / radius) - low_side(angle))

    def _piece(self, depth):
        return [piece for piece in self.pieces if piece[0] <= depth + 1e-12][-1]

    def point(self, depth):
        piece = self._piece(depth)
        return self._along(piece, depth - piece[0])

    def inclination(self, depth):
        piece = self._piece(depth)
        return piece[2] + (depth - piece[0]) / piece[3]


def tangent(angle):
    return np.array([math.sin(angle), 0.0, math.cos(angle)])


def low_side(angle):
    return np.array([-math.cos(angle), 0.0, math.sin(angle)])


class Tool:
    """Stations, links, weights and laws of the configured tool."""

    def __init__(self, keys):
        self.keys, self.well = keys, Well(keys)
        self.links, self.per = keys("tool.links"), keys("tool.elements_per_link", 5)
        count = self.links * self.per
        self.depth = np.linspace(0.0, self.well.length, count + 1)
        self.angle = np.array([self.well.inclination(s) for s in self.depth])
        self.bore = np.array([self.well.point(s) for s in self.depth])
        self.x = np.array([tangent(a) for a in self.angle])
        self.z = np.array([low_side(a) for a in self.angle])
        self.y = np.tile([0.0, 1.0, 0.0], (count + 1, 1))
        ends = self.bore[:: self.per]
        self.chord = np.linalg.norm(np.diff(ends, axis=0), axis=1)
        self.axis = np.diff(ends, axis=0) / self.chord[:, None]
        # Pipe: links are straight between their ends; guide: elements are straight between stations.
        within = np.arange(count + 1) % self.per / self.per
        self.on_chord = np.array(
            [
                ends[min(s // self.per, self.links - 1)]
                + (within[s] if s < count else 1.0) * (np.diff(ends, axis=0)[min(s // self.per, self.links - 1)])
                for s in range(count + 1)
            ]
        )
        g = keys("environment.gravity", 9.81) * keys("environment.buoyancy_factor", 0.86)
        self.gravity = g
        density = keys("tool.material.density", 7850.0)
        guide = [keys("tool.guide.outer_diameter"), keys("tool.guide.inner_diameter")]
        self.guide_radii = [guide[1] / 2, guide[0] / 2]
        # Per element (kg) and radius of the pipe per station (m).
        mass, spin = [], []
        for e in range(count):
            outer, inner = self.pipe_at((e % self.per + 0.5) / self.per)
            step = self.chord[e // self.per] / self.per
            mass.append(density * tube_area(outer, inner) * step)
            spin.append(density * polar(outer, inner) * step)
        self.pipe_mass, self.pipe_spin = np.array(mass), np.array(spin)
        self.guide_mass = density * tube_area(*guide) * np.linalg.norm(np.diff(self.bore, axis=0), axis=1)
        self.pipe_middle = 0.5 * (self.on_chord[1:] + self.on_chord[:-1])
        self.guide_middle = 0.5 * (self.bore[1:] + self.bore[:-1])
        self.hole = keys("well.hole_diameter") / 2
        radius = keys("tool.pipe.contact_diameter")
        if radius is None:
            radius = keys("tool.pipe.outer_diameter") or max(p["outer_diameter"] for p in keys("tool.pipe.pieces"))
        self.pipe_radius = radius / 2
        self.pieces = keys("tool.pipe.pieces")
        self.bit_radius = keys("tool.bit.diameter") / 2
        self.string = keys("string.model", "none") == "line"
        self.hoist = self.string and keys("rock.law", "paper") == "depth_of_cut"
        self.tied = keys("boundary.wob_path", "guide") == "shared"
        self.fixed_guide = keys("tool.guide.fixed", False)

    def pipe_at(self, share):
        pieces = self.keys("tool.pipe.pieces")
        if not pieces:
            return self.keys("tool.pipe.outer_diameter"), self.keys("tool.pipe.inner_diameter")
        piece = [p for p in pieces if p["from"] <= share + 1e-9][-1]
        return piece["outer_diameter"], piece["inner_diameter"]

    def station_of(self, at):
        """Stations of a location of the configuration."""
        last = len(self.depth) - 1
        if at == "top":
            return [0]
        if at == "bottom":
            return [last]
        if at == "all":
            return list(range(last + 1))
        if "station" in at:
            return [at["station"]]
        if "joint" in at:
            return [(at["joint"] + 1) * self.per]
        return [int(np.argmin(np.abs(self.depth - at["measured_depth"])))]


# ---------------------------------------------------------------- forces of the samples


class Forces:
    """Sums of forces (N) and of their moments about the origin (N m), by body, for each sample of a window."""

    def __init__(self, samples):
        zero = lambda: np.zeros((samples, 3))  # noqa: E731
        self.force = {body: zero() for body in ("pipe", "guide")}
        self.moment = {body: zero() for body in ("pipe", "guide")}

    def add(self, body, k, points, forces, moments=None):
        points, forces = np.atleast_2d(points), np.atleast_2d(forces)
        self.force[body][k] += forces.sum(axis=0)
        self.moment[body][k] += np.cross(points, forces).sum(axis=0)
        if moments is not None:
            self.moment[body][k] += np.atleast_2d(moments).sum(axis=0)

    def of(self, body):
        if body == "whole":
            return sum(self.force.values()), sum(self.moment.values())
        return self.force[body], self.moment[body]


def array(values):
    return np.asarray(values, dtype=float)


def standard_error(values):
    """Standard error of the mean of each column, from the scatter of the means of consecutive parts."""
    values = np.asarray(values, dtype=float)
    if len(values) < 2 * PARTS:
        return np.full(values.shape[1:], math.inf)
    parts = np.array([part.mean(axis=0) for part in np.array_split(values, PARTS)])
    return parts.std(axis=0, ddof=1) / math.sqrt(PARTS)


class Sampled:
    """The window's samples of which all topics with forces have the same stamp."""

    def __init__(self, tool, found, start, end, pressure):
        self.tool = tool
        by = {
            name: {stamp: message for stamp, message in found[name] if start <= stamp <= end}
            for name in ("reactions", "contacts", "shape", "bit", "joints")
        }
        self.missing = [TOPICS[name] for name, of in by.items() if not of]
        common = set.intersection(*(set(of) for of in by.values()))
        self.stamps = sorted(common)
        rows = {name: [of[stamp] for stamp in self.stamps] for name, of in by.items()}
        self.reactions, self.contacts, self.shape = rows["reactions"], rows["contacts"], rows["shape"]
        self.bit, self.joints = rows["bit"], rows["joints"]
        self.pressure = pressure

    def __len__(self):
        return len(self.stamps)

    def lateral(self, k, marker):
        """Position of a pipe's axis in the station frames (y, z), from the enlarged drawing (m)."""
        tool = self.tool
        enlarged = self.tool.keys("outputs.exaggeration", 10.0)
        points = np.array([[p.x, p.y, p.z] for p in self.shape[k].markers[marker].points])
        away = (points - tool.bore) / enlarged
        return np.stack([away[:, Y], (away * tool.z).sum(axis=1)], axis=1)

    def turned(self, k, forces, rest):
        """Adds what the wall's published sum has beyond the contacts at their stations.

        The wall's forces turn with a guide that has moved by u along an arc of curvature c: normal force times u c, along
        the hole. They go on pointing at the arc's centre, from where the guide has moved to, so that they act there. u is
        not published. The weight compresses the guide evenly, so that it is taken as a + b s, of which the published sum
        gives both numbers.
        """
        tool = self.tool
        bends = np.gradient(tool.x, tool.depth, axis=0)
        curvature = np.linalg.norm(bends, axis=1)
        centre = tool.bore + bends / np.maximum(curvature, 1e-9)[:, None] ** 2
        turns = curvature * np.abs(self.wall_normal[k])
        shares = [turns[:, None] * tool.x, (turns * (tool.depth[-1] - tool.depth))[:, None] * tool.x]
        sums = np.stack([share.sum(axis=0) for share in shares], axis=1)
        if not np.any(sums):
            return
        factors = np.linalg.lstsq(sums, rest, rcond=1e-9)[0]
        forces.add("guide", k, centre, factors[0] * shares[0] + factors[1] * shares[1])

    def bit_error(self):
        """Mean of the force along the bit's axis less the weight on bit, and its limit (N).

        The force is that of an instant, the weight the mean of the time before it.
        """
        along = self.bit_pushes @ self.tool.x[-1] + np.array([b.weight_on_bit for b in self.bit])
        across = self.bit_pushes - np.outer(self.bit_pushes @ self.tool.x[-1], self.tool.x[-1])
        size = max(abs(b.weight_on_bit) for b in self.bit)
        limit = 1e-4 * size + 1e-9 + STANDARD_ERRORS * float(standard_error(along))
        return size, limit, float(max(abs(along.mean()), np.abs(across).max()))

    def evaluate(self, kickoff_torque):
        """Forces from outside on each body, and what is checked on the way."""
        tool, forces = self.tool, Forces(len(self))
        alpha = tool.keys("tool.damping.alpha", 2.0)
        last = len(tool.depth) - 1
        self.gap_error, self.bore_error, self.weight_error, self.tilt = 0.0, 0.0, 0.0, 0.0
        self.bit_pushes, self.list_error = np.zeros((len(self), 3)), 0.0
        self.left, self.beyond_cone = np.zeros((len(self), 3)), -math.inf
        self.drags = np.zeros((len(self), 2))
        self.pipe_on = np.zeros((len(self), last + 1, 3))
        self.wall_normal = np.zeros((len(self), last + 1))
        for k in range(len(self)):
            r, c, b = self.reactions[k], self.contacts[k], self.bit[k]
            bore = np.array([[p.x, p.y, p.z] for p in self.shape[k].markers[0].points])
            self.bore_error = max(self.bore_error, np.abs(bore - tool.bore).max())
            pipe, guide = self.lateral(k, 1), self.lateral(k, 2)
            slopes = np.linalg.norm(np.diff(guide, axis=0), axis=1) / np.diff(tool.depth)
            self.tilt = max(self.tilt, slopes.max())
            at = lambda lateral: tool.bore + lateral[:, :1] * tool.y + lateral[:, 1:] * tool.z  # noqa: E731
            pipe_at, guide_at = at(pipe), at(guide)
            # Contacts: the outer body pushes back along the lean, friction acts where they touch.
            for layer, lean, centre, radius, on in (
                ("pipe_guide", pipe - guide, pipe_at, tool.pipe_radius, "pipe"),
                ("guide_wall", guide, guide_at, tool.guide_radii[1], "guide"),
            ):
                normal = array(getattr(c, f"{layer}_normal"))
                around = array(getattr(c, f"{layer}_tangential"))
                along = array(getattr(c, f"{layer}_axial"))
                size = np.linalg.norm(lean, axis=1)
                unit = lean / np.where(size > 0, size, 1.0)[:, None]
                n = unit[:, :1] * tool.y + unit[:, 1:] * tool.z
                t = -unit[:, 1:] * tool.y + unit[:, :1] * tool.z
                force = -normal[:, None] * n + around[:, None] * t + along[:, None] * tool.x
                touch = centre + radius * n
                forces.add(on, k, touch, force)
                clearance = tool.guide_radii[0] - radius if on == "pipe" else tool.hole - radius
                gap = array(getattr(c, f"{layer}_gap"))
                self.gap_error = max(self.gap_error, np.abs(clearance - size - gap).max())
                if on == "pipe":
                    forces.add("guide", k, guide_at + tool.guide_radii[0] * n, -force)
                    self.pipe_on[k] = force
                    self.drags[k, 0] = -along.sum()
                else:
                    wall = force.sum(axis=0)
                    self.drags[k, 1] = -along.sum()
                    self.wall_normal[k] = normal
            # Weight acts in the middle of each straight element, where it lies.
            down = np.array([0.0, 0.0, tool.gravity])
            moved = lambda lateral: 0.5 * (  # noqa: E731
                lateral[1:, :1] * tool.y[1:]
                + lateral[1:, 1:] * tool.z[1:]
                + lateral[:-1, :1] * tool.y[:-1]
                + lateral[:-1, 1:] * tool.z[:-1]
            )
            pipe_moved = 0.5 * (pipe_at[1:] + pipe_at[:-1])
            forces.add("pipe", k, pipe_moved, tool.pipe_mass[:, None] * down)
            forces.add("guide", k, tool.guide_middle + moved(guide), tool.guide_mass[:, None] * down)
            weight = (tool.pipe_mass.sum() + tool.guide_mass.sum()) * down
            for mass in tool.keys("masses", []):
                for s in tool.station_of(mass["at"]):
                    where = pipe_at if mass["body"] == "pipe" else guide_at
                    forces.add(mass["body"], k, where[s], mass.get("mass", 0.0) * down)
                    weight = weight + mass.get("mass", 0.0) * down
            self.weight_error = max(self.weight_error, np.abs(array(r.weight) - weight).max())
            # Supports: those of the list, and what the string above holds of the guide.
            total = np.zeros(3)
            for i, body in enumerate(r.body):
                force = np.array([r.force_x[i], r.force_y[i], r.force_z[i]])
                moment = np.array([r.moment_x[i], r.moment_y[i], r.moment_z[i]])
                point = tool.well.point(r.measured_depth[i])
                forces.add("pipe" if body == 0 else "guide", k, point, force, moment)
                total += force
            string = array(r.support_force) - total
            forces.add("guide", k, tool.bore[0], string)
            if tool.hoist:
                # Below a hoist the pipe's top hangs on the guide's. That force is not published; the first joint has it,
                # less what is between.
                own = slice(0, tool.per)
                between = self.pipe_on[k, : tool.per + 1].sum(axis=0) @ tool.axis[0]
                between += tool.pipe_mass[own].sum() * tool.gravity * tool.axis[0][Z]
                # It acts along the hole, and the supports of the pipe's top take what is across the link.
                along_link = -(between + effective_tension(tool, self, self.joints[k])[0])
                hangs = along_link / float(tool.x[0] @ tool.axis[0]) * tool.x[0]
                forces.add("pipe", k, tool.bore[0], hangs)
                forces.add("guide", k, tool.bore[0], -hangs)
            else:
                self.list_error = max(self.list_error, np.abs(string).max())
            # Bit: the weight pushes the guide's end up the hole, the rock's torque turns the pipe's end back.
            push = array(r.bit_force)
            forces.add("guide", k, guide_at[last], push)
            self.bit_pushes[k] = push
            self.turned(k, forces, array(r.wall_force) - wall)
            self.left[k] = (
                array(r.support_force)
                + weight
                + array(r.wall_force)
                + push
                + array(r.inertia_force)
                + array(r.damping_force)
            )
            # A torque on an end that may tilt lies half way between the link's axis and the tilted one.
            for s, link, torque in ((0, 0, kickoff_torque), (last, tool.links - 1, -b.torque)):
                a, z = (0, 1) if s == 0 else (last - 1, last)
                tilted = pipe_at[z] - pipe_at[a]
                half = tool.axis[link] + tilted / np.linalg.norm(tilted)
                forces.add("pipe", k, pipe_at[s], np.zeros(3), torque * half / np.linalg.norm(half))
            # Damping in proportion to the mass acts on the spin too (Eq. 7 of the paper).
            spins = np.repeat(spin_of_links(self.joints[k], b), tool.per)
            spun = -alpha * tool.pipe_spin * spins
            forces.add("pipe", k, tool.bore[0], np.zeros(3), spun[:, None] * np.repeat(tool.axis, tool.per, axis=0))
            bit_spun = -alpha * tool.keys("tool.bit.inertia", 0.0) * b.rotary_speed
            forces.add("pipe", k, tool.bore[0], np.zeros(3), bit_spun * tool.axis[-1])
            # Point loads that do not change.
            for load in tool.keys("loads", []):
                value, kind = load["history"].get("constant"), load["direction"]
                if value is None:
                    self.missing.append("the place of a load that changes")
                    continue
                for s in tool.station_of(load["at"]):
                    axes = {"u": tool.x[s], "v": tool.y[s], "w": tool.z[s]}
                    axes.update(psi=tool.x[s], phi_y=tool.y[s], phi_z=tool.z[s])
                    vector = value * axes[kind]
                    is_force = kind in "uvw"
                    forces.add(load["body"], k, tool.bore[s], vector * is_force, vector * (not is_force))
                    self.left[k] += vector * is_force
            # The pump's force on a sealed end has its reaction in the guide's connector, so that it is between the two.
            seal = tool.keys("environment.pressure.seal_diameter")
            if tool.keys("environment.pressure.end") == "sealed" and seal is not None:
                fallen = 1.0 - tool.keys("environment.pressure.drop_per_metre", 0.0) * tool.well.length
                push = self.pressure * fallen * math.pi / 4 * seal**2
                forces.add("pipe", k, tool.bore[last], -push * tool.axis[-1])
                forces.add("guide", k, tool.bore[last], push * tool.axis[-1])
        return forces


def spin_of_links(joints, bit):
    """Spin of every link (rad/s): the first turns as the second in the mean."""
    rates = array(joints.spin_rate)
    return np.concatenate([rates[:1], rates]) if len(rates) else np.array([bit.rotary_speed])


# ---------------------------------------------------------------- balances


def moment_balances(tool, sampled, forces, moving, out):
    """Forces and moments of pipe, guide and both, as means, in the world's axes."""
    if sampled.missing:
        out.append(Balance("forces and moments", why=f"the bag lacks {', '.join(sorted(set(sampled.missing)))}"))
        return
    nodes = 2 * len(tool.depth)
    # In motion residuals lie evenly within the limit of either sign, with a deviation of 1 / sqrt(3) of it: three
    # deviations of their sum. At rest they may have one sign.
    rest = (LEFT_IN_MOTION if moving else LEFT_AT_REST) * (math.sqrt(3 * nodes) if moving else nodes)
    why_rest = f"Newton's residual of {nodes} nodes" + (", of either sign, three deviations of their sum" if moving else "")
    left_out = max(SECOND_ORDER, 0.5 * sampled.tilt**2)
    centres = [(f"the centre of arc {i + 1}", c[0]) for i, c in enumerate(tool.well.centres)]
    bodies = ["whole"] if tool.tied or tool.fixed_guide else ["whole", "pipe", "guide"]
    for body in bodies:
        force, moment = forces.of(body)
        name = {"whole": "tool", "pipe": "pipe alone", "guide": "guide alone"}[body]
        axial = array([force_of(sampled, tool), [abs(b.weight_on_bit) for b in sampled.bit]]).max()
        error = STANDARD_ERRORS * standard_error(force)
        mean = force.mean(axis=0)
        if body != "whole":
            for i in range(3):
                limit = rest + error[i]
                out.append(Balance(f"force on the {name}, {'XYZ'[i]}", "N", mean[i], axial, limit, why_rest + SCATTER))
        for where, centre in [*centres, ("the bit", tool.bore[-1])]:
            about = moment - np.cross(centre, force)
            mean, error = about.mean(axis=0), STANDARD_ERRORS * standard_error(about)
            arm = max(np.linalg.norm(tool.bore - centre, axis=1).max(), tool.well.length / 2)
            for i in range(3):
                limit = rest * arm + error[i] + left_out * axial * arm
                reason = f"{why_rest} on {arm:.2f} m, {left_out:.2g} of the force at the top on it{SCATTER}"
                out.append(
                    Balance(
                        f"moment of the {name} about {where}, {'XYZ'[i]}", "N m", mean[i], axial * arm, limit, reason
                    )
                )
    if len(bodies) == 1:
        why = (
            "the force of the tie between both ends is not published"
            if tool.tied
            else "the guide is held at every node"
        )
        out.append(Balance("forces on pipe and guide alone", why=why))


SCATTER = ", and six standard errors of the samples' mean"
# Displacements enter the arms of the model's moments to first order (docs/mechanics.md, geometric stiffness): what is
# left out is by how much a tilted part is shorter along the hole, half of the square of the guide's largest tilt there.
# The least of it is for a tilt of 0.014 rad, since pipe and joints tilt too.
SECOND_ORDER = 1e-4


def force_of(sampled, tool):
    """Size of the axial force at the top, per sample (N)."""
    return [abs(float(np.dot(array(r.support_force), tool.x[0]))) for r in sampled.reactions]


def instant_balances(tool, sampled, moving, out):
    """What holds at every sample."""
    if sampled.missing:
        return
    nodes = 2 * len(tool.depth)
    limit = LEFT_IN_MOTION * math.sqrt(nodes) if moving else LEFT_AT_REST * nodes
    reason = f"Newton's residual of {nodes} nodes, worst of {len(sampled)} samples"
    if tool.hoist:
        # The acceleration of the tool's frame is left out: below a thousandth of gravity (docs/effects/string.md).
        limit += 1e-3 * float(np.linalg.norm(array(sampled.reactions[0].weight)))
        reason += ", 0.001 g"
    worst = float(np.linalg.norm(sampled.left, axis=1).max())
    scale = max(np.linalg.norm(array(r.wall_force)) + np.linalg.norm(array(r.support_force)) for r in sampled.reactions)
    out.append(Balance("forces, inertia and damping of the tool", "N", worst, scale, limit, reason))
    out.append(Balance("axis of the bore", "m", sampled.bore_error, tool.well.length, 1e-9, "rounding"))
    out.append(Balance("gaps of both layers", "m", sampled.gap_error, tool.hole, 1e-9, "rounding"))
    weight = float(array(sampled.reactions[0].weight)[Z])
    out.append(Balance("weight of the tool", "N", sampled.weight_error, weight, 1e-6 * abs(weight) + 1e-9, "rounding"))
    size, limit, error = sampled.bit_error()
    reason = "an instant against the mean before it: 0.01 %, and six standard errors of the samples' mean"
    out.append(Balance("weight on bit along the bit's axis", "N", error, size, limit, reason))
    if tool.hoist:
        out.append(Balance("supports in the list and their sum", why="the string's pull is not in the list"))
    else:
        total = max(np.linalg.norm(array(r.support_force)) for r in sampled.reactions)
        reason = "rounding; without a hoist no other support carries"
        out.append(Balance("supports in the list and their sum", "N", sampled.list_error, total, 1e-6 * total, reason))


def effective_tension(tool, sampled, joints):
    """Effective tension at every joint (N): its pins carry it and the pressure on their seal."""
    area = math.pi / 4 * tool.keys("environment.pressure.joint_seal_diameter", tool.pipe_at(0.5)[1]) ** 2
    drop = tool.keys("environment.pressure.drop_per_metre", 0.0)
    places = np.arange(1, tool.links) * tool.per
    pressure = sampled.pressure if tool.keys("environment.pressure") else 0.0
    return array(joints.axial_force) - pressure * area * (1.0 - drop * tool.depth[places])


def link_balances(tool, sampled, out):
    """Axial force from joint to joint along the pipe, in the axis of each link."""
    if sampled.missing or tool.links < 2:
        return
    shear = np.array([array(j.shear_force) for j in sampled.joints])
    effective = np.array([effective_tension(tool, sampled, j) for j in sampled.joints])
    worst = None
    # Below a hoist the first link says by what its top hangs.
    for link in range(1 if tool.hoist else 0, tool.links - 1):
        own = slice(link * tool.per, (link + 1) * tool.per)
        share = sampled.pipe_on[:, link * tool.per : (link + 1) * tool.per + 1].copy()
        # A contact at a joint's station acts on the link above.
        if link > 0:
            share[:, 0] = 0.0
        along = share.sum(axis=1) @ tool.axis[link]
        weight = tool.pipe_mass[own].sum() * tool.gravity * tool.axis[link][Z]
        if link == 0:
            above = np.array([pipe_top(r) for r in sampled.reactions]) @ tool.axis[0]
            unknown = 0.0
        else:
            bend = math.acos(min(1.0, float(np.dot(tool.axis[link - 1], tool.axis[link]))))
            above = -effective[:, link - 1] * math.cos(bend)
            unknown = float(np.abs(shear[:, link - 1]).mean()) * math.sin(bend)
        residual = above + weight + along + effective[:, link]
        limit = LEFT_IN_MOTION * math.sqrt(tool.per) + unknown + STANDARD_ERRORS * float(standard_error(residual))
        scale = float(np.abs(effective[:, link]).mean() + np.abs(above).mean())
        row = Balance(
            f"axial force of link {link + 1}",
            "N",
            float(residual.mean()),
            scale,
            limit,
            "Newton's residual, the shear of the joint above on the bend of the hole, whose direction is not published"
            + SCATTER,
        )
        if worst is None or abs(row.residual) / row.limit > abs(worst.residual) / worst.limit:
            worst = row
    if worst:
        out.append(worst)


def without_nan(value):
    """The same with null for numbers that are none, which JSON does not have."""
    if isinstance(value, dict):
        return {key: without_nan(part) for key, part in value.items()}
    if isinstance(value, list):
        return [without_nan(part) for part in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def pipe_top(reactions):
    """Force of the support on the pipe's top (N)."""
    total = np.zeros(3)
    for i, body in enumerate(reactions.body):
        if body == 0 and reactions.measured_depth[i] == 0.0:
            total += [reactions.force_x[i], reactions.force_y[i], reactions.force_z[i]]
    return total


def powers(tool, transfer, samples, speed, out):
    """Power in and out by the published terms, and those terms that torque and speed give."""
    t = transfer
    given = [t.drive_power, t.hoist_power, t.weight_on_bit_power, t.gravity_power, t.load_power, t.feed_power]
    given += [t.pressure_power, t.axial_update_power]
    taken = [t.bit_power, t.friction_power, t.contact_damping_power, t.rayleigh_damping_power]
    taken += [t.numerical_damping_power, t.string_power, t.mud_power]
    scale = sum(abs(p) for p in given + taken) / 2
    rest = sum(given) - sum(taken) - t.stored_power - t.error_power
    out.append(Balance("power in, out, stored and error", "W", rest, scale, 1e-6 * scale + 1e-9, "rounding of sums"))
    damped = (
        abs(t.contact_damping_power) + abs(t.rayleigh_damping_power) + abs(t.numerical_damping_power) + abs(t.mud_power)
    )
    limit = 0.01 * scale + 0.5 * damped + 0.1
    reason = "1 % of the power, half of what damping takes (model_quality GOOD), the audit's 0.1 W"
    out.append(Balance("error of the energy audit", "W", t.error_power, scale, limit, reason))
    parts = t.pipe_guide_friction_power + t.guide_wall_friction_power + t.joint_friction_power
    limit = 0.02 * (abs(t.friction_power) + abs(parts)) + 0.05
    reason = "instants at the ends of steps against means over steps, 2 % and 0.05 W"
    out.append(Balance("friction power by parts", "W", parts - t.friction_power, abs(t.friction_power), limit, reason))
    for name in ("bit", "pipe_guide_friction", "guide_wall_friction", "joint_friction", "contact_damping", "string"):
        value = getattr(t, f"{name}_power")
        if not math.isnan(value):
            reason = "no dissipation gives power; 1 % of the power for what is stored by bristles and waves"
            out.append(Balance(f"{name} power not negative", "W", min(value, 0.0), scale, 0.01 * scale + 0.05, reason))
    if tool.string:
        swing = max(t.surface_torque_rms**2 - t.surface_torque**2, 0.0)
        gain = drive_gain(tool)
        if gain is None:
            limit = 0.005 * abs(t.drive_power) + 0.1
            reason = "0.5 % and 0.1 W; the drive is rigid"
        else:
            limit = 0.005 * abs(t.drive_power) + swing / gain + 0.1
            reason = "0.5 %, 0.1 W, and the torque's swing squared over the drive's gain, by which its speed gives way"
        out.append(
            Balance(
                "power of the drive", "W", t.drive_power - t.surface_torque * speed, abs(t.drive_power), limit, reason
            )
        )
        out.append(Balance("power at the kick-off", why="the speed of the tool's top and its power are not published"))
    elif not tool.keys("boundary.drive", "top") == "none":
        limit = 0.005 * abs(t.drive_power) + 0.02
        reason = "0.5 % and 0.02 W, the speed is prescribed"
        out.append(
            Balance(
                "power of the drive", "W", t.drive_power - t.kickoff_torque * speed, abs(t.drive_power), limit, reason
            )
        )
    if len(samples):
        product = np.array([b.torque * b.rotary_speed for b in samples])
        error = STANDARD_ERRORS * float(standard_error(product)) if len(product) >= 2 * PARTS else math.inf
        limit = 0.01 * abs(t.bit_power) + error + 0.1
        reason = "1 %, 0.1 W" + SCATTER
        out.append(Balance("power of the bit", "W", t.bit_power - product.mean(), abs(t.bit_power), limit, reason))


def drive_gain(tool):
    """Torque by which the top drive answers an error of its speed (N m s/rad); None where it is rigid."""
    tuning = tool.keys("string.top_drive.tuning", "stiff")
    if tuning == "rigid":
        return None
    if tuning == "stiff":
        return tool.keys("string.top_drive.proportional", 38000.0)
    section = tool.keys("string.sections")[0]
    e, nu = tool.keys("string.material.youngs_modulus", 206e9), tool.keys("string.material.poisson_ratio", 0.3)
    rho = tool.keys("string.material.density", 7850.0)
    impedance = polar(section["outer_diameter"], section["inner_diameter"]) * math.sqrt(e / (2 * (1 + nu)) * rho)
    return tool.keys("string.top_drive.impedance_ratio", 4.0) * impedance


def string_inertia(tool):
    rho = tool.keys("string.material.density", 7850.0)
    sections = tool.keys("string.sections", [])
    own = sum(rho * polar(s["outer_diameter"], s["inner_diameter"]) * s["length"] for s in sections)
    return own + tool.keys("string.top_drive.inertia", 2900.0)


def string_weight(tool):
    """Weight of the string along the hole, in mud (N), and its mass (kg)."""
    rho = tool.keys("string.material.density", 7850.0)
    weight = mass = 0.0
    for s in tool.keys("string.sections", []):
        m = rho * tube_area(s["outer_diameter"], s["inner_diameter"]) * s["length"]
        mass += m
        weight += m * tool.gravity * math.cos(math.radians(s.get("inclination_deg", 0.0)))
    return weight, mass


def string_travel(tool):
    """Time that an axial wave takes along the string (s)."""
    e, rho = tool.keys("string.material.youngs_modulus", 206e9), tool.keys("string.material.density", 7850.0)
    return sum(s["length"] for s in tool.keys("string.sections", [])) / math.sqrt(e / rho)


def torques(tool, transfer, sampled, speed, out):
    """Torque from the surface to the bit."""
    t = transfer
    spins = np.array([spin_of_links(j, b)[0] for j, b in zip(sampled.joints, sampled.bit)])
    # The string lags behind its end by the waves' time: a tenth of the swing in addition to the change.
    change = abs(float(spins[-1] - spins[0])) + 0.1 * float(np.ptp(spins)) if len(spins) else math.inf
    wandering = change / max(t.duration, 1e-9)
    if tool.string:
        if tool.keys("string.attenuation_per_km", 0.0) > 0.0:
            out.append(Balance("torque along the string", why="the mud's drag on the string is not published"))
        else:
            rest = t.surface_torque - t.string_friction_torque - t.kickoff_torque
            limit = 0.005 * abs(t.surface_torque) + 0.5 + string_inertia(tool) * wandering
            reason = "0.5 %, 0.5 N m, and the spin of drive and string that the window may end with"
            out.append(Balance("torque along the string", "N m", rest, abs(t.surface_torque), limit, reason))
    mean = float(np.mean(spins)) if len(spins) else math.nan
    if abs(mean) < 0.5 or not len(spins):
        out.append(Balance("torque along the tool", why="the tool stands: friction has no mean power to compare"))
        return
    # The rotation alone gives what friction, damping and mud take of the pipe, without gravity and other work.
    lost = t.pipe_guide_friction_power + t.joint_friction_power + t.contact_damping_power + t.rayleigh_damping_power
    lost += t.numerical_damping_power + t.mud_power + t.guide_wall_friction_power - t.feed_power
    lost -= t.gravity_power + t.load_power + t.pressure_power + t.axial_update_power
    if not tool.hoist:
        lost -= t.weight_on_bit_power
    rest = t.kickoff_torque - t.bit_torque - lost / mean
    swing = math.sqrt(max(t.kickoff_torque_rms**2 - t.kickoff_torque**2, 0.0)) * float(np.std(spins)) / abs(mean)
    stored = abs(t.stored_power / mean) if not tool.string else 0.02 * abs(t.kickoff_torque)
    limit = 0.05 * abs(lost / mean) + 0.01 * abs(t.kickoff_torque) + 0.2 + swing + stored + abs(t.error_power / mean)
    reason = (
        "5 % of the losses (mechanics_transfer), 1 % for the joints' ripple, joint swing of torque and speed, stored"
    )
    out.append(Balance("torque along the tool", "N m", rest, abs(t.kickoff_torque), limit, reason))


def weights(tool, transfer, sampled, out):
    """Axial force from hook to bit, and the drags against the contacts that make them."""
    t = transfer
    if len(sampled) and not sampled.missing:
        for i, (name, value) in enumerate(
            [("pipe_guide_axial_drag", t.pipe_guide_axial_drag), ("guide_wall_axial_drag", t.guide_wall_axial_drag)]
        ):
            error = STANDARD_ERRORS * float(standard_error(sampled.drags[:, i]))
            size = float(np.abs(sampled.drags[:, i]).mean())
            limit = 0.01 * size + 1.0 + error
            reason = "1 % and 1 N" + SCATTER
            out.append(Balance(name, "N", float(value - sampled.drags[:, i].mean()), size, limit, reason))
    if not tool.string:
        return
    weight, mass = string_weight(tool)
    if math.isnan(t.kickoff_weight):
        out.append(Balance("hook load", why="no weight at the kick-off is published"))
        return
    if not len(sampled) or sampled.missing:
        out.append(Balance("hook load", why="the bag lacks the support of the pipe's top (twin/reactions)"))
        return
    if not tool.hoist:
        out.append(Balance("hook load", why="without a hoist the string carries torque only"))
        return
    top = float(np.mean([np.dot(pipe_top(r), tool.x[0]) for r in sampled.reactions]))
    drag = 0.0 if math.isnan(t.string_axial_drag) else t.string_axial_drag
    rest = t.hook_load - (weight - drag - t.kickoff_weight - top)
    # Waves carry momentum: force times time of travel, of either sign at both ends of the window.
    swing = math.sqrt(max(t.kickoff_weight_rms**2 - t.kickoff_weight**2, 0.0))
    waves = 2 * math.sqrt(2) * swing * string_travel(tool) / t.duration
    limit = 1e-4 * abs(t.hook_load) + 5.0 + mass * 1e-3 + waves
    reason = "0.01 %, 5 N, the string's mass at 1 mm/s2, to which the hoist accelerates it, and momentum of its waves"
    out.append(Balance("hook load", "N", rest, abs(t.hook_load), limit, reason))
    why = "the force in the string while the tool hangs, from which the surface weight counts, is not published"
    out.append(Balance("weight along the string", why=why))


def nearby_change(values):
    """Largest change from one value to the next, of the three before and after each."""
    steps = np.abs(np.diff(values))
    return np.array([steps[max(i - 3, 0) : i + 3].max(initial=0.0) for i in range(len(values))])


def rock(tool, transfer, samples, found_factor, out):
    """Torque by weight, rock removed by advance, and the work it took."""
    t, law, radius = transfer, tool.keys("rock.law", "paper"), tool.bit_radius
    slip = tool.keys("tool.bit.slip_rate", 0.1)
    if not samples:
        out.append(Balance("torque of the rock", why="the bag lacks twin/bit_state"))
        return
    torque, weight = np.array([b.torque for b in samples]), np.array([b.weight_on_bit for b in samples])
    speed = np.array([b.rotary_speed for b in samples])
    sign = speed / np.hypot(speed, slip)
    ratio = tool.keys("rock.weakening.ratio", 1.0)
    rate = tool.keys("rock.weakening.rate_rpm", 100.0) * math.pi / 30
    weakening = 1.0 + (ratio - 1.0) * np.exp(-np.abs(speed) / rate)
    if law in ("paper", "weakening"):
        own = found_factor * 2 * radius * weight / 3 * sign * (weakening if law == "weakening" else 1.0)
        scale = max(np.abs(own).max(), 1e-9)
        if law == "weakening":
            # A bit that stands holds whatever torque there is, up to the law's.
            holds = np.abs(speed) < 10 * slip
            most = found_factor * 2 * radius * weight / 3 * ratio
            own = np.where(holds, np.clip(torque, -most, most), own)
            scale = max(scale, np.abs(most).max())
        off = np.abs(torque - own)
        limits = np.full(len(samples), 1e-3 * scale + 1e-6)
        reason = "Eq. 1 at each sample; 0.1 % for a weight that its limit still changes within a step"
        if law == "weakening":
            # Samples are means. The mean torque is that of the mean weight by a mean of the weakening, weighted by the
            # weight, which swings with it: it lies between the least and the most weakening in the sample. A sample
            # reaches up to twice as far as from one to the next near it.
            limits += found_factor * 2 * radius / 3 * np.abs(weight) * 2 * nearby_change(weakening)
            reason += ", and twice what the weakening changes by from sample to sample"
        at = int(np.argmax(off / limits))
        worst, limit = float(off[at]), float(limits[at])
        out.append(Balance("torque of the rock by its weight", "N m", worst, scale, limit, reason))
        out.append(Balance("rock removed by advance", why="the law has no depth of cut"))
        return
    at = lambda key, default: tool.keys(f"rock.depth_of_cut.{key}", default)  # noqa: E731
    e, zeta, flat = at("specific_energy", 3e7), at("cutter_inclination", 0.6), at("wear_flat_force", 8670.0)
    friction = at("wear_flat_friction", 0.106)
    # Cutters and wear flats share the weight. Both laws are linear, so that the means say how.
    cut = t.depth_of_cut
    pressed = t.bit_weight - zeta * e * radius * cut
    steady = abs(float(speed.mean())) > 0.5 and np.abs(speed).min() > 10 * slip
    # The friction of the flats falls with the speed, and a part of the cutters' torque.
    part, size = at("cutting_weakening", 0.0), float(np.mean(weakening))
    of_cutting = 1.0 + part * (size - 1.0)
    spread = float(np.ptp(weakening)) * (friction * radius * max(pressed, 0.0) + part * e * radius**2 * cut) / 2
    if not steady:
        out.append(Balance("torque of the rock by its weight", why="the bit stands at times: its torque is anything"))
    else:
        forward = float(speed.mean()) > 0.0
        # A bit that turns backwards does not cut: all of its weight is on the wear flats.
        own = friction * radius * (pressed if forward else t.bit_weight) / 2 * size
        own = own + of_cutting * e * radius**2 * cut / 2 if forward else -own
        limit = 0.01 * abs(own) + spread + 0.01
        reason = "1 % for the smooth sign at ten times its width, the range of the weakening"
        out.append(Balance("torque of the rock by its weight", "N m", t.bit_torque - own, abs(own), limit, reason))
        if not forward:
            limit, reason = 1e-7, "blades cut forwards only: 0.1 um per turn"
            out.append(Balance("depth of cut in reverse", "m", cut, cut, limit, reason))
    # A bit that turns back stands on its wear flats with all of its weight.
    most = flat if float(speed.mean()) >= 0.0 else math.inf
    excess = max(pressed - most, -pressed, 0.0)
    reason = "forward the flats press between nothing and their full force; 0.1 % of the weight and 1 N"
    row = Balance("force of the wear flats within its range", "N", excess, flat, 1e-3 * abs(t.bit_weight) + 1.0, reason)
    out.append(row)
    turns = float(speed.mean()) / (2 * math.pi)
    removed = max(turns, 0.0) * t.depth_of_cut
    advance = t.rate_of_penetration
    density = 2500.0
    per = math.pi * radius**2 * density
    scale = max(abs(advance), abs(removed)) * per
    # The mean of a product is that of the means and, at most, the product of both swings; the depth's is the weight's.
    together = float(np.std(weight)) / (zeta * e * radius) * float(np.std(speed)) / (2 * math.pi)
    # The bottom goes down blade by blade: one cut more or less in the window.
    cut_by_cut = abs(cut) / at("blades", 4) / t.duration
    limit = per * (0.01 * abs(removed) + together + cut_by_cut + 1e-6)
    reason = "1 %, the swings of depth and speed together, one blade's cut, 1 um/s for waves; 2500 kg/m3"
    if advance < 0.0 or t.bit_weight < 1.0:
        # Off bottom the bit may rise or sink without removing rock; rock may not be removed there.
        if t.bit_weight < 1.0:
            out.append(
                Balance(
                    "rock removed off bottom", "kg/s", removed * per, scale, per * 1e-7, "no weight, no rock: 0.1 um/s"
                )
            )
        out.append(Balance("mass of rock removed by advance", why="the bit is off bottom or pulled back"))
    else:
        out.append(Balance("mass of rock removed by advance", "kg/s", (advance - removed) * per, scale, limit, reason))
    # What the bit takes of power, less the rubbing of the flats, is the energy to cut the volume that the bit left behind.
    if not steady:
        out.append(Balance("work of cutting by volume", why="the bit stands at times"))
        return
    rubbing = friction * radius * max(pressed, 0.0) / 2 * size * abs(float(speed.mean()))
    # The bit's power is that of its torque and, in the frame that advances with the block, of its weight.
    cutting = float((torque * speed).mean()) - rubbing
    volume = math.pi * radius**2 * max(advance, 0.0) if t.bit_weight > 1.0 else 0.0
    error = STANDARD_ERRORS * float(standard_error(torque * speed)) + spread * abs(float(speed.mean()))
    limit = 0.02 * abs(cutting) + 0.02 * rubbing + e * math.pi * radius**2 * (1e-6 + cut_by_cut) + error + 0.5
    reason = "2 %, one blade's cut, 1 um/s, 0.5 W" + SCATTER
    off = cutting - of_cutting * e * volume
    out.append(Balance("work of cutting by volume", "W", off, abs(cutting), limit, reason))


def coulomb(tool, sampled, applied, out):
    """Friction of every contact within Coulomb's limit."""
    if sampled.missing:
        return
    for layer, coefficients in (("pipe_guide", applied.inner_friction), ("guide_wall", applied.outer_friction)):
        law = tool.keys(f"contact.{'inner' if layer == 'pipe_guide' else 'outer'}.friction", "separate")
        mu_t, mu_x = float(coefficients[0]), float(coefficients[1])
        factor = 1.0
        if layer == "guide_wall":
            factor = max(
                tool.keys(f"contact.wall_friction_factors.{key}", 1.0) for key in ("before_arc", "arc", "after_arc")
            )
        worst = scale = 0.0
        for c in sampled.contacts:
            n = array(getattr(c, f"{layer}_normal")) * factor
            t, a = array(getattr(c, f"{layer}_tangential")), array(getattr(c, f"{layer}_axial"))
            if law == "separate":
                beyond = np.maximum(np.abs(t) - mu_t * n, np.abs(a) - mu_x * n)
            elif min(mu_t, mu_x) == 0.0:
                beyond = np.hypot(t, a) - max(mu_t, mu_x) * n
            else:
                beyond = (np.hypot(t / mu_t, a / mu_x) - n) * max(mu_t, mu_x)
            worst, scale = max(worst, float(beyond.max())), max(scale, float(max(mu_t, mu_x) * n.max()))
        limit = 1e-6 * scale + 1e-9
        out.append(
            Balance(
                f"{layer} friction within Coulomb's limit", "N", worst, scale, limit, "rounding; a law at each sample"
            )
        )


# ---------------------------------------------------------------- windows


def phases(found):
    """Times of constant targets: (from, to, inputs), in ns."""
    all_stamps = [stamp for stamp, _ in found["transfer"]] or [stamp for stamp, _ in found["bit"]]
    end = max(all_stamps) if all_stamps else 0
    begun, out = None, []
    for stamp, m in found["applied"]:
        key = (m.rotary_speed, m.weight_on_bit, m.rate_of_penetration, m.standpipe_pressure, m.reset)
        key += (tuple(m.inner_friction), tuple(m.outer_friction), m.bit_friction_factor)
        key += tuple(m.parameter_value)
        if begun is None or begun[1] != key:
            if begun is not None:
                out.append((begun[0], stamp, begun[2]))
            begun = (stamp, key, m)
    if begun is not None:
        out.append((begun[0], end, begun[2]))
    return out


def condition_of(inputs, tool):
    rpm, weight = inputs.rotary_speed * 30 / math.pi, inputs.weight_on_bit / 1e3
    what = "standing" if abs(rpm) < 0.01 else "reversed" if rpm < 0 else "drilling" if weight > 0 else "lifted"
    pressure = pressure_of(inputs, tool) / 1e6
    pump = f", pump {pressure:g} MPa" if pressure else ""
    return f"{what} at {rpm:.4g} r/min and {weight:.4g} kN{pump}"


def pressure_of(inputs, tool):
    at_top = tool.keys("environment.pressure.at_top", "standpipe")
    if not tool.keys("environment.pressure"):
        return 0.0
    return inputs.standpipe_pressure if at_top == "standpipe" else float(at_top)


def settling(tool, before, inputs):
    """Time after a change of the inputs until the tool has followed it (s)."""
    changes = [2.0]
    if before is not None:
        for name, slew in (
            ("rotary_speed", "rotary_speed_slew"),
            ("weight_on_bit", "weight_on_bit_slew"),
            ("rate_of_penetration", "rate_of_penetration_slew"),
            ("standpipe_pressure", "standpipe_pressure_slew"),
        ):
            change = abs(getattr(inputs, name) - getattr(before, name))
            changes.append(2.0 + change / max(getattr(inputs, slew), 1e-12) if change else 0.0)
    elif not tool.hoist:
        changes = [0.0]
    settle = max(changes)
    if tool.hoist:
        settle += 8 * tool.keys("string.hoist.response_time", 4.0)
    return settle


def judge(tool, found, settle):
    windows, begin, before = [], min(stamp for stamp, _ in found["applied"]), None
    for start, end, inputs in phases(found):
        wait = settle if settle is not None else settling(tool, before, inputs)
        transfers = [(s, m) for s, m in found["transfer"] if start < s <= end and m.duration > 0]
        before = inputs
        fitting = [(s, m) for s, m in transfers if s - m.duration * 1e9 >= start + wait * 1e9 - 1e6]
        if not fitting:
            continue
        stamp, transfer = fitting[-1]
        first = stamp - round(transfer.duration * 1e9)
        window = Window(condition_of(inputs, tool), (first - begin) / 1e9, (stamp - begin) / 1e9)
        sampled = Sampled(tool, found, first, stamp, pressure_of(inputs, tool))
        bits = [m for s, m in found["bit"] if first < s <= stamp]
        moving = abs(inputs.rotary_speed) > 1e-9
        if not moving and bits:
            moving = float(np.std([b.rotary_speed for b in bits])) > 1e-6 or abs(bits[-1].rotary_speed) > 1e-6
        out = window.balances
        if not sampled.missing and len(sampled) < 2 * PARTS:
            sampled.missing.append(f"samples: {len(sampled)} in {transfer.duration:.1f} s have all topics at one stamp")
        if not sampled.missing:
            forces = sampled.evaluate(transfer.kickoff_torque)
            instant_balances(tool, sampled, moving or tool.hoist, out)
        else:
            forces = None
        moment_balances(tool, sampled, forces, moving or tool.hoist, out)
        link_balances(tool, sampled, out)
        coulomb(tool, sampled, inputs, out)
        weights(tool, transfer, sampled, out)
        speed = inputs.rotary_speed
        powers(tool, transfer, bits, speed, out)
        torques(tool, transfer, sampled, speed, out)
        rock(tool, transfer, bits, inputs.bit_friction_factor, out)
        windows.append(window)
    return windows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bag", type=Path)
    parser.add_argument("--config", type=Path, help="configuration, instead of the one in the bag")
    parser.add_argument("--settle", type=float, help="time after a change of the inputs that is left out (s)")
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    found = read(given.bag)
    if given.config is not None:
        text = given.config.read_text()
    elif found["session"]:
        text = found["session"][0][1].configuration
    else:
        print(f"{given.bag}: no {TOPICS['session']} in it; give --config")
        return 2
    tool = Tool(Keys(YAML(typ="safe").load(io.StringIO(text))))
    windows = judge(tool, found, given.settle) if found["applied"] else []
    violated = [(window, balance) for window in windows for balance in window.balances if balance.violated]
    if given.json:
        rows = [
            {**asdict(window), "balances": [{**asdict(b), "violated": b.violated} for b in window.balances]}
            for window in windows
        ]
        print(json.dumps(without_nan({"windows": rows, "violated": len(violated)}), allow_nan=False))
    else:
        for window in windows:
            print(f"{window.condition}, {window.start:.1f} to {window.end:.1f} s")
            for balance in window.balances:
                print(balance.line())
        print(f"{len(windows)} windows, {sum(len(w.balances) for w in windows)} balances, {len(violated)} violated")
    if not windows:
        print("no time of constant inputs is long enough to judge", file=sys.stderr)
        return 2
    return 1 if violated else 0


if __name__ == "__main__":
    sys.exit(main())
