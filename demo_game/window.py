"""The window: events in, pictures out. Import it only where there is a display."""

from __future__ import annotations

import time as clock
from typing import Any

import moderngl
import pyglet
from pyglet.window import key

from demo_game.game import START, Game
from demo_game.gamepad import Gamepads
from demo_game.input import Controls
from demo_game.pictures import save_screenshot
from demo_game.play_keys import play_key
from demo_game.preparing import prepare_place
from demo_game.screen_keys import screen_click, screen_key
from demo_game.settings import Settings
from demo_game.sound import WalkSound
from demo_game.ui.menu import MenuActions, MouseRest, pause_menu
from demo_game.ui.minimap import map_place
from demo_game.ui.overlay import Overlay, Screen
from demo_game.ui.preparing import PreparingView
from demo_game.ui.surface import prepare_for_pyglet, read_pixels
from demo_game.ui.theme import Frame

TITLE = "The Walk"
LONGEST_DT = 0.25  # s; a pause of the machine does not move the player on
FASTEST = 1.0 / 120.0  # s between frames where the display does not set the pace
SMALLEST = (320, 200)


class GameWindow(pyglet.window.Window):
    """The game in a window."""

    def __init__(
        self,
        settings: Settings,
        config: Any = None,
        *,
        size: tuple[int, int] = (1280, 720),
        seed: int = 0,
        preset: str = "heavy",
        start: tuple[float, float] = START,
        metar: str | None = None,
        watch: bool = False,
    ) -> None:
        self.screen_shown = Screen.START
        self.ready = False
        self._closed_early = False
        self._prepared = (0, 0, 0)
        super().__init__(
            *size, caption=TITLE, resizable=True, vsync=True, config=config, visible=False
        )
        try:
            self._begin(settings, seed, preset, start, metar, watch)
        except BaseException:
            super().close()
            raise

    def _begin(
        self,
        settings: Settings,
        seed: int,
        preset: str,
        start: tuple[float, float],
        metar: str | None,
        watch: bool,
    ) -> None:
        self.set_minimum_size(*SMALLEST)
        self.settings = settings
        self.controls = Controls()
        if settings.fullscreen:
            self.set_fullscreen(True)
        self.set_visible(True)
        self.switch_to()
        self._gl = moderngl.get_context()
        place = prepare_place(seed, self._draw_preparing)
        self.switch_to()
        self.game = Game(
            self._gl,
            settings,
            place=place,
            seed=seed,
            preset=preset,
            start=start,
            metar=metar,
            watch=watch,
        )
        self.sound = WalkSound(self.game, settings, seed)
        self.menu = pause_menu(
            settings,
            MenuActions(
                resume=self.resume,
                settings_changed=self._settings_changed,
                again=self.again,
                help=self._open_help,
                quit=self.close,
            ),
        )
        self._help_from = Screen.PAUSE
        self._end_seen = False
        self._mouse_rest = MouseRest()
        self.overlay = Overlay(self.menu, map_place(self.game.place))
        self._gamepads = Gamepads(self.controls, pause=self._toggle_pause)
        self._ms = 16.0
        self._last = clock.perf_counter()
        self._wants_picture = False
        self.ready = True
        self._lay_out()

    def _draw_preparing(self, seconds: float) -> bool:
        self.dispatch_events()
        state = (self.width, self.height, int(seconds * 2))
        if self._closed_early or self.width < 1 or self.height < 1 or state == self._prepared:
            return not self._closed_early
        self._prepared = state
        self.switch_to()
        prepare_for_pyglet(self)
        view = PreparingView(Frame(self.width, self.height))
        view.draw(seconds)
        view.delete()
        self.flip()
        return True

    def play(self) -> None:
        """Run until the window is closed."""
        pyglet.clock.schedule_interval(self.frame, FASTEST)
        pyglet.app.run(interval=None)

    def shut(self) -> None:
        """Give everything back; a second call does nothing."""
        pyglet.clock.unschedule(self.frame)
        if not self.ready:
            return
        self.ready = False
        self._gamepads.close()
        self.sound.close()
        if self.context is not None:
            self.switch_to()
            self.overlay.delete()
            self.game.close()
            super().close()

    def close(self) -> None:
        """Close the window; the game's own things go first."""
        if self.ready:
            self.shut()
        elif self.context is not None:
            super().close()

    # One frame

    def frame(self, dt: float) -> None:
        """Update and draw once."""
        if not self.ready:
            return
        dt = min(max(dt, 0.0), LONGEST_DT)
        self._mouse_rest.frame()
        self.overlay.update(dt)
        if self.screen_shown is Screen.PLAY:
            self.game.player.look(*self.controls.turn(dt))
            self.game.update(dt, self.controls.intent())
            self._follow_letter()
        elif self.screen_shown in (Screen.START, Screen.END):
            self.game.update(dt)
        self.sound.update(dt, paused=self.screen_shown in (Screen.PAUSE, Screen.HELP))
        self.draw(dt)

    def on_draw(self) -> None:
        """Draw the place, the rain, and what lies over them."""
        width, height = self.get_framebuffer_size()
        if not self.ready or width < 1 or height < 1:
            return
        now = clock.perf_counter()
        self._ms += 0.08 * ((now - self._last) * 1000.0 - self._ms)
        self._last = now
        screen = self._gl.detect_framebuffer(0)
        screen.viewport = (0, 0, width, height)
        self.game.draw(screen)
        prepare_for_pyglet(self)
        self.overlay.draw(self.screen_shown, self.game, self._ms)
        if self._wants_picture:
            self._wants_picture = False
            self.overlay.say(f"Saved {save_screenshot(read_pixels(width, height))}")

    def _follow_letter(self) -> None:
        news = self.game.take_news()
        if news:
            self.overlay.say(news)
        if self.game.letter.ended and not self._end_seen:
            self._end_seen = True
            self._show(Screen.END)

    # Screens

    def again(self) -> None:
        """Begin anew, with another letter."""
        self.game.again()
        self._end_seen = False
        self.resume()

    def resume(self) -> None:
        """Go on playing."""
        self._show(Screen.PLAY)

    def pause(self) -> None:
        """Stop and show the menu; from the start screen or the help page nothing changes."""
        if self.screen_shown is Screen.PLAY:
            self.menu.chosen = 0
            self._show(Screen.PAUSE)

    def _toggle_pause(self) -> None:
        if self.screen_shown is Screen.PLAY:
            self.pause()
        elif self.screen_shown is Screen.END:
            self.again()
        else:
            self.resume()

    def _open_help(self) -> None:
        self._help_from = self.screen_shown
        self._show(Screen.HELP)

    def _show(self, screen: Screen) -> None:
        self.screen_shown = screen
        self._mouse_rest = MouseRest()
        self.controls.clear()
        self.set_exclusive_mouse(screen is Screen.PLAY)

    def _settings_changed(self, field: str) -> None:
        if field == "fullscreen":
            self.set_fullscreen(self.settings.fullscreen)
        else:
            self.switch_to()
            self.game.settings_changed(field)

    # Events

    def on_key_press(self, symbol: int, modifiers: int) -> bool:
        """A key for the screen that is shown, or for any of them."""
        name = key.symbol_string(symbol)
        if not self.ready:
            self._closed_early = self._closed_early or name == "ESCAPE"
        elif name == "F1":
            self.back() if self.screen_shown is Screen.HELP else self._open_help()
        elif name == "F3":
            self.overlay.show_readout = not self.overlay.show_readout
        elif name == "F11":
            self.settings.fullscreen = not self.settings.fullscreen
            self._settings_changed("fullscreen")
        elif name == "F12":
            self._wants_picture = True
        elif self.screen_shown is not Screen.PLAY:
            screen_key(name, self)
        elif name == "ESCAPE":
            self.pause()
        else:
            answer = play_key(name, self.game, self.overlay)
            if answer is None:
                self.controls.press(name)
            elif answer:
                self.overlay.say(answer)
        return True  # pyglet's own handler closes the window on Escape

    def on_key_release(self, symbol: int, modifiers: int) -> None:
        """A key came up."""
        self.controls.release(key.symbol_string(symbol))

    def back(self) -> None:
        """From the help page to what was there before."""
        self._show(self._help_from)

    def on_mouse_motion(self, x: int, y: int, dx: int, dy: int) -> None:
        """Look, or point at a row of the menu."""
        if not self.ready:
            return
        if self.screen_shown is Screen.PLAY:
            speed = self.settings.look_speed
            rise = -dy if self.settings.invert else dy
            self.game.player.look(-dx * speed, rise * speed)
        elif self.screen_shown is Screen.PAUSE and self._mouse_rest.moved(x, y):
            self.menu.point(self.overlay.pause_view.row_at(x, y))

    def on_mouse_drag(self, x: int, y: int, dx: int, dy: int, buttons: int, modifiers: int) -> None:
        """The same with a button held."""
        self.on_mouse_motion(x, y, dx, dy)

    def on_mouse_press(self, x: int, y: int, button: int, modifiers: int) -> None:
        """Begin, choose, begin anew, or close the help page."""
        if self.ready:
            view = self.overlay.pause_view
            screen_click(self, view.row_at(x, y), view.side_at(x))

    def on_deactivate(self) -> None:
        """Another window has the keys now."""
        if self.ready:
            self.controls.clear()
            self.pause()

    def on_resize(self, width: int, height: int) -> None:
        """Lay out for the new size; a minimised window has none."""
        super().on_resize(width, height)
        if self.ready:
            self._lay_out()

    def on_close(self) -> None:
        """The window's own close button."""
        if self.ready:
            self.close()
        self._closed_early = True

    def _lay_out(self) -> None:
        if self.width >= 1 and self.height >= 1:
            ratio = self.get_framebuffer_size()[0] / self.width
            self.overlay.resize(self.width, self.height, ratio)
