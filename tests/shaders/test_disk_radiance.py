"""Pictures of Page and Thorne's disk, bolometric and smooth, from infinity: every pixel's light against the float64 twin's."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl import listed_rays, reference
from blackhole_gl.physics import relativity
from blackhole_gl.physics.disk_profile import page_thorne_flux
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets

OUTER = 10.0
# Half floats keep eleven bits: 5e-4 at worst, and three orders' sum is rounded once.
BOUND = 1e-3


@pytest.mark.parametrize("spin, inclination, size", [(0.9, 70.0, (96, 54)), pytest.param(0.0, 80.0, (144, 81), marks=pytest.mark.slow)])
def test_light_of_the_smooth_disk(renderer: Renderer, spin: float, inclination: float, size: tuple[int, int]) -> None:
    scene = presets.load(
        ["kerr", "reference", "smooth"],
        {"hole.spin": spin, "camera.distance": "inf", "camera.inclination_deg": inclination, "camera.field_m": 30.0, "disk.outer_radius": OUTER,
         "disk.colour": "white", "disk.compositing": "additive", "disk.emission_strength": 0.18, "sky.enabled": False, "rays.edges": 1},
    )  # fmt: skip
    renderer.render(scene, 0.0, size)
    found = renderer.radiance()[::-1, :, 0].astype(float)
    truth, edge = light_of_the_twin(spin, inclination, scene.camera.field_m, size)
    inside = (truth > 1e-3 * truth.max()) & ~edge
    off = np.abs(found - truth)[inside] / truth[inside]
    print(f"a* = {spin}, {inclination:g} degrees, {np.count_nonzero(inside)} pixels: 99 % within {np.quantile(off, 0.99):.1e}, the worst {off.max():.1e}")
    assert np.count_nonzero(inside) > 1000 and np.quantile(off, 0.99) <= BOUND
    listed = listed_rays.intensities(scene, listed_rays.trace_by_shader(renderer, scene, listed_rays.pixel_rays(scene, size).reshape(-1, 2)))
    told = np.nansum(listed, axis=1).reshape(size[::-1])[::-1]
    assert np.quantile(np.abs(found - told)[inside] / told[inside], 0.99) <= BOUND, "listed rays tell the same"


def light_of_the_twin(spin: float, inclination: float, field_m: float, size: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    """Light of each pixel, g⁴ F over the largest F, summed over three crossings, bottom row first; and where one lies at an edge of the disk."""
    pixel = field_m / size[1]
    alpha, beta = np.meshgrid((np.arange(size[0]) + 0.5 - 0.5 * size[0]) * pixel, (np.arange(size[1]) + 0.5 - 0.5 * size[1]) * pixel)
    rays = np.stack([alpha.ravel(), beta.ravel()], axis=-1)
    met = reference.trace("kerr", spin=spin, distance=np.inf, inclination_deg=inclination, screen=rays, orders=3)
    r, inner = met.equatorial.r, float(relativity.isco_radius(spin))
    shines = (r > inner) & (r < OUTER)
    radii = np.linspace(inner, OUTER, 200_001)
    flux = np.where(shines, page_thorne_flux(np.where(shines, r, 2.0 * inner), spin), 0.0) / page_thorne_flux(radii, spin).max()
    light = np.nansum(flux * np.where(shines, met.g, 0.0) ** 4, axis=1).reshape(size[::-1])
    edges = [partly_covered(r[:, order].reshape(size[::-1]), inner) for order in range(3)]
    return light, np.any(edges, axis=0)


def partly_covered(r: np.ndarray, inner: float) -> np.ndarray:
    """Pixels, by the radii (height, width) of their crossings, through which an edge of the disk may run; those beside one without a crossing, too."""
    reach = np.zeros_like(r)
    for axis in (0, 1):
        change = np.abs(np.diff(r, axis=axis, prepend=np.nan))
        reach += np.maximum(change, np.roll(change, -1, axis))  # NaN beside a pixel without a crossing
    wide = np.where(np.isnan(reach), np.inf, reach)
    return ~np.isnan(r) & (r - wide < OUTER) & (r + wide > inner) & ~((r - wide > inner) & (r + wide < OUTER))
