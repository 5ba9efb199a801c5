"""What the tests of the Python module share: pictures, the program, and a small simulated study."""

import json
import os
import subprocess
import tempfile
from pathlib import Path

import numpy as np
import pytest

SOURCE = Path(__file__).resolve().parents[2]

# Neither the module nor the program nor Jupyter leaves anything in the user's home.
HOME = tempfile.TemporaryDirectory()
for variable in ("XDG_CONFIG_HOME", "XDG_CACHE_HOME", "JUPYTER_RUNTIME_DIR", "IPYTHONDIR"):
    os.environ[variable] = str(Path(HOME.name) / variable.lower())


def write_pnm(path, samples):
    """A PGM or PPM file; uint16 samples are big-endian there."""
    samples = np.asarray(samples)
    kind = "P6" if samples.ndim == 3 else "P5"
    most = 255 if samples.dtype == np.uint8 else 65535
    header = f"{kind}\n{samples.shape[1]} {samples.shape[0]}\n{most}\n".encode()
    path.write_bytes(header + samples.astype(samples.dtype.newbyteorder(">")).tobytes())
    return path


def rough_picture(height, width, seed=1, grain=1.5):
    """Smooth shapes and grain, so that every branch of the order map occurs."""
    random = np.random.default_rng(seed)
    y, x = np.mgrid[:height, :width]
    waves = 128 + 60 * np.sin(x / (3.0 + seed)) * np.cos(y / 5.0) + 40 * (x > width / 2)
    waves[: height // 3, : width // 3] = 90
    noisy = waves + random.normal(0, grain, waves.shape) * (waves != 90)
    return np.clip(np.floor(noisy + 0.5), 0, 255).astype(np.uint8)


@pytest.fixture(scope="session")
def program():
    def run(*arguments, fails=False):
        done = subprocess.run(
            [os.environ["TOUCHTRIAL_PROGRAM"], *map(str, arguments)],
            capture_output=True,
            text=True,
            check=False,
        )
        assert (done.returncode != 0) == fails, done.stderr
        return done.stderr if fails else done.stdout

    return run


@pytest.fixture(scope="session")
def study_folder(tmp_path_factory, program):
    """mine.json with three classes, and mine.db of two simulated participants."""
    folder = tmp_path_factory.mktemp("study")
    classes = []
    for seed, label in enumerate(("ripple", "weave", "grit"), start=1):
        write_pnm(folder / f"{label}.pgm", rough_picture(60, 60, seed, grain=4.0 * seed))
        classes.append({"label": label, "images": [f"{label}.pgm"]})
    study = {
        "study": "mine",
        "protocol": "classification",
        "classes": classes,
        "methods": [{"name": "adaptive"}],
        "rendering": {"pitch_mm": 1.0},
        "trials": {"repeats": 2, "explore_limit_s": 20},
        "seed": 7,
    }
    (folder / "mine.json").write_text(json.dumps(study))
    program(
        "simulate", folder / "mine.json", "--participants", 2, "--seed", 3, "--db", folder / "mine.db"
    )
    return folder
