"""Diameter, width and asymmetry of rings: of made-up ones whose values are known, of the critical curve, and of the shipped presets."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import ndimage, optimize, special

from blackhole_gl.measure import ring
from blackhole_gl.physics import lensed_circles
from blackhole_gl.physics.observer import observe
from blackhole_gl.scene import Scene, SceneError, presets
from tests.sampled import sampled

FWHM = math.sqrt(8.0 * math.log(2.0))


def made_up(radius: float, sigma: float, uneven: float = 0.0, towards_deg: float = 0.0, centre=(210.3, 181.7), background=0.0, size=(400, 360)) -> np.ndarray:
    """A Gaussian ring, brighter by the share `uneven` in a direction from up to the left."""
    y, x = np.mgrid[: size[1], : size[0]]
    right, up = x - centre[0], centre[1] - y
    angle = np.arctan2(-right, up) - math.radians(towards_deg)
    return background + (1.0 + uneven * np.cos(angle)) * np.exp(-0.5 * ((np.hypot(right, up) - radius) / sigma) ** 2)


SIZES = [(60.0, 3.0), (45.0, 8.0), (90.0, 12.0)]
SHARES = [(0.0, 0.0), (0.4, 200.0), (0.8, 310.0)]


@pytest.mark.parametrize("radius, sigma, uneven, towards_deg", sampled(
    [(*size, *share) for size in SIZES for share in SHARES], [(*size, *share) for size, share in zip(SIZES, SHARES, strict=True)],
))
def test_a_gaussian_ring(radius: float, sigma: float, uneven: float, towards_deg: float) -> None:
    """Reading linearly between pixels flattens a peak of σ = 3 px by 1/36 px² of its square: 0.3 % of the width."""
    found = ring.ring_of(made_up(radius, sigma, uneven, towards_deg))
    assert found is not None
    assert found.diameter == pytest.approx(2.0 * radius, abs=0.1)
    assert found.width == pytest.approx(FWHM * sigma, rel=0.01)
    assert found.asymmetry == pytest.approx(0.5 * uneven, abs=2e-3)
    assert found.centre == pytest.approx((210.3, 181.7), abs=0.2)
    assert found.spread < 2e-3
    if uneven:
        assert found.orientation_deg == pytest.approx(towards_deg, abs=0.5)


def test_an_even_background_widens_nothing() -> None:
    plain, raised = (ring.ring_of(made_up(50.0, 6.0, background=level)) for level in (0.0, 0.4))
    assert plain is not None and raised is not None
    assert raised.width == pytest.approx(plain.width, rel=0.01)  # half of the maximum above it, found on the same samples
    assert raised.diameter == pytest.approx(plain.diameter, abs=0.05)


@pytest.mark.parametrize("sigma", [6.0, 14.0])
def test_a_beam_makes_a_thin_ring_wider_and_smaller(sigma: float) -> None:
    """A thin ring of radius R becomes exp(−(r² + R²)/2σ²) I₀(rR/σ²), largest within R."""
    radius, own = 60.0, 1.5
    whole = math.hypot(sigma, 0.0)

    def profile(r: float) -> float:
        return math.exp(-0.5 * ((r - radius) / whole) ** 2) * float(special.i0e(r * radius / whole**2))

    peak = optimize.minimize_scalar(lambda r: -profile(r), bounds=(0.5 * radius, radius), method="bounded").x
    found = ring.ring_of(ring.blurred(made_up(radius, own), math.sqrt(sigma**2 - own**2)))
    assert found is not None
    assert found.diameter == pytest.approx(2.0 * peak, abs=0.2)  # the thin ring's own width acts across, the beam both ways
    assert found.diameter < 2.0 * radius


def test_the_blur_is_a_gaussian() -> None:
    light = np.random.default_rng(1).uniform(size=(60, 90))
    np.testing.assert_allclose(ring.blurred(light, 4.3), ndimage.gaussian_filter(light, 4.3, mode="nearest", truncate=6.0), atol=1e-8)


@pytest.mark.parametrize("light", [np.zeros((50, 60)), np.full((50, 60), 0.3), made_up(40.0, 2.0, centre=(10.0, 10.0), size=(60, 50))])
def test_where_there_is_no_ring_there_is_none(light: np.ndarray) -> None:
    assert ring.ring_of(light) is None


@pytest.mark.parametrize("spin, inclination", sampled([(0.0, 0.0), (0.94, 17.0)], [(0.94, 17.0)]))
def test_the_second_ring_is_as_wide_as_the_critical_curve(renderer, spin: float, inclination: float) -> None:
    """1 %: light of the second ring has turned round the hole once and a quarter, and passes outside the curve by e^(−5π/2) times some tens."""
    view = {"hole.spin": spin, "camera.distance": math.inf, "camera.field_m": 16.0, "camera.inclination_deg": inclination}
    disk = {"disk.orders_shown": "second_ring", "disk.colour": "white", "disk.compositing": "additive", "disk.turbulence": False, "disk.point_field": False}
    scene = Scene().with_values({**view, **disk, "sky.enabled": False})
    found = ring.measure(renderer, scene, 0.0, (400, 400))
    angles = np.linspace(0.0, 2.0 * np.pi, 720, endpoint=False)
    away = lensed_circles.shadow_edge(observe(scene), angles)
    edge = away * np.exp(1j * angles)
    expected = 2.0 * float(np.abs(edge - edge.mean()).mean())
    assert spin or expected == pytest.approx(2.0 * math.sqrt(27.0))
    assert found.sharp is not None
    assert found.sharp.diameter * found.pixel_m == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("name, diameter, error", [("m87_eht", 42.0, 3.0), ("sgr_a_eht", 51.8, 2.3)])
def test_presets_have_the_published_diameters(renderer, name: str, diameter: float, error: float) -> None:
    """µas: EHT 2019 Paper I, EHT 2022 Paper I. Seen through the beam, as they were."""
    found = ring.measure(renderer, presets.load([name]), 0.0, (300, 300))
    assert found.blurred is not None
    assert found.blurred.diameter * found.pixel_uas == pytest.approx(diameter, abs=error)


def test_m87_is_brighter_in_the_south(renderer) -> None:
    """Position angles of 150° to 200° are published (EHT 2019 Paper I)."""
    found = ring.measure(renderer, presets.load(["m87_eht"]), 0.0, (300, 300)).blurred
    assert found is not None
    assert 150.0 <= found.orientation_deg <= 200.0 and found.asymmetry > 0.1


@pytest.mark.parametrize("field, sign", [("toroidal", 1.0), ("radial", -1.0)])
def test_beta_2_tells_fields_apart(renderer, field: str, sign: float) -> None:
    """0.75 of all light is polarized; a beam of the ring's half mixes some of it away. 0.12: the disk is seen from 17°, and its matter moves."""
    none = dict.fromkeys(("polarization.field_vertical", "polarization.field_radial", "polarization.field_toroidal"), 0.0)
    values = none | {f"polarization.field_{field}": 1.0}
    scene = presets.load(["m87_eht"], values)
    found = ring.measure(renderer, scene, 0.0, (240, 240))
    assert found.sharp_beta_2 is not None and found.blurred_beta_2 is not None
    assert sign * found.sharp_beta_2.real == pytest.approx(0.7, abs=0.12) and abs(found.sharp_beta_2.imag) < 0.25
    assert 0.3 < abs(found.blurred_beta_2) < abs(found.sharp_beta_2)
    assert ring.text(found, scene).count("β₂") == 2


