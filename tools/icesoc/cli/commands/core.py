# SPDX-License-Identifier: MIT
"""core: commands that create, test, inspect and remove a core (docs/guides/core-new.md)."""
import dataclasses
import json
import os
import re
import shutil
import tempfile
from pathlib import Path

from icesoc import TREE
from icesoc.chip import manifest
from icesoc.cli import choices
from icesoc.cli.build_folder import BuildFolder, read_list
from icesoc.cli.command import GROUPS, command
from icesoc.cli.commands.synth import utilisation
from icesoc.cli.options import (BUILD, CORE_FOLDERS, FILE, FOLDER, JOBS, SEED, SWITCH, TEXT, Option,
                                matching, one_of)
from icesoc.util import vcd
from icesoc.util.console import say, warn
from icesoc.util.errors import Stop, nearest
from icesoc.util.process import logged, output, run
from icesoc.util.reserved import REFUSAL, RESERVED

TEMPLATE = TREE / "tools/icesoc/cores/template"

GROUPS["core"] = "cores: create, test, view waveforms, remove"
NAME = Option("name", TEXT, "name of the core, such as low_pass", "", positional=True)
CORE = Option("ip", matching(r"\w+", "the name of a core"), "name of the core", "", positional=True,
              choices=choices.cores)
CHIP = Option("chip", SWITCH,
              "synthesise the current chip (takes minutes); default: use the accepted figures")


def check_name(name, room="ip"):
    """Rejects a name that is invalid, or that already exists in the tree or in the folder
    `room`."""
    if not name:
        raise Stop("a core needs a name: ./icesoc core new low_pass --lang verilog", 2)
    if not re.fullmatch(r"[a-z][a-z0-9]*|[a-z][a-z0-9]+(_[a-z][a-z0-9]+)+", name):
        raise Stop(
            f"'{name}': expected words of small letters and digits, joined by _, such as "
            "low_pass", 2)
    if name in RESERVED:
        raise Stop(f"'{name}' {REFUSAL}", 2)
    for folder in (Path("ip", name), Path(room, name)):
        if os.path.lexists(folder):
            raise Stop(f"{folder} already exists; choose another name, or remove it first", 2)
    for room in ("bus", "hdl", "ip", "sw", "testbench", "synth"):
        for path in sorted(Path(room).rglob("*")):
            if room != "synth" and path.name in (f"{name}.regs.json", f"{name}_wrapper.v"):
                raise Stop(f"the name '{name}' is taken by {path}; choose another name", 2)
            if room not in ("sw", "testbench") and path.suffix in (".v", ".vhd") and re.search(
                    rf"^ *(module|entity) +{name}(_wrapper)?\b", path.read_text(errors="replace"),
                    re.M | re.I):
                raise Stop(f"the name '{name}' is taken by a module in {path}; choose another "
                           "name", 2)


def write_own(build, name, lang, ice, folder):
    """Writes a new core for the user's interface, the Slice file `ice`."""
    included = re.findall(r'^ *# *include *[<"]([^>"]*)', Path(ice).read_text(), re.M)
    if included:
        raise Stop(f"{ice} includes {' '.join(included)}: expected a Slice file without includes; "
                   "copy the declarations that it uses into it")
    work = folder.parent
    if run([build / "slice/slice2c", f"-I{Path(ice).absolute().parent}", ice, "--output-dir",
            work / "c", "--hw-regs", work / "regs", f"--hw-new-{lang}", work / "new"], check=False):
        raise Stop(f"{ice}: no core could be generated because of the errors above")
    cores = sorted(path.name[:-len(".regs.json")] for path in (work / "regs").iterdir())
    if cores != [name]:
        raise Stop(f"{ice}: expected one interface with [\":hw\"], named {name}; got "
                   f"{' '.join(cores) or 'none'}")
    for path in (work / "new").iterdir():
        shutil.copy(path, folder)
    shutil.copy(ice, folder / f"{name}.ice")
    fill(TEMPLATE / lang / "core.toml.in", folder, name)
    ground = fill(TEMPLATE / "interface/ground.py.in", folder, name)
    module, proxy = interface_of(json.loads(output([build / "slice/slice2c", "--describe", ice])))
    ground.write_text(ground.read_text().replace("@OWN@", module).replace("@PROXY@", proxy))
    readme = fill(TEMPLATE / "README.md.in", folder, name)
    readme.write_text(re.sub(r"^Adds an offset, and sums 1..count:",
                             "Answers every call with zeros:", readme.read_text(), flags=re.M))


