use std::io::{Cursor, Seek, SeekFrom, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::*;
use crate::io::testing::{assert_refused, only, put};

/// Where the conditions lie in the files made here: not where they usually begin.
const CONDITIONS: usize = 100;

/// A file of these height images, each of so many bits: pixels of 2 µm x 3 µm, steps of 0.1 nm.
fn file(images: &[(u32, Vec<u8>)]) -> Vec<u8> {
    let mut file = b"VK4_\0\0\0\x01\0\0\0\0".to_vec();
    file.resize(400, 0);
    put(&mut file, TABLE, (CONDITIONS as u32).to_le_bytes());
    for (k, length) in [2_000_000_u32, 3_000_000, 100].into_iter().enumerate() {
        put(&mut file, CONDITIONS + PIXEL + 4 * k, length.to_le_bytes());
    }
    for (k, (bits, data)) in images.iter().enumerate() {
        let place = file.len() as u32;
        put(&mut file, HEIGHT + 4 * k, place.to_le_bytes());
        for field in [3, 2, *bits, 0, data.len() as u32, 0, 9] {
            file.extend(u32::to_le_bytes(field));
        }
        file.extend([7; PALETTE]);
        file.extend(data);
    }
    file
}

const VALUES: [u8; 6] = [1, 2, 3, 0, 5, 255];

/// Each image on its own, and all three in a file. Oracle: the layout that the readers named in the module agree on.
#[test]
fn images_of_every_depth_are_read() -> Result<(), Fault> {
    let images = [
        (8, VALUES.to_vec()),
        (16, VALUES.map(|z| u16::from(z).to_le_bytes()).concat()),
        (32, VALUES.map(|z| u32::from(z).to_le_bytes()).concat()),
    ];
    let check = |channel: &Channel| {
        assert_eq!((channel.shape, channel.cell), ((3, 2), Some((2e-6, 3e-6))));
        for (found, value) in channel.values.iter().zip(VALUES) {
            // Two products, rounded once each.
            let expected = f64::from(value) * 1e-10;
            assert!((found - expected).abs() <= 2.0 * f64::EPSILON * expected);
        }
        let mask = [false, false, false, true, false, false];
        assert_eq!(channel.mask.as_deref(), Some(&mask[..]));
        assert_eq!(channel.notes.len(), 1);
    };
    for image in &images {
        let whole = file(std::slice::from_ref(image));
        let channels = parse(&whole)?;
        assert_eq!(channels.len(), 1);
        channels.iter().for_each(check);
        for end in 0..whole.len() {
            assert!(
                parse(&whole[..end]).map_or(true, |channels| channels.is_empty()),
                "{end} bytes"
            );
        }
    }
    let channels = parse(&file(&images))?;
    let names: Vec<&str> = channels.iter().map(|channel| &channel.name[..]).collect();
    assert_eq!(names, ["Height 1", "Height 2", "Height 3"]);
    channels.iter().for_each(check);
    // Without zeros nothing is marked.
    let plain = only(parse(&file(&[(8, vec![1; 6])])))?;
    assert_eq!((plain.mask, plain.notes.len()), (None, 0));
    Ok(())
}

#[test]
fn defects_are_named() {
    let image = [(8, VALUES.to_vec())];
    for (place, number, reason) in [
        (TABLE, u32::MAX, "is referred to, but the file has 1202 bytes"),
        (HEIGHT, 5000, "byte 5000 is referred to"),
        (400, 4, "4 x 2 heights of 8 bits are said to take 6 bytes (compression 0)"),
        (404, 30000, "3 x 30000 heights"),
        (408, 24, "24 bits"),
        (416, 7, "said to take 7 bytes"),
        (CONDITIONS + STEP, 0, "step in height is 0, but a positive number"),
    ] {
        let mut file = file(&image);
        put(&mut file, place, u32::to_le_bytes(number));
        assert_refused(parse(&file), reason);
    }
    for (place, number) in [(400, 0_u32), (400, 32769), (404, u32::MAX)] {
        let mut file = file(&image);
        put(&mut file, place, number.to_le_bytes());
        assert!(matches!(parse(&file), Err(Fault::Refused(_))), "{place}");
    }
    assert_refused(parse(b"VK3_ and more of it"), "does not begin with 'VK4_'");
    assert_refused(parse(b"VK6\0 and more of it"), "no complete zip archive");
}

/// An archive of members behind a picture, as `.vk6` and `.vk7` are. Places in it count from its beginning, or from that
/// of the file.
fn archive(
    begin: &[u8],
    from_archive: bool,
    method: CompressionMethod,
    members: &[(&str, &[u8])],
) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    // The picture holds what an empty archive looks like.
    let picture = [&b"BM"[..], b"PK\x05\x06", &[0; 18]].concat();
    let head = [begin, &(picture.len() as u32).to_le_bytes()[..], &picture].concat();
    let mut zip = Cursor::new(if from_archive { Vec::new() } else { head.clone() });
    zip.seek(SeekFrom::End(0))?;
    let mut zip = ZipWriter::new(zip);
    for (name, bytes) in members {
        zip.start_file(*name, SimpleFileOptions::default().compression_method(method))?;
        zip.write_all(bytes)?;
    }
    let zip = zip.finish()?.into_inner();
    Ok(if from_archive { [head, zip].concat() } else { zip })
}

#[test]
fn archives_hold_the_same_images() -> Result<(), Box<dyn std::error::Error>> {
    let whole = file(&[(32, VALUES.map(|z| u32::from(z).to_le_bytes()).concat())]);
    let expected = parse(&whole)?;
    let (height, conditions) = ((MEMBER, &whole[..]), ("VkMeasureCondition", &b"<xml/>"[..]));
    // An archive in the archive, as of images of many exposures.
    let inner = archive(b"", true, CompressionMethod::Stored, &[("Vk4File.bmp", b"BM")])?;
    let inner = ("VkHDRImages", &inner[..]);
    for begin in ARCHIVES {
        for from_archive in [true, false] {
            for method in [CompressionMethod::Stored, CompressionMethod::Deflated] {
                for members in [
                    vec![height],
                    vec![height, conditions, inner],
                    vec![inner, conditions, height],
                    vec![conditions, ("folder/Vk4File", height.1)],
                ] {
                    assert_eq!(parse(&archive(begin, from_archive, method, &members)?)?, expected);
                }
            }
        }
    }
    let two = [height, ("folder/Vk4File", height.1)];
    let two = archive(ARCHIVES[0], true, CompressionMethod::Stored, &two)?;
    assert_refused(parse(&two), "two members 'Vk4File'");
    Ok(())
}
