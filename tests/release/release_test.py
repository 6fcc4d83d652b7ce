#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""release_test: tests IceC's single files and packs, the porting examples, and the files of a
release.

Usage: release_test.py CASE WORK-FOLDER BUILD-FOLDER
"""
import hashlib
import json
import os
import re
import runpy
import select
import shutil
import subprocess
import sys
import tarfile
import time
import xml.etree.ElementTree as ET
import zipfile
from pathlib import Path
from types import SimpleNamespace

from icesoc.chip import contract_diff
from icesoc.regs.model import Block
from icesoc.release import components, packs, sbom, single_file, version
from script import TREE, Script, commit, fresh, git, main, repository, write

WORK, BUILD = map(Path, sys.argv[2:4])
CONTRACTS = Path(__file__).parent / "contracts"
EXAMPLE = TREE / "examples/porting"
STRICT = "-std=c90 -pedantic -Wall -Wextra -Wconversion -Werror".split()
ARM = "arm-none-eabi-gcc -mcpu=cortex-m3 -mthumb -Os".split()
GENERATED = ["Meter_types.c", "Meter_server.c", "Station_types.c", "Station_client.c"]
PROGRAM = ["icec.c", "icec_link.c", "icec_radio.c", EXAMPLE / "meter.c", EXAMPLE / "mps2.c"]
# Layers of the build, each with the component that has the same files.
LAYERS = {"icec": "icec", "icec_tcp": "icec_tcp", "link_layer": "icec_link", "crypto": "icec_link",
          "icec_xbee": "icec_radio", "fsmc": "icec_fsmc"}
SMALL = "# Changelog\n\n## Unreleased\n{}\n## 1.2.3\n\n- second\n\n## 1.2.2\n\n- first\n"


def write_all(files, folder="."):
    for name, text in files.items():
        write(Path(folder, name), text)


def symbols(file):
    """Returns the names of the functions and data that an object file defines."""
    said = subprocess.check_output(["nm", file], text=True)
    return [re.sub(r"\.\d+$", "", name)
            for name in re.findall(r"^\w+ [tTdDbBrR] (\S+)$", said, re.M)]


def undocumented(value):
    """Returns a description without its texts."""
    if isinstance(value, list):
        return [undocumented(each) for each in value]
    if isinstance(value, dict):
        return {name: "-" if name == "doc" else undocumented(each) for name, each in value.items()}
    return value


class Cases(Script):
    def test_components(self):
        """Each layer of the build must have the same files as its component."""
        known, found = components.COMPONENTS, {}
        for line in (BUILD / "tests/release/layers.txt").read_text().splitlines():
            layer, *files = line.split()
            paths = {os.path.relpath(file, TREE) if os.path.isabs(file) else f"sw/icec/{file}"
                     for file in files}
            found.setdefault(LAYERS[layer], set()).update(paths)
        self.assertEqual(found, {name: set(its.files()) for name, its in known.items()})

    def examples(self):
        """Writes the single files, and the generated code of the examples, to the current
        folder."""
        write_all(single_file.files())
        for name in "Meter", "Station":
            self.ask(BUILD / "slice/slice2c", EXAMPLE / f"{name}.ice", "--output-dir", ".")

    def test_single_file(self):
        """The single files compile without warnings with three compilers, and contain every
        function of the sources. A program that is built from them can answer stock Ice over TCP."""
        fresh(WORK)
        self.examples()
        known = components.COMPONENTS
        for compiler in ["clang"], ARM:
            for its in known.values():
                if compiler is not ARM or not its.host:
                    self.ask(*compiler, *STRICT, "-fsyntax-only", f"{its.name}.c")
        self.ask("g++", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", "-x", "c++",
                 *(f"{name}.h" for name in known))
        folders = [f"-I{TREE / folder}" for its in known.values() for folder in its.folders]
        for its in known.values():
            os.mkdir(its.name)
            self.ask("gcc", "-c", *folders, f"-I{TREE}/sw/base", f"-I{BUILD}/gen",
                     *[TREE / path for path in its.files()], cwd=its.name)
            self.ask("gcc", *STRICT, "-O2", "-c", f"{its.name}.c", "-o", "optimized.o")
            self.ask("gcc", "-c", f"{its.name}.c")
            parts = [(path.stem, name) for path in Path(its.name).glob("*.o")
                     for name in symbols(path)]
            joined = symbols(f"{its.name}.o")
            self.assertEqual(len(parts), len(joined), its.name)
            for stem, name in parts:
                self.assertTrue({name, f"{stem}_{name}"} & set(joined), f"{stem}: {name}")
        self.ask("gcc", *STRICT, "-D_POSIX_C_SOURCE=200809L", "-I.", f"-I{EXAMPLE}", "icec.c",
                 "icec_tcp.c", EXAMPLE / "meter.c", EXAMPLE / "host.c", *GENERATED, "-lpthread",
                 "-o", "host")
        with subprocess.Popen(["./host"], stdout=subprocess.PIPE, text=True) as host:
            try:
                port = host.stdout.readline().strip()
                self.ask("/usr/bin/python3", EXAMPLE / "call.py", "host",
                         f"tcp -h 127.0.0.1 -p {port}", timeout=60)
            finally:
                host.kill()

    def fly(self, elf, kernel):
        """Checks that stock Ice can call a program on QEMU's MPS2 board through the ground's
        plugin, and that the program can call back."""
        with subprocess.Popen(
                ["qemu-system-arm", "-M", "mps2-an385", "-kernel", elf, "-display", "none",
                 "-monitor", "none", "-serial", "pty"], stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as qemu:
            try:
                self.assertTrue(select.select([qemu.stdout], [], [], 20)[0], "QEMU is silent")
                said = qemu.stdout.readline()
                device = re.search(r"/dev/pts/\d+", said)
                self.assertTrue(device, f"QEMU did not name its serial port: {said}")
                self.ask("/usr/bin/python3", EXAMPLE / "call.py", kernel,
                         f"serial -d {device[0]} -a 0x0001", f"serial -d {device[0]} -s 0x0000",
                         f"--Ice.Plugin.XBeeAT={BUILD}/ground/xbeeat:createXBeeAT", timeout=120)
            finally:
                qemu.kill()

    def link(self, name, *objects):
        self.ask(*ARM, *STRICT, "-Wstrict-prototypes", "-I.", f"-I{EXAMPLE}", "-nostartfiles",
                 "--specs=nano.specs", "--specs=nosys.specs", "-T", EXAMPLE / "mps2.ld", *PROGRAM,
                 *objects, *GENERATED, "-o", name)

    def needs_qemu(self):
        if not shutil.which("qemu-system-arm"):
            self.skipTest("qemu-system-arm is missing: apt-get install qemu-system-arm")

    def fetched(self, thing):
        """Returns the folder that icesoc.util.fetch has downloaded. Without a network, the case is
        skipped."""
        done = subprocess.run([TREE / "tools/python", "-m", "icesoc.util.fetch", thing, thing],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode == 77:
            self.skipTest(f"{thing} cannot be fetched: {done.stdout.splitlines()[-2][-100:]}")
        self.assertEqual(done.returncode, 0, done.stdout)
        return Path(thing)

    def test_bare_metal(self):
        """The porting example without a kernel works on a Cortex-M3."""
        fresh(WORK)
        self.needs_qemu()
        self.examples()
        self.link("bare_metal.elf", EXAMPLE / "bare_metal.c")
        self.fly("bare_metal.elf", "bare metal")

    def test_freertos(self):
        """The porting example for FreeRTOS works on a Cortex-M3."""
        fresh(WORK)
        self.needs_qemu()
        kernel = self.fetched("freertos")
        self.examples()
        objects, port = [], "portable/GCC/ARM_CM3"
        folders = [word for folder in ("include", port) for word in ("-isystem", kernel / folder)]
        for path in "tasks.c", "queue.c", "list.c", f"{port}/port.c":
            objects.append(Path(path).with_suffix(".o").name)
            self.ask(*ARM, "-w", f"-I{EXAMPLE}", *folders, "-c", kernel / path, "-o", objects[-1])
        # The headers of the kernel require C99.
        self.ask(*ARM, *STRICT[2:], "-std=gnu99", "-I.", f"-I{EXAMPLE}", *folders, "-c",
                 EXAMPLE / "freertos.c")
        self.link("freertos.elf", "freertos.o", *objects)
        self.fly("freertos.elf", "FreeRTOS")

    def test_packs(self):
        """Each pack lists exactly the files that it contains, and these files compile."""
        fresh(WORK)
        write_all(packs.library("1.2.3"), "library")
        manifest = json.loads(Path("library/library.json").read_text())
        chosen = manifest["build"]["srcFilter"]
        self.assertEqual(chosen, ["+<*.c>", "-<icec_tcp.c>"])
        self.assertEqual(manifest["version"], "1.2.3")
        for header in manifest["headers"]:
            self.assertTrue(Path("library/src", header).is_file(), header)

        options = re.findall(r"^config (\w+)$", Path("library/zephyr/Kconfig").read_text(), re.M)
        used = set(re.findall(r"CONFIG_(\w+)", Path("library/zephyr/CMakeLists.txt").read_text()))
        self.assertEqual(used, set(options))
        # stubs for the functions of Zephyr that the module calls
        write("CMakeLists.txt", """cmake_minimum_required(VERSION 3.20)
