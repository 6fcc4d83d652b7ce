# SPDX-License-Identifier: MIT
"""flights: commands that fly the mission, repeat and debug a flight, send new firmware, and fly for
hours."""
import os
import re
import resource
import signal
import sys
import tempfile
import time
from pathlib import Path

from icesoc.call.objects import VEHICLES, VIEWED
from icesoc.cli import flight, keys
from icesoc.cli.build_folder import BuildFolder, configured, netlists
from icesoc.cli.command import command
from icesoc.cli.options import (BUILD, FAMILY, FLIGHT, FOLDER, JOBS, MINUTES, SECONDS, SEED,
                                SWITCH, Option, one_of)
from icesoc.util.console import say, warn
from icesoc.util.errors import Interrupted, Stop
from icesoc.util.lock import lock
from icesoc.util.process import end, run, start, tool, until, wait
from icesoc.util import spelling
from icesoc.util.spelling import option, switch

FROM = Option("from", SECONDS, "start of the waveform, simulated time")
TO = Option("to", SECONDS, "end of the waveform, simulated time")
DESCRIPTORS = 64  # file descriptors per process; the ground program needs about thirty
NETLIST = Option("netlist", SWITCH, "fly the netlist synthesised by Yosys; the chip runs at 2 "
                                    "MHz, and no idle clock cycles are skipped")
NETLIST_HZ = 2000000
BRIDGE = Option("bridge", one_of("async", "sync"), "FSMC bridge of the simulated chip; sync: the "
                                                   "bridge that samples its pins (docs/fsmc.md), "
                                                   "built in build/sync", "async")
SHOW = Option("show", one_of("auto", "yes", "no"),
              "open the page in a browser; auto: only if the command runs in a terminal and there "
              "is a display",
              "auto")
DEBUGGED = [option for option in flight.FIELDS if option.name in ("image", "size", "seed")]


@command("run", [*flight.OPTIONS, SHOW, NETLIST, FAMILY, BRIDGE, BUILD, JOBS], make="run",
         brief="run --size 96x64 --guard 20 --out build/brief/run",
         long=("run --netlist --size 96x64 --guard 20 --patience 3000 --out build/netlist/run",
               "run --netlist --family ecp5 --size 96x64 --guard 20 --patience 3000 "
               "--out build/netlist_ecp5/run"),
         examples=[
             "run --image photo.jpg --size 640x480", "run --loss 0.1 --seed 7 --cores ascon fir",
             "run --again build/run/flight.json"])
def fly_mission(values):
    """fly the mission: simulated UAV, radio, ZeroC Ice ground station

    Opens a page that shows the flight, or prints the page's address. After the mission, the vehicle
    keeps running while a browser shows the page, or with --live until Ctrl-C, so that you can call
    the vehicle from the page. OUT/flight.json describes the flight; --again repeats it.
    """
    descriptors = resource.getrlimit(resource.RLIMIT_NOFILE)[0]
    if descriptors < DESCRIPTORS:
        raise Stop(f"limit of file descriptors: expected at least {DESCRIPTORS}, got "
                   f"{descriptors}; raise it by ulimit -n {DESCRIPTORS}")
    if values.netlist and values.bridge == "sync":
        raise Stop(f"{switch('netlist')} and {option('bridge', 'sync')}: expected at most one of "
                   "the two, because netlists are only made of the chip with the other bridge", 2)
    flight.complete(values)
    board = flight.kit(values.board, values.described)
    if board and (values.netlist or values.bridge == "sync"):
        raise Stop(f"--board {board}: expected a board without multiplexed address and data, "
                   "because --netlist and --bridge sync fly only with such a board", 2)
    flight.check_chip(values, BuildFolder(values.build, values))
    build = BuildFolder(values.build, values).prepare()
    if values.netlist:
        values.clk_hz = min(values.clk_hz, NETLIST_HZ)
        chip, build = build, netlists(values)
        build.follow(chip)
    if not build.built:
        build.set(CLK_HZ=str(values.clk_hz))
    build.ninja("mission", *(["firmware_minimal"] if values.app == "minimal" else []),
                *(["gateway", "slice2c", "page_ice"] if values.live or opens(values) else []))
    values.chip = with_vehicle(build, board, values.bridge if "bridge" in values.given else "",
                               *["firmware_minimal"] * (values.app == "minimal"))
    flight.take_key(values, build)
    flight.take_observers_key(values)
    busy = (f"another flight is in progress in {values.out}; give this flight a separate folder: "
            f"{option('out', 'build/other')}")
    with lock(Path(values.out) / "lock", refuse=busy) as held:  # the lock is held until the last
                                                                # program has ended
        fly = minimal if values.app == "minimal" else update if values.update else mission
        return fly(values, build, held)


