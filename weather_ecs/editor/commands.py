"""The commands of the editor: what menus show, with the keys that do the same.

The window binds what each does, draws its menus from `menus()` and gives it the keys:

    commands = Commands()
    commands.bind("save", self.save, enabled=lambda: self.document.dirty)
    for title, group in commands.menus():
        for command in group:                       # None is a line between groups
            if command is not None and imgui.menu_item(
                commands.label(command.name), command.keys, False, commands.is_enabled(command.name)
            )[0]:
                commands.run(command.name)
    commands.press("S", ctrl=True)                  # from on_key_press; whether it was one
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Command:
    """One thing to do."""

    name: str
    menu: str
    label: str
    keys: str = ""  # as menus show it: Ctrl+Shift+S
    help: str = ""
    group: int = 0  # a line is drawn between two groups of a menu
    other_keys: tuple[str, ...] = ()  # which do the same


COMMANDS = (
    Command("new", "File", "New", "Ctrl+N", "An empty file"),
    Command("open", "File", "Open...", "Ctrl+O", "A file, which may also be dropped on the window"),
    Command("reload", "File", "Reload from disk", "Ctrl+R", "Take what the file has become", 1),
    Command("save", "File", "Save", "Ctrl+S", "Comments in the file stay", 1),
    Command("save_as", "File", "Save as...", "Ctrl+Shift+S", "Write to another file", 1),
    Command("still", "File", "Export still...", "Ctrl+E", "The view as a picture", 2),
    Command("turntable", "File", "Export turntable...", "", "A film once round the cloud", 2),
    Command("impostors", "File", "Export impostor sheet...", "", "Pictures from all sides", 2),
    Command("quit", "File", "Quit", "Ctrl+Q", "Asks where something is not saved", 3),
    Command("undo", "Edit", "Undo", "Ctrl+Z", "Take the last change back"),
    Command("redo", "Edit", "Redo", "Ctrl+Y", "Do it again", other_keys=("Ctrl+Shift+Z",)),
    Command("cut", "Edit", "Cut", "Ctrl+X", "The chosen seed, root, model or other part", 1),
    Command("copy", "Edit", "Copy", "Ctrl+C", "As text, which any program can hold", 1),
    Command("paste", "Edit", "Paste", "Ctrl+V", "Behind what is chosen", 1),
    Command("duplicate", "Edit", "Duplicate", "Ctrl+D", "One more like what is chosen", 1),
    Command("delete", "Edit", "Delete", "Delete", "Take it away", 1),
    Command("generate", "Cloud", "Generate again", "Ctrl+G", "Another cloud of the same model"),
    Command("billboards", "Cloud", "Billboards", "1", "Show the cloud itself", 1),
    Command("boxes", "Cloud", "Seed boxes", "2", "Show its seeds", 1),
    Command("rays", "Cloud", "CFA rays", "3", "Show where light is absorbed", 1),
    Command("roots", "Cloud", "Roots", "4", "Show them as arrows with their opening", 1),
    Command("move", "Cloud", "Move seeds", "W", "Arrows to drag a seed by", 2),
    Command("size", "Cloud", "Size seeds", "E", "Handles to size a seed by", 2),
    Command("frame", "Cloud", "Whole cloud in view", "F", "Bring the camera back", 2),
    Command("run", "Simulation", "Run or pause", "Space", "Let the weather go on"),
    Command("step", "Simulation", "Step", ".", "One second of weather"),
    Command("rewind", "Simulation", "To the start", "Home", "Back to the first moment"),
    Command("cloud_view", "View", "Cloud", "F2", "One cloud model and its parts"),
    Command("sky_view", "View", "Sky and weather", "F3", "The world, from the ground and above"),
    Command("help", "Help", "Keys and mouse", "F1", "This list"),
)
_ORDER = ("Ctrl", "Shift", "Alt")


class Commands:
    """What the commands do in a window."""

    def __init__(self, commands: tuple[Command, ...] = COMMANDS) -> None:
        self._all = {command.name: command for command in commands}
        self._does: dict[str, Callable[[], object]] = {}
        self._enabled: dict[str, Callable[[], bool]] = {}
        self._labels: dict[str, Callable[[], str]] = {}
        self._keys = {
            _plain(keys): command.name
            for command in commands
            for keys in (command.keys, *command.other_keys)
            if keys
        }

    def __getitem__(self, name: str) -> Command:
        return self._all[name]

    def bind(
        self,
        name: str,
        does: Callable[[], object],
        *,
        enabled: Callable[[], bool] | None = None,
        label: Callable[[], str] | None = None,
    ) -> None:
        """Say what a command does, when it can, and what it is called at the moment.

        Raises KeyError for a name that is none.
        """
        self._all[name]
        self._does[name] = does
        if enabled is not None:
            self._enabled[name] = enabled
        if label is not None:
            self._labels[name] = label

    def menus(self) -> Iterator[tuple[str, list[Command | None]]]:
        """Titles and commands of the menus; None stands for a line. What is not bound is absent."""
        for title in dict.fromkeys(command.menu for command in self._all.values()):
            found: list[Command | None] = []
            last: int | None = None
            for command in self._all.values():
                if command.menu == title and command.name in self._does:
                    if last is not None and command.group != last:
                        found.append(None)
                    found.append(command)
                    last = command.group
            if found:
                yield title, found

    def label(self, name: str) -> str:
        """What a command is called at the moment, such as Undo with what it takes back."""
        special = self._labels.get(name)
        return self._all[name].label if special is None else special()

    def is_enabled(self, name: str) -> bool:
        """Whether it does anything at the moment."""
        if name not in self._does:
            return False
        enabled = self._enabled.get(name)
        return enabled is None or enabled()

    def run(self, name: str) -> bool:
        """Do it, if it can be done; whether it was."""
        if not self.is_enabled(name):
            return False
        self._does[name]()
        return True

    def press(
        self, key: str, *, ctrl: bool = False, shift: bool = False, alt: bool = False
    ) -> bool:
        """A key was pressed: run its command; whether there is one, also if it cannot be done."""
        down = [name for name, on in zip(_ORDER, (ctrl, shift, alt), strict=True) if on]
        name = self._keys.get(_plain("+".join([*down, key])))
        if name is None or name not in self._does:
            return False
        self.run(name)
        return True


def _plain(keys: str) -> str:
    *down, key = keys.replace("++", "+plus").split("+")
    return "+".join([*sorted(part.lower() for part in down), key.lower()])
