"""Eight floats side by side: what the processor works out in one go, as a number type of kernels.

Compilers find such vectors in plain loops only where arrays cannot overlap and counts are known. Here a
kernel says what it means: it loads eight neighbouring floats of an array, calculates with them as with one
number and stores them. On processors with narrower registers the compiler takes several. Rounding is that of
single floats, operation by operation, everywhere.

Outside compiled code an Eight is an array of shape (8,), so that ``kernel.py_func`` works as it stands.
"""

import operator
from collections.abc import Callable
from importlib import import_module
from typing import Any

import numpy as np

from regolith_studio.geometry.arrays import FloatArray

numba: Any = import_module("numba.extending")
types: Any = import_module("numba").types
cgutils: Any = import_module("numba.core.cgutils")
registry: Any = import_module("numba.core.registry")
ir: Any = import_module("llvmlite.ir")

WIDTH = 8
WORD = 7 * WIDTH
"""Bits that are collected in one integer: seven Eights, so that none is the sign."""
LAST_BITS = (1 << 20) - 1
"""Last places of a float, which may hold a number."""
Eight = FloatArray


def load(array: FloatArray, at: int) -> Eight:
    """The eight floats from place `at` of a C-contiguous array on, rows one after the other."""
    return np.array(array.reshape(-1)[at : at + WIDTH])


def store(array: FloatArray, at: int, eight: Eight) -> None:
    """Write eight floats from place `at` on."""
    array.reshape(-1)[at : at + WIDTH] = eight


def splat(x: float) -> Eight:
    """Eight times the same."""
    return np.full(WIDTH, float(x))


def count_up() -> Eight:
    """0, 1, 2 and so on."""
    return np.arange(float(WIDTH))


def least(one: Eight, two: Eight) -> Eight:
    """The lesser of each pair; where one is NaN, `two`."""
    return np.where(one < two, one, two)


def most(one: Eight, two: Eight) -> Eight:
    """The greater of each pair; where one is NaN, `two`."""
    return np.where(one > two, one, two)


def pick(one: Eight, two: Eight, then: Eight, other: Eight) -> Eight:
    """``then`` where one < two, else ``other``."""
    return np.where(one < two, then, other)


def positive(eight: Eight) -> int:
    """Bit k is set where float k is above 0; NaN is not."""
    return int(sum(1 << k for k in range(WIDTH) if eight[k] > 0.0))


def tagged(eight: Eight, tag: int) -> Eight:
    """The floats with a number of at most 20 bits in their last places: some 2e-10 of their size."""
    bits = np.array(eight).view(np.int64) & ~LAST_BITS | int(tag)
    return np.array(bits.view(np.float64))


def tags(eight: Eight) -> Eight:
    """The numbers in the last places."""
    return np.array((np.array(eight).view(np.int64) & LAST_BITS).astype(np.float64))


def store_some(array: FloatArray, at: int, eight: Eight, word: int) -> None:
    """Write the floats whose bits are set in a row from place `at` on; spoils the rest of eight places."""
    kept = [eight[k] for k in range(WIDTH) if int(word) >> k & 1]
    array.reshape(-1)[at : at + WIDTH] = [*kept, *np.full(WIDTH - len(kept), np.nan)]


def smallest(eight: Eight) -> float:
    """The least of the eight; none may be NaN."""
    return float(np.min(eight))


def total(eight: Eight) -> float:
    """Their sum: halves are added until one is left."""
    four = eight[:4] + eight[4:]
    return float((four[0] + four[2]) + (four[1] + four[3]))


def first_bit(word: int) -> int:
    """Place of the lowest bit that is set; there must be one."""
    return (int(word) & -int(word)).bit_length() - 1


def count_bits(word: int) -> int:
    """How many bits are set."""
    return int(word).bit_count()


class EightType(types.Type):  # type: ignore[misc]
    """Numba's type of an Eight."""

    def __init__(self) -> None:
        super().__init__(name="Eight")


