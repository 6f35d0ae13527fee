"""Reads the messages of a bag, of each topic in the order in which they were recorded (http://wiki.ros.org/Bags/Format/2.0). The rosbag library
keeps an index of all messages, of all topics, in memory: hundreds of MB for a day's job."""

import bz2
import os
import struct

import numpy as np
import roslz4

from record import SourceError

INDEX, CHUNK, CONNECTION = 4, 5, 7
NOT_WHOLE = 'the bag was not closed, or is cut off; "rosbag reindex" saves what is in it'

LENGTH = struct.Struct('<I')
ENTRY = np.dtype([('time', '<u8'), ('offset', '<u4')])
DECOMPRESS = {b'none': bytes, b'bz2': bz2.decompress, b'lz4': roslz4.decompress}


def fields_of(header):
    """Names and values of a record's header."""
    fields, at = {}, 0
    while at < len(header):
        length, = struct.unpack_from('<I', header, at)
        name, _, value = header[at + 4:at + 4 + length].partition(b'=')
        fields[name] = value
        at += 4 + length
    return fields


class BagFile:
    """A closed bag. kinds: (type, digest of its definition) by topic, once `open` has read them."""

    def __init__(self, file):
        self._file = file
        if not file.readline().startswith(b'#ROSBAG V2.0'):
            raise SourceError('is a bag of another version; allowed: 2.0')
        header, _ = self._record() or ({b'index_pos': bytes(8)}, b'')
        self._end, = struct.unpack('<Q', header[b'index_pos'])
        if self._end == 0:
            raise SourceError(NOT_WHOLE)
        self._begin = file.tell()
        self._connections = {}  # topic, type and digest by number
        if file.seek(0, os.SEEK_END) <= self._end:
            raise SourceError(NOT_WHOLE)
        file.seek(self._end)
        for header, data in iter(self._record, None):
            if header[b'op'][0] == CONNECTION:
                self._add_connection(header, data)
        self.kinds = {topic: (kind, digest) for topic, kind, digest in self._connections.values()}

    def _record(self):
        """Header fields and data; None at the end of the file."""
        length = self._file.read(4)
        if not length:
            return None
        if len(length) < 4:
            raise SourceError(NOT_WHOLE)
        header = self._exactly(LENGTH.unpack(length)[0])
        size, = LENGTH.unpack(self._exactly(4))
        return fields_of(header), self._exactly(size)

    def _exactly(self, size):
        data = self._file.read(size)
        if len(data) < size:
            raise SourceError(NOT_WHOLE)
        return data

    def _add_connection(self, header, data):
        number, = LENGTH.unpack(header[b'conn'])
        named = fields_of(data)
        self._connections[number] = header[b'topic'].decode(), named[b'type'].decode(), named[b'md5sum'].decode()

    def messages(self, topics):
        """Type and data of every message of these topics."""
        wanted = {number: kind for number, (topic, kind, _) in self._connections.items() if topic in topics}
        self._file.seek(self._begin)
        chunk = b''
        while self._file.tell() < self._end:
            header, data = self._record()
            operation = header[b'op'][0]
            if operation == CHUNK:
                if header[b'compression'] not in DECOMPRESS:
                    raise SourceError('the bag is compressed by "%s"; allowed: %s' % (
                        header[b'compression'].decode(), ', '.join(name.decode() for name in DECOMPRESS)))
                chunk = DECOMPRESS[header[b'compression']](data)
            elif operation == INDEX:
                number, = LENGTH.unpack(header[b'conn'])
                if number not in wanted:
                    continue
                for offset in np.frombuffer(data, ENTRY)['offset'].tolist():
                    begin = offset + 8 + LENGTH.unpack_from(chunk, offset)[0]
                    yield wanted[number], chunk[begin:begin + LENGTH.unpack_from(chunk, begin - 4)[0]]
