"""force_field and render: against their formulas, and against what the program prepares."""

import gc
import json
import sys

import numpy as np
import pytest
import touchtrial
from conftest import rough_picture

PITCH_MM = 0.5


def field_of(model, **rendering):
    picture = rough_picture(40, 50)
    return touchtrial.force_field(
        picture, rendering={"model": model, "pitch_mm": PITCH_MM, **rendering}
    )


def centres_mm(shape, depth_mm):
    """The pixels' centres at a depth, row by row."""
    y, x = np.mgrid[: shape[0], : shape[1]]
    return np.stack(
        ((x.ravel() + 0.5) * PITCH_MM, (y.ravel() + 0.5) * PITCH_MM, np.full(x.size, -depth_mm)),
        axis=-1,
    )


def test_the_model_paper_at_pixel_centres_is_its_formula():
    field = field_of("paper", max_force_n=100.0)
    k = field.rendering["stiffness_n_per_mm"]
    forces = touchtrial.render(field, centres_mm(field.shape, 2.0)).reshape(*field.shape, 3)
    heights = field.heights.astype(float)
    normal = k * 2.0 + field.gains["normal_n"] * heights  # G - G_ref = T
    np.testing.assert_allclose(forces[..., 2], normal, rtol=1e-12)
    np.testing.assert_allclose(forces[..., :2], field.lateral_force(), atol=1e-7)
    assert np.abs(forces[..., :2]).max() > 0.01


def test_the_lateral_force_is_that_of_the_heights():
    field = field_of("paper")
    p = field.heights.astype(float)
    inside = np.zeros((38, 48, 2))
    for dy in (-1, 0, 1):
        for dx in (-1, 0, 1):
            if dx == dy == 0:
                continue
            fall = p[1:-1, 1:-1] - p[1 + dy : 39 + dy, 1 + dx : 49 + dx]
            inside += fall[..., None] * np.array([dx, dy]) / (dx * dx + dy * dy)
    newtons = field.gains["tangential_n"] * inside
    np.testing.assert_allclose(field.lateral_force()[1:-1, 1:-1], newtons, rtol=1e-5, atol=1e-7)


@pytest.mark.parametrize("model", ["paper", "surface"])
def test_far_from_the_texture_there_is_the_flat_wall(model):
    field = field_of(model)
    forces = touchtrial.render(field, [[-50.0, 5.0, -1.0], [5.0, 500.0, -1.5], [3.0, 3.0, 90.0]])
    k = field.rendering["stiffness_n_per_mm"]
    np.testing.assert_allclose(forces, [[0, 0, k], [0, 0, 1.5 * k], [0, 0, 0]], atol=1e-12)


def test_the_norm_of_the_force_is_limited():
    field = field_of("paper", max_force_n=0.5)
    norms = np.linalg.norm(touchtrial.render(field, centres_mm(field.shape, 5.0)), axis=1)
    np.testing.assert_allclose(norms, 0.5, rtol=1e-12)


def test_no_closed_path_on_the_model_surface_gains_energy():
    field = field_of("surface", max_force_n=100.0)
    angle = np.linspace(0, 2 * np.pi, 20001)
    path = np.stack(
        (9 + 4 * np.cos(angle), 11 + 3 * np.sin(angle), -1.5 + 0.5 * np.sin(3 * angle)), axis=-1
    )
    force = touchtrial.render(field, path)
    power = 0.5 * (force[1:] + force[:-1]) * np.diff(path, axis=0)
    assert abs(power.sum()) < 1e-6 < np.abs(power).sum()


def test_damping_follows_the_velocity_of_the_hand():
    field = field_of("paper", damping_n_s_per_mm=0.001, max_force_n=100.0)
    path = centres_mm(field.shape, 2.0)[:100]
    path[:, 2] += 0.001 * np.arange(100) ** 2 / 100
    still = touchtrial.render(field, path)
    velocities = np.zeros_like(path)
    velocities[1:] = np.diff(path, axis=0) / 0.01
    damped = touchtrial.render(field, path, velocities_mm_s=velocities)
    np.testing.assert_allclose(damped, touchtrial.render(field, path, 0.01), atol=1e-12)
    np.testing.assert_allclose(still[:, 2] - damped[:, 2], 0.001 * velocities[:, 2], atol=1e-12)


