# SPDX-License-Identifier: MIT
"""synth: utilisation of the chip."""
from cli.build_folder import configured
from cli.command import DEFAULTS, GROUPS, command
from cli.options import BUILD, JOBS, TEXT, WORDS, Option
from cli.runner import run

GROUPS["synth"] = "utilisation of the chip"
DEFAULTS["synth"] = "synth report"
DESIGN = Option("design", WORDS,
                "these designs only, such as modem, table1 or soc; of the others what is known")


def with_name(option, names):
    return [word for name in names for word in (option, name)]


def utilisation(build, values, *words):
    return run(
        [build / "synth/utilisation", "--generated", build / "gen", "--jobs", values.jobs, *words],
        check=False)


@command("synth report", [
    DESIGN, Option("family", WORDS, "these chips, too, such as xc7 or ecp5"), BUILD, JOBS],
         make="synth", brief="synth report --design npi_arbiter", long="synth report", examples=[
             "synth report --design modem", "synth report --family xc7 ecp5"])
def synth(values):
    """LUTs, flip-flops, slices of the chip and each part, against limits and paper"""
    build = configured(values, "synth_inputs", tests=True)
    return utilisation(build, values, *with_name("--design", values.design),
                       *with_name("--family", values.family))


@command("synth accept", [DESIGN, BUILD, JOBS], make="synth-accept", examples=[
    "synth accept --design modem"], brief="synth accept --design npi_arbiter")
def accept(values):
    """record today's utilisation as what is wanted (synth/baseline.json)"""
    return utilisation(configured(values, "synth_inputs"), values, "--accept",
                       *with_name("--design", values.design))


@command("synth edif", [Option("design", TEXT, "the design", "soc"), BUILD, JOBS],
         make="synth-edif", brief="synth edif --design npi_arbiter")
def edif(values):
    """the chip as EDIF for Xilinx ISE, in build/synth/ise"""
    build = configured(values, "synth_inputs")
    return run([build / "synth/utilisation", "--generated", build / "gen", "--edif", values.design],
               check=False)
