"""`import engine`: its flat face, and the examples that need nothing else."""

import re
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

import engine
from engine import face

ROOT = Path(__file__).parents[2]
EXAMPLES = {path.stem: path for path in sorted((ROOT / "engine" / "examples").glob("*.py"))}
README = ROOT / "engine" / "README.md"
# What each example shows, by the names that it leaves.
SHOWN = {
    "own_polygon": lambda left: left["proof"].is_locally_injective and left["frame"].k.max() < 0.6,
    "drawing": lambda left: left["bent"].status.is_final and 0 < left["bent"].certificate.k < 0.6,
    "hole": lambda left: 0 < left["correction"] < 0.1 and left["frame"].sigma_b.min() > 0,
    "limits": lambda left: (
        left["state"].status is engine.Status.AT_LIMITS and not left["unfinished"].status.is_final
    ),
    "playback": lambda left: left["difference"] < 1e-5,
    "variants": lambda left: abs(left["fast"].positions - left["printed"].positions).max() < 1e-4,
}


def test_face_is_flat_and_shows_about_25_names():
    names = dir(engine)
    assert 20 <= len(names) <= 30
    assert all(getattr(engine, name) is getattr(face, name) for name in names)
    assert engine.interpolation.prepare is engine.prepare


def test_face_refuses_names_that_it_has_not():
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        engine.nothing  # noqa: B018


def test_engine_loads_nothing_before_a_name_is_asked_for():
    script = "import sys, engine.variant; print('numpy' in sys.modules); engine.Bounds"
    script += "; print('numpy' in sys.modules)"
    found = subprocess.run(
        [sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert found.stdout.split() == ["False", "True"]


@pytest.fixture(scope="module")
def bar():
    domain = engine.domain_of_polygon([0, 6, 6 + 1j, 1j], triangles=1_000)
    boundary = engine.Boundary.sample(domain)
    handles = engine.Handles.place(boundary, [0.5 + 0.5j])
    return engine.Deformer(boundary=boundary, handles=handles, bounds=engine.Bounds())


MISUSES = {
    "Boundary.sample": lambda _: engine.Boundary.sample([0, 1, 1j]),
    "Bounds": lambda _: engine.Bounds(k="0.5"),
    "Domain": lambda _: engine.Domain([0, 1, 1j], [0, 1, 1j], 3),
    "domain_of_polygon": lambda _: engine.domain_of_polygon([0, 1, 1j], 5),
    "HarmonicMap": lambda _: engine.HarmonicMap(cage=1, phi=1, psi=1),
    "HarmonicMap.identity": lambda _: engine.HarmonicMap.identity("abc"),
    "map of ragged lists": lambda bar: bar.rest_map([[1], [1, 2]]),
    "Handles.place": lambda bar: engine.Handles.place(bar.boundary.domain, [1]),
    "weights": lambda bar: engine.Handles.place(bar.boundary, [1 + 0.5j], ["a"]),
    "rotations": lambda bar: bar.handles.targets([1], ["a"]),
    "start": lambda bar: bar.start([1]),
    "settle": lambda bar: bar.settle(bar.start(), [1]),
    "settle others": lambda bar: bar.settle(
        bar.start(), engine.Handles.place(bar.boundary, [1 + 0.5j, 2 + 0.5j]).targets([1, 2])
    ),
    "steps": lambda bar: bar.settle(bar.start(), bar.handles.targets([1]), at_most="3"),
    "certify": lambda bar: engine.certify([1], bar.boundary, bar.bounds),
    "prepare": lambda bar: engine.prepare(None, bar.boundary, [1]),
    "prove": lambda _: engine.prove([1]),
    "series": lambda _: engine.Series(pieces=(), error=0.0).values("a"),
    "reference": lambda bar: engine.Reference(
        first=bar.rest_map, second=bar.rest_map, outline=bar.boundary.outline, anchor=1 + 0.5j
    ).frame("linear", bar.handles.points, 0.5),
}


@pytest.mark.parametrize("name", MISUSES)
def test_front_door_refuses_wrong_arguments_in_words(name, bar):
    with pytest.raises(engine.EngineError):
        MISUSES[name](bar)


@pytest.mark.parametrize("name", EXAMPLES)
def test_example_runs_and_shows_what_it_says(name, capsys):
    left = runpy.run_path(str(EXAMPLES[name]))
    assert SHOWN[name](left)
    assert capsys.readouterr().out
    assert 15 <= len(EXAMPLES[name].read_text(encoding="utf-8").splitlines()) <= 30


def test_readme_shows_the_first_example(request):
    source = EXAMPLES["own_polygon"].read_text(encoding="utf-8").partition('"""\n\n')[2]
    shown = README.read_text(encoding="utf-8")
    made = re.sub(r"(?<=```python\n).*?(?=```)", lambda _: source, shown, flags=re.DOTALL)
    if request.config.getoption("--regenerate"):
        README.write_text(made, encoding="utf-8")
    else:
        assert shown == made, "write it anew with --regenerate"
