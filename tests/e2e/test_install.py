"""What is installed beside the program: manual pages, completions, a package, and libraries for others."""
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from harness import POLAR

BUILD = pathlib.Path(os.environ.get("BUILD", "build"))
DOCUMENTS = BUILD / "src/cli/documents"
CMAKE = os.environ.get("CMAKE", "cmake")
CONSUMER = pathlib.Path(__file__).resolve().parents[1] / "consumer"


def output(*command, **options):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=600, **options)
    if done.returncode != 0:
        raise AssertionError(f"{command}: {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


def commands():
    """As --help of the program lists them."""
    listed = output(POLAR, "--help").split("Subcommands:")[1]
    return re.findall(r"^  ([a-z]+) ", listed, re.MULTILINE)


def options(command):
    return re.findall(r"^  (?:-h,)?(--[a-z-]+)", output(POLAR, command, "--help"), re.MULTILINE)


class ManualPages(unittest.TestCase):
    def test_every_command_and_option_has_its_entry(self):
        whole = (DOCUMENTS / "polar.1").read_text().replace("\\-", "-")
        self.assertGreater(len(commands()), 5)
        for command in commands():
            self.assertIn(f"\\fBpolar-{command}\\fR(1)", whole)
            page = (DOCUMENTS / f"polar-{command}.1").read_text().replace("\\-", "-")
            self.assertGreater(len(options(command)), 1)
            for option in options(command):
                self.assertIn(f"\\fB{option}\\fR", page, command)

    @unittest.skipUnless(shutil.which("groff"), "groff is not installed")
    def test_troff_reads_them_without_a_warning(self):
        for page in sorted(DOCUMENTS.glob("*.1")):
            done = subprocess.run(["groff", "-man", "-ww", "-Tascii", "-P-cbou", page], capture_output=True, text=True, timeout=60)
            self.assertEqual((done.returncode, done.stderr), (0, ""), page)
            self.assertIn("NAME", done.stdout)


class Completions(unittest.TestCase):
    def bash(self, *words):
        script = (f'source "{DOCUMENTS}/polar.bash"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _polar;'
                  ' printf "%s\\n" "${COMPREPLY[@]}"')
        return output("bash", "-c", script, "bash", "polar", *words).split()

    def test_bash_offers_commands_options_and_words(self):
        self.assertEqual(set(self.bash("")) - {"-h", "--help", "--version"}, set(commands()))
        self.assertEqual(self.bash("sim"), ["simulate"])
        for command in commands():
            self.assertLessEqual(set(options(command)), set(self.bash(command, "-")), command)
        self.assertEqual(self.bash("run", "--over"), ["--overwrite"])
        self.assertEqual(self.bash("export", "results", "--to", "tif"), ["tiff"])
        self.assertEqual(self.bash("run", "--output", "-"), [])  # bash itself offers files

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
    def test_zsh_reads_it_and_names_every_option(self):
        output("zsh", "-n", DOCUMENTS / "_polar")
        text = (DOCUMENTS / "_polar").read_text()
        for command in commands():
            part = text.split(f"\n    {command})")[1].split(";;")[0]
            for option in options(command):
                self.assertIn(f"'*{option}[", part, command)


class Consumer(unittest.TestCase):
    def test_another_project_finds_builds_and_runs(self):
        with tempfile.TemporaryDirectory(prefix="polar-install-") as folder:
            root = pathlib.Path(folder)
            # Links instead of copies: the libraries of a build with debugging symbols are large.
            output(CMAKE, "--install", BUILD, "--component", "development", "--prefix", root / "prefix",
                   env={**os.environ, "CMAKE_INSTALL_MODE": "ABS_SYMLINK"})
            output(CMAKE, "-S", CONSUMER, "-B", root / "build", f"-DCMAKE_PREFIX_PATH={root / 'prefix'}")
            output(CMAKE, "--build", root / "build")
            table = root / "table.csv"
            table.write_text("x [nm],y [nm],particle\n1,2,1\n3,4,1\n")
            said = output(root / "build/consumer", table).splitlines()
            self.assertEqual(said[:2], [output(POLAR, "--version").strip(), "2 localisations"])
            self.assertTrue(said[2].startswith("ba7816bf"))

    def test_every_header_is_there(self):
        with tempfile.TemporaryDirectory(prefix="polar-install-") as folder:
            output(CMAKE, "--install", BUILD, "--component", "development", "--prefix", folder,
                   env={**os.environ, "CMAKE_INSTALL_MODE": "ABS_SYMLINK"})
            include = pathlib.Path(folder, "include")
            named = set()
            for header in include.rglob("*.hpp"):
                named |= set(re.findall(r'#include "((?:polar|smlm)/[^"]+)"', header.read_text()))
            self.assertGreater(len(named), 40)
            self.assertEqual([name for name in sorted(named) if not (include / name).exists()], [])


@unittest.skipUnless(shutil.which("dpkg-shlibdeps") and shutil.which("cpack"), "dpkg-dev or cpack is not installed")
class Package(unittest.TestCase):
    def test_unpacked_it_runs_and_names_what_it_needs(self):
        with tempfile.TemporaryDirectory(prefix="polar-package-") as folder:
            root = pathlib.Path(folder)
            output("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", root, "-D", "CPACK_COMPONENTS_ALL=program")
            package, = root.glob("polar-smlm_*.deb")
            needs = output("dpkg-deb", "--field", package, "Depends")
            for library in ("libc6", "libhdf5", "libtbb", "libyaml-cpp", "libssl"):
                self.assertIn(library, needs)
            output("dpkg-deb", "--extract", package, root / "root")
            usr = root / "root/usr"
            self.assertEqual(output(usr / "bin/polar", "--version"), output(POLAR, "--version"))
            for part in ("share/polar-smlm/weights/polar_autoencoder_1.h5", "share/polar-smlm/configs/default.yaml",
                         "share/man/man1/polar-run.1", "share/bash-completion/completions/polar",
                         "share/doc/polar-smlm/copyright"):
                self.assertTrue((usr / part).is_file(), part)
            # What ships beside the program is found from wherever it was unpacked.
            said = output(usr / "bin/polar", "inspect", usr / "share/polar-smlm/configs/demo.yaml")
            self.assertIn("60 particles", said)


if __name__ == "__main__":
    unittest.main()
