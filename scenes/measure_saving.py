#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures the saving of modelling only what a scene requires: runs scenes with and without --model-everything,
alternately, and prints the table of scenes/scene/MODELS.md. Usage: scenes/measure_saving.py [VPS] [--repeats N] [--scenes NAME ...]"""
import argparse
import json
import os
import statistics
import subprocess
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))


def run(vps, scene, flags):
    """The JSON of one run, with its peak memory."""
    with tempfile.TemporaryDirectory() as folder:
        numbers = os.path.join(folder, "assemble.json")
        command = [vps, "assemble", scene, "--no-pictures", "--no-cache", "--out", folder, "--json", numbers] + flags
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        if os.waitstatus_to_exitcode(status) not in (0, 1):
            raise SystemExit(" ".join(command) + " failed")
        with open(numbers) as file:
            result = json.load(file)
        result["peak_bytes"] = usage.ru_maxrss * 1024
        return result


ROWS = [
    ("models [MB]", lambda r: r["modelled"]["bytes"] / 1e6, 1),
    ("points of the fixed field, at the most memory", lambda r: r["modelled"]["field_points"], 0),
    ("peak memory of the program [MB]", lambda r: r["peak_bytes"] / 1e6, 0),
    ("load [s]", lambda r: r["wall"]["build_s"], 2),
    ("cooking between steps, all [s]", lambda r: sum(r["wall"]["cook_s"]), 2),
    ("physics step, median [us]", lambda r: r["wall"]["physics"]["tick_us"]["p50"], 1),
    ("physics step, p99 [us]", lambda r: r["wall"]["physics"]["tick_us"]["p99"], 1),
    ("haptic tick, median [us]", lambda r: r["wall"]["haptic"]["tick_us"]["p50"], 1),
    ("whole run [s]", lambda r: r["wall"]["build_s"] + r["wall"]["run_s"], 1),
]


def final_poses(result):
    return [step["final_error_m"] for step in result["steps"]]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("vps", nargs="?", default=os.path.join(HERE, "../build/release/vps"))
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--scenes", nargs="*", default=["peg_in_hole", "bearing_block"])
    given = parser.parse_args()
    for name in given.scenes:
        scene = os.path.join(HERE, name, "scene.toml")
        spared, everything = [], []
        for _ in range(given.repeats):
            spared.append(run(given.vps, scene, []))
            everything.append(run(given.vps, scene, ["--model-everything"]))
        print(f"| {name} | only what it requires | everything | ratio |\n|---|---|---|---|")
        for words, value, digits in ROWS:
            a = statistics.median(value(r) for r in spared)
            b = statistics.median(value(r) for r in everything)
            print(f"| {words} | {a:.{digits}f} | {b:.{digits}f} | {a / b if b else 1:.2f} |")
        apart = max(abs(a - b) for a, b in zip(final_poses(spared[0]), final_poses(everything[0])))
        print(f"\nfinal errors of the parts differ by {apart:g} m at most\n")


if __name__ == "__main__":
    main()
