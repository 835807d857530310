"""No number that is written to a file comes from a matrix library, whose last bits are up to the processor."""

import ast

import pytest

from tests.conftest import ROOT

FOLDERS = ("timemap_cli", "sample_logs", "benchmarks")
FIGURES_WITHIN_A_TOLERANCE = ROOT / "timemap_cli" / "checks"
CALLS = {
    "convolve", "correlate", "corrcoef", "cov", "dot", "einsum", "inner", "inv", "lstsq", "matmul", "polyfit",
    "solve", "tensordot", "vdot",
}  # fmt: skip


def products(source):
    """Lines of a module on which a matrix library may take part."""
    return [node.lineno for node in ast.walk(ast.parse(source)) if is_product(node)]


def is_product(node):
    if isinstance(node, ast.BinOp | ast.AugAssign):
        return isinstance(node.op, ast.MatMult)
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in CALLS


@pytest.mark.parametrize(
    "line", ["a @ b", "a @= b", "np.convolve(a, b)", "a.dot(b)", "np.linalg.solve(a, b)"]
)
def test_what_a_matrix_library_computes_is_found(line):
    assert products(f"x = 1\n{line}\n") == [2]


@pytest.mark.parametrize("folder", FOLDERS)
def test_no_module_leaves_its_sums_to_a_matrix_library(folder):
    found = {
        f"{path.relative_to(ROOT)}:{line}"
        for path in (ROOT / folder).rglob("*.py")
        if FIGURES_WITHIN_A_TOLERANCE not in path.parents
        for line in products(path.read_text(encoding="utf-8"))
    }
    assert not found
