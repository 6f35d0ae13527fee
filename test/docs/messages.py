#!/usr/bin/env python3
"""Holds docs/when-something-goes-wrong.md to the sources: every message of the sources below, every state, fault, reason,
interlock, result code and diagnostic status stands on the page, and every message that the page quotes is in the sources.
Prints what is not so; exits with 1 if there is something.

On the page, a message is code in the first cell of a row of a table, and in any cell of a table with the column "the panel
says". In it, `<...>` stands for what the program fills in."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = 'docs/when-something-goes-wrong.md'

# Where each text of two words or more is a message, or a part of one, that somebody may be shown when something goes wrong.
SOURCES = [
    'include/flute_grinder/cli/call.h',
    'include/flute_grinder/node/plain_name.h',
    'src/cli/online.cpp',
    'src/cli/run.cpp',
    'src/cli/state_watch.cpp',
    'src/connection/master_watch.cpp',
    'src/control/loop_requests.cpp',
    'src/control/loop_thread.cpp',
    'src/control/request_box.cpp',
    'src/core/loop_fault.cpp',
    'src/core/reason.cpp',
    'src/drive/hal_component.cpp',
    'src/drive/hal_fifo.cpp',
    'src/drive/hal_hardware.cpp',
    'src/drive/parameters.cpp',
    'src/messages/continue_job.cpp',
    'src/node/diagnostics.cpp',
    'src/node/goal_desk.cpp',
    'src/node/grinder_node.cpp',
    'src/node/journal_writer.cpp',
    'src/node/kept_file.cpp',
    'src/node/offset_desk.cpp',
    'src/node/offset_store.cpp',
    'src/node/plan_desk.cpp',
    'src/node/probe_desk.cpp',
    'src/node/progress_tracker.cpp',
    'src/node/request_desk.cpp',
    'src/node/stop_desk.cpp',
    'src/panel/grind_panel.cpp',
    'src/panel/grinder_link.cpp',
    'src/panel/job_box.cpp',
    'src/panel/plain_words.cpp',
    'src/panel/readout.cpp',
    'src/panel/touch_off_box.cpp',
]
