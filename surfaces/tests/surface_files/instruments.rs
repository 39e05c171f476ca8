//! What files of microscopes and interferometers leave open, or get wrong: our own files with a few bytes changed.

use std::fs;

use asperity_surfaces::io::{LengthUnit, MeasuredSurface, ReadOptions};
use asperity_surfaces::{Error, FileError};

use super::own;

type TestResult = Result<(), Box<dyn std::error::Error>>;

fn bytes(name: &str) -> Vec<u8> {
    fs::read(own().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// A file in which words are replaced by others of the same length.
fn edited(name: &str, edits: &[(&[u8], &[u8])]) -> Vec<u8> {
    let mut file = bytes(name);
    for (old, new) in edits {
        assert_eq!(old.len(), new.len());
        let place = file.windows(old.len()).position(|window| window == *old);
        let place = place.unwrap_or_else(|| panic!("{name} has no {old:?}"));
        file[place..place + old.len()].copy_from_slice(new);
    }
    file
}

fn read(file: &[u8]) -> Result<MeasuredSurface, Error> {
    ReadOptions::new().read_bytes(file, "file")
}

fn assert_refused(name: &str, edits: &[(&[u8], &[u8])], reason: &str) {
    match read(&edited(name, edits)) {
        Ok(found) => panic!("{name} is read: {found}"),
        Err(error) => assert!(error.to_string().contains(reason), "{name}: {error}"),
    }
}

/// A signal that is no length is there to be chosen, and then has no unit of length.
#[test]
fn other_signals_have_their_own_units() -> TestResult {
    for (name, signal, unit) in [
        ("plain_i16.spm", "Phase", "º"),
        ("missing_f32.ibw", "PhaseTrace", "deg"),
        ("plain_i16.nid", "Scan forward (Deflection)", "N"),
    ] {
        let found = read(&bytes(name))?;
        assert!(found.channels.len() == 2 && found.channels.iter().any(|name| name == signal));
        assert_ne!(found.title, signal);
        let refused = ReadOptions::new().channel(signal).read_bytes(bytes(name), name);
        assert!(
            matches!(&refused, Err(Error::File(FileError::NoUnit { found: Some(found), .. })) if found == unit),
            "{name}: {refused:?}"
        );
        // Counts from the integers or floats that the file was made with.
        let options = ReadOptions::new().channel(signal).height_unit(LengthUnit::METRE);
        assert_eq!(options.read_bytes(bytes(name), name)?.heights.shape(), (7, 5));
    }
    Ok(())
}

/// Two heights, forwards and backwards: neither is taken by itself, and both have a name.
#[test]
fn two_maps_of_one_name_are_told_apart() -> TestResult {
    let phase = (&b"S [Phase] \"Phase\""[..], &b"S [X] \"Height S\"  "[..]);
    let heights: [(&[u8], &[u8]); 3] = [
        (b"\"Height Sensor\"", b"\"Height S\"     "),
        (&phase.0[..17], &phase.1[..17]),
        (b"V [Sens. Phase]", b"V [Sens. Zsens]"),
    ];
    let file = edited("plain_i16.spm", &heights);
    let Err(Error::File(FileError::WhichChannel { channels, .. })) = read(&file) else {
        panic!("one of two heights was taken");
    };
    assert_eq!(channels, ["Height S [1]", "Height S [2]"]);
    let second = ReadOptions::new().channel("Height S [2]").read_bytes(&file, "file")?;
    assert!((second.heights[(6, 0)], second.heights[(0, 4)]) == (0.0, 0.0));
    Ok(())
}

#[test]
fn scales_of_nanoscope_need_their_sensitivity() -> TestResult {
    assert_refused(
        "plain_i16.spm",
        &[(b"@Sens. Zsens: V 100", b"@Sens. Other: V 100")],
        "no line '@Sens. Zsens'",
    );
    // Four bytes are four, whatever the header says; half of them are missing.
    assert_refused(
        "plain_i32.spm",
        &[(b"Data length: 140", b"Data length: 105")],
        "two or four each",
    );
    // An image without a scale is one of steps of the converter.
    let bare = edited(
        "plain_i16.spm",
        &[(b"@2:Z scale: V [Sens. Zsens]", b"@2:Z other: V [Sens. Zsens]")],
    );
    let refused = ReadOptions::new().channel("Height Sensor").read_bytes(bare, "file");
    assert!(
        matches!(&refused, Err(Error::File(FileError::NoUnit { found: Some(unit), .. })) if unit == "LSB")
    );
    assert_refused("plain_i16.spm", &[(b"\\*File list end", b"\\*File list and")], "no end");
    // A scan that was stopped after three lines.
    let stopped = edited(
        "plain_i16.spm",
        &[(b"\\Start context: OL\r\n\\Data", b"\\Valid data len Y: 3\r\n\\D1")],
    );
    let notes = read(&stopped)?.notes;
    assert_eq!(notes, ["7 x 3 of the 7 x 5 nodes are valid, as the file says; all are read"]);
    // One number is the side of a square, and an aspect ratio makes the other.
    let square = edited(
        "plain_i16.spm",
        &[(
            b"Aspect Ratio: 1:1\r\n\\Scan Size: 14 15 ~m",
            b"Aspect Ratio: 2:1\r\n\\Scan Size: 14 14 ~m",
        )],
    );
    let (dx, dy) = read(&square)?.cell.ok_or("no cell")?;
    assert!((7.0 * dx / 14e-6 - 1.0).abs() < 1e-14 && (5.0 * dy / 7e-6 - 1.0).abs() < 1e-14);
    Ok(())
}

/// Many images of the same bytes would take a multiple of the memory of the file.
#[test]
fn no_byte_belongs_to_two_images() {
    let file = bytes("plain_i16.spm");
    let place = |word: &[u8], from: usize| {
        let found = file[from..].windows(word.len()).position(|window| window == word);
        from + found.unwrap_or_else(|| panic!("no {word:?}"))
    };
    let start = place(b"\\*Ciao image list", 0);
    let end = place(b"\\*", start + 2);
    let image = String::from_utf8_lossy(&file[start..end])
        .replace("Data offset: 4096", "Data offset: 0")
        .replace("Data length: 70", "Data length: 70000")
        .replace("Samps/line: 7", "Samps/line: 7000");
    // 100 000 bytes hold one image of 70 000 bytes, but not two.
    for (count, reason) in [(1, None), (2, Some("more than the file has"))] {
        let images = image.repeat(count).into_bytes();
        let mut file = [&file[..start], &images, b"\\*File list end\r\n"].concat();
        file.resize(100_000, 0);
        let error = read(&file).err().map(|error| error.to_string());
        assert_eq!(error.is_some(), reason.is_some(), "{error:?}");
        assert!(reason.is_none_or(|reason| error.is_some_and(|error| error.contains(reason))));
    }
}

#[test]
fn waves_of_igor_are_checked() {
    // The sum of the headers: any other bytes that begin so are no wave.
    assert_refused(
        "missing_f32.ibw",
        &[(b"Surface00", b"Surface01")],
        "format of this file is unknown",
    );
    for (place, number, reason) in [
        (80, 3, "numbers have the type 3"),
        (136, 0, "a profile is no surface"),
        (144, 2, "it has four dimensions"),
        (140, 257, "257 layers"),
        (0, 2, "a wave of version 2, which has one dimension"),
        (0, 3, "a wave of version 3, which has one dimension"),
        (20, 33, "a unit has 33 bytes"),
    ] {
        let mut file = bytes("missing_f32.ibw");
        file[place..place + 2].copy_from_slice(&u16::to_le_bytes(number));
        balance(&mut file, [384, 126, 130][if place == 0 { usize::from(number) - 1 } else { 0 }]);
        let error = read(&file).map_err(|error| error.to_string());
        assert!(error.as_ref().is_err_and(|error| error.contains(reason)), "{error:?}");
    }
}

/// Makes the sum of all numbers in the headers of a wave zero.
fn balance(file: &mut [u8], headers: usize) {
    file[2..4].fill(0);
    let numbers = file[..headers].chunks(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]]));
    let sum = numbers.fold(0, u16::wrapping_add);
    file[2..4].copy_from_slice(&sum.wrapping_neg().to_le_bytes());
}

