"""Runs: a study into a folder, and what a finished folder holds."""
from __future__ import annotations

import json
import os
import pathlib
from typing import Any, Callable, Optional

import numpy

from . import _meniscus
from ._meniscus import Case, Evaluations, InvalidInput, IoError

Progress = Callable[[str, str, Optional[float]], object]


class Run:
    """A results folder, read once: its result.json and its evaluations."""

    def __init__(self, folder: "str | os.PathLike[str]") -> None:
        """Reads FOLDER/result.json. Raises IoError."""
        self._folder = pathlib.Path(folder)
        path = self._folder / "result.json"
        try:
            text = path.read_text(encoding="utf-8")
        except OSError as error:
            raise IoError(f"{path}: {error.strerror}; is the run finished, and "
                          "this its folder?") from None
        try:
            self._result = json.loads(text)
            self._status = str(self._result["status"])
            self._message = str(self._result["message"])
        except (ValueError, TypeError, KeyError) as error:
            raise IoError(f"{path} is no result of a run: {error!r}") from None
        self._evaluations: Optional[Evaluations] = None

    @property
    def folder(self) -> pathlib.Path:
        """The results folder."""
        return self._folder

    @property
    def result(self) -> "dict[str, Any]":
        """All of result.json (docs/results.md)."""
        return self._result

    @property
    def status(self) -> str:
        """'converged', 'infeasible', 'stopped', 'failed', 'error' or
        'interrupted'."""
        return self._status

    @property
    def message(self) -> str:
        """Why the run ended, in words."""
        return self._message

    @property
    def parameters(self) -> "dict[str, Any]":
        """Design variables at the answer and parameters, by name, in the
        case's units: floats, of a vector of design variables an array of its
        shape."""
        found = self._result.get("parameters") or {}
        return {name: numpy.array(value, dtype=float)
                if isinstance(value, list) else value
                for name, value in found.items()}

    @property
    def responses(self) -> "dict[str, float]":
        """Responses of the answer by name, in the case's units; empty without
        an answer."""
        return dict(self._result.get("responses") or {})

    @property
    def evaluations(self) -> Evaluations:
        """The evaluations in the study's database. Raises IoError; a family
        has none of its own."""
        if self._evaluations is None:
            self._evaluations = _meniscus._read_study(os.fspath(self._folder))
        return self._evaluations

    @property
    def case(self) -> Case:
        """The case as it was run, overrides included."""
        return self.evaluations._case

    @property
    def answer(self) -> "Optional[numpy.ndarray[Any, Any]]":
        """The answer's design, float64 (design variables,): Model(run.case)
        .evaluate(run.answer) has the responses of result.json to the last
        bit, unless the study went on from another model (`refrozen` there).
        None without an answer."""
        answer = self.evaluations._answer
        return numpy.array(answer) if answer else None

    @property
    def members(self) -> "dict[str, Run]":
        """Of a family the run of each member that has finished, by name."""
        runs = {}
        for member in self._result.get("members") or []:
            folder = self._folder / member["folder"]
            if (folder / "result.json").exists():
                runs[member["name"]] = Run(folder)
        return runs

    def __repr__(self) -> str:
        return f"<meniscus.Run {self._folder}: {self._status}>"


def read_run(folder: "str | os.PathLike[str]") -> Run:
    """The results folder of a finished run (Run). Raises IoError."""
    return Run(folder)


def run_study(case: Case, folder: "str | os.PathLike[str]", *,
              resume: bool = False, jobs: int = 1,
              time_limit: Optional[float] = None,
              estimate_errors: bool = True, pictures: bool = True,
              frames: bool = True, report: bool = True,
              progress: Optional[Progress] = None) -> Run:
    """Runs the study of the case into a folder, as `meniscus run` does, and
    reads it back (Run).

    resume: goes on with the study that is there; jobs: designs (or members)
    side by side, the same bits for any number; time_limit: [s];
    estimate_errors: one more, coarser model for the mesh error; pictures,
    frames, report: False leaves out pictures, films of the design's history,
    report.html; progress: called on this thread with stage, detail and fraction done (or None).

    Ctrl-C, or an exception of progress, stops the study and is raised once
    the folder tells of it; go on with resume=True. Raises InvalidInput,
    IoError.
    """
    if not isinstance(case, Case):
        raise InvalidInput(f"case: expected a meniscus.Case, found {case!r}")
    _meniscus._run_study(case, os.fspath(folder), resume, jobs,
                         0.0 if time_limit is None else float(time_limit),
                         estimate_errors, pictures, frames, report, progress)
    return Run(folder)
