#!/usr/bin/env python3
"""Families: each member sized as when run alone, whatever the order, the jobs
and the interruptions; one table; wrong members told by line. And parts side by
side."""
import csv
import json
import os
import re
import shutil
import signal
import sqlite3
import struct
import time
import unittest

import program
from program import ProgramTest

STRUT = program.ROOT / "tests" / "support" / "struts.toml"
# Stout enough for a mesh of some 500 elements.
SMALL = ["--set", "resolution.fea=10", "--set", "resolution.film=5",
         "--set", "length=54", "--set", "load=5000"]
MEMBERS = """name,length,offset,load,fill.lower,fill.upper
short,48,8,5500,,
middle,54,8,5000,,
far,54,14,5000,,
long,60,8,4500,0.9,1.4
"""
# Both searches end where the first-order residual is below 1e-4, and each
# answer is judged on a mesh of its own: 8e-4 of the mass was seen between two
# such meshes of some 500 elements.
COLD = 3e-3


class Family(ProgramTest):
    def family(self, members=MEMBERS, *replacements):
        text = re.sub(r"(?s)\n\[study\.members.*", "\n", STRUT.read_text())
        text = text.replace('[study]\n', '[study]\nmembers = "members.csv"\n')
        for old, new in replacements:
            self.assertIn(old, text)
            text = text.replace(old, new)
        case = self.folder / "case.toml"
        case.write_text(text)
        (self.folder / "members.csv").write_text(members)
        return case

    def sized(self, case, name, code, *more):
        out = self.folder / name
        done = self.expect(
            self.call("run", case, *SMALL, "--no-pictures", "--out", out,
                      *more), code)
        return out, done

    def whole(self, name="out"):
        """The family of MEMBERS sized: its case, a folder of its results and how
        the run ended."""
        case = self.family()
        made, (_, done) = program.once(
            "family", lambda folder: self.sized(case, folder / "out", 0))
        return case, shutil.copytree(made / "out", self.folder / name), done

    def rows(self, out):
        with open(out / "family.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def numbers(self, out):
        """All that must have the same bits."""
        keep = ("name", "parent", "status", "message", "parameters", "design",
                "objective", "constraints", "responses", "evaluations")
        return json.dumps([{k: m[k] for k in keep}
                           for m in self.result(out)["members"]])

    def test_each_member_is_sized_as_alone_from_cold(self):
        case, out, done = self.whole()
        self.assertIn("4 of 4 members are sized", done.stdout)
        result = self.result(out)
        self.assertEqual(result["status"], "converged")
        members = {m["name"]: m for m in result["members"]}
        self.assertEqual(list(members), ["short", "middle", "far", "long"])
        # The tree: each but the first starts from the nearest answer.
        self.assertEqual([m["parent"] for m in members.values()],
                         ["", "short", "middle", "middle"])
        for row in csv.DictReader(MEMBERS.splitlines()):
            alone = [f"{k}={row[k]}" for k in ("length", "offset", "load")]
            if row["fill.lower"]:
                alone.append("design.fill.bounds=[0.9, 1.4]")
            cold, _ = self.sized(case, "cold " + row["name"], 0, *(
                word for text in ["study.kind=minimize", *alone]
                for word in ("--set", text)))
            member, single = members[row["name"]], self.result(cold)
            self.assertAlmostEqual(
                member["objective"] / single["objective"], 1, delta=COLD)
            self.assertLess(member["responses"]["deflection"], 0.1 + 1e-6)
            self.assertEqual(member["parameters"]["load"], float(row["load"]))
        for member in members.values():
            folder = out / member["folder"]
            for name in ("result.json", "study.sqlite", "history.csv",
                         "part.vtu", "film.vtp", "part_5.stl"):
                self.assertGreater((folder / name).stat().st_size, 300, name)
            own = self.result(folder)
            self.assertEqual(own["objective"], member["objective"])
            self.assertEqual(own["member"]["parent"], member["parent"])
        table = self.rows(out)
        self.assertEqual([float(row["mass"]) for row in table],
                         [m["objective"] for m in members.values()])
        self.expect(self.call("study", "show", out), 0, "middle  *converged")
        self.assert_no_half_files(out)
        # Side by side, and read again: the same bits.
        two, _ = self.sized(case, "two", 0, "--jobs", "2")
        self.assertEqual(self.numbers(out), self.numbers(two))
        for member in members.values():
            part = pathlib_part(member)
            self.assertEqual((out / part).read_bytes(),
                             (two / part).read_bytes())
        stamp = os.stat(out / "members/far/result.json").st_mtime_ns
        self.sized(case, "out", 0, "--resume")
        self.assertEqual(self.numbers(out), self.numbers(two))
        self.assertEqual(os.stat(out / "members/far/result.json").st_mtime_ns,
                         stamp)
        self.compare(out)

    def test_a_row_that_is_added_leaves_the_others_as_they_are(self):
        case, out, _ = self.whole()
        before = {m["name"]: m for m in self.result(out)["members"]}
        files = {name: (out / "members" / name / "result.json").read_bytes()
                 for name in before}
        # In the middle, nearer to `long` than its parent is; and a comment.
        rows = MEMBERS.splitlines(keepends=True)
        (self.folder / "members.csv").write_text(
            "".join(rows[:3] + ["between,57,8,4700,,\n"] + rows[3:]))
        case.write_text("# grown\n" + case.read_text())
        self.sized(case, "out", 0, "--resume")
        after = {m["name"]: m for m in self.result(out)["members"]}
        self.assertEqual(list(after), ["short", "middle", "between", "far",
                                       "long"])
        for name, member in before.items():
            self.assertEqual(after[name], member)
            self.assertEqual(
                (out / "members" / name / "result.json").read_bytes(),
                files[name])
        self.assertIn(after["between"]["parent"], before)
        self.assertEqual(after["between"]["status"], "converged")

    def test_a_format_that_a_member_lacks_is_told(self):
        case = self.family("name,length\none,48\ntwo,50\n",
                           ('each = "minimize"\nobjective = "mass"\n',
                            'each = "analyse"\n'),
                           ('method = "slsqp"\n', ""))
        case.write_text(re.sub(r"(?s)\nconstraints = \[.*?\n\]", "",
                               case.read_text()))
        out, _ = self.sized(case, "out", 0, "--export", "step")
        self.assertEqual(len(list((out / "members/two").glob("*.step"))), 1)
        # As a part whose film has no STEP leaves it.
        path = out / "members/two/result.json"
        result = json.loads(path.read_text())
        result["warnings"].append("not written as step: film 'skin': a patch")
        path.write_text(json.dumps(result))
        _, done = self.sized(case, "out", 0, "--export", "step", "--resume")
        self.assertIn("two: not written as step: film 'skin'",
                      done.stdout + done.stderr)
        self.assertIn("two: not written as step: film 'skin': a patch",
                      self.result(out)["warnings"])

    def compare(self, out):
        """Two members side by side; and a block of known stiffness."""
        there = self.folder / "sides"
        done = self.expect(
            self.call("compare", out / "members/short", out / "members/long",
                      "--out", there), 0, r"mass \[kg\]",
            r"push: stiffness \[N/mm\]")
        parts = json.loads((there / "compare.json").read_text())["parts"]
        for part, name in zip(parts, ("short", "long")):
            own = self.result(out / "members" / name)
            self.assertAlmostEqual(part["mass"] / own["responses"]["mass"], 1,
                                   10)
            peak = own["stress"]["push"]["max_von_mises"]
            self.assertAlmostEqual(
                part["load_cases"]["push"]["max_von_mises"] / peak, 1, 9)
            self.assertEqual(part["parts"], 1)
        self.assertGreater((there / "compare.csv").stat().st_size, 100)
        self.assertIn("written to", done.stdout)

    def test_a_member_that_cannot_be_sized_is_a_row(self):
        case = self.family("name,length,load,resolution.fea\n"
                           "good,48,5000,\n"
                           "weak,48,90000,\n"
                           "slender,190,3000,\n"
                           "other,50,5000,\n")
        out, done = self.sized(case, "out", 3)
        self.assertIn("2 of 4 members are sized; not weak (infeasible), "
                      "slender (failed)", done.stderr)
        rows = {row["member"]: row for row in self.rows(out)}
        self.assertIn("deflection", rows["weak"]["message"])
        self.assertIn("deflection", rows["weak"]["missed"])
        self.assertEqual(rows["good"]["missed"], "")
        self.assertGreater(float(rows["good"]["mass_error"]), 0)
        self.assertRegex(done.stdout, r"\d \+- \d")
        self.assertRegex(rows["slender"]["message"], "pinch|unstable|neck")
        self.assertEqual(rows["good"]["status"], "converged")
        self.assertEqual(rows["other"]["status"], "converged")
        self.assertEqual(self.result(out)["status"], "infeasible")

    def test_members_that_are_looked_at_only(self):
        case = self.family("name,length\none,48\n",
                           ('each = "minimize"\nobjective = "mass"\n',
                            'each = "analyse"\n'),
                           ('method = "slsqp"\n', ""))
        case.write_text(re.sub(r"(?s)\nconstraints = \[.*?\n\]", "",
                               case.read_text()))
        out, done = self.sized(case, "out", 0)
        self.assertIn("1 of 1 members are sized", done.stdout)
        self.assertIn("deflection [mm]", done.stdout)
        self.assertEqual(self.rows(out)[0]["objective"], "")
        self.assertIsNone(self.result(out)["members"][0]["objective"])

    def test_ctrl_c_then_resume_ends_with_the_same_bits(self):
        case, whole, _ = self.whole("whole")
        out = self.folder / "out"
        running = self.start("run", case, *SMALL, "--no-pictures", "--out",
                             out)
        last = out / "members" / "middle" / "study.sqlite"
        while running.poll() is None and self.evaluations(last) < 2:
            time.sleep(0.005)
        running.send_signal(signal.SIGINT)
        running.communicate(timeout=60)
        if running.returncode == 130:
            self.assertEqual(self.result(out)["status"], "interrupted")
            self.expect(self.call("study", "show", out), 0, "waiting")
        self.sized(case, "out", 0, "--resume", "--jobs", "2")
        self.assertEqual(self.numbers(whole), self.numbers(out))

    def evaluations(self, database):
        try:
            with sqlite3.connect(f"file:{database}?mode=ro",
                                 uri=True) as store:
                return store.execute(
                    "select count(*) from evaluation").fetchone()[0]
        except sqlite3.Error:
            return 0

    def test_no_time_is_told_by_member(self):
        out, done = self.sized(self.family(), "out", 3, "--time-limit",
                               "0.001")
        self.assertEqual(self.result(out)["status"], "stopped")
        self.assertIn("0 of 4 members", done.stderr)

    def test_wrong_members_are_told_by_line(self):
        head = "name,length,load\n"
        for members, told in (
                (head + "a,60,1\nb,60,x y\n", r"members.csv:3: member 'b'.*x y"),
                (head + "a,60,1\n\na,60,1\n",
                 r"members.csv:4: a second member 'a'"),
                (head + "a,60\n", r"members.csv:2: 2 cells"),
                (head + "a b,60,1\n", r"members.csv:2: 'a b' is no name"),
                ("length,load\n1,2\n", r"members.csv:1: no column 'name'"),
                ("name,lenght\na,2\n",
                 r"members.csv:2: member 'a'.*did you mean 'length'"),
                ("name,fill.lower\na,2\n",
                 r"members.csv:1: .*needs a column 'fill.upper'"),
                ("name,fill.lower,fill.upper\na,1.1,1.4\n",
                 r"members.csv:2: member 'a'.*outside its bounds"),
                (head, r"members.csv:1: no members"),
                ('name,load\na,"1\n', r"members.csv:2: a quote")):
            with self.subTest(members=members):
                self.expect(self.call("check", self.family(members)), 2, told)
        case = self.family()
        case.write_text(case.read_text().replace("members.csv", "none.csv"))
        self.expect(self.call("check", case), 2,
                    r"case.toml:\d+: .*no file '.*none.csv'")

    def test_wrong_tables_are_told_by_line(self):
        for old, new, told in (
                ("length = 60\nload = 3500\n", "length = 60\nlaod = 3500\n",
                 r"case.toml:{}: member 's60'.*'laod'"),
                ("[study.members.s80]\n", "[study.members.s80]\n"
                 "design.base.bounds = [50, 60]\n",
                 r"member 's80'.*outside its bounds"),
                ('each = "minimize"', 'each = "sweep"', "each")):
            with self.subTest(new=new):
                case = self.folder / "case.toml"
                text = STRUT.read_text()
                self.assertIn(old, text)
                case.write_text(text.replace(old, new, 1))
                line = self.line_of(case, r"^\[study.members.s60\]")
                self.expect(self.call("check", case), 2, told.format(line))
        self.expect(self.call("check", STRUT), 0, "12 members")


def pathlib_part(member):
    return f"{member['folder']}/part_5.stl"


# A block 20 x 10 x 100 along z: its ends are those of the run's strut.
def block(width, depth, height):
    corners = [(x, y, z) for z in (0, height) for y in (0, depth)
               for x in (0, width)]
    faces = {"foot_pad": [(0, 2, 3), (0, 3, 1)],
             "eye_pad": [(4, 5, 7), (4, 7, 6)],
             "sides": [(0, 1, 5), (0, 5, 4), (1, 3, 7), (1, 7, 5),
                       (3, 2, 6), (3, 6, 7), (2, 0, 4), (2, 4, 6)]}
    text = ""
    for name, facets in faces.items():
        text += f"solid {name}\n"
        for facet in facets:
            text += "facet normal 0 0 0\nouter loop\n"
            for corner in facet:
                text += "vertex {} {} {}\n".format(*corners[corner])
            text += "endloop\nendfacet\n"
        text += f"endsolid {name}\n"
    return text


def as_obj(stl):
    """The same facets in groups."""
    text = ""
    for line in stl.splitlines():
        words = line.split()
        if words[0] == "solid":
            text += f"g {words[1]}\n"
        elif words[0] == "vertex":
            text += "v " + " ".join(words[1:]) + "\n"
        elif words[0] == "endloop":
            text += "f -3 -2 -1\n"
    return text


def as_binary(stl):
    corners = [[float(x) for x in line.split()[1:]]
               for line in stl.splitlines() if line.startswith("vertex")]
    data = bytes(80) + struct.pack("<I", len(corners) // 3)
    for k in range(0, len(corners), 3):
        data += struct.pack("<12fH", 0, 0, 0, *corners[k], *corners[k + 1],
                            *corners[k + 2], 0)
    return data


class ImportedPart(ProgramTest):
    def run_strut(self):
        folder, _ = program.once("strut", self.strut_in)
        return folder / "run"

    def strut_in(self, folder):
        self.expect(self.call(
            "run", STRUT, *SMALL, "--set", "study.kind=analyse", "--set",
            'load_cases.push.loads=[{ on = "eye_pad", force = [0, 0, 900] }]',
            "--set", 'load_cases.push.supports='
            '[{ on = "foot_pad", fix = "z" }, '
            '{ on = "foot_pad", stiffness = [1, 1, 0] }]',
            "--no-pictures", "--out", folder / "run"), 0)

    def test_a_block_has_the_stiffness_of_a_bar(self):
        run = self.run_strut()
        stl = self.folder / "block.stl"
        stl.write_text(block(20, 10, 100))
        obj = self.folder / "block.OBJ"
        obj.write_text(as_obj(stl.read_text()))
        there = self.folder / "sides"
        self.expect(self.call("compare", run, stl, obj, "--out", there), 0)
        _, part, same = json.loads(
            (there / "compare.json").read_text())["parts"]
        of_file = {"name": "", "surface": ""}
        self.assertEqual({**part, **of_file}, {**same, **of_file})
        # Pulled evenly: E A / L, the same stress everywhere.
        push = part["load_cases"]["push"]
        self.assertAlmostEqual(push["stiffness"] / (71700 * 200 / 100), 1, 5)
        self.assertAlmostEqual(part["mass"] / (2e4 * 2.8e-9), 1, 9)
        self.assertAlmostEqual(push["max_von_mises"] / (900 / 200), 1, 5)
        self.assertLess(push["coefficient_of_variation"], 1e-5)
        self.assertEqual(part["parts"], 1)

    def test_wrong_files_are_told(self):
        run = self.run_strut()
        stl = self.folder / "part.stl"
        whole = block(20, 10, 100)
        for text, told in (
                (whole.replace("eye_pad", "eye"),
                 r"no face 'eye_pad'(?s:.)*sides: (?s:.)*foot_pad: plane at(?s:.)*eye: "),
                (whole.replace("solid sides", "solid"),
                 r"part.stl:\d+: a solid without a name"),
                (whole.replace("solid sides", "solid eye_pad"),
                 "a second solid 'eye_pad'"),
                (whole.replace("vertex 0 0 0", "vertex 0 0"),
                 r"part.stl:\d+: found"),
                (whole[:-300], r"part.stl:\d+: found"),
                ("", "no facets"), ("a\0b", "binary")):
            with self.subTest(told=told):
                stl.write_text(text)
                self.expect(self.call("compare", run, stl), 2, told)
        stl.write_bytes(as_binary(whole))
        self.expect(self.call("compare", run, stl), 2,
                    "no face 'eye_pad'.*no names .binary STL")
        obj = self.folder / "part.obj"
        for text, told in (
                (as_obj(whole).replace("eye_pad", "eye"), "no face 'eye_pad'"),
                ("solid x\n", r"part.obj:1: found 'solid'"),
                ("", r"part.obj:1: the file has no faces")):
            obj.write_text(text)
            self.expect(self.call("compare", run, obj), 2, told)
        stl.write_text(re.sub(r"(?s)solid eye_pad.*?endsolid eye_pad\n",
                              "solid eye_pad\nendsolid eye_pad\n", whole))
        self.expect(self.call("compare", run, stl), 3, "(?i)open|closed")
        self.expect(self.call("compare", stl, run), 2, "first part")
        self.expect(self.call("compare", run, self.folder / "nowhere"), 2,
                    "nowhere")


if __name__ == "__main__":
    unittest.main(verbosity=2)
