# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Make `.venv` and the nominal bag; run by the Python that `.venv` is to be made of.

Each step has a stamp, the hash of what it depends on: a step is done again when its stamp is
missing or different, and so are those after it that build on it. A stamp is written when its step
is complete, so an interrupted set-up goes on where it stopped. Compiling the solver takes one core
longer than anything else: it begins as soon as it can, beside the steps after it. Only the
standard library is used.

"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
import contextlib
import dataclasses
import fcntl
import hashlib
import json
import os
from pathlib import Path
import shutil
import subprocess
import sys
import threading
import time

TREE = Path(__file__).resolve().parent.parent
VENV = TREE / '.venv'
PYTHON = VENV / 'bin' / 'python'
PINS = TREE / 'constraints.txt'
STAMPS = VENV / 'set_up.json'
LOG = TREE / 'log' / 'set_up.log'
SOLVER_LOG = TREE / 'log' / 'solver.log'  # of what is at work at the same time
INTERFACES = TREE / 'msg_defs'
INSTALLED_INTERFACES = VENV / 'ballscrew_msgs.txt'
PACKAGE = 'ballscrew_monitor'
SHARED = ('config', 'launch')  # folders of which each file is installed
BAG = TREE / 'bags' / 'nominal_cycle'
BAG_GENERATOR = TREE / 'bags' / 'nominal_cycle.py'
# Other modules that decide what the bag looks like.
BAG_SOURCES = (
    'bags/*.py',
    f'{PACKAGE}/recordings/bag_writer.py',
    f'{PACKAGE}/recordings/message_definitions.py',
)
# What the solver is compiled with.
NUMERICAL = ('llvmlite', 'numba', 'numpy', 'pyyaml', 'scipy')
# What is compiled, and what calls it.
COMPILED = (
    'surrogate.ehl.solver',
    'ballscrew_monitor.judge.many',
    'ballscrew_monitor.health.collect',
)
SOLVER_SOURCES = (
    'surrogate/ehl/kernels/*.py',
    'surrogate/ehl/*.py',
    'surrogate/surface/*.py',
    'surrogate/formulas/torque.py',
    f'{PACKAGE}/judge/*.py',
)
# An installer must neither ask nor follow a user's own idea of where packages go.
PIP = (PYTHON, '-m', 'pip', '--disable-pip-version-check', '--no-input')
# Bytecode is made when a module is first imported: most of what is installed never is.
INSTALL = (*PIP, 'install', '--no-compile', '--no-deps', '--no-build-isolation')


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Step:
    """A part of the set-up: what to say, what to do, and the hash of what it depends on."""

    name: str
    text: str
    key: str
    work: Callable[[], None]
    made: bool = True  # False when what the step makes is plainly not there
    beside: bool = False  # True when no step after it needs what it makes


class Failure(Exception):
    """One sentence about what went wrong, and the log that tells the rest."""

    def __init__(self, sentence: str, log: Path | None = None) -> None:
        """Take the log of all steps unless told otherwise."""
        super().__init__(sentence)
        self.log = log or LOG


class Stamps:
    """The keys of the steps that are complete, in a file that is replaced as a whole."""

    def __init__(self, kept: dict[str, str]) -> None:
        """Begin with what is known to be complete."""
        self._kept = kept
        self._one_at_a_time = threading.Lock()

    def remove(self, step: Step) -> None:
        """Have a step count as not done."""
        with self._one_at_a_time:
            self._kept.pop(step.name, None)
            if STAMPS.exists():
                self._write()

    def add(self, step: Step) -> None:
        """Have a step count as done."""
        with self._one_at_a_time:
            self._kept[step.name] = step.key
            self._write()

    def _write(self) -> None:
        fresh = STAMPS.with_suffix('.new')
        fresh.write_text(json.dumps(self._kept, indent=2) + '\n')
        fresh.replace(STAMPS)


def digest(*parts: str, files: Iterable[Path] = ()) -> str:
    """Return the SHA-256 of some words and of the names and contents of some files."""
    content = hashlib.sha256('\0'.join(parts).encode())
    for path in sorted(files):
        content.update(f'\0{path.relative_to(TREE)}\0'.encode() + path.read_bytes())
    return content.hexdigest()


def run(
    *command: object, log: Path | None = None, variables: Mapping[str, str] | None = None
) -> None:
    """Run a command with its output going to a log; raise Failure when it fails."""
    words = [str(word) for word in command]
    log = log or LOG
    with log.open('a') as output:
        print('$', *words, file=output, flush=True)
        done = subprocess.run(
            words,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=output,
            cwd=TREE,
            env={**os.environ, 'PIP_USER': '0', **(variables or {})},
            check=False,
        )
    if done.returncode:
        raise Failure(f'{Path(words[0]).name} failed with exit code {done.returncode}', log)


