//! A path that is being followed, a state at a time.

use std::io::Cursor;

use asperity::record::LoadingRecord;
use asperity::{ContactTarget, Error, LoadingPath, LoadingSolver, LoadingState};
use asperity_report::{PathTable, Report, Source};
use serde_json::{Value, json};

use crate::fault::Fault;
use crate::heights::Heights;
use crate::request::Job;
use crate::room;

/// The name that a record gets.
const RECORD: &str = "path.npz";

/// A path with its states.
#[derive(Debug)]
pub(crate) struct Running {
    name: String,
    bodies: Vec<(f64, f64)>,
    path: LoadingPath,
    states: Vec<LoadingState>,
    /// What was made of the states so far, since its fields take long.
    page: Option<Report>,
}

impl Running {
    /// Begins.
    pub(crate) fn new(heights: &Heights, job: &Job) -> Result<Self, Fault> {
        let surface = heights.surface()?;
        let (grid, boundary) = (*surface.grid(), job.half_space.boundary());
        let row = match (grid.shape(), boundary.repeats()) {
            ((_, 1), [_, false]) => Some("y"),
            ((1, _), [false, _]) => Some("x"),
            _ => None,
        };
        if let Some(across) = row {
            return Err(Fault::new(format!(
                "a profile is one row of nodes, which has to repeat across: let the half-space be periodic along {across}, or along both"
            )));
        }
        room::check(&grid, boundary)?;
        let (bodies, e_star) = job.bodies()?;
        let kernel = job.half_space.kernel(grid, e_star)?;
        let mut builder = LoadingSolver::builder(surface, &*kernel)
            .memory_budget(room::budget(&grid))
            .until(job.end(grid.nominal_area())?);
        if let Some(hardness) = job.hardness {
            builder = builder.hardness(hardness);
        }
        let path = builder.build()?.into_path();
        Ok(Self { name: heights.name.clone(), bodies, path, states: Vec::new(), page: None })
    }

    /// Goes on by one state; `false` at the end.
    pub(crate) fn step(&mut self) -> Result<bool, Fault> {
        let next = self.path.next().transpose()?;
        if next.is_some() {
            self.page = None;
        }
        self.states.extend(next);
        Ok(next.is_some())
    }

    pub(crate) fn states(&self) -> usize {
        self.states.len()
    }

    /// Nodes in contact, load, area, and the part of the way to the target: load grows about in proportion to nodes.
    pub(crate) fn progress(&self) -> Value {
        let Some(last) = self.states.last().map(|state| state.contact) else {
            return json!({"states": 0, "share": 0.0});
        };
        let share = |target: &ContactTarget| match *target {
            ContactTarget::Load(load) => last.load / load,
            ContactTarget::Approach(approach) => last.approach / approach,
            ContactTarget::AreaFraction(fraction) => last.contact_area_fraction / fraction,
            _ => 0.0,
        };
        let targets = self.path.targets();
        let shares = targets.iter().map(share);
        let share = match self.path.end() {
            None => shares.fold(last.contact_area_fraction, f64::max).min(1.0),
            Some(_) => 1.0,
        };
        json!({
            "states": self.states.len(),
            "nodes": last.contact_nodes,
            "load": last.load,
            "area": last.contact_area_fraction,
            "share": share,
        })
    }

    fn made(&self) -> Result<LoadingRecord, Error> {
        let history = self.states.iter().copied().collect();
        LoadingRecord::new(&self.path, history)?.with_bodies(&self.bodies)
    }

    /// The path so far for the viewer, without pressure and gap.
    pub(crate) fn so_far(&self) -> Result<String, Fault> {
        let mut report = Report::new();
        report.add(Source::new(&self.name, &self.made()?).without_fields())?;
        Ok(report.data().to_string())
    }

    fn page(&mut self) -> Result<&Report, Fault> {
        let page = match self.page.take() {
            Some(page) => page,
            None => {
                let record = self.made()?;
                let mut report = Report::new().made_by("asperity in the browser");
                report.add(Source::new(&self.name, &record).computed_by(&mut self.path))?;
                report
            }
        };
        Ok(self.page.insert(page))
    }

    /// The same with pressure and gap, and all that is said of it.
    pub(crate) fn whole(&mut self) -> Result<String, Fault> {
        Ok(self.page()?.data().to_string())
    }

    /// The report as one page.
    pub(crate) fn report(&mut self) -> Result<String, Fault> {
        Ok(self.page()?.html())
    }

