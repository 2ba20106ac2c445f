# SPDX-License-Identifier: MIT
"""What the public headers declare: structs with their fields, enumerations and functions, and the /// text of each.

Reads the form that clang-format gives the headers; it is no general parser of C++.
"""
import dataclasses
import keyword
import re


@dataclasses.dataclass
class Field:
    name: str
    type: str
    default: str
    doc: str

    @property
    def python_name(self):
        """Keywords of Python end with _."""
        return self.name + "_" if keyword.iskeyword(self.name) else self.name


@dataclasses.dataclass
class Struct:
    name: str
    doc: str
    base: str
    fields: list
    header: str


@dataclasses.dataclass
class Enum:
    name: str
    doc: str
    values: list  # (name, number, doc)
    header: str


@dataclasses.dataclass
class Function:
    name: str
    doc: str
    header: str


@dataclasses.dataclass
class Header:
    structs: list
    enums: list
    functions: list
    aliases: dict


_TOKEN = re.compile(r'//[^\n]*|"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])\'|[\s\S]')


def _end_of(text, begin, ends):
    """Index of the first of `ends` from `begin` on that is in no bracket, string or comment."""
    depth = 0
    for token in _TOKEN.finditer(text, begin):
        found = token.group()
        if depth == 0 and found in ends:
            return token.start()
        if found in "([{":
            depth += 1
        elif found in ")]}":
            depth -= 1
    return len(text)


def _without_comments(text):
    return "".join(t.group() for t in _TOKEN.finditer(text) if not t.group().startswith("//"))


def _statements(text):
    """(doc, head, body, trailing doc) of each declaration; body is None without braces."""
    position, doc = 0, []
    while position < len(text):
        blank = re.match(r"\s+", text[position:])
        if blank:
            if blank.group().count("\n") > 1:
                doc = []
            position += blank.end()
            continue
        line_end = text.find("\n", position)
        line_end = len(text) if line_end < 0 else line_end
        line = text[position:line_end]
        if line.startswith("///"):
            doc.append(line[3:].removeprefix("<").removeprefix(" "))
            position = line_end
            continue
        if line.startswith("//") or line.startswith("#"):
            position = line_end
            continue
        label = re.match(r"(public|private|protected):", line)
        if label:
            position += label.end()
            continue
        end = _end_of(text, position, ";{}")
        head, body = text[position:end], None
        if end < len(text) and text[end] == "{":
            close = _end_of(text, end + 1, "}")
            body = text[end + 1 : close]
            is_type = re.match(r"(template\b.*\n)?\s*(struct|enum|class|union)\b", head)
            next_text = re.match(r"\s*(.?)", text[close + 1 :]).group(1)
            is_function = "(" in head and not is_type and next_text != ";"
            if head.startswith("namespace") or is_function:
                position = close + 1
            else:
                position = _end_of(text, close + 1, ";") + 1
                if not is_type and next_text != ";":
                    head, body = text[end - len(head) : position - 1], None
                elif not is_type:
                    head = head + "{" + body + "}"
                    body = None
        else:
            position = end + 1
        trailing = []
        for match in re.finditer(r"[ \t]*///<[ ]?([^\n]*)(\n|$)", text[position:]):
            expected = sum(len(part) for part in trailing) if trailing else 0
            if match.start() != expected:
                break
            trailing.append(match.group())
        position += sum(len(part) for part in trailing)
        trailing_doc = [re.sub(r"^\s*///<\s?", "", part).strip() for part in trailing]
        yield doc, head.strip(), body, trailing_doc
        doc = []


def _split(text, separator=","):
    parts, depth, begin = [], 0, 0
    for token in _TOKEN.finditer(text):
        found = token.group()
        if found in "([{<":
            depth += 1
        elif found in ")]}>":
            depth -= 1
        elif found == separator and depth == 0:
            parts.append(text[begin : token.start()])
            begin = token.end()
    return parts + [text[begin:]]


def _declared(part):
    """(what stands before the initialiser, the initialiser)."""
    depth = 0
    for token in _TOKEN.finditer(part):
        found = token.group()
        if depth == 0 and found in "={":
            return part[: token.start()].strip(), part[token.start() :].strip("= \n")
        if found in "<([":
            depth += 1
        elif found in ">)]":
            depth -= 1
    return part.strip(), ""