EIGHT = EightType()
_WORDS = ir.VectorType(ir.IntType(64), WIDTH)
_FLOATS, _INDEX = ir.VectorType(ir.DoubleType(), WIDTH), ir.IntType(32)
_COMPRESS = "llvm.experimental.vector.compress.v8f64"
_NOTHING, _FIRST = ir.Constant(_FLOATS, ir.Undefined), ir.Constant(_INDEX, 0)


@numba.register_model(EightType)
class _Model(numba.models.PrimitiveModel):  # type: ignore[misc]
    """A vector register."""

    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, _FLOATS)


def _place(context: Any, builder: Any, kind: Any, array: Any, at: Any) -> Any:
    """Pointer to eight floats of an array."""
    data = context.make_array(kind)(context, builder, array).data
    floats = builder.bitcast(data, ir.DoubleType().as_pointer())
    return builder.bitcast(builder.gep(floats, [at]), _FLOATS.as_pointer())


def _shuffled(builder: Any, eight: Any, places: list[int]) -> Any:
    """Float `places[k]` in place k."""
    return builder.shuffle_vector(eight, _NOTHING, ir.Constant(ir.VectorType(_INDEX, WIDTH), places))


def _chosen(builder: Any, sign: str, one: Any, two: Any) -> Any:
    """``one`` where it compares to ``two`` as the sign says, else ``two``."""
    return builder.select(builder.fcmp_ordered(sign, one, two), one, two)


def _folded(builder: Any, eight: Any, fold: Callable[[Any, Any], Any]) -> Any:
    """The first float after halves are folded until one is left."""
    for by in (4, 2, 1):
        eight = fold(eight, _shuffled(builder, eight, [(k + by) % WIDTH for k in range(WIDTH)]))
    return builder.extract_element(eight, _FIRST)


def _bits(builder: Any, eight: Any) -> Any:
    """One bit for each float that is above 0."""
    above = builder.fcmp_ordered(">", eight, ir.Constant(_FLOATS, [0.0] * WIDTH))
    return builder.zext(builder.bitcast(above, ir.IntType(WIDTH)), ir.IntType(64))


def _some_stored(builder: Any, to: Any, eight: Any, word: Any) -> None:
    """By the instruction for it, or one by one, each in the place of the last if that was not meant."""
    if _compresses():
        builder.store(_compressed(builder, eight, word), to, align=8)
        return
    place = builder.bitcast(to, ir.DoubleType().as_pointer())
    for k in range(WIDTH):
        builder.store(builder.extract_element(eight, ir.Constant(_INDEX, k)), place)
        bit = builder.and_(builder.lshr(word, ir.Constant(word.type, k)), ir.Constant(word.type, 1))
        place = builder.gep(place, [bit])


def _compresses() -> bool:
    """Whether code is made for a processor that moves chosen floats to the front."""
    return "+avx512f" in registry.cpu_target.target_context.codegen().magic_tuple()[2].split(",")


def _compressed(builder: Any, eight: Any, word: Any) -> Any:
    """The floats whose bits are set to the front; for processors without the instruction LLVM 20 aborts."""
    bits = ir.VectorType(ir.IntType(1), WIDTH)
    kept = builder.bitcast(builder.trunc(word, ir.IntType(WIDTH)), bits)
    kind = ir.FunctionType(_FLOATS, (_FLOATS, bits, _FLOATS))
    compress = cgutils.get_or_insert_function(builder.module, kind, _COMPRESS)
    return builder.call(compress, (eight, kept, ir.Constant(_FLOATS, [0.0] * WIDTH)))


def _as_words(builder: Any, eight: Any, mask: int) -> Any:
    """The bits of the floats that are in a mask."""
    return builder.and_(builder.bitcast(eight, _WORDS), ir.Constant(_WORDS, [mask] * WIDTH))


def _tagged(builder: Any, eight: Any, tag: Any) -> Any:
    """The last places of each float replaced."""
    one = builder.insert_element(ir.Constant(_WORDS, ir.Undefined), tag, _FIRST)
    everywhere = ir.Constant(ir.VectorType(_INDEX, WIDTH), [0] * WIDTH)
    each = builder.shuffle_vector(one, ir.Constant(_WORDS, ir.Undefined), everywhere)
    return builder.bitcast(builder.or_(_as_words(builder, eight, ~LAST_BITS), each), _FLOATS)


