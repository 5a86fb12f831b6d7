#!/usr/bin/env python3
"""How the cost of a flat frame grows with triangles and with pixels: two Markdown tables and, with --picture, two lines.

    bench/linear.py [--build build/release/bench] [--threads 2] [--rounds 3] [--picture FILE.svg] [--most MILLIONS]

Triangles: one torus of 1 to 16 million, a window of 1280x800. Pixels: 60 × knot-480, windows of 64² to 8192². Half of
view 0 is covered. A time is the least of interleaved rounds.
"""
import argparse
import shutil
import subprocess
import sys

from race import Programs

TORI = {1: "torus:1024:512", 2: "torus:1024:1024", 4: "torus:2048:1024", 8: "torus:2048:2048"}
SIZES = [64 << k for k in range(8)]


def triangle_scenes(most):
    scenes = [(count << 20, dict(model=model, copies=1, size="1280x800")) for count, model in TORI.items()]
    scenes.append((16 << 20, dict(model=TORI[8], copies=2, size="1280x800")))
    return [(count, scene) for count, scene in scenes if count <= most << 20]


def pixel_scenes():
    return [(size * size, dict(model="knot-480", copies=60, size=f"{size}x{size}")) for size in SIZES]


def measure(programs, scenes, rounds, threads):
    """[(amount, ms)]: the least of `rounds` rounds through all scenes."""
    best = [float("inf")] * len(scenes)
    for _ in range(rounds):
        for i, (_, scene) in enumerate(scenes):
            seen = programs.frames("limn_bench_frames", scene, threads=threads, poses=2)
            best[i] = min(best[i], float(seen["min_ms"]))
    return [(amount, ms) for (amount, _), ms in zip(scenes, best)]


def show(title, unit, line):
    print(f"\n| {title} | ms | ms per million {unit} |\n|---:|---:|---:|")
    for amount, ms in line:
        print(f"| {amount:,} | {ms:.3f} | {ms * 1e6 / amount:.3f} |")


def draw(path, lines):
    """Both lines on logarithmic axes, with a straight line of slope 1 through the largest amount of each."""
    commands = [f"set terminal svg size 900,420; set output '{path}'; set multiplot layout 1,2; set logscale xy; "
                "set grid; set key left top; set ylabel 'ms per frame'; set format x '10^{%L}'"]
    for label, line in lines:
        (last, ms) = line[-1]
        commands.append(f"set xlabel '{label}'; plot '-' with linespoints pt 7 title 'limn', "
                        f"{ms}*x/{last} dashtype 2 title 'proportional'")
        commands += [f"{amount} {ms}" for amount, ms in line] + ["e"]
    subprocess.run(["gnuplot"], input="\n".join(commands), text=True, check=True)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--build", default="build/release/bench")
    arguments.add_argument("--threads", type=int, default=2)
    arguments.add_argument("--rounds", type=int, default=3)
    arguments.add_argument("--most", type=int, default=16, help="million triangles")
    arguments.add_argument("--picture")
    arguments = arguments.parse_args()
    if arguments.picture and not shutil.which("gnuplot"):
        sys.exit("linear.py: --picture needs gnuplot")
    programs = Programs(arguments.build, seconds=0.1)
    triangles = measure(programs, triangle_scenes(arguments.most), arguments.rounds, arguments.threads)
    show("triangles", "triangles", triangles)
    pixels = measure(programs, pixel_scenes(), arguments.rounds, arguments.threads)
    show("pixels", "pixels", pixels)
    if arguments.picture:
        draw(arguments.picture, [("triangles", triangles), ("pixels", pixels)])


if __name__ == "__main__":
    main()
