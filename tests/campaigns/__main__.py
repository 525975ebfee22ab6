"""Long campaigns against everything that may go wrong; each prints what it tried and measured.

`python -m tests.campaigns --seed 1` runs all of them, `--only kills faults` some. The tests run
short ones. Each is a process of its own, so that the memory it tells is its own and that of what it
starts.
"""

import argparse
import importlib
import os
import resource
import signal
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from app.cli.process import use_one_thread
from tests.campaigns.slowest import told_slowest

WHOSE = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
# Of each campaign, what its amount counts, and how much of it is asked for.
CAMPAIGNS = {
    "kills": ("processes killed", 1200),
    "faults": ("full disks and limits of memory", 200),
    "windows": ("windows ended or set against each other", 60),
    "outputs": ("outputs upon inputs and other things", 600),
    "taps": ("taps", 200),
    "shapes": ("shapes", 500),
    "minima": ("requests", 96),
    "series": ("pairs of poses", 200),
    "soak": ("minutes in the window", 30),
    "readers": ("files tampered with", 11_000),
    "commands": ("commands upon damaged files", 14_000),
}


def run() -> None:
    """Run the campaigns that are asked for."""
    use_one_thread()
    # Shells let what they start in the background ignore it, as nohup does another, and what that
    # starts as well.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    if os.name != "nt" and signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
        signal.signal(signal.SIGHUP, lambda *_: None)
    parser = argparse.ArgumentParser(prog="python -m tests.campaigns", description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", choices=list(CAMPAIGNS), nargs="+", help="some campaigns")
    parser.add_argument("--amount", type=int, help="other than usual; see the table in this file")
    arguments = parser.parse_args()
    for name, (what, usual) in CAMPAIGNS.items():
        if name not in (arguments.only or CAMPAIGNS):
            continue
        amount = arguments.amount or usual
        print(f"{name}: {amount} {what}, seed {arguments.seed}", flush=True)
        process = os.fork()
        if process == 0:
            _run_one(name, arguments.seed, amount)
            return
        status = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
        if status:
            sys.exit(status)


def _run_one(name: str, seed: int, amount: int) -> None:
    """Run a campaign; tell what each part of it found, its slowest input, and the most memory."""
    begun = time.perf_counter()
    module = importlib.import_module(f"tests.campaigns.{name}")
    for title, figures in module.campaign(seed, amount):
        most = max(resource.getrusage(whose).ru_maxrss for whose in WHOSE) / 1024
        told = {**figures, **told_slowest(), "most memory so far, MB": most}
        words = ", ".join(f"{label} {_rounded(value)}" for label, value in told.items())
        print(f"  {title}: {words}", flush=True)
    print(f"  {(time.perf_counter() - begun) / 60:.1f} minutes", flush=True)


def _rounded(value: float) -> str:
    return f"{value:,.0f}" if abs(value) >= 1000 else f"{value:.4g}"


if __name__ == "__main__":
    run()
