"""Cases from Python's own values: a dict becomes the text of a case file."""
from __future__ import annotations

import json
import math
import numbers
import re
from collections.abc import Mapping, Sequence
from typing import Any

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


def _key(key: object) -> str:
    if not isinstance(key, str):
        raise TypeError(f"a key of a case must be a str, found {key!r}")
    return key if _BARE_KEY.fullmatch(key) else json.dumps(key)


def _number(value: float) -> str:
    if math.isnan(value):
        return "nan"
    if math.isinf(value):
        return "inf" if value > 0 else "-inf"
    return repr(value)  # the digits that bring the same double back


def value_text(value: Any) -> str:
    """A value as it stands in a case file, on one line."""
    if hasattr(value, "tolist"):  # NumPy's arrays and scalars
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        return _number(float(value))
    if isinstance(value, Mapping):
        inside = (f"{_key(k)} = {value_text(v)}" for k, v in value.items())
        return "{ " + ", ".join(inside) + " }"
    if isinstance(value, Sequence) and not isinstance(value, bytes):
        return "[" + ", ".join(map(value_text, value)) + "]"
    raise TypeError(
        f"a case holds numbers, text, True and False, lists and dicts; found "
        f"{value!r}")


def _tables(tree: Mapping[str, Any], path: tuple[str, ...],
            lines: list[str]) -> None:
    plain = {k: v for k, v in tree.items() if not isinstance(v, Mapping)}
    inner = {k: v for k, v in tree.items() if isinstance(v, Mapping)}
    if path and (plain or not inner):
        lines.append(f"\n[{'.'.join(map(_key, path))}]")
    for name, value in plain.items():
        lines.append(f"{_key(name)} = {value_text(value)}")
    for name, table in inner.items():
        _tables(table, (*path, name), lines)


def case_text(tree: Mapping[str, Any]) -> str:
    """The text of a case file that says what the dict says."""
    lines: list[str] = []
    _tables(tree, (), lines)
    return "\n".join(lines).lstrip("\n") + "\n"


def override_texts(overrides: Any) -> list[str]:
    """NAME=VALUE each, as the program's --set takes them."""
    if overrides is None:
        return []
    if isinstance(overrides, Mapping):
        return [f"{name}={value_text(value)}"
                for name, value in overrides.items()]
    if isinstance(overrides, str):
        raise TypeError("overrides: a dict of names and values, or a list of "
                        "'NAME=VALUE', not a single str")
    return [str(text) for text in overrides]
