#!/usr/bin/env python3
"""Pictures per second into files: limn, and what people do without it.

    cmake --preset release -D LIMN_BUILD_PEER=ON && cmake --build --preset release
    bench/disk.py [--build build/release] [--frames 60] [--rounds 3] [--size 1280x800] [--json FILE]

One torus of 576 triangles that turns, RGBA, in a folder of /tmp. Every row is the best of the rounds, which go through all rows
by turns; start and end of the processes count (F3D's needs an X server of its own, whose start counts as well). Rows whose programs are not there are left out: llvmpipe needs limn_peer
and OSMesa, F3D the packages f3d and xvfb. Prints a Markdown table.
"""
import argparse
import json
import os
import shutil
import subprocess
import tempfile
import time

MODEL = "builtin:torus-576"


class Bench:
    def __init__(self, build, frames, size, folder):
        self.limn, self.frames, self.size, self.folder = os.path.join(build, "apps", "limn"), frames, size, folder
        self.png, self.peer = (os.path.join(build, "bench", name) for name in ("limn_png", "limn_peer"))
        self.glb = os.path.join(folder, "torus.glb")
        subprocess.run([self.limn, "refine", MODEL, "-o", self.glb, "--method", "flat"], check=True)

    def output(self):
        out = os.path.join(self.folder, "out")
        shutil.rmtree(out, ignore_errors=True)
        os.makedirs(out)
        return out

    def render(self, *options, frames=None, output="%04d.png"):
        return [self.limn, "render", MODEL, "--size", self.size, "--turntable", str(frames or self.frames), "--quiet", "-o",
                output, *options]

    def run(self, command, writer=None):
        """Seconds of one command in an empty folder, its output piped into a writer of PNG files."""
        out, start = self.output(), time.monotonic()
        first = subprocess.Popen(command, cwd=out, stdout=subprocess.PIPE if writer else subprocess.DEVNULL,
                                 stderr=subprocess.DEVNULL)
        if writer:
            subprocess.run([self.png, writer, self.size, out], stdin=first.stdout, check=True)
        if first.wait() != 0:
            raise RuntimeError(" ".join(command))
        return time.monotonic() - start, out

    def piped(self, writer):
        return self.run(self.render("--format", "rgba", output="-"), writer)

    def llvmpipe(self, writer):
        return self.run([self.peer, "--model", "torus-576", "--copies", "1", "--size", self.size, "--coverage", "0.3",
                         "--threads", "2", "--poses", "24", "--raw", str(self.frames)], writer)

    def each(self, *command):
        """Seconds that so many pictures would take with a process for each, from a few of them."""
        few, out, start = 3, self.output(), time.monotonic()
        for k in range(few):
            subprocess.run([*command[:-1], command[-1] % k], cwd=out, check=True, stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL)
        return (time.monotonic() - start) * self.frames / few, out

    def rows(self):
        limn = [self.limn, "render", MODEL, "--size", self.size, "--quiet", "-o", "%d.png"]
        rows = {
            "limn": lambda: self.run(self.render()),
            "limn, drawn flat": lambda: self.run(self.render("--method", "flat")),
            "limn, one thread: drawn, encoded, written one after the other": lambda: self.run(self.render("--threads", "1")),
            "drawn by limn, written by libpng": lambda: self.piped("libpng"),
            "drawn by limn, written by stb_image_write": lambda: self.piped("stb"),
            "limn --compress 2": lambda: self.run(self.render("--compress", "2")),
            "limn, a process for each picture": lambda: self.each(*limn),
        }
        if os.path.exists(self.peer):
            rows["llvmpipe, written by libpng"] = lambda: self.llvmpipe("libpng")
        if shutil.which("f3d") and shutil.which("xvfb-run"):
            rows["F3D, a process for each picture"] = lambda: self.each(
                "xvfb-run", "-a", "-s", "-screen 0 1920x1200x24", "f3d", self.glb, "--resolution",
                self.size.replace("x", ","), "--dry-run", "--no-background", "--output=%d.png")
        return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--size", default="1280x800")
    parser.add_argument("--json")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(os.path.abspath(arguments.build), arguments.frames, arguments.size, folder)
        best, sizes, rows = {}, {}, bench.rows()
        for _ in range(arguments.rounds):
            for name, row in rows.items():
                seconds, out = row()
                files = [os.path.getsize(os.path.join(out, file)) for file in os.listdir(out)]
                best[name], sizes[name] = min(seconds, best.get(name, seconds)), sum(files) / len(files)
    table = [dict(what=name, frames_per_second=round(arguments.frames / best[name], 2),
                  kib_per_picture=round(sizes[name] / 1024, 1), limn_is_faster=round(best[name] / best["limn"], 2))
             for name in rows]
    print(f"| {arguments.size}, {arguments.frames} frames | frames per second | KiB per picture | time over limn's |\n|---|---:|---:|---:|")
    for row in table:
        print("| {what} | {frames_per_second} | {kib_per_picture} | {limn_is_faster} |".format(**row))
    if arguments.json:
        with open(arguments.json, "w", encoding="utf-8") as file:
            json.dump(table, file, indent=1)


if __name__ == "__main__":
    main()
