"""Reads every document (*.md) below a folder and fails, naming file and line: lines of more than 110 columns, links
to files or headings that are not there, pictures that nothing shows, documents that README.md does not lead to.

    python3 check_documents.py ROOT"""
import re
import sys
from pathlib import Path

COLUMNS = 110
NOT_OURS = re.compile(r"^(build[^/]*|results|\.[^/]*|tests/documents/offending)(/|$)")
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")


def documents(root):
    for path in sorted(root.rglob("*.md")):
        if not NOT_OURS.match(path.relative_to(root).as_posix()):
            yield path


def prose(text):
    """(number, line) outside of fenced code; code between backticks is blanked, because it holds no links."""
    fenced = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        elif not fenced:
            yield number, re.sub(r"`[^`]*`", lambda m: "`" * len(m[0]), line)


def anchors(text):
    """Of the headings, as GitHub makes them."""
    found, fenced = set(), False
    for line in text.splitlines():
        if line.lstrip().startswith("```"):
            fenced = not fenced
        heading = re.match(r"#+\s+(.*)$", line)
        if fenced or not heading:
            continue
        plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading[1]).strip().lower()
        slug, n = re.sub(r"[^\w\- ]", "", plain).replace(" ", "-"), 0
        while (anchor := slug if n == 0 else f"{slug}-{n}") in found:
            n += 1
        found.add(anchor)
    return found


def main(root):
    faults, linked, pictures = [], {}, set()
    texts = {path: path.read_text(encoding="utf-8") for path in documents(root)}
    for path, text in texts.items():
        shown, linked[path] = path.relative_to(root), set()
        for number, line in enumerate(text.splitlines(), 1):
            if len(line) > COLUMNS:
                faults.append(f"{shown}:{number}: {len(line)} columns, at most {COLUMNS} are allowed: break the line")
        for number, line in prose(text):
            for link in LINK.findall(line):
                if re.match(r"[a-z]+:", link):
                    continue  # of another place: not looked at, because tests fetch nothing
                name, _, anchor = link.partition("#")
                target = (path.parent / name).resolve() if name else path
                if not target.exists():
                    faults.append(f"{shown}:{number}: '{link}': there is no such file")
                elif anchor and target in texts and anchor not in anchors(texts[target]):
                    faults.append(f"{shown}:{number}: '{link}': {name or shown} has no heading with this anchor")
                linked[path].add(target)
                pictures.add(target)
    for picture in sorted((root / "docs/figures").glob("*")):
        if picture.resolve() not in pictures:
            faults.append(f"{picture.relative_to(root)}: no document shows this picture")
    reached, new = set(), {root / "README.md"}
    while new:
        reached |= new
        new = {t for path in new for t in linked.get(path, ()) if t in texts} - reached
    for path in texts:
        if path not in reached and path.is_relative_to(root / "docs"):
            faults.append(f"{path.relative_to(root)}: README.md does not lead to this document: link it")
    for fault in faults:
        print(fault, file=sys.stderr)
    if not texts:
        print(f"{root}: holds no documents", file=sys.stderr)
    print(f"{len(texts)} documents read")
    return 1 if faults or not texts else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve()))
