# SPDX-License-Identifier: MIT
"""build: stages the pages of docs/ with the generated reference, and runs Doxygen and Sphinx."""
import os
import re
import shutil
import subprocess
from pathlib import Path

from icesoc.site import reference
from icesoc.util.errors import Stop

# Pages outside docs/ that are part of the site: path in the tree -> path in the site.
ADOPTED = {"sw/ground/README.md": "ground-plugin", "CHANGELOG.md": "changelog",
           "CONTRIBUTING.md": "contributing"}
DOXYFILE = """PROJECT_NAME = IceSoC
INPUT = {inputs}
FILE_PATTERNS = *.h
OUTPUT_DIRECTORY = {output}
EXTRACT_ALL = YES
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
OPTIMIZE_OUTPUT_FOR_C = YES
TYPEDEF_HIDES_STRUCT = YES
JAVADOC_AUTOBRIEF = YES
MARKDOWN_SUPPORT = NO
AUTOLINK_SUPPORT = NO
MACRO_EXPANSION = NO
ENABLE_PREPROCESSING = YES
INPUT_FILTER = "/usr/bin/python3 {filter}"
QUIET = YES
WARN_IF_UNDOCUMENTED = NO
WARN_IF_DOC_ERROR = NO
"""


def adopted(tree):
    """Returns the pages outside docs/ that are part of the site: the pages in ADOPTED, and one page
    per core."""
    cores = {f"ip/{path.parent.name}/README.md": f"reference/cores/{path.parent.name}"
             for path in sorted(tree.glob("ip/*/README.md"))}
    return {source: target for source, target in {**ADOPTED, **cores}.items()
            if (tree / source).exists()}


def relink(text, source, target, moved):
    """Returns the text of a page with its links changed for its place in the site.

    `source` and `target` are the page's paths in the tree and in the site; `moved` maps paths of
    pages in the tree to paths in the site. Paths have no leading slash. A link to a file that is
    not a page is replaced by the name of the file, formatted as code.
    """
    def replaced(match):
        label, link = match[1], match[2]
        if re.match(r"[a-z]+:|#", link):
            return match[0]
        path, _, anchor = link.partition("#")
        there = Path(os.path.normpath(Path(source).parent / path))
        page = moved.get(str(there))
        if page:
            up = "../" * (len(Path(target).parts) - 1)
            return f"[{label}]({up}{page}.md{'#' + anchor if anchor else ''})"
        if there.parts[:1] == ("docs",) or match[0].startswith("!"):
            return match[0]
        return label if "`" in label else f"{label} (`{there}`)"

    blocks = re.split(r"(^```.*?^```)", text, flags=re.S | re.M)
    return "".join(block if block.startswith("```") else
                   re.sub(r"!?\[([^]]*)\]\(([^)\s]+)\)", replaced, block) for block in blocks)


def stage(tree, pages, helps):
    """Copies the pages of docs/ and the pages outside docs/ into `pages`, and writes the generated
    pages there."""
    shutil.rmtree(pages, ignore_errors=True)
    shutil.copytree(tree / "docs", pages, ignore=shutil.ignore_patterns("CMakeLists.txt", "*.sh"))
    moved = adopted(tree)
    moved.update({str(path.relative_to(tree)): str(path.relative_to(tree / "docs").with_suffix(""))
                  for path in (tree / "docs").rglob("*.md")})
    for source, target in moved.items():
        text = relink((tree / source).read_text(), source, target, moved)
        reference.write(pages / f"{target}.md", text)
    reference.write_hdl(tree, pages)
    reference.write_registers(tree, pages)
    reference.write_c(tree, pages)
    reference.write_cores(tree, pages)
    reference.write_commands(pages, helps)


def run(words, what, log):
    """Runs a program and stores its output in `log`; raises Stop if it fails."""
    with open(log, "w") as file:
        status = subprocess.run(words, stdout=file, stderr=subprocess.STDOUT,
                                check=False).returncode
    if status:
        raise Stop(f"docs: {what} failed; the whole output is in {log}:\n" +
                   "\n".join(Path(log).read_text().splitlines()[-20:]))


def make_self_contained(html):
    """Makes the site independent of a web server.

    In Debian's package of the theme, the style sheet imports /javascript/normalize.css, and the
    script is a module that imports another module. A browser loads neither from files, so the menu
    of the current page and the choice between light and dark would not work. Raises Stop if a
    page still uses a file with an absolute path.
    """
    style = html / "_static/styles/furo.css"
    text = style.read_text()
    shared = "/javascript/normalize.css/normalize.css"
    if shared in text:
        shutil.copy("/usr/share" + shared, style.with_name("normalize.css"))
        style.write_text(text.replace(f"@import url({shared})", "@import url(normalize.css)"))
    script = html / "_static/scripts/furo.js"
    first, _, rest = script.read_text().partition("\n")
    if first.startswith("import Gumshoe from"):
        script.write_text(script.with_name("gumshoe-patched.js").read_text() + rest)
    for path in sorted(html.rglob("*")):
        if path.suffix in (".html", ".css"):
            found = re.search(r"(?:src|href)=\"(/[^\"]*)|url\([\"']?(/[^)]*)", path.read_text())
            if found:
                raise Stop(f"docs: {path}: expected only relative paths, got "
                           f"{found[1] or found[2]}: the site cannot be read from files")


def build(tree, out, helps):
    """Builds the site into `out`/html. Broken links and orphan pages are errors."""
    out.mkdir(parents=True, exist_ok=True)
    stage(tree, out / "pages", helps)
    folders = sorted({path.parent for path in (tree / "sw").rglob("*.h")})
    (out / "Doxyfile").write_text(DOXYFILE.format(
        inputs=" ".join(f'"{folder}"' for folder in folders), output=f'"{out / "doxygen"}"',
        filter=Path(__file__).with_name("doxygen_filter.py")))
    run(["doxygen", out / "Doxyfile"], "doxygen", out / "doxygen.log")
    # Sphinx's cache contains the paths of this machine, so it is stored outside the site.
    run(["sphinx-build", "-q", "-W", "--keep-going", "-b", "html", "-d", out / "doctrees", "-D",
         f"breathe_projects.icesoc={out / 'doxygen/xml'}", out / "pages", out / "html"],
        "Sphinx", out / "sphinx.log")
    make_self_contained(out / "html")
    return out / "html/index.html"
