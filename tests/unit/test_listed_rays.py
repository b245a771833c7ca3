"""What `trace` writes for each ray: columns that stay where they are, and values that come back as they were."""

from __future__ import annotations

import csv
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from blackhole_gl import listed_rays
from blackhole_gl.glsl.declared import Fate
from blackhole_gl.number_lists import ListError
from blackhole_gl.physics import disk_profile, relativity
from blackhole_gl.planning import plan
from blackhole_gl.scene import Scene, presets

RAYS = np.array([[0.2, 1.0], [0.4, 4.5], [0.25, 5.0], [0.3, 3.8], [0.19, 1.5], [0.01, 0.0], [3.0, 2.0]])


def scene_of(**changes) -> Scene:
    values = {"hole.spin": 0.9, "camera.distance": 15.0, "camera.inclination_deg": 70.0}
    return presets.load(["kerr"], values | {key.replace("__", "."): value for key, value in changes.items()})


def written(path: Path, traced: listed_rays.TracedRays) -> list[dict[str, str]]:
    listed_rays.write(path, scene_of(), traced, 17)
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_the_columns_of_crossings_come_in_turn_and_those_of_momenta_at_the_end(tmp_path: Path) -> None:
    rows = written(tmp_path / "hits.csv", listed_rays.trace_by_reference(scene_of(), RAYS))
    assert list(rows[0]) == (
        "fate theta phi steps evaluations r0 phi0 g0 r1 phi1 g1 r2 phi2 g2 lambda theta0 k_r0 k_theta0 theta1 k_r1 k_theta1 theta2 k_r2 k_theta2 energy "
        "intensity0 intensity1 intensity2 t0 t1 t2"
    ).split()


def test_what_is_written_is_what_was_found_and_is_light(tmp_path: Path) -> None:
    traced = listed_rays.trace_by_reference(scene_of(), RAYS)
    rows = written(tmp_path / "hits.csv", traced)
    assert [row["fate"] for row in rows] == [listed_rays.FATES[fate] for fate in traced.fate]
    found = 0
    for i, row in enumerate(rows):
        assert float(row["lambda"]) == traced.lambda_[i]
        for n in range(3):
            if row[f"r{n}"] == "":
                assert row[f"theta{n}"] == row[f"k_r{n}"] == row[f"k_theta{n}"] == ""
                continue
            found += 1
            r, theta, k_r, k_theta = (float(row[f"{name}{n}"]) for name in ("r", "theta", "k_r", "k_theta"))
            assert theta == pytest.approx(0.5 * math.pi, abs=1e-12)
            # A dozen steps of 1e-12 each.
            assert relativity.null_residual(r, theta, 0.9, traced.lambda_[i], k_r, k_theta) < 1e-10
    assert found >= 4


def test_orders_that_the_scene_does_not_keep_are_empty() -> None:
    one, three = (listed_rays.trace_by_reference(scene_of(rays__orders=orders), RAYS) for orders in (1, 3))
    for name in ("crossing_r", "crossing_theta", "crossing_k_r", "crossing_k_theta"):
        np.testing.assert_array_equal(getattr(one, name)[:, 0], getattr(three, name)[:, 0])
        assert np.isnan(getattr(one, name)[:, 1:]).all()


def test_parameters_reach_the_twin_that_declares_them() -> None:
    scene = scene_of(rays__model="kerr_like")
    turned, still = (listed_rays.trace_by_reference(scene.with_values({"rays.kerr_like.drag": drag}), RAYS) for drag in (5.0, 0.0))
    np.testing.assert_allclose(turned.crossing_r, still.crossing_r, rtol=1e-10)  # the twist moves nothing in r
    assert np.nanmax(np.abs(turned.crossing_phi - still.crossing_phi)) > 0.01


