"""`marey moments` against OpenSim's InverseDynamicsSolver, with the same coordinates, speeds and accelerations; and external loads that OpenSim's
inverse dynamics reads.

    moments_test.py PROGRAM      PROGRAM is marey; exits 77 (skipped) where OpenSim or its models are not here
"""
import os
import pathlib
import subprocess
import sys
import tempfile

try:
    import numpy as np
    import opensim
except ImportError as missing:
    print(f"skipped: {missing}; script/setup installs it")
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DATA = pathlib.Path(os.environ.get("MAREY_DATA", ROOT / "../shared/data"))
MODELS = {
    "gait2354": DATA / "opensim_models/gait2354/reference/subject01_simbody.osim",
    "Arnold 01": DATA / "arnold_synthetic/subject01/scaled.osim",
    "Arnold 02": DATA / "arnold_synthetic/subject02/scaled.osim",
    "Arnold 04": DATA / "arnold_synthetic/subject04/scaled.osim",
}
SEED, FRAMES, RATE = 38, 20, 100
LIMIT = 1e-6  # of each joint's largest moment


def table(path, columns, times, rows, degrees=False):
    lines = ["made", "version=1", f"nRows={len(times)}", f"nColumns={len(columns) + 1}", f"inDegrees={'yes' if degrees else 'no'}", "endheader"]
    lines.append("\t".join(["time", *columns]))
    lines += ["\t".join(f"{value:.17g}" for value in [time, *row]) for time, row in zip(times, rows)]
    path.write_text("\n".join(lines) + "\n")


def read(path):
    lines = path.read_text().splitlines()
    head = lines.index("endheader")
    columns = lines[head + 1].split("\t")
    values = np.array([[float(cell) for cell in line.split("\t")] for line in lines[head + 2 :]])
    return {name: values[:, i] for i, name in enumerate(columns)}


def smooth(random, times, scale):
    """A few sines: values, first and second derivatives."""
    value, speed, acceleration = np.zeros((3, len(times)))
    for _ in range(3):
        amplitude, frequency, phase = random.normal(0, scale), random.uniform(3, 15), random.uniform(0, 6)
        value += amplitude * np.sin(frequency * times + phase)
        speed += amplitude * frequency * np.cos(frequency * times + phase)
        acceleration -= amplitude * frequency**2 * np.sin(frequency * times + phase)
    return value, speed, acceleration


def speed_index(model, state, coordinate):
    """Which of the state's speeds is the coordinate's."""
    before = [state.getU().get(i) for i in range(state.getNU())]
    coordinate.setSpeedValue(state, 1.25)
    after = [state.getU().get(i) for i in range(state.getNU())]
    coordinate.setSpeedValue(state, 0)
    return next(i for i in range(len(before)) if before[i] != after[i])


def bare_model(path):
    """Without muscles and other forces; constraints off, for the solver does not satisfy them."""
    model = opensim.Model(str(path))
    model.updForceSet().clearAndDestroy()
    model.updConstraintSet().clearAndDestroy()
    for coordinate in model.updCoordinateSet():
        coordinate.set_locked(False)
        coordinate.set_clamped(False)
    return model


def expect_centre_of_mass(program, folder, path):
    """Where a coordinate turns about several axes (Arnold's knee) OpenSim's term of the squared speed is 0.1 % off the second difference of its own
    centre of mass, which the forces on the root must be: ours are compared with that."""
    model = bare_model(path)
    state = model.initSystem()
    names = [coordinate.getName() for coordinate in model.getCoordinateSet()]
    coordinates, knees, at, step = model.getCoordinateSet(), ("knee_angle_r", "knee_angle_r_beta"), 1.15, 1e-3
    values = {n: coordinates.get(n).getDefaultValue() for n in names}
    values["knee_angle_l_beta"] = values["knee_angle_l"]

    def centre(angle):
        for n in names:
            coordinates.get(n).setValue(state, angle if n in knees else values[n], False)
        model.realizePosition(state)
        found = model.calcMassCenterPosition(state)
        return np.array([found.get(i) for i in range(3)])

    def forces(speed):
        row = [x for n in names for x in ((at if n in knees else values[n]), speed if n in knees else 0, 0)]
        times = np.arange(5) / RATE
        table(folder / "knee.sto", [n + end for n in names for end in ("", "/speed", "/acceleration")], times, [row] * 5)
        subprocess.run([program, "moments", str(path), str(folder / "knee.sto"), "-o", str(folder / "knee_forces.sto"), "-q"], check=True, capture_output=True)
        found = read(folder / "knee_forces.sto")
        return np.array([found[f"pelvis_t{axis}_force"][2] for axis in "xyz"])

    second = (-centre(at + 2 * step) + 16 * centre(at + step) - 30 * centre(at) + 16 * centre(at - step) - centre(at - 2 * step)) / (12 * step**2)
    expected, found = model.getTotalMass(state) * 9 * second, forces(3) - forces(0)
    apart = np.abs(found - expected).max() / np.abs(expected).max()
    print(f"{path.parent.name}, a knee that turns at 3 rad/s: the root's forces {apart:.2g} of the largest from the centre of mass's")
    assert apart < LIMIT


