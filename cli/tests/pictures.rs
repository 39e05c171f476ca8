//! Pictures read back: maps of contact pixel by pixel, and curves as their files have them.

mod common;

use std::error::Error;
use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;

use asperity::io::{read_npy, write_npy};
use common::{Scratch, column, numbers, run};
use nalgebra::DMatrix;
use png::{BitDepth, ColorType, Decoder};

type Done = Result<(), Box<dyn Error>>;

/// Nodes along x and y: not as many, so that no picture of the one is one of the other.
const SHAPE: (usize, usize) = (24, 16);
const NODES: f64 = 384.0;
/// Colours of frames, of what is not in contact, and of what has yielded.
const INK: [u8; 3] = [34, 34, 34];
const WHITE: [u8; 3] = [255, 255, 255];
const YIELDED: [u8; 3] = [240, 120, 0];
/// Colours of nodes that adhesion pulls: across a gap, and in contact.
const APART: [u8; 3] = [196, 200, 206];
const PULLED: [u8; 3] = [230, 0, 0];

/// What a map of contact shows.
struct Picture {
    /// Pixels of a line, and three bytes of each.
    width: usize,
    bytes: Vec<u8>,
    /// Pixels of the frame: the left and the right line, and the upper and the lower one.
    columns: [usize; 2],
    rows: [usize; 2],
}

impl Picture {
    fn read(file: &Path) -> Result<Self, Box<dyn Error>> {
        let mut reader = Decoder::new(BufReader::new(File::open(file)?)).read_info()?;
        let mut bytes = vec![0; reader.output_buffer_size().ok_or("too large a picture")?];
        let read = reader.next_frame(&mut bytes)?;
        assert_eq!((read.color_type, read.bit_depth), (ColorType::Rgb, BitDepth::Eight));
        let (width, height) = (read.width as usize, read.height as usize);
        let mut picture = Self { width, bytes, columns: [0, 0], rows: [0, 0] };
        // The lines that are long are those of the frame, and right of it those of the colour bar.
        let is_ink = |x: usize, y: usize| picture.at(x, y) == INK;
        let mut upright =
            (0..width).filter(|&x| 2 * (0..height).filter(|&y| is_ink(x, y)).count() > height);
        let mut level =
            (0..height).filter(|&y| 2 * (0..width).filter(|&x| is_ink(x, y)).count() > width);
        let mut columns = [0, 0];
        let mut rows = [0, 0];
        for place in &mut columns {
            *place = upright.next().ok_or("no frame")?;
        }
        for place in &mut rows {
            *place = level.next().ok_or("no frame")?;
        }
        (picture.columns, picture.rows) = (columns, rows);
        Ok(picture)
    }

    /// The colour of a pixel.
    fn at(&self, x: usize, y: usize) -> [u8; 3] {
        let place = 3 * (x + self.width * y);
        [self.bytes[place], self.bytes[place + 1], self.bytes[place + 2]]
    }

    /// The colour in the middle of each node, with the first one at the lower left corner.
    fn nodes(&self) -> DMatrix<[u8; 3]> {
        let ([left, right], [top, bottom]) = (self.columns, self.rows);
        DMatrix::from_fn(SHAPE.0, SHAPE.1, |ix, iy| {
            let x = left + (2 * ix + 1) * (right - left) / (2 * SHAPE.0);
            let y = bottom - 1 - (2 * iy + 1) * (bottom - top) / (2 * SHAPE.1);
            self.at(x, y)
        })
    }

    /// The share of pixels within the frame that have a colour.
    fn coloured(&self) -> f64 {
        let ([left, right], [top, bottom]) = (self.columns, self.rows);
        let inside = (top + 1..bottom).flat_map(|y| (left + 1..right).map(move |x| (x, y)));
        let coloured = inside.filter(|&(x, y)| ![INK, WHITE].contains(&self.at(x, y))).count();
        coloured as f64 / ((right - left) * (bottom - top)) as f64
    }
}

/// The part of the nodes whose colour is one of these.
fn share(nodes: &DMatrix<[u8; 3]>, is: impl Fn([u8; 3]) -> bool) -> f64 {
    nodes.iter().filter(|colour| is(**colour)).count() as f64 / NODES
}

