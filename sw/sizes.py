#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""sizes: measures the bytes of the firmware's layers, from linker maps and object files.

    sizes.py layers SOURCE GENERATED BUILD OUT.json   each layer on a Cortex-M3 at -Os, compared
    with
                                                      the paper's Table II; RAM and largest frames;
                                                      fails if one exceeds tests/limits.toml
    sizes.py firmware MAP OUT.json                    flash and RAM of a firmware by layer; its
                                                      stacks, by the call graph

layers: `minimal` is the number of bytes of a layer in the image of the program sw/minimal, which
has the minimal run time and link. It counts text and read-only data; as in the paper, it does not
count the C library and generated code. `full` counts all files of the layer, including code that is
not linked.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib

# bytes of the layers in the paper's Table II; 0 for two layers that only this project has
PAPER = {"fsmc": 1116, "radio": 1795, "crypto": 0, "link": 1307, "icec": 2622, "endpoint": 0}
# sources of those layers that are not all files of one folder
FILES = {"icec": ["icec/*.c", "icec/values/*.c", "icec/extra/*.c"],
         "endpoint": ["icec/endpoints/xbee_endpoint.c", "icec/endpoints/xbee_peers.c"]}
LAYER_FOLDERS = ("fsmc", "radio", "crypto", "link", "icec", "values", "extra", "endpoints")
PACKAGES = ("update", "fleet", "keys")
TITLES = {"values": "icec", "extra": "icec", "vehicle": "application", "loader": "update",
          "Autopilot": "generated stubs", "endpoints": "icec, xbee-at endpoint", "m3": "os",
          "GNU": "uC/OS-II", "Source": "uC/OS-II", "ARMv7-M": "uC/OS-II"}
ENTRIES = ("UAV_radioTask", "appMainTask", "clientTask", "watchTask", "idleTask", "EXTI0_Handler",
           "SysTick_Handler")


def sections(path, dropped=False):
    """Returns (section, address, bytes, file) for each part of the image in a linker map; with
    `dropped`, for each part that the linker has removed (--gc-sections)."""
    head, _, text = open(path).read().partition("Linker script and memory map")
    if dropped:
        text = head.partition("Discarded input sections")[2]
    # after a long section name, the linker begins a new line
    text = re.sub(r"^( \.?[A-Za-z_]\S*)\n +(?=0x)", r"\1 ", text, flags=re.M)
    for name, address, size, file in re.findall(r"^ (\.?[A-Za-z_]\S*) +0x(\w+) +0x(\w+) (\S.*)$",
                                                text, re.M):
        yield name, int(address, 16), int(size, 16), file


def written(path, entries):
    os.makedirs(os.path.dirname(os.path.abspath(path)), exist_ok=True)
    with open(path, "w") as file:
        file.write("[" + ",\n ".join(map(json.dumps, entries)) + "]\n")
    print(f"Written: {path}")


def linked(image, layer, wanted):
    return sum(size for name, _, size, file in image if f"/minimal_{layer}.arm/" in file
               and re.match(wanted, name))


def whole(patterns, source, generated):
    """Returns (text and read-only data, RAM) of all contents of the files that match these
    patterns."""
    includes = [generated, f"{generated}/slice/Autopilot"] + [f"{source}/sw/{d}" for d in (
        "base", "os", "os/host", "fsmc", "radio", "crypto", "link", "icec", "icec/endpoints")]
    with tempfile.TemporaryDirectory() as work:
        paths = [str(p) for files in patterns for p in pathlib.Path(source, "sw").glob(files)]
        subprocess.run(["arm-none-eabi-gcc", "-std=c90", "-mcpu=cortex-m3", "-mthumb", "-Os",
                        "-ffunction-sections", "-fdata-sections", "-fno-merge-constants",
                        *(f"-I{i}" for i in includes), "-c", *paths], cwd=work, check=True)
        table = subprocess.run(["arm-none-eabi-size", *os.listdir(work)], cwd=work, check=True,
                               capture_output=True, text=True).stdout
    rows = [line.split() for line in table.splitlines()[1:]]
    return sum(int(row[0]) for row in rows), sum(int(row[1]) + int(row[2]) for row in rows)