    /// The record, with the fields of the last state.
    pub(crate) fn npz(&mut self) -> Result<Vec<u8>, Fault> {
        self.path.present()?;
        let record = self.made()?;
        let found = self.path.fields()?;
        let mut fields = vec![("pressure", &found.pressure), ("gap", &found.gap)];
        if record.settings().hardness.is_some() {
            fields.push(("plastic_depth", &found.plastic_depth));
        }
        let mut bytes = Cursor::new(Vec::new());
        record.write_npz_to(&mut bytes, RECORD, &fields)?;
        Ok(bytes.into_inner())
    }

    /// The table of all states.
    pub(crate) fn table(&self) -> Result<String, Fault> {
        let mut table = PathTable::new(self.path.grid(), self.path.problem().table().boundary());
        let mut text = format!("{}\n", PathTable::HEADER);
        for state in &self.states {
            text += &table.line(state)?;
            text.push('\n');
        }
        Ok(text)
    }
}

#[cfg(test)]
mod tests {
    use asperity::{Boussinesq, ContactEvent, Grid, SelfAffine, plane_strain_modulus};

    use super::*;
    use crate::request::{Generation, parse};

    fn running(job: &str) -> Result<Running, Fault> {
        let made = Heights::generate(&Generation { nodes: Some(64), ..Generation::default() })?;
        Running::new(&made, &parse(job)?)
    }

    /// What the page runs is the path of the library on the surface of the program's example, bit for bit.
    #[test]
    fn states_are_those_of_the_library() -> Result<(), Fault> {
        let mut page = running(r#"{"body": "steel"}"#)?;
        while page.step()? {}
        assert!(!page.step()?);
        // Eight cells of the 156 µm of 64 nodes are longer than the shortest wave of the example.
        let example = SelfAffine::zhang2020(1);
        let (rolloff, amplitude) = (example.rolloff_wavelength(), example.amplitude());
        let surface = SelfAffine::new(example.hurst(), rolloff, 8e-2 / 64.0, amplitude, 1)?;
        let kernel = Boussinesq::new(Grid::square(64, 1e-2)?, plane_strain_modulus(210e9, 0.3)?)?;
        let path = LoadingSolver::builder(&surface, &kernel).max_area_fraction(0.1).build()?;
        let expected: Vec<LoadingState> = path.collect::<Result<_, Error>>()?;
        assert_eq!(page.states, expected);
        assert_eq!(page.progress()["share"], 1.0);
        assert_eq!(page.table()?.lines().count(), expected.len() + 1);
        Ok(())
    }

    /// A path that was stopped is shown, saved and read again as far as it has come.
    #[test]
    fn a_path_is_there_before_its_end() -> Result<(), Fault> {
        let mut page =
            running(r#"{"body": "steel", "hardness": 2.5e9, "target": {"mean_pressure": 1e9}}"#)?;
        assert!(page.so_far().is_err() && page.npz().is_err());
        while page.states.iter().all(|state| state.event != ContactEvent::Yield) && page.step()? {}
        let count = |text: String| {
            let data: Value = serde_json::from_str(&text).unwrap_or_default();
            (data["records"][0]["events"]["count"].clone(), data["records"][0]["fields"].is_null())
        };
        assert_eq!(count(page.so_far()?), (json!(page.states()), true));
        assert_eq!(count(page.whole()?), (json!(page.states()), false));
        assert!(page.report()?.starts_with("<!DOCTYPE html>"));
        let name = std::env::temp_dir().join(format!("asperity-web-{}.npz", std::process::id()));
        std::fs::write(&name, page.npz()?).map_err(|error| Fault::new(error.to_string()))?;
        let record = LoadingRecord::read_npz(&name)?;
        assert_eq!((record.states(), record.bodies()), (&page.states[..], &[(210e9, 0.3)][..]));
        std::fs::remove_file(&name).map_err(|error| Fault::new(error.to_string()))
    }

    #[test]
    fn a_profile_has_to_repeat() -> Result<(), Fault> {
        let reading =
            parse(r#"{"side": 4e-3, "side_y": 1e-3, "height_unit": "um", "layout": "matrix"}"#)?;
        let row = Heights::read(b"1 2 3 2 1 0 1 2\n", "row.txt", &reading)?;
        let job = |half_space: &str| {
            parse::<Job>(&format!(
                r#"{{"e_star": 1e9, "half_space": "{half_space}", "target": {{"area_fraction": 0.5}}}}"#
            ))
        };
        assert!(
            Running::new(&row, &job("free")?).is_err_and(|fault| fault.message.contains("profile"))
        );
        assert!(Running::new(&row, &job("x")?).is_err());
        assert!(Running::new(&row, &job("y")?).is_ok());
        Ok(())
    }
}
