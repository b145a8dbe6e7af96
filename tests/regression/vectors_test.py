#!/usr/bin/env python3
"""Design variables under one name, from outside: a study that moves a vector, its
figures for people and programs, resume, export and the next run."""
import csv
import json
import signal
import sqlite3
import time
import unittest

from program import ROOT, ProgramTest, once

CASE = ROOT / "tests" / "support" / "petals.toml"
NAMES = [f"t[{i},{j}]" for i in (1, 2) for j in (1, 2, 3)]
RUN = ["run", CASE, "--no-pictures"]


class Vectors(ProgramTest):
    def made(self):
        return once("petals", lambda folder: self.expect(
            self.call(*RUN, "--out", folder / "out"), 0))

    def test_people_see_one_row_and_programs_every_element(self):
        folder, done = self.made()
        out = folder / "out"
        self.assertRegex(done.stdout, r"(?m)^  t \[2 x 3\] +\S+ to \S+, mean")
        self.assertNotIn("t[1,1]", done.stdout + done.stderr)
        result = self.result(out)
        nested = result["parameters"]["t"]
        self.assertEqual([len(row) for row in nested], [3, 3])
        with open(out / "history.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([n for n in rows[0] if n.startswith("t")], NAMES)
        flat = [number for row in nested for number in row]
        self.assertIn(flat, [[float(row[n]) for n in NAMES] for row in rows])
        self.assertLess(result["responses"]["sway"],
                        result["start"]["responses"]["sway"])
        table = self.expect(self.call("study", "show", out), 0).stdout
        self.assertRegex(table.splitlines()[0], r"^evaluation +t  ")
        self.expect(self.call("study", "watch", out, "--once"), 0,
                    r"t = \S+ to \S+, mean")
        self.expect(self.call("check", CASE), 0,
                    r"6 design variables \(6 of them t \[2 x 3\]\)")

    def test_events_have_it_as_result_json(self):
        log = self.folder / "log.jsonl"
        self.expect(self.call(*RUN, "--out", "out", "--quiet", "--log", log,
                              "--set", "study.kind=analyse"), 0)
        events = [json.loads(line) for line in log.read_text().splitlines()]
        designs = [e["design"] for e in events if e["event"] == "evaluation"]
        self.assertEqual(designs, [{"t": [[25.0] * 3] * 2}])

    def test_stopped_and_resumed_it_ends_with_the_same_bits(self):
        folder, _ = self.made()
        out = self.folder / "out"
        running = self.start(*RUN, "--out", out)
        while running.poll() is None and self.evaluations(out) < 2:
            time.sleep(0.005)
        running.send_signal(signal.SIGINT)
        running.communicate(timeout=60)
        self.expect(self.call(*RUN, "--out", out, "--resume"), 0)
        for key in ("status", "parameters", "responses", "evaluations"):
            self.assertEqual(self.result(out)[key],
                             self.result(folder / "out")[key], key)

    def evaluations(self, out):
        try:
            with sqlite3.connect(f"file:{out}/study.sqlite?mode=ro",
                                 uri=True) as database:
                return database.execute(
                    "select count(*) from evaluation").fetchone()[0]
        except sqlite3.Error:
            return 0

    def test_the_answer_is_exported_and_begun_from(self):
        folder, _ = self.made()
        out = folder / "out"
        step = self.folder / "part.stl"
        self.expect(self.call("export", out, "--format", "stl", "--out", step),
                    0)
        self.assertGreater(step.stat().st_size, 10000)
        self.expect(self.call(*RUN, "--from", out, "--out", "next", "--set",
                              "study.kind=analyse"), 0)
        self.assertEqual(self.result(self.folder / "next")["parameters"]["t"],
                         self.result(out)["parameters"]["t"])
        other = self.folder / "other.toml"
        other.write_text(CASE.read_text().replace("shape = [2, 3]",
                                                  "shape = [2, 4]"))
        self.expect(self.call("run", other, "--from", out, "--out", "no"), 2,
                    "has no design variable of this case, which has t")
        # Damaged: a row is missing.
        result = self.result(out)
        result["parameters"]["t"].pop()
        copy = self.folder / "copy"
        copy.mkdir()
        for path in out.iterdir():
            if path.is_file():
                (copy / path.name).write_bytes(path.read_bytes())
        (copy / "result.json").write_text(json.dumps(result))
        self.expect(self.call("export", copy, "--format", "obj"), 2,
                    r"no number for 't\[2,1\]'")

    def test_a_family_has_vectors_too(self):
        case = self.folder / "family.toml"
        case.write_text(CASE.read_text().split("[study]")[0] + """[study]
kind = "family"
each = "analyse"
[study.members.even]
t = 26
[study.members.own]
t = [[21, 22, 23], [24, 25, 26]]
[study.members.one]
"t[2,3]" = 31
""")
        done = self.expect(self.call("run", case, "--no-pictures", "--out",
                                     "out"), 0)
        members = self.result(self.folder / "out")["members"]
        self.assertEqual([m["design"]["t"] for m in members], [
            [[26.0] * 3] * 2, [[21.0, 22.0, 23.0], [24.0, 25.0, 26.0]],
            [[25.0] * 3, [25.0, 25.0, 31.0]]])
        self.assertRegex(done.stdout, r"21 to 26")
        self.assertNotIn("t[1,1]", done.stdout)

    def test_gradients_are_checked(self):
        done = self.expect(self.call(
            "check-gradient", CASE, "--at", "t[1,2]=26", "--set",
            "resolution.fea=12", "--set", "resolution.film=6"), 0,
            "all 12 derivatives agree", r"t \[2 x 3\] = 25 to 26, mean")
        for name in NAMES:
            self.assertIn(name, done.stdout)
        self.expect(self.call("check-gradient", CASE, "--at", "t[3,1]=26"), 2,
                    "expected NAME=VALUE of a design variable")
        self.expect(self.call("check-gradient", CASE, "--at", "t=40"), 2,
                    "outside the bounds")


if __name__ == "__main__":
    unittest.main(verbosity=2)