def test_a_table_has_the_twin_of_its_orbits() -> None:
    models = ("schwarzschild", "schwarzschild_table")
    marched, looked_up = (listed_rays.trace_by_reference(scene_of(hole__spin=0.0, rays__model=model), RAYS) for model in models)
    np.testing.assert_array_equal(marched.crossing_r, looked_up.crossing_r)


def test_rays_of_which_nothing_is_known_are_written_empty(tmp_path: Path) -> None:
    nothing = listed_rays.unknown(2)
    rows = written(tmp_path / "hits.csv", replace(nothing, lambda_=np.array([1.5, np.nan])))
    assert [row["fate"] for row in rows] == ["unresolved", "unresolved"]
    assert [row["lambda"] for row in rows] == ["1.5", ""]
    assert all(value == "" for name, value in rows[0].items() if name not in {"fate", "steps", "evaluations", "lambda"})


def test_intensities_are_those_of_the_disks_law_by_its_shift() -> None:
    scene = scene_of(disk__outer_radius=8.0)
    traced = listed_rays.trace_by_reference(scene, RAYS)
    found = listed_rays.intensities(scene, traced)
    made = plan(scene)
    on = (traced.crossing_r >= made.disk_inner) & (traced.crossing_r <= 8.0)
    assert on.any() and np.array_equal(np.isnan(found), np.isnan(traced.crossing_r))
    assert np.all(found[~on & ~np.isnan(found)] == 0.0)
    flux = disk_profile.page_thorne_flux(traced.crossing_r[on], 0.9) / disk_profile.page_thorne_flux(np.linspace(made.disk_inner, 8.0, 20_001), 0.9).max()
    # The law is scanned for its peak at 4096 radii, twice refined; here at 20,001, so that the two are within 1e-7.
    assert np.allclose(found[on], flux * (traced.crossing_g / traced.energy[:, None])[on] ** 4, rtol=1e-6)
    dark = listed_rays.intensities(scene.with_values({"disk.enabled": False}), traced)
    assert np.nanmax(dark) == 0.0


def test_the_reference_says_that_it_knows_no_things() -> None:
    scene = scene_of().with_values({"things.ring.kind": "annulus"})
    with pytest.raises(ListError, match="no things"):
        listed_rays.trace_by_reference(scene, RAYS)
    assert listed_rays.FATES[Fate.MET] == "met"


@pytest.mark.parametrize(
    "text, says",
    [
        ("psi,chi\n0.1,2\n3.2,1\n", r"line 3, column psi: got '3.2'; allowed is 0 to π"),
        ("psi,chi\n-0.1,2\n", r"line 2, column psi: got '-0.1'; allowed is 0 to π"),
        ("psi,chi\n0.1,inf\n", "line 2, column chi: got 'inf'; allowed is a finite number"),
        ('psi,chi\n0.1,"0,5"\n', "line 2, column chi: got '0,5'; .*write 0.5, not 0,5"),
        ("psi,chi\n0,5,1,2\n", "line 2: 4 values for 2 columns; .*0.5, not 0,5"),
        ("psi;chi\n0.1;2\n", "column psi is missing; .*separated by commas"),
        ("psi,chi,fate\n0.1,2,x\n", "column fate is there twice"),
        ("psi,chi\n0.1,\x00\xff", "not UTF-8"),
    ],
)
def test_a_list_that_cannot_be_used_is_told_with_file_and_place(tmp_path: Path, text: str, says: str) -> None:
    path = tmp_path / "rays.csv"
    path.write_bytes(text.encode("latin-1") if "\xff" in text else text.encode())
    with pytest.raises(ListError, match=rf"rays\.csv.*{says}"):
        listed_rays.read(path, scene_of())


def test_the_ends_of_the_range_of_angles_are_allowed(tmp_path: Path) -> None:
    path = tmp_path / "rays.csv"
    path.write_text(f"psi,chi\n0,-40\n{math.pi:.17g},40\n")
    assert listed_rays.read(path, scene_of()).values.tolist() == [[0.0, -40.0], [math.pi, 40.0]]
