# SPDX-License-Identifier: MIT
"""core_folder: commands that create and remove the folder of a core (docs/guides/core-new.md)."""
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
from icesoc.cli.build_folder import BuildFolder, check_spaces, read_list
from icesoc.cli.command import command
from icesoc.cli.options import BUILD, FILE, FOLDER, JOBS, SWITCH, TEXT, Option, one_of
from icesoc.util.console import say
from icesoc.util.errors import Stop, nearest
from icesoc.util.files import write
from icesoc.util.process import logged, output, run
from icesoc.util.reserved import REFUSAL, RESERVED
from icesoc.util.rooms import RTL
from icesoc.util.spelling import switch

TEMPLATE = TREE / "tools/icesoc/cores/template"
NAME = Option("name", TEXT, "name of the core, such as low_pass", "", positional=True)


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
    for room in (*RTL, "sw", "testbench", "synth"):  # rooms with modules or registers
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
    if len(cores) != 1:
        raise Stop(f"{ice}: expected one interface with [\":hw\"], got those of {' '.join(cores)}")
    if cores != [name]:
        raise Stop(f"{ice}: core {name}: expected the interface {type_of(name)}, got the interface "
                   f"of a core {cores[0]}; rename one of them")
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


def type_of(name):
    """Returns the name of a core's interface: LowPass for low_pass."""
    return "".join(word.capitalize() for word in name.split("_"))


def fill(template, folder, name):
    """Writes a file from a template, with the names of the core filled in. Returns the path of the
    file."""
    text = template.read_text().replace("@NAME@", name).replace("@MODULE@", "Cores")
    path = folder / re.sub("^NAME", name, template.name[:-len(".in")])
    path.write_text(text.replace("@TYPE@", type_of(name)))
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
    write(room / "cores.list", f"{listed}{end}{name}\n")
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
        raise Stop(f"{'LANG' if values.given_by_make else '--lang'}: expected verilog or vhdl, got "
                   "none", 2)
    room = values.repository or "ip"
    check_name(name, room)
    check_spaces(room)
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
               f"the chip; ./icesoc run --cores {name} calls it by radio")


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
        raise Stop(f"ip/{name} has uncommitted changes; {switch('force')} removes it "
                   f"anyway:\n{changed}")
    users = sorted(set(users_of(name)))
    if users:
        raise Stop(f"ip/cores.list connects inputs of {' '.join(users)} to outputs of '{name}'; "
                   "change these lines first")
    if core not in others:
        shutil.rmtree(core)
    listed = Path("ip/cores.list")
    write(listed, re.sub(rf"^[ \t]*{name}(?![^\s#]).*\n?", "", read_list(listed), flags=re.M))
    if (build / "build.ninja").exists():
        (build / f"files/{name}_slot.f").unlink(missing_ok=True)
        others = ";".join(str(folder) for folder in others if folder != core)
        logged(["cmake", f"-DCORE_FOLDERS={others}", build.folder], build / "rm-ip.log",
               "the build cannot be configured without it")
    say(f"ip/{name} and its line in ip/cores.list were removed" if not core.is_dir() else
        f"removed {name} from ip/cores.list; {core} is kept, but no longer part of the build")
