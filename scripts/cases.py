"""The cases' expectations: cases/NAME/expected.json read, run and compared.

cases/README.md describes the format. Both users, scripts/gallery and
tests/regression/case_test.py, go through here."""
import json
import math
import os
import pathlib
import re
import resource
import shlex
import shutil
import subprocess
import sys
import tempfile
import time

import peers

ROOT = pathlib.Path(__file__).resolve().parents[1]
CASES = ROOT / "cases"
# How far a figure of a kind may be off what is expected, relatively.
ROOM = {"film": 0.005, "displacement": 0.02, "stress": 0.05}
# What a command leaves to read figures from.
RESULT = {"run": "result.json", "evolve": "film.json",
          "compare": "compare.json", "check-gradient": None}
SECONDS = 180  # of one run at its default size on two cores
KEYS = {
    "case": {"prepare", "runs", "convergence", "wrong"},
    "run": {"name", "command", "quick", "long", "seconds", "exit", "pictures",
            "expected", "expected_quick", "calculix", "evolver"},
    "calculix": {"displacement", "stress", "peak"},
    "figure": {"value", "kind", "relative", "absolute", "why", "label",
               "unit", "scale", "reference", "of", "at_least", "at_most"},
    "picture": {"file", "name", "caption"},
    "convergence": {"path", "runs", "exact", "order", "absolute", "label"},
    "wrong": {"what", "command", "replace", "exit", "says"},
}


class BadFormat(Exception):
    """expected.json is not as cases/README.md says."""


def check(condition, where, message):
    if not condition:
        raise BadFormat(f"{where}: {message}")


def check_keys(what, table, where, needed=()):
    check(isinstance(table, dict), where, "a table is expected")
    for key in table:
        check(key in KEYS[what], where,
              f"unknown key '{key}', there are {', '.join(sorted(KEYS[what]))}")
    for key in needed:
        check(key in table, where, f"'{key}' is missing")


def room_of(figure):
    """Largest difference allowed."""
    if "absolute" in figure:
        return figure["absolute"]
    return abs(figure["value"]) * figure.get("relative",
                                             ROOM.get(figure.get("kind"), 0))


def check_figure(figure, where):
    if isinstance(figure, (str, bool, int)):
        return
    check_keys("figure", figure, where)
    if "value" in figure and figure["value"] is None:
        raise BadFormat(f"{where}: no value yet; scripts/gallery --fill")
    check(("reference" in figure) == ("of" in figure), where,
          "a reference says of whom ('of'), and nothing else does")
    if "value" not in figure:
        check("at_least" in figure or "at_most" in figure, where,
              "neither 'value' nor 'at_least' nor 'at_most'")
        return
    kind = figure.get("kind")
    check(kind is None or kind in ROOM, where,
          f"kind '{kind}' is none of {', '.join(ROOM)}")
    check("relative" not in figure or "absolute" not in figure, where,
          "'relative' and 'absolute' are both there")
    check(kind or "relative" in figure or "absolute" in figure, where,
          "no 'kind', and neither 'relative' nor 'absolute'")
    usual = abs(figure["value"]) * ROOM[kind] if kind else 0.0
    check(room_of(figure) <= usual or figure.get("why"), where,
          f"{room_of(figure):g} is more room than {usual:g}: say 'why'")


