"""What Hermite does without a window: evaluate, info, convert, render; only the last one loads Qt."""

import argparse
import csv
import io
import math
import os
import re
import sys
from collections.abc import Callable, Iterator, Sequence
from typing import Final, NamedTuple, NoReturn

import numpy as np

from model.channel import Channel
from model.clip import Clip
from model.formats import FORMATS, FormatError, format_of_path, losses, read_clip, sniff
from model.formats.skel import ANGLE
from model.hermite import Floats
from model.keyframe import TangentRule

_MOST_ROWS: Final = 10_000_000
_ROWS_AT_ONCE: Final = 4096
_NUMBER: Final = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?\Z")


class CommandError(Exception):
    """The command cannot do what was asked; ``str()`` is one sentence."""


class Command(NamedTuple):
    """One row a command: its line in the help, what it takes, what it does."""

    help: str
    add_arguments: Callable[[argparse.ArgumentParser], None]
    run: Callable[[argparse.Namespace], None]


def run(argv: Sequence[str]) -> int:
    """Do what *argv* (the command's name first) says: 0, or 2 after one sentence on stderr."""
    if sys.stdout is None:  # closed by whoever called
        return _refused("there is nowhere to print to: the output is closed")
    try:
        arguments, strangers = parser().parse_known_args(argv)
        if strangers:
            raise CommandError(_unknown(arguments.command, strangers[0]))
        COMMANDS[arguments.command].run(arguments)
        sys.stdout.flush()
    except BrokenPipeError:
        return _refused("nobody reads the output any more")
    except (CommandError, FormatError) as error:
        return _refused(str(error))
    except OSError as error:
        return _refused(str(error) if error.strerror is None else error.strerror)
    except KeyboardInterrupt:
        return _refused("stopped")
    finally:
        _drop_output_left()
    return 0


