#!/usr/bin/env python3
"""How the cost of a flat frame grows with triangles and with pixels: two Markdown tables, the straight line that fits
each best, and, with --picture, a drawing of both.

    bench/linear.py [--build build/release/bench] [--threads 2] [--seconds 0.5] [--picture FILE.svg] [--most MILLIONS]

Triangles: one torus of 1 to 8 million, and two of 8, in a window of 1280x800. Pixels: 60 × knot-480, windows of 64² to
8192². Half of view 0 is covered. A time is the least of the frames drawn in --seconds.
"""
import shutil
import subprocess
import sys

from race import Programs, options_of

TORI = {1: "torus:1024:512", 2: "torus:1024:1024", 4: "torus:2048:1024", 8: "torus:2048:2048"}
SIZES = [64 << k for k in range(8)]


def triangle_scenes(most):
    scenes = [(count << 20, dict(model=model, copies=1, size="1280x800")) for count, model in TORI.items()]
    scenes.append((16 << 20, dict(model=TORI[8], copies=2, size="1280x800")))
    return [(count, scene) for count, scene in scenes if count <= most << 20]


def pixel_scenes():
    return [(size * size, dict(model="knot-480", copies=60, size=f"{size}x{size}")) for size in SIZES]


def measure(programs, scenes, threads):
    """[(amount, ms)]. Scenes of one kind have the scale of the first that has as many copies."""
    line, scales = [], {}
    for amount, scene in scenes:
        scale = scales.setdefault(scene["copies"], programs.scale(scene))
        seen = programs.frames("limn_bench_frames", scene | dict(scale=scale), threads=threads, poses=2)
        line.append((amount, float(seen["min_ms"])))
    return line


def fit(line):
    """a and b of ms = a + b · amount, by least squares of relative errors."""
    weights = [1 / ms for _, ms in line]
    ww = sum(w * w for w in weights)
    wx = sum(w * w * x for w, (x, _) in zip(weights, line))
    xx = sum((w * x) ** 2 for w, (x, _) in zip(weights, line))
    wy, xy = sum(weights), sum(w * x for w, (x, _) in zip(weights, line))
    b = (ww * xy - wx * wy) / (ww * xx - wx * wx)
    return (wy - b * wx) / ww, b


def show(title, unit, line):
    a, b = fit(line)
    print(f"\n| {title} | ms | straight line | apart |\n|---:|---:|---:|---:|")
    for amount, ms in line:
        print(f"| {amount:,} | {ms:.3f} | {a + b * amount:.3f} | {100 * (ms / (a + b * amount) - 1):+.0f} % |")
    print(f"\nThe line: {a:.3f} ms and {b * 1e6:.3f} ms per million {unit}.")


def draw(path, lines):
    """Both lines on logarithmic axes, with the straight line that fits each."""
    commands = [f"set terminal svg size 900,420; set output '{path}'; set multiplot layout 1,2; set logscale xy; "
                "set grid; set key left top; set ylabel 'ms per frame'; set format x '10^{%L}'"]
    for label, line in lines:
        a, b = fit(line)
        commands.append(f"set xlabel '{label}'; plot '-' with points pt 7 title 'limn', "
                        f"{a} + {b}*x dashtype 2 title '{a:.2f} ms + {b * 1e6:.2f} ms per million'")
        commands += [f"{amount} {ms}" for amount, ms in line] + ["e"]
    subprocess.run(["gnuplot"], input="\n".join(commands), text=True, check=True)


def main():
    parser = options_of(__doc__, rounds=None, seconds=0.5)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--most", type=int, default=16, help="million triangles, two or more")
    parser.add_argument("--picture")
    arguments = parser.parse_args()
    if arguments.most < 2:
        parser.error("--most: a line needs two points; give 2 or more")
    if arguments.picture and not shutil.which("gnuplot"):
        sys.exit("linear.py: --picture needs gnuplot")
    programs = Programs(arguments.build, arguments.seconds)
    triangles = measure(programs, triangle_scenes(arguments.most), arguments.threads)
    show("triangles", "triangles", triangles)
    pixels = measure(programs, pixel_scenes(), arguments.threads)
    show("pixels", "pixels", pixels)
    if arguments.picture:
        draw(arguments.picture, [("triangles", triangles), ("pixels", pixels)])


if __name__ == "__main__":
    main()
