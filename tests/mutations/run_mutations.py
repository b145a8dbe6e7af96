#!/usr/bin/env python3
"""Whole commands on randomly damaged files. None may end by a signal, take 20 s
or 1 GB, or end with exit 4, which says that the machine is at fault."""
import argparse
import concurrent.futures
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

import mutations

# The program would start itself anew for it, which doubles what a short command
# takes.
os.environ.setdefault("OMP_WAIT_POLICY", "passive")
os.environ.setdefault("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1")

ROOT = pathlib.Path(__file__).resolve().parents[2]
CASES = ROOT / "cases"
CORPUS = ROOT / "tests" / "fuzz" / "corpus"
SECONDS = 20.0  # of a command, wall clock
ASKED = 10.0    # [s] then it is asked to stop
BYTES = 1 << 30  # resident, of any process
# Address space: libraries, threads' stacks and OpenBLAS's buffer beside it.
SPACE = 5 << 29
GOOD = (0, 1, 2, 3, 130)

# Coarse enough for a second or two each.
SIZES = {
    "bracket_vs_solid/case.toml": "resolution.fea=12",
    "casting/case.toml": "resolution.fea=16",
    "constant_mean_curvature/case.toml": "resolution.fea=0.3",
    "stepped_shaft/case.toml": "resolution.fea=8",
    "strut_family/case.toml": "resolution.fea=12",
    "talus/case.toml": "resolution.fea=8",
    "two_arm/case.toml": "resolution.fea=20 resolution.film=10",
    "two_arm_sized/case.toml": "resolution.fea=20 resolution.film=10",
}


def sizes_of(case):
    return [word for size in SIZES[case].split() for word in ("--set", size)]


