#!/usr/bin/env python3
"""Arrays are the engine's memory: not copied, read-only, alive as long as they
are shown; and nothing leaks."""
import gc
import os
import unittest

import numpy as np

import meniscus
from support import PackageTest, bracket, model

# Pages that the allocators keep, once warm; one evaluation's fields are 6 MB
# and its stiffness 8 MB, so that 50 that leaked would be 700 MB.
LEAK = 60e6


def resident():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def arrays_of(evaluation):
    """Every array of every stage: (what, owner, read again)."""
    film, mesh = evaluation.film, evaluation.mesh
    solution = evaluation.solution
    surface, stress = film.surface(), solution.stress()
    for owner, names in (
            (film, "vertices facets facet_labels design"),
            (surface, "vertices facets facet_labels edges mid_sides "
                      "facet_edges"),
            (mesh, "nodes elements regions faces face_labels design"),
            (stress, "nodal von_mises element_errors"),
            (evaluation, "responses design")):
        for name in names.split():
            yield name, owner, lambda o=owner, n=name: getattr(o, n)
    for name in ("displacement", "reactions"):
        yield name, solution, lambda n=name: getattr(solution, n)("service")


class Arrays(PackageTest):
    def test_shapes_and_kinds(self):
        evaluation = model().evaluate([5.0])
        mesh, solution = evaluation.mesh, evaluation.solution
        nodes, elements = len(mesh.nodes), len(mesh.elements)
        self.assertEqual(mesh.nodes.shape, (nodes, 3))
        self.assertEqual(mesh.elements.shape, (elements, 10))
        self.assertEqual(mesh.faces.shape[1], 6)
        self.assertEqual(mesh.faces.shape[0], len(mesh.face_labels))
        self.assertEqual(mesh.elements.dtype, np.int32)
        self.assertEqual(solution.displacement().shape, (nodes, 3))
        self.assertEqual(solution.stress().nodal.shape, (nodes, 6))
        self.assertEqual(solution.stress().element_errors.shape, (elements,))
        self.assertLess(mesh.elements.max(), nodes)
        surface = evaluation.film.surface()
        self.assertEqual(surface.mid_sides.shape, (len(surface.edges), 3))
        self.assertEqual(surface.facet_edges.shape, surface.facets.shape)
        # Corners of the elements' faces are the surface's.
        np.testing.assert_array_equal(mesh.nodes[:len(surface.vertices)],
                                      surface.vertices)

    def test_nothing_is_copied_and_nothing_can_be_written(self):
        for name, owner, read in arrays_of(model().evaluate([5.0])):
            with self.subTest(name=name):
                array = read()
                self.assertGreater(array.size, 0)
                self.assertFalse(array.flags.owndata)
                self.assertTrue(array.flags.c_contiguous)
                self.assertIs(array.base, owner)
                self.assertEqual(array.ctypes.data, read().ctypes.data)
                with self.assertRaises(ValueError):
                    array[0] = 1
                with self.assertRaises(ValueError):
                    array.setflags(write=True)

    def test_arrays_outlive_all_else(self):
        own = meniscus.Model(bracket())
        evaluation = own.evaluate([5.0])
        held = [(name, read()) for name, _, read in arrays_of(evaluation)]
        copies = [array.copy() for _, array in held]
        del own, evaluation
        gc.collect()
        meniscus.Model(bracket()).evaluate([-5.0])  # over freed memory
        for (name, array), copy in zip(held, copies):
            np.testing.assert_array_equal(array, copy, name)

    def test_fifty_evaluations_leak_nothing(self):
        def work(times):
            for k in range(times):
                evaluation = model().evaluate([k / 10])
                evaluation.gradient("left_deflection")
                evaluation.solution.stress()
                far = model().settle([-500.0])
                self.assertFalse(far.ok)
            gc.collect()
        work(8)
        before = resident()
        work(50)
        self.assertLess(resident() - before, LEAK)


if __name__ == "__main__":
    unittest.main(verbosity=2)
