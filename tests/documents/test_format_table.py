"""scripts/format_table --check: what it demands of a folder outside the project are the files that the document names."""
import importlib.machinery
import importlib.util
import io
import pathlib
import tempfile
import unittest
from contextlib import redirect_stderr, redirect_stdout

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts/format_table"
# Stands in for `polar inspect FILE --json`: a table has as many localisations as bytes.
POLAR = """#!/usr/bin/env python3
import json, os, sys
print(json.dumps({"formats": ["csv"], "planar": True, "localisations": os.path.getsize(sys.argv[2]), "particles": 1,
                  "sigma_assumed": False, "axial_sigma_assumed": False}))
"""


def loaded():
    loader = importlib.machinery.SourceFileLoader("format_table", str(SCRIPT))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("format_table", loader))
    loader.exec_module(module)
    return module


class Check(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.program = loaded()
        self.polar = self.folder / "polar"
        self.polar.write_text(POLAR)
        self.polar.chmod(0o755)
        for name in ("a.csv", "b.csv"):
            self.data(name, "x,y\n")
        self.document = self.folder / "formats.md"
        self.document.write_text(f"before\n{self.program.BEGIN}\n{self.program.END}\nafter\n")
        self.assertEqual(self.run_script()[0], 0)  # fills the list

    def data(self, name, content):
        path = self.folder / "data/formats" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content)
        return path

    def run_script(self, *more):
        said = io.StringIO()
        with redirect_stdout(said), redirect_stderr(said):
            code = self.program.main([str(self.polar), str(self.folder / "data"), str(self.document), *more])
        return code, said.getvalue()

    def test_the_document_as_it_was_made_is_up_to_date(self):
        self.assertIn("`a.csv`: csv, 4 localisations", self.document.read_text())
        self.assertEqual(self.run_script("--check"), (0, ""))

    def test_a_file_more_is_told_and_no_fault(self):
        self.data("c.csv", "x,y\n")
        self.assertEqual(self.run_script("--check"), (0, "not in the document: c.csv\n"))

    def test_a_file_that_is_read_otherwise_is_a_fault(self):
        self.data("b.csv", "x,y\n1,2\n")
        code, said = self.run_script("--check")
        self.assertEqual(code, 1)
        self.assertIn("`b.csv`: csv, 8 localisations", said)
        self.assertNotIn("a.csv", said)

    def test_a_file_that_is_named_and_missing_is_a_fault(self):
        self.data("a.csv", "").unlink()
        code, said = self.run_script("--check")
        self.assertEqual(code, 1)
        self.assertIn("a.csv\nwhich is not in", said)


if __name__ == "__main__":
    unittest.main()
