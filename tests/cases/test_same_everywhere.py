"""A replay gives the same bytes whatever the processor can do, and whatever surrounds the program."""

import hashlib
import importlib
import os
import subprocess
import sys

import numpy as np
import pytest

from tests.conftest import ROOT

LOG = ROOT / "sample_logs" / "patrol_tuesday.bag"
NUMPY = importlib.import_module(f"numpy.{'_core' if np.__version__ >= '2' else 'core'}._multiarray_umath")
DISPATCHED = [feature for feature in NUMPY.__cpu_dispatch__ if NUMPY.__cpu_features__[feature]]

# Every function whose last bit is up to a library or a processor is off by up to four of them, at random.
OFF_BY_LAST_BITS = """
import math
import numpy as np

random = np.random.default_rng(1)

def off(function):
    def call(*args, **kwargs):
        exact = np.asarray(function(*args, **kwargs))
        steps = random.integers(-4, 5, exact.shape)
        return (exact + np.where(np.isfinite(exact), steps * np.spacing(np.abs(exact)), 0)).astype(exact.dtype)[()]
    return call

for module, names in (
    (np, "sin cos tan arctan2 hypot exp expm1 log log1p log2 power matmul dot einsum"),
    (math, "sin cos tan atan2 hypot exp log1p pow"),
):
    for name in names.split():
        setattr(module, name, off(getattr(module, name)))

from timemap_cli.cli.entry import run
run()
"""
PLAIN = ("-m", "timemap_cli")


def run(*command, **environment):
    command = (sys.executable, *command)
    subprocess.run(command, check=True, cwd=ROOT, env=os.environ | environment, capture_output=True)


def digest(folder, program=PLAIN, **environment):
    """SHA-256 of the result of a replay by itself."""
    result = folder / f"{len(list(folder.iterdir()))}.timemap.mcap"
    run(*program, "replay", str(LOG), "--end", "+120s", "-o", str(result), **environment)
    return hashlib.sha256(result.read_bytes()).hexdigest()


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("everywhere")


@pytest.fixture(scope="module")
def expected(folder):
    return digest(folder)


@pytest.mark.skipif(not DISPATCHED, reason="NumPy has nothing better for this processor than its baseline")
def test_without_the_vector_units_that_numpy_chooses_by_processor(folder, expected):
    assert digest(folder, NPY_DISABLE_CPU_FEATURES=" ".join(DISPATCHED)) == expected


def test_with_every_library_function_off_by_some_last_bits(folder, expected):
    assert digest(folder, program=("-c", OFF_BY_LAST_BITS)) == expected


def test_with_another_hash_seed_locale_time_zone_and_number_of_threads(folder, expected):
    surroundings = {
        "PYTHONHASHSEED": "1234",
        "LC_ALL": "tr_TR.UTF-8",
        "TZ": "Asia/Kathmandu",
        "OPENBLAS_NUM_THREADS": "1",
        "OMP_NUM_THREADS": "1",
        "OPENBLAS_CORETYPE": "Prescott",
    }
    assert digest(folder, **surroundings) == expected
