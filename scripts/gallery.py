#!/usr/bin/env python3
"""Runs the cases, compares them with their expected.json and writes
docs/gallery: README.md, pictures, and the result table of each case's README.
usage: gallery.py [--quick] [--fill] [--out DIR] PROGRAM [CASE...]
  --quick  quick sizes, and nothing is written but to DIR
  --fill   only puts what comes out where an expected.json has the value null"""
import argparse
import html
import pathlib
import re
import sys
import tempfile

import cases

GALLERY = cases.ROOT / "docs" / "gallery"
WIDTHS = (1200, 1080, 960, 840, 720)  # [pixel], the first that is small enough
LARGEST = 300 * 1000  # [byte]
BEGIN, END = "<!-- results -->", "<!-- /results -->"


def save_picture(source, target):
    """Scaled, so that a page of many stays small. Never with fewer colours: a
    palette drops the rare ones, which in a stress picture are the peaks."""
    from PIL import Image  # only here: quick sizes do without

    with Image.open(source) as picture:
        picture = picture.convert("RGB")
        for width in WIDTHS:
            width = min(width, picture.width)
            picture.resize(
                (width, round(picture.height * width / picture.width)),
                Image.LANCZOS).save(target, optimize=True)
            if target.stat().st_size < LARGEST:
                return
    raise RuntimeError(f"{target} stays above {LARGEST} bytes")


def number(value):
    if value is None:
        return "none"
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return html.escape(str(value), quote=False)
    return f"{value:.5g}"


def off_by(row):
    if row.wanted is None or row.found is None:
        return "" if row.fine else "**no**"
    text = (f"{100 * (row.found / row.wanted - 1):+.2g} %"
            if row.wanted and "absolute" not in row.figure
            else f"{row.found - row.wanted:+.2g}")
    return text if row.fine else f"**{text}**"


def allowed(row):
    words = []
    if row.wanted is not None:
        words.append(
            f"{row.figure['absolute']:g}" if "absolute" in row.figure
            else f"{100 * cases.room_of(row.figure) / abs(row.wanted):g} %")
    for key, sign in (("at_least", ">="), ("at_most", "<=")):
        if key in row.figure:
            words.append(f"{sign} {scaled(row, row.figure[key])}")
    return ", ".join(words)


def scaled(row, value):
    """In the unit of the table, when it is another one than the file's."""
    factor = row.figure.get("scale", 1)
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return number(value * factor)
    return number(value)


def run_table(outcome, reasons):
    """Figures as a table, what must be equal in a line below it."""
    lines = []
    figures = [row for row in outcome.rows if not row.exact]
    command = f"`{outcome.run['command']}`"
    if figures:
        head = [command, "reference", "expected", "found", "off", "allowed"]
        lines += ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    for row in figures:
        name = (row.label if row.label != row.path else f"`{row.path}`")
        if row.unit:
            name += f" [{row.unit}]"
        why = row.figure.get("why")
        if why:
            if why not in reasons:
                reasons.append(why)
            name += f" ({reasons.index(why) + 1})"
        cells = [name,
                 "" if row.wanted is None else scaled(row, row.wanted),
                 scaled(row, row.found), off_by(row), allowed(row)]
        # Without another source, what is expected is what came out once.
        cells.insert(1, f"{scaled(row, row.figure['reference'])}, "
                     f"{row.figure['of']}" if "reference" in row.figure
                     else "snapshot" if row.wanted is not None else "")
        lines.append("| " + " | ".join(cells) + " |")
    equal = ", ".join(
        f"`{row.path}` {number(row.found)}" +
        ("" if row.fine else f" **not {number(row.wanted)}**")
        for row in outcome.rows if row.exact)
    if equal:
        lines += ["", equal + "." if figures else f"{command}: {equal}."]
    return lines + [""]


def table(outcomes, rates):
    lines = []
    reasons = []
    for outcome in outcomes.values():
        if outcome.rows:
            lines += run_table(outcome, reasons)
        elif not outcome.problems:
            lines += [f"`{outcome.run['command']}`: exit "
                      f"{outcome.run.get('exit', 0)}, as asked.", ""]
    if rates:
        lines += ["| error over the runs | exact | errors | observed order | "
                  "expected |", "|---|---|---|---|---|"]
        for rate in rates:
            lines.append("| {} | {:.8g} | {} | {} | {} +- {} |".format(
                rate.item.get("label", f"`{rate.item['path']}`"),
                rate.item["exact"],
                ", ".join(f"{e:.2e}" for e in rate.errors),
                ", ".join(f"{o:.2f}" for o in rate.orders),
                rate.item["order"], rate.item["absolute"]))
        lines.append("")
    for k, why in enumerate(reasons, 1):
        lines.append(f"({k}) {why}")
        lines.append("")
    return "\n".join(lines).rstrip() + "\n"


