#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""agreement: checks that slice2c accepts, warns about and rejects the same code as ZeroC's
slice2cpp.

agreement.py SLICE2C CASES.ice WORK   Each case in the file begins with a line "// ok: ...",
    "// warning: ..." or "// error: ..." and ends at the next such line. Accordingly, both compilers
    must accept the case silently, accept it with a warning, or reject it; the first line that they
    report must be the same. Then each keyword of Slice is tested as a name of each kind.
agreement.py SLICE2C FOLDER           Tests ZeroC's own wrong files (icesoc.util.fetch zeroc). For
    each line with a message of slice2cpp, slice2c must also report a message, or one of the REASONS
    must apply.
"""
import collections
import os
import pathlib
import re
import subprocess
import sys
import tempfile

NEXT = "slice2c reports the line of the name, slice2cpp the line of the bracket after it"
# regular expression for "FILE:LINE: message", with the reason why slice2c does not report this
REASONS = {
    "only at module scope|IdentAsKeyword.*(syntax error|capitalization from (dict|enum))":
        "after a syntax error slice2cpp has lost the module; slice2c continues in it",
    "metadata `cpp:": "metadata of C++ alone",
    "StructMembers.ice:10:": NEXT,
    "Undefined.ice:9:": "a name that is not a type is reported once, not at each use",
    "ConstDef.ice:132:": "a value that was refused above is refused once",
    "NotType.ice:28:": "a struct with a rejected member is not also reported as empty",
    "IllegalIdentifier.ice:23:": "names the line of the wrong character, not the next line"}
SAID = re.compile(r"[^:\n]*?([^/:\n]+\.ice):(\d+):(.*)")
WANTED = {"ok": (0, False), "warning": (0, True), "error": (1, True)}
KEYWORDS = """module class interface exception struct sequence dictionary enum out extends
    implements throws void byte bool short int long float double string Object LocalObject local
    const false true idempotent optional Value""".split()
NAMES = """struct % { int a; };|struct S# { int %; };|enum % { x# };|enum E# { % };|interface % { };
    |interface I# { void %(); };|interface I# { void op(int %); };|const int % = 1;|exception % { };
    |class % { };|sequence<int> %;|dictionary<int, int> %;|module % { };""".split("|")


def said(compiler, file, work="out"):
    """Runs a compiler. Returns its exit status, and {line: messages in order}."""
    words = [compiler, "--output-dir", work, file.name]
    words += ["--underscore"] * ("Underscore" in file.name)
    run = subprocess.run(words, cwd=file.parent, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                         text=True)
    lines = collections.defaultdict(list)
    for line in run.stdout.splitlines():
        if match := SAID.match(line):
            lines[int(match[2])].append(f"{match[1]}:{match[2]}:{match[3]}")
    return int(run.returncode != 0), lines


def cases(compiler, file, work):
    pathlib.Path(work, "out").mkdir(parents=True, exist_ok=True)
    case, differ = pathlib.Path(work, "case.ice"), 0

    def both(text):
        case.write_text(text, encoding="utf-8")
        return said(compiler, case), said("slice2cpp", case)

    found = re.split(r"(?m)^// (?=(?:ok|warning|error): )", file.read_text(encoding="utf-8"))[1:]
    deep = [f"module M{n} {{\n" for n in range(200)] + ["struct S { int a; };"] + ["\n};"] * 200
    found += ["ok: modules in modules\n" + "".join(deep), "ok: every construct\n" +
              (file.parents[1] / "compiler/golden/everything.ice").read_text()]
    for text in found:
        ours, theirs = both("// " + text)
        if WANTED[text.partition(":")[0]] != (theirs[0], bool(theirs[1])) or \
                (ours[0], list(ours[1])[:1]) != (theirs[0], list(theirs[1])[:1]):
            differ += 1
            print(f"{text}\nslice2c: {ours}\nslice2cpp: {theirs}")
    for form in NAMES:  # slice2cpp rejects each keyword as a name, but accepts it after a backslash
        for escape, wanted in ("", len(KEYWORDS)), ("\\", 0):
            line = f"module A# {{ {form.strip()} }};\n"
            ours, theirs = both("".join(
                line.replace("%", escape + word).replace("#", str(n))
                for n, word in enumerate(KEYWORDS)))
            if ours[1].keys() != theirs[1].keys() or len(theirs[1]) != wanted:
                differ += 1
                print(f"{escape}{form}: slice2c: {sorted(ours[1])}, slice2cpp: {sorted(theirs[1])}")
    print(f"{len(found)} cases and {2 * len(NAMES)} files of keywords, {differ} on which the "
          "compilers differ")
    return differ


def zerocs(compiler, folder):
    counts, wrong = collections.Counter(), []
    files = sorted(folder.glob("*.ice"))
    with tempfile.TemporaryDirectory() as work:
        for file in files:
            ours, theirs = said(compiler, file, work)[1], said("slice2cpp", file, work)[1]
            for line, messages in theirs.items():
                if line in ours:
                    counts["the same line"] += 1
                elif line - 1 in ours and line - 1 not in theirs:
                    counts[NEXT] += 1
                else:
                    whys = {why for text, why in REASONS.items()
                            if any(re.search(text, message) for message in messages)}
                    counts.update(list(whys)[:1])
                    wrong += messages if not whys else []
    for why, count in counts.most_common():
        print(f"{count:5} {why}")
    print(f"{len(files)} files, {sum(counts.values())} lines; messages without a reason:", *wrong,
          sep="\n")
    return wrong or counts["the same line"] < 400


where = pathlib.Path(sys.argv[2])
sys.exit(1 if (cases(sys.argv[1], where, os.path.abspath(sys.argv[3])) if where.is_file() else
               zerocs(sys.argv[1], where)) else 0)
