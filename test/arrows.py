#!/usr/bin/env python3
"""Holds every module to the includes that the table in docs/architecture.md allows it, and the core's modules to the libraries that it
names. No module may include one below it in the table, no header may be in include/ that only its own module includes, and the drive
plugin of docs/drive-plugin.md may include only drive. Nor may a C function that writes or reads numbers stand in a file that does
not know `CLocale`, since rviz' locale may have a comma in them. Prints what is wrong; exits with 1 if something is."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
FOLDERS = (ROOT / 'src', ROOT / 'include/flute_grinder')
ROW = re.compile(r'(?m)^\| `(\w+)` \|.*\| ?([^|]*?) ?\|$')
INSTALLED = ('base', 'curve', 'drive')
# `module`, or of a module only `some.h`, `headers.h`
ARROW = re.compile(r'`(\w+)`(?: \(([^)]+)\))?')
INCLUDE = re.compile(r'(?m)^#include [<"](.+?)[>"]')
CORE = ('base', 'curve', 'job', 'motion', 'machine')
# Not what is for a terminal: programs of our own keep the locale C.
LOCALE = re.compile(r'\b(?:ato[fl]|sto(?:f|d|ld)|strto(?:f|d|ld)|v?sn?printf|v?asprintf|vf?printf|fprintf|v?[fs]?scanf|setlocale|'
                    r'locale::global)\((?!stderr)')
KNOWS = '#include "flute_grinder/base/c_locale.h"'
LIBRARIES = {'the standard library': '[a-z_]+', 'Eigen': r'Eigen/\w+', 'yaml-cpp': r'yaml-cpp/\w+\.h', 'OpenSSL': r'openssl/\w+\.h',
             'urdfdom': r'urdf_\w+/\w+\.h', 'tinyxml2': r'tinyxml2\.h',
             'POSIX': r'(?:sys/\w+|fcntl|unistd)\.h'}


def read_modules():
    """Of the page: for each module those that it may include, with the headers that it is confined to, or None."""
    section = (ROOT / 'docs/architecture.md').read_text().split('## Modules')[1].split('\n## ')[0]
    modules = {}
    for module, arrows in ROW.findall(section):
        arrows = re.sub('the core\\b', ', '.join('`%s`' % name for name in CORE), arrows)
        modules[module] = {other: re.findall(r'`(\w+\.h)`', only) if only else None for other, only in ARROW.findall(arrows)}
        modules[module].update({library: None for library in LIBRARIES if library in arrows})
    return modules


def check_order(modules):
    """Of the table itself: no arrow upward, and so no circle; a row for each folder."""
    order = list(modules)
    wrong = ['docs/architecture.md: %s may not include %s, which is not above it' % (module, other)
             for module in modules for other in modules[module] if other not in LIBRARIES and other not in order[:order.index(module)]]
    folders = {path.name for folder in FOLDERS for path in folder.iterdir() if path.is_dir()}
    return wrong + ['docs/architecture.md and the folders differ in the module ' + module for module in sorted(folders ^ set(modules))]


def allowed(module, header, modules):
    inner = re.fullmatch(r'(?:flute_grinder/)?([a-z]+)/(\w+\.h)', header)
    if not inner or inner.group(1) not in modules:
        return module not in CORE or any(re.fullmatch(LIBRARIES[library], header) for library in LIBRARIES
                                       if library in modules[module] or library == 'the standard library')
    if inner.group(1) == module:
        return True
    if not header.startswith('flute_grinder/'):
        return False
    other, name = inner.groups()
    return other in modules[module] and name in (modules[module][other] or [name])


def check_private():
    """No header stands in include/ that only its own module's files include, unless it is installed."""
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
        wrong.append('%s: only its own module includes it; it belongs beside its source' % path.relative_to(ROOT))
    return wrong


def check_numbers():
    return ['%s: %s...) goes by the locale; allowed: format() and parseNumber()' % (path.relative_to(ROOT), call)
            for folder in FOLDERS for path in sorted(folder.rglob('*')) if path.suffix in ('.h', '.cpp')
            for text in [path.read_text()] if KNOWS not in text for call in LOCALE.findall(text)]


def main():
    modules = read_modules()
    wrong = check_order(modules) + check_private() + check_numbers()
    for folder in FOLDERS:
        for path in sorted(folder.rglob('*')):
            module = path.relative_to(folder).parts[0]
            if path.suffix not in ('.h', '.cpp') or module not in modules:
                continue
            for number, line in enumerate(path.read_text().splitlines(), 1):
                include = INCLUDE.match(line)
                if include and not allowed(module, include.group(1), modules):
                    wrong.append('%s:%d: %s may not include %s' % (path.relative_to(ROOT), number, module, include.group(1)))
    plugin = re.findall(r'^#include <flute_grinder/.+>$', (ROOT / 'docs/drive-plugin.md').read_text(), re.MULTILINE)
    wrong += ['docs/drive-plugin.md: a plugin may not need ' + line for line in plugin if '/drive/' not in line]
    if not plugin:
        wrong.append('docs/drive-plugin.md: no plugin found')
    print('\n'.join(wrong) or 'every include is allowed')
    return bool(wrong)


if __name__ == '__main__':
    sys.exit(main())