def with_vehicle(build, board, bridge, *firmware):
    """Returns the build folder that contains the simulator and the firmware of a board and a
    bridge, after building them; an empty text stands for the board or the bridge of `build`."""
    chip = build.for_vehicle(board, bridge)
    if chip is not build:
        kind = f"for the board {board}" if board else f"with the bridge '{bridge}'"
        say(f"building the simulator and the firmware {kind} ...")
        chip.ninja("icesoc-sim", "firmware_uav", "firmware_loader", *firmware)
    return chip


def with_recorded(build, folder):
    """Returns the build folder that contains the simulator and the firmware of a recorded flight,
    after building them."""
    head = flight.recorded(folder)
    if not build.built and "clkHz" in head:
        build.set(CLK_HZ=str(head["clkHz"]))
    build.ninja("mission")
    return with_vehicle(build, flight.kit(head.get("flight", {}).get("board", "")),
                        head.get("bridge", ""))


def simulator(values, held, options, ground):
    """Starts the simulator, which starts the ground program `ground` as its child. In the command
    line of the ground program, the simulator replaces words such as {out}."""
    flight.write(values, values.chip)
    return start([values.chip / "testbench/sim/icesoc-sim", "--flight",
                  Path(values.out) / "flight.json", *options, "--", "/usr/bin/python3", *ground],
                 pass_fds=[held], env={"PROBE": values.probe})


def minimal(values, build, held):
    """Flies the minimal program of Table II with its ground program."""
    return wait(
        simulator(values, held, [], [
            "sw/minimal/ground.py", "{device}", "--frame", "{frame}", "--reference",
            build / "testbench/sim/vision-reference",
            f"--Ice.Plugin.XBeeAT={build.folder}/ground/xbeeat:createXBeeAT",
            "--XBeeAT.Guard={guard}"]))


def update(values, build, held):
    """Sends firmware or a bitstream to a vehicle. OUT/flash.bin is the flash of the vehicle, and
    OUT/fpga.bin the flash of the FPGA; a missing file is created."""
    out, pack = Path(values.out), build / "sw/update/pack_update"
    keys.rescue(build.folder)
    signing = keys.folder() / "update.key"  # private key, created when it is first needed
    if not (out / "flash.bin").exists():
        chip = values.chip
        run([pack, "vehicle", chip / "firmware/loader.elf", flight.firmware(values, chip), 1,
             signing, out / "flash.bin"])
    # only ISE can make the golden bitstream, so a test bitstream is used instead
    if not (out / "fpga.bin").exists():
        run([build / "testbench/stm32/stand_in_bitstream", out / "golden.bin", 1, 10000])
        run([pack, "fpga", out / "golden.bin", 1, signing, out / "fpga.bin"])
    kind = "bitstream" if values.update.endswith((".bit", ".bin")) else "image"
    run([pack, kind, values.update, int(time.time()), signing, out / "new.update"])
    values.cpu = "m3"
    return wait(
        simulator(values, held,
                  ["--flash", out / "flash.bin", "--fpga-flash", out / "fpga.bin"], [
                      "sw/ground/clients/update.py", "{out}/new.update", "--device", "{device}",
                      "--status", "{status}", "--plugin", build / "ground", "--slice",
                      "sw/update/Update.ice", "--patience", values.patience,
                      *(["--key", values.key] if values.key else [])]))


def opens(values):
    """Returns whether a browser is opened with the page."""
    if values.show == "auto":
        display = os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
        return bool(display) and sys.stdout.isatty() and not values.app == "minimal"
    return values.show == "yes"


def mission(values, build, held):
    """Flies the mission that the README shows, with its page."""
    page = [*tool("web.live"), "--dir", values.out, "--port", values.port, "--build", build.folder]
    for name in VEHICLES, VIEWED:
        Path(values.out, name).unlink(missing_ok=True)
    before = begun(values)
    try_page(page)
    sim, shown = start_mission(values, build, held), None
    try:
        # Opening the page also prints its address. This is done only after the simulator has
        # accepted the options, because the address could hide an error message.
        if until(lambda: begun(values) != before, sim):
            shown = start([*page, *(["--open"] if opens(values) else [])], pass_fds=[held])
            watch_page(values, shown, sim)
        status = finish(values, sim)
    except Interrupted:
        end(sim)
        raise
    finally:
        if shown:
            end(shown)
    if status:
        explain_failure(values, status, has_flown=begun(values) != before)
    return status


