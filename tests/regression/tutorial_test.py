#!/usr/bin/env python3
"""docs/tutorial.md, docs/tutorial-bracket.md, docs/arms.md and docs/spines.md,
done as they say: their commands run in order in an empty folder, their tables are
put into the files that they
name, and what they show is what comes out, but for the clock and the last digits."""
import os
import re
import subprocess
import unittest

import program
from program import ProgramTest

DOCS = program.ROOT / "docs"
CLOSE = 0.02       # of numbers: libraries and processors differ
NOISE = 1e-4       # below it residuals and mismatches are only small
LOOSE = 0.5        # of numbers after +-, of counts, of necks
PLACE = 3.0        # [mm], of coordinates
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
HEADING = re.compile(r"^\[([^\[\]]+)\]", re.MULTILINE)


def blocks(text):
    """(info string, content) of each fenced block, in order."""
    return re.findall(r"^```([^\n]*)\n(.*?)^```$", text,
                      re.MULTILINE | re.DOTALL)


def put_tables(text, new):
    """The file with the block's tables in the place of those of the same
    names; others go to the end. A block with a title is a whole file."""
    if new.startswith("title"):
        return new
    for part in re.split(r"^(?=\[)", new, flags=re.MULTILINE):
        if not part.strip():
            continue
        name = HEADING.match(part).group(1)
        pattern = re.compile(
            r"^\[" + re.escape(name) + r"\].*?(?=^\[|^# \[|\Z)",
            re.MULTILINE | re.DOTALL)
        part = part.rstrip() + "\n\n"
        if pattern.search(text):
            text = pattern.sub(lambda _, part=part: part, text, count=1)
        else:
            text = text.rstrip() + "\n\n" + part
    return text


def same_number(shown, found, before, after):
    if re.match(r" s\b| MB|  *(start|step)$", after):
        return True  # the clock's
    a, b = float(shown), float(found)
    if max(abs(a), abs(b)) < NOISE:
        return (a == 0) == (b == 0)
    if re.search(r" at \([^()]*$", before):
        return abs(a - b) <= PLACE
    loose = (re.search(r"(\+-|neck|width) $", before) or
             re.match(r" (vertices|facets|evaluations)", after))
    room = LOOSE if loose else CLOSE
    return abs(a - b) <= room * max(abs(a), abs(b))


def differences(shown, found):
    """Lines of `shown` that are not in `found`, in order. A line "..." stands
    for any lines, "..." at the end of one for the rest of it."""
    rest = found.splitlines()
    problems = []
    for line in shown.splitlines():
        if line.strip() == "...":
            continue
        at = next((k for k, other in enumerate(rest)
                   if same_line(line, other)), None)
        if at is None:
            problems.append(line)
        else:
            rest = rest[at + 1:]
    return problems


def end_of(pattern, text):
    """Where the part of `text` ends that has the words of `pattern`, in which
    # stands for a number."""
    words = [re.escape(word).replace(r"\#", NUMBER.pattern)
             for word in pattern.split()]
    match = re.match(r"\s*" + r"\s+".join(words), text)
    return match.end() if match else 0


def same_line(shown, found):
    if shown.endswith("..."):
        shown = shown[:-3].rstrip()
        found = found[:end_of(NUMBER.sub("#", shown), found)]
    if [w for w in NUMBER.sub("#", shown).split()] != \
            [w for w in NUMBER.sub("#", found).split()]:
        return False
    ours, theirs = list(NUMBER.finditer(shown)), list(NUMBER.finditer(found))
    return len(ours) == len(theirs) and all(
        same_number(a.group(), b.group(), shown[:a.start()],
                    shown[a.end():]) for a, b in zip(ours, theirs))


class Tutorial(ProgramTest):
    def run_script(self, script):
        path = f"{program.PROGRAM.parent}:{os.environ['PATH']}"
        done = subprocess.run(["bash", "-e"], input=script, text=True,
                              stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, cwd=self.folder,
                              env={**os.environ, "PATH": path}, timeout=300)
        return done.returncode, done.stdout

    def test_everything_in_it(self):
        commands, shown = self.follow(DOCS / "tutorial.md")
        self.assertGreater(commands, 8)
        self.assertGreater(shown, 5)

    @program.more
    def test_bracket(self):
        commands, shown = self.follow(DOCS / "tutorial-bracket.md")
        self.assertGreater(commands, 4)
        self.assertGreater(shown, 4)

    def test_arms(self):
        commands, shown = self.follow(DOCS / "arms.md")
        self.assertGreater(commands, 4)
        self.assertGreater(shown, 2)

    def test_spines(self):
        commands, shown = self.follow(DOCS / "spines.md")
        self.assertGreater(commands, 6)
        self.assertGreater(shown, 3)

    def follow(self, page):
        """Numbers of commands done and of outputs compared."""
        commands = 0
        shown = 0
        code, said = 0, ""
        for info, content in blocks(page.read_text(encoding="utf-8")):
            words = info.split()
            if words[:1] == ["sh"] and "untested" not in words:
                code, said = self.run_script(content)
                wanted = next((int(w[5:]) for w in words
                               if w.startswith("exit=")), 0)
                self.assertEqual(code, wanted, f"{content}\n{said}")
                commands += 1
            elif words[:1] == ["text"]:
                problems = differences(content, said)
                self.assertEqual(problems, [], f"not in what came out:\n{said}")
                shown += 1
            elif words[:1] == ["toml"]:
                self.assertEqual(len(words), 2, f"whose file? {info}")
                path = self.folder / words[1]
                text = path.read_text() if path.exists() else ""
                path.write_text(put_tables(text, content))
        return commands, shown

    def test_what_differs_is_seen(self):
        shown = "film: stable\n...\nmass 2.10 kg +- 0.02 in 3.1 s\n"
        for found, problems in (
                ("film: stable\nx\nmass 2.11 kg +- 0.025 in 9 s\n", 0),
                ("film: stable\nmass 2.2 kg +- 0.02 in 3 s\n", 1),
                ("mass 2.10 kg +- 0.02 in 3 s\nfilm: stable\n", 1),
                ("film: stable\nmass 2.10 g +- 0.02 in 3 s\n", 1),
                ("film: stable\nmass 2.10 kg +- 0.1 in 3 s\n", 1)):
            self.assertEqual(len(differences(shown, found)), problems, found)
        text = "[a]\nx = 1\n\n[b]\ny = 2\n"
        self.assertEqual(put_tables(text, "[a]\nx = 3\n"),
                         "[a]\nx = 3\n\n[b]\ny = 2\n")
        self.assertIn("[c]", put_tables(text, "[c]\nz = 3\n"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
