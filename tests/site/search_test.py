#!/usr/bin/env python3
"""search_test.py SITE: plain questions, typed into the search of the built site, find the right page first.

The index is the site's own; it is searched as the theme's worker does (Material for MkDocs 8), by the lunr of mkdocs'
Python. Prints the first pages of each question whose right page is not the first.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys

try:
    from lunr.builder import Builder
    from lunr.stop_word_filter import WORDS as STOP_WORDS, stop_word_filter
    from lunr.trimmer import trimmer
except ImportError:  # mkdocs' own Python has it
    mkdocs = shutil.which("mkdocs")
    python = pathlib.Path(mkdocs).read_text(encoding="utf-8").split("\n")[0][2:].split() if mkdocs else []
    if not python or pathlib.Path(python[0]).resolve() == pathlib.Path(sys.executable).resolve():
        sys.exit("search_test.py: there is no lunr; install it: scripts/install-dependencies tests")
    sys.exit(subprocess.run([*python, *sys.argv]).returncode)

QUESTIONS = {
    "how do I use my own pictures": "how-to/own-pictures",
    "number of trials": "how-to/number-of-trials",
    "change the instructions": "how-to/instructions",
    "two methods in one study": "how-to/two-methods",
    "exclude a participant": "how-to/exclude-a-participant",
    "export to csv": "how-to/csv",
    "confusion matrix in R": "how-to/confusion-matrix",
    "how many participants do I need": "how-to/how-many-participants",
    "set up a Touch": "how-to/touch",
    "two monitors": "how-to/two-monitors",
    "run in German": "how-to/language",
    "resume after a crash": "how-to/after-a-crash",
    "blind the experimenter": "how-to/blind-the-experimenter",
    "share data": "how-to/share-data",
    "preregister": "preregistration",
    "how to cite": "cite",
    "calibrate the screen": "how-to/calibrate-the-screen",
    "true size pictures": "how-to/calibrate-the-screen",
    "make my own texture": "how-to/own-texture",
    "compare with the paper": "how-to/compare-with-the-paper",
    "add my own device": "how-to/own-device",
    "detection threshold": "threshold-tutorial",
    "matplotlib": "how-to/confusion-matrix",
    "Falcon too small": "how-to/falcon-too-small",
    "lost key": "when-something-goes-wrong",
}
NOT_SEARCHED = ("decisions/", "benchmarks/", "changelog")


class Search:
    def __init__(self, site):
        text = (site / "search" / "index.js").read_text(encoding="utf-8")
        index = json.loads(text.removeprefix("__search.loaded(").rstrip().removesuffix(");"))
        separator = re.compile(index["config"]["separator"])
        self.locations = [entry["location"] for entry in index["docs"]]
        builder = Builder()
        builder.pipeline.add(trimmer, stop_word_filter)
        builder.ref("location")
        for field, boost in (("title", 1000), ("text", 1)):
            builder.field(field, boost, lambda entry, field=field: [word for word in separator.split(entry[field]) if word])
        for entry in index["docs"]:
            builder.add(entry)
        self.index = builder.build()
        first_sections = set()  # of a page, which show as the page itself
        pages = set()
        for location in self.locations:
            page, _, anchor = location.partition("#")
            if anchor and page not in pages:
                pages.add(page)
                first_sections.add(location)
        self.shown = set(self.locations) - first_sections

    def pages(self, question):
        words = {word.lower() for word in question.split()} - set(STOP_WORDS)
        ranked = []
        for found in self.index.search(f"{question}*"):
            if found["ref"] in self.shown:
                terms = found["match_data"].metadata
                every = all(any(term.startswith(word) for term in terms) for word in words)
                ranked.append((found["score"] * (1 + ("#" not in found["ref"]) + every), found["ref"]))
        ranked.sort(key=lambda entry: -entry[0])
        return list(dict.fromkeys(location.partition("#")[0].removesuffix(".html") for _, location in ranked))


def main():
    search = Search(pathlib.Path(sys.argv[1]))
    faults = [f"{location} is in the search" for location in search.locations if location.startswith(NOT_SEARCHED)]
    for question, page in QUESTIONS.items():
        pages = search.pages(question)
        if pages[:1] != [page]:
            rank = pages.index(page) + 1 if page in pages else "none"
            faults.append(f"'{question}': rank {rank} of {page}; first are {', '.join(pages[:3])}")
    print("\n".join(faults) or f"{len(QUESTIONS)} questions find the right page first")
    sys.exit(bool(faults))


main()
