#!/usr/bin/env python3
"""Checks that the code that a page of docs/ shows is the code of the file that it names.

A page names a file in a comment on the line before a block: <!-- path/from/the/root -->. With
--write the blocks are replaced instead. Prints each difference; exits 1 if there is any.
"""
import pathlib
import re
import sys

BLOCK = re.compile(r"(?<=<!-- )(?P<path>\S+)(?P<between> -->\n```\w*\n)(?P<code>.*?)(?=```\n)",
                   re.DOTALL)


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
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]), "--write" in sys.argv[2:]))
