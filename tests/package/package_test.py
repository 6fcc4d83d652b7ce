# SPDX-License-Identifier: MIT
"""package_test: tests that the installed components work in another folder, without the source tree
and the build tree.

Usage: package_test.py case out-folder build-folder
"""
import contextlib
import gzip
import os
import re
import shutil
import socket
import subprocess
import sys
from pathlib import Path

from script import TREE, Script, edit, fresh, main, write

BUILD = Path(sys.argv[3]).resolve()
HERE = Path(__file__).resolve().parent
COMPONENTS = "icesoc-ground", "icesoc-slice2c", "libicec-dev", "icesoc-sim", "icesoc-hdl"
IMAGE = "/usr/share/xplanet/images/earth.jpg"


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return str(s.getsockname()[1])


class Cases(Script):
    def setUp(self):
        self.out = fresh(sys.argv[2])
        self.prefix = self.out / "installed"
        self.use_prefix()

    def use_prefix(self):
        """Sets the folders in the prefix, and an environment without paths to the tree."""
        self.bin = self.prefix / "bin"
        self.hdl = self.prefix / "share/icesoc/hdl"
        self.env = {"PATH": f"{self.bin}:/usr/bin:/bin", "HOME": str(self.out), "LC_ALL": "C.UTF-8",
                    "PYTHONPATH": str(self.prefix / "lib/python3/dist-packages"),
                    "PYTHONDONTWRITEBYTECODE": "1"}
        if "CCACHE_DIR" in os.environ:
            self.env["CCACHE_DIR"] = os.environ["CCACHE_DIR"]

    def move(self):
        """Moves the installation and the home folder to folders with unusual names."""
        old, self.prefix = self.prefix, self.out / "moved, été 1"
        old.rename(self.prefix)
        self.use_prefix()
        home = self.out / "zoé müller"
        home.mkdir()
        self.env["HOME"] = str(home)

    def install(self, *components):
        for component in components:
            self.ask("cmake", "--install", BUILD, "--component", component, "--prefix", self.prefix,
                     "--strip")

    def use(self, *words, **how):
        self.ask(*words, env={**self.env, **how.pop("env", {})}, **how)

    def test_install(self):
        """No installed file contains the path of the source tree, all programs start, and each
        program has a manual page."""
        self.install(*COMPONENTS)
        files = [path for path in self.prefix.rglob("*") if path.is_file()]
        self.assertGreater(len(files), 80)
        for path in files:
            data = path.read_bytes()
            if path.suffix == ".gz":
                data = gzip.decompress(data)
            for place in TREE, BUILD:
                self.assertFalse(str(place).encode() in data, f"{path} names {place}")
            if data[:4] == b"\x7fELF":
                self.ask("readelf", "-d", path)
                self.lacks("RPATH|RUNPATH")
        programs = sorted(path.name for path in self.bin.iterdir())
        pages = {path.name.partition(".")[0]: path for path in self.prefix.glob("share/man/*/*")}
        self.assertIn("icesoc-update", programs)
        for name in programs:
            self.use(name, "--help")
            self.ask("man", "--warnings", "-l", pages[name], env={**self.env, "MANWIDTH": "100"})
            self.lacks("warning|error:|an-old.tmac")
            self.has("^OPTIONS|options")

    def test_fly(self):
        """The installed simulator flies the mission with the host build and with the ARM binary,
        after the installation was moved to another folder."""
        self.install("icesoc-ground", "icesoc-sim")
        self.move()
        for cpu in "host", "m3":
            self.use("icesoc-fly", "--size", "96x64", "--guard", "20", "--out", cpu, "--cpu", cpu)
            self.has("the result equals the C\\+\\+ reference", "ms simulated")
            self.assertTrue((self.out / cpu / "after.png").stat().st_size)
        key = Path(self.env["HOME"], ".config/icesoc/demo.key")
        self.assertEqual(key.stat().st_mode & 0o777, 0o600)
        self.use("icesoc-fly", status=1, env={"HOME": "/proc/missing"})
        self.has("^icesoc-fly: cannot write /proc/missing: No such file or directory; --key ")
        edit(self.prefix / "share/icesoc/flight.schema.json", IMAGE, "/missing.jpg")
        self.use("icesoc-fly", status=1)
        self.has("^icesoc-fly: /missing.jpg: No such file or directory: install xplanet-images, "
                 "or select a picture with --image$")
        self.use("icesoc-fly", "--help")
        self.has("^  --board BOARD +folder made by ./icesoc board make")

    def test_gateway(self):
        """A user's program calls a core through the plugin, then through the gateway."""
        self.install("icesoc-ground", "icesoc-sim")
        write("vehicles.conf", "Vehicle.uav1=xbee-at -d modem -a 0x0001\nXBeeAT.Guard=20\n")
        port = free_port()
        write("gateway.conf", f"Vehicle.uav1=tcp -h 127.0.0.1 -p {port}\n")
        write("by_plugin.sh", "#!/bin/sh\nset -e\nln -sf $1 modem\n"
              f"ICESOC_VEHICLES=vehicles.conf python3 {HERE}/call.py uav1\n")
        write("by_gateway.sh", "#!/bin/bash\nset -e\n"
              f"icesoc-gateway -d $1 -g 20 -l 127.0.0.1:{port} &\n"
              "trap 'kill $!' EXIT\n"
              f"until true 2>/dev/null >/dev/tcp/127.0.0.1/{port}; do sleep 0.1; done\n"
              f"ICESOC_VEHICLES=gateway.conf python3 {HERE}/call.py uav1\n")
        for how in "by_plugin", "by_gateway":
            self.use("icesoc-sim", "--image", IMAGE, "--size", "96x64", "--guard", "20", "--out",
                     how, "--", f"./{how}.sh", "{device}")
            self.has("^corners: 1[0-9][0-9]$")
        self.use("python3", "-c", "import icesoc; icesoc.connect('uav9', 'vehicles.conf')",
                 status=None)
        self.has("vehicle 'uav9': expected one of uav1; add a line Vehicle.uav9=")

    def test_call(self):
        """icesoc-call calls cores through the gateway, by radio and by the name of a vehicle. Wrong
        arguments, unknown vehicles, a device or port that is in use, and missing files are rejected
        with the reason."""
        self.install("icesoc-ground", "icesoc-sim", "icesoc-slice2c")
        port, other = free_port(), free_port()
        write("vehicles.conf", f"Vehicle.uav1=tcp -h 127.0.0.1 -p {port}\n")
        write("radio.conf", "Vehicle.uav1=xbee-at -d modem -a 0x0001\nXBeeAT.Guard=20\n")
        write("calls.sh", "#!/bin/bash\nset -e\nln -sf $1 modem\n"
              "export ICESOC_VEHICLES=radio.conf\n"
              "icesoc-call hwengine1.setParameterA 24\n"
              "icesoc-call uav.isAlive 7 --device modem --guard 20 --json\n"
              f"icesoc-gateway -d $1 -g 20 -l 127.0.0.1:{port} &\n"
              "trap 'kill $!' EXIT\n"
              f"until true 2>/dev/null >/dev/tcp/127.0.0.1/{port}; do sleep 0.1; done\n"
              f"! icesoc-gateway -d $1 -g 20 -l 127.0.0.1:{other}\n"
              f"! icesoc-gateway -d /dev/ptmx -l 127.0.0.1:{port}\n"
              "export ICESOC_VEHICLES=vehicles.conf\n"
              "icesoc-call hwengine1.startProcessing\n"
              "icesoc-call hwengine1.getResult --json\n"
              f"icesoc-call fir.filter '[100, 200]' --gateway 127.0.0.1:{port}\n"
              "icesoc-call uav.isAlive 8 --repeat 3 --vehicle uav1\n")
        self.use("icesoc-sim", "--image", IMAGE, "--size", "96x64", "--guard", "20", "--out",
                 "flight", "--", "bash", "calls.sh", "{device}")
        self.has('^{"result": true}$', '"found": 1[0-9][0-9],', "^calls 3, failures 0, min ",
                 "icesoc-gateway: error: xbee-at: cannot open serial port .* is using it",
                 "^gateway: error: cannot use /dev/pts/.*: Device or resource busy$",
                 f"^gateway: error: cannot listen at .*{port}.*: Address already in use$")
        self.use("icesoc-call", "--list", "hwengine1")
        self.has("setParameterA\\(value: short 0..255 grey levels\\)")
        self.use("icesoc-call", "hwengine1.setParameterA", "300", status=2)
        self.has("value: expected 0 to 255, got 300")
        self.use("icesoc-call", "uav.isAlive", "7", "--vehicle", "uav9", status=2,
                 env={"ICESOC_VEHICLES": "vehicles.conf"})
        self.has("vehicle 'uav9': expected one of uav1")
        write("two.conf", "Vehicle.a=tcp -p 1\nVehicle.b=tcp -p 2\n")
        self.use("icesoc-call", "uav.isAlive", "7", status=2, env={"ICESOC_VEHICLES": "two.conf"})
        self.has("--vehicle: expected a name, as two.conf lists several: a, b$")
        self.use("icesoc-call", "uav.isAlive", "7", status=2, env={"ICESOC_VEHICLES": "none.conf"})
        self.has("^icesoc: no file lists the vehicles: expected none.conf with a line such as$")
        self.use("icesoc-call", "uav.isAlive", "7", "--gateway", "nohost.invalid:1", status=4)
        self.has("cannot reach nohost.invalid:1: nohost.invalid: host not found$")
        self.use("icesoc-update", "missing", status=1)
        self.has("^update: missing: No such file or directory$")
        self.use("icesoc-change-key", "--device", "modem", "--key", "missing", status=1)
        self.has("^change_key: .*/missing: No such file or directory$")
        self.use("icesoc-provide-key", "--port", "/dev/null", "--open", status=1)
        self.has("^provide_key: [^(]*Inappropriate ioctl for device$")
        self.use("icesoc-fly", "--out", "/proc/missing", status=1)
        self.has("^icesoc-fly: cannot write /proc/missing: No such file or directory$")

    def test_device(self):
        """The programs of the ground station accept paths with spaces and colons, such as those in
        /dev/serial/by-path."""
        self.install("icesoc-ground", "icesoc-sim", "icesoc-slice2c")
        port = "usb 0:1.0/my modem"
        write("my keys/uav 1.key", "00112233445566778899aabbccddeeff\n")
        os.chmod("my keys/uav 1.key", 0o600)
        self.use("icesoc-pack-update", "image", self.prefix / "lib/icesoc/uav.elf", "7", "own.key",
                 "new.update")
        write("vehicles.conf", f"Vehicle.uav1=xbee-at -d \"{port}\" -a 1\nXBeeAT.Guard=20\n"
              "XBeeAT.KeyFile=my keys/uav 1.key\n")
        write("use.sh", f"mkdir -p 'usb 0:1.0'\nln -sf $1 '{port}'\n"
              "export ICESOC_VEHICLES=vehicles.conf\n"
              f"modem=\"--device '{port}' --key 'my keys/uav 1.key' --guard 20\"\n"
              "icesoc-call keys.count\n"
              "eval icesoc-call uav.isAlive 7 $modem\n"
              "eval icesoc-change-key $modem\n"
              "eval icesoc-update new.update $modem\n")
        self.use("icesoc-sim", "--image", IMAGE, "--size", "96x64", "--guard", "20", "--out",
                 "flight", "--key", "my keys/uav 1.key", "--", "sh", "use.sh", "{device}",
                 status=None)
        self.has("^1$", "^true$", "^change_key: vehicle 0x0001 and .*/uav 1.key have a new key",
                 "^update: the vehicle has no object 'update'")

    def test_page(self):
        """Checks the gateway's page: its files, and a call like the one that the browser makes. The
        files must not come from the source tree."""
        self.install("icesoc-ground", "icesoc-sim", "icesoc-slice2c")
        port, page = free_port(), free_port()
        write("page.sh", "#!/bin/bash\nset -e\n"
              f"icesoc-gateway -d $1 -g 20 -l 127.0.0.1:{port} --page 127.0.0.1:{page} &\n"
              "trap 'kill $!' EXIT\n"
              f"until true 2>/dev/null >/dev/tcp/127.0.0.1/{page}; do sleep 0.1; done\n"
              f"python3 {HERE}/page.py 127.0.0.1:{page}\n")
        self.use("icesoc-sim", "--image", IMAGE, "--size", "96x64", "--guard", "20", "--out",
                 "flight", "--", "bash", "page.sh", "{device}")
        self.has("^objects: uav .*hwengine1", "^shell: icesoc-call --gateway 'ws -h 127.0.0.1 -p ",
                 "^isAlive: True$", "objects.js [0-9]{4,} bytes")
        library = self.prefix / "share/icesoc/page/ice.js"
        if not library.stat().st_size:
            return print("without Ice for JavaScript, which could not be fetched")
        self.has("ice.js [0-9]{6} bytes")
        self.assertIn("GPL-2.0", library.read_text().partition("\n")[0])

    @contextlib.contextmanager
    def server(self, program):
        port = free_port()
        with subprocess.Popen([program, port], stdout=subprocess.PIPE, text=True) as server:
            try:
                self.assertEqual(server.stdout.readline(), "ready\n")
                yield port
            finally:
                server.kill()

    def answers(self, program):
        """Checks that stock ZeroC Ice can call the server."""
        with self.server(program) as port:
            self.use("python3", "-c", f"""
import Ice
Ice.loadSlice("{HERE}/project/server/Thing.ice")
import M
with Ice.initialize() as ic:
    thing = M.ThingPrx.checkedCast(ic.stringToProxy("thing:tcp -h 127.0.0.1 -p {port}"))
    print("sum", thing.add(3, 4))
    try:
        thing.add(1, -1)
    except M.Busy as busy:
        print("busy:", busy.why)
""")
            self.has("^sum 7$", "^busy: b is negative$")

    def test_icec(self):
        """A project of ten lines can be built with CMake and with pkg-config. icesoc-call calls its
        program."""
        self.install("icesoc-slice2c", "libicec-dev", "icesoc-ground")
        self.use("cmake", "-S", HERE / "project/server", "-B", "cmake", "-G", "Ninja",
                 f"-DCMAKE_PREFIX_PATH={self.prefix}")
        self.use("ninja", "-C", "cmake")
        self.answers("cmake/server")
        with self.server("cmake/server") as port:
            thing = ["--slice", HERE / "project/server/Thing.ice", "--gateway",
                     f"127.0.0.1:{port}"]
            self.use("icesoc-call", "thing.add", "3", "4", *thing)
            self.has("^7$")
            self.use("icesoc-call", "thing.add", "1", "-1", *thing, status=3)
            self.has("why = b is negative")
        folders = [path.parent for path in self.prefix.rglob("*.pc")]
        write("make.sh", f"""#!/bin/sh
set -ex
$(pkg-config --variable=slice2c slice2c) {HERE}/project/server/Thing.ice --output-dir made
cc -std=c90 -ffunction-sections -fdata-sections -o by_pkg_config -Imade \\
    {HERE}/project/server/server.c made/*.c $(pkg-config --cflags --libs icec) \\
    -Wl,--gc-sections
""")
        self.use("./make.sh", env={"PKG_CONFIG_PATH": ":".join(map(str, folders))})
        self.answers("./by_pkg_config")

    def test_hdl(self):
        """Another project can simulate the bridge from its file list, and the file lists are
        complete."""
        self.install("icesoc-hdl")
        bench, lists = HERE / "fsmc_bridge_tb.v", self.hdl / "fsmc_bridge.f"
        hdl = {"ICESOC_HDL": str(self.hdl)}
        self.use("iverilog", "-g2005", "-Wall", "-Wno-timescale", "-s", "fsmc_bridge_tb", "-o",
                 "bridge.vvp", "-f", lists, bench, env=hdl)
        self.assertEqual(self.said, "")
        self.use("vvp", "-n", "bridge.vvp")
        self.has("^PASS$")
        self.use("verilator", "--binary", "--timing", "-Wno-fatal", "-O0", "--Mdir", "verilated",
                 "-MAKEFLAGS", "OPT_FAST=-O0 OPT_SLOW=-O0 OPT_GLOBAL=-O0",
                 "--top-module", "fsmc_bridge_tb", "-f", lists, bench, env=hdl)
        self.use("verilated/Vfsmc_bridge_tb")
        self.has("^PASS$")
        for path in sorted(self.hdl.glob("*.f")):
            top = re.search(r"Top: (\w+)[.]", path.read_text())[1]
            self.use("verilator", "--lint-only", "-Wall", "--top-module", top, "-f", path, env=hdl)
            self.assertTrue((self.hdl / f"icesoc-{path.stem}.core").exists())
        try:
            import yaml
        except ImportError:
            self.skipTest("python3-yaml is missing: FuseSoC's core files were not read")
        listed, included, needed = {}, {}, {}  # by the name of the block
        for path in self.hdl.glob("*.core"):
            head, _, text = path.read_text().partition("\n")
            self.assertEqual(head, "CAPI=2:")
            core = yaml.safe_load(text)
            block = core["name"].split(":")[2]
            files = [file if isinstance(file, str) else next(iter(file))
                     for fileset in core["filesets"].values() for file in fileset["files"]]
            for name in files:
                self.assertTrue((self.hdl / name).exists(), f"{path} names {name}")
            listed[block] = {Path(name).name for name in files}
            included[block] = {name for file in files for name in re.findall(
                '(?m)^ *`include "(.*)"', (self.hdl / file).read_text())
                if not name.endswith("_proof.vh")}
            needed[block] = [each.split(":")[2] for each in
                             core["filesets"]["rtl"].get("depend", [])]

        def with_needed(block):
            return listed[block].union(*map(with_needed, needed[block]))
        missing = {block: included[block] - with_needed(block) for block in listed}
        self.assertEqual({block: names for block, names in missing.items() if names}, {})

    def test_fusesoc(self):
        """FuseSoC finds each block with its dependencies, and lints the block with Verilator."""
        fusesoc = shutil.which("fusesoc")
        if not fusesoc:
            self.skipTest("fusesoc is missing: pip install fusesoc")
        self.install("icesoc-hdl")
        cores = [fusesoc, "--cores-root", self.hdl]
        blocks = sorted(path.stem.removeprefix("icesoc-") for path in self.hdl.glob("*.core"))
        self.ask(*cores, "core", "list")
        self.has(*(f"^icesoc:hdl:{block}:[0-9]" for block in blocks))
        for block in blocks:
            self.ask(*cores, "run", "--target", "lint", f"icesoc:hdl:{block}")
        self.ask(*cores, "run", "--setup", "--target", "synth", "--tool", "ise",
                 "icesoc:hdl:fsmc_bridge", "--family", "spartan6", "--device", "xc6slx16",
                 "--package", "ftg256", "--speed=-2")
        scripts = "".join(path.read_text() for path in Path("build").rglob("*.tcl"))
        self.assertIn("constraints/platform.ucf", scripts)

    def test_packages(self):
        """There is a Debian package for each component, with the files, scripts and dependencies
        that the component needs. All users can read the folders, whatever the umask was."""
        if not shutil.which("dpkg-shlibdeps"):
            self.skipTest("dpkg-dev is missing")
        self.ask("sh", "-c", 'umask 077; exec "$@"', "sh", TREE / "tools/python", "-c",
                 "import sys; from icesoc.cli.commands.package import pack; pack(*sys.argv[1:])",
                 BUILD, self.out)
        found = {path.name.partition("_")[0]: path for path in self.out.glob("*.deb")}
        self.assertEqual(sorted(found), sorted(COMPONENTS))
        for name, path in found.items():
            self.ask("dpkg-deb", "--contents", path)
            self.lacks("^[d-]......---")
            self.ask("dpkg-deb", "--info", path)
            print(name, path.stat().st_size, "bytes")
        self.ask("dpkg-deb", "--info", found["icesoc-ground"])
        self.has("Depends: .*python3-zeroc-ice", "libzeroc-ice3.7", "postinst")
        # The packages of programs for a vehicle and a ground station cannot be mixed with packages
        # of another version.
        its = r"[0-9]+\.[0-9]+\.[0-9]+(\+git\.[0-9]{14}\.[0-9a-f]{12})?-1~deb[0-9]+\)"
        self.has(rf"Depends: icesoc-slice2c \(= {its}")
        self.ask("dpkg-deb", "--info", found["icesoc-sim"])
        self.has(rf"Depends: icesoc-ground \(= {its}")
        # Generated code and IceC must have the same version.
        self.ask("dpkg-deb", "--info", found["libicec-dev"])
        self.has(rf"Breaks: icesoc-slice2c \(<< {its}, icesoc-slice2c \(>> {its}")
        self.ask("dpkg-deb", "--info", found["icesoc-hdl"])
        self.has("Architecture: all")
        self.ask("dpkg-deb", "--contents", found["icesoc-ground"])
        self.has("usr/lib/[a-z0-9_]+-linux-gnu/libxbeeat.so.37", "systemd/system/icesoc-gateway@",
                 "share/doc/icesoc-ground/copyright")


if __name__ == "__main__":
    main(Cases)
