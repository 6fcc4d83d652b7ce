# SPDX-License-Identifier: MIT
"""firmware: generates the firmware's pin table (board_pins.h) and the configuration of OpenOCD.

The table contains complete register values for each GPIO port; the firmware only writes them to the
registers."""
from icesoc.board.model import Board
from icesoc.board.signals import SIGNALS

SPEEDS = {"low": 0, "medium": 1, "high": 2, "fast": 3}
PULLS = {"up": 1, "down": 2}
GPIO = 0x40020000
# Values of the registers after reset (RM0033, 6.4). These values keep the debugger pins, which
# are on ports A and B, in use.
RESET = {"A": {"mode": 0xA8000000, "speed": 0, "pull": 0x64000000, "low": 0, "high": 0},
         "B": {"mode": 0x00000280, "speed": 0x000000C0, "pull": 0x00000100, "low": 0, "high": 0}}
START = {"crystal": "RCC_CR_HSEON", "bypass": "(RCC_CR_HSEBYP | RCC_CR_HSEON)"}
ADAPTERS = {"stlink": "interface/stlink.cfg", "jlink": "interface/jlink.cfg",
            "cmsis-dap": "interface/cmsis-dap.cfg"}


def put(registers, name, number, bits, value):
    """Sets field `number` of the register `name` to `value`. Each field of this register is `bits`
    wide."""
    mask = (1 << bits) - 1 << number * bits
    registers[name] = registers[name] & ~mask | value << number * bits


def ports(board: Board):
    """Returns {letter: register values} for each port that has pins of the FSMC."""
    found = {}
    speed = SPEEDS[board.facts.get("fsmc", {}).get("drive", "fast")]
    pins = board.parts["mcu"]
    for net in board.nets:
        pin = net.get("mcu")
        if not pin or not net.function.startswith("FSMC_"):
            continue
        letter, number = pin[1], int(pin[2:])
        registers = found.setdefault(letter, dict(RESET.get(
            letter, {"mode": 0, "speed": 0, "pull": 0, "low": 0, "high": 0})))
        put(registers, "mode", number, 2, 2)
        put(registers, "speed", number, 2, speed)
        put(registers, "pull", number, 2, PULLS.get(net.get("pull"), 0))
        put(registers, "low" if number < 8 else "high", number % 8, 4,
            pins[pin].functions[net.function])
    return dict(sorted(found.items()))


def header(board: Board):
    """Returns board_pins.h."""
    mcu = board.facts["mcu"]
    lines = [
        "/* SPDX-License-Identifier: MIT",
        " *",
        f" * board_pins: pins and clock of the board {board.name}. Generated from its board.toml:",
        " * do not edit.",
        " */", "#pragma once", "",
        f'#define BOARD_NAME "{board.name}"', "",
        "/* Oscillator, Hz, the bits of RCC_CR that start it, and the FPGA's clock, Hz. */",
        f"#define BOARD_HSE_HZ {mcu['hse_hz']}UL",
        f"#define BOARD_HSE_ON {START[mcu.get('hse', 'crystal')]}",
        f"#define BOARD_FPGA_HZ {board.facts['fpga']['clock_hz']}UL",
        "/* 1 if the data pins also carry address bits 15..0, otherwise 0. */",
        f"#define BOARD_MUXED {int(board.muxed)}",
        "",
        "/* Ports (0: A) and pins of the FPGA's interrupt, and of the jumper of Board_isWired. */"]
    for name, macro in (("IRQ", "IRQ"), ("JUMPER_WIRED", "WIRED")):
        pin = board.net(name).get("mcu")
        lines += [f"#define BOARD_{macro}_PORT {ord(pin[1]) - ord('A')}UL",
                  f"#define BOARD_{macro}_PIN {pin[2:]}U"]
    rows = [f"    {{0x{GPIO + 0x400 * (ord(letter) - ord('A')):08X}UL, "
            + ", ".join(f"0x{r[key]:08X}UL" for key in ("mode", "speed", "pull", "low", "high"))
            + "}" for letter, r in ports(board).items()]
    lines += ["", "/* Register values of each port with pins of the FSMC: base address, MODER, "
              "OSPEEDR, PUPDR,", " * AFRL, AFRH. */", f"#define BOARD_PORTS {len(rows)}U",
              "#define BOARD_PINS \\", ", \\\n".join(rows)]
    lines += ["", "/* Port and pin of the microcontroller for each net; 255, 0: without a wire. */"]
    for signal in SIGNALS.values():
        if signal.function:
            net = board.net(signal.name)
            pin = net.get("mcu") if net else ""
            place = f"{ord(pin[1]) - ord('A')}, {pin[2:]}" if pin else "255, 0"
            lines.append(f"#define BOARD_AT_{signal.name} {place}")
    lines += ["", "/* Bank of the FPGA for each net; 255 means a net without a ball. */"]
    for signal in SIGNALS.values():
        if signal.port and not signal.name.startswith("CORE_"):
            net = board.net(signal.name)
            ball = board.parts["fpga"].get(net.get("fpga", "")) if net else None
            lines.append(f"#define BOARD_BANK_{signal.name} {ball.bank if ball else 255}")
    return "\n".join(lines) + "\n"


def openocd(board: Board):
    """Returns the configuration of OpenOCD for the board's debugger."""
    adapter = ADAPTERS[board.facts["mcu"].get("debugger", "stlink")]
    return f"""# SPDX-License-Identifier: MIT
#
# Generated from boards/{board.name}/board.toml: do not edit. {board.facts['title']}.
#   openocd -f openocd.cfg -c "program firmware.elf verify reset exit"
source [find {adapter}]
transport select {'hla_swd' if 'stlink' in adapter else 'swd'}
set WORKAREASIZE 0x20000
source [find target/stm32f2x.cfg]
reset_config srst_only srst_nogate connect_assert_srst
"""
