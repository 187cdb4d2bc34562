"""Functions that are compiled by themselves, and that other compiled functions call by their address.

What numba compiles holds all that it calls: a function called from two of them becomes machine code twice, and none of
the two is begun before its types are known. One that is called by its address does so once, and at the same time as
what calls it, in another process. Callers have the address from a place in memory, which is filled before they run.
"""

from __future__ import annotations

import ctypes
import inspect
from collections.abc import Callable
from functools import cached_property, wraps
from typing import Any

from .parts import are_known


class Apart:
    """A function compiled by itself.

    Parameters
    ----------
    compiler : numba's
        Of the function, with a cache on disk.
    example : callable
        Returns arguments and a result of the types for which it is compiled: who calls it must know them beforehand.
    needs : tuple
        Others of its kind that it calls.
    """

    def __init__(
        self, compiler: Any, example: Callable[[], tuple[tuple[Any, ...], Any]], needs: tuple[Any, ...]
    ) -> None:
        self.compiler, self._example, self._needs = compiler, example, needs
        self._place = ctypes.c_void_p()
        function = compiler.py_func
        self.name = f"hoop_pulse.{function.__module__}.{function.__name__}"

    @cached_property
    def types(self) -> Any:
        """numba's types of the arguments, and of the result."""
        from numba import typeof

        arguments, result = self._example()
        return tuple(map(typeof, arguments)), typeof(result)

    def load(self) -> None:
        """Have it ready for compiled callers, with all that it needs: from the cache on disk, else compiled."""
        for function in self._needs:
            function.load()
        self.load_alone()

    def load_alone(self) -> None:
        """Have it ready, and nothing else."""
        if self._place.value:
            return
        arguments, result = self.types
        self.compiler.compile(arguments)
        code = self.compiler.overloads[arguments]
        if code.signature.return_type != result:
            raise TypeError(f"{self.name} returns {code.signature.return_type}, and {result} by its example.")
        self._place.value = code.library.get_pointer_to_function(code.fndesc.llvm_func_name)

    def known_to_compiled_code(self, function: Any) -> None:
        """Have compiled code that calls ``function`` go to the address."""
        from llvmlite import binding, ir
        from numba.core import cgutils, types
        from numba.core.imputils import impl_ret_new_ref
        from numba.core.typing import signature
        from numba.extending import lower_builtin, type_callable

        binding.add_symbol(self.name, ctypes.addressof(self._place))
        late = RuntimeError, (f"{self.name} was not loaded before compiled code that calls it.",)

        @type_callable(function)
        def typed(context: Any) -> Callable[..., Any]:
            def typer(*arguments: Any) -> Any:
                known, result = self.types
                return signature(result, *known) if len(arguments) == len(known) else None

            vars(typer).update(pysig=inspect.signature(function))
            return typer

        @lower_builtin(function, types.VarArg(types.Any))
        def call(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            convention, address = context.call_conv, ir.IntType(8).as_pointer()
            place = builder.module.globals.get(self.name) or ir.GlobalVariable(builder.module, address, self.name)
            callee = builder.load(place)
            with cgutils.if_unlikely(builder, cgutils.is_null(builder, callee)):
                convention.return_user_exc(builder, *late)
            kind = convention.get_function_type(signature.return_type, signature.args)
            callee = builder.bitcast(callee, kind.as_pointer())
            status, result = convention.call_function(builder, callee, signature.return_type, signature.args, arguments)
            with cgutils.if_unlikely(builder, status.is_error):
                convention.return_status_propagate(builder, status)
            return impl_ret_new_ref(context, builder, signature.return_type, result)


def called_by_address(
    compiler: Any, example: Callable[[], tuple[tuple[Any, ...], Any]], needs: tuple[Any, ...] = ()
) -> Any:
    """The function for Python and for compiled code: ``load`` it before compiled code that calls it runs.

    Where numba's insides are not known it becomes a part of what calls it, and there is nothing to load.
    """
    apart = Apart(compiler, example, needs)
    if not are_known():
        vars(compiler).update(load=lambda: None, load_alone=lambda: None)
        return compiler

    @wraps(compiler.py_func)
    def function(*arguments: Any) -> Any:
        for each in needs:
            each.load()
        return compiler(*arguments)

    apart.known_to_compiled_code(function)
    vars(function).update(load=apart.load, load_alone=apart.load_alone, py_func=compiler.py_func)
    return function


def once_loaded(compiler: Any, needs: tuple[Any, ...]) -> Any:
    """What numba compiles, called from Python with all that it ``needs`` by address loaded.

    ``compile_for`` arguments of the same types compiles it, or takes it from the cache, without them and without a
    call.
    """

    @wraps(compiler.py_func)
    def entry(*arguments: Any) -> Any:
        for function in needs:
            function.load()
        return compiler(*arguments)

    def compile_for(*arguments: Any) -> None:
        from numba import typeof

        compiler.compile(tuple(map(typeof, arguments)))

    vars(entry).update(compile_for=compile_for, py_func=compiler.py_func)
    return entry
