#!/usr/bin/env python3
"""A generic OpenSim model fitted to a subject by `marey solve --calibrate`, and used for the subject's other takes.

Usage: calibrated_skeletons.py MAREY DATA [--subjects 4] [--seed 1] [--only experts,children,simulated] [--without-static]

DATA is the folder that tests call MAREY_DATA; needs numpy and OpenSim (PyPI). A subject's static trial and one walk calibrate the model (--static-trial; with
--without-static the walk alone), which is written as .osim and solves the other takes. Prints Markdown tables: marker RMS of the takes, mm, and the others' in
relation to the calibrated one's; RMSE of hips', knees' and ankles' sagittal angles, degrees.

experts: OpenSim's gait2354 (walking) and Hamner (running), from the generic model; against the results that their authors had with models scaled by hand.
children: gait_children; the generic model of arnold_synthetic with Plug-in Gait's labels in the places of its own, without wrists. Without a truth for the angles.
simulated: subjects of other proportions, by OpenSim: the generic model of arnold_synthetic, in size by 8 %, its segments by 5 % an axis, left and right alike;
markers beside their places by 8 mm an axis on landmarks, 25 mm in clusters, left and right alike but for 3 mm; each moves on its segment with the stride by 5 and
10 mm (standard deviations, all), and has 1 mm of noise. The static trial's hips, knees and ankles are bent by 3 degrees. The walks are those of its three men.
"""
import argparse
import json
import pathlib
import re
import subprocess
import tempfile

import numpy as np
import opensim

opensim.Logger.setLevelString("Error")
SAGITTAL = [f"{joint}_{side}" for joint in ("hip_flexion", "knee_angle", "ankle_angle") for side in "rl"]
CENTRES = [side + joint for side in "RL" for joint in ("HJC", "KJC", "AJC", "SJC", "EJC")]  # joints that no camera sees
CLUSTERS = re.compile(r"[RL](TH|TB|UA|FA)")
WRISTS = [side + wrist for side in "LR" for wrist in ("WRA", "WRB")]  # exchanged in some files of the children, bench/labels.py
PLUG_IN_GAIT = {"CAL": "HEE", "LMAL": "ANK", "LFC": "KNE", "TH1": "THI", "TB1": "TIB", "ACR": "SHO", "LEL": "ELB", "FAradius": "WRA", "FAulna": "WRB"}


def table(path):
    """A .sto or .mot file: its columns by name, in degrees where it says so."""
    head, body = path.read_text().split("endheader\n")
    lines = body.strip().split("\n")
    rows = np.array([[float(value) for value in line.split()] for line in lines[1:]])
    return dict(zip(lines[0].split(), rows.T, strict=True))


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def solve(marey, recording, skeleton, out, *more):
    words = [marey, "solve", recording, "--skeleton", skeleton, "-o", out, "--json", *more]
    return json.loads(subprocess.run(list(map(str, words)), check=True, capture_output=True, text=True).stdout)


def sagittal_error(found, truth):
    """Of all six angles together, at the truth's instants within the recording."""
    inside = (truth["time"] >= found["time"][0] - 1e-6) & (truth["time"] <= found["time"][-1] + 1e-6)
    return rms([np.interp(truth["time"][inside], found["time"], found[name]) - truth[name][inside] for name in SAGITTAL])


def calibrate(options, walk, static, model, work, *more):
    """The summary of the calibrated take, and its angles; work/person.osim is the subject's model."""
    with_static = [] if options.without_static else ["--static-trial", static]
    found = solve(options.marey, walk, model, work / "walk.mot", "--calibrate", *with_static, "--write-skeleton", work / "person.osim", *more)
    return found, table(work / "walk.mot")


