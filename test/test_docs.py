# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Documentation that would rot: links, paths, commands, and the pages that are made."""

import ast
from contextlib import redirect_stdout
from functools import cache
import io
from pathlib import Path
import re
import runpy
import tokenize

from ballscrew_monitor.cli import main
import pytest

ROOT = Path(__file__).parents[1]
MADE = runpy.run_path(str(ROOT / 'scripts' / 'reference.py'))['pages']()
DOCS = ROOT / 'docs'
GUIDE = sorted((DOCS / 'guide').glob('*.md'))
REFERENCE = sorted((DOCS / 'reference').glob('*.md'))
PAGES = [
    ROOT / 'README.md',
    ROOT / 'CONTRIBUTING.md',
    ROOT / 'QUALITY_DECLARATION.md',
    ROOT / 'SECURITY.md',
    *sorted(DOCS.rglob('*.md')),
    ROOT / 'bags' / 'README.md',
    ROOT / 'studies' / 'README.md',
    ROOT / 'studies' / 'benchmark' / 'README.md',
]
SOURCES = [
    path
    for name in ('bags', 'ballscrew_monitor', 'bench', 'studies', 'surrogate', 'test')
    for path in sorted((ROOT / name).rglob('*.py'))
]
FOLDERS = [
    f'{folder.relative_to(ROOT)}/'
    for name in ('ballscrew_monitor', 'surrogate')
    for folder in sorted((ROOT / name).rglob('*'))
    if folder.is_dir() and (folder / '__init__.py').exists()
]
CODE_PATH = re.compile(
    r'(?<![\w/.~])((?:ballscrew_monitor|bags|bench|config|docs|launch|msg_defs|scripts|studies'
    r'|surrogate|test)/(?:[\w.-]+/)*[\w-]*(?:\.\w+)?)'
)
HISTORY = re.compile(
    r'\b(formerly|former|no longer|used to|(?:was|were) tried|left out, tried|tried and left out'
    r'|previous(?:ly)? version|earlier version|in the past|so far|not any ?more|nowadays)\b',
    re.IGNORECASE,
)
FOREIGN = re.compile(
    r'\b(told of|anew|of late|what it stands for|is none|whole of)\b', re.IGNORECASE
)
OPENING = re.compile(
    r'(What|From|Which|Just|How|Where|When|Why|Who|Whose|Whether|Whatever|Takes|Makes|Says)\b'
)
COMMAND = re.compile(r'ballscrew ((?:(?:surface|screw|oil) )?[a-z]+(?:-[a-z]+)?)((?: [^`\n#]*)?)')
LINK = re.compile(r'\]\(([^)#]*)(?:#([^)]+))?\)')
EMPTY = re.compile(r'^(\|.*\| \|)$', re.MULTILINE)
FUNCTION = re.compile(r'`([\w/]+/\w+\.py): (\w+)`')
DOCUMENT = re.compile(r'\b(docs/[\w/]+\.md)')
IN_WORKSPACE = 'ln -s ballscrew_monitor/msg_defs'  # a path beside the repository


def name_of(page):
    return str(page.relative_to(ROOT))


@cache
def text_of(path):
    return path.read_text(encoding='utf-8')


def offenders(check, paths):
    """Return `file:line: why` of all that a check of a file and its text finds."""
    return [
        f'{name_of(path)}:{line}: {why}'
        for path in paths
        for line, why in check(path, text_of(path))
    ]


def report(lines):
    """Hold that there is no offender; the failure has each on a line of its own."""
    assert not lines, '\n'.join(lines)


def found(pattern, text):
    """Yield the line of each match of a pattern, and its groups."""
    for match in pattern.finditer(text):
        yield text.count('\n', 0, match.start()) + 1, *match.groups()


def phrases(pattern, text):
    """Yield the line of each phrase, which may go over the end of a line, and its words."""
    words = [
        (word, number) for number, line in enumerate(text.split('\n'), 1) for word in line.split()
    ]
    joined = ' '.join(word for word, _ in words)
    for match in pattern.finditer(joined):
        yield words[joined.count(' ', 0, match.start())][1], match[0]


def anchors(page):
    """Return the anchors that the headings of a page make."""
    headings = re.findall(r'^#+ (.*)$', text_of(page), flags=re.MULTILINE)
    return {re.sub(r'[^\w\- ]', '', heading.lower()).replace(' ', '-') for heading in headings}


def defines(file, name):
    """Tell whether a module defines a function or class of that name."""
    return file.is_file() and bool(re.search(rf'^(?:def|class) {name}\b', text_of(file), re.M))


@cache
def help_of(*words):
    """Return what `--help` prints for a command."""
    with redirect_stdout(io.StringIO()) as printed, pytest.raises(SystemExit):
        main([*words, '--help'])
    return printed.getvalue()


def broken_links(page, text):
    for line, target, anchor in found(LINK, text):
        if not target.startswith('http'):
            file = page.parent / target if target else page
            if not file.exists() or (anchor and anchor not in anchors(file)):
                yield line, f'{target}#{anchor}' if anchor else target


def missing_paths(page, text):
    inside = text.replace(IN_WORKSPACE, IN_WORKSPACE.replace('ballscrew_monitor/', ''))
    for line, named in found(CODE_PATH, inside):
        if not (ROOT / named.rstrip('.')).exists():
            yield line, named


def missing_functions(page, text):
    for line, file, name in found(FUNCTION, text):
        if not defines(ROOT / file, name):
            yield line, f'{file}: {name}'


def missing_documents(path, text):
    for line, named in found(DOCUMENT, text):
        if not (ROOT / named).exists():
            yield line, named


