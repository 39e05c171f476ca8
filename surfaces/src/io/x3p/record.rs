//! The description of an `.x3p` file, `main.xml`: Record1 holds the axes, Record3 shape and data.

use std::borrow::Cow;

use roxmltree::{Document, Node, ParsingOptions};

use super::archive::DESCRIPTION;
use crate::io::bytes::{latin1, shape};
use crate::io::fault::Fault;
use crate::io::number::{Number, parsed};

/// Attributes in a description, which needs some five: the time to look names up grows with a power of their number.
const MAX_ATTRIBUTES: usize = 1024;

/// Fewest elements that are allowed, in the shortest archive.
const MIN_ELEMENTS: usize = 1024;

/// What a description says of a surface.
#[derive(Debug)]
pub(super) struct Record {
    pub(super) shape: (usize, usize),
    /// Spacing along x and y \[m\].
    pub(super) cell: (f64, f64),
    pub(super) z: Stored,
    /// Positions along x and y of a profile whose points have their own.
    pub(super) x: Option<Stored>,
    pub(super) y: Option<Stored>,
    pub(super) is_profile: bool,
    pub(super) points: Points,
    /// Where the checksum of the description is.
    pub(super) checksum: String,
    /// Whether axes are turned against those of the instrument.
    pub(super) rotated: bool,
}

/// An axis along which each point has a number.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stored {
    pub(super) number: Number,
    /// A stored number is this many metres.
    increment: f64,
    /// Metres of a stored zero.
    offset: f64,
}

impl Stored {
    fn read(axis: Node) -> Result<Self, Fault> {
        Ok(Self {
            number: number(axis)?,
            increment: increment(axis)?,
            offset: quantity(axis, "Offset", 0.0)?,
        })
    }

    /// The length \[m\] of a stored number.
    pub(super) fn metres(&self, number: f64) -> f64 {
        let length = number * self.increment;
        // Without an offset nothing is added: -0 would become 0.
        if self.offset == 0.0 { length } else { length + self.offset }
    }
}

/// Where the heights are.
#[derive(Debug)]
pub(super) enum Points {
    /// In a member of their own, and which of them are valid in another.
    Linked(Link, Option<Link>),
    /// In the description: x, y and height of each point, NaN where there is none.
    Listed(Vec<[f64; 3]>),
}

/// A member, and its checksum.
#[derive(Debug)]
pub(super) struct Link {
    pub(super) path: String,
    pub(super) md5: Option<String>,
}

impl Record {
    /// Reads the description in an archive of `length` bytes.
    pub(super) fn read(description: &[u8], length: usize) -> Result<Self, Fault> {
        let text: Cow<str> = match std::str::from_utf8(description) {
            Ok(text) => text.trim_start_matches('\u{feff}').into(),
            Err(_) => latin1(description).into(),
        };
        // The tree is made in memory of this size before its text is looked at.
        let elements = text.bytes().filter(|byte| *byte == b'<').count();
        let attributes = text.bytes().filter(|byte| *byte == b'=').count();
        let most = length.max(MIN_ELEMENTS);
        ensure!(
            elements <= most && attributes <= MAX_ATTRIBUTES,
            "'{DESCRIPTION}' has {elements} elements and {attributes} attributes, but at most {most} and \
             {MAX_ATTRIBUTES} are allowed in an archive of {length} bytes"
        );
        let options = ParsingOptions {
            nodes_limit: u32::try_from(most.saturating_mul(2)).unwrap_or(u32::MAX),
            ..ParsingOptions::default()
        };
        let document = Document::parse_with_options(&text, options)
            .map_err(|error| fault!("'{DESCRIPTION}': {error}"))?;
        Self::of(document.root_element())
            .map_err(|fault| fault.prefixed(&format!("'{DESCRIPTION}': ")))
    }

