#!/usr/bin/env python3
"""Breaks modules in some hundred small ways, one at a time, and notes which tests see each: a measure of what the tests
prove, and of which of them nobody would miss. Works in the user's cache, on the files as they are."""

import argparse
import collections
import concurrent.futures
import fcntl
import json
import os
import pathlib
import random
import re
import resource
import select
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import breaks

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Kept for the next run; not below the clone, where roslaunch would find every file twice.
WORK = pathlib.Path(os.environ.get('XDG_CACHE_HOME') or '~/.cache').expanduser() / 'flute_grinder_mutants' / str(ROOT)[1:]
TREE = WORK / 'tree'
BUILD = TREE / 'build'
BINARIES = BUILD / 'devel/lib/flute_grinder'
PREFIX = 'flute_grinder_test_'
ROUNDS = 12   # of a build, each without the breaks that did not compile in the one before
SLOW = 0.5    # [s]; a test that takes longer is asked only about what no faster one sees
PATIENCE = 3  # times a test may take as long with a mutant as without, and
LEAST = 3     # [s] is always left to it
MEMORY = 4e9  # [bytes] that a process gets: some mutants never end to append
# Fewer than in scripts/test, for time; a case that fails is not made smaller.
RANDOM_CASES = 'seed=20 max_success=30 noshrink=1'

# The rides, a test of what the control loop does, are as close to these modules as their own.
RIDES, RIDDEN = 'rides', ('motion', 'control')

Case = collections.namedtuple('Case', 'suite name')


def git(*arguments):
    return subprocess.run(['git', '-C', ROOT, *arguments], check=True, stdout=subprocess.PIPE).stdout.decode()


def copy_tree():
    """Brings the copy up to date, so that make builds again what is different."""
    names = {name for name in git('ls-files', '-z', '--cached', '--others', '--exclude-standard').split('\0')
             if name and (ROOT / name).exists()}
    for path in TREE.rglob('*'):
        if path.is_file() and BUILD not in path.parents and str(path.relative_to(TREE)) not in names:
            path.unlink()
    for name in names:
        write(TREE / name, (ROOT / name).read_bytes())
        shutil.copymode(ROOT / name, TREE / name)


def write(path, data):
    if path.exists() and path.read_bytes() == data:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)


def make(*arguments):
    return subprocess.run(['make', '-C', BUILD, '-j%d' % os.cpu_count(), *arguments], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT).stdout.decode(errors='replace')


def configure():
    if (BUILD / 'Makefile').exists():
        return
    subprocess.run(['cmake', '-S', TREE, '-B', BUILD, '-DCMAKE_BUILD_TYPE=Release', '-DTESTS_IN_ALL=ON',
                    '-DCATKIN_ENABLE_TESTING=ON', '-DBUILD_BENCHMARKS=OFF', '-DPYTHON_EXECUTABLE=/usr/bin/python3',
                    '-DPython3_EXECUTABLE=/usr/bin/python3',
                    '-DCMAKE_CXX_FLAGS=--param=ggc-min-heapsize=1000000'], check=True, stdout=subprocess.DEVNULL)
    make('flute_grinder_generate_messages_cpp')


def module_of(name):
    """The module of a file src/<module>/... or include/flute_grinder/<module>/..."""
    return name.replace('include/flute_grinder/', 'src/').split('/')[1]


def arguments_of(module):
    """The compiler's, of all of a module's sources together: some have definitions of their own."""
    arguments = []
    for entry in json.loads((BUILD / 'compile_commands.json').read_text()):
        if '/src/%s/' % module in entry['file']:
            words = shlex.split(entry['command'])[1:]
            arguments += [w for w in words[:words.index('-o')] if re.match(r'-[ID]|-isystem|-std|/', w)]
    if not arguments:
        raise SystemExit('no module ' + module)
    resources = subprocess.run(['clang', '-print-resource-dir'], check=True, stdout=subprocess.PIPE)
    # The messages' constants are compared in more steps than clang takes by itself.
    return arguments + ['-fconstexpr-steps=100000000', '-resource-dir', resources.stdout.decode().strip()]


