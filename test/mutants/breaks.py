"""The small breaks of a module's sources, found by clang's syntax tree, and the sources with all of them in: each is a call of
mutant.h, which breaks nothing but in a process that has this one."""

import collections
import re

from clang import cindex
from clang.cindex import CursorKind as Kind
from clang.cindex import TypeKind

# What is broken: its place in the original, and what is done to it.
Break = collections.namedtuple('Break', 'number file line column text')
# A rewriting: from start to end, `before` and `after` come around it, and `inside`, a list of (start, end, text), is replaced.
_Edit = collections.namedtuple('_Edit', 'start end before after inside line')

_ARITHMETIC = {'+': ('plus', '-'), '-': ('minus', '+'), '*': ('times', '+'), '/': ('over', '*')}
_ORDERS = {'<': ('less', '<=', '>='), '<=': ('lessEqual', '<', '>'), '>': ('greater', '>=', '<='),
           '>=': ('greaterEqual', '>', '<')}
_FUNCTIONS = (Kind.FUNCTION_DECL, Kind.CXX_METHOD, Kind.CONSTRUCTOR, Kind.DESTRUCTOR, Kind.CONVERSION_FUNCTION,
              Kind.FUNCTION_TEMPLATE)
_LITERALS = (Kind.INTEGER_LITERAL, Kind.FLOATING_LITERAL, Kind.CXX_BOOL_LITERAL_EXPR)
_NUMBERS = (TypeKind.BOOL, TypeKind.INT, TypeKind.UINT, TypeKind.LONG, TypeKind.ULONG, TypeKind.LONGLONG,
            TypeKind.ULONGLONG, TypeKind.SHORT, TypeKind.USHORT, TypeKind.UCHAR, TypeKind.SCHAR, TypeKind.DOUBLE,
            TypeKind.FLOAT)
_STATEMENTS = (Kind.CALL_EXPR, Kind.COMPOUND_ASSIGNMENT_OPERATOR, Kind.UNARY_OPERATOR, Kind.BINARY_OPERATOR,
               Kind.UNEXPOSED_EXPR, Kind.CONTINUE_STMT)
# Neither comparisons nor made of others.
_CONDITIONS = (Kind.CALL_EXPR, Kind.UNEXPOSED_EXPR, Kind.DECL_REF_EXPR, Kind.MEMBER_REF_EXPR)


def _is_number(cursor):
    return cursor.type.get_canonical().kind in _NUMBERS


def _is_real(cursor):
    return cursor.type.get_canonical().kind in (TypeKind.DOUBLE, TypeKind.FLOAT)


def _is_bool(cursor):
    return cursor.type.get_canonical().kind == TypeKind.BOOL


class _File:
    """A source with its breaks."""

    def __init__(self, path, name):
        self.name = name
        with open(path, 'rb') as file:
            self.text = file.read()
        self.edits = []
        self.seen = set()

    def of(self, cursor):
        return self.text[cursor.extent.start.offset:cursor.extent.end.offset].decode()

    def rewritten(self, header, count, without):
        """The source with its breaks but those in lines to be left out. @param count of the breaks of all files."""
        edits = [edit for edit in self.edits if edit.line not in without]
        inserts = collections.defaultdict(lambda: ([], []))
        replaced = {}
        for edit in edits:
            inserts[edit.start][1].append(edit.before)  # outer ones come first, as they are found first
            inserts[edit.end][0].insert(0, edit.after)
            for start, end, text in edit.inside:
                replaced[start] = (end, text)
        out, at = ['#define MUTANTS %d\n#include "%s"\n#line 1\n' % (count, header)], 0
        for place in sorted(set(inserts) | set(replaced)):
            out.append(self.text[at:place].decode())
            at = max(at, place)
            if place in inserts:
                out += inserts[place][0] + inserts[place][1]
            if place in replaced:
                at, text = replaced[place]
                out.append(text)
        return ''.join(out) + self.text[at:].decode()


