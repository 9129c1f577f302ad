"""Type checks of the arguments of public functions."""

from __future__ import annotations

import builtins
import inspect
import sys
import types
import typing
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache, wraps
from numbers import Integral, Real
from typing import Any, Final, Literal, ParamSpec, TypeVar, get_args, get_origin

from conveyor.errors import InputError, shorten_text

P = ParamSpec("P")
R = TypeVar("R")

_LONGEST_VALUE: Final = 60
_NUMBERS: Final[dict[Any, Any]] = {float: Real, int: Integral}
_LISTS: Final = (list, tuple)


def check_arguments(function: Callable[P, R]) -> Callable[P, R]:
    """Refuse arguments of another type than the function's signature states.

    Items of lists, tuples and mappings are checked too; protocols and the arguments of callables are not.

    Raises
    ------
    InputError
        An argument is missing, unknown, or of a wrong type; it is named, with what was given and what is expected.

    Examples
    --------
    >>> @check_arguments
    ... def doubled(value: float, *, times: int = 1) -> float:
    ...     return 2.0**times * value
    >>> doubled(3.0, times=2)
    12.0
    >>> doubled("3")
    Traceback (most recent call last):
    conveyor.errors.InputError: doubled: value: expected float, got '3' (str)
    """
    signature = inspect.signature(function)
    named = function.__qualname__.removesuffix(".__init__").rpartition(".")[2]

    @wraps(function)
    def called(*args: P.args, **kwargs: P.kwargs) -> R:
        try:
            bound = signature.bind(*args, **kwargs)
        except TypeError as error:
            raise InputError(f"{named}: {error}") from None
        for name, value in bound.arguments.items():
            written = signature.parameters[name].annotation
            if not _is_of_type(value, _annotated_type(function.__module__, written)):
                expected = str(written).replace(" | None", "")
                shown = shorten_text(repr(value), _LONGEST_VALUE)
                raise InputError(f"{named}: {name}: expected {expected}, got {shown} ({type(value).__name__})")
        return function(*args, **kwargs)

    return called


class _UnloadedType:
    """Placeholder for a type of a module that is not imported: no value is of it."""


class _ModuleNames(dict[str, Any]):
    """Names of a module; those imported for types only are looked up in the loaded modules."""

    def __missing__(self, name: str) -> Any:
        if hasattr(builtins, name):
            raise KeyError(name)
        ours = [module for key, module in list(sys.modules.items()) if key.startswith("conveyor.")]
        return next((vars(module)[name] for module in ours if name in vars(module)), _UnloadedType)


def _annotated_type(module: str, written: Any) -> Any:
    """Type of an annotation; Any if it cannot be evaluated."""
    if not isinstance(written, str):
        return Any if written is inspect.Parameter.empty else written
    try:
        return _evaluate_annotation(module, written, len(sys.modules))
    except (AttributeError, TypeError):
        return Any


@cache
def _evaluate_annotation(module: str, written: str, _loaded: int) -> Any:
    """Evaluate an annotation of this package; again whenever further modules are loaded."""
    return eval(written, {}, _ModuleNames(vars(sys.modules[module])))  # noqa: S307


def _is_of_type(value: Any, hint: Any) -> bool:
    """Check a value's type, as far as it can be checked."""
    origin, arguments = get_origin(hint), get_args(hint)
    if origin in {typing.Union, types.UnionType}:
        fits = any(_is_of_type(value, one) for one in arguments) or _lacks_only_unit(value, arguments)
    elif origin is typing.Annotated:
        fits = _is_of_type(value, arguments[0])
    elif origin is Literal:
        fits = True  # a wrong word is refused with those allowed, by the function
    elif origin is not None:
        fits = _is_container_of(value, origin, arguments)
    elif hint in _NUMBERS:
        fits = isinstance(value, _NUMBERS[hint]) and not isinstance(value, bool)
    elif hint is None:
        fits = value is None
    else:
        told = isinstance(hint, type) and hint is not Any and not getattr(hint, "_is_protocol", False)
        fits = isinstance(value, hint) if told else True
    return fits


def _lacks_only_unit(value: Any, kinds: tuple[Any, ...]) -> bool:
    """True for a plain number where a quantity is taken: the function refuses it, and says the unit."""
    return any(getattr(kind, "__name__", "") == "Quantity" for kind in kinds) and _is_of_type(value, float)


def _is_container_of(value: Any, origin: Any, arguments: tuple[Any, ...]) -> bool:
    """Check the type of a container and of its items."""
    if origin in {Sequence, Iterable} and isinstance(value, str | bytes):
        return False
    if getattr(origin, "_is_protocol", False):
        return True
    if isinstance(origin, type) and not isinstance(value, origin):
        return False
    if isinstance(value, Mapping) and len(arguments) == 2:
        return all(_is_of_type(key, arguments[0]) and _is_of_type(item, arguments[1]) for key, item in value.items())
    if isinstance(value, _LISTS) and arguments and (origin is not tuple or arguments[-1] is Ellipsis):
        return all(_is_of_type(item, arguments[0]) for item in value)
    return True
