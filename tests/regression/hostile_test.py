#!/usr/bin/env python3
"""What a hostile hand may give the program: an answer or a reason, in time and
within the machine's limits."""
import itertools
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import time
import unittest

import program
from program import CASE, COARSE, ProgramTest

sys.path.insert(0, str(program.ROOT / "tests" / "mutations"))
import mutations  # noqa: E402  (the folder is found only now)

# Of each kind of damage: MENISCUS_HOSTILE=1 tries two to eight times as many as
# every day.
ALL = os.environ.get("MENISCUS_HOSTILE") == "1"

# A triangle between three vertices; FIXED or nothing.
TRIANGLE = """{top}
vertices
1 0 0 0 fixed
2 1 0 0 fixed
3 0 1 0 fixed
4 0.3 0.3 0 {middle}
edges
1 1 2 fixed
2 2 3 fixed
3 3 1 fixed
4 1 4
5 2 4
6 3 4
faces
1 1 5 -4
2 2 6 -5
3 3 4 -6
{rest}"""


class Datafiles(ProgramTest):
    def evolve(self, text, code, *patterns, options=()):
        (self.folder / "film.fe").write_text(text)
        return self.expect(
            self.call("evolve", "film.fe", "--no-pictures", "--out", "out",
                      *options), code, *patterns)

    def still(self, rest=""):
        return TRIANGLE.format(top="", middle="fixed", rest=rest)

    def test_without_faces(self):
        text = "vertices\n1 0 0 0\n2 1 0 0\nedges\n1 1 2\nfaces\nread\n"
        self.evolve(text, 2, "no faces")

    def test_a_script_on_what_does_not_move(self):
        self.evolve(self.still("read\ngogo := { g 5; hessian; U; g 3; "
                               "print total_area }\n"),
                    0, "(?m)^0.5$", "nothing in it moves",
                    options=["--script"])

    def test_descents_of_what_does_not_move(self):
        for method in ("gradient", "conjugate_gradients", "newton"):
            self.evolve(self.still(), 2, "no vertex between its curves",
                        options=["--method", method, "--refine", "0"])

    def test_formulas_without_a_value(self):
        for formula, what in (("1/(x - x)", "division of 1 by zero"),
                              ("exp(846 + x)", "exp"),
                              ("log(x - 5)", "log")):
            for options in ([], ["--script"], ["--method", "gradient"]):
                text = TRIANGLE.format(
                    top="quantity q energy method facet_scalar_integral "
                        f"global scalar_integrand: {formula}",
                    middle="", rest="read\ngogo := { g 5; hessian }\n")
                said = self.evolve(text, 2, options=options)
                self.assertRegex(said.stderr, f"film.fe: .*{what}.* at \\(")

    def test_a_variable_that_is_no_number(self):
        self.evolve(TRIANGLE.format(top="", middle="", rest=(
            "read\nnn := 1e200\ngogo := { nn *= nn; nn *= nn }\n")), 2,
            r"film\.fe:\d+:\d+: 'nn' becomes inf", options=["--script"])

    def test_a_descent_is_kept_when_it_is_stopped(self):
        text = (program.ROOT / "cases/cube_to_sphere/cube.fe").read_text()
        (self.folder / "film.fe").write_text(text)
        running = self.start("evolve", "film.fe", "--no-pictures", "--out",
                             "out", "--method", "gradient", "--refine", "7")
        time.sleep(2.0)
        running.send_signal(signal.SIGTERM)
        begun = time.monotonic()
        _, said = running.communicate(timeout=60)
        self.assertEqual(running.returncode, 130, said)
        self.assertIn("kept as it was", said)
        self.assertLess(time.monotonic() - begun, 5.0)
        self.assertTrue((self.folder / "out" / "film.vtp").exists())


