"""Films: frames at exact times, kept until the film is whole, and packed without a lost or a doubled one."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import typing
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest

from blackhole_gl import cluster, film, film_cluster, films
from blackhole_gl.output import film_file, png, spherical
from blackhole_gl.physics import flight_files
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets

ROOT = Path(__file__).resolve().parents[2]
SIZE = (64, 36)
PATH = "rate = 4.0\n[[keys]]\nat = 0\ncamera.azimuth_deg = 0.0\n[[keys]]\nat = 1\ncamera.azimuth_deg = 60.0\n"


@pytest.fixture(scope="module")
def made() -> film.Film:
    return film.Film(flight_files.parse(PATH, presets.load(["kerr"])), Fraction(8), 9, SIZE)


@pytest.fixture(scope="module")
def drawn(made: film.Film, renderer: Renderer, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("film") / "x.mp4.frames"
    film.begin(made, folder)
    assert film.draw(made, folder, range(9), renderer) == 9
    return folder


def test_a_frame_is_what_render_draws_at_its_time(made: film.Film, drawn: Path, renderer: Renderer) -> None:
    for number in (0, 5, 8):
        moment = made.flight.at(number / 8.0)
        renderer.render_still(moment.scene, moment.time, SIZE)
        assert np.array_equal(png.read(film.frame_path(drawn, number)), renderer.read_rgb8())
        assert presets.load([str(film.frame_path(drawn, number))]) == moment.scene


def test_a_film_that_was_stopped_twice_goes_on_with_the_first_missing_frame(
    made: film.Film, drawn: Path, renderer: Renderer, tmp_path: Path
) -> None:
    folder = tmp_path / "frames"
    shares: list[float] = []

    def stop(share: float) -> None:
        shares.append(share)
        if len(shares) % 4 == 0:
            raise KeyboardInterrupt

    for _ in range(2):
        film.begin(made, folder)
        with pytest.raises(KeyboardInterrupt):
            film.draw(made, folder, range(9), renderer, stop)
    assert film.missing(made, folder, range(9)) == [8]
    film.begin(made, folder)
    assert film.draw(made, folder, range(9), renderer) == 1
    for number in range(9):
        assert film.frame_path(folder, number).read_bytes() == film.frame_path(drawn, number).read_bytes()


def test_frames_of_another_film_are_not_mixed_in(made: film.Film, drawn: Path) -> None:
    other = film.Film(made.flight, made.fps, 10, SIZE)
    with pytest.raises(film.FilmError, match="holds frames of another film"):
        film.begin(other, drawn)
    film.begin(made, drawn)


@pytest.mark.parametrize("name", ["x.mp4", "x.mov", "x.webm"])
def test_a_packed_film_has_every_frame_at_its_time(made: film.Film, drawn: Path, tmp_path: Path, name: str) -> None:
    out = tmp_path / name
    film.encode(made, drawn, out, film.codec_of(out, None))
    assert [path.name for path in tmp_path.iterdir()] == [name]
    with av.open(str(out)) as container:
        stream = container.streams.video[0]
        assert stream.average_rate == 8
        frames = list(container.decode(video=0))
        assert [float(frame.pts * frame.time_base) for frame in frames] == pytest.approx([k / 8.0 for k in range(9)], abs=1e-3)
        assert "camera.azimuth_deg" in container.metadata.get("comment", container.metadata.get("COMMENT", ""))
    for number, frame in enumerate(frames):
        shown = frame.reformat(format="rgb24", src_colorspace="ITU709").to_ndarray().astype(int)
        apart = [np.abs(shown - png.read(film.frame_path(drawn, k))).mean() for k in range(9)]
        # Half of the colours' resolution and the packing cost up to 3 levels of 255 in such small pictures of stars.
        assert apart[number] < 4.0
        if 2 < number < 6:  # at its ends the flight rests nearly, and its frames are alike
            assert np.argmin(apart) == number


def test_the_encoder_takes_its_settings(made: film.Film, drawn: Path, tmp_path: Path) -> None:
    """FFmpeg passes over an option that it does not know; x264 writes into the file what it went by."""
    if film_file.encoders().get("h264") != "libx264":
        pytest.skip("PyAV has no x264 here")
    film.encode(made, drawn, tmp_path / "x.mp4", "h264")
    packed = (tmp_path / "x.mp4").read_bytes()
    for setting in (b" crf=16.0 ", b" me=dia ", b" subme=1 ", b":0 me="):  # the last: partitions of P and B pictures, none
        assert setting in packed, setting


def test_a_film_that_is_packed_while_it_is_drawn_is_the_same(made: film.Film, drawn: Path, renderer: Renderer, tmp_path: Path) -> None:
    """Stopped and gone on with, too: what is there comes from its files. Same are the pictures that the encoder is given: what it makes of the same
    ones, in one process on one machine, has been seen to vary now and then."""
    film.encode(made, drawn, tmp_path / "after.mp4", "h264")
    folder, stopped = tmp_path / "frames", []
    packed: list[np.ndarray] = []
    film.begin(made, folder)

    def stop(share: float) -> None:
        stopped.append(share)
        if len(stopped) == 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt), film.packing_of(made, tmp_path / "while.mp4", "h264") as pack:
        film.draw(made, folder, range(9), renderer, stop, pack)
    assert not list(tmp_path.glob("*while*")), "half a film is none"
    with film.packing_of(made, tmp_path / "while.mp4", "h264") as pack:

        def keep_and_pack(pixels: np.ndarray) -> None:
            packed.append(pixels.copy())
            pack(pixels)

        assert film.draw(made, folder, range(9), renderer, None, keep_and_pack, stays=False) == 5
    for number in range(9):  # the first four small, the others as they are
        same = png.read(film.frame_path(drawn, number))
        assert np.array_equal(png.read(film.frame_path(folder, number)), same)
        assert np.array_equal(packed[number], same)
        assert png.read_scene_text(film.frame_path(folder, number)) == png.read_scene_text(film.frame_path(drawn, number))
    assert len(packed) == 9
    shown = []
    for name in ("after", "while"):
        with av.open(str(tmp_path / f"{name}.mp4")) as container:
            shown.append(np.array([frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)], int))
    assert shown[0].shape == (9, SIZE[1], SIZE[0], 3)
    # A quarter of what packing costs a picture of these (2.5 levels in the mean).
    assert np.abs(shown[0] - shown[1]).mean(axis=(1, 2, 3)).max() < 0.6


def test_a_shutter_gathers_light_from_the_frames_moment_on(made: film.Film, renderer: Renderer, tmp_path: Path) -> None:
    blurred = film.Film(made.flight, Fraction(1), 2, SIZE, shutter_deg=180.0)
    times = [moment.time for moment in blurred.moments(0)]
    assert times == pytest.approx(4.0 * (np.arange(8) + 0.5) / 16)
    film.begin(blurred, tmp_path / "b")
    film.draw(blurred, tmp_path / "b", [0], renderer)
    found = png.read(film.frame_path(tmp_path / "b", 0))
    single = []
    for moment in blurred.moments(0):
        renderer.render_still(moment.scene, moment.time, SIZE)
        single.append(renderer.read_rgb8())
    # The tone map is monotone, and so the mean of light lies between the darkest and the brightest moment; dithering adds a level on both sides.
    within = (found.astype(int) >= np.min(single, axis=0).astype(int) - 2) & (found.astype(int) <= np.max(single, axis=0).astype(int) + 2)
    assert within.mean() > 0.995
    assert np.abs(found.astype(int) - single[4]).mean() > 0.3, "it is not one of them"


def test_the_command_shares_out_frames_and_packs_when_all_are_there(renderer: Renderer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(films, "renderer_by", lambda backend: renderer)
    out, path = tmp_path / "x.mp4", tmp_path / "path.toml"
    path.write_text(PATH, encoding="utf-8")
    for share in ("0:3", "3:"):
        films.video(out, names=["kerr"], path=path, fps="4", size="32x18", frames=share)
        assert out.exists() == (share == "3:")
    assert not film.frames_folder(out).exists()
    with av.open(str(out)) as container:
        assert sum(1 for _ in container.decode(video=0)) == 5, "the flight's last moment is on the last frame"
    films.video(tmp_path / "pictures", names=["kerr"], fps="5", seconds=0.4, size="32x18")
    assert sorted(path.name for path in (tmp_path / "pictures").glob("*.png")) == ["frame_000000.png", "frame_000001.png"]


def test_a_job_array_shares_out_all_frames(monkeypatch: pytest.MonkeyPatch) -> None:
    shares = []
    for index in range(2, 9):
        for name, value in (("ID", index), ("MIN", 2), ("COUNT", 7)):
            monkeypatch.setenv(f"SLURM_ARRAY_TASK_{name}", str(value))
        shares += films._share("slurm", 100)
    assert shares == list(range(100))
    monkeypatch.delenv("SLURM_ARRAY_TASK_ID")
    with pytest.raises(ValueError, match="allowed within a job array"):
        films._share("slurm", 100)


@pytest.mark.slow
def test_a_cluster_draws_the_same_frames_though_a_worker_dies(made: film.Film, drawn: Path, tmp_path: Path) -> None:
    """Two workers, processes of their own; one is killed when the first frame is there."""
    program = """
