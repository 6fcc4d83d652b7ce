#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""suite: runs ZeroC's own test client of a suite, and counts its checks.

suite.py FOLDER SUITE RUN [--Ice.Property=value...] ENDPOINT|PORT

A check is a call of the client's function test(), whether its argument is true or false. The
original client stops at its first failure. Here each statement is guarded, so that a failure does
not hide later ones. expected.toml contains the reason for each expected failure, and the number of
checks that must pass.
"""
import argparse
import ast
import fnmatch
import importlib.abc
import importlib.util
import os
import sys
import threading
import tomllib

import Ice

OWN = os.path.dirname(os.path.abspath(__file__))
passed = 0
failures = {}  # "File.py:line": text
lock = threading.Lock()
PATIENCE = 3  # seconds
TURNS = 200  # maximum number of iterations of a loop that waits for the server


def check(truth):
    global passed
    if not truth:
        raise RuntimeError("test assertion failed")
    with lock:
        passed += 1


def failed(where, error):
    if isinstance(error, Ice.ConnectionRefusedException):
        print("the server is gone, after", list(failures.items())[-1:])
        sys.stdout.flush()
        os._exit(1)
    with lock:
        failures.setdefault(where, "%s: %s" %
                            (type(error).__name__, str(error).strip().replace("\n", " ")[:160]))


def turn(turns):
    """Called in each iteration of a loop; ends a loop that waits without success after TURNS
    iterations."""
    turns.append(0)
    if len(turns) > TURNS:
        raise RuntimeError("waited for %d turns" % TURNS)


def wait(self, timeout=None, wait=threading.Condition.wait):
    """Waits for a condition that a callback of the client signals. The wait has a time-out, because
    the callback may have failed."""
    if not wait(self, timeout or PATIENCE) and timeout is None:
        raise RuntimeError("nothing came")


class Guard(ast.NodeTransformer):
    """Puts each statement of a function that is not within a `try` into a separate `try`."""

    def __init__(self, name):
        self.name = name

    def visit_Try(self, node):
        # only the whole statement is wrapped, because its body must be able to throw
        return self.guarded(node)

    def visit_FunctionDef(self, node):
        node.body = [self.visit(s) for s in node.body]
        return node

    def visit_ClassDef(self, node):
        node.body = [self.visit(s) if isinstance(s, ast.FunctionDef) else s for s in node.body]
        return node

    def visit_With(self, node):
        node.body = [self.visit(s) for s in node.body]
        return self.guarded(node)

    visit_For = visit_With

    def visit_While(self, node):
        begin, turn = ast.parse("__turns__ = []\n__turn__(__turns__)").body
        node.body.insert(0, turn)
        # the loop is limited, because it may wait for a call that has failed
        return self.guarded(node, begin)

    def visit_If(self, node):
        node.body = [self.visit(s) for s in node.body]
        node.orelse = [self.visit(s) for s in node.orelse]
        return self.guarded(node)

    def generic_visit(self, node):
        plain = isinstance(node, (ast.Expr, ast.Assign, ast.AugAssign))
        return self.guarded(node) if plain else node

    def guarded(self, node, *before):
        note = ast.parse("__failed__(%r, __error__)" % ("%s:%d" % (self.name, node.lineno))).body
        handler = ast.ExceptHandler(type=ast.Name("Exception", ast.Load()), name="__error__",
                                    body=note)
        return ast.copy_location(ast.Try(body=[*before, node], handlers=[handler], orelse=[],
                                         finalbody=[]), node)


class Loader(importlib.abc.Loader):
    def __init__(self, path):
        self.path = path

    def exec_module(self, module):
        tree = ast.parse(open(self.path).read(), self.path)
        tree.body = [s for s in tree.body if getattr(s, "name", "") != "test"]
        if module.__name__ != "Client":
            guard = Guard(os.path.basename(self.path))
            tree.body = [guard.visit(s) if isinstance(s, (ast.FunctionDef, ast.ClassDef)) else s
                         for s in tree.body]
        module.test, module.__failed__, module.__turn__ = check, failed, turn
        exec(compile(ast.fix_missing_locations(tree), self.path, "exec"), module.__dict__)


class Finder(importlib.abc.MetaPathFinder):
    """Loads the modules of the suite. Each of their statements is wrapped, so that a statement
    that fails does not end the test (see Guard)."""

    def find_spec(self, name, path, target=None):
        file = os.path.join(os.getcwd(), name + ".py")
        if not os.path.exists(file):
            return None
        return importlib.util.spec_from_file_location(name, file, loader=Loader(file))


def expected(run):
    """Returns the number of checks that must pass in this run, and {place: reason} for checks that
    need not pass."""
    with open(os.path.join(OWN, "expected.toml"), "rb") as file:
        known = tomllib.load(file)
    wanted = [n for runs, n in known["passed"].items() if fnmatch.fnmatch(run, runs)]
    reasons = {}
    for reason, places in known["by_design"].items():
        for runs, place in (p.split() for p in places):
            file, lines = place.split(":")
            if fnmatch.fnmatch(run, runs):
                reasons.update((f"{file}:{line}", reason) for line in lines.split(","))
    return wanted[0], reasons


def main():
    global PATIENCE
    parser = argparse.ArgumentParser()
    parser.add_argument("folder")
    parser.add_argument("suite")
    parser.add_argument("run", help="name of the run: SUITE-tcp-1.1")
    parser.add_argument("rest", nargs=argparse.REMAINDER,
                        help="Ice properties, then an endpoint or a port")
    a = parser.parse_args()
    where = a.rest.pop()
    endpoint = where if not where.isdigit() else "tcp -h 127.0.0.1 -p " + where
    properties = dict(word[2:].split("=", 1) for word in a.rest)
    os.chdir(os.path.join(a.folder, "Ice", a.suite))
    sys.meta_path.insert(0, Finder())
    sys.path.append(a.folder)
    import TestHelper
    if not endpoint.startswith("tcp"):
        PATIENCE = 60
    threading.Condition.wait = wait

    def createTestProperties(self, args=[], create=TestHelper.TestHelper.createTestProperties):
        made = create(self, list(args))
        for key, value in properties.items():
            made.setProperty(key, value)
        return made

    TestHelper.TestHelper.createTestProperties = createTestProperties
    TestHelper.TestHelper.getTestEndpoint = lambda *_, **__: endpoint
    import Client
    try:
        Client.Client().run([])
    except Exception as error:
        failed("Client.py:0", error)

    wanted, reasons = expected(a.run)
    byReason = {}
    unknown = 0
    print()
    for place, text in sorted(failures.items()):
        reason = reasons.get(place, reasons.get(place.split(":")[0] + ":*"))
        if reason is None:
            unknown += 1
            print("FAILED %s: %s" % (place, text))
        else:
            byReason.setdefault(reason, []).append(place)
    for reason, places in byReason.items():
        print("by design, %s: %s" % (reason, " ".join(places)))
    print("%s: %d checks passed (%d expected), %d by design, %d failed"
          % (a.run, passed, wanted, len(failures) - unknown, unknown))
    sys.stdout.flush()
    # exits without waiting for threads that the suite has started
    os._exit(0 if unknown == 0 and passed >= wanted else 1)


main()
