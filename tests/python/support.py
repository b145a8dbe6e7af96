"""What the tests of the package share."""
import functools
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest

import meniscus

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else None
CASE = ROOT / "cases" / "two_arm" / "case.toml"
STRUTS = ROOT / "tests" / "support" / "struts.toml"
PETALS = ROOT / "tests" / "support" / "petals.toml"
# About a thousand elements, a tenth of a second each.
COARSE = {"resolution.fea": 24.0, "resolution.film": 12.0}


@functools.cache
def bracket():
    return meniscus.read_case(CASE, COARSE)


@functools.cache
def model():
    return meniscus.Model(bracket())


def strut_tree(study):
    """The first strut of the family, with a study of its own."""
    tree = tomllib.loads(STRUTS.read_text())
    tree["resolution"] = {"fea": 9.0, "film": 4.5}
    tree["study"] = study
    return tree


class PackageTest(unittest.TestCase):
    def folder(self):
        path = pathlib.Path(tempfile.mkdtemp(prefix="meniscus python ü "))
        self.addCleanup(shutil.rmtree, path, ignore_errors=True)
        return path

    def run_program(self, *arguments):
        done = subprocess.run([str(PROGRAM), *map(str, arguments)],
                              capture_output=True, text=True, timeout=200,
                              env=dict(os.environ))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
