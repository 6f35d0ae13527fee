#!/usr/bin/env python3
"""Chooses a free port for a server of a test. It lies below the range that the system gives to outgoing connections, one of
which could otherwise take the port before the server listens, or while the server is down."""

import random
import socket

PORTS = range(20000, 32768)


def free_port():
    for port in random.sample(PORTS, len(PORTS)):
        with socket.socket() as probe:
            try:
                probe.bind(('', port))
            except OSError:
                continue
            return port
    raise OSError('no port from %d to %d is free' % (PORTS[0], PORTS[-1]))


if __name__ == '__main__':
    print(free_port())
