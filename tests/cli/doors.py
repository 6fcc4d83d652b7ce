#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""doors: checks that ./icesoc and make accept the same options, report errors with advice, and
never pass a value to a shell. lists.py tests the lists of commands."""
import concurrent.futures, contextlib, importlib.util, io, json, os, resource, shutil, subprocess
import tempfile, time, unittest
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

from icesoc import TREE
from icesoc.cli import command, everything, flight  # noqa: F401
from icesoc.cli.commands import core, core_folder, fresh, regression
from icesoc.cli.main import QUICK
from icesoc.cli.options import FLIGHT, SWITCH
from icesoc.regress import regress
from icesoc.util.errors import SKIPPED, Stop
from icesoc.util.lock import lock
from icesoc.util.ninja import explained
import quick
from script import LONGEST


def clean(**more):
    """Returns the environment without the variables that set options, and without the variables
    that make sets when it runs the tests."""
    ours = {option.variable for each in command.COMMANDS.values() for option in each.options}
    ours |= {"MAKEFLAGS", "MFLAGS", "MAKELEVEL"}
    return {**{name: value for name, value in os.environ.items() if name not in ours}, **more}


def ask(*words, **environment):
    """Runs a program in the tree. Returns (exit status, output)."""
    done = subprocess.run(words, cwd=TREE, env=clean(**environment), stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=LONGEST)
    return done.returncode, done.stdout


def quickly(*words, **environment):
    """Does the same as `ask` for a command of make or ./icesoc, without starting Python."""
    return quick.ask(words, clean(**environment))


class Work(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.work = Path(folder.name)
        # A tree without sources, in which every command ends soon.
        (self.work / "tree/cmake").mkdir(parents=True)
        (self.work / "tree/ip").mkdir()
        self.script("tree/cmake/setup.sh", "")

    def script(self, name, text):
        (self.work / name).write_text("#!/bin/sh\n" + text)
        (self.work / name).chmod(0o755)


class Values(Work):
    def test_no_value_reaches_a_shell(self):
        hit = self.work / "hit"
        evil = f"x'; touch {hit}; echo '\"`touch {hit}`$(touch {hit})$(shell touch {hit})"
        for verb, name in (("rm-ip", "NAME"), ("new-ip", "NAME"), ("ip-test", "IP"),
                           ("new-foreign", "NAME"), ("new-foreign", "FILES"),
                           ("synth-accept", "DESIGN"), ("run", "OUT"), ("run", "BUILD"),
                           ("wave", "TEST"), ("bisect", "TEST"), ("ip-test", "CORE_FOLDERS"),
                           ("regress", "NAME"), ("foreign", "IMAGE"), ("run", "KEY")):
            tree = {"ICESOC_TREE": str(self.work / "tree"), "PATH": "/usr/bin:/bin"}
            run = ask if verb == "rm-ip" else quickly
            run("make", "-s", verb, f"{name}={evil}",
                *(["LANG=vhdl"] if verb == "new-ip" else []), "BUILT=1", **tree)
            run("make", "-s", f"{verb}'; touch {hit}; '", **tree)
            found, option = next((each, o) for each in command.COMMANDS.values()
                                 if each.make == verb for o in each.options if o.variable == name)
            run("./icesoc", *found.name.split(), "--built",
                *([evil] if option.positional else [f"--{option.name}", evil]), **tree)
            self.assertFalse(hit.exists(), f"{verb} {name}")

    def test_no_name_of_a_variable_lets_its_value_run(self):
        hit = self.work / "hit"
        for name in ("v", "each", "each=", "a.b-c", "é", "MAKEOVERRIDES", "MAKELEVEL", "value",
                     "eval", "origin", "VPATH", "CURDIR", "ICESOC_GOALS"):
            quickly("make", "-s", "rm-ip", f"{name}=$(shell touch {hit})")
            self.assertFalse(hit.exists(), name)

    def test_a_value_arrives_as_it_is(self):
        odd = "a'b \"c\" {device} `d` $(e) $$ # \\ f=g -- h"
        said = ask("make", "-s", "rm-ip", f"NAME={odd}")[1]
        expected = f"NAME: expected the name of a core, got '{odd}'"
        self.assertIn(expected, said)
        self.assertIn(expected, ask("./icesoc", "core", "remove", odd)[1])

    def test_the_name_of_tests_may_begin_with_a_hyphen(self):
        for text in ("-V", "--help", "-3"):
            chosen = regression.selection(SimpleNamespace(name=text, label="", folder=""), "folder")
            self.assertEqual(regress.parse(chosen).name.text, text)

    def test_a_list_of_cores_without_a_last_newline_gets_a_line(self):
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(TREE)
        (self.work / "cores.list").write_text("\ufefffir")
        with contextlib.redirect_stdout(io.StringIO()):
            core_folder.put_into_repository(self.work, "low_pass")
        self.assertEqual((self.work / "cores.list").read_text(), "fir\nlow_pass\n")

    def test_both_doors_give_the_same_values(self):
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(TREE)  # options accept names of things in the tree
        samples = {"N": "3", "VALUE": "a", "FOLDER": str(TREE / "tools"), "WxH": "96x64",
                   "TIME": "60s", "N|random": "random", "WORD": "a b"}
        for each in command.COMMANDS.values():
            if not each.make:
                continue
            options = [o for o in each.options if o.listed and not o.positional
                       and o.kind.metavar in samples and o.kind not in (SWITCH, FLIGHT)
                       and o.name not in ("loss", "interference")]
            # If an option accepts names, the first name that exists in the tree is used.
            variables = {o.variable: (o.choices(None) or ["a"])[0] if o.choices and o.is_checked
                         else samples[o.kind.metavar] for o in options}
            words = [word for o in options
                     for word in (f"--{o.name}", *variables[o.variable].split())]
            given = each.values(vars(each.parser().parse_args(words)), None, os.getcwd())
            os.environ.update(variables)
            made = each.values({}, list(variables), os.getcwd())
            for name in variables:
                del os.environ[name]
            for o in each.options:
                self.assertEqual(getattr(given, o.field), getattr(made, o.field),
                                 f"{each.name} {o.name}")

    def test_a_certificate_has_the_name_of_its_file(self):
        for name, status in (("Jos\u00e9", 0), ("\u00fc" * 64, 0), ("a" * 65, 2), ("k\udcff", 2)):
            file = self.work / f"{name}.pem"
            found, text = quickly("./icesoc", "key", "--certificate", str(file))
            self.assertEqual(found, status, text)
            if status:
                self.assertIn("expected at most 64 characters in UTF-8 before the suffix", text)
            else:
                subject = subprocess.run(
                    ["openssl", "x509", "-in", file, "-noout", "-subject", "-nameopt",
                     "utf8,-esc_msb"], capture_output=True, text=True, check=True).stdout
                self.assertEqual(subject, f"subject=CN={name}\n")

    def test_a_folder_that_was_removed_is_named_as_the_cause(self):
        place = self.work / "gone"
        place.mkdir()
        text = subprocess.run(["sh", "-c", f"rmdir '{place}' && '{TREE}/icesoc' board list"],
                              cwd=place, capture_output=True, text=True, check=False).stderr
        self.assertIn("the current folder no longer exists", text)

    def test_paths_are_relative_to_the_folder_of_the_caller(self):
        """This also applies to lists of files, and to names that may also be paths. A file name may
        contain spaces; the core's makefiles refuse it later, with a message that names it whole."""
        place = self.work / "mis núcleos"
        (place / "kit").mkdir(parents=True)
        shutil.copy(TREE / "boards/nucleo-qmtech/board.toml", place / "kit")
        for name in "a.v", "b.v", "two words.v":
            (place / name).write_text("")

        def values(*words):
            return command.by_words(words, str(place))[1]
        foreign = values("core", "foreign", "x", "--files", "a.v b.v", "two words.v", "/c.v")
        self.assertEqual(foreign.files, [f"{place}/{name}" for name in (
            "a.v", "b.v", "two words.v")] + ["/c.v"])
        self.assertEqual(values("run", "--core-folders", "kit;/usr").core_folders,
                         f"{place}/kit;/usr")
        self.assertEqual(values("run", "--core-folders", "none").core_folders, "none")
        self.assertEqual(values("run", "--board", "kit/board.toml").board,
                         f"{place}/kit/board.toml")
        self.assertEqual(values("run", "--board", "xynergy").board, "xynergy")
        done = subprocess.run([TREE / "icesoc", "board", "check", "kit/board.toml"], cwd=place,
                              env=clean(), capture_output=True, text=True, check=False)
        self.assertEqual(done.stdout, "kit: 73 nets, no problem found\n", done.stderr)

    def test_a_missing_flight_in_the_default_folder_is_refused(self):
        status, text = quickly("./icesoc", "replay", ICESOC_TREE=str(self.work / "tree"))
        self.assertEqual(status, 2)
        self.assertIn("contains no recorded flight", text)

    def test_keys_and_lists_of_keys_are_made_at_both_doors(self):
        for name in ("tree/build/main/sw/update", "files"):
            (self.work / name).mkdir(parents=True)
        self.script("tree/build/main/sw/update/pack_update", 'echo "$@"\n')
        made, by, first, second = (str(self.work / "files" / name) for name in (
            "a key", "by.key", "first.pub", "second.pub"))
        for name in (by, first, second):
            Path(name).touch()
        every = {"LIST": "3", "BY": by, "FIRST": first}
        for given, status, said in (
                ({}, 0, "only you can read"), ({}, 1, "never overwritten"),
                ({"SIGNING": "1"}, 0, f"public {made} {made}.pub\n"),
                (every, 0, f"keys 3 {by} {first} {made}\n"),
                ({**every, "SECOND": second}, 0, f"keys 3 {by} {first} {second} {made}\n"),
                ({**every, "BY": ""}, 2, "expected --list NUMBER, --by"),
                ({**every, "LIST": ""}, 2, "expected --list NUMBER, --by"),
                ({"SECOND": second}, 2, "expected --list NUMBER, --by"),
                ({**every, "FIRST": "/none"}, 2, "cannot read '/none': No such file"),
                ({**every, "LIST": "0"}, 2, ": expected a whole number, at least 1, got '0'"),
                ({**every, "SIGNING": "1"}, 2, "expected at most one of --certificate"),
                ({"CERTIFICATE": "1", "SIGNING": "1"}, 2, "expected at most one of --certificate")):
            words = [word for name, value in given.items() if value for word in (
                f"--{name.lower()}", value)[:1 if name in ("SIGNING", "CERTIFICATE") else 2]]
            doors = ["./icesoc", "key", made, *words, "--built"], [
                "make", "-s", "key", f"FILE={made}", "BUILT=1",
                *(f"{name}={value}" for name, value in given.items())]
            for door in doors[:1 if status else 2]:
                if not given and not status:
                    Path(made).unlink(missing_ok=True)
                answer = quickly(*door, ICESOC_TREE=str(self.work / "tree"))
                self.assertEqual(answer[0], status, answer[1])
                self.assertIn(said, answer[1])
        self.assertRegex(Path(made).read_text(), r"^[0-9a-f]{32}\n$")
        self.assertEqual(Path(made).stat().st_mode & 0o777, 0o600)

    def test_the_environment_gives_defaults(self):
        for words, given, said in (
                ("make -s fly", {"SEED": "x"},
                 "SEED: expected a whole number, at least 0, got 'x'"),
                ("./icesoc fly", {"SEED": "x"}, "SEED: expected a whole number"),
                ("make -s new-ip NAME=abc", {"LANG": "verilog"},
                 "LANG: expected verilog or vhdl"),
                ("make -s run OPEN=1 KEY=Makefile", {}, "OPEN=1 and KEY=")):
            self.assertIn(said, quickly(*words.split(), **given)[1])
        self.assertNotIn("OPEN=1 flies", quickly("make", "-s", "run", "OPEN=0", "KEY=Makefile",
                                                 "OUT=/proc/none")[1])


