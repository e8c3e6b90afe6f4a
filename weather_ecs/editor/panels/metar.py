"""METAR: a report that an airport has published, what was understood of it, and its weather."""

from __future__ import annotations

from imgui_bundle import imgui

from weather_ecs.editor import theme, whole
from weather_ecs.editor.document import Document
from weather_ecs.editor.panels.weather import put_whole
from weather_ecs.editor.shared import Shared
from weather_ecs.editor.view_bar import tip_of_last
from weather_ecs.errors import MetarError, MissingExtraError
from weather_ecs.metar import LONGEST, MetarReport

EXAMPLE = "EHAM 020825Z 21022KT 190V250 9999 FEW008 SCT018 BKN022 17/15 Q1002"


class MetarPanel:
    """The box for a report."""

    title = "METAR"

    def __init__(self, shared: Shared) -> None:
        self.text = EXAMPLE
        self._read: str | None = None
        self.report: MetarReport | None = None
        self.error = ""

    def draw(self, document: Document, shared: Shared) -> None:
        """The text, a button, and what was understood."""
        imgui.text_colored(theme.vec4(theme.LABEL), "A report as an airport publishes it")
        size = imgui.ImVec2(-1.0, 4.6 * imgui.get_text_line_height())
        flags = imgui.InputTextFlags_.word_wrap
        changed, text = imgui.input_text_multiline("##metar", self.text, size, flags)
        if changed:
            self.text = text
        self.understand(self.text)
        imgui.begin_disabled(self.report is None)
        pressed = imgui.button("Make this the weather", imgui.ImVec2(-1.0, 0.0))
        report = self.report
        if pressed and report and put_whole(document, shared, report.weather):
            shared.say(f"The weather of {report.station}, {report.time} UTC")
        imgui.end_disabled()
        tip_of_last("Layers, climate, rain, wind, air, fog and lightning of the document are set")
        if self.error:
            imgui.push_style_color(imgui.Col_.text, theme.vec4(theme.BAD))
            imgui.text_wrapped(self.error)
            imgui.pop_style_color()
        elif self.report is not None:
            _draw_report(self.report)

    def understand(self, text: str) -> None:
        """Read a text, unless it is the one that was read last."""
        if text == self._read:
            return
        self._read = text
        self.report, self.error = None, ""
        if not text.strip():
            return
        try:
            self.report = whole.read(text[: LONGEST + 1])
        except (MetarError, MissingExtraError) as error:
            self.error = str(error)


def shown(value: object) -> str:
    """A value as a person writes it."""
    return f"{value:g}" if isinstance(value, float) else str(value)


def _draw_report(report: MetarReport) -> None:
    imgui.separator_text(f"{report.station}, {report.time} UTC")
    flags = imgui.TableFlags_.row_bg | imgui.TableFlags_.sizing_stretch_prop
    if imgui.begin_table("understood", 2, flags):
        imgui.table_setup_column("field", 0, 0.38)
        imgui.table_setup_column("value", 0, 0.62)
        for field, value, unit, note in report.understood:
            imgui.table_next_column()
            imgui.text_colored(theme.vec4(theme.LABEL), field.replace("_", " "))
            imgui.table_next_column()
            imgui.text_wrapped(f"{shown(value)} {unit}".rstrip() + (f" ({note})" if note else ""))
        imgui.end_table()
    if report.unused:
        imgui.separator_text("Not used")
        for text, why in report.unused:
            imgui.push_style_color(imgui.Col_.text, theme.vec4(theme.DIM))
            imgui.text_wrapped(f"{text}: {why}")
            imgui.pop_style_color()
