"""Textures that are felt: Touchtrial's engine and studies, with NumPy arrays.

    >>> import touchtrial
    >>> bark = touchtrial.extract("stimuli/bark.png")
    >>> field = touchtrial.force_field("stimuli/bark.png", rendering={"model": "surface"})
    >>> newtons = touchtrial.render(field, [[20.0, 30.0, -1.0]])
    >>> study = touchtrial.read("study.db")
    >>> study.report["methods"][0]["overall"]["p"]

What is computed is defined in docs/method.md; docs/python.md is the manual of this package.
Functions release Python's global lock while they compute. What a user can cause in files and
databases is a touchtrial.Error with the program's message; a bad argument is a TypeError or
ValueError. Warnings go to the logger "touchtrial".
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
    """A texture and the stages before it, named as the files of `touchtrial extract --dump`.

    A plane that was not wanted, or that the method does not have, is None. Every array owns its
    memory, without a copy, for as long as you keep it.
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
    """The relative gap that was reached (tv-gabor)."""
    steps: int
    """The iterations that were used (tv-gabor)."""
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
        """What `touchtrial report --json` prints."""
        report: Dict[str, Any] = json.loads(self._native.report())
        return report

    @cached_property
    def columns(self) -> Dict[str, Dict[str, Array]]:
        """The tables of `touchtrial export --format csv` by the names of their files, each as its
        columns: int64, float64 (nan where there is nothing), or objects (None where there is
        nothing). docs/data-dictionary.md explains them."""
        return self._native.tables()

    def table(self, name: str) -> "pandas.DataFrame":
        """One of these tables, for instance "deviations", as a data frame."""
        try:
            import pandas
        except ModuleNotFoundError:
            raise ModuleNotFoundError(
                "pandas is not installed (Debian: python3-pandas); `columns` has the same as arrays"
            ) from None
        if name not in self.columns:
            raise KeyError(f"there is no table {name}; choose among {', '.join(self.columns)}")
        return pandas.DataFrame(self.columns[name])

    @cached_property
    def trials(self) -> "pandas.DataFrame":
        """One row for each scored trial: trials.csv."""
        return self.table("trials")

    @cached_property
    def sessions(self) -> "pandas.DataFrame":
        """One row for each session: participants.csv."""
        return self.table("participants")

    @cached_property
    def participants(self) -> "pandas.DataFrame":
        """The last session's row of each participant."""
        return self.sessions.drop_duplicates("participant", keep="last").reset_index(drop=True)

    def trace(self, session: int, trial: int) -> Trace:
        """Position and force of a trial; the numbers are those of the table `trials`."""
        numbers = (
            _whole(name, number, *_INT)
            for name, number in (("session", session), ("trial", trial))
        )
        rate_hz, samples = self._native.trace(*numbers)
        return Trace(rate_hz, samples[:, :3], samples[:, 3:])


_INT = (-(2**31), 2**31 - 1)


def _shown(value: Any) -> str:
    """A value as text for a one-line message."""
    text = " ".join(repr(value).split())
    return text if len(text) <= 60 else text[:57] + "..."


def _whole(name: str, value: Any, low: int, high: int) -> int:
    """A whole number, Python's or NumPy's, within its range."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name}: is {_shown(value)}, must be a whole number") from None
    if not low <= number <= high:
        raise ValueError(f"{name}: is {number}, must be from {low} to {high}")
    return number


def _text(name: str, value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{name}: is {_shown(value)}, must be a text")
    return value


def _path(name: str, value: Any) -> bytes:
    """A path's bytes, because file names need not be UTF-8."""
    try:
        path = os.fsencode(value)
    except TypeError:
        raise TypeError(f"{name}: is {_shown(value)}, must be a path") from None
    if b"\0" in path:
        raise ValueError(f"{name}: has a NUL, which no path can have")
    return path


def _is_masked(array: Any) -> bool:
    return isinstance(array, np.ma.MaskedArray) and bool(np.any(array.mask))


def _image(name: str, value: Any) -> Any:
    """A picture's path or samples for the native functions."""
    if isinstance(value, (str, bytes, os.PathLike)):
        _path(name, value)
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
    """The method's name in study files."""
    if method == "fixed" and order is None:
        raise ValueError("the method fixed needs order, 0 <= order < 1")
    if seed is not None and control in (None, "none"):
        raise ValueError('seed has no effect here; it belongs to control="phase-scrambled"')
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
    given = {key: value for key, value in keys.items() if value is not None}
    for key, value in given.items():
        if not isinstance(value, (str, int, float, tuple, np.generic)):
            raise TypeError(f"{key}: is {_shown(value)}, must be a number or a text")
    return _known_method(0 if seed is None else _whole("seed", seed, 0, 2**64 - 1), **given)


@lru_cache(maxsize=64, typed=True)
def _known_method(seed: int, **keys: Any) -> _touchtrial.Method:
    """Cached, because parsing options takes as long as extracting a small texture."""
    return _touchtrial.Method(_json(keys), seed)


def _json(options: Dict[str, Any]) -> str:
    """JSON text for the study file's reader; accepts NumPy numbers, but no NaN."""
    pairs = options.get("components")
    if isinstance(pairs, tuple):
        options["components"] = [{"frequency": f, "direction": d} for f, d in pairs]
    for key, value in options.items():
        if isinstance(value, (float, np.floating)) and not math.isfinite(value):
            raise ValueError(f"{key}: is {value}, must be finite")
    return json.dumps(options, allow_nan=False, default=_plain)