def read(folder, unfilled=False):
    """expected.json of a case, checked; `unfilled`: but for its figures. Throws
    BadFormat."""
    path = folder / "expected.json"
    where = f"{folder.name}/expected.json"
    try:
        spec = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, json.JSONDecodeError) as error:
        raise BadFormat(f"{where}: {error}") from error
    check_keys("case", spec, where, ["runs"])
    if "prepare" in spec:
        check((folder / spec["prepare"]).is_file(), where,
              f"prepare: no {spec['prepare']} in the folder")
    names = [run.get("name") for run in spec["runs"]]
    check(names and len(set(names)) == len(names), where,
          "runs need names of their own")
    for run in spec["runs"]:
        at = f"{where}: run '{run.get('name')}'"
        check_keys("run", run, at, ["name", "command", "expected"])
        command = shlex.split(run["command"])
        check(command and command[0] in RESULT, at,
              f"the command is none of {', '.join(RESULT)}")
        if "quick" in run:
            check("expected_quick" in run, at, "'expected_quick' is missing")
        check(not run.get("long") or "quick" in run, at,
              "'long' is for quick sizes")
        for peer in {"calculix", "evolver"} & set(run):
            check("quick" in run and command[0] == "run", at,
                  f"'{peer}' is for quick sizes of 'run'")
        if "calculix" in run:
            check_keys("calculix", run["calculix"], at, ["displacement"])
        for table in () if unfilled else ("expected", "expected_quick"):
            for name, figure in run.get(table, {}).items():
                check_figure(figure, f"{at}: {table}: {name}")
        for picture in run.get("pictures", []):
            check_keys("picture", picture, at, ["file", "name", "caption"])
    check(any("quick" in run and not run.get("long")
              for run in spec["runs"]), where,
          "no run has a quick size")
    for item in spec.get("convergence", []):
        check_keys("convergence", item, where,
                   ["path", "runs", "exact", "order", "absolute"])
        check(len(item["runs"]) > 1 and set(item["runs"]) <= set(names), where,
              f"convergence over {item['runs']}: two runs or more are needed")
    for item in spec.get("wrong", []):
        check_keys("wrong", item, where, ["what", "exit", "says"])
    return spec


def text_of(spec):
    """As expected.json is written: a figure a line."""
    text = json.dumps(spec, indent=2, ensure_ascii=False)
    text = re.sub(r"\{\n\s+([^{}\[\]]*?)\n\s+\}",
                  lambda m: "{ " + re.sub(r"\n\s+", " ", m.group(1)) + " }",
                  text)
    return text + "\n"


def prepare(program, folder, spec, out):
    """Files that a case's runs read and nobody wants to keep: its script
    writes them into `out`, by the program where it needs it."""
    out.mkdir(parents=True, exist_ok=True)
    if "prepare" in spec:
        subprocess.run([sys.executable, str(folder / spec["prepare"]),
                        str(out), str(program)], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL, timeout=600)


def fill(program, folder, out):
    """Runs both sizes of a case and puts what comes out where expected.json
    has a value of null."""
    spec = read(folder, unfilled=True)
    # Later runs read earlier ones of their own size.
    for quick, place in ((False, out), (True, out / "quick")):
        prepare(program, folder, spec, place)
        for run in spec["runs"]:
            table = run.get("expected_quick" if quick else "expected", {})
            open_figures = {path: figure for path, figure in table.items()
                            if isinstance(figure, dict) and
                            figure.get("value", 0) is None}
            if quick and "quick" not in run:
                continue
            result = execute(program, folder, {**run, "expected": {},
                                               "expected_quick": {}},
                             place, quick).result
            for path, figure in open_figures.items():
                found = find(result, path)
                check(isinstance(found, (int, float)), folder.name,
                      f"{path} is {found}")
                figure["value"] = float(f"{found:.5g}")
    (folder / "expected.json").write_text(text_of(spec), encoding="utf-8")


def folders():
    """All cases: folders with a case or a datafile in them."""
    return sorted(path for path in CASES.iterdir() if path.is_dir())


def find(result, path):
    """The figure at a path of keys; lists are searched by 'name', or counted.
    A key may have dots in it. None where there is no such figure."""
    def walk(value, keys):
        if not keys:
            return value
        for n in range(len(keys), 0, -1):
            key = ".".join(keys[:n])
            found = None
            if isinstance(value, list):
                found = next((v for v in value if isinstance(v, dict) and
                              v.get("name") == key), None)
                if found is None and key.isdigit() and int(key) < len(value):
                    found = value[int(key)]
            elif isinstance(value, dict):
                found = value.get(key)
            if found is not None:
                below = walk(found, keys[n:])
                if below is not None:
                    return below
        return None
    return walk(result, path.split("."))