def experts(options, work):
    data = options.data / "opensim_models"
    model = opensim.Model(str(data / "gait2354/gait2354_simbody.osim"))
    model.updateMarkerSet(opensim.MarkerSet(str(data / "gait2354/gait2354_Scale_MarkerSet.xml")))
    model.finalizeConnections()
    model.printToXML(str(work / "gait2354.osim"))
    print("| expert's | marker RMS, mm | hips, knees, ankles: RMSE, degrees | each |\n| --- | --- | --- | --- |")
    for name, walk, static, generic, result in (
        ("gait2354, walking", "gait2354/subject01_walk1.trc", "gait2354/subject01_static.trc", work / "gait2354.osim", "gait2354/reference/subject01_walk1_ik.mot"),
        ("Hamner, running", "hamner/subject02_running.trc", "hamner/subject02_static.trc", data / "hamner/FullBodyModel_Hamner2010_v2_0.osim", "hamner/reference/subject02_running_ik.mot"),
    ):
        found, angles = calibrate(options, data / walk, data / static, generic, work)
        truth = table(data / result)
        inside = (truth["time"] >= angles["time"][0] - 1e-6) & (truth["time"] <= angles["time"][-1] + 1e-6)
        off = {joint: [np.interp(truth["time"][inside], angles["time"], angles[f"{joint}_{side}"]) - truth[f"{joint}_{side}"][inside] for side in "rl"]
               for joint in ("hip_flexion", "knee_angle", "ankle_angle")}
        each = ", ".join(f"{rms(values):.1f} ({np.mean(values):+.1f})" for values in off.values())
        print(f"| {name} | {found['rms_mm']:.1f} | {sagittal_error(angles, truth):.1f} | {each} |", flush=True)


def children(options, work):
    text = (options.data / "arnold_synthetic/unscaled_generic.osim").read_text()
    for own, theirs in PLUG_IN_GAIT.items():
        text = re.sub(rf'(<Marker name="[RL]){own}"', rf'\1{theirs}"', text)
    (work / "plug_in_gait.osim").write_text(text)
    exclude = [word for label in [*CENTRES, *WRISTS] for word in ("--exclude", label)]
    print("\n| child | calibrated walk, mm | turn, mm | ratio |\n| --- | --- | --- | --- |")
    ratios = []
    for folder in sorted((options.data / "gait_children").glob("HC*")):
        walk, turn, static = (next(folder.glob(f"{kind}_*.c3d")) for kind in ("straight", "turn", "static"))
        found, _ = calibrate(options, walk, static, work / "plug_in_gait.osim", work, *exclude)
        other = solve(options.marey, turn, work / "person.osim", work / "turn.mot", *exclude)
        ratios.append(other["rms_mm"] / found["rms_mm"])
        print(f"| {folder.name} | {found['rms_mm']:.1f} | {other['rms_mm']:.1f} | {ratios[-1]:.2f} |", flush=True)
    print(f"| mean | | | {np.mean(ratios):.2f} |")


class Subject:
    """Of other proportions than the generic model."""

    def __init__(self, generic, chance):
        self.model = opensim.Model(str(generic))
        sizes, scales = {}, opensim.ScaleSet()
        size = 1 + 0.08 * chance.normal()
        for body in self.model.getBodySet():
            bones = body.getName().removesuffix("_r").removesuffix("_l")
            if bones == "patella":
                bones = "femur"
            if bones not in sizes:
                sizes[bones] = size * (1 + 0.05 * chance.normal(size=3))
            scale = opensim.Scale()
            scale.setSegmentName(body.getName())
            scale.setScaleFactors(opensim.Vec3(*sizes[bones]))
            scale.setApply(True)
            scales.cloneAndAppend(scale)
        state = self.model.initSystem()
        self.model.scale(state, scales, False)
        self.drift, offsets = {}, {}
        for marker in self.model.getMarkerSet():
            name = marker.getName()
            if name in CENTRES:
                continue
            twin, loose = name[1:] if name[0] in "RL" else name, CLUSTERS.match(name) is not None
            if twin not in offsets:
                offsets[twin] = (0.025 if loose else 0.008) * chance.normal(size=3)
            offset = offsets[twin] + 0.003 * chance.normal(size=3)
            if name[0] == "L":
                offset = offset * (1, 1, -1)
            place = marker.get_location()
            marker.set_location(opensim.Vec3(*(place.get(axis) + offset[axis] for axis in range(3))))
            self.drift[name] = ((0.010 if loose else 0.005) * chance.normal(size=3), chance.uniform(0, 2 * np.pi))
        self.model.finalizeConnections()
        self.state = self.model.initSystem()

    def record(self, path, times, angles, chance):
        """angles: of each coordinate a column, rad or m."""
        coordinates = [coordinate for coordinate in self.model.getCoordinateSet() if coordinate.getName() in angles]
        bodies = {marker.getName(): (marker, marker.getParentFrame()) for marker in self.model.getMarkerSet() if marker.getName() in self.drift}
        lines = [f"PathFileType\t4\t(X/Y/Z)\t{path.name}", "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames"]
        rate = round(1 / (times[1] - times[0]))
        lines.append(f"{rate}\t{rate}\t{len(times)}\t{len(bodies)}\tm\t{rate}\t1\t{len(times)}")
        lines.append("Frame#\tTime\t" + "".join(f"{name}\t\t\t" for name in bodies))
        lines.append("\t\t" + "".join(f"X{k}\tY{k}\tZ{k}\t" for k in range(1, len(bodies) + 1)) + "\n")
        for frame, time in enumerate(times):
            for coordinate in coordinates:
                coordinate.setValue(self.state, float(angles[coordinate.getName()][frame]), False)
            self.model.assemble(self.state)
            self.model.realizePosition(self.state)
            cells = []
            for name, (marker, parent) in bodies.items():
                amount, phase = self.drift[name]
                moved = amount * np.sqrt(2) * np.sin(2 * np.pi * time / 1.1 + phase)
                place = marker.get_location()
                local = opensim.Vec3(*(place.get(axis) + moved[axis] for axis in range(3)))
                there = parent.findStationLocationInGround(self.state, local)
                cells += [f"{there.get(axis) + 0.001 * chance.normal():.6f}" for axis in range(3)]
            lines.append(f"{frame + 1}\t{time:.5f}\t" + "\t".join(cells))
        path.write_text("\n".join(lines) + "\n")


