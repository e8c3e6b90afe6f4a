"""`Weather.prepare`: the same picture whether the work was done before the scene or after it."""

from __future__ import annotations

from collections.abc import Callable

import esper
import moderngl
import numpy as np
import pytest

from tests.boxes import CORNERS, TRIANGLES, placed
from tests.golden_scenes import SHED, Scene, Scenery
from tests.views import look_from, perspective
from tests.weather_pictures import Stage, stage
from weather_ecs import ContextError, InvalidValueError, Weather
from weather_ecs.components import (
    Cloud,
    Observer,
    Occluder,
    RainArea,
    RippleSurface,
    SplashEmitter,
    Sun,
    Wind,
)

SIZE = (240, 135)
HERE = (1.5, 1.7, 3.0)
PROJECTION = perspective()


def populate() -> None:
    esper.create_entity(RainArea(center=(0, 0), radii=(80, 60), rain_rate=60.0))
    esper.create_entity(RainArea(center=(260, 40), radii=(60, 60), rain_rate=40.0, ceiling=150.0))
    esper.create_entity(Wind((0.3, 1.0), 4.0), SplashEmitter(), Sun((0.4, 0.7, 0.3)))
    esper.create_entity(RippleSurface(center=(0, 0.02, -9), size=(16, 6)))
    esper.create_entity(Cloud("cumulus", (1500.0, 700.0, -900.0), number=2))
    for center, half, _ in SHED:
        esper.create_entity(Occluder(CORNERS, TRIANGLES, placed(center, half)))


def play(
    ctx: moderngl.Context, frame: Callable[[Stage, np.ndarray, Callable[[], None]], None],
    backend: str = "feedback",
) -> np.ndarray:  # fmt: skip
    """The last of some pictures; `frame` draws one from a view, and the scene when it likes."""
    with stage(ctx, SIZE, quality="medium", seed=3, backend=backend) as made:
        populate()
        scenery = Scenery(ctx)
        scene = Scene(populate, lambda t: HERE)
        for k in range(14):
            esper.process(1 / 30)
            view = look_from((HERE[0] + 0.02 * k, *HERE[1:]), 0.4)

            def paint(view: np.ndarray = view) -> None:
                made.clear()
                scenery.paint(scene, view, PROJECTION)

            frame(made, view, paint)
        scenery.release()
        return made.picture().astype(int)


def after(made: Stage, view: np.ndarray, paint: Callable[[], None]) -> None:
    paint()
    made.weather.draw(view, PROJECTION)


def before(made: Stage, view: np.ndarray, paint: Callable[[], None]) -> None:
    made.target.use()
    made.weather.prepare(view, PROJECTION)
    paint()
    made.weather.draw(view, PROJECTION)


@pytest.mark.parametrize("backend", ["feedback", "compute"])
def test_prepared_or_not_the_picture_is_the_same(ctx: moderngl.Context, backend: str) -> None:
    if backend == "compute" and ctx.version_code < 430:
        pytest.skip("no compute shaders here")
    plain, ahead = play(ctx, after, backend), play(ctx, before, backend)
    off = np.abs(plain - ahead)
    # Splashes are listed in no certain order by `compute`, and blend in the order of the list.
    assert off.max() == 0 if backend == "feedback" else off.mean() < 0.02
    assert plain.std() > 10.0


def test_what_was_prepared_for_something_else_is_not_drawn(ctx: moderngl.Context) -> None:
    def elsewhere(made: Stage, view: np.ndarray, paint: Callable[[], None]) -> None:
        made.target.use()
        made.weather.prepare(view, PROJECTION)
        made.weather.prepare(look_from((40.0, 9.0, 3.0), 2.0), PROJECTION, observer=other)
        paint()
        made.weather.draw(view, PROJECTION)

    other = Observer((40.0, 9.0, 3.0))
    assert np.abs(play(ctx, after) - play(ctx, elsewhere)).max() == 0


def test_what_was_prepared_before_all_was_forgotten_is_not_drawn(ctx: moderngl.Context) -> None:
    def forgets(made: Stage, view: np.ndarray, paint: Callable[[], None]) -> None:
        made.target.use()
        made.weather.prepare(view, PROJECTION)
        made.weather.forget_drawn()
        paint()
        made.weather.draw(view, PROJECTION)

    assert play(ctx, forgets).std() > 10.0


def test_another_viewport_at_the_draw_counts(ctx: moderngl.Context) -> None:
    def larger(made: Stage, view: np.ndarray, paint: Callable[[], None]) -> None:
        made.target.use()
        made.target.viewport = (0, 0, SIZE[0] // 2, SIZE[1] // 2)
        made.weather.prepare(view, PROJECTION)
        made.target.viewport = (0, 0, *SIZE)
        paint()
        made.weather.draw(view, PROJECTION)

    off = np.abs(play(ctx, after) - play(ctx, larger))
    assert off.mean() < 0.5  # clouds' pictures may have another size


def test_a_world_that_changed_since_is_drawn_as_it_is_now(ctx: moderngl.Context) -> None:
    with stage(ctx, SIZE, quality="medium", seed=3) as made:
        area = esper.create_entity(RainArea(center=(0, 0), radii=(80, 60), rain_rate=90.0))
        made.play(4)
        esper.process(1 / 30)
        view = look_from(HERE, 0.4)
        made.clear()
        made.weather.prepare(view, PROJECTION)
        assert made.weather.stats.containers == 1
        esper.delete_entity(area, immediate=True)
        esper.process(1 / 30)
        made.weather.draw(view, PROJECTION)
        assert made.weather.stats.containers == 0


def test_it_raises_what_draw_raises(ctx: moderngl.Context) -> None:
    with stage(ctx, SIZE) as made:
        with pytest.raises(InvalidValueError, match="view"):
            made.weather.prepare(np.zeros((3, 3)), PROJECTION)
        with pytest.raises(InvalidValueError, match="observer"):
            made.weather.prepare(np.eye(4), PROJECTION, observer="me")  # type: ignore[arg-type]


@pytest.mark.usefixtures("world")
def test_without_opengl_there_is_nothing_to_prepare() -> None:
    with Weather() as weather, pytest.raises(ContextError):
        weather.prepare(np.eye(4), PROJECTION)
