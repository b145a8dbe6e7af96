#!/usr/bin/env python3
"""What a study shows of itself: the log while it runs, `study watch` beside
it, the films of its history and its ledger."""
import json
import re
import signal
import struct
import time
import unittest

from program import COARSE, SIZED_STRUT, ProgramTest
import program

RUN = ["--no-pictures", "--threads", "1"]
EVENTS = {"message", "progress", "evaluation", "end"}


class Live(ProgramTest):
    def setUp(self):
        super().setUp()
        self.case = self.folder / "case.toml"
        self.case.write_text(SIZED_STRUT)

    def run_study(self, name, *more, code=0):
        out = self.folder / name
        done = self.expect(
            self.call("run", self.case, *RUN, "--out", out, *more), code)
        return out, done

    def lines(self, path):
        return [json.loads(line) for line in path.read_text().splitlines()]

    def frames(self, out):
        """Names and bytes of the films that the collection lists."""
        text = (out / "frames.pvd").read_text()
        found = re.findall(r'timestep="(\d+)".*file="([^"]+)"', text)
        names = sorted(path.name for path in (out / "frames").iterdir())
        self.assertEqual([name.split("/")[1] for _, name in found], names)
        for step, name in found:
            self.assertEqual(name, f"frames/film_{int(step):04d}.vtp")
        return {name: (out / name).read_bytes() for _, name in found}


class Log(Live):
    def test_every_line_is_an_object_and_says_when(self):
        log = self.folder / "log.jsonl"
        out, done = self.run_study("out", "--quiet", "--log", log)
        self.assertEqual((done.stdout, done.stderr), ("", ""))
        lines = self.lines(log)
        for line in lines:
            self.assertRegex(line["time"], r"^\d{4}-.*T.*\.\d{3}Z$")
            self.assertIn(line["event"], EVENTS)
            self.assertIn(line["level"], {"debug", "info", "warning"})
            self.assertGreaterEqual(line["seconds"], 0)
            self.assertIn("stage", line)
        result = self.result(out)
        told = [line for line in lines if line["event"] == "evaluation"]
        self.assertEqual([line["evaluation"] for line in told],
                         list(range(1, len(told) + 1)))
        self.assertEqual(len(told), result["evaluations"])
        best = told[-1]["best"]
        self.assertEqual(best["objective"], result["objective"])
        self.assertLess(best["violation"], 1e-6)
        self.assertEqual(told[0]["stage"], "minimize")
        self.assertEqual(set(told[0]["design"]), {"foot", "fill"})
        self.assertEqual(told[0]["responses"], result["start"]["responses"])
        self.assertGreaterEqual(told[0]["violation"], 0.0)
        self.assertEqual(lines[-1]["event"], "end")
        self.assertEqual(lines[-1]["status"], "converged")

    def test_a_kill_leaves_whole_lines_and_the_next_run_appends(self):
        log = self.folder / "log.jsonl"
        running = self.start("run", self.case, *RUN, "--out",
                             self.folder / "out", "--log", log)
        until = time.monotonic() + 60
        while time.monotonic() < until and (
                not log.exists() or '"evaluation"' not in log.read_text()):
            time.sleep(0.01)
        running.send_signal(signal.SIGKILL)
        running.communicate()
        before = len(self.lines(log))
        self.assertGreater(before, 1)
        with open(log, "a", encoding="utf-8") as file:
            file.write('{"time": "cut sho')
        self.run_study("out", "--resume", "--quiet", "--log", log)
        text = log.read_text().splitlines()
        self.assertEqual(text[before], '{"time": "cut sho')
        for line in text[before + 1:]:
            json.loads(line)
        self.assertEqual(json.loads(text[-1])["event"], "end")

    def test_a_pipe_gets_a_line_for_each_evaluation_and_no_flood(self):
        _, done = self.run_study("out")
        lines = done.stderr.splitlines()
        told = [line for line in lines if line.startswith("evaluation ")]
        self.assertGreater(len(told), 5)
        self.assertRegex(told[0], r"\(start\).*; keeps all constraints, the best so far")
        self.assertTrue(any("best so far mass = " in line for line in told))
        # Beside them one for each kind of stage, and warnings.
        self.assertLess(len(lines) - len(told), 20, done.stderr)


