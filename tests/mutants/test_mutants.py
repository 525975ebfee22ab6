"""Mistakes are drawn, found again and counted in a small tree, and no file stays changed."""

import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from threading import Event

import pytest

from tests.mutants.checkout import PYTHON, Checkout, CheckoutError, require_clean
from tests.mutants.functions import Mutant, draw_mutants, find_mutant, with_counters
from tests.mutants.hits import PLUGIN, Hits, read_hits
from tests.mutants.trial import CAUGHT, SURVIVED, try_mutant

ALL = 1000
LENGTHS = '''"""Lengths."""

from functools import cache


def total(values: list[float]) -> float:
    """Return the sum, none below zero."""
    found = 0.0
    for value in values:
        if value > 0:
            found += value
    return found


class Line:
    def __init__(self, ends: tuple[float, float]) -> None:
        self.ends = ends
        self.check()

    def check(self) -> None:
        @cache
        def length() -> float:
            return abs(self.ends[1] - self.ends[0])

        if length() < 0 or "ä" == "b":
            raise ValueError(f"no length: {1 + 1}")


@cache
def double(value: float) -> float:
    return 2 * value
'''
TESTS = """
import pytest
from app.lengths import double, total

@pytest.fixture(scope="module")
def found():
    return total([1.0, 2.0])

def test_fixture_is_made(found):
    assert found > 0

def test_fixture_is_kept(found):
    assert double(1) > 0

def test_cache_is_kept():
    assert double(3) == 6
"""