def deepest(build, layer):
    """Returns (bytes, function) for the largest stack frame of a layer in the minimal program."""
    lines = [line.split("\t")
             for su in pathlib.Path(build, "sw/minimal").glob(f"minimal_{layer}.arm/**/*.su")
             for line in open(su)]
    return max(((int(size), where.split(":")[3]) for where, size, *_ in lines), default=(0, ""))


def excess(entries, source):
    """Yields a sentence for each size that exceeds its limit in tests/limits.toml."""
    budget = tomllib.loads(pathlib.Path(source, "tests/limits.toml").read_text())["bytes"]
    for name, size in ((entry["name"], entry["value"]) for entry in entries):
        if name not in budget:
            yield f'size: tests/limits.toml has no "{name}" (it is {size})'
        elif size > budget[name]:
            yield (f"size: {name} has grown to {size} bytes, its budget is {budget[name]} "
                   "(tests/limits.toml)")


def layers(source, generated, build, output):
    source, generated = os.path.abspath(source), os.path.abspath(generated)
    image, entries = list(sections(f"{build}/firmware/minimal.map")), []
    unused = list(sections(f"{build}/firmware/minimal.map", dropped=True))

    def entry(name, size, limit=0):
        entries.append({"name": name, "value": size, "unit": "bytes",
                        **({"limit": limit} if limit else {}), "command": "./icesoc build size"})

    print("%-10s %8s %8s %8s %8s %9s %s" % ("layer", "minimal", "paper's", "full", "RAM min",
                                            "RAM full", "largest frame (minimal)"))
    small_all = large_all = unused_all = 0
    for layer, paper in PAPER.items():
        small, ram = (linked(image, layer, wanted)
                      for wanted in (r"\.(text|rodata)", r"\.(data|bss)|COMMON"))
        large, large_ram = whole(FILES.get(layer, [f"{layer}/*.c"]), source, generated)
        print("%-10s %8d %8s %8d %8d %9d %d %s" % (layer, small, paper or "-", large, ram,
                                                   large_ram, *deepest(build, layer)))
        entry(f"minimal.{layer}", small, paper)
        entry(f"full.{layer}", large)
        small_all, large_all = small_all + small, large_all + large
        unused_all += linked(unused, layer, r"\.(text|rodata)")
    over = list(excess(entries, source))
    print("%-10s %8d %8d %8d" % ("all", small_all, sum(PAPER.values()), large_all))
    entry("minimal.all", small_all, sum(PAPER.values()))
    entry("minimal.all without --gc-sections", small_all + unused_all)
    print(f"minimal without --gc-sections: {small_all + unused_all} bytes (the paper does not "
          "state how it counted)")
    print("RAM of the minimal program with all objects: "
          f"{linked(image, 'app', r'[.](data|bss)|COMMON')} bytes, of generated code and servants: "
          f"{linked(image, 'app', r'[.](text|rodata)')} bytes of text")
    added = packages(build)
    entries += added
    over += excess(added, source)
    written(output, entries)
    if over:
        sys.exit("\n".join(over))


def parts(path):
    """Yields (flash, RAM, kind of section, folder) for each part of a linked firmware. The folder
    is empty for parts of the C library."""
    for name, address, size, file in sections(path):
        kind = re.match(r"\.(text|rodata|data|bss|vectors|noinit)", name)
        if kind and address and size:
            folder = os.path.basename(os.path.dirname(file)) if ".arm/" in file else ""
            yield (size if kind[1] not in ("bss", "noinit") else 0,
                   size if kind[1] in ("bss", "noinit", "data") else 0, kind[1], folder)


def image_bytes(build, name):
    """Returns (flash, RAM, layers) of a linked firmware, in bytes. `layers` is the flash used by
    the layers of the paper (PAPER)."""
    found = list(parts(f"{build}/firmware/{name}.map"))
    return (sum(flash for flash, _, _, _ in found), sum(ram for _, ram, _, _ in found),
            sum(flash for flash, _, kind, folder in found
                if folder in LAYER_FOLDERS and kind in ("text", "rodata")))


