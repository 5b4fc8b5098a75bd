"""Finds places for single faults in a C++ source file, with the syntax tree that libclang makes of it."""
import ctypes.util
import dataclasses
import glob
import hashlib
import re

import rules


@dataclasses.dataclass
class Edit:
    """Text put before and after the bytes `start` to `end` of the file; "@" stands for "this fault is switched on"."""
    start: int
    end: int
    before: str
    after: str


@dataclasses.dataclass
class Fault:
    file: str      # relative to the root of the sources
    line: int
    function: str
    rule: str
    was: str       # source text on one line
    becomes: str
    edits: list
    ordinal: int = 0  # among faults of this file, function, rule and text

    def name(self):
        """What stays the same when lines above it change."""
        count = f" #{self.ordinal + 1}" if self.ordinal else ""
        return f"{self.file} | {self.function} | {self.rule}{count} | {self.was} => {self.becomes}"

    def rank(self, seed):
        return hashlib.sha256(f"{seed} {self.name()}".encode()).hexdigest()


def load_clang():
    """The module clang.cindex, or None where libclang and its Python bindings (16 or later) are not installed."""
    try:
        import clang.cindex as cindex
    except ImportError:
        return None
    libraries = glob.glob("/usr/lib/llvm-*/lib/libclang-*.so.1") + [ctypes.util.find_library("clang") or ""]
    libraries = [l for l in libraries if int((re.search(r"llvm-(\d+)", l) or [0, 0])[1]) >= 16] or libraries
    try:
        if not cindex.Config.loaded:
            cindex.Config.set_library_file(sorted(libraries)[0])
        cindex.Index.create()
    except Exception:
        return None
    # The bindings do not know the newest kinds of nodes (concepts...) and would stop at them.
    for kinds, other in ((cindex.CursorKind, cindex.CursorKind.UNEXPOSED_DECL), (cindex.TypeKind, cindex.TypeKind.UNEXPOSED)):
        kinds.from_id = staticmethod(lambda number, old=kinds.from_id, other=other: known_kind(old, number, other))
    return cindex


def known_kind(from_id, number, other):
    try:
        return from_id(number)
    except ValueError:
        return other


def one_line(text):
    return re.sub(r"\s+", " ", text).strip()


class Source:
    """A parsed file: its bytes and the functions of its tree."""

    def __init__(self, cindex, path, flags):
        self.k = cindex.CursorKind
        self.data = open(path, "rb").read()
        self.path = path
        index = cindex.Index.create()
        self.unit = index.parse(path, args=flags, options=cindex.TranslationUnit.PARSE_DETAILED_PROCESSING_RECORD)
        # An error (a header that the build includes by itself) leaves a tree with holes; a missing header is the end.
        fatal = [d for d in self.unit.diagnostics if d.severity >= cindex.Diagnostic.Fatal]
        if fatal:
            raise RuntimeError(f"{path}: {fatal[0]}")
        self.macros = []
        self.top = []
        for cursor in self.unit.cursor.get_children():
            place = cursor.location.file
            if not place or place.name != path:
                continue
            if cursor.kind == self.k.MACRO_INSTANTIATION:
                self.macros.append((cursor.extent.start.offset, cursor.extent.end.offset))
            elif not cursor.kind.is_preprocessing():
                self.top.append(cursor)

    def span(self, cursor):
        return cursor.extent.start.offset, cursor.extent.end.offset

    def text(self, start, end):
        return self.data[start:end].decode()

    def plain(self, start, end):
        """True for text that can be written twice: not part of a macro's expansion, no comment, no directive."""
        if not 0 <= start < end <= len(self.data):
            return False
        if any(a <= start < b or a < end <= b for a, b in self.macros):
            return False
        text = self.data[start:end]
        return b"//" not in text and b"/*" not in text and b"\n#" not in text


def faults_of(cindex, path, name, flags):
    """All faults of the file `path`, called `name` in reports, in the order of the text."""
    source = Source(cindex, path, flags)
    found = []
    for function, cursor, body in functions(source):
        for rule, start, end, was, becomes, edits in rules.faults_in(source, cursor, body):
            if all(source.plain(e.start, e.end) or e.start == e.end for e in edits):
                line = source.data.count(b"\n", 0, start) + 1
                found.append(Fault(name, line, function, rule, one_line(was), one_line(becomes), edits))
    found.sort(key=lambda f: (f.edits[0].start, f.rule, f.becomes))
    seen = {}
    for fault in found:
        key = fault.name()
        fault.ordinal = seen.get(key, 0)
        seen[key] = fault.ordinal + 1
    return found


def functions(source):
    """(name, cursor, body) of each function that is defined in the file and runs at run time."""
    k = source.k
    kinds = {k.FUNCTION_DECL, k.CXX_METHOD, k.CONSTRUCTOR, k.DESTRUCTOR, k.CONVERSION_FUNCTION, k.FUNCTION_TEMPLATE}
    out = []

    def visit(cursor, outer):
        if cursor.kind in kinds:
            children = list(cursor.get_children())
            body = children[-1] if children and children[-1].kind == k.COMPOUND_STMT else None
            head = source.text(cursor.extent.start.offset, body.extent.start.offset) if body else ""
            if body and not re.search(r"\b(constexpr|consteval)\b", head):
                parent = cursor.semantic_parent
                owner = parent.spelling + "::" if parent and parent.kind in (k.CLASS_DECL, k.STRUCT_DECL) else ""
                out.append((owner + cursor.spelling, cursor, body))
        elif cursor.kind in (k.NAMESPACE, k.CLASS_DECL, k.STRUCT_DECL, k.UNEXPOSED_DECL, k.LINKAGE_SPEC, k.CLASS_TEMPLATE):
            for child in cursor.get_children():
                visit(child, cursor)

    for cursor in source.top:
        visit(cursor, None)
    return out
