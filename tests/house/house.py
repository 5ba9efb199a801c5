#!/usr/bin/env python3
"""house.py ROOT: checks the sources below ROOT against docs/architecture.md. Prints one line per violation."""
import collections
import os
import pathlib
import re
import sys

# Headers that are also compiled as C, without a namespace.
C_HEADERS = {"device/drivers/plugin/touchtrial_device.h"}
ENTRY = r"main\(|LLVMFuzzerTestOneInput\("  # global functions that the linker requires
ARGUMENTS = r"(?:<[^<>()]*(?:<[^<>()]*>[^<>()]*)*>)?"  # of a template
OTHER_ENDINGS = {".h", ".hh", ".hxx", ".c", ".cc", ".cxx", ".inl", ".ipp", ".tpp"}


class Room:
    """A folder with its own static library."""

    def __init__(self, folder, uses):
        self.folder = folder
        self.sees_inside = "private headers" in uses
        self.named = {use for use in re.findall(r"[\w/]+", uses.split(" and ")[0]) if use != "-"}
        words = folder.split("/")
        # A protocol's part belongs to the layer of its last word.
        part = [words[-1], words[1]] if len(words) == 3 else [words[-1]]
        self.layer = part[0]
        self.name_space = "::".join(["touchtrial"] + (part if folder != "core" else []))


def rooms_of(architecture):
    """The rooms of the page's table, each with the folders that it may use, directly or indirectly."""
    rows = re.findall(r"^\| `([\w/]+)` \|.*\| ([^|]+) \|$", architecture, re.M)
    rooms = {folder: Room(folder, uses) for folder, uses in rows}
    for room in rooms.values():
        room.uses, pending = set(), list(room.named)
        while pending:
            used = pending.pop()
            if used not in rooms:
                raise SystemExit(f"docs/architecture.md: {room.folder} may use {used}, which is not in the table")
            if used not in room.uses:
                room.uses.add(used)
                pending += rooms[used].named
        if room.folder in room.uses:
            raise SystemExit(f"docs/architecture.md: {room.folder} may use itself indirectly")
    return rooms


def plain(text):
    """The text without comments, directives and code under `#if 0`, with "" for literals; and its includes."""
    text = text.replace("\r", "").replace("\\\n", "")
    skipped = re.compile(r'(?:u8|[uUL])?R"([^(\s]*)\(.*?\)\1"|//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"'
                         r"|(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])*'", re.S)
    includes, lines, skipped_depth = [], [], 0

    def shortened(found):
        if found[0].startswith("//"):
            return ""
        if found[0].startswith("/*"):
            return " "
        return found[0] if text[text.rfind("\n", 0, found.start()) + 1:found.start()].strip().startswith("#") else '""'

    for line in skipped.sub(shortened, text).split("\n"):
        directive = re.match(r"\s*#\s*(\w*)\s*(.*)", line)
        if not directive:
            lines += [] if skipped_depth else [line]
            continue
        word, rest = directive[1], directive[2].strip()
        if skipped_depth:
            skipped_depth += word.startswith("if")
            skipped_depth -= word == "endif" or (skipped_depth == 1 and word.startswith("el"))
        elif word == "if" and rest == "0":
            skipped_depth = 1
        elif word == "include" and rest:
            includes.append(rest.split()[0])
    return "\n".join(lines), includes


def without_parentheses(words):
    while (fewer := re.sub(r"\([^()]*\)", "", words)) != words:
        words = fewer
    return words


class Definition:
    def __init__(self, kind, name, is_local=False, aliased=""):
        self.kind, self.name, self.is_local, self.aliased = kind, name, is_local, aliased


