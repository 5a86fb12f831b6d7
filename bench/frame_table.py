#!/usr/bin/env python3
"""What a curved triangle costs against a flat one: frame times of every method and tolerance beside the flat mesh's.

    bench/frame_table.py [--build build/release/bench] [--rounds 3] [--seconds 0.2] [MODEL ...]

Each MODEL (a file or built-in name; default: built-in ones and, where they are there, the coarse models of
../shared/models/coarse-and-fine) is drawn as the peer's scene: 60 copies, 1280x800, one sample, half of view 0 covered;
and one large mesh is drawn once. A model's runs alternate, and its times are the least of all rounds. Prints JSON rows:

times_flat             frame time over the flat mesh's
classify_ms            stage times, summed over the threads: which edges bend,
refine_ms              the rest of the refinement,
raster_ms              and the rasterizer
ns_per_added_triangle  what the frame takes longer, per triangle that it has more
disturbed              the median is more than 1.5 times the least: others used the machine
"""
import glob
import json
import os
import sys

from race import Programs, options_of

BUILTIN = ["icosphere-320", "torus-576", "knot-480", "pawn", "cone-70"]
PAIRS = "../shared/models/coarse-and-fine/*-500.glb"
LARGE = "icosphere:8"
TOLERANCES = (2, 0.5, 0.1)
FEW = (0.5,)


def variants(tolerances):
    """[(method, tolerance)]: flat first, which the others are compared with."""
    return [("flat", 0.25)] + [(method, t) for method in ("patches", "curves", "pn") for t in tolerances]


def scenes(models):
    for model in models or BUILTIN + sorted(glob.glob(PAIRS)):
        tolerances = FEW if os.path.exists(model) else TOLERANCES
        yield dict(model=model, copies=60, size="1280x800"), variants(tolerances)
    if not models:
        # Uniform PN triangles of a mesh this fine only cost: its triangles are smaller than pixels.
        yield dict(model=LARGE, copies=1, size="1280x800"), [v for v in variants(FEW) if v[0] != "pn"]


def row(scene, method, tolerance, seen, flat):
    ms, flat_ms = float(seen["min_ms"]), float(flat["min_ms"])
    more = int(seen["tris_drawn"]) - int(flat["tris_drawn"])
    return dict(model=os.path.basename(scene["model"]), copies=scene["copies"], method=method, tolerance=tolerance,
                min_ms=ms, median_ms=float(seen["median_ms"]), times_flat=round(ms / flat_ms, 4),
                tris_drawn=int(seen["tris_drawn"]), classify_ms=float(seen["classify_ms"]),
                refine_ms=float(seen["refine_ms"]), raster_ms=float(seen["raster_wall_ms"]),
                ns_per_added_triangle=round((ms - flat_ms) * 1e6 / more, 1) if more > 0 else 0.0,
                allocs_per_frame=float(seen["allocs_per_frame"]),
                disturbed=float(seen["median_ms"]) > 1.5 * ms)


def main():
    parser = options_of(__doc__, rounds=3, seconds=0.2)
    parser.add_argument("models", nargs="*", metavar="MODEL")
    arguments = parser.parse_args()
    programs = Programs(arguments.build, arguments.seconds)
    rows = []
    for scene, some in scenes(arguments.models):
        best = programs.least(scene, [dict(method=method, tolerance=tolerance) for method, tolerance in some],
                              arguments.rounds)
        rows += [row(scene, *variant, seen, best[0]) for variant, seen in zip(some, best)]
    print("[\n" + ",\n".join("  " + json.dumps(r) for r in rows) + "\n]")
    if any(r["disturbed"] for r in rows):
        print("frame_table.py: some rows were disturbed by other work on the machine", file=sys.stderr)


if __name__ == "__main__":
    main()
