#!/usr/bin/env python3
"""pinned_words.py ROOT: counts the product's messages that a test repeats, and fails above a limit.

A message is a string literal of four or more words outside tests that is not SQL. It is pinned if four consecutive
words of it are also in a literal of a test. Names of test cases and headings of documentation pages do not count.

pinned_words.py ROOT --list PREFIX: prints each such literal of tests below PREFIX, and the messages' places.
"""
import bisect
import collections
import pathlib
import re
import sys

from house import rooms_of

LIMIT = 0.04
WORDS_IN_ROW = 4
TESTS = "tests/"
NOT_PRODUCT = (TESTS, "bench/", "fuzz/")
STRINGS = r'"(?:[^"\\\n]|\\.)*"(?:\s*"(?:[^"\\\n]|\\.)*")*'  # including adjacent ones
COMMENT_OR_LITERAL = re.compile(r"//[^\n]*|'(?:\\.|[^'\\\n])'|" r'(R"(\w*)\(.*?\)\2"|' + STRINGS + ")", re.S)
PYTHON_LITERAL = re.compile(r'#[^\n"]*\n|(""".*?"""|' + STRINGS + ")", re.S)
SQL = re.compile(r"\W*(?:SELECT|INSERT|UPDATE|DELETE|CREATE|DROP|ALTER|PRAGMA|WITH|FROM|WHERE) ")
TEST_NAME = re.compile(r"\b(?:TEST_CASE|TEST_CASE_METHOD|SECTION|INFO|FAIL|SKIP)\([^\"();]*$")


def words_of(text):
    """The text's words; a path, an option or a dotted name is one word."""
    return [word.rstrip(".:/") for word in re.findall(r"[A-Za-z][\w'./:-]*", re.sub(r"\\[ntr]", " ", text))]


def literals(text, is_python=False):
    """The string literals with their lines; adjacent ones are joined."""
    ends = [found.start() for found in re.finditer("\n", text)]
    for found in (PYTHON_LITERAL if is_python else COMMENT_OR_LITERAL).finditer(text):
        if found[1] and not TEST_NAME.search(text[max(0, found.start() - 200):found.start()]):
            joined = found[1] if found[1].startswith("R") else re.sub(r'"\s*"', "", found[1])
            yield bisect.bisect_left(ends, found.start()) + 1, joined


def rows(words):
    return {tuple(words[at:at + WORDS_IN_ROW]) for at in range(len(words) - WORDS_IN_ROW + 1)}


class Messages:
    """The product's messages, indexed by rows of four words."""

    def __init__(self, sources):
        self.places, self.with_row = [], collections.defaultdict(set)
        for path, text in sources.items():
            for line, literal in literals(text):
                if len(words := words_of(literal)) >= WORDS_IN_ROW and not SQL.match(literal):
                    for row in rows(words):
                        self.with_row[row].add(len(self.places))
                    self.places.append(f"{path}:{line}")


def pinning_literals(messages, tests, titles):
    """Each literal of a test that repeats a message: path, line, literal, and the messages' numbers."""
    for path, text in tests.items():
        for line, literal in literals(text, path.endswith(".py")):
            words = words_of(literal)
            if tuple(words) not in titles and not SQL.match(literal):
                if repeated := set().union(*(messages.with_row.get(row, ()) for row in rows(words))):
                    yield path, line, literal, repeated


def read(root):
    tops = {room.split("/")[0] for room in rooms_of((root / "docs" / "architecture.md").read_text())}
    files = {path.relative_to(root).as_posix(): path.read_text(errors="replace")
             for top in sorted(tops | {"tests", "docs"}) for path in sorted((root / top).rglob("*"))
             if path.suffix in (".cpp", ".hpp", ".md") or (top == "tests" and path.suffix == ".py")}
    product = {path: text for path, text in files.items()
               if path.endswith((".cpp", ".hpp")) and not path.startswith(NOT_PRODUCT)}
    tests = {path: text for path, text in files.items() if path.startswith(TESTS) and not path.endswith(".md")}
    titles = {tuple(words_of(title)) for path, text in files.items() if path.endswith(".md")
              for title in re.findall(r"^#+ (.*)", text, re.M)}
    return Messages(product), tests, titles


def main(root, list_below=None):
    messages, tests, titles = read(pathlib.Path(root))
    pinned, by_file = set(), collections.Counter()
    for path, line, literal, repeated in pinning_literals(messages, tests, titles):
        pinned |= repeated
        by_file[path] += 1
        if list_below is not None and path.startswith(list_below):
            print(f"{path}:{line}: {literal} <- {' '.join(sorted(messages.places[at] for at in repeated)[:3])}")
    share = len(pinned) / len(messages.places)
    print(f"{len(pinned)} of {len(messages.places)} messages ({share:.1%}) are repeated, "
          f"in {sum(by_file.values())} literals of tests; at most {LIMIT:.0%} may be")
    for path, count in by_file.most_common(20) if share > LIMIT else []:
        print(f"  {count} in {path}")
    return share > LIMIT


if __name__ == "__main__":
    if len(sys.argv) not in (2, 4) or (len(sys.argv) == 4 and sys.argv[2] != "--list"):
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], sys.argv[3] if len(sys.argv) == 4 else None))
