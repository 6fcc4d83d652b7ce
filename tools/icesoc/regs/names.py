# SPDX-License-Identifier: MIT
"""names: checks the names in the generated files before any file is written.

Two names in a description may become the same name in a generated file: the field TX.DONE and the
register TX_DONE_MASK are both TX_DONE_MASK in C. Such a pair is rejected, and the message contains
both names. VHDL does not distinguish capitals, so the check ignores them.
"""
# Macros of C's standard headers that could equal <BLOCK>_<REGISTER>.
C_MACROS = {f"{kind}_{end}" for end in ("MAX", "MIN") for kind in (
    "CHAR", "SCHAR", "UCHAR", "SHRT", "USHRT", "INT", "UINT", "LONG", "ULONG", "FLT", "DBL", "LDBL",
    "INT8", "INT16", "INT32", "INT64", "UINT8", "UINT16", "UINT32", "UINT64", "INTPTR", "UINTPTR",
    "INTMAX", "UINTMAX", "SIZE", "PTRDIFF", "WCHAR", "WINT", "RAND", "MB_LEN", "SIG_ATOMIC")}
C_MACROS |= {"CHAR_BIT", "SIG_DFL", "SIG_IGN", "SIG_ERR", "EXIT_SUCCESS", "EXIT_FAILURE",
             "SEEK_SET", "SEEK_CUR", "SEEK_END", "BUFSIZ_MAX", "LC_ALL", "LC_COLLATE", "LC_CTYPE",
             "LC_MONETARY", "LC_NUMERIC", "LC_TIME", "FLT_RADIX", "FLT_ROUNDS"}
C_MACROS |= {f"{kind}_{what}" for kind in ("FLT", "DBL", "LDBL") for what in (
    "DIG", "EPSILON", "MANT_DIG", "MAX_EXP", "MAX_10_EXP", "MIN_EXP", "MIN_10_EXP")}
# Prefixes of macros in the project's headers, such as HW_OK, ICE_OK, MAP_SLOT_MODEM.
PREFIXES = {"hw", "ice", "fsmc", "link", "uav", "os"}
# Ports that every register block begins with (bus/slot_ports.vh): name, output or not, width.
SLOT_PORTS = (
    ("clk_i", False, 1), ("rst_i", False, 1), ("bus_valid_i", False, 1), ("bus_write_i", False, 1),
    ("bus_addr_i", False, 4), ("bus_wdata_i", False, 32), ("bus_ready_o", True, 1),
    ("bus_rdata_o", True, 32), ("bus_error_o", True, 1))
RDL_KEYWORDS = set("""
    abstract accesstype addressingtype addrmap alias all alternate bit boolean bothedge byte compact
    component componentwidth constraint default encode enum external false field fullalign hw inside
    int internal level longint mem na negedge nonsticky number onreadtype onwritetype posedge
    precedencetype property r rclr real ref reg regalign regfile rset ruser rw rw1 shortint
    shortreal signal signed string struct sw this true type unsigned w w1 wclr with within woclr
    woset wot wr wset wuser wzc wzs wzt""".split())


class Collision(Exception):
    """Two names of a description that become the same name; the text is for the user."""


class Spelled:
    """Names of one scope in the generated files, and the names in the description from which they
    are derived."""

    def __init__(self):
        self.owners = {}  # name in upper case -> its name in the description

    def add(self, spelled, owner):
        if spelled.upper() not in self.owners:
            self.owners[spelled.upper()] = (spelled, owner)
            return
        first, other = self.owners[spelled.upper()]
        if other == owner:
            raise Collision(f"{owner}: duplicate name")
        raise Collision(f"{other} and {owner} both become {first} in a generated file: rename one")


def constants(b):
    """Returns the names of a block's constants in C, Verilog and VHDL, without the block's prefix.
    Rejects a block if two of its constants have the same name."""
    spelled = Spelled()
    if b.is_slot:
        spelled.add("TABLE", "the table of all registers")
    for c in b.constants:
        spelled.add(c.name, c.name)
    for r in b.registers:
        spelled.add(r.name, r.name)
        if r.page >= 0:
            spelled.add(f"{r.name}_PAGE", f"the page of {r.name}")
        for f in r.fields:
            for end in ("LSB", "MASK", "WIDTH"):
                spelled.add(f"{r.name}_{f.name}_{end}", full_name(r, f))
    return spelled


def check_block(b):
    """Rejects a block if two of its constants have the same name."""
    spelled = constants(b)
    if b.name.lower() in PREFIXES:
        raise Collision(f"block {b.name}: the name is reserved by the project")
    for name in spelled.owners:
        if f"{b.prefix}_{name}" in C_MACROS:
            raise Collision(f"{spelled.owners[name][1]} becomes {b.prefix}_{name}, which a header "
                            "of C defines: rename it")


def full_name(register, field):
    return f"{register.name}.{field.name}"


def check_ports(b):
    """Rejects a block if two ports or signals of its register block would have the same name."""
    spelled = Spelled()
    for name, _, _ in SLOT_PORTS:
        spelled.add(name, f"the port {name} of every slot")
    for p in b.ports:
        spelled.add(p.name, p.owner)


def rdl(name):
    """Returns a name for SystemRDL; a keyword is escaped."""
    return "\\" + name if name in RDL_KEYWORDS else name
