#!/usr/bin/env python3
"""Follows every link and picture of README.md and docs/*.md, and every file and name of the code that docs/architecture.md
speaks of. Prints what leads nowhere; exits with 1 if something does."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = ['README.md'] + sorted(str(path.relative_to(ROOT)) for path in (ROOT / 'docs').glob('*.md'))
# Where the architecture's files are named from.
BASES = ['', 'include/flute_grinder', 'src'] + [str(path.relative_to(ROOT)) for path in (ROOT / 'include/flute_grinder').iterdir()]
SOURCES = ['include', 'src', 'msg', 'srv', 'action', 'launch', 'config']


def anchors(text):
    """Of a page's headings, as GitHub names them."""
    return {re.sub(r'[^\w -]', '', heading.lower()).replace(' ', '-') for heading in re.findall(r'(?m)^#+ (.*)$', text)}


def wrong_links(page):
    text = (ROOT / page).read_text()
    for link in re.findall(r'\]\(([^)\s]+)\)|(?:src|href)="([^"]+)"', text):
        link = ''.join(link)
        path, _, anchor = link.partition('#')
        file = (ROOT / page).parent / path if path else ROOT / page
        if '://' in link:
            continue
        if not file.exists() or anchor and anchor not in anchors(file.read_text()):
            yield '%s: a link to %s' % (page, link)


def is_path(text):
    return re.fullmatch(r'[\w./]+', text) and ('/' in text or re.search(r'\.(h|cpp|py|msg|md|yaml)$', text))


def wrong_names(page):
    """Files that are not there, and names that no source has."""
    sources = ''.join(path.read_text() for folder in SOURCES for path in sorted((ROOT / folder).rglob('*'))
                      if path.is_file() and path.suffix != '.pyc')
    known = set(re.findall(r'\w+', sources))
    for code in re.findall(r'`([^`]+)`', (ROOT / page).read_text()):
        if is_path(code):
            if not any((ROOT / base / code).exists() for base in BASES):
                yield '%s: no file %s' % (page, code)
        else:
            yield from ('%s: %s is in no source' % (page, word) for word in re.findall(r'\w+', code) if word not in known)


def wrong():
    """One text for each thing that is wrong."""
    return [text for page in PAGES for text in wrong_links(page)] + list(wrong_names('docs/architecture.md'))


if __name__ == '__main__':
    found = wrong()
    print('\n'.join(found) or 'every link and name leads somewhere')
    sys.exit(bool(found))
