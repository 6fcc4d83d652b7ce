# SPDX-License-Identifier: MIT
"""fetch: downloads files that the build needs and Debian's packages do not contain, without
changing the system.

    fetch.py THING FOLDER    puts THING into FOLDER; `fetch.py --help` lists the things

A download is rejected if its checksum differs from the checksum that is listed here; a second build
needs no network (download.py). Exit status 77: the network is missing, and only optional parts need
this thing.
"""

import argparse
import os
import pathlib
import platform
import re
import shlex
import shutil
import sys
import tarfile

from icesoc.util.download import (GITHUB, NPM, Unreachable, kept, locked, output, packages,
                                  released, unpack)

# (path in Debian's pool, or below GITHUB or NPM; SHA-256)
LZ4 = ("l/lz4/lz4_1.9.4.orig.tar.gz",
       "0b0e3aa07c8c063ddf40b082bdf7e37a1562bda40a0ff5272957f3e987e0e54b")
SODIUM = ("libs/libsodium/libsodium_1.0.18.orig.tar.gz",
          "d59323c6b712a1519a5daf710b68f5e7fde57040845ffec53850911f10a5d4f4")
ICE = {"3.7.8": "c48f9e43d65e2b1f5e2af747fd86e7718b5e344b4e9d9a7dc73a84dd0be61f66",
       "3.7.10": "eb1c545cf679facdd07ab45e85ad9f87f2ffc84d72687eeeea2e4e490a6d31c8"}
SCHEMA = ("ARM-software/CMSIS_5/51f8f89612c8330c0116479cfe3a2cb04c390e2b"
          "/CMSIS/Utilities/CMSIS-SVD.xsd",
          "eee4bfe949f80708b00cccb4833e71da3766b0489a4cdfa2dae225d541688d89")
PACK = ("Open-CMSIS-Pack/Open-CMSIS-Pack-Spec/f34f91d07e4299e8aab0e4ee7fb8ff4834001c3e"
        "/schema/PACK.xsd", "76fd2cd95a2e3de3da20922723d624c7c356639cd79a2d5abd81efcec7c9e31b")
PLATFORMIO = ("platformio/platformio-core/145142ea6c1d97c92a62999d424c0dd712fbb9f5"
              "/platformio/package/manifest", {
                  "schema.py": "e91f2d348a72d5000fe5c4b882a93bc59188b1e7d07327b1fa697f66940acc33",
                  "parser.py": "6c294a1693ae6983714ecae4607b1db6251d7feb130516e34f4af148abbadbd8"})
ZEPHYR = ("zephyrproject-rtos/zephyr/e46ee99c65eba835ec62be60d7a24e3a9d3cb14b"
          "/scripts/zephyr_module.py",
          "91b284669a093d2648fbff54e24c20533256a160918f8e996c8bc59d14f69116")
SPDX = ("spdx/spdx-spec/aadf3b0b8dbbabdb4d880b0fc714255fea436ff7/schemas/spdx-schema.json",
        "239208b7ac287b3cf5d9a9af23f9d69863971102a5e1587a27a398b43490b89b")
PAGE = [("tabulator-tables", "6.5.3",
         "a3aeb833e5cf924c8a686fa6748c1070c5fde8e605e0b1734000c35b78571a9b",
         ["js/tabulator.min.js", "css/tabulator_simple.min.css"]),
        ("uplot", "1.6.32", "4b8a8191e425658e3ea8c8c1314b0fc679c861ee3a1af2b20c7b16ba50b5133d",
         ["uPlot.iife.min.js", "uPlot.min.css"])]
ICEJS = ("3.7.110", "8477728b2fccb8ec825d432d35391df74857c4dc5c68c39dc6f96925d475fd8d")
# FreeRTOS 11.1.0, MIT licence: folder of its commit, SHA-256 and path of each file
FREERTOS = ("FreeRTOS/FreeRTOS-Kernel/dbf70559b27d39c1fdb68dfb9a32140b6a6777a0", """
508a77d2e7b51d98adeed32648ad124b7b30241a8e70b2e72c99f92d8e5874d1 LICENSE.md
189d9626143b76b1a948a612c051617052f16b3e193324cc96b20e0eb4b8a103 include/FreeRTOS.h
157c9b113297981d1944d37826e10955be95ae4158483ddfaf2f287d0e02e024 include/deprecated_definitions.h
e18c1bd8dffddc0608112f3e47f28962dc8df916984e68286bbc9a9fa4f83d7c include/list.h
b2dd748823dce76d42a15a7a00e1bad3140eaaf615487716d3eca4763e0ac9bc include/mpu_wrappers.h
973c26ded2da7465cc843cf888d88bfc4e5bf9bb4099b48b131082eb95d35222 include/portable.h
05308062697b6093618d4b7110dbf125c5b4839072680d3b7239bc2644082347 include/projdefs.h
acaf6a17c7eb7106cbf4f0c6ba1438fb881127f9f4dae8085582dea8467659c0 include/queue.h
454fae279911c48b3636b341c77ecd18a00abc8c50206b9e83cf7d4ae2bccd7f include/semphr.h
022a341340eee8fbc21fc7fac1aafa3e6a9a720a24e91ea718af0b46fe843052 include/stack_macros.h
f3a76f99198a537ffce4b7876566502e7156a4fbd5b57b56f213bb7884b772c9 include/task.h
14c35d6830037b75612ad1f60367bd7a8e80122d9c8612ff4eaebaf5917b9924 include/timers.h
e0a4d7a061e86ccb8ee4e08b0c1229c51d8c0a7a6f1c51c45083314f2e42b297 list.c
037f78c536c8cf8dff0cc46b5a0f11e997fdbed1828ad6072a18d4848d7a9f3b portable/GCC/ARM_CM3/port.c
8cd1066faa43ef966ec0e971dabdd82b5f2f00bd38ea86de84969dd7833072f7 portable/GCC/ARM_CM3/portmacro.h
e66b73eb6dd7e6b2ccd121ab8d7345ab9698cd655b32171476643284e6dc4f4a queue.c
6a54883765441f12b45b7f2e36838727e8e0aa872054df30c814c473ee3e4149 tasks.c
""")
# Debian 13's packages with GHDL 5, and with all libraries that it loads
GHDL = ["ghdl-mcode", "ghdl-common", "libgnat-14", "libc6", "libgcc-s1", "libstdc++6", "zlib1g",
        "gcc-14-base"]


