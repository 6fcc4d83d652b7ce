#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""mission_test: flies missions in the way in which users start them.

Usage: mission_test.py case out-folder build-folder
"""
import contextlib
import json
import os
import pty
import random
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

from script import TREE, Script, fresh, main, write

CASE, BUILD = sys.argv[1], Path(sys.argv[3]).resolve()
IMAGE = Path("/usr/share/xplanet/images/earth.jpg")
# guard time of the modem, ms. With the default of 1 s, four guard times would pass in each flight.
# Therefore only the cases that test the default, and vehicles with a flash memory, use the default.
GUARD = 1000 if CASE in ("plain", "stopped", "update") else 20
SIMULATOR, PING = BUILD / "testbench/sim/icesoc-sim", BUILD / "sw/ground/ground_ping"
CLIENTS = TREE / "sw/ground/clients"
INTERFACE = ("--plugin", BUILD / "ground", "--slice", TREE / "sw/vehicle/Autopilot.ice")
UPDATES = (CLIENTS / "update.py", "new.update", "--device", "{device}", "--plugin",
           BUILD / "ground", "--slice", TREE / "sw/update/Update.ice")
FIRMWARE, STAND_IN = BUILD / "firmware/uav.elf", BUILD / "testbench/stm32/stand_in_bitstream"
VEHICLE = "vehicle", BUILD / "firmware/loader.elf", FIRMWARE, "1"
KEY = "000102030405060708090a0b0c0d0e0f"
DEVICE = 'hwengine1:xbee-at -d "{device}" -a 0x0001 '


class Cases(Script):
    def setUp(self):
        self.out = fresh(sys.argv[2])
        os.environ["XDG_CONFIG_HOME"] = str(BUILD / "config")  # keys for the tests only
        self.keys = BUILD / "config/icesoc"

    def words(self, *options, out=None, image=IMAGE):
        return (TREE / "icesoc", "run", "--built", "--build", BUILD, "--out", out or self.out,
                "--size", "96x64", "--guard", str(GUARD), "--image", image, *options)

    def fly(self, *options, out=None):
        """Flies a mission, which must succeed."""
        self.ask(*self.words(*options, out=out))
        self.flew(out or self.out)

    def flew(self, folder):
        for name in "after.png", "before.png":
            self.assertTrue((folder / name).stat().st_size)
        self.has("isAlive", file=folder / "report.md")

    def fails(self, said, *words):
        """Runs a command that must fail with this text and without a Python traceback."""
        self.ask(*words, status=None)
        self.has(said)
        self.lacks("Traceback")

    def refused(self, said, *options, **how):
        self.fails(said, *self.words(*options, **how))

    def simulator(self, *words, options=()):
        """Runs the simulator with a vehicle, and a program of the ground station."""
        return (SIMULATOR, "--image", IMAGE, "--size", "96x64", "--out", self.out, "--guard",
                str(GUARD), *options, "--", *words)

    def simulate(self, *words, options=(), **how):
        self.ask(*self.simulator(*words, options=options), **how)

    def replay(self, folder, *options, expected="the replay equals the recorded flight bit by bit"):
        """Replays the flight in a folder from its recording."""
        self.ask(SIMULATOR, "--out", "replay", "--replay", folder, *options)
        self.has(expected)

    def test_plain(self):
        """The link is encrypted by default, and only the user may read the recording and the
        key."""
        self.make("run", f"IMAGE={IMAGE}", "SIZE=96x64", f"OUT={self.out}", build=BUILD)
        self.flew(self.out)
        self.has("121 corners test only a part of the core: ./icesoc core test vision")
        # The ground first waits until the modem is set up, then for the vehicle.
        steps = re.findall("modem ready on .* after [0-9]* ms|link connecting|link up, secure|"
                           "the UAV has .* s to answer", self.said)
        self.assertEqual([step.split()[0] for step in steps][:4], ["the", "modem", "link", "link"])
        self.has(f'"key":"{self.keys}/demo.key"', file="flight.jsonl")
        for file in Path("flight.jsonl"), self.keys / "demo.key":
            self.assertEqual(file.stat().st_mode & 0o777, 0o600)

    def test_open(self):
        """With --open, a flight is not encrypted. The picture of this flight is noise, with some
        29,700 corners."""
        Path("noise.pgm").write_bytes(b"P5 640 480 255\n" + random.Random(1).randbytes(307200))
        self.fly("--open", "--image", self.out / "noise.pgm", "--size", "640x480")
        self.has('"key":""', file="flight.jsonl")

    def test_keys(self):
        """Unsuitable keys cause error messages when a mission starts, in a session with the
        vehicle, and when only the ground's program starts."""
        os.umask(0o077)
        for name, text in ("a", KEY), ("b", KEY[:-1] + "e"), ("short", KEY[:10]):
            write(f"{name}.key", text + "\n")
        shutil.copy("a.key", "others.key")
        os.chmod("others.key", 0o644)
        for name, said in (("short", "32 hexadecimal digits"), ("others", "chmod 600"),
                           ("no", "create one with ./icesoc key '.*no.key'")):
            self.refused(said, "--key", f"{name}.key")
        # The vehicle accepts no session if the ground has another key or no key.
        for key in self.out / "b.key", "":
            self.simulate(PING, DEVICE + "-g {guard} -t 3000", "1", f"--XBeeAT.KeyFile={key}",
                          "--Ice.RetryIntervals=-1", options=("--key", "a.key"), status=None)
            self.has("timeout while establishing a connection")
        for name, said in ("others", "chmod 600"), ("no", "openssl rand"):
            self.fails(said, PING, "hwengine1:xbee-at -d /dev/null", "1",
                       f"--XBeeAT.KeyFile={self.out}/{name}.key")

    def test_call(self):
        """A call from the command line reaches a vehicle with the same key, and gets the reason if
        a core refuses it. A vehicle with another key does not answer."""
        os.umask(0o077)
        for name, text in ("a", KEY), ("b", KEY[:-1] + "e"):
            write(f"{name}.key", text + "\n")
        call = (TREE / "icesoc", "call", "--build", BUILD, "--device", "{device}", "--guard",
                "{guard}", "--key")
        self.simulate(*call, self.out / "a.key", "uav.isAlive", "7", options=("--key", "a.key"))
        self.has("^true$")
        self.simulate(*call, self.out / "a.key", "ascon.setKey", "[1, 2, 3]", status=6,
                      options=("--key", "a.key"))
        self.has("ascon.setKey: the call was refused: key: expected 16 bytes")
        self.simulate(*call, self.out / "b.key", "uav.isAlive", "7", "--timeout", "3", status=4,
                      options=("--key", "a.key"))
        self.has("no answer from the vehicle 0x0001 at .* within 3 s; check that it is switched on")

    def test_loss(self):
        """A flight with packet loss can be replayed from its recording, as a user does to find the
        cause of a failure."""
        self.fly("--loss", "0.1", "--seed", os.environ.get("SEED", "1"))
        self.replay(self.out, "--from", "0.5", "--to", "0.51")
        # The simulator rejects the replay of a recording that has been altered or belongs to
        # another file, and a replay into the folder of the recording. If a recording ends early
        # because its flight was killed, the simulator replays the part that exists. Waveforms need
        # another build.
        flight = Path("flight.jsonl").read_text()
        for folder, text in (("cut", flight[:len(flight) // 2]),
                             ("other", flight.replace('"up":"2b', '"up":"2c'))):
            write(f"{folder}/flight.jsonl", text)
            shutil.copy("before.png", folder)
        self.replay("cut", expected="the recording ends here")
        replay = SIMULATOR, "--out", "replay", "--replay"
        self.fails("the replay differs from the recorded flight between", *replay, "other")
        write("other/flight.jsonl", '{"no": "flight"}\n')
        self.fails("expected the recording of a flight, line 1", *replay, "other")
        self.fails("--out: expected a folder other than the recording's", SIMULATOR, "--replay",
                   self.out, "--out", self.out)
        self.fails("expected a flight with the ARM binary", *replay, self.out, "--gdb", "0")
        self.fails("cannot write waveforms", *replay, self.out, "--wave", "wave.fst")

    def test_cores(self):
        """A mission calls every core that has a program ground.py."""
        listed = re.findall(r"^\w+", (TREE / "ip/cores.list").read_text(), re.M)
        parts = [core for core in listed if (TREE / f"ip/{core}/ground.py").exists()]
        self.fly("--cores", " ".join(parts))
        self.has(*(rf"{part}\." for part in parts), file="report.md")

    def test_sensor(self):
        """The picture comes from the camera pins to the vision core; the processor never reads
        it."""
        self.fly("--camera", "--cpu", "m3")
        self.has(r"camera.capture\(96, 64\)", file="report.md")

    def test_m3(self):
        """A flight can run the ARM binary. Its replay shows the tasks of the program in the 2 ms
        around the first event of a core."""
        self.fly("--cpu", "m3")
        self.has('"task":"UAV_radioTask"', file="events.jsonl")
        first = re.search(r'\{"events":\d*,"ns":(\d*)\d,"slot":[2-9]\}',
                          Path("events.jsonl").read_text())
        start, wave = int(first[1]), self.out / "wave"
        os.environ.update(WAVE=str(wave), WAVE_FROM=str(start - 20000),
                          WAVE_TO=str(start + 200000))
        self.replay(self.out, "--from", "0.5", "--to", "0.51")
        self.has("^sEXTI0_Handler.program.interrupt$", "^sPendSV_Handler.program.function$",
                 "^sUAV_coresTask.program.task$", "^sFSMC_read.*.program.function$",
                 file=f"{wave}.program.vcd")

    def patched(self, name, symbol, offset, value):
        """Writes a copy of the firmware in which the bytes at `symbol` + `offset` are replaced by
        `value`."""
        shutil.copy(FIRMWARE, name)
        there = f"{{unsigned char[{len(value)}]}}((char*)&{symbol} + {offset})"
        self.ask("gdb-multiarch", "-nx", "-batch", "--write", name, "-ex",
                 f"set var {there} = {{{', '.join(map(str, value))}}}")
        self.ask(BUILD / "sw/update/pack_update", "stamp", name)

    def test_other_chip(self):
        """If the firmware was built for other registers of the vision core, the firmware does not
        offer the core, and reports the reason to the ground."""
        lines = (BUILD / "gen/soc_cores.c").read_text().split("hw_contracts[")[1].split("\n")[1:]
        row = 1 + next(n for n, line in enumerate(lines) if '"vision"' in line)
        # the last word of the vision core's row, which is the hash of its registers
        self.patched("other.elf", "hw_contracts", 20 * row - 4, b"\xff" * 4)
        self.refused("no object 'hwengine1'; vision: expected registers with hash 0xFFFFFFFF, as "
                     "the firmware was built for, got 0x.* in the chip: rebuild both from the same "
                     "ip/cores.list", "--cpu", "m3", "--firmware", "other.elf")

    def pack(self, *words):
        self.ask(BUILD / "sw/update/pack_update", *words)

    def update(self, file, *said, status=0):
        self.ask(*self.words("--cpu", "m3", "--update", file), status=status)
        self.has(*said)
        self.lacks("Traceback")

    def test_update(self):
        """Updates the firmware: with a wrong file, in a vehicle with another key, and with a loss
        of power during the update."""
        self.update(TREE / "Makefile", "not a 32-bit ARM ELF file", status=None)
        flash = Path("flash.bin")
        self.pack(*VEHICLE, "other.key", flash)
        self.ask(STAND_IN, "golden.bin", "1", "10000")
        self.pack("fpga", "golden.bin", "1", "other.key", "fpga.bin")
        before = flash.read_bytes()
        self.update(FIRMWARE, "not signed with one of the vehicle's keys", status=None)
        self.assertEqual(flash.read_bytes(), before)
        Path("fpga.bin").unlink()
        Path("cut.update").write_bytes(Path("new.update").read_bytes()[:50000])
        self.fails("expected a complete package", CLIENTS / "update.py", "cut.update", "--slice",
                   UPDATES[-1])
        self.pack(*VEHICLE, self.keys / "update.key", flash)
        stored = "--cpu", "m3", "--flash", flash
        self.simulate(*UPDATES, options=(*stored, "--duration", "8"), status=None)
        self.has("the vehicle runs version 1$")
        self.assertNotEqual(flash.read_bytes(), before)
        for _ in range(2):
            self.update(FIRMWARE, "runs and is confirmed", "1 software, 0 watchdog")
        self.a_stolen_key(flash, stored)
        self.big_and_broken(flash)
        self.bitstreams(stored)

    def a_stolen_key(self, flash, stored):
        """Sends firmware that is signed with the second key, then a list of keys that does not
        contain the first key."""
        signing = self.keys / "spare.key"
        key = TREE / "icesoc", "key", "--built", "--build", BUILD
        self.ask(*key, signing, "--signing")
        self.pack(*VEHICLE, self.keys / "update.key", flash, "--second", self.keys / "spare.pub")
        self.pack("image", FIRMWARE, str(int(time.time())), signing, "spare.update")
        self.ask(*key, self.out / "list.update", "--list", "2", "--by", signing, "--first",
                 self.keys / "spare.pub")
        with open("spare.update", "ab") as file:
            file.write(Path("list.update").read_bytes())
        self.simulate(*(str(word).replace("new.update", "spare.update") for word in UPDATES),
                      options=stored)
        self.has("runs and is confirmed", "accepts packages signed with the keys of list 2")
        self.update(FIRMWARE, "not signed with one of the vehicle's keys", status=None)

    def big_and_broken(self, flash):
        """Sends 256 KiB, which fill three sectors, within 30 s of air time. Then sends firmware
        that crashes at its start; the vehicle must return to the previous firmware by itself."""
        self.ask(TREE / "tests/e2e/mission/big_firmware.sh", BUILD, self.out / "big.elf", "262144")
        self.pack(*VEHICLE, self.keys / "update.key", flash)
        with open(flash, "r+b") as file:
            file.seek(4 * 128 * 1024)
            file.write(os.urandom(3 * 128 * 1024))
        self.update("big.elf", "runs and is confirmed")
        sent = re.search(r"sent 262144 bytes in (.*)", self.said)[1]
        self.assertLessEqual(float(re.search(r"[\d.]+", sent)[0]), 30)
        self.patched("crashes.elf", "Program_run", 0, b"\xff\xde")  # UDF
        self.update("crashes.elf", "was received and verified; the vehicle starts it",
                    "was started, then replaced by the old one",
                    "2 software, 0 watchdog", status=None)

    def bitstreams(self, stored):
        """Updates the bitstream of a vehicle with an empty FPGA flash: with a file that is not a
        bitstream, with one that the FPGA rejects, with one that is never confirmed, and with one of
        full size."""
        self.update(BUILD / "firmware/uav.bin", "got no sync word", status=None)
        self.ask(STAND_IN, "new.bin", "2", "10000")
        damaged = bytearray(Path("new.bin").read_bytes())
        damaged[9000] = ord("x")
        Path("damaged.bin").write_bytes(damaged)
        self.update("damaged.bin", "the FPGA has not accepted the bitstream", status=None)
        self.pack("bitstream", "new.bin", str(int(time.time())), self.keys / "update.key",
                  "new.update")
        self.simulate(*UPDATES, "--rehearse", options=(*stored, "--fpga-flash", "fpga.bin"))
        self.has("runs and is not confirmed", "the vehicle runs version 1$")
        self.ask(STAND_IN, "full.bin", "3")
        for bits in "new.bin", "full.bin":
            self.update(bits, "runs and is confirmed")

    def test_slow(self):
        """On a machine that is four times too slow, the ground follows the simulator clock, so
        the modem answers within the usual time."""
        self.fly()  # this flight writes the flight.json that is used below
        Path("after.png").unlink()
        self.ask(SIMULATOR, "--flight", "flight.json", "--speed", "0.25", "--", "/usr/bin/python3",
                 CLIENTS / "mission.py", "flight.json", "--device", "{device}", "--frame",
                 "{frame}", "--status", "{status}", *INTERFACE, "--trace", "2")
        self.assertEqual(len(re.findall(r".*\+\+\+ at", self.said)), 2)
        self.assertTrue(Path("after.png").stat().st_size)

    @contextlib.contextmanager
    def until(self, said, *words):
        """Starts a process and returns it as soon as it has printed this text."""
        with open("log", "w") as log:
            process = subprocess.Popen(words, stdout=log, stderr=log)
        try:
            while said not in Path("log").read_text():
                self.assertIsNone(process.poll(), Path("log").read_text())
                time.sleep(0.02)
            yield process
        finally:
            process.terminate()
            process.wait()

    def test_stopped(self):
        """If the ground is stopped for four seconds during the set-up, simulated time waits for
        it."""
        with self.until("+++ at 9600 baud: OK", *self.simulator(
                PING, DEVICE + "-t 300000", "3", "--XBeeAT.Trace=2")) as simulator:
            ground = int(subprocess.check_output(["pgrep", "-P", str(simulator.pid)]))
            os.kill(ground, signal.SIGSTOP)
            time.sleep(4)
            os.kill(ground, signal.SIGCONT)
            self.assertEqual(simulator.wait(), 0, Path("log").read_text())
        seconds = re.search(r": ([\d.]+) s simulated", Path("log").read_text())
        self.assertLess(float(seconds[1]), 5)

    def test_encrypted(self):
        """Both modems have the same AES key: --modem-key sets it in the vehicle's modem, and -k in
        the endpoint sets it in the ground's modem. This case also uses the C++11 library of the
        plugin, a C++ client, and a proxy that is converted to a string and back."""
        key = "00112233445566778899AABBCCDDEEFF"
        self.simulate(PING, f"{DEVICE}-k {key} -p 2 -g {{guard}} -t 300000", "3",
                      options=("--modem-key", key))
        self.has("type: ::Autopilot::HwProcessingEngine", "-a 0x1 .*-p 2")
        self.lacks(key)

    def test_new_key(self):
        """A key can be replaced over the link; after that, no session can be opened with the old
        key."""
        os.umask(0o077)
        write("the.key", f"0x0001 {KEY}\n")
        self.simulate("/usr/bin/python3", CLIENTS / "change_key.py", "--device", "{device}",
                      "--guard", "{guard}", "--key", "the.key", *INTERFACE,
                      options=("--key", "the.key"))
        self.has("have a new key")
        self.assertEqual(Path("the.key").stat().st_mode & 0o777, 0o600)
        self.has("^0x0001 [0-9a-f]{32}$", file="the.key")
        self.lacks("000102030405", "the.key")

    def test_gateway(self):
        """Two clients of stock Ice call at the same time, through TCP."""
        self.simulate(TREE / "tests/e2e/mission/gateway.sh", BUILD, "{device}", "{guard}", self.out)

    def test_wire(self):
        """A cable can replace the modems: in a flight with the Cortex-M3, in the replay of this
        flight, and in calls through the gateway to the host build of the firmware."""
        self.fly("--wire", "--cpu", "m3")
        self.replay(self.out)
        self.has(" 0 packets on the air")
        self.simulate(TREE / "tests/e2e/mission/gateway.sh", BUILD, "{device}", "{guard}",
                      self.out, "--wire", options=["--wire"])
        self.refused("without modems and radio: leave out --loss", "--wire", "--loss", "0.1")

    def test_fleet(self):
        """Four vehicles share one modem; the first of them runs the host build of the firmware. The
        flight is then replayed. The first vehicle calls the second one and reports the answer to
        its ground station."""
        vehicles = 1, 2, 3, 4
        Path("fleet.key").write_text("".join(f"0x000{at} {str(at) * 32}\n" for at in vehicles))
        os.chmod("fleet.key", 0o600)
        self.fly("--vehicles", "4", "--key", self.out / "fleet.key")
        self.has("vehicleState.*, fellowState 1")
        for address in vehicles:
            self.has(f"the observer sees uav{address}: {'flying' if address == 2 else 'onGround'}")
        for address in vehicles[1:]:
            self.has(f"XBeeAT: 0x000{address}: link up, secure",
                     rf"uav{address}\.hwengine1: \d+ corners")
            self.assertTrue(Path(f"after{address}.png").exists())
        self.replay(self.out)
        self.refused("leave out --wire", "--vehicles", "2", "--wire")

    def test_twice(self):
        with self.until("", *self.words(out=self.out / "a")) as first:
            self.fly("--threshold", "50", out=self.out / "b")
            self.assertEqual(first.wait(), 0, Path("log").read_text())
        self.flew(self.out / "a")

    def test_odd_names(self):
        """The name of the output folder may contain special characters of the shell, of make and of
        the simulator."""
        hit = self.out / "oops"
        odd = f"a'b \"c\" {{device}} {{out}}x `touch {hit}` $(touch {hit})"
        self.fly(out=self.out / odd)
        self.assertFalse(hit.exists())

    def test_mistakes(self):
        """A start that fails changes nothing in the folder. The tested mistakes are a wrong
        picture, a wrong description of the flight, a wrong port, and a port without a modem. The
        two wrong ports are tested with the ground's program alone, without a simulator."""
        write("mine/report.md", "mine\n")
        shutil.copy("mine/report.md", ".")
        os.symlink(self.out / "mine/report.md", "calls.jsonl")
        write("bad.png", "this is not a picture\n")
        self.refused("expected a PNG, JPEG or PGM file", image="bad.png")
        # if the page had been started, its address would have been printed before this error
        self.lacks("127.0.0.1")
        for name in "report.md", "calls.jsonl":
            self.assertEqual(Path(name).read_text(), "mine\n")
        for text in '"text"', "[", "[{}]":
            write("bad.json", text)
            self.fails("'bad.json': expected a flight", SIMULATOR, "--flight", "bad.json")
            self.lacks("exception")
        flight = dict(threshold=24, loss=0, guard=20, patience=300, key="", camera=False, cores=[],
                      wire=False, vehicles=1, observer="", out=str(self.out))
        client = ["/usr/bin/python3", CLIENTS / "mission.py", "flight.json", *INTERFACE,
                  "--frame", "none", "--device"]
        write("flight.json", json.dumps(flight))
        self.fails("'flight.json': expected a flight .*; the member 'live' is missing", *client,
                   "none")
        write("flight.json", json.dumps({**flight, "live": False}))
        _, silent = pty.openpty()  # a port that no other test has open
        for device, said in (("/dev/no-such-port", "cannot open serial port '/dev/no-such-port'"),
                             (os.ttyname(silent), "no modem answers on")):
            self.fails(said, *client, device)

    def test_interrupted(self):
        with self.until("setting the ground", *self.words()) as run:
            self.refused("another flight is in progress")
            # Interrupts only the simulator, because Ctrl-C would reach all processes.
            self.ask("pkill", "-INT", "-f", f"icesoc-sim.*{self.out}")
            self.assertEqual(run.wait(), 130, Path("log").read_text())
        # The failed mission prints a command that shows the end of the flight.
        span = re.search(f"^To write a waveform of its end: ./icesoc run --replay {self.out} "
                         r"--from ([\d.]+) --to ([\d.]+)$", Path("log").read_text(), re.M)
        self.replay(self.out, "--from", span[1], "--to", span[2],
                    expected="the recording ends here|bit by bit")
        self.ask("pgrep", "-f", f"mission.py.*{self.out}", status=1)  # the ground station has ended


main(Cases)
