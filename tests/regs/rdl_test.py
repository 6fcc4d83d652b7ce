# SPDX-License-Identifier: MIT
"""rdl_test: checks that each property of SystemRDL 2.0 is converted, has no effect, or causes an
error with its line; none is misinterpreted."""
import sys
import tempfile
import unittest
from pathlib import Path

from icesoc.regs import rdl, rdl_properties
from icesoc.regs.model import Wrong

# All properties of the standard, by component, copied from its tables; each must be handled.
STANDARD = """name desc ispresent donttest dontcompare hdl_path hdl_path_slice hdl_path_gate
hdl_path_gate_slice errextbus hw sw reset resetsignal rclr rset onread woset woclr onwrite swwe
swwel swmod swacc singlepulse we wel anded ored xored fieldwidth hwclr hwset hwenable hwmask counter
threshold saturate incrthreshold incrsaturate overflow underflow incrvalue incr incrwidth decrvalue
decr decrwidth decrsaturate decrthreshold intr enable mask haltenable haltmask sticky stickybit
encode precedence paritycheck next regwidth accesswidth shared alignment sharedextbus addressing
bigendian littleendian rsvdset rsvdsetX msb0 lsb0 bridge signalwidth sync async cpuif_reset
field_reset activelow activehigh mementries memwidth nonsticky posedge negedge bothedge
level""".split()


def read(text, first=3):
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "a.rdl")
        file.write_text(text)
        return rdl.blocks_of(file, first)


def register(text, index=0):
    return read("addrmap widget {\n" + text + "\n};")[0]["registers"][index]


def field(properties, bits="[0:0]"):
    return register("reg {\n field { %s } A%s;\n } R @ 0;" % (properties, bits))


