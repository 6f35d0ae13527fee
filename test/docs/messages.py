#!/usr/bin/env python3
"""Compares docs/when-something-goes-wrong.md with the sources. Every message of the sources in MESSAGES, every state, kind of
fault or reason, interlock, result code and diagnostic status must be on the page, and every message that the page quotes must be
in a source. Prints what is not so; exits with 1 if there is something.

On the page, a message is code in a column that is headed as in QUOTING. In it, `<...>` stands for what the program fills in."""

import ast
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = 'docs/when-something-goes-wrong.md'

QUOTING = ('message', 'held because', 'the panel says')

# Sources in which every text of two words or more is a message, or a part of one. What follows a file are its texts that tell
# nobody of anything wrong: headings, labels, progress, the parts of other files.
MESSAGES = {
    'src/cli/call.h': (),
    'src/node/action_server.h': (),
    'src/node/plain_name.h': (),
    'src/node/state_fields.h': (),
    'src/cli/csv.cpp': (),
    'src/cli/machine_file.cpp': ('a drive, as flute_grinder/SimulatedDrive',),
    'src/cli/online.cpp': ('not confirmed', 'at speed', 'not at speed', 'on, not at speed', 'work position', 'of the machine', 'to go',
                           'the power is on', 'the fault is reset; the power is commanded off', 'held because', 'no journal', 'it ended'),
    'src/cli/probe.cpp': ('work offset',),
    'src/cli/run.cpp': ('canceling: waiting for the stop', 'setpoints in', 'the feed override is'),
    'src/cli/waiting.cpp': (),
    'src/check/machine_shapes.cpp': (),
    'src/curve/face_stroke.cpp': (),
    'src/tool/stl.cpp': ('flute_grinder, lengths in mm',),
    'src/network/master_watch.cpp': (),
    'src/control/loop_requests.cpp': (),
    'src/control/loop_thread.cpp': (),
    'src/control/machine_config.cpp': (),
    'src/machine/machine_model.cpp': (),
    'src/machine/strict_urdf.cpp': (),
    'src/control/request_box.cpp': ('refused: allowed:', 'refused: allowed: hold, cancel, disable'),  # wrong calls of the class
    'include/flute_grinder/machine/loop_fault.h': (),
    'src/machine/offset_fit.cpp': ('width of the wheel', 'another tool', 'not confirmed',
                                     'A as the flutes were ground, or probed on a tooth'),
    'src/machine/offset_limits.cpp': (),
    'include/flute_grinder/base/axes.h': (),
    'include/flute_grinder/job/reason.h': (),
    'src/job/reason.cpp': ('kReasonKinds: no text for {',),
    'src/drive/hal_component.cpp': (),
    'src/drive/hal_fifo.cpp': (),
    'src/drive/hal_hardware.cpp': (),
    'src/drive/parameters.cpp': ('true or false', '; allowed: true or false'),
    'src/tool/rake_touch.cpp': ('the rake face', 'nothing of the flute', 'the cutting edge', "the flute's floor first",
                                    "the flute's other wall first"),
    'src/setup/touch_off.cpp': (),
    'src/messages/continue_job.cpp': (),
    'src/record/measured.cpp': (),
    'src/record/correction.cpp': (),
    'src/panel/correction_dialog.cpp': (
        'next tool, unchanged', 'next tool, corrected', 'yyyy-MM-dd HH:mm:ss', 'Keep what was measured in the record of this tool',
        'Set the work offsets of Y and Z; nothing moves', 'Set them to what they were before the last correction', 'Measured tools of',
        'Correct the zero points?', 'Set them back?', 'Close this window', 'Reading the records ...', 'Set them',
        ', the last of this job and set-up, ground until', '. Enter what a gauge says of its first tooth.',
        'What is shown then counts; nothing moves', 'The work offsets of Y and Z are set.', 'Grind the next tool.', 'Before the next tool,'),
    'src/cli/measured.cpp': (),
    'src/cli/correct.cpp': (),
    'src/node/diagnostics.cpp': ('of the allowed [%]', 'cycle duration', 'wake-up delay'),
    'src/node/goal_server.cpp': ('planned and checked; nothing moved',),
    'src/node/grinder_node.cpp': ('of the parameter server',),
    'src/node/state_file.h': (),
    'src/node/state_file.cpp': (),
    'src/node/offset_server.cpp': ('wheel on the spindle:', 'a tool was clamped, by'),
    'src/node/offset_store.cpp': (),
    'src/messages/plan_result.cpp': ('mm at X', 'removes nothing'),
    'src/node/probe_server.cpp': (),
    'src/node/prober.cpp': (),
    'src/node/probing_cycles.cpp': (),
    'src/node/progress_tracker.cpp': (),
    'src/node/request_server.cpp': (),
    'src/node/stop_server.cpp': ('the job will be held before it moves',),
    'src/node/telemetry.cpp': (),
    'src/panel/grind_panel.cpp': ('the job begins at a feed override of', 'Replies from the grinder', 'is set',
                                  'the job is done', 'the job was sent', 'reclamped: where the teeth are is not known',
                                  'Set it back?', 'is what it was', 'a blank, or to be probed',
                                  'Was a tool clamped? Where its teeth are is then not known, and an unfinished job cannot be continued.',
                                  'touch-off: the work offset of', '. It was not started in this panel.',
                                  'Choose which grinder this panel shows',
                                  'Look at the tool', 'Cut open',
                                  'Leave out a wedge of the ground cutter in rviz, to see its section along the axis',
                                  "Turn rviz's view back to the tool; it does so by itself when another tool is shown"),
    'src/client/grinder_client.cpp': (),
    'src/panel/plain_words.cpp': ('To start it:', 'Swivel set to', 'Swivel at', 'The feed is never reached.', '; no axis limits it.', ', limited by',
                                  r'\nThe first pass cuts', r'\nPasses: depth, area of a section, rate', 'mm more than its infeed out of the shank.',
                                  ', at tooth', 'enable: the power is on', 'home: the drive is homing the axes',
                                  'reset: the fault is cleared; the power is commanded off', ': the wheel is being lifted',
                                  'resume: the job continues', 'the spindle is on; keep clear of the wheel',
                                  'the spindle is off; the wheel runs down', 'the coolant is on', 'the coolant is off', 'was sent'),
    'src/panel/setup_dialog.cpp': ('Write the set-up file', 'Write the set-up file that the job file names', 'Set-up of',
                                   'Close the sheet', 'Write it', 'Replace the set-up of this operation', 'Write this set-up into',
                                   'Written into', 'It is not written.'),
    'src/panel/rviz_window.cpp': ('End rviz', 'The grinder goes on, without its panel'),
    'src/panel/readout.cpp': ('; color: white; padding: 4px; border-radius: 4px;', 'No job runs', 'A job is planned', 'left at 100 %',
                              'Position in work coordinates.\\nMachine:', '\\nWork offset:', 'To go', 'Distance to go to the end of the running move in'),
}

