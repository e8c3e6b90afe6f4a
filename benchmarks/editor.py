"""The editor's frame on a cloud of 100 seeds and 1000 billboards, in its own window of 1280x720.

A frame is all of it: what a slider has changed is put into the document, the cloud is generated and
lit anew, drawn and shown, with all panels. Cases: `idle`, where nothing moves; `slider`, one value
changed in each frame; `slider_marks`, the same with seed boxes, rays and roots over the cloud;
`orbit`, the camera turned in each frame. Needs the extra `editor`; without a display the window is
one that nobody sees.

Rows: `seeds`, `billboards`, and `sharpness`, the share of the picture's sides that the editor drew
at the end: while a picture moves on a slow machine it has fewer pixels, all of them at rest.
Ratios: `fps_slider`, `fps_slider_marks`, `fps_orbit`; `frames_until_shown`, from a change to the
picture of it; `open_50_ms`, to open a file of 50 models.
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from benchmarks.harness import Case, Result, measure, renderer_name
from weather_ecs import CloudFile, save_clouds
from weather_ecs.components import CloudModel, CloudRoot, CloudSeed

SEEDS, BILLBOARDS = 100, 1000
MODELS = 50
SIZE = (1280, 720)


def big_model(name: str, seeds: int = SEEDS) -> CloudModel:
    """Seeds all over a flat cloud, ten billboards in each; a tenth of them with an idle root."""
    rng = np.random.default_rng(100)
    places = rng.uniform(-1.0, 1.0, (seeds, 3)) * (1400.0, 350.0, 1400.0) + (0.0, 500.0, 0.0)
    idle = (CloudRoot(pitch=60.0, open_pitch=40.0, seeds_start=0, seeds_end=0),)
    boxes = tuple(
        CloudSeed(tuple(place.tolist()), 300.0, 200.0, 300.0, roots=idle if k % 10 == 0 else ())
        for k, place in enumerate(places)
    )
    each = BILLBOARDS // SEEDS
    return CloudModel(
        name, boxes, billboards_min=each, billboards_max=each, size_min=200.0, size_max=350.0
    )


def run(quick: bool) -> Result:
    """Measure the four cases in turns."""
    import pyglet

    if sys.platform.startswith("linux") and not os.environ.get("DISPLAY"):
        pyglet.options.headless = True
        os.environ.setdefault("PYOPENGL_PLATFORM", "egl")
    pyglet.options.debug_gl = False
    from weather_ecs.editor.app import EditorWindow

    window = EditorWindow(None, SIZE)
    try:
        return _measured(window, quick)
    finally:
        window.shut()


def _measured(window: Any, quick: bool) -> Result:
    document, shared = window.document, window.shared
    document.reset(CloudFile(models=(big_model("big"),)))
    view = window.cloud_view
    changes = 0

    def frame(act: Callable[[], object]) -> None:
        window.switch_to()
        window.dispatch_events()
        act()
        window.frame()

    def slide() -> None:
        nonlocal changes
        changes += 1
        model = document.content.models[0]
        other = replace(model, roundness=0.2 + 0.005 * (changes % 100))
        document.apply("Roundness", replace(document.content, models=(other,)), merge="slider")

    def marks(on: bool) -> None:
        shared.modes.boxes = shared.modes.rays = shared.modes.roots = on

    for _ in range(3 if quick else 30):
        frame(slide)
    facts = {"seeds": SEEDS, "billboards": BILLBOARDS}
    acts: dict[str, tuple[Callable[[], object], bool]] = {
        "idle": (lambda: None, False),
        "slider": (slide, False),
        "slider_marks": (slide, True),
        "orbit": (lambda: view.camera.orbit(4.0, 0.0), False),
    }
    sharpness: dict[str, float] = {}

    def one(name: str) -> None:
        frame(acts[name][0])
        sharpness[name] = view.sharpness.share

    cases = [
        Case(name, lambda name=name: one(name), facts, lambda on=on: marks(on))  # type: ignore[misc]
        for name, (_, on) in acts.items()
    ]
    rounds, seconds = (2, 0.01) if quick else (7, 0.35)
    timings = measure(cases, finish=shared.gl.finish, rounds=rounds, sample_seconds=seconds)
    rows = [{**timings.row(case), "sharpness": sharpness[case.name]} for case in cases]
    before = view.drawn
    frame(slide)
    ratios = {f"fps_{row['name']}": row["fps"] for row in rows if row["name"] != "idle"}
    ratios["frames_until_shown"] = float(view.drawn - before)
    ratios["open_50_ms"] = _opening(window)
    return Result("editor", renderer_name(shared.gl), rows, ratios)


def _opening(window: Any) -> float:
    """Milliseconds until a file of many models has been read and shown."""
    models = tuple(replace(big_model("m", 12), name=f"model {k}") for k in range(MODELS))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "many.toml"
        save_clouds(path, CloudFile(models=models))
        begin = perf_counter()
        window.session.load(path)
        window.frame()
        window.shared.gl.finish()
        return (perf_counter() - begin) * 1e3
