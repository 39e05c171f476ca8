//! Maps and lists written in every dialect: what is read back has the same heights, or is refused. Text and map follow
//! from one number, which a failure names.

use asperity_surfaces::io::{LengthUnit, MeasuredSurface, ReadOptions};
use proptest::prelude::*;
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A map with dyadic heights and coordinates, so that all of them are written exactly; element `iy * nx + ix`, NaN
/// where missing.
struct Map {
    nx: usize,
    ny: usize,
    heights: Vec<f64>,
    /// Whether the heights are those of no plane, and of nothing else that is straight.
    is_rough: bool,
}

impl Map {
    fn of(rng: &mut ChaCha8Rng) -> Self {
        let (nx, ny) = (rng.random_range(1..=12), rng.random_range(1..=12));
        let kind = rng.random_range(0..10);
        let [a, b, c] = [(); 3].map(|()| f64::from(rng.random_range(-8..=8)) / 4.0);
        let mut heights: Vec<f64> = (0..nx * ny)
            .map(|k| {
                let (x, y) = ((k % nx) as f64, (k / nx) as f64);
                match kind {
                    // Planes, surfaces of straight lines, steps, a flat one, bumps on a tilted one.
                    0 => a + b * x + c * y,
                    1 => a * x + b * y + c * x * y,
                    2 => a + b * f64::from(u8::from(x > y)),
                    3 => c,
                    4 => a * x + f64::from(u8::from(x > 2.0 && y > 2.0 && x < 5.0)),
                    5 => f64::from(rng.random_range(0..256)),
                    6 => x * x + a * y * y,
                    _ => f64::from(rng.random_range(-4096..=4096)) / 1024.0,
                }
            })
            .collect();
        if rng.random_bool(0.2) {
            for _ in 0..rng.random_range(1..4) {
                let k = rng.random_range(0..heights.len());
                heights[k] = f64::NAN;
            }
        }
        Self { nx, ny, heights, is_rough: kind == 5 || kind > 6 }
    }
}

/// How a text is written.
#[derive(Debug)]
struct Dialect {
    separator: &'static str,
    decimal_comma: bool,
    quotes: bool,
    mark: bool,
    end: &'static str,
    missing: &'static str,
    trailing: bool,
    leading: bool,
    empty_lines: usize,
    remarks: bool,
}

fn one<T: Copy>(rng: &mut ChaCha8Rng, of: &[T]) -> T {
    of[rng.random_range(0..of.len())]
}

impl Dialect {
    fn of(rng: &mut ChaCha8Rng) -> Self {
        let separator = one(rng, &[" ", "   ", "\t", ";", "; ", ",", ", "]);
        let quotes = rng.random_bool(0.15);
        let parts_by_comma = separator.contains(',');
        let parts_by_blanks = separator.trim().is_empty() && separator != "\t";
        Self {
            separator,
            decimal_comma: (quotes || !parts_by_comma) && rng.random_bool(0.3),
            quotes,
            mark: rng.random_bool(0.2),
            end: one(rng, &["\n", "\n", "\r\n", "\r"]),
            missing: if parts_by_blanks { "NaN" } else { one(rng, &["NaN", "BAD", "***", ""]) },
            trailing: rng.random_bool(0.1),
            leading: rng.random_bool(0.1),
            empty_lines: usize::from(rng.random_bool(0.1)),
            remarks: rng.random_bool(0.2),
        }
    }

    fn cell(&self, number: f64) -> String {
        let word = if number.is_nan() { self.missing.to_string() } else { format!("{number}") };
        let word = if self.decimal_comma { word.replace('.', ",") } else { word };
        if self.quotes { format!("\"{word}\"") } else { word }
    }

    /// The text of a header and rows of cells.
    fn text(&self, header: &[String], rows: &[Vec<String>]) -> String {
        let mut text = String::new();
        if self.mark {
            text.push('\u{feff}');
        }
        if self.remarks {
            text += &format!("# made by a test, for a test; 3 lines{}", self.end);
        }
        for line in header {
            text += &format!("{line}{}", self.end);
        }
        text += &self.end.repeat(self.empty_lines);
        for (k, row) in rows.iter().enumerate() {
            if self.leading && k == 0 {
                text += if self.separator == "\t" { "  " } else { "\t\t" };
            }
            text += &row.join(self.separator);
            if self.trailing {
                text += self.separator;
            }
            text += self.end;
        }
        text
    }
}

/// A text, and whether nothing in it leaves a choice: then it has to be read.
struct Written {
    text: String,
    is_plain: bool,
    /// Whether a line says that it is a map.
    is_declared: bool,
    /// Numbers of a first row that are no heights of the map, if its rows have no more than two.
    above: Option<(f64, f64)>,
    name: &'static str,
}