# A comment, a character, a raw string, or a string, which alone has a group.
TOKEN = re.compile(r"""//[^\n]*|/\*.*?\*/|'(?:\\.|[^'\\\n])'|R"\(.*?\)"|"((?:\\.|[^"\\])*)\"""", re.S)
FORMAT = re.compile(r'%%|%-?[\d.]*l*[a-z]|%\d|\{[\w.]+\}')  # what printf, QString or the text of a reason fill in


def read(path):
    return (ROOT / path).read_text()


def literals(text):
    """The string literals of C++, each joined with those that follow it without anything between."""
    found, end = [], 0
    text = re.sub(r'(?m)^#include.*', '', text)
    for token in TOKEN.finditer(text):
        if token.group(1) is None:
            continue
        if found and not text[end:token.start()].strip():
            found[-1] += token.group(1)
        else:
            found.append(token.group(1))
        end = token.end()
    return found


def python_literals(text):
    return [node.value for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Constant) and isinstance(node.value, str)]


def is_phrase(text):
    return re.search(r'[A-Za-z]{2,}\W* \W*[A-Za-z]{2,}', text)


def texts(path):
    """What a source says to people, in pieces between what is filled in; what ends a line is a table or a list."""
    text = re.sub(r'\.add\("[^"]*"', '', read(path))  # names of diagnostics and their values
    pieces = [piece for literal in literals(text) if not literal.endswith('\\n') for piece in FORMAT.split(literal)]
    return [piece.strip() for piece in pieces if is_phrase(piece)]


def rows(page):
    """The cells of every table's row as a dictionary, by the heads of their columns."""
    head = []
    for line in page.splitlines():
        cells = [cell.strip() for cell in line.strip('|').split(' |')] if line.startswith('|') else []
        if not cells or set(line) <= set('|-'):
            head = head if cells else []
        elif head:
            yield dict(zip(head, cells))
        else:
            head = cells


def codes(text):
    return re.findall(r'`([^`\n]+)`', text)


def missing_messages(quoted):
    page = '\n'.join(quoted) + read('docs/reference.md')  # which has what parameters mean
    for path, silent in MESSAGES.items():
        said = texts(path)
        for text in said:
            if text not in page and text not in silent:
                yield '%s: "%s" is not on the page' % (path, text)
        for text in silent:
            if text not in said:
                yield '%s: "%s" is listed in vain' % (path, text)


