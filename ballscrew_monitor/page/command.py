# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`ballscrew page`: checks its options, opens its port, and serves until it is stopped."""

import argparse
import asyncio
from collections.abc import Callable
import dataclasses
from pathlib import Path
import socket
import ssl
import threading
from typing import Any

from ballscrew_monitor.core.interrupts import DONE, interrupts
from ballscrew_monitor.page.app import PageApp
from ballscrew_monitor.page.guard import is_loopback, read_token, Tokens
from ballscrew_monitor.page.hub import Hub
from ballscrew_monitor.page.metrics import HubCollector, Metrics
from ballscrew_monitor.page.questions import Questions
from ballscrew_monitor.page.ros_side import RosSide
from ballscrew_monitor.page.server import bound_socket, PageOptions, server_of
from ballscrew_monitor.page.what_if import WhatIf
from ballscrew_monitor.recordings.words import say
from ballscrew_monitor.settings.middleware import notice
from ballscrew_monitor.settings.qos import started_node
from surrogate.files import InputError
from surrogate.surface import Surface

POLL = 0.1  # [s] until a signal is noticed


def page_command(args: argparse.Namespace) -> int:
    """Serve until stopped; return the exit code. Raises InputError for options that are wrong."""
    options = _checked(args)
    with interrupts(threading.Event()) as stopped, bound_socket(options) as bound:
        options = dataclasses.replace(options, port=bound.getsockname()[1])
        say(*filter(None, [notice()]))
        with started_node('ballscrew_page') as node:
            asyncio.run(_serve(options, bound, node, lambda: bool(stopped)))
    return DONE


def _checked(args: argparse.Namespace) -> PageOptions:
    """Return the options; raises InputError."""
    if (args.cert is None) is not (args.key is None):
        raise InputError('--cert and --key belong together: give both, or none of them')
    token = None if args.token_file is None else read_token(args.token_file)
    if token is None and not is_loopback(args.host):
        raise InputError(
            f'--host is {args.host}, which others reach: a page for others needs --token-file'
        )
    if not 0 <= args.port <= 0xFFFF:
        raise InputError(f'--port is {args.port}, allowed is 0 to 65535, 0 for any that is free')
    if args.cert is not None:
        _check_certificate(args.cert, args.key)
    return PageOptions(
        host=args.host,
        port=args.port,
        node=args.node,
        token=token,
        cert=args.cert,
        key=args.key,
        language=args.language,
        oils=tuple(map(Surface.load, args.oils)),
    )


def _check_certificate(cert: Path, key: Path) -> None:
    try:
        ssl.create_default_context(ssl.Purpose.CLIENT_AUTH).load_cert_chain(cert, key)
    except OSError as error:  # that of TLS is one too
        why = error.strerror or error
        raise InputError(f'--cert {cert} and --key {key} cannot be used: {why}') from None


async def _serve(
    options: PageOptions, bound: socket.socket, node: Any, is_stopped: Callable[[], bool]
) -> None:
    """Serve what the ROS side of a `node` hears."""
    hub, tokens = Hub(), Tokens(options.token)
    ros = RosSide(node, hub, asyncio.get_running_loop().call_soon_threadsafe, only=options.node)
    metrics = Metrics(HubCollector(hub, lambda: tokens.wrong))
    what_if = WhatIf(hub, options.oils)
    app = PageApp(
        hub, Questions(what_if.handlers).answer, tokens, metrics, language=options.language
    )
    server = server_of(options, app.guarded(options.host))
    ros.start()
    try:
        print(f'page {options.url} (Ctrl-C ends it)', flush=True)
        following = asyncio.create_task(what_if.follow())
        serving = asyncio.create_task(server.serve(sockets=[bound]))
        while not is_stopped() and not serving.done():
            await asyncio.sleep(POLL)
        server.should_exit = True
        await serving
        following.cancel()
    finally:
        await asyncio.to_thread(ros.close)