fn matrix(map: &Map, dialect: &Dialect, rng: &mut ChaCha8Rng) -> Written {
    let Map { nx, ny, .. } = *map;
    let rows = map.heights.chunks(nx).map(|row| row.iter().map(|z| dialect.cell(*z)).collect());
    let mut rows: Vec<Vec<String>> = rows.collect();
    // A header with sides has no running numbers below, and its sides are those of the positions.
    let kind = rng.random_range(0..6);
    let is_counted = kind > 1 && rng.random_bool(0.3);
    let step = one(rng, &[1.0, 1.0, 0.25, 0.5, 2.0]);
    let start = if is_counted { one(rng, &[0.0, 1.0]) } else { one(rng, &[0.0, 1.0, -2.0, 0.5]) };
    let steps = match (is_counted, kind) {
        (true, _) => (1.0, 1.0),
        (false, 0 | 1) => (2.0, 3.0),
        (false, _) => (step, step),
    };
    let (along_x, along_y) = (rng.random_bool(0.25), rng.random_bool(0.25));
    // Above a single column a position is nothing but one more height.
    let along_x = along_x && nx > 1;
    if along_y {
        for (k, row) in rows.iter_mut().enumerate() {
            row.insert(0, dialect.cell(start + steps.1 * k as f64));
        }
    }
    if along_x {
        let mut axis: Vec<String> =
            (0..nx).map(|k| dialect.cell(start + steps.0 * k as f64)).collect();
        if along_y {
            let has_cells = !dialect.separator.trim_matches(' ').is_empty();
            let is_empty = has_cells && rng.random_bool(0.5);
            axis.insert(0, if is_empty { String::new() } else { dialect.cell(0.0) });
        }
        rows.insert(0, axis);
    }
    let (w, h) = (2 * nx, 3 * ny);
    let header = match kind {
        0 => vec![format!("# Width: {w} m"), format!("# Height: {h} m"), "# Value units: m".into()],
        1 => vec![
            "WSxM file copyright UAM".into(),
            "WSxM ASCII Matrix file".into(),
            format!("X Amplitude: {w} m"),
            format!("Y Amplitude: {h} m"),
            "Z Amplitude: 5 m".into(),
        ],
        2 => vec![
            "# File Format = ASCII".into(),
            format!("# x-pixels = {nx}"),
            format!("# y-pixels = {ny}"),
            "# z-unit = m".into(),
            "# Start of Data:".into(),
        ],
        3 => vec!["\\Exported image units: m".into()],
        _ => Vec::new(),
    };
    // Fewer random numbers are evenly spaced by chance now and then.
    let is_plain = map.is_rough && !along_x && !along_y && nx > 5 && ny > 5;
    let is_declared = !header.is_empty();
    let above = (along_x && !along_y && nx == 2).then_some((start, start + steps.0));
    Written { text: dialect.text(&header, &rows), is_plain, is_declared, above, name: "map.txt" }
}

fn list(map: &Map, dialect: &Dialect, rng: &mut ChaCha8Rng) -> Written {
    let mut points: Vec<(usize, usize)> =
        (0..map.nx * map.ny).map(|k| (k % map.nx, k / map.nx)).collect();
    match rng.random_range(0..3) {
        0 => points.sort_unstable(),
        1 => points.shuffle(rng),
        _ => {}
    }
    // Scanners leave out what they did not see; where it is a whole side, the list is one of a smaller map.
    let seen = |(ix, iy): &(usize, usize)| !map.heights[iy * map.nx + ix].is_nan();
    let is_seen = |at: &dyn Fn(&(usize, usize)) -> bool| points.iter().any(|p| at(p) && seen(p));
    let is_whole = (0..map.nx).all(|ix| is_seen(&|p| p.0 == ix))
        && (0..map.ny).all(|iy| is_seen(&|p| p.1 == iy));
    if is_whole && rng.random_bool(0.3) {
        points.retain(seen);
    }
    let (is_named, has_index) = (rng.random_bool(0.5), rng.random_bool(0.4));
    let has_more = rng.random_bool(0.2);
    let mut order = vec!['x', 'y', 'z'];
    if has_more {
        order.push('i');
    }
    if is_named {
        order.shuffle(rng);
    }
    let counts = has_index.then(|| f64::from(rng.random_range(0..2)));
    let number = |k: usize, (ix, iy): (usize, usize), column: char| match column {
        'x' => 2.0 * ix as f64,
        'y' => 3.0 * iy as f64,
        'z' => map.heights[iy * map.nx + ix],
        _ => (k * k % 97) as f64,
    };
    let row = |(k, point): (usize, &(usize, usize))| {
        let index = counts.map(|start| start + k as f64);
        let cells = order.iter().map(|column| number(k, *point, *column));
        index.into_iter().chain(cells).map(|number| dialect.cell(number)).collect()
    };
    let rows: Vec<Vec<String>> = points.iter().enumerate().map(row).collect();
    let name = |column: &char| match column {
        'i' => "intensity".to_string(),
        other => format!("{other} [m]"),
    };
    let mut names: Vec<String> = order.iter().map(name).collect();
    if has_index && rng.random_bool(0.7) {
        names.insert(0, one(rng, &["id", "#", "", "No"]).to_string());
    }
    let header = if is_named { vec![names.join(dialect.separator)] } else { Vec::new() };
    let is_plain =
        is_named && !has_index && !has_more && map.nx > 1 && map.ny > 1 && points.len() > 3;
    let file = if rng.random_bool(0.5) { "list.xyz" } else { "list.csv" };
    let text = dialect.text(&header, &rows);
    Written { text, is_plain, is_declared: false, above: None, name: file }
}

