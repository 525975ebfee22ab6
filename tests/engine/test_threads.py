"""A script that imports the engine has BLAS on one thread, whatever was imported before."""

import subprocess
import sys

SCRIPT = """
import numpy, scipy.linalg, threadpoolctl
from engine.interpolation import prepare
pools = threadpoolctl.threadpool_info()
print({pool["num_threads"] for pool in pools if pool["user_api"] == "blas"})
"""


def test_blas_keeps_to_one_thread():
    found = subprocess.run(
        [sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=True
    )
    assert found.stdout == "{1}\n"
