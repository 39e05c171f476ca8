//! Files of instruments, and what other readers find in them.

mod third_party_archives_and_text;