/// The last number of a column of a table.
fn last(file: &Path, name: &str) -> Result<f64, Box<dyn Error>> {
    Ok(*numbers(file, name)?.last().ok_or("no line")?)
}

/// Nodes that have touched and not left, by the events of a path.
fn in_contact(file: &Path) -> Result<DMatrix<bool>, Box<dyn Error>> {
    let (xs, ys) = (numbers(file, "ix")?, numbers(file, "iy")?);
    let mut is_in = DMatrix::from_element(SHAPE.0, SHAPE.1, false);
    for ((ix, iy), event) in xs.iter().zip(&ys).zip(column(file, "event")?) {
        let node = (*ix as usize, *iy as usize);
        match event.as_str() {
            "touch" => is_in[node] = true,
            "release" => is_in[node] = false,
            _ => (),
        }
    }
    Ok(is_in)
}

/// A folder with a surface on cells of half a millimetre.
fn with_surface(name: &str) -> Result<Scratch, Box<dyn Error>> {
    let folder = Scratch::new(name)?;
    let height = |ix: usize, iy: usize| {
        let (x, y) = (ix as f64, iy as f64);
        1e-6 * ((1.7 * x).sin() + (2.3 * y).cos() + (0.37 * x * y).sin())
    };
    write_npy(folder.join("rough.npy"), &DMatrix::from_fn(SHAPE.0, SHAPE.1, height))?;
    Ok(folder)
}

const SURFACE: &str = "--surface rough.npy --height-unit m --side 12mm --side-y 8mm --e-star 1e9";

/// A node has a colour if it has touched and not left, and is the darker the greater its pressure. Colours take as much
/// of the picture as the contact of the area, to 3 of its 576 rows: there are none under two lines of the frame and
/// some ticks.
#[test]
fn the_map_of_a_path_is_the_contact_of_its_table() -> Done {
    let folder = with_surface("picture-path")?;
    let line = format!("path {SURFACE} --max-area-fraction 0.3 --fields npy");
    run(&folder.0, &line)?;
    let table = folder.join("out/path.csv");
    let picture = Picture::read(&folder.join("out/contact_map.png"))?;
    let colours = picture.nodes();
    let is_in = in_contact(&table)?;
    assert_eq!(colours.map(|colour| colour != WHITE), is_in);
    let fraction = last(&table, "contact_area_fraction")?;
    assert!((share(&colours, |colour| colour != WHITE) - fraction).abs() < 1e-12, "{fraction}");
    let coloured = picture.coloured();
    assert!((coloured - fraction).abs() < 3.0 / 576.0, "{coloured} {fraction}");

    let pressure = read_npy(folder.join("out/pressure.npy"))?;
    let nodes = pressure.iter().zip(&colours).zip(&is_in).filter(|(_, is_in)| **is_in);
    let mut nodes: Vec<(f64, u8)> = nodes.map(|((p, [_, green, _]), _)| (*p, *green)).collect();
    nodes.sort_by(|one, other| one.0.total_cmp(&other.0));
    // Of all three colours green alone grows from one end of the scale to the other.
    assert!(nodes.windows(2).all(|pair| pair[0].1 >= pair[1].1), "{nodes:?}");
    assert_eq!(nodes.last().map(|node| node.1), Some(1));
    Ok(())
}

/// Half of what is pressed hardest without a limit is a limit that some nodes reach before the same area.
#[test]
fn the_map_of_a_path_has_the_nodes_that_have_yielded() -> Done {
    let folder = with_surface("picture-yielded")?;
    let line = format!("path {SURFACE} --max-area-fraction 0.3 --fields npy");
    run(&folder.0, &line)?;
    let hardness = 0.5 * read_npy(folder.join("out/pressure.npy"))?.max();
    run(&folder.0, &format!("path {SURFACE} --max-area-fraction 0.3 --hardness {hardness:e}"))?;
    let table = folder.join("out/path.csv");
    let colours = Picture::read(&folder.join("out/contact_map.png"))?.nodes();
    assert_eq!(colours.map(|colour| colour != WHITE), in_contact(&table)?);
    let yielded = last(&table, "yielded_area_fraction")?;
    assert!(yielded > 0.0);
    let orange = share(&colours, |colour| colour == YIELDED);
    assert!((orange - yielded).abs() < 1e-12, "{orange} {yielded}");
    Ok(())
}

