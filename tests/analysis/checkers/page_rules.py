#!/usr/bin/python3
"""Prints the faults of a page that standard input holds, one a line: what is incomplete, needs another file, or cannot be
read by a screen reader.

Elements close in order; ids are unique, and every reference to one leads somewhere; no script, no handler, no address
outside the page; the language is named; there is one h1, and headings do not skip a level; tables have a caption and
headers with a scope, and as many cells in every row; figures have a caption, and their pictures a description; parts that
scroll can be reached by keyboard."""
import re, sys

VOID = {"meta", "br", "img", "hr", "link", "input", "col"}
ADDRESSES = {"http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"}
VALUE = r"""(?:\s*=\s*(?:"([^"]*)"|'([^']*)'))?"""
ATTRIBUTE = re.compile(r"""\s*([^\s=>/"']+)""" + VALUE)
TAG = re.compile(r"""<(/?)([^\s=>/]+)((?:\s+[^\s=>/"']+(?:\s*=\s*(?:"[^"]*"|'[^']*'))?)*)\s*(/?)>""")


class Page:
    def __init__(self):
        self.faults, self.open, self.ids, self.wanted, self.tables = [], [], set(), [], []
        self.figcaption, self.heading, self.h1 = False, 0, 0

    def attribute(self, name, value):
        if "://" in value and value not in ADDRESSES:
            self.faults.append(f"an address outside the page: {value}")
        if name in ("href", "xlink:href", "src"):
            if value.startswith("#"):
                self.wanted.append(value[1:])
            elif not value.startswith("data:"):
                self.faults.append(f"a reference to something outside the page: {value}")
        if name.startswith("on"):
            self.faults.append(f"a handler: {name}")
        if name == "id":
            if value in self.ids:
                self.faults.append(f"twice: id {value}")
            self.ids.add(value)
        if name in ("aria-labelledby", "aria-describedby"):
            self.wanted += value.split()

    def cell(self, name, attributes):
        if not self.tables:
            return self.faults.append("a cell without a table")
        table = self.tables[-1]
        table["cells"] += 1
        if name == "th":
            table["header"] = True
            if not attributes.get("scope"):
                self.faults.append("a header cell without a scope")

    def opening(self, name, attributes):
        for one, value in attributes.items():
            self.attribute(one, value)
        if name == "html" and not attributes.get("lang"):
            self.faults.append("no language")
        if name in ("script", "link", "iframe", "object"):
            self.faults.append(f"element {name}")
        if re.fullmatch("h[1-6]", name):
            level = int(name[1])
            self.h1 += level == 1
            if level > self.heading + 1:
                self.faults.append("a heading skips a level")
            self.heading = level
        if name == "table":
            self.tables.append({"caption": False, "header": False, "columns": 0, "cells": 0})
        if name == "caption" and self.tables:
            self.tables[-1]["caption"] = True
        if name in ("th", "td"):
            self.cell(name, attributes)
        if name in ("figure", "figcaption"):
            self.figcaption = name == "figcaption"
        role = attributes.get("role")
        if (name == "img" and not attributes.get("alt")) or (
                role == "img" and not (attributes.get("aria-label") or attributes.get("aria-labelledby"))):
            self.faults.append("a picture without words")
        if role == "region" and not attributes.get("tabindex"):
            self.faults.append("out of reach by keyboard")

    def closing(self, name):
        if self.open and self.open[-1] == name:
            self.open.pop()
        else:
            self.faults.append(f"</{name}> closes {self.open[-1] if self.open else 'nothing'}")
        table = self.tables[-1] if self.tables else None
        if name == "tr" and table:
            table["columns"] = table["columns"] or table["cells"]
            if table["cells"] != table["columns"]:
                self.faults.append("a row of another length")
            table["cells"] = 0
        if name == "table" and table:
            for part, words in (("caption", "a table without a caption"), ("header", "a table without headers")):
                if not table[part]:
                    self.faults.append(words)
            self.tables.pop()
        if name == "figure" and not self.figcaption:
            self.faults.append("a figure without a caption")

    def read(self, html):
        if not html.startswith("<!doctype html>\n"):
            self.faults.append("no doctype")
        at = html.find(">") + 1
        while at < len(html):
            end = html.find("<", at)
            end = len(html) if end < 0 else end
            if ">" in html[at:end]:
                self.faults.append("a bare > in text")
            if end == len(html):
                break
            tag = TAG.match(html, end)
            if not tag:
                self.faults.append(f"no tag: {html[end:end + 60]}")
                break
            at = tag.end()
            if tag[1]:
                self.closing(tag[2])
                continue
            self.opening(tag[2], {a[1]: a[2] or a[3] or "" for a in ATTRIBUTE.finditer(tag[3])})
            if tag[4] or tag[2] in VOID:
                continue
            self.open.append(tag[2])
            if tag[2] == "style":
                end = html.find("</style>", at)
                if re.search(r"url\(|@import", html[at:end]):
                    self.faults.append("a style from outside")
                at = end
        self.faults += [f"not closed: {name}" for name in self.open]
        self.faults += [f"leads nowhere: #{name}" for name in self.wanted if name not in self.ids]
        if self.h1 != 1:
            self.faults.append("not one h1")


page = Page()
page.read(sys.stdin.read())
print("\n".join(fault.replace("\n", " ") for fault in page.faults))