def make_environment() -> None:
    """Remake the environment with what the solver is compiled with."""
    run(sys.executable, '-m', 'venv', '--clear', VENV)
    # What has no wheel is built with the pinned setuptools too.
    run(*INSTALL, '--constraint', PINS, 'setuptools', *NUMERICAL)


def install_packages() -> None:
    """Install the other pinned packages."""
    run(*INSTALL, '--requirement', PINS)


def build_interfaces() -> None:
    """Build and install msg_defs into the environment, where nothing has to be sourced."""
    remove_installed_interfaces()
    build = VENV / 'build'
    shutil.rmtree(build, ignore_errors=True)
    prefix = {
        'AMENT_PREFIX_PATH': str(VENV),
        'CMAKE_PREFIX_PATH': str(VENV),
        'PATH': f'{VENV / "bin"}{os.pathsep}{os.environ["PATH"]}',
    }
    run(
        VENV / 'bin' / 'cmake',
        '-S',
        INTERFACES,
        '-B',
        build,
        '-G',
        'Ninja',
        '-DCMAKE_BUILD_TYPE=Release',
        '-DBUILD_TESTING=OFF',
        f'-DCMAKE_INSTALL_PREFIX={VENV}',
        f'-DPython3_EXECUTABLE={PYTHON}',
        f'-DCMAKE_PROJECT_INCLUDE={TREE / "scripts" / "relocate_ros_wheels.cmake"}',
        variables=prefix,
    )
    run(VENV / 'bin' / 'cmake', '--build', build, '--target', 'install', variables=prefix)
    shutil.copy(build / 'install_manifest.txt', INSTALLED_INTERFACES)
    shutil.rmtree(build)
    run(
        PYTHON,
        '-c',
        'from ballscrew_msgs.msg import BallScrewState as State; '
        'from rclpy.serialization import serialize_message; serialize_message(State())',
    )


def remove_installed_interfaces() -> None:
    """Remove what an earlier build installed: a message that is gone must not stay importable."""
    if INSTALLED_INTERFACES.exists():
        for line in INSTALLED_INTERFACES.read_text().splitlines():
            Path(line).unlink(missing_ok=True)


def install_package() -> None:
    """Install the package so that the tree itself is what runs, and nothing goes stale."""
    run(*INSTALL, '--editable', TREE)
    share = VENV / 'share'
    index = share / 'ament_index' / 'resource_index' / 'packages'
    link(index / PACKAGE, TREE / 'resource' / PACKAGE)
    link(share / PACKAGE / 'package.xml', TREE / 'package.xml')
    for name in SHARED:
        link_files(share / PACKAGE / name, TREE / name)
    # Launch tools look for executables here.
    for name in ('ballscrew', PACKAGE):
        link(VENV / 'lib' / PACKAGE / name, VENV / 'bin' / name)


def link(place: Path, target: Path) -> None:
    """Make `place` a relative symbolic link to `target`."""
    place.parent.mkdir(parents=True, exist_ok=True)
    place.unlink(missing_ok=True)
    place.symlink_to(os.path.relpath(target, place.parent))


def link_files(place: Path, folder: Path) -> None:
    """Make `place` a directory of links to the files of `folder`."""
    # Launch tools walk the tree without following links to directories.
    if place.is_symlink():
        place.unlink()
    elif place.exists():
        shutil.rmtree(place)
    for path in files_below(folder):
        link(place / path.relative_to(folder), path)


def files_below(folder: Path) -> list[Path]:
    """Return the files of a folder and of those in it, without bytecode."""
    return sorted(
        path for path in folder.rglob('*') if path.is_file() and '__pycache__' not in path.parts
    )


def generate_bag() -> None:
    """Regenerate the bag of the nominal cycle."""
    shutil.rmtree(BAG, ignore_errors=True)
    run(PYTHON, BAG_GENERATOR)


def compile_solver() -> None:
    """Compile contact solver and judgement: the first solve and recording do not wait for it."""
    SOLVER_LOG.write_text('')

    def prepare(module: str) -> None:
        run(PYTHON, '-c', f'from {module} import prepare; prepare()', log=SOLVER_LOG)

    with ThreadPoolExecutor() as pool:
        list(pool.map(prepare, COMPILED))