def test_the_polarization_of_m87_turns_as_was_seen(renderer) -> None:
    """Nearly round the ring (EHT 2021 Paper VII), which has the phase 180°; the preset's field was chosen for −163° to −129°, and is held to it."""
    found = ring.measure(renderer, presets.load(["m87_eht"]), 0.0, (200, 200)).blurred_beta_2
    assert found is not None
    assert -163.0 <= math.degrees(np.angle(found)) <= -129.0


def test_where_polarization_is_not_known_the_rest_is_told(renderer) -> None:
    scene = presets.load(["m87_eht"], {"rays.model": "post_newtonian"})
    found = ring.measure(renderer, scene, 0.0, (200, 200))
    assert found.sharp is not None and found.sharp_beta_2 is None
    assert "β₂" not in ring.text(found, scene)


def test_neither_height_nor_shape_of_the_picture_changes_the_ring(renderer) -> None:
    """By more than a fiftieth of the beam."""
    scene = presets.load(["m87_eht"])
    found = [ring.measure(renderer, scene, 0.0, size) for size in ((200, 200), (480, 360))]
    sizes = [measured.blurred.diameter * measured.pixel_uas for measured in found if measured.blurred is not None]
    assert len(sizes) == 2 and abs(sizes[0] - sizes[1]) < 0.4


def test_a_view_has_no_brightness_and_says_so(renderer) -> None:
    with pytest.raises(SceneError, match="post.view: got 'steps'; allowed is 'picture'"):
        ring.measure(renderer, Scene().with_values({"post.view": "steps"}), 0.0, (32, 32))
