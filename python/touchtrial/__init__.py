"""Textures that are felt: Touchtrial's engine and studies, with NumPy arrays.

    >>> import touchtrial
    >>> bark = touchtrial.extract("stimuli/bark.png")
    >>> field = touchtrial.force_field("stimuli/bark.png", rendering={"model": "surface"})
    >>> newtons = touchtrial.render(field, [[20.0, 30.0, -1.0]])
    >>> study = touchtrial.read("study.db")
    >>> study.report["methods"][0]["overall"]["p"]

docs/method.md defines the computations; docs/python.md is the manual of this package. Functions
release Python's global lock while they compute. Invalid files and databases raise
touchtrial.Error with the program's message; bad arguments raise TypeError or ValueError. Warnings
go to the logger "touchtrial".
"""

from __future__ import annotations

import json
import math
import operator
import os
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any, Dict, Iterable, List, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _touchtrial
from ._touchtrial import Error, Field, __version__

if TYPE_CHECKING:
    import pandas

    Array = npt.NDArray[Any]
    Path = Union[str, "os.PathLike[str]"]
    Image = Union[Path, npt.ArrayLike]
    Components = Union[str, Sequence[Tuple[float, float]]]

__all__ = [
    "Error",
    "Extraction",
    "Field",
    "Study",
    "Trace",
    "__version__",
    "evaluate",
    "extract",
    "force_field",
    "force_fields",
    "order_map",
    "read",
    "render",
    "simulate",
]


@dataclass(eq=False)
class Extraction:
    """A texture and the stages before it, named like the files of `touchtrial extract --dump`.

    A plane that was not requested, or that the method lacks, is None. Every array owns its memory,
    without a copy.
    """

    image: Array
    """(H, W) uint8: the picture as grey levels."""
    texture: Array
    """(H, W): the texture T (for tv-gabor v), grey levels."""
    subband_LL: Optional[Array]
    """(ceil(H/2), ceil(W/2)): the first letter is the filter along x (adaptive)."""
    subband_LH: Optional[Array]
    subband_HL: Optional[Array]
    subband_HH: Optional[Array]
    csgv: Optional[Array]
    """(H, W): the slope of the picture over all sub-bands (adaptive)."""
    order: Optional[Array]
    """(H, W): the order of differentiation, in [0, 1) (adaptive, fixed)."""
    enhanced: Optional[Array]
    """(H, W): picture plus texture."""
    cartoon: Optional[Array]
    """(H, W): picture minus texture (tv-gabor)."""
    texture_u8: Optional[Array]
    """(H, W) uint8: the texture as a picture."""
    force_x: Optional[Array]
    """(H, W): the tangential force to the right, grey levels per pixel."""
    force_y: Optional[Array]
    """(H, W): the tangential force downwards in the picture, grey levels per pixel."""
    components: List[Tuple[float, float]]
    """Cycles per pixel and degrees of the oscillations used (tv-gabor)."""
    gap: float
    """The relative gap reached (tv-gabor)."""
    steps: int
    """The number of iterations (tv-gabor)."""
    converged: bool
    """False if tv-gabor stopped at max_steps."""

    @cached_property
    def force_tangential(self) -> Optional[Array]:
        """(H, W, 2): force_x and force_y in one array, which is a copy."""
        if self.force_x is None or self.force_y is None:
            return None
        return np.stack((self.force_x, self.force_y), axis=-1)


@dataclass(eq=False)
class Trace:
    """Position and force of a trial, sampled evenly from the moment the plane could be felt."""

    rate_hz: float
    position_mm: Array
    """(N, 3): x and y from the plane's top-left corner, z out of the plane."""
    force_n: Array
    """(N, 3): as sent to the device."""

    @cached_property
    def time_s(self) -> Array:
        """(N,): the time of each sample."""
        return np.arange(len(self.position_mm)) / self.rate_hz