def unknown_options(page, text):
    for line, command, rest in found(COMMAND, text):
        known = help_of(*command.split())
        for option in re.findall(r'--[a-zA-Z][\w-]*', rest):
            if option not in known:
                yield line, f'{command} {option}'


def history(page, text):
    yield from phrases(HISTORY, text)


def foreign_words(page, text):
    """No page has phrases that a native speaker would not write."""
    yield from phrases(FOREIGN, text)


def foreign_in(text):
    words = ' '.join(text.split()).replace('there is none', '')
    return set(FOREIGN.findall(words)) - {'is None'}


def foreign_words_of_a_source(path, text):
    """No comment or docstring has those phrases, and a module opens with a noun."""
    docstring = ast.get_docstring(ast.parse(text)) or ''
    if OPENING.match(docstring):
        yield 1, docstring.split()[0]
    if not foreign_in(text):  # which is quicker than its tokens
        return
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT or token.string.startswith('"""'):
            for phrase in foreign_in(token.string):
                yield token.start[0], phrase


def names_without_meaning(page, text):
    """Each row of a table ends in words, but that of what is not wrong."""
    for line, row in found(EMPTY, text):
        if '| NONE |' not in row:
            yield line, row


def folders_without_a_row(page, text):
    """Each folder of both packages has its row, and its entry is a function or class there."""
    for folder in FOLDERS:
        rows = [line for line in text.splitlines() if line.startswith(f'| `{folder}` |')]
        if len(rows) != 1:
            yield 1, f'{folder} has {len(rows)} rows'
        for module, name in re.findall(r'`(\w+\.py): (\w+)`', ''.join(rows[:1])):
            if not defines(ROOT / folder / module, name):
                yield 1, f'{folder}: no {name} in {module}'


def test_links_lead_somewhere():
    report(offenders(broken_links, PAGES))


def test_paths_named_exist():
    report(offenders(missing_paths, PAGES))


def test_functions_named_exist():
    report(offenders(missing_functions, PAGES))


def test_documents_named_in_code_exist():
    report(offenders(missing_documents, SOURCES))


def test_commands_of_the_readme_exist():
    shown = set(re.findall(r'^\| `ballscrew (\w+)', text_of(ROOT / 'README.md'), re.MULTILINE))
    assert shown >= {'point', 'surface', 'run'}
    assert not [command for command in shown if command not in help_of()]


def test_commands_of_a_page_have_their_options():
    report(offenders(unknown_options, [ROOT / 'README.md', *GUIDE, *REFERENCE]))


@pytest.mark.parametrize('path', MADE, ids=name_of)
def test_what_is_made_is_what_its_declarations_make(path):
    """After a change of a declaration: `python scripts/reference.py`."""
    assert text_of(path) == MADE[path]


def test_every_declared_name_has_a_meaning():
    report(offenders(names_without_meaning, MADE))


def test_guide_is_without_history():
    report(offenders(history, GUIDE))


def test_pages_are_in_plain_words():
    report(offenders(foreign_words, [page for page in PAGES if page not in MADE]))


def test_sources_are_in_plain_words():
    report(offenders(foreign_words_of_a_source, SOURCES))


def test_architecture_names_every_folder():
    report(offenders(folders_without_a_row, [DOCS / 'architecture.md']))


def test_front_page_leads_to_every_page():
    front = text_of(DOCS / 'README.md')
    pages = (*GUIDE, *REFERENCE, *sorted((DOCS / 'theory').glob('*.md')))
    assert not [name_of(page) for page in pages if f'({page.relative_to(DOCS)})' not in front]


def test_index_lists_the_decisions():
    pages = {page.name for page in (DOCS / 'decisions').glob('*.md')} - {'README.md'}
    text = text_of(DOCS / 'decisions' / 'README.md')
    assert not [name for name in pages if f'({name})' not in text]


def test_every_picture_is_on_a_page():
    text = ''.join(map(text_of, PAGES))
    assert not [path.name for path in DOCS.rglob('*.png') if f'/{path.name})' not in text]


README = ROOT / 'README.md'
FOREIGN_SOURCE = '''"""What a row is."""
# A call of it, told
# anew.
TEXT = 'told anew'


def law():
    """
    Return none, as there is none, and is None.

    Told
    of it.

    """
'''


@pytest.mark.parametrize(
    ('check', 'text', 'lines'),
    [
        (broken_links, '[a](docs/README.md)\n[b](nowhere.md) and [c](http://x)', [2]),
        (broken_links, '[a](CONTRIBUTING.md#rules)\n[b](CONTRIBUTING.md#laws)', [2]),
        (broken_links, '\n[a](#nothing)', [2]),
        (missing_paths, 'See `test/conftest.py`.\nSee surrogate/nothing.py', [2]),
        (
            missing_functions,
            '`surrogate/tasks/progress.py: Progress`\n`surrogate/tasks/progress.py: Law`',
            [2],
        ),
        (missing_functions, '`surrogate/nothing.py: law`', [1]),
        (missing_documents, f'# docs/README.md\n# docs/{"nothing"}.md', [2]),
        (unknown_options, 'ballscrew point --json\n`ballscrew point --xml`', [2]),
        (history, 'It is\nno\nlonger there.', [2]),
        (names_without_meaning, '| a | b |\n| a | |\n| 0 | NONE | |', [2]),
        (foreign_words, 'a\nb The\nwhole  of\nit', [3]),
        (foreign_words_of_a_source, FOREIGN_SOURCE, [1, 3, 8]),
        (folders_without_a_row, '', [1] * len(FOLDERS)),
        (
            folders_without_a_row,
            text_of(DOCS / 'architecture.md').replace(': MonitorSettings`', ': X`'),
            [1],
        ),
    ],
)
def test_each_check_finds_what_offends(check, text, lines):
    assert [line for line, _ in check(README, text)] == lines
