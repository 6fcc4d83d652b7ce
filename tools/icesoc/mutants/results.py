# SPDX-License-Identifier: MIT
"""results: reads and writes results of mutants as JUnit: planted.xml for seeded bugs, drawn.xml for
random mutants that Yosys has generated.

A mutant is a test case that passes if a test or proof catches the mutant. A case is skipped if the
mutant behaves like the module, so that it is not a bug. Attributes of a case: name, classname (the
test or proof), time, file and line. A failure has the result as its message. Properties of the case
contain all other facts about the mutant.
"""
import collections
import dataclasses
import xml.etree.ElementTree as xml

from icesoc.util.errors import Stop
from icesoc.util.files import write as write_file

GATE = 95  # per cent; share of the drawn mutants of each module that must at least be caught
PASSED, SKIPPED = "caught", "same"


@dataclasses.dataclass
class Mutant:
    name: str    # block/bug, or module/proof.number
    result: str  # "caught", "same" (not a bug), "SURVIVED", "does not build", ...
    test: str    # test or proof that caught it, or should have caught it
    seconds: float
    place: str = ""  # file:line
    # drawn mutants: module, what the mutant does, and how model.py plants it
    more: dict = dataclasses.field(default_factory=dict)


def write(path, mutants, **properties):
    """Writes a file. `properties`: facts about the run."""
    counts = collections.Counter(each.result for each in mutants)
    bad = len(mutants) - counts[PASSED] - counts[SKIPPED]
    suite = xml.Element("testsuite", name="mutants", tests=str(len(mutants)), failures=str(bad),
                        errors="0", skipped=str(counts[SKIPPED]))
    add_properties(suite, properties)
    for each in mutants:
        file, _, line = each.place.partition(":")
        where = {"file": file, "line": line} if line else {}
        case = xml.SubElement(suite, "testcase", name=each.name, classname=each.test,
                              time=f"{each.seconds:.1f}", **where)
        add_properties(case, each.more)
        if each.result == SKIPPED:
            xml.SubElement(case, "skipped")
        elif each.result != PASSED:
            xml.SubElement(case, "failure", message=each.result)
    xml.indent(suite)
    write_file(path, '<?xml version="1.0"?>\n' + xml.tostring(suite, encoding="unicode") + "\n")


def add_properties(element, properties):
    if properties:
        parent = xml.SubElement(element, "properties")
        for name, value in properties.items():
            xml.SubElement(parent, "property", name=name, value=str(value))


def properties_of(element):
    return {each.get("name"): each.get("value") for each in element.findall("properties/property")}


def read(path):
    """Returns (properties of the run, mutants) of a file; two empty results if it is missing."""
    try:
        suite = xml.parse(path).getroot()
    except FileNotFoundError:
        return {}, []
    except xml.ParseError as error:
        raise Stop(f"{path}: {error}; remove the file and run the mutants again") from None
    mutants = []
    for case in suite.iter("testcase"):
        failure = case.find("failure")
        result = failure.get("message") if failure is not None else \
            SKIPPED if case.find("skipped") is not None else PASSED
        place = f"{case.get('file')}:{case.get('line')}" if case.get("file") else ""
        mutants.append(Mutant(case.get("name"), result, case.get("classname"),
                              float(case.get("time")), place, properties_of(case)))
    return properties_of(suite), mutants


def scores(mutants):
    """Returns the counts of drawn mutants of each module, and the score: the share that a proof or
    a test caught, per cent. Mutants that are not bugs or that do not run are left out."""
    found = {}
    for module in sorted({each.more["module"] for each in mutants}):
        mine = [each for each in mutants if each.more["module"] == module]
        count = collections.Counter(each.result for each in mine)
        judged = len(mine) - count[SKIPPED] - count["BROKEN"]
        by_tests = sum(each.result == PASSED and not each.test.startswith("formal.")
                       for each in mine)
        found[module] = {"drawn": len(mine), "same": count[SKIPPED], "judged": judged,
                         "caught": count[PASSED], "by_tests": by_tests,
                         "score": round(100 * count[PASSED] / judged, 1) if judged else 100.0}
    return found
