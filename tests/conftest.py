"""What GL tests share: one context and one renderer in each test process."""

from __future__ import annotations

import os
from collections.abc import Iterator

from tests import shape_checks  # noqa: F401  # before what it checks is imported

# isort: split
import moderngl
import pytest

from blackhole_gl.planning import plan
from blackhole_gl.rendering.context import BACKENDS, ContextError, create_headless
from blackhole_gl.rendering.frame import Renderer

_create_context, _created_in = moderngl.create_context, []


def _create_the_only_context(*args: object, **named: object) -> moderngl.Context:
    """A second context in one process corrupts the heap, which shows up tests later, or never: it fails where it is made."""
    if _created_in:
        pytest.fail(f"a second GL context in one process: the first was made in {_created_in[0]}. Use the fixture `ctx`, or a process of its own.")
    made = _create_context(*args, **named)
    _created_in.append(os.environ.get("PYTEST_CURRENT_TEST", "a conftest"))
    return made


moderngl.create_context = _create_the_only_context


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--backend", choices=("auto", *BACKENDS), default="auto", help="how GL tests draw without a display")
    parser.addoption("--renew-goldens", action="store_true", help="write the golden pictures anew instead of comparing with them")


@pytest.fixture(scope="session")
def backend(request: pytest.FixtureRequest) -> str:
    """The way to render that was asked for: ``auto``, ``egl`` or ``osmesa``."""
    return request.config.getoption("--backend")


@pytest.fixture(scope="session")
def ctx(backend: str) -> moderngl.Context:
    """A context without a window. Where none can be made the tests fail, with the line that installs what is missing: a skip would hide it."""
    try:
        return create_headless(backend)
    except ContextError as error:
        pytest.fail(str(error), pytrace=False)


@pytest.fixture(scope="session")
def renderer(ctx: moderngl.Context) -> Iterator[Renderer]:
    """The one renderer whose compiled programs all tests use."""
    made = Renderer(ctx)
    yield made
    made.release()


@pytest.fixture(autouse=True)
def fresh_plans() -> Iterator[None]:
    """Plans are kept by their scenes: one made while a test had something replaced must not outlive it."""
    plan.cache_clear()
    yield
    plan.cache_clear()
