"""Fixtures for drawing: a context of each backend, an easel in it, and golden images."""

from collections.abc import Callable, Iterator
from pathlib import Path

import moderngl
import numpy as np
import pytest
from drawings import BACKENDS, Easel
from PIL import Image

from app.render.gpu.context import create_context
from engine.arrays import Bytes

GOLDEN = Path(__file__).parent / "golden"
TOLERANCE = 2  # levels, of 255


@pytest.fixture(scope="module", params=BACKENDS)
def gl(request: pytest.FixtureRequest) -> Iterator[moderngl.Context]:
    """A context of each backend in turn; where one is missing, its tests fail and say so."""
    context = create_context(request.param)
    yield context
    context.release()


@pytest.fixture
def easel(gl: moderngl.Context) -> Iterator[Easel]:
    easel = Easel(gl)
    yield easel
    easel.release()


@pytest.fixture
def check_golden(request: pytest.FixtureRequest, tmp_path: Path) -> Callable[[str, Bytes], None]:
    """Compares a picture with the golden image of that name, or writes it on --regenerate."""

    def check(name: str, picture: Bytes) -> None:
        path = GOLDEN / f"{name}.png"
        if request.config.getoption("--regenerate"):
            GOLDEN.mkdir(exist_ok=True)
            Image.fromarray(picture).save(path)
        golden = np.asarray(Image.open(path).convert("RGBA"))
        assert picture.shape == golden.shape
        difference = np.abs(picture.astype(int) - golden)
        if difference.max() > TOLERANCE:
            Image.fromarray(picture).save(tmp_path / f"{name}.png")
            amplified = np.clip(255 - 20 * difference.max(axis=2), 0, 255).astype(np.uint8)
            Image.fromarray(amplified).save(tmp_path / f"{name}-difference.png")
            pixels = int((difference > TOLERANCE).any(axis=2).sum())
            pytest.fail(
                f"{name}: {pixels} pixels differ by up to {difference.max()} levels; see {tmp_path}"
            )

    return check
