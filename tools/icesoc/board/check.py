# SPDX-License-Identifier: MIT
"""check: finds what cannot work on a board, in words.

Each function yields sentences of the form "net D0: expected ..., got ...; what to do".
"""
import re

from icesoc.board.model import Board, Net
from icesoc.board.signals import BOTH, FPGA, MCU, MODEM, OTHER, SIGNALS, needed

IO_VOLTS = 3.3  # V; supply of I/O banks for LVCMOS33 (synth/ise/chip.ucf)
MOST_VOLTS = 3.6  # V; highest voltage at inputs of FPGA and modem, and at the MCU's VDD
MCU_HZ = 120_000_000  # CPU clock, sw/board/clock.h
SOC_HZ = 100_000_000  # clock of the chip, by MIG's PLL
# Balls that configure the FPGA at start; if one of them has the wrong level, the FPGA does not load
# its bitstream (UG380).
CONFIGURES = re.compile(r"HSWAPEN|_M0_|_M1_|CCLK|INIT_B|CSO_B|MOSI_CSI_B|DIN_MISO|PROGRAM|DONE")


def who(net: Net):
    return f"net {net.name}"


def complete(board: Board):
    """Finds signals without a net, nets that are listed twice, and nets without one of their
    ends."""
    seen = set()
    for net in board.nets:
        if net.name in seen:
            yield f"{who(net)}: duplicate name"
        seen.add(net.name)
    for name in needed(board.muxed, board.address_lines):
        if name not in seen:
            yield f"net {name}: missing; the chip and the firmware need it"
    for name in SIGNALS:
        if re.fullmatch(r"A\d+", name) and name in seen and int(name[1:]) >= board.address_lines:
            yield f"net {name}: expected no net with fsmc.address_lines = {board.address_lines}"
    for net in board.nets:
        yield from ends(net)


def ends(net: Net):
    """Finds ends that a net lacks although its signal needs them, and ends that its signal does not
    have."""
    signal = net.signal
    has = {end for end in ("mcu", "fpga", "modem", "to") if net.get(end)}
    if signal.port and "fpga" not in has:
        yield f"{who(net)}: missing 'fpga', the ball of {signal.port}"
    if signal.function and "mcu" not in has and not net.get("pull"):
        yield f"{who(net)}: missing 'mcu', a pin with {signal.function}"
    if signal.modem and "modem" not in has:
        yield f"{who(net)}: missing 'modem', the pin {signal.modem} of the socket"
    if "fpga" in has and not signal.port:
        yield f"{who(net)}: expected no 'fpga'; the chip has no port for it"
    if "mcu" in has and not signal.function:
        yield f"{who(net)}: expected no 'mcu'; the firmware has no use for it"
    if signal.modem and "modem" in has and net.get("modem") != signal.modem:
        yield (f"{who(net)}: expected modem = \"{signal.modem}\", got \"{net.get('modem')}\": "
               + ("two outputs would drive the wire" if signal.driver in (FPGA, MODEM)
                  else "wrong pin"))
    driver = {MCU: "mcu", FPGA: "fpga", BOTH: "mcu", MODEM: "modem", OTHER: "to"}[signal.driver]
    if driver not in has and not net.get("pull"):
        yield (f"{who(net)}: the input has no driver: expected '{driver}', or 'pull' for a fixed "
               "level")
    if net.get("pull") and net.name in ("NWE", "NOE", "NE1", "NE2", "D0") and driver not in has:
        yield f"{who(net)}: the input has no driver: a pull holds it for ever"


def functions(board: Board):
    """Finds pins of the microcontroller that do not have the function that their net needs."""
    pins = board.parts["mcu"]
    for net in board.nets:
        name, function = net.get("mcu"), net.function
        if not name or not net.signal.function:
            continue
        if name not in pins:
            yield (f"{who(net)}: the {board.facts['mcu']['part']} has no pin {name}"
                   + where(pins, function))
            continue
        if not pins[name].is_io:
            yield f"{who(net)}: {name} is not an I/O pin"
        elif function != "GPIO" and function not in pins[name].functions:
            yield (f"{who(net)}: {name} does not have the function {function}"
                   + where(pins, function))
        elif net.signal.pin and name != net.signal.pin:
            yield (f"{who(net)}: expected pin {net.signal.pin}, which the firmware uses, got "
                   f"{name}")
        if function != net.signal.function and function in pins[name].functions:
            yield f"{who(net)}: expected the function {net.signal.function}, got {function}"


