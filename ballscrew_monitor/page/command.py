# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`ballscrew page`: checks its options, opens its port, and serves until it is stopped."""

import argparse
import asyncio
from collections.abc import Callable, Mapping
import contextlib
import dataclasses
from pathlib import Path
import socket
import ssl
import threading
from typing import Protocol

from ballscrew_monitor.core.interrupts import DONE, interrupts
from ballscrew_monitor.page.acting import Acting, LONG, refusals
from ballscrew_monitor.page.app import PageApp
from ballscrew_monitor.page.components import languages
from ballscrew_monitor.page.fault import fault_maker
from ballscrew_monitor.page.guard import is_loopback, read_token, Tokens
from ballscrew_monitor.page.hub import Hub
from ballscrew_monitor.page.metrics import HubCollector, Metrics
from ballscrew_monitor.page.questions import Handler, Questions
from ballscrew_monitor.page.recording import recorded_axes, Recording
from ballscrew_monitor.page.ros_side import RosSide
from ballscrew_monitor.page.server import bound_socket, PageOptions, server_of
from ballscrew_monitor.page.what_if import WhatIf
from ballscrew_monitor.recordings.opener import opened_log
from ballscrew_monitor.recordings.words import say, shown_progress
from ballscrew_monitor.report.parameters import parameters_for
from ballscrew_monitor.settings.qos import started_node
from rclpy.node import Node
from surrogate.files import InputError
from surrogate.surface import Surface

POLL = 0.1  # [s] until a signal is noticed


def page_command(args: argparse.Namespace, nominal: Path) -> int:
    """
    Serve until stopped; return the exit code. Raises InputError for what is wrong.

    `nominal` are the parameters of a recording that carries none.

    """
    options = _checked(args)
    with (
        interrupts(threading.Event()) as stopped,
        bound_socket(options) as bound,
        contextlib.ExitStack() as stack,
    ):
        options = dataclasses.replace(options, port=bound.getsockname()[1])
        begin: Begin
        if args.log:
            bag = opened_log(args.log, mapping=args.map)
            parameters = parameters_for(bag, args.params, nominal)
            say(f'parameters: {parameters.origin}', *parameters.sentences)
            with shown_progress(bag.duration) as on_done:
                axes = recorded_axes(bag, parameters, on_done)
            for axis in axes:
                axis.view.hear_parameters(parameters.values)
            say(*parameters.notes, *bag.notes)
            begin = lambda hub: Recording(hub, axes)  # noqa: E731
        else:
            node = stack.enter_context(started_node('ballscrew_page'))
            begin = lambda hub: LiveSource(node, hub, options)  # noqa: E731
        asyncio.run(_serve(options, bound, begin, lambda: bool(stopped), args.log))
    return DONE


class Source(Protocol):
    """Where the axes come from: nodes or a recording."""

    @property
    def handlers(self) -> Mapping[str, Handler]:
        """Return what answers the requests that are its own."""

    async def follow(self) -> None:
        """Bring what is new to the hub until cancelled."""


Begin = Callable[[Hub], Source]
"""Makes the source of a hub, in the thread of the server."""


class LiveSource:
    """The nodes in the ROS graph."""

    def __init__(self, node: Node, hub: Hub, options: PageOptions) -> None:
        post = asyncio.get_running_loop().call_soon_threadsafe
        self._ros = RosSide(node, hub, post, only=options.node)
        self.handlers = Acting(node, hub).handlers if options.acting else refusals()

    async def follow(self) -> None:
        """Listen until cancelled."""
        self._ros.start()
        try:
            while self._ros.failure is None:
                await asyncio.sleep(POLL)
        finally:
            self._ros.close()
        raise self._ros.failure


def _checked(args: argparse.Namespace) -> PageOptions:
    if (args.cert is None) is not (args.key is None):
        raise InputError('--cert and --key belong together: give both, or none of them')
    token = None if args.token_file is None else read_token(args.token_file)
    if token is None and not is_loopback(args.host):
        raise InputError(
            f'--host is {args.host}, which others reach: a page for others needs --token-file'
        )
    for name in ('node', 'allow_acting') if args.log else ('map', 'params'):
        if getattr(args, name):
            source = 'running nodes' if args.log else 'a recording'
            raise InputError(f'--{name.replace("_", "-")} is for {source}: leave it out')
    if args.language not in ('', *languages()):
        raise InputError(
            f'--language is {args.language}, allowed is {", ".join(sorted(languages()))}'
        )
    if not 0 <= args.port <= 0xFFFF:
        raise InputError(f'--port is {args.port}, allowed is 0 to 65535, 0 for any that is free')
    if args.cert is not None:
        try:
            ssl.create_default_context(ssl.Purpose.CLIENT_AUTH).load_cert_chain(
                args.cert, args.key
            )
        except OSError as error:  # that of TLS is one too
            raise InputError(
                f'--cert {args.cert} and --key {args.key} cannot be used: '
                f'{error.strerror or error}'
            ) from None
    return PageOptions(
        host=args.host,
        port=args.port,
        node=f'/{args.node.strip("/")}' if args.node else '',
        token=token,
        cert=args.cert,
        key=args.key,
        language=args.language,
        acting=args.allow_acting,
        oils=tuple(map(Surface.load, args.oils)),
    )


async def _serve(
    options: PageOptions,
    bound: socket.socket,
    begin: Begin,
    is_stopped: Callable[[], bool],
    log: Path | None,
) -> None:
    hub, tokens = Hub(acting=options.acting), Tokens(options.token)
    what_if, source = WhatIf(hub, options.oils), begin(hub)
    metrics = Metrics(HubCollector(hub, lambda: tokens.wrong))
    answer = Questions({**what_if.handlers, **source.handlers}, long=LONG).answer
    fault = fault_maker(hub, log, options.token)
    app = PageApp(hub, answer, tokens, metrics, language=options.language, fault=fault)
    server = server_of(options, app.guarded(options.host))
    print(f'page {options.url} (Ctrl-C ends it)', flush=True)
    tasks = [asyncio.create_task(part.follow()) for part in (what_if, source)]
    serving = asyncio.create_task(server.serve(sockets=[bound]))
    while not is_stopped() and not serving.done() and not any(task.done() for task in tasks):
        await asyncio.sleep(POLL)
    server.should_exit = True
    await serving
    for task in tasks:
        task.cancel()
    for outcome in await asyncio.gather(*tasks, return_exceptions=True):
        if isinstance(outcome, Exception):
            raise outcome
