#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""make_test: what is set up and fetched, and what a test needs of a build.

Usage: make_test.py make build-folder
"""
import os
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from script import TREE, Script, main, write  # noqa: E402

BUILD = Path(sys.argv[2])
SANITIZED = ("test_os_cases", "test_link", "test_engine", "test_icec")


class Cases(Script):
    def test_make(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        work = Path(folder.name)
        # A user's name may have an apostrophe.
        cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "icesoc"
        (work / "it's").mkdir()
        (work / "it's/icesoc").symlink_to(cache)
        self.ask(TREE / "cmake/fetch.py", "ghdl", work / "ghdl",
                 env={**os.environ, "XDG_CACHE_HOME": f"{work}/it's"})
        self.ask(work / "ghdl/ghdl", "--version")
        # The pages' libraries: without a network, or with a file of another checksum, the build
        # goes on, says so, and keeps no partial file.
        archive = "tabulator-tables-6.5.3.tgz"
        write(work / "npm/tabulator-tables/-" / archive, "wrong\n")
        page, empty = work / "page", work / "empty"
        for mirror in "http://127.0.0.1:9", (work / "npm").as_uri():
            self.ask(TREE / "cmake/fetch.py", "page", page,
                     env={**os.environ, "XDG_CACHE_HOME": str(empty), "ICESOC_NPM": mirror})
            self.has("cannot get Tabulator and uPlot")
            self.assertEqual((page / "libraries.js").read_text(), "")
            self.assertFalse((page / "done").exists())
            self.assertEqual(list(empty.glob("icesoc/foreign/*")), [])
        self.has(f"{archive} is not the file that was tested")
        # One block's tests need its programs, and no more.
        self.ask(BUILD / "tests/regress/regress", "--build", BUILD, "--prepare", "--list",
                 "--block", "bus")
        self.has("^(tests/bus/)?test_bus_decoder$")
        self.assertLess(self.said.count("\n"), 20)
        # Programs that `make test` runs with sanitizers: one without the label would be missed.
        for program in SANITIZED:
            labels, = BUILD.glob(f"tests/sw/*/{program}_labels.cmake")
            self.has("sanitized", file=labels)


main(Cases)
