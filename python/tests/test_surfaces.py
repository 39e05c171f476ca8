"""Surfaces: files, preparation, statistics, generators."""

from __future__ import annotations

import io
import json
import pickle
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from conftest import DATA
from numpy.typing import NDArray

import asperity as asp
from asperity.errors import FileError, MissingFileError

FILES = DATA / "surface_files"
COLUMN, ROW = np.meshgrid(np.arange(7), np.arange(5))
NANOMETRES = 100 * COLUMN + 17 * ROW**2 - 3 * COLUMN * ROW - 250.0
# What a file does not say, by extension.
OPEN: dict[str, dict[str, object]] = {
    ".npy": {"size": (14e-6, 15e-6), "height_unit": "m"},
    ".asc": {"size": (14e-6, 15e-6), "height_unit": "m"},
    ".csv": {"size": (14e-6, 15e-6), "height_unit": "m"},
    ".xyz": {"height_unit": "m", "lateral_unit": "m"},
    # Their pixels are square, or not the same in float32.
    ".dat": {"size": (14e-6, 15e-6)},
    ".opd": {"size": (14e-6, 15e-6)},
}


def expected(name: str) -> NDArray[np.float64]:
    z = NANOMETRES * 1e-9
    if name.startswith("profile"):
        # The first row, the third point of which is missing but in texts that have no sign for that.
        z = z[:1]
        if not name.endswith((".prf", ".smd")):
            z[0, 2] = np.nan
    z += {"plain_i32_offset.sur": 500e-9, "missing_u32.vk4": 300e-9, "missing_u32.vk6": 300e-9}.get(name, 0.0)
    if name.startswith(("missing", "masked")):
        z[1, 2] = z[4, 6] = np.nan
    return z


@pytest.mark.parametrize("name", sorted(file.name for file in FILES.iterdir()))
@pytest.mark.filterwarnings("ignore::asperity.AsperityWarning")
def test_every_format(name: str) -> None:
    options = dict(OPEN.get(Path(name).suffix, {}))
    surface = asp.read(FILES / name, **options)
    heights = expected(name)
    assert surface.shape == heights.shape
    assert surface.missing == np.isnan(heights).sum()
    # Seven digits in texts, float32 in .gsf and .al3d: of a height below 0.8 um.
    np.testing.assert_allclose(surface.z, heights, rtol=0, atol=1e-13)
    # Seven digits in texts as well. A profile is as wide as its steps.
    assert surface.size == pytest.approx((14e-6, 2e-6 if len(heights) == 1 else 15e-6), rel=1e-6)
    from_bytes = asp.read((FILES / name).read_bytes(), name=name, **options)
    from_object = asp.read(io.BytesIO((FILES / name).read_bytes()), name=name, **options)
    with (FILES / name).open("rb") as file:
        from_file = asp.read(file, **options)
    assert surface == from_bytes == from_object == from_file


def test_formats_are_listed_with_their_endings() -> None:
    formats = asp.formats()
    assert formats["Keyence"] == ["vk4", "vk6", "vk7"] and formats["text"] == ["txt", "asc", "csv", "xyz"]
    endings = {ending for of in formats.values() for ending in of}
    assert {Path(file).suffix[1:] for file in FILES.iterdir()} <= endings


def test_masks_and_channels() -> None:
    with pytest.warns(asp.AsperityWarning, match="2 nodes that a mask marks"):
        masked = asp.read(FILES / "masked.gwy")
    assert masked.missing == 2 and any("mask" in note for note in masked.notes)
    assert asp.read(FILES / "masked.gwy", ignore_mask=True).missing == 0
    names = asp.channels(FILES / "masked.gwy")
    assert len(names) >= 1
    with pytest.raises(FileError) as refused:
        asp.read(FILES / "masked.gwy", channel="nonsense")
    assert refused.value.kind == "WhichChannel" and refused.value.channels == names
    assert refused.value.wanted == "nonsense"


