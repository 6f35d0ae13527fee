"""Draws a report. `grind report` starts it, and hands it all that the report says as a JSON document on standard input."""

import argparse

from document import run, write


def arguments():
    parser = argparse.ArgumentParser(prog='grind report')
    parser.add_argument('--output')
    parser.add_argument('--pdf')
    return parser.parse_args()


def draw(data, given):
    """@raise Failure"""
    # matplotlib is slow to load.
    from page import page
    from pictures import draw_all
    text = page(data, draw_all(data))
    if given.output:
        write(given.output, text)
    if given.pdf:
        from pdf import print_pdf
        print_pdf(text, given.pdf)


if __name__ == '__main__':
    options = arguments()
    run(lambda document: draw(document, options))