class Row:
    """A figure as expected and as found."""

    def __init__(self, path, figure, found):
        self.path = path
        self.figure = figure if isinstance(figure, dict) else {"value": figure}
        self.label = self.figure.get("label", path)
        self.unit = self.figure.get("unit", "")
        self.wanted = self.figure.get("value")
        self.found = found
        self.exact = not isinstance(figure, dict)
        self.fine = self.judge()

    def judge(self):
        if self.exact:
            return type(self.found) is type(self.wanted) and \
                self.found == self.wanted
        if not isinstance(self.found, (int, float)) or \
                not math.isfinite(self.found):
            return False
        if self.found < self.figure.get("at_least", -math.inf) or \
                self.found > self.figure.get("at_most", math.inf):
            return False
        return self.wanted is None or \
            abs(self.found - self.wanted) <= room_of(self.figure)

    def bounds(self):
        """What was asked, in words."""
        if self.exact:
            return str(self.wanted)
        words = []
        if self.wanted is not None:
            words.append(f"{self.wanted:g} +- {room_of(self.figure):.3g}")
        for key in ("at_least", "at_most"):
            if key in self.figure:
                words.append(f"{key.replace('_', ' ')} {self.figure[key]:g}")
        return ", ".join(words)

    def __str__(self):
        return f"{self.path}: {self.found}, expected {self.bounds()}"


class Outcome:
    """What a run came to."""

    def __init__(self, run):
        self.run = run
        self.rows = []
        self.problems = []
        self.seconds = 0.0     # of the clock
        self.processor = 0.0   # of all cores, children included
        self.result = {}
        self.folder = None


def child_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def arguments_of(run, out, quick, pictures):
    words = shlex.split(run["command"])
    if quick:
        words += shlex.split(run["quick"])
    # The folder may hold spaces.
    words = [word.replace("{out}", str(out)) for word in words]
    if RESULT[words[0]]:
        words += ["--out", str(out / run["name"])]
    words.append("--quiet")
    wanted = pictures and run.get("pictures")
    if words[0] in ("run", "evolve") and not wanted:
        words.append("--no-pictures")
    return words


def execute(program, folder, run, out, quick=False, pictures=False):
    """Runs one run of a case into out/NAME and compares. `program`: the
    executable; at quick size only what `expected_quick` holds counts."""
    outcome = Outcome(run)
    outcome.folder = out / run["name"]
    out.mkdir(parents=True, exist_ok=True)
    words = arguments_of(run, out, quick, pictures)
    limit = run.get("seconds", SECONDS)
    before, start = child_seconds(), time.monotonic()
    try:
        done = subprocess.run([str(program), *words], cwd=folder,
                              capture_output=True, text=True,
                              timeout=10 * limit)
    except subprocess.TimeoutExpired:
        outcome.problems.append(f"still running after {10 * limit} s")
        return outcome
    outcome.seconds = time.monotonic() - start
    outcome.processor = child_seconds() - before
    if done.returncode != run.get("exit", 0):
        outcome.problems.append(
            f"exit {done.returncode}, expected {run.get('exit', 0)}: "
            f"{' '.join(words)}\n{done.stdout}{done.stderr}")
    # On a machine that is busy elsewhere the clock is no measure.
    if min(outcome.seconds, outcome.processor) > limit:
        outcome.problems.append(
            f"took {outcome.seconds:.0f} s, {outcome.processor:.0f} s of "
            f"processor time; {limit} s are allowed")
    if not RESULT[words[0]]:
        return outcome
    file = outcome.folder / RESULT[words[0]]
    if not file.exists():
        outcome.problems.append(f"no {file.name}")
        return outcome
    outcome.result = json.loads(file.read_text(encoding="utf-8"))
    wanted = run["expected_quick" if quick else "expected"]
    outcome.rows = [Row(path, figure, find(outcome.result, path))
                    for path, figure in wanted.items()]
    for peer, program_of_peer, rows in (
            ("calculix", "ccx", calculix_rows),
            ("evolver", "evolver", evolver_rows)):
        if quick and peer in run and (shutil.which(program_of_peer) or
                                      "MENISCUS_NO_SKIPS" in os.environ):
            try:
                outcome.rows += rows(program, outcome, out)
            except peers.NoPeer as error:
                outcome.problems.append(str(error))
    outcome.problems += [str(row) for row in outcome.rows if not row.fine]
    return outcome


