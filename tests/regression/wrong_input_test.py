#!/usr/bin/env python3
"""What goes wrong ends with the right exit code, names the place and leaves no
half-written file."""
import os
import re
import shutil
import subprocess
import unittest

import program
from program import COARSE, ProgramTest


class WrongCase(ProgramTest):
    """Found before any work starts: exit 2, case.toml:LINE, no results."""

    def refuse(self, path, line, *patterns):
        done = self.expect(
            self.call("run", path, "--out", "out", *COARSE), 2, *patterns)
        self.assertRegex(done.stderr, rf"case\.toml:{line}\b")
        self.assertFalse((self.folder / "out" / "result.json").exists())
        checked = self.call("check", path)
        self.assertEqual(checked.returncode, 2)

    def test_missing_key(self):
        path = self.write_case((r"^radius = 35.*\n", ""))
        self.refuse(path, self.line_of(path, r"^\[curves\.support\]"),
                    "radius")

    def test_misspelt_key(self):
        path = self.write_case((r"^radius = 35", "raduis = 35"))
        self.refuse(path, self.line_of(path, "raduis"), "raduis", "radius")

    def test_wrong_type(self):
        path = self.write_case((r"^radius = 35", "radius = [35]"))
        self.refuse(path, self.line_of(path, r"radius = \[35\]"), "radius")

    def test_list_where_a_name_is_asked(self):
        path = self.write_case((r"^\[study\]", "[responses.most]\n"
                                "kind = \"envelope\"\n"
                                "of = [\"left_deflection\"]\n\n[study]"))
        self.refuse(path, self.line_of(path, r"of = \[\"left"), "most.of",
                    "text")

    def test_unknown_name_in_expression(self):
        path = self.write_case((r'"support_x"', '"suport_x"'))
        self.refuse(path, self.line_of(path, '"suport_x"'), "suport_x",
                    "support_x")

    def test_expression_divides_by_zero(self):
        path = self.write_case((r"^radius = 35", 'radius = "35/support_x"'))
        self.refuse(path, self.line_of(path, "35/support_x"),
                    "(?i)zero|finite")

    def test_zero_radius(self):
        path = self.write_case((r"^radius = 35", "radius = 0"))
        self.refuse(path, self.line_of(path, r"^(\[curves\.support\]|radius = 0)"),
                    "support")

    def test_bounds_upside_down(self):
        path = self.write_case((r"^bounds = .*", "bounds = [40.0, -40.0]"))
        self.refuse(path, self.line_of(path, "^bounds"), "bounds")

    def test_open_body(self):
        path = self.write_case(
            (r'^enclosed_by = .*',
             'enclosed_by = ["skin", "support_pad", "left_pad"]'))
        self.refuse(path, r"\d+", "(?i)part.*(clos|open)", "right")

    def test_no_support(self):
        path = self.write_case((r"^supports = .*\n", ""))
        self.refuse(path, r"\d+", "support")

    def test_no_load(self):
        path = self.write_case((r"(?s)^loads = .*?\n\]\n|^loads = .*\n", ""))
        self.refuse(path, r"\d+", "load")

    def test_load_on_unknown_surface(self):
        path = self.write_case((r'on = "left_pad", force', 'on = "left_lid", force'))
        self.refuse(path, self.line_of(path, "left_lid"), "left_lid",
                    "left_pad")

    def test_broken_toml(self):
        path = self.write_case((r"^radius = 35", "radius = = 35"))
        self.refuse(path, self.line_of(path, "radius = = 35"))

    def test_missing_file(self):
        self.expect(self.call("run", "nowhere.toml"), 2, "nowhere.toml")

    def test_folder_instead_of_file(self):
        self.expect(self.call("run", self.folder), 2, "folder|directory")

    def test_unknown_override(self):
        self.expect(self.call("run", program.CASE, "--set", "load_lefd=1"), 2,
                    "load_lefd", "load_left")

    def test_unknown_option(self):
        self.expect(self.call("run", program.CASE, "--frobnicate"), 2)

    def test_unknown_method(self):
        self.expect(self.call("run", program.CASE, "--set",
                              "study.method=magic", *COARSE), 2, "magic",
                    "ceres")


