"""Gamepads, where there are any: sticks and buttons into the controls."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any

from demo_game.input import Controls


class Gamepads:
    """Listens to every gamepad that is there or comes later."""

    def __init__(self, controls: Controls, pause: Callable[[], None]) -> None:
        self._controls, self._pause = controls, pause
        self._open: list[Any] = []
        self._manager: Any = None
        try:
            import pyglet.input

            self._manager = pyglet.input.ControllerManager()
            found = list(self._manager.get_controllers())
        except Exception as error:  # drivers and permissions differ; the game plays without
            logging.getLogger("demo_game").info("no gamepads: %s", error)
            return
        self._manager.push_handlers(on_connect=self._connect, on_disconnect=self._disconnect)
        for controller in found:
            self._connect(controller)

    def close(self) -> None:
        """Let go of all of them."""
        for controller in list(self._open):
            self._disconnect(controller)
        if self._manager is not None:
            self._manager.remove_handlers(on_connect=self._connect, on_disconnect=self._disconnect)
            self._manager = None

    def _connect(self, controller: Any) -> None:
        try:
            controller.open()
        except Exception as error:
            logging.getLogger("demo_game").info("gamepad not opened: %s", error)
            return
        controller.push_handlers(
            on_stick_motion=self._stick,
            on_button_press=self._press,
            on_button_release=self._release,
        )
        self._open.append(controller)

    def _disconnect(self, controller: Any) -> None:
        if controller in self._open:
            self._open.remove(controller)
            controller.close()
            self._controls.clear()

    def _stick(self, controller: Any, name: str, vector: Any) -> None:
        if name == "leftstick":
            self._controls.stick.left = (float(vector.x), float(vector.y))
        elif name == "rightstick":
            self._controls.stick.right = (float(vector.x), float(vector.y))

    def _press(self, controller: Any, button: str) -> None:
        if button == "start":
            self._pause()
        elif button == "a":
            self._controls.stick.jump = True
        elif button in ("leftstick", "leftshoulder", "b"):
            self._controls.stick.run = True

    def _release(self, controller: Any, button: str) -> None:
        if button == "a":
            self._controls.stick.jump = False
        elif button in ("leftstick", "leftshoulder", "b"):
            self._controls.stick.run = False
