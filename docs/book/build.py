"""Builds the book of docs/ into target/book: python3 docs/book/build.py PROGRAM MDBOOK

The pages' commands run with PROGRAM, and the pictures that they make go onto the pages; the pages of commands and keys are asked from PROGRAM.
What the pages link to goes along: other pages as chapters, files as files. Ends with exit code 1 where a page shows what the program does not
answer, a link of the book is dead, or a page asks for something from a network.
"""

import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path, PurePosixPath
from posixpath import normpath
from tempfile import TemporaryDirectory

import keys
import pages

ROOT = pages.ROOT
LINK = re.compile(r"\]\(([^)\s#]+)(#[^)\s]*)?\)")
OUTSIDE = re.compile(r"^[a-z]+:")
GENERATED = re.compile(r"^<!-- generated: ([\w-]+) -->$", re.MULTILINE)


def linked(name, text):
    """Paths below the project that a page's links lead to."""
    links = (link for link, _ in LINK.findall(text) if not OUTSIDE.match(link))
    return [normpath(str(PurePosixPath(name).parent / link)) for link in links]


def run_pages(program, work):
    """Runs the commands of all pages, two at a time: complaints, and the folder of each page's files."""
    names = [page for page in pages.pages() if any(isinstance(step, pages.Command) for step in pages.steps(page.read_text(encoding="utf-8")))]
    left_out = {words for _, words, _ in pages.not_run()}
    with ThreadPoolExecutor(2) as pool:
        ran = list(pool.map(lambda page: pages.run(page, pages.emptied(work / page.stem), program, left_out), names))
    return [complaint for complaints, _ in ran for complaint in complaints], {page: folder for page, (_, folder) in zip(names, ran)}


def with_figures(page, text, made, source):
    """The page with the pictures that its commands made."""

    def picture(found):
        file, words = found.groups()
        target = f"figures/{page.stem}/{file}"
        if made.get(page) and (made[page] / file).is_file():
            copy = source / page.relative_to(ROOT).parent / target
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(made[page] / file, copy)
        return f"![{words}]({target})\n\n*{words}*"

    return pages.FIGURE.sub(picture, text)


def generated(program):
    """The pages below docs/reference/ that the program tells: path and text; and the children of each list, for the summary."""
    found, children = {}, {"command-line": [], "scenario-keys": []}
    for name in keys.commands(program):
        found[f"docs/reference/command-line/{name}.md"] = keys.command_page(program, name)
        children["command-line"].append((name, f"docs/reference/command-line/{name}.md"))
    for name, one in keys.tables(program):
        text = keys.key_page(name, one)
        if text:
            found[f"docs/reference/scenario-keys/{name}.md"] = text
            children["scenario-keys"].append((f"\\[{name}\\]", f"docs/reference/scenario-keys/{name}.md"))
    return found, children


def write(source, name, text):
    path = source / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def copy(source, name):
    """A file, or the files of a folder that are the project's, beside the chapters."""
    listed = subprocess.run(["git", "ls-files", "--", name], cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\n")
    for file in filter(None, listed):
        if not file.endswith(".md"):
            (source / file).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / file, source / file)


def collect(program, source, made):
    """Chapters, files and the summary, in `source`."""
    summary = (pages.DOCS / "SUMMARY.md").read_text(encoding="utf-8")
    chapters = linked("docs/SUMMARY.md", summary)
    first = chapters[0]
    told, children = generated(program)
    lists = {"command-line": keys.command_list(program), "scenario-keys": keys.key_list(program)}
    others, seen, waiting = [], set(), list(chapters)
    while waiting:
        name = waiting.pop(0)
        if name in seen:
            continue
        seen.add(name)
        path = ROOT / name
        if path.suffix != ".md":
            copy(source, name)
            continue
        if name not in chapters:
            others.append(name)
        text = path.read_text(encoding="utf-8")
        waiting += linked(name, text)
        text = GENERATED.sub(lambda found: lists[found[1]], with_figures(path, text, made, source))
        if name == first:
            # The first chapter is the book's index.html: its links are seen from the top.
            write(source, "index.md", LINK.sub(lambda found: f"]({normpath(str(PurePosixPath(name).parent / found[1]))}{found[2] or ''})", text))
        else:
            write(source, name, text)
    for name, text in told.items():
        write(source, name, text)
    lines = []
    for line in summary.splitlines():
        link = LINK.search(line)
        if not link:
            lines.append(line)
            continue
        name = normpath(f"docs/{link[1]}")
        lines.append(line.replace(link[0], f"]({'index.md' if name == first else name})"))
        indent = " " * (len(line) - len(line.lstrip()) + 2)
        lines += [f"{indent}- [{title}]({child})" for title, child in children.get(PurePosixPath(name).stem, [])]
    titles = {name: re.search(r"^# (.+)$", (ROOT / name).read_text(encoding="utf-8"), re.MULTILINE)[1] for name in others}
    lines += ["", "# Reports and other pages", ""] + [f"- [{titles[name]}]({name})" for name in sorted(others)]
    write(source, "SUMMARY.md", "\n".join(lines) + "\n")


def dead(book):
    """Links and sources of the built pages that lead nowhere, and what they ask of a network."""
    found = []
    for page in sorted(book.rglob("*.html")):
        text = page.read_text(encoding="utf-8")
        if page.name == "toc.html" or page == book / "404.html":
            continue
        for kind, link in re.findall(r"<(a|img|script|link)\b[^>]*?\s(?:href|src)=\"([^\"]*)\"", text):
            if OUTSIDE.match(link):
                if kind != "a" and not link.startswith("data:"):
                    found.append(f"{page.relative_to(book)}: asks for {link}")
                continue
            file = link.split("#")[0].split("?")[0].replace("%20", " ")
            if file and not (page.parent / file).exists():
                found.append(f"{page.relative_to(book)}: {link} is not in the book")
    return found


def main(program, mdbook):
    source, book = ROOT / "target/book-source", ROOT / "target/book"
    pages.emptied(source)
    for file in ("book.toml", "narrow.css"):
        shutil.copy(pages.DOCS / "book" / file, source / file)
    with TemporaryDirectory() as work:
        complaints, made = run_pages(program, Path(work))
        collect(program, source / "src", made)
    shutil.rmtree(book, ignore_errors=True)
    subprocess.run([mdbook, "build", source, "-d", book], check=True, env={"PATH": "/usr/bin:/bin", "MDBOOK_LOG": "warn"})
    complaints += dead(book)
    print("\n\n".join(complaints) or f"target/book/index.html: {len(list(book.rglob('*.html')))} pages", file=sys.stderr if complaints else sys.stdout)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()))
