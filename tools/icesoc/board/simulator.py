# SPDX-License-Identifier: MIT
"""simulator: generates the wires of a board for the simulator (testbench/sim/board_wires.h)."""
from icesoc.board.model import Board
from icesoc.board.signals import SIGNALS

KNOWN = {signal.function for signal in SIGNALS.values() if signal.function.startswith("FSMC_")}


def at_pin(pin, function):
    """Returns the FSMC function that a pin has, even if the net at this pin expects another one: a
    wire at a wrong pin carries the signal of that pin. If the pin has no FSMC function, returns
    `function`, or "-" if that is empty."""
    return next((name for name in pin.functions if name in KNOWN), function or "-")


def wires(board: Board):
    """Returns the wires as text. The first lines are the board's name, the oscillator, whether
    address and data are multiplexed (1) or not (0), and the kind of modem if it is known. Then each
    net has a line: the pin, the number and the name of its alternate function ("-" if it has none),
    the net, the ball, its bank, and the supply of the bank in V."""
    lines = ["# Wires: pin, alternate function, its name, net, ball, bank, volts",
             f"board {board.name}", f"oscillator {board.facts['mcu']['hse_hz']}",
             f"muxed {int(board.muxed)}"]
    if board.modem:
        lines.append(f"modem {board.modem}")
    pins, balls = board.parts["mcu"], board.parts["fpga"]
    for net in board.nets:
        pin, ball = net.get("mcu", "-"), net.get("fpga", "-")
        function = at_pin(pins[pin], net.function) if pin != "-" else "-"
        number = pins[pin].functions.get(function, "-") if pin != "-" else "-"
        bank = balls[ball].bank if ball != "-" else None
        volts = board.banks[bank] if bank is not None else 0
        end = pin if pin != "-" else net.get("modem", "-")
        place = f"{ball} {-1 if bank is None else bank} {volts:g}"
        lines.append(f"{end} {number} {function} {net.name} {place}")
    return "\n".join(lines) + "\n"


def literals(wires_text, ucf_text):
    """Returns the texts of the wires and of the UCF as C++ string literals, for the simulator's
    default board. Leaves comments out, because a title could contain the end of the literal."""
    wires_text, ucf_text = ("".join(line for line in text.splitlines(keepends=True)
                                    if not line.startswith("#"))
                            for text in (wires_text, ucf_text))
    return (f'constexpr char defaultWires[] = R"board({wires_text})board";\n'
            f'constexpr char defaultUcf[] = R"board({ucf_text})board";\n')