def _plain(value: Any) -> Any:
    """Converts NumPy numbers to Python's."""
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"an option is {_shown(value)}, must be a number, a text or an object of them")


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
    """The texture of a picture, identical to that of `touchtrial extract --dump`.

    image: a path, or samples (H, W) or (H, W, channels) of uint8 or uint16.
    method: adaptive, fixed, tv-gabor, gaussian, median, edge or luminance. The options after it are
    the keys of a study file's method, with the same defaults; one that the method does not have is
    refused.
    control, seed: "phase-scrambled" turns the texture into its control.
    mapping: of texture_u8: offset, abs or stretch.
    neighbourhood: side of the force's neighbourhood, odd.
    precision: "float" or "double", of all planes but the pictures.
    planes: the planes to keep, by name, or all; texture and image are always there. What no plane
    needs is not computed: planes=() is the fastest.
    """
    if precision not in ("float", "double"):
        raise ValueError(f'precision: is {_shown(precision)}, must be "float" or "double"')
    known = _method(
        method, order, radius, norm, gradient, combine, levels, sigma_px, threshold, divisor,
        lambda_, components, gap, max_steps, control, seed,
    )
    return Extraction(
        **_touchtrial.extract(
            _image("image", image),
            known,
            _text("mapping", mapping),
            _whole("neighbourhood", neighbourhood, *_INT),
            precision == "double",
            None if planes is None else [_text("planes", name) for name in planes],
        )
    )


def order_map(image: Image, **options: Any) -> Array:
    """(H, W): the order of differentiation at each pixel, in [0, 1); `Extraction.order`.

    options: of `extract`, for the methods adaptive and fixed.
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

    sources: each a picture (as of `extract`; its texture is extracted in double precision, as
    studies do), an Extraction, or a texture, which is an array (H, W) of floating-point grey levels.
    rendering: a study file's "rendering" object (docs/study-file.md), with the same defaults.
    The options after it are those of `extract`, for pictures.
    """
    known = _method(
        method, order, radius, norm, gradient, combine, levels, sigma_px, threshold, divisor,
        lambda_, components, gap, max_steps, control, seed,
    )
    textures = [
        one.texture if isinstance(one, Extraction) else _image("source", one) for one in sources
    ]
    options = (
        order, radius, norm, gradient, combine, levels, sigma_px, threshold, divisor, lambda_,
        components, gap, max_steps, control, seed,
    )
    is_asked = method != "adaptive" or any(option is not None for option in options)
    if is_asked and not any(_is_picture(texture) for texture in textures):
        raise ValueError("method and its options have no effect: every source is a texture already")
    return _touchtrial.force_fields(textures, known, _json(dict(rendering or {})))


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
    """(N, 3) newtons: the force on a stylus along a path, by the servo's rendering model.

    path_mm: (N, 3), x and y from the plane's top-left corner, z out of the plane; depth is -z.
    dt_s: the time between two positions, from which velocities follow by backward differences (the
    first is 0). Or velocities_mm_s: (N, 3). Without either the hand counts as still, which matters
    if the wall has damping. Friction carries over from position to position. A position or velocity
    that is not finite gives no force.
    """
    if not isinstance(field, Field):
        raise TypeError(f"field: is {_shown(field)}, must be a Field, as force_field makes it")
    if dt_s is not None and not isinstance(dt_s, (int, float, np.integer, np.floating)):
        raise TypeError(f"dt_s: is {_shown(dt_s)}, must be a number")
    for name, points in (("path_mm", path_mm), ("velocities_mm_s", velocities_mm_s)):
        if _is_masked(points):
            raise ValueError(f"{name}: has masked points, which would count; fill them with .filled()")
    return _touchtrial.render(field, path_mm, dt_s, velocities_mm_s)


def evaluate(*images: Image, sweep: bool = False) -> Dict[str, Any]:
    """Entropy and co-occurrence statistics of pictures and their adaptive textures.

    sweep: also the order sweep with MS-SSIM.
    Returns what `touchtrial evaluate --json` prints; docs/data-dictionary.md explains it. A picture
    that is no file is called "array 0", by its place.
    """
    if not isinstance(sweep, (bool, np.bool_)):
        raise TypeError(f"sweep: is {_shown(sweep)}, must be True or False")
    pictures = [_image(f"array {place}", one) for place, one in enumerate(images)]
    evaluation: Dict[str, Any] = json.loads(_touchtrial.evaluate(pictures, bool(sweep)))
    return evaluation


def read(db: Path, key: Optional[Path] = None, *, passphrase: Optional[str] = None) -> Study:
    """Opens an unblinded study: a database file.

    key: the study's key, by default DB.key or the one that was named last time.
    passphrase: of a protected key.
    Raises touchtrial.Error if the study is not unblinded, or its evidence does not hold.
    """
    if passphrase is not None:
        _text("passphrase", passphrase)
    place = _path("db", db)
    try:
        return Study(_touchtrial.read(place, b"" if key is None else _path("key", key), passphrase))
    except Error as error:
        what, option, _ = str(error).partition("--passphrase-file")
        if not option:
            raise
        raise Error(what.rpartition("; ")[0] + "; give it as passphrase=") from None


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

    study: its file. db: the database to make; its key is written to DB.key.
    subject: a subject model, by default the program's. on: what simulated hands hold.
    jobs: threads, by default one for each core; results do not depend on them.
    keep_blind: neither close nor unblind the study at the end.
    Returns what `touchtrial simulate --json` prints.
    """
    summary: Dict[str, Any] = json.loads(
        _touchtrial.simulate(
            _path("study", study),
            _path("db", db),
            _whole("participants", participants, 1, 100_000),
            _whole("seed", seed, 0, 2**64 - 1),
            b"" if subject is None else _path("subject", subject),
            "" if on is None else _text("on", on),
            0 if jobs is None else _whole("jobs", jobs, 1, 1024),
            _whole("first_participant", first_participant, 1, 1_000_000),
            bool(keep_blind),
        )
    )
    return summary
