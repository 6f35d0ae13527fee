"""Looks at a page in Chromium without a window."""

import html
import json
import os
import re
import subprocess
import tempfile

# What a page says of itself: its width and what sticks out of it, the colours, and the size of the smallest text in pictures.
SCRIPT = '''<script>
const width = document.documentElement.clientWidth, style = getComputedStyle(document.body);
const out = [...document.querySelectorAll('body *')].filter(e => e.getBoundingClientRect().right > width + 1);
const texts = [...document.querySelectorAll('figure svg text')];
const sizes = texts.map(t => parseFloat(getComputedStyle(t).fontSize) * t.ownerSVGElement.getScreenCTM().a);
parent.postMessage(JSON.stringify({
  width, scroll: document.documentElement.scrollWidth, out: out.map(e => e.tagName + ' ' + e.textContent.slice(0, 40)),
  smallest: Math.min(...sizes.filter(size => size > 0)), background: style.backgroundColor, ink: style.color,
  inks: [...new Set(texts.map(t => getComputedStyle(t).fill))]}), '*');
</script></body>'''

# A window is no narrower than 500 px; a frame in it can be.
FRAME = '''<!DOCTYPE html><html><body style="margin: 0"><pre id="reported"></pre>
<iframe src="%s" scrolling="no" style="border: 0; width: %dpx; height: 2000px"></iframe>
<script>onmessage = message => { document.getElementById('reported').textContent = message.data; };</script></body></html>'''


NUMBERS_PAGES = 131  # the first version that prints what a style sheet puts into a page's margin


def version():
    """Of Chromium, its first number; 0 where it is not installed."""
    try:
        reported = subprocess.check_output(['chromium', '--version'], universal_newlines=True)
    except FileNotFoundError:
        return 0
    return int(re.search(r'\d+', reported).group())


def chromium(*arguments):
    sandbox = ['--no-sandbox'] if os.geteuid() == 0 else []
    with tempfile.TemporaryDirectory() as profile:
        done = subprocess.run(['chromium', '--headless=new', '--disable-gpu', *sandbox, '--user-data-dir=' + profile, *arguments],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout


def take_picture(source, path, width, height):
    """The upper part of a page (HTML), into a file."""
    with tempfile.NamedTemporaryFile('w', suffix='.html') as page:
        page.write(source)
        page.flush()
        chromium('--screenshot=' + path, '--hide-scrollbars', '--window-size=%d,%d' % (width, height), 'file://' + page.name)


def look_at(source, width, dark=False):
    """What a page (HTML) is like at a width in px."""
    with tempfile.TemporaryDirectory() as folder:
        page, frame = os.path.join(folder, 'page.html'), os.path.join(folder, 'frame.html')
        for path, text in ((page, source.replace('</body>', SCRIPT)), (frame, FRAME % ('page.html', width))):
            with open(path, 'w') as file:
                file.write(text)
        # Virtual time, so that the message has come.
        dom = chromium('--dump-dom', '--window-size=1400,2000', '--virtual-time-budget=10000',
                       '--blink-settings=preferredColorScheme=%d' % (0 if dark else 1), 'file://' + frame)
    return json.loads(html.unescape(re.search(r'<pre id="reported">(.*)</pre>', dom).group(1)))


def lightness(colour):
    """Of an rgb() colour, 0 to 1."""
    return sum(int(part) for part in re.findall(r'\d+', colour)[:3]) / 3 / 255
