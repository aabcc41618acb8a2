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

NUMBERS = rb"""
nan .nan NaN inf -.inf Infinity -Infinity 1e308 -1e308 1e300 1e-300 5e-324 1e999 1E400 -1E-400 1e9 -1e9 1e6
-9223372036854775808 0x10 0x1p+1023 0x1.8p-1074 -0x1p+0 0x0p+0 0b1 0o7 1_000 0 -0 -1 1 2 3 1. .5 +1 1e 1e+ --1
1,5 07:32:00 1979-05-27
""".split()
NUMBERS += [b"9" * 20, b"9" * 400, b"9" * 4400, b"0x" + b"e" * 400, b"0.1" + b"0" * 40 + b"1"]
NUMBERS += [b"1" * 18 + b".5", "\u0661".encode(), "\uff11".encode()]
VALUES = rb"""
"" '' [] {} null ~ true false True yes "x" [[]] [{}] {"a":1} [1] [1,2] [[1,2],[3]] "1" '1' [nan] [true] ["a"]
"rad" "deg" "mm" "m" "3-5-3" "4-3-4" "every-motion" "b-spline-3" "velocity"
../../etc/passwd /etc/passwd /dev/zero file:///etc/passwd http://127.0.0.1/x . .. / |id
arm.urdf moveit.yaml table.csv nowhere.toml "\u0000" a\u0000b a\nb
""".split()
VALUES += [b"", b"{a: 1}", b"{a = 1}", b"- 1", b"x" * 300, b"x" * 5000]
MARKS = rb"""
[ ] { } ( ) < > /> / , ; : = . # ' " ''' \ | - & * ! ? % @ ` %YAML %TAG <<: &a *a !!float !x \ud800 \U00110000
<!ENTITY <!-- --> <![CDATA[ ]]> <?x?> &b; &amp; &#0; &#x10ffff; xacro: ${x} <limit/> a.b.c=1 __proto__ 0
""".split()
MARKS += [b'"""', b"<!DOCTYPE a>", b"<!ENTITY a 'b'>"]
MARKS += [
    b"<!DOCTYPE a [<!ENTITY b SYSTEM 'file:///etc/passwd'>]>",
    b"<xi:include href='/etc/passwd'/>",
]
MARKS += [
    b"<?xml version='1.1'?>",
    b"$(find x)",
    b"xmlns:a='b' ",
    b"!!python/object/apply:os.system ['id'] ",
]
MARKS += [b"<joint name='j1'/>", b"<link name='z'/>", b"<mimic joint='j2'/>", b"<axis xyz='0 0 0'/>"]
MARKS += [b">\n", b"|\n", b"? ", b"- ", b"---\n", b"...\n", b"%YAML 1.1\n", b"%TAG ! tag:x,2000:\n"]
MARKS += [
    b"&a ",
    b"<<: *a",
    b"!degrees ",
    b"!!binary ",
    b"[limits]\n",
    b"[[pose]]\n",
    b"[a.b.c]\n",
    b" = ",
]
MARKS += [
    b"\0",
    b"\t",
    b" ",
    b"\n",
    b"\r",
    b"\n\n",
    b"\x7f",
    b"\x1b[2J",
    b"\xff\xfe",
    b"\xef\xbb\xbf",
    b"\xc3",
]
MARKS += [b"\xed\xa0\x80", b"\xf4\x90\x80\x80"]
MARKS += [
    c.encode() for c in ("\u2028", "\u00a0", "\u202e", "\u200b", "\U0001f916", "e\u0301", "\ufeff")
]
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