def expect_solver(program, folder, name, path):
    random = np.random.default_rng(SEED)
    model = bare_model(path)
    names = [coordinate.getName() for coordinate in model.getCoordinateSet()]
    times = np.arange(FRAMES) / RATE
    motion = {}
    for coordinate in model.getCoordinateSet():
        rotational = coordinate.getMotionType() == opensim.Coordinate.Rotational
        # Knees stay within their splines: beyond an end, where the line is straight, OpenSim's second derivative is the end's and not 0.
        middle = 0.5 * (coordinate.getRangeMin() + coordinate.getRangeMax()) if coordinate.getName().startswith("knee_angle") else 0
        value, speed, acceleration = smooth(random, times, 0.15 if rotational else 0.05)
        # Arnold's turn about three axes at once: see expect_centre_of_mass.
        motion[coordinate.getName()] = (middle + value, 0 * speed if middle and name.startswith("Arnold") else speed, acceleration)
    couple(model, path, motion)
    body = {side: model.getBodySet().get(f"calcn_{side}") for side in "lr"}
    # Made loads on both feet: a force somewhere near the foot, and a moment.
    loads = {side: np.column_stack([random.normal(0, 80, (FRAMES, 2)), random.normal(0, 0.3, (FRAMES, 3)), random.normal(0, 20, (FRAMES, 3)), random.normal(700, 100, FRAMES)]) for side in "lr"}
    columns, rows = [], [[] for _ in times]
    for side in "lr":
        columns += [f"ground_force_{side}_v{axis}" for axis in "xyz"] + [f"ground_force_{side}_p{axis}" for axis in "xyz"] + [f"ground_torque_{side}_{axis}" for axis in "xyz"]
        for row, load in zip(rows, loads[side]):
            row += [load[0], load[8], load[1], *load[2:5], *load[5:8]]
    table(folder / "loads.mot", columns, times, rows)
    forces = "".join(
        f"<ExternalForce name='{side}'><applied_to_body>calcn_{side}</applied_to_body><force_expressed_in_body>ground</force_expressed_in_body>"
        f"<point_expressed_in_body>ground</point_expressed_in_body><force_identifier>ground_force_{side}_v</force_identifier>"
        f"<point_identifier>ground_force_{side}_p</point_identifier><torque_identifier>ground_torque_{side}_</torque_identifier></ExternalForce>"
        for side in "lr"
    )
    (folder / "loads.xml").write_text(f"<OpenSimDocument Version='40000'><ExternalLoads name='made'><objects>{forces}</objects><datafile>loads.mot</datafile></ExternalLoads></OpenSimDocument>")
    table(folder / "motion.sto", [n + end for n in names for end in ("", "/speed", "/acceleration")], times, np.column_stack([np.array(motion[n]).T for n in names]))
    done = subprocess.run([program, "moments", str(path), str(folder / "motion.sto"), "--loads", str(folder / "loads.xml"), "-o", str(folder / "ours.sto"), "-q"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    ours = read(folder / "ours.sto")

    state = model.initSystem()
    state.updQ()
    solver = opensim.InverseDynamicsSolver(model)
    index = {n: speed_index(model, state, model.getCoordinateSet().get(n)) for n in names}
    theirs = {n: np.zeros(FRAMES) for n in names}
    bodies = model.getBodySet().getSize() + 1  # and ground
    for frame in range(FRAMES):
        state.setTime(times[frame])
        for n in names:
            model.getCoordinateSet().get(n).setValue(state, motion[n][0][frame], False)
            model.getCoordinateSet().get(n).setSpeedValue(state, motion[n][1][frame])
        model.realizeDynamics(state)
        change = opensim.Vector(state.getNU(), 0.0)
        for n in names:
            change.set(index[n], motion[n][2][frame])
        nothing = opensim.SpatialVec(opensim.Vec3(0), opensim.Vec3(0))
        on_bodies, without = (opensim.VectorOfSpatialVec(bodies, nothing) for _ in range(2))
        for side in "lr":
            load = loads[side][frame]
            force, point, moment = np.array([load[0], load[8], load[1]]), load[2:5], load[5:8]
            origin = body[side].getPositionInGround(state)
            arm = point - np.array([origin.get(i) for i in range(3)])
            total = moment + np.cross(arm, force)
            number = int(body[side].getMobilizedBodyIndex())
            on_bodies.set(number, opensim.SpatialVec(opensim.Vec3(*total), opensim.Vec3(*force)))
        # With the model's own forces, which is gravity, and what the loads add.
        none = opensim.Vector(state.getNU(), 0.0)
        own, with_loads, without_loads = solver.solve(state, change), solver.solve(state, change, none, on_bodies), solver.solve(state, change, none, without)
        for n in names:
            theirs[n][frame] = own.get(index[n]) + with_loads.get(index[n]) - without_loads.get(index[n])
    report(name, names, ours, theirs)


def couple(model, path, motion):
    """Coordinates that couplers drive have the coupler's values: by differences of its function, exact enough for its spline's pieces is its own derivative."""
    whole = opensim.Model(str(path))
    for constraint in whole.getConstraintSet():
        coupler = opensim.CoordinateCouplerConstraint.safeDownCast(constraint)
        if coupler is None or not coupler.get_isEnforced():
            continue
        function, scale = coupler.getFunction(), opensim.PropertyHelper.getValueDouble(coupler.getPropertyByName("scale_factor"))
        q, speed, acceleration = motion[coupler.getIndependentCoordinateNames().get(0)]
        first, second = opensim.StdVectorInt(), opensim.StdVectorInt()
        first.push_back(0)
        second.push_back(0)
        second.push_back(0)
        at = [opensim.Vector(1, float(value)) for value in q]
        value = scale * np.array([function.calcValue(x) for x in at])
        slope = scale * np.array([function.calcDerivative(first, x) for x in at])
        bend = scale * np.array([function.calcDerivative(second, x) for x in at])
        motion[coupler.getDependentCoordinateName()] = (value, slope * speed, slope * acceleration + bend * speed**2)


def expect_external_loads(program, folder):
    """OpenSim's tool reads the external loads of `marey gait`; a model that does not move needs the same moments under them."""
    walk, model = DATA / "gait_children/HC038A/straight_HC038A11.c3d", MODELS["gait2354"]
    if not (walk.exists() and model.exists()):
        return
    subprocess.run([program, "gait", str(walk), "--forces", str(folder / "grf.mot"), "-q"], check=True, capture_output=True)
    loads = read(folder / "grf.mot")
    times = loads["time"][::10]
    bare = bare_model(model)
    bare.printToXML(str(folder / "bare.osim"))
    state = bare.initSystem()
    names = [coordinate.getName() for coordinate in bare.getCoordinateSet()]
    rest = [coordinate.getDefaultValue() for coordinate in bare.getCoordinateSet()]
    table(folder / "still.mot", names, times, [rest] * len(times))
    tool = opensim.InverseDynamicsTool()
    tool.setModelFileName(str(folder / "bare.osim"))
    tool.setCoordinatesFileName(str(folder / "still.mot"))
    tool.setExternalLoadsFileName(str(folder / "grf.xml"))
    tool.setStartTime(times[5])
    tool.setEndTime(times[-6])
    tool.setResultsDir(str(folder))
    tool.setOutputGenForceFileName("theirs.sto")
    assert tool.run()
    subprocess.run([program, "moments", str(folder / "bare.osim"), str(folder / "still.mot"), "--loads", str(folder / "grf.xml"), "-o", str(folder / "ours.sto"), "-q"], check=True, capture_output=True)
    theirs, ours = read(folder / "theirs.sto"), read(folder / "ours.sto")
    worst = 0
    for name in ours:
        if name == "time":
            continue
        mine = np.interp(theirs["time"], ours["time"], ours[name])
        worst = max(worst, np.abs(mine - theirs[name]).max() / max(1, np.abs(theirs[name]).max()))
    largest = max(loads[f"ground_force_{side}_vy"].max() for side in "lr")
    print(f"OpenSim's tool under the loads of {walk.name} (largest {largest:.0f} N): {worst:.2g} of the largest moment apart")
    assert largest > 500 and worst < 1e-4


def report(name, names, ours, theirs):
    worst, where = 0, ""
    for n in names:
        mine = ours.get(n + "_moment", ours.get(n + "_force"))
        largest = np.abs(theirs[n]).max()
        apart = np.abs(mine - theirs[n]).max() / max(largest, 1e-3)
        if apart > worst:
            worst, where = apart, f"{n}, largest {largest:.3g}"
    print(f"{name}: {len(names)} coordinates, {FRAMES} frames, seed {SEED}: worst {worst:.2g} of the largest moment ({where})")
    assert worst < LIMIT, name


def main():
    there = {name: path for name, path in MODELS.items() if path.exists()}
    if not there:
        print(f"skipped: {DATA} has no models")
        sys.exit(77)
    for name, path in there.items():
        with tempfile.TemporaryDirectory() as folder:
            expect_solver(sys.argv[1], pathlib.Path(folder), name, path)
            if name.startswith("Arnold"):
                expect_centre_of_mass(sys.argv[1], pathlib.Path(folder), path)
    with tempfile.TemporaryDirectory() as folder:
        expect_external_loads(sys.argv[1], pathlib.Path(folder))


main()
