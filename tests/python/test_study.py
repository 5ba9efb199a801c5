"""read and simulate: the same numbers as the program's report and exports."""

import json
import os
import shutil
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
import touchtrial

pandas = pytest.importorskip("pandas")


@pytest.fixture(scope="module")
def study(study_folder):
    return touchtrial.read(study_folder / "mine.db")


def test_the_report_is_what_the_program_prints(program, study_folder, study):
    printed = json.loads(program("report", study_folder / "mine.db", "--json"))
    # Head files vouch for a database's end; the module reads the database alone.
    assert printed.pop("vouched")["fault"] == ""
    assert study.report == printed
    assert study.report["trials"] == 12
    assert study.simulated and study.name == "mine"
    assert "SIMULATED" in repr(study)


def cell(value):
    """A number as a float, whatever wrote it; nothing as None."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        return value or None
    return None if np.isnan(number) else number


def test_the_tables_are_those_of_the_export(program, study_folder, study, tmp_path):
    program("export", study_folder / "mine.db", "--format", "csv", "--out", tmp_path / "csv")
    files = {file.stem: file for file in (tmp_path / "csv").glob("*.csv")}
    assert set(files) == set(study.columns)
    for name, file in files.items():
        exported = pandas.read_csv(file, dtype=str, keep_default_na=False)
        ours = study.table(name)
        assert list(ours.columns) == list(exported.columns), name
        for column in ours.columns:
            assert list(map(cell, ours[column])) == list(map(cell, exported[column])), column
    assert study.trials["session"].dtype == np.int64
    assert study.trials["reaction_time_s"].dtype == np.float64


def test_trials_sessions_and_participants_are_data_frames(study):
    assert len(study.trials) == 12
    assert study.trials["correct"].isin([0, 1]).all()
    accuracy = study.trials["correct"].mean()
    overall = study.report["methods"][0]["overall"]
    assert accuracy == pytest.approx(overall["correct"] / overall["n"])
    assert list(study.sessions["participant"]) == ["P001", "P002"]
    assert list(study.participants["session"]) == [1, 2]
    with pytest.raises(KeyError):
        study.table("nothing")


def test_traces_are_those_of_the_export(program, study_folder, study, tmp_path):
    program(
        "export", study_folder / "mine.db", "--format", "bids", "--traces", "--out", tmp_path / "bids"
    )
    files = sorted((tmp_path / "bids").rglob("*_motion.tsv"))
    assert len(files) == len(study.trials)
    for row, file in zip(study.trials.itertuples(), files):
        trace = study.trace(row.session, row.trial)
        samples = np.hstack((trace.position_mm, trace.force_n))
        exported = np.loadtxt(file)[:, 1:]  # the first is the latency
        assert samples.shape == exported.shape
        # Exports have 3 and 4 decimals.
        np.testing.assert_allclose(samples[:, :3], exported[:, :3], atol=0.000501)
        np.testing.assert_allclose(samples[:, 3:], exported[:, 3:], atol=0.0000501)
        assert trace.rate_hz == 1000
        assert trace.time_s[-1] == pytest.approx((len(samples) - 1) / 1000)


def test_the_forces_of_a_trace_are_those_of_the_texture_that_was_presented(study_folder, study):
    study_file = json.loads((study_folder / "mine.json").read_text())
    labels = [one["label"] for one in study_file["classes"]]
    fields = touchtrial.force_fields(
        [study_folder / f"{label}.pgm" for label in labels], rendering=study_file["rendering"]
    )
    for _, row in study.trials.iterrows():
        trace = study.trace(row["session"], row["trial"])
        apart = {
            label: np.median(
                np.linalg.norm(touchtrial.render(field, trace.position_mm) - trace.force_n, axis=1)
            )
            for label, field in zip(labels, fields)
        }
        assert min(apart, key=apart.get) == row["class"]


def test_samples_of_a_trace_are_shown_without_a_copy(study):
    trace = study.trace(1, 1)
    assert trace.position_mm.base is trace.force_n.base
    assert type(trace.position_mm.base.base).__name__ == "PyCapsule"


def test_a_trial_that_is_not_there_is_an_index_error(study):
    for session, trial in ((1, 0), (1, 99), (9, 1), (-1, -1)):
        with pytest.raises(IndexError, match=r"^[^\n]+$"):
            study.trace(session, trial)


def test_arrays_need_no_pandas(study_folder, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    study = touchtrial.read(study_folder / "mine.db")
    assert study.columns["trials"]["session"].dtype == np.int64
    assert study.columns["trials"]["reaction_time_s"].dtype == np.float64
    assert study.columns["trials"]["participant"][0] == "P001"
    with pytest.raises(ImportError):
        study.trials


def test_simulate_makes_the_programs_database(program, study_folder, study, tmp_path):
    db = tmp_path / "again.db"
    summary = touchtrial.simulate(study_folder / "mine.json", db, participants=2, seed=3, jobs=2)
    assert summary["sessions"] == 2 and summary["simulated"] and not summary["blind"]
    again = touchtrial.read(db)
    assert again.report == study.report
    pandas.testing.assert_frame_equal(again.trials, study.trials)
    with pytest.raises(touchtrial.Error) as caught:
        touchtrial.simulate(study_folder / "mine.json", db)
    stderr = program("simulate", study_folder / "mine.json", "--db", db, fails=True)
    assert stderr == f"touchtrial: {caught.value}\n"


def test_a_blind_study_is_refused(study_folder, tmp_path):
    db = tmp_path / "blind.db"
    touchtrial.simulate(study_folder / "mine.json", db, participants=1, keep_blind=True)
    with pytest.raises(touchtrial.Error, match=r"blind.db[^\n]*unblind`"):
        touchtrial.read(db)


def test_what_is_no_study_has_the_programs_message(program, study_folder, tmp_path):
    other = tmp_path / "other.db"
    other.write_text("no database")
    for path in (other, tmp_path / "missing.db"):
        with pytest.raises(touchtrial.Error) as caught:
            touchtrial.read(path)
        assert program("report", path, fails=True) == f"touchtrial: {caught.value}\n"
    alone = tmp_path / "alone.db"
    alone.write_bytes((study_folder / "mine.db").read_bytes())
    with pytest.raises(touchtrial.Error, match=r"[^\n]*key[^\n]*"):
        touchtrial.read(alone)
    assert touchtrial.read(alone, study_folder / "mine.db.key").report["trials"] == 12


@pytest.mark.parametrize(
    "options",
    [
        {"participants": 0},
        {"participants": 10**6},
        {"seed": -1},
        {"seed": 2**64},
        {"jobs": 0},
        {"jobs": 10**9},
        {"first_participant": 0},
    ],
    ids=repr,
)
def test_impossible_simulations_are_value_errors(study_folder, tmp_path, options):
    with pytest.raises(ValueError, match=r"^[^\n]+$"):
        touchtrial.simulate(study_folder / "mine.json", tmp_path / "x.db", **options)
    assert not (tmp_path / "x.db").exists()


def test_a_bad_study_file_has_the_programs_message(program, tmp_path):
    bad = tmp_path / "bad.json"
    bad.write_text('{"study": "x", "protocl": "classification"}')
    with pytest.raises(touchtrial.Error) as caught:
        touchtrial.simulate(bad, tmp_path / "x.db")
    stderr = program("simulate", bad, "--db", tmp_path / "x.db", fails=True)
    assert stderr == f"touchtrial: {caught.value}\n"


@pytest.mark.parametrize(
    "call",
    [
        lambda db: touchtrial.read(db, key=5),
        lambda db: touchtrial.read(db, passphrase=5),
        lambda db: touchtrial.read(None),
        lambda db: touchtrial.read(f"{db}\0x"),
        lambda db: touchtrial.read(db).trace("a", 1),
        lambda db: touchtrial.read(db).trace(1, 2**40),
        lambda db: touchtrial.simulate(None, "x.db"),
        lambda db: touchtrial.simulate("x.json", 5),
        lambda db: touchtrial.simulate("x.json", "x.db", participants=1.5),
        lambda db: touchtrial.simulate("x.json", "x.db", on=5),
    ],
)
def test_wrong_arguments_are_named_in_one_line(study_folder, call):
    with pytest.raises((TypeError, ValueError), match=r"^\w+: [^\n]+$"):
        call(study_folder / "mine.db")


def test_a_name_that_is_not_utf_8(study_folder, tmp_path):
    odd = tmp_path / os.fsdecode(b"\xff.db")
    shutil.copy(study_folder / "mine.db", odd)
    study = touchtrial.read(odd, study_folder / "mine.db.key")
    assert study.report["participants"] == touchtrial.read(study_folder / "mine.db").report["participants"]


def test_a_protected_key_needs_its_passphrase_in_every_thread(program, study_folder, tmp_path):
    database, key, word = (tmp_path / name for name in ("p.db", "p.db.key", "passphrase"))
    shutil.copy(study_folder / "mine.db", database)
    shutil.copy(study_folder / "mine.db.key", key)
    word.write_text("correct horse")
    word.chmod(0o600)
    program("key", "protect", key, "--new-passphrase-file", word)

    def opens(passphrase):
        try:
            return touchtrial.read(database, key, passphrase=passphrase).report["trials"] == 12
        except touchtrial.Error as error:
            assert "passphrase" in str(error)
            assert passphrase is not None or str(error).endswith("give it as passphrase=")
            return False

    with ThreadPoolExecutor(4) as threads:
        answers = list(threads.map(opens, ["correct horse", None, "wrong horse"] * 4))
    assert answers == [True, False, False] * 4


def test_threads_simulate_one_study(study_folder, tmp_path):
    study = tmp_path / "config" / "mine.json"
    shutil.copytree(study_folder, study.parent, ignore=shutil.ignore_patterns("*.pack", "*.db*"))
    with ThreadPoolExecutor(3) as threads:
        done = list(threads.map(
            lambda n: touchtrial.simulate(study, tmp_path / f"{n}.db", participants=1), range(3)))
    assert [one["sessions"] for one in done] == [1, 1, 1]