class NoSolution(ProgramTest):
    """Found by computing: exit 3, the reason, a result file that says so."""

    def fail_with(self, path, *patterns, arguments=()):
        out = self.folder / "out"
        self.expect(self.call("run", path, "--out", out, "--no-pictures",
                              *COARSE, *arguments), 3, *patterns)
        result = self.result(out)
        self.assertIn(result["status"], ("infeasible", "failed"))
        for pattern in patterns:
            self.assertRegex(result["message"], pattern)
        self.assert_no_half_files(out)

    def test_arms_too_slender(self):
        # Arms of 250 with rings of 22: far past pi times the ring's radius.
        path = self.write_case(
            (r"center = \[-120, 0, 72\]", "center = [-250, 0, 150]"),
            (r"center = \[120, 0, 72\]", "center = [250, 0, 150]"),
            (r"(?s)radius = 50(.*?)radius = 50", r"radius = 22\1radius = 22"),
            (r"radius = 35", "radius = 22"),
            (r"volume = 1\.7e6", "volume = 8.5e5"))
        self.fail_with(path, r"(?i)pinch|unstable|neck", r"\(.*,.*,.*\)",
                       r"(?i)volume|shorter|larger")

    def test_surface_crosses_itself(self):
        # A peg with its own chamber that runs into the bracket.
        path = self.write_case()
        path.write_text(path.read_text() + """
[curves.outer]
kind = "circle"
center = [0, 80, 60]
normal = [0, 1, 0]
radius = 15

[curves.inner]
kind = "circle"
center = [0, 0, 60]
normal = [0, -1, 0]
radius = 15

[films.peg]
kind = "loft"
curves = ["outer", "inner"]

[solids.outer_pad]
kind = "cap"
curve = "outer"

[solids.inner_pad]
kind = "cap"
curve = "inner"

[bodies.peg_body]
enclosed_by = ["peg", "outer_pad", "inner_pad"]
volume = 5.6e4
material = "aluminium"
""")
        self.fail_with(path, r"facet \d+ \('skin'\).*facet \d+ \('peg'\)",
                       "must not meet but at their common edges",
                       arguments=["--set", "resolution.fea=8",
                                  "--set", "resolution.film=4"])

    def test_curve_off_the_hull(self):
        path = self.write_case((r"center = \[120, 0, 72\]",
                                "center = [-60, 0, 90]"))
        self.expect(self.call("run", path, "--no-pictures", *COARSE), 2,
                    "left|right", "hull")

    def test_too_weak_support(self):
        path = self.write_case((r'fix = "xyz"', 'fix = "z"'))
        done = self.call("run", path, "--out", "out", "--no-pictures", *COARSE)
        self.assertIn(done.returncode, (2, 3), done.stderr)
        self.assertRegex(done.stderr, "(?i)support")
        self.assertRegex(done.stderr, r"(?i)\bx\b|translat|rotat|slide|move")


class UnusableFolder(ProgramTest):
    def test_out_below_a_file(self):
        (self.folder / "file").write_text("kept")
        self.expect(self.call("run", program.CASE, "--out", "file/out",
                              *COARSE), 2, "file/out")
        self.assertEqual((self.folder / "file").read_text(), "kept")

    def test_full_disk(self):
        """A file-size limit stands for the disk where no tiny file system can
        be mounted: the write fails the same way, half way."""
        disk = self.folder / "disk"
        disk.mkdir()
        mount = subprocess.run(
            ["mount", "-t", "tmpfs", "-o", "size=160k", "tmpfs", str(disk)],
            capture_output=True, check=False)
        if mount.returncode == 0:
            self.addCleanup(subprocess.run, ["umount", "-l", str(disk)])
            done = self.call("run", program.CASE, "--out", disk / "out",
                             "--no-pictures", *COARSE)
        else:
            done = subprocess.run(
                ["bash", "-c", "trap '' XFSZ; ulimit -f 100; exec \"$@\"", "_",
                 str(program.PROGRAM), "run", str(program.CASE), "--out",
                 str(disk / "out"), "--no-pictures", *COARSE],
                capture_output=True, text=True, check=False)
        self.expect(done, 4, "(?i)space|full|too large")
        self.assert_no_half_files(disk)


