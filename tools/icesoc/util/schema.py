# SPDX-License-Identifier: MIT
"""schema: checks the values of a JSON or TOML file against a JSON Schema, with messages for the
user."""
import functools
import json
import math
import re


@functools.cache
def _validator():
    """Returns the class of validators. A pattern must match the whole text, an integer must be
    written without a point, and a number must be finite. jsonschema is imported here for two
    reasons: the import takes 0.15 s, and on an empty machine, commands import this module before
    jsonschema is installed."""
    import jsonschema  # pylint: disable=import-outside-toplevel

    def matches(_, pattern, value, __):
        if isinstance(value, str) and not re.fullmatch(pattern, value, re.A | re.S):
            yield jsonschema.ValidationError(f"does not match {pattern}")

    base = jsonschema.Draft202012Validator
    types = base.TYPE_CHECKER.redefine("integer", lambda _, value: type(value) is int).redefine(
        "number", lambda _, value: type(value) is int or (
            type(value) is float and math.isfinite(value)))
    return jsonschema.validators.extend(base, {"pattern": matches}, type_checker=types)


def description(schema):
    """Returns the description in a schema, which is a text about the allowed values."""
    return schema["description"]


def limits(schema):
    """Returns a text about the allowed values, derived from the type and the limits in a schema."""
    if "enum" in schema:
        return " or ".join(map(str, schema["enum"]))
    if schema["type"] not in ("integer", "number"):
        return {"string": "a text", "boolean": "true or false", "array": "a list"}[schema["type"]]
    whole = "whole " * (schema["type"] == "integer")
    if "maximum" in schema:
        return f"a {whole}number, {schema['minimum']} to {schema['maximum']}"
    return f"a {whole}number, at least {schema['minimum']}"


def problems(value, schema, expected=description):
    """Returns a sentence for each part of a value that does not fit its schema. `expected`:
    function that returns a text about the allowed values, given a part of the schema."""
    errors = sorted(_validator()(schema).iter_errors(value), key=lambda e: list(e.absolute_path))
    return list(dict.fromkeys(_words(error, expected) for error in errors))


def _words(error, expected):
    where = "".join(f"[{step}]" if isinstance(step, int) else f".{step}"
                    for step in error.absolute_path).lstrip(".")
    before = f"{where}: " if where else ""
    if error.validator == "additionalProperties":
        known = error.schema["properties"]
        name = next(n for n in error.instance if n not in known)
        return f"{before}unknown key '{name}'; expected {', '.join(sorted(known))}"
    if error.validator == "required":
        return f"{before}missing key {error.message.partition(' is a required')[0]}"
    got = json.dumps(error.instance, ensure_ascii=False, default=str)
    return f"{before}expected {expected(error.schema)}, got {got[:60]}"
