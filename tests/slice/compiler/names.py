#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""names: tries each identifier of generated C as a name of each kind that a Slice file can define.

    names.py SLICE2C SW WORK

The identifiers come from the C code that TEMPLATES generate. Each identifier replaces X in each
template, in a separate module. There is one Slice file per kind of name; its C must compile as C90,
and its header as C++. slice2c may reject a name that has an underscore and already exists at file
scope in C. It must accept all names without an underscore; Slice forbids underscores by default.
"""
import os
import re
import subprocess
import sys

SLICE2C, SW, WORK = sys.argv[1:4]
# without optimisation, which would take most of the time of the test
C_FLAGS = ["-std=c90", "-pedantic", "-Werror"]
INCLUDES = [f"-I{SW}/base", f"-I{SW}/icec"]
COMMON = "struct qS { int qa; string qb; }; class qC { int qa; }; exception qE { int qa; };"

TEMPLATES = {
    "member": """struct qS { int X; string qa; }; exception qE { int X; optional(1) string qa; };
        exception qF extends qE { int qb; }; class qC { optional(1) int X; int qa; };
        class qD extends qC { int qb; };
        class qG { int qa; }; class qH extends qG { int X; }; exception qJ { int qa; };
        exception qK extends qJ { int X; optional(2) int qc; };
        ["preserve-slice"] exception qL { string X; };
        ["preserve-slice"] exception qM { int qa; }; exception qN extends qM { qC X; };
        interface qI { qS qop(qC qa, out qH qb) throws qE, qK, qL, qN; };""",
    "parameter": COMMON + """interface qI {
        int qop(int X, qS qa, optional(1) string qb, qC qc, out qC qd) throws qE;
        ["amd"] int qam(string X, optional(1) qC qc, out qC qd) throws qE;
        optional(3) int qopt(optional(1) qS X); };
        interface qJ { optional(1) qS qo2(qC X) throws qE;
        ["amd"] optional(1) qS qo3(optional(2) qC X); };
        ["preserve-slice"] exception qP { int qa; }; interface qK { void qo4(qS X) throws qP; };""",
    "out_parameter": COMMON + """interface qI { void qop(int qa, qC qc, out int X) throws qE;
        int qo2(out optional(1) qC X) throws qE; ["amd"] qS qo3(out string X) throws qE;
        optional(2) int qo4(int qa, out int X);
        ["amd"] optional(1) qC qo5(out qS X) throws qE; };""",
    "operation": COMMON + """interface qI { void X(int qa, out qS qb) throws qE; };
        interface qJ { ["amd"] int X(out qS qa) throws qE; }; interface qK extends qI { int qb(); };
        interface qM { int qop(); }; interface qN extends qM { void X(); };
        class qD { int X(qS qa); };""",
    "exception": COMMON + """exception X { int qa; }; exception qF extends X { string qb; };
        interface qI { int qop() throws X; ["amd"] int qam() throws X, qE; };""",
    "enumerator": """enum qE { X, qb }; ["c:scoped"] enum qF { X };
        struct qS { qE qa = qE::X; qF qb; };
        interface qI { qE qop(qF qa); };""",
    "long_constant": "const long X = 5; const int qa = 1; const string qb = \"a\";",
    "constant": "const int X = 5; struct qS { int qa = X; };",
    "struct": "struct X { int qa; }; sequence<X> qT; interface qI { X qop(X qa, out qT qb); };",
    "class": COMMON +
    "class X { int qa; }; class qD extends X { X qb; }; interface qI { X qop(X qa, X* qb) throws "
    "qE; };",
    "interface": COMMON + """interface X { int qa(X* qb) throws qE; };
        interface qI extends X { void qop(); };
        class qD implements X { int qb; };""",
    "sequence": "sequence<int> X; struct qS { X qa; }; [\"c:max:4\"] sequence<X> qT;",
    "dictionary": "dictionary<int, string> X; struct qS { X qa; };",
    "enum": "enum X { qa, qb }; struct qS { X qc = qb; };",
    "module": "module X { struct qS { int qa; }; exception qE { int qa; }; interface qI { int "
              "qop(qS qa) throws qE; }; };",
}
KEYWORDS = set("""module class interface exception struct sequence dictionary enum out extends
    implements throws void byte bool short int long float double string Object LocalObject local
    const false true idempotent optional Value""".split())


def run(command, **more):
    return subprocess.run(command, capture_output=True, text=True, **more)


def compile_slice(folder, text):
    """Returns the messages of slice2c for unit.ice in a new folder."""
    os.makedirs(folder, exist_ok=True)
    with open(f"{folder}/unit.ice", "w") as out:
        out.write('[["underscore", "ice-prefix", "suppress-warning"]]\n' + text)
    return run([SLICE2C, "unit.ice"], cwd=folder)


def identifiers(folder):
    found = set()
    for name in os.listdir(folder):
        if name.endswith((".c", ".h")):
            text = open(f"{folder}/{name}").read()
            text = re.sub(r'/\*.*?\*/|"(\\.|[^"\\])*"|#include[^\n]*', " ", text, flags=re.S)
            found.update(re.findall(r"[A-Za-z_]\w*", text))
    return found


def is_slice_name(name):
    return re.match("[A-Za-z]", name) and not (name.endswith(("_", "Helper", "Holder", "Prx",
                                                              "Ptr")) or "__" in name
                # the names q... are used by the templates
                or re.fullmatch(r"q\w{1,3}(Disp)?", name))


def written(module, template, name):
    name = re.sub(r"^M_", module + "_", name)
    name = "\\" + name if name in KEYWORDS else name
    return f"module {module} {{ " + re.sub(r"\bX\b", lambda _: name,
                                           " ".join(template.split())) + " };\n"


def main():
    own = {}  # by kind
    for kind, template in TEMPLATES.items():
        folder = f"{WORK}/template/{kind}"
        result = compile_slice(folder, written("M", template, "qxx"))
        if result.returncode:
            sys.exit(f"{kind}: {result.stderr}")
        own[kind] = identifiers(folder)
    parts = {part for found in own.values() for name in found for part in [name, *name.split("_")]}
    bad, refused, tried = [], 0, 0
    for kind, template in TEMPLATES.items():
        folder = f"{WORK}/{kind}"
        # A name that contains M_ occurs only in the C code of its template.
        names = sorted(n for n in own[kind] | {n for n in parts if "M_" not in n}
                       if is_slice_name(n))
        left = dict(enumerate(names, 2))  # by line
        tried += len(left)
        while True:
            text = "".join(written(f"M{n}", template, left[n]) if n in left else "\n"
                           for n in range(2, len(names) + 2))
            result = compile_slice(folder, text)
            lines = {int(n) for n in re.findall(r"^[^\n]*unit\.ice:(\d+):\d+: error", result.stderr,
                                                flags=re.M)}
            if result.returncode == 0:
                break
            if not lines:
                sys.exit(f"{kind}: {result.stderr}")
            for n in lines:
                name = left.pop(n)
                refused += 1
                if "_" not in name:
                    bad.append(f"{kind} '{name}': slice2c refuses it")
        with open(f"{folder}/whole.c", "w") as out:
            out.writelines(f'#include "unit_{part}.c"\n'
                           for part in ("types", "client", "async", "server"))
        with open(f"{folder}/whole.cpp", "w") as out:
            out.write('#include "unit.h"\n')
        for compiler in (["gcc", *C_FLAGS, "whole.c"],
                         ["g++", "-std=c++17", "-Wall", "-Werror", "whole.cpp"]):
            result = run([*compiler, "-fsyntax-only", "-fmax-errors=200", "-I.", *INCLUDES],
                         cwd=folder)
            guilty = set(re.findall(r"error: [^\n]*?\bM(\d+)_", result.stderr)) | \
                set(re.findall(r"^ *\d+ \|[^\n]*?\bM(\d+)_", result.stderr, flags=re.M))
            bad += [f"{kind} '{names[int(n) - 2]}': {compiler[0]} refuses its C"
                    for n in sorted(guilty, key=int)]
            if result.returncode and not guilty:
                bad.append(f"{kind}: {result.stderr}")
    print(f"{tried} pairs of name and kind: {refused} refused, {len(bad)} wrong")
    print("\n".join(bad))
    sys.exit(1 if bad else 0)


main()
