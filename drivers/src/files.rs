//! Real files of every format to begin with, from the tests of the library.

/// A file of the folder `tests/data/surface_files`.
macro_rules! file {
    ($name:literal) => {
        include_bytes!(concat!("../../tests/data/surface_files/", $name))
    };
}

/// One file of each format and kind.
pub(crate) const FILES: [&[u8]; 37] = [
    file!("missing.npy"),
    file!("missing.gsf"),
    file!("masked.gwy"),
    file!("missing_ascii.sdf"),
    file!("missing_bcr_i2.sdf"),
    file!("missing_iso2_f8.sdf"),
    file!("plain_iso2_f4.sdf"),
    file!("missing_f64.x3p"),
    file!("missing_i16_mask.x3p"),
    file!("missing_i16.sur"),
    file!("missing_i32_compressed.sur"),
    file!("missing_f32.al3d"),
    file!("missing_u32.vk4"),
    file!("missing_matrix.asc"),
    file!("plain_gwyddion.txt"),
    file!("missing.xyz"),
    file!("missing_i16_colours.sur"),
    file!("missing_u32.vk6"),
    file!("plain_i16.spm"),
    file!("plain_i32.spm"),
    file!("missing_f32.ibw"),
    file!("missing_f64_big.ibw"),
    file!("plain_i16.nid"),
    file!("missing_i16.opd"),
    file!("missing_f32.opd"),
    file!("missing_f32.opdx"),
    file!("missing_i32.dat"),
    file!("missing_f32.plu"),
    file!("profile_positions.x3p"),
    file!("profile_i16.pro"),
    file!("profile_npl.sdf"),
    file!("profile_f64.opdx"),
    file!("profile.prf"),
    file!("profile.smd"),
    file!("plain_i32.mnt"),
    file!("missing_i32.mnt"),
    file!("plain_i32_large_sectors.mnt"),
];

/// How files of each format begin.
pub(crate) const BEGINNINGS: [&[u8]; 21] = [
    b"\x93NUMPY\x01\x00",
    b"Gwyddion Simple Field 1.0\n",
    b"GWYPGwyContainer\0",
    b"aISO-1.0",
    b"bISO-2.0",
    b"aBCR-1.0",
    b"bBCR-1.0",
    b"PK\x03\x04",
    b"DIGITAL SURF",
    b"DSCOMPRESSED",
    b"AliconaImaging\0",
    b"VK4_",
    b"x y z\n",
    b"VK6",
    b"\\*File list\r\n",
    b"[DataSet]\r\n",
    b"\x01\x00Directory\0",
    b"1 2\r\nA 0 PRF\r\nCX M 2 MM 1 D\r\nCZ M 2 UM 1 L\r\nEOR\r\nSPACING CX 1\r\n",
    b"VCA DATA\x01\x00\x00\x55",
    b"\x88\x1b\x03\x6f",
    b"\x05\x00",
];
