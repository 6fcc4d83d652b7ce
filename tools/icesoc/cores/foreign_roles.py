# SPDX-License-Identifier: MIT
"""foreign_roles: finds the role of each port of a third-party core, from the name of the port and
from PORTS."""
import fnmatch
import re

from icesoc.cores import foreign_axis
from icesoc.cores.foreign_files import fail
from icesoc.util.spelling import option

CLOCK = r"[aph]?(clk|clock)g?"
RESET = r"[aph]?n?(rst|reset)[nb]?"
# A signal with one of these words in its name is not a clock or reset: clk_en, gate_clk_pad_i.
NO_CLOCK = {"en", "ena", "enable", "ce", "sel", "div", "gate", "ext", "pad"}
INTERRUPTS = {"int", "inta", "intr", "irq", "interrupt"}
AXI = ["awvalid", "awready", "awaddr", "awprot", "wvalid", "wready", "wdata", "wstrb", "bvalid",
       "bready", "bresp",
       "arvalid", "arready", "araddr", "arprot", "rvalid", "rready", "rdata", "rresp"]
WISHBONE = {"input": {"cyc": "cyc", "stb": "stb", "we": "we", "adr": "adr", "addr": "adr",
                      "sel": "sel", "dat": "wdata",
                      "data": "wdata"},
            "output": {"ack": "ack", "err": "err", "rty": "rty", "stall": "stall", "dat": "rdata",
                       "data": "rdata"}}
# "apb": AMBA APB 2 to 5 (ARM IHI 0024), without parity.
APB = {"psel": "stb", "penable": "enable", "pwrite": "we", "paddr": "adr", "pwdata": "wdata",
       "pstrb": "sel", "pwstrb": "sel", "prdata": "rdata", "pready": "ack", "pslverr": "err"}
# Optional signals of a bus. Inputs are set to constants for single transfers of whole words;
# outputs are left open.
TIED = {"axil": {**dict.fromkeys("awid awlen awlock awcache awqos awregion awuser wid wuser arid "
                                 "arlen arlock arcache arqos arregion aruser".split(), "low"),
                 "awakeup": "high", "wlast": "high", "awburst": "1", "arburst": "1",
                 "awsize": "2", "arsize": "2",
                 **dict.fromkeys(("bid", "buser", "rid", "rlast", "ruser"), "open")},
        "apb": {**dict.fromkeys(("pprot", "pnse", "pauser", "pwuser"), "low"), "pwakeup": "high",
                **dict.fromkeys(("pruser", "pbuser"), "open")},
        "wishbone": dict.fromkeys(("cti", "bte", "lock"), "low"),
        "avalon": {"burstcount": "1", "debugaccess": "low", "lock": "low", "response": "open",
                   "writeresponsevalid": "open"}}
# "memory": chip select, write enable, word address, data. Read data is valid in the same clock.
MEMORY = {"cs": "stb", "ce": "stb", "we": "we", "address": "adr", "addr": "adr",
          "write_data": "wdata", "wdata": "wdata",
          "din": "wdata", "read_data": "rdata", "rdata": "rdata", "dout": "rdata"}
# "avalon": Avalon-MM (Intel MNL-AVABUSREF), single transfers.
AVALON = {"chipselect": "stb", "read": "re", "write": "we", "address": "adr", "addr": "adr",
          "writedata": "wdata", "byteenable": "sel", "readdata": "rdata", "waitrequest": "stall",
          "readdatavalid": "valid"}
# Words for ROLE=port. A select is high until the answer, a strobe for one clock. In a core with
# neither, read and write also select the core.
ROLES = {"select": "stb", "strobe": "strobe", "read": "re", "write": "we", "address": "adr",
         "enables": "sel",
         "wdata": "wdata", "rdata": "rdata", "ack": "ack", "error": "err", "clock": "clock",
         "reset": "reset",
         "resetn": "resetn", "interrupt": "interrupt", "interruptn": "interruptn", "pin": "",
         "setting": "setting", "low": "low", "high": "high",
         "open": "open", "words": "words", "bytes": "bytes", "enable": "enable", "wait": "stall",
         "valid": "valid", "selectn": "stb_n", "readn": "re_n", "writen": "we_n"}