class Watch(Live):
    def test_it_follows_a_run_to_its_end(self):
        out = self.folder / "out"
        running = self.start("run", self.case, *RUN, "--out", out)
        until = time.monotonic() + 60
        while not (out / "study.sqlite").exists() and time.monotonic() < until:
            time.sleep(0.01)
        done = self.expect(self.call("study", "watch", out), 0)
        running.communicate()
        result = self.result(out)
        lines = done.stdout.splitlines()
        self.assertRegex(lines[0], r"running \(process \d+ on ")
        self.assertEqual(lines[-1],
                         f"converged: {result['message']}")
        told = [line for line in lines if line.startswith("evaluation ")]
        self.assertEqual(len(told), result["evaluations"])
        self.assertIn("best so far mass = ", done.stdout)
        once = self.expect(self.call("study", "watch", "--once", out), 0,
                           "no run is at work", "converged: ")
        self.assertIn(f"{result['evaluations']} evaluations", once.stdout)
        shown = self.expect(self.call("study", "show", out), 0)
        self.assertRegex(shown.stdout.splitlines()[0],
                         r"sway \[mm\] +mass \[kg\]")

    def test_a_killed_run_and_a_folder_without_one(self):
        out = self.folder / "out"
        running = self.start("run", self.case, *RUN, "--out", out)
        until = time.monotonic() + 60
        while not (out / "study.sqlite").exists() and time.monotonic() < until:
            time.sleep(0.01)
        time.sleep(0.5)
        running.send_signal(signal.SIGKILL)
        running.communicate()
        self.expect(self.call("study", "watch", out), 4,
                    "ended without a result.*--resume")
        self.expect(self.call("study", "watch", self.folder), 2,
                    "no run in .*neither study.sqlite nor family.csv")
        self.expect(self.call("study", "watch", self.folder / "none"), 2,
                    "no run in")

    def test_a_family(self):
        case = program.ROOT / "tests" / "support" / "struts.toml"
        out = self.folder / "family"
        running = self.start(
            "run", case, *RUN, "--set", "resolution.fea=10", "--set",
            "resolution.film=5", "--set", "study.max_evaluations=1",
            "--time-limit", "8", "--out", out)
        until = time.monotonic() + 60
        while not (out / "family.csv").exists() and \
                running.poll() is None and time.monotonic() < until:
            time.sleep(0.01)
        done = self.call("study", "watch", out)
        running.communicate()
        self.assertEqual(done.returncode, running.returncode, done.stderr)
        table = self.call("study", "watch", "--once", out).stdout
        for member in self.result(out)["members"]:
            self.assertIn(member["name"], table)
            if member["evaluations"] > 0:
                self.assertIn(f"{member['name']}: {member['status']}",
                              done.stdout)


class Frames(Live):
    def test_jobs_and_resume_make_the_same_bits(self):
        one, _ = self.run_study("one")
        frames = self.frames(one)
        self.assertGreater(len(frames), 3)
        result = self.result(one)
        two, _ = self.run_study("two", "--jobs", "2")
        self.assertEqual(self.frames(two), frames)
        running = self.start("run", self.case, *RUN, "--out",
                             self.folder / "three")
        until = time.monotonic() + 60
        while not (self.folder / "three" / "study.sqlite-wal").exists() and \
                time.monotonic() < until:
            time.sleep(0.01)
        time.sleep(1)
        running.kill()
        running.communicate()
        three, _ = self.run_study("three", "--resume")
        self.assertEqual(self.frames(three), frames)
        text = frames[max(frames)].split(b"<AppendedData")[0]
        for name in (b"surface", b"surface_names", b"moved", b"evaluation",
                     b"design", b"design_names", b"responses",
                     b"response_names", b"kept"):
            self.assertIn(b'Name="' + name + b'"', text)
        self.assertEqual(result["status"], "converged")
        # Another run in the folder leaves nothing of this one.
        self.run_study("one", "--no-frames")
        self.assertFalse((one / "frames.pvd").exists())
        self.assertFalse((one / "frames").exists())

    def test_a_failed_start_has_no_frames(self):
        self.case.write_text(SIZED_STRUT.replace(
            'volume = "fill"', 'volume = "fill / 40"'))
        out, _ = self.run_study("out", code=3)
        self.assertEqual(self.result(out)["status"], "failed")
        self.assertFalse((out / "frames.pvd").exists())

    def test_how_a_film_settles(self):
        out = self.folder / "out"
        self.expect(self.call("evolve", self.case, "--frames",
                              "--no-pictures", "--out", out), 0)
        frames = self.frames(out)
        self.assertGreater(len(frames), 3)
        self.assertLessEqual(len(frames), 24)