def interface_of(described):
    """Returns the outermost Slice module of the interface with the metadata [":hw"], and the Python
    class of its proxy. `described`: output of slice2c --describe."""
    name = next(name for name, facts in described.items() if facts["kind"] == "interface"
                and any(word.startswith(":hw") for word in facts.get("metadata", [])))
    modules = name.removeprefix("::").split("::")
    return modules[0], ".".join(modules) + "Prx"


def fill(template, folder, name):
    """Writes a file from a template, with the names of the core filled in. Returns the path of the
    file."""
    text = template.read_text().replace("@NAME@", name).replace("@MODULE@", "Cores")
    path = folder / re.sub("^NAME", name, template.name[:-len(".in")])
    path.write_text(text.replace("@TYPE@", "".join(word.capitalize() for word in name.split("_"))))
    return path


REPOSITORY = Option("repository", FOLDER, "separate repository for the core instead of ip/; it is"
                                          " created if missing")


def published():
    """Returns the newest commit of this branch that can be cloned from `origin`, and the text of
    its ip/cores.list. Both are "" if this tree is not a git repository. A commit that has not been
    pushed is not used, unless the tree has no branch of a remote repository."""
    def git(*words):
        return output(["git", *words], check=False, stderr=-3).strip()
    commit = git("rev-parse", "HEAD")
    if git("rev-list", "--max-count=1", "HEAD", "--not", "--remotes=origin"):
        edge = [line[1:] for line in git("rev-list", "--boundary", "HEAD", "--not",
                                         "--remotes=origin").splitlines() if line[0] == "-"]
        commit = edge[0] if edge else commit
    chip = git("show", f"{commit}:ip/cores.list")
    return commit, chip and chip + "\n"


def put_into_repository(room, name):
    """Adds a core's line to cores.list of the user's repository, and adds files that the repository
    lacks. Workflows are copied from this tree."""
    room = Path(room).absolute()
    origin = output(["git", "remote", "get-url", "origin"], check=False, stderr=-3).strip()
    origin = re.sub("(?<=://)[^/@]*@", "", origin)  # removes the user name and the password
    commit, chip = published()
    made = (TEMPLATE / "repository/Makefile.in").read_text()
    made = made.replace("@URL@", origin or os.getcwd()).replace("@COMMIT@", commit or "HEAD")
    files = {"Makefile": made, "cores.list": chip or read_list("ip/cores.list"),
             ".gitignore": "/build/\n"}
    for file in (".github/workflows/icesoc.yml", ".gitlab-ci.yml"):
        files[file] = Path(file).read_text()
    for file, text in files.items():
        if not (room / file).exists():
            (room / file).parent.mkdir(parents=True, exist_ok=True)
            (room / file).write_text(text)
    listed = read_list(room / "cores.list")
    end = "" if listed.endswith("\n") or not listed else "\n"
    (room / "cores.list").write_text(f"{listed}{end}{name}\n")
    say(f"Next: make -C {room} test; make -C {room} run calls it by radio")


@command("core new", [NAME, Option("lang", one_of("verilog", "vhdl"), "language of the core"),
                      Option("ice", FILE, "Slice file with the interface of the core; default: an"
                                          " example"),
                      REPOSITORY, BUILD, JOBS], make="new-ip",
         brief=("core new brief_core --lang vhdl", "core remove brief_core --force"),
         examples=["core new low_pass --lang vhdl", "core new lamp --lang verilog --ice lamp.ice",
                   "core new low_pass --lang verilog --repository ~/cores"])