def fail(text, status=1):
    print(f"fetch: {text}", file=sys.stderr)
    sys.exit(status)


def program(target, text):
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text("#!/bin/sh\n" + text)
    target.chmod(0o755)


def ghdl(target):
    """GHDL 5 (GHDL 2's Verilog output is wrong for `case`); FOLDER/ghdl runs it"""
    installed = re.match(r"GHDL (\d+)", output("ghdl", "--version"))
    if installed and int(installed[1]) >= 5:
        return program(target / "ghdl", 'exec ghdl "$@"\n')
    root = packages("ghdl5", GHDL)
    # GHDL runs with the dynamic loader and the libraries that were downloaded with it
    loader = next(file for file in sorted(root.rglob("ld-linux-*.so.2")) if not file.is_symlink())
    words = [f"GHDL_PREFIX={root}/usr/lib/ghdl/mcode/vhdl", loader, "--library-path",
             root / f"usr/lib/{os.uname().machine}-linux-gnu", root / "usr/bin/ghdl-mcode"]
    program(target / "ghdl", f'exec env {shlex.join(map(str, words))} "$@"\n')


def icegrid(target):
    """IceGrid's registry and IceStorm, as two programs; Debian's packages would start services"""
    release = platform.freedesktop_os_release()["VERSION_CODENAME"]
    library = "libzeroc-icestorm3.7" + ("" if release == "bookworm" else "t64")
    root = packages(f"icegrid-{release}", ["zeroc-icegrid", "zeroc-icebox", library], release)
    libraries = root / f"usr/lib/{os.uname().machine}-linux-gnu"
    for name in ("icegridregistry", "icebox"):
        program(target / name, f'export LD_LIBRARY_PATH={shlex.quote(str(libraries))}\n'
                f'exec {shlex.quote(str(root / "usr/bin" / name))} "$@"\n')


def ice_source(version):
    return released(f"z/zeroc-ice/zeroc-ice_{version}.orig.tar.xz", ICE[version])


def ice(target):
    """internal transport headers of Ice, in the version of the installed ZeroC Ice"""
    version = output("dpkg-query", "-W", "-f", "${Version}", "libzeroc-ice-dev").split("-")[0]
    try:
        archive = ice_source(version)
    except (KeyError, Unreachable) as error:
        print(f"fetch: the source of ZeroC Ice {version} is not available ({error}); the build "
              "continues with the headers of 3.7.8, because Ice's transport classes have not "
              "changed since 3.7.8", file=sys.stderr)
        archive, version = ice_source("3.7.8"), "3.7.8"
    unpack(archive, f"ice-{version}/cpp/src/Ice/", target / "Ice", ".h")


def zeroc(target):
    """from ZeroC Ice 3.7.8: the Python test suites, and Slice files that a compiler must reject"""
    source = ice_source("3.7.8")
    unpack(source, "ice-3.7.8/cpp/test/Slice/errorDetection/", target / "errorDetection", ".ice")
    unpack(source, "ice-3.7.8/python/test/", target)


def lz4(target):
    """the source of LZ4, which unpacks firmware on the chip"""
    unpack(released(*LZ4), "lz4-1.9.4/lib/", target)


def sodium(target):
    """the sources of libsodium that check a signature, for the chip"""
    unpack(released(*SODIUM), "libsodium-1.0.18/src/libsodium/", target)


def svd(target):
    """ARM's schema of CMSIS-SVD files, 1.3.9"""
    target.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(kept(f"{GITHUB}/{SCHEMA[0]}", SCHEMA[1]), target / "CMSIS-SVD.xsd")


def pack(target):
    """ARM's schema of CMSIS-Packs, 1.7.60"""
    target.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(kept(f"{GITHUB}/{PACK[0]}", PACK[1]), target / "PACK.xsd")