/// Units of more than three letters lie behind the numbers, before the labels.
#[test]
fn long_units_of_waves_are_read() -> TestResult {
    let plain = read(&bytes("missing_f32.ibw"))?;
    let mut file = bytes("missing_f32.ibw");
    // Behind headers, two layers of 35 numbers and the note.
    let place = 384 + 2 * 35 * 4 + 34;
    // Of the numbers, x and y: millimetres that the header calls metres.
    file.splice(place..place, b"millimetremicrometremicrometre".iter().copied());
    for field in [16, 20, 24] {
        file[field..field + 4].copy_from_slice(&10_u32.to_le_bytes());
    }
    balance(&mut file, 384);
    let long = read(&file)?;
    let (dx, dy) = plain.cell.ok_or("no cell")?;
    assert_eq!(long.cell, Some((dx * 1e-6, dy * 1e-6)));
    assert_eq!(long.heights[(0, 0)], plain.heights[(0, 0)] * 1e-3);
    assert_eq!((long.title, long.channels), (plain.title, plain.channels));
    Ok(())
}

#[test]
fn interferometers_state_their_units() -> TestResult {
    // Waves of an unknown length are no lengths.
    let waves = edited("missing_f32.opd", &[(b"Wavelength", b"Wavelangth")]);
    assert!(matches!(
        read(&waves),
        Err(Error::File(FileError::NoUnit { found: Some(unit), .. })) if unit == "waves"
    ));
    let other = edited("missing_f32.opd", &[(b"RAW_DATA", b"Raw\0\0\0\0\0")]);
    assert_eq!(read(&other)?.title, "made (Raw)");
    let found = read(&bytes("missing_f32.opd"))?;
    // 2⁻⁹ mm, and half as much again along y.
    assert_eq!(found.cell, Some((1e-3 / 512.0, 1.5e-3 / 512.0)));
    assert_eq!(found.title, "made (RAW_DATA)");
    // Without a calibration a file of MetroPro has no size.
    let pixel = 2e-6_f32.to_be_bytes();
    let bare = edited("missing_i32.dat", &[(&pixel, &[0; 4])]);
    assert_eq!(read(&bare)?.cell, None);
    assert_refused(
        "missing_i32.dat",
        &[(&0.5_f32.to_be_bytes(), &[0; 4])],
        "scale of the interferometer is 0",
    );
    assert_refused(
        "missing_i16.opd",
        &[(&[7, 0, 5, 0, 2, 0], &[7, 0, 5, 0, 3, 0])],
        "3 bytes each",
    );
    Ok(())
}

