"""Prints a page into a PDF file."""

import os
import shutil
import subprocess
import tempfile

from document import Failure, writing

TIMEOUT = 300  # longest time for the browser [s]
BROWSERS = ('chromium', 'chromium-browser', 'google-chrome')


def find_browser(output):
    """The path of a browser that can print. @raise Failure"""
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if not browser:
        raise Failure(output.path +
                      ': cannot be printed without a browser; install chromium, or print the HTML file with another')
    return browser


def print_pdf(browser, text, output):
    """Prints with a browser without a window, on A4 as set by the page's style sheet. @raise Failure"""
    with writing(output.path), tempfile.TemporaryDirectory() as folder:
        page, made = os.path.join(folder, 'report.html'), os.path.join(folder, 'report.pdf')
        with open(page, 'w', encoding='utf-8') as file:
            file.write(text)
        # The page is our own file and loads nothing; root, as in a container, has no sandbox.
        sandbox = ['--no-sandbox'] if os.geteuid() == 0 else []
        command = [browser, '--headless=new', '--disable-gpu', *sandbox, '--no-pdf-header-footer',
                   '--user-data-dir=' + os.path.join(folder, 'profile'), '--print-to-pdf=' + made, page]
        try:
            done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, universal_newlines=True,
                                  timeout=TIMEOUT)
        except subprocess.TimeoutExpired:
            raise Failure('%s: %s does not end within %d s' % (output.path, browser, TIMEOUT))
        if not os.path.exists(made):
            raise Failure('%s: %s printed nothing: %s' % (output.path, browser, done.stderr.strip()[-500:]))
        with open(made, 'rb') as file:
            output.write(file.read())