/// Nodes that stick are grey across a gap, and red in contact where their pressure is below 0.
#[test]
fn the_map_of_a_surface_that_sticks_has_the_nodes_that_are_pulled() -> Done {
    let folder = with_surface("picture-sticks")?;
    let surface = "--surface rough.npy --height-unit m --side 96um --side-y 64um --e-star 1MPa";
    let line = "--work-of-adhesion 50mJ/m² --mean-pressure 5kPa --fields npy";
    run(&folder.0, &format!("path {surface} {line}"))?;
    let table = folder.join("out/path.csv");
    let colours = Picture::read(&folder.join("out/contact_map.png"))?.nodes();
    let apart = last(&table, "soft_nodes")? + last(&table, "cohesive_nodes")?;
    assert!(apart > 0.0);
    assert_eq!(NODES * share(&colours, |colour| colour == APART), apart);
    let touching = share(&colours, |colour| colour != APART && colour != WHITE);
    let fraction = last(&table, "contact_area_fraction")?;
    assert!((touching - fraction).abs() < 1e-12, "{touching} {fraction}");

    let pressure = read_npy(folder.join("out/pressure.npy"))?;
    let (mut pulled, mut pressed) = (0, 0);
    for (colour, pressure) in colours.iter().zip(&pressure) {
        match *colour {
            WHITE => assert_eq!(*pressure, 0.0),
            APART => assert!(*pressure < 0.0, "{pressure}"),
            PULLED => {
                assert!(*pressure < 0.0, "{pressure}");
                pulled += 1;
            }
            _ => {
                assert!(*pressure >= 0.0, "{pressure}");
                pressed += 1;
            }
        }
    }
    assert!(pulled > 0 && pressed > 0, "{pulled} {pressed}");
    Ok(())
}

/// Each state has a map of its own, of the area that the table gives it.
#[test]
fn maps_of_loads_have_the_areas_of_their_table() -> Done {
    let folder = with_surface("picture-load")?;
    run(&folder.0, &format!("load {SURFACE} --at 5%,20%"))?;
    let fractions = numbers(&folder.join("out/load.csv"), "contact_area_fraction")?;
    assert_eq!(fractions.len(), 2);
    for (name, fraction) in ["5%", "20%"].into_iter().zip(fractions) {
        let picture = Picture::read(&folder.join(&format!("out/contact_map_{name}.png")))?;
        let found = share(&picture.nodes(), |colour| colour != WHITE);
        assert!((found - fraction).abs() < 1e-12, "{name}: {found} {fraction}");
        let coloured = picture.coloured();
        assert!((coloured - fraction).abs() < 3.0 / 576.0, "{name}: {coloured} {fraction}");
    }
    Ok(())
}

const BLUE: &str = "#005AA0";
const ORANGE: &str = "#D55E00";

/// What an element of an SVG has by a name.
fn attribute<'a>(element: &'a str, name: &str) -> Option<&'a str> {
    let (_, rest) = element.split_once(&format!(" {name}=\""))?;
    Some(rest.split_once('"')?.0)
}

/// Colour and points of the lines that are so wide, in the order in which they were drawn.
fn lines<'a>(svg: &'a str, width: &str) -> Vec<(&'a str, Vec<[i32; 2]>)> {
    let point = |text: &str| -> Option<[i32; 2]> {
        let (x, y) = text.split_once(',')?;
        Some([x.parse().ok()?, y.parse().ok()?])
    };
    let lines = svg.lines().filter(|line| line.starts_with("<polyline"));
    let lines = lines.filter(|line| attribute(line, "stroke-width") == Some(width));
    let line = |line| {
        let points = attribute(line, "points")?.split_whitespace().filter_map(point).collect();
        Some((attribute(line, "stroke")?, points))
    };
    lines.filter_map(line).collect()
}

