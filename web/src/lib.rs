//! asperity in a browser: the library as WebAssembly, for the page in `page`, whose worker calls what is exported here.
//!
//! Requests and answers are texts of JSON; quantities are in SI units. Whatever fails throws a text of JSON with a
//! `kind`, by which the page asks for what is missing, and a `message` for people.

#![warn(missing_debug_implementations)]

mod fault;
mod half_space;
mod heights;
mod information;
mod request;
mod room;
mod running;

use wasm_bindgen::prelude::*;

use fault::Fault;
use heights::Heights;
use running::Running;

/// What a browser throws.
fn thrown(fault: Fault) -> JsValue {
    JsValue::from_str(&fault.json())
}

/// Says on a panic where it was, which WebAssembly alone does not: to be called once.
#[wasm_bindgen]
pub fn begin() {
    std::panic::set_hook(Box::new(|panic| wasm_bindgen::throw_str(&panic.to_string())));
}

/// Names and values of materials, as a list in JSON.
#[wasm_bindgen]
#[must_use]
pub fn materials() -> String {
    information::materials()
}

/// A surface: read from a file or generated.
#[wasm_bindgen]
#[derive(Debug)]
pub struct WebSurface(Heights);

#[wasm_bindgen]
impl WebSurface {
    /// What is in a file, of any format that the library reads.
    ///
    /// # Errors
    ///
    /// What the file does not say and has to be asked for, and what cannot be read.
    pub fn read(bytes: &[u8], name: &str, reading: &str) -> Result<WebSurface, JsValue> {
        let read = || Heights::read(bytes, name, &request::parse(reading)?);
        read().map(Self).map_err(thrown)
    }

    /// A self-affine surface.
    ///
    /// # Errors
    ///
    /// For a spectrum that the grid cannot carry, and for want of memory.
    pub fn generate(generation: &str) -> Result<WebSurface, JsValue> {
        let generate = || Heights::generate(&request::parse(generation)?);
        generate().map(Self).map_err(thrown)
    }

    /// Facts, notes and warnings, in JSON.
    #[must_use]
    pub fn information(&self) -> String {
        information::of(&self.0).to_string()
    }

    /// Heights in levels from 1 to 255, x fast, 0 where a node is missing.
    #[must_use]
    pub fn picture(&self) -> Vec<u8> {
        self.0.picture()
    }
}

/// A path that is being followed.
#[wasm_bindgen]
#[derive(Debug)]
pub struct WebPath(Running);

#[wasm_bindgen]
impl WebPath {
    /// Begins.
    ///
    /// # Errors
    ///
    /// For bodies and targets that there are not, and for want of memory.
    #[wasm_bindgen(constructor)]
    pub fn new(surface: &WebSurface, job: &str) -> Result<WebPath, JsValue> {
        let begin = || Running::new(&surface.0, &request::parse(job)?);
        begin().map(Self).map_err(thrown)
    }

    /// Goes on by one state; `false` at the end.
    ///
    /// # Errors
    ///
    /// What breaks the path off; the states before stay.
    pub fn step(&mut self) -> Result<bool, JsValue> {
        self.0.step().map_err(thrown)
    }

    /// Number of states so far.
    #[must_use]
    pub fn states(&self) -> usize {
        self.0.states()
    }

    /// How far the path is, in JSON.
    #[must_use]
    pub fn progress(&self) -> String {
        self.0.progress().to_string()
    }

    /// The path so far for the viewer, without pressure and gap.
    ///
    /// # Errors
    ///
    /// Before the first state.
    pub fn so_far(&self) -> Result<String, JsValue> {
        self.0.so_far().map_err(thrown)
    }

    /// The same with pressure and gap, and all that is said of it.
    ///
    /// # Errors
    ///
    /// Before the first state.
    pub fn whole(&mut self) -> Result<String, JsValue> {
        self.0.whole().map_err(thrown)
    }

    /// The report as one page of HTML.
    ///
    /// # Errors
    ///
    /// Before the first state.
    pub fn report(&mut self) -> Result<String, JsValue> {
        self.0.report().map_err(thrown)
    }

    /// The record, as `asperity` and `numpy.load` open it.
    ///
    /// # Errors
    ///
    /// Before the first state.
    pub fn record(&mut self) -> Result<Vec<u8>, JsValue> {
        self.0.npz().map_err(thrown)
    }

    /// The table of all states, `path.csv`.
    ///
    /// # Errors
    ///
    /// For states that are in no order of a path.
    pub fn table(&self) -> Result<String, JsValue> {
        self.0.table().map_err(thrown)
    }
}
