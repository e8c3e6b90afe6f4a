"""Files of clouds that are refused, saves that fail, and the writer's text."""

from __future__ import annotations

import os
import tomllib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.cloud_texts import GOOD, QUICK, plain
from tests.file_values import changed
from tests.toml_files import load, refused
from weather_ecs import (
    CloudFile,
    WeatherFileError,
    load_cloud_model,
    load_clouds,
    save_cloud_model,
    save_clouds,
    toml_scan,
    toml_text,
)
from weather_ecs.cloud_files import LARGEST
from weather_ecs.components import Climate, CloudModel, CloudRoot, CloudSeed

# A change of GOOD, the line and key that the error names, and words of what is allowed.
BAD = [
    ("size_max = 200", "sise_max = 200", 5, "models[0].sise_max", "size_max"),
    ("size_max = 200", "size_max = -1", 5, "models[0].size_max", ">= 0.001"),
    ("size_max = 200", "size_max = true", 5, "models[0].size_max", "a number"),
    ("size_max = 200", "size_max = 30", None, "models[0].size_min", "at most size_max, 30"),
    ("size_max = 200", "size_max = 1979-05-27", 5, "models[0].size_max", "a number"),
    ("size_max = 200", 'images = ["plume"]', 5, "models[0].images", "puff"),
    ('name = "puffy"', "", 3, "models[0].name", "every CloudModel has one"),
    ('name = "flat"', 'name = "puffy"', 19, "models[1].name", "all differ"),
    ("open_pitch = 20.25", "open_pitch = 361", 13, "models[0].seeds[0].roots[0].open_pitch", "360"),
    ("open_pitch = 20.25", "seeds_start = 3000000", 11, "models[0].seeds[0].roots[0]", "1000000"),
    ("width = 250", "width = 0", 16, "models[0].seeds[1].width", ">= 0.001"),
    ("width = 250", "roots = 3", 16, "models[0].seeds[1].roots", "[[models.seeds.roots]]"),
    ("height = 5e-1", "height = nan", 22, "models[1].seeds[0].height", ">= 0.001"),
    ('model = "puffy"', 'model = "fluffy"', 25, "clouds[0].model", "of this file"),
    ("state = 1.0", "state = 0.0", 31, "layers[0].skies", "all differ"),
    ('models = ["flat", ', 'models = ["round", ', 36, "layers[0].skies[1].models", "of this file"),
    ('models = ["flat", ', 'models = [{name = "a"}, ', 36, "layers[0].skies[1].models", "names"),
    ("duration = 120.5", "duration = 0", 40, "climate.duration", "> 0"),
    ("[climate]", "[[climate]]", None, "climate", "a table"),
    ("version = 1", "version = 3", 1, "version", "1 to 2"),
    ("version = 1", "version = 1.0", 1, "version", "1"),
    ("version = 1", "version = true", 1, "version", "1"),
    ("version = 1", "", None, "version", "1"),
    ("version = 1", "version = 1\nfrom = 5", 2, "from", "models"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "line", "key", "allowed"), BAD)
def test_bad_values_are_named_with_line_key_and_what_is_allowed(
    tmp_path, old, new, line, key, allowed
):
    error = refused(tmp_path, GOOD.replace(old, new, 1))
    assert error.key == key
    assert allowed in str(error).partition("allowed: ")[2]
    if line is not None:
        assert error.line == line
        assert f"line {line}, {key}: got " in str(error)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a = 1\nversion = = 1", "not valid TOML.*line 2"),
        ("version = 1\nversion = 1", "not valid TOML"),
        (b"version = 1 # \xff", "UTF-8"),
        ("version = 1\nx = " + "[\n" * 5000 + "]\n" * 5000, "deep"),
        ("a" + ".a" * 500_000 + " = 1", "line 1 has 1000005 characters"),
        ("version = " + "9" * 1900, "version"),
        ("\0", "not valid TOML"),
        ("[[models]]\nname = 'a'\nseeds = []\n", "version"),
        ("version = 1\nmodels = 3", r"models: got 3.*\[\[models\]\]"),
        ("version = 1\nmodels = [3]", r"models\[0\]: got 3.*a table"),
        ("version = 1\n[[models]]\nname = 'a'\nseeds = []", "at least one seed"),
    ],
)
def test_texts_that_are_no_clouds_are_refused(tmp_path, text, words):
    with pytest.raises(WeatherFileError, match=words):
        load(tmp_path, text)


def test_a_hundred_megabytes_are_not_read(tmp_path):
    path = tmp_path / "clouds.toml"
    with open(path, "wb") as stream:
        stream.write(b"version = 1\n# ")
        stream.truncate(100 * 1024 * 1024)
    with pytest.raises(WeatherFileError, match=f"longer than {LARGEST}"):
        load_clouds(path)