/// How far down the lines begin, if there are any.
fn top(lines: &[(&str, Vec<[i32; 2]>)]) -> Option<i32> {
    lines.iter().flat_map(|line| &line.1).map(|[_, y]| *y).min()
}

/// Pulling off begins where pressing on ends, in each of four panels, and the names are above both curves.
#[test]
fn the_curve_of_pulling_off_begins_where_loading_ends() -> Done {
    let folder = with_surface("picture-back")?;
    let surface = "--surface rough.npy --height-unit m --side 96um --side-y 64um --e-star 1MPa";
    let line = "--work-of-adhesion 50mJ/m² --max-area-fraction 0.3 --unload";
    run(&folder.0, &format!("path {surface} {line}"))?;
    let svg = fs::read_to_string(folder.join("out/loading_curve.svg"))?;
    let curves = lines(&svg, "16");
    let turns = curves.windows(2).filter(|pair| (pair[0].0, pair[1].0) == (BLUE, ORANGE));
    let ends: Vec<_> = turns.map(|pair| (pair[0].1.last(), pair[1].1.first())).collect();
    assert_eq!(ends.len(), 4);
    for (end, begin) in ends {
        assert!(end.is_some() && end == begin, "{end:?} {begin:?}");
    }
    let (before, _) = svg.split_once("pulled off").ok_or("no name")?;
    let name = before.lines().last().and_then(|text| attribute(text, "y")?.parse::<i32>().ok());
    let curves = top(&lines(before, "16")).ok_or("no curves")?;
    // Letters of 17 pixels in 8 units each are centred there.
    assert!(curves > name.ok_or("no place")? + 8 * 17 / 2, "{curves} {name:?}");
    Ok(())
}

/// First touch has no load, and the state behind it is alone.
#[test]
fn a_single_state_is_a_dot() -> Done {
    let folder = with_surface("picture-single")?;
    let line = format!("path {SURFACE} --max-load 1e-12 --conductivity 50 --charts svg");
    run(&folder.0, &line)?;
    assert_eq!(numbers(&folder.join("out/path.csv"), "load")?, [0.0, 1e-12]);
    // There are two stiffnesses.
    for (file, count) in [("loading_curve.svg", 5), ("conductance.svg", 1)] {
        let svg = fs::read_to_string(folder.join("out").join(file))?;
        assert_eq!(svg.matches("<circle").count(), count, "{file}");
    }
    Ok(())
}

/// The names of the marks are above the curve of the area. The leak has a mark where contact seals, which is not where
/// the last channel closes if narrow ones are closed too.
#[test]
fn charts_over_time_say_what_is_true_and_hide_nothing() -> Done {
    let folder = Scratch::new("picture-time")?;
    let path = "path --nodes 24 --e-star 1e9 --max-area-fraction 0.8 --record path.npz";
    run(&folder.0, path)?;
    let load = 0.2 * last(&folder.join("out/path.csv"), "load")?;
    let line = format!("creep path.npz --prony 1,0.5 --load {load:e} --charts svg");
    let fluid = "--viscosity 1e-3 --pressure-drop 1 --along x";
    for (least_gap, is_marked) in [("", true), ("--least-gap 1nm", false)] {
        run(&folder.0, &format!("{line} {fluid} {least_gap}"))?;
        let leak = fs::read_to_string(folder.join("out/leak_over_time.svg"))?;
        assert_eq!(leak.contains("the last channel closes"), is_marked, "{least_gap}");
    }
    let svg = fs::read_to_string(folder.join("out/creep.svg"))?;
    let (before, after) = svg.split_once("opacity=\"0.85\"").ok_or("no names")?;
    let ground = before.lines().last().ok_or("no ground")?;
    let number = |name| attribute(ground, name).and_then(|text| text.parse::<i32>().ok());
    let bottom = number("y").zip(number("height")).map(|(y, height)| y + height);
    assert!(after.contains("seals along"));
    let curve = top(&lines(before, "6")).ok_or("no curve")?;
    assert!(curve > bottom.ok_or("no ground")?, "{curve} {bottom:?}");
    Ok(())
}
