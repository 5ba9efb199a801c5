"""extract and order_map: to the bit as the program, and near what others compute."""

import gc
import itertools
import json
import threading

import numpy as np
import pytest
import touchtrial
from conftest import rough_picture, write_pnm

METHODS = {
    "adaptive": {},
    "fixed": {"order": 0.35},
    "tv-gabor": {},
    "gaussian": {},
    "median": {},
    "edge": {},
    "luminance": {},
}
PLANES = (
    "image subband_LL subband_LH subband_HL subband_HH csgv order texture enhanced cartoon "
    "texture_u8 force_tangential"
).split()


def options_of_command(options):
    names = {"lambda_": "--lambda", "sigma_px": "--sigma"}
    for key, value in options.items():
        if key == "components" and not isinstance(value, str):
            value = ";".join(f"{frequency},{degrees}" for frequency, degrees in value)
        yield names.get(key, "--" + key.replace("_", "-"))
        yield str(value)


def same_bits(a, b):
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def check_against_dump(program, folder, picture, **options):
    """\\return the names of the planes that there are"""
    path = write_pnm(folder / "picture.pgm", picture)
    dump = folder / "dump"
    program("extract", path, "--dump", dump, *options_of_command(options))
    written = {file.stem: np.load(file) for file in dump.glob("*.npy")}
    for source in (path, picture):
        extraction = touchtrial.extract(source, **options)
        ours = {name: getattr(extraction, name) for name in PLANES}
        assert {name for name, plane in ours.items() if plane is not None} == set(written)
        for name, plane in written.items():
            assert same_bits(ours[name], plane), name
    return set(written)


@pytest.mark.parametrize("precision", ["float", "double"])
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("shape", [(37, 53), (64, 31), (3, 4)])
def test_every_plane_has_the_bits_of_the_dump(program, tmp_path, method, precision, shape):
    planes = check_against_dump(
        program, tmp_path, rough_picture(*shape), method=method, precision=precision, **METHODS[method]
    )
    assert ("csgv" in planes) == (method == "adaptive")
    assert ("cartoon" in planes) == (method == "tv-gabor")


@pytest.mark.parametrize(
    "options",
    [
        {"radius": 5, "norm": "sum", "gradient": "central", "combine": "l2", "levels": 2},
        {"norm": "none", "gradient": "prewitt", "combine": "max"},
        {"method": "fixed", "order": 0.0, "radius": 1},
        {"method": "tv-gabor", "lambda_": 0.1, "components": [(0.2, 30.0), (0.4, 90.0)]},
        {"method": "tv-gabor", "components": "auto"},
        {"method": "gaussian", "sigma_px": 0.7},
        {"method": "median", "threshold": 1.5, "radius": 3},
        {"method": "edge", "divisor": 2.0},
        {"control": "phase-scrambled", "seed": 18446744073709551615},
        {"mapping": "stretch", "neighbourhood": 5},
        {"mapping": "abs", "neighbourhood": 9, "precision": "double"},
    ],
)
def test_every_option_has_the_effect_of_the_programs(program, tmp_path, options):
    check_against_dump(program, tmp_path, rough_picture(29, 34), **options)


def test_one_pixel_and_a_flat_picture_have_a_texture_of_zero(program, tmp_path):
    for picture in (np.full((1, 1), 9, np.uint8), np.full((5, 8), 200, np.uint8)):
        check_against_dump(program, tmp_path, picture)
        assert not touchtrial.extract(picture).texture.any()


def test_samples_become_grey_as_those_of_files_do(tmp_path):
    random = np.random.default_rng(5)
    for dtype, shape in itertools.product((np.uint8, np.uint16), ((13, 9), (13, 9, 3))):
        samples = random.integers(0, np.iinfo(dtype).max, shape, dtype, endpoint=True)
        from_file = touchtrial.extract(write_pnm(tmp_path / "a.pnm", samples), planes=()).image
        variants = {
            "C": samples,
            "Fortran": np.asfortranarray(samples),
            "byte-swapped": samples.astype(samples.dtype.newbyteorder()),
            "strided": np.repeat(samples, 2, axis=1)[:, ::2],
            "upside down": samples[::-1].copy()[::-1],
        }
        for name, variant in variants.items():
            assert same_bits(touchtrial.extract(variant, planes=()).image, from_file), name