LOW = ("stb_n", "re_n", "we_n")  # active low
OUTPUTS = ("rdata", "ack", "err", "interrupt", "interruptn", "open")
NEEDED = {"memory": ["stb", "we", "adr", "wdata", "rdata"],
          "wishbone": ["stb", "we", "wdata", "rdata", "ack"],
          "apb": ["stb", "enable", "we", "wdata", "rdata"],
          "axil": [n for n in AXI if not n.endswith("prot")], "own": ["we", "wdata", "rdata"],
          "avalon": ["we", "wdata", "rdata", "ack"],
          "axis": foreign_axis.NEEDED}


def is_answer(signal):
    return signal in ("rdata", "ack", "err", "rty", "stall", "valid", "awready", "wready",
                      "bvalid", "bresp", "arready", "rvalid", "rresp", "s_tready", "m_tdata",
                      "m_tvalid")


def with_members(ports, bus, given):
    """Returns the ports with each packed structure replaced by its members, such as req_i.psel, if
    one of them is a signal of the bus, or if the user names one of them. Any other structure stays
    one port."""
    found = {}
    for name, port in ports.items():
        members = {f"{name}.{member}": {"direction": port["direction"], "bits": [0] * bits}
                   for member, bits in port.get("members", [])}
        is_bus = not role(name, port, bus) and any(
            role(member, part, bus) for member, part in members.items())
        is_named = any(word.partition("=")[2].startswith(name + ".") for word in given)
        found.update(members if is_bus or is_named else {name: port})
    return found


def role(name, port, bus):
    """Returns a port's role: clock, reset, interrupt, a signal of the bus, or "" for a pin. A
    member of a packed structure has the role of its name: aw.addr is AXI's awaddr."""
    member = name.partition(".")[2]
    name = (member or name).lower().replace(".", "_")
    tokens = name.split("_")
    if member and len(tokens) > 1:
        tokens.append(name.replace("_", ""))
    is_input = port["direction"] == "input"
    if is_input and len(port["bits"]) == 1 and not NO_CLOCK & set(tokens):
        if any(re.fullmatch(CLOCK, t) for t in tokens):
            return "clock"
        if any(re.fullmatch(RESET, t) for t in tokens):
            if "reset" in port:
                return "reset" if port["reset"] == "1" else "resetn"
            return "resetn" if {"n", "ni",
                                "b"} & set(tokens) or any(re.fullmatch(RESET, t)
                                                          and re.search("nr|[nb]$", t)
                                                          for t in tokens) else "reset"
    if bus == "axis":
        return foreign_axis.role(name, port) or ""
    base = re.sub(r"^[io]_|_[io]$", "", name)
    found = []
    if bus == "memory":
        found = [MEMORY[base]] if base in MEMORY else []
    elif bus == "axil":
        found = [t for t in tokens if t in AXI]
    elif bus == "avalon":
        found = [AVALON[t] for t in tokens if t in AVALON]
        found = [r + "_n" if "n" in tokens and r + "_n" in LOW else r for r in found]
    elif bus == "apb":
        found = [APB[t] for t in tokens if t in APB]
    elif bus == "wishbone" and (len(tokens) <= 2 or any(t.startswith("wb") for t in tokens)):
        found = [WISHBONE[port["direction"]][t] for t in tokens if t in WISHBONE[port["direction"]]]
    found = [r for r in found if (r in OUTPUTS or is_answer(r)) != is_input]
    found += [r for t in tokens if (r := TIED.get(bus, {}).get(t)) and (r == "open") != is_input]
    if found:
        return found[0]
    if is_input or not INTERRUPTS & set(tokens):
        return ""
    return "interruptn" if {"n", "no"} & set(tokens) else "interrupt"


def roles_of(top, bus, ports, given):
    """Returns the role of each port, and the latency: if the core has no port `ack`, the number of
    clocks until the core has answered; otherwise None. `given`: ROLE=port from the command line."""
    roles = {n: role(n, p, bus) for n, p in ports.items()}
    latency = take_given(top, bus, ports, roles, given)
    check_needed(top, bus, ports, roles, latency)
    check_limits(top, bus, ports, roles, latency)
    return roles, latency


