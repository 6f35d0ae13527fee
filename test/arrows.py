#!/usr/bin/env python3
"""Holds every room to the includes that docs/architecture.md allows it, and core to the standard library, Eigen and
yaml-cpp, and a drive plugin as docs/drive-plugin.md has it to flute_grinder/drive. Prints each include that is not
allowed; exits with 1 if there is one."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
ROOMS = {
    'core': [],
    'messages': ['core'],
    'drive': ['core'],
    'control': ['core', 'drive'],
    'connection': [],
    'scene': ['core', 'messages'],
    'node': ['core', 'messages', 'drive', 'control', 'connection', 'scene'],
    'cli': ['core', 'messages', 'drive', 'control', 'connection'],
    'panel': ['core', 'messages', 'connection'],
    'report': [],
}
# What a program, and nothing else, reads of a room.
ONLY = {'cli': {'drive': ['parameters'], 'control': ['machine_config', 'loop_config']}}
INCLUDE = re.compile(r'#include [<"](.+?)[>"]')
OF_CORE = re.compile(r'[a-z_]+|Eigen/\w+|yaml-cpp/yaml\.h|flute_grinder/core/\w+\.h')


def allowed(room, header):
    inner = re.fullmatch(r'flute_grinder/([a-z]+)/(\w+)\.h', header)
    if room == 'core':
        return OF_CORE.fullmatch(header)
    if not inner or inner.group(1) == room:
        return True
    other, name = inner.groups()
    return other in ROOMS[room] and name in ONLY.get(room, {}).get(other, [name])


def main():
    wrong, seen = [], set()
    for folder in (ROOT / 'src', ROOT / 'include/flute_grinder'):
        for path in sorted(folder.rglob('*')):
            if path.suffix not in ('.h', '.cpp'):
                continue
            room = path.relative_to(folder).parts[0]
            seen.add(room)
            if room not in ROOMS:
                wrong.append('%s: no such room' % path.relative_to(ROOT))
                continue
            for number, line in enumerate(path.read_text().splitlines(), 1):
                include = INCLUDE.match(line)
                if include and not allowed(room, include.group(1)):
                    wrong.append('%s:%d: %s may not include %s' % (path.relative_to(ROOT), number, room, include.group(1)))
    plugin = re.findall(r'^#include <flute_grinder/.+>$', (ROOT / 'docs/drive-plugin.md').read_text(), re.MULTILINE)
    wrong += ['docs/drive-plugin.md: a plugin may not need ' + line for line in plugin if '/drive/' not in line]
    if not {'core', 'control', 'node'} <= seen or not plugin:
        wrong.append('rooms or the plugin not found under %s' % ROOT)
    print('\n'.join(wrong) or 'every include is allowed')
    return bool(wrong)


if __name__ == '__main__':
    sys.exit(main())
