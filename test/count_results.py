#!/usr/bin/env python3
"""Counts the test cases in the JUnit files below a folder; names the checks of scripts/test that were skipped and all that
failed, with the end of what they say, and exits 1 if any has failed."""

import pathlib
import sys
import xml.etree.ElementTree as ElementTree

passed, failed, skipped = 0, [], []
for path in sorted(pathlib.Path(sys.argv[1]).rglob('*.xml')):
    counted = 0
    try:
        root = ElementTree.parse(path).getroot()
        cases = list(root.iter('testcase'))
        counted = sum(int(suite.get(kind) or 0) for suite in root.iter('testsuite') for kind in ('failures', 'errors'))
    except ElementTree.ParseError as error:
        cases = []
        failed.append('%s: %s' % (path.name, error))
    # catkin writes a file of its own for a test that left none.
    if not cases:
        failed.append('%s: no test case' % path.name)
    if counted and not any(case.find(kind) is not None for case in cases for kind in ('failure', 'error')):
        failed.append('%s: %d that no test case shows' % (path.name, counted))
    for case in cases:
        skip = case.find('skipped')
        if skip is not None:
            skipped += ['%s: %s' % (case.get('name'), skip.get('message'))] if case.get('classname') == 'checks' else []
            continue
        failures = case.findall('failure') + case.findall('error')
        passed += not failures
        for failure in failures[:1]:
            said = (failure.text or failure.get('message') or '').strip().splitlines()
            said = said[:6] + said[max(6, len(said) - 5):]  # the message, and where it was
            failed.append('\n  '.join(['%s: %s.%s' % (path.name, case.get('classname'), case.get('name')), *said]))
for name in skipped:
    print('SKIPPED ' + name)
for name in failed:
    print('FAILED ' + name)
print('%d passed, %d failed' % (passed, len(failed)))
sys.exit(1 if failed or not passed else 0)
