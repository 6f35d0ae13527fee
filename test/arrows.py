#!/usr/bin/env python3
"""Holds every room to the includes that the table in docs/architecture.md allows it, and the core's rooms to the libraries that it
names. No room may include one below it in the table, no header may be in include/ that only its own room includes, and the drive
plugin of docs/drive-plugin.md may include only drive. Prints what is wrong; exits with 1 if something is."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
FOLDERS = (ROOT / 'src', ROOT / 'include/flute_grinder')
ROW = re.compile(r'(?m)^\| `(\w+)` \|.*\| ?([^|]*?) ?\|$')
INSTALLED = ('curve', 'drive')
# `room`, or of a room only `some.h`, `headers.h`
ARROW = re.compile(r'`(\w+)`(?: \(([^)]+)\))?')
INCLUDE = re.compile(r'(?m)^#include [<"](.+?)[>"]')
CORE = ('curve', 'job', 'motion', 'machine')
LIBRARIES = {'the standard library': '[a-z_]+', 'Eigen': r'Eigen/\w+', 'yaml-cpp': r'yaml-cpp/\w+\.h'}


def read_rooms():
    """Of the page: for each room those that it may include, with the headers that it is confined to, or None."""
    section = (ROOT / 'docs/architecture.md').read_text().split('## Rooms')[1].split('\n## ')[0]
    rooms = {}
    for room, arrows in ROW.findall(section):
        arrows = re.sub('the core\\b', ', '.join('`%s`' % name for name in CORE), arrows)
        rooms[room] = {other: re.findall(r'`(\w+\.h)`', only) if only else None for other, only in ARROW.findall(arrows)}
        rooms[room].update({library: None for library in LIBRARIES if library in arrows})
    return rooms


def check_order(rooms):
    """Of the table itself: no arrow upward, and so no circle; a row for each folder."""
    order = list(rooms)
    wrong = ['docs/architecture.md: %s may not include %s, which is not above it' % (room, other)
             for room in rooms for other in rooms[room] if other not in LIBRARIES and other not in order[:order.index(room)]]
    folders = {path.name for folder in FOLDERS for path in folder.iterdir() if path.is_dir()}
    return wrong + ['docs/architecture.md and the folders differ in the room ' + room for room in sorted(folders ^ set(rooms))]


def allowed(room, header, rooms):
    inner = re.fullmatch(r'(?:flute_grinder/)?([a-z]+)/(\w+\.h)', header)
    if not inner or inner.group(1) not in rooms:
        return room not in CORE or any(re.fullmatch(LIBRARIES[library], header) for library in LIBRARIES
                                       if library in rooms[room] or library == 'the standard library')
    if inner.group(1) == room:
        return True
    if not header.startswith('flute_grinder/'):
        return False
    other, name = inner.groups()
    return other in rooms[room] and name in (rooms[room][other] or [name])


def check_private():
    """No header stands in include/ that only its own room's files include, unless it is installed."""
    sources = [path for folder in (*FOLDERS, ROOT / 'bench') for path in folder.rglob('*') if path.suffix in ('.h', '.cpp')]
    users = {}
    for path in sources:
        for header in INCLUDE.findall(path.read_text()):
            users.setdefault(header, set()).add(path)
    def room_of(path):
        return path.relative_to(ROOT).parts[-2]
    wrong = []
    for path in sorted(FOLDERS[1].rglob('*.h')):
        header = str(path.relative_to(ROOT / 'include'))
        used_by = users.get(header, set())
        if room_of(path) in INSTALLED or any(room_of(user) != room_of(path) or FOLDERS[1] in user.parents for user in used_by):
            continue
        wrong.append('%s: only its own room includes it; it belongs beside its source' % path.relative_to(ROOT))
    return wrong


def main():
    rooms = read_rooms()
    wrong = check_order(rooms) + check_private()
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