def begun(values):
    """Returns the time at which the last flight began, or None."""
    status = Path(values.out, "status")
    return status.stat().st_ctime_ns if status.exists() else None


def flies_on(values):
    """Returns whether the mission has ended and its vehicle stays, to be called."""
    return Path(values.out, VEHICLES).exists()


def try_page(page):
    """Ends the command if the page refuses its options."""
    trial = run([*page, "--try"], check=False)
    if 0 < trial <= 128:
        raise Stop(status=trial)
    if trial:
        warn(f"the page's trial was ended by signal {trial - 128}; the mission continues")


def start_mission(values, build, held):
    """Starts the simulator with the ground program of the mission."""
    # A viewer sees the mission in real time; without one, nothing waits for the wall clock.
    speed = [] if values.live or opens(values) else ["--speed", "viewed"]
    return simulator(values, held, speed, [
        "sw/ground/clients/mission.py", "{out}/flight.json", "--device", "{device}", "--frame",
        "{frame}", "--status", "{status}", "--plugin", build / "ground", "--slice",
        "sw/vehicle/Autopilot.ice", "--reference", build / "testbench/sim/vision-reference",
        *(["--observer-device", "{device2}"] if values.vehicles > 1 else [])])


def watch_page(values, shown, sim):
    """Waits until the mission has ended or its page has failed."""
    if not until(lambda: sim.poll() is not None or flies_on(values), shown):
        ended = shown.returncode
        how = f"signal {-ended}" if ended < 0 else f"exit status {ended}"
        warn(f"the page has ended ({how}); the mission continues")


def finish(values, sim):
    """Waits until the flight has ended. Returns the simulator's exit status; 0 if the user has
    ended a flight with a finished mission."""
    out = values.out
    results = f"Pictures and report: {out}/before.png {out}/after.png {out}/report.md"
    if not until(lambda: flies_on(values), sim):
        status = wait(sim)
        if status == 0:
            say(results)
        return status
    say(results)
    say(f"The page stays until {'' if values.live else 'you close it, or '}Ctrl-C, and so does the "
        "vehicle: ./icesoc call --list")
    try:
        status = wait(sim)
    except Interrupted:
        status = 0
    say("The flight has ended.")
    return status


def explain_failure(values, status, has_flown):
    """Prints the reason why a mission failed, and the commands that repeat its end."""
    out = values.out
    signal_ended = f": signal {status - 128} ended the simulator, or the ground's program."
    what = signal_ended if status > 128 else f" (exit status {status})."
    text = f"The mission failed{what}\n"
    span = flight.last_span(out) if has_flown else None
    if has_flown and not span:
        text += (f"It cannot be replayed, because {out}/flight.jsonl is incomplete; check whether "
                 "the disk is full.\n")
    if span:
        end = spelling.command("run", option("replay", out), *span)
        text += f"To write a waveform of its end: {end}\n"
        if values.cpu == "m3":
            gdb = spelling.command("gdb", option("replay", out))
            text += f"To debug it backwards from its end: {gdb}\n"
    sys.stderr.write(text)


@command("replay", [
    Option("replay", FLIGHT, "folder of the flight", "build/run", positional=True), FROM, TO,
    Option("out", FOLDER, "output folder", "build/replay"), BUILD, JOBS], make="run",
         when="REPLAY", brief="replay build/brief/run --out build/brief/replay", examples=[
             "replay",
             "replay build/run --from 1.5 --to 1.51",
             "replay build/run --from 4.2 --out build/end"])