def calculix_rows(program, outcome, out):
    """The run's final design in CalculiX: all nodal displacements, and where it
    is asked the von Mises stress's mean by volume and peak."""
    asked = outcome.run["calculix"]
    rows = []
    for peer in peers.solve(program, outcome.folder,
                                    out / f"{outcome.run['name']} in calculix"):
        rows.append(Row(f"calculix.{peer.name}.displacement",
                        {"at_most": asked["displacement"]}, peer.apart))
        for key, name, theirs in (("stress", "von_mises.mean", peer.mean),
                                  ("peak", "readings.points", peer.peak)):
            if key in asked:
                ours = find(outcome.result, f"stress.{peer.name}.{name}")
                rows.append(Row(f"calculix.{peer.name}.{name}",
                                {"value": theirs, "relative": asked[key],
                                 "reference": theirs, "of": "CalculiX"}, ours))
    return rows


def evolver_rows(program, outcome, out):
    """The film's energy and volumes as Surface Evolver has them."""
    energy, volume = peers.evolver_energy(
        program, outcome.folder, out / f"{outcome.run['name']} in evolver")
    film = outcome.result["film"]
    held = sum(body["volume"] for body in film["bodies"].values())
    return [Row(f"evolver.{name}", {"value": theirs, "reference": theirs,
                                    "relative": outcome.run["evolver"],
                                    "of": "Surface Evolver"}, ours)
            for name, theirs, ours in (("energy", energy, film["energy"]),
                                       ("volume", volume, held))]


class Rate:
    """How an error falls over runs, each refined once more than the last."""

    def __init__(self, item, outcomes):
        self.item = item
        values = [find(outcomes[name].result, item["path"])
                  for name in item["runs"] if name in outcomes]
        self.values = [v for v in values if v is not None]
        self.errors = [abs(v - item["exact"]) for v in self.values]
        self.orders = [math.log2(a / b) for a, b in
                       zip(self.errors, self.errors[1:]) if a > 0 and b > 0]

    def problems(self):
        name = self.item.get("label", self.item["path"])
        if not self.orders:
            return [f"{name}: no order, values {self.values}"]
        return [f"{name}: observed order {order:.3f}, expected "
                f"{self.item['order']} +- {self.item['absolute']}"
                for order in self.orders
                if abs(order - self.item["order"]) > self.item["absolute"]]


def run_case(program, folder, spec, out, quick=False, pictures=False,
             more=True):
    """All runs of a case, in order: outcomes by name, rates. At the quick size
    those that are long only with `more`."""
    outcomes = {}
    prepare(program, folder, spec, out)
    for run in spec["runs"]:
        if quick and ("quick" not in run or run.get("long") and not more):
            continue
        outcomes[run["name"]] = execute(program, folder, run, out, quick,
                                        pictures)
    rates = []
    for item in spec.get("convergence", []):
        here = [name for name in item["runs"] if name in outcomes]
        if len(here) > 1:
            rates.append(Rate(item, outcomes))
    return outcomes, rates


def run_wrong(program, folder, item):
    """A case made wrong, in a copy of its folder. Returns what is not as it
    should be, or nothing."""
    with tempfile.TemporaryDirectory(prefix="meniscus wrong ") as place:
        copy = pathlib.Path(place) / folder.name
        shutil.copytree(folder, copy)
        case = copy / "case.toml"
        text = case.read_text(encoding="utf-8")
        for old, new in item.get("replace", {}).items():
            if old not in text:
                return f"{item['what']}: no {old!r} in case.toml"
            text = text.replace(old, new, 1)
        case.write_text(text, encoding="utf-8")
        words = shlex.split(item.get("command", "check case.toml"))
        if RESULT.get(words[0]):
            words += ["--out", str(pathlib.Path(place) / "out"), "--quiet"]
        if words[0] in ("run", "evolve"):
            words.append("--no-pictures")
        done = subprocess.run([str(program), *words], cwd=copy,
                              capture_output=True, text=True, timeout=600,
                              env={**os.environ})
        said = done.stdout + done.stderr
        if done.returncode != item["exit"] or not re.search(item["says"], said):
            return (f"{item['what']}: exit {done.returncode}, expected "
                    f"{item['exit']} with {item['says']!r}:\n{said}")
    return ""
