"""The commands that write numbers in place of a picture: trace, curve, visibilities, profile, lightcurve, polarization and ring."""

from __future__ import annotations

import cmath
import math
import sys
from pathlib import Path
from typing import Annotated

from .arguments import Option
from .asked import (
    AnyFile,
    Backend,
    Named,
    OneUnit,
    Presets,
    Settings,
    asked_for,
    before_drawing,
    numbers_of,
    refuse_unmet,
    renderer_by,
    size_of,
    tell_warnings,
    time_of,
    unit_of,
)
from .output.files import refuse_unwritable, write_whole
from .output.progress import Progress
from .scene.lengths import factor


def trace(
    rays: Annotated[Path, Option(help="CSV with columns psi,chi (radians), or alpha,beta (M) with camera.distance=inf.")],
    out: Annotated[Path, Option("--out", "-o", help="The CSV to write, a row a ray. - is standard output.")],
    names: Named = None,
    preset: Presets = None,
    set_: Settings = None,
    any_file: AnyFile = False,
    float64: Annotated[bool, Option("--float64", help="Use the NumPy float64 reference instead of the shader.")] = False,
    lengths: OneUnit = None,
    backend: Backend = "auto",
) -> None:
    """Trace listed rays through the shader that pictures use.

    psi is the angle from the direction to the hole's centre, chi the angle on the screen from right (+e_φ) towards up (north).
    """
    from . import listed_rays

    scene, _ = asked_for(names, preset, set_, any_file)
    refuse_unwritable(out, (".csv", ".txt"), "CSV")
    unit = None if lengths is None else unit_of(lengths)
    listed = listed_rays.read(rays, scene, unit or "M")
    refuse_unmet(scene, set_)
    if float64:
        found = listed_rays.trace_by_reference(scene, listed.values)
    else:
        tell_warnings(scene)
        found = listed_rays.trace_by_shader(renderer_by(backend), scene, listed.values)
    listed_rays.write(out, scene, found, 17 if float64 else 9, listed, unit)


def curve(
    out: Annotated[Path, Option("--out", "-o", help="The CSV to write, a row a point. - is standard output.")],
    names: Named = None,
    preset: Presets = None,
    set_: Settings = None,
    any_file: AnyFile = False,
    radii: Annotated[str, Option(help="Circles of the disk's plane, in r_s unless --lengths says otherwise, with commas.", default="none")] = "",
    orders: Annotated[str, Option(help="Their images: 0 direct, 1 first ring, 2 second, and so on, with commas.")] = "0,1",
    samples: Annotated[int, Option(least=8, most=100_000, help="Points a curve.")] = 512,
    size: Annotated[str, Option(help="Width × height of the picture that pixels are counted in.")] = "1280x720",
    lengths: OneUnit = None,
) -> None:
    """Write where closed forms put the critical curve, and circles of the disk's plane by each order of image: in M, µas and pixels."""
    from .measure import curves

    scene, _ = asked_for(names, preset, set_, any_file)
    refuse_unwritable(out, (".csv", ".txt"), "CSV")
    unit = None if lengths is None else unit_of(lengths)
    circles = [radius / factor(unit or "r_s") for radius in numbers_of(radii, float, "--radii")]
    found = curves.measured(scene, circles, numbers_of(orders, int, "--orders"), samples)
    write_whole(out, curves.as_csv(found, scene, size_of(size), unit).encode())


def visibilities(
    out: Annotated[Path | None, Option("--out", "-o", help="The CSV to write, a row a baseline or triangle. - is standard output.")] = None,
    names: Named = None,
    preset: Presets = None,
    set_: Settings = None,
    any_file: AnyFile = False,
    baselines: Annotated[Path | None, Option(help="CSV with columns u,v in wavelengths, towards east and north: amplitudes and phases.")] = None,
    triangles: Annotated[Path | None, Option(help="CSV with columns u1,v1,u2,v2 of two sides: closure phases, and the three amplitudes.")] = None,
    sky: Annotated[Path | None, Option(help="Also write the picture as FITS that ehtim reads, in Jy a pixel.")] = None,
    flux: Annotated[float, Option(least=0.0, most=1e6, help="The whole picture's flux in Jy.")] = 1.0,
    frequency: Annotated[float, Option(least=1e-3, most=1e9, help="GHz, for the FITS file.")] = 230.0,
    at: Annotated[str, Option(help="Right ascension and declination in degrees, for the FITS file.")] = "0,0",
    size: Annotated[str, Option(help="Width × height in pixels of the picture that is measured.")] = "400x400",
    time: Annotated[float | None, Option(help="Scene time in r_s/c. When not given: that of a saved picture or scene, or 0.")] = None,
    backend: Backend = "auto",
) -> None:
    """Write what an interferometer measures of a picture: visibilities on given baselines, or closure phases of triangles."""
    from . import layers, number_lists
    from .measure import visibilities as measured

    scene, preset = asked_for(names, preset, set_, any_file)
    given = [(path, columns) for path, columns in ((baselines, measured.BASELINES), (triangles, measured.TRIANGLES)) if path is not None]
    if (out is None) != (not given) or len(given) > 1 or (out is None and sky is None):
        raise ValueError("visibilities: allowed is --out with one of --baselines and --triangles, or --sky, or both")
    for path, suffixes, what in ((out, (".csv", ".txt"), "CSV"), (sky, (".fits",), "FITS")):
        if path is not None:
            refuse_unwritable(path, suffixes, what)
    place = numbers_of(at, float, "--at")
    if len(place) != 2:
        raise ValueError(f"--at: got {at!r}; allowed are right ascension and declination in degrees, e.g. 187.7059,12.3911")
    listed = [number_lists.read(path, columns, "this option", {}, measured.WRITTEN) for path, columns in given]
    before_drawing(scene, set_)
    picture = measured.sky_picture(renderer_by(backend), scene, time_of(time, preset), size_of(size), scene.rays.in_stills)
    if sky is not None:
        layers.write_sky(sky, picture, scene, time_of(time, preset), flux, 1e9 * frequency, (place[0], place[1]))
    if out is not None:
        write_whole(out, measured.as_csv(measured.of_list(picture, listed[0]), listed[0], flux).encode())


