"""Stills whose tiles a cluster draws: the same files, byte for byte, whatever is drawn and whoever dies, and no more held than without."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from blackhole_gl import cli, cluster, still_cluster
from blackhole_gl.output import png
from blackhole_gl.rendering import still_files, stills
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import SceneError, presets

ROOT = Path(__file__).resolve().parents[2]

# Presets, values, size and rays a pixel along each axis, of pictures in tiles of 64 pixels.
PICTURES: dict[str, tuple[list[str], dict[str, Any], tuple[int, int], int]] = {
    "glow over many bands, metered": (["kerr"], {"post.exposure_mode": "automatic", "post.bloom_intensity": 1.5, "post.bloom_threshold": 0.1}, (100, 700), 1),
    "smaller than a tile, three rays": (["kerr_0998_85"], {}, (40, 30), 3),
    "labels": (["kerr"], {"post.labels": True}, (160, 90), 1),
    "a scale fitted on the whole": (["kerr"], {"post.view": "steps"}, (160, 140), 1),
    "differences": (["kerr"], {"post.view": "difference"}, (96, 70), 1),
    "all light at once": (["kerr"], {"post.beam": True}, (150, 140), 2),
    "a medium": (["cloudy_slab"], {}, (130, 70), 1),
    "stars and things": (["orbiting_star"], {}, (130, 70), 1),
    "for two eyes": (["kerr"], {"camera.projection": "stereo"}, (160, 160), 1),
    "all round": (["kerr"], {"camera.projection": "equirectangular"}, (160, 80), 1),
    "a cube": (["kerr"], {"camera.projection": "cube"}, (480, 80), 1),
}


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    """A cluster of one worker, a process of its own: here is no second context."""
    from distributed import LocalCluster

    with LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None) as found:
        yield found.scheduler_address


def written(renderer: Renderer, path: Path, scene: Any, size: tuple[int, int], samples: int) -> bytes:
    shares = list(still_files.write(renderer, path, scene, 3.0, size, samples, 64))
    assert shares[-1] == 1.0 and all(before <= after for before, after in pairwise(shares))
    return path.read_bytes()


@pytest.mark.parametrize("name", PICTURES)
def test_a_picture_by_a_cluster_is_the_same_file(name: str, address: str, renderer: Renderer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stills, "_BAND_PIXELS", 1)  # bands as low as they can be
    layered, values, size, samples = PICTURES[name]
    scene = presets.load(layered, values)
    here = written(renderer, tmp_path / "a.png", scene, size, samples)
    assert png.read(tmp_path / "a.png").std() > 1.0, "it shows something"
    monkeypatch.setattr(renderer._stills, "_draw", None)  # no tile can be drawn here
    with still_cluster.spreading(renderer, address):
        assert written(renderer, tmp_path / "a.png", scene, size, samples) == here
    assert renderer.spread is None


def test_the_command_writes_what_it_writes_alone(address: str, renderer: Renderer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cli, "renderer_by", lambda backend: renderer)
    for name, more in (("a.png", {}), ("a.jpg", {}), ("linear.png", {"linear": True, "supersample": 2})):
        out, files = tmp_path / name, []
        for where in (None, address):
            with monkeypatch.context() as patched:
                if where is not None:
                    patched.setattr(renderer._stills, "_draw", None)
                cli.render(out, names=["kerr"], size="600x90", dask=where, **more)
            files.append(out.read_bytes())
        assert files[0] == files[1], name


@pytest.mark.parametrize("out", ["x.exr", "x.fits", "x.npz", None])
def test_what_cannot_be_spread_is_refused(out: str | None, tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"--dask: got .*; allowed is --out with a PNG or .jpg"):
        cli.render(tmp_path / out if out else None, names=["kerr"], flux=out is None, dask="tcp://127.0.0.1:9")
    assert not list(tmp_path.iterdir())


def test_a_mistake_met_by_a_worker_is_told_here(address: str, renderer: Renderer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def mistaken(*given: object) -> None:  # local, and so sent there as it is
        raise SceneError("sky.image", "got nothing; allowed is something")

    monkeypatch.setattr(still_cluster, "_drawn", mistaken)
    with still_cluster.spreading(renderer, address), pytest.raises(SceneError, match="sky.image: got nothing; allowed is something"):
        written(renderer, tmp_path / "a.png", presets.load(["kerr"]), (40, 30), 1)
    assert renderer.spread is None and not list(tmp_path.iterdir())


def test_a_worker_of_another_version_is_refused(address: str, renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster, "_version", lambda: "0.0.7")
    with pytest.raises(cluster.ClusterError, match=f"has version 0.0.7; allowed is {cluster.VERSION}"), still_cluster.spreading(renderer, address):
        pass
    assert renderer.spread is None


def test_work_that_ends_every_worker_is_told(address: str) -> None:
    from distributed import KilledWorker

    with pytest.raises(cluster.ClusterError, match="has ended one worker after the other"), cluster.connected(address):
        raise KilledWorker.__new__(KilledWorker)


class Counting:
    """A client whose workers have done all that is under way, in the order that suits them; counts how much that is."""

    def __init__(self, threads: int) -> None:
        self.threads, self.under_way, self.most, self.pieces = threads, 0, 0, []

    def nthreads(self) -> dict[str, int]:
        return {"a": self.threads}

    def submit(self, work: object, moments: object, size: object, samples: int, side: int, piece: list, kind: type, **how: object) -> Counting._Future:
        assert how == {"retries": cluster.RETRIES, "pure": False}
        self.under_way += 1
        self.most = max(self.most, self.under_way)
        self.pieces.append(piece)
        return self._Future(self, [np.full((1, 1, 4), number, kind) for number, _ in piece])

    class _Future:
        def __init__(self, client: Counting, lights: list[np.ndarray]) -> None:
            self._client, self._lights = client, lights

        def result(self) -> list[np.ndarray]:
            self._client.under_way -= 1
            return self._lights


@pytest.mark.parametrize("projection", ["perspective", "stereo"])
def test_no_more_is_drawn_ahead_than_the_workers_threads_take(projection: str) -> None:
    """Tiles come one after the other as they were wanted, strips of a pair's in pieces as large as a tile, and none is asked for long before."""
    scene, taken = presets.load(["kerr"], {"camera.projection": projection}), []

    def wanted() -> Iterator[tuple[int, tuple[int, int]]]:
        for number in range(1000):
            taken.append(number)
            yield number, (0, 0)

    client, in_one = Counting(2), 4 if projection == "stereo" else 1
    for number, (share, light) in enumerate(still_cluster._spread(client, [(scene, 0.0)], (128, 128), 1, 128, wanted(), np.float32)):  # type: ignore[arg-type]
        assert share == 1.0 and light is not None and light[0, 0, 0] == number
        assert len(taken) <= number + (2 * still_cluster.AHEAD + 1) * in_one
        if number == 500:
            client.threads = 1  # a worker has gone
    assert number == 999 and client.under_way == 0
    assert client.most == 2 * still_cluster.AHEAD and {len(piece) for piece in client.pieces} == {in_one}


