"""Loading and saving a million keys, against usd-core on the same keys and orjson on the same numbers."""

import tempfile
from pathlib import Path

import orjson
from pxr import Sdf, Usd

from model.clip import Clip
from model.formats import read_clip, write_bytes
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


def run() -> list[Line]:
    """All figures of files."""
    clip = Clip([a_channel(MANY, name="root.tx")])
    run_of_keys = clip.channels[0].run()
    numbers = [run_of_keys[field].tolist() for field in ("time", "value", "slope_in", "slope_out")]
    lines = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        usd, json = _usd_file(folder), folder / "bench.json"
        json.write_bytes(orjson.dumps(numbers))
        usd_layer = Sdf.Layer.FindOrOpen(str(usd))
        for format_name, extension in (("anim", "anim"), ("hermite", "hermite")):
            path = folder / f"bench.{extension}"
            path.write_bytes(write_bytes(clip, format_name))
            taken = timed(
                {
                    "load": lambda p=path: read_clip(p),
                    "save": lambda p=path, f=format_name: save_atomic(p, write_bytes(clip, f)),
                    "usd load": lambda: _read_usd(usd),
                    "usd save": lambda: usd_layer.Export(str(folder / "again.usda")),
                    "json load": lambda: orjson.loads(json.read_bytes()),
                    "json save": lambda: json.write_bytes(orjson.dumps(numbers)),
                },
                rounds=3,
            )
            for verb in ("load", "save"):
                work, ours = f"{verb} 1,000,000 keys, .{extension}", taken[verb].median
                usd_time = taken[f"usd {verb}"].median * SHARE
                lines.append(Line(work, ours, "usd-core, .usda (100,000 keys x 10)", usd_time, 1.0, 1.0))
                lines.append(Line(work, ours, "orjson, the bare numbers", taken[f"json {verb}"].median))
    return lines
