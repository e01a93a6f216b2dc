#!/usr/bin/env python3
"""Exudyn (1.8 and later) on the scenes of peers_table, in its columns: planar Bernoulli-Euler cables
(ANCFCable2D) and shear-deformable beams in space (ANCFBeam), both nonlinear.

Usage: exudyn_peer.py REFERENCES PENDULUM_CSV
REFERENCES is the folder that `peers_table --references` wrote, PENDULUM_CSV
tests/data/double_pendulum.csv. Prints the rows without their head.

x along, y up (railstep's z). A step includes one Python call, which moves the loads; that call alone
is timed beside it and told on stderr.
"""
import contextlib
import csv
import math
import sys
import time

import numpy as np

sys.exudynFast = True  # its module without range checks
with contextlib.redirect_stdout(sys.stderr):  # the import says which module it took
    import exudyn as exu
    from exudyn.utilities import *  # items and GenerateStraightLineANCFCable2D

STEP = 1e-3  # s
BAY, SPEED, FORCE = 0.6, 30.0, -50e3  # m, m/s, N
START_UP, COMPARED = 50, 300  # steps, as in moving_load.h
ROUNDS = 5


class Section:
    """A rectangle, sizes in m, with its material in SI."""

    def __init__(self, height, width, young, density, shear_factor):
        self.area = height * width
        self.inertia_z = width * height**3 / 12  # m4, of bending up and down
        self.inertia_y = height * width**3 / 12
        self.young, self.density, self.shear_factor = young, density, shear_factor
        self.shear = young / (2 * 1.3)
        self.torsion = height * width**3 / 3 * (1 - 0.63 * width / height)

    def cable(self):
        return Cable2D(
            physicsMassPerLength=self.density * self.area,
            physicsBendingStiffness=self.young * self.inertia_z,
            physicsAxialStiffness=self.young * self.area,
        )

    def beam(self):
        section = exu.BeamSection()
        shear = self.shear * self.area * self.shear_factor
        section.stiffnessMatrix = np.diag(
            [
                self.young * self.area,
                shear,
                shear,
                self.shear * self.torsion,
                self.young * self.inertia_y,
                self.young * self.inertia_z,
            ]
        )
        section.inertia = self.density * np.diag(
            [self.inertia_y + self.inertia_z, self.inertia_y, self.inertia_z]
        )
        section.massPerLength = self.density * self.area
        return section


RAIL = Section(0.2319, 0.0375, 210e9, 7850.0, 0.8497)
LINK = Section(0.02, 0.03, 210e6, 7900.0, 1.0)


class Line:
    """A straight row of elements: their numbers, those of their nodes, and where x = 0 lies in one."""

    def __init__(self, mbs, kind, section, start, length, elements, gravity=0.0):
        self.length = length / elements
        if kind == "cable":
            made = GenerateStraightLineANCFCable2D(
                mbs=mbs,
                positionOfNode0=start,
                positionOfNode1=[start[0] + length, start[1], start[2]],
                numberOfElements=elements,
                cableTemplate=section.cable(),
                massProportionalLoad=[0, -gravity, 0],
            )
            self.nodes, self.objects, self.first = made[0], made[1], 0.0
            self.positions, self.coordinates, self.loads_on_nodes = 2, 4, False
            return
        self.first = -self.length / 2  # a beam's local x runs from -L/2 to L/2
        # A load on the body of an ANCFBeam writes past the end of Exudyn's matrix (1.11.0: 18 columns
        # into 8). Its axis is linear between its nodes, so forces on them are the very same load.
        self.loads_on_nodes = True
        self.positions, self.coordinates = 3, 9
        self.nodes, self.objects = [], []
        for i in range(elements + 1):
            at = [start[0] + i * self.length, start[1], start[2]]
            self.nodes.append(
                mbs.AddNode(NodePointSlope23(referenceCoordinates=at + [0, 1, 0] + [0, 0, 1]))
            )
        for i in range(elements):
            beam = ObjectANCFBeam(
                nodeNumbers=self.nodes[i : i + 2],
                physicsLength=self.length,
                sectionData=section.beam(),
            )
            self.objects.append(mbs.AddObject(beam))
        if gravity != 0:
            weight = gravity * section.density * section.area * self.length
            for i, node in enumerate(self.nodes):
                share = 0.5 if i in (0, elements) else 1.0
                marker = mbs.AddMarker(MarkerNodePosition(nodeNumber=node))
                mbs.AddLoad(Force(markerNumber=marker, loadVector=[0, -share * weight, 0]))

    def add_loads(self, mbs):
        """Markers and loads for a force that moves: one pair a node or an element."""
        if self.loads_on_nodes:
            markers = [mbs.AddMarker(MarkerNodePosition(nodeNumber=node)) for node in self.nodes]
        else:
            at = [self.first, 0, 0]
            markers = [
                mbs.AddMarker(MarkerBodyPosition(bodyNumber=element, localPosition=at))
                for element in self.objects
            ]
        self.markers = markers
        self.loads = [
            mbs.AddLoad(Force(markerNumber=marker, loadVector=[0, 0, 0])) for marker in markers
        ]

    def move_load(self, mbs, last, element, x, force):
        """Moves the force up from element `last` to local x of `element`."""
        if last != element:
            mbs.SetLoadParameter(self.loads[last], "loadVector", [0, 0, 0])
        if self.loads_on_nodes:
            part = (x - self.first) / self.length
            mbs.SetLoadParameter(self.loads[element], "loadVector", [0, (1 - part) * force, 0])
            mbs.SetLoadParameter(self.loads[element + 1], "loadVector", [0, part * force, 0])
        else:
            mbs.SetMarkerParameter(self.markers[element], "localPosition", [x, 0, 0])
            mbs.SetLoadParameter(self.loads[element], "loadVector", [0, force, 0])

    def coordinate(self, mbs, node, i):
        return mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=self.nodes[node], coordinate=i))


