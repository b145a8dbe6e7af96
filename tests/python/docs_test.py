#!/usr/bin/env python3
"""Every block of docs/python.md runs, one after the other."""
import contextlib
import io
import os
import re
import unittest

from support import ROOT, PackageTest


class Docs(PackageTest):
    def test_every_block_runs(self):
        text = (ROOT / "docs" / "python.md").read_text()
        blocks = list(re.finditer(r"```python\n(.*?)```", text, re.S))
        self.assertGreater(len(blocks), 4)
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        os.chdir(ROOT)
        names = {}
        for block in blocks:
            line = text[:block.start(1)].count("\n")
            code = compile("\n" * line + block.group(1), "docs/python.md",
                           "exec")
            with contextlib.redirect_stdout(io.StringIO()):
                exec(code, names)  # noqa: S102, the point of the test


if __name__ == "__main__":
    unittest.main(verbosity=2)