@pytest.mark.slow
def test_two_workers_draw_the_same_poster_though_one_dies(renderer: Renderer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Processes of their own; one is killed when a third of the picture is there."""
    program = """
import os, signal, sys
from pathlib import Path
from distributed import LocalCluster
from blackhole_gl import still_cluster
from blackhole_gl.asked import renderer_by
from blackhole_gl.rendering import still_files, stills
from blackhole_gl.scene import presets

if __name__ == "__main__":
    stills._BAND_PIXELS = 1
    renderer = renderer_by("auto")
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        victim = list(cluster.workers.values())[0].pid
        killed = False
        with still_cluster.spreading(renderer, cluster.scheduler_address):
            for share in still_files.write(renderer, Path(sys.argv[1]), presets.load(["kerr"]), 3.0, (640, 1536), 2, 128):
                if share > 0.33 and not killed:
                    os.kill(victim, signal.SIGKILL)
                    killed = True
        assert killed
"""
    (tmp_path / "run.py").write_text(program, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "LP_NUM_THREADS": "1"}
    run = subprocess.run([sys.executable, tmp_path / "run.py", tmp_path / "a.png"], env=environment, capture_output=True, text=True, timeout=280)
    assert run.returncode == 0, run.stderr
    monkeypatch.setattr(stills, "_BAND_PIXELS", 1)
    for _ in still_files.write(renderer, tmp_path / "b.png", presets.load(["kerr"]), 3.0, (640, 1536), 2, 128):
        pass
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