def test_files_that_are_not_there_are_refused(tmp_path):
    for path in (tmp_path, tmp_path / "none.toml"):
        with pytest.raises(WeatherFileError, match="no such file"):
            load_clouds(path)
    with pytest.raises(OSError, match="none"):
        save_clouds(tmp_path / "none" / "a.toml", CloudFile())
    assert not list(tmp_path.iterdir())


def test_a_file_of_one_model_has_one(tmp_path):
    path = tmp_path / "clouds.toml"
    for text, count in (("version = 1", 0), (GOOD, 2)):
        path.write_text(text, encoding="utf-8")
        with pytest.raises(WeatherFileError, match=f"got '{count} models'.*one model"):
            load_cloud_model(path)


def test_a_save_that_cannot_be_names_the_file(tmp_path):
    path = tmp_path / "no folder" / "clouds.toml"
    with pytest.raises(FileNotFoundError) as caught:
        save_clouds(path, CloudFile())
    assert caught.value.filename == str(path)


def test_a_failed_save_leaves_the_old_file(tmp_path, monkeypatch):
    path = tmp_path / "clouds.toml"
    path.write_text("mine", encoding="utf-8")

    def fail(*_: object) -> None:
        raise OSError("disk full")

    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(OSError, match="disk full"):
        save_clouds(path, CloudFile())
    assert path.read_text(encoding="utf-8") == "mine"
    assert os.listdir(tmp_path) == ["clouds.toml"]


def test_a_save_keeps_links_and_permissions(tmp_path):
    path, link = tmp_path / "clouds.toml", tmp_path / "link.toml"
    path.write_text("mine", encoding="utf-8")
    path.chmod(0o640)
    link.symlink_to(path)
    save_clouds(link, CloudFile(climate=Climate()))
    assert link.is_symlink()
    assert path.stat().st_mode & 0o777 == 0o640
    assert load_clouds(path).climate is not None


def test_what_could_not_be_read_back_is_not_written(tmp_path):
    seeds = tuple(CloudSeed(roots=(CloudRoot(),) * 8) for _ in range(2000))
    with pytest.raises(WeatherFileError, match="more than"):
        save_cloud_model(tmp_path / "large.toml", CloudModel("large", seeds))
    assert not list(tmp_path.iterdir())


@settings(QUICK, max_examples=250)
@given(changed(GOOD))
def test_changed_files_are_good_or_refused(tmp_path, text):
    data = text.encode("utf-8", "surrogatepass")
    try:
        got = load(tmp_path, data)
    except WeatherFileError:
        return
    path = tmp_path / "again.toml"
    save_clouds(path, got)  # a file that is taken is good from end to end
    assert plain(load_clouds(path).models) == plain(got.models)


@settings(QUICK, max_examples=100)
@given(st.binary(max_size=200))
def test_noise_is_refused_and_nothing_else_happens(tmp_path, data):
    with pytest.raises(WeatherFileError):
        load(tmp_path, data)


TEXT = st.text(max_size=20)
VALUES = st.recursive(
    st.floats(allow_nan=False) | st.integers(-(2**63), 2**63 - 1) | st.booleans() | TEXT,
    lambda inner: st.lists(inner, max_size=3),
    max_leaves=6,
)
KEYS = st.from_regex(r"[A-Za-z_-][A-Za-z0-9_-]{0,8}", fullmatch=True)
TABLES = st.recursive(
    st.dictionaries(KEYS, VALUES, max_size=3),
    lambda inner: st.dictionaries(
        KEYS, VALUES | inner | st.lists(inner, min_size=1, max_size=2), max_size=3
    ),
    max_leaves=5,
)


@settings(QUICK, max_examples=150)
@given(TABLES)
def test_the_writer_writes_what_python_reads(document):
    assert tomllib.loads(toml_text.dumps(document, "two\nlines")) == document


def test_lines_are_those_of_the_keys():
    text = 'a = 1\n[b]\nc = """\n[d]\n"""\nd = 3\n[[e]]\nf = 1\n[[e.g]]\n[[e]]\n[[e.g]]\nh = 2\n'
    for path, line in [
        (("a",), 1),
        (("b", "d"), 6),
        (("e", 0, "f"), 8),
        (("e", 1, "g", 0, "h"), 12),
        (("e", 1, "g", 0, "i"), 11),
        (("e", 0, "g", 0), 9),
        (("z",), None),
    ]:
        assert toml_scan.line_of(text, path) == line


def test_numbers_of_any_kind_are_kept(tmp_path):
    model = CloudModel("a", (CloudSeed((np.float32(0.1), -0.0, 1e-300)),), size_max=1e5)
    save_cloud_model(tmp_path / "a.toml", model)
    assert load_cloud_model(tmp_path / "a.toml").seeds[0].center == (
        float(np.float32(0.1)),
        0,
        1e-300,
    )