def new(values):
    """create a core: ip/NAME with interface, RTL and a test that passes

    The core is generated from a Slice interface: the example of docs/guides/core-new.md, or
    your own interface with --ice. The core is in the chip only if ip/cores.list names it.
    """
    name, lang = values.name, values.lang
    if name and not lang:
        raise Stop("--lang: expected verilog or vhdl (LANG=...), got nothing", 2)
    room = values.repository or "ip"
    check_name(name, room)
    build = BuildFolder(values.build, values).prepare()
    if values.ice:
        build.ninja("slice2c")
    build.folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="new-ip.", dir=build.folder) as work:
        folder = Path(work) / name
        folder.mkdir()
        if values.ice:
            write_own(build, name, lang, values.ice, folder)
        else:
            for template in [*TEMPLATE.glob("*.in"), *(TEMPLATE / lang).glob("*.in")]:
                fill(template, folder, name)
        if values.repository:
            readme = folder / "README.md"
            text = readme.read_text().replace("../../docs", "../build/icesoc/docs")
            readme.write_text(text.replace(f"./icesoc core test {name}", "make test"))
        os.makedirs(room, exist_ok=True)
        # the folder is moved into the tree only when it is complete
        shutil.move(folder, f"{room}/{name}")
    written = f"{room}/{name}: {' '.join(sorted(os.listdir(f'{room}/{name}')))}"
    if values.repository:
        say(written)
        return put_into_repository(room, name)
    # A later build would also run CMake. It runs now, because if it fails, the new folder can still
    # be removed.
    if (build / "build.ninja").exists():
        try:
            logged(["cmake", build.folder], build / "new-ip.log",
                   f"the build does not take '{name}' (above); nothing was changed")
        except BaseException as error:
            shutil.rmtree(f"ip/{name}")
            if not isinstance(error, Stop):  # Ctrl-C
                raise
            with open(build / "new-ip.log", "a") as log:
                run(["cmake", build.folder], check=False, stdout=log, stderr=log)
            raise
    say(written)
    return say(f"Next: ./icesoc core test {name}; a line '{name}' in ip/cores.list puts it into "
               f"the chip; make run CORES={name} calls it by radio")


def known(values, core_tests=False):
    """Returns the build folder that contains the core. With `core_tests`, a new folder is
    configured for the tests of cores only."""
    if not values.ip:
        raise Stop("expected the name of a core: ./icesoc core test fir", 2)
    build = BuildFolder(values.build, values).prepare(core_tests=core_tests)
    cores = build.known_cores()
    if not values.built and (values.ip not in cores or
                             not (build.core(values.ip) / "core.toml").is_file()):
        # CMake may not have found folders that were created or removed after its last run
        build.ninja("build.ninja")
        cores = build.known_cores()
    if values.ip not in cores:
        raise Stop(f"unknown core '{values.ip}': expected one of {' '.join(cores)}", 2)
    return build


@command("core test", [CORE, CORE_FOLDERS, SEED, BUILD, JOBS], make="ip-test",
         brief="core test fir", examples=[
             "core test fir",
             "core test fir --seed 7",
             "core test my_core --core-folders ~/my_core"])
def test(values):
    """build and test one core: its block test, and its VHDL under GHDL

    Builds only the targets that the tests of this core need. The core need not be in the chip.
    Exit status 8: a test failed.
    """
    core, build = values.ip, known(values, core_tests=True)
    build.ninja(f"tests_of_{core}")
    if core not in build.cached("TESTED_CORES").split(";"):
        raise Stop(f"{core} has no test: {core}_test.cpp not found in the core's folder")
    return build.ctest("-R", rf"^(test_ip_{core}[.]|vhdl[.]{core}$)", tests=values.jobs,
                       junit=f"junit-{core}.xml", SEED=values.seed)


@command("core synth", [CORE, CORE_FOLDERS, CHIP, BUILD, JOBS], make="ip-synth",
         brief="core synth fir", examples=[
             "core synth fir",
             "core synth fir --chip",
             "core synth my_core --core-folders ~/my_core"])
def synth(values):
    """report the utilisation of one core, and its cost in the chip

    Prints LUTs, flip-flops, block RAM and DSP blocks of the core and of its parts, and the cost
    that its slot and memory port add to the chip.
    """
    build = known(values)
    build.ninja("synth_inputs")
    return utilisation(build, values, "--design", values.ip) or \
        utilisation(build, values, "--core", values.ip,
                    *(["--design", "soc"] if values.chip else []))