def is_said(text, sources, rest=False):
    """Whether a text is part of a literal, or of several that are put together. @param sources literals, each in a line of its own.
    @param rest whether the text begins with a literal."""
    start = '\n' if rest else ''
    return start + text in sources or any(start + text[:i] + '\n' in sources and is_said(text[i:], sources, True)
                                          for i in range(1, len(text)))


def missing_sources(quoted):
    readers = {'.h': literals, '.cpp': literals, '.py': python_literals}
    files = [path for folder in ('include', 'src') for path in sorted((ROOT / folder).rglob('*')) if path.suffix in readers]
    sources = '\n'.join(['', *(literal for path in files for literal in readers[path.suffix](path.read_text())), ''])
    for quote in quoted:
        for piece in re.split('<[^>]*>', quote):
            if not is_said(piece.strip(), sources):
                yield 'no source says "%s", of `%s`' % (piece.strip(), quote)


def capitals(name):
    return re.sub(r'(?<!^)(?=[A-Z])', '_', name).upper()


def enumerators(path, enum):
    """Of an enum class, in capitals; without the one for nothing."""
    body = re.search(r'enum class %s\b[^{]*\{(.*?)\};' % enum, read('include/flute_grinder/' + path), re.S).group(1)
    names = re.findall(r'(?m)^  k(\w+)', body)
    return [capitals(name) for name in names if name != 'None']


def fault_codes():
    """The result's code of each kind of fault."""
    codes = dict(re.findall(r'case FaultClass::k(\w+): return flute_grinder::GrindResult::(\w+);', read('src/messages/plan_result.cpp')))
    rows = re.findall(r'\{FaultKind::k(\w+),[^}]*FaultClass::k(\w+)\}', read('include/flute_grinder/machine/loop_fault.h'))
    return {capitals(kind): codes[fault_class] for kind, fault_class in rows}


def missing_states(table):
    for name in re.findall(r'\{MachineState::k\w+, "(\w+)"\}', read('include/flute_grinder/machine/machine_state.h')):
        if not any(row.get('state') == '*%s*' % name for row in table):
            yield 'the state %s has no row' % name
    rows = r'\{MachineState::k\w+, "(\w+)"\},[^"]*"([^"]*)"\}'
    for name, text in re.findall(rows, read('include/flute_grinder/machine/machine_state.h')):
        if not any(row.get('state') == '*%s*' % name and text in codes(row['the panel says']) for row in table):
            yield 'the row of the state %s lacks "%s"' % (name, text)


def missing_kinds(table):
    """Kinds of faults and reasons, interlocks, and the codes of results."""
    kinds = [code for row in table for head in ('kind', 'kind, code') for code in codes(row.get(head, ''))]
    for kind in enumerators('job/reason.h', 'ReasonKind'):
        if kind not in kinds:
            yield 'the reason %s is in no row' % kind
    pairs = [codes(row['kind, code']) for row in table if row.get('kind, code')]
    for kind in enumerators('machine/loop_fault.h', 'FaultKind'):
        pair = [kind, fault_codes().get(kind)]
        if kind != 'LIMIT' and pair not in pairs:  # that has the reasons of the limits
            yield 'the fault %s, %s is in no row' % tuple(pair)
    for text in re.findall(r'\{Interlock::k\w+, "(.+)"\}', read('include/flute_grinder/machine/loop_fault.h')):
        if not any(text in codes(row.get('held because', '')) for row in table):
            yield 'the interlock "%s" has no row' % text
    for name, number in re.findall(r'(?m)^int32 (\w+)=(-?\d+)$', read('action/Grind.action')):
        if not any(name in codes(row.get('code', '')) and number in row.get('number', '').split(', ') for row in table):
            yield 'the code %s = %s has no row' % (name, number)


def missing_statuses(table):
    for status in re.findall(r'updater\.add\("([^"]+)"', read('src/node/diagnostics.cpp')):
        if not any(row.get('status') == '*%s*' % status for row in table):
            yield 'the diagnostic status %s has no row' % status


def wrong():
    """One text for each thing that is wrong."""
    page = read(PAGE)
    table = list(rows(page))
    quoted = [code for row in table for head in QUOTING for code in codes(row.get(head, ''))]
    found = [*missing_messages(codes(page)), *missing_sources(quoted), *missing_states(table), *missing_kinds(table),
             *missing_statuses(table)]
    return ['%s: %s' % (PAGE, text) for text in found]


if __name__ == '__main__':
    problems = wrong()
    print('\n'.join(problems) or 'every message is on the page')
    sys.exit(bool(problems))
