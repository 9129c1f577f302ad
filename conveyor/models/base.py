"""Base class of the models: frozen, no unknown keys, no NaN, `replace` that checks again."""

from __future__ import annotations

import ast
import inspect
import marshal
import operator
from collections.abc import Callable, Iterable, Mapping
from functools import cache, cached_property, partial
from hashlib import blake2b
from itertools import pairwise
from numbers import Integral
from textwrap import dedent
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple, Self, TypeVar

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    Strict,
    StringConstraints,
    ValidationError,
)
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import InitErrorDetails, PydanticCustomError
from pydantic_core.core_schema import ModelSchema

from conveyor.errors import InputError, SpecError
from conveyor.models.validation_messages import Location, error_message
from conveyor.units import System, is_quantity, spec_value, text
from conveyor.units.sentences import error_in_units

_SMALLEST, _LARGEST = 1e-30, 1e30
"""Smallest and largest size of a plain number other than zero: products of a few stay finite."""


_MARSHAL_FORMAT = 2
"""Format that depends on values alone: later ones refer back to objects met before."""


def _check_magnitude(value: float) -> float:
    """Refuse a number too small or too large to compute with."""
    if value == 0.0 or _SMALLEST <= abs(value) <= _LARGEST:
        return value
    raise PydanticCustomError(
        "quantity",
        "{message}",
        {"message": f"got {value:g}, expected a number in size from {_SMALLEST:g} to {_LARGEST:g}"},
    )


def _plain_integer(value: Any) -> Any:
    """A whole number of another library (NumPy's) as Python's; anything else as it is."""
    return operator.index(value) if isinstance(value, Integral) and not isinstance(value, bool) else value


AnyInteger = BeforeValidator(_plain_integer)
"""Of whole numbers: those of NumPy are taken too. The last of an annotation, so that limits are still in the schema."""


Number = Annotated[float, Strict(), AfterValidator(_check_magnitude)]
Friction = Annotated[Number, Field(gt=0, le=2)]
Switch = Annotated[bool, Strict()]
Name = Annotated[str, StringConstraints(min_length=1, max_length=100, pattern=r"^\S(.*\S)?$")]


class Problem(NamedTuple):
    """A refusal: pydantic location of the field, and what to change; an error where the message has amounts."""

    location: Location
    message: str | InputError


def raise_problems(title: str, problems: Iterable[Problem], system: System = "SI") -> None:
    """Raise one pydantic error with all problems, each at its own field; return where there are none.

    Raises
    ------
    pydantic.ValidationError
        There is at least one problem.
    """
    details = [
        InitErrorDetails(
            type=PydanticCustomError("conflict", "{message}", {"message": _problem_text(message, system)}),
            loc=location,
            input=None,
        )
        for location, message in problems
    ]
    if details:
        raise ValidationError.from_exception_data(title, details)


def _problem_text(message: str | InputError, system: System) -> str:
    return message if isinstance(message, str) else str(error_in_units(message, system))


def real_errors(error: ValidationError) -> list[dict[str, Any]]:
    """Errors of a validation without those that only follow from others.

    Pydantic counts the entries of a list that passed, and calls a list of refused entries too short.
    """
    items: list[dict[str, Any]] = [dict(item) for item in error.errors()]
    places: list[Location] = [item["loc"] for item in items]
    return [
        item
        for item in items
        if item["type"] != "too_short"
        or not any(place != item["loc"] and place[: len(item["loc"])] == item["loc"] for place in places)
    ]


def field_path(location: Location) -> str:
    """Write a pydantic location as people read it: ``route.sections[2].lift``, ``idlers.return``.

    Examples
    --------
    >>> field_path(("route", "sections", 2, "lift"))
    'route.sections[2].lift'
    >>> field_path(("idlers", "return_", "spacing"))  # a keyword of Python has an underscore there
    'idlers.return.spacing'
    """
    path = ""
    for part in location:
        path += f"[{part}]" if isinstance(part, int) else f".{part.removesuffix('_')}"
    return path.removeprefix(".")


