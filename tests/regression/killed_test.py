#!/usr/bin/env python3
"""A study cannot be lost: killed at any moment, on a full disk, with a locked
or a damaged database, it goes on to the same bits or says why not."""
import contextlib
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import sqlite3
import subprocess
import time
import unittest

from program import SIZED_STRUT, ProgramTest, once, without_seconds

MOMENTS = int(os.environ.get("MENISCUS_KILLS", "6"))
# Of a record: all but the seconds, which no two runs share.
COLUMNS = ("number, key, model, phase, input_names, inputs, response_names, "
           "responses, gradient, mismatch, failure, failure_message, figures")


def opened(*arguments, **options):
    """A database that is closed at the end, which `with` alone does not do: an
    open one keeps its log beside it."""
    return contextlib.closing(sqlite3.connect(*arguments, **options))


class Study(ProgramTest):
    """One case; `outcome` is what must not depend on what happened to it."""

    def setUp(self):
        super().setUp()
        # In one place for all: a database notes it with the case.
        folder, _ = once("case", lambda folder: (
            folder / "case.toml").write_text(SIZED_STRUT))
        self.case = folder / "case.toml"
        # Helpers' files, and a mark that tells our processes from others'.
        self.temporary = self.folder / "temporary"
        self.temporary.mkdir()
        self.env = {"TMPDIR": str(self.temporary),
                    "MENISCUS_TEST_MARK": str(self.folder)}

    def arguments(self, out, *more):
        return ["run", str(self.case), "--no-pictures", "--quiet", "--threads",
                "1", "--out", str(out), *more]

    def run_study(self, out, *more, **options):
        return self.call(*self.arguments(out, *more), env=self.env, **options)

    def start_study(self, out, *more, **options):
        return self.start(*self.arguments(out, *more),
                          env={**os.environ, **self.env}, **options)

    def rows(self, out):
        with opened(out / "study.sqlite") as database:
            rows = database.execute(f"select {COLUMNS} from evaluation "
                                    "order by number").fetchall()
            table = database.execute("select case_hash, case_text from meta")
            return rows, table.fetchall()

    def count(self, out):
        try:
            with opened(f"file:{out}/study.sqlite?mode=ro", uri=True,
                        timeout=0.1) as database:
                return database.execute(
                    "select count(*) from evaluation").fetchone()[0]
        except sqlite3.Error:
            return 0

    def outcome(self, out):
        return (self.rows(out), without_seconds(self.result(out)),
                (out / "part.vtu").read_bytes(),
                (out / "film.vtp").read_bytes(),
                sorted(path.name for path in out.iterdir()))

    def undisturbed(self):
        _, (self.seconds, outcome) = once("undisturbed", self.undisturbed_in)
        return outcome

    def undisturbed_in(self, folder):
        begun = time.monotonic()
        self.expect(self.run_study(folder / "out"), 0)
        return time.monotonic() - begun, self.outcome(folder / "out")

    def assert_same(self, one, two):
        names = ("study.sqlite", "result.json", "part.vtu", "film.vtp",
                 "names of files")
        for name, a, b in zip(names, one, two):
            if name == "result.json":
                self.assertEqual(json.dumps(a, indent=1),
                                 json.dumps(b, indent=1))
            self.assertTrue(a == b, f"{name} differs")

    def own_processes(self):
        """Processes that a run of this test left behind."""
        mark = f"MENISCUS_TEST_MARK={self.folder}".encode()
        found = []
        for path in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                if mark in (path / "environ").read_bytes().split(b"\0"):
                    found.append((path / "cmdline").read_bytes())
            except OSError:
                pass
        return found

    def assert_nothing_left(self, out):
        self.assert_no_half_files(out)
        until = time.monotonic() + 5
        while self.own_processes() and time.monotonic() < until:
            time.sleep(0.01)
        self.assertEqual(self.own_processes(), [])


class Killed(Study):
    def test_killed_at_any_moment_it_ends_with_the_same_bits(self):
        whole = self.undisturbed()
        elements = whole[1]["tet"]["elements"]
        self.assertGreater(elements, 1500)
        self.assertGreater(len(whole[0][0]), 9)
        choice = random.Random(50)
        reached = []
        for number in range(MOMENTS):
            out = self.folder / f"killed {number}"
            running = self.start_study(out, start_new_session=True)
            # Moments spread over the whole run, one in each part of it, the
            # parts shorter at its begin: the first evaluation comes soon.
            begun = time.monotonic()
            try:
                part = (number + choice.random()) / MOMENTS
                running.wait(self.seconds * part ** 1.5)
                # It ran alone, and faster than the first did.
                self.seconds = min(self.seconds, time.monotonic() - begun)
            except subprocess.TimeoutExpired:
                if number % 5 == 4:
                    running.kill()  # its helpers must end by themselves
                else:
                    os.killpg(running.pid, signal.SIGKILL)
            running.communicate()
            reached.append(self.count(out) if running.returncode < 0 else -1)
            self.expect(self.run_study(out, "--resume"), 0)
            self.assert_same(whole, self.outcome(out))
            self.assert_nothing_left(out)
            shutil.rmtree(out)
        print(f"{MOMENTS} kills in a run of {self.seconds:.2f} s; evaluations "
              f"stored by then (-1: it had ended): {reached}")
        # Some before the first evaluation, some in the middle of the study.
        self.assertIn(0, reached)
        self.assertTrue(any(0 < n < len(whole[0][0]) for n in reached))


