//! Files of instruments and of other programs: what other readers find in them.
//!
//! The files are not part of this project: they are in `third_party` of the folder that the environment variable
//! `ASPERITY_SURFACE_FILES` names.

use std::path::PathBuf;

use asperity_surfaces::io::ReadOptions;

/// What SurfaceTopography 1.27.1 and surfalize 0.19.2 say of a file, in metres.
struct Reference {
    file: &'static str,
    shape: (usize, usize),
    sides: (f64, f64),
    min: f64,
    max: f64,
    mean: f64,
    std: f64,
    missing: usize,
    /// Heights of single nodes.
    samples: &'static [((usize, usize), f64)],
    /// What these readers leave out of every height, or add to it.
    above: f64,
}

const FILES: &[Reference] = &[
    // The example of ISO 25178-71.
    Reference {
        file: "sdf-1.sdf",
        shape: (7, 4),
        sides: (7e-6, 4e-6),
        min: 0.94907e-6,
        max: 1e-6,
        mean: 0.983_563_214_285_714_4e-6,
        std: 0.013_602_897_289_488_262e-6,
        missing: 0,
        samples: &[
            ((0, 0), 1e-6),
            ((6, 0), 1e-6),
            ((0, 3), 0.97986e-6),
            ((6, 3), 0.97986e-6),
            ((1, 0), 0.99874e-6),
            ((0, 1), 0.99874e-6),
            ((3, 1), 0.9874e-6),
        ],
        above: 0.0,
    },
    // Its offset along z is -3.4143 mm, in metres as its spacing: SurfaceTopography leaves it out, and surfalize takes
    // it for micrometres.
    Reference {
        file: "sur-3.sur",
        shape: (512, 512),
        sides: (0.151_319_552, 0.151_319_552),
        min: 0.0,
        max: 0.006_992_349_802_242_836_5,
        mean: 0.005_993_636_730_711_471,
        std: 0.001_113_199_426_585_969_3,
        missing: 233_009,
        samples: &[],
        above: -0.003_414_330_072_700_977,
    },
    Reference {
        file: "al3d-1.al3d",
        shape: (200, 296),
        sides: (8.760_54e-5, 0.000_129_655_992),
        min: 0.076_323_203_742_504_12,
        max: 0.076_358_154_416_084_29,
        mean: 0.076_340_933_320_288_73,
        std: 7.688_265_843_362_921e-6,
        missing: 0,
        samples: &[
            ((0, 0), 0.076_358_154_416_084_29),
            ((199, 0), 0.076_345_704_495_906_83),
            ((0, 295), 0.076_336_793_601_512_91),
            ((199, 295), 0.076_323_203_742_504_12),
            ((1, 0), 0.076_358_132_064_342_5),
            ((0, 1), 0.076_358_102_262_020_11),
            ((100, 98), 0.076_344_624_161_720_28),
        ],
        above: 0.0,
    },
];

/// A file of these; none without the variable. Where it is set, all of them have to be there.
pub(super) fn path(name: &str) -> Option<PathBuf> {
    let Some(folder) = std::env::var_os("ASPERITY_SURFACE_FILES") else {
        println!("skipped: ASPERITY_SURFACE_FILES names no folder with {name}");
        return None;
    };
    let path = PathBuf::from(folder).join("third_party").join(name);
    assert!(path.is_file(), "{} is not there", path.display());
    Some(path)
}

#[test]
fn other_readers_find_the_same() {
    for reference in FILES {
        let name = reference.file;
        let Some(path) = path(name) else {
            return;
        };
        let found = ReadOptions::new().read(path).unwrap();
        assert_eq!(found.heights.shape(), reference.shape, "{name}");
        assert_eq!(found.missing, reference.missing, "{name}");
        let (nx, ny) = reference.shape;
        let (dx, dy) = found.cell.unwrap();
        let near = |found: f64, expected: f64, error: f64, what: &str| {
            assert!(
                (found - expected).abs() <= error,
                "{name}, {what}: {found:e} instead of {expected:e}"
            );
        };
        // Numbers of the readers have 15 digits or more; each has scaled and added a few times.
        let digits = |value: f64| 1e-14 * value.abs();
        let (lx, ly) = reference.sides;
        near(nx as f64 * dx, lx, digits(lx), "side along x");
        near(ny as f64 * dy, ly, digits(ly), "side along y");

        let heights = || found.heights.iter().filter(|z| !z.is_nan());
        let count = heights().count() as f64;
        let mean = heights().sum::<f64>() / count;
        let square = heights().map(|z| (z - mean) * (z - mean)).sum::<f64>() / count;
        let size = reference.max.abs() + reference.above.abs();
        let at = |value: f64| value + reference.above;
        let min = heights().fold(f64::INFINITY, |min, z| min.min(*z));
        let max = heights().fold(f64::NEG_INFINITY, |max, z| max.max(*z));
        near(min, at(reference.min), digits(size), "least height");
        near(max, at(reference.max), digits(size), "greatest height");
        // Sums of up to 2^18 heights, each rounded to one unit in 2^53 of the sum.
        near(mean, at(reference.mean), 1e-11 * size, "mean height");
        near(square.sqrt(), reference.std, 1e-11 * size, "deviation");
        for ((ix, iy), z) in reference.samples {
            near(found.heights[(*ix, *iy)], at(*z), digits(size), "a height");
        }
    }
}
