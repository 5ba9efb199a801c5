#!/usr/bin/python3
"""Prints what is wrong with a dataset, one fault a line: dataset_rules.py bids|psych-ds FOLDER. Written from the
specifications, so that no test needs a network; scripts/validate-exports asks the official validators.

BIDS 1.11.1 and its schema: "Common principles", "Modality agnostic files", "Behavioral experiments (with no neural
recordings)", "Motion". Psych-DS schema 1.5.1."""
import csv, json, math, os, re, sys

faults = []


def fault(path, what):
    faults.append(f"{path}: {what}")


def text_of(path):
    with open(path, encoding="utf-8", newline="") as file:
        return file.read()


def is_number(text):
    return re.fullmatch(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", text) is not None


def parsed(path):
    if not os.path.exists(path):
        fault(path, "is missing")
        return {}
    try:
        found = json.loads(text_of(path))
    except ValueError:
        found = None
    if not isinstance(found, dict):
        fault(path, "is no JSON object")
        return {}
    return found


def files_below(folder):
    for place, _, names in os.walk(folder):
        for name in names:
            yield os.path.join(place, name)


# --- BIDS: tables ---

def rows_of(path):
    return [line.split("\t") for line in text_of(path).split("\n")[:-1]]


def table_of(path):
    """The rows of any TSV file that fit its header, the header first."""
    text = text_of(path)
    if not text.endswith("\n") or "\r" in text or text.startswith("\ufeff"):
        fault(path, "has other ends of lines, or a byte order mark")
    lines = rows_of(path)
    if not lines:
        return [[""]]
    header = lines[0]
    if len(set(header)) != len(header):
        fault(path, "has a column twice")
    for name in header:
        if not re.fullmatch("[a-z][a-z0-9]*(_[a-z0-9]+)*", name):
            fault(path, f"has a column {name}")
    if {"onset", "duration"}.issubset(header) != path.endswith("_events.tsv"):
        fault(path, "must have onset and duration if it lists events, and else not both")
    for row in lines:
        if len(row) != len(header):
            fault(path, "has a row of another length")
        if "" in row:
            fault(path, "has an empty value in place of n/a")
    return [row for row in lines if len(row) == len(header)]


def check_columns(path, table, sidecar):
    for place, name in enumerate(table[0]):
        if name in ("participant_id", "session_id"):
            continue
        described = sidecar.get(name, {})
        if "Description" not in described:
            fault(path, f"column {name} is not described")
        for row in table[1:]:
            if "Levels" in described and row[place] != "n/a" and row[place] not in described["Levels"]:
                fault(path, f"{name} has no level {row[place]}")


def sidecar_beside(path):
    return parsed(path[:-len(".tsv")] + ".json")


def check_trials(dataset, path):
    task = re.sub(r".*_(task-[a-zA-Z0-9]+)_beh\.tsv", r"\1", os.path.basename(path))
    sidecar = parsed(os.path.join(dataset, task + "_beh.json"))
    if "TaskName" not in sidecar:
        fault(path, "no TaskName")
    table = table_of(path)
    check_columns(path, table, sidecar)
    of_session = os.path.dirname(os.path.dirname(path))
    for row in table[1:]:
        for name, value in zip(table[0], row):
            wrong = {"response_time": not is_number(value),
                     "motion_file": not os.path.exists(os.path.join(of_session, value)),
                     "stim_file": not os.path.exists(os.path.join(dataset, "stimuli", value))}
            if value != "n/a" and wrong.get(name):
                fault(path, f"{name} {value}")


def check_events(dataset, path):
    """Rows begin with a time and a duration, in order; unknown times come last. Schema, rules/checks/events.yaml."""
    table = table_of(path)
    check_columns(path, table, sidecar_of(dataset, path))
    if table[0][:2] != ["onset", "duration"]:
        return fault(path, "does not begin with onset and duration")
    before = 0.0
    for onset, duration, *_ in table[1:]:
        at = math.inf if onset == "n/a" else float(onset) if is_number(onset) else -1.0
        if at < before or not (duration == "n/a" or is_number(duration) and float(duration) >= 0.0):
            fault(path, f"onset {onset}, duration {duration}")
        before = at


def check_list_of_people(path, table, there):
    if table[0][0] != "participant_id":
        fault(path, "participant_id is not first")
    listed = [row[0] for row in table[1:]]
    if len(set(listed)) != len(listed):
        fault(path, "lists somebody twice")
    if not set(listed).issubset(there):
        fault(path, "lists somebody who is not there")
    return set(listed)


def check_sessions(dataset, path):
    table = table_of(path)
    check_columns(path, table, sidecar_beside(path))
    if table[0][0] != "session_id":
        fault(path, "session_id is not first")
    for column in set(table[0]).intersection(table_of(os.path.join(dataset, "participants.tsv"))[0]):
        fault(path, f"participants.tsv has a column {column} too")


def check_scans(path):
    named = [row[0] for row in table_of(path)[1:]]
    if len(set(named)) != len(named) or not all(os.path.exists(os.path.join(os.path.dirname(path), one)) for one in named):
        fault(path, "names a file that is not there, or one twice")


# --- BIDS: names and inheritance ---

def parts_of(path):
    """The entities of a file name, its suffix and its extension. Schema, rules/entities.yaml."""
    stem, _, extension = os.path.basename(path).partition(".")
    parts = stem.split("_")
    return dict(part.split("-", 1) for part in parts if "-" in part), parts[-1], extension


def inherited(dataset, path, suffix, extension):
    """The metadata files that apply to a file, from the top down. "The Inheritance Principle", rules 2, 4 and 5."""
    own = parts_of(path)[0]
    levels = [dataset]
    for folder in os.path.relpath(os.path.dirname(path), dataset).split(os.sep):
        levels += [] if folder == "." else [os.path.join(levels[-1], folder)]
    found = []
    for level in levels:
        here = []
        for name in sorted(os.listdir(level)):
            entities, other, ending = parts_of(name)
            if (other, ending) == (suffix, extension) and entities.items() <= own.items():
                here.append(os.path.join(level, name))
        if len(here) > 1:
            fault(path, "two files apply at one level")
        found += here
    return found


def sidecar_of(dataset, path):
    merged = {}
    for one in inherited(dataset, path, parts_of(path)[1], "json"):
        merged.update(parsed(one))
    return merged


TASK = "_task-[0-9a-zA-Z]+"
MOTION = TASK + r"_tracksys-[0-9a-zA-Z]+(_run-[0-9]+)?_(motion|events|channels)\.(tsv|json)"
# Labels in folders and names agree, entities have their order. Schema, rules/files/raw and rules/files/common.
NAMES = (
    r"dataset_description\.json|README|(participants|scans)\.json|participants\.tsv",
    r"task-[a-zA-Z0-9]+_((beh|events|channels)\.json|channels\.tsv)",
    r"phenotype/[a-z][a-z0-9_]*\.(tsv|json)",
    r"(?P<sub>sub-[0-9a-zA-Z]+)/(?P=sub)_sessions\.(tsv|json)",
    r"(?P<sub>sub-[0-9a-zA-Z]+)/(?P<ses>ses-[0-9a-zA-Z]+/)?"
    r"(beh/(?P<who>sub-[0-9a-zA-Z]+(_ses-[0-9a-zA-Z]+)?)" + TASK + r"_(beh|events)\.tsv"
    r"|motion/(?P<whom>sub-[0-9a-zA-Z]+(_ses-[0-9a-zA-Z]+)?)" + MOTION +
    r"|(?P<whose>sub-[0-9a-zA-Z]+(_ses-[0-9a-zA-Z]+)?)_scans\.tsv)")


def name_is_allowed(name):
    match = next(filter(None, (re.fullmatch(one, name) for one in NAMES)), None)
    if not match or "ses" not in match.groupdict():
        return match is not None
    folders = match["sub"] + ("_" + match["ses"][:-1] if match["ses"] else "")
    return folders == (match["who"] or match["whom"] or match["whose"])


# --- BIDS: motion ---

# Schema, rules/tabular_data/motion.yaml: the columns that channels.tsv begins with, and others that need no description.
FIRST_COLUMNS = ["name", "component", "type", "tracked_point", "units"]
OTHER_COLUMNS = {"placement", "reference_frame", "description", "sampling_frequency", "status", "status_description"}
COMPONENTS = {"x", "y", "z", "quat_x", "quat_y", "quat_z", "quat_w", "n/a"}
TYPES = {"ACCEL", "ANGACCEL", "GYRO", "JNTANG", "LATENCY", "MAGN", "MISC", "ORNT", "POS", "VEL"}
# Schema, rules/sidecars/motion.yaml; npm's validator refuses other fields.
FIELDS = {"TaskName", "TaskDescription", "Instructions", "InstitutionName", "InstitutionAddress",
          "InstitutionalDepartmentName", "DeviceSerialNumber", "Manufacturer", "ManufacturersModelName",
          "SoftwareVersions", "SamplingFrequency", "SamplingFrequencyEffective", "SubjectArtefactDescription",
          "TrackingSystemName", "TrackedPointsCount", "MissingValues", "MotionChannelCount"}


def check_channels(dataset, recording, sidecar):
    """\\return the types of the channels, in order"""
    files = inherited(dataset, recording, "channels", "tsv")
    if not files:
        fault(recording, "has no channels.tsv")
        return []
    path = files[-1]
    table = table_of(path)
    if table[0][:5] != FIRST_COLUMNS or not set(table[0][5:]).issubset(OTHER_COLUMNS):
        fault(path, "has other columns")
        return []
    channels = table[1:]
    if len({row[0] for row in channels}) != len(channels):
        fault(path, "has two channels of one name")
    for _, component, kind, _, unit, *_ in channels:
        if component not in COMPONENTS or kind not in TYPES or (kind == "POS" and component == "n/a") or (
                kind == "LATENCY" and unit != "s"):
            fault(path, f"component {component}, type {kind}, unit {unit}")
    kinds = [row[2] for row in channels]
    for kind in TYPES:
        if sidecar.get(kind + "ChannelCount", 0) != kinds.count(kind):
            fault(path, f"miscounts {kind}")
    if "reference_frame" in table[0]:
        frames = sidecar_of(dataset, path).get("reference_frame", {}).get("Levels", {})
        for frame in {row[table[0].index("reference_frame")] for row in channels} - {"n/a"}:
            if frame not in frames:
                fault(path, f"frame {frame} is not described")
    return kinds


def check_motion(dataset, path):
    """A recording has no header, a column for each channel, latencies from 0 upwards in seconds, the JSON that is
    required, events, and a row in *_scans.tsv."""
    sidecar = sidecar_of(dataset, path)
    for field in {"TaskName", "SamplingFrequency"} - set(sidecar):
        fault(path, f"lacks {field}")
    for field in set(sidecar) - FIELDS - {kind + "ChannelCount" for kind in TYPES}:
        fault(path, f"has a field {field}")
    kinds = check_channels(dataset, path, sidecar)
    before = 0.0
    for number, row in enumerate(rows_of(path)):
        if len(row) != len(kinds) or not all(value == "n/a" or is_number(value) for value in row):
            fault(path, "has a row that does not fit its channels")
            break
        for kind, value in zip(kinds, row):
            if kind != "LATENCY":
                continue
            at = before if value == "n/a" else float(value)
            if not re.fullmatch(r"[0-9]+(\.[0-9]{1,6})?|n/a", value) or at < before or (number == 0 and at != 0.0):
                fault(path, f"latency {value}")
            before = at
    if not os.path.exists(path.replace("_motion.tsv", "_events.tsv")):
        fault(path, "has no events")
    entities = parts_of(path)[0]
    folder = os.path.dirname(os.path.dirname(path))
    session = "_ses-" + entities["ses"] if "ses" in entities else ""
    scans = table_of(os.path.join(folder, f"sub-{entities['sub']}{session}_scans.tsv"))
    times = [row[1] for row in scans[1:] if row[0] == os.path.relpath(path, folder)]
    pattern = r"\d{4}-\d{2}-\d{2}T\d{2}:\d{2}:\d{2}(\.\d{1,6})?"
    if scans[0] != ["filename", "acq_time"] or len(times) != 1 or not re.fullmatch(pattern, times[0]):
        fault(path, "has no time in scans.tsv")


# --- BIDS: the whole ---

def check_bids_description(folder, kind):
    path = os.path.join(folder, "dataset_description.json")
    found = parsed(path)
    for key in ("Name", "BIDSVersion"):
        if not isinstance(found.get(key), str):
            fault(path, f"lacks {key}")
    if found.get("DatasetType", "raw") != kind or (kind == "derivative" and "GeneratedBy" not in found):
        fault(path, f"is of no {kind} dataset")


def check_bids(dataset):
    check_bids_description(dataset, "raw")
    readme = os.path.join(dataset, "README")
    if not os.path.exists(readme) or os.path.getsize(readme) <= 150:
        fault(readme, "says too little")
    for name in os.listdir(os.path.join(dataset, "derivatives")):
        check_bids_description(os.path.join(dataset, "derivatives", name), "derivative")
    there = {name for name in os.listdir(dataset) if name.startswith("sub-")}
    people = os.path.join(dataset, "participants.tsv")
    table = table_of(people)
    check_columns(people, table, sidecar_beside(people))
    if check_list_of_people(people, table, there) != there:
        fault(people, "does not list the folders")
    for path in files_below(dataset):
        name = os.path.relpath(path, dataset)
        if name.startswith((".", "sourcedata/", "derivatives/", "stimuli/")):
            continue
        if not name_is_allowed(name):
            fault(name, "is no name of BIDS")
        if name.endswith("_beh.tsv"):
            check_trials(dataset, path)
        if name.endswith("_events.tsv"):
            check_events(dataset, path)
        if name.startswith("phenotype/") and name.endswith(".tsv"):
            sidecar, answers = sidecar_beside(path), table_of(path)
            if "MeasurementToolMetadata" not in sidecar:
                fault(path, "not described")
            check_columns(path, answers, sidecar)
            check_list_of_people(path, answers, there)
        if name.endswith("_motion.tsv"):
            check_motion(dataset, path)
        if name.endswith("_scans.tsv"):
            check_scans(path)
        if name.endswith("_sessions.tsv"):
            check_sessions(dataset, path)


# --- Psych-DS. A fault has the code of the schema's rule (rules/errors). ---

KEYWORDS = {"study", "site", "subject", "session", "task", "condition", "trial", "stimulus", "description"}


def measured_in(path):
    found = parsed(path)
    for key in ("name", "description", "variableMeasured"):
        if key not in found:
            fault(path, f"JSON_KEY_REQUIRED: {key}")
    if found.get("@type") != "Dataset":
        fault(path, "INCORRECT_DATASET_TYPE")
    if found.get("@context", "").rstrip("/") != "https://schema.org":
        fault(path, "UNKNOWN_NAMESPACE")
    names = []
    for variable in found.get("variableMeasured", []):
        if isinstance(variable, dict) and variable.get("@type") != "PropertyValue":
            fault(path, "INVALID_OBJECT_TYPE")
        names.append(variable["name"] if isinstance(variable, dict) else variable)
    if len(set(names)) != len(names):
        fault(path, "measures something twice")
    return set(names)


def check_psych_ds(dataset):
    measured = measured_in(os.path.join(dataset, "dataset_description.json"))
    for name in ("README.md", "CHANGES.md", "data"):
        if not os.path.exists(os.path.join(dataset, name)):
            fault(name, "is missing")
    seen = set()
    for path in files_below(os.path.join(dataset, "data")):
        name = os.path.basename(path)
        if not re.fullmatch(r"([a-z]+-[a-zA-Z0-9]+)(_[a-z]+-[a-zA-Z0-9]+)*_data\.csv", name):
            fault(name, "FILENAME_KEYWORD_FORMATTING_ERROR")
        if not set(re.findall("([a-z]+)-[a-zA-Z0-9]+", name)).issubset(KEYWORDS):
            fault(name, "FILENAME_UNOFFICIAL_KEYWORD")
        with open(path, encoding="utf-8", newline="") as file:
            records = list(csv.reader(file, strict=True))
        if not records or not records[0] or not records[0][0]:
            fault(name, "CSV_HEADER_MISSING")
            continue
        header = records[0]
        if len(set(header)) != len(header):
            fault(name, "CSV_HEADER_REPEATED")
        if any(len(record) != len(header) for record in records):
            fault(name, "CSV_HEADER_LENGTH_MISMATCH")
        ids = [record[header.index("row_id")] for record in records] if "row_id" in header else []
        if len(set(ids)) != len(ids):
            fault(name, "ROWID_VALUES_NOT_UNIQUE")
        seen.update(header)
    for name in seen - measured:
        fault(name, "CSV_COLUMN_MISSING_FROM_METADATA")
    for name in measured - seen:
        fault(name, "VARIABLE_MISSING_FROM_CSV_COLUMNS")


{"bids": check_bids, "psych-ds": check_psych_ds}[sys.argv[1]](sys.argv[2])
print("\n".join(one.replace("\n", " ") for one in faults))