def add_all(finder, module):
    """Finds the breaks of a module's sources."""
    compiler = arguments_of(module)
    for source in sorted((TREE / 'src' / module).glob('*.cpp')):
        try:
            finder.add(source, compiler)
        except RuntimeError as error:
            if 'file not found' not in str(error):
                raise
            print('left out, e.g. a drive whose library is not installed: %s' % error)


def targets_of(arguments):
    """What is built: the test programs that are asked, or for a command everything."""
    if arguments.also:
        return ['all']
    names = re.findall(r'(?m)^\.\.\. (%s\w+)$' % PREFIX, make('help')) + [RIDES]
    return ['flute_grinder_' + RIDES if name == RIDES else name for name in names if re.search(arguments.tests, name)]


def build_with(finder, targets):
    """Builds with all breaks. @return the numbers of those that compile."""
    without, header = set(), ROOT / 'test/mutants/mutant.h'
    for _ in range(ROUNDS):
        texts = finder.rewritten(header, without)
        for name, text in texts.items():
            write(TREE / name, text.encode())
        log = make('-k', *targets)
        (WORK / 'build.log').write_text(log)
        places = re.findall(r'(?m)^(?:In file included from |\s+inlined from )?\S*?((?:src|include)/\S+?):(\d+):.*', log)
        wrong = {(name, int(line)) for name, line in places if name in texts and line != '0'} - without
        if ' error: ' not in log:
            return {b.number for b in finder.breaks if (b.file, b.line) not in without}
        if not wrong:
            raise SystemExit('%s: does not compile, and not for a break' % (WORK / 'build.log'))
        without |= wrong
    raise SystemExit('%s: does not compile after %d rounds' % (WORK / 'build.log', ROUNDS))


def limit_memory():
    resource.setrlimit(resource.RLIMIT_AS, (int(MEMORY), int(MEMORY)))


def run(command, environment, patience):
    """@param patience the seconds that a test by the name of the key may take, and by no name what is no test.
    @return what it prints, and whether it ended well; nothing for the latter if it did not end."""
    process = subprocess.Popen(command, cwd=TREE, env=dict(os.environ, RC_PARAMS=RANDOM_CASES, **environment),
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True, preexec_fn=limit_memory)
    text, deadline, hangs = b'', time.monotonic() + patience[''], False
    while not hangs:
        ready, _, _ = select.select([process.stdout], [], [], max(0, deadline - time.monotonic()))
        chunk = os.read(process.stdout.fileno(), 1 << 16) if ready else b''
        hangs = not ready
        if ready and not chunk:
            break
        text += chunk
        begun = re.findall(r'(?m)^\[ RUN +\] (\S+)\n', chunk.decode(errors='replace'))
        if begun:
            deadline = time.monotonic() + patience.get(begun[-1], patience[''])
    good = None if hangs else process.wait() == 0
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    process.wait()
    process.stdout.close()
    return text.decode(errors='replace'), good


def command(suite, names):
    """The command of a program with some of its tests; of a suite that is a command, that."""
    if suite == RIDES:
        return [BINARIES / suite, '--from', '0', '--count', '300']
    if not suite.startswith(PREFIX):
        return shlex.split(suite)
    return [BINARIES / suite, '--gtest_filter=' + ':'.join(names)]


def cases_of(suite):
    """The tests of a program."""
    if not suite.startswith(PREFIX):
        yield Case(suite, '')
        return
    text, good = run([BINARIES / suite, '--gtest_list_tests'], {}, {'': LEAST})
    if not good:
        raise SystemExit('%s does not say which tests it has' % suite)
    group = ''
    for line in text.splitlines():
        name = line.split('#')[0].rstrip()
        if name.endswith('.') and not name.startswith(' '):
            group = name
        elif name.startswith('  ') and group:
            yield Case(suite, group + name.strip())


