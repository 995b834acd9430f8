#!/usr/bin/python3
"""Writes a table of docs/consistency.md: are covariances as true after ten seconds as after one?

usage: [POINTPLANE_DATA=DIR] benchmarks/long_scenes.py BUILD [--seeds N] [--scenes SCENE ...] [--markdown PAGE]

Scenes are simulated for 16 s, with calibrations that are wrong by what [Covariance] of config.ini states. NEES of all
increments that begin in a part of the time are averaged. With POINTPLANE_DATA, TUM's recordings follow, with the noise
of their ground truth as measured by benchmark_ground_truth."""
import argparse
import concurrent.futures
import csv
import os
import pathlib
import re
import statistics
import tempfile

import random_scenes

SCENES = "corner desk room notexture cabinet corridor_floor seated".split()
RECORDINGS = "tum_fr1_xyz_part tum_fr1_rpy_part tum_fr3_structure_notexture_far_part".split()
SECONDS, SIZE = 16, "320x240"
PARTS = ((0, 2), (2, 5), (5, SECONDS))  # [s]
INTERVALS = ("1f", "1s")
DOF = 6
MARKS = ("<!-- long:begin -->", "<!-- long:end -->")


def nees_of(recording, truth, programs, config, options):
    """{(interval, part): squared errors per degree of freedom}"""
    poses, steps = recording.with_suffix(".poses.rawlog"), recording.with_suffix(".csv")
    random_scenes.run(programs / "pointplane-odometry", "-c", config, recording, "--quiet", "--jobs", 1, "--only-poses",
                      "--since", 31, "-o", poses)
    random_scenes.run(programs / "pointplane-eval", "nees", truth, poses, "--body-from-gt", "optical", "--interval",
                      ",".join(INTERVALS), "--save", steps, *options)
    with open(steps, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    start = min(float(row["stamp_i"]) for row in rows)
    out = {}
    for row in rows:
        since = float(row["stamp_i"]) - start
        for part in PARTS:
            if part[0] <= since < part[1]:
                out.setdefault((row["interval"], part), []).append(float(row["nees"]) / DOF)
    return out


def simulated(scene, seed, programs, config, folder):
    calibration = re.findall(r"^(principalPoint|focalLength|depthScale) = (\S+)", config.read_text(), re.M)
    recording = folder / f"{scene}.{seed}.rawlog"
    random_scenes.run(programs / "pointplane-simulate", scene, "-o", recording, "--quiet", "--seed", seed, "--duration",
                      SECONDS, "--size", SIZE,
                      *[part for key, value in calibration for part in ("--set", f"{key}Error={value}")])
    return nees_of(recording, recording.with_suffix(".groundtruth.txt"), programs, config, [])


def noise_of_truth(build, data, folder):
    """{recording: "x,y,z" [deg]}"""
    table = folder / "noise.csv"
    random_scenes.run(build / "benchmarks/ground_truth/benchmark_ground_truth", "--data", data, "--sequences", "tum_",
                      "--csv", table)
    with open(table, encoding="utf-8") as file:
        return {row[0]: ",".join(row[4:7]) for row in csv.reader(file) if row[1] == "1"}


def real(name, data, noise, programs, config, folder):
    recording = folder / f"{name}.rawlog"
    random_scenes.run(programs / "pointplane-convert", "tum", data / name, "-o", recording, "--quiet")
    return nees_of(recording, recording.with_suffix(".groundtruth.txt"), programs, config,
                   ["--gt-sigma-trans", 0.0001, "--gt-sigma-rot-deg", noise[name]])


def row(name, runs):
    cells = []
    for part in PARTS:
        pooled = [[n for run in runs for n in run.get((interval, part), [])] for interval in INTERVALS]
        cells.append(" / ".join(f"{statistics.mean(p):.2f}" if p else "-" for p in pooled))
    return f"| {name} | {' | '.join(cells)} |\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, help="build tree")
    parser.add_argument("--seeds", type=int, default=3, help="of each scene, from 101")
    parser.add_argument("--scenes", nargs="+", default=SCENES, choices=SCENES, metavar="SCENE")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--markdown", type=pathlib.Path, help="replace the table of this page")
    arguments = parser.parse_args()
    programs, build = arguments.build.resolve() / "bin", arguments.build.resolve()
    config = pathlib.Path(__file__).resolve().parent.parent / "config.ini"
    data = os.environ.get("POINTPLANE_DATA")
    with tempfile.TemporaryDirectory() as name, concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        folder = pathlib.Path(name)
        runs = {scene: [pool.submit(simulated, scene, 101 + k, programs, config, folder) for k in range(arguments.seeds)]
                for scene in arguments.scenes}
        if data:
            noise = noise_of_truth(build, pathlib.Path(data), folder)
            runs.update({r: [pool.submit(real, r, pathlib.Path(data), noise, programs, config, folder)]
                         for r in RECORDINGS})
        parts = " | ".join(f"{begin} to {end} s" for begin, end in PARTS)
        text = f"\n| NEES over 1 frame / 1 s, increments that begin at | {parts} |\n|---|{'---|' * len(PARTS)}\n"
        text += "".join(row(what, [run.result() for run in of]) for what, of in runs.items()) + "\n"
    if arguments.markdown:
        random_scenes.replace(arguments.markdown, text, MARKS)
    else:
        print(text)


if __name__ == "__main__":
    main()
