"""Checks the links of the built manual: launch_scripts/manual_links.py BOOK

A link to a file of the repository that is not a page of the manual leads out of the book; the file is copied to
BOOK/source and the link goes there, so that the book can be put anywhere. Ends with 1 where a link leads nowhere.
"""

import re
import shutil
import sys
from html import unescape
from pathlib import Path
from urllib.parse import unquote

ROOT = Path(__file__).resolve().parents[1]
LINK = re.compile(r'(href|src)="([^"]*)"')
ANCHOR = re.compile(r'\sid="([^"]*)"')


def repository_file(book, page, path):
    """The file of the repository that a page of the book means by a path out of it; None if there is none."""
    # mdBook makes .html of links to .md, also of those that are no page.
    for name in (path, re.sub(r"\.html$", ".md", path)):
        found = (ROOT / "docs" / page.relative_to(book).parent / name).resolve()
        if found.is_relative_to(ROOT) and found.exists():
            return found
    return None


def main():
    book = Path(sys.argv[1]).resolve()
    pages = sorted(book.rglob("*.html"))
    anchors = {page: set(ANCHOR.findall(page.read_text())) for page in pages}
    broken, copied = [], set()
    for page in pages:
        # The page for printing holds all others, with links that lead within it.
        if page.name in ("print.html", "404.html", "toc.html"):
            continue
        text = page.read_text()

        def checked(match):
            link = unescape(match[2])
            if re.match(r"[a-z]+:", link) or link.startswith("//"):
                return match[0]
            path, _, anchor = link.partition("#")
            target = (page.parent / unquote(path)).resolve() if path else page
            if target.is_dir():
                target /= "index.html"
            if target.exists() and target.is_relative_to(book):
                if anchor and target in anchors and anchor not in anchors[target]:
                    broken.append(f"{page.relative_to(book)}: {link}")
                return match[0]
            file = repository_file(book, page, path)
            if file is None:
                broken.append(f"{page.relative_to(book)}: {link}")
                return match[0]
            if file.is_dir():
                return f'{match[1]}="#"'
            # Browsers show text of these, and save what they do not know.
            copy = book / "source" / (str(file.relative_to(ROOT)) + ".txt")
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, copy)
            copied.add(copy)
            up = "../" * (len(page.relative_to(book).parts) - 1)
            return f'{match[1]}="{up}source/{file.relative_to(ROOT)}.txt"'

        page.write_text(LINK.sub(checked, text))
    print(f"{len(pages)} pages, {len(copied)} files of the repository beside them")
    if broken:
        sys.exit("links to nowhere:\n  " + "\n  ".join(sorted(set(broken))))


if __name__ == "__main__":
    main()
