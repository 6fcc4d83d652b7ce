#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""workflows: runs the commands of the container and of the workflows for GitHub and GitLab, in this
tree and in a user's repository of cores.

Usage: workflows.py case work-folder build-folder
"""
import glob
import os
import re
import shlex
import shutil
import sys
import types
from pathlib import Path

import yaml

from icesoc.cli.build_folder import BuildFolder
from icesoc.cli.commands.fresh import RELEASES
from icesoc.cli.flight import check_chip
from icesoc.util.errors import Stop
from script import TREE, Script, append, commit, fresh, git, main, repository, write

WORK, BUILD = map(Path, sys.argv[2:4])


def container():
    """Returns the instructions of the Containerfile as pairs of name and arguments."""
    text = (TREE / "Containerfile").read_text()
    return [line.split(" ", 1) for line in text.splitlines() if not line.startswith("#")]


def workflows(tree):
    """Returns, for each workflow, its file, its images, its commands, and the paths of its
    artifacts."""
    hub, lab = (tree / name for name in (".github/workflows/icesoc.yml", ".gitlab-ci.yml"))
    job = yaml.safe_load(hub.read_text())["jobs"]["icesoc"]
    images = [job["container"].replace("${{ matrix.debian }}", str(debian))
              for debian in job["strategy"]["matrix"]["debian"]]
    yield (hub, images, [step["run"] for step in job["steps"] if "run" in step],
           job["steps"][-1]["with"]["path"].split())
    job = yaml.safe_load(lab.read_text())["icesoc"]
    images = [job["image"].replace("$DEBIAN", debian)
              for row in job["parallel"]["matrix"] for debian in row["DEBIAN"]]
    yield (lab, images, job["before_script"] + job["script"],
           [*job["artifacts"]["paths"], job["artifacts"]["reports"]["junit"]])


def linked(tree):
    """Fills a folder with links to the entries of this tree, but with separate folders ip and
    build. Returns this folder."""
    for path in TREE.iterdir():
        if path.name not in ("build", "ip", ".git"):
            (tree / path.name).symlink_to(path)
    (tree / "ip").mkdir()
    for path in (TREE / "ip").iterdir():
        (tree / "ip" / path.name).symlink_to(path)
    (tree / "ip/cores.list").unlink()
    shutil.copy(TREE / "ip/cores.list", tree / "ip")


def entries(tree):
    """Returns names, link targets and modification times of the entries in a tree of links."""
    return sorted((str(path), os.readlink(path) if path.is_symlink() else path.stat().st_mtime_ns)
                  for folder in (tree, tree / "ip") for path in folder.iterdir())


class Cases(Script):
    def test_repository_in_chip(self):
        """A command can name a repository of cores. The build folder then uses the cores and the
        list of this repository, until a later command names other cores."""
        work = fresh(WORK)
        mine, list_ = work / "mine", work / "mine/cores.list"
        for name in "first", "second":
            write(mine / name / "core.toml", "")
        write(list_, "first\n")
        (mine / "build").mkdir()

        def folders(text):
            values = types.SimpleNamespace(jobs=1, built=False, core_folders=text)
            build = BuildFolder(work / "built", values)
            return build.other_cores(), build.chip_list()
        both = [mine / "first", mine / "second"]
        self.assertEqual(folders(str(mine)), (both, list_))
        self.assertEqual(folders(f"{mine};{mine}/second"), ([*both, mine / "second"], list_))
        self.assertEqual(folders(f"{mine}/second"), ([mine / "second"], None))
        # A flight finds its cores in this list, also before the build folder is configured.
        values = types.SimpleNamespace(jobs=1, built=False, core_folders=str(mine),
                                       cores=[str(mine / "first")])
        check_chip(values, BuildFolder(work / "built", values))
        values.cores = [str(mine / "second")]
        with self.assertRaisesRegex(Stop, f"add a line 'second' to {list_}"):
            check_chip(values, BuildFolder(work / "built", values))
        write(work / "built/CMakeCache.txt", f"CORES:FILEPATH={list_}\n"
              f"CORE_FOLDERS:STRING={mine}/first\n")
        for not_given in None, "":
            self.assertEqual(folders(not_given), ([mine / "first"], None))
        self.assertEqual(folders("none"), ([], Path("ip/cores.list").absolute()))

    def test_repository_published(self):
        """A new repository uses a commit of IceSoC that can be cloned: if the tree's last commit is
        not pushed, it uses the last pushed one, and the cores of that commit's chip."""
        work = fresh(WORK)
        mine, theirs, tree = work / "mine", work / "theirs", work / "tree"
        theirs.mkdir()
        linked(theirs)
        os.chdir(theirs)
        repository()
        commit("pushed")
        pushed = git("rev-parse HEAD")
        git("clone -q . ../tree")
        os.chdir(tree)
        repository()
        append("ip/cores.list", "unpushed\n")
        commit("not pushed")
        self.ask(TREE / "icesoc", "core", "new", "ramp", "--lang", "vhdl", "--repository", mine,
                 "--built", "--build", work / "none", env={**os.environ, "ICESOC_TREE": str(tree)})
        self.has(f"checkout --quiet {pushed}$", f"clone --quiet {theirs}/?[.]? ",
                 file=mine / "Makefile")
        self.has("^vision ", "^ramp$", file=mine / "cores.list")
        self.lacks("unpushed", file=mine / "cores.list")

    def test_container(self):
        """Each command of the Containerfile runs with the files that the container copies, on a
        machine on which no package is installed."""
        work = fresh(WORK)
        write(work / "bin/dpkg-query", "#!/bin/sh\necho 'no packages found matching g++' >&2\n")
        for program in ("apt-get", "git"):
            write(work / f"bin/{program}", f'#!/bin/sh\necho "{program} $*" >>{work}/said\n')
        write(work / "bin/id", "#!/bin/sh\necho 0\n")
        (work / "tree").mkdir()
        environment = {"PATH": f"{work}/bin:{os.environ['PATH']}", "HOME": str(work)}
        for name, rest in container():
            if name == "COPY":
                *files, to = rest.split()
                for file in files:
                    (work / "tree" / to).mkdir(parents=True)
                    shutil.copy(TREE / file, work / "tree" / to)
            elif name == "RUN":
                self.ask("sh", "-c", rest, cwd=work / "tree", env=environment)
                self.lacks("no packages found")  # dpkg-query's messages are left out
        self.has("install .* ca-certificates git make$", "^git config --system",
                 "install .* verilator .* chromium", file=work / "said")
        self.has('"make", "run"', "^FROM docker.io/library/debian:13$", file=TREE / "Containerfile")
        self.has("^make run ", "podman build .* podman run", file=TREE / "README.md")

    def carried_out(self, tree, **environment):
        """Runs the commands of both workflows, and checks that all artifacts exist. The workflows
        use each supported release of Debian, because each has faults that the other lacks."""
        images = [f"docker.io/library/debian:{name.removeprefix('Debian ')}"
                  for name in RELEASES.values()]
        before = [rest for name, rest in container() if name == "RUN" and "setup" not in rest]
        for file, used, commands, kept in workflows(tree):
            self.assertLess(len(file.read_text().splitlines()), 60)
            self.assertEqual((used, commands[:-2]), (images, before))
            self.assertEqual(commands[-2:], ["make run", "make test"])
            shutil.rmtree(tree / "build/run", ignore_errors=True)
            for junit in tree.glob("build/main/junit*.xml"):
                junit.unlink()
            for command in commands[-2:]:
                ours = {name: value for name, value in os.environ.items()
                        if name not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL")}
                self.ask("sh", "-c", command, cwd=tree, env={
                    **ours, "BUILT": "1", "SIZE": "96x64", **environment})
            for path in kept:
                self.assertTrue(glob.glob(str(tree / path)), f"{file}: {path}")
            self.has("<testcase ", file=next(tree.glob("build/main/junit*.xml")))
            self.assertTrue((tree / "build/run/report.md").exists())

    def test_workflows(self):
        tree = fresh(WORK)
        linked(tree)
        (tree / "build").mkdir()
        (tree / "build/main").symlink_to(BUILD)
        self.carried_out(tree, ICESOC_TREE=str(tree), NAME="^tree[.]pages$")

    def test_repository(self):
        """The repository is written by `./icesoc core new`. Its core has the same name as a core
        that is already built."""
        work = fresh(WORK)
        icesoc, mine = work / "icesoc", work / "mine"
        icesoc.mkdir()
        linked(icesoc)
        built = ["--built", "--build", work / "none"]
        new = [TREE / "icesoc", "core", "new", "--lang", "verilog", "--repository", mine, *built]
        self.ask(*new, "sample_verilog")
        self.has(f"^Next: make -C {mine} test")
        (mine / "build/main").mkdir(parents=True)
        for path in BUILD.iterdir():
            if path.name != "CMakeCache.txt" and not path.name.startswith("junit"):
                (mine / "build/main" / path.name).symlink_to(path)
        cache = (BUILD / "CMakeCache.txt").read_text()
        write(mine / "build/main/CMakeCache.txt",
              re.sub("(KNOWN|TESTED)_CORES:INTERNAL=", r"\g<0>sample_verilog;", cache))
        before = entries(icesoc)
        self.carried_out(mine, ICESOC_TREE=str(icesoc), ICESOC=str(icesoc), CORES="fir")
        self.assertEqual(entries(icesoc), before)  # the tree itself must be unchanged
        self.has("^vision ", "^sample_verilog$", file=mine / "cores.list")
        self.lacks("@[A-Z]+@|make ip-test", file=mine / "Makefile")
        self.lacks(r"\.\./\.\./docs|core test", file=mine / "sample_verilog/README.md")
        # Adding another core keeps the existing files.
        write(mine / ".gitlab-ci.yml", "changed\n")
        self.ask(*new, "second")
        self.has("^sample_verilog\nsecond$", file=mine / "cores.list")
        self.has("^changed$", file=mine / ".gitlab-ci.yml")
        self.ask(*new, "second", status=2)
        self.has("second already exists")
        # A repository can also contain a third-party core. Its files are found wherever the
        # repository is.
        (mine / "others").mkdir()
        shutil.copy(TREE / "tests/ip/new_foreign/wb_port.v", mine / "others")
        self.ask(TREE / "icesoc", "core", "foreign", "third", "--top", "wb_port", "--bus",
                 "wishbone", "--files", mine / "others/wb_port.v", "--repository", mine, *built)
        self.has(f"^Next: make -C {mine} test")
        self.has("^third$", file=mine / "cores.list")
        self.lacks("ip/cores.list")  # that hint is for a core in this tree
        self.has('"@FOLDER@/../others/wb_port.v"', file=mine / "third/core.toml")
        self.lacks(str(mine), file=mine / "third/core.toml")
        # The workflow clones the origin of this tree at this commit; it removes a clone that lacks
        # the commit.
        if (TREE / ".git").exists():
            text = (mine / "Makefile").read_text()
            used = re.search("checkout --quiet ([0-9a-f]{40})\n", text)[1]
            git(f"-C {shlex.quote(str(TREE))} merge-base --is-ancestor {used} HEAD")
            text = re.sub("quiet .*/.* ", f"quiet {TREE} ", text.replace(used, "0" * 40))
            write(mine / "Makefile", text)
            self.ask("make", "-C", mine, "clone", "ICESOC=clone", status=2)
            self.has(f"^fatal: .*{'0' * 40}")
            self.assertFalse((mine / "clone").exists())


main(Cases)
