#!/usr/bin/env python3
"""Frozen models: stages, gradients, failures, threads, wrong arguments."""
import signal
import threading
import unittest

import numpy as np

import meniscus
from support import CASE, COARSE, PETALS, PackageTest, bracket, model

# Central differences over 2 x 0.01 mm: second order in the step, and the
# noise of a solve to 1e-10.
DIFFERENCE = 1e-6
# A residual of 1e-10 in the energy norm.
BALANCE = 1e-8


class Stages(PackageTest):
    def test_one_by_one_they_have_the_bits_of_all_at_once(self):
        whole = model().evaluate([7.0])
        film = model().settle([7.0])
        mesh = film.mesh()
        solution = mesh.solve()
        np.testing.assert_array_equal(solution.evaluate().responses,
                                      whole.responses)
        np.testing.assert_array_equal(mesh.nodes, whole.mesh.nodes)
        for keep in ("fields", "responses"):
            np.testing.assert_array_equal(
                model().evaluate([7.0], keep=keep).responses, whole.responses)
        alone = meniscus.FilmModel(bracket()).settle({"support_x": 7.0})
        np.testing.assert_array_equal(alone.vertices, film.vertices)
        np.testing.assert_array_equal(alone.surface().vertices,
                                      film.surface().vertices)

    def test_what_the_stages_say_is_so(self):
        film = model().settle([7.0])
        self.assertEqual(film.verdict, "stable")
        self.assertLess(film.residual, film.residual_bound)
        self.assertGreater(film.min_eigenvalue, 0)
        self.assertEqual(film.index, 0)
        self.assertAlmostEqual(film.volumes["part"] / 1.7e6, 1, 9)
        # The enclosed volume by the divergence theorem, from the arrays.
        a, b, c = (film.vertices[film.facets[:, k]] for k in range(3))
        volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
        self.assertAlmostEqual(volume / film.volumes["part"], 1, 9)
        solution = film.mesh().solve()
        held = solution.reactions().sum(axis=0)
        np.testing.assert_allclose(held, [0, 0, 100e3],
                                   atol=100e3 * BALANCE)
        self.assertLess(solution.reaction_imbalance, BALANCE)
        stress = solution.stress("service")
        self.assertEqual(stress.von_mises.max(), stress.max_von_mises)
        x, y, z, xy, yz, zx = stress.nodal.T
        np.testing.assert_allclose(
            stress.von_mises,
            np.sqrt(((x - y) ** 2 + (y - z) ** 2 + (z - x) ** 2) / 2
                    + 3 * (xy ** 2 + yz ** 2 + zx ** 2)), rtol=1e-10)

    def test_gradients_are_those_of_differences(self):
        names = [r.name for r in bracket().responses]
        at = model().evaluate([7.0])
        exact = at.gradient()
        step = 0.01
        rise = (model().evaluate([7.0 + step]).responses
                - model().evaluate([7.0 - step]).responses) / (2 * step)
        np.testing.assert_allclose(exact[:, 0], rise, rtol=DIFFERENCE)
        np.testing.assert_allclose(at.gradient(names), exact,
                                   rtol=1e-12)
        self.assertEqual(at.gradient(names[1]).shape, (1,))
        self.assertEqual(at.gradient(names[1:]).shape, (1, 1))
        self.assertEqual(at.gradient()[1, 0], exact[1, 0])


