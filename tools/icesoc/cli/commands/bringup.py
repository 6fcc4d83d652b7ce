# SPDX-License-Identifier: MIT
"""bringup: runs the self-test of a new board, on the board or on a simulated one."""
import datetime
import os
import select
import shlex
import subprocess
import termios
import time
from pathlib import Path

from icesoc import TREE
from icesoc.board import bringup, firmware, make
from icesoc.cli.build_folder import BuildFolder
from icesoc.cli.command import command
from icesoc.cli.commands.board import NAME, read
from icesoc.cli.options import (BUILD, FOLDER, JOBS, SECONDS, SWITCH, TEXT, WORDS, Option)
from icesoc.util.console import say
from icesoc.util.errors import Stop

CALL_TIMEOUT = 30  # s; time-out of a call
BREAK_SECONDS = 1.0  # s; duration of the break on the serial line before the reset
LOAD_TIMEOUT = 120  # s; time-out of OpenOCD and of the program that makes a call
SILENCE = 60  # s; the report ends if the console prints no line for this time
CONSOLE = "/dev/ttyUSB0"


@command("board bringup", [
    NAME,
    Option("simulated", SWITCH, "run the self-test on a simulated board"),
    Option("fault", WORDS, "with --simulated: faults of the board, such as D3:open D1-D2:short "
                           "NWE:late=12ns (docs/simulation.md)"),
    Option("device", TEXT, "serial port of the board's console", CONSOLE),
    Option("cable", TEXT, "serial port of a cable that replaces the modem (docs/modem.md); "
                          "the command then loads the firmware and calls it instead of running "
                          "the self-test", ""),
    Option("listen", SWITCH, "only read the console, for a self-test that was started by hand"),
    Option("silence", SECONDS, "end the report after this time without output from the board",
           SILENCE),
    Option("out", FOLDER, "folder of the report (default: build/board/NAME)", ""),
    BUILD, JOBS],
         examples=["board bringup nucleo-qmtech --simulated",
                   "board bringup nucleo-qmtech --simulated --fault D3:open",
                   "board bringup nucleo-qmtech --device /dev/ttyUSB0",
                   "board bringup nucleo-qmtech --cable /dev/ttyUSB1"],
         brief="board bringup nucleo-qmtech --simulated --out build/brief/bringup")
def board_bringup(values):
    """test a new board: name each bad wire, and write a report

    Loads the self-test into the microcontroller's RAM by OpenOCD, listens to the console, and
    writes OUT/bringup.html and OUT/bringup.json. Run this command twice: first with the bitstream
    of synth/ise/lines.v in the FPGA, which tests the wires, then with the chip's bitstream. Then
    run the command with --cable, to load the firmware and to call it over a serial cable. With
    --simulated, all of this runs on a model of the board."""
    board = read(values)
    folder = Path(values.out or f"build/board/{board.name}")
    report = bringup.Report(board)
    report.data["date"] = datetime.datetime.now().strftime("%Y-%m-%d %H:%M")
    build = BuildFolder(values.build, values).prepare().for_vehicle(values.name)
    report.data["modem"] = board.modem or "unknown"
    if values.simulated:
        build.ninja("icesoc-bringup", "firmware_bringup_flash", "firmware_uav")
        report.data["how"] = " ".join(["Simulated.", *values.fault])
        simulated(values, build, report)
    elif values.cable:
        report.data["how"] = f"Board with a cable at {values.cable}."
        build.ninja("firmware_uav", "xbeeat")
        over_cable(values, build, report, folder)
    else:
        report.data["how"] = f"Board at {values.device}."
        on_board(values, build, report, folder)
    for path in bringup.write(report, folder):
        say(str(path))
    result = report.data["result"]
    if result == "stopped":
        step = report.steps[-1]["name"] if report.steps else "the start"
        raise Stop(f"board bringup: the self-test stopped in {step}: expected a line END, got no "
                   "further line; reset the board and run the command again")
    if result == "failed":
        raise Stop(f"board bringup: {len(report.failures)} failures: "
                   + ", ".join(f"{f['wire']} {f['kind']}" for f in report.failures))
    say("passed")


def follow(report, line):
    if text := report.take(line):
        say(text)


def simulated(values, build, report):
    """Runs the self-test on the models (testbench/wires)."""
    words = [build / "testbench/wires/icesoc-bringup", build / "firmware/bringup_flash.elf",
             build / "firmware/uav.elf"]
    for fault in values.fault:
        words += ["--fault", fault]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
        for line in process.stdout:
            follow(report, line)
    if process.returncode not in (0, 1):
        raise Stop("board bringup: the simulated board ended with the error above")