class Source:
    """A file's includes and definitions. Macros are not expanded."""

    def __init__(self, path, text, room):
        self.path, self.text, self.room = path, text, room
        self.folder = os.path.dirname(path)
        self.is_header = path.endswith(".hpp")
        self.once_a_target = path.endswith("-inl.hpp")
        self.code, self.includes = plain(text)
        self.definitions, self.used_namespaces = [], []
        self.namespaces = collections.defaultdict(bool)  # whether it has more than forward declarations
        self.pairs, self.is_complete = {}, True
        self.match_brackets()
        if self.is_complete:
            self.scope("", 0, len(self.code))

    def match_brackets(self):
        opened = []
        for found in re.finditer(r"[(){}\[\]]", self.code):
            if found[0] in "({[":
                opened.append(found)
            elif opened and opened[-1][0] + found[0] in ("()", "{}", "[]"):
                self.pairs[opened.pop().start()] = found.start()
            else:
                self.is_complete = False
        self.is_complete = self.is_complete and not opened

    def scope(self, space, at, end):
        """Reads the statements of a namespace."""
        head = ""  # of the statement, without the content of its braces
        while at < end:
            sign = self.code[at]
            if sign == ";":
                self.ended(space, head.strip())
                head = ""
            elif sign == "{":
                close, words = self.pairs[at], " ".join(head.split())
                if found := re.search(r'(?:^|\s)(?:inline )?namespace\b(?:\s*\[\[.*?\]\])?\s*([\w:\s]*)$', words):
                    name = re.sub(r"\binline\b|\s", "", found[1])
                    inner = "::".join(filter(None, [space, name or "(anonymous)"]))
                    if "(anonymous)" not in inner:
                        self.namespaces[inner] |= False
                    self.scope(inner, at + 1, close)
                    head = ""
                elif re.fullmatch(r'extern ""', words):
                    self.scope(space, at + 1, close)
                    head = ""
                else:
                    head = self.opened(space, words)
                at = close
            elif sign in "([":
                head += self.code[at:self.pairs[at] + 1]
                at = self.pairs[at]
            else:
                head += sign
            at += 1

    def opened(self, space, words):
        """Handles braces after the words of a statement. Returns its words if it continues after them."""
        self.holds_more(space)
        bare = declaration(words)
        if found := re.match(r"(?:typedef )?(class|struct|union|enum(?: class| struct)?)\b(.*)", bare):
            if not re.search(r"\)( const| noexcept| override)*$", re.split(r"(?<!:):(?!:)", found[2])[0]):
                name = re.split(r"(?<!:):(?!:)", found[2])[0].replace(" final", "")
                name = re.findall(r"(?:[\w:]|<[^{}]*>)+", re.sub(r"\w+\(.*?\)", "", name))
                if name:
                    self.add("type", space, name[-1])
                return "typedef } " if bare.startswith("typedef") else "} "
        initialises = re.search(r"\)\s*(?:noexcept)?\s*(?<!:):(?!:)", bare) and re.search(r"[\w>]$", bare)
        if re.search(r"\brequires\s*(\([^{}]*\))?$", words):
            return words + " {requires} "
        if "=" in re.sub(r"operator\s*\S+|[<>=!]=", "", without_parentheses(bare)) or not function_of(bare) or initialises:
            return words + " {}"
        self.function(space, bare)
        return ""

    def ended(self, space, head):
        words = " ".join(head.split())
        bare = declaration(words)
        if not words or words == "}":
            return
        if re.match(r"(class|struct|union|enum)\b[^=(){}]*$", bare) and not words.startswith("}"):
            return  # a forward declaration
        self.holds_more(space)
        if found := re.match(r"using namespace ([\w:]+)", bare):
            self.used_namespaces.append(found[1])
        elif found := re.match(r"using (\w+)(?: \[\[.*?\]\])? ?= ?(.*)", bare):
            self.add("type", space, found[1], aliased=found[2])
        elif found := re.match(r"concept (\w+)", bare):
            self.add("type", space, found[1])
        elif bare.startswith("typedef"):
            found = re.search(r"\( ?\* ?(\w+)\)|(\w+)(?:\[.*\])?$", bare)
            self.add("type", space, found[1] or found[2], aliased=bare)
        elif re.match(r"(using|namespace|static_assert|friend|template|asm|extern template)\b", bare):
            return
        elif re.search(r"= ?(default|delete)$", bare):
            self.function(space, bare)
        elif function_of(bare) and not re.search(r"\{\}|(?<![<>=!])=(?!=)", without_parentheses(bare)):
            return  # a declaration
        else:
            self.variable(space, bare)

    def function(self, space, bare):
        found = function_of(bare)
        if not found or found[1] in ("catch", "if"):
            return
        name, parameters, after = found[1], found[2], re.split(r"(?<!:):(?!:)", found[3])[0]
        if re.match(r'(inline )?extern ""', bare) and "(anonymous)" not in space:
            self.add("function", "", 'extern "C" ' + name)
            return
        condition = " ".join(re.findall(r"\brequires\b.*", bare))
        ends = "".join(re.findall(r"\bconst\b|&", after.split("->")[0]))
        self.add("function", space, f"{name}({', '.join(types_of(parameters))}){ends}{condition}",
                 is_local=bool(re.search(r"\bstatic\b", bare)))

    def variable(self, space, bare):
        is_value = re.search(r"=|\{\}", without_parentheses(bare))
        if re.search(r"\bextern\b", bare) and not is_value:
            return
        head = re.split(r"(?<![<>=!])=(?!=)|\{\}", bare)[0]
        found = re.search(r"\( ?[*&] ?(\w+)", head) or re.search(r"([\w:]+)\s*(?:\[.*\]|\(.*\)|\s)*$", head)
        if not found or len(head.split()) < 2:
            return
        shared = re.search(r"\b(inline|extern)\b", head)
        constant = re.search(r"\bconst(expr)?\b", head)
        self.add("variable", space, found[1], bool(re.search(r"\bstatic\b", head) or (constant and not shared)))

    def holds_more(self, space):
        named = space.split("::(anonymous)")[0]
        if named and named != "(anonymous)":
            self.namespaces[named] = True

    def add(self, kind, space, name, is_local=False, aliased=""):
        if not space and name.startswith("touchtrial::"):
            self.holds_more(name.split("(")[0].split("<")[0].rsplit("::", 1)[0])
        self.definitions.append(
            Definition(kind, f"{space}::{name}" if space else name, is_local or "(anonymous)" in space, aliased))


