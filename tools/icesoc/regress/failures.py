# SPDX-License-Identifier: MIT
"""failures: collects for each failed test the reason, the log, a command that repeats the test, the
tests that fail with the same reason, and a waveform."""
import dataclasses
import os
import pathlib
import re
import shutil

from icesoc.regress.junit import Result
from icesoc.util import spelling
from icesoc.util.files import write

# Lines that a test runner prints, or that end the log of a flight. They cannot be the reason of a
# failure, because names, times and counts in them differ between failures with the same cause.
RUNNERS = re.compile(
    r"^\[|^at clock cycle|tests? (ran|FAILED|PASSED)|^\s*\d+ FAILED|note:|trace: |Running main|"
    r"^The mission failed|^To (write|debug) |^icesoc-sim: Cortex-M3: |"
    r"^icesoc-sim: [0-9.]+ s simulated|"
    r"^-- \S+ \S+ XBeeAT: |^[\s{}()\[\];=-]*$|^(ERROR|FAIL): test_|^FAILED[ :]|^Ran \d+ test|"
    r"^g?make(\[\d+\])?: \*\*\*|^ninja: build stopped|^collect2: |^terminate called|as expected$|"
    r"^#\d|^Thread \d|^Stack of |^Google Test trace:|stands at clock", re.I)
# A message of a compiler, a linter or a sanitizer about a place in a file.
OF_FILE = re.compile(
    r"^%(Error|Warning)[^ ]*: [^ ]+:\d+:|"
    r"^[^ ]+:\d+:(\d+:)? *((fatal|runtime) error|error|warning):|"
    r"^SUMMARY: \S+Sanitizer: |^[^ ]+\.vhdl?:\d+:\d+:|: undefined reference to ")
# A message of a test about a value, or an exception of Python or Ice.
OF_VALUE = re.compile(r"\berror\b|(?<!as )\bexpected\b|\bdiffers?\b|"
                      r"^(\S+: )*(\w+\.)*(::\w+)*\w*(Error|Exception):|^what\(\): ", re.I)
# GoogleTest's lines about two unequal values, and about a condition.
EQUALITY = re.compile(r"(?m)^Expected equality of these values:"
                      r"\n +(.*)(?:\n +Which is: (.*))?\n +(.*)(?:\n +Which is: (.*))?$")
# GoogleTest's line about an unexpected exception; the description can have several lines.
THROWN = re.compile(r'(?m)^C\+\+ exception with description "((?:.|\n)*?)" thrown in .*\.$')
# GHDL's line about a failed assertion: file and line, then the text of the assertion.
ASSERTED = re.compile(r"(?m)^(\S+\.vhdl?:\d+):\d+:@\w+:\(assertion \w+\): (.*)$")
PLACE = re.compile(r"(?:^|\n)(?:[.][.]/)*(\S+:\d+): Failure\n")  # in GoogleTest's log
CONDITION = re.compile(r"(?m)^Value of: (.*)\n +Actual: (.*)\nExpected: (.*)$")


@dataclasses.dataclass
class Failure:
    result: Result
    reason: str  # line of the log with the error
    # the reason without its numbers; failures with the same bucket probably have the same cause
    bucket: str = ""
    repeat: str = ""  # command that repeats the test
    # place of the failure as printed by GoogleTest or GHDL, such as
    # "tests/sw/link/link_test.cpp:185", or ""
    place: str = ""
    changed: str = ""  # text about files that have changed since the test passed, or ""
    log: str = ""  # path of the log
    wave: str = ""  # path of an FST or VCD file, or ""
    about: str = ""  # text that names the relevant signals: the assertion of a proof, or the reason
    scope: str = ""  # instance to look at first, such as "u_window.u_wrapper", or ""
    # True if the failed assertion of a proof is in the proven module itself
    own_assertion: bool = False
    save: str = ""  # path of the GTKWave save file, or ""
    clock: int = 0  # clock of the failure in the waveform; 0: the end of the waveform

    def entry(self):
        """Returns the message and the text of the failure for JUnit."""
        return f"{self.reason} (SEED={self.result.seed})", "".join(
            f"{key}: {value}\n" for key in ("changed", "log", "repeat", "wave")
            if (value := getattr(self, key)))


def elements(text):
    """Returns the elements of a list that GoogleTest has printed: "{ 1, 2 }". An element may
    contain commas: a text, a character, or a pair or list in parentheses or braces."""
    found, depth = [""], 0
    for word in re.findall(r'"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])*\'|, |.', text[1:-1].strip()):
        depth += (word in ("{", "(")) - (word in ("}", ")"))
        if word == ", " and not depth:
            found.append("")
        else:
            found[-1] += word
    return found if found != [""] else []


def comparison(match):
    """Returns the difference in a GoogleTest message, such as "status is 5, not ICE_OK, which is
    0". For two lists, returns the first different element: "list differs at [2]: expected 5, got
    4". If GoogleTest has cut the lists off before this element, returns the last known index."""
    a, of_a, b, of_b = match.groups()
    if of_a and of_b and of_a[0] == of_b[0] == "{":
        got, expected = elements(of_a), elements(of_b)
        for index, (x, y) in enumerate(zip([*got, "its end"], [*expected, "its end"])):
            if "..." in (x, y):  # GoogleTest prints 32 elements
                return (f"{a} differs beyond [{index - 1}], where its text was cut off; "
                        "EXPECT_SAME reports the place")
            if x != y:
                return f"{a} differs at [{index}]: expected {y}, got {x}"
    if not of_a:
        a, of_a, b, of_b = b, of_b, a, of_a
    return (f"{a} is {of_a}" if of_a else a) + f", not {b}" + (f", which is {of_b}" if of_b else "")


