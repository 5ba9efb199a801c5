#!/usr/bin/env python3
"""Holds the JSON Schemas of settings against their readers, on files that are changed at random.

    schemas_and_readers.py SETTINGS_FILES ROOT [NUMBER]

A schema accepts all that the reader accepts. Both refuse a wrong type, a number out of its range,
an unknown or missing key and an unknown word; rules between keys are the reader's alone.
"""

import copy
import json
import pathlib
import random
import re
import subprocess
import sys

try:
    import jsonschema
except ImportError:
    print("there is no Python module jsonschema")
    sys.exit(77)

# How the readers' messages name what schemas know as well. Rules between keys have other words.
OF_SCHEMAS = ("must be text in quotes, not", "must be true or false, not", "must be a number, not",
              "must be a whole number, not", "must be a list, not", "must be an object, not",
              "is not a known key", "is not known to this version", "entries, must have from")
# Their range depends on what differs, another key.
EXCEPT = "/threshold/standards/"
VALUES = (None, True, 7, -1, 0, 0.5, 1e9, 3.5, "qqqqqqqq", "", [], {}, [1, 2, 3], {"qqqqqqqq": 1})


def places_in(value, place=()):
    yield place
    items = (value.items() if isinstance(value, dict)
             else enumerate(value) if isinstance(value, list) else ())
    for key, inner in items:
        yield from places_in(inner, (*place, key))


def at(value, place):
    for key in place:
        value = value[key]
    return value


def rule_at(schema, rule, place):
    """The part of the schema for a place; nothing where it has several forms."""
    for key in place:
        if "$ref" in rule:
            rule = at(schema, rule["$ref"].split("/")[1:])
        rule = rule.get("items") if isinstance(key, int) else rule.get("properties", {}).get(key)
        if rule is None:
            return None
    return rule


def bounds_of(rule):
    for word in ("minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum"):
        if word in rule:
            bound = rule[word]
            step = 1 if rule.get("type") == "integer" else 1e-6 * max(1.0, abs(bound))
            yield from (bound, bound - step, bound + step)
    yield from rule.get("enum", ())


def mutated(file, schema, source):
    """A file with one or two changes."""
    changed = copy.deepcopy(file)
    for _ in range(source.choice((1, 1, 1, 2))):
        place = source.choice([one for one in places_in(changed) if one])
        outer = at(changed, place[:-1])
        rule = rule_at(schema, schema, place)
        kind = source.random()
        candidates = list(bounds_of(rule)) if rule else []
        if kind < 0.4 and candidates:
            outer[place[-1]] = source.choice(candidates)
        elif kind < 0.7:
            outer[place[-1]] = copy.deepcopy(source.choice(VALUES))
        elif kind < 0.8 and isinstance(outer, dict):
            outer["qqqqqqqq"] = 1
        elif kind < 0.9 and isinstance(outer, dict):
            known = (rule_at(schema, schema, place[:-1]) or {}).get("properties", {})
            added = source.choice(sorted(known) or ["qqqqqqqq"])
            outer[added] = known.get(added, {}).get("default", source.choice(VALUES))
        else:
            del outer[place[-1]]
    return changed


def verdicts(program, kind, files):
    lines = "".join(json.dumps(file) + "\n" for file in files)
    return subprocess.run([program, "judge", kind], input=lines, text=True, check=True,
                          stdout=subprocess.PIPE).stdout.split("\n")[:-1]


def is_of_schemas(refusal):
    if EXCEPT in refusal:
        return False
    is_missing = refusal.endswith("is missing; add it")
    is_range = ", must be from " in refusal or ", must be above " in refusal \
        or ", must be at least " in refusal
    return is_missing or is_range or any(words in refusal for words in OF_SCHEMAS)


def check(program, root, kind, files, number):
    schema = json.loads((root / f"config/schema/{kind}.schema.json").read_text())
    judge = jsonschema.Draft202012Validator(schema)
    source = random.Random(kind)
    changed = files + [mutated(source.choice(files), schema, source) for _ in range(number)]
    counts = {True: 0, False: 0}
    faults = []
    for file, refusal in zip(changed, verdicts(program, kind, changed), strict=True):
        accepts = judge.is_valid(file)
        counts[not refusal] += 1
        if not refusal and not accepts:
            error = next(judge.iter_errors(file))
            faults.append(f"the schema alone refuses: {error.json_path}: {error.message}")
        if refusal and accepts and is_of_schemas(refusal):
            faults.append(f"the reader alone refuses: {refusal}")
    print(f"{kind}: {counts[True]} files accepted, {counts[False]} refused, {len(faults)} faults")
    for fault in sorted(set(faults)):
        print("  " + fault)
    return faults or counts[True] < number / 20 or counts[False] < number / 20


def without_comments(path):
    """A settings file, in which // and /* begin comments outside of texts."""
    parts = re.compile(r'("(?:\\.|[^"\\])*")|//[^\n]*|/\*.*?\*/', re.DOTALL)
    return json.loads(parts.sub(lambda found: found[1] or "", path.read_text()))


def main():
    program, root = sys.argv[1], pathlib.Path(sys.argv[2])
    number = int(sys.argv[3]) if len(sys.argv) > 3 else 2000
    config = root / "config"
    files = {
        "study": [without_comments(path) for path in sorted(config.glob("*.json"))
                  if path.name != "devices.json"],
        "subject": [without_comments(path) for path in sorted(config.glob("subjects/*.json"))],
        "devices": [without_comments(config / "devices.json")],
        "device-model": [without_comments(path) for path in sorted(config.glob("devices/*.json"))],
    }
    faults = [check(program, root, kind, files[kind], number // 4) for kind in files]
    return 1 if any(faults) else 0


if __name__ == "__main__":
    sys.exit(main())
