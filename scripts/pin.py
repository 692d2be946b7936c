# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Write constraints.txt: the newest versions of all that `.venv` holds, as pip resolves them today.

Run it with a Python of the lowest version, which has a pip of its own; the others must then be
tried by hand, because a version may leave out a newer Python.

"""

import json
from pathlib import Path
import re
import subprocess
import sys

TREE = Path(__file__).resolve().parent.parent
HEAD = """\
# Every package in .venv, exactly. Made by scripts/pin.py; valid on Python 3.11 to 3.14.
"""


def pin(package: dict[str, str]) -> str:
    """Return the line of a package; one that newer Pythons have within is pinned below them."""
    line = f'{package["name"].lower()}=={package["version"]}'
    newer = re.search(r'<\s*(3\.\d+)', package.get('requires_python', ''))
    return f'{line} ; python_version < "{newer[1]}"' if newer else line


def main() -> int:
    """Resolve the package with all its extras and write down what was chosen."""
    report = subprocess.run(
        [
            sys.executable,
            '-m',
            'pip',
            'install',
            '--quiet',
            '--dry-run',
            '--ignore-installed',
            '--report',
            '-',
            f'{TREE}[wheels,plot,bags,report,xlsx,page,areal,dask,docs,test]',
        ],
        check=True,
        stdout=subprocess.PIPE,
    ).stdout
    chosen = [item['metadata'] for item in json.loads(report)['install']]
    pins = sorted(
        pin(package)
        for package in chosen
        if package['name'].replace('_', '-') != 'ballscrew-monitor'
    )
    (TREE / 'constraints.txt').write_text(HEAD + '\n'.join(pins) + '\n')
    return 0


if __name__ == '__main__':
    sys.exit(main())
