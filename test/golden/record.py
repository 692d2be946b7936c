# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Record the golden outputs again, see README.md.

    python test/golden/record.py                # of all cases
    python test/golden/record.py warm_up live   # of these

Outputs that are equal to those on file, but for rounding, stay as they are; the others are named.

"""

import argparse
from pathlib import Path
import sys
import tempfile
import time

TREE = Path(__file__).resolve().parents[2]
sys.path += [str(TREE), str(TREE / 'bags')]

from golden import compare  # noqa: E402
from golden.cases import CASES  # noqa: E402


def main() -> int:
    """Record the cases that the command line names, or all."""
    parser = argparse.ArgumentParser(description='Record the golden outputs again.')
    parser.add_argument('cases', nargs='*', choices=[[], *CASES], help='none: all of them')
    for case in parser.parse_args().cases or CASES:
        begin = time.process_time()
        with tempfile.TemporaryDirectory() as folder:
            said = compare.keep(case, CASES[case](Path(folder).resolve()))
        print(f'{case}: {time.process_time() - begin:.1f} s of the processor')
        for name, how in said.items():
            print(f'  {name}: {how[0]}')
    return 0


if __name__ == '__main__':
    sys.exit(main())
