#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""commandline_test: tests slice2c's options, exit statuses, files that include other files,
dependencies.

Usage: commandline_test.py commandline work-folder slice2c
"""
import json
import subprocess
import sys
from pathlib import Path

from script import TREE, Script, edit, fresh, main, write

INCLUDES = [f"-I{TREE}/sw/base", f"-I{TREE}/sw/icec"]
STRICT = ("-std=c90 -pedantic -Wall -Wextra -Wconversion -Wstrict-prototypes -Wmissing-prototypes "
          "-Werror -fsyntax-only").split()
TREES = {
    "slice/Lib/Base.ice": """#pragma once
[["underscore"]]
module Lib {
    struct Point_ty { int x; int y; };
    exception Failed { string why; };
    interface Named { string name() throws Failed; };
    class Node { Node next; };
};
""",
    "slice/Lib/Middle.ice": """#ifndef MIDDLE
#define MIDDLE
#include <Lib/Base.ice>
module Lib { sequence<Point_ty> Points; interface Later; };
#endif
""",
    "slice/Top.ice": """#include <Lib/Middle.ice>
#include <Lib/Base.ice>
#ifdef WITH_MORE
module More { const int Amount = WITH_MORE; };
#endif
module Top {
    class Leaf extends Lib::Node { Lib::Points points; };
    exception Worse extends Lib::Failed { Lib::Later* whom; };
    interface Service extends Lib::Named { void go(Lib::Points points, Leaf leaf) throws Worse; };
};
""",
    # Two files with the same name can be part of one program. A file name may begin with a digit.
    "slice/2nd/Base.ice": "module Second { class Node { int x; }; };\n",
    "slice/Both.ice": "#include <Lib/Base.ice>\n#include <2nd/Base.ice>\n"
                      "module Both { struct S { Lib::Node a; Second::Node b; }; };\n",
    "file": "in the way\n", "bad.ice": "module {\n",
    "names.ice": "module A_b { struct iceS { int x; }; };",
    # A line that is longer than the preprocessor can handle
    "long.ice": "module L { // " + 70000 * "x" + "\n};\n",
    "includes.ice": "\n#include <long.ice>\n",
    "joined.ice": "module L { struct S { int a; }; };" + 8000 * "          \\\n",
    # Line ends of another operating system, and a file without a line end
    "crlf.ice": "module L {\r\n struct S { int a; };\r\n};",
    "without.ice": "#include <crlf.ice>\nmodule M { struct T { L::S a; }; };",
    "twice.ice": "#include <crlf.ice>\n#include <crlf.ice>\n",
    "described.ice": 'module D {\n/** "quoted" \\ back\ttab */\nstruct S { double a = 100000; '
                     'double b = 1e300; float c = 0.1; long d = -9223372036854775808; '
                     'bool e = true; string f = "a\\"\\\\\\n\\xff\\u00e9\\001"; }; };',
    "text.ice": f'module L {{ const string T = "{509 * "0"}"; '
                f'struct S {{ string a = "{510 * "0"}"; }}; }};',
    # Files next to the including file and in the folder above it are found, in whichever folder the
    # compiler runs
    "siblings/above.ice": "module Above { struct S { int a; }; };\n",
    "siblings/sub/next.ice": "module Next { struct S { Above::S a; Nothing b; }; };\n",
    "siblings/sub/low.ice": '#include "../above.ice"\n#include "next.ice"\n'
                          "module Low { struct S { Above::S a; }; };\n",
    "top.ice": "#include <sub/low.ice>\n",
    "one/fir.ice": "module Cores { sequence<byte> Bytes; interface Fir { void f(); }; };\n",
    "one/crc.ice": "// a core\n"
                   "module Cores { sequence<byte> Bytes; interface Crc { void f(); }; };\n",
    "one/other/fir.ice": "module Other { interface Fir { void f(); }; };\n",
    "one/user.ice": "#include <fir.ice>\n"
                    "module Cores { interface User { void f(Bytes b); }; };\n"}


class Cases(Script):
    def slice2c(self, words, status=0, *patterns):
        self.ask(sys.argv[3], *words.split(), status=status)
        self.has(*patterns)

    def test_commandline(self):
        fresh(sys.argv[2])
        for name, text in TREES.items():
            write(name, text)
        for words, status, said in (
            ("--help", 0, "output-dir"), ("--version", 0, "slice2c"), ("-v", 0, "slice2c"),
            ("", 1, "Slice file"), ("--no-such-option slice/Top.ice", 1, "no-such-option"),
            ("no-such-file.ice", 1, "cannot read"), ("slice", 1, "cannot read"),
            ("slice/Top.ice", 1, "Middle.ice"),  # no -I
            ("-I slice slice/Lib/Base.ice --output-dir file/sub", 1, "cannot write"),
            ("slice/Top.ice --output-dir", 1, "'--output-dir' requires an argument"),
            ("--describe=1 slice/Top.ice", 1, "'--describe' doesn't allow an argument"),
            ("-I", 1, "option requires an argument -- 'I'"), ("-- --validate", 1, "cannot read"),
            ("--validate", 0, ""), ("-E -I slice slice/Top.ice", 0, "struct Point_ty")):
            self.slice2c(words, status, said)
        self.assertFalse(Path("Top.h").exists())
        self.files_that_include_others()
        self.dependencies()
        self.wrong_lines()
        self.beside_and_above()
        self.limits()
        for option in "-E", "--depend":
            with open("/dev/full", "w") as full:
                said = subprocess.run([sys.argv[3], option, "crlf.ice"], stdout=full,
                                      stderr=subprocess.PIPE, text=True)
            self.assertNotEqual(said.returncode, 0, option)
            self.assertIn("cannot write", said.stderr)
        # In files of one program, two different names must not become the same name in C.
        one = "--one-program one/fir.ice"
        self.slice2c(f"{one} one/crc.ice", 1, "crc.ice:2:31: error: '::Cores::Bytes' and the "
                     "declaration at one/fir.ice:1 would both be named 'Cores_Bytes' in C")
        self.slice2c(f"{one} one/other/fir.ice", 1,
                     "file 'fir.ice' has the same name as one/fir.ice; both go")
        self.slice2c(f"{one} -Ione one/user.ice")
        self.assertFalse(Path("fir.h").exists())
        self.slice2c("--hw-c x crlf.ice", 1,
                     r"crlf.ice:1:1: error: expected an interface with \[\":hw\"\], found none")
        self.assertFalse(Path("crlf.h").exists())
        # --describe writes a description of the declarations for other programs.
        self.slice2c("--describe -I slice slice/Top.ice bad.ice", 1, "bad.ice:1:8: error: ")
        self.slice2c("--describe -I slice slice/Top.ice one/fir.ice")
        described = json.loads(self.said)
        self.assertEqual(described["::Lib::Points"]["element"], "::Lib::Point_ty")
        self.assertEqual(described["::Top::Worse"]["fields"],
                         [{"name": "whom", "type": "::Lib::Later*"}])
        self.assertEqual(described["::Top::Service"]["operations"], [
            {"name": "go", "result": "void", "parameters": [
                {"name": "points", "type": "::Lib::Points"},
                {"name": "leaf", "type": "::Top::Leaf"}],
             "throws": ["::Top::Worse"]}])
        self.assertIn("::Cores::Fir", described)
        # The description is valid JSON for each text and each number.
        self.slice2c("--describe described.ice")
        described = json.loads(self.said)["::D::S"]
        self.assertEqual(described["doc"], '"quoted" \\ back\ttab')
        self.assertEqual([field["default"] for field in described["fields"]], [
            1e5, 1e300, 0.1, -2 ** 63, True, 'a"\\\n\N{REPLACEMENT CHARACTER}é\x01'])
        # An exception causes a warning if no operation throws it or an exception derived from
        # it.
        Path("thrown.ice").write_text(
            "module M { exception Base { int a; }; exception Thrown extends Base { int b; };\n"
            "exception Forgotten { int c; };\n"
            '[":hw"] interface Core { int f() throws Thrown; }; };\n')
        self.slice2c("--hw-c x thrown.ice", 0, "/thrown.ice:2:11: warning: no operation throws "
                     "exception 'Forgotten'")

    def files_that_include_others(self):
        """Several files are compiled in one run, into one folder. A header is included by its name
        on the -I path."""
        self.slice2c("-I slice slice/Lib/Base.ice slice/Lib/Middle.ice --output-dir out/Lib")
        more = "-Islice -DWITH_MORE=7 slice/Top.ice --output-dir out"
        self.slice2c(more)
        self.has('#include "Lib/Middle.h"', r"More_Amount \(\(Ice_Int\)7\)", file="out/Top.h")
        self.has('#include "Lib/Base.h"', file="out/Lib/Middle.h")
        self.slice2c(f"{more} -UWITH_MORE")
        self.lacks("More_", "out/Top.h")
        self.slice2c("-Islice slice/Both.ice --output-dir out")
        self.slice2c("-Islice slice/2nd/Base.ice --output-dir out/2nd")
        self.ask("gcc", "-r", *INCLUDES, "-Iout", "-o", "linked.o", "out/Both_types.c",
                 "out/Lib/Base_types.c", "out/2nd/Base_types.c")
        for compiler in "gcc", "clang":
            for file in Path("out").rglob("*.c"):
                self.ask(compiler, *STRICT, *INCLUDES, "-Iout", "-Iout/Lib", file)
        # The generated header also compiles as C++.
        write("top.cpp",
              '#include "Top.h"\nint main() { Top_Leaf leaf; return sizeof leaf == 0; }\n')
        self.ask("g++", "-std=c++17", "-Wall", "-Werror", "-fsyntax-only", *INCLUDES, "-Iout",
                 "top.cpp")
        self.slice2c("-Islice slice/Top.ice --output-dir ext --header-ext hh --source-ext cc "
                     "--include-dir sub")
        self.has('#include "sub/Top.hh"', file="ext/Top_client.cc")

    def limits(self):
        """A .limits file contains C metadata, also for definitions of an included file."""
        write("limits/mesh.ice", "module G { sequence<int> Points; enum E { a }; enum F { b }; };")
        write("limits/user.ice", "#include <mesh.ice>\nmodule U { struct S { G::Points p; }; };")
        write("limits/mesh.limits", "# of a board\n\nG::Points c:max:21 # room\n::G::E c:scoped")
        words = "-Ilimits limits/user.ice limits/mesh.ice --output-dir limits"
        self.slice2c(words)
        self.has(r"\[21\]", "G_E_a", file="limits/mesh.h")
        self.lacks("G_F_b", "limits/mesh.h")
        self.slice2c("--depend -Ilimits limits/user.ice", 0, "limits/mesh.limits")
        for line, said in (("G::Point c:max:2", "mesh.limits:1:1: error: 'G::Point' is not def"),
                           ("\nG::Points # 7", "mesh.limits:2:1: error: 'G::Points': expected m"),
                           ("G::Points c:max:0", "expected a maximum of 1 to 65535"),
                           ("G::Points c:least:1", "has no effect here")):
            write("limits/mesh.limits", line)
            self.slice2c(words, int("no effect" not in said), said)

    def dependencies(self):
        self.slice2c("--depend -Islice slice/Top.ice", 0, "slice/Lib/Base.ice",
                     "Top.h Top_types.c Top_client.c Top_async.c Top_server.c:")
        self.slice2c("--depend-file deps -Islice slice/Top.ice")
        self.has("Top_client.c", file="deps")
        # Make reads the dependency file, and runs the rule for the header if an included file has
        # changed.
        write("Makefile", "include deps\nTop.h:\n\t@echo remade\n")
        write("Top.h", "")
        self.ask("touch", "-d", "+1 hour", "slice/Lib/Base.ice")
        self.ask("make", "-s", "Top.h")
        self.has("remade")
        # An invalid file does not prevent the other files from being compiled.
        self.slice2c("bad.ice slice/Lib/Base.ice --output-dir mixed", 1,
                     "expected the name of the module")
        self.assertTrue(Path("mixed/Base.h").exists())
        self.slice2c("names.ice --output-dir x", 1, "underscore")
        self.slice2c("--underscore --ice names.ice --output-dir x")

    def wrong_lines(self):
        too_long = "error: the line is too long"
        self.slice2c("long.ice", 1, f"long.ice:1: {too_long}")
        self.slice2c("-I . includes.ice", 1, f"long.ice:1: {too_long}")
        self.slice2c("joined.ice", 1, f"joined.ice:[0-9]*: {too_long}")
        self.slice2c("-I . crlf.ice without.ice --output-dir x")
        self.assertEqual(self.said, "")  # line ends of all kinds are accepted without a message
        self.slice2c("-I . twice.ice", 1, "crlf.ice:2:9: error: .S. is already defined: this file "
                     "is included twice; begin it with #pragma once")
        self.slice2c("text.ice", 1, "^1 error$", "text.ice:1:[0-9]*: error: string of 510 bytes: "
                     "expected at most 509, the length that C90 guarantees")

    def beside_and_above(self):
        self.slice2c("siblings/sub/low.ice", 1, "^module Next",
                     "^/.*/siblings/sub/next.ice:1:38: error: .Nothing. is not a type")
        edit("siblings/sub/next.ice", "Nothing b;", "")
        self.slice2c("siblings/sub/low.ice --output-dir siblings/sub")
        self.has('^#include "../above.h"$', '^#include "next.h"$', file="siblings/sub/low.h")
        for words in "siblings/sub/low.ice", "-Isiblings top.ice":
            self.slice2c(f"--depend {words}", 0, "^ siblings/above.ice ",
                         "^ siblings/sub/next.ice$")


main(Cases)