def test_a_text_says_how_it_was_understood() -> None:
    list_of_points = FILES.parent / "text_files" / "index_column.csv"
    with pytest.warns(asp.AsperityWarning, match="of 4 columns 2, 3 and 4 are read"):
        surface = asp.read(list_of_points)
    assert surface.understood.startswith("108 points, columns x [um], y [um], z [um] by name")
    assert pickle.loads(pickle.dumps(surface)).understood == surface.understood
    plane = b"".join(b"%d %d %d %d %d\n" % tuple(range(k, k + 5)) for k in range(5))
    with pytest.raises(FileError, match="`layout=`"):
        asp.read(plane, size=1.0, height_unit="m")
    with pytest.warns(asp.AsperityWarning, match="square"):
        below = asp.read(plane, size=1.0, height_unit="m", layout="x-row")
    assert below.shape == (4, 5)
    with pytest.raises(ValueError, match="'rows' is no layout"):
        asp.read(plane, layout="rows")  # type: ignore[arg-type]


def test_what_a_file_leaves_open_is_asked_for() -> None:
    with pytest.warns(asp.AsperityWarning), pytest.raises(FileError) as refused:
        asp.read(FILES / "missing.npy")
    assert refused.value.kind == "NoSide" and "`size=`" in str(refused.value)
    with pytest.warns(asp.AsperityWarning) as warned:
        asp.read(FILES / "missing.npy", size=14e-6)
    words = [str(warning.message) for warning in warned]
    assert any("no unit" in sentence for sentence in words) and any("square" in sentence for sentence in words)
    # The warning is of the line that called.
    assert all(warning.filename == __file__ for warning in warned)


def test_files_that_are_none(tmp_path: Path) -> None:
    with pytest.raises(MissingFileError) as missing:
        asp.read(tmp_path / "nothing.sdf")
    assert isinstance(missing.value, FileNotFoundError) and isinstance(missing.value, ValueError)
    assert missing.value.filename == str(tmp_path / "nothing.sdf") and missing.value.errno == 2
    (tmp_path / "noise.bin").write_bytes(bytes(range(256)))
    with pytest.raises(OSError) as unknown:
        asp.read(tmp_path / "noise.bin")
    assert unknown.value.kind == "UnknownFormat" and unknown.value.begins == list(range(8))
    broken = (FILES / "plain.gsf").read_bytes()[:-3]
    with pytest.raises(FileError) as bad:
        asp.read(broken, name="cut.gsf")
    assert bad.value.kind == "BadFile" and bad.value.filename == "cut.gsf"
    with pytest.raises(OSError):
        asp.read(tmp_path)
    for source in [3, None, object(), ["a"]]:
        with pytest.raises(asp.AsperityError):
            asp.read(source)
    with pytest.raises(asp.AsperityError, match="binary"):
        asp.read(io.StringIO("1 2\n3 4"))
    assert asp.read(bytearray((FILES / "plain.gsf").read_bytes())) == asp.read(FILES / "plain.gsf")
    assert asp.read(memoryview((FILES / "plain.gsf").read_bytes())) == asp.read(FILES / "plain.gsf")


def test_files_are_written_and_read_again(tmp_path: Path) -> None:
    surface = asp.example_surface(nodes=32)
    surface.save(tmp_path / "z.x3p")
    np.testing.assert_array_equal(asp.read(tmp_path / "z.x3p").z, surface.z)
    surface.save(tmp_path / "z.npy")
    np.testing.assert_array_equal(np.load(tmp_path / "z.npy").T, surface.z)
    surface.save(tmp_path / "z.gsf")
    # float32.
    np.testing.assert_allclose(asp.read(tmp_path / "z.gsf").z, surface.z, rtol=1e-7)
    with pytest.raises(FileError, match="cannot be written with this extension") as unknown:
        surface.save(tmp_path / "z.tiff")
    assert unknown.value.filename == str(tmp_path / "z.tiff")
    with pytest.raises(OSError):
        surface.save(tmp_path / "no folder" / "z.npy")


def test_statistics_are_those_of_the_program(program: Callable[..., str], tmp_path: Path) -> None:
    """Every number that `asperity info --json` prints of a surface and Python has too."""
    surface = asp.example_surface(nodes=64, seed=3)
    surface.save(tmp_path / "z.npy")
    told = json.loads(program("info", tmp_path / "z.npy", "--side", "1e-2", "--json", "--out", tmp_path))
    known = {name: getattr(surface, name) for name in ("missing", "sa", "sq", "sz", "rms_gradient")}
    known |= {"min": surface.z.min(), "max": surface.z.max()}
    for name, value in known.items():
        assert told[name] == value, name
    texture = surface.areal_parameters()
    for name, value in told["texture"].items():
        assert value == getattr(texture, name), name


