//! A solver of the engine, whatever updater it has.

use asperity::bed::{Bed, Superposition};
use asperity::contact::Certificate;
use asperity::creep::{Relaxation, ViscoelasticBed};
use asperity::leak::{Leak, LeakCurve, Seal};
use asperity::loading::{History, LoadingEnd};
use asperity::nalgebra::DMatrix;
use asperity::record::LoadingRecord;
use asperity::slip::{PartialSlip, SlipZone};
use asperity::stress::{FirstYield, Subsurface};
use asperity::surface::HeightMap;
use asperity::updater::LinearUpdater;
use asperity::{ContactTarget, Error, LoadingSolver, LoadingState, Problem};

/// What a path is asked.
pub(crate) trait Engine: Send + Sync {
    fn advance(&mut self) -> Option<Result<LoadingState, Error>>;
    fn waiting(&self) -> usize;
    fn end(&self) -> Option<LoadingEnd>;
    fn targets(&self) -> Vec<ContactTarget>;
    fn bytes(&self) -> usize;
    fn handed_over_at(&self) -> Option<usize>;
    fn has_hardness(&self) -> bool;
    fn hardness_map(&self) -> Option<DMatrix<f64>>;
    fn problem(&self) -> &Problem;
    fn continue_to(&mut self, target: ContactTarget) -> Result<(), Error>;
    fn record(&self, history: History) -> Result<LoadingRecord, Error>;
    fn pressure_at(&mut self, state: &LoadingState) -> Result<DMatrix<f64>, Error>;
    fn displacement_at(&mut self, state: &LoadingState) -> Result<DMatrix<f64>, Error>;
    fn gap_at(&mut self, state: &LoadingState) -> Result<DMatrix<f64>, Error>;
    fn pressure_and_gap_at(
        &mut self,
        state: &LoadingState,
    ) -> Result<(DMatrix<f64>, DMatrix<f64>), Error>;
    fn contact_map_at(&self, state: &LoadingState) -> Result<DMatrix<bool>, Error>;
    fn yielded_map_at(&self, state: &LoadingState) -> Result<DMatrix<bool>, Error>;
    fn plastic_depth_at(&mut self, state: &LoadingState) -> Result<DMatrix<f64>, Error>;
    fn add_unloading_stiffness(&self, states: &mut [LoadingState]) -> Result<(), Error>;
    fn residual_surface_at(&mut self, state: &LoadingState) -> Result<HeightMap, Error>;
    fn certificate_at(&mut self, state: &LoadingState) -> Result<Certificate, Error>;
    fn superposed_pressure(&mut self, of: &Superposition, bed: &Bed)
    -> Result<DMatrix<f64>, Error>;
    fn relaxed_gap(&mut self, of: &Relaxation, time: f64) -> Result<DMatrix<f64>, Error>;
    fn stepped_gap(&mut self, of: &ViscoelasticBed, pieces: usize) -> Result<DMatrix<f64>, Error>;
    fn sheared(
        &mut self,
        what: Sheared,
        of: &PartialSlip,
        load: f64,
    ) -> Result<DMatrix<f64>, Error>;
    fn slip_zones(&self, of: &PartialSlip, load: f64) -> Result<DMatrix<SlipZone>, Error>;
    fn leak_at(&mut self, seal: &Seal, state: &LoadingState) -> Result<Leak, Error>;
    fn leak_curve(
        &mut self,
        seal: &Seal,
        history: &History,
        states: usize,
    ) -> Result<LeakCurve, Error>;
    fn first_yield(
        &mut self,
        below: &Subsurface,
        history: &History,
        yield_stress: f64,
    ) -> Result<Option<FirstYield>, Error>;
}

/// Fields under a tangential load.
#[derive(Clone, Copy)]
pub(crate) enum Sheared {
    Traction,
    Slip,
    FrictionWork,
}

impl<U: LinearUpdater + Send + Sync> Engine for LoadingSolver<U> {
    fn advance(&mut self) -> Option<Result<LoadingState, Error>> {
        self.next()
    }

    fn waiting(&self) -> usize {
        Self::waiting(self)
    }

