"""How many of so many small mistakes the tests catch: `python -m tests.mutants --checkout DIR`.

A seed draws functions of `app` and `engine`, and one mistake in each: a sign, a limit, a dropped
call. In a checkout of the project that nobody works in, the tests that call such a function are
run with the mistake; one that fails catches it. To compare two states of the tests, draw the
mistakes from one tree (--draw-from) and try them in a checkout of each.
"""

import argparse
import csv
import queue
import signal
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import closing, contextmanager, nullcontext
from pathlib import Path
from threading import Event

from tests.mutants.checkout import Checkout, CheckoutError, StoppedError, require_clean
from tests.mutants.functions import Mutant, draw_mutants, find_mutant
from tests.mutants.hits import Hits, count_hits, read_hits
from tests.mutants.trial import GONE, SURVIVED, Trial, try_mutant

COLUMNS = ("number", "function", "line", "kind", "before", "after", "result", "test", "tests")


def main() -> int:
    """Try the mistakes, print a line for each, and the sum."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.mutants",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--seed", type=int, default=44)
    parser.add_argument("--count", type=int, default=100, help="functions (default: 100)")
    parser.add_argument(
        "--checkout",
        type=Path,
        action="append",
        required=True,
        metavar="DIR",
        help="clean, with .venv; given several times, several mistakes are tried at once",
    )
    parser.add_argument(
        "--draw-from", type=Path, metavar="DIR", help="the tree that mistakes are drawn from"
    )
    parser.add_argument(
        "--hits",
        type=Path,
        metavar="FILE",
        help="which tests call which function; written by a run of all tests if it is not there",
    )
    parser.add_argument(
        "--only", type=Path, metavar="TSV", help="try what survived in an earlier --out alone"
    )
    parser.add_argument("--out", type=Path, metavar="TSV", help="write the results to a file, too")
    parser.add_argument(
        "--most", type=int, default=60, help="tests for a mistake; 0: all (default: 60)"
    )
    parser.add_argument(
        "--whole-files", action="store_true", help="run the files of these tests, not them alone"
    )
    parser.add_argument(
        "--patience", type=float, default=900, help="seconds until a run hangs (default: 900)"
    )
    arguments = parser.parse_args()
    stop = Event()
    try:
        if len({require_clean(folder) for folder in arguments.checkout}) > 1:
            parser.error("The checkouts are of different revisions.")
        checkouts = [Checkout(folder, stop) for folder in arguments.checkout]
        if len({checkout.folder for checkout in checkouts}) < len(checkouts):
            parser.error("One checkout is given twice.")
        return _run(arguments, checkouts, stop)
    except CheckoutError as error:
        parser.error(str(error))
    except (KeyboardInterrupt, StoppedError):
        # What ran has put its files back.
        print("Stopped. The checkouts are as they were.", file=sys.stderr)
        return 130


def _run(arguments: argparse.Namespace, checkouts: list[Checkout], stop: Event) -> int:
    # Shells let what they start in the background ignore the first.
    for each in (signal.SIGINT, signal.SIGTERM):
        signal.signal(each, signal.default_int_handler)
    first = checkouts[0]
    drawn = draw_mutants(
        arguments.draw_from or first.folder, seed=arguments.seed, count=arguments.count
    )
    survivors = _survivors(arguments.only) if arguments.only else None
    chosen = [
        number
        for number, mutant in enumerate(drawn)
        if survivors is None or mutant.name in survivors
    ]
    there = {number: find_mutant(first.folder, drawn[number]) for number in chosen}
    hits = _hits(arguments.hits, first, drawn)
    results: Counter[str] = Counter()
    trials = _trials(there, hits, checkouts, arguments, stop)
    with _table(arguments.out) as table, closing(trials):
        for trial in trials:
            mutant = drawn[trial.number]
            results[trial.result] += 1
            print(f"{trial.number:4} {trial}: {mutant}", flush=True)
            table(mutant, trial)
    told = "".join(f", {count} {result}" for result, count in sorted(results.items()))
    print(f"{results.total()} mistakes{told}")
    return 0


def _survivors(path: Path) -> set[str]:
    """Return the functions in which mistakes survived before."""
    with path.open(encoding="utf-8", newline="") as file:
        rows = csv.DictReader(file, delimiter="\t")
        return {row["function"] for row in rows if row["result"] == SURVIVED}


def _hits(path: Path | None, checkout: Checkout, drawn: list[Mutant]) -> Hits:
    """Return what the tests call, counted where no file tells it."""
    if path and path.exists():
        return read_hits(path)
    with tempfile.TemporaryDirectory() as folder:
        return count_hits(checkout, drawn, path or Path(folder) / "hits.tsv")


@contextmanager
def _table(path: Path | None) -> Iterator[Callable[[Mutant, Trial], None]]:
    """Write a row for each mistake to a file, if there is one, as it comes."""
    with path.open("w", encoding="utf-8", newline="") if path else nullcontext() as file:
        table = csv.writer(file, "excel-tab", lineterminator="\n") if file else None

        def write(*cells: object) -> None:
            if table and file:
                table.writerow(" ".join(str(cell).split()) for cell in cells)
                file.flush()

        write(*COLUMNS)
        yield lambda mutant, trial: write(
            trial.number,
            mutant.name,
            mutant.line,
            mutant.kind,
            mutant.before,
            mutant.after,
            trial.result,
            trial.test,
            trial.tests,
        )


def _trials(
    mutants: dict[int, Mutant | None],
    hits: Hits,
    checkouts: list[Checkout],
    arguments: argparse.Namespace,
    stop: Event,
) -> Generator[Trial, None, None]:
    """Try mistakes, one at a time in each checkout; give each result as it comes."""
    waiting: queue.SimpleQueue[tuple[int, Mutant]] = queue.SimpleQueue()
    for number, mutant in mutants.items():
        if mutant:
            waiting.put((number, mutant))
        else:
            yield Trial(number=number, result=GONE)
    free: queue.SimpleQueue[Checkout] = queue.SimpleQueue()
    for checkout in checkouts:
        free.put(checkout)

    def try_next() -> Trial:
        number, mutant = waiting.get()
        checkout = free.get()
        try:
            return try_mutant(
                checkout,
                number,
                mutant,
                hits,
                most=arguments.most,
                whole_files=arguments.whole_files,
                patience=arguments.patience,
            )
        finally:
            free.put(checkout)

    with ThreadPoolExecutor(len(checkouts)) as threads:
        trials = [threads.submit(try_next) for _ in range(waiting.qsize())]
        try:
            for trial in as_completed(trials):
                yield trial.result()
        except BaseException:
            # The threads put their files back before the program ends.
            signal.signal(signal.SIGINT, signal.SIG_IGN)
            stop.set()
            threads.shutdown(cancel_futures=True)
            raise


if __name__ == "__main__":
    raise SystemExit(main())
