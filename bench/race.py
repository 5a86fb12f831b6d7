#!/usr/bin/env python3
"""limn against Mesa's llvmpipe on the same scenes, interleaved in one run.

    cmake --preset release -D LIMN_BUILD_PEER=ON && cmake --build --preset release
    bench/race.py [--build build/release/bench] [--rounds 5] [--seconds 0.4] [--json FILE] [ROW ...]

Every row is timed by alternating short runs of both programs; each program's time is the least over the rounds of its
min_ms (for every view the best frame, averaged over the views), so that a disturbance from outside hits neither side
alone. Frames end in client memory. Both draw with the same scale; before a row is timed the two pictures are compared.
Without the peer program (limn_peer) the rows that need it are left out. Prints a Markdown table; ROW are numbers or
parts of row names.
"""
import argparse
import json
import os
import re
import subprocess
import sys
import tempfile

MODELS = ("icosphere-320", "torus-576", "knot-480")
LARGE = "icosphere:8"


def parse(text):
    return {key: value.strip('"') for key, value in re.findall(r'(\w+)=("[^"]*"|\S+)', text)}


def options_of(doc, rounds, seconds):
    """A parser with the options that every race has; `rounds` and `seconds` are their defaults (None: it has no rounds)."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release/bench", help="the folder with the bench programs")
    if rounds:
        parser.add_argument("--rounds", type=int, default=rounds, help="turns; the least time of all counts")
    parser.add_argument("--seconds", type=float, default=seconds, help="of drawing, in each turn")
    return parser


class Programs:
    """The bench programs of one build."""

    def __init__(self, folder, seconds):
        self.folder, self.seconds, self.scales = folder, seconds, {}

    def has(self, name):
        return os.path.exists(os.path.join(self.folder, name))

    def run(self, name, **options):
        command = [os.path.join(self.folder, name)]
        for key, value in options.items():
            command += ["--" + key, str(value)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{' '.join(command)}\n{done.stderr.strip()}")
        return parse(done.stdout)

    def scale(self, scene):
        """The scale that covers half of view 0, searched once per scene."""
        key = tuple(scene.get(k) for k in ("model", "copies", "size"))
        if key not in self.scales:
            chosen = {k: v for k, v in scene.items() if k in ("model", "copies", "size")}
            self.scales[key] = self.run("limn_bench_frames", seconds=0, poses=1, **chosen)["scale"]
        return self.scales[key]

    def frames(self, name, scene, **more):
        options = dict(poses=8, seconds=self.seconds, threads=2, scale=self.scale(scene)) | scene | more
        return self.run(name, **options)

    def least(self, scene, variants, rounds):
        """What limn_bench_frames prints for each of `variants` (its options), drawn in turns: the run with the least min_ms."""
        best = [None] * len(variants)
        for _ in range(rounds):
            for i, options in enumerate(variants):
                seen = self.frames("limn_bench_frames", scene, **options)
                if best[i] is None or float(seen["min_ms"]) < float(best[i]["min_ms"]):
                    best[i] = seen
        return best


class Side:
    """One of the two timed alternately: a program, what it draws, and the least time seen."""

    def __init__(self, program, scene, **more):
        self.program, self.scene, self.more = program, scene, more
        self.best, self.last = float("inf"), {}

    def measure(self, programs):
        self.last = programs.frames(self.program, self.scene, **self.more)
        self.best = min(self.best, float(self.last["min_ms"]))


class Row:
    """A ratio of two times, `slow` over `fast`, and what it should be."""

    def __init__(self, name, slow, fast, goal, at_least=True, compare=False):
        self.name, self.slow, self.fast, self.goal = name, slow, fast, goal
        self.at_least, self.compare, self.note = at_least, compare, ""

    def needs_peer(self):
        return "limn_peer" in (self.slow.program, self.fast.program)

    def check_pictures(self, programs):
        with tempfile.TemporaryDirectory() as folder:
            picture = os.path.join(folder, "limn.png")
            quick = dict(seconds=0, poses=1)
            programs.frames("limn_bench_frames", self.fast.scene, dump=picture, **self.fast.more | quick)
            seen = programs.frames("limn_peer", self.slow.scene, against=picture, **self.slow.more | quick)
        self.note = f"colours {seen['mean_difference']}/255 apart, {seen['covered_by_one']} px at edges"

    def ratio(self):
        return self.slow.best / self.fast.best

    def cells(self):
        ratio = self.ratio()
        met = ratio >= self.goal if self.at_least else ratio <= self.goal
        sign = "≥" if self.at_least else "≤"
        return [self.name, f"{self.slow.best:.3f}", f"{self.fast.best:.3f}", f"{ratio:.2f}", f"{sign} {self.goal:g}",
                "yes" if met else "**no**", self.note]


def limn(scene, **more):
    return Side("limn_bench_frames", scene, **more)


def peer(scene, **more):
    return Side("limn_peer", scene, **more)


def table():
    grids = {model: dict(model=model, copies=60, size="1280x800") for model in MODELS}
    for model, scene in grids.items():
        yield Row(f"llvmpipe / limn: 60 × {model}", peer(scene), limn(scene), 8, compare=True)
    for size in ("1280x800", "1920x1080"):
        for model in MODELS:
            scene = dict(model=model, copies=1, size=size)
            yield Row(f"llvmpipe / limn: one {model}, {size}", peer(scene), limn(scene), 8, compare=True)
    scene = dict(model=LARGE, copies=1, size="1280x800")
    yield Row("llvmpipe / limn: 1,310,720 triangles", peer(scene), limn(scene), 20, compare=True)
    scene = grids[MODELS[0]]
    yield Row("llvmpipe / limn: textured, 60 × icosphere-320", peer(scene, texture=1), limn(scene, texture=1), 8,
              compare=True)
    for samples in (4, 8):
        yield Row(f"{samples} samples / 1: 60 × icosphere-320", limn(scene, samples=samples), limn(scene), 2,
                  at_least=False)
    for model in (MODELS[0], LARGE):
        scene = grids.get(model, dict(model=LARGE, copies=1, size="1280x800"))
        yield Row(f"1 thread / 2: {'60 × ' if model in grids else 'one '}{model}", limn(scene, threads=1), limn(scene),
                  1.9)
    for model, scene in grids.items():
        for tolerance, goal in ((0.5, 1.10), (0.1, 1.25)):
            yield Row(f"smooth at {tolerance} px / flat: 60 × {model}",
                      limn(scene, method="patches", tolerance=tolerance), limn(scene), goal, at_least=False)
    for model, scene in grids.items():
        yield Row(f"llvmpipe PN 9× / limn smooth at 0.5 px: 60 × {model}", peer(scene, level=3),
                  limn(scene, method="patches", tolerance=0.5), 25)


def main():
    parser = options_of(__doc__, rounds=5, seconds=0.4)
    parser.add_argument("rows", nargs="*", metavar="ROW")
    parser.add_argument("--json")
    arguments = parser.parse_args()
    programs = Programs(arguments.build, arguments.seconds)
    rows = [row for number, row in enumerate(table(), 1)
            if not arguments.rows or any(r == str(number) or (not r.isdigit() and r in row.name) for r in arguments.rows)]
    if not programs.has("limn_peer"):
        print("The peer is not built (cmake --preset release -D LIMN_BUILD_PEER=ON): its rows are left out.\n")
        rows = [row for row in rows if not row.needs_peer()]

    limits = programs.run("limn_bench_limits")
    for row in rows:
        if row.compare:
            row.check_pictures(programs)
    for _ in range(arguments.rounds):
        for row in rows:
            for side in (row.slow, row.fast):
                side.measure(programs)

    print("| what | ms | ms | ratio | goal | met | pictures |\n|---|---:|---:|---:|---:|---|---|")
    for row in rows:
        print("| " + " | ".join(row.cells()) + " |")
    frames = [side for row in rows for side in (row.slow, row.fast) if side.program == "limn_bench_frames"]
    allocations = max((float(side.last["allocs_per_frame"]) for side in frames), default=0.0)
    bound = float(limits["bound_ms"])
    print(f"\nHeap allocations per frame, the largest of all rows: {allocations:g}. Two threads gain "
          f"{limits['gain_arithmetic']} in pure arithmetic, {limits['gain_fill']} in filling memory.")
    first = dict(model=MODELS[0], copies=60, size="1280x800")
    flat = min((side.best for side in frames if side.scene == first and not side.more), default=None)
    if flat:
        print(f"Lower bound of a frame of 60 × {MODELS[0]}: {bound:.3f} ms; limn takes {flat / bound:.2f} × that.")
    if arguments.json:
        results = [dict(name=row.name, slow_ms=row.slow.best, fast_ms=row.fast.best, ratio=row.ratio(), goal=row.goal,
                        note=row.note, slow=row.slow.last, fast=row.fast.last) for row in rows]
        with open(arguments.json, "w", encoding="utf-8") as file:
            json.dump(dict(rows=results, limits=limits), file, indent=1)


if __name__ == "__main__":
    main()
