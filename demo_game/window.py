"""The window: events in, pictures out. Import it only where there is a display."""

from __future__ import annotations

import time as clock
from typing import Any, Unpack

import moderngl
import pyglet
from pyglet.window import key

from demo_game.beginning import Beginning
from demo_game.game import Game
from demo_game.gamepad import Gamepads
from demo_game.input import Controls
from demo_game.pictures import save_screenshot
from demo_game.play_keys import play_key
from demo_game.preparing import prepare_place
from demo_game.preparing_screen import PreparingScreen
from demo_game.screens import Screen, Screens
from demo_game.settings import Settings
from demo_game.sound import WalkSound
from demo_game.ui.minimap import map_place
from demo_game.ui.overlay import Overlay
from demo_game.ui.surface import prepare_for_pyglet, read_pixels

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
        **beginning: Unpack[Beginning],
    ) -> None:
        self.ready = False
        self._preparing = PreparingScreen(self)
        super().__init__(
            *size, caption=TITLE, resizable=True, vsync=True, config=config, visible=False
        )
        try:
            self._begin(settings, beginning)
        except BaseException:
            super().close()
            raise

    def _begin(self, settings: Settings, beginning: Beginning) -> None:
        self.set_minimum_size(*SMALLEST)
        self.settings = settings
        self.controls = Controls()
        if settings.fullscreen:
            self.set_fullscreen(True)
        self.set_visible(True)
        self.switch_to()
        self._gl = moderngl.get_context()
        seed = beginning.get("seed", 0)
        place = prepare_place(seed, self._preparing.keep_alive)
        self.switch_to()
        self.game = Game(self._gl, settings, place=place, **beginning)
        self.sound = WalkSound(self.game, settings, seed)
        self.screens = Screens(settings, self)
        self.overlay = Overlay(self.screens.menu, map_place(self.game.place))
        self._gamepads = Gamepads(self.controls, pause=self.screens.toggle_pause)
        self._ms = 16.0
        self._last = clock.perf_counter()
        self._wants_picture = False
        self.ready = True
        self._lay_out()

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
        self.screens.frame()
        self.overlay.update(dt)
        shown = self.screens.shown
        if shown is Screen.PLAY:
            self.game.player.look(*self.controls.turn(dt))
            self.game.update(dt, self.controls.intent())
            self._follow_letter()
        elif shown in (Screen.START, Screen.END):
            self.game.update(dt)
        self.sound.update(dt, paused=self.screens.shown in (Screen.PAUSE, Screen.HELP))
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
        self.overlay.draw(self.screens.shown, self.game, self._ms)
        if self._wants_picture:
            self._wants_picture = False
            self.overlay.say(f"Saved {save_screenshot(read_pixels(width, height))}")

    def _follow_letter(self) -> None:
        news = self.game.take_news()
        if news:
            self.overlay.say(news)
        if self.game.letter.ended:
            self.screens.end()

    # What the screens ask

    def screen_changed(self, screen: Screen) -> None:
        """Another screen is shown: the mouse is the player's, or free."""
        self.controls.clear()
        self.set_exclusive_mouse(screen is Screen.PLAY)

    def new_letter(self) -> None:
        """Begin anew."""
        self.game.again()

    def settings_changed(self, field: str) -> None:
        """A setting has another value."""
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
            self._preparing.closed = self._preparing.closed or name == "ESCAPE"
        elif name == "F1":
            self.screens.toggle_help()
        elif name == "F3":
            self.overlay.show_readout = not self.overlay.show_readout
        elif name == "F11":
            self.settings.fullscreen = not self.settings.fullscreen
            self.settings_changed("fullscreen")
        elif name == "F12":
            self._wants_picture = True
        elif self.screens.shown is not Screen.PLAY:
            self.screens.key(name)
        elif name == "ESCAPE":
            self.screens.pause()
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

    def on_mouse_motion(self, x: int, y: int, dx: int, dy: int) -> None:
        """Look, or point at a row of the menu."""
        if not self.ready:
            return
        if self.screens.shown is Screen.PLAY:
            speed = self.settings.look_speed
            rise = -dy if self.settings.invert else dy
            self.game.player.look(-dx * speed, rise * speed)
        elif self.screens.shown is Screen.PAUSE:
            self.screens.point(x, y, self.overlay.pause_view.row_at(x, y))

    def on_mouse_drag(self, x: int, y: int, dx: int, dy: int, buttons: int, modifiers: int) -> None:
        """The same with a button held."""
        self.on_mouse_motion(x, y, dx, dy)

    def on_mouse_press(self, x: int, y: int, button: int, modifiers: int) -> None:
        """Begin, choose, begin anew, or close the help page."""
        if self.ready:
            view = self.overlay.pause_view
            self.screens.click(view.row_at(x, y), view.side_at(x))

    def on_deactivate(self) -> None:
        """Another window has the keys now."""
        if self.ready:
            self.controls.clear()
            self.screens.pause()

    def on_resize(self, width: int, height: int) -> None:
        """Lay out for the new size; a minimised window has none."""
        super().on_resize(width, height)
        if self.ready:
            self._lay_out()

    def on_close(self) -> None:
        """The window's own close button."""
        if self.ready:
            self.close()
        self._preparing.closed = True

    def _lay_out(self) -> None:
        if self.width >= 1 and self.height >= 1:
            ratio = self.get_framebuffer_size()[0] / self.width
            self.overlay.resize(self.width, self.height, ratio)
