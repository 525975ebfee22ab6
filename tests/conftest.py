import gc
import os
import sys

import hypothesis
import pytest
from hypothesis.internal.conjecture import providers

# Texts are English on any system, also in the processes that tests start, unless they choose.
os.environ.setdefault("LISSOM_LANGUAGE", "en")

from app.cli.process import use_one_thread

# As in the program, and before anything imports NumPy.
use_one_thread()

# Also where Python is told to keep no compiled modules: each worker would rewrite the assertions of
# all tests anew in every run, and each process that a test starts would compile the program.
sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# Runs are repeatable, and no test depends on the machine's speed. Hypothesis would also draw from
# the constants of all local modules that are loaded, which are others where a test runs alone.
providers.is_local_module_file = lambda _: False
hypothesis.settings.register_profile("lissom", deadline=None, derandomize=True, database=None)
hypothesis.settings.load_profile("lissom")


def pytest_collection_finish() -> None:
    # What is there now stays for the whole run. To search it for garbage again and again took a
    # sixteenth of the time.
    gc.collect()
    gc.freeze()


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--regenerate",
        action="store_true",
        help="write golden images and tables anew instead of comparing; look at them then",
    )
    parser.addoption(
        "--steps",
        metavar="N",
        type=int,
        default=60,
        help="of each random walk through the window; many walk farther, and take longer",
    )
    parser.addoption(
        "--walks",
        metavar="N",
        type=int,
        help="random walks through the window with the seeds 1 to N, in place of the usual ones",
    )