def reason_of(log):
    """Returns the reason in a test's log: the text of a failed assertion in VHDL, or GoogleTest's
    lines after the first "Failure"; otherwise the first compiler message about a file, the first
    line about an error, or the last line. If an exception ends in a colon, the next line is
    included. From a diff, the first removed line and the line that replaces it are included."""
    last, of_file, of_value, failure = "", "", "", None
    if asserted := ASSERTED.search(log):
        return asserted[2]
    # the description of a failed test, which Python's unittest prints, is not a reason
    log = re.sub(r"(?m)^((?:ERROR|FAIL): test_.*\n)(?:.*\n)*?-{70}$", r"\1", log)
    log = CONDITION.sub(r"\1 is \2, not \3", EQUALITY.sub(comparison, log))
    log = THROWN.sub(r"\1", log)
    log = re.sub(r"((?:Error|Exception)\b.*:)\n+ *(?=\S)", r"\1 ", log)
    log = re.sub(r"(?m)^@@ .*\n(?: .*\n)*(-.*)\n([+].*)", r"differs: \1 \2", log)
    for line in log.splitlines():
        below = line.startswith(" ") and last.endswith(":")
        line = line.strip()
        if failure is not None and (not line or line[0] == "[" or len(failure) == 4
                                    or line.endswith(": Failure")):
            break
        if not line or RUNNERS.search(line) or (below and failure is None):
            continue
        if failure is not None:
            failure.append(re.sub(r"^(\.\./)+", "", line))
            continue
        if line.endswith("Failure"):
            failure = []
        last = line
        of_file = of_file or (line if OF_FILE.search(line) else "")
        of_value = of_value or (line if OF_VALUE.search(line) else "")
    return "; ".join(failure) if failure is not None else of_file or of_value or last


def find_assertion(failure):
    """Adds the failing assertion to the failure of a proof: its location and text, its instance,
    and whether it is in the proven module itself. Yosys's message contains the instance, file and
    line of the assertion, and the lines of all enclosing instances."""
    match = re.search(
        r"Assert failed in \S+: (\S+) \((?:\$flatten/)?(?:(\S*?)\.?\$assert\$(\S+)\$)?",
        failure.result.log)
    places = list(re.finditer(r"([^|]*?((?:hdl|bus|ip)/[^|:]+)):(\d+)[.](\d+)-(\d+)",
                              match[1])) if match else []  # file:89.41-91.66|...
    if not places:
        return
    at = next((p for p in reversed(places) if match[3] and match[3] + "." in p[0]), places[0])
    failure.scope = (match[2] or "").replace("./", ".")
    first, last = int(at[3]), int(at[5])
    path = pathlib.Path(at[1].lstrip("|"))
    lines = path.read_text().splitlines()[first - 1:last] if path.exists() else []
    if len(lines) > 1:  # the location that Yosys prints begins at the end of the previous statement
        lines[0] = lines[0][int(at[4]):]
    failure.about = " ".join(filter(None, map(str.strip, lines)))
    asserts = next((i for i, line in enumerate(lines) if "assert" in line), max(0, len(lines) - 1))
    failure.reason = failure.bucket = f"{at[2]}:{first + asserts}: {failure.about}"
    module = re.sub("_proof.*", "", pathlib.Path(at[2]).stem)
    failure.own_assertion = failure.result.name.startswith("formal." + module)


def rank(failure, tests):
    """Returns the sort key of a failure; failures with a lower key should be read first. Proofs
    come first, because they name the property; the proof of an inner module comes before the proofs
    of the modules that contain it. Then come checks of sources, tests of one block, of the chip and
    of the firmware, and whole missions."""
    test = tests.get(failure.result.name)
    text = " ".join([failure.result.name, *([test.place, *test.labels] if test else [])])
    order = ("^formal[.]", "^(lint|tree)[.]", r"^(slice[.]|\w+[.]vhdl\b)|(hdl|bus|ip)/?.* rtl",
             " rtl", " (firmware|models)", " interop")
    return -1 if failure.own_assertion else next(
        (i for i, kind in enumerate(order) if re.search(kind, text)), len(order))


def examine(results, tests, out):
    """Returns the failures in reading order. Stores their logs, and the traces of proofs, in
    <out>/failures/."""
    folder, failures = out / "failures", []
    shutil.rmtree(folder, ignore_errors=True)
    for result in [result for result in results if result.status == "failed"]:
        folder.mkdir(parents=True, exist_ok=True)
        words = reason_of(result.log)
        if result.end or not words:
            mute = "" if result.end.startswith("Hang") else " without a word"
            words = (result.end or "failed") + (f": {words}" if words else mute)
        short = re.sub(r"0x[0-9a-fA-F]+|[0-9]+(\.[0-9]+)?", "#", re.sub("[^ ]*/", "", words))
        exact = re.sub(r"([.+*?()\[\]{}|^$\\])", r"\\\1", result.name)
        base = f"{folder}/{re.sub('[^A-Za-z0-9_.-]', '_', result.name)}"
        again = spelling.command("test", spelling.option("name", f"^{exact}$"),
                                 spelling.option("seed", result.seed))
        failure = Failure(result, words, short[:160], again, log=f"{base}-{result.seed}.log",
                          about=words)
        find_assertion(failure)
        if place := PLACE.search(result.log) or ASSERTED.search(result.log):
            failure.place = os.path.relpath(place[1]) if place[1][0] == "/" else place[1]
        trace = re.search(r"trace: (\S+[.]vcd)", result.log)  # proofs print this line
        if trace and os.path.exists(trace[1]):
            failure.wave = f"{base}.vcd"
            shutil.copyfile(trace[1], failure.wave)
        write(failure.log, f"# {failure.repeat}\n{result.log}")
        failures.append(failure)
    return sorted(failures, key=lambda failure: rank(failure, tests))
