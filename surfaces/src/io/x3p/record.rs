//! The description of an `.x3p` file, `main.xml`: Record1 holds the axes, Record3 shape and data.

use std::borrow::Cow;

use roxmltree::{Document, Node, ParsingOptions};

use super::archive::DESCRIPTION;
use crate::io::bytes::{latin1, shape};
use crate::io::fault::Fault;
use crate::io::number::Number;

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
    pub(super) number: Number,
    /// A stored number is this many metres.
    pub(super) increment: f64,
    /// Height \[m\] of a stored zero.
    pub(super) offset: f64,
    pub(super) points: Points,
    /// Where the checksum of the description is.
    pub(super) checksum: String,
    /// Whether axes are turned against those of the instrument.
    pub(super) rotated: bool,
}

/// Where the heights are.
#[derive(Debug)]
pub(super) enum Points {
    /// In a member of their own, and which of them are valid in another.
    Linked(Link, Option<Link>),
    /// In the description.
    Listed(Vec<f64>),
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
        if elements > most || attributes > MAX_ATTRIBUTES {
            return Err(Fault::malformed(format!(
                "'{DESCRIPTION}' has {elements} elements and {attributes} attributes, but at most {most} and \
                 {MAX_ATTRIBUTES} are allowed in an archive of {length} bytes"
            )));
        }
        let options = ParsingOptions {
            nodes_limit: u32::try_from(most.saturating_mul(2)).unwrap_or(u32::MAX),
            ..ParsingOptions::default()
        };
        let document = Document::parse_with_options(&text, options)
            .map_err(|error| Fault::malformed(format!("'{DESCRIPTION}': {error}")))?;
        let root = document.root_element();
        if root.tag_name().name() != "ISO5436_2" {
            return Err(bad(
                root,
                format!("expected the element ISO5436_2, but found {}", root.tag_name().name()),
            ));
        }
        Self::of(root)
    }

    fn of(root: Node) -> Result<Self, Fault> {
        let first = descend(root, &["Record1"])?;
        let feature = text(descend(first, &["FeatureType"])?);
        if feature != "SUR" {
            return Err(bad(
                first,
                format!("the FeatureType is '{feature}': only surfaces, SUR, are read"),
            ));
        }
        let axes = descend(first, &["Axes"])?;
        let z = descend(axes, &["CZ"])?;
        let third = descend(root, &["Record3"])?;
        let shape = matrix(third)?;
        Ok(Self {
            shape,
            cell: (spacing(axes, "CX")?, spacing(axes, "CY")?),
            number: number(z)?,
            increment: increment(z)?,
            offset: quantity(z, "Offset", 0.0)?,
            points: points(third, shape)?,
            checksum: descend(root, &["Record4", "ChecksumFile"]).map_or("", text).to_string(),
            rotated: child(axes, "Rotation").is_some_and(turns),
        })
    }
}

/// Nodes along x and y.
fn matrix(third: Node) -> Result<(usize, usize), Fault> {
    let dimension = descend(third, &["MatrixDimension"])?;
    let count = |name| {
        let node = descend(dimension, &[name])?;
        text(node).parse::<u64>().map_err(|_| {
            bad(node, format!("{name} is '{}', but a number of points was expected", text(node)))
        })
    };
    let layers = match child(dimension, "SizeZ") {
        Some(_) => count("SizeZ")?,
        None => 1,
    };
    if layers != 1 {
        return Err(bad(
            dimension,
            format!("SizeZ is {layers}: only surfaces of a single layer are read"),
        ));
    }
    shape(count("SizeX")?, count("SizeY")?)
}

/// Spacing along x or y \[m\].
fn spacing(axes: Node, name: &str) -> Result<f64, Fault> {
    let axis = descend(axes, &[name])?;
    require(axis, "AxisType", "I", "has a constant spacing")?;
    let spacing = increment(axis)?;
    if spacing < 0.0 {
        return Err(bad(
            axis,
            format!("{name} has the Increment {spacing:e}, but a spacing was expected"),
        ));
    }
    Ok(spacing)
}

