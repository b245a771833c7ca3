"""Make `assets/galaxy_band.npy`: an invented galaxy seen from inside, for the procedural sky.

(192, 1024, 3) uint8: rows are sin(galactic latitude) from −0.5 to 0.5, columns longitude from −π to π with the
centre in the middle, values 255·√(radiance), linear Rec. 709, brightest about 1. It wraps in longitude and fades to
nothing at the upper and lower rows. Nothing in it is measured: star clouds and dust are filtered noise from a fixed seed.
"""

from pathlib import Path

import numpy as np

WIDTH, HEIGHT = 1024, 192
SEED = 20_240
TARGET = Path(__file__).resolve().parent.parent / "assets" / "galaxy_band.npy"


def clouds(rng: np.random.Generator, slope: float, flatness: float, coarsest: float) -> np.ndarray:
    """Gaussian noise (HEIGHT, WIDTH), mean 0, variance 1, with power ∝ k^-slope, `flatness` times longer than high."""
    tall = 2 * HEIGHT  # the upper half is thrown away: longitude wraps, latitude must not
    kx = np.fft.fftfreq(WIDTH, 1 / WIDTH)[None, :] * flatness
    ky = np.fft.fftfreq(tall, 1 / WIDTH)[:, None]
    k = np.hypot(np.hypot(kx, ky), coarsest)
    field = np.fft.ifft2(np.fft.fft2(rng.standard_normal((tall, WIDTH))) * k ** (-slope / 2)).real[:HEIGHT]
    return (field - field.mean()) / field.std()


def band() -> np.ndarray:
    """Radiance (HEIGHT, WIDTH, 3), 0…about 1."""
    rng = np.random.default_rng(SEED)
    sin_b = (np.arange(HEIGHT)[:, None] + 0.5) / HEIGHT - 0.5
    longitude = ((np.arange(WIDTH)[None, :] + 0.5) / WIDTH - 0.5) * 2 * np.pi
    towards = 0.5 + 0.5 * np.cos(longitude)
    plane = sin_b + 0.02 * clouds(rng, 4.0, 2.0, 3.0)

    height = 0.05 + 0.05 * towards**2
    stars = (0.25 + 0.75 * towards**1.5) * np.exp(-np.abs(plane) / height) * np.exp(0.45 * clouds(rng, 2.6, 1.5, 6.0))
    bulge = 1.1 * np.exp(-(longitude**2 / 0.16 + sin_b**2 / 0.012))
    haze = 0.10 * (0.3 + 0.7 * towards) * np.exp(-np.abs(sin_b) / 0.16)

    lanes = np.exp(-((plane + 0.012 * clouds(rng, 3.0, 3.0, 5.0)) ** 2) / (2 * 0.028**2))
    ridges = np.exp(-1.6 * np.abs(clouds(rng, 2.7, 2.2, 8.0))) * np.exp(0.5 * clouds(rng, 2.2, 1.5, 10.0))
    spurs = np.exp(-np.abs(plane) / 0.09) * np.clip(clouds(rng, 2.8, 1.0, 8.0), 0.0, None)
    depth = 2.4 * lanes * ridges + 0.7 * spurs

    cool, warm = np.array([0.78, 0.92, 1.25]), np.array([1.25, 0.98, 0.66])
    reddening = np.array([0.75, 1.0, 1.35])
    light = stars[..., None] * (cool + (warm - cool) * towards[..., None] ** 3) + bulge[..., None] * warm
    light = light * np.exp(-depth[..., None] * reddening) + haze[..., None]
    rim = np.clip((0.5 - np.abs(sin_b)) / 0.12, 0.0, 1.0)
    light = light * (rim**2 * (3 - 2 * rim))[..., None]
    # The whole colour is compressed, not each channel clipped: that would turn the core green.
    return np.clip(1.35 * light / (1.0 + light.max(axis=-1, keepdims=True)), 0.0, 1.0)


def main() -> None:
    """Write the map."""
    np.save(TARGET, np.round(255 * np.sqrt(band())).astype(np.uint8))  # not packed: that took 6 ms of every start


if __name__ == "__main__":
    main()
