#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""lists: tests the list of commands, the help and the manual page, and the output to files and
terminals."""
import ast, contextlib, io, json, re, shlex, shutil, subprocess, sys, tempfile, unittest
from pathlib import Path
from unittest import mock

from doors import TREE, ask, quickly
from icesoc.cli import command, flight
from icesoc.cli.commands import figures
from icesoc.cli.commands.tree import manual
from icesoc.regress import waves
from icesoc.util import spelling
from icesoc.util.errors import Stop
from icesoc.util.ninja import run_ninja
from icesoc.util.table import Table


def docstrings_of(tree):
    return {ast.get_docstring(node, False) or "" for node in ast.walk(tree)
            if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef))}


def strings_of(text):
    """Returns the strings of a Python program, without its comments."""
    tree = ast.parse(text)
    comments = docstrings_of(tree)
    return [node.value for node in ast.walk(tree) if isinstance(node, ast.Constant) and
            isinstance(node.value, str) and node.value not in comments]


def texts_of_tree():
    """Yields (path, text) of the tree's files that may name a command. CHANGELOG.md is left out,
    because it names the commands of earlier versions."""
    for file in subprocess.run(["git", "grep", "-IlE", r"make |\./icesoc", "--", ":!CHANGELOG.md"],
                               cwd=TREE, text=True, check=True, capture_output=True
                               ).stdout.splitlines():
        yield file, (TREE / file).read_text()


def comments_of(file, text):
    """Returns the comments of a file, without line breaks and comment marks. The result also
    contains other parts of the text, but not the strings of a Python program."""
    if file.endswith(".py"):
        text = "\n".join([*docstrings_of(ast.parse(text)), *re.findall(r"(?m)^ *#.*", text)])
    return re.sub(r"\n[ \t]*(?://+|#+|\*|--)?[ \t]*", " ", text)


def wrong_commands(text, is_page):
    """Yields each command in backquotes that does not exist, and each variable that a command does
    not have. `is_page`: code blocks of the text can contain several commands."""
    value = r"""[A-Z][A-Z0-9_]*=(?:'[^']*'|"[^"]*"|[^\s`'"]*)"""
    verbs = {each.make for each in command.COMMANDS.values() if each.make} | set(command.ALIASES)
    begin = r"(?<!board )\b" if is_page else "`"
    quoted = "\n\n".join(re.findall(r"```.*?```|``.*?``|`[^`]+`", text, re.S)) if is_page else text
    for before, verb, after in re.findall(
            rf"{begin}make ((?:{value} )*)([a-z][a-z-]*)((?:[ \n]+\[?{value})*)", quoted):
        if verb not in verbs:
            yield f"make {verb}"
            continue
        known = {o.variable for each in command.COMMANDS.values() if each.make == verb
                 for o in each.options}
        for name in re.findall(r"(?<![\w$])([A-Z][A-Z0-9_]*)=", before + after):
            if name not in known:
                yield f"make {verb} has no variable {name}"
    for words in re.findall(("" if is_page else "`") + r"\./icesoc ([a-z][^`\n#|]*)", quoted):
        try:
            command.find(words.split())
        except Stop:
            yield f"./icesoc {words}"