class Work(ProgramTest):
    """Bounded, told before it begins, and stopped within a second or so."""

    def far(self, distance):
        return self.write_case(
            (r"^center = \[-120, 0, 72\]", f"center = [-{distance}, 0, 72]"))

    def test_more_elements_than_memory_holds(self):
        for command in ("run", "evolve"):
            path = self.write_case(name="fine.toml")
            begun = time.monotonic()
            self.expect(
                self.call(command, path, "--out", "out", "--no-pictures",
                          "--set", "resolution.fea=0.02"), 2,
                "GB|memory holds")
            self.assertLess(time.monotonic() - begun, 10.0)

    def test_a_curve_in_the_next_town(self):
        for distance in ("1e7", "1e12", "1e300"):
            begun = time.monotonic()
            self.expect(
                self.call("evolve", self.far(distance), "--out", "out",
                          "--no-pictures"), 2)
            self.assertLess(time.monotonic() - begun, 15.0)

    def test_a_signal_while_the_film_is_groomed(self):
        path = self.far("120000")
        for command in ("run", "evolve"):
            running = self.start(command, path, "--out", f"out {command}",
                                 "--no-pictures")
            time.sleep(3.0)
            self.assertIsNone(running.poll())
            running.send_signal(signal.SIGTERM)
            begun = time.monotonic()
            _, said = running.communicate(timeout=60)
            self.assertEqual(running.returncode, 130, said)
            self.assertLess(time.monotonic() - begun, 3.0)
            self.assertNotIn("does not stop", said)

    def test_a_time_limit_while_the_film_is_groomed(self):
        begun = time.monotonic()
        done = self.expect(
            self.call("run", self.far("120000"), "--out", "out",
                      "--no-pictures", "--time-limit", "2"), 3,
            "the time limit of 2 s is over before a first design")
        self.assertLess(time.monotonic() - begun, 6.0, done.stderr)
        self.assertEqual(self.result(self.folder / "out")["status"],
                         "stopped")

    def test_two_films_over_the_same_curves(self):
        path = self.write_case((r"^\[solids\.support_pad\]", """[films.twin]
kind = "branch"
curves = ["support", "left", "right"]

[solids.support_pad]"""))
        for command in ("run", "evolve"):
            begun = time.monotonic()
            done = self.call(
                command, path, "--out", "out", "--no-pictures",
                "--set", "resolution.fea=16", "--set", "resolution.film=8",
                preexec_fn=lambda: resource.setrlimit(
                    resource.RLIMIT_AS, (3 << 30, 3 << 30)))
            self.assertIn(done.returncode, (2, 3), done.stderr)
            self.assertLess(time.monotonic() - begun, 60.0)

    def test_little_address_space(self):
        """OpenBLAS asks again and again for a buffer that it does not get."""
        spaces = (150, 200, 300, 370, 390, 500)
        threads_of = ("1", "2", None)
        cases = (itertools.product(spaces, threads_of) if ALL else
                 zip(spaces, itertools.cycle(threads_of)))
        for space, threads in cases:
            size = space << 20
            env = {**os.environ, **({"OMP_NUM_THREADS": threads} if threads
                                    else {})}
            with self.subTest(space=space, threads=threads):
                done = self.call(
                    "run", CASE, "--out", "out", "--no-pictures", *COARSE,
                    timeout=90, env=env,
                    preexec_fn=lambda size=size: resource.setrlimit(
                        resource.RLIMIT_AS, (size, size)))
                self.assertIn(done.returncode, (0, 2, 3, 4, 127), done.stderr)
                self.assertNotIn("libgomp", done.stderr)

    def test_blas_starts_no_threads_of_its_own(self):
        """They would ask for buffers before the program's first line."""
        size = 300 << 20
        done = self.call("--version", timeout=20,
                         preexec_fn=lambda: resource.setrlimit(
                             resource.RLIMIT_AS, (size, size)))
        self.expect(done, 0)

    def test_threads_sleep_while_they_wait(self):
        """The program starts itself anew for it, unless it is told how they
        wait; libgomp shows its settings each time it is loaded."""
        free = {key: value for key, value in os.environ.items()
                if key not in ("OMP_WAIT_POLICY", "GOMP_SPINCOUNT")}
        free["GLIBC_TUNABLES"] = ""
        for told, shown in (({}, ["300000", "0"]),
                            ({"OMP_WAIT_POLICY": "passive"}, ["0"]),
                            ({"OMP_WAIT_POLICY": "active"}, ["30000000000"]),
                            ({"GOMP_SPINCOUNT": "7"}, ["7"])):
            with self.subTest(told=told):
                done = subprocess.run(
                    [str(program.PROGRAM), "--version"], text=True, timeout=60,
                    env={**free, **told, "OMP_DISPLAY_ENV": "verbose"},
                    capture_output=True, check=True)
                self.assertEqual(re.findall(r"GOMP_SPINCOUNT = '(\d+)'",
                                            done.stderr), shown)

    def test_work_that_is_refused_leaves_the_earlier_answer(self):
        self.expect(self.call("run", CASE, "--out", "out", "--no-pictures",
                              *COARSE), 0)
        before = sorted(path.name for path in (self.folder / "out").iterdir())
        self.expect(self.call("run", CASE, "--out", "out", "--set",
                              "resolution.fea=0.02"), 2, "GB are free")
        self.assertEqual(sorted(path.name for path in
                                (self.folder / "out").iterdir()), before)


