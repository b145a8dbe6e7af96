#!/usr/bin/env python3
"""Cases from files, text and dicts; the public names, documented and typed."""
import ast
import inspect
import pathlib
import re
import tomllib
import unittest

import numpy as np

import meniscus
from support import CASE, PETALS, STRUTS, PackageTest, bracket


class Reading(PackageTest):
    def test_what_a_case_says(self):
        case = bracket()
        self.assertEqual(case.name, "two_arm")
        self.assertEqual([d.name for d in case.design], ["support_x"])
        self.assertEqual((case.lower_bounds[0], case.initial_design[0],
                          case.upper_bounds[0]), (-40.0, 0.0, 40.0))
        self.assertEqual([(r.name, r.unit, r.has_gradient)
                          for r in case.responses],
                         [("left_deflection", "mm", True),
                          ("right_deflection", "mm", True)])
        self.assertEqual(case.units.system, "mm-N-MPa")
        self.assertEqual(case.parameters()["load_left"], 40e3)
        self.assertEqual(case.load_cases, ["service"])
        self.assertEqual(len(meniscus.read_case(STRUTS).members), 12)

    def test_vectors_are_arrays_by_name(self):
        case = meniscus.read_case(PETALS)
        self.assertEqual([d.name for d in case.design][:4],
                         ["t[1,1]", "t[1,2]", "t[1,3]", "t[2,1]"])
        start = case.by_name()
        self.assertEqual(list(start), ["t"])
        np.testing.assert_array_equal(start["t"], np.full((2, 3), 25.0))
        start["t"][0, 0] = -1.0  # a new array each time
        self.assertEqual(case.by_name()["t"][0, 0], 25.0)
        numbers = np.arange(6.0)
        np.testing.assert_array_equal(case.by_name(numbers)["t"],
                                      numbers.reshape(2, 3))
        one = case.by_name({"t[2, 1]": 30.0})["t"]
        self.assertEqual((one[1, 0], one.sum()), (30.0, 155.0))
        np.testing.assert_array_equal(case.by_name({"t": 26})["t"],
                                      np.full((2, 3), 26.0))
        np.testing.assert_array_equal(
            case.by_name({"t": numbers.reshape(2, 3)})["t"].ravel(), numbers)
        for wrong, told in (
                ({"t": numbers}, "array of shape \\(6,\\), expected \\(2, 3\\)"),
                ({"t": numbers.reshape(3, 2)}, "expected \\(2, 3\\) or one"),
                ({"t[1,1]": [1.0]}, "expected one number"),
                ({"t": "much"}, "expected numbers"),
                ({"t[3,1]": 1.0}, "no design variable 't\\[3,1\\]'"),
                ({"u": 1.0}, "no design variable 'u'.*there are: t"),
                (numbers[:5], "expected \\(6,\\): t")):
            with self.assertRaisesRegex(meniscus.InvalidInput, told):
                case.by_name(wrong)
        own = meniscus.with_overrides(case, {
            "t": np.linspace(21.0, 26.0, 6).reshape(2, 3), "t[1,2]": 30})
        np.testing.assert_array_equal(own.by_name()["t"],
                                      [[21, 30, 23], [24, 25, 26]])
        tree = tomllib.loads(PETALS.read_text())
        tree["design"]["t"]["initial"] = np.full((2, 3), 27.0)
        self.assertEqual(meniscus.make_case(tree).by_name()["t"].sum(), 162.0)
        self.assertEqual(bracket().by_name(), {"support_x": 0.0})

    def test_overrides(self):
        case = meniscus.read_case(CASE, {
            "load_left": np.float64(1.5e4), "support_x": -3,
            "study.method": "bobyqa"})
        self.assertEqual(case.parameters()["load_left"], 1.5e4)
        self.assertEqual(case.initial_design[0], -3.0)
        again = meniscus.with_overrides(case, ["load_left=2e4"])
        self.assertEqual(again.parameters()["load_left"], 2e4)
        self.assertEqual(again.initial_design[0], -3.0)
        self.assertNotEqual(again.hash, case.hash)
        tenth = meniscus.with_overrides(case, {"load_left": 0.1 + 0.2})
        self.assertEqual(tenth.parameters()["load_left"], 0.1 + 0.2)

    def test_a_dict_is_the_same_case(self):
        for path in (CASE, STRUTS,
                     CASE.parents[1] / "two_arm_sized" / "case.toml"):
            tree = tomllib.loads(path.read_text())
            self.assertEqual(tomllib.loads(meniscus.case_text(tree)), tree)
            self.assertEqual(meniscus.make_case(tree).hash,
                             meniscus.read_case(path).hash)

    def test_numpy_and_odd_names_in_a_dict(self):
        tree = {"a key": {"x": np.array([1.5, 2]), "n": np.int64(3),
                          "yes": True, "t": 'quote " and ü\n'},
                "empty": {}, "list": [{"a": 1}, {"b": [0.1, "c"]}]}
        self.assertEqual(
            tomllib.loads(meniscus.case_text(tree)),
            {"a key": {"x": [1.5, 2.0], "n": 3, "yes": True,
                       "t": 'quote " and ü\n'},
             "empty": {}, "list": [{"a": 1}, {"b": [0.1, "c"]}]})
        with self.assertRaisesRegex(TypeError, "found None"):
            meniscus.case_text({"a": None})
        with self.assertRaisesRegex(TypeError, "must be a str"):
            meniscus.case_text({1: 2})

    def test_wrong_cases_are_told_by_line(self):
        text = CASE.read_text().replace("radius = 35", "radios = 35")
        line = 1 + text[:text.index("radios")].count("\n")
        with self.assertRaisesRegex(meniscus.InvalidInput,
                                    rf"my\.toml:{line}: .*radius"):
            meniscus.parse_case(text, path="my.toml")
        tree = tomllib.loads(CASE.read_text())
        tree["curves"]["left"]["radius"] = "50 kg"
        with self.assertRaises(ValueError) as caught:
            meniscus.make_case(tree)
        line = int(str(caught.exception).split(":")[1])
        self.assertIn("50 kg",
                      meniscus.case_text(tree).splitlines()[line - 1])
        with self.assertRaisesRegex(meniscus.InvalidInput,
                                    "--set load_lft=1: .*'load_left'"):
            meniscus.read_case(CASE, {"load_lft": 1})
        with self.assertRaisesRegex(meniscus.InvalidInput, "no such file"):
            meniscus.read_case("nowhere.toml")
        with self.assertRaisesRegex(TypeError, "not a single str"):
            meniscus.read_case(CASE, "load_left=1")
        with self.assertRaises(meniscus.Error):
            meniscus.parse_case("")


