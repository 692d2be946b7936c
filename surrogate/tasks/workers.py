# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Pools of workers: spawned processes of this machine, or those of a Dask cluster."""

import asyncio
from collections import deque
from collections.abc import Mapping
from concurrent.futures import Future
import os
from typing import Any, Self
import uuid

from surrogate.files import InputError
from surrogate.tasks.pool import Pool
from surrogate.tasks.spawned import apart, SpawnedWorkers
from surrogate.tasks.worker import OnShare, run_task, ShareTeller, Task, teller, worker_name

LOCAL = 'local'
"""The word for a Dask cluster on this machine."""
PATIENCE = 5.0
"""Longest wait for a scheduler, and for its first worker [s]."""
TOPIC = 'ballscrew'
"""
Of Dask's events: on one that begins so workers say what they begin, and how far they are.

Each pool has a topic of its own: a topic is heard by all clients of a scheduler.

"""


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


class ProcessPool:
    """Spawned processes of this machine."""

    def __init__(self, workers: int, on_share: OnShare) -> None:
        """Prepare for `workers` processes; each starts with the first task it is needed for."""
        self._events: deque[tuple[str, str]] = deque()
        self._executor = SpawnedWorkers(
            workers, self._note, lambda arguments, share: on_share(arguments[1], share)
        )

    def __enter__(self) -> Self:
        """Return the pool."""
        return self

    def __exit__(self, *error: object) -> None:
        """End all workers, also those at work."""
        self._executor.shutdown()

    def submit(self, task: Task, name: str, inputs: Mapping[str, Any]) -> Future[dict[str, Any]]:
        """Hand a task over."""
        return self._executor.submit(run_task, task, name, inputs)

    def begun(self) -> list[tuple[str, str]]:
        """Return names of tasks and workers that have begun them, since the last call."""
        return [self._events.popleft() for _ in range(len(self._events))]

    def _note(self, arguments: tuple[Any, ...], worker: str) -> None:
        self._events.append((arguments[1], worker))


class DaskPool:
    """The workers of a Dask cluster, which itself gives the tasks of lost workers to others."""

    def __init__(self, address: str, workers: int, on_share: OnShare) -> None:
        """Connect to a scheduler, or start `workers` processes of this machine."""
        import distributed

        self._on_share = on_share
        self._events: deque[tuple[str, str]] = deque()
        with apart():
            self._cluster = _local_cluster(distributed, workers) if address == LOCAL else None
            self._client = _client(distributed, self._cluster or address)
        self._topic = f'{TOPIC}-{uuid.uuid4()}'
        self._client.subscribe_topic(self._topic, self._note)
        self._executor = self._client.get_executor()

    def __enter__(self) -> Self:
        """Return the pool."""
        return self

    def __exit__(self, *error: object) -> None:
        """Take back what is not done; end the workers that were started here."""
        self._executor.shutdown(wait=False)  # cancels what is not done
        self._client.close()
        if self._cluster is not None:
            self._cluster.close()

    def submit(self, task: Task, name: str, inputs: Mapping[str, Any]) -> Future[dict[str, Any]]:
        """Hand a task over."""
        return self._executor.submit(run_told, self._topic, task, name, inputs)

    def begun(self) -> list[tuple[str, str]]:
        """Return names of tasks and workers that have begun them, since the last call."""
        return [self._events.popleft() for _ in range(len(self._events))]

    def _note(self, event: tuple[float, Mapping[str, Any]]) -> None:
        note = event[1]
        if 'share' in note:
            self._on_share(note['task'], note['share'])
        else:
            self._events.append((note['task'], note['process']))


def run_told(topic: str, task: Task, name: str, inputs: Mapping[str, Any]) -> dict[str, Any]:
    """Run a task in a worker of a Dask cluster; tell a topic that it is begun, and how far."""
    import distributed

    worker = distributed.get_worker()
    note = {'task': name, 'process': worker_name()}
    # Waits until the scheduler has it: a worker that is killed at once has said what it began.
    distributed.utils.sync(worker.loop, worker.scheduler.log_event, topic=topic, msg=note)
    teller.set(
        ShareTeller(lambda share: worker.log_event(topic, {'task': name, 'share': float(share)}))
    )
    return run_task(task, name, inputs)


def _local_cluster(distributed: Any, workers: int) -> Any:
    return distributed.LocalCluster(
        n_workers=workers,
        threads_per_worker=1,
        dashboard_address='127.0.0.1:0',
        silence_logs='ERROR',
    )


def _client(distributed: Any, cluster: Any) -> Any:
    """Return a client of a cluster that has a worker; raises InputError for any other."""
    if isinstance(cluster, str):
        _check_scheduler(distributed, cluster)
    client = distributed.Client(cluster, timeout=PATIENCE, set_as_default=False)
    try:
        client.wait_for_workers(1, timeout=PATIENCE)
    except TimeoutError:
        client.close()
        raise InputError(f'--dask: the scheduler at {cluster} has no workers') from None
    return client


def _check_scheduler(distributed: Any, address: str) -> None:
    """Ask who is there: a client would wait long for a scheduler that is not."""

    async def ask() -> Any:
        async with distributed.rpc(address) as there:
            return await there.identity()

    try:
        found = asyncio.run(asyncio.wait_for(ask(), PATIENCE)).get('type')
    except ValueError as error:
        found = str(error)
    except (OSError, TimeoutError):
        found = f'nothing answers within {PATIENCE:g} s'
    except Exception:  # what answers at a wrong port may say anything
        found = 'something else answers there'
    if found != 'Scheduler':
        raise InputError(
            f'--dask: no scheduler at {address} ({found}), allowed is tcp://HOST:PORT or {LOCAL}'
        )
