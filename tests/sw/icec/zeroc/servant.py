#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""servant: generates a servant in C from the statements of its operations.

servant.py BODIES HEADER... >servant.c

The generated headers contain the signatures; BODIES contains only the statements of the operations:

    C, up to a line %%
    prefix Test_Thing_ Test_Derived_    the operations below belong to these interfaces
    echo op1 op2*                       each out parameter gets the in parameter of its type
    op3 op4: statements;                continued in lines that begin with a blank

Names are shell patterns. In statements the parameters have their Slice names, `result` is the
result, and `ex` is the exception.
"""
import fnmatch
import re
import sys

PROTOTYPE = re.compile(r"^Ice_Status (\w+)\((\w+) self,\s*([^;]*?)const Ice_Current \*current\);",
                       re.M)


def parameters(text):
    """Returns the parameters of a signature as [(type, name)]."""
    words = [" ".join(p.split()) for p in text.split(",") if p.strip()]
    return [re.fullmatch(r"(.*?)(\w+)", w).groups() for w in words]


def echo(found, classes):
    """Returns statements that copy each in parameter to the out parameter of the same type, in
    order."""
    plain = lambda t: t.replace("const", "").replace("*", "").strip()
    isOut = lambda t: "**" in t if plain(t) in classes else "const" not in t and "*" in t
    sources = [(t, n) for t, n in found if not isOut(t)]
    used, lines = {}, []
    for kind, name in found:
        if not isOut(kind):
            continue
        same = [s for s in sources if plain(s[0]) == plain(kind)]
        source, value = same[min(used.get(plain(kind), 0), len(same) - 1)]
        used[plain(kind)] = used.get(plain(kind), 0) + 1
        # the type of a class is a pointer on both sides
        levels = source.count("*") - (kind.count("*") - 1)
        lines.append("*%s = %s%s;" % (name, "*" * levels, value))
    return "\n    ".join(lines)


def main():
    head, rest = open(sys.argv[1]).read().split("\n%%\n")
    rest = re.sub(r"\n[ \t]+", "\n ", rest)
    signatures, classes = {}, set()
    for header in sys.argv[2:]:
        text = open(header).read()
        classes.update(re.findall(r"#define (\w+)_cast\(", text))
        for name, own, between in PROTOTYPE.findall(text):
            signatures[name] = (own, parameters(between))
    print("/* Made by servant.py from %s. */\n%s" % (sys.argv[1].split("/")[-1], head))
    prefixes, done = [""], set()
    for line in re.sub(r"\n ", "\x01", rest).splitlines():
        if not line or line.startswith("#"):
            continue
        if line.startswith("prefix "):
            prefixes = line.split()[1:]
            continue
        names, _, body = (line[5:], "", None) if line.startswith("echo ") else line.partition(":")
        for pattern in [p + n for n in names.split() for p in prefixes]:
            found = fnmatch.filter(signatures, pattern)
            if not found and len(prefixes) == 1:
                sys.exit("servant: no operation %s" % pattern)
            for name in set(found) - done:
                done.add(name)
                own, these = signatures[name]
                text = echo(these,
                            classes) if body is None else body.strip().replace("\x01", "\n    ")
                voids = "".join(" (void)%s;" % n for n in ["self", "current"] +
                                [n for _, n in these])
                print("\nIce_Status %s(%s self,%s const Ice_Current* current) {\n    %s\n    {\n  "
                      "  %s\n    }\n"
                      "    return ICE_OK;\n}" % (name, own, "".join(" %s%s," % p for p in these),
                                                 voids.strip(), text))


main()