    fn of(root: Node) -> Result<Self, Fault> {
        let name = root.tag_name().name();
        ensure!(
            // Some programs write the name of the standard without its part.
            matches!(name, "ISO5436_2" | "ISO5436"),
            at(place(root)),
            "expected the element ISO5436_2, but found {name}"
        );
        let first = descend(root, &["Record1"])?;
        let feature = text(descend(first, &["FeatureType"])?);
        let is_profile = feature == "PRF";
        ensure!(
            is_profile || feature == "SUR",
            at(place(first)),
            "the FeatureType is '{feature}': only surfaces, SUR, and profiles, PRF, are read"
        );
        let axes = descend(first, &["Axes"])?;
        let z = descend(axes, &["CZ"])?;
        require(z, "AxisType", "A", "gives each height")?;
        let third = descend(root, &["Record3"])?;
        let dimension = descend(third, &["MatrixDimension"])?;
        let shape = matrix(dimension)?;
        let (mut x, mut y) = (None, None);
        let cell = if is_profile {
            ensure!(
                shape.1 == 1,
                at(place(dimension)),
                "SizeY is {}, but a profile has one line",
                shape.1
            );
            x = positions(child(axes, "CX"))?;
            y = positions(child(axes, "CY"))?;
            // A profile has no width, whatever stands for one.
            let step = if x.is_some() { 0.0 } else { spacing(axes, "CX")? };
            (step, step)
        } else {
            (spacing(axes, "CX")?, spacing(axes, "CY")?)
        };
        Ok(Self {
            shape,
            cell,
            z: Stored::read(z)?,
            x,
            y,
            is_profile,
            points: points(third, shape, x.is_some() || y.is_some())?,
            checksum: descend(root, &["Record4", "ChecksumFile"]).map_or("", text).to_string(),
            rotated: child(axes, "Rotation").is_some_and(turns),
        })
    }
}

/// Nodes along x and y.
fn matrix(dimension: Node) -> Result<(usize, usize), Fault> {
    let count = |name| {
        let node = descend(dimension, &[name])?;
        parsed::<u64>(name, text(node), place(node))
    };
    let layers = if child(dimension, "SizeZ").is_some() { count("SizeZ")? } else { 1 };
    ensure!(
        layers == 1,
        at(place(dimension)),
        "SizeZ is {layers}: only surfaces of a single layer are read"
    );
    shape(count("SizeX")?, count("SizeY")?)
}

/// The positions along an axis of a profile, if each point has its own.
fn positions(axis: Option<Node>) -> Result<Option<Stored>, Fault> {
    let absolute = axis.filter(|axis| child(*axis, "AxisType").map(text) == Some("A"));
    absolute.map(Stored::read).transpose()
}

/// Spacing along x or y \[m\].
fn spacing(axes: Node, name: &str) -> Result<f64, Fault> {
    let axis = descend(axes, &[name])?;
    require(axis, "AxisType", "I", "has a constant spacing")?;
    let spacing = increment(axis)?;
    ensure!(
        spacing >= 0.0,
        at(place(axis)),
        "{name} has the Increment {spacing:e}, but a spacing was expected"
    );
    Ok(spacing)
}

/// The type of stored numbers.
fn number(axis: Node) -> Result<Number, Fault> {
    let node = descend(axis, &["DataType"])?;
    Ok(match text(node) {
        "I" => Number::I16,
        "L" => Number::I32,
        "F" => Number::F32,
        "D" => Number::F64,
        other => {
            let name = axis.tag_name().name();
            bail!(
                at(place(node)),
                "{name} has the DataType '{other}', but I, L, F or D was expected"
            )
        }
    })
}

fn require(axis: Node, name: &str, expected: &str, meaning: &str) -> Result<(), Fault> {
    let node = descend(axis, &[name])?;
    ensure!(
        text(node) == expected,
        at(place(node)),
        "{} has the {name} '{}': only one that {meaning}, {expected}, is read",
        axis.tag_name().name(),
        text(node)
    );
    Ok(())
}

/// What a stored number counts. It may be absent in files of the first edition of the standard: 1 m.
fn increment(axis: Node) -> Result<f64, Fault> {
    let increment = quantity(axis, "Increment", 1.0)?;
    let name = axis.tag_name().name();
    ensure!(increment != 0.0, at(place(axis)), "{name} has the Increment 0");
    Ok(increment)
}

