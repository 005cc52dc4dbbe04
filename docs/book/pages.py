"""The pages of docs/: what stands in their fenced blocks, and how their commands are run.

A ```console block holds commands, each on a line that begins with `$ ` (what goes on in the next lines has `> ` before it),
and below each what it answers, on standard output and standard error. All commands of a page run from top to bottom in
one shell, in one folder that is empty at first. In what is shown `...` stands for any text of a line, and alone on a line
for any number of lines. A command that ends with another exit code than 0 is followed by `$ echo $?`.

A fenced block of another language below a paragraph that ends with a file's name, as in "Save it as `board.toml`:",
becomes this file before the commands below it run. `<!-- figure: FILE | words -->` is a picture that the page's commands make.
`<!-- first: COMMAND -->` runs unseen where it stands: it brings what readers have, as photographs of their own. It finds
`project NAME...`, which makes the folder a project with these scenarios of ours, and `ours FILE...`, which copies files of ours.
Other blocks, indented ones too, show how something is written; a line of theirs that begins as a command is one that nobody runs.
"""

import os
import re
import shutil
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
FENCE = re.compile(r"^```(\w*)[^\n]*\n(.*?)^```\s*$", re.DOTALL | re.MULTILINE)
STEP = re.compile(rf"{FENCE.pattern}|^<!-- first: (.+?) -->$", re.DOTALL | re.MULTILINE)
INDENTED = re.compile(r"^ {4}(?:\$ )?((?:calibench|just|\./bootstrap|cargo|python3?|pip|git|docker|npx|mdbook) .*)$", re.MULTILINE)
FIGURE = re.compile(r"^<!-- figure: (\S+) \| (.+?) -->$", re.MULTILINE)
NAMED = re.compile(r"`([\w./-]+)`:\s*\Z")
SHELLS = {"sh", "bash", "shell", "zsh"}


@dataclass
class Command:
    """A command, its place, and what the page says that it answers."""

    line: int
    words: str
    shown: list = field(default_factory=list)
    seen: bool = True


@dataclass
class File:
    """A block that becomes a file."""

    line: int
    name: str
    text: str


def pages(folder=DOCS):
    """All pages, in the order of their paths."""
    return sorted(folder.rglob("*.md"))


def steps(text):
    """What a page does: its files and commands, in order."""
    found = []
    for block in STEP.finditer(text):
        language, inside, first = block.groups()
        line = text.count("\n", 0, block.start()) + 2
        if first:
            found.append(Command(line - 1, first, seen=False))
            continue
        named = NAMED.search(text[: block.start()])
        if language == "console":
            found += commands(inside, line)
        elif named:
            found.append(File(line, named[1], inside))
    return found


def commands(block, line):
    """The commands of a console block that begins at `line`."""
    found = []
    for number, text in enumerate(block.splitlines(), line):
        if found and not found[-1].shown and text.startswith("> "):
            found[-1].words += "\n" + text[2:]
        elif text.startswith("$ "):
            found.append(Command(number, text[2:]))
        elif found:
            found[-1].shown.append(text.rstrip())
        else:
            raise ValueError(f"line {number}: a console block begins with a command: {text}")
    for one in found:
        while one.shown and not one.shown[-1]:
            one.shown.pop()
    return found


def indented(text):
    """Commands of indented blocks, without what follows their `#`."""
    return [words.split("  #")[0].rstrip() for words in INDENTED.findall(FENCE.sub("", text))]


def figures(text):
    """The pictures that a page's commands make: names and words."""
    return FIGURE.findall(text)


def matches(shown, answered):
    """Whether lines are what a page shows, with its `...`."""
    pattern = ""
    for line in shown:
        if line == "...":
            pattern += r"(?:[^\n]*\n)*?"
        else:
            pattern += "[^\n]*?".join(re.escape(part) for part in line.split("...")) + "\n"
    text = "".join(f"{line.rstrip()}\n" for line in answered)
    return re.fullmatch(pattern, text) is not None


# What commands before a page's own may call.
OURS = r"""
ours() { for file; do mkdir -p "$(dirname "$file")" && cp -r "$OURS/$file" "$file" || return; done; }
project() {
    mkdir -p scenarios reference/baselines methods
    for name; do
        ours "scenarios/$name.toml" || return
        for file in "$OURS/reference/baselines/${name//\//--}".*; do [ ! -e "$file" ] || cp "$file" reference/baselines; done
    done
}
"""


