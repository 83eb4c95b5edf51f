#!/usr/bin/env python3
"""The flexible drilling tool in EXUDYN, for a comparison of speed with flexdrill. See README.md beside this file.

Prints one line of JSON: model time, processor time, steps, Newton iterations, unknowns, and what the tool did.
"""

import argparse
import json
import os
import sys
import time

os.environ.setdefault("OMP_NUM_THREADS", "1")
sys.exudynFast = True  # EXUDYN's build without range checks: the fair one to compare with
import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    LoadForceVector,
    LoadMassProportional,
    LoadTorqueVector,
    MarkerBodyMass,
    MarkerNodePosition,
    MarkerNodeRigid,
    NodeGenericData,
    NodePointGround,
    NodeRigidBodyRxyz,
    ObjectBeamGeometricallyExact,
    ObjectConnectorTorsionalSpringDamper,
    ObjectContactSphereSphere,
    ObjectJointGeneric,
)

# As config/default.yaml has them; SI.
YOUNG, POISSON, DENSITY = 206e9, 0.3, 7850.0
PIPE, GUIDE, HOLE = (0.063, 0.032), (0.102, 0.080), 0.118
RADIUS, BUILD = 3.2, np.pi / 2
GRAVITY = 9.81 * 0.86
RAYLEIGH_BETA = 1e-4
INNER, OUTER = (1e7, 0.2), (2e7, 0.3)  # contact stiffness (N/m), friction
SLIP_SPEED = 0.01
BIT = 0.235 * 0.118 / 3  # torque per weight on bit, Eq. 1 of the paper


def about_y(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


def about_x(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])


def turned(rotation):
    """A marker's frame turned in its body."""
    transformation = np.eye(4)
    transformation[:3, :3] = rotation
    return transformation


# Turns z onto x: EXUDYN's torsional spring acts about z, the tool's axis is x.
Z_TO_X = about_y(np.pi / 2)