def field_docs(model: type[BaseModel]) -> dict[str, str]:
    """Docstrings of the fields of a model, by name; read from its source only when needed."""
    docs: dict[str, str] = {}
    for owner in reversed(model.__mro__):
        if issubclass(owner, BaseModel) and owner is not BaseModel:
            docs |= _class_docs(owner)
    return {name: docs[name] for name in model.model_fields if name in docs}


@cache
def _class_docs(model: type[BaseModel]) -> dict[str, str]:
    """Docstrings of the fields that a class itself declares; parsing its source takes 10 ms."""
    (written_down,) = ast.parse(dedent(inspect.getsource(model))).body
    return _docs_after_fields(written_down.body if isinstance(written_down, ast.ClassDef) else [])


def _docs_after_fields(statements: list[ast.stmt]) -> dict[str, str]:
    """String literals that follow annotated assignments, by field name."""
    docs = {}
    for field, after in pairwise(statements):
        match field, after:
            case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(value=ast.Constant(value=str(text))):
                docs[name] = inspect.cleandoc(text)
    return docs


class _SchemaWriter(GenerateJsonSchema):
    """JSON schema with the docstrings of fields, default quantities as in specs."""

    def model_schema(self, schema: ModelSchema) -> JsonSchemaValue:
        written_down = super().model_schema(schema)
        fields = schema["cls"].model_fields
        for name, doc in field_docs(schema["cls"]).items():
            written_down["properties"][fields[name].alias or name]["description"] = doc
        return written_down

    def encode_default(self, dft: Any) -> Any:
        if isinstance(dft, Model):
            return dft.as_data()
        if isinstance(dft, tuple):
            return [self.encode_default(each) for each in dft]
        return spec_value(dft) if is_quantity(dft) else super().encode_default(dft)


T = TypeVar("T")


