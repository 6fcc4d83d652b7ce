# SPDX-License-Identifier: MIT
"""foreign: puts third-party cores into slots (docs/guides/foreign-core.md)."""
import shutil
from pathlib import Path

from icesoc.cli.build_folder import BuildFolder, check_spaces, fetch
from icesoc.cli.command import command
from icesoc.cli.commands.core_folder import NAME, REPOSITORY, put_into_repository
from icesoc.cli.flight import FIELDS
from icesoc.cli.options import BUILD, COUNT, FILES, JOBS, SEED, SWITCH, TEXT, WORDS, Option, one_of
from icesoc.cores import examples
from icesoc.util import spelling
from icesoc.util.console import say, warn
from icesoc.util.errors import SKIPPED, Stop
from icesoc.util.lock import lock
from icesoc.util.process import run, tool


def foreign_words(values):
    """Returns the arguments for cores/new_foreign.py."""
    given = {name: getattr(values, name.lower()) for name in ("CLOCK", "ADDRESS")}
    return [values.name, values.top, values.bus, f"{values.repository or 'ip'}/{values.name}",
            *(f"{name}={value}" for name, value in given.items() if value),
            *(f"LIBRARY={each}" for each in values.library),
            *(f"PARAM:{each}" for each in values.params),
            *(f"DEFINE:{each}" for each in values.defines),
            *(["SPELLING=make"] if spelling.IS_MAKE else []), *values.ports, *values.files]


@command("core foreign", [
    NAME,
    Option("top", TEXT, "top module or entity of the core", ""),
    Option("bus", TEXT, "bus of the core: wishbone, axil, apb, avalon, memory, axis, or own (any "
                        "other bus, described by --ports)", ""),
    Option("files", FILES, "Verilog or VHDL files of the core"),
    Option("ports", WORDS, "roles of the core ports, as ROLE=PORT, such as write=we ack=done"),
    Option("params", WORDS, "parameters of the top module, such as DEPTH=16"),
    Option("defines", WORDS, "Verilog macros to define, such as WIDE"),
    Option("clock", COUNT, "frequency of a separate clock, Hz"),
    Option("library", WORDS,
           "VHDL library of the files; NAME=FILE for a file in another library, such as "
           "util=pkg.vhd"),
    Option("address", one_of("words", "bytes"),
           "unit of the core's address: words or bytes; detected by default"),
    REPOSITORY, BUILD, JOBS
], make="new-foreign", brief=(
    "core foreign brief_foreign --top req_words --bus own --files tests/ip/new_foreign/cores.v "
    "--ports select=req write=wr address=where wdata=value rdata=held ack=gnt",
    "core remove brief_foreign --force"), examples=[
             "core foreign my_uart --top wbuart --bus wishbone --files wbuart.v ufifo.v",
             "core foreign my_pwm --top apb_pwm --bus apb --files apb_pwm.v --params CHANNELS=2",
             "core foreign my_spi --top spi --bus axil --files spi.vhd --clock 50000000"])
def foreign_core(values):
    """put a third-party core into a slot, as ip/NAME

    Reads the ports of the core's top module, connects them to a slot, and writes registers, a
    test and a manifest. docs/guides/foreign-core.md lists the buses. With --repository, source
    files inside the repository are stored as relative paths.
    """
    check_spaces(values.repository or "ip")
    build = BuildFolder(values.build, values).prepare()
    if any(file.lower().endswith((".vhd", ".vhdl")) for file in values.files):
        build.ninja("ghdl")
    status = run([*tool("cores.new_foreign"), *foreign_words(values),
                  f"GHDL={build / 'ghdl/ghdl'}"], check=False)
    if status:
        return status
    if values.repository:
        return put_into_repository(values.repository, values.name)
    return say(f"Next: ./icesoc core test {values.name}; a line '{values.name}' in ip/cores.list "
               f"puts it into the chip; ./icesoc run --cores {values.name} calls it by "
               "radio")


def into_slot(source, slot, words, folder, ghdl):
    """Runs new_foreign.py, which writes the folder of a slot. `words`: the module, the bus, further
    arguments, and patterns of the core files, relative to the folder `source`."""
    top, bus, *more = words.split()
    rest = [part for word in more for part in (
        [word] if "=" in word or word.startswith("DEFINE:") else sorted(source.glob(word)))]
    run([*tool("cores.new_foreign"), slot, top, bus, folder / slot, *rest, f"GHDL={ghdl}"],
        stdout=-3)
    return folder / slot


def put_and_fly(values):
    """Puts the chosen cores into slots, then tests and flies them. Returns the exit status."""
    folder = Path("build/foreign-cores").absolute()
    missing = 0
    if examples.fetch(folder):
        fetch("ghdl", folder / "ghdl5")
    else:
        warn("cannot get any third-party core: is there a network?")
        missing = SKIPPED
    shutil.rmtree(folder / "slots", ignore_errors=True)
    chips = {}  # number of a chip -> {core: folder of its slot}
    for source in examples.SOURCES:
        for core in source.cores:
            if source.is_in(folder) and core.name in (values.cores or examples.cores()):
                chips.setdefault(core.chip, {})[core] = core.folder or into_slot(
                    folder / source.name, core.name, core.new, folder / "slots",
                    folder / "ghdl5/ghdl")
    if set(values.cores) - {core.name for cores in chips.values() for core in cores}:
        missing = SKIPPED
    status = 0
    for number, cores in sorted(chips.items()):
        names = folder / f"chip{number}.list"
        names.write_text("".join(f"{core.name} {core.list}\n" for core in cores))
        status = run(["examples/foreign/orders.sh", names, *cores.values()], check=False, env={
            "IMAGE": values.image, "JOBS": values.jobs, "SEED": values.seed,
            "ORDERS": "backwards shuffled listed" if len(cores) > 1 and not values.cores
                      else "listed",
            "CHIP": "1" if values.chip and all(core.netlist for core in cores) else ""
        }) or status
    return status or missing


@command("core examples", [
    Option("cores", WORDS, "names of the cores to use, from tools/icesoc/cores/examples.py "
                           "(default: all); the chip is then built only once, with the cores in "
                           "this order"),
    Option("chip", SWITCH, "also print the cost of each core in the chip"), SEED,
    *(o for o in FIELDS if o.name == "image"), BUILD, JOBS], make="foreign",
         brief="core examples --cores foreign_i2c foreign_arbiter foreign_queue",
         long="core examples --chip",
         examples=[
             "core examples",
             "core examples --cores aes",
             "core examples --chip --seed 7"])
def core_examples(values):
    """download public cores, put them into slots and call them by radio

    The cores have Wishbone, Avalon-MM, AXI4-Lite, AXI-Stream and plain buses, and are written
    in Verilog, SystemVerilog and VHDL. They are downloaded from Debian's mirror and GitHub; a core
    that cannot be downloaded is skipped. Together with two cores of this tree they form a chip,
    which is built and flown three times, each time with its cores in another order. Cores in
    SystemVerilog that Yosys cannot read fly in a second chip, which is not synthesised. Exit
    status 77: no core could be downloaded, or a core given by --cores could not be downloaded.
    """
    if unknown := set(values.cores) - examples.cores().keys():
        raise Stop(f"CORES: unknown core '{sorted(unknown)[0]}': expected one of "
                   f"{' '.join(sorted(examples.cores()))}", 2)
    if not values.built:
        run(["cmake/setup.sh", "--tests"])
    with lock("build/foreign.lock", refuse="core examples: another one runs in this folder; wait "
                                           "until it ends"):
        return put_and_fly(values)