def take_given(top, bus, ports, roles, given):
    """Sets the roles that the user gives as ROLE=port. Returns CLOCKS if the user gives ack=CLOCKS,
    otherwise None."""
    # Names of the bus's signals are also accepted, unless a role has the same name.
    words = {**{r: r for r in NEEDED[bus] + {"axil": AXI, "axis": foreign_axis.ROLES}.get(bus, [])},
             **ROLES}
    latency, named = None, set()
    for word in sorted(given, key=lambda word: "*" in word):
        what, port = word.split("=", 1)
        if what not in words:
            fail(f"{option('ports')}: '{what}': expected one of {', '.join(words)}")
        if what == "ack" and re.fullmatch("[1-9]", port):
            latency = int(port)
            continue
        is_output = words[what] in OUTPUTS or is_answer(words[what])
        if "*" in port:  # all matching ports of this direction that would otherwise be pins
            found = [n for n, p in ports.items() if not roles[n] and fnmatch.fnmatch(n, port)
                     and n not in named and is_output == (p["direction"] == "output")]
            roles.update(dict.fromkeys(found, words[what]))
            port = next(iter(found), port)
        if port not in ports:
            fail(f"{option('ports')}: {top} has no port '{port}'; its ports are {', '.join(ports)}")
        if words[what] and is_output != (ports[port]["direction"] == "output"):
            fail(f"{option('ports')}: {what} must be an {'output' if is_output else 'input'} of "
                 f"the core, and '{port}' is not")
        if what == "setting" and bus != "axis":
            fail(f"{option('ports')}: expected 'setting' only with {option('bus', 'axis')}; with "
                 "this bus, use 'pin' for an input outside the bus")
        roles[port] = words[what]
        named.add(port)
    return latency


def check_needed(top, bus, ports, roles, latency):
    """Fails if the bus lacks a port, or has two ports for one signal."""
    say = {v: k for k, v in ROLES.items()} if bus != "axis" else {}
    there = {*(r.removesuffix("_n") for r in roles.values()),
             *(["ack"] if latency or {"stall", "valid"} & set(roles.values()) else []),
             *(["adr"] if {"words", "bytes"} & set(roles.values()) else []),
             *(["stb"] if bus == "wishbone" and "cyc" in roles.values() else [])}
    missing = [say.get(r, r) for r in NEEDED[bus] + ["clock"] if r not in there]
    if missing:
        fail(f"{top} has no port for {', '.join(missing)}; its ports are {', '.join(ports)}: name "
             f"the port with {option('ports', missing[0] + '=PORT')}"
             + (", or give ack=1 if read data is valid one clock later"
                if "ack" in missing else ""))
    often = {"", "clock", "reset", "resetn", "interrupt", "interruptn", "setting", "low", "high",
             "open", "1", "2", *(("adr", "ack") if bus == "own" else ())}
    for r in there - often:
        if len(same := [n for n in ports if roles[n] == r]) > 1:
            fail(f"{top} has more than one port for {say.get(r, r)}: {', '.join(same)}; name the "
                 f"role of each other port, such as {option('ports', f'pin={same[-1]}')}")
    if "strobe" in roles.values() and "ack" not in there:
        fail(f"{option('ports')}: a strobe of one clock needs an ack; for a core that answers in "
             "the same clock, use select")


def check_limits(top, bus, ports, roles, latency):
    """Fails if the ports exceed what the adapter of the bus supports."""
    if bus == "apb" and latency:
        fail(f"{option('ports')}: an APB core without PREADY ends each transfer in its access "
             "phase: leave out ack=")
    if wide := [n for n in ports if bus != "axis" and roles[n] in ("wdata", "rdata")
                and len(ports[n]["bits"]) > 32]:
        fail(f"'{wide[0]}' of {top} has {len(ports[wide[0]]['bits'])} bits: a slot's bus has 32; "
             f"write a module that splits the words, and name it with {option('top')}")
