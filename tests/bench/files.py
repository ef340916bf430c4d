"""Loading and saving a million keys, against usd-core on the same keys and orjson on the same numbers."""

import tempfile
from itertools import product
from pathlib import Path

import numpy as np
import orjson
from pxr import Sdf, Usd

from app.clip_file import Leave, Saved, open_clip, save_clip
from model.channel import Channel
from model.clip import Clip
from model.formats import Loss, losses_of, write_bytes
from model.formats.content import Content
from model.keyframe import TangentRule, make_run
from model.saving import save_atomic
from tests.bench.evaluating import a_channel, as_ts
from tests.bench.table import Line, timed

MANY = 1_000_000
# pxr.Ts takes half a second for 100,000 knots from Python; a tenth of the keys is read and the time is multiplied.
SHARE = 10


def _usd_file(folder: Path) -> Path:
    """A tenth of the keys as a spline in a .usda file."""
    path = folder / "bench.usda"
    stage = Usd.Stage.CreateNew(str(path))
    prim = stage.DefinePrim("/Bench")
    attribute = prim.CreateAttribute("x", Sdf.ValueTypeNames.Double)
    attribute.SetSpline(as_ts(a_channel(MANY // SHARE)))
    stage.GetRootLayer().Save()
    return path


def _read_usd(path: Path) -> int:
    layer = Sdf.Layer.OpenAsAnonymous(str(path))
    return len(layer.GetAttributeAtPath("/Bench.x").GetSpline().GetKnots())


def _mixed(clip: Clip) -> Clip:
    """The same keys under all rules, with slopes of their own where they are fixed."""
    random, run = np.random.default_rng(5), clip.channels[0].run()
    rules = random.choice(list(TangentRule), len(run))
    into = np.where(rules == TangentRule.STEP, TangentRule.AUTO, rules)
    slopes = random.normal(size=(2, len(run)))
    return Clip([Channel("root.tx", make_run(run["time"], run["value"], *slopes, into, rules))])


def _saved(clip: Clip, path: Path, format_name: str, accepted: list[Loss]) -> None:
    """Save as the window does: written, on the disk, read back and compared, put in its place, its version noted.

    *accepted* is what the user has said may be lost.
    """
    leave = Leave(accepted, None, whatever=True)
    assert isinstance(save_clip(Content.of(clip), str(path), format_name, leave), Saved)


def run() -> list[Line]:
    """All figures of files."""
    smooth = Clip([a_channel(MANY, name="root.tx")])
    run_of_keys = smooth.channels[0].run()
    numbers = [run_of_keys[field].tolist() for field in ("time", "value", "slope_in", "slope_out")]
    clips = {"": smooth, " of all rules": _mixed(smooth)}
    lines = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        usd, json = _usd_file(folder), folder / "bench.json"
        json.write_bytes(orjson.dumps(numbers))
        usd_layer = Sdf.Layer.FindOrOpen(str(usd))
        for format_name, (kind, clip) in product(("anim", "hermite"), clips.items()):
            path = folder / f"bench.{format_name}"
            path.write_bytes(write_bytes(clip, format_name))
            accepted = losses_of(Content.of(clip), format_name, str(path))
            taken = timed(
                {
                    "load": lambda p=path: open_clip(str(p)),
                    "save": lambda c=clip, p=path, f=format_name, a=accepted: _saved(c, p, f, a),
                    "write": lambda c=clip, p=path, f=format_name: save_atomic(p, write_bytes(c, f)),
                    "usd load": lambda: _read_usd(usd),
                    "usd save": lambda: usd_layer.Export(str(folder / "again.usda")),
                    "json load": lambda: orjson.loads(json.read_bytes()),
                    "json save": lambda: json.write_bytes(orjson.dumps(numbers)),
                },
                rounds=3,
            )
            what = f"1,000,000 keys{kind}, .{format_name}"
            for verb in ("load", "save"):
                ours, usd_time = taken[verb].median, taken[f"usd {verb}"].median * SHARE
                lines.append(Line(f"{verb} {what}", ours, "usd-core, .usda (100,000 keys x 10)", usd_time, 1.0, 1.0))
                lines.append(Line(f"{verb} {what}", ours, "orjson, the bare numbers", taken[f"json {verb}"].median))
            written = taken["write"].median
            lines.append(Line(f"write {what}", written, "orjson, the bare numbers", taken["json save"].median))
    return lines
