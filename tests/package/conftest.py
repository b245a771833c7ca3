"""A wheel of the checkout, and a virtual environment with that wheel's copy installed."""

from __future__ import annotations

import os
import subprocess
import sys
import sysconfig
import venv
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class InstalledCopy:
    """An environment whose `blackhole_gl` comes from the wheel and not from the checkout."""

    scripts: Path
    elsewhere: Path  # a folder that is not the checkout, to run in

    def run(self, *command: str | Path, timeout: float = 240) -> subprocess.CompletedProcess[str]:
        """Runs a script or the interpreter of the environment; stdin is closed and there is no display."""
        hidden = {"PYTHONPATH", "PYTHONHOME", "VIRTUAL_ENV", "DISPLAY", "WAYLAND_DISPLAY"}
        environment = {key: value for key, value in os.environ.items() if key not in hidden}
        return subprocess.run(
            [self.scripts / str(command[0]), *map(str, command[1:])],
            cwd=self.elsewhere, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=timeout,
        )


@pytest.fixture(scope="session")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Built with the hatchling of this environment: no network."""
    return wheel_of(ROOT, tmp_path_factory.mktemp("wheel"))


def wheel_of(sources: Path, folder: Path) -> Path:
    """A wheel of a folder or archive of sources, in `folder`."""
    command = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", "--no-index", "--wheel-dir", folder, sources]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=240)
    assert done.returncode == 0, done.stderr
    (built,) = folder.glob("*.whl")
    return built


@pytest.fixture(scope="session")
def sdist(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The archive of sources, built likewise."""
    folder = tmp_path_factory.mktemp("sdist")
    done = subprocess.run([sys.executable, "-m", "hatchling", "build", "-t", "sdist", "-d", folder], cwd=ROOT, capture_output=True, text=True, timeout=240)
    assert done.returncode == 0, done.stderr
    (built,) = folder.glob("*.tar.gz")
    return built


@pytest.fixture(scope="session")
def installed_copy(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> InstalledCopy:
    """The wheel in an environment of its own, which borrows the dependencies installed here through a .pth file.

    A .pth file inside a borrowed folder is not read, so the checkout's editable install stays out of sight.
    """
    folder = tmp_path_factory.mktemp("installed")
    builder = venv.EnvBuilder(with_pip=False, symlinks=os.name != "nt")
    context = builder.ensure_directories(folder / "venv")
    builder.create(folder / "venv")
    command = [sys.executable, "-m", "pip", "--python", context.env_exe, "install", "--quiet", "--no-deps", "--no-index", wheel]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=240)
    assert done.returncode == 0, done.stderr
    site_packages = subprocess.run(
        [context.env_exe, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"], capture_output=True, text=True, check=True
    ).stdout.strip()
    borrowed = dict.fromkeys(sysconfig.get_path(kind) for kind in ("purelib", "platlib"))
    (Path(site_packages) / "borrowed_dependencies.pth").write_text("\n".join(borrowed) + "\n", encoding="utf-8")
    elsewhere = folder / "another folder"
    elsewhere.mkdir()
    return InstalledCopy(Path(context.bin_path), elsewhere)
