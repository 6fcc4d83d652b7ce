# SPDX-License-Identifier: MIT
"""reference: writes the generated pages of the site's reference section.

The functions that write pages take the tree and `pages`, the folder of the pages for Sphinx.
"""
import re
from pathlib import Path

from icesoc.regs.generate import markdown
from icesoc.regs.model import Block
from icesoc.site import hdl, symbol
from icesoc.synth.baseline import read_baseline

# Folders with reusable RTL, and their titles.
ROOMS = {"bus": "Register bus", "hdl/cdc": "Clock-domain crossings", "hdl/ddr": "Memory ports",
         "hdl/fsmc": "FSMC bridge", "hdl/modem": "Modem controller", "hdl/system": "Platform",
         "hdl/bringup": "Tester of a new board", "hdl": "Chip"}
# Files that contain properties or models instead of hardware.
NOT_HARDWARE = re.compile(r"(_proof|_rules|cdc_skew|idle_proof)$")
# Headers of the C API, grouped by the component to which they belong.
HEADERS = {
    "icec": ("IceC: Ice in C90", ["icec.h", "ice_stream.h", "ice_value.h", "ice_port.h",
                                  "ice_config.h", "tcp_endpoint.h", "xbee_endpoint.h"]),
    "link": ("Link layer", ["link.h", "link_port.h", "link_config.h"]),
    "fsmc": ("FSMC driver", ["fsmc.h"]),
    "radio": ("Radio driver", ["radio.h"]),
    "os": ("Kernel API", ["ucos_ii.h"]),
    "board": ("Board support", ["board.h", "flash.h"]),
}


def table(head, rows):
    """Returns a Markdown table. A vertical bar in a cell is escaped."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    for row in rows:
        lines.append("| " + " | ".join(str(cell).replace("|", "\\|") for cell in row) + " |")
    return "\n".join(lines) + "\n"


def code(text):
    """Returns the text as inline code, or nothing for an empty one."""
    return f"`{text}`" if text else ""


def write(path, text):
    """Writes a page, and the folders that it needs."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def paragraphs(comment):
    """Returns the comment of a file as Markdown; indented parts and tables become code blocks."""
    parts = []
    for part in re.split(r"\n\s*\n", comment):
        lines = part.splitlines()
        if any(line.startswith("  ") for line in lines):
            parts.append("```text\n" + part + "\n```")
        elif part.strip():
            parts.append(part)
    return "\n\n".join(parts)


def constraint_lines(entity, tree):
    """Returns the lines of the chip's constraint file that contain a pin of the entity."""
    pins = [p.name for p in entity.ports if p.clock == "asynchronous" and "_async" not in p.name]
    found = []
    for line in (tree / "synth/ise/chip.ucf").read_text().splitlines():
        names = re.findall(r'"([\w<>*?]+)"', line)
        if not line.startswith("#") and any(
                n.rstrip("<>*?").replace("_io", "_i") and
                any(p.startswith(n.split("*")[0].split("<")[0].rstrip("?").replace("_io", "_"))
                    for p in pins) for n in names if len(n.split("*")[0]) > 4):
            found.append(line)
    return found


def entity_page(entity, tree, figures):
    """Returns the page of one module or entity."""
    where = entity.path.relative_to(tree)
    language = "VHDL" if entity.path.suffix == ".vhd" else "Verilog"
    summary = entity.summary[:1].upper() + entity.summary[1:]
    parts = [f"# {entity.name}\n", summary + "\n", f"{language}, `{where}`.\n",
             "```{raw} html\n" + symbol.draw(entity) + "```\n", paragraphs(entity.text) + "\n"]
    if entity.parameters:
        parts += ["## Parameters\n", table(
            ("parameter", "default", "meaning"),
            [(code(p.name), code(p.default), p.meaning) for p in entity.parameters])]
    if entity.ports:
        parts += ["## Ports\n", table(
            ("port", "direction", "width", "clock", "meaning"),
            [(code(p.name), p.direction, code(p.width) or "1",
              code(p.clock) if p.clock.endswith("_i") else p.clock,
              p.meaning or p.group) for p in entity.ports])]
    lines = constraint_lines(entity, tree)
    if lines:
        parts += ["## Constraints\n", "These lines of `synth/ise/chip.ucf` concern its pins:\n",
                  "```text\n" + "\n".join(lines) + "\n```\n"]
    own = figures.get("designs", {}).get(entity.name)
    if own:
        parts += ["## Resources\n",
                  f"Estimated for the XC6SLX16 with default parameters by `make synth "
                  f"DESIGN={entity.name}`; [how far estimates go](../../utilisation.md).\n",
                  table(("LUTs", "flip-flops", "slices", "block RAMs", "DSP blocks", "clock, MHz"),
                        [(own["lut"], own["ff"], own["slices"], own["ram"], own["dsp"],
                          own["mhz"] or "combinational")])]
    return "\n".join(parts)