class Study:
    """An unblinded study; `read` opens it."""

    def __init__(self, native: _touchtrial.Study) -> None:
        self._native = native

    def __repr__(self) -> str:
        stamp = " SIMULATED" if self.simulated else ""
        return f"<touchtrial.Study {self.name!r}{stamp}>"

    @property
    def name(self) -> str:
        """The study's name."""
        return self._native.name

    @property
    def simulated(self) -> bool:
        """Whether the participants were simulated."""
        return self._native.simulated

    @cached_property
    def report(self) -> Dict[str, Any]:
        """The output of `touchtrial report --json`."""
        report: Dict[str, Any] = json.loads(self._native.report())
        return report

    @cached_property
    def columns(self) -> Dict[str, Dict[str, Array]]:
        """The tables of `touchtrial export --format csv` by file name, each as its columns: int64,
        float64 (missing values: nan), or objects (missing values: None). docs/data-dictionary.md
        explains them."""
        return self._native.tables()

    def table(self, name: str) -> "pandas.DataFrame":
        """One of these tables, for instance "deviations", as a data frame."""
        try:
            import pandas
        except ModuleNotFoundError:
            raise ModuleNotFoundError(
                "pandas is not installed (Debian: python3-pandas); `columns` has the same data as arrays"
            ) from None
        if name not in self.columns:
            raise KeyError(f"there is no table {name}; choose among {', '.join(self.columns)}")
        return pandas.DataFrame(self.columns[name])

    @cached_property
    def trials(self) -> "pandas.DataFrame":
        """One row per scored trial: trials.csv."""
        return self.table("trials")

    @cached_property
    def sessions(self) -> "pandas.DataFrame":
        """One row per session: participants.csv."""
        return self.table("participants")

    @cached_property
    def participants(self) -> "pandas.DataFrame":
        """One row per participant, from the last session."""
        return self.sessions.drop_duplicates("participant", keep="last").reset_index(drop=True)

    def trace(self, session: int, trial: int) -> Trace:
        """Position and force of a trial, numbered as in the table `trials`."""
        numbers = (
            _check_int(name, number, *_INT)
            for name, number in (("session", session), ("trial", trial))
        )
        rate_hz, samples = self._native.trace(*numbers)
        return Trace(rate_hz, samples[:, :3], samples[:, 3:])


_INT = (-(2**31), 2**31 - 1)


def _short_repr(value: Any) -> str:
    """Formats a value for a one-line message."""
    text = " ".join(repr(value).split())
    return text if len(text) <= 60 else text[:57] + "..."


def _check_int(name: str, value: Any, low: int, high: int) -> int:
    """Checks a whole number, Python's or NumPy's, and its range."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name}: is {_short_repr(value)}, must be a whole number") from None
    if not low <= number <= high:
        raise ValueError(f"{name}: is {number}, must be from {low} to {high}")
    return number


def _check_text(name: str, value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{name}: is {_short_repr(value)}, must be a string")
    return value


def _path_bytes(name: str, value: Any) -> bytes:
    """Converts a path to bytes, because file names need not be UTF-8."""
    try:
        path = os.fsencode(value)
    except TypeError:
        raise TypeError(f"{name}: is {_short_repr(value)}, must be a path") from None
    if b"\0" in path:
        raise ValueError(f"{name}: contains a NUL, which paths cannot contain")
    return path


def _is_masked(array: Any) -> bool:
    return isinstance(array, np.ma.MaskedArray) and bool(np.any(array.mask))


def _check_image(name: str, value: Any) -> Any:
    """A picture's path or samples for the native functions."""
    if isinstance(value, (str, bytes, os.PathLike)):
        _path_bytes(name, value)
        return value if isinstance(value, (str, bytes)) else os.fspath(value)
    if _is_masked(value):
        raise ValueError(f"{name}: has masked samples, which would count; fill them with .filled()")
    return value