def _has_call(text):
    """Whether there is a parenthesis outside of <>."""
    depth = 0
    for found in text:
        if found == "<":
            depth += 1
        elif found == ">":
            depth -= 1
        elif found == "(" and depth == 0:
            return True
    return False


_NO_FIELD = re.compile(
    r"(friend|static|using|struct|class|enum|union|explicit|constexpr|template|virtual|operator|typedef|inline)\b"
)


def _fields(body):
    fields = []
    for doc, head, inner, trailing in _statements(body):
        head = re.sub(r"\s+", " ", _without_comments(head)).strip()
        if inner is not None or not head or _NO_FIELD.match(head):
            continue
        first, *others = _split(head)
        declared, default = _declared(first)
        if _has_call(declared) or "operator" in declared:
            continue
        match = re.match(r"(.*[\s&*>])(\w+(?:\[\w*\])?)$", declared, re.S)
        if not match:
            continue
        base = re.sub(r"\s+", " ", match.group(1)).strip()
        text = " ".join(doc + trailing).strip()
        for name, value in [(match.group(2), default)] + [_declared(other) for other in others]:
            array = re.match(r"(\w+)\[(\w*)\]", name)
            kind = f"{base}[{array.group(2)}]" if array else base
            fields.append(Field(array.group(1) if array else name, kind, value, text))
    return fields


def _enum_values(body):
    docs, before, last = {}, [], None
    for line in body.splitlines():
        code, _, comment = line.partition("//")
        names = re.findall(r"(?:^|,)\s*(\w+)", code)
        text = re.sub(r"^/<?\s?", "", comment).strip()
        if comment and not comment.startswith("/<") and not names:
            before.append(text)
            continue
        for name in names:
            docs[name] = " ".join(before)
            before, last = [], name
        if comment.startswith("/<") and last:
            docs[last] = (docs[last] + " " + text).strip()
    values, number = [], -1
    for part in _split(_without_comments(body)):
        name, _, value = part.strip().partition("=")
        if name:
            number = int(value.strip(), 0) if value.strip() else number + 1
            values.append((name.strip(), number, docs.get(name.strip(), "")))
    return values


def read_header(path, shown):
    """The declarations of namespace papilla in a header; `shown` names it."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    found = Header([], [], [], {})
    begin = re.search(r"^namespace papilla \{$", text, re.M)
    while begin:
        end = _end_of(text, begin.end(), "}")
        _read_namespace(text[begin.end() : end], shown, found)
        begin = re.compile(r"^namespace papilla \{$", re.M).search(text, end)
    return found


def _read_namespace(text, shown, found):
    for doc, head, body, _ in _statements(text):
        flat = re.sub(r"\s+", " ", _without_comments(head))
        if flat.startswith("template") or flat.startswith("namespace"):
            continue
        if match := re.match(r"enum class (\w+)", flat):
            if body is not None:
                found.enums.append(Enum(match.group(1), "\n".join(doc), _enum_values(body), shown))
        elif match := re.match(r"struct (\w+)(?: : (?:public )?(\w+))?", flat):
            if body is not None:
                found.structs.append(
                    Struct(match.group(1), "\n".join(doc), match.group(2) or "", _fields(body), shown)
                )
        elif match := re.match(r"using (\w+) = (.*)", flat):
            found.aliases[match.group(1)] = match.group(2).rstrip(";")
        elif not flat.startswith("class ") and (match := re.search(r"(\w+)\s*\(", flat)):
            if doc:
                found.functions.append(Function(match.group(1), "\n".join(doc), shown))


def python_text(doc):
    """/// text as Python shows it: the marks of doxygen as words, members with a dot."""
    text = doc
    text = re.sub(r"(\w)::(\w)", r"\1.\2", text)
    text = re.sub(r"@param\s+(\w+)\s+", r"\1: ", text)
    text = re.sub(r"@throws\s+", "Raises ", text)
    text = re.sub(r"@returns?\s+", "Returns ", text)
    text = re.sub(r"@pre\s+", "Precondition: ", text)
    return text.strip()
