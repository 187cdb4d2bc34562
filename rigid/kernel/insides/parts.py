"""Parts of compiled functions, of which intermediate code is all that is made."""

from __future__ import annotations

from functools import cache
from typing import Any

_OLDEST, _NEXT = (0, 61), (0, 69)
"""numba from and before which its insides are known here; others compile longer, to the same code."""


def are_known() -> bool:
    """Whether numba's insides are."""
    from numba import version_info

    return bool(_OLDEST <= version_info.short < _NEXT)


def as_part() -> dict[str, Any]:
    """Options of a function that compiled code alone calls."""
    options: dict[str, Any] = {"no_cpython_wrapper": True}
    if are_known():
        options["pipeline_class"] = _compiler_of_parts()
    return options


@cache
def _compiler_of_parts() -> type:
    """numba's compiler, but of a part its intermediate code is all that is made.

    numba optimises each function by itself, with all that it calls, and makes machine code of it. Nothing runs that
    where the function is only called by compiled ones: they take its intermediate code and do both again. With
    functions that call each other eight deep that is half of LLVM's work.
    """
    from numba._dynfunc import make_function
    from numba.core.codegen import JITCodeLibrary
    from numba.core.compiler import CompilerBase, DefaultPassBuilder, _LowerResult
    from numba.core.compiler_machinery import register_pass
    from numba.core.typed_passes import NativeLowering

    class Code(JITCodeLibrary):
        """For callers to link and to optimise; the engine that runs machine code never sees it."""

        def _optimize_final_module(self) -> None:
            pass

        def _finalize_final_module(self) -> None:
            self._finalize_dynamic_globals()
            self._verify_declare_only_symbols()
            self._finalized = True

    @register_pass(mutates_CFG=True, analysis_only=False)
    class Lowering(NativeLowering):
        """To such code, of which callers are told."""

        _name = "native_lowering_of_a_part"

        def run_pass(self, state: Any) -> bool:
            code = state.library = Code(state.targetctx.codegen(), state.func_id.func_qualname)
            code.enable_object_caching()
            state.flags.no_compile = True
            super().run_pass(state)
            code.finalize()
            made, described = state.cr, state.cr.fndesc
            # what callers know the part by: an entry without an address
            entry = make_function(described.lookup_module(), state.func_id.func_name, "", 0, made.env, (code,))
            state.targetctx.insert_user_function(entry, described, [code])
            if hasattr(code, "_reload_init"):
                state.reload_init.extend(code._reload_init)
            state.cr = _LowerResult(described, made.call_helper, cfunc=entry, env=made.env)
            return True

    class Parts(CompilerBase):
        """numba's passes, the last of them as above."""

        def define_pipelines(self) -> list[Any]:
            passes = DefaultPassBuilder.define_nopython_pipeline(self.state, "a part")
            place = [each for each, _ in passes.passes].index(NativeLowering)
            passes.passes[place] = (Lowering, "to intermediate code")
            passes.finalize()
            return [passes]

    return Parts
