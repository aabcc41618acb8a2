"""Valid files spoilt as people, programs and attackers spoil them."""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Sequence

Data = bytes

_WORD = re.compile(rb"[-+.\w]+")
_NUMBER = re.compile(rb"[-+]?\d[\d.]*(?:[eE][-+]?\d+)?")
_LINE_ENDS = (b"\r\n", b"\r", b"\n\n", b"\n\r", "\u2028".encode(), b"\x0b", b"\x85")
_BOMS = (b"\xef\xbb\xbf", b"\xff\xfe", b"\xfe\xff", b"\xff\xfe\0\0", b"\0\0\xfe\xff", b"+/v8")

NUMBERS = [
    *(b"nan", b".nan", b"NaN", b"inf", b"-.inf", b"Infinity", b"-Infinity", b"1e308", b"-1e308", b"1e300"),
    *(b"1e-300", b"5e-324", b"1e999", b"1e9", b"-1e9", b"1e6", b"9" * 20, b"9" * 400, b"9" * 4400, b"-9223372036854775808"),
    *(b"0x10", b"0x" + b"e" * 400, b"0x1p+1023", b"0x1.8p-1074", b"-0x1p+0", b"0x0p+0", b"0b1", b"0o7", b"1_000"),
    *(b"0", b"-0", b"-1", b"1", b"2", b"3", b"1.", b".5", b"+1", b"1e", b"1e+", b"--1", b"1,5", b"07:32:00", b"1979-05-27"),
    *("\u0661".encode(), "\uff11".encode(), b"0.1" + b"0" * 40 + b"1", b"1" * 18 + b".5", b"1E400", b"-1E-400"),
]  # fmt: skip
VALUES = [
    *(b"", b'""', b"''", b"[]", b"{}", b"null", b"~", b"true", b"false", b"True", b"yes", b'"x"', b"[[]]", b"[{}]", b"{a: 1}"),
    *(b'{"a": 1}', b"{a = 1}", b"[1]", b"[1, 2]", b"[[1, 2], [3]]", b'"1"', b"'1'", b"[nan]", b"- 1", b"[true]", b'["a"]'),
    *(b'"rad"', b'"deg"', b'"mm"', b'"m"', b'"3-5-3"', b'"4-3-4"', b'"every-motion"', b'"b-spline-3"', b'"velocity"'),
    *(b"../../etc/passwd", b"/etc/passwd", b"/dev/zero", b"file:///etc/passwd", b"http://127.0.0.1/x", b".", b"..", b"/", b"|id"),
    *(b"arm.urdf", b"moveit.yaml", b"table.csv", b"nowhere.toml", b'"\\u0000"', b"a\\u0000b", b"a\\nb", b"x" * 300, b"x" * 5000),
]  # fmt: skip
MARKS = [
    *(b"[", b"]", b"{", b"}", b"(", b")", b"<", b">", b"/>", b"/", b",", b";", b":", b"=", b".", b"#", b"'", b'"', b'"""', b"'''"),
    *(b"\\", b"|", b">\n", b"|\n", b"? ", b"- ", b"---\n", b"...\n", b"%YAML 1.1\n", b"%TAG ! tag:x,2000:\n", b"&a ", b"*a", b"<<: ", b"<<: *a"),
    *(b"!!python/object:os.system ", b"!!python/object/apply:os.system ['id'] ", b"!degrees ", b"!!binary ", b"!!float ", b"!x "),
    *(b"<!DOCTYPE a>", b"<!ENTITY a 'b'>", b"<!DOCTYPE a [<!ENTITY b SYSTEM 'file:///etc/passwd'>]>", b"&b;", b"&amp;", b"&#0;", b"&#x10ffff;"),
    *(b"<![CDATA[", b"]]>", b"<?x?>", b"<?xml version='1.1'?>", b"<!--", b"-->", b"xacro:", b"${x}", b"$(find x)", b"<xi:include href='/etc/passwd'/>"),
    *(b"<joint name='j1'/>", b"<link name='z'/>", b"<mimic joint='j2'/>", b"<limit/>", b"<axis xyz='0 0 0'/>", b"xmlns:a='b' "),
    *(b"\0", b"\t", b" ", b"\n", b"\r", b"\n\n", b"\x1b[2J", b"\x7f", b"\xff\xfe", b"\xef\xbb\xbf", b"\xc3", b"\xed\xa0\x80", b"\xf4\x90\x80\x80"),
    *("\u2028".encode(), "\u00a0".encode(), "\u202e".encode(), "\u200b".encode(), "\U0001f916".encode(), "e\u0301".encode(), "\ufeff".encode()),
    *(b"[limits]\n", b"[[pose]]\n", b"[a.b.c]\n", b"a.b.c = 1\n", b"\\ud800", b"\\U00110000", b"__proto__", b"0", b"= ", b" = "),
]  # fmt: skip
TOKENS = [*NUMBERS, *VALUES, *MARKS]


