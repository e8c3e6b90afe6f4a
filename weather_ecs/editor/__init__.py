"""The editor: clouds, skies and weather by hand. `python -m weather_ecs.editor [FILE]`.

`document`, `history`, `files`, `clipboard`, `commands` and `fields` know no window and no widgets.
"""
