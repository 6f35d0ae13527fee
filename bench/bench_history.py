#!/usr/bin/env python3
"""How long `grind history` takes for many records, and its memory: copies of some, with other names, times and wheels.

    bench_history.py COUNT RECORD..."""

import datetime
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

import rospkg

sys.path.insert(0, rospkg.RosPack().get_path('flute_grinder') + '/test/node')
import grinder_client as gc  # noqa: E402
import record_files  # noqa: E402

GRINDERS = 4


def utc(moment):
    return moment.isoformat(timespec='milliseconds') + 'Z'


def keep_copies(folders, count, records):
    """Records in turn, a minute apart, each job with another wear of its wheel."""
    for i in range(count):
        record, start = records[i % len(records)], datetime.datetime(2020, 1, 1) + datetime.timedelta(minutes=i)
        head = dict(record['head'], started=utc(start), ended=utc(start + datetime.timedelta(seconds=50)), wear_mm=i * 1e-6)
        name = '%010d_' % (i + 1) + start.strftime('%Y%m%dT%H%M%S.000Z.json')
        (folders[i % len(folders)] / name).write_text(record_files.text_of(head, record['body']))


def main():
    count, *paths = sys.argv[1:]
    with tempfile.TemporaryDirectory() as shop:
        folders = [pathlib.Path(shop) / str(i) for i in range(GRINDERS)]
        for folder in folders:
            folder.mkdir()
        keep_copies(folders, int(count), [json.loads(pathlib.Path(path).read_text()) for path in paths])
        size = sum(file.stat().st_size for file in pathlib.Path(shop).glob('*/*'))
        print('%s records of %.1f kB, %d cores' % (count, size / int(count) / 1e3, os.cpu_count()))
        for options in [], ['--json'], ['--since', '2020-01-01', '--until', '2020-01-02']:
            begin, before = time.monotonic(), os.times()
            subprocess.run([gc.program('grind'), 'history', '--from', *map(str, folders), *options], check=True,
                           stdout=subprocess.DEVNULL)
            after = os.times()
            cores = after.children_user + after.children_system - before.children_user - before.children_system
            # The children's maximum so far, in kB.
            print('%-40s %6.2f s, %6.2f s of a core, %4.0f MB at most' % (
                ' '.join(['grind history', *options]), time.monotonic() - begin, cores,
                resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1e3))


if __name__ == '__main__':
    main()