def test_statistics_are_those_of_their_definitions() -> None:
    z = asp.example_surface(nodes=48, seed=5).z
    surface = asp.Surface(z, (1e-2, 2e-2))
    d = z - z.mean()
    # Rounding of sums over 2304 heights.
    close = {"rel": 1e-12}
    assert surface.sq == pytest.approx(np.sqrt(np.mean(d**2)), **close)
    assert surface.sa == pytest.approx(np.mean(np.abs(d)), **close)
    assert surface.sz == z.max() - z.min()
    assert surface.ssk == pytest.approx(np.mean(d**3) / np.mean(d**2) ** 1.5, rel=1e-9)
    assert surface.sku == pytest.approx(np.mean(d**4) / np.mean(d**2) ** 2, **close)
    slopes = (np.diff(z, axis=1) / (1e-2 / 48), np.diff(z, axis=0) / (2e-2 / 48))
    along = tuple(np.sqrt(np.mean(s**2)) for s in slopes)
    assert surface.rms_slopes == pytest.approx(along, **close)
    assert surface.rms_gradient == pytest.approx(np.hypot(*along), **close)
    assert surface.rms_curvature == pytest.approx(surface.rms_laplacian / 2, **close)
    moments = surface.moments()
    assert moments.rms_height == pytest.approx(surface.sq, **close)
    assert moments.nayak_parameter == pytest.approx(moments.m0 * moments.m4 / moments.m2**2, **close)
    spectrum = surface.psd()
    assert spectrum.wavevector.shape == spectrum.density.shape == spectrum.waves.shape
    assert np.all(np.diff(spectrum.wavevector) > 0)
    assert len(surface.psd(10).density) > 5
    edges = surface.psd([300.0, 3000.0, 30000.0])
    assert len(edges.density) <= 2
    along_x, along_y = surface.psd_along("x"), surface.psd_along("y")
    assert along_x.wavevector[0] == pytest.approx(2 * np.pi / 1e-2, **close)
    assert along_y.wavevector[0] == pytest.approx(2 * np.pi / 2e-2, **close)
    fit = asp.example_surface(nodes=128).fit_self_affine()
    assert fit.hurst.value == pytest.approx(0.8, abs=0.05) and fit.rolloff_wavelength is not None
    full = surface.full_contact_pressure(115e9)
    assert full.shape == z.shape and abs(full.mean()) < 1e-9 * full.max()
    shortest, longest = surface.bandwidth
    assert shortest < longest


def test_what_looks_wrong_is_said() -> None:
    surface = asp.example_surface(nodes=64)
    assert surface.check() == []
    steep = surface.scaled(1e3)
    assert any("units" in sentence for sentence in steep.check())
    tilted = asp.Surface(surface.z + 1e-3 * np.arange(64), surface.size)
    assert any('Surface.level("plane")' in sentence for sentence in tilted.check())
    assert tilted.level().check() == []
    np.testing.assert_allclose(tilted.level().z, surface.level().z, atol=1e-15)


def test_a_tilt_is_taken_off_before_holes_are_filled() -> None:
    """The trend is that of the measured nodes, and they are as level as without holes."""
    rows, columns = np.mgrid[0:48, 0:64]
    tilt = 1e-6 * columns - 2e-6 * rows
    holes = tilt.copy()
    holes[10:30, 40:] = np.nan
    surface = asp.Surface(holes, size=(6.4e-4, 4.8e-4))
    assert surface.trend().slopes == pytest.approx((0.1, -0.2), rel=1e-9)
    level = surface.level("plane")
    np.testing.assert_array_equal(np.isnan(level.z), np.isnan(holes))
    filled = level.fill_missing()
    assert filled.missing == 0
    # Rounding of a tilt of 0.1 mm.
    assert np.abs(filled.z).max() < 1e-17
    # Without holes it is what it was.
    whole = asp.Surface(tilt + 1e-9 * np.sin(rows * columns), surface.size)
    assert whole.level("quadratic").trend("quadratic").tilt < 1e-12
    with pytest.raises(asp.AsperityError) as nothing:
        asp.Surface(np.full((3, 4), np.nan), (1.0, 1.0)).level()
    assert nothing.value.kind == "NothingMeasured"


