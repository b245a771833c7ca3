"""Make `assets/pictures/`, what scenes hang behind the hole: a deep field of galaxies, and a desert's horizon.

Both are JPEG, sRGB, and invented: galaxies are ellipses with Sérsic's profiles and spirals of logarithms, dunes and table mountains are filtered noise,
from fixed seeds.
"""

from pathlib import Path

import numpy as np
from PIL import Image

FOLDER = Path(__file__).resolve().parent.parent / "assets" / "pictures"
SEED = 20_241
FIELD = (1600, 1000)
GALAXIES = 900
SPIRALS = 14
DESERT = (1600, 800)

Array = np.ndarray


def encoded(light: Array) -> Array:
    """sRGB codes uint8 of linear light (rows, columns, 3)."""
    light = np.clip(light, 0.0, 1.0)
    code = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    return np.rint(255.0 * code).astype(np.uint8)


def noise(rng: np.random.Generator, shape: tuple[int, int], slope: float, coarsest: float) -> Array:
    """Gaussian noise, mean 0, variance 1, with power ∝ k^-slope; k counts waves across."""
    ky, kx = np.fft.fftfreq(shape[0], 1 / shape[1])[:, None], np.fft.fftfreq(shape[1], 1 / shape[1])[None, :]
    field = np.fft.ifft2(np.fft.fft2(rng.standard_normal(shape)) * np.hypot(np.hypot(kx, ky), coarsest) ** (-slope / 2)).real
    return (field - field.mean()) / field.std()


def colour(redness: float) -> Array:
    """Of a galaxy, from young and blue, 0, to old and red, 1."""
    return np.array([0.55 + 0.45 * redness, 0.62 + 0.08 * redness, 1.0 - 0.62 * redness])


def galaxy(rng: np.random.Generator, size: float, arms: bool) -> Array:
    """Light (rows, columns, 3) of one whose half-light radius is `size` pixels, in the middle of a square."""
    reach = int(6.0 * size) + 3
    y, x = np.mgrid[-reach : reach + 1, -reach : reach + 1].astype(float)
    turn, flat = rng.uniform(0.0, np.pi), rng.uniform(0.35, 1.0) if arms else rng.uniform(0.2, 1.0)
    u, v = x * np.cos(turn) + y * np.sin(turn), (y * np.cos(turn) - x * np.sin(turn)) / flat
    r = np.hypot(u, v) / size
    fade = np.clip(1.0 - np.hypot(x, y) / reach, 0.0, 1.0)
    if not arms:
        redness = rng.uniform(0.15, 1.0)
        n = 1.0 + 2.0 * redness
        return (fade * np.exp(-(2 * n - 0.33) * (r ** (1 / n) - 1.0) * 0.75))[..., None] * colour(redness) * 0.12
    wind = np.cos(2.0 * (np.arctan2(v, u) - rng.uniform(2.2, 3.4) * rng.choice([-1, 1]) * np.log(r + 0.15)))
    knots = np.exp(0.5 * noise(rng, r.shape, 2.0, 4.0))
    disk = fade * np.exp(-1.4 * r) * (0.35 + 0.9 * np.clip(wind, 0.0, 1.0) ** 2 * knots)
    bulge = fade * np.exp(-6.0 * r)
    return 0.8 * disk[..., None] * colour(0.1) + 1.2 * bulge[..., None] * colour(0.85)


def deep_field() -> Array:
    """Light of a piece of sky full of galaxies."""
    rng = np.random.default_rng(SEED)
    width, height = FIELD
    light = np.full((height, width, 3), [0.0012, 0.0014, 0.0022])
    for k in range(GALAXIES):
        arms = k < SPIRALS
        size = rng.uniform(9.0, 22.0) if arms else 1.0 + 1.2 * rng.pareto(1.9)
        made = galaxy(rng, min(size, 24.0), arms) * rng.uniform(0.5, 1.3)
        side = made.shape[0]
        left, top = int(rng.uniform(0, width)) - side // 2, int(rng.uniform(0, height)) - side // 2
        x, y = slice(max(left, 0), min(left + side, width)), slice(max(top, 0), min(top + side, height))
        light[y, x] += made[y.start - top : y.stop - top, x.start - left : x.stop - left]
    return light


def desert() -> Array:
    """Light of a desert's horizon, half-way up the picture: sky, far table mountains, sand."""
    rng = np.random.default_rng(SEED)
    width, height = DESERT
    up = 1.0 - 2.0 * (np.arange(height)[:, None, None] + 0.5) / height
    horizon, zenith, sand = np.array([1.0, 0.78, 0.55]), np.array([0.16, 0.33, 0.72]), np.array([0.62, 0.40, 0.20])
    sky = zenith + (horizon - zenith) * np.exp(-np.abs(up) / 0.22)
    veil = np.clip(noise(rng, (height, width), 3.2, 5.0)[..., None] - 0.3, 0.0, 2.0) * np.clip(np.abs(up) * 3.0, 0.0, 1.0)
    light = sky + 0.16 * veil * (np.array([1.0, 0.93, 0.85]) - sky)
    for depth, (rise, far) in enumerate(((0.10, 0.75), (0.16, 0.45))):
        ridge = noise(rng, (1, width), 2.2, 3.0)[0]
        tables = rise * np.clip(np.tanh(3.0 * (ridge - 0.5 - 0.3 * depth)) + 0.02 * ridge, 0.0, 1.0)[None, :, None]
        rock = np.array([0.42, 0.20, 0.12]) * (0.8 + 0.25 * np.clip(noise(rng, (height, width), 2.5, 8.0), -1.5, 1.5)[..., None])
        cover = np.clip((tables - up) * 0.5 * height, 0.0, 1.0)
        light += cover * (far * horizon * 0.75 + (1.0 - far) * rock - light)
    dunes = sand * (1.0 + 0.14 * noise(rng, (height, width), 2.4, 6.0)[..., None])
    below = np.clip(-up * 0.5 * height, 0.0, 1.0)
    haze = np.exp(up / 0.12)
    return light + below * (dunes + (0.8 * horizon - dunes) * np.clip(haze, 0.0, 1.0) - light)


def main() -> None:
    FOLDER.mkdir(exist_ok=True)
    for name, light in (("deep_field", deep_field()), ("desert", desert())):
        path = FOLDER / f"{name}.jpg"
        Image.fromarray(encoded(light)).save(path, quality=82, optimize=True)
        print(f"{path.relative_to(FOLDER.parents[1])}  {path.stat().st_size // 1000} KB")


if __name__ == "__main__":
    main()