    fn end(&self) -> Option<LoadingEnd> {
        Self::end(self)
    }

    fn targets(&self) -> Vec<ContactTarget> {
        Self::targets(self)
    }

    fn bytes(&self) -> usize {
        Self::bytes(self)
    }

    fn handed_over_at(&self) -> Option<usize> {
        Self::handed_over_at(self)
    }

    fn has_hardness(&self) -> bool {
        self.hardness_map().is_some()
    }

    fn hardness_map(&self) -> Option<DMatrix<f64>> {
        Self::hardness_map(self)
    }

    fn problem(&self) -> &Problem {
        Self::problem(self)
    }

    fn continue_to(&mut self, target: ContactTarget) -> Result<(), Error> {
        Self::continue_to(self, target)
    }

    fn record(&self, history: History) -> Result<LoadingRecord, Error> {
        LoadingRecord::new(self, history)
    }

    fn pressure_at(&mut self, state: &LoadingState) -> Result<DMatrix<f64>, Error> {
        Self::pressure_at(self, state)
    }

    fn displacement_at(&mut self, state: &LoadingState) -> Result<DMatrix<f64>, Error> {
        Self::displacement_at(self, state)
    }

    fn gap_at(&mut self, state: &LoadingState) -> Result<DMatrix<f64>, Error> {
        Self::gap_at(self, state)
    }

    fn pressure_and_gap_at(
        &mut self,
        state: &LoadingState,
    ) -> Result<(DMatrix<f64>, DMatrix<f64>), Error> {
        Self::pressure_and_gap_at(self, state)
    }

    fn contact_map_at(&self, state: &LoadingState) -> Result<DMatrix<bool>, Error> {
        Self::contact_map_at(self, state)
    }

    fn yielded_map_at(&self, state: &LoadingState) -> Result<DMatrix<bool>, Error> {
        Self::yielded_map_at(self, state)
    }

    fn plastic_depth_at(&mut self, state: &LoadingState) -> Result<DMatrix<f64>, Error> {
        Self::plastic_depth_at(self, state)
    }

    fn add_unloading_stiffness(&self, states: &mut [LoadingState]) -> Result<(), Error> {
        Self::add_unloading_stiffness(self, states)
    }

    fn residual_surface_at(&mut self, state: &LoadingState) -> Result<HeightMap, Error> {
        Self::residual_surface_at(self, state)
    }

    fn certificate_at(&mut self, state: &LoadingState) -> Result<Certificate, Error> {
        Self::certificate_at(self, state)
    }

    fn superposed_pressure(
        &mut self,
        of: &Superposition,
        bed: &Bed,
    ) -> Result<DMatrix<f64>, Error> {
        of.pressure(bed, self)
    }

    fn relaxed_gap(&mut self, of: &Relaxation, time: f64) -> Result<DMatrix<f64>, Error> {
        of.gap(time, self)
    }

    fn stepped_gap(&mut self, of: &ViscoelasticBed, pieces: usize) -> Result<DMatrix<f64>, Error> {
        of.gap(pieces, self)
    }

    fn sheared(
        &mut self,
        what: Sheared,
        of: &PartialSlip,
        load: f64,
    ) -> Result<DMatrix<f64>, Error> {
        match what {
            Sheared::Traction => of.traction(self, load),
            Sheared::Slip => of.slip(self, load),
            Sheared::FrictionWork => of.friction_work(self, load),
        }
    }

    fn slip_zones(&self, of: &PartialSlip, load: f64) -> Result<DMatrix<SlipZone>, Error> {
        of.zones(self, load)
    }

    fn leak_at(&mut self, seal: &Seal, state: &LoadingState) -> Result<Leak, Error> {
        seal.leak_at(self, state)
    }

    fn leak_curve(
        &mut self,
        seal: &Seal,
        history: &History,
        states: usize,
    ) -> Result<LeakCurve, Error> {
        seal.curve(self, history, states)
    }

    fn first_yield(
        &mut self,
        below: &Subsurface,
        history: &History,
        yield_stress: f64,
    ) -> Result<Option<FirstYield>, Error> {
        below.first_yield(self, history, yield_stress)
    }
}
