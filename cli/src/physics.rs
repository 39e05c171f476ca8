//! Options for what the model leaves out: a sentence that says so.

use clap::error::{ContextKind, ContextValue, ErrorKind};

/// What the model is.
const MODEL: &str = "The model is linear elastic: two bodies, flat but for their roughness, press on each other \
                     normally, without friction. Nothing yields without --hardness, and nothing sticks without \
                     --work-of-adhesion";

/// Parts of the names that such options have, and what the program does of it.
const LEFT_OUT: [(&[&str], &str); 8] = [
    (
        &["friction", "shear", "tangential", "slip", "stick"],
        "the contact is frictionless here, and the load normal; `asperity slip` shears the path of a record",
    ),
    (
        &["plastic", "hardness", "yield"],
        "nothing yields here; `asperity path` and `asperity load` take --hardness",
    ),
    (
        &["adhesi", "surface-energy", "cohesi", "jkr", "dmt"],
        "nothing pulls here; `asperity path` takes --work-of-adhesion",
    ),
    (
        &["viscoel", "creep", "relax", "-rate", "frequency"],
        "time plays no part here, and the modulus is that at the rate of loading; `asperity creep` lets the path of a \
         record creep",
    ),
    (&["temperature", "thermal", "heat"], "temperature plays no part"),
    (&["wear"], "surfaces do not wear"),
    (
        &["lubric", "viscosity", "fluid", "leak"],
        "there is nothing between the surfaces here; `asperity leak` presses a fluid through the gap of a record",
    ),
    (
        &["unload"],
        "unloading needs no option where nothing yields: elastic contact without friction goes back through the same states; \
         `asperity path`, not `load`, takes --unload, with --hardness and with --work-of-adhesion",
    ),
];

/// What to say of a command line that asks for such a thing.
pub(crate) fn left_out(error: &clap::Error) -> Option<String> {
    let Some(ContextValue::String(option)) = error.get(ContextKind::InvalidArg) else {
        return None;
    };
    // `Usage: asperity path ...`: other commands know of what these leave out, and the program alone is `path`.
    let usage = error.get(ContextKind::Usage)?.to_string();
    let command = usage.split_whitespace().nth(2).unwrap_or_default();
    if !(["path", "load"].contains(&command) || command.starts_with(['[', '<', '-'])) {
        return None;
    }
    let asks = |names: &[&str]| names.iter().any(|name| option.contains(name));
    let is_unknown = error.kind() == ErrorKind::UnknownArgument;
    let (_, sentence) = LEFT_OUT.iter().find(|(names, _)| is_unknown && asks(names))?;
    Some(format!("error: there is no {option}: {sentence}.\n{MODEL}.\n"))
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Debug, Parser)]
    struct Known {
        #[arg(long)]
        _nodes: Option<usize>,
    }

    #[test]
    fn what_the_model_leaves_out_is_said() {
        let said = |option: &str| {
            let error = Known::try_parse_from(["asperity", option, "0.3"]).err();
            error.and_then(|error| left_out(&error))
        };
        for (option, word) in [
            ("--friction", "friction"),
            ("--friction-coefficient", "normal"),
            ("--plastic", "yields"),
            ("--hardness", "yields"),
            ("--work-of-adhesion", "pulls"),
            ("--viscoelastic", "time"),
            ("--creep-time", "`asperity creep`"),
            ("--viscosity", "`asperity leak`"),
            ("--leak", "`asperity leak`"),
            ("--temperature", "temperature"),
        ] {
            let said = said(option).unwrap_or_default();
            assert!(said.contains(word) && said.contains(option), "{said}");
            assert!(said.contains("linear elastic"), "{said}");
            assert!(!said.contains("without adhesion"), "{said}");
        }
        // Another command, another mistake, and none.
        #[derive(Debug, Parser)]
        struct Slip {
            #[arg(long)]
            _friction: Option<f64>,
        }
        let error = Slip::try_parse_from(["asperity slip", "--frictions", "0.3"]).err();
        assert!(error.is_some_and(|error| left_out(&error).is_none()));
        assert_eq!((said("--node"), said("--nonsense")), (None, None));
    }
}
