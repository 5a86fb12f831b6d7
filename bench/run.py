#!/usr/bin/env python3
"""All measures that fit into ten minutes: `make bench`.

    bench/run.py [--build build/release] [--results bench/results]

Writes for every measure NAME.json and NAME.csv (rows), NAME.txt (what it said on the way), machine.json, commands.json
(what repeats each result), the pictures of the trade and of the linear cost, and report.html, a page with all of it.
"""
import argparse
import csv
import glob
import json
import os
import platform
import shutil
import subprocess
import sys
import tempfile
import time

from report.build import build as build_report

BENCH = os.path.dirname(os.path.abspath(__file__))
SHOWN = ("sphere-200", "torus-576", "knot-480", "pawn", "cone-70")
MEASURED = ("flat", "patches", "curves")  # whose difference from the truth is drawn
METHODS = (*MEASURED, "pn")


def output(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True, cwd=os.path.dirname(BENCH)).stdout.strip()


def machine(build):
    """One row: what the figures were measured with and on."""
    with open(os.path.join(build, "CMakeCache.txt"), encoding="utf-8") as file:
        compiler = next(line.split("=", 1)[1].strip() for line in file if line.startswith("CMAKE_CXX_COMPILER:"))
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        cpu = next((line.split(": ", 1)[1].strip() for line in file if line.startswith("model name")), "unknown")
    return dict(cpu=cpu, threads=len(os.sched_getaffinity(0)), system=f"{platform.system()} {platform.machine()}",
                compiler=output(compiler, "--version").splitlines()[0], commit=output("git", "describe", "--always", "--dirty"),
                date_of_the_commit=output("git", "log", "-1", "--format=%cI"), load_at_start=os.getloadavg()[0])


class Run:
    """The measures of one build, into one folder."""

    def __init__(self, build, results):
        self.build, self.results = build, results
        self.start, self.rows, self.texts, self.pictures, self.commands = time.monotonic(), {}, {}, {}, []
        self.failed = []

    def say(self, text):
        print(f"limn bench {time.monotonic() - self.start:4.0f} s: {text}", file=sys.stderr)

    def file(self, name):
        return os.path.join(self.results, name)

    def program(self, name):
        return os.path.join(self.build, "bench", name)

    def command(self, name, *command):
        """Runs a measure; what it prints. A measure that fails is left out of the page, and said, and the run fails."""
        self.say(" ".join([os.path.basename(command[0]), *command[1:]]))
        done = subprocess.run(command, capture_output=True, text=True)
        with open(self.file(name + ".txt"), "w", encoding="utf-8") as file:
            file.write(done.stderr)
        if done.returncode != 0:
            self.say(f"{name} failed: {done.stderr.strip().splitlines()[-1:]}")
            self.failed.append(name)
            return None
        self.commands.append(dict(result=name, command=" ".join(command)))
        return done.stdout

    def keep(self, name, rows):
        """NAME.json, a row per line, and NAME.csv with a column for each key of the first row."""
        self.rows[name] = rows
        with open(self.file(name + ".json"), "w", encoding="utf-8") as file:
            file.write("[\n" + ",\n".join("  " + json.dumps(row) for row in rows) + "\n]\n")
        with open(self.file(name + ".csv"), "w", encoding="utf-8", newline="") as file:
            table = csv.DictWriter(file, fieldnames=list(rows[0]), extrasaction="ignore")
            table.writeheader()
            table.writerows(rows)

    def measure(self, name, *command):
        printed = self.command(name, *command)
        if printed:
            self.keep(name, json.loads(printed))

    def text(self, name, *command):
        """A measure whose result is a Markdown table."""
        printed = self.command(name, *command)
        if printed:
            self.texts[name] = printed
            with open(self.file(name + ".md"), "w", encoding="utf-8") as file:
                file.write(printed)
            print(printed)