def test_preparation() -> None:
    surface = asp.example_surface(nodes=64)
    long, short = surface.low_pass(1e-3), surface.high_pass(1e-3)
    np.testing.assert_allclose(long.z + short.z, surface.z, atol=1e-18)
    fine = surface.resample((128, 96), method="fourier")
    assert fine.shape == (128, 96) and fine.size == pytest.approx(surface.size)
    assert fine.sq == pytest.approx(surface.sq, rel=1e-6)
    assert surface.window("hann").sq != surface.sq
    with pytest.raises(asp.AsperityError) as refused:
        surface.window("tukey", 1.5)
    assert refused.value.kind == "OutOfRange" and refused.value.value == 1.5
    for call in [
        lambda: surface.level("cubic"),
        lambda: surface.flip("z"),
        lambda: surface.low_pass(1e-3, "boxcar"),
        lambda: surface.resample((8, 8), method="nearest"),
        lambda: surface.window("kaiser"),
        lambda: surface.psd("octaves"),
        lambda: surface.psd(-1),
        lambda: surface.psd(True),
        lambda: surface.psd(2.5),  # type: ignore[arg-type]
    ]:
        with pytest.raises(asp.AsperityError, match="must be"):
            call()
    with pytest.raises(asp.AsperityError) as out:
        surface.crop(rows=(0, 65))
    assert out.value.kind == "CropOutOfGrid" and out.value.axis == "y"
    with pytest.raises(asp.AsperityError, match=r"from 0 to 18446744073709551615 here, but this is \(-3, 5\)"):
        surface.crop(rows=(-3, 5))
    with pytest.raises(TypeError, match="first, behind the last"):
        surface.crop(columns=3)  # type: ignore[arg-type]
    with pytest.raises(asp.AsperityError) as out:
        surface + fine
    assert out.value.kind == "GridMismatch"
    # Rows and columns, as of arrays.
    assert (out.value.expected, out.value.found) == (surface.shape, fine.shape)
    assert "expected 64 rows x 64 columns, but found 128 x 96" in str(out.value)


def test_pieces_without_holes() -> None:
    """A hole is not in every piece."""
    z = np.random.default_rng(3).standard_normal((20, 30))
    z[0, 0] = np.nan
    surface = asp.Surface(z, size=(3.0, 2.0))
    piece = surface.crop((5, 20), (5, 20))
    assert piece.missing == 0 and np.array_equal(piece.z, z[5:20, 5:20]) and piece.sq > 0
    assert surface.crop((0, 3)).missing == 1 and surface.crop((0, 3)).shape == (3, 30)
    with pytest.raises(asp.AsperityError) as out:
        surface.crop(columns=(0, 31))
    assert out.value.kind == "CropOutOfGrid"


def test_what_still_repeats() -> None:
    """Steps that treat the border as an end leave open whether a surface repeats."""

    class Topography:
        physical_sizes, unit, is_periodic = (1e-3, 1e-3), "m", True

        def heights(self) -> np.ndarray:
            return asp.wave(1e-6, 1e-3 / 4, (32, 32), 1e-3).z

    surface = asp.Surface(Topography())
    assert surface.is_periodic
    for kept in (surface.level("mean"), surface.low_pass(2e-4, "sharp"), surface.resample((64, 64), "fourier"), -surface):
        assert kept.is_periodic
    for open_ in (
        surface.level(),
        surface.low_pass(2e-4),
        surface.high_pass(2e-4),
        surface.resample((64, 64)),
        surface.crop((0, 8)),
    ):
        assert open_.is_periodic is None


def test_sizes_that_differ_by_rounding_are_one() -> None:
    z = np.eye(3)
    assert (asp.Surface(z, 0.3) + asp.Surface(z, 0.1 * 3)).sz == 2.0