def steps() -> list[Step]:
    """Return the steps in order, with their keys as the tree is now."""
    environment = digest(
        sys.executable, sys.version, str(VENV), files=[Path(__file__).resolve(), PINS]
    )
    interfaces = [path for path in INTERFACES.rglob('*') if path.is_file()]
    cmake = TREE / 'scripts' / 'relocate_ros_wheels.cmake'
    declared = [TREE / name for name in ('package.xml', 'setup.cfg', 'setup.py')]
    shared = [str(path.relative_to(TREE)) for name in SHARED for path in files_below(TREE / name)]
    bag = [path for pattern in BAG_SOURCES for path in TREE.glob(pattern)]
    solver = [path for pattern in SOLVER_SOURCES for path in TREE.glob(pattern)]
    version = '.'.join(map(str, sys.version_info[:3]))
    made = [
        Step(
            name='environment',
            text=f'.venv with Python {version} and its numerical packages',
            key=environment,
            work=make_environment,
        ),
        Step(
            name='solver',
            text='the contact solver and the judgement, compiled',
            work=compile_solver,
            key=digest(environment, files=solver),
            made=any((TREE / 'surrogate' / 'ehl' / 'kernels' / '__pycache__').glob('*.nbc')),
            beside=True,
        ),
        Step(
            name='packages',
            text='the other pinned packages',
            work=install_packages,
            key=environment,
        ),
        Step(
            name='interfaces',
            text='the ROS interfaces, compiled',
            work=build_interfaces,
            key=digest(environment, files=[*interfaces, cmake]),
        ),
        Step(
            name='package',
            text=PACKAGE,
            work=install_package,
            key=digest(environment, *shared, files=declared),
        ),
    ]
    if BAG_GENERATOR.exists():
        made.append(
            Step(
                name='bag',
                text='the bag of the nominal cycle',
                work=generate_bag,
                key=digest(environment, files=bag),
                made=(BAG / 'metadata.yaml').exists(),
            )
        )
    return made


def read_stamps() -> dict[str, str]:
    """Return the stamps; none when there is no environment that runs."""
    try:
        stamps: dict[str, str] = json.loads(STAMPS.read_text())
        subprocess.run([PYTHON, '-S', '-c', ''], check=True, capture_output=True)
    except (OSError, ValueError, subprocess.CalledProcessError):
        return {}
    return stamps


def set_up() -> None:
    """Do the steps that are not done."""
    stamps = read_stamps()
    wanted = steps()
    if stamps.get('environment') != wanted[0].key:
        stamps = {}  # all the others are in it
    missing = [step for step in wanted if stamps.get(step.name) != step.key or not step.made]
    if not missing:
        return
    LOG.parent.mkdir(exist_ok=True)
    LOG.write_text('')
    begin = time.monotonic()
    kept = Stamps(stamps)
    with ThreadPoolExecutor() as pool:
        begun = []
        for number, step in enumerate(missing, start=1):
            place = f'{number} of {len(missing)}'
            if step.beside:
                begun.append(pool.submit(do, step, place, kept))
            else:
                do(step, place, kept)
        for other in begun:
            other.result()
    say(f'done in {time.monotonic() - begin:.0f} s')


def do(step: Step, place: str, stamps: Stamps) -> None:
    """Do a step, and say so at its begin and its end."""
    say(f'{place}: {step.text} ...')
    since = time.monotonic()
    # Gone while its step is at work, so that an interruption leaves no false stamp.
    stamps.remove(step)
    step.work()
    stamps.add(step)
    say(f'{place}: {time.monotonic() - since:.0f} s')


def say(text: str) -> None:
    """Print a line of progress."""
    print(f'set-up: {text}', flush=True)


@contextlib.contextmanager
def alone() -> Iterator[None]:
    """Wait for another set-up of this tree to end, and hold off the next."""
    tree = os.open(TREE, os.O_RDONLY)
    try:
        try:
            fcntl.flock(tree, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            say('waiting for another set-up of this tree')
            fcntl.flock(tree, fcntl.LOCK_EX)
        yield
    finally:
        os.close(tree)


def main() -> int:
    """Set up, and say in one sentence what went wrong if it did."""
    try:
        with alone():
            set_up()
    except KeyboardInterrupt:
        print('\nset-up: interrupted; the next call goes on from here', file=sys.stderr)
        return 130
    except (Failure, OSError) as reason:
        log = getattr(reason, 'log', LOG)
        print('\n' + ''.join(log.read_text().splitlines(True)[-30:]), file=sys.stderr)
        print(f'set-up: {reason}; the whole output is in {log.relative_to(TREE)}', file=sys.stderr)
        return 1
    return 0


if __name__ == '__main__':
    sys.exit(main())
