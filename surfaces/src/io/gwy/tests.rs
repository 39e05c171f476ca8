use super::*;
use crate::io::testing::{TestResult, assert_refused};
use crate::io::{ReadOptions, channels};
use crate::{Error, FileError};

fn text(name: &str) -> Vec<u8> {
    [name.as_bytes(), b"\0"].concat()
}

fn component(name: &str, kind: u8, value: &[u8]) -> Vec<u8> {
    [&text(name), &[kind][..], value].concat()
}

fn object(name: &str, components: &[Vec<u8>]) -> Vec<u8> {
    let body = components.concat();
    [&text(name), &(body.len() as u32).to_le_bytes()[..], &body].concat()
}

fn unit(name: &str, unit: &str) -> Vec<u8> {
    let unit = object("GwySIUnit", &[component("unitstr", b's', &text(unit))]);
    component(name, b'o', &unit)
}

fn count(name: &str, count: i32) -> Vec<u8> {
    component(name, b'i', &count.to_le_bytes())
}

fn data(values: &[f64]) -> Vec<u8> {
    let bytes: Vec<u8> = values.iter().flat_map(|z| z.to_le_bytes()).collect();
    component("data", b'D', &[&(values.len() as u32).to_le_bytes(), &bytes[..]].concat())
}

/// A field of 2 x 1 nodes.
fn field(values: [f64; 2], height_unit: &str) -> Vec<u8> {
    let components = [
        count("xres", 2),
        count("yres", 1),
        component("xreal", b'd', &4e-6_f64.to_le_bytes()),
        component("yreal", b'd', &3e-6_f64.to_le_bytes()),
        unit("si_unit_xy", "m"),
        unit("si_unit_z", height_unit),
        data(&values),
    ];
    object(FIELD, &components)
}

fn file(components: &[Vec<u8>]) -> Vec<u8> {
    [MAGIC, &object("GwyContainer", components)].concat()
}

#[test]
fn every_map_can_be_chosen() -> TestResult {
    // In the order of a hash table, as Gwyddion writes them.
    let bytes = file(&[
        component("/12/data", b'o', &field([5.0, 6.0], "m")),
        component("/2/data", b'o', &field([1.0, 2.0], "m")),
        component("/2/data/title", b's', &text("Height")),
        component("/7/data", b'o', &field([3.0, 4.0], "V")),
        component("/7/data/title", b's', &text("Height")),
        component("/0/data/title", b's', &text("A title without a map")),
        component("/brick/3", b'o', &object("GwyBrick", &[])),
        component("/3/data", b'o', &object("GwyGraphModel", &[])),
    ]);
    let names: Vec<_> = parse(&bytes)?.into_iter().map(|map| map.name).collect();
    assert_eq!(names, ["Height [2]", "Height [7]", "/12/data"]);
    let temporary = std::env::temp_dir().join(format!("asperity-{}.gwy", std::process::id()));
    std::fs::write(&temporary, &bytes)?;
    let listed = channels(&temporary);
    std::fs::remove_file(&temporary)?;
    assert_eq!(listed?, names);
    let read = |options: ReadOptions| options.read_bytes(&bytes, "test.gwy");
    let first = read(ReadOptions::new().channel("Height [2]"));
    let volts = read(ReadOptions::new().channel("Height [7]"));
    let any = read(ReadOptions::new());
    let first = first?;
    assert_eq!(first.channels, names);
    assert_eq!(first.heights.as_slice(), [1.0, 2.0]);
    assert!(
        matches!(volts, Err(Error::File(FileError::NoUnit { found: Some(unit), .. })) if unit == "V")
    );
    assert!(matches!(any, Err(Error::File(FileError::WhichChannel { .. }))));
    Ok(())
}

#[test]
fn what_is_no_map_is_passed_over() -> TestResult {
    let three = 3_u32.to_le_bytes();
    let inner = object("Inner", &[component("deep", b'b', &[1])]);
    let maps = parse(&file(&[
        component("b", b'b', &[1]),
        component("c", b'c', b"x"),
        component("i", b'i', &[0; 4]),
        component("q", b'q', &[0; 8]),
        component("d", b'd', &[0; 8]),
        component("s", b's', &text("/0/data")),
        component("o", b'o', &inner),
        component("C", b'C', &[&three[..], &[0; 3]].concat()),
        component("I", b'I', &[&three[..], &[0; 12]].concat()),
        component("Q", b'Q', &[&three[..], &[0; 24]].concat()),
        component("D", b'D', &[&three[..], &[0; 24]].concat()),
        component("S", b'S', &[&three[..], b"a\0\0b\0"].concat()),
        component("O", b'O', &[&three[..], &inner, &inner, &inner].concat()),
        component("/0/data", b'o', &field([1.0, 2.0], "")),
    ]))?;
    assert_eq!(maps.len(), 1);
    assert_eq!(maps[0].values, [1.0, 2.0]);
    assert_eq!((maps[0].shape, maps[0].cell), ((2, 1), Some((2e-6, 3e-6))));
    assert_eq!(maps[0].height_unit, None);
    assert_eq!(maps[0].lateral_unit.as_deref(), Some("m"));
    Ok(())
}

#[test]
fn a_mask_of_another_shape_is_not_used() -> TestResult {
    let mask = object(FIELD, &[count("xres", 1), count("yres", 1), data(&[0.0])]);
    let maps = parse(&file(&[
        component("/0/data", b'o', &field([1.0, 2.0], "m")),
        component("/0/mask", b'o', &mask),
    ]))?;
    assert_eq!((&maps[0].mask, maps[0].notes.len()), (&None, 1));
    Ok(())
}

#[test]
fn no_depth_exhausts_the_stack() -> TestResult {
    // Sizes from the inside out; each level has a name, a type, a name of its object and a size.
    let levels = 200_000;
    let head = b"a\0oB\0".to_vec();
    let mut bytes = [MAGIC, b"GwyContainer\0"].concat();
    for level in 0..levels {
        let size = (levels - level) * (head.len() + 4);
        bytes.extend((size as u32).to_le_bytes());
        bytes.extend(&head);
    }
    bytes.extend(0_u32.to_le_bytes());
    assert!(parse(&bytes)?.is_empty());
    Ok(())
}

#[test]
fn defects_are_named() {
    for (components, expected) in [
        (vec![], "no 'xres'"),
        (vec![count("xres", -1)], "xres is -1"),
        (vec![count("xres", 3), count("yres", 1), data(&[0.0])], "3 x 1 nodes has 1 values"),
        (vec![component("xres", b'!', &[])], "'xres' has the type 0x21"),
        // A claim of 32 GiB in a file of some bytes.
        (vec![component("data", b'D', &[255; 4])], "the file ends"),
    ] {
        let field = object(FIELD, &components);
        assert_refused(parse(&file(&[component("/0/data", b'o', &field)])), expected);
    }
    assert!(parse(b"GWYPGwyBrick\0\0\0\0\0").is_err());
}
