"""The package as such: stubs, docstrings, the manual's examples, the notebook."""

import inspect
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import touchtrial
from conftest import SOURCE


def run_python(*arguments, folder):
    # Debian's pandas has no types.
    (folder / "mypy.ini").write_text("[mypy]\n[mypy-pandas.*]\nignore_missing_imports = True\n")
    environment = {**os.environ, "MYPYPATH": str(SOURCE / "python")}
    return subprocess.run(
        [sys.executable, "-m", *map(str, arguments)],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )


def test_the_version_is_the_programs(program):
    assert program("--version").split()[:2] == ["touchtrial", touchtrial.__version__]


def test_everything_public_says_what_it_does():
    for name in touchtrial.__all__:
        one = getattr(touchtrial, name)
        if name == "__version__":
            continue
        assert inspect.getdoc(one), name
        if not inspect.isclass(one) or one is touchtrial.Error:
            continue
        for member, value in vars(one).items():
            if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                assert inspect.getdoc(value), f"{name}.{member}"


def test_every_key_of_a_study_files_methods_is_an_option():
    schema = json.loads((SOURCE / "config/schema/study.schema.json").read_text())
    keys = set(schema["properties"]["methods"]["items"]["properties"]) - {"name", "label", "lambda"}
    for function in (touchtrial.extract, touchtrial.force_fields):
        assert keys | {"method", "lambda_", "seed"} <= set(inspect.signature(function).parameters)
    keys = set(schema["properties"]["rendering"]["properties"]) - {"device"}
    assert set(touchtrial.force_field(np.zeros((2, 2))).rendering) == keys


def test_types_are_right(tmp_path):
    pytest.importorskip("mypy")
    (tmp_path / "user.py").write_text(
        "import touchtrial\n"
        "texture = touchtrial.extract('a.png', method='fixed', order=0.5).texture\n"
        "reveal_type(touchtrial.force_field(texture).heights)\n"
        "touchtrial.extract('a.png', radios=2)\n"
    )
    # One run reads NumPy's types once; the user's error is the only one.
    user = run_python("mypy", "--strict", SOURCE / "python/touchtrial", "user.py", folder=tmp_path).stdout
    # NumPy spells its 32-bit float in one of these ways, depending on its version.
    assert re.search(r"float32|floating\[numpy\._typing\.(\w+\.)?_32Bit\]", user), user
    assert 'Unexpected keyword argument "radios"' in user
    assert "Found 1 error in 1 file" in user


def test_the_stub_describes_the_native_module(tmp_path):
    pytest.importorskip("mypy")
    # pybind11's classes have a metaclass and a constructor of its own.
    known = tmp_path / "known"
    known.write_text("touchtrial._touchtrial.(Field|Method|Study)(.__init__)?\n")
    done = run_python(
        "mypy.stubtest", "touchtrial._touchtrial", "--mypy-config-file", "mypy.ini",
        "--ignore-missing-stub", "--allowlist", known, folder=tmp_path,
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A folder that looks like the project's, in which examples may write."""
    (tmp_path / "stimuli").symlink_to(SOURCE / "stimuli")
    (tmp_path / "config").mkdir()
    for file in (SOURCE / "config").glob("*.json"):
        (tmp_path / "config" / file.name).symlink_to(file)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_manuals_examples_work_as_they_stand(project):
    blocks = re.findall(r"```python\n(.*?)```", (SOURCE / "docs/python.md").read_text(), re.DOTALL)
    assert len(blocks) >= 4
    names = {}
    for block in blocks:
        exec(compile(block, "docs/python.md", "exec"), names)


def test_the_notebook_runs(project):
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    notebook = nbformat.read(SOURCE / "docs/python.ipynb", as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells), "commit it without outputs"
    done = nbclient.NotebookClient(
        notebook, timeout=300, resources={"metadata": {"path": str(project)}}
    ).execute()
    assert any(cell.get("outputs") for cell in done.cells)


def test_warnings_go_to_pythons_log(tmp_path, caplog):
    """The program warns of a rendering that keeps the paper's step at the surface."""
    (tmp_path / "a.pgm").write_bytes(b"P5\n40 40\n255\n" + bytes(i * 37 % 256 for i in range(1600)))
    (tmp_path / "b.pgm").write_bytes(b"P5\n40 40\n255\n" + bytes(i * 91 % 256 for i in range(1600)))
    (tmp_path / "s.json").write_text(
        '{"study": "s", "protocol": "classification", "classes": ['
        '{"label": "a", "images": ["a.pgm"]}, {"label": "b", "images": ["b.pgm"]}],'
        '"methods": [{"name": "adaptive"}], "rendering": {"reference_grey": 0},'
        '"trials": {"repeats": 1, "explore_limit_s": 5}}'
    )
    touchtrial.simulate(tmp_path / "s.json", tmp_path / "s.db", participants=1)
    assert [record.name for record in caplog.records] == ["touchtrial"] * len(caplog.records)
    assert any("reference_grey" in record.getMessage() for record in caplog.records)