def settings(steps, spectral_radius, tolerance, starts_from_accelerations=False):
    """@param tolerance of Newton, relative to a step's first residual: the loosest that leaves the error's
    first two digits; 1e-7 and tighter lies below the rounding of the moving load's forces"""
    s = exu.SimulationSettings()
    s.timeIntegration.numberOfSteps = steps
    s.timeIntegration.endTime = steps * STEP
    s.timeIntegration.adaptiveStep = False
    s.timeIntegration.generalizedAlpha.spectralRadius = spectral_radius
    s.timeIntegration.generalizedAlpha.computeInitialAccelerations = starts_from_accelerations
    s.timeIntegration.newton.useModifiedNewton = True
    s.timeIntegration.newton.relativeTolerance = tolerance
    s.timeIntegration.verboseMode = 0
    s.solutionSettings.writeSolutionToFile = False
    s.solutionSettings.sensorsWritePeriod = steps * STEP
    s.linearSolverType = exu.LinearSolverType.EigenSparse
    s.parallel.numberOfThreads = 1
    return s


class MovingLoad:
    """Two rails on springs at every bay border, 50 kN moving on each."""

    def __init__(self, kind, bays):
        self.container = exu.SystemContainer()  # owns the system, so it is kept
        self.mbs = mbs = self.container.AddSystem()
        node = mbs.AddNode(NodePointGround(referenceCoordinates=[0, 0, 0]))
        ground = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
        self.steps = round((bays - 1) * BAY / (SPEED * STEP))
        self.rails = [Line(mbs, kind, RAIL, [0, 0, 1.5 * i], bays * BAY, bays) for i in (0, 1)]
        for rail in self.rails:
            for border in range(bays + 1):
                for i, stiffness in zip(range(rail.positions), (3e6, 3e7, 3e7)):
                    marker = rail.coordinate(mbs, border, i)
                    mbs.AddObject(
                        CoordinateSpringDamper(
                            markerNumbers=[ground, marker], stiffness=stiffness, damping=3e4
                        )
                    )
            rail.add_loads(mbs)
        mbs.Assemble()

    def place(self, step):
        """Element and local x of the loads at the end of a step."""
        rail = self.rails[0]
        x = 0.5 * BAY + SPEED * STEP * step
        element = min(int(x / rail.length), len(rail.objects) - 1)
        return element, rail.first + x - element * rail.length

    def deflection(self, step):
        element, x = self.place(step)
        out = exu.OutputVariableType.Displacement
        body = self.rails[0].objects[element]
        return self.mbs.GetObjectOutputBody(body, out, [x, 0, 0])[1]

    def move(self, step):
        """Puts the loads where they stand at the end of a step."""
        last = self.place(step - 1)[0]
        element, x = self.place(step)
        for rail in self.rails:
            rail.move_load(self.mbs, last, element, x, FORCE)

    def run(self, seen=None):
        """Steps the whole passage; `seen` takes the deflection at every step's end.
        @returns us of a step, and of those the Python call's"""
        done, spent = 0, 0.0

        def before_step(mbs, t):
            nonlocal done, spent
            begin = time.process_time()
            if seen is not None and done > 0:
                seen.append(self.deflection(done))
            done += 1
            self.move(done)
            spent += time.process_time() - begin
            return True

        self.mbs.SetPreStepUserFunction(before_step)
        begin = time.process_time()
        self.mbs.SolveDynamic(settings(self.steps, 0.6, 1e-2))
        took = time.process_time() - begin
        if seen is not None:
            seen.append(self.deflection(done))
        return 1e6 * took / self.steps, 1e6 * spent / self.steps

    def unknowns(self):
        return sum(rail.coordinates * len(rail.nodes) for rail in self.rails)