def packages(build):
    """Prints flash and RAM of the vehicle's firmware by package: the core without packages, what
    each package adds to the whole firmware, and the whole firmware. Returns the entries of the
    report."""
    whole_image = image_bytes(build, "uav")
    rows = [("core", image_bytes(build, "uav_core"))]
    rows += [(name, tuple(a - b for a, b in zip(whole_image, image_bytes(build,
                                                                          f"uav_without_{name}"))))
             for name in PACKAGES]
    rows.append(("vehicle", whole_image))
    print("\n%-10s %8s %8s %8s" % ("package", "flash", "RAM", "layers"))
    for name, sizes in rows:
        print("%-10s %8d %8d %8d" % (name, *sizes))
    print("A package: bytes saved by leaving it out of the vehicle (two may share code). layers: "
          "flash of the layers above, as\nlinked; the rest is the application, servants, "
          "generated code, kernel, board and C library.")
    return [{"name": f"vehicle.{name}.{what}", "value": size, "unit": "bytes",
             "command": "./icesoc build size"} for name, sizes in rows
            for what, size in zip(("flash", "ram", "layers"), sizes)]


def firmware(path, output):
    flash, ram = {}, {}
    for in_flash, in_ram, _, folder in parts(path):
        layer = TITLES.get(folder, folder) or "C library"
        flash[layer] = flash.get(layer, 0) + in_flash
        ram[layer] = ram.get(layer, 0) + in_ram
    print("%-26s %8s %8s" % ("layer", "flash", "RAM"))
    for layer in flash:
        print("%-26s %8d %8d" % (layer, flash[layer], ram[layer]))
    print("%-26s %8d %8d   bytes, stacks of tasks included in RAM\n" %
          ("all", sum(flash.values()), sum(ram.values())))
    stacks(path)
    written(output, [{"name": f"{what}: {layer}", "value": table[layer], "unit": "bytes",
                      "command": "./icesoc build firmware"}
                     for layer in flash for what, table in (("flash", flash), ("RAM", ram))])


def stacks(path):
    """Prints the deepest stack of each task. It adds stack frames (-fstack-usage) along the call
    graph (-fcallgraph-info) of the objects in the linker map."""
    objects = sorted(set(re.findall(r"^LOAD (\S+)\.o$", open(path).read(), re.M)))
    graphs = [pathlib.Path(f"{name}.ci") for name in objects]
    text = "".join(graph.read_text() for graph in graphs if graph.is_file())
    name = r'"(?:[^"]*:)?([^":]*)"'
    frames = {f: int(size) for f, size in re.findall(r"^node: .*?title: " + name +
                                                     r".*?(\d+) bytes", text, re.M)}
    calls = {}
    for caller, called in re.findall(r"^edge: .*?sourcename: " + name + " targetname: " + name,
                                     text, re.M):
        calls.setdefault(caller, {})[called] = True
    known = {}

    def depth(function):
        """Returns (bytes, call path) of the deepest stack below a function; a recursive call is
        counted once."""
        if function not in known:
            known[function] = (0, [])
            below, way = max((depth(called) for called in calls.get(function, ())
                              if called != "__indirect_call"),
                             key=lambda found: found[0], default=(0, []))
            known[function] = (frames.get(function, 0) + below, [function] + way * bool(below))
        return known[function]

    print("%-26s %8s   %s" % ("stack, by analysis", "bytes",
                              "deepest way (calls through pointers and of the C library are not "
                              "followed)"))
    for entry in ENTRIES:
        size, way = depth(entry)
        print("%-26s %8d   %s" % (entry, size, " > ".join(way[1:])))


commands = {"layers": (layers, 4), "firmware": (firmware, 2)}
command, *words = sys.argv[1:] or [""]
if command not in commands or len(words) != commands[command][1]:
    sys.exit(__doc__)
commands[command][0](*words)
