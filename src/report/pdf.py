"""Prints a page into a PDF file."""

import os
import shutil
import subprocess
import tempfile

from record import SourceError

BROWSERS = ('chromium', 'chromium-browser', 'google-chrome')


def print_pdf(text, path):
    """By a browser without a window, on A4 as the page's style sheet says. @raise SourceError, OSError"""
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if not browser:
        raise SourceError('cannot be printed without a browser; install chromium, or print the HTML file with another')
    # Fail before the browser does, which tells less.
    with open(path, 'ab'):
        pass
    with tempfile.TemporaryDirectory() as folder:
        page, made = os.path.join(folder, 'report.html'), os.path.join(folder, 'report.pdf')
        with open(page, 'w', encoding='utf-8') as file:
            file.write(text)
        # The page is our own file and loads nothing; root, as in a container, has no sandbox.
        sandbox = ['--no-sandbox'] if os.geteuid() == 0 else []
        done = subprocess.run([browser, '--headless=new', '--disable-gpu', *sandbox, '--no-pdf-header-footer',
                               '--user-data-dir=' + os.path.join(folder, 'profile'), '--print-to-pdf=' + made, page],
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, universal_newlines=True)
        if not os.path.exists(made):
            raise SourceError('%s printed nothing: %s' % (browser, done.stderr.strip()[-500:]))
        try:
            shutil.copyfile(made, path)
        except OSError as error:
            raise OSError(error.errno, error.strerror, path)