def on_board(values, build, report, folder):
    """Starts the self-test in RAM by OpenOCD, and reads the console."""
    build.ninja("firmware_bringup")
    make.write({"openocd.cfg": firmware.openocd(report.board)}, folder)
    elf = build / "firmware/bringup.elf"
    start = ["openocd", "-f", str(folder / "openocd.cfg"), "-c",
             f"init; reset halt; load_image {elf}; "
             "set v [read_memory 0x20000000 32 2]; reg msp [lindex $v 0]; "
             "resume [lindex $v 1]; shutdown"]
    try:
        port = os.open(values.device, os.O_RDONLY | os.O_NOCTTY | os.O_NONBLOCK)
    except OSError as error:
        raise Stop(f"board bringup: cannot open the console {values.device}: {error.strerror}; "
                   "give its name by --device") from None
    try:
        set_rate(port)
        say("$ " + shlex.join(start))
        if not values.listen and not started(start):
            raise Stop("board bringup: OpenOCD failed (above); start the self-test by hand and use "
                       "--listen")
        listen(port, values.silence, report)
    finally:
        os.close(port)


def started(words):
    """Runs OpenOCD; returns whether it has loaded the program."""
    try:
        return subprocess.run(words, check=False, timeout=LOAD_TIMEOUT).returncode == 0
    except FileNotFoundError:
        raise Stop("board bringup: expected the program openocd, got none in PATH; install "
                   "openocd") from None
    except subprocess.TimeoutExpired:
        return False


def ended(words, meanwhile=None):
    """Runs a program, and calls `meanwhile` once while the program runs. Returns the reason if one
    of them fails, otherwise an empty text."""
    say("$ " + shlex.join(map(str, words)))
    try:
        with subprocess.Popen([str(word) for word in words]) as process:
            try:
                failed = meanwhile() if meanwhile else ""
                status = process.wait(LOAD_TIMEOUT)
            except subprocess.TimeoutExpired:
                process.kill()
                return f"{Path(words[0]).name} did not end within {LOAD_TIMEOUT} s"
    except OSError as error:
        return f"{Path(words[0]).name}: {error.strerror}"
    return failed or (f"{Path(words[0]).name} ended with status {status}" if status else "")


def over_cable(values, build, report, folder):
    """Loads the firmware, sets the vehicle to open mode over the console, and calls it over a
    cable. Adds this as the last step of the report."""
    make.write({"openocd.cfg": firmware.openocd(report.board)}, folder)
    follow(report, "STEP call: the firmware answers a call over a cable in the modem's place")
    openocd = ["openocd", "-f", folder / "openocd.cfg", "-c"]
    begin = time.monotonic()

    def restart():
        time.sleep(BREAK_SECONDS)  # the line is then in the break state
        return ended([*openocd, "init; reset run; shutdown"])

    steps = [
        ("MCU", lambda: ended([*openocd,
                               f"program {build / 'firmware/uav.elf'} verify reset exit"]),
         "the message of OpenOCD; both jumpers of ST-LINK (CN4)"),
        ("CONSOLE_TX-CONSOLE_RX",
         lambda: ended([TREE / "sw/ground/clients/provide_key.py", "--port", values.device,
                        "--open"], restart),
         "the console; JUMPER_OPEN, if the vehicle has a key"),
        ("MODEM_TXD-MODEM_RXD",
         lambda: ended([TREE / "icesoc", "call", "--device", values.cable, "--wire", "--timeout",
                        CALL_TIMEOUT, "hwengine1.ice_ping"]),
         "JUMPER_WIRED; TXD and RXD of the cable are crossed; RTS and CTS; its rate of 111,111 "
         "baud")]
    for wire, run, check in steps:
        if failed := run():
            follow(report, f"FAIL call {wire} silent: {failed}; check: {check}")
            follow(report, "END 1")
            return
    follow(report, f"PASS call: answered after s: {time.monotonic() - begin:.1f}, with loading")
    follow(report, "END 0")


def set_rate(port):
    """Sets a serial port to 115,200 baud, 8N1, raw."""
    if not os.isatty(port):
        return
    state = termios.tcgetattr(port)
    state[0], state[1], state[3] = 0, 0, 0
    state[2] = termios.CS8 | termios.CREAD | termios.CLOCAL
    state[4] = state[5] = termios.B115200
    termios.tcsetattr(port, termios.TCSANOW, state)


def listen(port, silence, report):
    """Reads lines until END, or until no line arrives for `silence` seconds."""
    pending, until = b"", time.monotonic() + silence
    while time.monotonic() < until:
        if not select.select([port], [], [], 0.5)[0]:
            continue
        try:
            got = os.read(port, 4096)
        except OSError:  # the adapter was unplugged
            got = b""
        if not got:
            return
        pending += got
        *lines, pending = pending.split(b"\n")
        for line in lines:
            until = time.monotonic() + silence
            follow(report, line.decode("ascii", "replace"))
            if report.data["result"] != "stopped":
                return