def modules(target, *wanted):
    """Copies the Python modules of these Debian packages into a folder."""
    release = platform.freedesktop_os_release()["VERSION_CODENAME"]
    root = packages(f"{wanted[0]}-{release}", wanted, release)
    shutil.copytree(root / "usr/lib/python3/dist-packages", target, dirs_exist_ok=True)


def platformio(target):
    """PlatformIO's parser and schema of library.json; python/ has the modules that they need"""
    target.mkdir(parents=True, exist_ok=True)
    for file, checksum in PLATFORMIO[1].items():
        shutil.copyfile(kept(f"{GITHUB}/{PLATFORMIO[0]}/{file}", checksum), target / file)
    modules(target / "python", "python3-marshmallow", "python3-semantic-version",
            "python3-packaging")


def zephyr(target):
    """Zephyr's schema of module.yml; python/ has the modules that check it"""
    target.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(kept(f"{GITHUB}/{ZEPHYR[0]}", ZEPHYR[1], "METADATA_SCHEMA = '''(.*?)'''"),
                    target / "module-schema.yml")
    modules(target / "python", "python3-pykwalify", "python3-yaml", "python3-docopt",
            "python3-dateutil", "python3-six", "python3-ruamel.yaml", "python3-ruamel.yaml.clib")


def spdx(target):
    """the JSON schema of SPDX 2.3"""
    target.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(kept(f"{GITHUB}/{SPDX[0]}", SPDX[1]), target / "spdx-schema.json")


def freertos(target):
    """the kernel FreeRTOS 11.1.0 for the Cortex-M3, for the porting example"""
    folder, files = FREERTOS
    for checksum, path in map(str.split, files.strip().splitlines()):
        file = target / path
        file.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(kept(f"{GITHUB}/{folder}/{path}", checksum), file)


def page(target):
    """Tabulator and uPlot for the pages, as FOLDER/libraries.js and .css, each below its licence"""
    target.mkdir(parents=True, exist_ok=True)
    texts = {"js": "", "css": ""}
    try:
        for name, version, checksum, files in PAGE:
            with tarfile.open(kept(f"{NPM}/{name}/-/{name}-{version}.tgz", checksum)) as tar:
                licence = tar.extractfile("package/LICENSE").read().decode()
                for file in files:
                    lines = tar.extractfile(f"package/dist/{file}").read().decode().split("\n")
                    code = "\n".join(line for line in lines if "sourceMappingURL=" not in line)
                    kind = file.rsplit(".", 1)[1]
                    texts[kind] += f"/*! {name} {version}\n{licence}\n*/\n{code}\n"
        (target / "done").touch()
    except Unreachable as error:
        texts = {"js": "", "css": ""}
        print(f"fetch: {error}\nfetch: cannot get Tabulator and uPlot, is there a network? Pages "
              "have plain tables and no drawn charts; the next build tries again", file=sys.stderr)
    for kind, text in texts.items():
        (target / f"libraries.{kind}").write_text(text)


def icejs(target):
    """Ice for JavaScript, for the page of a flight, as FOLDER/ice.js"""
    target.mkdir(parents=True, exist_ok=True)
    version, checksum = ICEJS
    text = ""
    try:
        with tarfile.open(kept(f"{NPM}/ice/-/ice-{version}.tgz", checksum)) as tar:
            library = tar.extractfile("package/lib/Ice.min.js").read().decode()
            text = f"/*! ice {version}, ZeroC, Inc., GPL-2.0 */\n{library}"
        (target / "ice.done").touch()
    except Unreachable as error:
        print(f"fetch: {error}\nfetch: cannot get Ice for JavaScript; check the network. Without "
              "it the page of a flight makes no calls; the next build tries again", file=sys.stderr)
    (target / "ice.js").write_text("\n".join(
        line for line in text.split("\n") if "sourceMappingURL=" not in line))


# Things that only optional parts need -> text that names the part
OPTIONAL = {zeroc: "Only these suites need it", svd: "Only the check of icesoc.svd needs it",
            pack: "Only the check of the CMSIS-Pack needs it",
            platformio: "Only the check of PlatformIO's manifest needs it",
            zephyr: "Only the check of Zephyr's module needs it",
            spdx: "Only the check of the bill of materials needs it",
            freertos: "Only the porting example for this kernel needs it"}
THINGS = {thing.__name__: thing
          for thing in (ice, ghdl, icegrid, icejs, lz4, sodium, page, svd, zeroc, pack,
                        platformio, zephyr, spdx, freertos)}


def main():
    things = "\n".join(f"  {name:10} {thing.__doc__}" for name, thing in THINGS.items())
    parser = argparse.ArgumentParser(description=__doc__, epilog=things,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("thing", choices=THINGS, metavar="THING")
    parser.add_argument("folder", type=pathlib.Path, metavar="FOLDER")
    options = parser.parse_args()
    thing = THINGS[options.thing]
    with locked():
        try:
            thing(options.folder.absolute())
        except Unreachable as error:
            fail(f"{error}\nfetch: cannot get {options.thing}: is there a network? " +
                 OPTIONAL.get(thing, "Check the network, then run make again"),
                 77 if thing in OPTIONAL else 1)


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
