#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""fuzz_parsers: runs a parser of hand-written files on mutated files, mostly in this process.

    fuzz_parsers.py PARSER BUILD INPUTS [FILE...]

The parser must either read a file, or reject it with a proper message and an exit status that is
not 0. It must not write output for a file that it rejects. Any other behaviour is reported as a
finding, and so is the use of more than 5 s of CPU time. Inputs that reach a new line of the parser
are mutated further. FUZZ=600 runs for 600 s instead of INPUTS inputs, and starts with the inputs
that earlier runs stored (~/.cache/icesoc/fuzz). SEED (default 1) selects the mutations. If FILE is
given, only these files are read, unchanged.
"""
import contextlib
import dataclasses
import hashlib
import importlib
import io
import json
import os
import random
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
import traceback
from pathlib import Path

from icesoc import TREE
from script import LONGEST

DATA = TREE / "tests/bus/cores/data"
BUILD, WORK = Path(), Path()  # the build folder, and the work folder of this run
CORES = {path.name.split(".")[0]: f"{path.with_name(path.name.split('.')[0] + '.toml')}={path}"
         for path in DATA.glob("*.regs.json")} | {
             "probe": f"{TREE}/ip/probe/core.toml={TREE}/ip/probe/probe.regs.json"}
COREMAP = ["--base", TREE / "bus/map.regs.json", "--output-dir", "OUT"]
LISTS = [
    "adder gate=on\nadder name=other\nled slot=7 button_i=@A4\n",
    "led\ntuner clock_i=@A9\ntuner name=other clock_i=led.led_o\ntuner name=made clock=6/25\n",
    "mover\nmover name=last memory=0x1000800 identity=x # last\n",
    "probe signals=u_adder.irq_o,u_modem.u_timer.clocks:17\n"]
RDL = """addrmap lamp { name = "Lamp // no comment"; default regwidth = 8; default sw = rw;
    enum colour { red = 0; }; reg state_r { field { sw = r; hw = w; } MODE[2] = 2'b01; };
    reg { field { desc = "Level"; } LEVEL[7:0] = 8'hFF; regwidth = 16; } CTRL @ 0x2;
    state_r STATE @ 4; reg { field { woclr; } DONE[0:0] = 0; } EVENTS @ 6; };
"""
KEYS = "# ours\n0x0001 {0}\n0xBEEF {0} {0}\n{0}\n".format("00112233445566778899AABBCCDDEEFF")
# Words of Python and of libraries that our error messages must not contain.
FOREIGN = re.compile(
    r"Traceback|[a-z]Error\b|NoneType|'\w+' object|unhashable|subscriptable|not supported between"
    r"|indices must|\b\w+\(\) |unsupported operand|literal for int|must be str|exception\.\w+\.\d+"
    r"|can only concatenate|not iterable|json\.|terminate called|codec can't")


@dataclasses.dataclass
class Parser:
    module: str
    words: list  # arguments; FILE is replaced by the input file, OUT by the folder for output
    seeds: object  # patterns of the files to mutate, or a function that returns the files
    function: str = "main"  # function to call; it gets the input file if `words` is empty
    program: str = ""  # program in the build folder that is run instead of calling the module


def chip_rdl():
    from icesoc.chip import coremap
    return coremap.core_exchange.rdl_of([
        coremap.Slot("led", 2, 0x1000, coremap.described(DATA / "led.regs.json"))])


def manifests():
    """Returns the manifests of the tree's cores. Creates empty files with the names that occur in
    the manifests."""
    texts = []
    for pattern in ("ip/*/core.toml", "tests/bus/cores/data/*.toml", "tests/e2e/cores/*/core.toml"):
        for path in sorted(TREE.glob(pattern)):
            text = path.read_text()
            for file in re.findall(r'"([\w.]+[.]\w+)"', text):
                (WORK / file).touch()
            texts.append(text if "\nname = " in text else f'name = "core"\n{text}')
    return texts


def flights():
    from icesoc.cli import flight
    values = {option.field: option.default or flight.empty(option) for option in flight.FIELDS}
    return [json.dumps({"version": flight.VERSION, **values, "firmware": "x"}, indent=1)]


PARSERS = {
    "regs": Parser("icesoc.regs.generate", ["FILE", "--output-dir", "OUT"], [
        "hdl/*/*.regs.json", "ip/*/*.regs.json", "bus/*.regs.json", "tests/bus/cores/data/*.json"]),
    "manifest": Parser("icesoc.chip.manifest", ["FILE"], manifests),
    "rdl": Parser("icesoc.regs.rdl", ["FILE", "OUT"], lambda: [RDL, chip_rdl()]),
    "cores": Parser("icesoc.chip.coremap", ["FILE", *COREMAP, *(
        word for name, path in CORES.items() for word in ("--core", f"{name}={path}"))],
                    lambda: LISTS),
    "core": Parser("icesoc.chip.coremap", ["LIST", *COREMAP, "--core",
                                           f"adder={DATA}/adder.toml=FILE", "--core",
                                           f"led={CORES['led']}"], [
        "ip/*/*.regs.json", "tests/bus/cores/data/*.json"]),
    "flight": Parser("icesoc.cli.flight", [], flights, "read"),
    "sim": Parser("", ["--flight", "FILE", "--wave", "x"], flights,
                  program="testbench/sim/icesoc-sim"),
    "provided_key": Parser("provide_key", ["--port", "/dev/null", "--key", "FILE"],
                           lambda: [KEYS]),
}


class TooLong(BaseException):
    """Raised when the parser has used more CPU time than allowed."""


class Runner:
    """Runs a parser, and records which of its lines were reached."""

    def __init__(self, parser):
        self.parser, self.reached = parser, set()
        self.file, self.out = WORK / "input", WORK / "out"
        self.file.touch(0o600)
        (WORK / "list").write_text("adder name=one gate=on\nled\n")
        self.words = [str(word) for word in parser.words]
        for name in ("FILE", self.file), ("OUT", self.out), ("LIST", WORK / "list"):
            self.words = [word.replace(name[0], str(name[1])) for word in self.words]
        if not parser.program:
            self.function = getattr(importlib.import_module(parser.module), parser.function)
            files = {getattr(each, "__file__", None) or "" for each in sys.modules.values()}
            self.files = {file for file in files if file.startswith(f"{TREE}/")} - {__file__}
            signal.signal(signal.SIGVTALRM, self.stop)

    @staticmethod
    def stop(*_):
        raise TooLong

    def trace(self, frame, _event, _argument):
        return self.line if frame.f_code.co_filename in self.files else None

    def line(self, frame, _event, _argument):
        self.reached.add((frame.f_code.co_filename, frame.f_lineno))
        return self.line

    def call(self):
        """Runs the parser on an input. Returns (status, message); a status of at least 128 is a
        finding."""
        if self.parser.program:
            run = subprocess.run([BUILD / self.parser.program, *self.words],
                                 capture_output=True, timeout=LONGEST)
            return run.returncode & 255, (run.stdout + run.stderr).decode(errors="replace")
        said = io.StringIO()
        try:
            with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
                signal.setitimer(signal.ITIMER_VIRTUAL, 5)
                sys.settrace(self.trace)
                if self.words:
                    sys.argv = [self.parser.module, *self.words]
                    status = self.function()
                else:
                    self.function(str(self.file))
                    status = 0
        except SystemExit as end:
            status = end.code
        except TooLong:
            return 128, "5 s of CPU time"
        except BaseException as error:
            if type(error).__name__ != "Stop":  # icesoc.util.errors.Stop
                return 128, traceback.format_exc()
            status = error.text
        finally:
            sys.settrace(None)
            signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        if isinstance(status, str):
            return 1, said.getvalue() + status
        return status or 0, said.getvalue()

    def finding(self, data):
        """Runs the parser on an input. Returns a description of its error, or None if it behaves
        correctly."""
        self.file.write_bytes(data)
        for old in self.out.iterdir():
            old.unlink()
        self.reached.clear()
        status, said = self.call()
        written = sorted(self.out.iterdir())
        if status >= 128:
            return said
        if status and written:
            return f"refused, and {written[0].name} is written: {said}"
        if status and (not said.strip() or FOREIGN.search(said)):
            return f"not our words: {said or 'none'}"
        return None


TOKEN = re.compile(rb'"(?:[^"\\]|\\.)*"|\w+|\s+|[^\w\s]')
ODD = [b"9" * 25, b"9" * 5000, b"\xff", b"\0", b"\n", b"\xe0\xb9\x95", b"\xc2\xb2", *(
    r'''-1 0 1 15 16 31 33 255 65536 4294967296 1e9 1.5 NaN Infinity null true [] {} "" "0" "\ud800"
        "\n" "*/" "../x" "/x" "x\u0000" \ " 0x 'hZ [ { ( = ; @ , #'''.encode().split())]


def mutated(data, corpus, words, draw):
    """Returns a copy of `data` with a few random changes: of words, of bytes, or of its two
    halves."""
    tokens = TOKEN.findall(data) or [b""]
    for _ in range(draw.choice((1, 1, 1, 2, 3, 6))):
        at = draw.randrange(len(tokens) + 1)
        end = min(len(tokens), at + draw.choice((1, 1, 2, 4, 20)))
        how = draw.randrange(8)
        if how == 0:
            del tokens[at:end]
        elif how == 1:
            tokens[at:at] = tokens[at:end] * draw.choice((1, 1, 1, 2, 40))
        elif how == 2:
            tokens[at:at] = [draw.choice(ODD)] * draw.choice((1,) * 20 + (3000,))
        elif how < 5:
            tokens[at:end] = [draw.choice(ODD)]
        elif how == 5:
            tokens[at:end] = [draw.choice(words)]
        elif how == 6:
            other = TOKEN.findall(draw.choice(corpus)) or [b""]
            other = other[draw.randrange(len(other)):]
            tokens[at:] = other[:draw.choice((1, 3, 10, 1000))] + draw.choice(([], tokens[end:]))
        else:
            whole = bytearray(b"".join(tokens)) or bytearray(1)
            whole[draw.randrange(len(whole))] ^= 1 << draw.randrange(8)
            tokens = TOKEN.findall(bytes(whole)) or [b""]
    return b"".join(tokens)[:100000]


def kept_in(name):
    cache = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    folder = Path(cache) / "icesoc/fuzz" / name
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def fuzz(name, runs, seconds):
    """Mutates inputs until the number of inputs or the time is reached. Returns the number of
    inputs, and the findings by message."""
    runner, seed = Runner(PARSERS[name]), PARSERS[name].seeds
    corpus = [text.encode() for text in seed()] if callable(seed) else [
        path.read_bytes() for pattern in seed for path in sorted(TREE.glob(pattern))]
    folder = kept_in(name) if seconds else None
    if folder:
        corpus += [path.read_bytes() for path in sorted(folder.iterdir())]
    draw, words = random.Random(int(os.environ.get("SEED", 1))), [
        word for data in corpus for word in TOKEN.findall(data) if word.strip()]
    known, found, begin, count = set(), {}, time.monotonic(), 0
    while time.monotonic() - begin < seconds if seconds else count < runs:
        isNew = count < len(corpus) and not found
        data = corpus[count] if count < len(corpus) else mutated(draw.choice(corpus), corpus, words,
                                                                 draw)
        said = runner.finding(data)
        count += 1
        if said:
            kind = re.sub(r"0x\w+|[\d\W]+", " ", said.strip().splitlines()[-1])[:80]
            if kind not in found or len(data) < len(found[kind][1]):
                found[kind] = said, data
        elif runner.reached - known and not (isNew and count <= len(corpus)):
            corpus.append(data)
            if folder:
                (folder / hashlib.sha256(data).hexdigest()[:16]).write_bytes(data)
        known |= runner.reached
    return count, found, time.monotonic() - begin


def main():
    global BUILD, WORK
    name, build, runs, *files = sys.argv[1:]
    BUILD, seconds = Path(build).resolve(), float(os.environ.get("FUZZ", 0))
    resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
    with tempfile.TemporaryDirectory(dir="/dev/shm") as work:  # in memory
        WORK = Path(work)
        (WORK / "out").mkdir()
        if files:
            runner = Runner(PARSERS[name])
            found = {path: (said, Path(path).read_bytes()) for path in files
                     if (said := runner.finding(Path(path).read_bytes()))}
            count, spent = len(files), 1
        else:
            count, found, spent = fuzz(name, int(runs), seconds)
    for said, data in found.values():
        print(f"fuzz: {said.strip()[-1500:]}\nof the input {data[:2000]!r}\n", file=sys.stderr)
    if found:
        sys.exit(f"fuzz: {name}: {len(found)} findings, SEED={os.environ.get('SEED', 1)}")
    print(f"{'note: ' if seconds else ''}{count} inputs, {count / spent:.0f} a second: each is "
          "read, or refused in our words")


if __name__ == "__main__":
    main()