class Bases:
    """Sound files, made once: a run, and parts of it in every format."""

    def __init__(self, program, folder):
        self.run = folder / "run"
        case = "two_arm/case.toml"
        subprocess.run(
            [program, "run", CASES / case, "--out", self.run, "--no-pictures",
             "--no-frames", "--export", "step", "--export", "stl", "--export",
             "obj", "--export", "inp", *sizes_of(case)], check=True, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        self.parts = sorted(path for path in self.run.iterdir()
                            if path.suffix in (".step", ".stl", ".obj"))
        assert {path.suffix for path in self.parts} == {
            ".step", ".stl", ".obj"}, self.parts
        self.decks = [*self.run.glob("*.inp"),
                      *sorted((CORPUS / "deck").glob("*.inp"))]
        assert len(self.decks) > 2, self.decks
        self.datafiles = [CASES / "cube_to_sphere" / "cube.fe",
                          *sorted((CORPUS / "fe").glob("*.fe"))]
        self.results = ["result.json", "part.vtu", "film.vtp", "study.sqlite",
                        "history.csv", "part_surface.vtp"]


def of_case(choice, folder, bases):
    case = choice.choice(sorted(SIZES))
    source = CASES / case
    for path in source.parent.glob("*"):
        if path.suffix in (".csv", ".toml"):
            shutil.copy(path, folder)
    target = folder / source.name
    target.write_bytes(
        mutations.mutate(choice, source.read_bytes(), "toml"))
    command = choice.choice(("check", "check", "evolve", "evolve", "run"))
    if command == "check":
        return ["check", target]
    if command == "run" and case.startswith("strut_family"):
        command = "evolve"
    more = {"run": ["--no-frames", "--no-report", "--time-limit", "8"],
            "evolve": []}
    return [command, target, "--out", folder / "out", "--no-pictures",
            *sizes_of(case), *more[command]]


def of_datafile(choice, folder, bases):
    source = choice.choice(bases.datafiles)
    target = folder / "film.fe"
    target.write_bytes(mutations.mutate(choice, source.read_bytes(), "text"))
    options = choice.choice(
        ([], [], ["--script"], ["--method", "gradient", "--refine", "1"],
         ["--method", "conjugate_gradients", "--refine", "1"], ["--pop"]))
    return ["evolve", target, "--out", folder / "out", "--no-pictures",
            *options]


def of_curve(choice, folder, bases):
    """A STEP or csv file that a case's curve comes from."""
    text = (CASES / "two_arm" / "case.toml").read_text()
    circle = text[text.index('kind = "circle"'):text.index("[curves.left]")]
    if choice.randrange(3) > 0:
        source = next(p for p in bases.parts if p.suffix == ".step").read_bytes()
        file = "curve.step"
        keys = choice.choice(('face = "support_pad"', 'face = "left_pad"',
                              f"edge = {choice.randint(1, 6)}"))
        data = mutations.mutate(choice, source, "text")
    else:
        rows = [f"{35 * c:.6f},{35 * s:.6f},0" for c, s in (
            (1, 0), (.924, .383), (.707, .707), (.383, .924), (0, 1),
            (-.383, .924), (-.707, .707), (-.924, .383), (-1, 0),
            (-.707, -.707), (0, -1), (.707, -.707))]
        file, keys = "curve.csv", 'as = "spline"'
        data = mutations.mutate(
            choice, ("x,y,z\n" + "\n".join(rows) + "\n").encode(), "text")
    (folder / file).write_bytes(data)
    target = folder / "case.toml"
    target.write_text(
        text.replace(circle,
                     f'kind = "file"\nfile = "{file}"\n{keys}\n\n'))
    if choice.randrange(2):
        return ["check", target]
    return ["evolve", target, "--out", folder / "out", "--no-pictures",
            *sizes_of("two_arm/case.toml")]


def of_part(choice, folder, bases):
    source = choice.choice(bases.parts)
    target = folder / ("part" + source.suffix)
    data = source.read_bytes()
    binary = source.suffix == ".stl" and b"\0" in data
    target.write_bytes(
        mutations.mutate(choice, data, "binary" if binary else "text"))
    return ["compare", bases.run, target]


def of_deck(choice, folder, bases):
    source = choice.choice(bases.decks)
    target = folder / "part.inp"
    target.write_bytes(mutations.mutate(choice, source.read_bytes(), "text"))
    if source.stem == "part" and choice.randrange(4) == 0:
        return ["compare", bases.run, target]
    return ["solve", target, "--out", folder / "out"]


def of_results(choice, folder, bases):
    out = folder / "out"
    shutil.copytree(bases.run, out)
    there = [name for name in bases.results if (out / name).exists()]
    path = out / choice.choice(there)
    kind = "text" if path.suffix in (".json", ".csv") else "binary"
    path.write_bytes(mutations.mutate(choice, path.read_bytes(), kind))
    return choice.choice((
        ["report", out], ["report", out], ["study", "show", out],
        ["compare", bases.run, out],
        ["run", CASES / "two_arm" / "case.toml", "--out", out, "--resume",
         "--no-pictures", *sizes_of("two_arm/case.toml")]))


def of_toml(choice, folder, bases):
    case = choice.choice(sorted(SIZES))
    source = CASES / case
    for path in source.parent.glob("*.csv"):
        shutil.copy(path, folder)
    target = folder / source.name
    target.write_bytes(mutations.mutate(choice, source.read_bytes(), "toml"))
    return ["check", target]


def of_step(choice, folder, bases):
    source = next(p for p in bases.parts if p.suffix == ".step")
    target = folder / "part.step"
    target.write_bytes(mutations.mutate(choice, source.read_bytes(), "text"))
    return ["compare", bases.run, target]


def damaged_result(name, command):
    def make(choice, folder, bases):
        out = folder / "out"
        shutil.copytree(bases.run, out)
        path = out / name
        path.write_bytes(
            mutations.mutate(choice, path.read_bytes(), "binary"))
        return [*command, out]
    return make


KINDS = (of_case, of_case, of_case, of_case, of_datafile, of_curve, of_part,
         of_results, of_deck)
# For --kind: one reader each.
READERS = {"toml": of_toml, "step": of_step, "deck": of_deck,
           "vtu": damaged_result("part.vtu", ["report"]),
           "sqlite": damaged_result("study.sqlite", ["study", "show"])}


def limit():
    resource.setrlimit(resource.RLIMIT_AS, (SPACE, SPACE))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


class Outcome:
    def __init__(self, command, folder):
        begun = time.monotonic()
        with open(folder / "said", "wb") as said:
            child = subprocess.Popen(
                [str(word) for word in command], stdout=said, stderr=said,
                stdin=subprocess.DEVNULL, cwd=folder, preexec_fn=limit,
                start_new_session=True,
                env={**os.environ, "OMP_NUM_THREADS": "1"})
        asked = threading.Timer(ASKED, child.send_signal, (signal.SIGTERM,))
        ended = threading.Timer(2 * SECONDS, child.kill)
        asked.start()
        ended.start()
        _, status, usage = os.wait4(child.pid, 0)
        asked.cancel()
        ended.cancel()
        child.returncode = os.waitstatus_to_exitcode(status)
        self.code = child.returncode
        self.seconds = time.monotonic() - begun
        self.bytes = 1024 * usage.ru_maxrss
        self.said = (folder / "said").read_bytes()[-600:].decode(
            errors="replace")

    def problem(self):
        if self.code < 0:
            return f"ended by signal {-self.code}"
        if self.code not in GOOD:
            return f"exit {self.code}"
        if self.seconds > SECONDS:
            return f"took {self.seconds:.1f} s"
        if self.bytes > BYTES:
            return f"took {self.bytes / 1e9:.2f} GB"
        return ""


def run_one(program, kinds, seed, number, bases, work, keep):
    choice = mutations.chooser(seed, number)
    folder = work / str(number)
    folder.mkdir()
    command = [program, *choice.choice(kinds)(choice, folder, bases)]
    outcome = Outcome(command, folder)
    problem = outcome.problem()
    if problem and keep:
        shutil.copytree(folder, keep / str(number), dirs_exist_ok=True)
    shutil.rmtree(folder, ignore_errors=True)
    return number, problem, outcome, " ".join(str(word) for word in command)


def groups(arguments, begun):
    """Numbers in order, until the count or the time is reached."""
    size = 4 * arguments.jobs
    first = arguments.first
    while True:
        if arguments.seconds is None:
            size = min(size, arguments.first + arguments.count - first)
        elif time.monotonic() - begun > arguments.seconds:
            return
        if size <= 0:
            return
        yield range(first, first + size)
        first += size


def map_jobs(jobs, numbers, work):
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        yield from pool.map(work, numbers)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seconds", type=float,
                        help="begin none after so long, in place of --count")
    parser.add_argument("--seed", type=int, default=17)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--kind", choices=sorted(READERS),
                        help="one reader's files (default: whole cases)")
    parser.add_argument("--keep", type=pathlib.Path,
                        help="folder for the files of those that fail")
    arguments = parser.parse_args()
    program = arguments.program.resolve()
    kinds = [READERS[arguments.kind]] if arguments.kind else KINDS
    failed = done = 0
    codes = {}
    slowest = most = 0.0
    begun = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="meniscus-mutations-") as name:
        work = pathlib.Path(name)
        bases = Bases(program, work)
        for some in groups(arguments, begun):
            for number, problem, outcome, command in map_jobs(
                    arguments.jobs, some,
                    lambda n: run_one(program, kinds, arguments.seed, n, bases,
                                      work, arguments.keep)):
                done += 1
                codes[outcome.code] = codes.get(outcome.code, 0) + 1
                slowest = max(slowest, outcome.seconds)
                most = max(most, outcome.bytes)
                if problem:
                    failed += 1
                    print(f"mutation {number}: {problem}: {command}\n"
                          f"{outcome.said}\n", flush=True)
    ends = ", ".join(f"{count} x exit {code}"
                     for code, count in sorted(codes.items()))
    print(f"{done} mutations from {arguments.first} on, seed "
          f"{arguments.seed}, {failed} failed: {ends}; slowest {slowest:.1f} s, most {most / 1e6:.0f} MB, "
          f"{time.monotonic() - begun:.0f} s in all")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
