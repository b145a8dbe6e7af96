#!/usr/bin/env python3
"""A run that is stopped in the middle keeps what it has; --resume ends with the
same bits as a run that nobody disturbed."""
import random
import signal
import sqlite3
import time
import unittest

import program
from program import COARSE, ProgramTest

RUN = ["run", program.CASE, "--no-pictures", *COARSE]


class Interrupted(ProgramTest):
    def evaluations(self, out):
        try:
            with sqlite3.connect(f"file:{out}/study.sqlite?mode=ro",
                                 uri=True) as database:
                return database.execute(
                    "select count(*) from evaluation").fetchone()[0]
        except sqlite3.Error:
            return 0

    def same_bits(self, one, two):
        left, right = self.result(one), self.result(two)
        for key in ("status", "parameters", "objective", "responses",
                    "response_errors", "evaluations"):
            self.assertEqual(left[key], right[key], key)
        self.assertEqual((one / "film.vtp").read_bytes(),
                         (two / "film.vtp").read_bytes())

    def test_ctrl_c_then_resume(self):
        undisturbed = self.folder / "undisturbed"
        self.expect(self.call(*RUN, "--out", undisturbed), 0)
        out = self.folder / "out"
        running = self.start(*RUN, "--out", out)
        while self.evaluations(out) < 1 and running.poll() is None:
            time.sleep(0.01)
        running.send_signal(signal.SIGINT)
        _, said = running.communicate(timeout=60)
        self.assertEqual(running.returncode, 130, said)
        self.assertIn("resume", said)
        self.assertEqual(self.result(out)["status"], "interrupted")
        self.assert_no_half_files(out)
        self.expect(self.call(*RUN, "--out", out, "--resume"), 0)
        self.same_bits(undisturbed, out)

    def test_kill_then_resume(self):
        undisturbed = self.folder / "undisturbed"
        begun = time.monotonic()
        self.expect(self.call(*RUN, "--out", undisturbed), 0)
        length = time.monotonic() - begun
        moments = random.Random(20)
        for number in range(4):
            out = self.folder / f"killed {number}"
            running = self.start(*RUN, "--out", out)
            time.sleep(length * moments.uniform(0.1, 0.95))
            running.kill()
            running.communicate()
            self.expect(self.call(*RUN, "--out", out, "--resume"), 0)
            self.same_bits(undisturbed, out)
            self.assert_no_half_files(out)

    def test_resume_of_another_case_is_refused(self):
        out = self.folder / "out"
        self.expect(self.call(*RUN, "--out", out), 0)
        self.expect(self.call(*RUN, "--out", out, "--resume", "--set",
                              "load_left=1"), 2, "(?i)resume|other|differ")


if __name__ == "__main__":
    unittest.main(verbosity=2)
