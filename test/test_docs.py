# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Documentation that would rot: links, paths, commands, the parameter table, short pages."""

import ast
import io
from pathlib import Path
import re
import runpy
import tokenize

from ballscrew_monitor.cli import main
import pytest

ROOT = Path(__file__).parents[1]
TABLE = runpy.run_path(str(ROOT / 'scripts' / 'parameter_pages.py'))['markdown_table']().strip()
DOCS = ROOT / 'docs'
GUIDE = sorted((DOCS / 'guide').glob('*.md'))
REFERENCE = sorted((DOCS / 'reference').glob('*.md'))
PAGES = [
    ROOT / 'README.md',
    ROOT / 'CONTRIBUTING.md',
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
COMMAND = re.compile(r'ballscrew ((?:(?:surface|screw|oil) )?[a-z]+)((?: [^`\n#]*)?)')
LINK = 'ln -s ballscrew_monitor/msg_defs'  # in a workspace, which holds the repository
MOST_PAGES, MOST_WORDS = 11, 900


def name_of(page):
    return str(page.relative_to(ROOT))


def anchors(page):
    """Return the anchors that the headings of a page make."""
    headings = re.findall(r'^#+ (.*)$', page.read_text(encoding='utf-8'), flags=re.MULTILINE)
    return {re.sub(r'[^\w\- ]', '', heading.lower()).replace(' ', '-') for heading in headings}


def defines(file, name):
    """Tell whether a module defines a function or class of that name."""
    return bool(re.search(rf'^(?:def|class) {name}\b', file.read_text(encoding='utf-8'), re.M))


def words_of(page):
    """Return the text of a page without line breaks and without the table that code makes."""
    text = page.read_text(encoding='utf-8').replace(TABLE, '')
    return ' '.join(text.split())


def help_of(capsys, *words):
    """Return what `--help` prints for a command."""
    with pytest.raises(SystemExit):
        main([*words, '--help'])
    return str(capsys.readouterr().out)


@pytest.mark.parametrize('page', PAGES, ids=name_of)
def test_links_lead_somewhere(page):
    links = re.findall(r'\]\(([^)#]*)(?:#([^)]+))?\)', page.read_text(encoding='utf-8'))
    for target, anchor in links:
        if not target.startswith('http'):
            file = page.parent / target if target else page
            assert file.exists(), target
            assert not anchor or anchor in anchors(file), f'{target}#{anchor}'


@pytest.mark.parametrize('page', PAGES, ids=name_of)
def test_paths_named_exist(page):
    text = page.read_text(encoding='utf-8')
    for named in CODE_PATH.findall(text.replace(LINK, LINK.replace('ballscrew_monitor/', ''))):
        assert (ROOT / named.rstrip('.')).exists(), named


@pytest.mark.parametrize('page', PAGES, ids=name_of)
def test_functions_named_exist(page):
    text = page.read_text(encoding='utf-8')
    for file, name in re.findall(r'`([\w/]+/\w+\.py): (\w+)`', text):
        assert defines(ROOT / file, name), f'{file}: {name}'


def test_documents_named_in_code_exist():
    for path in SOURCES:
        for named in re.findall(r'\bdocs/[\w/]+\.md', path.read_text(encoding='utf-8')):
            assert (ROOT / named).exists(), f'{name_of(path)}: {named}'


def test_commands_of_the_readme_exist(capsys):
    readme = (ROOT / 'README.md').read_text(encoding='utf-8')
    help_text = help_of(capsys)
    shown = set(re.findall(r'^\| `ballscrew (\w+)', readme, flags=re.MULTILINE))
    assert shown >= {'point', 'surface', 'run'}
    for command in shown:
        assert command in help_text


@pytest.mark.parametrize('page', [ROOT / 'README.md', *GUIDE, *REFERENCE], ids=name_of)
def test_commands_of_a_page_have_their_options(page, capsys):
    for command, rest in COMMAND.findall(page.read_text(encoding='utf-8')):
        known = help_of(capsys, *command.split())
        for option in re.findall(r'--[a-zA-Z][\w-]*', rest):
            assert option in known, f'{command} {option}'


def test_guide_is_of_few_pages():
    """A reader finds the page of a task at a glance."""
    assert len(GUIDE) <= MOST_PAGES


@pytest.mark.parametrize('page', GUIDE, ids=name_of)
def test_guide_is_short(page):
    assert len(page.read_text(encoding='utf-8').split()) <= MOST_WORDS


@pytest.mark.parametrize('page', [*GUIDE, *REFERENCE], ids=name_of)
def test_pages_are_without_history(page):
    assert not HISTORY.findall(words_of(page))


@pytest.mark.parametrize('page', PAGES, ids=name_of)
def test_pages_are_in_plain_words(page):
    """No page has phrases that a native speaker would not write."""
    assert not FOREIGN.findall(words_of(page))


@pytest.mark.parametrize('path', SOURCES, ids=name_of)
def test_sources_are_in_plain_words(path):
    """No comment or docstring has those phrases, and a module opens with a noun."""
    text = path.read_text(encoding='utf-8')
    assert not OPENING.match(ast.get_docstring(ast.parse(text)) or '')
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT or token.string.startswith('"""'):
            words = ' '.join(token.string.split()).replace('there is none', '')
            assert not set(FOREIGN.findall(words)) - {'is None'}, f'line {token.start[0]}'


def test_front_page_leads_to_every_page():
    front = (DOCS / 'README.md').read_text(encoding='utf-8')
    for page in (*GUIDE, *REFERENCE, *sorted((DOCS / 'theory').glob('*.md'))):
        assert f'({page.relative_to(DOCS)})' in front


@pytest.mark.parametrize('index', ['decisions', 'notes'])
def test_index_lists_its_pages(index):
    text = (DOCS / index / 'README.md').read_text(encoding='utf-8')
    for page in (DOCS / index).glob('*.md'):
        assert page.name == 'README.md' or f'({page.name})' in text


def test_every_picture_is_on_a_page():
    text = ''.join(page.read_text(encoding='utf-8') for page in PAGES)
    for picture in DOCS.rglob('*.png'):
        assert f'/{picture.name})' in text, picture.name


@pytest.mark.parametrize('folder', FOLDERS)
def test_architecture_names_every_folder(folder):
    """Each folder of both packages has its row, and its entry is a function or class there."""
    page = (DOCS / 'architecture.md').read_text(encoding='utf-8')
    rows = [line for line in page.splitlines() if line.startswith(f'| `{folder}` |')]
    assert len(rows) == 1
    for module, name in re.findall(r'`(\w+\.py): (\w+)`', rows[0]):
        assert defines(ROOT / folder / module, name)
