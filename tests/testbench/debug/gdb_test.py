#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""gdb_test: tests the port of the simulator to which a debugger connects.

    debug      Debian's GDB controls firmware and RTL: breakpoints, steps, registers, memory, the
               FPGA
    reverse    GDB runs the recording of a secure flight backwards
    strangers  a peer that is not a debugger is disconnected; a peer that leaves or sends garbage
               makes room for the next one

Usage: gdb_test.py icesoc-sim firmware.elf out-folder case
"""
import contextlib
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import time

PATIENCE = 60  # time after which a program is considered to hang, s
sim, elf, out, case = sys.argv[1:]
FLIGHT = [sim, "--image", "/usr/share/xplanet/images/earth.jpg", "--size", "96x64", "--cpu", "m3",
          "--firmware", elf, "--speed", "max"]


@contextlib.contextmanager
def simulator(*command):
    """Starts a simulator that waits for a debugger. Yields the process and the port."""
    with subprocess.Popen([*command, "--gdb", "0"], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True) as process:
        try:
            said = ""
            for line in process.stdout:
                said += line
                if found := re.search(r"127.0.0.1:(\d+)'", line):
                    break
            else:
                sys.exit(f"no port for a debugger:\n{said}")
            yield process, int(found[1])
        finally:
            process.kill()


def gdb(port, commands):
    """Runs GDB with these commands, one per line. Returns its output."""
    script = pathlib.Path(out, "commands")
    script.write_text("set confirm off\nset width 0\nset remotetimeout unlimited\n"
                      f"target remote 127.0.0.1:{port}\n{commands}kill\n")
    done = subprocess.run(["timeout", "600", "gdb-multiarch", "-nx", "-batch", "-x", script, elf],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    print(done.stdout)
    return done.stdout


def debug():
    with simulator(*FLIGHT, "--duration", "30", "--out", out) as (process, port):
        said = gdb(port, r"""monitor reset
