"""Meniscus designs load-carrying parts with liquid films.

    case = meniscus.read_case("case.toml", {"load_left": 50e3})
    model = meniscus.Model(case)
    evaluation = model.evaluate(case.initial_design)
    evaluation["left_deflection"], evaluation.gradient("left_deflection")

All numbers are in the case's units (case.units). Arrays are read-only views of
the engine's memory, which they keep alive.
"""
from __future__ import annotations

import os as _os
import pathlib as _pathlib
from collections.abc import Mapping as _Mapping
from typing import Any as _Any

from ._helpers import FOLDERS as _FOLDERS

# OpenMP reads this once, when its library is loaded; its threads would
# otherwise spin while they wait, and starve whatever else runs.
_waits = "OMP_WAIT_POLICY"
_quiet = _waits in _os.environ or "GOMP_SPINCOUNT" in _os.environ
if not _quiet:
    _os.environ[_waits] = "passive"
try:
    from . import _meniscus
finally:
    if not _quiet:
        del _os.environ[_waits]

from ._case_text import case_text, override_texts as _override_texts
from ._meniscus import (
    Case, DesignFailed, DesignVariable, Error, Evaluation, Evaluations,
    Failure, Film, FilmModel, Interrupted, InvalidInput, IoError, Mesh,
    MeshError, Model, Response, Solution, SolverError, Stress, Surface, Units,
    __version__, set_threads, threads)
from ._run import Run, read_run, run_study

_here = _pathlib.Path(__file__).resolve().parent
for _folder in _FOLDERS:
    _meniscus._add_helper_folder(str((_here / _folder).resolve()))


def read_case(path: "str | _os.PathLike[str]",
              overrides: _Any = None) -> Case:
    """A case from its file. overrides: {name: value} as for --set: parameters,
    design variables (their initial values) or dotted keys
    ('resolution.fea'); or a list of 'NAME=VALUE'. Raises InvalidInput with
    every problem as 'FILE:LINE: what, found, expected, try'."""
    return _meniscus._read_case_file(_os.fspath(path),
                                     _override_texts(overrides))


def parse_case(text: str, overrides: _Any = None, *,
               path: str = "<text>") -> Case:
    """A case from the text of a case file. path: as messages name it, and for
    files that the case names. Raises as read_case()."""
    return _meniscus._read_case_text(text, path, _override_texts(overrides))


def make_case(tree: "_Mapping[str, _Any]", overrides: _Any = None, *,
              path: str = "<dict>") -> Case:
    """A case from a dict with the tables and keys of a case file; values are
    numbers, text, lists, dicts and NumPy's arrays. Lines of messages are those
    of case_text(tree). Raises as read_case()."""
    return parse_case(case_text(tree), overrides, path=path)


def with_overrides(case: Case, overrides: _Any) -> Case:
    """The same case with these overrides after its own, see read_case()."""
    return _meniscus._read_case_text(
        case.text, case.path, [*case.overrides, *_override_texts(overrides)])


class Remember:
    """evaluate() of a model that computes a design once while the optimizer
    asks for it again: SciPy asks for value, derivatives and constraints one by
    one, each with the same design."""

    def __init__(self, model: Model, size: int = 1) -> None:
        """size: how many of the last designs are kept."""
        self._model = model
        self._size = max(1, int(size))
        self._kept: "dict[bytes, Evaluation]" = {}
        self._count = 0

    @property
    def count(self) -> int:
        """Number of designs that were computed."""
        return self._count

    def __call__(self, design: _Any) -> Evaluation:
        """The evaluation of a design, an array (design variables,)."""
        import numpy
        key = numpy.ascontiguousarray(design, dtype=float).tobytes()
        if key not in self._kept:
            evaluation = self._model.evaluate(design)
            self._count += 1
            while len(self._kept) >= self._size:
                del self._kept[next(iter(self._kept))]
            self._kept[key] = evaluation
        return self._kept[key]


__all__ = [
    "Case", "DesignFailed", "DesignVariable", "Error", "Evaluation",
    "Evaluations", "Failure", "Film", "FilmModel", "Interrupted",
    "InvalidInput", "IoError", "Mesh", "MeshError", "Model", "Remember",
    "Response", "Run", "Solution", "SolverError", "Stress", "Surface", "Units",
    "case_text", "make_case", "parse_case", "read_case", "read_run",
    "run_study", "set_threads", "threads", "with_overrides"]
for _name in __all__:
    globals()[_name].__module__ = "meniscus"