def one_test(program, text):
    """Returns the name of a test. `text` is the full name, or an expression that matches only this
    test."""
    listed = output([program, "--gtest_list_tests"])
    suite, names = "", []
    for line in listed.splitlines():
        if line.startswith(" "):
            names.append(suite + line.split()[0])
        else:
            suite = line.split()[0]
    found = [name for name in names if text in (name, name.partition(".")[2])] or [
        name for name in names if re.search(text, name)]
    if len(found) != 1:
        raise Stop(f"TEST={text}: expected an expression that matches one test, got {len(found)} "
                   f"matches; the tests are:\n{listed}"
                   + nearest(text, names), 2)
    return found[0]


def ports(build, core):
    """Returns the ports of the core's model, in the notation of GTKWave."""
    for header in build.folder.rglob(f"verilated_{core}_slot/V{core}_slot.h"):
        for name, high, low in re.findall(r"VL_(?:IN|OUT)[0-9W]*\(&(\w+),(\d+),(\d+)",
                                          header.read_text()):
            yield f"TOP.{name}" + (f"[{high}:{low}]" if int(high) > int(low) else "")


def rows_of(fst, build, core):
    """Returns the rows of GTKWave's save file, at most 200: the ports, then the signals of the
    instances, outermost first. The signals of an instance follow a comment with its name."""
    _, signals, _ = vcd.read(output(["fst2vcd", "-f", fst], check=False, stderr=-3)
                             if shutil.which("fst2vcd") else "")
    rows, most, last = [*ports(build, core)], 200, []
    for signal in sorted(filter(lambda s: s.is_shown, signals), key=lambda s: len(s.scopes)):
        if signal.scopes == ["TOP"] and rows and not last:
            continue  # the port is already in the list
        if signal.scopes != last:
            last = signal.scopes
            rows.append("-" + ".".join(last))
        rows.append(signal.row)
    return rows[:most]


def traced(values):
    """Returns the build folder of a test with a waveform, and the command that runs the test."""
    what = values.ip
    if what.startswith("vhdl."):  # GHDL writes the waveform itself
        build = BuildFolder(values.build, values).prepare()
        build.ninja("ghdl", f"{what[5:]}_vectors")
        return build, ["ctest", "--test-dir", build.folder, "--no-tests=error", "-R",
                       f"^{re.escape(what)}$"]
    if what.startswith("test_"):
        main, target = BuildFolder(values.build, values).prepare(), what
    else:
        main, target = known(values), f"test_ip_{what}"
        source = main.core(what) / f"{what}_test.cpp"
        if not source.exists():
            raise Stop(f"{source} not found; it is the core's test")
    build = BuildFolder("build/trace", values)
    if not values.built:
        build.configure("-DTRACE=ON")
        build.follow(main)
    build.ninja(target)
    program = next(path for path in sorted(build.folder.rglob(target))
                   if path.is_file() and os.access(path, os.X_OK)).absolute()
    return build, [program, f"--gtest_filter={one_test(program, values.test)}"]


@command("core wave", [dataclasses.replace(
    CORE, kind=matching(r"(vhdl\.)?\w+", "a core, test_... or vhdl.CORE"), is_checked=False,
    help="core, test program (such as test_fsmc_bridge), or VHDL test bench that runs in GHDL "
         "(such as vhdl.fir)"), Option(
    "test", TEXT, "name of the test, or an expression that matches only this test", "",
    positional=True), CORE_FOLDERS, BUILD, JOBS], make="wave", brief="core wave fir Impulse",
         examples=["core wave fir Impulse", "core wave test_fsmc_bridge TooEarly",
                   "core wave vhdl.fir"])