class NoResults(ProgramTest):
    """Folders that are no results, or damaged ones: exit 2, the file named,
    before anything is computed, and nothing written."""

    def all_commands(self, folder, *patterns):
        before = self.listing()
        for command in (["report", folder], ["study", "show", folder],
                        ["study", "watch", folder, "--once"],
                        ["export", folder, "--format", "stl"],
                        ["export", folder, "--format", "step"],
                        ["compare", folder, "good", "--out", "compared"],
                        ["compare", "good", folder, "--out", "compared"]):
            done = self.expect(self.call(*command), 2, *patterns)
            self.assertNotIn("tetrahedra", done.stderr, command)
        self.assertEqual(self.listing(), before)

    def good(self):
        made, _ = program.once("good", lambda folder: self.expect(
            self.call("run", program.CASE, "--out", folder / "good",
                      "--no-pictures", *COARSE), 0))
        return shutil.copytree(made / "good", self.folder / "good")

    def listing(self):
        return {path: path.stat().st_mtime_ns
                for path in self.folder.rglob("*") if path.is_file()}

    def test_told_at_once(self):
        good = self.good()
        (self.folder / "empty").mkdir()
        foreign = self.folder / "foreign"
        foreign.mkdir()
        (foreign / "result.json").write_text("{}")
        self.all_commands("nowhere", "nowhere")
        self.all_commands("empty", "empty")
        self.all_commands("foreign", "foreign")
        damaged = self.folder / "damaged"
        shutil.copytree(good, damaged)
        for data in (b"no database", (good / "study.sqlite").read_bytes()[:5000]):
            (damaged / "study.sqlite").write_bytes(data)
            self.all_commands("damaged", "damaged/study.sqlite")

    def test_read_only_results(self):
        self.good()
        before = self.listing()
        for command in (["report", "good"],
                        ["export", "good", "--format", "stl"],
                        ["compare", "good", "good", "--out", "good/compared"],
                        ["study", "show", "good", "--csv", "good/table.csv"]):
            line = " ".join([str(program.PROGRAM), *command])
            done = subprocess.run(
                ["unshare", "-rm", "bash", "-c",
                 f"mount --bind good good && mount -o remount,ro,bind good "
                 f"|| exit 99; {line}"],
                cwd=self.folder, capture_output=True, text=True, check=False)
            if done.returncode == 99 or "unshare" in done.stderr:
                self.skipTest("no mounts here: " + done.stderr)
            self.expect(done, 2, "(?i)read-only")
        self.assertEqual(self.listing(), before)


class OddSurroundings(ProgramTest):
    def run_coarse(self, **options):
        out = self.folder / "ergebnis mit leerzeichen ä"
        self.expect(self.call("run", program.CASE, "--out", out,
                              "--no-pictures", *COARSE, **options), 0)
        return self.result(out)

    def test_comma_locale(self):
        plain = self.run_coarse()
        locales = self.folder / "locales"
        locales.mkdir()
        made = subprocess.run(
            ["localedef", "-i", "de_DE", "-f", "UTF-8",
             str(locales / "de_DE.UTF-8")], capture_output=True, check=False)
        self.assertTrue((locales / "de_DE.UTF-8").exists(), made.stderr)
        german = self.run_coarse(
            env={"LOCPATH": str(locales), "LC_ALL": "de_DE.UTF-8"})
        self.assertEqual(plain["responses"], german["responses"])

    def test_no_home(self):
        env = {k: v for k, v in os.environ.items() if k != "HOME"}
        done = subprocess.run(
            [str(program.PROGRAM), "run", str(program.CASE), "--out", "out",
             *COARSE], capture_output=True, text=True, cwd=self.folder,
            env=env, timeout=180, check=False)
        self.expect(done, 0)

    def test_path_with_spaces_and_umlauts(self):
        path = self.write_case(name="träger mit arm.toml")
        self.expect(self.call("run", path, "--no-pictures", *COARSE), 0)
        results = list((self.folder / "results").iterdir())
        self.assertEqual(len(results), 1)
        self.assertTrue((results[0] / "result.json").exists())

    def test_two_runs_into_one_folder(self):
        first = self.start("run", program.CASE, "--out", "out",
                           "--no-pictures", "--set", "resolution.fea=16",
                           "--set", "resolution.film=8")
        try:
            while not (self.folder / "out" / "study.sqlite").exists():
                self.assertIsNone(first.poll(), "first run ended too early")
            second = self.call("run", program.CASE, "--out", "out", *COARSE)
            self.expect(second, 2, "(?i)another|running|use")
        finally:
            output = first.communicate(timeout=180)
        self.assertEqual(first.returncode, 0, output)


if __name__ == "__main__":
    unittest.main(verbosity=2)