/// The type, the name of the type and the numbers: the name of its own lacks, and what lies around is shorter by it.
#[test]
fn matrices_of_vision_need_no_name() -> TestResult {
    let named = read(&bytes("missing_f32.opdx"))?;
    let mut file = edited(
        "missing_f32.opdx",
        &[
            (b"2D_Data}\x02\xe1", b"2D_Data}\x02\xd5"),
            (b"RawG\x02\xcf", b"RawG\x02\xc3"),
            (b"Matrix\0", b"Matrix\x45"),
        ],
    );
    let name = b"\x01\0\0\0\x04\0\0\0Data";
    let place = file.windows(name.len()).position(|window| window == name).ok_or("no name")?;
    file.drain(place..place + name.len());
    let found = read(&file)?;
    assert_eq!((found.cell, found.missing), (named.cell, named.missing));
    let same = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits();
    assert!(found.heights.iter().zip(named.heights.iter()).all(same));
    Ok(())
}

#[test]
fn what_is_no_surface_is_called_by_its_name() {
    let kind = [
        [3_u32.to_le_bytes(), 3_u32.to_le_bytes()].concat(),
        [1_u32.to_le_bytes(), 3_u32.to_le_bytes()].concat(),
    ];
    assert_refused("missing_f32.plu", &[(&kind[0], &kind[1])], "it holds a profile (type 1)");
    assert_refused("missing_f32.opdx", &[(b"2D_Data", b"1D_Data")], "there is no map in it");
    assert_refused("plain_i16.nid", &[(b"SaveBits=16", b"SaveBits=12")], "12 bits each");
    let twice: [(&[u8], &[u8]); 2] = [(b"Vk4File", b"Vk5File"); 2];
    assert_refused("missing_u32.vk6", &twice, "the archive has no member 'Vk4File'");
}

#[test]
fn colours_behind_a_surface_are_said_to_be_left_out() -> TestResult {
    let found = read(&bytes("missing_i16_colours.sur"))?;
    assert_eq!(found.notes, ["the colours or intensities behind the heights are not read"]);
    Ok(())
}

/// Values beyond those that the file says to be heights are none, and that is told; documents without a surface are
/// refused.
#[test]
fn documents_of_mountains() -> TestResult {
    let found = read(&bytes("missing_i32.mnt"))?;
    assert_eq!(found.title, "made");
    assert_eq!(found.notes.len(), 1);
    assert!(found.notes[0].starts_with("2 nodes are beyond the numbers"), "{:?}", found.notes);
    let utf16 = |text: &str| text.encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<u8>>();
    let (stream, other) = (utf16("ScopedContents"), utf16("ScopedDocument"));
    let name = "plain_i32.mnt";
    assert_refused(name, &[(&stream, &other)], "without the stream 'ScopedContents'");
    // Four rows, 34 points, and blocks that do not fit together.
    let item = |count: u32| [&[1, 0, 4, 0, 0, 0, 0, 0, 0, 0][..], &count.to_le_bytes()].concat();
    assert_refused(name, &[(&item(5), &item(4))], "35 points, but 7 x 4 in a map");
    assert_refused(name, &[(&item(35), &item(34))], "34 points, but 7 x 5 in a map");
    let block = |place: u64, count: u32| [&place.to_le_bytes()[..], &count.to_le_bytes()].concat();
    for (to, reason) in [
        (block(0, 17), "are before it"),
        (block(18, 16), "a block of 16 heights holds 65 bytes"),
        (block(18, u32::MAX), "as a block claims"),
    ] {
        assert_refused(name, &[(&block(18, 17), &to)], reason);
    }
    Ok(())
}

/// Chains of sectors that run in circles or leave the file.
#[test]
fn chains_of_sectors_end() {
    let file = bytes("plain_i32.mnt");
    for word in (512..1024).step_by(4) {
        for number in [0_u32, 1, 3, 500, u32::MAX - 2] {
            let mut damaged = file.clone();
            damaged[word..word + 4].copy_from_slice(&number.to_le_bytes());
            // What is read all the same are the heights: the entry is of a sector that is not needed.
            if let Ok(found) = read(&damaged) {
                assert_eq!(
                    (found.missing, found.heights.shape()),
                    (0, (7, 5)),
                    "{number} at {word}"
                );
            }
        }
    }
    for end in 0..file.len() - 512 {
        assert!(read(&file[..end]).is_err(), "{end} of {} bytes", file.len());
    }
}
