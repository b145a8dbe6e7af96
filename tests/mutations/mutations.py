"""Random damage to the files that the program reads: the same for the same seed,
and small, so that most of what comes out is nearly right."""
import random
import re

NUMBER = re.compile(rb"(?<![\w.])[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?(?![\w.])")
WORD = re.compile(rb"[A-Za-z_]\w{2,}")
WILD = (b"0", b"-1", b"1e30", b"-1e30", b"1e308", b"1e-308", b"nan", b"inf",
        b"2147483648", b"9223372036854775807", b"1e400", b"1000000", b"0.001")
WILD_EXPRESSIONS = (b'"1/0"', b'"exp(846)"', b'"0/0"', b'"sqrt(-1)"', b'"x/0"',
                    b'"' + b"+".join([b"1"] * 4000) + b'"', b'"1e200*1e200"',
                    b'"((((((((1))))))))"', b'""', b"[]", b"true", b"{}")


def pick(choice, found):
    found = list(found)
    return choice.choice(found) if found else None


def change_number(choice, data, expressions):
    at = pick(choice, NUMBER.finditer(data))
    if at is None:
        return data
    kind = choice.randrange(6 if expressions else 5)
    if kind == 0:
        new = choice.choice(WILD)
    elif kind == 1:
        new = b"-" + at.group().lstrip(b"+-")
    elif kind == 5:
        new = choice.choice(WILD_EXPRESSIONS)
    else:
        try:
            scale = (choice.uniform(0.5, 2.0) if kind == 2
                     else 10.0 ** choice.randint(-6, 6))
            new = b"%.6g" % (float(at.group()) * scale)
        except (OverflowError, ValueError):
            new = b"0"
    return data[:at.start()] + new + data[at.end():]


def change_line(choice, data):
    lines = data.split(b"\n")
    at = choice.randrange(len(lines))
    other = choice.randrange(len(lines))
    kind = choice.randrange(3)
    if kind == 0:
        del lines[at]
    elif kind == 1:
        lines.insert(at, lines[other])
    else:
        lines[at], lines[other] = lines[other], lines[at]
    return b"\n".join(lines)


def change_word(choice, data):
    at, other = (pick(choice, WORD.finditer(data)) for _ in range(2))
    if at is None:
        return data
    return data[:at.start()] + other.group() + data[at.end():]


def change_bytes(choice, data):
    at = choice.randrange(len(data) + 1)
    kind = choice.randrange(4)
    if kind == 0:
        return data[:at]  # cut off
    if kind == 1:
        return data[:at] + data[at + choice.randint(1, 40):]
    if kind == 2:
        return data[:at] + choice.randbytes(choice.randint(1, 4)) + data[at:]
    return data[:at] + choice.randbytes(1) + data[at + 1:]


def mutate(choice, data, kind):
    """`kind`: toml, text or binary."""
    for _ in range(choice.choice((1, 1, 1, 2, 3))):
        if kind == "binary":
            data = change_bytes(choice, data)
            continue
        change = choice.randrange(10)
        if change < 6:
            data = change_number(choice, data, kind == "toml")
        elif change < 8:
            data = change_line(choice, data)
        elif change < 9:
            data = change_word(choice, data)
        else:
            data = change_bytes(choice, data)
    return data


def chooser(seed, number):
    return random.Random(f"{seed}:{number}")