class PublicNames(PackageTest):
    def members(self, kind):
        return [name for name in vars(kind)
                if not name.startswith("_") or name in (
                    "__getitem__", "__len__", "__call__")]

    def test_every_public_name_has_a_type(self):
        stub = ast.parse(pathlib.Path(meniscus.__file__).with_suffix(
            ".pyi").read_text())
        typed = {node.name: node for node in stub.body
                 if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual(set(typed), set(meniscus.__all__))
        for name, node in typed.items():
            known = getattr(meniscus, name)
            if not inspect.isclass(known) or issubclass(known, Exception):
                continue
            inside = {item.name for item in node.body
                      if isinstance(item, ast.FunctionDef)} - {"__init__"}
            self.assertEqual(inside, set(self.members(known)), name)

    def test_every_public_name_is_documented(self):
        def own_words(text):
            """Without the signature that pybind11 puts first."""
            lines = (text or "").strip().splitlines()
            return [line for line in lines[1 if "->" in (
                lines or [""])[0] else 0:] if line.strip()]

        self.assertTrue(own_words(meniscus.__doc__))
        for name in meniscus.__all__:
            known = getattr(meniscus, name)
            self.assertTrue(own_words(known.__doc__), name)
            if not inspect.isclass(known) or issubclass(known, Exception):
                continue
            for member in self.members(known):
                self.assertTrue(own_words(getattr(known, member).__doc__),
                                f"{name}.{member}")

    def test_arguments_are_those_of_the_types(self):
        def told(known):
            """Names of arguments, from Python or pybind11's first line."""
            try:
                return list(inspect.signature(known).parameters)
            except ValueError:
                first = known.__doc__.strip().splitlines()[0]
                inside = first[first.index("(") + 1:first.rindex(") ->")]
                return re.findall(r"(?:^|, )(\w+):", inside)

        def typed(function):
            return [a.arg for a in (*function.args.args,
                                    *function.args.kwonlyargs)]

        stub = pathlib.Path(meniscus.__file__).with_suffix(".pyi").read_text()
        for node in ast.parse(stub).body:
            if isinstance(node, ast.FunctionDef):
                self.assertEqual(typed(node), told(getattr(
                    meniscus, node.name)), node.name)
            for item in getattr(node, "body", []):
                if isinstance(item, ast.FunctionDef) and not (
                        item.decorator_list):
                    known = getattr(getattr(meniscus, node.name), item.name)
                    self.assertEqual(typed(item)[1:], told(known)[1:],
                                     f"{node.name}.{item.name}")

    def test_arrays_tell_shape_and_kind(self):
        stub = pathlib.Path(meniscus.__file__).with_suffix(".pyi").read_text()
        for node in ast.parse(stub).body:
            for item in getattr(node, "body", []):
                if isinstance(item, ast.FunctionDef) and "_Floats" in (
                        ast.unparse(item.returns)):
                    doc = getattr(getattr(meniscus, node.name),
                                  item.name).__doc__
                    self.assertRegex(doc, r"float64.*\(\w", item.name)


if __name__ == "__main__":
    unittest.main(verbosity=2)