def test_alpha_is_composited_on_black():
    picture = np.zeros((2, 2, 4), np.uint8)
    picture[..., :3] = 200
    picture[0, 0, 3] = 255
    picture[0, 1, 3] = 51
    assert touchtrial.extract(picture, planes=()).image.tolist() == [[200, 40], [0, 0]]
    grey = np.stack([picture[..., 0], picture[..., 3]], axis=-1)
    assert touchtrial.extract(grey, planes=()).image.tolist() == [[200, 40], [0, 0]]


def test_only_wanted_planes_are_there():
    extraction = touchtrial.extract(rough_picture(20, 20), planes=["order", "texture_u8"])
    there = {name for name in PLANES if getattr(extraction, name) is not None}
    assert there == {"image", "texture", "order", "texture_u8"}


def test_arrays_own_their_planes_without_a_copy_and_outlive_everything_else():
    picture = rough_picture(200, 300)
    extraction = touchtrial.extract(picture)
    for name in PLANES[:-1]:
        plane = getattr(extraction, name)
        if plane is None:
            continue
        assert type(plane.base).__name__ == "PyCapsule", name
        assert plane.flags.writeable and plane.flags.c_contiguous and plane.flags.aligned
    kept = extraction.texture[5:, ::2]
    before = kept.copy()
    picture[:] = 0
    del extraction, picture
    gc.collect()
    for _ in range(20):
        touchtrial.extract(rough_picture(200, 300, seed=2))
    assert same_bits(kept.copy(), before)


def test_the_picture_is_read_before_the_call_ends():
    picture = rough_picture(64, 64)
    extraction = touchtrial.extract(picture)
    assert not np.shares_memory(extraction.image, picture)
    assert (extraction.image == picture).all()


