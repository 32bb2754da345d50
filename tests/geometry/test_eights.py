"""Eight floats side by side: compiled code against numpy and the rules of single floats."""

import os
import platform
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.eights import (
    LAST_BITS,
    WIDTH,
    WORD,
    count_bits,
    first_bit,
    least,
    load,
    most,
    pick,
    positive,
    smallest,
    splat,
    store,
    store_some,
    tagged,
    tags,
    total,
)
from regolith_studio.geometry.kernels import kernel


@kernel
def everything(given: FloatArray, out: FloatArray) -> tuple[int, float, float]:
    """Every function once."""
    one, two = load(given, 0), load(given, 8)
    store(out, 0, one + two)
    store(out, 8, one - two)
    store(out, 16, one * two)
    store(out, 24, one / two)
    store(out, 32, least(one, two))
    store(out, 40, most(one, two))
    store(out, 48, pick(one, two, splat(1.5), two))
    return positive(one - two), smallest(one), total(two)


def test_that_compiled_eights_are_arrays_of_eight() -> None:
    given = np.random.default_rng(0).normal(size=(2, 8))
    one, two = given
    out = np.empty((7, 8))
    bits, low, added = everything(given, out)
    assert np.array_equal(
        out,
        [
            one + two,
            one - two,
            one * two,
            one / two,
            np.minimum(one, two),
            np.maximum(one, two),
            np.where(one < two, 1.5, two),
        ],
    )
    assert bits == int(np.packbits(one > two, bitorder="little")[0])
    assert low == one.min()
    assert added == pytest.approx(two.sum(), rel=1e-12)


def test_that_compiled_eights_are_their_python_reference() -> None:
    given = np.random.default_rng(1).normal(size=16)
    one, two = np.empty(56), np.empty(56)
    assert everything(given, one) == everything.py_func(given, two)
    assert np.array_equal(one, two)


def test_that_no_bit_stands_for_what_is_not_a_number() -> None:
    given = np.array([np.nan, 1.0, -1.0, 0.0, -0.0, np.inf, -np.inf, 1e-300, *np.zeros(8)])
    given[8:] = 0.0
    bits, _, _ = everything(given, np.empty(56))
    assert bits == (1 << 1) | (1 << 5) | (1 << 7)


@kernel
def bit_of(word: int) -> int:
    """The lowest bit."""
    return first_bit(word)


@pytest.mark.parametrize("word", [1, 6, 1 << (WORD - 1), (1 << WORD) - (1 << 40)])
def test_that_the_first_bit_is_the_power_of_two_that_divides(word: int) -> None:
    place = bit_of(word)
    assert word % 2**place == 0
    assert word % 2 ** (place + 1) != 0
    assert first_bit(word) == place


@kernel
def shifted(array: FloatArray, at: int) -> FloatArray:
    """Eight floats of a row, counted from the beginning of the array."""
    out = np.empty(8)
    store(out, 0, load(array, at))
    return out


def test_that_places_count_along_rows() -> None:
    array = np.arange(60.0).reshape(5, 12)
    assert np.array_equal(shifted(array, 17), np.arange(17.0, 25.0))


@kernel
def front(given: FloatArray, word: int, out: FloatArray) -> int:
    """The chosen floats to the front, and how many."""
    store_some(out, 1, load(given, 0), word)
    return count_bits(word)


@pytest.mark.parametrize("word", [0, 1, 0b10110010, 0b01111111, 255])
def test_that_floats_whose_bits_are_set_are_stored_in_a_row_within_eight_places(word: int) -> None:
    given, out = np.random.default_rng(word).normal(size=WIDTH), np.full(WIDTH + 2, 7.0)
    chosen = given[np.unpackbits(np.array([word], np.uint8), bitorder="little") == 1]
    for each in (front, front.py_func):
        assert each(given, word, out) == len(chosen)
        assert out[1 : 1 + len(chosen)].tolist() == chosen.tolist()
        assert out[[0, -1]].tolist() == [7.0, 7.0]


@kernel
def with_tags(given: FloatArray, tag: int, out: FloatArray) -> None:
    """Floats with a tag, and the tags that they have."""
    store(out, 0, tagged(load(given, 0), tag))
    store(out, WIDTH, tags(tagged(load(given, 0), tag)))


@pytest.mark.parametrize("tag", [0, 35, LAST_BITS])
def test_that_a_tag_changes_a_float_by_less_than_a_billionth_and_can_be_read(tag: int) -> None:
    given, out = np.random.default_rng(tag).normal(size=WIDTH), np.empty((2, WIDTH))
    for each in (with_tags, with_tags.py_func):
        each(given, tag, out)
        assert out[0] == pytest.approx(given, rel=3e-10)
        assert (out[1] == tag).all()


@pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="names processors of that kind")
@pytest.mark.parametrize("processor", ["x86-64", "haswell"])
def test_that_processors_without_wide_registers_do_the_same(processor: str, tmp_path: Path) -> None:
    """In its own process: where LLVM cannot make code for a processor it aborts."""
    others = {"NUMBA_CPU_NAME": processor, "NUMBA_CPU_FEATURES": "", "NUMBA_CACHE_DIR": str(tmp_path)}
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "-p",
        "no:cacheprovider",
        __file__,
        "-k",
        "not processors",
    ]
    found = subprocess.run(command, env=os.environ | others, capture_output=True, text=True, timeout=280)
    assert found.returncode == 0, found.stdout + found.stderr