def replay(values):
    """repeat a recorded flight bit by bit, or write its waveform

    Without --from and --to, repeats the flight and compares every result. With one of them, writes
    the waveform of this part of the flight to OUT/wave.fst. The first time, it also builds a
    simulator that records waveforms. The waveform of a flight with --cpu m3 also shows the task,
    the interrupt and the function that the processor executes.
    """
    try:
        FLIGHT.read(values.replay)  # only a folder given by the user has already been checked
    except ValueError as error:
        raise Stop(str(error), 2) from None
    span = values.given & {"from", "to"}
    if span and values.to is not None and values.to <= (getattr(values, "from") or 0):
        raise Stop(f"{option('from', getattr(values, 'from'))} {option('to', values.to)}: expected "
                   "the start of the span before its end, in seconds", 2)
    build = BuildFolder(values.build, values).prepare()
    chip = with_recorded(build, values.replay)
    words = ["--replay", values.replay, "--out", values.out]
    if not span:
        return run([chip / "testbench/sim/icesoc-sim", *words], check=False)
    say("building the simulator that writes waveforms (build/trace) ...")
    trace = BuildFolder("build/trace", values)
    trace.configure("-DTRACE=ON")
    trace.follow(build, CLK_HZ=build.cached("CLK_HZ"), BOARD=chip.cached("BOARD"),
                 BRIDGE=chip.cached("BRIDGE"))
    trace.ninja("icesoc-sim")
    Path(values.out).mkdir(parents=True, exist_ok=True)
    wave = Path(values.out) / "wave.fst"
    run([
        trace / "testbench/sim/icesoc-sim", *words, "--wave", wave, "--from",
        getattr(values, "from") or 0, *(["--to", values.to] if values.to is not None else [])])
    run(["testbench/common/join_waves.sh", wave])
    say(f"Waveform: gtkwave {wave}")


@command("gdb", [
    Option("replay", FLIGHT, "folder of a recorded flight to debug forwards and backwards", ""),
    *DEBUGGED,
    Option("out", FOLDER,
           "output folder (default: build/run, or build/replay for a replay)"),
    BUILD, JOBS], make="gdb", brief="gdb --size 48x32 --out build/brief/gdb", examples=[
             "gdb",
             "gdb --replay build/run",
             "gdb --size 48x32 --seed 7"])
def gdb(values):
    """debug the firmware's ARM binary against the RTL with gdb-multiarch

    Starts a flight in which the debugger controls the processor; simulated time stops while the
    processor is stopped. With --replay it debugs a recorded flight, forwards and backwards.
    docs/firmware.md shows a session.
    """
    build = configured(values, tests=True)
    if values.replay:
        build = with_recorded(build, values.replay)
    else:
        build.ninja("mission")
    out = Path(values.out or ("build/replay" if values.replay else "build/run"))
    out.mkdir(parents=True, exist_ok=True)
    flown = ["--replay", values.replay] if values.replay else [
        "--cpu", "m3", "--image", values.image, "--size", values.size, "--seed", values.seed]
    with tempfile.TemporaryFile("w+") as log:
        sim = start([build / "testbench/sim/icesoc-sim", "--gdb", 0, "--speed", "max", "--out", out,
                     *flown], stdout=log, stderr=log)
        try:

            def text():
                log.seek(0)
                return log.read()

            until(lambda: "target remote" in text(), sim, 0.1)
            port = re.search(r"127.0.0.1:(\d+)'", text())
            print(text(), end="", flush=True)
            if not port:
                raise Stop(status=wait(sim) or 1)
            signal.signal(signal.SIGINT, signal.SIG_IGN)  # GDB uses Ctrl-C to stop the processor
            words = ["gdb-multiarch", "-q", build / "firmware/uav.elf", "-ex",
                     "set remotetimeout unlimited", "-ex", f"target remote 127.0.0.1:{port[1]}"]
            return run(words, check=False,
                       preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        finally:
            end(sim)


@command("fly", [
    Option("minutes", MINUTES, "simulated time; one hour takes about ten minutes of CPU time", 4.0),
    SEED, BUILD, JOBS], make="fly", brief="fly --minutes 0.01",
         long="fly --minutes 60 --seed {day}", examples=[
             "fly",
             "fly --minutes 60",
             "fly --seed 7"])
def fly_for_long(values):
    """fly for a long time, with packet loss and restarts

    Vehicle and ground station call each other while packets are lost, and vehicle, modems and
    ground station restart at random times. Prints the numbers of calls and restarts. Exit
    status 1: a call was lost without a report or executed twice, or a link did not recover.
    """
    build = configured(values, "test_chip_soak")
    run([build / "tests/sw/ground/chip/test_chip_soak", "--gtest_brief=1"], env={
        "SEED": values.seed, "SOAK_REST": 10, "SOAK_SECONDS": values.minutes * 60})