def _is_picture(source: Any) -> bool:
    """Whether a field's source is a picture, which has to be extracted first."""
    return isinstance(source, (str, bytes, os.PathLike)) or np.asarray(source).dtype.kind == "u"


def _method(
    method: str,
    order: Optional[float],
    radius: Optional[int],
    norm: Optional[str],
    gradient: Optional[str],
    combine: Optional[str],
    levels: Optional[int],
    sigma_px: Optional[float],
    threshold: Optional[float],
    divisor: Optional[float],
    lambda_: Optional[float],
    components: Optional[Components],
    gap: Optional[float],
    max_steps: Optional[int],
    control: Optional[str],
    seed: Optional[int],
) -> _touchtrial.Method:
    """Builds a native method from the options of `extract`."""
    if method == "fixed" and order is None:
        raise ValueError("the method fixed needs order, 0 <= order < 1")
    if seed is not None and control in (None, "none"):
        raise ValueError('seed has no effect here; it applies to control="phase-scrambled"')
    if components is not None and not isinstance(components, str):
        try:
            pairs = np.asarray(components, dtype=float)
        except (TypeError, ValueError):
            pairs = np.empty(0)
        if pairs.ndim != 2 or pairs.shape[1] != 2:
            raise ValueError('components: give "auto" or pairs of cycles per pixel and degrees')
        components = tuple((float(f), float(d)) for f, d in pairs)
    keys = {
        "name": method,
        "order": order,
        "radius": radius,
        "norm": norm,
        "gradient": gradient,
        "combine": combine,
        "levels": levels,
        "sigma_px": sigma_px,
        "threshold": threshold,
        "divisor": divisor,
        "lambda": lambda_,
        "components": components,
        "gap": gap,
        "max_steps": max_steps,
        "control": control,
    }
    options = {key: value for key, value in keys.items() if value is not None}
    for key, value in options.items():
        if not isinstance(value, (str, int, float, tuple, np.generic)):
            raise TypeError(f"{key}: is {_short_repr(value)}, must be a number or a string")
    return _parse_method(0 if seed is None else _check_int("seed", seed, 0, 2**64 - 1), **options)


@lru_cache(maxsize=64, typed=True)
def _parse_method(seed: int, **keys: Any) -> _touchtrial.Method:
    """Cached, because parsing options takes as long as extracting a small texture."""
    return _touchtrial.Method(_json_text(keys), seed)


def _json_text(options: Dict[str, Any]) -> str:
    """JSON text for the study file's reader; accepts NumPy numbers, but no NaN."""
    pairs = options.get("components")
    if isinstance(pairs, tuple):
        options["components"] = [{"frequency": f, "direction": d} for f, d in pairs]
    for key, value in options.items():
        if isinstance(value, (float, np.floating)) and not math.isfinite(value):
            raise ValueError(f"{key}: is {value}, must be finite")
    return json.dumps(options, allow_nan=False, default=_python_number)


def _python_number(value: Any) -> Any:
    """Converts NumPy numbers to Python's."""
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"an option is {_short_repr(value)}, must be a number, a string or an object of them")