class Mutator:
    """Spoils files of one reader.

    ``words`` of its seeds are put where others were, so that keys and values of the format meet in new ways.
    ``large``: how many bytes one input may be blown up to; rare, because it is slow.
    """

    def __init__(self, rng: random.Random, seeds: Sequence[Data], *, large: int = 300_000) -> None:
        self.rng = rng
        self.seeds = list(seeds)
        self.words = sorted({word for seed in seeds for word in _WORD.findall(seed)}) or [b"x"]
        self.large = large
        usual = (_number, _number, _word, _word, _value, _token, _insert, _cut, _repeat, _flip)
        lines = (_copy_line, _drop_line, _swap_lines, _splice)
        rare = (_truncate, _line_ends, _bom, _nest, _shuffle)
        self.ways: list[Callable[[Mutator, Data], Data]] = [*usual * 3, *lines * 3, *rare]

    def mutated(self, data: Data) -> Data:
        """The file with one fault or a few."""
        rng = self.rng
        for _ in range(1 + int(rng.expovariate(0.7))):
            data = self.ways[int(rng.random() * len(self.ways))](self, data)
        if rng.random() < 0.0005:
            data = _blow_up(self, data)
        return data[: self.large]

    def token(self) -> Data:
        """A hostile piece of text, or a word of the format."""
        among = TOKENS if self.rng.random() < 0.6 else self.words
        return among[int(self.rng.random() * len(among))]

    def spot(self, data: Data) -> int:
        """A place in the file."""
        return int(self.rng.random() * (len(data) + 1))


def _found(m: Mutator, pattern: re.Pattern[bytes], data: Data) -> re.Match[bytes] | None:
    """A match near a random place."""
    return pattern.search(data, m.spot(data)) or pattern.search(data)


def _number(m: Mutator, data: Data) -> Data:
    match = _found(m, _NUMBER, data)
    return (
        data if match is None else data[: match.start()] + m.rng.choice(NUMBERS) + data[match.end() :]
    )


def _word(m: Mutator, data: Data) -> Data:
    match = _found(m, _WORD, data)
    return (
        data if match is None else data[: match.start()] + m.rng.choice(m.words) + data[match.end() :]
    )


def _value(m: Mutator, data: Data) -> Data:
    """What stands between two separators becomes something else."""
    at = m.spot(data)
    start = max(data.rfind(mark, 0, at) for mark in (b" ", b"=", b":", b",", b"["))
    end = min(
        (x for x in (data.find(mark, at) for mark in (b"\n", b",", b"]", b"}")) if x >= 0), default=at
    )
    return data[: start + 1] + m.rng.choice(VALUES if m.rng.random() < 0.7 else NUMBERS) + data[end:]


def _token(m: Mutator, data: Data) -> Data:
    at = m.spot(data)
    return data[:at] + m.token() + data[at + int(m.rng.expovariate(0.1)) :]


def _insert(m: Mutator, data: Data) -> Data:
    at = m.spot(data)
    return data[:at] + m.token() + data[at:]


def _cut(m: Mutator, data: Data) -> Data:
    at = m.spot(data)
    return data[:at] + data[at + int(m.rng.expovariate(0.1)) :]


def _repeat(m: Mutator, data: Data) -> Data:
    at = m.spot(data)
    end = at + int(m.rng.expovariate(0.05))
    return data[:at] + data[at:end] * m.rng.randrange(2, 6) + data[end:]


def _flip(m: Mutator, data: Data) -> Data:
    at = m.spot(data)
    return data[:at] + bytes([int(m.rng.random() * 256)]) + data[at + 1 :]


def _copy_line(m: Mutator, data: Data) -> Data:
    lines = data.split(b"\n")
    lines.insert(m.rng.randrange(len(lines) + 1), m.rng.choice(lines))
    return b"\n".join(lines)


def _drop_line(m: Mutator, data: Data) -> Data:
    lines = data.split(b"\n")
    del lines[m.rng.randrange(len(lines))]
    return b"\n".join(lines)


def _swap_lines(m: Mutator, data: Data) -> Data:
    lines = data.split(b"\n")
    i, j = m.rng.randrange(len(lines)), m.rng.randrange(len(lines))
    lines[i], lines[j] = lines[j], lines[i]
    return b"\n".join(lines)


def _shuffle(m: Mutator, data: Data) -> Data:
    lines = data.split(b"\n")
    m.rng.shuffle(lines)
    return b"\n".join(lines)


def _splice(m: Mutator, data: Data) -> Data:
    other = m.rng.choice(m.seeds)
    at, start = m.spot(data), m.spot(other)
    return data[:at] + other[start : start + m.rng.randrange(200)] + data[at + m.rng.randrange(100) :]


def _truncate(m: Mutator, data: Data) -> Data:
    return data[: m.spot(data)]


def _line_ends(m: Mutator, data: Data) -> Data:
    return data.replace(b"\n", m.rng.choice(_LINE_ENDS))


def _bom(m: Mutator, data: Data) -> Data:
    if m.rng.random() < 0.5:
        return m.rng.choice(_BOMS) + data
    return data.decode("utf-8", "replace").encode(
        m.rng.choice(("utf-16", "utf-32", "utf-16-le", "utf-7"))
    )


def _nest(m: Mutator, data: Data) -> Data:
    """A value inside many brackets, a key of many parts, or an element inside many elements."""
    match = _found(m, _WORD, data)
    if match is None:
        return data
    n = m.rng.choice((2, 5, 31, 33, 100, 1000))
    opening, closing = m.rng.choice(
        (
            (b"[", b"]"),
            (b"{a: ", b"}"),
            (b'{"a": ', b"}"),
            (b"{a = ", b"}"),
            (b"a.", b""),
            (b"<a>", b"</a>"),
            (b"- ", b""),
        )
    )
    return data[: match.start()] + opening * n + match.group() + closing * n + data[match.end() :]


def _blow_up(m: Mutator, data: Data) -> Data:
    """A piece of the file thousands of times: a long line, a long number, many lines, many keys."""
    at = m.spot(data)
    end = at + m.rng.choice((1, 1, 2, 5, 20, 100))
    piece = m.token() if m.rng.random() < 0.3 else data[at:end]
    if not piece:
        return data
    size = int(10.0 ** m.rng.uniform(3.5, 5.5))
    return data[:at] + piece * (size // len(piece)) + data[end:]
