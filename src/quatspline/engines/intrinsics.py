"""What compiled code needs and no language has: memory by address, kernels by address, vector stores."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import extending
from numba.core import types

from quatspline.engines.compiler import SHEET, SIGNATURES
from quatspline.kernels.jit import LANES

intrinsic: Any = extending.intrinsic  # typed, mypy would ask callers for the typing context


@intrinsic(prefer_literal=True)
def on_stack(typing: Any, count: Any) -> Any:
    """Room for a constant count of float64 on the stack, aligned to a cache line: no allocation."""

    def generate(context: Any, builder: Any, typed: Any, values: Any) -> Any:
        room = ir.ArrayType(ir.DoubleType(), count.literal_value)
        with builder.goto_entry_block():
            space = builder.alloca(room)
        space.align = 64
        return builder.bitcast(space, context.get_value_type(SHEET))

    return SHEET(count), generate


@intrinsic
def splat(typing: Any, sheet: Any, at: Any, value: Any) -> Any:
    """Store LANES copies of a value from a place of a sheet on; a loop would store one by one."""

    def generate(context: Any, builder: Any, typed: Any, values: Any) -> Any:
        pointer, place, number = values
        vector = ir.VectorType(ir.DoubleType(), LANES)
        nothing, lane = ir.Constant(vector, ir.Undefined), ir.IntType(32)
        one = builder.insert_element(nothing, number, lane(0))
        every = ir.Constant(ir.VectorType(lane, LANES), [0] * LANES)
        where = builder.bitcast(builder.gep(pointer, [place]), vector.as_pointer())
        builder.store(builder.shuffle_vector(one, nothing, every), where, align=8)
        return context.get_dummy_value()

    return types.void(SHEET, types.intp, types.float64), generate


@intrinsic
def at_address(typing: Any, address: Any) -> Any:
    """A pointer to the float64 at an address."""

    def generate(context: Any, builder: Any, typed: Any, values: Any) -> Any:
        return builder.inttoptr(values[0], context.get_value_type(SHEET))

    return SHEET(types.intp), generate


@intrinsic
def call_sample(typing: Any, address: Any, sheet: Any, count: Any) -> Any:
    """Call a sample kernel by its address from compiled code."""
    return types.void(types.intp, *SIGNATURES["sample"].args), _through(SIGNATURES["sample"])


@intrinsic
def call_fit(
    typing: Any,
    address: Any,
    q: Any,
    h: Any,
    closed: Any,
    sign: Any,
    parameters: Any,
    segments: Any,
    report: Any,
) -> Any:
    """Call a fit kernel by its address from compiled code."""
    return types.void(types.intp, *SIGNATURES["fit"].args), _through(SIGNATURES["fit"])


def _through(signature: Any) -> Callable[..., Any]:
    """Code generation of a call through an address with the given signature."""

    def generate(context: Any, builder: Any, typed: Any, values: Any) -> Any:
        kinds = [context.get_value_type(kind) for kind in signature.args]
        pointer = ir.FunctionType(ir.VoidType(), kinds).as_pointer()
        builder.call(builder.inttoptr(values[0], pointer), values[1:])
        return context.get_dummy_value()

    return generate
