//! Fig. 5 on the page.

use super::picture;

/// Area against load.
pub(crate) fn figure5(prefix: &str) -> String {
    format!(
        "## Fig. 5: area against load\n\n{}\n\n\
         Evenly spaced loads. A correlation of 0.999 does not prove a linear law: a line with an \
         intercept also fits a slightly curved law, and k of Fig. 6 falls over the same range. \
         The dot follows from the paper's k and gradient at its greatest load.",
        picture(prefix, "figure5", "Contact area against load"),
    )
}
