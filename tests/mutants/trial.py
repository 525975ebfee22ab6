"""One mistake, and the tests that may catch it."""

import re
from dataclasses import dataclass
from typing import Final

from tests.mutants.checkout import Checkout
from tests.mutants.functions import Mutant
from tests.mutants.hits import Hits

CAUGHT: Final = "caught"
SURVIVED: Final = "survived"
GONE: Final = "gone"
UNTRIED: Final = "not tried"
PASSED, FAILED = 0, 1  # exit statuses of pytest


@dataclass(frozen=True, slots=True, kw_only=True)
class Trial:
    """What came of a mistake: the result, the test that caught it, how many tests were chosen."""

    number: int
    result: str
    test: str = ""
    tests: int = 0

    def __str__(self) -> str:
        if self.result == CAUGHT:
            return f"caught by {self.test}"
        if self.result == SURVIVED:
            return f"survived {self.tests} tests" if self.tests else "survived, no test calls it"
        return f"{self.result}, {self.test}" if self.test else self.result


def try_mutant(
    checkout: Checkout,
    number: int,
    mutant: Mutant,
    hits: Hits,
    *,
    most: int,
    whole_files: bool,
    patience: float,
) -> Trial:
    """Run the tests that call a function with a mistake in it, until one fails."""
    tests = hits.choose(number, mutant, most)
    if not tests:
        return Trial(number=number, result=SURVIVED)
    told = dict.fromkeys(test.partition("::")[0] for test in tests) if whole_files else tests
    words = ["-q", "-n", "0", "-m", "long or not long", *told]
    with checkout.changed({mutant.path: mutant.source}):
        run = checkout.run_tests(["-x", "--tb=no", *words], patience=patience)
    if run.status == PASSED and not run.hangs:
        return Trial(number=number, result=SURVIVED, tests=len(tests))
    if run.hangs:
        test = f"the time limit of {patience:g} s"
    elif found := re.search(r"^(?:FAILED|ERROR) (.+?)(?: - .*)?$", run.output, re.MULTILINE):
        test = found[1]
    else:
        test = f"the end of the tests, status {run.status}"
    # Other statuses than of failed tests may also say that they are not there.
    if run.status > FAILED and not run.hangs:
        collected = checkout.run_tests(["--collect-only", *words])
        if collected.status != PASSED:
            return Trial(number=number, result=UNTRIED, test="its tests are not there")
    return Trial(number=number, result=CAUGHT, test=test, tests=len(tests))
