# SPDX-License-Identifier: MIT
"""foreign: puts third-party cores into slots (docs/recipes.md)."""
import shutil
from pathlib import Path

from cli.build_folder import BuildFolder, fetch
from cli.command import command
from cli.commands.core import NAME, REPOSITORY, put_into_repository
from cli.flight import FIELDS
from cli.options import BUILD, COUNT, FILES, JOBS, SEED, SWITCH, TEXT, WORDS, Option, one_of
from cli.runner import run


def foreign_words(values):
    """The words of ip/new_foreign.py."""
    given = {name: getattr(values, name.lower()) for name in ("CLOCK", "LIBRARY", "ADDRESS")}
    return [values.name, values.top, values.bus, f"{values.repository or 'ip'}/{values.name}",
            *(f"{name}={value}" for name, value in given.items() if value),
            *(f"PARAM:{each}" for each in values.params),
            *(f"DEFINE:{each}" for each in values.defines), *values.ports, *values.files]


@command("core foreign", [
    NAME,
    Option("top", TEXT, "its module", ""),
    Option("bus", TEXT, "wishbone, axil, apb, memory, own or axis", ""),
    Option("files", FILES, "its files, of Verilog or VHDL"),
    Option("ports", WORDS, "what its ports are, such as write=we ack=done"),
    Option("params", WORDS, "its parameters, such as depth=16"),
    Option("defines", WORDS, "its macros, such as wide"),
    Option("clock", COUNT, "Hz of a clock of its own"),
    Option("library", TEXT, "library of its VHDL", ""),
    Option("address", one_of("words", "bytes"),
           "what its address counts; found out, unless given"), REPOSITORY, BUILD, JOBS
], make="new-foreign", brief=(
    "core foreign brief_foreign --top req_words --bus own --files tests/ip/new_foreign/cores.v "
    "--ports select=req write=wr address=where wdata=value rdata=held ack=gnt",
    "core remove brief_foreign --force"), examples=[
        "core foreign my_uart --top wbuart --bus wishbone --files wbuart.v ufifo.v"])
def foreign_core(values):
    """put a third-party core into a slot: writes ip/NAME; its files in a repository of yours are
    found from there"""
    build = BuildFolder(values.build, values).prepare()
    if any(file.lower().endswith((".vhd", ".vhdl")) for file in values.files):
        build.ninja("ghdl")
    status = run(["ip/new_foreign.py", *foreign_words(values)], check=False, env={
        "GHDL": build / "ghdl/ghdl"})
    return status or (put_into_repository(values.repository, values.name) if values.repository
                      else 0)


# Words of new_foreign.py for each third-party core: slot, module, bus, files, and more.
EXAMPLES = [("foreign_spi", "neorv32_spi", "own", "neorv32/*.vhd", "LIBRARY=neorv32",
             "PARAM:IO_SPI_FIFO=4", *"""strobe=bus_req_i_stb write=bus_req_i_rw
             address=bus_req_i_addr enables=bus_req_i_ben wdata=bus_req_i_data rdata=bus_rsp_o_data
             ack=bus_rsp_o_ack error=bus_rsp_o_err high=clkgen_i low=bus_req_i_meta
             low=bus_req_i_amo low=bus_req_i_amoop low=bus_req_i_burst
             low=bus_req_i_lock""".split()),
            ("foreign_aes", "aes", "memory", "aes/*.v"),
            ("foreign_uart", "wbuart", "wishbone", "wbuart32/*.v", "CLOCK=24000000"),
            ("foreign_axil", "axiluart", "axil", "wbuart32/*.v"),
            ("foreign_i2c", "i2c_master_top", "wishbone", "i2c/*.v"),
            ("foreign_cobs", "axis_cobs_encode", "axis", "verilog-axis/*.v")]


@command("core examples", [
    Option("chip", SWITCH, "and what each costs in the chip"), SEED,
    *(o for o in FIELDS if o.name == "image"), BUILD, JOBS], make="foreign", brief="core examples",
         long="core examples --chip")
def examples(values):
    """put third-party cores and two of one's own through the recipe, in three orders, test them and
    call them by radio

    Wishbone, AXI4-Lite, AXI-Stream and plain buses in Verilog, records in VHDL. Downloads them;
    without a network only this project's two are tested, and the status says so: 77."""
    if not values.built:
        run(["cmake/setup.sh", "--tests"])
    cores = Path("build/foreign-cores").absolute()
    missing = fetch("foreign", cores, check=False)
    if not missing:
        fetch("ghdl", cores / "ghdl")
    shutil.rmtree(cores / "slots", ignore_errors=True)

    def into_slot(slot, module, bus, files, *words):
        run(["ip/new_foreign.py", slot, module, bus, cores / "slots" / slot, *words,
             *sorted(cores.glob(files))], stdout=-3, env={"GHDL": cores / "ghdl/ghdl"})
        return cores / "slots" / slot

    slots = [] if missing else ["examples/foreign/olo_spi",
                                *(into_slot(*each) for each in EXAMPLES)]
    return run(["examples/foreign/orders.sh", "tests/e2e/cores/servo", "tests/e2e/cores/crc32",
                *slots], check=False, env={
                    "IMAGE": values.image, "JOBS": values.jobs, "SEED": values.seed,
                    "CHIP": "1" if values.chip else ""}) or missing