class Limits(Live):
    def test_the_time_limit_bounds_what_comes_after_it(self):
        begun = time.monotonic()
        # A busy machine may not come to a first design within the least.
        for limit in ("0.4", "0.8", "1.6", "3.2"):
            out, done = self.run_study("out_" + limit, "--time-limit", limit,
                                       "--set", "resolution.fea=5", code=3)
            result = self.result(out)
            if "before a first design" not in result["message"]:
                break
        self.assertEqual(result["status"], "stopped")
        self.assertIn("left no time for: ", " ".join(result["warnings"]))
        self.assertEqual(result["response_errors"], {})
        self.assertFalse((out / "frames.pvd").exists())
        self.assertTrue((out / "part.vtu").exists())
        self.assertLess(time.monotonic() - begun, 60)

    def test_the_note_on_precision_is_printed_once(self):
        out = self.folder / "out"
        done = self.expect(
            self.call("run", program.CASE, *COARSE, *RUN, "--set",
                      "study.tolerance=1e-6", "--out", out), 0)
        note = "is below the mesh's own error"
        self.assertEqual((done.stdout + done.stderr).count(note), 1)
        self.assertIn(note, " ".join(self.result(out)["warnings"]))


class Ledger(Live):
    def test_stages_follow_each_other_and_files_are_what_they_say(self):
        out, _ = self.run_study("out")
        result = self.result(out)
        ledger = result["ledger"]
        self.assertEqual(ledger["input_bytes"], len(SIZED_STRUT.encode()))
        stages = ledger["stages"]
        # A line for each film and face, which together are the film's.
        films = [one for one in stages if one["name"].startswith("film: ")]
        self.assertEqual([one["name"] for one in films],
                         ["film: skin", "film: foot_pad", "film: top"])
        self.assertEqual(sum(one["after"]["elements"] for one in films),
                         result["film"]["facets"])
        chain = [one for one in stages if one not in films]
        for one, two in zip(chain, chain[1:]):
            self.assertEqual(one["after"], two["before"], two["name"])
        by_name = {stage["name"]: stage for stage in stages}
        self.assertEqual(by_name["film"]["after"]["elements"],
                         result["film"]["facets"])
        self.assertEqual(by_name["elasticity"]["after"]["elements"],
                         result["tet"]["elements"])
        for name in ("start", "motion", "elasticity"):
            self.assertGreater(by_name[name]["operations"], 1e4, name)
            self.assertGreater(by_name[name]["seconds"], 0, name)
        # The last mesh is made for the best design, whose film it begins with.
        self.assertIsNone(by_name["film"]["operations"])
        for file in ledger["files"]:
            if file["written"]:
                self.assertEqual((out / file["name"]).stat().st_size,
                                 file["bytes"])
        self.assertGreater(by_name["files"]["after"]["bytes"],
                           100 * ledger["input_bytes"])
        again, _ = self.run_study("again", "--jobs", "2")
        for one, two in zip(stages, self.result(again)["ledger"]["stages"]):
            self.assertEqual(one["operations"], two["operations"])


class Pictures(Live):
    def test_a_series_has_one_size(self):
        out = self.folder / "out"
        self.expect(self.call("run", self.case, "--set",
                              "study.max_evaluations=3", "--frame-pictures",
                              "--threads", "1", "--out", out), 3)
        sizes = set()
        films = sorted((out / "frames").glob("*.vtp"))
        for film in films:
            head = film.with_suffix(".png").read_bytes()[:24]
            self.assertEqual(head[:8], b"\x89PNG\r\n\x1a\n")
            sizes.add(struct.unpack(">II", head[16:24]))
        self.assertGreater(len(films), 1)
        self.assertEqual(sizes, {(2400, 1500)})


if __name__ == "__main__":
    unittest.main(verbosity=2)