def declaration(words):
    """A statement without attributes and "template <...>"."""
    words = re.sub(r"\[\[.*?\]\]|\b(alignas|__attribute__|decltype|explicit|noexcept)\s*\((\([^()]*\)|[^()])*\)", " ", words)
    words = " ".join(words.split())
    while words.startswith("template"):
        opening, depth, at = words.find("<"), 0, words.find("<")
        if words[8:opening].strip():
            return words  # an instantiation
        while at < len(words):
            bracket = words[at]
            if bracket == "(":
                at = words.find(")", at)
            depth += (bracket == "<") - (bracket == ">")
            at += 1
            if depth == 0:
                break
        words = words[at:].strip()
    words = re.sub(r"^requires .*?\{requires\} |^requires .*?\) (?=\w)|^requires [\w:]+<[^<>]*>\s*(&& \(.*?\) )?", "", words)
    return re.sub(r"^((inline|constexpr|constinit|static|thread_local) )*(?=(class|struct|union|enum|concept)\b)", "", words)


def function_of(bare):
    """Match of name, parameters and rest if the statement declares a function."""
    return re.match(rf"(?:.*?[\s&*])??((?:\w+{ARGUMENTS}::)*(?:operator\s*(?:\(\)|[^\s(]+|[\w: ]+)|~?\w+{ARGUMENTS}))"
                    r"\s*\((?![*&])((?:\([^()]*(?:\([^()]*\)[^()]*)*\)|[^()])*)\)(?!\s*\()(.*)$", bare)