def test_friction_pulls_against_the_stroke_up_to_its_limit():
    flat = touchtrial.force_field(
        np.full((40, 40), 9, np.uint8), rendering={"model": "surface", "friction": 0.3}
    )
    path = np.zeros((200, 3))
    path[:, 0] = np.linspace(1, 6, 200)
    path[:, 1] = 4
    path[:, 2] = -1
    force = touchtrial.render(flat, path)
    assert force[0, 0] == 0
    np.testing.assert_allclose(force[100:, 0], -0.3 * force[100:, 2], rtol=1e-9)


def test_a_field_of_a_texture_is_that_of_its_picture():
    picture = rough_picture(31, 45)
    of_picture = touchtrial.force_field(picture)
    extraction = touchtrial.extract(picture, precision="double")
    for source in (extraction, extraction.texture):
        other = touchtrial.force_field(source)
        assert (other.heights == of_picture.heights).all()
        assert other.gains == of_picture.gains
    strided = touchtrial.force_field(np.asfortranarray(extraction.texture).astype(">f8"))
    assert (strided.heights == of_picture.heights).all()


def test_gains_are_those_that_the_program_prepares(study_folder):
    study = json.loads((study_folder / "mine.json").read_text())
    fields = touchtrial.force_fields(
        [study_folder / one["images"][0] for one in study["classes"]], rendering=study["rendering"]
    )
    pack = json.loads((study_folder / "mine.sim.pack" / "pack.json").read_text())
    assert len(pack["fields"]) == len(fields)
    for entry in pack["fields"]:
        assert entry["gains"] in [field.gains for field in fields]


def test_equalised_fields_have_one_strength():
    fields = touchtrial.force_fields(
        [rough_picture(50, 50, seed, grain=seed) for seed in (1, 2, 3)],
        rendering={"equalise": "rms"},
    )
    rms = [field.statistics()["tangential_rms_n"] for field in fields]
    np.testing.assert_allclose(rms, rms[0], rtol=1e-6)
    assert len({field.gains["tangential_n"] for field in fields}) == 3


def test_rendering_options_are_those_of_a_study_file():
    field = field_of("paper", gains={"tangential_n": 0.5, "normal_n": 0.25})
    assert field.gains == {"tangential_n": 0.5, "normal_n": 0.25, "height_mm": 0.0}
    assert field.over_budget
    assert field.rendering["filter_mm"] == 0.4
    assert field.pitch_mm == PITCH_MM
    assert field.shape == (40, 50)
    assert field.size_mm == (20.0, 25.0)
    assert touchtrial.force_field(rough_picture(9, 9), rendering=field.rendering).over_budget


@pytest.mark.parametrize(
    "rendering, words",
    [
        ({"stifness_n_per_mm": 1.0}, "stiffness_n_per_mm"),
        ({"pitch_mm": 0.0}, "/pitch_mm"),
        ({"pitch_mm": float("inf")}, "pitch_mm: is inf"),
        ({"model": "papr"}, "paper"),
        ({"friction": 0.3}, "friction"),
        ({"neighbourhood": 2}, "/neighbourhood"),
        ({"gains": {"tangential_n": 1.0}}, "normal_n"),
    ],
    ids=repr,
)
def test_a_wrong_rendering_is_a_value_error_that_names_the_key(rendering, words):
    with pytest.raises(ValueError, match=r"^[^\n]+$") as caught:
        touchtrial.force_field(rough_picture(9, 9), rendering=rendering)
    assert words in str(caught.value)


def test_heights_are_the_fields_own_read_only_and_keep_it_alive():
    field = field_of("paper")
    before = sys.getrefcount(field)
    heights = field.heights
    assert sys.getrefcount(field) == before + 1
    assert heights.base is field and not heights.flags.writeable
    with pytest.raises(ValueError):
        heights[0, 0] = 1
    assert np.shares_memory(heights, field.heights)
    expected = heights.copy()
    part = heights[::2]
    del field, heights
    gc.collect()
    for _ in range(20):
        field_of("surface")
    assert (part == expected[::2]).all()


def test_positions_that_are_not_finite_give_no_force():
    for model in ("paper", "surface"):
        field = field_of(model)
        path = np.array([[np.nan, 1, -1], [1, np.inf, -1], [1, 1, -np.inf], [5, 5, -1.0]])
        forces = touchtrial.render(field, path)
        assert not forces[:3].any() and forces[3, 2] > 0
        assert np.isfinite(touchtrial.render(field, [[1e300, -1e300, -1.0], [1, 1, -1e300]])).all()