def simulated(options, work):
    data = options.data / "arnold_synthetic"
    walks = {}
    for folder in sorted(data.glob("subject*")):
        walks[folder.name] = {name: column[::4] for name, column in table(folder / "coordinates.sto").items()}
    first, *others = walks
    print("\n| subject | calibrated walk, mm | others, mm | ratio | sagittal RMSE: calibrated, others | mean error: hips, knees, ankles |\n| --- | --- | --- | --- | --- | --- |")
    ratios, errors = [], []
    for number in range(options.subjects):
        chance = np.random.default_rng([options.seed, number])
        subject = Subject(data / "unscaled_generic.osim", chance)
        for name, walk in walks.items():
            subject.record(work / f"{name}.trc", walk["time"], walk, chance)
        still = {name: np.zeros(50) for name in walks[first] if name != "time"}
        for name, column in still.items():
            column += walks[first][name].mean() if re.match("pelvis_t[xyz]", name) else np.radians(3) * chance.normal() * bool(re.match("hip_flexion|knee|ankle|pelvis_tilt|lumbar", name))
        for name in ("arm_add_r", "arm_add_l"):
            still[name] -= np.radians(15)
        subject.record(work / "static.trc", np.arange(50) / 50, still, chance)
        found, angles = calibrate(options, work / f"{first}.trc", work / "static.trc", data / "unscaled_generic.osim", work)
        truth = {name: {key: column if key == "time" else np.degrees(column) for key, column in walk.items()} for name, walk in walks.items()}
        own, theirs, residuals = sagittal_error(angles, truth[first]), [], []
        bias = [np.mean([np.interp(truth[first]["time"], angles["time"], angles[f"{joint}_{side}"]) - truth[first][f"{joint}_{side}"] for side in "rl"]) for joint in ("hip_flexion", "knee_angle", "ankle_angle")]
        for name in others:
            residuals.append(solve(options.marey, work / f"{name}.trc", work / "person.osim", work / "other.mot")["rms_mm"])
            theirs.append(sagittal_error(table(work / "other.mot"), truth[name]))
        ratios.append(np.mean(residuals) / found["rms_mm"])
        errors.append([own, np.mean(theirs)])
        print(f"| {number + 1} | {found['rms_mm']:.1f} | {np.mean(residuals):.1f} | {ratios[-1]:.2f} | {own:.1f}, {np.mean(theirs):.1f} | {', '.join(f'{value:+.1f}' for value in bias)} |", flush=True)
    print(f"| mean | | | {np.mean(ratios):.2f} | {', '.join(f'{value:.1f}' for value in np.mean(errors, 0))} | |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--subjects", type=int, default=4)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="experts,children,simulated")
    parser.add_argument("--without-static", action="store_true")
    options = parser.parse_args()
    options.marey = options.marey.resolve()
    with tempfile.TemporaryDirectory(prefix="marey_calibrated_") as folder:
        for part in options.only.split(","):
            {"experts": experts, "children": children, "simulated": simulated}[part](options, pathlib.Path(folder))


if __name__ == "__main__":
    main()