def _drop_output_left() -> None:
    """Python flushes stdout once more at exit: what could not be printed goes nowhere instead of failing there."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _refused(sentence: str) -> int:
    if sys.stderr is not None:  # closed: print would take the output instead
        print(_printable(sentence), file=sys.stderr)
    return 2


class _Parser(argparse.ArgumentParser):
    """A parser that takes -1e-3 for a number, and whose refusal is one sentence instead of a page."""

    def __init__(self, *arguments: object, **options: object) -> None:
        super().__init__(*arguments, **options)  # type: ignore[arg-type]  # passed on as they came
        self._negative_number_matcher = re.compile(r"-\.?[0-9]")

    def error(self, message: str) -> NoReturn:
        raise CommandError(f"{self.prog}: {message} (see {self.prog} --help)")


def parser() -> argparse.ArgumentParser:
    """The parser of all commands."""
    result = _Parser(prog="hermite", description="Works on animation clips without a window.", allow_abbrev=False)
    commands = result.add_subparsers(dest="command", required=True, metavar="COMMAND", parser_class=_Parser)
    for name, command in COMMANDS.items():
        sub = commands.add_parser(name, help=command.help, description=command.help, allow_abbrev=False)
        sub.usage = f"hermite {name} FILE{' OUT' if name == 'convert' else ''} [OPTION ...]"
        sub.add_argument("file", metavar="FILE", help="the clip")
        sub.add_argument("--skel", metavar="FILE", help="a skeleton whose joints name the channels of a course .anim")
        command.add_arguments(sub)
    return result


def _unknown(command: str, word: str) -> str:
    """What to say of a word that is no option of the command, or one file too many."""
    if not word.startswith("-"):
        return f"hermite {command}: {word!r} is one word too many (see hermite {command} --help)"
    import difflib

    sub = argparse.ArgumentParser(add_help=False)
    COMMANDS[command].add_arguments(sub)
    options = [option for action in sub._actions for option in action.option_strings]
    close = difflib.get_close_matches(word, [*options, "--skel"], 1, 0.6)
    hint = f"did you mean {close[0]}?" if close else f"see hermite {command} --help"
    return f"hermite {command}: there is no option {word} ({hint})"


def _number(text: str) -> float:
    value = float(text) if _NUMBER.match(text) else math.nan
    if not math.isfinite(value):
        cure = "; numbers are parted by spaces" if "," in text else ""
        if "." in text.lstrip("-0123456789.") or os.path.exists(text):
            cure = "; the clip stands in front of the options"
        raise argparse.ArgumentTypeError(f"{text!r} is not a number{cure}")
    return value


def _positive(text: str) -> float:
    value = _number(text)
    if value <= 0:
        raise argparse.ArgumentTypeError(f"{text!r} is not above 0")
    return value


def _size(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"([0-9]{1,5})[xX×]([0-9]{1,5})", text)
    size = (int(match[1]), int(match[2])) if match else (0, 0)
    if not all(16 <= side <= 16384 for side in size):
        raise argparse.ArgumentTypeError(f"{text!r} is not a size such as 1600x900 (16 to 16384 pixels)")
    return size


def _chosen(clip: Clip, names: Sequence[str] | None) -> list[Channel]:
    """The channels called *names*, all without; CommandError with the nearest names for one that is not there."""
    if not names:
        return clip.channels
    known = {channel.name: channel for channel in clip.channels}
    for name in names:
        if name not in known:
            import difflib

            close = difflib.get_close_matches(name, known, 3, 0.5)
            hint = f"did you mean {' or '.join(close)}?" if close else "hermite info lists them"
            raise CommandError(f"there is no channel {name!r}; {hint}")
    return [known[name] for name in names]


# --- evaluate


def _add_evaluate(sub: argparse.ArgumentParser) -> None:
    sub.add_argument("--times", nargs="+", type=_number, metavar="T", help="at these times (seconds)")
    sub.add_argument("--from", dest="start", type=_number, metavar="A", help="first time; else the clip's start")
    sub.add_argument("--to", dest="end", type=_number, metavar="B", help="last time; else the clip's end")
    sub.add_argument("--rate", type=_positive, metavar="R", help="samples per second; else the clip's frame rate")
    sub.add_argument("--channel", nargs="+", action="extend", metavar="NAME", help="only these channels")


def _evaluate(arguments: argparse.Namespace) -> None:
    if arguments.times and not (arguments.start is arguments.end is arguments.rate is None):
        raise CommandError("hermite evaluate: give either --times or --from, --to and --rate")
    clip = read_clip(arguments.file, skeleton=arguments.skel)
    channels = _chosen(clip, arguments.channel)
    pieces = _pieces(clip, arguments)
    header = io.StringIO()
    csv.writer(header, lineterminator="\n").writerow(["time", *(channel.name for channel in channels)])
    _print(header.getvalue())
    for times in pieces:
        columns = [times, *(channel.evaluate(times) for channel in channels)]
        texts = [map(repr, column.tolist()) for column in columns]
        _print("\n".join(map(",".join, zip(*texts, strict=True))) + "\n")


def _pieces(clip: Clip, arguments: argparse.Namespace) -> Iterator[Floats]:
    """The times asked for, some at once; CommandError before the first if they make no sense."""
    if arguments.times:
        return iter([np.array(arguments.times, np.float64)])
    start = clip.start if arguments.start is None else arguments.start
    end = clip.end if arguments.end is None else arguments.end
    rate = clip.frame_rate if arguments.rate is None else arguments.rate
    if start > end:
        own = " (where one is not given, the clip's range counts)" if None in (arguments.start, arguments.end) else ""
        raise CommandError(f"hermite evaluate: the first time {start!r} lies after the last, {end!r}{own}")
    # A last sample that falls short of the end by rounding alone is still meant.
    steps = (end - start) * rate * (1 + 1e-12) + 1e-9
    if not steps < _MOST_ROWS:
        raise CommandError(f"hermite evaluate: that is {steps:.3g} samples; at most {_MOST_ROWS:,} are given")
    return _pieces_at_rate(start, end, rate, int(steps) + 1)


def _pieces_at_rate(start: float, end: float, rate: float, count: int) -> Iterator[Floats]:
    for first in range(0, count, _ROWS_AT_ONCE):
        numbers = np.arange(first, min(first + _ROWS_AT_ONCE, count), dtype=np.float64)
        yield np.minimum(start + numbers / rate, end)


# --- info


def _add_nothing(_sub: argparse.ArgumentParser) -> None:
    pass


def _info(arguments: argparse.Namespace) -> None:
    clip = read_clip(arguments.file, skeleton=arguments.skel)
    with open(arguments.file, "rb") as file:
        kind = FORMATS[sniff(file.read(1 << 16))].label
    keys = clip.key_count
    lines = [
        f"{arguments.file}: {kind}, {len(clip.channels)} channels, {keys} keys",
        f"range {clip.start!r} to {clip.end!r} s, {clip.frame_rate!r} frames per second",
    ]
    if clip.title:
        lines.append(f"title {clip.title}")
    extent = clip.extent()
    if extent:
        lines.append(f"keys from {extent[0]!r} to {extent[1]!r} s")
    titles = ("channel", "keys", "first", "last", "lowest", "highest", "before", "after", "unit", "rules (sides)")
    rows = [titles, *map(_row, clip.channels)]
    _print("\n".join([*map(_printable, lines), "", *_table(rows)]) + "\n")


def _row(channel: Channel) -> tuple[str, ...]:
    first, last = channel.first, channel.last
    numbers = [""] * 4
    if first is not None and last is not None:
        numbers = [f"{number:.6g}" for number in (first.time, last.time, *channel.extrema())]
    run = channel.run()
    counts = np.bincount(np.concatenate([run["rule_in"], run["rule_out"]]), minlength=len(TangentRule)).tolist()
    rules = [f"{rule.word} {counts[rule]}" for rule in TangentRule if counts[rule]]
    broken = int(np.count_nonzero(run["broken"]))
    if broken:
        rules.append(f"broken {broken}")
    if channel.locked:
        rules.append("locked")
    unit = "rad" if channel.unit == ANGLE else channel.unit
    return (channel.name, str(len(run)), *numbers, channel.pre.word, channel.post.word, unit, ", ".join(rules))


def _table(rows: list[tuple[str, ...]]) -> list[str]:
    """Rows as lines with columns below each other; columns of numbers end at the same place."""
    rows = [tuple(map(_printable, row)) for row in rows]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    aligned = [str.rjust if 1 <= i <= 5 else str.ljust for i in range(len(widths))]
    return ["  ".join(f(cell, w) for f, cell, w in zip(aligned, row, widths, strict=True)).rstrip() for row in rows]


# --- convert and render


def _add_convert(sub: argparse.ArgumentParser) -> None:
    sub.add_argument("out", metavar="OUT", help="where to write; its extension tells the format")
    sub.add_argument("--to", dest="format", choices=list(FORMATS), help="the format, whatever the extension")
    sub.add_argument("--lossy", action="store_true", help="write even if the format cannot hold everything")
    sub.add_argument("--force", action="store_true", help="replace OUT if it exists")


def _convert(arguments: argparse.Namespace) -> None:
    from model.saving import save_clip

    if os.path.isdir(arguments.out):
        raise CommandError(f"{arguments.out}: this is a folder; give a file name")
    format_name = arguments.format or format_of_path(arguments.out)
    if format_name is None:
        known = ", ".join(row.extension for row in FORMATS.values())
        raise CommandError(f"{arguments.out}: the extension tells no format ({known} do); give --to")
    if os.path.isfile(arguments.out) and not arguments.force:
        raise CommandError(f"{arguments.out}: not written, since there is a file of that name (--force replaces it)")
    clip = read_clip(arguments.file, skeleton=arguments.skel)
    lost = losses(clip, format_name, arguments.out)
    if lost and not arguments.lossy:
        raise CommandError(
            f"{arguments.out}: not written, since {'; '.join(map(str, lost))} (--lossy writes it all the same)"
        )
    for note in save_clip(clip, arguments.out, format_name).notes:
        print(_printable(note), file=sys.stderr)


def _add_render(sub: argparse.ArgumentParser) -> None:
    sub.add_argument("-o", "--out", required=True, metavar="PNG", help="the picture to write")
    sub.add_argument("--size", type=_size, default=(1600, 900), metavar="WxH", help="in pixels; 1600x900 unless given")
    sub.add_argument("--from", dest="start", type=_number, metavar="A", help="first time; else what there is")
    sub.add_argument("--to", dest="end", type=_number, metavar="B", help="last time; else what there is")
    sub.add_argument("--channel", nargs="+", action="extend", metavar="NAME", help="only these channels")


def _render(arguments: argparse.Namespace) -> None:
    if arguments.start is not None and arguments.end is not None and not arguments.start < arguments.end:
        raise CommandError(f"hermite render: --from {arguments.start!r} does not lie before --to {arguments.end!r}")
    if os.path.exists(arguments.out) and (format_of_path(arguments.out) or _holds_a_clip(arguments.out)):
        raise CommandError(f"{arguments.out}: not written, since it is a clip and -o names a picture, as in walk.png")
    clip = read_clip(arguments.file, skeleton=arguments.skel)
    channels = _chosen(clip, arguments.channel)
    if not arguments.out.lower().endswith(".png"):
        raise CommandError(f"{arguments.out}: not written, since pictures are PNG files: name it with .png at the end")
    from app.quick_qt import import_qt
    from app.quick_start import import_pyqtgraph

    import_qt()
    import_pyqtgraph()
    from app.render import render

    render(clip, channels, arguments.out, size=arguments.size, start=arguments.start, end=arguments.end)


def _holds_a_clip(path: str) -> bool:
    if not os.path.isfile(path):
        return False
    with open(path, "rb") as file:
        return sniff(file.read(1 << 16)) in FORMATS


COMMANDS: Final[dict[str, Command]] = {
    "evaluate": Command("print the values of channels at given times as CSV", _add_evaluate, _evaluate),
    "info": Command("print what is in a clip", _add_nothing, _info),
    "convert": Command("write a clip in another format", _add_convert, _convert),
    "render": Command("draw a clip into a picture", _add_render, _render),
}


def _print(text: str) -> None:
    """Text as UTF-8, whatever the terminal's encoding is said to be: tables and files must not depend on it."""
    sys.stdout.buffer.write(text.encode("utf-8", "replace"))


def _printable(text: str) -> str:
    """Text that cannot steer a terminal: names come from files of others."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)