import os, pickle, signal, sys
from pathlib import Path
from distributed import LocalCluster
from blackhole_gl import film, film_cluster

if __name__ == "__main__":
    made, folder = pickle.loads(Path(sys.argv[1]).read_bytes()), Path(sys.argv[2])
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        victim = list(cluster.workers.values())[0].pid
        killed = []

        def kill(share):
            if not killed:
                killed.append(os.kill(victim, signal.SIGKILL))

        assert film_cluster.draw(made, folder, range(made.count), cluster.scheduler_address, kill) == made.count and killed
"""
    (tmp_path / "run.py").write_text(program, encoding="utf-8")
    (tmp_path / "film").write_bytes(pickle.dumps(made))
    folder = tmp_path / "frames"
    film.begin(made, folder)
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "LP_NUM_THREADS": "1"}
    run = subprocess.run([sys.executable, tmp_path / "run.py", tmp_path / "film", folder], env=environment, capture_output=True, text=True, timeout=280)
    assert run.returncode == 0, run.stderr
    for number in range(made.count):
        assert np.array_equal(png.read(film.frame_path(folder, number)), png.read(film.frame_path(drawn, number)))


def test_a_cluster_that_is_not_there_is_told(made: film.Film, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import dask
    import distributed  # noqa: F401  its defaults, had they come while the timeout is set, would go with it, for the tests after this one too

    with dask.config.set({"distributed.comm.timeouts.connect": "0.2s"}), pytest.raises(cluster.ClusterError, match="--dask: got 'tcp://127.0.0.1:9'"):
        film_cluster.draw(made, tmp_path, range(1), "tcp://127.0.0.1:9")
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(cluster.ClusterError, match=r"pip install 'blackhole-gl\[cluster\]'"):
        film_cluster.draw(made, tmp_path, range(1), "tcp://127.0.0.1:9")


WRONG = (
    ({"out": "x.avi"}, "got the suffix .avi; allowed is .mp4, .mov, .webm, .mkv, or a name without one"),
    ({"codec": "mpeg2"}, "--codec: got 'mpeg2'; allowed is one of h264, h265, vp9, av1, prores"),
    ({"codec": "prores"}, "--codec: got prores in a .mp4 file; allowed there is h264, h265, av1"),
    ({"size": "33x18"}, "--size: got 33x18; allowed with h264 are even numbers"),
    ({"fps": "0"}, "--fps: got '0'; allowed is a number up to 1000"),
    ({"fps": "1/0"}, "--fps: got '1/0'"),
    ({"seconds": None}, "--seconds: missing"),
    ({"seconds": 0.001}, "which is 0 frames"),
    ({"frames": "5"}, "--frames: got '5'; allowed is FIRST:END within 0:30"),
    ({"frames": "40:50"}, "--frames: got '40:50'"),
    ({"path": Path("none.toml")}, "none.toml: cannot be read"),
)


@pytest.mark.parametrize("values, words", WRONG, ids=lambda value: "" if isinstance(value, str) else str(value))
def test_what_cannot_be_is_told_before_anything_is_drawn(values: dict, words: str, tmp_path: Path) -> None:
    given = {"out": "x.mp4", "seconds": 1.0, "size": "32x18", **values}
    with pytest.raises(ValueError) as told:
        films.video(tmp_path / given.pop("out"), names=["kerr"], **given)
    assert words in str(told.value)
    assert list(tmp_path.iterdir()) == []


def test_the_help_names_the_codecs_that_there_are() -> None:
    told = typing.get_type_hints(films.video, include_extras=True)["codec"].__metadata__[0].help
    assert told == f"One of {', '.join(film.CODECS)}."


@pytest.mark.parametrize("name", ["x.mp4", "x.mov"])
@pytest.mark.parametrize("projection", ["equirectangular", "stereo", "perspective"])
def test_a_film_all_round_says_so_to_players(projection: str, name: str, tmp_path: Path) -> None:
    """FFmpeg finds the box that Google's players look for, and tells of each frame what it is; of other films it tells nothing."""
    scene = presets.load(["kerr"], {"camera.projection": projection})
    made = film.Film(flight_files.parse(PATH, scene), Fraction(8), 3, SIZE)
    picture = np.random.default_rng(1).integers(0, 256, (36, 64, 3), dtype=np.uint8)
    with film.packing_of(made, tmp_path / name, film.codec_of(tmp_path / name, None)) as pack:
        for _ in range(3):
            pack(picture)
    with av.open(str(tmp_path / name)) as container:
        frames = list(container.decode(video=0))
    assert len(frames) == 3
    for shown in frames:
        told = {data.type.name: bytes(data) for data in shown.side_data.keys()}
        assert ("SPHERICAL" in told) == (projection != "perspective")
        if "SPHERICAL" in told:
            assert int.from_bytes(told["SPHERICAL"][:4], sys.byteorder) == 0, "AV_SPHERICAL_EQUIRECTANGULAR"
            pair = told.get("STEREO3D", bytes(4))
            assert int.from_bytes(pair[:4], sys.byteorder) == (2 if projection == "stereo" else 0), "AV_STEREO3D_TOPBOTTOM, AV_STEREO3D_2D"


def test_a_file_of_another_kind_is_not_marked(tmp_path: Path) -> None:
    path = tmp_path / "x.mp4"
    path.write_bytes(bytes.fromhex("0000000866726565"))
    with pytest.raises(ValueError, match="allowed is one that ends with 'moov'"):
        spherical.mark(path, pair=False)
    assert path.read_bytes() == bytes.fromhex("0000000866726565")
