"""One headless context for all shader tests: making one costs more than most of them."""

from __future__ import annotations

from typing import Iterator

import moderngl
import pytest

from blackhole_gl.render.context import create_headless


@pytest.fixture(scope="session")
def ctx() -> Iterator[moderngl.Context]:
    context = create_headless()
    yield context
    context.release()
