# SPDX-License-Identifier: MIT
"""runner: runs chosen tests by CTest, prints the progress, and writes JUnit."""
import dataclasses
import re
import sys
import threading
import time
import xml.etree.ElementTree as xml

from tool import Stop, run, write


@dataclasses.dataclass
class Result:
    name: str
    status: str  # "passed", "failed", "skipped"
    seconds: float
    log: str = ""
    end: str = ""  # of a failed test: "SegFault", "Timeout"; "" if it ended by itself
    seed: str = ""


class Progress:
    """Prints the progress: on a terminal in one line that it rewrites, else at each tenth. It
    reports a failure at once."""

    def __init__(self, tests, history, jobs):
        self.jobs, self.total, self.done, self.failed = jobs, len(tests), 0, 0
        self.seconds = {test.name: history.seconds(test.name) for test in tests}
        self.running = {}  # name: when it began
        self.due = {}  # name: the age in seconds at which it is named
        self.lock = threading.Lock()

    def start(self, name):
        usual = self.seconds.get(name)
        self.running[name] = time.monotonic()
        self.due[name] = 60 if usual is None else max(10, 3 * usual)

    def watch(self, done):
        """Names each test that takes three times its usual time (60 s if that is not known) with
        its age, and again at twice that age, until `done` is set."""
        while not done.wait(1):
            self.name_late()

    def name_late(self):
        for name, begin in list(self.running.items()):
            age, usual = time.monotonic() - begin, self.seconds.get(name)
            if age >= self.due[name]:
                self.due[name] = 2 * age
                self._line(f"{name} has run for {age:.0f} s, usually " + (
                    "unknown" if usual is None else f"{usual:.1f} s"), True)

    def end(self, name, status, seconds):
        self.running.pop(name, None)
        self.seconds.pop(name, None)
        self.done += 1
        if status == "failed":
            self.failed += 1
            self._line(f"FAILED {name} ({seconds:.1f} s)", True)
        known = all(each is not None for each in self.seconds.values())
        seconds = int(sum(self.seconds.values()) / self.jobs) if known else 0
        left = f"{seconds // 60}:{seconds % 60:02}" if known else self.total - self.done
        tenth = 10 * self.done // self.total != 10 * (self.done - 1) // self.total
        self._line(f"{self.done} of {self.total}, {self.failed} failed, {left} left: "
                   f"{' '.join(sorted(self.running))}", tenth and not sys.stdout.isatty())

    def _line(self, text, keep):
        with self.lock:
            if sys.stdout.isatty():
                print(f"\r{text[:110]}\033[K", end="\n" if keep else "", flush=True)
            elif keep:
                print(text, flush=True)


def readable(log):
    """A log without colours (the first word is CTest's for ESC) and without endless lines."""
    def short(line):
        return line if len(line) <= 2000 else \
            f"{line[:1000]} ... {len(line)} characters ... {line[-500:]}"
    log = re.sub(r"\[NON-XML-CHAR-0x1B\]\[[0-9;]*m", "", log)
    return "".join(short(line) + "\n" for line in log.splitlines())


def run_tests(tests, build, out, seed, jobs, history):
    """Runs tests in parallel, those that failed last time first."""
    chosen, junit = out / "tests.list", (out / f"junit-{seed}.xml").resolve()
    # start, end, stride: none but the numbers
    write(chosen, ",".join(["0,0,0", *(str(test.number) for test in tests)]) + "\n")
    junit.unlink(missing_ok=True)
    progress, ends = Progress(tests, history, jobs), {}
    print(f"{len(tests)} tests, SEED={seed}", flush=True)

    def on_line(line):
        if begun := re.match(r" *Start +\d+: (\S+)", line):
            progress.start(begun[1])
        if ended := re.match(r" *\d+/\d+ Test +#\d+: (\S+) \.*(.*?) +([0-9.]+) sec", line):
            name, how = ended[1], ended[2]
            ends[name] = how
            progress.end(name, "passed" if "Passed" in how else
                         "skipped" if "Skipped" in how else "failed", float(ended[3]))
    done = threading.Event()
    threading.Thread(target=progress.watch, args=[done], daemon=True).start()
    try:
        status, text = run(
            ["ctest", "--test-dir", build, "-I", chosen.resolve(), "-j", jobs, "--output-junit",
             junit, "--test-output-size-passed", 4096, "--test-output-size-failed", 200000,
             "--test-output-truncation", "middle"], {"SEED": seed}, on_line)
    finally:
        done.set()
    if sys.stdout.isatty():
        print("\r\033[K", end="")
    try:
        cases = xml.parse(junit).iter("testcase")
    except FileNotFoundError:
        raise Stop(f"ctest gave no results ({status}):\n{text}") from None
    except xml.ParseError as error:
        raise Stop(f"{junit}: {error}; is the disk full?") from None
    results = []
    for case in cases:
        log = readable(case.findtext("system-out") or "")
        how = {"run": "passed", "fail": "failed"}.get(case.get("status"), "skipped")
        if log.startswith("Unable to find"):  # its program
            how = "failed"
        end = ends.get(case.get("name"), "")
        results.append(Result(
            case.get("name"), how, float(case.get("time")), log,
            "" if end in ("***Failed", "***Not Run") else re.sub("[*]{3}(Exception: *)?", "", end),
            seed))
    return results


def write_junit(path, results, failures, begin, commit):
    """JUnit of all results, for CI systems: a suite for each program and seed, begun at `begin`
    (RFC 3339); a failure's text says where to look. Jenkins' junit-10.xsd has no properties of a
    test."""
    of, suites = {id(failure.result): failure for failure in failures}, {}
    for result in results:
        suites.setdefault((result.name.split(".")[0], result.seed), []).append(result)

    def totals(results):
        failed, skipped = (sum(result.status == how for result in results)
                           for how in ("failed", "skipped"))
        return {"tests": str(len(results)), "failures": str(failed), "errors": "0",
                "skipped": str(skipped), "time": f"{sum(each.seconds for each in results):.3f}"}
    whole = totals(results)
    del whole["skipped"]  # as the schema has it
    root = xml.Element("testsuites", name="icesoc", **whole)
    for (name, seed), results_ in suites.items():
        suite = xml.SubElement(root, "testsuite", name=name, timestamp=begin, **totals(results_))
        properties = xml.SubElement(suite, "properties")
        for key, value in (("seed", seed), ("commit", commit)):
            xml.SubElement(properties, "property", name=key, value=value)
        for result in results_:
            case = xml.SubElement(suite, "testcase", name=result.name, classname=name,
                                  time=f"{result.seconds:.3f}")
            if result.status == "failed":
                failure = of[id(result)]
                told = xml.SubElement(case, "failure",
                                      message=f"{failure.reason} (SEED={result.seed})")
                told.text = "".join(
                    f"{key}: {value}\n" for key in ("changed", "log", "repeat", "wave")
                    if (value := getattr(failure, key)))
                xml.SubElement(case, "system-out").text = result.log
            elif result.status == "skipped":
                xml.SubElement(case, "skipped")
    write(path, '<?xml version="1.0"?>\n' + xml.tostring(root, encoding="unicode") + "\n")