/// The type of heights.
fn number(z: Node) -> Result<Number, Fault> {
    require(z, "AxisType", "A", "gives each height")?;
    let node = descend(z, &["DataType"])?;
    match text(node) {
        "I" => Ok(Number::I16),
        "L" => Ok(Number::I32),
        "F" => Ok(Number::F32),
        "D" => Ok(Number::F64),
        other => {
            Err(bad(node, format!("CZ has the DataType '{other}', but I, L, F or D was expected")))
        }
    }
}

fn require(axis: Node, name: &str, expected: &str, meaning: &str) -> Result<(), Fault> {
    let node = descend(axis, &[name])?;
    if text(node) == expected {
        return Ok(());
    }
    Err(bad(
        node,
        format!(
            "{} has the {name} '{}': only one that {meaning}, {expected}, is read",
            axis.tag_name().name(),
            text(node)
        ),
    ))
}

/// What a stored number counts. It may be absent in files of the first edition of the standard: 1 m.
fn increment(axis: Node) -> Result<f64, Fault> {
    let increment = quantity(axis, "Increment", 1.0)?;
    if increment == 0.0 {
        return Err(bad(axis, format!("{} has the Increment 0", axis.tag_name().name())));
    }
    Ok(increment)
}

/// A finite number, or what stands for none.
fn quantity(axis: Node, name: &str, absent: f64) -> Result<f64, Fault> {
    let found = child(axis, name).map_or("", text);
    if found.is_empty() {
        return Ok(absent);
    }
    found.parse().ok().filter(|value: &f64| value.is_finite()).ok_or_else(|| {
        bad(
            axis,
            format!(
                "{} has the {name} '{found}', but a number was expected",
                axis.tag_name().name()
            ),
        )
    })
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

fn points(third: Node, shape: (usize, usize)) -> Result<Points, Fault> {
    let Some(link) = child(third, "DataLink") else {
        return listed(descend(third, &["DataList"])?, shape).map(Points::Listed);
    };
    let member = |path, md5| {
        child(link, path).map(text).filter(|path| !path.is_empty()).map(|path| Link {
            path: path.to_string(),
            md5: child(link, md5).map(|md5| text(md5).to_string()),
        })
    };
    let data = member("PointDataLink", "MD5ChecksumPointData")
        .ok_or_else(|| bad(link, "DataLink names no PointDataLink"))?;
    let valid = member("ValidPointsLink", "MD5ChecksumValidPoints");
    Ok(Points::Linked(data, valid))
}

/// Heights written out in the description: the last number of each point, which is missing if there is none.
fn listed(list: Node, (nx, ny): (usize, usize)) -> Result<Vec<f64>, Fault> {
    let mut values = Vec::new();
    for datum in elements(list, "Datum") {
        let height = text(datum).rsplit(';').next().unwrap_or_default().trim();
        let value = if height.is_empty() {
            f64::NAN
        } else {
            height.parse().map_err(|_| {
                bad(datum, format!("a Datum is '{height}', but a number was expected"))
            })?
        };
        values.push(value);
    }
    if values.len() != nx * ny {
        return Err(bad(
            list,
            format!("{nx} x {ny} points were expected, but the DataList has {}", values.len()),
        ));
    }
    Ok(values)
}

/// The elements of a name in another, whatever their namespace: files differ in which they use.
fn elements<'a, 'b: 'a>(
    node: Node<'a, 'b>,
    name: &'static str,
) -> impl Iterator<Item = Node<'a, 'b>> {
    node.children().filter(move |child| child.is_element() && child.tag_name().name() == name)
}

fn child<'a, 'b>(node: Node<'a, 'b>, name: &str) -> Option<Node<'a, 'b>> {
    node.children().find(|child| child.is_element() && child.tag_name().name() == name)
}

/// The element at the end of a path of names.
fn descend<'a, 'b>(node: Node<'a, 'b>, path: &[&str]) -> Result<Node<'a, 'b>, Fault> {
    path.iter().try_fold(node, |node, name| {
        child(node, name).ok_or_else(|| {
            bad(node, format!("expected an element {name} in {}", node.tag_name().name()))
        })
    })
}

fn text<'a>(node: Node<'a, '_>) -> &'a str {
    node.text().unwrap_or_default().trim()
}

/// A defect at an element of the description.
fn bad(node: Node, reason: impl std::fmt::Display) -> Fault {
    Fault::at(node.range().start, format!("'{DESCRIPTION}': {reason}"))
}
