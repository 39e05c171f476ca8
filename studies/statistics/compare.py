"""Statistics of asperity beside those of tamaas and SurfaceTopography.

    cargo run --release -p asperity-studies --bin statistics > out/statistics.csv
    pip install tamaas==2.9.0 SurfaceTopography==1.27.1
    python studies/statistics/compare.py out/statistics.csv docs/statistics.md

Writes the tables between the markers of the page, and fails if a number differs that should not.
"""

import csv
import sys
import textwrap
from importlib.metadata import version
from pathlib import Path

import numpy as np
import SurfaceTopography
import tamaas

GOLDEN = 0.6180339887498949
TOLERANCE = 1e-10
DATA = Path(__file__).parents[2] / "tests" / "data"
BEGIN = "<!-- written by studies/statistics/compare.py: begin -->"
END = "<!-- written by studies/statistics/compare.py: end -->"

# Quantities that tamaas or SurfaceTopography define in another way, with the note that the page explains.
DIFFERENT = {
    ("rms height", "tamaas"): "a",
    ("rms gradient, differences", "SurfaceTopography"): "b",
    ("rms slope along x, differences", "SurfaceTopography"): "b",
    ("rms slope along y, differences", "SurfaceTopography"): "b",
    ("unit square: m4", "tamaas"): "c",
}


# The same for a map of an odd number of nodes along x, with waves of two cells along y.
DIFFERENT_SHORT_WAVES = {
    (f"unit square: {quantity}", "tamaas"): "d"
    for quantity in [
        "m0",
        "m2",
        "m4",
        "(m40 + 3 m22 + m04)/3",
        "rms gradient, spectral",
        "least mean pressure of full contact over E*",
    ]
} | {(quantity, "SurfaceTopography"): "e" for quantity in ["m02", "rms gradient, spectral"]}


def formula():
    ix, iy = np.meshgrid(np.arange(45), np.arange(28), indexing="ij")
    noise = np.fmod(GOLDEN * (ix * ix + 3 * ix * iy + 5 * iy * iy + ix), 1.0)
    return 1e-6 * (noise + 0.03 * ix - 0.02 * iy)


MAPS = {
    "periodic_32x24": (np.load(DATA / "periodic_32x24.npy"), (2e-5, 3e-5)),
    "selfaffine_48": (np.load(DATA / "selfaffine_48.npy"), (1e-2 / 48, 1e-2 / 48)),
    "periodic_128": (np.load(DATA / "periodic_128.npy"), (1 / 128, 1 / 128)),
    "formula_45x28": (formula(), (2e-6, 3.5e-6)),
}


def others(heights, cell):
    """Numbers of the other programs: {quantity: {program: value}}."""
    nx, ny = heights.shape
    sides = (nx * cell[0], ny * cell[1])
    found = {}

    def put(quantity, program, value):
        found.setdefault(quantity, {})[program] = float(value)

    s = tamaas.Statistics2D
    h = np.ascontiguousarray(heights - heights.mean())
    put("rms height", "tamaas", s.computeRMSHeights(h))
    m0, m2, m4 = s.computeMoments(h)
    # Its wave numbers are those of turns, not of radians.
    put("unit square: m0", "tamaas", m0)
    put("unit square: m2", "tamaas", (2 * np.pi) ** 2 * m2)
    put("unit square: m4", "tamaas", (2 * np.pi) ** 4 * m4)
    put("unit square: (m40 + 3 m22 + m04)/3", "tamaas", (2 * np.pi) ** 4 * m4)
    put("unit square: rms gradient, spectral", "tamaas", s.computeSpectralRMSSlope(h))
    put("unit square: least mean pressure of full contact over E*", "tamaas", s.computeFullContactPressure(h))

    st = "SurfaceTopography"
    free = SurfaceTopography.Topography(heights, sides, periodic=False)
    periodic = SurfaceTopography.Topography(heights, sides, periodic=True)
    turned = SurfaceTopography.Topography(heights.T, sides[::-1], periodic=False)
    put("rms height", st, free.Sq())
    put("rms gradient, differences", st, free.rms_gradient())
    put("rms slope along x, differences", st, free.Rdq())
    put("rms slope along y, differences", st, turned.Rdq())
    put("rms Laplacian, differences", st, free.rms_laplacian())
    put("rms curvature, differences", st, free.rms_curvature_from_area())
    slope_x, slope_y = periodic.fourier_derivative()
    put("m20", st, np.mean(slope_x**2))
    put("m02", st, np.mean(slope_y**2))
    put("rms gradient, spectral", st, np.sqrt(np.mean(slope_x**2 + slope_y**2)))

    plane = free.detrend("height")
    put("rms height above the plane", st, plane.Sq())
    put("rms height above the quadratic", st, free.detrend("curvature").Sq())
    ix, iy = np.meshgrid(np.arange(nx), np.arange(ny), indexing="ij")
    trend = heights - plane.heights()
    slopes = (trend[1, 0] - trend[0, 0]) / cell[0], (trend[0, 1] - trend[0, 0]) / cell[1]
    put("tilt of the plane", st, np.arctan(np.hypot(*slopes)))

    missing = (2.0 * ix - nx) ** 2 + (2.0 * iy - ny) ** 2 < 0.2 * nx * ny
    missing |= np.fmod(GOLDEN * (ix + nx * iy), 1.0) < 0.33
    holed = SurfaceTopography.Topography(np.ma.array(heights, mask=missing), sides, periodic=False)
    filled = holed.interpolate_undefined_data_with_harmonic_function()
    put("rms height with missing nodes filled", st, np.std(filled.heights()))

    q, density = periodic.power_spectrum_from_area()
    keep = ~np.ma.getmaskarray(density)
    for k, (q, density) in enumerate(zip(q[keep], density[keep])):
        put(f"radial wavevector {k}", st, q)
        put(f"radial density {k}", st, density)
    for letter, map_ in [("x", periodic), ("y", SurfaceTopography.Topography(heights.T, sides[::-1], periodic=True))]:
        q, density = map_.power_spectrum_from_profile(resampling_method=None)
        # The first is q = 0, the mean of each profile.
        for k, (q, density) in enumerate(zip(q[1:], density[1:])):
            put(f"profile wavevector along {letter} {k}", st, q)
            put(f"profile density along {letter} {k}", st, density)
    return found