class Orphans(ProgramTest):
    """Helpers, the virtual display among them, end with a run that is killed."""

    def processes(self):
        mark = f"MENISCUS_TEST_MARK={self.folder}".encode()
        found = []
        for path in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                if mark in (path / "environ").read_bytes().split(b"\0"):
                    found.append((path / "cmdline").read_bytes())
            except OSError:
                pass
        return found

    def test_none_is_left(self):
        env = {**os.environ, "MENISCUS_TEST_MARK": str(self.folder)}
        begun = time.monotonic()
        whole = self.start("run", CASE, "--out", "whole", *COARSE, env=env,
                           pictures=True)
        helpers = set()
        while whole.poll() is None:
            helpers.update(line.split(b"\0")[0].split(b"/")[-1]
                           for line in self.processes())
            time.sleep(0.02)
        whole.communicate()
        length = time.monotonic() - begun
        self.assertIn(b"Xvfb", helpers)
        self.assertIn(b"meniscus-render", helpers)
        choice = random.Random(5)
        for number in range(12 if ALL else 3):
            running = self.start("run", CASE, "--out", f"out {number}",
                                 *COARSE, env=env, pictures=True)
            time.sleep(length * choice.uniform(0.05, 1.0))
            running.kill()
            running.communicate()
            until = time.monotonic() + 5.0
            while self.processes() and time.monotonic() < until:
                time.sleep(0.05)
            self.assertEqual(self.processes(), [], number)


