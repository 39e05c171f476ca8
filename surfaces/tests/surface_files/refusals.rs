//! What is no file of heights at all.

use std::fs;
use std::io::ErrorKind;
use std::path::PathBuf;

use asperity_surfaces::io::{
    LengthUnit, ReadOptions, TextLayout, channels, read_npy, read_surface, write_gsf, write_npy,
    write_vti, write_x3p,
};
use asperity_surfaces::{Error, FileError, Grid};
use nalgebra::DMatrix;

use super::{Scratch, own};

#[test]
fn a_file_that_is_not_there_is_named_with_the_cause() {
    let absent = Scratch::new("absent.sdf");
    for error in
        [read_surface(&absent.0).map(drop).unwrap_err(), read_npy(&absent.0).map(drop).unwrap_err()]
    {
        let Error::File(FileError::Io { path, source }) = &error else {
            panic!("{error}");
        };
        assert_eq!(*path, absent.0);
        assert_eq!(source.kind(), ErrorKind::NotFound);
        let message = error.to_string();
        assert!(message.contains("absent.sdf"), "{message}");
        assert!(message.contains(&source.to_string()), "{message}");
    }
}

#[test]
fn a_folder_is_refused() {
    for error in
        [read_surface(own()).map(drop).unwrap_err(), read_npy(own()).map(drop).unwrap_err()]
    {
        assert!(
            matches!(&error, Error::File(FileError::BadFile { path, reason, .. }) if *path == own() && reason.contains("regular")),
            "{error}"
        );
    }
}

/// A pipe into which nobody writes: opening it would never return.
#[cfg(unix)]
#[test]
fn a_pipe_is_refused() {
    let pipe = Scratch::new("pipe.sdf");
    let made = std::process::Command::new("mkfifo").arg(&pipe.0).status();
    // Without the program there is nothing to try.
    if made.is_ok_and(|status| status.success()) {
        for error in [
            read_surface(&pipe.0).map(drop).unwrap_err(),
            read_npy(&pipe.0).map(drop).unwrap_err(),
            channels(&pipe.0).map(drop).unwrap_err(),
        ] {
            assert!(
                matches!(&error, Error::File(FileError::BadFile { path, reason, .. }) if *path == pipe.0 && reason.contains("regular")),
                "{error}"
            );
        }
    }
}

/// What cannot be written names the file and the cause: no folder of that name, no space left.
#[test]
fn files_that_cannot_be_written() {
    let grid = Grid::new(3, 2, 1.0, 1.0).unwrap();
    let field = DMatrix::from_element(3, 2, 1.0);
    let nowhere = Scratch::new("nowhere");
    let mut places = vec![nowhere.0.join("file")];
    // A device that is always full, where there is one.
    places.extend([PathBuf::from("/dev/full")].into_iter().filter(|path| path.exists()));
    for place in places {
        for error in [
            write_npy(&place, &field).unwrap_err(),
            write_gsf(&place, &grid, &field, "m").unwrap_err(),
            write_x3p(&place, &grid, &field).unwrap_err(),
            write_vti(&place, &grid, &[("height", &field)]).unwrap_err(),
        ] {
            let Error::File(FileError::Io { path, source }) = &error else {
                panic!("{error}");
            };
            assert_eq!(*path, place);
            if place.starts_with("/dev") {
                assert_eq!(source.kind(), ErrorKind::StorageFull);
                // The device is still one.
                #[cfg(unix)]
                assert!(std::os::unix::fs::FileTypeExt::is_char_device(
                    &fs::metadata(&place).unwrap().file_type()
                ));
            }
            let message = error.to_string();
            let told = [place.display().to_string(), source.to_string()];
            assert!(told.iter().all(|part| message.contains(part)), "{message}");
        }
    }
}

#[test]
fn bytes_of_no_format_are_shown() {
    let unknown = Scratch::new("unknown.sdf");
    fs::write(&unknown.0, b"\x00\x01\x02 something else").unwrap();
    let error = read_surface(&unknown.0).unwrap_err();
    // Text is what is left: a reader of text may take it, and then says what is wrong.
    assert!(
        matches!(
            &error,
            Error::File(FileError::UnknownFormat { .. }) | Error::File(FileError::BadFile { .. })
        ),
        "{error}"
    );
    assert!(error.to_string().contains("unknown.sdf"), "{error}");
}

/// An array has no unit, and one side does not say the other.
#[test]
fn what_is_assumed_is_noted() {
    let file = Scratch::new("assumed.npy");
    write_npy(&file.0, &DMatrix::from_element(4, 2, 1.0)).unwrap();
    let notes = |options: ReadOptions| options.read(&file.0).unwrap().notes;
    let side = notes(ReadOptions::new().side(1e-3));
    assert_eq!(
        side,
        [
            "a NumPy array has no unit: its heights are assumed to be in m; its first index is taken for x \
             (`ReadOptions::rows_are_y` takes an image, whose rows are y)",
            "cells are assumed to be square: the side along y is 500 µm"
        ]
    );
    let both = ReadOptions::new().side(1e-3).side_y(1e-3);
    let unit: LengthUnit = "um".parse().unwrap();
    assert!(notes(both.height_unit(unit)).is_empty());
}

/// An image is the transposed array, with the side along x that of its rows; files of other formats are as they were.
#[test]
fn an_array_may_be_an_image() {
    let file = Scratch::new("image.npy");
    let image = DMatrix::from_fn(2, 4, |row, column| (10 * row + column) as f64);
    write_npy(&file.0, &image).unwrap();
    let options = ReadOptions::new().side(8e-3).rows_are_y();
    let measured = options.read(&file.0).unwrap();
    assert_eq!(measured.heights, image.transpose());
    assert_eq!(measured.cell, Some((2e-3, 2e-3)));
    assert_eq!(measured.notes[0], "a NumPy array has no unit: its heights are assumed to be in m");
    let text = "0 1 2 3\n10 11 12 13\n";
    let options = options.height_unit(LengthUnit::METRE).layout(TextLayout::Matrix);
    assert_eq!(options.read_bytes(text, "text").unwrap().heights, image.transpose());
}

/// A side may be a number that its cells are not.
#[test]
fn sides_of_no_cell() {
    let file = Scratch::new("side.npy");
    write_npy(&file.0, &DMatrix::from_element(3, 3, 1.0)).unwrap();
    let read = |side: f64| ReadOptions::new().side(side).read(&file.0);
    assert_eq!(read(3e-300).unwrap().cell, Some((1e-300, 1e-300)));
    for side in [5e-324, 0.0, -1.0, f64::NAN] {
        let error = read(side).unwrap_err();
        assert!(matches!(error, Error::NotPositive { .. }), "{error}");
    }
}
