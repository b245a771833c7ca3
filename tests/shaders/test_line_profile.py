"""The profile of a line against a quadrature over the disk: where its circles are seen, in closed form and float64."""

from __future__ import annotations

import csv
import io

import numpy as np
import pytest
from scipy.interpolate import RectBivariateSpline

from blackhole_gl.measure import line_profile
from blackhole_gl.physics import lensed_circles, observer, relativity
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, SceneError, presets

BINS = 100


def disk(spin: float, inclination: float, **changes: float | str) -> Scene:
    named = {"hole.spin": spin, "camera.distance": "inf", "camera.inclination_deg": inclination, "disk.compositing": "additive", "disk.outer_radius": 10.0}
    return presets.load(["kerr", "reference"], named | {key.replace("__", "."): value for key, value in changes.items()})


def by_quadrature(scene: Scene, index: float, edges: np.ndarray, order: int) -> np.ndarray:
    """Flux in each bin, in M², of the image `order`: sums over the disk's own radii and over angles on the screen."""
    seen, spin = observer.observe(scene), scene.hole.spin
    inner = float(relativity.isco_radius(spin))
    # Circles crowd at the inner edge on the screen, so few of them are enough in the root of their distance from it.
    part = np.linspace(0.0, 1.0, 40)
    radii = inner + (scene.disk.outer_radius - inner) * part**2
    chi = np.linspace(0.0, 2.0 * np.pi, 181)
    spline = RectBivariateSpline(part, chi, lensed_circles.circles(seen, radii, np.full(len(radii), order), chi))
    fine = (np.arange(1200) + 0.5) / 1200
    angles = 2.0 * np.pi * (np.arange(1440) + 0.5) / 1440
    away, change = spline(fine, angles), spline(fine, angles, dx=1)
    r = (inner + (scene.disk.outer_radius - inner) * fine**2)[:, None]
    lam = -away * np.cos(angles) * np.sin(np.radians(scene.camera.inclination_deg))
    g = relativity.circular_orbit_g(np.broadcast_to(r, lam.shape), lam, spin)
    light = g**3 * r**-index * away * np.abs(change) / len(fine) * (2.0 * np.pi / len(angles))
    return np.histogram(g, edges, weights=light)[0]


VIEWS = [(0.998, 60.0, 3.0), *(pytest.param(*view, marks=pytest.mark.slow) for view in ((0.0, 30.0, 3.0), (0.998, 75.0, 2.0)))]


@pytest.mark.parametrize("spin, inclination, index", VIEWS)
def test_it_is_that_of_the_quadrature(renderer: Renderer, spin: float, inclination: float, index: float) -> None:
    scene = disk(spin, inclination)
    found = line_profile.measure(renderer, scene, index=index, bins=BINS)
    truth = np.stack([by_quadrature(scene, index, found.edges, order) for order in range(3)])
    off = np.abs(found.flux - truth / truth.sum()).max(axis=1) / found.flux.max(axis=1)
    print(f"a* = {spin}, {inclination:g} degrees, q = {index:g}: {', '.join(f'{100.0 * part:.2f}' for part in off)} % of each order's peak")
    # What is left is how evenly rays fill bins: it falls with their number, and shares, which need no bins, agree to a thousandth.
    assert np.abs(found.flux.sum(axis=0) - truth.sum(axis=0) / truth.sum()).max() <= 0.01 * found.flux.sum(axis=0).max()
    np.testing.assert_allclose(found.shares, truth.sum(axis=1) / truth.sum(), rtol=2e-3)


def coarsely(renderer: Renderer, scene: Scene) -> line_profile.LineProfile:
    """By a quarter of the rays that `measure` has: shares are then exact to two thousandths."""
    (found,) = (found for found in line_profile.in_parts(renderer, scene, index=3.0, bins=BINS, parts=1, fineness=0.5) if found is not None)
    return found


@pytest.fixture(scope="module")
def clear(renderer: Renderer) -> line_profile.LineProfile:
    return coarsely(renderer, disk(0.9, 60.0))


def test_a_disk_hides_its_rings_but_beside_it(renderer: Renderer, clear: line_profile.LineProfile) -> None:
    opaque = coarsely(renderer, disk(0.9, 60.0, disk__compositing="opacity", disk__opacity=1.0))
    assert clear.shares[1:].sum() > 2.0 * opaque.shares[1:].sum() > 0.0


def test_a_far_camera_and_one_at_infinity_see_the_same(renderer: Renderer, clear: line_profile.LineProfile) -> None:
    far = coarsely(renderer, disk(0.9, 60.0, camera__distance=1e4))
    np.testing.assert_allclose(far.shares, clear.shares, rtol=5e-3)  # 5 r_s of 10^4 is how much larger the near side is seen
    assert far.mean == pytest.approx(clear.mean, rel=1e-3)


@pytest.mark.parametrize("changes, key", [
    ({"disk.enabled": False}, "disk.enabled"), ({"rays.model": "lorenz"}, "rays.model"), ({"things.ball.kind": "sphere"}, "things"),
])  # fmt: skip
def test_what_has_no_profile_is_refused(changes: dict, key: str) -> None:
    with pytest.raises(SceneError, match=key):
        line_profile.refuse(presets.load(["kerr"], changes))


def test_a_row_a_bin() -> None:
    found = line_profile.LineProfile(np.array([0.5, 0.75, 1.25]), np.array([[0.25, 0.5], [0.0, 0.25], [0.0, 0.0]]))
    rows = list(csv.reader(io.StringIO(found.as_csv())))
    assert rows == [["g", "total", "direct", "first_ring", "second_ring"], ["0.625", "1", "1", "0", "0"], ["1", "1.5", "1", "0.5", "0"]]
    assert list(found.shares) == [0.75, 0.25, 0.0] and found.mean == pytest.approx(0.25 * 0.625 + 0.75)
