"""Draws a report. `grind report` starts it, and hands it the contents of the report as a JSON document on standard input."""

import argparse

from document import Output, run


def arguments():
    parser = argparse.ArgumentParser(prog='grind report')
    parser.add_argument('--output', type=Output)
    parser.add_argument('--pdf', type=Output)
    return parser.parse_args()


def draw(data, given):
    """Draws the report of a document into its files. @raise Failure"""
    if given.pdf:
        from pdf import find_browser
        browser = find_browser(given.pdf)
    # matplotlib is slow to load.
    from page import page
    from pictures import draw_all
    text = page(data, draw_all(data))
    if given.output:
        given.output.write(text.encode())
    if given.pdf:
        from pdf import print_pdf
        print_pdf(browser, text, given.pdf)


if __name__ == '__main__':
    options = arguments()
    run(lambda document: draw(document, options))
