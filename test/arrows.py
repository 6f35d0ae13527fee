#!/usr/bin/env python3
"""Holds every room to the includes that the table in docs/architecture.md allows it, and core to the standard library, Eigen
and yaml-cpp. No room may include one below it in the table, and the drive plugin of docs/drive-plugin.md none but drive. Prints what is
wrong; exits with 1 if something is."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
FOLDERS = (ROOT / 'src', ROOT / 'include/flute_grinder')
ROW = re.compile(r'(?m)^\| `(\w+)` \|.*\| ?([^|]*?) ?\|$')
# `room`, or of a room only `some.h`, `headers.h`
ARROW = re.compile(r'`(\w+)`(?: \(([^)]+)\))?')
INCLUDE = re.compile(r'#include [<"](.+?)[>"]')
OF_CORE = re.compile(r'[a-z_]+|Eigen/\w+|yaml-cpp/\w+\.h|flute_grinder/core/\w+\.h')


def read_rooms():
    """Of the page: for each room those that it may include, with the headers that it is confined to, or None."""
    section = (ROOT / 'docs/architecture.md').read_text().split('## Rooms')[1].split('\n## ')[0]
    return {room: {other: re.findall(r'`(\w+\.h)`', only) if only else None for other, only in ARROW.findall(arrows)}
            for room, arrows in ROW.findall(section)}


def check_order(rooms):
    """Of the table itself: no arrow upward, and so no circle; a row for each folder."""
    order = list(rooms)
    wrong = ['docs/architecture.md: %s may not include %s, which is not above it' % (room, other)
             for room in rooms for other in rooms[room] if other not in order[:order.index(room)]]
    folders = {path.name for folder in FOLDERS for path in folder.iterdir() if path.is_dir()}
    return wrong + ['docs/architecture.md and the folders differ in the room ' + room for room in sorted(folders ^ set(rooms))]


def allowed(room, header, rooms):
    if room == 'core':
        return OF_CORE.fullmatch(header)
    inner = re.fullmatch(r'flute_grinder/([a-z]+)/(\w+\.h)', header)
    if not inner or inner.group(1) == room:
        return True
    other, name = inner.groups()
    return other in rooms[room] and name in (rooms[room][other] or [name])


def main():
    rooms = read_rooms()
    wrong = check_order(rooms)
    for folder in FOLDERS:
        for path in sorted(folder.rglob('*')):
            room = path.relative_to(folder).parts[0]
            if path.suffix not in ('.h', '.cpp') or room not in rooms:
                continue
            for number, line in enumerate(path.read_text().splitlines(), 1):
                include = INCLUDE.match(line)
                if include and not allowed(room, include.group(1), rooms):
                    wrong.append('%s:%d: %s may not include %s' % (path.relative_to(ROOT), number, room, include.group(1)))
    plugin = re.findall(r'^#include <flute_grinder/.+>$', (ROOT / 'docs/drive-plugin.md').read_text(), re.MULTILINE)
    wrong += ['docs/drive-plugin.md: a plugin may not need ' + line for line in plugin if '/drive/' not in line]
    if not plugin:
        wrong.append('docs/drive-plugin.md: no plugin found')
    print('\n'.join(wrong) or 'every include is allowed')
    return bool(wrong)


if __name__ == '__main__':
    sys.exit(main())
