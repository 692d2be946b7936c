# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Bill of materials, sbom.cdx.json in the form CycloneDX 1.5: what constraints.txt pins.

It holds what `.venv` holds, tools of tests and builds among it. A stock ROS 2 machine has the
packages of its distribution instead.

"""

import json
from pathlib import Path
import re
import sys
from typing import Any
import uuid

TREE = Path(__file__).resolve().parent.parent
FILE = TREE / 'sbom.cdx.json'
NAME = 'ballscrew_monitor'


def bill() -> dict[str, Any]:
    """Return the bill of the pins and of the version that setup.py names."""
    pins = (TREE / 'constraints.txt').read_text()
    pairs = [line.split('==') for line in pins.splitlines() if not line.startswith('#')]
    version = re.findall(r"version='(.*)'", (TREE / 'setup.py').read_text())[0]
    return {
        'bomFormat': 'CycloneDX',
        'specVersion': '1.5',
        'serialNumber': f'urn:uuid:{uuid.uuid5(uuid.NAMESPACE_OID, NAME + version + pins)}',
        'version': 1,
        'metadata': {
            'component': {
                'type': 'application',
                'bom-ref': NAME,
                'name': NAME,
                'version': version,
                'licenses': [{'license': {'id': 'Apache-2.0'}}],
            }
        },
        'components': [_component(name, version) for name, version in pairs],
    }


def _component(name: str, version: str) -> dict[str, str]:
    canonical = re.sub('[-_.]+', '-', name).lower()
    url = f'pkg:pypi/{canonical}@{version}'
    return {'type': 'library', 'bom-ref': url, 'name': name, 'version': version, 'purl': url}


def main() -> int:
    """Write the file."""
    FILE.write_text(json.dumps(bill(), indent=1) + '\n')
    return 0


if __name__ == '__main__':
    sys.exit(main())
