"""MuJoCo called from compiled code: its step by address, its constraint rows by their place in `mjData`.

Constraint arrays live in an arena and move at every step, so their pointers are read from the C struct itself. The
struct's layout comes from the description MuJoCo ships (`mujoco.introspect`); before its first use, every field that is
read is checked against Python's view of it.
"""

import ctypes
import functools
from pathlib import Path
from typing import Any, NamedTuple

import mujoco
import numpy as np
from llvmlite import ir
from mujoco.introspect import ast_nodes, structs
from numba import types
from numba.extending import intrinsic

from mobnet.core.errors import SimulationError

C_TYPES: dict[str, Any] = {
    "int": ctypes.c_int,
    "mjtSize": ctypes.c_int64,
    "uint64_t": ctypes.c_uint64,
    "size_t": ctypes.c_size_t,
    "float": ctypes.c_float,
    "mjtNum": ctypes.c_double,
    "double": ctypes.c_double,
    "uintptr_t": ctypes.c_void_p,
    "mjtByte": ctypes.c_ubyte,
    "mjtBool": ctypes.c_bool,
}


READ = {  # fields of mjData that compiled code reads by address, in the order of Native, and their type
    "nefc": np.int32,
    "efc_type": np.int32,
    "efc_J_rownnz": np.int32,
    "efc_J_rowadr": np.int32,
    "efc_J_colind": np.int32,
    "efc_J": np.float64,
    "efc_force": np.float64,
}
BALL = """<mujoco><option jacobian="sparse" cone="pyramidal"/><worldbody>
<geom type="plane" size="1 1 1"/><body pos="0 0 0.09"><freejoint/><geom size="0.1"/></body>
</worldbody></mujoco>"""  # four rows of a contact, so that each field holds another number


class Native(NamedTuple):
    """Addresses for compiled code, all integers."""

    step: int  # of the function mj_step
    model: int  # of the mjModel
    data: int  # of the mjData
    nefc: int  # offset in mjData of the number of constraint rows
    efc_type: int  # offset of the pointer to their types (nefc,) int32
    row_entries: int  # offset of the pointer to the number of entries of each row of their Jacobian (nefc,) int32
    row_start: int  # offset of the pointer to the place of each row's first entry (nefc,) int32
    entry_column: int  # offset of the pointer to the entries' columns (nJ,) int32
    entry_value: int  # offset of the pointer to the entries themselves (nJ,)
    efc_force: int  # offset of the pointer to their forces (nefc,)


@functools.cache
def c_struct(name: str) -> Any:
    """Return a ctypes structure laid out as MuJoCo's struct of that name."""
    fields = [(field.name, _c_type(field.type)) for field in structs.STRUCTS[name].fields]
    return type(name, (ctypes.Structure,), {"_fields_": fields})


def _c_type(node: Any) -> Any:
    """Return the ctypes type of a described C type."""
    if isinstance(node, ast_nodes.PointerType):
        return ctypes.c_void_p
    if isinstance(node, ast_nodes.ArrayType):
        count = int(np.prod(node.extents))
        return _c_type(node.inner_type) * count
    if node.name in C_TYPES:
        return C_TYPES[node.name]
    return c_struct(node.name) if node.name in structs.STRUCTS else ctypes.c_int  # enums are ints


@functools.cache
def step_address() -> int:
    """Return the address of MuJoCo's mj_step in the library Python loaded."""
    folder = Path(mujoco.__file__).parent
    names = [*folder.glob("libmujoco.so*"), *folder.glob("libmujoco*.dylib"), *folder.glob("mujoco.dll")]
    if not names:
        raise SimulationError(f"{folder}: no MuJoCo library found")
    library = ctypes.CDLL(str(names[0]))
    return int(ctypes.cast(library.mj_step, ctypes.c_void_p).value or 0)


def bind(model: mujoco.MjModel, data: mujoco.MjData) -> Native:
    """Return the addresses of a model and its data, and bring the data's derived arrays to its position."""
    native = Native(step_address(), model._address, data._address, *offsets())
    mujoco.mj_forward(model, data)
    return native


@functools.cache
def offsets() -> tuple[int, ...]:
    """Return the offsets in mjData of the fields in `READ`, checked at first use on a ball that lies on the ground.

    Raises:
        SimulationError: Python's view of the ball's data has a field elsewhere, or of another type.
    """
    model = mujoco.MjModel.from_xml_string(BALL)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    offsets_read = tuple(offset(field) for field in READ)
    for (field, kind), at in zip(READ.items(), offsets_read, strict=True):
        read = read_at(data._address + at, field)
        viewed = np.asarray(getattr(data, field))
        wanted = viewed.ctypes.data if viewed.ndim else int(viewed)
        if read != wanted:
            raise SimulationError(f"mjData.{field}: {read} by its address, Python says {wanted}")
        if viewed.ndim and viewed.dtype != kind:
            raise SimulationError(f"mjData.{field}: type {viewed.dtype} is not accepted; accepted: {np.dtype(kind)}")
    return offsets_read


def offset(field: str) -> int:
    """Return the offset of a field of mjData in the struct that MuJoCo describes."""
    return getattr(c_struct("mjData"), field).offset


def read_at(address: int, field: str) -> int:
    """Return what compiled code reads of a field: the number of rows, or else the address of an array."""
    kind = ctypes.c_int32 if field == "nefc" else ctypes.c_uint64
    return kind.from_address(address).value


def _call_step(typingctx: Any, step: Any, model: Any, data: Any) -> Any:
    """Call mj_step(model, data), all three given as addresses."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        kind = ir.FunctionType(ir.VoidType(), [ir.IntType(64), ir.IntType(64)])
        builder.call(builder.inttoptr(args[0], kind.as_pointer()), [args[1], args[2]])
        return context.get_dummy_value()

    return types.void(types.int64, types.int64, types.int64), codegen


call_step: Any = intrinsic(_call_step)


def _pointer(kind: Any) -> Any:
    """Return an intrinsic that turns an address into a pointer to `kind`."""

    @intrinsic
    def as_pointer(typingctx: Any, address: Any) -> Any:
        def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            return builder.inttoptr(args[0], context.get_value_type(signature.return_type))

        return types.CPointer(kind)(types.int64), codegen

    return as_pointer


doubles_at = _pointer(types.float64)
ints_at = _pointer(types.int32)
addresses_at = _pointer(types.int64)
