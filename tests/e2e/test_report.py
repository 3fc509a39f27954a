"""report.html as a reader has it: in a headless Chromium, wide and narrow, light and dark. Skipped without one."""
import os
import pathlib
import random
import unittest

import browser
from harness import HEADER, PolarCase

MOST_BYTES = 5_000_000
# Upright particles that the start `imaged` finds at once.
SMALL = "simulation: {particles: 24, blinks_mean: 3, orientation: in_plane, tilt_std_deg: 10, cramer_rao: false}"
QUICK = "registration: {starts: [imaged]%s}\n"

# Every figure: whether it is there, what it shows, and whether it stays within the window.
FIGURES = """
[...document.querySelectorAll("figure")].map(figure => {
  const svg = figure.querySelector("svg"), canvas = figure.querySelector("canvas"), box = figure.getBoundingClientRect();
  const letters = svg ? [...svg.querySelectorAll("text")].map(t => t.getBoundingClientRect()) : [];
  const frame = svg ? svg.getBoundingClientRect() : box;
  return {
    id: figure.id, state: figure.dataset.figure, caption: figure.querySelector("figcaption")?.textContent ?? "",
    marks: svg ? svg.querySelectorAll("path, rect, image").length : 0,
    drawn: svg ? [...svg.querySelectorAll("path, rect, image")].filter(m => {
      const b = m.getBBox(); return b.width + b.height > 0 }).length : 0,
    lit: canvas ? Number(canvas.dataset.lit) : 0,
    smallest: Math.min(99, ...letters.map(b => b.height)),
    outside: letters.filter(b => b.left < frame.left - 2 || b.right > frame.right + 2).length,
    width: box.width, right: box.right};
})
"""
COLOURS = """(() => { const s = getComputedStyle(document.body);
  return [s.backgroundColor, s.color].map(c => c.match(/\\d+/g).slice(0, 3).map(Number).reduce((a, b) => a + b) / 765) })()"""


