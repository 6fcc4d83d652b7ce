#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""tutorial_test: tests the program that executes the tutorial: it must accept a correct page, and
reject wrong commands, output and exit statuses.

Usage: tutorial_test.py CASE WORK-FOLDER
"""
import subprocess
import sys
from pathlib import Path

from icesoc.site import tutorial
from icesoc.util.errors import Stop
from script import TREE, Script, fresh, main, write

WORK = Path(sys.argv[2])
PAGE = """# Page

```console
$ cd icesoc
```

`greeting`:

```
hello, radio
```

```console
$ cat greeting
hello, ...
$ printf 'a\\nb\\nc\\n'
a
...
c
```

<!-- long -->
```console
$ echo slow >>log
```

<!-- exit status 3 -->
```console
$ exit 3
```
"""


def execute(command):
    done = subprocess.run(["sh", "-c", command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, check=False)
    return done.returncode, done.stdout


class Cases(Script):
    def follow(self, text, brief=False):
        fresh(WORK)
        write(WORK / "page.md", text)
        tutorial.follow(WORK / "page.md", WORK, execute, "cd icesoc", brief)

    def test_right(self):
        """The steps of a page are executed in order."""
        self.follow(PAGE)
        self.assertEqual((WORK / "greeting").read_text(), "hello, radio\n")
        self.assertTrue((WORK / "log").exists())
        self.follow(PAGE, brief=True)
        self.assertFalse((WORK / "log").exists())

    def test_wrong(self):
        """A wrong command, a wrong, missing or additional line, or a wrong exit status is reported
        with its line in the page."""
        for old, new, message in (
                ("$ cat greeting", "$ cat greetings",
                 "page.md:14: cat greetings: .*status 0, got 1"),
                ("hello, ...", "hello, cable", "page.md:14: .*expected hello, cable"),
                ("hello, radio", "hello radio", "expected hello, [.]"),
                ("a\\n...\\nc", "a\\nc", "expected c"),
                ("a\\n...\\nc", "a\\nb", "expected no further line, got 'c'"),
                ("c\\n```", "c\\nd\\n```", "expected d"),
                ("$ exit 3", "$ exit 2", "expected exit status 3, got 2"),
                ("$ cd icesoc", "$ ls", "expected the command 'cd icesoc'")):
            old, new = old.replace("\\n", "\n"), new.replace("\\n", "\n")
            self.assertIn(old, PAGE)
            with self.assertRaisesRegex(Stop, message):
                self.follow(PAGE.replace(old, new))

    def test_page(self):
        """The tutorial writes files, and shows the output of each command that prints something."""
        steps = tutorial.steps((TREE / "docs/tutorial.md").read_text())
        self.assertGreater(len([step for step in steps if step.file]), 2)
        for step in steps:
            silent = step.command.startswith(("cd ", "git clone", "echo "))
            self.assertTrue(step.expected or silent, step.command)
            self.assertNotEqual(step.expected, ["..."], step.command)


main(Cases)