maintenance flush register-cache
echo START \n
info symbol $pc
break UAV_start
continue
print board_fsmc.read32
stepi
stepi
info symbol $pc
break SysTick_Handler
continue
backtrace 1
print $xpsr & 0x1ff
print/x $control
print $msp != $psp
x/1xw 0x64000000
x/1xw 0xe000ed00
print boot_record.starts
set var boot_record.starts = 77
print boot_record.starts
set $r12 = 0x1234
print/x $r12
finish
delete
monitor info
monitor reset
info symbol $pc
""")
        process.wait(PATIENCE)
    for wanted in ("^Reset_Handler in section .text", "^Breakpoint 1, UAV_start",
                   r"^UAV_start \+ [24] in section .text", "^Breakpoint 2, .*SysTick_Handler",
                   "^#0 .*SysTick_Handler", "= 15$",
                   "^0x64000000:.*0x5359",      # the register ID of the system slot
                   "^0xe000ed00:.*0x412fc230",  # a Cortex-M3
                   "= 77$", "= 0x1234$", "s simulated, .* instructions"):
        assert re.search(wanted, said, re.M), f"expected: {wanted}"


def reverse():
    key = pathlib.Path(out, "a.key")
    key.write_text("000102030405060708090a0b0c0d0e0f\n")
    key.chmod(0o600)
    subprocess.run([*FLIGHT, "--duration", "0.3", "--key", key, "--out", f"{out}/flight",
                    "--quiet"], check=True)
    # From a given place, "continue" must always lead to the same place.
    steps = (("reverse-stepi", "AT_BEGIN"), ("break UAV_start\ncontinue", "START"),
             ("delete\nstepi 20", "AHEAD"), ("reverse-stepi 20", "BACK"), ("stepi 20", "AGAIN"),
             ("continue", "END"),
             ("break SysTick_Handler\nreverse-continue", "TICK1"), ("reverse-continue", "TICK2"),
             ("set var boot_record.starts = 77\ncontinue", "TICK1_AGAIN"),
             ("reverse-finish\ninfo symbol $pc\ndelete\nbreak UAV_start\nreverse-continue",
              "START_AGAIN"))
    with simulator(sim, "--replay", f"{out}/flight", "--out", out) as (process, port):
        said = gdb(port, "".join(f"{commands}\necho {name} \\n\nmonitor info\n"
                                 for commands, name in steps) + "print boot_record.starts\n")
        assert process.wait(PATIENCE) == 0, "the simulator's exit status"
    at = {name: (int(instructions), int(cycles)) for name, instructions, cycles in
          re.findall(r"^(\w+) \n.*?simulated, (\d+) instructions, (\d+) cycles", said, re.M | re.S)}
    assert at["AT_BEGIN"] == (0, 0)
    for name, again in (("START", "BACK"), ("AHEAD", "AGAIN"), ("TICK1", "TICK1_AGAIN"),
                        ("START", "START_AGAIN")):
        assert at[name] == at[again], (name, at[name], again, at[again])
    assert at["TICK2"][0] < at["TICK1"][0] < at["END"][0], "ticks, the later one first"
    # GDB 13 prints the first of these messages, GDB 16 the second one.
    ends = re.findall("No more reverse-execution history|Reached end of recorded history", said)
    assert len(ends) == 2, "begin and end are not reported"
    assert not re.search("= 77$", said, re.M), "later data are visible earlier"
    # The checkpoints are frozen copies of the simulator's process. They end shortly after the
    # simulator.
    copies = ["pgrep", "-f", "--", f"--out {out} --gdb"]
    until = time.monotonic() + PATIENCE
    while subprocess.run(copies, stdout=subprocess.DEVNULL).returncode == 0:
        assert time.monotonic() < until, "a copy of the simulator was left behind"
        time.sleep(0.1)


def packet(text):
    return b"$%s#%02x" % (text, sum(text) & 255)


def strangers():
    with simulator(*FLIGHT, "--out", out) as (process, port):
        check(port)
        with socket.create_connection(("127.0.0.1", port), PATIENCE) as s:
            s.sendall(packet(b"k"))
            assert process.wait(PATIENCE) == 0


def check(port):
    def talk(*parts):
        """Sends bytes. Returns the answer, or b"" if the connection was closed."""
        with socket.create_connection(("127.0.0.1", port), PATIENCE) as s:
            answer = b""
            try:
                for part in parts:
                    s.sendall(part)
                while not re.search(rb"#..$", answer):
                    more = s.recv(1000)
                    if not more:
                        return b""
                    answer += more
            except ConnectionError:
                return b""
            return answer

    def leave(*parts):
        """Sends bytes, and disconnects."""
        with socket.create_connection(("127.0.0.1", port), PATIENCE) as s:
            for part in parts:
                s.sendall(part)
        assert talk(packet(b"?"))[:5] == b"+$T05", f"no debugger is served after {parts[0][:20]}"

    web = b"POST / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"
    assert talk(web + packet(b"k")) == b"", "a web page's request"
    assert talk(b"$" + b"m" * 100000) == b"", "a packet without an end"
    assert talk() == b"", "silence"
    for wrong in (b"m0,ffffffff", b"m", b"M0,5:00", b"M20000000,1:zz", b"pffffffffffffffff",
                  b"P19"):
        assert b"E01" in talk(packet(wrong)), wrong
    go = packet(b"?") + packet(b"c")
    leave(go)
    leave(packet(b"?") + b"$c")
    leave(go, packet(b"g") * 100)
    leave(go, b"k" * 100000)  # garbage arrives while the processor runs
    leave(packet(b"?") + packet(b"s") * 50)
    leave(packet(b"D"))
    with socket.create_connection(("127.0.0.1", port), PATIENCE) as s:
        s.sendall(go)
    assert talk(b"GET /") == b"", "the processor runs, and a web page comes"


shutil.rmtree(out, ignore_errors=True)
pathlib.Path(out).mkdir(parents=True)
{"debug": debug, "reverse": reverse, "strangers": strangers}[case]()
