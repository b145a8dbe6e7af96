"""The installed package evaluates a case: import_test.py CASE PREFIX."""
import sys

import meniscus

case, prefix = sys.argv[1:]
assert meniscus.__file__.startswith(prefix), meniscus.__file__
model = meniscus.Model(meniscus.read_case(case, {"resolution.fea": 24,
                                                 "resolution.film": 12}))
assert model.evaluate([5.0]).ok