class Page:
    """A case's part of the gallery: what its folder says, results included."""

    def __init__(self, folder, spec):
        self.folder = folder
        self.name = folder.name
        self.text = (folder / "README.md").read_text(encoding="utf-8")
        self.pictures = [picture for run in spec["runs"]
                         for picture in run.get("pictures", [])]

    def title(self):
        return re.search(r"^# (.+)$", self.text, re.MULTILINE).group(1)

    def question(self):
        """The README's first paragraph that is no sketch, its links as the
        gallery has them."""
        for paragraph in self.text.split("\n\n")[1:]:
            if re.match(r"[A-Z]", paragraph):
                return paragraph.strip().replace("](../", "](../../cases/")
        return ""

    def table(self):
        return self.text.split(BEGIN)[1].split(END)[0].strip()

    def write_table(self, text):
        """Into the case's own README, between its marks."""
        pattern = re.compile(f"{BEGIN}.*?{END}", re.DOTALL)
        if not pattern.search(self.text):
            raise RuntimeError(f"{self.name}/README.md has no {BEGIN}")
        self.text = pattern.sub(lambda _: f"{BEGIN}\n{text}{END}", self.text)
        (self.folder / "README.md").write_text(self.text, encoding="utf-8")

    def row(self, figures):
        return (f"| [{self.title()}](#{anchor(self.title())}) | "
                f"[cases/{self.name}](../../cases/{self.name}/README.md) | "
                f"{figures} |")

    def section(self):
        text = [f"## {self.title()}", "", self.question(), ""]
        for picture in self.pictures:
            text += [f"![{picture['caption']}]({picture['name']})", "",
                     f"*{picture['caption']}*", ""]
        return "\n".join([*text, self.table(), ""])


def anchor(title):
    """As GitHub makes it."""
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


INTRO = """# Gallery

Written by `./scripts/gallery`, which runs the folders of [cases](../../cases/README.md),
compares each with its `expected.json` and draws it. Allowed are 0.5 % for figures of
films, 2 % for displacements, 5 % for stresses; wider rooms have their reason below the
table. Seconds are those of the clock and of the processor, all runs and pictures of the
case, on two cores that other work may share.

| part | folder | figures | as expected | s | s of processor |
|---|---|---|---|---|---|
"""


def figures_of(outcomes, rates):
    """The cells of a case that was run."""
    count = sum(len(o.rows) or 1 for o in outcomes.values()) + len(rates)
    wrong = len(problems_of(outcomes, rates))
    return " | ".join([
        str(count), f"**{wrong} not**" if wrong else "all",
        f"{sum(o.seconds for o in outcomes.values()):.0f}",
        f"{sum(o.processor for o in outcomes.values()):.0f}"])


def problems_of(outcomes, rates):
    problems = [text for o in outcomes.values() for text in o.problems]
    return problems + [text for rate in rates for text in rate.problems()]


def write_gallery(figures):
    """The whole page; of cases that were not run now what it said before."""
    path = GALLERY / "README.md"
    before = path.read_text(encoding="utf-8") if path.exists() else ""
    pages = [Page(folder, cases.read(folder)) for folder in cases.folders()]
    rows = []
    for page in pages:
        told = re.search(rf"cases/{page.name}/README.md\) \| (.*) \|$",
                         before, re.MULTILINE)
        rows.append(page.row(figures.get(
            page.name, told.group(1) if told else "not run | | |")))
    text = INTRO + "\n".join(rows) + "\n\n"
    text += "\n".join(page.section() for page in pages)
    path.write_text(text.rstrip() + "\n", encoding="utf-8")


def parse():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--fill", action="store_true")
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("cases", nargs="*")
    return parser.parse_args()


def main():
    arguments = parse()
    program = arguments.program.resolve()
    known = cases.folders()
    chosen = [f for f in known
              if not arguments.cases or f.name in arguments.cases]
    if len(chosen) < len(set(arguments.cases)):
        sys.exit(f"there are {', '.join(f.name for f in known)}")
    out = arguments.out or pathlib.Path(tempfile.mkdtemp(prefix="gallery-"))
    GALLERY.mkdir(parents=True, exist_ok=True)
    figures = {}
    failed = False
    for folder in chosen:
        print(f"{folder.name} ...", flush=True)
        if arguments.fill:
            cases.fill(program, folder, (out / folder.name).resolve())
            continue
        spec = cases.read(folder)
        outcomes, rates = cases.run_case(
            program, folder, spec, (out / folder.name).resolve(),
            arguments.quick, not arguments.quick)
        text = table(outcomes, rates)
        print(text)
        for problem in problems_of(outcomes, rates):
            print(f"  NOT AS EXPECTED: {problem}", flush=True)
            failed = True
        if arguments.quick:
            continue
        figures[folder.name] = figures_of(outcomes, rates)
        for outcome in outcomes.values():
            for picture in outcome.run.get("pictures", []):
                save_picture(outcome.folder / picture["file"],
                             GALLERY / picture["name"])
        Page(folder, spec).write_table(text)
        write_gallery(figures)
    print(f"results in {out}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
