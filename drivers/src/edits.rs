//! Files that somebody has tampered with.

use crate::draw::Draw;

/// Counts and lengths that become none, or more than there can be, in bytes and in digits.
const EXTREMES: [&[u8]; 12] = [
    b"\0",
    b"\0\0\0\0",
    b"\x7f",
    b"\xff",
    b"\xff\xff",
    b"\xff\xff\xff\xff",
    b"\xff\xff\xff\x7f",
    b"9999",
    b"-1",
    b"1e308",
    b"nan",
    b"\n",
];

/// Does a few things to bytes, each somewhere: overwrites, puts in, takes out, repeats.
pub(crate) fn edit(draw: &mut Draw<'_>, bytes: &mut Vec<u8>, most: usize) {
    for _ in 0..draw.whole(0, 6) {
        let place = draw.whole(0, bytes.len());
        let end = (place + draw.whole(0, 16)).min(bytes.len());
        let put: Vec<u8> = match draw.whole(0, 4) {
            0 => draw.bytes(end - place).to_vec(),
            1 => draw.one_of(EXTREMES[0], &EXTREMES).to_vec(),
            2 => Vec::new(),
            3 => bytes[place..end].repeat(2),
            _ => {
                let count = draw.whole(0, 24);
                draw.bytes(count).to_vec()
            }
        };
        bytes.splice(place..end, put);
        bytes.truncate(most);
    }
}
