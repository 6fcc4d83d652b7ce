# SPDX-License-Identifier: MIT
"""page: builds the pages of regression and utilisation from their parts."""
import json

from icesoc import TREE
from icesoc.util.errors import Stop


def page_parts(libraries):
    """Returns (style, script) that all pages share: libraries, colours, tables, charts."""
    here = TREE / "tools/icesoc/web"

    def joined(ending):
        files = [libraries / f"libraries{ending}",
                 here / f"common{ending}", here / f"tables{ending}"]
        return "".join(file.read_text() for file in files if file.exists())
    return joined(".css"), joined(".js")


def filled(page, places):
    """Returns the page with each placeholder replaced by its text."""
    for place, text in places.items():
        if place not in page:
            raise Stop(f"the page has no {place}")
        page = page.replace(place, text, 1)
    return page


def script_safe(data):
    """Returns JSON for a page's script, escaped so that a "</" in it does not end the script."""
    return json.dumps(data, separators=(",", ":"), sort_keys=True).replace("</", "<\\/")
