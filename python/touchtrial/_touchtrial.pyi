"""The native part of touchtrial; use the package."""

import os
from typing import Any, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

_Path = Union[str, bytes, "os.PathLike[str]"]

__version__: str

class Error(Exception):
    """An error that a user can cause: one line with the cause, the place and the remedy."""

class Method:
    """An extraction method and its options."""

    def __init__(self, method: str, seed: int) -> None:
        """method: JSON, as in a study file's "methods"."""

class Field:
    """A texture on the virtual plane, with the gains from grey levels to newtons."""

    @property
    def heights(self) -> npt.NDArray[np.float32]:
        """(H, W), read-only and without a copy: for the model paper the filtered texture, for
        surface the coefficients of its spline; grey levels."""
    @property
    def shape(self) -> Tuple[int, int]:
        """Height and width, pixels."""
    @property
    def size_mm(self) -> Tuple[float, float]:
        """Height and width of the textured plane, mm."""
    @property
    def pitch_mm(self) -> float:
        """Millimetres per pixel."""
    @property
    def rendering(self) -> Dict[str, Any]:
        """All rendering options."""
    @property
    def gains(self) -> Dict[str, float]:
        """tangential_n and normal_n (paper) or height_mm (surface) per grey level; the others are
        0."""
    @property
    def over_budget(self) -> bool:
        """Whether explicit gains exceed the stiffness budget."""
    def lateral_force(self) -> npt.NDArray[np.float64]:
        """(H, W, 2) newtons at the pixels' centres, x then y, before the force limit is applied; for
        surface at a load of 0.7 N."""
    def statistics(self) -> Dict[str, Any]:
        """Numbers that predict how the field feels; docs/method.md defines them."""

class Study:
    """An unblinded study, opened for reading."""

    @property
    def name(self) -> str: ...
    @property
    def simulated(self) -> bool: ...
    def report(self) -> str:
        """The text that `touchtrial report --json` prints."""
    def tables(self) -> Dict[str, Dict[str, npt.NDArray[Any]]]:
        """Columns by table and name, as in `export --format csv`."""
    def trace(self, session: int, trial: int) -> Tuple[float, npt.NDArray[np.float64]]:
        """The rate in Hz, and (N, 6) positions in mm and forces in N."""

def extract(
    image: Any,
    method: Method,
    mapping: str,
    neighbourhood: int,
    in_double: bool,
    planes: Optional[Sequence[str]],
) -> Dict[str, Any]:
    """The planes of an extraction by name; each is an array that owns its memory, or None."""

def _seconds_of_extraction(image: Any, all_planes: bool) -> float:
    """Times the C++ call, for the benchmark."""

def evaluate(images: Sequence[Any], sweep: bool) -> str:
    """The text that `touchtrial evaluate --json` prints."""

def force_fields(sources: Sequence[Any], method: Method, rendering: str) -> List[Field]:
    """Fields of images or textures with common gains."""

def render(
    field: Field,
    path_mm: npt.ArrayLike,
    dt_s: Optional[float] = None,
    velocities_mm_s: Optional[npt.ArrayLike] = None,
) -> npt.NDArray[np.float64]:
    """The force on a stylus along a path, (N, 3) newtons, by the servo's rendering model."""

def read(database: _Path, key: _Path, passphrase: Optional[str]) -> Study:
    """Opens an unblinded study."""

def simulate(
    study: _Path,
    database: _Path,
    participants: int,
    seed: int,
    subject: _Path,
    on: str,
    jobs: int,
    first_participant: int,
    keep_blind: bool,
) -> str:
    """The text that `touchtrial simulate --json` prints."""