class FullDisk(Study):
    def small_disk(self, path):
        """A file system of 8 MB, or None where we may not mount one."""
        path.mkdir()
        done = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=8m",
                               "tmpfs", str(path)], capture_output=True)
        if done.returncode != 0:
            return None
        self.addCleanup(subprocess.run, ["umount", "-l", str(path)])
        return path

    def assert_told_and_resumed(self, out, done, whole, free_space):
        self.expect(done, 4, "(?i)disk full|no space|file too large",
                    "--resume")
        self.assertEqual(done.stderr.count("Traceback"), 0)
        kept = self.count(out)
        free_space()
        self.expect(self.run_study(out, "--resume"), 0)
        self.assertGreaterEqual(self.count(out), kept)
        self.assert_same(whole, self.outcome(out))
        self.assert_nothing_left(out)

    def test_a_full_disk_loses_nothing(self):
        whole = self.undisturbed()
        disk = self.small_disk(self.folder / "disk")
        if disk is None:
            self.a_limit_on_files(whole)
            return
        for free in (80, 160, 240, 400):  # kB that are left
            with self.subTest(free=free):
                out = disk / f"out {free}"
                out.mkdir()
                filler = disk / "filler"
                room = shutil.disk_usage(disk).free - 1024 * free
                filler.write_bytes(bytes(room))
                self.assert_told_and_resumed(out, self.run_study(out), whole,
                                             filler.unlink)
                shutil.rmtree(out)

    def a_limit_on_files(self, whole):
        for limit in (60_000, 150_000):
            out = self.folder / f"out {limit}"

            def lower(limit=limit):
                signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

            done = self.run_study(out, preexec_fn=lower)
            self.assert_told_and_resumed(out, done, whole, lambda: None)


class Database(Study):
    def cut_short(self, out):
        """A study of three evaluations."""
        self.expect(self.run_study(out, "--set", "study.max_evaluations=3"), 3)
        return out

    def test_a_lock_is_waited_for(self):
        whole = self.undisturbed()
        out = self.folder / "out"
        running = self.start_study(out)
        while self.count(out) < 1 and running.poll() is None:
            time.sleep(0.002)
        with opened(out / "study.sqlite", timeout=5) as other:
            other.execute("begin immediate")
            time.sleep(1.0)
            other.execute("rollback")
        _, said = running.communicate(timeout=60)
        self.assertEqual(running.returncode, 0, said)
        self.assert_same(whole, self.outcome(out))

    def test_a_lock_that_stays_ends_the_run_and_loses_nothing(self):
        whole = self.undisturbed()
        out = self.folder / "out"
        running = self.start_study(out)
        while self.count(out) < 1 and running.poll() is None:
            time.sleep(0.002)
        other = sqlite3.connect(out / "study.sqlite", timeout=5)
        other.execute("begin immediate")
        kept = other.execute("select count(*) from evaluation").fetchone()[0]
        _, said = running.communicate(timeout=60)
        self.assertEqual(running.returncode, 4, said)
        self.assertRegex(said, "study.sqlite is locked by another program.*"
                         "--resume")
        # Nor can another run begin.
        self.expect(self.run_study(out, "--resume"), 2,
                    "study.sqlite is locked by another program")
        other.execute("rollback")
        other.close()
        self.assertEqual(self.count(out), kept)
        self.expect(self.run_study(out, "--resume"), 0)
        self.assert_same(whole, self.outcome(out))

    def test_a_damaged_database_is_refused_and_left_as_it_is(self):
        out = self.cut_short(self.folder / "out")
        path = out / "study.sqlite"
        good = path.read_bytes()
        places = {"header": 20, "half": len(good) // 2, "end": len(good) - 40,
                  "tables": good.index(b"CREATE TABLE evaluation") + 2,
                  "columns": good.index(b"response_names TEXT") + 2,
                  "case": good.index(b"A strut sized to")}
        with opened(path) as database:
            for name in ("responses", "inputs", "gradient"):
                places[name] = good.index(database.execute(
                    f"select {name} from evaluation").fetchone()[0]) + 3
        damaged = {}
        for name, place in places.items():
            bytes_ = bytearray(good)
            for k in range(place, place + 4):
                bytes_[k] ^= 0x5a
            damaged[name] = bytes(bytes_)
        damaged["truncated"] = good[:len(good) // 2]
        damaged["a page too short"] = good[:-4096]
        damaged["garbage"] = b"Z" * 5000
        for name, content in damaged.items():
            with self.subTest(name):
                path.write_bytes(content)
                done = self.run_study(out, "--resume")
                if done.returncode == 0:  # where nothing stands
                    self.assertIn(name, ("half", "end"))
                    path.write_bytes(good)
                    continue
                self.expect(done, 2, "study.sqlite", "without --resume|--set")
                self.assertEqual(path.read_bytes(), content)
        path.write_bytes(damaged["truncated"])
        self.expect(self.run_study(out), 0)
        self.assertEqual((out / "study-1.sqlite").read_bytes(),
                         damaged["truncated"])

    def test_another_version_is_refused_by_name(self):
        out = self.cut_short(self.folder / "out")
        with opened(out / "study.sqlite") as database:
            database.execute("pragma user_version = 77")
        before = (out / "study.sqlite").read_bytes()
        self.expect(self.run_study(out, "--resume"), 2, "schema version 77",
                    "without --resume")
        self.assertEqual((out / "study.sqlite").read_bytes(), before)

    def test_a_second_run_on_one_folder_is_refused(self):
        whole = self.undisturbed()
        out = self.folder / "out"
        running = self.start_study(out)
        while self.count(out) < 1 and running.poll() is None:
            time.sleep(0.002)
        for more in ([], ["--resume"]):
            self.expect(self.run_study(out, *more), 2, "another run is at work",
                        f"process {running.pid}")
        running.communicate(timeout=60)
        self.assertEqual(running.returncode, 0)
        self.assert_same(whole, self.outcome(out))


if __name__ == "__main__":
    unittest.main(verbosity=2)