/// A finite number, or what stands for none.
fn quantity(axis: Node, name: &str, absent: f64) -> Result<f64, Fault> {
    let found = child(axis, name).map_or("", text);
    if found.is_empty() {
        return Ok(absent);
    }
    let name = format!("the {name} of {}", axis.tag_name().name());
    let value: f64 = parsed(&name, found, place(axis))?;
    ensure!(value.is_finite(), at(place(axis)), "{name} is {value}, which is not finite");
    Ok(value)
}

/// Whether a matrix of rotation is another than that of no rotation.
fn turns(rotation: Node) -> bool {
    let diagonal = ["r11", "r22", "r33"];
    rotation.children().filter(Node::is_element).any(|element| {
        let name = element.tag_name().name();
        let expected = f64::from(u8::from(diagonal.contains(&name)));
        text(element).parse() != Ok(expected)
    })
}

fn points(third: Node, shape: (usize, usize), has_places: bool) -> Result<Points, Fault> {
    let Some(link) = child(third, "DataLink") else {
        let list = descend(third, &["DataList"])?;
        return listed(list, shape, has_places).map(Points::Listed);
    };
    let member = |path, md5| {
        child(link, path).map(text).filter(|path| !path.is_empty()).map(|path| Link {
            path: path.to_string(),
            md5: child(link, md5).map(|md5| text(md5).to_string()),
        })
    };
    let data = member("PointDataLink", "MD5ChecksumPointData")
        .ok_or_else(|| fault!(at(place(link)), "DataLink names no PointDataLink"))?;
    let valid = member("ValidPointsLink", "MD5ChecksumValidPoints");
    Ok(Points::Linked(data, valid))
}

/// Points written out in the description: the first number of each, the last but one, and the last, its height.
fn listed(list: Node, (nx, ny): (usize, usize), has_places: bool) -> Result<Vec<[f64; 3]>, Fault> {
    // Whatever their namespace: files differ in which they use.
    let data = list.children().filter(|child| child.tag_name().name() == "Datum");
    let points = data.map(|datum| {
        let number = |number: Option<&&str>| match number.map_or("", |number| number.trim()) {
            "" => Ok(f64::NAN),
            number => parsed("a Datum", number, place(datum)),
        };
        let mut numbers: Vec<&str> = text(datum).split(';').collect();
        // Some writers end a point with the sign that parts its numbers; behind a place it is a missing height.
        let ends = numbers.len() == 4 || numbers.len() == 2 && !has_places;
        numbers.pop_if(|last| ends && last.is_empty());
        let mut from_last = numbers.iter().rev();
        let (z, y) = (number(from_last.next())?, number(from_last.next())?);
        Ok::<_, Fault>([number(numbers.first())?, y, z])
    });
    let values: Vec<[f64; 3]> = points.collect::<Result<_, _>>()?;
    let found = values.len();
    ensure!(
        found == nx * ny,
        at(place(list)),
        "{nx} x {ny} points were expected, but the DataList has {found}"
    );
    Ok(values)
}

fn child<'a, 'b>(node: Node<'a, 'b>, name: &str) -> Option<Node<'a, 'b>> {
    node.children().find(|child| child.tag_name().name() == name)
}

/// The element at the end of a path of names.
fn descend<'a, 'b>(node: Node<'a, 'b>, path: &[&str]) -> Result<Node<'a, 'b>, Fault> {
    path.iter().try_fold(node, |node, name| {
        let parent = node.tag_name().name();
        let lacks = || fault!(at(place(node)), "expected an element {name} in {parent}");
        child(node, name).ok_or_else(lacks)
    })
}

fn text<'a>(node: Node<'a, '_>) -> &'a str {
    node.text().unwrap_or_default().trim()
}

/// Where an element begins in the description.
fn place(node: Node) -> usize {
    node.range().start
}
