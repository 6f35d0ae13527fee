#!/usr/bin/env python3
"""Writes docs/reference.md from the message files, docs/schema.yaml and the launch file; with --check, only says whether
the file that is there is up to date."""

import pathlib
import re
import sys
import xml.etree.ElementTree as xml

import yaml

ROOT = pathlib.Path(__file__).resolve().parent.parent
FILE = ROOT / 'docs/reference.md'

HEAD = """# Reference

Made by `docs/make_reference.py` from `msg/`, `srv/`, `action/`, `docs/schema.yaml` and `launch/grinder.launch`: a change belongs
there. What the node does with all this is in [the node `grinder`](ros-interface.md).
"""

KEYS = {
    'job': ('The job file', "YAML in the operator's units. A key that is missing, unknown, doubled, of the wrong type or out of range is "
            'refused with file, line, key, value and what is allowed. [How to write one](write-a-job.md).'),
    'machine': ('Parameters: the machine', "In the node's namespace; `config/grinder.yaml` has them. `<joint>` is `axis_x`, `axis_y`, `axis_z` "
                'or `axis_a`; of two units the second is that of A. One that is missing, half-stated or of the wrong type '
                'stops the start with its full name.'),
    'node': ('Parameters: the node', ''),
    'simulated_drive': ('Parameters: the simulated drive', 'Of the plugin `flute_grinder/SimulatedDrive`.'),
    'hal': ("Parameters: LinuxCNC's HAL as the drive", 'Of the plugin `flute_grinder/HalHardware`; `config/hal.yaml` goes over '
            '`config/grinder.yaml`.'),
}


def table(head, rows):
    """A Markdown table; nothing where there are no rows."""
    if not rows:
        return []
    return ['', '| %s |' % ' | '.join(head), '|' + '---|' * len(head), *('| %s |' % ' | '.join(row) for row in rows)]


def number(value):
    """As the programs write it, 1e+09 and not 1000000000.0; or the name of a parameter."""
    return '`%s`' % value if isinstance(value, str) else '%g' % value


def allowed(entry):
    """What a key may be, as text."""
    text = entry.get('allowed', '')
    if not text and 'range' in entry:
        text = '%s to %s' % tuple(map(number, entry['range']))
    if 'choices' in entry:
        text = ', '.join('`%s`' % choice for choice in entry['choices'])
    if not text:
        text = {'text': 'a text', 'flag': 'true or false'}[entry['type']]
    if entry.get('integer'):
        text += ', whole'
    if 'default' in entry:
        text += '; if left out: %s' % entry['default']
    return text


def keys(schema):
    lines = []
    for section, (title, text) in KEYS.items():
        rows = [('`%s`' % name, entry.get('unit', ''), allowed(entry), entry['meaning'])
                for name, entry in schema[section].items()]
        lines += ['', '## ' + title] + (['', text] if text else [])
        lines += table(('key' if section == 'job' else 'parameter', 'unit', 'allowed', 'meaning'), rows)
    return lines


def fields(text):
    """A part of a message file as (description, constants, fields); a comment below a field belongs to it."""
    description, constants, rows = [], [], []
    for line in text.splitlines():
        code, _, comment = (part.strip() for part in line.partition('#'))
        if not code and comment:
            (rows[-1] if rows else description).append(comment)
        elif '=' in code:
            constants.append('`%s`' % code.split(maxsplit=1)[1])
        elif code:
            kind, name = code.split()
            rows.append([name, kind] + ([comment] if comment else []))
    return ' '.join(description), constants, [('`%s`' % n, '`%s`' % k, ' '.join(c).replace('|', '\\|')) for n, k, *c in rows]


def messages():
    lines = []
    parts = {'msg': [''], 'srv': ['Request', 'Response'], 'action': ['Goal', 'Result', 'Feedback']}
    for folder, title in (('action', 'Action'), ('srv', 'Services'), ('msg', 'Messages')):
        lines += ['', '## ' + title]
        for path in sorted((ROOT / folder).iterdir()):
            lines += ['', '### ' + path.stem]
            for name, text in zip(parts[folder], re.split(r'(?m)^---$', path.read_text())):
                description, constants, rows = fields(text)
                lines += ['', ('*%s.* ' % name if name else '') + description]
                lines += ['', ', '.join(constants) + '.'] if constants else []
                lines += table(('field', 'type', 'meaning'), rows)
    return lines


def launch_arguments():
    """Those that may be set; one with a value is the file's own."""
    rows = []
    for arg in xml.parse(ROOT / 'launch/grinder.launch').getroot().findall('arg'):
        if 'default' not in arg.keys():
            continue
        default = arg.get('default').replace('$(find flute_grinder)/', '')
        rows.append(('`%s`' % arg.get('name'), '`%s`' % default if default else '', arg.get('doc')))
    return ['', '## Launch arguments', '', 'Of `grinder.launch`.', *table(('argument', 'default', 'meaning'), rows)]


def main():
    schema = yaml.safe_load((ROOT / 'docs/schema.yaml').read_text())
    text = HEAD + '\n'.join(keys(schema) + launch_arguments() + messages()) + '\n'
    if '--check' not in sys.argv[1:]:
        FILE.write_text(text)
    elif FILE.read_text() != text:
        sys.exit('docs/reference.md is not up to date: run docs/make_reference.py')


if __name__ == '__main__':
    main()
