# SPDX-License-Identifier: MIT
"""rdl_properties: lists every property of SystemRDL 2.0 (Accellera, annex E) by its effect for
software: it is converted, it has no effect, or it cannot be represented and is an error with its
line.
"""
from icesoc.regs import names

# Properties that rdl.py uses. `name` and `desc` become the text `doc`.
TAKEN = {
    "name", "desc", "ispresent", "fieldwidth", "reset", "sw", "hw", "woclr", "woset", "onwrite",
    "singlepulse", "hwclr", "hwset", "swmod", "swacc", "regwidth", "accesswidth", "alignment",
    "addressing", "memory_bytes"}
# Properties without effect here: texts for verification, hints for other tools, and behaviour that
# our registers always have.
WITHOUT_EFFECT = {"donttest", "dontcompare", "hdl_path", "hdl_path_slice", "hdl_path_gate",
                  "hdl_path_gate_slice", "encode", "littleendian", "lsb0", "internal"}
# Values with which a property has no effect for software; any other value is an error. A property
# that is set to false counts as missing.
OFF: dict[str, set[str]] = {
    "precedence": {"sw"}, "onread": set(), "rclr": set(), "rset": set(), "swwe": set(),
    "swwel": set(), "we": set(), "wel": set(), "hwenable": set(), "hwmask": set(), "anded": set(),
    "ored": set(), "xored": set(), "paritycheck": set(), "next": set(), "resetsignal": set(),
    "intr": set(), "enable": set(), "mask": set(), "haltenable": set(), "haltmask": set(),
    "sticky": set(), "stickybit": set(), "nonsticky": set(), "level": set(), "posedge": set(),
    "negedge": set(), "bothedge": set(), "counter": set(), "incr": set(), "incrvalue": set(),
    "incrwidth": set(), "incrsaturate": set(), "incrthreshold": set(), "overflow": set(),
    "decr": set(), "decrvalue": set(), "decrwidth": set(), "decrsaturate": set(),
    "decrthreshold": set(), "underflow": set(), "saturate": set(), "threshold": set(),
    "errextbus": set(), "sharedextbus": set(), "shared": set(), "bigendian": set(), "msb0": set(),
    "rsvdset": set(), "rsvdsetX": set(), "bridge": set(), "sync": set(), "async": set(),
    "activehigh": set(), "activelow": set(), "cpuif_reset": set(), "field_reset": set(),
    "signalwidth": set(), "mementries": set(), "memwidth": set()}
# Properties by component; all others belong to fields.
UNIVERSAL = {"name", "desc", "ispresent", "donttest", "dontcompare", "hdl_path", "hdl_path_gate"}
OF_COMPONENT: dict[str, set[str]] = {
    "addrmap": UNIVERSAL | {"alignment", "addressing", "sharedextbus", "errextbus", "bigendian",
                            "littleendian", "rsvdset", "rsvdsetX", "msb0", "lsb0", "bridge",
                            "memory_bytes"},
    "reg": UNIVERSAL | {"regwidth", "accesswidth", "errextbus", "shared"},
    "root": set(TAKEN | WITHOUT_EFFECT | set(OFF))}
ONLY_ABOVE_FIELDS = (OF_COMPONENT["addrmap"] | OF_COMPONENT["reg"]) - UNIVERSAL
OF_COMPONENT["field"] = (TAKEN | WITHOUT_EFFECT | set(OFF)) - ONLY_ABOVE_FIELDS

SW = {"rw", "wr", "r", "w"}
HW = {"rw", "wr", "r", "w", "rw1", "w1", "na"}
BITS = {"8", "16", "32", "64"}
VALUES = {"sw": SW, "hw": HW, "regwidth": BITS, "accesswidth": BITS, "onwrite": {"woclr", "woset"},
          "addressing": {"compact", "regalign", "fullalign"}}
FLAGS = {"ispresent", "woclr", "woset", "singlepulse", "hwclr", "hwset", "swmod", "swacc"}


def is_standard(name):
    """Returns whether a word is a property of SystemRDL 2.0, or modifies one (`posedge intr`)."""
    return name in (TAKEN | WITHOUT_EFFECT | set(OFF)) - {"memory_bytes"}


def problem_of(kind, name, value, declared):
    """Returns the reason why a property of a component cannot be converted, or "". `kind`: addrmap,
    reg or field, or root or defaults, which may have any property. `declared`: names of the
    properties declared in the file."""
    if name in declared:
        return ""
    if not is_standard(name) and name not in TAKEN:
        return f"'{name}' is not a property of SystemRDL 2.0"
    if name not in OF_COMPONENT[kind]:
        return f"'{name}' is not a property of {kind}"
    if name in OFF and value not in {"false"} | OFF[name]:
        return f"{name} = {value}: a register description cannot express it"
    if name in VALUES and value not in VALUES[name]:
        return f"{name}: expected {' or '.join(sorted(VALUES[name]))}, got {value}"
    if name in FLAGS and value not in ("true", "false"):
        return f"{name}: expected true or false, got {value}"
    return ""


def name_problem(text):
    """Returns the reason why a text cannot be a name, or ""."""
    if text.lower() != text or text not in names.RDL_KEYWORDS:
        return ""
    return f"'{text}' is a keyword; write \\{text} for a name"
