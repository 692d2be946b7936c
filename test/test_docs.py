# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Documentation that would rot: links, the parameter table, the commands of the README."""

from pathlib import Path
import re

from ballscrew_monitor.cli import main
from ballscrew_monitor.node.parameters import markdown_table
import pytest

ROOT = Path(__file__).parents[1]
PAGES = [
    ROOT / 'README.md',
    ROOT / 'CONTRIBUTING.md',
    *sorted((ROOT / 'docs').glob('*.md')),
    ROOT / 'bags' / 'README.md',
]


@pytest.mark.parametrize('page', PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path):
    """Every relative link of a page names a file of the repository."""
    for target in re.findall(r'\]\(([^)#]+)\)', page.read_text(encoding='utf-8')):
        if not target.startswith('http'):
            assert (page.parent / target).exists(), target


def test_parameter_page_is_the_table():
    """The page holds the table as the code makes it."""
    page = (ROOT / 'docs' / 'parameters.md').read_text(encoding='utf-8')
    assert markdown_table().strip() in page


def test_commands_of_the_readme_exist(capsys):
    """Each command that the README's table shows is one that the program knows."""
    readme = (ROOT / 'README.md').read_text(encoding='utf-8')
    with pytest.raises(SystemExit):
        main(['--help'])
    help_text = capsys.readouterr().out
    shown = set(re.findall(r'^\| `ballscrew (\w+)', readme, flags=re.MULTILINE))
    assert shown >= {'point', 'surface', 'run'}
    for command in shown:
        assert command in help_text
