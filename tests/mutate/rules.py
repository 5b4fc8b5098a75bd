"""The rules by which faults are made. Each looks at one node of the syntax tree and yields
(rule, start, end, text before, text after, edits); the new text is guarded by a switch, so that one build holds all."""
import re

PAIRS = [("x", "y"), ("y", "z"), ("z", "x"), ("min", "max"), ("first", "second"), ("lo", "hi"), ("from", "to"),
         ("width", "height"), ("rows", "columns"), ("left", "right"), ("top", "bottom"), ("near", "far"), ("a", "b"),
         ("begin", "end"), ("lower", "upper"), ("source", "target"), ("name", "unit"), ("r", "g"), ("g", "b")]
OTHER_MEMBER = {}
for one, two in PAIRS:
    OTHER_MEMBER.setdefault(one, two)
    OTHER_MEMBER.setdefault(two, one)
OTHER_FUNCTION = {"min": "max", "max": "min", "floor": "ceil", "ceil": "floor", "sin": "cos", "cos": "sin",
                  "lower_bound": "upper_bound", "upper_bound": "lower_bound", "front": "back", "back": "front",
                  "any_of": "all_of", "all_of": "any_of"}
BOUNDS = {"<": "<=", "<=": "<", ">": ">=", ">=": ">"}
EQUALS = {"==": "!=", "!=": "=="}
LOGIC = {"&&": "||", "||": "&&"}


def one_line(text):
    return re.sub(r"\s*\n\s*", " ", text)


def edit(start, end, before, after=""):
    from faults import Edit
    return Edit(start, end, before, after)


def instead(rule, source, start, end, new):
    """The expression from `start` to `end`, or `new` where the fault is on."""
    new = one_line(new)
    return rule, start, end, source.text(start, end), new, [edit(start, end, f"(@ ? ({new}) : (", "))")]


def instead_bool(rule, source, start, end, new):
    """The same for a condition, which may be a pointer or an optional."""
    return (rule, start, end, source.text(start, end), new,
            [edit(start, end, f"(@ ? ({new}) : static_cast<bool>(", "))")])


def faults_in(source, function, body):
    """Walks a function's body and applies every rule to every node."""
    k = source.k
    yield from nothing_done(source, function, body)

    def walk(node, parent, result_known=True):
        kind = node.kind
        if kind == k.LAMBDA_EXPR:
            result_known = "->" in source.text(*source.span(node)).split("{")[0]
        if kind == k.STATIC_ASSERT or (kind == k.VAR_DECL and is_constant(source, node)):
            return
        children = list(node.get_children())
        start, end = source.span(node)
        if kind in (k.BINARY_OPERATOR, k.COMPOUND_ASSIGNMENT_OPERATOR) and len(children) == 2:
            yield from binary(source, node, *children)
        elif kind == k.UNARY_OPERATOR and len(children) == 1:
            yield from unary(source, start, end, children[0])
        elif kind == k.CONDITIONAL_OPERATOR and len(children) == 3:
            yield from negated("swap-branches", source, children[0])
        elif kind == k.CALL_EXPR:
            yield from call(source, node, parent)
        elif kind == k.MEMBER_REF_EXPR:
            yield from member(source, node, parent)
        elif kind in (k.INTEGER_LITERAL, k.FLOATING_LITERAL, k.CXX_BOOL_LITERAL_EXPR):
            yield from literal(source, node, parent)
        elif kind == k.RETURN_STMT and children and result_known:
            yield from early_return(source, start, end, children[0])
        if kind in (k.IF_STMT, k.WHILE_STMT) and children:
            if re.match(r"if\s+constexpr", source.text(start, start + 20)):
                children = children[1:]
            else:
                yield from condition(source, node, children)
        if kind == k.CASE_STMT:
            children = children[1:]
        if kind == k.FOR_STMT:  # never the step: a loop without end costs a time limit and teaches nothing
            children = [c for c in children if not is_step(source, node, c)]
        for child in children:
            yield from walk(child, node, result_known)

    yield from walk(body, None)


def is_constant(source, node):
    start, end = source.span(node)
    return re.search(r"\bconstexpr\b", source.text(start, end).split("=")[0]) is not None


def is_step(source, loop, child):
    start = loop.extent.start.offset
    return source.text(start, child.extent.start.offset).count(";") >= 2 and child.kind in (
        source.k.UNARY_OPERATOR, source.k.COMPOUND_ASSIGNMENT_OPERATOR, source.k.BINARY_OPERATOR, source.k.CALL_EXPR)


def spelled(kind_or_type):
    return kind_or_type.get_canonical().spelling


def is_number(kind):
    name = spelled(kind).replace("const ", "").replace("&", "").strip()
    return name in ("int", "unsigned int", "long", "unsigned long", "float", "double", "unsigned char", "signed char",
                    "short", "unsigned short", "long long", "unsigned long long", "char")


