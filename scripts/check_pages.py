#!/usr/bin/env python3
"""Checks that the pages agree with what is beside them.

The code that a page of docs/ shows is the code of the file that it names, in a comment on the line
before a block: <!-- path/from/the/root -->. With --write the blocks are replaced instead. What
pages link to exists, headings included, and every plot of docs/models is shown by some page.
Prints each difference; exits 1 if there is any.
"""
import pathlib
import re
import sys

BLOCK = re.compile(r"(?<=<!-- )(?P<path>\S+)(?P<between> -->\n```\w*\n)(?P<code>.*?)(?=```\n)",
                   re.DOTALL)


LINK = re.compile(r"\]\((?!https?:)(?P<path>[^)#\s]*)(?:#(?P<heading>[^)\s]*))?\)")
CODE = re.compile(r"^```.*?^```|`[^`\n]*`", re.DOTALL | re.MULTILINE)


def headings_of(page: pathlib.Path) -> set:
    """As they are linked to: lower case, hyphens for spaces, punctuation left out."""
    lines = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", line.lower()).replace(" ", "-") for line in lines}


def broken_links(root: pathlib.Path) -> list:
    broken = []
    linked = set()
    for page in [*sorted(root.glob("*.md")), *sorted((root / "docs").rglob("*.md"))]:
        for link in LINK.finditer(CODE.sub("", page.read_text(encoding="utf-8"))):
            target = (page.parent / link["path"]).resolve() if link["path"] else page
            linked.add(target)
            if not target.exists():
                broken.append(f"{page.relative_to(root)}: there is no {link['path']}")
            elif link["heading"] and link["heading"] not in headings_of(target):
                broken.append(f"{page.relative_to(root)}: {link['path']} has no heading "
                              f"#{link['heading']}")
    return broken + [f"{plot.relative_to(root)}: no page shows it"
                     for plot in sorted((root / "docs/models/plots").glob("*.svg"))
                     if plot.resolve() not in linked]


def main(root: pathlib.Path, write: bool) -> int:
    differences = 0
    blocks = 0
    for page in sorted((root / "docs").rglob("*.md")):
        text = page.read_text(encoding="utf-8")

        def as_in_file(block: re.Match) -> str:
            nonlocal differences, blocks
            code = (root / block["path"]).read_text(encoding="utf-8")
            blocks += 1
            if code != block["code"] and not write:
                print(f"{page.relative_to(root)}: the block of {block['path']} differs from the file; "
                      f"scripts/check_pages.py {root} --write mends it")
                differences += 1
            return block["path"] + block["between"] + code

        corrected = BLOCK.sub(as_in_file, text)
        if write and corrected != text:
            page.write_text(corrected, encoding="utf-8")
    if blocks == 0:
        print("no page shows a file: the pattern is wrong, or the pages are elsewhere")
        return 1
    for problem in broken_links(root.resolve()):
        print(problem)
        differences += 1
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]), "--write" in sys.argv[2:]))
