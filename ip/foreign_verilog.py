# SPDX-License-Identifier: MIT
"""foreign_verilog: pieces of Verilog that the wrapper of every third-party core has."""
import re

ADAPTER = '`include "slot_connect.vh"\n        .irq_o(irq_o)'


def vector(width):
    return f"[{width - 1}:0] " if width > 1 else ""


def pin_name(name, port):
    """Returns the port's name as the platform has pins: in small letters, with _i or _o at its
    end."""
    base = re.sub(r"^[io]_|_[io]$", "", name.lower())
    return base + ("_i" if port["direction"] == "input" else "_o")


def overrides(params):
    """Returns the parameters of an instance."""
    return f" #({', '.join('.{}({})'.format(*p.split('=', 1)) for p in params)})" if params else ""


def head(name, what, pins, memory=""):
    """Returns the begin of a slot's module, with its port list."""
    ports = "".join(f",\n    {p['direction']:6} wire {vector(len(p['bits']))}{n}" for n, p in pins)
    return f"""// SPDX-License-Identifier: MIT
//
// {name}: a slot with the third-party core {what}.

`default_nettype none

module {name} (
    `include "slot_ports.vh"
{memory}    output wire irq_o{"," + chr(10) + "    // pins" + ports[1:] if pins else ""}
);
"""
