//! Methods that return a field.

/// Methods that return the fields of these names: `getters!(Grid { nx: usize });`, each with its documentation.
macro_rules! getters {
    ($of:ty { $($(#[$text:meta])* $field:ident: $type:ty,)+ }) => {
        impl $of {$(
            $(#[$text])*
            #[must_use]
            pub fn $field(&self) -> $type {
                self.$field
            }
        )+}
    };
}