class Model(BaseModel):
    """Base of all models; input refused in any way of making one raises `SpecError`."""

    model_config = ConfigDict(
        frozen=True,
        extra="forbid",
        allow_inf_nan=False,
        populate_by_name=True,
        validate_default=True,
        defer_build=True,
    )

    def __init__(self, /, **fields: Any) -> None:
        self._validated(partial(super().__init__, **fields))

    # Pydantic validates nested models without calling `__init__`: their errors keep their locations.
    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    if not TYPE_CHECKING:  # type checkers know it from `frozen`

        def __setattr__(self, name: str, value: object) -> None:
            try:
                super().__setattr__(name, value)
            except ValidationError:
                raise InputError(
                    f"{name}: a {type(self).__name__} does not change; replace({name}=...) makes a changed copy"
                ) from None

        def __delattr__(self, name: str) -> None:
            raise InputError(f"{name}: a {type(self).__name__} does not change; replace() makes a changed copy")

    @classmethod
    def model_validate(cls, obj: Any, **options: Any) -> Self:
        """As pydantic's, from data or a model.

        Raises
        ------
        SpecError
            The data are refused; every refusal on its own line.
        """
        return cls._validated(partial(super().model_validate, obj, **options))

    @classmethod
    def model_validate_json(cls, json_data: str | bytes | bytearray, **options: Any) -> Self:
        """As pydantic's, from JSON text.

        Raises
        ------
        SpecError
            The data are refused; every refusal on its own line.
        """
        return cls._validated(partial(super().model_validate_json, json_data, **options))

    @classmethod
    def model_validate_strings(cls, obj: Any, **options: Any) -> Self:
        """As pydantic's, from strings.

        Raises
        ------
        SpecError
            The data are refused; every refusal on its own line.
        """
        return cls._validated(partial(super().model_validate_strings, obj, **options))

    @classmethod
    def _validated(cls, validate: Callable[[], T]) -> T:
        """Result of a validation; its errors as those of this package, without pydantic's, which are not unpickled."""
        try:
            return validate()
        except ValidationError as error:
            refused = cls.refusal(error)
        raise refused

    def replace(self, **changes: Any) -> Self:
        """Return a copy with changed fields, checked like new input.

        Raises
        ------
        SpecError
            A change is not allowed; every refusal on its own line.
        """
        kept = {name: getattr(self, name) for name in self.model_fields_set}
        aliases = {field.alias: name for name, field in type(self).model_fields.items() if field.alias}
        renamed = {aliases.get(name, name): value for name, value in changes.items()}
        return self.from_data(kept | renamed)

    @classmethod
    def from_data(cls, data: dict[str, Any]) -> Self:
        """Build a model from plain data or from quantities.

        Raises
        ------
        SpecError
            The data are refused; every refusal on its own line.
        """
        return cls.model_validate(data)

    @classmethod
    def refusal(cls, error: ValidationError) -> SpecError:
        """Error of a failed validation, every refusal on its own line."""
        return SpecError((field_path(item["loc"]), error_message(item, cls)) for item in real_errors(error))

    @cached_property
    def fingerprint(self) -> bytes:
        """Digest of the fields as entered: equal models of one class have one, in every process."""
        return value_digest(*(getattr(self, name) for name in type(self).model_fields))

    def __copy__(self) -> Self:
        """Copy without what was worked out of the fields, which `model_copy` may change."""
        twin = super().__copy__()
        for name in vars(twin).keys() - type(self).model_fields.keys():
            del vars(twin)[name]
        return twin

    @classmethod
    def json_schema(cls) -> dict[str, Any]:
        """Return the JSON schema of the model, in the names that specs use."""
        return cls.model_json_schema(schema_generator=_SchemaWriter)

    def as_data(self) -> dict[str, Any]:
        """Return plain data (text, numbers, lists) that validate to the same model again."""
        return self.model_dump(mode="json", by_alias=True, exclude_none=True)

    def _repr_html_(self) -> str:
        """Field list for notebooks, as entered."""
        from conveyor.text.markup import name_value_table

        return str(name_value_table(type(self).__name__, self.as_data().items()))

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the given fields as plain data: pint quantities do not survive another process's registry."""
        given = self.model_dump(mode="json", by_alias=True, exclude_unset=True)
        return type(self).model_validate, (given,)


def given_data(model: BaseModel) -> dict[str, Any]:
    """Plain data given to a model, without defaults."""
    return model.model_dump(mode="json", by_alias=True, exclude_none=True, exclude_unset=True)


def value_digest(*values: object) -> bytes:
    """Digest of values of fields, quantities as entered."""
    return blake2b(marshal.dumps(_plain_value(values), _MARSHAL_FORMAT), digest_size=16).digest()


def _plain_value(value: object) -> Any:
    """Value in plain types; of a model its fingerprint."""
    if isinstance(value, str | float | int | None):
        return value
    if isinstance(value, tuple):
        return tuple(map(_plain_value, value))
    if isinstance(value, Model):
        return type(value).__name__, value.fingerprint
    if isinstance(value, Mapping):
        return tuple((key, _plain_value(each)) for key, each in value.items())
    return text(value) if is_quantity(value) else repr(value)


M = TypeVar("M", bound=BaseModel)


def validate_model(model: type[M], data: object, context: dict[str, Any] | None = None) -> M:
    """Make a model from plain data; errors keep their pydantic locations, to be looked up in a file.

    Parameters
    ----------
    model : type of BaseModel
        Class of the result.
    data : object
        Plain data.
    context : dict, optional
        Validation context: resolvers of names.

    Raises
    ------
    pydantic.ValidationError
        The data are refused.
    """
    made: M = BaseModel.model_validate.__func__(model, data, context=context)  # type: ignore[attr-defined]
    return made
