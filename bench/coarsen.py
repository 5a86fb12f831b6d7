#!/usr/bin/env python3
"""What a small model with fitted curves is worth beside plain simplification: a Markdown table and a picture.

    bench/coarsen.py FINE.glb ... [--build build/release] [--triangles 250,500,1000,2000] [--picture FILE.svg]

For every fine model and count: `limn coarsen` makes the small file; its outline is measured as patches and flat (26
views, 1024 pixels, tolerance 0.25). *Plain* are the same models at every count drawn flat, without their curves: what
simplification alone gives. *Same bytes*, *same triangles*: the plain outline at as many bytes, or as many drawn triangles,
interpolated between the counts along a power law. *Chain*: the bytes of a level-of-detail chain that ends with the plain
model of the same outline.
"""
import argparse
import json
import math
import os
import subprocess
import tempfile

PLAIN = [250, 500, 1000, 2000, 4000, 8000]


def coarsen(build, fine, count, folder):
    small = os.path.join(folder, f"{os.path.basename(fine)}-{count}.glb")
    limn = os.path.join(build, "apps", "limn")
    subprocess.run([limn, "coarsen", fine, "-o", small, "--triangles", str(count), "--quiet"], check=True)
    return small


def curve_bytes(build, small):
    info = subprocess.run([os.path.join(build, "apps", "limn"), "info", small, "--json"], check=True, capture_output=True)
    return sum(mesh["fitted_curves"]["bytes"] for mesh in json.loads(info.stdout)["meshes"] if mesh["fitted_curves"])


def outline(build, small, fine, methods):
    program = os.path.join(build, "bench", "limn_measure")
    command = [program, "outline", "--model", small, "--truth", fine, "--method", methods, "--tolerance", "0.25"]
    rows = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    return {row["method"].split(":")[0]: row for row in rows}


def at(points, x):
    """The power law through the two points of (x, y) around x, or the nearest two."""
    points = sorted(points)
    k = next((i for i in range(1, len(points) - 1) if points[i][0] >= x), len(points) - 1)
    (x0, y0), (x1, y1) = points[k - 1], points[k]
    slope = math.log(y1 / y0) / math.log(x1 / x0) if y0 > 0 and y1 > 0 else 0.0
    return y0 * (x / x0) ** slope


def measure(build, fine, counts, folder):
    plain, rows = [], []
    for count in sorted(set(counts) | set(PLAIN)):
        small = coarsen(build, fine, count, folder)
        size, curves = os.path.getsize(small), curve_bytes(build, small)
        found = outline(build, small, fine, "flat,patches" if count in counts else "flat")
        plain.append((count, size - curves, found["flat"]["mean_px"]))
        if count in counts:
            patches = found["patches"]
            rows.append((count, size, patches["triangles"], patches["mean_px"], found["flat"]["mean_px"],
                         patches["removed"], patches["views_worse_than_flat"]))
    return plain, rows


def chain_bytes(plain, px):
    """Levels, each twice the one before, up to the one whose flat outline is as good."""
    level = at([(y, size) for _, size, y in plain], px)
    return 2.0 * level


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fine", nargs="+")
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--triangles", default="250,500,1000,2000")
    parser.add_argument("--picture")
    options = parser.parse_args()
    counts = [int(count) for count in options.triangles.split(",")]
    print("| model | triangles | bytes | drawn | outline px | flat px | removed | worse views | plain, same bytes | "
          "plain, same triangles | chain of equal outline, bytes |\n" + "| --- " + "| ---: " * 10 + "|")
    drawn = []
    with tempfile.TemporaryDirectory() as folder:
        for fine in options.fine:
            plain, rows = measure(options.build, fine, counts, folder)
            name = os.path.basename(fine).removesuffix(".glb")
            for count, size, triangles, px, flat, removed, worse in rows:
                same_bytes = at([(s, y) for _, s, y in plain], size)
                same_triangles = at([(n, y) for n, _, y in plain], triangles)
                print(f"| {name} | {count} | {size} | {triangles:.0f} | {px:.3f} | {flat:.3f} | {100 * removed:.1f} % | {worse} | "
                      f"{same_bytes:.3f} | {same_triangles:.3f} | {chain_bytes(plain, px):.0f} |", flush=True)
            drawn.append((name, [(s, y) for _, s, y in plain], [(row[1], row[3]) for row in rows]))
        if options.picture:
            draw(options.picture, drawn, folder)


def draw(file, models, folder):
    lines = []
    for number, (name, plain, fitted) in enumerate(models):
        for kind, points in (("plain", plain), ("fitted", fitted)):
            data = os.path.join(folder, f"{number}-{kind}.tsv")
            with open(data, "w") as out:
                out.writelines(f"{x} {y}\n" for x, y in points)
            style = "dashtype 2" if kind == "plain" else "linewidth 2"
            lines.append(f'"{data}" with linespoints linecolor {number + 1} {style} title "{name}, {kind}"')
    script = (f'set terminal svg size 800,560; set output "{file}"; set logscale xy; set xrange [5000:200000]; set grid; set key outside\n'
              'set xlabel "bytes of the file"; set ylabel "mean distance of the outline, pixels of 1024"\n'
              "plot " + ", ".join(lines) + "\n")
    subprocess.run(["gnuplot"], input=script, text=True, check=True)


if __name__ == "__main__":
    main()
