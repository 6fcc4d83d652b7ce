# SPDX-License-Identifier: MIT
"""build: commands that build everything or only the firmware, print the size of each layer, and
take the pictures of the pages."""
import os
import re
import tempfile
import time
from pathlib import Path

from icesoc.cli.build_folder import BuildFolder, configured
from icesoc.cli.command import DEFAULTS, GROUPS, command
from icesoc.cli.options import BUILD, FOLDER, INPUT_FOLDER, JOBS, UCOS2, WORDS, Option
from icesoc.site.figures import printed, put_text
from icesoc.util.browser import Browser
from icesoc.util.console import say
from icesoc.util.errors import Stop
from icesoc.util.process import end, logged, run, start

GROUPS["build"] = "build everything, or firmware, sizes, pictures"
DEFAULTS["build"] = "build all"


@command("build all", [BUILD, JOBS, UCOS2], make="build", brief="build all", examples=[
             "build all",
             "build all --jobs 2",
             "build all --ucos2 ~/uC-OS2"])
def build_all(values):
    """build everything: simulator, firmware, compiler, plugin, tests

    Configures the build folder if necessary. The first build takes 5 to 20 minutes. Later
    builds only compile what has changed.
    """
    BuildFolder(values.build, values).prepare().ninja()


@command("build configure", [BUILD, JOBS, UCOS2], make="configure", brief="build configure",
         examples=[
             "build configure",
             "build configure --build build/other",
             "build configure --ucos2 ~/uC-OS2"])
def build_configure(values):
    """configure the build folder without building

    Runs CMake. Afterwards, `ninja -C build/main TARGET` builds a single target, and editors find
    the current compiler options in compile_commands.json.
    """
    BuildFolder(values.build, values).prepare()


@command("build firmware", [BUILD, JOBS, UCOS2], make="firmware", brief="build firmware", examples=[
             "build firmware",
             "build firmware --jobs 2",
             "build firmware --ucos2 ~/uC-OS2"])
def build_firmware(values):
    """build the firmware for the STM32F2 (build/main/firmware)

    Prints how much flash, RAM and stack each program uses, and fails if a program exceeds its
    budget.
    """
    build = BuildFolder(values.build, values).prepare()
    build.ninja("firmware")
    run(["sw/sizes.py", "firmware", build / "firmware/uav.map", "build/firmware.json"])


@command("build size", [BUILD, JOBS], make="size", brief="build size",
         examples=[
             "build size",
             "build size --jobs 2",
             "build size --build build/other"])
def build_size(values):
    """compare the code size of each firmware layer with the paper

    Prints two sizes of each layer: the size of all its files, and the size of the parts that the
    minimal program links. Writes build/size.json.
    """
    configured(values).ninja("size")


# Picture -> width and height in pixels, page below build/, part of the page (#...), and the command
# that writes the page.
PAGES = {
    "utilisation": (1400, 1500, "synth/report.html", "#table1/u_modem", "synth report"),
    "regression": (1180, 1180, "regress/report.html", "", "regress"),
    "failure": (1180, 900, "regress/report.html", "", "regress")}


def small(path):
    """Reduces a picture to at most 64 colours, or to fewer if its file would exceed 100 KB."""
    from PIL import Image  # setup installs this module
    picture = Image.open(path).convert("RGB")
    for colours in (64, 48, 32, 24, 16, 8):
        picture.quantize(colours, dither=Image.Dither.NONE).save(path, optimize=True)
        if os.path.getsize(path) < 100000:
            return say(f"{path} {colours} colours")
    raise Stop(f"{path}: expected less than 100 KB, got more even with eight colours; show less of "
               "the page")


# Returns the text in the window, in the order of the page.
VISIBLE = """(() => {
    const texts = [], nodes = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    for (let node; node = nodes.nextNode();) {
        const box = document.createRange();
        box.selectNodeContents(node);
        const place = box.getBoundingClientRect();
        if (place.width && place.bottom > 0 && place.top < innerHeight &&
            node.parentElement.checkVisibility())
            texts.push(node.textContent);
    }
    return texts.join(' ').replace(/\\s+/g, ' ');
})()"""


