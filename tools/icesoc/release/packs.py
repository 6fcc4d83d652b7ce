# SPDX-License-Identifier: MIT
"""packs: packages IceC for package managers for firmware.

Each package contains every component of IceC as one merged C file and one header (single_file.py),
because the layered sources have headers with common names such as link.h. `library` returns the
files of one folder that is a PlatformIO library and a Zephyr module; `cmsis` returns the files of a
CMSIS-Pack.
"""
import json
import re
import textwrap
import xml.etree.ElementTree as ET

from icesoc import TREE
from icesoc.release import components, single_file

CONFIG = "sw/icec/ice_config.h"
SCHEMA = "1.7.7"  # oldest version of PACK.xsd with all elements that are used here
VENDOR, PACK = "IceSoC", "IceC"
DESCRIPTION = ("Serve and call ZeroC Ice objects from C90 firmware, without memory allocation, over"
               " TCP, a packet radio or a serial line.")
KEYWORDS = ["ice", "zeroc", "rpc", "radio", "xbee"]
README = """# IceC {version}

{description}

| file | purpose |
|---|---|
{rows}

Compile the C files that you need with your program, as C90 or later, with `src` as include path.
Set limits such as `-DICE_MESSAGE_MAX=1024` for all files of the program; `src/icec.h` lists them.
`slice2c` of IceSoC generates the code of your interfaces. The porting guide of IceSoC,
`docs/porting.md`, describes the functions that a new board or kernel has to supply.
"""


def limits(tree=TREE):
    """Returns the limits of IceC that a program may choose, in the order of ice_config.h: (name,
    default value, help)."""
    text = (tree / CONFIG).read_text(encoding="utf-8")
    found = re.findall(r"/\*((?:(?!\*/).)*)\*/\n#ifndef (\w+)\n#define \2 (\w+)\n#endif", text,
                       re.S)
    return [(name, value, " ".join(re.sub(r"\n \*", " ", text).split()))
            for text, name, value in found]


def targets():
    """Returns the components that do not need a POSIX system."""
    return [its for its in components.COMPONENTS.values() if not its.host]


def kconfig(tree=TREE):
    """Returns Zephyr's Kconfig file: an option for each component and each limit."""
    lines = ["# SPDX-License-Identifier: MIT", "", "menu \"IceC\"", ""]
    for its in targets():
        lines += [f"config {its.name.upper()}", f"\tbool \"{its.title}\""]
        lines += [f"\tselect {other.upper()}" for other in its.needs] + [""]
    lines += ["if ICEC", ""]
    for name, value, text in limits(tree):
        default = value if value.isdigit() else f"ICEC_{value.removeprefix('ICE_')}"
        lines += [f"config ICEC_{name.removeprefix('ICE_')}", f"\tint \"{name}\"",
                  f"\tdefault {default}", "\thelp"]
        lines += ["\t  " + line for line in textwrap.wrap(text, 90)] + [""]
    return "\n".join([*lines, "endif", "", "endmenu", ""])


def zephyr_cmake(tree=TREE):
    """Returns the CMakeLists.txt of the Zephyr module."""
    switches = [its.name.upper() for its in targets()]
    lines = ["# SPDX-License-Identifier: MIT", "",
             f"if({' OR '.join('CONFIG_' + name for name in switches)})",
             "  zephyr_library_named(icec)",
             "  zephyr_include_directories(${CMAKE_CURRENT_LIST_DIR}/../src)"]
    for its in targets():
        lines += [f"  zephyr_library_sources_ifdef(CONFIG_{its.name.upper()}",
                  f"    ${{CMAKE_CURRENT_LIST_DIR}}/../src/{its.name}.c)"]
    lines += ["endif()", "", "# The program has to see the same limits as the library.",
              "if(CONFIG_ICEC)"]
    for name, _, _ in limits(tree):
        option = "CONFIG_ICEC_" + name.removeprefix("ICE_")
        lines.append(f"  zephyr_compile_definitions({name}=${{{option}}})")
    return "\n".join([*lines, "endif()", ""])