_FLOAT, _WORD = types.float64, types.int64
_Row = tuple[Callable[..., Any], tuple[Any, ...], Any, Callable[..., Any]]
_TABLE: tuple[_Row, ...] = (
    (load, (types.Array, types.Integer), EIGHT, lambda b, place: b.load(place, align=8)),
    (store, (types.Array, types.Integer, EIGHT), types.none, lambda b, to, x: b.store(x, to, align=8)),
    (splat, (_FLOAT,), EIGHT, lambda b, x: _shuffled(b, b.insert_element(_NOTHING, x, _FIRST), [0] * WIDTH)),
    (count_up, (), EIGHT, lambda _: ir.Constant(_FLOATS, [float(k) for k in range(WIDTH)])),
    (operator.add, (EIGHT, EIGHT), EIGHT, lambda b, x, y: b.fadd(x, y)),
    (operator.sub, (EIGHT, EIGHT), EIGHT, lambda b, x, y: b.fsub(x, y)),
    (operator.mul, (EIGHT, EIGHT), EIGHT, lambda b, x, y: b.fmul(x, y)),
    (operator.truediv, (EIGHT, EIGHT), EIGHT, lambda b, x, y: b.fdiv(x, y)),
    (least, (EIGHT, EIGHT), EIGHT, lambda b, x, y: _chosen(b, "<", x, y)),
    (most, (EIGHT, EIGHT), EIGHT, lambda b, x, y: _chosen(b, ">", x, y)),
    (pick, (EIGHT,) * 4, EIGHT, lambda b, x, y, u, v: b.select(b.fcmp_ordered("<", x, y), u, v)),
    (positive, (EIGHT,), _WORD, _bits),
    (smallest, (EIGHT,), _FLOAT, lambda b, x: _folded(b, x, lambda y, z: _chosen(b, "<", y, z))),
    (total, (EIGHT,), _FLOAT, lambda b, x: _folded(b, x, b.fadd)),
    (tagged, (EIGHT, _WORD), EIGHT, _tagged),
    (tags, (EIGHT,), EIGHT, lambda b, x: b.sitofp(_as_words(b, x, LAST_BITS), _FLOATS)),
    (store_some, (types.Array, types.Integer, EIGHT, _WORD), types.none, _some_stored),
    (count_bits, (_WORD,), _WORD, lambda b, x: b.ctpop(x)),
    (first_bit, (_WORD,), _WORD, lambda b, x: b.cttz(x, ir.Constant(ir.IntType(1), 1))),
)
"""Function, arguments, result, and what a builder puts in its place; array and place come as a pointer."""


def _typer_of(wanted: tuple[Any, ...], result: Any) -> Callable[..., Any]:
    """What numba asks whether a function takes certain arguments; it wants to know how many."""

    def fits(*given: Any) -> Any:
        fit = (
            isinstance(g, w) if isinstance(w, type) else g == w for g, w in zip(given, wanted, strict=True)
        )
        in_rows = all(each.layout == "C" for each in given if isinstance(each, types.Array))
        return result if all(fit) and in_rows else None

    return (
        lambda: fits(),
        lambda a: fits(a),
        lambda a, b: fits(a, b),
        lambda a, b, c: fits(a, b, c),
        lambda a, b, c, d: fits(a, b, c, d),
    )[len(wanted)]


def _taught(
    function: Callable[..., Any], wanted: tuple[Any, ...], result: Any, emitted: Callable[..., Any]
) -> None:
    """Tell numba the type of a function and its code."""

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        if types.Array in wanted:
            values = (_place(context, builder, signature.args[0], *values[:2]), *values[2:])
        value = emitted(builder, *values)
        return context.get_dummy_value() if result is types.none else value

    numba.type_callable(function)(lambda _context: _typer_of(wanted, result))
    numba.lower_builtin(function, *wanted)(code)


for _row in _TABLE:
    _taught(*_row)