def test_threads_get_the_same_bits():
    pictures = [rough_picture(101, 99, seed) for seed in range(1, 9)]
    alone = [touchtrial.extract(picture).texture for picture in pictures]
    together = [None] * len(pictures)

    def work(i):
        together[i] = touchtrial.extract(pictures[i]).texture

    threads = [threading.Thread(target=work, args=(i,)) for i in range(len(pictures))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(map(same_bits, alone, together))


def test_sub_bands_are_those_of_pywavelets():
    pywt = pytest.importorskip("pywt")
    picture = rough_picture(38, 54)
    extraction = touchtrial.extract(picture, precision="double")
    # PyWavelets' symmetric mode has one coefficient more at the beginning.
    ll, (lh, hl, hh) = pywt.dwt2(picture.astype(float), "db2", mode="symmetric")
    for ours, theirs in (
        (extraction.subband_LL, ll),
        (extraction.subband_LH, lh),
        (extraction.subband_HL, hl),
        (extraction.subband_HH, hh),
    ):
        theirs = theirs[1:, 1:]
        assert ours.shape == theirs.shape
        np.testing.assert_allclose(np.abs(ours), np.abs(theirs), atol=1e-10)


def slow_order_map(picture):
    """docs/method.md, "Sub-bands" and "Gradient and order map", word by word."""
    s = np.sqrt(3.0)
    h = np.array([1 + s, 3 + s, 3 - s, 1 - s]) / (4 * np.sqrt(2))
    g = np.array([h[3], -h[2], h[1], -h[0]])

    def filtered(x, taps):  # along the first axis
        count = (len(x) + 1) // 2
        padded = np.pad(x, [(0, 4), (0, 0)], mode="symmetric")
        return sum(taps[m] * padded[m : m + 2 * count : 2][:count] for m in range(4))

    def magnitude(band):
        p = np.pad(band, 1, mode="symmetric")
        across = p[:, 2:] - p[:, :-2]
        gx = across[:-2] + 2 * across[1:-1] + across[2:]
        along = p[2:] - p[:-2]
        gy = along[:, :-2] + 2 * along[:, 1:-1] + along[:, 2:]
        return np.hypot(gx, gy)

    x = picture.astype(float)
    bands = [filtered(filtered(x, a).T, b).T for a in (h, g) for b in (h, g)]
    csgv = sum(magnitude(band) for band in bands)
    most = csgv.max()
    order = np.where(csgv <= 128, csgv / (3 * most) + 0.666, csgv / (2 * most) + 0.499)
    order[csgv < 2] = 0
    return order.repeat(2, axis=0).repeat(2, axis=1)[: x.shape[0], : x.shape[1]]


@pytest.mark.parametrize("shape", [(40, 60), (41, 33), (6, 5)])
def test_the_order_map_is_that_of_a_slow_calculation(shape):
    picture = rough_picture(*shape)
    slow = slow_order_map(picture)
    assert slow.max() > 0.99 and (slow.size < 100 or (slow == 0).any())
    np.testing.assert_allclose(touchtrial.order_map(picture, precision="double"), slow, atol=1e-9)
    np.testing.assert_allclose(touchtrial.order_map(picture), slow, atol=1e-6)


def test_the_force_is_that_of_a_slow_calculation():
    extraction = touchtrial.extract(rough_picture(17, 23), precision="double", neighbourhood=5)
    surface = 128 + extraction.texture
    height, width = surface.shape
    slow = np.zeros((height, width, 2))
    for y, x in np.ndindex(height, width):
        for j, i in itertools.product(range(y - 2, y + 3), range(x - 2, x + 3)):
            if (j, i) != (y, x) and 0 <= j < height and 0 <= i < width:
                away = np.array([i - x, j - y])
                slow[y, x] += (surface[y, x] - surface[j, i]) * away / (away @ away)
    np.testing.assert_allclose(extraction.force_tangential, slow, atol=1e-10)


@pytest.mark.parametrize(
    "image",
    [
        np.zeros((4, 4)),
        np.zeros((4, 4), np.int64),
        np.zeros((4, 4), bool),
        np.full((4, 4), np.nan),
        np.zeros((4, 4), complex),
        np.zeros((4, 4), object),
        [["a", "b"]],
        None,
        3,
        {},
    ],
    ids=repr,
)
def test_what_is_no_picture_is_a_type_error_of_one_line(image):
    with pytest.raises(TypeError, match="^image: [^\n]*$"):
        touchtrial.extract(image)


@pytest.mark.parametrize(
    "shape", [(), (0,), (5,), (0, 5), (5, 0), (0, 0), (5, 5, 0), (5, 5, 5), (2, 2, 2, 1)]
)
def test_a_wrong_shape_is_a_value_error_of_one_line(shape):
    with pytest.raises(ValueError, match="^image: [^\n]*$"):
        touchtrial.extract(np.zeros(shape, np.uint8))


def test_a_picture_larger_than_the_memory_is_refused_before_it_is_copied():
    for shape in ((1 << 20, 1 << 20), (2, 1 << 40), (1 << 40, 1)):
        with pytest.raises(ValueError, match="^image: [^\n]*$"):
            touchtrial.extract(np.broadcast_to(np.uint8(3), shape))


def test_arrays_of_any_kind_are_taken_or_refused_in_one_line():
    random = np.random.default_rng(11)
    kinds = "u1 >u2 <u2 i1 u4 f2 f4 >f8 g c8 ? S3 U2 O M8[s] m8[s] V4".split()
    taken = 0
    for turn in range(600):
        shape = random.integers(0, 6, random.integers(0, 5))
        array = np.zeros(shape, kinds[turn % len(kinds)])
        for axis in range(array.ndim):
            steps = (None, 2, -1, -2)[random.integers(4)]
            array = np.moveaxis(np.moveaxis(array, axis, 0)[::steps], 0, axis)
        if turn % 3 == 0:
            array = array.T
        for call in (
            lambda: touchtrial.extract(array),
            lambda: touchtrial.force_field(array),
            lambda: touchtrial.order_map(array, precision="double"),
        ):
            try:
                call()
                taken += 1
            except (TypeError, ValueError) as error:
                assert "\n" not in str(error)
    assert taken > 20


@pytest.mark.parametrize(
    "options, words",
    [
        ({"method": "adaptiv"}, "adaptive"),
        ({"method": "fixed"}, "order"),
        ({"method": "fixed", "order": 1.0}, "/order"),
        ({"order": 0.5}, "/order"),
        ({"radius": 64}, "/radius"),
        ({"radius": 2.5}, "/radius"),
        ({"radius": "2"}, "/radius"),
        ({"norm": "additiv"}, "additive"),
        ({"method": "gaussian", "sigma_px": float("nan")}, "sigma_px"),
        ({"method": "gaussian", "sigma_px": 0.0}, "/sigma_px"),
        ({"method": "tv-gabor", "components": [0.2]}, "components"),
        ({"method": "tv-gabor", "components": [(0.6, 0.0)]}, "/frequency"),
        ({"seed": 3}, "phase-scrambled"),
        ({"control": "phase-scrambled", "seed": -1}, "seed"),
        ({"mapping": "log"}, "stretch"),
        ({"neighbourhood": 4}, "neighbourhood"),
        ({"neighbourhood": -3}, "neighbourhood"),
        ({"precision": "half"}, "precision"),
        ({"planes": ["cvgs"]}, "csgv"),
    ],
    ids=repr,
)
def test_a_wrong_option_is_a_value_error_that_names_it(options, words):
    with pytest.raises(ValueError, match=r"^[^\n]+$") as caught:
        touchtrial.extract(rough_picture(8, 8), **options)
    assert words in str(caught.value)


def test_an_unknown_option_is_a_type_error():
    with pytest.raises(TypeError):
        touchtrial.extract(rough_picture(8, 8), radios=2)


def test_a_file_that_is_no_picture_has_the_programs_message(program, tmp_path):
    broken = tmp_path / "broken.png"
    broken.write_bytes(b"\x89PNG\r\n\x1a\nno more")
    for path in (broken, tmp_path / "missing.png"):
        with pytest.raises(touchtrial.Error) as caught:
            touchtrial.extract(path)
        assert program("extract", path, fails=True) == f"touchtrial: {caught.value}\n"


def test_numbers_of_numpy_are_numbers():
    picture = rough_picture(16, 16)
    ours = touchtrial.extract(picture, radius=np.int32(3)).texture
    assert same_bits(ours, touchtrial.extract(picture, radius=3).texture)


def test_evaluate_is_what_the_program_prints(program, tmp_path):
    paths = [
        write_pnm(tmp_path / f"{seed}.pgm", rough_picture(180 + seed, 200, seed)) for seed in (1, 2)
    ]
    for sweep in (False, True):
        printed = json.loads(program("evaluate", *paths, "--json", *["--sweep"] * sweep))
        assert touchtrial.evaluate(*paths, sweep=sweep) == printed
    of_array = touchtrial.evaluate(rough_picture(181, 200, 1))["images"][0]
    assert of_array.pop("image") == "array 0"
    expected = touchtrial.evaluate(paths[0])["images"][0]
    del expected["image"]
    assert of_array == expected


def test_a_picture_too_small_for_a_sweep_is_a_value_error():
    with pytest.raises(ValueError):
        touchtrial.evaluate(rough_picture(20, 20), sweep=True)
    with pytest.raises(ValueError):
        touchtrial.evaluate(np.zeros((1, 1), np.uint8))
