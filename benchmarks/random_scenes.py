#!/usr/bin/python3
"""Writes a table of docs/consistency.md: errors and covariances on simulated recordings that are drawn at random.

usage: benchmarks/random_scenes.py BUILD [--runs N] [--seed N] [--csv FILE] [--markdown PAGE]

Scene, camera, size of the images, frames a second, speed, light and all seeds are drawn, so nothing can have been
chosen on them. Calibrations are wrong by what [Covariance] of config.ini states."""
import argparse
import collections
import concurrent.futures
import csv
import json
import math
import os
import pathlib
import random
import re
import statistics
import subprocess
import sys
import tempfile

SCENES = ("corner desk room notexture cabinet corridor corridor_floor person push door half seated").split()
CAMERAS = ("kinect", "d435", "azure", "phone")
SIZES = (None, None, "320x240", "424x240", "640x360", "848x480")
RATES = (5, 7.5, 10, 15, 30, 30, 60)
SPEEDS = (0.2, 1, 1, 2, 3)
LIGHTS = (1, 1, 1, 0.25)
BRIGHTNESS_SWINGS = (0, 0, 0.3)
FRAMES, SHORTEST, LONGEST = 75, 2, 8  # [-], [s]
INTERVALS = ("1f", "10f", "1s")
BEYOND_SIGMAS, LEAST_ERROR = 5, (0.01, math.radians(1))  # as in docs/envelope.md: [m], [rad]
MARKS = ("<!-- random:begin -->", "<!-- random:end -->")


def draw(rng, repository):
    """A recording: options of pointplane-simulate."""
    rate = rng.choice(RATES)
    calibration = {
        key: value
        for key, value in re.findall(
            r"^(principalPoint|focalLength|depthScale) = (\S+)", (repository / "config.ini").read_text(), re.M)
    }
    return {
        "scene": rng.choice(SCENES),
        "camera": rng.choice(CAMERAS),
        "size": rng.choice(SIZES),
        "fps": rate,
        "seed": rng.randrange(10**6, 10**9),
        "duration": min(max(FRAMES / rate, SHORTEST), LONGEST),
        "settings": {
            "sceneSeed": rng.randrange(10**6, 10**9),
            "motionSpeed": rng.choice(SPEEDS),
            "light": rng.choice(LIGHTS),
            "exposureSwing": rng.choice(BRIGHTNESS_SWINGS),
            "principalPointError": calibration["principalPoint"],
            "focalLengthError": calibration["focalLength"],
            "depthScaleError": calibration["depthScale"],
        },
    }


def describe(drawn):
    settings = " ".join(f"{key}={value}" for key, value in drawn["settings"].items())
    return (f"{drawn['scene']} --camera {drawn['camera']} --size {drawn['size'] or 'own'} --fps {drawn['fps']} "
            f"--seed {drawn['seed']} {settings}")