def is_vector(kind):
    return re.match(r"(const )?(glm::(vec|mat)<|ImVec[24])", spelled(kind)) is not None


def is_real(kind):
    return spelled(kind).replace("const ", "").strip() in ("float", "double")


def binary(source, node, left, right):
    (a, b), (c, d) = source.span(left), source.span(right)
    if b > c:
        return
    yield from operation(source, a, b, c, d, left.type, right.type, node.type)


def operation(source, a, b, c, d, left, right, result):
    """Faults of "left op right", whose operands are the bytes a to b and c to d."""
    if not (source.plain(a, b) and source.plain(c, d)) or b > c:
        return
    op, one, two = source.text(b, c).strip(), source.text(a, b), source.text(c, d)
    if op in BOUNDS:
        yield instead("bound", source, a, d, f"{one} {BOUNDS[op]} {two}")
    if op in EQUALS:
        yield instead("equality", source, a, d, f"{one} {EQUALS[op]} {two}")
    if op in LOGIC:
        yield instead("and-or", source, a, d, f"({one}) {LOGIC[op]} ({two})")
    numbers = (is_number(left) or is_vector(left)) and (is_number(right) or is_vector(right))
    if op in "-/" and op and numbers:
        yield instead("swap-operands", source, a, d, f"({two}) {op} ({one})")
    if op == "+" and "basic_string" in spelled(result):
        yield instead("swap-operands", source, a, d, f"std::string({two}) + ({one})")
    if op in ("+", "-") and numbers:
        yield instead("plus-minus", source, a, d, f"{one} {'-' if op == '+' else '+'} ({two})")
    if op == "*" and numbers and is_real(right):
        yield instead("times-over", source, a, d, f"({one}) / ({two})")
    if op in ("+=", "-=") and numbers:
        yield instead("plus-minus", source, a, d, f"{one} {'-=' if op == '+=' else '+='} {two}")


def unary(source, start, end, operand):
    a, b = source.span(operand)
    op = source.text(start, a).strip()
    if op == "!":
        yield instead("drop-not", source, start, end, f"static_cast<bool>({source.text(a, b)})")
    if op == "-":
        yield instead("drop-minus", source, start, end, source.text(a, b))


def negated(rule, source, expression):
    start, end = source.span(expression)
    if source.plain(start, end):
        yield instead_bool(rule, source, start, end, f"!({one_line(source.text(start, end))})")


def condition(source, node, children):
    """An `if` that is always or never taken; a loop that is never entered."""
    k = source.k
    test = children[0]
    if test.kind in (k.DECL_STMT, k.VAR_DECL) or len(children) < 2 or not test.kind.is_expression():
        return
    start, end = source.span(test)
    if not source.plain(start, end) or source.text(node.extent.start.offset, start).count(";"):
        return
    choices = ("false",) if node.kind == k.WHILE_STMT else ("true", "false")
    for choice in choices:
        yield instead_bool("condition", source, start, end, choice)


def call(source, node, parent):
    k = source.k
    start, end = source.span(node)
    arguments = [a for a in node.get_arguments() if a is not None]
    operator = re.match(r"operator(\S+)$", node.spelling or "")
    if operator and len(arguments) == 2 and source.span(arguments[0])[0] == start:
        (a, b), (c, d) = source.span(arguments[0]), source.span(arguments[1])
        yield from operation(source, a, b, c, d, arguments[0].type, arguments[1].type, node.type)
        return
    if operator or not source.text(start, end).endswith(")"):
        return  # conversions and constructors that are not written out
    if parent is not None and is_statement(source, node, parent):
        yield ("drop-call", start, end, source.text(start, end), "", [edit(start, end, "(@ ? (void)0 : (void)(", "))")])
    yield from other_function(source, node, start, end)
    spans = [source.span(a) for a in arguments]
    if not all(source.plain(*s) and start <= s[0] and s[1] <= end for s in spans):
        return
    for argument, (a, b) in zip(arguments, spans):
        kind = spelled(argument.type)
        text = source.text(a, b)
        plain_value = re.fullmatch(r"-?[\d.][\w.]*|true|false|\{.*|\".*", text, re.DOTALL)
        if (is_number(argument.type) or is_vector(argument.type) or "bool" == kind.replace("const ", "") or
                kind.replace("const ", "").startswith("std::basic_string<") or is_enum(argument.type)) and not plain_value:
            yield instead("ignore-argument", source, a, b, f"std::decay_t<decltype({text})>{{}}")
    for i in range(len(arguments) - 1):
        (a, b), (c, d) = spans[i], spans[i + 1]
        one, two = source.text(a, b), source.text(c, d)
        if one != two and b <= c and spelled(arguments[i].type) == spelled(arguments[i + 1].type):
            if node.spelling in ("min", "max", "hypot", "swap", "dot") or "(" in one + two:
                continue
            edits = [edit(a, b, f"(@ ? ({two}) : (", "))"), edit(c, d, f"(@ ? ({one}) : (", "))")]
            yield "swap-arguments", a, d, f"{node.spelling}({one}, {two})", f"{node.spelling}({two}, {one})", edits


