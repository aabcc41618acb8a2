"""Messages between a run and an algorithm in a process of its own.

A message is two lengths, a header in JSON, and plain bytes (mostly float64).  Nothing that comes from the
other side is unpickled, and no length is believed before it is checked.
"""

from __future__ import annotations

import json
import socket
import struct
import time
from collections.abc import Mapping
from typing import Any

LENGTHS = struct.Struct("!IQ")  # bytes of the header, bytes of the data
LONGEST_HEADER = 1 << 16


class MessageError(ValueError):
    """The other side sent something else than a message."""


class Channel:
    """One end of a pair of sockets.

    Parameters
    ----------
    end : socket.socket
        This side's end; the channel closes it.
    """

    def __init__(self, end: socket.socket) -> None:
        self._end = end

    def send(self, header: Mapping[str, Any], data: bytes = b"", seconds: float | None = None) -> None:
        """Send one message.

        Parameters
        ----------
        header : Mapping[str, Any]
            What JSON can hold.
        data : bytes
            Follows the header as it is.
        seconds : float, optional
            Time limit [s]; none if left out.

        Raises
        ------
        TimeoutError
            The other side does not read.
        OSError
            The other side is gone.
        """
        line = json.dumps(header).encode()
        self._end.settimeout(seconds)
        self._end.sendall(LENGTHS.pack(len(line), len(data)) + line + data)

    def receive(self, most: int, seconds: float | None = None) -> tuple[dict[str, Any], bytes]:
        """Wait for one message.

        Parameters
        ----------
        most : int
            Bytes of data that a message may have.
        seconds : float, optional
            Time limit of the whole message [s]; none if left out.

        Returns
        -------
        header : dict[str, Any]
            As sent; its entries are whatever the other side likes.
        data : bytes
            As sent.

        Raises
        ------
        MessageError
            The other side sent no message, or too long a one.
        TimeoutError
            The message was not whole in time.
        EOFError, OSError
            The other side is gone.
        """
        deadline = None if seconds is None else time.monotonic() + seconds
        n_header, n_data = LENGTHS.unpack(self._read(LENGTHS.size, deadline))
        if n_header > LONGEST_HEADER or n_data > most:
            raise MessageError(f"a message of {n_header} + {n_data} bytes")
        body = self._read(n_header + n_data, deadline)
        try:
            header = json.loads(body[:n_header])
        except (ValueError, RecursionError):
            raise MessageError("a header that is no JSON") from None
        if type(header) is not dict:
            raise MessageError("a header that is no object")
        return header, body[n_header:]

    def _read(self, size: int, deadline: float | None) -> bytes:
        body = bytearray(size)
        view = memoryview(body)
        while view:
            left = None if deadline is None else deadline - time.monotonic()
            if left is not None and left <= 0.0:
                raise TimeoutError
            self._end.settimeout(left)
            read = self._end.recv_into(view)
            if read == 0:
                raise EOFError
            view = view[read:]
        return bytes(body)

    def close(self) -> None:
        """Close this end."""
        self._end.close()