# Mistyped commands, each with a part of the message that it must cause.
MISTAKES = {
    "./icesoc rnu": "unknown command 'rnu'; did you mean run?",
    "./icesoc core nwe": "core has no command 'nwe'; did you mean new?",
    "./icesoc run --treshold 3": "run has no option --treshold; did you mean --threshold?",
    "./icesoc run --loss 2": "--loss: expected 0 to 1, got '2'",
    "./icesoc run --size 333x111":
    "--size: expected WIDTHxHEIGHT, 8x8 to 1024x4096, WIDTH a multiple of 8, got '333x111'",
    "./icesoc run --image nofile": "cannot read '",
    "./icesoc run --jobs 0": "--jobs: expected a whole number, at least 1, got '0'",
    "./icesoc run fir": "run: unexpected argument 'fir' (./icesoc run --help)",
    "./icesoc run --seed": "expected one argument",
    "./icesoc run --seed \u0663": "--seed: expected a whole number, at least 0, got '\u0663'",
    "./icesoc run --size \u0669\u0666x64": "--size: expected WIDTHxHEIGHT",
    "./icesoc contract from-rdl Makefile": "expected a SystemRDL file and an output folder",
    "./icesoc key /none/my.key": "folder '/none' not found; create it first",
    "./icesoc core test": "expected the name of a core",
    "./icesoc replay nowhere": "contains no recorded flight",
    "./icesoc run --replay nowhere": "contains no recorded flight",
    "./icesoc core test --ip a-b": "IP: expected the name of a core, got 'a-b'",
    "./icesoc run --key no.key": "./icesoc key",
    "./icesoc run --again Makefile": "expected JSON, got other text in line 1",
    "./icesoc run --again nope": "cannot read the flight 'nope': No such file",
    "./icesoc build all --ucos2 nope": "--ucos2: expected an existing folder, got 'nope'",
    "./icesoc board check": "NAME: expected one of the boards nucleo-qmtech, ",
    "./icesoc core new low_pass": "--lang: expected verilog or vhdl, got none",
    "./icesoc check fresh --packages nope": "--packages: expected an existing folder",
    "./icesoc run --wire=yes": "--wire: expected no value, got 'yes'",
    "./icesoc run --again tools/icesoc/cli/flight.schema.json":
    "is not a flight file: version: expected 4, got none",
    "./icesoc contract": "contract: expected one of the commands diff, from-rdl",
    "./icesoc contract dif": "contract has no command 'dif'; did you mean diff?",
    "./icesoc bench --only airr":
    "--only: expected the name of a bench, got 'airr'; did you mean air? Known: simulator, air, ",
    "./icesoc nightly --steps nothing --built": "unknown step 'nothing': expected one of kept, ran",
    "make -s rnu": "unknown target 'make rnu'; did you mean run?",
    "make -s run LOS=1": "make run has no variable LOS; did you mean LOSS?",
    "make -s run loss=1": "make run has no variable loss; did you mean LOSS?",
    "make -s run DRAW=3": "it is one of make mutants",
    "make -s run CAMERA=yes": "CAMERA: expected 1 or 0, got 'yes'",
    "make -s run SIZE=96x65k": "SIZE: expected WIDTHxHEIGHT",
    "make -s run THRESHOLD=300": "THRESHOLD: expected 0 to 255 grey levels, got '300'",
    "make -s run LOSS=7": "LOSS: expected 0 to 1, got '7'",
    "make -s run CPU=x": "CPU: expected host or m3, got 'x'",
    "make -s run CORES=nobody": "core 'nobody' cannot be called in a mission",
    "make -s run CORES=fri": "; did you mean fir?",
    "./icesoc core test fri": "IP: expected the name of a core, got 'fri'; did you mean fir?",
    "./icesoc synth --design modme": "the name of a design, got 'modme'; did you mean modem?",
    "./icesoc synth edif --design socc": "got 'socc'; did you mean soc?",
    "./icesoc test --label frmware": "got 'frmware'; did you mean firmware?",
    "./icesoc regress --name Brust": "expected a word of a test name, got 'Brust'; did you mean ",
    "./icesoc check mutants --block busses": "got 'busses'; did you mean bus",
    "./icesoc check sanitizers --kinds adress": "got 'adress'; did you mean address?",
    "./icesoc check netlist --family ecp6": "--family: expected xc6s or ecp5, got 'ecp6'",
    "./icesoc test hdl/fsmcc":
    "expected a folder of tests, got 'hdl/fsmcc'; did you mean hdl/fsmc?",
    "./icesoc run --core-folders ip/fri":
    "--core-folders: expected existing folders of cores, got '",
    "./icesoc board show nucleo-qmtec": "did you mean nucleo-qmtech?",
    "./icesoc core wave frr Impulse": "; did you mean fir?",
    "./icesoc core wave fir (": "--test '(': expected a regular expression",
    "./icesoc core wave frr.vhdl": "; did you mean fir?",
    "./icesoc core wave fir Impulsee": "; did you mean Impulse?",
    "./icesoc core wave fir FirCore.RefusesEmty": "got no test of this name in ip/fir; did you "
                                                     "mean RefusesEmpty?",
    "./icesoc core wave test_fsmc_bridge TooErly": "; did you mean TooEarly?",
    "./icesoc contract diff nowhere": "unknown commit BASE=nowhere",
    "./icesoc core remove fri": "ip/fri not found; did you mean fir?",
    "./icesoc core new Fir --lang vhdl": "expected words of small letters and digits",
    "make -s run PROBE=fir.go=1": "PROBE='fir.go=1' needs a probe core: add CORES=probe",
    "make -s run OUT=/proc/none": "OUT=/proc/none: expected a folder",
    "./icesoc run --out /proc/none": "--out /proc/none: expected a folder",
    "./icesoc run --open --key Makefile": "--open and --key Makefile: expected at most one",
    "make -s run WIRE=1 LOSS=0.1": "WIRE=1 flies the mission without modems and radio: leave out "
                                   "LOSS",
    "make -s run UPDATE=/none CPU=m3": "cannot read '/none'",
    "make -s run PINS=/none": "cannot read '/none'",
    "make -s run REPLAY=/none": "'/none' contains no recorded flight",
    "make -s gdb REPLAY=/none": "'/none' contains no recorded flight",
    "make -s soak FUZZED=0": "FUZZED: expected a whole number, at least 1, got '0'",
    "make -s fly MINUTES=abc": "MINUTES: expected a number, at least 0.001 minutes, got 'abc'",
    "make -s test SEED=7x": "SEED: expected a whole number, at least 0, got '7x'",
}