def extract(
    image: Image,
    *,
    method: str = "adaptive",
    order: Optional[float] = None,
    radius: Optional[int] = None,
    norm: Optional[str] = None,
    gradient: Optional[str] = None,
    combine: Optional[str] = None,
    levels: Optional[int] = None,
    sigma_px: Optional[float] = None,
    threshold: Optional[float] = None,
    divisor: Optional[float] = None,
    lambda_: Optional[float] = None,
    components: Optional[Components] = None,
    gap: Optional[float] = None,
    max_steps: Optional[int] = None,
    control: Optional[str] = None,
    seed: Optional[int] = None,
    mapping: str = "offset",
    neighbourhood: int = 3,
    precision: str = "float",
    planes: Optional[Iterable[str]] = None,
) -> Extraction:
    """Extracts the texture of a picture, identical to that of `touchtrial extract --dump`.

    image: a path, or samples (H, W) or (H, W, channels) of uint8 or uint16.
    method: adaptive, fixed, tv-gabor, gaussian, median, edge or luminance. The options after it are
    the keys of a study file's method, with the same defaults; options that the method lacks are
    refused.
    control, seed: "phase-scrambled" replaces the texture with a control.
    mapping: how texture_u8 is made: offset, abs or stretch.
    neighbourhood: side of the force's neighbourhood, odd.
    precision: "float" or "double", for all planes except the pictures.
    planes: names of the planes to return, by default all; texture and image are always included.
    Only what these need is computed: planes=() is the fastest.
    """
    if precision not in ("float", "double"):
        raise ValueError(f'precision: is {_short_repr(precision)}, must be "float" or "double"')
    native_method = _method(
        method, order, radius, norm, gradient, combine, levels, sigma_px, threshold, divisor,
        lambda_, components, gap, max_steps, control, seed,
    )
    return Extraction(
        **_touchtrial.extract(
            _check_image("image", image),
            native_method,
            _check_text("mapping", mapping),
            _check_int("neighbourhood", neighbourhood, *_INT),
            precision == "double",
            None if planes is None else [_check_text("planes", name) for name in planes],
        )
    )


def order_map(image: Image, **options: Any) -> Array:
    """(H, W): the order of differentiation at each pixel, in [0, 1); `Extraction.order`.

    options: those of `extract`, for the methods adaptive and fixed.
    """
    order = extract(image, planes=("order",), **options).order
    if order is None:
        raise ValueError(f"the method {options['method']} has no orders; use adaptive or fixed")
    return order


def force_fields(
    sources: Iterable[Union[Image, Extraction]],
    *,
    rendering: Optional[Dict[str, Any]] = None,
    method: str = "adaptive",
    order: Optional[float] = None,
    radius: Optional[int] = None,
    norm: Optional[str] = None,
    gradient: Optional[str] = None,
    combine: Optional[str] = None,
    levels: Optional[int] = None,
    sigma_px: Optional[float] = None,
    threshold: Optional[float] = None,
    divisor: Optional[float] = None,
    lambda_: Optional[float] = None,
    components: Optional[Components] = None,
    gap: Optional[float] = None,
    max_steps: Optional[int] = None,
    control: Optional[str] = None,
    seed: Optional[int] = None,
) -> List[Field]:
    """The force fields of several textures with common gains, like a study's stimuli.

    sources: each a picture as in `extract` (its texture is extracted in double precision, as in
    studies), an Extraction, or a texture, which is an array (H, W) of floating-point grey levels.
    rendering: a study file's "rendering" object (docs/study-file.md), with the same defaults.
    The other options are those of `extract`, for pictures.
    """
    native_method = _method(
        method, order, radius, norm, gradient, combine, levels, sigma_px, threshold, divisor,
        lambda_, components, gap, max_steps, control, seed,
    )
    textures = [
        source.texture if isinstance(source, Extraction) else _check_image("source", source)
        for source in sources
    ]
    options = (
        order, radius, norm, gradient, combine, levels, sigma_px, threshold, divisor, lambda_,
        components, gap, max_steps, control, seed,
    )
    has_options = method != "adaptive" or any(option is not None for option in options)
    if has_options and not any(_is_picture(texture) for texture in textures):
        raise ValueError("method and its options have no effect: every source is a texture already")
    return _touchtrial.force_fields(textures, native_method, _json_text(dict(rendering or {})))


def force_field(
    source: Union[Image, Extraction],
    *,
    rendering: Optional[Dict[str, Any]] = None,
    **options: Any,
) -> Field:
    """The force field of one texture: `force_fields` with a single source."""
    return force_fields([source], rendering=rendering, **options)[0]


