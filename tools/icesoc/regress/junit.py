# SPDX-License-Identifier: MIT
"""junit: reads and writes test results as JUnit. CTest writes its JUnit file only when it ends; if
a CTest run was stopped, this module reads the log instead."""
import collections
import dataclasses
import pathlib
import re
import xml.etree.ElementTree as xml

from icesoc.util.errors import Stop
from icesoc.util.files import write


@dataclasses.dataclass
class Result:
    name: str
    status: str  # "passed", "failed", "skipped"
    seconds: float
    log: str = ""
    end: str = ""  # how a failed test was ended: "SegFault", "Hang, ..."; "" if it ended by itself
    seed: str = ""


def read_junit(path):
    """Returns the results in a JUnit file that CTest or write_junit has written."""
    try:
        cases = xml.parse(path).iter("testcase")
    except xml.ParseError as error:
        raise Stop(f"{path}: {error}; check whether the disk is full") from None
    results = []
    for case in cases:
        parts = {each.tag for each in case}
        status = "failed" if parts & {"failure", "error"} else \
            "skipped" if "skipped" in parts else "passed"
        results.append(Result(case.get("name"), status, float(case.get("time")),
                              case.findtext("system-out") or ""))
    return results


def begun(line):
    """Returns the name in a line that CTest prints when a test starts; None for any other line. A
    name can contain spaces, for example if it ends with the parameters of a GoogleTest case."""
    found = re.match(r" *Start +\d+: (.*\S)", line)
    return found and found[1]


def ended(line):
    """Parses a line that CTest prints when a test has ended. Returns (name, outcome, seconds,
    number of tests of the run), with an outcome such as "***Skipped"; None for any other line."""
    found = re.match(r" *\d+/(\d+) Test +#\d+: (.*?) \.+ *(\S.*?) +([0-9.]+) sec", line)
    return found and (found[2], found[3], float(found[4]), int(found[1]))


def status_of(outcome):
    """Returns the status of an outcome that CTest prints: `Passed`, `***Failed`, `***Skipped`."""
    return "passed" if "Passed" in outcome else "skipped" if "Skipped" in outcome else "failed"


def logs(build):
    """Returns the outputs of the finished tests by name, from the log that CTest writes while it
    runs. The log does not distinguish skipped tests from passed ones."""
    folder = pathlib.Path(build) / "Testing/Temporary"
    path = next((path for name in ("LastTest.log.tmp", "LastTest.log")
                 if (path := folder / name).exists()), None)
    log = path.read_text(errors="replace") if path else ""
    return dict(re.findall(r'^"(.+)" start time: .*\nOutput:\n-{58}\n([\s\S]*?)^<end of output>\n'
                           r"Test time =", log, re.M))


def finished(build, ends):
    """Returns the results of a run that was stopped. `ends`: (outcome, seconds) of each test."""
    known = logs(build)
    return [Result(name, status_of(outcome), seconds, known.get(name, ""))
            for name, (outcome, seconds) in ends.items()]


def kind_of(result):
    """Returns the JUnit kind: a failed test that did not end by itself is an error."""
    return {"skipped": "skipped", "passed": ""}.get(result.status,
                                                    "error" if result.end else "failure")


def write_junit(path, results, begin, failed, **properties):
    """Writes the JUnit of all results, for CI systems. Each program and seed is a suite that began
    at `begin` (RFC 3339) and has the given properties; empty properties are left out. `failed`
    returns the message and the text of a failed result. A test has no properties, because Jenkins'
    junit-10.xsd does not allow them."""
    suites = {}
    for result in results:
        suites.setdefault((result.name.split(".")[0], result.seed), []).append(result)

    def totals(results):
        kinds = collections.Counter(kind_of(result) for result in results)
        return {"tests": str(len(results)), "failures": str(kinds["failure"]),
                "errors": str(kinds["error"]), "skipped": str(kinds["skipped"]),
                "time": f"{sum(each.seconds for each in results):.3f}"}
    whole = totals(results)
    del whole["skipped"]  # required by the schema
    root = xml.Element("testsuites", name="icesoc", **whole)
    for (name, seed), results_ in suites.items():
        suite = xml.SubElement(root, "testsuite", name=name, timestamp=begin, **totals(results_))
        entries = xml.SubElement(suite, "properties")
        for key, value in {"seed": seed, **properties}.items():
            if value:
                xml.SubElement(entries, "property", name=key, value=value)
        for result in results_:
            case = xml.SubElement(suite, "testcase", name=result.name, classname=name,
                                  time=f"{result.seconds:.3f}")
            if result.status == "failed":
                message, text = failed(result)
                xml.SubElement(case, kind_of(result), message=message).text = text
                # characters that XML does not allow are replaced
                log = re.sub(r"[^\t\n\x20-\uFFFD]", "?", result.log)
                xml.SubElement(case, "system-out").text = log
            elif result.status == "skipped":
                xml.SubElement(case, "skipped")
    write(path, '<?xml version="1.0"?>\n' + xml.tostring(root, encoding="unicode") + "\n")
