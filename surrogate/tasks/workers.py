# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Pools of workers: processes of this machine, or those of a Dask cluster."""

import asyncio
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import CancelledError, Future
import contextlib
import functools
import logging
from multiprocessing import resource_tracker
import os
import queue
import signal
import sys
from typing import Any, Self
import uuid

from surrogate.files import InputError
from surrogate.surface.file import SurfaceError
from surrogate.tasks.child import Frame, one_thread_environment, path_to_this_code, Worker, Workers
from surrogate.tasks.pool import Pool
from surrogate.tasks.worker import describe_failure, listener, run_task, ShareTeller, worker_name

LOCAL = 'local'
"""The word for a Dask cluster on this machine."""
PATIENCE = 5.0
"""Longest wait for a scheduler, and for its first worker [s]."""
TOPIC = 'ballscrew'
"""
Of Dask's events: on one that begins so workers say what they begin, and how far they are.

Each pool has a topic of its own: a topic is heard by all clients of a scheduler.

"""
OnShare = Callable[[str, float], None]
"""Told the name of a task at work and which share of it is done [-]."""


def ignore(name: str, share: float) -> None:
    """Take no notice of how far a task is."""


def usable_cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0))


def open_pool(
    workers: int | None = None, dask: str | None = None, *, on_share: OnShare = ignore
) -> Pool:
    """
    Return a pool of `workers` processes, or that of the Dask cluster `dask`.

    `dask` is the address of a scheduler, such as tcp://host:8786, or `local` for a cluster of
    `workers` processes here. Workers are as many as cores by default. `on_share` is told how far
    tasks are that say so. Raises InputError for a number below 1, a number for a cluster that has
    its own, and a scheduler that does not answer.

    """
    if workers is not None and workers < 1:
        raise InputError(f'--workers is {workers}, allowed is 1 or more')
    if dask is None:
        return ProcessPool(workers or usable_cores(), on_share)
    if dask != LOCAL and workers is not None:
        raise InputError(f'--workers does not belong to --dask {dask}: the cluster has its own')
    return DaskPool(dask, workers or usable_cores(), on_share)


class ProcessPool(Workers):
    """Processes of this machine, which find the modules that this process finds."""

    def __init__(self, workers: int, on_share: OnShare) -> None:
        environment = one_thread_environment(wheels=True) | {
            'PYTHONPATH': path_to_this_code(sys.path)
        }
        super().__init__(workers, functools.partial(Worker, environment=environment))
        self._on_share = on_share

    def wait(self, seconds: float) -> list[tuple[str, Frame]]:
        """Return what is heard of tasks within a time [s], but for how far they are."""
        heard = super().wait(seconds)
        for name, frame in heard:
            if 'step' in frame:
                self._on_share(name, frame['step'])
        return heard


class DaskPool:
    """The workers of a Dask cluster, which itself gives the tasks of lost workers to others."""

    def __init__(self, address: str, workers: int, on_share: OnShare) -> None:
        import distributed

        # A scheduler that is lost is told in a sentence, not in tracebacks of its client.
        logging.getLogger('distributed.client').setLevel(logging.CRITICAL)
        self._on_share = on_share
        self._heard: queue.SimpleQueue[tuple[str, Frame | Future[Frame]]] = queue.SimpleQueue()
        with _deaf_to_ctrl_c():
            self._cluster: Any = None
            if address == LOCAL:
                self._cluster = distributed.LocalCluster(
                    n_workers=workers,
                    threads_per_worker=1,
                    dashboard_address='127.0.0.1:0',
                    silence_logs='ERROR',
                )
            self._client = _client(distributed, self._cluster or address)
        self._topic = f'{TOPIC}-{uuid.uuid4()}'
        self._client.subscribe_topic(self._topic, lambda event: self._heard.put(event[1]))
        self._executor = self._client.get_executor()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self._executor.shutdown(wait=False)  # cancels what is not done
        self._client.close()
        if self._cluster is not None:
            self._cluster.close()

    def submit(self, name: str, task: str, inputs: Mapping[str, Any]) -> None:
        """Hand a task over."""
        future = self._executor.submit(run_told, self._topic, name, task, inputs)
        future.add_done_callback(lambda done: self._heard.put((name, done)))

    def wait(self, seconds: float) -> list[tuple[str, Frame]]:
        """Return what is heard of a task within a time [s], but for how far it is."""
        try:
            name, heard = self._heard.get(timeout=seconds)
        except queue.Empty:
            return []
        frame = _end_of(heard) if isinstance(heard, Future) else heard
        if 'step' in frame:
            self._on_share(name, frame['step'])
        return [(name, frame)]


def _end_of(future: 'Future[Frame]') -> Frame:
    """Return what became of a task; raises SurfaceError when the whole cluster is gone."""
    try:
        return future.result()
    except CancelledError:
        raise SurfaceError(
            'the scheduler was lost; run the command again, results that were kept are not '
            'solved again'
        ) from None
    except Exception as error:  # such as that its worker was lost too often
        return {'result': None, 'sentence': describe_failure(error), 'worker': ''}


def run_told(topic: str, name: str, task: str, inputs: Mapping[str, Any]) -> Frame:
    """Run a task in a worker of a Dask cluster; tell a topic that it is begun, and how far."""
    import distributed

    worker = distributed.get_worker()
    note = name, {'begun': worker_name()}
    # Waits until the scheduler has it: a worker that is killed at once has said what it began.
    distributed.utils.sync(worker.loop, worker.scheduler.log_event, topic=topic, msg=note)
    listener.set(ShareTeller(lambda step: worker.log_event(topic, (name, {'step': step}))))
    return run_task(task, inputs)


@contextlib.contextmanager
def _deaf_to_ctrl_c() -> Iterator[None]:
    """
    Let processes and threads that start meanwhile not see Ctrl-C.

    It is inherited, so there is no moment in which a new process would be hit. Ctrl-C is for the
    main thread alone, which then ends its workers.

    """
    # Started with the first process, the tracker would unblock what is blocked here.
    resource_tracker.ensure_running()
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)


def _client(distributed: Any, cluster: Any) -> Any:
    """Return a client of a cluster that has a worker; raises InputError for any other."""
    if isinstance(cluster, str):  # a client would wait long for a scheduler that is not there

        async def ask() -> Any:
            async with distributed.rpc(cluster) as scheduler:
                return await scheduler.identity()

        try:
            answer = asyncio.run(asyncio.wait_for(ask(), PATIENCE)).get('type')
        except ValueError as error:
            answer = str(error)
        except (OSError, TimeoutError):
            answer = f'nothing answers within {PATIENCE:g} s'
        except Exception:  # what answers at a wrong port may say anything
            answer = 'something else answers there'
        if answer != 'Scheduler':
            raise InputError(
                f'--dask: no scheduler at {cluster} ({answer}), allowed is tcp://HOST:PORT or '
                f'{LOCAL}'
            )
    client = distributed.Client(cluster, timeout=PATIENCE, set_as_default=False)
    try:
        client.wait_for_workers(1, timeout=PATIENCE)
    except TimeoutError:
        client.close()
        raise InputError(f'--dask: the scheduler at {cluster} has no workers') from None
    return client
