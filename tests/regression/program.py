"""Runs the program as a user would, for the tests in this folder."""
import atexit
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = (pathlib.Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 and
           "/" in sys.argv[1] else None)
CASE = ROOT / "cases" / "two_arm" / "case.toml"
# As the program sets them by starting itself anew (core/process_settings.h),
# which loads its libraries a second time: half of what a short command takes.
# hostile_test.py's test_threads_sleep_while_they_wait is about that.
os.environ.setdefault("OMP_WAIT_POLICY", "passive")
os.environ.setdefault("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1")
# About a thousand elements: the physics of the case in a second or two.
COARSE = ["--set", "resolution.fea=20", "--set", "resolution.film=10"]
# Set by regression.more.NAME, labelled long: a test with all of its draws.
MORE = os.environ.get("MENISCUS_MORE") == "1"


def some(draws, quick=1):
    """The first `quick` of them, all with MORE."""
    draws = list(draws)
    return draws if MORE else draws[:quick]


def more(test):
    """A test method of MORE alone: there is none of its name without."""
    return test if MORE else None


def strut(radius, length, foot):
    """Curves, film, caps and body of a strut; `foot` names the cap below."""
    return f"""
[curves.base]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, -1]
radius = {radius}

[curves.head]
kind = "circle"
center = [0, 0, {length}]
normal = [0, 0, 1]
radius = 20

[films.skin]
kind = "branch"
curves = ["base", "head"]

[solids.{foot}]
kind = "cap"
curve = "base"

[solids.top]
kind = "cap"
curve = "head"

[bodies.part]
enclosed_by = ["skin", "{foot}", "top"]
volume = 9e4
material = "aluminium"
"""


# About 2000 elements, 10 evaluations and gradients in under a second.
SIZED_STRUT = """title = "A strut sized to a deflection"
units = "mm-N-MPa"

[design.foot]
initial = 25.0
bounds = [20.0, 32.0]

[design.fill]
initial = 9e4
bounds = [7e4, 1.2e5]
""" + strut('"foot"', 60, "foot_pad").replace("volume = 9e4",
                                              'volume = "fill"') + """
[resolution]
fea = 8.0

[materials.aluminium]
youngs_modulus = 71700.0
poisson_ratio = 0.33
density = 2.8e-9

[load_cases.service]
supports = [{ on = "foot_pad", fix = "xyz" }]
loads = [{ on = "top", force = [1000, 0, 0] }]

[responses.sway]
kind = "mean_displacement"
on = "top"
direction = [1, 0, 0]

[responses.mass]
kind = "mass"

[analysis]
buckling = 0

[study]
kind = "minimize"
objective = "mass"
constraints = [{ response = "sway", max = 0.0075 }]
method = "mma"
"""


def without_pictures(arguments, pictures):
    """Arguments of the program, with --no-pictures where pictures are not asked
    for: those of one small part take longer than its run."""
    words = [str(word) for word in arguments]
    if (words[:1] not in (["run"], ["evolve"]) or pictures or
            {"--no-pictures", "--frame-pictures", "--help"} & set(words)):
        return words
    return [*words, "--no-pictures"]


_made = {}  # by name: what once() gave


def once(name, make):
    """make(folder) in an empty folder, for all tests of a script that begin with
    the same run: the folder and what make returned. To be read; a test that
    changes the folder takes a copy."""
    if name not in _made:
        folder = pathlib.Path(tempfile.mkdtemp(prefix="meniscus test ü "))
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
        _made[name] = folder, make(folder)
    return _made[name]


def without_seconds(value):
    """Of result.json: all that must not depend on the clock."""
    if isinstance(value, dict):
        return {key: without_seconds(item) for key, item in value.items()
                if "seconds" not in key}
    if isinstance(value, list):
        return [without_seconds(item) for item in value]
    return value


class ProgramTest(unittest.TestCase):
    """Each test gets an empty folder."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="meniscus test ü "))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def call(self, *arguments, env=None, timeout=120, pictures=False,
             **options):
        return subprocess.run(
            [str(PROGRAM), *without_pictures(arguments, pictures)],
            capture_output=True, text=True, timeout=timeout, cwd=self.folder,
            env={**os.environ, **(env or {})}, **options)

    def start(self, *arguments, pictures=False, **options):
        return subprocess.Popen(
            [str(PROGRAM), *without_pictures(arguments, pictures)],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            cwd=self.folder, **options)

    def case(self, text, name="case.toml"):
        """That text as a file."""
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def run_at(self, text, name="out", **options):
        """The result of a case of that text, in a folder of that name."""
        out = self.folder / name
        self.expect(self.call("run", self.case(text, name + ".toml"), "--out",
                              out, "--no-pictures", "--no-report", **options), 0)
        return self.result(out)

    def write_case(self, *replacements, name="case.toml"):
        """The two-arm case with text replaced; each pattern must be there."""
        text = CASE.read_text()
        for pattern, new in replacements:
            text, count = re.subn(pattern, new, text, count=1,
                                  flags=re.MULTILINE)
            self.assertEqual(count, 1, f"no {pattern!r} in {CASE}")
        path = self.folder / name
        path.write_text(text)
        return path

    def line_of(self, path, pattern):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if re.search(pattern, line):
                return number
        self.fail(f"no {pattern!r} in {path}")
        return 0

    def expect(self, done, code, *patterns):
        said = f"exit {done.returncode}\n{done.stdout}\n{done.stderr}"
        self.assertEqual(done.returncode, code, said)
        for pattern in patterns:
            self.assertRegex(done.stderr + done.stdout, pattern)
        return done

    def analyse_at(self, name, text, edge, film):
        """Its result at these edges; None where it fails."""
        case = self.folder / f"{name}.toml"
        case.write_text(text)
        out = self.folder / f"{name}_{edge:.3f}"
        done = self.call(
            "run", case, "--out", out, "--no-pictures", "--no-report",
            "--quiet", "--set", f"resolution.fea={edge:.6g}",
            "--set", f"resolution.film={film:.6g}")
        return self.result(out) if done.returncode == 0 else None

    def result(self, folder):
        return json.loads((folder / "result.json").read_text())

    def assert_no_half_files(self, folder):
        """Nothing temporary left; what is there can be read to its end."""
        for path in folder.rglob("*"):
            self.assertNotRegex(path.name, r"(\.tmp|\.part|~)$|^\.(?!lock)")
            if path.suffix == ".json":
                json.loads(path.read_text())