class Files(ProgramTest):
    def run_once(self):
        made, _ = program.once("exported", lambda folder: self.expect(
            self.call("run", CASE, "--out", folder / "run", "--no-pictures",
                      "--no-frames", "--export", "stl", "--export", "obj",
                      "--export", "step", *COARSE), 0))
        return pathlib.Path(shutil.copytree(made / "run", self.folder / "run"))

    def limited(self, *arguments):
        """Under 3 GB of address space."""
        begun = time.monotonic()
        done = self.call(
            *arguments, preexec_fn=lambda: resource.setrlimit(
                resource.RLIMIT_AS, (3 << 30, 3 << 30)))
        self.assertLess(time.monotonic() - begun, 60.0)
        return done

    def part_of(self, run, suffix):
        return next(path for path in run.iterdir() if path.suffix == suffix)

    def test_a_wild_coordinate_is_named(self):
        run = self.run_once()
        obj = self.part_of(run, ".obj").read_text().split("\n")
        at = [k for k, line in enumerate(obj) if line.startswith("v ")][20]
        obj[at] = obj[at].rsplit(" ", 1)[0] + " 7e8"
        (self.folder / "wild.obj").write_text("\n".join(obj))
        self.expect(self.limited("compare", run, "wild.obj"), 2,
                    rf"wild\.obj:{at + 1}: the point \(.*7e\+08\)")
        stl = bytearray(self.part_of(run, ".stl").read_bytes())
        if not stl.startswith(b"solid"):
            stl[84 + 50 * 3 + 12:84 + 50 * 3 + 16] = struct.pack("<f", 7e8)
            (self.folder / "wild.stl").write_bytes(stl)
            self.expect(self.limited("compare", run, "wild.stl"), 2,
                        r"wild\.stl:facet 3: the point \(7e\+08")
        rows = ["x,y,z"] + [f"{k % 4},{k // 4},0" for k in range(16)]
        rows[9] = "1,2e7,0"
        (self.folder / "rim.csv").write_text("\n".join(rows))
        path = self.write_case(
            (r'kind = "circle"\ncenter = \["support_x", 0, 0\]\nnormal = '
             r'\[0, 0, -1\]\nradius = 35', 'kind = "file"\nfile = "rim.csv"\n'))
        self.expect(self.limited("check", path), 2,
                    r"rim\.csv:10: the point \(1, 2e\+07, 0\)")

    def test_a_damaged_step_file(self):
        """As found: OpenCASCADE ends its process on one in five. scripts/fuzz
        damages more."""
        run = self.run_once()
        step = self.part_of(run, ".step").read_bytes()
        choice = random.Random(17)
        for number in range(25):
            damaged = mutations.mutate(choice, step, "text")
            # One without a solid, one that ends OpenCASCADE's process, one with
            # a spike of twenty times the part.
            if not ALL and number not in (0, 3, 8):
                continue
            path = self.folder / f"part {number}.step"
            path.write_bytes(damaged)
            done = self.limited("compare", run, path)
            self.assertIn(done.returncode, (0, 2, 3),
                          f"{path}: {done.stderr}")

    def test_a_damaged_deck(self):
        """Refused by its line, or solved; tests/mutations damages more."""
        run = self.run_once()
        self.expect(self.call("export", run, "--format", "inp", "--out",
                              "own.inp"), 0)
        whole = (self.folder / "own.inp").read_bytes()
        decks = [whole[:len(whole) * k // 9] for k in range(1, 9)]
        choice = random.Random(23)
        for _ in range(40 if ALL else 8):
            decks.append(mutations.mutate(choice, whole, "text"))
        for number, data in enumerate(decks):
            path = self.folder / f"deck {number}.inp"
            path.write_bytes(data)
            done = self.limited("solve", path, "--out", "solved")
            self.assertIn(done.returncode, (0, 2, 3), done.stderr)
            if done.returncode == 2:
                self.assertRegex(done.stderr, rf"deck {number}\.inp:\d+: ")

    def test_damaged_results(self):
        run = self.run_once()
        whole = (run / "part.vtu").read_bytes()
        damaged = [whole[:len(whole) * k // 7] for k in range(1, 7)]
        damaged.append(whole.replace(b'NumberOfPoints="', b'NumberOfPoints="9', 1))
        damaged.append(whole.replace(b'NumberOfCells="', b'NumberOfCells="77', 1))
        damaged.append(whole.replace(b' offset="', b' offset="8', 3))
        # Bytes put in: what comes behind them is read from the wrong places.
        begin = whole.index(b"<AppendedData")
        for k in range(1, 10):
            cut = begin + k * (len(whole) - begin) // 10
            damaged.append(whole[:cut] + b"\0" * k + whole[cut:])
        for data in damaged if ALL else damaged[::2]:
            (run / "part.vtu").write_bytes(data)
            done = self.limited("report", run, "--no-pictures")
            self.assertIn(done.returncode, (0, 2), done.stderr)
            self.assertRegex(done.stderr + done.stdout, r"part\.vtu")


if __name__ == "__main__":
    unittest.main(verbosity=2)