class Tool:
    """Well plane x-z, tangent from -45 to 45 degrees about y.

    The world is turned by 45 degrees against flexdrill's, so that the second of the three angles of a spinning node stays below 45
    degrees; at 90 they are singular.
    """

    def __init__(self, args):
        self.args = args
        self.container = exu.SystemContainer()
        self.mbs = self.container.AddSystem()
        self.links, self.elements = args.links, args.elements
        self.stations = self.links * self.elements
        self.length = RADIUS * BUILD * args.links / 33
        self.build = self.length / RADIUS
        self.spin = args.rpm * 2 * np.pi / 60
        self.ground = self.mbs.AddNode(NodePointGround())
        self.contacts = []
        self.guide()
        self.pipe()
        self.gaps()
        self.loads()
        self.mbs.Assemble()

    def angle(self, arc):
        """Rotation about y at an arc length: x turns up against z for a positive angle, so the build is negative."""
        return 0.25 * np.pi - arc / RADIUS

    def place(self, arc):
        a, b = self.angle(0), self.angle(arc)
        return RADIUS * np.array([np.sin(a) - np.sin(b), 0, np.cos(a) - np.cos(b)])

    def node(self, place, angle, spin=0.0):
        # Rates of the angles of R = Rx(a) Ry(b) Rz(c) at a = c = 0 for a spin about the node's own x axis.
        rates = [spin / np.cos(angle), 0, -spin * np.tan(angle)]
        return self.mbs.AddNode(
            NodeRigidBodyRxyz(referenceCoordinates=[*place, 0, angle, 0], initialVelocities=[0, 0, 0, *rates])
        )

    def section(self, outer, inner):
        area = np.pi / 4 * (outer**2 - inner**2)
        second = np.pi / 64 * (outer**4 - inner**4)
        shear = YOUNG / (2 * (1 + POISSON))
        # Shear correction of a thick ring (Cowper 1966).
        m = (inner / outer) ** 2
        k = 6 * (1 + POISSON) * (1 + m) ** 2 / ((7 + 6 * POISSON) * (1 + m) ** 2 + (20 + 12 * POISSON) * m)
        section = exu.BeamSection()
        stiffness = np.diag(
            [YOUNG * area, k * shear * area, k * shear * area, 2 * shear * second, YOUNG * second, YOUNG * second]
        )
        section.stiffnessMatrix = stiffness
        section.dampingMatrix = RAYLEIGH_BETA * stiffness
        section.inertia = np.diag([2 * DENSITY * second, DENSITY * second, DENSITY * second])
        section.massPerLength = DENSITY * area
        return section

    def beam(self, nodes, length, section):
        body = self.mbs.AddObject(
            ObjectBeamGeometricallyExact(nodeNumbers=nodes, length=length, sectionData=section)
        )
        # The world is turned: gravity points along flexdrill's Z.
        down = GRAVITY * np.array([np.cos(self.angle(0)), 0, -np.sin(self.angle(0))])
        marker = self.mbs.AddMarker(MarkerBodyMass(bodyNumber=body))
        self.mbs.AddLoad(LoadMassProportional(markerNumber=marker, loadVector=list(down)))

    def guide(self):
        section = self.section(*GUIDE)
        step = self.length / self.stations
        self.guide_nodes = [self.node(self.place(i * step), self.angle(i * step)) for i in range(self.stations + 1)]
        for pair in zip(self.guide_nodes, self.guide_nodes[1:]):
            self.beam(list(pair), step, section)

    def pipe(self):
        section = self.section(*PIPE)
        step = self.length / self.links
        ends = [self.place(i * step) for i in range(self.links + 1)]
        self.pipe_nodes, before = [], None
        for link, (first, last) in enumerate(zip(ends, ends[1:])):
            chord = last - first
            angle = np.arctan2(-chord[2], chord[0])
            nodes = [
                self.node(first + chord * k / self.elements, angle, self.spin) for k in range(self.elements + 1)
            ]
            for pair in zip(nodes, nodes[1:]):
                self.beam(list(pair), np.linalg.norm(chord) / self.elements, section)
            if before is not None:
                cross = turned(about_x(0.5 * np.pi * (link - 1)))
                self.joint(self.rigid(before, cross), self.rigid(nodes[0], cross), [1, 1, 1, 1, 0, 0])
            # The end of the link above is the pipe's node of a joint station, as in flexdrill.
            self.pipe_nodes += nodes[1:] if link else nodes
            before = nodes[-1]

    def rigid(self, node, transformation=None):
        turn = {} if transformation is None else {"localHT": transformation}
        return self.mbs.AddMarker(MarkerNodeRigid(nodeNumber=node, **turn))

    def fixed(self, arc, turn=None):
        """A marker on the ground in the frame of the bore."""
        node = self.mbs.AddNode(NodePointGround(referenceCoordinates=list(self.place(arc))))
        frame = about_y(self.angle(arc))
        return self.rigid(node, turned(frame if turn is None else frame @ turn))

    def joint(self, first, second, axes):
        self.mbs.AddObject(ObjectJointGeneric(markerNumbers=[first, second], constrainedAxes=axes))

    def gap(self, inside, outside, radii, stiffness, friction):
        data = self.mbs.AddNode(NodeGenericData(initialCoordinates=[0.1, 0, 0, 0], numberOfDataCoordinates=4))
        self.contacts.append(
            self.mbs.AddObject(
                ObjectContactSphereSphere(
                    markerNumbers=[inside, outside],
                    nodeNumber=data,
                    spheresRadii=radii,
                    isHollowSphere1=True,
                    dynamicFriction=friction,
                    frictionProportionalZone=SLIP_SPEED,
                    contactStiffness=stiffness,
                    # Hunt-Crossley. flexdrill's c = 0.5 s/m gives e = 1 - 2/3 c v: 0.9 at an impact of 0.3 m/s.
                    impactModel=1,
                    restitutionCoefficient=0.9,
                    minimumImpactVelocity=0.1,
                )
            )
        )

    def gaps(self):
        step = self.length / self.stations
        for i, (pipe, guide) in enumerate(zip(self.pipe_nodes, self.guide_nodes)):
            self.gap(self.rigid(pipe), self.rigid(guide), [PIPE[0] / 2, GUIDE[1] / 2], *INNER)
            self.gap(self.rigid(guide), self.fixed(i * step), [GUIDE[0] / 2, HOLE / 2], *OUTER)

    def loads(self):
        weight = 1e3 * self.args.wob
        for node in [self.pipe_nodes[0], self.guide_nodes[0]]:
            self.joint(self.fixed(0), self.rigid(node), [1, 1, 1, 0, 0, 0])
        for node in [self.pipe_nodes[-1], self.guide_nodes[-1]]:
            self.joint(self.fixed(self.length), self.rigid(node), [0, 1, 1, 0, 0, 0])
        # A stiff speed control in place of flexdrill's prescribed angle: 92 N m change its speed by 1e-3 rad/s.
        self.mbs.AddObject(
            ObjectConnectorTorsionalSpringDamper(
                markerNumbers=[self.fixed(0, Z_TO_X), self.rigid(self.pipe_nodes[0], turned(Z_TO_X))],
                damping=1e5,
                velocityOffset=self.spin,
            )
        )
        up = -weight * about_y(self.angle(self.length))[:, 0]
        marker = self.mbs.AddMarker(MarkerNodePosition(nodeNumber=self.guide_nodes[-1]))
        self.mbs.AddLoad(LoadForceVector(markerNumber=marker, loadVector=list(up)))
        self.mbs.AddLoad(
            LoadTorqueVector(
                markerNumber=self.rigid(self.pipe_nodes[-1]), bodyFixed=True, loadVector=[-BIT * weight, 0, 0]
            )
        )

    def run(self, duration):
        """Advances by `duration` (s) and gives what it took."""
        settings = exu.SimulationSettings()
        start = self.time if hasattr(self, "time") else 0.0
        integration = settings.timeIntegration
        integration.startTime, integration.endTime = start, start + duration
        integration.numberOfSteps = max(1, round(duration / self.args.step))
        integration.generalizedAlpha.spectralRadius = self.args.spectral_radius
        integration.newton.useModifiedNewton = self.args.modified_newton
        integration.newton.relativeTolerance = self.args.tolerance
        integration.newton.absoluteTolerance = self.args.tolerance
        # Contacts switch inside a step, as in flexdrill; without this EXUDYN cuts steps to 1e-7 s to meet every touch.
        integration.discontinuous.useRecommendedStepSize = False
        integration.stepInformation = 0
        settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
        settings.linearSolver.reuseAnalyzedPattern = True
        settings.parallel.numberOfThreads = 1
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = 1e9
        settings.show.computationTime = self.args.verbose
        settings.show.statistics = self.args.verbose
        wall, cpu = time.perf_counter(), time.process_time()
        solver = exu.MainSolverImplicitSecondOrder()
        done = solver.SolveSystem(self.mbs, settings)
        wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
        if not done:
            raise SystemExit(f"EXUDYN: the run from {start} s did not converge")
        self.mbs.systemData.SetSystemState(
            self.mbs.systemData.GetSystemState(configuration=exu.ConfigurationType.Current),
            configuration=exu.ConfigurationType.Initial,
        )
        self.time = start + duration
        iterations = solver.it
        return {
            "model_time": duration,
            "wall": wall,
            "cpu": cpu,
            "steps": iterations.currentStepIndex,
            "newton": iterations.newtonStepsCount,
            "jacobians": iterations.newtonJacobiCount,
            "discontinuous": iterations.discontinuousIterationsCount,
            "rejected": iterations.rejectedModifiedNewtonSteps + iterations.rejectedAutomaticStepSizeSteps,
        }

    def touching(self):
        gaps = [self.mbs.GetObject(c)["nodeNumber"] for c in self.contacts]
        return sum(self.mbs.GetNodeOutput(n, exu.OutputVariableType.Coordinates)[0] < 0 for n in gaps)

    def bit_speed(self):
        velocity = self.mbs.GetNodeOutput(self.pipe_nodes[-1], exu.OutputVariableType.AngularVelocityLocal)
        return velocity[0] * 60 / (2 * np.pi)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--links", type=int, default=33)
    parser.add_argument("--elements", type=int, default=5, help="per link")
    parser.add_argument("--rpm", type=float, default=40.0)
    parser.add_argument("--wob", type=float, default=10.0, help="kN")
    parser.add_argument("--step", type=float, default=2.5e-4, help="s")
    parser.add_argument("--start-up", type=float, default=0.05, help="model time before the measured part (s)")
    parser.add_argument("--duration", type=float, default=0.2, help="model time of the measured part (s)")
    parser.add_argument("--tolerance", type=float, default=1e-6, help="of EXUDYN's Newton, relative and absolute")
    parser.add_argument("--spectral-radius", type=float, default=0.9, help="of generalised alpha")
    parser.add_argument("--modified-newton", type=int, default=1)
    parser.add_argument("--verbose", action="store_true")
    args = parser.parse_args()
    args.modified_newton = bool(args.modified_newton)
    tool = Tool(args)
    data = tool.mbs.systemData
    report = {
        "exudyn": exu.config.Version() if hasattr(exu.config, "Version") else str(exu.__version__),
        "step": args.step,
        "unknowns": [data.ODE2Size(), data.AEsize()],
        "contacts": len(tool.contacts),
        "start_up": tool.run(args.start_up),
        "measured": tool.run(args.duration),
        "touching": int(tool.touching()),
        "bit_rpm": float(tool.bit_speed()),
    }
    print(json.dumps(report))


if __name__ == "__main__":
    main()