@pytest.fixture
def tree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A small project, and a Python for it."""
    # Of the plugins of pytest only what its runs need, as others take long to load.
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    monkeypatch.setenv("PYTEST_PLUGINS", "xdist.plugin")
    tree = tmp_path / "tree"
    for folder in ("app", "engine", "tests", PYTHON.parent):
        (tree / folder).mkdir(parents=True)
    (tree / "app" / "__init__.py").touch()
    (tree / "app" / "lengths.py").write_text(LENGTHS, encoding="utf-8")
    (tree / "engine" / "moves.py").write_text("def there(x):\n    return -x\n", encoding="utf-8")
    (tree / "tests" / "test_lengths.py").write_text(TESTS, encoding="utf-8")
    (tree / "pyproject.toml").write_text(
        '[tool.pytest.ini_options]\nmarkers = ["long"]\npythonpath = ["."]\n', encoding="utf-8"
    )
    # Not a link, beside which its environment would not be found.
    (tree / PYTHON).write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n', encoding="utf-8")
    (tree / PYTHON).chmod(0o755)
    return tree


def all_mutants(tree: Path) -> Iterator[Mutant]:
    for seed in range(24):
        yield from draw_mutants(tree, seed=seed, count=ALL)


def of(tree: Path, function: str, before: str) -> Mutant:
    """Return a mutant of a function, whatever seed draws it."""
    return next(m for m in all_mutants(tree) if (m.function, m.before) == (function, before))


def test_a_seed_draws_the_same_mutants_again(tree: Path) -> None:
    drawn = draw_mutants(tree, seed=1, count=ALL)
    assert drawn == draw_mutants(tree, seed=1, count=ALL)
    assert drawn[:2] == draw_mutants(tree, seed=1, count=2)
    assert sorted(mutant.function for mutant in drawn) == [
        "Line.__init__",
        "Line.check",
        "double",
        "there",
        "total",
    ]
    assert len({tuple(draw_mutants(tree, seed=seed, count=ALL)) for seed in range(9)}) > 4


def test_a_mutant_parses_and_differs_in_one_place(tree: Path) -> None:
    kinds = set()
    for mutant in all_mutants(tree):
        before = (tree / mutant.path).read_text(encoding="utf-8")
        ast.parse(mutant.source)
        places = [each.span() for each in re.finditer(re.escape(mutant.before), before)]
        changed = [before[:first] + mutant.after + before[last:] for first, last in places]
        assert mutant.source in changed
        assert mutant.source != before
        assert mutant.code in before.splitlines()[mutant.line - 1]
        kinds.add(mutant.kind)
    assert kinds == {"sign", "limit", "dropped call"}


def test_a_mutant_leaves_the_words_of_errors_as_they_are(tree: Path) -> None:
    assert all("no length: {1 + 1}" in m.source for m in all_mutants(tree) if "app" in m.path)


def test_a_mutant_is_drawn_again_when_others_change(tree: Path) -> None:
    path = tree / "app" / "lengths.py"
    before = {m.name: (m.before, m.after) for m in draw_mutants(tree, seed=3, count=ALL)}
    path.write_text(LENGTHS.replace("2 * value", "value * 2"), encoding="utf-8")
    after = {m.name: (m.before, m.after) for m in draw_mutants(tree, seed=3, count=ALL)}
    del before["app/lengths.py:double"], after["app/lengths.py:double"]
    assert after == before


def test_a_mutant_is_found_where_its_line_is_still_there(tree: Path) -> None:
    mutants = list(all_mutants(tree))
    path = tree / "app" / "lengths.py"
    path.write_text(f"import math\n\n{LENGTHS}", encoding="utf-8")
    for mutant in mutants:
        found = find_mutant(tree, mutant)
        assert found is not None
        lower = 2 if "app" in mutant.path else 0
        assert (found.line, found.after) == (mutant.line + lower, mutant.after)
    (gone,) = {m for m in mutants if m.before == "value > 0"}
    path.write_text(LENGTHS.replace("value > 0", "value > 0.0"), encoding="utf-8")
    assert find_mutant(tree, gone) is None
    path.unlink()
    assert find_mutant(tree, gone) is None


def test_a_mutant_is_found_among_places_that_are_alike(tree: Path) -> None:
    path = tree / "engine" / "moves.py"
    path.write_text("def twice(x):\n    return x + 1, x + 1, x + 1\n", encoding="utf-8")
    alike = {m for m in all_mutants(tree) if m.before == "x + 1"}
    assert {mutant.turn for mutant in alike} == {0, 1, 2}
    assert len({mutant.source for mutant in alike}) == 3
    assert all(find_mutant(tree, mutant) == mutant for mutant in alike)


def test_counters_stand_first_in_their_functions(tree: Path) -> None:
    mutants = draw_mutants(tree, seed=1, count=ALL)
    (tree / "engine" / "moves.py").unlink()  # Of which nothing is counted any more.
    files = with_counters(tree, mutants)
    assert list(files) == ["app/lengths.py"]
    counted = {
        function.name: ast.unparse(function.body[1 if ast.get_docstring(function) else 0])
        for function in ast.walk(ast.parse(files["app/lengths.py"]))
        if isinstance(function, ast.FunctionDef) and function.name != "length"
    }
    assert counted == {
        mutant.function.rpartition(".")[2]: f"__import__('mutant_hits').hit({number})"
        for number, mutant in enumerate(mutants)
        if mutant.path in files
    }


def test_hits_choose_tests_of_the_room_and_run_cheap_ones_first(tmp_path: Path) -> None:
    far, near = "tests/app/ui/test_x.py::test_x", "tests/app/motion/test_y.py::test_y"
    seconds = {f"{far}[1]": 1, f"{far}[2]": 0.5, f"{near}[1]": 3, f"{near}[2]": 2}
    broken = "tests/app/motion/test_y.py::test_z"
    path = tmp_path / "hits.tsv"
    called = [*seconds, broken, "tests/test_architecture.py::test_a"]
    lines = [f"7\t{test}" for test in [*called, *called]]
    lines += [f"test\t{test}\t{cost}\tpassed" for test, cost in seconds.items()]
    lines += [f"test\t{broken}\t0.1\tfailed", "7\t"]
    path.write_text("\n".join(lines), encoding="utf-8")
    hits = read_hits(path)
    mutant = Mutant(
        path="app/motion/y.py",
        function="f",
        kind="sign",
        line=1,
        before="",
        after="",
        code="",
        turn=0,
        source="",
    )
    assert hits.choose(7, mutant, 1) == [f"{near}[2]"]
    assert hits.choose(7, mutant, 2) == [f"{far}[2]", f"{near}[2]"]
    assert hits.choose(7, mutant, 0) == sorted(seconds, key=lambda test: seconds[test])
    assert hits.choose(8, mutant, 0) == []


def test_the_tree_of_the_program_is_refused() -> None:
    with pytest.raises(CheckoutError, match="Make a clone"):
        require_clean(Path(__file__).parents[2])


def test_files_are_put_back_when_a_run_fails(tree: Path) -> None:
    checkout = Checkout(tree, Event())
    before = {path: path.read_bytes() for path in tree.rglob("*.py")}

    def fail() -> None:
        with checkout.changed({"app/lengths.py": "", "new.py": ""}):
            assert not (tree / "app" / "lengths.py").read_bytes()
            assert (tree / "new.py").exists()
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail()
    assert {path: path.read_bytes() for path in tree.rglob("*.py")} == before


def test_what_is_kept_counts_for_every_test_that_gets_it(tree: Path) -> None:
    mutants = [of(tree, "total", "value > 0"), of(tree, "double", "2 * value")]
    files = with_counters(tree, mutants) | {PLUGIN.name: PLUGIN.read_text(encoding="utf-8")}
    path = tree / "hits.tsv"
    variables = {"MUTANT_HITS": str(path), "PYTEST_PLUGINS": PLUGIN.stem}
    checkout = Checkout(tree, Event())
    with checkout.changed(files):
        run = checkout.run_tests([], variables=variables)
    assert run.status == 0, run.output
    hits = read_hits(path)
    made, kept, cached = (
        f"tests/test_lengths.py::test_{name}"
        for name in ("fixture_is_made", "fixture_is_kept", "cache_is_kept")
    )
    assert hits.tests == {0: [made, kept], 1: [kept, cached]}
    assert set(hits.seconds) == {made, kept, cached}


def test_a_test_that_fails_or_hangs_catches_a_mistake(tree: Path) -> None:
    test = "tests/test_lengths.py::test_cache_is_kept"
    hits = Hits(tests={0: [test]})
    checkout = Checkout(tree, Event())

    def tried(mutant: Mutant, *, patience: float = 600) -> tuple[str, str]:
        trial = try_mutant(checkout, 0, mutant, hits, most=0, whole_files=False, patience=patience)
        return trial.result, trial.test

    assert tried(of(tree, "total", "value > 0")) == (SURVIVED, "")
    assert tried(of(tree, "double", "2 * value")) == (CAUGHT, test)
    (tree / "tests" / "test_lengths.py").write_text("while True:\n    pass\n", encoding="utf-8")
    caught = tried(of(tree, "double", "2 * value"), patience=0.5)
    assert caught == (CAUGHT, "the time limit of 0.5 s")
    assert (tree / "app" / "lengths.py").read_text(encoding="utf-8") == LENGTHS