/// How far positions may be from even steps, in steps, and still be taken as they are.
const EVEN: f64 = 1e-3;

fn is_same(a: f64, b: f64) -> bool {
    a == b || a.is_nan() && b.is_nan()
}

/// Whether this is the profile of these positions and heights: the heights as they are where the steps are even, and
/// those on straight lines between them where they are not.
fn is_profile(found: &MeasuredSurface, mut points: Vec<(f64, f64)>) -> bool {
    if points.first().map(|point| point.0) > points.last().map(|point| point.0) {
        points.reverse();
    }
    let ([(first, _), ..], [.., (last, _)]) = (&points[..], &points[..]) else {
        return false;
    };
    let step = (last - first) / (points.len() - 1) as f64;
    let place = |k: usize| first + step * k as f64;
    let is_even = points.iter().enumerate().all(|(k, p)| (p.0 - place(k)).abs() <= EVEN * step);
    let is_there = |k: usize, z: f64| {
        // Positions and their steps are dyadic, and what is halfway between is so to rounding.
        let near = |other: f64| (z - other).abs() < 1e-9 * (1.0 + other.abs());
        let is_at = |p: &&(f64, f64)| (p.0 - place(k)).abs() < 1e-9 * step;
        match points.iter().find(is_at) {
            Some(point) => is_same(z, point.1) || near(point.1),
            None => points.windows(2).any(|pair| {
                let ((x, before), (next, after)) = (pair[0], pair[1]);
                let expected = before + (place(k) - x) / (next - x) * (after - before);
                x < place(k) && place(k) < next && (near(expected) || is_same(z, expected))
            }),
        }
    };
    found.heights.shape() == (points.len(), 1)
        && found.cell.is_some_and(|(side, _)| (side / step - 1.0).abs() < 1e-12)
        && found.heights.iter().enumerate().all(|(k, z)| match is_even {
            true => is_same(*z, points[k].1),
            false => is_there(k, *z),
        })
}

/// Whether this is the map; sides of it of which nothing was measured may lack if that is said.
fn is_map(found: &MeasuredSurface, map: &Map, written: &Written) -> bool {
    let (is_declared, above) = (written.is_declared, written.above);
    let (nx, ny) = found.heights.shape();
    let written = |ix: usize, iy: usize| map.heights[iy * map.nx + ix];
    if found.understood.starts_with("a profile") {
        // By convention two columns are positions along x and heights, and one column is heights, unless a line says
        // that they are a map.
        let heights = (0..map.ny).map(|iy| written(0, iy));
        let in_order = heights.zip(&found.heights).all(|(a, b)| is_same(a, *b));
        let is_one = map.nx == 1 && (nx, ny) == (map.ny, 1) && in_order;
        let rows = (0..map.ny).map(|iy| (written(0, iy), written(1, iy)));
        let is_two = || map.nx == 2 && is_profile(found, above.into_iter().chain(rows).collect());
        return !is_declared && (is_one || is_two());
    }
    let columns =
        if found.understood.contains("empty cells") { 0..=map.nx.abs_diff(nx) } else { 0..=0 };
    ny == map.ny
        && columns.clone().any(|before| {
            let is_inside = |ix: usize| (before..before + nx).contains(&ix);
            nx <= map.nx
                && nx + columns.end() == map.nx
                && (0..ny).all(|iy| {
                    (0..map.nx).all(|ix| match is_inside(ix) {
                        true => is_same(found.heights[(ix - before, iy)], written(ix, iy)),
                        false => written(ix, iy).is_nan(),
                    })
                })
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn what_is_read_back_has_the_same_heights_or_is_refused(seed in any::<u64>()) {
        let metre =
            ReadOptions::new().height_unit(LengthUnit::METRE).lateral_unit(LengthUnit::METRE);
        let rng = &mut ChaCha8Rng::seed_from_u64(seed);
        let (map, mut dialect) = (Map::of(rng), Dialect::of(rng));
        if map.nx == 1 && dialect.missing.is_empty() {
            // An empty line is no row.
            dialect.missing = "NaN";
        }
        let is_list = rng.random_bool(0.5);
        let written =
            if is_list { list(&map, &dialect, rng) } else { matrix(&map, &dialect, rng) };
        match metre.read_bytes(&written.text, written.name) {
            Ok(found) => prop_assert!(
                is_map(&found, &map, &written),
                "{found} for {} x {}, {:?} {}, {dialect:?}\n{}",
                map.nx, map.ny, found.notes, found.understood, written.text
            ),
            Err(error) => prop_assert!(!written.is_plain, "{error}, {dialect:?}\n{}", written.text),
        }
    }
}
