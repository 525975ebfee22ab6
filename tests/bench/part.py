"""One part of the bench, in this process: `python -m tests.bench.part PART [--brief]`."""

import importlib
import sys

from app.cli.process import use_one_thread


def main() -> None:
    """Print the tables of a part as they are measured."""
    use_one_thread()
    part, *words = sys.argv[1:]
    module = importlib.import_module(f"tests.bench.{part}")
    for table in module.tables(module.BRIEF if words else module.Extent()):
        print(f"\n{table}", flush=True)


if __name__ == "__main__":
    main()