def profile(
    out: Annotated[Path, Option("--out", "-o", help="The CSV to write, a row a bin of g = E_infinity/E_emitter. - is standard output.")],
    names: Named = None,
    preset: Presets = None,
    set_: Settings = None,
    any_file: AnyFile = False,
    emissivity: Annotated[float, Option(least=-5.0, most=10.0, help="q of the line's power, r^-q.")] = 3.0,
    bins: Annotated[int, Option(least=10, most=2000, help="Bins between the least g and the largest.")] = 200,
    backend: Backend = "auto",
) -> None:
    """Write the profile of a narrow line from the whole disk, of each order of image, and say what share of the light each has."""
    from .measure import line_profile

    scene, _ = asked_for(names, preset, set_, any_file)
    refuse_unwritable(out, (".csv", ".txt"), "CSV")
    line_profile.refuse(scene)
    before_drawing(scene, set_)
    found = line_profile.measure(renderer_by(backend), scene, index=emissivity, bins=bins)
    write_whole(out, found.as_csv().encode())
    for name, share in zip(line_profile.ORDERS, found.shares, strict=True):
        print(f"{name:12} {100.0 * share:.3g} % of the light", file=sys.stderr)
    print(f"mean g       {found.mean:.4f}", file=sys.stderr)


def lightcurve(
    out: Annotated[Path, Option("--out", "-o", help="The CSV to write, a row a time. - is standard output.")],
    names: Named = None,
    preset: Presets = None,
    set_: Settings = None,
    any_file: AnyFile = False,
    plot: Annotated[Path | None, Option("--plot", help="A PNG of the curve, to be written too.")] = None,
    count: Annotated[int, Option("--times", least=2, most=100_000, help="Pictures that the curve is made of.")] = 96,
    start: Annotated[float, Option(help="Scene time in r_s/c of the first.")] = 0.0,
    duration: Annotated[float, Option(least=0.0, help="In r_s/c; 0: one turn of the hot spot, or else of what moves.")] = 0.0,
    size: Annotated[str, Option(help="Width × height in pixels of the pictures.")] = "320x180",
    backend: Backend = "auto",
) -> None:
    """Write the light of the whole picture against time, and plot it: with --set rays.light_travel=true each part of it as late as its light arrives."""
    from .measure import light_curve
    from .measure.plot import plotted
    from .output import png

    scene, _ = asked_for(names, preset, set_, any_file)
    refuse_unwritable(out, (".csv", ".txt"), "CSV")
    if plot is not None:
        refuse_unwritable(plot, (".png",), "PNG")
    light_curve.refuse(scene)
    before_drawing(scene, set_)
    with Progress("light curve") as progress:
        found = light_curve.measure(renderer_by(backend), scene, light_curve.times(scene, count, start, duration), size_of(size), progress)
    write_whole(out, found.as_csv().encode())
    if plot is not None:
        png.write(plot, plotted(found.time, {"light over its mean": found.relative}, ("scene time, r_s/c", "")))
    print(f"brightest    {found.relative.max():.4g} of the mean at {found.time[found.flux.argmax()]:.5g} r_s/c", file=sys.stderr)
    print(f"faintest     {found.relative.min():.4g} of the mean at {found.time[found.flux.argmin()]:.5g} r_s/c", file=sys.stderr)


def polarization(
    out: Annotated[Path, Option("--out", "-o", help="The NumPy archive to write: I, Q and U of each pixel, top row first. - is standard output.")],
    names: Named = None,
    preset: Presets = None,
    set_: Settings = None,
    any_file: AnyFile = False,
    size: Annotated[str, Option(help="Width × height in pixels.")] = "640x360",
) -> None:
    """Write how the light of the disk is polarized, pixel by pixel, and say how much of it is, along what, and beta_2."""
    from .measure import polarization_maps

    scene, _ = asked_for(names, preset, set_, any_file)
    refuse_unwritable(out, (".npz",), "a NumPy archive")
    with Progress("polarization") as progress:
        found = polarization_maps.measure(scene, size_of(size), progress)
    write_whole(out, found.as_npz())
    share, angle = found.net
    print(f"polarized    {100.0 * found.mean_share:.3g} % of the light, {100.0 * share:.3g} % of all together, along {angle:.2f}°", file=sys.stderr)
    print(f"beta_2       {abs(found.beta_2):.4f}, phase {math.degrees(cmath.phase(found.beta_2)):.2f}°", file=sys.stderr)


def ring(
    names: Named = None,
    preset: Presets = None,
    set_: Settings = None,
    any_file: AnyFile = False,
    size: Annotated[str, Option(help="Width × height in pixels of the picture that is measured.")] = "600x600",
    time: Annotated[float | None, Option(help="Scene time in r_s/c. When not given: that of a saved picture or scene, or 0.")] = None,
    backend: Backend = "auto",
) -> None:
    """Measure the ring in a picture: diameter, width, asymmetry and beta_2, of the light as it comes and through the scene's beam."""
    from .measure import ring as ring_measure

    scene, preset = asked_for(names, preset, set_, any_file)
    ring_measure.refuse(scene)
    before_drawing(scene, set_)
    found = ring_measure.measure(renderer_by(backend), scene, time_of(time, preset), size_of(size))
    print(ring_measure.text(found, scene), end="")
