#!/usr/bin/env python3
"""Doxygen's folder of HTML pages: each link leads to a file and an anchor of the folder. On pages from
documents, no mark of Markdown is left in the text: Doxygen reads some of it otherwise than GitHub.

usage: check_links.py FOLDER. Links to other sites are not followed. Exit code 1 names what is broken."""
import html.parser
import pathlib
import re
import sys
import urllib.parse


CODE = ("pre", "code", "script", "style")
MARK = re.compile(r".{0,30}(`|\*\*|</?t[a-z]+[ >]|(?<!\w)\*\w).{0,30}")


class Page(html.parser.HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.anchors, self.links, self.text, self.inCode = set(), [], "", 0
        self.feed(path.read_text(encoding="utf-8", errors="replace"))

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.anchors.update(values[key] for key in ("id", "name") if values.get(key))
        self.links += [values[key] for key in ("href", "src") if values.get(key)]
        self.inCode += tag in CODE or (tag == "div" and self.inCode > 0) or "fragment" in values.get("class", "")

    def handle_endtag(self, tag):
        self.inCode -= self.inCode > 0 and (tag in CODE or tag == "div")

    def handle_data(self, data):
        self.text += " " if self.inCode else data


def main(folder):
    pages = {path.resolve(): Page(path) for path in folder.rglob("*.html")}
    broken = set()
    for path, page in pages.items():
        if path.name.startswith("md_") or path.name == "index.html":
            broken.update(f"{path.name}: left of Markdown: {mark.group()}" for mark in MARK.finditer(page.text))
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            # Doxygen links to a section that it does not always write.
            if parts.scheme or parts.netloc or link in ("#", "#nested-classes"):
                continue
            target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            if not target.exists():
                broken.add(f"{path.name}: {link} is not there")
            elif parts.fragment and target in pages and parts.fragment not in pages[target].anchors:
                broken.add(f"{path.name}: {link}: no such anchor")
    print("\n".join(sorted(broken)) or f"{len(pages)} pages, no broken link")
    return 1 if broken or len(pages) < 2 else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
