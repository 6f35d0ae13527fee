"""Reads a page of the documentation as what a reader is to type, and what they are to see.

A block is indented by four spaces, or fenced. Within it, a paragraph that begins with a command (COMMAND) is commands, one a
line; the paragraph that follows it in the same block is what the last one prints: every line of it is looked for in the output, in order, where
`...` stands for anything. A fenced block below a line that ends in `path`: is a file that the reader writes. A comment ahead of
a block says what a reader sees by themselves:

    <!-- test: while COMMAND -->      the block is typed while that command runs, which must end well unless the last cancels it
    <!-- test: after Ctrl-C -->       what was launched has been ended
    <!-- test: after Ctrl-C in COMMAND --> that command has been broken off in the midst of its job
    <!-- test: exits N -->            the last command of the block ends with this status
    <!-- test: output of COMMAND -->  the block is what that command has printed
    <!-- figures: ... -->             the table below has figures that grind has printed, see figures.py

pages.py PAGE FOLDER: writes the files of a page, in FOLDER where the page has the home folder.
"""

import pathlib
import re
import sys
from dataclasses import dataclass, field

PROGRAMS = r'(?:scripts|build)/\w\S*|rosrun|roslaunch|rostest|rosbag|rostopic|rosservice|rosparam|rviz|halcmd|halrun|python3|grind'
COMMAND = re.compile(r'(?:%s|source|export|cd|cmake|catkin_make|git|rosdep|sudo|cp|chmod|sed|kill|uname|latency-histogram)(?= |$)'
                     % PROGRAMS)


@dataclass
class Item:
    """A part of a page: kind is commands, output, file, figures, text or mention."""
    kind: str
    line: int
    lines: list
    directive: str = ''
    path: str = ''


@dataclass
class Block:
    line: int
    fenced: bool
    lines: list = field(default_factory=list)


def join_continued(lines):
    """Lines that end in a backslash with those that follow; without comments."""
    text = '\n'.join(lines).replace('\\\n', ' ')
    return [line for line in (re.sub(r'(^|\s)#.*', '', line).strip() for line in text.splitlines()) if line]


def of_block(block, directive):
    """The items of a block: its paragraphs."""
    items, first = [], block.line
    for paragraph in '\n'.join(block.lines).split('\n\n'):
        lines = [line for line in paragraph.splitlines() if line.strip()]
        if directive.startswith('output of '):
            kind = 'output'
        elif lines and COMMAND.match(lines[0]):
            kind = 'commands'
        else:
            kind = 'output' if items and items[-1].kind in ('commands', 'output') else 'text'
        if lines:
            items.append(Item(kind, first, join_continued(lines) if kind == 'commands' else lines, directive))
        first += paragraph.count('\n') + 2
    return items


def tables(lines, first):
    """The table that begins at a line, as rows of cells."""
    rows = []
    for line in lines[first:]:
        if not line.startswith('|'):
            break
        rows.append([cell.strip() for cell in line.strip('|').split('|')])
    return [rows[0]] + rows[2:]


def read_page(text):
    """All items of a page, in order."""
    lines = text.splitlines()
    items, directive, said, last, i = [], '', '', '', 0
    while i < len(lines):
        line = lines[i]
        note = re.fullmatch(r'<!-- (test|figures): (.*) -->', line)
        fence = re.match(r'```', line)
        if note and note.group(1) == 'figures':
            items.append(Item('figures', i + 1, tables(lines, i + 2), note.group(2)))
        elif note:
            directive = note.group(2)
        elif fence or (line.startswith('    ') and not said):
            block = Block(i + 1 + bool(fence), bool(fence))
            i += bool(fence)
            while i < len(lines) and (lines[i] != '```' if fence else lines[i].startswith('    ') or not lines[i]):
                block.lines.append(lines[i] if fence else lines[i][4:])
                i += 1
            path = re.search(r'`([^` ]+)`:$', last) if fence else None
            if path:
                items.append(Item('file', block.line, block.lines, '', path.group(1)))
            else:
                items += of_block(block, directive)
            directive = ''
            i -= not fence
            said = ''
        else:
            items += [Item('mention', i + 1, [span]) for span in re.findall(r'`([^`]+)`', line) if COMMAND.match(span)]
            said = line
            last = line or last
        i += 1
    return items


def write_file(path, lines):
    """A file of a page; one that is up to date keeps its time, by which make goes."""
    text = '\n'.join(lines) + '\n'
    if not path.exists() or path.read_text() != text:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


if __name__ == '__main__':
    page, folder = sys.argv[1:]
    for item in read_page(pathlib.Path(page).read_text()):
        if item.kind == 'file':
            write_file(pathlib.Path(item.path.replace('~', folder, 1)), item.lines)
