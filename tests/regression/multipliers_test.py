#!/usr/bin/env python3
"""Multipliers of a minimum: what the program says that a bound is worth,
against the same study with the bound moved."""
import unittest

from program import SIZED_STRUT, ProgramTest

# One mesh for all, so that what moves is the bound alone.
STRUT = SIZED_STRUT.replace('method = "mma"', 'tolerance = 1e-6\n'
                            "refreeze = false")
# Besides the slope there are the minimum's curvature, half of which the means
# of both sides take away, and tolerances of 1e-6 in changes of 5e-3.
WITHIN = 0.01


class Multipliers(ProgramTest):
    def minimum(self, name, *changes):
        out = self.folder / name
        case = self.folder / f"{name}.toml"
        text = STRUT
        for was, now in changes:
            self.assertIn(was, text)
            text = text.replace(was, now)
        case.write_text(text)
        done = self.call("run", case, "--no-pictures", "--out", out)
        self.expect(done, 0)
        return done.stdout, self.result(out)

    def moved(self, was, below, above):
        return (self.minimum("above", (was, above))[1]["objective"] -
                self.minimum("below", (was, below))[1]["objective"])

    def test_a_bound_is_worth_what_its_multiplier_says(self):
        told, result = self.minimum("plain")
        found = result["multipliers"]
        self.assertLess(found["residual"], 1e-6)
        binding = {entry["name"]: entry for entry in found["binding"]}
        sway = binding["sway"]
        self.assertEqual((sway["of"], sway["side"], sway["bound"]),
                         ("constraint", "upper", 0.0075))
        self.assertLess(sway["slope"], 0.0)
        self.assertAlmostEqual(sway["step"], 0.000075, 12)
        self.assertAlmostEqual(sway["change"], sway["slope"] * sway["step"], 15)
        change = self.moved("max = 0.0075", "max = 0.007425",
                            "max = 0.007575")
        self.assertLess(abs(change / (2 * sway["change"]) - 1), WITHIN)
        self.assertRegex(told, r"what binds, and what it is worth \(first-order"
                         r" residual .*\)\n    sway +at most 0.0075 mm +to "
                         r"0.007575 mm +mass -[0-9.e-]+ kg \(-[0-9.]+ %\)")

    def test_so_is_that_of_a_variable(self):
        """With a foot that may not be as wide as it would."""
        def foot_up_to(upper):
            return f"initial = 22.0\nbounds = [20.0, {upper}]"
        free = "initial = 25.0\nbounds = [20.0, 32.0]"
        _, result = self.minimum("narrow", (free, foot_up_to(23)))
        binding = {entry["name"]: entry
                   for entry in result["multipliers"]["binding"]}
        foot = binding["foot"]
        self.assertEqual((foot["of"], foot["side"], foot["bound"]),
                         ("variable", "upper", 23.0))
        change = self.moved(free, foot_up_to(22.77), foot_up_to(23.23))
        self.assertLess(abs(change / (2 * foot["change"]) - 1), WITHIN)


if __name__ == "__main__":
    unittest.main(verbosity=2)
