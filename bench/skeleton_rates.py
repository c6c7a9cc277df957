"""How near `marey solve` brings a skeleton to a runner's markers, whatever the rate and however fast the run, beside OpenSim.

The recording (a TRC file in mm, y up) is played 1, 2 and 5 times as fast and resampled by cubic splines. Printed: the unweighted RMS distance of all markers,
mm, of `marey solve`, of `marey solve --smooth` and, where the package opensim is installed, of OpenSim's inverse kinematics with every marker of weight 1,
on the same model and frames; and the largest step of an angle of the root between two frames, degrees.

Usage: skeleton_rates.py MAREY MODEL.osim RUN.trc [--seconds S of the recording] [--begin S] [--clocks 1,2,5] [--rates 25,60,…]
"""

import argparse
import contextlib
import json
import os
import pathlib
import subprocess
import tempfile

import numpy
from scipy.interpolate import CubicSpline


def read_trc(path):
    lines = pathlib.Path(path).read_text().splitlines()
    rate = float(lines[2].split()[0])
    names = [name for name in lines[3].split("\t")[2:] if name.strip()]
    rows = [line.split("\t") for line in lines[5:] if line.strip()]
    values = numpy.array([[float(cell) if cell.strip() else numpy.nan for cell in row[2:2 + 3 * len(names)]] for row in rows])
    values = values.reshape(len(rows), len(names), 3)
    values[(values == 0).all(axis=2)] = numpy.nan
    return rate, names, values


def write_trc(path, rate, names, values):
    with open(path, "w") as out:
        out.write(f"PathFileType\t4\t(X/Y/Z)\t{path}\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n")
        out.write(f"{rate}\t{rate}\t{len(values)}\t{len(names)}\tmm\t{rate}\t1\t{len(values)}\nFrame#\tTime\t" + "\t\t\t".join(names) + "\t\t\n\t\t")
        out.write("\t".join(f"X{i + 1}\tY{i + 1}\tZ{i + 1}" for i in range(len(names))) + "\n\n")
        for f, row in enumerate(values):
            out.write(f"{f + 1}\t{f / rate:.6f}\t" + "\t".join(f"{x:.5f}" for x in row.reshape(-1)) + "\n")


@contextlib.contextmanager
def quietly(folder):
    """OpenSim writes opensim.log where it is started, and the model's counts to standard output."""
    here, out = os.getcwd(), os.dup(1)
    os.chdir(folder)
    with open(os.devnull, "w") as nowhere:
        os.dup2(nowhere.fileno(), 1)
        try:
            yield
        finally:
            os.dup2(out, 1)
            os.close(out)
            os.chdir(here)


def opensim_rms(model, trc, folder):
    """mm, and nothing if the package is not here."""
    try:
        import opensim
    except ImportError:
        return None
    opensim.Logger.setLevelString("error")
    body = opensim.Model(str(model))
    tool = opensim.InverseKinematicsTool()
    tool.setModel(body)
    tool.setMarkerDataFileName(str(trc))
    table = opensim.TimeSeriesTableVec3(str(trc))
    times = table.getIndependentColumn()
    tool.setStartTime(times[0])
    tool.setEndTime(times[-1])
    tool.setResultsDir(str(folder))
    tool.setName("peer")
    tool.setOutputMotionFileName(str(folder / "peer.mot"))
    recorded = set(table.getColumnLabels())
    for i in range(body.getMarkerSet().getSize()):
        name = body.getMarkerSet().get(i).getName()
        if name in recorded:
            task = opensim.IKMarkerTask()
            task.setName(name)
            task.setWeight(1)
            task.setApply(True)
            tool.getIKTaskSet().cloneAndAppend(task)
    tool.set_report_errors(True)
    tool.run()
    lines = (folder / "peer_ik_marker_errors.sto").read_text().splitlines()
    begin = next(i for i, line in enumerate(lines) if line.startswith("time"))
    column = lines[begin].split("\t").index("marker_error_RMS")
    rms = numpy.array([float(line.split("\t")[column]) for line in lines[begin + 1:]])
    return 1000 * float(numpy.sqrt((rms ** 2).mean()))


def solved(marey, model, trc, folder, *options):
    done = subprocess.run([marey, "solve", trc, "--skeleton", model, "-o", folder / "own.mot", "--json", *options], capture_output=True, text=True, check=True)
    rows = (folder / "own.mot").read_text().splitlines()
    begin = next(i for i, line in enumerate(rows) if line.startswith("time"))
    angles = numpy.array([[float(x) for x in row.split("\t")[1:4]] for row in rows[begin + 1:]])
    return json.loads(done.stdout)["rms_mm"], float(abs(numpy.diff(angles, axis=0)).max()) if len(angles) > 1 else 0


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("marey")
    parser.add_argument("model")
    parser.add_argument("run")
    parser.add_argument("--begin", type=float, default=2)
    parser.add_argument("--seconds", type=float, default=1.5)
    parser.add_argument("--clocks", default="1,2,5")
    parser.add_argument("--rates", default="25,60,120,250,500,1000")
    parser.add_argument("--without-peer", action="store_true")
    parser.add_argument("--smooth", action="store_true")
    given = parser.parse_args()
    model = os.path.abspath(given.model)
    rate, names, values = read_trc(given.run)
    seen = [i for i in range(len(names)) if not numpy.isnan(values[:, i]).any()]
    spline = CubicSpline(numpy.arange(len(values)) / rate, values[:, seen])
    print("clock rate_hz frames marey_mm smooth_mm opensim_mm ratio largest_root_step_deg", flush=True)
    for clock in (float(c) for c in given.clocks.split(",")):
        for to in (float(r) for r in given.rates.split(",")):
            times = given.begin + numpy.arange(0, given.seconds, clock / to)
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name)
                write_trc(folder / "run.trc", to, [names[i] for i in seen], spline(times))
                own, step = solved(given.marey, model, folder / "run.trc", folder)
                smooth = solved(given.marey, model, folder / "run.trc", folder, "--smooth")[0] if given.smooth else float("nan")
                peer = None
                if not given.without_peer:
                    with quietly(folder):
                        peer = opensim_rms(pathlib.Path(model), folder / "run.trc", folder)
                print(f"{clock:g} {to:g} {len(times)} {own:.2f} {smooth:.2f} {peer or 0:.2f} {own / peer if peer else 0:.3f} {step:.1f}", flush=True)


main()