class Lists(unittest.TestCase):
    maxDiff = None

    def test_every_command_has_a_short_form_and_the_list_is_short(self):
        self.assertEqual([name for name, each in command.COMMANDS.items() if not each.brief], [])
        self.assertLessEqual(len({name.split()[0] for name in command.COMMANDS}), 23)
        for name, each in command.COMMANDS.items():
            for words in [*each.brief, *each.examples]:
                found, rest = command.find(shlex.split(words.partition(" && ")[0]))
                found.parser().parse_args(rest)
                self.assertTrue(found)
            self.assertTrue(each.help and name in command.find(name.split())[0].name)

    def test_help_has_a_line_a_paragraph_options_and_three_examples(self):
        for name, each in command.COMMANDS.items():
            self.assertEqual(command.short(each.help, 67), each.help, f"{name}: too long")
            self.assertRegex(each.more, r"(?s)\w.*\w", f"{name}: no paragraph")
            listed = sum(option.listed for option in each.options)
            self.assertGreaterEqual(len(each.examples), min(3, 1 + listed), f"{name}: examples")
            self.assertEqual([line for line in each.examples if name.split()[0] not in line], [])
            for line in each.parser().format_help().partition("\nexamples:\n")[2].splitlines():
                self.assertTrue(line.startswith("  ./icesoc "), line)
                command.find(shlex.split(line)[1:])
            for option in each.options:
                if option.listed:
                    text = option.explain()
                    self.assertRegex(text, r"^\W?\w", f"{name} --{option.name}")
                    self.assertNotRegex(
                        text, r"^(of|that|in|from|by|which|whose|what|where|as) ",
                        f"{name} --{option.name}: a noun or a verb comes first")

    def test_messages_and_pages_name_one_form_of_each_command(self):
        """Messages and pages name `make` for the commands with which a user may begin, and
        ./icesoc for all others."""
        goals = {each.make for each in command.COMMANDS.values() if each.make}
        goals |= set(command.ALIASES)
        other = "|".join(sorted(goals - {"run", "test", "synth", "regress", "package"}))
        named = re.compile(rf"(?<!board )\bmake (?:{other})(?![\w-])")
        allowed = {"docs/recipes.md": "make new-ip"}  # the page explains both forms
        wrong = []
        for file in subprocess.run(["git", "ls-files", "sw", "slice", "testbench", "tools", "cmake",
                                    "docs", "README.md"], cwd=TREE, text=True, check=True,
                                   capture_output=True).stdout.split():
            if file.endswith((".png", ".pdf")):
                continue
            text = (TREE / file).read_text()
            texts = strings_of(text) if file.endswith(".py") else [
                line for line in text.split("\n") if not re.match(r"\s*(//|#|/?\*)", line)]
            found = {name for each in texts for name in named.findall(each)}
            wrong += [f"{file}: {name}" for name in found - {allowed.get(file)}]
        self.assertEqual(wrong, [])

    def test_pages_and_comments_name_commands_that_there_are(self):
        for file, text in texts_of_tree():
            is_page = file.endswith(".md")
            text = text if is_page else comments_of(file, text)
            self.assertEqual(list(wrong_commands(text, is_page)), [], file)

    def test_comments_name_one_form_of_each_command(self):
        """A comment names a command in the same form as messages and pages."""
        goals = {each.make for each in command.COMMANDS.values() if each.make}
        other = "|".join(sorted(goals - {"run", "test", "synth", "regress", "package"}))
        found = [f"{file}: {name}" for file, text in texts_of_tree()
                 # the requirements of tests/plan.toml are about variables of make
                 if not file.endswith((".md", "plan.toml"))
                 for name in re.findall(rf"(?<!board )\bmake (?:{other})(?![\w-])",
                                        comments_of(file, text))]
        self.assertEqual(sorted(set(found)), [])

    def test_a_stale_command_is_found(self):
        for text, wrong in (
                ("-- `make new-foreign\n--   BUS=axis` writes it", []),
                ("// `make new-core NAME=a`", ["make new-core"]),
                ("# `make run\n# COLOUR=1`", ["make run has no variable COLOUR"]),
                ("/* `./icesoc core\n * remake` */", ["./icesoc core remake"]),
                ("`./icesoc core foreign` and `./icesoc commands --brief`", [])):
            self.assertEqual(list(wrong_commands(comments_of("", text), False)), wrong, text)

    def test_the_schema_is_that_of_the_options_and_holds_a_flight(self):
        schema = (TREE / "tools/icesoc/cli/flight.schema.json").read_text()
        self.assertEqual(schema, flight.schema_text())
        good = {"version": flight.VERSION, **{o.field: rule["default"] for o in flight.FIELDS
                                 if (rule := flight.schema()["properties"][o.field])}}
        self.assertEqual(flight.wrong(good), "")
        for change in ({"loss": 2}, {"loss": "0"}, {"cpu": "z80"}, {"cores": "fir"}, {
                "version": 1}, {"more": 1}, {"open": 1}):
            self.assertTrue(flight.wrong({**good, **change}), change)
        del good["seed"]
        self.assertIn("missing key 'seed'", flight.wrong(good))

    def test_a_recording_that_is_cut_has_no_span(self):
        with tempfile.TemporaryDirectory() as work:
            for text, span in (('{"ns":0,"digest":1}\n{"ns":3000000000,"down":2}\n',
                                ["--from 0.000", "--to 3.000"]),
                               ('{"ns":0,"digest":1}\n{"ns":30', None)):
                Path(work, "flight.jsonl").write_text(text)
                self.assertEqual(flight.last_span(work), span)

    def test_the_regression_finds_the_end_of_a_flight_in_its_log(self):
        for is_make in (False, True):
            with mock.patch.object(spelling, "IS_MAKE", is_make):
                for out in ("fly", "my fly"):
                    end = spelling.command("run", spelling.option("replay", out),
                                           spelling.option("from", "1.5"),
                                           spelling.option("to", "2.0"))
                    found = waves.END_OF_FLIGHT.search(f"of its end: {end}\n")
                    self.assertEqual((found[1].strip("'"), found[2]), (out, "2.0"))

    def test_pictures_need_a_report_of_all_designs(self):
        with tempfile.TemporaryDirectory() as work:
            report = Path(work, "report.json")
            with self.assertRaisesRegex(Stop, "report.json not found; run ./icesoc synth, or add"):
                figures.whole_report(report)
            whole = {"entries": [], "states": {"fir": "measured now", "soc": "measured now"}}
            report.write_text(json.dumps(whole))
            self.assertEqual(figures.whole_report(report), whole)
            report.write_text(json.dumps({"entries": [], "states": {
                "fir": "measured now", **dict.fromkeys(("a", "b", "c", "soc"), "changed since")}}))
            with self.assertRaisesRegex(Stop, "those of a, b, c and 1 more are missing: run "):
                figures.whole_report(report)

    def test_a_long_subject_is_refused(self):
        with tempfile.TemporaryDirectory() as work:
            for length, status in ((72, 0), (73, 1)):
                Path(work, "message").write_text("# a comment\n" + "x" * length + "\n\nWhy.\n")
                self.assertEqual(ask(".ci/hooks/commit-msg", f"{work}/message")[0], status)

    def test_a_certificate_is_signed_by_the_authority_beside_it(self):
        with tempfile.TemporaryDirectory() as work:
            for name in ("pilot", "observer"):
                status, _ = quickly("./icesoc", "key", f"{work}/{name}.pem", "--certificate")
                self.assertEqual(status, 0)
            status, said = ask("openssl", "verify", "-CAfile", f"{work}/authority.pem",
                               f"{work}/pilot.pem", f"{work}/observer.pem")
            self.assertEqual((status, said.count("OK")), (0, 2), said)
            subject = ask("openssl", "x509", "-noout", "-subject", "-in", f"{work}/pilot.pem")[1]
            self.assertRegex(subject, "subject=CN ?= ?pilot")
            # The certificate must not be allowed to sign other certificates.
            self.assertIn("CA:FALSE", ask("openssl", "x509", "-noout", "-text", "-in",
                                          f"{work}/pilot.pem")[1])
            self.assertEqual(Path(work, "pilot.pem").stat().st_mode & 0o777, 0o600)
            self.assertIn("never overwritten", quickly("./icesoc", "key", f"{work}/pilot.pem",
                                                       "--certificate")[1])
            Path(work, "authority.key").unlink()
            self.assertIn("restore the missing file", quickly(
                "./icesoc", "key", f"{work}/new.pem", "--certificate")[1])

    def test_a_build_is_one_line_and_a_file(self):
        with tempfile.TemporaryDirectory() as work:
            tool, log = Path(work, "tool"), Path(work, "log")
            tool.write_text("#!/bin/sh\necho '[1/2] first'\necho 'odd: a warning'\n"
                            "echo '[2/2] second'\nexit 3\n")
            tool.chmod(0o755)
            code = ("from icesoc.util.ninja import *\n"
                    f"run_ninja(['{tool}'], '{log}', check=False)")
            words = [sys.executable, "-c", code]
            self.assertEqual(ask(*words)[1], "odd: a warning\n")
            shown = ask("script", "-qec", shlex.join(words), "/dev/null")[1]
            self.assertEqual(re.sub(r"\s*\x1b\[K", "|", shown),
                             "|[1/2] 0:00 left first|odd: a warning|[2/2] 0:00 left second|")
            self.assertIn("[2/2] second", log.read_text())
            self.assertRaisesRegex(Stop, f"the build failed .* {log}",
                                   run_ninja, [str(tool)], log)

    def test_a_table_tells_what_failed_and_what_lacks_a_network(self):
        with tempfile.TemporaryDirectory() as work, contextlib.redirect_stdout(
                io.StringIO()) as out:
            rows = Table(f"{work}/rows")
            rows.add("good", 0, 1.5, "a | b")
            rows.add("far", 77, 0)
            rows.end()
            self.assertRegex(out.getvalue(), "(?s)skipped: far.*1 commands, 2 s")
            rows.add("bad", 3, 0)
            self.assertRaisesRegex(Stop, "failed: bad ", rows.end)
            self.assertIn("| good | 0 | 1.5 | a / b |", Path(work, "rows.md").read_text())

    def test_help_fits_a_screen_and_lists_the_commands_of_a_group(self):
        for words in ("--help",), ("help",), ():
            status, text = quickly("./icesoc", *words)
            self.assertEqual(status, 0)
            self.assertLess(len(text.splitlines()), 40)
            self.assertLess(max(map(len, text.splitlines())), 81, text)
        for name in command.COMMANDS:
            self.assertIn(f"  {name.split()[0]} ", text)
        for group in command.GROUPS:
            for words in (group, "--help"), (group, "-h"), ("help", group):
                status, text = quickly("./icesoc", *words)
                self.assertEqual(status, 0)
                for name in command.COMMANDS:
                    first, _, second = name.partition(" ")
                    self.assertTrue(first != group or f"  {second} " in text, f"{words}: {second}")
        self.assertEqual(ask("./icesoc", "help", "core", "new"),
                         quickly("./icesoc", "core", "new", "--help"))

    def test_version_and_manual_are_there(self):
        self.assertRegex(ask("./icesoc", "--version")[1], r"^icesoc \d+\.\d+\.\d+\n")
        said = subprocess.run(["groff", "-man", "-ww", "-Tutf8", "-z"], input=manual(),
                              capture_output=True, text=True).stderr \
            if shutil.which("groff") else ""
        self.assertEqual(said, "")
        shown = quickly("./icesoc", "run", "--help")[1]
        for option in command.COMMANDS["run"].options:
            self.assertTrue(not option.listed or f"--{option.name}" in shown, option.name)


if __name__ == "__main__":
    unittest.main()