class Mistakes(Work):
    def test_what_is_no_flight_is_refused_in_words(self):
        whole = {"version": flight.VERSION, **{
            option.field: option.default or flight.empty(option) for option in flight.FIELDS}}
        for text, said in ((b"\xff", "expected JSON in UTF-8"), (b"[" * 100000, "deeply"),
                           (json.dumps({**whole, "seed": True}).encode(),
                            "seed: expected a whole number, at least 0, got true"),
                           (json.dumps({**whole, "cores": [1]}).encode(),
                            "cores[0]: expected a text, got 1")):
            (self.work / "flight.json").write_bytes(text)
            status, text = quickly("./icesoc", "run", "--again", str(self.work / "flight.json"))
            self.assertEqual(status, 2)
            self.assertIn(said, text)

    def test_each_is_answered_in_words(self):
        for words, said in MISTAKES.items():
            # of these commands, ./icesoc imports only one file
            alone = words.startswith(tuple(f"./icesoc {name}" for name in QUICK))
            status, text = (ask if alone else quickly)(*words.split())
            self.assertEqual(status, 2, words)
            self.assertIn(said, text, words)
            self.assertNotIn("Traceback", text, words)

    def test_a_path_with_spaces_is_refused_before_packages_are_installed(self):
        self.script("tree/cmake/setup.sh", "echo set up\n")
        tree, folder = {"ICESOC_TREE": str(self.work / "tree")}, str(self.work / "mis núcleos")
        (self.work / "mis núcleos/tree").mkdir(parents=True)
        for words, where in ((("build", "all", "--build", folder), tree),
                             (("core", "new", "x", "--lang", "vhdl", "--repository", folder), tree),
                             (("core", "foreign", "x", "--repository", folder), tree),
                             (("build", "all"), {"ICESOC_TREE": f"{folder}/tree"})):
            status, text = ask("./icesoc", *words, **where)
            self.assertEqual(status, 2, f"{words}: {text}")
            self.assertRegex(text, f"^icesoc: '{folder}(/tree)?': expected a folder without spaces")

    def test_a_key_that_cannot_be_written_leaves_no_file(self):
        """A limit of 0 bytes for files has the same effect as a full disk."""
        file = self.work / "my.key"
        self.assertEqual(ask("prlimit", "--fsize=0", "./icesoc", "key", str(file)),
                         (1, f"icesoc: cannot write '{file}': File too large\n"))
        self.assertEqual(list(self.work.glob("my.key*")), [])

    def test_clean_reports_what_it_removed(self):
        """The folder build may be a link. Clean ends with an error if an entry cannot be
        removed."""
        (self.work / "far/main").mkdir(parents=True)
        (self.work / "tree/build").symlink_to(self.work / "far")
        tree = {"ICESOC_TREE": str(self.work / "tree")}
        self.assertEqual(ask("./icesoc", "clean", **tree), (0, "removed: build/main\n"))
        self.assertEqual(os.listdir(self.work / "far"), [])
        (self.work / "tree/build").unlink()
        (self.work / "tree/build").symlink_to("/proc/sys/kernel/random")
        status, text = ask("./icesoc", "clean", **tree)
        self.assertEqual(status, 1)
        self.assertRegex(text, "^icesoc: (Operation not permitted|Permission denied): build/")

    def test_without_root_or_debootstrap_the_nightly_skips_the_empty_systems(self):
        values = SimpleNamespace(folder=str(self.work), list=False, packages="", release="")
        for user, said in ((1000, "expected root"), (0, "apt-get install debootstrap")):
            with mock.patch("os.geteuid", return_value=user), mock.patch.dict(
                    os.environ, {"PATH": str(self.work)}), self.assertRaisesRegex(Stop, said) as it:
                fresh.fresh(values)
            self.assertEqual(it.exception.status, SKIPPED)

    def test_the_probe_without_a_map_is_refused(self):
        status, text = ask("tools/python", "-m", "icesoc.cores.probe", "--proxy", "probe:default",
                           "--map", "/none", str(self.work / "capture.vcd"))
        self.assertEqual(status, 1, text)
        self.assertIn("probe: --map: expected gen/chip.json", text)

    def test_nothing_is_built_before_what_is_wrong_is_said(self):
        self.script("tree/cmake/setup.sh", "echo set up\n")
        for folder in ("ip", "synth", "tests"):
            shutil.copytree(TREE / folder, self.work / "tree" / folder, dirs_exist_ok=True)
        for wrong in ("run LOSS=7", "run SIZE=1x1", "run IMAGE=none", "run SEED=-1",
                      "run CORES=nobody", "run PROBE=u_fir.sent=1", "run APP=minimal",
                      "run THRESHOLD=300", "ip-test IP=fri", "synth DESIGN=scs", "test LABEL=rlt",
                      "regress NAME=Brust", "mutants BLOCK=busses", "bench ONLY=airr",
                      "contract-diff BASE=nowhere", "wave IP=fri TEST=Impulse",
                      "wave IP=fir TEST=Impulsee", "wave IP=fri.vhdl"):
            status, text = quickly("make", "-s", *wrong.split(),
                                   ICESOC_TREE=str(self.work / "tree"))
            self.assertEqual(status, 2, wrong)
            self.assertNotIn("set up", text, wrong)

    def test_names_are_completed_at_both_doors(self):
        for line, wanted in (("make ip-t", "ip-test"), ("make ip-test IP=f", "fir"),
                             ("make run CP", "CPU="), ("make run CPU=", "host m3"),
                             ("make test LABEL=firm", "firmware"),
                             ("make synth DESIGN=modem_ba", "modem_baud"),
                             ("make run CORES=as", "ascon"), ("make run NONE=", ""),
                             ("make run BOARD=xyn", "xynergy"),
                             ("make -s run OUT='a b' LIVE=1 CPU=m", "m3")):
            self.assertEqual(quickly("./icesoc", _ICESOC_MAKE=line),
                             (0, "\n".join(wanted.split()) + "\n"), line)
        # of a value of several words, the last one is completed
        for line in ('make run CORES="fir as', "make run CORES='fir as", r"make run CORES=fir\ as"):
            self.assertEqual(quickly("./icesoc", _ICESOC_MAKE=line), (0, "fir ascon\n"), line)
        for line, wanted in (("./icesoc core test f", "fir"), ("./icesoc run --cpu ", "host"),
                             ("./icesoc run --board xy", "xynergy"),
                             ("./icesoc test --label firm", "firmware"),
                             ("./icesoc synth --design modem_ba", "modem_baud"),
                             ("./icesoc regress --name IsReportedOn", "IsReportedOnceWith")):
            if importlib.util.find_spec("argcomplete"):
                done = subprocess.run(
                    ["bash", "-c", "./icesoc 8>&1 9>/dev/null >/dev/null 2>&1"], cwd=TREE,
                    capture_output=True, text=True,
                    env=clean(_ARGCOMPLETE="1", COMP_TYPE="9", _ARGCOMPLETE_IFS="\n",
                              COMP_LINE=line, COMP_POINT=str(len(line)),
                              _ARGCOMPLETE_SUPPRESS_SPACE="1"))
                self.assertIn(wanted, done.stdout, line)

    def test_a_full_disk_leaves_the_old_files(self):
        old, limit = "# a line\n" * 3000, resource.getrlimit(resource.RLIMIT_FSIZE)
        (self.work / "wiring.svg").write_text(old)
        (self.work / "cores.list").write_text(old)
        self.addCleanup(resource.setrlimit, resource.RLIMIT_FSIZE, limit)
        # every write beyond this limit fails, as on a full disk
        resource.setrlimit(resource.RLIMIT_FSIZE, (20000, limit[1]))
        self.assertEqual(ask("./icesoc", "board", "make", "nucleo-qmtech", "--out", self.work),
                         (1, f"icesoc: cannot write {self.work}/wiring.svg: File too large\n"))
        with contextlib.chdir(TREE), contextlib.redirect_stdout(io.StringIO()), \
                self.assertRaisesRegex(Stop, "cannot write .*/cores.list: File too large"):
            core_folder.put_into_repository(self.work, "low_pass")
        for file in ("wiring.svg", "cores.list"):
            self.assertEqual((self.work / file).read_text(), old)
        self.assertEqual([*self.work.glob("*.part")], [])

    def test_an_incomplete_waveform_is_reported(self):
        """GHDL ends with status 0 even if it could not write the whole file."""
        file = self.work / "fir.fst"
        file.write_bytes(b"\0" * 400)
        with self.assertRaisesRegex(Stop, f"{file}: the waveform is incomplete"):
            core.rows_of(file, None, "fir.vhdl")

    def test_where_one_may_not_write_what_to_do_is_said(self):
        theirs = self.work / "theirs"
        theirs.mkdir()
        self.work.chmod(0o755)
        theirs.chmod(0o555)
        (self.work / "mine").mkdir()
        (self.work / "mine").chmod(0o777)
        drop = "setpriv --reuid=65534 --regid=65534 --clear-groups".split()
        other = drop if os.getuid() == 0 else []
        if subprocess.run([*other, "test", "-x", TREE / "icesoc"]).returncode:
            self.skipTest("another user cannot read this tree")
        words = [*other, "./icesoc", "build", "configure", "--build"]
        tree = {"ICESOC_TREE": str(self.work / "tree")}
        self.assertIn(f"{theirs} is not writable", ask(*words, str(theirs), **tree)[1])
        self.assertIn("XDG_CACHE_HOME", ask(*words, str(self.work / "mine"), HOME=str(theirs),
                                            XDG_CACHE_HOME="", **tree)[1])

    def test_a_missing_program_and_a_full_disk_are_told(self):
        (self.work / "bin").mkdir()
        for name in ("setpriv", "sh", "dirname"):
            (self.work / "bin" / name).symlink_to(shutil.which(name))
        status, text = ask("./icesoc", "build", ICESOC_TREE=str(self.work / "tree"), PATH=str(
            self.work / "bin"))
        self.assertEqual((status, text), (127, "icesoc: program 'cmake' not found: "
                                          "./icesoc setup --tests installs missing packages\n"))
        self.assertEqual(ask("./icesoc", "commands", "--man", "/dev/full"),
                         (1, "icesoc: cannot write /dev/full: No space left on device\n"))

    def test_an_interrupt_ends_all_with_one_message(self):
        self.interrupt("./icesoc", "build")

    def test_an_interrupt_of_a_command_that_runs_another_prints_one_message(self):
        self.interrupt("tools/python", "-c", "import sys; from icesoc.cli.main import main; "
                       "from icesoc.util.process import run; "
                       "sys.exit(main([], lambda _: run(['./icesoc', 'build'])))")

    def interrupt(self, *words):
        """Presses Ctrl-C while the command builds."""
        self.script("tree/cmake/setup.sh", f"echo $$ >{self.work}/child\nexec sleep 5000\n")
        run = subprocess.Popen(words, cwd=TREE, env=clean(ICESOC_TREE=str(self.work / "tree")),
                               stderr=subprocess.PIPE, text=True, start_new_session=True)
        child = self.work / "child"
        while not child.exists() or not child.read_text():
            time.sleep(0.01)
        os.killpg(run.pid, 2)
        self.assertEqual(run.communicate()[1], "icesoc: stopped\n")
        self.assertEqual(run.returncode, 130)
        # If the child had just been started, it may end a little later than its parent.
        while Path("/proc", child.read_text().strip()).exists():
            time.sleep(0.01)

    def test_a_build_names_the_source(self):
        Path(self.work, "mixer.v").write_text(
            "// Generated by GHDL from the VHDL of mixer: do not edit.\n"
            "  wire [3:0] n1_o;\n  wire n2_o;\n"
            "  /* ip/mixer.vhd:9:10  */\n  assign n1_o = n2_o;\n"
            "  /* ip/mixer.vhd:12:3  */\n  always @*\n    n2_o = n1_o[0];\n")
        for line, place in ((2, 9), (3, 12), (5, 9), (7, 12)):
            at = f"{self.work}/mixer.v:{line}"
            self.assertEqual(explained(f"%Warning: {at}:5: a loop\n"),
                             f"%Warning: {at} (ip/mixer.vhd:{place}):5: a loop\n")
        Path(self.work, "own.v").write_text("// own\n")
        for said in (f"{self.work}/own.v:1:2: odd\n", f"{self.work}/none.v:1:2: odd\n"):
            self.assertEqual(explained(said), said)
        Path(self.work, "CMakeLists.txt").write_text("icesoc_core(a\n  VERILOG ba.v a.v)\n")
        said = (f"ninja: error: '{self.work}/a.v', needed by 'b', "
                "missing and no known rule to make it")
        self.assertEqual(explained(said),
                         f"{self.work}/CMakeLists.txt:2: file {self.work}/a.v not found\n{said}")
        Path(self.work, "CMakeLists.txt").write_text("icesoc_core()\n")
        Path(self.work, "core.toml").write_text('verilog = [\n    "ba.v",\n    "a.v",\n]\n')
        self.assertEqual(explained(said),
                         f"{self.work}/core.toml:3: file {self.work}/a.v not found\n{said}")


