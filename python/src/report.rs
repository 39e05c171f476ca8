//! A path as one page.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;

use asperity::Error;
use asperity::io::write_whole;
use asperity_report::{Report as Page, Source};
use pyo3::prelude::*;

use crate::choice::choose;
use crate::elastic_path::ElasticPath;
use crate::errors::{Failure, Fallible};

/// Pixels of a page between other cells of a notebook.
const HEIGHT: u32 = 900;

/// A path, or two to compare, as one page for a browser: made by `report`.
///
/// A notebook shows it in place.
#[pyclass(frozen, module = "asperity")]
pub(crate) struct Report {
    html: String,
    notes: Vec<String>,
}

#[pymethods]
impl Report {
    /// The page: one file that needs no network and no other file.
    #[getter]
    fn html(&self) -> &str {
        &self.html
    }

    /// What the page leaves out, and why; it says so itself.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// Write the page.
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    ///     Its name; it should end in ``.html``.
    fn save(&self, path: PathBuf) -> Fallible<()> {
        write_whole(&path, |output| output.write_all(self.html.as_bytes()))
            .map_err(|error| Error::from(error).into())
    }

    /// The page in a frame of its own: its style and its names stay apart from those of the notebook.
    fn _repr_html_(&self) -> String {
        let mut frame = format!(
            r#"<iframe title="asperity" width="100%" height="{HEIGHT}" style="border: 0" sandbox="allow-scripts allow-downloads allow-modals" srcdoc=""#
        );
        for letter in self.html.chars() {
            match letter {
                '&' | '"' | '<' | '>' => {
                    // Writing to a text cannot fail.
                    let _ = write!(frame, "&#{};", u32::from(letter));
                }
                _ => frame.push(letter),
            }
        }
        frame + r#""></iframe>"#
    }

    fn __repr__(&self) -> String {
        format!("<Report: {} bytes>", self.html.len())
    }
}

/// A path as one page for a browser: the contact at every state under a slider, charts and tables.
///
/// The page has the order of all events, all scalars, pressure and gap at 24 states, the surface, the bodies, warnings and residuals.
/// It is what ``asperity report`` writes.
///
/// Parameters
/// ----------
/// path : LoadingPath
///     Its states so far.
/// other : LoadingPath, optional
///     Another one to compare.
/// name, other_name : str
///     What the page calls them.
/// folder : str or os.PathLike, optional
///     Folder of tables that the program has written of the path: ``slip.csv``, ``creep.csv``, ``leak.csv``, ``unloading.csv``.
/// units : {'SI', 'mm-N-MPa'}
///     What the page shows at first; its reader may choose others.
///
/// Returns
/// -------
/// Report
///
/// Examples
/// --------
/// >>> import asperity as asp
/// >>> surface = asp.example_surface(nodes=32)
/// >>> path = asp.load_path(surface, asp.HalfSpace(1e9, boundary="free"), area_fraction=0.1)
/// >>> history = path.run(check=False)
/// >>> page = asp.report(path, name="an example")
/// >>> page.html.startswith("<!DOCTYPE html>")
/// True
#[pyfunction]
#[pyo3(signature = (path, other=None, *, name="path", other_name="other path", folder=None, units="SI"))]
fn report(
    py: Python<'_>,
    path: ElasticPath<'_>,
    other: Option<ElasticPath<'_>>,
    name: &str,
    other_name: &str,
    folder: Option<PathBuf>,
    units: &str,
) -> Fallible<Report> {
    if let Some(folder) = folder.as_ref().filter(|folder| !folder.is_dir()) {
        return Err(Failure::arguments(format!("there is no folder {}", folder.display())));
    }
    let mut page = match choose("units", units, &[("SI", false), ("mm-N-MPa", true)])? {
        false => Page::new(),
        true => Page::new().in_millimetres(),
    };
    let paths = [Some((path, name, folder)), other.map(|other| (other, other_name, None))];
    for (path, name, folder) in paths.into_iter().flatten() {
        let name = name.to_string();
        page = path.with_record(py, move |engine, record| {
            let source = Source::new(name, record).computed_by(engine);
            page.add(match folder {
                Some(folder) => source.with_folder(&folder),
                None => source,
            })?;
            Ok(page)
        })?;
    }
    Ok(Report { html: page.html(), notes: page.notes().to_vec() })
}

pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Report>()?;
    module.add_function(wrap_pyfunction!(report, module)?)
}
