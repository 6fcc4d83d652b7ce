#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""pages: checks every Markdown page.

    pages.py TREE

A link must lead to a file in the repository and, if it names a heading, to a heading that exists. A
path in backquotes must exist, and so must a GoogleTest case. An empty line must end each table.
docs/architecture.md must list every page in docs/. Prints a line for each fault; the exit status is
then 1. (icesoc.site.figures checks the figures in pages.)
"""
import fnmatch
import os
import re
import subprocess
import sys


def exists(tree, path, files):
    """Returns True if a path that a page names is in the repository. The path may also be a folder,
    a file name without its ending, or a pattern."""
    path = path.rstrip("/")
    pattern = "^" + re.escape(path).replace(r"\*", "[^/]*") + r"(/|$|\.)"
    return any(re.match(pattern, f) for f in files)


def anchors(page):
    """Returns the anchors of a page's headings, as GitHub generates them."""
    headings = re.findall(r"^#+ (.*)$", open(page).read(), re.M)
    return {re.sub(r"[^\w -]", "", h).lower().replace(" ", "-") for h in headings}


def cases(tree, files):
    """Returns the GoogleTest cases of the tree, as Suite.Case."""
    texts = (open(os.path.join(tree, f), encoding="utf-8").read() for f in files
             if f.endswith("_test.cpp"))
    return {".".join(names) for text in texts
            for names in re.findall(r"^(?:TYPED_)?TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)", text, re.M)}


def missing_cases(line, known):
    """Yields the names in backquotes that look like a case, or a pattern of cases, but match none
    of the known cases."""
    suites = {name.split(".")[0] for name in known}
    for text, name in re.findall(r"`((?:test_\w+\.)?([A-Z]\w*\.[A-Z*][\w*]*)(?:/[\w*]+)?)`", line):
        if name.split(".")[0] in suites and not fnmatch.filter(known, name):
            yield text
    for text, pattern in re.findall(r"`(test_\w+\.(\*\w[\w*]*))`", line):
        if not fnmatch.filter(known, pattern):
            yield text


def check(tree, page, files, tests):
    code, before = False, ""
    folders = "|".join(sorted({re.escape(f.split("/")[0]) for f in files if "/" in f}))
    for number, line in enumerate(open(os.path.join(tree, page)), 1):
        line = line.rstrip("\n")
        if re.match(r"\s*```", line):
            code = not code
        if code:
            continue
        if before.startswith("|") and line and not line.startswith("|"):
            yield f"{page}:{number}: expected an empty line after the table"
        before = line
        for target in re.findall(r"\]\(([^)#\s]+)[^)]*\)", line):
            if "://" not in target and not target.startswith("../../actions/"):  # GitHub's
                path = os.path.normpath(os.path.join(os.path.dirname(page), target))
                if not exists(tree, path, files):
                    yield f"{page}:{number}: links to {path}, which is not in the repository"
        for target, anchor in re.findall(r"\]\(([^)#\s]*)#([^)\s]+)\)", line):
            path = os.path.normpath(os.path.join(os.path.dirname(page), target)) if target else page
            known = path.endswith(".md") and path in files
            if known and anchor not in anchors(os.path.join(tree, path)):
                yield f"{page}:{number}: {path} has no heading #{anchor}"
        for path in re.findall(rf"`((?:{folders})/[\w./*-]+)`", line):
            # names that the guides use as examples
            example = re.search("low_pass|my_uart|[pP]ump|NAME", path)
            if not example and not exists(tree, path, files):
                yield f"{page}:{number}: {path} does not exist"
        for text in missing_cases(line, tests):
            yield f"{page}:{number}: no test is called {text}"


def main(words):
    if len(words) != 1 or words[0].startswith("-"):
        sys.exit(__doc__)
    tree = words[0]
    listing = "grep --no-index --exclude-standard --no-color -l".split()
    files = subprocess.check_output(["git", "-C", tree, *listing, ""], text=True).split("\n")
    pages = [f for f in files if f.endswith(".md") and os.path.exists(os.path.join(tree, f))]
    tests = cases(tree, files)
    wrong = [w for page in pages for w in check(tree, page, files, tests)]
    index = open(os.path.join(tree, "docs/architecture.md")).read()
    wrong += [f"docs/architecture.md: its index has no {page}" for page in pages
              if re.match(r"docs/(?!architecture|index)[^/]*$", page)
              and f"({os.path.basename(page)})" not in index]
    print("\n".join(wrong))
    return 1 if wrong else 0


sys.exit(main(sys.argv[1:]))