def is_enum(kind):
    from clang.cindex import TypeKind
    return kind.get_canonical().kind == TypeKind.ENUM


def is_statement(source, node, parent):
    """True for a call whose value nobody takes."""
    k = source.k
    after = source.data[node.extent.end.offset:node.extent.end.offset + 1]
    before = source.data[:node.extent.start.offset].rstrip()[-1:]
    holders = (k.COMPOUND_STMT, k.IF_STMT, k.FOR_STMT, k.CXX_FOR_RANGE_STMT, k.CASE_STMT, k.DEFAULT_STMT,
               k.UNEXPOSED_EXPR, k.WHILE_STMT)
    return parent.kind in holders and after == b";" and (before in b"{};):" or source.data[
        :node.extent.start.offset].rstrip().endswith(b"else"))


def other_function(source, node, start, end):
    other = OTHER_FUNCTION.get(node.spelling)
    text = source.text(start, end)
    place = re.search(rf"\b{re.escape(node.spelling)}(?=(<\w+>)?\()", text) if other else None
    if place and source.plain(start, end):
        yield instead("other-function", source, start, end, text[:place.start()] + other + text[place.end():])


def member(source, node, parent):
    """p.x -> p.y, range.lo -> range.hi: another field of the same struct and type."""
    k = source.k
    field = node.referenced
    if field is None or field.kind != k.FIELD_DECL:
        return
    start, end = source.span(node)
    name = node.spelling
    text = source.text(start, end)
    if not text.endswith(name) or not source.plain(start, end):
        return
    names = [f.spelling for f in field.semantic_parent.get_children()
             if f.kind == k.FIELD_DECL and spelled(f.type) == spelled(field.type) and f.spelling != name]
    other = OTHER_MEMBER.get(name)
    owner = spelled(field.semantic_parent.type)
    if other and (other in names or "glm::vec" in owner or (owner == "" and name in "xyz")):
        if name == "y" and "vec<2" in base_type(node):
            other = "x"
        yield instead("swap-member", source, start, end, text[:-len(name)] + other)
    elif names and len(names) <= 12:
        names.sort()
        yield instead("swap-member", source, start, end, text[:-len(name)] + names[len(name) % len(names)])


def base_type(node):
    for child in node.get_children():
        return spelled(child.type)
    return ""


def literal(source, node, parent):
    k = source.k
    start, end = source.span(node)
    if not source.plain(start, end):
        return
    text = source.text(start, end)
    before, after = source.data[start - 1:start], source.data[end:end + 1]
    if before in b"<[" and after in b">,]" and parent.kind in (k.VAR_DECL, k.DECL_REF_EXPR, k.MEMBER_REF_EXPR):
        return
    if after == b">" or (before == b"<" and after == b","):
        return  # an argument of a template
    if node.kind == k.CXX_BOOL_LITERAL_EXPR:
        yield instead("true-false", source, start, end, "false" if text == "true" else "true")
    elif node.kind == k.INTEGER_LITERAL and re.fullmatch(r"\d+[uUlL]*", text):
        value, suffix = re.fullmatch(r"(\d+)(\w*)", text).groups()
        if value in ("0", "1"):
            yield instead("zero-one", source, start, end, ("1" if value == "0" else "0") + suffix)
        else:
            yield instead("off-by-one", source, start, end, str(int(value) + 1) + suffix)
    elif node.kind == k.FLOATING_LITERAL and re.fullmatch(r"[\d.e+-]+f?", text):
        suffix = "f" if text.endswith("f") else ""
        value = float(text.rstrip("f"))
        yield instead("number", source, start, end, repr(1.0 if value == 0 else value * 2) + suffix)


def early_return(source, start, end, value):
    a, b = source.span(value)
    if not source.plain(start, end) or source.data[end:end + 1] != b";" or b > end:
        return
    text = source.text(a, b)
    if text in ("{}", "false", "nullptr", "0", "std::nullopt", "true", "-1") or "[&]" in text or "[=]" in text:
        return
    yield ("return-empty", start, end + 1, source.text(start, end), "return {}",
           [edit(start, end + 1, "{ if (@) return {}; ", " }")])


def nothing_done(source, function, body):
    """A function without a result that returns at once."""
    start, end = source.span(body)
    if function.result_type.spelling != "void":
        return
    first = source.text(start + 1, end).strip().split("\n")[0]
    if not first.startswith(("}", "#")):
        yield "return-early", start + 1, end, first, "return;", [edit(start + 1, start + 1, " if (@) return;")]