class DoublePendulum:
    """Two links of 0.40 m let go from rest along +x."""

    def __init__(self, kind, elements):
        self.container = exu.SystemContainer()  # owns the system, so it is kept
        self.mbs = mbs = self.container.AddSystem()
        node = mbs.AddNode(NodePointGround(referenceCoordinates=[0, 0, 0]))
        ground = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
        upper, lower = (
            Line(mbs, kind, LINK, [start, 0, 0], 0.4, elements, 9.81) for start in (0.0, 0.4)
        )
        for i in range(upper.positions):
            for pair in (
                [ground, upper.coordinate(mbs, 0, i)],
                [upper.coordinate(mbs, -1, i), lower.coordinate(mbs, 0, i)],
            ):
                mbs.AddObject(CoordinateConstraint(markerNumbers=pair))
        self.end, self.lines = lower.nodes[-1], (upper, lower)
        # The mass of an ANCFBeam's slopes is singular, so its accelerations at the start are zero.
        self.starts_from_accelerations = kind == "cable"
        mbs.Assemble()

    def run(self, seen=None):
        """Steps 1 s; `seen` takes x and y of C every 50 ms. @returns us of a step"""
        done = 0
        position = exu.OutputVariableType.Position

        def before_step(mbs, t):
            nonlocal done
            if seen is not None and done % 50 == 0:
                seen.append(mbs.GetNodeOutput(self.end, position)[0:2])
            done += 1
            return True

        if seen is not None:  # no call of Python in a run that is timed
            self.mbs.SetPreStepUserFunction(before_step)
        begin = time.process_time()
        self.mbs.SolveDynamic(settings(1000, 0.9, 1e-4, self.starts_from_accelerations))
        took = time.process_time() - begin
        if seen is not None:
            seen.append(self.mbs.GetNodeOutput(self.end, position)[0:2])
        return 1e6 * took / 1000, 0.0

    def unknowns(self):
        return sum(line.coordinates * len(line.nodes) for line in self.lines)


def read(path):
    """Rows of numbers below a title; remarks begin with #. A remark `own_error=...` is told."""
    own_error, rows = math.nan, []
    with open(path, newline="") as file:
        for row in csv.reader(file):
            if row[0].startswith("# own_error="):
                own_error = float(row[0].split("=")[1])
            elif not row[0].startswith("#") and not row[0][0].isalpha():
                rows.append([float(x) for x in row])
    return own_error, rows


def timed(make):
    """Medians of us a step and of the Python call's part, and the times' quartiles."""
    runs = [make().run() for _ in range(ROUNDS)]
    us = sorted(run[0] for run in runs)
    low, middle, high = np.percentile(us, [25, 50, 75])
    return middle, low, high, float(np.median([run[1] for run in runs]))


def print_row(peer, scene, elements, error, reference_error, unknowns, make, from_start=""):
    us, low, high, python = timed(make)
    print(
        f"{peer},{scene},{elements},{STEP:g},{us:.3g},{error:.2e},{reference_error:.1e},"
        f"{low:.3g},{high:.3g},{unknowns},,{from_start}",
        flush=True,
    )
    print(f"{peer}, {scene}, {elements}: {python:.1f} us a step in Python", file=sys.stderr)


def moving_load(folder, kind, name):
    for bays in (4, 16, 64, 256):
        own_error, rows = read(f"{folder}/moving_load_{bays}.csv")
        want = np.array(rows)[:, 1]
        model, seen = MovingLoad(kind, bays), []
        model.run(seen)
        gap = np.abs(np.array(seen[: len(want)]) - want)
        after = slice(START_UP, None)
        print_row(
            f"Exudyn {name}",
            "moving_load",
            bays,
            gap[after].max() / np.abs(want[after]).max(),
            own_error,
            model.unknowns(),
            lambda: MovingLoad(kind, bays),
            f"{gap.max() / np.abs(want).max():.2e}",
        )


def double_pendulum(path, kind, name):
    want = np.array(read(path)[1])[:, 3:5]
    model, seen = DoublePendulum(kind, 4), []
    model.run(seen)
    error = np.linalg.norm(np.array(seen) - want, axis=1).max()
    print_row(
        f"Exudyn {name}",
        "double_pendulum",
        4,
        error,
        1e-7,
        model.unknowns(),
        lambda: DoublePendulum(kind, 4),
    )


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: exudyn_peer.py REFERENCES PENDULUM_CSV")
    for kind, name in (("cable", "planar cable"), ("beam", "beam in space")):
        moving_load(sys.argv[1], kind, name)
        double_pendulum(sys.argv[2], kind, name)


if __name__ == "__main__":
    main()