def sources(version, tree=TREE):
    """Returns the files that are the same in all packages: the merged files of the components,
    README and licence."""
    files = {f"src/{name}": text for name, text in single_file.files(None, tree, version).items()}
    rows = "\n".join(f"| `src/{its.name}.c`, `src/{its.name}.h` | {its.title}"
                     + (f"; needs {', '.join(its.needs)}" if its.needs else "") + " |"
                     for its in components.COMPONENTS.values())
    files["README.md"] = README.format(version=version, description=DESCRIPTION, rows=rows)
    files["LICENSE"] = (tree / "LICENSE").read_text(encoding="utf-8")
    return files


def library(version, tree=TREE):
    """Returns the files of the folder for PlatformIO and Zephyr, name to text."""
    hosted = [f"-<{its.name}.c>" for its in components.COMPONENTS.values() if its.host]
    manifest = {
        "name": PACK, "version": version, "description": DESCRIPTION, "keywords": KEYWORDS,
        "license": "MIT", "frameworks": "*", "platforms": "*",
        "headers": [f"{its.name}.h" for its in components.COMPONENTS.values()],
        "build": {"srcDir": "src", "includeDir": "src", "srcFilter": ["+<*.c>", *hosted]}}
    return sources(version, tree) | {
        "library.json": json.dumps(manifest, indent=2) + "\n",
        "zephyr/module.yml": "# SPDX-License-Identifier: MIT\nname: icec\nbuild:\n"
                             "  cmake: zephyr\n  kconfig: zephyr/Kconfig\n",
        "zephyr/CMakeLists.txt": zephyr_cmake(tree),
        "zephyr/Kconfig": kconfig(tree)}


def pdsc(version, date, changes, tree=TREE):
    """Returns the description of the CMSIS-Pack. `date` is the date of the release, such as
    2026-11-28; `changes` is the changelog's section about this release."""
    package = ET.Element("package", {
        "schemaVersion": SCHEMA, "xmlns:xs": "http://www.w3.org/2001/XMLSchema-instance",
        "xs:noNamespaceSchemaLocation": "PACK.xsd"})

    def add(parent, name, text=None, /, **attributes):
        made = ET.SubElement(parent, name, attributes)
        made.text = text
        return made

    for name, text in (("vendor", VENDOR), ("name", PACK), ("description", DESCRIPTION),
                       ("url", ""), ("license", "LICENSE")):
        add(package, name, text)
    add(add(package, "releases"), "release", changes, version=version, date=date)
    words = add(package, "keywords")
    for word in KEYWORDS:
        add(words, "keyword", word)
    known = {its.name: its for its in targets()}
    conditions = add(package, "conditions")
    for its in known.values():
        if its.needs:
            condition = add(conditions, "condition", id=f"needs of {its.name}")
            add(condition, "description", f"{its.title}: {', '.join(its.needs)}")
            for other in its.needs:
                add(condition, "require", Cclass="IceC", Cgroup=other)
    made, plain = add(package, "components"), version.partition("+")[0]
    for its in known.values():
        needs = {"condition": f"needs of {its.name}"} if its.needs else {}
        component = add(made, "component", Cclass="IceC", Cgroup=its.name, Cversion=plain,
                        **needs)
        add(component, "description", its.title)
        files = add(component, "files")
        add(files, "file", category="doc", name="README.md")
        for header in [f"{its.name}.h", *its.forwards]:
            add(files, "file", category="header", name=f"src/{header}")
        add(files, "file", category="sourceC", name=f"src/{its.name}.c")
    ET.indent(package)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(package, "unicode") + "\n"


def cmsis(version, date, changes, tree=TREE):
    """Returns the files of the CMSIS-Pack, name to text."""
    hosted = tuple(f"src/{its.name}." for its in components.COMPONENTS.values() if its.host)
    files = {name: text for name, text in sources(version, tree).items()
             if not name.startswith(hosted)}
    return files | {f"{VENDOR}.{PACK}.pdsc": pdsc(version, date, changes, tree)}