def run(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{' '.join(map(str, command))}\n{done.stderr}")


def is_beyond(step):
    """Along one of the robot's axes. docs/envelope.md has principal axes, of covariances that --save does not write."""
    for axes, unit, least in (("x y z", "m", LEAST_ERROR[0]), ("rx ry rz", "rad", LEAST_ERROR[1])):
        for axis in axes.split():
            error, sigma = abs(float(step[f"error_{axis}_{unit}"])), float(step[f"sigma_{axis}_{unit}"])
            if error > least and error > BEYOND_SIGMAS * sigma:
                return True
    return False


def measure(drawn, programs, config, folder):
    """Simulates, estimates and scores one recording."""
    recording, poses, table = folder / "in.rawlog", folder / "out.rawlog", folder / "frames.csv"
    truth, steps = folder / "in.groundtruth.txt", folder / "steps.csv"
    size = ["--size", drawn["size"]] if drawn["size"] else []
    settings = [part for key, value in drawn["settings"].items() for part in ("--set", f"{key}={value}")]
    run(programs / "pointplane-simulate", drawn["scene"], "-o", recording, "--quiet", "--truth-frame", "robot",
        "--seed", drawn["seed"], "--duration", drawn["duration"], "--fps", drawn["fps"], "--camera", drawn["camera"],
        *size, *settings)
    run(programs / "pointplane-odometry", "-c", config, recording, "--quiet", "--jobs", 1, "--only-poses", "--since", 61,
        "-o", poses, "--diagnostics", table)
    run(programs / "pointplane-eval", "nees", truth, poses, "--interval", ",".join(INTERVALS), "--json",
        folder / "nees.json", "--save", steps)
    run(programs / "pointplane-eval", "rpe", truth, poses, "--fixed-delta", "--delta", 1, "--json", folder / "rpe.json")
    with open(table, encoding="utf-8") as file:
        statuses = {round(float(row["stamp"]), 3): row["status"] for row in csv.DictReader(file)}
    with open(steps, encoding="utf-8") as file:
        wrong = sum(row["interval"] == "1f" and statuses[round(float(row["stamp_j"]), 3)] == "tracked" and
                    is_beyond(row) for row in csv.DictReader(file))
    nees = {i["interval"]: i["joint"]["neesPerDof"] for i in json.loads((folder / "nees.json").read_text())["intervals"]}
    rpe = json.loads((folder / "rpe.json").read_text())
    tracked = sum(status == "tracked" for status in statuses.values())
    return {
        **drawn,
        "frames": len(statuses) - 1,
        "tracked": tracked,
        "rpe_mm": 1000 * rpe["translation"]["rmse"],
        "nees": [nees.get(interval, math.nan) for interval in INTERVALS],
        "beyond": wrong,
    }


def row(name, runs):
    rpe = [r["rpe_mm"] for r in runs]
    nees = [[r["nees"][k] for r in runs if not math.isnan(r["nees"][k])] for k in range(len(INTERVALS))]
    middle = " / ".join(f"{statistics.median(n):.2f}" for n in nees)
    largest = " / ".join(f"{max(n):.2f}" for n in nees)
    tracked = 100 * sum(r["tracked"] for r in runs) / sum(r["frames"] for r in runs)
    return (f"| {name} | {len(runs)} | {tracked:.0f} | {statistics.median(rpe):.1f} / {max(rpe):.1f} | {middle} | "
            f"{largest} | {sum(r['beyond'] for r in runs)} |\n")


def tables(results, seed):
    by_scene, by_camera = collections.defaultdict(list), collections.defaultdict(list)
    for r in results:
        by_scene[r["scene"]].append(r)
        by_camera[r["camera"]].append(r)
    out = f"\n{len(results)} recordings, drawn with seed {seed}:\n\n"
    out += ("| scene or camera | recordings | tracked, % | RPE over 1 s [mm], median / largest | NEES, median | NEES, largest "
            "| steps beyond 5σ |\n|---|---|---|---|---|---|---|\n")
    for names, groups in ((SCENES, by_scene), (CAMERAS, by_camera)):
        for name in names:
            if groups[name]:
                out += row(name, groups[name])
    return out + row("**all**", results) + "\n"


def replace(page, text, marks):
    content = page.read_text(encoding="utf-8")
    before, rest = content.split(marks[0])
    page.write_text(before + marks[0] + "\n" + text + marks[1] + rest.split(marks[1])[1], encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, help="build tree, or another folder with the programs in bin")
    parser.add_argument("--runs", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1, help="of what is drawn")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--csv", type=pathlib.Path, help="write a line per recording")
    parser.add_argument("--markdown", type=pathlib.Path, help="replace the table of this page")
    arguments = parser.parse_args()
    repository = pathlib.Path(__file__).resolve().parent.parent
    rng = random.Random(arguments.seed)
    drawn = [draw(rng, repository) for _ in range(arguments.runs)]

    def one(what):
        with tempfile.TemporaryDirectory() as folder:
            result = measure(what, arguments.build.resolve() / "bin", repository / "config.ini", pathlib.Path(folder))
        worst = max((n for n in result["nees"] if not math.isnan(n)), default=math.nan)
        print(f"{describe(what)}: RPE {result['rpe_mm']:.1f} mm, NEES up to {worst:.2f}, beyond 5σ {result['beyond']}",
              file=sys.stderr)
        return result

    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        results = list(pool.map(one, drawn))
    if arguments.csv:
        with open(arguments.csv, "w", encoding="utf-8") as file:
            out = csv.writer(file)
            out.writerow(("recording", "frames", "tracked", "rpe_mm", *(f"nees_{i}" for i in INTERVALS), "beyond_5_sigma"))
            for r in results:
                out.writerow((describe(r), r["frames"], r["tracked"], r["rpe_mm"], *r["nees"], r["beyond"]))
    text = tables(results, arguments.seed)
    if arguments.markdown:
        replace(arguments.markdown, text, MARKS)
    else:
        print(text)


if __name__ == "__main__":
    main()
