# SPDX-License-Identifier: MIT
"""docs: builds the documentation site, and follows the tutorial."""
import importlib.util
import os
import shutil
import subprocess
from pathlib import Path

from icesoc.cli.command import COMMANDS, command
from icesoc.cli.options import FOLDER, SWITCH, Option
from icesoc.util.console import say
from icesoc.util.errors import Stop
from icesoc.util.process import run, start, wait
from icesoc.site import build, tutorial

# programs and Python modules that render the site, each with its Debian package
PROGRAMS = {"sphinx-build": "python3-sphinx", "doxygen": "doxygen"}
MODULES = {"myst_parser": "python3-myst-parser", "furo": "furo", "breathe": "python3-breathe"}


@command("docs", [Option("out", FOLDER, "output folder; the site is in its folder html",
                         "build/docs")],
         brief="docs --out build/brief/docs", examples=[
             "docs",
             "docs --out /srv/www/icesoc",
             "docs --out /tmp/site"])
def docs(values):
    """build the documentation as a site with search, in build/docs/html

    The site has the pages of docs/, and a reference of HDL modules, registers, C headers and
    commands that is generated from the sources. It works without a network. A broken link, or a
    page that no table of contents lists, is an error.
    """
    missing = [package for program, package in PROGRAMS.items() if not shutil.which(program)]
    missing += [package for module, package in MODULES.items()
                if importlib.util.find_spec(module) is None]
    if missing:
        raise Stop(f"docs: missing packages: {', '.join(missing)}; ./icesoc setup --tests "
                   "installs them", 2)
    say("Reading the sources and rendering the pages takes about half a minute ...")
    helps = {name: each.parser().format_help() for name, each in COMMANDS.items()}
    say(f"Open {build.build(Path.cwd(), Path(values.out).absolute(), helps)}")


TUTORIAL = "docs/tutorial.md"
CHIP = Path("ip/cores.list")
# the tutorial's commands up to this one create a clone; they are skipped
BEGIN = "cd icesoc"
MADE = ["LowPass.ice", "ip/low_pass"]


@command("check tutorial", [
    Option("clone", SWITCH, "follow the tutorial in a new clone of HEAD (build/tutorial/icesoc), "
                            "without earlier builds"),
    Option("brief", SWITCH, "leave out flights and the waveform, which take minutes"),
    Option("list", SWITCH, "only list the commands of the page")],
         brief="check tutorial --brief", long="check tutorial --clone", examples=[
             "check tutorial",
             "check tutorial --brief",
             "check tutorial --clone"])
def check_tutorial(values):
    """run the tutorial and compare its output with the page

    Runs every command of docs/tutorial.md, writes its files, and compares output and exit
    status. Without --clone, it runs in this tree and uses the existing build. It adds the core
    low_pass to the tree, and removes it at the end.
    """
    page, folder = Path(TUTORIAL).absolute(), Path.cwd()
    if values.list:
        return say("\n".join(step.command or f"write {step.file}"
                             for step in tutorial.steps(page.read_text())))
    if values.clone:
        folder = Path("build/tutorial/icesoc").absolute()
        shutil.rmtree(folder, ignore_errors=True)
        run(["git", "clone", "--quiet", "--no-hardlinks", Path.cwd(), folder])
    for name in MADE:
        if (folder / name).exists():
            raise Stop(f"check tutorial: {name} already exists; rename or remove it first")

    def execute(text):
        say(f"$ {text}")
        kept = {name: value for name, value in os.environ.items()
                if name not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL", "ICESOC_TREE")}
        process = start(["env", "-i", *(f"{name}={value}" for name, value in kept.items()),
                         "sh", "-c", text], cwd=folder, stdin=subprocess.DEVNULL, text=True,
                        errors="replace", stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        output = process.stdout.read()
        return wait(process), output

    chip = (folder / CHIP).read_text()
    try:
        tutorial.follow(page, folder, execute, BEGIN, values.brief)
    finally:
        (folder / MADE[0]).unlink(missing_ok=True)
        shutil.rmtree(folder / MADE[1], ignore_errors=True)
        (folder / CHIP).write_text(chip)
    say("The output of every command equals the output on the page.")