project(zephyr C)
macro(zephyr_library_named name)
  add_library(${name} STATIC)
  set(library ${name})
endmacro()
function(zephyr_include_directories)
  target_include_directories(${library} PUBLIC ${ARGN})
endfunction()
function(zephyr_compile_definitions)
  target_compile_definitions(${library} PUBLIC ${ARGN})
endfunction()
function(zephyr_library_sources_ifdef option)
  if(${option})
    target_sources(${library} PRIVATE ${ARGN})
  endif()
endfunction()
include(options.cmake)
add_subdirectory(library/zephyr)
""")
        write("options.cmake", "".join(f"set(CONFIG_{name} {value})\n" for name, value in [
            *((name, 1) for name in options), *((f"ICEC_{name.removeprefix('ICE_')}", value)
                                                for name, value, _ in packs.limits())]).replace(
            " ICE_MESSAGE_MAX)", " 512)"))
        self.ask("cmake", "-G", "Ninja", "-B", "build", "-DCMAKE_BUILD_TYPE=MinSizeRel",
                 "-DCMAKE_C_COMPILER=arm-none-eabi-gcc", "-DCMAKE_SYSTEM_NAME=Generic",
                 "-DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY",
                 "-DCMAKE_C_FLAGS=-mcpu=cortex-m3 -mthumb -Wall -Werror")
        self.ask("ninja", "-C", "build")
        self.ask("arm-none-eabi-nm", "build/library/zephyr/libicec.a")
        self.has("T Ice_initialize", "T Link_init", "T XBeeATEndpoint_init", "T FSMC_init")

        files = packs.cmsis("1.2.3", "2026-11-28", "- a <b> & c")
        description = ET.fromstring(files["IceSoC.IceC.pdsc"])
        named = {its.get("name") for its in description.iter("file")}
        self.assertEqual(named | {"LICENSE", "IceSoC.IceC.pdsc"}, set(files))
        groups = {its.get("Cgroup") for its in description.iter("component")}
        conditions = {its.get("id") for its in description.iter("condition")}
        for its in description.iter("require"):
            self.assertIn(its.get("Cgroup"), groups)
        for its in description.iter("component"):
            self.assertIn(its.get("condition"), conditions | {None})

    def test_guide(self):
        """The code in the porting guide is identical to the code of the examples."""
        page = (TREE / "docs/porting.md").read_text()
        sources = "".join(path.read_text() for path in EXAMPLE.glob("*.c"))
        blocks = re.findall(r"^```c\n(.*?)^```", page, re.M | re.S)
        self.assertTrue(blocks)
        for block in blocks:
            self.assertIn(block, sources)

    def test_pack_schema(self):
        """ARM's schema accepts the description of the CMSIS-Pack."""
        fresh(WORK)
        schema = self.fetched("pack")
        for number in "1.2.3", "1.2.3+git.0123456789ab":
            write("a.pdsc", packs.pdsc(number, "2026-11-28", "- a <b> & c"))
            self.ask("xmllint", "--noout", "--schema", schema / "PACK.xsd", "a.pdsc")

    def test_platformio(self):
        """PlatformIO's parser and schema accept library.json and know each of its fields."""
        fresh(WORK)
        folder = self.fetched("platformio")
        sys.path.insert(0, str((folder / "python").absolute()))

        class Refused(Exception):
            """Exception that PlatformIO raises."""

        # replacements for the modules that these two modules of PlatformIO import
        for name, its in {
                "requests": {"exceptions": SimpleNamespace(RequestException=OSError)},
                "platformio": {"util": None}, "platformio.util": {
                    "memoized": lambda expire: lambda function: function},
                "platformio.compat": {"get_object_members": vars, "string_types": str},
                "platformio.http": {"fetch_remote_content":
                                    lambda url: '{"licenses": [{"licenseId": "MIT"}]}'},
                "platformio.package.exception": dict.fromkeys(
                    ["ManifestParserError", "ManifestValidationError", "UnknownManifestError"],
                    Refused),
                "platformio.project.helpers": {"is_platformio_project": bool}}.items():
            sys.modules[name] = SimpleNamespace(**its)
        parser = runpy.run_path(str(folder / "parser.py"))["LibraryJsonManifestParser"]
        schema = runpy.run_path(str(folder / "schema.py"))["ManifestSchema"]()
        for number in "1.2.3", "1.2.3+git.0123456789ab":
            text = packs.library(number)["library.json"]
            accepted = schema.load_manifest(parser(text).as_dict())
            # The value of `build` is for PlatformIO's builder, so the schema does not describe it.
            self.assertEqual({*accepted, "build"}, {*json.loads(text)})
        for wrong in {"version": "one"}, {"license": "Sauce"}, {"keywords": ["a,b!"]}:
            with self.assertRaises(Refused, msg=wrong):
                schema.load_manifest(parser(json.dumps(json.loads(text) | wrong)).as_dict())

    def test_zephyr(self):
        """Zephyr's schema accepts zephyr/module.yml, and the files that it names exist."""
        fresh(WORK)
        folder = self.fetched("zephyr")
        sys.path.insert(0, str((folder / "python").absolute()))
        import pykwalify.core
        import yaml
        schema = yaml.safe_load((folder / "module-schema.yml").read_text())
        files = packs.library("1.2.3")
        module = yaml.safe_load(files["zephyr/module.yml"])
        pykwalify.core.Core(source_data=module, schema_data=schema).validate()
        self.assertIn(f"{module['build']['cmake']}/CMakeLists.txt", files)
        self.assertIn(module["build"]["kconfig"], files)
        with self.assertRaises(pykwalify.errors.SchemaError):
            wrong = {"build": {"cmake": "zephyr", "sauce": "x"}}
            pykwalify.core.Core(source_data=wrong, schema_data=schema).validate()

    def test_sbom_schema(self):
        """The schema of SPDX 2.3 accepts the bill of materials."""
        fresh(WORK)
        import jsonschema
        schema = json.loads((self.fetched("spdx") / "spdx-schema.json").read_text())
        sources = {name: (TREE / name).read_bytes()
                   for name in ("LICENSE", "README.md", "cmake/setup.sh", "sw/ground/engine.h")}
        bill = json.loads(sbom.document("1.2.3+git.0123456789ab", "0" * 40, 1764000000, sources,
                                        {"a.deb": "1" * 64}))
        jsonschema.Draft7Validator(schema).validate(bill)
        with self.assertRaises(jsonschema.ValidationError):
            jsonschema.Draft7Validator(schema).validate(bill | {"files": [{"fileName": "./a"}]})

    def test_licences(self):
        """The bill of materials states the licence of each Debian package: only icesoc-ground
        contains parts under the licence of ZeroC Ice."""
        sources = {name: (TREE / name).read_bytes() for name in ("LICENSE", "cmake/setup.sh")}
        names = ["icesoc-ground", "icesoc-hdl", "icesoc-sim", "icesoc-slice2c", "libicec-dev"]
        bill = json.loads(sbom.document("1.2.3", "0" * 40, 1764000000, sources,
                                        {f"{name}_1.2.3-1~deb13_amd64.deb": "1" * 64
                                         for name in names}))
        found = {its["name"].partition("_")[0]: its for its in bill["packages"]}
        self.assertEqual({name: found[name]["licenseDeclared"] for name in names}, {
            "icesoc-ground": "MIT AND GPL-2.0-only", "icesoc-hdl": "MIT",
            "icesoc-sim": "MIT AND (LGPL-3.0-only OR Artistic-2.0)", "icesoc-slice2c": "MIT",
            "libicec-dev": "MIT"})
        for name in names:
            path = TREE / f"cmake/install/debian/{name}.copyright"
            text = path.read_text() if path.exists() else ""
            self.assertEqual("License: GPL-2" in text, "GPL-2" in found[name]["licenseDeclared"])
        page = next(its for its in bill["packages"] if its["name"] == "npm-ice")
        self.assertEqual(page["licenseDeclared"], "GPL-2.0-only")
        self.assertIn({"spdxElementId": found["icesoc-ground"]["SPDXID"],
                       "relationshipType": "CONTAINS", "relatedSpdxElement": page["SPDXID"]},
                      bill["relationships"])

    def test_contracts(self):
        """The registers of a block are compatible with each recorded version that has the same
        major number. If RECORD is in the environment, missing versions are recorded."""
        for path in sorted([*TREE.glob("hdl/*/*.regs.json"), *TREE.glob("ip/*/*.regs.json")]):
            block = Block.read(path)
            if not block.is_slot:
                continue
            number = f"{block.version >> 8}.{block.version & 255}"
            own = CONTRACTS / f"{block.name}-{number}.json"
            if os.environ.get("RECORD") and not own.exists():
                write(own, json.dumps(undocumented(block.description), indent=1) + "\n")
            files = list(CONTRACTS.glob(f"{block.name}-{block.version >> 8}.*.json"))
            if list(CONTRACTS.glob(f"{block.name}-*.json")):
                self.assertIn(own, files, f"{block.name} {number} is not recorded: RECORD=1")
            for file in files:
                old = Block.read(file)
                breaking, compatible = contract_diff.compare(old, block)
                self.assertFalse(breaking, f"{path}: raise the major version of {block.name}, "
                                 f"since it breaks {file.stem}")
                self.assertFalse(compatible and old.version == block.version,
                                 f"{path}: raise the minor version of {block.name}: {compatible}")

    def release(self, out, *words, tree=TREE, **environment):
        self.ask(TREE / "icesoc", "release", "--out", out, *words,
                 env={**os.environ, "ICESOC_TREE": str(tree), **environment})

    def test_same_objects(self):
        """The object files of a package have the same bytes in every folder, with and without
        ccache, even with debug information."""
        fresh(WORK)
        made = []
        for folder in "a", "b/deeper":
            write(Path(folder, "CMakeLists.txt"), f"""cmake_minimum_required(VERSION 3.20)
project(same LANGUAGES C)
include({TREE}/cmake/same_bytes.cmake)
file(WRITE ${{CMAKE_BINARY_DIR}}/gen/made.h "static const char *made(void) {{ return __FILE__; }}")
add_library(same STATIC ${{CMAKE_SOURCE_DIR}}/some/file.c)
target_include_directories(same PRIVATE ${{CMAKE_BINARY_DIR}}/gen ${{CMAKE_SOURCE_DIR}}/some)
""")
            write(Path(folder, "some/file.h"),
                  "static const char *header(void) { return __FILE__; }")
            write(Path(folder, "some/file.c"), "#include \"file.h\"\n#include \"made.h\"\n"
                  "const char *name(int n) { return n ? header() : n > 1 ? made() : __FILE__; }\n")
            for launcher in "", "ccache" if shutil.which("ccache") else "":
                build = Path(folder, "build/same")
                shutil.rmtree(build, ignore_errors=True)
                self.ask("cmake", "-G", "Ninja", "-S", folder, "-B", build, "-DCMAKE_C_FLAGS=-g",
                         f"-DCMAKE_C_COMPILER_LAUNCHER={launcher}")
                self.ask("ninja", "-C", build, env={
                    **os.environ, "CCACHE_BASEDIR": str(Path(folder).absolute()),
                    "CCACHE_NOHASHDIR": "1", "CCACHE_DIR": str(WORK / "ccache")})
                made.append(next(build.rglob("*.o")).read_bytes())
        for path in b"../../some/file.c\0", b"../../some/file.h\0", b"gen/made.h\0":
            self.assertTrue(path in made[0], path)
        self.assertTrue(made[1:] == made[:1] * 3, "the objects differ")

    def test_same_bytes(self):
        """Two runs in different environments produce the same bytes. The archive contains all files
        of the commit, and the bill of materials lists each of them."""
        fresh(WORK)
        if not (TREE / ".git").exists():
            self.skipTest("this tree is not a git repository")
        there = ["git", "-C", TREE, "cat-file", "-e", f"HEAD:{components.LIST}"]
        if subprocess.run(there).returncode:
            self.skipTest("the last commit has no list of components")
        parts = ["--only", "source", "icec", "changes", "sbom"]
        self.release(WORK / "a", *parts, TZ="Asia/Tokyo", PYTHONHASHSEED="1")
        self.has("^IceSoC .*, not signed: --key KEY signs SHA256SUMS")
        self.release(WORK / "b", *parts, TZ="America/Lima", PYTHONHASHSEED="2")
        self.ask("diff", "-r", "a", "b")
        self.ask("sha256sum", "--check", "SHA256SUMS", cwd="a")
        listed = subprocess.check_output(["git", "ls-tree", "-r", "-z", "--name-only", "HEAD"],
                                         text=True, cwd=TREE).strip("\0").split("\0")
        source = next(path for path in Path("a").glob("icesoc-*.tar.gz"))
        with tarfile.open(source) as tar:
            folder = source.name.removesuffix(".tar.gz") + "/"
            self.assertEqual(sorted(tar.getnames()), sorted(folder + name for name in listed))
            self.assertEqual(tar.getmember(folder + "icesoc").mode, 0o755)
        bill = json.loads(next(Path("a").glob("*.spdx.json")).read_text())
        self.assertEqual(sorted(its["fileName"] for its in bill["files"]),
                         sorted(f"./{name}" for name in listed))
        self.assertEqual(bill["spdxVersion"], "SPDX-2.3")
        known = [its["SPDXID"] for kind in ("packages", "files") for its in bill[kind]]
        self.assertEqual(len(known), len(set(known)))
        for its in bill["relationships"]:
            for end in its["spdxElementId"], its["relatedSpdxElement"]:
                self.assertIn(end, {*known, "SPDXRef-DOCUMENT"})
        sums = sorted(its["checksums"][0]["checksumValue"] for its in bill["files"])
        self.assertEqual(bill["packages"][0]["packageVerificationCode"],
                         {"packageVerificationCodeValue":
                          hashlib.sha1("".join(sums).encode()).hexdigest()})
        with zipfile.ZipFile(next(Path("a").glob("*.pack"))) as pack:
            self.assertIn("IceSoC.IceC.pdsc", pack.namelist())

    def small(self, unreleased):
        """Turns the work folder into a repository that contains a changelog."""
        fresh(WORK / "small")
        repository()
        write("CHANGELOG.md", SMALL.format(unreleased))
        commit("First")

    def test_versions(self):
        """If a commit has unreleased changes, its version consists of the last version and the
        time and hash of the commit, so that dpkg regards later commits as newer. A released version
        belongs to one commit."""
        self.assertEqual(version.newest(), re.search(r"badge/version-([\d.]+)-",
                                                     (TREE / "README.md").read_text())[1])
        self.small("\n- third\n")
        seconds, short = int(git("show -s --format=%ct")), git("rev-parse HEAD")[:12]
        when = time.strftime("%Y%m%d%H%M%S", time.gmtime(seconds))
        number = f"1.2.3+git.{when}.{short}"
        self.release("out", "--only", "changes", tree=".")
        self.has(f"^IceSoC {re.escape(number)}, not signed")
        self.has("^- third", file=f"out/CHANGES-{number}.md")
        self.assertEqual(version.of_commit("."), number)
        write("unpacked/CHANGELOG.md", SMALL.format("\n- third\n"))  # belongs to no commit
        self.assertEqual(version.of_commit("unpacked"), "1.2.3")
        later = version.of_text(Path("CHANGELOG.md").read_text(), "0" * 40, seconds + 1)
        for older, newer in ("1.2.3-1", f"{number}-1"), (f"{number}-1", f"{later}-1"), (
                f"{later}-1", "1.2.4-1"):
            self.ask("dpkg", "--compare-versions", older, "lt", newer)
        self.small("")
        git("tag v1.2.3")
        self.release("out", "--only", "changes", tree=".")
        self.has("^- second", file="out/CHANGES-1.2.3.md")
        self.lacks("first", file="out/CHANGES-1.2.3.md")
        write("more", "")
        commit("Second")
        self.ask(TREE / "icesoc", "release", "--only", "changes", status=1,
                 env={**os.environ, "ICESOC_TREE": "."})
        self.has("version 1.2.3 is already released as commit .*; give CHANGELOG.md a new version")
        self.ask(TREE / "icesoc", "release", "--only", "sauce", status=2)
        self.has("--only: expected one of source, .*, got 'sauce'")

    def package(self, path, seconds):
        """Writes a Debian package without files, with the time stamp `seconds`."""
        write(path.with_suffix("") / "DEBIAN/control", "Package: a\nVersion: 1\nDescription: a\n"
              "Architecture: all\nMaintainer: a <a@b>\n")
        self.ask("dpkg-deb", "--root-owner-group", "-b", path.with_suffix(""), path,
                 env={**os.environ, "SOURCE_DATE_EPOCH": str(seconds)})

    def test_two_debians(self):
        """A release takes the packages for each release of Debian from a folder. Packages of
        another commit, and two packages with the same name, are rejected."""
        self.small("")
        seconds = int(git("show -s --format=%ct"))
        for number in 12, 13:
            self.package(Path(f"{number}/a_1~deb{number}_all.deb"), seconds)
        release = ["--only", "changes", "packages", "--packages"]
        self.release("out", *release, "12", "13", tree=".")
        self.has("a_1~deb12_all.deb$", "a_1~deb13_all.deb$")
        self.ask("sha256sum", "--check", "SHA256SUMS", cwd="out")
        self.has("a_1~deb12_all.deb: OK", "a_1~deb13_all.deb: OK")
        refused = [TREE / "icesoc", "release", *release]
        how = {"status": 1, "env": {**os.environ, "ICESOC_TREE": "."}}
        self.ask(*refused, "12", "12", **how)
        self.has("packages: 12/a_1~deb12_all.deb: another folder also has this package")
        self.package(Path("old/a_1~deb12_all.deb"), seconds - 60)
        self.ask(*refused, "old", "13", **how)
        self.has("old/a_1~deb12_all.deb: expected files of .*, the time of commit .*, got ")
        os.mkdir("empty")
        self.ask(*refused, "empty", **how)
        self.has("packages: expected Debian packages in empty, got none")

    def test_signature(self):
        """The signature of SHA256SUMS is valid, and a missing key is an error."""
        if not shutil.which("gpg"):
            self.skipTest("gpg is missing: apt-get install gnupg")
        self.small("")
        home = {**os.environ, "GNUPGHOME": str(Path("keys").absolute()), "ICESOC_TREE": "."}
        os.mkdir("keys", 0o700)
        self.ask("gpg", "--batch", "--passphrase", "", "--quick-gen-key", "test@icesoc", "ed25519",
                 env=home)
        release = [TREE / "icesoc", "release", "--only", "changes", "--out", "out", "--key"]
        self.ask(*release, "test@icesoc", env=home)
        self.has("SHA256SUMS.asc$", "^IceSoC 1.2.3, signed.$")
        self.ask("gpg", "--verify", "out/SHA256SUMS.asc", "out/SHA256SUMS", env=home)
        self.ask(*release, "missing@icesoc", status=1, env=home)
        self.has("release: gpg could not sign with 'missing@icesoc': ")
        self.ask("gpgconf", "--kill", "all", env=home)


main(Cases)
