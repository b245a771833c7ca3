"""Imports run one way, so that each part can be read, tested and used without what stands above it."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "blackhole_gl"

# Lowest first. A part imports from rows below its own and from itself, never sideways or upwards.
LAYERS = (
    {"resources", "shapes", "text_files", "worker"},
    {"arguments", "number_lists"},
    {"output"},
    {"scene"},
    {"physics"},
    {"planning", "glsl"},
    {"rendering"},
    {"gl_process", "listed_rays"},
    {"gl_thread"},
    {"measure"},
    {"app"},
    {"cluster", "desktop", "film", "layers", "renderers", "self_check"},
    {"api"},
    {"asked", "notebook"},
    {"film_cluster", "still_cluster"},
    {"films", "research"},
    {"cli"},
    {"__main__"},
)
RANK = {part: rank for rank, row in enumerate(LAYERS) for part in row}

# The float64 twins share no code with what they check, so that a mistake cannot hide in both; of the rest of the package they know the
# closed forms, which have tests of their own, and the names of array types.
INDEPENDENT = {
    "reference": {
        *("physics.circling", "physics.deflection", "physics.plunging", "physics.relativity", "physics.torus"),
        *("shapes.Bool", "shapes.Float", "shapes.Int"),
    }
}

# Third-party packages that only some modules may import: everything else must work without them.
CONFINED = {
    "imgui_bundle": ("app",),
    "glfw": ("app", "rendering/context.py"),
    "jaxtyping": ("shapes.py",),
    "matplotlib": (),
    "platformdirs": ("resources.py",),
}
TEST_AND_TOOL_PACKAGES = {"scipy", "colour", "pytest", "hypothesis"}

MODULES = sorted(path for path in PACKAGE.rglob("*.py") if path != PACKAGE / "__init__.py")


def part_of(path: Path) -> str:
    """The name in LAYERS that a module belongs to: its file's or its folder's, right below the package."""
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def imports(path: Path) -> Iterator[tuple[int, str]]:
    """(line, absolute dotted name) of every import in a file, those inside functions too."""
    here = ("blackhole_gl", *path.relative_to(PACKAGE).with_suffix("").parts)
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield node.lineno, alias.name
        elif isinstance(node, ast.ImportFrom):
            base = list(here[: -node.level]) if node.level else []
            base += node.module.split(".") if node.module else []
            for alias in node.names:
                yield node.lineno, ".".join([*base, alias.name])


def imported_parts(path: Path) -> Iterator[tuple[int, str, str]]:
    """(line, part, dotted name below the package) of every import from the package itself."""
    for line, name in imports(path):
        package, _, rest = name.partition(".")
        if package == "blackhole_gl" and rest:
            part = rest.partition(".")[0]
            # `from blackhole_gl import __version__` and the like name no part.
            if (PACKAGE / part).is_dir() or (PACKAGE / f"{part}.py").is_file():
                yield line, part, rest


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.relative_to(PACKAGE).as_posix())
def test_imports_run_one_way(path: Path) -> None:
    own = part_of(path)
    assert own in RANK or own in INDEPENDENT, f"{own} stands in no layer: put it into LAYERS in {Path(__file__).name}"
    for line, part, name in imported_parts(path):
        if part == own:
            continue
        where = f"{path.relative_to(PACKAGE.parent)}:{line}"
        if own in INDEPENDENT:
            assert name in INDEPENDENT[own], f"{where}: {own} is to be independent, and imports {name}"
        elif part in INDEPENDENT:
            assert RANK[own] > RANK["planning"], f"{where}: {own} imports the reference it is checked against"
        else:
            assert RANK.get(part, len(LAYERS)) < RANK[own], f"{where}: {own} imports {part}, which does not stand below it"


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.relative_to(PACKAGE).as_posix())
def test_third_party_packages_stay_where_they_belong(path: Path) -> None:
    relative = path.relative_to(PACKAGE).as_posix()
    for line, name in imports(path):
        package = name.partition(".")[0]
        assert package not in TEST_AND_TOOL_PACKAGES, f"{relative}:{line}: {package} is for tests and tools only"
        homes = CONFINED.get(package)
        if homes is not None:
            assert relative in homes or part_of(path) in homes, f"{relative}:{line}: {package} belongs to {', '.join(homes)}"


def test_pyrr_is_used_in_one_place_at_most() -> None:
    """pyrr returns zeros or raises for some inputs (docs/architecture.md); one tested module wraps it."""
    users = [path.relative_to(PACKAGE).as_posix() for path in MODULES if any(name.partition(".")[0] == "pyrr" for _, name in imports(path))]
    assert len(users) <= 1, users
