import hypothesis
import pytest

# Runs are repeatable, and no test depends on the machine's speed.
hypothesis.settings.register_profile("lissom", deadline=None, derandomize=True, database=None)
hypothesis.settings.load_profile("lissom")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--regenerate",
        action="store_true",
        help="write the golden images anew instead of comparing with them; look at them then",
    )