def test_paths_of_any_layout_give_the_same_forces():
    field = field_of("paper")
    path = centres_mm(field.shape, 1.0)
    expected = touchtrial.render(field, path)
    wide = np.zeros((len(path), 6))
    wide[:, ::2] = path
    for variant in (np.asfortranarray(path), path.astype(">f8"), wide[:, ::2], path.tolist()):
        assert (touchtrial.render(field, variant) == expected).all()
    assert touchtrial.render(field, np.empty((0, 3))).shape == (0, 3)


@pytest.mark.parametrize(
    "error, path, options",
    [
        (ValueError, np.zeros((4, 2)), {}),
        (ValueError, np.zeros(3), {}),
        (ValueError, np.zeros((4, 3, 1)), {}),
        (TypeError, np.zeros((4, 3), complex), {}),
        (TypeError, [["a", "b", "c"]], {}),
        (TypeError, None, {}),
        (ValueError, np.zeros((4, 3)), {"dt_s": 0.0}),
        (ValueError, np.zeros((4, 3)), {"dt_s": float("nan")}),
        (ValueError, np.zeros((4, 3)), {"velocities_mm_s": np.zeros((3, 3))}),
        (ValueError, np.zeros((4, 3)), {"velocities_mm_s": np.zeros((4, 3)), "dt_s": 1.0}),
    ],
)
def test_wrong_paths_are_refused_in_one_line(error, path, options):
    with pytest.raises(error, match=r"^[^\n]+$"):
        touchtrial.render(field_of("paper"), path, **options)


@pytest.mark.parametrize(
    "error, texture",
    [
        (ValueError, np.zeros((0, 3))),
        (ValueError, np.zeros(9)),
        (ValueError, np.full((4, 4), np.nan)),
        (ValueError, np.full((4, 4), np.inf)),
        (ValueError, np.broadcast_to(0.0, (1 << 20, 1 << 20))),
        (TypeError, np.zeros((4, 4), int)),
        (TypeError, np.zeros((4, 4), complex)),
    ],
)
def test_wrong_textures_are_refused_in_one_line(error, texture):
    with pytest.raises(error, match=r"^[^\n]+$"):
        touchtrial.force_field(texture)


def test_no_field_of_nothing():
    with pytest.raises(ValueError):
        touchtrial.force_fields([])
    with pytest.raises(TypeError):
        touchtrial._touchtrial.Field()


@pytest.mark.parametrize(
    "call",
    [
        lambda: touchtrial.extract("bark\0.png"),
        lambda: touchtrial.extract(np.ones((9, 9), np.uint8), planes=[5]),
        lambda: touchtrial.extract(np.ones((9, 9), np.uint8), mapping=None),
        lambda: touchtrial.extract(np.ones((9, 9), np.uint8), neighbourhood=3.0),
        lambda: touchtrial.extract(np.ones((9, 9), np.uint8), neighbourhood=10**12),
        lambda: touchtrial.extract(np.ones((9, 9), np.uint8), radius=object()),
        lambda: touchtrial.extract(np.ones((9, 9), np.uint8), radius=[3]),
        lambda: touchtrial.extract(np.ones((9, 9), np.uint8), method="fixed", order=np.nan),
        lambda: touchtrial.extract(np.ma.masked_array(np.ones((9, 9), np.uint8), mask=np.eye(9))),
        lambda: touchtrial.force_field(np.ones((9, 9)), method="gaussian", sigma_px=3),
        lambda: touchtrial.force_field(np.ones((9, 9)), rendering={"pitch_mm": object()}),
        lambda: touchtrial.render(None, np.zeros((3, 3))),
        lambda: touchtrial.render(touchtrial.force_field(np.ones((9, 9))), np.zeros((3, 3)), "a"),
        lambda: touchtrial.evaluate(np.ones((9, 9), np.uint8), sweep="yes"),
    ],
)
def test_wrong_arguments_have_one_line(call):
    with pytest.raises((TypeError, ValueError), match=r"^[^\n]+$"):
        call()


def test_a_path_larger_than_the_memory_is_a_memory_error():
    field = touchtrial.force_field(np.ones((9, 9)))
    with pytest.raises(MemoryError):
        touchtrial.render(field, np.broadcast_to(np.zeros(3, np.float32), (10**12, 3)))
