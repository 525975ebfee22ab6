"""Which tests call a function, and which of them are tried first."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from tests.mutants.checkout import Checkout, CheckoutError
from tests.mutants.functions import Mutant, with_counters

PLUGIN = Path(__file__).with_name("mutant_hits.py")
# What looks at the text of the project, and what would try mistakes of its own.
LEFT_OUT = ("tests/test_architecture.py", "tests/mutants/")


@dataclass(frozen=True, slots=True, kw_only=True)
class Hits:
    """What a run of all tests told.

    Parameters
    ----------
    tests : dict
        The tests that call each function, by its number, as they ran.
    seconds : dict
        How long tests took, where that is known.
    failed : set
        Tests that fail without any mistake, and tell nothing.
    """

    tests: dict[int, list[str]] = field(default_factory=dict)
    seconds: dict[str, float] = field(default_factory=dict)
    failed: set[str] = field(default_factory=set)

    def choose(self, number: int, mutant: Mutant, most: int) -> list[str]:
        """Return at most so many tests that call a function, the cheapest first; 0: all.

        Tests of the function's own room are chosen before others, and of a test with many
        parameters one before others are tried again.
        """
        turns: dict[str, int] = {}
        ranks: list[tuple[int, int, float, int, str]] = []
        calling = [each for each in dict.fromkeys(self.tests.get(number, ())) if self._tells(each)]
        for place, test in sorted(
            enumerate(calling), key=lambda each: (self.seconds.get(each[1], 0.0), each[0])
        ):
            name = test.partition("[")[0]
            turns[name] = turns.get(name, 0) + 1
            cost = self.seconds.get(test, 0.0)
            ranks.append((turns[name], -_kinship(test, mutant.path), cost, place, test))
        chosen = sorted(ranks)[: most or None]
        return [test for *_, test in sorted(chosen, key=lambda rank: rank[2:])]

    def _tells(self, test: str) -> bool:
        return test not in self.failed and not test.startswith(LEFT_OUT)


def _kinship(test: str, path: str) -> int:
    """Return how many folders a test has in common with a module, and one if it has its name."""
    file = PurePosixPath(test.partition("::")[0])
    module = PurePosixPath(path)
    rooms = zip(file.parts[1:-1], module.parts[:-1], strict=False)
    common = 0
    for one, other in rooms:
        if one != other:
            break
        common += 1
    return common + (file.stem == f"test_{module.stem}")


def read_hits(path: Path) -> Hits:
    """Read what `mutant_hits` wrote."""
    hits = Hits()
    for line in path.read_text(encoding="utf-8").splitlines():
        kind, test, *words = line.split("\t")
        if not test:
            continue
        if kind == "test":
            hits.seconds[test] = float(words[0])
            if words[1] == "failed":
                hits.failed.add(test)
        else:
            hits.tests.setdefault(int(kind), []).append(test)
    return hits


def count_hits(
    checkout: Checkout, mutants: Sequence[Mutant], path: Path, words: Sequence[str] = ()
) -> Hits:
    """Run all tests, or those that are named, and write which calls which of the functions."""
    written = path.with_name(f"{path.name}.part").resolve()
    written.unlink(missing_ok=True)
    files = with_counters(checkout.folder, list(mutants))
    # Child processes that get another PYTHONPATH find it beside the program.
    files[PLUGIN.name] = PLUGIN.read_text(encoding="utf-8")
    variables = {
        "MUTANT_HITS": str(written),
        "PYTEST_PLUGINS": PLUGIN.stem,
    }
    with checkout.changed(files):
        run = checkout.run_tests(
            ["-q", "-n", "auto", "-m", "long or not long", "--maxfail=1000000", *words],
            variables=variables,
        )
    if run.status not in {0, 1} or not written.exists():
        raise CheckoutError(f"The tests cannot be run there:\n{run.output[-4000:]}")
    written.replace(path)
    return read_hits(path)
