#!/usr/bin/env python3
"""Whole studies from Python: the bits of the program's, stopped and resumed."""
import json
import signal
import threading
import unittest

import numpy as np

import meniscus
from support import CASE, COARSE, PETALS, PackageTest, bracket, strut_tree

SET = [part for name, value in COARSE.items()
       for part in ("--set", f"{name}={value}")]
SIZED = {"kind": "minimize", "objective": "mass", "method": "slsqp",
         "constraints": [{"response": "deflection", "max": 0.1}]}


class Studies(PackageTest):
    def test_the_bits_of_the_program(self):
        theirs, ours = self.folder() / "program", self.folder() / "python"
        self.run_program("run", CASE, *SET, "--no-pictures", "--out", theirs)
        run = meniscus.run_study(bracket(), ours)
        expected = json.loads((theirs / "result.json").read_text())
        for key in ("status", "message", "parameters", "responses", "case_hash",
                    "response_errors", "evaluations", "program_version"):
            self.assertEqual(run.result[key], expected[key], key)
        for name in ("film.vtp", "part.vtu", "part_surface.vtp",
                     "part_12.stl", "history.csv", "study.sqlite",
                     "frames.pvd", "part.png", "film.png", "overview.png",
                     "report.html"):
            self.assertTrue((ours / name).exists(), name)
        self.assertIn("ledger", run.result)
        # An evaluation in Python of the design that the program went on from.
        read = meniscus.read_run(theirs)
        last = expected["refrozen"][0]
        at = meniscus.Model(read.case).evaluate(
            np.array(list(last["parameters"].values())))
        self.assertEqual(dict(zip(at.names, at.responses)), last["responses"])
        table, own = read.evaluations, run.evaluations
        np.testing.assert_array_equal(table.designs, own.designs)
        np.testing.assert_array_equal(table.responses, own.responses)
        self.assertEqual(table.phases, own.phases)
        self.assertEqual(len(table), expected["evaluations"])
        self.assertFalse(table.designs.flags.owndata)

    def test_a_progress_function_that_raises_stops_it_and_it_goes_on(self):
        folder = self.folder() / "run"
        case = meniscus.make_case(strut_tree(SIZED))
        seen = []

        def stop_late(stage, detail, fraction):
            seen.append(stage)
            if seen.count("minimize") == 3:
                raise KeyError("enough")

        with self.assertRaisesRegex(KeyError, "enough"):
            meniscus.run_study(case, folder, progress=stop_late)
        self.assertTrue((folder / "report.html").exists())
        cut = meniscus.read_run(folder)
        self.assertEqual(cut.status, "interrupted")
        kept = len(cut.evaluations)
        self.assertGreater(kept, 0)
        run = meniscus.run_study(case, folder, resume=True, pictures=False,
                                 frames=False, report=False)
        self.assertEqual(run.status, "converged")
        for name in ("part.png", "frames.pvd", "report.html"):
            self.assertFalse((folder / name).exists(), name)
        self.assertGreater(len(run.evaluations), kept)
        np.testing.assert_array_equal(run.evaluations.designs[:kept],
                                      cut.evaluations.designs)
        whole = meniscus.run_study(case, self.folder() / "whole",
                                   pictures=False, frames=False, report=False)
        self.assertEqual(whole.responses, run.responses)

    def test_ctrl_c(self):
        # Also with two jobs, where the calling thread only waits.
        tree = strut_tree({"kind": "sweep", "count": 500})
        case = meniscus.make_case(tree)
        for jobs in (1, 2):
            with self.subTest(jobs=jobs):
                folder = self.folder() / "run"
                timer = threading.Timer(
                    1.5, signal.raise_signal, [signal.SIGINT])
                timer.start()
                with self.assertRaises(KeyboardInterrupt):
                    meniscus.run_study(case, folder, jobs=jobs, pictures=False)
                timer.join()
                self.assertEqual(meniscus.read_run(folder).status,
                                 "interrupted")

    def test_the_answer_of_a_vector_is_an_array(self):
        case = meniscus.read_case(PETALS, {"study.kind": "analyse"})
        run = meniscus.run_study(case, self.folder() / "petals", pictures=False)
        np.testing.assert_array_equal(run.parameters["t"],
                                      np.full((2, 3), 25.0))
        self.assertEqual(run.result["parameters"]["t"], [[25.0] * 3] * 2)
        np.testing.assert_array_equal(
            run.case.by_name(run.answer)["t"], run.parameters["t"])
        self.assertEqual(run.evaluations.designs.shape, (1, 6))

    def test_a_failed_initial_design_is_a_result(self):
        case = meniscus.with_overrides(bracket(),
                                       {"bodies.part.volume": 2e5})
        run = meniscus.run_study(case, self.folder() / "run", pictures=False)
        self.assertEqual(run.status, "failed")
        self.assertIsNone(run.answer)
        self.assertEqual(run.responses, {})

    def test_a_family(self):
        tree = strut_tree({"kind": "family", "each": "analyse", "members": {
            "short": {"length": 60}, "long": {"length": 80}}})
        run = meniscus.run_study(meniscus.make_case(tree),
                                 self.folder() / "run", jobs=2, pictures=False)
        self.assertEqual(run.status, "converged")
        self.assertEqual(list(run.members), ["short", "long"])
        masses = [m.responses["mass"] for m in run.members.values()]
        self.assertLess(masses[0], masses[1])

    def test_wrong_folders_and_options(self):
        folder = self.folder()
        with self.assertRaisesRegex(meniscus.IoError, "result.json"):
            meniscus.read_run(folder)
        for text in ("{", "[]", "{}", '{"status": 3}'):
            (folder / "result.json").write_text(text)
            with self.assertRaisesRegex(meniscus.IoError, "no result"):
                meniscus.read_run(folder)
        (folder / "result.json").write_text('{"status": "", "message": ""}')
        with self.assertRaises(meniscus.Error):
            meniscus.read_run(folder).evaluations
        (folder / "file").write_text("")
        with self.assertRaises(meniscus.IoError):
            meniscus.run_study(bracket(), folder / "file" / "run")
        for told, options in (("jobs", {"jobs": 0}),
                              ("time_limit", {"time_limit": -1}),
                              ("time_limit", {"time_limit": np.nan})):
            with self.assertRaisesRegex(meniscus.InvalidInput, told):
                meniscus.run_study(bracket(), folder / "run", **options)
        with self.assertRaisesRegex(meniscus.InvalidInput, "expected a men"):
            meniscus.run_study("case.toml", folder / "run")


if __name__ == "__main__":
    unittest.main(verbosity=2)