def write_hdl(tree, pages):
    """Writes a page for each module of the platform, and for each folder a page with links to its
    modules."""
    figures = read_baseline(tree / "synth/baseline.json")
    names = []
    for room, title in ROOMS.items():
        entities = []
        for path in sorted([*(tree / room).glob("*.v"), *(tree / room).glob("*.vhd")]):
            entity = None if NOT_HARDWARE.search(path.stem) else hdl.read(path, tree)
            if entity:
                entities.append(entity)
                write(pages / "reference/hdl" / f"{entity.name}.md",
                      entity_page(entity, tree, figures))
        if not entities:
            continue
        name = f"reference/hdl/room-{room.replace('/', '-')}"
        links = [(f"[{e.name}]({e.name}.md)", e.summary) for e in entities]
        write(pages / f"{name}.md", f"# {title}\n\n" + table(("module", "purpose"), links) +
              "\n```{toctree}\n:hidden:\n" + "\n".join(e.name for e in entities) + "\n```\n")
        names.append(name)
    write_index(pages, "hdl", "HDL modules", "Each page has a module's purpose, drawing, "
                "parameters, ports with their clocks, constraints and estimated resources, "
                "generated from its source.", names)


def write_index(pages, folder, title, text, names):
    """Writes the page that lists the pages of a reference folder."""
    write(pages / f"reference/{folder}/index.md", f"# {title}\n\n{text}\n\n```{{toctree}}\n" +
          "\n".join(Path(name).name for name in names) + "\n```\n")


def write_registers(tree, pages):
    """Writes a page for each register description in the tree."""
    names = []
    for path in sorted([*tree.glob("hdl/**/*.regs.json"), *tree.glob("ip/*/*.regs.json"),
                        *tree.glob("bus/*.regs.json")]):
        block = Block.read(path)
        write(pages / "reference/registers" / f"{block.name}.md",
              markdown(block) + f"\nFrom `{path.relative_to(tree)}`.\n")
        names.append(block.name)
    write_index(pages, "registers", "Register maps", "Words are 32 bits wide. Cores with a Slice "
                "interface get their registers at build time; those pages are in "
                "`build/main/gen`.", names)


def write_c(tree, pages):
    """Writes a page for each component of the C API; Breathe fills it in from Doxygen's output."""
    there = {path.name for path in (tree / "sw").rglob("*.h")}
    names = []
    for name, (title, headers) in HEADERS.items():
        parts = [f"# {title}\n"]
        for header in headers:
            if header in there:
                parts.append(f"## {header}\n\n```{{eval-rst}}\n.. doxygenfile:: {header}\n"
                             "   :sections: briefdescription detaileddescription innerclass define "
                             "enum typedef func\n```\n")
        write(pages / f"reference/c/{name}.md", "\n".join(parts))
        names.append(name)
    write_index(pages, "c", "C API", "Generated from the headers in `sw/`. All of it is C90, and "
                "nothing allocates memory.", names)


def write_cores(tree, pages):
    """Writes the list of the cores' pages; the pages themselves are the README files in ip/."""
    names = [path.parent.name for path in sorted(tree.glob("ip/*/README.md"))]
    write_index(pages, "cores", "IP cores", "The cores in `ip/`, from their README files.", names)


def write_commands(pages, helps):
    """Writes the pages of the command line. `helps` maps the words of each command to its --help
    text."""
    parts = ["# Command line\n", "`./icesoc COMMAND --help` prints the same.\n"]
    for words, text in helps.items():
        parts.append(f"## icesoc {words}\n\n```text\n{text.strip()}\n```\n")
    write(pages / "reference/commands.md", "\n".join(parts))