def shoot(path, width, height, address):
    """Saves a picture of a page as it looks after three seconds of its timers. The file also
    contains the text in the picture."""
    with Browser(width=width, height=height) as browser:
        browser.open(address)
        browser.pass_time(3000)
        browser.shoot(path)
        text = browser.run(VISIBLE)
    small(path)
    put_text(path, text)


# Script that calls an operation of the vision core through the form on the page.
CALL = """(async () => {
    const wait = () => new Promise(done => setTimeout(done, 20));
    const find = () => [...document.querySelectorAll('#cards details')]
        .find(card => card.innerText.startsWith('hwengine1'));
    while (!find()) await wait();
    find().open = true;
    const mine = () => [...find().querySelectorAll('form')]
        .find(form => form.querySelector('h4').innerText.split(' ')[0] === '%s');
    while (!mine()) await wait();
    const filter = document.getElementById('filter');
    filter.value = 'hwengine1';
    filter.dispatchEvent(new Event('input'));
    for (const number of mine().querySelectorAll('input[type=text]')) {
        number.value = 24;
        number.dispatchEvent(new Event('input'));
    }
    const output = mine().querySelector('output');
    mine().requestSubmit();
    while (!/done in/.test(output.innerText)) await wait();
})()"""


def shoot_mission(path, profile, icesoc):
    """Flies the default mission, and saves the picture that the mission writes. The file also
    contains the mission's output as text."""
    out, log = f"{profile}/run", f"{profile}/log"
    logged([*icesoc, "--out", out], log, "the mission failed")
    path.write_bytes(Path(out, "after.png").read_bytes())
    small(path)
    put_text(path, printed(Path(log).read_text(), out))


def shoot_live(path, profile, icesoc):
    """Saves a picture of the page of a flight in progress, after the page's forms have called the
    vision core."""
    with open(f"{profile}/live.log", "w+") as log:
        flight = start([*icesoc, "--live", "--cpu", "m3", "--out", f"{profile}/live"], stdout=log,
                       stderr=log)
        try:
            while "stays until" not in (text := Path(log.name).read_text()):
                if flight.poll() is not None:
                    raise Stop(text)
                time.sleep(1)
            address = re.search("^The mission as it runs: (.*)$", text, re.M)[1]
            with Browser(width=1280, height=1700) as browser:
                browser.open(address + "#objects")
                for form in "setParameterA", "startProcessing", "getResult":
                    browser.run(CALL % form)
                # after one second, the page has drawn the corners and no longer marks the changed
                # registers
                time.sleep(1)
                browser.shoot(path)
                shown = browser.run(VISIBLE)
            small(path)
            put_text(path, shown)
        finally:
            end(flight)


@command("build pictures", [
    Option("pictures", WORDS,
           "pictures to take: mission, live, utilisation, regression, or failure (which needs a "
           "report with a failed test)",
           ["mission", "live", "utilisation", "regression"], positional=True),
    Option("from", INPUT_FOLDER, "folder with the pages", "build"),
    Option("to", FOLDER, "output folder", "docs/pictures")], make="pictures",
         brief="build pictures mission --to build/brief", examples=[
             "build pictures",
             "build pictures mission",
             "build pictures utilisation --to /tmp"])
def pictures(values):
    """retake the pictures of README.md and docs/

    Flies a mission, takes screenshots of the generated pages with Chromium, and reduces each
    picture to 100 KB or less. The pages must have been generated before.
    """
    icesoc, to = ["./icesoc", "run", *(["--built"] if values.built else [])], Path(values.to)
    with tempfile.TemporaryDirectory() as profile:
        for name in values.pictures:
            path = to / f"{name}.png"
            if name == "mission":
                shoot_mission(path, profile, icesoc)
            elif name == "live":
                shoot_live(path, profile, icesoc)
            elif name in PAGES:
                width, height, file, part, by = PAGES[name]
                page = Path(getattr(values, "from"), file)
                if not page.exists():
                    raise Stop(f"{page} not found; ./icesoc {by} writes it")
                shoot(path, width, height, f"file://{page.absolute()}{part}")
            else:
                raise Stop(f"unknown picture '{name}': expected one of mission, live, "
                           f"{', '.join(PAGES)}", 2)