def speed(run):
    folder = run.program("")
    run.text("race", os.path.join(BENCH, "race.py"), "--build", folder, "--rounds", "3", "--json", run.file("race.json"))
    run.text("linear", os.path.join(BENCH, "linear.py"), "--build", folder, "--picture",
             run.file("linear.svg"))
    run.text("disk", os.path.join(BENCH, "disk.py"), "--build", run.build, "--frames", "40", "--rounds", "2", "--json",
             run.file("disk.json"))
    run.measure("frames", os.path.join(BENCH, "frame_table.py"), "--build", folder)
    printed = run.command("microbench", run.program("limn_microbench"), "--benchmark_format=json",
                          "--benchmark_min_time=0.1")
    if printed:
        kept = ("name", "real_time", "time_unit", "items_per_second")
        run.keep("microbench", [{key: row.get(key, "") for key in kept} for row in json.loads(printed)["benchmarks"]])


def accuracy(run):
    measure = run.program("limn_measure")
    run.measure("stability", measure, "stability", "--quick")
    run.measure("trade", measure, "trade", "--quick", "--plot", run.results)
    run.measure("outline", measure, "outline", "--method", "flat,patches,curves,pn:4")
    run.measure("coherence", measure, "coherence", "--quick", "--size", "512",
                *(f"--model=builtin:{name}" for name in SHOWN[:3]))


def draw(run, folder):
    """The page's pictures: frames of every method, differences from the truth, plots."""
    limn, measure = os.path.join(run.build, "apps", "limn"), run.program("limn_measure")
    for model in SHOWN:
        for method in METHODS:
            picture = os.path.join(folder, f"{model}-{method}.png")
            subprocess.run([limn, "render", f"builtin:{model}", "--method", method, "--size", "900x900", "--background",
                            "#ffffff", "--quiet", "-o", picture], check=True)
            run.pictures[f"frame/{model}/{method}"] = picture
        subprocess.run([measure, "outline", "--model", f"builtin:{model}", "--method", ",".join(MEASURED), "--seed", "5",
                        "--views", "1", "--dump", folder], check=True, capture_output=True)
        for method in MEASURED:
            for picture in glob.glob(os.path.join(folder, f"builtin-{model}-{method}-*.png")):
                run.pictures[f"difference/{model}/{method}"] = picture
    for data in sorted(glob.glob(run.file("trade-*.dat"))):
        group = os.path.basename(data)[len("trade-"):-len(".dat")]
        subprocess.run(["gnuplot", "-e", f"dir='{run.results}'; group='{group}'", os.path.join(BENCH, "trade.gp")],
                       check=True)
        run.pictures[f"plot/{group} models/trade"] = run.file(f"trade-{group}.svg")
    if os.path.exists(run.file("linear.svg")):
        run.pictures["linear/time against triangles and pixels/cost"] = run.file("linear.svg")


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--build", default="build/release")
    arguments.add_argument("--results", default="bench/results")
    arguments = arguments.parse_args()
    shutil.rmtree(arguments.results, ignore_errors=True)
    os.makedirs(arguments.results)
    run = Run(arguments.build, arguments.results)
    run.keep("machine", [machine(run.build)])
    speed(run)
    accuracy(run)
    run.keep("commands", run.commands)
    with tempfile.TemporaryDirectory() as folder:
        run.say("pictures")
        draw(run, folder)
        build_report(run.file("report.html"), run.rows, run.texts, run.pictures)
    subprocess.run([os.path.join(BENCH, "report", "check.sh"), run.file("report.html")], check=True)
    disturbed = sum(row.get("disturbed") is True for rows in run.rows.values() for row in rows)
    if disturbed:
        run.say(f"warning: {disturbed} timings were disturbed by other work on this machine; they are marked in the tables")
    run.say(f"done: {run.file('report.html')}")
    if run.failed:
        sys.exit("not in the report, for they failed: " + ", ".join(run.failed))


if __name__ == "__main__":
    main()