def seen_by(suite, names, number, patience):
    """The tests among those named that see a mutant. One that crashes ends its process: the others go on in another; one that
    hangs is enough."""
    seen, left = set(), list(names)
    while left:
        text, good = run(command(suite, left), {'MUTANT': str(number)}, patience)
        if good:
            break
        ended = set(re.findall(r'(?m)^\[ +(?:OK|FAILED) +\] (\S+?)(?:,.*)? \(', text))
        seen |= set(re.findall(r'(?m)^\[ +FAILED +\] (\S+?)(?:,.*)? \(', text)) & set(left)
        left = [name for name in left if name not in ended]
        broken = [name for name in re.findall(r'(?m)^\[ RUN +\] (\S+)', text) if name in left]
        if not broken:  # what ends outside of a test is seen by all
            seen |= set(left)
            break
        seen.add(broken[0])
        if good is None:
            break
        left.remove(broken[0])
    return seen


def reached_by(case):
    """The numbers of the mutants that a test comes by, and how long it takes; none if it fails without a mutant."""
    with tempfile.TemporaryDirectory() as folder:
        begin = time.monotonic()
        text, good = run(command(case.suite, [case.name]), {'MUTANTS_REACHED': folder}, {'': 600})
        took = time.monotonic() - begin
        if not good:
            print('%s %s fails without a mutant: left out\n%s' % (*case, text[-500:]), file=sys.stderr)
            return set(), took
        return {int(n) for file in pathlib.Path(folder).iterdir() for n in file.read_text().split()}, took


def ask(number, cases, took, own):
    """The tests that see a mutant: of the module's own, all fast ones, or else all slow ones; or else one of the others."""
    stages = collections.defaultdict(lambda: collections.defaultdict(list))
    for case in cases:
        stages[case.suite not in own, took[case] > SLOW][case.suite].append(case.name)
    for (others, _), suites in sorted(stages.items()):
        seen = set()
        for suite, names in sorted(suites.items()):
            patience = {name: LEAST + PATIENCE * took[Case(suite, name)] for name in names}
            patience[''] = max(patience.values())
            seen |= {Case(suite, name) for name in seen_by(suite, names, number, patience)}
            if others and seen:
                break
        if seen:
            return seen
    return set()


def own_suites(module):
    text = (TREE / 'test/CMakeLists.txt').read_text()
    suites = {PREFIX + name for name, of in re.findall(r'add_unit_test\((\w+) MODULE (\w+)', text) if of == module}
    return suites | ({RIDES} if module in RIDDEN else set())


def enough(seen):
    """Tests which together see what all do, those that see most alone first."""
    left, chosen = {number for number in seen if seen[number]}, []
    while left:
        counts = collections.Counter(case for number in left for case in seen[number])
        best = max(sorted(counts), key=lambda case: counts[case])
        chosen.append(best)
        left -= {number for number in left if best in seen[number]}
    return chosen


def drawn(numbers, finder, arguments):
    """So many numbers of each module's breaks, at random."""
    for module in arguments.modules:
        of = [n for n in numbers if module_of(finder.breaks[n].file) == module]
        yield from sorted(random.Random(arguments.seed).sample(of, min(arguments.most, len(of))))


def share(seen, of):
    """How many of some breaks are seen, as text."""
    good = sum(bool(seen[n]) for n in of)
    return 'asked about: %d, seen: %d (%.1f %%)' % (len(of), good, 100 * good / max(1, len(of)))