def render(
    field: Field,
    path_mm: npt.ArrayLike,
    dt_s: Optional[float] = None,
    velocities_mm_s: Optional[npt.ArrayLike] = None,
) -> Array:
    """Computes the force on a stylus along a path, (N, 3) newtons, by the servo's rendering model.

    path_mm: (N, 3), x and y from the plane's top-left corner, z out of the plane; depth is -z.
    dt_s: the time between two positions, for velocities by backward differences (the first is 0).
    velocities_mm_s: (N, 3), instead of dt_s. Without either, velocities are 0, which matters if the
    wall has damping. Friction carries over from position to position. Positions and velocities that
    are not finite give no force.
    """
    if not isinstance(field, Field):
        raise TypeError(f"field: is {_short_repr(field)}, must be a Field from force_field or force_fields")
    if dt_s is not None and not isinstance(dt_s, (int, float, np.integer, np.floating)):
        raise TypeError(f"dt_s: is {_short_repr(dt_s)}, must be a number")
    for name, points in (("path_mm", path_mm), ("velocities_mm_s", velocities_mm_s)):
        if _is_masked(points):
            raise ValueError(f"{name}: has masked points, which would count; fill them with .filled()")
    return _touchtrial.render(field, path_mm, dt_s, velocities_mm_s)


def evaluate(*images: Image, sweep: bool = False) -> Dict[str, Any]:
    """Entropy and co-occurrence statistics of pictures and their adaptive textures.

    sweep: whether to add the order sweep with MS-SSIM.
    Returns the output of `touchtrial evaluate --json`; docs/data-dictionary.md explains it. An array
    is named by its index, for instance "array 0".
    """
    if not isinstance(sweep, (bool, np.bool_)):
        raise TypeError(f"sweep: is {_short_repr(sweep)}, must be True or False")
    pictures = [_check_image(f"array {index}", image) for index, image in enumerate(images)]
    evaluation: Dict[str, Any] = json.loads(_touchtrial.evaluate(pictures, bool(sweep)))
    return evaluation


def read(db: Path, key: Optional[Path] = None, *, passphrase: Optional[str] = None) -> Study:
    """Opens an unblinded study: a database file.

    key: the study's key, by default DB.key or the one used last.
    passphrase: the passphrase of a protected key.
    Raises touchtrial.Error if the study is not unblinded or fails verification.
    """
    if passphrase is not None:
        _check_text("passphrase", passphrase)
    database = _path_bytes("db", db)
    try:
        return Study(_touchtrial.read(database, b"" if key is None else _path_bytes("key", key), passphrase))
    except Error as error:
        message, option, _ = str(error).partition("--passphrase-file")
        if not option:
            raise
        raise Error(message.rpartition("; ")[0] + "; give it as passphrase=") from None


def simulate(
    study: Path,
    db: Path,
    *,
    participants: int = 20,
    seed: int = 1,
    subject: Optional[Path] = None,
    on: Optional[str] = None,
    jobs: Optional[int] = None,
    first_participant: int = 1,
    keep_blind: bool = False,
) -> Dict[str, Any]:
    """Runs a whole study with simulated participants, in virtual time; `read` then opens it.

    study: the study file. db: the database to create; its key is written to DB.key.
    subject: a subject model, by default the built-in one. on: the device of the simulated hands.
    jobs: threads, by default one per core; results do not depend on their number.
    keep_blind: neither close nor unblind the study at the end.
    Returns the output of `touchtrial simulate --json`.
    """
    summary: Dict[str, Any] = json.loads(
        _touchtrial.simulate(
            _path_bytes("study", study),
            _path_bytes("db", db),
            _check_int("participants", participants, 1, 100_000),
            _check_int("seed", seed, 0, 2**64 - 1),
            b"" if subject is None else _path_bytes("subject", subject),
            "" if on is None else _check_text("on", on),
            0 if jobs is None else _check_int("jobs", jobs, 1, 1024),
            _check_int("first_participant", first_participant, 1, 1_000_000),
            bool(keep_blind),
        )
    )
    return summary
