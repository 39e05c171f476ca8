"""Exceptions and warnings of asperity.

Each exception here is an `AsperityError`, so a `ValueError`. Those of a kind that Python knows by another name are that
as well: files are `OSError`, iterations that do not converge `RuntimeError`, memory `MemoryError`. The numbers that an
exception tells are its attributes, `error.value` for example; `error.kind` is the name of the error in the Rust
library, and `error.numbers` holds all attributes. A node has `row` and `column`, and the same as `iy` and `ix`.
"""

from __future__ import annotations

from typing import Any

__all__ = [
    "ArrayError",
    "AsperityError",
    "AsperityWarning",
    "ConvergenceError",
    "FileError",
    "ForbiddenFileError",
    "InternalError",
    "MemoryLimitError",
    "MissingFileError",
]


class AsperityError(ValueError):
    """An input that is refused, or an answer that cannot be given.

    Attributes
    ----------
    kind : str
        Name of the error.
    numbers : dict
        What the error tells, by name; each is an attribute as well.
    """

    kind: str
    numbers: dict[str, Any]

    def __init__(self, message: str = "", /, *, kind: str = "Other", **numbers: Any) -> None:
        super().__init__(message)
        self.message = message
        self.kind = kind
        self.numbers = numbers
        for name, number in numbers.items():
            setattr(self, name, number)

    def __str__(self) -> str:
        return self.message

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (type(self), self.message, self.kind, self.numbers)

    def __getattr__(self, name: str) -> Any:
        # Only asked for what is not there. Which numbers are depends on the kind: type checkers let all pass.
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")


class ArrayError(AsperityError, TypeError):
    """An argument that is no array of real numbers, or has the wrong number of dimensions."""


class ConvergenceError(AsperityError, RuntimeError):
    """An iteration that has not reached its tolerance. Nothing is returned as if it had."""


class FileError(AsperityError, OSError):
    """A file that could not be read or written, or does not say what it should."""


class MissingFileError(FileError, FileNotFoundError):
    """A file that is not there."""


class ForbiddenFileError(FileError, PermissionError):
    """A file that may not be read or written."""


class MemoryLimitError(AsperityError, MemoryError):
    """More memory would be needed than the budget allows; it was not allocated."""


class InternalError(AsperityError, RuntimeError):
    """A mistake in asperity itself. Please report it, with the input."""


class AsperityWarning(UserWarning):
    """Something that is allowed and looks wrong: most often a unit that was mistaken."""


def _restored(
    error: type[AsperityError], message: str, kind: str, numbers: dict[str, Any]
) -> AsperityError:
    """An exception that was pickled."""
    return error(message, kind=kind, **numbers)
