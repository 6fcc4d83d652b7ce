# SPDX-License-Identifier: MIT
"""changes: lists the files that a failed test uses and that have changed since the test last
passed. They are usually the best hint at the cause."""
import functools
import re

from icesoc.regress.tests import Graph
from icesoc.util.process import collect

SHOWN = 6  # files


class Changes:
    """The state of the tree, including uncommitted changes, stored as a tree object of git, and
    comparisons with earlier states. The object is stored in <out>/tree; the repository is not
    changed."""

    def __init__(self, source, build, out):
        self.source, self.build, self.environment, self.tree = source, build, {}, ""
        folder = out.resolve() / "tree"
        status, objects = self.git("rev-parse", "--path-format=absolute", "--git-path", "objects")
        if status == 0:
            (folder / "objects").mkdir(parents=True, exist_ok=True)
            self.environment = {"GIT_INDEX_FILE": str(folder / "index"),
                                "GIT_OBJECT_DIRECTORY": str(folder / "objects"),
                                "GIT_ALTERNATE_OBJECT_DIRECTORIES": objects.strip()}
            self.tree = self._write_tree()

    def git(self, *words):
        return collect(["git", "-C", self.source, "-c", "core.quotePath=false", *words],
                   self.environment)

    def _write_tree(self):
        added, (status, tree) = self.git("add", "--all")[0], self.git("write-tree")
        return "" if added or status else tree.strip()

    def meanwhile(self):
        """Returns the files that have changed since the tree was recorded, that is, while the tests
        ran."""
        now = self.tree and self._write_tree()
        return self.git("diff", "--name-only", "--no-renames", self.tree, now)[1].splitlines() \
            if now else []

    @functools.cache
    def differing(self, since):
        """Returns {path: (first different line, number of different lines)} for the changes since a
        tree or a commit; None if git no longer has this tree or commit. Uncommitted files are
        listed first, and sources before other files."""
        status, text = self.git("diff", "--unified=0", "--no-color", "--no-ext-diff",
                                "--no-renames", "--src-prefix=a/", "--dst-prefix=b/", since,
                                self.tree)
        if status:
            return None
        files = {}
        for line in text.splitlines():
            if begin := re.fullmatch("diff --git a/(.*) b/.*", line):
                path = begin[1]
                files[path] = (0, 0)
            elif hunk := re.match(r"@@ -\d+(?:,(\d+))? [+](\d+)(?:,(\d+))? @@", line):
                first, lines = files[path]
                files[path] = (first or max(1, int(hunk[2])),
                               lines + max(int(hunk[1] or 1), int(hunk[3] or 1)))
        mine = self.git("diff", "--name-only", "--no-renames", "HEAD", self.tree)[1].splitlines()
        return dict(sorted(files.items(), key=lambda file: (
            file[0] not in mine, file[0].startswith(("tests/", "docs/")))))

    @functools.cached_property
    def graph(self):
        return Graph(self.source, self.build)

    def forget_graph(self):
        """Discards the cached file graph of ninja; called after a build, which changes this
        graph."""
        self.__dict__.pop("graph", None)

    def of_test(self, test, since):
        """Returns the changes since a tree or a commit, limited to the files that a test uses."""
        folders = test.reads()
        inputs = set()
        if test.unbuilt or test.is_program(self.build.resolve()):
            inputs, folders = self.graph.inputs(test.program), (f"tests/{test.place}",)
        elif files := test.compiles():
            inputs, folders = set().union(*map(self.graph.inputs, files)), ()
        return {path: lines for path, lines in (self.differing(since) or {}).items()
                if path in inputs or path.startswith(tuple(f + "/" for f in folders))}

    def touched(self, test, last_pass):
        """Returns whether files that a test uses have changed since the test last passed. If it has
        never passed here, compares with the last commit. Returns True if the changes are
        unknown."""
        since = last_pass[1].get("tree") if last_pass else "HEAD"
        return not self.tree or not since or self.differing(since) is None or \
            bool(self.of_test(test, since))

    def since(self, last_pass, test, seed):
        """Returns a text such as "changed since it passed at 632b860abc: ip/fir/fir.v:12 (2 lines),
        ...", or a text that reports no changes. Returns "" if the changes are unknown."""
        if not self.tree:
            return ""
        end, noted = last_pass or (None, dict[str, str]())
        commit = noted.get("commit", "HEAD").split("-dirty")[0]
        since = next((each for each in (noted.get("tree"), commit)
                      if each and self.differing(each) is not None), None)
        if not since or not (end or self.differing(since)):
            return ""
        # The list of files that a script uses is incomplete. If none of the listed files has
        # changed, all changes are therefore shown.
        files = self.of_test(test, since) or self.differing(since)
        text = "the last commit (no recorded run has passed)" if not end else \
            f"it passed at {commit}" + (
                f" with SEED={end[3]}" if end[3] != seed else "")
        if not files:
            return f"nothing has changed since {text}"
        named = [path + (f":{first} ({lines} line{'s' * (lines != 1)})" if first else "")
                for path, (first, lines) in list(files.items())[:SHOWN]]
        more = f" and {len(files) - SHOWN} more" if len(files) > SHOWN else ""
        return f"changed since {text}: {', '.join(named)}{more}"