def main(ours_path, page_path):
    ours = {}
    with open(ours_path) as file:
        for row in csv.DictReader(file):
            ours.setdefault(row["map"], {})[row["quantity"]] = float(row["value"])

    # The differences of a quantity from that of a program, one for each map; the greatest of those that are rounding.
    rows = {}
    wrong = []
    rounding = 0.0
    for name, (heights, cell) in MAPS.items():
        reference = others(heights, cell)
        different = DIFFERENT | (DIFFERENT_SHORT_WAVES if name == "formula_45x28" else {})
        spectra = {}
        for quantity, value in ours[name].items():
            theirs = reference.get(quantity, {})
            family = quantity.rsplit(" ", 1)[0]
            if family.startswith(("radial", "profile")):
                if "SurfaceTopography" in theirs:
                    spectra.setdefault(family, []).append((value, theirs["SurfaceTopography"]))
                continue
            for program in theirs:
                difference = value / theirs[program] - 1
                note = different.get((quantity, program))
                if note is None and abs(difference) > TOLERANCE:
                    wrong.append(f"{name}: {quantity} is {value!r}, of {program} {theirs[program]!r}")
                if note is None:
                    rounding = max(rounding, abs(difference))
                shown = f"{difference:+.1e}" if note is None else f"{difference:+.1e} ({note})"
                rows.setdefault((quantity, program), {})[name] = shown
        for family, pairs in spectra.items():
            count = sum(key.rsplit(" ", 1)[0] == family for key in reference)
            found, expected = np.array(pairs).T
            # Beyond a cut-off densities are rounding: they are compared with the greatest.
            difference = np.max(np.abs(found - expected)) / np.max(expected)
            if count != len(pairs) or difference > TOLERANCE:
                wrong.append(f"{name}: {len(pairs)} of {count} numbers of {family}, difference {difference}")
            rounding = max(rounding, difference)
            rows.setdefault(("radial and profile power spectral densities", "SurfaceTopography"), {})[name] = ""

    alike = [key for key, shown in rows.items() if not any("(" in cell for cell in shown.values())]
    programs = {program: ", ".join(q.replace(", ", " by ") for q, of in alike if of == program) for _, program in alike}
    words = (
        f"asperity beside tamaas {version('tamaas')} and SurfaceTopography {version('SurfaceTopography')}, NumPy {np.__version__}. "
        f"To rounding, {rounding:.1e} at most, these are equal on all four maps: "
        + "; ".join(f"of {program} the {quantities}" for program, quantities in programs.items())
        + ". For the others, asperity's number over theirs, less 1:"
    )
    lines = [
        *textwrap.wrap(words, 120, break_on_hyphens=False),
        "",
        f"| quantity | program | {' | '.join(f'`{name}`' for name in MAPS)} |",
        "|---" * (2 + len(MAPS)) + "|",
    ]
    for (quantity, program), shown in rows.items():
        if (quantity, program) not in alike:
            lines.append(f"| {quantity} | {program} | {' | '.join(shown.get(name, '') for name in MAPS)} |")
    lines.append("")

    page = Path(page_path)
    text = page.read_text()
    before, rest = text.split(BEGIN)
    after = rest.split(END)[1]
    page.write_text(before + BEGIN + "\n\n" + "\n".join(lines) + "\n" + END + after)
    if wrong:
        sys.exit("\n".join(wrong))


if __name__ == "__main__":
    main(*sys.argv[1:])