class Rdl(unittest.TestCase):
    def refused(self, words, text):
        with self.assertRaises(Wrong) as caught:
            register(text)
        self.assertRegex(str(caught.exception), r"^\d+: error: ")
        for word in words:
            self.assertIn(word, str(caught.exception))
        return str(caught.exception)

    def test_every_property_of_the_standard_has_its_place(self):
        known = rdl_properties.TAKEN | rdl_properties.WITHOUT_EFFECT | set(rdl_properties.OFF)
        self.assertEqual(set(STANDARD) - known, set())
        for name in rdl_properties.OFF:
            kind = next(k for k in ("field", "reg", "addrmap")
                        if name in rdl_properties.OF_COMPONENT[k])
            place = {"field": "reg { field {\n%s = true; } A[1]; } R @ 0;",
                     "reg": "reg {\n%s = true; field {} A[1]; } R @ 0;",
                     "addrmap": "\n%s = true; reg { field {} A[1]; } R @ 0;"}[kind]
            said = self.refused([name], place % name)
            self.assertTrue(said.startswith("3:"), said)
            register(place.replace("true", "false") % name)  # off

    def test_widths(self):
        two = register("reg { field { fieldwidth = 4; } GAIN; field { fieldwidth = 8; } OFFS; } "
                       "R @ 0;")
        self.assertEqual([(f["lsb"], f["width"]) for f in two["fields"]], [(0, 4), (4, 8)])
        self.refused(["fieldwidth is 4"], "reg { field { fieldwidth = 4; } A[7:0]; } R @ 0;")
        self.refused(["bits -1 to 0"], "reg { field { fieldwidth = 0; } A; } R @ 0;")
        self.refused(["expected a number"], "reg { field { fieldwidth = 2 + 2; } A; } R @ 0;")
        default = read("addrmap a { default fieldwidth = 3; reg { field {} A; } R; };")
        self.assertEqual(default[0]["registers"][0]["fields"][0]["width"], 3)

    def test_accesses(self):
        for properties, access in (
                ("sw = rw; woclr = false;", "rw"), ("sw = rw; woclr;", "w1c"),
                ("sw = r; hw = w;", "ro"),
                ("onwrite = woset;", "w1s"), ("woset = true;", "w1s"), ("sw = w;", "ws"),
                ("singlepulse;", "ws"), ("singlepulse = false;", "rw"), ("sw = wr;", "rw"),
                ("onwrite = woclr;", "w1c")):
            self.assertEqual(field(properties)["access"], access, properties)
        for properties in ("sw = na;", "sw = rw1;", "sw = w1;", "onwrite = wot;", "onwrite = wzc;",
                           "onwrite = wclr;", "onwrite = wuser;", "rclr;", "onread = rset;",
                           "woclr; woset;", "sw = r; woclr;", "counter;", "intr;", "posedge intr;",
                           "swwe;", "woclr = maybe;", "fieldwith = 3;", "regwidth = 8;"):
            self.refused([], "reg { field { %s } A[0:0]; } R @ 0;" % properties)

    def test_fields_of_different_access(self):
        mixed = register("reg { field { sw = r; } BUSY[0:0]; field {} ON[1:1]; } R @ 0;")
        self.assertEqual((mixed["access"], [f.get("access") for f in mixed["fields"]]),
                         ("rw", ["ro", None]))
        self.refused(["rw, w1c"], "reg { field {} A[0:0]; field { woclr; } B[1:1]; } R @ 0;")
        self.refused(["ro, ws"], "reg { field { sw = r; } A[0:0]; field { sw = w; } B[1:1]; } "
                     "R @ 0;")
        self.refused(["overlaps"], "reg { field {} A[3:0]; field {} B[4:2]; } R @ 0;")

    def test_resets_and_hardware(self):
        made = register("reg { field { reset = 5; } A[3:0]; field {} B[7:4] = 4'hF; } R @ 0;")
        self.assertEqual([f["reset"] for f in made["fields"]], ["0x5", "0xF"])
        self.refused(["reset 16 does not fit"], "reg { field { reset = 16; } A[3:0]; } R @ 0;")
        self.assertEqual(field("hw = rw;")["storage"], "core")
        self.assertTrue(field("hwclr;")["fields"][0]["hwclr"])
        self.assertEqual(field("swacc;")["strobes"], ["read", "write"])
        self.assertEqual(read("addrmap a { reg { ispresent = false; field {} A; } X; "
                              "reg { field {} A; } Y; };")[0]["registers"][0]["name"], "Y")

    def test_addresses(self):
        aligned = read("addrmap a { alignment = 8; reg { field {} A[32]; } ONE; "
                       "reg { field {} B[32]; } TWO; };")[0]["registers"]
        self.assertEqual([r["word"] for r in aligned], [3, 5])
        self.refused(["not a multiple of its 4 bytes"], "reg { field {} A; } R @ 0x2;")
        self.refused(["alignment: expected a power of two"],
                     "alignment = 3; reg { field {} A; } R @ 0;")
        self.refused(["share words"], "reg { regwidth = 8; field {} A; } R @ 0; "
                     "reg { regwidth = 16; field {} A; } S @ 2;")
        own = read("addrmap a { default regwidth = 8; reg { field {} A; } R @ 0; "
                   "reg { field {} A; } S @ 4; };")[0]["registers"]
        self.assertEqual([r["word"] for r in own], [3, 4])

    def test_texts_and_names(self):
        block = read(r'addrmap a { desc = "ends in \"quotes\""; reg { desc = "a\\"; field { desc = '
                     r'"say \"hi\""; } A[8]; } \reg @ 0; };')[0]
        found = block["registers"][0]
        self.assertEqual((block["doc"], found["doc"], found["fields"][0]["doc"], found["name"]),
                         ('ends in "quotes"', "a\\", 'say "hi"', "reg"))
        self.refused(["'signal' is a keyword"], "reg { field {} A; } signal @ 0;")

    def test_enumerators_with_properties_are_skipped(self):
        made = register('enum mode { IDLE = 0 { name = "Idle"; desc = "a } brace"; }; RUN = 1; '
                        'HALT; }; reg { field { encode = mode; } M[2]; } R @ 0;')
        self.assertEqual(made["fields"][0]["width"], 2)

    def test_a_default_holds_for_what_comes_after_it(self):
        made = read("addrmap a { reg { field {} A; } R; default sw = r; reg { field {} B; } S; "
                    "reg { default sw = rw; field {} C; default hw = w; field {} D; } T; };")[0]
        self.assertEqual([r["access"] for r in made["registers"]], ["rw", "ro", "rw"])

    def test_what_is_given_twice(self):
        for text in ("reg { field { sw = r; sw = rw; } A; } R;",
                     "default sw = r; default sw = rw; reg { field {} A; } R;",
                     "field f { sw = r; }; field f {}; reg { f A; } R;",
                     "property p { component = reg; type = string; }; "
                     "property p { component = reg; type = string; }; reg { field {} A; } R;"):
            self.refused(["already"], text)
        self.refused(["'counter' already exists"], "property counter { component = field; type = "
                     "number; }; reg { field { counter; } A; } R;")
        self.refused(["R: duplicate name, first on line 2"],
                     "reg { field {} A; } R;\nreg { field {} A; } R;")
        self.refused(["S has the address of R"],
                     "reg { field {} A; } R @ 4; reg { field {} A; } S @ 4;")

    def test_texts_and_comments_end(self):
        self.refused(["no closing quote"], 'desc = "open; reg { field {} A; } R;')
        self.refused(["comment has no end"], "reg { field {} A; } R; /* open")
        for text in ("5", '"a" "b"', "name"):
            self.refused(["expected one text in quotes"],
                         "reg { desc = %s; field {} A; } R;" % text)
        self.refused(["without */"], 'reg { desc = "a */ b"; field {} A; } R;')

    def test_numbers_fit_their_width(self):
        self.refused(["expected a value of 2 bits, got 7"], "reg { field {} A[7:0] = 2'h7; } R;")
        self.refused(["reset: 1'd2"], "reg { field { reset = 1'd2; } A[7:0]; } R;")
        made = register("reg { field {} A[15:0] = 1_000; } R;")
        self.assertEqual(made["fields"][0]["reset"], "0x3E8")
        self.refused(["accesswidth: expected at most 8"], "reg { regwidth = 8; accesswidth = 32; "
                     "field {} A[8]; } R;")
        for bits in ("[8]", "= 1"):
            self.refused(["single pulse"], "reg { field { singlepulse; } A %s; } R;" % bits)

    def test_common_registers_are_those_of_a_slot(self):
        common = ("reg { field {} VERSION[16]; field {} TYPE[16]; } ID @ %d; reg { field {} GO; } "
                  "EVENT @ 4; reg { field {} %s; } MASK @ 8;")
        self.assertEqual(read("addrmap a {%s};" % common % (0, "GO"))[0]["events"][0]["name"], "GO")
        self.refused(["expected words 0, 1 and 2"], common % (12, "GO"))
        self.refused(["the same fields"], common % (0, "STOP"))
        self.refused(["the same fields"], common.replace("GO", "GO[2]") % (0, "GO[2]"))
        self.refused(["expected the fields VERSION"], common.replace("TYPE", "KIND") % (0, "GO"))

    def test_messages_name_what_is_wrong(self):
        for words, text in (("type 'missing' is not defined", "missing R;"),
                            ("Perl", "<% print 1; %> reg { field {} A; } R;"),
                            ("expected a component or a property, got ';'", ";"),
                            ("sw: expected a value", "reg { field { sw = ; } A; } R;"),
                            ("'A__B': expected a name", "reg { field {} A__B; } R;"),
                            ("'R_': expected a name", "reg { field {} A; } R_;")):
            self.refused([words], text)
        with self.assertRaisesRegex(Wrong, "1: error: 'sw': a property belongs"):
            read("sw = r; addrmap a { reg { field {} A; } R; };")

    def test_what_is_not_part_of_the_subset(self):
        for text in ("signal { } s;", "alias R reg { field {} A; } S;", "R->desc = \"x\";",
                     "R.A->reset = 1;", "`include \"x.rdl\"", "reg { field {} A; } R[4];",
                     "reg { field {} A; } R @ 0 += 4;", "reg { field {} A; } R %= 8;",
                     "reg { reg { field {} A; } B; } R;", "field {} A;", "regfile { } r;",
                     "reg { field {} A[0:7]; } R;", "struct x { };", "mem { } m;"):
            self.refused([], text)
        with self.assertRaises(Wrong):
            read("reg { field {} A; } R; addrmap a { reg { field {} A; } R; };")


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