def where(pins, function):
    """Returns the end of an error message: the names of the pins that have this function."""
    found = [name for name, pin in pins.items() if function in pin.functions]
    return f"; {function} is on {' or '.join(found)}" if found else ""


def balls(board: Board):
    """Finds balls that are not I/O, balls that configure the FPGA, and clocks on ordinary
    inputs."""
    known = board.parts["fpga"]
    for net in board.nets:
        name = net.get("fpga")
        if not name:
            continue
        ball = known.get(name)
        if not ball:
            yield f"{who(net)}: the {board.facts['fpga']['part']} has no ball {name}"
        elif not ball.is_io:
            yield f"{who(net)}: ball {name} is {ball.description}, not an I/O"
        elif CONFIGURES.search(ball.description):
            yield (f"{who(net)}: ball {name} ({ball.description}) configures the FPGA at start; "
                   "choose another")
        elif net.name == "CLOCK" and not ball.is_clock:
            yield (f"{who(net)}: ball {name} ({ball.description}) is not a global clock pin; "
                   "choose one with GCLK in its name")
        elif net.signal.is_clock and not ball.is_clock and net.get("mcu"):
            yield (f"{who(net)}: its edge clocks registers, and ball {name} ({ball.description}) "
                   "is not a clock input; choose one with GCLK in its name")


def twice(board: Board):
    """Finds pins, balls and pins of the modem that two nets use."""
    for end, noun in (("mcu", "pin"), ("fpga", "ball"), ("modem", "modem's pin")):
        seen = {}
        for net in board.nets:
            name = net.get(end)
            if name and name in seen:
                yield f"{who(net)}: {noun} {name} is used twice, also by {seen[name]}"
            elif name:
                seen[name] = net.name


def occupied(board: Board):
    """Finds pins that the module uses itself, or does not connect to a connector. Nets for which
    the same pin has another problem are left out."""
    judged = {text.split(":")[0].removeprefix("net ")
              for check in (functions, balls, memory) for text in check(board)}
    opened = set(board.facts.get("open", []))
    for end, module in board.modules.items():
        known = {use["release"] for use in module.occupied.values() if "release" in use}
        if end == "mcu":
            for bridge in sorted(opened - known):
                yield f"open: {module.name} has no solder bridge or jumper {bridge}"
        for net in board.nets:
            name = net.get(end)
            if not name or net.name in judged:
                continue
            use = module.occupied.get(name)
            driven = use and use.get("drives")
            if driven and driven == net.get("to"):
                continue
            if use and not (use.get("release") in opened or loads(use, net, end)):
                how = (f"; open {use['release']} (add it to 'open')" if "release" in use
                       else "; choose another")
                yield f"{who(net)}: {name} is occupied by {use['by']}{how}"
            elif not board.place(net, end):
                connectors = ", ".join(board.facts[end].get("connectors", [])) or "no connector"
                yield f"{who(net)}: {name} is not on {connectors} of {module.name}"


def loads(use, net: Net, end):
    """Returns whether a part of the module on this pin is only a load for the output that drives
    the net."""
    return use.get("load") and (net.signal.driver in (BOTH, MCU) if end == "mcu"
                                else net.signal.driver in (BOTH, FPGA))


def memory(board: Board):
    """Finds nets on balls of the memory controller that the DDR3 uses."""
    if not board.ddr:
        return
    bank = board.ddr["bank"]
    for net in board.nets:
        ball = board.parts["fpga"].get(net.get("fpga", ""))
        if ball and ball.bank == bank and f"_M{bank}" in ball.description:
            yield f"{who(net)}: ball {ball.name} ({ball.description}) belongs to the DDR3"