class Failures(PackageTest):
    def test_a_vector_goes_in_as_an_array(self):
        case = meniscus.read_case(PETALS, {"resolution.fea": 12.0,
                                             "resolution.film": 6.0})
        petals = meniscus.Model(case)
        t = 25.0 + np.arange(6.0).reshape(2, 3) / 10
        evaluation = petals.evaluate({"t": t})
        np.testing.assert_array_equal(evaluation.design, t.ravel())
        np.testing.assert_array_equal(
            evaluation.responses, petals.evaluate(t.ravel()).responses)
        slope = case.by_name(evaluation.gradient("mass"))["t"]
        self.assertEqual(slope.shape, (2, 3))
        step = np.zeros((2, 3))
        step[1, 0] = 1e-3
        difference = (petals.evaluate({"t": t + step})["mass"]
                      - petals.evaluate({"t": t - step})["mass"]) / 2e-3
        self.assertAlmostEqual(slope[1, 0] / difference, 1.0, 5)

    def test_a_failed_design_is_data(self):
        far = model().evaluate([-500.0])
        self.assertFalse(far.ok)
        self.assertIn(far.failure.kind, ("film_pinched", "film_not_found",
                                         "elements_inverted"))
        self.assertTrue(far.failure.message)
        self.assertTrue(np.isnan(far.responses).all())
        self.assertEqual(far.responses.shape, (2,))
        for ask in (lambda: far["left_deflection"], lambda: far.solution,
                    far.gradient):
            with self.assertRaises(meniscus.DesignFailed) as caught:
                ask()
            self.assertEqual(caught.exception.failure.kind, far.failure.kind)
            self.assertIn(far.failure.message, str(caught.exception))
        with self.assertRaises(meniscus.DesignFailed):
            model().settle([-500.0]).mesh().solve()

    def test_a_model_that_cannot_be_frozen_tells_why(self):
        case = meniscus.read_case(CASE, {**COARSE, "bodies.part.volume": 2e5})
        thin = meniscus.Model(case)
        self.assertTrue(thin.failure.kind.startswith("film"))
        self.assertEqual(thin.evaluate().failure.message,
                         thin.failure.message)
        self.assertEqual(thin.settle([1.0]).failure.kind, thin.failure.kind)
        self.assertIsNone(thin.unfilled_surface)
        self.assertEqual(thin.findings, [])
        film = meniscus.FilmModel(case)
        self.assertEqual(film.failure.kind, thin.failure.kind)
        with self.assertRaises(meniscus.DesignFailed):
            film.settle().surface()

    def test_wrong_arguments(self):
        at = model().evaluate([1.0])
        lean = model().evaluate([1.0], keep="responses")
        for told, ask in (
                (r"shape \(2,\), expected \(1,\): support_x",
                 lambda: model().evaluate([1.0, 2.0])),
                ("support_x is nan", lambda: model().evaluate([np.nan])),
                ("expected numbers", lambda: model().evaluate(["a"])),
                ("did you mean 'support_x'",
                 lambda: model().evaluate({"suport_x": 1})),
                ("did you mean 'left_deflection'",
                 lambda: at["left_defection"]),
                ("no load case 'storm'",
                 lambda: at.solution.displacement("storm")),
                ("keep: found 'some'",
                 lambda: model().evaluate(keep="some")),
                ("keep='all'", lambda: model().evaluate(
                    keep="fields").gradient()),
                ("for its responses alone", lambda: lean.mesh),
                ("use meniscus.Model", meniscus.FilmModel(
                    bracket()).settle().mesh),
                ("above 0", lambda: meniscus.Model(bracket(), edge_factor=0)),
                ("a function", lambda: meniscus.Model(bracket(), progress=3)),
                ("1 or more", lambda: meniscus.set_threads(-1))):
            with self.subTest(told=told):
                with self.assertRaisesRegex(meniscus.InvalidInput, told):
                    ask()
        peak = meniscus.parse_case(
            CASE.read_text() + '\n[responses.peak]\nkind = "max_von_mises"\n',
            COARSE)
        self.assertFalse(peak.responses[2].has_gradient)
        with self.assertRaisesRegex(meniscus.InvalidInput,
                                    "'peak' has no derivatives"):
            meniscus.Model(peak).evaluate().gradient()


class Threads(PackageTest):
    def test_two_threads_on_one_model_have_the_same_bits(self):
        designs = np.linspace(-8.0, 8.0, 6)
        alone = [model().evaluate([x]) for x in designs]
        found = {}

        def work(name, order):
            for x in order:
                found[name, x] = model().evaluate([x])
                found[name, x].gradient()

        threads = [threading.Thread(target=work, args=("up", designs)),
                   threading.Thread(target=work, args=("down",
                                                       designs[::-1]))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for x, evaluation in zip(designs, alone):
            for name in ("up", "down"):
                np.testing.assert_array_equal(found[name, x].responses,
                                              evaluation.responses)
                np.testing.assert_array_equal(found[name, x].gradient(),
                                              evaluation.gradient())

    def test_the_number_of_threads_changes_no_bit(self):
        self.addCleanup(meniscus.set_threads, 0)
        one, two = [], []
        for count, kept in ((1, one), (2, two)):
            meniscus.set_threads(count)
            self.assertEqual(meniscus.threads(), count)
            own = meniscus.Model(bracket())
            at = own.evaluate([3.0])
            kept += [at.responses, at.gradient(), at.mesh.nodes]
        for a, b in zip(one, two):
            np.testing.assert_array_equal(a, b)

    def test_other_threads_run_meanwhile(self):
        ticks = []
        stop = threading.Event()

        def tick():
            while not stop.wait(0.005):
                ticks.append(1)

        ticker = threading.Thread(target=tick)
        ticker.start()
        for x in range(5):
            model().evaluate([x])
        stop.set()
        ticker.join()
        self.assertGreater(len(ticks), 5)

    def test_ctrl_c_ends_a_freeze(self):
        timer = threading.Timer(0.4, signal.raise_signal, [signal.SIGINT])
        with self.assertRaises(KeyboardInterrupt):
            timer.start()
            meniscus.Model(meniscus.read_case(CASE, {
                "resolution.fea": 6.0, "resolution.film": 3.0}))
        self.assertTrue(model().evaluate([1.0]).ok)

    def test_progress_comes_on_the_calling_thread(self):
        heard = []
        meniscus.Model(bracket(), progress=lambda *news: heard.append(
            (threading.get_ident(), *news)))
        self.assertEqual({h[0] for h in heard}, {threading.get_ident()})
        self.assertLessEqual({"film", "mesh", "fea"}, {h[1] for h in heard})

        def refuse(stage, detail, fraction):
            raise RuntimeError("enough")
        with self.assertRaisesRegex(RuntimeError, "enough"):
            meniscus.Model(bracket(), progress=refuse)


class Remembering(PackageTest):
    def test_a_design_is_computed_once(self):
        at = meniscus.Remember(model())
        self.assertIs(at([1.0]), at(np.array([1.0])))
        self.assertEqual(at.count, 1)
        at([2.0])
        at([1.0])
        self.assertEqual(at.count, 3)


if __name__ == "__main__":
    unittest.main(verbosity=2)