class Trees(Work):
    """Tests of commands that use build folders."""
    def configure(self, tree):
        return ask("./icesoc", "build", "configure", "--build", "build", ICESOC_TREE=str(tree),
                   XDG_CONFIG_HOME=str(self.work / "config"))

    def test_a_tree_that_was_moved_is_built_anew_and_one_that_was_not_is_left_alone(self):
        old, new, config = self.work / "tree", self.work / "new", self.work / "config"
        (old /
         "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.25)\nproject(moved NONE)\n")
        self.assertEqual(self.configure(old)[0], 0)
        (old / "build/kept").touch()
        (old / "build/update.key").write_bytes(b"private")
        self.assertEqual(self.configure(old)[0], 0)
        self.assertTrue((old / "build/kept").exists())
        old.rename(new)
        status, text = self.configure(new)
        self.assertIn(f"build was configured for the tree in {old}: creating it again", text)
        self.assertEqual(status, 0)
        self.assertEqual((config / "icesoc/update.key").read_bytes(), b"private")
        # If CMake rejects a value, the value must not be stored; otherwise all later commands would
        # fail.
        with open(new / "CMakeLists.txt", "a") as file:
            file.write('if(CORE_FOLDERS)\n'
                       '  message(FATAL_ERROR "CORE_FOLDERS is ${CORE_FOLDERS}")\nendif()\n')
        here = self.work / "here"
        here.mkdir()
        status, text = ask("./icesoc", "core", "test", "here", "--core-folders", str(here),
                           "--build", "build", ICESOC_TREE=str(new))
        self.assertIn(f"CORE_FOLDERS is {here}", text)
        self.assertEqual(ask("cmake", str(new / "build"))[0], 0)

    def test_of_two_at_once_in_a_new_tree_one_configures(self):
        (self.work / "tree/CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(twice NONE)\n"
            "execute_process(COMMAND sleep 0.5)\nfile(APPEND ${CMAKE_BINARY_DIR}/times x)\n")
        with concurrent.futures.ThreadPoolExecutor() as two:
            ends = list(two.map(self.configure, 2 * [self.work / "tree"]))
        self.assertEqual([status for status, said in ends], [0, 0], ends)
        self.assertEqual((self.work / "tree/build/times").read_text(), "x")

    def test_keys_are_outside_of_what_is_built_and_nothing_removes_them(self):
        tree, config = self.work / "tree", self.work / "config"

        def remove(text):
            (tree / "build/main").mkdir(parents=True, exist_ok=True)
            # file in which earlier versions stored the key
            (tree / "build/main/update.key").write_text(text)
            ask("make", "-s", "clean", ICESOC_TREE=str(tree), XDG_CONFIG_HOME=str(config))
            self.assertFalse((tree / "build").exists())
            return sorted(key.read_text() for key in (config / "icesoc").glob("update*.key"))

        self.assertEqual(remove("one"), ["one"])
        self.assertEqual(remove("one"), ["one"])
        self.assertEqual(remove("another"), ["another", "one"])
        self.assertEqual((config / "icesoc/update.key").read_text(), "one")
        self.assertEqual({key.stat().st_mode & 0o777
                          for key in (config / "icesoc").iterdir()}, {0o600})

    def test_of_two_runs_of_all_commands_one_is_refused(self):
        build = self.work / "tree/build"
        build.mkdir(parents=True)
        with lock(build / "commands.lock"):
            status, said = ask("./icesoc", "commands", "--brief",
                               ICESOC_TREE=str(self.work / "tree"))
        self.assertEqual((status, said), (1, "icesoc: all commands run in this folder already\n"))

    def test_programs_have_one_environment(self):
        self.script("tree/cmake/setup.sh", 'echo "$HOME $LC_ALL $CCACHE_BASEDIR ${SEED:-none} '
                    '${MAKEFLAGS:-none} ${NAME:-none}"\nexit 1\n')
        tree = str(self.work / "tree")
        said = ask("env", "-u", "HOME", "make", "-s", "test", "SEED=3", "NAME=x", ICESOC_TREE=tree,
                   LC_ALL="de_DE.UTF-8")[1]
        self.assertIn(f"{Path.home()} C.UTF-8 {tree} none none none\n", said)


if __name__ == "__main__":
    unittest.main()