def levels(board: Board):
    """Finds nets, banks and supplies with an unsuitable voltage."""
    for net in board.nets:
        if net.level > MOST_VOLTS:
            ends_of = " and ".join(str(net.get(end)) for end in ("mcu", "fpga", "modem")
                                   if net.get(end))
            yield (f"{who(net)}: {net.level:g} V on {ends_of}, which takes {MOST_VOLTS:g} V at "
                   "most; use a level shifter or a divider")
        ball = board.parts["fpga"].get(net.get("fpga", ""))
        if not ball or ball.bank is None or not ball.is_io:
            continue
        volts = board.banks[ball.bank]
        if volts == 0:
            yield f"{who(net)}: ball {ball.name} is in bank {ball.bank}, which has no supply"
        elif abs(volts - min(net.level, MOST_VOLTS)) > 0.2 and net.level <= MOST_VOLTS:
            yield (f"{who(net)}: {net.level:g} V on ball {ball.name}, and its bank {ball.bank} "
                   f"has {volts:g} V")
    if board.ddr and abs(board.banks[board.ddr["bank"]] - 1.5) > 0.075:
        yield (f"fpga.banks: bank {board.ddr['bank']} has the DDR3 and needs 1.5 V, got "
               f"{board.banks[board.ddr['bank']]:g} V")
    for supply in board.facts.get("supplies", []):
        for name in supply.get("feeds", []):
            if name not in {module.name for module in board.modules.values()}:
                yield f"supplies: {supply['name']}: feeds {name}, which is not a module"
            if name == "xbee" and supply["volts"] > MOST_VOLTS:
                yield f"supplies: {supply['volts']:g} V at xbee, which takes {MOST_VOLTS:g} V"


def clocks(board: Board):
    """Finds oscillators from which the clocks of the CPU and of the chip cannot be derived."""
    hse, clock = board.facts["mcu"].get("hse_hz"), board.facts["fpga"].get("clock_hz")
    if hse is None:
        yield "mcu.hse_hz: missing; the frequency of the microcontroller's clock in Hz"
    elif hse % 1_000_000 or not 4_000_000 <= hse <= 26_000_000:
        yield (f"mcu.hse_hz: expected whole MHz, 4 to 26, got {hse / 1e6:g} MHz: the PLL divides "
               f"to 1 MHz and makes {MCU_HZ // 1_000_000} MHz of it")
    if clock is None:
        yield "fpga.clock_hz: missing; the frequency of the FPGA's oscillator in Hz"
    elif multiplier(clock) is None:
        yield (f"fpga.clock_hz: MIG's PLL cannot make {SOC_HZ // 1_000_000} MHz of "
               f"{clock / 1e6:g} MHz (600 MHz is not a multiple of this)")


def multiplier(clock):
    """Returns C3_CLKFBOUT_MULT, by which MIG's PLL multiplies this clock to get 600 MHz; None if it
    cannot."""
    return 600_000_000 // clock if 600_000_000 % clock == 0 else None


def skew(board: Board):
    """Finds data and address lines whose delay differs too much from the strobe's."""
    strobe = board.net("NWE")
    limit = 5.0  # ns: data stays on the pads for 5 ns (synth/ise/chip.ucf)
    for net in board.nets:
        if strobe and net.signal.function.startswith("FSMC_"):
            late = strobe.get("delay_ns", 0) - net.get("delay_ns", 0)
            if late > limit:
                yield (f"{who(net)}: NWE arrives {late:g} ns after it; at most {limit:g} ns, or "
                       "the FPGA takes the next word's value")


CHECKS = (complete, functions, balls, memory, twice, occupied, levels, clocks, skew)


def problems(board: Board):
    """Returns the problems of a board; the list is empty if the board can be built. If the
    description says that facts are unknown, missing items are not reported."""
    unknown = [f"unknown: {text}" for text in board.facts.get("unknown", [])]
    found = list(unknown)
    for check in CHECKS:
        if not unknown or check not in (complete, clocks):
            found += check(board)
    return list(dict.fromkeys(found))