def test_generators_are_those_of_the_library() -> None:
    """Closed forms of the shapes, and the same surface for the same seed."""
    x = (np.arange(12) + 0.5) / 12 * 1e-3 - 0.5e-3
    y = (np.arange(8) + 0.5) / 8 * 2e-3 - 1e-3
    shape, size = (8, 12), (1e-3, 2e-3)
    xx, yy = np.meshgrid(x, y)
    close = {"rtol": 1e-12, "atol": 1e-20}
    np.testing.assert_allclose(asp.paraboloid(0.1, shape, size).z, -(xx**2 + yy**2) / 0.2, **close)
    np.testing.assert_allclose(asp.paraboloid((0.1, 0.2), shape, size).z, -(xx**2) / 0.2 - yy**2 / 0.4, **close)
    np.testing.assert_allclose(asp.cylinder(0.1, shape, size, axis="y").z, -(xx**2) / 0.2, **close)
    np.testing.assert_allclose(asp.cylinder(0.1, shape, size, axis="x").z, -(yy**2) / 0.2, **close)
    np.testing.assert_allclose(asp.cone(0.3, shape, size).z, -0.3 * np.hypot(xx, yy), **close)
    wave = 1e-6 * np.cos(2 * np.pi * xx / 1e-3)
    np.testing.assert_allclose(asp.wave(1e-6, 1e-3, shape, size).z, wave, rtol=0, atol=1e-20)
    assert asp.wave(1e-6, (1e-3, 2e-3), shape, size).shape == shape
    corner = asp.paraboloid(0.1, shape, size, center=(0.0, 0.0)).z
    assert np.unravel_index(np.argmax(corner), shape) == (0, 0)
    settings = {"hurst": 0.8, "rolloff": 2.5e-4, "short_cutoff": 1e-4, "seed": 7}
    one = asp.self_affine((40, 50), (1e-3, 8e-4), rms_height=1e-6, **settings)
    assert one == asp.self_affine((40, 50), (1e-3, 8e-4), rms_height=1e-6, **settings)
    assert one.sq == pytest.approx(1e-6, rel=1e-12) and one.shape == (40, 50)
    with pytest.raises(asp.AsperityError, match="one of"):
        asp.self_affine((40, 50), 1e-3, **settings)
    with pytest.raises(asp.AsperityError) as refused:
        asp.self_affine((40, 50), 1e-3, rms_height=1e-6, **{**settings, "short_cutoff": 1e-6})
    assert refused.value.kind == "CutoffBelowGrid"


def test_texture() -> None:
    """Two crossed waves: Sal along the diagonals, the longest way along the axes. Half of a wave lies above its mean."""
    k = 2 * np.pi / 20e-6
    x, y = np.meshgrid(np.arange(400) * 1e-6, np.arange(300) * 1e-6)
    surface = asp.Surface(1e-7 * (np.cos(k * x) + np.cos(k * y)), size=(400e-6, 300e-6))
    found = surface.areal_parameters()
    sal = np.sqrt(2) * np.arccos(0.2) / k
    assert found.sal == pytest.approx(sal, rel=0.02)
    assert found.str == pytest.approx(sal / (np.arccos(-0.6) / k), rel=0.03)
    assert found.sq == pytest.approx(1e-7, rel=0.01)
    # Of small slopes half the mean square gradient.
    assert found.sdr == pytest.approx(0.5 * found.sdq**2, rel=0.01)
    assert found.spk >= 0 and found.sk > found.spk
    assert surface.material_ratio([1.0, 0.0, -1.0]) == pytest.approx([0.0, 0.5, 1.0], abs=0.03)


def test_profiles() -> None:
    """A sine of 40 waves: Ra = 2 A / pi, Rq = A / sqrt(2), RSm is its length."""
    x = np.arange(4000) * 0.25e-6
    text = "".join(f"{1e3 * a:.17g} {z:.17g}\n" for a, z in zip(x, 0.5 * np.sin(2 * np.pi * x / 25e-6)))
    profile = asp.read(text.encode(), height_unit="um", lateral_unit="mm", name="sine.txt")
    assert profile.z.shape == (1, 4000)
    for cutoff in [None, 0.25e-3]:
        found = profile.profile_parameters(cutoff)
        assert found.cutoff == cutoff
        assert found.ra == pytest.approx(0.5e-6 * 2 / np.pi, rel=1e-3)
        assert found.rq == pytest.approx(0.5e-6 / np.sqrt(2), rel=1e-3)
        assert found.rsm == pytest.approx(25e-6, rel=1e-3)
    with pytest.raises(asp.AsperityError) as refused:
        asp.example_surface(nodes=32).profile_parameters()
    assert refused.value.value == 32


def test_titles_are_those_of_the_maps() -> None:
    """A surface has the name of its map in its file, and keeps it; one of an array has none."""
    surface = asp.read(FILES / "masked.gwy", ignore_mask=True)
    assert surface.title == "made"
    assert asp.read(FILES / "plain_i16.spm").title == "Height Sensor"
    with pytest.warns(asp.AsperityWarning, match="taken to be in nm"):
        phase = asp.read(FILES / "plain_i16.spm", channel="Phase", height_unit="nm")
    assert phase.title == "Phase"
    assert asp.Surface(surface.z, size=surface.size).title == ""
