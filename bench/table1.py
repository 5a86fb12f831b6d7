#!/usr/bin/env python3
"""Table I of L. Wang et al., "Silhouette Smoothing for Real-Time Rendering of Mesh Surfaces", row by row.

    bench/table1.py [--models FOLDER] [--tolerance 0.5] [--rounds 3] [--seconds 0.3] [--threads 2] [ROW ...]

60 copies of each mesh in 1280×800, about half of the window covered (the largest mesh once): drawn triangles of one copy
and frame time over the flat mesh's, for PN triangles of the paper's level, patches and curves, beside the paper's own.
The methods of a row are timed in turns, in short runs; each one's time is the least over the rounds. Meshes that cannot
be had are stood in for by shapes of their kind, named in the row. Models are looked for in FOLDER/coarse-and-fine; rows
whose file is not there are left out. Prints a Markdown table.
"""
import os

from race import Programs, options_of

# Of the paper: name, triangles, PN triangles and level, the method's triangles, frames per second drawn directly, with PN
# triangles and with silhouette curves in perspective; then the mesh that stands for it.
ROWS = (
    ("sphere", 200, 3200, 3, 332, 573, 115, 347, "sphere-200"),
    ("knot", 480, 7680, 3, 884, 605, 53, 147, "knot-480"),
    ("bunny", 500, 8000, 3, 800, 442, 50, 68, "bunny-500.glb"),
    ("fish", 500, 4500, 2, 886, 620, 77, 114, "camelhead-500.glb"),
    ("bear", 500, 8000, 3, 893, 633, 52, 112, "cheburashka-500.glb"),
    ("head", 500, 8000, 3, 904, 448, 54, 75, "igea-500.glb"),
    ("venus", 500, 4500, 2, 862, 655, 76, 153, "venus-500.glb"),
    ("cat", 500, 8000, 3, 842, 372, 52, 74, "cat-500.glb"),
    ("cow", 500, 8000, 3, 983, 560, 51, 80, "cow-500.glb"),
    ("torus", 576, 5184, 2, 960, 592, 67, 167, "torus-576"),
    ("hippo, once", 43288, 389592, 2, 51842, 462, 60, 96, "armadillo-fine.glb"),
)
HEAD = ("mesh", "triangles: flat", "pn", "patches", "curves", "paper: flat", "pn", "curves", "time / flat: pn", "patches",
        "curves", "paper: pn", "curves")


def cells(programs, row, model, arguments):
    name, flat, pn, level, curves, direct_fps, pn_fps, curves_fps, stands_in = row
    copies = 1 if name.endswith("once") else 60
    scene = dict(model=model, copies=copies, size="1280x800", threads=arguments.threads)
    methods = {"flat": {}, "pn": dict(method="pn", segments=level + 1),
               "patches": dict(method="patches", tolerance=arguments.tolerance),
               "curves": dict(method="curves", tolerance=arguments.tolerance)}
    seen = dict(zip(methods, programs.least(scene, list(methods.values()), arguments.rounds)))
    best = {method: float(run["min_ms"]) for method, run in seen.items()}
    drawn = {method: float(run["tris_drawn"]) / copies for method, run in seen.items()}
    kind = os.path.splitext(stands_in)[0]
    return ([name if kind.startswith(name) else f"{name} ({kind})"] + [f"{drawn[m]:,.0f}" for m in methods] +
            [f"{flat:,}", f"{pn:,}", f"{curves:,}"] + [f"{best[m] / best['flat']:.2f}" for m in methods if m != "flat"] +
            [f"{direct_fps / pn_fps:.2f}", f"{direct_fps / curves_fps:.2f}"])


def main():
    parser = options_of(__doc__, rounds=3, seconds=0.3)
    parser.add_argument("rows", nargs="*", metavar="ROW", help="parts of row names; all where there is none")
    parser.add_argument("--models", default="../shared/models")
    parser.add_argument("--tolerance", type=float, default=0.5)
    parser.add_argument("--threads", type=int, default=2)
    arguments = parser.parse_args()
    programs = Programs(arguments.build, arguments.seconds)
    print("| " + " | ".join(HEAD) + " |\n|---|" + "---:|" * (len(HEAD) - 1))
    for row in ROWS:
        if arguments.rows and not any(part in row[0] for part in arguments.rows):
            continue
        model = row[-1]
        if model.endswith(".glb"):
            model = os.path.join(arguments.models, "coarse-and-fine", model)
            if not os.path.exists(model):
                continue
        print("| " + " | ".join(cells(programs, row, model, arguments)) + " |", flush=True)


if __name__ == "__main__":
    main()
