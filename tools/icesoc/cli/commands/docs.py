# SPDX-License-Identifier: MIT
"""docs: builds the documentation site."""
import shutil
from pathlib import Path

from icesoc.cli.command import COMMANDS, command
from icesoc.cli.options import FOLDER, Option
from icesoc.util.console import say
from icesoc.util.errors import Stop
from icesoc.site import build

PROGRAMS = {"sphinx-build": "python3-sphinx", "doxygen": "doxygen"}


@command("docs", [Option("out", FOLDER, "folder of the site; the pages are in its html/",
                         "build/docs")],
         brief="docs --out build/brief/docs", examples=[
             "docs", "docs --out /srv/www/icesoc"])
def docs(values):
    """build the documentation as a site with search, in build/docs/html

    The site has the pages of docs/, and a reference of HDL modules, registers, C headers and
    commands that is generated from the sources. It works without a network. A broken link, or a
    page that no table of contents lists, is an error.
    """
    missing = [package for program, package in PROGRAMS.items() if not shutil.which(program)]
    if missing:
        raise Stop(f"docs: missing packages: {', '.join(missing)}; ./icesoc setup --tests "
                   "installs them", 2)
    say("Reading the sources and rendering the pages takes about half a minute ...")
    helps = {name: each.parser().format_help() for name, each in COMMANDS.items()}
    try:
        page = build.build(Path.cwd(), Path(values.out).absolute(), helps)
    except build.SiteError as error:
        raise Stop(f"docs: {error}") from error
    say(f"Open {page}")
