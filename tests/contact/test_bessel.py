"""Bessel tables against 40-digit arithmetic: zero to overflow of the plain functions."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from conveyor.contact.galerkin.bessel import ProductIK, bessel_j

ARGUMENTS = [1e-12, 1e-3, 0.7, 2.404825557695773, 9.5, 31.4, 100.25, 512.0, 3e3]


@pytest.mark.parametrize("order", [1, 2, 8, 40, 512])
def test_j_to_rounding_of_the_largest(order):
    x = np.array(ARGUMENTS)
    table = bessel_j(order, x)
    orders = sorted({0, 1, 2, order // 2, order - 1, order} & set(range(order + 1)))
    with mpmath.workdps(40):
        expected = np.array([[float(mpmath.besselj(v, float(a))) for a in x] for v in orders])
    # beyond the turning point |J_v| <= 1 and the forward recurrence keeps absolute precision, with J0 and J1 good to
    # rounding times the argument
    np.testing.assert_allclose(table[orders], expected, rtol=0, atol=1e-15 * max(ARGUMENTS) ** 0.5)


def test_j_below_the_turning_point_keeps_relative_precision():
    # values down to 1e-250, where an absolute tolerance says nothing
    x = np.array([1e-3, 0.7, 9.5, 60.0])
    table = bessel_j(100, x)
    with mpmath.workdps(40):
        for column, a in enumerate(x):
            for v in range(int(a) + 2, 101, 7):
                expected = float(mpmath.besselj(v, float(a)))
                if abs(expected) > 1e-250:
                    assert table[v, column] == pytest.approx(expected, rel=2e-13)


def test_j_table_keeps_the_shape_and_any_order_of_arguments():
    x = np.array([[5.0, 0.1], [40.0, 1e-9], [3.0, 5.0]])
    table = bessel_j(6, x)
    assert table.shape == (7, 3, 2)
    for row, column in np.ndindex(3, 2):
        single = bessel_j(6, x[row, column : column + 1])[:, 0]
        # the start of the recurrence depends on the largest argument of the batch: rounding differs
        np.testing.assert_allclose(table[:, row, column], single, rtol=0, atol=1e-15)


def test_j_squares_add_to_one():
    # Neumann: J_0² + 2 Σ J_v² = 1
    table = bessel_j(300, np.array([0.01, 3.0, 50.0, 200.0]))
    np.testing.assert_allclose(table[0] ** 2 + 2.0 * (table[1:] ** 2).sum(axis=0), 1.0, rtol=1e-13)


# 16 and 1024 are the last that orders 8 and 64 reach downward, where the start is forgotten least
SPANS = [1e-9, 1e-3, 0.5, 1.0, 7.0, 16.0, 30.0, 700.0, 1024.0, 1e5]


@pytest.mark.parametrize("order", [1, 8, 64])
def test_products_of_i_and_k(order):
    # one retardation term in each row of the batch; the wide ones go through a matrix product, the narrow by diagonals
    b = np.array(SPANS)[:, None]
    products, _ = ProductIK(order, b).weighted_sums(np.array([1.0]))
    assert np.all(np.diagonal(products, axis1=1, axis2=2) == 0.0)
    pairs = {(0, 1), (0, order), (order // 2, order)} - {(0, 0)}
    with mpmath.workdps(40):
        for place, a in enumerate(SPANS):
            for low, high in pairs:
                expected = float(mpmath.besseli(high, a) * mpmath.besselk(low, a))
                for i, v in ((low, high), (high, low)):
                    # rounding of a sum of `order` logarithms of size ln(2v/b); what is dropped is below 1e-16
                    assert products[place, i, v] == pytest.approx(expected, rel=1e-12, abs=1e-16)


@pytest.mark.parametrize("order", [8, 64])
def test_deficit_keeps_relative_precision(order):
    # 1/(2v) - I_v K_v → b²/(4 v³) for b → 0, where the plain difference has no digit left
    _, deficit = ProductIK(order, np.array(SPANS)[:, None]).weighted_sums(np.array([1.0]))
    assert np.all(deficit[:, 0] == 0.0)
    with mpmath.workdps(60):
        for place, a in enumerate(SPANS):
            for v in (1, 2, order // 2, order):
                product = mpmath.besseli(v, a) * mpmath.besselk(v, a)
                assert deficit[place, v] == pytest.approx(float(mpmath.mpf(1) / (2 * v) - product), rel=1e-12)


def test_terms_add_with_their_weights():
    b = np.array(SPANS)
    weights = np.linspace(0.1, 2.0, b.size)
    together = ProductIK(12, b[None, :]).weighted_sums(weights)
    alone = [ProductIK(12, b[None, t : t + 1]).weighted_sums(weights[t : t + 1]) for t in range(b.size)]
    for whole, parts in zip(together, zip(*alone, strict=True), strict=True):
        np.testing.assert_allclose(whole, sum(parts), rtol=1e-12, atol=1e-16)


def test_products_at_the_ends_of_the_range():
    # neither I nor K is representable there: I_v K_v is 1/(2v) and 1/(2b)
    _, deficit = ProductIK(3, np.array([[1e-150], [1e150]])).weighted_sums(np.array([1.0]))
    assert deficit[0, 2] == pytest.approx(1e-300 / (4.0 * 2.0**3 - 8.0), rel=1e-9)  # b²/(4 v (v² - 1))
    assert deficit[1, 2] == pytest.approx(0.25, rel=1e-14)