def types_of(parameters):
    """The parameters' types without white space, names and default values."""
    types, depth, one = [], 0, ""
    for sign in parameters + ",":
        depth += (sign in "<([{") - (sign in ">)]}")
        if sign != "," or depth > 0:
            one += sign
            continue
        one = " ".join(re.sub(r"=.*", "", one).split())
        named = re.fullmatch(r"(.*(?:[\w>*&]|\.\.\.)[\s&*]+)(?!(?:int|char|long|short|double|const)$)\w+(\[.*\])?", one)
        is_only_type = re.fullmatch(r"(const|volatile|struct|class|enum|typename|unsigned) [\w:]+", one)
        types.append(re.sub(r"\s", "", one if is_only_type or not named else named[1]))
        one = ""
    return types


class House:
    def __init__(self, root, architecture):
        self.root, self.rooms = pathlib.Path(root), rooms_of(architecture)
        self.sources, self.not_read = {}, []
        for top in sorted({folder.split("/")[0] for folder in self.rooms}):
            for path in sorted((self.root / top).rglob("*")):
                self.read(path.relative_to(self.root).as_posix(), path)

    def room_of(self, path):
        """The innermost room of a path."""
        inside = [room for folder, room in self.rooms.items() if path.startswith(folder + "/")]
        return max(inside, key=lambda room: len(room.folder), default=None)

    def read(self, path, file):
        if path in C_HEADERS:
            return
        if file.suffix in OTHER_ENDINGS:
            self.not_read.append(f"{path} ends neither in .hpp nor in .cpp")
        if file.suffix in (".hpp", ".cpp"):
            if room := self.room_of(path):
                self.sources[path] = Source(path, file.read_text(), room)
            else:
                self.not_read.append(f"{path} is in no room")

    def ours(self, source):
        """The names of included files of the project."""
        names = [(include[1:-1], include[0]) for include in source.includes]
        return [name for name, mark in names if mark == '"' or self.room_of(name)]

    def wrong_includes(self):
        for source in self.sources.values():
            for name in self.ours(source):
                to, what = self.room_of(name), f"{source.path} includes {name}"
                if source.room.sees_inside and name.startswith("tests/"):
                    continue
                if not (self.root / name).exists():
                    yield f"{what}, which does not exist"
                elif to is None:
                    yield f"{what}, which is in no room"
                elif name not in self.sources and name not in C_HEADERS:
                    yield f"{what}, which is not read: headers end in .hpp"
                elif to is not source.room and to.folder not in source.room.uses:
                    yield f"{what}, which its room may not use"

    def third_party_headers_shown(self):
        """Unlike the C++ standard library's, all third-party headers have a folder or an ending."""
        showing = set()
        while True:
            more = {source.path for source in self.sources.values() if source.is_header and (
                any(name in showing for name in self.ours(source)) or
                any(re.search(r"[/.]", i) and not self.room_of(i[1:-1]) for i in source.includes if i[0] == "<"))}
            if more == showing:
                break
            showing = more
        for source in self.sources.values():
            for name in self.ours(source):
                if name in showing and not source.room.sees_inside and not self.in_one_layer(source.room, name):
                    yield f"{source.path} includes {name}, which exposes a third-party header"

    def in_one_layer(self, part, name):
        layer = self.room_of(name)
        return layer is part or part.name_space.startswith(layer.name_space + "::") and layer.folder != "core"

    def private_headers_used_elsewhere(self):
        for source in self.sources.values():
            for name in self.ours(source):
                header = self.sources.get(name)
                comment = re.match(r"(?:///.*\n)*", header.text)[0].replace("///", "") if header else ""
                found = re.search(r"[Pp]rivate to\s+([\w/]*\w)", comment)
                if not found or source.room.sees_inside:
                    continue
                folder = found[1] if (header.folder + "/").startswith(found[1] + "/") else header.folder
                if not source.path.startswith(folder + "/"):
                    yield f"{source.path} includes {name}, which is private to {folder}"

    def reached_from(self, path):
        """All headers that a file includes, directly or not."""
        reached, waiting = set(), [path]
        while waiting:
            new = set(self.ours(self.sources[waiting.pop()])) & set(self.sources) - reached
            reached |= new
            waiting += new
        return reached

    def hidden_headers_reached(self):
        """A header may state "Hidden from FOLDER and FILE, but for FILE": these may not include it, even indirectly."""
        for header in self.sources.values():
            comment = re.match(r"(?:///.*\n)*", header.text)[0].replace("///", "") if header.is_header else ""
            found = re.search(r"Hidden\s+from\s+([^,:]+)(?:,\s+but\s+for\s+([\w/.]+))?", comment)
            if not found:
                continue
            hidden_from = tuple(re.sub(r"\.$", "", place) for place in found[1].split() if place != "and")
            for path in self.sources:
                if path != found[2] and path.startswith(hidden_from) and header.path in self.reached_from(path):
                    yield f"{path} reaches {header.path}, which is hidden from it"

    def names_defined_twice(self):
        """Names local to a source must be unique in its folder, whose files may be compiled together."""
        files_by_meaning = collections.defaultdict(dict)
        for source in self.sources.values():
            includes_itself = "<hwy/foreach_target.h>" in source.includes
            for definition in source.definitions:
                is_local = definition.is_local and not source.is_header
                if source.once_a_target or re.match(ENTRY, definition.name) or (is_local and includes_itself):
                    continue
                name = f"{definition.kind} {definition.name}"
                if is_local:
                    name = f"{name.replace('(anonymous)::', '')} of folder {source.folder}"
                # Files compiled together may repeat an alias.
                meaning = definition.aliased if is_local and definition.aliased else source.path
                files_by_meaning[name].setdefault(meaning, source.path)
        for name, files in sorted(files_by_meaning.items()):
            if len(files) > 1:
                yield f"{name} is defined in {' '.join(sorted(files.values()))}"

    def namespaces_of_other_rooms(self):
        for source in self.sources.values():
            own, opens_own = source.room.name_space, False
            for name, holds_more in sorted(source.namespaces.items()):
                inner_rooms = [room.name_space for room in self.rooms.values()
                          if (name + "::").startswith(room.name_space + "::") and len(room.name_space) > len(own)]
                inside = (name + "::").startswith(own + "::") and not inner_rooms
                opens_own = opens_own or inside
                if not inside and holds_more and not (name + "::").startswith("std::"):
                    yield f"{source.path} opens namespace {name}"
            for definition in source.definitions:
                if "::" not in definition.name.split("(")[0] and not re.match(ENTRY + "|extern", definition.name):
                    yield f"{source.path} defines {definition.name.split('(')[0]} in no namespace"
            if source.is_header:
                yield from (f"{source.path} uses all of namespace {used}" for used in source.used_namespaces)
            if not opens_own and not source.path.endswith(("main.cpp", "fuzz/driver.cpp")):
                yield f"{source.path} does not open namespace {own}"

    def unguarded_or_unexplained(self):
        for source in self.sources.values():
            if not source.is_complete:
                yield f"{source.path} has an unmatched bracket"
            if source.is_header and not source.text.startswith("/// \\file "):
                yield f"{source.path} does not begin with \\file"
            if source.is_header and not source.once_a_target and "#pragma once" not in source.text:
                yield f"{source.path} has no #pragma once"

    def violations(self):
        return [*self.not_read, *self.wrong_includes(), *self.third_party_headers_shown(),
                *self.private_headers_used_elsewhere(), *self.hidden_headers_reached(), *self.names_defined_twice(),
                *self.namespaces_of_other_rooms(), *self.unguarded_or_unexplained()]


def main(root):
    house = House(root, (pathlib.Path(root) / "docs" / "architecture.md").read_text())
    empty = [f"{room.folder} has no sources" for room in house.rooms.values()
             if not any(source.room is room for source in house.sources.values())]
    found = empty + house.violations()
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