@unittest.skipUnless(browser.CHROMIUM, "Chromium is not installed")
class Report(PolarCase):
    def setUp(self):
        super().setUp()
        self.browser = browser.Browser()
        self.addCleanup(self.browser.close)

    def look(self, page, width=1280, dark=False):
        """Opens the page, demands what holds of every page, and returns its figures by id."""
        self.browser.open(page, width, dark)
        self.assertLess(page.stat().st_size, MOST_BYTES)
        self.assertEqual(self.browser.said, [])
        asked = [url for url in self.browser.requests if not url.startswith(("file:", "data:"))]
        self.assertEqual(asked, [])
        figures = self.browser.value(FIGURES)
        self.assertEqual(len({f["id"] for f in figures}), len(figures))
        for figure in figures:
            with self.subTest(page=str(page), width=width, figure=figure["id"]):
                if figure["state"] == "present":
                    self.assertTrue(figure["lit"] > 0 or figure["drawn"] > 0, "is empty")
                    self.assertEqual(figure["outside"], 0, "letters are cut off")
                    self.assertGreater(figure["smallest"], 8, "letters are too small")
                else:
                    self.assertEqual(figure["state"], "absent")
                    self.assertGreater(len(figure["caption"]), 10, "does not say why it is absent")
                self.assertLessEqual(figure["right"], width, "reaches beyond the window")
        self.assertLessEqual(self.browser.value("document.documentElement.scrollWidth"), width)
        ground, ink = self.browser.value(COLOURS)
        self.assertGreater(abs(ground - ink), 0.5, "letters do not stand out")
        self.assertEqual(ground < 0.5, dark)
        keep = os.environ.get("POLAR_SCREENSHOTS")  # to look at them
        if keep:
            name = f"{page.parent.name}_{width}_{'dark' if dark else 'light'}.png"
            self.browser.screenshot(pathlib.Path(keep, name))
        return {f["id"]: f for f in figures}

    def look_at_all(self, page):
        for width in (1280, 400):
            for dark in (False, True):
                figures = self.look(page, width, dark)
        return figures

    def test_page_of_a_run(self):
        self.simulate(SMALL)
        self.ok("run", self.run_config(more=QUICK % ", symmetry: C8" + "output: {resolution: halves}\n"))
        page = self.folder / "results" / "report.html"
        figures = self.look_at_all(page)
        for present in ("projection-xy", "projection-xz", "projection-yz", "slice-xy", "turntable", "fsc", "sphere", "tilt",
                        "in-plane", "log-likelihood", "rotation-std", "translation-std", "gallery-1", "localisations",
                        "calibration", "residual-lateral", "residual-axial", "starts", "rounds", "rounds-score", "time"):
            self.assertEqual(figures[present]["state"], "present", present)
        with self.subTest("the table searches and sorts"):
            rows = "document.querySelectorAll('#particle-table tbody tr').length"
            self.assertEqual(self.browser.value(rows), 24)
            self.browser.value("(() => { const s = document.querySelector('input[type=search]'); s.value = 'no such particle';"
                               "s.dispatchEvent(new Event('input')) })()")
            self.assertEqual(self.browser.value(rows), 0)
            self.browser.value("(() => { const s = document.querySelector('input[type=search]'); s.value = '';"
                               "s.dispatchEvent(new Event('input'));"
                               "document.querySelectorAll('#particle-table th button')[5].click() })()")
            scores = [float(v) for v in self.browser.value(
                "[...document.querySelectorAll('#particle-table tbody tr')].map(r => r.cells[5].textContent).filter(v => v)")]
            self.assertEqual(scores, sorted(scores))
        with self.subTest("the superparticle turns"):
            pixels = "document.getElementById('turn').toDataURL()"
            before = self.browser.value(pixels)
            self.browser.value("document.getElementById('turn').focus()")
            self.browser.key("ArrowRight")
            after = self.browser.value(f"new Promise(done => setTimeout(() => done({pixels}), 300))")
            self.assertNotEqual(before, after)
        with self.subTest("the command, the input's hash and the configuration stand there"):
            text = self.browser.value("document.getElementById('again').innerText")
            for part in ("run.yaml", "localisations.csv", "resolution: halves", "avx" if "avx" in text else "portable"):
                self.assertIn(part, text)

    def test_page_of_noise(self):
        numbers = random.Random(1)
        rows = "".join(",".join(f"{numbers.gauss(0, 30):.3f}" for _ in range(3)) + f",3,3,6,{i % 20}\n"
                       for i in range(20 * 60))
        self.write("data/localisations.csv", HEADER + rows)
        run = ("run", self.run_config(more=QUICK % ""), "--output", "noise")
        self.fails(5, "no particle could be registered", *run)
        page = self.folder / "noise" / "report.html"
        figures = self.look_at_all(page)
        self.assertIn("No structure found", self.browser.value("document.getElementById('verdict').innerText"))
        for shown in ("rejections", "rejected-1"):
            self.assertEqual(figures[shown]["state"], "present")
        self.fails(5, "no particle could be registered", *run)  # given again: not in its own way

    def test_page_of_planar_data_and_written_anew(self):
        self.simulate(SMALL.replace("tilt_std_deg: 10", "planar: true"))
        self.ok("run", self.run_config(more=QUICK % ""))
        page = self.folder / "results" / "report.html"
        self.assertEqual(self.look_at_all(page)["turntable"]["state"], "absent")
        first = page.read_bytes()
        page.unlink()
        self.assertEqual(self.ok("report", "results").strip(), "results/report.html")
        self.assertEqual(page.read_bytes(), first)
        self.ok("report", "results/results.h5", "--output", "other.html")
        self.assertEqual((self.folder / "other.html").read_bytes(), first)
        self.fails(4, "none", "report", "none")
        self.fails(3, "data/localisations.csv", "report", "data/localisations.csv")


if __name__ == "__main__":
    unittest.main()