def report(finder, numbers, reached, seen, took, own):
    """The result, as text."""
    unseen = [n for n in sorted(seen) if not seen[n]]
    everywhere = set().union(*reached.values())
    print('breaks: %d, reached by tests: %d, %s' % (len(numbers), len(numbers & everywhere), share(seen, list(seen))))
    for module in sorted({module_of(finder.breaks[n].file) for n in seen}):
        print('%s: %s' % (module, share(seen, [n for n in seen if module_of(finder.breaks[n].file) == module])))
    print('\nNo test sees:')
    for n in unseen:
        b = finder.breaks[n]
        print('  %s:%d:%d %s%s' % (b.file, b.line, b.column, b.text, '' if n in everywhere else ' (no test reaches it)'))
    print('\nTests that see (breaks, those seen by no other, seconds; -: the others see as much without it):')
    total = collections.Counter(case for by in seen.values() for case in by)
    alone = collections.Counter(next(iter(by)) for by in seen.values() if len(by) == 1)
    chosen = set(enough(seen))
    cases = [case for case in took if total[case] or (case.suite in own and reached[case] & numbers)]
    for case in sorted(cases, key=lambda c: (c not in chosen, c)):
        print('  %s %4d %4d %6.2f %s %s' % ('+' if case in chosen else '-', total[case], alone[case], took[case],
                                           case.suite.replace(PREFIX, ''), case.name))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('modules', metavar='MODULE', nargs='+', help='a folder of src/, e.g. motion')
    parser.add_argument('--most', metavar='N', type=int, default=400, help='mutants of each module to ask about, drawn at random (default 400)')
    parser.add_argument('--seed', metavar='S', type=int, default=1, help='of the draw')
    parser.add_argument('--files', metavar='REGEX', default='', help='only breaks of these files')
    parser.add_argument('--tests', metavar='REGEX', default='', help='only test programs with these names')
    parser.add_argument('--also', metavar='COMMAND', action='append', default=[],
                        help="what else sees a break by its exit status, e.g. 'docs/make_reference.py --check'")
    parser.add_argument('--headers', action='store_true', help="also the module's headers: all is built anew")
    parser.add_argument('--json', metavar='FILE', help='write which tests see which mutants')
    arguments = parser.parse_args()

    WORK.mkdir(parents=True, exist_ok=True)
    lock = open(WORK / 'lock', 'w')
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise SystemExit('%s: another run works there' % WORK) from None
    copy_tree()
    configure()
    roots = ['src'] + (['include/flute_grinder'] if arguments.headers else [])
    finder = breaks.Finder(TREE, ['%s/%s/' % (root, module) for module in arguments.modules for root in roots])
    for module in arguments.modules:
        add_all(finder, module)
    for program in BINARIES.glob(PREFIX + '*'):
        program.unlink()  # one that is not built any more would see breaks, against libraries that it does not fit
    numbers = build_with(finder, targets_of(arguments))
    print('%d breaks, %d compile' % (len(finder.breaks), len(numbers)), file=sys.stderr)

    suites = [s for s in sorted(p.name for p in BINARIES.glob(PREFIX + '*')) + [RIDES] if re.search(arguments.tests, s)]
    suites += arguments.also
    cases = [case for suite in suites for case in cases_of(suite)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = dict(zip(cases, pool.map(reached_by, cases)))
        reached = {case: result[0] for case, result in results.items()}
        took = {case: result[1] for case, result in results.items()}
        asked = [n for n in sorted(numbers) if re.search(arguments.files, finder.breaks[n].file)]
        asked = list(drawn(asked, finder, arguments))
        print('%d tests, %.0f s; asking about %d' % (len(cases), sum(took.values()), len(asked)), file=sys.stderr)
        seen, own = {}, {module: own_suites(module) for module in arguments.modules}
        near = {n: own[module_of(finder.breaks[n].file)] for n in asked}
        for n, by in zip(asked, pool.map(lambda n: ask(n, [c for c in cases if n in reached[c]], took, near[n]), asked)):
            seen[n] = by
            if len(seen) % 50 == 0:
                print('%d asked' % len(seen), file=sys.stderr)
    report(finder, numbers, reached, seen, took, set().union(*own.values()))
    if arguments.json:
        found = [dict(finder.breaks[n]._asdict(), seen_by=sorted((c.suite.replace(PREFIX, '') + ' ' + c.name).strip() for c in seen[n]))
                 for n in asked]
        pathlib.Path(arguments.json).write_text(json.dumps(found, indent=1))


if __name__ == '__main__':
    main()
