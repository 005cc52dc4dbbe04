"""Pages that the program itself tells: its commands from their help, the keys of scenarios from their JSON Schema."""

import json
import subprocess


def asked(program, *words):
    """What the program answers; its help in lines of at most 100 characters."""
    return subprocess.run([program, *words], check=True, capture_output=True, text=True).stdout


def commands(program):
    """The names of all commands."""
    groups = asked(program, "--help").split("\nOptions:\n")[0].split("\n\n")[2:]
    names = [line.split()[0] for group in groups for line in group.splitlines()[1:]]
    return [name for name in names if name != "help"]


def common(help):
    """The options that every command has, as its help prints them."""
    return help[help.index("      --root <DIR>") : help.index("  -h, --help")]


def command_page(program, name):
    """A command's page: its help without the options that all have."""
    help = asked(program, name, "--help").rstrip()
    about, rest = help.split("\n\n", 1)
    options = rest.replace(common(rest), "")
    return f"# calibench {name}\n\n{' '.join(about.split())}.\n\n```text\n{options}\n```\n"


def command_list(program):
    """What stands on the page of all commands."""
    rows = []
    for name in commands(program):
        about = " ".join(asked(program, name, "--help").split("\n\n", 1)[0].split())
        rows.append(f"| [{name}](command-line/{name}.md) | {cell(about)} |")
    return "| command | what it does |\n|---|---|\n" + "\n".join(rows) + f"\n\nEvery command takes these options, too:\n\n```text\n{common(asked(program, 'list', '--help'))}```\n"


def cell(text):
    return text.replace("|", "\\|").replace("<", "&lt;").replace("\n", " ")


def schema(program):
    return json.loads(asked(program, "schema", "scenarios"))


def tables(program):
    """The tables and keys at the top of a scenario: name and schema, those without tables below them first."""
    return sorted(schema(program)["properties"].items())


def type_of(one):
    """A value's type and bounds, in words."""
    if "const" in one:
        return f"`{json.dumps(one['const'])}`"
    if "enum" in one:
        return ", ".join(f"`{json.dumps(value)}`" for value in one["enum"] if value is not None)
    parts = [type_of(part) for part in one.get("anyOf", one.get("oneOf", [])) if part.get("type") != "null"]
    if parts:
        return " or ".join(dict.fromkeys(part for part in parts if part))
    kinds = one.get("type", "")
    kinds = [kinds] if isinstance(kinds, str) else kinds
    words = {"integer": "whole number", "array": "list", "object": "table", "string": "text", "boolean": "true or false"}
    said = " or ".join(words.get(kind, kind) for kind in kinds if kind != "null")
    if "items" in one and isinstance(one["items"], dict):
        said += " of " + (type_of(one["items"]) or "values")
    low, high = one.get("minimum"), one.get("maximum")
    if low is not None and high is not None:
        said += f", {low:g} to {high:g}"
    elif low is not None or high is not None:
        said += f", at least {low:g}" if low is not None else f", at most {high:g}"
    return said


def inner(one):
    """The table that a value is, or that a list is of; None where it is none."""
    one = one.get("items", one) if isinstance(one.get("items", one), dict) else one
    return one if "properties" in one else None


def rows(one, before=""):
    """A row for each key of a table, and of tables in it."""
    needed = one.get("required", [])
    for name, value in one["properties"].items():
        about = value.get("description", "") + ("" if name not in needed or before else " Needed.")
        yield f"| `{before}{name}` | {cell(type_of(value))} | {cell(about.strip())} |"
        below = inner(value)
        if below:
            yield from rows(below, f"{before}{name}.")
        for number, part in enumerate(value.get("anyOf", []) + value.get("oneOf", [])):
            if inner(part):
                yield from rows(inner(part), f"{before}{name}.")


def table_of(one):
    return "| key | value | what it says |\n|---|---|---|\n" + "\n".join(dict.fromkeys(rows(one))) + "\n"


def variants(one):
    """The kinds of a table: a name and a schema each."""
    for part in (one.get("items") or one).get("oneOf", (one.get("items") or one).get("anyOf", [])):
        if "properties" not in part:
            continue
        names = [f'{key} = {json.dumps(value["const"])}' for key, value in part["properties"].items() if "const" in value]
        yield (", ".join(names) or ", ".join(part.get("required", [])) or "without these"), part


def key_page(name, one):
    """A table's page, or None for a key without a table."""
    text = f"# [{name}]\n\n{one.get('description', (one.get('items') or {}).get('description', '')) or 'A table of a scenario.'}\n"
    whole = inner(one)
    if whole:
        text += f"\n{table_of(whole)}"
    for title, part in variants(one):
        text += f"\n## {title}\n\n{part.get('description', '')}\n\n{table_of(part)}"
    return text if "|---|" in text else None


def key_list(program):
    """What stands on the page of all keys."""
    keys = []
    for name, one in tables(program):
        about = one.get("description", (one.get("items") or {}).get("description", ""))
        shown = f"[`[{name}]`](scenario-keys/{name}.md)" if key_page(name, one) else f"`{name}`"
        keys.append(f"| {shown} | {cell(type_of(one))} | {cell(about)} |")
    return "| table or key | value | what it says |\n|---|---|---|\n" + "\n".join(keys) + "\n"
