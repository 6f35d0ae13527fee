#!/usr/bin/env python3
"""Runs every command that README.md and docs/*.md tell a reader to type, writes the files that they tell him to write, and
compares what is printed, and all tables of figures, with what stands there. How a page is read is in pages.py.

test/rviz/on_screen test/docs/test_docs.py [PAGE...]: all pages unless some are named."""

import concurrent.futures
import os
import re
import subprocess
import sys
import tempfile
import textwrap
import traceback

import figures
from commands import NOT_RUN
from links import PAGES
from pages import read_page, write_file
from session import ROOT, Failure, Session, missing_line

IN_HAL = {'docs/shop-floor-pc.md'}
# What a new user reads, so that nothing may have been typed before.
FROM_THE_BEGINNING = {'README.md', 'docs/first-cutter.md', 'docs/install.md'}


def run_commands(session, item):
    commands = [command for command in item.lines if command not in NOT_RUN]
    other = re.fullmatch('while (.*)', item.directive)
    broken_off = re.fullmatch('after Ctrl-C in (.*)', item.directive)
    status = re.fullmatch(r'exits (\d)', item.directive)
    if item.directive and not (other or broken_off or status or item.directive == 'after Ctrl-C'):
        raise Failure('line %d: what is "%s"?' % (item.line, item.directive))
    if other:
        return session.type_while(other.group(1), commands)
    if item.directive == 'after Ctrl-C':
        session.end_launched()
    if broken_off:
        session.type_while(broken_off.group(1), [], broken_off=True)
    for i, command in enumerate(commands):
        last = i == len(commands) - 1
        session.type(command, int(status.group(1)) if status and last else 0)


def check_output(session, item, last):
    command = item.directive[len('output of '):] if item.directive.startswith('output of ') else last
    if command in NOT_RUN:
        return
    if command not in session.outputs:
        raise Failure('line %d: no output of %s' % (item.line, command))
    line = missing_line(item.lines, session.outputs[command])
    if line:
        raise Failure('line %d: "%s" is not in the output of %s:\n%s'
                      % (item.line, line.strip(), command, session.outputs[command]))


def grind_job(command, job, *arguments):
    """What a subcommand of grind says of a job that is given as text."""
    with tempfile.NamedTemporaryFile('w', suffix='.yaml') as file:
        file.write(job.replace('setup: {file: ', 'setup: {file: %s/jobs/' % ROOT))
        file.flush()
        return subprocess.run([ROOT / 'build/devel/lib/flute_grinder/grind', command, file.name, *arguments], check=True,
                              env=dict(os.environ, ROS_PACKAGE_PATH=str(ROOT)), stdout=subprocess.PIPE,
                              universal_newlines=True).stdout


def do(session, item, last):
    """Does what an item asks of the reader."""
    if item.kind == 'file':
        write_file(session.clone / item.path.replace('~', str(session.home)), item.lines)
    elif item.kind == 'commands':
        run_commands(session, item)
    elif item.kind == 'output':
        check_output(session, item, last)
    elif item.kind == 'figures':
        found = figures.wrong(item, lambda path: (ROOT / path).read_text(), grind_job)
        if found:
            raise Failure('line %d: %s' % (item.line, '; '.join(found)))


def run_page(page):
    """Types a page from its begin to its end. @return what is wrong, empty if nothing is."""
    if page in IN_HAL and 'INSIDE_HAL' not in os.environ:
        done = subprocess.run([ROOT / 'test/hal/in_hal', sys.executable, __file__, page], stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        return '' if done.returncode == 0 else done.stdout
    session = Session()
    try:
        if page not in FROM_THE_BEGINNING:
            session.type('source build/devel/setup.bash')
        if page in IN_HAL:
            session.type('halcmd stop; halrun -U')
        last = ''
        for item in read_page((ROOT / page).read_text()):
            do(session, item, last)
            last = item.lines[-1] if item.kind == 'commands' else last
        session.end_launched()
    except Failure as failure:
        return textwrap.indent(str(failure), page + ': ')
    except Exception:
        return textwrap.indent(traceback.format_exc(), page + ': ')
    finally:
        session.close()
    return ''


def main():
    pages = sys.argv[1:] or PAGES
    with concurrent.futures.ThreadPoolExecutor(3) as pool:
        wrong = list(filter(None, pool.map(run_page, pages)))
    print('\n'.join(wrong))
    print('%d pages, %d things wrong' % (len(pages), len(wrong)))
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