class Shell:
    """A shell in an empty folder that has the program on its path, and keeps its folder and variables from command to command."""

    def __init__(self, folder, program):
        folder = Path(folder).resolve()
        if ROOT in folder.parents:
            raise ValueError(f"{folder} lies in the project: the commands would write into its records")
        bin = folder / "bin"
        bin.mkdir(parents=True)
        (bin / "calibench").symlink_to(Path(program).resolve())
        self.folder = folder / "here"
        self.folder.mkdir()
        own = {name: value for name, value in os.environ.items() if not name.startswith("CALIBENCH_")}
        own |= {"OURS": str(ROOT), "PATH": f"{bin}{os.pathsep}{own['PATH']}", "HOME": str(self.folder), "LC_ALL": "C.UTF-8", "PYTHONDONTWRITEBYTECODE": "1"}
        self.process = subprocess.Popen(
            ["bash", "--noprofile", "--norc"], cwd=self.folder, env=own, text=True, bufsize=1,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        )  # fmt: skip
        self.code = 0
        self.run(OURS)

    def run(self, words):
        """Lines that a command answers, and its exit code."""
        mark = "<<end of a command>>"
        # The exit code stays for an `echo $?` that follows.
        self.process.stdin.write(f"{{\n{words}\n}} < /dev/null\nkept=$?; printf '\\n{mark} %s\\n' $kept; (exit $kept)\n")
        self.process.stdin.flush()
        lines = []
        for line in self.process.stdout:
            if line.startswith(mark):
                self.code = int(line.split()[-1])
                while lines and not lines[-1]:
                    lines.pop()
                return lines, self.code
            lines.append(line.rstrip("\n"))
        raise ChildProcessError(f"the shell ended at: {words}")

    def write(self, file):
        """A file of the page, in the folder where the shell is now."""
        path = Path(self.run("pwd")[0][-1]) / file.name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(file.text, encoding="utf-8")

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def run(page, folder, program, leave_out=()):
    """Runs a page's commands in `folder`, but those of `leave_out`. Returns its complaints, a text each, and the folder that the page's files are in."""
    text = Path(page).read_text(encoding="utf-8")
    name = Path(page).name
    complaints = []
    shell = Shell(folder, program)
    todo = [step for step in steps(text) if not (isinstance(step, Command) and step.words in leave_out)]
    for step, after in zip(todo, [*todo[1:], None]):
        if isinstance(step, File):
            shell.write(step)
            continue
        answered, code = shell.run(step.words)
        if code and not (isinstance(after, Command) and after.words == "echo $?"):
            complaints.append(f"{name}:{step.line}: $ {step.words}\nended with exit code {code}:\n" + "\n".join(answered))
        elif step.seen and not matches(step.shown, answered):
            complaints.append(f"{name}:{step.line}: $ {step.words}\nthe page shows:\n" + "\n".join(step.shown) + "\nit answers:\n" + "\n".join(answered))
    shell.close()
    for figure, _ in figures(text):
        picture = shell.folder / figure
        if not picture.is_file() or picture.stat().st_size < 1000:
            complaints.append(f"{name}: no command makes the picture {figure}")
    return complaints, shell.folder


def rewritten(page, folder, program, leave_out=()):
    """The page's text with what its commands answer now in place of what it showed; lines of a text that still agrees are left."""
    text = Path(page).read_text(encoding="utf-8").splitlines()
    shell = Shell(folder, program)
    moved = 0
    for step in steps("\n".join(text) + "\n"):
        if isinstance(step, File):
            shell.write(step)
        elif step.words not in leave_out:
            answered, _ = shell.run(step.words)
            if step.seen and not matches(step.shown, answered):
                first = step.line - 1 + moved + step.words.count("\n") + 1
                text[first : first + len(step.shown)] = answered
                moved += len(answered) - len(step.shown)
    shell.close()
    return "\n".join(text) + "\n"


def not_run():
    """Commands that no test runs: page, first line, why."""
    rows = [line.split(" | ") for line in (DOCS / "book/not-run.txt").read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    return [tuple(part.strip() for part in row) for row in rows]


def emptied(folder):
    """A folder that holds nothing."""
    shutil.rmtree(folder, ignore_errors=True)
    Path(folder).mkdir(parents=True)
    return Path(folder)
