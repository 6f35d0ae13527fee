"""Looks at a page in Chromium without a window."""

import json
import os
import re
import subprocess
import tempfile

# What a page says of itself: its width and what sticks out of it, the colours, and the size of the smallest text in pictures.
SCRIPT = '''<script>
const width = document.documentElement.clientWidth, style = getComputedStyle(document.body);
const out = [...document.querySelectorAll('body *')].filter(e => e.getBoundingClientRect().right > width + 1);
const sizes = [...document.querySelectorAll('figure svg text')].map(
  t => parseFloat(getComputedStyle(t).fontSize) * t.ownerSVGElement.getScreenCTM().a);
const inks = [...document.querySelectorAll('figure svg text')].map(t => getComputedStyle(t).fill);
document.body.innerHTML = '<pre id="told">' + JSON.stringify({
  width, scroll: document.documentElement.scrollWidth, out: out.map(e => e.tagName + ' ' + e.textContent.slice(0, 40)),
  smallest: Math.min(...sizes), background: style.backgroundColor, ink: style.color, inks: [...new Set(inks)]}) + '</pre>';
</script></body>'''


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
    """What a page (HTML) is like in a window of a width in px."""
    with tempfile.NamedTemporaryFile('w', suffix='.html') as page:
        page.write(source.replace('</body>', SCRIPT))
        page.flush()
        dom = chromium('--dump-dom', '--window-size=%d,2000' % width,
                       '--blink-settings=preferredColorScheme=%d' % (0 if dark else 1), 'file://' + page.name)
    return json.loads(re.search(r'<pre id="told">(.*)</pre>', dom).group(1))


def lightness(colour):
    """Of an rgb() colour, 0 to 1."""
    return sum(int(part) for part in re.findall(r'\d+', colour)[:3]) / 3 / 255