class Finder:
    """Finds the breaks of sources in `folders`, below `root`."""

    def __init__(self, root, folders):
        self._root, self._folders = str(root) + '/', tuple(folders)
        self._index = cindex.Index.create()
        self._files = {}
        self.breaks = []

    def add(self, source, arguments):
        """Goes through a source and what it includes of the folders."""
        unit = self._index.parse(str(source), args=arguments)
        errors = [d for d in unit.diagnostics if d.severity >= cindex.Diagnostic.Error]
        if errors:
            raise RuntimeError('%s: %s' % (source, errors[0]))
        for cursor in unit.cursor.get_children():
            self._outside(cursor)

    def rewritten(self, header, without):
        """The sources by their names. @param without pairs of a name and a line whose breaks do not compile."""
        return {file.name: file.rewritten(header, len(self.breaks), {line for name, line in without if name == file.name})
                for file in self._files.values()}

    def _file(self, cursor):
        name = cursor.location.file.name if cursor.location.file else ''
        if not name.startswith(self._root) or not name[len(self._root):].startswith(self._folders):
            return None
        if name not in self._files:
            self._files[name] = _File(name, name[len(self._root):])
        return self._files[name]

    def _outside(self, cursor):
        """Looks for functions."""
        file = self._file(cursor)
        if not file:
            return
        if cursor.kind in _FUNCTIONS:
            if cursor.is_definition() and cursor.extent.start.offset not in file.seen:
                file.seen.add(cursor.extent.start.offset)
                for child in cursor.get_children():
                    if child.kind == Kind.COMPOUND_STMT or child.kind.is_expression():  # a member's in a constructor
                        self._inside(file, child)
            return
        if cursor.kind in (Kind.NAMESPACE, Kind.CLASS_DECL, Kind.STRUCT_DECL, Kind.CLASS_TEMPLATE,
                           Kind.UNEXPOSED_DECL, Kind.LINKAGE_SPEC):
            for child in cursor.get_children():
                self._outside(child)

    def _inside(self, file, cursor):
        if self._is_fixed(file, cursor):
            return
        children = list(cursor.get_children())
        if cursor.kind == Kind.COMPOUND_STMT:
            for child in children:
                self._statement(file, child)
        elif cursor.kind in (Kind.IF_STMT, Kind.WHILE_STMT, Kind.CONDITIONAL_OPERATOR) and children:
            self._condition(file, children[0])
        elif cursor.kind == Kind.RETURN_STMT and children and _is_bool(children[0]):
            self._condition(file, children[0])
        self._expression(file, cursor, children)
        for i, child in enumerate(children):
            if cursor.kind == Kind.CASE_STMT and i == 0:
                continue
            self._inside(file, child)

    @staticmethod
    def _is_fixed(file, cursor):
        """Whether the compiler computes it."""
        return cursor.kind == Kind.STATIC_ASSERT or (
            cursor.kind == Kind.VAR_DECL and re.match(r'(static\s+)?constexpr\b', file.of(cursor)) is not None)

    def _break(self, file, cursor, texts, before, after, inside=()):
        """Adds the breaks of an expression, with %d in `before` for the number of the first."""
        start, end = cursor.extent.start, cursor.extent.end
        file.edits.append(_Edit(start.offset, end.offset, before.replace('%d', str(len(self.breaks))), after, inside, start.line))
        for text in texts:
            self.breaks.append(Break(len(self.breaks), file.name, start.line, start.column,
                                     '%s: %s' % (' '.join(file.of(cursor).split())[:100], text)))

    def _statement(self, file, cursor):
        """A statement that is left out."""
        if cursor.kind in _STATEMENTS:
            self._break(file, cursor, ['left out'], 'if (mutants::at(%d)) {} else ', '')

    def _condition(self, file, cursor):
        if cursor.kind in _CONDITIONS:
            self._break(file, cursor, ['the opposite'], '(mutants::at(%d) != static_cast<bool>(', '))')

    def _expression(self, file, cursor, children):
        if cursor.kind == Kind.BINARY_OPERATOR and len(children) == 2:
            self._binary(file, cursor, children)
        elif cursor.kind == Kind.UNARY_OPERATOR and children:
            self._unary(file, cursor, children[0])
        elif cursor.kind == Kind.CALL_EXPR and cursor.spelling in ('min', 'max') and len(children) == 3:
            text = file.of(children[0])
            if text in ('std::min', 'std::max'):
                name = children[0].extent
                other = 'max' if text == 'std::min' else 'min'
                bracket = file.text.index(b'(', name.end.offset)
                inside = [(name.start.offset, bracket + 1, 'mutants::%s(%d, ' % (text[5:], len(self.breaks)))]
                self._break(file, cursor, [other], '', '', inside)
        elif cursor.kind in _LITERALS or self._is_constant(cursor):
            around = file.text[cursor.extent.start.offset - 1:cursor.extent.start.offset]
            if around != b'<' and _is_number(cursor):
                self._break(file, cursor, ['not' if _is_bool(cursor) else 'another'], 'mutants::value(%d, ', ')')

    @staticmethod
    def _is_constant(cursor):
        """Whether it names a constant of the program."""
        if cursor.kind != Kind.DECL_REF_EXPR or not re.match(r'k[A-Z]', cursor.spelling) or not _is_number(cursor):
            return False
        return cursor.referenced is not None and cursor.referenced.kind == Kind.VAR_DECL

    def _binary(self, file, cursor, children):
        left, right = (child.extent for child in children)
        start, end = left.end.offset, right.start.offset
        operator = file.text[start:end].decode().strip()
        if operator in _ARITHMETIC and all(_is_number(child) for child in children):
            name, other = _ARITHMETIC[operator]
            self._break(file, cursor, ['%s for %s' % (other, operator)], 'mutants::' + name + '(%d, ', ')',
                        [(start, end, ', ')])
        elif operator in _ORDERS and all(_is_number(child) and not _is_real(child) for child in children):
            name, *others = _ORDERS[operator]
            self._break(file, cursor, ['%s for %s' % (other, operator) for other in others],
                        'mutants::' + name + '(%d, ', ')', [(start, end, ', ')])
        elif operator in ('==', '!=', *_ORDERS):  # of real numbers, hardly ever are two equal
            self._break(file, cursor, ['the opposite'], '(mutants::at(%d) != (', '))')
        elif operator in ('&&', '||'):
            always, before = ('true', '(mutants::at(%d) || (') if operator == '&&' else ('false', '(!mutants::at(%d) && (')
            for child in children:
                self._break(file, child, ['always ' + always], before, '))')

    def _unary(self, file, cursor, operand):
        text = file.text[cursor.extent.start.offset:operand.extent.start.offset].decode().strip()
        if text == '-' and _is_number(operand):
            start = cursor.extent.start.offset
            self._break(file, cursor, ['without -'], 'mutants::negative(%d, ', ')', [(start, operand.extent.start.offset, '')])
        elif text == '!':
            self._break(file, cursor, ['without !'], '(mutants::at(%d) != (', '))')