def wave(values):
    """write the waveform of one test for GTKWave, build/wave/NAME.fst

    The save file NAME.gtkw lists the ports, then internal signals. For a core in VHDL,
    `vhdl.NAME` in place of the core name selects GHDL's waveform, which has the names and types
    of the source."""
    what = values.ip
    if not what or not (values.test or what.startswith("vhdl.")):
        raise Stop("core wave: expected a core or test program, and a test: ./icesoc core "
                   "wave fir Impulse; or only vhdl.CORE: ./icesoc "
                   "core wave vhdl.fir", 2)
    build, words = traced(values)
    folder = Path("build/wave").absolute()
    folder.mkdir(parents=True, exist_ok=True)
    fst, save, log = (folder / f"{what}{end}" for end in (".fst", ".gtkw", ".log"))
    fst.unlink(missing_ok=True)
    with open(log, "w") as file:
        status = run(words, check=False, stdout=file, stderr=file, env={"WAVE": fst})
    name = str(words[-1]).rpartition("=")[2]
    if not fst.exists() or not fst.stat().st_size:
        raise Stop(f"{log.read_text()}{name} wrote no waveform")
    save.write_text("\n".join([
        f"[*] {name}: generated by ./icesoc core wave", f'[dumpfile] "{fst}"',
        f'[savefile] "{save}"', *rows_of(fst, build, what)]) + "\n")
    if status:
        warn(f"{name} failed: {log}")
    if os.environ.get("DISPLAY") and shutil.which("gtkwave"):
        return run(["gtkwave", fst, save], check=False)
    say(f"gtkwave {fst} {save}")


def users_of(name):
    """Yields the cores that need the core `name`: ip/cores.list connects one of their inputs to it,
    and without it this input would become a pin of the chip. An input that the manifest calls
    "internal" does not count, because it would become 0."""
    for line in read_list("ip/cores.list").split("\n"):
        user, *words = line.partition("#")[0].split() or [""]
        path = Path("ip", user, "core.toml")
        pins = manifest.read(path).pins() if user and path.is_file() else []
        internal = {pin["name"] for pin in pins if pin.get("internal")}
        if any(f"={name}." in word and word.partition("=")[0] not in internal for word in words):
            yield user


@command("core remove", [dataclasses.replace(NAME, choices=choices.cores, is_checked=False),
                         Option("force", SWITCH, "remove the core even with uncommitted changes"),
                         BUILD, JOBS], make="rm-ip", brief=("core new brief_gone --lang verilog",
                                                            "core remove brief_gone --force"),
         examples=[
             "core remove low_pass",
             "core remove low_pass --force",
             "core remove my_core"])
def remove(values):
    """remove a core: its folder and its line in ip/cores.list

    A core's folder outside ip/ is not deleted. Without --force, a core with uncommitted changes is
    not removed.
    """
    build = BuildFolder(values.build, values)
    name, core = values.name, build.core(values.name or ".")
    if not re.fullmatch(r"[a-z0-9_]+", name) or name == "template":
        raise Stop(
            f"NAME: expected the name of a core, got '{name}': ./icesoc core remove low_pass", 2)
    if not core.is_dir():
        raise Stop(f"{core} not found{nearest(name, choices.cores(values))}", 2)
    others = build.other_cores()
    changed = core not in others and output(
        ["git", "status", "--porcelain", "--ignored", "--", core], check=False, stderr=-3)
    if changed and not values.force:
        raise Stop(f"ip/{name} has uncommitted changes; FORCE=1 (--force) removes it "
                   f"anyway:\n{changed}")
    users = sorted(set(users_of(name)))
    if users:
        raise Stop(f"ip/cores.list connects inputs of {' '.join(users)} to outputs of '{name}'; "
                   "change these lines first")
    if core not in others:
        shutil.rmtree(core)
    listed = Path("ip/cores.list")
    listed.write_text(re.sub(rf"^[ \t]*{name}(?![^\s#]).*\n?", "", read_list(listed), flags=re.M))
    if (build / "build.ninja").exists():
        (build / f"files/{name}_slot.f").unlink(missing_ok=True)
        others = ";".join(str(folder) for folder in others if folder != core)
        logged(["cmake", f"-DCORE_FOLDERS={others}", build.folder], build / "rm-ip.log",
               "the build cannot be configured without it")
    say(f"ip/{name} and its line in ip/cores.list were removed" if not core.is_dir() else
        f"removed {name} from ip/cores.list; {core} is kept, but no longer part of the build")
